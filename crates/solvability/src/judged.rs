//! Results for one part: verdicts on the joints and drives of the part, and dependencies of its
//! rows.

use model::{ConstraintId, Mechanism, SpaceKind, System};
use rank::RankStatus;

use crate::error::AnalysisError;
use crate::freedoms::PartialRanks;
use crate::matrices::QueryError;
use crate::parts::{Extent, PartAnalysis, PartDecision};
use crate::verdict::Judgement;

/// The verdict on a joint or drive.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionVerdict {
    /// The joint or drive.
    pub id: ConstraintId,
    /// Name of the joint or drive.
    pub name: String,
    /// The space of the mechanism.
    pub space: SpaceKind,
    /// Type of the joint or drive in scene files.
    pub kind: &'static str,
    /// Verdict on the wrench. The wrench is unique iff `B_X = 0` and no component is free because
    /// of a row that moves no body, such as a row between two parts of the ground.
    pub wrench: Judgement,
    /// Verdict on all multipliers together. The multipliers are unique iff `Z_X = 0`.
    pub multipliers: Judgement,
    /// Verdicts on each row of the joint or drive.
    pub rows: Vec<RowVerdict>,
    /// Verdicts on each component of the reaction that is not identically zero, and on the `load`
    /// of a coupling.
    pub components: Vec<ComponentVerdict>,
    /// The components that are zero at this configuration under any load, such as the force along a
    /// knife edge. Such components are unique, but not informative.
    pub zero_components: Vec<&'static str>,
    /// Basis of the unique directions, in these components.
    pub unique_directions: Vec<Vec<f64>>,
    /// Basis of the unique directions that are not zero under any load. These directions are
    /// perpendicular to the directions in which the reaction is zero at this configuration. `None`
    /// if the number of directions is undecided. In this case the list of unique directions is
    /// empty as well.
    pub live_directions: Option<Vec<Vec<f64>>>,
    /// The largest component of the reaction that counts as zero within the tolerance of the scene.
    /// The directions are unique because this component counts as zero. The value is zero if no
    /// component counts as zero.
    pub directions_left_out: f64,
}

impl ReactionVerdict {
    /// Returns whether the named component of the reaction is unique. A component that is zero
    /// under any load is unique. The named component of a definition, such as `N` of a knife edge,
    /// is unique if the wrench is unique.
    #[must_use]
    pub fn determines(&self, component: &str) -> bool {
        if self.wrench.verdict.is_unique() || self.zero_components.contains(&component) {
            return true;
        }
        let mut components = self.components.iter();
        components.any(|c| c.name == component && c.judgement.verdict.is_unique())
    }
}

/// The verdict on one row.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RowVerdict {
    /// Row of C, from 0.
    pub row: usize,
    /// Verdict on the multiplier of the row.
    pub judgement: Judgement,
}

/// The verdict on one component of a reaction.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ComponentVerdict {
    /// Name of the component: `Fx`, `Fy` or `T`; in space `Fx` to `Tz`; or the named component of a
    /// definition.
    pub name: &'static str,
    /// Verdict on the component.
    pub judgement: Judgement,
}

/// A minimal set of dependent rows.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Dependency {
    /// Rows of C, from 0.
    pub rows: Vec<usize>,
    /// Coefficients of `Σ coefficient·row = 0`; the largest coefficient is 1.
    pub coefficients: Vec<f64>,
    /// The largest coefficient (for scaled rows) that counts as zero only within the tolerance of
    /// the scene; zero if there is no such coefficient.
    pub left_out: f64,
    /// Explanation as text.
    pub text: String,
}

/// Results for a part. The results have the numbering of the part until [`Self::placed`] is called.
pub(crate) struct PartResults {
    pub(crate) part: PartAnalysis,
    pub(crate) reactions: Vec<ReactionVerdict>,
    pub(crate) dependencies: Vec<Dependency>,
    pub(crate) warnings: Vec<String>,
}

impl PartResults {
    /// Creates the results of a part at time t from its decided rank and from the ranks of some of
    /// its rows. `verdict` returns the verdict on each joint and drive. The results do not list
    /// dependencies.
    pub(crate) fn new(
        mechanism: &Mechanism,
        t: f64,
        size: f64,
        decision: PartDecision,
        ranks: PartialRanks,
        verdict: impl Fn(ConstraintId) -> Result<ReactionVerdict, QueryError>,
    ) -> Result<Self, AnalysisError> {
        let reactions = mechanism.layout().constraint_ids().map(verdict);
        let reactions = reactions
            .collect::<Result<_, _>>()
            .map_err(|source| AnalysisError::Query { time: t, source })?;
        let mut warnings = ranks.warnings;
        if let RankStatus::Undecided(doubt) = decision.status() {
            warnings.push(format!(
                "the rank is undecided, and with it every verdict: {doubt}"
            ));
        }
        Ok(Self {
            part: PartAnalysis {
                extent: Extent::Whole,
                size,
                rank_holonomic: ranks.holonomic,
                rank_nonholonomic: ranks.nonholonomic,
                without_drives: ranks.without_drives,
                nearly_redundant: None,
                certificate: decision.evidence().certificate.clone(),
                decision,
            },
            reactions,
            dependencies: Vec::new(),
            warnings,
        })
    }

    /// Returns the results in the numbering of the whole mechanism. Warnings contain the name of
    /// the part.
    pub(crate) fn placed(mut self, whole: &Mechanism, extent: Extent) -> Self {
        if extent.is_whole() {
            return self;
        }
        for reaction in &mut self.reactions {
            reaction.id = ConstraintId(extent.group(reaction.id.0));
            for row in &mut reaction.rows {
                row.row = extent.row(row.row);
            }
        }
        for dependency in &mut self.dependencies {
            for row in &mut dependency.rows {
                *row = extent.row(*row);
            }
        }
        for warning in &mut self.warnings {
            *warning = format!("{}: {warning}", extent.name(whole));
        }
        self.part.extent = extent;
        self
    }
}
