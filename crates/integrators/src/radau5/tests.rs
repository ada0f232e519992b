//! Tests of the method without step control. They test its coefficients, its stability function,
//! its order and its dense output.

use super::Radau5Stages;
use super::dense::{defect_weights, start_weight, start_weight_derivative};
use super::tableau::{C, COMPLEX, E, REAL, T, T_INVERSE, lagrange, lagrange_derivative};
use crate::dense_implicit::{DenseImplicit, Differences, Jacobian};
use crate::interval::Interval;
use crate::method::{Dense, Ends, Start, Stepper, Trial};
use crate::ode::{Function, Ode};
use crate::options::Tolerance;
use crate::statistics::Statistics;
use std::convert::Infallible;

type Matrix = [[f64; 3]; 3];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn assert_near(a: &Matrix, b: &Matrix, tolerance: f64) {
    for i in 0..3 {
        for j in 0..3 {
            assert!((a[i][j] - b[i][j]).abs() < tolerance, "{a:?}\n{b:?}");
        }
    }
}

/// Returns A from its definition, Σ_j a_ij·c_j^k = c_i^(k+1)/(k+1) for k = 0, 1, 2, in the closed
/// form of Hairer, Wanner II, table IV.5.6.
fn a() -> Matrix {
    let s = 6.0_f64.sqrt();
    [
        [
            (88.0 - 7.0 * s) / 360.0,
            (296.0 - 169.0 * s) / 1800.0,
            (-2.0 + 3.0 * s) / 225.0,
        ],
        [
            (296.0 + 169.0 * s) / 1800.0,
            (88.0 + 7.0 * s) / 360.0,
            (-2.0 - 3.0 * s) / 225.0,
        ],
        [(16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0],
    ]
}

#[test]
fn the_transformation_makes_the_inverse_of_a_block_diagonal() {
    let identity: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (i, row) in a().iter().enumerate() {
        for k in 0..3 {
            let sum: f64 = (0..3).map(|j| row[j] * C[j].powi(k)).sum();
            let expected = C[i].powi(k + 1) / f64::from(k + 1);
            assert!((sum - expected).abs() < 1e-15, "{i} {k}");
        }
    }
    assert_near(&product(&T, &T_INVERSE), &identity, 1e-14);
    let [re, im] = COMPLEX;
    let blocks = [[REAL, 0.0, 0.0], [0.0, re, -im], [0.0, im, re]];
    let inverse = product(&product(&T, &blocks), &T_INVERSE);
    assert_near(&product(&inverse, &a()), &identity, 1e-13);
}

#[test]
fn polynomials_are_dual_to_their_places() {
    for (j, theta) in [0.0, C[0], C[1], C[2]].into_iter().enumerate() {
        for (i, l) in lagrange(theta).into_iter().enumerate() {
            let expected = if i + 1 == j { 1.0 } else { 0.0 };
            assert!((l - expected).abs() < 1e-14);
        }
        let expected = if j == 0 { 1.0 } else { 0.0 };
        assert!((start_weight_derivative(theta) - expected).abs() < 1e-15);
    }
    for (e, l) in E.into_iter().zip(lagrange_derivative(0.0)) {
        assert!((e + l).abs() < 1e-14);
    }
    assert!(start_weight(1.0).abs() < 1e-15);
    // The weights of the defects by their Taylor polynomials: six differences determine the
    // derivative of a quintic.
    let derivative = |theta: f64, k: usize| {
        let d = |h: f64| defect_weights(theta + h)[k] - defect_weights(theta - h)[k];
        (1.5 * d(0.25) - 0.3 * d(0.5) + d(0.75) / 30.0) / 0.5
    };
    for (j, place) in [0.0, 0.25, 0.75, 1.0].into_iter().enumerate() {
        for k in 0..4 {
            let expected = if j == k { 1.0 } else { 0.0 };
            assert!((derivative(place, k) - expected).abs() < 1e-12);
        }
    }
    assert_eq!([defect_weights(0.0), defect_weights(1.0)], [[0.0; 4]; 2]);
}

/// Steps of a given size, without control.
struct FixedSteps<O> {
    ode: O,
    stages: Radau5Stages,
    statistics: Statistics,
    y: Vec<f64>,
    f: Vec<f64>,
}

impl<F, J> FixedSteps<DenseImplicit<Function<F>, J>>
where
    F: FnMut(f64, &[f64], &mut [f64]),
    J: Jacobian<Function<F>>,
{
    fn new(f: F, jacobian: J, y: &[f64]) -> Self {
        let mut ode = DenseImplicit::new(Function::new(y.len(), f), jacobian);
        let mut f = vec![0.0; y.len()];
        ode.rhs(0.0, y, &mut f).expect("f is defined");
        Self {
            ode,
            stages: Radau5Stages::new(y.len()),
            statistics: Statistics::default(),
            y: y.to_vec(),
            f,
        }
    }

    /// Performs a step from t to t + h at full accuracy. The two dense outputs at θ are written to
    /// `inside`. Returns the size of the estimated error.
    fn step(&mut self, t: f64, h: f64, theta: f64, inside: &mut [Vec<f64>; 2]) -> f64 {
        let legs = Interval::new(t, t + h)
            .legs::<Infallible>()
            .expect("finite");
        let trial = Trial {
            leg: &legs[0],
            t,
            h,
            t1: t + h,
        };
        let tolerance = Tolerance::Uniform {
            rtol: 1e-12,
            atol: 1e-30,
        };
        let start = Start {
            y0: &self.y,
            f0: &self.f,
            tolerance: &tolerance,
        };
        let (mut y1, mut f1) = (self.y.clone(), self.f.clone());
        let (stages, ode, statistics) = (&mut self.stages, &mut self.ode, &mut self.statistics);
        stages.matrices = super::Matrices::default();
        stages
            .trial(ode, &trial, &start, &mut y1, statistics)
            .expect("smooth");
        stages.filter_twice = false;
        stages
            .error_norm(ode, &trial, &start, &[], statistics)
            .expect("smooth");
        stages
            .end_derivative(ode, &trial, &y1, &mut f1, statistics)
            .expect("smooth");
        let ends = Ends {
            trial,
            y0: &self.y,
            f0: &self.f,
            y1: &y1,
            f1: &f1,
        };
        stages.prepare(ode, &ends, &mut 0).expect("smooth");
        let dense: &dyn Dense<DenseImplicit<Function<F>, J>> = stages;
        dense.interpolate(&ends, theta, &mut inside[0]);
        dense.interpolate_accurately(&ends, theta, &mut inside[1]);
        stages.before.h = Some(h);
        std::mem::swap(&mut stages.z, &mut stages.before.z);
        (self.y, self.f) = (y1, f1);
        stages.defect[0].hypot(stages.defect[1])
    }
}

/// One step of size 1 on y' = z·y multiplies y by R(z) = (1 + 2z/5 + z²/20)/(1 − 3z/5 + 3z²/20 −
/// z³/60), the (2, 3) Padé approximation of the exponential (Hairer, Wanner II, IV.3).
#[test]
fn one_linear_step_is_the_stability_function() {
    for (re, im) in [
        (-1.0, 0.0),
        (0.0, 2.0),
        (-3.0, 5.0),
        (-1e3, 1e2),
        (-1e8, 0.0),
        (0.5, 1e5),
    ] {
        let f = move |_t: f64, y: &[f64], dy: &mut [f64]| {
            dy.copy_from_slice(&[re * y[0] - im * y[1], im * y[0] + re * y[1]]);
        };
        let j = move |_t: f64, _y: &[f64], j: &mut [f64]| j.copy_from_slice(&[re, -im, im, re]);
        let mut run = FixedSteps::new(f, j, &[1.0, 0.0]);
        let mut unused = [vec![0.0; 2], vec![0.0; 2]];
        run.step(0.0, 1.0, 0.5, &mut unused);
        let times = |a: (f64, f64), b: (f64, f64)| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let z = (re, im);
        let (z2, z3) = (times(z, z), times(z, times(z, z)));
        let p = (1.0 + 0.4 * z.0 + z2.0 / 20.0, 0.4 * z.1 + z2.1 / 20.0);
        let q = (
            1.0 - 0.6 * z.0 + 0.15 * z2.0 - z3.0 / 60.0,
            -0.6 * z.1 + 0.15 * z2.1 - z3.1 / 60.0,
        );
        let size = q.0 * q.0 + q.1 * q.1;
        let r = times(p, (q.0 / size, -q.1 / size));
        let error = (run.y[0] - r.0).hypot(run.y[1] - r.1);
        assert!(
            error < 1e-13,
            "R({re} + {im}i): {:?}, expected {r:?}",
            run.y
        );
    }
}

/// Returns the largest errors over [0, 2] with n steps: the error at the ends of steps, the errors
/// of both outputs at θ = 0.4, and the largest estimate.
fn errors(n: u32) -> [f64; 4] {
    // The solution of y₁' = y₂·cos t, y₂' = −y₁·cos t + (1 − y₁² − y₂²)·y₂ is (sin s, cos s) with s
    // = sin t. The problem is nonlinear in y and depends on t.
    let f = |t: f64, y: &[f64], dy: &mut [f64]| {
        let excess = 1.0 - y[0] * y[0] - y[1] * y[1];
        dy.copy_from_slice(&[
            y[1] * t.cos() + excess * y[0] * y[1],
            -y[0] * t.cos() + excess * y[1],
        ]);
    };
    let exact = |t: f64| [t.sin().sin(), t.sin().cos()];
    let distance = |y: &[f64], t: f64| (y[0] - exact(t)[0]).hypot(y[1] - exact(t)[1]);
    let mut run = FixedSteps::new(f, Differences::default(), &exact(0.0));
    let (h, theta) = (2.0 / f64::from(n), 0.4);
    let mut inside = [vec![0.0; 2], vec![0.0; 2]];
    let mut largest = [0.0_f64; 4];
    for i in 0..n {
        let t = f64::from(i) * h;
        let estimate = run.step(t, h, theta, &mut inside);
        let here = [
            distance(&run.y, t + h),
            distance(&inside[0], t + theta * h),
            distance(&inside[1], t + theta * h),
            estimate,
        ];
        for (largest, here) in largest.iter_mut().zip(here) {
            *largest = largest.max(here);
        }
    }
    largest
}

/// The ends of the steps and the accurate output have order 5. The output without extra evaluations
/// has the local error O(h⁵). The estimate is O(h⁴), as for an estimate of order 3.
#[test]
fn orders_of_the_step_its_outputs_and_its_estimate() {
    let runs = [16, 32, 64].map(errors);
    for pair in runs.windows(2) {
        let orders: Vec<f64> = (0..4).map(|i| (pair[0][i] / pair[1][i]).log2()).collect();
        for (order, claimed) in orders.iter().zip([5.0, 5.0, 5.0, 4.0]) {
            assert!((order - claimed).abs() < 0.2, "{orders:?} {runs:?}");
        }
    }
    let [ends, _, accurate, _] = runs[2];
    assert!(accurate < 1.1 * ends, "{runs:?}");
}
