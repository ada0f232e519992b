//! Do all rows give what the kept ones give? Asked on the constraints, and where kept rows are refined: masses that differ by many powers of
//! ten cost the other formulations digits that nothing in their own numbers shows.

use linalg::Matrix;
use model::System;

use super::KeptRowMotion;
use crate::error::Trip;
use crate::prepare::Prepared;

/// Forces that are this much smaller than the largest are zero up to rounding.
const NO_FORCE: f64 = 1e-12;

/// Where most is missed, in units of what is allowed.
struct Miss {
    column: usize,
    by: f64,
}

/// The largest `|x_j − y_j|/size_j`; NaN counts as infinite.
fn worst(x: &[f64], y: &[f64], size: impl Fn(usize) -> f64) -> Miss {
    let mut worst = Miss { column: 0, by: 0.0 };
    for (column, (x, y)) in x.iter().zip(y).enumerate() {
        let by = match (x - y).abs() {
            0.0 => 0.0,
            missed => missed / size(column),
        };
        if by.is_nan() || by > worst.by {
            let by = if by.is_nan() { f64::INFINITY } else { by };
            worst = Miss { column, by };
        }
    }
    worst
}

/// A massless motion that a solver with all rows finds where that on kept rows finds none: it takes graded masses for none.
pub(super) fn too_graded(trip: Trip, mass: &[f64]) -> Trip {
    match trip {
        Trip::Massless {
            time,
            body,
            coordinate,
        } => Trip::Graded {
            time,
            body,
            coordinate,
            spread: linalg::mass_spread(mass),
        },
        other => other,
    }
}

/// The same at the start, where kept rows have to be asked first.
pub(super) fn unless_graded(prepared: &Prepared, trip: Trip) -> Trip {
    let kept = KeptRowMotion::new(prepared);
    match kept.and_then(|mut kept| kept.is_refined_at(0.0, &prepared.q)) {
        Ok(true) => too_graded(trip, prepared.mechanism.mass()),
        _ => trip,
    }
}

impl KeptRowMotion<'_> {
    /// Compares accelerations with all rows, just solved for on the constraints, with refined ones on kept rows, beside the largest that there
    /// are or that forces and velocities ask for.
    pub(super) fn check_acceleration(&mut self, a: &[f64]) -> Result<(), Trip> {
        let Some(allowed) = self.allowed_miss() else {
            return Ok(());
        };
        let mut kept = vec![0.0; a.len()];
        self.solve_on_kept_rows(&mut kept)?;
        let (mechanism, s) = (self.mechanism, &self.s);
        let unit = |j: usize| mechanism.unit(j, self.size);
        let asked_for = (0..a.len()).map(|j| match mechanism.mass()[j] {
            m if m > 0.0 => kept[j].abs().max(s.force[j].abs() / m) / unit(j),
            _ => kept[j].abs() / unit(j),
        });
        let rate = self.velocity.rate().max(asked_for.fold(0.0, f64::max));
        let miss = worst(a, &kept, |j| rate * unit(j));
        self.judge("the acceleration", &miss, allowed)
    }

    /// Turns the multipliers of the last solve into those that the formulation reports. Where kept rows are refined, it begins with theirs, and the
    /// forces of the constraints are compared, beside the terms that they are the sum of.
    pub(super) fn choose_multipliers(&mut self) -> Result<(), Trip> {
        let Some(allowed) = self.allowed_miss() else {
            if let Some(all) = &mut self.all_rows {
                all.choose(self.mechanism, &self.s);
            }
            return Ok(());
        };
        let n = self.mechanism.layout().n_v;
        let mut a = vec![0.0; n];
        self.solve_on_kept_rows(&mut a)?;
        let (kept, lambda) = (&self.velocity.kept, &self.velocity.lambda);
        let Some(all) = &mut self.all_rows else {
            return Ok(());
        };
        all.start_from(kept, lambda);
        all.choose(self.mechanism, &self.s);
        let c: Matrix = self.mechanism.layout().dense(&self.s);
        let (mut forces, mut expected, mut sizes) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for (i, l) in all.lambda.iter().enumerate() {
            for ((force, size), c) in forces.iter_mut().zip(&mut sizes).zip(c.row(i)) {
                *force += c * l;
                *size += (c * l).abs();
            }
        }
        for (&i, l) in kept.iter().zip(lambda) {
            for (force, c) in expected.iter_mut().zip(c.row(i)) {
                *force += c * l;
            }
        }
        let least = NO_FORCE * sizes.iter().fold(0.0, |a, size| f64::max(a, *size));
        let miss = worst(&forces, &expected, |j| sizes[j].max(least));
        self.judge("the force of the constraints", &miss, allowed)
    }

    /// What is allowed, where there is something to compare.
    fn allowed_miss(&self) -> Option<f64> {
        let all = self.all_rows.as_ref()?;
        self.velocity.are_refined().then(|| all.allowed())
    }

    fn solve_on_kept_rows(&mut self, a: &mut [f64]) -> Result<(), Trip> {
        let Self {
            mechanism,
            s,
            velocity,
            ..
        } = self;
        for (rhs, &i) in velocity.rhs.iter_mut().zip(&velocity.kept) {
            *rhs = s.gamma[i];
        }
        velocity.accelerate(mechanism, s, a)
    }

    fn judge(&self, what: &'static str, miss: &Miss, allowed: f64) -> Result<(), Trip> {
        if miss.by <= allowed {
            return Ok(());
        }
        let (body, coordinate) = self.mechanism.coordinate(miss.column);
        Err(Trip::AllRows {
            time: self.s.t,
            what,
            body: body.to_owned(),
            coordinate,
            by: miss.by,
            allowed,
        })
    }
}
