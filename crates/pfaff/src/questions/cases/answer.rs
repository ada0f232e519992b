//! The load cases with their peaks, as a document and as a table.

use std::io::Write;

use report::{ByName, ReactionColumn, Table, TableError};
use scene::LoadCase;
use serde::Serialize;

use crate::documents::{ExtremeDocument, LoadPeak, RunDocument};
use crate::error::OPENING;
use crate::question::Answer;
use crate::questions::simulate::SimulateAnswer;
use crate::refusal::Refusal;
use crate::words::Block;

/// File name of the table of all peaks.
pub(super) const TABLE: &str = "cases.csv";

/// Columns of the table.
const COLUMNS: [&str; 9] = [
    "case",
    "rank",
    "redundancy",
    "mobility",
    "name",
    "load",
    "unit",
    "peak",
    "time",
];

/// The run of a case, with the columns of its reactions and groups.
pub(super) struct SimulatedCase {
    pub(super) run: SimulateAnswer,
    pub(super) columns: Vec<ReactionColumn>,
}

/// The load cases of a scene with their peak loads.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CasesAnswer {
    /// Name of the scene.
    pub scene: String,
    /// Whether the work was interrupted before the last case.
    #[serde(rename = "partial")]
    pub interrupted: bool,
    /// The cases in the order of the scene.
    pub cases: Vec<CaseDocument>,
    /// The cases that are done, apart by ranks and verdicts: peaks are compared only within a set.
    pub sets: Vec<CaseSet>,
}

/// A load case.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CaseDocument {
    /// Name of the case.
    pub name: String,
    /// Values of the load case, which replace values of the scene.
    pub set: Vec<String>,
    /// Name of the directory with the files of its run.
    pub directory: String,
    /// `done`, `opened` (the run ended when its one-sided joints opened), `stopped`, `refused` or
    /// `interrupted`.
    pub status: &'static str,
    /// Reason why the case is not done.
    pub error: Option<String>,
    /// Warnings of the run.
    pub warnings: Vec<String>,
}

/// Cases whose mechanisms have the same ranks and the same verdicts.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CaseSet {
    /// Names of the cases.
    pub cases: Vec<String>,
    /// Rank of C at the start.
    pub rank: usize,
    /// Degree of redundancy at the start.
    pub redundancy: usize,
    /// Degrees of freedom at the start.
    pub mobility: usize,
    /// Joints and drives whose reaction is not unique during the run.
    pub not_unique: Vec<String>,
    /// Joints and drives whose verdict is undecided.
    pub undecided: Vec<String>,
    /// The peak loads of these cases.
    pub peaks: Vec<CasePeaks>,
}

/// The peaks of one load.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CasePeaks {
    /// Name of the joint, drive, group or force element.
    pub name: String,
    /// `force` and `moment` for the largest magnitudes, `force at most` and `moment at most` for
    /// their upper bounds, or the name of a component.
    pub load: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// The peak in each case, by name; `null` if the load is not determined during the whole run.
    pub cases: ByName<Option<ExtremeDocument>>,
    /// The largest peak; `null` if a case has none, or if all are zero.
    pub largest: Option<PeakOfCase>,
}

/// The peak of a load in a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PeakOfCase {
    /// Name of the case.
    pub case: String,
    /// The value with its sign, and its time.
    #[serde(flatten)]
    pub peak: ExtremeDocument,
}

impl CasesAnswer {
    pub(super) fn new(scene: &str) -> Self {
        Self {
            scene: scene.to_owned(),
            ..Self::default()
        }
    }

    /// Adds a case with its run.
    pub(super) fn add(
        &mut self,
        case: &LoadCase,
        directory: &str,
        ended: Result<SimulatedCase, Refusal>,
    ) {
        let (status, error) = match &ended {
            Ok(SimulatedCase { run, .. }) if run.document.partial => {
                ("interrupted", run.document.error.clone())
            }
            Ok(_) => ("done", None),
            Err(refusal) if refusal.code() == Some(OPENING) => {
                ("opened", Some(refusal.document().error))
            }
            Err(refusal @ Refusal::Stopped(..)) => ("stopped", Some(refusal.document().error)),
            Err(refusal) => ("refused", Some(refusal.document().error)),
        };
        let settings = case.settings.iter();
        let settings = settings.map(|own| format!("{} = {}", own.key, own.expression));
        self.cases.push(CaseDocument {
            name: case.name.clone(),
            set: settings.collect(),
            directory: directory.to_owned(),
            status,
            error,
            warnings: ended
                .as_ref()
                .map_or_else(|_| Vec::new(), |ended| warnings(&ended.run)),
        });
        if let Ok(SimulatedCase { run, columns }) = ended
            && status == "done"
        {
            self.add_run(&case.name, &run.document, &columns);
        }
    }

    fn add_run(&mut self, case: &str, run: &RunDocument, columns: &[ReactionColumn]) {
        let peaks = LoadPeak::all(run, columns);
        let judged = |word: &str| {
            let named = run.reactions.0.iter().filter(|(_, r)| r.verdict() == word);
            named.map(|(name, _)| name.clone()).collect::<Vec<_>>()
        };
        let own = CaseSet {
            cases: Vec::new(),
            rank: run.rank,
            redundancy: run.redundancy,
            mobility: run.mobility,
            not_unique: judged("not_unique"),
            undecided: judged("undecided"),
            peaks: Vec::new(),
        };
        let place = self.sets.iter().position(|set| set.is_like(&own));
        let place = place.unwrap_or_else(|| {
            self.sets.push(own);
            self.sets.len() - 1
        });
        let set = &mut self.sets[place];
        for LoadPeak {
            name,
            load,
            unit,
            peak,
        } in peaks
        {
            let known = set
                .peaks
                .iter_mut()
                .find(|p| p.name == name && p.load == load);
            match known {
                Some(known) => known.cases.0.push((case.to_owned(), peak)),
                None => {
                    // Earlier cases have no such load.
                    let earlier = set.cases.iter().map(|case| (case.clone(), None));
                    let cases = earlier.chain([(case.to_owned(), peak)]);
                    set.peaks.push(CasePeaks {
                        cases: ByName(cases.collect()),
                        largest: None,
                        name,
                        load,
                        unit,
                    });
                }
            }
        }
        set.cases.push(case.to_owned());
    }

    /// Finds the largest peaks, and removes forces and moments that are zero in every case.
    pub(super) fn finish(&mut self) {
        for set in &mut self.sets {
            set.peaks.retain(|peaks| !peaks.is_zero());
            let n = set.cases.len();
            for peaks in &mut set.peaks {
                peaks.largest = peaks.largest(n);
            }
        }
    }

    /// Writes the table of all peaks, with one line for each case and load.
    pub(super) fn write_table<W: Write>(&self, out: W) -> Result<W, TableError> {
        let header = COLUMNS.map(str::to_owned);
        let mut table = Table::new(TABLE, out, &header)?;
        for set in &self.sets {
            let ranks = (set.rank, set.redundancy, set.mobility);
            for peaks in &set.peaks {
                let CasePeaks {
                    name, load, unit, ..
                } = peaks;
                for (case, peak) in &peaks.cases.0 {
                    let peak = peak.map(|peak| (peak.value, peak.time)).unzip();
                    table.record((case, ranks, name, load, unit, peak))?;
                }
            }
        }
        table.finish()
    }
}

impl CaseSet {
    /// Whether the cases of both sets have the same ranks and verdicts.
    fn is_like(&self, other: &Self) -> bool {
        let of = |set: &Self| (set.rank, set.redundancy, set.mobility);
        of(self) == of(other)
            && self.not_unique == other.not_unique
            && self.undecided == other.undecided
    }
}

impl CasePeaks {
    fn is_zero(&self) -> bool {
        let mut each = self.cases.0.iter();
        each.all(|(_, peak)| peak.is_some_and(|peak| peak.value == 0.0))
    }

    /// Returns the largest peak, if every case has one.
    fn largest(&self, cases: usize) -> Option<PeakOfCase> {
        let known = self.cases.0.iter().filter_map(|(case, peak)| {
            let case = case.clone();
            (*peak).map(|peak| PeakOfCase { case, peak })
        });
        let known: Vec<PeakOfCase> = known.collect();
        let is_known = known.len() == cases;
        let size = |of: &PeakOfCase| of.peak.value.abs();
        let largest = known.into_iter();
        let largest = largest.reduce(|best, own| if size(&own) > size(&best) { own } else { best });
        largest.filter(|largest| is_known && size(largest) > 0.0)
    }
}

/// Returns the warnings of a run.
fn warnings(run: &SimulateAnswer) -> Vec<String> {
    let of = |block| match block {
        Block::Sentence { lead, text } => {
            let text = lead + &text;
            // A code in square brackets may follow.
            let (code, text) = text.strip_prefix("warning")?.split_once(": ")?;
            (code.is_empty() || code.starts_with('[')).then(|| text.to_owned())
        }
        _ => None,
    };
    run.words().into_iter().filter_map(of).collect()
}
