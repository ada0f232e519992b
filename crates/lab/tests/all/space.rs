//! Tests for mechanisms in space that the results of the program equal the results of exact
//! arithmetic, and that converted planar scenes have the same results as in the plane.
//! `cargo run --release -p lab -- fuzz exact --suite space` tests 20 000 of them.

use std::fs;

use lab::fuzz::exact::answer::answer;
use lab::fuzz::exact::expected::Elsewhere;
use lab::fuzz::exact::findings::Kind;
use lab::fuzz::exact::tally::{Suite, Tally};
use lab::fuzz::exact::{precisions, rounded};
use lab::fuzz::space::drawing::{self, Drawing, GROUND};
use lab::fuzz::space::examine::{compared, examine};
use lab::fuzz::space::text::{Precision, text, text_within};
use lab::fuzz::space::vector::{Motion, Vector, whole};
use lab::fuzz::space::within::Meant;
use lab::fuzz::space::{catalogue, lifted, ratio::Ratio, scene};
use serde_json::{Value, json};

const SEED: u64 = 3;

/// Two drawings of each family in each variant.
const SCENES: u64 = 96;

#[test]
fn no_answer_contradicts_exact_arithmetic() {
    let tally = Tally::of(Suite::Space, SEED, 0, SCENES, || ());
    assert!(tally.passes(), "\n{}", tally.describe());
    assert_eq!(tally.contradicting, [0; 0], "\n{}", tally.describe());
}

#[test]
fn the_catalogue_has_its_answers() {
    for (name, drawing) in catalogue::all() {
        let findings = compared(&drawing);
        assert!(findings.0.is_empty(), "{name}: {findings:#?}");
    }
}

/// Verdicts are the same if a mechanism is a thousand times smaller or larger.
#[test]
fn verdicts_do_not_depend_on_size() {
    for number in (1..SCENES).step_by(8) {
        for scale in [Ratio::new(1, 1000), Ratio::whole(1000)] {
            let mut drawing = scene(SEED, number).drawing;
            let scale = Motion {
                scale,
                ..Motion::none()
            };
            drawing.moved(&scale);
            for body in &mut drawing.bodies {
                body.centre = lab::fuzz::space::vector::Vector::zero();
            }
            let findings = compared(&drawing);
            assert!(findings.0.is_empty(), "{number}: {findings:#?}");
        }
    }
}

/// Returns the results for all scenes of some drawings with few digits.
fn of_drawings(seed: u64, from: u64, drawings: u64) -> Tally {
    let suite = Suite::RoundedInSpace;
    let ways = suite.ways() as u64;
    Tally::of(suite, seed, ways * from, ways * drawings, || ())
}

#[test]
fn with_few_digits_no_answer_is_wrong() {
    let tally = of_drawings(1, 0, 12);
    assert!(tally.passes(), "\n{}", tally.describe());
}

/// Drawings with a couple along an axis of the ground. Rounding rotated the couple slightly, and an
/// earlier version reported its other components wrongly as not unique.
#[test]
fn couples_have_directions_within_a_tolerance() {
    for drawn in [29, 35, 38, 100] {
        let tally = of_drawings(1, drawn, 1);
        assert_eq!(tally.wrong(), 0, "{drawn}\n{}", tally.describe());
    }
}

/// Bricard's linkages with few digits, which do not determine the configuration of the linkage
/// along its motion. With four digits, an earlier version reported a full rank, and the path
/// continued along another branch.
#[test]
fn bricard_with_few_digits_is_right_or_undecided() {
    for (seed, drawn, digits) in [(2, 209, 6), (3, 11, 7)] {
        let outcomes = rounded::outcomes(Suite::RoundedInSpace, seed, drawn);
        for (outcome, known) in outcomes.iter().zip(precisions::DIGITS) {
            let worst = outcome.worst();
            let is_allowed = match worst {
                Some(kind) => !kind.is_wrong() && known < digits,
                None => true,
            };
            assert!(
                is_allowed,
                "{seed} {drawn}, {known} digits:\n{}",
                outcome.page("")
            );
        }
    }
}

/// An earlier version required that a row that is redundant within the tolerance depends on the
/// other rows at other configurations as accurately as at the given configuration. Therefore, with
/// 6 to 10 digits, couplings, planar linkages, doors and vehicles were reported as redundant only
/// at this configuration.
#[test]
fn with_few_digits_a_redundancy_that_lasts_is_the_same_elsewhere() {
    for (seed, drawn) in [(1, 6), (2, 46), (2, 13), (3, 14)] {
        let tally = of_drawings(seed, drawn, 1);
        assert_eq!(tally.wrong(), 0, "{seed} {drawn}\n{}", tally.describe());
    }
}

/// Returns two links with hinges about z; the second link has a knife edge with its normal along x
/// at its end. The edge constrains no motion at the configuration at which the links are in line,
/// but it constrains the motion at other configurations.
fn links_in_line() -> Drawing {
    let mut drawing = Drawing::default();
    let [first, second] = [drawing.body(), drawing.body()];
    let axis = Vector::unit(2);
    drawing.joint(
        [GROUND, first],
        catalogue::revolute(&whole([0, 0, 0]), &axis),
    );
    drawing.joint(
        [first, second],
        catalogue::revolute(&whole([2, 0, 0]), &axis),
    );
    let edge = drawing::Kind::KnifeEdge {
        at: whole([3, 0, 0]),
        normal: Vector::unit(0),
    };
    drawing.joint([second, GROUND], edge);
    drawing
}

/// The comparison finds a wrong statement about other configurations, with all digits and within a
/// tolerance.
#[test]
fn a_changed_claim_about_other_poses_is_found_out() {
    let drawings = catalogue::all();
    let bennett = drawings.iter().find(|(name, _)| *name == "V11 Bennett");
    let (_, bennett) = bennett.expect("a catalogue with Bennett's linkage");
    let line = links_in_line();
    let only_here = "redundancy 3 and its verdicts hold at this singular configuration only";
    let last = [
        ("/generic/redundancy", json!(2)),
        ("/generic/redundancy", json!(4)),
        ("/evidence/permanent", json!(false)),
        ("/warnings", json!([only_here])),
    ];
    let here = [
        ("/generic/redundancy", json!(1)),
        ("/evidence/permanent", json!(true)),
    ];
    for (drawing, is, digits, claims) in [
        (bennett, Elsewhere::Same, None, &last[..]),
        (bennett, Elsewhere::Same, Some(8), &last[..]),
        (&line, Elsewhere::Higher, None, &here[..]),
    ] {
        assert_eq!(drawing.right().1.elsewhere, is);
        let precision = digits.map_or_else(Precision::default, |digits| {
            Precision::of_digits(drawing, digits)
        });
        let document = answer(&text_within(drawing, &precision)).expect("it has an answer");
        let meant = Meant::of(drawing);
        let found = |document: &Value| {
            let findings = match digits {
                None => examine(drawing, document),
                Some(_) => meant.judge(document, precision.tolerance).findings,
            };
            findings.0.iter().map(|f| f.kind).collect::<Vec<_>>()
        };
        assert_eq!(found(&document), []);
        assert_eq!(document["evidence"]["permanent"], is == Elsewhere::Same);
        for (pointer, value) in claims {
            let mut changed = document.clone();
            *changed.pointer_mut(pointer).expect(pointer) = value.clone();
            assert_eq!(found(&changed), [Kind::Sentence], "{pointer} = {value}");
        }
    }
}

#[test]
fn lifted_scenes_have_the_answers_of_the_plane() {
    let tally = Tally::of(Suite::Lifted, SEED, 0, 112, || ());
    assert!(tally.passes(), "\n{}", tally.describe());
}

/// Compares the answers for scenes of the suite and of the examples that can be converted to space.
#[test]
fn known_scenes_have_the_answers_of_the_plane() {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let files = fs::read_dir(examples).expect("the examples");
    let files = files.map(|file| file.expect("a file").path());
    let scenes = files.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let scenes = scenes.map(|path| {
        let text = fs::read_to_string(&path).expect("text");
        (path.display().to_string(), text)
    });
    let suite = suite::all().map(|case| (case.name.to_owned(), case.scene.to_owned()));
    let (mut whole, mut cycles) = (0, 0);
    for (name, text) in scenes.chain(suite) {
        let Some((lifted, judged)) = lifted::examine(&text).unwrap_or_else(|e| {
            panic!("{name}: {e}");
        }) else {
            continue;
        };
        let findings = judged.findings;
        assert!(findings.0.is_empty(), "{name}: {findings:#?}");
        whole += usize::from(lifted.left_out.is_empty());
        cycles += usize::from(lifted.graph().cycle_rank() > 0);
    }
    assert!(
        whole > 20 && cycles > 10,
        "{whole} whole, {cycles} with cycles"
    );
}

/// The comparison finds errors in a correct document that was changed.
#[test]
fn a_changed_document_is_found_out() {
    // In Bennett's linkage no reaction is unique; in a four-bar with a spherical joint many
    // reactions are.
    let drawings = catalogue::all();
    let named = |name: &str| {
        let found = drawings.iter().find(|(own, _)| *own == name);
        found.map(|(_, drawing)| drawing).expect(name)
    };
    let drawing = named("V3 RRRS");
    let document = answer(&text(drawing)).expect("it has an answer");
    let kinds = |document: &Value| {
        let findings = examine(drawing, document).0;
        findings.into_iter().map(|f| f.kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&document), []);
    let verdict = json!("undecided");
    for (pointer, value, kind) in [
        ("/rank", json!(16), Kind::Rank),
        ("/mobility", json!(2), Kind::Rank),
        ("/kept_rows", json!([1, 2]), Kind::Rank),
        ("/reactions/0/verdict", json!("unique"), Kind::Verdict),
        ("/reactions/0/multipliers", json!("unique"), Kind::Verdict),
        (
            "/reactions/0/components/2/verdict",
            json!("unique"),
            Kind::Verdict,
        ),
        (
            "/reactions/0/components/0/verdict",
            json!("not_unique"),
            Kind::Verdict,
        ),
        (
            "/reactions/0/row_verdicts/2/verdict",
            json!("unique"),
            Kind::Verdict,
        ),
        (
            "/reactions/3/unique_directions/0",
            json!([0.0, 0.0, 1.0]),
            Kind::Verdict,
        ),
        ("/evidence/status", verdict, Kind::Undecided),
    ] {
        let mut changed = document.clone();
        let place = changed.pointer_mut(pointer);
        *place.unwrap_or_else(|| panic!("{pointer} of {document:#}")) = value.clone();
        assert!(kinds(&changed).contains(&kind), "{pointer} = {value}");
    }
}

/// The comparison finds a violation of the conversion rule for each changed verdict. The changed
/// verdicts are on an out-of-plane component and on an in-plane component.
#[test]
fn a_changed_lift_is_found_out() {
    let text = suite::find("four-bar").map_or_else(
        || {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/four-bar.toml");
            fs::read_to_string(path).expect("text")
        },
        |case| case.scene.to_owned(),
    );
    let (lifted, judged) = lifted::examine(&text).expect("a scene").expect("lifted");
    assert!(judged.findings.0.is_empty(), "{judged:#?}");
    let [plane, space] = lifted.answers().expect("answers");
    for (pointer, value) in [
        ("/redundancy", json!(2)),
        ("/mobility", json!(3)),
        ("/reactions/0/components/0/verdict", json!("not_unique")),
        ("/reactions/0/components/2/verdict", json!("unique")),
    ] {
        let mut changed = space.clone();
        *changed.pointer_mut(pointer).expect(pointer) = value;
        let findings = lifted::compared(&lifted, &plane, &changed);
        assert!(findings.0.iter().any(|f| f.kind.is_wrong()), "{pointer}");
    }
}
