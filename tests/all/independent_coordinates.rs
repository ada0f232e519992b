//! The motion on independent coordinates: completed states, and the Jacobian against differences of the motion itself.

use std::ops::ControlFlow;

use dynamics::{KeptRowMotion, MotionOptions, Prepared, Reduced, RowChoice, prepare, simulate};
use joints::{Bushing, SpringDamper, TorsionSpringDamper};
use model::{BodyRef, Description, Force, Mechanism, PlaneForce, StartOptions};
use tests::cranks::cranks;
use tests::largest;
use tests::robot::{robot, steering};

fn prepared(d: &Description) -> Prepared {
    let mechanism = Mechanism::build(d).expect("a mechanism");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("a start")
}

/// A state `[q; v; work]` on the constraints, in motion.
fn state_at(p: &Prepared, t: f64) -> Vec<f64> {
    let mut y = Vec::new();
    let options = MotionOptions::to(t);
    simulate(p, &options, |row| {
        y = [row.q, row.v, &[0.0]].concat();
        Ok(ControlFlow::Continue(()))
    })
    .expect("a motion");
    y
}

fn force(name: &str, bodies: [BodyRef; 2], element: impl PlaneForce + 'static) -> Force {
    Force {
        name: name.into(),
        bodies: bodies.to_vec(),
        element: Box::new(element),
        functions: Vec::new(),
    }
}

/// Three cranks with forces of every kind.
fn sprung_cranks() -> Description {
    let [ground, crank, coupler] = [BodyRef::Ground, BodyRef::Body(0), BodyRef::Body(3)];
    let spring = SpringDamper {
        s_i: [0.3, 2.0],
        s_j: [0.2, 0.1],
        stiffness: 40.0,
        damping: 1.5,
        free_length: Some(0.7),
        free_length_0: 0.0,
    };
    let torsion = TorsionSpringDamper {
        stiffness: 30.0,
        damping: 0.8,
        free_angle: Some(0.5),
        free_angle_0: 0.0,
    };
    let bushing = Bushing {
        s_i: [0.5, 1.0],
        s_j: [0.1, -0.2],
        stiffness: [20.0, 10.0, 5.0],
        damping: [0.3, 0.2, 0.1],
        offset: [0.0; 2],
        angle_0: 0.0,
    };
    let mut d = cranks(&[0.0, 1.0, 2.0], 0.8, 0.9);
    d.gravity = [0.0, -9.81];
    d.forces = vec![
        force("spring", [ground, coupler], spring),
        force("torsion", [ground, crank], torsion),
        force("bushing", [ground, coupler], bushing),
    ];
    d
}

/// The mechanisms, at times when everything moves: the robot is steered at 1.5 s.
fn cases() -> [(&'static str, Prepared, f64); 2] {
    [
        ("cranks", prepared(&sprung_cranks()), 0.4),
        ("robot", prepared(&robot(steering())), 1.5),
    ]
}

#[test]
fn the_jacobian_is_the_difference_of_the_motion() {
    const H: f64 = 1e-5;
    for (name, p, t) in cases() {
        let y = state_at(&p, t);
        let mut motion = KeptRowMotion::new(&p).expect("rows");
        let mut reduced = Reduced::new(&motion);
        reduced.linearise(&mut motion, t, &y).expect("a Jacobian");
        let (jacobian, places) = reduced.jacobian();
        let size = jacobian.max_abs();
        assert!(size > 1.0, "{name}: the motion depends on its state");
        for (j, &place) in places.iter().enumerate() {
            let mut at = |h: f64| {
                let mut y = y.clone();
                y[place] += h;
                let mut dy = vec![0.0; y.len()];
                motion.derivative(t, &y, &mut dy).expect("a state nearby");
                dy
            };
            let (plus, minus) = (at(H), at(-H));
            for (i, (plus, minus)) in plus.iter().zip(&minus).enumerate() {
                let difference = (plus - minus) / (2.0 * H);
                let found = jacobian[(i, j)];
                assert!(
                    (found - difference).abs() < 1e-7 * size,
                    "{name}, d f[{i}]/d y[{place}]: {found}, by differences {difference}"
                );
            }
        }
    }
}

#[test]
fn dependent_entries_are_a_guess_only() {
    for (name, p, t) in cases() {
        let y = state_at(&p, t);
        let mut motion = KeptRowMotion::new(&p).expect("rows");
        let mut expected = vec![0.0; y.len()];
        motion.derivative(t, &y, &mut expected).expect("a state");
        motion.use_chart(t, &y[..y.len() / 2]).expect("a chart");
        let (z, u) = motion.independent().expect("a chart");
        let n = p.q.len();
        let is_free = |i: usize| z.contains(&i) || i >= n && u.contains(&(i - n));
        let moved: Vec<f64> = (0..y.len())
            .map(|i| {
                y[i] + if is_free(i) {
                    0.0
                } else {
                    1e-3 * (i as f64).sin()
                }
            })
            .collect();
        let mut found = vec![0.0; y.len()];
        motion.derivative(t, &moved, &mut found).expect("a state");
        let gap = largest(found.iter().zip(&expected).map(|(a, b)| a - b));
        let size = largest(expected.iter().copied());
        assert!(gap < 1e-12 * size, "{name}: {gap:e} of {size}");
    }
}

#[test]
fn shifted_systems_are_solved() {
    let (_, p, t) = &cases()[0];
    let y = state_at(p, *t);
    let mut motion = KeptRowMotion::new(p).expect("rows");
    let mut reduced = Reduced::new(&motion);
    reduced.linearise(&mut motion, *t, &y).expect("a Jacobian");
    let (sigma, [alpha, beta]) = (3.0, [2.0, 5.0]);
    reduced.factor(sigma, [alpha, beta]).expect("regular");
    let (jacobian, places) = reduced.jacobian();
    let places = places.to_vec();
    let times = |x: &[f64]| jacobian.times(&places.iter().map(|&i| x[i]).collect::<Vec<_>>());
    let right = |k: f64| -> Vec<f64> { (0..y.len()).map(|i| (k * i as f64).cos()).collect() };

    let (b, mut x) = (right(1.0), right(1.0));
    reduced.solve(&mut x);
    let gap = largest((0..x.len()).map(|i| sigma * x[i] - times(&x)[i] - b[i]));
    assert!(gap < 1e-10, "{gap:e}");

    let (b_re, b_im) = (right(2.0), right(3.0));
    let (mut re, mut im) = (b_re.clone(), b_im.clone());
    reduced.solve_complex(&mut re, &mut im);
    let real = |i: usize| alpha * re[i] - beta * im[i] - times(&re)[i] - b_re[i];
    let imaginary = |i: usize| alpha * im[i] + beta * re[i] - times(&im)[i] - b_im[i];
    let gap = largest((0..re.len()).flat_map(|i| [real(i), imaginary(i)]));
    assert!(gap < 1e-10, "{gap:e}");
}
