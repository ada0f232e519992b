//! Tsitouras 5(4): the coefficients. The coefficients were computed from the equations of the paper
//! in 40 digits and rounded once. The module `order_conditions` checks them.
//!
//! The paper prints the weights of the dense output with 16 to 18 digits. The weights of this crate
//! differ from the published weights by at most 1e-14. The weights of this crate are the nearest
//! weights that satisfy the conditions of order 4 exactly.
//!
//! Source: Ch. Tsitouras, Runge–Kutta pairs of order 5(4) satisfying only the first column
//! simplifying assumption, Comput. Math. Appl. 62 (2011) 770–775, DOI 10.1016/j.camwa.2011.06.002.

use super::tableau::Tableau;

/// Tsitouras 5(4) with seven stages. The last stage is reused in the next step. The method has
/// order 5, with smaller error coefficients than [`Dopri5`](crate::Dopri5) and a sharper error
/// estimate. The dense output has order 4 without extra evaluations, and order 5 with two extra
/// evaluations in the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tsit5;

impl Tableau for Tsit5 {
    const C: [f64; 6] = [0.161, 0.327, 0.9, 0.980_025_540_904_509_7, 1.0, 1.0];

    const A: [[f64; 6]; 6] = [
        [0.161, 0.0, 0.0, 0.0, 0.0, 0.0],
        [
            -0.008_480_655_492_356_989,
            0.335_480_655_492_357,
            0.0,
            0.0,
            0.0,
            0.0,
        ],
        [
            2.897_153_057_105_493_5,
            -6.359_448_489_975_075,
            4.362_295_432_869_581_5,
            0.0,
            0.0,
            0.0,
        ],
        [
            5.325_864_828_439_257,
            -11.748_883_564_062_828,
            7.495_539_342_889_836_5,
            -0.092_495_066_361_755_25,
            0.0,
            0.0,
        ],
        [
            5.861_455_442_946_42,
            -12.920_969_317_847_11,
            8.159_367_898_576_159,
            -0.071_584_973_281_401,
            -0.028_269_050_394_068_383,
            0.0,
        ],
        [
            0.096_460_766_818_065_23,
            0.01,
            0.479_889_650_414_499_6,
            1.379_008_574_103_742,
            -3.290_069_515_436_081,
            2.324_710_524_099_774,
        ],
    ];

    const E: [f64; 7] = [
        0.001_780_011_052_225_771_4,
        0.000_816_434_459_656_746_9,
        -0.007_880_878_010_261_995,
        0.144_711_007_173_262_9,
        -0.582_357_165_452_555_2,
        0.458_082_105_929_186_97,
        -1.0 / 66.0,
    ];

    const D: [f64; 7] = [
        -1.053_088_497_729_021_6,
        0.101_7,
        2.490_627_285_651_253,
        -16.548_102_889_244_902,
        47.379_521_962_819_28,
        -34.870_657_861_496_61,
        2.5,
    ];
}
