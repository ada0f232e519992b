//! Constraint violations of rows that are redundant only within a stated tolerance, and the
//! difference between the motions for two choices of independent rows.

use model::words::{quantity, rounded};
use std::fmt;

use dynamics::{Misfit, MotionError};
use model::SpaceKind;
use model::space::norm;
use serde::Serialize;

use super::from_one;

/// The largest constraint violation of a redundant row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MisfitDocument {
    /// The row, counted from 1.
    pub row: usize,
    /// Joint or drive of the row.
    pub joint: String,
    /// The row within the joint.
    pub component: String,
    /// The largest constraint violation, in `unit`.
    pub largest: f64,
    /// Time of the largest violation (s).
    pub time: f64,
    /// The violation that data within their tolerances explain at that time, in `unit`.
    pub bound: f64,
    /// m or rad; m/s or rad/s for a nonholonomic row.
    pub unit: &'static str,
    /// For angles: the violation times the size of the mechanism (m, or m/s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_size: Option<f64>,
}

/// Largest number of violations that are printed as text. `summary.json` contains all violations.
const TOLD: usize = 12;

impl MisfitDocument {
    /// Returns one line of text for each of the first violations, and a line with the number of the
    /// other violations.
    #[must_use]
    pub fn lines(misfits: &[Self]) -> Vec<String> {
        let mut lines: Vec<String> = misfits.iter().take(TOLD).map(Self::to_string).collect();
        match misfits.len().saturating_sub(TOLD) {
            0 => {}
            more => lines.push(format!("{more} more rows are violated, see summary.json")),
        }
        lines
    }
}

impl From<&Misfit> for MisfitDocument {
    fn from(misfit: &Misfit) -> Self {
        Self {
            row: misfit.row + 1,
            joint: misfit.label.joint.clone(),
            component: misfit.label.row.to_owned(),
            largest: misfit.largest,
            time: misfit.time,
            bound: misfit.bound,
            unit: misfit.unit,
            at_size: misfit.at_size,
        }
    }
}

impl fmt::Display for MisfitDocument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            row,
            joint,
            component,
            largest,
            time,
            bound,
            unit,
            ..
        } = self;
        write!(
            f,
            "`{joint}` would have to give {} at t = {} s (row {row}, {component}; the tolerance explains {})",
            quantity(*largest, unit),
            rounded(*time),
            quantity(*bound, unit)
        )
    }
}

/// Difference between the motions for two choices of independent rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SpreadDocument {
    /// The rows that the other choice deletes, counted from 1.
    pub deleted_rows: Vec<usize>,
    /// Largest distance of a centre of mass (m).
    pub position: f64,
    /// Largest difference of an angle (rad).
    pub angle: f64,
    /// Time at which the distance is largest, or the angle if all distances are zero (s).
    pub time: f64,
    /// Reason why the other run stopped; the numbers hold up to that time.
    pub error: Option<String>,
}

impl SpreadDocument {
    /// Starts without a difference. The argument contains the redundant rows of the other choice
    /// (0-based).
    #[must_use]
    pub fn new(dropped: &[usize]) -> Self {
        Self {
            deleted_rows: from_one(dropped),
            position: 0.0,
            angle: 0.0,
            time: 0.0,
            error: None,
        }
    }

    /// Describes a run on other rows that could not begin. The argument contains the redundant rows
    /// (0-based).
    #[must_use]
    pub fn stopped(dropped: &[usize], error: &MotionError) -> Self {
        Self {
            error: Some(error.to_string()),
            ..Self::new(dropped)
        }
    }

    /// Adds the displacements between both runs at one time, along the columns of C.
    pub fn take(&mut self, t: f64, apart: &[f64], space: SpaceKind) {
        let before = (self.position, self.angle);
        for body in apart.chunks_exact(space.n_v()) {
            self.position = self.position.max(norm(&body[space.forces()]));
            self.angle = self.angle.max(norm(&body[space.torques()]));
        }
        if self.position > before.0 || self.position == 0.0 && self.angle > before.1 {
            self.time = t;
        }
    }
}

impl fmt::Display for SpreadDocument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows: Vec<String> = self.deleted_rows.iter().map(usize::to_string).collect();
        let rows = rows.join(", ");
        match &self.error {
            None => write!(
                f,
                "with rows {rows} deleted instead, the motion differs by up to {} and {} (t = {} s)",
                quantity(self.position, "m"),
                quantity(self.angle, "rad"),
                rounded(self.time)
            ),
            Some(error) => write!(
                f,
                "with rows {rows} deleted instead, the run stops: {error}; up to there the motion differs by {} and {}",
                quantity(self.position, "m"),
                quantity(self.angle, "rad")
            ),
        }
    }
}
