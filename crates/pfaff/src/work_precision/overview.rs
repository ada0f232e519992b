//! All scenes together, in words.

use report::{WorkPrecisionRow, WorkPrecisionScene};

/// Methods this close to the fastest share its place: repeated runs differ by as much.
const EQUAL: f64 = 1.1;

/// A finished run with an error above this one at a tolerance of at most [`TIGHT`] is wrong, not inaccurate.
const WRONG: f64 = 1e-2;

/// See [`WRONG`].
const TIGHT: f64 = 1e-6;

/// Who wins how often, how many runs did not reach their end, and which finished runs are wrong.
#[must_use]
pub fn overview(scenes: &[WorkPrecisionScene]) -> Vec<String> {
    let mut sentences: Vec<String> = wins(scenes).into_iter().collect();
    let rows: Vec<&WorkPrecisionRow> = scenes.iter().flat_map(|s| &s.rows).collect();
    let unfinished = rows.iter().filter(|row| row.status != "done").count();
    sentences.push(format!(
        "{} runs; {unfinished} did not reach their end, each with its reason in the table.",
        rows.len()
    ));
    let is_wrong = |row: &&WorkPrecisionRow| {
        row.tolerance <= TIGHT && row.motion_error().is_some_and(|error| error > WRONG)
    };
    let wrong: Vec<String> = rows.into_iter().filter(is_wrong).map(name).collect();
    sentences.push(match wrong.len() {
        0 => format!("No finished run at a tolerance of {TIGHT:.0e} or tighter is off by more than {WRONG:.0e}."),
        n => format!(
            "{n} finished runs at a tolerance of {TIGHT:.0e} or tighter are off by more than {WRONG:.0e}: {}.",
            wrong.join("; ")
        ),
    });
    sentences
}

fn name(row: &WorkPrecisionRow) -> String {
    let curve = &row.curve;
    format!(
        "{} with {}, {}, {} at {:.0e}",
        row.scene, curve.method, curve.formulation, curve.stabilisation, row.tolerance
    )
}

/// How often each method is the fastest, over all scenes and errors.
fn wins(scenes: &[WorkPrecisionScene]) -> Option<String> {
    let usual = &scenes.iter().flat_map(|s| &s.rows).next()?.curve;
    let (mut total, mut counts) = (0, Vec::<(&str, usize)>::new());
    for line in scenes.iter().flat_map(|s| &s.ranking) {
        let alike = line.places.iter().filter(|p| {
            p.curve.formulation == usual.formulation && p.curve.stabilisation == usual.stabilisation
        });
        let places: Vec<_> = alike.collect();
        let Some(first) = places.first() else {
            continue;
        };
        total += 1;
        for place in places.iter().filter(|p| p.seconds <= EQUAL * first.seconds) {
            match counts
                .iter_mut()
                .find(|(method, _)| *method == place.curve.method)
            {
                Some((_, n)) => *n += 1,
                None => counts.push((place.curve.method, 1)),
            }
        }
    }
    counts.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    let words: Vec<String> = counts
        .iter()
        .map(|(method, n)| format!("{method} {n}"))
        .collect();
    Some(format!(
        "Of {total} pairs of a scene and an error that some method reaches, the fastest or within a tenth of it: {}.",
        words.join(", ")
    ))
}
