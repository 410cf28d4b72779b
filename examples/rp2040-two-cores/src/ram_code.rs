//! Copies the section `.ramcode` of `memory.x` from flash to RAM before anything else runs.

core::arch::global_asm!(
    ".section .text.__pre_init",
    ".global __pre_init",
    ".type __pre_init, %function",
    ".thumb_func",
    "__pre_init:",
    "ldr r0, =__sramcode",
    "ldr r1, =__eramcode",
    "ldr r2, =__siramcode",
    "b 2f",
    "1: ldm r2!, {{r3}}",
    "stm r0!, {{r3}}",
    "2: cmp r0, r1",
    "blo 1b",
    "bx lr",
);
