//! Rows at given output times, as accurate as the accurate dense output and independent of the step
//! size.
//!
//! The type is intended for observers that also process events or perform other tasks. The function
//! [`crate::sample()`] also integrates.

use crate::error::IntegrationError;
use crate::interval::Interval;
use crate::ode::Ode;
use crate::options::invalid;
use crate::step::Step;
use std::ops::ControlFlow;

/// The output times.
#[derive(Debug, Clone, PartialEq)]
pub enum OutputTimes {
    /// The times t0, t0 ± dt, t0 ± 2·dt, … and exactly `t_end`, with dt > 0. A multiple of dt whose
    /// distance from `t_end` is below 1e-9·dt is replaced by `t_end`.
    Every(f64),
    /// The given times within the interval, including its ends. The times must be strictly
    /// monotonic in the direction of integration.
    At(Vec<f64>),
}

/// The rows of one integration, produced step by step.
///
/// # Examples
///
/// The example is free fall, y = t². The output has rows at 0, 0.4, 0.8 and 1, and counts the
/// steps.
///
/// ```
/// use pfaff_integrators::{Dopri5, Function, Interval, Options, OutputTimes, Rows, integrate};
/// use std::ops::ControlFlow;
///
/// let mut ode = Function::new(1, |t, _y: &[f64], dy: &mut [f64]| dy[0] = 2.0 * t);
/// let (interval, y0) = (Interval::new(0.0, 1.0), [0.0]);
/// let (mut written, mut steps) = (Vec::new(), 0);
/// let mut rows = Rows::new::<std::convert::Infallible>(OutputTimes::Every(0.4), &interval)?;
/// let mut write = |_ode: &mut _, t: f64, y: &mut [f64]| {
///     written.push((t, y[0]));
///     ControlFlow::Continue(())
/// };
/// let _ = rows.start(&mut ode, &y0, &mut write);
/// integrate(&Dopri5, &mut ode, &interval, &y0, &Options::default(), |step| {
///     steps += 1;
///     rows.emit(step, &mut write).expect("f can be evaluated everywhere")
/// })?;
/// assert_eq!(written.iter().map(|row| row.0).collect::<Vec<_>>(), [0.0, 0.4, 0.8, 1.0]);
/// assert!(written.iter().all(|(t, y)| (y - t * t).abs() < 1e-14));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Rows {
    times: OutputTimes,
    interval: Interval<'static>,
    /// Index of the next row.
    index: u64,
    y: Vec<f64>,
}

impl Rows {
    /// Creates the rows at `times` of an integration over `interval`.
    ///
    /// # Errors
    ///
    /// Returns [`IntegrationError::InvalidOption`] for an invalid output step, and
    /// [`IntegrationError::InvalidOutputTime`] for an invalid list.
    pub fn new<E: std::error::Error + 'static>(
        times: OutputTimes,
        interval: &Interval<'_>,
    ) -> Result<Self, IntegrationError<E>> {
        times.check(interval)?;
        Ok(Self {
            times,
            interval: Interval::new(interval.t0, interval.t_end),
            index: 0,
            y: Vec::new(),
        })
    }

    /// Calls `row` with the initial state if t0 is an output time. The caller must call this
    /// function before the integration.
    pub fn start<O: Ode>(
        &mut self,
        ode: &mut O,
        y0: &[f64],
        mut row: impl FnMut(&mut O, f64, &mut [f64]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.y.clear();
        self.y.extend_from_slice(y0);
        if self.next() == Some(self.interval.t0) {
            self.index += 1;
            row(ode, self.interval.t0, &mut self.y)?;
        }
        ControlFlow::Continue(())
    }

    /// Calls `row` with the problem, the time and the state at all output times up to the end of
    /// `step`. If `row` changes the state (for example by a projection), the integration is not
    /// affected. After `row` returns `Break`, it is not called again.
    ///
    /// # Errors
    ///
    /// Returns [`IntegrationError::OutputFailed`] if an extra evaluation fails. The previous rows
    /// remain valid.
    pub fn emit<O: Ode>(
        &mut self,
        step: &mut Step<'_, O>,
        row: impl FnMut(&mut O, f64, &mut [f64]) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, IntegrationError<O::Error>> {
        self.emit_until(step.t1(), step, row)
    }

    /// Works like [`Rows::emit`], but not beyond `t_stop`. At this time an event ends the motion.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Rows::emit`].
    pub fn emit_until<O: Ode>(
        &mut self,
        t_stop: f64,
        step: &mut Step<'_, O>,
        mut row: impl FnMut(&mut O, f64, &mut [f64]) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, IntegrationError<O::Error>> {
        let sign = self.interval.direction();
        let last = if (t_stop - step.t1()) * sign < 0.0 {
            t_stop
        } else {
            step.t1()
        };
        self.y.resize(step.y0().len(), 0.0);
        while let Some(t) = self.next().filter(|t| (last - t) * sign >= 0.0) {
            self.index += 1;
            // Times within steps that were not passed to this function are skipped.
            if (t - step.t0()) * sign < 0.0 {
                continue;
            }
            step.write_accurately(t, &mut self.y)
                .map_err(|cause| IntegrationError::OutputFailed { t, cause })?;
            if row(step.ode(), t, &mut self.y).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    fn next(&self) -> Option<f64> {
        self.times.get(self.index, &self.interval)
    }
}

/// A row whose distance from t_end is below this fraction of dt is replaced by t_end.
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

    /// Returns the time of the row with this index, if the row exists.
    fn get(&self, index: u64, interval: &Interval<'_>) -> Option<f64> {
        match self {
            Self::At(times) => usize::try_from(index)
                .ok()
                .and_then(|i| times.get(i))
                .copied(),
            Self::Every(dt) => {
                // The time is a product and not a sum. Therefore rounding does not accumulate. A
                // row with index i exists if i·dt is below the length.
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
