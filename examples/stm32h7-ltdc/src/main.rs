//! An STM32H743 turns a teapot on an RGB panel of 320x240 pixels, which its LTDC feeds from memory.
//!
//! There are two frames: one is shown while the next is drawn into the other, and they change places
//! in the vertical blank. Pixels are in the processor's order, and go through no bus that waits. The
//! data cache is off; a firmware that switches it on has to clean a frame before it is shown.
//!
//! Panel: 6.4 MHz pixel clock, 408 x 262 clocks a frame, all syncs active low, as panels of this size
//! commonly want. Pins: CLK PE14, DE PE13, HSYNC PC6, VSYNC PA4, red PB0 PA5 PA12 PB1 PE15,
//! green PA6 PE11 PB10 PB11 PC7 PD3, blue PD10 PE12 PA3 PB8 PB9, the lowest bit first.
#![no_std]
#![no_main]

use embedded_display_controller::{
    DisplayConfiguration, DisplayController, DisplayControllerLayer, PixelFormat,
};
use panic_halt as _;
use scanbeam::pixel::{PixelFormat as _, Rgb565};
use scanbeam::scan_out::{Blocking, FrameBuffer, Pump, SwapFlag};
use scanbeam::{frame::draw_frame, look::Gouraud};
use spinner::{BACKGROUND, HEIGHT, TURN, WIDTH, lend};
use stm32h7xx_hal::gpio::Speed;
use stm32h7xx_hal::{ltdc::Ltdc, pac, prelude::*};

type Look = Gouraud<Rgb565>;

const PANEL: DisplayConfiguration = DisplayConfiguration {
    active_width: WIDTH as u16,
    active_height: HEIGHT as u16,
    h_sync: 30,
    h_back_porch: 38,
    h_front_porch: 20,
    v_sync: 3,
    v_back_porch: 15,
    v_front_porch: 4,
    h_sync_pol: false,
    v_sync_pol: false,
    not_data_enable_pol: false,
    pixel_clock_pol: false,
};

static SWAP: SwapFlag = SwapFlag::new();

/// Gives pins to the LTDC, each by its alternate function.
macro_rules! to_ltdc {
    ($($port:ident . $pin:ident $function:literal),* $(,)?) => {
        $($port.$pin.into_alternate::<$function>().speed(Speed::VeryHigh);)*
    };
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let chip = pac::Peripherals::take().expect("main runs once");
    let power = chip.PWR.constrain().freeze();
    let rcc = chip.RCC.constrain().sys_ck(400.MHz()).pll3_p_ck(64.MHz()).pll3_r_ck(6_400.kHz());
    let ccdr = rcc.freeze(power, &chip.SYSCFG);
    let has = ccdr.peripheral;
    let (a, b) = (chip.GPIOA.split(has.GPIOA), chip.GPIOB.split(has.GPIOB));
    let (c, d) = (chip.GPIOC.split(has.GPIOC), chip.GPIOD.split(has.GPIOD));
    let e = chip.GPIOE.split(has.GPIOE);
    to_ltdc!(e.pe14 14, e.pe13 14, c.pc6 14, a.pa4 14);
    to_ltdc!(b.pb0 9, a.pa5 14, a.pa12 14, b.pb1 9, e.pe15 14);
    to_ltdc!(a.pa6 14, e.pe11 14, b.pb10 14, b.pb11 14, c.pc7 14, d.pd3 14);
    to_ltdc!(d.pd10 14, e.pe12 14, a.pa3 14, b.pb8 14, b.pb9 14);

    let frames = [lend!(u16, WIDTH * HEIGHT, 0), lend!(u16, WIDTH * HEIGHT, 0)];
    let places = frames.each_ref().map(|frame| frame.as_ptr());
    let mut ltdc = Ltdc::new(chip.LTDC, has.LTDC, &ccdr.clocks);
    ltdc.init(PANEL);
    let mut layer = ltdc.split();
    // SAFETY: the frame is lent for ever, and has all the pixels of the panel.
    unsafe { layer.enable(places[SWAP.shown()], PixelFormat::RGB565) };

    let frames = FrameBuffer::new(frames, WIDTH as u16, HEIGHT as u16, &SWAP);
    let lines = [lend!(u16, WIDTH, 0), lend!(u16, WIDTH, 0)];
    let mut pump = Pump::new(Blocking::over(frames), lines);
    let (mut scene, mut renderer) = (spinner::scene!(Look), spinner::renderer!(Look));
    for turn in (0..TURN).cycle() {
        spinner::build(&mut scene, turn);
        let background = Rgb565::from_rgb8(BACKGROUND);
        let sent = draw_frame(&scene, &mut renderer, &mut pump, background, 1);
        sent.expect("the frames are as large as the panel");
        // SAFETY: as above. Nothing is drawn until the frames have changed places.
        unsafe { layer.swap_framebuffer(places[1 - SWAP.shown()]) };
        while layer.is_swap_pending() {}
        SWAP.vertical_blank();
        spinner::count_frame();
    }
    unreachable!("it turns for ever")
}
