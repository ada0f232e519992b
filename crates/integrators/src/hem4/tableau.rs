//! The coefficients: V. Brasey, E. Hairer, Half-explicit Runge–Kutta methods for differential-algebraic systems of index 2, SIAM J. Numer.
//! Anal. 30 (1993) 538–552, method of order 4 with five stages. The weights of the estimate are ours.
//!
//! Checked by the observed orders of the method and of its estimate.

/// √6.
const S: f64 = 2.449_489_742_783_178;

/// Nodes of the stages and of the end; row sums of [`A`].
pub(super) const C: [f64; 6] = [0.0, 0.3, (4.0 - S) / 10.0, (4.0 + S) / 10.0, 1.0, 1.0];

/// Rows for stages 2 to 5 and for the new state.
pub(super) const A: [[f64; 5]; 5] = [
    [0.3, 0.0, 0.0, 0.0, 0.0],
    [(1.0 + S) / 30.0, (11.0 - 4.0 * S) / 30.0, 0.0, 0.0, 0.0],
    [
        (-79.0 - 31.0 * S) / 150.0,
        (-1.0 - 4.0 * S) / 30.0,
        (24.0 + 11.0 * S) / 25.0,
        0.0,
        0.0,
    ],
    [
        (14.0 + 5.0 * S) / 6.0,
        (-8.0 + 7.0 * S) / 6.0,
        (-9.0 - 7.0 * S) / 4.0,
        (9.0 - S) / 4.0,
        0.0,
    ],
    [0.0, 0.0, (16.0 - S) / 36.0, (16.0 + S) / 36.0, 1.0 / 9.0],
];

/// Weights of the estimated error: of f0 = y'(t0), of stages 3 to 5, of f1 = y'(t1).
///
/// The accelerations of the stages are no values of y' (they aim at the constraints of the next stage), and no combination of
/// them alone is an estimate of order 3. With both ends there is one up to a factor: it is found by expanding all seven derivatives in
/// powers of h and removing the orders 0, 1, 2. The factor gives f0 the weight 1/9 that the end has in the method.
pub(super) const E: [f64; 5] = [
    1.0 / 9.0,
    (-1.0 / 3.0 - S / 2.0) / 9.0,
    (-1.0 / 3.0 + S / 2.0) / 9.0,
    2.0 / 27.0,
    -1.0 / 9.0,
];
