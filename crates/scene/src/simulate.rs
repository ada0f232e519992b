//! `[simulate]`: options of a run.

use model::words::short;
use std::collections::HashMap;
use std::ops::Range;

use dynamics::{Method, MotionError, MotionOptions, RowChoice, Stabilisation};

use crate::diagnostic::Diagnostic;
use crate::dimension::Dimension;
use crate::field::Field;
use crate::findings::Findings;
use crate::function::Domain;
use crate::key::{Interval, Key, Takes};
use crate::mistake::Mistake;
use crate::nearest::{did_you_mean, list};
use crate::plausible;
use crate::table::Table;

/// The allowed texts of a key, each with its value of the enum `T`.
pub(crate) struct Choice<T: 'static> {
    pub(crate) key: Key,
    pub(crate) available: &'static [T],
    pub(crate) name: fn(T) -> &'static str,
}

const METHODS: Choice<Method> = Choice {
    key: METHOD,
    available: Method::ALL,
    name: Method::name,
};

const STABILISATIONS: Choice<Stabilisation> = Choice {
    key: STABILISATION,
    available: Stabilisation::ALL,
    name: Stabilisation::name,
};

const T_END: Key = Key::required(
    "t_end",
    "a finite time ≥ 0",
    Takes::Number(Interval::NotNegative),
)
.unit(Dimension::TIME)
.doc("Last time of the run");
const OUTPUT_STEP: Key = positive("output_step", "a time > 0")
    .unit(Dimension::TIME)
    .doc("Time between written rows; t_end/200 if it is omitted");
const RTOL: Key = Key::optional(
    "rtol",
    MotionOptions::RTOL_EXPECTED,
    Takes::Number(Interval::Within(
        *MotionOptions::RTOL_RANGE.start(),
        *MotionOptions::RTOL_RANGE.end(),
    )),
)
.doc("Relative tolerance of a step")
.or(|| MotionOptions::RTOL.into());
const ATOL: Key = positive("atol", "a number > 0")
    .doc("Absolute tolerance of a step (m, rad, m/s, rad/s)")
    .or(|| MotionOptions::ATOL.into());
const MAX_STEP: Key = positive("max_step", "a time > 0")
    .unit(Dimension::TIME)
    .doc("Largest step; no limit if it is omitted");
const MAX_STEPS: Key = Key::optional("max_steps", "a whole number ≥ 1", Takes::Whole(1, i64::MAX))
    .doc("Most steps, accepted and rejected, after which a run stops")
    .or(|| MotionOptions::MAX_STEPS.into());
const METHOD: Key = Key::optional(
    "method",
    "the name of a method",
    Takes::OneOf(|| names(Method::ALL, Method::name)),
)
.doc("Integrator; `auto` looks at the forces of the start")
.or(|| Method::default().name().into());
const STABILISATION: Key = Key::optional(
    "stabilisation",
    "the name of a stabilisation",
    Takes::OneOf(|| names(Stabilisation::ALL, Stabilisation::name)),
)
.doc("Treatment of drift")
.or(|| Stabilisation::default().name().into());
const DROP: Key = Key::optional("drop", "a list of rows, counted from 1", Takes::Rows)
    .doc("Rows to eliminate, counted from 1; chosen automatically if they are omitted");

/// Keys of the section.
pub(crate) const KEYS: [Key; 9] = [
    T_END,
    OUTPUT_STEP,
    RTOL,
    ATOL,
    MAX_STEP,
    MAX_STEPS,
    METHOD,
    STABILISATION,
    DROP,
];

const fn positive(name: &'static str, expected: &'static str) -> Key {
    Key::optional(name, expected, Takes::Number(Interval::Positive))
}

fn names<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> Vec<&'static str> {
    all.iter().map(|value| name(*value)).collect()
}

/// Number of output rows from which an error message computes the suggested step.
const USEFUL_ROWS: f64 = 1e4;

/// The section, with the positions that later checks need.
pub(crate) struct Simulate {
    pub(crate) options: MotionOptions,
    pub(crate) t_end: Range<usize>,
    /// Rows to treat as dependent (key `drop`, 0-based), with their positions in the text.
    drop: Vec<(usize, Range<usize>)>,
}

/// Reads the section. Returns `None` if the end time of the run could not be read.
pub(crate) fn read(mut table: Table) -> Option<Simulate> {
    let end = table.needed(T_END.name, "the last time in s");
    let t_end = end.as_ref().and_then(|field| bounded(field, &T_END));
    let mut options = MotionOptions::to(t_end.unwrap_or(1.0));
    let step = table.optional(&OUTPUT_STEP);
    let output_step = step.as_ref().and_then(|field| bounded(field, &OUTPUT_STEP));
    options.output_step = output_step.unwrap_or(options.output_step);
    if let (Some(_), Some(end), Some(step)) = (t_end, &end, &step) {
        check_length(&options, step, end);
        plausible::output_step(step, [options.output_step, options.t_end]);
    }
    let mut number = |key: &Key, value: &mut f64| {
        let read = table.optional(key).and_then(|field| bounded(&field, key));
        *value = read.unwrap_or(*value);
    };
    number(&RTOL, &mut options.rtol);
    number(&ATOL, &mut options.atol);
    number(&MAX_STEP, &mut options.max_step);
    if let Some(steps) = max_steps(&mut table) {
        options.max_steps = steps;
    }
    options.method = choose(&mut table, &METHODS).unwrap_or_default();
    options.stabilisation = choose(&mut table, &STABILISATIONS).unwrap_or_default();
    let drop = table.optional(&DROP).map(|field| rows(&field));
    table.close();
    if let Some(drop) = &drop {
        options.rows = RowChoice::Drop(drop.iter().map(|(row, _)| *row).collect());
    }
    t_end.and(end).map(|end| Simulate {
        options,
        t_end: end.span(),
        drop: drop.unwrap_or_default(),
    })
}

/// Reports an output with more rows than a disk can hold.
fn check_length(options: &MotionOptions, step: &Field, end: &Field) {
    let MotionOptions {
        t_end, output_step, ..
    } = *options;
    let rows = t_end / output_step;
    let most = MotionOptions::MOST_ROWS;
    if rows <= most {
        return;
    }
    let message = format!(
        "{}: output_step is {output_step:?} s: up to t = {t_end} s this would write {rows} rows, more than {most:e}",
        step.subject,
        rows = short(rows)
    );
    let source = step.findings.source;
    let label = "too small for this run";
    let too_small = Diagnostic::error(Mistake::TooManyRows, source, step.span(), message, label)
        .and(source.label(end.span(), "the run ends here"))
        .help(format!(
            "`output_step = {:e}` gives {USEFUL_ROWS:e} rows; without the key there are {}",
            t_end / USEFUL_ROWS,
            MotionOptions::OUTPUT_STEPS + 1.0
        ));
    step.findings.report(too_small);
}

/// Reads a number within its bounds; the error messages are the messages of `dynamics`.
pub(crate) fn bounded(field: &Field, key: &Key) -> Option<f64> {
    let value = field.number(key.unit)?;
    if key.allows(value) {
        return Some(value);
    }
    let expected = key.expected;
    let error = MotionError::Option {
        name: key.name,
        value,
        expected,
    };
    field.error(
        Mistake::OutOfRange,
        format!(": {error}"),
        format!("expected {expected}"),
    );
    None
}

fn max_steps(table: &mut Table) -> Option<u64> {
    let field = table.optional(&MAX_STEPS)?;
    let value = field.integer(MAX_STEPS.expected)?;
    let steps = u64::try_from(value).ok().filter(|steps| *steps > 0);
    if steps.is_none() {
        let expected = MAX_STEPS.expected;
        let message = format!("{}: max_steps is {value}, need {expected}", field.subject);
        table.findings.error(
            Mistake::OutOfRange,
            field.span(),
            message,
            format!("expected {expected}"),
        );
    }
    steps
}

/// Reads the name of a value; an unknown name is reported.
pub(crate) fn choose<T: Copy>(table: &mut Table, choice: &Choice<T>) -> Option<T> {
    let field = table.optional(&choice.key)?;
    let names = || choice.available.iter().map(|value| (choice.name)(*value));
    let value = field.text(&format!("one of {}", list(names())))?;
    let mut available = choice.available.iter().copied();
    if let Some(found) = available.find(|found| (choice.name)(*found) == value) {
        return Some(found);
    }
    let help = did_you_mean(value, names());
    field.error_with_help(
        Mistake::UnknownChoice,
        format!(": `{}` `{value}` is unknown", field.key),
        "no such choice",
        help.or_else(|| Some(format!("available are {}", list(names())))),
    );
    None
}

/// Reads the rows to treat as dependent. They are 1-based in the file and 0-based in the result.
/// After the mechanism has been built, another check reports rows that do not exist.
fn rows(field: &Field) -> Vec<(usize, Range<usize>)> {
    const EXPECTED: &str = DROP.expected;
    let mut rows: Vec<(usize, Range<usize>)> = Vec::new();
    let mut named = HashMap::new();
    for item in field.items(EXPECTED).unwrap_or_default() {
        let Some(number) = item.integer(EXPECTED) else {
            continue;
        };
        let Some(row) = usize::try_from(number).ok().and_then(|n| n.checked_sub(1)) else {
            item.error(
                Mistake::UnknownRow,
                format!(": `drop` names row {number}; rows are counted from 1"),
                "no such row",
            );
            continue;
        };
        let twice = format!("{}: `drop` names row {number} twice", field.subject);
        if field.findings.is_first(&mut named, row, item.span(), twice) {
            rows.push((row, item.span()));
        }
    }
    rows
}

impl Simulate {
    /// Reports rows of the key `drop` that do not exist in the mechanism.
    pub(crate) fn check_rows(&self, n_rows: usize, findings: &Findings) {
        for (row, span) in self.drop.iter().filter(|(row, _)| *row >= n_rows) {
            findings.error(
                Mistake::UnknownRow,
                span.clone(),
                format!(
                    "`[simulate]`: `drop` names row {}; rows are 1 to {n_rows}",
                    row + 1
                ),
                "no such row",
            );
        }
    }

    /// Reports functions of time that are not defined during the whole run.
    pub(crate) fn check_domains(&self, domains: &[Domain], findings: &Findings) {
        let t_end = self.options.t_end;
        for domain in domains {
            let Some((mistake, message, label)) = domain.excess(t_end) else {
                continue;
            };
            let (place, end) = (domain.span.clone(), self.t_end.clone());
            findings.collision(mistake, place, message, label, end, "the run ends here");
        }
    }
}
