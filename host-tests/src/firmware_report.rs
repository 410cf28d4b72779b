//! `firmware`: every frame of the firmware against the same frame drawn here, bit for bit (X1).

use crate::args::FirmwareArgs;
use crate::draw::ModelLines;
use crate::effect_frames::effect_frames;
use crate::figures::gate::{Record, Verdict};
use crate::figures::{Bench, Figure, Size, growth, suite};
use crate::firmware::{
    self, BOARDS, Board, COMPARER, DEFAULT_TIMEOUT, Measured, Profile, Sections, Toolchain,
};
use crate::image_out::{Frame, make_folder, write_atomically, write_image};
use crate::lean_frames::lean_frame;
use crate::lent::{LineRooms, SceneRooms};
use crate::method_frames::method_frames;
use crate::mock::{HostLine, MockFrameBuffer};
use crate::{preset_sizes, profile_report};
use scanbeam::input::ListMemory;
use scanbeam::list::TextureSlot;
use scanbeam::pipeline::{
    BlockFixed, Counted, Deferred, DepthUse, FlatDepth, FlatPainter, Gouraud, GouraudDepth,
    GouraudPainter, ListedDepth, Pipeline, TexturedDepth, Worded,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::Pump;
use scanbeam::texture::{Quality, Size as TextureSize, Texture, Textured, Textures, Words, Wrap};
use scanbeam::{FrameStats, Scene, draw_frame};
use scanbeam_model::draw_model_frame;
use scenes::{
    CRATE_INDICES, CRATE_TABLE, CRATE_TEXTURES, DEPTHS, HEIGHT, KeepsDepth, LEAN, LIST_INDICES,
    LIST_TABLE, LookB, LookF, OBJECTS, SCENE_B_BLOCKS, SCENES_B, SHOTS, STACKS, STRESS, SUITE,
    SWATCHES, SceneB, Shot, Suite, TEXEL_SIDE, TEXELS_PANEL, TEXTURES_B, TEXTURES_F, VARIANTS,
    VERTICES, WIDTH, build_crate, build_listed,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

/// Builds and runs the firmware on every board and compares; `false` when a frame differs, or when
/// something costs more than recorded, or has just been recorded.
///
/// # Errors
/// When the firmware cannot be built or run, or did not say what it should.
pub fn run(args: &FirmwareArgs) -> Result<bool, Box<dyn Error>> {
    if args.sizes {
        return preset_sizes::run(args).map(|()| true);
    }
    if let Some(frame) = &args.profile {
        return profile_report::run(frame, args).map(|()| true);
    }
    let host = host_frames()?;
    if args.bless {
        return bless(&host);
    }
    let toolchain = Toolchain::find()?;
    let boards = compared(&toolchain, &host, args.bench)?;
    let verdict = if args.bench {
        Record::read(&Record::path())?.judge(&toolchain.version, &figures(&boards))
    } else {
        Verdict::default()
    };
    if args.json {
        let reports: Vec<Value> = boards.iter().map(Compared::to_json).collect();
        // The first board's figures stand at the top, where the contract has them.
        let mut report = reports.first().cloned().unwrap_or_default();
        report["toolchain"] = json!(toolchain.version);
        report["targets"] = json!(reports);
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        say!("{}", toolchain.version);
        for board in &boards {
            board.print();
        }
    }
    if let Some(folder) = &args.output {
        plot(folder, &boards)?;
    }
    for refusal in &verdict.refused {
        tell!("slower: {refusal}");
    }
    if let Some(other) = &verdict.other {
        tell!("note: no figures of this compiler are recorded; those of {other} were used");
    }
    if verdict.better > 0 {
        let better = verdict.better;
        tell!("note: {better} figures are better than recorded: {BLESS} would keep that");
    }
    if !verdict.refused.is_empty() {
        tell!("if it has to be so, {BLESS} records it");
    }
    Ok(boards.iter().all(Compared::matches) && verdict.refused.is_empty())
}

/// The command that records figures.
const BLESS: &str = "`cargo run --release -p host-tests -- firmware --bench --bless`";

/// Records the figures of every complete compiler; `false`, because nothing was judged.
fn bless(host: &BTreeMap<&str, u32>) -> Result<bool, Box<dyn Error>> {
    let path = Record::path();
    let mut record = Record::read(&path)?;
    for toolchain in Toolchain::all()? {
        let boards = compared(&toolchain, host, true)?;
        if let Some(wrong) = boards.iter().find(|board| !board.matches()) {
            let name = wrong.measured.board.name;
            return Err(format!("{name}: a frame differs, so nothing is recorded").into());
        }
        record.bless(&toolchain.version, &figures(&boards));
        record.write(&path)?;
        tell!("recorded: {}", toolchain.version);
    }
    suite::write(&record)?;
    tell!("{} is new: look at what changed in it", path.display());
    Ok(false)
}

/// Runs every board.
fn compared(
    toolchain: &Toolchain,
    host: &BTreeMap<&str, u32>,
    bench: bool,
) -> Result<Vec<Compared>, Box<dyn Error>> {
    let mut boards = Vec::new();
    let spans = growth::spans()?;
    let programs = if bench {
        &[COMPARER, SIZES[0], SIZES[1]][..]
    } else {
        &[COMPARER]
    };
    firmware::build_all(toolchain, &BOARDS, Profile::Release, programs, &[])?;
    if bench {
        let programs = &[COMPARER];
        firmware::build_all(toolchain, &BOARDS, Profile::Release, programs, &["bench"])?;
    }
    for board in &BOARDS {
        let measured = firmware::measure(toolchain, board, Profile::Release, &[])?;
        let mut compared = Compared::new(measured, host)?;
        if bench {
            let measured = firmware::measure(toolchain, board, Profile::Release, &["bench"])?;
            let sizes = sizes(toolchain, board, host)?;
            compared.bench = Some(Bench::new(&measured.output, &spans, sizes)?);
        }
        boards.push(compared);
    }
    Ok(boards)
}

/// The small programs.
const SIZES: [&str; 2] = ["preset", "presets"];

/// Builds the small programs, and runs them, so that what is measured also draws.
fn sizes(
    toolchain: &Toolchain,
    board: &Board,
    host: &BTreeMap<&str, u32>,
) -> Result<Vec<Size>, Box<dyn Error>> {
    let mut known = host.clone();
    let painter = draw::<GouraudPainter<Rgb565Be>>(Shot::Teapot)?;
    known.insert("teapot_painter", crc32fast::hash(&painter));
    let painter = draw::<FlatPainter<Rgb565Be>>(Shot::Teapot)?;
    known.insert("teapot_flat_painter", crc32fast::hash(&painter));
    let mut sizes = Vec::new();
    for program in SIZES {
        let elf = firmware::build(toolchain, board, Profile::Release, program, &[])?;
        let pictures = firmware::run(board, &elf, DEFAULT_TIMEOUT)?;
        let drawn = |line: &String| {
            let mut words = line.split(' ').skip(1);
            let crc = known.get(words.next()?)?;
            (words.next()? == format!("{crc:08x}")).then_some(())
        };
        if pictures.is_empty() || !pictures.iter().all(|line| drawn(line).is_some()) {
            let name = board.name;
            return Err(format!("{name}: {program} draws something else: {pictures:?}").into());
        }
        sizes.push(Size {
            program,
            sections: Sections::read(&elf)?,
        });
    }
    Ok(sizes)
}

/// Everything that is recorded, by board.
fn figures(boards: &[Compared]) -> BTreeMap<String, Vec<Figure>> {
    let of = |board: &Compared| {
        let frames = board
            .frames
            .iter()
            .map(|(scene, _, _, instructions)| Figure {
                name: format!("frame {scene}"),
                value: *instructions as f64,
                // Two ticks.
                grain: 80.0,
            });
        let mut figures: Vec<Figure> = frames.collect();
        figures.extend(board.bench.iter().flat_map(Bench::figures));
        (board.measured.board.name.to_owned(), figures)
    };
    boards.iter().map(of).collect()
}

/// Writes the growth of the first board.
fn plot(folder: &Path, boards: &[Compared]) -> Result<(), Box<dyn Error>> {
    make_folder(folder)?;
    let curves = boards.first().and_then(|board| board.bench.as_ref());
    let plot = growth::plot(curves.map_or(&[], |bench| &bench.growth));
    write_atomically(&folder.join("growth.svg"), plot.to_svg().as_bytes())?;
    write_image(&folder.join("growth.png"), &plot.to_frame())?;
    Ok(())
}

/// The checksums of all frames as this machine draws them, by name.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn host_frames() -> Result<BTreeMap<&'static str, u32>, Box<dyn Error>> {
    let mut frames = BTreeMap::new();
    for suite in SUITE {
        let bytes = drawn_suite::<GouraudDepth<Rgb565Be>, LookB, LookF>(suite)?.0;
        frames.insert(suite.name(), crc32fast::hash(&bytes));
    }
    for (name, suite) in LEAN {
        frames.insert(name, crc32fast::hash(&lean_frame(suite)?));
    }
    for shot in SHOTS.into_iter().chain(STACKS).chain(STRESS) {
        frames.insert(
            shot.name(),
            crc32fast::hash(&draw::<GouraudDepth<Rgb565Be>>(shot)?),
        );
    }
    let flat = draw::<FlatDepth<Rgb565Be>>(Shot::Teapot)?;
    frames.insert("teapot_flat", crc32fast::hash(&flat));
    let flat = draw::<FlatDepth<Rgb565Be>>(Shot::Crossings)?;
    frames.insert("crossings_flat", crc32fast::hash(&flat));
    let model = draw_by_model(Shot::Teapot)?;
    frames.insert("teapot_model", crc32fast::hash(&model));
    let (listed, _) = shown(Shot::Teapot, build_list, by_lines)?;
    frames.insert("teapot_list", crc32fast::hash(&listed));
    let slots = [const { TextureSlot::new() }; CRATE_TEXTURES];
    let build = |scene: &mut Scene<'_, _>| build_crate_list(scene, &slots);
    let (listed, _) = shown(Shot::Teapot, build, by_lines)?;
    frames.insert("crate_list", crc32fast::hash(&listed));
    for (name, shot, keeps) in DEPTHS {
        frames.insert(name, crc32fast::hash(&draw_keeping(shot, keeps)?));
    }
    for scene in SCENES_B {
        frames.insert(scene.name, crc32fast::hash(&drawn_b::<LookB>(scene)?.0));
    }
    frames.insert(
        SCENE_B_BLOCKS.name,
        crc32fast::hash(&draw_rows_b(SCENE_B_BLOCKS)?),
    );
    for variant in VARIANTS {
        // However it is drawn there, it is the shot that one renderer draws here.
        let plain = draw::<GouraudDepth<Rgb565Be>>(variant.shot)?;
        frames.insert(variant.name, crc32fast::hash(&plain));
    }
    for (name, swatch) in SWATCHES {
        let mut bytes = Vec::new();
        swatch.draw(&mut |line| bytes.extend(line.iter().flat_map(|word| word.to_ne_bytes())));
        frames.insert(name, crc32fast::hash(&bytes));
    }
    for (name, words) in method_frames()?.into_iter().chain(effect_frames(64)?) {
        let bytes: Vec<u8> = words.into_iter().flat_map(u16::to_ne_bytes).collect();
        frames.insert(name, crc32fast::hash(&bytes));
    }
    Ok(frames)
}

/// Lines that one transfer takes.
const LINES: u16 = 3;

/// What the frames of the shots have: pixels, spans and triangles, by name.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn host_counts() -> Result<BTreeMap<&'static str, FrameStats>, Box<dyn Error>> {
    let mut counts = BTreeMap::new();
    for shot in SHOTS.into_iter().chain(STACKS) {
        let drawn = drawn::<Counted<GouraudDepth<Rgb565Be>>>(shot)?;
        counts.insert(shot.name(), drawn.1);
    }
    for scene in SCENES_B {
        counts.insert(scene.name, drawn_b::<Counted<LookB>>(scene)?.1);
    }
    for suite in SUITE {
        let (_, stats) = counted_suite(suite)?;
        counts.insert(suite.name(), stats);
    }
    Ok(counts)
}

/// A shot as a picture, and what its frame had.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn picture(shot: Shot) -> Result<(Frame, FrameStats), Box<dyn Error>> {
    let (bytes, stats) = drawn::<Counted<GouraudDepth<Rgb565Be>>>(shot)?;
    Ok((framed(&bytes)?, stats))
}

/// A scene B as a picture, and what its frame had.
///
/// # Errors
/// As [`picture`].
pub fn picture_b(scene: SceneB) -> Result<(Frame, FrameStats), Box<dyn Error>> {
    let (bytes, stats) = drawn_b::<Counted<LookB>>(scene)?;
    Ok((framed(&bytes)?, stats))
}

/// A picture of the bytes of a shot in scan-out order.
fn framed(bytes: &[u8]) -> Result<Frame, Box<dyn Error>> {
    let words = bytes
        .chunks_exact(2)
        .map(|b| u16::from_ne_bytes([b[0], b[1]]));
    let rgb = words.flat_map(Rgb565Be::to_rgb8).collect();
    Ok(Frame::new(WIDTH.into(), HEIGHT.into(), rgb).ok_or("a frame of another size")?)
}

/// The bytes of a shot in scan-out order.
pub(crate) fn draw<P: Pipeline<Pixel = Rgb565Be>>(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    drawn::<P>(shot).map(|(bytes, _)| bytes)
}

/// The bytes of a shot in scan-out order, and what the frame had.
fn drawn<P: Pipeline<Pixel = Rgb565Be>>(
    shot: Shot,
) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>> {
    shown::<P, _>(shot, |scene| build(shot, scene), by_lines)
}

/// The bytes of a shot in scan-out order, with depth kept in another way on every line.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn draw_keeping(shot: Shot, keeps: KeepsDepth) -> Result<Vec<u8>, Box<dyn Error>> {
    match keeps {
        KeepsDepth::BlockFix => draw_tested::<BlockFixed<GouraudDepth<Rgb565Be>>>(shot),
        KeepsDepth::Word => draw_tested::<Worded<GouraudDepth<Rgb565Be>>>(shot),
        KeepsDepth::Deferred => draw_tested::<Deferred<GouraudDepth<Rgb565Be>>>(shot),
    }
}

/// The bytes of a shot in scan-out order, with depth tested on every line.
fn draw_tested<P: Pipeline<Pixel = Rgb565Be>>(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    let by_depth = |scene: &Scene<'_, P>, pump: &mut Display, background| {
        let mut rooms = LineRooms::<P>::new(64, OBJECTS, WIDTH.into());
        let mut renderer = rooms.renderer();
        renderer.set_depth_use(DepthUse::Always);
        draw_frame(scene, &mut renderer, pump, background, LINES)?;
        Ok(())
    };
    Ok(shown::<P, _>(shot, |scene| build(shot, scene), by_depth)?.0)
}

/// A scene of the suite as a picture, and what its frame had.
///
/// # Errors
/// As [`picture`].
pub fn picture_suite(suite: Suite) -> Result<(Frame, FrameStats), Box<dyn Error>> {
    let (bytes, stats) = counted_suite(suite)?;
    Ok((framed(&bytes)?, stats))
}

fn counted_suite(suite: Suite) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>> {
    drawn_suite::<Counted<GouraudDepth<Rgb565Be>>, Counted<LookB>, Counted<LookF>>(suite)
}

/// The bytes of a scene of the suite in scan-out order, and what the frame had: by `P`, or where it
/// has a texture by `B` or `F`, whichever takes it.
fn drawn_suite<P, B, F>(suite: Suite) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb565Be>,
    B: Pipeline<
            Pixel = Rgb565Be,
            Shading = Textured<Gouraud>,
            Textures = <LookB as Pipeline>::Textures,
        >,
    F: Pipeline<
            Pixel = Rgb565Be,
            Shading = Textured<Gouraud>,
            Textures = <LookF as Pipeline>::Textures,
        >,
{
    match suite {
        Suite::B | Suite::BUnlit => textured_suite::<B>(suite, Textures(&TEXTURES_B)),
        Suite::F => textured_suite::<F>(suite, Textures(&TEXTURES_F)),
        _ => {
            let build = |scene: &mut Scene<'_, P>| {
                suite
                    .build(scene)
                    .map_err(|error| format!("{}: {error:?}", suite.name()))?;
                Ok(())
            };
            shown_over::<P, _>(suite.background(), build, by_lines)
        }
    }
}

fn textured_suite<P>(
    suite: Suite,
    textures: P::Textures,
) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb565Be, Shading = Textured<Gouraud>>,
{
    let build = |scene: &mut Scene<'_, P>| {
        scene.set_textures(textures);
        suite
            .build_textured(Quality::Balanced, scene)
            .map_err(|error| format!("{}: {error:?}", suite.name()))?;
        Ok(())
    };
    shown_over::<P, _>(suite.background(), build, by_lines)
}

/// The bytes of scene B in scan-out order, and what the frame had.
///
/// # Errors
/// When it does not fit the arenas that it asks for.
pub fn drawn_b<P>(how: SceneB) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<
            Pixel = Rgb565Be,
            Shading = Textured<Gouraud>,
            Textures = <LookB as Pipeline>::Textures,
        >,
{
    textured_b::<P>(how, Textures(&TEXTURES_B))
}

/// Scene B with these textures, as [`drawn_b`] has it.
///
/// # Errors
/// When it does not fit the arenas that it asks for.
pub fn textured_b<P>(
    how: SceneB,
    textures: P::Textures,
) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb565Be, Shading = Textured<Gouraud>>,
{
    let build = |scene: &mut Scene<'_, P>| {
        scene.set_textures(textures);
        how.build(scene)
            .map_err(|error| format!("{}: {error:?}", how.name))?;
        Ok(())
    };
    shown::<P, _>(Shot::Sphere, build, by_lines)
}

/// Scene B from a texture in rows, as it has to be from one in blocks, whatever its cache.
fn draw_rows_b(how: SceneB) -> Result<Vec<u8>, Box<dyn Error>> {
    type Rows<'t> = TexturedDepth<'t, Rgb565Be, Texture<Words<'t, u16>, Wrap>>;
    let size = TextureSize::new(TEXEL_SIDE, TEXEL_SIDE)?;
    let rows = [Texture::<_, Wrap>::new(Words(&TEXELS_PANEL[..]), size)?];
    Ok(textured_b::<Rows<'_>>(how, Textures(&rows))?.0)
}

/// Draws all lines with one renderer.
fn by_lines<P: Pipeline<Pixel = Rgb565Be>>(
    scene: &Scene<'_, P>,
    pump: &mut Display,
    background: u16,
) -> Result<FrameStats, Box<dyn Error>> {
    let mut rooms = LineRooms::<P>::new(64, OBJECTS, WIDTH.into());
    Ok(draw_frame(
        scene,
        &mut rooms.renderer(),
        pump,
        background,
        LINES,
    )?)
}

/// The bytes of a shot as the hardware model draws it.
fn draw_by_model(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    type Smooth = GouraudDepth<Rgb565Be>;
    let mut lines = ModelLines::new(WIDTH);
    let mut renderer = lines.renderer();
    let (bytes, _) = shown::<Smooth, _>(
        shot,
        |scene| build(shot, scene),
        |scene, pump, background| {
            draw_model_frame(scene, &mut renderer, pump, background, LINES)
                .map_err(|error| format!("{error:?}"))?;
            Ok(())
        },
    )?;
    Ok(bytes)
}

/// Draws a shot into a scene.
fn build<P: Pipeline>(shot: Shot, scene: &mut Scene<'_, P>) -> Result<(), Box<dyn Error>> {
    shot.build(scene)
        .map_err(|error| format!("{}: {error:?}", shot.name()))?;
    Ok(())
}

/// The baked list, as the firmware runs it from flash.
fn build_list(scene: &mut Scene<'_, GouraudDepth<Rgb565Be>>) -> Result<(), Box<dyn Error>> {
    let (mut normals, mut indices) = ([[0; 3]; LIST_TABLE], [0; LIST_INDICES]);
    let memory = ListMemory {
        normals: &mut normals,
        indices: &mut indices,
        ..ListMemory::default()
    };
    build_listed(scene, memory).map_err(|error| format!("teapot.list: {error:?}"))?;
    Ok(())
}

/// The baked crate, as the firmware runs it from flash.
fn build_crate_list<'t>(
    scene: &mut Scene<'_, ListedDepth<'t, Rgb565Be>>,
    slots: &'t [TextureSlot],
) -> Result<(), Box<dyn Error>> {
    let (mut positions, mut normals) = ([[0; 3]; CRATE_TABLE], [[0; 3]; CRATE_TABLE]);
    let (mut places, mut indices) = ([[0; 2]; CRATE_TABLE], [0; CRATE_INDICES]);
    let memory = ListMemory {
        positions: &mut positions,
        normals: &mut normals,
        indices: &mut indices,
        places: &mut places,
        ..ListMemory::default()
    };
    build_crate(scene, memory, slots).map_err(|error| format!("crate.list: {error:?}"))?;
    Ok(())
}

type Display = Pump<MockFrameBuffer<u16>>;

/// What arrives at the display when `draw` draws what `build` has built, over a shot's background, and
/// what `draw` gave.
fn shown<P: Pipeline<Pixel = Rgb565Be>, T>(
    shot: Shot,
    build: impl FnOnce(&mut Scene<'_, P>) -> Result<(), Box<dyn Error>>,
    draw: impl FnOnce(&Scene<'_, P>, &mut Display, u16) -> Result<T, Box<dyn Error>>,
) -> Result<(Vec<u8>, T), Box<dyn Error>> {
    shown_over(shot.background(), build, draw)
}

/// As [`shown`], over a background of 8-bit levels.
fn shown_over<P: Pipeline<Pixel = Rgb565Be>, T>(
    background: [u8; 3],
    build: impl FnOnce(&mut Scene<'_, P>) -> Result<(), Box<dyn Error>>,
    draw: impl FnOnce(&Scene<'_, P>, &mut Display, u16) -> Result<T, Box<dyn Error>>,
) -> Result<(Vec<u8>, T), Box<dyn Error>> {
    let mut lent = SceneRooms::<P>::new(VERTICES, OBJECTS, HEIGHT.into());
    let mut scene = lent.scene(Shot::screen());
    build(&mut scene)?;
    let words = usize::from(WIDTH) * usize::from(LINES);
    let sink = MockFrameBuffer::new(WIDTH, HEIGHT).late_by(1);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = Rgb565Be::from_rgb8(background);
    let drawn = draw(&scene, &mut pump, background)?;
    let words = pump.sink().frame()?;
    let bytes = words.into_iter().flat_map(u16::to_ne_bytes).collect();
    Ok((bytes, drawn))
}

/// A board's frames beside the host's.
struct Compared {
    measured: Measured,
    /// Name, host's checksum, target's checksum, instructions.
    frames: Vec<(String, u32, u32, u64)>,
    /// What the frames of the shots have.
    counts: BTreeMap<&'static str, FrameStats>,
    /// What `--bench` measures.
    bench: Option<Bench>,
}

impl Compared {
    fn new(measured: Measured, host: &BTreeMap<&str, u32>) -> Result<Self, Box<dyn Error>> {
        let name = measured.board.name;
        let mut frames = Vec::new();
        for frame in &measured.output.frames {
            let host = host
                .get(frame.scene.as_str())
                .ok_or_else(|| format!("{name}: the host has no frame `{}`", frame.scene))?;
            frames.push((frame.scene.clone(), *host, frame.crc, frame.instructions));
        }
        if frames.len() != host.len() {
            return Err(format!("{name}: drew {} frames of {}", frames.len(), host.len()).into());
        }
        Ok(Self {
            measured,
            frames,
            counts: host_counts()?,
            bench: None,
        })
    }

    fn matches(&self) -> bool {
        self.frames
            .iter()
            .all(|(_, host, target, _)| host == target)
    }

    fn to_json(&self) -> Value {
        let sections = &self.measured.sections;
        let frames: Vec<Value> = self
            .frames
            .iter()
            .map(|(scene, host, target, instructions)| {
                let stats = self.counts.get(scene.as_str());
                let each = |of: fn(&FrameStats) -> u32| {
                    stats.map(|stats| *instructions as f64 / f64::from(of(stats).max(1)))
                };
                json!({
                    "per_pixel": each(|stats| stats.spans.pixels_shaded),
                    "per_span": each(|stats| stats.spans.spans),
                    "per_triangle": each(|stats| stats.pass_one.triangles),
                    "scene": scene,
                    "crc_host": format!("{host:08x}"),
                    "crc_target": format!("{target:08x}"),
                    "match": host == target,
                    "instructions": instructions,
                })
            })
            .collect();
        let mut report = json!({
            "board": self.measured.board.name,
            "target": self.measured.board.target,
            "machine": self.measured.board.machine,
            "text_bytes": sections.text_bytes(),
            "ram_bytes": sections.ram_bytes(),
            "fast_bytes": sections.fast.bytes,
            "line_bytes": sections.dma.bytes,
            "slow_bytes": sections.slow_bytes(),
            "stack_bytes": self.measured.output.figures.get("stack_bytes"),
            "list": self.list(),
            "frames": frames,
        });
        if let Some(bench) = &self.bench {
            bench.add_to(&mut report);
        }
        report
    }

    /// What pass one of the baked teapot costs, beside the same tables by immediate calls.
    fn list(&self) -> Value {
        let figure = |name: &str| {
            let figures = &self.measured.output.figures;
            figures.get(name).copied().unwrap_or_default()
        };
        let (listed, called) = (figure("list_pass_one"), figure("calls_pass_one"));
        let vertices = figure("list_vertices");
        json!({
            "pass_one": listed,
            "pass_one_by_calls": called,
            "vertices": vertices,
            "more_per_vertex": (listed as f64 - called as f64) / vertices.max(1) as f64,
        })
    }

    fn print(&self) {
        let (board, sections) = (&self.measured.board, &self.measured.sections);
        say!(
            "{} ({}, {}): code {} bytes, fast RAM {}, line buffers {}, slow RAM {}",
            board.name,
            board.target,
            board.machine,
            sections.text_bytes(),
            sections.fast.bytes,
            sections.dma.bytes,
            sections.slow_bytes()
        );
        say!(
            "  pass one of the teapot, from a list and drawn at once: {}",
            self.list()
        );
        for (scene, host, target, instructions) in &self.frames {
            let verdict = if host == target {
                "same bits"
            } else {
                "DIFFERS"
            };
            say!("  {scene:15} {host:08x} {target:08x} {verdict}  {instructions:>10} instructions");
        }
        if let Some(bench) = &self.bench {
            bench.print();
        }
    }
}
