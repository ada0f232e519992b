//! Choices and permissions in the syntax of the command line.

use std::collections::HashSet;

use model::ConstraintId;
use solvability::{Choice, Compliance, DeletableRows, NormWeights};

use crate::error::StudyError;
use crate::refusal::Refusal;
use crate::run_options::NO_ROW;
use crate::start::Start;

/// Rows that `--allow` permits to be deleted, in a mechanism with this number of rows.
///
/// # Errors
/// Describes the expected text.
pub fn allowed(text: &str, rows: usize) -> Result<DeletableRows, Refusal> {
    match (text, text.strip_prefix("rows:")) {
        ("sensible", _) => Ok(DeletableRows::Sensible),
        ("whole", _) => Ok(DeletableRows::Whole),
        ("rows", _) => Ok(DeletableRows::Rows((0..rows).collect())),
        (_, Some(list)) => Ok(DeletableRows::Rows(row_list("--allow", list, rows)?)),
        _ => Err(Refusal::input(format!(
            "--allow is `{text}`, need `sensible`, `whole`, `rows`, or a list as `rows:4,6,21`"
        ))),
    }
}

/// The scope of choices: the number of rows of a mechanism, and its joints and drives by name.
pub type ChoiceScope<'a> = (usize, &'a dyn Fn(&str) -> Result<ConstraintId, StudyError>);

/// Parses the choices of `--choose`.
///
/// # Errors
/// Describes the expected text, or names the joint or drive that does not exist.
pub fn choices(
    texts: &[String],
    of: &Start<'_>,
    named: ChoiceScope<'_>,
) -> Result<Vec<Choice>, Refusal> {
    let each = texts.iter().map(|text| choice(text, of, named));
    each.collect()
}

fn choice(
    text: &str,
    of: &Start<'_>,
    (rows, reaction): ChoiceScope<'_>,
) -> Result<Choice, Refusal> {
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
            let joints = terms(rest).into_iter();
            let joints = joints.map(|term| compliance(text, term, of, reaction));
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

fn wrong(text: &str, expected: &str) -> Refusal {
    Refusal::input(format!("--choose is `{text}`, need {expected}"))
}

/// Splits a list at its commas; a name may contain a comma.
fn terms(text: &str) -> Vec<&str> {
    let (mut terms, mut begin) = (Vec::new(), 0);
    let commas = text.match_indices(',').map(|(at, _)| at);
    for end in commas.chain([text.len()]) {
        if text[begin..end].contains('=') || end == text.len() {
            terms.push(&text[begin..end]);
            begin = end + 1;
        }
    }
    terms
}

/// Parses `W3=1e-6` (m/N in every direction), or `W3=1e-6/1e-3` with rad/(N·m).
fn compliance(
    text: &str,
    term: &str,
    of: &Start<'_>,
    reaction: &dyn Fn(&str) -> Result<ConstraintId, StudyError>,
) -> Result<Compliance, Refusal> {
    let expected =
        "NAME=COMPLIANCE in m/N, or NAME=COMPLIANCE/ROTATION with rad/(N·m), finite numbers ≥ 0";
    let (name, numbers) = term.rsplit_once('=').ok_or_else(|| wrong(text, expected))?;
    let reaction = reaction(name.trim()).map_err(|e| of.refusal(e))?;
    let number = |word: &str| {
        let x = word.trim().parse::<f64>().ok();
        x.filter(|x| x.is_finite() && *x >= 0.0).ok_or_else(|| {
            let found = word.trim();
            Refusal::input(format!(
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

/// Parses a list of rows, counted from 1, into indices of existing rows, counted from 0, without
/// repetition.
fn row_list(option: &str, list: &str, rows: usize) -> Result<Vec<usize>, Refusal> {
    let numbers: Result<Vec<usize>, _> = list.split(',').map(|x| x.trim().parse()).collect();
    let Ok(numbers) = numbers else {
        return Err(Refusal::input(format!(
            "{option}: `{list}` is not a list of rows such as `6,21`"
        )));
    };
    if let Some(row) = numbers.iter().find(|row| **row > rows) {
        return Err(Refusal::input(format!(
            "{option}: there is no row {row}; rows are 1 to {rows}"
        )));
    }
    let mut listed = HashSet::new();
    if let Some(row) = numbers.iter().find(|row| !listed.insert(**row)) {
        return Err(Refusal::input(format!(
            "{option}: row {row} is listed twice"
        )));
    }
    let from_zero = numbers.iter().map(|row| row.checked_sub(1)).collect();
    Option::ok_or_else(from_zero, || Refusal::input(NO_ROW.to_owned()))
}
