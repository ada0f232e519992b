//! Choices and permissions in the syntax of the command line.

use std::collections::HashSet;

use pfaff::StudyError;
use pfaff::model::ConstraintId;
use pfaff::solvability::{Allowed, Choice, Compliance, NormWeights};

use crate::input::{Source, rows_from_zero};
use crate::output::Failure;

/// Rows that `--allow` permits to be deleted, in a mechanism with this number of rows.
pub(crate) fn allowed(text: &str, rows: usize) -> Result<Allowed, Failure> {
    match (text, text.strip_prefix("rows:")) {
        ("sensible", _) => Ok(Allowed::Sensible),
        ("whole", _) => Ok(Allowed::Whole),
        ("rows", _) => Ok(Allowed::Rows((0..rows).collect())),
        (_, Some(list)) => Ok(Allowed::Rows(row_list("--allow", list, rows)?)),
        _ => Err(Failure::input(format!(
            "--allow is `{text}`, need `sensible`, `whole`, `rows`, or a list as `rows:4,6,21`"
        ))),
    }
}

/// What choices refer to: the number of rows of a mechanism, and its joints and drives by name.
pub(crate) type Named<'a> = (usize, &'a dyn Fn(&str) -> Result<ConstraintId, StudyError>);

/// The choices of `--choose`.
pub(crate) fn choices(
    texts: &[String],
    source: &Source,
    named: Named<'_>,
) -> Result<Vec<Choice>, Failure> {
    let each = texts.iter().map(|text| choice(text, source, named));
    each.collect()
}

fn choice(text: &str, source: &Source, (rows, reaction): Named<'_>) -> Result<Choice, Failure> {
    let (kind, rest) = match text.split_once(':') {
        Some((kind, rest)) => (kind, Some(rest)),
        None => (text, None),
    };
    match (kind, rest) {
        ("minimum-norm", None) => Ok(Choice::MinimumNorm(NormWeights::NEWTON_METRE)),
        ("minimum-norm", Some(rest)) => {
            let length = rest
                .strip_prefix("length=")
                .and_then(|x| x.parse::<f64>().ok());
            match length.filter(|x| x.is_finite() && *x > 0.0) {
                Some(length) => Ok(Choice::MinimumNorm(NormWeights::with_arm(length))),
                None => Err(wrong(
                    text,
                    "`length=` and an arm in m > 0, as `minimum-norm:length=0.5`",
                )),
            }
        }
        ("compliance", Some(rest)) => {
            let joints = rest
                .split(',')
                .map(|term| compliance(text, term, source, reaction));
            Ok(Choice::Compliance(joints.collect::<Result<_, _>>()?))
        }
        ("drop", Some(rest)) => Ok(Choice::Elimination(row_list("--choose drop", rest, rows)?)),
        ("compliance", None) => Err(wrong(
            text,
            "joints with compliances, as `compliance:W3=1e-6,W4=2e-6`",
        )),
        ("drop", None) => Err(wrong(text, "rows, as `drop:6,21`")),
        _ => Err(wrong(
            text,
            "`minimum-norm`, `minimum-norm:length=L`, `compliance:…` or `drop:…`",
        )),
    }
}

fn wrong(text: &str, expected: &str) -> Failure {
    Failure::input(format!("--choose is `{text}`, need {expected}"))
}

/// Parses `W3=1e-6` (m/N in every direction), or `W3=1e-6/1e-3` with rad/(N·m).
fn compliance(
    text: &str,
    term: &str,
    source: &Source,
    reaction: &dyn Fn(&str) -> Result<ConstraintId, StudyError>,
) -> Result<Compliance, Failure> {
    let expected =
        "NAME=COMPLIANCE in m/N, or NAME=COMPLIANCE/ROTATION with rad/(N·m), finite numbers ≥ 0";
    let (name, numbers) = term.rsplit_once('=').ok_or_else(|| wrong(text, expected))?;
    let reaction = reaction(name.trim()).map_err(|e| source.failure(e))?;
    let number = |word: &str| {
        let x = word.trim().parse::<f64>().ok();
        x.filter(|x| x.is_finite() && *x >= 0.0).ok_or_else(|| {
            let found = word.trim();
            Failure::input(format!(
                "--choose compliance: that of `{}` is {found}, need {expected}",
                name.trim()
            ))
        })
    };
    let (along, rotation) = match numbers.split_once('/') {
        Some((along, rotation)) => (number(along)?, number(rotation)?),
        None => (number(numbers)?, 0.0),
    };
    Ok(Compliance {
        reaction,
        along: [along; 3],
        rotation,
    })
}

/// Parses a list of rows, counted from 1, into existing rows from 0, each at most once.
fn row_list(option: &str, list: &str, rows: usize) -> Result<Vec<usize>, Failure> {
    let numbers: Result<Vec<usize>, _> = list.split(',').map(|x| x.trim().parse()).collect();
    let Ok(numbers) = numbers else {
        return Err(Failure::input(format!(
            "{option}: `{list}` is no list of rows, as `6,21`"
        )));
    };
    if let Some(row) = numbers.iter().find(|row| **row > rows) {
        return Err(Failure::input(format!(
            "{option}: there is no row {row}; rows are 1 to {rows}"
        )));
    }
    let mut listed = HashSet::new();
    if let Some(row) = numbers.iter().find(|row| !listed.insert(**row)) {
        return Err(Failure::input(format!(
            "{option}: row {row} is listed twice"
        )));
    }
    Ok(rows_from_zero(Some(&numbers))?.unwrap_or_default())
}
