//! Parallelograms rotate at speed through their singular configurations, at which another branch of
//! motion begins. The distance from the origin is small, or up to a thousand kilometres. Every
//! method is tested.
//!
//! The correct result has a closed form. All cranks have the same angle θ, so the coupler does not
//! rotate. The energy `½·I·θ̇² + W·sin θ` is constant, with `I = Σ (J + m·l²/4) + M·l²` and
//! `W = g·l·(n·m/2 + M)`. Without gravity θ = θ₀ + ω·t.

use std::collections::BTreeMap;
use std::fmt::{self, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use dynamics::{Method, MotionOptions, RowChoice, prepare, simulate};
use model::{Mechanism, StartOptions};

use crate::mechanisms::cranks::cranks_at;
use suite::numbers::Numbers;

/// Largest distance of the far parallelograms from the origin (m).
const FAR: f64 = 1e6;

/// Duration of the motion (s).
const SECONDS: f64 = 5.0;

/// Largest processor time after which a run that stops must report the error.
const PATIENCE: Duration = Duration::from_secs(1);

/// Error bounds of angles and energies as multiples of the tolerance, and the smallest values of
/// these bounds. A run passes a few dozen singular configurations. At each singular configuration
/// the error may be ten times the tolerance.
const TOLERANCES: f64 = 1e4;

/// Smallest distance from a singular configuration at which a step of a run can end. This limit of
/// the product is a fraction of pivots; here it is the angle to the singular configuration (rad).
const NEAREST: f64 = 1e-3;

/// Acceleration of gravity (m/s²).
const GRAVITY: f64 = 9.81;

/// One run.
#[derive(Clone, Debug)]
pub struct Parallelogram {
    origin: [f64; 2],
    pivots: Vec<f64>,
    length: f64,
    theta: f64,
    omega: f64,
    gravity: f64,
    /// Integrator.
    pub method: Method,
    rtol: f64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The run is on the correct branch at every output row.
    Right,
    /// The run stopped with an error.
    Stopped {
        /// Text of the error.
        error: String,
        /// Whether the error was reported within a second of processor time.
        in_time: bool,
    },
    /// An output row contradicts the closed form.
    Wrong(String),
}

impl fmt::Display for Parallelogram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} cranks of {:.3} m at {:.3} rad/s from {:.3} rad, origin {:.0?} m, gravity {} m/s², {}, rtol {:e}",
            self.pivots.len(),
            self.length,
            self.omega,
            self.theta,
            self.origin,
            self.gravity,
            self.method.name(),
            self.rtol
        )
    }
}

impl Parallelogram {
    /// Draws the run with this number. In every second run the parallelogram is far from the
    /// origin.
    #[must_use]
    pub fn draw(seed: u64, number: u64) -> Self {
        let mut n = Numbers::new(seed ^ number.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let far = if number % 2 == 1 { FAR } else { 0.0 };
        let origin = [far * n.unit(), far * n.unit()];
        let width = n.within(0.5, 2.0);
        let mut pivots = vec![0.0, width];
        if n.below(4) == 0 {
            pivots.push(width * n.within(0.2, 0.8));
        }
        let sign = if n.below(2) == 0 { 1.0 } else { -1.0 };
        let methods = [
            Method::Dop853,
            Method::Dop853,
            Method::Dop853,
            Method::Dopri5,
            Method::Tsit5,
            Method::Radau5,
        ];
        Self {
            origin,
            pivots,
            length: n.within(0.2, 1.0),
            theta: n.within(0.3, 2.8),
            omega: sign * n.within(1.0, 10.0),
            gravity: [0.0, 0.0, GRAVITY][n.below(3)],
            method: methods[n.below(methods.len())],
            rtol: [1e-6, 1e-8, 1e-8, 1e-10][n.below(4)],
        }
    }

    /// Whether the parallelogram is far from the origin.
    #[must_use]
    pub fn is_far(&self) -> bool {
        self.origin != [0.0; 2]
    }

    /// Relative change of the speed that rounding errors of the coordinates may cause.
    ///
    /// Coordinates at a distance D from the origin are accurate to `ε·D`, so the angles of cranks
    /// of length l are accurate to `ε·D/l`. At an angle σ from the singular configuration, the
    /// ratio of the crank speeds then has an error of `ε·D/(l·σ)`. If a step begins or ends at this
    /// angle, the speed of all cranks has the same error. The smallest σ at the end of a step
    /// determines the largest error. The relative error of the rotation angle is then the same, and
    /// the relative error of the energy is twice as large. Within 2 m of the origin the value is
    /// below 3e-12. On another branch, angles have errors of some radians.
    fn speed_error(&self) -> f64 {
        let distance = self.origin[0].hypot(self.origin[1]);
        f64::EPSILON * (distance + self.length) / (self.length * NEAREST)
    }

    /// Performs the run and compares every row with the closed form.
    #[must_use]
    pub fn run(&self) -> Verdict {
        let clock = Clock::start();
        let stopped = |error: String| Verdict::Stopped {
            error,
            in_time: clock.elapsed() <= PATIENCE,
        };
        let mut d = cranks_at(self.origin, &self.pivots, self.length, self.theta);
        d.gravity = [0.0, -self.gravity];
        let (sin, cos) = self.theta.sin_cos();
        let n = self.pivots.len();
        for (k, body) in d.bodies.iter_mut().enumerate() {
            let (share, turns) = if k < n { (0.5, 1.0) } else { (1.0, 0.0) };
            let speed = share * self.length * self.omega;
            body.velocity = Some([-speed * sin, speed * cos]);
            body.angular_velocity = Some(turns * self.omega);
        }
        let (crank, coupler) = (d.bodies[0].clone(), d.bodies[n].clone());
        let (l, cranks) = (self.length, n as f64);
        let inertia = cranks * (crank.inertia + 0.25 * crank.mass * l * l) + coupler.mass * l * l;
        let weight = self.gravity * l * (0.5 * cranks * crank.mass + coupler.mass);
        let energy = |theta: f64, omega: f64| 0.5 * inertia * omega * omega + weight * theta.sin();
        let (start, scale) = (
            energy(self.theta, self.omega),
            0.5 * inertia * self.omega * self.omega + weight,
        );
        let prepared = match Mechanism::build(&d) {
            Ok(m) => prepare(m, &StartOptions::default(), &RowChoice::Automatic),
            Err(errors) => return stopped(format!("{errors:?}")),
        };
        let prepared = match prepared {
            Ok(prepared) => prepared,
            Err(error) => return stopped(error.to_string()),
        };
        let options = MotionOptions {
            method: self.method,
            rtol: self.rtol,
            atol: 1e-2 * self.rtol,
            ..MotionOptions::to(SECONDS)
        };
        let permitted = TOLERANCES * self.rtol;
        let speed_error = self.speed_error();
        let mut wrong = None;
        let outcome = simulate(&prepared, &options, |row| {
            let (theta, omega) = (row.q[2], row.v[2]);
            let apart = (1..n).map(|k| (row.q[3 * k + 2] - theta).abs());
            let apart = apart.fold(row.q[3 * n + 2].abs(), f64::max);
            let turned = self.omega * row.t;
            let (led, by_rounding) = if self.gravity == 0.0 {
                let led = (theta - self.theta - turned).abs();
                (led, turned.abs() * speed_error)
            } else {
                let led = (energy(theta, omega) - start).abs() / scale;
                (led, 2.0 * speed_error)
            };
            if !(apart <= permitted && led <= permitted + by_rounding) {
                let t = row.t;
                wrong = Some(format!(
                    "at {t} s the angles differ by {apart:.1e} rad, and the cranks have an error of {led:.1e} rad"
                ));
                return Ok(ControlFlow::Break(()));
            }
            Ok(ControlFlow::Continue(()))
        });
        match (wrong, outcome) {
            (Some(wrong), _) => Verdict::Wrong(wrong),
            (None, Ok(_)) => Verdict::Right,
            (None, Err(failure)) => stopped(failure.to_string()),
        }
    }
}

/// The time of a thread. This is the processor time, which does not depend on other processes. If
/// the system does not report the processor time, it is the wall-clock time.
struct Clock {
    wall: Instant,
    processor: Option<Duration>,
}

impl Clock {
    fn start() -> Self {
        Self {
            wall: Instant::now(),
            processor: Self::processor(),
        }
    }

    /// Returns the time since the start.
    fn elapsed(&self) -> Duration {
        match (self.processor, Self::processor()) {
            (Some(then), Some(now)) => now.saturating_sub(then),
            _ => self.wall.elapsed(),
        }
    }

    /// Returns the processor time of the thread; Linux reports it in nanoseconds.
    fn processor() -> Option<Duration> {
        let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        let used = told.split_whitespace().next()?.parse().ok()?;
        Some(Duration::from_nanos(used))
    }
}

/// Results of many runs.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Number of correct runs and number of all runs, by method and position.
    pub counts: BTreeMap<(String, bool), [u64; 2]>,
    /// Runs that stopped or were wrong, with their indices and results.
    pub others: Vec<(u64, Parallelogram, Verdict)>,
}

impl Tally {
    /// Performs the runs of a seed, beginning with `from`; `done` is called after each run.
    #[must_use]
    pub fn of(seed: u64, from: u64, runs: u64, done: impl Fn()) -> Self {
        let mut tally = Self::default();
        for number in from..from + runs {
            let one = Parallelogram::draw(seed, number);
            let verdict = one.run();
            let key = (one.method.name().to_owned(), one.is_far());
            let counts = tally.counts.entry(key).or_default();
            counts[1] += 1;
            if verdict == Verdict::Right {
                counts[0] += 1;
            } else {
                tally.others.push((number, one, verdict));
            }
            done();
        }
        tally
    }

    /// Returns the number of correct runs, and of all runs.
    #[must_use]
    pub fn right(&self) -> [u64; 2] {
        let counts = self.counts.values();
        counts.fold([0, 0], |[a, b], [right, all]| [a + right, b + all])
    }

    /// Whether no run is wrong, no run stopped late, and at least 97 of 100 runs passed.
    #[must_use]
    pub fn passes(&self) -> bool {
        let in_time = |verdict: &Verdict| matches!(verdict, Verdict::Stopped { in_time: true, .. });
        let [right, all] = self.right();
        self.others.iter().all(|(_, _, v)| in_time(v)) && 100 * right >= 97 * all
    }

    /// Returns a table, and a line for each run that did not pass.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        // Writing into a string does not fail.
        for ((method, is_far), [right, all]) in &self.counts {
            let place = if *is_far {
                "1e6 m away"
            } else {
                "near the origin"
            };
            let _ = writeln!(text, "{method:>8} {place:16} {right:>5} of {all:>5} right");
        }
        for (number, one, verdict) in &self.others {
            let said = match verdict {
                Verdict::Right => continue,
                Verdict::Stopped { error, in_time } => {
                    let late = if *in_time {
                        ""
                    } else {
                        " after more than a second"
                    };
                    format!("stopped{late}: {error}")
                }
                Verdict::Wrong(how) => format!("WRONG: {how}"),
            };
            let _ = writeln!(text, "run {number}, {one}: {said}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of runs is the requested number, and every method is tested.
    #[test]
    fn parallelograms_pass_their_flat_poses_at_speed() {
        let tally = Tally::of(1, 0, 150, || {});
        assert!(tally.passes(), "{}", tally.describe());
        assert_eq!(tally.counts.len(), 8, "{:?}", tally.counts);
    }

    /// The error due to rounding is negligible near the origin, and less than a ten-thousandth of a
    /// radian far away.
    #[test]
    fn rounding_explains_errors_far_from_the_origin_only() {
        for number in 0..1000 {
            let one = Parallelogram::draw(3, number);
            let turned = one.omega.abs() * SECONDS;
            let off = turned * one.speed_error();
            let most = if one.is_far() { 1e-4 } else { 1e-10 };
            assert!(off < most, "run {number}, {one}: {off:e}");
        }
    }

    /// Rounding errors at a singular configuration far from the origin cause a relative change of
    /// the speed of 4e-8, and a change of the angle of 1.0e-6 rad four seconds later.
    #[test]
    fn a_passage_far_away_is_as_good_as_its_coordinates_are_known() {
        let one = Parallelogram::draw(202, 129);
        assert_eq!(one.run(), Verdict::Right, "{one}");
    }

    #[test]
    fn time_asleep_is_no_time_of_the_processor() {
        let clock = Clock::start();
        std::thread::sleep(Duration::from_millis(50));
        let elapsed = clock.elapsed();
        if clock.processor.is_some() {
            assert!(elapsed < Duration::from_millis(50), "{elapsed:?}");
        } else {
            assert!(elapsed >= Duration::from_millis(50), "{elapsed:?}");
        }
    }
}
