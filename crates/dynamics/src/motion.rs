//! The solved equations of motion on kept rows.
//!
//! The rank is never re-decided at a stage, where the state is off the constraints by δ and a
//! singular value that is exactly zero reads as about δ. The dropped rows are only monitored, at
//! accepted steps: their residual after projection is a free certificate of redundancy. Kept rows
//! may become nearly dependent although the rank stays (an edge turns until it no longer carries
//! what a dropped row carried): then, at an accepted and polished point, other rows are kept, which
//! changes no motion.
//!
//! Positions and velocities have rows of their own. A holonomic row may be dropped because knife
//! edges imply its velocity; nothing implies its position, and without it the configuration would
//! drift.

mod chart;
mod coded;
mod impulse;
mod locate;
mod passage;
mod project;
mod reduced;
mod review;
mod rows;
mod stabilise;

use std::sync::Arc;

use model::{Mechanism, Scratch, System};

use crate::counts::{Counted, note};
use crate::error::MotionFault;
use crate::events::Event;
use crate::options::{MotionOptions, RowChoice, Stabilisation};
use crate::prepare::Prepared;
use chart::Chart;
use coded::Coded;
pub(crate) use locate::Singular;
use passage::Passage;
use rows::KeptRows;
pub(crate) use rows::{is_far, is_sparse, mass_spread, memory};

pub use reduced::Reduced;

/// Equations solved for what moves.
pub trait Motion {
    /// `v̇` from `M·v̇ + C_Kᵀ·λ_K = Q`, `C_K·v̇ = Γ_K`.
    ///
    /// # Errors
    /// If the equations have no (unique) solution here.
    fn acceleration(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        a: &mut [f64],
    ) -> Result<(), MotionFault>;

    /// Moves q and v onto the constraints by the smallest correction in the mass metric, and checks
    /// the dropped rows.
    ///
    /// # Errors
    /// If that fails, or a dropped row is violated.
    fn project(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<Correction, MotionFault>;

    /// Multipliers of all rows: those of dropped rows are zero by decree, and all are NaN where the
    /// kept rows are dependent at just this instant, so that no multipliers belong to them.
    ///
    /// # Errors
    /// As [`Motion::acceleration`].
    fn multipliers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), MotionFault>;
}

/// What a projection found and did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    /// Corrections of the position made.
    pub iterations: usize,
    /// Largest |Φ| afterwards, all rows.
    pub position_residual: f64,
    /// Largest |C·v − b| afterwards, all rows.
    pub velocity_residual: f64,
}

/// A mechanism on kept rows. All storage is made here; accelerations and projections allocate
/// nothing.
pub struct KeptRowMotion<'a> {
    mechanism: &'a Mechanism,
    s: Scratch,
    /// Length by which positions are measured (m).
    size: f64,
    /// How long the run lasts (s); infinite where nobody has said, and where it takes no time:
    /// nothing may part then.
    horizon: f64,
    choice: RowChoice,
    /// Independent rows of C.
    velocity: KeptRows,
    /// Rows that the user chose, while they are nearly dependent and others are kept.
    aside: Option<KeptRows>,
    /// Independent rows of Φq.
    position: KeptRows,
    /// Independent coordinates, where the motion is one of these alone.
    chart: Option<Chart>,
    stabilisation: Stabilisation,
    /// Generated code, where there is some that may be used.
    coded: Option<Coded>,
    /// Whether a singular configuration is passed.
    passage: Passage,
    /// Whether other rows hold the position since it was settled.
    is_unsettled: bool,
    /// What happened at the last accepted steps and has not been told.
    pending: Option<Event>,
    /// A configuration before it was completed, n_q.
    guess: Vec<f64>,
    /// A correction, n_v.
    delta: Vec<f64>,
    /// No force, n_v.
    zero: Vec<f64>,
}

impl<'a> KeptRowMotion<'a> {
    /// The motion of a prepared mechanism on kept rows, with projection and by the interpreter.
    ///
    /// # Errors
    /// If more rows are kept than there are velocities.
    pub fn new(prepared: &'a Prepared) -> Result<Self, MotionFault> {
        Self::kept(prepared, Stabilisation::Projection)
    }

    /// The motion of a prepared mechanism with the method and stabilisation of a run; on generated
    /// code, if there is some for it.
    ///
    /// # Errors
    /// As [`KeptRowMotion::new`]; also if no independent coordinates can be chosen for an implicit
    /// method.
    pub fn with(prepared: &'a Prepared, options: &MotionOptions) -> Result<Self, MotionFault> {
        let mut motion = Self::kept(prepared, options.stabilisation)?;
        if options.t_end > 0.0 {
            motion.horizon = options.t_end;
        }
        if options.method.needs_independent_coordinates() {
            motion.use_chart(0.0, &prepared.q)?;
        }
        if let Ok(code) = prepared.code_for(options) {
            motion.use_code(Arc::clone(code), 0.0, &prepared.q);
        }
        Ok(motion)
    }

    fn kept(prepared: &'a Prepared, stabilisation: Stabilisation) -> Result<Self, MotionFault> {
        let n = prepared.mechanism.layout().n_v;
        let rows = |d: &solvability::RowDecision| {
            KeptRows::new(
                &prepared.mechanism,
                prepared.assembly.size,
                &d.kept,
                &d.dropped,
            )
            .map_err(|source| MotionFault::Saddle { time: 0.0, source })
        };
        Ok(Self {
            mechanism: &prepared.mechanism,
            s: prepared.mechanism.scratch(),
            size: prepared.assembly.size,
            horizon: f64::INFINITY,
            choice: prepared.choice.clone(),
            velocity: rows(&prepared.decision)?,
            aside: None,
            position: rows(&prepared.position_decision)?,
            chart: None,
            stabilisation,
            coded: None,
            passage: Passage::default(),
            is_unsettled: false,
            pending: None,
            guess: vec![0.0; prepared.mechanism.layout().n_q],
            delta: vec![0.0; n],
            zero: vec![0.0; n],
        })
    }

    /// The mechanism.
    #[must_use]
    pub fn mechanism(&self) -> &'a Mechanism {
        self.mechanism
    }

    /// Length by which positions are measured (m).
    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// Results of the last evaluation: poses, forces, …
    #[must_use]
    pub fn scratch(&self) -> &Scratch {
        &self.s
    }

    /// Smallest pivot of the last factorisation relative to its row: small near singular
    /// configurations.
    #[must_use]
    pub fn pivot_ratio(&self) -> f64 {
        self.velocity.pivot_ratio()
    }

    /// Whether the motion is so near to a singular configuration that stages have to lie on the
    /// constraints: off them by δ, accelerations are wrong by δ divided by the share of the
    /// reference pivots that is left.
    pub(crate) fn is_delicate(&self) -> bool {
        self.velocity.are_delicate()
    }

    /// The same relative to that when the rows were chosen.
    pub(crate) fn relative_pivot(&self) -> f64 {
        self.velocity.relative_pivot()
    }

    /// Degrees of freedom.
    pub(crate) fn mobility(&self) -> usize {
        self.mechanism.layout().n_v - self.velocity.kept.len()
    }

    /// Whether accelerations at coordinates q are refined.
    ///
    /// # Errors
    /// If the equations have no unique solution here.
    pub(crate) fn is_refined_at(&mut self, t: f64, q: &[f64]) -> Result<bool, MotionFault> {
        let Self {
            mechanism,
            s,
            velocity,
            ..
        } = self;
        mechanism.pose(t, q, s);
        mechanism.c(s);
        velocity.factor(mechanism, s)?;
        Ok(velocity.are_refined())
    }

    /// b at the pose of the scratch.
    fn evaluate_b(&mut self) {
        if self.mechanism.layout().rheonomic {
            self.mechanism.b(&mut self.s);
        }
    }

    /// Solves for accelerations.
    fn solve(&mut self, t: f64, q: &[f64], v: &[f64], a: &mut [f64]) -> Result<(), MotionFault> {
        let Self {
            mechanism,
            s,
            velocity,
            passage,
            ..
        } = self;
        mechanism.pose(t, q, s);
        mechanism.c(s);
        velocity.factor(mechanism, s)?;
        passage.see(velocity);
        self.solve_factored(v, a)
    }

    /// The same where the pose is taken and the rows are factored.
    fn solve_factored(&mut self, v: &[f64], a: &mut [f64]) -> Result<(), MotionFault> {
        note(Counted::Accelerations);
        self.mechanism.twist(v, &mut self.s);
        self.mechanism.gamma(&mut self.s);
        self.mechanism.force(&mut self.s);
        let Self {
            mechanism,
            s,
            velocity,
            ..
        } = self;
        for (rhs, &i) in velocity.rhs.iter_mut().zip(&velocity.kept) {
            *rhs = s.gamma[i];
        }
        let solved = velocity.accelerate(mechanism, s, a);
        solved.map_err(|fault| self.named(fault))
    }

    /// An error at the state just evaluated, with the name of the force that has no value, if there
    /// is one.
    fn named(&mut self, fault: MotionFault) -> MotionFault {
        match fault {
            MotionFault::NotFinite { time, what } => {
                let force = self.mechanism.undefined_force(&mut self.s);
                let what = force.map_or(what, |name| format!("the force `{name}`"));
                MotionFault::NotFinite { time, what }
            }
            other => other,
        }
    }

    /// Multipliers of all rows for accelerations a from the last solve; those of dropped rows are
    /// zero.
    fn multipliers_for(&mut self, a: &[f64], lambda: &mut [f64]) -> Result<(), MotionFault> {
        let Self {
            mechanism,
            s,
            velocity,
            ..
        } = self;
        velocity.find_multipliers(mechanism, s, a)?;
        lambda.fill(0.0);
        for (&i, &l) in velocity.kept.iter().zip(&velocity.lambda) {
            lambda[i] = l;
        }
        Ok(())
    }
}

impl Motion for KeptRowMotion<'_> {
    fn acceleration(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        a: &mut [f64],
    ) -> Result<(), MotionFault> {
        match self.coded_acceleration(t, q, v, a) {
            true => Ok(()),
            false => self.solve(t, q, v, a),
        }
    }

    fn project(&mut self, t: f64, q: &mut [f64], v: &mut [f64]) -> Result<Correction, MotionFault> {
        self.complete_row(t, q, v)?;
        let iterations = self.settle(t, q)?;
        self.finish(v, iterations)
    }

    fn multipliers(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        lambda: &mut [f64],
    ) -> Result<(), MotionFault> {
        note(Counted::Multipliers);
        if self.coded_multipliers(t, q, v, lambda) {
            return Ok(());
        }
        self.swap_aside();
        let mut a = std::mem::take(&mut self.delta);
        let solved = self
            .solve(t, q, v, &mut a)
            .and_then(|()| self.multipliers_for(&a, lambda));
        self.delta = a;
        let left_out = self.velocity.n_left_out();
        self.swap_aside();
        solved?;
        if left_out > 0 {
            lambda.fill(f64::NAN);
        }
        Ok(())
    }
}
