//! Tests that count operations and show that unchanged values are not recomputed.

use std::cell::RefCell;

use joints::{Angle, Direction, Revolute, Translational, TranslationalDisplacementDrive};

use super::{System, WorkKind};
use crate::{Body, BodyRef, Description, Drive, Function, Joint, Mechanism};

thread_local! {
    /// Number of evaluations of each kind on this thread.
    pub(super) static COUNTS: RefCell<[usize; 2]> = const { RefCell::new([0; 2]) };
}

/// Counts the evaluations of one kind in `run`.
fn count(work: WorkKind, run: impl FnOnce()) -> usize {
    let now = || COUNTS.with_borrow(|counts| counts[work as usize]);
    let before = now();
    run();
    now() - before
}

fn body(name: &str) -> Body {
    Body {
        name: name.into(),
        mass: 1.0,
        inertia: 1.0,
        ..Body::default()
    }
}

const GROUND: BodyRef = BodyRef::Ground;

fn guide() -> Translational {
    Translational::new([0.0; 2], [0.0; 2], Direction::X)
}

/// A driven slider on the ground, a second body with locked rotation relative to the slider, and a
/// pendulum on the slider.
fn trolley() -> Mechanism {
    let [slider, held, bob] = [0, 1, 2].map(BodyRef::Body);
    let drive = TranslationalDisplacementDrive::new([0.0; 2], [0.0; 2], Direction::X);
    let pin = Revolute {
        s_i: [0.0; 2],
        s_j: [0.0, 1.0],
    };
    let d = Description {
        bodies: vec![body("slider"), body("held"), body("bob")],
        joints: vec![
            // This joint comes before the guide; only the guide implies that neither body rotates.
            Joint::new("hold", &[slider, held], Angle::new()),
            Joint::new("guide", &[GROUND, slider], guide()),
            Joint::new("pin", &[slider, bob], pin),
        ],
        drives: vec![Drive {
            name: "motor".into(),
            bodies: vec![GROUND, slider],
            element: Box::new(drive),
            motion: Function::harmonic(1.0, 2.0, 0.0, 0.0).expect("finite"),
            tolerance: None,
        }],
        ..Description::default()
    };
    Mechanism::build(&d).expect("builds")
}

#[test]
fn angles_that_stay_have_their_sine_and_cosine_already() {
    let m = trolley();
    let mut s = m.scratch();
    let mut q = [0.0; 9];
    (q[2], q[5], q[8]) = (0.3, 0.3, 0.1);
    assert_eq!(count(WorkKind::Trigonometry, || m.pose(0.0, &q, &mut s)), 3);
    let mut later = |s: &mut _, angle: f64| {
        (q[0], q[3], q[8]) = (0.5, 1.5, angle);
        count(WorkKind::Trigonometry, || m.pose(0.1, &q, s))
    };
    assert_eq!(later(&mut s, 0.2), 1, "only the bob has turned");
    assert_eq!(later(&mut s, 0.2), 0);
    assert_eq!(
        (s.bodies.origin(0)[0], s.bodies.axes(2)[0][1]),
        (0.5, 0.2_f64.sin())
    );
    assert_eq!(s.bodies.axes(1)[0][0], 0.3_f64.cos());
    // The value −0 differs from 0, and therefore the sine is recomputed.
    later(&mut s, 0.0);
    assert_eq!(later(&mut s, -0.0), 1);
    assert!(s.bodies.axes(2)[0][1].is_sign_negative());
}

#[test]
fn rounding_does_not_turn_what_is_held() {
    let m = trolley();
    let mut s = m.scratch();
    m.pose(0.0, &[0.0; 9], &mut s);
    let mut q = [0.0; 9];
    // Each angle changes by the rounding error of 1. The angle of the slider is fixed, but the
    // angle of the bob is not.
    (q[2], q[8]) = (f64::EPSILON, f64::EPSILON);
    assert_eq!(count(WorkKind::Trigonometry, || m.pose(0.0, &q, &mut s)), 1);
    assert_eq!(
        [s.bodies.axes(0)[0][1], s.bodies.axes(2)[0][1]],
        [0.0, f64::EPSILON]
    );
    assert_eq!(s.bodies.angle(0), f64::EPSILON, "rows of angles see it");
    // Accumulated rounding errors are detected.
    for k in 2..8 {
        q[2] = f64::EPSILON * f64::from(k);
        m.pose(0.0, &q, &mut s);
    }
    assert_eq!(s.bodies.axes(0)[0][1], 5.0 * f64::EPSILON);
    q[2] = 1e-9;
    m.pose(0.0, &q, &mut s);
    assert_eq!(s.bodies.axes(0)[0][1], 1e-9);
}

#[test]
fn functions_are_evaluated_once_at_each_time() {
    let m = trolley();
    let mut s = m.scratch();
    let mut q = [0.0; 9];
    let mut at = |t: f64| {
        q[0] += 0.1;
        count(WorkKind::Function, || m.pose(t, &q, &mut s))
    };
    assert_eq!(
        [at(0.0), at(0.0), at(0.5), at(0.5), at(0.0)],
        [1, 0, 1, 0, 1]
    );
    m.b(&mut s);
    // The row is coordinate − (f(t) − f(0)) = 0, so b = −Φt is ḟ = 2·cos(0).
    assert_eq!(s.b[m.layout().m - 1], 2.0);
}

#[test]
fn the_work_is_told_from_the_structure() {
    let work = crate::Work::of(&trolley());
    assert_eq!(work.without_turning, [0, 1]);
    // Γ is zero in the row that contains only angles; only the drive has a nonzero b.
    assert_eq!(
        (work.rows_of_gamma, work.rows_of_time, work.functions),
        (5, 1, 1)
    );
    // The row of `hold` and the row `angle` of the guide are constant. The entries for translations
    // of the pin, two in each of its rows, are constant as well.
    assert_eq!(work.entries - work.varying_entries, 2 + 1 + 4);
}

#[test]
fn rows_of_constant_entries_have_no_gamma_whatever_stood_there() {
    let m = trolley();
    let mut s = m.scratch();
    m.pose(0.0, &[0.0; 9], &mut s);
    m.twist(&[1.0; 9], &mut s);
    s.gamma.fill(7.0);
    m.gamma(&mut s);
    assert_eq!(s.gamma[0], 0.0);
}
