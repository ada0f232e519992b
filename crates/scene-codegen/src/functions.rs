//! The functions of a module as programs: accelerations, multipliers, projection, derivatives,
//! residuals.

use dynamics::code::LEAVE;
use model::record::Input;
use model::{Mechanism, SpaceKind, System};
use symbolic::{Function as Unary, Op, Program, Value};

use crate::axes::Axes;
use crate::eliminate::FactoredRows;
use crate::equations::{Equations, Source};
use crate::error::CodeError;
use crate::frame::{FrameEquations, may_be_seen_from};
use crate::subject::Subject;

/// Largest number of operations of a generated function. The compilation of a function of this
/// length takes about a minute.
pub(crate) const LIMIT: usize = 60_000;

/// Largest number of bodies whose frames are tested.
const VIEWS: usize = 12;

/// The reference size of a divisor is at least this fraction of the median of the divisor over the
/// sampled states.
const OF_MEDIAN: f64 = 0.5;

/// One function: straight-line code from inputs to outputs, and the relative sizes of its divisors.
pub(crate) struct Function {
    pub(crate) signature: Signature,
    /// Number of outputs.
    pub(crate) n_out: usize,
    /// The outputs, followed by the relative sizes of the divisors.
    pub(crate) program: Program,
}

/// Name, arguments and result of a function, which are the same for every mechanism. The lengths of
/// the arrays are constants of the module.
#[cfg_attr(
    not(feature = "modules"),
    allow(dead_code, reason = "only modules say it")
)]
pub(crate) struct Signature {
    pub(crate) name: &'static str,
    pub(crate) doc: &'static str,
    /// Arguments after the time.
    pub(crate) arguments: &'static [(&'static str, &'static str)],
    pub(crate) out: (&'static str, &'static str),
    /// Whether the function also returns a health value. The health value is the smallest relative
    /// size of the divisors.
    pub(crate) divides: bool,
}

const ACCELERATION: Signature = Signature {
    name: "acceleration",
    doc: "Accelerations a of `M·a + Cᵀ·λ = Q`, `C·a = Γ` on the kept rows.",
    arguments: &[("q", "N_Q"), ("v", "N_V")],
    out: ("a", "N_V"),
    divides: true,
};

const MULTIPLIERS: Signature = Signature {
    name: "multipliers",
    doc: "Multipliers λ of all rows for these accelerations; 0 for dropped rows.",
    arguments: &[("q", "N_Q"), ("v", "N_V")],
    out: ("lambda", "ROWS"),
    divides: true,
};

const PHI: Signature = Signature {
    name: "phi",
    doc: "Φ of all holonomic rows.",
    arguments: &[("q", "N_Q")],
    out: ("values", "M"),
    divides: false,
};

const VELOCITY_RESIDUAL: Signature = Signature {
    name: "velocity_residual",
    doc: "`C·v − b` of all rows.",
    arguments: &[("q", "N_Q"), ("v", "N_V")],
    out: ("values", "ROWS"),
    divides: false,
};

const POSITION_CORRECTION: Signature = Signature {
    name: "position_correction",
    doc: "The smallest dq in the mass metric with `Φq·dq = −r` on the rows that hold the position.",
    arguments: &[("q", "N_Q"), ("r", "M")],
    out: ("dq", "N_V"),
    divides: true,
};

const VELOCITY_CORRECTION: Signature = Signature {
    name: "velocity_correction",
    doc: "The smallest dv in the mass metric with `C·dv = −r` on the kept rows.",
    arguments: &[("q", "N_Q"), ("r", "ROWS")],
    out: ("dv", "N_V"),
    divides: true,
};

/// This function exists only in space, because q̇ = v in the plane.
pub(crate) const RATE: Signature = Signature {
    name: "rate",
    doc: "q̇ = T(q)·v: `½·e∘(0, ω)` for the quaternion e of each body.",
    arguments: &[("q", "N_Q"), ("v", "N_V")],
    out: ("qd", "N_Q"),
    divides: false,
};

/// The axes in which the equations are solved.
#[derive(Clone, Copy)]
enum View {
    /// The equations use ground axes for translations. In space, the components of angular
    /// velocities are along the principal axes of the body.
    Ground,
    /// In the plane: the equations are in the frame of the body whose angle has this index in q.
    Angle(usize),
    /// In space: angular velocities are in ground axes.
    GroundAxes,
    /// In space: the angular velocity of each body is in the axes of the body that supports it.
    JointAxes,
    /// In space: all velocities are in the axes of this body.
    BodyAxes(usize),
}

/// The axes as text; a body is given by its name.
#[cfg_attr(
    not(feature = "modules"),
    allow(dead_code, reason = "only modules say it")
)]
pub(crate) enum NamedView {
    Ground,
    GroundAxes,
    JointAxes,
    Frame(String),
}

/// All functions of a module.
#[cfg_attr(
    not(feature = "modules"),
    allow(dead_code, reason = "only modules say it")
)]
pub(crate) struct Functions {
    pub(crate) equations: Equations,
    pub(crate) list: Vec<Function>,
    /// The axes in which the equations are solved.
    pub(crate) view: NamedView,
    /// Number of sampled states at which the health of the accelerations is below the limit that
    /// runs require.
    pub(crate) unhealthy: usize,
}

impl Functions {
    /// Generates the functions in the axes for which the accelerations need the fewest operations.
    /// In space, the function prefers the axes for which the health is below the limit of runs at
    /// the fewest sampled states.
    pub(crate) fn new(subject: &Subject<'_>) -> Result<Self, CodeError> {
        recordable(&subject.prepared.mechanism)?;
        let functions = match subject.prepared.mechanism.space() {
            SpaceKind::Plane => Self::in_plane(subject)?,
            SpaceKind::Space3 => Self::in_space(subject)?,
            #[allow(unreachable_patterns, reason = "the space for tests is a feature")]
            _ => return Err(CodeError::Coordinates),
        };
        let is_of_rotation = |op: &Op| matches!(op, Op::Call(Unary::AngleOverSine(_), _));
        let ops = || functions.list.iter().flat_map(|f| f.program.ops());
        if ops().any(is_of_rotation) {
            return Err(CodeError::RotationVector);
        }
        let longest = functions
            .list
            .iter()
            .map(|f| f.program.counts().total())
            .max();
        match longest {
            Some(operations) if operations > LIMIT => Err(CodeError::TooLong {
                operations,
                limit: LIMIT,
            }),
            _ => Ok(functions),
        }
    }

    fn in_plane(subject: &Subject<'_>) -> Result<Self, CodeError> {
        let from_ground = Self::seen(subject, View::Ground);
        let angles = (2..subject.prepared.mechanism.layout().n_q)
            .step_by(3)
            .take(VIEWS)
            .filter(|&angle| may_be_seen_from(subject, angle));
        let views = angles.flat_map(|angle| Self::seen(subject, View::Angle(angle)));
        views.min_by_key(Self::cost).map_or(from_ground, Ok)
    }

    /// The axes of single bodies are tested only if the other axes are not suitable for all sampled
    /// states.
    fn in_space(subject: &Subject<'_>) -> Result<Self, CodeError> {
        let mut best = Self::seen(subject, View::Ground);
        let bodies = 0..subject.prepared.mechanism.bodies().len().min(VIEWS);
        let views = [View::GroundAxes, View::JointAxes].into_iter();
        for view in views.chain(bodies.map(View::BodyAxes)) {
            let serves_all = best.as_ref().is_ok_and(|best| best.unhealthy == 0);
            if serves_all && matches!(view, View::BodyAxes(_)) {
                break;
            }
            if let Ok(other) = Self::seen(subject, view) {
                let key = |f: &Self| (f.unhealthy, f.cost());
                if best.as_ref().map_or(true, |best| key(&other) < key(best)) {
                    best = Ok(other);
                }
            }
        }
        best
    }

    /// Number of operations for the accelerations.
    fn cost(&self) -> usize {
        self.list[0].program.counts().total()
    }

    /// Generates all functions; the equations are solved in these axes.
    fn seen(subject: &Subject<'_>, view: View) -> Result<Self, CodeError> {
        let mut e = Equations::new(subject);
        let prepared = subject.prepared;
        let mechanism = &prepared.mechanism;
        let (layout, mass) = (mechanism.layout(), e.mass());
        let mass = mass.as_slice();
        let (kept, position_kept) = (&prepared.decision.kept, &prepared.position_decision.kept);
        let mut seen = match view {
            View::Angle(angle) => FrameEquations::from_body(&mut e, subject, angle)
                .filter(|seen| seen.keeps_pairs(kept) && seen.keeps_pairs(position_kept))
                .ok_or(CodeError::NoView)?,
            _ => FrameEquations::from_ground(&e),
        };
        let axes = match view {
            View::Ground | View::Angle(_) => Some(Axes::default()),
            View::GroundAxes => Axes::of_ground(&e, subject),
            View::JointAxes => Axes::of_joints(&mut e, subject),
            View::BodyAxes(body) => Axes::of_body(&mut e, subject, body)
                .filter(|axes| axes.keeps_vectors(kept) && axes.keeps_vectors(position_kept)),
        };
        let axes = axes.ok_or(CodeError::NoView)?;
        seen.c = axes.rows_of(&mut e.code, &seen.c);
        let frame = &seen.frame;
        let scaling = mechanism.layout().dimension_scaling(prepared.assembly.size);
        let scale: Vec<f64> = scaling.cols.iter().map(|&x| f64::from(x).exp2()).collect();
        let rows = |kept: &[usize]| kept.iter().map(|&i| seen.c[i].clone()).collect();
        let velocity = FactoredRows::new(&mut e.code, rows(kept), &axes, (mass, &scale))?;
        let position = FactoredRows::new(&mut e.code, rows(position_kept), &axes, (mass, &scale))?;
        let velocity_shares = shares(&mut e, &velocity);
        let position_shares = shares(&mut e, &position);

        let gamma = axes.rows_in(&mut e.code, &seen.gamma);
        let gamma: Vec<Value> = kept.iter().map(|&i| gamma[i]).collect();
        let a_seen = velocity.solve(&mut e.code, mass, &gamma, &seen.force);
        let a = frame.velocities_out(&mut e.code, &a_seen);

        let p = &mut e.code.program;
        let excess: Vec<Value> = (0..layout.n_v)
            .map(|i| {
                let m = mass[i].value(p);
                let inertia = p.mul(m, a_seen[i]);
                p.sub(seen.force[i], inertia)
            })
            .collect();
        let kept_lambda = velocity.multipliers(&mut e.code, &excess);
        let zero = e.code.program.number(0.0);
        let mut lambda = vec![zero; layout.rows()];
        for (&i, l) in kept.iter().zip(kept_lambda) {
            lambda[i] = l;
        }
        let lambda = axes.rows_out(&mut e.code, &lambda);
        let lambda = frame.rows_out(&mut e.code, &lambda);

        let v: Vec<Value> = (0..layout.n_v)
            .filter_map(|k| e.input(Source::Mechanism(Input::Velocity(k))))
            .collect();
        let mut residual = Vec::with_capacity(layout.rows());
        for i in 0..layout.rows() {
            let rate = e.row_times(i, &v);
            let b = e.b[i];
            residual.push(e.code.program.sub(rate, b));
        }

        let missed = (0..layout.rows()).filter_map(|i| e.input(Source::Rhs(i)));
        let missed: Vec<Value> = missed.collect();
        let p = &mut e.code.program;
        let missing: Vec<Value> = missed.into_iter().map(|r| p.neg(r)).collect();
        let missing = frame.rows_in(&mut e.code, &missing);
        let missing = axes.rows_in(&mut e.code, &missing);
        let no_force = vec![zero; layout.n_v];
        let mut correct = |factored: &FactoredRows, kept: &[usize]| {
            let rhs: Vec<Value> = kept.iter().map(|&i| missing[i]).collect();
            let d = factored.solve(&mut e.code, mass, &rhs, &no_force);
            frame.velocities_out(&mut e.code, &d)
        };
        let dq = correct(&position, position_kept);
        let dv = correct(&velocity, kept);

        let shares = velocity_shares;
        let health = |e: &mut Equations, state: usize| {
            let shares = shares.iter().map(|share| e.code.at(*share)[state]);
            shares.fold(f64::INFINITY, f64::min)
        };
        let states = 0..subject.states.len();
        let unhealthy = states.filter(|&k| health(&mut e, k) < LEAVE).count();
        let mut plan = vec![
            (ACCELERATION, a, shares.clone()),
            (MULTIPLIERS, lambda, shares.clone()),
            (PHI, e.phi.clone(), Vec::new()),
            (VELOCITY_RESIDUAL, residual, Vec::new()),
            (POSITION_CORRECTION, dq, position_shares),
            (VELOCITY_CORRECTION, dv, shares),
        ];
        if mechanism.space() == SpaceKind::Space3 {
            plan.push((RATE, e.rate.clone(), Vec::new()));
        }
        let program = &e.code.program;
        let function =
            |(signature, outputs, shares): (Signature, Vec<Value>, Vec<Value>)| Function {
                signature,
                n_out: outputs.len(),
                program: program.with_outputs(&[outputs, shares].concat()),
            };
        let list = plan.into_iter().map(function).collect();
        Ok(Self {
            equations: e,
            list,
            unhealthy,
            view: match view {
                View::Angle(k) => NamedView::Frame(mechanism.coordinate(k).0.to_owned()),
                View::BodyAxes(k) => NamedView::Frame(mechanism.bodies()[k].name.clone()),
                View::GroundAxes => NamedView::GroundAxes,
                View::JointAxes => NamedView::JointAxes,
                View::Ground => NamedView::Ground,
            },
        })
    }
}

/// Returns an error if the kernels of a mechanism do not compute the same results with recording
/// numbers as in a run.
pub(crate) fn recordable(mechanism: &Mechanism) -> Result<(), CodeError> {
    if mechanism.layout().turns > 0 {
        return Err(CodeError::Turns);
    }
    if !matches!(mechanism.space(), SpaceKind::Plane | SpaceKind::Space3) {
        return Err(CodeError::Coordinates);
    }
    if let Some(force) = mechanism.applied_forces().without_derivatives().next() {
        return Err(CodeError::Called(force));
    }
    if let Some(element) = mechanism.expression_of_time() {
        let element = element.to_owned();
        return Err(CodeError::Expression { element });
    }
    if let Some(armature) = mechanism.armatures().next() {
        let joint = armature.joint.to_owned();
        return Err(CodeError::Armature { joint });
    }
    match mechanism.applied_forces().law_drives().next() {
        Some((drive, _)) => Err(CodeError::Law {
            drive: drive.to_owned(),
        }),
        None => Ok(()),
    }
}

/// Divides each divisor by its smallest size over the sampled states, with its sign. If the
/// smallest size is less than a fraction of the median, this fraction of the median is used.
/// Otherwise, a motion near a singular configuration would determine the reference.
fn shares(e: &mut Equations, factored: &FactoredRows) -> Vec<Value> {
    let share = |&divisor: &Value| {
        let at = e.code.at(divisor);
        let sign = at.first().map_or(1.0, |d| d.signum());
        let mut sizes: Vec<f64> = at.iter().map(|d| d.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let unit = sizes[0].max(OF_MEDIAN * sizes[sizes.len() / 2]);
        // The reference is a power of two, so that the text does not depend on rounding errors in
        // the sampled states.
        let unit = unit.log2().round().exp2();
        let unit = e.code.program.number(sign / unit);
        e.code.program.mul(divisor, unit)
    };
    factored.divisors.iter().map(share).collect()
}

#[cfg(test)]
mod tests {
    use model::{Body, BodyRef, Description, Wrench};

    use super::*;

    #[test]
    fn armatures_are_refused_by_name() {
        let mut d = Description::new("arm");
        let arm = d.body(Body::new("arm", 1.0, 1.0));
        let (bodies, o) = ([BodyRef::Ground, arm], [0.0; 2]);
        d.joint("pin", &bodies, joints::Revolute { s_i: o, s_j: o });
        d.armature("pin", &bodies, joints::RevoluteAngleDrive::new(o, o), 0.0);
        let none = Mechanism::build(&d).expect("builds");
        assert!(recordable(&none).is_ok());
        d.armatures[0].inertia = 0.5;
        let armed = Mechanism::build(&d).expect("builds");
        let refused = recordable(&armed).expect_err("it cannot be recorded");
        assert_eq!(
            refused.to_string(),
            "joint `pin` has an armature, which generated code does not support; run this scene interpreted"
        );
    }

    #[test]
    fn forces_that_call_a_function_are_refused_by_name() {
        let mut d = Description::new("stone");
        let stone = d.body(Body::new("stone", 1.0, 1.0));
        let still = Mechanism::build(&d).expect("builds");
        assert!(recordable(&still).is_ok());
        d.called_force("wind", stone, |_| Ok(Wrench::default()));
        let blown = Mechanism::build(&d).expect("builds");
        let refused = recordable(&blown).expect_err("it cannot be recorded");
        assert_eq!(
            refused.to_string(),
            "force `wind` calls a function, which has no derivatives, which generated code does not support; run this scene interpreted"
        );
    }
}
