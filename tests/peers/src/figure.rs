//! Error versus evaluations and versus time, both logarithmic, one file for each problem.

use std::fmt::{self, Write};

use crate::measure::{Breaks, Row, Series};

/// Width and height of a panel, and the margin around it.
const SIZE: [f64; 2] = [330.0, 300.0];
const MARGIN: f64 = 55.0;
const LEGEND: f64 = 270.0;

/// Colours of libraries, and dashes of their methods in the order of their occurrence.
const COLOURS: [(&str, &str); 4] = [
    ("dynamics", "#b3001b"),
    ("integrators", "#e08a00"),
    ("differential-equations", "#1b5fb3"),
    ("diffsol", "#2a8a3a"),
];
const DASHES: [&str; 4] = ["", "7 3", "2 2", "9 2 2 2"];

/// The figure of one problem. Runs that ignore break times are only in the tables.
pub fn draw(title: &str, rows: &[&Row]) -> Result<String, fmt::Error> {
    let mut all: Vec<&Series> = Vec::new();
    for row in rows {
        if row.series.breaks != Breaks::Ignored && !all.contains(&&row.series) {
            all.push(&row.series);
        }
    }
    let [width, height] = [2.0 * (SIZE[0] + MARGIN) + LEGEND, SIZE[1] + 2.0 * MARGIN];
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{MARGIN}\" y=\"24\" font-size=\"14\">{title}</text>\n"
    );
    let evaluations = |_: f64, evaluations: u64| evaluations as f64;
    let microseconds = |seconds: f64, _| 1e6 * seconds;
    panel(&mut out, MARGIN, "evaluations", &all, rows, evaluations)?;
    let second = 2.0 * MARGIN + SIZE[0];
    panel(&mut out, second, "microseconds", &all, rows, microseconds)?;
    for (i, series) in all.iter().enumerate() {
        let (x, y) = (second + SIZE[0] + 15.0, MARGIN + 10.0 + 18.0 * i as f64);
        let (style, name) = (style(&all, i), crate::tables::name(series));
        writeln!(out, "<path d=\"M{x} {y}h30\" {style}/>")?;
        writeln!(
            out,
            "<text x=\"{}\" y=\"{}\">{name}</text>",
            x + 36.0,
            y + 4.0
        )?;
    }
    out += "</svg>\n";
    Ok(out)
}

fn style(all: &[&Series], i: usize) -> String {
    let library = all[i].library;
    let known = COLOURS.iter().find(|(name, _)| *name == library);
    let colour = known.map_or("black", |(_, colour)| colour);
    let earlier = all[..i].iter().filter(|s| s.library == library).count();
    let dash = DASHES[earlier % DASHES.len()];
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-dasharray=\"{dash}\"")
}

/// One panel with its upper left corner at (x0, MARGIN): errors decrease to the right, costs
/// increase upwards.
fn panel(
    out: &mut String,
    x0: f64,
    label: &str,
    all: &[&Series],
    rows: &[&Row],
    cost: impl Fn(f64, u64) -> f64,
) -> fmt::Result {
    let points = |series: &Series| -> Vec<[f64; 2]> {
        let of_series = rows.iter().filter(|row| row.series == *series);
        let good = of_series.filter_map(|row| row.good().map(|r| (row, r)));
        good.map(|(row, r)| [-r.error.log10(), cost(row.seconds, r.evaluations).log10()])
            .collect()
    };
    let every: Vec<[f64; 2]> = all.iter().flat_map(|s| points(s)).collect();
    let range = |k: usize| {
        let values = || every.iter().map(|p| p[k]);
        let least = values().fold(f64::INFINITY, f64::min).floor();
        (least, values().fold(least + 1.0, f64::max).ceil())
    };
    let ranges = [range(0), range(1)];
    let x = |e: f64| x0 + SIZE[0] * (e - ranges[0].0) / (ranges[0].1 - ranges[0].0);
    let y = |c: f64| MARGIN + SIZE[1] * (1.0 - (c - ranges[1].0) / (ranges[1].1 - ranges[1].0));
    let grid = "stroke=\"#dddddd\"";
    for e in ranges[0].0 as i32..=ranges[0].1 as i32 {
        let (x, bottom) = (x(f64::from(e)), MARGIN + SIZE[1]);
        writeln!(out, "<path d=\"M{x:.1} {MARGIN}v{}\" {grid}/>", SIZE[1])?;
        if e % 2 == 0 {
            writeln!(
                out,
                "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">1e{}</text>",
                bottom + 15.0,
                -e
            )?;
        }
    }
    for c in ranges[1].0 as i32..=ranges[1].1 as i32 {
        let y = y(f64::from(c));
        writeln!(out, "<path d=\"M{x0} {y:.1}h{}\" {grid}/>", SIZE[0])?;
        writeln!(
            out,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">1e{c}</text>",
            x0 - 5.0,
            y + 4.0
        )?;
    }
    writeln!(
        out,
        "<text x=\"{x0}\" y=\"{}\">{label} against error</text>",
        MARGIN - 8.0
    )?;
    for (i, series) in all.iter().enumerate() {
        let line: Vec<String> = points(series)
            .iter()
            .map(|p| format!("{:.1} {:.1}", x(p[0]), y(p[1])))
            .collect();
        if !line.is_empty() {
            writeln!(out, "<path d=\"M{}\" {}/>", line.join("L"), style(all, i))?;
        }
    }
    Ok(())
}
