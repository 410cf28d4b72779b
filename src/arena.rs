//! A lent slice that fills from the front (S3).

/// Storage for up to `items.len()` values, lent by the application.
#[derive(Debug)]
pub(crate) struct Arena<'m, T> {
    items: &'m mut [T],
    /// Never above `items.len()` and never above [`Arena::LIMIT`].
    len: usize,
}

impl<'m, T> Arena<'m, T> {
    /// Indices are 16 bits, the upper half of whose range the object links keep for themselves.
    pub(crate) const LIMIT: usize = 1 << 16;

    pub(crate) fn new(items: &'m mut [T]) -> Self {
        Self { items, len: 0 }
    }

    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// Forgets all but the first `len` values.
    pub(crate) fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Appends; `None` when the arena is full.
    #[inline]
    pub(crate) fn push(&mut self, value: T) -> Option<u16> {
        let index = self.len as u16;
        *self.append(1)?.first_mut()? = value;
        Some(index)
    }

    /// Appends `count` values, whatever they are, to be overwritten; `None` when there is no room
    /// for all of them.
    pub(crate) fn append(&mut self, count: usize) -> Option<&mut [T]> {
        let end = self.len.checked_add(count).filter(|&e| e <= Self::LIMIT)?;
        let new = self.items.get_mut(self.len..end)?;
        self.len = end;
        Some(new)
    }

    /// The places after the last value, to be written and then [taken](Arena::take); `None` where the arena
    /// is as long as indices reach.
    pub(crate) fn rest(&mut self) -> Option<core::slice::IterMut<'_, T>> {
        let end = self.items.len().min(Self::LIMIT);
        self.items.get_mut(self.len..end).map(<[T]>::iter_mut)
    }

    /// Keeps the next `count` places, which [`rest`](Arena::rest) has given.
    pub(crate) fn take(&mut self, count: usize) {
        self.len = (self.len + count).min(self.items.len());
    }

    /// The values so far.
    #[inline]
    pub(crate) fn as_slice(&self) -> &[T] {
        self.items.get(..self.len).unwrap_or(&[])
    }

    /// The value that was added last, to be changed.
    pub(crate) fn last_mut(&mut self) -> Option<&mut T> {
        self.items.get_mut(self.len.checked_sub(1)?)
    }

    /// The values so far, to be changed.
    #[inline]
    pub(crate) fn as_mut_slice(&mut self) -> &mut [T] {
        self.items.get_mut(..self.len).unwrap_or(&mut [])
    }
}

#[cfg(test)]
mod tests {
    use super::Arena;

    #[test]
    fn fills_and_refuses() {
        let mut memory = [0; 2];
        let mut arena = Arena::new(&mut memory);
        assert_eq!(arena.push(5), Some(0));
        assert_eq!(arena.push(6), Some(1));
        assert_eq!(arena.push(7), None);
        assert_eq!(arena.as_slice(), [5, 6]);
        arena.truncate(1);
        arena.truncate(2);
        assert_eq!((arena.len(), arena.as_slice()), (1, &[5][..]));
        assert_eq!(arena.append(2), None);
        assert_eq!(arena.append(1).map(|new| new.len()), Some(1));
        assert_eq!(arena.len(), 2);
        arena.clear();
        assert!(arena.as_slice().is_empty());
    }

    /// Kills: places beyond those that indices have.
    #[test]
    fn is_no_longer_than_indices_reach() {
        let mut memory = [(); Arena::<()>::LIMIT + 2];
        let mut arena = Arena::new(&mut memory);
        let last = (0..Arena::<()>::LIMIT).map_while(|_| arena.push(())).last();
        assert_eq!((last, arena.push(())), (Some(u16::MAX), None));
        assert_eq!(arena.append(1), None);
        assert_eq!(arena.len(), 1 << 16);
    }
}
