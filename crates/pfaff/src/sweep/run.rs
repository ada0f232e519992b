//! Simulates one run of a sweep, with the values of the varied keys for this run, and records the
//! results.

use std::ops::ControlFlow;
use std::sync::Arc;

use dynamics::plan::{Reactions, Rows, Verdicts};
use dynamics::{
    Event, EventKind, MotionFault, MotionOptions, OutputRequest, Plan, PreparedMechanism, Sample,
    SceneCode, Stop, Summary,
};
use model::{ConstraintId, Mechanism, System};
use report::Peak;
use report::sweep::SweepMotion;
use scene_codegen::Tape;
use solvability::analysis::analyse_decided;
use solvability::{Analysis, ReactionStretches, Stretches};

use crate::bounds_of_run::{BoundsOfRun, FoundBounds};
use crate::documents::ExtremeDocument;
use crate::error::StudyError;
use crate::peaks_of_run::{MagnitudePeak, MagnitudesOfRun};
use crate::study::Study;

/// A run that can begin. It has been assembled, and its start has been analysed.
pub(super) struct PreparedRun {
    pub(super) study: Study,
    pub(super) options: MotionOptions,
    pub(super) analysis: Arc<Analysis>,
    /// Number of unique reactions that are ill-determined.
    pub(super) fragile: u64,
    /// Indices of the requested reactions in this mechanism.
    pub(super) reactions: Vec<Option<usize>>,
    /// The generated code of the run, if it uses generated code.
    #[cfg_attr(target_family = "wasm", allow(dead_code))]
    pub(super) code: Option<Tape>,
}

/// The scene without changes. Its decisions are used for all runs with the same constraints.
pub(super) struct UnvariedScene {
    study: Study,
    pub(super) analysis: Arc<Analysis>,
}

impl UnvariedScene {
    /// Returns `None` if the scene cannot be analysed.
    pub(super) fn new(study: Study) -> Option<Self> {
        let PreparedMechanism {
            mechanism,
            q,
            decided,
            ..
        } = &study.prepared;
        let analysis =
            analyse_decided(mechanism, study.start_time(), q, decided.as_ref()?, |_| ()).ok()?;
        Some(Self {
            analysis: Arc::new(analysis),
            study,
        })
    }

    pub(super) fn prepared(&self) -> &PreparedMechanism {
        &self.study.prepared
    }

    /// Whether a run has the same constraints and the same configuration, and therefore the same
    /// decisions.
    pub(super) fn decides(&self, run: &PreparedMechanism) -> bool {
        let own = self.prepared();
        let both = own.decided.as_ref().zip(run.decided.as_ref());
        both.is_some_and(|(own, of_run)| Arc::ptr_eq(own, of_run)) && own.q == run.q
    }
}

/// Result of a run: the contents of its row, and the reason why the run stopped, if it stopped.
pub(super) struct MadeRun {
    pub(super) motion: SweepMotion,
    pub(super) error: Option<StudyError>,
    /// Whether the run continued with the interpreter before its end, and not with generated code.
    left_code: bool,
}

impl MadeRun {
    /// Whether the run stopped after it had continued with the interpreter in place of generated
    /// code.
    pub(super) fn has_lost_its_way(&self) -> bool {
        self.error.is_some() && self.left_code
    }
}

impl PreparedRun {
    /// Interprets the run from its start on.
    pub(super) fn leave_code(&mut self) {
        self.study.prepared = self.study.prepared.clone().without_code();
    }

    /// Performs the run up to its end, or until a callback stops the run. `each` is called with
    /// every written row, and `stop` at each evaluation. If several runs are performed at once,
    /// `evaluator` evaluates the code of the run.
    pub(super) fn go(
        &self,
        evaluator: Option<&dyn SceneCode>,
        stop: &Stop<'_>,
        mut each: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> MadeRun {
        let mut watch = Watch::new(self);
        // Without redundant rows, all reactions are unique.
        let is_redundant = self.analysis.decision.redundancy > 0 && !self.reactions.is_empty();
        let elastic = self.study.bounds.as_ref().filter(|_| is_redundant);
        let wanted = OutputRequest {
            rows: Rows::Every,
            accelerations: self.study.scene.output.accelerations,
            reactions: match elastic {
                // The bounds of one reaction depend on the loads of all joints.
                Some(_) => Reactions::All,
                None => Reactions::Of(watch.names()),
            },
            groups: Vec::new(),
            choices: Vec::new(),
            uniqueness: false,
            // The row of a sweep contains no instants. `OfRun` omits the loads on which bounds
            // depend.
            verdicts: match elastic {
                Some(_) => Verdicts::WithInstants,
                None => Verdicts::OfRun,
            },
        };
        let mut bounds = None;
        let plan = Plan::new(&self.study.prepared, &self.options, &wanted);
        let outcome = plan.map(|plan| {
            let Study {
                scene, prepared, ..
            } = &self.study;
            let known = watch.magnitudes.reactions().to_vec();
            bounds = elastic.map(|elastic| {
                BoundsOfRun::of_magnitudes((scene, &prepared.mechanism), elastic, known, &plan)
            });
            let row = |sample: &mut Sample<'_, '_>| {
                watch.see(sample)?;
                if let Some(bounds) = &mut bounds {
                    bounds.see(sample)?;
                }
                each(sample)
            };
            match evaluator {
                Some(evaluator) => plan.simulate_evaluated(evaluator, stop, row),
                None => plan.simulate_watched(&|_| ControlFlow::Continue(()), stop, row),
            }
        });
        let (summary, error) = match outcome {
            Ok(Ok(summary)) => (summary, None),
            Ok(Err(failure)) => (failure.summary, Some(StudyError::from(failure.error))),
            Err(error) => (Summary::default(), Some(error.into())),
        };
        let mut events = summary.events.iter();
        MadeRun {
            motion: watch.motion(&summary, bounds.as_ref().map(|bounds| bounds.found().1)),
            error,
            left_code: events.any(|event| event.kind == EventKind::CodeLeft),
        }
    }
}

/// Whether an event belongs to the motion, and not only to the computation of the motion.
fn is_of_motion(event: &&Event) -> bool {
    !matches!(event.kind, EventKind::CodeLeft | EventKind::CodeUsed)
}

/// Values stored from the rows of a run.
struct Watch<'s> {
    begun: &'s PreparedRun,
    /// Time of the last state (s).
    t_state: f64,
    /// The last coordinates and velocities; `None` before the first row.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Force and torque of the requested reactions that this run has.
    magnitudes: MagnitudesOfRun,
}

impl<'s> Watch<'s> {
    fn new(begun: &'s PreparedRun) -> Self {
        let known = begun.reactions.iter().flatten().copied();
        let known = known.map(ConstraintId).collect();
        Self {
            begun,
            t_state: f64::NAN,
            last: None,
            magnitudes: MagnitudesOfRun::new(&begun.study.prepared.mechanism, known),
        }
    }

    fn mechanism(&self) -> &'s Mechanism {
        &self.begun.study.prepared.mechanism
    }

    /// Returns the names of the joints and drives whose reactions are recorded.
    fn names(&self) -> Vec<String> {
        let groups = &self.mechanism().layout().groups;
        let known = self.magnitudes.reactions().iter();
        known.map(|id| groups[id.0].name.clone()).collect()
    }

    fn see(&mut self, sample: &mut Sample<'_, '_>) -> Result<(), MotionFault> {
        self.t_state = sample.t;
        match &mut self.last {
            Some((q, v)) => {
                q.copy_from_slice(sample.q);
                v.copy_from_slice(sample.v);
            }
            last => *last = Some((sample.q.to_vec(), sample.v.to_vec())),
        }
        if !self.magnitudes.reactions().is_empty() {
            let cuts = sample.events.iter().filter(|event| event.kind.cuts());
            cuts.for_each(|event| self.magnitudes.cut(event.time));
            let all = sample.reactions()?;
            self.magnitudes.row(sample.t, all.as_chosen());
        }
        Ok(())
    }

    /// Returns the last state, body by body in the order of trajectories. The numbers are NaN if
    /// there is no state.
    fn state(&self) -> Vec<f64> {
        let mechanism = self.mechanism();
        let bodies = 0..mechanism.bodies().len();
        match &self.last {
            Some((q, v)) => {
                let frames = mechanism.frames();
                let of_body = |body| frames.body(body, q, v).numbers();
                bodies.flat_map(of_body).collect()
            }
            None => vec![f64::NAN; mechanism.space().columns().len() * bodies.len()],
        }
    }

    /// Returns the peaks of the magnitudes that are determined on the whole run.
    fn peaks(&self, verdicts: Option<&Stretches>) -> Vec<[Option<Peak>; 2]> {
        let found = verdicts.map_or_else(Vec::new, |verdicts| self.magnitudes.finish(verdicts));
        let mut found = found.into_iter();
        let requested = self.begun.reactions.iter();
        let known = requested.map(|place| place.and_then(|_| found.next()));
        let of_run = |(_, peaks): (_, [MagnitudePeak; 2])| peaks.map(MagnitudePeak::of_run);
        known
            .map(|known| known.map_or([None, None], of_run))
            .collect()
    }

    /// Returns the bounds of the reactions that are not unique on the whole run.
    fn at_most(
        &self,
        verdicts: Option<&Stretches>,
        found: Option<&FoundBounds>,
    ) -> report::sweep::BoundsOfRun {
        let both = verdicts.zip(found).into_iter();
        let open: Vec<_> = both
            .flat_map(|(verdicts, found)| found.open(verdicts))
            .collect();
        let numbers = |most: Option<ExtremeDocument>| most.map(|most| [most.value, most.time]);
        let of = |place: &Option<usize>| {
            let id = ConstraintId((*place)?);
            let (_, largest) = open.iter().find(|(known, _)| *known == id)?;
            Some(largest.map(|most| numbers(most).unwrap_or([f64::NAN; 2])))
        };
        let largest = self.begun.reactions.iter();
        let largest = largest.map(|place| of(place).unwrap_or([[f64::NAN; 2]; 2]));
        let gap = found.and_then(|found| found.gap.as_ref());
        report::sweep::BoundsOfRun {
            rows_without: gap.map_or(0, |gap| gap.rows as u64),
            largest: largest.collect(),
        }
    }

    fn motion(self, summary: &Summary, found: Option<&FoundBounds>) -> SweepMotion {
        let PreparedRun {
            study,
            analysis,
            fragile,
            ..
        } = self.begun;
        let largest = |values: &[f64]| values.iter().fold(0.0, |a, x| f64::max(a, x.abs()));
        let verdicts = summary.verdicts.as_ref();
        let is_open = |r: &&ReactionStretches| !r.whole.of_run().is_unique();
        let open = |found: &Stretches| found.reactions.iter().filter(is_open).count() as u64;
        SweepMotion {
            method: summary.method.name(),
            t: summary.t,
            steps: summary.steps,
            rejected: summary.rejected,
            evaluations: summary.evaluations,
            projections: summary.projections,
            seconds: summary.wall_seconds,
            max_position_residual: summary.max_position_residual,
            max_velocity_residual: summary.max_velocity_residual,
            energy_balance: summary.energy_balance,
            start_correction: largest(&study.prepared.assembly.correction),
            start_velocity_correction: largest(&study.prepared.velocity_correction),
            events: summary.events.iter().filter(is_of_motion).count() as u64,
            rank: analysis.decision.rank as u64,
            redundancy: analysis.decision.redundancy as u64,
            not_unique: verdicts.map(open),
            fragile: *fragile,
            t_state: self.t_state,
            state: self.state(),
            peaks: self.peaks(verdicts),
            at_most: study.bounds.as_ref().map(|_| self.at_most(verdicts, found)),
        }
    }
}
