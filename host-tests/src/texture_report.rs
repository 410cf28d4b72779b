//! Texture memory and depth formats, counted: blocks against rows, and how far depth tells apart.
//!
//! | figure | rows |
//! |---|---|
//! | page changes and texel re-reads of a texture in blocks and in rows | B1, B5 |
//! | page changes of triangles in a frame buffer of blocks, by strips and by lines | B1, B6 |
//! | the bits of distance that a depth format tells apart | H2 |
//!
//! Access is modelled, not timed: a page (1 KB, as of a DRAM) changes when an access is to another
//! one than the access before; a small cache holds lines of 32 bytes.

use crate::image_out::{ImageError, write_atomically, write_image};
use crate::plot::{Chart, Marks, Series};
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use scanbeam::scene::{BlockCache, Blocked, CacheWord, Texels, Texture};
use scanbeam_model::{BlockFix16, Cluster, Grid, Traversal};
use std::collections::BTreeSet;
use std::path::Path;

/// Bytes of a page.
pub const PAGE: usize = 1024;
/// Bytes of a line of the cache.
pub const LINE: usize = 32;
/// Lines of the cache: 1 KB.
const LINES: usize = 32;
/// Texels a side, 16 bits each.
const SIDE: u32 = 256;
const TEXEL: usize = 2;
const WIDTH: usize = 320;
const HEIGHT: usize = 240;

/// What is looked at: the texel at each pixel that shows the texture, in the order of scanning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// A sphere that fills the picture's height, by latitude and longitude.
    Sphere,
    /// A plane that goes to the horizon, seen at a grazing angle.
    Ground,
    /// A square of one texel a pixel, turned by 90 degrees.
    Quarter,
    /// The same, turned by 30 degrees.
    Turned,
    /// The same, upright: what rows are best at.
    Upright,
}

/// All of them, with names.
pub const VIEWS: [(&str, View); 5] = [
    ("sphere", View::Sphere),
    ("ground plane", View::Ground),
    ("quad, 90 degrees", View::Quarter),
    ("quad, 30 degrees", View::Turned),
    ("quad, upright", View::Upright),
];

impl View {
    /// The columns and rows of the texels of all pixels in order, each line from the left.
    fn texels(self) -> Vec<[u16; 2]> {
        match self {
            Self::Sphere => sphere(),
            Self::Ground => (0..HEIGHT / 2).flat_map(ground).collect(),
            Self::Quarter => quad(90.0),
            Self::Turned => quad(30.0),
            Self::Upright => quad(0.0),
        }
    }
}

/// The texel that holds a place, of a texture that repeats.
fn texel(u: f64, v: f64) -> [u16; 2] {
    [u, v].map(|place| place.floor().rem_euclid(f64::from(SIDE)) as u16)
}

fn sphere() -> Vec<[u16; 2]> {
    let mut texels = Vec::new();
    let radius = HEIGHT as f64 / 2.0;
    for line in 0..HEIGHT {
        for column in 0..WIDTH {
            let x = (column as f64 + 0.5 - WIDTH as f64 / 2.0) / radius;
            let y = (line as f64 + 0.5 - radius) / radius;
            let z2 = 1.0 - x * x - y * y;
            if z2 > 0.0 {
                let turn = std::f64::consts::PI;
                let longitude = x.atan2(z2.sqrt()) / turn;
                let latitude = y.asin() / turn;
                // Tilted, so that neither runs along the lines.
                let (u, v) = (longitude + 0.4 * latitude, latitude - 0.4 * longitude);
                texels.push(texel(u * f64::from(SIDE), v * f64::from(SIDE)));
            }
        }
    }
    texels
}

/// A line of a plane, from the horizon down, turned by some 30 degrees against the picture.
fn ground(line: usize) -> Vec<[u16; 2]> {
    let q = (line as f64 + 1.0) / (HEIGHT as f64 / 2.0);
    // Far away a line shows 1024 texels at most.
    let wide = (150.0 / q).min(1000.0);
    let step = [wide * 0.87, wide * 0.5].map(|way| way / WIDTH as f64);
    let first = [0.5, 0.87].map(|part| part * 300.0 / (q + 0.3));
    (0..WIDTH)
        .map(|column| {
            let [u, v] = [0, 1].map(|axis| first[axis] + column as f64 * step[axis]);
            texel(u, v)
        })
        .collect()
}

/// A square of the texture's size about the middle of the picture, turned by so many degrees.
fn quad(degrees: f64) -> Vec<[u16; 2]> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let mut texels = Vec::new();
    for line in 0..HEIGHT {
        for column in 0..WIDTH {
            let x = column as f64 + 0.5 - WIDTH as f64 / 2.0;
            let y = line as f64 + 0.5 - HEIGHT as f64 / 2.0;
            let half = f64::from(SIDE) / 2.0;
            let (u, v) = (x * cos - y * sin + half, x * sin + y * cos + half);
            if (0.0..2.0 * half).contains(&u) && (0.0..2.0 * half).contains(&v) {
                texels.push(texel(u, v));
            }
        }
    }
    texels
}

/// What a layout costs in a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Texels that were asked for.
    pub fetches: usize,
    /// Accesses to another page than the one before, without a cache.
    pub page_changes: usize,
    /// Lines of the cache that were filled from slow memory.
    pub fills: usize,
    /// Texels read from slow memory that had been read before.
    pub re_reads: usize,
}

/// Counts a view's accesses: pages and lines of the cache lie as layouts say; the pages of rows are what rows are.
fn count(view: View, pages: Option<Blocked>, lines: Blocked) -> Access {
    let rows: Vec<u32> = (0..SIDE * SIDE).collect();
    // Where each texel of the rows lies.
    let mut page_of = rows.clone();
    if let Some(pages) = pages {
        let mut blocks = rows.clone();
        let arranged = pages.arrange([SIDE, SIDE], &rows, &mut blocks);
        arranged.expect("it has its texels");
        for (at, texel) in (0..).zip(blocks) {
            page_of[texel as usize] = at;
        }
    }
    let words = vec![0; rows.len()];
    let slow = Texture::words(&words, SIDE, SIDE).expect("it has its texels");
    let per_line = LINE / TEXEL;
    let mut fast: Vec<_> = (0..LINES * per_line).map(|_| CacheWord::new()).collect();
    let cache = BlockCache::new(slow, lines, &mut fast).expect("it is as large as it says");
    let (mut changes, mut page, mut touched) = (0, usize::MAX, BTreeSet::new());
    let texels = view.texels();
    for &[column, row] in &texels {
        let at = page_of[usize::from(row) * SIDE as usize + usize::from(column)];
        let now = at as usize * TEXEL / PAGE;
        changes += usize::from(now != page);
        page = now;
        let of = |at: u16, side: u32| u32::from(at) / side;
        touched.insert([of(column, lines.width()), of(row, lines.height())]);
        let _: u16 = cache.texel(column, row);
    }
    let fills = cache.reads().misses as usize;
    Access {
        fetches: texels.len(),
        page_changes: changes,
        fills,
        re_reads: (fills - touched.len()) * per_line,
    }
}

/// A view in rows and in blocks.
#[must_use]
pub fn compare(view: View) -> [Access; 2] {
    // A line of the cache is a part of a row.
    let part = Blocked::new((LINE / TEXEL).ilog2(), 0).expect("it is short");
    [
        count(view, None, part),
        count(
            view,
            Some(Blocked::of_page(PAGE, 8 * TEXEL)),
            Blocked::of_page(LINE, 8 * TEXEL),
        ),
    ]
}

/// All views as a table.
#[must_use]
pub fn texture_table() -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED);
    table.set_header([
        "view",
        "layout",
        "texels",
        "page changes",
        "cache fills",
        "texels re-read",
    ]);
    for (name, view) in VIEWS {
        for (layout, access) in ["rows", "blocks"].into_iter().zip(compare(view)) {
            table.add_row([
                name.to_owned(),
                layout.to_owned(),
                access.fetches.to_string(),
                access.page_changes.to_string(),
                access.fills.to_string(),
                access.re_reads.to_string(),
            ]);
        }
    }
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// A frame buffer in blocks, each a page; it refuses a pixel that is written twice.
#[derive(Debug)]
pub struct BlockFrame {
    /// Pixels of a block, to the right and down.
    block: (i32, i32),
    width: i32,
    written: Vec<bool>,
    page: Option<(i32, i32)>,
    /// How often the page changed.
    pub page_changes: u32,
}

impl BlockFrame {
    /// An empty one of so many pixels, in blocks.
    #[must_use]
    pub fn new((width, height): (u32, u32), block: (i32, i32)) -> Self {
        Self {
            block,
            width: width as i32,
            written: vec![false; (width * height) as usize],
            page: None,
            page_changes: 0,
        }
    }

    /// Writes a pixel.
    ///
    /// # Panics
    /// When it was written before, or lies outside.
    pub fn write(&mut self, (column, line): (i32, i32)) {
        let at = (line * self.width + column) as usize;
        assert!(
            !std::mem::replace(&mut self.written[at], true),
            "({column}, {line}) is written twice"
        );
        let page = (
            column.div_euclid(self.block.0),
            line.div_euclid(self.block.1),
        );
        self.page_changes += u32::from(self.page != Some(page));
        self.page = Some(page);
    }

    /// Which pixels have been written, row by row.
    #[must_use]
    pub fn written(&self) -> &[bool] {
        &self.written
    }
}

/// Page changes of one triangle: in strips into blocks, line by line into blocks, line by line
/// into rows. A page has as many pixels in all three.
#[must_use]
pub fn triangle_pages(corners: [(u16, u16); 3], size: (u32, u32), block: (i32, i32)) -> [u32; 3] {
    let grid = Grid::new((4, 2), block.0 as u16).expect("blocks have whole clusters");
    let mut by_strips = BlockFrame::new(size, block);
    for pixel in Traversal::new(corners, grid).flat_map(Cluster::pixels) {
        by_strips.write(pixel);
    }
    // The same pixels in the order of lines.
    let mut by_lines = BlockFrame::new(size, block);
    let mut in_rows = BlockFrame::new(size, (block.0 * block.1, 1));
    let width = size.0 as usize;
    for (at, written) in by_strips.written().iter().enumerate() {
        if *written {
            let pixel = ((at % width) as i32, (at / width) as i32);
            by_lines.write(pixel);
            in_rows.write(pixel);
        }
    }
    [by_strips, by_lines, in_rows].map(|frame| frame.page_changes)
}

/// Writes `depth-resolution`, `texture-pages` and `texture-reads` into a folder, as SVG and PNG.
///
/// # Errors
/// When a file cannot be written.
pub fn write_plots(folder: &Path) -> Result<(), ImageError> {
    for (name, plot) in [
        ("depth-resolution", depth_resolution()),
        ("texture-pages", texture_pages()),
        ("texture-reads", texture_reads()),
    ] {
        let file = |extension: &str| folder.join(format!("{name}.{extension}"));
        write_atomically(&file("svg"), plot.to_svg().as_bytes())?;
        write_image(&file("png"), &plot.to_frame())?;
    }
    Ok(())
}

/// Page changes of each view, texels in rows and in blocks (B1, B5).
#[must_use]
pub fn texture_pages() -> Chart {
    views(
        "Page changes (1 KB) of a frame, a texture of 256 x 256 x 16 bits",
        "page changes",
        |access| access.page_changes,
    )
}

/// Texels of each view that a cache of 1 KB read from slow memory again, in rows and in blocks.
#[must_use]
pub fn texture_reads() -> Chart {
    views(
        "Texels read again, a cache of 32 lines of 32 bytes",
        "texels re-read",
        |access| access.re_reads,
    )
}

/// A count of all views, in rows and in blocks.
fn views(title: &str, y_name: &str, of: impl Fn(&Access) -> usize) -> Chart {
    let counts = VIEWS.map(|(_, view)| compare(view).map(|access| of(&access) as f64));
    let series = |name: &str, layout: usize| Series {
        name: name.to_owned(),
        values: counts.iter().map(|count| count[layout]).collect(),
    };
    Chart {
        title: title.into(),
        x: VIEWS.map(|(name, _)| name.to_owned()).into(),
        x_name: "what is seen, 320 x 240".into(),
        y_name: y_name.into(),
        series: vec![series("linear: rows", 0), series("blocked", 1)],
        marks: Marks::Bars,
    }
}

/// Bits of distance that depth formats tell apart: `-log2` of the smallest relative difference,
/// at distances from 1 (the near plane) to 2^12.
#[must_use]
pub fn depth_resolution() -> Chart {
    const STEPS: u32 = 4;
    let distances: Vec<f64> = (0..=12 * STEPS)
        .map(|i| 2f64.powf(f64::from(i) / f64::from(STEPS)) * 1.01)
        .collect();
    let depth = |w: f64| (2f64.powi(31) / w) as u32;
    const FARTHEST: f64 = 4096.0;
    // A step of 1/w by `step` is one of w by `step w²`.
    let bits = |w: f64, step: f64| (-(step * w).log2()).max(0.0);
    let series = |name: &str, step: &dyn Fn(f64) -> f64| Series {
        name: name.to_owned(),
        values: distances.iter().map(|w| bits(*w, step(*w))).collect(),
    };
    Chart {
        title: "Distance told apart by depth formats, near plane at 1".into(),
        x: (0..=12 * STEPS)
            .map(|i| match i % STEPS {
                0 => format!("{}", 1u32 << (i / STEPS)),
                _ => String::new(),
            })
            .collect(),
        x_name: "distance w".into(),
        y_name: "bits".into(),
        series: vec![
            series("block-fix 16", &|w| {
                // To the next code of the same range.
                let range = BlockFix16::range_of(depth(w));
                let code = BlockFix16::new(depth(w), range);
                let next = BlockFix16::from_bits(code.to_bits() ^ 1);
                f64::from(code.to_depth().abs_diff(next.to_depth())) / 2f64.powi(31)
            }),
            series("16-bit fixed 1/w", &|_| 2f64.powi(-16)),
            series("32-bit 1/w", &|_| 2f64.powi(-31)),
            // Even steps of w from the near plane to the far one.
            series("32-bit linear", &|w| {
                (FARTHEST - 1.0) * 2f64.powi(-32) / (w * w)
            }),
        ],
        marks: Marks::Lines,
    }
}
