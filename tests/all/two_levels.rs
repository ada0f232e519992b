//! A joint with rows of both levels, and a user-defined joint: a disc that rolls on a line touches
//! it by a holonomic row and does not slip by a nonholonomic one. Verdicts, motions and reactions
//! are compared with closed forms, next to joints of only one level.

use std::ops::ControlFlow;

use dynamics::Method;
use joint_macro::joint;
use joints::{Constraint, Line, PointOnLine};
use model::{Mechanism, RowRanges, System};
use pfaff::prelude::*;

joint! { plane RollingDisc(i) {
    /// A disc of this radius rolls without slip on a line of the ground. Its centre has this
    /// distance to the left of the line, and the point of contact has no velocity along the line.
    params {
        /// The centre of the disc.
        s: Point in i,
        /// Radius of the disc.
        radius: Length,
        /// The line, with the disc to its left.
        track: GroundLine,
    }
    let up = perp(along(track));
    rows: [contact, slip];
    phi: dot(up, point(i, s) - start(track)) - radius;
    psi: dot(along(track), velocity(point(i, s))) + radius * rate(angle(i));
    component N: up;
    place: point(i, s);
} }

const MASS: f64 = 2.0;
const INERTIA: f64 = 0.3;
const RADIUS: f64 = 0.5;
const GRAVITY: f64 = 9.81;
/// Slope of the track (rad).
const SLOPE: f64 = 0.3;

/// The motions below are polynomials of second degree in time, which every method reproduces except
/// for rounding and its tolerance of 1e-10.
const TOLERANCE: f64 = 1e-8;

fn close(found: f64, expected: f64, what: &str) {
    let off = (found - expected).abs();
    assert!(
        off <= TOLERANCE * expected.abs().max(1.0),
        "{what}: {found}, not {expected}"
    );
}

/// Returns a line up the slope at this distance to the left of the line through the origin.
fn line(left: f64) -> Line {
    let (sin, cos) = SLOPE.sin_cos();
    let start = [-left * sin, left * cos];
    Line::new(start, [start[0] + cos, start[1] + sin]).expect("a line")
}

/// Adds a disc at this distance up the slope.
fn disc(d: &mut Description, name: &str, at: f64) -> BodyRef {
    let (sin, cos) = SLOPE.sin_cos();
    let body = d.body(Body {
        position: [at * cos - RADIUS * sin, at * sin + RADIUS * cos],
        ..Body::new(name, MASS, INERTIA)
    });
    let rolls = RollingDisc {
        s: [0.0; 2],
        radius: RADIUS,
        track: line(0.0),
    };
    d.joint(&format!("{name} rolls"), &[body], rolls);
    body
}

fn slope() -> Description {
    Description {
        gravity: [0.0, -GRAVITY],
        ..Description::new("slope")
    }
}

fn rail() -> PointOnLine {
    PointOnLine {
        s: [0.0; 2],
        line: line(RADIUS),
    }
}

/// Rows have the specified order, and every joint has the indices of its rows: nonholonomic rows
/// follow the holonomic ones in the order of the description, in which an edge is first.
#[test]
fn rows_of_both_levels_have_their_places() {
    let mut d = slope();
    let skate = d.body(Body::new("skate", 1.0, 1.0));
    let edge = KnifeEdge {
        s: [0.0; 2],
        normal: Direction::Y,
    };
    d.joint("edge", &[skate], edge);
    let first = disc(&mut d, "first", 0.0);
    d.joint("rail", &[first], rail());
    disc(&mut d, "second", 3.0);
    let mechanism = Mechanism::build(&d).expect("a mechanism");
    let layout = mechanism.layout();
    assert_eq!((layout.m, layout.h), (3, 3));
    let rows = |k: usize| {
        (
            layout.groups[k].name.as_str(),
            layout.groups[k].rows.clone(),
        )
    };
    let both = |phi: usize, psi: usize| RowRanges {
        holonomic: phi..phi + 1,
        nonholonomic: psi..psi + 1,
    };
    assert_eq!(rows(0), ("first rolls", both(0, 4)));
    assert_eq!(rows(2), ("second rolls", both(2, 5)));
    let listed: Vec<Vec<usize>> = (0..4).map(|k| rows(k).1.iter().collect()).collect();
    assert_eq!(listed, [vec![0, 4], vec![1], vec![2, 5], vec![3]]);
    let labels: Vec<String> = layout.labels.iter().map(ToString::to_string).collect();
    let expected = [
        "1 (`first rolls`, contact)",
        "2 (`rail`, normal)",
        "3 (`second rolls`, contact)",
        "4 (`edge`, normal)",
        "5 (`first rolls`, slip)",
        "6 (`second rolls`, slip)",
    ];
    assert_eq!(labels, expected);
    let owners: Vec<usize> = layout.owners.iter().map(|id| id.0).collect();
    assert_eq!(owners, [0, 1, 2, 3, 0, 2]);
    // The same check for a part of the whole, with the names of the whole.
    let part = mechanism.part(&[2]);
    assert_eq!(
        (part.places.rows, part.places.groups),
        (vec![2, 5], vec![2])
    );
    let own = part.mechanism.layout();
    assert_eq!(own.groups[0].rows, both(0, 1));
    assert_eq!((own.labels[1].number, own.labels[1].row), (6, "slip"));
}

/// The acceleration down the slope is g·sin α/(1 + J/(m·r²)). The whole load of the track acts at
/// the contact: the normal force m·g·cos α, and the rest of the weight along the slope, which
/// rotates the disc.
#[test]
fn a_disc_rolls_down_a_slope() {
    for method in [Method::Dop853, Method::Radau5] {
        let mut d = slope();
        disc(&mut d, "disc", 0.0);
        // Another disc follows it: neither has adjacent rows.
        disc(&mut d, "other", 3.0);
        let study = Study::build(d).unwrap_or_else(|e| panic!("{e}"));
        let options = MotionOptions {
            method,
            rtol: 1e-10,
            atol: 1e-12,
            ..MotionOptions::to(1.0)
        };
        let (sin, cos) = SLOPE.sin_cos();
        let down = GRAVITY * sin / (1.0 + INERTIA / (MASS * RADIUS * RADIUS));
        let mut rows = 0;
        let run = study.run(&options, |sample| {
            rows += 1;
            let travelled = 0.5 * down * sample.t * sample.t;
            for (k, reaction) in sample.reactions()?.as_chosen().iter().enumerate() {
                let q = &sample.q[3 * k..];
                let up_slope = q[0] * cos + q[1] * sin;
                close(up_slope, 3.0 * k as f64 - travelled, "way");
                close(q[1] * cos - q[0] * sin, RADIUS, "height");
                close(q[2], travelled / RADIUS, "angle");
                let [x, y, _] = reaction.force;
                close(y * cos - x * sin, MASS * GRAVITY * cos, "normal force");
                close(x * cos + y * sin, MASS * (GRAVITY * sin - down), "friction");
                close(reaction.torque[2], INERTIA * down / RADIUS, "torque");
                let named = reaction.component.expect("a named component");
                close(named, MASS * GRAVITY * cos, "N");
            }
            Ok(ControlFlow::Continue(()))
        });
        run.unwrap_or_else(|failure| panic!("{}", failure.error));
        assert!(rows > 1);
    }
}

/// A rail for the centre can replace the contact. Of the reaction of the disc the component across
/// the slope is not unique, the component along it is unique, and there is one verdict.
#[test]
fn a_rail_takes_the_load_of_one_row_of_a_joint() {
    let mut d = slope();
    let body = disc(&mut d, "disc", 0.0);
    d.joint("rail", &[body], rail());
    let study = Study::build(d).unwrap_or_else(|e| panic!("{e}"));
    let found = study.analyse(0.0, None).expect("a start");
    let analysis = &found.analysis;
    assert_eq!((analysis.decision.rank, analysis.mobility()), (2, 1));
    let alone = [analysis.rank_holonomic, analysis.rank_nonholonomic];
    assert_eq!(alone, [1, 1]);
    let names: Vec<&str> = analysis.reactions.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["disc rolls", "rail"]);
    let [rolls, rail] = &analysis.reactions[..] else {
        unreachable!("two reactions")
    };
    assert_eq!(
        [rolls, rail].map(|r| r.wrench.verdict.word()),
        ["not_unique"; 2]
    );
    let rows: Vec<(usize, &str)> = rolls
        .rows
        .iter()
        .map(|row| (row.row, row.judgement.verdict.word()))
        .collect();
    assert_eq!(rows, [(0, "not_unique"), (2, "unique")]);
    // Of Fx, Fy and T only the force across the slope is not unique.
    let components: Vec<(&str, &str)> = rolls
        .components
        .iter()
        .map(|c| (c.name, c.judgement.verdict.word()))
        .collect();
    let expected = [("Fx", "not_unique"), ("Fy", "not_unique"), ("T", "unique")];
    assert_eq!(components, expected);
    assert_eq!(rolls.unique_directions.len(), 2);
    for unique in &rolls.unique_directions {
        let (sin, cos) = SLOPE.sin_cos();
        close(unique[1] * cos - unique[0] * sin, 0.0, "across the slope");
    }
    let group = found.group("disc rolls + rail").expect("a sum");
    assert_eq!(group.judgement.verdict.word(), "unique");
}

/// The definition has all properties of the standard definitions.
#[test]
fn the_definition_conforms() {
    assert_eq!(
        (RollingDisc::SPEC.rows.len(), RollingDisc::SPEC.holonomic),
        (2, 1)
    );
    if let Err(failure) = joint_conformance::check_constraint::<RollingDisc, _>(2013) {
        panic!("{failure}");
    }
}
