//! Consistency of redundant rows. Guides that are parallel on paper are parallel to the rounding of
//! their data: the resulting violation of constraints is not a contradiction, for any position,
//! orientation and speed. A difference above the accuracy of the data is a contradiction, however
//! small it is.
//!
//! The reference values follow from Newton's second law for one body on one straight guide.

use std::ops::ControlFlow;

use dynamics::{MotionError, RowChoice, prepare};
use model::{Body, ConstraintId, Function, Mechanism, StartOptions, System};
use pfaff::AssembledScene;
use pfaff::prelude::*;
use solvability::{Choice, Contradiction, Equations, NormWeights, RowTerms, solution};
use suite::numbers::Numbers;
use tests::cranks::driven_parallelogram;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn unit(n: &mut Numbers) -> Vector {
    let v = [0; 3].map(|_| n.within(-1.0, 1.0));
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// A body on two guides along one direction, at positions up to a given distance from the origin.
struct Guided {
    text: String,
    along: Vector,
    gravity: Vector,
    speed: f64,
}

const MASS: f64 = 0.5;
const T_END: f64 = 0.1;

impl Guided {
    fn new(kinds: [&str; 2], far: f64, speed: f64, n: &mut Numbers) -> Self {
        // Along a coordinate axis the motion is in no row, except for rounding.
        let along = match n.below(4) {
            0 => unit(n),
            k => [1, 2, 3].map(|axis| f64::from(u8::from(axis == k))),
        };
        let gravity = unit(n).map(|x| 9.81 * x);
        let place = |n: &mut Numbers| [0; 3].map(|_| far * n.within(-1.0, 1.0));
        let (position, turn, angle) = (place(n), unit(n), n.within(-3.0, 3.0));
        let velocity = along.map(|x| speed * x);
        let mut text = format!(
            "[scene]\nname = \"guided\"\nspace = \"spatial\"\ngravity = {gravity:?}\n\
             [[body]]\nname = \"b\"\nmass = {MASS}\ninertia = [1.5, 2.0, 2.5]\nposition = {position:?}\n\
             orientation = {{ axis = {turn:?}, angle = {angle:?} }}\nvelocity = {velocity:?}\n"
        );
        for (k, kind) in kinds.into_iter().enumerate() {
            let bodies = [["b", "ground"], ["ground", "b"]][k];
            text += &format!(
                "[[joint]]\nname = \"guide {k}\"\ntype = {kind:?}\nbodies = {bodies:?}\nat = {:?}\n\
                 axis = {along:?}\nframe = \"global\"\n",
                place(n)
            );
        }
        text += &format!("[simulate]\nt_end = {T_END}\n");
        Self {
            text,
            along,
            gravity,
            speed,
        }
    }

    fn study(&self) -> Study {
        let scene = AssembledScene::read("guided.toml", &self.text, &Registry::standard());
        let study = scene.and_then(|scene| scene.prepare(&RunOptions::default()));
        study.unwrap_or_else(|e| panic!("{e}\n{}", self.text))
    }

    /// The body moves along the guide, and the guides balance gravity across it.
    fn check(&self) {
        let study = self.study();
        assert_eq!(study.cannot_begin(), None, "{}", self.text);
        let p = &study.prepared;
        let found = solution(&p.mechanism, (0.0, &p.q, &p.v), &p.decision)
            .unwrap_or_else(|e| panic!("{e}\n{}", self.text));
        let falls = dot(self.gravity, self.along);
        for k in 0..3 {
            let expected = falls * self.along[k];
            assert!(
                (found.acceleration[k] - expected).abs() < 1e-9,
                "{}",
                self.text
            );
        }
        let reached = self.speed * T_END + 0.5 * falls * T_END * T_END;
        let start = p.q.clone();
        let mut last = Vec::new();
        let run = study.run(&MotionOptions::to(T_END), |sample| {
            last = sample.q.to_vec();
            Ok(ControlFlow::Continue(()))
        });
        run.unwrap_or_else(|failure| panic!("{}\n{}", failure.error, self.text));
        // The tolerance of the run is 1e-8 of the distance.
        for k in 0..3 {
            let moved = last[k] - start[k];
            let way = reached.abs().max(start[k].abs());
            assert!(
                (moved - reached * self.along[k]).abs() < 1e-8 * way.max(1.0),
                "{}",
                self.text
            );
        }
        let start = study.analyse(0.0, None).expect("it can be analysed");
        let least = Choice::MinimumNorm(NormWeights::NEWTON_METRE);
        let made = start.distribution(&least);
        made.unwrap_or_else(|e| panic!("{e}\n{}", self.text));
    }
}

/// The guides are two sleeves, two rails or one of each: three to seven rows are redundant only to
/// rounding.
#[test]
fn guides_that_are_parallel_to_rounding_do_not_contradict_each_other() {
    let mut n = Numbers::new(5);
    for kinds in [
        ["cylindrical", "cylindrical"],
        ["translational", "cylindrical"],
        ["translational", "translational"],
    ] {
        for far in [1.0, 30.0] {
            for speed in [0.0, 1e-9, 0.06, 300.0] {
                for _ in 0..4 {
                    Guided::new(kinds, far, speed, &mut n).check();
                }
            }
        }
    }
}

/// A rod across a plane: the rod and the plane both constrain the body along the normal, so two
/// reactions act in one direction. On the body, `F_rod − F_table = −m·g_y`. The acceleration of
/// each row is accurate only to the rounding of the 9.81 m/s² along the plane.
#[test]
fn a_rod_across_a_plane_has_reactions() {
    let text = r#"
[scene]
name = "rod across a plane"
space = "spatial"
gravity = [0.0, -5.0, -9.81]
[[body]]
name = "b"
mass = 0.5
inertia = [1.5, 2.0, 2.5]
position = [0.3, 0.7, 0.2]
orientation = { axis = [1, 2, 3], angle = 0.7 }
[[joint]]
name = "rod"
type = "distance"
bodies = ["b", "ground"]
at = [[1.5, -1.5, -0.5], [1.5, -1.0, -0.5]]
[[joint]]
name = "table"
type = "planar"
bodies = ["ground", "b"]
at = [0.5, 0.5, -0.5]
normal = [0, 1, 0]
"#;
    let scene = AssembledScene::read("rod.toml", text, &Registry::standard());
    let study = scene.and_then(|scene| scene.prepare(&RunOptions::default()));
    let p = study.expect("it assembles").prepared;
    let found = solution(&p.mechanism, (0.0, &p.q, &p.v), &p.decision).expect("there is one");
    assert!(
        found.acceleration[1].abs() < 1e-12,
        "{:?}",
        found.acceleration
    );
    assert!(
        (found.acceleration[2] + 9.81).abs() < 1e-12,
        "{:?}",
        found.acceleration
    );
    let mut s = p.mechanism.scratch();
    p.mechanism.pose(0.0, &p.q, &mut s);
    let forces: Vec<f64> = ["rod", "table"]
        .iter()
        .map(|name| {
            let groups = &p.mechanism.layout().groups;
            let id = groups.iter().position(|group| group.name == *name);
            let id = ConstraintId(id.expect("it is a joint"));
            p.mechanism
                .reactions(&s)
                .reaction(id, found.multipliers.as_chosen())
                .force[1]
        })
        .collect();
    assert!((forces[0] - forces[1] - 2.5).abs() < 1e-9, "{forces:?}");
}

fn refused(motions: [Function; 2], wheel: f64) -> Option<Contradiction> {
    let mut d = driven_parallelogram(motions);
    d.body(Body {
        position: [5.0, 5.0],
        angular_velocity: Some(wheel),
        ..Body::new("wheel", 1.0, 1.0)
    });
    let mechanism = Mechanism::build(&d).expect("builds");
    match prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic) {
        Ok(_) => None,
        Err(MotionError::Contradiction(found)) => Some(found),
        Err(other) => panic!("{other}"),
    }
}

/// A difference above rounding is detected, also if a wheel rotates fast. Velocities are computed
/// together, so each is accurate to the rounding of 1e4 rad/s, which is about 1e-9 rad/s in these
/// rows.
#[test]
fn what_differs_by_more_than_rounding_is_a_contradiction() {
    let law = |coefficients: &[f64]| Function::polynomial(coefficients).expect("finite");
    for (wheel, by, is_found) in [
        (0.0, 1e-10, true),
        (0.0, 1e-17, false),
        (1e4, 1e-6, true),
        (1e4, 1e-17, false),
    ] {
        let [rates, accelerations] = [[0.0, 1.0 + by, 0.0], [0.0, 1.0, by]];
        for other in [rates, accelerations] {
            let found = refused([law(&[0.0, 1.0]), law(&other)], wheel);
            let what = format!("{other:?} with {wheel} rad/s: {found:?}");
            assert_eq!(found.is_some(), is_found, "{what}");
        }
    }
}

/// The same test for equations without a mechanism: a row along x is inclined by one rounding
/// error, while y accelerates.
#[test]
fn a_leaning_row_agrees_to_the_rounding_of_what_it_leans_to() {
    let rows = |lean: f64| {
        let c = linalg::Matrix::from_rows(&[[1.0, 0.0], [1.0, lean]]);
        Equations {
            mass: vec![1.0, 1.0],
            added: linalg::AddedMass::default(),
            force: vec![3.0, -9.81],
            terms: RowTerms::of_matrix(&c),
            gamma: vec![0.0, 0.0],
            c,
        }
    };
    for (lean, agrees) in [(0.0, true), (1e-17, true), (1e-13, true), (1e-7, false)] {
        // One row is independent for any matrix.
        let c = linalg::Matrix::from_rows(&[[1.0, 0.0], [1.0, 0.0]]);
        let decision = rank::decide(&c, rank::Accuracy::Rounding).expect("finite");
        let found = rows(lean).multipliers(&decision);
        assert_eq!(found.is_ok(), agrees, "{lean:e}: {found:?}");
    }
}
