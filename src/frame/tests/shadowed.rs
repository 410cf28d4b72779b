//! What a call with a shadow leaves for the calls after it, and what is counted of one that found no room.

use super::kept::{NEAR, RED, Rooms, SIDE, Smooth, coloured};
use crate::geometry::{
    Affine, Camera, Cull, Faces, Light, Mesh, Screen, ShadowEdge, ShadowLight, ShadowMemory, Sphere,
};
use crate::look::Textured;
use crate::pixel::Rgb565;
use crate::scene::{
    Budget, Draw, DrawError, Full, Master, Scene, ScreenCorner, ScreenVertex, Shadow, Skin, TexGen,
    Texture, TexturePlace,
};

const CORNERS: [[i16; 3]; 4] = [
    [-9_000, -9_000, 0],
    [9_000, -9_000, 0],
    [0, 9_000, 0],
    [0, 0, 9_000],
];
const CLOSED: Mesh<'_> = Mesh {
    positions: &CORNERS,
    normals: &[],
    colours: &[],
    faces: Faces::Triangles(&[[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]]),
};

/// Draws the shadow that a mesh casts in a light from above.
fn cast(scene: &mut Scene<'_, '_, Smooth>) -> Result<(), DrawError> {
    let light = ShadowLight {
        light: 0,
        direction: Light::new([0.0, 1.0, 0.0], 0.0).unwrap().direction,
        reach: 4,
    };
    let memory = ShadowMemory {
        edges: &mut [ShadowEdge::default(); 12],
        positions: &mut [[0; 3]; 12],
        faces: &mut [[0; 3]; 12],
    };
    scene.draw_shadow(&CLOSED, &Affine::IDENTITY, &light, memory)
}

/// A volume by its mesh.
fn volume() -> Draw<'static, 'static> {
    Draw {
        shadow: Some(Shadow::Volume(0)),
        ..Draw::new(CLOSED)
    }
}

/// Kills: a shadow that is left out by the master, or that is skipped, and is not remembered.
#[test]
fn what_is_refused_beside_shadows_hangs_on_neither_master_nor_view() {
    let away = Draw {
        model: Affine::placed(1.0, [50.0, 0.0, 0.0]).unwrap(),
        shadow: Some(Shadow::Lit(0)),
        ..coloured(&NEAR, RED)
    };
    let ranked = Draw {
        priority: 1,
        ..coloured(&NEAR, RED)
    };
    for without in [None, Some(Master::SHADOWS), Some(Master::DEPTH)] {
        for call in 0..4 {
            let mut rooms = Rooms::new(90, 9);
            let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
            scene.set_master(without.map_or(Master::ALL, |part| Master::ALL.without(part)));
            match call {
                0 => cast(&mut scene).unwrap(),
                1 => scene.draw(&volume()).unwrap(),
                2 => scene.draw(&away).unwrap(),
                _ => {
                    let looked_at = scene.draw_within(&away, &Sphere::around(&NEAR));
                    assert_eq!(looked_at, Ok(false));
                }
            }
            let refused = scene.draw(&ranked);
            assert_eq!(refused, Err(DrawError::ShadowRanked), "{without:?} {call}");
        }
    }
}

/// Kills: a volume that found no room for both of its states, and counts as one all the same.
#[test]
fn a_volume_that_is_not_kept_is_forgotten() {
    let mut rooms = Rooms::new(90, 1);
    let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
    let full = DrawError::Full {
        memory: Full::Draws,
        triangles: 4,
        first_face: 0,
    };
    assert_eq!(scene.draw(&volume()), Err(full));
    let ranked = Draw {
        priority: 1,
        ..coloured(&NEAR, RED)
    };
    assert_eq!(scene.draw(&ranked), Ok(()));
}

/// Kills: what closes a volume at the near plane, and is counted neither as kept, nor as culled, nor as lost.
#[test]
fn triangles_at_the_near_plane_are_counted() {
    let (eye, ahead) = ([0.0, -1.0, 0.3], [0.0, -1.0, -5.0]);
    let camera = Camera::look_at(eye, ahead, [0.0, 1.0, 0.0], 60.0, 0.1, 100.0).unwrap();
    for states in 0..6 {
        let mut rooms = Rooms::new(90, states);
        let mut scene = rooms.scene::<Smooth>(SIDE, SIDE);
        scene.begin(&camera).unwrap();
        let drawn = cast(&mut scene);
        let counts = scene.assembled();
        assert_eq!(drawn.is_ok(), states >= 4);
        if drawn.is_ok() {
            let seen = counts.triangles - counts.culled;
            assert!(counts.culled > 0 && scene.objects() >= seen as usize);
        }
    }
}

/// Kills: a rule for texture places that stands for those that corners on the screen have.
#[test]
fn corners_on_the_screen_keep_their_texture_places() {
    static TEXELS: [u16; 64] = [0xF800; 64];
    static BRICKS: Texture<'_> = match Texture::words(&TEXELS, 8, 8) {
        Ok(texture) => texture,
        Err(_) => panic!("8 x 8 texels"),
    };
    let corner = |x, y, across| ScreenCorner {
        vertex: ScreenVertex {
            x,
            y,
            depth: 1 << 30,
            colour: [255; 3],
        },
        texel: [across, 0],
    };
    for texgen in [None, Some(TexGen::SPHERE)] {
        let mut rooms = Rooms::new(90, 2);
        rooms.places = std::vec![TexturePlace::EMPTY; 90];
        let mut scene =
            Scene::<Textured<Rgb565>>::new(Screen::new(SIDE, SIDE).unwrap(), rooms.memory());
        let eye = [0.0, 0.0, 2.0];
        let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.5, 100.0);
        scene.begin(&camera.unwrap()).unwrap();
        let skin = Skin {
            texture: &BRICKS,
            places: &[],
            budget: Budget::BALANCED,
        };
        let draw = Draw {
            texture: Some(skin),
            texgen,
            cull: Cull::None,
            ..Draw::new(CLOSED)
        };
        let wide = [
            corner(0, 0, 0),
            corner(300, 0, 5_000 << 8),
            corner(0, 300, 0),
        ];
        scene.draw_screen(&draw, &[wide]).unwrap();
        assert_eq!(scene.assembled().untextured, 1);
    }
}
