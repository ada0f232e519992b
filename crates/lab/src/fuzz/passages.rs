//! Parallelograms that turn through their flat poses at speed, where another branch of motion
//! begins: near the origin and a thousand kilometres from it, by every method.
//!
//! What is right has a closed form. All cranks keep one angle θ, so the coupler does not turn, and
//! `½·I·θ̇² + W·sin θ` keeps its value with `I = Σ (J + m·l²/4) + M·l²` and
//! `W = g·l·(n·m/2 + M)`; without gravity θ = θ₀ + ω·t.

use std::collections::BTreeMap;
use std::fmt::{self, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use dynamics::{Method, MotionOptions, RowChoice, prepare, simulate};
use model::{Mechanism, StartOptions};

use crate::mechanisms::cranks::cranks_at;
use suite::numbers::Numbers;

/// How far from the origin the far ones stand at most (m).
const FAR: f64 = 1e6;

/// How long they turn (s).
const SECONDS: f64 = 5.0;

/// A run that stops is to say so within this time of its processor.
const PATIENCE: Duration = Duration::from_secs(1);

/// What angles and energies may be off by, in tolerances, and at least: a few dozen passages,
/// each of which may miss its tolerance by a factor of ten.
const TOLERANCES: f64 = 1e4;

/// No step of a run ends nearer to a flat pose than this (share of pivots; here the angle to it,
/// in radians): a limit of the product, repeated here.
const NEAREST: f64 = 1e-3;

/// Stands in for gravity (m/s²).
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
    /// On the right branch at every row.
    Right,
    /// With an error by name.
    Stopped {
        /// What it says.
        error: String,
        /// Whether it said so within a second of its processor.
        in_time: bool,
    },
    /// A row contradicts the closed form.
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
    /// The one of this number; every other one stands far from the origin.
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

    /// Whether it stands far from the origin.
    #[must_use]
    pub fn is_far(&self) -> bool {
        self.origin != [0.0; 2]
    }

    /// What rounding of the coordinates may change the speed by, as a share of it.
    ///
    /// Coordinates at a distance D from the origin are known to `ε·D`, so the angles of cranks of
    /// length l to `ε·D/l`. At an angle σ to the flat pose the ratio of their speeds is wrong by
    /// that over σ, and a step that begins or ends there hands the error on to the speed of all
    /// cranks. Steps end at various σ, so the passage with the least one decides. The angle is then
    /// off by this share of what has been turned, the energy by twice this share. Within 2 m of
    /// the origin it is below 3e-12, and on another branch angles are off by some radians.
    fn speed_error(&self) -> f64 {
        let distance = self.origin[0].hypot(self.origin[1]);
        f64::EPSILON * (distance + self.length) / (self.length * NEAREST)
    }

    /// Runs it and compares every row with the closed form.
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
                    "at {t} s the angles are {apart:.1e} rad apart, and the cranks by {led:.1e} off"
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

/// The time of a thread: of the processor, which others on the machine do not change, or, where
/// the system does not tell that, of the clock on the wall.
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

    /// Since the start.
    fn elapsed(&self) -> Duration {
        match (self.processor, Self::processor()) {
            (Some(then), Some(now)) => now.saturating_sub(then),
            _ => self.wall.elapsed(),
        }
    }

    /// What the thread has used so far; Linux tells it in nanoseconds.
    fn processor() -> Option<Duration> {
        let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        let used = told.split_whitespace().next()?.parse().ok()?;
        Some(Duration::from_nanos(used))
    }
}

/// What came out of many runs.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// By method and place: right ones, and all.
    pub counts: BTreeMap<(String, bool), [u64; 2]>,
    /// Runs that stopped, or were wrong: which, and what was said.
    pub others: Vec<(u64, Parallelogram, Verdict)>,
}

impl Tally {
    /// Of the runs `from`, … of a seed; `done` is called after each.
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

    /// Right ones, and all.
    #[must_use]
    pub fn right(&self) -> [u64; 2] {
        let counts = self.counts.values();
        counts.fold([0, 0], |[a, b], [right, all]| [a + right, b + all])
    }

    /// Whether none is wrong, none stopped late, and at least 97 of 100 passed.
    #[must_use]
    pub fn passes(&self) -> bool {
        let in_time = |verdict: &Verdict| matches!(verdict, Verdict::Stopped { in_time: true, .. });
        let [right, all] = self.right();
        self.others.iter().all(|(_, _, v)| in_time(v)) && 100 * right >= 97 * all
    }

    /// A table, and a line for each that did not pass.
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

    /// As many as were asked for; every method is among them.
    #[test]
    fn parallelograms_pass_their_flat_poses_at_speed() {
        let tally = Tally::of(1, 0, 150, || {});
        assert!(tally.passes(), "{}", tally.describe());
        assert_eq!(tally.counts.len(), 8, "{:?}", tally.counts);
    }

    /// Rounding explains nothing near the origin, and far away less than a ten-thousandth of a
    /// radian.
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

    /// Rounding at a passage far from the origin changes the speed by 4e-8 of it, and so the angle
    /// by 1.0e-6 rad four seconds later.
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
