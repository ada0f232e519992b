//! Rows at given output times, as accurate as the steps and independent of their size.

use crate::drive::{check, refuse};
use crate::error::{Failure, IntegrationError};
use crate::interval::Interval;
use crate::method::{End, Method, Outcome, integrate};
use crate::ode::Ode;
use crate::options::{Options, invalid};
use crate::statistics::Statistics;
use crate::step::{OutputError, Step};
use std::ops::ControlFlow;

/// When rows are wanted.
#[derive(Debug, Clone, PartialEq)]
pub enum OutputTimes {
    /// t0, t0 ± dt, t0 ± 2·dt, … and `t_end` exactly; dt > 0. A multiple of dt that falls within 1e-9·dt of `t_end` gives
    /// way to it.
    Every(f64),
    /// These times inside the interval, ends included, strictly in the order of travel.
    At(Vec<f64>),
}

/// Rows closer to t_end than this part of dt are t_end.
const SAME_ROW: f64 = 1e-9;

impl OutputTimes {
    fn check<E: std::error::Error + 'static>(
        &self,
        interval: &Interval<'_>,
    ) -> Result<(), IntegrationError<E>> {
        match self {
            Self::Every(dt) if *dt > 0.0 && dt.is_finite() => Ok(()),
            Self::Every(dt) => Err(invalid("output step", *dt, "a finite positive number")),
            Self::At(times) => {
                let (t0, t_end, sign) = (interval.t0, interval.t_end, interval.direction());
                let is_good = |index: usize, t: f64| {
                    let after = index == 0 || (t - times[index - 1]) * sign > 0.0;
                    after && (t - t0) * sign >= 0.0 && (t_end - t) * sign >= 0.0
                };
                match times.iter().enumerate().find(|&(i, &t)| !is_good(i, t)) {
                    None => Ok(()),
                    Some((index, &t)) => Err(IntegrationError::InvalidOutputTime {
                        index,
                        t,
                        t0,
                        t_end,
                    }),
                }
            }
        }
    }

    /// Row number `index`, if there is one.
    fn get(&self, index: u64, interval: &Interval<'_>) -> Option<f64> {
        match self {
            Self::At(times) => usize::try_from(index)
                .ok()
                .and_then(|i| times.get(i))
                .copied(),
            Self::Every(dt) => {
                // A product, not a sum: rounding does not pile up. Time number i counts if i·dt is short of the length.
                let length = (interval.t_end - interval.t0).abs();
                let before_end = |i: u64| length - i as f64 * dt > SAME_ROW * dt.min(length);
                if index == 0 || before_end(index) {
                    Some(interval.t0 + interval.direction() * (index as f64 * dt))
                } else if before_end(index - 1) {
                    Some(interval.t_end)
                } else {
                    None
                }
            }
        }
    }
}

/// Integrates like [`integrate`] and calls `row` at each of `times`, in order, with the problem, the time and the state.
///
/// The state may be changed by `row` (projected, say); the integration does not see the change. Inside steps it comes from
/// [`Step::interpolate_accurately`]; at t0 it is `y0` as given.
///
/// # Errors
///
/// Those of [`integrate`], and [`IntegrationError::InvalidOutputTime`], [`IntegrationError::InvalidOption`] for a bad `times`,
/// [`IntegrationError::OutputFailed`] if an extra evaluation for a row fails. All rows before are valid.
///
/// # Examples
///
/// Free fall, y = t²: rows at 0, 0.4, 0.8 and at the end.
///
/// ```
/// use integrators::{Dopri5, Function, Interval, Options, OutputTimes, sample};
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
    check(ode, interval, y0, options)
        .and_then(|_legs| times.check(interval))
        .map_err(|error| refuse(error, interval.t0, y0))?;
    let mut y = y0.to_vec();
    let mut index = 0;
    if times.get(0, interval) == Some(interval.t0) {
        index = 1;
        if row(ode, interval.t0, &mut y).is_break() {
            return Ok(Outcome {
                t: interval.t0,
                y: y0.to_vec(),
                end: End::Stopped,
                statistics: Statistics::default(),
            });
        }
    }
    let mut output_error = None;
    let outcome = integrate(
        method,
        ode,
        interval,
        y0,
        options,
        |step: &mut Step<'_, O>| {
            let sign = interval.direction();
            while let Some(t) = times
                .get(index, interval)
                .filter(|t| (step.t1() - t) * sign >= 0.0)
            {
                if let Err(error) = step.interpolate_accurately(t, &mut y) {
                    output_error = Some((t, error));
                    return ControlFlow::Break(());
                }
                index += 1;
                row(step.ode(), t, &mut y)?;
            }
            ControlFlow::Continue(())
        },
    )?;
    match output_error {
        Some((t, OutputError::Evaluation(cause))) => Err(Box::new(Failure {
            error: IntegrationError::OutputFailed { t, cause },
            t: outcome.t,
            y: outcome.y,
            statistics: outcome.statistics,
        })),
        Some((t, error)) => unreachable!("row at t = {t} was asked of the wrong step: {error}"),
        None => Ok(outcome),
    }
}
