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
//! | `words` | dependencies as sentences |

pub mod existence;
pub mod generic;
pub mod groups;
pub mod matrices;
pub mod mechanism;
pub mod verdict;
mod words;

pub use existence::{ConstraintLevel, Contradiction, contradiction};
pub use generic::is_permanent;
pub use groups::{Group, Term, judge_groups};
pub use matrices::{QueryError, Solvability};
pub use mechanism::{
    Analysis, AnalysisError, ComponentVerdict, Dependency, ReactionVerdict, RowVerdict, analyse,
    analyse_dropping, certify, certify_dropping, certify_holonomic,
};
pub use verdict::{Judgement, Verdict};
