//! Tests the campaign `fuzz numbers`. The reference solver is compared with closed forms, planted
//! errors must be found, and a short campaign is run. `cargo run --release -p lab -- fuzz numbers`
//! examines 20 000 mechanisms.

use lab::fuzz::numbers::examine::{examine, examine_by};
use lab::fuzz::numbers::findings::{Findings, Kind};
use lab::fuzz::numbers::forms::{Form, forms};
use lab::fuzz::numbers::moves::moves;
use lab::fuzz::numbers::oracle::Instant;
use lab::fuzz::numbers::run::{Row, Run, prepared};
use lab::fuzz::numbers::sets::{elastic, without};
use lab::fuzz::numbers::tally::Tally;
use lab::fuzz::numbers::verdicts::{AtState, Judge, OnRun, Product, Word};
use pfaff::AssembledScene;
use pfaff::model::{ConstraintId, Mechanism, Registry, System};
use pfaff::solvability::{AnalysisError, Compliance, analyse};
use suite::numbers::Numbers;

/// A door of 20 kg has two hinges, 1.5 m apart. The mass centre is 0.4 m from the line of the
/// hinges.
const DOOR: &str = r#"
scene = { name = "door", space = "plane", gravity = [0.0, -10.0] }
body = [{ name = "leaf", mass = 20.0, inertia = 8.0, position = [0.4, 1.0] }]
joint = [
    { name = "lower", type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 0.25] },
    { name = "upper", type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 1.75] },
]
"#;

/// Three upright cranks. The pivot of one crank consists of two points on lines. The sideways force
/// in this pivot is determined only at the initial configuration.
const UPRIGHT: &str = r#"
scene = { name = "upright", space = "plane", gravity = [0.0, -10.0] }
body = [
    { name = "one", mass = 1.0, inertia = 0.02, position = [0.0, 0.25], angular_velocity = 2.0 },
    { name = "two", mass = 1.0, inertia = 0.02, position = [1.0, 0.25] },
    { name = "three", mass = 1.0, inertia = 0.02, position = [2.0, 0.25] },
    { name = "coupler", mass = 3.0, inertia = 1.0, position = [1.2, 0.5] },
]
joint = [
    { name = "pivot one", type = "revolute", bodies = ["ground", "one"], at = [0.0, 0.0] },
    { name = "sideways", type = "point-on-line", body = "two", at = [1.0, 0.0], line = [[1.0, -1.0], [1.0, 1.0]] },
    { name = "upwards", type = "point-on-line", body = "two", at = [1.0, 0.0], line = [[0.0, 0.0], [2.0, 0.0]] },
    { name = "pivot three", type = "revolute", bodies = ["ground", "three"], at = [2.0, 0.0] },
    { name = "tip one", type = "revolute", bodies = ["one", "coupler"], at = [0.0, 0.5] },
    { name = "tip two", type = "revolute", bodies = ["two", "coupler"], at = [1.0, 0.5] },
    { name = "tip three", type = "revolute", bodies = ["three", "coupler"], at = [2.0, 0.5] },
]
simulate = { t_end = 0.4, output_step = 0.1 }
"#;

/// Returns a mechanism on a rotating base; `bodies` and `joints` are further tables of the text.
fn on_a_base(bodies: &str, joints: &str) -> String {
    format!(
        r#"
scene = {{ name = "base", space = "plane", gravity = [0.0, -10.0] }}
body = [
    {{ name = "base", mass = 5.0, inertia = 1.0, position = [0.2, 0.0], angular_velocity = 1.0 }},
{bodies}
]
joint = [
    {{ name = "pivot", type = "revolute", bodies = ["ground", "base"], at = [0.0, 0.0] }},
{joints}
]
simulate = {{ t_end = 0.3, output_step = 0.1 }}
"#
    )
}

fn oracle(text: &str) -> (Instant, Vec<Form>, pfaff::Study) {
    let study = prepared(text, None).expect("it moves");
    let p = &study.prepared;
    let instant = Instant::new(&p.mechanism, (0.0, &p.q, &p.v)).expect("a solution");
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(0.0, &p.q, &mut s);
    p.mechanism.c(&mut s);
    let forms = forms(&p.mechanism, &s, instant.size);
    (instant, forms, study)
}

fn find<'f>(forms: &'f [Form], group: usize, name: &str) -> &'f Form {
    let mut forms = forms.iter();
    forms
        .find(|f| f.group == group && f.name == name)
        .expect("a component")
}

/// The moments about the upper hinge give 1.5·Fx = 0.4·200 N·m. The distribution of the weight is
/// not determined. Without the vertical row of one hinge, the other hinge supports the whole
/// weight; equal elastic hinges support half of it each.
#[test]
fn the_oracle_knows_a_door() {
    let (instant, forms, study) = oracle(DOOR);
    assert_eq!((instant.rank, instant.redundancy()), (3, 1));
    let value = |form: &Form, lambda| instant.scaled(form).dot(lambda);
    let fx = [0, 1].map(|k| find(&forms, k, "Fx"));
    let fy = [0, 1].map(|k| find(&forms, k, "Fy"));
    assert!(fx.iter().all(|f| instant.margin(f, &forms) < 1e-14));
    assert!(
        fy.iter()
            .all(|f| (instant.margin(f, &forms) - 0.5_f64.sqrt()).abs() < 1e-14)
    );
    let least = instant.least();
    let [a, b] = fx.map(|f| value(f, least));
    assert!(
        (a.abs() - 80.0 / 1.5).abs() < 1e-12 && (a + b).abs() < 1e-12,
        "{a} {b}"
    );
    // Row 1 (from 0) is the vertical row of the lower hinge.
    let upper = without(&instant, least, &[1]).expect("admissible");
    let [a, b] = fy.map(|f| value(f, &upper));
    assert!(
        a.abs() < 1e-12 && (b.abs() - 200.0).abs() < 1e-12,
        "{a} {b}"
    );
    assert!(
        without(&instant, least, &[0]).is_none(),
        "the other rows stop no turn"
    );
    let compliances = [1.0, 3.0].map(|x| 1e-6 * x);
    let compliances: Vec<Compliance> = compliances
        .iter()
        .enumerate()
        .map(|(k, c)| Compliance {
            reaction: ConstraintId(k),
            along: [*c; 3],
            rotation: 0.0,
        })
        .collect();
    let mechanism = &study.prepared.mechanism;
    let shared = elastic(&instant, least, (mechanism, &forms), &compliances).expect("one");
    let [a, b] = fy.map(|f| value(f, &shared).abs());
    assert!(
        (a - 150.0).abs() < 1e-9 && (b - 50.0).abs() < 1e-9,
        "{a} {b}"
    );
    assert!((instant.load - 200.0).abs() < 1e-12, "{}", instant.load);
}

/// Two collinear bars between two pins can move to first order, but they have no finite motion.
#[test]
fn an_own_step_does_not_move_what_second_order_blocks() {
    let bars = |y: f64| {
        format!(
            r#"
scene = {{ name = "bars", space = "plane" }}
body = [
    {{ name = "left", mass = 1.0, inertia = 0.1, position = [0.5, {y}] }},
    {{ name = "right", mass = 1.0, inertia = 0.1, position = [1.5, {y}] }},
]
joint = [
    {{ name = "A", type = "revolute", bodies = ["ground", "left"], at = [0.0, 0.0] }},
    {{ name = "B", type = "revolute", bodies = ["left", "right"], at = [1.0, {y}] }},
    {{ name = "C", type = "revolute", bodies = ["ground", "right"], at = [2.0, 0.0] }},
]
"#
        )
    };
    let flat = r#"
scene = { name = "flat", space = "plane" }
body = [
    { name = "one", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
    { name = "two", mass = 1.0, inertia = 0.1, position = [2.5, 0.0] },
    { name = "coupler", mass = 1.0, inertia = 0.1, position = [2.0, 0.0] },
]
joint = [
    { name = "A", type = "revolute", bodies = ["ground", "one"], at = [0.0, 0.0] },
    { name = "B", type = "revolute", bodies = ["ground", "two"], at = [2.0, 0.0] },
    { name = "C", type = "revolute", bodies = ["one", "coupler"], at = [1.0, 0.0] },
    { name = "D", type = "revolute", bodies = ["two", "coupler"], at = [3.0, 0.0] },
]
"#;
    let pendulum = on_a_base("", "");
    let cases = [
        (bars(0.0), false),
        (bars(0.5), false),
        (flat.to_owned(), true),
        (pendulum, true),
    ];
    for (text, expected) in cases {
        let read = AssembledScene::read("scene.toml", &text, &Registry::standard());
        let mut assembled = read.expect("a scene");
        let q = assembled.assemble().expect("a start").q;
        let mut numbers = Numbers::new(1);
        let moved = moves(&assembled.mechanism, (0.0, &q), &mut numbers);
        assert_eq!(moved, expected, "{text}");
    }
}

fn kinds(findings: &Findings) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = findings.all.iter().map(|f| f.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

/// The product with changed verdicts. The function `change` receives the verdict at the initial
/// state and the verdict on the run.
struct Changed<F>(F);

impl<F: Fn(bool, &mut OnRun) + Sync> Judge for Changed<F> {
    fn on_run(&self, run: &Run, forms: &[Form]) -> Result<Vec<OnRun>, AnalysisError> {
        let start = analyse(&run.study.prepared.mechanism, 0.0, &run.rows[0].q)?;
        let mut all = Product.on_run(run, forms)?;
        for (own, form) in all.iter_mut().zip(forms) {
            (self.0)(start.reactions[form.group].determines(form.name), own);
        }
        Ok(all)
    }

    fn sensitivities(&self, mechanism: &Mechanism, forms: &[Form], row: &Row) -> Option<AtState> {
        let found = Product.sensitivities(mechanism, forms, row)?;
        let each = found.each.iter().map(|s| s.map(|_| 0.0)).collect();
        Some(AtState { each, ..found })
    }
}

fn all_stretches(own: &mut OnRun, word: Word) {
    own.stretches.iter_mut().for_each(|s| s.word = word);
}

/// A source of verdicts that uses the verdict at the initial state for the whole run, as earlier
/// versions of the product.
#[test]
fn a_verdict_of_the_start_is_found_out() {
    let of_start = Changed(|is_unique: bool, own: &mut OnRun| {
        let word = if is_unique {
            Word::Unique
        } else {
            Word::NotUnique
        };
        all_stretches(own, word);
    });
    let found = examine_by(&of_start, UPRIGHT, &mut Numbers::new(5));
    assert!(kinds(&found).contains(&Kind::States), "{:?}", found.all);
    let found = examine(UPRIGHT, &mut Numbers::new(5));
    assert_eq!(kinds(&found), [], "{:?}", found.all);
}

/// Sources of verdicts that report no value as determined, every value as determined, or no value
/// as ill-determined.
#[test]
fn planted_faults_are_found() {
    let doubled = on_a_base(
        r#"    { name = "leaf", mass = 2.0, inertia = 0.1, position = [1.0, 0.3] },"#,
        r#"
    { name = "upper", type = "revolute", bodies = ["base", "leaf"], at = [0.4, 0.2] },
    { name = "lower", type = "revolute", bodies = ["base", "leaf"], at = [0.4, 0.2] },"#,
    );
    // A body on a pin and on a bar whose line passes the pin at a distance of 1 mm.
    let lever = on_a_base(
        r#"    { name = "lever", mass = 2.0, inertia = 0.1, position = [0.9, 0.0] },"#,
        r#"
    { name = "pin", type = "revolute", bodies = ["base", "lever"], at = [0.4, 0.0] },
    { name = "bar", type = "distance", bodies = ["base", "lever"], at = [[0.1, 0.001], [0.8, 0.001]] },"#,
    );
    let nothing = Changed(|_, own: &mut OnRun| all_stretches(own, Word::NotUnique));
    let found = examine_by(&nothing, &doubled, &mut Numbers::new(1));
    assert!(
        kinds(&found).contains(&Kind::Unexplained),
        "{:?}",
        found.all
    );
    let everything = Changed(|_, own: &mut OnRun| all_stretches(own, Word::Unique));
    let found = examine_by(&everything, &doubled, &mut Numbers::new(1));
    for kind in [Kind::States, Kind::Runs] {
        assert!(kinds(&found).contains(&kind), "{kind:?}: {:?}", found.all);
    }
    let sturdy = Changed(|_, _: &mut OnRun| ());
    let found = examine_by(&sturdy, &lever, &mut Numbers::new(1));
    assert!(kinds(&found).contains(&Kind::Moves), "{:?}", found.all);
    for text in [&doubled, &lever] {
        let found = examine(text, &mut Numbers::new(1));
        assert_eq!(kinds(&found), [], "{:?}", found.all);
    }
}

/// The first mechanisms of a campaign contain every submechanism on every carrier.
#[test]
fn a_short_campaign_finds_nothing() {
    let tally = Tally::of(1, 0, 30, || ());
    assert!(tally.passes(), "\n{}", tally.describe());
}

/// Mechanisms for which a campaign has found errors, with a description of each error.
#[test]
fn mechanisms_that_were_wrong_once_are_right() {
    let found = [
        (
            9673,
            "rows of output took their position from rows that were nearly dependent there",
        ),
        (
            11923,
            "a number is largest on the way to the displaced datum, not at its end",
        ),
        (
            13056,
            "a component near zero made steps over a singular pose impossible",
        ),
        (14530, "the same, just before the end of the run"),
    ];
    for (number, what) in found {
        let (_, findings) = lab::fuzz::numbers::tally::outcome(1, number);
        let wrong: Vec<&str> = findings.all.iter().map(|f| f.text.as_str()).collect();
        assert!(wrong.is_empty(), "{number}: {what}: {wrong:?}");
    }
}
