//! Words and numbers from Python as options of the library.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use pfaff::ConfigurationAnalysis;
use pfaff::RunOptions as Overrides;
use pfaff::dynamics::plan::{Reactions, Rows};
use pfaff::dynamics::{Method, OutputRequest};
use pfaff::memory::{Budget, Bytes};
use pfaff::model::Tolerance;
use pfaff::scene::nearest;
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

/// Keywords of all questions.
#[derive(FromPyObject, Clone, Default)]
#[pyo3(from_item_all)]
pub(crate) struct Common {
    tolerance: Option<f64>,
    angle_tolerance: Option<f64>,
    threads: Option<usize>,
    max_memory: Option<Size>,
    pub(crate) out: Option<PathBuf>,
}

impl Common {
    pub(crate) fn tolerance(&self) -> Tolerance {
        tolerance(self.tolerance, self.angle_tolerance)
    }

    pub(crate) fn budget(&self) -> Result<Budget, Fault> {
        budget(self.max_memory.as_ref())
    }

    pub(crate) fn threads(&self) -> Result<Option<NonZeroUsize>, Fault> {
        self.threads.map(threads).transpose()
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
