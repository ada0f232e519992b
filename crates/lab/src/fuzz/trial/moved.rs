//! Properties that a motion must have.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use pfaff::Study;
use pfaff::dynamics::{Misfit, Sample, Stabilisation};
use pfaff::model::start::scene_size;
use pfaff::model::{Mechanism, Scratch, System};
use pfaff::report::{ReactionTable, Selection, Trajectory, TrajectoryTable, columns_of_reactions};
use pfaff::solvability::ChosenValues;
use pfaff::study::more_columns;

use super::reach::{ROWS, Reach, STEPS, named};

/// Largest residual of projected rows, as a fraction of the terms of the row of Φ or C·v − b. Near
/// a singular configuration, coordinates are accurate only to √ε = 1.5e-8. In redundant rows, the
/// residuals of the independent rows are multiplied by coefficients of up to 10 (larger
/// coefficients cause an exchange of rows), which gives 1.5e-7. A larger residual means another
/// motion, not a loss of accuracy. The limit in a run is different: redundant rows may have a
/// residual of 1e-11 of the terms on which they depend, multiplied by coefficients that are not
/// computed here. This check does not use that limit.
const RESIDUAL: f64 = 1e-6;

/// Accuracy of positions, relative to the size of the scene. The size includes the farthest body,
/// because projections transfer the rounding error of this body to the neighbouring bodies.
const FAR_ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// Largest rates of a body at rest, as a fraction of the size of the mechanism per second.
const REST: f64 = 1e-14;

/// Simulates the motion within the limits of a trial. Returns the stage that the simulation
/// reached, and the number of output rows. The tables are written in the format of `simulate`, and
/// the function checks that they can be read.
pub(super) fn check(study: &Study) -> (Reach, usize) {
    let plan = match study.plan() {
        Ok(plan) => plan,
        Err(e) => {
            named(&e);
            return (Reach::JudgedStart, 0);
        }
    };
    let mechanism = &study.prepared.mechanism;
    let mut trajectory = TrajectoryTable::new(
        Vec::new(),
        Trajectory::new(mechanism, more_columns(&study.scene.output)),
        None,
    )
    .expect("a vector takes everything");
    let columns = columns_of_reactions(mechanism, &Selection::All, &[], |_| false);
    let columns = columns.expect("all of them");
    let mut reactions = ReactionTable::new("choice.csv", Vec::new(), mechanism, columns, None)
        .expect("a vector takes everything");
    let no_groups = ChosenValues::new(Vec::new(), Vec::new());
    let mut checked = Rows {
        mechanism,
        scratch: mechanism.scratch(),
        is_projected: plan.options().stabilisation == Stabilisation::Projection,
        size: scene_size(mechanism, &study.prepared.q),
        last: f64::NEG_INFINITY,
        missed: study
            .prepared
            .may_miss
            .then(|| vec![0.0; mechanism.layout().rows()]),
    };
    let (steps, mut rows, mut with_reactions) = (AtomicUsize::new(0), 0, 0);
    let watch = |_: f64| {
        if steps.fetch_add(1, Ordering::Relaxed) < STEPS {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let outcome = plan.simulate_watched(&watch, &|| false, |sample| {
        rows += 1;
        checked.row(sample);
        let has_accelerations = trajectory.has_accelerations();
        let a = has_accelerations
            .then(|| sample.acceleration())
            .transpose()?;
        trajectory
            .row(sample.t, (sample.q, sample.v), a.as_deref())
            .expect("a vector takes everything");
        let forces = sample.reactions()?;
        reactions
            .row(sample.t, &forces, &no_groups)
            .expect("a vector takes everything");
        with_reactions += 1;
        Ok(if rows < ROWS {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        })
    });
    readable(
        trajectory.finish().expect("a vector takes everything"),
        rows,
        "trajectory",
    );
    let (written, _) = reactions.finish().expect("a vector takes everything");
    readable(written, with_reactions, "reactions");
    // Only the last row of a run may have no reactions.
    assert!(
        with_reactions == rows || outcome.is_err(),
        "rows without reactions"
    );
    if let (Ok(summary), Some(missed)) = (&outcome, &checked.missed) {
        reported(missed, &summary.misfits);
    }
    let reach = match outcome {
        Ok(summary) if summary.t >= plan.options().t_end => {
            assert!(rows >= 1, "a run without rows");
            Reach::Moved
        }
        Ok(_) => {
            assert!(
                rows >= ROWS || steps.load(Ordering::Relaxed) > STEPS,
                "a run ended before its end, without a reason"
            );
            Reach::Cut
        }
        Err(failure) => {
            let text = failure.to_string();
            assert!(
                !text.trim().is_empty(),
                "a run stopped without a reason: {:?}",
                failure.error
            );
            Reach::Stopped
        }
    };
    (reach, rows)
}

/// Rows of a run, in sequence.
struct Rows<'m> {
    mechanism: &'m Mechanism,
    scratch: Scratch,
    is_projected: bool,
    size: f64,
    last: f64,
    /// The largest residual of each row above the limits of this check. `None` if redundant rows
    /// must not be violated.
    missed: Option<Vec<f64>>,
}

impl Rows<'_> {
    fn row(&mut self, sample: &Sample<'_, '_>) {
        let Sample { t, q, v, .. } = *sample;
        assert!(t > self.last, "rows at t = {t} s after {} s", self.last);
        self.last = t;
        assert!(
            q.iter().chain(v).all(|x| x.is_finite()),
            "the state at t = {t} s is not finite"
        );
        if self.is_projected {
            self.residuals(t, q, v);
        }
    }

    fn residuals(&mut self, t: f64, q: &[f64], v: &[f64]) {
        let Self {
            mechanism,
            scratch: s,
            size,
            missed,
            ..
        } = self;
        let layout = mechanism.layout();
        // At a break time, rows contain the values just before the break.
        let t_before = if t > 0.0 && layout.break_times.contains(&t) {
            t.next_down()
        } else {
            t
        };
        mechanism.pose(t_before, q, s);
        mechanism.phi(s);
        mechanism.c(s);
        mechanism.b(s);
        for i in 0..layout.rows() {
            if i < layout.m {
                let (phi, scale) = (s.phi[i].abs(), mechanism.scales(s).position(i));
                let far = if layout.is_angular(i) { 0.0 } else { *size };
                let limit = RESIDUAL * scale + FAR_ROUNDINGS * far;
                if let Some(missed) = missed {
                    if phi > limit {
                        missed[i] = missed[i].max(phi);
                    }
                    // The rates of violated rows are also nonzero, so they are not checked.
                    continue;
                }
                assert!(
                    phi <= limit,
                    "t = {t} s: |Φ| of row {} is {phi:e}, its terms {scale:e}",
                    layout.labels[i]
                );
            }
            let (rate, scale) = (
                layout.velocity_residual(s, i, v).abs(),
                mechanism.scales(s).velocity(i, v),
            );
            // The bound is relative to the rate of the fastest row, and allows for the rounding
            // errors of accelerations over one second.
            let fastest = (0..layout.rows())
                .map(|k| mechanism.scales(s).velocity(k, v))
                .fold(scale, f64::max);
            let limit = RESIDUAL * fastest + REST * mechanism.scales(s).position(i).max(*size);
            if let Some(missed) = missed {
                if rate > limit {
                    missed[i] = missed[i].max(rate);
                }
                continue;
            }
            assert!(
                rate <= limit,
                "t = {t} s: |C·v − b| of row {} is {rate:e}, the largest terms {fastest:e}",
                layout.labels[i]
            );
        }
    }
}

/// Checks that the results contain the violations at output rows, and that the violations are
/// within their bounds.
fn reported(missed: &[f64], misfits: &[Misfit]) {
    for (row, &missed) in missed
        .iter()
        .enumerate()
        .filter(|(_, missed)| **missed > 0.0)
    {
        let misfit = misfits.iter().find(|m| m.row == row);
        let largest = misfit.map_or(0.0, |m| m.largest);
        assert!(
            missed <= largest * (1.0 + 1e-9),
            "row {row} is violated by {missed:e}, but {largest:e} is reported"
        );
    }
    for m in misfits {
        assert!(m.largest <= m.bound, "row {}: {m:?}", m.label);
    }
}

/// Checks that a table has a header of distinct names, and that all rows have the same number of
/// values.
fn readable(table: Vec<u8>, rows: usize, name: &str) {
    let mut reader = csv::Reader::from_reader(table.as_slice());
    let header = reader.headers().expect("a header").clone();
    let mut names: Vec<&str> = header.iter().collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(
        names.len(),
        header.len(),
        "{name}: several columns have the same name: {header:?}"
    );
    let mut count = 0;
    for row in reader.records() {
        let row = row.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(
            // A missing value is an empty cell.
            row.iter().all(|x| x.is_empty() || x.parse::<f64>().is_ok()),
            "{name}: {row:?}"
        );
        count += 1;
    }
    assert_eq!(count, rows, "{name}: rows");
}
