//! Tests whether a motion is blocked, or has a bifurcation. The tips of horizontal parallel cranks,
//! of length L and at distance d, move across the line at v_k. Two neighbours under one coupler
//! require `(v₂ − v₁)·[(v₂ + v₁)/L − (v₂ − v₁)/d] = 0`, derived by hand.

use joints::RevoluteAngleDrive;
use linalg::Matrix;
use model::{BodyRef, Description, Drive, Function, Mechanism, System};
use solvability::{Continuation, SecondOrderDoubt, decide, is_locked, second_order};
use tests::cranks::cranks;
use tests::{largest, revolute, rod};

const LENGTH: f64 = 0.5;
const PITCH: f64 = 1.0;

/// The ratio v₂/v₁ of two horizontal cranks on the branch that is not parallel.
const RATIO: f64 = (LENGTH + PITCH) / (LENGTH - PITCH);

fn driven(mut d: Description, rate: f64) -> Description {
    let element = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    d.drives.push(Drive {
        tolerance: None,
        name: "motor".into(),
        bodies: vec![BodyRef::Ground, BodyRef::Body(0)],
        element: Box::new(element),
        motion: Function::constant_rate(rate).expect("finite"),
    });
    d
}

/// The mechanism has n + 1 horizontal cranks, and each pair of neighbours has its own coupler.
fn four_bars(n: usize) -> Description {
    let x = |k: usize| PITCH * k as f64;
    let tip = |k: usize| [x(k) + LENGTH, 0.0];
    let mut bodies: Vec<_> = (0..=n)
        .map(|k| rod(&format!("crank {k}"), 1.0, [x(k), 0.0], tip(k)))
        .collect();
    bodies.extend((0..n).map(|k| rod(&format!("coupler {k}"), 1.0, tip(k), tip(k + 1))));
    let body = BodyRef::Body;
    let mut joints: Vec<_> = (0..=n)
        .map(|k| {
            revolute(
                &format!("pivot {k}"),
                &bodies,
                [BodyRef::Ground, body(k)],
                [x(k), 0.0],
            )
        })
        .collect();
    for k in 0..n {
        let coupler = body(n + 1 + k);
        let [left, right] = [k, k + 1].map(|c| {
            revolute(
                &format!("tip {c} of {k}"),
                &bodies,
                [body(c), coupler],
                tip(c),
            )
        });
        joints.extend([left, right]);
    }
    Description {
        name: "four-bars".into(),
        bodies,
        joints,
        ..Description::default()
    }
}

/// All bodies move in parallel with the cranks at this rate; the cranks come first.
fn parallel(d: &Description, n_cranks: usize, rate: f64) -> Vec<f64> {
    let tip = rate * LENGTH;
    let crank = [0.0, 0.5 * tip, rate];
    let of = |k| if k < n_cranks { crank } else { [0.0, tip, 0.0] };
    (0..d.bodies.len()).flat_map(of).collect()
}

/// Returns the result of the second-order test at the singular configuration for the parallel
/// motion, with the rank there.
fn at_flat(d: &Description, n_cranks: usize, regular: &[Vec<f64>]) -> (usize, Continuation) {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let decision = decide(&mechanism, &s, &q).expect("finite");
    assert!(decision.is_decided());
    let v = parallel(d, n_cranks, 2.0);
    let columns = Matrix::from_fn(q.len(), regular.len(), |i, j| regular[j][i]);
    let found = second_order(&mechanism, 0.0, &q, &v, &decision, &columns).expect("a state");
    (decision.redundancy, found)
}

/// Rates of the cranks on each branch.
fn branches(found: Continuation, n_cranks: usize) -> Vec<Vec<f64>> {
    let Continuation::Bifurcation { branches } = found else {
        panic!("a bifurcation, not {found:?}");
    };
    let rates = |v: &Vec<f64>| -> Vec<f64> { (0..n_cranks).map(|k| v[3 * k + 2]).collect() };
    branches.iter().map(rates).collect()
}

#[test]
fn three_cranks_are_blocked() {
    let d = cranks(&[0.0, PITCH, 1.7], LENGTH, 0.0);
    let v = parallel(&d, 3, 1.0);
    assert_eq!(at_flat(&d, 3, &[v]), (2, Continuation::Unique));
    assert_eq!(at_flat(&driven(d, 2.0), 3, &[]), (2, Continuation::Unique));
}

#[test]
fn five_cranks_are_blocked() {
    let d = cranks(&[0.0, PITCH, 1.7, 2.1, 3.0], LENGTH, 0.0);
    let v = parallel(&d, 5, 1.0);
    assert_eq!(at_flat(&d, 5, &[v]), (4, Continuation::Unique));
}

#[test]
fn two_cranks_bifurcate() {
    let d = cranks(&[0.0, PITCH], LENGTH, 0.0);
    let v = parallel(&d, 2, 1.0);
    let (redundancy, found) = at_flat(&d, 2, &[v]);
    assert_eq!(redundancy, 1);
    let [rates] = branches(found, 2).try_into().expect("one other branch");
    assert!((rates[1] / rates[0] - RATIO).abs() < 1e-12, "{rates:?}");

    let (_, found) = at_flat(&driven(d, 2.0), 2, &[]);
    let [rates] = branches(found, 2).try_into().expect("one other branch");
    assert!(
        largest([rates[0] - 2.0, rates[1] - 2.0 * RATIO]) < 1e-12,
        "{rates:?}"
    );
}

/// Each coupler may choose its branch independently: 2ⁿ branches, one of them parallel.
#[test]
fn a_row_of_four_bars_bifurcates_at_each_coupler() {
    for n in 1..=3 {
        let d = driven(four_bars(n), 2.0);
        let (redundancy, found) = at_flat(&d, n + 1, &[]);
        assert_eq!(redundancy, n);
        let expected: Vec<Vec<f64>> = (1..1 << n)
            .map(|choice: usize| {
                let factor = |k: usize| if choice >> k & 1 == 1 { RATIO } else { 1.0 };
                let grow = |rate: &mut f64, k| {
                    let now = *rate;
                    *rate *= if k < n { factor(k) } else { 1.0 };
                    Some(now)
                };
                (0..=n).scan(2.0, grow).collect()
            })
            .collect();
        let found = branches(found, n + 1);
        assert_eq!(found.len(), expected.len());
        for rates in expected {
            let distance = |f: &Vec<f64>| largest(f.iter().zip(&rates).map(|(f, r)| f - r));
            assert!(
                found.iter().any(|f| distance(f) < 1e-11),
                "{rates:?} in {found:?}"
            );
        }
    }
}

#[test]
fn what_is_not_decided_is_said() {
    let d = driven(four_bars(5), 2.0);
    let reason = SecondOrderDoubt::Kernel { found: 5, most: 4 };
    assert_eq!(at_flat(&d, 6, &[]), (5, Continuation::Undetermined(reason)));
    // The motion cannot continue.
    let d = cranks(&[0.0, PITCH], LENGTH, 0.0);
    let mut v = parallel(&d, 2, 1.0);
    (v[4], v[5], v[7], v[8]) = (0.5, 2.0, 0.75, 0.5);
    let (_, found) = at_flat(&d, 2, &[v]);
    assert!(
        matches!(
            found,
            Continuation::Undetermined(SecondOrderDoubt::Irregular { .. })
        ),
        "{found:?}"
    );
}

/// A triangle of rods cannot move: rest is its only velocity.
#[test]
fn what_has_no_freedom_stands_still() {
    let d = chain(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]);
    let mechanism = Mechanism::build(&d).expect("builds");
    let (q, _) = mechanism.described_state();
    let mut s = mechanism.scratch();
    mechanism.pose(0.0, &q, &mut s);
    mechanism.phi(&mut s);
    mechanism.c(&mut s);
    let decision = decide(&mechanism, &s, &q).expect("finite");
    assert_eq!((decision.rank, decision.redundancy), (6, 0));
    let (rest, none) = (vec![0.0; 6], Matrix::zeros(6, 0));
    let found = second_order(&mechanism, 0.0, &q, &rest, &decision, &none);
    assert_eq!(found.expect("a state"), Continuation::Unique);
}

/// Rods connect pivots end to end, with joints at these positions.
fn chain(places: &[[f64; 2]]) -> Description {
    let links = places.len() - 1;
    let rods = places.windows(2).enumerate();
    let bodies: Vec<_> = rods
        .map(|(k, ends)| rod(&format!("rod {k}"), 1.0, ends[0], ends[1]))
        .collect();
    let before = |k: usize| match k {
        0 => BodyRef::Ground,
        k => BodyRef::Body(k - 1),
    };
    let after = |k: usize| {
        if k == links {
            BodyRef::Ground
        } else {
            BodyRef::Body(k)
        }
    };
    let joint = |(k, at): (usize, &[f64; 2])| {
        revolute(&format!("pin {k}"), &bodies, [before(k), after(k)], *at)
    };
    let joints = places.iter().enumerate().map(joint).collect();
    Description {
        bodies,
        joints,
        ..Description::default()
    }
}

/// A straight chain between two pivots has only an infinitesimal motion, with any number of pins:
/// in a finite motion it would have to become longer.
#[test]
fn what_cannot_go_on_at_second_order_is_locked() {
    let locked = |d: &Description| {
        let mechanism = Mechanism::build(d).expect("builds");
        let (q, _) = mechanism.described_state();
        let mut s = mechanism.scratch();
        mechanism.pose(0.0, &q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        let decision = decide(&mechanism, &s, &q).expect("finite");
        let found = is_locked(&mechanism, 0.0, &q, &decision).expect("a configuration");
        found.expect("second order decides")
    };
    let x = |x: f64| [x, 0.0];
    assert!(locked(&chain(&[x(0.0), x(1.0), x(2.5)])));
    assert!(locked(&chain(&[x(0.0), x(1.0), x(2.5), x(3.0)])));
    // With a rod that points back, the chain can open.
    assert!(!locked(&chain(&[x(0.0), x(1.0), x(0.4), x(0.9)])));
    // One chain has no degree of freedom, and one has a finite motion.
    assert!(!locked(&chain(&[x(0.0), [1.0, 1.0], x(2.0)])));
    assert!(!locked(&chain(&[x(0.0), [0.0, 1.0], [1.0, 1.0], x(1.0)])));
    assert!(!locked(&cranks(&[0.0, PITCH], LENGTH, 0.0)));
}
