//! The kernels of a constraint, and the properties that constraints alone have.

mod data;
mod identities;

use std::collections::BTreeSet;
use std::marker::PhantomData;

use joints::spec::{Row, Spec};
use joints::{Argument, ArgumentError, Constraint, Definition, Derivatives, Element};

use crate::block::Block;
use crate::bodies::Bodies;
use crate::check::{Check, entry};
use crate::failure::{DUAL_TOLERANCE, Failure, Property, fact};
use crate::number::Number;
use crate::pattern::Pattern;
use crate::state::{Along, State};
use crate::subject::{By, Derivative, Subject, dense, sparse};
use identities::phi_at_start;

/// A constraint as a subject of the harness.
pub(crate) struct OfConstraint<K, S>(K, PhantomData<S>);

/// Kernels of a constraint, and what is made of them.
#[derive(Clone, Copy)]
pub(crate) enum Kernel {
    /// Φ, of the holonomic rows.
    Phi,
    C,
    B,
    /// C·v − b
    Velocity,
    Gamma,
    /// Cᵀλ
    Force,
    /// C·a − Γ
    Residual,
    Wrench,
    Component,
    Place,
    DForceDx,
    DResidualDx,
    DGammaDv,
    DVelocityDx,
    DPhiDp,
    DResidualDp,
}

/// Derivatives of Φ, in the holonomic rows.
const OF_POSITIONS: [Derivative<Kernel>; 4] = {
    use {Derivative as D, Kernel as K, Property as P};
    [
        D::new(P::C, K::C, 1.0, K::Phi, By::Poses),
        D::new(P::B, K::B, -1.0, K::Phi, By::Time),
        D::new(P::Velocity, K::Velocity, 1.0, K::Phi, By::Motion),
        D::new(P::GammaFromPhi, K::Gamma, -1.0, K::Phi, By::MotionTwice),
    ]
};

/// Derivatives of C, b and Γ.
const OF_VELOCITIES: [Derivative<Kernel>; 5] = {
    use {Derivative as D, Kernel as K, Property as P};
    [
        D::new(P::Gamma, K::Gamma, -1.0, K::Velocity, By::Motion),
        D::new(P::DForceDx, K::DForceDx, 1.0, K::Force, By::Poses),
        D::new(P::DResidualDx, K::DResidualDx, 1.0, K::Residual, By::Poses),
        D::new(P::DGammaDv, K::DGammaDv, 1.0, K::Gamma, By::Twists),
        D::new(P::DVelocityDx, K::DVelocityDx, 1.0, K::Velocity, By::Poses),
    ]
};

/// What was seen over all cases.
#[derive(Default)]
pub(crate) struct Seen {
    /// Rows of Φ that are not zero at every start.
    restricting: BTreeSet<usize>,
    depends_on_time: bool,
}

impl<K: Constraint<S>, S: Bodies> Subject for OfConstraint<K, S> {
    type Space = S;
    type Kernel = Kernel;
    type Seen = Seen;

    const COMMON: Spec = K::SPEC.common;
    const ROWS: &'static [Row] = K::SPEC.rows;
    const TURNING: bool = K::SPEC.turning;
    const TURNS: usize = K::SPEC.turns;
    const SLOPE: Kernel = Kernel::C;
    const INVARIANTS: &'static [(Kernel, &'static str)] = &[
        (Kernel::Phi, "Φ"),
        (Kernel::C, "C"),
        (Kernel::Gamma, "Γ"),
        (Kernel::Wrench, "the wrench map"),
        (Kernel::Component, "the component"),
    ];

    fn from_arguments(arguments: &[Argument]) -> Result<Self, ArgumentError> {
        K::from_arguments(arguments).map(|k| Self(k, PhantomData))
    }

    fn definition(&mut self) -> &mut dyn Definition<S> {
        &mut self.0
    }

    fn kernel<D: Number>(&self, kernel: Kernel, at: &State<S, D>) -> Block<D> {
        let k = self.0.element::<D>();
        let State { x, f, lambda, .. } = at;
        let v = &State::<S, D>::twists(&at.v);
        let (m, n) = (Self::ROWS.len(), Self::columns());
        match kernel {
            Kernel::Phi => dense(K::SPEC.holonomic, |out| k.phi(x, f, out)),
            Kernel::C => sparse([m, n], &c_pattern::<K, S>(), |out| c_entries(k, x, f, out)),
            Kernel::B if !K::SPEC.rheonomic => dense(m, |out| {
                out.fill(D::from(0.0));
                k.b(x, f, out);
            }),
            Kernel::B => dense(m, |out| k.b(x, f, out)),
            Kernel::Velocity => {
                let velocity = self.kernel(Kernel::C, at).times(&at.v);
                velocity.zip(&self.kernel(Kernel::B, at), |e, b| e - b)
            }
            Kernel::Gamma => dense(m, |out| k.gamma(x, v, f, out)),
            Kernel::Force => self.kernel(Kernel::C, at).transpose_times(lambda),
            Kernel::Residual => {
                let inertia = self.kernel(Kernel::C, at).times(&at.a);
                inertia.zip(&self.kernel(Kernel::Gamma, at), |e, g| e - g)
            }
            Kernel::Wrench => sparse([S::N_DOF, m], K::SPEC.wrench, |out| k.wrench(x, f, out)),
            Kernel::Component => {
                let rows = K::SPEC.component.map_or(0, |_| m);
                dense(rows, |out| k.component(x, f, out))
            }
            Kernel::Place => Block::column(k.place(x).as_ref().to_vec()),
            Kernel::DPhiDp => dense(K::SPEC.n_data(), |out| k.d_phi_dp(x, f, lambda, out)),
            _ => unreachable!("a kernel that is not differentiated"),
        }
    }

    fn final_kernel(&self, kernel: Kernel, at: &State<S, f64>) -> Block {
        let k: &dyn Derivatives<f64, S> = &self.0;
        let State { x, f, lambda, .. } = at;
        let (v, a) = (
            &State::<S, f64>::twists(&at.v),
            &State::<S, f64>::twists(&at.a),
        );
        let (m, n) = (Self::ROWS.len(), Self::columns());
        match kernel {
            Kernel::DForceDx => sparse([n, n], K::SPEC.d_force_dx, |out| {
                k.d_force_dx(x, f, lambda, out);
            }),
            Kernel::DResidualDx => sparse([m, n], K::SPEC.d_residual_dx, |out| {
                k.d_residual_dx(x, v, a, f, out);
            }),
            Kernel::DGammaDv => sparse([m, n], K::SPEC.d_gamma_dv, |out| {
                k.d_gamma_dv(x, v, f, out);
            }),
            Kernel::DVelocityDx => sparse([m, n], K::SPEC.d_velocity_dx, |out| {
                k.d_velocity_dx(x, v, f, out);
            }),
            Kernel::DResidualDp => dense(K::SPEC.n_data(), |out| {
                k.d_residual_dp(x, v, a, f, lambda, out);
            }),
            _ => self.kernel(kernel, at),
        }
    }

    fn patterns() -> Result<Vec<(Kernel, Pattern)>, Failure> {
        use Kernel as W;
        let (m, n, spec) = (Self::ROWS.len(), Self::columns(), &K::SPEC);
        let of = |kernel, name, shape, entries: &[[usize; 2]]| {
            let pattern = Pattern::new(spec.common.name, name, shape, entries.to_vec())?;
            Ok((kernel, pattern))
        };
        let patterns = [
            of(W::C, "C", [m, n], &c_pattern::<K, S>()),
            of(W::Wrench, "the wrench map", [S::N_DOF, m], spec.wrench),
            of(W::DForceDx, "∂(Cᵀλ)/∂x", [n, n], spec.d_force_dx),
            of(W::DResidualDx, "∂(C·a − Γ)/∂x", [m, n], spec.d_residual_dx),
            of(W::DGammaDv, "∂Γ/∂v", [m, n], spec.d_gamma_dv),
            of(W::DVelocityDx, "∂(C·v − b)/∂x", [m, n], spec.d_velocity_dx),
        ];
        patterns.into_iter().collect()
    }

    fn derivatives() -> impl Iterator<Item = &'static Derivative<Kernel>> {
        OF_POSITIONS.iter().chain(&OF_VELOCITIES)
    }

    /// Kernels write exactly the entries that are theirs.
    fn before(check: &Check<'_, Self>) -> Result<(), Failure> {
        let k = &check.subject.0;
        let at = Along::Time.state(check.case, &check.case.motions[0], 0.0);
        let (x, f) = (&at.x, &at.f);
        let unwritten = |n| vec![f64::NAN; n];
        let (mut constant, mut varying) = (unwritten(K::SPEC.c.len()), unwritten(K::SPEC.c.len()));
        let mut b = unwritten(Self::ROWS.len());
        k.c_constant(&mut constant);
        k.c(x, f, &mut varying);
        k.b(x, f, &mut b);
        let entries = K::SPEC.c.iter().zip(constant.iter().zip(&varying));
        let c = entries.flat_map(|(e, (c, v))| {
            let name = entry::<Self>(Property::C, e.row, S::N_DOF * e.slot + e.dof);
            [
                (format!("c_constant, {name}"), !c.is_nan(), e.constant),
                (format!("c, {name}"), !v.is_nan(), !e.constant),
            ]
        });
        let b = b.iter().enumerate().map(|(row, b)| {
            let name = format!("b, {}", entry::<Self>(Property::B, row, 0));
            (name, !b.is_nan(), K::SPEC.rheonomic)
        });
        match c.chain(b).find(|(_, written, due)| written != due) {
            Some((entry, written, due)) => {
                Err(check.fact(Property::Writes, entry, [written, due].map(f64::from)))
            }
            None => Ok(()),
        }
    }

    fn properties(check: &Check<'_, Self>) -> Result<(), Failure> {
        check.data()?;
        check.wrench()?;
        check.place()?;
        check.component()?;
        check.start()?;
        check.turned()?;
        check.rows_balance()
    }

    fn see(check: &Check<'_, Self>, seen: &mut Seen) {
        let b = check.at(Kernel::B, &check.case.motions[0]);
        seen.depends_on_time |= b.largest() > 0.0;
        let at_start = phi_at_start(check);
        let rows = (0..at_start.rows()).filter(|&row| at_start.get(row, 0).abs() > DUAL_TOLERANCE);
        seen.restricting.extend(rows);
    }

    fn facts(seen: &Seen) -> Result<(), Failure> {
        if seen.depends_on_time != K::SPEC.rheonomic {
            let entry = "`rheonomic` of the spec against b".to_owned();
            let facts = [K::SPEC.rheonomic, seen.depends_on_time].map(f64::from);
            return Err(fact(Self::COMMON.name, Property::B, entry, facts, None));
        }
        let idle = |(n, row): &(usize, &Row)| row.restricts_start && !seen.restricting.contains(n);
        let holonomic = Self::ROWS.iter().take(K::SPEC.holonomic);
        match holonomic.enumerate().find(idle) {
            Some((_, row)) => {
                let entry = format!("row `{}`, zero at every start", row.name);
                let facts = [0.0, 1.0];
                Err(fact(Self::COMMON.name, Property::Start, entry, facts, None))
            }
            None => Ok(()),
        }
    }
}

/// Row and column of each entry of C.
fn c_pattern<K: Constraint<S>, S: Bodies>() -> Vec<[usize; 2]> {
    let entries = K::SPEC.c.iter();
    entries
        .map(|e| [e.row, S::N_DOF * e.slot + e.dof])
        .collect()
}

/// Entries of C in the order of the pattern, constant and varying ones.
fn c_entries<S: Bodies, D: Number>(
    k: &dyn Element<D, S>,
    x: &[S::Pose<D>],
    f: &[[D; 3]],
    out: &mut [D],
) {
    let mut constant = vec![f64::NAN; out.len()];
    k.c_constant(&mut constant);
    k.c(x, f, out);
    for ((e, c), out) in k.spec().c.iter().zip(constant).zip(out) {
        if e.constant {
            *out = D::from(c);
        }
    }
}
