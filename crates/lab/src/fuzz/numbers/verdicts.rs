//! The verdicts of the product on a run, which are the subject of the test. No decision of the
//! reference is made in this module.
//!
//! The cuts of a run are the events and the break times of functions of time. Between two cuts, a
//! component is `unique` if it is unique at every state of the open interval. It is `not unique` if
//! it is not unique at one state, and otherwise undecided.

use model::{ConfigurationAccuracy, ConstraintId, Mechanism};
use solvability::{Analysis, AnalysisError, Verdict, VerdictStretch, analyse_known};

use super::forms::Form;
use super::run::{RTOL, Row, Run};

/// A verdict as one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Word {
    /// The component is determined.
    Unique,
    /// The verdict is undecided.
    Undecided,
    /// The component is not determined.
    NotUnique,
}

/// The verdict on a component in an interval of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Start time (s), which belongs to the interval.
    pub from: f64,
    /// End time (s), which belongs to the interval only at the end of the run.
    pub to: f64,
    /// Verdict in the interval.
    pub word: Word,
}

/// The verdicts on one component along a run.
#[derive(Clone, Debug)]
pub struct OnRun {
    /// Intervals from the first to the last time, without gaps.
    pub stretches: Vec<Stretch>,
    /// The largest sensitivity at the states that were examined, if it is known.
    pub sensitivity: Option<f64>,
}

impl OnRun {
    /// Returns the interval that contains a time. At a cut, this is the interval that begins at the
    /// cut.
    #[must_use]
    pub fn at(&self, t: f64) -> Option<&Stretch> {
        self.stretches.iter().rev().find(|s| s.from <= t)
    }

    /// Whether the component is determined at a time.
    #[must_use]
    pub fn is_determined(&self, t: f64) -> bool {
        self.at(t).is_some_and(|s| s.word == Word::Unique)
    }
}

/// Computes the verdicts and sensitivities that the tests check.
pub trait Judge: Sync {
    /// Returns the verdicts on components along a run.
    ///
    /// # Errors
    /// Returns an error if a state cannot be analysed.
    fn on_run(&self, run: &Run, forms: &[Form]) -> Result<Vec<OnRun>, AnalysisError>;

    /// Returns the sensitivities of components at one state.
    fn sensitivities(&self, mechanism: &Mechanism, forms: &[Form], row: &Row) -> Option<AtState>;
}

/// Sensitivities at one state.
#[derive(Clone, Debug)]
pub struct AtState {
    /// The independent rows.
    pub kept: Vec<usize>,
    /// Sensitivity by component, if the component is determined and its sensitivity is known.
    pub each: Vec<Option<f64>>,
}

/// The product under test.
pub struct Product;

impl Judge for Product {
    fn on_run(&self, run: &Run, forms: &[Form]) -> Result<Vec<OnRun>, AnalysisError> {
        let (mechanism, rows) = (&run.study.prepared.mechanism, &run.rows[..]);
        let mut all: Vec<OnRun> = forms.iter().map(|form| on_run(run, form)).collect();
        // The states are the initial state, whose sensitivities a run reports, and the middle of
        // each interval.
        if let Some(row) = rows.first() {
            let found = sensitivities(mechanism, &analysis(mechanism, row)?, forms, row);
            for (own, new) in all.iter_mut().zip(found.iter().flat_map(|f| &f.each)) {
                own.sensitivity = *new;
            }
        }
        for piece in ends(rows, &run.cuts).windows(2) {
            let inside = |row: &&Row| piece[0] < row.t && row.t < piece[1];
            let states: Vec<&Row> = rows.iter().filter(inside).collect();
            let Some(row) = states.get(states.len() / 2) else {
                continue;
            };
            let found = sensitivities(mechanism, &analysis(mechanism, row)?, forms, row);
            for (own, new) in all.iter_mut().zip(found.iter().flat_map(|f| &f.each)) {
                own.sensitivity = larger(own.sensitivity, *new);
            }
        }
        Ok(all)
    }

    fn sensitivities(&self, mechanism: &Mechanism, forms: &[Form], row: &Row) -> Option<AtState> {
        sensitivities(mechanism, &analysis(mechanism, row).ok()?, forms, row)
    }
}

/// Returns the verdict of the run on a component. A component that is zero under any load is
/// determined.
fn on_run(run: &Run, form: &Form) -> OnRun {
    let track = run.stretches.as_ref().map(|found| {
        let own = found.reactions[form.group].component(form.name);
        own.map_or_else(
            || {
                vec![Stretch {
                    from: found.extent[0],
                    to: found.extent[1],
                    word: Word::Unique,
                }]
            },
            |track| track.stretches().iter().map(stretch).collect(),
        )
    });
    OnRun {
        stretches: track.unwrap_or_default(),
        sensitivity: None,
    }
}

fn stretch(of: &VerdictStretch) -> Stretch {
    Stretch {
        from: of.from,
        to: of.to,
        word: match of.verdict {
            Verdict::Unique => Word::Unique,
            Verdict::NotUnique => Word::NotUnique,
            _ => Word::Undecided,
        },
    }
}

fn larger(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        (a, b) => a.or(b),
    }
}

/// Returns the analysis of a state. The accuracy of the state is the tolerance of the run.
fn analysis(mechanism: &Mechanism, row: &Row) -> Result<Analysis, AnalysisError> {
    let known = match row.t {
        0.0 => ConfigurationAccuracy::AsStored,
        _ => ConfigurationAccuracy::To(RTOL),
    };
    analyse_known(mechanism, row.t_before, &row.q, known)
}

fn ends(rows: &[Row], cuts: &[f64]) -> Vec<f64> {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Vec::new();
    };
    let inside = |t: &&f64| first.t < **t && **t < last.t;
    let mut ends = vec![first.t, last.t];
    ends.extend(cuts.iter().filter(inside));
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}

/// Returns the verdict of an analysis on a component.
fn word_of(analysis: &Analysis, form: &Form) -> Word {
    let reaction = &analysis.reactions[form.group];
    if reaction.determines(form.name) {
        return Word::Unique;
    }
    let own = reaction.components.iter().find(|c| c.name == form.name);
    match &own.map_or(&reaction.wrench, |c| &c.judgement).verdict {
        Verdict::Unique => Word::Unique,
        Verdict::NotUnique => Word::NotUnique,
        _ => Word::Undecided,
    }
}

fn sensitivities(
    mechanism: &Mechanism,
    analysis: &Analysis,
    forms: &[Form],
    row: &Row,
) -> Option<AtState> {
    let found = analysis.sensitivities(mechanism, &row.q, &row.v).ok()?;
    let each = forms.iter().map(|form| {
        let own = found.component(ConstraintId(form.group), form.name);
        let change = own.map(|s| s.change);
        change.filter(|_| word_of(analysis, form) == Word::Unique)
    });
    Some(AtState {
        kept: analysis.decision.kept.clone(),
        each: each.collect(),
    })
}
