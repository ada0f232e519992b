//! The largest values of the reactions during a run: of each column of the table of reactions, and
//! of the magnitudes of force and moment.

use model::space::norm;
use model::{ConstraintId, Mechanism, Reaction, SpaceKind, System};
use report::{Column, Peak, PeakRecorder, Quantity, ReactionColumn};
use solvability::{ReactionStretches, Stretches, VerdictTrack};

use crate::documents::{
    ExtremeDocument, LoadOfRunDocument, MagnitudeOfRunDocument, PeakDocument, RunDocument,
};
use crate::words::load_unit;

/// Unit of forces.
const FORCE: &str = "N";

/// Unit of moments.
const MOMENT: &str = "N·m";

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

/// A load with its peak during a run.
pub(crate) struct LoadPeak {
    /// Name of the joint, drive, group or force element.
    pub(crate) name: String,
    /// `force` and `moment` for the largest magnitudes, `force at most` and `moment at most` for
    /// their upper bounds, or the name of a component.
    pub(crate) load: String,
    /// Unit of the peak.
    pub(crate) unit: &'static str,
    /// The peak; `None` if the load is not determined during the whole run.
    pub(crate) peak: Option<ExtremeDocument>,
}

impl LoadPeak {
    /// Returns the peaks of all loads of a run. Its reactions and groups have these columns.
    pub(crate) fn all(run: &RunDocument, columns: &[ReactionColumn]) -> Vec<Self> {
        let mut all = Vec::new();
        let mut add = |name: &str, load: &str, unit, peak| {
            all.push(Self {
                name: name.to_owned(),
                load: load.to_owned(),
                unit,
                peak,
            });
        };
        let throughout = |peak: &Option<PeakDocument>| {
            let peak = peak.as_ref()?;
            let value = peak.value.determined()?;
            let is_whole = matches!(peak.over.as_slice(), [[_, to]] if *to >= run.t_end);
            is_whole.then(|| ExtremeDocument::new(value, peak.time))
        };
        for (name, reaction) in &run.reactions.0 {
            let has = |letter| {
                reaction
                    .components
                    .0
                    .iter()
                    .any(|(own, _)| own.starts_with(letter))
            };
            let peak = reaction.peak.as_ref();
            if has('F') {
                add(
                    name,
                    "force",
                    FORCE,
                    peak.and_then(|peak| throughout(&peak.force)),
                );
            }
            if has('T') {
                add(
                    name,
                    "moment",
                    MOMENT,
                    peak.and_then(|peak| throughout(&peak.moment)),
                );
            }
            let of_definition = columns.iter().find(|column| {
                let Column { owner, number, .. } = &column.column;
                matches!(column.quantity, Quantity::Component(..))
                    && owner == name
                    && load_unit(number).is_empty()
            });
            if let Some(ReactionColumn { column, .. }) = of_definition {
                let own = reaction.components.get(column.number);
                let peak = own.and_then(|own| throughout(&own.peak));
                add(name, column.number, column.unit, peak);
            }
            if let Some(MagnitudeOfRunDocument { force, moment }) = reaction.magnitude_at_most {
                add(name, "force at most", FORCE, force);
                add(name, "moment at most", MOMENT, moment);
            }
        }
        for ReactionColumn {
            column, quantity, ..
        } in columns
        {
            let (Quantity::Group(..), Some(group)) = (quantity, run.groups.get(&column.owner))
            else {
                continue;
            };
            let peak = match group.components.get(column.number) {
                Some(number) => &number.peak,
                None => &group.peak,
            };
            add(&column.owner, column.number, column.unit, throughout(peak));
        }
        // A load without a peak is zero, because the state determines loads of force elements.
        let peak_of =
            |peak: Option<ExtremeDocument>| Some(peak.unwrap_or(ExtremeDocument::new(0.0, 0.0)));
        for (name, LoadOfRunDocument { peak, .. }) in &run.loads.0 {
            add(name, "force", FORCE, peak_of(peak.force));
            add(name, "moment", MOMENT, peak_of(peak.moment));
        }
        all
    }
}
