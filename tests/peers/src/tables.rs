//! The output files: all rows as `peers.csv`, tables at equal error as `tables.md`.

use std::fmt::{self, Write};

use crate::equal_error::{Cost, Point, cost_at};
use crate::measure::{Row, Series};

/// Errors at which series are compared.
const ERRORS: [i32; 7] = [-2, -4, -6, -7, -8, -10, -11];

/// All rows, including failures.
pub fn csv(rows: &[Row]) -> Result<String, fmt::Error> {
    let mut out = String::from(
        "problem,library,method,break_times,rtol,atol,error,evaluations,steps,seconds,status\n",
    );
    for row in rows {
        let Series {
            problem,
            library,
            method,
            breaks,
        } = &row.series;
        let breaks = breaks.name();
        write!(
            out,
            "{problem},{library},{method},{breaks},{:.0e},{:.0e},",
            row.rtol, row.atol
        )?;
        let status = row.trouble().map(|text| text.replace(['"', '\n'], " "));
        let status = status.map_or("ok".to_owned(), |text| format!("\"{text}\""));
        match &row.result {
            Ok(r) => writeln!(
                out,
                "{:.3e},{},{},{:.3e},{status}",
                r.error, r.evaluations, r.steps, row.seconds
            )?,
            Err(_) => writeln!(out, ",,,,{status}")?,
        }
    }
    Ok(out)
}

/// One problem: evaluations and time of each series at equal error, their ratios to the first
/// series, and the failures.
pub fn problem(title: &str, rows: &[&Row]) -> Result<String, fmt::Error> {
    let mut all: Vec<&Series> = Vec::new();
    for row in rows {
        if !all.contains(&&row.series) {
            all.push(&row.series);
        }
    }
    let mut out = format!("## {title}\n");
    let evaluations = |row: &Row| row.good().map(|r| r.evaluations as f64);
    let microseconds = |row: &Row| row.good().map(|_| 1e6 * row.seconds);
    writeln!(out, "\nEvaluations (ratio to the first line).\n")?;
    table(&mut out, &all, rows, evaluations)?;
    writeln!(out, "\nMicroseconds (ratio to the first line).\n")?;
    table(&mut out, &all, rows, microseconds)?;
    per_evaluation(&mut out, &all, rows)?;
    for row in rows {
        if let Some(text) = row.trouble() {
            writeln!(
                out,
                "- {} at rtol {:.0e}: {text}",
                name(&row.series),
                row.rtol
            )?;
        }
    }
    Ok(out)
}

/// Library, method, and the treatment of break times if it is unusual.
pub fn name(series: &Series) -> String {
    let Series {
        library,
        method,
        breaks,
        ..
    } = series;
    match breaks {
        crate::measure::Breaks::Ignored => format!("{library} {method}, break times ignored"),
        _ => format!("{library} {method}"),
    }
}

fn of<'r>(rows: &'r [&Row], series: &'r Series) -> impl Iterator<Item = &'r Row> {
    rows.iter()
        .copied()
        .filter(move |row| row.series == *series)
}

fn table(
    out: &mut String,
    all: &[&Series],
    rows: &[&Row],
    cost: impl Fn(&Row) -> Option<f64>,
) -> fmt::Result {
    let costs = |series: &Series| {
        let point = |row: &Row| {
            let (result, cost) = (row.good()?, cost(row)?);
            Some(Point {
                error: result.error,
                cost,
            })
        };
        let points: Vec<Point> = of(rows, series).filter_map(point).collect();
        ERRORS.map(|e| cost_at(&points, 10f64.powi(e)))
    };
    write!(out, "| error |")?;
    for e in ERRORS {
        write!(out, " 1e{e} |")?;
    }
    writeln!(out, "\n| --- |{}", " ---: |".repeat(ERRORS.len()))?;
    let Some(first) = all.first() else {
        return Ok(());
    };
    let ours = costs(first);
    for series in all {
        write!(out, "| {} |", name(series))?;
        for (cost, ours) in costs(series).into_iter().zip(ours) {
            write!(out, " {} |", cell(cost, ours))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// A cost and its ratio to ours.
fn cell(cost: Cost, ours: Cost) -> String {
    match (cost, ours) {
        (Cost::Unknown, _) => "–".to_owned(),
        (Cost::At(cost), Cost::At(ours)) => format!("{cost:.0} ({:.2})", cost / ours),
        (Cost::At(cost), Cost::AtMost(ours)) => format!("{cost:.0} (≥ {:.2})", cost / ours),
        (Cost::At(cost), Cost::Unknown) => format!("{cost:.0}"),
        (Cost::AtMost(cost), Cost::At(ours)) => format!("≤ {cost:.0} (≤ {:.2})", cost / ours),
        (Cost::AtMost(cost), _) => format!("≤ {cost:.0}"),
    }
}

/// Time per evaluation, and the smallest error that a series reaches.
fn per_evaluation(out: &mut String, all: &[&Series], rows: &[&Row]) -> fmt::Result {
    writeln!(
        out,
        "\n| series | least error | time per evaluation (ns): loosest … tightest tolerance |\n| --- | ---: | ---: |"
    )?;
    for series in all {
        let done = || of(rows, series).filter_map(|row| Some((row, row.good()?)));
        let least = done().map(|(_, r)| r.error).fold(f64::INFINITY, f64::min);
        let mut each = done().map(|(row, r)| 1e9 * row.seconds / r.evaluations as f64);
        if let Some(first) = each.next() {
            let last = each.last().unwrap_or(first);
            writeln!(
                out,
                "| {} | {least:.1e} | {first:.0} … {last:.0} |",
                name(series)
            )?;
        }
    }
    writeln!(out)
}
