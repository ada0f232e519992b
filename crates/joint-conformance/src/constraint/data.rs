//! Tests of the values that a constraint stores: reading, setting, and derivatives with respect to
//! these values. The expected derivatives are differences through `set_data`, and dual numbers
//! through the kernels. The dual numbers use the derivatives of the stored values that the
//! constraint returns.

use joints::spec::{DatumShape, Unit};

use super::{Kernel, OfConstraint};
use crate::block::{Block, dot};
use crate::bodies::Bodies;
use crate::case::Motion;
use crate::check::Check;
use crate::derivative::by_differences;
use crate::failure::{Claim, Failure, Oracle, Property};
use crate::number::{Dual, with_slopes};
use crate::state::Along;
use crate::subject::Subject;

/// This number is added to each stored value in turn. No case contains this number by chance.
const ANOTHER: f64 = 0.0625;

/// Each component of a unit vector has the rounding error of a quotient.
const UNIT: f64 = 4.0 * f64::EPSILON;

/// All kernels that depend on the stored values.
const ALL: [Kernel; 6] = [
    Kernel::Phi,
    Kernel::C,
    Kernel::B,
    Kernel::Gamma,
    Kernel::Wrench,
    Kernel::Place,
];

impl<S: Bodies> Check<'_, OfConstraint<S>> {
    /// Performs all tests of the values that the constraint stores.
    pub(super) fn data(&self) -> Result<(), Failure> {
        let numbers = self.numbers();
        self.data_facts(&numbers)?;
        self.data_put_back(&numbers)?;
        if self.case.has_differences() {
            let by_numbers = |kernel| self.each(|m| self.by_data(kernel, &numbers, m));
            let (phi, residual) = (by_numbers(Kernel::Phi), by_numbers(Kernel::Residual));
            self.data_claim(Property::DPhiDp, Oracle::DIFFERENCES, &phi)?;
            self.data_claim(Property::DResidualDp, Oracle::DIFFERENCES, &residual)?;
        }
        let dual = |kernel| self.each(|m| self.by_stored(kernel, m));
        let (phi, residual) = (dual(Kernel::Phi), dual(Kernel::Residual));
        self.data_claim(Property::DPhiDp, Oracle::DUAL_NUMBERS, &phi)?;
        self.data_claim(Property::DResidualDp, Oracle::DUAL_NUMBERS, &residual)
    }

    fn numbers(&self) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.of.spec.n_data()];
        self.made.plain().data(&mut out);
        out
    }

    /// Returns the result of `ask` for the constraint with these stored values.
    fn with_data<T>(&self, numbers: &[f64], ask: impl Fn(&Check<'_, OfConstraint<S>>) -> T) -> T {
        let made = self.made.with_data(numbers);
        ask(&Check {
            made: &made,
            ..*self
        })
    }

    /// Checks that each value belongs to one datum, that all values are listed, and that directions
    /// are unit vectors.
    fn data_facts(&self, numbers: &[f64]) -> Result<(), Failure> {
        let mut next = 0;
        for datum in self.of.spec.data {
            let name = datum.name;
            self.data_fact(&format!("place of `{name}`"), datum.first != next)?;
            next += datum.count;
            let values = &numbers[datum.numbers()];
            let untold = values.iter().any(|x| !x.is_finite());
            self.data_fact(&format!("numbers of `{name}`"), untold)?;
            let unit = match datum.shape {
                DatumShape::Direction { .. } => values,
                DatumShape::Line => &values[2..],
                DatumShape::Plane => &values[3..],
                _ => continue,
            };
            let length = unit.iter().map(|x| x * x).sum::<f64>().sqrt();
            let off = (length - 1.0).abs() > UNIT;
            self.data_fact(&format!("length of the unit vector of `{name}`"), off)?;
        }
        Ok(())
    }

    fn data_fact(&self, entry: &str, wrong: bool) -> Result<(), Failure> {
        if wrong {
            Err(self.fact(Property::Data, entry.to_owned(), [0.0, 1.0]))
        } else {
            Ok(())
        }
    }

    /// Checks that `set_data` restores the values that `data` returns and does not change anything
    /// else.
    fn data_put_back(&self, numbers: &[f64]) -> Result<(), Failure> {
        let same = self.with_data(numbers, bits);
        let changed = bits(self) != same;
        self.data_fact("kernels after `set_data` with unchanged values", changed)?;
        // For axes, and for angles stored by cosine and sine, `set_data` applies the values as
        // changes; it does not store them.
        let is_change = |k: usize| {
            self.of.spec.data.iter().any(|d| {
                let is_kept_angle = d.shape == DatumShape::Kept(Unit::Angle);
                // Angles in space are stored by cosine and sine.
                let turns = is_kept_angle && <S as joints::Space>::DIM > 2;
                d.numbers().contains(&k) && (turns || matches!(d.shape, DatumShape::Axes { .. }))
            })
        };
        for k in (0..numbers.len()).filter(|&k| !is_change(k)) {
            let mut other = numbers.to_vec();
            other[k] += ANOTHER;
            let (told, back) = self.with_data(&other, |check| {
                (check.numbers(), check.with_data(numbers, bits))
            });
            self.data_fact(&format!("number {k}, set and read"), told != other)?;
            self.data_fact(&format!("number {k}, changed and restored"), back != same)?;
        }
        Ok(())
    }

    /// Computes the derivatives of `λᵀ·kernel` with respect to all stored values by differences.
    /// The step of a small value is a fraction of the value. The reason is a kernel that divides by
    /// the value: it has a pole at zero, which must not be inside a step.
    fn by_data(&self, kernel: Kernel, numbers: &[f64], motion: &Motion) -> Block {
        let slope = |number: usize| {
            let unit = match numbers[number].abs() {
                small if small > 0.0 && small < 0.1 => 10.0 * small,
                _ => 1.0,
            };
            let differences = by_differences(|step| {
                let mut numbers = numbers.to_vec();
                numbers[number] += step * unit;
                let rows = self.with_data(&numbers, |check| check.at(kernel, motion));
                Block::column(vec![dot(rows.entries(), &motion.lambda)])
            });
            differences.get(0, 0) / unit
        };
        Block::column((0..numbers.len()).map(slope).collect())
    }

    /// Computes the derivatives of `λᵀ·kernel` with respect to all stored values by dual numbers in
    /// the kernel.
    fn by_stored(&self, kernel: Kernel, motion: &Motion) -> Block {
        let plain = self.made.plain();
        let mut stored = Vec::new();
        plain.stored(&mut stored);
        let n = self.of.spec.n_data();
        let mut slopes = vec![vec![0.0; stored.len()]; n];
        plain.d_stored_dp(&mut |place, number, slope| slopes[number][place] += slope);
        let of_number = |slopes: Vec<f64>| {
            let rows = with_slopes(slopes, || {
                let state = Along::Time.state(self.case, motion, Dual::from(0.0));
                self.of.kernel(self.made, kernel, &state)
            });
            dot(rows.map(|e| e.0.v1).entries(), &motion.lambda)
        };
        Block::column(slopes.into_iter().map(of_number).collect())
    }

    fn data_claim(
        &self,
        property: Property,
        oracle: Oracle,
        expected: &Block,
    ) -> Result<(), Failure> {
        let kernel = match property {
            Property::DPhiDp => Kernel::DPhiDp,
            _ => Kernel::DResidualDp,
        };
        let claim = Claim {
            property,
            oracle,
            found: &self.each(|m| self.at(kernel, m)),
            expected,
        };
        self.decide(&claim, |row, column| {
            let datum = self
                .of
                .spec
                .data
                .iter()
                .find(|d| d.numbers().contains(&row));
            let name = datum.map_or("", |d| d.name);
            let number = datum.map_or(row, |d| row - d.first);
            format!("number {number} of `{name}`, motion {column}")
        })
    }
}

fn bits<S: Bodies>(check: &Check<'_, OfConstraint<S>>) -> Vec<u64> {
    let m = &check.case.motions[0];
    let block = |kernel| check.at(kernel, m).map(f64::to_bits).entries().to_vec();
    ALL.into_iter().flat_map(block).collect()
}
