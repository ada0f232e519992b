//! Reasons why no code can be generated for a mechanism.

use dynamics::{MotionError, MotionFault};
use model::ForceWithoutDerivatives;
use scene::{Diagnostic, KeyError};

/// Reason why a module could not be generated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CodeError {
    /// The scene contains errors, with positions in its text.
    #[error("{}", lines(.0))]
    Scene(Vec<Diagnostic>),
    /// The motion cannot be sampled.
    #[error("the motion for which the code is generated stops: {0}")]
    Motion(#[from] Box<dynamics::Failure>),
    /// The equations have no solution at a prepared state.
    #[error(transparent)]
    Start(#[from] MotionError),
    /// The equations have no solution at a state of the motion.
    #[error(transparent)]
    MotionFault(#[from] MotionFault),
    /// No order of elimination is suitable for the whole motion.
    #[error(
        "no fixed order of elimination is accurate during the whole motion: with {left} rows left the best pivot falls to {share:.1e} of its row or column \
         (at least 1e-3 is needed); run this scene interpreted, or generate code for a shorter motion"
    )]
    NoPivot {
        /// Smallest ratio of the best pivot to the largest entry of its row or column.
        share: f64,
        /// Rows that are not yet eliminated.
        left: usize,
    },
    /// A drive has a force law. If a force law has no value, a run must stop, which is not possible
    /// in generated code.
    #[error(
        "drive `{drive}` has a law, for which generated code cannot report errors; run this scene interpreted"
    )]
    Law {
        /// Name of the drive.
        drive: String,
    },
    /// A function of time is an expression. If it has no value, a run must stop, which is not
    /// possible in generated code.
    #[error(
        "`{element}` has an expression of the time, which generated code cannot stop by name; write a function of time with a `type`, or run this scene interpreted"
    )]
    Expression {
        /// Name of the joint, drive or force.
        element: String,
    },
    /// A joint has an armature, so the mass matrix depends on the configuration.
    #[error(
        "joint `{joint}` has an armature, which generated code does not support; run this scene interpreted"
    )]
    Armature {
        /// Name of the joint.
        joint: String,
    },
    /// A force uses a callback, which cannot be recorded.
    #[error("{0}, which generated code does not support; run this scene interpreted")]
    Called(ForceWithoutDerivatives),
    /// The coordinates of bodies are neither angles (plane) nor quaternions (space); generated code
    /// supports only these.
    #[error(
        "generated code supports only bodies whose orientation is an angle or a quaternion; run this scene interpreted"
    )]
    Coordinates,
    /// A joint or force needs full revolutions, which are counted from the poses between calls of
    /// kernels.
    #[error(
        "generated code does not support joints and forces that count the turns of angles; run this scene interpreted"
    )]
    Turns,
    /// A force depends on a rotation vector, which is undefined near half a revolution. The
    /// interpreter stops a run at such a rotation, but generated code cannot.
    #[error(
        "forces along a rotation vector have no value near half a turn, and generated code cannot report this error; run this scene interpreted"
    )]
    RotationVector,
    /// A free motion has no mass.
    #[error(
        "the motion of velocity {} has no mass, so its acceleration is not determined; give its body mass or inertia",
        column + 1
    )]
    Massless {
        /// Index of the velocity component (0-based).
        column: usize,
    },
    /// A key of an input does not refer to a number in the scene.
    #[error("an input of code: {0}")]
    Key(#[from] KeyError),
    /// A number of the scene cannot be an input.
    #[error(transparent)]
    Input(#[from] NotAnInput),
    /// The scene is invalid if the inputs have other values.
    #[error("the scene does not allow other values of {}: {reason}", keys.join(", "))]
    Varied {
        /// The keys of the inputs.
        keys: Vec<String>,
        /// Error of the first attempt, with the largest change of the values.
        reason: String,
    },
    /// Inputs can only be found in the text of a scene, but there is no text.
    #[error(
        "inputs are keys of the text of a scene, but a mechanism built in Rust has no text; call `scene_text` with them"
    )]
    NoText,
    /// The code would be too long to compile.
    #[error(
        "the module would have {operations} operations, more than {limit}: compilers take minutes for that; run this scene interpreted"
    )]
    TooLong {
        /// Number of operations of the longest function.
        operations: usize,
        /// Largest permitted number of operations.
        limit: usize,
    },
    /// A file cannot be read or written.
    #[error("{path} cannot be read or written: {source}")]
    File {
        /// Path of the file.
        path: String,
        /// The reason.
        source: std::io::Error,
    },
    /// Only some components of a vector are independent rows, so the equations cannot be rotated to
    /// the frame of a body.
    #[error("the kept rows contain only some components of a vector")]
    NoView,
    /// The given text is not the path of a crate.
    #[error(
        "`{path}` is no path of a crate; `--dynamics` wants one as the module sees it, such as `pfaff::dynamics`"
    )]
    Path {
        /// The given text.
        path: String,
    },
    /// A module cannot be compared with a file that does not exist.
    #[error("{path} cannot be read ({source}): write it first, without `--check`")]
    Unwritten {
        /// Path of the file.
        path: String,
        /// The reason.
        source: std::io::Error,
    },
    /// A row number is zero, but rows are 1-based.
    #[error("rows to drop are counted from 1, found 0")]
    RowZero,
    /// A file with generated code is out of date: the content of the file differs from the module
    /// that is now generated from the same scene.
    #[error("{path} does not agree with its scene: generate it again")]
    Stale {
        /// Path of the file.
        path: String,
    },
    /// The generated text is not valid Rust, which is a bug in this crate.
    #[error("the generated text is no Rust: {0}")]
    Text(String),
}

/// Reason why a number in a scene cannot be an input of code.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotAnInput {
    /// One of the numbers of several keys cannot be an input.
    #[error("`{key}` cannot be an input of code: {why}")]
    OfKey {
        /// The key of the number.
        key: String,
        /// The reason.
        why: Box<NotAnInput>,
    },
    /// The number activates or deactivates an item.
    #[error("it is true or false, not a number; generate code for both scenes")]
    Switch,
    /// Other values of the number lead to other operations.
    #[error(
        "with it the equations have other parts, as where a tensor of inertia gets its first products; describe the scene with them"
    )]
    Structure,
    /// The number changes a break time, but break times are constants of a module.
    #[error(
        "it moves a time at which a function of time is not smooth, and these times are constants of a module; generate code for each of its values"
    )]
    BreakTimes,
    /// With other values of the number, the independent rows become dependent. A module has fixed
    /// independent rows.
    #[error("with it the kept rows depend on each other; choose the rows to drop with `--drop`")]
    Rows,
    /// The number does not occur in the equations.
    #[error(
        "no number of the equations depends on it, so code without this input serves all of its values; leave it out"
    )]
    Nothing,
}

/// One line for each position.
fn lines(places: &[Diagnostic]) -> String {
    let lines: Vec<String> = places.iter().map(Diagnostic::to_string).collect();
    lines.join("\n")
}
