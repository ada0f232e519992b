//! A scene with its mechanism, before the rows of the mechanism are analysed. This is the first
//! stage of a study. If the rank is too uncertain for a motion, no other stage is available.

use dynamics::{MotionError, MotionOptions, PreparedMechanism, RowChoice};
use dynamics::{prepare_after, start_velocity, unmovable};
use model::start::CorrectionLimit;
use model::start::assemble;
use model::{
    AnyDescription, Assembly, ConfigurationAccuracy, FramePose, Mechanism, Registry, StartError,
    StartPose, System, Tolerance,
};
use scene::Scene;
use solvability::{ConstraintLevel, State};

use crate::configuration::{AskedRows, ConfigurationAnalysis};
use crate::error::StudyError;
use crate::run_options::RunOptions;
use crate::study::Study;
use crate::within;

/// A scene whose mechanism has been built.
///
/// ```
/// use pfaff::AssembledScene;
/// use pfaff::model::Registry;
///
/// // Two pivots 10⁻⁹ m apart: such a bar can neither move nor be called redundant in double precision.
/// let scene = r#"
/// scene = { name = "bar", space = "plane" }
/// body = [{ name = "bar", mass = 1.0, inertia = 1.0, position = [1.0, 0.0] }]
/// joint = [
///     { name = "pivot", type = "revolute", bodies = ["ground", "bar"], at = [0.0, 0.0] },
///     { name = "twin", type = "revolute", bodies = ["ground", "bar"], at = [1e-9, 0.0] },
/// ]
/// "#;
/// let mut assembled = AssembledScene::read("bar.toml", scene, &Registry::standard())?;
/// let start = assembled.analyse(None)?;
/// assert_eq!((start.analysis.decision.rank, start.analysis.decision.redundancy), (3, 1));
/// assert!(start.analysis.nearly_redundant.is_some());
/// # Ok::<(), pfaff::StudyError>(())
/// ```
#[non_exhaustive]
pub struct AssembledScene {
    /// The scene, read from a text or built by a program.
    pub scene: Scene,
    /// The mechanism of the scene. Its initial values are the values given in the scene, before the
    /// assembly.
    pub mechanism: Mechanism,
}

impl AssembledScene {
    /// Reads a scene. `name` is the file name in messages.
    ///
    /// # Errors
    /// [`StudyError::Scene`]: all faults of the text.
    pub fn read(name: &str, text: &str, registry: &Registry) -> Result<Self, StudyError> {
        let read = scene::read_and_build(name, text, registry);
        let (scene, mechanism) = read.map_err(StudyError::Scene)?;
        Ok(Self { scene, mechanism })
    }

    /// Builds the mechanism of a scene. The argument is a [`Scene`] or the description of a
    /// mechanism, for example a description that a Rust program built without the text of a scene.
    ///
    /// # Errors
    /// [`StudyError::Build`]: all faults of the description. If the scene was read from a text and
    /// then changed, [`StudyError::Scene`] with positions in the text.
    pub fn build(scene: impl Into<Scene>) -> Result<Self, StudyError> {
        let scene = scene.into();
        match Mechanism::build(&scene.description) {
            Ok(mechanism) => Ok(Self { scene, mechanism }),
            Err(faults) => {
                let places: Option<_> = faults.iter().map(|e| scene.locate_build(e)).collect();
                Err(places.map_or(StudyError::Build(faults), StudyError::Scene))
            }
        }
    }

    /// Replaces the tolerances that the `[scene]` table states. Values that are `None` do not
    /// replace anything. Tolerances of bodies and joints still take precedence.
    ///
    /// ```
    /// use pfaff::AssembledScene;
    /// use pfaff::model::{Registry, Tolerance};
    ///
    /// let scene = r#"
    /// scene = { name = "stone", space = "plane", tolerance = 1e-3, angle_tolerance = 1e-4 }
    /// body = [{ name = "stone", mass = 1.0, inertia = 1.0 }]
    /// "#;
    /// let assembled = AssembledScene::read("stone.toml", scene, &Registry::standard())?;
    /// let finer = assembled.stating(Tolerance { length: Some(1e-5), angle: None })?;
    /// let expected = Tolerance { length: Some(1e-5), angle: Some(1e-4) };
    /// assert_eq!(finer.mechanism.tolerance(), expected);
    /// assert_eq!(finer.scene.description.tolerance(), expected);
    /// # Ok::<(), pfaff::StudyError>(())
    /// ```
    ///
    /// # Errors
    /// [`StudyError::Build`]: a tolerance is not a finite number > 0.
    pub fn stating(mut self, tolerance: Tolerance) -> Result<Self, StudyError> {
        let tolerance = tolerance.or(self.scene.description.tolerance());
        let stated = self.mechanism.set_tolerance(tolerance);
        stated.map_err(|fault| StudyError::Build(vec![fault]))?;
        self.scene.description.set_tolerance(tolerance);
        Ok(self)
    }

    /// Finds a consistent start and chooses rows.
    ///
    /// # Errors
    /// - [`StudyError::Scene`]: there is no such start; for a scene without text
    ///   [`StudyError::Motion`].
    /// - [`StudyError::SingularStart`]: there is such a start, but no motion begins with its
    ///   velocities.
    /// - [`StudyError::Motion`]: the start exists, but no rows can be chosen; or options of the run
    ///   are invalid, with their position in the text if they come from the scene.
    pub fn prepare(self, overrides: &RunOptions) -> Result<Study, StudyError> {
        self.prepare_after(overrides, None)
    }

    /// Works like [`AssembledScene::prepare`], but reuses the decisions for another mechanism with
    /// the same constraints.
    pub(crate) fn prepare_after(
        self,
        overrides: &RunOptions,
        other: Option<&PreparedMechanism>,
    ) -> Result<Study, StudyError> {
        let Self { scene, mechanism } = self;
        let options = options(&scene, overrides);
        let rows = match (&overrides.drop, &options) {
            (Some(drop), _) => RowChoice::Drop(drop.clone()),
            (None, Some(options)) => options.rows.clone(),
            (None, None) => RowChoice::Automatic,
        };
        if let Some(Err(e)) = options.as_ref().map(MotionOptions::check) {
            return Err(if *overrides == RunOptions::default() {
                refused(&scene, e)
            } else {
                e.into()
            });
        }
        let spare = match other {
            None => within::spare(&mechanism),
            Some(_) => None,
        };
        let prepared = match prepare_after(mechanism, &scene.start, &rows, other) {
            Ok(prepared) => prepared,
            Err(e) if leaves_no_motion(&e) => {
                let place = scene.locate_motion(&e).map(Box::new);
                return Err(match e {
                    MotionError::Contradiction(contradiction) => StudyError::SingularStart {
                        contradiction,
                        place,
                    },
                    other => other.into(),
                });
            }
            // Only errors of the text have a position in the text. Rows may come from the caller.
            Err(e @ (MotionError::Start(_) | MotionError::Contradiction(_))) => {
                let help = within::advice(spare.as_ref(), &scene, &rows, &e);
                return Err(match (refused(&scene, e), help) {
                    (StudyError::Scene(mut places), Some(help)) => {
                        if let Some(place) = places.first_mut() {
                            place.help = Some(help);
                        }
                        StudyError::Scene(places)
                    }
                    (error, _) => error,
                });
            }
            Err(e @ MotionError::Rows(_)) if overrides.drop.is_none() => {
                return Err(refused(&scene, e));
            }
            Err(e) => return Err(e.into()),
        };
        Ok(Study {
            scene,
            prepared,
            options,
            choices: Vec::new(),
            bounds: None,
            remedies: Vec::new(),
            case: None,
        })
    }

    /// Moves the bodies to the nearest consistent configuration, and sets the initial values of the
    /// joints to the values at this configuration.
    ///
    /// # Errors
    /// [`StudyError::Scene`]: there is no such configuration; for a scene without text
    /// [`StudyError::Motion`].
    pub fn assemble(&mut self) -> Result<Assembly, StudyError> {
        assemble(&mut self.mechanism, &self.scene.start).map_err(|e| refused(&self.scene, e.into()))
    }

    /// Returns the frames of all bodies at a configuration near the start, in which one body is as
    /// close to another pose as the joints allow. The other bodies follow. `to` converts the frame
    /// at the start to this pose. [`scene::posed`] writes the frames into the text.
    ///
    /// # Errors
    /// Returns the errors of [`Self::assemble`].
    pub fn dragged(
        &mut self,
        body: usize,
        to: impl FnOnce(FramePose) -> FramePose,
    ) -> Result<Vec<FramePose>, StudyError> {
        self.scene.start.correction = CorrectionLimit::Any;
        let mut q = self.assemble()?.q;
        let described = frames(&self.scene, &self.mechanism, &q);
        let target = described.get(body).copied().map(to);
        for k in 0..DRAGS {
            let mut poses = frames(&self.scene, &self.mechanism, &q);
            if let (Some(pose), Some(target)) = (poses.get_mut(body), target) {
                *pose = target;
            }
            let poses = poses.into_iter().enumerate();
            let poses = poses.map(|(body, frame)| StartPose { body, frame });
            self.scene.start.poses = poses.collect();
            match self.assemble() {
                Ok(assembly) => q = assembly.q,
                // Near a limit of the motion, the last configuration is the closest that is known.
                Err(_) if k > 0 => break,
                Err(e) => return Err(e),
            }
        }
        Ok(frames(&self.scene, &self.mechanism, &q))
    }

    /// Analyses the start, even if [`AssembledScene::prepare`] rejects the start because the rank
    /// is undecided in `f64` or no motion begins.
    ///
    /// # Errors
    /// Returns the errors of [`AssembledScene::assemble`], also if the given velocities are
    /// impossible, and
    /// [`StudyError::Analysis`]: C cannot be analysed.
    pub fn analyse(
        &mut self,
        drop: Option<&[usize]>,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        self.analyse_with_progress(drop, |_| ())
    }

    /// Works like [`Self::analyse`], and calls `progress` with the number of joints analysed so
    /// far.
    ///
    /// # Errors
    /// Returns the errors of [`AssembledScene::analyse`].
    pub fn analyse_with_progress(
        &mut self,
        drop: Option<&[usize]>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        let asked = drop.map_or(AskedRows::Any, AskedRows::Dropped);
        let mut configuration = self.analyse_position(asked, progress)?;
        let start = &configuration.scene.start;
        let decision = &configuration.analysis.decision;
        if decision.is_decided() {
            let (q, kept) = (&configuration.state.q, &decision.kept);
            let mechanism = configuration.mechanism;
            let rows = solvability::rows(mechanism, mechanism.layout().start_time, q)?;
            configuration.state.v = match start_velocity(mechanism, start, &rows, q, kept) {
                Ok((found, _)) => found.v,
                Err(MotionError::Start(StartError::NoVelocity { .. }))
                    if unmovable(mechanism, &rows, q).is_some() =>
                {
                    Vec::new()
                }
                Err(e) => return Err(refused(configuration.scene, e)),
            };
        }
        Ok(configuration)
    }

    /// Works like [`Self::analyse`], but does not compute velocities, because verdicts do not need
    /// velocities.
    pub(crate) fn analyse_configuration(
        &mut self,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        self.analyse_position(AskedRows::Any, |_| ())
    }

    fn analyse_position(
        &mut self,
        rows: AskedRows<'_>,
        progress: impl Fn(usize) + Sync,
    ) -> Result<ConfigurationAnalysis<'_>, StudyError> {
        let assembly = self.assemble()?;
        let state = State {
            q: assembly.q,
            v: Vec::new(),
        };
        ConfigurationAnalysis::new(
            &self.scene,
            &self.mechanism,
            0.0,
            state,
            ConfigurationAccuracy::AsStored,
            rows,
            progress,
        )
    }
}

/// Number of corrections of a dragged configuration. Each correction sets the dragged body to its
/// target and finds the closest configuration, so that the body approaches its target.
const DRAGS: usize = 4;

/// Returns the frames of all bodies at the coordinates q.
pub(crate) fn frames(scene: &Scene, mechanism: &Mechanism, q: &[f64]) -> Vec<FramePose> {
    let v = vec![0.0; mechanism.layout().n_v];
    let frame = |body: usize| {
        let frame = mechanism.frames().body(body, q, &v);
        let [x, y, _] = frame.place;
        match &scene.description {
            AnyDescription::Plane(_) => FramePose::Plane {
                position: [x, y],
                angle: frame.angle,
            },
            AnyDescription::Space3(_) => FramePose::Space3 {
                position: frame.place,
                orientation: frame.quaternion,
            },
        }
    };
    (0..mechanism.bodies().len()).map(frame).collect()
}

/// Adds the position in the text of the scene to an error, if there is a text.
pub(crate) fn refused(scene: &Scene, error: MotionError) -> StudyError {
    match scene.locate_motion(&error) {
        Some(place) => StudyError::Scene(vec![place]),
        None => error.into(),
    }
}

/// Whether rows contradict each other in accelerations only, and none of these rows is a driven
/// row. In this case, a motion with another velocity is possible.
fn leaves_no_motion(e: &MotionError) -> bool {
    matches!(e, MotionError::Contradiction(c) if c.level == ConstraintLevel::Acceleration && c.drives == 0)
}

/// Returns the options of the scene. Options of the caller take precedence.
pub(crate) fn options(scene: &Scene, overrides: &RunOptions) -> Option<MotionOptions> {
    let mut options = match (&scene.simulate, overrides.t_end) {
        (Some(options), _) => options.clone(),
        (None, Some(t_end)) => MotionOptions::to(t_end),
        (None, None) => return None,
    };
    if let Some(t_end) = overrides.t_end {
        let by_default = |t_end: f64| t_end / MotionOptions::OUTPUT_STEPS;
        let is_default = options.output_step == by_default(options.t_end);
        options.t_end = t_end;
        if is_default {
            options.output_step = by_default(t_end);
        } else if t_end > 0.0 {
            options.output_step = options.output_step.min(t_end);
        }
    }
    options.rtol = overrides.rtol.unwrap_or(options.rtol);
    options.atol = overrides.atol.unwrap_or(options.atol);
    options.max_step = overrides.max_step.unwrap_or(options.max_step);
    options.max_steps = overrides.max_steps.unwrap_or(options.max_steps);
    options.method = overrides.method.unwrap_or(options.method);
    options.stabilisation = overrides.stabilisation.unwrap_or(options.stabilisation);
    options.threads = overrides.threads.or(options.threads);
    if let Some(drop) = &overrides.drop {
        options.rows = RowChoice::Drop(drop.clone());
    }
    Some(options)
}
