//! Hand-derived results for the mechanisms of the catalogue. The results come from textbooks of
//! mechanism theory (Bennett, Sarrus, Bricard, Oldham, Hooke) and from planar results that are
//! converted to space. In converted results, three out-of-plane rows are redundant for each loop
//! that constrains its bodies to a plane.

use super::*;
use crate::fuzz::exact::expected::{Expected, Verdict};
use crate::fuzz::exact::truth::Truth;
use crate::fuzz::exact::wrench::{Owner, Wrench};

/// Checks that every joint is satisfied as drawn, and returns the results.
fn answer(drawing: &Drawing) -> Expected {
    assert_eq!(drawing.broken(), Vec::<&str>::new());
    Expected::of(drawing)
}

/// Returns rows, rank, redundancy and mobility.
fn counts(expected: &Expected) -> [usize; 4] {
    let e = expected;
    [e.rows, e.rank, e.redundancy, e.mobility]
}

/// Returns the components of a joint as letters; unique components are `u`.
fn letters(expected: &Expected, joint: usize) -> String {
    let components = expected.reactions[joint].components().iter();
    let letter = |v: &Verdict| if v.is_unique() { 'u' } else { 'n' };
    components.map(|(_, v)| letter(v)).collect()
}

fn all_letters(expected: &Expected) -> Vec<String> {
    let joints = 0..expected.reactions.len();
    joints.map(|k| letters(expected, k)).collect()
}

fn unit_force(k: usize) -> Wrench {
    Wrench {
        force: Vector::unit(k),
        moment: Vector::zero(),
    }
}

fn hinges(kinds: &[Flat]) -> Drawing {
    let places = kinds.iter().zip([0, 3, 7, 12]);
    let joints = places.map(|(kind, z)| flat(*kind, &parts([2, 5, z], 10)));
    door(&joints.collect::<Vec<_>>())
}

#[test]
fn v1_doors() {
    use Flat::{C, R};
    let three = hinges(&[R, R, R]);
    let expected = answer(&three);
    assert_eq!(counts(&expected), [15, 5, 10, 1]);
    // No wrench is unique. A hinge transmits no moment about its axis.
    assert_eq!(all_letters(&expected), ["nnnnnu"; 3]);
    assert!(
        expected
            .reactions
            .iter()
            .all(|r| r.free == 5 && r.carried == 5)
    );
    let truth = Truth::of(&three);
    for k in 0..3 {
        let sum = [0, 1, 2].map(|j| (Owner::Joint(j), unit_force(k)));
        assert!(truth.sum_is_unique(&sum));
        assert!(!truth.sum_is_unique(&sum[..2]));
    }
    assert_eq!(counts(&answer(&hinges(&[R, R]))), [10, 5, 5, 1]);
    assert_eq!(counts(&answer(&hinges(&[R, R, R, R]))), [20, 5, 15, 1]);
    let mixed = answer(&hinges(&[R, C, C]));
    assert_eq!(counts(&mixed), [13, 5, 8, 1]);
    assert_eq!(all_letters(&mixed), ["nnunnu", "nnunnu", "nnunnu"]);
}

#[test]
fn v3_four_bars() {
    use Flat::{C, R, S};
    let expected = answer(&four_bar([R; 4]));
    assert_eq!(counts(&expected), [20, 17, 3, 1]);
    assert_eq!(all_letters(&expected), ["uunnnu"; 4]);

    let expected = answer(&four_bar([R, R, R, S]));
    assert_eq!(counts(&expected), [18, 17, 1, 1]);
    // The self-stress is a force along z through D; its moment about A has no component along A–D ∥
    // x.
    assert_eq!(
        all_letters(&expected),
        ["uununu", "uunnnu", "uunnnu", "uunuuu"]
    );

    for kinds in [[R, R, S, C], [R, S, C, R]] {
        let expected = answer(&four_bar(kinds));
        assert_eq!(counts(&expected)[2..], [0, 1]);
        assert_eq!(all_letters(&expected), ["uuuuuu"; 4]);
    }
    let expected = answer(&four_bar([R, R, C, R]));
    assert_eq!(counts(&expected), [19, 17, 2, 1]);
    assert_eq!(all_letters(&expected), ["uuunnu"; 4]);

    let expected = answer(&four_bar([R, S, S, R]));
    assert_eq!(counts(&expected), [16, 16, 0, 2]);
}

#[test]
fn v3_four_bars_with_a_universal_joint() {
    use Flat::{R, S, U};
    let expected = answer(&four_bar([R, R, U, S]));
    assert_eq!(counts(&expected), [17, 17, 0, 1]);
    assert_eq!(all_letters(&expected), ["uuuuuu"; 4]);

    let mut drawing = four_bar_with_flat_cross();
    assert_eq!(counts(&answer(&drawing)), [17, 16, 1, 2]);
    // The test is repeated with the axes in the other bodies.
    let swapped = drawing.joints[2].kind.swapped();
    drawing.joints[2].kind = swapped.expect("its axes can be exchanged");
    assert_eq!(counts(&answer(&drawing)), [17, 16, 1, 2]);
}

#[test]
fn v4_slider_cranks() {
    use Flat::{C, P, R, S, U};
    let cases = [
        ([R, R, R, P], 3),
        ([R, R, C, P], 2),
        ([R, R, S, P], 1),
        ([R, S, R, P], 1),
        ([R, S, U, P], 0),
    ];
    for (kinds, redundancy) in cases {
        let expected = answer(&slider_crank(kinds));
        assert_eq!(expected.redundancy, redundancy, "{kinds:?}");
        assert_eq!(expected.mobility, 1, "{kinds:?}");
    }
}

#[test]
fn v5_v6_cranks_side_by_side() {
    assert_eq!(counts(&answer(&three_cranks())), [30, 23, 7, 1]);
    for n in 1..=3 {
        let expected = answer(&parallelograms(n, [3, 4]));
        assert_eq!((expected.redundancy, expected.mobility), (3 * n, 1));
        let flat = answer(&parallelograms(n, [5, 0]));
        assert_eq!((flat.redundancy, flat.mobility), (4 * n, n + 1));
    }
}

#[test]
fn v8_oldham_and_v10_hooke() {
    assert_eq!(counts(&answer(&oldham())), [20, 17, 3, 1]);
    assert_eq!(counts(&answer(&hooke_with_cross())), [20, 17, 3, 1]);
    assert_eq!(counts(&answer(&hooke_as_universal())), [14, 11, 3, 1]);
}

#[test]
fn v11_bennett() {
    let expected = answer(&bennett());
    assert_eq!(counts(&expected), [20, 17, 3, 1]);
    for reaction in &expected.reactions {
        assert!(!reaction.is_unique.is_unique());
        assert_eq!(reaction.carried - reaction.free, 2);
    }
    // Tz of the first joint is the moment about the axis of this joint.
    assert_eq!(letters(&expected, 0), "nnnnnu");
    assert_eq!(all_letters(&expected)[1..], ["nnnnnn"; 3]);
}

#[test]
fn v13_bricard() {
    let drawing = bricard();
    let expected = answer(&drawing);
    assert_eq!(counts(&expected), [30, 29, 1, 1]);
    assert!(expected.reactions.iter().all(|r| !r.is_unique.is_unique()));
    assert!(expected.reactions.iter().all(|r| r.free == 1));
}

#[test]
fn v14_sarrus() {
    let expected = answer(&sarrus(&[0, 1]));
    assert_eq!(counts(&expected), [30, 29, 1, 1]);
    assert_eq!(all_letters(&expected), ["uuuuun"; 6]);
    assert_eq!(counts(&answer(&sarrus(&[0, 1, 2]))), [45, 41, 4, 1]);
}

#[test]
fn v16_tables_and_v17_grooves() {
    let points = [[0, 0], [4, 0], [1, 3], [5, 4], [-2, 3]];
    for (n, redundancy) in [(3, 0), (4, 1), (5, 2)] {
        let expected = answer(&table(&points[..n]));
        assert_eq!(counts(&expected), [n, 3, redundancy, 3]);
    }
    let points = [[3, 0], [-2, 3], [-1, -4], [2, 5]];
    for (n, redundancy) in [(3, 0), (4, 2)] {
        let expected = answer(&grooves(&points[..n]));
        assert_eq!(counts(&expected), [2 * n, 6, redundancy, 0]);
    }
}

#[test]
fn v18_hexapod() {
    let expected = answer(&hexapod(false));
    assert_eq!(counts(&expected), [72, 72, 0, 6]);
    assert_eq!(expected.without_drives, None);
    let expected = answer(&hexapod(true));
    assert_eq!(counts(&expected), [78, 78, 0, 0]);
    let left = expected
        .without_drives
        .map(|w| [w.rank, w.redundancy, w.mobility]);
    assert_eq!(left, Some([72, 0, 6]));
}

/// Each parallelogram has three redundant rows. The platform has three further redundant rows,
/// because each of the three legs prevents two rotations of the platform by two couples.
#[test]
fn v19_delta() {
    assert_eq!(counts(&answer(&delta())), [105, 93, 12, 3]);
}

#[test]
fn four_bars_in_a_row_add_up() {
    for n in 1..=3 {
        let expected = answer(&four_bars_in_a_row(n));
        assert_eq!(counts(&expected), [20 * n, 17 * n, 3 * n, n]);
        assert_eq!(all_letters(&expected)[..4], ["uunnnu"; 4]);
    }
}

#[test]
fn v22_cars() {
    let straight = answer(&car(&Ratio::zero()));
    assert_eq!(counts(&straight), [32, 29, 3, 1]);
    let turned = answer(&car(&Ratio::new(1, 10)));
    assert_eq!(counts(&turned), [32, 30, 2, 0]);
    // The four contacts have a self-stress of normal forces with a zero sum.
    for expected in [straight, turned] {
        assert_eq!(
            (expected.rank_holonomic, expected.rank_nonholonomic),
            (23, 8)
        );
    }
}
