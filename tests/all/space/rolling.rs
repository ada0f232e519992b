//! Wheels with a tube and balls, read from scenes, roll according to Newton's and Euler's
//! equations.

use std::ops::ControlFlow;

use dynamics::{Method, MotionOptions};
use joints::space3::{Axes, Pose};
use model::{Reaction, Registry};
use pfaff::{RunOptions, Study};

/// The motions below are smooth, and rows are satisfied to rounding at output; the tolerance of the
/// method is 1e-12.
const TOLERANCE: f64 = 1e-9;

const GRAVITY: f64 = 9.81;

/// A row of a motion of one body on one joint.
struct Row {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    reaction: Reaction,
}

fn moved(scene: &str, t_end: f64) -> Vec<Row> {
    let registry = Registry::standard();
    let study = Study::read("wheel.toml", scene, &registry, &RunOptions::default());
    let study = study.unwrap_or_else(|e| panic!("{e}"));
    let options = MotionOptions {
        method: Method::Dop853,
        rtol: 1e-12,
        atol: 1e-12,
        output_step: t_end / 10.0,
        ..MotionOptions::to(t_end)
    };
    let mut rows = Vec::new();
    let run = study.run(&options, |sample| {
        let [reaction] = sample.reactions()?.as_chosen()[..] else {
            panic!("one joint");
        };
        rows.push(Row {
            t: sample.t,
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
            reaction,
        });
        Ok(ControlFlow::Continue(()))
    });
    run.unwrap_or_else(|e| panic!("{}", e.error));
    assert_eq!(rows.len(), 11);
    rows
}

fn close(found: &[f64], expected: &[f64], what: &str) {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() < TOLERANCE * b.abs().max(1.0);
    assert!(
        found.iter().zip(expected).all(near),
        "{what}: {found:?}, expected {expected:?}"
    );
}

/// An upright torus starts from rest down a slope: v = ω·(radius + tube), and its acceleration is
/// g·sin α/(1 + J/(m·(radius + tube)²)). Normal force and friction act at the contact.
#[test]
fn a_torus_rolls_down_a_slope() {
    rolls_down("[0.3, 0.5, 0.3]");
    // The wheel has spokes: its principal axes across the axle are not those of its frame.
    rolls_down("[[0.3, 0, 0.1], [0, 0.5, 0], [0.1, 0, 0.3]]");
}

fn rolls_down(tensor: &str) {
    let (mass, moment, radius, tube, slope) = (3.0, 0.5, 0.4, 0.1, 0.3_f64);
    let (sin, cos) = slope.sin_cos();
    let (normal, down) = ([sin, 0.0, cos], [cos, 0.0, -sin]);
    let reach = radius + tube;
    let scene = format!(
        "scene = {{ name = \"slope\", space = \"spatial\", gravity = [0, 0, -{GRAVITY}] }}\n\
         body = [{{ name = \"tyre\", mass = {mass}, inertia = {tensor}, position = [{}, 0, {}] }}]\n\
         joint = [{{ name = \"tread\", type = \"wheel\", body = \"tyre\", point = [0, 0, 0], axis = [0, 1, 0], \
         radius = {radius}, tube = {tube}, plane = {{ point = [0, 0, 0], normal = [{sin}, 0, {cos}] }} }}]\n",
        reach * sin,
        reach * cos,
    );
    let along = GRAVITY * sin / (1.0 + moment / (mass * reach * reach));
    for row in moved(&scene, 1.0) {
        let (speed, way) = (along * row.t, 0.5 * along * row.t * row.t);
        let place = [0, 1, 2].map(|k| reach * normal[k] + way * down[k]);
        close(&row.q[..3], &place, "place");
        close(&row.v[..3], &down.map(|x| speed * x), "velocity");
        // The rotation is about the axle, for any order of the principal axes.
        let turning: f64 = row.v[3..].iter().map(|w| w * w).sum();
        close(&[turning.sqrt()], &[speed / reach], "turning");
        let [pressure, friction] = [mass * GRAVITY * cos, mass * (GRAVITY * sin - along)];
        let force = [0, 1, 2].map(|k| pressure * normal[k] - friction * down[k]);
        close(&row.reaction.force, &force, "force of the contact");
        close(&row.reaction.torque, &[0.0; 3], "moment about the contact");
        let component = row.reaction.component.expect("N");
        close(&[component], &[pressure], "N");
    }
}

/// A leaning torus has an axis that rotates steadily about the vertical. Let r be the unit vector
/// outwards, t along the circle and z upwards. The axis is e = sin θ·r + cos θ·z, and its angular
/// velocity is Ω·z + s·e. The contact is at c = ρ·cos θ·r − H·z from the centre, at the height H =
/// ρ·sin θ + σ. The radius of the centre circle is ρ, and that of the tube is σ.
///
/// Rolling means that the centre has the velocity −(Ω·z + s·e) × c = −V·t with V = Ω·ρ·cos θ +
/// s·(ρ + σ·sin θ). The centre moves on a circle with Ω, so that the contact carries m·Ω·V·r +
/// m·g·z, whose moment c × F is −(m·g·ρ·cos θ + m·H·Ω·V)·t. The angular momentum is A·Ω·sin θ·(sin
/// θ·z − cos θ·r) + C·ω₃·e, with ω₃ = s + Ω·cos θ. Its rate is Ω·sin θ·(C·ω₃ − A·Ω·cos θ)·t. Both
/// sides are equal for one value of s.
#[test]
fn a_leaning_torus_rolls_steadily() {
    let (mass, [a, c], radius, tube) = (15.0, [3.75, 7.5], 0.8, 0.2);
    let (tilt, precession) = (1.2_f64, 0.7);
    let (sin, cos) = tilt.sin_cos();
    let height = radius * sin + tube;
    let lever = radius + tube * sin;
    // The condition is Ω·sin θ·(C·(s + Ω·cos θ) − A·Ω·cos θ) + m·H·Ω·(Ω·ρ·cos θ + s·lever) +
    // m·g·ρ·cos θ = 0.
    let of_spin = precession * (sin * c + mass * height * lever);
    let rest = precession * precession * cos * (sin * (c - a) + mass * height * radius)
        + mass * GRAVITY * radius * cos;
    let spin = -rest / of_spin;
    let speed = precession * radius * cos + spin * lever;
    let scene = format!(
        "scene = {{ name = \"torus\", space = \"spatial\", gravity = [0, 0, -{GRAVITY}] }}\n\
         body = [{{ name = \"tyre\", mass = {mass}, inertia = [{a}, {a}, {c}], position = [0, 0, {height}], \
         orientation = {{ axis = [0, 1, 0], angle = {tilt} }}, velocity = [0, {}, 0], \
         angular_velocity = [{}, 0, {}] }}]\n\
         joint = [{{ name = \"tread\", type = \"wheel\", body = \"tyre\", point = [0, 0, 0], axis = [0, 0, 1], \
         radius = {radius}, tube = {tube} }}]\n",
        -speed,
        spin * sin,
        precession + spin * cos,
    );
    for row in moved(&scene, 5.0) {
        let (turned_sin, turned_cos) = (precession * row.t).sin_cos();
        let (out, along) = ([turned_cos, turned_sin], [-turned_sin, turned_cos]);
        let pose = Pose::new([0.0; 3], [row.q[3], row.q[4], row.q[5], row.q[6]]);
        let [_, _, axis] = Axes::FRAME.map(|v| pose.direction_to_global(v)).uvw();
        close(&axis, &[sin * out[0], sin * out[1], cos], "axis");
        close(&row.v[5..], &[spin + precession * cos], "spin");
        close(
            &row.v[..3],
            &[-speed * along[0], -speed * along[1], 0.0],
            "velocity",
        );
        close(&row.q[2..3], &[height], "height");
        let inwards = mass * precession * speed;
        let force = [inwards * out[0], inwards * out[1], mass * GRAVITY];
        close(&row.reaction.force, &force, "force of the contact");
        close(&row.reaction.torque, &[0.0; 3], "moment about the contact");
    }
}

/// A ball on a slope at first rolls across it and spins about its normal. Its acceleration down the
/// slope is g·sin α·m·r²/(J + m·r²). It keeps its velocity across the slope and its spin, and the
/// slope carries the rest of the weight at the contact.
#[test]
fn a_ball_rolls_down_a_slope() {
    let (mass, moment, radius, slope) = (3.0, 0.5, 0.4, 0.3_f64);
    let (sin, cos) = slope.sin_cos();
    let (normal, down) = ([sin, 0.0, cos], [cos, 0.0, -sin]);
    let (across, spin) = (0.7, 2.0);
    // A velocity V along the plane has ω = n × V/r, and n × y is −x' along the slope.
    let turning = [0, 1, 2].map(|k| spin * normal[k] - across / radius * down[k]);
    let scene = format!(
        "scene = {{ name = \"slope\", space = \"spatial\", gravity = [0, 0, -{GRAVITY}] }}\n\
         body = [{{ name = \"ball\", mass = {mass}, inertia = [{moment}, {moment}, {moment}], \
         position = [{}, 0, {}], velocity = [0, {across}, 0], angular_velocity = {turning:?} }}]\n\
         joint = [{{ name = \"contact\", type = \"ball\", body = \"ball\", point = [0, 0, 0], radius = {radius}, \
         plane = {{ point = [0, 0, 0], normal = [{sin}, 0, {cos}] }} }}]\n",
        radius * sin,
        radius * cos,
    );
    let along = GRAVITY * sin / (1.0 + moment / (mass * radius * radius));
    for row in moved(&scene, 1.0) {
        let (speed, way) = (along * row.t, 0.5 * along * row.t * row.t);
        let fallen = [0, 1, 2].map(|k| radius * normal[k] + way * down[k]);
        close(
            &row.q[..3],
            &[fallen[0], across * row.t, fallen[2]],
            "place",
        );
        let velocity = [speed * down[0], across, speed * down[2]];
        close(&row.v[..3], &velocity, "velocity");
        let pose = Pose::new([0.0; 3], [row.q[3], row.q[4], row.q[5], row.q[6]]);
        let omega = pose.direction_to_global([row.v[3], row.v[4], row.v[5]]);
        // The identity is n × x' = y.
        let expected = [turning[0], speed / radius, turning[2]];
        close(&omega, &expected, "turning");
        let [pressure, friction] = [mass * GRAVITY * cos, mass * (GRAVITY * sin - along)];
        let force = [0, 1, 2].map(|k| pressure * normal[k] - friction * down[k]);
        close(&row.reaction.force, &force, "force of the contact");
        close(&row.reaction.torque, &[0.0; 3], "moment about the contact");
        let component = row.reaction.component.expect("N");
        close(&[component], &[pressure], "N");
    }
}

/// A wheel below its plane, or with a height above it that is smaller than the tube radius, is not
/// lifted automatically. The error names such a wheel, and also a wheel that lies flat.
#[test]
fn a_centre_that_is_too_low_is_named() {
    let told = |height: f64, axis: &str| {
        let scene = format!(
            "scene = {{ name = \"low\", space = \"spatial\", gravity = [0, 0, -9.81] }}\n\
             body = [{{ name = \"tyre\", mass = 1, inertia = [0.1, 0.1, 0.1], position = [0, 0, {height}] }}]\n\
             joint = [{{ name = \"tread\", type = \"wheel\", body = \"tyre\", point = [0, 0, 0], axis = {axis}, \
             radius = 0.4, tube = 0.1 }}]\n"
        );
        let registry = Registry::standard();
        match Study::read("wheel.toml", &scene, &registry, &RunOptions::default()) {
            Ok(_) => "a start".to_owned(),
            Err(e) => e.to_string(),
        }
    };
    assert_eq!(told(0.5, "[0, 1, 0]"), "a start");
    for (height, axis, words) in [
        (
            0.05,
            "[0, 1, 0]",
            "and the distance of its centre is larger than `tube`",
        ),
        (
            -0.3,
            "[0, 1, 0]",
            "and the distance of its centre is larger than `tube`",
        ),
        (0.5, "[0, 0, 1]", "is not parallel to the ground"),
    ] {
        let found = told(height, axis);
        assert!(found.contains(words), "{height}: {found}");
    }
}
