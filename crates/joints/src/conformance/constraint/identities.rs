//! Relations between kernels without derivatives: wrench, place, balance of forces, rigid motions,
//! the start.

use super::super::block::Block;
use super::super::case::Case;
use super::super::derivative::DualNumbers;
use super::super::failure::{Claim, Failure, Judge, Property, Reference};
use super::super::kernels;
use super::super::oracle::{DUAL_TOLERANCE, assembled, is_internal, resultant};
use super::super::state::Along;
use super::check::Check;
use super::derivatives::Quantity;
use crate::constraint::Constraint;
use crate::plane::{N_DOF, Pose};
use crate::spec::Level;

/// The case with its poses moved until Φ is about zero, by corrections along one row of C after the
/// other, which need no rank.
fn closed<K: Constraint>(k: &K, case: &Case) -> Case {
    const SWEEPS: usize = 100;
    let mut case = case.clone();
    for _ in 0..SWEEPS {
        if kernels::phi(k, &case.x, &case.f).largest() <= f64::EPSILON * case.size() {
            break;
        }
        for row in 0..K::SPEC.rows.len() {
            let phi = kernels::phi(k, &case.x, &case.f).get(row, 0);
            let c = kernels::c(k, &case.x, &case.f);
            let square: f64 = c.row(row).iter().map(|e| e * e).sum();
            if phi == 0.0 || square == 0.0 {
                continue;
            }
            for (x, c) in case.x.iter_mut().zip(c.row(row).chunks(N_DOF)) {
                let [dx, dy, turn] = [0, 1, 2].map(|dof| -c[dof] * phi / square);
                *x = Pose::new(x.x + dx, x.y + dy, x.angle + turn);
            }
        }
    }
    case
}

impl<K: Constraint> Check<'_, K> {
    /// `F = −C_v`, `T = −C_ω − (place − origin) × F`.
    pub(super) fn wrench(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let c = kernels::c(k, x, f);
        let place = k.place(x);
        let lever = [place[0] - x[0].x, place[1] - x[0].y];
        let mut expected = Block::filled(N_DOF, c.rows(), 0.0);
        for row in 0..c.rows() {
            let force = [-c.get(row, 0), -c.get(row, 1)];
            expected.set(0, row, force[0]);
            expected.set(1, row, force[1]);
            let moment = lever[0] * force[1] - lever[1] * force[0];
            expected.set(2, row, -c.get(row, 2) - moment);
        }
        self.identity(Property::Wrench, &kernels::wrench(k, x, f), &expected)
    }

    /// At most the force of each multiplier, or its torque if it has no force.
    pub(super) fn component(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        if K::SPEC.component.is_none() {
            return Ok(());
        }
        let wrench = kernels::wrench(k, x, f);
        let found = kernels::component(k, x, f);
        let bound = |row| match wrench.get(0, row).hypot(wrench.get(1, row)) {
            0.0 => wrench.get(2, row).abs(),
            force => force,
        };
        // Equal to the value if it is within the bound, otherwise to the bound: the excess is the
        // error.
        let within = |row| {
            let (value, bound): (f64, f64) = (found.get(row, 0), bound(row));
            if value.is_nan() {
                0.0
            } else {
                value.clamp(-bound, bound)
            }
        };
        let expected = Block::column((0..found.rows()).map(within).collect());
        self.identity(Property::Component, &found, &expected)
    }

    /// The place moves with the first body only.
    pub(super) fn place(&self) -> Result<(), Failure> {
        let n = kernels::shape::<K>()[1];
        let (x, motion) = (&self.case.x, &self.case.motions[0]);
        let found = self.jacobian::<DualNumbers>(Quantity::Place, Along::Pose, motion);
        let place = self.constraint.place(x);
        let mut expected = Block::filled(2, n, 0.0);
        expected.set(0, 0, 1.0);
        expected.set(1, 1, 1.0);
        expected.set(0, 2, -(place[1] - x[0].y));
        expected.set(1, 2, place[0] - x[0].x);
        self.identity(Property::Place, &found, &expected)
    }

    /// Only if Φ = 0: otherwise two points that should coincide give the pair of forces a lever
    /// arm.
    pub(super) fn balance(&self) -> Result<(), Failure> {
        if !is_internal(&K::SPEC.common) || K::SPEC.level != Level::Holonomic {
            return Ok(());
        }
        let case = closed(self.constraint, self.case);
        let c = kernels::c(self.constraint, &case.x, &case.f);
        let left = kernels::phi(self.constraint, &case.x, &case.f).norm();
        let sum = |row| resultant(&case.x, c.row(row));
        let claim = Claim {
            property: Property::Balance,
            reference: Reference::Identity,
            found: &Block::beside(&(0..c.rows()).map(sum).collect::<Vec<_>>()),
            expected: &Block::filled(N_DOF, c.rows(), 0.0),
            tolerance: DUAL_TOLERANCE,
            floor: c.largest().max(1.0) * case.size() + left / DUAL_TOLERANCE,
        };
        Judge {
            case: &case,
            ..self.judge()
        }
        .decide(&claim, |row, column| {
            self.entry(Property::Balance, row, column)
        })
    }

    /// Moves all bodies as one.
    pub(super) fn rigid_motion(&self) -> Result<(), Failure> {
        if !is_internal(&K::SPEC.common) {
            return Ok(());
        }
        let (moved, moved_case) = assembled::<K>(&self.case.moved())?;
        let there = Check {
            constraint: &moved,
            case: &moved_case,
        };
        let names = ["Φ", "C", "Γ", "the wrench map", "the component"];
        let norms = |check: &Check<'_, K>| check.invariant_blocks().map(|b| b.norm());
        let (here, there) = (norms(self), norms(&there));
        for (name, (found, expected)) in names.iter().zip(there.into_iter().zip(here)) {
            let (found, expected) = (Block::column(vec![found]), Block::column(vec![expected]));
            let claim = Claim {
                property: Property::RigidMotion,
                reference: Reference::Identity,
                found: &found,
                expected: &expected,
                tolerance: DUAL_TOLERANCE,
                floor: self.scale(),
            };
            self.judge()
                .decide(&claim, |_, _| format!("norm of {name}"))?;
        }
        Ok(())
    }

    fn invariant_blocks(&self) -> [Block; 5] {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let phi = match K::SPEC.level {
            Level::Holonomic => kernels::phi(k, x, f),
            Level::Nonholonomic => Block::column(Vec::new()),
        };
        let gamma = self
            .case
            .motions
            .iter()
            .map(|m| kernels::gamma(k, x, &m.v, f));
        [
            phi,
            kernels::c(k, x, f),
            Block::beside(&gamma.collect::<Vec<_>>()),
            kernels::wrench(k, x, f),
            kernels::component(k, x, f),
        ]
    }

    /// Rows that store an initial value are zero at the start.
    pub(super) fn start(&self) -> Result<(), Failure> {
        let phi = self.phi_at_start();
        let keeps = |row: usize| !K::SPEC.rows[row].restricts_start;
        let kept = |row| if keeps(row) { 0.0 } else { phi.get(row, 0) };
        let expected = Block::column((0..phi.rows()).map(kept).collect());
        self.identity(Property::Start, &phi, &expected)
    }
}
