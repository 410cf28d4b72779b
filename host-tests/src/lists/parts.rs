//! Triangles into parts that lists pass over where they are turned away (X3, M4).

use super::strips::{Runs, strips_alone, strips_of};
use scanbeam::list::Cone;
use scanbeam::mesh::{CutError, Meshlet, Meshlets};
use std::collections::HashMap;

/// Triangles that are drawn together.
pub(super) struct Part {
    /// What tells from where they are seen from behind, where anything does; words are to be filled in.
    pub(super) cone: Option<Cone>,
    pub(super) runs: Runs,
}

/// Triangles that are cut at once: no more vertices than 16 bits can number.
const AT_ONCE: usize = 65_535 / 3;

/// All triangles as one part.
pub(super) fn whole(triangles: &[[u32; 3]]) -> Vec<Part> {
    let runs = strips_of(triangles);
    vec![Part { cone: None, runs }]
}

/// Triangles as parts that are near to each other, of vertices at `places` in Q1.30.
///
/// # Errors
/// None: they have their vertices, and there is room.
pub(super) fn parts_of(triangles: &[[u32; 3]], places: &[[i32; 3]]) -> Result<Vec<Part>, CutError> {
    let mut all = Vec::new();
    for some in triangles.chunks(AT_ONCE) {
        cut(some, places, &mut all)?;
    }
    Ok(all)
}

fn cut(triangles: &[[u32; 3]], places: &[[i32; 3]], all: &mut Vec<Part>) -> Result<(), CutError> {
    let (mut known, mut numbers) = (HashMap::new(), Vec::new());
    let mut number = |vertex: u32| {
        *known.entry(vertex).or_insert_with(|| {
            numbers.push(vertex);
            numbers.len() as u16 - 1
        })
    };
    let mut faces: Vec<[u16; 3]> = triangles.iter().map(|t| t.map(&mut number)).collect();
    let positions: Vec<_> = numbers.iter().map(|v| places[*v as usize]).collect();
    let mut parts = vec![Meshlet::EMPTY; faces.len() / 11 + 1];
    let mut vertices = vec![0; 3 * faces.len()];
    let cut = Meshlets::cut(&positions, &mut faces, &mut parts, &mut vertices)?;
    let scanbeam::Faces::Triangles(mut rest) = cut.faces() else {
        return Ok(());
    };
    for part in cut.parts() {
        let (some, others) = rest.split_at(part.faces.into());
        rest = others;
        let some: Vec<_> = some
            .iter()
            .map(|f| f.map(|i| numbers[usize::from(i)]))
            .collect();
        let cone = (part.axis != [0; 3]).then_some(Cone {
            apex: part.apex,
            axis: part.axis,
            spread: part.spread,
            words: 0,
        });
        all.push(Part {
            cone,
            runs: strips_alone(&some),
        });
    }
    Ok(())
}
