//! Small frames of what few draw calls have in the rooms `scene`, `look` and `frame`, and of the ways to send them,
//! which must have the same bits everywhere.
//!
//! | name | what it shows |
//! |---|---|
//! | `values_phong` | a ball and a ribbon that are lit at each pixel, one of them dithered |
//! | `values_texels` | a cube and a grille whose texels are lit at each pixel, one of them dithered |
//! | `values_dusk` | a ball, a cube and octahedra of a list, of indices, by a palette for each line |
//! | `values_bands` | heights as contour bands, by a look of its own |
//! | `values_mirror` | a teapot that reflects its surroundings |
//! | `values_holes` | a cube with holes around a ball, a decal and texels as they are |
//! | `values_dither` | smooth and textured surfaces, dithered |
//! | `values_alpha` | a fading ribbon, cubes of rings that are clear, added or not dithered, cut and flat ones |
//! | `values_again` | textured cubes that are drawn again where they are as far: lit, added, seen through |
//! | `values_blends` | panes of all modes, scissors, depth tests, several lights, flat faces |
//! | `values_ranked` | the same by priority |
//! | `values_master` | the scene of blends with all switched off that can be |
//! | `values_sampled` | a floor and balls in levels of detail, cubes whose texels are mixed |
//! | `values_computed` | a floor and cubes of computed texels, nearest, mixed and with holes |
//! | `values_blocks` | floors, cubes and a crate of a list, with texels in blocks behind a small cache |
//! | `values_compressed` | floors and cubes of compressed texels: through a cache, mixed, alone, and with holes |
//! | `values_shadows` | two cubes, an octahedron of a list, a ribbon, a floor and a pane in the shadows of two lights |
//! | `values_points` | points of three sizes and corners on the screen, textured, by a camera that looks aside |
//! | `values_overlay` | a ball below sprites |
//! | `values_lines` | a ball, and what of it changes, line by line |
//! | `values_runs` | the same in cells of 16 x 2 pixels |
//! | `values_doubled` | the teapot of the suite, its lines and columns doubled on their way out |
//! | `values_told` | what becomes of damaged lists, and what frames, lists and queues tell, as squares |

mod again;
mod alpha;
mod compressed;
mod dusk;
mod fetched;
mod kept;
mod listed;
mod octahedron;
mod points;
mod sampled;
mod scenes;
mod shadows;
mod told;

use crate::ShotError;
use crate::contours::ContourLook;
use crate::looks::{SmoothLook, TexturedLook};
use again::again;
use alpha::alpha;
pub use compressed::STONE;
use compressed::{cache, compressed, empty, pressed};
use dusk::{Dusk, dusk};
use fetched::computed;
use points::points;
use sampled::{levels, sampled, textures};
use scanbeam::frame::{
    FastMemory, FrameError, Memory as LineMemory, Renderer, draw_frame, draw_frame_changed,
    draw_frame_changed_runs, draw_frame_indexed, draw_frame_overlaid,
};
use scanbeam::look::{Gouraud, Look, Phong, TexturedPhong};
use scanbeam::overlay::Overlay;
use scanbeam::pixel::{Index8, PixelFormat, Rgb565Be, expand_indices};
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma, ShownLines, ShownRuns, Window, send_doubled};
use scanbeam::scene::{DrawState, Master, Memory, Object, Scene, TexturePlace, Vertex};
use scanbeam::{Link, Screen};
use scenes::{ball, bands, blends, dither, holes, lamps, mirror, phong, sprites, teapot, texels};
use shadows::shadows;

/// Pixels a line of such a frame.
pub const VALUES_WIDTH: u16 = 160;
/// Lines of such a frame.
pub const VALUES_HEIGHT: u16 = 120;
/// Vertices, places, objects and links that suffice for any of them.
pub const VALUES_ROOM: usize = 2400;
/// Words that suffice to know what of it a display shows.
pub const VALUES_SHOWN: usize =
    ShownRuns::words(VALUES_WIDTH, VALUES_HEIGHT, CELL.0, CELL.1) + VALUES_HEIGHT as usize;

/// Draw calls of the frame that has most.
const DRAWS: usize = 12;
/// Likewise with shadows.
const SHADOW_DRAWS: usize = 32;
/// Columns and lines of a cell.
const CELL: (u16, u16) = (16, 2);

/// Light at each pixel.
pub type PhongLook = Phong<Rgb565Be>;
/// The same of texels.
pub type TexturedPhongLook = TexturedPhong<Rgb565Be>;
/// Indices of a palette.
pub type IndexedLook = Gouraud<Index8>;

/// A small frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Light at each pixel.
    Phong,
    /// Texels that are lit at each pixel.
    Texels,
    /// Indices, and palettes of lines.
    Dusk,
    /// A look of one's own.
    Bands,
    /// Texture places from normals.
    Mirror,
    /// Texels that are transparent.
    Holes,
    /// Dithered colours and texels.
    Dither,
    /// Alphas of vertices and texels.
    Alpha,
    /// Textures where depth is equal.
    Again,
    /// Blends, scissors, depth tests, lights.
    Blends,
    /// The same by priority.
    Ranked,
    /// What blends has, with all switched off that can be.
    Master,
    /// Levels of detail, and means of texels.
    Sampled,
    /// Texels that are computed.
    Computed,
    /// Texels in blocks of slow memory, through a cache.
    Blocks,
    /// Texels of 4 bits.
    Compressed,
    /// Volumes of two lights, and what they light.
    Shadows,
    /// Points, and triangles that are set up beforehand.
    Points,
    /// Below sprites.
    Overlay,
    /// A frame, and the changed lines of another.
    Lines,
    /// A frame, and the changed cells of another.
    Runs,
    /// A frame of which four times as many pixels are sent.
    Doubled,
    /// Answers, as squares: two frames.
    Told,
}

/// Their names, and which frame each is.
pub const VALUES: [(&str, Values); 23] = [
    ("values_phong", Values::Phong),
    ("values_texels", Values::Texels),
    ("values_dusk", Values::Dusk),
    ("values_bands", Values::Bands),
    ("values_mirror", Values::Mirror),
    ("values_holes", Values::Holes),
    ("values_dither", Values::Dither),
    ("values_alpha", Values::Alpha),
    ("values_again", Values::Again),
    ("values_blends", Values::Blends),
    ("values_ranked", Values::Ranked),
    ("values_master", Values::Master),
    ("values_sampled", Values::Sampled),
    ("values_computed", Values::Computed),
    ("values_blocks", Values::Blocks),
    ("values_compressed", Values::Compressed),
    ("values_shadows", Values::Shadows),
    ("values_points", Values::Points),
    ("values_overlay", Values::Overlay),
    ("values_lines", Values::Lines),
    ("values_runs", Values::Runs),
    ("values_doubled", Values::Doubled),
    ("values_told", Values::Told),
];

/// What such a frame is lent.
#[derive(Debug)]
pub struct ValuesMemory<'m> {
    /// [`VALUES_ROOM`] of them.
    pub vertices: &'m mut [Vertex],
    /// Likewise.
    pub places: &'m mut [TexturePlace],
    /// Likewise.
    pub objects: &'m mut [Object],
    /// Likewise.
    pub links: &'m mut [Link],
    /// [`VALUES_HEIGHT`] of them.
    pub bins: &'m mut [u16],
    /// [`VALUES_WIDTH`] of them.
    pub depth: &'m mut [u32],
    /// [`VALUES_SHOWN`] of them.
    pub shown: &'m mut [u32],
    /// The slots of smooth colours.
    pub smooth: &'m mut FastMemory<SmoothLook>,
    /// The slots of textures.
    pub textured: &'m mut FastMemory<TexturedLook>,
    /// The slots of light at each pixel.
    pub lit: &'m mut FastMemory<PhongLook>,
    /// The slots of texels that are lit so.
    pub lit_texels: &'m mut FastMemory<TexturedPhongLook>,
    /// The slots of indices.
    pub indexed: &'m mut FastMemory<IndexedLook>,
    /// The slots of a look of one's own.
    pub banded: &'m mut FastMemory<ContourLook>,
}

/// Why a frame was not drawn.
#[derive(Debug)]
pub enum ValuesError<E> {
    /// The scene was not made.
    Scene(ShotError),
    /// The frame was not sent.
    Frame(FrameError<E>),
}

impl<E> From<ShotError> for ValuesError<E> {
    fn from(error: ShotError) -> Self {
        Self::Scene(error)
    }
}

impl<E> From<FrameError<E>> for ValuesError<E> {
    fn from(error: FrameError<E>) -> Self {
        Self::Frame(error)
    }
}

/// What a frame is drawn with: a scene's memory but its draw states, a renderer's but its slots, and what is shown.
struct Rest<'m> {
    vertices: &'m mut [Vertex],
    places: &'m mut [TexturePlace],
    objects: &'m mut [Object],
    links: &'m mut [Link],
    bins: &'m mut [u16],
    depth: &'m mut [u32],
    shown: &'m mut [u32],
}

impl Values {
    /// Columns and lines that are sent.
    #[must_use]
    pub const fn size(self) -> (u16, u16) {
        match self {
            Self::Doubled => (2 * VALUES_WIDTH, 2 * VALUES_HEIGHT),
            _ => (VALUES_WIDTH, VALUES_HEIGHT),
        }
    }

    /// Draws the frame with the memory that is lent, and sends it, and what changes after it, through `pump`.
    ///
    /// # Errors
    /// When the sink fails, or less is lent than said.
    pub fn draw<D>(
        self,
        lent: ValuesMemory<'_>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let rest = Rest {
            vertices: lent.vertices,
            places: lent.places,
            objects: lent.objects,
            links: lent.links,
            bins: lent.bins,
            depth: lent.depth,
            shown: lent.shown,
        };
        let lamps = lamps()?;
        match self {
            Self::Phong => rest.send(self, lent.lit, pump, |scene, _| phong(scene, &lamps)),
            Self::Texels => rest.send(self, lent.lit_texels, pump, |scene, _| {
                texels(scene, &lamps)
            }),
            Self::Dusk => rest.send_indexed(lent.indexed, pump),
            Self::Bands => rest.send(self, lent.banded, pump, |scene, _| bands(scene)),
            Self::Mirror => rest.send(self, lent.textured, pump, |scene, _| mirror(scene)),
            Self::Holes => rest.send(self, lent.textured, pump, |scene, _| holes(scene)),
            Self::Alpha => rest.send(self, lent.textured, pump, |scene, _| alpha(scene)),
            Self::Again => rest.send(self, lent.textured, pump, |scene, _| again(scene)),
            Self::Points => rest.send(self, lent.textured, pump, |scene, _| points(scene)),
            Self::Dither => rest.send(self, lent.textured, pump, |scene, _| dither(scene)),
            Self::Blends | Self::Ranked | Self::Master => {
                let is_ranked = self == Self::Ranked;
                rest.send(self, lent.smooth, pump, |scene, _| blends(scene, is_ranked))
            }
            Self::Sampled => rest.send_sampled(lent.textured, pump),
            Self::Computed => rest.send(self, lent.textured, pump, |scene, _| computed(scene)),
            Self::Blocks => rest.send_blocks(lent.textured, pump),
            Self::Compressed => rest.send_compressed(lent.textured, pump),
            Self::Shadows => rest.send_shadows(lent.smooth, pump),
            Self::Told => rest.send_told(lent.textured, pump),
            Self::Doubled => rest.send(self, lent.smooth, pump, |scene, _| teapot(scene)),
            Self::Overlay | Self::Lines | Self::Runs => rest.send(self, lent.smooth, pump, ball),
        }
    }
}

/// What is seen where nothing is.
fn background() -> u16 {
    Rgb565Be::from_rgb8([24, 32, 48])
}

impl<'m> Rest<'m> {
    /// What a scene is lent, what a renderer is, and what is shown.
    #[inline(always)]
    fn lend<'a, 't, L: Look>(
        self,
        draws: &'a mut [DrawState<'t>],
        cache: &'a mut FastMemory<L>,
    ) -> (Memory<'a, 't>, LineMemory<'a, L>, &'a mut [u32])
    where
        'm: 'a,
    {
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws,
        };
        let lines = LineMemory {
            cache,
            links: self.links,
            depth: self.depth,
        };
        (memory, lines, self.shown)
    }

    /// Sends the scene with shadows: a function of its own, so that other looks do not have their code.
    #[inline(never)]
    fn send_shadows<D>(
        self,
        cache: &mut FastMemory<SmoothLook>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let mut draws = [const { DrawState::EMPTY }; SHADOW_DRAWS];
        let (memory, lines, _) = self.lend(&mut draws, cache);
        let mut scene = Scene::new(values_screen(), memory);
        shadows(&mut scene)?;
        let mut counts = [0; VALUES_WIDTH as usize];
        let mut renderer = Renderer::with_shadows(lines, &mut counts);
        draw_frame(&scene, &mut renderer, pump, background(), 3)?;
        Ok(())
    }

    /// Sends the scene of indices.
    #[inline(never)]
    fn send_indexed<D>(
        self,
        cache: &mut FastMemory<IndexedLook>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let (memory, lines, _) = self.lend(&mut draws, cache);
        let mut scene = Scene::new(values_screen(), memory);
        dusk(&mut scene)?;
        let mut renderer = Renderer::new(lines);
        let mut indices = [0; VALUES_WIDTH as usize];
        let mut dusk = Dusk::new();
        let expand = |line, indices: &[u8], pixels: &mut [u16]| {
            expand_indices(indices, dusk.palette(line), pixels);
        };
        draw_frame_indexed(&scene, &mut renderer, pump, 0, 3, &mut indices, expand)?;
        Ok(())
    }

    /// Makes levels of detail, and sends the scene that has them.
    #[inline(never)]
    fn send_sampled<D>(
        self,
        cache: &mut FastMemory<TexturedLook>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let mut words = ([0; 1024], [0; 256], [0; 64], [0; 16]);
        let levels = levels(&mut words)?;
        let textures = textures(&levels)?;
        self.send(Values::Sampled, cache, pump, |scene, _| {
            sampled(scene, &textures)
        })
    }

    /// Loads what fits the cache of a compressed texture, and sends the scene that reads it.
    #[inline(never)]
    fn send_compressed<D>(
        self,
        slots: &mut FastMemory<TexturedLook>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let mut words = empty();
        let cache = cache(&mut words)?;
        let textures = pressed(&cache)?;
        self.send(Values::Compressed, slots, pump, |scene, _| {
            compressed(scene, &textures)
        })
    }

    /// Makes the scene by `build`, of this moment, and sends it.
    #[inline(never)]
    fn send<'t, L, D>(
        self,
        values: Values,
        cache: &mut FastMemory<L>,
        pump: &mut Pump<D>,
        build: impl Fn(&mut Scene<'_, 't, L>, f32) -> Result<(), ShotError>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        L: Look<Pixel = Rgb565Be>,
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let (memory, lines, known) = self.lend(&mut draws, cache);
        let mut scene = Scene::<L>::new(values_screen(), memory);
        let mut renderer = Renderer::new(lines);
        let background = background();
        if values == Values::Master {
            let master = Master::ALL.without(Master::SHADING).without(Master::DEPTH);
            let master = master.without(Master::TEXTURE).without(Master::BLEND);
            scene.set_master(master.without(Master::DITHER));
        }
        build(&mut scene, 0.0)?;
        if values == Values::Overlay {
            let sprites = sprites();
            let overlay = Overlay::<Rgb565Be>::new(&sprites);
            let mut overlay = overlay.map_err(|_| ShotError::Sprites)?;
            let paint = |line, pixels: &mut [u16]| overlay.paint(line, pixels);
            draw_frame_overlaid(&scene, &mut renderer, pump, background, 1, paint)?;
            return Ok(());
        }
        if values == Values::Doubled {
            let window = Window {
                x: 0,
                y: 0,
                width: VALUES_WIDTH,
                height: VALUES_HEIGHT,
            };
            let (mut above, mut below) = ([0; VALUES_WIDTH as usize], [0; VALUES_WIDTH as usize]);
            let drawn = [&mut above[..], &mut below[..]];
            let draw = |line, pixels: &mut [u16]| {
                let drawn = renderer.draw_line(&scene, line, pixels, background);
                drawn.map(|_| ()).map_err(FrameError::Line)
            };
            send_doubled(pump, window, 1, drawn, Rgb565Be::mix_lines, draw)?;
            return Ok(());
        }
        if !matches!(values, Values::Lines | Values::Runs) {
            draw_frame(&scene, &mut renderer, pump, background, 3)?;
            return Ok(());
        }
        let (lines, cells) = known.split_at_mut(VALUES_HEIGHT.into());
        let mut lines = ShownLines::new(lines);
        let mut cells = ShownRuns::new(cells, VALUES_WIDTH, CELL.0, CELL.1);
        for moment in [0.0, 0.25, 0.25] {
            build(&mut scene, moment)?;
            let renderer = &mut renderer;
            if values == Values::Lines {
                draw_frame_changed(&scene, renderer, pump, background, 3, &mut lines, |_, _| {})?;
            } else {
                draw_frame_changed_runs(
                    &scene,
                    renderer,
                    pump,
                    background,
                    2,
                    &mut cells,
                    |_, _| {},
                )?;
            }
        }
        Ok(())
    }
}

/// The size of such a frame.
#[must_use]
pub fn values_screen() -> Screen {
    match Screen::new(VALUES_WIDTH, VALUES_HEIGHT) {
        Ok(screen) => screen,
        Err(_) => unreachable!("no side is too long"),
    }
}
