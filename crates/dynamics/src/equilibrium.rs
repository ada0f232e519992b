//! Finds a static equilibrium near an initial state. The equilibrium satisfies Φ(q, t) = 0, v = 0
//! and `Zᵀ·Q(q, 0, t) = 0` at the initial time t. Z is a basis of the velocities that the rows
//! allow.
//!
//! Each step of the search follows the unbalanced forces and solves `(K + μ·I)·y = Zᵀ·Q`. K is the
//! stiffness of the forces and of the multipliers. μ makes `K + μ·I` positive definite and limits
//! the length of the step. Near an equilibrium the search is Newton's method. Because the steps
//! follow the forces, a potential decreases at each step. The search moves away from a maximum of
//! the potential as soon as a force acts. Masses have no influence.
//!
//! Sources: C. T. Kelley, D. E. Keyes, Convergence analysis of pseudo-transient continuation, SIAM
//! J. Numer. Anal. 35 (1998) 508–523; J. J. Moré, D. C. Sorensen, Computing a trust region step,
//! SIAM J. Sci. Stat. Comput. 4 (1983) 553–572.

mod balance;
mod error;
mod fall;
mod stiffness;
mod words;

use crate::held::accelerated;
use crate::limits::{
    REST_LEFT, REST_LONGEST, REST_PUSH, REST_PUSHES, REST_RADIUS, REST_ROUNDINGS, REST_SHORTEST,
    REST_STALLED, REST_STEPS, UNRESISTED, UNRESISTED_FORCE, UNRESISTED_STEPS,
};
use crate::prepare::PreparedMechanism;
use balance::{Balance, Statics};
use linalg::kernels::{dot, norm};
use model::StartError;
use stiffness::{Stiffness, Way};

pub use error::{EquilibriumError, UnbalancedForce};

/// Options of a search for an equilibrium.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EquilibriumOptions {
    /// Whether the search continues after a small displacement if it finds an equilibrium that is
    /// not a minimum of the potential.
    pub stable: bool,
}

/// A static equilibrium.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Equilibrium {
    /// Time (s).
    pub time: f64,
    /// Coordinates, n_q.
    pub q: Vec<f64>,
    /// Number of steps of the search.
    pub steps: usize,
    /// Number of small displacements. After each displacement, the search continued from an
    /// equilibrium that is not a minimum of the potential.
    pub pushes: usize,
    /// Largest remaining force or torque along a free motion, divided by the largest acting force
    /// or torque.
    pub residual: f64,
    /// Largest acting force, or torque divided by the size of the mechanism (N).
    pub largest_force: f64,
    /// Stability of the equilibrium against small displacements.
    pub stability: RestStability,
    /// Descriptions of the free motions along which neither a force nor a stiffness acts. The
    /// search does not move the mechanism along these motions.
    pub idle: Vec<String>,
    /// Descriptions of the unstable free motions. Along these motions, the forces drive the
    /// mechanism away from the equilibrium.
    pub falling: Vec<String>,
    /// Whether the equilibrium depends on the path of the search. The equilibrium depends on the
    /// path if nonholonomic rows restrict the path but not the position.
    pub depends_on_way: bool,
    /// Drives and joints that are locked in this analysis, but accelerate immediately in a run
    /// because of their functions of time.
    pub moving_on: Vec<String>,
}

/// Stability of an equilibrium against small displacements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum RestStability {
    /// No motion is possible.
    Immovable,
    /// The potential has a minimum at the equilibrium.
    Stable,
    /// No motion is unstable, but some motions have no stiffness.
    Idle,
    /// The equilibrium is not a minimum of the potential. The forces increase some small
    /// displacements.
    Unstable,
    /// Stability is not analysed because of nonholonomic rows.
    Nonholonomic,
    /// Stability is not analysed because forces have no potential.
    NoPotential,
}

impl RestStability {
    /// Returns the name of the result in output.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Immovable => "immovable",
            Self::Stable => "stable",
            Self::Idle => "idle",
            Self::Unstable => "unstable",
            Self::Nonholonomic | Self::NoPotential => "not_judged",
        }
    }

    /// Returns the reason why stability is not analysed.
    #[must_use]
    pub fn why_not(self) -> Option<&'static str> {
        match self {
            Self::Nonholonomic => Some(
                "with nonholonomic rows the position depends on the path, so no potential exists",
            ),
            Self::NoPotential => Some("the forces have no potential"),
            _ => None,
        }
    }
}

/// Finds a static equilibrium near the initial configuration of a prepared mechanism, at the
/// initial time. The initial velocities have no influence.
///
/// ```
/// use pfaff_dynamics::equilibrium::{EquilibriumOptions, RestStability, equilibrium};
/// use pfaff_dynamics::{RowChoice, prepare};
/// use joints::Revolute;
/// use model::{Body, BodyRef, Description, Mechanism, StartOptions};
///
/// // The start is 1e-3 m from the upright position; the pendulum hangs in the equilibrium.
/// let mut d = Description { gravity: [0.0, -9.81], ..Description::new("pendulum") };
/// let bob = d.body(Body { position: [1e-3, 1.0], ..Body::new("bob", 1.0, 0.1) });
/// d.joint("pivot", &[BodyRef::Ground, bob], Revolute { s_i: [0.0; 2], s_j: [-1e-3, -1.0] });
/// let mechanism = Mechanism::build(&d).unwrap();
/// let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)?;
/// let found = equilibrium(&prepared, &EquilibriumOptions::default())?;
/// assert!(found.q[0].abs() < 1e-15 && (found.q[1] + 1.0).abs() < 1e-6);
/// assert_eq!(found.stability, RestStability::Stable);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// - [`EquilibriumError::Prescribed`]: a drive or a joint prescribes a velocity.
/// - [`EquilibriumError::Pushed`]: a force acts along a free motion at any distance that the
///   mechanism moves.
/// - [`EquilibriumError::NotFound`], [`EquilibriumError::Blocked`]: the search did not converge.
/// - [`EquilibriumError::NoDerivatives`]: a force calls a function.
/// - [`EquilibriumError::Start`], [`EquilibriumError::NotFinite`]: an intermediate configuration
///   cannot be assembled, or a force has no finite value at this configuration.
pub fn equilibrium(
    prepared: &PreparedMechanism,
    options: &EquilibriumOptions,
) -> Result<Equilibrium, EquilibriumError> {
    if let Some(force) = prepared
        .mechanism
        .applied_forces()
        .without_derivatives()
        .next()
    {
        return Err(EquilibriumError::NoDerivatives(force));
    }
    let mut statics = Statics::new(prepared);
    statics.check_rest(&prepared.q)?;
    let falls = fall::falls(&mut statics, &prepared.q);
    if !falls.is_empty() {
        return Err(EquilibriumError::Pushed(falls));
    }
    let mut search = EquilibriumSearch {
        at: statics.balance(prepared.q.clone())?,
        statics,
        radius: REST_RADIUS,
        steps: 0,
        pushes: 0,
        unresisted: 0,
        best: f64::INFINITY,
        stalled: 0,
    };
    let stiffness = search.run(options)?;
    search.finish(&stiffness, prepared)
}

/// Describes the bodies that fall freely at the configuration q and time t, and the loads that act
/// on these bodies. Such bodies have no connection to the ground. Returns `None` if it is not
/// certain that a body falls.
pub(crate) fn falling(prepared: &PreparedMechanism, t: f64, q: &[f64]) -> Option<String> {
    let mut statics = Statics::new(prepared);
    statics.t = t;
    let falls = fall::falls(&mut statics, q);
    (!falls.is_empty()).then(|| error::push(&falls))
}

/// State of a search for an equilibrium.
struct EquilibriumSearch<'m> {
    statics: Statics<'m>,
    at: Balance,
    /// Maximum step length for each body (in sizes of the mechanism, or rad).
    radius: f64,
    steps: usize,
    pushes: usize,
    /// Number of successive steps along a motion without stiffness.
    unresisted: usize,
    /// Smallest remaining force so far, and the number of steps since this force was last halved.
    best: f64,
    stalled: usize,
}

impl EquilibriumSearch<'_> {
    /// Moves the mechanism to an equilibrium. Returns the stiffness at the equilibrium.
    fn run(&mut self, options: &EquilibriumOptions) -> Result<Stiffness, EquilibriumError> {
        loop {
            let stiffness = self.statics.stiffness(&self.at)?;
            if self.is_at_rest(&stiffness) {
                let falling = stiffness.falling();
                if !options.stable || falling.is_empty() || self.pushes == REST_PUSHES {
                    return Ok(stiffness);
                }
                self.push(&falling[0])?;
                continue;
            }
            self.watch(&stiffness)?;
            if self.steps == REST_STEPS {
                return Err(self.not_found());
            }
            self.step(&stiffness)?;
            self.steps += 1;
        }
    }

    /// Returns whether the remaining forces are rounding errors.
    fn is_at_rest(&mut self, stiffness: &Stiffness) -> bool {
        let left = norm(&self.at.free);
        let rounding = f64::EPSILON * (self.at.scale + stiffness.largest);
        if left <= 0.5 * self.best {
            (self.best, self.stalled) = (left, 0);
        } else {
            self.stalled += 1;
        }
        left <= REST_ROUNDINGS * rounding
            || self.stalled >= REST_STALLED && left <= REST_LEFT * rounding
    }

    /// Returns an error for a motion along which a force acts at every configuration.
    fn watch(&mut self, stiffness: &Stiffness) -> Result<(), EquilibriumError> {
        let free = &self.at.free;
        let size = norm(free);
        let along: Vec<f64> = free.iter().map(|f| f / size).collect();
        let resisted = norm(&stiffness.k.times(&along));
        let is_pushed = size > UNRESISTED_FORCE * self.at.scale;
        if is_pushed && resisted <= UNRESISTED * (self.at.scale + stiffness.largest) {
            self.unresisted += 1;
        } else {
            self.unresisted = 0;
        }
        if self.unresisted <= UNRESISTED_STEPS {
            return Ok(());
        }
        let pushed = words::pushed(&mut self.statics, &self.at, &along);
        Err(EquilibriumError::Pushed(pushed))
    }

    fn not_found(&mut self) -> EquilibriumError {
        EquilibriumError::NotFound {
            steps: self.steps,
            left: norm(&self.at.free) / self.at.scale,
            pushed: self.pushed(),
        }
    }

    fn blocked(&mut self) -> EquilibriumError {
        EquilibriumError::Blocked {
            steps: self.steps,
            pushed: self.pushed(),
        }
    }

    /// Returns the unbalanced forces at the current configuration.
    fn pushed(&mut self) -> Vec<UnbalancedForce> {
        let size = norm(&self.at.free);
        let along: Vec<f64> = self.at.free.iter().map(|f| f / size).collect();
        words::pushed(&mut self.statics, &self.at, &along)
    }

    /// Makes one step along the forces.
    fn step(&mut self, stiffness: &Stiffness) -> Result<(), EquilibriumError> {
        let bodies = self.statics.bodies().max(1) as f64;
        let before = norm(&self.at.free);
        loop {
            let radius = self.radius * bodies.sqrt();
            let rounding = REST_ROUNDINGS * f64::EPSILON * (self.at.scale + stiffness.largest);
            let (y, way) = stiffness.step(&self.at.free, radius, rounding);
            let moved = self.statics.moved(&self.at, &y);
            let reached = self
                .statics
                .placed(&self.at, &moved)
                .and_then(|q| self.statics.balance(q));
            let at = match reached {
                Ok(at) => at,
                Err(EquilibriumError::Start(StartError::NoAssembly { .. }))
                    if self.radius < REST_SHORTEST =>
                {
                    return Err(self.blocked());
                }
                Err(error) if self.radius < REST_SHORTEST => return Err(error),
                Err(_) => {
                    self.radius *= 0.25;
                    continue;
                }
            };
            // Work divided by the length of the step, first at the start and then at the end of the
            // step.
            let begins = dot(&self.at.free, &y);
            let ends = dot(&self.statics.scaled(&at), &moved);
            let ratio = ends / begins;
            let after = norm(&at.free);
            let is_rounding = after <= REST_LEFT * rounding;
            let is_back = ratio.is_nan() || ratio < -0.5;
            if is_back && after > 0.5 * before && !is_rounding {
                if self.radius < REST_SHORTEST {
                    return Err(self.not_found());
                }
                self.radius = 0.25 * (norm(&y) / bodies.sqrt()).min(self.radius);
                continue;
            }
            if way == Way::Short && ratio > 0.25 {
                self.radius = (2.0 * self.radius).min(REST_LONGEST);
            }
            self.at = at;
            return Ok(());
        }
    }

    /// Moves the mechanism away from an equilibrium that is not a minimum of the potential.
    fn push(&mut self, along: &[f64]) -> Result<(), EquilibriumError> {
        let largest = along
            .iter()
            .fold(0.0, |a: f64, x| if x.abs() > a.abs() { *x } else { a });
        let y: Vec<f64> = along
            .iter()
            .map(|x| REST_PUSH * x * largest.signum())
            .collect();
        let moved = self.statics.moved(&self.at, &y);
        let q = self.statics.placed(&self.at, &moved)?;
        self.at = self.statics.balance(q)?;
        self.radius = REST_RADIUS;
        self.pushes += 1;
        (self.best, self.stalled) = (f64::INFINITY, 0);
        Ok(())
    }

    fn finish(
        self,
        stiffness: &Stiffness,
        prepared: &PreparedMechanism,
    ) -> Result<Equilibrium, EquilibriumError> {
        let depends_on_way = prepared.decision.rank > prepared.position_decision.rank;
        let (idle, falling) = (stiffness.idle(), stiffness.falling());
        let stability = if self.at.free.is_empty() {
            RestStability::Immovable
        } else if depends_on_way {
            RestStability::Nonholonomic
        } else if !stiffness.has_potential {
            RestStability::NoPotential
        } else if !falling.is_empty() {
            RestStability::Unstable
        } else if !idle.is_empty() {
            RestStability::Idle
        } else {
            RestStability::Stable
        };
        let falling = if stability == RestStability::Unstable {
            words::motions(&self.statics, &self.at, &falling)
        } else {
            Vec::new()
        };
        let idle = words::motions(&self.statics, &self.at, &idle);
        let largest = self.at.free.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let (t, size) = (self.statics.t, self.statics.size);
        let moving_on = accelerated(self.statics.mechanism, size, t, &self.at.q);
        Ok(Equilibrium {
            time: self.statics.t,
            steps: self.steps,
            pushes: self.pushes,
            residual: if self.at.scale > 0.0 {
                largest / self.at.scale
            } else {
                0.0
            },
            largest_force: self.at.scale / self.statics.size,
            stability,
            idle,
            falling,
            depends_on_way,
            moving_on,
            q: self.at.q,
        })
    }
}
