//! The motion of a mechanism on independent rows. This module combines the equations (`solve`), the
//! constraints (`manifold`) and the monitors (`watch`). The independent rows may become
//! ill-conditioned although the rank stays the same, for example if a knife edge rotates. The
//! motion then continues with other independent rows from an accepted and corrected state. This
//! exchange does not change the motion.
//!
//! The rows that the user requests to drop are dropped again as soon as the other rows are
//! independent again. Reactions always belong to the requested choice of rows.

use model::{Mechanism, Scratch, System};
use solvability::ChosenValues;

use crate::code::SceneCode;
use crate::counts::{WorkKind, note};
use crate::error::MotionFault;
use crate::events::Event;
use crate::guards::GUARDED;
use crate::manifold::{Correction, Manifold, Origin, inspect};
use crate::options::MotionOptions;
use crate::prepare::PreparedMechanism;
use crate::solve::{Accelerations, Evaluation, KeptEquations, KeptRows, Misfits, State};
use crate::watch::{CodeSwitch, Monitors, Next, are_worn};

/// A mechanism on independent rows. All memory is allocated when the motion is created.
/// Accelerations and projections allocate no memory.
pub struct KeptRowMotion<'m> {
    pub(crate) equations: KeptEquations<'m>,
    pub(crate) manifold: Manifold,
    pub(crate) watch: Monitors,
    /// Generated code, if available and usable.
    pub(crate) code: Option<CodeSwitch<'m>>,
}

impl<'m> KeptRowMotion<'m> {
    /// Creates the motion of a prepared mechanism on independent rows, with projection and without
    /// generated code.
    ///
    /// # Errors
    /// Returns an error if there are more independent rows than velocities.
    pub fn new(prepared: &'m PreparedMechanism) -> Result<Self, MotionFault> {
        Self::interpreted(prepared, &MotionOptions::to(0.0))
    }

    /// Creates the motion of a prepared mechanism with the method and stabilisation of a run, and
    /// with generated code if available.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowMotion::new`]. Also returns an error if no independent
    /// coordinates can be chosen for an implicit method.
    pub fn with(
        prepared: &'m PreparedMechanism,
        options: &MotionOptions,
    ) -> Result<Self, MotionFault> {
        Self::evaluated(prepared, options, None)
    }

    /// Works like [`KeptRowMotion::with`]. `evaluator` evaluates the generated code if the motion
    /// uses generated code.
    pub(crate) fn evaluated(
        prepared: &'m PreparedMechanism,
        options: &MotionOptions,
        evaluator: Option<&'m dyn SceneCode>,
    ) -> Result<Self, MotionFault> {
        let mut motion = Self::interpreted(prepared, options)?;
        if options.method.needs_independent_coordinates() {
            motion.use_independent_coordinates(prepared.start_time(), &prepared.q)?;
        }
        if let Ok(code) = prepared.code_for(options) {
            motion.code = Some(CodeSwitch::new(
                evaluator.unwrap_or(&**code),
                &mut motion.equations,
                (prepared.start_time(), &prepared.q),
            ));
        }
        Ok(motion)
    }

    fn interpreted(
        prepared: &'m PreparedMechanism,
        options: &MotionOptions,
    ) -> Result<Self, MotionFault> {
        let at = Evaluation::new(&prepared.mechanism, prepared.assembly.size);
        let needs = prepared.solver_needs(options.method);
        let velocity = KeptRows::new(&at, &prepared.decision, needs)?;
        let position = KeptRows::new(&at, &prepared.position_decision, needs)?;
        let horizon = options.t_end - prepared.start_time();
        let horizon = if horizon > 0.0 {
            horizon
        } else {
            f64::INFINITY
        };
        let mut equations = KeptEquations::new(at, velocity, position);
        if prepared.may_miss {
            equations.at.pose(prepared.start_time(), &prepared.q);
            equations.misfits = Some(Box::new(Misfits::new(&equations.at)));
        }
        Ok(Self {
            manifold: Manifold::new(&equations.at, options.stabilisation, horizon),
            watch: Monitors::new(&prepared.choice, options),
            equations,
            code: None,
        })
    }

    /// Returns the mechanism of the motion.
    #[must_use]
    pub fn mechanism(&self) -> &'m Mechanism {
        self.equations.at.mechanism
    }

    /// Returns the results of the last evaluation, such as poses and forces.
    #[must_use]
    pub fn scratch(&self) -> &Scratch {
        &self.equations.at.s
    }

    /// Returns the smallest pivot of the last factorisation relative to its row. The value is small
    /// near singular configurations.
    #[must_use]
    pub fn pivot_ratio(&self) -> f64 {
        self.equations.velocity.pivot_ratio()
    }

    /// Changes to a formulation with independent coordinates, which are chosen at the configuration
    /// q. This configuration must satisfy the constraints at time t.
    ///
    /// ```
    /// use pfaff_dynamics::{KeptRowMotion, RowChoice, prepare};
    /// use joints::Angle;
    /// use model::{Body, BodyRef, Description, Joint, Mechanism, StartOptions};
    /// // A body that does not rotate: x and y are independent, its angle is not.
    /// let level = Description {
    ///     bodies: vec![Body { name: "crate".into(), mass: 1.0, inertia: 1.0, ..Body::default() }],
    ///     joints: vec![Joint::new("level", &[BodyRef::Ground, BodyRef::Body(0)], Angle::new())],
    ///     ..Description::default()
    /// };
    /// let mechanism = Mechanism::build(&level).unwrap();
    /// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
    /// let mut motion = KeptRowMotion::new(&prepared)?;
    /// motion.use_independent_coordinates(0.0, &prepared.q)?;
    /// assert_eq!(motion.independent(), Some((&[0, 1][..], &[0, 1][..])));
    /// // A wrong angle in y is a guess only: ẏ = [q̇; v̇] belongs to the completed state.
    /// let mut dy = [0.0; 6];
    /// motion.derivative(0.0, &[5.0, 6.0, 0.3, 7.0, 8.0, 0.2], &mut dy)?;
    /// assert_eq!(dy, [7.0, 8.0, 0.0, 0.0, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns an error if the independent rows are dependent at this configuration.
    pub fn use_independent_coordinates(&mut self, t: f64, q: &[f64]) -> Result<(), MotionFault> {
        self.equations.at.pose(t, q);
        let (q, v) = (q.to_vec(), vec![0.0; self.mechanism().layout().n_v]);
        self.manifold
            .choose_coordinates(&mut self.equations, Origin { t, q, v })
    }

    /// Returns the independent coordinates and velocities, ascending. Returns `None` if the motion
    /// uses all coordinates.
    #[must_use]
    pub fn independent(&self) -> Option<(&[usize], &[usize])> {
        let coordinates = self.manifold.coordinates.as_ref();
        coordinates.map(|c| (&c.partition.z[..], &c.partition.u[..]))
    }

    /// Returns whether the motion uses generated code.
    pub(crate) fn is_on_code(&self) -> bool {
        self.code.as_ref().is_some_and(CodeSwitch::is_in_use)
    }

    /// Accepts the start as the first state.
    pub(crate) fn begin(&mut self, t: f64, q: &mut [f64]) -> Result<(), MotionFault> {
        self.manifold.settle(&mut self.equations, t, q)?;
        self.watch.passage.take(&mut self.equations.velocity, t);
        Ok(())
    }

    /// Chooses new independent coordinates if necessary and if a step has started.
    pub(crate) fn begin_step(
        &mut self,
        has_begun: impl Fn(f64) -> bool,
    ) -> Result<(), MotionFault> {
        let mechanism = self.mechanism();
        let Some(coordinates) = &mut self.manifold.coordinates else {
            return Ok(());
        };
        coordinates.begin_step(mechanism, &has_begun);
        let Some(origin) = coordinates.due(has_begun) else {
            return Ok(());
        };
        let equations = &mut self.equations;
        equations.at.pose_and_phi(origin.t, &origin.q);
        // An exchange of rows is decided without a partition.
        for rows in [&mut equations.velocity, &mut equations.position] {
            rows.forget_partition();
            rows.factor(&equations.at)?;
        }
        match self.watch.judge_rows(equations, &origin.q) {
            Next::Stop(fault) => return Err(fault),
            Next::Keep(rows) => self.watch.tell_later(rows.keep(equations)?.1),
            Next::Accept | Next::Reject => {}
        }
        self.manifold.choose_coordinates(equations, origin)
    }

    /// Computes `v̇` from `M·v̇ + C_Kᵀ·λ_K = Q`, `C_K·v̇ = Γ_K`.
    ///
    /// # Errors
    /// Returns an error if the equations have no unique solution at this state.
    pub fn acceleration(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        a: &mut [f64],
    ) -> Result<(), MotionFault> {
        let state = State { t, q, v };
        let code = self.code.as_mut().and_then(CodeSwitch::in_use);
        if code.is_some_and(|code| code.accelerations(state, a).is_ok()) {
            Ok(())
        } else {
            self.interpret(state, a)
        }
    }

    /// Moves q and v onto the constraint manifold by the smallest correction in the mass metric,
    /// and checks the redundant rows.
    ///
    /// # Errors
    /// Returns an error if the projection fails, or a redundant row is violated.
    pub fn project(
        &mut self,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) -> Result<Correction, MotionFault> {
        self.manifold.project(&mut self.equations, t, (q, v))
    }

    /// Returns the multipliers of all rows. The multipliers of redundant rows are zero. All
    /// multipliers are NaN if the independent rows are dependent at exactly this instant, because
    /// the multipliers are then not defined.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowMotion::acceleration`].
    pub fn multipliers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut ChosenValues<f64>,
    ) -> Result<(), MotionFault> {
        lambda.choose(self.equations.without_multiplier());
        self.write_multipliers(t, q, v, lambda.to_be_written())
    }

    /// Works like [`Self::multipliers`], but writes only the values.
    pub(crate) fn write_multipliers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), MotionFault> {
        note(WorkKind::Multipliers);
        let state = State { t, q, v };
        let code = self.code.as_mut().and_then(CodeSwitch::in_use);
        if code.is_some_and(|code| code.multipliers(state, lambda).is_ok()) {
            // Reactions need the pose.
            self.equations.at.pose(t, q);
            return Ok(());
        }
        let found = self.equations.multipliers(state, lambda);
        self.watch.passage.see(&self.equations.velocity);
        found
    }

    /// Evaluates `ẏ = f(t, y)` for `y = [q; v]`, or `[q; v; W]` with the work W of drives and
    /// applied forces. With independent coordinates the dependent entries of y have no effect.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowMotion::acceleration`]. Also returns
    /// [`MotionFault::OffConstraints`] or [`MotionFault::IndependentCoordinates`] if a state cannot
    /// be completed.
    ///
    /// # Panics
    /// Panics if `y` or `dy` are shorter than n_q + n_v.
    pub fn derivative(&mut self, t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), MotionFault> {
        self.begin_step(|accepted| t > accepted)?;
        let (q, v) = self.parts(y);
        let (qd, a, power) = self.parts_mut(dy);
        if let Some(coordinates) = &mut self.manifold.coordinates {
            coordinates.complete(&mut self.equations, t, q, v)?;
            self.watch.passage.see(&self.equations.velocity);
            self.equations.solve_factored(&coordinates.v, a)?;
            let state = (&coordinates.q[..], &coordinates.v[..], &*a);
            rates(&self.equations.at, state, (qd, power));
            return Ok(());
        }
        let state = State { t, q, v };
        let is_evaluated = match &mut self.code {
            Some(code) => {
                let answered = code.evaluate(state, a, (&self.equations, &self.watch));
                if !answered {
                    code.wake_up(&mut self.equations, &mut self.manifold, &mut self.watch)?;
                }
                answered
            }
            None => false,
        };
        if !is_evaluated {
            self.interpret(state, a)?;
        }
        rates(&self.equations.at, (q, v, a), (&mut *qd, power));
        self.mechanism().state_rates(&self.equations.at.s, qd);
        Ok(())
    }

    /// Works like [`Self::derivative`], at a state that a projection has just moved onto the
    /// constraint manifold. The rows must be factored at this state.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowMotion::derivative`].
    pub(crate) fn derivative_of_projected(
        &mut self,
        t: f64,
        y: &[f64],
        dy: &mut [f64],
    ) -> Result<(), MotionFault> {
        if self.manifold.coordinates.is_some() {
            return self.derivative(t, y, dy);
        }
        let (q, v) = self.parts(y);
        let (qd, a, power) = self.parts_mut(dy);
        self.solve_factored(v, a)?;
        rates(&self.equations.at, (q, v, a), (&mut *qd, power));
        self.mechanism().state_rates(&self.equations.at.s, qd);
        Ok(())
    }

    /// Computes the accelerations of a stage without generated code.
    fn interpret(&mut self, state: State<'_>, a: &mut [f64]) -> Result<(), MotionFault> {
        self.equations.factor_at(state.t, state.q)?;
        self.solve_factored(state.v, a)
    }

    /// Computes the accelerations. The pose must be evaluated, and the rows must be factored.
    pub(crate) fn solve_factored(&mut self, v: &[f64], a: &mut [f64]) -> Result<(), MotionFault> {
        self.watch.passage.see(&self.equations.velocity);
        self.equations.solve_factored(v, a)
    }

    /// Returns the multipliers of all rows for the accelerations a of the last evaluation.
    pub(crate) fn multipliers_for(
        &mut self,
        a: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), MotionFault> {
        note(WorkKind::Multipliers);
        self.equations.multipliers_for(a, lambda)
    }

    /// Returns the parts q and v of y.
    pub(crate) fn parts<'y>(&self, y: &'y [f64]) -> (&'y [f64], &'y [f64]) {
        let layout = self.mechanism().layout();
        let (q, rest) = y.split_at(layout.n_q);
        (q, &rest[..layout.n_v])
    }

    /// Returns the parts q and v of y, and the work if y contains the work. If y contains rates,
    /// the parts are rates.
    pub(crate) fn parts_mut<'y>(
        &self,
        y: &'y mut [f64],
    ) -> (&'y mut [f64], &'y mut [f64], Option<&'y mut f64>) {
        let layout = self.mechanism().layout();
        let (q, rest) = y.split_at_mut(layout.n_q);
        let (v, work) = rest.split_at_mut(layout.n_v);
        (q, v, work.first_mut())
    }

    /// Moves the end of a step that passed its error test onto the constraint manifold, or computes
    /// the residuals of the end. Selects other independent rows if the current rows are
    /// ill-conditioned at the end. If `has_to_end` is true, the step ends at t at any
    /// configuration. Events are reported when the step is accepted.
    pub(crate) fn end_step(
        &mut self,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
        has_to_end: bool,
    ) -> Result<Correction, Next> {
        let Self {
            equations,
            manifold,
            watch,
            code,
        } = self;
        if let Some(code) = code.as_mut().filter(|code| code.is_in_use()) {
            return match code.project(equations, t, (q, v)) {
                Ok(found) => Ok(found),
                Err(doubt) => {
                    code.leave(t, doubt, (equations, watch));
                    code.wake_up(equations, manifold, watch)?;
                    Err(Next::Reject)
                }
            };
        }
        if !manifold.projects() {
            return self.end_unprojected_step(t, (q, v), has_to_end);
        }
        let corrections = manifold.settle_completed(equations, t, (&mut *q, &mut *v))?;
        watch.judge_place(equations, t, has_to_end).stands()?;
        // With independent coordinates, rows are exchanged when the next step starts.
        if GUARDED
            && manifold.coordinates.is_none()
            && let Some(rows) = watch.judge_rows(equations, q).stands()?
        {
            let (moves, event) = rows.keep(equations)?;
            watch.tell_later(event);
            if moves {
                manifold.settle(equations, t, q)?;
            }
        }
        Ok(manifold.finish(equations, v, corrections)?)
    }

    /// Works like [`Self::end_step`], for states without projection. The independent rows are
    /// nevertheless monitored.
    fn end_unprojected_step(
        &mut self,
        t: f64,
        (q, v): (&[f64], &[f64]),
        has_to_end: bool,
    ) -> Result<Correction, Next> {
        let (equations, watch) = (&mut self.equations, &mut self.watch);
        let found = inspect(equations, t, q, v)?;
        watch.judge_place(equations, t, has_to_end).stands()?;
        if !watch.may_exchange(equations) {
            return Ok(found);
        }
        // The rank is decided only at configurations on the constraint manifold.
        let mut polished = q.to_vec();
        self.manifold.settle(equations, t, &mut polished)?;
        if let Some(rows) = watch.judge_rows(equations, &polished).stands()? {
            watch.tell_later(rows.keep(equations)?.1);
        }
        Ok(inspect(equations, t, q, v)?)
    }

    /// Accepts the state just evaluated as the end of a step to t.
    pub(crate) fn accept(&mut self, t: f64, may_have_passed: bool) -> Option<Event> {
        let is_worn = are_worn(&self.equations);
        if let Some(coordinates) = &mut self.manifold.coordinates {
            coordinates.accept(t, is_worn);
        }
        self.watch.accept(&mut self.equations, t, may_have_passed)
    }

    /// Completes an output row: projects the row, or computes its residuals. Redundant rows are
    /// checked in both cases.
    ///
    /// # Errors
    /// Returns the same errors as [`KeptRowMotion::project`].
    pub(crate) fn end_row(
        &mut self,
        t: f64,
        (q, v): (&mut [f64], &mut [f64]),
    ) -> Result<Correction, MotionFault> {
        let Self {
            equations,
            manifold,
            watch,
            code,
        } = self;
        if let Some(code) = code.as_mut().filter(|code| code.is_in_use())
            && let Ok(found) = code.project(equations, t, (&mut *q, &mut *v))
        {
            return Ok(found);
        }
        if !manifold.projects() {
            let mut polished = (q.to_vec(), v.to_vec());
            manifold.project(equations, t, (&mut polished.0, &mut polished.1))?;
            let state = State {
                t,
                q: &polished.0,
                v: &polished.1,
            };
            self.interpret(state, &mut vec![0.0; v.len()])?;
            return inspect(&mut self.equations, t, q, v);
        }
        let mut corrections = manifold.settle_completed(equations, t, (&mut *q, &mut *v))?;
        if manifold.coordinates.is_some() {
            return manifold.finish(equations, v, corrections);
        }
        if let Some(rows) = watch.position_rows_for_output(equations, q)? {
            let kept = std::mem::replace(&mut equations.position, rows);
            let settled = manifold.settle(equations, t, q);
            equations.position = kept;
            corrections += settled?;
        }
        let Some(rows) = watch.rows_for_output(equations, q)? else {
            return manifold.finish(equations, v, corrections);
        };
        let kept = std::mem::replace(&mut equations.velocity, rows);
        let found = manifold.finish(equations, v, corrections);
        equations.velocity = kept;
        found
    }
}

/// Computes q̇. If `rates` has an entry for the power, the function also computes the power of
/// drives and applied forces at a state with acceleration a.
fn rates(
    Evaluation { mechanism, s, .. }: &Evaluation<'_>,
    (q, v, a): (&[f64], &[f64], &[f64]),
    (qd, power): (&mut [f64], Option<&mut f64>),
) {
    mechanism.rate(q, v, qd);
    if let Some(power) = power {
        *power = mechanism.energy_rate(s, v, a);
    }
}
