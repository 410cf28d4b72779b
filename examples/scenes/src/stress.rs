//! Random triangles at the ends of what numbers hold, drawn on the host and on every target (M3,
//! X1).

use crate::{Shot, ShotError};
use scanbeam::look::Look;
use scanbeam::scene::Shading;
use scanbeam::{Affine, Camera, Cull, Draw, Faces, Mesh, Scene};

/// The shots of this file.
pub const STRESS: [Shot; 3] = [Shot::Slivers, Shot::Giants, Shot::Crossings];

/// Random numbers of 24 bits, the same everywhere.
struct Random(u32);

impl Random {
    /// From -`reach` below `reach`.
    fn within(&mut self, reach: i32) -> i32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((i64::from(self.0 >> 8) * i64::from(reach)) >> 23) as i32 - reach
    }

    /// A place, Q1.30.
    fn place(&mut self, reach: [i32; 3]) -> [i32; 3] {
        reach.map(|r| self.within(r))
    }

    /// A colour whose channels are 0, full, or between.
    fn colour(&mut self) -> [u8; 3] {
        [(); 3].map(|()| self.within(383).clamp(-128, 127) as i8 as u8 ^ 0x80)
    }
}

/// 1.0 in Q1.30.
const ONE: i32 = 1 << 30;

/// Draws one of [`STRESS`]; other shots draw nothing here.
///
/// The camera is at the origin and looks along -z: 160 pixels of focal length, so the picture is
/// 2 by 1.5 at distance 1.
pub(crate) fn build<L: Look>(
    shot: Shot,
    shading: Shading,
    scene: &mut Scene<'_, '_, L>,
) -> Result<(), ShotError> {
    let (near, far) = if shot == Shot::Crossings {
        (0.03, 64.0)
    } else {
        (0.5, 4096.0)
    };
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    scene.begin(&Camera::look_at([0.0; 3], ahead, up, 160.0, near, far)?)?;
    let mut random = Random(1);
    match shot {
        // From one place of the picture to another, up to half a pixel wide.
        Shot::Slivers => {
            for _ in 0..72 {
                let mut end = || random.place([ONE, ONE / 4 * 3, 1]);
                let (a, b) = (end(), end());
                let half_way = [0, 1, 2].map(|i| a[i] / 2 + b[i] / 2 + random.within(ONE / 320));
                let away = -ONE - random.within(ONE / 2).abs();
                let places = [a, b, half_way].map(|p| [p[0], p[1], away]);
                triangle(shading, scene, &mut random, places, 1.0)?;
            }
            // 1/w from 1 to 2^-12 along one sliver.
            for _ in 0..24 {
                let [x, y, _] = random.place([ONE / 4096, ONE / 4096, 1]);
                let far = random.place([ONE, ONE, 1]);
                let near = -ONE / 4095;
                let places = [
                    [x, y, near],
                    [x + ONE / 1_000_000, y, near],
                    [far[0], far[1], -ONE],
                ];
                triangle(shading, scene, &mut random, places, 4096.0)?;
            }
        }
        // Up to 8192 pixels wide and high; most of each is beside the picture.
        Shot::Giants => {
            for i in 0..20 {
                let mut corner = || {
                    let [x, y, _] = random.place([ONE, ONE, 1]);
                    [x, y, -ONE / 48 - random.within(ONE / 3).abs()]
                };
                let (a, b, mut c) = (corner(), corner(), corner());
                if i % 2 == 1 {
                    // As long, and a few pixels wide.
                    c = b.map(|v| v - random.within(ONE / 64).abs());
                }
                triangle(shading, scene, &mut random, [a, b, c], 32.0)?;
            }
        }
        // Through the near plane at any angle, some of them beyond the sides too.
        Shot::Crossings => {
            for i in 0..96 {
                let reach = ONE / [1, 4, 16][i % 3];
                let places = [(); 3].map(|()| random.place([reach; 3]));
                triangle(shading, scene, &mut random, places, 1.0)?;
            }
        }
        _ => {}
    }
    Ok(())
}

/// One triangle in random colours, its model scaled.
fn triangle<L: Look>(
    shading: Shading,
    scene: &mut Scene<'_, '_, L>,
    random: &mut Random,
    positions: [[i32; 3]; 3],
    scale: f32,
) -> Result<(), ShotError> {
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[random.colour(), random.colour(), random.colour()],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    scene.draw(&Draw {
        model: Affine::placed(scale, [0.0; 3]).unwrap_or(Affine::IDENTITY),
        cull: Cull::None,
        shading,
        ..Draw::new(mesh)
    })?;
    Ok(())
}
