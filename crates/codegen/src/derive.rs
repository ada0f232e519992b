//! The kernels that are derived from a definition; no kernel is written by hand for any joint.
//!
//! Holonomic and nonholonomic rows both lead to a velocity row `e = Φ̇` or `e = Ψ·q̇ + ψ`. The row
//! has the form `e = C·v − b`, where `C = ∂e/∂v` and `b = −e(v = 0)`. `Γ` is `−ė` without the
//! acceleration terms.

use std::ops::Range;

use proc_macro2::Ident;
use quote::format_ident;
use symbolic::Expr;

use crate::defined::Along;
use crate::elaborate::{ConstraintBody, Model, Source};
use crate::identity;
use crate::space::Space;
use crate::vector::{Components, Frame, Vector, cross, dot};

/// A sparse block: (row, column) and value.
pub(crate) type Sparse = Vec<([usize; 2], Expr)>;

/// An entry of C.
pub(crate) struct Entry {
    pub(crate) row: usize,
    pub(crate) column: usize,
    pub(crate) value: Expr,
    pub(crate) constant: bool,
}

/// Kernels of a constraint.
pub(crate) struct ConstraintKernels {
    /// The values of Φ, one for each holonomic row.
    pub(crate) phi: Vec<Expr>,
    pub(crate) restricts_start: Vec<bool>,
    pub(crate) c: Vec<Entry>,
    /// The entries of b; the list is empty for scleronomic constraints.
    pub(crate) b: Vec<Expr>,
    pub(crate) gamma: Vec<Expr>,
    pub(crate) wrench: Sparse,
    pub(crate) component: Vec<Expr>,
    pub(crate) place: Components,
    pub(crate) d_force_dx: Sparse,
    pub(crate) d_residual_dx: Sparse,
    pub(crate) d_gamma_dv: Sparse,
    pub(crate) d_velocity_dx: Sparse,
}

impl ConstraintKernels {
    /// Returns the expressions of the rows. The expressions contain all kernels that can be
    /// evaluated in any numeric type.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &Expr> {
        let c = self.c.iter().map(|e| &e.value);
        let others = [&self.phi, &self.b, &self.gamma, &self.component];
        c.chain(others.into_iter().flatten())
    }

    /// Returns the unit of the joint coordinate that a driven row prescribes. The joint coordinate
    /// is an angle if the row does not depend on the velocities of origins.
    pub(crate) fn unit_of_measure(&self, space: Space) -> Ident {
        let rotates = |e: &Entry| space.is_rotation(e.column % space.n_dof());
        if self.c.iter().all(rotates) {
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

/// The way in which a reaction component is computed.
pub(crate) enum Component {
    None,
    /// The component is the part of the force along the vector of the body.
    Along,
    /// The component is the force along the joint coordinate that a drive prescribes. The
    /// coefficient of each multiplier is the negative of this derivative of Φ.
    Motion(Along),
}

/// Derives the kernels of a constraint. Returns an error if a row restricts no motion. Rows of Ψ
/// are linear in velocities, because the elaboration rejects other rows.
pub(crate) fn constraint(
    model: &mut Model,
    body: &ConstraintBody,
    component: &Component,
) -> Result<ConstraintKernels, usize> {
    let columns = columns(model);
    let (phi, psi) = body.rows.split_at(body.holonomic);
    let rates = phi.iter().map(|&r| model.time.apply(&mut model.g, r));
    let velocity: Vec<Expr> = rates.chain(psi.iter().copied()).collect();
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
    let wrench = wrench(model, &c, &place, body.rows.len());
    let component = match component {
        Component::None => Vec::new(),
        Component::Motion(along) => {
            let mut slope_of = |&row: &Expr| {
                let slope = along.apply(&mut model.g, row);
                model.g.neg(slope)
            };
            let mut slopes: Vec<Expr> = phi.iter().map(&mut slope_of).collect();
            slopes.resize(body.rows.len(), model.g.number(0.0));
            slopes
        }
        Component::Along => {
            let (_, along) = body.component.as_ref().expect("the definition has one");
            let along = along.to_ground(&mut model.g, &model.turns);
            force_along(model, &c, &along, body.rows.len())
        }
    };
    let restricts_start = body
        .rows
        .iter()
        .map(|&row| !keeps_start(model, row))
        .collect();
    let residuals = match model.inputs.space {
        Space::Plane => residuals(model, &c, &gamma),
        Space::Space3 => {
            let full = model.inputs.full_time_derivation(&mut model.g);
            let rows = velocity.iter();
            rows.map(|&e| full.apply(&mut model.g, e)).collect()
        }
    };
    let d_force_dx = match model.inputs.space {
        Space::Plane => force_derivatives(model, &c, &columns),
        Space::Space3 => {
            let work = weighted(model, &body.rows, 0..body.holonomic, &body.vectors);
            let power = model.time.apply(&mut model.g, work);
            let of_psi = body.holonomic..body.rows.len();
            let of_psi = weighted(model, &body.rows, of_psi, &body.vectors);
            let power = model.g.add(power, of_psi);
            let forces = along_velocities(model, power);
            along_columns(model, &forces, &columns)
        }
    };
    let d_residual_dx = along_columns(model, &residuals, &columns);
    let d_gamma_dv = velocity_derivatives(model, &gamma);
    let d_velocity_dx = along_columns(model, &velocity, &columns);
    let phi = phi.to_vec();
    let mut kernels = ConstraintKernels {
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
    };
    expand(&mut kernels, model);
    Ok(kernels)
}

/// Replaces all symbols that have a definition.
fn expand(k: &mut ConstraintKernels, model: &mut Model) {
    let dense = [
        &mut k.phi,
        &mut k.b,
        &mut k.gamma,
        &mut k.component,
        &mut k.place,
    ];
    let sparse = [
        &mut k.wrench,
        &mut k.d_force_dx,
        &mut k.d_residual_dx,
        &mut k.d_gamma_dv,
        &mut k.d_velocity_dx,
    ];
    expand_all(model, dense.into_iter().flatten());
    expand_all(model, sparse.into_iter().flatten().map(|(_, e)| e));
    expand_all(model, k.c.iter_mut().map(|entry| &mut entry.value));
}

fn expand_all<'a>(model: &mut Model, all: impl Iterator<Item = &'a mut Expr>) {
    all.for_each(|e| *e = model.expand(*e));
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
                    let is_rate =
                        model.depends_on(coordinate, |s| matches!(s, Source::Twist { .. }));
                    let lever = if is_rate {
                        let n_dof = model.inputs.space.n_dof();
                        let v = model.inputs.slots[k / n_dof].twist[k % n_dof];
                        let by = model.inputs.partial(&mut model.g, v);
                        by.apply(&mut model.g, coordinate)
                    } else {
                        along.apply(&mut model.g, coordinate)
                    };
                    (1.0, model.g.mul(law, lever))
                })
                .collect();
            (k, model.g.sum(&parts))
        })
        .collect();
    q.retain(|(_, e)| !identity::is_zero(&mut model.g, &model.inputs, *e));
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
    let entries = q.iter_mut().map(|(_, e)| e);
    let derivatives = dq_dx.iter_mut().chain(&mut dq_dv).map(|(_, e)| e);
    expand_all(model, entries.chain(derivatives));
    ForceKernels { q, dq_dx, dq_dv }
}

/// Returns the derivation along each degree of freedom of each slot.
fn columns(model: &mut Model) -> Vec<Along> {
    let n_dof = model.inputs.space.n_dof();
    (0..model.inputs.slots.len() * n_dof)
        .map(|k| model.inputs.along_dof(&mut model.g, k / n_dof, k % n_dof))
        .collect()
}

fn c_block(model: &mut Model, velocity: &[Expr], n: usize) -> Vec<Entry> {
    let n_dof = model.inputs.space.n_dof();
    let mut c = Vec::new();
    for (row, &e) in velocity.iter().enumerate() {
        for column in 0..n {
            let v = model.inputs.slots[column / n_dof].twist[column % n_dof];
            let value = model.inputs.partial(&mut model.g, v).apply(&mut model.g, e);
            if !identity::is_zero(&mut model.g, &model.inputs, value) {
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
        .flat_map(|s| s.twist.iter().map(|&v| (v, zero)))
        .collect();
    let b: Vec<Expr> = velocity
        .iter()
        .map(|&e| {
            let e = model.expand(e);
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

/// Returns the force and the moment on the first body about the reference point, for each
/// multiplier. The force is `−C_vᵀ`. The moment about the centre of mass is `−C_ωᵀ`. The moment is
/// transferred to the reference point with the arm from the origin of the body. In space `−C_ωᵀ`
/// has components in the frame of the body, and the moment has ground components.
fn wrench(model: &mut Model, c: &[Entry], place: &Components, rows: usize) -> Sparse {
    let (space, dim) = (model.inputs.space, model.inputs.space.dim());
    let lever: Components = (0..dim)
        .map(|k| model.g.sub(place[k], model.inputs.slots[0].pose[k]))
        .collect();
    let mut map = Vec::new();
    for component in 0..space.n_dof() {
        for row in 0..rows {
            push(&mut map, model, component, row, |m| {
                let all: Components = (0..space.n_dof()).map(|k| entry(m, c, row, k)).collect();
                let (force, moment) = all.split_at(dim);
                match (space, component.checked_sub(dim)) {
                    (_, None) => m.g.neg(force[component]),
                    (Space::Plane, _) => {
                        let (a, b) = (m.g.mul(lever[0], force[1]), m.g.mul(lever[1], force[0]));
                        m.g.sum(&[(1.0, a), (-1.0, b), (-1.0, moment[0])])
                    }
                    (Space::Space3, Some(k)) => {
                        let transferred = cross(&mut m.g, &lever, force)[k];
                        let own = m.turns[0].clone().to_ground(&mut m.g, moment)[k];
                        m.g.sub(transferred, own)
                    }
                }
            });
        }
    }
    map
}

/// Returns the coefficients of the component of the force on the first body along a vector.
fn force_along(model: &mut Model, c: &[Entry], along: &Components, rows: usize) -> Vec<Expr> {
    (0..rows)
        .map(|row| {
            let force: Components = (0..along.len()).map(|k| entry(model, c, row, k)).collect();
            let along = dot(&mut model.g, &force, along);
            model.g.neg(along)
        })
        .collect()
}

fn entry(model: &mut Model, c: &[Entry], row: usize, column: usize) -> Expr {
    match c.iter().find(|e| e.row == row && e.column == column) {
        Some(e) => e.value,
        None => model.g.number(0.0),
    }
}

/// Returns whether a row contains a value stored at the start. Such a row is satisfied at any
/// initial configuration and does not restrict the initial configuration.
fn keeps_start(model: &Model, row: Expr) -> bool {
    model.depends_on(row, |s| match s {
        Source::Kept { field, .. } => {
            field == "measure_0" || model.kept.iter().any(|k| k.field == *field && k.of_start)
        }
        _ => false,
    })
}

/// Returns `∂(Cᵀλ)/∂x`.
fn force_derivatives(model: &mut Model, c: &[Entry], columns: &[Along]) -> Sparse {
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

/// Returns `C·a − Γ`, row by row.
fn residuals(model: &mut Model, c: &[Entry], gamma: &[Expr]) -> Vec<Expr> {
    let n_dof = model.inputs.space.n_dof();
    gamma
        .iter()
        .enumerate()
        .map(|(row, &gamma)| {
            let mut terms: Vec<(f64, Expr)> = c
                .iter()
                .filter(|e| e.row == row)
                .map(|e| {
                    let a = model.inputs.slots[e.column / n_dof].acceleration[e.column % n_dof];
                    (1.0, model.g.mul(e.value, a))
                })
                .collect();
            terms.push((-1.0, gamma));
            model.g.sum(&terms)
        })
        .collect()
}

/// Returns `Σ λ·row` of these rows. In space, rows that are the components of a vector are
/// multiplied as vectors.
fn weighted(
    model: &mut Model,
    rows: &[Expr],
    which: Range<usize>,
    vectors: &[(usize, Vector)],
) -> Expr {
    let mut terms: Vec<(f64, Expr)> = Vec::new();
    let mut row = which.start;
    while row < which.end {
        let vector = vectors.iter().find(|(first, _)| *first == row);
        match vector {
            Some((_, vector)) if model.inputs.space == Space::Space3 => {
                let dim = model.inputs.space.dim();
                let lambda = model.inputs.lambda[row..row + dim].to_vec();
                let lambda = Vector::new(Frame::Ground, lambda);
                terms.push((1.0, vector.dot(&mut model.g, &lambda, &model.turns)));
                row += dim;
            }
            _ => {
                let product = model.g.mul(model.inputs.lambda[row], rows[row]);
                terms.push((1.0, product));
                row += 1;
            }
        }
    }
    model.g.sum(&terms)
}

/// Returns the partial derivatives of a scalar with respect to the velocities.
fn along_velocities(model: &mut Model, e: Expr) -> Vec<Expr> {
    let slots = model.inputs.slots.iter();
    let twists: Vec<Expr> = slots.flat_map(|s| s.twist.iter().copied()).collect();
    twists
        .into_iter()
        .map(|v| model.inputs.partial(&mut model.g, v).apply(&mut model.g, e))
        .collect()
}

/// Returns the derivatives of `rows` along each degree of freedom.
fn along_columns(model: &mut Model, rows: &[Expr], columns: &[Along]) -> Sparse {
    let mut out = Vec::new();
    for (row, &e) in rows.iter().enumerate() {
        for (column, along) in columns.iter().enumerate() {
            push(&mut out, model, row, column, |m| along.apply(&mut m.g, e));
        }
    }
    out
}

/// Returns the partial derivatives of `rows` with respect to the velocities.
fn velocity_derivatives(model: &mut Model, rows: &[Expr]) -> Sparse {
    let n_dof = model.inputs.space.n_dof();
    let mut out = Vec::new();
    for (row, &e) in rows.iter().enumerate() {
        for column in 0..model.inputs.slots.len() * n_dof {
            let v = model.inputs.slots[column / n_dof].twist[column % n_dof];
            push(&mut out, model, row, column, |m| {
                m.inputs.partial(&mut m.g, v).apply(&mut m.g, e)
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
    if !identity::is_zero(&mut model.g, &model.inputs, value) {
        out.push(([row, column], value));
    }
}

#[cfg(test)]
mod tests;
