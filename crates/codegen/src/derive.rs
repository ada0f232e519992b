//! The kernels that follow from a definition; none of them is written by hand for any joint.
//!
//! Holonomic and nonholonomic rows both lead to a velocity row `e = Φ̇` or `e = Ψ·q̇ + ψ`, which is
//! `e = C·v − b`: `C = ∂e/∂v`, `b = −e(v = 0)`, and `Γ = −ė` without the terms in the
//! accelerations.

use proc_macro2::Ident;
use quote::format_ident;
use symbolic::{Derivation, Expr};

use crate::elaborate::{ConstraintBody, Model, Source};
use crate::identity;

/// A sparse block: (row, column) and value.
pub(crate) type Sparse = Vec<([usize; 2], Expr)>;

/// Degrees of freedom of a planar body.
pub(crate) const N_DOF: usize = 3;

/// An entry of C.
pub(crate) struct Entry {
    pub(crate) row: usize,
    pub(crate) column: usize,
    pub(crate) value: Expr,
    pub(crate) constant: bool,
}

/// Kernels of a constraint.
pub(crate) struct ConstraintKernels {
    pub(crate) phi: Vec<Expr>,
    pub(crate) restricts_start: Vec<bool>,
    pub(crate) c: Vec<Entry>,
    /// Empty for scleronomic constraints.
    pub(crate) b: Vec<Expr>,
    pub(crate) gamma: Vec<Expr>,
    pub(crate) wrench: Sparse,
    pub(crate) component: Vec<Expr>,
    pub(crate) place: [Expr; 2],
    pub(crate) d_force_dx: Sparse,
    pub(crate) d_residual_dx: Sparse,
    pub(crate) d_gamma_dv: Sparse,
    pub(crate) d_velocity_dx: Sparse,
    /// One value for each number of the data.
    pub(crate) d_phi_dp: Vec<Expr>,
    pub(crate) d_residual_dp: Vec<Expr>,
}

impl ConstraintKernels {
    /// The unit of the measure that a driven row prescribes: it is an angle if the row does not
    /// depend on the velocities of origins.
    pub(crate) fn unit_of_measure(&self) -> Ident {
        if self.c.iter().all(|e| e.column % N_DOF == N_DOF - 1) {
            format_ident!("Angle")
        } else {
            format_ident!("Length")
        }
    }
}

/// Kernels of a force.
pub(crate) struct ForceKernels {
    pub(crate) q: Vec<(usize, Expr)>,
    pub(crate) dq_dx: Sparse,
    pub(crate) dq_dv: Sparse,
}

/// How a reaction component is computed.
pub(crate) enum Component {
    None,
    /// The component of the force along the body's vector.
    Along,
    /// The force along the measure that this motion moves: `−∂Φ/∂motion` for each multiplier.
    Motion(Expr),
}

/// Derives the kernels of a constraint, or reports which row restricts no motion. Rows of Ψ are
/// linear in velocities, because elaboration refuses others. `data` are the derivations with
/// respect to the numbers that the constraint stores.
pub(crate) fn constraint(
    model: &mut Model,
    body: &ConstraintBody,
    component: &Component,
    data: &[Derivation],
) -> Result<ConstraintKernels, usize> {
    let columns = columns(model);
    let velocity: Vec<Expr> = if body.holonomic {
        body.rows
            .iter()
            .map(|&r| model.time.apply(&mut model.g, r))
            .collect()
    } else {
        body.rows.clone()
    };
    let c = c_block(model, &velocity, columns.len());
    if let Some(row) = (0..velocity.len()).find(|row| c.iter().all(|e| e.row != *row)) {
        return Err(row);
    }
    let b = b_rows(model, &velocity);
    let gamma: Vec<Expr> = velocity
        .iter()
        .map(|&e| {
            let rate = model.time.apply(&mut model.g, e);
            model.g.neg(rate)
        })
        .collect();
    let place = body.place.to_ground(&mut model.g, &model.turns);
    let wrench = wrench(model, &c, place, body.rows.len());
    let component = match component {
        Component::None => Vec::new(),
        Component::Motion(motion) => {
            let along = Derivation::partial(&mut model.g, *motion);
            let rows = body.rows.iter();
            rows.map(|&row| {
                let slope = along.apply(&mut model.g, row);
                model.g.neg(slope)
            })
            .collect()
        }
        Component::Along => {
            let (_, along) = body.component.as_ref().expect("the definition has one");
            let along = along.to_ground(&mut model.g, &model.turns);
            force_along(model, &c, along, body.rows.len())
        }
    };
    let restricts_start = body
        .rows
        .iter()
        .map(|&row| !keeps_start(model, row))
        .collect();
    let residuals = residuals(model, &c, &gamma);
    let d_force_dx = force_derivatives(model, &c, &columns);
    let d_residual_dx = along_columns(model, &residuals, &columns);
    let d_gamma_dv = velocity_derivatives(model, &gamma);
    let d_velocity_dx = along_columns(model, &velocity, &columns);
    let phi = if body.holonomic {
        body.rows.clone()
    } else {
        Vec::new()
    };
    let d_phi_dp = gradient(model, &phi, data);
    let d_residual_dp = gradient(model, &residuals, data);
    Ok(ConstraintKernels {
        phi,
        restricts_start,
        c,
        b,
        gamma,
        wrench,
        component,
        place,
        d_force_dx,
        d_residual_dx,
        d_gamma_dv,
        d_velocity_dx,
        d_phi_dp,
        d_residual_dp,
    })
}

/// Derives the kernels of a force: `Q = Σ law·∂coordinate/∂x`.
pub(crate) fn force(model: &mut Model, terms: &[(Expr, Expr)]) -> ForceKernels {
    let columns = columns(model);
    let mut q: Vec<(usize, Expr)> = columns
        .iter()
        .enumerate()
        .map(|(k, along)| {
            let parts: Vec<(f64, Expr)> = terms
                .iter()
                .map(|&(law, coordinate)| {
                    let lever = along.apply(&mut model.g, coordinate);
                    (1.0, model.g.mul(law, lever))
                })
                .collect();
            (k, model.g.sum(&parts))
        })
        .collect();
    q.retain(|(_, e)| !identity::is_zero(&model.g, &model.inputs, *e));
    let mut dq_dx = Vec::new();
    for &(row, e) in &q {
        for (column, along) in columns.iter().enumerate() {
            push(&mut dq_dx, model, row, column, |m| along.apply(&mut m.g, e));
        }
    }
    let rows: Vec<Expr> = q.iter().map(|(_, e)| *e).collect();
    let mut dq_dv = velocity_derivatives(model, &rows);
    for (at, _) in &mut dq_dv {
        at[0] = q[at[0]].0;
    }
    ForceKernels { q, dq_dx, dq_dv }
}

/// The derivation along each degree of freedom of each slot.
fn columns(model: &mut Model) -> Vec<Derivation> {
    (0..model.inputs.slots.len() * N_DOF)
        .map(|k| model.inputs.along_dof(&mut model.g, k / N_DOF, k % N_DOF))
        .collect()
}

fn c_block(model: &mut Model, velocity: &[Expr], n: usize) -> Vec<Entry> {
    let mut c = Vec::new();
    for (row, &e) in velocity.iter().enumerate() {
        for column in 0..n {
            let v = model.inputs.slots[column / N_DOF].twist[column % N_DOF];
            let value = Derivation::partial(&mut model.g, v).apply(&mut model.g, e);
            if !identity::is_zero(&model.g, &model.inputs, value) {
                let varies =
                    |s: &Source| matches!(s, Source::Pose { .. } | Source::Function { .. });
                let constant = !model.depends_on(value, varies);
                c.push(Entry {
                    row,
                    column,
                    value,
                    constant,
                });
            }
        }
    }
    c
}

fn b_rows(model: &mut Model, velocity: &[Expr]) -> Vec<Expr> {
    let zero = model.g.number(0.0);
    let at_rest: Vec<(Expr, Expr)> = model
        .inputs
        .slots
        .iter()
        .flat_map(|s| s.twist.map(|v| (v, zero)))
        .collect();
    let b: Vec<Expr> = velocity
        .iter()
        .map(|&e| {
            let drift = model.g.substitute(e, &at_rest);
            model.g.neg(drift)
        })
        .collect();
    if b.iter().all(|&e| model.g.is_zero(e)) {
        Vec::new()
    } else {
        b
    }
}

/// `[Fx, Fy, T]` on the first body about the place, for each multiplier: the force is `−C_vᵀ`; the
/// torque is `−C_ωᵀ` at the mass centre, transferred to the place with the arm from the body's
/// origin.
fn wrench(model: &mut Model, c: &[Entry], place: [Expr; 2], rows: usize) -> Sparse {
    let [x, y, ..] = model.inputs.slots[0].pose;
    let lever = [model.g.sub(place[0], x), model.g.sub(place[1], y)];
    let mut map = Vec::new();
    for component in 0..N_DOF {
        for row in 0..rows {
            push(&mut map, model, component, row, |m| {
                let [cx, cy, cw] = [0, 1, 2].map(|k| entry(m, c, row, k));
                match component {
                    0 => m.g.neg(cx),
                    1 => m.g.neg(cy),
                    _ => {
                        let (a, b) = (m.g.mul(lever[0], cy), m.g.mul(lever[1], cx));
                        m.g.sum(&[(1.0, a), (-1.0, b), (-1.0, cw)])
                    }
                }
            });
        }
    }
    map
}

/// Coefficients of the component along a vector of the force on the first body.
fn force_along(model: &mut Model, c: &[Entry], along: [Expr; 2], rows: usize) -> Vec<Expr> {
    (0..rows)
        .map(|row| {
            let [cx, cy] = [0, 1].map(|k| entry(model, c, row, k));
            let (x, y) = (model.g.mul(cx, along[0]), model.g.mul(cy, along[1]));
            model.g.sum(&[(-1.0, x), (-1.0, y)])
        })
        .collect()
}

fn entry(model: &mut Model, c: &[Entry], row: usize, column: usize) -> Expr {
    match c.iter().find(|e| e.row == row && e.column == column) {
        Some(e) => e.value,
        None => model.g.number(0.0),
    }
}

/// Whether a row contains a value kept from the start; such a row is satisfied at any start and
/// does not restrict it.
fn keeps_start(model: &Model, row: Expr) -> bool {
    model.depends_on(row, |s| match s {
        Source::Kept { field, .. } => {
            field == "measure_0" || model.kept.iter().any(|k| k.field == *field && k.of_start)
        }
        _ => false,
    })
}

/// `∂(Cᵀλ)/∂x`
fn force_derivatives(model: &mut Model, c: &[Entry], columns: &[Derivation]) -> Sparse {
    let forces: Vec<Expr> = (0..columns.len())
        .map(|column| {
            let terms: Vec<(f64, Expr)> = c
                .iter()
                .filter(|e| e.column == column)
                .map(|e| (1.0, model.g.mul(e.value, model.inputs.lambda[e.row])))
                .collect();
            model.g.sum(&terms)
        })
        .collect();
    along_columns(model, &forces, columns)
}

/// `C·a − Γ`, row by row.
fn residuals(model: &mut Model, c: &[Entry], gamma: &[Expr]) -> Vec<Expr> {
    gamma
        .iter()
        .enumerate()
        .map(|(row, &gamma)| {
            let mut terms: Vec<(f64, Expr)> = c
                .iter()
                .filter(|e| e.row == row)
                .map(|e| {
                    let a = model.inputs.slots[e.column / N_DOF].acceleration[e.column % N_DOF];
                    (1.0, model.g.mul(e.value, a))
                })
                .collect();
            terms.push((-1.0, gamma));
            model.g.sum(&terms)
        })
        .collect()
}

/// `∂(λᵀ·rows)/∂p` for each number p of the data.
fn gradient(model: &mut Model, rows: &[Expr], data: &[Derivation]) -> Vec<Expr> {
    let terms: Vec<(f64, Expr)> = rows
        .iter()
        .enumerate()
        .map(|(row, &e)| (1.0, model.g.mul(model.inputs.lambda[row], e)))
        .collect();
    let sum = model.g.sum(&terms);
    data.iter()
        .map(|along| {
            let slope = along.apply(&mut model.g, sum);
            if identity::is_zero(&model.g, &model.inputs, slope) {
                model.g.number(0.0)
            } else {
                slope
            }
        })
        .collect()
}

/// Derivatives of `rows` along each degree of freedom.
fn along_columns(model: &mut Model, rows: &[Expr], columns: &[Derivation]) -> Sparse {
    let mut out = Vec::new();
    for (row, &e) in rows.iter().enumerate() {
        for (column, along) in columns.iter().enumerate() {
            push(&mut out, model, row, column, |m| along.apply(&mut m.g, e));
        }
    }
    out
}

/// Partial derivatives of `rows` with respect to the velocities.
fn velocity_derivatives(model: &mut Model, rows: &[Expr]) -> Sparse {
    let mut out = Vec::new();
    for (row, &e) in rows.iter().enumerate() {
        for column in 0..model.inputs.slots.len() * N_DOF {
            let v = model.inputs.slots[column / N_DOF].twist[column % N_DOF];
            push(&mut out, model, row, column, |m| {
                Derivation::partial(&mut m.g, v).apply(&mut m.g, e)
            });
        }
    }
    out
}

fn push(
    out: &mut Sparse,
    model: &mut Model,
    row: usize,
    column: usize,
    value: impl FnOnce(&mut Model) -> Expr,
) {
    let value = value(model);
    if !identity::is_zero(&model.g, &model.inputs, value) {
        out.push(([row, column], value));
    }
}

#[cfg(test)]
mod tests;
