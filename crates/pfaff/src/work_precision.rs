//! Error against run time. One scene is simulated with every method at many tolerances, and the
//! results are compared with independent reference values.
//!
//! | module | content |
//! | --- | --- |
//! | `plan` | the runs of a comparison |
//! | `observation`, `standard` | the compared quantities, the reference values, and their accuracy |
//! | `measure` | runs that measure errors, and runs that measure times |
//! | `rival` | runs of other programs and other formulations, in the same table |
//! | `ranking`, `overview` | which method reaches which error in the shortest time |
//! | [`provenance`] | machine and date of the runs |

mod measure;
mod observation;
mod overview;
mod plan;
pub mod provenance;
mod ranking;
mod rival;
mod standard;

use dynamics::{Method, MotionOptions, PreparedMechanism};
use model::start::scene_size;
use model::words::rough;
use report::{CurveName, ReferenceDocument, WorkPrecisionRow, WorkPrecisionScene};

use crate::error::StudyError;
use crate::study::Study;
use measure::{Look, RunEnding, Times, clock, look, options};
use plan::ACCURATE;
use standard::{Standard, unique_reactions};

pub use observation::{Kind, Observation};
pub use overview::overview;
pub use plan::{ComparisonPlan, Curve};
pub use rival::{Rival, RivalFault, RivalRun};
pub use standard::{Errors, Reference, ReferenceInstant};

/// Number of instants at which motions without a known solution are compared.
const INSTANTS: u32 = 5;

/// Tolerances for a reference. The reference uses the tightest of these tolerances at which a
/// method reaches the end of the run.
const TIGHTEST: [f64; 3] = [1e-13, 1e-12, 1e-11];

/// A scene whose motions are compared.
pub struct Subject {
    name: String,
    title: String,
    study: Study,
    base: MotionOptions,
    reference: Option<Reference>,
    times: Times,
    /// Size of the mechanism (m).
    size: f64,
}

/// A comparison, finished or interrupted.
#[derive(Clone, Debug)]
pub struct SceneComparison {
    /// References, runs, and ranking.
    pub scene: WorkPrecisionScene,
    /// Whether the comparison was interrupted.
    pub interrupted: bool,
}

impl Subject {
    /// Creates a scene with a known motion.
    ///
    /// # Errors
    /// Returns the errors of [`Subject::of_study`].
    pub fn known(study: Study, title: &str, reference: Reference) -> Result<Self, StudyError> {
        Self::new(study, title, Some(reference))
    }

    /// Creates a scene without a known motion. The reference then consists of two methods that
    /// agree.
    ///
    /// # Errors
    /// [`StudyError::NoEnd`]: neither the scene nor the caller states the end of the run.
    pub fn of_study(study: Study) -> Result<Self, StudyError> {
        let title = study.scene.name().to_owned();
        Self::new(study, &title, None)
    }

    fn new(study: Study, title: &str, reference: Option<Reference>) -> Result<Self, StudyError> {
        let base = study.options.clone().ok_or(StudyError::NoEnd)?;
        base.check()?;
        if base.t_end <= study.start_time() {
            return Err(StudyError::NoEnd);
        }
        let times = match &reference {
            Some(known) => {
                let wanted = known.instants.iter().map(|i| i.t).collect();
                Times::multiples(wanted, base.output_step)
            }
            None => Times::evenly(INSTANTS, base.t_end),
        };
        Ok(Self {
            name: study.scene.name().to_owned(),
            title: title.to_owned(),
            size: scene_size(&study.prepared.mechanism, &study.prepared.q),
            study,
            base,
            reference,
            times,
        })
    }

    /// Returns the name of the scene.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the mechanism at its start.
    #[must_use]
    pub fn prepared(&self) -> &PreparedMechanism {
        &self.study.prepared
    }

    /// Returns the times at which motions are compared (s), in ascending order.
    #[must_use]
    pub fn instants(&self) -> &[f64] {
        &self.times.wanted
    }

    /// Compares one run with the known motion, and returns its error and the error of the
    /// reference. Returns `None` if no motion is known.
    ///
    /// # Errors
    /// [`StudyError::Motion`]: the run did not reach its end.
    pub fn errors(&self, curve: Curve, tolerance: f64) -> Result<Option<Errors>, StudyError> {
        let options = options(&self.base, curve, tolerance);
        let run = look(&self.study, &options, &self.times, f64::INFINITY, &|| false);
        if let RunEnding::Failed(error) = run.ending {
            return Err(error.into());
        }
        let known = self.reference();
        Ok(known.and_then(|known| known.errors(&run.observations)))
    }

    /// Performs all runs of a plan, and then the runs of the rivals at the same tolerances. Each
    /// row is passed on when it is finished. `interrupted` is called from time to time to decide
    /// whether to stop.
    ///
    /// # Errors
    /// [`StudyError::Analysis`]: it cannot be determined which reactions are unique. Errors of
    /// `row` are also returned.
    pub fn compare<E: From<StudyError>>(
        &self,
        plan: &ComparisonPlan,
        rivals: &[&dyn Rival],
        interrupted: &(impl Fn() -> bool + Sync),
        mut row: impl FnMut(&WorkPrecisionRow) -> Result<(), E>,
    ) -> Result<SceneComparison, E> {
        let (standard, document) = self.standard(plan, interrupted)?;
        let own = plan.curves.iter().map(|&curve| Contender::Own(curve));
        let ways: Vec<Contender<'_>> = own
            .chain(rivals.iter().map(|r| Contender::Rival(*r)))
            .collect();
        let runs = ways.len() * plan.tolerances.len();
        let mut rows: Vec<WorkPrecisionRow> = Vec::with_capacity(runs);
        'all: for way in &ways {
            let mut given_up = None;
            for &tolerance in &plan.tolerances {
                let empty = WorkPrecisionRow::empty(&self.name, way.name(), tolerance);
                let new = match (given_up, way) {
                    (Some(looser), _) => Some(given_up_before(empty, looser)),
                    (None, Contender::Own(curve)) => {
                        self.run(*curve, empty, plan, standard.as_ref(), interrupted)
                    }
                    (None, Contender::Rival(rival)) => {
                        rival::row(self, *rival, empty, plan, standard.as_ref(), interrupted)
                    }
                };
                let Some(new) = new else { break 'all };
                if new.status.starts_with(GIVEN_UP) {
                    given_up = given_up.or(Some(tolerance));
                }
                row(&new)?;
                rows.push(new);
            }
        }
        let ranking = ranking::ranking(&rows, document.motion_limit());
        Ok(SceneComparison {
            interrupted: rows.len() < runs,
            scene: WorkPrecisionScene {
                name: self.name.clone(),
                title: self.title.clone(),
                automatic: self.automatic(plan, interrupted),
                reference: document,
                summary: ranking::words(&ranking, &rows),
                ranking,
                rows,
            },
        })
    }

    /// Returns the method that is chosen automatically, found by a run with the loosest tolerance.
    fn automatic(
        &self,
        plan: &ComparisonPlan,
        interrupted: &(impl Fn() -> bool + Sync),
    ) -> &'static str {
        let curve = ComparisonPlan::usual(Method::Auto);
        let tolerance = plan.tolerances.first().copied().unwrap_or(self.base.rtol);
        let options = options(&self.base, curve, tolerance);
        let run = look(&self.study, &options, &self.times, plan.budget, interrupted);
        run.summary.method.name()
    }

    /// Performs the runs at one setting and returns a row, or `None` if interrupted.
    fn run(
        &self,
        curve: Curve,
        empty: WorkPrecisionRow,
        plan: &ComparisonPlan,
        standard: Option<&Standard>,
        interrupted: &(impl Fn() -> bool + Sync),
    ) -> Option<WorkPrecisionRow> {
        let options = options(&self.base, curve, empty.tolerance);
        let Look {
            observations,
            summary,
            ending,
        } = look(&self.study, &options, &self.times, plan.budget, interrupted);
        let mut row = WorkPrecisionRow {
            reference_limit: standard.map_or(f64::NAN, Standard::motion_limit),
            ..empty
        };
        let timed = match ending {
            RunEnding::Interrupted => return None,
            RunEnding::Reached => clock(&self.study, &options, plan, interrupted),
            RunEnding::GivenUp(t) => {
                row.status = format!(
                    "{GIVEN_UP}: after {:.0} s of computing the run had reached t = {t:.3} s",
                    plan.budget
                );
                None
            }
            RunEnding::Failed(error) => {
                row.status = match summary.steps {
                    0 => format!("refused: {error}"),
                    _ => format!("stopped: {error}"),
                };
                None
            }
        };
        if interrupted() {
            return None;
        }
        if let (Some((_, repetitions)), Some(standard)) = (&timed, standard) {
            let errors = standard.errors(&observations).unwrap_or(Errors::UNKNOWN);
            (row.errors, row.error_state) = (errors.scaled, errors.state);
            row.repetitions = *repetitions;
        }
        let reached = timed.is_some();
        let counted = timed.map_or(summary, |(fastest, _)| fastest);
        row.evaluations = counted.evaluations;
        row.projections = counted.projections;
        row.factorisations = counted.factorisations;
        row.steps = counted.steps;
        row.rejected = counted.rejected;
        row.constraint_residual = counted
            .max_position_residual
            .max(counted.max_velocity_residual);
        row.energy_error = counted.energy_balance;
        row.seconds = if reached {
            counted.wall_seconds
        } else {
            f64::NAN
        };
        Some(row)
    }

    fn reference(&self) -> Option<Standard> {
        let mechanism = &self.study.prepared.mechanism;
        let reference = self.reference.as_ref()?;
        Some(Standard::known(reference, mechanism, self.size))
    }

    /// Returns the reference values of the runs. They come from the known motion. For other
    /// quantities, they come from two runs of different methods that agree.
    fn standard(
        &self,
        plan: &ComparisonPlan,
        interrupted: &(impl Fn() -> bool + Sync),
    ) -> Result<(Option<Standard>, ReferenceDocument), StudyError> {
        let known = self.reference();
        let pair = self.best_pair(plan, interrupted)?;
        let agreement = match (&pair, &known) {
            (None, _) => {
                "No two different methods reached the end at a tight tolerance.".to_owned()
            }
            (Some(pair), known) => pair.words(known.as_ref()),
        };
        let source = match &self.reference {
            Some(reference) => reference.source.clone(),
            None => "the mean of two runs of different methods. The difference between the two runs is the accuracy of the reference.".to_owned(),
        };
        let standard = match (known, pair) {
            (Some(known), Some(pair)) => Some(known.completed_by(&pair.mean)),
            (Some(only), None) => Some(only),
            (None, pair) => pair.map(|pair| pair.mean),
        };
        let limits = standard.as_ref().map_or([f64::NAN; 4], |s| s.limits);
        let document = ReferenceDocument {
            source,
            limits,
            agreement,
        };
        Ok((standard, document))
    }

    /// Returns the two runs with the best agreement among the most accurate runs of different
    /// methods.
    fn best_pair(
        &self,
        plan: &ComparisonPlan,
        interrupted: &(impl Fn() -> bool + Sync),
    ) -> Result<Option<Pair>, StudyError> {
        let accurate = |&method: &Method| {
            let curve = ComparisonPlan::usual(method);
            for tolerance in TIGHTEST {
                let options = options(&self.base, curve, tolerance);
                let run = look(&self.study, &options, &self.times, plan.budget, interrupted);
                match run.ending {
                    RunEnding::Reached => {
                        let verdicts = run.summary.verdicts?;
                        return Some((method, tolerance, run.observations, verdicts));
                    }
                    RunEnding::Failed(_) => {}
                    RunEnding::GivenUp(_) | RunEnding::Interrupted => return None,
                }
            }
            None
        };
        let runs: Vec<_> = ACCURATE.iter().filter_map(accurate).collect();
        let mechanism = &self.study.prepared.mechanism;
        let mut best: Option<Pair> = None;
        let unique = match runs.first() {
            Some(first) if runs.len() > 1 => unique_reactions(&first.3, mechanism),
            _ => return Ok(None),
        };
        for (k, a) in runs.iter().enumerate() {
            for b in &runs[..k] {
                let mean = Standard::mean([&a.2, &b.2], &unique, mechanism, self.size);
                if best
                    .as_ref()
                    .is_none_or(|best| mean.motion_limit() < best.mean.motion_limit())
                {
                    best = Some(Pair {
                        methods: [b.0, a.0].map(Method::name),
                        tolerance: a.1.max(b.1),
                        mean,
                        first: a.2.clone(),
                    });
                }
            }
        }
        Ok(best)
    }
}

/// A way to simulate the mechanism, by this program or by another program.
enum Contender<'a> {
    Own(Curve),
    Rival(&'a dyn Rival),
}

impl Contender<'_> {
    fn name(&self) -> CurveName {
        match self {
            Self::Own(curve) => curve.name(),
            Self::Rival(rival) => rival.name(),
        }
    }
}

/// Beginning of the status of runs that took too long.
const GIVEN_UP: &str = "given up";

fn given_up_before(row: WorkPrecisionRow, looser: f64) -> WorkPrecisionRow {
    WorkPrecisionRow {
        status: format!(
            "{GIVEN_UP}: the run at the larger tolerance {looser:.0e} was stopped, too"
        ),
        ..row
    }
}

/// Two runs that agree with each other.
struct Pair {
    methods: [&'static str; 2],
    /// The looser of the two tolerances.
    tolerance: f64,
    mean: Standard,
    first: Vec<observation::Observation>,
}

impl Pair {
    fn words(&self, known: Option<&Standard>) -> String {
        let [a, b] = self.methods;
        let apart = self.mean.motion_limit();
        let mut words = format!(
            "results of {a} and {b} at tolerance {:.0e} agree to {apart}",
            self.tolerance,
            apart = rough(apart)
        );
        if let Some(errors) = known.and_then(|known| known.errors(&self.first)) {
            words.push_str(&format!(
                ", and with the reference to {}",
                rough(errors.motion())
            ));
        }
        words.push('.');
        words
    }
}
