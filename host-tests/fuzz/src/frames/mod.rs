//! Set-up to pixels: any bytes as a scene, drawn in every way.

mod bytes;
mod call;

use arbitrary::{Result, Unstructured};
use bytes::camera;
use call::Call;
use scanbeam::frame::{FastMemory, Memory as Lent, Renderer};
use scanbeam::look::{Gouraud, Look, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};
use scanbeam::scene::{DrawState, Memory, Object, Scene, Texture, TexturePlace, Vertex};
use scanbeam::{Camera, Link, Screen};
use std::fmt::Debug;

/// Longest side of a picture.
const MOST: u16 = 64;

/// How a frame is drawn; none of it may change a pixel.
#[derive(Debug)]
struct Way {
    slots: u16,
    renderers: u16,
    /// Bytes a line that are fetched ahead.
    fetched: u32,
    counts: bool,
    /// Where lines begin, and the step to the next, modulo the height.
    order: Option<[u16; 2]>,
}

/// A whole case.
#[derive(Debug)]
struct Case {
    screen: Screen,
    camera: Camera,
    calls: Vec<Call>,
    texels: Vec<u16>,
    has_depth: bool,
    vertices: usize,
    objects: usize,
    way: Way,
}

/// A look whose lines the target draws, by words that it can compare.
trait Drawn: Look + 'static {
    type Format: PixelFormat<Word: Debug>;

    fn draw_line(
        renderer: &mut Renderer<'_, Self>,
        scene: &Scene<'_, '_, Self>,
        line: u16,
        pixels: &mut [WordOf<Self>],
        ground: WordOf<Self>,
    ) -> bool;
}

type WordOf<L> = <<L as Drawn>::Format as PixelFormat>::Word;

macro_rules! drawn {
    ($($look:ident<$format:ty>),+) => {$(
        impl Drawn for $look<$format> {
            type Format = $format;

            fn draw_line(
                renderer: &mut Renderer<'_, Self>,
                scene: &Scene<'_, '_, Self>,
                line: u16,
                pixels: &mut [WordOf<Self>],
                ground: WordOf<Self>,
            ) -> bool {
                renderer.draw_line(scene, line, pixels, ground).expect("memory")
            }
        }
    )+};
}
drawn!(Gouraud<Rgb888>, Gouraud<Rgb565>, Textured<Rgb565Be>);

impl Case {
    /// `None` when a camera cannot be made of the bytes.
    fn new(u: &mut Unstructured<'_>) -> Result<Option<Self>> {
        let screen = Screen::new(u.int_in_range(1..=MOST)?, u.int_in_range(1..=MOST)?);
        let camera = camera(u)?;
        let (Ok(screen), Ok(camera)) = (screen, camera) else {
            return Ok(None);
        };
        let order = match u.arbitrary()? {
            true => Some([u.arbitrary()?, u.arbitrary()?]),
            false => None,
        };
        Ok(Some(Self {
            screen,
            camera,
            way: Way {
                slots: u.int_in_range(0..=12)?,
                renderers: u.int_in_range(1..=3)?,
                fetched: u.int_in_range(0..=300)?,
                counts: u.arbitrary()?,
                order,
            },
            has_depth: u.ratio(3, 4)?,
            vertices: u.int_in_range(0..=120)?,
            objects: u.int_in_range(0..=100)?,
            texels: (0..64).map(|_| u.arbitrary()).collect::<Result<_>>()?,
            calls: (0..u.int_in_range(1..=4u8)?)
                .map(|_| Call::new(u, screen))
                .collect::<Result<_>>()?,
        }))
    }

    /// Draws in plenty of slots and again in the case's way, each over two grounds; hands out which pixels are covered,
    /// or `None` where something found no room.
    fn draw<L: Drawn>(&self, is_textured: bool, is_plain: bool) -> Option<Vec<bool>> {
        let texture = Texture::words(&self.texels, 8, 8).expect("8 x 8 texels");
        let mut vertices = vec![Vertex::EMPTY; self.vertices];
        let mut places = vec![TexturePlace::EMPTY; self.vertices];
        let mut objects = vec![Object::EMPTY; self.objects];
        let mut bins = vec![0; usize::from(self.screen.height())];
        let mut draws = vec![DrawState::EMPTY; 3];
        let memory = Memory {
            vertices: &mut vertices,
            places: &mut places,
            objects: &mut objects,
            bins: &mut bins,
            draws: &mut draws,
        };
        let mut scene = Scene::<L>::new(self.screen, memory);
        scene.begin(&self.camera).expect("a bin a line");
        let mut range = [[u8::MAX; 3], [0; 3]];
        let mut all = 0;
        for call in &self.calls {
            let skin = is_textured.then_some(&texture);
            if call.draw(&mut scene, skin, is_plain) {
                call.widen(&mut range);
            }
            all += 1;
        }
        let done = scene.assembled();
        assert!(scene.objects() <= self.objects && scene.vertices() <= self.vertices);
        assert!(
            done.culled <= done.triangles && done.dropped <= done.triangles,
            "{done:?} of {all} calls"
        );

        let plenty = Way {
            slots: 64,
            renderers: 1,
            fetched: 0,
            counts: false,
            order: None,
        };
        let [black, white] = [[0; 3], [255; 3]].map(L::Format::from_rgb8);
        let picture = plenty.draw(&scene, self.has_depth, black);
        assert_eq!(
            picture,
            self.way.draw(&scene, self.has_depth, black),
            "another way"
        );
        if !is_plain {
            return None;
        }
        let other = plenty.draw(&scene, self.has_depth, white);
        let mut covered = Vec::new();
        for (i, (&a, &b)) in picture.iter().zip(&other).enumerate() {
            covered.push(a == b);
            if a != b {
                assert_eq!((a, b), (black, white), "pixel {i}");
            } else if !is_textured {
                within::<L>(a, range, i);
            }
        }
        (done.dropped == 0).then_some(covered)
    }
}

/// No colour wraps (P4): each channel lies within a step of the levels that it was made from.
fn within<L: Drawn>(word: WordOf<L>, [low, high]: [[u8; 3]; 2], at: usize) {
    let got = L::Format::to_rgb8(word);
    for i in 0..3 {
        let steps = f64::from(L::Format::STEPS[i]);
        let step = |level: u8| f64::from(level) * steps / 255.0;
        // Half a step by rounding, half by interpolation, and the rounding of `to_rgb8`.
        let slack = 1.0 + 0.5 * steps / 255.0;
        assert!(
            (step(low[i]) - slack..=step(high[i]) + slack).contains(&step(got[i])),
            "pixel {at}: {got:?} is not within {low:?} and {high:?}"
        );
    }
}

impl Way {
    fn draw<L: Drawn>(
        &self,
        scene: &Scene<'_, '_, L>,
        has_depth: bool,
        ground: WordOf<L>,
    ) -> Vec<WordOf<L>> {
        let (width, height) = (scene.screen().width(), scene.screen().height());
        let mut picture = vec![ground; usize::from(width) * usize::from(height)];
        for offset in 0..self.renderers {
            let mut cache = FastMemory::new();
            cache.set_limit(self.slots);
            let mut links = vec![Link::EMPTY; scene.objects()];
            // Shadows are counted by depth.
            let mut depth = vec![0; usize::from(width)];
            let mut counts = vec![0; usize::from(width)];
            let lent = Lent {
                cache: &mut cache,
                links: &mut links,
                depth: &mut depth,
            };
            let mut renderer = match has_depth {
                true => Renderer::with_shadows(lent, &mut counts),
                false => Renderer::new(Lent {
                    depth: &mut [],
                    ..lent
                }),
            };
            if renderer.check(scene).is_err() {
                // Shadows without depth, which are refused before anything is drawn.
                assert!(!has_depth);
                return picture;
            }
            if self.fetched > 0 {
                renderer = renderer.fetching(self.fetched);
            }
            if self.counts {
                renderer = renderer.counting();
            }
            for i in 0..height {
                let line = match self.order {
                    // A step without a common factor with the height meets every line once.
                    Some([start, step]) if coprime(step, height) => {
                        let at = u32::from(start) + u32::from(i) * u32::from(step);
                        (at % u32::from(height)) as u16
                    }
                    _ => i,
                };
                if line % self.renderers != offset {
                    continue;
                }
                let at = usize::from(line) * usize::from(width);
                let pixels = &mut picture[at..at + usize::from(width)];
                let drawn = L::draw_line(&mut renderer, scene, line, pixels, ground);
                assert!(drawn || pixels.iter().all(|p| *p == ground));
            }
            let spans = renderer.spans();
            assert!(spans.spans_hidden <= spans.spans && spans.spans_untested <= spans.spans);
        }
        picture
    }
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
    let covered = case.draw::<Gouraud<Rgb888>>(false, true);
    // Which pixels are covered depends on places alone.
    assert_eq!(
        covered,
        case.draw::<Gouraud<Rgb565>>(false, true),
        "another format"
    );
    // Textures have no holes here; with them a scene may be fuller, as faces that are cut take places.
    let textured = case.draw::<Textured<Rgb565Be>>(true, true);
    assert_eq!(covered, textured, "another look");
    // Values may do anything to pixels but hang on how they are drawn.
    case.draw::<Gouraud<Rgb888>>(false, false);
    case.draw::<Textured<Rgb565Be>>(true, false);
    covered.map_or(0, |pixels| pixels.iter().filter(|p| **p).count())
}
