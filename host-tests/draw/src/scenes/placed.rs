//! An object of a scene in the crate's number formats, where it stands.

use crate::effects::colour_of;
use crate::prepared::ShadowMesh;
use crate::scene_file::{Item, Part, SceneFile};
use crate::{DrawFailure, Prepared, TextureSet};
use host_support::model::Model;
use scanbeam::Affine;
use scanbeam::pixel::Index8;
use scanbeam::scene::Budget;
use std::collections::HashMap;

/// An object.
pub(super) struct Placed<'a> {
    pub(super) item: &'a Item,
    pub(super) textures: &'a TextureSet,
    pub(super) prepared: Prepared,
    pub(super) model: Affine,
    /// The colours of parts by their looks, where light falls on pixels.
    colours: Vec<[u8; 3]>,
    /// What throws its shadow.
    pub(super) shadows: Vec<ShadowMesh>,
    /// The world's units that its coordinates are fractions of.
    unit: f64,
    /// About where it is placed, what it is within.
    pub(super) ball: Ball,
}

/// A ball in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    centre: [f64; 3],
    radius: f64,
}

impl Ball {
    /// From a point of one to a point of the other, at most.
    fn span(&self, other: &Self) -> f64 {
        let off = |i: usize| self.centre[i] - other.centre[i];
        let between = (0..3).fold(0.0f64, |sum, i| sum.hypot(off(i)));
        between + self.radius + other.radius
    }
}

impl<'a> Placed<'a> {
    /// Rounds an object of a scene.
    ///
    /// # Errors
    /// In a line, why it cannot be drawn.
    pub(super) fn new(part: &'a Part, scene: &SceneFile) -> Result<Self, String> {
        let (item, model) = (&part.item, &part.model);
        let (colours, of_triangle) = match scene.phong {
            true => colours(model)?,
            false => (Vec::new(), Vec::new()),
        };
        let look = |triangle: usize| of_triangle.get(triangle).copied().unwrap_or(0);
        let mut prepared = Prepared::split(model, &part.textures, look);
        if scene.has_palettes() {
            prepared.paint(Index8::colour(item.index.unwrap_or(0)));
        }
        let shadows = match scene.casts(item) {
            true => prepared.shadow_meshes(model, |_| true),
            false => Vec::new(),
        };
        let placed = placed(&prepared, item).ok_or("it is too large, or too far away")?;
        let scale = item.scale.unwrap_or(1.0);
        let corners = model.bounds().unwrap_or_default();
        let farthest = |i: usize| corners.0[i].abs().max(corners.1[i].abs());
        Ok(Self {
            item,
            textures: &part.textures,
            model: placed,
            colours,
            shadows,
            unit: prepared.scale * scale,
            prepared,
            ball: Ball {
                centre: item.place.unwrap_or_default(),
                radius: scale * (0..3).fold(0.0f64, |sum, i| sum.hypot(farthest(i))),
            },
        })
    }

    /// How far its texture places may be off.
    pub(super) fn budget(&self) -> Budget {
        self.item.quality.map(Budget::from).unwrap_or_default()
    }

    /// The colour of a part with a look.
    pub(super) fn colour(&self, look: u16) -> [u8; 3] {
        let colour = self.colours.get(usize::from(look));
        colour.copied().unwrap_or([255; 3])
    }

    /// The power of two of its units that its shadow is long, to fall past all of `others`, of which it may be one.
    ///
    /// # Errors
    /// When that is more than shadows are long.
    pub(super) fn reach<'b>(&self, others: impl Iterator<Item = &'b Ball>) -> Result<u8, String> {
        /// The highest power of two of units that a shadow is long.
        const MOST: f64 = 12.0;
        let longest = others.fold(0.0f64, |most, other| most.max(self.ball.span(other)));
        let power = (longest / self.unit).log2().ceil().max(1.0);
        match power <= MOST {
            true => Ok(power as u8),
            false => Err(
                "it is too small to throw its shadow over the whole scene: say `shadow` false"
                    .into(),
            ),
        }
    }
}

/// The colours of a model's triangles, and which of them each has.
fn colours(model: &Model) -> Result<(Vec<[u8; 3]>, Vec<u16>), String> {
    let (mut all, mut numbers) = (Vec::new(), HashMap::new());
    let mut of_triangle = Vec::new();
    for triangle in 0..model.triangles.len() {
        let colour = colour_of(model, triangle).ok_or_else(|| {
            format!("`phong` lights one colour a triangle: triangle {triangle} has several")
        })?;
        let number = *numbers.entry(colour).or_insert_with(|| {
            all.push(colour);
            all.len() - 1
        });
        let number = u16::try_from(number).map_err(|_| "`phong` has at most 65536 colours")?;
        of_triangle.push(number);
    }
    Ok((all, of_triangle))
}

/// Rounds the objects of a scene.
///
/// # Errors
/// The first that cannot be drawn, by its number.
pub(super) fn place<'a>(
    parts: &'a [Part],
    scene: &SceneFile,
) -> Result<Vec<Placed<'a>>, DrawFailure> {
    let place = |(number, part)| {
        let placed = Placed::new(part, scene);
        placed.map_err(|why| DrawFailure::View(format!("object {number}: {why}")))
    };
    parts.iter().enumerate().map(place).collect()
}

/// Model space to the world; `None` where that leaves the ranges of matrices. What is not said rounds nothing.
fn placed(prepared: &Prepared, item: &Item) -> Option<Affine> {
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let mut model = Affine::placed(prepared.scale as f32, single(prepared.centre))?;
    if let Some(scale) = item.scale {
        model = model.then(&Affine::placed(scale as f32, [0.0; 3])?);
    }
    if let Some(turn) = item.turn {
        let [x, y, z] = single(turn).map(f32::to_radians);
        model = model
            .then(&Affine::rotation_x(x))
            .then(&Affine::rotation_y(y))
            .then(&Affine::rotation_z(z));
    }
    if let Some(place) = item.place {
        model = model.then(&Affine::placed(1.0, single(place))?);
    }
    Some(model)
}
