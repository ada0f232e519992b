//! Tests the orders of the two methods with their own step size control, with constant step sizes.

use dynamics::{PreparedMechanism, RowChoice, prepare};
use integrators::Ode;
use model::{Mechanism, StartOptions, System};

use super::equations::Equations;
use super::gbs::Gbs;
use super::generalized_alpha::GeneralizedAlpha;
use super::stepping::{Stepper, Trial};
use super::{Comparator, Drift, Formulation, KeptRows, Method, run};
use crate::mechanisms::cranks::cranks;

const END: f64 = 0.4;

/// Returns three falling cranks under one coupler, one of which is redundant.
fn falling() -> PreparedMechanism {
    let mut three = cranks(&[0.0, 1.0, 2.0], 0.8, 0.9);
    three.gravity = [0.0, -9.81];
    let mechanism = Mechanism::build(&three).expect("three cranks");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("a start")
}

/// Returns the state at the end after `n` steps of equal size, with a projection after each step.
fn at_end(p: &PreparedMechanism, stepper: &mut dyn Stepper, tolerance: f64, n: usize) -> Vec<f64> {
    let kept = &p.decision.kept;
    let columns = p.mechanism.layout().n_v;
    let solver = |_: &_, _: &_| Ok(Box::new(KeptRows::new(columns, kept)?) as _);
    let mut equations = Equations::new(p, Drift::Projection, solver).expect("independent rows");
    let mut y = [p.q.as_slice(), &p.v].concat();
    let (mut f, mut y1) = (vec![0.0; y.len()], y.clone());
    stepper.restart();
    let h = END / n as f64;
    for k in 0..n {
        let t = k as f64 * h;
        equations.rhs(t, &y, &mut f).expect("no singular pose");
        let trial = Trial {
            t,
            h,
            last: END,
            is_cut: true,
            y0: &y,
            f0: &f,
            tolerance,
        };
        stepper
            .step(&mut equations, &trial, &mut y1)
            .expect("a step");
        equations
            .end(trial.time(1.0), &mut y1)
            .expect("close to the constraints");
        stepper.next_size(h, 0.5, true);
        y.copy_from_slice(&y1);
    }
    y
}

/// Half the step size divides the error by 2^order. With a tolerance that every step meets, `gbs`
/// uses only its first two columns, which have order 4.
#[test]
fn errors_fall_with_the_order() {
    let p = falling();
    let way = Comparator {
        formulation: Formulation::KeptRows,
        method: Method::Dop853,
        drift: Drift::Projection,
    };
    let exact = run(&p, way, 1e-13, &[END]).expect("runs");
    let exact = [exact.rows[0].q.as_slice(), &exact.rows[0].v].concat();
    let error = |stepper: &mut dyn Stepper, tolerance: f64, n: usize| -> f64 {
        let found = at_end(&p, stepper, tolerance, n);
        let gaps = found.iter().zip(&exact).map(|(a, b)| (a - b).abs());
        gaps.fold(0.0, f64::max)
    };
    let dim = exact.len();
    let gbs = |n| error(&mut Gbs::new(dim, 1.0), 1e300, n);
    let alpha = |n| {
        let stepper = GeneralizedAlpha::new(&p.mechanism, &p.decision.kept);
        let mut stepper = stepper.expect("no function is called");
        error(&mut stepper, 1e-8, n)
    };
    let order = |coarse: f64, fine: f64| (coarse / fine).log2();
    let found = [order(gbs(16), gbs(32)), order(alpha(200), alpha(400))];
    for (found, expected) in found.into_iter().zip([4.0, 2.0]) {
        assert!(
            (found - expected).abs() < 0.25,
            "{found} instead of {expected}"
        );
    }
}
