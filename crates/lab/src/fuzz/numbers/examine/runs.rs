//! Test (a) in separate runs of the product. Each run has other redundant rows.

use super::Examined;
use crate::fuzz::numbers::findings::{Count, Findings, Kind};
use crate::fuzz::numbers::run::{Row, prepared, run};
use crate::fuzz::numbers::verdicts::Judge;

/// Largest difference of two runs that counts as agreement, as a fraction of the load, if their
/// states agree to within [`SAME_STATE`].
const BETWEEN_RUNS: f64 = 1e-7;
const SAME_STATE: f64 = 1e-10;

impl Examined<'_> {
    /// Performs test (a) in separate runs. Each run has other redundant rows.
    pub(super) fn between_runs(&self, judge: &dyn Judge, text: &str, findings: &mut Findings) {
        for rows in self.sets.iter().take(2) {
            // A set of rows that is admissible during the run may not be admissible at the initial
            // state.
            let Ok(study) = prepared(text, Some(rows)) else {
                continue;
            };
            let other = run(study);
            for state in &self.states {
                let (row, instant, forms) = state;
                let Some(twin) = other.rows.iter().find(|r| r.t == row.t) else {
                    continue;
                };
                if !self.is_same(row, twin, instant.size) {
                    findings.count(Count::OtherStates, 1);
                    continue;
                }
                for (k, (form, own)) in forms.iter().zip(&self.verdicts).enumerate() {
                    let pair = [row, twin].map(|r| r.reactions.get(form.group));
                    let [Some(one), Some(two)] = pair else {
                        continue;
                    };
                    if !own.is_determined(row.t) {
                        continue;
                    }
                    let values = [one, two].map(|r| form.of(self.mechanism, r));
                    findings.count(Count::BetweenRuns, 1);
                    if self.differ(judge, state, (k, &values), BETWEEN_RUNS) {
                        let text = format!(
                            "`{}` at t = {} s without rows {rows:?} (from 0): {values:?} N, load {:.3e} N",
                            self.name(form),
                            row.t,
                            instant.load
                        );
                        findings.note(Kind::Runs, text);
                    }
                }
            }
        }
    }

    fn is_same(&self, a: &Row, b: &Row, size: f64) -> bool {
        let (_, far) = self.mechanism.largest_difference(&a.q, &b.q, size);
        let speeds = a.v.iter().zip(&b.v).map(|(a, b)| (a - b).abs());
        far.max(speeds.fold(0.0, f64::max)) <= SAME_STATE
    }
}
