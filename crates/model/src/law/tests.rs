//! Values and derivatives of force laws and of the resulting forces, compared with manual
//! calculations and with difference quotients.

use joints::generated::{DistanceLengthDrive, RevoluteAngleDrive, TranslationalDisplacementDrive};
use joints::{Argument, Constraint, Pose, Twist};

use super::*;
use crate::element::ForceKernels;

use {Join as J, UnaryFunction as F};
use {Operation::Apply, Operation::Measure, Operation::Number as N, Operation::Rate};

fn law(operations: &[Operation]) -> Law {
    Law::new(operations).expect("complete")
}

#[test]
fn every_function_has_its_value_and_its_derivative() {
    let third = 3.0_f64.sqrt() / 2.0;
    // Columns: f at the joint coordinate, value, derivative.
    let of_one = [
        (F::Negate, 2.0, -2.0, -1.0),
        (F::Whole(3), 2.0, 8.0, 12.0),
        (F::Whole(-2), 2.0, 0.25, -0.25),
        (F::Whole(0), 2.0, 1.0, 0.0),
        (F::Root, 4.0, 2.0, 0.25),
        (F::Abs, -3.0, 3.0, -1.0),
        (F::Sin, 0.0, 0.0, 1.0),
        (F::Cos, 0.0, 1.0, 0.0),
        (F::Tan, 0.0, 0.0, 1.0),
        (F::Asin, 0.5, 0.5_f64.asin(), 1.0 / third),
        (F::Acos, 0.5, 0.5_f64.acos(), -1.0 / third),
        (F::Atan, 1.0, 1.0_f64.atan(), 0.5),
        (F::Exp, 0.0, 1.0, 1.0),
        (F::Log, 2.0, 2.0_f64.ln(), 0.5),
        // The derivative is not finite and is therefore replaced by zero.
        (F::Root, 0.0, 0.0, 0.0),
    ];
    for (f, at, value, slope) in of_one {
        let found = law(&[Measure, Apply(f)]).slopes(at, 9.0, 9.0);
        let [v, by_measure, by_rate] = found.expect("defined");
        assert!((v - value).abs() < 1e-15, "{f:?}: {v}");
        assert!((by_measure - slope).abs() < 1e-15, "{f:?}: {by_measure}");
        assert_eq!(by_rate, 0.0);
    }
    // Columns: j of joint coordinate 2 and rate 4, the value, and both derivatives.
    let ln = 2.0_f64.ln();
    let of_two = [
        (J::Add, 6.0, [1.0, 1.0]),
        (J::Subtract, -2.0, [1.0, -1.0]),
        (J::Multiply, 8.0, [4.0, 2.0]),
        (J::Divide, 0.5, [0.25, -0.125]),
        (J::Power, 16.0, [32.0, 16.0 * ln]),
        (J::Angle, 0.5_f64.atan(), [0.2, -0.1]),
        (J::Least, 2.0, [1.0, 0.0]),
        (J::Largest, 4.0, [0.0, 1.0]),
    ];
    for (j, value, by) in of_two {
        let found = law(&[Measure, Rate, Operation::Join(j)]).slopes(2.0, 4.0, 0.0);
        let found = found.expect("defined");
        for (found, expected) in found.into_iter().zip([value, by[0], by[1]]) {
            assert!(
                (found - expected).abs() < 1e-14,
                "{j:?}: {found}, {expected}"
            );
        }
    }
}

#[test]
fn what_has_no_value_is_named() {
    let told = |operations: &[Operation], at: f64| {
        let found = law(operations).value(at, 0.0, 0.0);
        found.expect_err("not defined").to_string()
    };
    let quotient = [N(1.0), Measure, Operation::Join(J::Divide)];
    assert_eq!(told(&quotient, 0.0), "division by zero");
    assert_eq!(told(&[Measure, Apply(F::Log)], -1.0), "log(-1)");
    assert_eq!(told(&[Measure, Apply(F::Root)], -2.5), "sqrt(-2.5)");
    assert_eq!(told(&[Measure, Apply(F::Exp)], 1e3), "exp(1000)");
    // The error also occurs if a later operation makes the value finite again.
    let hidden = [&quotient[..], &[Apply(F::Atan)]].concat();
    assert_eq!(told(&hidden, 0.0), "division by zero");
}

#[test]
fn operations_that_leave_no_number_are_refused() {
    let left = |operations: &[Operation]| Law::new(operations).expect_err("incomplete");
    assert_eq!(left(&[]), LawError::Incomplete { left: 0 });
    assert_eq!(left(&[N(1.0), N(2.0)]), LawError::Incomplete { left: 2 });
    assert_eq!(
        left(&[Operation::Join(J::Add)]),
        LawError::Incomplete { left: 0 }
    );
    assert_eq!(left(&[N(1.0); 65]), LawError::Deep);
}

/// `−3·measure³ + rate·(2 − measure) + t`
fn some_law() -> Law {
    let join = Operation::Join;
    law(&[
        N(-3.0),
        Measure,
        Apply(F::Whole(3)),
        join(J::Multiply),
        Rate,
        N(2.0),
        Measure,
        join(J::Subtract),
        join(J::Multiply),
        join(J::Add),
        Operation::Time,
        join(J::Add),
    ])
}

fn force<K: Constraint>(law: Law, arguments: &[Argument], start: &[Pose]) -> Box<dyn ForceKernels> {
    let mut force = {
        let drive = K::from_arguments(arguments).expect("its arguments");
        law_drive::<K, joints::Plane>(drive, law).expect("a row and two bodies")
    };
    force.initialise(start);
    force
}

const TIME: [[f64; 3]; 1] = [[0.5, 1.0, 0.0]];

fn at_start() -> [Pose; 2] {
    [Pose::new(0.3, -0.2, 0.4), Pose::new(1.1, 0.7, -0.9)]
}

/// The three kinds of joint coordinates, each at a value that differs from its initial value.
fn forces() -> [Box<dyn ForceKernels>; 3] {
    let pair = |x, y| Argument::Pair([x, y]);
    let (s_i, s_j, axis) = (pair(0.2, 0.1), pair(-0.3, 0.4), pair(0.6, 0.8));
    let points = [s_i.clone(), s_j.clone(), Argument::Absent];
    let along = [s_i, s_j, axis, Argument::Absent];
    let (law, start) = (some_law(), at_start());
    [
        force::<RevoluteAngleDrive>(law.clone(), &points, &start),
        force::<TranslationalDisplacementDrive>(law.clone(), &along, &start),
        force::<DistanceLengthDrive>(law, &points, &start),
    ]
}

/// Manual calculation: two points on the x axis have a distance of 2 at the start and 3 now. The
/// distance grows at a rate of 0.5. The force is −3·27 + 0.5·(2 − 3) + 0.5 = −81, so the points
/// attract each other.
#[test]
fn a_law_of_a_length_acts_along_it() {
    let origin = Argument::Pair([0.0; 2]);
    let arguments = [origin.clone(), origin, Argument::Absent];
    let start = [Pose::GROUND, Pose::new(2.0, 0.0, 0.0)];
    let force = force::<DistanceLengthDrive>(some_law(), &arguments, &start);
    let x = [Pose::GROUND, Pose::new(3.0, 0.0, 0.0)];
    let v = [
        Twist::zero(),
        Twist {
            x: 0.5,
            y: 7.0,
            omega: 2.0,
        },
    ];
    let mut q = [0.0; 6];
    force.q(&x, &v, &TIME, &mut q);
    let expected = [81.0, 0.0, 0.0, -81.0, 0.0, 0.0];
    for (found, expected) in q.into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-13, "{q:?}");
    }
    let found = force.drive(&x, &v, &TIME).expect("a law");
    assert!((found.measure - 3.0).abs() < 1e-15 && (found.rate - 0.5).abs() < 1e-15);
    // At distance zero, the direction is not defined.
    force.q(&[Pose::GROUND; 2], &v, &TIME, &mut q);
    let why = force.drive(&[Pose::GROUND; 2], &v, &TIME).expect("a law");
    assert!(q[3].is_nan() && why.force == Err(UndefinedValue::Input));
}

/// Central differences with h = 1e-5. The error is h² plus the rounding error divided by h.
#[test]
fn derivatives_of_the_force_agree_with_differences() {
    const H: f64 = 1e-5;
    let x = [Pose::new(-0.4, 0.9, 1.2), Pose::new(0.8, 0.1, 0.3)];
    let twist = |x, y, omega| Twist { x, y, omega };
    let v = [twist(0.3, -0.5, 0.7), twist(-0.2, 0.4, 1.1)];
    for (which, force) in forces().iter().enumerate() {
        let spec = force.spec();
        let q = |x: &[Pose; 2], v: &[Twist; 2]| {
            let mut q = [0.0; 6];
            force.q(x, v, &TIME, &mut q);
            q
        };
        let (mut by_x, mut by_v) = ([0.0; 36], [0.0; 36]);
        force.dq_dx(&x, &v, &TIME, &mut by_x);
        force.dq_dv(&x, &v, &TIME, &mut by_v);
        assert_eq!(
            (spec.q.len(), spec.dq_dx.len(), spec.dq_dv.len()),
            (6, 36, 36)
        );
        for (k, &[row, column]) in spec.dq_dx.iter().enumerate() {
            let moved = |h: f64| {
                let (mut x, mut v) = (x, v);
                let body = &mut x[column / 3];
                let d = [0, 1, 2].map(|dof| if dof == column % 3 { h } else { 0.0 });
                *body = Pose::new(body.x + d[0], body.y + d[1], body.angle + d[2]);
                let body = &mut v[column / 3];
                *body = twist(body.x + d[0], body.y + d[1], body.omega + d[2]);
                (x, v)
            };
            let slope = |f: &dyn Fn(f64) -> f64| (f(H) - f(-H)) / (2.0 * H);
            let of_x = slope(&|h| q(&moved(h).0, &v)[row]);
            let of_v = slope(&|h| q(&x, &moved(h).1)[row]);
            assert!(
                (of_x - by_x[k]).abs() < 1e-7,
                "{which} x {row} {column}: {of_x} {}",
                by_x[k]
            );
            assert!(
                (of_v - by_v[k]).abs() < 1e-7,
                "{which} v {row} {column}: {of_v} {}",
                by_v[k]
            );
        }
    }
}

/// The function `−3·measure³ + rate·(2 − measure) + t` as a callback.
fn some_function() -> Law {
    Law::called(|at| {
        let DriveState {
            time,
            measure,
            rate,
        } = *at;
        Ok(-3.0 * measure.powi(3) + rate * (2.0 - measure) + time)
    })
}

#[test]
fn a_called_function_makes_the_force_of_the_same_text() {
    let x = [Pose::new(-0.4, 0.9, 1.2), Pose::new(0.8, 0.1, 0.3)];
    let twist = |x, y, omega| Twist { x, y, omega };
    let v = [twist(0.3, -0.5, 0.7), twist(-0.2, 0.4, 1.1)];
    for written in forces() {
        let called = written.with_law(&some_function()).expect("a law");
        assert!(called.is_law() && called.is_called() && !written.is_called());
        let (mut found, mut expected) = ([0.0; 6], [0.0; 6]);
        called.q(&x, &v, &TIME, &mut found);
        written.q(&x, &v, &TIME, &mut expected);
        for (found, expected) in found.into_iter().zip(expected) {
            // The products are computed in another order.
            assert!((found - expected).abs() < 1e-14 * expected.abs().max(1.0));
        }
        let mut slopes = [0.0; 36];
        called.dq_dx(&x, &v, &TIME, &mut slopes);
        assert!(slopes.iter().all(|slope| slope.is_nan()));
        called.dq_dv(&x, &v, &TIME, &mut slopes);
        assert!(slopes.iter().all(|slope| slope.is_nan()));
    }
}

#[test]
fn what_a_function_does_not_give_is_named() {
    let value = |law: &Law| law.value(0.5, 0.0, 1.0);
    let no_number = value(&Law::called(|_| Ok(f64::NAN))).expect_err("not finite");
    assert_eq!(no_number.to_string(), "its function returned NaN");
    assert!(no_number.is_of_function());
    let infinite = value(&Law::called(|at| Ok(1.0 / (at.measure - 0.5))));
    assert_eq!(infinite, Err(UndefinedValue::Returned("inf".to_owned())));
    let failed = value(&Law::called(|_| Err("no sensor".into())));
    assert_eq!(failed, Err(UndefinedValue::Failed("no sensor".to_owned())));
    let law = some_function();
    assert_eq!(law.slopes(0.5, 0.0, 1.0), Err(UndefinedValue::ValueAlone));
    assert_eq!(law.value(f64::NAN, 0.0, 1.0), Err(UndefinedValue::Input));
    assert!(law == law.clone() && law != some_function());
}

/// If the law uses the change since the start, its replacement also uses this change.
#[test]
fn a_law_is_replaced_on_its_measure() {
    let origin = Argument::Pair([0.0; 2]);
    let arguments = [origin.clone(), origin, Argument::Absent];
    let start = [Pose::GROUND, Pose::new(2.0, 0.0, 0.0)];
    let written = some_law().since_start();
    let called = force::<DistanceLengthDrive>(written, &arguments, &start)
        .with_law(&some_function())
        .expect("a law");
    let x = [Pose::GROUND, Pose::new(3.0, 0.0, 0.0)];
    let found = called.drive(&x, &[Twist::zero(); 2], &TIME);
    let found = found.expect("a law");
    // The force is −3·1³ + 0.5.
    assert!((found.measure - 1.0).abs() < 1e-15 && found.force == Ok(-2.5));
}
