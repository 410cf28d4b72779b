//! `bake`: a model into a list that firmware keeps in flash (H11, H16).
//!
//! Vertices are rounded to the smallest form that keeps the error asked for, and merged where
//! they become the same; triangles of one colour share a material instead of a column; strips
//! and fans index tables of 255 vertices in bytes, or one large table in half words, whichever is
//! smaller. Pictures become textures of the smallest form that keeps the error asked for, and
//! texture places are moved by whole sides to where 2x16U holds them. Materials keep opacity and
//! highlights. HEAD says what memory the list needs, BOUNDS where it is.

mod plan;

use super::args::{BakeArgs, Normals, Pictures};
use super::fields::{Grid, Packed, degrees_between, normal_fields};
use super::gltf::{self, Loaded};
use super::sizes;
use super::texels::{Picture, Texels};
use crate::draw::TextureSetError;
use crate::image_out::{read_cutout, write_atomically};
use crate::lists::writer::ListWriter;
use crate::model::{Model, ModelError};
use crate::texture_file;
use plan::Plan;
use scanbeam::list::FieldForm;
use std::collections::BTreeSet;
use std::error::Error;

/// What is to be kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BakeSettings {
    /// How far a vertex may be moved, in units of the model; `None`: a thousandth of half the
    /// longest side.
    pub error: Option<f64>,
    /// How far a normal may be turned, in degrees.
    pub normal_error: f64,
    /// Whether normals are kept.
    pub normals: bool,
    /// How far texels may be off: root of the mean square, in levels of 255.
    pub texel_error: f64,
    /// Whether it is cut into parts that are passed over where they are turned away.
    pub meshlets: bool,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            error: None,
            normal_error: 1.0,
            normals: true,
            texel_error: 4.0,
            meshlets: false,
        }
    }
}

/// A list and what became of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Baked {
    /// The list, as it lies in memory.
    pub words: Vec<u32>,
    /// Triangles that are drawn.
    pub triangles: usize,
    /// Triangles of the model that have two corners in one place after rounding.
    pub dropped: usize,
    /// Vertices in tables, copies in several tables included.
    pub vertices: usize,
    /// Strips, fans and separate triangles.
    pub runs: [usize; 3],
    /// Parts that are passed over where they are turned away.
    pub parts: usize,
    /// Form of the places.
    pub place: FieldForm,
    /// Form of the normals, where there are any.
    pub normal: Option<FieldForm>,
    /// Farthest that a vertex was moved, in units of the model.
    pub error: f64,
    /// Farthest that a normal was turned, in degrees.
    pub normal_error: f64,
    /// Vertices of the largest table.
    pub table: usize,
    /// The textures, by number.
    pub textures: Vec<Texels>,
    /// Texture places that no number of sides brings to where 2x16U holds them: moved to its rim.
    pub places_cut: usize,
}

impl Baked {
    /// Bytes of the list for each triangle that it draws, texels and palettes left out.
    #[must_use]
    pub fn bytes_per_triangle(&self) -> f64 {
        let texels: usize = self.textures.iter().map(Texels::bytes).sum();
        (4 * self.words.len() - texels) as f64 / self.triangles.max(1) as f64
    }
}

/// Bakes a model file.
///
/// # Errors
/// When the model cannot be read or baked, or the list cannot be written.
pub fn run(args: &BakeArgs) -> Result<(), Box<dyn Error>> {
    let Loaded { model, pictures } = load(args)?;
    let settings = BakeSettings {
        error: args.error,
        normal_error: args.normal_error,
        normals: args.normals == Normals::Keep,
        texel_error: args.texel_error,
        meshlets: args.meshlets,
    };
    let baked = bake_textured(&model, &pictures, &settings)
        .map_err(|e| format!("{}: {e}", args.model.display()))?;
    let bytes: Vec<u8> = baked.words.iter().flat_map(|w| w.to_ne_bytes()).collect();
    write_atomically(&args.output, &bytes)?;
    sizes::report(&baked, args.json)?;
    model.print_warnings();
    Ok(())
}

/// The model with its pictures, as the flags ask for them.
fn load(args: &BakeArgs) -> Result<Loaded, Box<dyn Error>> {
    let obj = args
        .model
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    let mut loaded = if obj {
        let model = Model::load(&args.model)?;
        let pictures = match (args.textures, &args.texture) {
            (Pictures::Keep, None) => of_materials(&model)?,
            _ => Vec::new(),
        };
        Loaded { model, pictures }
    } else {
        gltf::load(&args.model)?
    };
    args.check_apart(loaded.model.files())?;
    let is_pictured = obj && loaded.pictures.iter().any(Option::is_some);
    if (is_pictured || args.texture.is_some()) && !loaded.model.has_places() {
        return Err(TextureSetError::NoPlaces.named(&args.model).into());
    }
    let mut cut = loaded
        .pictures
        .iter()
        .flatten()
        .filter(|p| p.image.alpha.is_some())
        .count();
    if let Some(file) = &args.texture {
        // The last material, which no triangle has had, is for those without.
        let read = read_cutout(file)?;
        let one = Picture::new(&read.frame)?;
        let model = &mut loaded.model;
        model.materials.push(crate::model::Material::default());
        let last = model.materials.len() as u32 - 1;
        for material in &mut model.triangle_materials {
            material.get_or_insert(last);
        }
        loaded.pictures = vec![Some(one); model.materials.len()];
        cut = usize::from(read.alpha.is_some());
    } else if args.textures == Pictures::Drop {
        loaded.pictures.clear();
    }
    if cut > 0 {
        loaded.model.warnings.push(ModelError {
            file: args.model.clone(),
            line: None,
            reason: format!("alphas of materials' pictures are left out: {cut}"),
        });
    }
    // A picture on several materials is told once.
    let mut told = BTreeSet::new();
    let notes = loaded.pictures.iter().flatten();
    for note in notes.filter_map(|picture| picture.image.note.as_deref()) {
        if told.insert(note) {
            tell!("note: {note}");
        }
    }
    Ok(loaded)
}

/// The pictures of an OBJ file's materials, which repeat.
fn of_materials(model: &Model) -> Result<Vec<Option<Picture>>, Box<dyn Error>> {
    let images = texture_file::of_materials(model)?.into_iter();
    let picture = |image| Picture {
        image,
        clamped: false,
    };
    Ok(images.map(|image| image.map(picture)).collect())
}

/// Makes a list of a model without textures.
///
/// # Errors
/// When no form keeps the error, or the model is beyond what a matrix can say.
pub fn bake(model: &Model, settings: &BakeSettings) -> Result<Baked, Box<dyn Error>> {
    bake_textured(model, &[], settings)
}

/// Makes a list of a model with the pictures of its materials, of which the last may be missing.
///
/// # Errors
/// As [`bake`]; when there are more than 256 pictures.
pub fn bake_textured(
    model: &Model,
    pictures: &[Option<Picture>],
    settings: &BakeSettings,
) -> Result<Baked, Box<dyn Error>> {
    let (low, high) = model.bounds().unwrap_or(([0.0; 3], [0.0; 3]));
    let centre = [0, 1, 2].map(|i| low[i] / 2.0 + high[i] / 2.0);
    let reach = (0..3).fold(0.0f64, |r, i| r.max(high[i] - centre[i]));
    let allowed = settings.error.unwrap_or(reach / 1000.0);
    let moved = |grid: &Grid| {
        model.vertices.iter().fold(0.0f64, |worst, v| {
            let at = grid.place(grid.fields(v.position));
            let d = [0, 1, 2].map(|i| at[i] - v.position[i]);
            worst.max((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt())
        })
    };
    // By bytes in a column: 3, 4, 6, 12.
    let forms = [
        FieldForm::S8x3,
        FieldForm::S10x3,
        FieldForm::S16x3,
        FieldForm::S32x3,
    ];
    let (grid, error) = forms
        .into_iter()
        .map(|form| Grid::new(form, centre, reach))
        .map(|grid| (grid, moved(&grid)))
        .find(|(_, error)| *error <= allowed)
        .ok_or_else(|| format!("no form keeps an error of {allowed:e}"))?;
    let turned = |form| {
        model.vertices.iter().fold(0.0f64, |worst, v| {
            worst.max(degrees_between(normal_fields(form, v.normal).1, v.normal))
        })
    };
    let (normal, normal_error) = [FieldForm::S8x3, FieldForm::S10x3, FieldForm::S16x3]
        .into_iter()
        .map(|form| (form, turned(form)))
        .find(|(form, error)| *error <= settings.normal_error || *form == FieldForm::S16x3)
        .filter(|_| settings.normals)
        .map_or((None, 0.0), |(form, error)| (Some(form), error));

    let packed: Vec<Packed> = model
        .vertices
        .iter()
        .map(|v| {
            let n = normal.map_or([0; 3], |form| normal_fields(form, v.normal).0);
            let colour = v.colour.map(|c| (c * 255.0).round() as u8);
            Packed {
                place: grid.fields(v.position),
                normal: n,
                colour,
                uv: [0; 2],
            }
        })
        .collect();
    // Materials that share a picture share its texture.
    let mut distinct: Vec<&Picture> = Vec::new();
    let numbers: Vec<Option<u8>> = pictures
        .iter()
        .map(|picture| {
            let picture = picture.as_ref()?;
            let at = distinct.iter().position(|d| *d == picture);
            let at = at.unwrap_or_else(|| {
                distinct.push(picture);
                distinct.len() - 1
            });
            Some(at as u8)
        })
        .collect();
    if distinct.len() > 256 {
        return Err("more than 256 textures".into());
    }
    let reduced = |p: &&Picture| Texels::new(p, settings.texel_error);
    let textures: Vec<Texels> = distinct.iter().map(reduced).collect();
    let texel_words: usize = textures.iter().map(|t| t.bytes() / 4 + 8).sum();
    let mut baked = Baked {
        words: Vec::new(),
        triangles: 0,
        dropped: 0,
        vertices: 0,
        runs: [0; 3],
        parts: 0,
        place: grid.form,
        normal,
        error,
        normal_error,
        table: 0,
        textures,
        places_cut: 0,
    };
    let writer = Plan {
        grid,
        normal,
        packed: &packed,
        model,
        textures: &numbers,
        meshlets: settings.meshlets,
    };
    // 16 words a triangle and what comes once: more than any of the forms takes.
    let mut memory = vec![0; 32 * model.triangles.len() + 1024 + texel_words];
    let mut out = ListWriter::new(&mut memory);
    writer.write(&mut out, &mut baked, reach)?;
    baked.words = out.words().to_vec();
    Ok(baked)
}
