//! Extrapolation of the explicit midpoint rule (Gragg, Bulirsch, Stoer) with orders 4 to 18. Order
//! and step size are chosen together for each step.
//!
//! Column j divides the step into n_j = 2·j equal substeps of the midpoint rule. The results of
//! columns 1 to k, extrapolated to infinitely many substeps, have order 2k. The smoothing at the
//! end of the step is omitted, so each column needs one evaluation less. Source: the program ODEX
//! of E. Hairer and G. Wanner; Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I,
//! 2nd ed., II.9.

mod columns;
mod order;

use integrators::Ode;

use super::Fault;
use super::equations::Equations;
use super::stepping::{Stepper, Trial};
use columns::{COLUMNS, substeps};
use order::{OrderControl, Verdict};

/// Returns weights w of columns `first` to `last`. The sum Σ w_j·c_j is the value at h = 0 of the
/// polynomial in h² through the points c_j at h = 1/n_j, with
/// `w_j = Π_{l ≠ j} n_j² / (n_j² − n_l²)`. Weights of other columns are zero.
fn weights(first: usize, last: usize) -> [f64; COLUMNS] {
    let mut w = [0.0; COLUMNS];
    for j in first..=last {
        let square = |l: usize| (substeps(l) * substeps(l)) as f64;
        w[j - 1] = (first..=last)
            .filter(|&l| l != j)
            .map(|l| square(j) / (square(j) - square(l)))
            .product();
    }
    w
}

/// The extrapolated midpoint rule.
pub(super) struct Gbs {
    control: OrderControl,
    /// Change of the state over the whole step, for each column.
    columns: [Vec<f64>; COLUMNS],
    /// The last two states of the midpoint rule, and f.
    previous: Vec<f64>,
    present: Vec<f64>,
    state: Vec<f64>,
    f: Vec<f64>,
}

impl Gbs {
    pub(super) fn new(dim: usize, tolerance: f64) -> Self {
        let zeros = || vec![0.0; dim];
        let mut control = OrderControl::new();
        control.aim(tolerance);
        Self {
            control,
            columns: std::array::from_fn(|_| zeros()),
            previous: zeros(),
            present: zeros(),
            state: zeros(),
            f: zeros(),
        }
    }

    /// Computes column j with `z_1 = h_j·f0`, `z_{m+1} = z_{m−1} + 2·h_j·f(t + m·h_j, y0 + z_m)`,
    /// in which z is the change of the state.
    fn column(
        &mut self,
        ode: &mut Equations<'_>,
        trial: &Trial<'_>,
        j: usize,
    ) -> Result<(), Fault> {
        let n = substeps(j);
        let h = trial.h / n as f64;
        for (i, f0) in trial.f0.iter().enumerate() {
            (self.previous[i], self.present[i]) = (0.0, h * f0);
        }
        for m in 1..n {
            for (i, y0) in trial.y0.iter().enumerate() {
                self.state[i] = y0 + self.present[i];
            }
            ode.rhs(trial.time(m as f64 / n as f64), &self.state, &mut self.f)?;
            for (i, f) in self.f.iter().enumerate() {
                let next = self.previous[i] + 2.0 * h * f;
                (self.previous[i], self.present[i]) = (self.present[i], next);
            }
        }
        self.columns[j - 1].copy_from_slice(&self.present);
        Ok(())
    }
}

impl Stepper for Gbs {
    fn restart(&mut self) {
        self.control.restart();
    }

    fn step(
        &mut self,
        ode: &mut Equations<'_>,
        trial: &Trial<'_>,
        y1: &mut [f64],
    ) -> Result<f64, Fault> {
        let is_fresh = self.control.is_first || trial.is_cut;
        self.control.begin();
        self.column(ode, trial, 1)?;
        let mut error = f64::INFINITY;
        for j in 2..=COLUMNS {
            self.column(ode, trial, j)?;
            let (all, rest) = (weights(1, j), weights(2, j));
            for (i, y0) in trial.y0.iter().enumerate() {
                let sum = |w: &[f64]| -> f64 {
                    let terms = w[..j].iter().zip(&self.columns);
                    terms.map(|(w, column)| w * column[i]).sum()
                };
                y1[i] = y0 + sum(&all);
                self.f[i] = sum(&all) - sum(&rest);
            }
            error = trial.norm(&self.f, y1);
            match self.control.judge(j, trial.h, error, is_fresh) {
                Verdict::NextColumn => {}
                Verdict::Done => break,
            }
        }
        Ok(error)
    }

    fn next_size(&mut self, h: f64, _error: f64, is_accepted: bool) -> f64 {
        if is_accepted {
            self.control.accept(h)
        } else {
            self.control.reject(h)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_remove_even_powers() {
        for last in 1..=COLUMNS {
            for first in 1..=last {
                let w = weights(first, last);
                let sum = |power: i32| -> f64 {
                    let column = |j: usize| w[j - 1] * (2.0 / substeps(j) as f64).powi(power);
                    (1..=COLUMNS).map(column).sum()
                };
                // The bound is the rounding error of weights whose values are up to some thousand.
                assert!((sum(0) - 1.0).abs() < 1e-11);
                for l in 1..=(last - first) {
                    assert!(sum(2 * l as i32).abs() < 1e-11, "{first} {last} {l}");
                }
            }
        }
    }

    /// The order control uses more columns for a higher accuracy. The first target column follows
    /// from the tolerance.
    #[test]
    fn the_column_to_begin_with_follows_the_tolerance() {
        let mut control = OrderControl::new();
        for (rtol, target) in [(1.0, 2), (1e-6, 5), (1e-10, 7), (1e-16, 8), (0.0, 8)] {
            control.aim(rtol);
            assert_eq!(control.target, target, "{rtol}");
        }
    }
}
