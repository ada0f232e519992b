//! Computes the verdicts along the motion of a scene: runs the scene, records enough rows for its
//! speed, and analyses them.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::documents::AlongDocument;
use crate::documents::AnalysisDocument;
use dynamics::plan::{Reactions, Rows};
use dynamics::{MotionError, MotionOptions, OutputRequest, Plan, Stop};
use model::start::scene_size;
use model::{ColumnKind, Layout, Mechanism, System};
use solvability::{
    AlongError, Extent, MotionAnalysis, PassageKind, State, Stretches, along_motion_of_parts,
};

use crate::error::StudyError;
use crate::study::Study;

/// Smallest number of analysed states. The states are evenly spaced in time. For mechanisms with
/// many rows, the smallest number is `INTERVALS_OF_ROWS` divided by the number of rows, but at
/// least `INTERVALS_LEAST`.
const INTERVALS: usize = 200;
const INTERVALS_OF_ROWS: usize = 240_000;
const INTERVALS_LEAST: usize = 24;

/// Recorded rows between two analysed states. States between rows are interpolated and then moved
/// onto the constraints. The interpolation error is REACH⁴/384 times the distance of the rows.
/// Mechanisms with more than `MANY` rows of C have one recorded row per analysed state. The
/// integrator interpolates this row, because a projection of rows would take longer than all steps.
/// The accelerations are slopes of the velocities. They are used only for the direction of the
/// motion at singular instants.
const ROWS: usize = 4;
const MANY: usize = 10_000;

/// Largest motion of a body between two analysed states: a displacement as a fraction of the size
/// of the mechanism, or a rotation angle (rad).
const REACH: f64 = 0.1;

/// Length of the extrapolation of a motion that stopped. It is a multiple of the time between the
/// last row and the end of the motion, or of the time between two rows if this time is longer.
const BEYOND: f64 = 8.0;

/// Largest number of analysed states.
const INTERVALS_MAX: usize = 4_000;

/// Verdicts along a motion.
#[derive(Debug)]
#[non_exhaustive]
pub struct VerdictsAlongMotion {
    /// The verdicts on each stretch of time, and the singular configurations.
    pub along: MotionAnalysis,
    /// Last time that was analysed (s).
    pub to: f64,
    /// Number of analysed states.
    pub samples: usize,
    /// Largest displacement of a body between two analysed states: a fraction of the size of the
    /// mechanism, or an angle (rad).
    pub reach: f64,
    /// Reason why the motion stopped, if it did.
    pub stopped: Option<MotionError>,
    /// Time (s) up to which the analysis extrapolated the motion smoothly beyond its last state, if
    /// the motion stopped at a singular configuration. The analysis of the singular configuration
    /// determines how the motion continues. The motion itself was not computed beyond its last
    /// state.
    pub continued_to: Option<f64>,
}

impl VerdictsAlongMotion {
    /// The verdicts as plain data, with the names of this layout: `along` in the output of
    /// `pfaff analyze --along --json`.
    #[must_use]
    pub fn document(&self, layout: &Layout) -> AlongDocument {
        let extent = (self.samples, self.reach);
        let mut document = AlongDocument::new(&self.along, layout, self.to, extent);
        document.stopped = self.stopped.as_ref().map(ToString::to_string);
        document.continued_to = self.continued_to;
        document
    }

    /// Adds the verdicts to the document of a configuration of the same scene. The generic verdicts
    /// of that document are then the verdicts of the stretches of the motion that contain its time.
    pub fn add_to(&self, document: &mut AnalysisDocument, layout: &Layout) {
        let generic = self.along.verdicts.generic_at(document.configuration.time);
        if let Some(verdicts) = generic {
            document.add_generic_verdicts(&verdicts);
        }
        document.answers.along = Some(self.document(layout));
    }
}

/// Progress of the verdicts along a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionProgress {
    /// The motion has reached this time (s).
    Moving(f64),
    /// Verdicts are computed at this time (s). The times do not increase monotonically, because
    /// searches also go backwards in time.
    Judging(f64),
}

impl Study {
    /// Runs the scene up to `t_end`, or to the end that the scene states, and analyses the motion.
    /// If the run stops early, the function analyses the computed part.
    ///
    /// ```
    /// use pfaff::model::Registry;
    /// use pfaff::{RunOptions, Study};
    ///
    /// // A falling pendulum has no singular configurations.
    /// let scene = r#"
    /// scene = { name = "pendulum", space = "plane", gravity = [0.0, -9.81] }
    /// body = [{ name = "bob", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] }]
    /// joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
    /// "#;
    /// let study = Study::read("pendulum.toml", scene, &Registry::standard(),
    /// &RunOptions::default())?; let along_motion = study.verdicts_along_motion(Some(1.0), |_| {})?;
    /// assert_eq!((along_motion.to, along_motion.stopped.is_none()), (1.0, true));
    /// assert_eq!(along_motion.along.generic.redundancy, 0);
    /// assert!(along_motion.along.verdicts.reactions[0].whole.of_run().is_unique());
    /// assert!(along_motion.along.passages.is_empty());
    /// # Ok::<(), pfaff::StudyError>(())
    /// ```
    ///
    /// # Errors
    /// - [`StudyError::NoEnd`]: neither the scene nor the caller states the end of the run.
    /// - [`StudyError::Motion`]: the motion cannot begin, or stops before anything can be analysed.
    /// - [`StudyError::Along`]: the motion cannot be analysed.
    pub fn verdicts_along_motion(
        &self,
        t_end: Option<f64>,
        progress: impl FnMut(MotionProgress) + Send,
    ) -> Result<VerdictsAlongMotion, StudyError> {
        self.verdicts_along_motion_until(t_end, &|| false, progress)
    }

    /// Works like [`Self::verdicts_along_motion`], but calls `stop` at each evaluation of the
    /// motion, and before the motion is analysed.
    ///
    /// # Errors
    /// Returns the errors of [`Self::verdicts_along_motion`], and [`StudyError::Interrupted`] if
    /// `stop` returned true.
    pub fn verdicts_along_motion_until(
        &self,
        t_end: Option<f64>,
        stop: &Stop<'_>,
        mut progress: impl FnMut(MotionProgress) + Send,
    ) -> Result<VerdictsAlongMotion, StudyError> {
        let own = self.options.as_ref().map(|options| options.t_end);
        let t_end = t_end.or(own).ok_or(StudyError::NoEnd)?;
        if !(t_end.is_finite() && t_end > 0.0) {
            return Err(StudyError::Motion(MotionError::Option {
                name: "t_end",
                value: t_end,
                expected: "a finite time > 0",
            }));
        }
        let rows = self.prepared.mechanism.layout().rows().max(1);
        let least = (INTERVALS_OF_ROWS / rows).clamp(INTERVALS_LEAST, INTERVALS);
        let run = self.record(t_end, least, stop, &mut progress)?;
        if run.stopped.is_some()
            && let Some(along_motion) = self.judge_beyond(&run, least, &mut progress)
        {
            return Ok(VerdictsAlongMotion {
                stopped: run.stopped,
                ..along_motion
            });
        }
        let needed = least as f64 * run.reach(&self.prepared.mechanism) / REACH;
        let intervals = least.max(needed.min(INTERVALS_MAX as f64).ceil() as usize);
        if run.stopped.is_none() && intervals == least {
            return self.judge(run, intervals, &mut progress);
        }
        // If the motion is too fast for these rows, it is recorded again. If the motion stopped, it
        // is recorded again up to its last state. This last state may be too close to a singular
        // configuration for a projection onto the constraints. In this case, the last row before
        // this state is used.
        let again = self.record(run.reached, intervals, stop, &mut progress)?;
        let stopped = again.stopped.is_some();
        match self.judge(again, intervals, &mut progress) {
            Err(StudyError::Along(AlongError::OffConstraints { .. }))
                if run.stopped.is_some() || stopped =>
            {
                self.judge(run, least, &mut progress)
            }
            Ok(along_motion) => Ok(VerdictsAlongMotion {
                stopped: along_motion.stopped.or(run.stopped),
                ..along_motion
            }),
            failed => failed,
        }
    }

    /// Analyses a motion that stopped, up to a time a little later than its end, if the added
    /// interval contains a singular configuration.
    fn judge_beyond(
        &self,
        run: &Record,
        intervals: usize,
        progress: &mut (impl FnMut(MotionProgress) + Send),
    ) -> Option<VerdictsAlongMotion> {
        let last = run.rows.last().filter(|_| run.rows.len() > 1)?.t;
        let to = run.reached
            + BEYOND * (run.reached - last).max(last / (run.between * intervals) as f64);
        let along = self.along(run, to, intervals, progress).ok()?;
        let passed = along.passages.iter().any(|p| {
            p.time > last && p.time < to && matches!(p.kind, PassageKind::RankDrops { .. })
        });
        passed.then(|| VerdictsAlongMotion {
            along,
            to: last,
            samples: intervals + 1,
            reach: run.reach(&self.prepared.mechanism),
            stopped: None,
            continued_to: Some(to),
        })
    }

    /// Returns verdicts at evenly spaced times up to `to`.
    fn along(
        &self,
        run: &Record,
        to: f64,
        intervals: usize,
        progress: &mut (impl FnMut(MotionProgress) + Send),
    ) -> Result<MotionAnalysis, StudyError> {
        let times: Vec<f64> = (0..=intervals)
            .map(|k| to * (k as f64 / intervals as f64))
            .collect();
        let progress = Mutex::new(progress);
        let motion = |t: f64, extent: &Extent| {
            // Skips the report while another thread is reporting.
            if let Ok(mut progress) = progress.try_lock() {
                progress(MotionProgress::Judging(t));
            }
            run.state(t, extent)
        };
        let mechanism = &self.prepared.mechanism;
        Ok(along_motion_of_parts(
            mechanism,
            motion,
            &times,
            run.verdicts.as_ref(),
        )?)
    }

    fn judge(
        &self,
        run: Record,
        intervals: usize,
        progress: &mut (impl FnMut(MotionProgress) + Send),
    ) -> Result<VerdictsAlongMotion, StudyError> {
        let start = self.start_time();
        let Some(to) = run.rows.last().map(|row| row.t).filter(|t| *t > start) else {
            return Err(match run.stopped {
                Some(error) => error.into(),
                None => StudyError::NoEnd,
            });
        };
        Ok(VerdictsAlongMotion {
            along: self.along(&run, to, intervals, progress)?,
            to,
            samples: intervals + 1,
            reach: run.reach(&self.prepared.mechanism),
            stopped: run.stopped,
            continued_to: None,
        })
    }

    /// Runs the scene and records its rows.
    fn record(
        &self,
        t_end: f64,
        intervals: usize,
        stop: &Stop<'_>,
        progress: &mut (impl FnMut(MotionProgress) + Send),
    ) -> Result<Record, StudyError> {
        let base = self.options.clone();
        let many = self.prepared.mechanism.layout().rows() > MANY;
        let between = if many { 1 } else { ROWS };
        let wanted = OutputRequest {
            rows: if many {
                Rows::Interpolated
            } else {
                Rows::Every
            },
            accelerations: !many,
            // With this option, the run also returns its verdicts. The values of the reactions are
            // not computed.
            reactions: Reactions::All,
            uniqueness: false,
            ..OutputRequest::default()
        };
        let options = MotionOptions {
            t_end,
            output_step: t_end / (between * intervals) as f64,
            ..base.unwrap_or_else(|| MotionOptions::to(t_end))
        };
        options.check()?;
        let mechanism = &self.prepared.mechanism;
        let mut rows: Vec<Row> = Vec::new();
        let plan = Plan::new(&self.prepared, &options, &wanted)?;
        let asked = AtomicBool::new(false);
        let stop = || {
            let is_asked = stop();
            asked.fetch_or(is_asked, Ordering::Relaxed);
            is_asked
        };
        let goes_on = |_| ControlFlow::Continue(());
        let outcome = plan.simulate_watched(&goes_on, &stop, |sample| {
            progress(MotionProgress::Moving(sample.t));
            let mut qd = vec![0.0; sample.q.len()];
            mechanism.rate(sample.q, sample.v, &mut qd);
            rows.push(Row {
                t: sample.t,
                q: sample.q.to_vec(),
                qd,
                v: sample.v.to_vec(),
                a: sample.acceleration()?,
            });
            Ok(ControlFlow::Continue(()))
        });
        if asked.load(Ordering::Relaxed) {
            return Err(StudyError::Interrupted);
        }
        let (summary, stopped) = match outcome {
            Ok(summary) => (summary, None),
            Err(failure) if failure.summary.t > self.start_time() => {
                (failure.summary, Some(failure.error))
            }
            Err(failure) => return Err(failure.error.into()),
        };
        if !wanted.accelerations {
            differentiate(&mut rows);
        }
        Ok(Record {
            rows,
            between,
            reached: summary.t,
            verdicts: summary.verdicts,
            stopped,
        })
    }
}

/// One recorded state with its rates.
struct Row {
    t: f64,
    q: Vec<f64>,
    qd: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

/// Sets the acceleration of each row to the slope of a parabola. The parabola passes through the
/// velocities of this row and of the two adjacent rows. For the first and the last row, it passes
/// through the velocities of the three nearest rows. With only two rows, the acceleration is the
/// slope of a line.
fn differentiate(rows: &mut [Row]) {
    let secant = |pair: &[Row]| {
        let h = pair[1].t - pair[0].t;
        let both = pair[0].v.iter().zip(&pair[1].v);
        (h, both.map(|(x, y)| (y - x) / h).collect::<Vec<f64>>())
    };
    let secants: Vec<(f64, Vec<f64>)> = rows.windows(2).map(secant).collect();
    let of = |k: Option<usize>| k.and_then(|k| secants.get(k));
    for (k, row) in rows.iter_mut().enumerate() {
        let (near, other, is_end) = match (of(k.checked_sub(1)), of(Some(k))) {
            (Some(before), Some(after)) => (before, Some(after), false),
            (Some(last), None) => (last, of(k.checked_sub(2)), true),
            (None, Some(first)) => (first, of(Some(1)), true),
            (None, None) => continue,
        };
        let ((h, d), Some((h_2, d_2))) = (near, other) else {
            row.a.clone_from(&near.1);
            continue;
        };
        let share = if is_end { -h } else { *h } / (h + h_2);
        let slopes = d.iter().zip(d_2).map(|(x, y)| x + share * (y - x));
        row.a = slopes.collect();
    }
}

/// The rows of a run.
struct Record {
    rows: Vec<Row>,
    /// Number of rows from one analysed state to the next.
    between: usize,
    /// The last accepted time (s), at or after the last row.
    reached: f64,
    /// The verdicts of the run. `None` for a mechanism without joints and drives.
    verdicts: Option<Stretches>,
    stopped: Option<MotionError>,
}

impl Record {
    /// Returns the largest displacement between analysed states.
    fn reach(&self, mechanism: &Mechanism) -> f64 {
        let Some(first) = self.rows.first() else {
            return 0.0;
        };
        let size = scene_size(mechanism, &first.q);
        let unit = |kind: &ColumnKind| match kind {
            ColumnKind::Translation => size,
            ColumnKind::Rotation => 1.0,
        };
        let units: Vec<f64> = mechanism.layout().column_kinds().iter().map(unit).collect();
        // The speeds come from velocities, because a body may have more coordinates than
        // velocities.
        let fastest = |row: &Row| {
            let rates = row.v.iter().zip(&units).map(|(v, unit)| (v / unit).abs());
            rates.fold(0.0, f64::max)
        };
        let moved =
            |pair: &[Row]| (pair[1].t - pair[0].t) * fastest(&pair[0]).max(fastest(&pair[1]));
        self.between as f64 * self.rows.windows(2).map(moved).fold(0.0, f64::max)
    }

    /// Interpolates the motion at a time between the first row and the last row, or slightly
    /// outside of this interval. At least two rows are necessary.
    fn state(&self, t: f64, extent: &Extent) -> State {
        let next = self.rows.partition_point(|row| row.t <= t);
        let k = next.clamp(1, self.rows.len() - 1);
        let (x, y) = (&self.rows[k - 1], &self.rows[k]);
        let h = y.t - x.t;
        let u = (t - x.t) / h;
        let between = |from: &[Vec<f64>; 2], to: &[Vec<f64>; 2]| {
            (0..from[0].len())
                .map(|i| hermite(u, [from[0][i], h * from[1][i]], [to[0][i], h * to[1][i]]))
                .collect()
        };
        let q = |row: &Row| [&row.q, &row.qd].map(|x| extent.coordinates(x).into_owned());
        let v = |row: &Row| [&row.v, &row.a].map(|x| extent.velocities(x).into_owned());
        State {
            q: between(&q(x), &q(y)),
            v: between(&v(x), &v(y)),
        }
    }
}

/// The cubic polynomial with these values and slopes at u = 0 and u = 1.
fn hermite(u: f64, [x, slope_x]: [f64; 2], [y, slope_y]: [f64; 2]) -> f64 {
    let d = y - x;
    let (c_2, c_3) = (
        3.0 * d - 2.0 * slope_x - slope_y,
        slope_x + slope_y - 2.0 * d,
    );
    x + u * (slope_x + u * (c_2 + u * c_3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes of parabolas are exact for velocities that are quadratic in time. This is also true
    /// at uneven times and at the ends.
    #[test]
    fn slopes_of_recorded_velocities() {
        let v = |t: f64| vec![3.0 - 2.0 * t + 0.5 * t * t, 7.0 * t];
        let row = |t: f64| Row {
            t,
            q: Vec::new(),
            qd: Vec::new(),
            v: v(t),
            a: Vec::new(),
        };
        let mut rows: Vec<Row> = [0.0, 0.5, 1.25, 1.5].into_iter().map(row).collect();
        differentiate(&mut rows);
        for row in &rows {
            let exact = [-2.0 + row.t, 7.0];
            let off = row.a.iter().zip(exact).map(|(a, b)| (a - b).abs());
            assert!(
                row.a.len() == 2 && off.fold(0.0, f64::max) < 1e-14,
                "{:?}",
                row.a
            );
        }
        // With two rows, the rate of change is constant.
        let mut rows: Vec<Row> = [1.0, 3.0].into_iter().map(row).collect();
        differentiate(&mut rows);
        assert!(rows.iter().all(|row| row.a == [0.0, 7.0]));
        differentiate(&mut []);
    }
}
