//! What a user puts together.

use model::ConstraintId;

use super::error::RequestError;

/// What is to be judged.
#[derive(Clone, Debug, PartialEq)]
pub enum Group {
    /// The reactions of these joints and drives together: unique iff each is.
    Members(Vec<ConstraintId>),
    /// These joints and drives as if they were one: unique iff their total force on each body is.
    OneJoint(Vec<ConstraintId>),
    /// `Σ coefficient · component`: one number.
    Combination(Vec<Term>),
    /// `Σ coefficient · wrench`, each wrench as it acts on the first body of its joint, torques
    /// about the place of the first one.
    WrenchSum(Vec<(f64, ConstraintId)>),
    /// Everything that acts on these bodies from joints and drives, torques about the origin of the
    /// first. Newton and Euler make it unique.
    Resultant(Vec<usize>),
}

/// One component of a reaction, times a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The joint or drive.
    pub reaction: ConstraintId,
    /// `Fx`, `Fy`, `T`, or the named component of its definition.
    pub component: String,
    /// The number.
    pub coefficient: f64,
}

/// A group without members.
pub(crate) const NO_REACTION: RequestError = RequestError::Empty {
    of: "joint or drive",
};
