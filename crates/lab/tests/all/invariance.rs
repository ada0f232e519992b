//! Tests that verdicts in space do not depend on the description of a mechanism: position,
//! orientation, units, order, exchange of first and second body, frames and mass centres of the
//! bodies. Two descriptions of one mechanism are compared with each other, without a reference
//! result.

use std::collections::BTreeMap;

use lab::fuzz::space::drawing::Drawing;
use lab::fuzz::space::pose::{Writing, posed};
use lab::fuzz::space::ratio::Ratio;
use lab::fuzz::space::text::Precision;
use lab::fuzz::space::vector::{Motion, Rotation, Vector};
use lab::fuzz::space::{description, scene};
use pfaff::model::Mechanism;
use pfaff::solvability::{Verdict, analyse};
use proptest::prelude::*;
use suite::numbers::Numbers;

/// Seed of the drawings; proptest selects the indices of the drawings.
const SEED: u64 = 1_111;

/// Number of drawings from which proptest selects: twenty of each family.
const DRAWINGS: u64 = 240;

/// Longest translation of a near scene (m): three times the largest coordinate, which is below 10
/// m.
const NEAR: i64 = 30;

/// Longest translation of a far scene (m).
const FAR: i64 = 1_000_000;

/// Results for a mechanism that do not depend on axes. For each reaction, by name: the verdict on
/// the reaction, the verdict on its multipliers, the number of directions of unique wrenches, and
/// the number of directions of wrenches that are not always zero.
#[derive(Debug, PartialEq)]
struct Said {
    /// Rank, redundancy, rank of the holonomic and of the nonholonomic rows; `None` if undecided.
    ranks: Option<[usize; 4]>,
    reactions: BTreeMap<String, (Verdict, Verdict, [Option<usize>; 2])>,
}

fn said(drawing: &Drawing) -> Said {
    let description = description(drawing, &Precision::default()).expect("a scene");
    let mechanism = Mechanism::build(&description).expect("the mechanism builds");
    let (q, _) = mechanism.described_state();
    let a = analyse(&mechanism, 0.0, &q).expect("C is finite");
    let d = &a.decision;
    let ranks = [d.rank, d.redundancy, a.rank_holonomic, a.rank_nonholonomic];
    let reactions = a.reactions.iter().map(|r| {
        let directions = [Some(&r.unique_directions), r.live_directions.as_ref()];
        let dimensions = directions.map(|d| d.map(Vec::len));
        let verdicts = (r.wrench.verdict.clone(), r.multipliers.verdict.clone());
        (r.name.clone(), (verdicts.0, verdicts.1, dimensions))
    });
    Said {
        ranks: d.is_decided().then_some(ranks),
        reactions: reactions.collect(),
    }
}

fn is_open(verdict: &Verdict) -> bool {
    matches!(verdict, Verdict::Undecided { .. })
}

/// Whether both results can be correct. An undecided verdict contradicts no other verdict.
fn agree(a: &Said, b: &Said) -> bool {
    let same = |a: &Verdict, b: &Verdict| a == b || is_open(a) || is_open(b);
    let names = a.reactions.keys().eq(b.reactions.keys());
    let ranks = a.ranks.zip(b.ranks);
    names
        && ranks.is_none_or(|(a, b)| a == b)
        && a.reactions
            .iter()
            .all(|(name, (wrench, rows, dimensions))| {
                let (other, other_rows, other_dimensions) = &b.reactions[name];
                let is_decided = !(is_open(wrench) || is_open(other));
                same(wrench, other)
                    && same(rows, other_rows)
                    && (!is_decided || ranks.is_none() || dimensions == other_dimensions)
            })
}

/// Quaternions of integers up to 1000, so that the entries of the rotation matrices use all digits.
fn turns() -> impl Strategy<Value = Rotation> {
    let parts = prop::array::uniform4(-1000_i64..=1000);
    let parts = parts.prop_filter("a rotation", |q| *q != [0; 4]);
    parts.prop_map(Rotation::whole)
}

/// Units of length: metres, millimetres, kilometres, inches and feet.
fn units() -> impl Strategy<Value = Ratio> {
    let units = [(1, 1), (1000, 1), (1, 1000), (10_000, 254), (3048, 10_000)];
    prop::sample::select(units.to_vec()).prop_map(|(a, b)| Ratio::new(a, b))
}

fn shifts(most: i64) -> impl Strategy<Value = Vector> {
    let parts = prop::array::uniform3(-1000_i64..=1000);
    parts.prop_map(move |p| Vector(p.map(|x| Ratio::new((x * most) as i32, 1000))))
}

/// Returns a drawing in its original form.
fn drawn(number: u64) -> Drawing {
    let ways = Writing::ALL.len() as u64;
    scene(SEED, ways * number).drawing
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, failure_persistence: None, ..ProptestConfig::default() })]

    /// If a mechanism is translated, rotated, or described in other units, the verdicts are the
    /// same, and all of them are decided.
    #[test]
    fn a_place_an_orientation_and_units_change_nothing(
        number in 0..DRAWINGS, turn in turns(), shift in shifts(NEAR), scale in units()
    ) {
        let here = drawn(number);
        let mut there = here.clone();
        there.moved(&Motion { scale, ..Motion::rigid(turn, shift) });
        let (here, there) = (said(&here), said(&there));
        prop_assert_eq!(here, there);
    }

    /// The variants have another order of bodies, joints and drives, exchanged first and second
    /// bodies, other frames, mass centres, masses and tensors.
    #[test]
    fn the_description_of_bodies_and_joints_changes_nothing(
        number in 0..DRAWINGS, turn in turns(), other in any::<u64>()
    ) {
        let here = drawn(number);
        let mut there = here.clone();
        there.moved(&Motion::rigid(turn, Vector::zero()));
        let there = posed(&there, Writing::Reordered, &mut Numbers::new(other));
        let (here, there) = (said(&here), said(&there));
        prop_assert!(here.ranks.is_some() && there.ranks.is_some());
        prop_assert!(agree(&here, &there), "{here:#?}\n{there:#?}");
        let is_decided = |s: &Said| s.reactions.values().all(|r| !is_open(&r.0) && !is_open(&r.1));
        prop_assert!(is_decided(&here) && is_decided(&there), "{here:#?}\n{there:#?}");
    }

    /// Far from the origin, coordinates have fewer significant digits. Each result is the same or
    /// undecided.
    #[test]
    fn far_away_nothing_is_contradicted(
        number in 0..DRAWINGS, turn in turns(), shift in shifts(FAR)
    ) {
        let here = drawn(number);
        let mut there = here.clone();
        there.moved(&Motion::rigid(turn, shift));
        let (here, there) = (said(&here), said(&there));
        prop_assert!(agree(&here, &there), "{here:#?}\n{there:#?}");
    }
}
