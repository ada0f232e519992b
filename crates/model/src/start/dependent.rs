//! Computes the velocities that the initial velocities do not state. Among all velocities that
//! satisfy the velocity constraints `C·v = b`, the chosen velocities minimise the kinetic energy
//! `½·vᵀ·M·v`.
//!
//! Sets of rows that have no dependent velocity in common are solved separately. Small sets are
//! solved directly, after the rank of their columns has been determined. The remaining rows form
//! circuits. The sums of the right-hand sides over the circuits determine whether the velocities
//! exist. Large sets are solved with their Schur complement. Other modules select the dependent
//! velocities, and process velocities that are impossible.
//!
//! The rank of these columns is not the rank of the constraints.

use std::collections::HashMap;

use linalg::{
    DisjointSets, KeptRowSaddle, Matrix, SchurSaddle, SchurStructure, SparseMatrix,
    least_squares_step,
};
use rank::{Circuit, circuits, decide};

use super::components::Components;
use super::error::StartError;
use super::metric::{DAMPING, ROUNDINGS, weights};
use super::options::StartOptions;
use crate::mechanism::Mechanism;
use crate::size::size_of;
use crate::space::norm;
use crate::system::{Scratch, System};
use crate::uncertainty::ConfigurationAccuracy;

/// Sets with more rows than this limit are solved with their Schur complement, because dense
/// factorisations would take seconds.
pub(super) const DENSE_ROWS: usize = 300;

/// In large sets, a row counts as dependent on other rows if its remaining part is below this
/// fraction. The limit is large because the condition number of the Schur complement is the square
/// of the condition number of the rows.
const LEFT: f64 = 1e-7;

/// In large sets, a row is ignored if its entries are below this multiple of their uncertainties.
/// After scaling to norm one, these entries would be rounding errors.
const SIGNIFICANT: f64 = 1e3;

/// Largest number of repetitions of the solution. A repetition removes all errors except rounding
/// errors. If independent rows appear dependent in the metric, the effect of the damping remains as
/// well.
const REPETITIONS: usize = 6;

/// A repetition has to reduce the residuals to less than this fraction.
const PROGRESS: f64 = 0.5;

/// The equations `C·v = b` of an initial state.
pub(super) struct Equations<'m> {
    pub(super) mechanism: &'m Mechanism,
    pub(super) q: Vec<f64>,
    pub(super) s: Scratch,
    pub(super) size: f64,
    /// Diagonal of M⁻¹; velocities without mass have the weight of the smallest mass.
    pub(super) weights: Vec<f64>,
    /// Bodies for which only some components of the angular velocity are kept. The columns of these
    /// bodies are transformed.
    components: Vec<Components>,
    /// The reciprocal of this rate (1/s) is a time. A velocity counts as zero if, during this time,
    /// it changes positions by less than 100 times their rounding error.
    rest_rate: f64,
    /// Uncertainty of the entries in the pattern of C; computed on request.
    known: Option<Vec<f64>>,
}

impl<'m> Equations<'m> {
    pub(super) fn new(mechanism: &'m Mechanism, options: &StartOptions, q: &[f64]) -> Self {
        let mut s = mechanism.scratch();
        mechanism.pose(mechanism.layout().start_time, q, &mut s);
        mechanism.phi(&mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        let size = size_of(mechanism, &s);
        let weight = mechanism.weight().iter().zip(mechanism.mass());
        let gravity = weight.filter(|(_, m)| **m > 0.0).map(|(w, m)| w.abs() / m);
        let gravity = gravity.fold(0.0, f64::max);
        let mut weights = weights(mechanism, size);
        let components = Components::kept(mechanism, options, &s, &weights);
        for body in &components {
            body.take_over(mechanism, &mut s, &mut weights);
        }
        Self {
            mechanism,
            q: q.to_vec(),
            s,
            size,
            weights,
            components,
            // The default time is one second. For a mechanism that falls under gravity, the time
            // √(size/g) is used if it is shorter.
            rest_rate: (gravity / size).sqrt().max(1.0),
            known: None,
        }
    }

    /// Converts velocities of the mechanism to the variables of these equations.
    pub(super) fn take(&self, v: &mut [f64]) {
        self.components.iter().for_each(|body| body.replace(v));
    }

    /// Converts the variables of these equations to velocities of the mechanism.
    pub(super) fn velocities(&self, v: &[f64]) -> Vec<f64> {
        let mut v = v.to_vec();
        self.components.iter().for_each(|body| body.restore(&mut v));
        v
    }

    /// Returns the residual `C·v − b` of row `i`.
    pub(super) fn residual(&self, i: usize, v: &[f64]) -> f64 {
        self.mechanism.layout().velocity_residual(&self.s, i, v)
    }

    /// Returns the largest residual of row `i` that counts as rounding. This limit contains the
    /// rounding error of the terms, and the rounding error of the positions of the bodies times the
    /// largest rate.
    pub(super) fn rounding(&self, i: usize, v: &[f64]) -> f64 {
        let row = self.mechanism.layout().row(&self.s, i);
        let fastest = self.fastest(row.map(|(j, _)| j), v);
        let places = self.mechanism.scales(&self.s).position(i);
        let terms = self.mechanism.scales(&self.s).bounded_velocity(i, v);
        ROUNDINGS * f64::EPSILON * (terms + fastest * places)
    }

    /// Returns the largest rate of some velocity components (1/s): rotations, and translations
    /// divided by the longest arm of the body.
    pub(super) fn fastest(&self, columns: impl Iterator<Item = usize>, v: &[f64]) -> f64 {
        let space = self.mechanism.space();
        let arm = |j: usize| {
            if space.is_rotation(j) {
                1.0
            } else {
                self.mechanism.reach(space.body_of(j))
            }
        };
        columns.map(|j| v[j].abs() / arm(j)).fold(0.0, f64::max)
    }

    /// Returns the permitted residual of row `i` if all velocities have the rounding error of this
    /// rate (1/s), or are at rest.
    pub(super) fn slack(&self, i: usize, rate: f64) -> f64 {
        let places = self.mechanism.scales(&self.s).position(i);
        ROUNDINGS * f64::EPSILON * (ROUNDINGS * self.rest_rate + rate) * places
    }

    /// Returns the limit below which velocity `j` counts as zero.
    pub(super) fn rest_of(&self, j: usize) -> f64 {
        self.rest_at(j, 0.0)
    }

    /// Returns the limit below which velocity `j` counts as zero if other bodies move at this rate
    /// (1/s). The limit includes the rounding errors of a solution that computes all these
    /// velocities together.
    pub(super) fn rest_at(&self, j: usize, rate: f64) -> f64 {
        let body = self.mechanism.space().body_of(j);
        let place = norm(&self.s.bodies.origin(body)).max(self.size);
        let rest = ROUNDINGS.powi(2) * f64::EPSILON * self.rest_rate.max(rate) * place;
        rest / self.arm(j)
    }

    /// Returns the factor that converts a velocity component to the velocity of a point; for
    /// rotations, it is the size of the mechanism.
    pub(super) fn arm(&self, j: usize) -> f64 {
        if self.mechanism.space().is_rotation(j) {
            self.size
        } else {
            1.0
        }
    }

    /// Returns the velocity components in some rows, in ascending order.
    pub(super) fn columns(&self, rows: &[usize]) -> Vec<usize> {
        let layout = self.mechanism.layout();
        let all = rows.iter().flat_map(|&i| layout.row(&self.s, i));
        let mut columns: Vec<usize> = all.map(|(j, _)| j).collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    }

    /// Returns the sets of rows that have velocity components in common. Each set is in ascending
    /// order, and the sets are ordered by their first rows. Only velocity components for which
    /// `joins` returns `true` connect rows.
    pub(super) fn sets(&self, rows: &[usize], joins: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let layout = self.mechanism.layout();
        let mut sets = DisjointSets::new(rows.len());
        let mut first: HashMap<usize, usize> = HashMap::new();
        for (k, &i) in rows.iter().enumerate() {
            for (j, _) in layout.row(&self.s, i).filter(|(j, _)| joins(*j)) {
                sets.join(*first.entry(j).or_insert(k), k);
            }
        }
        let of_rows = |set: Vec<usize>| set.into_iter().map(|k| rows[k]).collect();
        sets.sets().into_iter().map(of_rows).collect()
    }

    /// Returns the submatrix of C with these rows and columns. The function allocates memory.
    pub(super) fn matrix(&self, rows: &[usize], columns: &[usize]) -> Matrix {
        let mut c = Matrix::zeros(rows.len(), columns.len());
        for (k, &i) in rows.iter().enumerate() {
            for (j, x) in self.mechanism.layout().row(&self.s, i) {
                if let Ok(l) = columns.binary_search(&j) {
                    c[(k, l)] += x;
                }
            }
        }
        c
    }

    /// Computes the uncertainties of the entries in the pattern of C, if this has not been done
    /// before.
    pub(super) fn learn(&mut self) {
        let Self {
            mechanism,
            s,
            size,
            known,
            ..
        } = self;
        known.get_or_insert_with(|| {
            mechanism
                .scales(s)
                .uncertainty_of_entries(*size, ConfigurationAccuracy::AsStored)
        });
    }

    fn known(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let pattern = &self.mechanism.layout().pattern;
        let known = self.known.as_deref().unwrap_or_default();
        pattern
            .row(i)
            .map(move |k| (pattern.column[k], known.get(k).copied().unwrap_or_default()))
    }
}

/// Returns whether a size is above a limit, or NaN.
pub(super) fn exceeds(size: f64, limit: f64) -> bool {
    size > limit || size.is_nan() || limit.is_nan()
}

/// Rows, and the velocity components that are computed from them.
pub(super) struct DependentVelocities {
    parts: Vec<RowBlock>,
    /// The circuits of small sets: sums of rows that do not depend on the dependent velocities.
    pub(super) circuits: Vec<Circuit>,
}

/// Rows that are solved together.
pub(super) struct RowBlock {
    /// Rows that are independent in these columns.
    rows: Vec<usize>,
    columns: Vec<usize>,
    solver: Solver,
}

enum Solver {
    Dense(Matrix),
    Schur(Box<(SparseMatrix, SchurSaddle)>),
}

impl DependentVelocities {
    /// Prepares the solution of some rows. The unknowns are the velocity components for which
    /// `follows` returns `true`.
    ///
    /// # Errors
    /// Returns an error if C is not finite.
    pub(super) fn new(
        of: &Equations<'_>,
        rows: &[usize],
        follows: impl Fn(usize) -> bool,
    ) -> Result<Self, StartError> {
        let mut dependent = Self {
            parts: Vec::new(),
            circuits: Vec::new(),
        };
        for set in of.sets(rows, &follows) {
            let mut columns = of.columns(&set);
            columns.retain(|j| follows(*j));
            if set.len() > DENSE_ROWS {
                let masses: Vec<f64> = columns.iter().map(|&j| of.weights[j].recip()).collect();
                dependent
                    .parts
                    .extend(RowBlock::schur(of, &set, columns, &masses)?);
                continue;
            }
            let exponents = of.mechanism.layout().dimension_scaling(of.size).cols;
            let scaled =
                |k: usize, l: usize, x: f64| (k, l, x * f64::from(exponents[columns[l]]).exp2());
            let mut c = Matrix::zeros(set.len(), columns.len());
            let mut known = Matrix::zeros(set.len(), columns.len());
            for (k, &i) in set.iter().enumerate() {
                let place = |j: usize| columns.binary_search(&j).ok();
                for (j, x) in of.mechanism.layout().row(&of.s, i) {
                    if let Some((k, l, x)) = place(j).map(|l| scaled(k, l, x)) {
                        c[(k, l)] += x;
                    }
                }
                for (j, x) in of.known(i) {
                    if let Some((k, l, x)) = place(j).map(|l| scaled(k, l, x)) {
                        known[(k, l)] += x;
                    }
                }
            }
            let decision = decide(&c, &known)?;
            let left = circuits(&decision).into_iter().map(|circuit| Circuit {
                rows: circuit.rows.iter().map(|&k| set[k]).collect(),
                ..circuit
            });
            dependent.circuits.extend(left);
            let rows: Vec<usize> = decision.kept.iter().map(|&k| set[k]).collect();
            if !rows.is_empty() {
                let c = of.matrix(&rows, &columns);
                dependent.parts.push(RowBlock {
                    rows,
                    columns,
                    solver: Solver::Dense(c),
                });
            }
        }
        Ok(dependent)
    }

    /// Corrects the dependent velocities in v so that the residuals of the rows become zero.
    ///
    /// # Errors
    /// Returns an error if a row is not finite.
    pub(super) fn follow(&mut self, of: &Equations<'_>, v: &mut [f64]) -> Result<(), StartError> {
        self.parts
            .iter_mut()
            .try_for_each(|part| part.follow(of, v))
    }

    /// Returns the circuits whose sum of residuals is larger than the rounding error of the terms.
    pub(super) fn open<'t>(
        &'t self,
        of: &'t Equations<'_>,
        v: &'t [f64],
    ) -> impl Iterator<Item = &'t Circuit> + 't {
        let is_open = |circuit: &&Circuit| {
            let terms = || circuit.rows.iter().zip(&circuit.coefficients);
            let sum: f64 = terms().map(|(&i, z)| z * of.residual(i, v)).sum();
            let rounding: f64 = terms().map(|(&i, z)| z.abs() * of.rounding(i, v)).sum();
            exceeds(sum.abs(), rounding)
        };
        self.circuits.iter().filter(is_open)
    }
}

impl RowBlock {
    /// Prepares the solution of a large set. Returns `None` if no row of the set has significant
    /// entries in these columns.
    pub(super) fn schur(
        of: &Equations<'_>,
        set: &[usize],
        columns: Vec<usize>,
        masses: &[f64],
    ) -> Result<Option<Self>, StartError> {
        let layout = of.mechanism.layout();
        let is_here = |j: usize| columns.binary_search(&j).is_ok();
        let says = |i: &&usize| {
            let known: HashMap<usize, f64> = of.known(**i).collect();
            let mut own = layout.row(&of.s, **i).filter(|(j, _)| is_here(*j));
            own.any(|(j, c)| c.abs() > SIGNIFICANT * known.get(&j).copied().unwrap_or_default())
        };
        let rows: Vec<usize> = set.iter().filter(says).copied().collect();
        if rows.is_empty() {
            return Ok(None);
        }
        let entries = |&i: &usize| {
            let own = layout.row(&of.s, i);
            let own = own.filter_map(|(j, c)| Some((columns.binary_search(&j).ok()?, c)));
            own.collect::<Vec<_>>()
        };
        let c = SparseMatrix::from_rows(columns.len(), rows.iter().map(entries))?;
        let mut blocks: Vec<std::ops::Range<usize>> = Vec::new();
        let body_of = |j: usize| layout.space.body_of(j);
        for l in 0..columns.len() {
            match blocks.last_mut() {
                Some(last) if body_of(columns[last.start]) == body_of(columns[l]) => {
                    last.end = l + 1;
                }
                _ => blocks.push(l..l + 1),
            }
        }
        let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &blocks));
        saddle.factor_above(LEFT, &c, masses)?;
        Ok(Some(Self {
            rows,
            columns,
            solver: Solver::Schur(Box::new((c, saddle))),
        }))
    }

    pub(super) fn follow(&mut self, of: &Equations<'_>, v: &mut [f64]) -> Result<(), StartError> {
        let mut best = f64::INFINITY;
        for _ in 0..REPETITIONS {
            let residual: Vec<f64> = self.rows.iter().map(|&i| of.residual(i, v)).collect();
            let ratio = |(&i, r): (&usize, &f64)| {
                if *r == 0.0 {
                    0.0
                } else {
                    r.abs() / of.rounding(i, v)
                }
            };
            let used = |k: usize| match &self.solver {
                Solver::Dense(_) => true,
                Solver::Schur(sparse) => sparse.1.uses(k),
            };
            let rows = self.rows.iter().zip(&residual).enumerate();
            let ratios = rows.filter(|(k, _)| used(*k)).map(|(_, row)| ratio(row));
            let worst = ratios.fold(0.0, |a: f64, x| if x.is_nan() { x } else { a.max(x) });
            // The iteration ends when the residual no longer decreases, because the results have
            // their own rounding errors.
            if worst == 0.0 || exceeds(worst, PROGRESS * best) {
                return Ok(());
            }
            best = worst;
            let step = self.step(of, &residual)?;
            for (&j, dv) in self.columns.iter().zip(step) {
                v[j] += dv;
            }
        }
        Ok(())
    }

    /// Returns the velocity correction of smallest norm that removes these residuals.
    fn step(&mut self, of: &Equations<'_>, residual: &[f64]) -> Result<Vec<f64>, StartError> {
        match &mut self.solver {
            Solver::Dense(c) => {
                let weights: Vec<f64> = self.columns.iter().map(|&j| of.weights[j]).collect();
                shortest(c, residual, &weights)
            }
            Solver::Schur(sparse) => {
                let (c, saddle) = &mut **sparse;
                let gamma: Vec<f64> = residual.iter().map(|r| -r).collect();
                let mut dv = vec![0.0; self.columns.len()];
                let mut lambda = vec![0.0; self.rows.len()];
                let forces = vec![0.0; dv.len()];
                saddle.solve(c, &forces, &gamma, &mut dv, &mut lambda)?;
                Ok(dv)
            }
        }
    }
}

/// Returns the step of smallest norm that removes the residuals of the rows. The metric is given by
/// inverse masses. If the rows are independent to working precision, the step is exact, even for
/// very different masses. Otherwise the step is damped.
pub(super) fn shortest(
    c: &Matrix,
    residual: &[f64],
    weights: &[f64],
) -> Result<Vec<f64>, StartError> {
    if c.nrows() <= c.ncols() {
        let masses: Vec<f64> = weights.iter().map(|w| w.recip()).collect();
        let mut saddle = KeptRowSaddle::new(c.ncols(), c.nrows())?;
        if saddle.factor(|k| c.row(k), &masses).is_ok() {
            let gamma: Vec<f64> = residual.iter().map(|r| -r).collect();
            let mut step = vec![0.0; c.ncols()];
            saddle.motion(&vec![0.0; c.ncols()], &gamma, &mut step)?;
            return Ok(step);
        }
    }
    Ok(least_squares_step(c, residual, weights, DAMPING)?)
}
