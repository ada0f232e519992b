//! The runs of a sweep: the scene of each run, and its row.

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use dynamics::PreparedMechanism;
use model::{Mechanism, Registry, System, Tolerance};
use report::sweep::{SweepPlan, digest};
use report::{SweepRow, SweepStatus};
use scene::{Template, WantedReactions};
use solvability::analyse;
use solvability::analysis::analyse_decided;

use super::SweepError;
use super::axis::{Axis, Grid};
use super::code::SweepCode;
use super::run::{MadeRun, PreparedRun, UnvariedScene};
use crate::assembled::AssembledScene;
use crate::configuration::requests;
use crate::error::StudyError;
use crate::run_options::RunOptions;

/// A scene and its varied numbers. Several axes form a full grid. The last axis varies fastest.
///
/// ```
/// use pfaff::model::Registry;
/// use pfaff::sweep::Sweep;
///
/// // A stone falls for one second on the Moon and on Earth.
/// let scene = r#"
/// scene = { name = "stone", space = "plane", gravity = [0.0, -1.0] }
/// body = [{ name = "stone", mass = 1.0, inertia = 1.0, position = [0.0, 10.0] }]
/// simulate = { t_end = 1.0 }
/// "#;
/// let axes = vec!["scene.gravity[1]=-1.62,-9.81".parse()?];
/// let registry = Registry::standard();
/// let sweep = Sweep::read("stone.toml", scene, &registry, axes)?;
/// let heights: Vec<f64> = (1..=sweep.runs())
///     .filter_map(|run| sweep.row(run).motion)
///     .map(|motion| motion.state[1])
///     .collect();
/// assert!((heights[0] - (10.0 - 0.81)).abs() < 1e-9);
/// assert!((heights[1] - (10.0 - 4.905)).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Sweep<'r> {
    template: Template,
    grid: Grid,
    /// Value of one unit of each axis in SI, if the values of the axis have no unit. Values with a
    /// unit are already in SI.
    scales: Vec<f64>,
    pub(super) plan: SweepPlan,
    /// Indices of the requested reactions.
    reactions: Vec<usize>,
    registry: &'r Registry,
    /// Tolerance that takes precedence over the tolerance that the scene states.
    tolerance: Tolerance,
    /// The text of the scene.
    text: String,
    /// The scene without changes, prepared when the first run begins.
    pub(super) described: OnceLock<Option<UnvariedScene>>,
    /// The generated code of the runs, or the reason why the runs are interpreted. It is created
    /// when the first run begins.
    pub(super) code: OnceLock<Result<SweepCode, String>>,
}

impl<'r> Sweep<'r> {
    /// Reads a scene and finds the varied numbers. `name` is the file name in messages.
    ///
    /// # Errors
    /// - [`SweepError::Study`]: the scene is invalid without changes, or it does not state the end
    ///   of a run.
    /// - [`SweepError::Key`]: a key does not refer to a number of the scene.
    /// - [`SweepError::Axis`]: no number is varied, or there are too many combinations.
    pub fn read(
        name: &str,
        text: &str,
        registry: &'r Registry,
        axes: Vec<Axis>,
    ) -> Result<Self, SweepError> {
        let assembled = AssembledScene::read(name, text, registry)?;
        Self::of(&assembled, text, (registry, Tolerance::default()), axes)
    }

    /// Works like [`Self::read`], for a scene that has been read, with this accuracy of the data.
    ///
    /// # Errors
    /// Returns the errors of [`Self::read`].
    pub(crate) fn of(
        assembled: &AssembledScene,
        text: &str,
        (registry, tolerance): (&'r Registry, Tolerance),
        axes: Vec<Axis>,
    ) -> Result<Self, SweepError> {
        if assembled.scene.simulate.is_none() {
            return Err(StudyError::NoEnd.into());
        }
        let grid = Grid::new(axes)?;
        let keys: Vec<&str> = grid.axes.iter().map(Axis::key).collect();
        let template = Template::new(text, &keys)?;
        let groups = &assembled.mechanism.layout().groups;
        let is_wanted = |name: &String| match &assembled.scene.output.reactions {
            WantedReactions::All => true,
            WantedReactions::Of(names) => names.contains(name),
            WantedReactions::None => false,
        };
        let reactions: Vec<usize> = (0..groups.len())
            .filter(|k| is_wanted(&groups[*k].name))
            .collect();
        let bounds = requests::bounds(&assembled.scene, &assembled.mechanism)?.is_some();
        if bounds && reactions.is_empty() {
            return Err(StudyError::NoReactions.into());
        }
        let plan = SweepPlan {
            scene: assembled.scene.name().to_owned(),
            digest: format!("{:016x}", digest(known_text(text, tolerance).as_bytes())),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            vary: grid.axes.iter().map(Axis::to_string).collect(),
            runs: grid.len as u64,
            keep_rows: false,
            keys: keys.into_iter().map(str::to_owned).collect(),
            bodies: assembled
                .mechanism
                .bodies()
                .iter()
                .map(|b| b.name.clone())
                .collect(),
            state: assembled
                .mechanism
                .space()
                .columns()
                .iter()
                .map(|name| (*name).to_owned())
                .collect(),
            reactions: reactions.iter().map(|k| groups[*k].name.clone()).collect(),
            bounds,
        };
        let scales = scales(&template, &grid, registry);
        Ok(Self {
            template,
            grid,
            scales,
            plan,
            reactions,
            registry,
            tolerance,
            text: text.to_owned(),
            described: OnceLock::new(),
            code: OnceLock::new(),
        })
    }

    /// Describes, as text, how the equations of the runs are evaluated: by code that is generated
    /// for all runs without a compiler, or by the interpreter. If the interpreter evaluates the
    /// runs, the text contains the reason.
    ///
    /// ```
    /// use pfaff::model::Registry;
    /// use pfaff::sweep::Sweep;
    ///
    /// let scene = r#"
    /// scene = { name = "pendulum", space = "plane", gravity = [0.0, -9.81] }
    /// body = [{ name = "bob", mass = 1.0, inertia = 0.1, position = [0.5, 0.0] }]
    /// joint = [{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], at = [0.0, 0.0] }]
    /// simulate = { t_end = 1.0 }
    /// "#;
    /// let registry = Registry::standard();
    /// let read = |axis: &str| {
    ///     let axes = vec![axis.parse().unwrap()];
    ///     Sweep::read("pendulum.toml", scene, &registry, axes).unwrap()
    /// };
    /// let masses = read("body.bob.mass=1:2:100").evaluation();
    /// assert!(masses.starts_with("generated code, 8 runs at the same time; its inputs are 2 numbers"), "{masses}");
    /// let few = read("body.bob.mass=1,2").evaluation();
    /// assert!(few.starts_with("interpreted: code is generated for at least 100 runs"), "{few}");
    /// ```
    #[must_use]
    pub fn evaluation(&self) -> String {
        match (self.code(), self.code.get()) {
            (Some(code), _) => code.describe(),
            (None, Some(Err(why))) => format!("interpreted: {why}"),
            (None, _) => "interpreted".to_owned(),
        }
    }

    fn assembled(&self, text: &str) -> Result<AssembledScene, StudyError> {
        AssembledScene::read(&self.plan.scene, text, self.registry)?.stating(self.tolerance)
    }

    /// Returns the scene without changes, if it can be analysed.
    pub(super) fn described(&self) -> Option<&UnvariedScene> {
        let make = || {
            let assembled = self.assembled(&self.text).ok()?;
            UnvariedScene::new(assembled.prepare(&RunOptions::default()).ok()?)
        };
        self.described.get_or_init(make).as_ref()
    }

    /// Returns the code of the runs, if they use generated code.
    fn code(&self) -> Option<&SweepCode> {
        let text = (self.plan.scene.as_str(), self.text.as_str());
        let runs = (self.plan.keys.as_slice(), self.plan.runs);
        let make = || SweepCode::new(text, self.registry, self.described(), runs);
        self.code.get_or_init(make).as_ref().ok()
    }

    /// Also writes the trajectory of each run to `runs/<number>/trajectory.csv`.
    #[must_use]
    pub fn keeping_rows(mut self) -> Self {
        self.plan.keep_rows = true;
        self
    }

    /// Returns the number of runs of all shards.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.plan.runs
    }

    /// Returns the varied numbers of a run in SI. The units in which the numbers are written have
    /// no effect. A parameter without a unit is a plain number.
    ///
    /// # Panics
    /// Panics if the run does not exist. Runs are counted from 1.
    #[must_use]
    pub fn point(&self, run: u64) -> Vec<f64> {
        let runs = self.runs();
        assert!(
            (1..=runs).contains(&run),
            "run {run} does not exist: runs are 1 to {runs}"
        );
        // The conversion is safe, because the number of runs was a usize.
        let point = self.grid.point((run - 1) as usize).into_iter();
        point
            .zip(&self.scales)
            .map(|(x, scale)| x * scale)
            .collect()
    }

    /// Returns the indices of the requested reactions in the mechanism of a run. Some reactions may
    /// be missing if the sweep varies which joints are active.
    fn places(&self, mechanism: &Mechanism) -> Vec<Option<usize>> {
        let groups = &mechanism.layout().groups;
        let place = |(&k, name): (&usize, &String)| match groups.get(k) {
            Some(group) if group.name == *name => Some(k),
            _ => groups.iter().position(|group| group.name == *name),
        };
        self.reactions
            .iter()
            .zip(&self.plan.reactions)
            .map(place)
            .collect()
    }

    /// Performs a run without writing any file.
    ///
    /// # Panics
    /// Panics if the run does not exist. Runs are counted from 1.
    #[must_use]
    pub fn row(&self, run: u64) -> SweepRow {
        match self.begin(run) {
            Ok(begun) => self.row_of(
                run,
                begun.go(None, &|| false, |_| Ok(ControlFlow::Continue(()))),
            ),
            Err(error) => self.refused(run, &error),
        }
    }

    /// Returns the varied keys with their values in a run.
    pub(super) fn values(&self, run: u64) -> String {
        let axes = self.grid.axes.iter().zip(self.point(run));
        let texts: Vec<String> = axes
            .map(|(axis, x)| format!("{} = {x}", axis.key()))
            .collect();
        texts.join(", ")
    }

    /// Assembles a run (counted from 1).
    pub(super) fn begin(&self, run: u64) -> Result<PreparedRun, StudyError> {
        let written = self.grid.written((run - 1) as usize);
        let written: Vec<&str> = written.iter().map(String::as_str).collect();
        let text = self.template.with_expressions(&written);
        let assembled = self.assembled(&text)?;
        let described = self.described();
        let other = described.map(UnvariedScene::prepared);
        let mut study = assembled.prepare_after(&RunOptions::default(), other)?;
        let options = study.options.clone().ok_or(StudyError::NoEnd)?;
        options.check()?;
        study.bounds = study.wanted_bounds()?;
        let PreparedMechanism {
            mechanism,
            q,
            v,
            decided,
            ..
        } = &study.prepared;
        let known = described.filter(|described| described.decides(&study.prepared));
        let t = mechanism.layout().start_time;
        let analysis = match (known, decided) {
            (Some(known), _) => Arc::clone(&known.analysis),
            (None, Some(decided)) => Arc::new(analyse_decided(mechanism, t, q, decided, |_| ())?),
            (None, None) => Arc::new(analyse(mechanism, t, q)?),
        };
        let fragile = analysis.sensitivities(mechanism, q, v)?.fragile().count() as u64;
        let reactions = self.places(mechanism);
        let code = self
            .code()
            .and_then(|code| code.of_run(&mut study, described, &options));
        Ok(PreparedRun {
            study,
            options,
            analysis,
            fragile,
            reactions,
            code,
        })
    }

    /// Returns the row of a run that has begun.
    pub(super) fn row_of(&self, run: u64, MadeRun { motion, error, .. }: MadeRun) -> SweepRow {
        match error {
            // The run has no state.
            Some(error) if motion.t_state.is_nan() => self.refused(run, &error),
            error => SweepRow {
                run,
                varied: self.point(run),
                status: match &error {
                    Some(error) if error.is_opening() => SweepStatus::Opened,
                    Some(_) => SweepStatus::Stopped,
                    None => SweepStatus::Done,
                },
                error: error.as_ref().map_or(String::new(), reason),
                motion: Some(motion),
            },
        }
    }

    /// Returns the row of a run that cannot begin.
    pub(super) fn refused(&self, run: u64, error: &StudyError) -> SweepRow {
        SweepRow {
            run,
            varied: self.point(run),
            status: SweepStatus::Refused,
            error: reason(error),
            motion: None,
        }
    }

    /// Returns the row of a run that has ended its process twice.
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

/// Message for a run that has ended its process.
const CRASHED: &str = "the process ended twice while it performed only this run";

/// Returns an error as text, without the name and the lines of a text that the user has not
/// written.
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

/// Returns the value of one unit of each axis in SI, for keys at which the scene reads numbers
/// without units. The function reads the scene of the first run or of the last run. If neither
/// scene can be read, no run of the sweep uses the result.
fn scales(template: &Template, grid: &Grid, registry: &Registry) -> Vec<f64> {
    let read = |run: usize| {
        let written = grid.written(run);
        let written: Vec<&str> = written.iter().map(String::as_str).collect();
        let (text, places) = template.placed(&written);
        let scene = scene::read("", &text, registry).ok()?;
        let scale = |(place, axis): (&usize, &Axis)| {
            let here = scene.scales.iter().find(|(at, _)| at == place);
            here.filter(|_| axis.is_bare())
                .map_or(1.0, |(_, scale)| *scale)
        };
        Some(places.iter().zip(&grid.axes).map(scale).collect())
    };
    let told = read(0).or_else(|| read(grid.len - 1));
    told.unwrap_or_else(|| vec![1.0; grid.axes.len()])
}

/// Combines a text with the accuracy of its numbers, if the caller states an accuracy. Sweeps with
/// different texts or accuracies are different sweeps.
fn known_text(text: &str, tolerance: Tolerance) -> String {
    if tolerance == Tolerance::default() {
        return text.to_owned();
    }
    let Tolerance { length, angle } = tolerance;
    format!("{text}\n{length:?} {angle:?}")
}
