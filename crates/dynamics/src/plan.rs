//! The plan of a run: the computations of the run, and the computations that the run omits. A plan
//! is made once from a prepared mechanism, its options and the requested output. Each decision has
//! a reason and states which computations it saves. A run follows its plan ([`crate::simulate`]).
//! Other modules contain the computations.

mod component;
mod decided;
mod decisions;
mod saving;
mod sizes;
mod split;
#[cfg(test)]
mod tests;

use model::{ConstraintId, System};

use crate::choose;
use crate::code::NoCode;
use crate::error::MotionError;
use crate::options::MotionOptions;
use crate::prepare::PreparedMechanism;
use solvability::{Group, NamedChoice};

pub use component::ComponentPlan;
pub use decided::{Decision, Line};
pub use decisions::Decisions;
pub use saving::{Cost, Saving};
pub use sizes::Sizes;

/// The requested output of a motion. Values that are not requested are not computed.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputRequest {
    /// The requested output rows.
    pub rows: Rows,
    /// Whether accelerations are requested at the output rows.
    pub accelerations: bool,
    /// Joints and drives whose reactions are requested at the output rows. If reactions are
    /// requested, the run also computes verdicts.
    pub reactions: Reactions,
    /// Additional groups whose verdicts are requested.
    pub groups: Vec<Group>,
    /// The verdicts that are requested with the reactions.
    pub verdicts: Verdicts,
    /// Additional assumptions (choices) that select one solution for reactions that are not unique.
    /// All reactions are requested for each choice. Each choice selects a solution at the start.
    pub choices: Vec<NamedChoice>,
    /// Whether events at singular configurations state whether the motion is unique there.
    pub uniqueness: bool,
}

/// Verdicts that are computed with reactions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdicts {
    /// Verdicts for time intervals, and for instants whose verdicts differ from the verdict on
    /// their interval. The verdicts are computed at accepted steps and output rows.
    WithInstants,
    /// Verdicts on the whole run. The verdicts are computed at the start, and in each time interval
    /// at the end of its first accepted step and at the start of its last step. If a verdict is
    /// still undecided, they are also computed at the second, fourth, eighth … step. Further
    /// instants could only add special instants, because between events a component is determined
    /// either throughout or only at isolated instants. A reaction is not computed further if
    /// neither its force nor its torque is determined in an interval.
    OfRun,
    /// No verdicts.
    None,
}

impl Default for OutputRequest {
    /// All output is requested by default.
    fn default() -> Self {
        Self {
            rows: Rows::Every,
            accelerations: true,
            reactions: Reactions::All,
            groups: Vec::new(),
            verdicts: Verdicts::WithInstants,
            choices: Vec::new(),
            uniqueness: true,
        }
    }
}

/// Kinds of output rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// Rows at the start, at every output step, and at the end.
    #[default]
    Every,
    /// Rows at the same times, but with the states that are interpolated within steps. These states
    /// violate the constraints by about the tolerance of the run. This kind of rows is for callers
    /// that project the states anyway.
    Interpolated,
    /// Rows at the start and at the end.
    Ends,
}

/// The reactions that are requested.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Reactions {
    /// The reactions of all joints and drives.
    #[default]
    All,
    /// The reactions of these joints and drives.
    Of(Vec<String>),
    /// No reactions.
    None,
}

/// The plan of a run, as a list of its decisions.
///
/// ```
/// use pfaff_dynamics::{MotionOptions, Plan, RowChoice, OutputRequest, prepare};
/// use joints::Revolute;
/// use model::{Body, BodyRef, Description, Joint, Mechanism, StartOptions};
/// // Two pendulums on one ground are independent of each other.
/// let body = |name: &str| Body { name: name.into(), mass: 1.0, inertia: 1.0, ..Body::default() };
/// let pin = |name: &str, k| {
///     Joint::new(name, &[BodyRef::Ground, BodyRef::Body(k)], Revolute { s_i: [0.0; 2], s_j: [0.0, 1.0] })
/// };
/// let pendulums = Description {
///     gravity: [0.0, -9.81],
///     bodies: vec![body("left"), body("right")],
///     joints: vec![pin("a", 0), pin("b", 1)],
///     ..Description::default()
/// };
/// let start = StartOptions { correction: model::start::CorrectionLimit::Any, ..StartOptions::default() };
/// let prepared = prepare(Mechanism::build(&pendulums).unwrap(), &start, &RowChoice::Automatic)?;
/// let plan = Plan::new(&prepared, &MotionOptions::to(1.0), &OutputRequest::default())?;
/// assert_eq!(plan.components.len(), 2);
/// assert_eq!(plan.components[1].name, "right");
/// assert_eq!(plan.components[1].decisions.method.taken, "dop853");
/// # Ok::<(), pfaff_dynamics::MotionError>(())
/// ```
#[non_exhaustive]
pub struct Plan<'a> {
    prepared: &'a PreparedMechanism,
    options: MotionOptions,
    /// Whether the mechanism is split into components.
    pub apart: Decision<bool>,
    /// Whether the run uses code generated for the mechanism.
    pub code: Decision<bool>,
    /// The output rows that are computed.
    pub rows: Decision<Rows>,
    /// Whether accelerations are computed at the output rows.
    pub accelerations: Decision<bool>,
    /// Groups whose verdicts are computed; empty without reactions.
    pub groups: Vec<Group>,
    /// Verdicts that are computed with reactions.
    pub verdicts: Verdicts,
    /// Additional assumptions (choices) for which reactions are computed at output rows.
    pub choices: Vec<NamedChoice>,
    /// Whether events at singular configurations state whether the motion is unique there.
    pub uniqueness: bool,
    /// Components of the mechanism, or the whole mechanism as the only component.
    pub components: Vec<ComponentPlan<'a>>,
}

impl<'a> Plan<'a> {
    /// Makes all decisions that are possible before the motion starts.
    ///
    /// # Errors
    /// - [`MotionError::Option`], [`MotionError::Combination`]: the options are invalid.
    /// - [`MotionError::NoReaction`]: a reaction of a nonexistent joint is requested.
    /// - [`MotionError::Fault`]: the equations of motion have no solution at the start.
    pub fn new(
        prepared: &'a PreparedMechanism,
        options: &MotionOptions,
        wanted: &OutputRequest,
    ) -> Result<Self, MotionError> {
        options.check()?;
        if options.t_end < prepared.start_time() {
            return Err(MotionError::Option {
                name: "t_end",
                value: options.t_end,
                expected: "a time not before the start",
            });
        }
        let groups = wanted_groups(prepared, wanted)?;
        let code = code(prepared, options)?;
        let (apart, parts) = if code.value {
            split::stays("the generated code contains all bodies".to_owned())
        } else {
            split::split(prepared)?
        };
        let components = if parts.is_empty() {
            vec![ComponentPlan::whole(prepared, options, &groups)?]
        } else {
            parts
                .into_iter()
                .map(|part| ComponentPlan::part(part, options, &groups))
                .collect::<Result<_, _>>()?
        };
        Ok(Self {
            prepared,
            options: options.clone(),
            apart,
            code,
            rows: rows(options, prepared.start_time(), wanted.rows),
            accelerations: accelerations(wanted.accelerations),
            verdicts: wanted.verdicts,
            groups: match wanted.reactions {
                Reactions::None => Vec::new(),
                _ => wanted.groups.clone(),
            },
            choices: wanted.choices.clone(),
            uniqueness: wanted.uniqueness,
            components,
        })
    }

    /// Returns the prepared mechanism.
    #[must_use]
    pub fn prepared(&self) -> &'a PreparedMechanism {
        self.prepared
    }

    /// Returns the options of the run. Each component has its own method.
    #[must_use]
    pub fn options(&self) -> &MotionOptions {
        &self.options
    }

    /// Returns all decisions. The decisions for the whole mechanism come first.
    #[must_use]
    pub fn lines(&self) -> Vec<Line<'_>> {
        let of_whole = [
            self.apart.line("components"),
            self.code.line("generated code"),
            self.rows.line("rows of output"),
            self.accelerations.line("accelerations"),
        ];
        let several = self.components.len() > 1;
        let of_components = self.components.iter().flat_map(|component| {
            let name = several.then_some(component.name.as_str());
            let lines = component.decisions.lines().into_iter();
            lines.map(move |line| Line {
                component: name,
                ..line
            })
        });
        of_whole.into_iter().chain(of_components).collect()
    }
}

/// Returns, for each joint and drive, whether its reaction is requested by itself or as a part of a
/// group.
fn wanted_groups(
    prepared: &PreparedMechanism,
    wanted: &OutputRequest,
) -> Result<Vec<bool>, MotionError> {
    let groups = &prepared.mechanism.layout().groups;
    let names = match &wanted.reactions {
        Reactions::All => return Ok(vec![true; groups.len()]),
        Reactions::None => return Ok(vec![false; groups.len()]),
        Reactions::Of(names) => names,
    };
    match names.iter().find(|n| groups.iter().all(|g| g.name != **n)) {
        Some(name) => Err(MotionError::NoReaction { name: name.clone() }),
        None => {
            let is_named = |k: usize| names.contains(&groups[k].name);
            let is_member = |k: usize| wanted.groups.iter().any(|g| g.has(ConstraintId(k)));
            let ids = 0..groups.len();
            Ok(ids.map(|k| is_named(k) || is_member(k)).collect())
        }
    }
}

/// Decides whether a run of the whole mechanism uses generated code.
fn code(
    prepared: &PreparedMechanism,
    options: &MotionOptions,
) -> Result<Decision<bool>, MotionError> {
    let interpreted = |why: NoCode| Ok(Decision::new(false, "interpreted", why.to_string()));
    // Without generated code, no method needs to be chosen for the whole mechanism.
    if let Err(why @ NoCode::None) = prepared.code_for(options) {
        return interpreted(why);
    }
    let options = MotionOptions {
        method: choose::method(prepared, options)?.value,
        ..options.clone()
    };
    let code = match prepared.code_for(&options) {
        Err(why) => return interpreted(why),
        Ok(code) => code.spec(),
    };
    let reason = format!(
        "it was generated for this mechanism ({}); the kernels and the elimination below are the fallback",
        code.operations
    );
    Ok(Decision::new(true, format!("`{}`", code.name), reason))
}

fn rows(options: &MotionOptions, start: f64, rows: Rows) -> Decision<Rows> {
    let every = ((options.t_end - start) / options.output_step)
        .ceil()
        .max(0.0) as u64
        + 1;
    let wanted = format!("requested every {} s", options.output_step);
    match rows {
        Rows::Every => Decision::new(rows, format!("{every}"), wanted),
        Rows::Interpolated => Decision::new(
            rows,
            format!("{every}, interpolated within steps"),
            format!("{wanted}; projected onto the constraints later"),
        ),
        Rows::Ends => Decision::new(rows, "only first and last", "no other rows are written")
            .saving(every.saturating_sub(2), every, Cost::Rows),
    }
}

fn accelerations(wanted: bool) -> Decision<bool> {
    if wanted {
        Decision::new(true, "at output rows", "requested")
    } else {
        Decision::new(false, "only within steps", "not requested at output rows")
    }
}
