//! Words and numbers from Python as options of the library.

use std::num::NonZeroUsize;

use pfaff::ConfigurationAnalysis;
use pfaff::dynamics::plan::{Reactions, Rows};
use pfaff::dynamics::{Method, OutputRequest};
use pfaff::memory::{Budget, Bytes};
use pfaff::model::{ConstraintId, Mechanism, System, Tolerance};
use pfaff::scene::nearest;
use pfaff::solvability::{DeletableRows, Choice, Compliance, NormWeights};
use pfaff::{RunOptions as Overrides, StudyError};
use pyo3::prelude::*;

use crate::fault::{Fault, wrong};

/// Options of a run; what is `None` is that of the scene.
#[derive(FromPyObject, Clone, Default)]
#[pyo3(from_item_all)]
pub(crate) struct RunOptions {
    t_end: Option<f64>,
    rtol: Option<f64>,
    atol: Option<f64>,
    max_step: Option<f64>,
    max_steps: Option<u64>,
    method: Option<String>,
    threads: Option<usize>,
    /// Rows to drop, from 1.
    drop: Option<Vec<usize>>,
    pub(crate) output_step: Option<f64>,
    tolerance: Option<f64>,
    angle_tolerance: Option<f64>,
    /// Names of joints and drives; `None` for all.
    reactions: Option<Vec<String>>,
    max_memory: Option<Size>,
}

impl RunOptions {
    pub(crate) fn overrides(&self) -> Result<Overrides, Fault> {
        Ok(Overrides {
            t_end: self.t_end,
            rtol: self.rtol,
            atol: self.atol,
            max_step: self.max_step,
            max_steps: self.max_steps,
            method: self.method.as_deref().map(method).transpose()?,
            drop: rows_from_zero(self.drop.as_deref())?,
            threads: self.threads.map(threads).transpose()?,
            ..Overrides::default()
        })
    }

    pub(crate) fn tolerance(&self) -> Tolerance {
        tolerance(self.tolerance, self.angle_tolerance)
    }

    pub(crate) fn budget(&self) -> Result<Budget, Fault> {
        budget(self.max_memory.as_ref())
    }

    pub(crate) fn wanted(&self) -> OutputRequest {
        let reactions = match &self.reactions {
            None => Reactions::All,
            Some(names) if names.is_empty() => Reactions::None,
            Some(names) => Reactions::Of(names.clone()),
        };
        OutputRequest {
            rows: Rows::Every,
            accelerations: false,
            reactions,
            ..OutputRequest::default()
        }
    }

    /// Names of wanted reactions that do not exist are refused.
    pub(crate) fn check_names(&self, start: &ConfigurationAnalysis<'_>) -> Result<(), Fault> {
        for name in self.reactions.iter().flatten() {
            start.reaction(name)?;
        }
        Ok(())
    }
}

/// A size: bytes, or a text such as `4GB`.
#[derive(FromPyObject, Clone)]
pub(crate) enum Size {
    #[pyo3(transparent)]
    Bytes(u64),
    #[pyo3(transparent)]
    Words(String),
}

/// What may be taken of the memory: this size, or what the machine has left.
pub(crate) fn budget(limit: Option<&Size>) -> Result<Budget, Fault> {
    let limit = match limit {
        None => None,
        Some(Size::Bytes(bytes)) => Some(Bytes(*bytes)),
        Some(Size::Words(words)) => {
            let read = words.parse::<Bytes>();
            Some(read.map_err(|e| wrong(format!("max_memory: {e}")))?)
        }
    };
    Ok(Budget {
        limit,
        option: "max_memory",
    })
}

fn method(name: &str) -> Result<Method, Fault> {
    let found = Method::ALL.iter().find(|method| method.name() == name);
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
        unknown("method", name, &names)
    })
}

pub(crate) fn threads(threads: usize) -> Result<NonZeroUsize, Fault> {
    NonZeroUsize::new(threads).ok_or_else(|| wrong("threads is 0, need a number > 0".to_owned()))
}

/// The error for a name that is none of the known ones.
pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> Fault {
    let near = nearest(name, known.iter().copied());
    let advice = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    let known = known.join(", ");
    wrong(format!(
        "there is no {what} `{name}`; there are: {known}{advice}"
    ))
}

pub(crate) fn tolerance(length: Option<f64>, angle: Option<f64>) -> Tolerance {
    Tolerance { length, angle }
}

/// Rows from 0, from those of the caller, which are counted from 1.
pub(crate) fn rows_from_zero(rows: Option<&[usize]>) -> Result<Option<Vec<usize>>, Fault> {
    let Some(rows) = rows else { return Ok(None) };
    let from_zero: Option<Vec<usize>> = rows.iter().map(|row| row.checked_sub(1)).collect();
    match from_zero {
        Some(rows) => Ok(Some(rows)),
        None => Err(wrong(
            "rows are counted from 1; there is no row 0".to_owned(),
        )),
    }
}

/// What may be deleted: a word, or rows from 1.
#[derive(FromPyObject)]
pub(crate) enum Allow {
    #[pyo3(transparent)]
    Word(String),
    #[pyo3(transparent)]
    Rows(Vec<usize>),
}

impl Allow {
    pub(crate) fn allowed(&self, mechanism: &Mechanism) -> Result<DeletableRows, Fault> {
        match self {
            Self::Word(word) => match word.as_str() {
                "sensible" => Ok(DeletableRows::Sensible),
                "whole" => Ok(DeletableRows::Whole),
                "rows" => Ok(DeletableRows::Rows((0..mechanism.layout().rows()).collect())),
                _ => Err(unknown("permission", word, &["sensible", "whole", "rows"])),
            },
            Self::Rows(rows) => Ok(DeletableRows::Rows(
                rows_from_zero(Some(rows))?.unwrap_or_default(),
            )),
        }
    }
}

/// A choice of reactions that are not unique: the least norm, with the arm (m) on which a torque
/// counts as a force; compliances (m/N, rad/(N·m)) by name; or rows to drop, from 1.
#[derive(FromPyObject)]
pub(crate) enum Choose {
    #[pyo3(transparent)]
    Arm(Option<f64>),
    #[pyo3(transparent)]
    Drop(Vec<usize>),
    #[pyo3(transparent)]
    Compliances(Vec<(String, f64, f64)>),
}

impl Choose {
    pub(crate) fn choice(
        &self,
        reaction: &dyn Fn(&str) -> Result<ConstraintId, StudyError>,
    ) -> Result<Choice, Fault> {
        match self {
            Self::Arm(None) => Ok(Choice::MinimumNorm(NormWeights::NEWTON_METRE)),
            Self::Arm(Some(arm)) if arm.is_finite() && *arm > 0.0 => {
                Ok(Choice::MinimumNorm(NormWeights::with_arm(*arm)))
            }
            Self::Arm(Some(arm)) => Err(wrong(format!("length is {arm}, need an arm in m > 0"))),
            Self::Drop(rows) => Ok(Choice::Elimination(
                rows_from_zero(Some(rows))?.unwrap_or_default(),
            )),
            Self::Compliances(joints) => {
                let joint = |(name, along, rotation): &(String, f64, f64)| {
                    if [along, rotation]
                        .into_iter()
                        .any(|x| !(x.is_finite() && *x >= 0.0))
                    {
                        return Err(wrong(format!(
                            "the compliance of `{name}` is {along} m/N and {rotation} rad/(N·m), need finite numbers ≥ 0"
                        )));
                    }
                    Ok(Compliance {
                        reaction: reaction(name)?,
                        along: [*along; 3],
                        rotation: *rotation,
                    })
                };
                let joints: Result<_, Fault> = joints.iter().map(joint).collect();
                Ok(Choice::Compliance(joints?))
            }
        }
    }
}

/// A point: the name of a marker, or coordinates (m, ground axes).
#[derive(FromPyObject)]
pub(crate) enum About {
    #[pyo3(transparent)]
    Marker(String),
    #[pyo3(transparent)]
    Point(Vec<f64>),
}

impl About {
    pub(crate) fn point(&self, of: &ConfigurationAnalysis<'_>) -> Result<[f64; 3], Fault> {
        let n = of.mechanism.layout().space.n_translations();
        match self {
            Self::Marker(name) => of.marker(name).ok_or_else(|| {
                let observed = of.mechanism.frames();
                let markers = observed.observed().markers.iter();
                let names: Vec<&str> = markers.map(|marker| marker.name.as_str()).collect();
                unknown("marker", name, &names)
            }),
            Self::Point(numbers) if numbers.len() == n && numbers.iter().all(|x| x.is_finite()) => {
                let mut point = [0.0; 3];
                point[..n].copy_from_slice(numbers);
                Ok(point)
            }
            Self::Point(numbers) => Err(wrong(format!(
                "about is {numbers:?}, need {n} finite numbers (m), or the name of a marker"
            ))),
        }
    }
}
