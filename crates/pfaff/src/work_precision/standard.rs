//! The reference values of runs: values by index and instant, the accuracy of each kind, and the
//! source of the values.

use model::Mechanism;
use solvability::{ReactionStretches, Stretches};

use super::observation::{Observation, reaction_place, units};

/// A row and an instant of a reference have the same time if their times differ by less than this
/// fraction of the time.
const SAME_TIME: f64 = 1e-9;

/// Errors of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Error of each kind in the order of [`Kind`](super::Kind). It is the largest error over
    /// components and instants, with lengths and torques divided by the size of the mechanism. The
    /// error is relative to the largest value of the kind. It is relative to 1 for positions with
    /// smaller values, and if all values are zero. Without a reference, the error is NaN.
    pub scaled: [f64; 4],
    /// The largest difference of a coordinate or velocity, in SI units.
    pub state: f64,
}

impl Errors {
    /// Errors without a reference.
    pub(super) const UNKNOWN: Self = Self {
        scaled: [f64::NAN; 4],
        state: f64::NAN,
    };

    /// Returns the larger of the errors of position and velocity.
    #[must_use]
    pub fn motion(&self) -> f64 {
        self.scaled[0].max(self.scaled[1])
    }
}

/// The values of a motion that is known without a run. [`Kind::place`](super::Kind::place) returns
/// the indices of the values.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Source of the values.
    pub source: String,
    /// Bound on the error of the values of each kind, scaled as [`Errors::scaled`].
    pub limits: [f64; 4],
    /// Values in the order of time.
    pub instants: Vec<ReferenceInstant>,
}

/// Reference values of one mechanism.
#[derive(Clone, Debug)]
pub(super) struct Standard {
    /// Bound on the error of the values of each kind, scaled as [`Errors::scaled`]. Without a
    /// reference, the bound is NaN.
    pub(super) limits: [f64; 4],
    instants: Vec<ReferenceInstant>,
    units: [Vec<f64>; 4],
    scales: [f64; 4],
}

/// Values at one time, by index.
#[derive(Clone, Debug)]
pub struct ReferenceInstant {
    /// Time (s).
    pub t: f64,
    /// Indices and values of each kind.
    pub values: [Vec<(usize, f64)>; 4],
}

impl Standard {
    /// Returns the bound on the error of the motion: the larger bound of position and velocity.
    pub(super) fn motion_limit(&self) -> f64 {
        self.limits[0].max(self.limits[1])
    }

    /// Returns the values of a reference.
    pub(super) fn known(reference: &Reference, mechanism: &Mechanism, size: f64) -> Self {
        let units = units(mechanism, size);
        Self::new(reference.instants.clone(), reference.limits, units)
    }

    /// Returns the mean of two runs at their common times. The bound on the error of the mean is
    /// the difference of the runs. Only the reactions with the indices `unique` are used.
    pub(super) fn mean(
        [a, b]: [&[Observation]; 2],
        unique: &[usize],
        mechanism: &Mechanism,
        size: f64,
    ) -> Self {
        let mean = |(a, b): (&Observation, &Observation)| {
            let values = [0, 1, 2, 3].map(|kind| {
                let (x, y) = (&a.values[kind], &b.values[kind]);
                let places = (0..x.len()).filter(|place| kind < 3 || unique.contains(place));
                places.map(|i| (i, 0.5 * (x[i] + y[i]))).collect()
            });
            ReferenceInstant { t: a.t, values }
        };
        let instants = a.iter().zip(b).map(mean).collect();
        let mut standard = Self::new(instants, [0.0; 4], units(mechanism, size));
        if let Some(errors) = standard.errors(a) {
            // Each run differs from the mean by half of the difference of the two runs.
            standard.limits = errors.scaled.map(|e| 2.0 * e);
        }
        standard
    }

    fn new(instants: Vec<ReferenceInstant>, limits: [f64; 4], units: [Vec<f64>; 4]) -> Self {
        let scale = |kind: usize| {
            let values = instants.iter().flat_map(|i| &i.values[kind]);
            let sizes = values.map(|&(place, value)| (value / units[kind][place]).abs());
            let largest = sizes.fold(if kind == 0 { 1.0 } else { 0.0 }, f64::max);
            if largest > 0.0 { largest } else { 1.0 }
        };
        let scales = [scale(0), scale(1), scale(2), scale(3)];
        let is_known = |kind: usize| instants.iter().any(|i| !i.values[kind].is_empty());
        let known = [is_known(0), is_known(1), is_known(2), is_known(3)];
        let mut limits = limits;
        for (limit, known) in limits.iter_mut().zip(known) {
            *limit = if known { *limit } else { f64::NAN };
        }
        Self {
            limits,
            instants,
            units,
            scales,
        }
    }

    /// Adds the kinds without a reference from another instance.
    pub(super) fn completed_by(mut self, other: &Self) -> Self {
        for kind in 0..4 {
            if !self.limits[kind].is_nan() {
                continue;
            }
            let mut taken = 0;
            for instant in &mut self.instants {
                let same = |o: &&ReferenceInstant| is_same_time(o.t, instant.t);
                if let Some(theirs) = other.instants.iter().find(same) {
                    instant.values[kind].clone_from(&theirs.values[kind]);
                    taken += theirs.values[kind].len();
                }
            }
            if taken > 0 {
                self.limits[kind] = other.limits[kind];
                self.scales[kind] = other.scales[kind];
            }
        }
        self
    }

    /// Returns the errors of a run. Returns `None` if the run has no row at one of the instants.
    pub(super) fn errors(&self, run: &[Observation]) -> Option<Errors> {
        let mut errors = Errors {
            scaled: [0.0; 4],
            state: 0.0,
        };
        for expected in &self.instants {
            let row = run.iter().find(|row| is_same_time(row.t, expected.t))?;
            for kind in 0..4 {
                for &(place, value) in &expected.values[kind] {
                    let gap = (row.values[kind][place] - value).abs();
                    let relative = match gap {
                        0.0 => 0.0,
                        _ => gap / (self.units[kind][place] * self.scales[kind]),
                    };
                    errors.scaled[kind] = worse(errors.scaled[kind], relative);
                    if kind < 2 {
                        errors.state = worse(errors.state, gap);
                    }
                }
            }
        }
        for (error, limit) in errors.scaled.iter_mut().zip(self.limits) {
            *error = if limit.is_nan() { f64::NAN } else { *error };
        }
        Some(errors)
    }
}

/// Returns the larger value. A value that is not finite counts as the largest.
fn worse(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

fn is_same_time(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_TIME * a.abs().max(b.abs())
}

/// Returns the indices of the components of reactions that are unique on all stretches of a run,
/// including the named components of definitions.
pub(super) fn unique_reactions(verdicts: &Stretches, mechanism: &Mechanism) -> Vec<usize> {
    let space = mechanism.space();
    let of_reaction = |found: &ReactionStretches| -> Vec<usize> {
        let unique = found.components.iter();
        let unique = unique.filter(|(_, track)| track.of_run().is_unique());
        let component = |name| space.component(name).unwrap_or(space.n_v());
        let place = |name| reaction_place(mechanism, found.id.0, component(name));
        unique.map(|(name, _)| place(name)).collect()
    };
    verdicts.reactions.iter().flat_map(of_reaction).collect()
}

#[cfg(test)]
mod tests {
    use model::System;
    use solvability::{Verdict, VerdictTrack};

    use super::*;
    use crate::Study;

    /// A number is compared if it is unique on the whole run, even if it is not unique at the
    /// start.
    #[test]
    fn only_what_is_unique_on_the_run_is_compared() {
        let mut d = model::Description::new("sleigh");
        let body = d.body(model::Body::new("sleigh", 1.0, 1.0));
        let blade = joints::KnifeEdge {
            s: [0.0; 2],
            normal: joints::Direction::Y,
        };
        d.joint("blade", &[body], blade);
        let study = Study::build(d).expect("a study");
        let mechanism = &study.prepared.mechanism;
        let mut verdicts = Stretches::unique(mechanism, [0.0, 1.0], &[]);
        // The components are Fx, Fy and N of a blade; a blade has no torque.
        assert_eq!(unique_reactions(&verdicts, mechanism), [0, 1, 3]);
        verdicts.reactions[0].components[1].1 =
            VerdictTrack::constant([0.0, 1.0], Verdict::NotUnique);
        assert_eq!(unique_reactions(&verdicts, mechanism), [0, 3]);
        assert_eq!(mechanism.layout().groups.len(), 1);
    }
}
