//! Sensitivities computed by hand and by differences.

use crate::limits::MOVED;
use joints::{KnifeEdge, Line, PointOnLine, Revolute, RevoluteAngleDrive};
use linalg::Matrix;
use model::{Body, BodyRef, Description, Function};

mod fleets;
mod parts;

use super::*;
use crate::sketch::{GROUND, Kind, Sketch, Z};
use joints::space3::Pose;

/// Sensitivities of all reactions, all of which are unique.
fn known(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Vec<Sensitivity> {
    let analysis = crate::analyse(mechanism, t, q).expect("finite");
    let all = analysis.sensitivities(mechanism, q, v).expect("fits");
    let each = all.each.into_iter();
    each.map(|s| s.expect("unique")).collect()
}

/// A beam of 2 m and 10 N between a pin and a roller, its mass centre at a quarter of the length
/// from the pin: the roller carries W·c/L.
fn beam() -> Mechanism {
    let mut d = Description::new("beam");
    d.gravity = [0.0, -10.0];
    let beam = d.body(Body {
        position: [0.5, 0.0],
        ..Body::new("beam", 1.0, 1.0)
    });
    let pin = Revolute {
        s_i: [-0.5, 0.0],
        s_j: [0.0, 0.0],
    };
    d.joint("pin", &[beam, BodyRef::Ground], pin);
    let line = Line::new([0.0, 0.0], [2.0, 0.0]).expect("a line");
    let roller = PointOnLine {
        s: [1.5, 0.0],
        line,
    };
    d.joint("roller", &[beam], roller);
    Mechanism::build(&d).expect("it builds")
}

/// dR/dL = −W·c/L², dR/da = −W·(L − c)/L² if the pin moves along the beam: 3/8 of the weight per
/// metre, and the point moves by 0.2 mm.
#[test]
fn a_beam_by_hand() {
    let mechanism = beam();
    let found = known(&mechanism, 0.0, &[0.5, 0.0, 0.0], &[0.0; 3]);
    let [pin, roller] = &found[..] else {
        panic!("two joints");
    };
    for (of, name) in [(pin, "pin"), (roller, "roller")] {
        assert!((of.change / 7.5e-5 - 1.0).abs() < 1e-9, "{name}: {of:?}");
        assert_eq!(of.by.map(|by| by.joint), Some(ConstraintId(0)), "{name}");
        assert!(!of.is_fragile());
        for (change, is_fragile) in [(0.08, false), (0.12, true)] {
            let by_more = Sensitivity {
                change,
                ..of.clone()
            };
            assert_eq!(by_more.is_fragile(), is_fragile, "{change}");
        }
    }
}

/// Numbers of a crank of 0.3 m with a rod of 0.8 m whose end moves on an oblique line; each pair is
/// a point or a direction.
const POINTS: [[f64; 2]; 6] = [
    [0.02, -0.01], // A on the ground
    [-0.15, 0.0],  // A on the crank
    [0.15, 0.01],  // B on the crank
    [-0.4, 0.0],   // B on the rod
    [0.4, 0.02],   // end of the rod
    [0.0, -0.1],   // a point of the line
];

/// Direction of the line (rad).
const LINE: f64 = 0.2;

/// A driven crank; its start is rotated by `turned`, so that the pose is determined at each time.
fn slider_crank(points: [[f64; 2]; 6], line: f64, turned: f64) -> Mechanism {
    let mut d = Description::new("slider-crank");
    d.gravity = [0.3, -9.81];
    let crank = d.body(Body {
        position: [0.12, 0.08],
        angle: 0.6,
        ..Body::new("crank", 2.0, 0.03)
    });
    let rod = d.body(Body {
        position: [0.65, 0.1],
        angle: -0.2,
        ..Body::new("rod", 1.5, 0.1)
    });
    let pin = |i: usize, j: usize| Revolute {
        s_i: points[i],
        s_j: points[j],
    };
    d.joint("A", &[BodyRef::Ground, crank], pin(0, 1));
    d.joint("B", &[crank, rod], pin(2, 3));
    let [x, y] = points[5];
    let line = Line::new([x, y], [x + line.cos(), y + line.sin()]).expect("a line");
    d.joint("end", &[rod], PointOnLine { s: points[4], line });
    let motor = RevoluteAngleDrive::new(points[0], points[1]);
    let motion = Function::polynomial(&[turned, 3.0, 4.0]).expect("numbers");
    d.drive("motor", &[BodyRef::Ground, crank], motor, motion);
    Mechanism::build(&d).expect("it builds")
}

/// Solves `A·x = b`, or `Aᵀ·x = b`, by elimination with exchanges.
fn solved(a: &Matrix, b: &[f64], transposed: bool) -> Vec<f64> {
    let n = b.len();
    let entry = |i, j| if transposed { a[(j, i)] } else { a[(i, j)] };
    let mut m = Matrix::from_fn(n, n + 1, |i, j| if j == n { b[i] } else { entry(i, j) });
    for k in 0..n {
        let larger = |i: &usize, j: &usize| m[(*i, k)].abs().total_cmp(&m[(*j, k)].abs());
        let pivot = (k..n).max_by(larger).expect("rows");
        for j in 0..=n {
            let (x, y) = (m[(k, j)], m[(pivot, j)]);
            (m[(k, j)], m[(pivot, j)]) = (y, x);
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = m[(i, k)] / m[(k, k)];
            for j in k..=n {
                let x = m[(k, j)];
                m[(i, j)] -= factor * x;
            }
        }
    }
    (0..n).map(|i| m[(i, n)] / m[(i, i)]).collect()
}

/// State and reactions (force, torque) at a time, by Newton's method from the described pose and
/// two square systems.
fn reactions(mechanism: &Mechanism, t: f64) -> (Vec<f64>, Vec<f64>, Vec<[f64; 3]>) {
    let layout = mechanism.layout();
    let mut s = mechanism.scratch();
    let mut q = mechanism.described_state().0;
    for step in 0..40 {
        // The drive is followed in small steps, so that the branch does not change.
        mechanism.pose(t * (f64::from(step) / 20.0).min(1.0), &q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        let change = solved(&layout.dense(&s), &s.phi, false);
        q.iter_mut()
            .zip(change)
            .for_each(|(q, change)| *q -= change);
    }
    mechanism.pose(t, &q, &mut s);
    mechanism.c(&mut s);
    mechanism.b(&mut s);
    let c = layout.dense(&s);
    let v = solved(&c, &s.b, false);
    mechanism.twist(&v, &mut s);
    mechanism.gamma(&mut s);
    mechanism.force(&mut s);
    let a = solved(&c, &s.gamma, false);
    let inertial = mechanism.mass().iter().zip(&a).map(|(m, a)| m * a);
    let rest: Vec<f64> = s.force.iter().zip(inertial).map(|(f, i)| f - i).collect();
    let lambda = solved(&c, &rest, true);
    let each = mechanism.layout().constraint_ids().map(|id| {
        let map = mechanism.reactions(&s).wrench_map(id);
        let rows = layout.groups[id.0].rows.iter();
        let own = &rows.map(|row| lambda[row]).collect::<Vec<_>>();
        [0, 1, 2].map(|i| map.row(i).iter().zip(own).map(|(w, l)| w * l).sum())
    });
    let each = each.collect();
    (q, v, each)
}

/// The largest change of each reaction due to one pair of numbers that moves by 1e-4 of the size,
/// or a direction that rotates by 1e-4 rad, as the norm of all its derivatives. The reference uses
/// central differences of mechanisms built with other numbers, at rest and moving.
#[test]
fn sensitivities_are_those_of_mechanisms_built_with_other_numbers() {
    const H: f64 = 1e-6;
    for t in [0.0, 0.35] {
        let mechanism = slider_crank(POINTS, LINE, 0.0);
        let (q, v, nominal) = reactions(&mechanism, t);
        let size = model::start::scene_size(&mechanism, &q);
        let found = known(&mechanism, t, &q, &v);
        let norm = |w: [f64; 3]| w[0].hypot(w[1]).hypot(w[2] / size);
        let difference = |plus: &Mechanism, minus: &Mechanism| -> Vec<[f64; 3]> {
            let (plus, minus) = (reactions(plus, t).2, reactions(minus, t).2);
            let both = plus.into_iter().zip(minus);
            both.map(|(a, b)| [0, 1, 2].map(|i| (a[i] - b[i]) / (2.0 * H)))
                .collect()
        };
        let mut largest = vec![0.0_f64; nominal.len()];
        for point in 0..POINTS.len() {
            let moved = |axis: usize, by: f64| {
                let mut points = POINTS;
                points[point][axis] += by;
                slider_crank(points, LINE, 0.0)
            };
            let by = [0, 1].map(|axis| difference(&moved(axis, H), &moved(axis, -H)));
            for (largest, (x, y)) in largest.iter_mut().zip(by[0].iter().zip(&by[1])) {
                *largest = largest.max(MOVED * size * norm(*x).hypot(norm(*y)));
            }
        }
        for turned in [
            |h| slider_crank(POINTS, LINE + h, 0.0),
            |h| slider_crank(POINTS, LINE, h),
        ] {
            let by = difference(&turned(H), &turned(-H));
            for (largest, by) in largest.iter_mut().zip(by) {
                *largest = largest.max(MOVED * norm(by));
            }
        }
        // The reference load: weights, and inertia forces of the bodies.
        let reference = |reaction: f64| reaction.max(load(&mechanism, t, &q, &v, size));
        for (k, sensitivity) in found.iter().enumerate() {
            let expected = largest[k] / reference(norm(nominal[k]));
            let name = &mechanism.layout().groups[k].name;
            assert!(
                (sensitivity.change / expected - 1.0).abs() < 1e-5,
                "{name} at {t}: {} instead of {expected}",
                sensitivity.change
            );
        }
    }
}

/// The largest applied or inertial force.
fn load(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64], size: f64) -> f64 {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    mechanism.twist(v, &mut s);
    mechanism.gamma(&mut s);
    mechanism.force(&mut s);
    let a = solved(&mechanism.layout().dense(&s), &s.gamma, false);
    let mut load = 0.0_f64;
    for (j, a) in a.iter().enumerate() {
        let arm = if j % 3 == 2 { size } else { 1.0 };
        load = load
            .max((mechanism.mass()[j] * a).abs() / arm)
            .max(s.force[j].abs() / arm);
    }
    load
}

/// A body between two edges whose normals differ by a small angle: without weight, a unit load is
/// used, and the reactions are proportional to the inverse of the angle.
#[test]
fn without_any_load_unit_loads_are_asked() {
    let told = |angle: f64| {
        let mut d = Description::new("edges");
        let body = d.body(Body::new("body", 1.0, 1.0));
        for (name, y, angle) in [("first", 1.0, 0.0), ("second", 1.0 + angle, angle)] {
            let normal = joints::Direction::new([f64::cos(angle), f64::sin(angle)]);
            let normal = normal.expect("a direction");
            let s = [0.0, y];
            d.joint(name, &[body], KnifeEdge { s, normal });
        }
        let mechanism = Mechanism::build(&d).expect("it builds");
        let each = known(&mechanism, 0.0, &[0.0; 3], &[0.0; 3]);
        each.iter().map(|s| s.change).collect::<Vec<_>>()
    };
    for angle in [1e-2, 1e-4] {
        let change = told(angle);
        // A direction that rotates by 1e-4 rad, or a point that moves by 1e-4, changes the angle of
        // 1e-2 or 1e-4 by the fraction 1e-4/angle.
        let share = 1e-4 / angle;
        assert!(
            change
                .iter()
                .all(|c| (0.3 * share..3.0 * share).contains(c)),
            "{angle}: {change:?}"
        );
    }
    assert!(told(0.5).iter().all(|c| *c < 1e-3));
}

/// No sensitivity is given if the rank is undecided or a reaction is not unique.
#[test]
fn nothing_is_said_of_reactions_that_are_not_unique() {
    let mut d = Description::new("door");
    d.gravity = [0.0, -10.0];
    let leaf = d.body(Body::new("leaf", 1.0, 1.0));
    for (name, y) in [("upper", 1.0), ("lower", -1.0)] {
        d.joint(
            name,
            &[BodyRef::Ground, leaf],
            Revolute {
                s_i: [0.0, y],
                s_j: [0.0, y],
            },
        );
    }
    let other = d.body(Body {
        position: [1.0, 0.0],
        ..Body::new("other", 1.0, 1.0)
    });
    d.joint(
        "pin",
        &[BodyRef::Ground, other],
        Revolute {
            s_i: [0.5, 0.0],
            s_j: [-0.5, 0.0],
        },
    );
    let mechanism = Mechanism::build(&d).expect("it builds");
    let q = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    let analysis = crate::analyse(&mechanism, 0.0, &q).expect("finite");
    let all = analysis
        .sensitivities(&mechanism, &q, &[0.0; 6])
        .expect("known");
    assert_eq!(
        all.each.iter().map(Option::is_some).collect::<Vec<_>>(),
        [false, false, true]
    );
    assert_eq!(all.fragile().count(), 0);
    let pin = all.each[2].as_ref().expect("known");
    // The joint is numbered in the whole mechanism.
    assert_eq!(pin.by.map(|by| by.joint), Some(ConstraintId(2)));
}

#[test]
fn sentences_are_for_people() {
    for (metres, text) in [
        (2.4e-4, "0.24 mm"),
        (1.234e-6, "1.2 µm"),
        (0.0123, "12 mm"),
        (3e-12, "3.0e-12 m"),
        (2.0, "2.0 m"),
    ] {
        assert_eq!(length(metres), text);
    }
    for (change, reactions, text) in [
        (0.123, 1, "changes by about 12 %"),
        (0.123, 2, "change by up to about 12 %"),
        (4.6, 1, "would change by several times its size"),
        (4.6, 3, "would change by up to several times their size"),
        (1e4, 1, "would change by many times its size"),
    ] {
        assert_eq!(told(change, reactions), text);
    }
}

/// A door in space: the hinge carries its weight and a moment of the weight times its width. What
/// one moved point changes, as a share of both, depends neither on the axes of the ground nor on
/// the unit of length.
#[test]
fn in_space_moments_are_compared_with_forces_by_the_size() {
    let turns = [
        [1.0, 0.0, 0.0, 0.0],
        [0.5, 0.5, 0.5, 0.5],
        [0.5, -0.5, -0.5, -0.5],
        [0.8, -0.4, 0.2, 0.4],
    ];
    let mut changes = Vec::new();
    // The least motion that follows the data has rotations in units of a power of two.
    for length in [1.0, 1024.0, 1.0 / 1024.0] {
        for turn in turns {
            let moved = Pose::new([0.0; 3], turn);
            let mut sketch = Sketch::at(moved);
            let door = sketch.body("door", [0.7 * length, 0.0, 0.0]);
            let own = &mut sketch.d.bodies[0];
            own.centre = [0.0; 3];
            own.position = moved.to_global([0.7 * length, 0.0, 0.0]);
            own.inertia = own.inertia.map(|row| row.map(|j| j * length * length));
            sketch.d.gravity = moved.direction_to_global([0.0, 0.0, -10.0]);
            sketch.joint("hinge", Kind::Revolute, [GROUND, door], [0.0; 3], Z);
            let mechanism = Mechanism::build(&sketch.d).expect("it builds");
            let (q, _) = mechanism.described_state();
            let found = known(&mechanism, 0.0, &q, &[0.0; 6]);
            changes.push(found[0].change);
        }
    }
    assert!(changes[0] > 1e-5 && changes[0] < 1e-2, "{changes:?}");
    let is_same = |c: &f64| (c / changes[0] - 1.0).abs() < 1e-9;
    assert!(changes.iter().all(is_same), "{changes:?}");
}

/// Of a force that calls a function no derivative is known: its sensitivities are left out with its
/// name, and the verdicts stay.
#[test]
fn a_called_force_leaves_sensitivities_unknown() {
    let mut d = Description::new("motor");
    let wheel = d.body(Body::new("wheel", 1.0, 0.1));
    let (bodies, o) = ([GROUND, wheel], [0.0, 0.0]);
    d.joint("shaft", &bodies, Revolute { s_i: o, s_j: o });
    let drive = RevoluteAngleDrive::new(o, o);
    let law = model::Law::called(|at| Ok(20.0 - 0.5 * at.rate));
    d.drive_by_law("motor", &bodies, drive, law).expect("a row");
    let mechanism = Mechanism::build(&d).expect("it builds");
    let (q, v) = ([0.0; 3], [0.0; 3]);
    let analysis = crate::analyse(&mechanism, 0.0, &q).expect("finite");
    assert!(analysis.reactions[0].wrench.verdict.is_unique());
    let all = analysis.sensitivities(&mechanism, &q, &v).expect("fits");
    assert_eq!(all.each, [None]);
    let [why] = &all.left_out[..] else {
        panic!("{:?}", all.left_out);
    };
    assert!(
        why.ends_with("drive `motor` calls a function, which has no derivatives"),
        "{why}"
    );
}
