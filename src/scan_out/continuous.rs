//! Panels that do not wait: RGB and VGA panels that are fed from a few lines of memory (SPEC X5).
//!
//! Such a panel reads line after line on its own clock, so each line has a deadline. Any line can be drawn alone
//! (K5), so a line that cannot be had in time is not worth drawing: it is counted and left out, the panel shows
//! what its memory holds, and the next line is drawn in its right place. Delay is never handed down the picture.

/// A panel that reads lines by its own clock from a ring of line buffers.
///
/// An interrupt of its DMA may call [`feed_line`] for the buffer that has become free, or a loop for all lines of a
/// picture.
pub trait ContinuousPanel {
    /// One pixel, as the panel takes it.
    type Word: Copy + 'static;

    /// The time, in ticks of any length that wrap around. No two times of a frame are 2^31 ticks or more apart.
    fn now(&mut self) -> u32;

    /// When the panel begins to read `line` of this frame.
    fn deadline(&mut self, line: u16) -> u32;

    /// The words that the panel reads for `line`, with any old content. Waits until the line that was in
    /// them before has been read.
    fn buffer(&mut self, line: u16) -> &mut [Self::Word];
}

/// What became of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Fed {
    /// Drawn, so many ticks before its deadline or just at it.
    InTime(u32),
    /// Drawn, but so many ticks after the panel began to read: a part may be old.
    Late(u32),
    /// Not drawn: its deadline was so many ticks ago.
    LeftOut(u32),
}

/// How a continuous panel was fed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FeedStats {
    /// Lines that were drawn before the panel read them.
    pub lines_in_time: u32,
    /// Lines that were drawn too late.
    pub lines_late: u32,
    /// Lines that were not drawn, because it was too late to begin.
    pub lines_left_out: u32,
    /// Ticks by which the latest of these missed its deadline; 0 when all were in time.
    pub worst_ticks: u32,
}

impl FeedStats {
    /// Counts a line.
    pub fn count(&mut self, fed: Fed) {
        let (lines, missed) = match fed {
            Fed::InTime(_) => (&mut self.lines_in_time, 0),
            Fed::Late(ticks) => (&mut self.lines_late, ticks),
            Fed::LeftOut(ticks) => (&mut self.lines_left_out, ticks),
        };
        *lines = lines.saturating_add(1);
        self.worst_ticks = self.worst_ticks.max(missed);
    }
}

/// Ticks since `deadline`, when it is over.
fn missed_by(now: u32, deadline: u32) -> Option<u32> {
    let ticks = now.wrapping_sub(deadline);
    (ticks != 0 && ticks < 1 << 31).then_some(ticks)
}

/// Draws one line where the panel reads it, unless it is too late to begin.
///
/// # Errors
/// What `draw` says; the line counts as nothing then.
pub fn feed_line<C: ContinuousPanel, E>(
    panel: &mut C,
    line: u16,
    draw: impl FnOnce(u16, &mut [C::Word]) -> Result<(), E>,
) -> Result<Fed, E> {
    let deadline = panel.deadline(line);
    if let Some(ticks) = missed_by(panel.now(), deadline) {
        return Ok(Fed::LeftOut(ticks));
    }
    draw(line, panel.buffer(line))?;
    let now = panel.now();
    Ok(match missed_by(now, deadline) {
        Some(ticks) => Fed::Late(ticks),
        None => Fed::InTime(deadline.wrapping_sub(now)),
    })
}
