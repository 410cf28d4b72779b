//! Small frames of what few draw calls have in the rooms `scene`, `look` and `frame`, and of the ways to send them,
//! which must have the same bits everywhere.
//!
//! | name | what it shows |
//! |---|---|
//! | `values_phong` | a ball and a ribbon that are lit at each pixel, one of them dithered |
//! | `values_bands` | heights as contour bands, by a look of its own |
//! | `values_mirror` | a teapot that reflects its surroundings |
//! | `values_holes` | a cube with holes around a ball, a decal and texels as they are |
//! | `values_dither` | smooth and textured surfaces, dithered |
//! | `values_blends` | panes of all modes, scissors, depth tests, several lights, flat faces |
//! | `values_ranked` | the same by priority |
//! | `values_master` | the scene of blends with all switched off that can be |
//! | `values_overlay` | a ball below sprites |
//! | `values_lines` | a ball, and what of it changes, line by line |
//! | `values_runs` | the same in cells of 16 x 2 pixels |
//! | `values_doubled` | the teapot of the suite, its lines and columns doubled on their way out |

use crate::contours::{CONTOURED, LeanContours};
use crate::lean::{LeanError, LeanLook, LeanTextured};
use crate::suite::{Looking, Suite, teapot_part};
use crate::{CUBE, PLACES_F, RIBBON, SPHERE, SURROUNDINGS, TEAPOT, TEXELS_F_PANEL};
use scanbeam::frame::{
    FastMemory, FrameError, Memory as LineMemory, Renderer, draw_frame, draw_frame_changed,
    draw_frame_changed_runs, draw_frame_overlaid,
};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::look::{Look, Phong};
use scanbeam::mesh::{Material, U1F15};
use scanbeam::overlay::{Ink, Overlay, Sprite};
use scanbeam::pixel::{Pixel, PixelFormat, Pixels, Rgb565Be};
use scanbeam::scan_out::{
    ErrorType, LineBuf, Pump, ScanoutDma, ShownLines, ShownRuns, Window, send_doubled,
};
use scanbeam::scene::{
    Application, Blend, BlendMode, Budget, DepthFunction, DepthTest, Draw, DrawState, Factor,
    Master, Memory, Object, Scene, Scissor, Shading, Skin, TexGen, Texture, TexturePlace, Vertex,
};
use scanbeam::{Affine, Camera, Cull, Light, Link, Mesh, Screen};

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
/// Columns and lines of a cell.
const CELL: (u16, u16) = (16, 2);

/// Light at each pixel.
pub type LeanPhong = Phong<Rgb565Be>;

/// A small frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Light at each pixel.
    Phong,
    /// A look of one's own.
    Bands,
    /// Texture places from normals.
    Mirror,
    /// Texels that are transparent.
    Holes,
    /// Dithered colours and texels.
    Dither,
    /// Blends, scissors, depth tests, lights.
    Blends,
    /// The same by priority.
    Ranked,
    /// What blends has, with all switched off that can be.
    Master,
    /// Below sprites.
    Overlay,
    /// A frame, and the changed lines of another.
    Lines,
    /// A frame, and the changed cells of another.
    Runs,
    /// A frame of which four times as many pixels are sent.
    Doubled,
}

/// Their names, and which frame each is.
pub const VALUES: [(&str, Values); 12] = [
    ("values_phong", Values::Phong),
    ("values_bands", Values::Bands),
    ("values_mirror", Values::Mirror),
    ("values_holes", Values::Holes),
    ("values_dither", Values::Dither),
    ("values_blends", Values::Blends),
    ("values_ranked", Values::Ranked),
    ("values_master", Values::Master),
    ("values_overlay", Values::Overlay),
    ("values_lines", Values::Lines),
    ("values_runs", Values::Runs),
    ("values_doubled", Values::Doubled),
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
    pub smooth: &'m mut FastMemory<LeanLook>,
    /// The slots of textures.
    pub textured: &'m mut FastMemory<LeanTextured>,
    /// The slots of light at each pixel.
    pub lit: &'m mut FastMemory<LeanPhong>,
    /// The slots of a look of one's own.
    pub banded: &'m mut FastMemory<LeanContours>,
}

/// Why a frame was not drawn.
#[derive(Debug)]
pub enum ValuesError<E> {
    /// The scene was not made.
    Scene(LeanError),
    /// The frame was not sent.
    Frame(FrameError<E>),
}

impl<E> From<LeanError> for ValuesError<E> {
    fn from(error: LeanError) -> Self {
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
    ) -> Result<(), ValuesError<<D as ErrorType>::Error>>
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
            Self::Bands => rest.send(self, lent.banded, pump, |scene, _| bands(scene)),
            Self::Mirror => rest.send(self, lent.textured, pump, |scene, _| mirror(scene)),
            Self::Holes => rest.send(self, lent.textured, pump, |scene, _| holes(scene)),
            Self::Dither => rest.send(self, lent.textured, pump, |scene, _| dither(scene)),
            Self::Blends | Self::Ranked | Self::Master => {
                let is_ranked = self == Self::Ranked;
                rest.send(self, lent.smooth, pump, |scene, _| blends(scene, is_ranked))
            }
            Self::Doubled => rest.send(self, lent.smooth, pump, |scene, _| teapot(scene)),
            Self::Overlay | Self::Lines | Self::Runs => rest.send(self, lent.smooth, pump, ball),
        }
    }
}

impl Rest<'_> {
    /// Makes the scene by `build`, of this moment, and sends it.
    #[inline(never)]
    fn send<'t, L, D>(
        self,
        values: Values,
        cache: &mut FastMemory<L>,
        pump: &mut Pump<D>,
        build: impl Fn(&mut Scene<'_, 't, L>, f32) -> Result<(), LeanError>,
    ) -> Result<(), ValuesError<<D as ErrorType>::Error>>
    where
        L: Look<Pixel = Rgb565Be>,
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws: &mut draws,
        };
        let mut scene = Scene::<L>::new(values_screen(), memory);
        let mut renderer = Renderer::new(LineMemory {
            cache,
            links: self.links,
            depth: self.depth,
        });
        let background = Rgb565Be::from_rgb8([24, 32, 48]);
        if values == Values::Master {
            let master = Master::ALL.without_shading().without_depth();
            scene.set_master(master.without_texture().without_blend().without_dither());
        }
        build(&mut scene, 0.0)?;
        if values == Values::Overlay {
            let sprites = sprites();
            let overlay = Overlay::<Rgb565Be>::new(&sprites);
            let overlay = overlay.map_err(|_| LeanError::Sprites)?;
            draw_frame_overlaid(&scene, &mut renderer, pump, background, 1, overlay)?;
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
        let (lines, cells) = self.shown.split_at_mut(VALUES_HEIGHT.into());
        let mut lines = ShownLines::new(lines);
        let mut cells = ShownRuns::new(cells, VALUES_WIDTH, CELL.0, CELL.1);
        for moment in [0.0, 0.25, 0.25] {
            build(&mut scene, moment)?;
            let renderer = &mut renderer;
            if values == Values::Lines {
                draw_frame_changed(&scene, renderer, pump, background, 3, &mut lines, ())?;
            } else {
                draw_frame_changed_runs(&scene, renderer, pump, background, 2, &mut cells, ())?;
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

/// Who looks at it.
fn camera() -> Result<Camera, LeanError> {
    let (eye, up) = ([0.6, 1.0, 2.8], [0.0, 1.0, 0.0]);
    Camera::look_at(eye, [0.0; 3], up, 140.0, 0.1, 100.0).map_err(LeanError::Camera)
}

fn at(scale: f32, place: [f32; 3]) -> Affine {
    Affine::placed(scale, place).unwrap_or(Affine::IDENTITY)
}

/// A warm light from the right, as pixels see it.
fn lamps() -> Result<Option<PixelLamps>, LeanError> {
    let light = DirectionalLight::new([0.6, 0.8, 1.0], [1.0, 0.9, 0.8]);
    let ambient = [U1F15::from_bits(5_000); 3];
    let lighting = light.as_ref().and_then(|light| {
        let light = core::slice::from_ref(light);
        Lighting::new(light, ambient, Material::shiny(0.6, 30))
    });
    let camera = camera()?;
    Ok(lighting.map(|lighting| PixelLamps::new(&lighting, &camera, values_screen())))
}

/// A mesh without colours of its own.
fn uncoloured(mesh: Mesh<'static>) -> Mesh<'static> {
    Mesh {
        colours: &[],
        ..mesh
    }
}

/// Begins a scene and draws these calls.
fn draw_all<'t, L: Look>(
    scene: &mut Scene<'_, 't, L>,
    calls: &[Draw<'_, 't>],
) -> Result<(), LeanError> {
    scene.begin(&camera()?).map_err(LeanError::Begin)?;
    for call in calls {
        scene.draw(call).map_err(LeanError::Draw)?;
    }
    Ok(())
}

/// A ball and a ribbon.
fn phong<'t>(
    scene: &mut Scene<'_, 't, LeanPhong>,
    lamps: &'t Option<PixelLamps>,
) -> Result<(), LeanError> {
    let lamps = lamps.as_ref();
    let ball = Draw {
        model: Affine::rotation_x(0.5).then(&at(0.8, [-0.2, 0.1, 0.0])),
        colour: [200, 90, 60],
        lamps,
        ..Draw::new(SPHERE)
    };
    let ribbon = Draw {
        model: Affine::rotation_y(0.3).then(&at(1.0, [0.2, -0.3, 0.8])),
        cull: Cull::None,
        lamps,
        dither: true,
        ..Draw::new(uncoloured(RIBBON))
    };
    draw_all(scene, &[ball, ribbon])
}

/// A ball with contour bands, a corner of the picture left out.
fn bands(scene: &mut Scene<'_, 'static, LeanContours>) -> Result<(), LeanError> {
    let ball = Draw {
        model: Affine::rotation_x(0.5).then(&at(0.9, [0.0, 0.1, 0.0])),
        scissor: Some(Scissor::outside(0..75, 0..40)),
        ..Draw::new(CONTOURED)
    };
    draw_all(scene, &[ball])
}

/// A teapot that is a mirror.
fn mirror(scene: &mut Scene<'_, 'static, LeanTextured>) -> Result<(), LeanError> {
    let teapot = Draw {
        model: Affine::rotation_y(0.6),
        texture: Some(Skin {
            texture: &SURROUNDINGS,
            places: &[],
            budget: Budget::BALANCED,
        }),
        texgen: Some(TexGen::SPHERE),
        ..Draw::new(TEAPOT)
    };
    draw_all(scene, &[teapot])
}

/// What is transparent in [`GRILLE`]: no other texel is magenta.
const KEY: u16 = 0xF81F_u16.to_be();

/// The texture of scene F, every other square of which is transparent.
static GRILLE_TEXELS: [u16; 64 * 64] = {
    let mut texels = TEXELS_F_PANEL;
    let mut i = 0;
    while i < texels.len() {
        let (x, y) = (i % 64, i / 64);
        let is_rim = x < 2 || y < 2 || x >= 62 || y >= 62;
        if (x ^ y) & 8 == 0 && !is_rim {
            texels[i] = KEY;
        }
        i += 1;
    }
    texels
};

static GRILLE: Texture<'static> = match Texture::words(&GRILLE_TEXELS, 64, 64) {
    Ok(texture) => texture.keyed(KEY),
    Err(_) => panic!("as many texels as the sides need"),
};

static PANEL: Texture<'static> = match Texture::words(&TEXELS_F_PANEL, 64, 64) {
    Ok(texture) => texture,
    Err(_) => panic!("as many texels as the sides need"),
};

/// How the grille lies on a cube.
const SKIN: Skin<'static, 'static> = Skin {
    texture: &GRILLE,
    places: &PLACES_F,
    budget: Budget::BALANCED,
};

fn light() -> Option<Light> {
    Light::new([0.3, 0.8, 0.6], 0.3)
}

/// A lit cube with holes around a ball, one whose holes its colours fill, and one that is not lit.
fn holes(scene: &mut Scene<'_, 'static, LeanTextured>) -> Result<(), LeanError> {
    let cube = |angle: f32, scale: f32, place: [f32; 3]| Draw {
        model: Affine::rotation_y(angle).then(&at(scale, place)),
        cull: Cull::None,
        light: light(),
        texture: Some(SKIN),
        ..Draw::new(uncoloured(CUBE))
    };
    let ball = Draw {
        model: at(0.5, [-0.3, 0.1, 0.0]),
        colour: [250, 120, 40],
        light: light(),
        ..Draw::new(SPHERE)
    };
    let decal = Draw {
        application: Application::Decal,
        colour: [60, 200, 90],
        cull: Cull::Back,
        ..cube(0.9, 0.28, [0.75, -0.1, 0.6])
    };
    let plain = Draw {
        application: Application::Replace,
        ..cube(0.3, 0.22, [0.6, 0.75, 0.0])
    };
    draw_all(
        scene,
        &[cube(0.5, 0.6, [-0.3, 0.1, 0.0]), ball, decal, plain],
    )
}

/// A ball, a ribbon and a textured cube.
fn dither(scene: &mut Scene<'_, 'static, LeanTextured>) -> Result<(), LeanError> {
    let ball = Draw {
        model: at(0.8, [-0.5, 0.1, 0.0]),
        colour: [90, 70, 60],
        light: light(),
        dither: true,
        ..Draw::new(SPHERE)
    };
    let ribbon = Draw {
        model: Affine::rotation_y(0.3).then(&at(1.0, [0.2, -0.3, 0.8])),
        cull: Cull::None,
        dither: true,
        ..Draw::new(RIBBON)
    };
    let skin = Skin {
        texture: &PANEL,
        ..SKIN
    };
    let cube = Draw {
        model: Affine::rotation_y(0.5).then(&at(0.45, [0.8, 0.2, -0.2])),
        light: Light::new([0.3, 0.8, 0.6], 0.1),
        texture: Some(skin),
        dither: true,
        ..Draw::new(uncoloured(CUBE))
    };
    draw_all(scene, &[ball, ribbon, cube])
}

/// Panes of all modes before a ribbon, a cube in two lights and a ribbon of flat faces, some of them cut; each by a
/// priority of its own if it `is_ranked`.
fn blends(scene: &mut Scene<'_, 'static, LeanLook>, is_ranked: bool) -> Result<(), LeanError> {
    let warm = DirectionalLight::new([0.3, 0.8, 0.6], [0.9, 0.8, 0.6]);
    let cold = DirectionalLight::new([-0.9, 0.1, 0.3], [0.1, 0.2, 0.5]);
    let lights = warm.zip(cold).map(|(warm, cold)| [warm, cold]);
    let ambient = [U1F15::from_bits(6_000); 3];
    let lighting = lights
        .as_ref()
        .and_then(|lights| Lighting::new(lights, ambient, Material::shiny(0.5, 20)));
    let open = Draw {
        cull: Cull::None,
        light: light(),
        ..Draw::new(RIBBON)
    };
    let back = Draw {
        mesh: CUBE,
        model: Affine::rotation_y(0.6).then(&at(0.7, [0.3, 0.0, -1.6])),
        light: None,
        lights: lighting.as_ref().map(|lighting| lighting as _),
        scissor: Some(Scissor::outside(70..90, 40..60)),
        ..open
    };
    let faceted = Draw {
        mesh: uncoloured(RIBBON),
        model: Affine::rotation_z(1.2).then(&at(0.9, [-0.9, 0.1, -0.4])),
        shading: Shading::Flat,
        colour: [210, 120, 90],
        depth: DepthTest::new(DepthFunction::NEARER),
        ..open
    };
    let mut calls = [open, back, faceted, open, open, open, open, open];
    let multiply = BlendMode::Factors {
        source: Factor::Destination,
        destination: Factor::Constant(60),
    };
    let modes = [
        Blend::filter(120),
        Blend::add(200).writing([true, true, false]),
        Blend::new(BlendMode::Subtract(90)),
        Blend::new(BlendMode::Half),
        Blend::new(multiply),
    ];
    for (i, (call, blend)) in (0u8..).zip(calls.iter_mut().skip(3).zip(modes)) {
        let angle = 0.9 * f32::from(i);
        let place = [0.45 * f32::from(i) - 0.9, 0.1 * f32::from(i), 0.2];
        let turned = Affine::rotation_x(angle).then(&Affine::rotation_y(2.0 * angle));
        *call = Draw {
            mesh: CUBE,
            model: turned.then(&at(0.3, place)),
            blend: Some(blend),
            scissor: (i == 3).then_some(Scissor::inside(0..130, 30..120)),
            ..open
        };
    }
    for (i, call) in (0u8..).zip(calls.iter_mut()) {
        call.priority = if is_ranked { (i * 5) % 8 + 1 } else { 0 };
    }
    draw_all(scene, &calls)
}

/// The teapot of the suite, at half the size.
fn teapot(scene: &mut Scene<'_, 'static, LeanLook>) -> Result<(), LeanError> {
    let view = Suite::Teapot.view();
    let half = Looking {
        focal: view.focal / 2.0,
        ..view
    };
    let camera = half.camera().map_err(LeanError::Camera)?;
    scene.begin(&camera).map_err(LeanError::Begin)?;
    let part = teapot_part();
    let teapot = Draw {
        model: part.instance.model,
        light: part.instance.light,
        colour: part.instance.colour,
        ..Draw::new(part.mesh)
    };
    scene.draw(&teapot).map_err(LeanError::Draw)
}

/// A ball of which a part turns, with a cube that goes round it.
fn ball(scene: &mut Scene<'_, 'static, LeanLook>, moment: f32) -> Result<(), LeanError> {
    let ball = Draw {
        model: at(0.8, [-0.2, 0.1, 0.0]),
        colour: [90, 160, 220],
        light: light(),
        ..Draw::new(SPHERE)
    };
    let cube = Draw {
        model: Affine::rotation_y(1.0 + moment).then(&at(0.2, [0.6 + moment, -0.3, 0.8])),
        light: light(),
        ..Draw::new(CUBE)
    };
    draw_all(scene, &[ball, cube])
}

/// A bar across the picture, a cross that lets the picture through, and a light spot beyond the right edge.
fn sprites() -> [Sprite<'static, u16>; 3] {
    static CROSS: [u16; 49] = {
        let mut cross = [0; 49];
        let mut i = 0;
        while i < 49 {
            if i % 7 == i / 7 || i % 7 == 6 - i / 7 {
                cross[i] = 0xFFE0_u16.to_be();
            }
            i += 1;
        }
        cross
    };
    let sprite = Sprite {
        x: -5,
        y: 4,
        width: 120,
        height: 6,
        pixels: Pixels::Colour(0x07E0_u16.to_be()),
        ink: Ink::Opaque,
    };
    [
        sprite,
        Sprite {
            x: 70,
            y: 50,
            width: 7,
            height: 7,
            pixels: Pixels::Image(&CROSS),
            ink: Ink::Keyed(0),
        },
        Sprite {
            x: 60,
            y: 70,
            height: 60,
            pixels: Pixels::Colour(0x30C6_u16.to_be()),
            ink: Ink::Additive,
            ..sprite
        },
    ]
}
