//! Error against run time: the results of `pfaff work-precision` as a table, a figure and a page.
//!
//! The crate `pfaff` contains the runs, the references and the comparison of methods.

mod page;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

pub use page::work_precision_page;
pub use table::WorkPrecisionTable;

/// Methods of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CurveName {
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Integration method.
    pub method: &'static str,
    /// Method that prevents drift from the constraints.
    pub stabilisation: &'static str,
}

/// One run, or the reason why it failed. Errors are scaled; [`WorkPrecisionScene::reference`]
/// describes the reference values.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorkPrecisionRow {
    /// Name of the scene.
    pub scene: String,
    /// Formulation, integrator and stabilisation.
    #[serde(flatten)]
    pub curve: CurveName,
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// Errors of position, velocity, acceleration and unique reactions; NaN without a reference, or
    /// if the run did not reach its end.
    pub errors: [f64; 4],
    /// Largest |Φ| or |C·v − b| at steps, all rows.
    pub constraint_residual: f64,
    /// Number of evaluations of accelerations.
    pub evaluations: u64,
    /// Number of projections of steps.
    pub projections: u64,
    /// Number of factorisations of iteration matrices of implicit methods.
    pub factorisations: u64,
    /// Number of accepted steps.
    pub steps: u64,
    /// Shortest time of a run (s); NaN if the run did not reach its end.
    pub seconds: f64,
    /// `done`, or the reason why the run did not reach its end.
    pub status: String,
    /// Number of rejected steps.
    pub rejected: u64,
    /// Number of timed runs.
    pub repetitions: u32,
    /// Largest |E − E₀ − work| relative to the largest kinetic energy.
    pub energy_error: f64,
    /// Largest difference of a coordinate or velocity from the reference, SI units.
    pub error_state: f64,
    /// Bound on the error of the reference: the larger one of position and velocity.
    pub reference_limit: f64,
}

impl WorkPrecisionRow {
    /// A row without results.
    #[must_use]
    pub fn empty(scene: &str, curve: CurveName, tolerance: f64) -> Self {
        Self {
            scene: scene.to_owned(),
            curve,
            tolerance,
            errors: [f64::NAN; 4],
            constraint_residual: f64::NAN,
            evaluations: 0,
            projections: 0,
            factorisations: 0,
            steps: 0,
            seconds: f64::NAN,
            status: "done".to_owned(),
            rejected: 0,
            repetitions: 0,
            energy_error: f64::NAN,
            error_state: f64::NAN,
            reference_limit: f64::NAN,
        }
    }

    /// Returns the larger error of position and velocity. Returns `None` if the run did not reach
    /// its end or there is no reference.
    #[must_use]
    pub fn motion_error(&self) -> Option<f64> {
        let error = self.errors[0].max(self.errors[1]);
        (self.seconds.is_finite() && error.is_finite()).then_some(error)
    }
}

/// The reference values of the runs of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ReferenceDocument {
    /// Source of the values.
    pub source: String,
    /// Bounds on the error of position, velocity, acceleration and reactions of the reference,
    /// scaled like the errors; NaN if unknown.
    pub limits: [f64; 4],
    /// Difference between the two best runs of different methods, as text.
    pub agreement: String,
}

impl ReferenceDocument {
    /// Bound on the error of the motion, which is the larger bound of position and velocity.
    #[must_use]
    pub fn motion_limit(&self) -> f64 {
        self.limits[0].max(self.limits[1])
    }
}

/// The ranking of curves for an error.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RankingLine {
    /// The target error.
    pub error: f64,
    /// Curves that reach the target error, with their time (s) and evaluations, the fastest first.
    pub places: Vec<Place>,
}

/// A curve at a target error.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Place {
    /// The curve.
    #[serde(flatten)]
    pub curve: CurveName,
    /// Time (s).
    pub seconds: f64,
    /// Number of evaluations.
    pub evaluations: f64,
}

/// All results of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorkPrecisionScene {
    /// Name of the scene.
    pub name: String,
    /// Description of the scene.
    pub title: String,
    /// The method that is chosen automatically.
    pub automatic: &'static str,
    /// The reference values.
    pub reference: ReferenceDocument,
    /// The fastest methods, as text.
    pub summary: Vec<String>,
    /// The ranking as numbers.
    pub ranking: Vec<RankingLine>,
    /// All runs.
    pub rows: Vec<WorkPrecisionRow>,
}

/// The machine, versions, date and command of the runs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Provenance {
    /// Processor, cores, operating system.
    pub machine: String,
    /// Versions of the program and the compiler.
    pub versions: String,
    /// Date and time, UTC.
    pub date: String,
    /// The command that reproduces the comparison.
    pub command: String,
}

/// A complete comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorkPrecisionDocument {
    /// The machine, versions, date and command of the runs.
    pub provenance: Provenance,
    /// Whether the comparison was interrupted before its end.
    pub partial: bool,
    /// Summary of all scenes as text.
    pub summary: Vec<String>,
    /// Results by scene.
    pub scenes: Vec<WorkPrecisionScene>,
}
