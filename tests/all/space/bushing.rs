//! Compares bushings in space with closed forms, with the energy of their springs, and with the
//! plane, for small and large motions of bodies on them.

use std::ops::ControlFlow;

use dynamics::linearise::LineariseOptions;
use dynamics::{Method, MotionOptions};
use joints::space3::{Pose, dot};
use linalg::eigenpairs;
use model::Registry;
use pfaff::{RunOptions, Study};

fn study(text: &str) -> Study {
    let study = Study::read(
        "bushing.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    study.unwrap_or_else(|e| panic!("{text}\n{e}"))
}

fn options(t_end: f64, rows: f64) -> MotionOptions {
    MotionOptions {
        rtol: 1e-12,
        atol: 1e-12,
        method: Method::Dop853,
        output_step: t_end / rows,
        ..MotionOptions::to(t_end)
    }
}

/// Returns times and states of all rows.
fn rows(text: &str, t_end: f64) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut rows = Vec::new();
    let run = study(text).run(&options(t_end, 200.0), |sample| {
        rows.push((sample.q.to_vec(), sample.v.to_vec()));
        Ok(ControlFlow::Continue(()))
    });
    run.unwrap_or_else(|e| panic!("{}", e.error));
    assert_eq!(rows.len(), 201);
    rows
}

/// A body is at (1, 2, 3) on a bushing of the ground, with additional keys of both.
fn mounted(body: &str, bushing: &str, more: &str) -> String {
    format!(
        r#"
[scene]
name = "mounted"
space = "spatial"
[[body]]
name = "engine"
mass = 4.0
inertia = [0.1, 0.12, 0.14]
position = [1, 2, 3]
{body}
[[force]]
name = "mount"
type = "bushing"
bodies = ["ground", "engine"]
{bushing}
{more}
"#
    )
}

/// Returns the frequencies, ascending (rad/s); the others of each pair are their negatives.
fn frequencies(text: &str) -> Vec<f64> {
    let found = study(text).linearise(0.0, &LineariseOptions::default());
    let found = found.unwrap_or_else(|e| panic!("{e}"));
    let pairs = eigenpairs(&found.a).expect("converges");
    let values = pairs.into_iter().map(|pair| pair.value);
    let mut frequencies: Vec<f64> = values
        .map(|[_, frequency]| frequency)
        .filter(|f| *f > 0.0)
        .collect();
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

#[track_caller]
fn close(found: &[f64], expected: &[f64], bound: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= bound, "{found:?} {expected:?}");
    }
}

/// With the bushing at the mass centre, every degree of freedom oscillates independently, √(k/m)
/// and √(k/J). With the bushing below it, at (0, 0, −0.5), translation along x is coupled with
/// rotation about y: x_place = x − 0.5·θ_y.
#[test]
fn small_motions_have_the_frequencies_of_springs() {
    let bushing = |at: &str| {
        let numbers = "stiffness = [100, 200, 300, 4, 5, 6]\ndamping = [0, 0, 0, 0, 0, 0]";
        mounted("", &format!("at = {at}\n{numbers}"), "")
    };
    let mut expected = [25.0, 50.0, 75.0, 4.0 / 0.1, 5.0 / 0.12, 6.0 / 0.14].map(f64::sqrt);
    expected.sort_by(f64::total_cmp);
    close(&frequencies(&bushing("[1, 2, 3]")), &expected, 1e-6);
    // Each pair satisfies λ² − (k/m + (c + k·s²)/J)·λ + k·c/(m·J) = 0.
    let pair = |k: f64, c: f64, j: f64| {
        let (sum, product) = (k / 4.0 + (c + 0.25 * k) / j, k * c / (4.0 * j));
        let root = (0.25 * sum * sum - product).sqrt();
        [0.5 * sum - root, 0.5 * sum + root].map(f64::sqrt)
    };
    let mut expected = [pair(100.0, 5.0, 0.12), pair(200.0, 4.0, 0.1)].concat();
    expected.extend([75.0_f64.sqrt(), (6.0_f64 / 0.14).sqrt()]);
    expected.sort_by(f64::total_cmp);
    close(&frequencies(&bushing("[1, 2, 2.5]")), &expected, 1e-6);
}

/// Returns the rotation vector of a unit quaternion, from its half angle.
fn rotation_vector([w, x, y, z]: [f64; 4]) -> [f64; 3] {
    let sine = (x * x + y * y + z * z).sqrt();
    let twice = if sine == 0.0 {
        0.0
    } else {
        2.0 * sine.atan2(w.abs()) / sine
    };
    [x, y, z].map(|e| twice * e * w.signum())
}

fn quaternion(q: &[f64]) -> [f64; 4] {
    let square: f64 = q[3..7].iter().map(|e| e * e).sum();
    [3, 4, 5, 6].map(|k| q[k] / square.sqrt())
}

/// Returns the product ē∘f.
fn against([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [
        a * w + b * x + c * y + d * z,
        a * x - b * w - c * z + d * y,
        a * y + b * z - c * w - d * x,
        a * z - b * y + c * x - d * w,
    ]
}

/// Two free bodies tumble on each other. Kinetic energy and ½·Σ k·d² + ½·Σ k·θ² add up to a
/// constant, with relative rotations of 2 rad, and their momenta are constant.
#[test]
fn springs_give_back_what_they_take() {
    let text = mounted(
        "angular_velocity = [9.1, 5.2, -7.15]\nvelocity = [0.3, -0.2, 0.5]",
        "at = [1, 2, 3.2]\nstiffness = [100, 200, 300, 2, 3, 4]\ndamping = [0, 0, 0, 0, 0, 0]",
        "[[body]]\nname = \"frame\"\nmass = 10.0\ninertia = [1.0, 1.5, 2.0]\nposition = [1, 2, 3.5]\nangular_velocity = [0.1, -0.2, 0.3]",
    )
    .replace("\"ground\", \"engine\"", "\"frame\", \"engine\"");
    let masses = [(4.0, [0.1, 0.12, 0.14]), (10.0, [1.0, 1.5, 2.0])];
    let (mut least, mut most, mut largest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    let mut momenta: Vec<[f64; 6]> = Vec::new();
    for (q, v) in rows(&text, 10.0) {
        let mut energy = 0.0;
        let mut momentum = [0.0; 6];
        for (body, (mass, inertia)) in masses.iter().enumerate() {
            let (q, v) = (&q[7 * body..], &v[6 * body..]);
            let spin = [0, 1, 2].map(|k| inertia[k] * v[3 + k]);
            let push = [0, 1, 2].map(|k| mass * v[k]);
            energy += 0.5 * (dot(push, [v[0], v[1], v[2]]) + dot(spin, [v[3], v[4], v[5]]));
            let pose = Pose::new([q[0], q[1], q[2]], quaternion(q));
            let turning = pose.direction_to_global(spin);
            let about = joints::space3::cross(pose.r, push);
            for k in 0..3 {
                momentum[k] += push[k];
                momentum[3 + k] += turning[k] + about[k];
            }
        }
        let pose = |body: usize| {
            let q = &q[7 * body..];
            Pose::new([q[0], q[1], q[2]], quaternion(q))
        };
        let (engine, frame) = (pose(0), pose(1));
        let [of_engine, of_frame] = [
            engine.to_global([0.0, 0.0, 0.2]),
            frame.to_global([0.0, 0.0, -0.3]),
        ];
        let apart = frame.direction_to_local([0, 1, 2].map(|k| of_engine[k] - of_frame[k]));
        let turned = rotation_vector(against(quaternion(&q[7..]), quaternion(&q)));
        for (k, stiffness) in [100.0, 200.0, 300.0].into_iter().enumerate() {
            energy += 0.5 * stiffness * apart[k] * apart[k];
        }
        for (k, stiffness) in [2.0, 3.0, 4.0].into_iter().enumerate() {
            energy += 0.5 * stiffness * turned[k] * turned[k];
        }
        (least, most) = (least.min(energy), most.max(energy));
        largest = largest.max(dot(turned, turned).sqrt());
        momenta.push(momentum);
    }
    assert!((2.0..3.0).contains(&largest), "{largest}");
    assert!(most - least < 1e-9 * most, "{least} {most}");
    for momentum in &momenta {
        close(momentum, &momenta[0], 1e-9);
    }
}

/// A force and a torque along (2, 1, 2)/3 act at the mass centre, on equal springs: displacement
/// and angle are load over stiffness.
#[test]
fn a_body_comes_to_rest_where_springs_carry_the_load() {
    let text = mounted(
        "",
        "at = [1, 2, 3]\nstiffness = [100, 200, 400, 5, 5, 5]\ndamping = [20, 28, 40, 1, 1, 1]",
        "[[force]]\nname = \"push\"\ntype = \"point-force\"\nbody = \"engine\"\nat = [1, 2, 3]\nforce = [10, 20, -10]\n\
         [[force]]\nname = \"turn\"\ntype = \"torque\"\nbody = \"engine\"\ntorque = [4, 2, 4]\n",
    );
    let rows = rows(&text, 60.0);
    let (q, v) = rows.last().expect("rows");
    close(&q[..3], &[1.1, 2.1, 2.975], 1e-9);
    let turned = rotation_vector(quaternion(q));
    close(&turned, &[0.8, 0.4, 0.8], 1e-9);
    assert!(v.iter().all(|v| v.abs() < 1e-9), "{v:?}");
}

/// A motion in the plane equals that of the planar bushing.
#[test]
fn in_the_plane_it_is_the_bushing_of_the_plane() {
    let scene = |space: &str,
                 three: &dyn Fn([f64; 2]) -> String,
                 inertia: &str,
                 spin: &dyn Fn(f64) -> String,
                 more: &str| {
        format!(
            "scene = {{ name = \"pair\", space = \"{space}\" }}\nbody = [\n\
             {{ name = \"a\", mass = 2.0, inertia = {inertia}, position = {}, velocity = {}, angular_velocity = {} }},\n\
             {{ name = \"b\", mass = 1.0, inertia = {inertia}, position = {}, velocity = {}, angular_velocity = {} }},\n]\n\
             force = [{{ name = \"f\", type = \"bushing\", bodies = [\"a\", \"b\"], at = {}, {more} }}]\n",
            three([0.0, 0.0]),
            three([0.1, 0.0]),
            spin(0.4),
            three([1.0, 0.2]),
            three([0.0, 0.6]),
            spin(-5.0),
            three([0.7, 0.1]),
        )
    };
    let plane = scene(
        "plane",
        &|[x, y]| format!("[{x}, {y}]"),
        "0.3",
        &|w| w.to_string(),
        "stiffness = [40, 60, 5], damping = [0.5, 0.6, 0.05]",
    );
    let space = scene(
        "spatial",
        &|[x, y]| format!("[{x}, {y}, 0]"),
        "[0.2, 0.2, 0.3]",
        &|w| format!("[0, 0, {w}]"),
        "stiffness = [40, 60, 7, 8, 9, 5], damping = [0.5, 0.6, 0.7, 0.8, 0.9, 0.05]",
    );
    let mut largest = 0.0_f64;
    for ((q, v), (in_plane, of_plane)) in rows(&space, 4.0).iter().zip(rows(&plane, 4.0)) {
        for body in 0..2 {
            let (q, v) = (&q[7 * body..], &v[6 * body..]);
            let (p, w) = (&in_plane[3 * body..], &of_plane[3 * body..]);
            close(&q[..3], &[p[0], p[1], 0.0], 1e-8);
            close(&[v[0], v[1], v[5]], &w[..3], 1e-8);
            let half = 0.5 * p[2];
            close(&[q[6] * half.cos() - q[3] * half.sin()], &[0.0], 1e-8);
        }
        largest = largest.max((in_plane[5] - in_plane[2]).abs());
    }
    assert!((1.0..3.0).contains(&largest), "{largest}");
}

/// A rotation by half a turn has no unique rotation vector. A run stops before it with an error,
/// and does not stop at the other sign.
#[test]
fn a_bushing_is_refused_at_half_a_turn() {
    let bushing =
        "at = [1, 2, 3]\nstiffness = [100, 200, 300, 0.1, 0.1, 0.1]\ndamping = [0, 0, 0, 0, 0, 0]";
    for omega in ["[0, 0, 9]", "[3, 4, 5]", "[0, -20, 0]"] {
        let text = mounted(&format!("angular_velocity = {omega}"), bushing, "");
        let mut largest = 0.0_f64;
        let run = study(&text).run(&options(5.0, 1000.0), |sample| {
            let turned = rotation_vector(quaternion(sample.q));
            largest = largest.max(dot(turned, turned).sqrt());
            Ok(ControlFlow::Continue(()))
        });
        let error = run.map(|_| ()).expect_err("half a turn").error.to_string();
        assert!(
            error.contains("`mount`") && error.contains("not finite"),
            "{error}"
        );
        assert!((2.0..=3.0).contains(&largest), "{largest}: {error}");
    }
}
