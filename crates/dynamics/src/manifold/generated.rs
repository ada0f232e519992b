//! Projection by generated code. The code computes the residuals and corrections of the Newton
//! iteration that the interpreter also uses.

use model::{Mechanism, System};

use super::dropped::Correction;
use super::levels::largest;
use super::newton::{Level, Limits, correct};
use crate::code::SceneCode;
use crate::guards::GUARDED;
use crate::limits::{
    CODE_AT_REST, CODE_CORRECTIONS, DROPPED_MISFIT, STALLED_ROUNDINGS, VELOCITY_CORRECTIONS,
};
use crate::solve::{Doubt, GeneratedCode, KeptEquations};

/// Storage for a projection by generated code.
pub(crate) struct CodeProjection {
    /// Whether each row of Φ and of C is an independent row of the code.
    keeps_position: Vec<bool>,
    keeps: Vec<bool>,
    bounds: Bounds,
    /// Sizes of coordinates, sizes of the terms of each row, and the residuals.
    coordinates: Vec<f64>,
    sizes: Vec<f64>,
    phi: Vec<f64>,
    residual: Vec<f64>,
    dq: Vec<f64>,
    dv: Vec<f64>,
    /// Copy of the state before the projection.
    before: (Vec<f64>, Vec<f64>),
}

/// For each row, the columns of C with nonzero entries, and bounds on the entries.
struct Bounds {
    /// Index of the first entry of each row, and the end of the last row: m + h + 1 values.
    start: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl Bounds {
    fn new(rows: impl Iterator<Item = Vec<(usize, f64)>>) -> Self {
        let (mut start, mut entries) = (vec![0], Vec::new());
        for row in rows {
            entries.extend(row);
            start.push(entries.len());
        }
        Self { start, entries }
    }

    /// Writes the sizes of the terms of all rows for values x of the columns, n_v.
    fn sizes(&self, x: &[f64], sizes: &mut [f64]) {
        for (size, ends) in sizes.iter_mut().zip(self.start.windows(2)) {
            let entries = &self.entries[ends[0]..ends[1]];
            *size = entries.iter().map(|&(j, c)| c * x[j].abs()).sum();
        }
    }
}

impl CodeProjection {
    /// Allocates work space for code on the rows of these equations, with C at the last evaluated
    /// pose.
    pub(crate) fn new(equations: &KeptEquations<'_>, q: &[f64]) -> Self {
        let at = &equations.at;
        let layout = at.mechanism.layout();
        let keeps = |kept: &[usize], rows: usize| (0..rows).map(|i| kept.contains(&i)).collect();
        let bounds = (0..layout.rows()).map(|i| at.mechanism.scales(&at.s).entry_bounds(i));
        Self {
            keeps_position: keeps(&equations.position.kept, layout.m),
            keeps: keeps(&equations.velocity.kept, layout.rows()),
            bounds: Bounds::new(bounds),
            coordinates: vec![0.0; layout.n_v],
            sizes: vec![0.0; layout.rows()],
            phi: vec![0.0; layout.m],
            residual: vec![0.0; layout.rows()],
            dq: vec![0.0; layout.n_v],
            dv: vec![0.0; layout.n_v],
            before: (q.to_vec(), vec![0.0; layout.n_v]),
        }
    }

    /// Moves q and v onto the constraint manifold and checks all rows. If the result is unreliable,
    /// q and v are unchanged.
    pub(crate) fn project(
        &mut self,
        GeneratedCode(code): &GeneratedCode<'_>,
        mechanism: &Mechanism,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<Correction, Doubt> {
        self.before.0.copy_from_slice(q);
        self.before.1.copy_from_slice(v);
        let projected = self.project_both(*code, mechanism, t, (&mut *q, &mut *v));
        if projected.is_err() {
            q.copy_from_slice(&self.before.0);
            v.copy_from_slice(&self.before.1);
        }
        projected
    }

    fn project_both(
        &mut self,
        code: &dyn SceneCode,
        mechanism: &Mechanism,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<Correction, Doubt> {
        model::Scales::of_coordinates(mechanism, q, &mut self.coordinates);
        self.bounds.sizes(&self.coordinates, &mut self.sizes);
        let mut positions = CodePositions {
            all: self,
            code,
            mechanism,
            t,
            q,
        };
        let end = correct(&mut positions, &limits(CODE_CORRECTIONS))?;
        let (m, q) = (self.phi.len(), &*q);
        reached(end.is_reached, end.worst, &self.phi)?;
        check_dropped(&self.phi, &self.keeps_position, &self.sizes[..m])?;
        let mut velocities = CodeVelocities {
            all: self,
            code,
            t,
            q,
            v,
        };
        let reach = correct(&mut velocities, &limits(VELOCITY_CORRECTIONS))?;
        reached(reach.is_reached, reach.worst, &self.residual)?;
        check_dropped(&self.residual, &self.keeps, &self.sizes)?;
        Ok(Correction {
            iterations: end.corrections,
            position_residual: largest(&self.phi),
            velocity_residual: largest(&self.residual),
        })
    }
}

/// Generated code corrects each level at least once, because it does not compute residuals
/// beforehand.
fn limits(most: usize) -> Limits {
    Limits {
        corrections: [1, most],
        enough: STALLED_ROUNDINGS,
        stalled: 0.0,
    }
}

fn reached(is_reached: bool, row: usize, misses: &[f64]) -> Result<(), Doubt> {
    match is_reached {
        true => Ok(()),
        false if misses[row].is_finite() => Err(Doubt::OffConstraints {
            row,
            by: misses[row].abs(),
        }),
        false => Err(Doubt::OffConstraints {
            row,
            by: f64::INFINITY,
        }),
    }
}

struct CodePositions<'a> {
    all: &'a mut CodeProjection,
    code: &'a dyn SceneCode,
    mechanism: &'a Mechanism,
    t: f64,
    q: &'a mut [f64],
}

impl Level for CodePositions<'_> {
    type Fault = Doubt;

    fn misses(&mut self, corrections: usize) -> (usize, f64) {
        let all = &mut *self.all;
        self.code.phi(self.t, self.q, &mut all.phi);
        worst_kept(corrections, &all.phi, &all.keeps_position, &all.sizes)
    }

    fn correct(&mut self, _: bool) -> Result<(), Doubt> {
        let CodeProjection { phi, dq, .. } = &mut *self.all;
        let health = self.code.position_correction(self.t, self.q, phi, dq);
        Doubt::of(health, dq)?;
        self.mechanism.displace(self.q, dq);
        Ok(())
    }
}

struct CodeVelocities<'a> {
    all: &'a mut CodeProjection,
    code: &'a dyn SceneCode,
    t: f64,
    q: &'a [f64],
    v: &'a mut [f64],
}

impl Level for CodeVelocities<'_> {
    type Fault = Doubt;

    fn misses(&mut self, corrections: usize) -> (usize, f64) {
        let all = &mut *self.all;
        let residual = &mut all.residual;
        self.code
            .velocity_residual(self.t, self.q, self.v, residual);
        if corrections > 0 {
            all.bounds.sizes(self.v, &mut all.sizes);
            // Rows of bodies at rest contain rounding errors of other rows.
            let least = CODE_AT_REST * largest(&all.sizes);
            for size in &mut all.sizes {
                *size = size.max(least);
            }
        }
        worst_kept(corrections, residual, &all.keeps, &all.sizes)
    }

    fn correct(&mut self, _: bool) -> Result<(), Doubt> {
        let CodeProjection { residual, dv, .. } = &mut *self.all;
        let health = self.code.velocity_correction(self.t, self.q, residual, dv);
        Doubt::of(health, dv)?;
        for (v, d) in self.v.iter_mut().zip(&*dv) {
            *v += d;
        }
        Ok(())
    }
}

/// Returns the independent row with the largest residual, and the residual in roundings of the
/// terms of the row. The residual is infinite if it is NaN. The value is not used before the first
/// correction.
fn worst_kept(corrections: usize, x: &[f64], keeps: &[bool], sizes: &[f64]) -> (usize, f64) {
    if corrections == 0 {
        return (0, f64::INFINITY);
    }
    let rows = x.iter().zip(keeps).zip(sizes).enumerate();
    let rows = rows.filter(|(_, ((x, keeps), _))| **keeps && **x != 0.0);
    let (row, share) = rows.fold((0, 0.0), |worst, (i, ((x, _), size))| {
        match x.abs() / size {
            share if share > worst.1 => (i, share),
            share if share.is_nan() => (i, f64::INFINITY),
            _ => worst,
        }
    });
    (row, share / f64::EPSILON)
}

/// Checks that redundant rows are satisfied. The residuals of these rows are compared with the
/// largest row, because the rounding errors of all rows affect them.
fn check_dropped(x: &[f64], keeps: &[bool], sizes: &[f64]) -> Result<(), Doubt> {
    if !GUARDED {
        return Ok(());
    }
    let most = DROPPED_MISFIT * largest(sizes);
    let misses = |x: &f64| x.is_nan() || x.abs() > most;
    let mut dropped = x.iter().zip(keeps).enumerate();
    match dropped.find(|(_, (x, keeps))| !**keeps && misses(x)) {
        Some((row, (x, _))) => Err(Doubt::DroppedRow { row, by: x.abs() }),
        None => Ok(()),
    }
}
