//! Events: times at which a function g(t, y) of the solution passes zero, found in the accurate
//! dense output of accepted steps.
//!
//! The caller handles an event. If a motion jumps, the caller starts a new integration at the
//! event.

use crate::drive::integrate;
use crate::error::{Failure, IntegrationError};
use crate::interval::Interval;
use crate::method::{Method, Outcome};
use crate::ode::Ode;
use crate::options::Options;
use crate::root::bracketed_root;
use crate::step::Step;
use std::error::Error;
use std::ops::ControlFlow;

/// Direction of the zero crossings of g that count as events, in the direction of integration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Direction {
    /// All zero crossings.
    #[default]
    Any,
    /// Zero crossings from negative to positive values.
    Rising,
    /// Zero crossings from positive to negative values.
    Falling,
}

/// A zero of g.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Crossing {
    /// Time of the zero of the dense output, exact to a few units in the last place. At this time g
    /// is zero or has already changed its sign.
    pub t: f64,
    /// Whether g was negative before the zero.
    pub is_rising: bool,
}

/// Number of parts into which a step is divided. g is evaluated at the ends of the parts.
const PARTS: u32 = 10;
/// Width of the final bracket around a zero, in units of the rounding of t.
const WIDTH_IN_EPSILONS: f64 = 2.0;

/// Finds the zeros of one function g step by step, for use in an observer.
///
/// g is evaluated at eleven points of each step. These evaluations use the dense output without
/// extra evaluations of f. The accurate dense output is used only in a step in which the sign
/// changes. A zero at the end of a step belongs to this step. A zero at the start of the
/// integration is ignored. The search does not detect two zeros between neighbouring points, or a
/// change of sign due to a jump of the state at a break time. The search detects a contact without
/// change of sign (a grazing contact) only if g is exactly 0 at one of the points. Limit the step
/// size if g changes faster than the solution. Search for zeros of dg/dt if such contacts are
/// important.
///
/// # Examples
///
/// The example finds the upward zeros of sin t = y, y' = cos t, between 0 and 20: 2π, 4π, 6π. The
/// integration starts at 0.
///
/// ```
/// use pfaff_integrators::{Crossings, Direction, Dop853, Function, Interval, Options, integrate};
/// use std::ops::ControlFlow;
///
/// let mut ode = Function::new(1, |t: f64, _y: &[f64], dy: &mut [f64]| dy[0] = t.cos());
/// let options = Options::with_tolerance(1e-12, 1e-12);
/// let (mut crossings, mut times) = (Crossings::new(Direction::Rising), Vec::new());
/// integrate(&Dop853, &mut ode, &Interval::new(0.0, 20.0), &[0.0], &options, |step| {
///     let found = crossings.locate(step, |_ode, _t, y| y[0]).expect("g and f are defined everywhere");
///     times.extend(found.iter().map(|crossing| crossing.t / std::f64::consts::TAU));
///     ControlFlow::Continue(())
/// })?;
/// assert_eq!(times.len(), 3);
/// assert!(times.iter().zip([1.0, 2.0, 3.0]).all(|(t, exact)| (t - exact).abs() < 1e-10));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Crossings {
    direction: Direction,
    found: Vec<Crossing>,
    y: Vec<f64>,
}

impl Crossings {
    /// Searches one function for zeros in this direction.
    #[must_use]
    pub fn new(direction: Direction) -> Self {
        Self {
            direction,
            ..Self::default()
        }
    }

    /// Finds the zeros of g in this step, in the direction of integration. g is called with the
    /// problem, the time and the state.
    ///
    /// # Errors
    ///
    /// Returns [`IntegrationError::EventUndefined`] if g is not a number, and
    /// [`IntegrationError::OutputFailed`] if an extra evaluation of f fails.
    pub fn locate<O: Ode>(
        &mut self,
        step: &mut Step<'_, O>,
        mut g: impl FnMut(&mut O, f64, &[f64]) -> f64,
    ) -> Result<&[Crossing], IntegrationError<O::Error>> {
        self.found.clear();
        self.y.resize(step.y0().len(), 0.0);
        let (t0, t1) = (step.t0(), step.t1());
        let y = &mut self.y;
        let mut cheap = |step: &mut Step<'_, O>, t: f64| {
            step.write_cheaply(t, y);
            number(t, g(step.ode(), t, y))
        };
        let mut before = cheap(step, t0)?;
        let mut changes = false;
        for i in 1..=PARTS {
            let g_i = cheap(step, place(t0, t1, i))?;
            changes |= passes(before, g_i);
            before = g_i;
        }
        if !changes {
            return Ok(&self.found);
        }
        let mut accurate = |t: f64| {
            step.write_accurately(t, y)
                .map_err(|cause| IntegrationError::OutputFailed { t, cause })?;
            number(t, g(step.ode(), t, y))
        };
        let width = WIDTH_IN_EPSILONS * f64::EPSILON * t0.abs().max(t1.abs());
        let mut near = (t0, accurate(t0)?);
        for i in 1..=PARTS {
            let t = place(t0, t1, i);
            let far = (t, accurate(t)?);
            let is_rising = near.1 < 0.0;
            let counts = match self.direction {
                Direction::Any => true,
                Direction::Rising => is_rising,
                Direction::Falling => !is_rising,
            };
            if counts && passes(near.1, far.1) {
                let t = bracketed_root(near, far, width, &mut accurate)?;
                self.found.push(Crossing { t, is_rising });
            }
            near = far;
        }
        Ok(&self.found)
    }
}

/// Returns the boundary with index `i` between the parts of a step. The indices 0 and [`PARTS`] are
/// exactly the ends of the step.
fn place(t0: f64, t1: f64, i: u32) -> f64 {
    if i == PARTS {
        t1
    } else {
        t0 + f64::from(i) / f64::from(PARTS) * (t1 - t0)
    }
}

/// Returns whether g reaches or passes zero between `before` and `after`.
fn passes(before: f64, after: f64) -> bool {
    (before < 0.0 && after >= 0.0) || (before > 0.0 && after <= 0.0)
}

fn number<E: Error + 'static>(t: f64, g: f64) -> Result<f64, IntegrationError<E>> {
    if g.is_nan() {
        Err(IntegrationError::EventUndefined { t })
    } else {
        Ok(g)
    }
}

/// Integrates like [`integrate`] until g(t, y) passes zero in the given direction. The outcome is
/// then [`End::Stopped`](crate::End::Stopped) with the time of the event and the state of the
/// accurate dense output at that time.
///
/// Zeros that [`Crossings`] does not detect are not detected by this function, either. A motion
/// that continues from an event begins with g = 0, apart from rounding. Choose the direction so
/// that this initial zero does not count.
///
/// # Errors
///
/// Returns the errors of [`integrate`] and of [`Crossings::locate`].
///
/// # Examples
///
/// In the example, a body falls from 5 m with g = 10 m/s². The body reaches the ground after 1 s at
/// 10 m/s.
///
/// ```
/// use pfaff_integrators::{Direction, Dopri5, End, Function, Interval, Options, integrate_until};
///
/// let mut fall = Function::new(2, |_t, y: &[f64], dy: &mut [f64]| dy.copy_from_slice(&[y[1], -10.0]));
/// let (interval, options) = (Interval::new(0.0, 100.0), Options::default());
/// let ground = |_: &mut _, _t: f64, y: &[f64]| y[0];
/// let end = integrate_until(&Dopri5, &mut fall, &interval, &[5.0, 0.0], &options, Direction::Falling, ground)?;
/// assert_eq!(end.end, End::Stopped);
/// assert!((end.t - 1.0).abs() < 1e-14 && (end.y[1] + 10.0).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn integrate_until<O: Ode>(
    method: &impl Method<O>,
    ode: &mut O,
    interval: &Interval<'_>,
    y0: &[f64],
    options: &Options,
    direction: Direction,
    mut g: impl FnMut(&mut O, f64, &[f64]) -> f64,
) -> Result<Outcome, Box<Failure<O::Error>>> {
    let mut crossings = Crossings::new(direction);
    let mut event = None;
    let mut outcome = integrate(method, ode, interval, y0, options, |step| {
        let found = crossings.locate(step, &mut g).and_then(|found| {
            let Some(&Crossing { t, .. }) = found.first() else {
                return Ok(None);
            };
            let mut y = vec![0.0; step.y0().len()];
            step.write_accurately(t, &mut y)
                .map_err(|cause| IntegrationError::OutputFailed { t, cause })?;
            Ok(Some((t, y)))
        });
        match found {
            Ok(None) => return ControlFlow::Continue(()),
            Ok(Some(place)) => event = Some(Ok(place)),
            Err(error) => event = Some(Err(error)),
        }
        ControlFlow::Break(())
    })?;
    match event {
        None => {}
        Some(Ok((t, y))) => (outcome.t, outcome.y) = (t, y),
        Some(Err(error)) => {
            return Err(Box::new(Failure {
                error,
                t: outcome.t,
                y: outcome.y,
                statistics: outcome.statistics,
            }));
        }
    }
    Ok(outcome)
}
