//! A picture in bands of lines, from top to bottom, where its scene does not fit the arenas as a whole.

use crate::{DrawFailure, Prepared};
use host_support::lent::SceneRooms;
use host_support::reference::{Cull, Shade, View};
use scanbeam::pipeline::{DrawError, Instance, Pipeline, Scene};
use scanbeam::stats::PassOne;
use scanbeam::{Camera, Faces, Light, Mesh, Screen};
use std::ops::Range;

/// Lines that have more triangles than an arena can hold: they show those that fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Overfull {
    /// The first such line.
    pub line: u16,
    /// How many lines there are.
    pub lines: u32,
    /// How many triangles are left out, each on each of the lines.
    pub triangles: u32,
    /// What was full on the first line.
    pub first: String,
}

impl std::fmt::Display for Overfull {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { line, first, .. } = self;
        write!(f, "line {line}: {first}; the rest is drawn")?;
        match self.lines {
            1 => Ok(()),
            n => write!(
                f,
                " ({n} lines are so, {} triangles in all)",
                self.triangles
            ),
        }
    }
}

/// How a picture was put together.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Bands {
    /// Bands of lines that were drawn one after the other.
    pub count: u32,
    /// What fits no band.
    pub overfull: Option<Overfull>,
}

/// What stays the same for all bands of a picture.
pub struct Setting {
    pub(crate) screen: Screen,
    pub(crate) camera: Camera,
    pub(crate) instance: Instance,
}

impl Setting {
    /// In the crate's number formats.
    ///
    /// # Errors
    /// A size, a camera or a light that is out of the crate's ranges.
    pub fn new(prepared: &Prepared, view: &View) -> Result<Self, DrawFailure> {
        let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
        let screen = Screen::new(view.width as u16, view.height as u16).map_err(|e| bad(&e))?;
        let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
        let far = prepared
            .centre
            .iter()
            .fold(0.0f64, |far, c| far.max(c.abs()));
        if far.max(prepared.scale) > 2f64.powi(90) {
            return Err(bad(
                &"the model is too large, or too far away: its coordinates must be below 2^90",
            ));
        }
        // The model's middle is the origin, so that floats are spent on distances that matter.
        let from_centre = |p: [f64; 3]| [0, 1, 2].map(|i| (p[i] - prepared.centre[i]) as f32);
        let unit = |v: [f64; 3]| {
            let largest = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
            v.map(|c| (c / largest) as f32)
        };
        let camera = Camera::look_at(
            from_centre(view.eye),
            from_centre(view.at),
            unit(view.up),
            focal as f32,
            view.near as f32,
            view.far as f32,
        )
        .map_err(|e| bad(&e))?;
        let light = Light::new(unit(view.light), view.ambient as f32);
        let instance = Instance {
            model: prepared
                .model_matrix()
                .ok_or_else(|| bad(&"the model is too large"))?,
            cull: match view.cull {
                Cull::Back => scanbeam::Cull::Back,
                Cull::None => scanbeam::Cull::None,
            },
            light: light.filter(|_| view.shade != Shade::None),
            colour: [255; 3],
        };
        Ok(Self {
            screen,
            camera,
            instance,
        })
    }

    /// Builds the scene of `lines` of a model and hands it to `draw`; in several bands from top to bottom where it does
    /// not fit the arenas as a whole.
    ///
    /// # Errors
    /// What `draw` says, or a mesh that the scene refuses.
    pub fn bands<P: Pipeline>(
        &self,
        prepared: &Prepared,
        rooms: &mut SceneRooms<P>,
        lines: Range<u16>,
        draw: impl FnMut(&Scene<'_, P>) -> Result<(), DrawFailure>,
    ) -> Result<Bands, DrawFailure> {
        let build = |scene: &mut Scene<'_, P>, chunk: usize, alone: bool| {
            prepared.chunks[chunk].draw(scene, &self.instance, alone)
        };
        self.bands_of((rooms, lines), (prepared.chunks.len(), build), draw)
    }

    /// Builds the scene of `lines` and hands it to `draw`; in several bands from top to bottom
    /// where it does not fit the arenas as a whole. A line that does not fit by itself shows what
    /// does.
    pub(crate) fn bands_of<P: Pipeline>(
        &self,
        (rooms, lines): (&mut SceneRooms<P>, Range<u16>),
        (steps, mut build): (
            usize,
            impl FnMut(&mut Scene<'_, P>, usize, bool) -> Result<(), DrawError>,
        ),
        mut draw: impl FnMut(&Scene<'_, P>) -> Result<(), DrawFailure>,
    ) -> Result<Bands, DrawFailure> {
        let mut scene = rooms.scene(self.screen);
        let mut bands = Bands::default();
        let mut start = lines.start;
        let mut count = lines.len() as u16;
        // Chunks whose triangles bring their own vertices.
        let mut alone = vec![false; steps];
        while start < lines.end {
            count = count.min(lines.end - start);
            scene
                .begin_band(&self.camera, start..start + count)
                .map_err(|error| DrawFailure::View(error.to_string()))?;
            let mut full = None;
            let mut changed = false;
            for (step, alone) in alone.iter_mut().enumerate() {
                let before = scene.pass_one();
                match build(&mut scene, step, *alone) {
                    Ok(()) => {}
                    Err(error @ DrawError::Full(_)) => {
                        full.get_or_insert(error);
                        if count > 1 {
                            break;
                        }
                    }
                    Err(error) => return Err(DrawFailure::View(error.to_string())),
                }
                let after = scene.pass_one();
                let (vertices, objects) = (
                    after.vertices - before.vertices,
                    after.objects - before.objects,
                );
                // A chunk most of which lies outside the band takes less room without sharing.
                if !*alone && vertices > 3 * objects {
                    *alone = true;
                    changed = true;
                }
            }
            if let Some(error) = full {
                if changed {
                    continue;
                }
                if count > 1 {
                    // Fewer lines have fewer triangles.
                    count = count.div_ceil(2);
                    continue;
                }
                let overfull = bands.overfull.get_or_insert_with(|| Overfull {
                    line: start,
                    lines: 0,
                    triangles: 0,
                    first: error.to_string(),
                });
                overfull.lines += 1;
                overfull.triangles += scene.pass_one().dropped;
            }
            draw(&scene)?;
            bands.count += 1;
            start += count;
        }
        Ok(bands)
    }

    /// Replaces the sums over bands by counts of the whole picture, in which a triangle that is
    /// on several bands is one. Pass one runs again for that, a few thousand triangles at a time,
    /// so that they fit.
    pub(crate) fn count_once<P: Pipeline>(
        &self,
        prepared: &Prepared,
        rooms: &mut SceneRooms<P>,
        counts: &mut PassOne,
    ) -> Result<(), DrawFailure> {
        // With the vertices of a chunk and 8 more for each that is clipped: below 65,536.
        const TRIANGLES: usize = 7000;
        *counts = PassOne {
            dropped: counts.dropped,
            untextured: counts.untextured,
            ..PassOne::default()
        };
        let mut scene = rooms.scene(self.screen);
        for chunk in &prepared.chunks {
            // Parts of a chunk share its vertices, and are skipped together.
            let shared = chunk.positions.len() as u32;
            let (mut is_kept, mut is_skipped) = (false, false);
            for faces in chunk.faces.chunks(TRIANGLES) {
                scene
                    .begin(&self.camera)
                    .map_err(|error| DrawFailure::View(error.to_string()))?;
                let mesh = Mesh {
                    faces: Faces::Triangles(faces),
                    ..chunk.mesh()
                };
                match scene.draw_within(&mesh, &self.instance, &chunk.sphere) {
                    // What found no room was not culled, and only that is asked here.
                    Ok(_) | Err(DrawError::Full(_)) => {}
                    Err(error) => return Err(DrawFailure::View(error.to_string())),
                }
                let done = scene.pass_one();
                counts.triangles += done.triangles;
                counts.culled += done.culled;
                counts.clipped += done.clipped;
                counts.objects += done.objects;
                counts.vertices += done.vertices.saturating_sub(shared);
                counts.triangles_skipped += done.triangles_skipped;
                is_kept |= done.vertices > 0;
                is_skipped |= done.meshes_skipped > 0;
            }
            if is_kept {
                counts.vertices += shared;
            }
            if is_skipped {
                counts.meshes_skipped += 1;
                counts.vertices_skipped += shared;
            }
        }
        Ok(())
    }
}
