//! Summary of all scenes as text.

use report::{Place, WorkPrecisionRow, WorkPrecisionScene};

/// Methods within this factor of the fastest method have the same rank, because repeated runs
/// differ by this factor.
const EQUAL: f64 = 1.1;

/// Largest error of an inaccurate run at a tolerance of at most [`TIGHT`]. A finished run with a
/// larger error is wrong.
const WRONG: f64 = 1e-2;

/// See the limit [`WRONG`].
const TIGHT: f64 = 1e-6;

/// Counts how often each method wins and how many runs did not reach their end, and lists the
/// finished runs that are wrong.
#[must_use]
pub fn overview(scenes: &[WorkPrecisionScene]) -> Vec<String> {
    let mut sentences: Vec<String> = wins(scenes).into_iter().chain(losses(scenes)).collect();
    let rows: Vec<&WorkPrecisionRow> = scenes.iter().flat_map(|s| &s.rows).collect();
    let unfinished = rows.iter().filter(|row| row.status != "done").count();
    sentences.push(format!(
        "Of {} runs, {unfinished} did not reach their end. The table states the reason for each of them.",
        rows.len()
    ));
    let is_wrong = |row: &&WorkPrecisionRow| {
        row.tolerance <= TIGHT && row.motion_error().is_some_and(|error| error > WRONG)
    };
    let wrong: Vec<String> = rows.into_iter().filter(is_wrong).map(name).collect();
    sentences.push(match wrong.len() {
        0 => format!("No finished run at a tolerance of {TIGHT:.0e} or tighter has an error above {WRONG:.0e}."),
        n => format!(
            "{n} finished runs at a tolerance of {TIGHT:.0e} or tighter have an error above {WRONG:.0e}: {}.",
            wrong.join("; ")
        ),
    });
    sentences
}

fn name(row: &WorkPrecisionRow) -> String {
    let curve = &row.curve;
    format!(
        "{} with {}, {}, {} at tolerance {:.0e}",
        row.scene, curve.method, curve.formulation, curve.stabilisation, row.tolerance
    )
}

/// For each scene and error, returns the methods with the usual stabilisation in the order of their
/// speed. The fastest method comes first.
fn methods(
    scenes: &[WorkPrecisionScene],
) -> impl Iterator<Item = (&WorkPrecisionScene, f64, Vec<&Place>)> {
    let usual = scenes
        .iter()
        .flat_map(|s| &s.rows)
        .next()
        .map(|row| &row.curve);
    let is_usual = move |place: &&Place| {
        usual.is_some_and(|u| {
            place.curve.formulation == u.formulation && place.curve.stabilisation == u.stabilisation
        })
    };
    let lines = scenes
        .iter()
        .flat_map(|s| s.ranking.iter().map(move |line| (s, line)));
    let places = lines.map(move |(name, line)| {
        (
            name,
            line.error,
            line.places.iter().filter(is_usual).collect(),
        )
    });
    places.filter(|(_, _, places): &(_, _, Vec<_>)| !places.is_empty())
}

/// Lists cases in which the automatically chosen method is not the fastest, with the worst factor
/// of each scene.
fn losses(scenes: &[WorkPrecisionScene]) -> Option<String> {
    let mut worst: Vec<(&WorkPrecisionScene, f64, &str, f64)> = Vec::new();
    let mut unreached: Vec<&str> = Vec::new();
    for (scene, error, places) in methods(scenes) {
        let first = places[0];
        let Some(own) = places.iter().find(|p| p.curve.method == scene.automatic) else {
            if unreached.last() != Some(&scene.name.as_str()) {
                unreached.push(&scene.name);
            }
            continue;
        };
        let factor = own.seconds / first.seconds;
        match worst.last_mut() {
            _ if factor < EQUAL => {}
            Some(last) if last.0.name == scene.name => {
                if factor > last.3 {
                    *last = (scene, error, first.curve.method, factor);
                }
            }
            _ => worst.push((scene, error, first.curve.method, factor)),
        }
    }
    let lost = worst.iter().map(|(scene, error, method, factor)| {
        let (name, own) = (&scene.name, scene.automatic);
        format!(
            "{name} ({own} takes {factor:.1} times as long as {method} for an error of {error:.0e})"
        )
    });
    let lost: Vec<String> = lost.collect();
    let mut words = match lost.len() {
        0 => "The automatically chosen method never takes more than 1.1 times as long as the fastest method".to_owned(),
        _ => format!(
            "The automatically chosen method takes at least 1.1 times as long as the fastest method in these scenes, each with its largest factor: {}",
            lost.join(", ")
        ),
    };
    if !unreached.is_empty() {
        let names = unreached.join(", ");
        words.push_str(&format!(
            "; it does not reach all errors that other methods reach in {names}"
        ));
    }
    words.push('.');
    scenes.first().map(|_| words)
}

/// Counts how often each method is the fastest, over all scenes and errors.
fn wins(scenes: &[WorkPrecisionScene]) -> Option<String> {
    let (mut total, mut counts) = (0, Vec::<(&str, usize)>::new());
    for (_, _, places) in methods(scenes) {
        total += 1;
        for place in places
            .iter()
            .filter(|p| p.seconds <= EQUAL * places[0].seconds)
        {
            match counts
                .iter_mut()
                .find(|(method, _)| *method == place.curve.method)
            {
                Some((_, n)) => *n += 1,
                None => counts.push((place.curve.method, 1)),
            }
        }
    }
    if total == 0 {
        return None;
    }
    counts.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    let words: Vec<String> = counts
        .iter()
        .map(|(method, n)| format!("{method} {n}"))
        .collect();
    Some(format!(
        "There are {total} pairs of a scene and an error that at least one method reaches. Number of pairs in which a method is the fastest or takes at most 1.1 times as long as the fastest: {}.",
        words.join(", ")
    ))
}
