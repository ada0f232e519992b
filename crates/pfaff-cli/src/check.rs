//! `pfaff check`: read and assemble, and say everything that is wrong.

use pfaff::model::{Layout, Mechanism, System, start};
use pfaff::{Overrides, StudyError};
use serde_json::json;

use crate::Outcome;
use crate::args::Check;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, count, print, wrapped};
use crate::resources::Resources;
use crate::watch;

pub(crate) fn run(arguments: &Check) -> Outcome {
    if arguments.watch {
        return watch::run(arguments);
    }
    Interrupt::ends_at_once()?;
    arguments.resources.apply()?;
    let source = Source::read(&arguments.scene)?;
    let checked = Checked::of(&source, arguments.resources)?;
    match arguments.json {
        true => print(&format!("{:#}\n", checked.facts())),
        false => print(&checked.describe()),
    }
}

/// A scene that has been read and assembled.
pub(crate) struct Checked {
    scene: String,
    bodies: usize,
    layout: Layout,
    /// Largest change of a coordinate.
    position: f64,
    /// Largest change of a velocity; nothing where no motion begins.
    velocity: Option<f64>,
    /// Why it cannot be moved, where that is all that is wrong.
    warning: Option<String>,
}

impl Checked {
    /// Reads and assembles the scene. What `analyze` judges is no error here.
    pub(crate) fn of(source: &Source, resources: Resources) -> Result<Self, Failure> {
        let new = |scene: &str, mechanism: &Mechanism, correction: &[f64]| Self {
            scene: scene.to_owned(),
            bodies: mechanism.bodies().len(),
            layout: mechanism.layout().clone(),
            position: largest(correction),
            velocity: None,
            warning: None,
        };
        let blueprint = resources.blueprint(source)?;
        match source.prepare(blueprint, &Overrides::default()) {
            Ok(study) => {
                let p = &study.prepared;
                let checked = new(study.scene.name(), &p.mechanism, &p.assembly.correction);
                Ok(Self {
                    velocity: Some(largest(&p.velocity_correction)),
                    ..checked
                })
            }
            Err(e) => {
                let Some(warning) = e.only_motion() else {
                    return Err(source.failure(e));
                };
                let mut blueprint = resources.blueprint(source)?;
                let start = &blueprint.scene.start;
                let assembly =
                    start::assemble(&mut blueprint.mechanism, start).map_err(
                        |e| match blueprint.scene.locate_start(&e) {
                            Some(place) => source.failure(StudyError::Scene(vec![place])),
                            None => source.failure(StudyError::Motion(e.into())),
                        },
                    )?;
                let checked = new(
                    blueprint.scene.name(),
                    &blueprint.mechanism,
                    &assembly.correction,
                );
                Ok(Self {
                    warning: Some(warning),
                    ..checked
                })
            }
        }
    }

    fn facts(&self) -> serde_json::Value {
        json!({
            "ok": true,
            "scene": self.scene,
            "bodies": self.bodies,
            "coordinates": self.layout.n_q,
            "holonomic_rows": self.layout.m,
            "nonholonomic_rows": self.layout.h,
            "start_correction": self.position,
            "start_velocity_correction": self.velocity,
            "problems": [],
            "warnings": self.warning.as_slice(),
        })
    }

    /// In words.
    pub(crate) fn describe(&self) -> String {
        let velocity = match self.velocity {
            Some(correction) => format!(" and {correction:.1e} in velocity"),
            None => String::new(),
        };
        let warning = match &self.warning {
            Some(warning) => wrapped("warning: ", warning),
            None => String::new(),
        };
        format!(
            "{}: {}, {}, {} ({} holonomic, {} nonholonomic)\n\
             assembled; the start was corrected by {:.1e} in position{velocity}\n{warning}",
            self.scene,
            count(self.bodies, "body", "bodies"),
            count(
                self.layout.groups.len(),
                "joint or drive",
                "joints and drives"
            ),
            count(self.layout.rows(), "row", "rows"),
            self.layout.m,
            self.layout.h,
            self.position,
        )
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}
