//! The computations of a run and those that it omits, decided once from a prepared mechanism, its
//! options and the requested output. Each decision has its reason and states what it saves; a run
//! follows its plan ([`crate::simulate`]). The computations themselves are in other modules.

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

/// The requested output of a motion. Other values are not computed.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputRequest {
    /// Which rows of output are requested.
    pub rows: Rows,
    /// Whether accelerations are requested at these rows.
    pub accelerations: bool,
    /// Joints and drives whose reactions are requested at these rows. With reactions come the
    /// verdicts of the run.
    pub reactions: Reactions,
    /// Groups whose verdicts are requested besides.
    pub groups: Vec<Group>,
    /// Which verdicts are requested with the reactions.
    pub verdicts: Verdicts,
    /// Choices by which all reactions are requested besides, which are possible at the start.
    pub choices: Vec<NamedChoice>,
}

/// Verdicts that come with reactions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdicts {
    /// Those on stretches, and the instants that differ: read at accepted steps and rows of output.
    WithInstants,
    /// Those on the whole run: read at the start, in each stretch at the end of its first accepted
    /// step and at the begin of its last, and at the second, fourth, eighth … step if one is open.
    /// More instants can only add such as differ: between events a component is determined
    /// throughout or, but for isolated instants, nowhere. A reaction is not computed any more where
    /// neither its force nor its torque is determined in a stretch.
    OfRun,
    /// No verdicts.
    None,
}

impl Default for OutputRequest {
    /// Everything.
    fn default() -> Self {
        Self {
            rows: Rows::Every,
            accelerations: true,
            reactions: Reactions::All,
            groups: Vec::new(),
            verdicts: Verdicts::WithInstants,
            choices: Vec::new(),
        }
    }
}

/// Which rows of output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rows {
    /// At time 0, at every output step, and at the end.
    #[default]
    Every,
    /// At the same times, but states as interpolated within steps, which violate the constraints by
    /// about the tolerance of the run. For callers that project them anyway.
    Interpolated,
    /// At time 0 and at the end.
    Ends,
}

/// Which reactions are requested.
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

/// The plan of a run.
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
    /// Whether code generated for the mechanism is used.
    pub code: Decision<bool>,
    /// Which rows of output are computed.
    pub rows: Decision<Rows>,
    /// Whether accelerations are computed at these rows.
    pub accelerations: Decision<bool>,
    /// Groups whose verdicts are computed; none without reactions.
    pub groups: Vec<Group>,
    /// Verdicts that come with reactions.
    pub verdicts: Verdicts,
    /// Choices by which reactions are computed at rows of output.
    pub choices: Vec<NamedChoice>,
    /// Its components, or the whole mechanism as the only one.
    pub components: Vec<ComponentPlan<'a>>,
}

impl<'a> Plan<'a> {
    /// Makes all decisions that are possible before the motion begins.
    ///
    /// # Errors
    /// - [`MotionError::Option`], [`MotionError::Combination`]: the options are invalid.
    /// - [`MotionError::NoReaction`]: a reaction is requested of a joint that does not exist.
    /// - [`MotionError::Fault`]: the motion cannot be evaluated at its start.
    pub fn new(
        prepared: &'a PreparedMechanism,
        options: &MotionOptions,
        wanted: &OutputRequest,
    ) -> Result<Self, MotionError> {
        options.check()?;
        let groups = wanted_groups(prepared, wanted)?;
        let code = code(prepared, options)?;
        let (apart, parts) = if code.value {
            split::stays("the generated code has all bodies".to_owned())
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
            rows: rows(options, wanted.rows),
            accelerations: accelerations(wanted.accelerations),
            verdicts: wanted.verdicts,
            groups: match wanted.reactions {
                Reactions::None => Vec::new(),
                _ => wanted.groups.clone(),
            },
            choices: wanted.choices.clone(),
            components,
        })
    }

    /// The prepared mechanism.
    #[must_use]
    pub fn prepared(&self) -> &'a PreparedMechanism {
        self.prepared
    }

    /// The options of the run; the methods are those of the components.
    #[must_use]
    pub fn options(&self) -> &MotionOptions {
        &self.options
    }

    /// All decisions, those of the whole mechanism first.
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

/// Whether the reaction of each joint and drive is requested, by itself or as a part of a group.
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
        "its values are those of this mechanism ({}); kernels and elimination below are what it falls back to",
        code.operations
    );
    Ok(Decision::new(true, format!("`{}`", code.name), reason))
}

fn rows(options: &MotionOptions, rows: Rows) -> Decision<Rows> {
    let every = (options.t_end / options.output_step).ceil().max(0.0) as u64 + 1;
    let wanted = format!("wanted every {} s", options.output_step);
    match rows {
        Rows::Every => Decision::new(rows, format!("{every}"), wanted),
        Rows::Interpolated => Decision::new(
            rows,
            format!("{every}, as interpolated within steps"),
            format!("{wanted}, and moved onto the constraints elsewhere"),
        ),
        Rows::Ends => Decision::new(rows, "the ends only", "nothing is written of the others")
            .saving(every.saturating_sub(2), every, Cost::Rows),
    }
}

fn accelerations(wanted: bool) -> Decision<bool> {
    if wanted {
        Decision::new(true, "at rows of output", "wanted")
    } else {
        Decision::new(false, "within steps only", "not wanted at rows of output")
    }
}
