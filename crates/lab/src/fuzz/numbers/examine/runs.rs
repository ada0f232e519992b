//! (a) in separate runs of the product, each without other rows.

use super::{Examined, LOAD, reference, span};
use crate::fuzz::numbers::findings::{Count, Findings, Kind};
use crate::fuzz::numbers::run::{Row, prepared, run};

/// Agreement of two runs, of the load, where their states agree to [`SAME_STATE`].
const BETWEEN_RUNS: f64 = 1e-7;
const SAME_STATE: f64 = 1e-10;

impl Examined<'_> {
    /// (a) in separate runs, each without other rows.
    pub(super) fn between_runs(&self, text: &str, findings: &mut Findings) {
        for rows in self.sets.iter().take(2) {
            // A set that is admissible on the way may not be at the start.
            let Ok(study) = prepared(text, Some(rows)) else {
                continue;
            };
            let other = run(study);
            for (row, instant, forms) in &self.states {
                let Some(twin) = other.rows.iter().find(|r| r.t == row.t) else {
                    continue;
                };
                if !self.is_same(row, twin, instant.size) {
                    findings.count(Count::OtherStates, 1);
                    continue;
                }
                for (form, own) in forms.iter().zip(&self.verdicts) {
                    let pair = [row, twin].map(|r| r.reactions.get(form.group));
                    let [Some(one), Some(two)] = pair else {
                        continue;
                    };
                    if !own.is_determined(row.t) {
                        continue;
                    }
                    let values = [one, two].map(|r| form.of(self.mechanism, r));
                    findings.count(Count::BetweenRuns, 1);
                    let permitted = BETWEEN_RUNS * reference(own, &values, instant.load);
                    if span(&values) > permitted.max(BETWEEN_RUNS * LOAD) {
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
