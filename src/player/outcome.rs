//! What a list does that reaches too far, and what it has done.

/// What becomes of a list that reaches for what is not its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum OnViolation {
    /// The block is passed over.
    #[default]
    GoOn,
    /// The list stops.
    Stop,
}

/// What a list has done since it was started. A number that would be too large stays at `u32::MAX`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RunCounts {
    /// Blocks, flow control left out.
    pub blocks: u32,
    /// Meshes that were drawn, and shadow volumes of them.
    pub draws: u32,
    /// Vertices that were transformed.
    pub vertices: u32,
    /// Triangles that were submitted.
    pub triangles: u32,
    /// Triangles that found no room in the scene.
    pub dropped: u32,
    /// Features that the pipeline does not have, each time one was asked for.
    pub unimplemented: u32,
    /// Access violations.
    pub violations: u32,
    /// Times that what BOUNDS or CONE speaks of was out of sight, or turned away, and passed over (M4).
    pub skipped: u32,
    /// Words that were passed over so.
    pub skipped_words: u32,
}
