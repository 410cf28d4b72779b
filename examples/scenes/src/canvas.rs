//! What test scenes are drawn into.

use crate::ShotError;
use scanbeam::look::Look;
use scanbeam::mesh::Coordinate;
use scanbeam::pipeline::{Instance, Pipeline, Scene as PresetScene};
use scanbeam::{Camera, Draw, Scene};

/// Takes a camera and draw calls.
pub trait Canvas {
    /// Begins a picture.
    ///
    /// # Errors
    /// When the memory has too few lines.
    fn begin(&mut self, camera: &Camera) -> Result<(), ShotError>;

    /// Draws a mesh.
    ///
    /// # Errors
    /// When the memory is too small.
    fn draw<C: Coordinate>(&mut self, call: &Draw<'_, 'static, C>) -> Result<(), ShotError>;
}

impl<L: Look> Canvas for Scene<'_, '_, L> {
    fn begin(&mut self, camera: &Camera) -> Result<(), ShotError> {
        Scene::begin(self, camera).map_err(ShotError::Begin)
    }

    fn draw<C: Coordinate>(&mut self, call: &Draw<'_, 'static, C>) -> Result<(), ShotError> {
        Scene::draw(self, call).map(|_| ()).map_err(ShotError::Draw)
    }
}

/// Without textures.
impl<P: Pipeline> Canvas for PresetScene<'_, P> {
    fn begin(&mut self, camera: &Camera) -> Result<(), ShotError> {
        PresetScene::begin(self, camera).map_err(ShotError::PresetScene)
    }

    fn draw<C: Coordinate>(&mut self, call: &Draw<'_, 'static, C>) -> Result<(), ShotError> {
        let instance = Instance {
            model: call.model,
            cull: call.cull,
            light: call.light,
            colour: call.colour,
        };
        PresetScene::draw(self, &call.mesh, &instance)
            .map(|_| ())
            .map_err(ShotError::Preset)
    }
}
