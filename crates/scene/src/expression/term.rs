//! Terms that contain variables of a force law or of a function of time: their dimension, if it is
//! known, and the operations that evaluate them later.
//!
//! If the dimension of a term is known, its value is in kg, N, m, s and rad. The dimension of the
//! product of a bare number and a variable is not known (`0.5*rate` may be a torque). Until a key
//! or a sum determines the dimension, such a term is a number in the units of the scene, like a
//! bare number. The sine of a variable is a bare number, as the sine of a constant is.

use model::law::{Join, Law, LawError, LawState, Operation, UnaryFunction};
use model::{Function, FunctionError};

use super::quantity::{Bases, Quantity};
use super::unit::TIME;
use super::{Fault, INTEGRAL, LAG, Problem, Scope, Value, parse, taken};
use crate::dimension::Dimension;

const MEASURE: &str = "measure";
const RATE: &str = "rate";

/// The variables of a force law.
pub(crate) const OF_LAW: &[&str] = &[MEASURE, RATE, TIME];

/// The variables of a function of time.
pub(crate) const OF_TIME: &[&str] = &[TIME];

#[derive(Clone)]
pub(super) enum LawTerm {
    /// A value without variables.
    Constant(Quantity),
    Variable(Variable),
}

#[derive(Clone)]
pub(super) struct Variable {
    dimension: Option<Dimension>,
    /// Whether the value is computed only from bare numbers and functions such as `sin`. Such a
    /// value has no dimension and gets the dimension of its key, like a bare number.
    is_bare: bool,
    /// Whether the value contains π and has no unit of an angle; see [`Quantity`].
    has_pi: bool,
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
    let variables = [
        variable(MEASURE, measure, Operation::Measure),
        variable(RATE, measure.times(Dimension::TIME, -1), Operation::Rate),
        time(),
    ];
    let work = operations(text, &variables, result, scope)?;
    Law::new(&work).map_err(|error| vec![refused(text, &error)])
}

/// Parses a function of time with values of dimension `result`.
pub(crate) fn of_time(
    text: &str,
    result: Dimension,
    scope: &impl Scope,
) -> Result<Function, Vec<Fault>> {
    let work = operations(text, &[time()], result, scope)?;
    let mut states = work.iter().filter_map(|operation| match operation {
        Operation::Keep(LawState::Integral) => Some(INTEGRAL),
        Operation::Keep(LawState::Lag) => Some(LAG),
        _ => None,
    });
    if let Some(name) = states.next() {
        let (problem, span) = (Problem::OnlyInLaw { name }, 0..text.len());
        return Err(vec![Fault { span, problem }]);
    }
    Function::expression(&work).map_err(|error| {
        vec![match &error {
            FunctionError::Operations(error) => refused(text, error),
            _ => refused(text, &LawError::Variable),
        }]
    })
}

fn variable(name: &'static str, of: Dimension, operation: Operation) -> (&'static str, LawTerm) {
    let variable = Variable {
        dimension: Some(of),
        is_bare: false,
        has_pi: false,
        work: vec![operation],
    };
    (name, LawTerm::Variable(variable))
}

fn time() -> (&'static str, LawTerm) {
    variable(TIME, Dimension::TIME, Operation::Time)
}

/// Parses an expression of these variables with a value of dimension `result`.
fn operations(
    text: &str,
    variables: &[(&'static str, LawTerm)],
    result: Dimension,
    scope: &impl Scope,
) -> Result<Vec<Operation>, Vec<Fault>> {
    let term = parse(text, scope, variables)?;
    let span = 0..text.len();
    let term = term.at(result, scope.bases());
    term.map(|term| term.work)
        .map_err(|problem| vec![Fault { span, problem }])
}

/// The error for operations that are not accepted.
fn refused(text: &str, error: &LawError) -> Fault {
    let problem = match error {
        LawError::Deep => Problem::Deep {
            most: super::DEEPEST,
        },
        // Other errors do not occur: operands come before their operations, and all variables come
        // from the caller.
        _ => Problem::Empty,
    };
    let span = 0..text.len();
    Fault { span, problem }
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

    fn is_bare(&self) -> bool {
        match self {
            Self::Constant(q) => q.dimension.is_none(),
            Self::Variable(v) => v.is_bare,
        }
    }

    /// Converts the term for a key that requires the dimension `expected`.
    fn at(self, expected: Dimension, bases: Bases) -> Result<Variable, Problem> {
        let is_bare = self.is_bare() && expected == Dimension::NONE;
        let v = match self {
            Self::Constant(q) => Variable {
                dimension: Some(expected),
                is_bare,
                has_pi: q.has_pi,
                work: vec![Operation::Number(q.at(expected, bases)?.to_f64())],
            },
            Self::Variable(v) => match v.dimension {
                Some(found) if !v.is_bare && !found.fits(expected) => {
                    return Err(Problem::Dimension { found, expected });
                }
                Some(_) if !v.is_bare => v,
                _ => v.scaled(expected, bases, Join::Multiply)?,
            },
        };
        Ok(Variable {
            dimension: Some(expected),
            is_bare,
            has_pi: v.has_pi && is_bare,
            ..v
        })
    }

    /// Converts the term to a number in the units of the scene.
    fn bare(self, bases: Bases) -> Result<Variable, Problem> {
        let is_number = self.is_bare() || self.dimension().is_none();
        let v = match self {
            Self::Constant(q) => Variable {
                dimension: q.dimension,
                is_bare: false,
                has_pi: q.has_pi,
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
            is_bare: false,
            has_pi: v.has_pi && is_number,
            ..v
        })
    }

    /// Returns whether the term has a known dimension that contains an angle.
    fn is_angular(&self) -> bool {
        let dimension = self.dimension().filter(|_| !self.is_bare());
        dimension.is_some_and(|of| of.chosen()[1] != 0)
    }

    /// Converts both terms to one dimension, if at least one of the two dimensions is known.
    fn matched(self, other: Self, bases: Bases) -> Result<[Variable; 2], Problem> {
        let bare = [self.is_bare(), other.is_bare()];
        let of = match (bare, self.dimension(), other.dimension()) {
            ([true, true], ..) => Some(Dimension::NONE),
            ([true, false], _, of) | ([false, true], of, _) => of,
            (_, None, None) => None,
            (_, Some(a), Some(b)) if b.fits(a) => Some(a),
            (_, Some(a), Some(b)) if !a.fits(b) => return Err(Problem::Mixed { a, b }),
            (_, of, None) | (_, _, of) => of,
        };
        match of {
            Some(of) => Ok([self.at(of, bases)?, other.at(of, bases)?]),
            None => Ok([self.bare(bases)?, other.bare(bases)?]),
        }
    }

    fn product(self, other: Self, power: i8, bases: Bases) -> Result<Self, Problem> {
        let join = if power > 0 {
            Join::Multiply
        } else {
            Join::Divide
        };
        let of = if self.is_bare() && other.is_bare() {
            Some((Dimension::NONE, Dimension::NONE))
        } else {
            self.dimension().zip(other.dimension())
        };
        let is_angular = self.is_angular() || other.is_angular();
        let mut factors = match of {
            Some((a, b)) => [self.at(a, bases)?, other.at(b, bases)?],
            None => [self.bare(bases)?, other.bare(bases)?],
        };
        for factor in &mut factors {
            // If the term has a unit of an angle, as in `pi*t*rad`, the angle is in radians.
            factor.has_pi &= !is_angular;
        }
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
        if self.is_bare() && exponent.is_bare() {
            let none = Dimension::NONE;
            let factors = [self.at(none, bases)?, exponent.at(none, bases)?];
            return Ok(joined(factors, Join::Power, Some(none)));
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
    LawTerm::Variable(Variable {
        dimension,
        is_bare: a.is_bare && b.is_bare && dimension == Some(Dimension::NONE),
        has_pi: a.has_pi || b.has_pi,
        work,
    })
}

impl Variable {
    /// Multiplies or divides the term by the unit that the scene chooses for a dimension.
    fn scaled(mut self, of: Dimension, bases: Bases, join: Join) -> Result<Self, Problem> {
        let one = Quantity {
            has_pi: self.has_pi && join == Join::Multiply,
            ..Quantity::bare(linalg::Dd::ONE)
        };
        let unit = bases.scaled(one, of)?.to_f64();
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

/// Returns the state of a law, which these values drive.
fn kept(name: &str, values: &[LawTerm], bases: Bases) -> Result<LawTerm, Problem> {
    let driving = values[0].clone();
    let of = driving.dimension();
    let driving = match of {
        Some(of) => driving.at(of, bases)?,
        None => driving.bare(bases)?,
    };
    let mut work = driving.work;
    let (state, dimension) = match values.get(1) {
        Some(time) if name == LAG => {
            let time = time.clone().at(Dimension::TIME, bases)?;
            if let [Operation::Number(value)] = time.work[..]
                && value <= 0.0
            {
                let name = "a lag";
                return Err(Problem::Undefined { name, value });
            }
            work.extend(time.work);
            (LawState::Lag, of)
        }
        _ => (
            LawState::Integral,
            of.map(|of| of.times(Dimension::TIME, 1)),
        ),
    };
    work.push(Operation::Keep(state));
    Ok(LawTerm::Variable(Variable {
        dimension,
        is_bare: driving.is_bare && state == LawState::Lag,
        has_pi: driving.has_pi,
        work,
    }))
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
        if let INTEGRAL | LAG = name {
            return kept(name, values, bases).map_err(|e| (false, e));
        }
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
        let x = Variable {
            is_bare: of == Dimension::NONE,
            has_pi: false,
            ..x
        };
        Ok(x.applied(f, Some(of)))
    }
}
