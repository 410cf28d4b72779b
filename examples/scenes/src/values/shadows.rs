//! Two cubes, an octahedron of a list, a ribbon and a pane over a floor, in two lights: what light from everywhere makes
//! of them, the volumes of both lights, and what each light adds where it is not in the way (K9).

use super::octahedron::octahedron;
use super::scenes::{at, camera, uncoloured};
use crate::ShotError;
use crate::looks::SmoothLook;
use crate::{CUBE, RIBBON};
use scanbeam::mesh::QuadSplit;
use scanbeam::scene::{Blend, Draw, Scene, Shadow, ShadowEdge, ShadowLight, ShadowMemory};
use scanbeam::{Affine, Cull, Faces, Light, Mesh};

/// Where a light comes from, and what it makes of white.
struct Lamp {
    towards: [f32; 3],
    colour: [u8; 3],
}

const LAMPS: [Lamp; 2] = [
    Lamp {
        towards: [0.7, 1.0, 0.4],
        colour: [150, 125, 80],
    },
    Lamp {
        towards: [-0.8, 0.9, 0.7],
        colour: [30, 60, 110],
    },
];

const ONE: i16 = 1 << 14;
static CORNERS: [[i16; 3]; 8] = [
    [-ONE, -ONE, -ONE],
    [ONE, -ONE, -ONE],
    [-ONE, ONE, -ONE],
    [ONE, ONE, -ONE],
    [-ONE, -ONE, ONE],
    [ONE, -ONE, ONE],
    [-ONE, ONE, ONE],
    [ONE, ONE, ONE],
];
static SIDES: [[u16; 4]; 6] = [
    [1, 3, 7, 5],
    [0, 4, 6, 2],
    [2, 6, 7, 3],
    [0, 1, 5, 4],
    [4, 5, 7, 6],
    [0, 2, 3, 1],
];

/// Each corner once, so that the mesh is closed.
const CLOSED: Mesh<'static> = Mesh {
    positions: &CORNERS,
    normals: &[],
    colours: &[],
    faces: Faces::Quads(&SIDES, QuadSplit::Corner0To2),
};

/// Draws the volumes of a cube.
fn throw(
    scene: &mut Scene<'_, 'static, SmoothLook>,
    model: &Affine,
    light: &ShadowLight,
) -> Result<(), ShotError> {
    let memory = ShadowMemory {
        edges: &mut [ShadowEdge::default(); 36],
        positions: &mut [[0; 3]; 24],
        faces: &mut [[0; 3]; 24],
    };
    let drawn = scene.draw_shadow(&CLOSED, model, light, memory);
    drawn.map_err(ShotError::Draw)
}

/// Makes the scene.
pub(super) fn shadows(scene: &mut Scene<'_, 'static, SmoothLook>) -> Result<(), ShotError> {
    scene.begin(&camera()?).map_err(ShotError::Begin)?;
    let cubes = [
        Affine::rotation_y(0.5).then(&at(0.35, [-0.3, -0.1, 0.2])),
        Affine::rotation_x(0.8).then(&at(0.25, [0.45, 0.5, 0.5])),
    ];
    let floor = at(4.0, [0.0, -4.6, 0.0]);
    let ribbon = Affine::rotation_y(0.3).then(&at(0.7, [0.5, -0.3, 0.3]));
    let draw_all = |scene: &mut Scene<'_, 'static, SmoothLook>, dressed: &Draw<'_, 'static>| {
        for model in cubes.into_iter().chain([floor]) {
            let call = Draw { model, ..*dressed };
            scene.draw(&call).map_err(ShotError::Draw)?;
        }
        let open = Draw {
            mesh: uncoloured(RIBBON),
            model: ribbon,
            cull: Cull::None,
            ..*dressed
        };
        scene.draw(&open).map_err(ShotError::Draw)
    };
    let dark = Draw {
        colour: [40, 40, 50],
        ..Draw::new(uncoloured(CUBE))
    };
    draw_all(scene, &dark)?;
    let lights = LAMPS.each_ref().map(|lamp| Light::new(lamp.towards, 0.0));
    let [Some(warm), Some(cold)] = lights else {
        return Err(ShotError::Light);
    };
    let casts = [(0, warm), (1, cold)].map(|(light, lit)| ShadowLight {
        light,
        direction: lit.direction,
        reach: 5,
    });
    let turned = Affine::rotation_x(0.4).then(&at(0.3, [-0.7, 0.35, -0.4]));
    let thrown = Draw {
        model: turned,
        ..dark
    };
    octahedron(scene, &thrown, &casts)?;
    for ((lit, lamp), cast) in [warm, cold].into_iter().zip(&LAMPS).zip(&casts) {
        for model in &cubes {
            throw(scene, model, cast)?;
        }
        let adds = Draw {
            colour: lamp.colour,
            light: Some(lit),
            shadow: Some(Shadow::Lit(cast.light)),
            blend: Some(Blend::add(255)),
            ..dark
        };
        draw_all(scene, &adds)?;
        let model = turned;
        octahedron(scene, &Draw { model, ..adds }, &[])?;
    }
    let pane = Draw {
        model: Affine::rotation_y(0.9).then(&at(0.2, [-0.75, 0.05, 0.8])),
        cull: Cull::None,
        colour: [90, 200, 120],
        blend: Some(Blend::filter(110)),
        ..Draw::new(uncoloured(CUBE))
    };
    scene.draw(&pane).map_err(ShotError::Draw)
}
