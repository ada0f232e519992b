//! Errors that stop a motion or prevent its start.

mod rows;

use integrators::IntegrationError;
use linalg::{SaddleError, SingularPivot};
use model::codes::Code;
use model::words::{clause, listed, rough, rounded, short};
use model::{ForceWithoutDerivatives, RowLabel, StartError, UndefinedForce};
use rank::Doubt;
use solvability::{AnalysisError, Contradiction, DriveLimit, NoFiniteReaction, StateError};

pub use rows::DropError;

/// Reason why the equations cannot be solved at one instant. A shorter step may avoid the problem.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionFault {
    /// The independent rows became dependent.
    #[error(
        "at t = {t} s the kept rows are no longer independent at row {row}: pivot {pivot} of {scale}; \
         the mechanism passes a singular configuration", t = rounded(*time), pivot = short(*pivot), scale = short(*scale))]
    RankLost {
        /// Time (s).
        time: f64,
        /// The row whose pivot vanished.
        row: RowLabel,
        /// The pivot.
        pivot: f64,
        /// The reference value with which the pivot is compared.
        scale: f64,
    },
    /// The independent coordinates no longer determine the dependent coordinates.
    #[error(
        "at t = {t} s the independent coordinates do not determine the others: row {row} has a pivot of {pivot} times the \
         one at their choice", t = rounded(*time), pivot = short(*pivot))]
    IndependentCoordinates {
        /// Time (s).
        time: f64,
        /// The row that cannot be satisfied.
        row: RowLabel,
        /// Pivot relative to the pivot at the choice of the coordinates.
        pivot: f64,
    },
    /// The linear system of an implicit step has no solution.
    #[error("at t = {t} s the iteration matrix of the step is singular: {source}", t = rounded(*time))]
    IterationMatrix {
        /// Time (s).
        time: f64,
        /// Cause.
        source: SingularPivot,
    },
    /// The mechanism has a motion that moves no mass.
    #[error(
        "at t = {t} s a motion without mass or inertia is possible: body `{body}` can move its {coordinate} freely; \
         give it mass or inertia, or constrain it", t = rounded(*time))]
    Massless {
        /// Time (s).
        time: f64,
        /// The body with the largest motion.
        body: String,
        /// Coordinate of the body.
        coordinate: &'static str,
    },
    /// A value is NaN or infinite.
    #[error("at t = {t} s {what} is not finite", t = rounded(*time))]
    NotFinite {
        /// Time (s).
        time: f64,
        /// Name of the value.
        what: String,
    },
    /// An external function did not return a finite value. The run ends, because another step
    /// cannot correct this error.
    #[error(
        "at t = {t} s {source} has no value; a function must return finite numbers at every state, since the stages of a step may leave the motion", t = rounded(*time))]
    Function {
        /// Time (s).
        time: f64,
        /// The drive or force, with the state and the cause.
        source: UndefinedForce,
    },
    /// A force calls an external function, which returns values but no derivatives.
    #[error("{needs} derivatives of all forces, and {source}; {instead}")]
    NoDerivatives {
        /// Text with the calculation that needs derivatives, and the verb of the calculation.
        needs: &'static str,
        /// The force that calls a function.
        source: ForceWithoutDerivatives,
        /// Alternatives for the user.
        instead: &'static str,
    },
    /// Positions could not be moved back onto the constraints.
    #[error(
        "at t = {t} s row {row} is violated by {residual} after {iterations} corrections, {}",
        above(*residual, *tolerance), t = rounded(*time), residual = short(*residual))]
    OffConstraints {
        /// Time (s).
        time: f64,
        /// The row with the largest residual.
        row: RowLabel,
        /// Residual of the row.
        residual: f64,
        /// The largest residual allowed.
        tolerance: f64,
        /// Number of corrections made.
        iterations: usize,
    },
    /// The independent rows no longer imply a redundant row.
    #[error(
        "at t = {t} s the dropped row {row} is violated by {residual} ({level}), {}: the kept rows implied it at the start, but no longer imply it here; {}",
        above(*residual, *tolerance), implied(drives), t = rounded(*time), residual = short(*residual))]
    DroppedRow {
        /// Time (s).
        time: f64,
        /// The row.
        row: RowLabel,
        /// "position" or "velocity".
        level: &'static str,
        /// Residual of the row.
        residual: f64,
        /// The largest residual allowed.
        tolerance: f64,
        /// Drives and joints with functions of time that belong to this row or to the rows that
        /// implied it.
        drives: Box<[String]>,
    },
    /// The violation of a row that is redundant within the stated tolerance is larger than data
    /// within this tolerance can cause.
    #[error(
        "at t = {time} s row {row} is violated by {residual} ({level}), but the stated tolerance explains only {bound}: within the tolerance the mechanism cannot move farther than this position ({way} since the start). Correct the dimensions of its joint, state a larger tolerance for the joint, or end the run earlier", residual = short(*residual), bound = short(*bound))]
    BeyondTolerance {
        /// Time (s).
        time: f64,
        /// The row.
        row: RowLabel,
        /// "position" or "velocity".
        level: &'static str,
        /// Residual of the row.
        residual: f64,
        /// Largest violation that data within the tolerance can cause.
        bound: f64,
        /// Distance that the mechanism has moved since its start.
        way: String,
    },
    /// From some time after the start, redundant drives prescribe different motions, or a drive
    /// prescribes a motion that the joints prevent.
    #[error("at t = {t} s redundant rows contradict each other: {contradiction}", t = rounded(*time))]
    Drives {
        /// Time at which the program detected the difference of the rows (s).
        time: f64,
        /// The contradiction at a time at which the rows differ clearly.
        contradiction: Box<Contradiction>,
    },
    /// A row that counted as redundant because the start is singular is violated at neighbouring
    /// configurations.
    #[error(
        "at t = {t} s the dropped row {row} is violated by {residual}: it contradicts the kept rows. It is redundant at the start only, which \
         is a singular configuration (its degree of redundancy is {redundancy}, elsewhere {elsewhere}): begin at another one, or correct the joint \
         of the row", t = rounded(*time), residual = short(*residual))]
    SingularStart {
        /// Degree of redundancy at the start.
        redundancy: usize,
        /// Degree of redundancy at other configurations.
        elsewhere: usize,
        /// Time at which the program detected the violation of the row (s).
        time: f64,
        /// The row.
        row: RowLabel,
        /// Residual of the row.
        residual: f64,
    },
    /// The one-sided joints can no longer all stay closed.
    #[error(
        "at t = {t} s {who}: no sharing of the loads presses on all one-sided joints any more; end the run before, or \
         leave out `one_sided` to compute the motion of contacts that pull",
        t = rounded(*time), who = clause(joints, ["opens", "open"]))]
    Opens {
        /// Time (s).
        time: f64,
        /// The joints that open.
        joints: Vec<String>,
    },
    /// Contacts that grip cannot all hold any more.
    #[error(
        "at t = {t} s {who} for every sharing of the loads; end the run before, increase `grip`, or leave it out to \
         compute the motion of contacts that never slip",
        t = rounded(*time), who = clause(joints, ["slips", "slip"]))]
    Slips {
        /// Time (s).
        time: f64,
        /// The contacts that slip.
        joints: Vec<String>,
    },
    /// Newton's method for dependent coordinates converged to a configuration far away. This
    /// configuration belongs to another branch or to another revolution.
    #[error(
        "at t = {t} s the dependent coordinates could only be found {by:.2} (lengths of the mechanism, or radians) from where the \
         step expects them, at the {coordinate} of `{body}`", t = rounded(*time))]
    FarCompletion {
        /// Time (s).
        time: f64,
        /// The body with the largest motion.
        body: String,
        /// Coordinate of the body.
        coordinate: &'static str,
        /// Distance. Lengths are given as a fraction of the size of the mechanism, and angles in
        /// radians.
        by: f64,
    },
    /// An output row is far from the path of the step that contains the row.
    #[error(
        "the row at t = {t} s lies {by:.2} (lengths of the mechanism, or radians) from where the step around it leads, at the {coordinate} of \
         `{body}`, or has other velocities: near a singular configuration the method's output between steps may lead to another branch; use another method, \
         or a smaller max_step", t = rounded(*time))]
    FarRow {
        /// Time (s).
        time: f64,
        /// The body with the largest distance.
        body: String,
        /// Coordinate of the body.
        coordinate: &'static str,
        /// Distance. Lengths are given as a fraction of the size of the mechanism, and angles in
        /// radians.
        by: f64,
    },
    /// A constraint function jumps.
    #[error(
        "at t = {t} s row {row} jumps by {jump}: this needs an infinite force; use a continuous function of time, or a short ramp", t = rounded(*time), jump = short(*jump))]
    PositionJump {
        /// Time (s).
        time: f64,
        /// The row.
        row: RowLabel,
        /// Size of the jump.
        jump: f64,
    },
    /// No step reaches the other side of a singular configuration.
    #[error(
        "{} the mechanism is at or passes a singular configuration without a smooth continuation: the constraints do not determine the further motion", instant(*from, *to))]
    SingularPassage {
        /// The last time reached before the singular configuration (s).
        from: f64,
        /// The first time tried after the singular configuration (s).
        to: f64,
    },
    /// Drives prescribe values that no configuration can reach.
    #[error(
        "at t = {t} s {limit}. End the run earlier, or prescribe a motion that reverses before", t = rounded(limit.time))]
    NoConfiguration {
        /// The drives, and the limits of their motion.
        limit: Box<DriveLimit>,
    },
    /// The independent rows became dependent, and no other independent rows can be chosen.
    #[error(
        "at t = {t} s the kept rows are nearly dependent and no others can be chosen: {what}", t = rounded(*time))]
    NoRows {
        /// Time (s).
        time: f64,
        /// Cause.
        what: String,
    },
    /// The caller ended the run. The steps before are valid.
    #[error("interrupted at t = {t} s", t = rounded(*time))]
    Interrupted {
        /// Time of the evaluation that was not carried out (s).
        time: f64,
    },
    /// The saddle-point equations were rejected for another reason.
    #[error("at t = {t} s: {source}", t = rounded(*time))]
    Saddle {
        /// Time (s).
        time: f64,
        /// Cause.
        source: SaddleError,
    },
}

impl MotionFault {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::RankLost { .. } => const { Code::new(410) },
            Self::IndependentCoordinates { .. } => const { Code::new(411) },
            Self::IterationMatrix { .. } => const { Code::new(412) },
            Self::Massless { .. } => const { Code::new(413) },
            Self::NotFinite { .. } => const { Code::new(414) },
            Self::Function { .. } => const { Code::new(426) },
            Self::NoDerivatives { .. } => const { Code::new(427) },
            Self::OffConstraints { .. } => const { Code::new(415) },
            Self::DroppedRow { .. } => const { Code::new(416) },
            Self::BeyondTolerance { .. } => const { Code::new(425) },
            Self::Drives { .. } => const { Code::new(417) },
            Self::SingularStart { .. } => const { Code::new(418) },
            Self::FarCompletion { .. } => const { Code::new(419) },
            Self::FarRow { .. } => const { Code::new(420) },
            Self::PositionJump { .. } => const { Code::new(421) },
            Self::SingularPassage { .. } => const { Code::new(422) },
            Self::NoRows { .. } => const { Code::new(423) },
            Self::NoConfiguration { .. } => const { Code::new(428) },
            Self::Opens { .. } | Self::Slips { .. } => const { Code::new(429) },
            Self::Saddle { .. } => const { Code::new(424) },
            Self::Interrupted { .. } => const { Code::new(8) },
        }
    }
}

/// Reason why there is no motion, or only part of a motion.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// An option of the run is invalid.
    #[error("{name} is {value}, need {expected}")]
    Option {
        /// Name of the run option.
        name: &'static str,
        /// Value of the option.
        value: f64,
        /// The allowed values.
        expected: &'static str,
    },
    /// Two options cannot be combined.
    #[error("{chosen} cannot be combined with {with}: {why}")]
    Combination {
        /// The first option.
        chosen: &'static str,
        /// The second option.
        with: &'static str,
        /// Reason.
        why: &'static str,
    },
    /// No consistent start exists.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The constraint matrix at the start cannot be analysed.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// The start is an invalid state of the mechanism.
    #[error(transparent)]
    State(#[from] StateError),
    /// Redundant rows require different motions.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
    /// The rank at the start cannot be decided.
    #[error("the rank of the start is undecided, so no rows can be chosen: {}", undecided(.0))]
    RankUndecided(Doubt),
    /// The independent rows are too ill-conditioned to compute a motion.
    #[error(
        "at the start the rows {} are dependent to within {sigma}; a simulation needs {required}: velocities would be accurate only to {} of their size. Correct the misalignment, or delete one of the rows",
        listed(rows), rough(f64::EPSILON / sigma), sigma = rough(*sigma), required = rough(*required))]
    Inseparable {
        /// The rows.
        rows: Vec<String>,
        /// The smallest singular value of the independent rows, in units of the bodies.
        sigma: f64,
        /// The smallest value allowed.
        required: f64,
    },
    /// The constraints exclude, at second order, the acceleration that the loads cause at the
    /// start.
    #[error(
        "at the start {0}. Remove these loads, support the freedom, or describe the small offset by which the mechanism supports them"
    )]
    NoFiniteReaction(Box<NoFiniteReaction>),
    /// The rows that the user wants to treat as redundant cannot be redundant.
    #[error(transparent)]
    Rows(#[from] DropError),
    /// The equations have no solution at the start.
    #[error(transparent)]
    Fault(#[from] MotionFault),
    /// The user requests a reaction of a joint or drive that does not exist.
    #[error("the reaction of `{name}` is requested, but no joint or drive has this name")]
    NoReaction {
        /// The name.
        name: String,
    },
    /// One of several independent components stopped. The run then stopped the other components at
    /// the same time.
    #[error("{component}: {source}")]
    Component {
        /// Bodies of the component.
        component: String,
        /// Cause.
        source: Box<MotionError>,
    },
    /// The integration stopped.
    #[error("{0}")]
    Integration(Box<IntegrationError<MotionFault>>),
}

impl MotionError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Option { .. } => const { Code::new(401) },
            Self::Combination { .. } => const { Code::new(402) },
            Self::Start(e) => e.code(),
            Self::Analysis(e) => e.code(),
            Self::State(e) => e.code(),
            Self::Contradiction(_) => const { Code::new(210) },
            Self::RankUndecided(_) => const { Code::new(212) },
            Self::Inseparable { .. } => const { Code::new(213) },
            Self::NoFiniteReaction(_) => const { Code::new(215) },
            Self::Rows(e) => e.code(),
            Self::Fault(e) => e.code(),
            Self::NoReaction { .. } => const { Code::new(404) },
            Self::Component { source, .. } => source.code(),
            Self::Integration(_) => const { Code::new(430) },
        }
    }
}

/// Explains an undecided rank to the author of a scene, and lists changes to the scene that may
/// help.
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
                "Positions are too inaccurate: lengths differ too much, or points are too far from the origin"
            } else {
                "Some rows depend on each other nearly but not quite: correct the misalignment of their joints, or delete one of them"
            };
            format!(
                "singular value {sigma} lies between the tolerance {tolerance} and {required}: rank {lower} or {upper}. {advice}",
                sigma = short(sigma),
                tolerance = short(tolerance),
                required = short(required)
            )
        }
        Doubt::NotPolished {
            sigma_max,
            tolerance,
        } => format!(
            "tolerance {tolerance} exceeds the largest singular value {sigma_max}: positions are too inaccurate for a rank decision; place the mechanism nearer to the origin",
            tolerance = short(tolerance),
            sigma_max = short(sigma_max)
        ),
        other => other.to_string(),
    }
}

/// Explains why a row is no longer implied, from the rows that implied it.
fn implied(drives: &[String]) -> String {
    let names: Vec<String> = drives.iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => "compare the dimensions of its joint with those that `pfaff analyze` lists with it under \"Why\"".to_owned(),
        [only] => format!("{only} prescribes a motion that the joints allowed at the start and prevent here"),
        all => format!("the drives {}, which implied each other at the start, contradict each other here", listed(all)),
    }
}

/// Describes the limit that a residual exceeds. A run stops as soon as a residual exceeds its
/// limit. Therefore the residual and the limit may be equal after rounding for the message.
fn above(residual: f64, tolerance: f64) -> String {
    let [found, allowed] = [residual, tolerance].map(short);
    if found == allowed {
        format!("just above the allowed {allowed}")
    } else {
        format!("more than {allowed}")
    }
}

/// Describes the interval between two times. If both times are equal after rounding, only one time
/// is printed.
fn instant(from: f64, to: f64) -> String {
    let [from, to] = [from, to].map(rounded);
    if from == to {
        format!("at t = {from} s")
    } else {
        format!("between t = {from} s and t = {to} s")
    }
}

#[cfg(test)]
mod tests {
    use super::above;

    #[test]
    fn two_numbers_that_look_the_same_are_not_called_different() {
        assert_eq!(above(1.25e-9, 3e-13), "more than 3e-13");
        assert_eq!(
            above(1.381_24e-13, 1.381_19e-13),
            "just above the allowed 1.381e-13"
        );
        assert_eq!(above(f64::NAN, 1e-9), "more than 1e-9");
    }
}
