//! Tests the exact reference in space: verdicts that follow from theory, and changes of the data
//! that must be detected.

use std::collections::BTreeMap;

use super::catalogue;
use super::*;
use crate::fuzz::exact::expected::Verdict;
use crate::fuzz::exact::truth::{Reaction, Truth};
use crate::fuzz::exact::wrench::Owner;

/// Number of scenes: five drawings of each of the 12 families, in each of the 4 variants.
const SCENES: u64 = 12 * 4 * 5;

/// For each joint or drive, by name: whether the wrench is unique, whether the force is unique, the
/// number of directions of the wrenches, and the number of directions that are not unique.
type Verdicts = BTreeMap<String, (bool, bool, usize, usize)>;

/// Returns the results that do not depend on the variant: ranks and verdicts.
fn invariants(right: &Expected) -> ([usize; 6], Verdicts) {
    let ranks = [
        right.rows,
        right.rank,
        right.mobility,
        right.rank_holonomic,
        right.rank_nonholonomic,
        right.without_drives.map_or(0, |w| w.rank),
    ];
    let reactions = right.reactions.iter();
    let reactions = reactions.map(|r| {
        let mut force = r.components()[..3].iter();
        let force = force.all(|(_, v)| v.is_unique());
        let verdicts = (r.is_unique.is_unique(), force, r.carried, r.free);
        (r.name.clone(), verdicts)
    });
    (ranks, reactions.collect())
}

#[test]
fn everything_is_drawn_where_it_holds_and_theory_agrees() {
    let mut with_theory = 0;
    for scene in scenes(7).take(SCENES as usize) {
        let what = format!("{} {}", scene.number, scene.family.name());
        assert_eq!(scene.drawing.broken(), Vec::<&str>::new(), "{what}");
        let right = Expected::of(&scene.drawing);
        if let Some(redundancy) = right.theory {
            assert_eq!(right.redundancy, redundancy, "{what}\n{}", right.describe());
            with_theory += 1;
        }
    }
    assert!(4 * with_theory > SCENES, "{with_theory} with theory");
}

#[test]
fn the_way_of_writing_changes_no_verdict() {
    for drawn in 0..SCENES / 4 {
        let ways = [0, 1, 2, 3].map(|way| scene(3, 4 * drawn + way));
        let right = ways
            .each_ref()
            .map(|s| invariants(&Expected::of(&s.drawing)));
        for other in &right[1..] {
            assert_eq!(*other, right[0], "drawing {drawn}");
        }
    }
}

#[test]
fn the_catalogue_is_the_same_wherever_it_stands() {
    for (name, drawing) in catalogue::all() {
        let right = invariants(&Expected::of(&drawing));
        for (seed, writing) in Writing::ALL.into_iter().enumerate() {
            let posed = pose::posed(&drawing, writing, &mut Numbers::new(seed as u64));
            assert_eq!(posed.broken(), Vec::<&str>::new(), "{name}");
            assert_eq!(
                invariants(&Expected::of(&posed)),
                right,
                "{name} {writing:?}"
            );
        }
    }
}

#[test]
fn verdicts_by_ranks_and_by_free_wrenches_agree() {
    // A reaction is unique if and only if rank C = rank C_X + rank of the other rows; a row is
    // unique if and only if the rank decreases without it.
    for scene in scenes(19).step_by(7).take(60) {
        let truth = Truth::of(&scene.drawing);
        let right = Expected::from_truth(&truth);
        for reaction in &right.reactions {
            let own = truth.rows_of(reaction.owner);
            let by_ranks = truth.is_unique_without(&own, &[]);
            let what = format!("{} {}", scene.number, reaction.name);
            assert_eq!(reaction.is_unique, by_ranks.into(), "{what}");
            let mut components = reaction.components().iter();
            let all = components.all(|(_, v)| v.is_unique());
            assert_eq!(reaction.is_unique, all.into(), "{what}");
            assert_eq!(reaction.carried, truth.rank_of(&own), "{what}");
            for &(row, _, is_unique) in &reaction.rows {
                let by_ranks = Verdict::from(!truth.keeps_motion(&[row]));
                assert_eq!(is_unique, by_ranks, "{what} row {row}");
            }
        }
    }
}

#[test]
fn verdicts_differ_within_a_family() {
    // A program that reports all scenes as redundant, or all as not redundant, would be wrong in
    // many scenes.
    let mut counts: BTreeMap<Family, [usize; 2]> = BTreeMap::new();
    for number in (0..480).step_by(4) {
        let scene = scene(5, number);
        let right = Expected::of(&scene.drawing);
        let count = counts.entry(scene.family).or_default();
        count[usize::from(right.redundancy > 0)] += 1;
    }
    for family in [Family::Chains, Family::Supports, Family::Platforms] {
        assert!(counts[&family].iter().all(|&n| n > 0), "{counts:?}");
    }
    let [full, redundant] = counts
        .values()
        .fold([0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    assert!(full > 12 && redundant > 60, "{counts:?}");
}

#[test]
fn the_same_seed_gives_the_same_scenes() {
    let texts = |seed| scenes(seed).take(24).map(|s| s.drawing.judged());
    assert!(texts(11).eq(texts(11)));
    assert!(!texts(11).eq(texts(12)));
}

#[test]
fn a_circuit_names_the_rows_that_depend_on_each_other() {
    // A table has its legs at the corners of a square. The signs of the normal forces in the
    // self-stress alternate.
    let drawing = catalogue::table(&[[0, 0], [2, 0], [2, 2], [0, 2]]);
    let truth = Truth::of(&drawing);
    assert_eq!(truth.circuit(&[0, 1, 2]), None);
    let found = truth.circuit(&[0, 1, 2, 3]);
    let found = found.map(|z| truth.coefficients(&[0, 1, 2, 3], &z));
    let alternating = [vec![1.0, -1.0, 1.0, -1.0], vec![-1.0, 1.0, -1.0, 1.0]];
    assert!(found.is_some_and(|z| alternating.contains(&z)));
    assert!(truth.is_unique_without(&[0], &[3]));
    assert!(!truth.keeps_motion(&[2, 3]));
}

#[test]
fn a_moment_may_be_unique_about_another_point() {
    // In a spherical linkage all free wrenches are forces through the centre, so the moment about
    // the centre is unique, and the moment about a joint is not.
    let drawing = catalogue::hooke_with_cross();
    let truth = Truth::of(&drawing);
    let bearing = Owner::Joint(0);
    let moments = |free: Vec<Reaction>| free.iter().all(|w| (3..6).all(|k| w.is_zero(k)));
    assert!(moments(truth.free_about(bearing, &vector::Vector::zero())));
    let place = truth.free_wrenches(bearing).expect("a place");
    assert!(!moments(place));
}

#[test]
fn every_type_of_joint_occurs() {
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    for number in (0..1200).step_by(4) {
        for joint in &scene(1, number).drawing.joints {
            *names.entry(joint.kind.name()).or_default() += 1;
        }
    }
    assert_eq!(names.len(), 15, "{names:?}");
}
