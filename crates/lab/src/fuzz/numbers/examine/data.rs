//! (c) at one state: data displaced one at a time.

use super::{Examined, LOAD};
use crate::fuzz::numbers::displaced::Displaced;
use crate::fuzz::numbers::findings::{Count, Findings, Kind};
use crate::fuzz::numbers::verdicts::OnRun;

/// Changes with one datum: most of a component that is not fragile, least of one that is.
const STURDY: f64 = 0.12;
const FRAGILE: f64 = 0.08;

impl Examined<'_> {
    /// (c) at one state.
    pub(super) fn displaced(&self, which: usize, findings: &mut Findings) {
        let (row, instant, forms) = &self.states[which];
        let known = |own: &OnRun| own.sensitivity.is_some() && own.is_determined(row.t);
        if instant.load <= LOAD || !self.verdicts.iter().any(known) {
            return;
        }
        let kept = &self.run.study.prepared.decision.kept;
        let Some(at) = Displaced::new(self.mechanism, row, kept, instant.size) else {
            return;
        };
        let changes = at.changes();
        for (((form, own), change), value) in forms
            .iter()
            .zip(&self.verdicts)
            .zip(changes)
            .zip(&at.values)
        {
            if !known(own) {
                continue;
            }
            let share = change / value.abs().max(instant.load);
            if own.is_fragile() {
                findings.count(Count::Fragile, 1);
                findings.count(Count::FragileChanges, usize::from(share > FRAGILE));
                continue;
            }
            findings.count(Count::Sturdy, 1);
            if share > STURDY {
                let text = format!(
                    "`{}` at t = {} s: changes by {:.1} %, called {:.1e}; value {value:.3e} N, load {:.3e} N",
                    self.name(form),
                    row.t,
                    100.0 * share,
                    own.sensitivity.unwrap_or(f64::NAN),
                    instant.load
                );
                findings.note(Kind::Moves, text);
            }
        }
    }
}
