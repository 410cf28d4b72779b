//! Pass one: meshes into the slow arena, each object under the first line it is on (K1, S3).

mod read;

use super::error::{DrawError, SceneError};
use super::filing::Filing;
use super::instance::Instance;
use super::spans::scale;
use crate::active::Buckets;
use crate::arena::Arena;
use crate::composite::TextureSource;
use crate::geometry::{
    Affine, Assembled, Assembler, Camera, Coordinate, Cull, LightingModel, Looks, Mesh, MeshError,
    Screen, ScreenMesh, ScreenVertex, Shading, Sphere, Store, Surfaced, on_screen, triangles,
};
use crate::link::Link;
use crate::pipeline::{ObjectOf, Pipeline, SkinOf, VertexOf};
use crate::stats::PassOne;
use core::ops::Range;

/// The memory of a scene, lent by the application; best in large, slow RAM.
///
/// A vertex of a Gouraud pipeline is 12 bytes, an object 8.
pub struct SceneMemory<'m, P: Pipeline> {
    /// Vertices on the screen; at most 65,536 are used.
    pub vertices: &'m mut [VertexOf<P>],
    /// Objects; at most 61,440 are used.
    pub objects: &'m mut [ObjectOf<P>],
    /// One for each line of the picture, or of the largest band that is begun.
    pub buckets: &'m mut [Link],
}

/// A scene in memory: shared by any number of line renderers, read-only while they draw.
pub struct Scene<'m, P: Pipeline> {
    screen: Screen,
    camera: Option<Camera>,
    store: Store<'m, P::Shading>,
    objects: Arena<'m, ObjectOf<P>>,
    buckets: Buckets<'m>,
    /// Lines of the picture that are drawn.
    lines: Range<u16>,
    pass_one: PassOne,
    textures: P::Textures,
    /// Counts changes of the content, so that a renderer notices them.
    generation: u32,
}

impl<'m, P: Pipeline> Scene<'m, P> {
    /// An empty scene for pictures of the size of `screen`.
    #[must_use]
    pub fn new(screen: Screen, memory: SceneMemory<'m, P>) -> Self {
        let objects = memory.objects.len().min(usize::from(Link::CACHED));
        Self {
            screen,
            camera: None,
            store: Store {
                vertices: Arena::new(memory.vertices),
            },
            objects: Arena::new(&mut memory.objects[..objects]),
            buckets: Buckets::new(memory.buckets),
            lines: 0..0,
            pass_one: PassOne::default(),
            textures: P::Textures::default(),
            generation: 0,
        }
    }

    /// Empties the scene and begins a whole picture seen by `camera`.
    ///
    /// # Errors
    /// When there are fewer buckets than lines.
    pub fn begin(&mut self, camera: &Camera) -> Result<(), SceneError> {
        self.begin_band(camera, 0..self.screen.height())
    }

    /// Empties the scene and begins the `lines` of a picture; what is on other lines alone is
    /// culled. Bands one after the other give the same picture as all at once, with smaller
    /// arenas (H18).
    ///
    /// # Errors
    /// When the lines are not within the picture, or are more than there are buckets; then the
    /// scene is as it was.
    pub fn begin_band(&mut self, camera: &Camera, lines: Range<u16>) -> Result<(), SceneError> {
        let height = self.screen.height();
        if lines.start >= lines.end || lines.end > height {
            return Err(SceneError::Lines {
                start: lines.start,
                end: lines.end,
                height,
            });
        }
        let have = self.buckets.room();
        if lines.len() > have {
            return Err(SceneError::Buckets {
                needed: lines.len() as u16,
                have,
            });
        }
        let top = self.screen.top();
        self.buckets
            .reset(top + i32::from(lines.start)..top + i32::from(lines.end));
        self.store.vertices.clear();
        self.objects.clear();
        self.lines = lines;
        self.camera = Some(*camera);
        self.pass_one = PassOne::default();
        self.generation = self.generation.wrapping_add(1);
        Ok(())
    }

    /// Lends the textures that [`draw_skinned`](Scene::draw_skinned) names by number; at first
    /// there are none. They stay until others are lent.
    ///
    /// Lend them before what they are on is drawn: pass one asks how a texture goes on beyond its
    /// sides. One that is not there yet is taken to repeat every 8,192 texels.
    pub fn set_textures(&mut self, textures: P::Textures) {
        self.textures = textures;
    }

    /// The textures lent.
    #[inline(always)]
    pub(crate) fn textures(&self) -> P::Textures {
        self.textures
    }

    /// Draws a mesh into the scene. Before [`begin`](Scene::begin) it does nothing.
    ///
    /// # Errors
    /// [`DrawError::Full`] when an arena had no room for all of it: what was kept is drawn.
    /// [`DrawError::Mesh`] when the mesh contradicts itself: nothing of it is drawn.
    pub fn draw<C: Coordinate, L: LightingModel>(
        &mut self,
        mesh: &Mesh<'_, C>,
        instance: &Instance<L>,
    ) -> Result<Assembled, DrawError> {
        self.draw_skinned(mesh, SkinOf::<P>::default(), instance)
    }

    /// [`draw`](Scene::draw) with what the mesh brings beside its colours: in pipelines such as
    /// [`TexturedDepth`](crate::pipeline::TexturedDepth) a [`Skin`](crate::pipeline::texture::Skin).
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); a skin that is neither empty nor as long as the mesh's positions
    /// is a [`MeshError::AttributeLength`].
    pub fn draw_skinned<C: Coordinate, L: LightingModel>(
        &mut self,
        mesh: &Mesh<'_, C>,
        skin: SkinOf<'_, P>,
        instance: &Instance<L>,
    ) -> Result<Assembled, DrawError> {
        self.draw_known((mesh, usize::MAX), skin, instance)
    }

    /// [`draw_skinned`](Scene::draw_skinned) of a mesh whose indices are known to be below a
    /// number, so that they are not looked at once more.
    pub(crate) fn draw_known<C: Coordinate, L: LightingModel>(
        &mut self,
        mesh: (&Mesh<'_, C>, usize),
        skin: SkinOf<'_, P>,
        instance: &Instance<L>,
    ) -> Result<Assembled, DrawError> {
        self.assemble(instance, skin, |assembler, mut filing| {
            assembler.mesh(mesh, |object, first| filing.file(object, first))
        })
    }

    /// Draws triangles whose vertices were set up beforehand: no camera, no light, and nothing to
    /// clip (H11). Before [`begin`](Scene::begin) it does nothing.
    ///
    /// # Errors
    /// As [`draw_skinned`](Scene::draw_skinned).
    pub fn draw_screen(
        &mut self,
        vertices: &[ScreenVertex],
        triangles: &[[u16; 3]],
        skin: SkinOf<'_, P>,
        cull: Cull,
    ) -> Result<Assembled, DrawError> {
        if self.camera.is_none() {
            return Ok(Assembled::default());
        }
        let skin = self.known(skin);
        let mut filing = Filing::<P> {
            objects: &mut self.objects,
            buckets: &mut self.buckets,
        };
        let done = on_screen(
            &mut self.store,
            self.screen,
            self.lines.clone(),
            Surfaced {
                scale: scale::<P>(),
                skin,
            },
            ScreenMesh {
                vertices,
                faces: triangles,
                cull,
            },
            |object, first| filing.file(object, first),
        );
        self.count(done)
    }

    /// Lets an assembler of meshes at `instance` run, and counts what it has done.
    #[inline(always)]
    pub(super) fn assemble<'k, L: LightingModel>(
        &mut self,
        instance: &Instance<L>,
        skin: SkinOf<'k, P>,
        run: impl FnOnce(
            Assembler<'_, 'm, 'k, P::Shading, L::InModel>,
            Filing<'_, 'm, P>,
        ) -> Result<Assembled, MeshError>,
    ) -> Result<Assembled, DrawError> {
        let skin = self.known(skin);
        let Some(camera) = &self.camera else {
            return Ok(Assembled::default());
        };
        let assembler = Assembler::new(
            &mut self.store,
            camera,
            self.screen,
            self.lines.clone(),
            &instance.model,
            Looks {
                cull: instance.cull,
                light: instance.light,
                colour: instance.colour,
            },
            Surfaced {
                scale: scale::<P>(),
                skin,
            },
        );
        let filing = Filing {
            objects: &mut self.objects,
            buckets: &mut self.buckets,
        };
        let done = run(assembler, filing);
        self.count(done)
    }

    /// The skin with what the textures lent say of its own.
    #[inline(always)]
    fn known<'k>(&self, skin: SkinOf<'k, P>) -> SkinOf<'k, P> {
        let textures = &self.textures;
        P::Shading::known(skin, |number| {
            TextureSource::<P::Pixel>::period(textures, number)
        })
    }

    /// Counts what an assembler has done.
    #[inline(always)]
    fn count(&mut self, done: Result<Assembled, MeshError>) -> Result<Assembled, DrawError> {
        self.generation = self.generation.wrapping_add(1);
        let done = done.map_err(DrawError::Mesh)?;
        self.pass_one.triangles += done.triangles;
        self.pass_one.culled += done.culled;
        self.pass_one.clipped += done.clipped;
        self.pass_one.untextured += done.untextured;
        self.pass_one.objects = self.objects.len() as u32;
        self.pass_one.vertices = self.store.vertices.len() as u32;
        match done.dropped {
            Some(dropped) => {
                self.pass_one.dropped += dropped.triangles;
                Err(DrawError::Full(dropped))
            }
            None => Ok(done),
        }
    }

    /// Draws a mesh all of whose vertices lie in `sphere`, as [`draw`](Scene::draw) does, but does
    /// not look at it when the sphere is wholly outside the picture or the band, or nearer or
    /// farther than what is seen (M4). The picture is the same; [`PassOne`] counts what is skipped.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); a mesh that is skipped is not checked for contradictions.
    pub fn draw_within<C: Coordinate, L: LightingModel>(
        &mut self,
        mesh: &Mesh<'_, C>,
        instance: &Instance<L>,
        sphere: &Sphere,
    ) -> Result<Assembled, DrawError> {
        match self.skip_outside(mesh, instance, sphere) {
            Some(done) => Ok(done),
            None => self.draw(mesh, instance),
        }
    }

    /// Whether nothing within the sphere can be seen at `model`. Before [`begin`](Scene::begin)
    /// everything can.
    pub(crate) fn is_outside(&self, sphere: &Sphere, model: &Affine) -> bool {
        let beyond = |camera: &Camera| sphere.is_outside(camera, self.screen, &self.lines, model);
        self.camera.as_ref().is_some_and(beyond)
    }

    /// What [`draw_within`](Scene::draw_within) does with a mesh whose sphere is outside of the
    /// picture: counts it, and nothing else; `None` when it has to be drawn.
    pub fn skip_outside<C: Coordinate, L>(
        &mut self,
        mesh: &Mesh<'_, C>,
        instance: &Instance<L>,
        sphere: &Sphere,
    ) -> Option<Assembled> {
        if !self.is_outside(sphere, &instance.model) {
            return None;
        }
        let done = Assembled {
            triangles: triangles(mesh.faces),
            culled: triangles(mesh.faces),
            ..Assembled::default()
        };
        self.pass_one.triangles += done.triangles;
        self.pass_one.culled += done.culled;
        self.pass_one.meshes_skipped += 1;
        self.pass_one.triangles_skipped += done.triangles;
        self.pass_one.vertices_skipped += mesh.positions.len() as u32;
        Some(done)
    }
}
