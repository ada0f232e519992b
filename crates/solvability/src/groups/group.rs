//! Groups of reactions that the user defines.

use model::ConstraintId;

use super::error::RequestError;

/// A group on which a verdict is requested.
#[derive(Clone, Debug, PartialEq)]
pub enum Group {
    /// The reactions of these joints and drives together: unique iff every one of them is unique.
    Members(Vec<ConstraintId>),
    /// These joints and drives as if they were one joint: unique iff their total wrench on each
    /// body is unique.
    OneJoint(Vec<ConstraintId>),
    /// `Σ coefficient · component`: one number.
    Combination(Vec<Term>),
    /// `Σ coefficient · wrench`, each wrench as it acts on the first body of its joint, torques
    /// about the place of the first one.
    WrenchSum(Vec<(f64, ConstraintId)>),
    /// The total of all joints and drives that act on these bodies, torques about the origin of the
    /// first body. It is unique by the Newton-Euler equations.
    Resultant(Vec<usize>),
}

/// One component of a reaction, times a coefficient.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// `Fx`, `Fy`, `T`, or the named component of its definition.
    pub component: String,
    /// The coefficient.
    pub coefficient: f64,
}

/// A group without members.
pub(crate) const NO_REACTION: RequestError = RequestError::Empty {
    of: "joint or drive",
};
