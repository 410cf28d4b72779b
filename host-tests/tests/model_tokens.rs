//! Tokens survive the wires, bit by bit, and what is no token is refused (K13).

use crate::common::Rng;
use scanbeam_model::{
    Argb10, CHARTS, Chart, GlobalMode, ParameterSetup, PixelToken, StartDma, Target, Token,
    TokenBits, TokenError, ZSetup,
};

fn bits(rng: &mut Rng, width: u32) -> u64 {
    let word = u64::from(rng.below(1 << 20)) << 40
        ^ u64::from(rng.below(1 << 20)) << 20
        ^ u64::from(rng.below(1 << 20));
    word & ((1 << width) - 1)
}

fn flag(rng: &mut Rng) -> bool {
    rng.below(2) == 1
}

/// A token of any kind, every field random within its width.
fn token(rng: &mut Rng) -> Token {
    let pixel = |rng: &mut Rng| {
        let [a, r, g, b] = [(); 4].map(|()| bits(rng, 10) as u16);
        PixelToken {
            x: bits(rng, 11) as u16,
            w: bits(rng, 12) as u16,
            colour: Argb10 { a, r, g, b },
            force_additive: flag(rng),
        }
    };
    let ends = |rng: &mut Rng| ParameterSetup {
        left: bits(rng, 36),
        right: bits(rng, 36),
    };
    let target = Target {
        rgb: flag(rng),
        z: flag(rng),
    };
    match rng.below(14) {
        0 => Token::Null,
        1 => Token::Pixel(pixel(rng)),
        2 => Token::Overlay(pixel(rng)),
        3 => Token::ZSetup(ZSetup {
            z0: bits(rng, 32) as u32,
            z1: bits(rng, 32) as u32,
            diffuse: flag(rng),
            front: flag(rng),
        }),
        4 => Token::DiffuseSetup(ends(rng)),
        5 => Token::SpecularSetup(ends(rng)),
        6 => Token::NormalSetup(ends(rng)),
        7 => Token::ParameterSetup(5 + rng.below(11) as u8, ends(rng)),
        8 => Token::LoadWriteRegister(target, bits(rng, 40)),
        9 => Token::StartDma(StartDma {
            target,
            start: bits(rng, 11) as u16,
            length: bits(rng, 11) as u16,
            scanout_enable: flag(rng),
            round: flag(rng),
            write_enable: flag(rng),
        }),
        10 => Token::WaitDma(target),
        11 => Token::Swap(target),
        12 => Token::GlobalMode(GlobalMode {
            diffuse_shade: flag(rng),
            specular_shade: flag(rng),
            shadow_count: flag(rng),
            shadow_test: flag(rng),
            additive: flag(rng),
            control_flags: rng.below(4) as u8,
            invert_shadow: flag(rng),
            force_z_visible: flag(rng),
            disable_z_write: flag(rng),
        }),
        _ => Token::Jam(bits(rng, 40)),
    }
}

#[test]
fn every_token_comes_back() {
    let mut rng = Rng::new(11);
    for _ in 0..200_000 {
        let token = token(&mut rng);
        let wires = token.encode();
        assert_eq!(Token::decode(wires), Ok(token), "{wires:?}");
        assert_eq!(TokenBits::new(wires.get()), Some(wires));
    }
}

#[test]
fn any_bits_are_one_token_or_refused() {
    let mut rng = Rng::new(12);
    let mut kinds = [0u32; 4];
    for i in 0..400_000u32 {
        let mut wires = u128::from(bits(&mut rng, 60)) << 17 | u128::from(bits(&mut rng, 17));
        if i % 2 == 0 {
            // Mostly empty, so that reserved bits are often 0.
            wires &= u128::from(rng.below(2)) << 76 | 0xF << 72 | 0xFF << 64 | 1 << rng.below(64);
        }
        let wires = TokenBits::truncated(wires);
        match Token::decode(wires) {
            Ok(token) => {
                kinds[0] += 1;
                let again = token.encode();
                match token {
                    // What these do not look at is not kept.
                    Token::Null => assert_eq!(wires.id(), 0),
                    Token::Jam(data) => assert_eq!(again.field(37, 40), data),
                    _ => assert_eq!(again, wires),
                }
            }
            Err(TokenError::Id { setup, id }) => {
                kinds[1] += 1;
                assert!(if setup {
                    id == 0
                } else {
                    (3..15).contains(&id)
                });
            }
            Err(TokenError::OpCode(op)) => {
                kinds[2] += 1;
                assert!(op == 0 || op > 6);
                assert_eq!((wires.is_setup(), wires.id()), (false, 15));
            }
            Err(TokenError::Reserved) => {
                kinds[3] += 1;
                assert!(Chart::of(wires).is_some());
            }
        }
    }
    assert!(kinds.iter().all(|count| *count > 1_000), "{kinds:?}");
}

/// The fields as the charts have them are those that encoding fills: the tables and the code
/// were written apart.
#[test]
fn fields_stand_where_their_chart_has_them() {
    let mut seen = String::new();
    let mut rng = Rng::new(13);
    for _ in 0..20_000 {
        let token = token(&mut rng);
        let wires = token.encode();
        let Some(chart) = Chart::of(wires) else {
            assert!(matches!(token, Token::Null | Token::ParameterSetup(..)));
            continue;
        };
        let values: Vec<u64> = chart.values(wires).map(|(_, value)| value).collect();
        let flag = u64::from;
        let targets = |t: Target| vec![flag(t.rgb), flag(t.z)];
        let nine = |s: ParameterSetup| {
            let fields = |word: u64| [27, 18, 9, 0].map(|down| word >> down & 0x1FF);
            [fields(s.left), fields(s.right)].concat()
        };
        let (letter, expected): (char, Vec<u64>) = match token {
            Token::Pixel(p) | Token::Overlay(p) => {
                let Argb10 { a, r, g, b } = p.colour;
                let additive = u16::from(p.force_additive);
                let (letter, [c0, c1, c2, c3]) = match token {
                    Token::Pixel(_) => ('A', [a, r, g, b]),
                    _ => ('B', [r, g, b, a]),
                };
                let all = [p.x, p.w, c0, c1, c2, c3, additive];
                (letter, all.map(u64::from).to_vec())
            }
            Token::ZSetup(s) => (
                'C',
                vec![s.z0.into(), flag(s.diffuse), flag(s.front), s.z1.into()],
            ),
            Token::DiffuseSetup(s) => ('D', nine(s)),
            Token::SpecularSetup(s) => ('E', nine(s)),
            Token::NormalSetup(s) => {
                let fields = |word: u64| [24, 12, 0].map(|down| word >> down & 0xFFF);
                ('F', [fields(s.left), fields(s.right)].concat())
            }
            Token::LoadWriteRegister(t, value) => ('G', [targets(t), vec![value]].concat()),
            Token::StartDma(s) => {
                let rest = vec![
                    s.start.into(),
                    s.length.into(),
                    flag(s.scanout_enable),
                    flag(s.round),
                    flag(s.write_enable),
                ];
                ('H', [targets(s.target), rest].concat())
            }
            Token::WaitDma(t) => ('I', targets(t)),
            Token::Swap(t) => ('J', targets(t)),
            Token::GlobalMode(m) => (
                'K',
                vec![
                    flag(m.diffuse_shade),
                    flag(m.specular_shade),
                    flag(m.shadow_count),
                    flag(m.shadow_test),
                    flag(m.additive),
                    m.control_flags.into(),
                    flag(m.invert_shadow),
                    flag(m.force_z_visible),
                    flag(m.disable_z_write),
                ],
            ),
            Token::Jam(data) => ('L', vec![data]),
            Token::Null | Token::ParameterSetup(..) => unreachable!("they have no chart"),
        };
        assert_eq!((chart.letter, values), (letter, expected), "{token:?}");
        if !seen.contains(letter) {
            seen.push(letter);
        }
    }
    assert_eq!(seen.len(), CHARTS.len(), "{seen}");
}

#[test]
fn a_token_reads_like_its_chart() {
    let pixel = Token::Pixel(PixelToken {
        x: 1,
        ..PixelToken::default()
    });
    // 0 0001 00000000001 and nothing more.
    assert_eq!(pixel.encode().get(), 1 << 72 | 1 << 61);
    let swap = Token::Swap(Target::Z).encode();
    assert_eq!(swap.get(), 0xF << 72 | 4 << 64 | 1 << 62);
    let unknown = TokenBits::truncated(0xF << 72 | 7 << 64);
    assert_eq!(Token::decode(unknown), Err(TokenError::OpCode(7)));
    assert_eq!(
        TokenError::OpCode(7).to_string(),
        "no control token has the op-code 7"
    );
}
