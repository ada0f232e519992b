//! The properties of one constraint definition.

mod check;
mod data;
mod derivatives;
mod identities;

use super::block::Block;
use super::case::{Case, Kind};
use super::derivative::{Differences, DualNumbers};
use super::failure::{Failure, Property, fact};
use super::kernels;
use super::oracle::{DIFFERENCES, DUAL_NUMBERS, DUAL_TOLERANCE, assembled};
use super::pattern::Pattern;
use crate::constraint::Constraint;
use crate::plane::N_DOF;
use crate::spec::{Level, Row};
use check::Check;

/// Checks all cases of one definition.
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
