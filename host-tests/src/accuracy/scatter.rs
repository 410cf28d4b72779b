//! Cost against error as pictures.

use super::Row;
use crate::plot::{Dot, Scatter};

/// Cases that one plot can tell apart.
const MOST_CASES: usize = 2;

/// Plots of all that has a cost, by name: one for each family, or, where it has many cases, for
/// each of them.
pub fn plots(rows: &[Row]) -> Vec<(String, Scatter)> {
    let costed: Vec<&Row> = rows.iter().filter(|row| row.cost.is_some()).collect();
    let mut plots = Vec::new();
    for family in distinct(costed.iter().map(|row| row.family)) {
        let of: Vec<&Row> = costed
            .iter()
            .copied()
            .filter(|r| r.family == family)
            .collect();
        let cases = distinct(of.iter().map(|row| row.case));
        if cases.len() <= MOST_CASES {
            plots.push((file_name(&[family]), plot(family, &of)));
            continue;
        }
        for case in cases {
            let of: Vec<&Row> = of.iter().copied().filter(|r| r.case == case).collect();
            let title = format!("{family}: {case}");
            plots.push((file_name(&[family, case]), plot(&title, &of)));
        }
    }
    plots
}

/// Each once, in the order in which they come.
fn distinct<'a>(all: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    for one in all {
        if !found.contains(&one) {
            found.push(one);
        }
    }
    found
}

/// Letters, digits and hyphens.
fn file_name(parts: &[&str]) -> String {
    let text = format!("accuracy {}", parts.join(" ")).to_lowercase();
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '.');
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("-").replace('.', "_")
}

fn plot(title: &str, rows: &[&Row]) -> Scatter {
    let groups = distinct(rows.iter().map(|row| row.case));
    let dots = rows.iter().map(|row| Dot {
        name: row.method.to_owned(),
        group: groups.iter().position(|g| *g == row.case).unwrap_or(0),
        x: row.cost.unwrap_or(0.0),
        y: row.max,
        marked: row.on_frontier,
    });
    let unit = rows.first().map_or("", |row| row.unit);
    Scatter {
        title: format!("{title} (framed and joined: the frontier)"),
        x_name: "instructions a pixel, with its part of a span of 4 where spans are told apart, Cortex-M4".into(),
        y_name: format!("largest error, {unit}"),
        dots: dots.collect(),
        groups: groups.into_iter().map(str::to_owned).collect(),
    }
}
