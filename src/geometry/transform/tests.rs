//! Maps against the same in f64, and units.

use super::*;
use crate::num::random::Rng;

fn value<const N: usize>(b: &Block<N>, i: usize) -> f64 {
    f64::from(b.mantissa[i]) * 2f64.powi(b.exponent - 30)
}

#[test]
fn then_composes_like_matrices() {
    let a = Affine::from_rows(
        [[1.0, 2.0, 3.0], [0.5, -1.0, 0.25], [4.0, 0.0, 1.0]],
        [1.0, 2.0, 3.0],
    )
    .unwrap();
    let b = Affine::from_rows(
        [[0.0, 1.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, 8.0]],
        [1000.0, -0.5, 0.0],
    )
    .unwrap();
    let c = a.then(&b);
    let linear = [0.5, -1.0, 0.25, -2.0, -4.0, -6.0, 32.0, 0.0, 8.0];
    for (i, want) in linear.into_iter().enumerate() {
        assert!((value(&c.linear, i) - want).abs() < 1e-7, "{i}");
    }
    for (i, want) in [1002.0, -2.5, 24.0].into_iter().enumerate() {
        assert!((value(&c.offset, i) - want).abs() < 1e-5, "{i}");
    }
    assert_eq!(a.then(&Affine::IDENTITY), a);
    assert_eq!(Affine::IDENTITY.then(&a), a);
}

#[test]
fn rotations_keep_lengths() {
    for i in 0..1000 {
        let angle = i as f32 * 0.0137;
        let r = Affine::rotation_z(angle);
        let (c, s) = (value(&r.linear, 0), value(&r.linear, 3));
        assert!((c * c + s * s - 1.0).abs() < 4e-9, "{angle}");
        let want = f64::from(angle);
        assert!(
            (c - want.cos()).abs() < 4e-9 && (s - want.sin()).abs() < 4e-9,
            "{angle}"
        );
    }
}

/// Against `f64`, which has the remainder of a turn of such angles from 1,100 bits of pi.
#[test]
fn rotations_by_any_angle_are_rotations() {
    let mut rng = Rng(11);
    let mut worst = 0f64;
    for i in 0..200_000 {
        let bits = if i % 2 == 0 {
            rng.bits()
        } else {
            // About 1 to 2^30.
            (rng.bits() & 0x80FF_FFFF) + ((120 + rng.bits() % 32) << 23)
        };
        let angle = f32::from_bits(bits);
        let turned = Affine::rotation_z(angle);
        if !angle.is_finite() {
            assert_eq!(turned, Affine::IDENTITY);
            continue;
        }
        let (c, s) = (value(&turned.linear, 0), value(&turned.linear, 3));
        assert!((c * c + s * s - 1.0).abs() < 4e-9, "{angle:e}");
        let (want_s, want_c) = f64::from(angle).sin_cos();
        let off = (s * want_c - c * want_s)
            .atan2(c * want_c + s * want_s)
            .abs();
        assert!(off < 4e-9, "{angle:e}: {off}");
        worst = worst.max(off);
    }
    std::println!("angles of any size: {worst:.2e} rad off at most");
    for angle in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(Affine::rotation_x(angle), Affine::IDENTITY);
        assert_eq!(Affine::rotation_y(angle), Affine::IDENTITY);
        assert_eq!(Affine::rotation_z(angle), Affine::IDENTITY);
    }
}

/// The linear part in f64, row by row.
fn rows(map: &Affine) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| value(&map.linear, 3 * i + k)))
}

fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| (0..3).map(|j| a[i][j] * b[j][k]).sum()))
}

fn apart(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    pairs.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()))
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// How far the rows are from unit vectors at right angles.
fn skew(m: &[[f64; 3]; 3]) -> f64 {
    let transposed = [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i]));
    apart(&product(m, &transposed), &IDENTITY)
}

fn determinant([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// M3, a million turns of a thousandth of a radian, the same ones over and over, which is
/// the worst case: errors of a step add up.
///
/// Bounds. A product rounds each entry by 2^-30 at most, so after n steps a chain is within
/// 3 n 2^-30 of the exact product of its own steps, times what these have grown to. A step's
/// entries are 2^-28.8 off: its skew is below 2^-27, and adds up to n 2^-27. With
/// `orthonormalised` the skew is below 2^-26 at any time, and between two calls that are k
/// steps apart below 2^-26 + k 2^-27.
#[test]
fn a_million_turns_drift_within_their_bounds() {
    const TURNS: u32 = 1_000_000;
    let turns = [
        Affine::rotation_y(0.001),
        Affine::rotation_x(-0.0007),
        Affine::rotation_z(0.0013),
    ];
    for turn in &turns {
        assert!(skew(&rows(turn)) < 2f64.powi(-27));
    }
    let cases: [&[Affine]; 2] = [&turns[..1], &turns];
    for steps in cases {
        let (mut plain, mut kept, mut seldom) = ([Affine::IDENTITY; 3]).into();
        let mut exact = IDENTITY;
        let (mut worst_kept, mut worst_seldom) = (0f64, 0f64);
        for (n, step) in (1..=TURNS).zip(steps.iter().cycle()) {
            plain = plain.then(step);
            exact = product(&rows(step), &exact);
            kept = kept.then(step).orthonormalised().unwrap();
            seldom = seldom.then(step);
            worst_kept = worst_kept.max(skew(&rows(&kept)));
            worst_seldom = worst_seldom.max(skew(&rows(&seldom)));
            if n % 100 == 0 {
                seldom = seldom.orthonormalised().unwrap();
            }
        }
        let growth = determinant(&exact).abs().max(1.0);
        let error = apart(&rows(&plain), &exact);
        let drift = skew(&rows(&plain));
        std::println!(
            "{} kinds of turn: chain {error:.2e} from the product of its steps; skew without \
             {drift:.2e}, determinant {:.6}; with, each step {worst_kept:.2e}, every 100 \
             {worst_seldom:.2e}, determinant 1 {:+.1e}",
            steps.len(),
            determinant(&rows(&plain)),
            determinant(&rows(&kept)) - 1.0,
        );
        let turns = f64::from(TURNS);
        assert!(error <= 3.0 * turns * 2f64.powi(-30) * growth, "{error}");
        assert!(drift <= turns * 2f64.powi(-27), "{drift}");
        assert!(worst_kept <= 2f64.powi(-26), "{worst_kept}");
        assert!(worst_seldom <= 2f64.powi(-26) + 100.0 * 2f64.powi(-27));
        assert!((determinant(&rows(&kept)) - 1.0).abs() <= 2f64.powi(-25));
    }
}

/// Any map: the result keeps lengths and angles and its first row's direction, and mirrors
/// where the map does; or the rows are too near to a line.
#[test]
fn any_map_can_be_made_orthonormal_unless_its_rows_are_parallel() {
    let mut rng = Rng(5);
    let mut made = 0;
    for i in 0..100_000 {
        let thin = [1.0, 1e-2, 1e-4, 1e-6][i % 4];
        let size = [1.0f32, 1e20, 1e-20][i / 4 % 3];
        let a = [(); 3].map(|()| rng.signed());
        let b = a.map(|c| c + thin * rng.signed());
        let c = [(); 3].map(|()| rng.signed());
        let map = Affine::from_rows([a, b, c].map(|r| r.map(|v| v * size)), [1.0, 2.0, 3.0]);
        let map = map.unwrap();
        let m = rows(&map);
        // The sine of the angle between the first two rows.
        let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let [a, b] = [m[0], m[1]].map(|r| r.map(|c| c / length(r)));
        let across = [(1, 2), (2, 0), (0, 1)].map(|(i, k)| a[i] * b[k] - a[k] * b[i]);
        let Some(unit) = map.orthonormalised() else {
            assert!(length(across) < 2f64.powi(-19), "{map:?}");
            continue;
        };
        made += 1;
        let u = rows(&unit);
        assert!(skew(&u) <= 2f64.powi(-26), "{map:?}: {u:?}");
        assert_eq!(unit.offset, map.offset);
        let scaled = m.map(|r| r.map(|v| v / f64::from(size)));
        let d = determinant(&scaled);
        // Of a flat map the sign is a matter of rounding.
        assert!(
            d.abs() < 1e-6 || (d < 0.0) == (determinant(&u) < 0.0),
            "{d}"
        );
        for k in 0..3 {
            assert!((a[k] - u[0][k]).abs() < 2f64.powi(-27), "{map:?}");
        }
    }
    assert!(made > 70_000, "{made}");
    // Kills: what is left of rows that are all but parallel is taken for a direction.
    let bent = [[1.0, 0.0, 0.0], [1.0, 2f32.powi(-22), 0.0], [0.0, 0.0, 1.0]];
    for rows in [[[0.0f32; 3]; 3], [[1.0, 0.0, 0.0]; 3], bent] {
        let map = Affine::from_rows(rows, [0.0; 3]).unwrap();
        assert_eq!(map.orthonormalised(), None);
    }
}

/// M3: matrices at the ends of their range. A chain of n maps errs by at most 3 n 2^-30 of
/// the product of their norms (largest row sums), whatever their magnitudes.
#[test]
fn chains_of_any_magnitude_keep_their_bound() {
    let mut rng = Rng(9);
    for _ in 0..20_000 {
        let mut chain = Affine::IDENTITY;
        let (mut exact, mut norm) = (IDENTITY, 1.0);
        for n in 1..=8 {
            let power = f64::from(rng.bits() % 180) - 85.0;
            let map = [(); 3].map(|()| [(); 3].map(|()| rng.signed() * 2f64.powf(power) as f32));
            let offset = [(); 3].map(|()| rng.signed());
            let map = Affine::from_rows(map, offset).unwrap();
            chain = chain.then(&map);
            let m = rows(&map);
            exact = product(&m, &exact);
            let sums = m.map(|r| r.iter().map(|v| v.abs()).sum::<f64>());
            norm *= sums.into_iter().fold(0.0, f64::max);
            let error = apart(&rows(&chain), &exact) / norm;
            assert!(error <= 3.0 * f64::from(n) * 2f64.powi(-30), "{n}: {error}");
        }
    }
}

/// Exponents stop where nothing can be seen any more, and never overflow.
#[test]
fn maps_may_be_squared_for_ever() {
    for scale in [2f32.powi(90), 2f32.powi(-85), 0.0, -1.0] {
        let mut map = Affine::placed(scale, [1e28, -1e28, 1e-25]).unwrap();
        for _ in 0..100 {
            map = map.then(&map);
        }
        let _ = map.orthonormalised();
    }
}

/// What is not finite is refused, and so is nothing else up to 2^96.
#[test]
fn any_floats_are_a_map_or_refused() {
    let mut rng = Rng(3);
    let mut refused = 0;
    for i in 0..500_000 {
        let mut v = [0f32; 12];
        for v in &mut v {
            *v = rng.signed();
        }
        let bits = match i % 5 {
            0 => 0x7F80_0000 | rng.bits() & 0x807F_FFFF,
            1 => rng.bits() & 0x807F_FFFF,
            2 => 0x7F80_0000,
            _ => rng.bits(),
        };
        let odd = f32::from_bits(bits);
        v[rng.bits() as usize % 12] = odd;
        let map = Affine::from_rows(
            [[v[0], v[1], v[2]], [v[3], v[4], v[5]], [v[6], v[7], v[8]]],
            [v[9], v[10], v[11]],
        );
        assert_eq!(map.is_some(), odd.abs() < 2f32.powi(96), "{odd:e}");
        refused += u32::from(map.is_none());
        if let Some(map) = map {
            let _ = map.then(&map).then(&map).orthonormalised();
        }
    }
    assert!(refused > 200_000, "{refused}");
}

#[test]
fn units_have_length_one() {
    let u = unit([3 << 20, -4 << 20, 0]).map(I2F14::to_bits);
    assert_eq!(u, [9830, -13107, 0]);
    assert_eq!(unit([1, 0, 0]).map(I2F14::to_bits), [16384, 0, 0]);
    assert_eq!(unit([0; 3]).map(I2F14::to_bits), [0; 3]);
    assert_eq!(unit([-(1 << 32), 0, 0]).map(I2F14::to_bits), [-16384, 0, 0]);
}

/// Kills: one Newton step less, squares of fewer bits, a root that is not halved, components that are rounded down, and a
/// length that is not mended.
#[test]
fn units_are_the_nearest_to_exact_ones() {
    let mut rng = Rng(29);
    let (mut worst, mut worst_q30) = (0f64, 0f64);
    for i in 0..60_000 {
        let size = 2f64.powi(i % 61) * (1.0 + f64::from(rng.signed().abs()));
        let thin = [1.0, 1e-3, 1e-6][i as usize / 61 % 3];
        let v = [1.0, thin, 1.0].map(|part| (f64::from(rng.signed()) * part * size) as i64);
        let length = v.iter().map(|&c| c as f64 * c as f64).sum::<f64>().sqrt();
        assert_eq!(unit_q30(v).is_some(), length > 0.0);
        for (i, c) in v.into_iter().enumerate() {
            let want = c as f64 / length.max(1.0);
            let got = f64::from(unit(v)[i].to_bits()) / 16_384.0;
            worst = worst.max((got - want).abs());
            let got = unit_q30(v).map_or(0.0, |v| v[i] as f64 / 2f64.powi(30));
            worst_q30 = worst_q30.max((got - want).abs());
        }
    }
    std::println!(
        "{} of 2^-14, {} of 2^-28",
        worst * 2f64.powi(14),
        worst_q30 * 2f64.powi(28)
    );
    assert!(worst < 0.501 / 2f64.powi(14), "{worst}");
    assert!(worst_q30 < 1.0 / 2f64.powi(28), "{worst_q30}");
}

/// Kills: a direction that is scaled on its way, and entries of another row or column.
#[test]
fn directions_are_turned_in_units_of_the_mantissa() {
    let mut rng = Rng(23);
    for i in 0..2_000 {
        let scale = f32::from(1u16 << rng.below(8));
        let row = |rng: &mut Rng| [0; 3].map(|_: u8| scale * rng.signed());
        let rows = [row(&mut rng), row(&mut rng), row(&mut rng)];
        let map = Affine::from_rows(rows, [0.0; 3]).unwrap();
        let bits = [0; 3].map(|_: u8| (rng.signed() * 16_384.0) as i16);
        let direction = bits.map(I2F14::from_bits);
        let unit = 2f64.powi(map.linear.exponent - 30);
        let (there, back) = (map.turned(direction), map.transposed_times(direction));
        for axis in 0..3 {
            let sum = |entry: [f64; 3]| {
                let parts = [0, 1, 2].map(|k| entry[k] * f64::from(bits[k]) / 16_384.0);
                parts.iter().sum::<f64>() / unit
            };
            let row = [0, 1, 2].map(|k| value(&map.linear, 3 * axis + k));
            let column = [0, 1, 2].map(|k| value(&map.linear, 3 * k + axis));
            for (got, want) in [(there[axis], sum(row)), (back[axis], sum(column))] {
                // Rounded down to a unit.
                let off = want - got as f64;
                assert!((-1e-3..1.001).contains(&off), "{i}: {got} for {want}");
            }
        }
    }
}

/// Kills: what a square lacks that is cut off.
#[test]
fn units_along_an_axis_are_exact() {
    for axis in 0..3 {
        for length in [1i64, -7, 1 << 29, -(1 << 61), (1 << 61) - 1] {
            let (mut v, mut unit) = ([0; 3], [0; 3]);
            v[axis] = length;
            unit[axis] = length.signum() as i32 * (1 << 30);
            assert_eq!(unit_q30(v), Some(unit), "{v:?}");
        }
    }
    assert_eq!(unit_q30([0; 3]), None);
}
