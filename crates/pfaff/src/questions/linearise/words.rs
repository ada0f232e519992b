//! Text about small motions.

use super::answer::{LineariseAnswer, ModeOfMotion};
use crate::words::{Block, Cell, count};
use model::words::{marked, short};

pub(super) fn of(d: &LineariseAnswer) -> Vec<Block> {
    let velocities = d.states.len() - d.positions;
    let mut blocks = Vec::new();
    let mut say = |text: String| blocks.push(Block::sentence(text));
    say(format!(
        "{} at t = {} s: {}, {}, {}",
        d.scene,
        d.time,
        count(d.positions, "position", "positions"),
        count(velocities, "velocity", "velocities"),
        count(d.inputs.len(), "input", "inputs"),
    ));
    let states = d.states.iter().map(|s| format!("{} ({})", s.name, s.unit));
    say(format!("states: {}", states.collect::<Vec<_>>().join(", ")));
    if !d.inputs.is_empty() {
        let inputs = d.inputs.iter().map(|i| format!("{}.{}", i.name, i.what));
        say(format!("inputs: {}", inputs.collect::<Vec<_>>().join(", ")));
    }
    if !d.held.is_empty() {
        let (time, held) = (d.time, marked(&d.held));
        say(format!(
            "locked at t = {time} s, because the state is at rest: {held}"
        ));
    }
    let Some(modes) = &d.modes else {
        say("the eigenvalues were not found; only the matrices are available".to_owned());
        return blocks;
    };
    let lines = modes.iter().enumerate().map(|(k, mode)| {
        let ratio = mode.damping_ratio.filter(|_| mode.frequency != 0.0);
        [
            (k + 1).to_string().into(),
            value([mode.real, mode.imaginary]).into(),
            Cell::quantity(Some(mode.frequency).filter(|f| *f != 0.0), "Hz"),
            Cell::quantity(mode.natural_frequency, "Hz"),
            // The damping ratio of an undamped motion is a rounding error and is printed without a
            // sign.
            Cell::quantity(ratio.map(|x| (1e6 * x).round() / 1e4), "%"),
            movers(mode, d.positions).into(),
        ]
    });
    let columns = [
        "mode",
        "eigenvalue (1/s)",
        "damped",
        "undamped",
        "damping ratio",
        "moves",
    ];
    blocks.push(Block::table(columns, lines));
    let first = match d.stability {
        _ if d.states.is_empty() => "no body can move",
        Some("stable") => "stable: all small motions decay",
        Some("unstable") => "unstable: some small motions grow",
        _ => "undecided at first order: some small motions neither decay nor grow",
    };
    blocks.push(Block::sentence(first));
    blocks.extend(pages(d, modes.len()));
    blocks
}

/// Lists the modes with pages, if pages were requested.
fn pages(d: &LineariseAnswer, modes: usize) -> Option<Block> {
    if d.pages.is_empty() {
        return None;
    }
    let has_page = |k: &usize| d.pages.iter().any(|(shown, _)| shown == k);
    let left: Vec<usize> = (0..modes).filter(|k| !has_page(k)).map(|k| k + 1).collect();
    let without = match left.as_slice() {
        [] => String::new(),
        left => format!("; no pages for modes {}", ranges(left)),
    };
    Some(Block::sentence(format!(
        "open the pages of the modes in a browser{without}"
    )))
}

/// Formats ascending numbers as ranges, such as `1–3, 7`.
fn ranges(all: &[usize]) -> String {
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

/// Formats an eigenvalue. A conjugate pair is one text.
pub(super) fn value([re, im]: [f64; 2]) -> String {
    match (re, im) {
        (0.0, 0.0) => "0".to_owned(),
        (re, 0.0) => short(re),
        (re, im) => format!("{} ± {}i", short(re), short(im)),
    }
}

/// Lists the positions with the largest amplitudes, or the velocities if all positions are zero.
fn movers(mode: &ModeOfMotion, positions: usize) -> String {
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
    use super::ranges;

    #[test]
    fn ranges_are_named_by_their_ends() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1–3, 7, 9, 10");
        assert_eq!(ranges(&[]), "");
    }
}
