//! Examples that are mainly about forces: statics, couples, equilibrium.

use super::{Run, close, says};

const G: f64 = 9.81;

/// Moments about a hinge show that the couple of the two horizontal forces balances the weight at
/// half the width.
#[test]
fn door() {
    let run = Run::of("door");
    let row = run.last();
    let (weight, width, distance) = (20.0 * G, 0.8, 1.5);
    let pull = weight * 0.5 * width / distance;
    let [lower, upper] = ["lower", "upper"].map(|j| run.reaction(row, j));
    close(upper[0], pull, weight);
    close(lower[0], -pull, weight);
    close(lower[1] + upper[1], -weight, weight);
    says("door", pull, 2);
    says("door", weight, 1);
}

/// The carriage follows x = g·sin(α)·t²/2, and the bearings together carry m·g·cos(α).
#[test]
fn carriage() {
    let run = Run::of("carriage");
    let weight = 12.0 * 0.8 * G;
    for row in &run.rows {
        close(run.pose(row, "carriage")[0], 0.3 * G * row.t * row.t, 3.0);
        let sum: f64 = ["rear", "front"]
            .map(|j| run.reaction(row, j)[1])
            .iter()
            .sum();
        close(sum, -weight, weight);
    }
    says("carriage", 0.3 * G, 3);
    says("carriage", weight, 3);
}

/// The reference consists of the equilibrium conditions at the nodes, and the elastic solution of
/// the force method.
#[test]
fn truss() {
    let run = Run::of("truss");
    let row = run.first();
    let load = 1000.0;
    let fx = |joint: &str| run.reaction(row, joint)[0];
    close(fx("AC") - fx("CD"), load, load);
    close(fx("AC") + fx("BD"), load, load);
    close(fx("support"), load, load);
    // Without BD, AC = √2·P and BC = −P. A unit force in BD gives −1/√2 in the sides and 1 in AC.
    // With equal EA, flexibilities are lengths.
    let root = 2.0_f64.sqrt();
    let (mixed, own) = (root * root + 1.0 / root, 4.0 * 0.5 + 2.0 * root);
    let bd = -load * mixed / own;
    says("truss", -bd, 2);
    says("truss", root * load + bd, 2);
    says("truss", -bd / root, 2);
}

/// The power balance is F·ds = weight·dh with half of each leg, and h² + s² = L².
#[test]
fn scissor_lift() {
    let run = Run::of("scissor-lift");
    let weight = (200.0 + 4.0 * 15.0) * G;
    let at_rest = weight * 1.6 / 1.2;
    close(run.reaction(run.first(), "cylinder")[0], at_rest, weight);
    says("scissor-lift", at_rest, 2);
    for row in &run.rows {
        let foot = run.point(row, "down-1", [0.8, -0.6]);
        let height = run.pose(row, "table")[1];
        close(height, (4.0 - foot[0] * foot[0]).sqrt(), 2.0);
        close(run.pose(row, "table")[2], 0.0, 1.0);
    }
    let row = run.last();
    close(run.pose(row, "table")[1], 1.6, 2.0);
    // The drive is at rest at the end.
    let at_rest = weight * 1.2 / 1.6;
    close(run.reaction(row, "cylinder")[0], at_rest, weight);
    says("scissor-lift", at_rest, 2);
}

/// Both cranks rotate, both links translate, and there is one equation for the sum of the powers.
#[test]
fn five_bar() {
    let run = Run::of("five-bar");
    let (crank, link, length) = (1.0, 0.8, 0.5);
    let holding = (crank * length + 2.0 * link * length) * G;
    let sum = |row| {
        let [a, b, e] = ["motor-A", "motor-B", "motor-E"].map(|m| run.component(row, m));
        a - b + e
    };
    // The torque acts on the ground, and on the crank at B it is opposite to the motion.
    let (start, end) = (0.6, (0.8_f64.atan2(0.6) + 0.5).cos());
    close(sum(run.first()), -holding * start, holding);
    close(sum(run.last()), -holding * end, holding);
    for row in &run.rows {
        for link in ["link-1", "link-2"] {
            close(run.pose(row, link)[2], 0.0, 1.0);
        }
    }
    close(run.pose(run.last(), "crank-1")[2], 0.5, 1.0);
    says("five-bar", holding * start, 4);
    says("five-bar", holding * end, 4);
}

/// Newton's law is applied to the reduced inertia; both layshafts exert forces on the output.
#[test]
fn gear_train() {
    let run = Run::of("gear-train");
    let reduced = 0.01 + 2.0 * 0.04 * 0.25 + 0.9 / 36.0;
    let alpha = 12.0 / reduced;
    for row in &run.rows {
        let speed = alpha * row.t;
        close(run.rate(row, "input")[2], speed, alpha);
        close(run.rate(row, "lay-1")[2], -speed / 2.0, alpha);
        close(run.rate(row, "lay-2")[2], -speed / 2.0, alpha);
        close(run.rate(row, "output")[2], speed / 6.0, alpha);
        let sum: f64 = ["out-1", "out-2"]
            .map(|j| run.reaction(row, j)[2])
            .iter()
            .sum();
        close(sum, 0.9 * alpha / 6.0 / 3.0, 12.0);
    }
    says("gear-train", alpha / 6.0, 3);
    says("gear-train", 0.9 * alpha / 6.0, 3);
    says("gear-train", 0.9 * alpha / 18.0, 3);
}

/// Willis' equation: relative to the carrier, sun and ring rotate in the ratio −60 : 30.
#[test]
fn planetary_gear() {
    let run = Run::of("planetary-gear");
    let reduced = 2.25e-4 + 1e-3 / 9.0 + 3.0 * (0.15 * 0.045 * 0.045 / 9.0 + 1.6875e-5);
    let alpha = (1.5 - 4.2 / 3.0) / reduced;
    for row in &run.rows {
        let sun = alpha * row.t;
        close(run.rate(row, "sun")[2], sun, alpha);
        close(run.rate(row, "carrier")[2], sun / 3.0, alpha);
        for planet in ["planet-1", "planet-2", "planet-3"] {
            close(run.rate(row, planet)[2], -sun, alpha);
        }
        let meshes = ["sun-1", "sun-2", "sun-3"].map(|j| run.reaction(row, j)[2]);
        close(meshes.iter().sum(), -(1.5 - 2.25e-4 * alpha), 1.5);
    }
    says("planetary-gear", alpha, 1);
    says("planetary-gear", alpha / 3.0, 2);
    says("planetary-gear", 1.5 - 2.25e-4 * alpha, 4);
}
