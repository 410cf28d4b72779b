//! What the proofs of the hot path share: memory for scenes and renderers, triangles whose
//! corners lie on chosen 1/8 pixels at chosen distances, and what is exact at a pixel.

pub mod count;
pub mod cover;
pub mod exact;
pub mod layers;
pub mod shine;
pub mod values;
pub mod ways;

use scanbeam::frame::{FastMemory, LineError, Memory as Lent, Renderer};
use scanbeam::look::{Gouraud, Look, Phong, Textured, TexturedPhong};
use scanbeam::pixel::{
    Grey8, Index4, Index8, PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888,
};
use scanbeam::scene::{Draw, DrawError, DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scanbeam::{Affine, Camera, Cull, Faces, Link, Mesh, Screen};

/// Distance of the near plane: what is 1 away is just behind it.
pub const NEAR: f64 = 1.0 - 1.0 / 1024.0;

/// The mesh of calls that draw triangles of the screen.
pub const NO_MESH: Mesh<'static> = Mesh {
    positions: &[],
    normals: &[],
    colours: &[],
    faces: Faces::Triangles(&[]),
};

/// Units of 1/8 pixel from the left and the top of the picture.
pub type Place = (i32, i32);

/// A corner: where it is seen, how far away, and its colour.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub at: Place,
    pub w: f64,
    pub colour: [u8; 3],
}

/// A smooth look whose words can be named.
pub trait Smooth: Look + 'static {
    type Format: PixelFormat;

    fn draw_line(
        renderer: &mut Renderer<'_, Self, 4>,
        scene: &Scene<'_, '_, Self>,
        line: u16,
        pixels: &mut [WordOf<Self>],
        background: WordOf<Self>,
    ) -> Result<bool, LineError>;
}

pub type WordOf<L> = <<L as Smooth>::Format as PixelFormat>::Word;

macro_rules! smooth {
    ($($look:ident<$format:ty>),+) => {$(
        impl Smooth for $look<$format> {
            type Format = $format;

            fn draw_line(
                renderer: &mut Renderer<'_, Self, 4>,
                scene: &Scene<'_, '_, Self>,
                line: u16,
                pixels: &mut [WordOf<Self>],
                background: WordOf<Self>,
            ) -> Result<bool, LineError> {
                renderer.draw_line(scene, line, pixels, background)
            }
        }
    )+};
}
smooth!(
    Gouraud<Rgb565>,
    Gouraud<Rgb565Be>,
    Gouraud<Rgb565Le>,
    Gouraud<Rgb888>,
    Gouraud<Xrgb8888>,
    Gouraud<Grey8>,
    Gouraud<Index8>,
    Gouraud<Index4>,
    Phong<Rgb565Be>,
    Phong<Rgb888>,
    Textured<Rgb565Be>,
    Textured<Rgb565Le>,
    Textured<Rgb565>,
    Textured<Rgb888>,
    Textured<Xrgb8888>,
    TexturedPhong<Rgb565Be>,
    TexturedPhong<Rgb888>
);

/// What a scene is lent.
pub struct SceneRooms {
    pub vertices: Vec<Vertex>,
    pub places: Vec<TexturePlace>,
    pub objects: Vec<Object>,
    pub bins: Vec<u16>,
    pub draws: Vec<DrawState<'static>>,
}

impl SceneRooms {
    pub fn new(vertices: usize, objects: usize, bins: usize, draws: usize) -> Self {
        Self {
            vertices: vec![Vertex::EMPTY; vertices],
            places: vec![TexturePlace::EMPTY; vertices],
            objects: vec![Object::EMPTY; objects],
            bins: vec![0; bins],
            draws: vec![DrawState::EMPTY; draws],
        }
    }

    /// Room for so many triangles with corners of their own, each in a draw call of its own.
    pub fn of_triangles(triangles: usize, screen: Screen) -> Self {
        Self::new(3 * triangles, triangles, screen.height().into(), triangles)
    }

    pub fn scene<L: Look>(&mut self, screen: Screen) -> Scene<'_, 'static, L> {
        Scene::new(
            screen,
            Memory {
                vertices: &mut self.vertices,
                places: &mut self.places,
                objects: &mut self.objects,
                bins: &mut self.bins,
                draws: &mut self.draws,
            },
        )
    }
}

/// What a renderer is lent.
pub struct LineRooms<L: Look> {
    pub cache: Box<FastMemory<L, 4>>,
    pub links: Vec<Link>,
    pub depth: Vec<u32>,
    /// One a pixel.
    pub counts: Vec<u8>,
}

impl<L: Look> LineRooms<L> {
    /// Enough for any line of `scene`, with so many slots, with depth or without.
    pub fn fitting(scene: &Scene<'_, '_, L>, slots: u16, depth: bool) -> Self {
        let mut cache = Box::new(FastMemory::new());
        cache.set_limit(slots);
        let cells = usize::from(scene.screen().width()) * usize::from(depth);
        Self {
            cache,
            links: vec![Link::EMPTY; scene.objects()],
            depth: vec![0; cells],
            counts: vec![77; scene.screen().width().into()],
        }
    }

    pub fn renderer(&mut self) -> Renderer<'_, L, 4> {
        Renderer::new(self.lent())
    }

    /// One that draws shadows.
    pub fn with_shadows(&mut self) -> Renderer<'_, L, 4> {
        let lent = Lent {
            cache: &mut self.cache,
            links: &mut self.links,
            depth: &mut self.depth,
        };
        Renderer::with_shadows(lent, &mut self.counts)
    }

    /// One that refuses draw calls with values that few have.
    pub fn plain(&mut self) -> Renderer<'_, L, 4> {
        Renderer::plain(self.lent())
    }

    fn lent(&mut self) -> Lent<'_, L, 4> {
        Lent {
            cache: &mut self.cache,
            links: &mut self.links,
            depth: &mut self.depth,
        }
    }
}

/// One line over a background.
pub fn line<L: Smooth>(
    renderer: &mut Renderer<'_, L, 4>,
    scene: &Scene<'_, '_, L>,
    number: u16,
    background: WordOf<L>,
) -> Vec<WordOf<L>> {
    // Filled with something else, so that a pixel that is not written is noticed.
    let other = L::Format::from_rgb8([90, 200, 10]);
    let mut pixels = vec![other; scene.screen().width().into()];
    L::draw_line(renderer, scene, number, &mut pixels, background).expect("the memory suffices");
    pixels
}

/// All lines that were begun, from the top, with so many slots.
pub fn frame<L: Smooth>(
    scene: &Scene<'_, '_, L>,
    slots: u16,
    depth: bool,
    background: WordOf<L>,
) -> Vec<Vec<WordOf<L>>> {
    let mut rooms = LineRooms::fitting(scene, slots, depth);
    let mut renderer = rooms.renderer();
    let lines = scene.lines();
    lines
        .map(|y| line(&mut renderer, scene, y, background))
        .collect()
}

/// Sees what is 1 away so that one unit of the screen is 2^-15 of the distance.
pub fn camera() -> Camera {
    let far = Camera::MOST_FAR * NEAR as f32;
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at([0.0; 3], ahead, up, 4096.0, NEAR as f32, far).expect("these are fine")
}

/// Units from the picture's middle.
fn from_middle(screen: Screen, at: Place) -> [f64; 2] {
    let (w, h) = (i32::from(screen.width()), i32::from(screen.height()));
    [f64::from(at.0 - 4 * w), f64::from(at.1 - 4 * h)]
}

/// The scale of a triangle's model: a power of two that all its coordinates are within.
pub fn scale(screen: Screen, corners: &[Corner]) -> f64 {
    let farthest = corners.iter().fold(0.0, |m: f64, c| {
        let [x, y] = from_middle(screen, c.at);
        m.max(c.w * (x.abs().max(y.abs()) / 32_768.0).max(1.0))
    });
    farthest.log2().ceil().exp2()
}

/// Where a vertex lies that [`camera`] sees at a place from so far away, in a model of this scale.
pub fn position(screen: Screen, at: Place, w: f64, scale: f64) -> [i32; 3] {
    let q30 = |v: f64| (v / scale * f64::from(1 << 30)).round() as i32;
    let [x, y] = from_middle(screen, at);
    [q30(x / 32_768.0 * w), q30(-y / 32_768.0 * w), q30(-w)]
}

/// Draws triangles as one mesh, of one scale.
pub fn draw<L: Look>(
    scene: &mut Scene<'_, '_, L>,
    triangles: &[[Corner; 3]],
    cull: Cull,
) -> Result<(), DrawError> {
    draw_with(scene, triangles, |call| call.cull = cull)
}

/// The same, as a call that `dress` changes.
pub fn draw_with<L: Look>(
    scene: &mut Scene<'_, '_, L>,
    triangles: &[[Corner; 3]],
    dress: impl FnOnce(&mut Draw<'_, '_, i32>),
) -> Result<(), DrawError> {
    draw_of(scene, scene.screen(), triangles, dress)
}

/// The same of triangles of a larger picture, of which the scene is a part.
pub fn draw_of<L: Look>(
    scene: &mut Scene<'_, '_, L>,
    screen: Screen,
    triangles: &[[Corner; 3]],
    dress: impl FnOnce(&mut Draw<'_, '_, i32>),
) -> Result<(), DrawError> {
    let corners = triangles.as_flattened();
    let scale = scale(screen, corners);
    let positions: Vec<_> = corners
        .iter()
        .map(|c| position(screen, c.at, c.w, scale))
        .collect();
    let colours: Vec<_> = corners.iter().map(|c| c.colour).collect();
    let faces: Vec<_> = (0..triangles.len() as u16)
        .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
        .collect();
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &colours,
        faces: Faces::Triangles(&faces),
    };
    let mut call = Draw::new(mesh);
    call.model = Affine::placed(scale as f32, [0.0; 3]).expect("a power of two");
    dress(&mut call);
    scene.draw(&call)
}

/// A scene of triangles of either side, each a draw call of its own, handed to `see`.
pub fn with_scene<L: Look, R>(
    screen: Screen,
    triangles: &[[Corner; 3]],
    see: impl FnOnce(&Scene<'_, '_, L>) -> R,
) -> R {
    let mut rooms = SceneRooms::of_triangles(triangles.len(), screen);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    for one in triangles {
        draw(&mut scene, std::slice::from_ref(one), Cull::None).expect("there is room");
    }
    assert_eq!(scene.assembled().clipped, 0, "places lie within the planes");
    see(&scene)
}
