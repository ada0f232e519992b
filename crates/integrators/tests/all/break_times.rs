//! Kinks and jumps of f, declared and undeclared.

use crate::problems::{Plain, fixed_step, plain, run};
use pfaff_integrators::{
    Dop853, Dopri5, Function, Interval, Method, Ode, Options, OutputTimes, Tsit5, integrate, sample,
};
use std::convert::Infallible;
use std::ops::ControlFlow;

const DECLARED: [f64; 1] = [1.0];

/// The equation y' = |t − 1| has y(2) = 1 from y(0) = 0. On each side of t = 1 the solution is a
/// polynomial.
fn kink(t: f64, _y: &[f64], dy: &mut [f64]) {
    dy[0] = (t - 1.0).abs();
}

/// The equation is y' = −y before t = 1 and y' = y from t = 1 on: y(2) = 1 from y(0) = 1.
fn jump_with_less(t: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = if t < 1.0 { -y[0] } else { y[0] };
}

/// The same equation, with the value at t = 1 taken from the other side.
fn jump_with_less_or_equal(t: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = if t <= 1.0 { -y[0] } else { y[0] };
}

fn interval(break_times: &[f64]) -> Interval<'_> {
    Interval {
        t0: 0.0,
        t_end: 2.0,
        break_times,
    }
}

#[test]
fn declared_kink_costs_nothing_and_is_exact() {
    let options = Options::default();
    let with = run(
        &mut Function::new(1, kink),
        &interval(&DECLARED),
        &[0.0],
        &options,
    );
    let without = run(
        &mut Function::new(1, kink),
        &interval(&[]),
        &[0.0],
        &options,
    );
    // Order 5 integrates a linear f exactly, except for rounding.
    assert!((with.y[0] - 1.0).abs() < 1e-14, "{}", with.y[0]);
    assert_eq!(with.statistics.rejected(), 0);
    assert!(without.statistics.rejected() > 0);
    assert!((without.y[0] - 1.0).abs() > 1e-14);
    assert!((without.y[0] - 1.0).abs() < 1e-6);
}

#[test]
fn declared_jump_needs_no_rejection_on_either_side() {
    let options = Options::default();
    let run = |f: fn(f64, &[f64], &mut [f64]), breaks: &[f64]| {
        run(
            &mut Function::new(1, f),
            &interval(breaks),
            &[1.0],
            &options,
        )
    };
    let less = run(jump_with_less, &DECLARED);
    let less_or_equal = run(jump_with_less_or_equal, &DECLARED);
    assert_eq!(less, less_or_equal);
    assert_eq!(less.statistics.rejected(), 0);
    assert!((less.y[0] - 1.0).abs() < 1e-8, "{}", less.y[0]);
    let undeclared = run(jump_with_less, &[]);
    assert!(undeclared.statistics.rejected() > 5);
    assert!(undeclared.statistics.evaluations > less.statistics.evaluations);
}

/// For all methods, the side from which f is evaluated does not depend on how the problem writes
/// its condition.
#[test]
fn all_methods_stay_on_their_side_of_a_jump() {
    fn check(name: &str, method: &impl Method<Plain>) {
        for options in [Options::default(), fixed_step(0.25)] {
            let run = |f: fn(f64, &[f64], &mut [f64])| {
                let mut rows = Vec::new();
                let times = OutputTimes::Every(0.1);
                let mut write = |_: &mut Plain, _t: f64, y: &mut [f64]| {
                    rows.push(y[0]);
                    ControlFlow::Continue(())
                };
                let (mut ode, interval) = (plain(1, f), interval(&DECLARED));
                let end = sample(
                    method,
                    &mut ode,
                    &interval,
                    &[1.0],
                    &options,
                    &times,
                    &mut write,
                )
                .expect("smooth on either side");
                (end, rows)
            };
            let (less, less_or_equal) = (run(jump_with_less), run(jump_with_less_or_equal));
            assert_eq!(less, less_or_equal, "{name}");
            assert_eq!(less.0.statistics.rejected(), 0, "{name}");
            for (i, y) in less.1.iter().enumerate() {
                let t = 0.1 * i as f64;
                let exact = if t < 1.0 { (-t).exp() } else { (t - 2.0).exp() };
                assert!((y - exact).abs() < 1e-4, "{name}, t = {t}: {y}");
            }
        }
    }
    check("dopri5", &Dopri5);
    check("tsit5", &Tsit5);
    check("dop853", &Dop853);
}

#[test]
fn declared_jump_backwards() {
    let back = Interval {
        t0: 2.0,
        t_end: 0.0,
        break_times: &DECLARED,
    };
    let end = run(
        &mut Function::new(1, jump_with_less),
        &back,
        &[1.0],
        &Options::default(),
    );
    assert_eq!(end.statistics.rejected(), 0);
    assert!((end.y[0] - 1.0).abs() < 1e-8, "{}", end.y[0]);
}

#[test]
fn steps_end_exactly_at_break_times_and_the_end() {
    let breaks = [1.7, 0.1 + 0.2, -3.0, 1.1, 5.0, 1.1];
    let mut ends = Vec::new();
    let mut ode = Function::new(1, |_t, y: &[f64], dy: &mut [f64]| dy[0] = -y[0]);
    let end = integrate(
        &Dopri5,
        &mut ode,
        &interval(&breaks),
        &[1.0],
        &Options::default(),
        |step| {
            ends.push(step.t1());
            ControlFlow::Continue(())
        },
    )
    .expect("smooth problem");
    for t in [0.1 + 0.2, 1.1, 1.7, 2.0] {
        assert!(ends.contains(&t), "{t} in {ends:?}");
    }
    assert_eq!(end.t, 2.0);
    assert!(ends.is_sorted());
}

#[test]
fn neighbouring_break_times_are_passed() {
    let breaks = [1.0, 1.0_f64.next_up(), 1.0_f64.next_up().next_up()];
    let end = run(
        &mut Function::new(1, kink),
        &interval(&breaks),
        &[0.0],
        &Options::default(),
    );
    assert!((end.y[0] - 1.0).abs() < 1e-14, "{}", end.y[0]);
}

/// A ball of unit mass receives an impulse at t = 1, at which v jumps by 3.
struct Hit;

impl Ode for Hit {
    type Error = Infallible;

    fn dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Infallible> {
        dy.copy_from_slice(&[y[1], 0.0]);
        Ok(())
    }

    fn at_break(&mut self, t: f64, y: &mut [f64]) -> Result<(), Infallible> {
        assert_eq!(t, 1.0_f64.next_up());
        y[1] += 3.0;
        Ok(())
    }
}

#[test]
fn the_state_may_jump_at_a_break_time() {
    let interval = Interval {
        t0: 0.0,
        t_end: 2.0,
        break_times: &[1.0],
    };
    let mut before = 0.0;
    let end = integrate(
        &Dopri5,
        &mut Hit,
        &interval,
        &[0.0, 1.0],
        &Options::default(),
        |step| {
            if step.t1() == 1.0 {
                before = step.y1()[1];
            }
            ControlFlow::Continue(())
        },
    )
    .expect("free flight");
    assert_eq!(before, 1.0, "the step to t = 1 ends before the hit");
    assert!((end.y[0] - 5.0).abs() < 1e-14 && end.y[1] == 4.0);
}
