//! K10: light at each pixel, as a look: against the formulae in f64 at every pixel of any triangles.
//!
//! A normal is linear between the corners and made unit length at the pixel. Its bits turn it by 1/2000 of its length
//! across and down and 1/1000 ahead, more where corners differ and what is between them is short; what that does to
//! the level is the bound, and what rounding does.

mod mixed;

use crate::common::Rng;
use crate::hot::exact::{weights, within};
use crate::hot::shine::{V3, dot, q14, some_direction, unit};
use crate::hot::{Corner, SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::look::{Gouraud, Phong, TexturedPhong};
use scanbeam::mesh::{Material, U1F15};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::scene::{Application, Budget, Draw, DrawError, Shading, Skin, Texture};
use scanbeam::{Cull, Light, Screen};

/// Lights and a material, in f64.
struct Shine {
    lights: Vec<(V3, V3)>,
    ambient: V3,
    material: Material,
}

fn real(level: [U1F15; 3]) -> V3 {
    level.map(|c| f64::from(c.to_bits()) / 32_768.0)
}

impl Shine {
    fn new(rng: &mut Rng, count: u32) -> Self {
        let mut levels = |most: u32| [(); 3].map(|()| U1F15::from_bits(rng.below(most) as u16));
        let material = Material {
            ambient: levels(1 << 15),
            diffuse: levels(1 << 15),
            specular: levels(1 << 15),
            emission: levels(1 << 12),
            shininess: 1,
        };
        let ambient = real(levels(1 << 14));
        let shininess = rng.pick(&[1, 4, 16, 40]);
        let lights = (0..count).map(|_| (some_direction(rng), [(); 3].map(|()| rng.unit())));
        Self {
            lights: lights.collect(),
            ambient,
            material: Material {
                shininess,
                ..material
            },
        }
    }

    fn lamps(&self, screen: Screen) -> PixelLamps {
        let f32s = |v: V3| v.map(|c| c as f32);
        let light = |&(towards, colour): &(V3, V3)| {
            DirectionalLight::new(f32s(towards), f32s(colour)).expect("a direction")
        };
        let lights: Vec<_> = self.lights.iter().map(light).collect();
        let ambient = self
            .ambient
            .map(|c| U1F15::from_bits((c * 32_768.0) as u16));
        let lighting = Lighting::new(&lights, ambient, self.material).expect("not too many");
        PixelLamps::new(&lighting, &camera(), screen)
    }

    /// The least and the most level of a channel, of a normal that may be turned by an angle.
    fn level(&self, i: usize, own: f64, normal: V3, eye: V3, turned: f64) -> [f64; 2] {
        let of = |levels: [U1F15; 3]| real(levels)[i];
        let Material {
            ambient,
            diffuse,
            specular,
            emission,
            shininess,
        } = self.material;
        // Between what is behind and what faces the light nothing jumps but what is mirrored.
        let mut sum = [own * self.ambient[i] * of(ambient) + of(emission); 2];
        for (towards, colour) in &self.lights {
            let falls = dot(normal, *towards);
            let angle = falls.clamp(-1.0, 1.0).acos();
            let mirrored = [0, 1, 2].map(|k| 2.0 * falls * normal[k] - towards[k]);
            let glance = dot(mirrored, eye).clamp(-1.0, 1.0).acos();
            for (sum, side) in sum.iter_mut().zip([1.0, -1.0]) {
                let lit = (angle + side * turned).max(0.0).cos().max(0.0);
                let near = (glance + side * 2.0 * turned).max(0.0).cos().max(0.0);
                let shine = if lit > 0.0 {
                    near.powi(shininess.into())
                } else {
                    0.0
                };
                *sum += colour[i] * (own * of(diffuse) * lit + of(specular) * shine);
            }
        }
        sum.map(|level| 255.0 * level.min(1.0))
    }
}

/// A triangle and its normals.
struct Facet {
    corners: [Corner; 3],
    normals: [V3; 3],
}

impl Facet {
    fn new(rng: &mut Rng, screen: Screen) -> Self {
        Self::slanted(rng, screen, &[1.0, 2.0])
    }

    /// Up to one of so many times as far at one corner as at another.
    fn slanted(rng: &mut Rng, screen: Screen, slants: &[f64]) -> Self {
        let size = rng.pick(&[20, 60, 300, 2_000]);
        let middle =
            [screen.width(), screen.height()].map(|side| rng.within(0, 8 * i32::from(side)));
        let w = 1.0 + 3.0 * rng.unit();
        let slant = rng.pick(slants);
        let towards = some_direction(rng);
        Self {
            corners: [(); 3].map(|()| Corner {
                at: (
                    middle[0] + rng.within(-size, size),
                    middle[1] + rng.within(-size, size),
                ),
                w: w * rng.between(1.0, slant),
                colour: [0; 3],
            }),
            normals: [(); 3].map(|()| {
                let to = some_direction(rng);
                let mean = unit([0, 1, 2].map(|k| towards[k] + 0.8 * to[k]));
                mean.map(|c| (c * 16_384.0).round() / 16_384.0)
            }),
        }
    }

    fn normal(&self, x: u16, y: u16) -> V3 {
        let (part, _) = weights(self.corners.map(|c| c.at), x.into(), y.into());
        [0, 1, 2].map(|i| (0..3).map(|k| part[k] * self.normals[k][i]).sum())
    }

    fn dress<'t>(&self, draw: &mut Draw<'_, 't, i32>, lamps: &'t PixelLamps, colour: [u8; 3]) {
        // A call may outlive this one, as the compiler sees it.
        let normals: &'static [_] = self.normals.map(q14).to_vec().leak();
        (draw.mesh.normals, draw.mesh.colours) = (normals, &[]);
        (draw.colour, draw.lamps, draw.cull) = (colour, Some(lamps), Cull::None);
    }
}

/// In every other round the face has one normal; in half of these and of others nothing is mirrored, and in half of
/// those nothing shines by itself. Some have two equal normals, or more than full light.
fn even_in_some(round: u32, facet: &mut Facet, shine: &mut Shine) {
    if round % 2 == 1 {
        facet.normals = [facet.normals[0]; 3];
    }
    if round % 16 == 6 {
        facet.normals[1] = facet.normals[0];
    }
    if round % 8 == 7 {
        shine.material.diffuse = [U1F15::from_bits(u16::MAX); 3];
    }
    if round % 4 >= 2 {
        shine.material.specular = [U1F15::ZERO; 3];
    }
    if round % 8 >= 4 {
        shine.material.emission = [U1F15::ZERO; 3];
    }
}

/// From the pixel to the eye.
fn eye(screen: Screen, x: u16, y: u16) -> V3 {
    let from = |at: u16, side: u16| (f64::from(at) + 0.5 - f64::from(side) / 2.0) / 4096.0;
    unit([-from(x, screen.width()), from(y, screen.height()), 1.0])
}

/// Kills: fields in another order, a middle that is off by a unit, planes that are taken a column too late, normals that
/// are not made unit length; a face of one normal in which something is mirrored, or that has two normals, lit once, as is one
/// that shines by itself, or whose light is more than full.
fn pixels_are_the_formula<L: Smooth>(seed: u64, off: f64) -> usize {
    let mut rng = Rng::new(seed);
    let mut pixels = 0;
    for round in 0..400 {
        let screen = Screen::new(rng.pick(&[40, 64]), 24).expect("a screen");
        let mut facet = Facet::new(&mut rng, screen);
        let mut shine = Shine::new(&mut rng, round % 9);
        even_in_some(round, &mut facet, &mut shine);
        let lamps: &'static _ = Box::leak(Box::new(shine.lamps(screen)));
        let colour = [(); 3].map(|()| rng.below(256) as u8);
        let mut rooms = SceneRooms::of_triangles(1, screen);
        let mut scene = rooms.scene::<L>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        draw_with(&mut scene, &[facet.corners], |draw| {
            facet.dress(draw, lamps, colour)
        })
        .expect("there is room");
        let slots = rng.pick(&[0, 4]);
        let lines = frame(&scene, slots, true, L::Format::from_rgb8([0; 3]));
        for (y, words) in (0..).zip(&lines) {
            let columns = within(facet.corners.map(|c| c.at), y.into(), screen.width());
            for x in columns {
                let normal = facet.normal(x as u16, y);
                let length = dot(normal, normal).sqrt();
                let turned = 0.0013 / length;
                let got = L::Format::to_rgb8(words[x]);
                for i in 0..3 {
                    let own = f64::from(colour[i]) / 255.0;
                    let eye = eye(screen, x as u16, y);
                    let [least, most] = shine.level(i, own, unit(normal), eye, turned);
                    let got = f64::from(got[i]);
                    assert!(
                        least - off <= got && got <= most + off,
                        "{got} for {least} to {most} at {x}, {y}, length {length}, {slots} slots: {:?}",
                        facet.corners.map(|c| c.at)
                    );
                }
                pixels += 1;
            }
        }
    }
    pixels
}

#[test]
fn every_pixel_is_lit_by_its_own_normal() {
    let pixels = pixels_are_the_formula::<Phong<Rgb888>>(1_801, 1.0);
    assert!(pixels > 40_000, "{pixels}");
    // Half a step of 5 bits.
    let pixels = pixels_are_the_formula::<Phong<Rgb565Be>>(1_802, 4.7);
    assert!(pixels > 40_000, "{pixels}");
}

/// A texture of 64 x 32 texels, an eighth of which may be holes, that lies on the picture pixel by pixel.
struct Wallpaper {
    words: &'static [u16],
    texture: &'static Texture<'static>,
    /// The levels of a word.
    levels: fn(u16) -> [u8; 3],
}

/// The word of a hole.
const HOLE: u16 = 0x1234;

impl Wallpaper {
    /// Of words of `T`.
    fn new<T: PixelFormat<Word = u16>>(rng: &mut Rng) -> Self {
        let word = |rng: &mut Rng| match rng.below(8) {
            0 => HOLE,
            _ => rng.below(1 << 16) as u16,
        };
        let words: &'static [u16] = (0..64 * 32).map(|_| word(rng)).collect::<Vec<_>>().leak();
        let texture = Texture::words(words, 64, 32).expect("sides of powers of two");
        let texture = match rng.below(3) {
            0 => texture,
            _ => texture.keyed(HOLE),
        };
        Self {
            words,
            texture: Box::leak(Box::new(texture)),
            levels: T::to_rgb8,
        }
    }

    fn texel(&self, x: usize, y: u16) -> (u16, [u8; 3]) {
        let word = self.words[64 * (usize::from(y) % 32) + x % 64];
        (word, (self.levels)(word))
    }

    fn dress(&self, draw: &mut Draw<'_, '_, i32>, facet: &Facet) {
        let place = |corner: &Corner| [32 * corner.at.0, 32 * corner.at.1];
        let places: &'static [_] = facet.corners.each_ref().map(place).to_vec().leak();
        draw.texture = Some(Skin {
            texture: self.texture,
            places,
            budget: Budget::EXACT,
        });
    }
}

/// The texel of each pixel times the call's colour is what light falls on; holes are as they are in textures that are
/// lit at corners.
///
/// Kills: a colour that the texel is not multiplied with, texels of a run that begin anew at its start, normals of
/// small triangles taken as shades, lamps that shine on texels that replace.
fn texels_are_lit<L: Smooth, T: PixelFormat<Word = u16>>(seed: u64, off: f64) -> [usize; 3] {
    let mut rng = Rng::new(seed);
    let mut seen = [0; 3];
    for round in 0..400 {
        let screen = Screen::new(rng.pick(&[40, 200]), 24).expect("a screen");
        let mut facet = Facet::slanted(&mut rng, screen, &[1.0]);
        let mut shine = Shine::new(&mut rng, round % 9);
        even_in_some(round, &mut facet, &mut shine);
        let lamps: &'static _ = Box::leak(Box::new(shine.lamps(screen)));
        let paper = Wallpaper::new::<T>(&mut rng);
        let application = rng.pick(&[
            Application::Product,
            Application::Replace,
            Application::Decal,
        ]);
        let colour = [(); 3].map(|()| rng.below(256) as u8);
        let mut rooms = SceneRooms::of_triangles(1, screen);
        let mut scene = rooms.scene::<L>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        draw_with(&mut scene, &[facet.corners], |draw| {
            facet.dress(draw, lamps, colour);
            paper.dress(draw, &facet);
            draw.application = application;
        })
        .expect("there is room");
        let slots = rng.pick(&[0, 4]);
        let background = L::Format::from_rgb8([1, 250, 3]);
        let lines = frame(&scene, slots, true, background);
        for (y, words) in (0..).zip(&lines) {
            for x in within(facet.corners.map(|c| c.at), y.into(), screen.width()) {
                let (word, texel) = paper.texel(x, y);
                let is_hole = paper.texture.key().is_some() && word == HOLE;
                let (own, is_lit) = match application {
                    Application::Product if is_hole => ([0.0; 3], false),
                    Application::Replace if is_hole => ([0.0; 3], false),
                    Application::Decal if is_hole => (colour.map(|c| f64::from(c) / 255.0), true),
                    Application::Product => {
                        let own = |i: usize| f64::from(colour[i]) * f64::from(texel[i]) / 65_025.0;
                        ([0, 1, 2].map(own), true)
                    }
                    Application::Replace | Application::Decal => {
                        (texel.map(|c| f64::from(c) / 255.0), false)
                    }
                };
                if is_hole && !is_lit {
                    assert!(words[x] == background, "{x}, {y}");
                    seen[2] += 1;
                    continue;
                }
                let normal = facet.normal(x as u16, y);
                let length = dot(normal, normal).sqrt();
                let got = L::Format::to_rgb8(words[x]);
                for i in 0..3 {
                    let level = 255.0 * own[i];
                    let [least, most] = match is_lit {
                        true => {
                            let eye = eye(screen, x as u16, y);
                            shine.level(i, own[i], unit(normal), eye, 0.0013 / length)
                        }
                        false => [level; 2],
                    };
                    let got = f64::from(got[i]);
                    assert!(
                        least - off <= got && got <= most + off,
                        "{got} for {least} to {most} at {x}, {y}, {slots} slots: {:?}",
                        facet.corners.map(|c| c.at)
                    );
                }
                seen[usize::from(is_lit)] += 1;
            }
        }
    }
    seen
}

#[test]
fn texels_are_lit_by_their_own_normal() {
    for seen in [
        texels_are_lit::<TexturedPhong<Rgb888>, Rgb565>(1_805, 1.0),
        texels_are_lit::<TexturedPhong<Rgb565Be>, Rgb565Be>(1_806, 4.7),
    ] {
        let [replaced, lit, holes] = seen;
        assert!(
            lit > 20_000 && replaced > 20_000 && holes > 3_000,
            "{seen:?}"
        );
    }
}

/// Many triangles across each other, by depth: any cache gives the same bits.
#[test]
fn pictures_lit_at_pixels_do_not_depend_on_the_cache() {
    let mut rng = Rng::new(1_803);
    let screen = Screen::new(64, 24).expect("a screen");
    for _ in 0..40 {
        let shine = Shine::new(&mut rng, 2);
        let lamps: &'static _ = Box::leak(Box::new(shine.lamps(screen)));
        let mut rooms = SceneRooms::new(6 * 12, 12, 24, 12);
        let mut scene = rooms.scene::<Phong<Rgb888>>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        for i in 0..12 {
            let facet = Facet::new(&mut rng, screen);
            draw_with(&mut scene, &[facet.corners], |draw| {
                facet.dress(draw, lamps, [200, 20 * i, 90]);
                if i % 3 == 0 {
                    draw.shading = Shading::Flat;
                }
            })
            .expect("there is room");
        }
        let all = frame(&scene, 64, true, [0; 3]);
        let seen = |lines: &[Vec<WordOf<Phong<Rgb888>>>]| {
            lines.iter().flatten().filter(|&&p| p != [0; 3]).count()
        };
        assert!(seen(&all) > 0);
        for slots in [0, 1, 5] {
            assert_eq!(frame(&scene, slots, true, [0; 3]), all, "{slots} slots");
        }
    }
}

/// Light of the other kind is refused, and nothing is drawn.
#[test]
fn light_that_a_look_does_not_know_is_refused() {
    let mut rng = Rng::new(1_804);
    let screen = Screen::new(40, 24).expect("a screen");
    let lamps: &'static _ = Box::leak(Box::new(Shine::new(&mut rng, 1).lamps(screen)));
    let facet = Facet::new(&mut rng, screen);
    let light = Light::new([0.0, 0.0, 1.0], 0.5);
    let several = Lighting::new(&[], [Default::default(); 3], Material::default());
    let several: &'static Lighting<'_> = Box::leak(Box::new(several.expect("no light")));
    let mut rooms = SceneRooms::of_triangles(1, screen);
    let mut scene = rooms.scene::<Phong<Rgb888>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    for which in 0..3 {
        let drawn = draw_with(&mut scene, &[facet.corners], |draw| {
            let colours = draw.mesh.colours;
            facet.dress(draw, lamps, [90; 3]);
            match which {
                0 => draw.light = light,
                1 => draw.lights = Some(several),
                _ => draw.mesh.colours = colours,
            }
        });
        assert_eq!(drawn, Err(DrawError::Light), "{which}");
    }
    assert_eq!((scene.objects(), scene.vertices()), (0, 0));
    let mut rooms = SceneRooms::of_triangles(1, screen);
    let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    let drawn = draw_with(&mut scene, &[facet.corners], |draw| {
        facet.dress(draw, lamps, [90; 3])
    });
    assert_eq!(drawn, Err(DrawError::Light));
    assert_eq!((scene.objects(), scene.vertices()), (0, 0));
}
