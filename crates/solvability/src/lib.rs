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
//! | [`groups`] | combinations of reactions, resultants |
//! | [`frames`] | components in global, body and edge frames |
//! | [`choices`] | one solution among many, labelled |
//! | [`units`] | facts and choices told apart by a change of units |
//! | [`mechanism`] | the same for a mechanism: joints, wrenches, directions |
//! | `words` | dependencies as sentences |

pub mod choices;
pub mod existence;
pub mod frames;
pub mod generic;
pub mod groups;
pub mod matrices;
pub mod mechanism;
pub mod units;
pub mod verdict;
mod words;

pub use choices::{
    Choice, ChoiceError, Compliance, Distribution, Equations, Label, NormWeights, ReactionValues,
    Value, minimise,
};
pub use existence::{ConstraintLevel, Contradiction, contradiction};
pub use frames::{FrameForms, FrameVerdict, judge_frames};
pub use generic::is_permanent;
pub use groups::{
    Configuration, Group, GroupVerdict, LinearForm, RequestError, Term, judge_groups,
};
pub use matrices::Solvability;
pub use mechanism::{
    Analysis, AnalysisError, ComponentVerdict, Dependency, ReactionVerdict, RowVerdict, analyse,
    analyse_dropping, certify, certify_dropping, certify_holonomic,
};
pub use units::{Nature, UnitCheck, UnitError, Units, check_units};
pub use verdict::{Judgement, Verdict};
