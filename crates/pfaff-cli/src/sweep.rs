//! `pfaff sweep`: many runs of one scene with other numbers, in parallel, resumable, in parts.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use pfaff::model::Registry;
use pfaff::report::{SweepDocument, SweepStatus, write_json};
use pfaff::sweep::{Sweep, SweepError, SweepProgress, SweepSettings, merge};

use crate::Outcome;
use crate::args;
use crate::input::Source;
use crate::output::{Failure, print, wrapped};
use crate::simulate::TRUSTED_BALANCE;

pub(crate) fn run(arguments: &args::Sweep) -> Outcome {
    let document = match &arguments.scene {
        Some(scene) if arguments.merge.is_empty() => {
            let source = Source::read(scene)?;
            make(arguments, &source).map_err(|e| match e {
                SweepError::Study(e) => source.failure(e),
                other => failure(&other),
            })?
        }
        _ => merge(&arguments.merge, &arguments.out).map_err(|e| failure(&e))?,
    };
    if arguments.json {
        let mut out = Vec::new();
        write_json(&mut out, &document).map_err(|e| Failure::stopped(e.to_string()))?;
        print(&String::from_utf8_lossy(&out))?;
    } else {
        print(&describe(&document, &arguments.out.display().to_string()))?;
    }
    Ok(())
}
