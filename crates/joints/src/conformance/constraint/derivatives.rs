//! Kernels compared with derivatives of the kernels before them: C and b with those of Φ, Γ with
//! those of both, and so on.

use super::super::block::Block;
use super::super::case::Motion;
use super::super::derivative::{Curve, Differentiate};
use super::super::failure::{Claim, Failure, Property};
use super::super::kernels;
use super::super::number::Number;
use super::super::oracle::Oracle;
use super::super::state::{Along, State};
use super::check::Check;
use crate::constraint::Constraint;
use crate::plane::Twist;
use crate::spec::Level;

/// A column of kernel results along a curve.
pub(super) struct Path<'a, K> {
    check: &'a Check<'a, K>,
    motion: &'a Motion,
    along: Along,
    quantity: Quantity,
}

#[derive(Clone, Copy)]
pub(super) enum Quantity {
    /// Φ
    Phi,
    /// C·v − b
    Velocity,
    /// Γ
    Gamma,
    /// Cᵀλ
    Force,
    /// C·a − Γ
    Residual,
    /// The place.
    Place,
    /// ∂(λᵀΦ)/∂p
    PhiByData,
}

impl<K: Constraint> Curve for Path<'_, K> {
    fn at<D: Number>(&self, tau: D) -> Block<D> {
        let State { x, v, f } = self.along.state(self.check.case, self.motion, tau);
        let k = self.check.constraint;
        let stack =
            |t: &[Twist<D>]| -> Vec<D> { t.iter().flat_map(|t| [t.x, t.y, t.omega]).collect() };
        match self.quantity {
            Quantity::Phi => kernels::phi(k, &x, &f),
            Quantity::Velocity => {
                let velocity = times(&kernels::c(k, &x, &f), &stack(&v));
                velocity.zip(&kernels::b(k, &x, &f), |e, b| e - b)
            }
            Quantity::Gamma => kernels::gamma(k, &x, &v, &f),
            Quantity::Force => {
                let lambda: Vec<D> = self.motion.lambda.iter().map(|&l| D::from(l)).collect();
                transpose_times(&kernels::c(k, &x, &f), &lambda)
            }
            Quantity::Residual => {
                let a = self.motion.a.iter().flat_map(|a| [a.x, a.y, a.omega]);
                let a: Vec<D> = a.map(D::from).collect();
                let inertia = times(&kernels::c(k, &x, &f), &a);
                inertia.zip(&kernels::gamma(k, &x, &v, &f), |e, g| e - g)
            }
            Quantity::Place => Block::column(k.element::<D>().place(&x).to_vec()),
            Quantity::PhiByData => {
                let lambda: Vec<D> = self.motion.lambda.iter().map(|&l| D::from(l)).collect();
                kernels::d_phi_dp(k, &x, &f, &lambda)
            }
        }
    }
}

impl<K: Constraint> Path<'_, K> {
    /// The column at the state itself.
    pub(super) fn at_zero(&self) -> Block {
        self.at(0.0)
    }
}

fn times<D: Number>(c: &Block<D>, v: &[D]) -> Block<D> {
    let row = |r| {
        c.row(r)
            .iter()
            .zip(v)
            .fold(D::from(0.0), |sum, (&c, &v)| sum + c * v)
    };
    Block::column((0..c.rows()).map(row).collect())
}

fn transpose_times<D: Number>(c: &Block<D>, lambda: &[D]) -> Block<D> {
    let column = |k| (0..c.rows()).fold(D::from(0.0), |sum, r| sum + c.get(r, k) * lambda[r]);
    Block::column((0..c.columns()).map(column).collect())
}

impl<K: Constraint> Check<'_, K> {
    /// All derivatives, by one oracle.
    pub(super) fn derivatives<O: Differentiate>(
        &self,
        Oracle {
            reference,
            tolerance,
            floor,
        }: Oracle,
    ) -> Result<(), Failure> {
        use Quantity as Q;
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let one = &self.case.motions[0];
        let each = |block: &dyn Fn(&Motion) -> Block| self.case.for_each_motion(block);
        let claim = |property, found: Block, expected: Block| {
            let (found, expected) = (&found, &expected);
            self.judge().decide(
                &Claim {
                    property,
                    reference,
                    found,
                    expected,
                    tolerance,
                    floor,
                },
                |row, column| self.entry(property, row, column),
            )
        };
        if K::SPEC.level == Level::Holonomic {
            claim(
                Property::C,
                kernels::c(k, x, f),
                self.jacobian::<O>(Q::Phi, Along::Pose, one),
            )?;
            let phi_t = O::first(&self.curve(Q::Phi, Along::Time, one));
            claim(Property::B, kernels::b(k, x, f), phi_t.map(|e| -e))?;
            claim(
                Property::Velocity,
                each(&|m| self.curve(Q::Velocity, Along::Time, m).at(0.0)),
                each(&|m| O::first(&self.curve(Q::Phi, Along::Motion, m))),
            )?;
            claim(
                Property::GammaFromPhi,
                each(&|m| kernels::gamma(k, x, &m.v, f)),
                each(&|m| O::second(&self.curve(Q::Phi, Along::Motion, m)).map(|e| -e)),
            )?;
        }
        claim(
            Property::Gamma,
            each(&|m| kernels::gamma(k, x, &m.v, f)),
            each(&|m| O::first(&self.curve(Q::Velocity, Along::Motion, m)).map(|e| -e)),
        )?;
        claim(
            Property::DForceDx,
            each(&|m| kernels::d_force_dx(k, x, f, &m.lambda)),
            each(&|m| self.jacobian::<O>(Q::Force, Along::Pose, m)),
        )?;
        claim(
            Property::DResidualDx,
            each(&|m| kernels::d_residual_dx(k, x, &m.v, &m.a, f)),
            each(&|m| self.jacobian::<O>(Q::Residual, Along::Pose, m)),
        )?;
        claim(
            Property::DGammaDv,
            each(&|m| kernels::d_gamma_dv(k, x, &m.v, f)),
            each(&|m| self.jacobian::<O>(Q::Gamma, Along::Twist, m)),
        )?;
        claim(
            Property::DVelocityDx,
            each(&|m| kernels::d_velocity_dx(k, x, &m.v, f)),
            each(&|m| self.jacobian::<O>(Q::Velocity, Along::Pose, m)),
        )
    }

    pub(super) fn curve<'s>(
        &'s self,
        quantity: Quantity,
        along: Along,
        motion: &'s Motion,
    ) -> Path<'s, K> {
        Path {
            check: self,
            motion,
            along,
            quantity,
        }
    }

    /// Derivatives along each degree of freedom, side by side.
    pub(super) fn jacobian<O: Differentiate>(
        &self,
        quantity: Quantity,
        along: fn(usize) -> Along,
        motion: &Motion,
    ) -> Block {
        let column = |c| O::first(&self.curve(quantity, along(c), motion));
        Block::beside(
            &(0..kernels::shape::<K>()[1])
                .map(column)
                .collect::<Vec<_>>(),
        )
    }
}
