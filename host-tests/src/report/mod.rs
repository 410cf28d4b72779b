//! `report`: one page with the pictures, their errors, and what they cost (M1, M2, C8).
//!
//! All on it is drawn and measured when it is made, except the instruction counts of whole
//! frames: those are the recorded ones that `firmware --bench` is held against.

pub mod effects;
pub mod paced;
pub mod page;
pub mod scene_files;

use crate::args::{PixelFormatArg, ReportArgs};
use crate::bench::OnBoard;
use crate::draw::{CrewSettings, Drawn, draw, draw_model};
use crate::figures::gate::Record;
use crate::figures::suite;
use crate::firmware::BOARDS;
use crate::frames::{picture, picture_b, picture_suite};
use crate::image_out::{Frame, make_folder, write_atomically};
use crate::model::{Model, obj_text};
use crate::reference::{Cull, Reference, Shade, View, compare, render};
use crate::{accuracy, bench, cache_report};
use page::Page;
use scanbeam::Link;
use scanbeam::frame::FastMemory;
use scanbeam::look::{Gouraud, Look, Phong, Textured, TexturedPhong};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{Object, TexturePlace, Vertex};
use scenes::{HEIGHT, SCENES_B, SHOTS, STACKS, SUITE, Shot, WIDTH};
use std::error::Error;
use std::path::Path;

/// Levels of the heat map for one level of error.
const HEAT: f64 = 64.0;

/// Makes the page.
///
/// # Errors
/// When the folder or the page cannot be written, or a peer cannot be built.
pub fn run(args: &ReportArgs) -> Result<(), Box<dyn Error>> {
    let folder = &args.output;
    let mut page = Page::new("scanbeam");
    shots(&mut page)?;
    errors(&mut page)?;
    effects::effects(&mut page)?;
    scene_files::scene_files(&mut page)?;
    paced::paced(&mut page)?;
    accuracy_plots(&mut page)?;
    cache(&mut page)?;
    costs(&mut page)?;
    if args.peers {
        peers(&mut page)?;
    }
    memory(&mut page);
    make_folder(folder)?;
    let file = folder.join("index.html");
    write_atomically(&file, page.finish().as_bytes())?;
    say!("{}", file.display());
    Ok(())
}

/// The frames that host and firmware draw alike.
pub fn shots(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("shots", "Frames");
    page.paragraph(
        "320 by 240 pixels of RGB565. The firmware draws the same frames with the same bits.",
    );
    let shots = SHOTS.into_iter().chain([Shot::Crowd]).chain(STACKS);
    let shots = shots.map(|shot| (shot.name(), picture(shot)));
    let textured = SCENES_B
        .into_iter()
        .map(|scene| (scene.name, picture_b(scene)));
    let suite = SUITE
        .into_iter()
        .filter(|suite| {
            !SHOTS
                .iter()
                .chain(&STACKS)
                .any(|shot| shot.name() == suite.name())
        })
        .map(|suite| (suite.name(), picture_suite(suite)));
    for (name, drawn) in shots.chain(textured).chain(suite) {
        let (frame, stats) = drawn?;
        let caption = format!(
            "{name}: {} triangles, {} filed, {} spans, {} pixels written",
            stats.pass_one.triangles, stats.objects, stats.spans.spans, stats.spans.pixels_shaded
        );
        page.pictures(&[&frame], &caption)?;
    }
    Ok(())
}

/// What a picture of the section on errors is drawn by.
type Draws = fn(&Model, &View) -> Result<Drawn, Box<dyn Error>>;

fn draws_888(model: &Model, view: &View) -> Result<Drawn, Box<dyn Error>> {
    let crew = CrewSettings::default();
    Ok(draw(model, view, PixelFormatArg::Rgb888, crew)?)
}

fn draws_565(model: &Model, view: &View) -> Result<Drawn, Box<dyn Error>> {
    let crew = CrewSettings::default();
    Ok(draw(model, view, PixelFormatArg::Rgb565, crew)?)
}

fn draws_model(model: &Model, view: &View) -> Result<Drawn, Box<dyn Error>> {
    Ok(draw_model(model, view, PixelFormatArg::Rgb888)?)
}

/// Pictures beside their distance from the reference.
pub fn errors(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("errors", "Errors against f64");
    page.paragraph(
        "Left the picture, right the distance of its worst channel from the reference, 64 shades \
         a level. Blue are pixels on which a corner that is rounded to 1/8 pixel may change what is seen: \
         they are held by the colours around them.",
    );
    let text = |mesh| obj_text(mesh).ok_or("a mesh of triangles");
    let file = Path::new("made here.obj");
    let teapot = Model::from_obj_text(&text(&scenes::TEAPOT)?, file)?;
    let cube = Model::from_obj_text(&text(&scenes::CUBE)?, file)?;
    let view = |shade| View {
        eye: [0.0, 1.2, 2.6],
        light: [0.3, 0.8, 0.6],
        shade,
        cull: Cull::Back,
        background: [24, 32, 48],
        ..View::default()
    };
    let pictures: [(&str, &Model, Shade, Draws); 6] = [
        (
            "teapot, gouraud, RGB888",
            &teapot,
            Shade::Gouraud,
            draws_888,
        ),
        (
            "teapot, gouraud, RGB565",
            &teapot,
            Shade::Gouraud,
            draws_565,
        ),
        ("teapot, flat, RGB888", &teapot, Shade::Flat, draws_888),
        (
            "teapot, the hardware model",
            &teapot,
            Shade::Gouraud,
            draws_model,
        ),
        (
            "cube, vertex colours, RGB888",
            &cube,
            Shade::None,
            draws_888,
        ),
        ("cube, gouraud, RGB565", &cube, Shade::Gouraud, draws_565),
    ];
    for (name, model, shade, draws) in pictures {
        let view = view(shade);
        let drawn = draws(model, &view)?;
        let reference = render(model, &view)?;
        let compared = compare(&reference, view.background, &drawn.frame)?;
        let caption = format!(
            "{name}: at most {:.2} levels off, {:.3} in the mean, on {} pixels",
            compared.max_error_levels, compared.mean_error_levels, compared.compared_pixels
        );
        let heat = heat(&reference, &drawn.frame).ok_or("a frame without pixels")?;
        page.pictures(&[&drawn.frame, &heat], &caption)?;
    }
    Ok(())
}

/// How far each pixel is from the reference: grey, or blue near edges.
fn heat(reference: &Reference, frame: &Frame) -> Option<Frame> {
    let pixels = frame.rgb().chunks_exact(3);
    let rgb = pixels
        .zip(&reference.colour)
        .zip(&reference.near_edge)
        .flat_map(|((drawn, levels), near_edge)| {
            let off = drawn
                .iter()
                .zip(levels)
                .fold(0.0f64, |most, (d, l)| most.max((f64::from(*d) - l).abs()));
            let shade = (off * HEAT).min(255.0) as u8;
            if *near_edge { [0, 0, 96] } else { [shade; 3] }
        });
    Frame::new(frame.width(), frame.height(), rgb.collect())
}

fn accuracy_plots(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("accuracy", "Error against cost");
    let (plots, note) = accuracy::plots()?;
    page.paragraph(note.as_deref().unwrap_or(
        "Instructions a pixel on a Cortex-M4 against the largest error; methods on the frontier \
         are ringed and joined.",
    ));
    for plot in plots {
        page.plot(&plot.to_svg());
    }
    Ok(())
}

/// The plots of the cache.
pub fn cache(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("cache", "Object cache");
    page.paragraph(
        "Slow bytes a frame and modelled times against slots of the cache; the picture is the same.",
    );
    for chart in cache_report::charts()? {
        page.plot(&chart.to_svg());
    }
    Ok(())
}

/// The recorded instructions of whole frames.
fn costs(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("costs", "Instructions a frame");
    page.paragraph(
        "Counted in QEMU, from model space to RGB565, as recorded for the latest compiler.",
    );
    let record = Record::read(&Record::path())?;
    let mut rows = vec![vec!["board".to_owned()]];
    let frames = ["sphere", "teapot", "cube", "c_f2n", "c_n2f"];
    rows[0].extend(frames.map(str::to_owned));
    for board in record.boards() {
        let mut row = vec![board.clone()];
        row.extend(frames.map(|frame| {
            let figure = record.latest(&board, &format!("frame {frame}"));
            figure.map_or_else(|| "-".to_owned(), |count| format!("{count:.0}"))
        }));
        rows.push(row);
    }
    page.table(&rows);
    suite_table(page, &record);
    Ok(())
}

/// The suite on every board, beside the best of others.
fn suite_table(page: &mut Page, record: &Record) {
    page.paragraph(
        "The suite with 64 slots and a line a transfer, in million instructions: ours, and the best \
         other renderer (TGX, TinyGL or small3dlib).",
    );
    let mut rows = suite::rows(record);
    for cell in rows.iter_mut().flatten() {
        *cell = cell.replace("**", "");
    }
    page.table(&rows);
}

fn peers(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("peers", "Beside other renderers");
    page.paragraph("On this machine, the same scenes; ratios to scanbeam, which draws RGB565.");
    let head = [
        "scene",
        "renderer",
        "instructions a frame",
        "ratio",
        "ratio of time",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let measured = bench::rows(true)?;
    for row in &measured {
        let some = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "-".to_owned(), |v| format!("{v:.digits$}"))
        };
        rows.push(vec![
            row.scene.to_owned(),
            row.renderer.to_owned(),
            some(row.instructions, 0),
            some(row.instructions_ratio, 2),
            format!("{:.2}", row.ratio),
        ]);
    }
    page.table(&rows);
    page.paragraph(
        "On Cortex-M in QEMU, million instructions a frame, each with its ratio to scanbeam.",
    );
    let mut rows = vec![vec!["scene".to_owned(), "renderer".to_owned()]];
    for board in BOARDS {
        rows[0].extend([board.name.to_owned(), format!("{}, ratio", board.name)]);
    }
    for row in &measured {
        let mut cells = vec![row.scene.to_owned(), row.renderer.to_owned()];
        cells.extend(row.boards.iter().flat_map(OnBoard::cells));
        rows.push(cells);
    }
    page.table(&rows);
    for reason in bench::missing(&measured) {
        page.paragraph(&format!("Not measured: {reason}."));
    }
    Ok(())
}

/// Bytes of the records of a look, and of fast RAM for a line of the shots with 64 slots.
fn sizes<L: Look>(name: &str) -> Vec<String> {
    let place = if L::TEXTURED {
        size_of::<TexturePlace>()
    } else {
        0
    };
    let cell = size_of::<u32>();
    let bytes = [
        size_of::<Vertex>() + place,
        size_of::<Object>() + size_of::<Link>(),
        FastMemory::<L>::SLOT_BYTES,
        cell,
        size_of::<FastMemory<L>>() + usize::from(WIDTH) * cell,
        2 * usize::from(WIDTH) * size_of::<<L::Pixel as PixelFormat>::Word>(),
    ];
    std::iter::once(name.to_owned())
        .chain(bytes.map(|bytes| bytes.to_string()))
        .collect()
}

/// What records of each look take.
pub fn memory(page: &mut Page) {
    page.section("memory", "Memory");
    page.paragraph(&format!(
        "Bytes of the records, and of fast RAM for a line of {WIDTH} pixels with 64 slots of cache; \
         a frame buffer of RGB565 would be {} bytes, and a z-buffer of 32 bits {} more.",
        usize::from(WIDTH) * usize::from(HEIGHT) * 2,
        usize::from(WIDTH) * usize::from(HEIGHT) * 4
    ));
    let head = [
        "look",
        "vertex (slow)",
        "triangle and link (slow)",
        "slot",
        "depth a pixel",
        "cache and depth line",
        "two line buffers",
    ];
    page.table(&[
        head.map(str::to_owned).to_vec(),
        sizes::<Gouraud<Rgb565Be>>("smooth"),
        sizes::<Textured<Rgb565Be>>("textured"),
        sizes::<Phong<Rgb565Be>>("light at pixels"),
        sizes::<TexturedPhong<Rgb565Be>>("textured, light at pixels"),
    ]);
}
