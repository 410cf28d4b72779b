//! What is left of the regions of `memory.x`, lent piece by piece to a scene whose size only the host knows.

use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, Ordering};

unsafe extern "C" {
    static mut _fast_rest: MaybeUninit<u8>;
    static mut _fast_limit: MaybeUninit<u8>;
    static mut _dma_rest: MaybeUninit<u8>;
    static mut _dma_limit: MaybeUninit<u8>;
    static mut _slow_rest: MaybeUninit<u8>;
    static mut _slow_limit: MaybeUninit<u8>;
}

/// What is left of a region.
pub(crate) struct Rest {
    free: &'static mut [MaybeUninit<u8>],
    /// Bytes that were lent.
    pub(crate) lent: usize,
}

/// What is left of all regions.
pub(crate) struct Regions {
    /// Tightly coupled RAM.
    pub(crate) fast: Rest,
    /// RAM that a DMA can reach.
    pub(crate) dma: Rest,
    /// External RAM.
    pub(crate) slow: Rest,
}

impl Regions {
    /// Takes them, once.
    pub(crate) fn take() -> Self {
        static TAKEN: AtomicBool = AtomicBool::new(false);
        assert!(!TAKEN.load(Ordering::Relaxed), "taken twice");
        TAKEN.store(true, Ordering::Relaxed);
        // SAFETY: the linker puts each pair around RAM that no section has, and this is done once, before anything else
        // could be: nothing that interrupts takes regions.
        unsafe {
            Self {
                fast: Rest::between(&raw mut _fast_rest, &raw mut _fast_limit),
                dma: Rest::between(&raw mut _dma_rest, &raw mut _dma_limit),
                slow: Rest::between(&raw mut _slow_rest, &raw mut _slow_limit),
            }
        }
    }
}

impl Rest {
    /// # Safety
    /// What is between them must be RAM of nobody else, from now on.
    unsafe fn between(start: *mut MaybeUninit<u8>, end: *mut MaybeUninit<u8>) -> Self {
        let bytes = (end as usize).saturating_sub(start as usize);
        Self {
            // SAFETY: as the caller says; bytes need not have values.
            free: unsafe { core::slice::from_raw_parts_mut(start, bytes) },
            lent: 0,
        }
    }

    /// Lends so many values, each made by `make`.
    pub(crate) fn lend<T>(&mut self, count: usize, make: impl Fn() -> T) -> &'static mut [T] {
        let free = core::mem::take(&mut self.free);
        let gap = free.as_ptr().align_offset(align_of::<T>());
        let bytes = count.checked_mul(size_of::<T>());
        let end = bytes.and_then(|bytes| bytes.checked_add(gap));
        let end = end.filter(|end| *end <= free.len());
        let (own, rest) = free.split_at_mut(end.expect("the host has seen that it is enough"));
        self.free = rest;
        self.lent += own.len();
        let own = own[gap..].as_mut_ptr().cast::<MaybeUninit<T>>();
        // SAFETY: the pointer is aligned to `T`, and what it points to are `count` of them, of nobody else for ever.
        let own = unsafe { core::slice::from_raw_parts_mut(own, count) };
        for slot in own.iter_mut() {
            slot.write(make());
        }
        // SAFETY: all were written just now.
        unsafe { &mut *(core::ptr::from_mut(own) as *mut [T]) }
    }

    /// One value.
    pub(crate) fn one<T>(&mut self, make: impl Fn() -> T) -> &'static mut T {
        self.lend(1, make).first_mut().expect("it is one")
    }
}
