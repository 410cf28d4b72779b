//! Scenes of the suite whose mesh is drawn in parts, so that what is turned away is not looked at.

use crate::{ShotError, Suite};
use scanbeam::look::Look;
use scanbeam::mesh::{CutError, Meshlet, Meshlets};
use scanbeam::{Faces, Scene};

/// Those scenes, as frames.
pub const IN_PARTS: [(&str, Suite); 3] = [
    ("a_meshlets", Suite::A),
    ("g_meshlets", Suite::G),
    ("teapot_meshlets", Suite::Teapot),
];

/// Memory in which meshes are cut.
#[derive(Debug, Default)]
pub struct CutMemory<'m> {
    /// [`CutMemory::FACES`] for all scenes.
    pub faces: &'m mut [[u16; 3]],
    /// [`CutMemory::PARTS`], likewise.
    pub parts: &'m mut [Meshlet],
    /// [`CutMemory::VERTICES`], likewise.
    pub vertices: &'m mut [u16],
}

impl CutMemory<'_> {
    /// Faces of all of them.
    pub const FACES: usize = 12_496;
    /// Their parts, and more.
    pub const PARTS: usize = Self::FACES / 16;
    /// Entries of vertices of their parts, and more.
    pub const VERTICES: usize = Self::FACES / 2 * 3;
}

/// A scene of one mesh, cut.
#[derive(Clone, Copy, Debug)]
pub struct InParts<'m> {
    /// The scene.
    pub suite: Suite,
    meshlets: Meshlets<'m>,
}

impl<'m> InParts<'m> {
    /// Cuts the mesh of a scene in some of the memory.
    ///
    /// # Errors
    /// When that does not suffice.
    pub fn new(suite: Suite, memory: &mut CutMemory<'m>) -> Result<Self, CutError> {
        let mesh = suite.part(0).mesh;
        let from = match mesh.faces {
            Faces::Triangles(faces) => faces,
            _ => &[],
        };
        let faces = memory.faces.split_off_mut(..from.len());
        let faces = faces.unwrap_or_default();
        for (to, face) in faces.iter_mut().zip(from) {
            *to = *face;
        }
        let parts = memory.parts.split_off_mut(..from.len() / 16);
        let vertices = memory.vertices.split_off_mut(..from.len() / 2 * 3);
        let (parts, vertices) = (parts.unwrap_or_default(), vertices.unwrap_or_default());
        let meshlets = Meshlets::cut(mesh.positions, faces, parts, vertices)?;
        Ok(Self { suite, meshlets })
    }

    /// Draws it into `scene`, as [`Suite::build`] does.
    ///
    /// # Errors
    /// As that.
    pub fn build<L: Look>(&self, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
        scene.begin(&self.suite.view().camera()?)?;
        scene.draw_meshlets(&self.suite.part(0).draw(), &self.meshlets)?;
        Ok(())
    }
}
