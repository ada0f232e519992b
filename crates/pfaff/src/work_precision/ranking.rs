//! The curve that reaches each error in the shortest time, as numbers and as text.

#[cfg(test)]
mod tests;

use report::{CurveName, Place, RankingLine, WorkPrecisionRow};

/// Errors for which the ranking is made.
const LEVELS: [f64; 10] = [
    1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12,
];

/// A run reaches an error only if no run with a tighter tolerance exceeds the error by more than
/// this factor. The reason is that a loose run may be accurate by chance near singular
/// configurations.
const LUCK: f64 = 10.0;

/// The smallest error in the ranking is this multiple of the error of the reference.
const RESOLVED: f64 = 3.0;

/// Methods within this factor count as equal, because repeated runs differ by this factor.
const EQUAL: f64 = 1.1;

/// Orders curves by time at each error. The fastest curve comes first.
pub(super) fn ranking(rows: &[WorkPrecisionRow], limit: f64) -> Vec<RankingLine> {
    let mut curves: Vec<&CurveName> = Vec::new();
    for row in rows {
        if !curves.contains(&&row.curve) {
            curves.push(&row.curve);
        }
    }
    let levels = LEVELS
        .into_iter()
        .filter(|level| limit.is_finite() && *level >= RESOLVED * limit);
    let line = |error: f64| {
        let mut places: Vec<Place> = curves
            .iter()
            .filter_map(|curve| {
                let of_curve = |row: &&WorkPrecisionRow| row.curve == **curve;
                let runs: Vec<&WorkPrecisionRow> = rows.iter().filter(of_curve).collect();
                let (seconds, evaluations) = cost(&runs, error)?;
                Some(Place {
                    curve: (*curve).clone(),
                    seconds,
                    evaluations,
                })
            })
            .collect();
        places.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        RankingLine { error, places }
    };
    levels
        .map(line)
        .filter(|line| !line.places.is_empty())
        .collect()
}

/// Returns the time (s) and the number of evaluations for an error, from the runs of a curve. The
/// run with the loosest tolerance comes first. The logarithms of the values are interpolated
/// linearly between the last run above the error and the first run that reaches the error.
fn cost(runs: &[&WorkPrecisionRow], level: f64) -> Option<(f64, f64)> {
    let error = |row: &WorkPrecisionRow| row.motion_error().unwrap_or(f64::INFINITY);
    let finished: Vec<(&WorkPrecisionRow, f64)> = runs.iter().map(|r| (*r, error(r))).collect();
    let reached = (0..finished.len()).find(|&k| {
        finished[k].1 <= level
            && finished[k..]
                .iter()
                .all(|f| f.1 <= LUCK * level || f.0.status != "done")
    })?;
    let (row, found) = finished[reached];
    let own = (row.seconds, row.evaluations as f64);
    let before = reached.checked_sub(1).map(|k| finished[k]);
    let Some((looser, missed)) = before.filter(|b| b.1.is_finite() && b.1 > level && found > 0.0)
    else {
        return Some(own);
    };
    let share = (missed / level).ln() / (missed / found).ln();
    let between = |a: f64, b: f64| (a.ln() + share * (b.ln() - a.ln())).exp();
    let evaluations = between(looser.evaluations as f64, own.1);
    Some((between(looser.seconds, own.0), evaluations))
}

/// Writes one sentence for each range of errors with the fastest method, then a comparison of the
/// stabilisations of one method.
pub(super) fn words(lines: &[RankingLine], rows: &[WorkPrecisionRow]) -> Vec<String> {
    let Some(usual) = rows.first().map(|row| &row.curve) else {
        return Vec::new();
    };
    let is_method = |c: &CurveName| {
        c.formulation == usual.formulation && c.stabilisation == usual.stabilisation
    };
    let mut ranges: Vec<(Vec<f64>, Vec<&Place>, Vec<f64>)> = Vec::new();
    for line in lines {
        let methods: Vec<&Place> = line.places.iter().filter(|p| is_method(&p.curve)).collect();
        let Some(first) = methods.first() else {
            continue;
        };
        let next = methods
            .get(1)
            .map_or(f64::INFINITY, |p| p.seconds / first.seconds);
        match ranges.last_mut() {
            Some((levels, places, factors)) if places[0].curve == first.curve => {
                levels.push(line.error);
                factors.push(next);
                *places = methods;
            }
            _ => ranges.push((vec![line.error], methods, vec![next])),
        }
    }
    let mut sentences: Vec<String> = ranges
        .iter()
        .map(|(levels, places, factors)| range(levels, places, factors))
        .collect();
    sentences.extend(treatments(lines, rows));
    sentences
}

fn range(levels: &[f64], places: &[&Place], factors: &[f64]) -> String {
    let span = match levels {
        [first, .., last] => format!("For errors of {first:.0e} … {last:.0e}"),
        [only] => format!("For an error of {only:.0e}"),
        [] => String::new(),
    };
    let winner = places[0].curve.method;
    let fold = |(low, high): (f64, f64), f: &f64| (low.min(*f), high.max(*f));
    let (low, high) = factors.iter().fold((f64::INFINITY, 0.0), fold);
    let Some(next) = places.get(1).map(|place| place.curve.method) else {
        return format!(
            "{span}, {winner} is the fastest method, and no other method reaches the smallest error."
        );
    };
    if high < EQUAL {
        format!(
            "{span}, {winner} is the fastest method, and {next} takes less than 1.1 times as long."
        )
    } else {
        let factor = span_of(low, high);
        let which = if levels.len() > 1 {
            " (at the smallest error: "
        } else {
            " ("
        };
        format!(
            "{span}, {winner} is the fastest method. The second-fastest method{which}{next}) takes {factor} times as long."
        )
    }
}

fn span_of(low: f64, high: f64) -> String {
    let (a, b) = (format!("{low:.1}"), format!("{high:.1}"));
    match (a == b, high.is_finite()) {
        (true, _) => a,
        (false, true) => format!("{a} to {b}"),
        (false, false) => format!("at least {a}"),
    }
}

/// Compares other stabilisations with the usual stabilisation of the same method.
fn treatments(lines: &[RankingLine], rows: &[WorkPrecisionRow]) -> Option<String> {
    let usual = &rows.first()?.curve;
    let mut others: Vec<&CurveName> = Vec::new();
    for row in rows {
        let same = row.curve.formulation == usual.formulation
            && row.curve.stabilisation == usual.stabilisation;
        if !same && !others.contains(&&row.curve) {
            others.push(&row.curve);
        }
    }
    let compared: Vec<String> = others
        .iter()
        .map(|curve| {
            let base = CurveName {
                method: curve.method,
                ..usual.clone()
            };
            let ratio = |line: &RankingLine| {
                let of = |name: &CurveName| line.places.iter().find(|p| p.curve == *name);
                Some((line.error, of(curve)?.seconds / of(&base)?.seconds))
            };
            let ratios: Vec<(f64, f64)> = lines.iter().filter_map(ratio).collect();
            let name = if curve.stabilisation == usual.stabilisation {
                curve.formulation.to_owned()
            } else {
                curve.stabilisation.to_owned()
            };
            match ratios.last() {
                None => format!("{name} does not reach any error of the table"),
                Some((best, _)) => {
                    let mean = ratios.iter().map(|r| r.1.ln()).sum::<f64>() / ratios.len() as f64;
                    format!(
                        "{name} takes {:.1} times as long (for errors down to {best:.0e})",
                        mean.exp()
                    )
                }
            }
        })
        .collect();
    let method = others.first()?.method;
    Some(format!(
        "Run times of {method} relative to its runs with {} and {}: {}.",
        usual.formulation,
        usual.stabilisation,
        compared.join("; ")
    ))
}
