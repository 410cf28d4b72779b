//! Points of three sizes on balls, and triangles that are set up beforehand over and behind it, by a camera that looks
//! aside (H11, K3).

use super::scenes::{GRILLE, PANEL, at, camera, light};
use crate::SPHERE;
use crate::ShotError;
use crate::looks::TexturedLook;
use scanbeam::mesh::ScreenVertex;
use scanbeam::scene::{Budget, Draw, Scene, ScreenCorner, Skin, Texture};
use scanbeam::{Affine, Cull, Faces, Mesh};

const NOTHING: Mesh<'static> = Mesh {
    positions: &[],
    normals: &[],
    colours: &[],
    faces: Faces::Triangles(&[]),
};

/// Points of a cloud.
const CLOUD: usize = 140;

/// A rectangle of the screen at a depth, the texture once on it.
fn card(left: i16, top: i16, depth: u32) -> [[ScreenCorner; 3]; 2] {
    let corner = |x: i16, y: i16| ScreenCorner {
        vertex: ScreenVertex {
            x: 8 * left + 8 * 40 * x + 3,
            y: 8 * top + 8 * 36 * y - 5,
            depth,
            colour: [255, 255 - 90 * x as u8, 120 + 80 * y as u8],
        },
        texel: [i32::from(x) << 14, i32::from(y) << 14],
    };
    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    [[a, b, c], [a, c, d]]
}

/// Makes the scene.
pub(super) fn points(scene: &mut Scene<'_, 'static, TexturedLook>) -> Result<(), ShotError> {
    let aside = camera()?
        .shifted([21.5, -8.25])
        .map_err(ShotError::Camera)?;
    scene.begin(&aside).map_err(ShotError::Begin)?;
    // Every third vertex of a ball.
    let some = |values: &[[i16; 3]]| {
        let mut thirds = values.iter().step_by(3);
        [[0; 3]; CLOUD].map(|none| thirds.next().copied().unwrap_or(none))
    };
    let (positions, normals) = (some(SPHERE.positions), some(SPHERE.normals));
    for (size, angle, scale) in [(1, 0.3, 0.9), (3, 1.1, 0.6), (2, 2.0, 0.75)] {
        let cloud = Draw {
            model: Affine::rotation_y(angle).then(&at(scale, [0.0; 3])),
            light: light(),
            colour: [255, 190, 90],
            ..Draw::new(Mesh {
                positions: &positions,
                normals: &normals,
                ..NOTHING
            })
        };
        scene.draw_points(&cloud, size).map_err(ShotError::Draw)?;
    }
    let with = |texture: &'static Texture<'static>| Draw {
        cull: Cull::None,
        texture: Some(Skin {
            texture,
            places: &[],
            budget: Budget::BALANCED,
        }),
        ..Draw::new(NOTHING)
    };
    // In front of all points, and among them.
    let near = card(70, 60, 1 << 30);
    let among = card(20, 40, 76_000_000);
    scene
        .draw_screen(&with(&GRILLE), &near)
        .map_err(ShotError::Draw)?;
    scene
        .draw_screen(&with(&PANEL), &among)
        .map_err(ShotError::Draw)
}
