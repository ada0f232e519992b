//! Mechanisms known by hand and random ones with planted redundancy (crate `lab`, `fuzz::space`),
//! built without files. The expected counts come from textbooks and screws, and every verdict is
//! compared with exact arithmetic on wrenches.

use lab::fuzz::space::pose::{Writing, posed};
use lab::fuzz::space::text::Precision;
use lab::fuzz::space::{Drawing, Expected, catalogue, description, scenes};
use model::{Mechanism, System};
use solvability::{ReactionVerdict, Verdict, analyse};
use suite::numbers::Numbers;

/// Rows, rank, redundancy and mobility of all mechanisms of the catalogue that no other test
/// counts.
const COUNTS: [(&str, [usize; 4]); 17] = [
    ("V5 three cranks", [30, 23, 7, 1]),
    ("V6 two parallelograms", [35, 29, 6, 1]),
    ("V6 two parallelograms, flat", [35, 27, 8, 3]),
    ("V8 Oldham", [20, 17, 3, 1]),
    ("V13 Bricard", [30, 29, 1, 1]),
    ("V14 Sarrus with two legs", [30, 29, 1, 1]),
    ("V14 Sarrus with three legs", [45, 41, 4, 1]),
    ("V16 table on three points", [3, 3, 0, 3]),
    ("V16 table on four points", [4, 3, 1, 3]),
    ("V16 table on five points", [5, 3, 2, 3]),
    ("V17 three balls in grooves", [6, 6, 0, 0]),
    ("V17 four balls in grooves", [8, 6, 2, 0]),
    ("V18 6-UPS", [72, 72, 0, 6]),
    ("V18 6-UPS, driven", [78, 78, 0, 0]),
    ("V19 Delta", [105, 93, 12, 3]),
    ("V22 car, straight", [32, 29, 3, 1]),
    ("V22 car, front axle turned", [32, 30, 2, 0]),
];

/// Returns rows, rank, redundancy and mobility, after a comparison of all verdicts.
fn judged(what: &str, drawing: &Drawing) -> [usize; 4] {
    let expected = Expected::of(drawing);
    let description =
        description(drawing, &Precision::default()).unwrap_or_else(|e| panic!("{what}: {e}"));
    let mechanism = Mechanism::build(&description).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    let (q, _) = mechanism.described_state();
    let found = analyse(&mechanism, 0.0, &q).unwrap_or_else(|e| panic!("{what}: {e}"));
    let decision = &found.decision;
    assert!(decision.is_decided(), "{what}: {decision:?}");
    let rows = mechanism.layout().rows();
    let counts = [rows, decision.rank, rows - decision.rank, found.mobility()];
    let e = &expected;
    assert_eq!(counts, [e.rows, e.rank, e.redundancy, e.mobility], "{what}");
    let alone = [found.rank_holonomic, found.rank_nonholonomic];
    assert_eq!(alone, [e.rank_holonomic, e.rank_nonholonomic], "{what}");
    assert_eq!(found.dependencies.len(), e.redundancy, "{what}");
    let of = |name: &str| found.reactions.iter().find(|r| r.name == name);
    for right in &expected.reactions {
        let what = format!("{what}, {}", right.name);
        let verdict = of(&right.name).unwrap_or_else(|| panic!("{what}: no verdict"));
        assert_eq!(unique(verdict), right.is_unique.is_unique(), "{what}");
        for &(name, is_unique) in right.components() {
            let component = verdict.components.iter().find(|c| c.name == name);
            let found = component.is_none_or(|c| c.judgement.verdict == Verdict::Unique);
            assert_eq!(found, is_unique.is_unique(), "{what}: {name}, {verdict:?}");
        }
        let free = right.carried - right.free;
        assert_eq!(
            verdict.live_directions.as_ref().map(Vec::len),
            Some(free),
            "{what}"
        );
    }
    counts
}

fn unique(verdict: &ReactionVerdict) -> bool {
    assert!(
        !matches!(verdict.wrench.verdict, Verdict::Undecided { .. }),
        "{verdict:?}"
    );
    verdict.wrench.verdict == Verdict::Unique
}

/// Each mechanism is tested as drawn, and under two rigid motions with bodies in other frames, off
/// their mass centres, and in another order.
#[test]
fn mechanisms_known_by_hand() {
    let catalogue = catalogue::all();
    for (name, counts) in COUNTS {
        let known = catalogue.iter().find(|(known, _)| *known == name);
        let (_, drawing) = known.unwrap_or_else(|| panic!("no {name}"));
        assert_eq!(judged(name, drawing), counts, "{name}");
    }
    for (k, (name, drawing)) in catalogue.iter().enumerate() {
        for (seed, writing) in [(1, Writing::Moved), (2, Writing::Moved), (3, Writing::Far)] {
            let drawing = posed(drawing, writing, &mut Numbers::new(seed + 10 * k as u64));
            judged(&format!("{name}, {}", writing.name()), &drawing);
        }
    }
}

/// The mechanisms are N four-bars side by side, and N four-bars on each other.
#[test]
fn four_bars_add_up() {
    for n in 1..=4 {
        let rows = 5 * (3 * n + 1);
        let steep = judged("side by side", &catalogue::parallelograms(n, [3, 4]));
        assert_eq!(steep, [rows, rows - 3 * n, 3 * n, 1]);
        let flat = judged("flat", &catalogue::parallelograms(n, [5, 0]));
        assert_eq!(flat, [rows, rows - 4 * n, 4 * n, n + 1]);
        let row = judged("in a row", &catalogue::four_bars_in_a_row(n));
        assert_eq!(row, [20 * n, 17 * n, 3 * n, n]);
    }
}

#[test]
fn random_mechanisms_with_planted_redundancy() {
    for scene in scenes(7).take(SCENES) {
        let (number, family) = (scene.number, scene.family.name());
        let what = format!("{number}, {family}, {}", scene.writing.name());
        judged(&what, &scene.drawing);
    }
}

/// Each drawing is written as a scene in four ways.
const SCENES: usize = 240;
