//! Examines one mechanism: compares the values that the product reports as determined on a run with
//! the reference solver at the same states.

mod choices;
mod data;
mod runs;
mod states;

use model::{Mechanism, System};
use nalgebra::DVector;
use solvability::Compliance;

use super::findings::{Count, Findings, Kind};
use super::forms::{Form, forms};
use super::oracle::{Fault, Instant};
use super::refusals;
use super::run::{Row, Run, prepared, run};
use super::sets::{compliances, dropped, elastic, without};
use super::verdicts::{Judge, OnRun, Product};
use suite::numbers::Numbers;

/// Largest difference that counts as agreement at one state, as a fraction of the load.
const AT_STATE: f64 = 1e-8;

/// A load below this value (N) counts as zero.
const LOAD: f64 = 1e-9;

/// Values below this bound (N) are rounding errors, because inertial forces are computed from
/// coordinates of some metres and velocities of some metres per second.
const ROUNDING: f64 = 1e-12;

/// Returns the findings for a scene; the random numbers select redundant rows and compliances.
#[must_use]
pub fn examine(text: &str, numbers: &mut Numbers) -> Findings {
    examine_by(&Product, text, numbers)
}

/// Like [`examine`], with verdicts from another source.
#[must_use]
pub fn examine_by(judge: &dyn Judge, text: &str, numbers: &mut Numbers) -> Findings {
    let mut findings = Findings::default();
    let study = match prepared(text, None) {
        Ok(study) => study,
        Err(error) => {
            refusals::at_start(text, &error, numbers, &mut findings);
            return findings;
        }
    };
    let run = run(study);
    match &run.stopped {
        None => findings.count(Count::Ran, 1),
        Some(error) => refusals::on_the_way(&run, error, numbers, &mut findings),
    }
    Examined::of(judge, text, &run, (numbers, &mut findings));
    findings
}

/// A run with all compared data.
struct Examined<'a> {
    mechanism: &'a Mechanism,
    /// Output rows of the scene, with the solutions of the reference solver. The output rows are
    /// every second row of the run.
    states: Vec<(&'a Row, Instant, Vec<Form>)>,
    verdicts: Vec<OnRun>,
    sets: Vec<Vec<usize>>,
    compliances: Vec<Compliance>,
}

impl<'a> Examined<'a> {
    fn of(
        judge: &dyn Judge,
        text: &str,
        run: &'a Run,
        (numbers, findings): (&mut Numbers, &mut Findings),
    ) {
        let mechanism = &run.study.prepared.mechanism;
        let mut states = Vec::new();
        for row in run.rows.iter().step_by(2) {
            match Instant::new(mechanism, (row.t_before, &row.q, &row.v)) {
                Ok(instant) => {
                    let mut s = mechanism.scratch();
                    mechanism.pose(row.t_before, &row.q, &mut s);
                    mechanism.c(&mut s);
                    let forms = forms(mechanism, &s, instant.size);
                    states.push((row, instant, forms));
                }
                Err(Fault::Unclear) => findings.count(Count::Unclear, 1),
                Err(fault) => {
                    let text = format!("t = {} s: the oracle has {fault:?}", row.t);
                    findings.note(Kind::Failed, text);
                }
            }
        }
        // At isolated instants the rank may be lower. No reactions are compared at these instants.
        let rank = states.iter().map(|(_, i, _)| i.rank).max().unwrap_or(0);
        states.retain(|(_, instant, _)| instant.rank == rank);
        let Some((_, instant, forms)) = states.get(states.len() / 2) else {
            return;
        };
        let verdicts = match judge.on_run(run, forms) {
            Ok(verdicts) => verdicts,
            Err(error) => return findings.note(Kind::Failed, error.to_string()),
        };
        let p = instant.redundancy();
        findings.count(Count::Redundant, usize::from(p > 0));
        let wanted = match p {
            0 => 0,
            1 => 2,
            _ => 3,
        };
        let mut sets: Vec<Vec<usize>> = (0..wanted).map(|_| dropped(instant, numbers)).collect();
        sets.dedup();
        let compliances = compliances(mechanism, instant.size, numbers);
        let examined = Self {
            mechanism,
            states,
            verdicts,
            sets,
            compliances,
        };
        let which = numbers.below(examined.states.len());
        examined.at_states(judge, findings);
        examined.choices(judge, which, findings);
        examined.between_runs(judge, text, findings);
        examined.displaced(judge, which, findings);
    }

    /// Whether two values of component k at a state differ by more than this fraction of their
    /// reference. A component that is ill-determined only at this state is compared like an
    /// ill-determined component.
    fn differ(
        &self,
        judge: &dyn Judge,
        (row, instant, forms): &(&Row, Instant, Vec<Form>),
        (k, values): (usize, &[f64]),
        share: f64,
    ) -> bool {
        let (load, span) = (instant.load, span(values));
        // Rounding error of a solution in `f64` with this smallest singular value.
        let largest = values.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let resolved = ROUNDING.max(f64::EPSILON / instant.sigma * largest);
        let is_within = |sensitivity: Option<f64>| {
            span <= (share * reference(sensitivity, values, load)).max(resolved)
        };
        let here = || judge.sensitivities(self.mechanism, forms, row)?.each[k];
        !is_within(self.verdicts[k].sensitivity) && !is_within(here())
    }

    fn name(&self, form: &Form) -> String {
        let group = &self.mechanism.layout().groups[form.group];
        format!("{}.{}", group.name, form.name)
    }

    /// Returns all solutions at a state: one solution without the rows of each set, and one
    /// solution with elastic joints.
    fn solutions(&self, instant: &Instant, forms: &[Form]) -> Vec<DVector<f64>> {
        let least = instant.least();
        let mut all: Vec<DVector<f64>> = self
            .sets
            .iter()
            .filter_map(|rows| without(instant, least, rows))
            .collect();
        all.extend(elastic(
            instant,
            least,
            (self.mechanism, forms),
            &self.compliances,
        ));
        all
    }
}

/// Returns the reference value for relative differences. This is the load, or for an ill-determined
/// component the larger of its value and the load times its sensitivity.
fn reference(sensitivity: Option<f64>, values: &[f64], load: f64) -> f64 {
    match sensitivity {
        Some(sensitivity) if sensitivity > solvability::FRAGILE => values
            .iter()
            .fold(load * sensitivity.max(1.0), |a, x| a.max(x.abs())),
        _ => load,
    }
}

fn span(values: &[f64]) -> f64 {
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    if values.len() < 2 { 0.0 } else { most - least }
}
