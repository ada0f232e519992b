//! Reactions on the first body of a joint by Newton and Euler: free-body diagrams on paper, and M·a
//! − Q of bodies with only one joint. The cases are gears with every order of bodies and carriers,
//! racks with both orders, and a joint of three bodies with forces.

use std::ops::ControlFlow;

use joints::{Gear, RackAndPinion};
use model::{BuildError, Mechanism, Reaction, System};
use pfaff::prelude::*;

/// The values below have sizes of 1 to 30 and result from one factorisation of a few rows.
const ROUNDING: f64 = 1e-11;

/// States of the motion are accurate to the tolerance of the run. The accelerations at these states
/// are accurate to all digits, and both sides use the same state.
const T_END: f64 = 0.3;

fn close(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() <= ROUNDING * expected.abs().max(1.0),
        "{what}: {found} instead of {expected}"
    );
}

fn wrench(r: &Reaction) -> [f64; 3] {
    [r.force[0], r.force[1], r.torque[2]]
}

/// A written row of a run.
struct Row {
    q: Vec<f64>,
    a: Vec<f64>,
    reactions: Vec<[f64; 3]>,
}

/// The rows of a run at its beginning and its end.
fn run(study: &Study) -> [Row; 2] {
    let mut rows = Vec::new();
    let options = MotionOptions {
        output_step: T_END,
        ..MotionOptions::to(T_END)
    };
    study
        .run(&options, |sample| {
            let (a, reactions) = (
                sample.acceleration()?,
                sample.reactions()?.as_chosen().to_vec(),
            );
            rows.push(Row {
                q: sample.q.to_vec(),
                a,
                reactions: reactions.iter().map(wrench).collect(),
            });
            Ok(ControlFlow::Continue(()))
        })
        .unwrap_or_else(|failure| panic!("{}", failure.error));
    let end = rows.pop().expect("two rows");
    [rows.swap_remove(0), end]
}

/// The reaction of a joint of a scene at rest, `[Fx, Fy, T]`.
fn at_rest(scene: &str, joint: &str) -> [f64; 3] {
    let study = Study::read(
        "scene.toml",
        scene,
        &Registry::standard(),
        &RunOptions::default(),
    )
    .unwrap_or_else(|e| panic!("{scene}: {e}"));
    let groups = &study.prepared.mechanism.layout().groups;
    let k = groups.iter().position(|g| g.name == joint).expect("exists");
    run(&study)[0].reactions[k]
}

/// Wheels a (2 kg·m²) and b (0.5 kg·m²) and an arm c (3 kg·m²) turn in bearings of the ground, with
/// a torque on each.
fn wheels(gear: &str, torques: [f64; 3]) -> String {
    let [a, b, c] = torques;
    format!(
        r#"
scene = {{ name = "wheels", space = "plane" }}
body = [
    {{ name = "a", mass = 1.0, inertia = 2.0 }},
    {{ name = "b", mass = 1.0, inertia = 0.5, position = [3.0, 1.0] }},
    {{ name = "c", mass = 1.0, inertia = 3.0, position = [0.0, 4.0] }},
]
joint = [
    {{ name = "bearing-a", type = "revolute", bodies = ["ground", "a"], at = [0.0, 0.0] }},
    {{ name = "bearing-b", type = "revolute", bodies = ["ground", "b"], at = [3.0, 1.0] }},
    {{ name = "bearing-c", type = "revolute", bodies = ["ground", "c"], at = [0.0, 4.0] }},
    {{ name = "mesh", type = "gear", {gear} }},
]
force = [
    {{ name = "on-a", type = "torque", body = "a", torque = {a} }},
    {{ name = "on-b", type = "torque", body = "b", torque = {b} }},
    {{ name = "on-c", type = "torque", body = "c", torque = {c} }},
]
"#
    )
}

/// S is the couple of the joint on its second body. Its virtual work vanishes: T·δφ_i + S·δφ_j +
/// T_c·δφ_c = 0 for δφ_j = n·δφ_i + (1 − n)·δφ_c. Therefore T = −n·S acts on the first body and T_c
/// = −(1 − n)·S on the carrier; the three couples sum to zero.
#[test]
fn gears_at_rest_by_hand() {
    let cases: [(&str, [f64; 3], f64, &str); 9] = [
        (
            r#"bodies = ["a", "b"], ratio = -2.0"#,
            [10.0, 1.0, 0.0],
            -6.0,
            "α_b = −2·α_a, (2 + 4·0.5)·α_a = 10 − 2·1: α_a = 2; T = 2·2 − 10",
        ),
        (
            r#"bodies = ["b", "a"], ratio = -0.5"#,
            [10.0, 1.0, 0.0],
            -3.0,
            "the same box: α_b = −4, T = 0.5·(−4) − 1",
        ),
        (
            r#"bodies = ["ground", "a"], ratio = -2.0"#,
            [10.0, 0.0, 0.0],
            10.0,
            "the wheel is held at the ground: −10 on it, 10 on the ground, whatever the ratio",
        ),
        (
            r#"bodies = ["a", "ground"], ratio = -2.0"#,
            [10.0, 0.0, 0.0],
            -10.0,
            "the same, reported on the wheel",
        ),
        (
            r#"bodies = ["ground", "a"], carrier = "ground", ratio = 0.25"#,
            [-8.0, 0.0, 0.0],
            -8.0,
            "8 hold the wheel, −8 on the ground",
        ),
        (
            r#"bodies = ["a", "b"], carrier = "c", ratio = -2.0"#,
            [10.0, 1.0, 5.0],
            -2.0,
            "α_b = −2·α_a + 3·α_c with 2·α_a = 10 + 2·S, 0.5·α_b = 1 + S, 3·α_c = 5 − 3·S: S = −1, T = 2·S",
        ),
        (
            r#"bodies = ["ground", "b"], carrier = "c", ratio = -2.0"#,
            [0.0, 1.0, 12.0],
            4.0,
            "α_b = 3·α_c with 0.5·α_b = 1 + S, 3·α_c = 12 − 3·S: S = 2; on the ground S·(3 − 1)",
        ),
        (
            r#"bodies = ["a", "ground"], carrier = "c", ratio = 0.25"#,
            [10.0, 0.0, 2.0],
            -2.0,
            "α_a = −3·α_c with 2·α_a = 10 + T, 3·α_c = 2 + 3·T: T = −2",
        ),
        (
            r#"bodies = ["ground", "ground"], carrier = "c", ratio = -2.0"#,
            [0.0, 0.0, 7.0],
            7.0,
            "the carrier is held: −7 on it, 7 on the ground",
        ),
    ];
    for (gear, torques, torque, why) in cases {
        let found = at_rest(&wheels(gear, torques), "mesh");
        for (found, expected) in found.iter().zip([0.0, 0.0, torque]) {
            close(*found, expected, &format!("{gear}: {why}"));
        }
    }
}

/// A moving body may occur only once: a wheel that carries its own mesh would simply be fixed to
/// the other one.
#[test]
fn a_body_is_not_its_own_carrier() {
    for gear in [
        r#"bodies = ["a", "b"], carrier = "a", ratio = -2.0"#,
        r#"bodies = ["a", "b"], carrier = "b", ratio = -2.0"#,
    ] {
        let scene = wheels(gear, [0.0; 3]);
        let read = scene::read("scene.toml", &scene, &Registry::standard());
        let faults = read.expect_err("refused");
        assert!(
            faults[0].message.contains("`mesh` connects `"),
            "{}",
            faults[0]
        );
    }
}

/// A rack of 2 kg moves in a guide along x and meshes with a pinion of 0.25 kg·m² with its centre
/// at P = (1, 2).
fn rack(joint: &str, force: f64, torque: f64) -> String {
    format!(
        r#"
scene = {{ name = "rack", space = "plane" }}
body = [
    {{ name = "rack", mass = 2.0, inertia = 1.0, position = [-1.0, 1.0] }},
    {{ name = "pinion", mass = 3.0, inertia = 0.25, position = [1.0, 2.0] }},
]
joint = [
    {{ name = "guide", type = "translational", bodies = ["ground", "rack"], at = [-1.0, 1.0], axis = [1.0, 0.0] }},
    {{ name = "bearing", type = "revolute", bodies = ["ground", "pinion"], at = [1.0, 2.0] }},
    {{ name = "mesh", type = "rack-and-pinion", at = [1.0, 2.0], axis = [1.0, 0.0], {joint} }},
]
force = [
    {{ name = "push", type = "point-force", body = "rack", point = [0.0, 0.0], force = [{force}, 0.0] }},
    {{ name = "turn", type = "torque", body = "pinion", torque = {torque} }},
]
"#
    )
}

/// The teeth exert the force R along x on the rack and −R on the pinion, both at the pitch point,
/// which is below P by the radius. Rolling requires a = r·α.
#[test]
fn racks_at_rest_by_hand() {
    let cases = [
        (
            r#"bodies = ["rack", "pinion"], radius = 0.5"#,
            [5.0, 0.5],
            [-1.0, -0.5],
            "2·a = 5 + R, 0.25·α = 0.5 − 0.5·R, α = 2·a: a = 2, R = −1; about P: 0.5·R",
        ),
        (
            r#"bodies = ["rack", "pinion"], radius = -0.5"#,
            [5.0, -0.5],
            [-1.0, 0.5],
            "the rack above: 0.25·α = −0.5 + 0.5·R, α = −2·a: a = 2, R = −1; about P: −0.5·R",
        ),
        (
            r#"bodies = ["rack", "ground"], radius = 0.5"#,
            [5.0, 0.0],
            [-5.0, -2.5],
            "the pinion is part of the ground, which holds the rack: R = −5",
        ),
        (
            r#"bodies = ["ground", "pinion"], radius = 0.5"#,
            [0.0, 0.5],
            [1.0, 0.5],
            "the rack is part of the ground, and the bearing of the pinion, too: 0.5 = 0.5·R",
        ),
    ];
    for (joint, [force, torque], [along, moment], why) in cases {
        let found = at_rest(&rack(joint, force, torque), "mesh");
        for (found, expected) in found.iter().zip([along, 0.0, moment]) {
            close(*found, expected, &format!("{joint}: {why}"));
        }
    }
}

/// A pinion (2 kg, 0.25 kg·m², r = 0.5 m) rolls along a rack of the ground. A slot keeps its centre
/// at y = 2; a force of 7 N and a torque of 0.5 N·m act on it. The equations are 2·a = 7 − R,
/// 0.25·α = 0.5 − 0.5·R, α = −2·a, so a = 2 and R = 3. On the rack the force is 3 N along the line
/// y = 1.5, and its torque about the point (1, 2) is 1.5 N·m, also after the pinion has left that
/// point.
#[test]
fn the_place_of_a_rack_stays_in_the_rack() {
    let scene = r#"
scene = { name = "rolling pinion", space = "plane" }
body = [{ name = "pinion", mass = 2.0, inertia = 0.25, position = [1.0, 2.0] }]
joint = [
    { name = "slot", type = "point-on-line", body = "pinion", at = [1.0, 2.0], line = [[0.0, 2.0], [1.0, 2.0]] },
    { name = "mesh", type = "rack-and-pinion", bodies = ["ground", "pinion"], at = [1.0, 2.0], axis = [1.0, 0.0], radius = 0.5 },
]
force = [
    { name = "pull", type = "point-force", body = "pinion", point = [0.0, 0.0], force = [7.0, 0.0] },
    { name = "turn", type = "torque", body = "pinion", torque = 0.5 },
]
"#;
    let study = Study::read(
        "scene.toml",
        scene,
        &Registry::standard(),
        &RunOptions::default(),
    )
    .unwrap_or_else(|e| panic!("{e}"));
    let rows = run(&study);
    close(rows[1].q[0], 1.0 + T_END * T_END, "the pinion has rolled");
    for row in rows {
        for (found, expected) in row.reactions[1].iter().zip([3.0, 0.0, 1.5]) {
            close(*found, expected, "on the rack");
        }
    }
}

/// Three free bodies rotate and move, with a torque on each.
fn free_bodies() -> (Description, [BodyRef; 3]) {
    let mut d = Description {
        gravity: [1.0, -3.0],
        ..Description::new("free bodies")
    };
    let bodies = [0, 1, 2].map(|k| {
        let x = f64::from(k);
        let body = d.body(Body {
            position: [2.0 * x - 1.0, 1.0 + x * x],
            angle: 0.4 + 0.7 * x,
            ..Body::new(["a", "b", "c"][k as usize], 1.0 + 0.5 * x, 0.3 + 0.4 * x)
        });
        d.force(
            ["on-a", "on-b", "on-c"][k as usize],
            &[body],
            joints::Torque {},
        )
        .functions
        .push(Function::constant(LOADS[k as usize]).expect("finite"));
        body
    });
    (d, bodies)
}

/// Torques on the free bodies (N·m).
const LOADS: [f64; 3] = [5.0, -2.0, 3.5];

/// Returns the forces on a body apart from its weight and its torque, `[Fx, Fy, T]` about a point:
/// M·a − Q, transferred to this point.
fn missing(d: &Description, row: &Row, body: usize, about: [f64; 2]) -> [f64; 3] {
    let b = &d.bodies[body];
    let (q, a) = (&row.q[3 * body..], &row.a[3 * body..]);
    let force = [0, 1].map(|k| b.mass * (a[k] - d.gravity[k]));
    let arm = [q[0] - about[0], q[1] - about[1]];
    let torque = b.inertia * a[2] - LOADS[body] + arm[0] * force[1] - arm[1] * force[0];
    [force[0], force[1], torque]
}

/// Compares the only reaction with M·a − Q of its first body. If the first body is the ground, it
/// compares the reaction with the values of all other bodies with the opposite sign.
fn compare(study: &Study, d: &Description, first: BodyRef, place: impl Fn(&Row) -> [f64; 2]) {
    for row in run(study) {
        let about = place(&row);
        let expected = match first {
            BodyRef::Body(k) => missing(d, &row, k, about),
            BodyRef::Ground => (0..d.bodies.len())
                .map(|k| missing(d, &row, k, about))
                .fold([0.0; 3], |sum, x| [0, 1, 2].map(|k| sum[k] - x[k])),
        };
        for (found, expected) in row.reactions[0].iter().zip(expected) {
            close(*found, expected, "M·a − Q");
        }
    }
}

#[test]
fn gears_in_every_order_are_what_their_first_body_misses() {
    let (_, [a, b, _]) = free_bodies();
    let choices = [BodyRef::Ground, a, b];
    let mut orders = 0;
    for first in choices {
        for second in choices {
            for carrier in choices {
                let all = [first, second, carrier];
                let twice = |body| all.iter().filter(|x| **x == body).count() > 1;
                if twice(a) || twice(b) || all == [BodyRef::Ground; 3] {
                    continue;
                }
                for ratio in [-2.0, 0.3] {
                    let (mut d, _) = free_bodies();
                    d.joint("mesh", &all, Gear::new(ratio));
                    let study = Study::build(d.clone()).unwrap_or_else(|e| panic!("{e}"));
                    compare(&study, &d, first, |_| [0.0, 0.0]);
                    orders += 1;
                }
            }
        }
    }
    assert_eq!(
        orders,
        2 * (6 + 6),
        "both wheels, or one and the ground twice"
    );
}

#[test]
fn racks_in_every_order_are_what_their_first_body_misses() {
    let (described, [a, b, _]) = free_bodies();
    for bodies in [[a, b], [b, a], [BodyRef::Ground, a], [a, BodyRef::Ground]] {
        for radius in [0.4, -1.3] {
            let (mut d, _) = free_bodies();
            let s_j = [0.3, -0.2];
            let joint = RackAndPinion::new(
                s_j,
                Direction::new([0.6, 0.8]).expect("a direction"),
                radius,
            );
            d.joint("mesh", &bodies, joint);
            let study = Study::build(d.clone()).unwrap_or_else(|e| panic!("{e}"));
            // Returns the centre of the pinion at the start, as a point fixed to the rack.
            let turn = |[x, y]: [f64; 2], angle: f64| {
                let (sin, cos) = angle.sin_cos();
                [cos * x - sin * y, sin * x + cos * y]
            };
            let start = |body: BodyRef| match body {
                BodyRef::Ground => [0.0; 3],
                BodyRef::Body(k) => {
                    let b = &described.bodies[k];
                    [b.position[0], b.position[1], b.angle]
                }
            };
            let [rack, pinion] = bodies.map(start);
            let arm = turn(s_j, pinion[2]);
            let offset = [0, 1].map(|k| pinion[k] + arm[k] - rack[k]);
            compare(&study, &d, bodies[0], |row| match bodies[0] {
                BodyRef::Ground => offset,
                BodyRef::Body(k) => {
                    let q = &row.q[3 * k..];
                    let [x, y] = turn(offset, q[2] - rack[2]);
                    [q[0] + x, q[1] + y]
                }
            });
        }
    }
}

pfaff::joint! { plane MiddleDistance(i, j, k) {
    /// Point `s_i` of body i has a constant distance from the midpoint between point `s_j` of body
    /// j and the origin of body k.
    params {
        /// Point of body i.
        s_i: Point in i,
        /// Point of body j.
        s_j: Point in j,
    }
    let d = point(i, s_i) - 0.5 * (point(j, s_j) + origin(k));
    initial { square: Length = dot(d, d) }
    rows: [distance];
    phi: dot(d, d) - square;
    place: point(i, s_i);
} }

/// If the ground is the body of several slots, the forces of all these slots are summed.
#[test]
fn a_joint_of_three_bodies_is_what_its_first_body_misses() {
    let (_, [a, b, _]) = free_bodies();
    let ground = BodyRef::Ground;
    let s_i = [0.7, -0.4];
    for bodies in [
        [a, b, ground],
        [ground, a, b],
        [ground, a, ground],
        [ground, ground, a],
        [a, ground, ground],
    ] {
        let (mut d, _) = free_bodies();
        let joint = MiddleDistance::new(s_i, [0.2, 0.9]);
        d.joint("middle", &bodies, joint);
        let study = Study::build(d.clone()).unwrap_or_else(|e| panic!("{e}"));
        compare(&study, &d, bodies[0], |row| match bodies[0] {
            BodyRef::Ground => s_i,
            BodyRef::Body(k) => {
                let q = &row.q[3 * k..];
                let (sin, cos) = q[2].sin_cos();
                [
                    q[0] + cos * s_i[0] - sin * s_i[1],
                    q[1] + sin * s_i[0] + cos * s_i[1],
                ]
            }
        });
    }
}

pfaff::joint! { plane NamedDistance(i, j, k) {
    /// The origins of bodies j and k have a constant distance along a direction of body i.
    params {
        /// Direction in body i.
        along: Direction in i,
    }
    initial { start: Length = dot(direction(i, along), origin(k) - origin(j)) }
    rows: [distance];
    phi: dot(direction(i, along), origin(k) - origin(j)) - start;
    component N: direction(i, along);
    place: origin(i);
} }

/// A named component belongs to one slot. If the first body were in two slots, the component would
/// be ambiguous.
#[test]
fn a_named_component_needs_a_first_body_of_one_slot() {
    let build = |bodies: fn([BodyRef; 3]) -> [BodyRef; 3]| {
        let (mut d, all) = free_bodies();
        let joint = NamedDistance::new(Direction::X);
        d.joint("named", &bodies(all), joint);
        Mechanism::build(&d)
    };
    assert!(build(|all| all).is_ok());
    assert!(build(|[a, _, _]| [a, BodyRef::Ground, BodyRef::Ground]).is_ok());
    let refused = build(|[a, ..]| [BodyRef::Ground, a, BodyRef::Ground]);
    let same = BuildError::SameBody {
        name: "named".into(),
        body: "ground".into(),
    };
    assert_eq!(refused.err().expect("refused"), [same]);
}
