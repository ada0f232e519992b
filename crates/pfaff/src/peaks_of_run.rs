//! The largest values of the reactions during a run: the peak of each column of the table of
//! reactions, and the peaks of the magnitudes of force and moment.

use model::space::norm;
use model::{ConstraintId, Mechanism, Reaction, SpaceKind, System};
use report::{Peak, PeakRecorder, Quantity, ReactionColumn};
use solvability::{ReactionStretches, Stretches, VerdictTrack};

/// Recorder of the peaks of |F| and |T| of joints and drives while rows are added.
pub(crate) struct MagnitudesOfRun {
    space: SpaceKind,
    reactions: Vec<ConstraintId>,
    recorder: PeakRecorder,
}

/// The peak of a magnitude over a run.
pub(crate) struct MagnitudePeak {
    /// `None` if the magnitude is not determined at any row.
    peak: Option<Peak>,
    /// `None` if the magnitude is zero under any load.
    verdicts: Option<VerdictTrack>,
}

/// Recorder of the peaks while rows are added.
pub(crate) struct PeaksOfRun {
    columns: Vec<ReactionColumn>,
    numbers: PeakRecorder,
    magnitudes: MagnitudesOfRun,
}

/// The peaks of a run. A peak is `None` if the value is not determined at any row.
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
        Self {
            numbers: PeakRecorder::new(columns.len(), &mechanism.layout().break_times),
            magnitudes: MagnitudesOfRun::new(mechanism, reactions),
            columns,
        }
    }

    /// Adds a time at which the verdicts may change.
    pub(crate) fn cut(&mut self, t: f64) {
        self.numbers.cut(t);
        self.magnitudes.cut(t);
    }

    /// Adds a row: the values of the columns, and the reactions of all joints and drives.
    pub(crate) fn row(&mut self, t: f64, values: &[f64], all: &[Reaction]) {
        self.numbers.row(t, values.iter().copied());
        self.magnitudes.row(t, all);
    }

    /// Returns the peaks of the determined values.
    pub(crate) fn finish(&self, stretches: &Stretches) -> FoundPeaks {
        let columns = self.columns.iter();
        let tracks = columns.map(|column| column.quantity.verdicts(stretches));
        let tracks: Vec<Option<&VerdictTrack>> = tracks.collect();
        let numbers = self.numbers.finish(&tracks, stretches.extent);
        let magnitudes = self.magnitudes.finish(stretches).into_iter();
        let magnitudes = magnitudes.map(|(id, peaks)| (id, peaks.map(MagnitudePeak::determined)));
        FoundPeaks {
            magnitudes: magnitudes.collect(),
            columns: self.columns.iter().cloned().zip(numbers).collect(),
        }
    }
}

impl MagnitudesOfRun {
    /// Creates a recorder for these joints and drives.
    pub(crate) fn new(mechanism: &Mechanism, reactions: Vec<ConstraintId>) -> Self {
        let cuts = &mechanism.layout().break_times;
        Self {
            space: mechanism.space(),
            recorder: PeakRecorder::new(2 * reactions.len(), cuts),
            reactions,
        }
    }

    /// Returns the joints and drives.
    pub(crate) fn reactions(&self) -> &[ConstraintId] {
        &self.reactions
    }

    /// Adds a time at which the verdicts may change.
    pub(crate) fn cut(&mut self, t: f64) {
        self.recorder.cut(t);
    }

    /// Adds a row with the reactions of all joints and drives.
    pub(crate) fn row(&mut self, t: f64, all: &[Reaction]) {
        let own = self.reactions.iter().filter_map(|id| all.get(id.0));
        let magnitudes = own.flat_map(|load| [norm(&load.force), norm(&load.torque)]);
        self.recorder.row(t, magnitudes);
    }

    /// Returns the joints and drives with the peaks of |F| and |T|.
    pub(crate) fn finish(&self, stretches: &Stretches) -> Vec<(ConstraintId, [MagnitudePeak; 2])> {
        let parts = [self.space.forces(), self.space.torques()];
        let of = |id: &ConstraintId| {
            let found = stretches.reactions.get(id.0);
            let names = parts.clone().map(|part| &self.space.components()[part]);
            names.map(|names| found.and_then(|found| together(found, names)))
        };
        let verdicts: Vec<[Option<VerdictTrack>; 2]> = self.reactions.iter().map(of).collect();
        let tracks = verdicts.iter().flatten().map(Option::as_ref);
        let tracks: Vec<Option<&VerdictTrack>> = tracks.collect();
        let mut peaks = self.recorder.finish(&tracks, stretches.extent).into_iter();
        let mut found = |verdicts| MagnitudePeak {
            peak: peaks.next().flatten(),
            verdicts,
        };
        let each = self.reactions.iter().zip(verdicts);
        each.map(|(id, verdicts)| (*id, verdicts.map(&mut found)))
            .collect()
    }
}

impl MagnitudePeak {
    /// Returns the peak over the intervals on which the magnitude is determined, unless the
    /// magnitude is zero under any load.
    fn determined(self) -> Option<Peak> {
        self.peak.filter(|_| self.verdicts.is_some())
    }

    /// Returns the peak, if the magnitude is determined on the whole run.
    pub(crate) fn of_run(self) -> Option<Peak> {
        let verdicts = self.verdicts.as_ref();
        let is_unique = verdicts.is_none_or(|verdicts| verdicts.of_run().is_unique());
        self.peak.filter(|_| is_unique)
    }
}

/// Returns the verdicts on these components together. Returns `None` if all of these components are
/// zero under any load.
pub(crate) fn together(found: &ReactionStretches, names: &[&str]) -> Option<VerdictTrack> {
    let tracks = names.iter().filter_map(|name| found.component(name));
    let tracks: Vec<&VerdictTrack> = tracks.collect();
    (!tracks.is_empty()).then(|| VerdictTrack::together(&tracks))
}
