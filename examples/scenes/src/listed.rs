//! The teapot as a baked list, run from flash (H11).

use crate::ShotError;
use scanbeam::list::{Budget, Halt, ListError, words_of};
use scanbeam::{
    Affine, Camera, Instance, Light, ListMemory, ListRunner, ListSettings, Notice, Pipeline,
    RunCounts, Scene, include_list,
};

/// Vertices of the list's largest table, which its HEAD says.
pub const LIST_TABLE: usize = 255;
/// Indices that are drawn together: those of a table's triangles.
pub const LIST_INDICES: usize = 1536;

/// Why the list was not drawn whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ListedError {
    /// The camera or the scene.
    Shot(ShotError),
    /// The list is malformed.
    List(ListError),
    /// It halted before its end, or found no room.
    Halted(Halt),
}

/// The list, as it lies in flash.
///
/// # Errors
/// None: it is aligned.
pub fn teapot_list() -> Result<&'static [u32], ListError> {
    words_of(include_list!(concat!(env!("OUT_DIR"), "/teapot.list")))
}

/// Where [`Shot::Teapot`](crate::Shot::Teapot) stands, and how it is lit.
fn instance() -> Instance {
    Instance {
        model: Affine::rotation_y(0.6),
        light: Light::new([0.3, 0.8, 0.6], 0.2),
        ..Instance::default()
    }
}

/// Draws [`Shot::Teapot`](crate::Shot::Teapot) from the list. Places are used where they lie, so only normals need
/// room for [`LIST_TABLE`] vertices.
///
/// # Errors
/// When the scene or the memory is too small.
pub fn build_listed<P: Pipeline>(
    scene: &mut Scene<'_, P>,
    memory: ListMemory<'_>,
) -> Result<RunCounts, ListedError> {
    let (eye, up) = ([0.0, 1.2, 2.6], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, [0.0; 3], up, 300.0, 0.1, 100.0);
    let camera = camera.map_err(|e| ListedError::Shot(ShotError::Camera(e)))?;
    let begun = scene.begin(&camera);
    begun.map_err(|e| ListedError::Shot(ShotError::Scene(e)))?;
    let settings = ListSettings {
        instance: instance(),
        ..ListSettings::default()
    };
    let mut runner = ListRunner::new(memory, settings);
    runner.start(0);
    let list = teapot_list().map_err(ListedError::List)?;
    let halt = runner
        .run(list, scene, &mut Budget::of(1 << 16), &mut |_: Notice| {})
        .map_err(ListedError::List)?;
    let counts = runner.counts();
    match halt {
        Halt::End if counts.dropped == 0 => Ok(counts),
        halt => Err(ListedError::Halted(halt)),
    }
}
