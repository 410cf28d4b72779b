//! A draw call of any bytes, with any values.

use super::bytes::{affine, float, vector};
use arbitrary::{Arbitrary, Result, Unstructured};
use scanbeam::look::Look;
use scanbeam::mesh::{Coordinate, QuadSplit};
use scanbeam::scene::{
    Application, Blend, BlendMode, Budget, DepthFunction, DepthTest, Draw, DrawError, Factor,
    Scene, Scissor, Shading, Shadow, Skin, Texture,
};
use scanbeam::{Affine, Cull, Faces, Light, Mesh, Screen};

/// A mesh, how it stands, and what else is said of it.
#[derive(Debug)]
pub struct Call {
    positions: Vec<[i32; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    places: Vec<[i32; 2]>,
    alphas: Vec<u8>,
    faces: Vec<u16>,
    /// Triangles, quads or a strip.
    kind: u8,
    split: QuadSplit,
    /// Positions are cut down to 16 bits.
    is_short: bool,
    model: Affine,
    cull: Cull,
    light: Option<Light>,
    colour: [u8; 3],
    values: Values,
}

/// What few calls have.
#[derive(Debug)]
struct Values {
    shading: Shading,
    application: Application,
    budget: Budget,
    scissor: Option<Scissor>,
    depth: DepthTest,
    blend: Option<Blend>,
    has_alphas: bool,
    dither: bool,
    shadow: Option<Shadow>,
    priority: u8,
}

const FUNCTIONS: [DepthFunction; 8] = [
    DepthFunction::NEARER_OR_EQUAL,
    DepthFunction::NEVER,
    DepthFunction::ALWAYS,
    DepthFunction::NEARER,
    DepthFunction::EQUAL,
    DepthFunction::FARTHER_OR_EQUAL,
    DepthFunction::FARTHER,
    DepthFunction::DIFFERENT,
];

fn factor(u: &mut Unstructured<'_>) -> Result<Factor> {
    Ok(match u.int_in_range(0..=6u8)? {
        0 => Factor::Constant(u.arbitrary()?),
        1 => Factor::Destination,
        2 => Factor::InverseDestination,
        3 => Factor::SourceAlpha,
        4 => Factor::InverseSourceAlpha,
        5 => Factor::TextureAlpha,
        _ => Factor::InverseTextureAlpha,
    })
}

fn blend(u: &mut Unstructured<'_>) -> Result<Blend> {
    let mode = match u.int_in_range(0..=5u8)? {
        0 => BlendMode::Replace,
        1 => BlendMode::Filter(u.arbitrary()?),
        2 => BlendMode::Half,
        3 => BlendMode::Add(u.arbitrary()?),
        4 => BlendMode::Subtract(u.arbitrary()?),
        _ => BlendMode::Factors {
            source: factor(u)?,
            destination: factor(u)?,
        },
    };
    Ok(Blend::new(mode).writing(u.arbitrary()?))
}

impl Values {
    fn new(u: &mut Unstructured<'_>, screen: Screen) -> Result<Self> {
        let some = |u: &mut Unstructured<'_>| u.ratio(1, 4u8);
        let (width, height) = (screen.width(), screen.height());
        let scissor = match some(u)? {
            true => {
                let mut range = |end: u16| -> Result<_> {
                    let from = u.int_in_range(0..=end)?;
                    Ok(from..u.int_in_range(from..=end + 9)?)
                };
                let (columns, lines) = (range(width)?, range(height)?);
                Some(match u.arbitrary()? {
                    true => Scissor::inside(columns, lines),
                    false => Scissor::outside(columns, lines),
                })
            }
            false => None,
        };
        let depth = match some(u)? {
            true => DepthTest {
                colour_if: *u.choose(&FUNCTIONS)?,
                depth_if: *u.choose(&FUNCTIONS)?,
            },
            false => DepthTest::default(),
        };
        let light = u.int_in_range(0..=9)?;
        Ok(Self {
            shading: *u.choose(&[Shading::Smooth, Shading::Flat])?,
            application: *u.choose(&[
                Application::Product,
                Application::Replace,
                Application::Decal,
            ])?,
            budget: *u.choose(&[Budget::FAST, Budget::BALANCED, Budget::EXACT])?,
            scissor,
            depth,
            blend: some(u)?.then(|| blend(u)).transpose()?,
            has_alphas: u.arbitrary()?,
            dither: some(u)?,
            shadow: match u.int_in_range(0..=11u8)? {
                0 => Some(Shadow::Volume(light)),
                1 => Some(Shadow::Lit(light)),
                2 => Some(Shadow::Shadowed(light)),
                _ => None,
            },
            priority: if u.ratio(1, 16u8)? { u.arbitrary()? } else { 0 },
        })
    }
}

/// So many of anything.
fn many<'a, T: Arbitrary<'a>>(u: &mut Unstructured<'a>, count: usize) -> Result<Vec<T>> {
    (0..count).map(|_| u.arbitrary()).collect()
}

impl Call {
    pub fn new(u: &mut Unstructured<'_>, screen: Screen) -> Result<Self> {
        let count = u.int_in_range(0..=12usize)?;
        let is_coarse = u.arbitrary()?;
        let mut positions = Vec::new();
        for _ in 0..count {
            positions.push(if is_coarse {
                let p: [i8; 3] = u.arbitrary()?;
                p.map(|c| i32::from(c) << 24)
            } else {
                u.arbitrary()?
            });
        }
        // Now and then one too many, which must be refused.
        let other = |u: &mut Unstructured<'_>| {
            Ok(match u.int_in_range(0..=7u8)? {
                0 => count + 1,
                1..=3 => 0,
                _ => count,
            })
        };
        let (normals, colours) = (other(u)?, other(u)?);
        Ok(Self {
            positions,
            normals: many(u, normals)?,
            colours: many(u, colours)?,
            places: (0..count)
                .map(|_| Ok([float(u)?, float(u)?].map(|place| (place * 2048.0) as i32)))
                .collect::<Result<_>>()?,
            alphas: many(u, count)?,
            faces: (0..u.int_in_range(0..=24u8)?)
                .map(|_| {
                    let is_wrong = count == 0 || u.ratio(1, 256)?;
                    u.int_in_range(0..=count as u16 - u16::from(!is_wrong))
                })
                .collect::<Result<_>>()?,
            kind: u.int_in_range(0..=2)?,
            split: *u.choose(&[QuadSplit::Corner0To2, QuadSplit::Corner1To3])?,
            is_short: u.arbitrary()?,
            model: affine(u)?,
            cull: *u.choose(&[Cull::Back, Cull::None])?,
            light: match u.arbitrary()? {
                true => Light::new(vector(u)?, float(u)?),
                false => None,
            },
            colour: u.arbitrary()?,
            values: Values::new(u, screen)?,
        })
    }

    /// Draws it, with its values unless it is to be plain; `false` when it was refused whole.
    pub fn draw<'t, L: Look>(
        &self,
        scene: &mut Scene<'_, 't, L>,
        texture: Option<&'t Texture<'t>>,
        is_plain: bool,
    ) -> bool {
        let short = |p: &[i32; 3]| p.map(|c| (c >> 16) as i16);
        if self.is_short {
            let short: Vec<_> = self.positions.iter().map(short).collect();
            self.draw_at(&short, scene, texture, is_plain)
        } else {
            self.draw_at(&self.positions, scene, texture, is_plain)
        }
    }

    fn draw_at<'t, L: Look, C: Coordinate>(
        &self,
        positions: &[[C; 3]],
        scene: &mut Scene<'_, 't, L>,
        texture: Option<&'t Texture<'t>>,
        is_plain: bool,
    ) -> bool {
        let triangles: Vec<_> = chunks::<3>(&self.faces).collect();
        let quads: Vec<_> = chunks::<4>(&self.faces).collect();
        let mesh = Mesh {
            positions,
            normals: &self.normals,
            colours: &self.colours,
            faces: match self.kind {
                0 => Faces::Triangles(&triangles),
                1 => Faces::Quads(&quads, self.split),
                _ => Faces::QuadStrip(&self.faces, self.split),
            },
        };
        let values = &self.values;
        let mut call = Draw {
            model: self.model,
            cull: self.cull,
            light: self.light,
            colour: self.colour,
            texture: texture.map(|texture| Skin {
                texture,
                places: &self.places,
                budget: values.budget,
            }),
            ..Draw::new(mesh)
        };
        if !is_plain {
            call.shading = values.shading;
            call.application = values.application;
            call.scissor = values.scissor;
            call.depth = values.depth;
            call.blend = values.blend;
            call.alphas = if values.has_alphas { &self.alphas } else { &[] };
            call.dither = values.dither;
            call.shadow = values.shadow;
            call.priority = values.priority;
        }
        matches!(scene.draw(&call), Ok(()) | Err(DrawError::Full { .. }))
    }

    /// The levels that its pixels may have.
    pub fn widen(&self, [low, high]: &mut [[u8; 3]; 2]) {
        let own = [self.colour];
        let colours = match self.colours.is_empty() {
            true => own.as_slice(),
            false => &self.colours,
        };
        for colour in colours {
            for i in 0..3 {
                let dark = if self.light.is_some() { 0 } else { colour[i] };
                low[i] = low[i].min(dark);
                high[i] = high[i].max(colour[i]);
            }
        }
    }
}

/// The whole groups of `N` indices.
fn chunks<const N: usize>(indices: &[u16]) -> impl Iterator<Item = [u16; N]> {
    indices
        .chunks_exact(N)
        .filter_map(|group| group.try_into().ok())
}
