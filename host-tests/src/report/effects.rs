//! Pictures of what goes beyond opaque surfaces in one matt light.

use super::Page;
use crate::args::PixelFormatArg;
use crate::draw::{CrewSettings, Effects, FilterArg, Skins, TextureSet, draw_effects};
use crate::frames::values_pictures;
use crate::model::{Material, Model, obj_text};
use crate::reference::{Cull, Shade, View};
use scanbeam::scene::Budget;
use std::error::Error;
use std::path::Path;

/// The section.
pub fn effects(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("effects", "Materials, shadows, light at pixels, dither");
    page.paragraph(
        "A teapot that shines and a clear ball on a floor, by `render` with the flags that are \
         named. Shadows are volumes that are counted on each line, and what is clear is sorted on \
         each line, so no picture needs more memory than its lines.",
    );
    let model = still_life()?;
    let rgb888 = PixelFormatArg::Rgb888;
    let dithered = PixelFormatArg::Dithered565;
    let pictures = [
        ("--shade gouraud", Shade::Gouraud, rgb888, false, false),
        (
            "--shade gouraud --shadows on",
            Shade::Gouraud,
            rgb888,
            true,
            false,
        ),
        (
            "--shade phong --shadows on",
            Shade::Gouraud,
            rgb888,
            true,
            true,
        ),
        (
            "--shade phong --shadows on --format rgb565 --dither on",
            Shade::Gouraud,
            dithered,
            true,
            true,
        ),
    ];
    for (name, shade, format, shadows, phong) in pictures {
        let view = View {
            eye: [1.2, 1.5, 2.8],
            at: [0.1, -0.1, 0.0],
            light: [0.5, 1.0, 0.6],
            shade,
            cull: Cull::None,
            background: [24, 32, 48],
            ..View::default()
        };
        let effects = Effects {
            specular: None,
            shadows,
            phong,
        };
        let set = TextureSet::default().with_levels(true);
        let skins = Skins {
            set: &set,
            filter: FilterArg::Nearest,
            budget: Budget::BALANCED,
        };
        let crew = CrewSettings::default();
        let drawn = draw_effects(&model, skins, (&view, format), crew, effects)?;
        let caption = format!("`{name}`: {} triangles in memory", drawn.figures.objects);
        page.pictures(&[&drawn.frame], &caption)?;
    }
    page.paragraph(
        "Small frames that the firmware draws with the same bits: light at pixels, texels that are lit so, a palette for each line, a look of \
         one's own, texels with holes, dither, blends by depth and by priority, shadows, points, sprites, and what a \
         second frame changed.",
    );
    for (name, frame) in values_pictures()? {
        page.pictures(&[&frame], name.trim_start_matches("values_"))?;
    }
    Ok(())
}

/// A teapot, a clear ball, and a floor.
fn still_life() -> Result<Model, Box<dyn Error>> {
    let file = Path::new("made here.obj");
    let text = |mesh| obj_text(mesh).ok_or("a mesh of triangles");
    let material = |ks: f64, ns: f64, d: f64| Material {
        ks: [ks; 3],
        ns,
        d,
        ..Material::default()
    };
    let mut all = Model {
        materials: vec![
            material(0.5, 40.0, 1.0),
            material(0.6, 80.0, 0.35),
            material(0.0, 1.0, 1.0),
        ],
        ..Model::default()
    };
    let mut add = |part: Model, (number, colour): (u32, [f64; 3]), place: [f64; 3], size: f64| {
        let base = all.vertices.len() as u32;
        for mut vertex in part.vertices {
            vertex.position = [0, 1, 2].map(|i| place[i] + size * vertex.position[i]);
            vertex.colour = colour;
            all.vertices.push(vertex);
        }
        for triangle in part.triangles {
            all.triangles.push(triangle.map(|i| base + i));
            all.triangle_materials.push(Some(number));
        }
    };
    let teapot = Model::from_obj_text(&text(&scenes::TEAPOT)?, file)?;
    add(teapot, (0, [0.8, 0.4, 0.2]), [-0.2, 0.0, -0.2], 1.0);
    let ball = Model::from_obj_text(&text(&scenes::SPHERE)?, file)?;
    add(ball, (1, [0.4, 0.8, 0.9]), [0.75, -0.15, 0.75], 0.35);
    let floor = "v -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nf 1 2 3 4\n";
    let floor = Model::from_obj_text(floor, file)?;
    add(floor, (2, [0.75, 0.75, 0.7]), [0.0, -0.5, 0.0], 1.0);
    Ok(all)
}
