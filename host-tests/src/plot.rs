//! Line charts and scatter plots as SVG and as pixels, the same on every machine: no system fonts.
//!
//! Both are drawn by one routine through a canvas of lines and text; text in pixels is an 8 x 8
//! bitmap font.

use crate::image_out::Frame;
use font8x8::{BASIC_FONTS, UnicodeFonts};
use std::fmt::Write;

const WIDTH: i32 = 800;
const HEIGHT: i32 = 480;
/// Left, top, right, bottom of the plotted area.
const AREA: [i32; 4] = [70, 40, 780, 420];
/// Colours of the series, in order, told apart by people who do not see all colours.
const COLOURS: [[u8; 3]; 4] = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167]];
const INK: [u8; 3] = [40, 40, 40];
const GRID: [u8; 3] = [224, 224, 224];
/// From a point to its name, where that is not beside it.
const FAINT: [u8; 3] = [150, 150, 150];

/// Values at each of the chart's places.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// For the legend.
    pub name: String,
    /// One for each place; from 0 up.
    pub values: Vec<f64>,
}

/// A chart over places that stand at equal distances.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Above the chart.
    pub title: String,
    /// The names of the places.
    pub x: Vec<String>,
    /// Below the places.
    pub x_name: String,
    /// Above the scale.
    pub y_name: String,
    /// At most four are told apart.
    pub series: Vec<Series>,
    /// How values are shown.
    pub marks: Marks,
}

/// How the values of a chart are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Marks {
    /// Points, joined: places are in an order, and something lies between them.
    #[default]
    Lines,
    /// A bar each, side by side: places are things of their own.
    Bars,
}

/// A point of a scatter plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Dot {
    /// Written beside it.
    pub name: String,
    /// Which of [`Scatter::groups`] it is of.
    pub group: usize,
    /// From 0 up.
    pub x: f64,
    /// From 0 up.
    pub y: f64,
    /// Whether it is one of those that are ringed, and joined to the others of its group.
    pub marked: bool,
}

/// Points on two scales, both logarithmic.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// Above the plot.
    pub title: String,
    /// Below the scale of x.
    pub x_name: String,
    /// Above the scale of y.
    pub y_name: String,
    /// For the legend; at most four are told apart.
    pub groups: Vec<String>,
    /// The points.
    pub dots: Vec<Dot>,
}

/// A logarithmic scale: powers of two from `low` on, `count` doublings.
struct Doublings {
    low: i32,
    count: i32,
}

impl Doublings {
    /// One that holds the values and a margin. Below 2^-10 is all the same, also 0.
    fn holding(values: impl Iterator<Item = f64>) -> Self {
        let (mut low, mut high) = (i32::MAX, i32::MIN);
        for value in values {
            let at = value.clamp(LEAST, 1e12).log2();
            low = low.min(at.floor() as i32);
            high = high.max(at.ceil() as i32);
        }
        let (low, high) = if low > high {
            (0, 1)
        } else {
            (low, high.max(low + 1))
        };
        Self {
            low,
            count: high - low,
        }
    }

    /// Where a value is, from 0 to 1.
    fn part(&self, value: f64) -> f64 {
        (value.clamp(LEAST, 1e12).log2() - f64::from(self.low)) / f64::from(self.count)
    }

    /// Values of the grid.
    fn ticks(&self) -> impl Iterator<Item = f64> + use<> {
        let low = self.low;
        (0..=self.count).map(move |i| 2f64.powi(low + i))
    }
}

/// Where logarithmic scales end.
const LEAST: f64 = 1.0 / 1024.0;

impl Scatter {
    /// As a picture of 800 x 480 pixels.
    #[must_use]
    pub fn to_frame(&self) -> Frame {
        framed(|pixels| self.draw(pixels))
    }

    /// As SVG.
    #[must_use]
    pub fn to_svg(&self) -> String {
        svg(|svg| self.draw(svg))
    }

    fn draw(&self, canvas: &mut impl Canvas) {
        let [left, top, right, bottom] = AREA;
        let across = Doublings::holding(self.dots.iter().map(|dot| dot.x));
        let up = Doublings::holding(self.dots.iter().map(|dot| dot.y));
        let between = |a: i32, b: i32, part: f64| a + (f64::from(b - a) * part).round() as i32;
        let x = |value: f64| between(left + 10, right - 10, across.part(value));
        let y = |value: f64| between(bottom - 10, top + 10, up.part(value));
        let label = |value: f64| match value {
            v if v <= LEAST => "0".to_owned(),
            v if v < 0.1 => format!("{v:.3}"),
            v if v < 1.0 => format!("{v:.2}"),
            v => format!("{v}"),
        };
        for tick in up.ticks() {
            canvas.line((left, y(tick)), (right, y(tick)), GRID, 1);
            canvas.text((left - 6, y(tick) + 4), 2, &label(tick));
        }
        for tick in across.ticks() {
            canvas.line((x(tick), top), (x(tick), bottom), GRID, 1);
            canvas.text((x(tick), bottom + 18), 1, &label(tick));
        }
        canvas.line((left, top), (left, bottom), INK, 1);
        canvas.line((left, bottom), (right, bottom), INK, 1);
        canvas.text(((left + right) / 2, bottom + 40), 1, &self.x_name);
        canvas.text((left, top - 8), 0, &self.y_name);
        canvas.text((WIDTH / 2, 18), 1, &self.title);
        let mut stairs = Vec::new();
        for n in 0..self.groups.len() {
            let colour = COLOURS[n % COLOURS.len()];
            let mut marked: Vec<&Dot> = self
                .dots
                .iter()
                .filter(|d| d.group == n && d.marked)
                .collect();
            marked.sort_by(|a, b| a.x.total_cmp(&b.x));
            for pair in marked.windows(2) {
                // A staircase: between two methods there is none.
                let corner = (x(pair[1].x), y(pair[0].y));
                for end in pair {
                    let (ex, ey) = (x(end.x), y(end.y));
                    canvas.line((ex, ey), corner, colour, 1);
                    let (across, along) = ([ex, corner.0], [ey, corner.1]);
                    stairs.push(Room([
                        across[0].min(across[1]),
                        along[0].min(along[1]),
                        across[0].max(across[1]) + 1,
                        along[0].max(along[1]) + 1,
                    ]));
                }
            }
        }
        // Where names should not be: frames of points, names before, and, if there is room
        // elsewhere, the stairs.
        let mut taken: Vec<Room> = Vec::new();
        for dot in &self.dots {
            let (px, py) = (x(dot.x), y(dot.y));
            let half = if dot.marked { 8 } else { 4 };
            taken.push(Room([px - half, py - half, px + half, py + half]));
        }
        // One group alone is named by the title.
        if self.groups.len() > 1 {
            taken.push(self.legend(canvas, &taken, &stairs));
        }
        for dot in &self.dots {
            let colour = COLOURS[dot.group % COLOURS.len()];
            let (px, py) = (x(dot.x), y(dot.y));
            canvas.line((px - 3, py), (px + 3, py), colour, 6);
            if dot.marked {
                for (from, to) in [
                    ((-8, -8), (8, -8)),
                    ((8, -8), (8, 8)),
                    ((8, 8), (-8, 8)),
                    ((-8, 8), (-8, -8)),
                ] {
                    canvas.line(
                        (px + from.0, py + from.1),
                        (px + to.0, py + to.1),
                        colour,
                        1,
                    );
                }
            }
            let wide = 8 * dot.name.chars().count() as i32;
            let name = Room::beside((px, py), wide, &taken, &stairs);
            taken.push(name);
            let [l, t, r, b] = name.0;
            // Text is narrower in one of the canvases: it begins, or ends, beside the point.
            let (end, anchor) = if l > px { (l, 0) } else { (r, 2) };
            if py < t || py > b {
                canvas.line(
                    (px, py),
                    (end - (end - px).signum() * 3, (t + b) / 2),
                    FAINT,
                    1,
                );
            }
            canvas.text((end, b - 2), anchor, &dot.name);
        }
    }

    /// Names the groups at a side, in a corner or between two, where it keeps the clearest of what is
    /// there, and says where.
    fn legend(&self, canvas: &mut impl Canvas, taken: &[Room], stairs: &[Room]) -> Room {
        let [left, top, right, bottom] = AREA;
        let longest = self.groups.iter().map(|g| g.chars().count()).max();
        let wide = 8 * longest.unwrap_or(0) as i32 + 20;
        let high = 18 * self.groups.len() as i32 + 4;
        let (x, y) = (right - 4 - wide, bottom - 4 - high);
        let heights = [top + 4, y, (top + bottom - high) / 2];
        let places = [x, left + 4].into_iter();
        let places = places.flat_map(|x| heights.map(|y| Room([x, y, x + wide, y + high])));
        // A point takes the room of its name too, on either side.
        let meets = |room: &Room| {
            let points = taken.iter().zip(&self.dots).map(|(point, dot)| {
                let [l, t, r, b] = point.0;
                let name = 8 * dot.name.chars().count() as i32 + 8;
                Room([l - name, t, r + name, b])
            });
            points
                .chain(stairs.iter().copied())
                .filter(|one| room.meets(one))
                .count()
        };
        let room = places.min_by_key(meets).unwrap_or(Room([x, top, right, y]));
        for (n, group) in self.groups.iter().enumerate() {
            let colour = COLOURS[n % COLOURS.len()];
            let (x, at) = (room.0[0], room.0[1] + 14 + 18 * n as i32);
            canvas.line((x + 2, at - 4), (x + 10, at - 4), colour, 8);
            canvas.text((x + 18, at), 0, group);
        }
        room
    }
}

/// Left, top, right and bottom of a part of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Room([i32; 4]);

impl Room {
    fn meets(self, other: &Self) -> bool {
        let ([l, t, r, b], [ol, ot, or, ob]) = (self.0, other.0);
        l < or && ol < r && t < ob && ot < b
    }

    /// For a name so wide beside a point: on the nearest of the lines above and below, to the right
    /// or to the left, clear of what is taken and, where that can be, of lines.
    fn beside((x, y): (i32, i32), wide: i32, taken: &[Self], lines: &[Self]) -> Self {
        let [left, top, right, bottom] = AREA;
        let sides = [x + 12, x - 12 - wide];
        let places = (0..20).flat_map(|n| {
            // 0, 1 up, 1 down, 2 up, and so on.
            let down = (n + 1) / 2 * if n % 2 == 0 { 11 } else { -11 };
            sides.map(|at| Self([at, y + down - 6, at + wide, y + down + 6]))
        });
        let inside = places.filter(|place| {
            let [l, t, r, b] = place.0;
            l > left && r <= right && t >= top && b <= bottom
        });
        let free = inside.filter(|place| !taken.iter().any(|one| place.meets(one)));
        let free: Vec<Self> = free.collect();
        let clear = free
            .iter()
            .take(6)
            .find(|place| !lines.iter().any(|line| place.meets(line)));
        let none = Self([x + 12, y - 6, x + 12 + wide, y + 6]);
        clear.or(free.first()).copied().unwrap_or(none)
    }
}

/// What `draw` draws, as a picture.
fn framed(draw: impl FnOnce(&mut Pixels)) -> Frame {
    let mut pixels = Pixels(vec![[255; 3]; (WIDTH * HEIGHT) as usize]);
    draw(&mut pixels);
    let rgb = pixels.0.into_flattened();
    Frame::new(WIDTH as u32, HEIGHT as u32, rgb).expect("the size is right")
}

/// What `draw` draws, as SVG.
fn svg(draw: impl FnOnce(&mut Svg)) -> String {
    let mut svg = Svg(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n"
    ));
    draw(&mut svg);
    svg.0 + "</svg>\n"
}

trait Canvas {
    fn line(&mut self, from: (i32, i32), to: (i32, i32), colour: [u8; 3], width: i32);
    /// `anchor`: 0 left, 1 middle, 2 right; `at` is on the base line.
    fn text(&mut self, at: (i32, i32), anchor: i32, text: &str);
}

impl Chart {
    /// As a picture of 800 x 480 pixels.
    #[must_use]
    pub fn to_frame(&self) -> Frame {
        framed(|pixels| self.draw(pixels))
    }

    /// As SVG.
    #[must_use]
    pub fn to_svg(&self) -> String {
        svg(|svg| self.draw(svg))
    }

    fn draw(&self, canvas: &mut impl Canvas) {
        let [left, top, right, bottom] = AREA;
        let values = self.series.iter().flat_map(|s| &s.values);
        let largest = values.fold(0.0f64, |m, v| m.max(*v));
        let step = nice(largest / 8.0);
        let full = (largest / step).ceil().max(1.0) * step;
        // Room above for the legend, where a value at its places would go through it.
        let legend = f64::from(16 + 18 * self.series.len() as i32) / f64::from(bottom - top);
        let under = |values: &Vec<f64>| {
            let from = values.len() * 3 / 5;
            values[from..].iter().fold(0.0f64, |m, v| m.max(*v))
        };
        let under = self.series.iter().map(|s| under(&s.values));
        let under = under.fold(0.0, f64::max) / (1.0 - legend).max(0.2);
        let full = full.max((under / step).ceil() * step);
        let y = |v: f64| bottom - (v / full * f64::from(bottom - top)).round() as i32;
        let count = self.x.len().max(2) as i32;
        let wide = (right - left) / count;
        let x = |i: usize| match self.marks {
            Marks::Lines => left + 20 + i as i32 * (right - left - 40) / (count - 1),
            Marks::Bars => left + i as i32 * wide + wide / 2,
        };
        for tick in 0..=(full / step).round() as i32 {
            let v = f64::from(tick) * step;
            canvas.line((left, y(v)), (right, y(v)), GRID, 1);
            let digits = usize::from(step < 1.0) + usize::from(step < 0.1);
            canvas.text((left - 6, y(v) + 4), 2, &format!("{v:.digits$}"));
        }
        for (i, name) in self.x.iter().enumerate() {
            canvas.line((x(i), bottom), (x(i), bottom + 4), INK, 1);
            canvas.text((x(i), bottom + 18), 1, name);
        }
        canvas.line((left, top), (left, bottom), INK, 1);
        canvas.line((left, bottom), (right, bottom), INK, 1);
        canvas.text(((left + right) / 2, bottom + 40), 1, &self.x_name);
        canvas.text((left, top - 8), 0, &self.y_name);
        canvas.text(((left + right) / 2, 18), 1, &self.title);
        for (n, series) in self.series.iter().enumerate() {
            let colour = COLOURS[n % COLOURS.len()];
            let values = series.values.iter().enumerate();
            let points: Vec<_> = values.map(|(i, v)| (x(i), y(*v))).collect();
            match self.marks {
                Marks::Lines => {
                    for pair in points.windows(2) {
                        canvas.line(pair[0], pair[1], colour, 2);
                    }
                    for (px, py) in points {
                        canvas.line((px - 3, py), (px + 3, py), colour, 4);
                    }
                }
                Marks::Bars => {
                    let bar = (wide - 30).max(1) / self.series.len() as i32;
                    for ((px, py), value) in points.into_iter().zip(&series.values) {
                        let at = px + (2 * n as i32 + 1 - self.series.len() as i32) * bar / 2;
                        canvas.line((at, bottom), (at, py), colour, (bar - 6).max(1));
                        canvas.text((at, py - 4), 1, &value.to_string());
                    }
                }
            }
            let at = top + 16 + 18 * n as i32;
            canvas.line((right - 260, at - 4), (right - 235, at - 4), colour, 3);
            canvas.text((right - 228, at), 0, &series.name);
        }
    }
}

/// The next of 1, 2, 5 times a power of ten, not below `value`.
pub fn nice(value: f64) -> f64 {
    let value = value.max(1e-9);
    let ten = 10f64.powf(value.log10().floor());
    let factors = [1.0, 2.0, 5.0, 10.0];
    let fits = factors.into_iter().find(|f| f * ten >= value * 0.999_999);
    fits.unwrap_or(10.0) * ten
}

struct Svg(String);

impl Canvas for Svg {
    fn line(&mut self, from: (i32, i32), to: (i32, i32), c: [u8; 3], width: i32) {
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.0,
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#{:02x}{:02x}{:02x}\" \
             stroke-width=\"{width}\"/>",
            from.0, from.1, to.0, to.1, c[0], c[1], c[2]
        );
    }

    fn text(&mut self, at: (i32, i32), anchor: i32, text: &str) {
        let anchor = ["start", "middle", "end"][anchor.clamp(0, 2) as usize];
        let text = text.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(
            self.0,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\" fill=\"#282828\">{text}</text>",
            at.0, at.1
        );
    }
}

struct Pixels(Vec<[u8; 3]>);

impl Pixels {
    fn set(&mut self, x: i32, y: i32, colour: [u8; 3]) {
        if (0..WIDTH).contains(&x) && (0..HEIGHT).contains(&y) {
            self.0[(y * WIDTH + x) as usize] = colour;
        }
    }
}

impl Canvas for Pixels {
    fn line(&mut self, from: (i32, i32), to: (i32, i32), colour: [u8; 3], width: i32) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let steps = dx.abs().max(dy.abs()).max(1);
        for i in 0..=steps {
            let at = |a: i32, d: i32| a + (2 * d * i + d.signum() * steps) / (2 * steps);
            for w in 0..width {
                let off = w - width / 2;
                let (x, y) = (at(from.0, dx), at(from.1, dy));
                if dx.abs() >= dy.abs() {
                    self.set(x, y + off, colour);
                } else {
                    self.set(x + off, y, colour);
                }
            }
        }
    }

    fn text(&mut self, at: (i32, i32), anchor: i32, text: &str) {
        let width = 8 * text.chars().count() as i32;
        let left = at.0 - width * anchor / 2;
        for (n, letter) in text.chars().enumerate() {
            let rows = BASIC_FONTS.get(letter).unwrap_or([0x7E; 8]);
            for (y, row) in rows.into_iter().enumerate() {
                for x in 0..8 {
                    if row >> x & 1 == 1 {
                        self.set(left + 8 * n as i32 + x, at.1 - 8 + y as i32, INK);
                    }
                }
            }
        }
    }
}
