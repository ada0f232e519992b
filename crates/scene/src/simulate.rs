//! `[simulate]`: what a run is asked to do.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ops::Range;

use dynamics::{Formulation, Method, MotionError, MotionOptions, RowChoice, Stabilisation};

use crate::diagnostic::Diagnostic;
use crate::field::Field;
use crate::findings::Findings;
use crate::function::Domain;
use crate::nearest::{did_you_mean, list};
use crate::table::Table;

/// The values of a key whose meaning is an enum of `dynamics`.
struct Choice<T: 'static> {
    key: &'static str,
    available: &'static [T],
    name: fn(T) -> &'static str,
}

const METHODS: Choice<Method> = Choice {
    key: "method",
    available: Method::ALL,
    name: Method::name,
};

const FORMULATIONS: Choice<Formulation> = Choice {
    key: "formulation",
    available: Formulation::ALL,
    name: Formulation::name,
};

const STABILISATIONS: Choice<Stabilisation> = Choice {
    key: "stabilisation",
    available: Stabilisation::ALL,
    name: Stabilisation::name,
};

/// Rows of the step that a refusal proposes.
const USEFUL_ROWS: f64 = 1e4;

/// The section with the places that later checks need.
pub(crate) struct Simulate {
    pub(crate) options: MotionOptions,
    pub(crate) t_end: Range<usize>,
    /// Rows to drop, from 0, with their places.
    drop: Vec<(usize, Range<usize>)>,
}

/// Reads the section. `None` if the end of the run could not be read.
pub(crate) fn read(mut table: Table, findings: &mut Findings) -> Option<Simulate> {
    let end = table.required("t_end", "the last time in s", findings);
    let t_end = end
        .as_ref()
        .and_then(|field| bounded(field, "t_end", |t| t >= 0.0, "a finite time ≥ 0", findings));
    let mut options = MotionOptions::to(t_end.unwrap_or(1.0));
    let step = table.optional("output_step");
    let output_step = step
        .as_ref()
        .and_then(|field| bounded(field, "output_step", |x| x > 0.0, "a time > 0", findings));
    options.output_step = output_step.unwrap_or(options.output_step);
    if let (Some(_), Some(end), Some(step)) = (t_end, &end, &step) {
        check_length(&options, step, end, findings);
    }
    if let Some(field) = table.optional("rtol") {
        let is_right = |x| MotionOptions::RTOL_RANGE.contains(&x);
        let read = bounded(
            &field,
            "rtol",
            is_right,
            MotionOptions::RTOL_EXPECTED,
            findings,
        );
        options.rtol = read.unwrap_or(options.rtol);
    }
    let mut positive = |name: &'static str, expected: &'static str, value: &mut f64| {
        let read = table
            .optional(name)
            .and_then(|field| bounded(&field, name, |x| x > 0.0, expected, findings));
        *value = read.unwrap_or(*value);
    };
    positive("atol", "a number > 0", &mut options.atol);
    positive("max_step", "a time > 0", &mut options.max_step);
    options.method = choose(&mut table, &METHODS, findings).unwrap_or_default();
    options.formulation = choose(&mut table, &FORMULATIONS, findings).unwrap_or_default();
    options.stabilisation = choose(&mut table, &STABILISATIONS, findings).unwrap_or_default();
    if let Some(field) = table.optional("baumgarte") {
        gains(&field, &mut options.stabilisation, findings);
    }
    let drop_field = table.optional("drop");
    if let Some(field) = drop_field
        .as_ref()
        .filter(|_| !options.formulation.drops_rows())
    {
        let formulation = options.formulation.name();
        let error = MotionError::NothingToDrop { formulation };
        findings.error(
            field.span(),
            format!("{}: {error}", field.subject),
            "no row is dropped here",
        );
    }
    let drop = drop_field.map(|field| rows(&field, findings));
    table.close(findings);
    if let Some(drop) = &drop {
        options.rows = RowChoice::Drop(drop.iter().map(|(row, _)| *row).collect());
    }
    t_end.and(end).map(|end| Simulate {
        options,
        t_end: end.span(),
        drop: drop.unwrap_or_default(),
    })
}

/// Reports an output of more rows than a disk should hold.
fn check_length(options: &MotionOptions, step: &Field, end: &Field, findings: &mut Findings) {
    let MotionOptions {
        t_end, output_step, ..
    } = *options;
    let rows = t_end / output_step;
    let most = MotionOptions::MOST_ROWS;
    if rows <= most {
        return;
    }
    let message = format!(
        "{}: output_step is {output_step} s: up to t = {t_end} s this would write {rows:.3e} rows, more than {most:e}",
        step.subject
    );
    let source = findings.source;
    let too_small = Diagnostic::error(source, step.span(), message, "too small for this run")
        .and(source.label(end.span(), "the run ends here"))
        .help(format!(
            "`output_step = {:e}` gives {USEFUL_ROWS:e} rows; without the key there are {}",
            t_end / USEFUL_ROWS,
            MotionOptions::OUTPUT_STEPS + 1.0
        ));
    findings.report(too_small);
}

/// A number within its bounds, refused in the words of `dynamics`.
fn bounded(
    field: &Field,
    name: &'static str,
    within: impl Fn(f64) -> bool,
    expected: &'static str,
    findings: &mut Findings,
) -> Option<f64> {
    let value = field.number(findings)?;
    if within(value) {
        return Some(value);
    }
    let error = MotionError::Option {
        name,
        value,
        expected,
    };
    findings.error(
        field.span(),
        format!("{}: {error}", field.subject),
        format!("expected {expected}"),
    );
    None
}

fn choose<T: Copy>(table: &mut Table, choice: &Choice<T>, findings: &mut Findings) -> Option<T> {
    let field = table.optional(choice.key)?;
    let names = || choice.available.iter().map(|value| (choice.name)(*value));
    let value = field.text(&format!("one of {}", list(names())), findings)?;
    let mut available = choice.available.iter().copied();
    if let Some(found) = available.find(|found| (choice.name)(*found) == value) {
        return Some(found);
    }
    let help = did_you_mean(value, names());
    findings.error_with_help(
        field.span(),
        format!("{}: `{}` `{value}` is unknown", field.subject, field.key),
        "no such choice",
        help.or_else(|| Some(format!("available are {}", list(names())))),
    );
    None
}

/// The gains of Baumgarte's method, `[α, β]`, where it is asked for.
fn gains(field: &Field, stabilisation: &mut Stabilisation, findings: &mut Findings) {
    const EXPECTED: &str = "two gains ≥ 0, `[alpha, beta]` (1/s)";
    let Some(gains) = field.pair(EXPECTED, findings) else {
        return;
    };
    if gains.iter().any(|gain| *gain < 0.0) {
        let [alpha, beta] = gains;
        findings.error(
            field.span(),
            format!(
                "{}: `baumgarte` is [{alpha}, {beta}], need {EXPECTED}",
                field.subject
            ),
            format!("expected {EXPECTED}"),
        );
        return;
    }
    match stabilisation {
        Stabilisation::Baumgarte { alpha, beta } => [*alpha, *beta] = gains,
        other => findings.error_with_help(
            field.span(),
            format!(
                "{}: `baumgarte` gives gains, but the stabilisation is `{}`",
                field.subject,
                other.name()
            ),
            "no gains are used",
            Some("add `stabilisation = \"baumgarte\"`".to_owned()),
        ),
    }
}

/// Rows to drop, counted from 1 in the file and from 0 in the result. That they exist is checked when the mechanism
/// is built.
fn rows(field: &Field, findings: &mut Findings) -> Vec<(usize, Range<usize>)> {
    const EXPECTED: &str = "a list of rows, counted from 1";
    let mut rows: Vec<(usize, Range<usize>)> = Vec::new();
    let mut first: HashMap<usize, Range<usize>> = HashMap::new();
    for item in field.items(EXPECTED, findings).unwrap_or_default() {
        let Some(number) = item.integer(EXPECTED, findings) else {
            continue;
        };
        let Some(row) = usize::try_from(number).ok().and_then(|n| n.checked_sub(1)) else {
            findings.error(
                item.span(),
                format!(
                    "{}: `drop` names row {number}; rows are counted from 1",
                    field.subject
                ),
                "no such row",
            );
            continue;
        };
        match first.entry(row) {
            Entry::Occupied(first) => findings.collision(
                item.span(),
                format!("{}: `drop` names row {number} twice", field.subject),
                "named again here",
                first.get().clone(),
                "first named here",
            ),
            Entry::Vacant(place) => {
                place.insert(item.span());
                rows.push((row, item.span()));
            }
        }
    }
    rows
}

impl Simulate {
    /// Reports dropped rows that the mechanism does not have.
    pub(crate) fn check_rows(&self, n_rows: usize, findings: &mut Findings) {
        for (row, span) in self.drop.iter().filter(|(row, _)| *row >= n_rows) {
            findings.error(
                span.clone(),
                format!(
                    "`[simulate]`: `drop` names row {}; rows are 1 to {n_rows}",
                    row + 1
                ),
                "no such row",
            );
        }
    }

    /// Reports tables of functions that end before the run does.
    pub(crate) fn check_domains(&self, domains: &[Domain], findings: &mut Findings) {
        let t_end = self.options.t_end;
        for domain in domains {
            let Domain { first, last, .. } = *domain;
            if first <= 0.0 && last >= t_end {
                continue;
            }
            findings.collision(
                domain.span.clone(),
                format!(
                    "{}: the table runs from t = {first} to t = {last}, the run from t = 0 to t = {t_end}",
                    domain.subject
                ),
                "must cover the whole run",
                self.t_end.clone(),
                "the run ends here",
            );
        }
    }
}
