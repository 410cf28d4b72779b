//! H15: what is clipped to the inside or outside of a window is the un-clipped picture, masked: for
//! random scenes, windows and pipelines, any cache, several renderers, whole or in bands.
//!
//! The picture that is masked comes from pipelines that know no windows. Groups of triangles have
//! clips of their own; at each pixel the right picture is that of the groups which keep the pixel.

use crate::common::{LineRooms, Rng, SceneRooms};
use scanbeam::list::Window;
use scanbeam::pipeline::blend::Finish;
use scanbeam::pipeline::parallel::Interleave;
use scanbeam::pipeline::{
    Clip, Composited, Counted, FlatDepth, FlatPainter, Forward, GouraudDepth, GouraudPainter,
    Instance, Interpolated, Pipeline, Scene, Shading, SkinOf, Windowed, WordOf,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};
use std::ops::Range;

const SIZE: (u16, u16) = (47, 38);

/// Triangles that have one clip.
struct Group {
    clip: Clip,
    /// Of surfaces that have one.
    finish: Finish,
    positions: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<[u16; 3]>,
}

fn window(rng: &mut Rng) -> Window {
    let mut side = |most: u16| {
        let ends = [0; 2].map(|_| rng.below(u32::from(most) + 6) as u16);
        (ends[0].min(ends[1]), ends[0].max(ends[1]))
    };
    let ((left, right), (top, bottom)) = (side(SIZE.0), side(SIZE.1));
    Window {
        left,
        top,
        right,
        bottom,
    }
}

impl Group {
    fn new(rng: &mut Rng) -> Self {
        let window = window(rng);
        let count = rng.pick(&[1, 7, 30]) as u16;
        let size = rng.pick(&[400, 5_000, 30_000]);
        let mut positions = Vec::new();
        for _ in 0..count {
            let at = [0; 3].map(|_| rng.within(-18_000, 18_000));
            for _ in 0..3 {
                let near = |c: i32, rng: &mut Rng| c + rng.within(-size, size);
                let corner = at.map(|c| near(c, rng).clamp(-32_768, 32_767) as i16);
                positions.push(corner);
            }
        }
        Self {
            clip: match rng.below(5) {
                0 => Clip::Picture,
                1 | 2 => Clip::Inside(window),
                _ => Clip::Outside(window),
            },
            finish: Finish::OPAQUE,
            positions,
            colours: (0..3 * count)
                .map(|_| [0; 3].map(|_| rng.below(256) as u8))
                .collect(),
            faces: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        }
    }

    fn draw<P: Pipeline>(&self, scene: &mut Scene<'_, P>) {
        let skin = P::Shading::finished(SkinOf::<P>::default(), self.finish);
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &self.colours,
            faces: Faces::Triangles(&self.faces),
        };
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw_skinned(&mesh, skin, &instance).unwrap();
    }

    fn keeps(&self, x: u16, y: u16) -> bool {
        let has = |w: Window| (w.left..w.right).contains(&x) && (w.top..w.bottom).contains(&y);
        match self.clip {
            Clip::Picture => true,
            Clip::Inside(window) => has(window),
            Clip::Outside(window) => !has(window),
        }
    }
}

fn begin<P: Pipeline>(scene: &mut Scene<'_, P>, lines: Range<u16>) {
    let (eye, up) = ([0.0, 0.0, 2.5], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, [0.0; 3], up, 40.0, 0.4, 50.0).unwrap();
    scene.begin_band(&camera, lines).unwrap();
}

/// The pixels of the groups whose bit is set, by a pipeline without windows.
fn unclipped<P: Pipeline>(groups: &[Group], subset: usize) -> Vec<WordOf<P>> {
    let mut rooms = SceneRooms::<P>::new(2000, 1000, 64);
    let mut scene = rooms.scene(Screen::new(SIZE.0, SIZE.1).unwrap());
    begin(&mut scene, 0..SIZE.1);
    for (_, group) in groups
        .iter()
        .enumerate()
        .filter(|(i, _)| subset >> i & 1 != 0)
    {
        group.draw(&mut scene);
    }
    crate::common::frame(&scene, 4000).concat()
}

/// What should be seen.
fn masked<P: Pipeline>(groups: &[Group]) -> Vec<WordOf<P>> {
    let all: Vec<_> = (0..1 << groups.len())
        .map(|subset| unclipped::<P>(groups, subset))
        .collect();
    let places = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    let pixels = places.enumerate().map(|(at, (x, y))| {
        let kept = groups.iter().enumerate().filter(|(_, g)| g.keeps(x, y));
        let subset: usize = kept.map(|(i, _)| 1 << i).sum();
        all[subset][at]
    });
    pixels.collect()
}

/// What is seen, drawn in bands by so many renderers.
fn clipped<P: Pipeline>(groups: &[Group], rng: &mut Rng) -> Vec<WordOf<P>> {
    let mut rooms = SceneRooms::<P>::new(2000, 4000, 64);
    let mut scene = rooms.scene(Screen::new(SIZE.0, SIZE.1).unwrap());
    let bands = rng.pick(&[1, 1, 2, 3]);
    let mut frame = Vec::new();
    for band in 0..bands {
        let edge = |band: u16| SIZE.1 * band / bands;
        begin(&mut scene, edge(band)..edge(band + 1));
        assert_eq!(scene.clip(), Clip::Picture);
        for group in groups {
            scene.set_clip(group.clip);
            group.draw(&mut scene);
        }
        let slots = rng.pick(&[0, 2, 9, 500]);
        let count = 1 + rng.below(3) as u16;
        let mut rooms: Vec<_> = (0..count)
            .map(|_| LineRooms::<P>::fitting(slots, &scene))
            .collect();
        let mut renderers: Vec<_> = rooms.iter_mut().map(LineRooms::renderer).collect();
        for (offset, renderer) in (0..).zip(&mut renderers) {
            renderer.set_interleave(Interleave::lines(count, offset).unwrap());
        }
        for y in scene.lines() {
            let own = renderers.iter_mut().find(|r| r.interleave().owns(y));
            frame.extend(crate::common::line(own.unwrap(), &scene, y));
        }
    }
    frame
}

fn compare<P: Pipeline>(seeds: Range<u64>) {
    let mut partly = 0;
    for seed in seeds.clone() {
        let mut rng = Rng::new(seed);
        let mut groups: Vec<_> = (0..1 + rng.below(3))
            .map(|_| Group::new(&mut rng))
            .collect();
        for group in groups.iter_mut().skip(1) {
            // What adds does so in any order.
            group.finish = Finish::additive(130);
        }
        let expected = masked::<P>(&groups);
        let seen = clipped::<Windowed<P>>(&groups, &mut rng);
        assert!(seen == expected, "seed {seed}");
        partly += u32::from(seen != unclipped::<P>(&groups, (1 << groups.len()) - 1));
    }
    // Often it matters.
    assert!(u64::from(partly) * 2 > seeds.end - seeds.start, "{partly}");
}

#[test]
fn clipped_pictures_are_masked_ones() {
    compare::<FlatDepth<Rgb565Be>>(0..120);
    compare::<FlatPainter<Rgb888>>(200..260);
    compare::<GouraudDepth<Rgb888>>(300..420);
    compare::<GouraudPainter<Rgb888>>(500..560);
    compare::<Interpolated<GouraudDepth<Rgb565Be>, Forward>>(600..680);
    compare::<Counted<GouraudDepth<Rgb888>>>(700..740);
}

#[test]
fn clipped_glass_is_masked_glass() {
    compare::<Composited<GouraudDepth<Rgb888>>>(800..880);
    compare::<Composited<FlatDepth<Rgb565Be>>>(900..960);
}

/// Ramps of 5 and 6 bits are anchored where the span begins, so where it is cut they may round the other
/// way: no channel is off by more than a step, and no pixel of the mask is.
#[test]
fn packed_colours_are_a_step_off_at_most() {
    type P = GouraudDepth<Rgb565Be>;
    let mut same = 0usize;
    let mut all = 0usize;
    for seed in 0..60 {
        let mut rng = Rng::new(2000 + seed);
        let groups: Vec<_> = (0..1 + rng.below(3))
            .map(|_| Group::new(&mut rng))
            .collect();
        let expected = masked::<P>(&groups);
        let seen = clipped::<Windowed<P>>(&groups, &mut rng);
        for (a, b) in seen.iter().zip(&expected) {
            let [a, b] = [*a, *b].map(|w| {
                let w = u16::from_be(w);
                [w >> 11, w >> 5 & 63, w & 31].map(i32::from)
            });
            assert!((0..3).all(|i| (a[i] - b[i]).abs() <= 1), "{a:?} {b:?}");
            same += usize::from(a == b);
            all += 1;
        }
    }
    println!("{same} of {all} pixels the same");
    assert!(same * 100 > all * 98, "{same} of {all}");
}

#[test]
fn what_is_outside_is_skipped_and_counted() {
    type P = Windowed<FlatDepth<Rgb888>>;
    let mut rooms = SceneRooms::<P>::new(2000, 4000, 64);
    let mut scene = rooms.scene(Screen::new(SIZE.0, SIZE.1).unwrap());
    let mut some = 0;
    for seed in 0..200 {
        let mut rng = Rng::new(3000 + seed);
        let mut group = Group::new(&mut rng);
        let alone = |scene: &mut Scene<'_, P>, group: &Group| {
            begin(scene, 0..SIZE.1);
            scene.set_clip(group.clip);
            group.draw(scene);
            scene.pass_one()
        };
        let clip = core::mem::replace(&mut group.clip, Clip::Picture);
        let open = alone(&mut scene, &group);
        assert_eq!(open.outside_window, 0);
        group.clip = clip;
        let cut = alone(&mut scene, &group);
        assert_eq!(cut.triangles, open.triangles);
        if cut.clipped == 0 {
            // Each triangle is kept, in one part or several, or outside, or was culled before.
            assert_eq!(cut.culled - open.culled, cut.outside_window);
            assert!(cut.objects <= 4 * (open.objects - cut.outside_window));
        }
        if matches!(clip, Clip::Inside(_)) {
            assert!(cut.objects <= open.objects);
        }
        some += u32::from(cut.outside_window > 0);
        // An empty window keeps all, or nothing.
        let nowhere = Window {
            left: 9,
            top: 9,
            right: 9,
            bottom: 20,
        };
        group.clip = Clip::Outside(nowhere);
        assert_eq!(alone(&mut scene, &group).objects, open.objects);
        group.clip = Clip::Inside(nowhere);
        let none = alone(&mut scene, &group);
        assert_eq!((none.objects, none.vertices), (0, 0));
        assert_eq!(none.culled, none.triangles);
    }
    assert!(some > 60, "{some}");
}
