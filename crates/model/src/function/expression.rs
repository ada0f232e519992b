//! Functions of time that are lists of operations, with two derivatives.

use crate::law::number::{LawNumber, Smooth};
use crate::law::program::Program;
use crate::law::{Join, LawError, Operation, UnaryFunction};

/// A function of time as a list of operations.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Expression(Program);

impl Expression {
    /// Checks that the operations have one result, and that time is their only variable.
    pub(super) fn new(operations: &[Operation]) -> Result<Self, LawError> {
        let is_other =
            |o: &Operation| matches!(o, Operation::Measure | Operation::Rate | Operation::Keep(_));
        if operations.iter().any(is_other) {
            return Err(LawError::Variable);
        }
        Program::new(operations).map(Self)
    }

    pub(super) fn operations(&self) -> &[Operation] {
        self.0.operations()
    }

    /// Returns the value, the rate and the second derivative, or NaN if the function has no value
    /// at this time.
    pub(super) fn jet(&self, t: f64) -> [f64; 3] {
        let inputs = [Jet::from(0.0), Jet::from(0.0), Jet([t, 1.0, 0.0])];
        let value = self.0.evaluate(inputs, |_, _| Jet::from(f64::NAN));
        value.map_or([f64::NAN; 3], |jet| jet.0)
    }

    pub(super) fn is_constant(&self) -> bool {
        !self.operations().contains(&Operation::Time)
    }

    /// Returns whether the value and the first two derivatives are continuous at all times at which
    /// the function has a value.
    pub(super) fn is_smooth(&self) -> bool {
        self.operations().iter().all(|operation| {
            !matches!(
                operation,
                Operation::Apply(UnaryFunction::Abs)
                    | Operation::Join(Join::Angle | Join::Least | Join::Largest)
            )
        })
    }
}

/// A value with its first two derivatives with respect to time.
#[derive(Clone, Copy)]
struct Jet([f64; 3]);

impl From<f64> for Jet {
    fn from(x: f64) -> Self {
        Self([x, 0.0, 0.0])
    }
}

impl Jet {
    fn is_constant(self) -> bool {
        self.0[1..] == [0.0; 2]
    }

    /// Returns g(x), where `value` is g and `first` and `second` are the first two derivatives of g
    /// at this number.
    fn chain(self, value: f64, first: f64, second: f64) -> Self {
        // A constant has no derivatives, even if the derivatives of g are infinite.
        if self.is_constant() {
            return value.into();
        }
        let [_, d, dd] = self.0;
        Self([value, first * d, second * d * d + first * dd])
    }
}

/// Returns the second derivative of a function at `a`. The first derivative at `a` is `first`.
fn curvature(f: UnaryFunction, a: f64, first: f64) -> f64 {
    match f {
        UnaryFunction::Negate | UnaryFunction::Abs | UnaryFunction::Whole(0 | 1) => 0.0,
        UnaryFunction::Whole(n) => f64::from(n) * a.slope(UnaryFunction::Whole(n - 1)),
        UnaryFunction::Root => -first / (2.0 * a),
        UnaryFunction::Sin => -a.sin(),
        UnaryFunction::Cos => -a.cos(),
        UnaryFunction::Tan => 2.0 * a.tan() * first,
        UnaryFunction::Asin | UnaryFunction::Acos => a * first.powi(3),
        UnaryFunction::Atan => -2.0 * a * first.powi(2),
        UnaryFunction::Exp => a.exp(),
        UnaryFunction::Log => -first.powi(2),
    }
}

impl LawNumber for Jet {
    fn number(self) -> Option<f64> {
        Some(self.0[0])
    }

    fn apply(self, f: UnaryFunction) -> Self {
        let [a, ..] = self.0;
        let first = a.slope(f);
        self.chain(a.apply(f), first, curvature(f, a, first))
    }

    fn join(self, j: Join, other: Self) -> Self {
        let ([a, da, dda], [b, db, ddb]) = (self.0, other.0);
        let value = a.join(j, b);
        match j {
            Join::Add => Self([value, da + db, dda + ddb]),
            Join::Subtract => Self([value, da - db, dda - ddb]),
            Join::Multiply => Self([value, da * b + a * db, dda * b + 2.0 * da * db + a * ddb]),
            Join::Divide => {
                let d = (da - value * db) / b;
                Self([value, d, (dda - 2.0 * d * db - value * ddb) / b])
            }
            Join::Power if other.is_constant() => {
                let first = b * a.powf(b - 1.0);
                self.chain(value, first, b * (b - 1.0) * a.powf(b - 2.0))
            }
            // aᵇ = exp(b·log a)
            Join::Power => {
                let log = self.apply(UnaryFunction::Log);
                other.join(Join::Multiply, log).apply(UnaryFunction::Exp)
            }
            Join::Angle => {
                let square = a * a + b * b;
                let d = (b * da - a * db) / square;
                let turned = (b * dda - a * ddb) / square;
                Self([value, d, turned - 2.0 * d * (a * da + b * db) / square])
            }
            Join::Least if a < b => self,
            Join::Largest if a > b => self,
            Join::Least | Join::Largest => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{E, LN_2, PI};

    use super::*;
    use crate::Function;

    use Operation::{Number as N, Time};
    use {Join as J, UnaryFunction as F};

    /// Rounding of a few operations.
    const ROUNDING: f64 = 1e-14;

    fn jet(operations: &[Operation], t: f64) -> [f64; 3] {
        Function::expression(operations).expect("complete").jet(t)
    }

    #[track_caller]
    fn near(found: [f64; 3], expected: [f64; 3], what: &str) {
        for (found, expected) in found.iter().zip(expected) {
            let bound = ROUNDING * expected.abs().max(1.0);
            assert!(
                (found - expected).abs() <= bound,
                "{what}: {found} {expected}"
            );
        }
    }

    /// Closed forms of f(t²) and its derivatives: f'·2t and f''·4t² + 2f'.
    #[test]
    fn every_function_has_two_derivatives() {
        let root = 3.0_f64.sqrt();
        // Columns: t, f, f' and f'' at t².
        for (f, t, value, first, second) in [
            (F::Negate, 2.0, -4.0, -1.0, 0.0),
            (F::Whole(0), 2.0, 1.0, 0.0, 0.0),
            (F::Whole(1), 2.0, 4.0, 1.0, 0.0),
            (F::Whole(3), 2.0, 64.0, 48.0, 24.0),
            (F::Whole(-1), 2.0, 0.25, -1.0 / 16.0, 1.0 / 32.0),
            (F::Whole(-2), 1.0, 1.0, -2.0, 6.0),
            (F::Root, 2.0, 2.0, 0.25, -1.0 / 32.0),
            (F::Abs, 2.0, 4.0, 1.0, 0.0),
            (F::Sin, (PI / 6.0).sqrt(), 0.5, root / 2.0, -0.5),
            (F::Cos, (PI / 6.0).sqrt(), root / 2.0, -0.5, -root / 2.0),
            (F::Tan, (PI / 4.0).sqrt(), 1.0, 2.0, 4.0),
            (
                F::Asin,
                0.5_f64.sqrt(),
                PI / 6.0,
                2.0 / root,
                4.0 / (3.0 * root),
            ),
            (
                F::Acos,
                0.5_f64.sqrt(),
                PI / 3.0,
                -2.0 / root,
                -4.0 / (3.0 * root),
            ),
            (F::Atan, 1.0, PI / 4.0, 0.5, -0.5),
            (F::Exp, 1.0, E, E, E),
            (F::Log, 2.0_f64.sqrt(), LN_2, 0.5, -0.25),
        ] {
            let found = jet(
                &[Time, Operation::Apply(F::Whole(2)), Operation::Apply(f)],
                t,
            );
            let expected = [value, first * 2.0 * t, second * 4.0 * t * t + 2.0 * first];
            near(found, expected, &format!("{f:?}"));
        }
    }

    /// Closed forms for a = t² and b = t³ at t = 2: a = 4, 4, 2 and b = 8, 12, 12.
    #[test]
    fn every_combination_has_two_derivatives() {
        let power = 2.0_f64.powi(16); // t^(2t³)
        // log(t^(2t³)) = 2t³·log t, with the derivatives 6t²·log t + 2t² and 12t·log t + 10t.
        let log = [24.0 * LN_2 + 8.0, 24.0 * LN_2 + 20.0];
        for (j, expected) in [
            (J::Add, [12.0, 16.0, 14.0]),
            (J::Subtract, [-4.0, -8.0, -10.0]),
            (J::Multiply, [32.0, 80.0, 160.0]), // t⁵
            (J::Divide, [0.5, -0.25, 0.25]),    // 1/t
            (
                J::Power,
                [power, power * log[0], power * (log[1] + log[0] * log[0])],
            ),
            // atan2(t², t³) = atan(1/t), with the derivatives −1/(1 + t²) and 2t/(1 + t²)².
            (J::Angle, [0.5_f64.atan(), -0.2, 0.16]),
            (J::Least, [4.0, 4.0, 2.0]),
            (J::Largest, [8.0, 12.0, 12.0]),
        ] {
            let [a, b] = [2, 3].map(|n| [Time, Operation::Apply(F::Whole(n))]);
            let operations = [&a[..], &b[..], &[Operation::Join(j)]].concat();
            near(jet(&operations, 2.0), expected, &format!("{j:?}"));
        }
        // A constant exponent, also at a zero base: t^1.5 and (t²)^2.5 = t⁵.
        let power = |n: f64| [Time, N(n), Operation::Join(J::Power)];
        near(jet(&power(1.5), 4.0), [8.0, 3.0, 0.375], "t^1.5");
        near(jet(&power(2.5), 0.0), [0.0; 3], "0^2.5");
        // A constant base: 2^t.
        let exponential = [N(2.0), Time, Operation::Join(J::Power)];
        near(
            jet(&exponential, 1.0),
            [2.0, 2.0 * LN_2, 2.0 * LN_2 * LN_2],
            "2^t",
        );
    }

    #[test]
    fn a_function_may_have_no_value() {
        assert!(jet(&[Time, Operation::Apply(F::Log)], -1.0)[0].is_nan());
        let quotient = [N(1.0), Time, Operation::Join(J::Divide)];
        assert!(jet(&quotient, 0.0)[0].is_nan());
        // The root has a value at zero, but no rate.
        let [value, rate, _] = jet(&[Time, Operation::Apply(F::Root)], 0.0);
        assert_eq!((value, rate.is_finite()), (0.0, false));
        for wrong in [
            &[Time, Operation::Measure][..],
            &[Operation::Rate],
            &[Time, Time],
            &[],
        ] {
            assert!(Function::expression(wrong).is_err(), "{wrong:?}");
        }
        let [kink, line] = [F::Abs, F::Sin].map(|f| [Time, Operation::Apply(f)]);
        assert!(!Function::expression(&kink).expect("complete").is_smooth());
        let smooth = Function::expression(&line).expect("complete");
        assert!(smooth.is_smooth() && !smooth.is_constant());
        assert!(
            Function::expression(&[N(2.0)])
                .expect("complete")
                .is_constant()
        );
        assert!(
            Function::table(&[0.0, 1.0], &[0.0, 1.0])
                .expect("a table")
                .is_smooth()
        );
    }
}
