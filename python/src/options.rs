//! Converts texts and numbers from Python to options of the library.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use pfaff::dynamics::OutputRequest;
use pfaff::dynamics::plan::{Reactions, Rows};
use pfaff::elasticity::elasticity;
use pfaff::memory::{Budget, Bytes};
use pfaff::model::System;
use pfaff::model::Tolerance;
use pfaff::refusal::Refusal;
use pfaff::scene::WantedBounds;
use pfaff::scene::nearest;
use pfaff::solvability::Elasticity;
use pfaff::{ConfigurationAnalysis, RunOptions, Study};
use pyo3::prelude::*;

use crate::fault::{Fault, wrong};

/// Options of a run.
#[derive(FromPyObject, Clone, Default)]
#[pyo3(from_item_all)]
pub(crate) struct RunKeywords {
    /// Options that replace the options of the scene, as JSON.
    run: String,
    pub(crate) common: Common,
    pub(crate) output_step: Option<f64>,
    /// Names of joints and drives; `None` for all.
    reactions: Option<Vec<String>>,
    /// Requested bounds.
    bounds: Option<BoundsKeywords>,
}

/// The elastic joints of bounds.
#[derive(FromPyObject, Clone)]
#[pyo3(from_item_all)]
struct BoundsKeywords {
    rigid: Vec<String>,
    within: Option<f64>,
    compliance: Option<String>,
}

impl RunKeywords {
    pub(crate) fn run(&self) -> Result<RunOptions, Fault> {
        let run = RunOptions::read(&self.run)?;
        Ok(RunOptions {
            threads: self.common.threads()?,
            ..run
        })
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

    /// Returns the requested bounds of a run. Without a request, returns the bounds that the scene
    /// requests.
    pub(crate) fn elasticity(&self, study: &Study) -> Result<Option<Elasticity>, Fault> {
        let own = self.bounds.clone().map(|own| WantedBounds {
            rigid: own.rigid,
            within: own.within,
            compliance: own.compliance,
        });
        let wanted = own.as_ref().or(study.scene.output.bounds.as_ref());
        let reaction = |name: &str| {
            let found = study.reaction(name);
            found.map_err(|e| Refusal::input(e.to_string()).coded(e.code()))
        };
        let layout = study.prepared.mechanism.layout();
        let found = wanted.map(|wanted| elasticity(wanted, layout, &reaction));
        Ok(found.transpose()?)
    }

    /// Rejects names of requested reactions that do not exist.
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
        Tolerance {
            length: self.tolerance,
            angle: self.angle_tolerance,
        }
    }

    pub(crate) fn budget(&self) -> Result<Budget, Fault> {
        budget(self.max_memory.as_ref())
    }

    pub(crate) fn threads(&self) -> Result<Option<NonZeroUsize>, Fault> {
        self.threads.map(threads).transpose()
    }
}

/// A size: a number of bytes, or a text such as `4GB`.
#[derive(FromPyObject, Clone)]
pub(crate) enum Size {
    #[pyo3(transparent)]
    Bytes(u64),
    #[pyo3(transparent)]
    Words(String),
}

/// Returns the memory limit: this size, or the available memory of the machine.
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

pub(crate) fn threads(threads: usize) -> Result<NonZeroUsize, Fault> {
    NonZeroUsize::new(threads).ok_or_else(|| wrong("threads is 0, need a number > 0".to_owned()))
}

/// Builds the error for an unknown name.
pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> Fault {
    let near = nearest(name, known.iter().copied());
    let advice = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    let known = known.join(", ");
    wrong(format!(
        "there is no {what} `{name}`; there are: {known}{advice}"
    ))
}

/// Converts row numbers that begin at 1 to row numbers that begin at 0.
pub(crate) fn rows_from_zero(rows: Option<&[usize]>) -> Result<Option<Vec<usize>>, Fault> {
    let Some(rows) = rows else { return Ok(None) };
    let from_zero: Option<Vec<usize>> = rows.iter().map(|row| row.checked_sub(1)).collect();
    match from_zero {
        Some(rows) => Ok(Some(rows)),
        None => Err(wrong(
            "row 0 does not exist: rows are counted from 1".to_owned(),
        )),
    }
}
