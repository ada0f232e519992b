//! The numbers of one solution, and their rounding errors.

use super::*;
use crate::sketch::{Kind, door};
use joints::space3::Pose;
use model::System;

/// The value 0.1 + 0.2 − 0.3 = 2⁻⁵⁴ is the rounding error of one addition. A difference of 3e-15
/// relative to 0.3 is not a rounding error, because each of the two numbers is accurate to 3e-17.
#[test]
fn what_two_roundings_leave_is_zero_and_more_is_not() {
    let (mechanism, q, analysis) = door(&[Kind::Revolute; 2], Pose::GROUND).judged();
    let decision = analysis.whole().expect("small").into_owned();
    let configuration = Configuration::new(&mechanism, 0.0, &q, &decision).expect("decided");
    let rows = mechanism.layout().rows();
    // Forces along x of both hinges.
    let second = mechanism.layout().groups[1].rows.iter().next().expect("5");
    let mut sum = LinearForm::zero(rows);
    sum.add(&[(0, 1.0), (second, 1.0)]).expect("rows");
    let value = |force: f64| {
        let mut lambda = vec![0.0; rows];
        (lambda[0], lambda[second]) = (force, -0.3);
        configuration.value(&sum, &lambda)
    };
    assert_eq!(value(0.1 + 0.2), 0.0);
    let more = value(0.3 + 3e-15);
    assert!((more - 3e-15).abs() < 1e-16, "{more}");
}
