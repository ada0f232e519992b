#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`verdict`] | unique, not unique, undecided: with the number behind it |
//! | [`matrices`] | solvability of a plain constraint matrix |
//! | [`existence`] | do the rows contradict each other? |
//! | [`generic`] | permanent, or only of this configuration? |
//! | [`groups`] | combinations of reactions |
//! | [`mechanism`] | the same for a mechanism: joints, wrenches, directions |
//! | [`structure`] | what the shape settles before any rank |
//! | [`explain`] | mixing, free directions and sentences |
//! | [`make_unique`] | what to delete so that a reaction becomes unique |
//! | `words` | dependencies as sentences |

mod certificate;
pub mod existence;
pub mod explain;
pub mod generic;
pub mod groups;
pub mod make_unique;
pub mod matrices;
pub mod mechanism;
pub mod structure;
pub mod verdict;
mod words;

pub use certificate::certify;
pub use existence::{ConstraintLevel, Contradiction, contradiction};
pub use explain::{
    Explanation, ExplanationError, FreeDirection, Mixing, ReactionExplanation, SelfStress, explain,
};
pub use generic::is_permanent;
pub use groups::{Group, Term, judge_groups};
pub use make_unique::{Allowed, Proposal, Proposals, make_unique};
pub use matrices::{QueryError, Solvability};
pub use mechanism::{
    Analysis, AnalysisError, ComponentVerdict, Dependency, ReactionVerdict, RowVerdict, analyse,
    analyse_dropping, decide, decide_dropping, decide_holonomic,
};
pub use structure::{judge_parts, structure};
pub use verdict::{Judgement, Verdict};
