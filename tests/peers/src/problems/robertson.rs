//! Robertson's reaction up to t = 10¹¹ as an ordinary differential equation: problem ROBER of the
//! Test Set for IVP Solvers.

use crate::problem::{Differentiated, Problem};

/// Initial concentrations.
pub const START: [f64; 3] = [1.0, 0.0, 0.0];

/// Last time.
pub const T_END: f64 = 1e11;

/// First step of all methods.
pub const FIRST_STEP: f64 = 1e-6;

/// Concentrations at the end, from the Test Set.
const REFERENCE: [f64; 3] = [
    0.208_334_014_970_125_5e-7,
    0.833_336_077_033_471_3e-13,
    0.999_999_979_166_505,
];

const K1: f64 = 0.04;
const K2: f64 = 3e7;
const K3: f64 = 1e4;

/// The three rate equations.
pub struct Robertson;

impl Problem<3> for Robertson {
    #[inline]
    fn rhs(&self, _t: f64, y: &[f64; 3], dy: &mut [f64; 3]) {
        let (a, b, c) = (K1 * y[0], K2 * y[1] * y[1], K3 * y[1] * y[2]);
        *dy = [c - a, a - b - c, b];
    }
}

impl Differentiated<3> for Robertson {
    #[inline]
    fn jacobian(&self, _t: f64, y: &[f64; 3], j: &mut [[f64; 3]; 3]) {
        let (b, c2, c3) = (2.0 * K2 * y[1], K3 * y[2], K3 * y[1]);
        *j = [[-K1, c2, c3], [K1, -b - c2, -c3], [0.0, b, 0.0]];
    }
}

/// Largest relative error of a concentration.
pub fn error(y: &[f64; 3]) -> f64 {
    let d = y.iter().zip(&REFERENCE).map(|(a, b)| (a / b - 1.0).abs());
    d.fold(0.0, f64::max)
}
