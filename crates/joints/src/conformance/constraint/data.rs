//! The numbers stored by a constraint: reading and setting them, and derivatives with respect to
//! them. Fields are plain numbers, so dual numbers cannot be used for them: the references are
//! differences through `set_data`, and, for the second kernel, dual numbers through the poses of
//! the first.

use super::super::block::Block;
use super::super::case::Motion;
use super::super::derivative::{Differentiate, DualNumbers, by_differences};
use super::super::failure::{Claim, Failure, Property, fact};
use super::super::kernels;
use super::super::oracle::{DIFFERENCES, DUAL_NUMBERS, Oracle};
use super::super::state::Along;
use super::check::Check;
use super::derivatives::Quantity;
use crate::constraint::Constraint;
use crate::spec::{DatumShape, Level};

/// Added to each number in turn; differs from every number that a case draws.
const ANOTHER: f64 = 0.0625;

/// Components of unit vectors have the round-off of a quotient each.
const UNIT: f64 = 4.0 * f64::EPSILON;

impl<K: Constraint> Check<'_, K> {
    /// `data` returns the numbers named in the specification, `set_data` sets them, and nothing
    /// else changes.
    pub(super) fn data(&self) -> Result<(), Failure> {
        let numbers = kernels::data(self.constraint);
        let n = numbers.len();
        self.data_facts(&numbers)?;
        let mut same = self.constraint.clone();
        same.set_data(&numbers);
        let changed = bits(&self.all_blocks(self.constraint)) != bits(&self.all_blocks(&same));
        self.data_fact("kernels after `set_data` of the same numbers", changed)?;
        for k in 0..n {
            let mut other = numbers.clone();
            other[k] += ANOTHER;
            let mut constraint = self.constraint.clone();
            constraint.set_data(&other);
            let told = kernels::data(&constraint);
            self.data_fact(&format!("number {k}, set and told"), told != other)?;
            constraint.set_data(&numbers);
            let changed = bits(&self.all_blocks(&constraint)) != bits(&self.all_blocks(&same));
            self.data_fact(&format!("number {k}, changed and put back"), changed)?;
        }
        Ok(())
    }

    /// Each number belongs to one datum, all of them are listed, and directions are unit vectors.
    fn data_facts(&self, numbers: &[f64]) -> Result<(), Failure> {
        let mut next = 0;
        for datum in K::SPEC.data {
            let name = datum.name;
            self.data_fact(&format!("place of `{name}`"), datum.first != next)?;
            next += datum.shape.count();
            let values = &numbers[datum.numbers()];
            let untold = values.iter().any(|x| !x.is_finite());
            self.data_fact(&format!("numbers of `{name}`"), untold)?;
            let unit = match datum.shape {
                DatumShape::Direction { .. } => values,
                DatumShape::Line => &values[2..],
                _ => continue,
            };
            let off = (unit[0].hypot(unit[1]) - 1.0).abs() > UNIT;
            self.data_fact(&format!("length of the unit vector of `{name}`"), off)?;
        }
        Ok(())
    }

    fn data_fact(&self, entry: &str, wrong: bool) -> Result<(), Failure> {
        if wrong {
            Err(fact(
                K::SPEC.common.name,
                Property::Data,
                entry.to_owned(),
                [0.0, 1.0],
                Some(self.case),
            ))
        } else {
            Ok(())
        }
    }

    /// All blocks that depend on the numbers.
    fn all_blocks(&self, k: &K) -> Vec<Block> {
        let (x, f, m) = (&self.case.x, &self.case.f, &self.case.motions[0]);
        let phi = match K::SPEC.level {
            Level::Holonomic => kernels::phi(k, x, f),
            Level::Nonholonomic => Block::column(Vec::new()),
        };
        vec![
            phi,
            kernels::c(k, x, f),
            kernels::b(k, x, f),
            kernels::gamma(k, x, &m.v, f),
            kernels::wrench(k, x, f),
            Block::column(k.place(x).to_vec()),
        ]
    }

    /// `∂(λᵀ·Φ)/∂p` and `∂(λᵀ·(C·a − Γ))/∂p` by differences.
    pub(super) fn data_differences(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let each = |block: &dyn Fn(&Motion) -> Block| self.case.for_each_motion(block);
        self.data_claim(
            Property::DPhiDp,
            DIFFERENCES,
            &each(&|m| kernels::d_phi_dp(k, x, f, &m.lambda)),
            &each(&|m| self.by_data(Quantity::Phi, m)),
        )?;
        self.data_claim(
            Property::DResidualDp,
            DIFFERENCES,
            &each(&|m| kernels::d_residual_dp(k, x, m, f)),
            &each(&|m| self.by_data(Quantity::Residual, m)),
        )
    }

    /// `∂(λᵀ·(C·a − Γ))/∂p` of holonomic constraints from `g = ∂(λᵀ·Φ)/∂p`: `C·a − Γ` is the change
    /// of Φ along a, bodies only, and its second derivative along `x + τv` and `t + τ`, so the same
    /// holds for g.
    pub(super) fn data_dual_numbers(&self) -> Result<(), Failure> {
        if K::SPEC.level != Level::Holonomic {
            return Ok(());
        }
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let expected = |m: &Motion| {
            let by_pose = self.jacobian::<DualNumbers>(Quantity::PhiByData, Along::Pose, m);
            let a: Vec<f64> = m.a.iter().flat_map(|a| [a.x, a.y, a.omega]).collect();
            let along_a = |row| by_pose.row(row).iter().zip(&a).map(|(g, a)| g * a).sum();
            let along_a = Block::column((0..by_pose.rows()).map(along_a).collect());
            let along_v = self.curve(Quantity::PhiByData, Along::Motion, m);
            along_a.zip(&DualNumbers::second(&along_v), |a, v| a + v)
        };
        self.data_claim(
            Property::DResidualDp,
            DUAL_NUMBERS,
            &self
                .case
                .for_each_motion(|m| kernels::d_residual_dp(k, x, m, f)),
            &self.case.for_each_motion(expected),
        )
    }

    /// The derivatives of `λᵀ·quantity` with respect to all numbers.
    fn by_data(&self, quantity: Quantity, motion: &Motion) -> Block {
        let numbers = kernels::data(self.constraint);
        let slope = |number: usize| {
            let differences = by_differences(|step| {
                let mut numbers = numbers.clone();
                numbers[number] += step;
                let mut constraint = self.constraint.clone();
                constraint.set_data(&numbers);
                let there = Check {
                    constraint: &constraint,
                    case: self.case,
                };
                let rows = match (quantity, K::SPEC.level) {
                    (Quantity::Phi, Level::Nonholonomic) => Block::filled(1, 1, 0.0),
                    _ => there.curve(quantity, Along::Time, motion).at_zero(),
                };
                let terms = rows.entries().iter().zip(&motion.lambda);
                Block::column(vec![terms.map(|(e, l)| e * l).sum()])
            });
            differences.get(0, 0)
        };
        Block::column((0..numbers.len()).map(slope).collect())
    }

    fn data_claim(
        &self,
        property: Property,
        oracle: Oracle,
        found: &Block,
        expected: &Block,
    ) -> Result<(), Failure> {
        let claim = Claim {
            property,
            reference: oracle.reference,
            found,
            expected,
            tolerance: oracle.tolerance,
            floor: oracle.floor,
        };
        self.judge().decide(&claim, |row, column| {
            let datum = K::SPEC.data.iter().find(|d| d.numbers().contains(&row));
            let name = datum.map_or("", |d| d.name);
            let number = datum.map_or(row, |d| row - d.first);
            format!("number {number} of `{name}`, motion {column}")
        })
    }
}

fn bits(blocks: &[Block]) -> Vec<u64> {
    let entries = blocks.iter().flat_map(|b| b.entries());
    entries.map(|e| e.to_bits()).collect()
}
