//! Tests of two wheels on one axle. On a rigid axle both contact points belong to one body: six
//! rows constrain two of its points, and five of them are independent. The remaining degree of
//! freedom is a rotation about the line through both points. So the axle rolls straight ahead and
//! cannot steer, and of two forces along this line only the sum is determined. On hubs each wheel
//! has its own spin, and the axle has three degrees of freedom: it can roll, steer, and pitch on
//! its hubs; both wheels still constrain it sideways along one line.

use std::fmt::Write;

use model::{ConstraintId, Mechanism, Registry, System};
use pfaff::{RunOptions, Study};
use solvability::{Analysis, Group, Questions, analyse};

/// Half of the track, and the radius of the wheels.
const HALF: f64 = 0.7;
const RADIUS: f64 = 0.3;

/// Components of a reaction.
const COMPONENTS: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

fn study(text: &str) -> Study {
    let registry = Registry::standard();
    let study = Study::read("axle.toml", text, &registry, &RunOptions::default());
    study.unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Returns rows, rank, redundancy and mobility.
fn ranks(mechanism: &Mechanism, analysis: &Analysis) -> [usize; 4] {
    assert!(analysis.decision.is_decided(), "{:?}", analysis.decision);
    let (rows, rank) = (mechanism.layout().rows(), analysis.decision.rank);
    assert_eq!(analysis.decision.redundancy, rows - rank);
    [rows, rank, rows - rank, analysis.mobility()]
}

/// Returns the components of a reaction that are not unique.
fn open(analysis: &Analysis, name: &str) -> Vec<&'static str> {
    let reaction = analysis.reactions.iter().find(|r| r.name == name);
    let components = &reaction.unwrap_or_else(|| panic!("no `{name}`")).components;
    let words = components
        .iter()
        .map(|c| (c.name, c.judgement.verdict.word()));
    words
        .inspect(|(_, word)| assert!(["unique", "not_unique"].contains(word), "{name}: {word}"))
        .filter(|(_, word)| *word == "not_unique")
        .map(|(name, _)| name)
        .collect()
}

/// Returns the components of the sum of two reactions that are not unique.
fn open_sum(study: &Study, analysis: Analysis, names: [&str; 2]) -> Vec<&'static str> {
    let prepared = &study.prepared;
    let groups = &prepared.mechanism.layout().groups;
    let id = |name: &str| groups.iter().position(|g| g.name == name);
    let terms = names.map(|name| (1.0, ConstraintId(id(name).expect("a joint"))));
    let questions = Questions::new(&prepared.mechanism, &prepared.q, analysis.into());
    let sum = questions.group(&Group::WrenchSum(terms.to_vec()));
    let sum = sum.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(sum.components.len(), COMPONENTS.len());
    let pairs = COMPONENTS.iter().zip(&sum.components);
    pairs
        .filter(|(_, c)| !c.judgement.verdict.is_unique())
        .map(|(name, _)| *name)
        .collect()
}

/// A rigid axle along y with wheels of these radii, horizontal or not, at (2, −1), rotated by an
/// angle about the vertical.
fn rigid(radii: [f64; 2], turn: f64) -> String {
    // The rims touch the ground at the heights h ± HALF·sin α − r·cos α = 0.
    let slope = (radii[0] - radii[1]) / (2.0 * HALF);
    let (sin, cos) = slope.atan().sin_cos();
    let height = 0.5 * (radii[0] + radii[1]) * cos;
    let (s, c) = turn.sin_cos();
    // The rotation is about x by α, then about z by the steering angle.
    let matrix = [
        [c, -s * cos, s * sin],
        [s, c * cos, -c * sin],
        [0.0, sin, cos],
    ];
    let mut text = format!(
        "scene = {{ name = \"axle\", space = \"spatial\", gravity = [0, 0, -9.81] }}\n\
         body = [{{ name = \"axle\", mass = 5, inertia = [0.8, 0.1, 0.8], position = [2, -1, {height:?}], \
         orientation = {{ matrix = {matrix:?} }} }}]\n"
    );
    for (name, y, radius) in [("left", HALF, radii[0]), ("right", -HALF, radii[1])] {
        writeln!(
            text,
            "[[joint]]\nname = \"{name}\"\ntype = \"wheel\"\nbody = \"axle\"\npoint = [0, {y:?}, 0]\n\
             axis = [0, 1, 0]\nradius = {radius:?}"
        )
        .expect("a string");
    }
    text
}

/// With the axle along y the undetermined force is Fy; otherwise both horizontal components contain
/// it.
#[test]
fn wheels_that_are_fixed_on_one_axle() {
    for radii in [[RADIUS; 2], [0.5, 0.3]] {
        for turn in [0.0, 0.4, -2.0] {
            let study = study(&rigid(radii, turn));
            let mechanism = &study.prepared.mechanism;
            let found = analyse(mechanism, 0.0, &study.prepared.q).expect("C is finite");
            let what = format!("{radii:?}, {turn}");
            assert_eq!(ranks(mechanism, &found), [6, 5, 1, 1], "{what}");
            let sideways = if turn == 0.0 {
                vec!["Fy"]
            } else {
                vec!["Fx", "Fy"]
            };
            for wheel in ["left", "right"] {
                assert_eq!(open(&found, wheel), sideways, "{what}: {wheel}");
            }
            // The rows are contact 1 and lateral 2: normal and longitudinal forces are determined.
            for reaction in &found.reactions {
                let words = reaction.rows.iter().map(|r| r.judgement.verdict.word());
                let words: Vec<_> = words.collect();
                assert_eq!(words, ["unique", "unique", "not_unique"], "{what}");
            }
            let left = open_sum(&study, found, ["left", "right"]);
            assert!(left.is_empty(), "{what}: {left:?}");
        }
    }
}

/// An axle has two wheels that turn freely; they have turned by 0.3 and −1.1, and each points
/// inwards by an angle.
fn hubs(toe: f64) -> String {
    let mut bodies = format!(
        "{{ name = \"axle\", mass = 5, inertia = [0.8, 0.1, 0.8], position = [0, 0, {RADIUS:?}] }}"
    );
    let mut joints = String::new();
    for (name, y, turn, spin) in [("left", HALF, -toe, 0.3), ("right", -HALF, toe, -1.1)] {
        let (sin, cos) = turn.sin_cos();
        let (s, c) = f64::sin_cos(spin);
        let matrix = [
            [cos * c, -sin, cos * s],
            [sin * c, cos, sin * s],
            [-s, 0.0, c],
        ];
        write!(
            bodies,
            ", {{ name = \"{name}\", mass = 1, inertia = [0.03, 0.05, 0.03], position = [0, {y:?}, {RADIUS:?}], \
             orientation = {{ matrix = {matrix:?} }} }}"
        )
        .expect("a string");
        write!(
            joints,
            "[[joint]]\nname = \"hub-{name}\"\ntype = \"revolute\"\nbodies = [\"axle\", \"{name}\"]\n\
             at = [0, {y:?}, {RADIUS:?}]\naxis = [{:?}, {cos:?}, 0]\n[[joint]]\nname = \"{name}\"\ntype = \"wheel\"\n\
             body = \"{name}\"\npoint = [0, 0, 0]\naxis = [0, 1, 0]\nradius = {RADIUS:?}\n",
            -sin
        )
        .expect("a string");
    }
    format!(
        "scene = {{ name = \"axle\", space = \"spatial\", gravity = [0, 0, -9.81] }}\nbody = [{bodies}]\n{joints}"
    )
}

/// A force along y at the left contact acts through the left hub, the axle and the right hub on the
/// right contact. About the reference point of a hub it has a moment about x.
#[test]
fn wheels_that_turn_freely_on_one_axle() {
    let study = study(&hubs(0.0));
    let mechanism = &study.prepared.mechanism;
    let found = analyse(mechanism, 0.0, &study.prepared.q).expect("C is finite");
    assert_eq!(ranks(mechanism, &found), [16, 15, 1, 3]);
    for side in ["left", "right"] {
        assert_eq!(open(&found, side), ["Fy"]);
        assert_eq!(open(&found, &format!("hub-{side}")), ["Fy", "Tx"]);
    }
    for pair in [["left", "right"], ["hub-left", "hub-right"]] {
        let again = analyse(mechanism, 0.0, &study.prepared.q).expect("C is finite");
        assert!(open_sum(&study, again, pair).is_empty(), "{pair:?}");
    }
}

/// With toe-in the two lateral directions are n = (± sin, cos). With the axle at (vx, vy), steering
/// with w and pitching with p, the wheel at ± HALF does not slip sideways if n·(vx ∓ HALF·w −
/// RADIUS·p, vy) = 0. The difference of both rows gives vx = RADIUS·p, and their sum relates vy to
/// w. So the rows are independent and all reactions are determined. The axle may steer, and roll as
/// one piece with its wheels, but not roll on its hubs.
#[test]
fn toe_in_takes_a_freedom_and_leaves_nothing_open() {
    let study = study(&hubs(0.05));
    let mechanism = &study.prepared.mechanism;
    let found = analyse(mechanism, 0.0, &study.prepared.q).expect("C is finite");
    assert_eq!(ranks(mechanism, &found), [16, 16, 0, 2]);
    for name in ["left", "right", "hub-left", "hub-right"] {
        assert!(open(&found, name).is_empty(), "{name}");
    }
}
