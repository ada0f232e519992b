//! Free motions of the gallery: their number is the mobility, they are independent, they satisfy
//! the constraints by differences of Φ, and their texts were derived by hand.

use lab::fuzz::space::pose::Writing;
use linalg::{Matrix, PivotedQr};
use model::space::{cross, difference};
use model::{Mechanism, Registry, System};
use pfaff::solvability::{FreeMotions, Freedoms};
use pfaff::{RunOptions, Study};

use super::examples::{files, read, scene};

/// Half the step of a difference: its error is a few times the square of the step, and the rounding
/// error of Φ divided by the step is smaller.
const STEP: f64 = 1e-5;

/// Error bound of a difference for velocities and lengths of a few units.
const DIFFERENCE: f64 = 1e-7;

/// Error bound of a row of Ψ.
const ROUNDING: f64 = 1e-11;

/// Directions that differ by more than this value are independent.
const INDEPENDENT: f64 = 1e-3;

fn study(name: &str) -> Study {
    let text = read(&scene(name));
    let found = Study::read(name, &text, &Registry::standard(), &RunOptions::default());
    found.unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn freedoms(study: &Study) -> Freedoms {
    let start = study.analyse(0.0, None).expect("a start");
    start.freedoms().expect("its configuration").clone()
}

fn texts(motions: &FreeMotions) -> Vec<&str> {
    motions.motions.iter().map(|m| m.text.as_str()).collect()
}

/// Returns all velocities of all motions, n_v each. In space the motions describe frames in ground
/// axes, while columns of C belong to centres of mass and to rotations about the axes of the
/// bodies.
fn velocities(mechanism: &Mechanism, q: &[f64], motions: &FreeMotions) -> Vec<Vec<f64>> {
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    let of_columns = |body: usize, own: &[f64]| -> Vec<f64> {
        let [vx, vy, vz, wx, wy, wz] = *own else {
            return own.to_vec();
        };
        let omega = [wx, wy, wz];
        let to_origin = mechanism.bodies()[body].from_centre([0.0; 3]);
        let moved = cross(omega, s.bodies.turned(body, to_origin));
        let centre = difference([vx, vy, vz], moved);
        let turned = s.bodies.axes(body).map(|axis| dot(axis, omega));
        [centre, turned].concat()
    };
    let all = motions.motions.iter().flat_map(|m| &m.velocities);
    all.map(|bodies| {
        let mut v = vec![0.0; mechanism.layout().n_v];
        for (body, own) in bodies {
            v[mechanism.layout().columns(*body)].copy_from_slice(&of_columns(*body, own));
        }
        v
    })
    .collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Asserts that the rows of Φ do not change along a motion, and those of Ψ vanish on it. Drives are
/// at rest, or are omitted.
fn stays_on(mechanism: &Mechanism, q: &[f64], v: &[f64], drives: bool, name: &str) {
    let layout = mechanism.layout();
    let left_out = if drives {
        Vec::new()
    } else {
        layout.drive_rows()
    };
    let rows = (0..layout.rows()).filter(|row| !left_out.contains(row));
    let phi = |along: f64| {
        let mut s = mechanism.scratch();
        let mut moved = q.to_vec();
        let by: Vec<f64> = v.iter().map(|v| along * v).collect();
        mechanism.displace(&mut moved, &by);
        mechanism.pose(0.0, &moved, &mut s);
        mechanism.phi(&mut s);
        s.phi
    };
    let (ahead, behind) = (phi(STEP), phi(-STEP));
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, q, &mut s);
    mechanism.c(&mut s);
    for row in rows {
        let (rate, allowed) = if row < layout.m {
            ((ahead[row] - behind[row]) / (2.0 * STEP), DIFFERENCE)
        } else {
            (layout.row(&s, row).map(|(j, c)| c * v[j]).sum(), ROUNDING)
        };
        let label = &layout.labels[row];
        assert!(rate.abs() < allowed, "{name}, row {label}: {rate:e}");
    }
}

/// Asserts that the reported motions are a basis of the motions that the rows allow, with the
/// drives and without them; returns their number.
pub(super) fn are_a_basis(study: &Study, name: &str) -> usize {
    let (mechanism, q) = (&study.prepared.mechanism, &study.prepared.q);
    let found = freedoms(study);
    are_a_basis_at(mechanism, q, &found, name)
}

/// Makes the same check for known motions.
fn are_a_basis_at(mechanism: &Mechanism, q: &[f64], found: &Freedoms, name: &str) -> usize {
    let without = found.without_drives.as_ref();
    let with = Some((true, found.mobility, &found.motions));
    let without = without.map(|d| (false, d.mobility, &d.motions));
    let mut seen = 0;
    for (drives, mobility, motions) in [with, without].into_iter().flatten() {
        assert_eq!(motions.left_out, None, "{name}");
        let all = velocities(mechanism, q, motions);
        assert_eq!(all.len(), mobility, "{name}: {motions:?}");
        let n = mechanism.layout().n_v;
        let units = Matrix::from_fn(all.len(), n, |i, j| {
            let length = all[i].iter().map(|v| v * v).sum::<f64>().sqrt();
            all[i][j] / length
        });
        let smallest = PivotedQr::of_rows(units).r_diagonal().last();
        assert!(smallest.is_none_or(|p| p.abs() > INDEPENDENT), "{name}");
        for v in &all {
            stays_on(mechanism, q, v, drives, name);
            seen += 1;
        }
    }
    seen
}

#[test]
fn motions_of_the_gallery_are_a_basis_of_what_the_rows_allow() {
    let names = files(".toml");
    let all = names.iter().map(String::as_str).chain(["robot-trolley"]);
    let seen: usize = all.map(|name| are_a_basis(&study(name), name)).sum();
    assert!(seen > 25, "{seen} motions");
}

/// One joint constrains a rotated body: the rounding error of a zero in a row is not an independent
/// direction.
#[test]
fn rounding_of_a_row_is_no_direction() {
    let joints = [
        "type = \"distance\", bodies = [\"b\", \"ground\"], at = [[1.0, -2.0], [-1.5, -2.0]]",
        "type = \"revolute\", bodies = [\"b\", \"ground\"], at = [1.0, -2.0]",
        "type = \"translational\", bodies = [\"b\", \"ground\"], at = [1.0, -2.0], axis = [0.6, 0.8]",
        "type = \"point-on-line\", body = \"b\", at = [1.0, -2.0], line = [[1.0, -2.0], [1.6, -1.2]]",
    ];
    for joint in joints {
        for k in 0..40 {
            let angle = 0.1 * f64::from(k) + 0.0435;
            let text = format!(
                "scene = {{ name = \"one\", space = \"plane\" }}\n\
                 body = [{{ name = \"b\", mass = 1.0, inertia = 0.5, position = [-1.5, 1.0], angle = {angle:?} }}]\n\
                 joint = [{{ name = \"j\", {joint} }}]\n"
            );
            let study = Study::read("one", &text, &Registry::standard(), &RunOptions::default());
            let study = study.unwrap_or_else(|e| panic!("{text}\n{e}"));
            assert!(are_a_basis(&study, &text) > 0);
        }
    }
}

/// Random spatial mechanisms with planted redundancy.
#[test]
fn motions_of_random_mechanisms_satisfy_their_rows() {
    let (mut seen, mut refused) = (0, 0);
    for scene in lab::fuzz::space::scenes(11).take(240) {
        if scene.writing == Writing::Far {
            continue;
        }
        let what = format!("{}, {}", scene.number, scene.family.name());
        let (text, _) = scene.drawing.judged();
        let study = Study::read(
            "random",
            &text,
            &Registry::standard(),
            &RunOptions::default(),
        );
        // Some mechanisms are too nearly redundant to have velocities in `f64`.
        let Ok(study) = study else {
            refused += 1;
            continue;
        };
        let found = freedoms(&study);
        if found.motions.left_out.is_none() {
            let (mechanism, q) = (&study.prepared.mechanism, &study.prepared.q);
            seen += are_a_basis_at(mechanism, q, &found, &what);
        }
    }
    assert!(
        seen > 200 && refused < 5,
        "{seen} motions, {refused} refused"
    );
}

/// The slider moves the links, which rotate the knuckles of both axles; all other bodies are at
/// rest. With the drive locked the cart rolls straight ahead.
#[test]
fn the_robot_rolls_and_steers() {
    let found = freedoms(&study("robot-trolley"));
    let rolls = "`platform`, `front-knuckle`, `rear-knuckle`, `front-link`, `rear-link`, `slider` and `trolley` slide together along (1, 0)";
    assert_eq!((found.mobility, texts(&found.motions)), (1, vec![rolls]));
    let without = found.without_drives.expect("it is steered by a drive");
    let ranks = (without.ranks.rank, without.ranks.redundancy);
    assert_eq!((without.mobility, ranks), (2, (19, 2)));
    let steers = "`slider` slides along (0, 1); with it `front-knuckle`, `rear-knuckle`, `front-link` and `rear-link` turn";
    let mut all = texts(&without.motions);
    all.sort_unstable();
    assert_eq!(all, [rolls, steers]);
}

/// Rotor and axles rotate independently, each about its pivot; the board rolls along its wheels
/// together with all of them.
#[test]
fn the_snakeboard_has_a_motion_for_each_drive() {
    let found = freedoms(&study("snakeboard"));
    let rolls = "`board`, `rotor`, `front` and `rear` slide together along (1, 0)";
    assert_eq!(texts(&found.motions), [rolls]);
    let without = found.without_drives.expect("three drives");
    assert_eq!((without.drives, without.mobility), (3, 4));
    let mut all = texts(&without.motions);
    all.sort_unstable();
    let expected = [
        rolls,
        "`front` turns about `front-pivot`",
        "`rear` turns about `rear-pivot`",
        "`rotor` turns about `hip`",
    ];
    assert_eq!(all, expected);
}

/// The angular velocities of sun, carrier and planets are in the ratio 3 : 1 : −3, and the centres
/// of the planets move with the carrier.
#[test]
fn the_planetary_gear_turns_as_one() {
    let study = study("planetary-gear");
    let found = freedoms(&study);
    let words = "`sun` turns about `sun-bearing`; with it `carrier`, `planet-1`, `planet-2` and `planet-3` turn";
    assert_eq!(texts(&found.motions), [words]);
    let v = &velocities(&study.prepared.mechanism, &study.prepared.q, &found.motions)[0];
    let q = &study.prepared.q;
    let carrier = 1.0 / 3.0;
    for (body, omega) in [1.0, carrier, -1.0, -1.0, -1.0].into_iter().enumerate() {
        let [x, y] = [q[3 * body], q[3 * body + 1]];
        let derived = [-carrier * y, carrier * x, omega];
        for (found, derived) in v[3 * body..].iter().zip(derived) {
            assert!((found - derived).abs() < 1e-12, "{v:?}");
        }
    }
}

/// Two motors drive two cranks, and a third law is redundant; without the drives crank and link
/// move, one at a time while the other is at rest.
#[test]
fn redundancy_of_drives_goes_with_them() {
    let found = freedoms(&study("five-bar"));
    let without = found.without_drives.expect("drives");
    assert_eq!((without.ranks.redundancy, without.mobility), (0, 2));
}

/// A mechanism that cannot move is reported as immovable; a mechanism that is moved only by its
/// drive is not.
#[test]
fn a_truss_and_a_door_cannot_move() {
    for (name, cannot) in [("truss", true), ("door", true), ("four-bar", false)] {
        let found = freedoms(&study(name));
        assert_eq!(
            (found.mobility, found.cannot_move),
            (0, Some(cannot)),
            "{name}"
        );
    }
}
