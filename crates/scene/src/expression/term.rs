//! Terms that contain variables of a force law: their dimension, if it is known, and the operations
//! that evaluate them later.
//!
//! If the dimension of a term is known, its value is in kg, N, m, s and rad. The dimension of the
//! product of a bare number and a variable is not known (`0.5*rate` may be a torque). Until a key
//! or a sum determines the dimension, such a term is a number in the units of the scene, like a
//! bare number.

use model::law::{Join, Law, LawError, Operation, UnaryFunction};

use super::quantity::{Bases, Quantity};
use super::{Fault, Problem, Scope, Value, parse, taken};
use crate::dimension::Dimension;

#[derive(Clone)]
pub(super) enum LawTerm {
    /// A value without variables.
    Constant(Quantity),
    Variable(Variable),
}

#[derive(Clone)]
pub(super) struct Variable {
    dimension: Option<Dimension>,
    work: Vec<Operation>,
}

/// Parses a force law for a joint coordinate of the dimension `of`; the value is a force or torque
/// of dimension `result`.
pub(crate) fn law(
    text: &str,
    measure: Dimension,
    result: Dimension,
    scope: &impl Scope,
) -> Result<Law, Vec<Fault>> {
    let variable = |of: Dimension, operation| {
        LawTerm::Variable(Variable {
            dimension: Some(of),
            work: vec![operation],
        })
    };
    let variables = [
        ("measure", variable(measure, Operation::Measure)),
        (
            "rate",
            variable(measure.times(Dimension::TIME, -1), Operation::Rate),
        ),
        ("t", variable(Dimension::TIME, Operation::Time)),
    ];
    let term = parse(text, scope, &variables)?;
    let whole = |problem| {
        vec![Fault {
            span: 0..text.len(),
            problem,
        }]
    };
    let work = term.at(result, scope.bases()).map_err(whole)?.work;
    Law::new(&work).map_err(|error| {
        whole(match error {
            LawError::Deep => Problem::Deep {
                most: super::DEEPEST,
            },
            // This error does not occur, because operands come before their operations.
            _ => Problem::Empty,
        })
    })
}

impl From<Quantity> for LawTerm {
    fn from(q: Quantity) -> Self {
        Self::Constant(q)
    }
}

impl LawTerm {
    fn dimension(&self) -> Option<Dimension> {
        match self {
            Self::Constant(q) => q.dimension,
            Self::Variable(v) => v.dimension,
        }
    }

    /// Converts the term for a key that requires the dimension `expected`.
    fn at(self, expected: Dimension, bases: Bases) -> Result<Variable, Problem> {
        match self {
            Self::Constant(q) => {
                let value = q.at(expected, bases)?.to_f64();
                Ok(Variable {
                    dimension: Some(expected),
                    work: vec![Operation::Number(value)],
                })
            }
            Self::Variable(v) => match v.dimension {
                None => v.scaled(expected, bases, Join::Multiply),
                Some(found) if found.fits(expected) => Ok(v),
                Some(found) => Err(Problem::Dimension { found, expected }),
            }
            .map(|v| Variable {
                dimension: Some(expected),
                ..v
            }),
        }
    }

    /// Converts the term to a number in the units of the scene.
    fn bare(self, bases: Bases) -> Result<Variable, Problem> {
        let v = match self {
            Self::Constant(q) => Variable {
                dimension: q.dimension,
                work: vec![Operation::Number(q.to_f64())],
            },
            Self::Variable(v) => v,
        };
        match v.dimension {
            None => Ok(v),
            Some(of) => v.scaled(of, bases, Join::Divide),
        }
        .map(|v| Variable {
            dimension: None,
            ..v
        })
    }

    /// Converts both terms to one dimension, if at least one of the two dimensions is known.
    fn matched(self, other: Self, bases: Bases) -> Result<[Variable; 2], Problem> {
        match (self.dimension(), other.dimension()) {
            (None, None) => Ok([self.bare(bases)?, other.bare(bases)?]),
            (Some(of), None) => Ok([self.at(of, bases)?, other.at(of, bases)?]),
            (Some(a), Some(b)) if b.fits(a) => Ok([self.at(a, bases)?, other.at(a, bases)?]),
            (Some(a), Some(b)) if !a.fits(b) => Err(Problem::Mixed { a, b }),
            (_, Some(of)) => Ok([self.at(of, bases)?, other.at(of, bases)?]),
        }
    }

    fn product(self, other: Self, power: i8, bases: Bases) -> Result<Self, Problem> {
        let join = if power > 0 {
            Join::Multiply
        } else {
            Join::Divide
        };
        let of = self.dimension().zip(other.dimension());
        let factors = match of {
            Some((a, b)) => [self.at(a, bases)?, other.at(b, bases)?],
            None => [self.bare(bases)?, other.bare(bases)?],
        };
        Ok(joined(factors, join, of.map(|(a, b)| a.times(b, power))))
    }

    fn power(self, exponent: Self, bases: Bases) -> Result<Self, Problem> {
        if let Some(found) = exponent.dimension().filter(|d| *d != Dimension::NONE) {
            return Err(Problem::Exponent { found });
        }
        if let Self::Constant(q) = exponent {
            let n = q.to_f64();
            if n.fract() == 0.0 && n.abs() <= MOST_FACTORS {
                #[expect(clippy::cast_possible_truncation, reason = "whole and small")]
                let (whole, power) = (n as i32, n as i8);
                let dimension = self.dimension();
                let of = dimension.map(|of| Dimension::NONE.times(of, power));
                let base = match dimension {
                    Some(of) => self.at(of, bases)?,
                    None => self.bare(bases)?,
                };
                return Ok(base.applied(UnaryFunction::Whole(whole), of));
            }
        }
        if let Some(of) = self.dimension().filter(|d| *d != Dimension::NONE) {
            return Err(Problem::PowerOfUnit { of });
        }
        let factors = [self.bare(bases)?, exponent.bare(bases)?];
        Ok(joined(factors, Join::Power, None))
    }
}

/// Largest integer power that is computed as a product; see `Quantity::power`.
const MOST_FACTORS: f64 = 64.0;

fn joined([a, b]: [Variable; 2], join: Join, dimension: Option<Dimension>) -> LawTerm {
    let mut work = a.work;
    work.extend(b.work);
    work.push(Operation::Join(join));
    LawTerm::Variable(Variable { dimension, work })
}

impl Variable {
    /// Multiplies or divides the term by the unit that the scene chooses for a dimension.
    fn scaled(mut self, of: Dimension, bases: Bases, join: Join) -> Result<Self, Problem> {
        let unit = Quantity::bare(linalg::Dd::ONE).at(of, bases)?.to_f64();
        if unit != 1.0 {
            self.work
                .extend([Operation::Number(unit), Operation::Join(join)]);
        }
        Ok(self)
    }

    fn applied(mut self, f: UnaryFunction, dimension: Option<Dimension>) -> LawTerm {
        self.work.push(Operation::Apply(f));
        LawTerm::Variable(Self { dimension, ..self })
    }
}

impl Value for LawTerm {
    fn negated(self) -> Self {
        match self {
            Self::Constant(q) => Self::Constant(q.negated()),
            Self::Variable(v) => {
                let of = v.dimension;
                v.applied(UnaryFunction::Negate, of)
            }
        }
    }

    fn joined(self, sign: u8, other: Self, bases: Bases) -> Result<Self, Problem> {
        let (a, b) = match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => {
                return a.joined(sign, b, bases).map(Self::Constant);
            }
            pair => pair,
        };
        let sum = |join| {
            let pair = a.clone().matched(b.clone(), bases)?;
            let of = pair[0].dimension;
            Ok(joined(pair, join, of))
        };
        match (sign, &b) {
            (b'+', _) => sum(Join::Add),
            (b'-', _) => sum(Join::Subtract),
            (b'/', Self::Constant(q)) if q.to_f64() == 0.0 => Err(Problem::DivisionByZero),
            (b'*', _) => a.product(b, 1, bases),
            (b'/', _) => a.product(b, -1, bases),
            _ => a.power(b, bases),
        }
    }

    fn call(name: &'static str, values: &[Self], bases: Bases) -> Result<Self, (bool, Problem)> {
        let constants: Option<Vec<Quantity>> = values
            .iter()
            .map(|value| match value {
                Self::Constant(q) => Some(*q),
                Self::Variable(_) => None,
            })
            .collect();
        if let Some(constants) = constants {
            return Quantity::call(name, &constants, bases).map(Self::Constant);
        }
        let of_whole = |e| (false, e);
        let x = values[0].clone();
        let two = |join, of: Option<Dimension>| {
            let pair = values[0].clone().matched(values[1].clone(), bases);
            let pair = pair.map_err(of_whole)?;
            let of = of.or(pair[0].dimension);
            Ok(joined(pair, join, of))
        };
        let (f, of) = match name {
            "min" => return two(Join::Least, None),
            "max" => return two(Join::Largest, None),
            "atan2" => return two(Join::Angle, Some(Dimension::ANGLE)),
            "sin" => (UnaryFunction::Sin, Dimension::NONE),
            "cos" => (UnaryFunction::Cos, Dimension::NONE),
            "tan" => (UnaryFunction::Tan, Dimension::NONE),
            "asin" => (UnaryFunction::Asin, Dimension::ANGLE),
            "acos" => (UnaryFunction::Acos, Dimension::ANGLE),
            "atan" => (UnaryFunction::Atan, Dimension::ANGLE),
            "exp" => (UnaryFunction::Exp, Dimension::NONE),
            "log" => (UnaryFunction::Log, Dimension::NONE),
            _ => {
                // "sqrt" | "abs"
                let of = x.dimension();
                let x = match of {
                    Some(of) => x.at(of, bases),
                    None => x.bare(bases),
                };
                let x = x.map_err(of_whole)?;
                if name == "abs" {
                    return Ok(x.applied(UnaryFunction::Abs, of));
                }
                let root = of.map(|of| of.root().ok_or(Problem::Root { of }));
                let root = root.transpose().map_err(of_whole)?;
                return Ok(x.applied(UnaryFunction::Root, root));
            }
        };
        let taken = taken(name).unwrap_or(Dimension::NONE);
        let x = x.at(taken, bases).map_err(|e| (true, e))?;
        Ok(x.applied(f, Some(of)))
    }
}
