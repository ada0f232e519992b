//! The properties of one constraint definition.

mod data;
mod derivatives;
mod identities;

use super::block::Block;
use super::case::{Case, Kind};
use super::derivative::{Differences, DualNumbers};
use super::failure::{Claim, Failure, Judge, Property, Reference, fact};
use super::kernels;
use super::pattern::Pattern;
use super::{DIFFERENCES, DUAL_NUMBERS, DUAL_TOLERANCE, assembled, column_name};
use crate::constraint::Constraint;
use crate::plane::N_DOF;
use crate::spec::{Level, Row};

/// All cases of one definition.
pub(super) fn check<K: Constraint>(seed: u64) -> Result<(), Failure> {
    let definition = K::SPEC.common.name;
    let [m, n] = kernels::shape::<K>();
    let pattern = |block, shape, entries| Pattern::new(definition, block, shape, entries);
    let mut patterns = [
        pattern("C", [m, n], kernels::c_pattern::<K>())?,
        pattern("the wrench map", [N_DOF, m], K::SPEC.wrench.to_vec())?,
        pattern("∂(Cᵀλ)/∂x", [n, n], K::SPEC.d_force_dx.to_vec())?,
        pattern("∂(C·a − Γ)/∂x", [m, n], K::SPEC.d_residual_dx.to_vec())?,
        pattern("∂Γ/∂v", [m, n], K::SPEC.d_gamma_dv.to_vec())?,
        pattern("∂(C·v − b)/∂x", [m, n], K::SPEC.d_velocity_dx.to_vec())?,
    ];
    let mut restricts = vec![false; m];
    let mut depends_on_time = false;
    for case in Case::all(seed, &K::SPEC.common, m) {
        let (constraint, case) = assembled::<K>(&case)?;
        let check = Check {
            constraint: &constraint,
            case: &case,
        };
        check.all()?;
        for (pattern, block) in patterns.iter_mut().zip(check.sparse_blocks()) {
            pattern.see(&block);
        }
        depends_on_time |= kernels::b(&constraint, &case.x, &case.f).largest() > 0.0;
        let at_start = check.phi_at_start();
        for (seen, phi) in restricts.iter_mut().zip(at_start.entries()) {
            *seen |= phi.abs() > DUAL_TOLERANCE;
        }
    }
    patterns.iter().try_for_each(|p| p.all_alive(definition))?;
    if depends_on_time != K::SPEC.rheonomic {
        let entry = "`rheonomic` of the spec against b".to_owned();
        let facts = [K::SPEC.rheonomic, depends_on_time].map(f64::from);
        return Err(fact(definition, Property::B, entry, facts, None));
    }
    let idle = |(row, seen): &(&Row, &bool)| row.restricts_start && !**seen;
    match K::SPEC.rows.iter().zip(&restricts).find(idle) {
        Some((row, _)) if K::SPEC.level == Level::Holonomic => {
            let entry = format!("row `{}`, zero at every start", row.name);
            Err(fact(definition, Property::Start, entry, [0.0, 1.0], None))
        }
        _ => Ok(()),
    }
}

/// One case of one definition.
struct Check<'a, K> {
    constraint: &'a K,
    case: &'a Case,
}

impl<K: Constraint> Check<'_, K> {
    fn all(&self) -> Result<(), Failure> {
        self.writes()?;
        self.derivatives::<DualNumbers>(DUAL_NUMBERS)?;
        self.data()?;
        if self.case.has_differences() {
            self.derivatives::<Differences>(DIFFERENCES)?;
            self.data_differences()?;
        }
        self.data_dual_numbers()?;
        self.wrench()?;
        self.place()?;
        self.component()?;
        self.start()?;
        if self.case.kind == Kind::Ordinary {
            self.balance()?;
            self.rigid_motion()?;
        }
        Ok(())
    }

    fn judge(&self) -> Judge<'_> {
        Judge {
            definition: K::SPEC.common.name,
            case: self.case,
        }
    }

    /// The entry in words.
    fn entry(&self, property: Property, row: usize, column: usize) -> String {
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

    fn writes(&self) -> Result<(), Failure> {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let mut constant = vec![f64::NAN; K::SPEC.c.len()];
        k.c_constant(&mut constant);
        let mut varying = vec![f64::NAN; K::SPEC.c.len()];
        k.c(x, f, &mut varying);
        let mut b = vec![f64::NAN; K::SPEC.rows.len()];
        k.b(x, f, &mut b);
        let entries = K::SPEC.c.iter().zip(constant.iter().zip(&varying));
        let c = entries.flat_map(|(e, (c, v))| {
            let name = self.entry(Property::C, e.row, N_DOF * e.slot + e.dof);
            [
                (format!("c_constant, {name}"), !c.is_nan(), e.constant),
                (format!("c, {name}"), !v.is_nan(), !e.constant),
            ]
        });
        let b = b.iter().enumerate().map(|(row, b)| {
            (
                format!("b, {}", self.entry(Property::B, row, 0)),
                !b.is_nan(),
                K::SPEC.rheonomic,
            )
        });
        match c.chain(b).find(|(_, written, due)| written != due) {
            Some((entry, written, due)) => {
                let facts = [written, due].map(f64::from);
                Err(fact(
                    K::SPEC.common.name,
                    Property::Writes,
                    entry,
                    facts,
                    Some(self.case),
                ))
            }
            None => Ok(()),
        }
    }

    /// Equality up to what an error of the coordinates can do.
    fn identity(&self, property: Property, found: &Block, expected: &Block) -> Result<(), Failure> {
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

    /// What a relative error of 1 in the coordinates does to Φ and, the rows of C having a size of
    /// about one length, to C.
    fn scale(&self) -> f64 {
        let c = kernels::c(self.constraint, &self.case.x, &self.case.f);
        c.largest().max(1.0) * self.case.size()
    }

    fn phi_at_start(&self) -> Block {
        match K::SPEC.level {
            Level::Holonomic => {
                let f = vec![[0.0; 3]; self.case.f.len()];
                kernels::phi(self.constraint, &self.case.start, &f)
            }
            Level::Nonholonomic => Block::filled(K::SPEC.rows.len(), 1, 0.0),
        }
    }

    /// Blocks in the order of their patterns in [`check`].
    fn sparse_blocks(&self) -> [Block; 6] {
        let (k, x, f) = (self.constraint, &self.case.x, &self.case.f);
        let m = &self.case.motions[0];
        [
            kernels::c(k, x, f),
            kernels::wrench(k, x, f),
            kernels::d_force_dx(k, x, f, &m.lambda),
            kernels::d_residual_dx(k, x, &m.v, &m.a, f),
            kernels::d_gamma_dv(k, x, &m.v, f),
            kernels::d_velocity_dx(k, x, &m.v, f),
        ]
    }
}
