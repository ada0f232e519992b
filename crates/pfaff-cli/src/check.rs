//! `pfaff check`: read and assemble, and say everything that is wrong.

use pfaff::model::System;
use pfaff::{Overrides, Study};
use serde_json::json;

use crate::Outcome;
use crate::args::Check;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{count, print};
use crate::watch;

pub(crate) fn run(arguments: &Check) -> Outcome {
    if arguments.watch {
        return watch::run(arguments);
    }
    Interrupt::ends_at_once()?;
    let source = Source::read(&arguments.scene)?;
    let study = source.study(&Overrides::default(), arguments.resources)?;
    match arguments.json {
        true => print(&format!("{:#}\n", facts(&study))),
        false => print(&describe(&study)),
    }
}

fn facts(study: &Study) -> serde_json::Value {
    let layout = study.prepared.mechanism.layout();
    json!({
        "ok": true,
        "scene": study.scene.description.name,
        "bodies": study.prepared.mechanism.bodies().len(),
        "coordinates": layout.n_q,
        "holonomic_rows": layout.m,
        "nonholonomic_rows": layout.h,
        "start_correction": correction(&study.prepared.assembly.correction),
        "start_velocity_correction": correction(&study.prepared.velocity_correction),
        "problems": [],
    })
}

/// In words.
pub(crate) fn describe(study: &Study) -> String {
    let layout = study.prepared.mechanism.layout();
    format!(
        "{}: {}, {}, {} ({} holonomic, {} nonholonomic)\n\
         assembled; the start was corrected by {:.1e} in position and {:.1e} in velocity\n",
        study.scene.description.name,
        count(study.prepared.mechanism.bodies().len(), "body", "bodies"),
        count(layout.groups.len(), "joint or drive", "joints and drives"),
        count(layout.rows(), "row", "rows"),
        layout.m,
        layout.h,
        correction(&study.prepared.assembly.correction),
        correction(&study.prepared.velocity_correction),
    )
}

fn correction(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}
