//! Baked lists, run from flash: the teapot, and a crate with its textures (H7, H11).

use crate::ShotError;
use scanbeam::event::Notice;
use scanbeam::input::{ListMemory, ListRunner, ListSettings, RunCounts};
use scanbeam::list::{Budget, Halt, ListError, TextureSlot, words_of};
use scanbeam::pipeline::texture::ListTextures;
use scanbeam::pipeline::{Instance, Pipeline, Scene};
use scanbeam::{Affine, Camera, Light, include_list};

/// Vertices of the list's largest table, which its HEAD says.
pub const LIST_TABLE: usize = 255;
/// Indices that are drawn together: those of a table's triangles.
pub const LIST_INDICES: usize = 1536;

/// Vertices of the crate's largest table.
pub const CRATE_TABLE: usize = 16;
/// Indices of the crate that are drawn together.
pub const CRATE_INDICES: usize = 48;
/// Slots for the crate's two textures, their palettes, and both pairs.
pub const CRATE_TEXTURES: usize = 6;

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

/// The crate, as it lies in flash.
///
/// # Errors
/// None: it is aligned.
pub fn crate_list() -> Result<&'static [u32], ListError> {
    words_of(include_list!(concat!(env!("OUT_DIR"), "/crate.list")))
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
    let list = teapot_list().map_err(ListedError::List)?;
    begin(scene, [0.0, 1.2, 2.6])?;
    run(scene, memory, list)
}

/// Draws the crate from its list, from near enough that perspective counts, in the same light.
/// Texels are fetched from where they lie; the memory has [`CRATE_TABLE`] vertices with their
/// texture places, and there are [`CRATE_TEXTURES`] slots.
///
/// # Errors
/// When the scene or the memory is too small.
pub fn build_crate<'t, P>(
    scene: &mut Scene<'_, P>,
    memory: ListMemory<'_>,
    slots: &'t [TextureSlot],
) -> Result<RunCounts, ListedError>
where
    P: Pipeline<Textures = ListTextures<'t>>,
{
    let words = crate_list().map_err(ListedError::List)?;
    begin(scene, [0.3, 1.7, 2.4])?;
    scene.set_textures(ListTextures { words, slots });
    let memory = ListMemory {
        textures: slots,
        ..memory
    };
    run(scene, memory, words)
}

fn begin<P: Pipeline>(scene: &mut Scene<'_, P>, eye: [f32; 3]) -> Result<(), ListedError> {
    let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 300.0, 0.1, 100.0);
    let camera = camera.map_err(|e| ListedError::Shot(ShotError::Camera(e)))?;
    let begun = scene.begin(&camera);
    begun.map_err(|e| ListedError::Shot(ShotError::Scene(e)))
}

fn run<P: Pipeline>(
    scene: &mut Scene<'_, P>,
    memory: ListMemory<'_>,
    list: &[u32],
) -> Result<RunCounts, ListedError> {
    let settings = ListSettings {
        instance: instance(),
        ..ListSettings::default()
    };
    let mut runner = ListRunner::new(memory, settings);
    runner.start(0);
    let halt = runner
        .run(list, scene, &mut Budget::of(1 << 16), &mut |_: Notice| {})
        .map_err(ListedError::List)?;
    let counts = runner.counts();
    match halt {
        Halt::End if counts.dropped == 0 => Ok(counts),
        halt => Err(ListedError::Halted(halt)),
    }
}
