//! `pfaff linearise`: matrices, eigenvalues and modes of small motions.

use std::path::Path;

use pfaff::dynamics::linearise::{Linearisation, LineariseOptions, Mode};
use pfaff::model::System;
use pfaff::report::documents::{LinearisationDocument, ModeDocument};
use pfaff::report::{
    Family, Frame, MatrixTable, Recording, RunPage, Shows, TableError, modes_table, run_page,
    write_json,
};
use pfaff::{Overrides, Study};

use crate::args::Linearise;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Files, Outcome, columns, count, directory};
use crate::simulate::origin;

/// Modes with pages of their own, first those that are not zero: others are in the tables only.
const PAGES: usize = 12;

/// The files of a linearisation: each matrix, the modes, and pages of modes.
const FAMILY: Family = Family(&[
    "a.csv",
    "b.csv",
    "m.csv",
    "d.csv",
    "k.csv",
    "modes.csv",
    "linearisation.json",
    "mode-*.html",
]);

/// Frames of the page of a mode in one period.
const FRAMES: usize = 40;

/// Periods of the page of a mode.
const PERIODS: usize = 8;

/// The largest displacement of a mode on its page, as a share of the size of the mechanism or in
/// radians.
const AMPLITUDE: f64 = 0.15;

pub(crate) fn run(arguments: &Linearise, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let study = source.study(&Overrides::default(), arguments.resources, console)?;
    let options = LineariseOptions {
        coordinates: arguments.coordinates.clone(),
        follow: arguments.follow.clone(),
    };
    let found = study
        .linearise(arguments.at_time, &options)
        .map_err(|e| source.failure(e))?;
    let modes = found.modes();
    let document = LinearisationDocument::new(study.scene.name(), &found, modes.as_deref());
    let written = match &arguments.out {
        Some(path) => {
            let modes = modes.as_deref().unwrap_or_default();
            write(path, arguments.force, (&study, &found), (modes, &document))?
        }
        None => String::new(),
    };
    if arguments.json {
        return console.document(&document);
    }
    console.print(&(describe(&document) + &written))
}

/// Writes all files; returns what was written, in words.
fn write(
    path: &Path,
    force: bool,
    (study, found): (&Study, &Linearisation),
    (modes, document): (&[Mode], &LinearisationDocument),
) -> Result<String, Failure> {
    let shown = shown(modes);
    let pages: Vec<String> = shown
        .iter()
        .map(|k| format!("mode-{}.html", k + 1))
        .collect();
    let place = directory(path, FAMILY, force)?;
    let mut files = Files::of(&place, FAMILY)?;
    let table = |e: TableError| Failure::stopped(e.to_string()).coded(e.code());
    for matrix in MatrixTable::ALL {
        if let Some(text) = matrix.write(document, Vec::new()).map_err(table)? {
            files.put(matrix.file(), &text)?;
        }
    }
    if document.modes.is_some() {
        files.put(
            "modes.csv",
            &modes_table(document, Vec::new()).map_err(table)?,
        )?;
    }
    let mut json = Vec::new();
    write_json(&mut json, document).map_err(|e| Failure::stopped(e.to_string()))?;
    files.put("linearisation.json", &json)?;
    for (name, &k) in pages.iter().zip(&shown) {
        files.put(name, page(study, found, &modes[k], k + 1).as_bytes())?;
    }
    let beside = files.finish()?;
    let left = (0..modes.len()).filter(|k| !shown.contains(k));
    let left = numbers(&left.map(|k| k + 1).collect::<Vec<_>>());
    let opens = match (pages.is_empty(), left.is_empty()) {
        (true, _) => String::new(),
        (_, true) => "; its pages open in any browser".to_owned(),
        _ => format!("; its pages open in any browser, modes {left} have none"),
    };
    Ok(format!("written to {}{opens}\n{beside}", path.display()))
}

/// The modes that have pages: the first of those that are not zero, then of the others.
fn shown(modes: &[Mode]) -> Vec<usize> {
    let (zero, moving): (Vec<usize>, Vec<usize>) =
        (0..modes.len()).partition(|&k| modes[k].value == [0.0; 2]);
    let mut shown: Vec<usize> = moving.into_iter().chain(zero).take(PAGES).collect();
    shown.sort_unstable();
    shown
}

/// Ascending numbers in words, as `1–3, 7`.
fn numbers(all: &[usize]) -> String {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for &k in all {
        match runs.last_mut() {
            Some([_, last]) if *last + 1 == k => *last = k,
            _ => runs.push([k, k]),
        }
    }
    let words = runs.iter().map(|[first, last]| match last - first {
        0 => first.to_string(),
        1 => format!("{first}, {last}"),
        _ => format!("{first}–{last}"),
    });
    words.collect::<Vec<_>>().join(", ")
}

/// A page on which a mode moves for a period, or for a second if it has none.
fn page(study: &Study, found: &Linearisation, mode: &Mode, number: usize) -> String {
    let mechanism = &study.prepared.mechanism;
    let size = study.prepared.assembly.size;
    let space = mechanism.space();
    let most = |shape: &[f64]| {
        let shares = shape.iter().enumerate();
        shares.fold(0.0_f64, |a, (j, d)| a.max(d.abs() / space.unit(j, size)))
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let largest = most(&found.shape(mode, 0.0, 1.0)).max(most(&found.shape(mode, quarter, 1.0)));
    let amplitude = if largest > 0.0 {
        AMPLITUDE / largest
    } else {
        0.0
    };
    let period = match mode.value[1] {
        0.0 => 1.0,
        rate => std::f64::consts::TAU / rate,
    };
    let mut recording = Recording::new(period, FRAMES as f64, 1);
    for k in 0..=PERIODS * FRAMES {
        let share = k as f64 / FRAMES as f64;
        let shape = found.shape(mode, std::f64::consts::TAU * share, amplitude);
        let q = space.displaced(&found.q, 1.0, &shape);
        let frame = Frame::at_rest(share * period, &q, mechanism.layout().n_v);
        recording.frames.push(frame);
    }
    let told = format!(
        "Mode {number} of small motions about t = {} s, with eigenvalue {} (1/s): drawn enlarged, and \
         without decay or growth",
        found.time,
        value(mode.value)
    );
    run_page(&RunPage {
        mechanism,
        analysis: None,
        hints: &[],
        shows: Shows::Mode(&told),
        stretches: None,
        recording: &recording,
        comparisons: &[],
        drives: &[],
        origin: &origin(),
        scene: pfaff::written_scene(&study.scene),
        options: &[],
        left_out: &[],
        work_precision: None,
    })
}

fn describe(d: &LinearisationDocument) -> String {
    let velocities = d.states.len() - d.positions;
    let mut text = format!(
        "{} at t = {} s: {}, {}, {}\n",
        d.scene,
        d.time,
        count(d.positions, "position", "positions"),
        count(velocities, "velocity", "velocities"),
        count(d.inputs.len(), "input", "inputs"),
    );
    let names: Vec<String> = d
        .states
        .iter()
        .map(|state| format!("{} ({})", state.name, state.unit))
        .collect();
    text.push_str(&format!("states: {}\n", names.join(", ")));
    if !d.inputs.is_empty() {
        let inputs = d.inputs.iter().map(|i| format!("{}.{}", i.name, i.what));
        text.push_str(&format!(
            "inputs: {}\n",
            inputs.collect::<Vec<_>>().join(", ")
        ));
    }
    if !d.held.is_empty() {
        let names = d.held.iter().map(|name| format!("`{name}`"));
        text.push_str(&format!(
            "held at t = {} s, since the state is at rest: {}\n",
            d.time,
            names.collect::<Vec<_>>().join(", ")
        ));
    }
    let Some(modes) = &d.modes else {
        text.push_str("eigenvalues: this program was built without them (feature `eigen`)\n");
        return text;
    };
    let header = [
        "mode",
        "eigenvalue (1/s)",
        "damped (Hz)",
        "undamped (Hz)",
        "damping",
        "moves",
    ];
    let rows = modes.iter().enumerate().map(|(k, mode)| {
        vec![
            (k + 1).to_string(),
            value([mode.real, mode.imaginary]),
            hertz(Some(mode.frequency).filter(|f| *f != 0.0)),
            hertz(mode.natural_frequency),
            mode.damping_ratio
                .filter(|_| mode.frequency != 0.0)
                // Rounding of an undamped motion has no sign.
                .map_or("–".to_owned(), |x| {
                    format!("{:.4} %", (1e6 * x).round() / 1e4 + 0.0)
                }),
            movers(mode, d.positions),
        ]
    });
    let all = std::iter::once(header.map(str::to_owned).to_vec()).chain(rows);
    text.push('\n');
    text.push_str(&columns(&all.collect::<Vec<_>>()));
    let first = match d.stability {
        _ if d.states.is_empty() => "nothing can move",
        Some("stable") => "stable: all small motions decay",
        Some("unstable") => "unstable: some small motions grow",
        _ => "first order does not decide: some small motions neither decay nor grow",
    };
    text.push_str(&format!("\n{first}\n"));
    text
}

/// A frequency of a mode that oscillates.
fn hertz(frequency: Option<f64>) -> String {
    frequency.map_or("–".to_owned(), |f| format!("{f:.6}"))
}

/// An eigenvalue, a conjugate pair as one.
fn value([re, im]: [f64; 2]) -> String {
    match (re, im) {
        (0.0, 0.0) => "0".to_owned(),
        (re, 0.0) => format!("{re:.6}"),
        (re, im) => format!("{re:.6} ± {im:.6}i"),
    }
}

/// The positions that take part most, or velocities if none does.
fn movers(mode: &ModeDocument, positions: usize) -> String {
    let size = |z: &[f64; 2]| z[0].hypot(z[1]);
    let takes_part = |part: &[(String, [f64; 2])]| -> Vec<String> {
        let largest = part.iter().map(|(_, z)| size(z)).fold(0.0, f64::max);
        let mut all: Vec<_> = part
            .iter()
            .filter(|(_, z)| size(z) > 0.1 * largest)
            .collect();
        all.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
        all.iter().take(4).map(|(name, _)| name.clone()).collect()
    };
    let (places, rates) = mode.shape.0.split_at(positions);
    let moves = places.iter().any(|(_, z)| size(z) > 0.5);
    takes_part(if moves { places } else { rates }).join(", ")
}

#[cfg(test)]
mod tests {
    use super::numbers;

    #[test]
    fn runs_of_numbers_are_told_by_their_ends() {
        assert_eq!(numbers(&[1, 2, 3, 7, 9, 10]), "1–3, 7, 9, 10");
        assert_eq!(numbers(&[]), "");
    }
}
