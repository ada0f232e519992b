//! Examples in space, compared with motions in closed form, sums of reactions, and published
//! digits.

use std::f64::consts::FRAC_PI_2;

use joints::space3::Pose;

use super::{Row, Run, close, says};

const G: f64 = 9.81;

/// Results of runs with bodies in space.
struct Spatial(Run);

impl Spatial {
    fn of(name: &str) -> Self {
        Self(Run::of(name))
    }

    fn at(&self, body: &str) -> usize {
        let at = self.0.bodies.iter().position(|b| b == body);
        at.unwrap_or_else(|| panic!("no body `{body}`"))
    }

    /// Returns a point of a body; `s` is relative to its mass centre, in its axes.
    fn point(&self, row: &Row, body: &str, s: [f64; 3]) -> [f64; 3] {
        let [x, y, z, e @ ..]: [f64; 7] = row.q[7 * self.at(body)..][..7]
            .try_into()
            .expect("seven coordinates");
        Pose::new([x, y, z], e).to_global(s)
    }

    fn centre(&self, row: &Row, body: &str) -> [f64; 3] {
        self.point(row, body, [0.0; 3])
    }

    /// Returns the direction from one point of a body to another one.
    fn direction(&self, row: &Row, body: &str, s: [f64; 3]) -> [f64; 3] {
        sub(self.point(row, body, s), self.centre(row, body))
    }

    /// Returns the angular velocity; the tensors of the examples are diagonal, so that these are
    /// body axes.
    fn spin(&self, row: &Row, body: &str) -> [f64; 3] {
        let k = 6 * self.at(body) + 3;
        [row.v[k], row.v[k + 1], row.v[k + 2]]
    }

    fn sum(&self, row: &Row, joints: &[&str]) -> [f64; 3] {
        let forces = joints.iter().map(|j| row.reactions[self.0.joint(j)].force);
        forces.fold([0.0; 3], |a, b| std::array::from_fn(|k| a[k] + b[k]))
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the angle between two directions.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    (dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()).acos()
}

/// A constant torque acts about a fixed axis; the hinges together accelerate the mass centre.
#[test]
fn hinges() {
    let run = Spatial::of("hinges");
    let alpha = 6.4 / (20.0 * 0.8 * 0.8 / 3.0);
    for row in &run.0.rows {
        let turned = 0.5 * alpha * row.t * row.t;
        let centre = run.centre(row, "leaf");
        close(centre[0], 0.4 * turned.cos(), 1.0);
        close(centre[1], 0.4 * turned.sin(), 1.0);
        close(centre[2], 1.0, 1.0);
        let [x, y, z] = run.sum(row, &["lower", "middle", "upper"]);
        let speed = alpha * row.t;
        close(x.hypot(y), 8.0 * alpha.hypot(speed * speed), 100.0);
        close(z, -20.0 * G, 200.0);
    }
    says("hinges", 8.0 * alpha.hypot(alpha * alpha), 4);
}

/// C is on a circle about B and on a circle about D.
#[test]
fn linkage() {
    let run = Spatial::of("linkage");
    let mut c = [0.0; 3];
    for row in &run.0.rows {
        let (sin, cos) = (0.5 * row.t).sin_cos();
        let b = [0.3 * cos - 0.8 * sin, 0.3 * sin + 0.8 * cos];
        let (x, y) = (1.4 - b[0], -b[1]);
        let (square, coupler, rocker) = (x * x + y * y, 1.44 + 0.09, 0.01 + 1.21);
        let along = (coupler - rocker + square) / (2.0 * square);
        let across = (coupler / square - along * along).sqrt();
        c = run.point(row, "rocker", [0.05, 0.55, 0.0]);
        close(c[0], b[0] + along * x - across * y, 1.0);
        close(c[1], b[1] + along * y + across * x, 1.0);
        close(c[2], 0.0, 1.0);
        close(run.sum(row, &["A", "D"])[2], -4.0 * G, 40.0);
    }
    says("linkage", c[0], 6);
    says("linkage", c[1], 6);
}

/// The ratio of the rates is ω₂/ω₁ = cos β/(1 − sin² β·sin² θ₁).
#[test]
fn hooke() {
    let run = Spatial::of("hooke");
    for row in &run.0.rows {
        let sin = (2.0 * row.t).sin();
        let expected = 2.0 * 0.8 / (1.0 - 0.36 * sin * sin);
        // The x-axis of the body is the axis of the shaft.
        close(run.spin(row, "output")[0], expected, 3.0);
    }
    says("hooke", run.spin(run.0.last(), "output")[0], 4);
}

/// The product of the tangents of half the angles at neighbouring hinges is constant.
#[test]
fn bennett() {
    let run = Spatial::of("bennett");
    let mut at_b = 0.0;
    for row in &run.0.rows {
        let crank = run.direction(row, "crank", [0.0, 1.5, 0.0]);
        let c = [-16.0 / 13.0, -9.0 / 13.0, 12.0 / 13.0];
        let half = sub(c, [-8.0 / 13.0, 15.0 / 13.0, 6.0 / 13.0]);
        let coupler = run.direction(row, "coupler", half);
        let at_a = angle(crank, [-1.0, 0.0, 0.0]);
        at_b = angle(crank.map(|x| -x), coupler);
        close(at_a, FRAC_PI_2 - 0.5 * row.t, 1.0);
        close((0.5 * at_a).tan() * (0.5 * at_b).tan(), 0.2, 1.0);
    }
    says("bennett", at_b, 4);
}

/// The plate moves vertically; at rest the motor balances the weights that rise with it.
#[test]
fn sarrus() {
    let run = Spatial::of("sarrus");
    for row in &run.0.rows {
        let [x, y, z] = run.centre(row, "plate");
        close(x, 0.4, 1.0);
        close(y, 0.4, 1.0);
        let link = run.direction(row, "lower-2", [0.0, 0.2, 0.15]);
        close(z, 4.0 * link[2], 1.0);
    }
    let torque = |cos: f64| (2.0 * 4.0 + 4.0 * 0.5) * G * 0.5 * cos;
    for (row, sin, cos) in [(run.0.first(), 0.6, 0.8), (run.0.last(), 0.8, 0.6)] {
        close(run.centre(row, "plate")[2], sin, 1.0);
        close(run.0.component(row, "motor"), -torque(cos), 50.0);
        says("sarrus", torque(cos), 2);
    }
}

/// The reference is z = sin θ/(1 − sin θ), the energy, and the published angle after one second.
#[test]
fn bricard() {
    let run = Spatial::of("bricard");
    let (mut theta, mut z) = (0.0, 0.0);
    for row in &run.0.rows {
        let rod = run.direction(row, "rod-1", [1.0, 0.0, 0.0]);
        theta = rod[2].atan2(rod[0]);
        let sin = theta.sin();
        z = run.point(row, "rod-2", [0.0, -0.5, 0.0])[2];
        close(z, sin / (1.0 - sin), 1.0);
    }
    close(theta, -1.035_028_459_518, 1.0);
    says("bricard", -theta, 6);
    says("bricard", -z, 6);
}

/// The forces of two legs on one side follow from moments about the other side.
#[test]
fn table() {
    let run = Spatial::of("table");
    let row = run.0.last();
    close(run.centre(row, "top")[0], 0.2 + 0.3 * 2.0, 1.0);
    close(run.centre(row, "top")[1], 0.1, 1.0);
    let x = run.direction(row, "top", [1.0, 0.0, 0.0]);
    close(x[1].atan2(x[0]), 1.0, 1.0);
    let weight = 12.0 * G;
    let first = run.0.first();
    close(run.sum(first, &["A", "B"])[2], -weight * 0.5 / 0.8, weight);
    close(run.sum(row, &["A", "B", "C", "D"])[2], -weight, weight);
    says("table", weight * 0.5 / 0.8, 3);
}

/// The legs have equal lengths and equal horizontal distances; the power balance is valid at rest.
#[test]
fn hexapod() {
    let run = Spatial::of("hexapod");
    let sum = |row: &Row| -> f64 {
        let legs = ["L1", "L2", "L3", "L4", "L5", "L6"];
        legs.iter().map(|leg| run.0.component(row, leg)).sum()
    };
    for row in &run.0.rows {
        let [x, y, _] = run.centre(row, "platform");
        close(x, 0.0, 1.0);
        close(y, 0.0, 1.0);
    }
    let weight = (50.0 + 6.0 * 3.0) * G;
    for (row, length) in [(run.0.first(), 1.3_f64), (run.0.last(), 1.5)] {
        let height = (length * length - 0.25).sqrt();
        close(run.centre(row, "platform")[2], height, 1.0);
        close(sum(row), -weight * length / height, weight);
        says("hexapod", weight * length / height, 3);
    }
}

/// The reference values are the digits of the benchmark.
#[test]
fn top() {
    let run = Spatial::of("top");
    let row = run.0.last();
    let expected = [
        0.173_343_964_094_386_04,
        0.640_088_592_070_568_8,
        -0.748_490_791_133_581_3,
    ];
    for (found, expected) in run.centre(row, "top").into_iter().zip(expected) {
        close(found, expected, 1.0);
        says("top", expected.abs(), 6);
    }
    for row in &run.0.rows {
        close(run.spin(row, "top")[1], 150.0, 150.0);
    }
}

/// Newton's law is applied with an additional half of the mass of each wheel.
#[test]
fn wagon() {
    let run = Spatial::of("wagon");
    for row in &run.0.rows {
        close(run.centre(row, "chassis")[0], 0.25 * row.t * row.t, 1.0);
        let braked = run.sum(row, &["wheel-front-left"]);
        close(braked[0], -0.5 * 0.5, 13.0);
    }
    let wheels = ["front-left", "front-right", "rear-left", "rear-right"];
    let contacts = wheels.map(|w| format!("wheel-{w}"));
    let contacts = contacts.each_ref().map(String::as_str);
    close(run.sum(run.0.last(), &contacts)[2].abs(), 24.0 * G, 240.0);
}

/// The robot moves straight ahead, and the load on the wheel of the trolley follows from the
/// moments about its hitch.
#[test]
fn robot_in_space() {
    let run = Spatial::of("robot-in-space");
    let carried = (8.0 * 0.35 / 0.4 + 0.5) * G;
    for row in run.0.rows.iter().filter(|row| row.t <= 1.0) {
        close(run.centre(row, "platform")[0], row.t, 1.0);
        close(run.spin(row, "trolley-wheel")[1], 1.0 / 0.08, 12.5);
        close(run.sum(row, &["W5"])[2].abs(), carried, carried);
    }
    says("robot-in-space", carried, 4);
}
