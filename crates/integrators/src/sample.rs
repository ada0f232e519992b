//! Integrates, and calls a function for rows at given output times.

use crate::drive::{check, integrate, refuse};
use crate::error::Failure;
use crate::interval::Interval;
use crate::method::{End, Method, Outcome};
use crate::ode::Ode;
use crate::options::Options;
use crate::rows::{OutputTimes, Rows};
use std::ops::ControlFlow;

/// Integrates like [`integrate`] and calls `row` at each of `times`, in order, with the problem,
/// the time and the state.
///
/// If `row` changes the state (for example by a projection), the integration is not affected.
/// Within steps the state comes from [`crate::Step::interpolate_accurately`]; at t0 it is the given
/// `y0`.
///
/// # Errors
///
/// Returns the errors of [`integrate`], of [`Rows::new`] and of [`Rows::emit`]. All previous rows
/// are valid.
///
/// # Examples
///
/// The example is free fall, y = t². The output has rows at 0, 0.4, 0.8 and at the end.
///
/// ```
/// use pfaff_integrators::{Dopri5, Function, Interval, Options, OutputTimes, sample};
/// use std::ops::ControlFlow;
///
/// let mut ode = Function::new(1, |t, _y: &[f64], dy: &mut [f64]| dy[0] = 2.0 * t);
/// let (interval, options) = (Interval::new(0.0, 1.0), Options::default());
/// let mut rows = Vec::new();
/// sample(&Dopri5, &mut ode, &interval, &[0.0], &options, &OutputTimes::Every(0.4), |_ode, t, y| {
///     rows.push((t, y[0]));
///     ControlFlow::Continue(())
/// })?;
/// let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
/// assert_eq!(times, [0.0, 0.4, 0.8, 1.0]);
/// assert!(rows.iter().all(|(t, y)| (y - t * t).abs() < 1e-14));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sample<O, M, F>(
    method: &M,
    ode: &mut O,
    interval: &Interval<'_>,
    y0: &[f64],
    options: &Options,
    times: &OutputTimes,
    mut row: F,
) -> Result<Outcome, Box<Failure<O::Error>>>
where
    O: Ode,
    M: Method<O>,
    F: FnMut(&mut O, f64, &mut [f64]) -> ControlFlow<()>,
{
    let mut rows = check(ode, interval, y0, options)
        .and_then(|_legs| Rows::new(times.clone(), interval))
        .map_err(|error| refuse(error, interval.t0, y0))?;
    if rows.start(ode, y0, &mut row).is_break() {
        return Ok(Outcome::unmoved(interval.t0, y0, End::Stopped));
    }
    let mut failure = None;
    let outcome = integrate(method, ode, interval, y0, options, |step| {
        rows.emit(step, &mut row).unwrap_or_else(|error| {
            failure = Some(error);
            ControlFlow::Break(())
        })
    })?;
    match failure {
        None => Ok(outcome),
        Some(error) => Err(Box::new(Failure {
            error,
            t: outcome.t,
            y: outcome.y,
            statistics: outcome.statistics,
        })),
    }
}
