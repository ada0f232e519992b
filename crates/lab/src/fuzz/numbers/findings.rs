//! Findings for one mechanism: disagreements, and counted numbers.

/// A kind of disagreement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A component that is called determined differs between solutions at one state.
    States,
    /// A value of the product differs from that of the oracle at one state.
    Values,
    /// A choice of the product differs from the same choice of the oracle.
    Choices,
    /// A component that is called determined differs between two runs.
    Runs,
    /// A component with a verdict that it depends on the choice is determined at every state.
    Unexplained,
    /// A component that is determined and not called ill-determined changes with a datum.
    Moves,
    /// The product rejects a mechanism that moves, or stops a motion that can continue.
    Refused,
    /// The product fails where the oracle has a solution, or panics.
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
    /// Component, time and numbers.
    pub text: String,
}

/// Quantities that are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Count {
    /// Mechanisms that ran to their end.
    Ran,
    /// Runs that stopped because an independent step does not continue or the configuration is
    /// singular.
    Stopped,
    /// Runs that reached the limit of steps.
    Cut,
    /// Mechanisms that are rejected and do not move.
    DoesNotMove,
    /// Mechanisms that are rejected at a singular configuration.
    SingularStart,
    /// Mechanisms that are rejected because no reaction is finite: accelerations from rest violate
    /// the second-order equations.
    NoFinite,
    /// Mechanisms that are rejected because the given velocities are impossible.
    NoVelocities,
    /// Mechanisms that are rejected because of the text.
    NoScene,
    /// Mechanisms with redundant rows.
    Redundant,
    /// States without a result of the oracle.
    Unclear,
    /// Values of determined components that were compared at one state.
    Values,
    /// Values of determined components that were compared between two runs.
    BetweenRuns,
    /// Rows of two runs with different states.
    OtherStates,
    /// Components that are called dependent on the choice, on their stretches.
    NotDetermined,
    /// Components among these that differ between two solutions.
    Differs,
    /// Components among these without any load along them: free in the null space.
    NoLoad,
    /// Components without a decision, on their stretches.
    Undecided,
    /// Components that are determined and not ill-determined, whose data were displaced.
    Sturdy,
    /// Components that are determined and ill-determined, whose data were displaced.
    Fragile,
    /// Components among these that change by more than 8 %.
    FragileChanges,
}

impl Count {
    /// Returns the name of the count.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ran => "mechanisms that ran to their end",
            Self::Stopped => "runs that stopped where they cannot continue, or at a singular pose",
            Self::Cut => "runs that took too many steps",
            Self::DoesNotMove => "refused, and does not move",
            Self::SingularStart => "refused at a singular configuration",
            Self::NoFinite => "refused, and no reaction is finite",
            Self::NoVelocities => "refused for velocities that no motion has",
            Self::NoScene => "refused for the text",
            Self::Redundant => "mechanisms with redundant rows",
            Self::Unclear => "states near a lower rank, without an answer of the oracle",
            Self::Values => "determined values compared at one state",
            Self::BetweenRuns => "determined values compared between two runs",
            Self::OtherStates => "rows of two runs with different states",
            Self::NotDetermined => "components not determined on a stretch",
            Self::Differs => "  they differ between two solutions",
            Self::NoLoad => "  they are free, and no load reaches them",
            Self::Undecided => "components undecided on a stretch",
            Self::Sturdy => "determined components, not fragile, with displaced data",
            Self::Fragile => "fragile components with displaced data",
            Self::FragileChanges => "  they change by more than 8 %",
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
