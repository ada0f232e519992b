//! Why a motion stops, or does not begin.

mod rows;

use integrators::IntegrationError;
use linalg::{SaddleError, SingularPivot};
use model::{RowLabel, StartError};
use rank::Doubt;
use solvability::{AnalysisError, Contradiction, StateError};

pub use rows::DropError;

/// Why the equations cannot be solved at one instant. A shorter step may avoid it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionFault {
    /// The kept rows became dependent.
    #[error(
        "at t = {time} s the kept rows are no longer independent at row {row}: pivot {pivot:.3e} of {scale:.3e}; \
         the mechanism passes a singular configuration"
    )]
    RankLost {
        /// When.
        time: f64,
        /// The row whose pivot vanished.
        row: RowLabel,
        /// The pivot.
        pivot: f64,
        /// What it is compared with.
        scale: f64,
    },
    /// The independent coordinates no longer determine the others.
    #[error(
        "at t = {time} s the independent coordinates do not determine the others: row {row} has a pivot of {pivot:.3e} times the \
         one at their choice"
    )]
    IndependentCoordinates {
        /// When.
        time: f64,
        /// The row that cannot be solved.
        row: RowLabel,
        /// Its pivot relative to the one at the choice.
        pivot: f64,
    },
    /// The linear system of an implicit step has no solution.
    #[error("at t = {time} s the iteration matrix of the step is singular: {source}")]
    IterationMatrix {
        /// When.
        time: f64,
        /// Why.
        source: SingularPivot,
    },
    /// A motion that moves no mass.
    #[error(
        "at t = {time} s a motion without mass or inertia is possible: body `{body}` can move its {coordinate} freely; \
         give it mass or inertia, or constrain it"
    )]
    Massless {
        /// When.
        time: f64,
        /// The body that moves most.
        body: String,
        /// Its coordinate.
        coordinate: &'static str,
    },
    /// A value is NaN or infinite.
    #[error("at t = {time} s {what} is not finite")]
    NotFinite {
        /// When.
        time: f64,
        /// Which value.
        what: String,
    },
    /// Positions could not be brought back onto the constraints.
    #[error(
        "at t = {time} s row {row} misses by {residual:.3e} after {iterations} corrections, {}",
        above(*residual, *tolerance)
    )]
    OffConstraints {
        /// When.
        time: f64,
        /// The row that misses most.
        row: RowLabel,
        /// By how much.
        residual: f64,
        /// What is allowed.
        tolerance: f64,
        /// Corrections made.
        iterations: usize,
    },
    /// A dropped row is no longer implied by the kept ones.
    #[error(
        "at t = {time} s the dropped row {row} is violated by {residual:.3e} ({level}), {}: it \
         contradicts the kept rows; it was redundant only at the start, or drives contradict each other",
        above(*residual, *tolerance)
    )]
    DroppedRow {
        /// When.
        time: f64,
        /// The row.
        row: RowLabel,
        /// Positions or velocities.
        level: &'static str,
        /// Its residual.
        residual: f64,
        /// What is allowed.
        tolerance: f64,
    },
    /// Redundant drives ask for different motions from a time after the start on, or one of them
    /// for what joints forbid.
    #[error("at t = {time} s redundant rows part: {contradiction}")]
    Drives {
        /// When the rows were seen to differ.
        time: f64,
        /// What they ask for, where they differ clearly.
        contradiction: Box<Contradiction>,
    },
    /// A row that is dropped because the start is singular holds no more beside it.
    #[error(
        "at t = {time} s the dropped row {row} is violated by {residual:.3e}: it contradicts the kept rows. It is redundant at the start only, which \
         is a singular configuration (its degree of redundancy is {redundancy}, elsewhere {elsewhere}): begin at another one, or correct the joint \
         of the row"
    )]
    SingularStart {
        /// Degree of redundancy at the start.
        redundancy: usize,
        /// The same at other configurations.
        elsewhere: usize,
        /// When the row was seen to be violated.
        time: f64,
        /// The row.
        row: RowLabel,
        /// Its residual.
        residual: f64,
    },
    /// Newton's method for dependent coordinates went to a configuration far away: another branch,
    /// or another turn.
    #[error(
        "at t = {time} s the dependent coordinates could only be found {by:.2} (lengths of the mechanism, or radians) from where the \
         step expects them, at the {coordinate} of `{body}`"
    )]
    FarCompletion {
        /// When.
        time: f64,
        /// The body that moved most.
        body: String,
        /// Its coordinate.
        coordinate: &'static str,
        /// By how much: lengths as share of the mechanism's size, angles in radians.
        by: f64,
    },
    /// A row of output is not where its step leads.
    #[error(
        "the row at t = {time} s lies {by:.2} (lengths of the mechanism, or radians) from where the step around it leads, at the {coordinate} of \
         `{body}`, or has other velocities: near a singular configuration the method's output between steps may lead to another branch; use another method, \
         or a smaller max_step"
    )]
    FarRow {
        /// When.
        time: f64,
        /// The body that lies farthest off.
        body: String,
        /// Its coordinate.
        coordinate: &'static str,
        /// By how much: lengths as share of the mechanism's size, angles in radians.
        by: f64,
    },
    /// A constraint jumps.
    #[error(
        "at t = {time} s row {row} jumps by {jump:.3e}: positions cannot follow at once (an infinite force); use a function \
         of time that is continuous, or a short ramp"
    )]
    PositionJump {
        /// When.
        time: f64,
        /// The row.
        row: RowLabel,
        /// By how much.
        jump: f64,
    },
    /// No step gets over a singular configuration.
    #[error(
        "between t = {from} s and t = {to} s the mechanism is in or passes a singular configuration that it does not leave \
         smoothly: the constraints do not determine how it goes on"
    )]
    SingularPassage {
        /// The last time before it.
        from: f64,
        /// The first time after it.
        to: f64,
    },
    /// The kept rows became dependent and no others can be chosen.
    #[error(
        "at t = {time} s the kept rows are nearly dependent and no others can be chosen: {what}"
    )]
    NoRows {
        /// When.
        time: f64,
        /// Why.
        what: String,
    },
    /// The saddle equations were refused for another reason.
    #[error("at t = {time} s: {source}")]
    Saddle {
        /// When.
        time: f64,
        /// Why.
        source: SaddleError,
    },
}

/// Why there is no motion, or only a part of it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// The options of the run are no options.
    #[error("{name} is {value}, need {expected}")]
    Option {
        /// Which number.
        name: &'static str,
        /// The number.
        value: f64,
        /// What is needed.
        expected: &'static str,
    },
    /// Two options that do not go together.
    #[error("{chosen} does not go with {with}: {why}")]
    Combination {
        /// One.
        chosen: &'static str,
        /// The other.
        with: &'static str,
        /// Why not.
        why: &'static str,
    },
    /// No consistent start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The constraint matrix of the start cannot be judged.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// The start is no state of the mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// Redundant rows ask for different motions.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
    /// The rank of the start is undecided.
    #[error("the rank of the start is undecided, so no rows can be chosen: {}", undecided(.0))]
    RankUndecided(Doubt),
    /// Kept rows that only differ by what no motion can be computed with.
    #[error(
        "at the start the rows {} depend on each other but for {sigma:.1e}, need {required:.1e} to move: velocities would be known to {:.1e} of \
         their size only. Correct the misalignment, or delete one of them",
        rows.join(", "), f64::EPSILON / sigma
    )]
    Inseparable {
        /// The rows.
        rows: Vec<String>,
        /// The smallest singular value of the kept rows, as bodies feel it.
        sigma: f64,
        /// What is needed.
        required: f64,
    },
    /// The rows asked to be dropped cannot be.
    #[error(transparent)]
    Rows(#[from] DropError),
    /// The equations could not be solved at the start.
    #[error(transparent)]
    Fault(#[from] MotionFault),
    /// A reaction is wanted of a joint or drive that does not exist.
    #[error("the reaction of `{name}` is wanted, but no joint or drive has this name")]
    NoReaction {
        /// The name.
        name: String,
    },
    /// One of several components that do not feel each other stopped; the others were stopped
    /// there.
    #[error("{component}: {source}")]
    Component {
        /// Its bodies.
        component: String,
        /// Why it stopped.
        source: Box<MotionError>,
    },
    /// The operating system refused a thread for a component.
    #[error("no thread for {component}: {source}")]
    Thread {
        /// Its bodies.
        component: String,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// The integration stopped.
    #[error("{0}")]
    Integration(Box<IntegrationError<MotionFault>>),
}

/// A doubt in the words of one who writes scenes: what can be changed there.
fn undecided(doubt: &Doubt) -> String {
    match *doubt {
        Doubt::NoClearGap {
            lower,
            upper,
            sigma,
            tolerance,
            required,
        } => {
            let advice = if required > rank::NEARLY_SINGULAR {
                "Places are known too badly for this: lengths differ too much, or lie too far from the origin"
            } else {
                "Some rows depend on each other nearly but not quite: correct the misalignment of their joints, or delete one of them"
            };
            format!(
                "singular value {sigma:.3e} lies between the tolerance {tolerance:.3e} and {required:.3e}: rank {lower} or {upper}. {advice}"
            )
        }
        Doubt::NotPolished {
            sigma_max,
            tolerance,
        } => format!(
            "tolerance {tolerance:.3e} exceeds the largest singular value {sigma_max:.3e}: places are known too badly for any rank; place the mechanism \
             nearer to the origin"
        ),
        other => other.to_string(),
    }
}

/// What a residual was compared with. A run goes on up to the last state that is allowed, so both
/// may look the same.
fn above(residual: f64, tolerance: f64) -> String {
    let [found, allowed] = [residual, tolerance].map(|x| format!("{x:.3e}"));
    if found == allowed {
        format!("just above the allowed {allowed}")
    } else {
        format!("more than {allowed}")
    }
}

#[cfg(test)]
mod tests {
    use super::above;

    #[test]
    fn two_numbers_that_look_the_same_are_not_called_different() {
        assert_eq!(above(1.25e-9, 3e-13), "more than 3.000e-13");
        assert_eq!(
            above(1.381_24e-13, 1.381_19e-13),
            "just above the allowed 1.381e-13"
        );
        assert_eq!(above(f64::NAN, 1e-9), "more than 1.000e-9");
    }
}
