//! The functions of a module as programs: accelerations, multipliers, projection, derivatives,
//! residuals.

use dynamics::code::LEAVE;
use model::record::Input;
use model::{SpaceKind, System};
use symbolic::{Program, Value};

use crate::eliminate::Factored;
use crate::equations::{Equations, Source};
use crate::error::CodeError;
use crate::frame::{Seen, may_be_seen_from};
use crate::subject::Subject;

/// Largest number of operations of a generated function. A compiler takes about a minute for it.
const LIMIT: usize = 60_000;

/// Largest number of bodies whose frames are tried.
const VIEWS: usize = 12;

/// The smallest size of a divisor is taken as at least this fraction of its median.
const OF_MEDIAN: f64 = 0.5;

/// One function: straight-line code from inputs to outputs, and the relative sizes of its divisors.
pub(crate) struct Function {
    pub(crate) signature: Signature,
    /// Number of outputs.
    pub(crate) n_out: usize,
    /// Outputs, then relative sizes of divisors.
    pub(crate) program: Program,
}

/// Name, arguments and result of a function, the same for every mechanism: arrays with the
/// constants that are their lengths.
pub(crate) struct Signature {
    pub(crate) name: &'static str,
    pub(crate) doc: &'static str,
    /// Arguments after the time.
    pub(crate) arguments: &'static [(&'static str, &'static str)],
    pub(crate) out: (&'static str, &'static str),
    /// Whether it returns a health, the smallest relative size of its divisors.
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
    doc: "Their multipliers λ of all rows, 0 for dropped ones.",
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
    out: ("dq", "N_Q"),
    divides: true,
};

const VELOCITY_CORRECTION: Signature = Signature {
    name: "velocity_correction",
    doc: "The smallest dv in the mass metric with `C·dv = −r` on the kept rows.",
    arguments: &[("q", "N_Q"), ("r", "ROWS")],
    out: ("dv", "N_V"),
    divides: true,
};

/// All functions of a module.
pub(crate) struct Functions {
    pub(crate) equations: Equations,
    pub(crate) list: Vec<Function>,
    /// The body in whose frame the equations are solved, if it is not the ground.
    pub(crate) seen_from: Option<String>,
    /// Number of sampled states at which the health of accelerations is below the limit of runs.
    pub(crate) unhealthy: usize,
}

impl Functions {
    /// In the frame of the ground, or of the body in whose frame accelerations need the fewest
    /// operations, if the equations may be solved in the frames of bodies.
    pub(crate) fn new(subject: &Subject<'_>) -> Result<Self, CodeError> {
        if subject.prepared.mechanism.space() != SpaceKind::Plane {
            return Err(CodeError::NotPlanar);
        }
        let from_ground = Self::seen_from(subject, None);
        let angles: Vec<usize> = (2..subject.prepared.mechanism.layout().n_q)
            .step_by(3)
            .take(VIEWS)
            .filter(|&angle| may_be_seen_from(subject, angle))
            .collect();
        let views = angles
            .into_iter()
            .map(|angle| Self::seen_from(subject, Some(angle)));
        let cost = |f: &Self| f.list[0].program.counts().total();
        let best = views.flatten().min_by_key(cost);
        let functions = match (best, from_ground) {
            (Some(best), _) => best,
            (None, from_ground) => from_ground?,
        };
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

    /// All functions, with the equations solved in the frame of the ground or of the body whose
    /// angle has this index in q.
    fn seen_from(subject: &Subject<'_>, angle: Option<usize>) -> Result<Self, CodeError> {
        let forces = subject.prepared.mechanism.applied_forces();
        if let Some((drive, _)) = forces.law_drives().next() {
            let drive = drive.to_owned();
            return Err(CodeError::Law { drive });
        }
        let mut e = Equations::new(subject);
        let prepared = subject.prepared;
        let mechanism = &prepared.mechanism;
        let (layout, mass) = (mechanism.layout(), mechanism.mass());
        let (kept, position_kept) = (&prepared.decision.kept, &prepared.position_decision.kept);
        let seen = match angle {
            None => Seen::from_ground(&e),
            Some(angle) => Seen::from_body(&mut e, subject, angle)
                .filter(|seen| seen.keeps_pairs(kept) && seen.keeps_pairs(position_kept))
                .ok_or(CodeError::NoView)?,
        };
        let frame = &seen.frame;
        let scaling = mechanism.layout().dimension_scaling(prepared.assembly.size);
        let scale: Vec<f64> = scaling.cols.iter().map(|&x| f64::from(x).exp2()).collect();
        let rows = |kept: &[usize]| kept.iter().map(|&i| seen.c[i].clone()).collect();
        let velocity = Factored::new(&mut e.code, rows(kept), mass, &scale)?;
        let position = Factored::new(&mut e.code, rows(position_kept), mass, &scale)?;
        let velocity_shares = shares(&mut e, &velocity);
        let position_shares = shares(&mut e, &position);

        let gamma: Vec<Value> = kept.iter().map(|&i| seen.gamma[i]).collect();
        let a_seen = velocity.solve(&mut e.code, mass, &gamma, &seen.force);
        let a = frame.velocities_out(&mut e.code, &a_seen);

        let p = &mut e.code.program;
        let excess: Vec<Value> = (0..layout.n_v)
            .map(|i| {
                let m = p.number(mass[i]);
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
        let no_force = vec![zero; layout.n_v];
        let mut correct = |factored: &Factored, kept: &[usize]| {
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
        let plan = [
            (ACCELERATION, a, shares.clone()),
            (MULTIPLIERS, lambda, shares.clone()),
            (PHI, e.phi.clone(), Vec::new()),
            (VELOCITY_RESIDUAL, residual, Vec::new()),
            (POSITION_CORRECTION, dq, position_shares),
            (VELOCITY_CORRECTION, dv, shares),
        ];
        let program = &e.code.program;
        let list = plan.map(|(signature, outputs, shares)| Function {
            signature,
            n_out: outputs.len(),
            program: program.with_outputs(&[outputs, shares].concat()),
        });
        Ok(Self {
            equations: e,
            list: list.into(),
            unhealthy,
            seen_from: angle.map(|k| mechanism.coordinate(k).0.to_owned()),
        })
    }
}

/// Each divisor relative to its smallest size over the sampled states, with its sign. If that size
/// is less than a fraction of its median, the fraction of the median is used: a motion that passes
/// near a singular configuration must not define the reference.
fn shares(e: &mut Equations, factored: &Factored) -> Vec<Value> {
    let share = |&divisor: &Value| {
        let at = e.code.at(divisor);
        let sign = at.first().map_or(1.0, |d| d.signum());
        let mut sizes: Vec<f64> = at.iter().map(|d| d.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let unit = sizes[0].max(OF_MEDIAN * sizes[sizes.len() / 2]);
        // A power of two, so that the text does not depend on the rounding of the sampled states.
        let unit = unit.log2().round().exp2();
        let unit = e.code.program.number(sign / unit);
        e.code.program.mul(divisor, unit)
    };
    factored.divisors.iter().map(share).collect()
}
