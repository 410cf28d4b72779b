//! A frame drawn by two cores and sent by one (K16, X6).
//!
//! The desk's core draws and sends; the worker's core helps. A worker asks for lines when it begins, and again when
//! it begins those it got; the desk answers with a band ahead of its own line, and goes on below it. So each draws as
//! much as it has time for, whatever else it does: a worker may make the next scene before it helps with this one.
//! Bands become short towards the end, where one core would wait for the other. After a line on which nothing is
//! active, those up to the next that a triangle begins on are filled by the desk, and lent to nobody.
//!
//! Lines go one way and empty buffers the other, each through a queue of one producer; the question and the answer are
//! one word. Nothing else is shared but the scene, read-only. Pictures are the same whoever draws a line (K5).

use super::renderer::{LineError, Renderer};
use super::send::{FrameError, FrameUse, Lines, send};
use crate::look::{Look, WordOf};
use crate::pixel::PixelFormat;
use crate::scan_out::{LineBuf, Pump, ScanoutDma};
use crate::scene::Scene;
use core::fmt;
use core::ops::Range;
use core::sync::atomic::{AtomicU32, Ordering};
use heapless::Deque;
use heapless::spsc::{Consumer, Producer, Queue};

/// The worker is not in a frame.
const AWAY: u32 = 0;
/// The worker asks for lines: of even frames, and of odd ones. It may be in the next before the desk is.
const ASKS: [u32; 2] = [1, 2];
/// The desk has no more lines for the worker.
const OVER: u32 = 3;
/// The desk's answer: a band, its first line above the line after its last.
const BAND: u32 = 1 << 31;
/// Bands that a worker may have: of lines that are drawn, that it draws, and that it draws next.
const BANDS: usize = 4;
/// Lines of a band, unless the desk is told otherwise.
const USUAL_BAND: u16 = 4;
/// Blank lines for each of a band that take longer to send than the band to draw, on a usual bus.
const FAR: u16 = 4;

/// How a core waits for the other, and wakes it: `wfe` and `sev` on Cortex-M.
#[derive(Clone, Copy)]
pub struct Peer<'a> {
    /// Called while something is awaited. It may sleep until the other wakes it; `false` gives the frame up.
    pub wait: &'a dyn Fn() -> bool,
    /// Called when something was done that the other may wait for.
    pub wake: &'a dyn Fn(),
}

impl fmt::Debug for Peer<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Peer").finish_non_exhaustive()
    }
}

/// A line on its way from a worker to the desk.
#[derive(Debug)]
struct Drawn<B> {
    line: u16,
    /// Whether something is active on it, or why it could not be drawn.
    result: Result<bool, LineError>,
    buf: B,
}

/// What is between a worker and the desk, with room for `N - 1` line buffers.
#[derive(Debug)]
pub struct Relay<B, const N: usize> {
    drawn: Queue<Drawn<B>, N>,
    free: Queue<B, N>,
    order: AtomicU32,
}

impl<B: LineBuf, const N: usize> Relay<B, N> {
    /// A relay that passes `buffers` to and fro, each of at least a line. Those beyond `N - 1` are dropped.
    #[must_use]
    pub fn new(buffers: impl IntoIterator<Item = B>) -> Self {
        let mut free = Queue::new();
        for buf in buffers.into_iter().take(N.saturating_sub(1)) {
            // There is room.
            let _ = free.enqueue(buf);
        }
        Self {
            drawn: Queue::new(),
            free,
            order: AtomicU32::new(AWAY),
        }
    }

    /// The end of the core that helps, and that of the core that sends. A frame that was given up is forgotten.
    pub fn split(&mut self) -> (Worker<'_, B>, Desk<'_, B>) {
        while let Some(drawn) = self.drawn.dequeue() {
            // There is room for every buffer.
            let _ = self.free.enqueue(drawn.buf);
        }
        *self.order.get_mut() = AWAY;
        let can_help = !self.free.is_empty();
        let (to_desk, drawn) = self.drawn.split();
        let (to_worker, free) = self.free.split();
        let order = &self.order;
        let worker = Worker {
            to_desk,
            free,
            order,
            odd: false,
        };
        let desk = Desk {
            drawn,
            to_worker,
            order,
            can_help,
            band: USUAL_BAND,
            lent: Deque::new(),
            blank: 0,
            end: 0,
            told: false,
            odd: true,
        };
        (worker, desk)
    }
}

/// The end of a [`Relay`] that helps.
pub struct Worker<'q, B> {
    to_desk: Producer<'q, Drawn<B>>,
    free: Consumer<'q, B>,
    order: &'q AtomicU32,
    /// Whether the next frame has an odd number.
    odd: bool,
}

impl<B: LineBuf> Worker<'_, B> {
    /// Helps with a frame: draws the lines that the desk has for it, until there are no more. The desk's frame ends
    /// after that.
    ///
    /// `false`: `wait` has given up, and the relay is to be split anew before the next frame.
    pub fn help<L, const WORDS: usize>(
        &mut self,
        scene: &Scene<'_, '_, L>,
        renderer: &mut Renderer<'_, L, WORDS>,
        background: WordOf<L>,
        peer: Peer<'_>,
    ) -> bool
    where
        L: Look,
        B: LineBuf<Word = WordOf<L>>,
    {
        renderer.restart();
        let needed = usize::from(scene.screen().width());
        let asks = ASKS[usize::from(self.odd)];
        self.odd = !self.odd;
        self.say(asks, peer);
        loop {
            let order = self.order.load(Ordering::Acquire);
            if order & BAND != 0 {
                self.say(asks, peer);
                let (start, end) = (order >> 16 & 0x7FFF, order & 0xFFFF);
                for line in start as u16..end as u16 {
                    let mut buf = loop {
                        if let Some(buf) = self.free.dequeue() {
                            break buf;
                        }
                        if !(peer.wait)() {
                            return false;
                        }
                    };
                    let have = buf.pixels().len();
                    let result = match buf.pixels().get_mut(..needed) {
                        Some(pixels) => renderer.draw_line(scene, line, pixels, background),
                        None => Err(LineError::Pixels { needed, have }),
                    };
                    // There is room for every buffer.
                    let _ = self.to_desk.enqueue(Drawn { line, result, buf });
                    (peer.wake)();
                    if result.is_ok() {
                        renderer.fetch_known(scene);
                    }
                }
            } else if order == OVER {
                self.say(AWAY, peer);
                return true;
            } else if !(peer.wait)() {
                return false;
            }
        }
    }

    fn say(&self, order: u32, peer: Peer<'_>) {
        self.order.store(order, Ordering::Release);
        (peer.wake)();
    }
}

/// The end of a [`Relay`] that sends.
pub struct Desk<'q, B> {
    drawn: Consumer<'q, Drawn<B>>,
    to_worker: Producer<'q, B>,
    order: &'q AtomicU32,
    /// Whether the relay has a buffer.
    can_help: bool,
    band: u16,
    /// What the worker has, from the top.
    lent: Deque<Range<u16>, BANDS>,
    /// Nothing is active on lines of this core before this one.
    blank: u16,
    /// Nothing is active from this line on.
    end: u16,
    /// Whether the worker knows that there is no more.
    told: bool,
    /// Whether this frame has an odd number.
    odd: bool,
}

impl<B: LineBuf> Desk<'_, B> {
    /// The most lines that a worker gets at once, at least 1; 4 at first. A triangle that lies on lines of both is
    /// set up by both, and a worker is ahead by as many lines as there are buffers: three bands are enough.
    pub fn set_band(&mut self, lines: u16) {
        self.band = lines.max(1);
    }

    /// Begins a frame. Apart, as what happens once a frame must not lie among what happens once a line: on a chip that
    /// runs from flash both would be in the cache.
    #[inline(never)]
    fn open<L>(&mut self, scene: &Scene<'_, '_, L>) {
        self.lent.clear();
        self.blank = scene.begins_from(scene.lines().start);
        self.end = scene.ends_by();
        self.told = false;
        self.odd = !self.odd;
    }

    /// Whether the worker asks for lines of this frame.
    fn is_asked(&self) -> bool {
        self.order.load(Ordering::Acquire) == ASKS[usize::from(self.odd)]
    }

    /// Whether the worker knows that there is no more, and has left.
    fn is_left(&self) -> bool {
        let order = self.order.load(Ordering::Acquire);
        self.told && (order == AWAY || order == ASKS[usize::from(!self.odd)])
    }

    /// Answers a worker that asks, while `line` is the first that this core has not begun.
    #[inline(never)]
    fn answer(&mut self, line: u16, peer: Peer<'_>) {
        if self.told || self.lent.is_full() || !self.is_asked() {
            return;
        }
        let lent = self.lent.back().map_or(line, |band| band.end);
        let from = lent.max(line).max(self.blank);
        let left = self.end.saturating_sub(from);
        let band = self.band.min((left / 4).max(1));
        // Lines in between are for this core: fewer, the further the worker is ahead; none, where this core has
        // enough that are blank.
        let is_far = from == self.blank && from >= line.saturating_add(FAR * band);
        let between = 2 * band / (1 + self.lent.len() as u16);
        let between = if is_far {
            0
        } else {
            between.clamp(1, left.saturating_sub(band).max(1))
        };
        let start = from.saturating_add(between);
        let mut order = OVER;
        if left > between && self.can_help {
            let end = start.saturating_add(band);
            order = BAND | u32::from(start) << 16 | u32::from(end);
            // There is room.
            let _ = self.lent.push_back(start..end);
        }
        self.told = order == OVER;
        self.order.store(order, Ordering::Release);
        (peer.wake)();
    }

    /// Whether the worker has a line, which is the next.
    fn has_lent(&mut self, line: u16) -> bool {
        if self.lent.front().is_some_and(|band| band.end <= line) {
            self.lent.pop_front();
        }
        self.lent.front().is_some_and(|band| band.contains(&line))
    }

    /// Copies the worker's line; whether something is active on it.
    fn take(
        &mut self,
        line: u16,
        pixels: &mut [B::Word],
        peer: Peer<'_>,
    ) -> Result<bool, LineError> {
        let mut drawn = loop {
            if let Some(drawn) = self.drawn.dequeue() {
                break drawn;
            }
            self.answer(line.saturating_add(1), peer);
            if !(peer.wait)() {
                return Err(LineError::Stopped { line });
            }
        };
        let mut result = drawn.result;
        let (needed, words) = (pixels.len(), drawn.buf.pixels());
        let have = words.len();
        match words.get(..needed) {
            _ if drawn.line != line => result = Err(LineError::Strayed { line }),
            Some(words) => pixels.copy_from_slice(words),
            None => result = result.and(Err(LineError::Pixels { needed, have })),
        }
        // There is room for every buffer.
        let _ = self.to_worker.enqueue(drawn.buf);
        (peer.wake)();
        result
    }

    /// Ends the frame, whatever became of it: when the worker has left. What it has drawn is thrown away.
    #[inline(never)]
    fn close(&mut self, end: u16, peer: Peer<'_>) -> Result<(), LineError> {
        loop {
            // Asked before, so that all is here that it handed on before it left.
            let is_left = self.is_left();
            while let Some(drawn) = self.drawn.dequeue() {
                // There is room for every buffer.
                let _ = self.to_worker.enqueue(drawn.buf);
            }
            if is_left {
                return Ok(());
            }
            if self.is_asked() {
                self.told = true;
                self.order.store(OVER, Ordering::Release);
            }
            (peer.wake)();
            if !(peer.wait)() {
                return Err(LineError::Stopped { line: end });
            }
        }
    }
}

/// Draws all lines of `scene` over `background` with the help of a [worker](Worker::help), and sends them through
/// `pump`, so many lines a transfer; what that took, with what the cache of this core has done.
///
/// # Errors
/// When the sink fails, naming the line, or a renderer or a buffer is too short: the worker has left then, too, and
/// the next frame is whole. And when `wait` gives up.
pub fn draw_frame_shared<L, D, B, const WORDS: usize>(
    scene: &Scene<'_, '_, L>,
    renderer: &mut Renderer<'_, L, WORDS>,
    desk: &mut Desk<'_, B>,
    pump: &mut Pump<D>,
    background: WordOf<L>,
    lines_per_transfer: u16,
    peer: Peer<'_>,
) -> Result<FrameUse, FrameError<D::Error>>
where
    L: Look,
    B: LineBuf<Word = WordOf<L>>,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<L>>>,
{
    let end = scene.lines().end;
    let mut lines = Lines::new(scene, background, |_, _| {});
    desk.open(scene);
    let draw = |renderer: &mut Renderer<'_, L, WORDS>, line, pixels: &mut [WordOf<L>]| {
        let is_active = if desk.has_lent(line) {
            desk.take(line, pixels, peer)?
        } else {
            desk.answer(line + 1, peer);
            if line < desk.blank {
                L::Pixel::fill(pixels, background);
                return Ok((false, true));
            }
            lines.draw(renderer, line, pixels)?
        };
        if !is_active {
            let next = scene.begins_from(line + 1);
            desk.blank = desk.blank.max(next);
        }
        Ok((is_active, true))
    };
    let sent = send(scene, renderer, pump, lines_per_transfer, Pump::begin, draw);
    let closed = desk.close(end, peer).map_err(FrameError::Line);
    sent.and_then(|sent| closed.map(|()| sent))
}

#[cfg(test)]
mod tests;
