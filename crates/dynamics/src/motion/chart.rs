//! Independent coordinates z and velocities u: the rows determine the others, and the motion is an
//! ordinary differential equation of z and u alone. y keeps all coordinates: `f(y) = F(P·y)`, where
//! P completes a state from its independent entries, so that results, projections and output do not
//! know of the partition. Steps of explicit methods need no projection; implicit methods have a
//! Jacobian without constraints ([`super::reduced`]).
//!
//! The partition stays for a step and its dense output, because f must not change within them.
//! Where its pivots have fallen it is chosen again at the accepted state, when the next step
//! begins. Near a singular configuration there is none, and a step that needs one is refused.

use model::{Mechanism, System};

use super::KeptRowMotion;
use super::project::Correct;
use crate::error::MotionFault;

/// A partition, and the state completed last.
pub(super) struct Chart {
    /// Columns of Φq along which coordinates are independent.
    pub(super) z: Vec<usize>,
    /// Independent velocities.
    pub(super) u: Vec<usize>,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// Coordinates of the last accepted state.
    accepted: Vec<f64>,
    /// Its velocities and its time.
    accepted_v: Vec<f64>,
    accepted_at: f64,
    /// How many partitions there were before.
    pub(super) generation: u64,
    /// Where this one was chosen: t, q and v.
    pub(super) origin: Origin,
    /// Where another one is due.
    renewal: Option<Origin>,
}

impl Chart {
    /// The longest way along a column of C from the last accepted state to time t at the velocities
    /// there, in its `unit`.
    fn way_to(&self, t: f64, unit: impl Fn(usize) -> f64) -> f64 {
        let velocities = self.accepted_v.iter().enumerate();
        let largest = velocities.fold(0.0, |a: f64, (j, v)| a.max(v.abs() / unit(j)));
        largest * (t - self.accepted_at).abs()
    }

    /// Takes the independent entries of a state. The others stay those of the state completed last:
    /// what an integrator carries for them may be off by as much as a step, and Newton's method
    /// would go from there to another branch or another turn.
    fn take_independent(&mut self, mechanism: &Mechanism, q: &[f64], v: &[f64]) {
        mechanism.take(&mut self.q, q, &self.z);
        for &i in &self.u {
            self.v[i] = v[i];
        }
    }
}

/// An accepted state.
#[derive(Clone)]
pub(super) struct Origin {
    pub(super) t: f64,
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
}

/// Dependent coordinates that move by more than this when a state is completed, as share of the
/// mechanism's size or in radians, may have gone to another branch or another turn.
const FAR: f64 = 0.6;

/// Beside this they may move by so many times the way that the mechanism would go from the last
/// accepted state with its rates.
const WAY: f64 = 2.0;

/// The end of a step may lie so far from where the rates at both ends lead, as share of the largest
/// way on it, and beside.
const FAR_IN_A_STEP: f64 = 0.5;
const FAR_AT_REST: f64 = 1e-2;

impl KeptRowMotion<'_> {
    /// From now on the motion is one of independent coordinates, chosen at q, which must lie on the
    /// constraints at t.
    ///
    /// ```
    /// use dynamics::{KeptRowMotion, RowChoice, prepare};
    /// use joints::Angle;
    /// use model::{Body, BodyRef, Description, Joint, Mechanism, StartOptions};
    /// // A body that does not turn: x and y are independent, its angle is not.
    /// let level = Description {
    ///     bodies: vec![Body { name: "crate".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    ///     joints: vec![Joint::new("level", &[BodyRef::Ground, BodyRef::Body(0)], Angle { angle_0: 0.0 })],
    ///     ..Description::default()
    /// };
    /// let mechanism = Mechanism::build(&level).unwrap();
    /// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
    /// let mut motion = KeptRowMotion::new(&prepared)?;
    /// motion.use_chart(0.0, &prepared.q)?;
    /// assert_eq!(motion.independent(), Some((&[0, 1][..], &[0, 1][..])));
    /// // A wrong angle in y is a guess only: ẏ = [q̇; v̇] is that of the completed state.
    /// let mut dy = [0.0; 6];
    /// motion.derivative(0.0, &[5.0, 6.0, 0.3, 7.0, 8.0, 0.2], &mut dy)?;
    /// assert_eq!(dy, [7.0, 8.0, 0.0, 0.0, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the kept rows are dependent there.
    pub fn use_chart(&mut self, t: f64, q: &[f64]) -> Result<(), MotionFault> {
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.c(&mut self.s);
        let (q, v) = (q.to_vec(), vec![0.0; self.mechanism.layout().n_v]);
        self.choose_chart(Origin { t, q, v })
    }

    /// Independent coordinates and velocities, ascending, where the motion is one of these alone.
    #[must_use]
    pub fn independent(&self) -> Option<(&[usize], &[usize])> {
        self.chart.as_ref().map(|c| (&c.z[..], &c.u[..]))
    }

    /// `ẏ = f(t, y)` of `y = [q; v]`, or `[q; v; W]` with the work W of drives and applied forces.
    /// On a chart the dependent entries of y do not matter.
    ///
    /// # Errors
    /// As [`super::Motion::acceleration`]; [`MotionFault::OffConstraints`], [`MotionFault::Chart`] if a state
    /// cannot be completed.
    ///
    /// # Panics
    /// If `y` or `dy` are shorter than n_q + n_v.
    pub fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), MotionFault> {
        self.begin_step(|accepted| t > accepted)?;
        let layout = self.mechanism.layout();
        let (q, rest) = y.split_at(layout.n_q);
        let v = &rest[..layout.n_v];
        let (qd, rest) = dy.split_at_mut(layout.n_q);
        let (a, work) = rest.split_at_mut(layout.n_v);
        let Some(mut chart) = self.chart.take() else {
            if !self.coded_stage(t, q, v, a)? {
                self.solve(t, q, v, a)?;
            }
            self.rates(q, v, a, (qd, work));
            return Ok(());
        };
        let solved = self
            .complete_on(&mut chart, t, q, v)
            .and_then(|()| self.solve_completed(&chart, a));
        if solved.is_ok() {
            self.rates(&chart.q, &chart.v, a, (qd, work));
        }
        self.chart = Some(chart);
        solved
    }

    /// The same at a state that a projection has just moved onto the constraints, where the rows
    /// are factored.
    ///
    /// # Errors
    /// As [`KeptRowMotion::derivative`].
    pub(crate) fn derivative_of_projected(
        &mut self,
        t: f64,
        y: &[f64],
        dy: &mut [f64],
    ) -> Result<(), MotionFault> {
        if self.chart.is_some() {
            return self.derivative(t, y, dy);
        }
        let layout = self.mechanism.layout();
        let (q, rest) = y.split_at(layout.n_q);
        let v = &rest[..layout.n_v];
        let (qd, rest) = dy.split_at_mut(layout.n_q);
        let (a, work) = rest.split_at_mut(layout.n_v);
        self.passage.see(&self.velocity);
        self.solve_factored(v, a)?;
        self.rates(q, v, a, (qd, work));
        Ok(())
    }

    /// q̇ and, where there is room for it, the power of drives and applied forces at a state with
    /// acceleration a.
    fn rates(&self, q: &[f64], v: &[f64], a: &[f64], (qd, work): (&mut [f64], &mut [f64])) {
        self.mechanism.rate(q, v, qd);
        if let Some(work) = work.first_mut() {
            *work = self.mechanism.energy_rate(v, a);
        }
    }

    /// Whether an evaluated state (q, v) at the end of a step is where the velocities at both ends
    /// lead: on another branch or another turn it is not.
    ///
    /// # Errors
    /// [`MotionFault::FarCompletion`]
    pub(crate) fn check_travel(&mut self, t: f64, q: &[f64], v: &[f64]) -> Result<(), MotionFault> {
        let Some(chart) = &mut self.chart else {
            return Ok(());
        };
        let (mechanism, size) = (self.mechanism, self.size);
        let dt = t - chart.accepted_at;
        let mut farthest = 0.0_f64;
        for (j, way) in self.delta.iter_mut().enumerate() {
            let (from, to) = (chart.accepted_v[j], v[j]);
            *way = 0.5 * dt * (from + to);
            farthest = farthest.max(dt * from.abs().max(to.abs()) / mechanism.unit(j, size));
        }
        self.guess.copy_from_slice(&chart.accepted);
        mechanism.displace(&mut self.guess, &self.delta);
        let (place, by) = mechanism.largest_difference(q, &self.guess, size);
        if by <= FAR_IN_A_STEP * farthest + FAR_AT_REST {
            return Ok(());
        }
        let (body, coordinate) = mechanism.coordinate(place);
        Err(MotionFault::FarCompletion {
            time: t,
            body: body.to_owned(),
            coordinate,
            by,
        })
    }

    /// Completes a state on a chart: from the state completed last or, if that was too far away,
    /// from the one accepted last, or from what the integrator carries. Where nothing is free that
    /// comes first, because nothing else tells how far the motion has gone.
    fn complete_on(
        &mut self,
        chart: &mut Chart,
        t: f64,
        q: &[f64],
        v: &[f64],
    ) -> Result<(), MotionFault> {
        let far = FAR + WAY * chart.way_to(t, |i| self.mechanism.unit(i, self.size));
        if chart.z.is_empty() {
            chart.q.copy_from_slice(q);
        }
        chart.take_independent(self.mechanism, q, v);
        let near = self.complete(t, far, &mut chart.q, &mut chart.v);
        if near.is_ok() {
            return near;
        }
        chart.q.copy_from_slice(&chart.accepted);
        chart.take_independent(self.mechanism, q, v);
        if self.complete(t, far, &mut chart.q, &mut chart.v).is_ok() {
            return Ok(());
        }
        chart.q.copy_from_slice(q);
        let carried = self.complete(t, FAR, &mut chart.q, &mut chart.v);
        if carried.is_err() {
            // Where it failed is no place to begin from.
            chart.q.copy_from_slice(&chart.accepted);
            return near;
        }
        carried
    }

    /// Solves for accelerations at the state just completed.
    fn solve_completed(&mut self, chart: &Chart, a: &mut [f64]) -> Result<(), MotionFault> {
        self.passage.see(&self.velocity);
        self.solve_factored(&chart.v, a)
    }

    /// Overwrites dependent coordinates and velocities; factors there.
    fn complete(
        &mut self,
        t: f64,
        far: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), MotionFault> {
        self.guess.copy_from_slice(q);
        self.project_position(t, q, Correct::DependentCoordinates)?;
        let (place, by) = self.mechanism.largest_difference(q, &self.guess, self.size);
        if by > far {
            let (body, coordinate) = self.mechanism.coordinate(place);
            return Err(MotionFault::FarCompletion {
                time: t,
                body: body.to_owned(),
                coordinate,
                by,
            });
        }
        self.check_positions()?;
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
    ) -> Result<(), MotionFault> {
        let Some(mut chart) = self.chart.take() else {
            return Ok(());
        };
        let completed = self.complete_on(&mut chart, t, q, v);
        if completed.is_ok() {
            q.copy_from_slice(&chart.q);
            v.copy_from_slice(&chart.v);
        }
        self.chart = Some(chart);
        completed
    }

    /// Asks for another chart where the present one is worn: at the state just evaluated, which has
    /// been accepted at t.
    pub(super) fn review_chart(&mut self, t: f64) {
        let worn = self.velocity.are_worn() || self.position.are_worn() || self.aside.is_some();
        let Some(chart) = &mut self.chart else {
            return;
        };
        chart.accepted.copy_from_slice(&chart.q);
        chart.accepted_v.copy_from_slice(&chart.v);
        chart.accepted_at = t;
        if worn {
            let (q, v) = (chart.q.clone(), chart.v.clone());
            chart.renewal = Some(Origin { t, q, v });
        }
    }

    /// Chooses the chart that has been asked for, if a step has begun: whether one has is told by
    /// the time of the accepted state.
    pub(super) fn begin_step(
        &mut self,
        has_begun: impl Fn(f64) -> bool,
    ) -> Result<(), MotionFault> {
        let due = self.chart.as_ref().and_then(|c| c.renewal.as_ref());
        let Some(origin) = due.filter(|origin| has_begun(origin.t)).cloned() else {
            return Ok(());
        };
        self.mechanism.pose(origin.t, &origin.q, &mut self.s);
        self.mechanism.phi(&mut self.s);
        self.mechanism.c(&mut self.s);
        // Whether other rows are due is judged without a partition.
        self.velocity.forget_partition();
        self.position.forget_partition();
        self.velocity.factor(self.mechanism, &self.s)?;
        self.position.factor(self.mechanism, &self.s)?;
        if let Some(event) = self.review(&origin.q)? {
            self.pending = Some(event);
        }
        self.choose_chart(origin)
    }

    /// Partitions the rows at the pose of the scratch, which is that of the origin.
    fn choose_chart(&mut self, origin: Origin) -> Result<(), MotionFault> {
        let (mechanism, s) = (self.mechanism, &self.s);
        // Far from the origin places are known to fewer digits than angles.
        let place = |j: usize| mechanism.position(&origin.q, j).abs();
        let far = |j: usize| (place(j) / mechanism.unit(j, self.size)).max(1.0);
        let z = self.position.partition(mechanism, s, far)?;
        let u = self.velocity.partition(mechanism, s, |_| 1.0)?;
        // Rows set aside are only solved on, at single instants.
        if let Some(aside) = &mut self.aside {
            aside.forget_partition();
        }
        let generation = self.chart.as_ref().map_or(0, |c| c.generation + 1);
        self.chart = Some(Chart {
            z,
            u,
            q: origin.q.clone(),
            v: origin.v.clone(),
            accepted: origin.q.clone(),
            accepted_v: origin.v.clone(),
            accepted_at: origin.t,
            generation,
            origin,
            renewal: None,
        });
        Ok(())
    }
}
