//! Shadow volumes into a scene (K9).
//!
//! A scene with shadows has three kinds of surfaces: those that are seen, drawn as always; the
//! volumes, from [`Scene::draw_shadow`]; and the seen ones again, with what a light's shadow makes
//! of them: [`Finish::in_shadow`], with the colours they have there, for one light, or
//! [`Finish::lit_by`], with what one light adds, for several. Which of them a pixel gets is
//! counted on each line; lines without volumes go the usual way.

use super::error::DrawError;
use super::instance::Instance;
use super::scene::Scene;
use crate::geometry::{
    Affine, Assembled, Blended, Coordinate, Cull, DepthFunction, Extrusion, Faces, Finish, Mesh,
    Shading, ShadowLight, ShadowMemory, ShadowRoom, Surface, check,
};
use crate::pipeline::Pipeline;

/// Why a shadow was not drawn, or not all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ShadowError {
    /// The memory lent for the volume is too short; nothing of it is drawn.
    Room(ShadowRoom),
    /// What [`Scene::draw`] says.
    Draw(DrawError),
}

impl core::fmt::Display for ShadowError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Room(room) => write!(f, "shadow: no room for all {room}"),
            Self::Draw(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ShadowError {}

impl<P, S> Scene<'_, P>
where
    S: Shading,
    P: Pipeline<Shading = Blended<S>>,
{
    /// Draws the shadow volume of a mesh that stands at `model`: what is inside is in the shadow of
    /// the light. Before [`begin`](Scene::begin) it does nothing.
    ///
    /// The mesh should be closed; of one that is not, faces that look at the light cast shadows.
    /// Where `model` stretches it, it must do so by the same factor in all directions. The camera
    /// may be inside the volume.
    ///
    /// Pipelines whose depth is [`ShadowDepth32`](crate::pipeline::blend::ShadowDepth32), such as
    /// [`Shadowed`](crate::pipeline::Shadowed), show it; others do not.
    ///
    /// # Errors
    /// [`ShadowError::Room`] when memory is too short, and those of [`draw`](Scene::draw): what
    /// was kept of a volume then is wrong. Of a mesh that contradicts itself nothing is drawn.
    pub fn draw_shadow<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        model: &Affine,
        light: &ShadowLight,
        mut memory: ShadowMemory<'_>,
    ) -> Result<Assembled, ShadowError> {
        check(mesh).map_err(|error| ShadowError::Draw(DrawError::Mesh(error)))?;
        let extrusion = Extrusion::new(light, model);
        let sides = extrusion
            .sides(mesh, &mut memory)
            .map_err(ShadowError::Room)?;
        let instance = Instance {
            model: extrusion.model(model),
            cull: Cull::None,
            ..Instance::default()
        };
        let volume = Mesh {
            positions: sides.positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(sides.faces),
        };
        let finish = Finish::volume(light.light);
        let mut done = self
            .draw_skinned(&volume, Surface::from(finish), &instance)
            .map_err(ShadowError::Draw)?;
        // In front of all that is seen, wherever rounding puts it.
        let cap = Finish {
            colour_if: DepthFunction::ALWAYS,
            ..finish
        };
        let near = self
            .assemble(&instance, Surface::from(cap), |assembler, mut filing| {
                if !assembler.is_near(&extrusion, mesh) {
                    return Ok(Assembled::default());
                }
                Ok(
                    assembler.near_cap(&extrusion, mesh, &sides, |object, first, vertices| {
                        filing.file(object, first, vertices)
                    }),
                )
            })
            .map_err(ShadowError::Draw)?;
        done.triangles += near.triangles;
        done.kept += near.kept;
        Ok(done)
    }
}
