//! Components in joint axes, which rotate with the mechanism.

use joints::space3::Pose;
use model::space::{cross, difference, dot, norm};
use model::{ConstraintId, Frame};

use super::judge_frames;
use crate::sketch::{Kind, Z, four_bar, places};

/// Permitted difference between axes. It is a rounding error.
const ROUNDING: f64 = 1e-13;

/// V3: in the axes of its joints, a planar four-bar has the same verdicts at any position.
#[test]
fn verdicts_in_joint_axes_turn_with_the_mechanism() {
    for place in places() {
        let (mechanism, q, analysis) = four_bar([Kind::Revolute; 4], place).judged();
        let decision = analysis.whole().expect("small");
        for k in 0..4 {
            let frames = judge_frames(&mechanism, 0.0, &q, &decision, ConstraintId(k));
            let frames = frames.expect("a joint");
            let kinds: Vec<Frame> = frames.iter().map(|f| f.frame).collect();
            assert_eq!(kinds, [Frame::Global, Frame::FirstBody, Frame::Joint]);
            let own = frames.last().expect("joint axes");
            let [u, v, w] = *own.axes.as_array().expect("three axes");
            assert!(norm(&difference(w, place.direction_to_global(Z))) < ROUNDING);
            assert!(norm(&difference(cross(u, v), w)) < ROUNDING && dot(u, v).abs() < ROUNDING);
            let found = own.components.iter();
            let found: Vec<(&str, bool)> = found
                .map(|c| (c.name, c.judgement.verdict.is_unique()))
                .collect();
            let [yes, no] = [true, false];
            let expected = [
                ("Fu", yes),
                ("Fv", yes),
                ("Fw", no),
                ("Tu", no),
                ("Tv", no),
                ("Tw", yes),
            ];
            assert_eq!(found, expected);
        }
    }
}

/// A ball joint has no axis, and therefore no joint axes.
#[test]
fn a_ball_has_no_joint_axes() {
    let kinds = [
        Kind::Revolute,
        Kind::Spherical,
        Kind::Spherical,
        Kind::Revolute,
    ];
    let (mechanism, q, analysis) = four_bar(kinds, Pose::GROUND).judged();
    let decision = analysis.whole().expect("small");
    let frames = judge_frames(&mechanism, 0.0, &q, &decision, ConstraintId(1)).expect("a joint");
    assert!(frames.iter().all(|f| f.frame != Frame::Joint) && frames.len() == 2);
}
