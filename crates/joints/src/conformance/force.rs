//! The properties of one force definition.

use super::block::Block;
use super::case::{Case, Kind, Motion};
use super::derivative::{Curve, Differences, Differentiate, DualNumbers};
use super::failure::{Claim, Failure, Judge, Property, Reference, fact};
use super::kernels;
use super::number::Number;
use super::oracle::{
    DIFFERENCES, DUAL_NUMBERS, DUAL_TOLERANCE, Oracle, assembled_force, column_name, is_internal,
    resultant,
};
use super::pattern::Pattern;
use super::state::{Along, State};
use crate::force::Force;
use crate::plane::{N_DOF, Twist};

/// Checks all cases of one definition.
pub(super) fn check<K: Force>(seed: u64) -> Result<(), Failure> {
    let spec = &K::SPEC;
    let definition = spec.common.name;
    let n = N_DOF * spec.common.slots.len();
    let q = spec.q.iter().map(|&row| [row, 0]).collect();
    let mut patterns = [
        Pattern::new(definition, "Q", [n, 1], q)?,
        Pattern::new(definition, "∂Q/∂x", [n, n], spec.dq_dx.to_vec())?,
        Pattern::new(definition, "∂Q/∂v", [n, n], spec.dq_dv.to_vec())?,
    ];
    if spec.dissipative == spec.dq_dv.is_empty() {
        let entry = "`dissipative` of the spec against the pattern of ∂Q/∂v".to_owned();
        let facts = [spec.dissipative, !spec.dq_dv.is_empty()].map(f64::from);
        return Err(fact(definition, Property::DqDv, entry, facts, None));
    }
    for case in Case::all(seed, &spec.common, 0) {
        let (force, case) = assembled_force::<K>(&case)?;
        let check = Check {
            force: &force,
            case: &case,
        };
        check.all()?;
        let m = &case.motions[0];
        patterns[0].see(&kernels::q(&force, &case.x, &m.v, &case.f));
        patterns[1].see(&kernels::dq_dx(&force, &case.x, &m.v, &case.f));
        patterns[2].see(&kernels::dq_dv(&force, &case.x, &m.v, &case.f));
    }
    patterns.iter().try_for_each(|p| p.all_alive(definition))
}

/// Q along a curve.
struct Path<'a, K> {
    check: &'a Check<'a, K>,
    motion: &'a Motion,
    along: Along,
}

impl<K: Force> Curve for Path<'_, K> {
    fn at<D: Number>(&self, tau: D) -> Block<D> {
        let State { x, v, f } = self.along.state(self.check.case, self.motion, tau);
        kernels::q(self.check.force, &x, &v, &f)
    }
}

/// One case of one definition.
struct Check<'a, K> {
    force: &'a K,
    case: &'a Case,
}

impl<K: Force> Check<'_, K> {
    fn all(&self) -> Result<(), Failure> {
        self.derivatives::<DualNumbers>(DUAL_NUMBERS)?;
        if self.case.has_differences() {
            self.derivatives::<Differences>(DIFFERENCES)?;
        }
        if is_internal(&K::SPEC.common) {
            self.balance()?;
            if self.case.kind == Kind::Ordinary {
                self.rigid_motion()?;
            }
        }
        self.dissipation()
    }

    fn derivatives<O: Differentiate>(
        &self,
        Oracle {
            reference,
            tolerance,
            floor,
        }: Oracle,
    ) -> Result<(), Failure> {
        let (k, x, f) = (self.force, &self.case.x, &self.case.f);
        let n = N_DOF * K::SPEC.common.slots.len();
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
                |row, column| {
                    let [row, dof] =
                        [row, column % n].map(|c| column_name(K::SPEC.common.slots, c));
                    format!("row {row}, column {dof}, motion {}", column / n)
                },
            )
        };
        claim(
            Property::DqDx,
            each(&|m| kernels::dq_dx(k, x, &m.v, f)),
            each(&|m| self.jacobian::<O>(Along::Pose, m)),
        )?;
        claim(
            Property::DqDv,
            each(&|m| kernels::dq_dv(k, x, &m.v, f)),
            each(&|m| self.jacobian::<O>(Along::Twist, m)),
        )
    }

    /// Derivatives of Q along each degree of freedom, side by side.
    fn jacobian<O: Differentiate>(&self, along: fn(usize) -> Along, motion: &Motion) -> Block {
        let column = |c| {
            O::first(&Path {
                check: self,
                motion,
                along: along(c),
            })
        };
        let n = N_DOF * K::SPEC.common.slots.len();
        Block::beside(&(0..n).map(column).collect::<Vec<_>>())
    }

    fn judge(&self) -> Judge<'_> {
        Judge {
            definition: K::SPEC.common.name,
            case: self.case,
        }
    }

    fn balance(&self) -> Result<(), Failure> {
        let x = &self.case.x;
        for m in &self.case.motions {
            let q = kernels::q(self.force, x, &m.v, &self.case.f);
            let claim = Claim {
                property: Property::Balance,
                reference: Reference::Identity,
                found: &resultant(x, q.entries()),
                expected: &Block::filled(N_DOF, 1, 0.0),
                tolerance: DUAL_TOLERANCE,
                floor: q.largest() * self.case.size(),
            };
            self.judge().decide(&claim, |row, _| {
                format!("sum of {}", ["Fx", "Fy", "T"][row])
            })?;
        }
        Ok(())
    }

    fn rigid_motion(&self) -> Result<(), Failure> {
        let (moved, case) = assembled_force::<K>(&self.case.moved())?;
        let norms = |force: &K, case: &Case| {
            let norm = |m: &Motion| kernels::q(force, &case.x, &m.v, &case.f).norm();
            Block::column(case.motions.iter().map(norm).collect())
        };
        let (here, there) = (norms(self.force, self.case), norms(&moved, &case));
        // An error of the coordinates changes Q by ∂Q/∂x.
        let slope = kernels::dq_dx(
            self.force,
            &self.case.x,
            &self.case.motions[0].v,
            &self.case.f,
        );
        let claim = Claim {
            property: Property::RigidMotion,
            reference: Reference::Identity,
            found: &there,
            expected: &here,
            tolerance: DUAL_TOLERANCE,
            floor: slope.largest().max(1.0) * self.case.size(),
        };
        self.judge()
            .decide(&claim, |row, _| format!("norm of Q, motion {row}"))
    }

    /// `(Q(v) − Q(0))·v ≤ 0`, and `wᵀ·∂Q/∂v·w ≤ 0`.
    fn dissipation(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.force, &self.case.x, &self.case.f);
        let rest = vec![Twist::zero(); x.len()];
        let still = kernels::q(k, x, &rest, f);
        for m in &self.case.motions {
            let v: Vec<f64> = m.v.iter().flat_map(|v| [v.x, v.y, v.omega]).collect();
            let a: Vec<f64> = m.a.iter().flat_map(|a| [a.x, a.y, a.omega]).collect();
            let q = kernels::q(k, x, &m.v, f);
            let power = dot(q.zip(&still, |q, s| q - s).entries(), &v);
            let slope = kernels::dq_dv(k, x, &m.v, f);
            let rows: Vec<f64> = (0..slope.rows()).map(|r| dot(slope.row(r), &a)).collect();
            let found = Block::column(vec![power, dot(&rows, &a)]);
            let expected = found.map(|e| e.min(0.0));
            let forces = q.largest() + still.largest() + slope.largest();
            let claim = Claim {
                property: Property::Dissipation,
                reference: Reference::Identity,
                found: &found,
                expected: &expected,
                tolerance: DUAL_TOLERANCE,
                floor: forces * (dot(&v, &v) + dot(&a, &a) + 1.0),
            };
            let names = ["power of the velocity terms", "curvature of the power"];
            self.judge()
                .decide(&claim, |row, _| names[row].to_owned())?;
        }
        Ok(())
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
