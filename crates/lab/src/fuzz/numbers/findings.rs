//! What is found at one mechanism: disagreements, and numbers that are counted.

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
    /// A component that is called a matter of choice is determined at every state.
    Unexplained,
    /// A component that is determined and not called fragile moves with a datum.
    Moves,
    /// The product refuses a mechanism that moves, or stops where it goes on.
    Refused,
    /// The product fails where the oracle has a solution, or panics.
    Failed,
}

impl Kind {
    /// Its name.
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

    /// Whether one of it fails a campaign; of unexplained ones a share is permitted.
    #[must_use]
    pub fn is_wrong(self) -> bool {
        self != Self::Unexplained
    }
}

/// A disagreement in words.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Its kind.
    pub kind: Kind,
    /// Component, time and numbers.
    pub text: String,
}

/// Things that are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Count {
    /// Mechanisms that ran to their end.
    Ran,
    /// Runs that stopped, where an own step does not go on or the configuration is singular.
    Stopped,
    /// Runs that took too many steps.
    Cut,
    /// Mechanisms that are refused and do not move.
    DoesNotMove,
    /// Mechanisms that are refused at a singular configuration.
    SingularStart,
    /// Mechanisms that are refused because no reaction is finite, where accelerations from rest
    /// break the equations of second order.
    NoFinite,
    /// Mechanisms that are refused for given velocities that no motion has.
    NoVelocities,
    /// Mechanisms that are refused for the text.
    NoScene,
    /// Mechanisms with redundant rows.
    Redundant,
    /// States without an answer of the oracle.
    Unclear,
    /// Values of determined components that were compared at one state.
    Values,
    /// The same between two runs.
    BetweenRuns,
    /// Rows of two runs with different states.
    OtherStates,
    /// Components that are called a matter of choice, on their stretches.
    NotDetermined,
    /// Those that differ between two solutions.
    Differs,
    /// Those that no load reaches: free in the null space.
    NoLoad,
    /// Components without a decision, on their stretches.
    Undecided,
    /// Components that are determined and not fragile, whose data were displaced.
    Sturdy,
    /// Components that are determined and fragile, whose data were displaced.
    Fragile,
    /// Those of them that change by more than 8 %.
    FragileChanges,
}

impl Count {
    /// What it counts.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ran => "mechanisms that ran to their end",
            Self::Stopped => "runs that stopped where they cannot go on, or at a singular pose",
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

/// All of one mechanism.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// Disagreements.
    pub all: Vec<Finding>,
    /// What was counted.
    pub counts: std::collections::BTreeMap<Count, usize>,
}

impl Findings {
    /// Counts.
    pub fn count(&mut self, what: Count, number: usize) {
        *self.counts.entry(what).or_default() += number;
    }

    /// Notes a disagreement.
    pub fn note(&mut self, kind: Kind, text: String) {
        self.all.push(Finding { kind, text });
    }
}
