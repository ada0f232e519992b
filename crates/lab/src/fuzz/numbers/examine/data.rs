//! Test (c) at one state, with data that are displaced one at a time.

use model::System;

use super::{Examined, LOAD};
use crate::fuzz::numbers::displaced::Displaced;
use crate::fuzz::numbers::findings::{Count, Findings, Kind};
use crate::fuzz::numbers::verdicts::Judge;

/// Limits for the change of a reaction component due to a change of one datum. A component that is
/// reported as well determined must not change by more than `STURDY`. A component that is reported
/// as fragile is expected to change by more than `FRAGILE`.
const STURDY: f64 = 0.12;
const FRAGILE: f64 = 0.08;

impl Examined<'_> {
    /// Performs test (c) at one state.
    pub(super) fn displaced(&self, judge: &dyn Judge, which: usize, findings: &mut Findings) {
        let (row, instant, forms) = &self.states[which];
        // Size and loads are computed separately for each set of connected bodies.
        let joints: Vec<usize> = (0..self.mechanism.layout().groups.len()).collect();
        if instant.load <= LOAD || self.mechanism.joined(&joints).len() > 1 {
            return;
        }
        let Some(called) = judge.sensitivities(self.mechanism, forms, row) else {
            return;
        };
        if called.each.iter().all(Option::is_none) {
            return;
        }
        let Some(at) = Displaced::new(self.mechanism, row, &called.kept, instant.size) else {
            return;
        };
        let changes = at.changes().into_iter().zip(&at.values);
        for ((form, called), (change, value)) in forms.iter().zip(called.each).zip(changes) {
            let Some(called) = called else { continue };
            let share = change / value.abs().max(instant.load);
            if called > solvability::FRAGILE {
                findings.count(Count::Fragile, 1);
                findings.count(Count::FragileChanges, usize::from(share > FRAGILE));
                continue;
            }
            findings.count(Count::Sturdy, 1);
            if share > STURDY {
                let text = format!(
                    "`{}` at t = {} s: changes by {:.1} %, called {called:.1e}; value {value:.3e} N, load {:.3e} N, σ {:.1e}",
                    self.name(form),
                    row.t,
                    100.0 * share,
                    instant.load,
                    instant.sigma
                );
                findings.note(Kind::Moves, text);
            }
        }
    }
}
