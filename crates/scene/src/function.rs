//! Functions of time: a number, an expression of the time, or an inline table with a `type`.

use std::ops::Range;
use std::rc::Rc;

use joints::spec::Unit;
use model::words::rounded;
use model::{Function, FunctionError};

use crate::dimension::Dimension;
use crate::field::{Field, all};
use crate::key::{Interval, Key, TYPE, Takes};
use crate::limits::RUN_INSTANTS;
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::table::Table;

/// A kind of function: the value of `type`, its keys, and its formula.
pub(crate) struct FunctionKind {
    pub(crate) name: &'static str,
    pub(crate) keys: &'static [Key],
    pub(crate) doc: &'static str,
}

/// All kinds.
pub(crate) const KINDS: [FunctionKind; 6] = [
    FunctionKind {
        name: "steps",
        keys: &[START, STEPS],
        doc: "start + Σ by·(10s³ − 15s⁴ + 6s⁵), s from 0 at `from` to 1 at `to`: smooth steps",
    },
    FunctionKind {
        name: "constant-rate",
        keys: &[RATE],
        doc: "rate·t",
    },
    FunctionKind {
        name: "polynomial",
        keys: &[COEFFICIENTS],
        doc: "c₀ + c₁·t + c₂·t² + …",
    },
    FunctionKind {
        name: "harmonic",
        keys: &[AMPLITUDE, OMEGA, PHASE, OFFSET],
        doc: "amplitude·sin(omega·t + phase) + offset",
    },
    FunctionKind {
        name: "table",
        keys: &[TIMES, VALUES],
        doc: "A smooth curve (C² spline) through points; the run must stay within its times",
    },
    FunctionKind {
        name: "linear-table",
        keys: &[TIMES, VALUES],
        doc: "Straight lines through points, two at one time are a jump; the run must stay within its times",
    },
];

const START: Key = value("start")
    .of_values()
    .doc("Value before the first step")
    .or(|| 0.0.into());
const STEPS: Key = Key::required(
    "steps",
    "a list of steps { from = …, to = …, by = … }",
    Takes::Steps,
)
.doc("Steps, which may overlap");
const FROM: Key = value("from")
    .needed()
    .unit(Dimension::TIME)
    .doc("When the step begins");
const TO: Key = value("to")
    .needed()
    .unit(Dimension::TIME)
    .doc("When it ends, later");
const BY: Key = value("by")
    .needed()
    .of_values()
    .doc("By how much the value changes");
const RATE: Key = value("rate")
    .needed()
    .unit(Dimension::PER_TIME)
    .of_values()
    .doc("Change per second");
const COEFFICIENTS: Key = Key::required(
    "coefficients",
    "a list of numbers, ascending",
    Takes::Numbers(0),
)
.of_values()
.doc("Coefficients of 1, t, t², …");
const AMPLITUDE: Key = value("amplitude").needed().of_values().doc("Amplitude");
const OMEGA: Key = value("omega")
    .needed()
    .unit(Dimension::ANGULAR_VELOCITY)
    .doc("Angular frequency");
const PHASE: Key = value("phase")
    .unit(Dimension::ANGLE)
    .doc("Phase at t = 0")
    .or(|| 0.0.into());
const OFFSET: Key = value("offset")
    .of_values()
    .doc("Mean value")
    .or(|| 0.0.into());
const TIMES: Key = Key::required("times", "a list of growing times", Takes::Numbers(2))
    .unit(Dimension::TIME)
    .doc("Times of the points");
const VALUES: Key = Key::required("values", "a list of numbers", Takes::Numbers(2))
    .of_values()
    .doc("Values at these times");

/// Keys of a step.
pub(crate) const STEP_KEYS: [Key; 3] = [FROM, TO, BY];

const fn value(name: &'static str) -> Key {
    Key::optional(name, "a number", Takes::Number(Interval::Any))
}

/// Names of the kinds.
fn names() -> impl Iterator<Item = &'static str> {
    KINDS.iter().map(|kind| kind.name)
}

/// The times at which a function is defined; the run must not exceed them.
pub(crate) struct Domain {
    pub(crate) subject: Rc<str>,
    pub(crate) span: Range<usize>,
    extent: Extent,
}

/// The times at which a function is defined.
enum Extent {
    /// The interval of a table.
    Interval { first: f64, last: f64 },
    /// The times at which an expression has a value and this number of derivatives.
    Expression {
        key: String,
        function: Function,
        derivatives: usize,
    },
}

impl Domain {
    /// Returns the reason why a run from t = 0 exceeds the domain, if it does. Expressions are
    /// evaluated at instants of the run.
    pub(crate) fn excess(&self, t_end: f64) -> Option<(Mistake, String, &'static str)> {
        let subject = &self.subject;
        match &self.extent {
            Extent::Interval { first, last } if *first <= 0.0 && *last >= t_end => None,
            Extent::Interval { first, last } => Some((
                Mistake::Uncovered,
                format!(
                    "{subject}: the table runs from t = {first} to t = {last}, the run from t = 0 to t = {t_end}"
                ),
                "must cover the whole run",
            )),
            Extent::Expression {
                key,
                function,
                derivatives,
            } => {
                let mut instants =
                    (0..=RUN_INSTANTS).map(|k| t_end * f64::from(k) / f64::from(RUN_INSTANTS));
                let (t, what) =
                    instants.find_map(|t| Some((t, missing(function, *derivatives, t)?)))?;
                Some((
                    Mistake::NoValue,
                    format!("{subject}: `{key}` has no {what} at t = {} s", rounded(t)),
                    "must be defined during the whole run",
                ))
            }
        }
    }
}

/// Reads a function with values of this dimension. The time intervals of tables are added to
/// `domains`.
pub(crate) fn read(field: &Field, of: Dimension, domains: &mut Vec<Domain>) -> Option<Function> {
    const EXPECTED: &str = "a number, an expression of `t` or a function of time { type = … }";
    if field.is_of_time() {
        let function = field.of_time(of)?;
        let derivatives = regular(&function, of, field)?;
        domains.push(Domain {
            subject: Rc::clone(&field.subject),
            span: field.span(),
            extent: Extent::Expression {
                key: field.key.to_string(),
                function: function.clone(),
                derivatives,
            },
        });
        return Some(function);
    }
    if field.may_be_number() {
        let value = field.number(of)?;
        return accept(Function::constant(value), field);
    }
    let mut table = field.table(EXPECTED)?;
    let kind = table.needed(TYPE, list(names()))?;
    let function = match kind.text(&list(names()))? {
        "steps" => steps(&mut table, of),
        "constant-rate" => {
            let rate = number(&mut table, &RATE, of);
            rate.and_then(|rate| accept(Function::constant_rate(rate), field))
        }
        "polynomial" => polynomial(&mut table, of, field),
        "harmonic" => harmonic(&mut table, of, field),
        "table" => points(&mut table, of, Function::table, domains),
        "linear-table" => points(&mut table, of, Function::lines, domains),
        unknown => {
            kind.error_with_help(
                Mistake::UnknownType,
                format!(" has the unknown type `{unknown}`"),
                "no such function of time",
                did_you_mean(unknown, names()).or(Some(format!("there are {}", list(names())))),
            );
            return None;
        }
    };
    table.close();
    function
}

/// Reads the number under a key of a function with values of this dimension; without the key,
/// returns the default.
fn number(table: &mut Table, key: &Key, of: Dimension) -> Option<f64> {
    match (table.optional(key), key.default) {
        (Some(field), _) => field.number(key.unit_in(of)),
        (None, Some(default)) => default().as_f64(),
        (None, None) => {
            table.required(key);
            None
        }
    }
}

fn steps(table: &mut Table, of: Dimension) -> Option<Function> {
    let start = number(table, &START, of);
    let field = table.required(&STEPS)?;
    let items = field.items(STEPS.expected)?;
    let read = all(&items, |item| step(item, of));
    let (start, mut steps) = (start?, read?);
    // The constructor reports only the first error, so the step is replaced by a valid step and the
    // construction is repeated.
    let mut faultless = true;
    for _ in 0..=items.len() {
        if table.findings.is_full() {
            return None;
        }
        match Function::steps(start, &steps) {
            Ok(function) => return faultless.then_some(function),
            Err(FunctionError::EmptyStep { step, from, to }) => {
                let error = FunctionError::EmptyStep { step, from, to };
                refuse(&error, &items[step - 1]);
                steps[step - 1] = [0.0, 1.0, 0.0];
                faultless = false;
            }
            Err(error) => {
                refuse(&error, &field);
                return None;
            }
        }
    }
    None
}

fn step(item: &Field, of: Dimension) -> Option<[f64; 3]> {
    let mut table = item.table("a step { from = …, to = …, by = … }")?;
    let step = STEP_KEYS.map(|key| number(&mut table, &key, of));
    table.close();
    let [from, to, by] = step;
    Some([from?, to?, by?])
}

fn polynomial(table: &mut Table, of: Dimension, field: &Field) -> Option<Function> {
    let list = table.required(&COEFFICIENTS)?;
    let of = COEFFICIENTS.unit_in(of);
    // The dimension of the coefficient of tᵏ is the dimension of the values divided by s^k.
    let power = |k: usize| i8::try_from(k).unwrap_or(i8::MAX);
    let coefficients = list.any_numbers(|k| of.times(Dimension::PER_TIME, power(k)))?;
    accept(Function::polynomial(&coefficients), field)
}

fn harmonic(table: &mut Table, of: Dimension, field: &Field) -> Option<Function> {
    let amplitude = number(table, &AMPLITUDE, of);
    let omega = number(table, &OMEGA, of);
    let phase = number(table, &PHASE, of);
    let offset = number(table, &OFFSET, of);
    let function = Function::harmonic(amplitude?, omega?, phase?, offset?);
    accept(function, field)
}

fn points(
    table: &mut Table,
    of: Dimension,
    through: impl Fn(&[f64], &[f64]) -> Result<Function, FunctionError>,
    domains: &mut Vec<Domain>,
) -> Option<Function> {
    let times = table.required(&TIMES);
    let values = table.required(&VALUES);
    let (times, values) = (times?, values?);
    let t = times.any_numbers(|_| TIMES.unit);
    let y = values.any_numbers(|_| VALUES.unit_in(of));
    let (t, y) = (t?, y?);
    let function = match through(&t, &y) {
        Ok(function) => function,
        Err(error) => {
            let at = match &error {
                FunctionError::NotIncreasing { index, .. } => times
                    .items("a list")
                    .and_then(|items| items.get(*index).cloned()),
                FunctionError::Uneven { .. } => Some(values),
                _ => None,
            };
            refuse(&error, at.as_ref().unwrap_or(&times));
            return None;
        }
    };
    if let [first, .., last] = t[..] {
        domains.push(Domain {
            subject: Rc::clone(&table.subject),
            span: times.span(),
            extent: Extent::Interval { first, last },
        });
    }
    Some(function)
}

/// Returns the number of derivatives that a function of this dimension needs, or reports that these
/// derivatives do not exist at the start. A load needs only a value. A prescribed velocity needs
/// one derivative, and the motion of a drive needs two derivatives. Prescribed motions must have no
/// kinks, because the times of kinks are not known in advance.
fn regular(function: &Function, of: Dimension, field: &Field) -> Option<usize> {
    let loads = [Unit::Force, Unit::Torque].map(Dimension::from);
    let derivatives = match of {
        of if loads.contains(&of) => 0,
        Dimension::VELOCITY => 1,
        _ => 2,
    };
    let (subject, key) = (&field.subject, &field.key);
    let report = |message: &str, label: &str, help: &str| {
        field.findings.error_with_help(
            Mistake::NoValue,
            field.span(),
            format!("{subject}: `{key}` {message}"),
            label,
            help.to_owned(),
        );
    };
    if derivatives > 0 && !function.is_smooth() {
        report(
            "prescribes a motion, so it cannot contain `abs`, `min`, `max` or `atan2` of the time",
            "has kinks or jumps",
            "write a function of time of the type `steps` or `linear-table`",
        );
        return None;
    }
    let Some(what) = missing(function, derivatives, 0.0) else {
        return Some(derivatives);
    };
    report(
        &format!("has no {what} at t = 0 s"),
        "not a number at the start",
        "write an expression that is defined from the start to the end of the run",
    );
    None
}

/// Returns which of the value and these derivatives does not exist at a time. If several do not
/// exist, the result is the lowest order.
fn missing(function: &Function, derivatives: usize, t: f64) -> Option<&'static str> {
    let names = ["value", "rate", "second derivative"];
    let all = names.into_iter().zip(function.jet(t)).take(derivatives + 1);
    all.filter(|(_, x)| !x.is_finite())
        .map(|(name, _)| name)
        .next()
}

fn accept(function: Result<Function, FunctionError>, field: &Field) -> Option<Function> {
    function.map_err(|error| refuse(&error, field)).ok()
}

fn refuse(error: &FunctionError, at: &Field) {
    let label = match error {
        FunctionError::EmptyStep { .. } => "ends before it begins",
        FunctionError::NotIncreasing { .. } => "not later than the time before it",
        FunctionError::Uneven { .. } => "expected as many as `times`",
        FunctionError::ShortTable { .. } => "too few",
        _ => "not possible",
    };
    let message = format!("{}: `{}`: {error}", at.subject, at.key);
    at.findings.error(error.code(), at.span(), message, label);
}
