//! The pipeline behind stage one does with tokens what the device does (K8-K14).

use scanbeam_model::{
    Argb10, GlobalMode, Output, ParameterSetup, Pipe, PipeMemory, PixelToken, SpanWeight, StartDma,
    Target, Token, ZSetup, lirp,
};

const WIDTH: usize = 16;
const BLACK: Argb10 = Argb10 {
    a: 1023,
    r: 0,
    g: 0,
    b: 0,
};

/// Lines of memory for a pipeline.
#[derive(Default)]
struct Lines([[u64; WIDTH]; 4]);

impl Lines {
    fn pipe(&mut self) -> Pipe<'_> {
        let [z0, z1, c0, c1] = &mut self.0;
        Pipe::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        })
    }
}

/// Sends tokens over the wires and gathers what comes out.
fn send(pipe: &mut Pipe<'_>, tokens: impl IntoIterator<Item = Token>) -> Vec<Output> {
    let mut out = Vec::new();
    for token in tokens {
        pipe.bits(token.encode(), &mut |o| out.push(o)).unwrap();
    }
    out
}

fn start(target: Target, scanout_enable: bool, write_enable: bool) -> Token {
    Token::StartDma(StartDma {
        target,
        start: 0,
        length: WIDTH as u16,
        scanout_enable,
        round: true,
        write_enable,
    })
}

/// Clears both lines of both units and sets the mode.
fn clear(pipe: &mut Pipe<'_>, mode: GlobalMode) {
    let both = Target::BOTH;
    let fill = start(both, false, true);
    let out = send(
        pipe,
        [
            Token::GlobalMode(mode),
            Token::LoadWriteRegister(Target::Z, 0xFF_FFFF_FF00),
            Token::LoadWriteRegister(Target::RGB, BLACK.to_word()),
            fill,
            Token::Swap(both),
            fill,
            Token::WaitDma(both),
        ],
    );
    assert_eq!(out, []);
}

const SHADED: GlobalMode = GlobalMode {
    diffuse_shade: true,
    specular_shade: false,
    shadow_count: false,
    shadow_test: false,
    additive: false,
    control_flags: 0,
    invert_shadow: false,
    force_z_visible: false,
    disable_z_write: false,
};

fn argb9(fields: [u64; 4]) -> u64 {
    fields.iter().fold(0, |word, field| word << 9 | field)
}

/// A span over `from .. to` pixels between two depths and two colours of 9 bits.
fn span(from: u16, to: u16, z: [u32; 2], colours: [[u64; 4]; 2]) -> Vec<Token> {
    let weight = SpanWeight::new(8 * (to - from));
    let mut tokens = vec![
        Token::ZSetup(ZSetup {
            z0: z[0],
            z1: z[1],
            ..ZSetup::default()
        }),
        Token::DiffuseSetup(ParameterSetup {
            left: argb9(colours[0]),
            right: argb9(colours[1]),
        }),
    ];
    tokens.extend((from..to).map(|x| {
        Token::Pixel(PixelToken {
            x,
            w: weight.at(8 * (x - from) + 4),
            ..PixelToken::default()
        })
    }));
    tokens
}

/// Swaps and scans out the line that was drawn.
fn scan_out(pipe: &mut Pipe<'_>) -> Vec<[u8; 4]> {
    let tokens = [
        Token::Swap(Target::BOTH),
        start(Target::Z, false, true),
        start(Target::RGB, true, true),
        Token::WaitDma(Target::BOTH),
    ];
    pixels(&send(pipe, tokens))
}

fn pixels(out: &[Output]) -> Vec<[u8; 4]> {
    let pixels: Vec<_> = out
        .iter()
        .map(|output| match output {
            Output::Pixel { x, argb } => (*x, *argb),
            Output::Data(data) => panic!("{data:x}"),
        })
        .collect();
    assert!(pixels.iter().zip(0..).all(|((x, _), i)| *x == i));
    pixels.into_iter().map(|(_, argb)| argb).collect()
}

const OPAQUE: u64 = 511;
const OLD: [u8; 4] = [255, 0, 0, 0];

#[test]
fn a_span_is_drawn_from_end_to_end() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    let colours = [[OPAQUE, 0, 511, 100], [OPAQUE, 511, 0, 100]];
    send(&mut pipe, span(2, 10, [50; 2], colours));
    let line = scan_out(&mut pipe);
    assert_eq!(line.len(), WIDTH);
    for (x, argb) in line.into_iter().enumerate() {
        if !(2..10).contains(&x) {
            assert_eq!(argb, OLD, "{x}");
            continue;
        }
        // Eight pixels: centres at 1/16, 3/16 and so on.
        let part = (2 * (x as i32 - 2) + 1) * 255 / 16;
        let near = |level: u8, expected: i32| (i32::from(level) - expected).abs() <= 1;
        assert!(
            near(argb[1], part) && near(argb[2], 255 - part),
            "{x}: {argb:?}"
        );
        assert_eq!((argb[0], argb[3]), (255, 50), "{x}");
    }
    // What was sent is clear again, and so is the depth.
    send(&mut pipe, span(0, 1, [u32::MAX; 2], [[OPAQUE; 4]; 2]));
    let line = scan_out(&mut pipe);
    assert_eq!(line[0], [255; 4]);
    assert_eq!(line[1..], [OLD; WIDTH - 1]);
    assert_eq!(scan_out(&mut pipe), [OLD; WIDTH]);
}

#[test]
fn nearer_or_equal_wins_and_what_loses_is_null() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    let red = [[OPAQUE, 511, 0, 0]; 2];
    let green = [[OPAQUE, 0, 511, 0]; 2];
    let blue = [[OPAQUE, 0, 0, 511]; 2];
    send(&mut pipe, span(0, 8, [100; 2], red));
    // Equal: the later one.
    send(&mut pipe, span(4, 12, [100; 2], green));
    assert_eq!(pipe.counts().hidden, 0);
    // From in front to behind: the depths cross in the middle.
    send(&mut pipe, span(0, 8, [90, 110], blue));
    assert_eq!(pipe.counts().hidden, 4);
    let line = scan_out(&mut pipe);
    let expected = |x: usize| match x {
        0..4 => [255, 0, 0, 255],
        4..12 => [255, 0, 255, 0],
        _ => OLD,
    };
    assert!(
        line.iter().enumerate().all(|(x, p)| *p == expected(x)),
        "{line:?}"
    );
}

#[test]
fn modes_of_the_z_unit() {
    let near = [[OPAQUE, 511, 0, 0]; 2];
    let far = [[OPAQUE, 0, 511, 0]; 2];
    let red_over = |mode: GlobalMode| {
        let mut lines = Lines::default();
        let mut pipe = lines.pipe();
        clear(&mut pipe, mode);
        send(&mut pipe, span(0, 1, [10; 2], near));
        send(&mut pipe, span(0, 1, [20; 2], far));
        scan_out(&mut pipe)[0][1] == 255
    };
    assert!(red_over(SHADED));
    assert!(!red_over(GlobalMode {
        force_z_visible: true,
        ..SHADED
    }));
    // Depth is not kept, so everything is in front of the farthest.
    assert!(!red_over(GlobalMode {
        disable_z_write: true,
        ..SHADED
    }));
}

/// Draws one pixel over a red one.
fn composited(mode: GlobalMode, force_additive: bool, argb: [u64; 4]) -> Argb10 {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    let red = [OPAQUE, 400, 0, 200];
    send(&mut pipe, span(0, 1, [9; 2], [red; 2]));
    send(&mut pipe, [Token::GlobalMode(mode)]);
    let mut second = span(0, 1, [9; 2], [argb; 2]);
    if let Some(Token::Pixel(pixel)) = second.last_mut() {
        pixel.force_additive = force_additive;
    }
    send(&mut pipe, second);
    Argb10::from_word(lines.0[3][0])
}

fn ten(level: u64) -> u16 {
    (level << 1 | level >> 8) as u16
}

#[test]
fn opacity_additive_and_forced() {
    let additive = GlobalMode {
        additive: true,
        ..SHADED
    };
    let new = |a: u64| [a, 300, 511, 200];
    let red = |c: Argb10| (c.r, c.g, c.b);
    // Opaque replaces, in either mode.
    for mode in [SHADED, additive] {
        let opaque = red(composited(mode, false, new(OPAQUE)));
        assert_eq!(opaque, (ten(300), 1023, ten(200)));
    }
    // Forced, it is added all the same, and stops at full.
    let forced = red(composited(SHADED, true, new(OPAQUE)));
    assert_eq!(forced, (1023, 1023, 2 * ten(200)));
    // Clear leaves what is there.
    let clear = (ten(400), 0, ten(200));
    assert_eq!(red(composited(SHADED, false, new(0))), clear);
    assert_eq!(red(composited(additive, false, new(0))), clear);
    // Half.
    let half = u32::from(ten(255));
    let blend = |a: u16, b: u16| lirp(a.into(), b.into(), half, 10) as u16;
    let filtered = red(composited(SHADED, false, new(255)));
    let expected = (
        blend(ten(400), ten(300)),
        blend(0, 1023),
        blend(ten(200), ten(200)),
    );
    assert_eq!(filtered, expected);
    assert_eq!(filtered.2, ten(200));
    let added = red(composited(additive, false, new(255)));
    let sum = |old: u16, new: u16| (old + blend(0, new)).min(1023);
    let expected = (
        sum(ten(400), ten(300)),
        sum(0, 1023),
        sum(ten(200), ten(200)),
    );
    assert_eq!(added, expected);
}

#[test]
fn specular_colour_is_added_and_saturates() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    let mode = GlobalMode {
        specular_shade: true,
        ..SHADED
    };
    clear(&mut pipe, mode);
    let specular = ParameterSetup {
        left: argb9([40, 200, 200, 0]),
        right: argb9([40, 200, 200, 0]),
    };
    send(&mut pipe, [Token::SpecularSetup(specular)]);
    send(&mut pipe, span(0, 1, [1; 2], [[OPAQUE, 400, 0, 0]; 2]));
    let colour = Argb10::from_word(lines.0[3][0]);
    assert_eq!(
        (colour.a, colour.r, colour.g, colour.b),
        (1023, 1023, ten(200), 0)
    );
}

#[test]
fn overlays_go_over_everything() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    send(&mut pipe, span(0, 3, [0; 2], [[OPAQUE, 511, 0, 0]; 2]));
    let overlay = |x, force_additive| {
        Token::Overlay(PixelToken {
            x,
            w: 0,
            colour: Argb10 { g: 1023, ..BLACK },
            force_additive,
        })
    };
    // The third is beyond the line, and nowhere.
    send(
        &mut pipe,
        [overlay(0, false), overlay(1, true), overlay(2000, false)],
    );
    let line = scan_out(&mut pipe);
    let [opaque, added, below] = [line[0], line[1], line[2]];
    assert_eq!(opaque, [255, 0, 255, 0]);
    assert_eq!(added, [255, 255, 255, 0]);
    assert_eq!(below, [255, 255, 0, 0]);
}

#[test]
fn a_line_is_sent_while_the_next_is_drawn() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    let red = [[OPAQUE, 511, 0, 0]; 2];
    let green = [[OPAQUE, 0, 511, 0]; 2];
    send(&mut pipe, span(0, 16, [7; 2], red));
    let stalls = pipe.counts().stalls;
    let both = Target::BOTH;
    let sent = send(
        &mut pipe,
        [
            Token::Swap(both),
            start(Target::Z, false, true),
            start(Target::RGB, true, true),
        ],
    );
    assert_eq!(sent, [], "the first pixel comes with the next token");
    // The next line: its first ten tokens drive ten pixels out, red and whole.
    let next = span(0, 8, [7; 2], green);
    let out = pixels(&send(&mut pipe, next));
    assert_eq!(out, [[255, 255, 0, 0]; 10]);
    assert_eq!(pipe.counts().stalls, stalls, "nothing had to wait");
    // The swap waits for the six that are left: one leaves in its own clock.
    let out = send(&mut pipe, [Token::Swap(both)]);
    assert_eq!(out.len(), 6);
    assert_eq!(pipe.counts().stalls, stalls + 5);
    let out = send(
        &mut pipe,
        [start(Target::RGB, true, true), Token::WaitDma(Target::RGB)],
    );
    let line = pixels(&out);
    assert_eq!(line[..8], [[255, 0, 255, 0]; 8]);
    assert_eq!(line[8..], [OLD; 8]);
}

#[test]
fn dma_registers_do_what_they_say() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    // In 255ths these are 127.4, 254.8, 63.6 and 0.7.
    for (x, level) in [(0, 511), (1, 1022), (2, 255), (3, 3)] {
        let colour = Argb10 { r: level, ..BLACK };
        send(
            &mut pipe,
            [Token::Overlay(PixelToken {
                x,
                colour,
                ..PixelToken::default()
            })],
        );
    }
    let both = Target::BOTH;
    let dma = |start, length, round, write_enable| {
        [
            Token::StartDma(StartDma {
                target: Target::RGB,
                start,
                length,
                scanout_enable: true,
                round,
                write_enable,
            }),
            Token::WaitDma(Target::RGB),
        ]
    };
    let red = |out: Vec<Output>| -> Vec<(u16, u8)> {
        out.into_iter()
            .map(|output| match output {
                Output::Pixel { x, argb } => (x, argb[1]),
                Output::Data(_) => panic!("no data was sent"),
            })
            .collect()
    };
    send(&mut pipe, [Token::Swap(both)]);
    // A part, cut off, and not cleared; then rounded, and cleared; then it is clear.
    let cut = red(send(&mut pipe, dma(0, 4, false, false)));
    assert_eq!(cut, [(0, 127), (1, 255), (2, 63), (3, 0)]);
    let part = red(send(&mut pipe, dma(1, 3, true, true)));
    assert_eq!(part, [(1, 255), (2, 64), (3, 1)]);
    let rest = red(send(&mut pipe, dma(0, 4, true, true)));
    assert_eq!(rest, [(0, 128), (1, 0), (2, 0), (3, 0)]);
    // Beyond the line there is nothing, and a length of 0 is nothing.
    assert_eq!(red(send(&mut pipe, dma(14, 2047, true, true))).len(), 2);
    assert_eq!(red(send(&mut pipe, dma(3, 0, true, true))), []);
    assert_eq!(red(send(&mut pipe, dma(2047, 9, true, true))), []);
}

#[test]
fn jam_passes_and_the_z_unit_can_be_read() {
    let mut lines = Lines::default();
    let mut pipe = lines.pipe();
    clear(&mut pipe, SHADED);
    let data = 0x12_3456_789A;
    assert_eq!(send(&mut pipe, [Token::Jam(data)]), [Output::Data(data)]);
    send(&mut pipe, span(0, 1, [0xABCD_EF01; 2], [[OPAQUE; 4]; 2]));
    send(&mut pipe, [Token::Swap(Target::Z)]);
    let out = send(
        &mut pipe,
        [start(Target::Z, true, false), Token::WaitDma(Target::Z)],
    );
    assert_eq!(out[0], Output::Data(0xAB_CDEF_0100));
    assert_eq!(out[1], Output::Data(0xFF_FFFF_FF00));
    assert_eq!(out.len(), WIDTH);
}

#[test]
fn shadow_volumes_in_three_passes() {
    let draw = |invert_shadow: bool| {
        let mut lines = Lines::default();
        let mut pipe = lines.pipe();
        clear(&mut pipe, SHADED);
        let ambient = [[OPAQUE, 100, 0, 0]; 2];
        let lit = [[OPAQUE, 511, 0, 0]; 2];
        // First pass: the surface.
        send(&mut pipe, span(0, 12, [100; 2], ambient));
        // Second: a volume around pixels 4 to 7 (its back is behind the surface), and one
        // wholly in front of 8 to 11.
        let mode = GlobalMode {
            shadow_count: true,
            ..SHADED
        };
        send(&mut pipe, [Token::GlobalMode(mode)]);
        let side = |from, to, z, front| {
            let mut tokens = span(from, to, [z; 2], lit);
            tokens[0] = Token::ZSetup(ZSetup {
                z0: z,
                z1: z,
                diffuse: true,
                front,
            });
            tokens
        };
        send(&mut pipe, side(4, 8, 50, true));
        send(&mut pipe, side(4, 8, 150, false));
        send(&mut pipe, side(8, 12, 50, true));
        send(&mut pipe, side(8, 12, 60, false));
        // Third: where the surface is seen and not in shadow it is lit.
        let mode = GlobalMode {
            shadow_test: true,
            invert_shadow,
            ..SHADED
        };
        send(&mut pipe, [Token::GlobalMode(mode)]);
        send(&mut pipe, span(0, 12, [100; 2], lit));
        send(&mut pipe, span(0, 12, [99; 2], [[OPAQUE; 4]; 2]));
        let line = scan_out(&mut pipe);
        line.iter().map(|p| p[1] == 255).collect::<Vec<_>>()
    };
    let lit = |x: usize| x < 4 || (8..12).contains(&x);
    let plain: Vec<bool> = (0..WIDTH).map(lit).collect();
    assert_eq!(draw(false), plain);
    let inverted: Vec<bool> = (0..WIDTH).map(|x| (4..8).contains(&x)).collect();
    assert_eq!(draw(true), inverted);
}
