//! A small frame for each thing that goes beyond opaque matt surfaces, which must have the same
//! bits everywhere: transparency, shadows, light at each pixel, dither, palettes of lines, windows,
//! priorities.

use crate::{
    CUBE, METHOD_HEIGHT, METHOD_WIDTH, RIBBON, SPHERE, ShotError, build_method, method_screen,
};
use scanbeam::light::{DirectionalLight, Lamplight, Lighting, PixelLamps};
use scanbeam::list::Window;
use scanbeam::mesh::{I2F14, Material, U1F15};
use scanbeam::pipeline::blend::{
    Blend, Factor, Finish, ShadowEdge, ShadowLight, ShadowMemory, Surface,
};
use scanbeam::pipeline::{
    Clip, Composited, FlatDepth, GouraudDepth, Instance, PhongDepth, Pipeline, Prioritised,
    Priority, Scene, Shadowed, Windowed,
};
use scanbeam::pixel::{Dithered, Index8, LinePalettes, PixelFormat, Rgb565, Rgb565Be};
use scanbeam::{Affine, Camera, Cull, Light, Mesh};

/// Pixels a line of such a frame.
pub const EFFECT_WIDTH: u16 = METHOD_WIDTH;
/// Lines of such a frame.
pub const EFFECT_HEIGHT: u16 = METHOD_HEIGHT;
/// Vertices and objects that suffice for any of them.
pub const EFFECT_ROOM: usize = 2200;

/// The frames by name, in the order of [`by_effect`].
pub const EFFECTS: [&str; 7] = [
    "effect_transparency",
    "effect_shadows",
    "effect_phong",
    "effect_dither",
    "effect_palette",
    "effect_window",
    "effect_priority",
];

/// Surfaces with a finish.
pub type Transparent = Composited<GouraudDepth<Rgb565Be>>;
/// The same with shadows.
pub type Shady = Shadowed<GouraudDepth<Rgb565Be>>;
/// Light at each pixel.
pub type Lit<'l> = PhongDepth<'l, Rgb565Be>;
/// Dithered colours.
pub type Grainy = GouraudDepth<Dithered<Rgb565>>;

/// Numbers of a palette.
pub type Numbered = FlatDepth<Index8>;
/// Surfaces that are cut to windows.
pub type Cropped = Windowed<GouraudDepth<Rgb565Be>>;
/// The same without depth, by priority.
pub type Ranked = Prioritised<Cropped>;

/// What draws a frame with any of these pipelines.
pub trait DrawsEffect {
    /// Surfaces with a finish.
    fn transparent(&mut self, build: impl Fn(&mut Scene<'_, Transparent>) -> Result<(), ShotError>);
    /// Shadows.
    fn shady(&mut self, build: impl Fn(&mut Scene<'_, Shady>) -> Result<(), ShotError>);
    /// Light at each pixel, by these lights.
    fn lit<'l>(
        &mut self,
        lights: Lamplight<'l>,
        build: impl Fn(&mut Scene<'_, Lit<'l>>) -> Result<(), ShotError>,
    );
    /// Dither.
    fn grainy(&mut self, build: impl Fn(&mut Scene<'_, Grainy>) -> Result<(), ShotError>);
    /// Numbers, by these palettes; all is 0 where nothing is.
    fn numbered(
        &mut self,
        palettes: Dusk,
        build: impl Fn(&mut Scene<'_, Numbered>) -> Result<(), ShotError>,
    );
    /// Windows.
    fn cropped(&mut self, build: impl Fn(&mut Scene<'_, Cropped>) -> Result<(), ShotError>);
    /// Priorities.
    fn ranked(&mut self, build: impl Fn(&mut Scene<'_, Ranked>) -> Result<(), ShotError>);
}

/// Has the frame of [`EFFECTS`] at `index` drawn; the last one for any index above.
///
/// # Errors
/// When the camera or a light cannot be made, which is never.
pub fn by_effect(index: usize, to: &mut impl DrawsEffect) -> Result<(), ShotError> {
    match index {
        0 => to.transparent(transparency),
        1 => to.shady(shadows),
        2 => {
            let camera = camera()?;
            let light = DirectionalLight::new([0.6, 0.8, 1.0], [1.0, 0.9, 0.8]);
            let lighting = light.as_ref().and_then(|light| {
                let ambient = [U1F15::from_bits(5_000); 3];
                Lighting::new(
                    core::slice::from_ref(light),
                    ambient,
                    Material::shiny(0.6, 30),
                )
            });
            let lamps = lighting.map(|l| PixelLamps::new(&l, &camera, method_screen()));
            to.lit(Lamplight(lamps.as_slice()), phong);
        }
        3 => to.grainy(build_method),
        4 => to.numbered(Dusk::new(), palette),
        5 => to.cropped(windows),
        _ => to.ranked(priorities),
    }
    Ok(())
}

fn camera() -> Result<Camera, ShotError> {
    let up = [0.0, 1.0, 0.0];
    Ok(Camera::look_at(
        [0.6, 1.0, 2.8],
        [0.0; 3],
        up,
        56.0,
        0.1,
        100.0,
    )?)
}

fn at(scale: f32, place: [f32; 3]) -> Affine {
    Affine::placed(scale, place).unwrap_or(Affine::IDENTITY)
}

/// Panes of all kinds around a ribbon, in each other and in front of a cube.
fn transparency(scene: &mut Scene<'_, Transparent>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let open = Instance {
        cull: Cull::None,
        light: Light::new([0.3, 0.8, 0.6], 0.4),
        ..Instance::default()
    };
    scene.draw(&RIBBON, &open)?;
    let back = Instance {
        model: Affine::rotation_y(0.6).then(&at(0.7, [0.3, 0.0, -1.6])),
        ..open
    };
    scene.draw(&CUBE, &back)?;
    let finishes = [
        Finish::filtered(120),
        Finish::additive(200),
        Finish::subtractive(90),
        Finish::blended(Blend::Half, 255),
        Finish::blended(
            Blend::Factors {
                source: Factor::SourceAlpha,
                destination: Factor::Destination,
            },
            180,
        ),
    ];
    for (i, finish) in (0u8..).zip(finishes) {
        let angle = 0.9 * f32::from(i);
        let place = [0.45 * f32::from(i) - 0.9, 0.1 * f32::from(i), 0.2];
        let instance = Instance {
            model: Affine::rotation_x(angle)
                .then(&Affine::rotation_y(2.0 * angle))
                .then(&at(0.3, place)),
            ..open
        };
        scene.draw_skinned(&CUBE, Surface::from(finish), &instance)?;
    }
    Ok(())
}

/// Two turned cubes that throw shadows on each other and on a floor.
fn shadows(scene: &mut Scene<'_, Shady>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let Some(light) = Light::new([0.7, 1.0, 0.4], 0.3) else {
        return Ok(());
    };
    let floor = at(4.0, [0.0, -4.6, 0.0]);
    let cubes = [
        Affine::rotation_y(0.5).then(&at(0.35, [-0.3, -0.1, 0.2])),
        Affine::rotation_x(0.8).then(&at(0.25, [0.45, 0.5, 0.5])),
    ];
    let draw = |scene: &mut Scene<'_, Shady>, finish: Finish, light: Light| {
        for model in cubes.iter().chain([&floor]) {
            let instance = Instance {
                model: *model,
                light: Some(light),
                ..Instance::default()
            };
            scene.draw_skinned(&CUBE, Surface::from(finish), &instance)?;
        }
        Ok::<_, ShotError>(())
    };
    draw(scene, Finish::OPAQUE, light)?;
    let shadow = ShadowLight {
        light: 0,
        direction: light.direction,
        reach: 5,
    };
    for model in &cubes {
        let memory = ShadowMemory {
            edges: &mut [ShadowEdge::default(); 36],
            positions: &mut [[0; 3]; 72],
            faces: &mut [[0; 3]; 72],
        };
        // Each corner once, so that the mesh is closed.
        let cube = Mesh {
            positions: &CORNERS,
            normals: &[],
            colours: &[],
            faces: scanbeam::Faces::Quads(&SIDES, scanbeam::mesh::QuadSplit::Corner0To2),
        };
        // The memory suffices, and a scene that is full says so for the cubes too.
        if scene.draw_shadow(&cube, model, &shadow, memory).is_err() {
            break;
        }
    }
    // A light from nowhere: that from everywhere alone.
    let dark = Light {
        direction: [I2F14::ZERO; 3],
        ..light
    };
    draw(scene, Finish::in_shadow(0), dark)
}

const ONE: i16 = 1 << 14;
pub(crate) static CORNERS: [[i16; 3]; 8] = [
    [-ONE, -ONE, -ONE],
    [ONE, -ONE, -ONE],
    [-ONE, ONE, -ONE],
    [ONE, ONE, -ONE],
    [-ONE, -ONE, ONE],
    [ONE, -ONE, ONE],
    [-ONE, ONE, ONE],
    [ONE, ONE, ONE],
];
pub(crate) static SIDES: [[u16; 4]; 6] = [
    [1, 3, 7, 5],
    [0, 4, 6, 2],
    [2, 6, 7, 3],
    [0, 1, 5, 4],
    [4, 5, 7, 6],
    [0, 2, 3, 1],
];

/// A ball and a ribbon.
fn phong<P: Pipeline>(scene: &mut Scene<'_, P>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let ball = Instance {
        model: Affine::rotation_x(0.5).then(&at(0.8, [-0.2, 0.1, 0.0])),
        colour: [200, 90, 60],
        ..Instance::default()
    };
    scene.draw(&SPHERE, &ball)?;
    let ribbon = Instance {
        model: Affine::rotation_y(0.3).then(&at(1.0, [0.2, -0.3, 0.8])),
        cull: Cull::None,
        ..Instance::default()
    };
    scene.draw(&RIBBON, &ribbon)?;
    Ok(())
}

/// A ramp above the water and one below it, and a sky that changes from line to line.
pub struct Dusk([[u16; 256]; 2]);

impl Dusk {
    fn new() -> Self {
        let ramp = |[r, g, b]: [u16; 3]| {
            core::array::from_fn(|i| {
                let level = |full: u16| (i as u16 * full / 255) as u8;
                Rgb565Be::from_rgb8([level(r), level(g), level(b)])
            })
        };
        Self([ramp([255, 190, 110]), ramp([40, 150, 210])])
    }
}

impl LinePalettes<u16, 256> for Dusk {
    fn palette(&mut self, line: u16) -> &[u16; 256] {
        let high = (4 * (EFFECT_HEIGHT - line.min(EFFECT_HEIGHT))) as u8;
        let water = usize::from(line >= EFFECT_HEIGHT / 2);
        let palette = &mut self.0[water];
        palette[0] = match water {
            0 => Rgb565Be::from_rgb8([240 - high / 2, 120, high]),
            _ => Rgb565Be::from_rgb8([0, high / 2, 40 + high]),
        };
        palette
    }
}

/// A ball and a cube of flat faces, whose light is a place on a ramp.
fn palette(scene: &mut Scene<'_, Numbered>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let lit = Instance {
        model: at(0.7, [-0.5, 0.1, 0.0]),
        light: Light::new([0.3, 0.8, 0.6], 0.3),
        colour: Index8::colour(255),
        ..Instance::default()
    };
    scene.draw(&SPHERE, &lit)?;
    let cube = Mesh {
        colours: &[],
        ..CUBE
    };
    let turned = Instance {
        model: Affine::rotation_y(0.6).then(&at(0.45, [0.9, -0.2, 0.3])),
        ..lit
    };
    scene.draw(&cube, &turned)?;
    Ok(())
}

const fn window(left: u16, top: u16, right: u16, bottom: u16) -> Window {
    Window {
        left,
        top,
        right,
        bottom,
    }
}

/// A ball with a hole, a ribbon in the hole and beyond, and a cube in a corner.
fn windows(scene: &mut Scene<'_, Cropped>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let lit = Instance {
        light: Light::new([0.3, 0.8, 0.6], 0.3),
        colour: [210, 120, 90],
        ..Instance::default()
    };
    scene.set_clip(Clip::Outside(window(25, 14, 51, 37)));
    scene.draw(&SPHERE, &lit)?;
    scene.set_clip(Clip::Inside(window(17, 0, 73, 33)));
    let open = Instance {
        cull: Cull::None,
        ..lit
    };
    scene.draw(&RIBBON, &open)?;
    scene.set_clip(Clip::Inside(window(50, 31, 100, 100)));
    let front = Instance {
        model: Affine::rotation_y(0.6).then(&at(0.5, [0.6, -0.4, 0.9])),
        ..lit
    };
    scene.draw(&CUBE, &front)?;
    Ok(())
}

/// Four cubes and a ball, each drawn before what is behind it, partly in windows.
fn priorities(scene: &mut Scene<'_, Ranked>) -> Result<(), ShotError> {
    scene.begin(&camera()?)?;
    let lit = Instance {
        light: Light::new([0.3, 0.8, 0.6], 0.3),
        colour: [90, 160, 220],
        ..Instance::default()
    };
    for i in 0u8..4 {
        let near = f32::from(3 - i);
        scene.set_priority(Priority(200 - 7 * i));
        scene.set_clip(match i {
            1 => Clip::Inside(window(11, 7, 60, 44)),
            2 => Clip::Outside(window(30, 20, 46, 39)),
            _ => Clip::Picture,
        });
        let model = Affine::rotation_x(0.3 * near)
            .then(&Affine::rotation_y(0.5 + near))
            .then(&at(
                0.35,
                [0.45 * near - 0.8, 0.2 - 0.1 * near, 0.5 * near - 0.6],
            ));
        scene.draw(&CUBE, &Instance { model, ..lit })?;
    }
    scene.set_priority(Priority(3));
    scene.set_clip(Clip::Picture);
    let ball = Instance {
        model: at(0.9, [0.0, 0.2, -1.5]),
        ..lit
    };
    scene.draw(&SPHERE, &ball)?;
    Ok(())
}
