//! Many mechanisms with data that vary within the tolerances of a scene. In each mechanism, each
//! point, direction and number has a random value within its tolerance. The mechanism is assembled
//! again from the described configuration and analysed. The results are the ranges of verdicts,
//! ranks, unique reactions and positions.
//!
//! Displacements are uniformly distributed. The radius of the ball for a point, and of the ball for
//! the rotation vector of a direction or an axis, is the tolerance. Numbers are uniform in their
//! interval. Each point of each body is displaced independently, because each point is manufactured
//! independently. A drive has the points of its joint. Masses and forces are not varied, unless a
//! key varies them ([`Variation`]).
//!
//! If rows are redundant within the tolerances, samples are assembled on the independent rows. The
//! small violations of the redundant rows are a result. The second analysis of each sample treats
//! the numbers of the sample as exact, without clearance; see [`Sample`].
//!
//! Ranges are computed in the order of the samples, so the number of threads does not change any
//! bit.

mod draw;
mod error;
mod failed;
mod limits;
mod nominal;
mod quantity;
mod sample;
mod summary;
#[cfg(test)]
mod tests;
mod vary;

use std::num::NonZeroUsize;

use crate::documents::ToleranceDocument;
use model::System;
use model::words::in_same_units;
use rayon::prelude::*;
use scene::Scene;
use solvability::Elasticity;

use crate::assembled::AssembledScene;
use crate::workers::Workers;
use nominal::Nominal;

pub use error::ToleranceError;
pub use failed::SampleFailure;
pub use limits::{ROWS_MAX, SAMPLES, SAMPLES_MAX};
pub use sample::{AssembledSample, Sample};
pub use vary::{Variation, VariedText};

/// Settings of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToleranceOptions {
    /// Number of samples.
    pub samples: usize,
    /// The seed of the random numbers. The same seed gives the same samples, for any number of
    /// threads.
    pub seed: u64,
    /// Number of threads. `None` means one thread for each core.
    pub threads: Option<NonZeroUsize>,
}

impl Default for ToleranceOptions {
    fn default() -> Self {
        Self {
            samples: SAMPLES,
            seed: 1,
            threads: None,
        }
    }
}

/// A scene whose data vary within their tolerances.
///
/// ```
/// use pfaff::AssembledScene;
/// use pfaff::model::Registry;
/// use pfaff::tolerance::{ToleranceOptions, ToleranceStudy};
///
/// // A beam of 20 N on a hinge and a roller 2 m apart, its centre of mass in the middle.
/// let scene = r#"
/// scene = { name = "beam", space = "plane", gravity = [0.0, -10.0], tolerance = 1e-3 }
/// body = [{ name = "beam", mass = 2.0, inertia = 1.0, position = [1.0, 0.0] }]
/// joint = [
///     { name = "hinge", type = "revolute", bodies = ["ground", "beam"], at = [0.0, 0.0] },
///     { name = "roller", type = "pin-in-slot", bodies = ["ground", "beam"], at = [2.0, 0.0], axis = [1, 0] },
/// ]
/// "#;
/// let beam = AssembledScene::read("beam.toml", scene, &Registry::standard())?;
/// let study = ToleranceStudy::new(beam, 0.0)?;
/// let options = ToleranceOptions { samples: 100, ..ToleranceOptions::default() };
/// let found = study.run(&options, || false, |_| ())?;
/// let roller = &found.document.reactions.iter().find(|r| r.name == "roller").unwrap();
/// let range = roller.values[0].range.as_ref().unwrap();
/// assert!(range.least < 10.0 && range.greatest > 10.0 && range.width() < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct ToleranceStudy<'r> {
    nominal: Nominal,
    vary: Option<VariedText<'r>>,
}

/// All samples, and their combined results.
pub struct ToleranceResult {
    /// The computed samples, in their order.
    pub samples: Vec<Sample>,
    /// Combined results of the samples.
    pub document: ToleranceDocument,
}

impl<'r> ToleranceStudy<'r> {
    /// Analyses the described mechanism at a time of its motion. At t = 0, no run is needed.
    ///
    /// # Errors
    /// - [`ToleranceError::NoTolerance`], [`ToleranceError::NoData`]: no datum varies.
    /// - [`ToleranceError::TooLarge`]: the mechanism has too many rows.
    /// - [`ToleranceError::Study`]: the mechanism cannot be assembled, moved to that time, or
    ///   analysed at that time.
    pub fn new(assembled: AssembledScene, t: f64) -> Result<Self, ToleranceError> {
        Self::varying(assembled, t, None)
    }

    /// Works like [`Self::new`], with further numbers of the scene that vary. In this case, the
    /// scene need not state a tolerance.
    ///
    /// # Errors
    /// Returns the errors of [`Self::new`].
    pub fn varying(
        assembled: AssembledScene,
        t: f64,
        vary: Option<VariedText<'r>>,
    ) -> Result<Self, ToleranceError> {
        let mechanism = &assembled.mechanism;
        if !mechanism.has_tolerances() && vary.is_none() {
            return Err(ToleranceError::NoTolerance);
        }
        let rows = mechanism.layout().rows();
        if rows > ROWS_MAX {
            return Err(ToleranceError::TooLarge { rows });
        }
        let nominal = Nominal::new(assembled, t)?;
        if nominal.data.is_empty() && vary.is_none() {
            return Err(ToleranceError::NoData);
        }
        Ok(Self { nominal, vary })
    }

    /// Returns the same study with bounds for elastic joints. The bounds are computed for reactions
    /// that are not unique with the described redundancy.
    #[must_use]
    pub fn with_bounds(mut self, scene: Scene, elasticity: Option<Elasticity>) -> Self {
        let prepared = elasticity.map(|elasticity| self.nominal.sample_bounds(scene, elasticity));
        self.nominal.bounds = prepared;
        self
    }

    /// Computes one sample, counted from 1.
    #[must_use]
    pub fn sample(&self, seed: u64, number: u64) -> Sample {
        self.nominal.sample(self.vary.as_ref(), seed, number)
    }

    /// Computes all samples. `progress` is called with each sample, in any order. `interrupted` is
    /// called often. If it returns true, the work ends, and the result contains the samples
    /// computed so far.
    ///
    /// # Errors
    /// - [`ToleranceError::Samples`]: the number of samples is out of its range.
    pub fn run(
        &self,
        options: &ToleranceOptions,
        interrupted: impl Fn() -> bool + Sync,
        progress: impl Fn(&Sample) + Sync,
    ) -> Result<ToleranceResult, ToleranceError> {
        let samples = options.samples;
        if !(1..=SAMPLES_MAX).contains(&samples) {
            return Err(ToleranceError::Samples { samples });
        }
        let workers = Workers::start(options.threads);
        let make = |number: u64| {
            if interrupted() {
                return None;
            }
            let sample = self.sample(options.seed, number);
            progress(&sample);
            Some(sample)
        };
        let all = 1..=samples as u64;
        let made: Vec<Sample> = workers.install(|| {
            all.into_par_iter()
                .filter_map(in_same_units(make))
                .collect()
        });
        Ok(ToleranceResult {
            document: self.nominal.document(options, self.list(), &made),
            samples: made,
        })
    }

    /// Estimates the memory of this many samples (bytes).
    #[must_use]
    pub fn memory(&self, samples: usize) -> usize {
        samples.saturating_mul(self.nominal.numbers_of_sample() * size_of::<f64>())
    }

    /// Returns the numbers of the scene that vary.
    fn list(&self) -> &[Variation] {
        self.vary.as_ref().map_or(&[], |vary| &vary.list)
    }

    /// Returns the columns of the table of samples.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        self.nominal.columns(self.list())
    }

    /// Returns a row of the table of samples.
    #[must_use]
    pub fn row(&self, sample: &Sample) -> Vec<String> {
        self.nominal.row(self.list(), sample)
    }

    /// Returns the names of the markers and their positions (m). For each marker, the first
    /// position follows from the data given in the scene. The other positions come from the
    /// samples.
    #[must_use]
    pub fn clouds(&self, samples: &[Sample]) -> Vec<(String, Vec<[f64; 3]>)> {
        self.nominal.clouds(samples)
    }
}
