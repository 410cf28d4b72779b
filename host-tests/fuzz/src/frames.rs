//! Set-up to pixels: any bytes as a scene, drawn by several pipelines in every way.

use arbitrary::{Result, Unstructured};
use scanbeam::mesh::QuadSplit;
use scanbeam::pipeline::parallel::Interleave;
use scanbeam::pipeline::{
    DepthUse, DrawError, FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, Instance, LineDepth,
    LineMemory, LineRenderer, ObjectOf, Pipeline, Scene, SceneMemory, VertexOf, WordOf,
};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::{Affine, Camera, CameraError, Cull, Faces, Light, Link, Mesh, Screen};

/// Longest side of a picture.
const MOST: u16 = 64;

/// A model and how it stands.
#[derive(Debug)]
struct Model {
    positions: Vec<[i32; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<u16>,
    /// Triangles, quads or a strip.
    kind: u8,
    split: QuadSplit,
    /// Positions are cut down to 16 bits.
    short: bool,
    instance: Instance,
}

/// How a frame is drawn; none of it may change a pixel.
#[derive(Debug)]
struct Way {
    slots: usize,
    depth_use: DepthUse,
    renderers: u16,
    prefetch: u32,
    /// Where lines begin, and the step to the next, modulo the height.
    order: Option<(u16, u16)>,
}

/// A whole case.
#[derive(Debug)]
struct Case {
    screen: Screen,
    camera: Camera,
    models: Vec<Model>,
    vertices: usize,
    objects: usize,
    way: Way,
}

/// Any float: plain ones most of the time, any bits now and then.
fn float(u: &mut Unstructured<'_>) -> Result<f32> {
    Ok(match u.int_in_range(0..=15u8)? {
        15 => f32::from_bits(u.arbitrary()?),
        14 => {
            let power = f32::from(u.arbitrary::<i8>()?);
            if u.arbitrary()? {
                power.exp2()
            } else {
                -power.exp2()
            }
        }
        12 | 13 => f32::from(u.arbitrary::<i16>()?) / 256.0,
        _ => f32::from(u.arbitrary::<i8>()?) / 64.0,
    })
}

fn vector(u: &mut Unstructured<'_>) -> Result<[f32; 3]> {
    Ok([float(u)?, float(u)?, float(u)?])
}

/// A chain of maps of every kind; what is refused is left out.
fn affine(u: &mut Unstructured<'_>) -> Result<Affine> {
    let mut map = Affine::IDENTITY;
    for _ in 0..u.int_in_range(0..=4u8)? {
        let next = match u.int_in_range(0..=5u8)? {
            0 => Affine::from_rows([vector(u)?, vector(u)?, vector(u)?], vector(u)?),
            1 => Affine::placed(float(u)?, vector(u)?),
            2 => Some(Affine::rotation_x(float(u)?)),
            3 => Some(Affine::rotation_y(float(u)?)),
            4 => Some(Affine::rotation_z(float(u)?)),
            _ => map.orthonormalised(),
        };
        map = map.then(&next.unwrap_or(Affine::IDENTITY));
    }
    Ok(map)
}

/// Mostly one that sees the origin.
fn camera(u: &mut Unstructured<'_>) -> Result<std::result::Result<Camera, CameraError>> {
    if u.ratio(1, 4)? {
        let (eye, at, up) = (vector(u)?, vector(u)?, vector(u)?);
        let (focal, near, range) = (float(u)?.abs(), float(u)?.abs(), float(u)?.abs());
        return Ok(Camera::look_at(eye, at, up, focal, near, near + range));
    }
    let [x, y, z] = vector(u)?;
    let near = f32::from(u.int_in_range(0..=20i8)? - 10).exp2();
    Ok(Camera::look_at(
        [x, y, z + 2.0],
        [x / 4.0, y / 4.0, 0.0],
        [0.0, 1.0, 0.0],
        f32::from(u.arbitrary::<u8>()?) + 20.0,
        near,
        near * (1.0 + f32::from(u.arbitrary::<u16>()?)) + 4.0,
    ))
}

impl Model {
    fn new(u: &mut Unstructured<'_>) -> Result<Self> {
        let count = u.int_in_range(0..=12usize)?;
        let coarse = u.arbitrary()?;
        let mut positions = Vec::new();
        for _ in 0..count {
            positions.push(if coarse {
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
            normals: (0..normals).map(|_| u.arbitrary()).collect::<Result<_>>()?,
            colours: (0..colours).map(|_| u.arbitrary()).collect::<Result<_>>()?,
            faces: (0..u.int_in_range(0..=24u8)?)
                .map(|_| {
                    let wrong = count == 0 || u.ratio(1, 256)?;
                    u.int_in_range(0..=count as u16 - u16::from(!wrong))
                })
                .collect::<Result<_>>()?,
            kind: u.int_in_range(0..=2)?,
            split: if u.arbitrary()? {
                QuadSplit::Corner0To2
            } else {
                QuadSplit::Corner1To3
            },
            short: u.arbitrary()?,
            instance: Instance {
                model: affine(u)?,
                cull: if u.arbitrary()? {
                    Cull::Back
                } else {
                    Cull::None
                },
                light: if u.arbitrary()? {
                    Light::new(vector(u)?, float(u)?)
                } else {
                    None
                },
                colour: u.arbitrary()?,
            },
        })
    }

    /// Draws it; `false` when it was refused whole.
    fn draw<P: Pipeline>(&self, scene: &mut Scene<'_, P>) -> bool {
        let triangles: Vec<_> = chunks::<3>(&self.faces).collect();
        let quads: Vec<_> = chunks::<4>(&self.faces).collect();
        let faces = match self.kind {
            0 => Faces::Triangles(&triangles),
            1 => Faces::Quads(&quads, self.split),
            _ => Faces::QuadStrip(&self.faces, self.split),
        };
        let (normals, colours) = (self.normals.as_slice(), self.colours.as_slice());
        let drawn = if self.short {
            let short: Vec<_> = self
                .positions
                .iter()
                .map(|p| p.map(|c| (c >> 16) as i16))
                .collect();
            let positions = short.as_slice();
            let mesh = Mesh {
                positions,
                normals,
                colours,
                faces,
            };
            scene.draw(&mesh, &self.instance)
        } else {
            let positions = self.positions.as_slice();
            let mesh = Mesh {
                positions,
                normals,
                colours,
                faces,
            };
            scene.draw(&mesh, &self.instance)
        };
        !matches!(drawn, Err(DrawError::Mesh(_)))
    }
}

impl Case {
    /// `None` when a camera cannot be made of the bytes.
    fn new(u: &mut Unstructured<'_>) -> Result<Option<Self>> {
        let screen = Screen::new(u.int_in_range(1..=MOST)?, u.int_in_range(1..=MOST)?);
        let camera = camera(u)?;
        let (Ok(screen), Ok(camera)) = (screen, camera) else {
            return Ok(None);
        };
        let order = if u.arbitrary()? {
            Some((u.arbitrary()?, u.arbitrary()?))
        } else {
            None
        };
        Ok(Some(Self {
            screen,
            camera,
            way: Way {
                slots: u.int_in_range(0..=12)?,
                depth_use: *u.choose(&[DepthUse::WhereNeeded, DepthUse::Always])?,
                renderers: u.int_in_range(1..=3)?,
                prefetch: u.int_in_range(0..=300)?,
                order,
            },
            vertices: u.int_in_range(0..=100)?,
            objects: u.int_in_range(0..=100)?,
            models: (0..u.int_in_range(1..=3u8)?)
                .map(|_| Model::new(u))
                .collect::<Result<_>>()?,
        }))
    }

    /// Draws with `P` in plenty of memory and again in the case's way, each over two grounds;
    /// hands out which pixels are covered, or `None` where an arena was full.
    fn draw<P: Pipeline>(&self) -> Option<Vec<bool>>
    where
        WordOf<P>: std::fmt::Debug,
    {
        let mut vertices = vec![VertexOf::<P>::empty(); self.vertices];
        let mut objects = vec![ObjectOf::<P>::default(); self.objects];
        let mut buckets = vec![Link::NONE; usize::from(self.screen.height())];
        let memory = SceneMemory {
            vertices: &mut vertices,
            objects: &mut objects,
            buckets: &mut buckets,
        };
        let mut scene = Scene::<P>::new(self.screen, memory);
        scene.begin(&self.camera).expect("a bucket a line");
        let mut range = [[u8::MAX; 3], [0; 3]];
        for model in &self.models {
            if model.draw(&mut scene) {
                model.widen(&mut range);
            }
        }
        let pass_one = scene.pass_one();
        assert!(pass_one.objects as usize <= self.objects);
        assert!(pass_one.vertices as usize <= self.vertices);

        let plenty = Way {
            slots: 128,
            depth_use: DepthUse::Always,
            renderers: 1,
            prefetch: 0,
            order: None,
        };
        let black = P::Pixel::pack([0; 3]);
        let white = P::Pixel::pack(P::Pixel::STEPS.map(|s| s as u8));
        let picture = plenty.draw(&scene, black);
        assert_eq!(picture, self.way.draw(&scene, black), "another way");
        let other = plenty.draw(&scene, white);
        let mut covered = Vec::new();
        for (i, (a, b)) in picture.iter().zip(&other).enumerate() {
            covered.push(a == b);
            if a == b {
                within::<P>(*a, range, i);
            } else {
                assert_eq!((*a, *b), (black, white), "pixel {i}");
            }
        }
        (pass_one.dropped == 0).then_some(covered)
    }
}

/// No colour wraps (P4): each channel lies within a step of the levels that it was made from.
fn within<P: Pipeline>(word: WordOf<P>, [low, high]: [[u8; 3]; 2], at: usize) {
    let got = P::Pixel::to_rgb8(word);
    for i in 0..3 {
        let steps = f64::from(P::Pixel::STEPS[i]);
        let step = |level: u8| f64::from(level) * steps / 255.0;
        // Half a step by rounding, half by interpolation, and the rounding of `to_rgb8`.
        let slack = 1.0 + 0.5 * steps / 255.0;
        assert!(
            (step(low[i]) - slack..=step(high[i]) + slack).contains(&step(got[i])),
            "pixel {at}: {got:?} is not within {low:?} and {high:?}"
        );
    }
}

impl Model {
    /// The levels that its pixels may have.
    fn widen(&self, [low, high]: &mut [[u8; 3]; 2]) {
        let own = [self.instance.colour];
        let colours = if self.colours.is_empty() {
            own.as_slice()
        } else {
            &self.colours
        };
        for colour in colours {
            for i in 0..3 {
                let dark = if self.instance.light.is_some() {
                    0
                } else {
                    colour[i]
                };
                low[i] = low[i].min(dark);
                high[i] = high[i].max(colour[i]);
            }
        }
    }
}

impl Way {
    fn draw<P: Pipeline>(&self, scene: &Scene<'_, P>, ground: WordOf<P>) -> Vec<WordOf<P>> {
        let (width, height) = (scene.screen().width(), scene.screen().height());
        let mut picture = vec![ground; usize::from(width) * usize::from(height)];
        let links = scene.pass_one().objects as usize;
        for offset in 0..self.renderers {
            let mut slots = vec![LineRenderer::<P>::empty_slot(); self.slots];
            let mut links = vec![Link::NONE; links];
            let mut depth = vec![P::Depth::FARTHEST; usize::from(width)];
            let mut renderer = LineRenderer::new(LineMemory {
                slots: &mut slots,
                links: &mut links,
                depth: &mut depth,
            });
            let turn = Interleave::lines(self.renderers, offset).expect("below the step");
            renderer.set_interleave(turn);
            renderer.set_prefetch(self.prefetch);
            renderer.set_depth_use(self.depth_use);
            for i in 0..height {
                let line = match self.order {
                    // A step without a common factor with the height meets every line once.
                    Some((start, step)) if coprime(step, height) => {
                        ((u32::from(start) + u32::from(i) * u32::from(step)) % u32::from(height))
                            as u16
                    }
                    _ => i,
                };
                if line % self.renderers != offset {
                    continue;
                }
                let at = usize::from(line) * usize::from(width);
                let pixels = &mut picture[at..at + usize::from(width)];
                let drawn = renderer.draw_line(scene, line, pixels).expect("memory");
                assert!(drawn || pixels.iter().all(|p| *p == ground));
            }
        }
        picture
    }
}

/// The whole groups of `N` indices.
fn chunks<const N: usize>(indices: &[u16]) -> impl Iterator<Item = [u16; N]> {
    indices
        .chunks_exact(N)
        .filter_map(|group| group.try_into().ok())
}

fn coprime(mut a: u16, mut b: u16) -> bool {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// Draws what the bytes say; panics when something does not hold. How many pixels were covered.
pub fn run(data: &[u8]) -> usize {
    let Ok(Some(case)) = Case::new(&mut Unstructured::new(data)) else {
        return 0;
    };
    let covered = case.draw::<GouraudDepth<Rgb888>>();
    // Which pixels are covered depends on places alone.
    let others = [
        case.draw::<GouraudPainter<Rgb565>>(),
        case.draw::<FlatDepth<Rgb565Be>>(),
        case.draw::<FlatPainter<Rgb888>>(),
    ];
    for other in others {
        assert_eq!(covered, other, "another pipeline");
    }
    covered.map_or(0, |pixels| pixels.iter().filter(|p| **p).count())
}
