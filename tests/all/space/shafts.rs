//! Compares joints between shafts, read from scenes, with closed forms of their transmission.

use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions};
use joints::space3::Pose;
use model::{Registry, System};
use pfaff::{RunOptions, Study};

/// The rows of a joint are satisfied to rounding at output; the tolerance of the method is 1e-12.
const TOLERANCE: f64 = 1e-9;

fn study(scene: &str) -> Study {
    let registry = Registry::standard();
    let study = Study::read("shafts.toml", scene, &registry, &RunOptions::default());
    study.unwrap_or_else(|e| panic!("{e}"))
}

/// Returns rows, rank, redundancy and mobility.
fn judged(study: &Study) -> [usize; 4] {
    let found = study.analyse(0.0, None).expect("a start").analysis;
    let rows = found.holonomic_rows + found.nonholonomic_rows;
    let rank = found.decision.rank;
    [rows, rank, rows - rank, found.mobility()]
}

/// Returns the angular velocities of all bodies in ground axes, at eleven times.
fn turning(study: &Study, t_end: f64) -> Vec<(f64, Vec<[f64; 3]>)> {
    let options = MotionOptions {
        method: Method::Dop853,
        rtol: 1e-12,
        atol: 1e-12,
        output_step: t_end / 10.0,
        ..MotionOptions::to(t_end)
    };
    let mut rows = Vec::new();
    let run = study.run(&options, |sample| {
        let bodies = sample.q.chunks(7).zip(sample.v.chunks(6));
        let omegas = bodies.map(|(q, v)| {
            let pose = Pose::new([0.0; 3], [q[3], q[4], q[5], q[6]]);
            pose.direction_to_global([v[3], v[4], v[5]])
        });
        rows.push((sample.t, omegas.collect()));
        Ok(ControlFlow::Continue(()))
    });
    run.unwrap_or_else(|e| panic!("{}", e.error));
    assert_eq!(rows.len(), 11);
    rows
}

/// Two shafts meet at the origin under an angle, each on a hinge; the first one is driven.
fn bent(joint: &str, drive: &str) -> String {
    format!(
        "scene = {{ name = \"shafts\", space = \"spatial\" }}\n\
         body = [\n    {{ name = \"first\", mass = 1, inertia = [0.1, 0.2, 0.3], position = [-1, 0, 0] }},\n    \
         {{ name = \"second\", mass = 1, inertia = [0.1, 0.2, 0.3], position = [0.6, 0.8, 0] }},\n]\n\
         joint = [\n    {{ name = \"A\", type = \"revolute\", bodies = [\"ground\", \"first\"], at = [-1, 0, 0], axis = [1, 0, 0] }},\n    \
         {{ name = \"B\", type = \"revolute\", bodies = [\"ground\", \"second\"], at = [0.6, 0.8, 0], axis = [0.6, 0.8, 0] }},\n    \
         {{ name = \"C\", bodies = [\"first\", \"second\"], at = [0, 0, 0], {joint} }},\n]\n{drive}\n"
    )
}

/// Both shafts turn with the same rate, although they meet under 53 degrees; with a universal joint
/// the rate of the second would vary between 0.6 and 1/0.6 of that of the first. As with a
/// universal joint, three of the 14 rows are redundant.
#[test]
fn a_constant_velocity_joint_transmits_the_rate() {
    let joint =
        "type = \"constant-velocity\", axes = { first = [1, 0, 0], second = [0.6, 0.8, 0] }";
    assert_eq!(judged(&study(&bent(joint, ""))), [14, 11, 3, 1]);
    let drive = "drive = [{ name = \"motor\", joint = \"A\", type = \"angle\", \
        motion = { type = \"polynomial\", coefficients = [0.0, 3.0, 1.0] } }]";
    for (t, omegas) in turning(&study(&bent(joint, drive)), 4.0) {
        let rate = 3.0 + 2.0 * t;
        let expected = [[rate, 0.0, 0.0], [0.6 * rate, 0.8 * rate, 0.0]];
        for (found, expected) in omegas.iter().zip(expected) {
            let off = (0..3).map(|k| (found[k] - expected[k]).abs());
            assert!(
                off.fold(0.0, f64::max) < TOLERANCE * rate,
                "{t}: {omegas:?}"
            );
        }
    }
}

/// The axes are at right angles, along any axes of both bodies: the row is `ω·(a + b)` with the
/// axes a and b.
#[test]
fn axes_of_a_constant_velocity_joint_may_be_at_right_angles() {
    let units = [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
        [-1, 0, 0],
        [0, -1, 0],
        [0, 0, -1],
    ];
    let across = |a: [i32; 3], b: [i32; 3]| (0..3).all(|k| a[k] * b[k] == 0);
    for a in units {
        for b in units.into_iter().filter(|b| across(a, *b)) {
            let text = format!(
                "scene = {{ name = \"bend\", space = \"spatial\" }}\n\
                 body = [{{ name = \"b\", mass = 1, inertia = [1, 1, 1] }}]\n\
                 joint = [{{ name = \"cv\", type = \"constant-velocity\", bodies = [\"ground\", \"b\"], \
                 at = [0, 0, 0], axes = {{ ground = {a:?}, b = {b:?} }} }}]\n"
            );
            let study = study(&text);
            assert_eq!(judged(&study), [4, 4, 0, 2], "{text}");
            let mechanism = &study.prepared.mechanism;
            let mut s = mechanism.scratch();
            mechanism.pose(0.0, &study.prepared.q, &mut s);
            mechanism.c(&mut s);
            let row = mechanism.layout().dense(&s).row(3)[3..].to_vec();
            let size = row.iter().map(|c| c * c).sum::<f64>().sqrt();
            let sign = row
                .iter()
                .zip(a)
                .map(|(c, a)| c * f64::from(a))
                .sum::<f64>()
                .signum();
            for k in 0..3 {
                let sum = f64::from(a[k] + b[k]) / 2.0_f64.sqrt();
                assert!(
                    (sign * row[k] / size - sum).abs() < 1e-14,
                    "{a:?}, {b:?}: {row:?}"
                );
            }
        }
    }
}
