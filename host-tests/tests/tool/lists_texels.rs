//! Textures of lists: the form of the fewest bytes.

use host_tests::image_out::Frame;
use host_tests::lists::texels::*;
use scanbeam::list::TexelForm;

fn picture(side: u32, pixel: impl Fn(u32, u32) -> [u8; 3]) -> Picture {
    let pixel = &pixel;
    let rgb = (0..side).flat_map(|y| (0..side).flat_map(move |x| pixel(x, y)));
    let frame = Frame::new(side, side, rgb.collect()).expect("the size is legal");
    Picture::new(&frame).expect("it is a picture")
}

/// The texels as the core reads them.
fn shown(texels: &Texels) -> Vec<[u8; 3]> {
    let [w, h] = texels.log_sides;
    let read = scanbeam::list::Texels::new(&texels.words, texels.form, &texels.palette);
    (0..1 << (w + h))
        .map(|i| {
            let [r, g, b, _] = read.rgba(i);
            [r, g, b]
        })
        .collect()
}

fn error(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    let sum: u64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| u64::from(squared(*a, *b)))
        .sum();
    (sum as f64 / (3 * a.len()) as f64).sqrt()
}

#[test]
fn few_colours_are_kept_exactly_in_few_bits() {
    for (colours, form) in [
        (1u32, TexelForm::Index1),
        (2, TexelForm::Index1),
        (3, TexelForm::Index2),
        (5, TexelForm::Index4),
        (16, TexelForm::Index4),
        (17, TexelForm::Index8),
        (256, TexelForm::Index8),
    ] {
        let colour = |n: u32| [n as u8, (n * 7) as u8, (n * 31) as u8];
        let made = picture(64, |x, y| colour((x * 3 + y * 64 + x * y) % colours));
        let texels = Texels::new(&made, 0.0);
        assert_eq!((texels.form, texels.error), (form, 0.0), "{colours}");
        let full: Vec<_> = (0..64 * 64u32)
            .map(|i| colour((i % 64 * 3 + i / 64 * 64 + i % 64 * (i / 64)) % colours))
            .collect();
        assert_eq!(shown(&texels), full, "{colours}");
        assert_eq!(texels.bytes(), bytes(form, 4096, texels.palette.len()));
    }
}

#[test]
fn the_error_is_what_is_said_and_more_of_it_takes_fewer_bytes() {
    // Two ramps and a hue that turns: thousands of colours.
    let pixel = |x: u32, y: u32| [(x * 2) as u8, (y * 2) as u8, (x ^ y) as u8];
    let made = picture(128, pixel);
    let full: Vec<_> = (0..128 * 128).map(|i| pixel(i % 128, i / 128)).collect();
    let mut last = usize::MAX;
    let mut forms = Vec::new();
    for allowed in [0.0, 3.0, 12.0, 20.0, 35.0, 60.0] {
        let texels = Texels::new(&made, allowed);
        assert!(texels.error <= allowed, "{} > {allowed}", texels.error);
        assert!((error(&shown(&texels), &full) - texels.error).abs() < 1e-9);
        assert!(texels.bytes() <= last);
        last = texels.bytes();
        forms.push(texels.form);
    }
    assert_eq!(
        forms,
        [
            TexelForm::Rgb888,
            TexelForm::Rgb565,
            TexelForm::Index8,
            TexelForm::Index4,
            TexelForm::Index2,
            TexelForm::Index1,
        ]
    );
    // Better than a lattice of 6 colours a channel, whose steps of 51 are off by a root of
    // 51^2 / 12.
    let eight = Texels::new(&made, 51.0 / 12f64.sqrt());
    assert_eq!(eight.form, TexelForm::Index8);
}
