//! The motion in independent coordinates: completed states, and the Jacobian compared with
//! difference quotients of the motion.

use std::ops::ControlFlow;

use dynamics::{
    KeptRowMotion, Method, MotionOptions, PreparedMechanism, ReducedJacobian, RowChoice, prepare,
    simulate,
};
use joints::{
    Bushing, Direction, KnifeEdge, RevoluteAngleDrive, SpringDamper, TorsionSpringDamper,
    Translational, TranslationalDisplacementDrive,
};
use model::{Body, BodyRef, Description, Force, ForceKernels, Joint, Mechanism, StartOptions};
use tests::cranks::cranks;
use tests::largest;
use tests::robot::{robot, steering};

fn prepared(d: &Description) -> PreparedMechanism {
    let mechanism = Mechanism::build(d).expect("a mechanism");
    prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic).expect("a start")
}

/// Returns a moving state `[q; v; work]` on the constraints.
fn state_at(p: &PreparedMechanism, t: f64) -> Vec<f64> {
    let mut y = Vec::new();
    let options = MotionOptions::to(t);
    simulate(p, &options, |row| {
        y = [row.q, row.v, &[0.0]].concat();
        Ok(ControlFlow::Continue(()))
    })
    .expect("a motion");
    y
}

fn force(name: &str, bodies: [BodyRef; 2], element: impl ForceKernels + 'static) -> Force {
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
    let spring = SpringDamper::new([0.3, 2.0], [0.2, 0.1], 40.0, 1.5).with_free_length(0.7);
    let torsion = TorsionSpringDamper::new(30.0, 0.8).with_free_angle(0.5);
    let bushing = Bushing::new([0.5, 1.0], [0.1, -0.2], [20.0, 10.0, 5.0], [0.3, 0.2, 0.1]);
    let mut d = cranks(&[0.0, 1.0, 2.0], 0.8, 0.9);
    d.gravity = [0.0, -9.81];
    d.forces = vec![
        force("spring", [ground, coupler], spring),
        force("torsion", [ground, crank], torsion),
        force("bushing", [ground, coupler], bushing),
    ];
    d
}

/// A block that slides on an arm, with armatures of the arm and of the slide. The displacement of
/// the slide depends on the configuration of both bodies.
fn armatured_slide() -> Description {
    let mut d = Description::new("slide");
    d.gravity = [0.0, -9.81];
    let [arm, block] = [[0.5, 0.0], [1.2, 0.3]].map(|position| Body {
        position,
        ..Body::new(if position[0] < 1.0 { "arm" } else { "block" }, 1.5, 0.2)
    });
    let [arm, block] = [d.body(arm), d.body(block)];
    let [pin, slide] = [[BodyRef::Ground, arm], [arm, block]];
    let axis = Direction::new([0.6, 0.8]).expect("a direction");
    let [s_i, s_j] = pin.map(|body| d.local(body, [0.0; 2]));
    d.joint("pin", &pin, joints::Revolute { s_i, s_j });
    d.armature("pin", &pin, RevoluteAngleDrive::new(s_i, s_j), 0.7);
    let [s_i, s_j] = slide.map(|body| d.local(body, [1.0, 0.4]));
    d.joint("slide", &slide, Translational::new(s_i, s_j, axis));
    let along = TranslationalDisplacementDrive::new(s_i, s_j, axis);
    d.armature("slide", &slide, along, 2.5);
    d
}

/// The mechanisms, at times at which all bodies move: the robot is steered at 1.5 s.
fn cases() -> [(&'static str, PreparedMechanism, f64); 3] {
    [
        ("armatures", prepared(&armatured_slide()), 0.4),
        ("cranks", prepared(&sprung_cranks()), 0.4),
        ("robot", prepared(&robot(steering())), 1.5),
    ]
}

/// Indices of the independent coordinates and velocities in y.
fn places_of_w(motion: &KeptRowMotion<'_>, n_q: usize) -> Vec<usize> {
    let (z, u) = motion.independent().expect("independent coordinates");
    z.iter().copied().chain(u.iter().map(|u| n_q + u)).collect()
}

#[test]
fn the_jacobian_is_the_difference_of_the_motion() {
    const H: f64 = 1e-5;
    for (name, p, t) in cases() {
        let y = state_at(&p, t);
        let mut motion = KeptRowMotion::new(&p).expect("rows");
        let mut reduced = ReducedJacobian::new(&motion);
        reduced.linearise(&mut motion, t, &y).expect("a Jacobian");
        let (jacobian, places) = (reduced.columns(), places_of_w(&motion, p.q.len()));
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
        motion
            .use_independent_coordinates(t, &y[..y.len() / 2])
            .expect("independent coordinates");
        let (z, u) = motion.independent().expect("independent coordinates");
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
    let (_, p, t) = &cases()[1];
    let y = state_at(p, *t);
    let mut motion = KeptRowMotion::new(p).expect("rows");
    let mut reduced = ReducedJacobian::new(&motion);
    reduced.linearise(&mut motion, *t, &y).expect("a Jacobian");
    let (sigma, [alpha, beta]) = (3.0, [2.0, 5.0]);
    reduced.factor(sigma, [alpha, beta]).expect("regular");
    let (jacobian, places) = (reduced.columns(), places_of_w(&motion, p.q.len()));
    let times = |x: &[f64]| jacobian.times(&places.iter().map(|&i| x[i]).collect::<Vec<_>>());
    let right = |k: f64| -> Vec<f64> { (0..y.len()).map(|i| (k * i as f64).cos()).collect() };

    let (b, mut x) = (right(1.0), right(1.0));
    reduced.solve(&mut x);
    let gap = |i: usize| sigma * x[i] - times(&x)[i] - b[i];
    let work = y.len() - 1;
    let of_w = |gap: &dyn Fn(usize) -> f64| largest(places.iter().chain([&work]).map(|&i| gap(i)));
    assert!(of_w(&gap) < 1e-10, "{:e}", of_w(&gap));

    let (b_re, b_im) = (right(2.0), right(3.0));
    let (mut re, mut im) = (b_re.clone(), b_im.clone());
    reduced.solve_complex(&mut re, &mut im);
    let real = |i: usize| alpha * re[i] - beta * im[i] - times(&re)[i] - b_re[i];
    let imaginary = |i: usize| alpha * im[i] + beta * re[i] - times(&im)[i] - b_im[i];
    assert!(of_w(&real) < 1e-10, "{:e}", of_w(&real));
    assert!(of_w(&imaginary) < 1e-10, "{:e}", of_w(&imaginary));

    // The dependent entries move the state along the constraints; after completion, the velocities
    // contained in q̇ have an error of order H².
    const H: f64 = 1e-4;
    for x in [&x, &re, &im] {
        let size = largest(x.iter().copied());
        let moved: Vec<f64> = y.iter().zip(x).map(|(y, x)| y + H * x / size).collect();
        let mut dy = vec![0.0; y.len()];
        motion
            .derivative(*t, &moved, &mut dy)
            .expect("a state nearby");
        let n = p.q.len();
        let gap = largest((0..n).map(|i| dy[i] - moved[n + i]));
        assert!(gap < 100.0 * H * H, "{gap:e}");
    }
}

/// A spring of 1e12 N·m/rad and a damper of 1e6 N·m·s/rad connect the first of three cranks to a
/// hand, which is driven by s(t) = −0.7 + 0.3·sin t. The fast motion decays at a rate of 3e5/s, and
/// the crank follows the hand.
mod held {
    use super::*;
    use joints::RevoluteAngleDrive;
    use model::{Drive, Function};

    const K: f64 = 1e12;
    const C: f64 = 1e6;
    const G: f64 = 9.81;
    /// Moment of inertia of all bodies for the one angle θ, with cranks 1 m long: 3·(0.1 +
    /// 1·0.5²) + 0.5·1².
    const INERTIA: f64 = 1.55;
    /// Moment of the weight at θ = 0, divided by g: 3·1·0.5 + 0.5·1.
    const LEVER: f64 = 2.0;

    /// The angle θ and the rate θ̇ of the slow motion, `I·θ̈ = −G·cos θ − k·(θ − s) − c·(θ̇ − ṡ)`,
    /// by two terms of its series in 1/k: the third term is below 1e-20.
    pub(super) fn slow(t: f64) -> [f64; 2] {
        let (sin, cos) = t.sin_cos();
        let [s, d, dd, ddd] = [-0.7 + 0.3 * sin, 0.3 * cos, -0.3 * sin, -0.3 * cos];
        let weight = G * LEVER;
        let e = -(INERTIA * dd + weight * s.cos()) / K;
        let e_rate = -(INERTIA * ddd - weight * s.sin() * d) / K;
        [s + e - C * e_rate / K, d + e_rate]
    }

    pub(super) fn description() -> Description {
        let [theta, omega] = slow(0.0);
        let mut d = cranks(&[0.0, 1.0, 2.0], 1.0, theta);
        d.gravity = [0.0, -G];
        let (sin, cos) = theta.sin_cos();
        for crank in &mut d.bodies[..3] {
            crank.inertia = 0.1;
            crank.angular_velocity = Some(omega);
            crank.velocity = Some([-0.5 * omega * sin, 0.5 * omega * cos]);
        }
        d.bodies[3].mass = 0.5;
        d.bodies[3].velocity = Some([-omega * sin, omega * cos]);
        d.bodies.push(Body {
            name: "hand".into(),
            mass: 1.0,
            inertia: 0.01,
            angular_velocity: Some(0.3),
            ..Body::default()
        });
        let pair = [BodyRef::Ground, BodyRef::Body(4)];
        let hand = tests::revolute("hand pivot", &d.bodies, pair, [0.0, 0.0]);
        d.joints.push(hand);
        d.drives.push(Drive {
            tolerance: None,
            name: "drive".into(),
            bodies: pair.to_vec(),
            element: Box::new(RevoluteAngleDrive::new([0.0; 2], [0.0; 2])),
            motion: Function::harmonic(0.3, 1.0, 0.0, 0.0).expect("finite"),
        });
        let spring = TorsionSpringDamper::new(K, C).with_free_angle(-0.7);
        let pair = [BodyRef::Body(4), BodyRef::Body(0)];
        d.forces.push(force("grip", pair, spring));
        d
    }
}

/// Returns the number of steps and the errors of angle and angular velocity of the coupled crank
/// after 2 s.
fn held_crank(p: &PreparedMechanism, rtol: f64) -> (u64, f64, f64) {
    let options = MotionOptions {
        method: Method::Radau5,
        rtol,
        atol: 1e-3 * rtol,
        output_step: 2.0,
        ..MotionOptions::to(2.0)
    };
    let mut found = [0.0; 2];
    let summary = simulate(p, &options, |row| {
        found = [row.q[2], row.v[2]];
        Ok(ControlFlow::Continue(()))
    })
    .expect("a motion");
    assert!(summary.max_position_residual < 1e-14);
    let expected = held::slow(2.0);
    let [position, velocity] = [0, 1].map(|i| (found[i] - expected[i]).abs());
    (summary.steps, position, velocity)
}

/// A stiffness of 1e12 does not require short steps, although an explicit method would need 3e5 of
/// them. The error of the angle is far below the tolerance. The velocity at the end of a step is
/// the slope of a cubic through s at its Radau nodes, which differs from the slope of s by
/// `s⁗·h³/80`. So after 2 s it depends on the length of the last step.
#[test]
fn a_grip_of_1e12_takes_few_steps() {
    let p = prepared(&held::description());
    let mut smallest = f64::INFINITY;
    for k in 6..12 {
        let rtol = 10f64.powf(-0.5 * f64::from(k));
        let (steps, position, velocity) = held_crank(&p, rtol);
        assert!(
            steps <= [9, 12, 16, 20, 28, 40][k as usize - 6],
            "{steps} steps at {rtol:e}"
        );
        assert!(position <= 1e-10, "{position:e} at {rtol:e}");
        assert!(velocity <= 1e-5, "{velocity:e} at {rtol:e}");
        smallest = smallest.min(velocity);
    }
    assert!(smallest <= 1e-7, "{smallest:e}");
}

/// A knife edge at the centre of mass moves on circles: `x = v/ω·sin ωt`. The dependent velocity is
/// the velocity across the edge, which is another coordinate after every quarter of a turn.
#[test]
fn partitions_are_renewed_as_a_blade_turns() {
    let (speed, omega) = (1.2, 1.5);
    let edge = KnifeEdge {
        s: [0.0, 0.0],
        normal: Direction::Y,
    };
    let d = Description {
        bodies: vec![Body {
            name: "sleigh".into(),
            mass: 1.0,
            inertia: 0.5,
            velocity: Some([speed, 0.0]),
            angular_velocity: Some(omega),
            ..Body::default()
        }],
        joints: vec![Joint::new("edge", &[BodyRef::Body(0)], edge)],
        ..Description::default()
    };
    let p = prepared(&d);
    for method in [Method::Dopri5, Method::Radau5] {
        let options = MotionOptions {
            method,
            rtol: 1e-10,
            atol: 1e-12,
            output_step: 0.5,
            ..MotionOptions::to(10.0)
        };
        let summary = simulate(&p, &options, |row| {
            let (sin, cos) = (omega * row.t).sin_cos();
            let radius = speed / omega;
            let expected = [radius * sin, radius * (1.0 - cos), omega * row.t];
            let gap = largest(row.q.iter().zip(expected).map(|(q, e)| q - e));
            assert!(gap < 1e-8, "{method:?} at t = {}: {gap:e}", row.t);
            Ok(ControlFlow::Continue(()))
        })
        .expect("a motion");
        assert!(summary.max_velocity_residual < 1e-14);
    }
}

/// Independent coordinates, inside an implicit method, and all coordinates on the independent rows
/// are two forms of the same motion.
#[test]
fn all_ways_lead_along_one_motion() {
    let end = |p: &PreparedMechanism, t: f64, method: Method| {
        let options = MotionOptions {
            method,
            rtol: 1e-9,
            atol: 1e-11,
            output_step: t,
            ..MotionOptions::to(t)
        };
        let mut y = Vec::new();
        let summary = simulate(p, &options, |row| {
            let [q, v] = [row.q.to_vec(), row.v.to_vec()];
            y = [
                q,
                v,
                row.acceleration()?,
                row.multipliers()?.as_chosen().to_vec(),
            ]
            .concat();
            Ok(ControlFlow::Continue(()))
        })
        .expect("a motion");
        assert!(summary.max_position_residual < 1e-14 && summary.max_velocity_residual < 1e-14);
        y
    };
    for (name, p, t) in cases() {
        let expected = end(&p, t, Method::Dopri5);
        for method in [Method::Radau5, Method::Dop853] {
            let found = end(&p, t, method);
            let gap = largest(found.iter().zip(&expected).map(|(a, b)| a - b));
            let size = largest(expected.iter().copied());
            assert!(gap < 1e-7 * size, "{name}, {method:?}: {gap:e}");
        }
    }
}
