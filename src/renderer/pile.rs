//! Transparent spans of a line, as many as fit on the stack, in the order in which they are drawn
//! (K11): from the left, or from back to front.

/// Most transparent spans that are sorted in one go.
pub(super) const PILE: usize = 32;
/// A transparent span.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pane {
    pub(super) start: u16,
    pub(super) end: u16,
    pub(super) object: u16,
    /// [`usize::MAX`] cut off, if it has none.
    pub(super) slot: u16,
    /// Depth of the first pixel, and the step to the next.
    pub(super) depth: u32,
    pub(super) step: u32,
}

impl Pane {
    /// Depth at a pixel.
    fn at(&self, pixel: u16) -> u32 {
        let pixels = u32::from(pixel - self.start);
        self.depth.wrapping_add(self.step.wrapping_mul(pixels))
    }
}

/// Which panes a pile takes, and in which order.
#[derive(Clone, Copy, Debug)]
pub(super) enum By {
    /// Those that reach beyond a pixel, by where they begin from there on.
    Start(u16),
    /// Those that cover a stretch, from back to front at its middle; behind those up to a key, which
    /// have been drawn.
    Depth(u16, u16, Option<Key>),
}

/// Where a pane stands in a pile; of equal ones the later object is behind.
pub(super) type Key = (u32, u16);

impl By {
    /// Where a pane stands, if it is taken.
    pub(super) fn key(self, pane: &Pane) -> Option<Key> {
        let (key, taken) = match self {
            Self::Start(pixel) => (u32::from(pane.start.max(pixel)), pane.end > pixel),
            Self::Depth(start, end, after) => {
                if pane.start > start || pane.end < end {
                    return None;
                }
                let depth = pane.at(middle(start, end));
                (
                    depth,
                    after.is_none_or(|after| (depth, pane.object) > after),
                )
            }
        };
        taken.then_some((key, pane.object))
    }
}

/// The pixel in the middle of a stretch, or just before it.
const fn middle(start: u16, end: u16) -> u16 {
    start + (end - 1 - start) / 2
}

/// The first panes of an order.
#[derive(Debug)]
pub(super) struct Pile {
    pub(super) panes: [Pane; PILE],
    pub(super) count: usize,
    pub(super) by: By,
    /// The key of the first that found no room.
    pub(super) left_out: Option<Key>,
    /// Where the first pane begins or ends behind the pixel from which on they are taken.
    pub(super) edge: u16,
}

impl Default for Pile {
    fn default() -> Self {
        Self {
            panes: [Pane::default(); PILE],
            count: 0,
            by: By::Start(0),
            left_out: None,
            edge: 0,
        }
    }
}

impl Pile {
    /// Empties the pile for panes in an order.
    pub(super) fn begin(&mut self, by: By) {
        self.by = by;
        (self.count, self.left_out, self.edge) = (0, None, u16::MAX);
    }

    pub(super) fn add(&mut self, pane: Pane) {
        let Some(key) = self.by.key(&pane) else {
            return;
        };
        if let By::Start(pixel) = self.by {
            let edge = if pane.start > pixel {
                pane.start
            } else {
                pane.end
            };
            self.edge = self.edge.min(edge);
        }
        let stands = |pane: &Pane| self.by.key(pane).unwrap_or_default();
        let mut at = self.count;
        if at == PILE {
            let out = stands(&self.panes[PILE - 1]).max(key);
            self.left_out = Some(self.left_out.map_or(out, |first| first.min(out)));
            if out == key {
                return;
            }
            at -= 1;
        } else {
            self.count += 1;
        }
        while at > 0 && stands(&self.panes[at - 1]) > key {
            self.panes[at] = self.panes[at - 1];
            at -= 1;
        }
        self.panes[at] = pane;
    }

    /// The pixel from which on panes are missing in a pile from the left.
    pub(super) fn limit(&self) -> u16 {
        self.left_out.map_or(u16::MAX, |(start, _)| start as u16)
    }

    /// The next stretch from `pixel` on that is covered by the same panes throughout, none of them
    /// missing: from where to where, and how many of `order` these are, from back to front.
    pub(super) fn stretch(&self, pixel: u16, order: &mut [u8; PILE]) -> Option<(u16, u16, usize)> {
        let panes = self.panes.get(..self.count)?;
        let first = |pane: &Pane| pane.start.max(pixel);
        let start = panes.iter().filter(|p| p.end > pixel).map(first).min()?;
        let mut end = self.limit();
        if start >= end {
            return None;
        }
        let mut count = 0;
        for (pane, index) in panes.iter().zip(0..) {
            if pane.start > start {
                end = end.min(pane.start);
            } else if pane.end > start {
                end = end.min(pane.end);
                order[count] = index;
                count += 1;
            }
        }
        let middle = middle(start, end);
        let key = |index: u8| {
            let pane = &self.panes[usize::from(index)];
            (pane.at(middle), pane.object)
        };
        for i in 1..count {
            let mut at = i;
            while at > 0 && key(order[at - 1]) > key(order[at]) {
                order.swap(at - 1, at);
                at -= 1;
            }
        }
        Some((start, end, count))
    }
}
