//! Ends of bounds that are reached.

use model::ConstraintId;
use pfaff::solvability::Elasticity;

use super::{TABLE, assert_range, of, study};

/// One soft joint at a time reaches the ends if one component is undetermined.
#[test]
fn soft_joints_reach_the_ends_of_one_component() {
    let study = study(TABLE);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let found = start.bounds(&solution, &Elasticity::default());
    // Tables on three legs, by hand: the loads of the four legs without one of them.
    let expected = [
        [-78.48, 0.0],
        [-73.575, 4.905],
        [-44.145, 34.335],
        [-78.48, 0.0],
    ];
    for (k, expected) in expected.into_iter().enumerate() {
        let bounds = of(&found, k, "Fz");
        assert_range(&bounds, expected, &format!("leg {k}"));
        assert_eq!(bounds.reached, [true; 2]);
        assert_eq!((bounds.at_lowest.len(), bounds.at_highest.len()), (1, 1));
        let most = found.largest_magnitudes(ConstraintId(k)).expect("bounds")[0];
        let expected = expected[0].abs().max(expected[1].abs());
        assert!((most.expect("a force") - expected).abs() < 1e-9);
    }
}
