//! The kernels of a constraint, and the properties that are tested only for constraints.

mod data;
mod identities;

use std::collections::BTreeSet;

use joints::spec::{ConstraintSpec, Row, Spec};
use joints::{Argument, ArgumentError, Constraint, Definition, Element, SlopedOutputs};

use crate::block::Block;
use crate::bodies::Bodies;
use crate::check::{Check, entry};
use crate::failure::{DUAL_TOLERANCE, Failure, Property, fact};
use crate::kernels::{AnyConstraint, KernelNumber};
use crate::pattern::Pattern;
use crate::state::{Along, State};
use crate::subject::{By, Derivative, Subject, dense, sparse};
use identities::phi_at_start;

/// A constraint definition for a check.
#[derive(Clone, Copy)]
pub(crate) struct OfConstraint<S: Bodies> {
    spec: &'static ConstraintSpec,
    make: Make<S>,
}

type Make<S> = fn(&[Argument]) -> Result<Box<dyn AnyConstraint<S>>, ArgumentError>;

impl<S: Bodies> OfConstraint<S> {
    /// Creates the subject for the definition K.
    pub(crate) fn new<K: Constraint<S>>() -> Self {
        Self {
            spec: const { &K::SPEC },
            make: |arguments| Ok(Box::new(K::from_arguments(arguments)?)),
        }
    }

    /// Returns row and column of each entry of C.
    fn c_pattern(self) -> Vec<[usize; 2]> {
        let entries = self.spec.c.iter();
        entries
            .map(|e| [e.row, S::N_DOF * e.slot + e.dof])
            .collect()
    }
}

/// The kernels of a constraint, and quantities computed from them.
#[derive(Clone, Copy)]
pub(crate) enum Kernel {
    /// The values Φ of the holonomic rows.
    Phi,
    C,
    B,
    /// The value C·v − b.
    Velocity,
    Gamma,
    /// The value Cᵀλ.
    Force,
    /// The value C·a − Γ.
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

/// Derivatives of Φ in the holonomic rows.
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

/// Properties that were observed in some case.
#[derive(Default)]
pub(crate) struct Seen {
    /// Rows of Φ that are not zero at every initial configuration.
    restricting: BTreeSet<usize>,
    depends_on_time: bool,
}

impl<S: Bodies> Subject for OfConstraint<S> {
    type Space = S;
    type Made = Box<dyn AnyConstraint<S>>;
    type Kernel = Kernel;
    type Seen = Seen;

    const SLOPE: Kernel = Kernel::C;
    const INVARIANTS: &'static [(Kernel, &'static str)] = &[
        (Kernel::Phi, "Φ"),
        (Kernel::C, "C"),
        (Kernel::Gamma, "Γ"),
        (Kernel::Wrench, "the wrench map"),
        (Kernel::Component, "the component"),
    ];

    fn common(self) -> &'static Spec {
        &self.spec.common
    }

    fn rows(self) -> &'static [Row] {
        self.spec.rows
    }

    fn turning(self) -> bool {
        self.spec.turning
    }

    fn turns(self) -> usize {
        self.spec.turns
    }

    fn make(self, arguments: &[Argument]) -> Result<Self::Made, ArgumentError> {
        (self.make)(arguments)
    }

    fn definition(made: &mut Self::Made) -> &mut dyn Definition<S> {
        made.as_mut().definition()
    }

    fn kernel<D: KernelNumber>(
        self,
        made: &Self::Made,
        kernel: Kernel,
        at: &State<S, D>,
    ) -> Block<D> {
        let (k, spec) = (D::of_constraint(made.as_ref()), self.spec);
        let of = |kernel| self.kernel(made, kernel, at);
        let State { x, f, lambda, .. } = at;
        let v = &State::<S, D>::twists(&at.v);
        let (m, n) = (spec.rows.len(), self.columns());
        match kernel {
            Kernel::Phi => dense(spec.holonomic, |out| k.phi(x, f, out)),
            Kernel::C => sparse([m, n], &self.c_pattern(), |out| c_entries(k, x, f, out)),
            Kernel::B if !spec.rheonomic => dense(m, |out| {
                out.fill(D::from(0.0));
                k.b(x, f, out);
            }),
            Kernel::B => dense(m, |out| k.b(x, f, out)),
            Kernel::Velocity => {
                let mut velocity = of(Kernel::C).times(&at.v);
                velocity.update(&of(Kernel::B), |e, b| e - b);
                velocity
            }
            Kernel::Gamma => dense(m, |out| k.gamma(x, v, f, out)),
            Kernel::Force => of(Kernel::C).transpose_times(lambda),
            Kernel::Residual => {
                let mut residual = of(Kernel::C).times(&at.a);
                residual.update(&of(Kernel::Gamma), |e, g| e - g);
                residual
            }
            Kernel::Wrench => {
                let reaction = D::reaction_of(made.as_ref());
                sparse([S::N_DOF, m], spec.wrench, |out| reaction.wrench(x, f, out))
            }
            Kernel::Component => {
                let rows = spec.component.map_or(0, |_| m);
                dense(rows, |out| k.component(x, f, out))
            }
            Kernel::Place => {
                let place = D::reaction_of(made.as_ref()).place(x);
                Block::column(place.as_ref().to_vec())
            }
            _ => unreachable!("a kernel that is not differentiated"),
        }
    }

    fn final_kernel(self, made: &Self::Made, kernel: Kernel, at: &State<S, f64>) -> Block {
        let (k, spec) = (made.plain(), self.spec);
        let State { x, f, lambda, .. } = at;
        let (v, a) = (
            &State::<S, f64>::twists(&at.v),
            &State::<S, f64>::twists(&at.a),
        );
        let (m, n) = (spec.rows.len(), self.columns());
        match kernel {
            Kernel::DForceDx => sparse([n, n], spec.d_force_dx, |out| {
                k.d_force_dx(x, f, lambda, out);
            }),
            Kernel::DResidualDx => sparse([m, n], spec.d_residual_dx, |out| {
                k.d_residual_dx(x, v, a, f, out);
            }),
            Kernel::DGammaDv => sparse([m, n], spec.d_gamma_dv, |out| {
                k.d_gamma_dv(x, v, f, out);
            }),
            Kernel::DVelocityDx => sparse([m, n], spec.d_velocity_dx, |out| {
                k.d_velocity_dx(x, v, f, out);
            }),
            Kernel::DPhiDp => dense(spec.n_data(), |out| {
                k.slopes(x, f, SlopedOutputs::Phi).phi(lambda, out);
            }),
            Kernel::DResidualDp => dense(spec.n_data(), |out| {
                k.slopes(x, f, SlopedOutputs::All(v))
                    .residual(lambda, &at.a, out);
            }),
            _ => self.kernel(made, kernel, at),
        }
    }

    fn patterns(self) -> Result<Vec<(Kernel, Pattern)>, Failure> {
        use Kernel as W;
        let (m, n, spec) = (self.spec.rows.len(), self.columns(), self.spec);
        let of = |kernel, name, shape, entries: &[[usize; 2]]| {
            let pattern = Pattern::new(spec.common.name, name, shape, entries.to_vec())?;
            Ok((kernel, pattern))
        };
        let patterns = [
            of(W::C, "C", [m, n], &self.c_pattern()),
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

    /// Checks that kernels write exactly the entries that they must write.
    fn before(check: &Check<'_, Self>) -> Result<(), Failure> {
        let (k, spec) = (check.made.plain(), check.of.spec);
        let at = Along::Time.state(check.case, &check.case.motions[0], 0.0);
        let (x, f) = (&at.x, &at.f);
        let unwritten = |n| vec![f64::NAN; n];
        let (mut constant, mut varying) = (unwritten(spec.c.len()), unwritten(spec.c.len()));
        let mut b = unwritten(spec.rows.len());
        k.c_constant(&mut constant);
        k.c(x, f, &mut varying);
        k.b(x, f, &mut b);
        let entries = spec.c.iter().zip(constant.iter().zip(&varying));
        let c = entries.flat_map(|(e, (c, v))| {
            let name = entry(check.of, Property::C, e.row, S::N_DOF * e.slot + e.dof);
            [
                (format!("c_constant, {name}"), !c.is_nan(), e.constant),
                (format!("c, {name}"), !v.is_nan(), !e.constant),
            ]
        });
        let b = b.iter().enumerate().map(|(row, b)| {
            let name = format!("b, {}", entry(check.of, Property::B, row, 0));
            (name, !b.is_nan(), spec.rheonomic)
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
        check.programs()?;
        check.rows_balance()
    }

    fn see(check: &Check<'_, Self>, seen: &mut Seen) {
        let b = check.at(Kernel::B, &check.case.motions[0]);
        seen.depends_on_time |= b.largest() > 0.0;
        let at_start = phi_at_start(check);
        let rows = (0..at_start.rows()).filter(|&row| at_start.get(row, 0).abs() > DUAL_TOLERANCE);
        seen.restricting.extend(rows);
    }

    fn facts(self, seen: &Seen) -> Result<(), Failure> {
        let spec = self.spec;
        if seen.depends_on_time != spec.rheonomic {
            let entry = "`rheonomic` of the spec against b".to_owned();
            let facts = [spec.rheonomic, seen.depends_on_time].map(f64::from);
            return Err(fact(spec.common.name, Property::B, entry, facts, None));
        }
        let idle = |(n, row): &(usize, &Row)| row.restricts_start && !seen.restricting.contains(n);
        let holonomic = spec.rows.iter().take(spec.holonomic);
        match holonomic.enumerate().find(idle) {
            Some((_, row)) => {
                let entry = format!("row `{}`, zero at every start", row.name);
                let facts = [0.0, 1.0];
                Err(fact(spec.common.name, Property::Start, entry, facts, None))
            }
            None => Ok(()),
        }
    }
}

/// Returns the constant entries and the varying entries of C, in the order of the pattern.
fn c_entries<S: Bodies, D: KernelNumber>(
    k: &dyn Element<D, S>,
    x: &[S::Pose<D>],
    f: &[[D; 3]],
    out: &mut [D],
) {
    let mut constant = vec![D::from(f64::NAN); out.len()];
    k.c_constant(&mut constant);
    k.c(x, f, out);
    for ((e, c), out) in k.spec().c.iter().zip(constant).zip(out) {
        if e.constant {
            *out = c;
        }
    }
}
