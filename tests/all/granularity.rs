//! Tests verdicts on components in all frames, and on sums of wrenches, groups and resultants, with
//! drives, affine and rheonomic rows.

use joints::plane::{Direction, Line};
use joints::{
    Angle, Distance, Fixed, Gear, KnifeEdge, PinInSlot, PointOnLine, RackAndPinion, Revolute,
    RevoluteAngleDrive, Rolling, Translational, Velocity,
};
use model::start::{
    Coordinate, KeepLevel, Metric, assemble, consistent_velocity, nearest_configuration,
};
use model::{
    Body, BodyRef, ConfigurationAccuracy, ConstraintId, Description, Drive, Frame, Function, Joint,
    Mechanism, StartError, StartOptions, System,
};
use pfaff::{RunOptions, Study, StudyError};
use solvability::{
    Choice, Configuration, Equations, Group, GroupVerdict, LinearForm, NormWeights, RequestError,
    Term, analyse, analyse_known, judge_frames, judge_groups,
};
use tests::largest;
use tests::robot::{robot, steering};

/// Margins of unique components are rounding errors.
const ROUNDING: f64 = 1e-14;

fn body(name: &str, x: f64, y: f64, angle: f64) -> Body {
    Body {
        name: name.into(),
        mass: 2.0,
        inertia: 0.5,
        position: [x, y],
        angle,
        ..Body::default()
    }
}

fn described(bodies: Vec<Body>, joints: Vec<Joint>) -> Mechanism {
    let d = Description {
        bodies,
        joints,
        ..Description::default()
    };
    Mechanism::build(&d).expect("builds")
}

fn groups(m: &Mechanism, q: &[f64], groups: &[Group]) -> Result<Vec<GroupVerdict>, RequestError> {
    // The robot is steered at t = 1; the other mechanisms here are at rest at any time.
    let decision = analyse_known(m, 1.0, q, ConfigurationAccuracy::To(1e-12))
        .expect("C is finite")
        .whole()
        .expect("one part")
        .into_owned();
    judge_groups(m, 1.0, q, &decision, groups)
}

fn words(m: &Mechanism, q: &[f64], asked: &[Group]) -> Vec<&'static str> {
    let verdicts = groups(m, q, asked).expect("can be judged");
    verdicts
        .iter()
        .map(|v| v.judgement.verdict.word())
        .collect()
}

fn id(m: &Mechanism, name: &str) -> ConstraintId {
    let groups = &m.layout().groups;
    ConstraintId(groups.iter().position(|g| g.name == name).expect("exists"))
}

/// The robot at t = 1 with its slider displaced, on its constraints.
fn robot_steered(displacement: f64) -> (Mechanism, Vec<f64>) {
    let ramp = Function::steps(0.0, &[[0.0, 1.0, displacement]]).expect("a step");
    let mut m = Mechanism::build(&robot(ramp)).expect("builds");
    let mut q = assemble(&mut m, &StartOptions::default())
        .expect("assembles")
        .q;
    let rows: Vec<usize> = (0..m.layout().m).collect();
    for k in 1..=10 {
        q = nearest_configuration(&m, 0.1 * f64::from(k), &rows, &q, Metric::Mass).expect("near");
    }
    (m, q)
}

#[test]
fn frames_of_the_robot() {
    let (m, q) = robot_steered(0.02);
    let decision = analyse_known(&m, 1.0, &q, ConfigurationAccuracy::To(1e-12))
        .expect("C is finite")
        .whole()
        .expect("one part")
        .into_owned();
    assert_eq!((decision.rank, decision.redundancy), (20, 2));
    let frames = |name| judge_frames(&m, 1.0, &q, &decision, id(&m, name)).expect("judged");
    let w1 = frames("W1");
    let in_the_plane = [Frame::Global, Frame::FirstBody, Frame::Edge];
    assert_eq!(w1.iter().map(|f| f.frame).collect::<Vec<_>>(), in_the_plane);
    let words = |k: usize| [0, 1, 2].map(|c| w1[k].components[c].judgement.verdict.word());
    assert_eq!(words(0), ["not_unique", "not_unique", "unique"]);
    assert_eq!(words(1), ["unique", "not_unique", "unique"]);
    assert_eq!(words(2), ["not_unique", "unique", "unique"]);
    let knuckle = q[5];
    for (found, expected) in w1[2].axes[0].iter().zip([-knuckle.sin(), knuckle.cos()]) {
        assert!((found - expected).abs() < 1e-15);
    }
    // B is not reported in an edge frame, but its component along the edge of W1 is unique.
    let b = frames("B");
    assert_eq!(b.len(), 2);
    let configuration = Configuration::new(&m, 1.0, &q, &decision).expect("fits");
    let along = configuration
        .reactions()
        .force(id(&m, "B"), w1[2].axes[1])
        .expect("exists");
    let across = configuration
        .reactions()
        .force(id(&m, "B"), w1[2].axes[0])
        .expect("exists");
    let judged = |form: &LinearForm| configuration.judge(form).expect("fits");
    assert_eq!(judged(&along).verdict.word(), "unique");
    assert!(judged(&along).margin < ROUNDING);
    assert_eq!(judged(&across).verdict.word(), "not_unique");
    // The force of the drive is parallel to the axis of the slider.
    let drive = frames("steering");
    assert!(
        drive
            .iter()
            .all(|f| f.components.iter().all(|c| c.judgement.verdict.is_unique()))
    );
    assert_eq!(drive[2].frame, Frame::Edge);
}

#[test]
fn sums_of_wrenches_of_the_robot() {
    let (m, q) = robot_steered(0.02);
    let sum = |terms: &[(f64, &str)]| {
        Group::WrenchSum(terms.iter().map(|&(k, name)| (k, id(&m, name))).collect())
    };
    let asked = [
        sum(&[(1.0, "W3"), (1.0, "W4")]),
        // On the knuckle, B acts with the opposite sign.
        sum(&[(1.0, "W1"), (-1.0, "B")]),
        sum(&[(1.0, "W1"), (1.0, "B")]),
        sum(&[(2.5, "A"), (-1.0, "steering")]),
        sum(&[(1.0, "W3"), (-1.0, "W3")]),
    ];
    assert_eq!(
        words(&m, &q, &asked),
        ["not_unique", "unique", "not_unique", "unique", "unique"]
    );
    let parts = &groups(&m, &q, &asked[..1]).expect("judged")[0].components;
    // W3 and W4 are on one line across the rotated platform: the torque about W3 vanishes.
    let parts: Vec<_> = parts
        .iter()
        .map(|c| (c.name, c.judgement.verdict.word()))
        .collect();
    assert_eq!(
        parts,
        [("Fx", "not_unique"), ("Fy", "not_unique"), ("T", "unique")]
    );
    // With the edges at ±90° the circuits separate, and W3 and W4 are coupled only with each other.
    let (m, q) = robot_steered(-0.135_153_013_442_6);
    let pair = Group::WrenchSum(vec![(1.0, id(&m, "W3")), (1.0, id(&m, "W4"))]);
    let each = Group::Members(vec![id(&m, "W3"), id(&m, "W4")]);
    let joint = Group::OneJoint(vec![id(&m, "W4"), id(&m, "W3"), id(&m, "W4")]);
    assert_eq!(
        words(&m, &q, &[pair, each, joint]),
        ["unique", "not_unique", "unique"]
    );
}

/// By Newton and Euler, the resultant on any set of bodies is `M·a − Q`, in every solution.
#[test]
fn resultants_are_unique_and_are_those_of_newton_and_euler() {
    let mut d = robot(steering());
    d.gravity = [3.0, -4.0];
    let m = Mechanism::build(&d).expect("builds");
    let (q, v) = m.described_state();
    let decision = analyse(&m, 0.0, &q)
        .expect("C is finite")
        .whole()
        .expect("one part")
        .into_owned();
    let c = Configuration::new(&m, 0.0, &q, &decision).expect("fits");
    let equations = Equations::of(&m, 0.0, &q, &v).expect("fits");
    let solved = equations.multipliers(&decision).expect("solved");
    let lambda = solved.as_chosen();
    let norm = c
        .distribute(lambda, &Choice::MinimumNorm(NormWeights::NEWTON_METRE))
        .expect("a norm");
    // In straight motion the edges support the robot sideways; along x it accelerates at 3 m/s².
    let masses: Vec<f64> = d.bodies.iter().map(|b| b.mass).collect();
    for set in [
        vec![0],
        vec![6],
        vec![0, 1, 2],
        vec![1, 3],
        (0..7).collect(),
    ] {
        let forms = c
            .reactions()
            .resultant(&set, c.reactions().origin(set[0]).expect("exists"))
            .expect("exists");
        for form in &forms {
            let judgement = c.judge(form).expect("fits");
            assert!(
                judgement.verdict.is_unique() && judgement.margin < ROUNDING,
                "{judgement:?}"
            );
        }
        let [fx, fy] = [0, 1].map(|k| {
            let value = norm.value(&c, &forms[k]).expect("fits");
            value.determined().unwrap_or_else(|| panic!("{value}"))
        });
        let mass: f64 = set.iter().map(|&k| masses[k]).sum();
        assert!(
            fx.abs() < 1e-12 && (fy - 4.0 * mass).abs() < 1e-11,
            "{set:?}: {fx} {fy}"
        );
    }
    assert!(largest(lambda.iter().copied()) > 10.0);
    // Two bodies are connected only with each other, twice: no constraint acts on both together,
    // with or without rounding.
    let hinge = |name: &str| {
        let element = Revolute {
            s_i: [0.1, 0.2],
            s_j: [-0.3, 0.7],
        };
        Joint::new(name, &[BodyRef::Body(0), BodyRef::Body(1)], element)
    };
    let m = described(
        vec![body("a", 0.3, 0.1, 0.7), body("b", 0.0, 0.0, 0.0)],
        vec![hinge("once"), hinge("again")],
    );
    let mut q = m.described_state().0;
    let at = d.bodies[0].pose().to_global([0.0; 2]);
    let [x, y] = model::Body {
        position: [q[0], q[1]],
        angle: q[2],
        ..Body::default()
    }
    .pose()
    .to_global([0.1, 0.2]);
    (q[3], q[4]) = (x + 0.3 + at[0], y - 0.7 + at[1]);
    let both = Group::Resultant(vec![0, 1, 0]);
    let one = Group::Resultant(vec![1]);
    let each = Group::Members(vec![ConstraintId(0), ConstraintId(1)]);
    let as_one = Group::OneJoint(vec![ConstraintId(0), ConstraintId(1)]);
    assert_eq!(
        words(&m, &q, &[both, one, each, as_one]),
        ["unique", "unique", "not_unique", "unique"]
    );
}

/// The test computes the direction of the force of each definition only from its wrench map.
#[test]
fn edge_frames_come_from_the_definitions() {
    let (angle, axis) = (0.4_f64, Direction::new([3.0, 4.0]).expect("a direction"));
    let turned = |[x, y]: [f64; 2]| {
        [
            angle.cos() * x - angle.sin() * y,
            angle.sin() * x + angle.cos() * y,
        ]
    };
    let (along, normal) = (turned([0.6, 0.8]), turned([-0.8, 0.6]));
    let pair = [BodyRef::Body(0), BodyRef::Body(1)];
    let (s_i, s_j) = ([0.1, 0.0], [0.0, 0.2]);
    let one = [BodyRef::Body(0)];
    let line = Line::new([0.0, 0.0], [0.0, 2.0]).expect("two points");
    let origin = |k: usize| [[0.0, 0.0], [1.0, 2.0]][k];
    let cases: Vec<(Joint, Option<[f64; 2]>)> = vec![
        (
            Joint::new(
                "j",
                &one,
                KnifeEdge {
                    s: s_i,
                    normal: axis,
                },
            ),
            Some(along),
        ),
        (
            Joint::new("j", &one, PointOnLine { s: s_i, line }),
            Some([1.0, 0.0]),
        ),
        (
            Joint::new(
                "j",
                &pair,
                Rolling {
                    s: s_i,
                    direction: axis,
                    radius: 0.3,
                },
            ),
            Some(along),
        ),
        (
            Joint::new("j", &pair, PinInSlot { s_i, s_j, axis }),
            Some(normal),
        ),
        (
            Joint::new("j", &pair, Translational::new(s_i, s_j, axis)),
            Some(normal),
        ),
        (
            Joint::new("j", &pair, RackAndPinion::new(s_j, axis, 0.3)),
            Some(along),
        ),
        (
            Joint::new("j", &pair, Distance::new([0.0; 2], [0.0; 2])),
            Some([origin(1)[0] / 5_f64.sqrt(), origin(1)[1] / 5_f64.sqrt()]),
        ),
        (Joint::new("j", &pair, Revolute { s_i, s_j }), None),
        (Joint::new("j", &pair, Fixed::new(s_i, s_j)), None),
        (Joint::new("j", &pair, Angle::new()), None),
        (
            Joint::new("j", &[pair[0], pair[1], BodyRef::Ground], Gear::new(-2.0)),
            None,
        ),
    ];
    for (joint, expected) in cases {
        let name = joint.element.spec().common.name;
        let m = described(
            vec![body("a", 0.0, 0.0, angle), body("b", 1.0, 2.0, 0.0)],
            vec![joint],
        );
        let mut s = m.scratch();
        m.pose(0.0, &m.described_state().0, &mut s);
        let found = m.reactions(&s).axes(ConstraintId(0), Frame::Edge);
        match (found, expected) {
            (None, None) => {}
            // The comparison ignores the sign, which is that of the multiplier.
            (Some(axes), Some([ex, ey])) => {
                let [x, y, _] = axes[0];
                assert!((x * ey - y * ex).abs() < 1e-15, "{name}: {x} {y}");
                assert_eq!(axes[1..], [[-y, x, 0.0]]);
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}

/// Affine ψ and rheonomic Φ: rows that prescribe a motion are analysed like all others.
#[test]
fn affine_and_rheonomic_rows() {
    let speed = |name: &str, s: [f64; 2]| Joint {
        functions: vec![Function::polynomial(&[1.0, 2.0]).expect("finite")],
        ..Joint::new(
            name,
            &[BodyRef::Body(0)],
            Velocity {
                s,
                direction: Direction::X,
            },
        )
    };
    // Both rows push the same body forward along one line; a third row, parallel to it, is
    // independent.
    let joints = vec![
        speed("a", [0.0, 0.5]),
        speed("b", [2.0, 0.5]),
        speed("c", [0.0, -1.0]),
    ];
    let m = described(vec![body("cart", 0.0, 0.0, 0.0)], joints);
    let term = |k: usize, component: &str, coefficient| Term {
        reaction: ConstraintId(k),
        component: component.into(),
        coefficient,
    };
    let wrench = |terms: &[(f64, usize)]| {
        Group::WrenchSum(terms.iter().map(|&(k, i)| (k, ConstraintId(i))).collect())
    };
    let asked = [
        Group::Combination(vec![term(0, "Fx", 1.0)]),
        Group::Combination(vec![term(0, "Fx", 1.0), term(1, "Fx", 1.0)]),
        Group::Combination(vec![term(0, "Fx", 1e-200), term(1, "Fx", -1e-200)]),
        Group::Combination(vec![term(0, "Fx", 1e200), term(1, "Fx", 1e200)]),
        // The load is identically zero: perpendicular to the row, about the reference point, with a
        // coefficient of zero, or added and subtracted.
        Group::Combination(vec![
            term(0, "Fy", 1.0),
            term(1, "T", 3.0),
            term(0, "Fx", 0.0),
        ]),
        Group::Combination(vec![
            term(0, "Fx", 0.3),
            term(0, "Fx", -0.1),
            term(0, "Fx", -0.2),
        ]),
        wrench(&[(1.0, 0), (1.0, 1)]),
        wrench(&[(1.0, 0), (2.0, 1)]),
        Group::Members(vec![ConstraintId(2), ConstraintId(2)]),
    ];
    let expected = [
        "not_unique",
        "unique",
        "not_unique",
        "unique",
        "unique",
        "unique",
        "unique",
        "not_unique",
        "unique",
    ];
    assert_eq!(words(&m, &[0.0; 3], &asked), expected);

    // Two motors drive one shaft.
    let motor = |name: &str| Drive {
        tolerance: None,
        name: name.into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
        motion: Function::constant_rate(1.0).expect("finite"),
    };
    let d = Description {
        bodies: vec![body("shaft", 0.0, 0.0, 0.0)],
        drives: vec![motor("left"), motor("right")],
        ..Description::default()
    };
    let m = Mechanism::build(&d).expect("builds");
    let asked = [
        wrench(&[(1.0, 0)]),
        wrench(&[(1.0, 0), (1.0, 1)]),
        Group::Combination(vec![term(0, "drive", 1.0)]),
        Group::Combination(vec![term(0, "drive", 1.0), term(1, "drive", 1.0)]),
    ];
    assert_eq!(
        words(&m, &[0.0, 0.0, 1.0], &asked),
        ["not_unique", "unique", "not_unique", "unique"]
    );
}

#[test]
fn questions_without_an_answer_are_refused() {
    let (m, q) = robot_steered(0.02);
    let error = |group: Group| groups(&m, &q, &[group]).expect_err("refused").to_string();
    let no_joint = "there is no joint or drive 14; the mechanism has 14, counted from 0";
    let beyond = ConstraintId(14);
    let term = |reaction, component: &str, coefficient| {
        Group::Combination(vec![Term {
            reaction,
            component: component.into(),
            coefficient,
        }])
    };
    assert_eq!(error(Group::Members(vec![beyond])), no_joint);
    assert_eq!(
        error(Group::OneJoint(vec![ConstraintId(0), beyond])),
        no_joint
    );
    assert_eq!(
        error(Group::WrenchSum(vec![
            (1.0, ConstraintId(0)),
            (1.0, beyond)
        ])),
        no_joint
    );
    assert_eq!(error(Group::WrenchSum(vec![(1.0, beyond)])), no_joint);
    assert_eq!(error(term(beyond, "Fx", 1.0)), no_joint);
    assert_eq!(error(term(beyond, "N", 1.0)), no_joint);
    assert_eq!(
        error(term(id(&m, "W3"), "M", 1.0)),
        "the reaction of `W3` has no component `M`; it has `Fx`, `Fy`, `T`, `N`"
    );
    assert_eq!(
        error(term(id(&m, "W3"), "N", f64::NAN)),
        "coefficients contains NaN at 0, need finite numbers"
    );
    for empty in [
        Group::Members(vec![]),
        Group::OneJoint(vec![]),
        Group::WrenchSum(vec![]),
    ] {
        assert_eq!(error(empty), "a group needs at least one joint or drive");
    }
    assert_eq!(
        error(Group::Combination(vec![])),
        "a group needs at least one term"
    );
    assert_eq!(
        error(Group::Resultant(vec![])),
        "a group needs at least one body"
    );
    assert_eq!(
        error(Group::Resultant(vec![0, 7])),
        "there is no body 7; the mechanism has 7, counted from 0"
    );
    let decision = analyse(&m, 0.0, &q)
        .expect("C is finite")
        .whole()
        .expect("one part")
        .into_owned();
    let frames = judge_frames(&m, 0.0, &q, &decision, beyond);
    assert_eq!(frames.expect_err("refused").to_string(), no_joint);
    let wrong = [
        judge_groups(&m, 0.0, &q[1..], &decision, &[]),
        judge_groups(&m, f64::NAN, &q, &decision, &[]),
        judge_groups(
            &described(vec![body("a", 0.0, 0.0, 0.0)], vec![]),
            0.0,
            &[0.0; 3],
            &decision,
            &[],
        ),
    ];
    let texts = wrong.map(|e| e.expect_err("refused").to_string());
    assert_eq!(
        texts,
        [
            "q has 20 entries, need 21",
            "t contains NaN at 0, need finite numbers",
            "the rank decision, by rows, has 22 entries, need 0",
        ]
    );
}

#[test]
fn coordinates_to_keep_must_exist() {
    let mut m = Mechanism::build(&robot(steering())).expect("builds");
    let (q, _) = m.described_state();
    let given = m.frames().given_velocities(&q);
    for (body, dof) in [(7, 0), (0, 3), (usize::MAX, 0)] {
        let keep = |level| StartOptions {
            keep: vec![Coordinate { body, dof, level }],
            ..StartOptions::default()
        };
        let expected = StartError::NoCoordinate {
            body,
            dof,
            bodies: 7,
        };
        assert_eq!(
            assemble(&mut m, &keep(KeepLevel::Position)),
            Err(expected.clone())
        );
        let velocity = consistent_velocity(&m, &keep(KeepLevel::Velocity), &q, &given, &[0]);
        assert_eq!(velocity, Err(expected));
    }
}

/// Groups of a scene and sums from the command line, by name.
#[test]
fn groups_of_a_study() {
    let mut text = include_str!("../../crates/robot-trolley/robot-trolley.toml").to_owned();
    // Overlapping groups, one with the name of a joint.
    for (name, members) in [
        ("pair", "[\"W3\", \"W4\"]"),
        ("A", "[\"W4\"]"),
        ("driven", "[\"A\", \"steering\"]"),
    ] {
        text += &format!("\n[[group]]\nname = \"{name}\"\nmembers = {members}\n");
    }
    let registry = model::Registry::standard();
    let mut study =
        Study::read("robot", &text, &registry, &RunOptions::default()).expect("a scene");
    let combine = ["W3+W4", "W3.N + W4.N", "W3.T", "2*A - steering"].map(str::to_owned);
    let configuration = study.analyse(0.0, None).expect("judged");
    let groups = configuration.groups(&combine).expect("judged");
    let first = groups.len() - 7;
    let found: Vec<_> = groups[first..]
        .iter()
        .map(|(name, g)| (name.as_str(), g.judgement.verdict.word()))
        .collect();
    assert_eq!(
        found,
        [
            ("pair", "not_unique"),
            ("A", "not_unique"),
            ("driven", "unique"),
            ("W3+W4", "not_unique"),
            ("W3.N + W4.N", "not_unique"),
            ("W3.T", "unique"),
            ("2*A - steering", "unique"),
        ]
    );
    // A name that does not exist in the mechanism is an error and is not ignored.
    study.scene.groups[0].content = pfaff::scene::GroupContent::Members(vec!["W9".into()]);
    let configuration = study.analyse(0.0, None).expect("judged");
    let error = configuration.groups(&[]).expect_err("unknown");
    assert!(
        matches!(&error, StudyError::UnknownReaction { name, .. } if name == "W9")
            && error.is_input()
    );
}
