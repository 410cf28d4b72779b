//! Overlays of lists that are played: what is painted of every form (K14).

use crate::common::Rng;
use crate::listing::PLENTY;
use crate::played::{HEIGHT, Kept, WIDTH, drawn, played};
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{Halt, Overlay, OverlaySlot, Palette, State, TexelForm};
use scanbeam::look::Gouraud;
use scanbeam::overlay::ListOverlays;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb888};

type Smooth = Gouraud<Rgb565Be>;

/// The field of some bits from a place in a run of words, bit by bit.
fn bits(words: &[u32], from: usize, count: usize) -> u32 {
    (0..count).fold(0, |v, k| {
        let at = from + k;
        v | (words[at / 32] >> (at % 32) & 1) << k
    })
}

/// An overlay, its words, and the colours that its palette's number has then.
struct Sheet {
    block: Overlay,
    words: Vec<u32>,
    colours: Vec<u32>,
}

impl Sheet {
    fn rgba(&self, x: usize, y: usize) -> [u8; 4] {
        let each = self.block.form.bits() as usize;
        let v = bits(
            &self.words,
            (y * usize::from(self.block.width) + x) * each,
            each,
        );
        let grown = |v: u32, bits: u32| (v << (8 - bits) | v >> (2 * bits - 8)) as u8;
        match self.block.form {
            TexelForm::Rgb565 => [
                grown(v >> 11, 5),
                grown(v >> 5 & 63, 6),
                grown(v & 31, 5),
                255,
            ],
            TexelForm::Rgb888 => [v as u8, (v >> 8) as u8, (v >> 16) as u8, 255],
            TexelForm::Rgba => {
                // 7 bits of alpha: nothing only where all are 0.
                let alpha = if v >> 24 & 0x7F == 0 { 0 } else { 1 };
                [v as u8, (v >> 8) as u8, (v >> 16) as u8, alpha]
            }
            TexelForm::Rgba5551 | TexelForm::Rgbd5551 => {
                let five = |down: u32| grown(v >> down & 31, 5);
                let is_seen = self.block.form == TexelForm::Rgbd5551 || v & 1 != 0;
                [five(11), five(6), five(1), u8::from(is_seen)]
            }
            TexelForm::Index6 => self.colour(v & 63),
            _ => self.colour(v),
        }
    }

    fn colour(&self, n: u32) -> [u8; 4] {
        let colour = self.colours.get(n as usize);
        colour.map_or([0; 4], |c| c.to_le_bytes())
    }
}

fn overlaid<F: PixelFormat>(seed: u64) -> u32
where
    F::Word: PartialEq + std::fmt::Debug,
{
    let mut rng = Rng::new(seed);
    let any = |rng: &mut Rng| rng.below(1 << 16) << 16 | rng.below(1 << 16);
    let mut memory = vec![0; 1 << 15];
    let mut writer = ListWriter::new(&mut memory);
    let mut palettes: [Vec<u32>; 2] = [vec![], vec![]];
    let mut sheets: Vec<Sheet> = Vec::new();
    for _ in 0..1 + rng.below(6) {
        for (number, colours) in palettes.iter_mut().enumerate() {
            if colours.is_empty() || rng.below(2) == 0 {
                *colours = (0..1 + rng.below(256)).map(|_| any(&mut rng)).collect();
                // Some let the picture through.
                colours.iter_mut().step_by(3).for_each(|c| *c &= 0xFF_FFFF);
                let palette = Palette {
                    number: number as u8,
                    count: colours.len() as u16,
                    at: 0,
                };
                writer.bulk(&State::Palette(palette), colours).unwrap();
            }
        }
        let palette = rng.below(2) as u8;
        let block = Overlay {
            left: rng.below(u32::from(WIDTH) + 9) as u16,
            top: rng.below(u32::from(HEIGHT) + 9) as u16,
            width: 1 + rng.below(40) as u16,
            height: 1 + rng.below(40) as u16,
            form: rng.pick(&TexelForm::ALL),
            additive: rng.below(2) == 0,
            palette,
            at: 0,
        };
        let words: Vec<u32> = (0..block.words()).map(|_| any(&mut rng)).collect();
        writer.bulk(&State::Overlay(block), &words).unwrap();
        sheets.push(Sheet {
            block,
            words,
            colours: palettes[usize::from(palette)].clone(),
        });
    }
    let list = writer.words().to_vec();
    let list: &'static [u32] = Vec::leak(list);
    let slots: &'static [OverlaySlot] = Vec::leak((0..6).map(|_| OverlaySlot::new()).collect());
    let kept = Box::leak(Box::new(Kept::new(4, 4)));
    let mut player = kept.player_over::<Smooth>(PlayerSettings::default(), slots);
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    });
    let over = ListOverlays { words: list, slots };
    let mut painted = 0;
    for line in 0..HEIGHT {
        let mut got: Vec<F::Word> = (0..WIDTH)
            .map(|_| F::from_rgb8([0; 3].map(|_: u8| rng.below(256) as u8)))
            .collect();
        let mut want = got.clone();
        over.paint::<F>(line, &mut got);
        for sheet in &sheets {
            for (x, pixel) in (0..).zip(&mut want) {
                let (left, top) = (sheet.block.left, sheet.block.top);
                let within = (left..left + sheet.block.width).contains(&x)
                    && (top..top + sheet.block.height).contains(&line);
                if !within {
                    continue;
                }
                let [r, g, b, a] = sheet.rgba(usize::from(x - left), usize::from(line - top));
                let word = F::from_rgb8([r, g, b]);
                if a > 0 {
                    *pixel = if sheet.block.additive {
                        F::add(*pixel, word)
                    } else {
                        word
                    };
                    painted += 1;
                }
            }
        }
        assert_eq!(got, want, "seed {seed}, line {line}");
    }
    painted
}

#[test]
fn overlays_of_lists_are_painted_as_they_say() {
    let painted: u32 = (0..60)
        .map(|seed| overlaid::<Rgb888>(seed) + overlaid::<Rgb565>(1000 + seed))
        .sum();
    assert!(painted > 30_000, "{painted}");
}
