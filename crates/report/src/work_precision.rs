//! Error against run time: the results of `pfaff work-precision` as a table, a figure and a page.
//!
//! Not here: runs, references, and the judgement which method is the best.

mod page;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

pub use page::work_precision_page;
pub use table::WorkPrecisionTable;

/// How a run was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CurveName {
    /// Treatment of redundancy.
    pub formulation: &'static str,
    /// Integrator.
    pub method: &'static str,
    /// Treatment of drift.
    pub stabilisation: &'static str,
}

/// One run, or why there was none. Errors are scaled; see [`WorkPrecisionScene::reference`] for
/// what they are compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorkPrecisionRow {
    /// The scene.
    pub scene: String,
    /// How.
    #[serde(flatten)]
    pub curve: CurveName,
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// Of position, velocity, acceleration and unique reactions; NaN where nothing is known, or the
    /// run did not reach its end.
    pub errors: [f64; 4],
    /// Largest |Φ| or |C·v − b| at steps, all rows.
    pub constraint_residual: f64,
    /// Evaluations of accelerations.
    pub evaluations: u64,
    /// Projections of steps.
    pub projections: u64,
    /// Factorisations of iteration matrices of implicit methods.
    pub factorisations: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Shortest time of a run (s); NaN where the run did not reach its end.
    pub seconds: f64,
    /// `done`, or why the run did not reach its end.
    pub status: String,
    /// Rejected steps.
    pub rejected: u64,
    /// Runs whose time was taken.
    pub repetitions: u32,
    /// Largest |E − E₀ − work| relative to the largest kinetic energy.
    pub energy_error: f64,
    /// Largest difference of a coordinate or velocity from the reference, SI units.
    pub error_state: f64,
    /// How far the reference may be from the truth: the larger one of position and velocity.
    pub reference_limit: f64,
}

impl WorkPrecisionRow {
    /// A row of which nothing is known yet.
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

    /// The larger error of position and velocity, if the run reached its end and something is
    /// known.
    #[must_use]
    pub fn motion_error(&self) -> Option<f64> {
        let error = self.errors[0].max(self.errors[1]);
        (self.seconds.is_finite() && error.is_finite()).then_some(error)
    }
}

/// What the runs of a scene are compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReferenceDocument {
    /// Where the values come from.
    pub source: String,
    /// How far values of position, velocity, acceleration and reactions may be from the truth,
    /// scaled as the errors; NaN if nothing is known.
    pub limits: [f64; 4],
    /// How far the two best runs of different methods are apart, in words.
    pub agreement: String,
}

impl ReferenceDocument {
    /// How well the motion is known.
    #[must_use]
    pub fn motion_limit(&self) -> f64 {
        self.limits[0].max(self.limits[1])
    }
}

/// Who is the fastest up to an error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RankingLine {
    /// The error that is reached.
    pub error: f64,
    /// Curves that reach it with their time (s) and evaluations, the fastest first.
    pub places: Vec<Place>,
}

/// A curve at an error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Which curve.
    #[serde(flatten)]
    pub curve: CurveName,
    /// Time (s).
    pub seconds: f64,
    /// Evaluations.
    pub evaluations: f64,
}

/// All of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorkPrecisionScene {
    /// Its name.
    pub name: String,
    /// What it is.
    pub title: String,
    /// The method that is chosen if none is asked for.
    pub automatic: &'static str,
    /// What runs are compared with.
    pub reference: ReferenceDocument,
    /// Which method wins where, in words.
    pub summary: Vec<String>,
    /// The same in numbers.
    pub ranking: Vec<RankingLine>,
    /// All runs.
    pub rows: Vec<WorkPrecisionRow>,
}

/// Where and how the runs were made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Processor, cores, operating system.
    pub machine: String,
    /// Of the program and the compiler.
    pub versions: String,
    /// Day and time, UTC.
    pub date: String,
    /// The command that makes it again.
    pub command: String,
}

/// A whole comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorkPrecisionDocument {
    /// Where and how.
    pub provenance: Provenance,
    /// Whether it was interrupted before its end.
    pub partial: bool,
    /// All scenes together, in words.
    pub summary: Vec<String>,
    /// Scene by scene.
    pub scenes: Vec<WorkPrecisionScene>,
}
