//! Test (a): solutions for the multipliers that the product computes on request at one state are
//! compared with the same solutions of the reference solver.

use std::sync::Arc;

use model::ConfigurationAccuracy;
use nalgebra::DVector;
use solvability::{Choice, Questions, analyse_known, solution};

use super::{AT_STATE, Examined, ROUNDING, span};
use crate::fuzz::numbers::findings::{Findings, Kind};
use crate::fuzz::numbers::moves::ranks;
use crate::fuzz::numbers::run::RTOL;
use crate::fuzz::numbers::sets::{elastic, without};
use crate::fuzz::numbers::verdicts::Judge;
use suite::numbers::Numbers;

/// Largest difference that counts as agreement, as a fraction of the largest value.
const CHOSEN: f64 = 1e-7;

impl Examined<'_> {
    /// Compares the requested solutions of the product at one state with the solutions of the
    /// reference solver.
    pub(super) fn choices(&self, judge: &dyn Judge, which: usize, findings: &mut Findings) {
        let state = &self.states[which];
        let (row, instant, forms) = state;
        let solved = (row.t_before, &row.q[..], &row.v[..]);
        let known = if row.t == 0.0 {
            ConfigurationAccuracy::AsStored
        } else {
            ConfigurationAccuracy::To(RTOL)
        };
        let Ok(analysis) = analyse_known(self.mechanism, row.t_before, &row.q, known) else {
            return;
        };
        let solved = match solution(self.mechanism, solved, &analysis.decision) {
            Ok(solved) => solved,
            Err(error) => {
                let at = (row.t_before, &row.q[..]);
                let [here, near] = ranks(self.mechanism, at, &mut Numbers::new(1));
                // At a singular configuration these solutions may not exist.
                if here == near {
                    let text = format!("no solution at t = {} s: {error}", row.t);
                    findings.note(Kind::Failed, text);
                }
                return;
            }
        };
        let questions = Questions::new(self.mechanism, &row.q, Arc::new(analysis));
        let least = instant.least();
        let mut asked: Vec<(Choice, Option<DVector<f64>>)> = self
            .sets
            .iter()
            .map(|rows| {
                (
                    Choice::Elimination(rows.clone()),
                    without(instant, least, rows),
                )
            })
            .collect();
        let own = elastic(instant, least, (self.mechanism, forms), &self.compliances);
        asked.push((Choice::Compliance(self.compliances.clone().into()), own));
        for (choice, own) in asked {
            let Some(own) = own else { continue };
            let found = match questions.distribute(&solved, &choice) {
                Ok(found) => found,
                Err(error) => {
                    let text = format!("{choice:?} at t = {} s: {error}", row.t);
                    findings.note(Kind::Choices, text);
                    continue;
                }
            };
            let values: Vec<f64> = forms
                .iter()
                .map(|form| instant.scaled(form).dot(&own))
                .collect();
            let largest = values.iter().fold(instant.load, |a, x| a.max(x.abs()));
            for (k, (form, right)) in forms.iter().zip(&values).enumerate() {
                let components = &found.reactions[form.group].components;
                let of = components.iter().find(|(name, _)| *name == form.name);
                let Some((_, value)) = of else { continue };
                // A missing value does not count as wrong.
                let Some(given) = value.in_solution() else {
                    continue;
                };
                let pair = [form.unit * given, *right];
                let is_wrong = if value.determined().is_some() {
                    self.differ(judge, state, (k, &pair), AT_STATE)
                } else {
                    span(&pair) > (CHOSEN * largest).max(ROUNDING)
                };
                if is_wrong {
                    let text = format!(
                        "`{}` by {choice:?} at t = {} s: {:?} N, right {right:?} N",
                        self.name(form),
                        row.t,
                        form.unit * given
                    );
                    findings.note(Kind::Choices, text);
                }
            }
        }
    }
}
