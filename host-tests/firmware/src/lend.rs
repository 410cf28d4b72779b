//! Memory of a region of `memory.x`, lent once.

/// Lends `[$element; $len]` from the section `$section`, every element set to `$value`, as a
/// `&'static mut` slice. Each place in the source can lend once; a second time stops the
/// processor, without the code of a panic, of which the small programs have none.
macro_rules! lend {
    ($section:literal, $element:ty, $len:expr, $value:expr) => {{
        use core::{
            mem::MaybeUninit,
            ptr,
            sync::atomic::{AtomicBool, Ordering},
        };
        type Room = [MaybeUninit<$element>; $len];
        // Beside the room, not in it: the sections are not cleared at start-up.
        static TAKEN: AtomicBool = AtomicBool::new(false);
        #[unsafe(link_section = $section)]
        static mut ROOM: Room = [const { MaybeUninit::uninit() }; $len];
        // Not swap: ARMv6-M has none.
        let taken = cortex_m::interrupt::free(|_| {
            let taken = TAKEN.load(Ordering::Relaxed);
            TAKEN.store(true, Ordering::Relaxed);
            taken
        });
        if taken {
            cortex_m::asm::udf();
        }
        // SAFETY: `TAKEN` lets one caller ever come here, so this is the only reference.
        let room: &'static mut Room = unsafe { &mut *(&raw mut ROOM) };
        // A length that the compiler does not know, and a loop kept rolled: it would write out dozens of rounds.
        for element in core::hint::black_box(&mut room[..]) {
            element.write($value);
            core::hint::black_box(());
        }
        // SAFETY: every element was written just above.
        let lent: &'static mut [$element] =
            unsafe { &mut *(ptr::from_mut::<[MaybeUninit<$element>]>(room) as *mut [$element]) };
        lent
    }};
}

pub(crate) use lend;
