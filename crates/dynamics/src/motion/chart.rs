//! Independent coordinates z and velocities u: the rows determine the others, and the motion is an ordinary differential equation of
//! z and u alone. y keeps all coordinates: `f(y) = F(P·y)`, where P completes a state from its independent entries, so that results,
//! projections and output do not know of the partition. Steps of explicit methods need no projection; implicit methods have a Jacobian without
//! constraints ([`super::reduced`]).
//!
//! The partition stays for a step at least, because f must not change within it. It is chosen again at an accepted step where its pivots have
//! fallen. Near a singular configuration there is none, and a step that needs one is refused.

use model::System;

use super::KeptRowMotion;
use super::project::Correct;
use crate::error::Trip;

/// A partition, and the state completed last.
pub(super) struct Chart {
    /// Independent coordinates: columns of Φq, which in the plane are places in q.
    pub(super) z: Vec<usize>,
    /// Independent velocities.
    pub(super) u: Vec<usize>,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// How many partitions there were before.
    pub(super) generation: u64,
}

impl KeptRowMotion<'_> {
    /// From now on the motion is one of independent coordinates, chosen at q, which must lie on the constraints at t.
    ///
    /// # Errors
    /// If the kept rows are dependent there.
    pub fn use_chart(&mut self, t: f64, q: &[f64]) -> Result<(), Trip> {
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.c(&mut self.s);
        self.choose_chart(q)
    }

    /// Independent coordinates and velocities, ascending, where the motion is one of these alone.
    #[must_use]
    pub fn independent(&self) -> Option<(&[usize], &[usize])> {
        self.chart.as_ref().map(|c| (&c.z[..], &c.u[..]))
    }

    /// `ẏ = f(t, y)` of `y = [q; v]`, or `[q; v; W]` with the work W of drives and applied forces. On a chart the dependent entries of
    /// y are a first guess only.
    ///
    /// # Errors
    /// As [`super::Motion::acceleration`]; [`Trip::OffConstraints`], [`Trip::Chart`] if a state cannot be completed.
    ///
    /// # Panics
    /// If `y` or `dy` are shorter than n_q + n_v.
    pub fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Trip> {
        let layout = self.mechanism.layout();
        let (q, rest) = y.split_at(layout.n_q);
        let v = &rest[..layout.n_v];
        let (qd, rest) = dy.split_at_mut(layout.n_q);
        let (a, work) = rest.split_at_mut(layout.n_v);
        let Some(mut chart) = self.chart.take() else {
            self.solve(t, q, v, a)?;
            self.rates(q, v, qd, work);
            return Ok(());
        };
        chart.q.copy_from_slice(q);
        chart.v.copy_from_slice(v);
        let solved = self.solve_on_chart(t, &mut chart, a);
        if solved.is_ok() {
            self.rates(&chart.q, &chart.v, qd, work);
        }
        self.chart = Some(chart);
        solved
    }

    /// q̇ and, where there is room for it, the power at a state whose acceleration is the last one evaluated.
    fn rates(&mut self, q: &[f64], v: &[f64], qd: &mut [f64], work: &mut [f64]) {
        self.mechanism.rate(q, v, qd);
        if let Some(work) = work.first_mut() {
            *work = self.power(v);
        }
    }

    /// Completes the state of a chart and solves for accelerations there.
    fn solve_on_chart(&mut self, t: f64, chart: &mut Chart, a: &mut [f64]) -> Result<(), Trip> {
        self.complete(t, &mut chart.q, &mut chart.v)?;
        self.passage.see(&self.velocity);
        self.solve_factored(&chart.v, a)
    }

    /// Overwrites dependent coordinates and velocities; factors there.
    fn complete(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<(), Trip> {
        self.project_position(t, q, Correct::DependentCoordinates)?;
        self.velocity.factor(self.mechanism, &self.s)?;
        self.evaluate_b();
        for (rhs, &i) in self.velocity.rhs.iter_mut().zip(&self.velocity.kept) {
            *rhs = self.s.b[i];
        }
        self.velocity.complete(self.mechanism, &self.s, v)
    }

    /// Completes a state on a chart. What projections leave to do afterwards is rounding.
    pub(super) fn complete_row(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), Trip> {
        match self.chart {
            Some(_) => self.complete(t, q, v),
            None => Ok(()),
        }
    }

    /// Completes the result of a step on a chart, and chooses another one where its pivots have fallen.
    pub(super) fn complete_step(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), Trip> {
        if self.chart.is_none() {
            return Ok(());
        }
        self.complete(t, q, v)?;
        if self.velocity.are_lost() || self.position.are_lost() {
            self.choose_chart(q)?;
        }
        Ok(())
    }

    /// Chooses a chart on new rows, at the pose of the scratch.
    pub(super) fn renew_chart(&mut self, q: &[f64]) -> Result<(), Trip> {
        match self.chart {
            Some(_) => self.choose_chart(q),
            None => Ok(()),
        }
    }

    /// Partitions the rows at the pose of the scratch.
    fn choose_chart(&mut self, q: &[f64]) -> Result<(), Trip> {
        let (mechanism, s) = (self.mechanism, &self.s);
        let z = self.position.partition(mechanism, s, self.size)?;
        let u = self.velocity.partition(mechanism, s, self.size)?;
        // Rows set aside are only solved on, at single instants.
        if let Some(aside) = &mut self.aside {
            aside.forget_partition();
        }
        let generation = self.chart.as_ref().map_or(0, |c| c.generation + 1);
        self.chart = Some(Chart {
            z,
            u,
            q: q.to_vec(),
            v: vec![0.0; mechanism.layout().n_v],
            generation,
        });
        Ok(())
    }
}
