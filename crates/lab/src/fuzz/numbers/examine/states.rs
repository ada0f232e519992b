//! Tests (a) and (b): compares the solutions at each state with each other and with the value of
//! the product.

use super::{AT_STATE, Examined, LOAD, span};
use crate::fuzz::numbers::findings::{Count, Findings, Kind};
use crate::fuzz::numbers::forms::Form;
use crate::fuzz::numbers::oracle::Instant;
use crate::fuzz::numbers::run::Row;
use crate::fuzz::numbers::verdicts::{Judge, Word};

/// Two solutions differ if a component differs by more than this fraction of the load.
const DIFFERS: f64 = 1e-6;

/// A component is not determined if its fraction in the left null space exceeds this value divided
/// by the smallest singular value. For states that satisfy the constraints to 1e-12, this is the
/// accuracy of the null space.
const FREE: f64 = 1e-10;

impl Examined<'_> {
    /// Performs tests (a) and (b) at each state.
    pub(super) fn at_states(&self, judge: &dyn Judge, findings: &mut Findings) {
        // Two values for each component and interval: whether solutions differ in the interval, and
        // whether the component is not determined in the interval. `None` if the interval contains
        // no state.
        let own = self.verdicts.iter().map(|own| own.stretches.len());
        let mut found: Vec<Vec<Option<[bool; 2]>>> = own.map(|count| vec![None; count]).collect();
        for state in &self.states {
            let (row, instant, forms) = state;
            let solutions = self.solutions(instant, forms);
            for (k, (form, own)) in forms.iter().zip(&self.verdicts).enumerate() {
                let Some(at) = own.stretches.iter().rposition(|s| s.from <= row.t) else {
                    continue;
                };
                let w = instant.scaled(form);
                let values: Vec<f64> = solutions.iter().map(|l| w.dot(l)).collect();
                let span = span(&values);
                let is_free = instant.margin(form, forms) > FREE / instant.sigma;
                if own.is_determined(row.t) {
                    findings.count(Count::Values, 1);
                    if is_free || self.differ(judge, state, (k, &values), AT_STATE) {
                        let text = format!(
                            "`{}` at t = {} s: {values:?} N, load {:.3e} N, margin {:.1e}, σ {:.1e}",
                            self.name(form),
                            row.t,
                            instant.load,
                            instant.margin(form, forms),
                            instant.sigma
                        );
                        findings.note(Kind::States, text);
                    }
                    self.value(judge, state, k, findings);
                } else if own.stretches[at].from < row.t {
                    // At the instant at which the interval begins, the component may be different.

                    let [differs, free] = found[k][at].get_or_insert_default();
                    *differs |= span > DIFFERS * instant.load.max(LOAD);
                    *free |= is_free;
                }
            }
        }
        for (k, own) in self.verdicts.iter().enumerate() {
            for (stretch, found) in own.stretches.iter().zip(&found[k]) {
                let Some([differs, is_free]) = *found else {
                    continue;
                };
                match stretch.word {
                    Word::Unique => {}
                    Word::Undecided => findings.count(Count::Undecided, 1),
                    Word::NotUnique => {
                        findings.count(Count::NotDetermined, 1);
                        findings.count(Count::Differs, usize::from(differs));
                        findings.count(Count::NoLoad, usize::from(!differs && is_free));
                        if !differs && !is_free {
                            let name = self.name(&self.states[0].2[k]);
                            let text = format!("`{name}` in {} … {} s", stretch.from, stretch.to);
                            findings.note(Kind::Unexplained, text);
                        }
                    }
                }
            }
        }
    }

    /// Returns the value of the product for a determined component.
    fn value(
        &self,
        judge: &dyn Judge,
        state: &(&Row, Instant, Vec<Form>),
        k: usize,
        findings: &mut Findings,
    ) {
        let (row, instant, forms) = state;
        let form = &forms[k];
        let Some(reaction) = row.reactions.get(form.group) else {
            return;
        };
        let (found, right) = (
            form.of(self.mechanism, reaction),
            instant.scaled(form).dot(instant.least()),
        );
        if !found.is_nan() && self.differ(judge, state, (k, &[found, right]), AT_STATE) {
            let text = format!(
                "`{}` at t = {} s: {found:?} N, right {right:?} N, load {:.3e} N, σ {:.1e}",
                self.name(form),
                row.t,
                instant.load,
                instant.sigma
            );
            findings.note(Kind::Values, text);
        }
    }
}
