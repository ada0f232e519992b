//! Examples with knife edges and wheels.

use std::f64::consts::TAU;

use super::{Run, close, says};

/// Component of gravity along a slope of 3 : 4 (m/s²).
const SLOPE: f64 = 0.6 * 9.81;

/// The body moves on a cycloid across the slope; the edge carries twice the component of the weight
/// perpendicular to it.
#[test]
fn knife_edge() {
    let run = Run::of("knife-edge");
    let (m, omega) = (2.0, 1.5);
    let a = SLOPE / (2.0 * omega * omega);
    for row in &run.rows {
        let phase = omega * row.t;
        let [x, y, angle] = run.pose(row, "skate");
        close(x, a * phase.sin().powi(2), 10.0);
        close(y, a * (phase - 0.5 * (2.0 * phase).sin()), 10.0);
        close(angle, phase, 10.0);
        let force = 2.0 * m * SLOPE * phase.sin();
        close(run.component(row, "edge"), force, 50.0);
    }
    says("knife-edge", a, 3);
    says("knife-edge", a * TAU, 4);
    says("knife-edge", 2.0 * m * SLOPE, 3);
}

/// The energy m·v² + J·ω² is constant, with J = m here: v = 2·tanh t, ω = 2/cosh t. The runners
/// together carry m·v·ω + m·a·dω/dt.
#[test]
fn sleigh() {
    let run = Run::of("sleigh");
    for row in &run.rows {
        let [vx, vy, omega] = run.rate(row, "sleigh");
        let heading = run.pose(row, "sleigh")[2];
        let ahead = vx * heading.cos() + vy * heading.sin();
        close(ahead, 2.0 * row.t.tanh(), 2.0);
        close(omega, 2.0 / row.t.cosh(), 2.0);
        // The heading is the Gudermannian function.
        close(heading, 4.0 * (0.5 * row.t).tanh().atan(), 4.0);
        let sum: f64 = ["left", "right"]
            .map(|j| run.component(row, j))
            .iter()
            .sum();
        close(sum, 24.0 * row.t.tanh() / row.t.cosh(), 24.0);
    }
    says("sleigh", 2.0 * 3.0_f64.tanh(), 5);
    says("sleigh", 24.0 * 0.5_f64.tanh() / 0.5_f64.cosh(), 4);
}

/// The motion is a tractrix: the axle is L·tanh τ behind the hitch and L/cosh τ away from the road,
/// τ = v·t/L.
#[test]
fn towed_cart() {
    let run = Run::of("towed-cart");
    let length = 1.2;
    for row in &run.rows {
        let tau = 0.6 * row.t / length;
        let [x, y] = run.point(row, "cart", [0.0, -0.4]);
        close(x, length * (tau - tau.tanh()), 2.0);
        close(y, -length / tau.cosh(), 2.0);
    }
    says("towed-cart", length * (2.0 - 2.0_f64.tanh()), 4);
    says("towed-cart", length / 2.0_f64.cosh(), 4);
}

/// The reduced mass is 40 + (0.08 + 16·0.02)/0.1² kg, and the reduced force is 4·0.6/0.1 N.
#[test]
fn sweeper() {
    let run = Run::of("sweeper");
    let (mass, force) = (40.0 + (0.08 + 16.0 * 0.02) / 0.01, 4.0 * 0.6 / 0.1);
    let deceleration = force / mass;
    for row in &run.rows {
        let speed = 2.0 - deceleration * row.t;
        close(run.rate(row, "cart")[0], speed, 2.0);
        close(run.rate(row, "brush")[2], -40.0 * speed, 80.0);
        for wheel in ["left-rolls", "right-rolls"] {
            // The decelerating force is shared equally, and this share is determined.
            close(run.reaction(row, wheel)[0], -20.0 * deceleration, 10.0);
        }
    }
    close(run.pose(run.last(), "cart")[0], 6.25, 10.0);
    says("sweeper", deceleration, 1);
    says("sweeper", 6.25, 2);
}

/// The car moves on one circle; the wheels together push it towards the centre.
#[test]
fn car() {
    let run = Run::of("car");
    let (mass, omega, centre) = (1200.0, 0.4, [-1.2, 2.5]);
    for row in &run.rows {
        let [x, y, angle] = run.pose(row, "car");
        let (sin, cos) = (omega * row.t).sin_cos();
        close(x, centre[0] - cos * centre[0] + sin * centre[1], 10.0);
        close(y, centre[1] - sin * centre[0] - cos * centre[1], 10.0);
        close(angle, omega * row.t, 10.0);
        let wheels = ["front-left", "front-right", "rear-left", "rear-right"];
        let forces = wheels.map(|w| run.reaction(row, w));
        for k in 0..2 {
            let sum: f64 = forces.iter().map(|f| f[k]).sum();
            let position = [x, y][k];
            close(sum, mass * omega * omega * (centre[k] - position), 1000.0);
        }
    }
    close(run.pose(run.last(), "car")[0], 0.0, 10.0);
    says("car", -mass * omega * omega * centre[0], 1);
    says("car", mass * omega * omega * centre[1], 1);
}

/// A force of 56 kN decelerates 28 t; the kingpin decelerates 20 t of them.
#[test]
fn truck() {
    let run = Run::of("truck");
    for row in &run.rows {
        close(run.rate(row, "truck")[0], 20.0 - 2.0 * row.t, 20.0);
        close(run.rate(row, "trailer")[0], 20.0 - 2.0 * row.t, 20.0);
        close(run.reaction(row, "kingpin")[0], 20e3 * 2.0, 4e4);
    }
    close(run.pose(run.last(), "truck")[0], 75.0, 100.0);
    says("truck", 75.0, 0);
}

/// Angular momentum about the fixed centre of the turn is constant: the board rotates back by
/// J_r/(J + m·R²) of the rotation of the rotor.
#[test]
fn snakeboard() {
    let run = Run::of("snakeboard");
    let (radius, half): (f64, f64) = (0.8, 0.4);
    let axles = 2.0 * (0.25 * (radius * radius + half * half) + 0.005);
    let all = 7.5 * radius * radius + axles + 0.35 + 0.44;
    let turn = 0.44 * 6.0 / all;
    let [x, y, angle] = run.pose(run.last(), "board");
    close(angle, turn, 1.0);
    close(x, radius * turn.sin(), 1.0);
    close(y, radius * (1.0 - turn.cos()), 1.0);
    // At first only the axles rotate.
    let steered = run.rows.iter().filter(|row| row.t <= 1.0);
    for row in steered {
        close(run.pose(row, "board")[2], 0.0, 1.0);
    }
    says("snakeboard", turn, 2);
    says("snakeboard", radius * turn.sin(), 4);
    says("snakeboard", radius * (1.0 - turn.cos()), 4);
}

/// No force drives the robot; it moves straight ahead until the slider moves.
#[test]
fn robot_trolley() {
    let run = Run::of("robot-trolley");
    let straight: Vec<_> = run.rows.iter().filter(|row| row.t <= 1.0).collect();
    assert!(straight.len() > 10);
    for row in straight {
        close(run.pose(row, "platform")[0], row.t, 1.0);
        close(run.pose(row, "trolley")[0], row.t - 0.75, 1.0);
    }
}
