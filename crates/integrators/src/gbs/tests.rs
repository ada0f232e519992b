//! The extrapolation itself, with a given number of columns and given steps.

use super::Extrapolation;
use super::order::OrderControl;
use super::sequence::{COLUMNS, substeps, weights};
use crate::interval::{Interval, Leg};
use crate::method::{Dense, Ends, Trial};
use crate::ode::{Function, Ode};
use std::convert::Infallible;

#[test]
fn weights_remove_even_powers() {
    for last in 1..=COLUMNS {
        for first in 1..=last {
            let w = weights(first, last);
            let sum = |power: i32| -> f64 {
                (1..=COLUMNS)
                    .map(|j| w[j - 1] * (2.0 / substeps(j) as f64).powi(power))
                    .sum()
            };
            // Rounding of weights ≤ 100.
            assert!((sum(0) - 1.0).abs() < 1e-13);
            for l in 1..=(last - first) {
                assert!(sum(2 * l as i32).abs() < 1e-13, "{first} {last} {l}");
            }
        }
    }
}

/// Largest errors at the ends of the steps and inside, of both dense outputs.
struct Errors {
    ends: f64,
    cheap: f64,
    accurate: f64,
}

/// y' = y·cos t, solution exp(sin t), over n steps with k columns from t0 to t_end.
fn largest_errors(k: usize, t0: f64, t_end: f64, n: u32) -> Errors {
    type Plain = Function<fn(f64, &[f64], &mut [f64])>;
    let mut ode: Plain = Function::new(1, |t, y, dy| dy[0] = y[0] * t.cos());
    let exact = |t: f64| t.sin().exp();
    let legs = Interval::new(t0, t_end).legs::<Infallible>();
    let leg: &Leg = &legs.expect("good times")[0];
    let mut gbs = Extrapolation::new(1);
    // No error is too large: one polynomial a step.
    gbs.scale.fill(f64::INFINITY);
    let mut errors = Errors {
        ends: 0.0,
        cheap: 0.0,
        accurate: 0.0,
    };
    let (mut y0, mut y1, mut f0, mut f1) = ([exact(t0)], [0.0], [0.0], [0.0]);
    let Ok(()) = ode.rhs(t0, &y0, &mut f0);
    for i in 0..n {
        let time = |i: u32| t0 + f64::from(i) * (t_end - t0) / f64::from(n);
        let (t, t1) = (time(i), time(i + 1));
        let trial = Trial {
            leg,
            t,
            h: t1 - t,
            t1,
        };
        for j in 1..=k {
            gbs.column(&mut ode, &trial, &y0, &f0, j, &mut 0)
                .expect("smooth");
        }
        gbs.extrapolate(&y0, k, &mut y1);
        gbs.control.last = k;
        gbs.note_middle();
        let Ok(()) = ode.rhs(t1, &y1, &mut f1);
        errors.ends = errors.ends.max((y1[0] - exact(t1)).abs());
        let ends = Ends {
            trial,
            y0: &y0,
            f0: &f0,
            y1: &y1,
            f1: &f1,
        };
        Dense::<Plain>::prepare(&mut gbs, &mut ode, &ends, &mut 0).expect("smooth");
        for l in 1..10 {
            let theta = f64::from(l) / 10.0;
            let exact = exact(t + theta * trial.h);
            let mut y = [0.0];
            Dense::<Plain>::interpolate_accurately(&gbs, &ends, theta, &mut y);
            errors.accurate = errors.accurate.max((y[0] - exact).abs());
            Dense::<Plain>::interpolate(&gbs, &ends, theta, &mut y);
            errors.cheap = errors.cheap.max((y[0] - exact).abs());
        }
        (y0, f0) = (y1, f1);
    }
    errors
}

fn assert_order(name: &str, k: usize, (a, b): (f64, f64), claimed: f64) {
    let observed = (a / b).log2();
    assert!(
        (observed - claimed).abs() < 0.2,
        "{k} columns, {name}: {observed} ({a:e}, {b:e})"
    );
}

/// k columns have order 2k, the accurate output as well, the other one 6 at most.
#[test]
fn orders_are_twice_the_number_of_columns() {
    for (k, t_end, n) in [(2, 4.0, 40), (3, 4.0, 16), (4, 3.5, 12), (5, 10.0, 16)] {
        let [a, b] = [n, 2 * n].map(|n| largest_errors(k, 0.0, t_end, n));
        let claimed = 2.0 * k as f64;
        assert_order("ends", k, (a.ends, b.ends), claimed);
        assert_order("cheap", k, (a.cheap, b.cheap), claimed.min(6.0));
        // With five columns rounding comes too early.
        if k < 5 {
            assert_order("accurate", k, (a.accurate, b.accurate), claimed);
        }
    }
}

/// The control takes more columns where more accuracy is wanted, and starts where the tolerance says.
#[test]
fn the_column_to_begin_with_follows_the_tolerance() {
    let mut control = OrderControl::new();
    for (rtol, target) in [(1.0, 2), (1e-6, 5), (1e-10, 7), (1e-16, 8), (0.0, 8)] {
        control.aim(rtol);
        assert_eq!(control.target, target, "{rtol}");
    }
}
