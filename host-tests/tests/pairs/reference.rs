//! A picture of draw calls in f64, pixel by pixel and call by call: no planes, no spans, no slots.
//!
//! A level is a range, from the least to the most that the documented errors allow: of the texel, any within the
//! budget of its place. Where two depths are nearer to each other than depth may err, a pixel is left out.

use crate::hot::Corner;
use crate::hot::exact::{weights, within};
use crate::hot::layers::{Layer, lay_all};
use crate::hot::shine::{V3, dot, unit};
use crate::hot::values::{Alphas, Cut, Function, blended_by};
use scanbeam::Screen;
use scanbeam::scene::{Application, BlendMode, Budget, Wrap};

/// The least and the most.
pub type Range = [f64; 2];

/// Texels of a texture by their places: red, green and blue, 0 to 255.
#[derive(Debug)]
pub struct Texels {
    pub width: i32,
    pub height: i32,
    pub rgb: Vec<V3>,
    /// Which are transparent where a call says so.
    pub is_key: Vec<bool>,
    /// What a mask says of them: alpha, 0 to 255, and whether they are added.
    pub alpha: Vec<f64>,
    pub is_added: Vec<bool>,
}

/// A texture on a triangle, its places in texels.
#[derive(Clone, Debug)]
pub struct Skin64 {
    pub form: usize,
    pub wrap: Wrap,
    pub places: [[i32; 2]; 3],
    /// And how far a texel may be from its place, in texels.
    pub budget: (Budget, f64),
    pub is_keyed: bool,
    /// Whether four texels are mixed.
    pub is_filtered: bool,
    /// None, one of alphas, or one that says also what is added.
    pub mask: usize,
    pub application: Application,
}

/// Where light comes from, and its level.
#[derive(Clone, Debug)]
pub enum Light64 {
    None,
    /// Towards it, and the level where it does not reach.
    One(V3, f64),
    /// Towards each, and its colour; what is mirrored in white, and its power.
    Several(Vec<(V3, V3)>, f64, u16),
}

/// A draw call of one triangle, and its values.
#[derive(Clone, Debug)]
pub struct Call {
    pub corners: [Corner; 3],
    /// The colour of the call, where corners have none of their own.
    pub colour: Option<[u8; 3]>,
    pub normals: [V3; 3],
    pub is_flat: bool,
    pub light: Light64,
    pub skin: Option<Skin64>,
    pub cut: Option<Cut>,
    /// Where it is seen, and where its depth is kept.
    pub test: [Function; 2],
    /// What becomes of colours that are there, and the channels that are written.
    pub blend: Option<(BlendMode, [bool; 3])>,
    /// Of the corners.
    pub alphas: Option<[u8; 3]>,
    pub dithers: bool,
    pub priority: u8,
}

/// What rounding may add to a level: where a colour is written, where it changes along a span, and where it is blended.
#[derive(Clone, Copy, Debug)]
pub struct Rounding {
    pub written: f64,
    pub sloped: f64,
    pub blended: f64,
    /// By how much a dither may raise or lower it: half a step.
    pub dithered: f64,
    /// Whether two pixels are shaded by the place between them.
    pub by_twos: bool,
}

/// From how many levels a pixel on a shade serves two pixels: 1/70 of full light.
const STEEP: f64 = 255.0 / 70.0;

/// What of a texture is shown at a pixel.
enum Shown {
    Nothing,
    Texel([Range; 3]),
}

/// What pictures are drawn with.
pub struct World<'a> {
    pub screen: Screen,
    pub texels: &'a [Texels],
    pub background: [u8; 3],
    pub rounding: Rounding,
    /// Whether depth is compared.
    pub by_depth: bool,
}

/// Where a corner is, seen from the eye, in units of its distance.
fn position(corner: &Corner, screen: Screen) -> V3 {
    let middle = [screen.width(), screen.height()].map(|side| 4 * i32::from(side));
    let (x, y) = (corner.at.0 - middle[0], corner.at.1 - middle[1]);
    let at = |d: i32| f64::from(d) / 32_768.0 * corner.w;
    [at(x), -at(y), -corner.w]
}

impl Call {
    /// Red, green and blue of the corners, lit, 0 to 255; `None` where it is not known which side a light comes from.
    fn colours(&self, screen: Screen) -> Option<[V3; 3]> {
        let at = self.corners.each_ref().map(|c| position(c, screen));
        let side = |i: usize| [0, 1, 2].map(|k| at[i][k] - at[0][k]);
        let (a, b) = (side(1), side(2));
        let standing = unit([
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]);
        let mut colours = [[0.0; 3]; 3];
        for (i, lit) in colours.iter_mut().enumerate() {
            let from = if self.is_flat { 0 } else { i };
            let own = self.colour.unwrap_or(self.corners[from].colour);
            let normal = if self.is_flat {
                standing
            } else {
                self.normals[i]
            };
            // The eye is where all is seen from.
            *lit = self.lit(own.map(f64::from), normal, unit(at[from].map(|c| -c)))?;
        }
        Some(colours)
    }

    fn lit(&self, own: V3, normal: V3, eye: V3) -> Option<V3> {
        Some(match &self.light {
            Light64::None => own,
            Light64::One(towards, ambient) => {
                let level = ambient + (1.0 - ambient) * dot(normal, *towards).max(0.0);
                own.map(|c| c * level)
            }
            Light64::Several(lights, specular, power) => {
                let mut sum = [0.0; 3];
                for (towards, colour) in lights {
                    let falls = dot(normal, *towards);
                    // What comes from along a surface is mirrored by it as a whole, or not at all.
                    if *specular > 0.0 && falls.abs() < 2e-4 {
                        return None;
                    }
                    if falls <= 0.0 {
                        continue;
                    }
                    let mirrored = [0, 1, 2].map(|k| 2.0 * falls * normal[k] - towards[k]);
                    let shine = specular * dot(mirrored, eye).max(0.0).powi((*power).into());
                    for i in 0..3 {
                        sum[i] += colour[i] * (own[i] * falls + 255.0 * shine);
                    }
                }
                sum.map(|c| c.min(255.0))
            }
        })
    }

    fn covers(&self, x: u16, y: u16, screen: Screen) -> bool {
        let columns = within(self.corners.map(|c| c.at), y.into(), screen.width());
        columns.contains(&usize::from(x)) && self.cut.as_ref().is_none_or(|cut| cut.keeps(x, y))
    }

    fn layer(&self) -> Layer<'_> {
        let is_translucent = |(mode, _)| mode != BlendMode::Replace;
        Layer {
            corners: &self.corners,
            test: self.test,
            is_translucent: self.blend.is_some_and(is_translucent),
        }
    }

    /// The place on the texture, in texels.
    fn place(&self, skin: &Skin64, x: i32, y: i32) -> [f64; 2] {
        let (part, _) = weights(self.corners.map(|c| c.at), x, y);
        let near = [0, 1, 2].map(|k| part[k] / self.corners[k].w);
        let whole: f64 = near.iter().sum();
        [0, 1].map(|axis| {
            let texel = |k: usize| f64::from(skin.places[k][axis]) / 256.0;
            (0..3).map(|k| near[k] * texel(k)).sum::<f64>() / whole
        })
    }

    /// The texels that may be shown at a pixel, across and down; `None` where these are a lot.
    fn reach(&self, skin: &Skin64, [x, y]: [u16; 2]) -> Option<[[i32; 2]; 2]> {
        let (x, y) = (i32::from(x), i32::from(y));
        let at = self.place(skin, x, y);
        let steps = [(1, 0), (-1, 0), (0, 1), (0, -1)].map(|(dx, dy)| {
            let there = self.place(skin, x + dx, y + dy);
            [0, 1].map(|k| (there[k] - at[k]).abs())
        });
        // The budget, 1/16 texel of fixed point, and 1/32 pixel of corners that are rounded.
        let reach = [0, 1].map(|k| {
            let step = steps.iter().fold(0.0f64, |most, step| most.max(step[k]));
            skin.budget.1 + 1.0 / 16.0 + step / 16.0
        });
        let span = [0, 1].map(|k| [at[k] - reach[k], at[k] + reach[k]].map(|c| c.floor() as i32));
        let is_much = span.iter().any(|[low, high]| high - low > 8);
        (!is_much).then_some(span)
    }

    /// What alphas a pixel may have, and whether it is added; `None` where that is not known.
    fn alphas(&self, at: [u16; 2], world: &World<'_>) -> Option<([Range; 2], bool)> {
        let surface = self.alphas.map_or(1.0, |alphas| {
            let (part, _) = weights(self.corners.map(|c| c.at), at[0].into(), at[1].into());
            (0..3).map(|k| part[k] * f64::from(alphas[k]) / 255.0).sum()
        });
        let masked = self.skin.as_ref().filter(|skin| skin.mask > 0);
        let Some(skin) = masked else {
            return Some(([[surface; 2], [1.0; 2]], false));
        };
        let span = self.reach(skin, at)?;
        let (mut alpha, mut added) = ([1.0f64, 0.0f64], [false; 2]);
        let beyond = i32::from(skin.is_filtered);
        let texels = &world.texels[skin.form];
        for v in span[1][0] - beyond..=span[1][1] + beyond {
            for u in span[0][0] - beyond..=span[0][1] + beyond {
                let at = texels.at(skin.wrap, u, v);
                let of = texels.alpha[at] / 255.0;
                alpha = [alpha[0].min(of), alpha[1].max(of)];
                let may_be_nearest = (span[0][0]..=span[0][1]).contains(&u)
                    && (span[1][0]..=span[1][1]).contains(&v);
                if may_be_nearest {
                    added[usize::from(texels.is_added[at])] = true;
                }
            }
        }
        match (skin.mask, added) {
            (1, _) | (_, [true, false]) => Some(([[surface; 2], alpha], false)),
            (_, [false, true]) => Some(([[surface; 2], alpha], true)),
            _ => None,
        }
    }

    /// What of the texture may be shown at a pixel; `None` where that is a lot, or not told from a transparent texel.
    fn texels(&self, skin: &Skin64, at: [u16; 2], all: &[Texels]) -> Option<Shown> {
        let span = self.reach(skin, at)?;
        let texels = &all[skin.form];
        let mut levels = [[255.0f64, 0.0f64]; 3];
        let (mut keys, mut others) = (0, 0);
        // Of four that are mixed, two are the next ones on each axis; whether it is a hole is said by the nearest.
        let beyond = i32::from(skin.is_filtered);
        for v in span[1][0] - beyond..=span[1][1] + beyond {
            for u in span[0][0] - beyond..=span[0][1] + beyond {
                let at = texels.at(skin.wrap, u, v);
                let rgb = texels.rgb[at];
                let may_be_nearest = (span[0][0]..=span[0][1]).contains(&u)
                    && (span[1][0]..=span[1][1]).contains(&v);
                if skin.is_keyed && texels.is_key[at] {
                    keys += usize::from(may_be_nearest);
                    continue;
                }
                others += usize::from(may_be_nearest);
                for i in 0..3 {
                    levels[i] = [levels[i][0].min(rgb[i]), levels[i][1].max(rgb[i])];
                }
            }
        }
        match (keys, others) {
            (0, _) => Some(Shown::Texel(levels)),
            (_, 0) => Some(Shown::Nothing),
            _ => None,
        }
    }

    /// Whether a pixel that is covered is a hole; `None` where that is not known.
    fn is_hole(&self, at: [u16; 2], world: &World<'_>) -> Option<bool> {
        match &self.skin {
            Some(skin) if skin.is_keyed && skin.application != Application::Decal => Some(
                matches!(self.texels(skin, at, world.texels)?, Shown::Nothing),
            ),
            _ => Some(false),
        }
    }

    /// The levels that a pixel may get; `None` where too many texels may be shown.
    fn levels(&self, at: [u16; 2], world: &World<'_>) -> Option<[Range; 3]> {
        let colours = self.colours(world.screen)?;
        let places = self.corners.map(|c| c.at);
        let (part, step) = weights(places, at[0].into(), at[1].into());
        let of = |part: V3| [0, 1, 2].map(|i| (0..3).map(|k| part[k] * colours[k][i]).sum());
        let (level, step): (V3, V3) = (of(part), of(step));
        let is_even = colours.iter().all(|c| *c == colours[0]);
        let Rounding {
            written, sloped, ..
        } = world.rounding;
        let mut off = if is_even { written } else { sloped };
        if self.dithers {
            off += world.rounding.dithered;
        }
        let white = [[255.0; 2]; 3];
        let texels = match &self.skin {
            None => white,
            Some(skin) => match (self.texels(skin, at, world.texels)?, skin.application) {
                (Shown::Nothing, _) => white,
                (Shown::Texel(texels), Application::Product) => texels,
                (Shown::Texel(texels), _) => {
                    return Some(texels.map(|[low, high]| [low - written, high + written]));
                }
            },
        };
        Some([0, 1, 2].map(|i| {
            // Where it changes fast, a shade may be that half a pixel away.
            let half = if world.rounding.by_twos && step[i].abs() > STEEP {
                step[i].abs() / 2.0
            } else {
                0.0
            };
            let (least, most) = (level[i] - half, level[i] + half);
            let shade = |level: f64| level.clamp(0.0, 255.0) / 255.0;
            [
                texels[i][0] * shade(least) - off,
                texels[i][1] * shade(most) + off,
            ]
        }))
    }
}

impl Texels {
    /// The number of the texel at a place, which may lie beyond the sides.
    fn at(&self, wrap: Wrap, u: i32, v: i32) -> usize {
        let folded = |at: i32, side: i32| match wrap {
            Wrap::Repeat => at.rem_euclid(side),
            Wrap::Clamp => at.clamp(0, side - 1),
            Wrap::Mirror => {
                let there = at.rem_euclid(2 * side);
                there.min(2 * side - 1 - there)
            }
        };
        let (u, v) = (folded(u, self.width), folded(v, self.height));
        (v * self.width + u) as usize
    }
}

/// Lays what a call may have over what may be there.
fn lay(levels: &mut [Range; 3], call: &Call, at: [u16; 2], world: &World<'_>) -> Option<()> {
    let new = call.levels(at, world)?;
    let (mode, rgb) = call.blend.unwrap_or((BlendMode::Replace, [true; 3]));
    let (by, is_added) = match mode {
        BlendMode::Replace => ([[1.0; 2]; 2], false),
        _ => call.alphas(at, world)?,
    };
    let has_alphas = by != [[1.0; 2]; 2];
    for i in (0..3).filter(|&i| rgb[i]) {
        let clamped = |range: Range| range.map(|c| c.clamp(0.0, 255.0));
        let (old, new) = (clamped(levels[i]), clamped(new[i]));
        // Each mode is linear in each of them, so its least and its most are at the ends.
        let ends: [f64; 8] = std::array::from_fn(|k| {
            let alphas = Alphas {
                surface: by[0][0],
                texel: by[1][k >> 2],
                is_added,
            };
            blended_by(mode, alphas, old[k & 1], new[k >> 1 & 1])[0]
        });
        let off = match mode {
            BlendMode::Replace => 0.0,
            // Each alpha is rounded to a level, and their product.
            _ if has_alphas => world.rounding.blended + 1.2,
            _ => world.rounding.blended,
        };
        let fold = |f: fn(f64, f64) -> f64| ends.into_iter().reduce(f).unwrap_or_default();
        levels[i] = [fold(f64::min) - off, fold(f64::max) + off];
    }
    Some(())
}

/// The levels that a pixel may have; `None` where they hang on what depth or a texture may err. Calls come in order of
/// priority.
pub fn pixel(calls: &[&Call], at: [u16; 2], world: &World<'_>) -> Option<[Range; 3]> {
    let off = world.rounding.written;
    let mut levels = world
        .background
        .map(|level| [-off, off].map(|off| f64::from(level) + off));
    let mut seen = Vec::new();
    for &call in calls {
        if call.covers(at[0], at[1], world.screen) && !call.is_hole(at, world)? {
            seen.push((call.layer(), call));
        }
    }
    lay_all(seen, at, world.by_depth, |call| {
        lay(&mut levels, call, at, world)
    })?;
    Some(levels)
}

/// The calls that have a pixel, to be told.
pub fn covering<'a>(calls: &[&'a Call], [x, y]: [u16; 2], world: &World<'_>) -> Vec<&'a Call> {
    let covers = |call: &&&Call| call.covers(x, y, world.screen);
    calls.iter().filter(covers).copied().collect()
}
