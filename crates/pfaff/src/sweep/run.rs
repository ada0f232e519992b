//! One run of a sweep: the scene with its numbers, moved and recorded.

use std::ops::ControlFlow;

use dynamics::{MotionFault, Prepared, Sample, Stop, Summary};
use model::Mechanism;
use model::space::norm;
use report::sweep::{Extreme, SweepMotion};
use report::{SweepRow, SweepStatus};
use solvability::{Analysis, analyse};

use super::Sweep;
use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::study::{Overrides, Study};

/// A run that can begin: assembled, and analysed at its start.
pub(super) struct Begun<'s> {
    sweep: &'s Sweep<'s>,
    run: u64,
    pub(super) study: Study,
    analysis: Analysis,
    /// Number of unique reactions that are fragile.
    fragile: u64,
}

impl Sweep<'_> {
    /// Assembles a run (from 1).
    pub(super) fn begin(&self, run: u64) -> Result<Begun<'_>, StudyError> {
        let written = self.grid.written((run - 1) as usize);
        let written: Vec<&str> = written.iter().map(String::as_str).collect();
        let text = self.template.with_expressions(&written);
        let assembled = AssembledScene::read(&self.plan.scene, &text, self.registry)?;
        let study = assembled.prepare(&Overrides::default())?;
        let options = study.options.as_ref().ok_or(StudyError::NoEnd)?;
        options.check()?;
        let Prepared {
            mechanism, q, v, ..
        } = &study.prepared;
        let analysis = analyse(mechanism, 0.0, q)?;
        let fragile = analysis.sensitivities(mechanism, q, v)?.fragile().count() as u64;
        Ok(Begun {
            sweep: self,
            run,
            study,
            analysis,
            fragile,
        })
    }

    /// The row of a run that cannot begin.
    pub(super) fn refused(&self, run: u64, error: &StudyError) -> SweepRow {
        SweepRow {
            run,
            varied: self.point(run),
            status: SweepStatus::Refused,
            error: reason(error),
            motion: None,
        }
    }

    /// The row of a run that has ended its process twice.
    pub(super) fn crashed(&self, run: u64) -> SweepRow {
        SweepRow {
            run,
            varied: self.point(run),
            status: SweepStatus::Crashed,
            error: CRASHED.to_owned(),
            motion: None,
        }
    }
}

/// What is known of a run that has ended its process.
const CRASHED: &str = "the process ended twice while it made this run and no other";

impl Begun<'_> {
    /// Moves it to its end, or until `each`, which is called with every written row, or `stop`,
    /// which is called at each evaluation, stops it.
    pub(super) fn go(
        &self,
        stop: &Stop<'_>,
        mut each: impl FnMut(&Sample<'_, '_>) -> ControlFlow<()>,
    ) -> SweepRow {
        let Self {
            sweep,
            run,
            study,
            analysis,
            fragile,
        } = self;
        let Some(options) = &study.options else {
            return sweep.refused(*run, &StudyError::NoEnd);
        };
        let reactions = sweep.places(&study.prepared.mechanism);
        let mut watch = Watch::new(&reactions, study, analysis);
        let outcome = study.run_until(options, stop, |sample| {
            watch.see(sample)?;
            Ok(each(sample))
        });
        let (summary, error) = match outcome {
            Ok(summary) => (summary, None),
            Err(failure) => (failure.summary, Some(StudyError::from(failure.error))),
        };
        match error {
            // The run has no state.
            Some(error) if watch.t_state.is_nan() => sweep.refused(*run, &error),
            error => SweepRow {
                run: *run,
                varied: sweep.point(*run),
                status: match error {
                    Some(_) => SweepStatus::Stopped,
                    None => SweepStatus::Done,
                },
                error: error.as_ref().map_or(String::new(), reason),
                motion: Some(watch.motion(study, analysis, *fragile, &summary)),
            },
        }
    }
}

/// An error as text, without the name and the lines of a text that the user has not written.
pub(super) fn reason(error: &StudyError) -> String {
    let StudyError::Scene(diagnostics) = error else {
        return error.to_string();
    };
    let texts = diagnostics.iter().map(|d| match d.primary.text.as_str() {
        text if text.starts_with("did you mean") => format!("{}; {text}", d.message),
        _ => d.message.clone(),
    });
    texts.collect::<Vec<_>>().join("; ")
}

/// Values kept from the rows of a run.
struct Watch<'s> {
    mechanism: &'s Mechanism,
    /// Time of the last state (s).
    t_state: f64,
    /// The last state, body by body in the order of trajectories.
    state: Vec<f64>,
    /// The requested reactions, and whether each is unique.
    reactions: Vec<(usize, bool)>,
    extremes: Vec<Extreme>,
}

impl<'s> Watch<'s> {
    fn new(reactions: &[Option<usize>], study: &'s Study, analysis: &Analysis) -> Self {
        let is_unique = |k: usize| {
            let verdict = analysis.reactions.get(k).map(|r| &r.wrench.verdict);
            verdict.is_some_and(|v| v.is_unique())
        };
        // Nothing is unique of a reaction that this run does not have.
        let columns = study.prepared.mechanism.space().columns().len();
        let known = |&k: &Option<usize>| k.map_or((0, false), |k| (k, is_unique(k)));
        Self {
            t_state: f64::NAN,
            state: vec![f64::NAN; columns * study.prepared.mechanism.bodies().len()],
            mechanism: &study.prepared.mechanism,
            reactions: reactions.iter().map(known).collect(),
            extremes: vec![Extreme::UNKNOWN; reactions.len()],
        }
    }

    fn see(&mut self, sample: &mut Sample<'_, '_>) -> Result<(), MotionFault> {
        self.t_state = sample.t;
        let columns = self.mechanism.space().columns().len();
        for (body, state) in self.state.chunks_exact_mut(columns).enumerate() {
            let frame = self.mechanism.frames().body(body, sample.q, sample.v);
            state
                .iter_mut()
                .zip(frame.numbers())
                .for_each(|(to, x)| *to = x);
        }
        if !self.reactions.iter().any(|(_, is_unique)| *is_unique) {
            return Ok(());
        }
        let all = sample.reactions()?;
        for ((k, is_unique), extreme) in self.reactions.iter().zip(&mut self.extremes) {
            if *is_unique && let Some(reaction) = all.get(*k) {
                let force = norm(&reaction.force);
                extreme.include(sample.t, force, norm(&reaction.torque));
            }
        }
        Ok(())
    }

    fn motion(
        self,
        study: &Study,
        analysis: &Analysis,
        fragile: u64,
        summary: &Summary,
    ) -> SweepMotion {
        let largest = |values: &[f64]| values.iter().fold(0.0, |a, x| f64::max(a, x.abs()));
        let not_unique = analysis
            .reactions
            .iter()
            .filter(|r| !r.wrench.verdict.is_unique());
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
            events: summary.events.len() as u64,
            rank: analysis.decision.rank as u64,
            redundancy: analysis.decision.redundancy as u64,
            not_unique: not_unique.count() as u64,
            fragile,
            t_state: self.t_state,
            state: self.state,
            extremes: self.extremes,
        }
    }
}
