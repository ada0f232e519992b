//! Determines the verdicts of a motion from its sample times. Also determines the time intervals
//! between break times on which the rank differs.

use model::{Mechanism, System};

use super::data::Stretch;
use super::path::{Path, Sample};
use super::words;
use crate::components::all_components;
use crate::state::State;
use crate::stretches::{InstantOrder, Stretches, VerdictRecorder};

/// Returns the verdicts at those sample times whose rank is the rank of their interval of the
/// motion.
pub(super) fn of_samples<F: FnMut(f64) -> State>(path: &Path<'_, F>) -> Stretches {
    let (mechanism, samples) = (path.mechanism, &path.samples);
    let mut recorder = VerdictRecorder::new(all_components(mechanism.layout()).count());
    let pieces = pieces(path);
    for piece in &pieces {
        recorder.cut(piece.from);
    }
    for sample in samples {
        let begun = pieces.partition_point(|piece| piece.from <= sample.t);
        let rank = pieces[begun.max(1) - 1].rank;
        let is_typical = sample.decision.is_decided() && Some(sample.decision.rank) == rank;
        let own = sample.judged.iter();
        let verdicts = own.map(|j| is_typical.then(|| j.verdict.clone()));
        recorder.see(sample.t, InstantOrder::Next, verdicts.collect());
    }
    let tracks = recorder.finish(path.extent());
    Stretches::of_components(mechanism, path.extent(), tracks)
}

/// Returns the time intervals whose rank differs from the rank almost everywhere, in chronological
/// order. Neighbouring intervals with the same rank are merged.
pub(super) fn of_other_rank<F: FnMut(f64) -> State>(path: &Path<'_, F>) -> Vec<Stretch> {
    let rows = path.mechanism.layout().rows();
    let mut found: Vec<Stretch> = Vec::new();
    for Piece { from, to, rank } in pieces(path) {
        // An interval without a decided rank is not reported.
        let Some(rank) = rank.filter(|rank| *rank != path.rank) else {
            continue;
        };
        let redundancy = rows - rank;
        match found.last_mut() {
            Some(last) if last.to == from && last.redundancy == redundancy => last.to = to,
            _ => found.push(Stretch {
                from,
                to,
                redundancy,
                text: String::new(),
            }),
        }
    }
    for stretch in &mut found {
        stretch.text = words::stretch(stretch, rows - path.rank);
    }
    found
}

/// A time interval of the motion between break times.
struct Piece {
    from: f64,
    to: f64,
    /// The largest decided rank at the sample times inside the interval.
    rank: Option<usize>,
}

fn pieces<F: FnMut(f64) -> State>(path: &Path<'_, F>) -> Vec<Piece> {
    let [first, last] = path.extent();
    let ends = ends_of_pieces(path.mechanism, first, last);
    let piece = |ends: &[f64]| {
        let inside = |s: &&Sample| ends[0] < s.t && s.t < ends[1];
        let decided = path.samples.iter().filter(|s| s.decision.is_decided());
        Piece {
            from: ends[0],
            to: ends[1],
            rank: decided.filter(inside).map(|s| s.decision.rank).max(),
        }
    };
    ends.windows(2).map(piece).collect()
}

/// Returns the first and last time, and the break times between them.
pub(super) fn ends_of_pieces(mechanism: &Mechanism, first: f64, last: f64) -> Vec<f64> {
    let breaks = mechanism.layout().break_times.iter().copied();
    let inside = breaks.filter(|t| first < *t && *t < last);
    [first].into_iter().chain(inside).chain([last]).collect()
}
