//! H18: scanlines of indices become colours by the palette of their line, in any format of the
//! display, whoever draws them and in whatever bands.
//!
//! What index a pixel must have is told by another picture of the same scene, in which each face
//! has a colour of 24 bits of its own.

use crate::common::{LineRooms, Rng, SceneRooms};
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::overlay::{Overlaid, Overlay, Sprite};
use scanbeam::pipeline::parallel::{Crew, Interleave};
use scanbeam::pipeline::send::{draw_frame_indexed, send_frame_indexed};
use scanbeam::pipeline::{
    DepthUse, FlatDepth, FrameError, GouraudDepth, Instance, Pipeline, RendererError, Scene,
};
use scanbeam::pixel::{
    Index4, Index8, Indexed, LinePalettes, PaletteTable, PixelFormat, Pixels, Rgb565, Rgb565Be,
    Rgb565Le, Rgb888,
};
use scanbeam::scan_out::{LineBuf, Pump};
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};
use std::fmt::Debug;

const SIZE: (u16, u16) = (53, 41);
const FACES: usize = 60;

/// Triangles anywhere, and an index for each.
struct Soup {
    positions: Vec<[i16; 3]>,
    faces: Vec<[u16; 3]>,
    indices: Vec<u8>,
}

impl Soup {
    fn new(rng: &mut Rng) -> Self {
        let positions = (0..3 * FACES).map(|_| [0; 3].map(|_| rng.within(-20_000, 20_000) as i16));
        Self {
            positions: positions.collect(),
            faces: (0..FACES as u16)
                .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                .collect(),
            indices: (0..FACES).map(|_| rng.below(256) as u8).collect(),
        }
    }

    /// Draws it with a colour for each face.
    fn build<P: Pipeline>(
        &self,
        scene: &mut Scene<'_, P>,
        lines: std::ops::Range<u16>,
        colour: impl Fn(usize) -> [u8; 3],
    ) {
        let (eye, up) = ([0.0, 0.0, 3.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(eye, [0.0; 3], up, 45.0, 0.5, 50.0).unwrap();
        scene.begin_band(&camera, lines).unwrap();
        let colours: Vec<_> = (0..3 * FACES).map(|i| colour(i / 3)).collect();
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &colours,
            faces: Faces::Triangles(&self.faces),
        };
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw(&mesh, &instance).unwrap();
    }

    /// The face at each pixel.
    fn seen(&self) -> Vec<Option<usize>> {
        let screen = Screen::new(SIZE.0, SIZE.1).unwrap();
        let mut rooms = rooms::<FlatDepth<Rgb888>>();
        let mut scene = rooms.scene(screen);
        let number = |face: usize| [1 + face as u8, 0, 0];
        self.build(&mut scene, 0..SIZE.1, number);
        let pixels = crate::common::frame(&scene, 4095).concat();
        let face = |[red, _, _]: [u8; 3]| usize::from(red).checked_sub(1);
        pixels.into_iter().map(face).collect()
    }
}

fn rooms<P: Pipeline>() -> SceneRooms<P> {
    SceneRooms::new(9 * FACES + 9, 4 * FACES + 4, usize::from(SIZE.1))
}

/// Random palettes and one for each line.
fn palettes<W: Copy + Default, const N: usize>(
    rng: &mut Rng,
    word: impl Fn([u8; 3]) -> W,
) -> (Vec<[W; N]>, Vec<u8>) {
    let colour = |rng: &mut Rng| word([0; 3].map(|_| rng.below(256) as u8));
    let palettes = (0..5).map(|_| {
        let mut palette = [W::default(); N];
        palette.fill_with(|| colour(rng));
        palette
    });
    let palettes = palettes.collect();
    (palettes, (0..SIZE.1).map(|_| rng.below(5) as u8).collect())
}

/// Draws a soup through a pump, band by band and by so many renderers.
fn shown<F, const N: usize>(
    soup: &Soup,
    rng: &mut Rng,
    mut palettes: impl LinePalettes<F::Word, N>,
    background: u8,
) -> Vec<F::Word>
where
    F: PixelFormat,
    F::Word: Debug,
{
    type P<const N: usize> = FlatDepth<Indexed<N>>;
    let screen = Screen::new(SIZE.0, SIZE.1).unwrap();
    let mut rooms = rooms::<P<N>>();
    let mut scene = rooms.scene(screen);
    let sink = MockFrameBuffer::new(SIZE.0, SIZE.1).late_by(rng.below(3));
    let transfer = 1 + rng.below(5) as u16;
    let words = usize::from(SIZE.0) * usize::from(transfer);
    let buffers = [HostLine::<F::Word>::new(words), HostLine::new(words)];
    let mut pump = Pump::new(sink, buffers);
    let bands = rng.pick(&[1, 2, 3]);
    let edge = |band: u16| SIZE.1 * band / bands;
    let mut indices = vec![0xAA; usize::from(SIZE.0) + rng.below(2) as usize];
    for band in 0..bands {
        let lines = edge(band)..edge(band + 1);
        let colour = |face| Indexed::<N>::colour(soup.indices[face]);
        soup.build(&mut scene, lines, colour);
        let slots = rng.pick(&[0, 3, 100]);
        let by = (&mut indices[..], &mut palettes);
        if rng.below(2) == 0 {
            let mut rooms = LineRooms::fitting(slots, &scene);
            let mut renderer = rooms.renderer();
            draw_frame_indexed(&scene, &mut renderer, &mut pump, background, transfer, by).unwrap();
        } else {
            let mut rooms = [0, 1].map(|_| LineRooms::<P<N>>::fitting(slots, &scene));
            let mut offset = 0;
            let mut renderers = rooms.each_mut().map(|rooms| {
                let mut renderer = rooms.renderer();
                renderer.set_interleave(Interleave::lines(2, offset).unwrap());
                renderer.set_depth_use(DepthUse::Always);
                offset += 1;
                renderer
            });
            let mut crew = Crew {
                scene: &scene,
                here: &mut renderers,
                background,
                skipped: 0,
            };
            send_frame_indexed(&scene, &mut crew, &mut pump, transfer, by).unwrap();
        }
    }
    pump.sink().frame().unwrap()
}

fn format<F: PixelFormat, const N: usize>(seed: u64)
where
    F::Word: Debug,
{
    let mut rng = Rng::new(seed);
    let soup = Soup::new(&mut rng);
    let (palettes, of_line) = palettes::<F::Word, N>(&mut rng, F::from_rgb8);
    let background = rng.below(N as u32) as u8;
    let seen = soup.seen();
    let expected = seen.iter().enumerate().map(|(at, face)| {
        let line = at / usize::from(SIZE.0);
        let index = face.map_or(background, |face| soup.indices[face]);
        palettes[usize::from(of_line[line])][usize::from(index) % N]
    });
    let expected: Vec<_> = expected.collect();
    let table = PaletteTable::new(&palettes, &of_line).unwrap();
    assert!(shown::<F, N>(&soup, &mut rng, table, background) == expected);
    // One palette for all lines gives another picture.
    let one = &palettes[0];
    let same = shown::<F, N>(&soup, &mut rng, one, background) == expected;
    assert!(!same, "seed {seed}");
}

#[test]
fn faces_have_the_colour_of_their_index_on_each_line() {
    for seed in 0..12 {
        format::<Rgb565Be, 256>(seed);
        format::<Rgb565Le, 256>(100 + seed);
        format::<Rgb888, 256>(200 + seed);
        format::<Rgb565Be, 16>(300 + seed);
        format::<Rgb565, 16>(400 + seed);
        format::<Rgb888, 2>(500 + seed);
    }
}

/// A sky: entry 0 changes from line to line.
struct Sky([u16; 256]);

impl LinePalettes<u16, 256> for Sky {
    fn palette(&mut self, line: u16) -> &[u16; 256] {
        self.0[0] = 1000 + line;
        &self.0
    }
}

#[test]
fn an_entry_may_change_as_the_lines_go() {
    let mut rng = Rng::new(77);
    let soup = Soup::new(&mut rng);
    let mut palette = [0; 256];
    palette[1..].fill_with(|| rng.below(900) as u16);
    let pixels = shown::<Rgb565, 256>(&soup, &mut rng, Sky(palette), 0);
    let rows = pixels.chunks(usize::from(SIZE.0));
    for (y, (row, faces)) in rows
        .zip(soup.seen().chunks(usize::from(SIZE.0)))
        .enumerate()
    {
        for (pixel, face) in row.iter().zip(faces) {
            let index = face.map_or(0, |face| soup.indices[face]);
            let sky = 1000 + y as u16;
            let expected = if index == 0 {
                sky
            } else {
                palette[usize::from(index)]
            };
            assert_eq!(*pixel, expected);
        }
    }
}

/// Colours between vertices run along the palette, and stay between those of the corners.
#[test]
fn smooth_colours_are_indices_between_those_of_the_corners() {
    let mut rng = Rng::new(9);
    let screen = Screen::new(SIZE.0, SIZE.1).unwrap();
    let mut several = 0;
    for _ in 0..50 {
        let soup = Soup::new(&mut rng);
        let (low, high) = (rng.below(8) as u8, 8 + rng.below(8) as u8);
        let ends = [Index4::colour(low), Index4::colour(high)];
        let mut rooms = rooms::<GouraudDepth<Index4>>();
        let mut scene = rooms.scene(screen);
        soup.build(&mut scene, 0..SIZE.1, |face| ends[face % 2]);
        // Each face has one colour; neighbours in a strip have both.
        let mesh = Mesh {
            positions: &soup.positions,
            normals: &[],
            colours: &(0..3 * FACES).map(|i| ends[i % 2]).collect::<Vec<_>>(),
            faces: Faces::Triangles(&soup.faces),
        };
        scene.draw(&mesh, &Instance::default()).unwrap();
        let mut seen = std::collections::BTreeSet::new();
        let mut rooms = LineRooms::fitting(100, &scene);
        let mut renderer = rooms.renderer();
        for y in 0..SIZE.1 {
            let mut line = vec![99; usize::from(SIZE.0)];
            renderer.draw_line(&scene, y, &mut line).unwrap();
            seen.extend(line.into_iter().filter(|i| *i != 99));
        }
        assert!(seen.iter().all(|i| (low..=high).contains(i)), "{seen:?}");
        several += usize::from(seen.len() > 3);
    }
    assert!(several > 25, "{several}");
}

#[test]
fn sprites_of_indices_lie_over_them() {
    let mut rng = Rng::new(3);
    let soup = Soup::new(&mut rng);
    let screen = Screen::new(SIZE.0, SIZE.1).unwrap();
    let mut rooms = rooms::<FlatDepth<Index8>>();
    let mut scene = rooms.scene(screen);
    let colour = |face: usize| Index8::colour(soup.indices[face]);
    soup.build(&mut scene, 0..SIZE.1, colour);
    let mut line_rooms = LineRooms::fitting(9, &scene);
    let mut renderers = [line_rooms.renderer()];
    let crew = Crew {
        scene: &scene,
        here: &mut renderers,
        background: 0,
        skipped: 0,
    };
    let sprites = [Sprite {
        x: 10,
        y: 5,
        width: 6,
        height: 4,
        pixels: Pixels::Colour(200),
        ink: Default::default(),
    }];
    let overlay = Overlay::new(&sprites).unwrap();
    let mut source = Overlaid {
        source: crew,
        overlay,
    };
    let palette: [u16; 256] = std::array::from_fn(|i| 3 * i as u16);
    let mut pump = Pump::new(
        MockFrameBuffer::new(SIZE.0, SIZE.1),
        [0, 1].map(|_| HostLine::new(usize::from(SIZE.0))),
    );
    let mut indices = [0; SIZE.0 as usize];
    send_frame_indexed(&scene, &mut source, &mut pump, 1, (&mut indices, &palette)).unwrap();
    let seen = soup.seen();
    for (at, pixel) in pump.sink().frame().unwrap().into_iter().enumerate() {
        let (x, y) = (at % usize::from(SIZE.0), at / usize::from(SIZE.0));
        let index = seen[at].map_or(0, |face| soup.indices[face]);
        let over = (10..16).contains(&x) && (5..9).contains(&y);
        assert_eq!(pixel, 3 * if over { 200 } else { u16::from(index) });
    }
}

#[test]
fn a_line_of_bytes_that_is_too_short_is_an_error() {
    let screen = Screen::new(SIZE.0, SIZE.1).unwrap();
    let mut rooms = rooms::<FlatDepth<Index8>>();
    let mut scene = rooms.scene(screen);
    Soup::new(&mut Rng::new(1)).build(&mut scene, 0..SIZE.1, |_| [9; 3]);
    let mut line_rooms = LineRooms::fitting(9, &scene);
    let mut renderer = line_rooms.renderer();
    let mut buffers = [0, 1].map(|_| HostLine::<u16>::new(usize::from(SIZE.0)));
    buffers[0].pixels().fill(1);
    let mut pump = Pump::new(MockFrameBuffer::new(SIZE.0, SIZE.1), buffers);
    let by = (&mut [0; 52][..], &[7; 256]);
    let error = draw_frame_indexed(&scene, &mut renderer, &mut pump, 0, 1, by).unwrap_err();
    let short = RendererError::Pixels {
        needed: 53,
        have: 52,
    };
    assert_eq!(error, FrameError::Renderer(short));
    let by = (&mut [0; 53][..], &[7; 256]);
    draw_frame_indexed(&scene, &mut renderer, &mut pump, 0, 1, by).unwrap();
    assert_eq!(pump.sink().frame().unwrap().len(), 53 * 41);
}
