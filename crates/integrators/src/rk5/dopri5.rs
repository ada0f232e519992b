//! Dormand–Prince 5(4): the coefficients, as printed in the paper's table 2 and in Hairer, Nørsett,
//! Wanner I, 2nd ed., table II.5.2. The module `order_conditions` checks them with order conditions
//! that are generated from rooted trees.
//!
//! Source: J. R. Dormand, P. J. Prince, A family of embedded Runge–Kutta formulae, J. Comput. Appl.
//! Math. 6 (1980) 19–26, DOI 10.1016/0771-050X(80)90013-3. Dense output: L. F. Shampine, Some
//! practical Runge–Kutta formulas, Math. Comp. 46 (1986) 135–150, in the form of Hairer, Nørsett,
//! Wanner I, 2nd ed., II.6.

use super::tableau::Tableau;

/// Dormand–Prince 5(4) with seven stages, also called `ode45`. The last stage is reused in the next
/// step. The method has order 5. The dense output has order 4 (local error O(h⁵)) without extra
/// evaluations, and order 5 (local error O(h⁶), like the step) with two extra evaluations in the
/// step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dopri5;

impl Tableau for Dopri5 {
    const C: [f64; 6] = [1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

    const A: [[f64; 6]; 6] = [
        [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
            0.0,
            0.0,
        ],
        [
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
            0.0,
        ],
        [
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ],
    ];

    const E: [f64; 7] = [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];

    const D: [f64; 7] = [
        -12715105075.0 / 11282082432.0,
        0.0,
        87487479700.0 / 32700410799.0,
        -10690763975.0 / 1880347072.0,
        701980252875.0 / 199316789632.0,
        -1453857185.0 / 822651844.0,
        69997945.0 / 29380423.0,
    ];
}
