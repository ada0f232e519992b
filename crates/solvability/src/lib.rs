#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`verdict`] | unique, not unique, undecided: with the number behind it |
//! | [`matrices`] | solvability of a plain constraint matrix |
//! | [`mod@rows`] | what a motion needs: independent rows, also of large mechanisms |
//! | [`state`] | a state that the caller gives |
//! | [`existence`] | do the rows contradict each other? |
//! | [`mod@generic`] | permanent, or only of this configuration? |
//! | [`groups`] | combinations of reactions, resultants |
//! | [`frames`] | components in global, body and edge frames |
//! | [`choices`] | one solution among many, labelled |
//! | [`units`] | facts and choices told apart by a change of units |
//! | [`mechanism`] | the same for a mechanism: joints, wrenches, directions |
//! | `certificate` | the rank in double-double at a polished point |
//! | [`mod@structure`] | what the shape settles before any rank |
//! | `large` | the rank of one large set of joints, decided sparsely |
//! | [`mod@survey`] | large mechanisms, cycle by cycle |
//! | [`mod@explain`] | mixing, free directions and sentences |
//! | [`mod@make_unique`] | what to delete so that a reaction becomes unique |
//! | [`mod@second_order`] | is the motion unique where the rank drops? |
//! | [`along`] | verdicts along a motion: one, and where another holds |
//! | `words` | dependencies as sentences |

pub mod along;
mod certificate;
pub mod choices;
pub mod existence;
pub mod explain;
pub mod frames;
pub mod generic;
pub mod groups;
mod large;
pub mod make_unique;
pub mod matrices;
pub mod mechanism;
pub mod memory;
pub mod rows;
pub mod second_order;
pub mod state;
pub mod structure;
pub mod survey;
pub mod units;
pub mod verdict;
mod words;

pub use along::{
    Along, AlongError, Difference, Part, Passage, PassageKind, Stretch, along_motion,
    singular_passages,
};
pub use certificate::{certify, inseparable};
pub use choices::{
    Choice, ChoiceError, Compliance, Distribution, Equations, Label, NormWeights, ReactionValues,
    Value, minimise,
};
pub use existence::{ConstraintLevel, Contradiction, Ranks, contradictions};
pub use explain::{
    Explanation, ExplanationError, FreeDirection, Mixing, ReactionExplanation, SelfStress, explain,
};
pub use frames::{FrameForms, FrameVerdict, judge_frames};
pub use generic::{Elsewhere, GENERIC_ROWS, Generic, generic, is_permanent};
pub use groups::{
    Configuration, Group, GroupVerdict, LinearForm, RequestError, Term, judge_groups,
};
pub use make_unique::{Allowed, Proposal, Proposals, make_unique};
pub use matrices::{QueryError, Solvability};
pub use mechanism::{
    Analysis, AnalysisError, ComponentVerdict, Dependency, ReactionVerdict, RowVerdict, analyse,
    analyse_dropping, analyse_known, decide, decide_dropping, decide_holonomic,
};
pub use memory::memory_of_verdicts;
pub use rows::{RowDecision, Rows, decide_holonomic_rows, decide_rows, decide_rows_dropping, rows};
pub use second_order::{Continuation, KERNEL_MAX, Undetermined, is_locked, second_order};
pub use state::{State, StateError};
pub use structure::{judge_parts, structure};
pub use survey::{LARGE, PartVerdicts, Survey, SurveyedPart, survey, verdicts};
pub use units::{Nature, UnitCheck, UnitError, Units, check_units};
pub use verdict::{Judgement, Verdict};
