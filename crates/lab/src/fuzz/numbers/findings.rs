//! Findings for one mechanism: disagreements, and counted quantities.

/// A kind of disagreement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A component that is reported as determined differs between solutions at one state.
    States,
    /// A value of the product differs from the value of the reference solver at one state.
    Values,
    /// A requested solution of the product differs from the same solution of the reference solver.
    Choices,
    /// A component that is reported as determined differs between two runs.
    Runs,
    /// A component that is reported as not determined is determined at every state.
    Unexplained,
    /// A component that is reported as determined and not as ill-determined changes with a datum.
    Moves,
    /// The product rejects a mechanism that moves, or stops a motion that can continue.
    Refused,
    /// The product panics, or fails at a state for which the reference solver has a solution.
    Failed,
}

impl Kind {
    /// Returns the name of the kind.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::States => "(a) differs between solutions at one state",
            Self::Values => "(a) value of the product differs at one state",
            Self::Choices => "(a) choice of the product differs at one state",
            Self::Runs => "(a) differs between two runs",
            Self::Unexplained => "(b) not determined, without a difference",
            Self::Moves => "(c) not fragile, moves with a datum",
            Self::Refused => "(d) refused, and it moves",
            Self::Failed => "fails",
        }
    }

    /// Whether a single finding of this kind fails a campaign; a fraction of unexplained findings
    /// is permitted.
    #[must_use]
    pub fn is_wrong(self) -> bool {
        self != Self::Unexplained
    }
}

/// The text of a disagreement.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Kind of the finding.
    pub kind: Kind,
    /// Component, time and values.
    pub text: String,
}

/// Quantities that are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Count {
    /// Mechanisms whose run reached the end time.
    Ran,
    /// Runs that stopped before the end time for a valid reason: the configuration is near a
    /// singular configuration, or an independent integration also finds no continuation.
    Stopped,
    /// Runs that stopped at the maximum number of steps.
    Cut,
    /// Mechanisms that are rejected, and for which an independent computation also finds no motion.
    DoesNotMove,
    /// Mechanisms that are rejected at a singular configuration.
    SingularStart,
    /// Mechanisms that are rejected because no finite reactions exist: accelerations from rest
    /// violate the second-order equations.
    NoFinite,
    /// Mechanisms that are rejected because the given velocities are impossible.
    NoVelocities,
    /// Mechanisms that are rejected because the text of the scene has an error.
    NoScene,
    /// Mechanisms with redundant rows.
    Redundant,
    /// States without a result of the reference solver.
    Unclear,
    /// Values of determined components that were compared at one state.
    Values,
    /// Values of determined components that were compared between two runs.
    BetweenRuns,
    /// Rows of two runs with different states.
    OtherStates,
    /// Components that are reported as not determined, counted for each interval.
    NotDetermined,
    /// Components of the previous count that differ between two solutions.
    Differs,
    /// Components that are reported as not determined and have a part in the left null space, if no
    /// load acts along this part.
    NoLoad,
    /// Undecided components, counted for each interval.
    Undecided,
    /// Components with displaced data that are determined and not ill-determined.
    Sturdy,
    /// Components with displaced data that are determined and ill-determined.
    Fragile,
    /// Components of the previous count that change by more than 8 %.
    FragileChanges,
}

impl Count {
    /// Returns the name of the count.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ran => "mechanisms that ran to their end",
            Self::Stopped => {
                "runs that stopped because they could not continue, or at a singular pose"
            }
            Self::Cut => "runs that took too many steps",
            Self::DoesNotMove => "refused, and does not move",
            Self::SingularStart => "refused at a singular configuration",
            Self::NoFinite => "runs rejected because no reaction is finite",
            Self::NoVelocities => "runs rejected because no motion has the given velocities",
            Self::NoScene => "refused for the text",
            Self::Redundant => "mechanisms with redundant rows",
            Self::Unclear => "states near a lower rank, for which the oracle has no result",
            Self::Values => "determined values compared at one state",
            Self::BetweenRuns => "determined values compared between two runs",
            Self::OtherStates => "rows of two runs with different states",
            Self::NotDetermined => "components not determined on a stretch",
            Self::Differs => "  they differ between two solutions",
            Self::NoLoad => "  free components that no load affects",
            Self::Undecided => "components undecided on a stretch",
            Self::Sturdy => "determined, well-conditioned components, computed with displaced data",
            Self::Fragile => "fragile components with displaced data",
            Self::FragileChanges => "  ill-determined components that change by more than 8 %",
        }
    }
}

/// All findings for one mechanism.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// Disagreements.
    pub all: Vec<Finding>,
    /// Counted quantities.
    pub counts: std::collections::BTreeMap<Count, usize>,
}

impl Findings {
    /// Increases a count.
    pub fn count(&mut self, what: Count, number: usize) {
        *self.counts.entry(what).or_default() += number;
    }

    /// Adds a disagreement.
    pub fn note(&mut self, kind: Kind, text: String) {
        self.all.push(Finding { kind, text });
    }
}
