//! One case of one constraint, with the names and comparisons of its entries.

use super::super::block::Block;
use super::super::case::Case;
use super::super::failure::{Claim, Failure, Judge, Property, Reference};
use super::super::kernels;
use super::super::oracle::{DUAL_TOLERANCE, column_name};
use crate::constraint::Constraint;
use crate::spec::Level;

/// One case of one definition.
pub(in super::super) struct Check<'a, K> {
    pub(in super::super) constraint: &'a K,
    pub(in super::super) case: &'a Case,
}

impl<K: Constraint> Check<'_, K> {
    pub(in super::super) fn judge(&self) -> Judge<'_> {
        Judge {
            definition: K::SPEC.common.name,
            case: self.case,
        }
    }

    /// Description of an entry.
    pub(in super::super) fn entry(&self, property: Property, row: usize, column: usize) -> String {
        let n = kernels::shape::<K>()[1];
        let row_name = |row: usize| format!("row `{}`", K::SPEC.rows[row].name);
        let dof = |column: usize| column_name(K::SPEC.common.slots, column % n);
        match property {
            Property::C => format!("{}, column {}", row_name(row), dof(column)),
            Property::DForceDx => {
                format!(
                    "row {}, column {}, multipliers {}",
                    dof(row),
                    dof(column),
                    column / n
                )
            }
            Property::DResidualDx | Property::DGammaDv | Property::DVelocityDx => {
                format!(
                    "{}, column {}, motion {}",
                    row_name(row),
                    dof(column),
                    column / n
                )
            }
            Property::Velocity | Property::Gamma | Property::GammaFromPhi => {
                format!("{}, motion {column}", row_name(row))
            }
            Property::Wrench => format!("{}, {}", ["Fx", "Fy", "T"][row], row_name(column)),
            Property::Balance => {
                format!("sum of {}, {}", ["Fx", "Fy", "T"][row], row_name(column))
            }
            Property::Place => format!("{}, column {}", ["x", "y"][row], dof(column)),
            _ => row_name(row),
        }
    }

    /// Checks equality up to the effect of an error of the coordinates.
    pub(in super::super) fn identity(
        &self,
        property: Property,
        found: &Block,
        expected: &Block,
    ) -> Result<(), Failure> {
        let claim = Claim {
            property,
            reference: Reference::Identity,
            found,
            expected,
            tolerance: DUAL_TOLERANCE,
            floor: self.scale(),
        };
        self.judge()
            .decide(&claim, |row, column| self.entry(property, row, column))
    }

    /// Effect of a relative error of 1 in the coordinates on Φ, and on C, whose rows have the size
    /// of about one length.
    pub(in super::super) fn scale(&self) -> f64 {
        let c = kernels::c(self.constraint, &self.case.x, &self.case.f);
        c.largest().max(1.0) * self.case.size()
    }

    pub(in super::super) fn phi_at_start(&self) -> Block {
        match K::SPEC.level {
            Level::Holonomic => {
                let f = vec![[0.0; 3]; self.case.f.len()];
                kernels::phi(self.constraint, &self.case.start, &f)
            }
            Level::Nonholonomic => Block::filled(K::SPEC.rows.len(), 1, 0.0),
        }
    }
}
