//! The triangles of a model counted once each, where a picture has several parts, or triangles are drawn again.

use crate::DrawFailure;
use crate::parts::{Job, MOST_OBJECTS, MOST_VERTICES, Step, Tile, tiles};
use crate::prepared::Chunk;
use host_support::rooms::{Room, SceneRooms};
use scanbeam::Camera;
use scanbeam::look::Look;
use std::ops::Range;

/// Triangles that are drawn at a time: with the vertices of a part, and 20 more for each that is flat and clipped, they
/// are below 65,536.
const AT_ONCE: usize = 3000;

/// What a whole picture has of a model.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Triangles {
    pub(crate) triangles: u32,
    /// Those that are on no line.
    pub(crate) culled: u32,
    /// Those that cross a near, far or guard plane.
    pub(crate) clipped: u32,
    /// Records made of the others, and vertices; in each tile anew.
    pub(crate) objects: usize,
    pub(crate) vertices: usize,
}

/// What is found of a triangle.
#[derive(Debug, Default, Clone, Copy)]
struct Mark {
    is_seen: bool,
    is_clipped: bool,
}

/// Runs pass one again, a few thousand triangles at a time, so that they fit a scene.
///
/// On several tiles, where a triangle may be seen on any, each that may be is looked at alone.
pub(crate) fn count_triangles<'t, L: Look>(
    job: &Job,
    counted: &[Option<&Chunk>],
    step: &mut Step<'_, 't, L>,
) -> Result<Triangles, DrawFailure> {
    let mut all = Triangles::default();
    let alone = tiles(job).count() > 1;
    let room = Room {
        vertices: MOST_VERTICES,
        places: if L::TEXTURED { MOST_VERTICES } else { 0 },
        objects: MOST_OBJECTS,
        draws: 1,
    };
    let faces = |chunk: &Option<&Chunk>| chunk.map_or(0, |chunk| chunk.faces.len());
    let mut found: Vec<_> = counted
        .iter()
        .map(|chunk| vec![Mark::default(); faces(chunk)])
        .collect();
    for tile in tiles(job) {
        let camera = match tile.camera(job) {
            Err(_) if job.is_ahead => continue,
            camera => camera?,
        };
        let mut memory = SceneRooms::new(room, tile.size[1]);
        let mut scene = memory.scene::<L>(tile.screen()?);
        for (number, (chunk, marks)) in counted.iter().zip(&mut found).enumerate() {
            let Some(chunk) = chunk else { continue };
            let mut draw = |part: &Chunk| -> Result<Triangles, DrawFailure> {
                let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
                scene.begin(&camera).map_err(|error| bad(&error))?;
                let drawn = step(&mut scene, &tile, number, Some(part));
                drawn.map_err(|error| bad(&error))?;
                let done = scene.assembled();
                Ok(Triangles {
                    triangles: done.triangles,
                    culled: done.culled,
                    clipped: done.clipped,
                    objects: scene.objects(),
                    vertices: scene.vertices(),
                })
            };
            all.add_chunk(chunk, alone.then_some(marks), &mut draw)?;
        }
    }
    if alone {
        for mark in found.iter().flatten() {
            all.triangles += 1;
            all.culled += u32::from(!mark.is_seen);
            all.clipped += u32::from(mark.is_clipped);
        }
    }
    Ok(all)
}

/// The lines of a tile that each triangle of each part of the model may be on, each drawn alone.
pub(crate) fn lines_of_faces<'t, L: Look>(
    camera: &Camera,
    tile: &Tile,
    counted: &[Option<&Chunk>],
    step: &mut Step<'_, 't, L>,
) -> Result<Vec<Vec<Range<i32>>>, DrawFailure> {
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let room = Room {
        vertices: ONE,
        places: if L::TEXTURED { ONE } else { 0 },
        objects: ONE,
        draws: 1,
    };
    let mut memory = SceneRooms::new(room, tile.size[1]);
    let mut scene = memory.scene::<L>(tile.screen()?);
    let mut all = Vec::new();
    for (number, chunk) in counted.iter().enumerate() {
        let mut of_chunk = Vec::new();
        for face in 0..chunk.map_or(0, |chunk| chunk.faces.len()) {
            let part = chunk.map(|chunk| chunk.alone(face));
            scene.begin(camera).map_err(|error| bad(&error))?;
            let drawn = step(&mut scene, tile, number, part.as_ref());
            drawn.map_err(|error| bad(&error))?;
            let lines = scene.triangles().map(|triangle| triangle.lines());
            let both = |a: Range<i32>, b: Range<i32>| a.start.min(b.start)..a.end.max(b.end);
            of_chunk.push(lines.reduce(both).unwrap_or_default());
        }
        all.push(of_chunk);
    }
    Ok(all)
}

/// Room for a triangle, flat and clipped.
const ONE: usize = 64;

impl Triangles {
    /// Adds what a tile has of a part of the model. Where there are marks, its triangles are marked and not counted.
    fn add_chunk(
        &mut self,
        chunk: &Chunk,
        mut marks: Option<&mut Vec<Mark>>,
        draw: &mut dyn FnMut(&Chunk) -> Result<Self, DrawFailure>,
    ) -> Result<(), DrawFailure> {
        // Parts of a part share its vertices.
        let shared = chunk.positions.len();
        let mut is_kept = false;
        for first in (0..chunk.faces.len()).step_by(AT_ONCE) {
            let faces = first..(first + AT_ONCE).min(chunk.faces.len());
            let had = draw(&chunk.some(faces.clone()))?;
            is_kept |= had.objects > 0;
            self.objects += had.objects;
            self.vertices += had.vertices.saturating_sub(shared);
            let Some(marks) = &mut marks else {
                self.triangles += had.triangles;
                self.culled += had.culled;
                self.clipped += had.clipped;
                continue;
            };
            if had.objects == 0 {
                continue;
            }
            for face in faces {
                let had = draw(&chunk.alone(face))?;
                let is_seen = had.objects > 0;
                marks[face].is_seen |= is_seen;
                marks[face].is_clipped |= is_seen && had.clipped > 0;
            }
        }
        self.vertices += if is_kept { shared } else { 0 };
        Ok(())
    }
}
