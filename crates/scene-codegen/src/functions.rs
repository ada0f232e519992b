//! The functions of a module as programs: accelerations, multipliers, projection, derivatives, residuals.

use model::System;
use model::record::Input;
use symbolic::{Program, Value};

use crate::eliminate::Factored;
use crate::equations::{Equations, Source};
use crate::error::CodeError;
use crate::subject::Subject;

/// Longest function that is generated. A compiler takes about a minute for it.
const LIMIT: usize = 60_000;

/// One function: straight-line code from inputs to outputs, and the shares of its divisors.
pub(crate) struct Function {
    pub(crate) name: &'static str,
    /// What the outputs are called, and how many there are.
    pub(crate) out: (&'static str, usize),
    /// Outputs, then shares.
    pub(crate) program: Program,
}

/// All functions of a module.
pub(crate) struct Functions {
    pub(crate) equations: Equations,
    pub(crate) list: Vec<Function>,
}

impl Functions {
    pub(crate) fn new(subject: &Subject<'_>) -> Result<Self, CodeError> {
        let mut e = Equations::new(subject);
        let prepared = subject.prepared;
        let mechanism = &prepared.mechanism;
        let (layout, mass) = (mechanism.layout(), mechanism.mass());
        let scaling = mechanism.dimension_scaling(prepared.assembly.size);
        let scale: Vec<f64> = scaling.cols.iter().map(|&x| f64::from(x).exp2()).collect();
        let rows = |e: &Equations, kept: &[usize]| kept.iter().map(|&i| e.c[i].clone()).collect();
        let (kept, position_kept) = (&prepared.decision.kept, &prepared.position_decision.kept);
        let c = rows(&e, kept);
        let velocity = Factored::new(&mut e.code, c, mass, &scale)?;
        let c = rows(&e, position_kept);
        let position = Factored::new(&mut e.code, c, mass, &scale)?;
        let velocity_shares = shares(&mut e, &velocity);
        let position_shares = shares(&mut e, &position);

        let gamma: Vec<Value> = kept.iter().map(|&i| e.gamma[i]).collect();
        let force = e.force.clone();
        let a = velocity.solve(&mut e.code, mass, &gamma, &force);

        let p = &mut e.code.program;
        let excess: Vec<Value> = (0..layout.n_v)
            .map(|i| {
                let m = p.number(mass[i]);
                let inertia = p.mul(m, a[i]);
                p.sub(force[i], inertia)
            })
            .collect();
        let kept_lambda = velocity.multipliers(&mut e.code, &excess);
        let zero = e.code.program.number(0.0);
        let mut lambda = vec![zero; layout.rows()];
        for (&i, l) in kept.iter().zip(kept_lambda) {
            lambda[i] = l;
        }

        let v: Vec<Value> = (0..layout.n_v)
            .filter_map(|k| e.input(Source::Mechanism(Input::Velocity(k))))
            .collect();
        let mut residual = Vec::with_capacity(layout.rows());
        for i in 0..layout.rows() {
            let rate = e.row_times(i, &v);
            let b = e.b[i];
            residual.push(e.code.program.sub(rate, b));
        }

        let no_force = vec![zero; layout.n_v];
        let rhs = |e: &mut Equations, kept: &[usize]| -> Vec<Value> {
            let rhs = kept.iter().filter_map(|&i| e.input(Source::Rhs(i)));
            let rhs: Vec<Value> = rhs.collect();
            rhs.into_iter().map(|r| e.code.program.neg(r)).collect()
        };
        let missing = rhs(&mut e, position_kept);
        let dq = position.solve(&mut e.code, mass, &missing, &no_force);
        let missing = rhs(&mut e, kept);
        let dv = velocity.solve(&mut e.code, mass, &missing, &no_force);
        let da = tangent(&mut e, &a);

        let (phi, n_v, n_q) = (e.phi.clone(), layout.n_v, layout.n_q);
        let plan = [
            ("acceleration", ("a", n_v), a, velocity_shares.clone()),
            (
                "multipliers",
                ("lambda", layout.rows()),
                lambda,
                velocity_shares.clone(),
            ),
            ("phi", ("phi", layout.m), phi, Vec::new()),
            (
                "velocity_residual",
                ("residual", layout.rows()),
                residual,
                Vec::new(),
            ),
            ("position_correction", ("dq", n_q), dq, position_shares),
            (
                "velocity_correction",
                ("dv", n_v),
                dv,
                velocity_shares.clone(),
            ),
            ("jacobian_action", ("da", n_v), da, velocity_shares),
        ];
        let list = plan.map(|(name, out, outputs, shares)| Function {
            name,
            out,
            program: e
                .code
                .program
                .with_outputs(&[outputs.as_slice(), &shares].concat()),
        });
        let longest = list.iter().map(|f| f.program.counts().total()).max();
        let operations = longest.unwrap_or(0);
        if operations > LIMIT {
            return Err(CodeError::TooLong {
                operations,
                limit: LIMIT,
            });
        }
        Ok(Self {
            equations: e,
            list: list.into(),
        })
    }
}

/// Each divisor as a signed share of its smallest size over the sampled states.
fn shares(e: &mut Equations, factored: &Factored) -> Vec<Value> {
    let share = |&divisor: &Value| {
        let at = e.code.at(divisor);
        let sign = at.first().map_or(1.0, |d| d.signum());
        let smallest = at.iter().fold(f64::INFINITY, |a, d| a.min(d.abs()));
        let unit = e.code.program.number(sign / smallest);
        e.code.program.mul(divisor, unit)
    };
    factored.divisors.iter().map(share).collect()
}

/// The derivative of accelerations along a direction of coordinates and velocities.
fn tangent(e: &mut Equations, a: &[Value]) -> Vec<Value> {
    let along = |k| Source::AlongQ(k);
    let places: Vec<Option<Value>> = e
        .sources
        .iter()
        .map(|source| match *source {
            Source::Mechanism(Input::Coordinate(k) | Input::Cos(k) | Input::Sin(k)) => {
                e.input(along(k))
            }
            Source::Mechanism(Input::Velocity(k)) => e.input(Source::AlongV(k)),
            _ => None,
        })
        .collect();
    // Partners: d cos = −sin·dφ, d sin = cos·dφ.
    let partner: Vec<Option<Value>> = e
        .sources
        .iter()
        .map(|source| match *source {
            Source::Mechanism(Input::Cos(k)) => e.input(Source::Mechanism(Input::Sin(k))),
            Source::Mechanism(Input::Sin(k)) => e.input(Source::Mechanism(Input::Cos(k))),
            _ => None,
        })
        .collect();
    let sources = e.sources.clone();
    e.code.program.tangent(a, |p, symbol, _| {
        let k = symbol.index();
        let (Some(direction), partner) = (places[k], partner[k]) else {
            return p.number(0.0);
        };
        match (sources[k], partner) {
            (Source::Mechanism(Input::Cos(_)), Some(sin)) => {
                let product = p.mul(sin, direction);
                p.neg(product)
            }
            (Source::Mechanism(Input::Sin(_)), Some(cos)) => p.mul(cos, direction),
            _ => direction,
        }
    })
}
