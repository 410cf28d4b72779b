//! What a line may cost, and what was paid to stay within it (X9).

use crate::span::{Size, Triangle};

/// What a line may cost, and what its parts cost at most (X9): in instructions, cycles, or any other unit.
///
/// A [paced](crate::Renderer::paced) renderer takes each step of a line only if the line can still pay for it, at these
/// costs. Where it cannot, quality is lowered:
///
/// | step | where it costs too much |
/// |---|---|
/// | sides turn | a triangle whose side cannot turn is given up |
/// | triangles begin, while half of what the line has is left, and a slot is free | others wait for the next line |
/// | those of 7 lines below begin, while about what is active can be paid for | they begin further down |
/// | columns are found | the line has the background alone |
/// | spans that meet are sorted and compared, while half of what is left then is there | the nearest depth of a span on the line says who is seen, or where they could not be sorted its slot |
/// | runs of pixels that are seen are coloured | runs have the colour of their middle, the narrowest first |
/// | | where all have, runs join what is left of them, the narrowest first |
///
/// The costs below are instructions at `opt-level` 3: in 23 scenes of all kinds no line took more than was paid for it, half
/// of them took less than three quarters; `scanbeam firmware --paced` measures that again. Where chips wait for memory, a
/// line takes more cycles than instructions, as a measurement there tells. No
/// cost covers a [`Shader`](crate::look::Shader), light at pixels or texels that are filtered: for these, `run` and `pixel`
/// have to be raised. A line costs `line` and a `column` each in any case.
///
/// ```
/// use scanbeam::frame::Pace;
///
/// // 168 MHz, 30 pictures of 240 lines a second, 1.4 cycles an instruction.
/// let pace = Pace { most: 168_000_000 / (30 * 240) * 10 / 14, ..Pace::GOURAUD_M4 };
/// assert_eq!(pace.most, 16_666);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    /// The most that a line may cost.
    pub most: u32,
    /// A line, whatever is on it.
    pub line: u16,
    /// A column of it, likewise.
    pub column: u16,
    /// A triangle of up to 25 pixels each way that begins, and is no sliver.
    pub begin: u16,
    /// Any other; one that is too thin for planes costs that on each line on which it is compared, and for each run.
    pub large: u16,
    /// A triangle of which a side turns.
    pub turn: u16,
    /// A triangle that is active, three times where it meets others; and a run, where not all can be coloured in full.
    pub span: u16,
    /// 32 columns that it touches, twice a line.
    pub word: u16,
    /// A step of sorting those that meet others.
    pub step: u16,
    /// Two that are compared.
    pub pair: u16,
    /// A run of pixels that are coloured; twice where that is not done in the commonest way, as of large triangles, slivers and
    /// texels in perspective, but for short spans of squares that repeat, within a coarse budget; half for texels of small
    /// triangles without a shade.
    pub run: u16,
    /// A pixel of it, likewise.
    pub pixel: u16,
}

/// What a [paced](crate::Renderer::paced) renderer has paid for not being late (X9). No more pixels are other than they
/// would be than `even`, `joined`, `unsorted` and `left_out` together, but for those of triangles that are late or lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Paid {
    /// Lines with such pixels, or on which a triangle waited.
    pub lines: u32,
    /// Pixels that have the colour of the one in the middle of their run.
    pub even: u32,
    /// Pixels that have the colour of the one left of their run.
    pub joined: u32,
    /// Pixels of spans that were not compared with all others that they meet.
    pub unsorted: u32,
    /// Pixels of lines that have the background alone.
    pub left_out: u32,
    /// Triangles that began on a line below their first.
    pub late: u32,
    /// Triangles that ended while they waited, or were given up because a side could not turn. What waits on the last line
    /// still is not among them, and where a line cannot pay for a `span` nobody is told to have ended.
    pub lost: u32,
    /// What the dearest line was reckoned to cost: [`Pace::most`] at most.
    pub dearest: u32,
}

impl Pace {
    /// [`Gouraud`](crate::look::Gouraud) in M4 and M3 code; there is no limit.
    pub const GOURAUD_M4: Self = Self {
        most: u32::MAX,
        line: 1080,
        column: 4,
        begin: 620,
        large: 1400,
        turn: 130,
        span: 104,
        word: 12,
        step: 11,
        pair: 180,
        run: 230,
        pixel: 5,
    };
    /// The same in M0+ code.
    pub const GOURAUD_M0: Self = Self {
        line: 1350,
        begin: 1100,
        large: 2700,
        turn: 240,
        span: 200,
        word: 16,
        step: 15,
        pair: 290,
        run: 310,
        pixel: 8,
        ..Self::GOURAUD_M4
    };
    /// [`Textured`](crate::look::Textured) in M4 and M3 code, with texels that are not filtered; there is no limit.
    pub const TEXTURED_M4: Self = Self {
        begin: 1700,
        large: 3050,
        run: 330,
        pixel: 14,
        ..Self::GOURAUD_M4
    };
    /// The same in M0+ code.
    pub const TEXTURED_M0: Self = Self {
        begin: 3500,
        large: 7700,
        run: 700,
        pixel: 14,
        ..Self::GOURAUD_M0
    };

    /// What it costs that a triangle begins.
    pub(super) fn of_begin(&self, triangle: &Triangle<'_>) -> u32 {
        u32::from(match triangle.size(triangle.area()) {
            Size::Tiny => self.begin,
            _ => self.large,
        })
    }

    /// About what so many triangles cost on a line so wide, in the commonest way, where half of them meet others.
    pub(super) fn of_active(&self, count: u32, width: u32) -> u32 {
        if count == 0 {
            return 0;
        }
        let each = 2 * u32::from(self.span) + u32::from(self.run);
        count * each + u32::from(self.pixel) * width
    }

    /// What a line so wide has left for what is on it.
    pub(super) fn for_spans(&self, width: u32) -> u32 {
        let taken = u32::from(self.line) + u32::from(self.column) * width;
        self.most.saturating_sub(taken)
    }
}
