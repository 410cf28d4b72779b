//! What a plot shows, as it is written.

use host_tests::plot::*;

#[test]
fn scales_are_nice() {
    let pairs = [
        (0.7, 1.0),
        (1.0, 1.0),
        (1.1, 2.0),
        (23.0, 50.0),
        (0.051, 0.1),
    ];
    for (value, expected) in pairs {
        assert!((nice(value) - expected).abs() < 1e-9, "{value}");
    }
}

#[test]
fn scatters_are_drawn_whatever_is_in_them() {
    let dot = |x, y, marked| Dot {
        name: "a < b".into(),
        group: 5,
        x,
        y,
        marked,
    };
    let all = [
        dot(0.0, 0.0, true),
        dot(1e300, 3.0, true),
        dot(7.0, 1e-30, false),
    ];
    for dots in [&all[..0], &all[..1], &all] {
        let plot = Scatter {
            title: "t".into(),
            x_name: "x".into(),
            y_name: "y".into(),
            groups: vec!["g".into(); 6],
            dots: dots.into(),
        };
        assert_eq!(plot.to_frame().width(), 800);
        let svg = plot.to_svg();
        assert_eq!(svg.matches("a &lt; b").count(), dots.len());
    }
}

#[test]
fn empty_and_extreme_charts_can_be_drawn() {
    let all = [vec![], vec![0.0], vec![0.0, 1e12], vec![1e-6; 40]];
    let both = all
        .iter()
        .flat_map(|v| [Marks::Lines, Marks::Bars].map(|m| (v.clone(), m)));
    for (values, marks) in both {
        let chart = Chart {
            marks,
            title: "a < b & c".into(),
            x: values.iter().map(f64::to_string).collect(),
            x_name: String::new(),
            y_name: "\u{1F980}".into(),
            series: vec![
                Series {
                    name: "one".into(),
                    values,
                };
                6
            ],
        };
        assert_eq!(chart.to_frame().width(), 800);
        assert!(chart.to_svg().contains("a &lt; b &amp; c"));
    }
}
