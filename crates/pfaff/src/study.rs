//! All stages for a scene, from its text to its results: read, assemble, decide, simulate, write.
//! The functions correspond to the commands, but print nothing.

use std::ops::ControlFlow;
use std::sync::Mutex;

use crate::documents::{AnalysisDocument, Run, RunDocument};
use crate::documents::{
    BodyOfRunDocument, DataDocument, Gap, MomentDocument, MotionDocument, PullDocument,
    RunVerdicts, SpreadDocument,
};
use crate::page::Origin;
use dynamics::equilibrium::{Equilibrium, EquilibriumError, EquilibriumOptions, equilibrium};
use dynamics::linearise::{Linearisation, LineariseOptions, linearise};
use dynamics::plan::{Reactions, Rows, Verdicts};
use dynamics::{
    Failure, MotionError, MotionFault, MotionOptions, OutputRequest, Plan, PreparedMechanism,
    Sample, Stop, Summary, simulate_until,
};
use model::start::assemble;
use model::words::rounded;
use model::{
    AnyDescription, ConfigurationAccuracy, ConstraintId, Load, Reaction, Registry, StartError,
    StartPose, System,
};
use report::{
    ByName, Family, OutputDirectory, Quantity, ReactionColumn, Selection, TableError, Trajectory,
    TrajectoryTable, columns_of_reactions, write_json,
};
use scene::{KeyError, Output, Scene, WantedReactions};
use solvability::{
    Choice, ChosenValues, Contradiction, Elasticity, Freedoms, Group, GroupNumbers,
    GroupSensitivities, NamedChoice, ReactionVerdict, Sensitivities, Sensitivity, State, Stretches,
    contradicting_drives_along,
};

use crate::assembled::{AssembledScene, frames, refused};
use crate::body_loads::{BodyLoads, joints_of};
use crate::bounds_of_run::{self, BOUNDS, BoundsOfRun, FoundBounds};
use crate::configuration::{AskedRows, ConfigurationAnalysis, requests};
use crate::error::StudyError;
use crate::loads_of_run::{self, LOADS, LoadsOfRun};
use crate::peaks_of_run::{FoundPeaks, PeaksOfRun};
use crate::pulls::PullsOfRun;
use crate::questions::analyze::remedies::RemedyDocument;
use crate::report_builder::{OfRun, ReportBuilder};
use crate::rows::{Calling, RowFault, RowSink, RunEnd, run_into};
use crate::run_options::RunOptions;
use crate::spread::Path;
pub use crate::tables_of_run::more_columns;
use crate::tables_of_run::{
    ReactionFiles, TableRows, TrajectoryFile, group_numbers, note_gap, numbers_of, selection,
    table_units,
};
use crate::within::missed;

/// Largest number of rows of a mechanism for which an animation has additional output rows between
/// the rows of the tables.
const PICTURED_ROWS: usize = 600;

/// Largest number of rows of a mechanism for which the program tests whether a motion begins.
const BEGUN_ROWS: usize = 2000;

/// Largest violation, as a fraction of the size, with which a start after a search on the
/// constraints counts as close to an assembled start. The violation remains because the constraints
/// are dependent at this start.
const REACHED: f64 = 1e-6;

/// Largest number of searches for an equilibrium after a search from a singular start.
const SEARCHES: usize = 3;

/// A scene that has been assembled and can move.
#[non_exhaustive]
#[derive(Clone)]
pub struct Study {
    /// The scene, read from a text or made by a program.
    pub scene: Scene,
    /// The start and the independent rows.
    pub prepared: PreparedMechanism,
    /// Options of a run. `None` if neither the scene nor the caller states the end of the run.
    pub options: Option<MotionOptions>,
    /// Choices for a run. They give values to the numbers that the model does not determine.
    /// Without a choice, the multipliers of the redundant rows are zero.
    pub choices: Vec<Choice>,
    /// Elastic joints. With these joints, a run computes bounds of the reactions that the model
    /// does not determine. Without elastic joints, no bounds are computed.
    pub bounds: Option<Elasticity>,
    /// Joints of other types that make reactions unique, for the report.
    pub remedies: Vec<RemedyDocument>,
    /// The load case whose values the scene contains.
    pub case: Option<String>,
}

/// A run that has ended.
#[derive(Debug)]
#[non_exhaustive]
pub struct EndedRun {
    /// Numbers, events and verdicts of the run.
    pub document: RunDocument,
    /// Reason why the run stopped before its end, if an error stopped it.
    pub stopped: Option<MotionError>,
    /// Verdicts at the start, in the order of the rows of C.
    pub verdicts: Vec<ReactionVerdict>,
    /// Verdicts of the run. `None` if no reactions were requested.
    pub stretches: Option<Stretches>,
    /// The columns of the reactions of all joints and drives, followed by the columns of the groups
    /// of the scene.
    pub columns: Vec<ReactionColumn>,
    /// The times of the rows (s), each with the smallest and the largest value of each column.
    /// Values without bounds are NaN. The list is empty if no bounds were requested or no rows are
    /// redundant.
    pub bounds: Vec<(f64, Vec<[f64; 2]>)>,
}

/// The values of the reactions of a row for one choice.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ChosenNumbers {
    /// Reactions of all joints and drives in the order of their rows.
    pub reactions: ChosenValues<Reaction>,
    /// All numbers of the groups of the scene, group by group.
    pub groups: ChosenValues<f64>,
    /// The same values for each choice of [`Study::choices`], followed by the choices of
    /// [`OutputRequest::choices`]. The values are NaN if a choice selects no solution.
    pub choices: Vec<ChosenNumbers>,
    /// Loads of force elements. They do not depend on a choice, and the list is empty in
    /// [`Self::choices`].
    pub loads: Vec<Load>,
}

impl Study {
    /// Returns the time of the start (s).
    #[must_use]
    pub fn start_time(&self) -> f64 {
        self.prepared.start_time()
    }

    /// Returns the study with another start: a time (s), coordinates and velocities. Prescribed
    /// motions and functions of time continue.
    ///
    /// ```
    /// use pfaff::prelude::*;
    /// use std::ops::ControlFlow;
    ///
    /// let mut thrown = Description { gravity: [0.0, -10.0], ..Description::new("thrown") };
    /// thrown.body(Body { velocity: Some([0.0, 5.0]), ..Body::new("stone", 1.0, 1.0) });
    /// let study = Study::build(thrown)?;
    /// // It flies on for half a second, from its highest point.
    /// let later = study.at(0.5, &[0.0, 1.25, 0.0], &[0.0; 3])?;
    /// let mut height = 0.0;
    /// later.run(&MotionOptions::to(1.0), |sample| {
    ///     height = sample.q[1];
    ///     Ok(ControlFlow::Continue(()))
    /// }).map_err(|failure| failure.error)?;
    /// assert!(later.start_time() == 0.5 && height.abs() < 1e-9);
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// [`StudyError::Motion`]: the state does not satisfy the constraints, or no rows can be
    /// chosen.
    pub fn at(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Self, StudyError> {
        Ok(Self {
            prepared: self.prepared.at(t, q, v)?,
            ..self.clone()
        })
    }

    /// Reads a scene, finds a consistent start and chooses rows. `name` is the file name in
    /// messages.
    ///
    /// # Errors
    /// - [`StudyError::Scene`]: all errors of the text, including errors of the start.
    /// - [`StudyError::Motion`]: the start exists, but no rows can be chosen.
    pub fn read(
        name: &str,
        text: &str,
        registry: &Registry,
        overrides: &RunOptions,
    ) -> Result<Self, StudyError> {
        AssembledScene::read(name, text, registry)?.prepare(overrides)
    }

    /// Works like [`Self::read`], for a scene made by a program, or for a description without a
    /// scene.
    ///
    /// ```
    /// use pfaff::prelude::*;
    ///
    /// let mut door = Description::new("door on two hinges");
    /// let leaf = door.body(Body::new("leaf", 20.0, 5.0));
    /// for (name, y) in [("upper", 1.0), ("lower", -1.0)] {
    ///     door.joint(name, &[BodyRef::Ground, leaf], Revolute { s_i: [0.0, y], s_j: [0.0, y] });
    /// }
    /// let study = Study::build(door)?;
    /// assert_eq!(study.analyse(0.0, None)?.analysis.decision.redundancy, 1);
    ///
    /// let nothing = Study::build(Description::new("nothing")).err().unwrap();
    /// assert!(matches!(nothing, StudyError::Build(_)), "{nothing}");
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// - [`StudyError::Build`]: all errors of the description.
    /// - [`StudyError::Motion`]: there is no consistent start, or no rows can be chosen.
    /// - [`StudyError::SingularStart`]: no motion begins with the velocities of the start.
    pub fn build(scene: impl Into<Scene>) -> Result<Self, StudyError> {
        AssembledScene::build(scene)?.prepare(&RunOptions::default())
    }

    /// Analyses a configuration at a time of the motion. At t = 0, no run is needed. `drop` (rows
    /// 0-based) selects the redundant rows. Verdicts do not depend on this selection.
    ///
    /// # Errors
    /// Returns an error if the motion does not reach that time, if C cannot be analysed or
    /// redundant rows contradict each other at that time, or if the rows `drop` cannot be
    /// redundant.
    pub fn analyse(
        &self,
        t: f64,
        drop: Option<&[usize]>,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        self.analyse_until(t, drop, &|| false, |_| ())
    }

    /// Works like [`Self::analyse`]. `stop` is called at each evaluation of the run up to the time.
    /// `progress` is called with the number of joints analysed so far.
    ///
    /// # Errors
    /// Returns the errors of [`Study::analyse`], and [`StudyError::Interrupted`] if `stop` returned
    /// true.
    pub fn analyse_until(
        &self,
        t: f64,
        drop: Option<&[usize]>,
        stop: &Stop<'_>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        self.analyse_state(t, self.state_until(t, stop)?, drop, progress)
    }

    /// Analyses the state of the motion at t.
    pub(crate) fn analyse_state(
        &self,
        t: f64,
        state: State,
        drop: Option<&[usize]>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        let mechanism = &self.prepared.mechanism;
        // A later configuration is only as accurate as the motion up to that time.
        let known = match t {
            t if t == self.start_time() => ConfigurationAccuracy::AsStored,
            _ => ConfigurationAccuracy::To(self.motion_to(t).rtol),
        };
        let rows = match (drop, &self.prepared.decided) {
            (Some(drop), _) => AskedRows::Dropped(drop),
            (None, Some(decided)) if t == self.start_time() => AskedRows::Decided(decided),
            (None, _) => AskedRows::Any,
        };
        let configuration =
            ConfigurationAnalysis::new(&self.scene, mechanism, t, state, known, rows, progress)?;
        // Contradictions at the start were checked when the start was prepared.
        let found = if t == self.start_time() {
            Vec::new()
        } else {
            configuration.contradictions()?
        };
        match found.into_iter().next() {
            Some(worst) => Err(worst.into()),
            None => Ok(configuration),
        }
    }

    /// Checks that all contacts stay closed and hold at a state. `place` names the state.
    ///
    /// # Errors
    /// [`StudyError::Contacts`], and the errors of [`Study::analyse`].
    pub(crate) fn check_contacts(
        &self,
        (t, state): (f64, State),
        place: &str,
    ) -> Result<(), StudyError> {
        if !self.prepared.mechanism.layout().has_contact_limits() {
            return Ok(());
        }
        let there = self.analyse_state(t, state, None, |_| ())?;
        there.contact_fault()?.map_or(Ok(()), |fault| {
            let place = place.to_owned();
            Err(StudyError::Contacts { place, fault })
        })
    }

    /// Linearises the motion about the state at a time of the motion, which must be at rest or in
    /// steady motion; at t = 0 no run is needed. At rest, functions of time have their constant
    /// values at t.
    ///
    /// # Errors
    /// Returns an error if the motion does not reach that time, the errors of [`linearise`], and
    /// [`StudyError::Contacts`] if contacts do not stay closed or slip there.
    pub fn linearise(
        &self,
        t: f64,
        options: &LineariseOptions,
    ) -> Result<Linearisation, StudyError> {
        self.linearise_until(t, options, &|| false)
    }

    /// Works like [`Self::linearise`]. `stop` is called at each evaluation of the run up to the
    /// time.
    ///
    /// # Errors
    /// Returns the errors of [`Study::linearise`], and [`StudyError::Interrupted`] if `stop`
    /// returned true.
    pub fn linearise_until(
        &self,
        t: f64,
        options: &LineariseOptions,
        stop: &Stop<'_>,
    ) -> Result<Linearisation, StudyError> {
        let state = self.state_until(t, stop)?;
        let linearised = linearise(&self.prepared, (t, &state.q, &state.v), options)?;
        self.check_contacts((t, state), &format!("the state at t = {} s", rounded(t)))?;
        Ok(linearised)
    }

    /// Finds an equilibrium near the start. Also returns the study of the same scene that starts at
    /// the equilibrium, at rest, for all further questions. Reference points, initial values and
    /// the zeros of joint coordinates are still computed from the poses given in the scene. Drives
    /// are locked at their positions at the start. If the drives would accelerate immediately
    /// ([`Equilibrium::moving_on`]), [`Self::held_at`] gives the static forces.
    ///
    /// ```
    /// use pfaff::prelude::*;
    /// use pfaff::dynamics::equilibrium::EquilibriumOptions;
    /// use pfaff::joints::SpringDamper;
    ///
    /// // A mass on a spring of 100 N/m, described where the spring carries nothing.
    /// let mut d = Description { gravity: [0.0, -10.0], ..Description::new("scale") };
    /// let pan = d.body(Body { position: [0.0, -1.0], ..Body::new("pan", 2.0, 0.1) });
    /// let both = [BodyRef::Ground, pan];
    /// d.joint("guide", &both, Translational::new([0.0; 2], [0.0; 2], Direction::Y));
    /// d.force("spring", &both, SpringDamper::new([0.0; 2], [0.0; 2], 100.0, 0.0).with_free_length(1.0));
    /// let (found, there) = Study::build(d)?.equilibrium(&EquilibriumOptions::default())?;
    /// assert!((found.q[1] + 1.2).abs() < 1e-12);
    /// assert_eq!(there.prepared.v, [0.0; 3]);
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// Returns the errors of [`equilibrium`], an error if the mechanism cannot start there, and
    /// [`StudyError::Contacts`] if contacts do not stay closed or slip there.
    pub fn equilibrium(
        &self,
        options: &EquilibriumOptions,
    ) -> Result<(Equilibrium, Self), StudyError> {
        let mut found = equilibrium(&self.prepared, options)?;
        let mut there = self.starting_at(&found.q)?;
        // A search that starts at a singular configuration uses the rank of this configuration.
        // This rank may be lower than the rank at all other configurations.
        let rank = |study: &Self| study.prepared.decision.rank;
        for _ in 0..SEARCHES {
            let before = rank(&there);
            if before == rank(self) {
                break;
            }
            let mut next = equilibrium(&there.prepared, options)?;
            there = self.starting_at(&next.q)?;
            next.steps += found.steps;
            next.pushes += found.pushes;
            found = next;
            if rank(&there) == before {
                break;
            }
        }
        let held = there.held_at(found.time);
        held.check_contacts(
            (held.start_time(), held.state_at(held.start_time())?),
            "the position found",
        )?;
        Ok((found, there))
    }

    /// Returns the same study with constant functions of time, which have their values at t; see
    /// [`model::Mechanism::held_at`]. This is for a start at rest. The reactions at the start are
    /// then the static reactions.
    #[must_use]
    pub fn held_at(&self, t: f64) -> Self {
        Self {
            scene: self.scene.clone(),
            prepared: self.prepared.held_at(t),
            options: self.options.clone(),
            choices: self.choices.clone(),
            bounds: self.bounds.clone(),
            remedies: self.remedies.clone(),
            case: self.case.clone(),
        }
    }

    /// Returns the study of the same scene that starts at the coordinates q, at rest.
    fn starting_at(&self, q: &[f64]) -> Result<Self, StudyError> {
        let mut scene = self.scene.clone();
        let frames = frames(&self.scene, &self.prepared.mechanism, q).into_iter();
        let poses = frames.enumerate();
        scene.start.poses = poses
            .map(|(body, frame)| StartPose { body, frame })
            .collect();
        match &mut scene.description {
            AnyDescription::Plane(d) => {
                for body in &mut d.bodies {
                    body.velocity = body.velocity.map(|_| [0.0; 2]);
                    body.angular_velocity = body.angular_velocity.map(|_| 0.0);
                }
            }
            AnyDescription::Space3(d) => {
                for body in &mut d.bodies {
                    body.velocity = body.velocity.map(|_| [0.0; 3]);
                    body.angular_velocity = body.angular_velocity.map(|_| [0.0; 3]);
                }
            }
        }
        let assembled = AssembledScene::build(scene)?;
        let (start, mut again) = (assembled.scene.start.clone(), assembled.mechanism.clone());
        let size = self.prepared.assembly.size;
        assembled.prepare(&RunOptions::default()).map_err(|error| {
            // The search has reached these coordinates on the constraints.
            let left = match assemble(&mut again, &start) {
                Err(StartError::NoAssembly { misfits, .. }) => missed(&misfits, size),
                _ => f64::INFINITY,
            };
            if left <= REACHED * size {
                EquilibriumError::Singular { left }.into()
            } else {
                error
            }
        })
    }

    /// Returns the text of a scene that starts at the coordinates q, at rest; see
    /// [`scene::at_rest`]. The scene must have been read from a text.
    ///
    /// # Errors
    /// Returns an error if the poses cannot be written into the text.
    pub fn text_at_rest(&self, q: &[f64]) -> Result<String, KeyError> {
        scene::at_rest(
            &self.scene,
            &frames(&self.scene, &self.prepared.mechanism, q),
        )
    }

    /// Returns the text of a scene that starts at a time (s), coordinates and velocities; see
    /// [`scene::in_motion`]. The scene must have been read from a text.
    ///
    /// # Errors
    /// Returns an error if the state cannot be written into the text.
    pub fn text_at(&self, t: f64, q: &[f64], v: &[f64]) -> Result<String, KeyError> {
        let mechanism = &self.prepared.mechanism;
        let layout = mechanism.layout();
        if layout.n_q > layout.n_of_bodies() {
            let (name, coordinate) = mechanism.coordinate_name(layout.n_of_bodies());
            return Err(KeyError::Unstated {
                name: name.to_owned(),
                coordinate,
            });
        }
        let bodies = 0..mechanism.bodies().len();
        let velocities = bodies.map(|body| {
            let state = mechanism.frames().body(body, q, v);
            [state.velocity, state.omega]
        });
        let velocities: Vec<_> = velocities.collect();
        let poses = frames(&self.scene, mechanism, q);
        scene::in_motion(&self.scene, t, &poses, &velocities)
    }

    /// Finds the first contradiction of drives after the start. Drives may contradict each other,
    /// or the motions that the joints permit. The check uses a dozen times up to the end of the
    /// run. Returns `None` if there is no contradiction, if the end of the run is not stated, or if
    /// the check is not possible; see [`solvability::contradicting_drives_along`].
    ///
    /// # Errors
    /// Returns an error if C cannot be analysed at one of these times.
    pub fn contradicting_drives(&self) -> Result<Option<Contradiction>, StudyError> {
        let Some(options) = &self.options else {
            return Ok(None);
        };
        let PreparedMechanism { mechanism, q, .. } = &self.prepared;
        Ok(contradicting_drives_along(mechanism, q, options.t_end)?)
    }

    /// Returns an error for drives that contradict each other later in the run, with their
    /// positions in the scene.
    ///
    /// # Errors
    /// Returns the errors of [`Study::contradicting_drives`]. If there are such drives, returns
    /// [`StudyError::Scene`], or [`StudyError::Motion`] for a scene without text.
    pub fn check_drives(&self) -> Result<(), StudyError> {
        match self.contradicting_drives()? {
            Some(contradiction) => Err(refused(&self.scene, contradiction.into())),
            None => Ok(()),
        }
    }

    /// Returns the reason why no motion begins although the start is consistent, for example a
    /// massless body that is free to move. Returns `None` if a motion begins. This is not tested
    /// for mechanisms with many rows, because the test takes as long as a step.
    #[must_use]
    pub fn cannot_begin(&self) -> Option<String> {
        if self.prepared.mechanism.layout().rows() > BEGUN_ROWS {
            return None;
        }
        let options = MotionOptions {
            t_end: self.start_time(),
            ..self.motion_to(1.0)
        };
        let wanted = OutputRequest {
            accelerations: false,
            verdicts: Verdicts::None,
            uniqueness: false,
            ..OutputRequest::default()
        };
        let plan = Plan::new(&self.prepared, &options, &wanted);
        let begun = plan.and_then(|plan| {
            let begun = plan.simulate(|sample| {
                sample.reactions()?;
                Ok(ControlFlow::Break(()))
            });
            begun.map_err(|failure| failure.error)
        });
        let error = begun.err()?;
        Some(format!("this start cannot be simulated: {error}"))
    }

    /// Adds warnings to the document of the start. They state which drives contradict each other
    /// later, and why no motion begins.
    ///
    /// # Errors
    /// Returns the errors of [`Study::contradicting_drives`].
    pub fn add_warnings(&self, document: &mut AnalysisDocument) -> Result<(), StudyError> {
        if let Some(later) = self.contradicting_drives()? {
            document.warnings.insert(0, later.to_string());
        }
        document.warnings.extend(self.cannot_begin());
        Ok(())
    }

    /// Returns the state at a time of the motion. At t = 0, no run is needed.
    pub(crate) fn state_at(&self, t: f64) -> Result<State, StudyError> {
        self.state_until(t, &|| false)
    }

    /// Returns the state at a time of the motion. The state is the same as in a row of the tables
    /// at this time. At t = 0, no run is needed. `stop` is called at each evaluation of the run.
    ///
    /// ```
    /// use pfaff::prelude::*;
    ///
    /// // A thrown body is back after 1 s: v = 5 − g·t.
    /// let mut thrown = Description { gravity: [0.0, -10.0], ..Description::new("thrown") };
    /// thrown.body(Body { velocity: Some([0.0, 5.0]), ..Body::new("stone", 1.0, 1.0) });
    /// let study = Study::build(thrown)?;
    /// let state = study.state_until(1.0, &|| false)?;
    /// assert!(state.q[1].abs() < 1e-9 && (state.v[1] + 5.0).abs() < 1e-9);
    /// assert!(matches!(study.state_until(1.0, &|| true), Err(StudyError::Interrupted)));
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// - [`StudyError::Motion`]: the motion does not reach that time.
    /// - [`StudyError::Interrupted`]: `stop` returned true.
    pub fn state_until(&self, t: f64, stop: &Stop<'_>) -> Result<State, StudyError> {
        if t == self.start_time() {
            return Ok(State {
                q: self.prepared.q.clone(),
                v: self.prepared.v.clone(),
            });
        }
        let own = self.motion_to(t);
        match self.reached(t, &own, stop) {
            // A run to the end that the scene states may not begin because of events after t.
            Err(StudyError::Motion(_)) if own.t_end > t => {
                let shorter = MotionOptions { t_end: t, ..own };
                self.reached(t, &shorter, stop)
            }
            state => state,
        }
    }

    /// Returns the state at a later time of a motion with a row at that time.
    fn reached(
        &self,
        t: f64,
        options: &MotionOptions,
        stop: &Stop<'_>,
    ) -> Result<State, StudyError> {
        let mut state = None;
        let wanted = OutputRequest {
            accelerations: false,
            reactions: Reactions::None,
            uniqueness: false,
            ..OutputRequest::default()
        };
        let plan = Plan::new(&self.prepared, options, &wanted)?;
        plan.simulate_watched(&|_| ControlFlow::Continue(()), stop, |sample| {
            if sample.t < t {
                return Ok(ControlFlow::Continue(()));
            }
            state = Some(State {
                q: sample.q.to_vec(),
                v: sample.v.to_vec(),
            });
            Ok(ControlFlow::Break(()))
        })
        .map_err(|f| f.error)?;
        state.ok_or(StudyError::Interrupted)
    }

    /// Returns options of a run with a row at this time. The run has the same steps as the motion
    /// that the scene states. A run that ended at this time would have other steps and a slightly
    /// different motion within the tolerance.
    fn motion_to(&self, t: f64) -> MotionOptions {
        let base = self.options.clone().unwrap_or_else(|| MotionOptions::to(t));
        MotionOptions {
            t_end: base.t_end.max(t),
            output_step: t,
            ..base
        }
    }

    /// Returns the options of a run of the scene. Options of the caller take precedence. Returns
    /// `None` if neither the scene nor the caller states the end of the run. A choice of redundant
    /// rows needs a separate study; see [`AssembledScene::prepare`].
    #[must_use]
    pub fn options_with(&self, overrides: &RunOptions) -> Option<MotionOptions> {
        crate::assembled::options(&self.scene, overrides)
    }

    /// Runs the scene and passes projected output rows to a function. See [`dynamics::simulate()`].
    ///
    /// # Errors
    /// An error contains the summary of the completed part.
    pub fn run(
        &self,
        options: &MotionOptions,
        row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        self.run_until(options, &|| false, row)
    }

    /// Works like [`Study::run`]. `stop` is called at each evaluation. The run ends after `stop`
    /// returns true.
    ///
    /// # Errors
    /// Returns the errors of [`Study::run`].
    pub fn run_until(
        &self,
        options: &MotionOptions,
        stop: &Stop<'_>,
        row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, MotionFault>,
    ) -> Result<Summary, Box<Failure>> {
        simulate_until(&self.prepared, options, stop, row)
    }

    /// Returns the motion as plain data. The data contain the state and the reactions at t = 0, at
    /// every output step and at the end, and the numbers, events and verdicts of the run. Values of
    /// reactions that are not unique depend on the choice that the summary states.
    ///
    /// ```
    /// use pfaff::prelude::*;
    ///
    /// // A thrown body: y = 5·t − g·t²/2.
    /// let mut thrown = Description { gravity: [0.0, -10.0], ..Description::new("thrown") };
    /// thrown.body(Body { velocity: Some([0.0, 5.0]), ..Body::new("stone", 1.0, 1.0) });
    /// let motion = Study::build(thrown)?.motion(&MotionOptions::to(1.0))?;
    /// let highest = motion.rows.iter().map(|row| row.bodies["stone"]["y"]).fold(0.0, f64::max);
    /// assert!((highest - 1.25).abs() < 1e-9);
    /// assert_eq!(motion.rows.len(), 201);
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// - [`StudyError::Motion`]: the run could not begin, or stopped; [`Study::run`] returns the
    ///   rows up to that time.
    /// - [`StudyError::Analysis`]: reactions cannot be analysed at the start.
    pub fn motion(&self, options: &MotionOptions) -> Result<MotionDocument, StudyError> {
        let mechanism = &self.prepared.mechanism;
        let mut rows = Vec::new();
        let ended = self.show(
            options,
            &OutputRequest::default(),
            &|| false,
            |sample, numbers| {
                let (t, q, v) = (sample.t, sample.q, sample.v);
                rows.push(MomentDocument::new(mechanism, t, q, v, &numbers.reactions));
                ControlFlow::Continue(())
            },
        )?;
        match (ended.stopped, &ended.stretches) {
            (Some(error), _) => Err(error.into()),
            (None, stretches) => Ok(MotionDocument::new(
                ended.document,
                rows,
                mechanism,
                stretches.as_ref(),
            )),
        }
    }

    /// Runs the scene and passes the rows with their reactions to `row`. `row` may end the run.
    /// `stop` is called at each evaluation and may also end the run. Rows that were passed are
    /// valid even if the run ends early.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use pfaff::dynamics::OutputRequest;
    /// use pfaff::prelude::*;
    ///
    /// let mut thrown = Description { gravity: [0.0, -10.0], ..Description::new("thrown") };
    /// thrown.body(Body { velocity: Some([0.0, 5.0]), ..Body::new("stone", 1.0, 1.0) });
    /// let study = Study::build(thrown)?;
    /// let mut highest = 0.0_f64;
    /// let (options, wanted) = (MotionOptions::to(1.0), OutputRequest::default());
    /// let ended = study.show(&options, &wanted, &|| false, |sample, _| {
    ///     highest = highest.max(sample.q[1]);
    ///     if sample.v[1] > 0.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    /// })?;
    /// assert!((highest - 1.25).abs() < 1e-9);
    /// assert!(ended.document.partial);
    /// # Ok::<(), StudyError>(())
    /// ```
    ///
    /// # Errors
    /// - [`StudyError::Motion`]: the run could not begin.
    /// - [`StudyError::Interrupted`]: the run was ended before the first row.
    /// - [`StudyError::Analysis`]: reactions cannot be analysed at the start.
    pub fn show(
        &self,
        options: &MotionOptions,
        wanted: &OutputRequest,
        stop: &Stop<'_>,
        row: impl FnMut(&mut Sample<'_, '_>, &ChosenNumbers) -> ControlFlow<()>,
    ) -> Result<EndedRun, StudyError> {
        self.show_bounded(options, wanted, self.bounds.as_ref(), stop, row)
    }

    /// Works like [`Study::show`], with bounds for these elastic joints in place of
    /// [`Study::bounds`].
    ///
    /// # Errors
    /// Returns the errors of [`Study::show`].
    pub fn show_bounded(
        &self,
        options: &MotionOptions,
        wanted: &OutputRequest,
        elasticity: Option<&Elasticity>,
        stop: &Stop<'_>,
        mut row: impl FnMut(&mut Sample<'_, '_>, &ChosenNumbers) -> ControlFlow<()>,
    ) -> Result<EndedRun, StudyError> {
        let begun = self.begun()?;
        let plan = Plan::new(&self.prepared, options, &begun.wanted(wanted.clone()))?;
        let mut gaps = vec![None; plan.choices.len()];
        let (mut path, mut rows) = (Path::new(&self.prepared), 0);
        let (mechanism, q) = (&self.prepared.mechanism, &self.prepared.q);
        let mut groups = GroupNumbers::new(mechanism, q, &plan.groups);
        let (columns, space) = (begun.columns(&Selection::All)?, mechanism.space());
        let mut peaks = PeaksOfRun::new(mechanism, columns.clone());
        let every = TableRows::new(1, plan.options().t_end);
        let mut loads = LoadsOfRun::begin(None, mechanism, every)?;
        let mut caller = Calling(|sample: &mut Sample<'_, '_>| {
            let numbers = ChosenNumbers {
                loads: loads.as_mut().map_or_else(Vec::new, |all| all.see(sample)),
                reactions: sample.reactions()?,
                groups: group_numbers(&mut groups, sample)?,
                choices: chosen_numbers(sample, &mut groups, &mut gaps)?,
            };
            let cuts = sample.events.iter().filter(|event| event.kind.cuts());
            cuts.for_each(|event| peaks.cut(event.time));
            let own = numbers.reactions.as_chosen().iter();
            let own = own.flat_map(|r| r.components(space).chain(r.component));
            let values: Vec<f64> = own
                .chain(numbers.groups.as_chosen().iter().copied())
                .collect();
            peaks.row(sample.t, &values, numbers.reactions.as_chosen());
            rows += 1;
            Ok(row(sample, &numbers))
        });
        let goes_on = |_| ControlFlow::Continue(());
        let elastic = elasticity.filter(|_| self.prepared.decision.redundancy > 0);
        let mut bounds = elastic.map(|elastic| {
            let all = TableRows::new(1, plan.options().t_end);
            BoundsOfRun::new(
                (&self.scene, mechanism),
                elastic,
                columns.clone(),
                &plan,
                (all, true),
            )
        });
        let mut pulls = PullsOfRun::begin(&self.scene, mechanism, every);
        let mut sinks: Vec<&mut dyn RowSink> = vec![&mut path, &mut caller];
        sinks.extend(pulls.as_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(bounds.as_mut().map(|sink| sink as &mut dyn RowSink));
        let ended = run_into(
            &plan,
            (&goes_on, stop),
            &mut |_| goes_on(self.start_time()),
            &mut sinks,
        )?;
        if let Some(bounds) = &mut bounds {
            bounds.end(ended.summary.verdicts.as_ref(), &ended.ending())?;
        }
        let found = ended.summary.verdicts.as_ref();
        let peaks = found.map_or_else(FoundPeaks::default, |found| peaks.finish(found));
        let written = WrittenRun {
            pulls: pulls.map_or_else(Vec::new, |pulls| pulls.found(found)),
            spread: path.spread_of(&plan, &ended, stop),
            rows,
            peaks: &peaks,
            files: &[],
            gaps: &gaps,
            loads: loads.as_ref(),
            bodies: Vec::new(),
            elasticity,
            bounds: bounds.as_ref().map(BoundsOfRun::found),
        };
        let document = begun.document(&plan, &ended, written);
        Ok(EndedRun {
            bounds: bounds.map_or_else(Vec::new, BoundsOfRun::into_rows),
            document,
            verdicts: begun.start.analysis.reactions.clone(),
            columns,
            stretches: ended.summary.verdicts,
            stopped: ended.error,
        })
    }

    /// Finds the joint or drive with this name.
    ///
    /// # Errors
    /// [`StudyError::UnknownReaction`], with the most similar name.
    pub fn reaction(&self, name: &str) -> Result<ConstraintId, StudyError> {
        requests::reaction(&self.scene, &self.prepared.mechanism, name)
    }

    /// Returns the elastic joints of the request in the scene, if the scene requests bounds.
    ///
    /// # Errors
    /// [`StudyError::Bounds`], if the request does not fit the mechanism.
    pub(crate) fn wanted_bounds(&self) -> Result<Option<Elasticity>, StudyError> {
        requests::bounds(&self.scene, &self.prepared.mechanism)
    }

    /// Returns the groups of the scene with their names.
    fn groups(&self) -> Result<Vec<(String, Group)>, StudyError> {
        requests::groups(&self.scene, &self.prepared.mechanism, &[])
    }

    /// Returns the data of a run that are known before the run begins.
    fn begun(&self) -> Result<RunPreparation<'_>, StudyError> {
        let start = self.analyse(self.start_time(), None)?;
        let choices = self.choices.iter().map(|choice| start.named(choice));
        let sensitivities = start.sensitivities()?;
        Ok(RunPreparation {
            case: self.case.as_deref(),
            choices: choices.collect::<Result<_, _>>()?,
            freedoms: start.freedoms()?.clone(),
            group_sensitivities: start.group_sensitivities(&sensitivities)?,
            sensitivities,
            groups: self.groups()?,
            start,
        })
    }

    /// Returns the plan of a run of the scene, with the output that `[output]` of the scene
    /// requests.
    ///
    /// ```
    /// use pfaff::model::Registry;
    /// use pfaff::{RunOptions, Study};
    ///
    /// let scene = r#"
    /// scene = { name = "pendulum", space = "plane", gravity = [0.0, -9.81] }
    /// body = [{ name = "bob", mass = 1.0, inertia = 0.1, position = [1.0, 0.0] }]
    /// joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
    /// simulate = { t_end = 1.0 }
    /// output = { reactions = false }
    /// "#;
    /// let study = Study::read("pendulum.toml", scene, &Registry::standard(), &RunOptions::default())?;
    /// let plan = study.plan()?;
    /// assert_eq!(plan.components[0].decisions.reactions.taken, "none");
    /// assert_eq!(plan.components[0].decisions.method.reason, "no applied forces that could be stiff");
    /// # Ok::<(), pfaff::StudyError>(())
    /// ```
    ///
    /// # Errors
    /// - [`StudyError::NoEnd`]: neither the scene nor the caller states the end of the run.
    /// - [`StudyError::Motion`]: the options are invalid, or the motion cannot be evaluated at its
    ///   start.
    pub fn plan(&self) -> Result<Plan<'_>, StudyError> {
        let options = self.options.as_ref().ok_or(StudyError::NoEnd)?;
        let groups = self.groups()?.into_iter().map(|(_, group)| group);
        let mut wanted = OutputRequest {
            groups: groups.collect(),
            ..wanted(&self.scene.output)
        };
        let asks_bodies = !self.scene.output.bodies.is_empty();
        wanted.accelerations |= asks_bodies;
        let needs_all = asks_bodies || self.bounds.is_some();
        if needs_all && matches!(wanted.reactions, Reactions::Of(_)) {
            // The bounds of one reaction depend on the loads of all joints.
            wanted.reactions = Reactions::All;
        }
        let options = MotionOptions {
            output_step: options.output_step / self.rows_between(&wanted) as f64,
            ..options.clone()
        };
        Ok(Plan::new(&self.prepared, &options, &wanted)?)
    }

    /// Returns the number of rows that a run computes for each row of the tables. An animation may
    /// need more rows than the scene requests. The number is a power of two, so that the times of
    /// the tables do not change.
    fn rows_between(&self, wanted: &OutputRequest) -> usize {
        let Some(options) = self.options.as_ref().filter(|_| self.scene.output.report) else {
            return 1;
        };
        if wanted.rows == Rows::Ends || self.prepared.mechanism.layout().rows() > PICTURED_ROWS {
            return 1;
        }
        let rows = (options.t_end / options.output_step).max(1.0);
        let mut between = 1;
        while rows * (between as f64) < MotionOptions::OUTPUT_STEPS {
            between *= 2;
        }
        between
    }

    /// Runs the scene and writes the requested files into a directory: `trajectory.csv`,
    /// `reactions.csv`, `summary.json` and `report.html`. Files of an earlier run that this run
    /// does not write are removed. `progress` is called with the time of each row and may stop the
    /// run. If no rows are written, `progress` is called with the time of each step. The files of a
    /// stopped run are kept, and the summary contains `partial`.
    ///
    /// # Errors
    /// - [`StudyError::NoEnd`]: neither the scene nor the caller states the end of the run.
    /// - [`StudyError::Motion`]: the run could not begin; nothing has been written.
    /// - [`StudyError::Stopped`]: the run stopped; all results up to that time have been written.
    /// - [`StudyError::Interrupted`]: a stop was requested before the first row.
    /// - [`StudyError::File`], [`StudyError::Table`]: a file could not be written.
    pub fn simulate_into(
        &self,
        directory: &OutputDirectory,
        progress: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<RunDocument, StudyError> {
        self.simulate_as(&Origin::default(), directory, &|| false, progress)
    }

    /// Works like [`Study::simulate_into`]. In addition, the report contains information about the
    /// origin of the run. `stop` is called at each evaluation, and the run ends after `stop`
    /// returns true.
    ///
    /// # Errors
    /// Returns the errors of [`Study::simulate_into`].
    pub fn simulate_as(
        &self,
        origin: &Origin,
        directory: &OutputDirectory,
        stop: &Stop<'_>,
        progress: impl FnMut(f64) -> ControlFlow<()> + Send,
    ) -> Result<RunDocument, StudyError> {
        // The plan is checked before any file of an earlier run is changed.
        let mut plan = self.plan()?;
        let t_end = plan.options().t_end;
        let between = self.rows_between(&wanted(&self.scene.output));
        let mechanism = &self.prepared.mechanism;
        let output = &self.scene.output;
        let begun = self.begun()?;
        let asks_bodies = !output.bodies.is_empty();
        let needs_reactions = asks_bodies || !begun.choices.is_empty() || self.bounds.is_some();
        if needs_reactions && matches!(output.reactions, WantedReactions::None) {
            return Err(StudyError::NoReactions);
        }
        if begun.choices.is_empty() {
            begun.check_loads_of(&output.bodies)?;
        }
        plan.choices.clone_from(&begun.choices);
        let table_rows = TableRows::new(between, t_end);
        let units = table_units(&self.scene);
        let mut trajectory = if output.trajectory {
            let file = directory.file("trajectory.csv")?;
            let trajectory = Trajectory::new(mechanism, more_columns(output));
            let table = TrajectoryTable::new(file, trajectory, units)?;
            Some(TrajectoryFile::new(table, table_rows))
        } else {
            None
        };
        let mut reactions = match selection(&output.reactions) {
            Some(selection) => Some(ReactionFiles::begin(
                directory,
                (mechanism, &self.prepared.q),
                (begun.columns(&selection)?, units),
                &plan,
                table_rows,
                self.prepared.decision.redundancy == 0,
            )?),
            None => None,
        };
        let is_plain = self.prepared.decision.redundancy == 0;
        let elasticity = self.bounds.as_ref();
        let mut bounds = match (elasticity, selection(&output.reactions)) {
            (Some(elasticity), Some(selection)) if !is_plain => Some(BoundsOfRun::begin(
                directory,
                (&self.scene, mechanism),
                elasticity,
                begun.columns(&selection)?,
                &plan,
                (table_rows, output.report),
            )?),
            _ => None,
        };
        let asked = self.options.as_ref().ok_or(StudyError::NoEnd)?;
        let builder = || ReportBuilder::new(&self.scene, &self.prepared, asked, &plan);
        let mut report_builder = output.report.then(builder).transpose()?;
        let progress = Mutex::new(progress);
        let go_on = |t: f64| {
            // A lock is poisoned only by a panic. The panic continues in its own thread.
            progress.lock().map_or(ControlFlow::Break(()), |mut p| p(t))
        };
        let watch = |t: f64| match plan.rows.value {
            Rows::Every | Rows::Interpolated => ControlFlow::Continue(()),
            Rows::Ends => go_on(t),
        };
        let mut path = Path::new(&self.prepared);
        let mut counted = TableRows::new(between, t_end);
        let mut written_rows = 0;
        let mut counter = Calling(|sample: &mut Sample<'_, '_>| {
            written_rows += usize::from(counted.take(sample.t));
            Ok(ControlFlow::Continue(()))
        });
        // Without rows of reactions, a run need not stop at the rows.
        let (mut loads, mut pulls) = match output.reactions {
            WantedReactions::None => (None, None),
            _ => (
                LoadsOfRun::begin(Some((directory, units)), mechanism, table_rows)?,
                PullsOfRun::begin(&self.scene, mechanism, table_rows),
            ),
        };
        let is_complete = (is_plain, !begun.choices.is_empty());
        let of_bodies = output.bodies.iter().map(|&body| {
            BodyLoads::begin(directory, mechanism, body, (table_rows, units), is_complete)
        });
        let mut of_bodies: Vec<BodyLoads<'_>> = of_bodies.collect::<Result<_, _>>()?;
        let mut sinks: Vec<&mut dyn RowSink> = vec![&mut path, &mut counter];
        sinks.extend(of_bodies.iter_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(loads.as_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(pulls.as_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(trajectory.as_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(reactions.as_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(bounds.as_mut().map(|sink| sink as &mut dyn RowSink));
        sinks.extend(report_builder.as_mut().map(|sink| sink as &mut dyn RowSink));
        let ended = run_into(&plan, (&watch, stop), &mut |t| go_on(t), &mut sinks)?;
        for sink in &mut sinks {
            sink.end(ended.summary.verdicts.as_ref(), &ended.ending())?;
        }
        drop(sinks);
        let none = FoundPeaks::default();
        let peaks = reactions.as_ref().map_or(&none, |tables| &tables.found);
        let (choice_files, gaps): (&[String], &[Option<Gap>]) = match &reactions {
            Some(tables) => (&tables.choice_files, &tables.gaps),
            None => (&[], &[]),
        };
        let found = bounds.as_ref().map(BoundsOfRun::found);
        let has_bounds = found.is_some_and(|(_, found)| found.has_table);
        let others = [(LOADS, loads.is_some()), (BOUNDS, has_bounds)];
        let mut files = files_of(output, choice_files, others);
        let bodies = output.bodies.iter().zip(&of_bodies);
        let bodies = bodies.map(|(&body, table)| {
            let name = mechanism.bodies()[body].name.clone();
            (name, table.found.clone())
        });
        let bodies: Vec<_> = bodies.collect();
        files.extend(bodies.iter().map(|(_, table)| table.file.clone()));
        let stretches = ended.summary.verdicts.as_ref();
        let pulls = pulls.map_or_else(Vec::new, |pulls| pulls.found(stretches));
        let written = WrittenRun {
            spread: path.spread_of(&plan, &ended, stop),
            rows: written_rows,
            files: &files,
            gaps,
            peaks,
            loads: loads.as_ref(),
            bodies,
            pulls,
            elasticity,
            bounds: found,
        };
        let document = begun.document(&plan, &ended, written);
        let mut text = Vec::new();
        write_json(&mut text, &document).map_err(|source| TableError::Write {
            table: "summary.json",
            source,
        })?;
        directory.write("summary.json", &text)?;
        // The summary lists the files of the run. Old files without an entry are removed.
        directory.keep(FAMILY, &files)?;
        if let Some(report_builder) = report_builder {
            let figure = comparison_beside(directory);
            let of_run = OfRun {
                start: &begun.start,
                sensitivities: &begun.sensitivities,
                document: &document,
                stretches,
                bounds: found,
                remedies: &self.remedies,
            };
            let page = report_builder.page(&of_run, origin, figure.as_deref());
            directory.write("report.html", page.as_bytes())?;
        }
        match (ended.unwritten, ended.error) {
            (Some(e), _) => Err(e.into()),
            (None, Some(error)) => Err(StudyError::Stopped {
                error,
                run: Box::new(document),
            }),
            (None, None) => Ok(document),
        }
    }
}

/// Data of a run that are known before the run begins.
struct RunPreparation<'s> {
    /// The load case whose values the scene contains.
    case: Option<&'s str>,
    start: ConfigurationAnalysis<'s>,
    freedoms: Freedoms,
    sensitivities: Sensitivities,
    /// The groups of the scene, with their names.
    groups: Vec<(String, Group)>,
    choices: Vec<NamedChoice>,
    /// Sensitivities of the numbers of the groups to the data, with the same names.
    group_sensitivities: Vec<(String, GroupSensitivities)>,
}

/// Output of a run.
struct WrittenRun<'w> {
    spread: Option<SpreadDocument>,
    rows: usize,
    files: &'w [String],
    gaps: &'w [Option<Gap>],
    peaks: &'w FoundPeaks,
    loads: Option<&'w LoadsOfRun<'w>>,
    /// The tables of the loads on bodies, by the names of the bodies.
    bodies: Vec<(String, BodyOfRunDocument)>,
    /// Contacts that pull.
    pulls: Vec<PullDocument>,
    /// The elastic joints of the requested bounds.
    elasticity: Option<&'w Elasticity>,
    /// The columns of the bounds, with the results.
    bounds: Option<(&'w [ReactionColumn], &'w FoundBounds)>,
}

impl RunPreparation<'_> {
    /// Rejects bodies on which some loads are not determined at the start.
    fn check_loads_of(&self, bodies: &[usize]) -> Result<(), StudyError> {
        let mechanism = self.start.mechanism;
        for &body in bodies {
            let own = joints_of(mechanism, body).into_iter();
            let reactions = &self.start.analysis.reactions;
            let open = own.filter(|id| !reactions[id.0].wrench.verdict.is_unique());
            let open = open.map(|id| mechanism.layout().groups[id.0].name.clone());
            let open: Vec<String> = open.collect();
            if !open.is_empty() {
                return Err(StudyError::OpenLoads {
                    body: mechanism.bodies()[body].name.clone(),
                    joints: open,
                });
            }
        }
        Ok(())
    }

    /// Adds the groups of the scene and the choices to the requested output.
    fn wanted(&self, wanted: OutputRequest) -> OutputRequest {
        let groups = self.groups.iter().map(|(_, group)| group.clone());
        let choices = self.choices.iter().cloned();
        OutputRequest {
            groups: groups.collect(),
            choices: choices.chain(wanted.choices).collect(),
            ..wanted
        }
    }

    /// Returns the columns of reactions.
    fn columns(&self, selection: &Selection) -> Result<Vec<ReactionColumn>, TableError> {
        let mechanism = self.start.mechanism;
        columns_of_reactions(mechanism, selection, &self.groups, |quantity| {
            self.is_fragile(quantity)
        })
    }

    /// Whether a number is unique at the start, but sensitive to the last digits of the data.
    fn is_fragile(&self, quantity: &Quantity) -> bool {
        let own = match quantity {
            Quantity::Component(id, name) => self.sensitivities.component(*id, name),
            Quantity::Group(k, name) => self.group_sensitivities[*k].1.number(name),
        };
        own.is_some_and(Sensitivity::is_fragile)
    }

    fn document(&self, plan: &Plan<'_>, ended: &RunEnd, written: WrittenRun<'_>) -> RunDocument {
        let verdicts = ended.summary.verdicts.as_ref();
        let mut document = RunDocument::new(&Run {
            plan,
            reactions: &self.start.analysis.reactions,
            sensitivities: &self.sensitivities,
            data: DataDocument::new(&self.start.analysis),
            freedoms: &self.freedoms,
            verdicts: verdicts.map(|stretches| RunVerdicts {
                stretches,
                groups: &self.group_sensitivities,
                peaks: written.peaks,
            }),
            summary: &ended.summary,
            spread: written.spread.as_ref(),
            ending: ended.ending(),
            rows: written.rows,
            files: written.files,
            gaps: written.gaps,
        });
        document.case = self.case.map(str::to_owned);
        document.loads = loads_of_run::documents(written.loads);
        document.bodies = ByName(written.bodies);
        document.pulls = written.pulls;
        if let Some(elasticity) = written.elasticity {
            let mechanism = self.start.mechanism;
            let found = written.bounds;
            bounds_of_run::add_to(&mut document, mechanism, elasticity, found, verdicts);
        }
        document
    }
}

/// The files of a run.
pub const FAMILY: Family = Family(&[
    "trajectory.csv",
    "reactions.csv",
    "choice.csv",
    "choice_*.csv",
    "bounds.csv",
    "bounds_*.csv",
    "loads.csv",
    "body_<name>.csv",
    "choice_body_<name>.csv",
    "all_body_<name>.csv",
    "summary.json",
    "report.html",
]);

/// Returns the files of a run with this output and these tables of choices. `more` lists other
/// tables, and whether they exist.
fn files_of(output: &Output, choices: &[String], more: [(&str, bool); 2]) -> Vec<String> {
    let reactions = !matches!(output.reactions, WantedReactions::None);
    let tables = [
        ("trajectory.csv", output.trajectory),
        ("reactions.csv", reactions),
    ];
    let others = [("summary.json", true), ("report.html", output.report)];
    let wanted = |(name, is): (&str, bool)| is.then(|| name.to_owned());
    let tables = tables.into_iter().filter_map(wanted);
    let tables = tables.chain(choices.iter().cloned());
    let tables = tables.chain(more.into_iter().filter_map(wanted));
    tables
        .chain(others.into_iter().filter_map(wanted))
        .collect()
}

/// Returns the output of a run that is needed for these files.
fn wanted(output: &Output) -> OutputRequest {
    let reactions = match &output.reactions {
        WantedReactions::All => Reactions::All,
        WantedReactions::Of(names) => Reactions::Of(names.clone()),
        WantedReactions::None => Reactions::None,
    };
    let rows = match (output.trajectory, &reactions) {
        (false, Reactions::None) => Rows::Ends,
        _ => Rows::Every,
    };
    OutputRequest {
        rows,
        accelerations: output.trajectory && output.accelerations,
        reactions,
        ..OutputRequest::default()
    }
}

/// Returns the values of a row for each choice, and counts the rows at which a choice selects no
/// solution.
fn chosen_numbers(
    sample: &mut Sample<'_, '_>,
    groups: &mut GroupNumbers<'_>,
    gaps: &mut [Option<Gap>],
) -> Result<Vec<ChosenNumbers>, RowFault> {
    let mut all = Vec::with_capacity(gaps.len());
    if gaps.is_empty() {
        return Ok(all);
    }
    for (found, gap) in sample.chosen()?.into_iter().zip(gaps) {
        note_gap(gap, sample.t, found.refused.as_ref());
        all.push(ChosenNumbers {
            groups: numbers_of(groups, sample, &found.multipliers)?,
            reactions: found.reactions,
            choices: Vec::new(),
            loads: Vec::new(),
        });
    }
    Ok(all)
}

/// Returns the figure of a comparison of methods in the same directory, if there is such a figure
/// and the figure is not too large for the page.
fn comparison_beside(directory: &OutputDirectory) -> Option<String> {
    let path = directory.path().join("work_precision.svg");
    let small = std::fs::metadata(&path).is_ok_and(|m| m.len() < FIGURE_MOST);
    small.then(|| std::fs::read_to_string(path).ok()).flatten()
}

/// Largest size of a figure that is included in a page (bytes).
const FIGURE_MOST: u64 = 1 << 20;
