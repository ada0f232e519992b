use super::drawing::{GROUND, Kind, Measure};
use super::rows::{Owner, Wrench};
use super::truth::Truth;
use super::vector::{Vector, parts, whole};
use super::*;

const SCENES: u64 = 12 * 4 * 4;

#[test]
fn everything_is_drawn_where_it_holds_and_theory_agrees() {
    let mut with_theory = 0;
    for scene in scenes(7).take(SCENES as usize) {
        let what = format!("{} {}", scene.number, scene.family.name());
        assert!(scene.drawing.broken().is_empty(), "{what}");
        let right = Expected::of(&scene.drawing);
        if let Some(redundancy) = right.theory {
            assert_eq!(right.redundancy, redundancy, "{what}\n{}", scene.drawing.judged().0);
            with_theory += 1;
        }
    }
    assert!(4 * with_theory > SCENES, "{with_theory} with theory");
}
