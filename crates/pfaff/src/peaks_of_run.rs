//! The largest values of the reactions during a run: of each column of the table of reactions, and
//! of the magnitudes of force and moment.

use model::space::norm;
use model::{ConstraintId, Mechanism, Reaction, SpaceKind, System};
use report::{Peak, PeakRecorder, Quantity, ReactionColumn};
use solvability::{ReactionStretches, Stretches, VerdictTrack};

/// Recorder of the peaks while rows are added.
pub(crate) struct PeaksOfRun {
    space: SpaceKind,
    columns: Vec<ReactionColumn>,
    /// The joints and drives of the columns.
    reactions: Vec<ConstraintId>,
    numbers: PeakRecorder,
    magnitudes: PeakRecorder,
}

/// The peaks of a run, each `None` if the value is not determined at any row.
#[derive(Default)]
pub(crate) struct FoundPeaks {
    /// The columns of the table of reactions with the peaks of their values.
    pub(crate) columns: Vec<(ReactionColumn, Option<Peak>)>,
    /// The joints and drives with the peaks of |F| and of |T|.
    pub(crate) magnitudes: Vec<(ConstraintId, [Option<Peak>; 2])>,
}

impl PeaksOfRun {
    /// Creates a recorder for these columns of reactions.
    pub(crate) fn new(mechanism: &Mechanism, columns: Vec<ReactionColumn>) -> Self {
        let of_columns = columns.iter().filter_map(|column| match column.quantity {
            Quantity::Component(id, _) => Some(id),
            Quantity::Group(..) => None,
        });
        let mut reactions: Vec<ConstraintId> = of_columns.collect();
        reactions.dedup();
        let cuts = &mechanism.layout().break_times;
        Self {
            space: mechanism.space(),
            numbers: PeakRecorder::new(columns.len(), cuts),
            magnitudes: PeakRecorder::new(2 * reactions.len(), cuts),
            columns,
            reactions,
        }
    }

    /// Adds a time at which the verdicts may change.
    pub(crate) fn cut(&mut self, t: f64) {
        self.numbers.cut(t);
        self.magnitudes.cut(t);
    }

    /// Adds a row: the values of the columns, and the reactions of all joints and drives.
    pub(crate) fn row(&mut self, t: f64, values: &[f64], all: &[Reaction]) {
        self.numbers.row(t, values);
        let own = self.reactions.iter().filter_map(|id| all.get(id.0));
        let magnitudes = own.flat_map(|load| [norm(&load.force), norm(&load.torque)]);
        let magnitudes: Vec<f64> = magnitudes.collect();
        self.magnitudes.row(t, &magnitudes);
    }

    /// Returns the peaks of the determined values.
    pub(crate) fn finish(&self, stretches: &Stretches) -> FoundPeaks {
        let columns = self.columns.iter();
        let tracks = columns.map(|column| column.quantity.verdicts(stretches));
        let tracks: Vec<Option<&VerdictTrack>> = tracks.collect();
        let numbers = self.numbers.finish(&tracks, stretches.extent);
        let parts = [self.space.forces(), self.space.torques()];
        let of = |id: &ConstraintId| {
            let found = stretches.reactions.get(id.0);
            let names = parts.clone().map(|part| &self.space.components()[part]);
            names.map(|names| found.and_then(|found| together(found, names)))
        };
        let owned: Vec<Option<VerdictTrack>> = self.reactions.iter().flat_map(of).collect();
        let tracks: Vec<Option<&VerdictTrack>> = owned.iter().map(Option::as_ref).collect();
        let found = self.magnitudes.finish(&tracks, stretches.extent);
        let known = found.into_iter().zip(tracks);
        let mut known = known.map(|(peak, track)| peak.filter(|_| track.is_some()));
        let mut next = || known.next().flatten();
        let magnitudes = self.reactions.iter().map(|id| (*id, [next(), next()]));
        FoundPeaks {
            magnitudes: magnitudes.collect(),
            columns: self.columns.iter().cloned().zip(numbers).collect(),
        }
    }
}

/// The verdicts on these components together; `None` if all of them are zero under any load.
fn together(found: &ReactionStretches, names: &[&str]) -> Option<VerdictTrack> {
    let tracks = names.iter().filter_map(|name| found.component(name));
    let tracks: Vec<&VerdictTrack> = tracks.collect();
    (!tracks.is_empty()).then(|| VerdictTrack::together(&tracks))
}
