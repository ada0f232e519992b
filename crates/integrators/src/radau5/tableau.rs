//! The coefficients: nodes, the transformation that makes A⁻¹ block diagonal, and the collocation
//! polynomial.
//!
//! The module `tests` compares the coefficients with the matrix A that is computed from the nodes.

/// Square root √6.
const SQRT_6: f64 = 2.449_489_742_783_178;

/// Nodes c_i: zeros of the Radau polynomial d²/dx² [x²·(x − 1)³].
pub(super) const C: [f64; 3] = [(4.0 - SQRT_6) / 10.0, (4.0 + SQRT_6) / 10.0, 1.0];

/// Real eigenvalue u₁ of A⁻¹.
pub(super) const REAL: f64 = 3.637_834_252_744_496;
/// Complex eigenvalue of A⁻¹ with positive imaginary part.
pub(super) const COMPLEX: [f64; 2] = [2.681_082_873_627_752_3, 3.050_430_199_247_410_5];

/// Transformation T: T⁻¹·A⁻¹·T is block diagonal with the blocks u₁ and [α, −β; β, α].
pub(super) const T: [[f64; 3]; 3] = [
    [
        9.123_239_487_089_295e-2,
        -0.141_255_295_020_954_2,
        -3.002_919_410_514_742_4e-2,
    ],
    [
        0.241_717_932_707_107,
        0.204_129_352_293_799_93,
        0.382_942_112_757_261_9,
    ],
    [0.966_048_182_615_093, 1.0, 0.0],
];

/// Inverse T⁻¹.
pub(super) const T_INVERSE: [[f64; 3]; 3] = [
    [
        4.325_579_890_063_155,
        0.339_199_251_815_809_87,
        0.541_770_539_935_874_9,
    ],
    [
        -4.178_718_591_551_905,
        -0.327_682_820_761_062_4,
        0.476_623_554_500_550_46,
    ],
    [
        -0.502_872_634_945_786_9,
        2.571_926_949_855_605,
        -0.596_039_204_828_224_9,
    ],
];

/// Weights `E_i = −L_i'(0)`. The sum h·f0 + Σ E_i·z_i is the defect of the collocation polynomial
/// at the start, which is the estimated error of order 3.
pub(super) const E: [f64; 3] = [
    -(13.0 + 7.0 * SQRT_6) / 3.0,
    (-13.0 + 7.0 * SQRT_6) / 3.0,
    -1.0 / 3.0,
];

/// Returns the values at θ of the Lagrange polynomials L_i of the nodes 0, c₁, c₂, 1. The
/// polynomial of node 0 is omitted: u(θ) = y0 + Σ L_i(θ)·z_i.
pub(super) fn lagrange(theta: f64) -> [f64; 3] {
    let [a, b, _] = C;
    let x = theta;
    [
        x * (x - b) * (x - 1.0) / (a * (a - b) * (a - 1.0)),
        x * (x - a) * (x - 1.0) / (b * (b - a) * (b - 1.0)),
        x * (x - a) * (x - b) / ((1.0 - a) * (1.0 - b)),
    ]
}

/// Returns L_i'(θ).
pub(super) fn lagrange_derivative(theta: f64) -> [f64; 3] {
    let [a, b, _] = C;
    let x = theta;
    // Returns the derivative d/dx of x·(x − p)·(x − q).
    let cubic = |p: f64, q: f64| x * (3.0 * x - 2.0 * (p + q)) + p * q;
    [
        cubic(b, 1.0) / (a * (a - b) * (a - 1.0)),
        cubic(a, 1.0) / (b * (b - a) * (b - 1.0)),
        cubic(a, b) / ((1.0 - a) * (1.0 - b)),
    ]
}
