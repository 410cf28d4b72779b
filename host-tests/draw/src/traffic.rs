//! What pass two reads from slow memory and writes there, reckoned from what caches have done (C8).
//!
//! | when | read | written |
//! |---|---|---|
//! | a line begins | the head of its bin | |
//! | a triangle begins and finds a slot | its record | its link |
//! | it finds none | where the next one is | its link, and the one before |
//! | a line of a triangle without a slot | its link and its record | |
//! | it moves into a slot | its link and its record | its link |
//! | a side of one in a slot turns | its corners, and where two of them are | |

use scanbeam::Link;
use scanbeam::frame::CacheUse;
use scanbeam::scene::{FiledTriangle, Object, TexturePlace, Vertex};

/// Accesses to slow memory.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Traffic {
    /// Records read: a triangle and its three corners.
    pub records: u64,
    /// Sides that turned: a triangle and two places.
    pub turns: u64,
    /// Links read, with heads of bins.
    pub links_read: u64,
    /// Links written.
    pub links_written: u64,
}

/// Whether one side of a triangle gives way to the third below its first line.
#[must_use]
pub fn turns(triangle: &FiledTriangle) -> bool {
    let mut y = triangle
        .corners
        .map(|corner| (i32::from(corner.y) + 4) >> 3);
    y.sort_unstable();
    y[0] < y[1] && y[1] < y[2]
}

impl Traffic {
    /// Bytes of a record, without places on a texture.
    pub const RECORD_BYTES: usize = size_of::<Object>() + 3 * size_of::<Vertex>();
    /// Bytes that a turn reads: a triangle, and where two corners are.
    pub const TURN_BYTES: usize = size_of::<Object>() + 2 * 4;

    /// That of caches, on so many lines each of which every one of `renderers` goes over; of `all` triangles of the
    /// scene a side of `turning` turns, and those that found a slot are taken to be like the others.
    #[must_use]
    pub fn of(cache: &CacheUse, lines: u64, renderers: u64, [turning, all]: [usize; 2]) -> Self {
        let kept = u64::from(cache.hits) + u64::from(cache.moved_in);
        let (spilled, misses) = (u64::from(cache.spilled), u64::from(cache.misses));
        let moved = u64::from(cache.moved_in);
        Self {
            records: cache.set_ups.into(),
            turns: kept * turning as u64 / all.max(1) as u64,
            links_read: lines * renderers + spilled + misses + moved,
            links_written: kept + 2 * spilled,
        }
    }

    /// Adds another part's.
    pub fn add(&mut self, other: &Self) {
        self.records += other.records;
        self.turns += other.turns;
        self.links_read += other.links_read;
        self.links_written += other.links_written;
    }

    /// Bytes read, with places on a texture or without.
    #[must_use]
    pub fn read_bytes(&self, textured: bool) -> u64 {
        let places = if textured {
            3 * size_of::<TexturePlace>()
        } else {
            0
        };
        self.records * (Self::RECORD_BYTES + places) as u64
            + self.turns * Self::TURN_BYTES as u64
            + self.links_read * size_of::<Link>() as u64
    }

    /// Bytes written.
    #[must_use]
    pub fn written_bytes(&self) -> u64 {
        self.links_written * size_of::<Link>() as u64
    }
}
