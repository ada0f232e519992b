//! Pages with animated modes.

use crate::page::{Origin, RunPage, Shows, run_page};
use dynamics::linearise::{Linearisation, Mode};
use model::System;
use report::{Frame, Recording};

use super::words::value;
use crate::report_builder::written_scene;
use crate::study::Study;

/// Number of modes with separate pages. Modes with nonzero eigenvalues come first. Other modes are
/// only in the tables.
const PAGES: usize = 12;

/// Frames in one period on the page of a mode.
const FRAMES: usize = 40;

/// Number of periods on the page of a mode.
const PERIODS: usize = 8;

/// The largest displacement of a mode on its page: a fraction of the size of the mechanism, or an
/// angle (rad).
const AMPLITUDE: f64 = 0.15;

/// Returns the pages of modes, with the index of each mode (0-based). Some modes have no page.
pub(super) fn all(
    study: &Study,
    found: &Linearisation,
    modes: &[Mode],
    origin: &Origin,
) -> Vec<(usize, String)> {
    let page = |k| (k, page(study, found, (&modes[k], k + 1), origin));
    shown(modes).into_iter().map(page).collect()
}

/// Selects the modes that have pages: first modes with nonzero eigenvalues, then other modes.
fn shown(modes: &[Mode]) -> Vec<usize> {
    let (zero, moving): (Vec<usize>, Vec<usize>) =
        (0..modes.len()).partition(|&k| modes[k].value == [0.0; 2]);
    let mut shown: Vec<usize> = moving.into_iter().chain(zero).take(PAGES).collect();
    shown.sort_unstable();
    shown
}

/// Builds a page with the motion of a mode during one period. If the mode does not oscillate, the
/// duration is one second.
fn page(
    study: &Study,
    found: &Linearisation,
    (mode, number): (&Mode, usize),
    origin: &Origin,
) -> String {
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
    let what = format!(
        "Mode {number} of the small motions about the configuration at t = {} s has the eigenvalue {} (1/s). \
         The picture enlarges the amplitude and omits decay and growth.",
        found.time,
        value(mode.value)
    );
    run_page(&RunPage {
        mechanism,
        analysis: None,
        hints: &[],
        shows: Shows::Mode(&what),
        stretches: None,
        recording: &recording,
        comparisons: &[],
        bands: &[],
        groups: &[],
        plots: &[],
        drives: &[],
        origin,
        scene: written_scene(&study.scene),
        options: &[],
        left_out: &[],
        work_precision: None,
    })
}
