//! Verdicts do not depend on the description of a mechanism: on order, scaling and recombination of
//! rows, order of bodies, units, position, frame, masses, loads and speed.

use linalg::Matrix;
use model::{BodyRef, Description, Mechanism, System};
use solvability::{Analysis, Solvability, analyse};
use tests::cranks::cranks;
use tests::numbers::Numbers;
use tests::robot::{robot_of_size, steering_of_size};
use tests::sketch::Sketch;

use crate::planted_mechanisms::generate::{Kind, draw};

const SEED: u64 = 18_112_026;

/// Number of random mechanisms of each kind.
const EACH: usize = 50;

/// The frame-independent results for a reaction: the verdicts on its wrench and its multipliers,
/// and the numbers of its unique directions and of the directions that are not always zero.
type Said = (String, &'static str, &'static str, [Option<usize>; 2]);

/// The verdicts of a configuration, by name: ranks, then every reaction.
fn said(a: &Analysis) -> ([usize; 4], Vec<Said>) {
    assert!(a.decision.is_decided(), "{:?}", a.decision.status);
    let mut reactions: Vec<Said> = a
        .reactions
        .iter()
        .map(|r| {
            let (wrench, multipliers) = (r.wrench.verdict.word(), r.multipliers.verdict.word());
            (
                r.name.clone(),
                wrench,
                multipliers,
                [Some(&r.unique_directions), r.live_directions.as_ref()].map(|d| d.map(Vec::len)),
            )
        })
        .collect();
    reactions.sort();
    let ranks = [
        a.rank_holonomic,
        a.rank_nonholonomic,
        a.decision.rank,
        a.decision.redundancy,
    ];
    (ranks, reactions)
}

fn analysed(d: &Description) -> Analysis {
    let mechanism = Mechanism::build(d).expect("the mechanism builds");
    let (q, _) = mechanism.described_state();
    analyse(&mechanism, 0.0, &q).expect("C is finite")
}

/// Three cranks, and mechanisms of every kind except those with many sizes at once.
fn sketches(numbers: &mut Numbers) -> Vec<Sketch> {
    let kinds = Kind::ALL.into_iter().filter(|k| *k != Kind::Sizes);
    kinds
        .flat_map(|kind| [kind; EACH])
        .map(|kind| draw(kind, numbers).sketch)
        .collect()
}

fn assert_same(what: &str, changes: impl Fn(&Sketch, &mut Numbers) -> Vec<Sketch>) {
    let mut numbers = Numbers::new(SEED);
    for sketch in sketches(&mut numbers) {
        let expected = said(&analysed(&sketch.description()));
        for changed in changes(&sketch, &mut numbers) {
            assert_eq!(
                said(&analysed(&changed.description())),
                expected,
                "{what}: {sketch:?}"
            );
        }
    }
}

#[test]
fn order_of_bodies_and_joints() {
    assert_same("order", |sketch, numbers| {
        let bodies = numbers.order(sketch.bodies.len());
        let links = numbers.order(sketch.links.len());
        vec![sketch.with_bodies(&bodies).with_links(&links)]
    });
}

/// Metres or millimetres, micrometres, megametres are equivalent to other sizes of mechanisms.
#[test]
fn units_of_length() {
    assert_same("length", |sketch, _| {
        [1e-6, 1e3, 1e6].map(|f| sketch.scaled(f)).to_vec()
    });
}

#[test]
fn place() {
    assert_same("place", |sketch, _| {
        vec![sketch.moved([1e6, -3e5]), sketch.moved([-0.3, 1e3])]
    });
}

#[test]
fn frame() {
    assert_same("frame", |sketch, _| {
        [0.3, 1.0, -2.5].map(|a| sketch.turned(a)).to_vec()
    });
}

/// The units are kilograms or grams, seconds or milliseconds; masses, loads and speeds are
/// arbitrary.
#[test]
fn masses_loads_and_speed() {
    let mut numbers = Numbers::new(SEED);
    for sketch in sketches(&mut numbers) {
        let mut d = sketch.description();
        let expected = said(&analysed(&d));
        for _ in 0..2 {
            d.gravity = [10.0 * numbers.unit(), -9.81e-3];
            for body in &mut d.bodies {
                body.mass = 10_f64.powi(numbers.between(-9, 9));
                body.inertia = 10_f64.powi(numbers.between(-9, 9));
                body.velocity = Some([1e3 * numbers.unit(), numbers.unit()]);
                body.angular_velocity = Some(100.0 * numbers.unit());
            }
            assert_eq!(said(&analysed(&d)), expected);
        }
    }
}

/// The test changes order, scaling, and recombination inside a joint, of the rows of the robot, the
/// cranks and random mechanisms.
#[test]
fn rows() {
    let mut numbers = Numbers::new(SEED);
    let robot = robot_of_size(1.0, steering_of_size(1.0));
    let three = cranks(&[0.0, 1.0, 1.7], 0.5, 1.0);
    let random = sketches(&mut numbers).into_iter().map(|s| s.description());
    for d in [robot, three].into_iter().chain(random) {
        let mechanism = Mechanism::build(&d).expect("the mechanism builds");
        let (q, _) = mechanism.described_state();
        let mut s = mechanism.scratch();
        mechanism.pose(0.0, &q, &mut s);
        mechanism.c(&mut s);
        let c = mechanism.layout().dense(&s);
        let groups: Vec<Vec<usize>> = mechanism
            .layout()
            .groups
            .iter()
            .map(|g| g.rows.iter().collect())
            .collect();
        // Both analyses treat rounding errors as large as those of recombined rows as noise.
        let noise = 1e-14;
        let judged = |c: &Matrix, groups: &[Vec<usize>]| -> Vec<&str> {
            let solvability =
                Solvability::of(c, rank::Accuracy::Absolute(noise)).expect("C is finite");
            assert!(solvability.decision().is_decided());
            let word = |rows: &Vec<usize>| {
                let judgement = solvability.group(rows.iter().copied());
                judgement.expect("the rows exist").verdict.word()
            };
            groups.iter().map(word).collect()
        };
        let expected = judged(&c, &groups);

        // The joints have another order, and the rows of each are mixed and scaled.
        let order = numbers.order(groups.len());
        let (mut rows, mut changed) = (Vec::new(), vec![Vec::new(); groups.len()]);
        for &g in &order {
            changed[g] = (rows.len()..rows.len() + groups[g].len()).collect();
            rows.extend(mixed(&c, &groups[g], &mut numbers));
        }
        let other = Matrix::from_fn(rows.len(), c.ncols(), |i, k| rows[i][k]);
        assert_eq!(judged(&other, &changed), expected, "{}", d.name);
    }
}

/// Multiplies some rows by a matrix with a dominant diagonal, scaled over 1e±6.
fn mixed(c: &Matrix, rows: &[usize], numbers: &mut Numbers) -> Vec<Vec<f64>> {
    let mut out = Vec::new();
    for &i in rows {
        let scale = 10_f64.powi(numbers.between(-6, 6));
        let mut row: Vec<f64> = c.row(i).iter().map(|x| 4.0 * scale * x).collect();
        for &l in rows {
            let factor = scale * numbers.unit();
            for (x, y) in row.iter_mut().zip(c.row(l)) {
                *x += factor * y;
            }
        }
        out.push(row);
    }
    out
}

/// The robot has any heading, position and size: it has no joint with the ground, so it may be
/// moved as a whole.
#[test]
fn robot_anywhere() {
    let facts = |size: f64, by: [f64; 2], angle: f64| {
        let mut d = robot_of_size(size, steering_of_size(size));
        let (sin, cos) = f64::sin_cos(angle);
        for body in &mut d.bodies {
            let [x, y] = body.position;
            body.position = [by[0] + cos * x - sin * y, by[1] + sin * x + cos * y];
            body.angle += angle;
        }
        assert!(
            d.joints
                .iter()
                .all(|j| !j.bodies.contains(&BodyRef::Ground))
        );
        said(&analysed(&d))
    };
    let expected = facts(1.0, [0.0; 2], 0.0);
    assert_eq!(expected.0, [17, 4, 20, 2]);
    for (size, by, angle) in [
        (1.0, [1e6, -2e6], 0.0),
        (1.0, [0.0; 2], 0.7),
        (1.0, [0.0; 2], std::f64::consts::FRAC_PI_2),
        (1e3, [3e3, 1e4], -2.0),
        (1e-6, [0.0; 2], 1e-9),
        (1e-3, [1.0, 1.0], 3.0),
    ] {
        assert_eq!(
            facts(size, by, angle),
            expected,
            "size {size}, at {by:?}, turned {angle}"
        );
    }
}
