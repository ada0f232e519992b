//! Examples that are mainly about geometry: linkages and the curves that they trace.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use super::{Run, close, read, says, scene, study};

const G: f64 = 9.81;

/// Returns the angle of the rocker for a crank angle: C is on two circles, above the line from D to
/// B.
fn rocker(crank: f64) -> f64 {
    let b = [0.3 * crank.cos(), 0.3 * crank.sin()];
    let d = [0.8 - b[0], -b[1]];
    let distance = d[0].hypot(d[1]);
    // The angle at D is in the triangle with the sides 0.9 and 1.
    let cos = (0.81 + distance * distance - 1.0) / (2.0 * 0.9 * distance);
    (-d[1]).atan2(-d[0]) - cos.acos()
}

#[test]
fn four_bar() {
    let run = Run::of("four-bar");
    for row in &run.rows {
        let turned = run.pose(row, "rocker")[2];
        let expected = rocker(FRAC_PI_2 + 6.0 * row.t) - rocker(FRAC_PI_2);
        // Both angles are equal up to whole revolutions of the arc tangent.
        close((turned - expected).sin(), 0.0, 1.0);
        assert!((turned - expected).cos() > 0.0);
        close(run.pose(row, "crank")[2], 6.0 * row.t, 12.0);
    }
    close(run.rate(run.first(), "rocker")[2], 2.0, 6.0);
    let half_turn = rocker(3.0 * FRAC_PI_2) - rocker(FRAC_PI_2);
    says("four-bar", half_turn.rem_euclid(2.0 * PI), 4);
}

/// The piston is as far as crank and rod reach along the bore; at both dead centres of an offset
/// bore they lie on one line.
#[test]
fn slider_crank() {
    let run = Run::of("slider-crank");
    let (r, l, offset, speed) = (0.04, 0.13, 0.005, 50.0 * PI);
    for row in &run.rows {
        let phi = PI / 3.0 + speed * row.t;
        let rise: f64 = offset - r * phi.sin();
        let reach = r * phi.cos() + (l * l - rise * rise).sqrt();
        close(run.pose(row, "piston")[0], reach, r + l);
        close(run.pose(row, "rod")[2], (rise / l).asin(), 1.0);
        close(run.rate(row, "crank")[2], speed, speed);
    }
    let dead = |arm: f64| (arm * arm - offset * offset).sqrt();
    says("slider-crank", 1e3 * (dead(l + r) - dead(l - r)), 3);
}

/// Computes the complete elliptic integral K(m) by the arithmetic-geometric mean (Abramowitz and
/// Stegun 17.6).
fn k(m: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

/// The cranks move like a pendulum with the moment of inertia I = 3·m·L²/3 + M·L² and the static
/// moment S = 3·m·L/2 + M·L.
#[test]
fn three_cranks() {
    let run = Run::of("three-cranks");
    let (inertia, moment) = (1.2 * 0.25 + 3.0 * 0.25, 1.8 * 0.5 + 3.0 * 0.5);
    let fastest = (2.0 * moment * G * 0.2 / inertia).sqrt();
    let hanging = 0.6_f64.asin();
    let period = 4.0 * (inertia / (moment * G)).sqrt() * k(0.1);
    for row in &run.rows {
        let [.., turned] = run.pose(row, "crank-1");
        let rate = run.rate(row, "crank-1")[2];
        let energy = 0.5 * inertia * rate * rate - moment * G * (hanging + turned).cos();
        close(energy, -0.8 * moment * G, moment * G);
        close(run.pose(row, "bar")[2], 0.0, 1.0);
    }
    says("three-cranks", fastest, 4);
    says("three-cranks", period, 4);
    let text = read(&scene("three-cranks")).replace("t_end = 2.0", &format!("t_end = {period:?}"));
    let round = Run::of_text("three-cranks", &text);
    close(round.pose(round.last(), "crank-1")[2], 0.0, 1.0);
}

/// The slider follows x = r·cos ωt; the torque of the motor is m·r²·ω²·sin ωt·cos ωt.
#[test]
fn scotch_yoke() {
    let run = Run::of("scotch-yoke");
    let (m, r, omega) = (2.0, 0.1, 20.0);
    for row in &run.rows {
        let phase = omega * row.t;
        close(run.pose(row, "yoke")[0], r * phase.cos(), 1.0);
        let torque = 0.5 * m * r * r * omega * omega * (2.0 * phase).sin();
        // The torque acts on the ground.
        close(run.reaction(row, "motor")[2], -torque, 4.0);
        let weight: f64 = ["left", "right"]
            .map(|j| run.reaction(row, j)[1])
            .iter()
            .sum();
        close(weight, -m * G, m * G);
    }
    says("scotch-yoke", m * G, 2);
    says("scotch-yoke", 0.5 * m * r * r * omega * omega, 1);
}

#[test]
fn pantograph() {
    let run = Run::of("pantograph");
    for row in &run.rows {
        let pen = run.point(row, "bar-AD", [0.4, -0.3]);
        let stylus = run.pose(row, "stylus");
        close(pen[0], 2.0 * stylus[0], 2.0);
        close(pen[1], 2.0 * stylus[1], 2.0);
    }
    close(run.point(run.last(), "bar-AD", [0.4, -0.3])[0], 1.8, 2.0);
    says("pantograph", 1.8, 1);
}

/// Returns the scene of a linkage without the guide of its point.
fn without_guide(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.contains("\"guide\""));
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// O, B and D are collinear, OB·OD = 0.5² − 0.34², and B moves on the circle through O, so that D.x
/// is constant.
#[test]
fn peaucellier() {
    // The straight line must follow from the linkage, not from its guide.
    let text = read(&scene("peaucellier"));
    let alone = without_guide(&text);
    for text in [text, alone] {
        let run = Run::of_text("peaucellier", &text);
        for row in &run.rows {
            let d = run.point(row, "CD", [0.08, 0.15]);
            close(d[0], 0.56, 1.0);
            let crank = run.pose(row, "crank")[2];
            close(d[1], 0.56 * (0.5 * crank).tan(), 1.0);
        }
        close(run.pose(run.last(), "crank")[2], 0.8, 1.0);
    }
    says("peaucellier", 0.56 * 0.4_f64.tan(), 5);
}

/// A force to the right acts on the middle of Chebyshev's coupler.
const PUSH: &str = r#"
[[force]]
name = "push"
type = "point-force"
body = "coupler"
at = [0.0, 0.4]
force = [0.5, 0.0]
"#;

/// Returns the height of the middle of the coupler at a tilt: two circles around O1 and O2, solved
/// for y.
fn height(tilt: f64) -> f64 {
    let u = tilt.cos();
    ((0.2 - 0.04 * u) * (u + 2.0).powi(2) / (5.0 + 4.0 * u)).sqrt()
}

#[test]
fn chebyshev() {
    // With the guide the linkage does not move.
    let run = Run::of("chebyshev");
    close(run.pose(run.last(), "coupler")[0], 0.0, 1.0);
    // With a force no motion can begin.
    let text = read(&scene("chebyshev"));
    let pushed = study("chebyshev", &format!("{text}{PUSH}"));
    let options = pushed.options.clone().expect("it says how long");
    let stopped = pushed.run(&options, |_| Ok(ControlFlow::Continue(())));
    assert!(stopped.is_err(), "a locked linkage has moved");
    // Without the guide the linkage moves, and the curve is not quite straight.
    let alone = without_guide(&text);
    let run = Run::of_text("chebyshev", &format!("{alone}{PUSH}"));
    let mut highest: f64 = 0.0;
    for row in &run.rows {
        let [_, y, tilt] = run.pose(row, "coupler");
        close(y, height(tilt), 1.0);
        highest = highest.max(y);
    }
    // The largest deviation is at a zero of the derivative of y²: −1/(5 − u) + 2/(u + 2) − 4/(5 +
    // 4u) = 0.
    let slope = |u: f64| -1.0 / (5.0 - u) + 2.0 / (u + 2.0) - 4.0 / (5.0 + 4.0 * u);
    let (mut low, mut high) = (0.4, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if slope(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let largest = height(low.acos()) - 0.4;
    says("chebyshev", 1e3 * largest, 2);
    // The comparison is to half a percent, because output rows do not coincide with the instant.
    assert!(
        (highest - 0.4 - largest).abs() < 5e-3 * largest,
        "{highest}"
    );
}

/// The angle of the crank at t = 0.03 s comes from the test set of Mazzia and Magherini; its table
/// is accurate to nine digits.
#[test]
fn andrews() {
    let run = Run::of("andrews");
    let beta = run.pose(run.last(), "crank")[2];
    close(beta, 15.81077119629904, beta);
    says("andrews", 15.81077, 5);
    assert!(beta > 5.0 * PI);
}
