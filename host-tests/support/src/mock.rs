//! A mocked fast-raster frame buffer: the sink that forgives nothing (SPEC S5, K12, X5).
//!
//! It stands in for the display in every host test, so it checks what a display cannot: that each pixel of a frame
//! arrives exactly once, in order, in transfers of whole lines, and that nobody starts a transfer while one runs. It is
//! late on purpose, by a number of polls that the test chooses, and copies the pixels only when the transfer ends, so
//! that a buffer changed too early would show. It fails where it is told to.
//!
//! A *frame* here is a set of windows that do not overlap, in order of their tops. It begins by itself with the first `begin`
//! after the last one was complete or after an error; a partial update says [`MockFrameBuffer::next_frame`].

use std::collections::VecDeque;
use std::fmt::{self, Display};
use std::task::Poll;

use scanbeam::scan_out::{Error, ErrorKind, LineBuf, ScanoutDma, Window};

/// A line buffer from the host's heap.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HostLine<W>(Box<[W]>);

impl<W: Copy + Default + 'static> HostLine<W> {
    /// A buffer of `words` words.
    #[must_use]
    pub fn new(words: usize) -> Self {
        Self(vec![W::default(); words].into())
    }
}

impl<W: Copy + 'static> LineBuf for HostLine<W> {
    type Word = W;

    fn pixels(&mut self) -> &mut [W] {
        &mut self.0
    }
}

/// What the mock refused, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MockError {
    /// The kind of the error.
    pub kind: ErrorKind,
    /// The line of the display, 0 at its top.
    pub line: u16,
    /// What was wrong, for people.
    pub what: &'static str,
}

impl Error for MockError {
    fn kind(&self) -> ErrorKind {
        self.kind
    }
}

impl Display for MockError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.what)
    }
}

impl std::error::Error for MockError {}

/// Where a planned fault strikes. All but `Hang` strike once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// `begin` of a window that contains the line fails.
    Begin,
    /// `start` of the transfer that contains the line fails, and gives the buffer back with the error.
    Start,
    /// The transfer starts, but fails in `poll`, and the buffer comes with the next `poll`.
    Poll,
    /// The transfer with the line runs until [`MockFrameBuffer::clear_fault`].
    Hang,
    /// The transfer with the line fails to give its buffer back: the mock drops it and is idle.
    Lose,
    /// `end` fails after the line was sent.
    End,
}

/// A transfer that runs or waits behind one that does.
#[derive(Debug)]
struct Transfer<W> {
    buf: HostLine<W>,
    len: usize,
    window: Window,
    /// First line, counted from the top of the window, and how many.
    first: u16,
    lines: u16,
    polls_left: u32,
}

impl<W> Transfer<W> {
    /// Whether `line` of the display is among the lines of this transfer.
    fn has(&self, line: u16) -> bool {
        let top = self.window.y + self.first;
        (top..top + self.lines).contains(&line)
    }
}

/// The mocked frame buffer, with pixels of type `W`.
#[derive(Debug)]
pub struct MockFrameBuffer<W> {
    width: u16,
    height: u16,
    /// What the display shows: survives from frame to frame. `None` was never written.
    shown: Vec<Option<W>>,
    /// Which pixels were written in this frame.
    written: Vec<bool>,
    late: u32,
    /// How many transfers may be started before the first ends.
    depth: usize,
    fault: Option<(u16, Fault)>,
    window: Option<Window>,
    /// Lines of the window that were started, and of those the ones that arrived.
    started: u16,
    arrived: u16,
    /// The top of the last window of this frame: the next one must not begin above it.
    last_top: u16,
    /// An error ended the frame: the next `begin` starts a new one.
    broken: bool,
    queue: VecDeque<Transfer<W>>,
    /// Buffers of failed transfers, on their way back.
    returning: VecDeque<HostLine<W>>,
    transfers: usize,
    words: usize,
    windows: usize,
}

impl<W: Copy + 'static> MockFrameBuffer<W> {
    /// A display of `width` x `height` pixels that is never late and does not chain.
    #[must_use]
    pub fn new(width: u16, height: u16) -> Self {
        let pixels = usize::from(width) * usize::from(height);
        Self {
            width,
            height,
            shown: vec![None; pixels],
            written: vec![false; pixels],
            late: 0,
            depth: 1,
            fault: None,
            window: None,
            started: 0,
            arrived: 0,
            last_top: 0,
            broken: false,
            queue: VecDeque::new(),
            returning: VecDeque::new(),
            transfers: 0,
            words: 0,
            windows: 0,
        }
    }

    /// Each transfer is found busy by so many polls.
    #[must_use]
    pub fn late_by(mut self, polls: u32) -> Self {
        self.late = polls;
        self
    }

    /// Takes up to two transfers at once, as a chaining sink does.
    #[must_use]
    pub fn chained(mut self) -> Self {
        self.depth = 2;
        self
    }

    /// Plans a fault at `line` of the display, in place of any other.
    pub fn fail_at(&mut self, line: u16, fault: Fault) {
        self.fault = Some((line, fault));
    }

    /// Takes the planned fault back; a hanging transfer goes on.
    pub fn clear_fault(&mut self) {
        self.fault = None;
    }

    /// Starts a frame although the last one was only a part of the display. What is shown stays.
    pub fn next_frame(&mut self) {
        self.written.fill(false);
        self.last_top = 0;
        self.broken = false;
    }

    /// The pixels of this frame, when every one of them arrived.
    ///
    /// # Errors
    /// At the first line with a missing pixel.
    pub fn frame(&self) -> Result<Vec<W>, MockError> {
        let width = usize::from(self.width).max(1);
        let pixels = self.shown.iter().zip(&self.written).enumerate();
        pixels
            .map(|(at, (pixel, written))| {
                pixel.filter(|_| *written).ok_or(MockError {
                    kind: ErrorKind::Sequence,
                    line: (at / width) as u16,
                    what: "the frame has no such line",
                })
            })
            .collect()
    }

    /// What the display shows, also of earlier frames; `None` where nothing was ever sent.
    #[must_use]
    pub fn shown(&self) -> &[Option<W>] {
        &self.shown
    }

    /// Transfers that ended well, of all frames.
    #[must_use]
    pub fn transfers(&self) -> usize {
        self.transfers
    }

    /// Pixels that arrived, of all frames.
    #[must_use]
    pub fn words(&self) -> usize {
        self.words
    }

    /// Windows that were opened, of all frames.
    #[must_use]
    pub fn windows(&self) -> usize {
        self.windows
    }

    /// The line of the display that would be started next.
    fn next_line(&self) -> u16 {
        self.window.map_or(0, |window| window.y + self.started)
    }

    /// An error that ends the frame.
    fn refuse(&mut self, kind: ErrorKind, line: u16, what: &'static str) -> MockError {
        self.broken = true;
        MockError { kind, line, what }
    }

    /// Whether `fault` is planned for one of `lines`; it then has struck.
    fn strikes(&mut self, fault: Fault, top: u16, lines: u16) -> bool {
        let hit = self.fault.is_some_and(|(at, planned)| {
            planned == fault && (top..top.saturating_add(lines)).contains(&at)
        });
        if hit {
            self.fault = None;
        }
        hit
    }

    /// Checks a window and opens it.
    fn open(&mut self, w: Window) -> Result<(), MockError> {
        if !self.queue.is_empty() || !self.returning.is_empty() {
            return Err(self.refuse(ErrorKind::Sequence, w.y, "begin while a transfer runs"));
        }
        if self.window.is_some() {
            return Err(self.refuse(ErrorKind::Sequence, w.y, "begin before end"));
        }
        let fits = |start: u16, len: u16, end: u16| {
            len > 0 && u32::from(start) + u32::from(len) <= u32::from(end)
        };
        if !fits(w.x, w.width, self.width) || !fits(w.y, w.height, self.height) {
            return Err(self.refuse(ErrorKind::Length, w.y, "the window is not on the display"));
        }
        if self.broken || self.written.iter().all(|written| *written) {
            self.next_frame();
        }
        if self.overlaps(w) {
            return Err(self.refuse(ErrorKind::Sequence, w.y, "a line was sent already"));
        }
        if w.y < self.last_top {
            return Err(self.refuse(ErrorKind::Sequence, w.y, "a window above the last one"));
        }
        if self.strikes(Fault::Begin, w.y, w.height) {
            return Err(self.refuse(ErrorKind::Bus, w.y, "planned fault in begin"));
        }
        self.window = Some(w);
        self.last_top = w.y;
        self.started = 0;
        self.arrived = 0;
        self.windows += 1;
        Ok(())
    }

    /// Whether a pixel of the window was written in this frame.
    fn overlaps(&self, w: Window) -> bool {
        let row = |y: u16| usize::from(y) * usize::from(self.width) + usize::from(w.x);
        (w.y..w.y + w.height).any(|y| {
            self.written[row(y)..][..usize::from(w.width)]
                .iter()
                .any(|written| *written)
        })
    }

    /// Checks a transfer of `len` words and tells its window and number of lines.
    fn check(&mut self, have: usize, len: usize) -> Result<(Window, u16), MockError> {
        let line = self.next_line();
        let Some(window) = self.window else {
            return Err(self.refuse(ErrorKind::Sequence, line, "start without begin"));
        };
        if self.queue.len() + self.returning.len() >= self.depth {
            return Err(self.refuse(ErrorKind::Sequence, line, "start while busy"));
        }
        let width = usize::from(window.width);
        if len == 0 || !len.is_multiple_of(width) {
            return Err(self.refuse(ErrorKind::Length, line, "not whole lines"));
        }
        if len > have {
            return Err(self.refuse(ErrorKind::Length, line, "more than the buffer holds"));
        }
        let lines = len / width;
        if lines > usize::from(window.height - self.started) {
            return Err(self.refuse(ErrorKind::Sequence, line, "more lines than the window"));
        }
        let lines = lines as u16;
        if self.strikes(Fault::Start, line, lines) {
            return Err(self.refuse(ErrorKind::Bus, line, "planned fault in start"));
        }
        Ok((window, lines))
    }

    /// The transfer has ended: its pixels are copied only now.
    fn arrive(&mut self, transfer: &Transfer<W>) {
        let window = transfer.window;
        let lines = transfer.buf.0[..transfer.len].chunks_exact(usize::from(window.width));
        for (y, line) in (window.y + transfer.first..).zip(lines) {
            let at = usize::from(y) * usize::from(self.width) + usize::from(window.x);
            for (i, word) in line.iter().enumerate() {
                self.shown[at + i] = Some(*word);
                self.written[at + i] = true;
            }
        }
        self.arrived += transfer.lines;
        self.transfers += 1;
        self.words += transfer.len;
    }
}

impl<W: Copy + 'static> ScanoutDma for MockFrameBuffer<W> {
    type Error = MockError;
    type Buf = HostLine<W>;

    fn begin(&mut self, window: Window) -> Result<(), MockError> {
        self.open(window)
    }

    fn start(&mut self, buf: HostLine<W>, len: usize) -> Result<(), (MockError, HostLine<W>)> {
        let (window, lines) = match self.check(buf.0.len(), len) {
            Ok(checked) => checked,
            Err(error) => return Err((error, buf)),
        };
        let first = self.started;
        let polls_left = self.late;
        self.queue.push_back(Transfer {
            buf,
            len,
            window,
            first,
            lines,
            polls_left,
        });
        self.started += lines;
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<HostLine<W>>, MockError>> {
        if let Some(buf) = self.returning.pop_front() {
            return Poll::Ready(Ok(Some(buf)));
        }
        let fault = self.fault;
        let Some(running) = self.queue.front_mut() else {
            return Poll::Ready(Ok(None));
        };
        if fault.is_some_and(|(line, fault)| fault == Fault::Hang && running.has(line)) {
            return Poll::Pending;
        }
        if let Some(left) = running.polls_left.checked_sub(1) {
            running.polls_left = left;
            return Poll::Pending;
        }
        let top = running.window.y + running.first;
        let lines = running.lines;
        if self.strikes(Fault::Lose, top, lines) {
            self.queue.clear();
            self.broken = true;
            return Poll::Ready(Ok(None));
        }
        if self.strikes(Fault::Poll, top, lines) {
            // What is chained behind is cancelled.
            self.returning
                .extend(self.queue.drain(..).map(|cancelled| cancelled.buf));
            return Poll::Ready(Err(self.refuse(
                ErrorKind::Bus,
                top,
                "planned fault in poll",
            )));
        }
        match self.queue.pop_front() {
            Some(done) => {
                self.arrive(&done);
                Poll::Ready(Ok(Some(done.buf)))
            }
            None => Poll::Ready(Ok(None)),
        }
    }

    fn end(&mut self) -> Result<(), MockError> {
        let line = self.next_line();
        if !self.queue.is_empty() || !self.returning.is_empty() {
            return Err(self.refuse(ErrorKind::Sequence, line, "end while a transfer runs"));
        }
        let Some(window) = self.window.take() else {
            return Ok(());
        };
        if self.arrived < window.height {
            let line = window.y + self.arrived;
            return Err(self.refuse(ErrorKind::Sequence, line, "a line is missing"));
        }
        if self.strikes(Fault::End, window.y, window.height) {
            return Err(self.refuse(ErrorKind::Bus, line, "planned fault in end"));
        }
        Ok(())
    }

    fn chains(&self) -> bool {
        self.depth > 1
    }
}
