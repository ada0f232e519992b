//! Choices and permissions in the syntax of the command line.

use std::collections::HashSet;

use model::{ConstraintId, SpaceKind};
use solvability::{
    Centres, Choice, Compliance, DeletableRows, ElasticSupports, Misfit, NormWeights,
};

use crate::refusal::Refusal;
use crate::run_options::NO_ROW;

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

/// Finds a joint or drive by its name.
pub type FindReaction<'a> = &'a dyn Fn(&str) -> Result<ConstraintId, Refusal>;

/// The scope of choices: the space and the number of rows of a mechanism, and its joints and drives
/// by name.
pub type ChoiceScope<'a> = (SpaceKind, usize, FindReaction<'a>);

/// Parses the choices of `--choose`.
///
/// # Errors
/// Describes the expected text, or names the joint or drive that does not exist.
pub fn choices(texts: &[String], named: ChoiceScope<'_>) -> Result<Vec<Choice>, Refusal> {
    let each = texts.iter().map(|text| choice(text, named));
    each.collect()
}

fn choice(text: &str, (space, rows, reaction): ChoiceScope<'_>) -> Result<Choice, Refusal> {
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
            let (stiff, misfits) = match rest.split_once(";misfit:") {
                Some((stiff, misfits)) => (stiff, misfits.split(";misfit:").collect()),
                None => (rest, Vec::new()),
            };
            let misfits = misfits.into_iter();
            Ok(Choice::Compliance(ElasticSupports {
                compliances: compliances("--choose", stiff, reaction)?,
                misfits: misfits
                    .map(|term| misfit(term.trim(), space, reaction))
                    .collect::<Result<_, _>>()?,
                centres: Centres::default(),
            }))
        }
        ("drop", Some(rest)) => Ok(Choice::Elimination(row_list("--choose drop", rest, rows)?)),
        ("compliance", None) => Err(wrong(
            text,
            "joints with compliances, as `compliance:W3=1e-6,W4=2e-6`",
        )),
        ("drop", None) => Err(wrong(text, "rows, as `drop:6,21`")),
        _ => Err(wrong(
            text,
            "`minimum-norm`, `minimum-norm:length=L`, `compliance:…`, `compliance:…;misfit:…` or `drop:…`",
        )),
    }
}

fn wrong(text: &str, expected: &str) -> Refusal {
    Refusal::input(format!("--choose is `{text}`, need {expected}"))
}

/// Splits a list at its commas. A name may contain a comma.
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

/// Parses a list of compliances: `W3=1e-6` (m/N in every direction), or `W3=1e-6/1e-3` with
/// rad/(N·m).
///
/// # Errors
/// Describes the expected text of the option, or names the joint or drive that does not exist.
pub fn compliances(
    option: &str,
    text: &str,
    reaction: FindReaction<'_>,
) -> Result<Vec<Compliance>, Refusal> {
    let each = terms(text).into_iter();
    each.map(|term| compliance(option, term, reaction))
        .collect()
}

fn compliance(option: &str, term: &str, reaction: FindReaction<'_>) -> Result<Compliance, Refusal> {
    let expected =
        "NAME=COMPLIANCE in m/N, or NAME=COMPLIANCE/ROTATION with rad/(N·m), finite numbers ≥ 0";
    let (name, numbers) = term.rsplit_once('=').ok_or_else(|| {
        let message = format!("{option}: a compliance is `{term}`, need {expected}");
        Refusal::input(message)
    })?;
    let reaction = reaction(name.trim())?;
    let number = |word: &str| {
        let x = word.trim().parse::<f64>().ok();
        x.filter(|x| x.is_finite() && *x >= 0.0).ok_or_else(|| {
            let found = word.trim();
            Refusal::input(format!(
                "{option}: the compliance of `{}` is {found}, need {expected}",
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

/// Parses `A=dx,dy` (m), or `A=dx,dy,angle` with rad; in space `A=dx,dy,dz` and three angles.
fn misfit(term: &str, space: SpaceKind, reaction: FindReaction<'_>) -> Result<Misfit, Refusal> {
    let (translations, rotations) = (space.n_translations(), space.n_rotations());
    let expected = match rotations {
        1 => "NAME=DX,DY in m, or NAME=DX,DY,ANGLE with rad",
        _ => "NAME=DX,DY,DZ in m, or NAME=DX,DY,DZ,RX,RY,RZ with rad",
    };
    let wrong = || {
        let message = format!(
            "--choose: a misfit is `{term}`, need {expected}; `;misfit:` before each further joint"
        );
        Refusal::input(message)
    };
    let (name, numbers) = term.rsplit_once('=').ok_or_else(wrong)?;
    let has_two = |e| if name.contains('=') { wrong() } else { e };
    let reaction = reaction(name.trim()).map_err(has_two)?;
    let numbers = numbers.split(',').map(|word| {
        let x = word.trim().parse::<f64>().ok();
        x.filter(|x| x.is_finite()).ok_or_else(wrong)
    });
    let numbers = numbers.collect::<Result<Vec<f64>, _>>()?;
    if numbers.len() != translations && numbers.len() != translations + rotations {
        return Err(wrong());
    }
    let (mut along, mut rotation) = ([0.0; 3], [0.0; 3]);
    along[..translations].copy_from_slice(&numbers[..translations]);
    let turns = &numbers[translations..];
    rotation[3 - turns.len()..].copy_from_slice(turns);
    Ok(Misfit {
        reaction,
        along,
        rotation,
    })
}

/// Parses a list of rows (1-based). Returns the indices (0-based) of these rows without
/// repetitions, after a check that the rows exist.
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
