//! Functions of time: a number, or an inline table with a `type`.

use std::ops::Range;
use std::rc::Rc;

use model::{Function, FunctionError};

use crate::field::{Field, all, as_number};
use crate::findings::Findings;
use crate::nearest::{did_you_mean, list};
use crate::table::Table;

/// Values of `type`.
const TYPES: [&str; 6] = [
    "steps",
    "constant-rate",
    "polynomial",
    "harmonic",
    "table",
    "linear-table",
];

/// The times of a table: the run must not leave them.
pub(crate) struct Domain {
    pub(crate) subject: Rc<str>,
    pub(crate) span: Range<usize>,
    pub(crate) first: f64,
    pub(crate) last: f64,
}

/// Reads a function. Tables leave their domain in `domains`.
pub(crate) fn read(
    field: &Field,
    domains: &mut Vec<Domain>,
    findings: &mut Findings,
) -> Option<Function> {
    const EXPECTED: &str = "a number or a function of time { type = … }";
    if as_number(field.value.get_ref()).is_some() {
        let value = field.number(findings)?;
        return accept(Function::constant(value), field, findings);
    }
    let mut table = field.table(EXPECTED, findings)?;
    let kind = table.required("type", list(TYPES), findings)?;
    let function = match kind.text(&list(TYPES), findings)? {
        "steps" => steps(&mut table, findings),
        "constant-rate" => {
            let rate = number(&mut table, "rate", None, findings);
            rate.and_then(|rate| accept(Function::constant_rate(rate), field, findings))
        }
        "polynomial" => polynomial(&mut table, field, findings),
        "harmonic" => harmonic(&mut table, field, findings),
        "table" => points(&mut table, Function::table, domains, findings),
        "linear-table" => points(&mut table, Function::lines, domains, findings),
        unknown => {
            findings.error_with_help(
                kind.span(),
                format!("{} has the unknown type `{unknown}`", table.subject),
                "no such function of time",
                did_you_mean(unknown, TYPES).or(Some(format!("there are {}", list(TYPES)))),
            );
            return None;
        }
    };
    table.close(findings);
    function
}

/// The number under a key, or its default.
fn number(
    table: &mut Table,
    key: &'static str,
    default: Option<f64>,
    findings: &mut Findings,
) -> Option<f64> {
    match (table.optional(key), default) {
        (Some(field), _) => field.number(findings),
        (None, Some(default)) => Some(default),
        (None, None) => {
            table.required(key, "a number", findings);
            None
        }
    }
}

fn steps(table: &mut Table, findings: &mut Findings) -> Option<Function> {
    const STEPS: &str = "a list of steps { from = …, to = …, by = … }";
    let start = number(table, "start", Some(0.0), findings);
    let field = table.required("steps", STEPS, findings)?;
    let items = field.items(STEPS, findings)?;
    let read = all(&items, |item| step(item, findings));
    let (start, mut steps) = (start?, read?);
    // The function names its first fault only: report it, put a harmless step there and ask again.
    let mut faultless = true;
    for _ in 0..=items.len() {
        if findings.is_full() {
            return None;
        }
        match Function::steps(start, &steps) {
            Ok(function) => return faultless.then_some(function),
            Err(FunctionError::EmptyStep { step, from, to }) => {
                let error = FunctionError::EmptyStep { step, from, to };
                refuse(&error, &items[step - 1], findings);
                steps[step - 1] = [0.0, 1.0, 0.0];
                faultless = false;
            }
            Err(error) => {
                refuse(&error, &field, findings);
                return None;
            }
        }
    }
    None
}

fn step(item: &Field, findings: &mut Findings) -> Option<[f64; 3]> {
    let mut table = item.table("a step { from = …, to = …, by = … }", findings)?;
    let step = ["from", "to", "by"].map(|key| number(&mut table, key, None, findings));
    table.close(findings);
    let [from, to, by] = step;
    Some([from?, to?, by?])
}

fn polynomial(table: &mut Table, field: &Field, findings: &mut Findings) -> Option<Function> {
    let coefficients = table
        .required("coefficients", "a list of numbers, ascending", findings)?
        .any_numbers(findings)?;
    accept(Function::polynomial(&coefficients), field, findings)
}

fn harmonic(table: &mut Table, field: &Field, findings: &mut Findings) -> Option<Function> {
    let amplitude = number(table, "amplitude", None, findings);
    let omega = number(table, "omega", None, findings);
    let phase = number(table, "phase", Some(0.0), findings);
    let offset = number(table, "offset", Some(0.0), findings);
    let function = Function::harmonic(amplitude?, omega?, phase?, offset?);
    accept(function, field, findings)
}

fn points(
    table: &mut Table,
    through: impl Fn(&[f64], &[f64]) -> Result<Function, FunctionError>,
    domains: &mut Vec<Domain>,
    findings: &mut Findings,
) -> Option<Function> {
    let times = table.required("times", "a list of growing times", findings);
    let values = table.required("values", "a list of numbers", findings);
    let (times, values) = (times?, values?);
    let t = times.any_numbers(findings);
    let y = values.any_numbers(findings);
    let (t, y) = (t?, y?);
    let function = match through(&t, &y) {
        Ok(function) => function,
        Err(error) => {
            let at = match &error {
                FunctionError::NotIncreasing { index, .. } => times
                    .items("a list", findings)
                    .and_then(|items| items.get(*index).cloned()),
                FunctionError::Uneven { .. } => Some(values),
                _ => None,
            };
            refuse(&error, at.as_ref().unwrap_or(&times), findings);
            return None;
        }
    };
    if let [first, .., last] = t[..] {
        domains.push(Domain {
            subject: Rc::clone(&table.subject),
            span: times.span(),
            first,
            last,
        });
    }
    Some(function)
}

fn accept(
    function: Result<Function, FunctionError>,
    field: &Field,
    findings: &mut Findings,
) -> Option<Function> {
    function
        .map_err(|error| refuse(&error, field, findings))
        .ok()
}

fn refuse(error: &FunctionError, at: &Field, findings: &mut Findings) {
    let label = match error {
        FunctionError::EmptyStep { .. } => "ends before it begins",
        FunctionError::NotIncreasing { .. } => "not later than the time before it",
        FunctionError::Uneven { .. } => "expected as many as `times`",
        FunctionError::ShortTable { .. } => "too few",
        _ => "not possible",
    };
    let message = format!("{}: `{}`: {error}", at.subject, at.key);
    findings.error(at.span(), message, label);
}
