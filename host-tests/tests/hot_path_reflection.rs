//! Texture places from normals: whatever way a triangle goes, its places are those that a skin could have given.
//!
//! Without a turn the rule is whole numbers, so pictures are the same to the bit.

use crate::common::Rng;
use crate::hot::{Corner, SceneRooms, camera, draw_with, frame};
use scanbeam::MeshError;
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{Rgb565, Rgb565Be};
use scanbeam::scene::{Application, Budget, Draw, DrawError, Shading, Skin, TexGen, Texture};
use scanbeam::{Cull, Light, Screen};

const SIDE: i32 = 64;

/// A texture no two texels of which are alike.
fn map() -> Texture<'static> {
    let texels: Vec<u16> = (0..SIDE * SIDE).map(|i| (i * 13) as u16).collect();
    Texture::words(texels.leak(), SIDE as u32, SIDE as u32).expect("as many as the sides need")
}

/// The place of a normal that the camera sees as it is: to the right, and down.
fn place([x, y, _]: [i16; 3]) -> [i32; 2] {
    let across = |c: i32| SIDE * 128 + ((c * ((SIDE - 1) * 64) + 4096) >> 13);
    [across(x.into()), across(-i32::from(y))]
}

/// Kills: normals of another vertex or chunk, a map upside down, corners of cut or flat triangles without a place.
#[test]
fn places_from_normals_are_those_that_a_skin_could_give() {
    let mut rng = Rng::new(1_941);
    let texture: &'static Texture<'_> = Box::leak(Box::new(map()));
    let screen = Screen::new(64, 24).expect("a screen");
    let (mut seen, mut clipped) = (0, 0);
    for round in 0..200 {
        let count = 1 + rng.below(14) as usize;
        let triangles: Vec<[Corner; 3]> = (0..count)
            .map(|_| {
                [(); 3].map(|()| Corner {
                    at: (rng.within(-200, 700), rng.within(-200, 400)),
                    // Some of them nearer than the near plane.
                    w: rng.between(0.7, 3.0),
                    colour: [255; 3],
                })
            })
            .collect();
        let some = |rng: &mut Rng| {
            let v = [(); 3].map(|()| rng.signed());
            let length = v.iter().map(|c| c * c).sum::<f64>().sqrt().max(0.1);
            v.map(|c| (c / length * 16_384.0).round() as i16)
        };
        let normals: Vec<_> = (0..3 * count).map(|_| some(&mut rng)).collect();
        let places: Vec<_> = normals.iter().map(|&normal| place(normal)).collect();
        let (normals, places): (&'static _, &'static _) = (normals.leak(), places.leak());
        let is_lit = rng.below(2) == 0;
        let dress = |draw: &mut Draw<'_, '_, i32>, made: bool| {
            draw.cull = Cull::None;
            draw.mesh.normals = normals;
            draw.light = Light::new([0.3, 0.8, 0.6], 0.3).filter(|_| is_lit);
            draw.texgen = made.then_some(TexGen::SPHERE);
            draw.texture = Some(Skin {
                texture,
                places: if made { &[] } else { places },
                budget: Budget::EXACT,
            });
            match round % 4 {
                0 => draw.shading = Shading::Flat,
                1 => draw.application = Application::Replace,
                _ => {}
            }
        };
        // With room for all vertices, and for those of triangles alone.
        for room in [9 * count, 0] {
            let mut pictures = [true, false].map(|made| {
                let mut rooms = SceneRooms::new(12 * count, 4 * count, 24, 1);
                if room == 0 {
                    rooms.vertices.truncate(3 * count - 1);
                }
                let mut scene = rooms.scene::<Textured<Rgb565>>(screen);
                scene.begin(&camera()).expect("the rooms are large enough");
                // What finds no room is left out, of both alike.
                let _ = draw_with(&mut scene, &triangles, |draw| dress(draw, made));
                clipped += scene.assembled().clipped;
                frame(&scene, 8, true, 0)
            });
            let [made, given] = &mut pictures;
            assert!(made == given, "round {round}, {room} vertices");
            seen += made.iter().flatten().filter(|&&pixel| pixel != 0).count();
        }
    }
    assert!(seen > 100_000 && clipped > 300, "{seen}, {clipped}");
}

/// Normals are needed, and places are not; a look without textures says so all the same.
#[test]
fn normals_are_needed_and_places_are_not() {
    let texture: &'static Texture<'_> = Box::leak(Box::new(map()));
    let screen = Screen::new(64, 24).expect("a screen");
    let corners = [(0, 0), (300, 0), (0, 150)].map(|at| Corner {
        at,
        w: 1.0,
        colour: [255; 3],
    });
    let dress = |draw: &mut Draw<'_, '_, i32>, normals: &'static [[i16; 3]]| {
        draw.mesh.normals = normals;
        draw.texgen = Some(TexGen::SPHERE);
        draw.texture = Some(Skin {
            texture,
            places: &[],
            budget: Budget::EXACT,
        });
    };
    let mut rooms = SceneRooms::of_triangles(2, screen);
    let mut scene = rooms.scene::<Textured<Rgb565Be>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    let drawn = draw_with(&mut scene, &[corners], |draw| dress(draw, &[]));
    assert_eq!(drawn, Err(DrawError::Mesh(MeshError::AttributeLength)));
    let drawn = draw_with(&mut scene, &[corners], |draw| {
        dress(draw, &[[0, 0, 16_384]; 3])
    });
    assert_eq!(drawn, Ok(()));
    let mut rooms = SceneRooms::of_triangles(2, screen);
    let mut scene = rooms.scene::<Gouraud<Rgb565Be>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    let drawn = draw_with(&mut scene, &[corners], |draw| {
        dress(draw, &[[0, 0, 16_384]; 3])
    });
    assert_eq!(drawn, Err(DrawError::Untextured));
}
