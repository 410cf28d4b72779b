//! What the figures must be, so that a method that gets worse is noticed.

use super::cost::{Costs, solve};
use super::{Errors, Row, mark_frontier, measure, scatter, table};
use crate::firmware::{FrameResult, KernelRun, Output};

fn made(case: &'static str, cost: Option<f64>, max: f64) -> Row {
    let name = ("family", case, "method", "unit", None);
    Row {
        per_pixel: cost,
        ..Row::rate(name, max, 0.0)
    }
}

fn frontier(mut rows: Vec<Row>) -> Vec<bool> {
    mark_frontier(&mut rows);
    rows.iter().map(|row| row.on_frontier).collect()
}

#[test]
fn the_frontier_is_what_nothing_beats() {
    let rows = vec![
        made("a", Some(1.0), 9.0),
        made("a", Some(2.0), 3.0),
        made("a", Some(3.0), 3.0),
        made("a", Some(4.0), 1.0),
        made("a", None, 0.0),
        made("b", Some(9.0), 9.0),
    ];
    assert_eq!(frontier(rows), [true, true, false, true, false, true]);
    // Twins do not beat each other.
    let twins = vec![made("a", Some(1.0), 1.0); 2];
    assert_eq!(frontier(twins), [true, true]);
}

#[test]
fn errors_become_figures() {
    let mut errors = Errors::default();
    for i in (0..1000).rev() {
        errors.push(f64::from(i));
    }
    let row = errors.row(("family", "case", "method", "unit", None));
    assert_eq!((row.max, row.mean), (999.0, 499.5));
    assert_eq!((row.p999, row.samples), (Some(999.0), 1000));
    let none = Errors::default().row(("family", "case", "method", "unit", None));
    assert_eq!((none.max, none.mean, none.samples), (0.0, 0.0, 0));
}

fn run(name: &str, pixels: u64, spans: u64) -> KernelRun {
    KernelRun {
        name: name.into(),
        pixels,
        spans,
        instructions: 7 * pixels + 30 * spans,
    }
}

#[test]
fn two_equations_tell_pixels_from_spans() {
    let (long, short) = (run("k", 2000, 62), run("k", 244, 58));
    let (pixel, span) = solve(&long, &short).unwrap();
    assert!((pixel - 7.0).abs() < 1e-9 && (span - 30.0).abs() < 1e-9);
    assert_eq!(solve(&long, &long), None);
    let mut output = Output {
        kernels: vec![long, short],
        frames: vec![FrameResult {
            scene: "teapot".into(),
            crc: 0,
            instructions: 1000,
        }],
        ..Output::default()
    };
    let costs = Costs::from_output(&output, 10).unwrap();
    let with = |kernel| {
        let name = ("family", "case", "method", "unit", Some(kernel));
        let mut rows = [Row::rate(name, 1.0, 1.0)];
        costs.fill(&mut rows).map(|()| rows[0].per_pixel)
    };
    assert_eq!(with("teapot").unwrap(), Some(100.0));
    assert!((with("k").unwrap().unwrap() - 7.0).abs() < 1e-9);
    assert!(with("other").is_err());
    // Nothing measured is nothing claimed.
    let name = ("family", "case", "method", "unit", Some("k"));
    let mut rows = [Row::rate(name, 1.0, 1.0)];
    Costs::default().fill(&mut rows).unwrap();
    assert_eq!(rows[0].per_pixel, None);
    output.kernels.pop();
    assert!(Costs::from_output(&output, 10).is_err());
}

/// The largest error that each method may have; a row that is not here is a method without a
/// bound. Levels are beyond the rounding of the method's own format.
const BOUNDS: [(&str, &str, &str, f64); 20] = [
    ("interpolation", "spans of 1 to 63", "LIRP, 10-bit", 0.6),
    ("interpolation", "spans of 1 to 63", "LIRP, 12-bit", 0.4),
    ("interpolation", "spans of 1 to 63", "LIRP, 16-bit", 0.3),
    ("interpolation", "", "packed, one word", 1.1),
    ("interpolation", "", "packed, two words", 0.125),
    ("interpolation", "spans of 1 to 8192", "LIRP, 10-bit", 0.6),
    ("interpolation", "spans of 1 to 8192", "LIRP, 12-bit", 0.4),
    ("interpolation", "spans of 1 to 8192", "LIRP, 16-bit", 0.3),
    ("interpolation", "", "planes, 16.16 channels, RGB888", 0.1),
    ("interpolation", "", "planes, 16.16 channels, RGB565", 0.5),
    ("coverage", "corners on the 1/8 grid", "", 0.0),
    ("coverage", "corners anywhere", "", 120.0),
    ("depth order", "", "32-bit 1/w", 0.0),
    ("depth order", "1 % apart", "hardware model", 1.0),
    ("depth order", "0.1 % apart", "hardware model", 50.0),
    ("depth order", "0.01 % apart", "hardware model", 80.0),
    ("depth planes", "", "", 0.05),
    ("frame", "", "planes, RGB888", 0.5),
    ("frame", "", "planes, RGB565", 1.1),
    ("frame", "", "hardware model", 2.0),
];

/// Errors of all methods, and, where there is a machine to count on, what they cost.
#[test]
fn every_method_keeps_its_bound_and_the_defaults_are_on_the_frontier() {
    let mut rows = measure().unwrap();
    for row in &rows {
        let fits = |b: &&(&str, &str, &str, f64)| {
            row.family == b.0 && row.case.starts_with(b.1) && row.method.starts_with(b.2)
        };
        let (_, _, _, bound) = BOUNDS.iter().find(fits).expect(row.method);
        assert!(row.max <= *bound, "{row:?}: above {bound}");
        assert!(row.mean <= row.max && row.samples > 1000, "{row:?}");
        assert!(
            row.p999.is_none_or(|p| p <= row.max && p >= row.mean),
            "{row:?}"
        );
    }
    let (costs, note) = Costs::measured().unwrap();
    assert_eq!(note, None, "QEMU and a compiler for it are needed here");
    costs.fill(&mut rows).unwrap();
    mark_frontier(&mut rows);
    for (family, method, most) in [
        ("interpolation", "packed, one word", 7.5),
        ("interpolation", "packed, two words", 13.0),
        ("interpolation", "planes, 16.16 channels, RGB565", 15.0),
        ("interpolation", "planes, 16.16 channels, RGB888", 18.0),
        ("coverage", "exact edges", 4.0),
        ("depth order", "32-bit 1/w, small", 20.0),
        ("depth planes", "planes, small", 20.0),
        ("frame", "planes, RGB565", 320.0),
    ] {
        let mut some = false;
        for row in rows
            .iter()
            .filter(|r| r.family == family && r.method.starts_with(method))
        {
            some = true;
            assert!(row.on_frontier, "{row:?}");
            assert!(
                row.per_pixel.is_some_and(|cost| cost > 0.0 && cost <= most),
                "{row:?}"
            );
        }
        assert!(some, "{family}: {method}");
    }
    for row in &rows {
        let json = row.to_json();
        for key in [
            "family",
            "method",
            "unit",
            "max_error",
            "mean_error",
            "p999_error",
            "instructions_per_pixel",
            "on_frontier",
        ] {
            assert!(json.get(key).is_some(), "{key}");
        }
    }
    let text = table(&rows).to_string();
    let plot = scatter::plot(&rows);
    assert_eq!(plot.dots.iter().filter(|d| d.marked).count(), 4);
    for row in rows.iter().filter(|r| r.family == "interpolation") {
        assert!(text.contains(row.method) && plot.to_svg().contains(row.method));
    }
    assert_eq!(plot.to_frame().width(), 800);
}
