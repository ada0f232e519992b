//! Armatures of joints. The references are closed forms, and the same scenes with rotors: a wheel
//! on the ground without mass, which a coupling rotates with the joint coordinate.

use std::fmt::Write;
use std::ops::ControlFlow;

use linalg::{Lu, Matrix, eigenpairs};
use model::{ConstraintId, Registry, System};
use pfaff::dynamics::linearise::LineariseOptions;
use pfaff::dynamics::{KeptRowMotion, Method, MotionOptions, Summary, simulate};
use pfaff::{RunOptions, Study};
use solvability::ChosenValues;

/// An armature: the joint, its coordinate, and the inertia.
type Armature = (&'static str, &'static str, f64);

fn study(text: &str) -> Study {
    let options = RunOptions::default();
    Study::read("scene.toml", text, &Registry::standard(), &options)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Adds armatures to a scene as keys of its joints. Each joint begins with its name.
fn with_keys(text: &str, armatures: &[Armature]) -> String {
    let mut out = text.to_owned();
    let mut names: Vec<&str> = armatures.iter().map(|(joint, ..)| *joint).collect();
    names.dedup();
    for name in names {
        let own: Vec<_> = armatures
            .iter()
            .filter(|(joint, ..)| *joint == name)
            .collect();
        let table = own.iter().map(|(_, measure, a)| format!("{measure} = {a}"));
        let table = table.collect::<Vec<_>>().join(", ");
        let several = ["cylindrical", "universal", "screw", "pin-in-slot"];
        let kind = text.split(&format!("name = \"{name}\", type = \"")).nth(1);
        let kind = kind
            .and_then(|rest| rest.split('"').next())
            .expect("a joint");
        let value = match (several.contains(&kind), &own[..]) {
            (false, [(.., a)]) => a.to_string(),
            _ => format!("{{ {table} }}"),
        };
        let key = format!("name = \"{name}\", ");
        out = out.replacen(&key, &format!("{key}armature = {value}, "), 1);
    }
    out
}

/// Adds armatures to a scene as rotors.
fn with_rotors(text: &str, armatures: &[Armature]) -> String {
    let is_plane = text.contains("\"plane\"");
    let (mut bodies, mut joints) = (String::new(), String::new());
    for (k, (joint, measure, a)) in armatures.iter().enumerate() {
        let (inertia, place) = if is_plane {
            (format!("{a}"), "at = [0.0, 0.0]")
        } else {
            let inertia = format!("[{a}, {a}, {a}]");
            (inertia, "at = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 1.0]")
        };
        let _ = writeln!(
            bodies,
            "    {{ name = \"rotor {k}\", mass = 0.0, inertia = {inertia} }},"
        );
        let _ = writeln!(
            joints,
            "    {{ name = \"bearing {k}\", type = \"revolute\", bodies = [\"ground\", \"rotor {k}\"], {place} }},
    {{ name = \"gear {k}\", type = \"coupling\", measures = [\"{joint}.{measure}\", \"bearing {k}.angle\"], ratio = 1.0 }},"
        );
    }
    let (before, own_joints) = text.split_once("]\njoint = [").expect("bodies and joints");
    let own_joints = own_joints.trim_end().strip_suffix(']').expect("joints");
    format!("{before}{bodies}]\njoint = [{own_joints}{joints}]\n")
}

/// Accelerations and multipliers at a state.
fn solved(study: &Study, t: f64, q: &[f64], v: &[f64]) -> [Vec<f64>; 2] {
    let mechanism = &study.prepared.mechanism;
    let mut motion = KeptRowMotion::new(&study.prepared).expect("a motion");
    let mut a = vec![0.0; mechanism.layout().n_v];
    let rows = mechanism.layout().rows();
    let dropped = study.prepared.decision.dropped.clone();
    let mut lambda = ChosenValues::new(vec![0.0; rows], dropped);
    motion.acceleration(t, q, v, &mut a).expect("a solution");
    motion
        .multipliers(t, q, v, &mut lambda)
        .expect("multipliers");
    let lambda = lambda.as_chosen().to_vec();
    [a, lambda]
}

/// The end of a motion: q and v, and the summary.
fn moved(study: &Study, t_end: f64, method: Method) -> (Vec<f64>, Vec<f64>, Summary) {
    let (mut q, mut v) = (Vec::new(), Vec::new());
    let options = MotionOptions {
        method,
        rtol: 1e-11,
        atol: 1e-11,
        ..MotionOptions::to(t_end)
    };
    let summary = simulate(&study.prepared, &options, |row| {
        (q, v) = (row.q.to_vec(), row.v.to_vec());
        Ok(ControlFlow::Continue(()))
    });
    let summary = summary.unwrap_or_else(|e| panic!("{e}"));
    (q, v, summary)
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let size = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    let all = found.iter().zip(expected);
    let error = all.fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()));
    assert!(
        error < tolerance * size,
        "{what}: {found:?}, expected {expected:?}"
    );
}

/// The reactions of all joints except couplings and bearings of rotors.
fn reactions(study: &Study, t: f64, q: &[f64], lambda: &[f64]) -> Vec<f64> {
    let mechanism = &study.prepared.mechanism;
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    let groups = mechanism.layout().groups.iter().enumerate();
    let own = groups.filter(|(_, g)| !g.name.starts_with("bearing") && !g.name.starts_with("gear"));
    let all = own.flat_map(|(k, _)| {
        let of = mechanism.reactions(&s).reaction(ConstraintId(k), lambda);
        of.force.into_iter().chain(of.torque).collect::<Vec<_>>()
    });
    all.collect()
}

/// All loads on each body, including the loads of armatures, sum to zero.
fn assert_balanced(study: &Study, t: f64, (q, v): (&[f64], &[f64]), (a, lambda): (&[f64], &[f64])) {
    let mechanism = &study.prepared.mechanism;
    let (mut s, mut loads) = (mechanism.scratch(), mechanism.loads());
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    loads.set(t, q, v);
    let space = mechanism.space();
    for body in 0..mechanism.bodies().len() {
        let own = loads.on_body(body).map(|(_, load)| load);
        let own = own.chain(loads.of_mass(body, a));
        let own = own.chain(loads.of_armatures(body, a).map(|(_, load)| load));
        let mut sum = vec![0.0; space.n_v()];
        let mut largest = 0.0_f64;
        for load in own {
            for (sum, x) in sum.iter_mut().zip(load.components(space)) {
                *sum += x;
                largest = largest.max(x.abs());
            }
        }
        let reactions = mechanism.reactions(&s);
        let map = reactions.body_wrench_map(body, s.bodies.origin(body));
        let map = map.expect("joints");
        for (k, sum) in sum.iter_mut().enumerate() {
            *sum += (0..lambda.len())
                .map(|i| map[(k, i)] * lambda[i])
                .sum::<f64>();
        }
        assert!(largest > 0.1, "{largest}");
        let left = sum.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(left < 1e-8 * largest, "body {body}: {sum:?}");
    }
}

/// Compares a scene with armatures and the scene with rotors during a motion.
fn compare(text: &str, armatures: &[Armature], t_end: f64) {
    let (own, other) = (with_keys(text, armatures), with_rotors(text, armatures));
    let [own, other] = [&own, &other].map(|text| study(text));
    let (of_own, of_other) = (&own.prepared.mechanism, &other.prepared.mechanism);
    let n_v = of_own.layout().n_v;
    assert!(of_own.has_armatures());
    assert_eq!(
        of_own.bodies().len() + armatures.len(),
        of_other.bodies().len()
    );
    // The unwrapped angles come last.
    let bodies = of_own.of_bodies(&own.prepared.q).len();
    for method in [Method::Dop853, Method::Radau5] {
        let (q, v, summary) = moved(&own, t_end, method);
        let (other_q, other_v, of_rotors) = moved(&other, t_end, method);
        assert_near(&q[..bodies], &other_q[..bodies], 1e-7, "q");
        assert_near(&v, &other_v[..n_v], 1e-7, "v");
        assert!(v.iter().any(|v| v.abs() > 0.1), "{v:?}");
        let energies = [&summary, &of_rotors].map(|s| s.largest_kinetic_energy);
        assert_near(&energies[..1], &energies[1..], 1e-6, "kinetic energy");
        assert!(
            summary.energy_gap < 1e-6 * energies[0],
            "{}",
            summary.energy_gap
        );
        let [a, lambda] = solved(&own, t_end, &q, &v);
        // The same state, with the rotors of the other motion.
        let (mut same_q, mut same_v) = (other_q.clone(), other_v.clone());
        same_q[..bodies].copy_from_slice(&q[..bodies]);
        same_v[..n_v].copy_from_slice(&v);
        assert_balanced(&own, t_end, (&q, &v), (&a, &lambda));
        let [b, mu] = solved(&other, t_end, &same_q, &same_v);
        assert_near(&a, &b[..n_v], 1e-6, "accelerations");
        let found = reactions(&own, t_end, &q, &lambda);
        let expected = reactions(&other, t_end, &same_q, &mu);
        assert_near(&found, &expected, 1e-6, "reactions");
    }
    // The rank of C does not change.
    let bare = study(text);
    let kept = |study: &Study| study.prepared.decision.kept.clone();
    assert_eq!(kept(&own), kept(&bare));
}

const PENDULUM: &str = "
scene = { name = \"pendulum\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [1.5, 0.0] }]
joint = [{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0] }]
";

/// A rod of m = 2, J = 0.5 and l = 1.5 from rest at the horizontal: (J + m·l² + a)·α = −m·g·l, and
/// the pin carries m·(g + l·α).
#[test]
fn a_pendulum_has_the_inertia_of_its_armature() {
    let own = study(&with_keys(PENDULUM, &[("pin", "angle", 1.25)]));
    let [a, lambda] = solved(&own, 0.0, &own.prepared.q, &[0.0; 3]);
    let alpha = -2.0 * 9.81 * 1.5 / (0.5 + 2.0 * 1.5 * 1.5 + 1.25);
    assert_near(&a, &[0.0, 1.5 * alpha, alpha], 1e-14, "accelerations");
    let found = reactions(&own, 0.0, &own.prepared.q, &lambda);
    // The reaction is the load on the first body, the ground.
    assert_near(
        &found[1..2],
        &[-2.0 * (9.81 + 1.5 * alpha)],
        1e-13,
        "force of the pin",
    );
    let v = [0.0, 1.5 * 3.0, 3.0];
    let kinetic = own.prepared.mechanism.kinetic_energy(&own.prepared.q, &v);
    let expected = 0.5 * (0.5 + 2.0 * 1.5 * 1.5 + 1.25) * 9.0;
    assert_near(&[kinetic], &[expected], 1e-14, "kinetic energy");
}

#[test]
fn an_armature_of_zero_is_no_armature() {
    let own = study(&with_keys(PENDULUM, &[("pin", "angle", 0.0)]));
    assert!(!own.prepared.mechanism.has_armatures());
    let bare = study(PENDULUM);
    let of = |study: &Study| solved(study, 0.0, &study.prepared.q, &[0.0; 3]);
    assert_eq!(of(&own), of(&bare));
}

/// M of the small motion is J + m·l² + a, and the eigenvalues are ±i·√(m·g·l/M).
#[test]
fn a_linearisation_contains_the_armature() {
    let hanging = PENDULUM.replace("[1.5, 0.0]", "[0.0, -1.5]");
    let own = study(&with_keys(&hanging, &[("pin", "angle", 1.25)]));
    let found = own
        .linearise(0.0, &LineariseOptions::default())
        .unwrap_or_else(|e| panic!("{e}"));
    let mass = 0.5 + 2.0 * 1.5 * 1.5 + 1.25;
    let second = found.second_order.expect("at rest");
    assert!(
        (second.mass[(0, 0)] - mass).abs() < 1e-13,
        "{:?}",
        second.mass
    );
    assert!((second.stiffness[(0, 0)] - 2.0 * 9.81 * 1.5).abs() < 1e-10);
    let frequency = (2.0 * 9.81 * 1.5 / mass).sqrt();
    for pair in eigenpairs(&found.a).expect("converges") {
        assert!(pair.value[0].abs() < 1e-12 && (pair.value[1].abs() - frequency).abs() < 1e-12);
    }
}

/// A wheel without mass and inertia on a pin, under a constant torque T: α = T/a.
#[test]
fn an_armature_may_be_the_only_inertia() {
    let text = "
scene = { name = \"wheel\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"wheel\", mass = 0.0, inertia = 0.0, position = [0.5, 0.0] }]
joint = [{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"wheel\"], at = [0.0, 0.0] }]
force = [{ name = \"push\", type = \"torque\", body = \"wheel\", torque = 3.0 }]
";
    let own = study(&with_keys(text, &[("pin", "angle", 0.5)]));
    let [a, _] = solved(&own, 0.0, &own.prepared.q, &[0.0; 3]);
    assert_near(&a, &[0.0, 3.0, 6.0], 1e-13, "accelerations");
    let (_, v, summary) = moved(&own, 1.0, Method::Dop853);
    assert_near(&v[2..], &[6.0], 1e-9, "angular velocity");
    assert!(summary.energy_gap < 1e-8);
}

/// The torque of a drive with s = 0.4·sin(3·t) contains a·s̈.
#[test]
fn a_drive_accelerates_the_armature() {
    let drive = "drive = [{ name = \"motor\", joint = \"pin\", type = \"angle\", motion = { type = \"harmonic\", amplitude = 0.4, omega = 3.0 } }]";
    let text = format!("{PENDULUM}{drive}");
    let torque = |study: &Study| {
        let (q, v, _) = moved(study, 0.3, Method::Dop853);
        let [a, lambda] = solved(study, 0.3, &q, &v);
        let layout = study.prepared.mechanism.layout();
        (a[2], lambda[layout.drive_rows()[0]])
    };
    let (alpha, bare) = torque(&study(&text));
    let (same, own) = torque(&study(&with_keys(&text, &[("pin", "angle", 1.25)])));
    assert!(
        (alpha - same).abs() < 1e-8 && alpha.abs() > 1.0,
        "{alpha}, {same}"
    );
    assert!(
        (own - bare + 1.25 * alpha).abs() < 1e-7,
        "{own}, {bare}, {alpha}"
    );
}

/// The rate of a drive jumps by −3 rad/s: the impulse is (J + m·l² + a)·3.
#[test]
fn an_impulse_changes_the_momentum_of_the_armature() {
    let drive = "drive = [{ name = \"motor\", joint = \"pin\", type = \"angle\", motion = { type = \"linear-table\", times = [0.0, 1.0, 3.0], values = [0.0, 2.0, 0.0] } }]";
    let text = with_keys(&format!("{PENDULUM}{drive}"), &[("pin", "angle", 1.25)]);
    let (_, v, summary) = moved(&study(&text), 1.5, Method::Dop853);
    assert_near(&v[2..], &[-1.0], 1e-9, "angular velocity");
    let [event] = &summary.events[..] else {
        panic!("one event: {:?}", summary.events);
    };
    let change = 0.5 * (0.5 + 2.0 * 1.5 * 1.5 + 1.25) * (1.0 - 4.0);
    let energy = format!("the kinetic energy by {change:.6e} J");
    assert!(event.text.contains(&energy), "{}: {}", energy, event.text);
}

/// A lever with its tip 2 m from the pin rests on a support, and a torque T lifts it: the gap
/// accelerates with 2·(T − m·g·l)/(J + m·l² + a).
#[test]
fn a_support_opens_with_the_acceleration_of_the_armature() {
    let text = PENDULUM.replacen(
        "joint = [",
        "force = [{ name = \"lift\", type = \"torque\", body = \"rod\", torque = 50.0 }]
joint = [
    { name = \"support\", type = \"point-on-line\", body = \"rod\", at = [2.0, 0.0], line = [[0.0, 0.0], [3.0, 0.0]], one_sided = \"pushes\", toward = [0.0, 1.0] },
    ",
        1,
    );
    let own = study(&with_keys(&text, &[("pin", "angle", 1.25)]));
    let q = own.prepared.q.clone();
    let found = solvability::lifted(&own.prepared.mechanism, (0.0, &q, &[0.0; 3]));
    let found = found.expect("clear");
    let alpha = (50.0 - 2.0 * 9.81 * 1.5) / (0.5 + 2.0 * 1.5 * 1.5 + 1.25);
    let [(_, gap)] = found.joints[..] else {
        panic!("one joint opens: {found:?}");
    };
    assert_near(&[gap], &[2.0 * alpha], 1e-12, "gap");
    assert_near(
        &found.accelerations,
        &[0.0, 1.5 * alpha, alpha],
        1e-12,
        "accelerations",
    );
}

#[test]
fn rotors_in_the_plane_have_the_same_motion() {
    let four_bar = "
scene = { name = \"four-bar\", space = \"plane\", gravity = [0.0, -9.81] }
body = [
    { name = \"crank\", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
    { name = \"coupler\", mass = 2.0, inertia = 0.4, position = [1.8, 0.6] },
    { name = \"rocker\", mass = 1.5, inertia = 0.3, position = [2.8, 0.6] },
]
joint = [
    { name = \"A\", type = \"revolute\", bodies = [\"ground\", \"crank\"], at = [0.0, 0.0] },
    { name = \"B\", type = \"revolute\", bodies = [\"crank\", \"coupler\"], at = [1.0, 0.0] },
    { name = \"C\", type = \"revolute\", bodies = [\"coupler\", \"rocker\"], at = [2.6, 1.2] },
    { name = \"D\", type = \"revolute\", bodies = [\"rocker\", \"ground\"], at = [3.0, 0.0] },
]
";
    compare(four_bar, &[("A", "angle", 0.7), ("C", "angle", 2.5)], 0.6);
    let slides = "
scene = { name = \"slides\", space = \"plane\", gravity = [0.0, -9.81] }
body = [
    { name = \"arm\", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] },
    { name = \"block\", mass = 2.0, inertia = 0.4, position = [1.2, 0.3] },
    { name = \"slider\", mass = 1.5, inertia = 0.3, position = [2.0, 0.5] },
]
joint = [
    { name = \"A\", type = \"revolute\", bodies = [\"ground\", \"arm\"], at = [0.0, 0.0] },
    { name = \"S\", type = \"translational\", bodies = [\"arm\", \"block\"], at = [1.2, 0.3], axis = [0.6, 0.8] },
    { name = \"P\", type = \"pin-in-slot\", bodies = [\"block\", \"slider\"], at = [2.0, 0.5], axis = [1.0, 0.2] },
]
";
    let all = [
        ("A", "angle", 0.7),
        ("S", "displacement", 3.0),
        ("P", "displacement", 1.1),
        ("P", "angle", 0.4),
    ];
    compare(slides, &all, 0.4);
}

#[test]
fn rotors_in_space_have_the_same_motion() {
    let chain = "
scene = { name = \"chain\", space = \"spatial\", gravity = [1.0, 2.0, -9.81] }
body = [
    { name = \"one\", mass = 1.0, inertia = [0.1, 0.2, 0.25], position = [0.5, 0.0, 0.0] },
    { name = \"two\", mass = 2.0, inertia = [[0.3, 0.05, 0.0], [0.05, 0.4, 0.02], [0.0, 0.02, 0.5]], position = [1.0, 0.5, 0.2], orientation = { axis = [0.0, 0.6, 0.8], angle = 0.4 } },
    { name = \"three\", mass = 1.5, inertia = [0.2, 0.3, 0.4], position = [1.5, 1.0, 0.0] },
]
joint = [
    { name = \"A\", type = \"revolute\", bodies = [\"ground\", \"one\"], at = [0.0, 0.0, 0.0], axis = [0.0, 0.6, 0.8], frame = \"global\" },
    { name = \"B\", type = \"KIND\", bodies = [\"one\", \"two\"], at = [1.0, 0.0, 0.1], MORE },
    { name = \"C\", type = \"revolute\", bodies = [\"two\", \"three\"], at = [1.0, 1.0, 0.0], axis = [1.0, 0.2, 0.0], frame = \"global\" },
]
";
    let axis = "axis = [0.3, 0.2, 0.8], frame = \"global\"";
    let cross = "axis = [1.0, 0.0, 0.0], cross = [0.0, 1.0, 0.5], frame = \"global\"";
    let screw = "axis = [0.3, 0.2, 0.8], frame = \"global\", pitch = 0.2";
    for (kind, more, measures) in [
        ("revolute", axis, &["angle"][..]),
        ("translational", axis, &["displacement"]),
        ("cylindrical", axis, &["angle", "displacement"]),
        ("universal", cross, &["first", "second"]),
        ("screw", screw, &["angle", "displacement"]),
    ] {
        let text = chain.replace("KIND", kind).replace("MORE", more);
        let mut armatures = vec![("A", "angle", 0.3), ("C", "angle", 0.8)];
        armatures.extend(measures.iter().zip([0.9, 2.2]).map(|(m, a)| ("B", *m, a)));
        armatures.sort_by_key(|(joint, ..)| *joint);
        compare(&text, &armatures, 0.4);
    }
}

/// A long chain of rods with a motor in each pin, which is solved through the Schur complement. The
/// reference is a dense solution of the equations with the accelerations of the motors as unknowns.
#[test]
fn many_armatures_are_solved_through_the_schur_complement() {
    let n = 60;
    let mut text =
        "[scene]\nname = \"chain\"\nspace = \"plane\"\ngravity = [0.0, -9.81]\n".to_owned();
    for k in 0..n {
        let before = match k {
            0 => "ground".to_owned(),
            k => format!("rod {}", k - 1),
        };
        let _ = write!(
            text,
            "[[body]]\nname = \"rod {k}\"\nmass = 1.0\ninertia = 0.1\nposition = [{}, {}]\n\
             [[joint]]\nname = \"pin {k}\"\ntype = \"revolute\"\nbodies = [\"{before}\", \"rod {k}\"]\n\
             at = [{k}, 0.0]\narmature = {}\n",
            0.5 + f64::from(k),
            0.3 * f64::from(k % 3),
            0.05 + 0.5 * f64::from(k % 4)
        );
    }
    let own = study(&text);
    let mechanism = &own.prepared.mechanism;
    let layout = mechanism.layout();
    let (n_v, rows) = (layout.n_v, layout.rows());
    let v: Vec<f64> = vec![0.0; n_v];
    let [a, lambda] = solved(&own, 0.0, &own.prepared.q, &v);
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &own.prepared.q, &mut s);
    mechanism.c(&mut s);
    mechanism.twist(&v, &mut s);
    mechanism.gamma(&mut s);
    mechanism.force(&mut s);
    let mut matrix = Matrix::zeros(n_v + rows, n_v + rows);
    for j in 0..n_v {
        matrix[(j, j)] = mechanism.mass()[j];
    }
    for k in 0..n as usize {
        // The rate of the pin is the difference of the angular velocities.
        let inertia = 0.05 + 0.5 * (k % 4) as f64;
        let own = [(3 * k + 2, 1.0)];
        let before = k.checked_sub(1).map(|k| (3 * k + 2, -1.0));
        let row: Vec<(usize, f64)> = own.into_iter().chain(before).collect();
        for (i, x) in &row {
            for (j, y) in &row {
                matrix[(*i, *j)] += inertia * x * y;
            }
        }
    }
    for i in 0..rows {
        for (j, c) in layout.row(&s, i) {
            matrix[(n_v + i, j)] += c;
            matrix[(j, n_v + i)] += c;
        }
    }
    let mut lu = Lu::new(n_v + rows);
    lu.factor(|i, j| matrix[(i, j)]).expect("regular");
    let mut x = [&s.force[..], &s.gamma[..]].concat();
    lu.solve(&mut x);
    assert_near(&a, &x[..n_v], 1e-9, "accelerations");
    assert_near(&lambda, &x[n_v..], 1e-9, "multipliers");
}
