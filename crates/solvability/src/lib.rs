#![doc = include_str!("../README.md")]
//!
//! # Code map
//!
//! | module | content |
//! | --- | --- |
//! | [`verdict`] | the verdicts unique, not unique and undecided, with their evidence |
//! | [`matrices`] | solvability of a plain constraint matrix |
//! | [`mod@rows`] | independent rows for simulations, also of large mechanisms |
//! | [`state`] | checks of coordinates and velocities that the caller passes |
//! | [`existence`] | existence of a solution: contradictions between redundant rows |
//! | [`finite`] | whether finite reactions exist if second-order terms block a velocity |
//! | [`mod@generic`] | whether a redundancy is permanent or exists at one configuration only |
//! | [`freedoms`] | free motions with and without the drives |
//! | [`groups`] | combinations of reactions, resultants |
//! | [`frames`] | components in global, body and edge frames |
//! | [`moments`] | moments about points other than the reference point |
//! | [`choices`] | one solution among many, labelled |
//! | [`mod@analysis`] | ranks and verdicts of a mechanism of any size |
//! | [`mod@parts`] | the parts of a mechanism on common cycles, each analysed separately |
//! | `mechanism` | one part: joints, wrenches, directions |
//! | `directions` | readable bases of free directions |
//! | `pose` | C at one configuration, without dimensions |
//! | `judged` | verdicts on the reactions of one part |
//! | `certificate` | rank in double-double arithmetic at a refined configuration |
//! | [`questions`] | sums, frames, choices and deletions, computed from the parts involved |
//! | [`contacts`] | loads that one-sided joints and contacts that grip permit |
//! | `polyhedra` | linear programs, polyhedra and complementarity for contacts |
//! | [`mod@structure`] | reactions that are unique because of the structure alone |
//! | `sparse`, `large` | analysis of a large set of joints with sparse matrices |
//! | [`mod@explain`] | explanations: coupled reactions, free directions and sentences |
//! | [`mod@make_unique`] | what to delete so that a reaction becomes unique |
//! | `weaker` | weaker joints with which all reactions are unique and the motion is the same |
//! | [`sensitivity`] | how much unique reaction components depend on the data |
//! | [`mod@second_order`] | whether the motion is unique where the rank drops |
//! | [`mod@stretches`] | verdicts of a simulation, by time interval and component |
//! | [`along`] | verdicts along a motion by time interval, and its singular configurations |
//! | `words` | text formatting of lists, numbers and vectors |
//! | `loads` | sentences about spatial forces and moments that joints share |

pub mod along;
pub mod analysis;
pub mod bounds;
mod certificate;
pub mod choices;
mod components;
pub mod contacts;
mod directions;
mod error;
pub mod existence;
pub mod explain;
pub mod finite;
pub mod frames;
pub mod freedoms;
pub mod generic;
pub mod groups;
mod judged;
mod large;
mod limits;
mod loads;
pub mod make_unique;
pub mod matrices;
mod mechanism;
pub mod memory;
pub mod moments;
mod numerical_rank;
pub mod parts;
mod polyhedra;
mod pose;
pub mod questions;
mod row_decision;
pub mod rows;
pub mod second_order;
pub mod sensitivity;
#[cfg(test)]
mod sketch;
mod sparse;
pub mod state;
pub mod stretches;
pub mod structure;
pub mod value;
pub mod verdict;
mod weaker;
mod words;

pub use along::{
    AlongError, Difference, GenericRank, MotionAnalysis, Passage, PassageKind, Stretch,
    along_motion, along_motion_of_parts, singular_passages,
};
pub use analysis::{
    Analysis, analyse, analyse_by_cycles, analyse_decided, analyse_dropping, analyse_known,
    analyse_with_progress,
};
pub use bounds::{
    BoundsError, ComplianceRange, ElasticBounds, ElasticLoad, ElasticSolutions, Elasticity,
    NominalCompliance, ReactionBounds,
};
pub use certificate::{certify, inseparable};
pub use choices::{
    CarriedChoices, CarriedSolution, Centres, Choice, ChoiceError, ChosenValues, Compliance,
    Distribution, ElasticSupports, Equations, Misfit, NamedChoice, NormWeights, ReactionValues,
    RowTerms, Solution, minimise, solution,
};
pub use contacts::{
    CarriedContacts, Closure, ConditionKind, ContactCondition, GripVerdict, Holds, Impossible,
    Liftoff, PermittedEnd, PermittedError, PermittedRange, PermittedReactions, RangeKind,
    TwoSidedContacts, lifted, opened,
};
pub use error::AnalysisError;
pub use existence::{
    Contradiction, Demand, DriveLimit, LimitedDrive, Ranks, contradicting_drives,
    contradicting_drives_along, contradictions, drive_limit, may_miss,
};
pub use explain::{
    Explanation, ExplanationError, FreeDirection, Mixing, ReactionExplanation, SelfStress, explain,
};
pub use finite::no_finite_reactions;
pub use frames::{FrameForms, FrameVerdict, judge_frames};
pub use freedoms::{
    FreeMotion, FreeMotions, Freedoms, FreedomsWithoutDrives, LeftOut, WithoutDrives, motions_among,
};
pub use generic::{
    Generic, GenericVerdict, OtherConfiguration, generic, generic_with_verdicts, is_permanent,
};
pub use groups::{
    Configuration, Group, GroupNumbers, GroupVerdict, LinearForm, ReactionForms, RequestError,
    Term, judge_groups,
};
pub use judged::{ComponentVerdict, Dependency, ReactionVerdict, RowVerdict};
pub use limits::{CARRIED_VECTORS, FRAGILE, KERNEL_MAX, MOTIONS_REPORTED, MOVED, ONE_PART};
pub use make_unique::{DeletableRows, Proposal, Proposals, make_unique};
pub use matrices::{QueryError, Solvability};
pub use memory::{VerdictMemory, memory_of_verdicts};
pub use model::ConstraintLevel;
pub use moments::MomentVerdict;
pub use parts::{Extent, PartAnalysis, PartDecision};
pub use pose::{decide, decide_dropping, decide_holonomic};
pub use questions::{EliminationError, Numbers, Questions};
pub use row_decision::RowDecision;
pub use rows::{
    Rows, decide_holonomic_rows, decide_of_rank, decide_rows, decide_rows_dropping, rows,
    rows_of_rank,
};
pub use second_order::{
    CommonZero, Continuation, RestrictedVelocities, Restrictions, SecondOrder, SecondOrderDoubt,
    blocked_velocities, common_zero, is_locked, restrictions, second_order,
};
pub use sensitivity::{GroupSensitivities, ReactionNumber, ReactionSensitivities, Sensitivities};
pub use state::{State, StateError, check_state};
pub use stretches::{
    CarriedState, CarriedVerdicts, GroupStretches, InstantOrder, ReactionStretches, SpecialInstant,
    Stretches, VerdictRecorder, VerdictStretch, VerdictTrack,
};
pub use structure::structure;
pub use value::{Datum, Label, NoFiniteReaction, Sensitivity, Value};
pub use verdict::{Judgement, Verdict};
pub use weaker::{CoupledJoints, Replacements, WeakerJoint};
