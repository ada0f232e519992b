//! Unusual input: keys that do not fit, and mechanisms at the limits of the method.

use pfaff::prelude::*;
use pfaff::solvability::RangeKind;

use super::{answers, assert_push, ends, near, study};

/// Accuracy of a range in a large or small scene, relative to the loads.
const WEIGHT: f64 = 12.0 * 9.81;

/// Returns the error of a scene.
fn refusal(text: &str) -> String {
    let options = RunOptions::default();
    match Study::read("contacts.toml", text, &Registry::standard(), &options) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(e) => format!("{} {e}", e.code()),
    }
}

/// A stone on a floor, with these keys of the floor, and more joints.
fn stone(keys: &str, more: &str) -> String {
    format!(
        "scene = {{ name = \"stone\", space = \"plane\", gravity = [0.0, -9.81] }}\n\
         body = [{{ name = \"stone\", mass = 2.0, inertia = 0.1 }}]\n\
         joint = [\n\
         {{ name = \"floor\", type = \"point-on-line\", body = \"stone\", at = [0.0, 0.0], line = [[0.0, 0.0], [0.3, 0.1]]{keys} }},\n\
         {more}]\n"
    )
}

const SIDED: &str = ", one_sided = \"pushes\", toward = [0, 1]";

fn edge(keys: &str) -> String {
    format!(
        "{{ name = \"edge\", type = \"knife-edge\", body = \"stone\", at = [0, 0], normal = [1, 0]{keys} }},\n"
    )
}

/// Every error names the joint and the key, and states what to write.
#[test]
fn impossible_keys_of_contacts_are_refused() {
    let with = |keys: &str| stone(SIDED, &edge(keys));
    let cases = [
        (
            stone(", one_sided = \"push\", toward = [0, 1]", ""),
            "P0114",
            "`one_sided` is `push`",
        ),
        (
            stone(", one_sided = true, toward = [0, 1]", ""),
            "P0105",
            "\"pushes\" or \"pulls\"",
        ),
        (
            stone(", one_sided = \"pushes\"", ""),
            "P0103",
            "`floor` needs `toward`",
        ),
        (
            stone(", toward = [0, 1]", ""),
            "P0103",
            "`toward` is the side of a one-sided joint",
        ),
        (
            stone(", one_sided = \"pushes\", toward = [0, 0]", ""),
            "P0112",
            "`toward` is zero",
        ),
        // 0.3·0.3 − 0.1·0.9 is 2.8e-17 with rounding.
        (
            stone(", one_sided = \"pushes\", toward = [0.9, 0.3]", ""),
            "P0112",
            "along the line",
        ),
        (
            stone(", one_sided = \"pushes\", toward = \"up\"", ""),
            "P0105",
            "a pair [x, y]",
        ),
        (
            stone(&format!("{SIDED}, grip = 0.3"), ""),
            "P0102",
            "no key `grip`",
        ),
        (
            stone(
                "",
                "{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"stone\"], at = [0, 0], one_sided = \"pushes\" },\n",
            ),
            "P0102",
            "`pin` has no key `one_sided`",
        ),
        (
            with(", grip = 0.3"),
            "P0156",
            "make the joint one-sided, or state `load`",
        ),
        (with(", grip = -0.3, load = 40"), "P0156", "`grip` is -0.3"),
        (with(", grip = 0.3, load = -40"), "P0156", "`load` is -40 N"),
        (
            with(", grip = 0.3, load = \"flor\""),
            "P0156",
            "no active joint `flor`",
        ),
        (
            with(", grip = 0.3, load = \"edge\""),
            "P0156",
            "add `one_sided` to it",
        ),
        (
            with(", load = \"floor\""),
            "P0103",
            "`load` presses a contact with `grip`",
        ),
        (
            stone("", &edge(", grip = 0.3, load = \"floor\"")),
            "P0156",
            "add `one_sided` to it",
        ),
        (
            stone(
                &format!("{SIDED}, active = false"),
                &edge(", grip = 0.3, load = \"floor\""),
            ),
            "P0156",
            "no active joint `floor`",
        ),
        (
            stone(
                "",
                "{ name = \"belt\", type = \"velocity\", body = \"stone\", at = [0, 0], direction = [1, 0], rate = 0.5, grip = 0.3 },\n",
            ),
            "P0102",
            "no key `grip`",
        ),
    ];
    for (text, code, words) in cases {
        let found = refusal(&text);
        assert!(
            found.contains(code) && found.contains(words),
            "{found}\n{text}"
        );
    }
    // One mistake is one error, although a `load` names the joint with the mistake.
    let text = stone(
        ", one_sided = \"push\", toward = [0, 1]",
        &edge(", grip = 0.3, load = \"floor\""),
    );
    let found = refusal(&text);
    assert!(
        !found.contains("P0156") && !found.contains("add `one_sided`"),
        "{found}"
    );
}

/// A force may be a number with a unit, an expression, or a parameter; other texts are names.
#[test]
fn a_load_is_a_force_or_a_joint() {
    for load in [
        "40",
        "\"40 N\"",
        "\"2*P\"",
        "\"P + 20 N\"",
        "\"floor\"",
        "\"0.04 kN\"",
    ] {
        let text = stone(SIDED, &edge(&format!(", grip = \"mu\", load = {load}")));
        let text = text.replace(
            "scene = {",
            "parameters = { P = \"20 N\", mu = 0.5 }\nscene = { format = 2,",
        );
        study(&text);
    }
}

/// Inactive joints have no conditions.
#[test]
fn inactive_contacts_are_read_only() {
    let text = stone(
        &format!("{SIDED}, active = false"),
        &edge(", grip = 0.3, load = 40, active = false"),
    );
    let study = study(&text);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    assert!(start.permitted(solution).expect("clear").is_none());
}

/// A table on n legs on a circle, with more keys and joints.
fn legs(n: u32, length: f64, gravity: f64, more: &str) -> String {
    let leg = |k: u32| {
        let (sin, cos) = (0.3 + std::f64::consts::TAU * f64::from(k) / f64::from(n)).sin_cos();
        format!(
            "{{ name = \"L{k}\", type = \"point-on-plane\", bodies = [\"ground\", \"top\"], at = [{:?}, {:?}, 0.0], \
             normal = [0, 0, 1], one_sided = \"pushes\" }},\n",
            length * cos,
            length * sin
        )
    };
    let joints: String = (0..n).map(leg).collect();
    format!(
        "scene = {{ name = \"table\", space = \"spatial\", gravity = [0.0, 0.0, {:?}] }}\n\
         body = [{{ name = \"top\", mass = 12.0, inertia = [{:?}, {:?}, {:?}], position = [0.0, 0.0, {:?}] }}]\n\
         joint = [\n{joints}{more}]\n",
        -gravity,
        length * length,
        length * length,
        2.0 * length * length,
        0.7 * length,
    )
}

/// Four legs in a square, the load above the middle: each leg carries up to half of the weight.
#[test]
fn huge_and_tiny_tables_have_the_same_ranges() {
    for length in [1e6, 1.0, 1e-6] {
        let found = answers(&legs(4, length, 9.81, ""), &[("L0", "Fz"), ("L3", "Fz")]);
        for range in &found.ranges {
            assert_push(range, [0.0, 0.5 * WEIGHT], WEIGHT);
        }
    }
}

/// Without gravity all pushes are zero: unique by their signs.
#[test]
fn without_loads_no_contact_presses() {
    let found = answers(&legs(5, 1.0, 0.0, ""), &[("L0", "Fz"), ("L2", "Fz")]);
    assert!(found.impossible.is_empty());
    for range in &found.ranges {
        assert_eq!(
            (range.kind, ends(range)),
            (RangeKind::Point, [Some(0.0); 2])
        );
    }
    // Upwards, nothing presses.
    let found = answers(&legs(5, 1.0, -9.81, ""), &[("L0", "Fz")]);
    assert_eq!(found.ranges[0].kind, RangeKind::Empty);
    assert_eq!(found.lifts.len(), 5);
    assert!(found.lifts.iter().all(|(_, a)| near(*a, 9.81, 9.81)));
}

/// Many legs: by symmetry, a leg carries at most half of the weight, together with the opposite
/// one.
#[test]
fn many_legs_have_ranges() {
    let found = answers(&legs(40, 1.0, 9.81, ""), &[("L7", "Fz")]);
    assert_push(&found.ranges[0], [0.0, 0.5 * WEIGHT], WEIGHT);
}

/// Legs of a table that is also clamped: the clamp may carry any load, so a leg has no upper limit,
/// and the clamp pulls the table against its legs or carries it all.
#[test]
fn legs_of_a_clamped_table_have_no_upper_limit() {
    let clamp =
        "{ name = \"clamp\", type = \"fixed\", bodies = [\"ground\", \"top\"], at = [0, 0, 0] },\n";
    let found = answers(
        &legs(4, 1.0, 9.81, clamp),
        &[("L1", "Fz"), ("clamp", "Fz"), ("clamp", "Tx")],
    );
    let [leg, force, moment] = &found.ranges[..] else {
        panic!("three ranges");
    };
    assert_eq!(
        (leg.kind, ends(leg)),
        (RangeKind::HalfLine, [None, Some(0.0)])
    );
    assert_eq!(force.kind, RangeKind::HalfLine);
    let [Some(lowest), None] = ends(force) else {
        panic!("{force:?}");
    };
    assert!(near(lowest, -WEIGHT, WEIGHT), "{force:?}");
    assert_eq!((moment.kind, ends(moment)), (RangeKind::Line, [None; 2]));
}
