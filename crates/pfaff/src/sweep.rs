//! Many runs of one scene with different numbers: in parallel, in shards on any number of machines,
//! and such that no end of a process loses a finished run.
//!
//! Each run is read, checked, assembled and moved like any scene. A fault of one combination of
//! numbers is reported in its row; the other runs continue. Only unique reactions have numbers.
//!
//! The meaning of a key is in [`scene::Template`], the format of files in [`report::sweep`].

mod attempt;
mod axis;
mod code;
mod error;
mod gate;
mod lanes;
mod make;
mod run;
mod shard;
#[cfg(test)]
mod tests;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::OnceLock;

use model::{Mechanism, Registry, System};
use report::sweep::{Extent, Records, Shards, SweepPlan, digest, write_sweep};
use report::{OutputDirectory, SweepDocument, SweepRow};
use scene::{Template, WantedReactions};

use crate::assembled::AssembledScene;
use crate::error::StudyError;
use crate::study::Overrides;
use attempt::Attempt;
use axis::Grid;
use code::SweepCode;
use make::Keep;
use run::Described;

pub use axis::{Axis, AxisError};
pub use error::SweepError;
pub use report::sweep::end_attempts;
pub use shard::{Shard, ShardError};

/// A scene and the numbers that are varied in it. Several axes form a full grid, in which the last
/// axis varies fastest.
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
    /// What a one of each axis is in SI, if its values have no unit; otherwise they are in SI.
    scales: Vec<f64>,
    plan: SweepPlan,
    /// Indices of the requested reactions.
    reactions: Vec<usize>,
    registry: &'r Registry,
    /// The text of the scene.
    text: String,
    /// The scene without changes, prepared when the first run begins.
    described: OnceLock<Option<Described>>,
    /// The code of its runs, or why they are interpreted; made when the first run begins.
    code: OnceLock<Result<SweepCode, String>>,
}

/// Settings of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweepSettings {
    /// The runs that are made by this process.
    pub shard: Shard,
    /// Number of threads; 0 means one for each core.
    pub threads: usize,
}

impl Default for SweepSettings {
    fn default() -> Self {
        Self {
            shard: Shard::WHOLE,
            threads: 0,
        }
    }
}

/// Progress of a sweep.
#[derive(Clone, Copy, Debug)]
pub enum SweepProgress<'a> {
    /// It begins.
    Begin {
        /// Number of runs of this shard.
        runs: u64,
        /// Number of runs that were finished before.
        finished: u64,
    },
    /// A run is finished, and its row is in the journal.
    Finished(&'a SweepRow),
}

impl<'r> Sweep<'r> {
    /// Reads a scene and finds the numbers that are varied; `name` is the file name in messages.
    ///
    /// # Errors
    /// - [`SweepError::Study`]: the scene is invalid without changes, or it does not state the end
    ///   of a run.
    /// - [`SweepError::Key`]: a key does not refer to a number of the scene.
    /// - [`SweepError::Axis`]: nothing is varied, or there are too many combinations.
    pub fn read(
        name: &str,
        text: &str,
        registry: &'r Registry,
        axes: Vec<Axis>,
    ) -> Result<Self, SweepError> {
        let assembled = AssembledScene::read(name, text, registry)?;
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
        let plan = SweepPlan {
            scene: assembled.scene.name().to_owned(),
            digest: format!("{:016x}", digest(text.as_bytes())),
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
        };
        let scales = scales(&template, &grid, registry);
        Ok(Self {
            template,
            grid,
            scales,
            plan,
            reactions,
            registry,
            text: text.to_owned(),
            described: OnceLock::new(),
            code: OnceLock::new(),
        })
    }

    /// What evaluates the equations of its runs, in words: code that is generated for all of them
    /// without a compiler, or the interpreter, with the reason.
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
    /// assert!(masses.starts_with("on generated code, 8 runs at once; it takes 2 numbers"), "{masses}");
    /// let few = read("body.bob.mass=1,2").evaluation();
    /// assert!(few.starts_with("interpreted: code is made for 100 runs"), "{few}");
    /// ```
    #[must_use]
    pub fn evaluation(&self) -> String {
        match (self.code(), self.code.get()) {
            (Some(code), _) => code.describe(),
            (None, Some(Err(why))) => format!("interpreted: {why}"),
            (None, _) => "interpreted".to_owned(),
        }
    }

    /// The scene without changes, if it can be analysed.
    fn described(&self) -> Option<&Described> {
        let make = || {
            let name = &self.plan.scene;
            let assembled = AssembledScene::read(name, &self.text, self.registry).ok()?;
            Described::new(assembled.prepare(&Overrides::default()).ok()?)
        };
        self.described.get_or_init(make).as_ref()
    }

    /// The code of the runs, if they are made on code.
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

    /// Number of runs of all shards.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.plan.runs
    }

    /// The varied numbers of a run in SI, whatever the units in which they are written; a parameter
    /// without a unit is a plain number.
    ///
    /// # Panics
    /// If there is no such run; they are counted from 1.
    #[must_use]
    pub fn point(&self, run: u64) -> Vec<f64> {
        let runs = self.runs();
        assert!((1..=runs).contains(&run), "no run {run} of 1 to {runs}");
        // Fits, because the number of runs was a usize.
        let point = self.grid.point((run - 1) as usize).into_iter();
        point
            .zip(&self.scales)
            .map(|(x, scale)| x * scale)
            .collect()
    }

    /// Indices of the requested reactions in the mechanism of a run, which may lack some of them if
    /// it is varied what is active.
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

    /// Makes a run without writing any file.
    ///
    /// # Panics
    /// If there is no such run; they are counted from 1.
    #[must_use]
    pub fn row(&self, run: u64) -> SweepRow {
        match self.begin(run) {
            Ok(begun) => self.row_of(
                run,
                begun.go(None, &|| false, |_| ControlFlow::Continue(())),
            ),
            Err(error) => self.refused(run, &error),
        }
    }

    /// Makes the runs of a shard that nobody has finished, and writes them as one file. If no run
    /// of the sweep is left then, or if the shard is the whole, the tables are written:
    /// `sweep.csv`, `sweep.parquet` and `summary.json`. `progress` is called with each finished
    /// run, in any order; `interrupted` is called often and ends the sweep without losing a
    /// finished run.
    ///
    /// Any number of processes may work in one directory, also on the same shard. A run during
    /// which its process ends is made again, alone; if it ends twice then, the row says so.
    ///
    /// # Errors
    /// - [`SweepError::NoneBegins`]: no run of the sweep can begin; nothing is written.
    /// - [`SweepError::Journal`]: the directory belongs to another sweep.
    /// - [`SweepError::File`], [`SweepError::Table`], [`SweepError::Threads`]: the operating system
    ///   reported an error.
    pub fn run_into(
        &self,
        directory: &Path,
        settings: &SweepSettings,
        interrupted: impl Fn() -> bool + Sync,
        mut progress: impl FnMut(SweepProgress<'_>) + Send,
    ) -> Result<SweepOutcome, SweepError> {
        let is_new = !directory.exists();
        let output = OutputDirectory::create(directory)?.shared()?;
        let shards = Shards::open(directory, &self.plan)?;
        let Some(runs) = settings.shard.runs(self.runs()) else {
            progress(SweepProgress::Begin {
                runs: 0,
                finished: 0,
            });
            let records = Records::none(&self.plan);
            return self.ended(&output, &shards, settings.shard, records);
        };
        let known = shards.read(runs)?;
        let pending = known.missing(runs);
        let left: u64 = pending.iter().map(|runs| runs.count()).sum();
        progress(SweepProgress::Begin {
            runs: runs.count(),
            finished: runs.count() - left,
        });
        if left == 0 && runs.without(&known.sealed).is_empty() {
            shards.tidy(runs)?;
            return self.ended(&output, &shards, settings.shard, known);
        }
        let keep = if self.plan.keep_rows {
            Keep::Trajectories(directory)
        } else {
            Keep::Rows
        };
        let journal = shards.begin(runs)?;
        let attempt = Attempt::new(self, keep, &interrupted, journal, &mut progress);
        attempt.make(&known, &pending, settings.threads)?;
        let refused = !known.has_begun() && !attempt.has_begun() && !interrupted();
        if refused && let Some(error) = attempt.none_begins(runs, &known)? {
            attempt.into_journal().discard()?;
            shards.forget();
            if is_new {
                drop(output);
                // Others may have begun.
                let _ = std::fs::remove_dir(directory);
            }
            return Err(error);
        }
        attempt.into_journal().finish()?;
        let now = shards.read(runs)?;
        if now.missing(runs).is_empty() {
            for hole in runs.without(&now.sealed) {
                shards.seal(hole, &now)?;
            }
            shards.tidy(runs)?;
        }
        self.ended(&output, &shards, settings.shard, now)
    }

    /// Writes the tables, if they are due.
    fn ended(
        &self,
        output: &OutputDirectory,
        shards: &Shards,
        shard: Shard,
        records: Records,
    ) -> Result<SweepOutcome, SweepError> {
        let runs = shard.runs(self.runs());
        if shard.n() == 1 {
            let document = write_all(output, shards, records)?;
            return Ok(SweepOutcome {
                document,
                tables: Tables::Written,
            });
        }
        let document = SweepDocument::new(&records, Extent::Shard(runs));
        drop(records);
        let sealed = shards.sealed()?;
        let all = shards.all();
        let tables = if all.is_some_and(|all| all.without(&sealed).is_empty()) {
            let records = all.map_or_else(|| Ok(Records::none(&self.plan)), |all| shards.read(all));
            write_all(output, shards, records?)?;
            Tables::Written
        } else {
            Tables::NotYet
        };
        Ok(SweepOutcome { document, tables })
    }

    /// The varied keys with their values in a run.
    fn values(&self, run: u64) -> String {
        let axes = self.grid.axes.iter().zip(self.point(run));
        let texts: Vec<String> = axes
            .map(|(axis, x)| format!("{} = {x}", axis.key()))
            .collect();
        texts.join(", ")
    }
}

/// How a sweep, or a shard of it, ended.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepOutcome {
    /// Its runs.
    pub document: SweepDocument,
    /// The tables of all runs.
    pub tables: Tables,
}

/// Whether the tables of all runs have been written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tables {
    /// They have, by this call.
    Written,
    /// Runs of other shards are missing: who makes the last one writes them, or [`merge`].
    NotYet,
}

/// Merges what several directories have into one set of tables.
///
/// # Errors
/// [`SweepError::Journal`]: they belong to different sweeps, or two rows of one run differ;
/// [`SweepError::File`], [`SweepError::Table`]: something could not be written.
pub fn merge<P: AsRef<Path>>(directories: &[P], into: &Path) -> Result<Merged, SweepError> {
    let records = Records::merged(directories)?;
    let output = OutputDirectory::create(into)?.shared()?;
    Ok(Merged {
        document: write_sweep::<SweepError>(&output, &records)?,
        shards: Shard::number(records.plan.runs, &records.sealed),
    })
}

/// What [`merge`] has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// All runs.
    pub document: SweepDocument,
    /// The number of shards in which the runs were made, if the finished ones tell.
    pub shards: Option<u64>,
}

/// Writes the tables. If others have finished shards meanwhile, they may have written tables with
/// more rows before: then once more.
fn write_all(
    output: &OutputDirectory,
    shards: &Shards,
    mut records: Records,
) -> Result<SweepDocument, SweepError> {
    loop {
        let document: SweepDocument = write_sweep::<SweepError>(output, &records)?;
        let Some(all) = shards.all().filter(|_| document.partial) else {
            return Ok(document);
        };
        let again = shards.read(all)?;
        if again.rows.len() <= records.rows.len() {
            return Ok(document);
        }
        records = again;
    }
}

/// What a one of each axis is in SI, by the keys at which the scene reads bare numbers. Scenes of
/// the first run or of the last one can be read, or none is told by them.
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
