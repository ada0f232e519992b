//! Sensitivities, compared with manual calculations and with difference quotients.

use crate::limits::MOVED;
use joints::{Distance, KnifeEdge, Line, PointOnLine, Revolute, RevoluteAngleDrive};
use linalg::Matrix;
use model::{Body, BodyRef, ConstraintId, Description, Function, Mechanism, System};

mod fleets;
mod numbers;
mod parts;

use super::*;
use crate::sketch::{GROUND, Kind, Sketch, Z};
use crate::value::{Sensitivity, change_in_words};
use joints::space3::Pose;

/// Returns the sensitivities of all reactions. All reactions must be unique.
fn known(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Vec<Sensitivity> {
    let analysis = crate::analyse(mechanism, t, q).expect("finite");
    let all = analysis.sensitivities(mechanism, q, v).expect("fits");
    let ids = mechanism.layout().constraint_ids();
    ids.map(|id| all.reaction(id).expect("unique").clone())
        .collect()
}

/// Returns a beam of 2 m and 10 N between a pin and a roller. The distance of its mass centre from
/// the pin is a quarter of the length. The load on the roller is W·c/L.
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

/// The derivatives are dR/dL = −W·c/L², and dR/da = −W·(L − c)/L² if the pin moves along the beam.
/// This is 3/8 of the weight per metre. The point moves by 0.2 mm.
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

/// A beam on two rollers moves along the rollers with 1 m/s. Its weight is a ten-millionth of the
/// load that would stop the beam. The relative sensitivity is the same as for any other weight.
#[test]
fn a_small_load_beside_a_fast_motion_is_a_load() {
    for gravity in [10.0, 1e-7] {
        let mut d = Description::new("beam");
        d.gravity = [0.0, -gravity];
        let beam = d.body(Body {
            position: [0.5, 0.0],
            ..Body::new("beam", 1.0, 1.0)
        });
        let line = Line::new([0.0, 0.0], [2.0, 0.0]).expect("a line");
        for (name, x) in [("left", -0.5), ("right", 1.5)] {
            d.joint(name, &[beam], PointOnLine { s: [x, 0.0], line });
        }
        let mechanism = Mechanism::build(&d).expect("it builds");
        let found = known(&mechanism, 0.0, &[0.5, 0.0, 0.0], &[1.0, 0.0, 0.0]);
        for of in found {
            assert!((of.change / 7.5e-5 - 1.0).abs() < 1e-6, "{gravity}: {of:?}");
        }
    }
}

/// Data of a crank of 0.3 m with a rod of 0.8 m. The end of the rod moves on an oblique line. Each
/// pair is a point or a direction.
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

/// Returns a driven crank. The start of the crank is rotated by `turned`, so that the configuration
/// is determined at each time.
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

/// Solves `A·x = b` or `Aᵀ·x = b` by elimination with exchanges.
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

/// Returns the state and the reactions (force, torque) at a time. They are computed by Newton's
/// method from the described configuration, and from two square systems.
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

/// Computes the largest change of a component of each reaction due to one pair of numbers. The pair
/// is a point that moves by 1e-4 of the size, or a direction that rotates by 1e-4 rad. The
/// reference uses central differences of mechanisms built with other numbers, at rest and moving.
#[test]
fn sensitivities_are_those_of_mechanisms_built_with_other_numbers() {
    const H: f64 = 1e-6;
    for t in [0.0, 0.35] {
        let mechanism = slider_crank(POINTS, LINE, 0.0);
        let (q, v, nominal) = reactions(&mechanism, t);
        let size = model::start::scene_size(&mechanism, &q);
        let analysis = crate::analyse(&mechanism, t, &q).expect("finite");
        let found = analysis.sensitivities(&mechanism, &q, &v).expect("fits");
        let difference = |plus: &Mechanism, minus: &Mechanism| -> Vec<[f64; 3]> {
            let (plus, minus) = (reactions(plus, t).2, reactions(minus, t).2);
            let both = plus.into_iter().zip(minus);
            both.map(|(a, b)| [0, 1, 2].map(|i| (a[i] - b[i]) / (2.0 * H)))
                .collect()
        };
        let mut largest = vec![[0.0_f64; 3]; nominal.len()];
        for point in 0..POINTS.len() {
            let moved = |axis: usize, by: f64| {
                let mut points = POINTS;
                points[point][axis] += by;
                slider_crank(points, LINE, 0.0)
            };
            let by = [0, 1].map(|axis| difference(&moved(axis, H), &moved(axis, -H)));
            for (largest, (x, y)) in largest.iter_mut().zip(by[0].iter().zip(&by[1])) {
                for i in 0..3 {
                    largest[i] = largest[i].max(MOVED * size * x[i].hypot(y[i]));
                }
            }
        }
        for turned in [
            |h| slider_crank(POINTS, LINE + h, 0.0),
            |h| slider_crank(POINTS, LINE, h),
        ] {
            let by = difference(&turned(H), &turned(-H));
            for (largest, by) in largest.iter_mut().zip(by) {
                for i in 0..3 {
                    largest[i] = largest[i].max(MOVED * by[i].abs());
                }
            }
        }
        // The reference load consists of weights and of inertia forces of the bodies.
        let load = load(&mechanism, t, &q, &v, size);
        for id in mechanism.layout().constraint_ids() {
            let group = &mechanism.layout().groups[id.0];
            for i in group.components() {
                let unit = if i == 2 { size } else { 1.0 };
                let expected = largest[id.0][i] / nominal[id.0][i].abs().max(unit * load);
                let name = ["Fx", "Fy", "T"][i];
                let change = found.component(id, name).expect("unique").change;
                assert!(
                    (change / expected - 1.0).abs() < 1e-5,
                    "{}.{name} at {t}: {change} instead of {expected}",
                    group.name
                );
            }
        }
    }
}

/// Returns the largest applied force or inertia force.
fn load(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64], size: f64) -> f64 {
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    mechanism.c(&mut s);
    mechanism.twist(v, &mut s);
    mechanism.gamma(&mut s);
    mechanism.force(&mut s);
    let a = solved(&mechanism.layout().dense(&s), &s.gamma, false);
    let inertial: Vec<f64> = a.iter().zip(mechanism.mass()).map(|(a, m)| m * a).collect();
    let largest = |load: &[f64]| {
        let bodies = load.chunks_exact(3);
        let bodies = bodies.map(|f| f[0].hypot(f[1]).max(f[2].abs() / size));
        bodies.fold(0.0, f64::max)
    };
    largest(&inertial).max(largest(&s.force))
}

/// A body between two edges whose normals differ by a small angle. Without weight, a unit load is
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
    let known = [0, 1, 2].map(|k| all.component(ConstraintId(k), "Fy").is_some());
    assert_eq!(known, [false, false, true]);
    assert_eq!(all.fragile().count(), 0);
    let pin = all.reaction(ConstraintId(2)).expect("known");
    // The joint is numbered in the whole mechanism.
    assert_eq!(pin.by.map(|by| by.joint), Some(ConstraintId(2)));
}

#[test]
fn sentences_are_for_people() {
    for (change, reactions, text) in [
        (0.123, 1, "changes by about 12 %"),
        (0.123, 2, "change by up to about 12 %"),
        (4.6, 1, "would change by several times its size"),
        (4.6, 3, "would change by up to several times their size"),
        (1e4, 1, "would change by many times its size"),
    ] {
        assert_eq!(change_in_words(change, reactions), text);
    }
}

/// A door in space. The hinge supports the weight of the door and the moment of the weight about
/// the hinge. The change due to one moved point is expressed as a share of both, in the axes of the
/// door. This share depends neither on the axes of the ground nor on the unit of length.
#[test]
fn in_space_moments_are_compared_with_forces_by_the_size() {
    let turns = [
        [1.0, 0.0, 0.0, 0.0],
        [0.5, 0.5, 0.5, 0.5],
        [0.5, -0.5, -0.5, -0.5],
        [0.8, -0.4, 0.2, 0.4],
    ];
    let mut changes: Vec<Vec<f64>> = Vec::new();
    // The smallest motion that follows from the data has rotations in units of a power of two.
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
            sketch.joint("hinge", Kind::Revolute, [door, GROUND], [0.0; 3], Z);
            let mechanism = Mechanism::build(&sketch.d).expect("it builds");
            let (q, _) = mechanism.described_state();
            let analysis = crate::analyse(&mechanism, 0.0, &q).expect("finite");
            let number = |k| ReactionNumber::in_frame(ConstraintId(0), model::Frame::Joint, k);
            let numbers = [0, 1, 2, 3, 4, 5].map(number);
            let found = analysis.sensitivities_of(&mechanism, &q, &[0.0; 6], &numbers);
            let found = found.expect("fits").into_iter();
            changes.push(found.map(|s| s.expect("known").change).collect());
        }
    }
    let largest = changes[0].iter().copied().fold(0.0, f64::max);
    assert!(largest > 1e-5 && largest < 1e-2, "{changes:?}");
    let is_same = |(c, first): (&f64, &f64)| (c - first).abs() < 1e-8 * largest;
    let are_same = |c: &Vec<f64>| c.iter().zip(&changes[0]).all(is_same);
    assert!(changes.iter().all(are_same), "{changes:?}");
}

/// The load of a force that calls a function is constant, so no derivative of this load is needed.
/// If the force has no value, sensitivities are omitted, the reason is stated, and the verdicts do
/// not change.
#[test]
fn a_called_force_is_a_load() {
    let of = |torque: f64| {
        let mut d = Description::new("motor");
        let wheel = d.body(Body::new("wheel", 1.0, 0.1));
        let (bodies, o) = ([GROUND, wheel], [0.0, 0.0]);
        d.joint("shaft", &bodies, Revolute { s_i: o, s_j: o });
        let drive = RevoluteAngleDrive::new(o, o);
        let law = model::Law::called(move |at| Ok(torque - 0.5 * at.rate));
        d.drive_by_law("motor", &bodies, drive, law).expect("a row");
        let mechanism = Mechanism::build(&d).expect("it builds");
        let (q, v) = ([0.0; 3], [0.0; 3]);
        let analysis = crate::analyse(&mechanism, 0.0, &q).expect("finite");
        assert!(analysis.reactions[0].wrench.verdict.is_unique());
        analysis.sensitivities(&mechanism, &q, &v).expect("fits")
    };
    let all = of(20.0);
    let shaft = all.reaction(ConstraintId(0)).expect("known");
    assert!(!shaft.is_fragile() && all.left_out.is_empty(), "{all:?}");
    let all = of(f64::NAN);
    assert_eq!(all.reaction(ConstraintId(0)), None);
    let [why] = &all.left_out[..] else {
        panic!("{:?}", all.left_out);
    };
    assert!(why.ends_with("the applied forces are not finite"), "{why}");
}

/// A plate on two pins half a millimetre apart. The distance of its mass centre is one metre.
/// Neither pin is unique, but the vertical force of each pin is unique. It is W·c/e, with a
/// relative change of moved/e. The sum of the vertical forces is the weight, for any data.
#[test]
fn a_component_may_be_fragile_alone() {
    let (apart, arm, weight) = (5e-4, 1.0, 10.0);
    let mut d = Description::new("plate");
    d.gravity = [0.0, -weight];
    let plate = d.body(Body::new("plate", 1.0, 1.0));
    for (name, x) in [("far", -arm), ("near", apart - arm)] {
        let at = [x, 0.0];
        let pin = Revolute { s_i: at, s_j: at };
        d.joint(name, &[GROUND, plate], pin);
    }
    let mechanism = Mechanism::build(&d).expect("it builds");
    let (q, v) = ([0.0; 3], [0.0; 3]);
    let analysis = crate::analyse(&mechanism, 0.0, &q).expect("finite");
    let all = analysis.sensitivities(&mechanism, &q, &v).expect("fits");
    let moved = MOVED * model::start::scene_size(&mechanism, &q);
    for (k, force) in [
        (0, weight * (arm - apart) / apart),
        (1, weight * arm / apart),
    ] {
        let id = ConstraintId(k);
        assert_eq!(analysis.reactions[k].wrench.verdict.word(), "not_unique");
        assert_eq!(all.component(id, "Fx"), None);
        let found = all.component(id, "Fy").expect("unique").change;
        // The change of W·c/e due to a change of e.
        let expected = weight * arm / apart * (moved / apart) / force;
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        assert!(all.reaction(id).is_some_and(Sensitivity::is_fragile));
    }
    let sentences = all.sentences(mechanism.layout());
    assert!(
        sentences[0].starts_with("`far.Fy` and `near.Fy` are unique but"),
        "{sentences:?}"
    );
    let term = |k| crate::groups::Term {
        reaction: ConstraintId(k),
        component: "Fy".into(),
        coefficient: 1.0,
    };
    let sum = crate::groups::Group::Combination(vec![term(0), term(1)]);
    let sum = ReactionNumber::of_group(&mechanism, &sum, None).expect("names");
    let found = analysis.sensitivities_of(&mechanism, &q, &v, &[sum[0].1.clone()]);
    let found = found.expect("fits")[0].clone().expect("known");
    assert!(found.change < 1e-6, "{found:?}");
}

/// A body that is suspended from a guide and from a stiff spring with a given free length. The
/// tension of the spring is a load. The guide is determined as well as it is without the spring.
#[test]
fn a_stiff_spring_makes_no_tree_fragile() {
    for stiffness in [1e3, 1e9] {
        let mut d = Description::new("spring");
        d.gravity = [0.0, -10.0];
        let body = d.body(Body::new("body", 1.0, 1.0));
        let arm = Revolute {
            s_i: [-1.0, 0.0],
            s_j: [-1.0, 0.0],
        };
        d.joint("arm", &[GROUND, body], arm);
        let spring = joints::SpringDamper::new([1.0, 2.0], [0.5, 0.0], stiffness, 0.0);
        // The spring is stretched by a ten-thousandth of a newton per unit of stiffness.
        let length = 0.5_f64.hypot(2.0);
        let spring = spring.with_free_length(length - 10.0 / stiffness);
        d.force("spring", &[GROUND, body], spring);
        let mechanism = Mechanism::build(&d).expect("it builds");
        let each = known(&mechanism, 0.0, &[0.0; 3], &[0.0; 3]);
        assert!(each[0].change < 1e-3, "{stiffness}: {each:?}");
    }
}

/// Two bodies in free fall with a hinge between them. The reaction of the hinge is zero for any
/// position of its points.
#[test]
fn a_reaction_of_zero_does_not_change() {
    let mut d = Description::new("falling");
    d.gravity = [0.0, -10.0];
    let [a, b] = [[0.0, 0.0], [1.0, 0.3]].map(|position| {
        d.body(Body {
            position,
            ..Body::new("link", 1.0, 0.2)
        })
    });
    d.bodies[1].name = "other".into();
    let hinge = Revolute {
        s_i: [0.5, 0.1],
        s_j: [-0.5, -0.2],
    };
    d.joint("hinge", &[a, b], hinge);
    let mechanism = Mechanism::build(&d).expect("it builds");
    let (q, _) = mechanism.described_state();
    let each = known(&mechanism, 0.0, &q, &[0.0; 6]);
    assert!(each[0].change < 1e-12, "{each:?}");
}

/// A bob on two bars of length ℓ hangs lower than the pins of the bars by s. Each bar carries
/// m·g·ℓ/(2·s), and s² = ℓ² − c² for pins at a distance of 2·c. If a pin moves by 0.2 mm, the force
/// of bars with a sag of 3.5 cm increases by 9.3 %. The first order gives 8.2 %.
#[test]
fn near_its_limit_a_reaction_changes_by_more_than_first_order() {
    for sag in [0.033, 0.034, 0.035] {
        let mut d = Description::new("bob");
        d.gravity = [0.0, -10.0];
        let bob = d.body(Body {
            position: [0.0, -sag],
            ..Body::new("bob", 1.0, 0.1)
        });
        for (name, x) in [("left", -1.0), ("right", 1.0)] {
            let bar = Distance::new([x, 0.0], [0.0; 2]);
            d.joint(name, &[GROUND, bob], bar);
        }
        let mechanism = Mechanism::build(&d).expect("it builds");
        let found = known(&mechanism, 0.0, &[0.0, -sag, 0.0], &[0.0; 3]);
        let by = found[0].by.as_ref().expect("a point moves it");
        let square = |c: f64| 1.0 + sag * sag - c * c;
        let carried = |square: f64| 5.0 * (1.0 + sag * sag).sqrt() / square.sqrt();
        let now = carried(square(1.0));
        let then = carried(square(1.0 + 0.5 * by.moved));
        let (expected, first) = (then / now - 1.0, by.moved / (2.0 * sag * sag));
        let change = found[0].change;
        assert!(expected > 1.05 * first, "{sag}: {expected} {first}");
        assert!(
            (change / expected - 1.0).abs() < 2e-2,
            "{sag}: {change} instead of {expected}, {first} to first order"
        );
    }
}
