//! Properties of an assembled scene.

use crate::documents::FreedomsDocument;
use model::words::rough;
use model::{Mechanism, System};
use scene::{Diagnostic, Scene};
use serde::Serialize;
use solvability::Freedoms;

use crate::question::Answer;
use crate::words::{Block, count, count_of_rows};

/// Result for a scene that was read and assembled.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CheckAnswer {
    /// `true`
    pub ok: bool,
    /// Name of the scene.
    pub scene: String,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of coordinates n_q.
    pub coordinates: usize,
    /// Number of velocities n_v.
    pub velocities: usize,
    /// Number of holonomic rows m.
    pub holonomic_rows: usize,
    /// Number of nonholonomic rows h.
    pub nonholonomic_rows: usize,
    /// The largest correction of a coordinate at the start (m, rad).
    pub start_correction: f64,
    /// The largest correction of a velocity (m/s, rad/s), if there is a motion.
    pub start_velocity_correction: Option<f64>,
    /// Mobility n_v − r.
    pub mobility: Option<usize>,
    /// Mobility without the drives.
    pub mobility_without_drives: Option<usize>,
    /// Whether no motion is possible; `null` if this is not decided.
    pub cannot_move: Option<bool>,
    /// Joints, drives, forces and groups that are in the scene, but not active.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inactive: Vec<String>,
    /// Warnings about the text with their positions; a scene with errors has no answer.
    pub problems: Vec<Diagnostic>,
    /// The same warnings as sentences, then warnings about the start. If the mechanism cannot be
    /// moved and there is no other error, the list also contains the reason.
    pub warnings: Vec<String>,
    /// Number of joints and drives.
    #[serde(skip)]
    pub reactions: usize,
    /// The mobility as text.
    #[serde(skip)]
    pub freedoms: Option<String>,
}

impl CheckAnswer {
    /// Builds the answer for an assembled scene. `correction` is the correction of the coordinates.
    pub(super) fn new((scene, mechanism): (&Scene, &Mechanism), correction: &[f64]) -> Self {
        let layout = mechanism.layout();
        Self {
            ok: true,
            scene: scene.name().to_owned(),
            bodies: mechanism.bodies().len(),
            coordinates: layout.n_of_bodies(),
            velocities: layout.n_v,
            holonomic_rows: layout.m,
            nonholonomic_rows: layout.h,
            start_correction: largest(correction),
            start_velocity_correction: None,
            mobility: None,
            mobility_without_drives: None,
            cannot_move: None,
            inactive: scene.inactive.iter().map(ToString::to_string).collect(),
            problems: scene.warnings.clone(),
            warnings: scene.cautions().collect(),
            reactions: layout.groups.len(),
            freedoms: None,
        }
    }

    /// Adds a warning about the start. If the scene has a text, the warning has positions.
    pub(super) fn warned(self, place: Option<Diagnostic>, text: &impl ToString) -> Self {
        let Self {
            mut warnings,
            mut problems,
            ..
        } = self;
        match place {
            Some(place) => {
                warnings.insert(problems.len(), place.sentence());
                problems.push(place);
            }
            None => warnings.push(text.to_string()),
        }
        Self {
            warnings,
            problems,
            ..self
        }
    }

    /// Adds the possible motions of the mechanism.
    pub(super) fn moving(self, freedoms: &Freedoms, mechanism: &Mechanism) -> Self {
        let document = FreedomsDocument::new(freedoms, mechanism);
        let warnings = self.warnings.iter().cloned();
        Self {
            warnings: warnings.chain(document.prevented()).collect(),
            mobility: Some(freedoms.mobility),
            mobility_without_drives: document.mobility_without_drives(),
            cannot_move: document.cannot_move,
            freedoms: Some(document.summary(freedoms.mobility)),
            ..self
        }
    }
}

impl Answer for CheckAnswer {
    fn words(&self) -> Vec<Block> {
        let bodies = count(self.bodies, "body", "bodies");
        let reactions = count(self.reactions, "joint or drive", "joints and drives");
        let rows = count_of_rows(self.holonomic_rows, self.nonholonomic_rows);
        let mut blocks = vec![Block::sentence(format!(
            "{}: {bodies}, {reactions}, {rows}",
            self.scene
        ))];
        blocks.extend(self.freedoms.iter().map(Block::sentence));
        let velocity = match self.start_velocity_correction {
            Some(correction) => format!(", velocity {correction}", correction = rough(correction)),
            None => String::new(),
        };
        blocks.push(Block::sentence(format!(
            "assembled; initial corrections: position {}{velocity}",
            rough(self.start_correction)
        )));
        if !self.inactive.is_empty() {
            blocks.push(Block::after("not active: ", self.inactive.join(", ")));
        }
        let codes = self
            .problems
            .iter()
            .map(|d| format!("warning[{}]: ", d.code));
        let heads = codes.chain(std::iter::repeat("warning: ".to_owned()));
        let warnings = heads.zip(&self.warnings);
        blocks.extend(warnings.map(|(head, warning)| Block::after(head, warning)));
        blocks
    }
}

/// Returns the largest absolute value of the numbers.
pub(super) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}
