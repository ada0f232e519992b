//! `[simulate]`: what a run is asked to do.

use dynamics::{Formulation, Method, MotionError, MotionOptions, RowChoice, Stabilisation};

use crate::field::Field;
use crate::findings::Findings;
use crate::nearest::{did_you_mean, list};
use crate::table::Table;

/// The values of a key whose meaning is an enum of `dynamics`.
struct Choice<T: 'static> {
    key: &'static str,
    /// All that a scene may ever ask for.
    planned: &'static [&'static str],
    /// What can be done today.
    available: &'static [(&'static str, T)],
}

const METHODS: Choice<Method> = Choice {
    key: "method",
    planned: &[
        "auto",
        "dopri5",
        "dop853",
        "tsit5",
        "gbs",
        "radau5",
        "generalized-alpha",
        "hem4",
    ],
    // `auto` leaves the choice to `dynamics`, which has one method today.
    available: &[("auto", Method::Dopri5), ("dopri5", Method::Dopri5)],
};

const FORMULATIONS: Choice<Formulation> = Choice {
    key: "formulation",
    planned: &["kept-rows", "null-space", "minimum-norm", "proximal"],
    available: &[("kept-rows", Formulation::KeptRows)],
};

const STABILISATIONS: Choice<Stabilisation> = Choice {
    key: "stabilisation",
    planned: &["projection", "baumgarte", "none"],
    available: &[("projection", Stabilisation::Projection)],
};

/// Reads the section. `None` if the end of the run could not be read.
pub(crate) fn read(mut table: Table, findings: &mut Findings) -> Option<MotionOptions> {
    let t_end = table
        .required("t_end", "the last time in s", findings)
        .and_then(|field| bounded(&field, |t| t >= 0.0, "a finite time ≥ 0", findings));
    let mut options = MotionOptions::to(t_end.unwrap_or(1.0));
    let mut positive = |key: &str, expected: &'static str, value: &mut f64| {
        let read = table
            .optional(key)
            .and_then(|field| bounded(&field, |x| x > 0.0, expected, findings));
        *value = read.unwrap_or(*value);
    };
    positive("output_step", "a time > 0", &mut options.output_step);
    positive("rtol", "a number > 0", &mut options.rtol);
    positive("atol", "a number > 0", &mut options.atol);
    options.method = choose(&mut table, &METHODS, findings).unwrap_or_default();
    options.formulation = choose(&mut table, &FORMULATIONS, findings).unwrap_or_default();
    options.stabilisation = choose(&mut table, &STABILISATIONS, findings).unwrap_or_default();
    if let Some(field) = table.optional("drop") {
        options.rows = RowChoice::Drop(rows(&field, findings));
    }
    table.close(findings);
    t_end.map(|_| options)
}

/// A number within its bounds, refused in the words of `dynamics`.
fn bounded(
    field: &Field,
    within: impl Fn(f64) -> bool,
    expected: &'static str,
    findings: &mut Findings,
) -> Option<f64> {
    let value = field.number(findings)?;
    if within(value) {
        return Some(value);
    }
    let name = match field.key.as_str() {
        "t_end" => "t_end",
        "output_step" => "output_step",
        "rtol" => "rtol",
        _ => "atol",
    };
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
    let names = || choice.available.iter().map(|(name, _)| *name);
    let value = field.text(&format!("one of {}", list(names())), findings)?;
    if let Some((_, found)) = choice.available.iter().find(|(name, _)| *name == value) {
        return Some(*found);
    }
    let (message, label, help) = match choice.planned.contains(&value) {
        true => ("is not available yet", "not available yet", None),
        false => ("is unknown", "no such choice", did_you_mean(value, names())),
    };
    findings.error_with_help(
        field.span(),
        format!("{}: `{}` `{value}` {message}", field.subject, field.key),
        label,
        help.or_else(|| Some(format!("available are {}", list(names())))),
    );
    None
}

/// Rows to drop, counted from 1 in the file and from 0 in the result. That they exist is checked when the mechanism
/// is built.
fn rows(field: &Field, findings: &mut Findings) -> Vec<usize> {
    let mut rows: Vec<(usize, Field)> = Vec::new();
    for item in field
        .items("a list of rows, counted from 1", findings)
        .unwrap_or_default()
    {
        let Some(number) = item.integer("a list of rows, counted from 1", findings) else {
            continue;
        };
        let Some(row) = usize::try_from(number).ok().and_then(|n| n.checked_sub(1)) else {
            findings.error(
                item.span(),
                format!("{}: `drop` names row {number}; rows are counted from 1", field.subject),
                "no such row",
            );
            continue;
        };
        match rows.iter().find(|(earlier, _)| *earlier == row) {
            Some((_, first)) => findings.collision(
                item.span(),
                format!("{}: `drop` names row {number} twice", field.subject),
                "named again here",
                first.span(),
                "first named here",
            ),
            None => rows.push((row, item)),
        }
    }
    rows.into_iter().map(|(row, _)| row).collect()
}

/// Reports dropped rows that the mechanism does not have.
pub(crate) fn check_rows(field: &Field, n_rows: usize, findings: &mut Findings) {
    let Some(items) = field.value.get_ref().as_array() else {
        return;
    };
    for item in items {
        let item = Field {
            value: item,
            ..field.clone()
        };
        let number = crate::field::as_number(item.value.get_ref()).unwrap_or_default();
        if number > n_rows as f64 {
            findings.error(
                item.span(),
                format!("{}: `drop` names row {number}; rows are 1 to {n_rows}", field.subject),
                "no such row",
            );
        }
    }
}
