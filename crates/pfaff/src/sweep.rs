//! Many runs of one scene with different numbers: in parallel, in parts, and such that an
//! interruption loses no finished run.
//!
//! Each run is read, checked, assembled and moved like any scene. A fault of one combination of
//! numbers is reported in its row; the other runs continue. Only unique reactions have numbers.
//!
//! The meaning of a key is in [`scene::Template`], the format of files in [`report::sweep`].

mod axis;
mod error;
mod run;
mod shard;
#[cfg(test)]
mod tests;

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use model::{Mechanism, Registry, System};
use rayon::prelude::*;
use report::sweep::{Journal, Journals, SweepPlan, digest, write_sweep};
use report::{OutputDirectory, SweepDocument, SweepRow, TrajectoryTable};
use scene::{Template, WantedReactions};

use crate::assembled::AssembledScene;
use crate::error::StudyError;
use axis::Grid;

pub use axis::{Axis, AxisError};
pub use error::SweepError;
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
        })
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
            Ok(begun) => begun.go(&|| false, |_| ControlFlow::Continue(())),
            Err(error) => self.refused(run, &error),
        }
    }

    /// Makes the runs of a shard that are not in a journal of the directory yet, and writes the
    /// tables of all finished runs: `sweep.csv`, `sweep.parquet` and `summary.json`. `progress` is
    /// called with each finished run, in any order; `interrupted` is called often and ends the
    /// sweep without losing a finished run.
    ///
    /// # Errors
    /// - [`SweepError::NoneBegins`]: no run can begin; nothing is written.
    /// - [`SweepError::Journal`]: the directory belongs to another sweep, or another process works
    ///   on this shard.
    /// - [`SweepError::File`], [`SweepError::Table`], [`SweepError::Threads`]: the operating system
    ///   reported an error.
    pub fn run_into(
        &self,
        directory: &Path,
        settings: &SweepSettings,
        interrupted: impl Fn() -> bool + Sync,
        mut progress: impl FnMut(SweepProgress<'_>) + Send,
    ) -> Result<SweepDocument, SweepError> {
        // More threads than runs would be idle.
        let runs = usize::try_from(self.runs()).unwrap_or(usize::MAX);
        let threads = NonZeroUsize::new(settings.threads.min(runs));
        let pool = crate::pool(threads).map_err(SweepError::Threads)?;
        pool.install(|| self.check(&interrupted))?;
        let output = OutputDirectory::create(directory)?.shared()?;
        let journal = Journal::open(directory, &settings.shard.journal(), &self.plan)?;
        let finished = Journals::read(&[directory])?.rows;
        let mine = (1..=self.runs()).filter(|run| settings.shard.has(*run));
        let (before, pending): (Vec<u64>, Vec<u64>) =
            mine.partition(|run| finished.contains_key(run));
        drop(finished);
        progress(SweepProgress::Begin {
            runs: (before.len() + pending.len()) as u64,
            finished: before.len() as u64,
        });
        let ledger = Mutex::new((journal, progress));
        let make = |run: &u64| {
            let keep = self
                .plan
                .keep_rows
                .then(|| folder(directory, *run, self.runs()));
            if let Some(row) = self.whole_row(*run, keep.as_deref(), &interrupted)? {
                // A thread that panicked has written a whole line or none.
                let mut ledger = ledger.lock().unwrap_or_else(PoisonError::into_inner);
                ledger.0.append(&row)?;
                ledger.1(SweepProgress::Finished(&row));
            }
            Ok::<(), SweepError>(())
        };
        pool.install(|| pending.par_iter().with_max_len(1).try_for_each(make))?;
        let (journal, _) = ledger.into_inner().unwrap_or_else(PoisonError::into_inner);
        journal.finish()?;
        write_sweep(&output, || Ok(Journals::read(&[directory])?))
    }

    /// Makes a run, with its trajectory in a directory if one is given. Returns `None` if it was
    /// interrupted.
    fn whole_row(
        &self,
        run: u64,
        keep: Option<&Path>,
        interrupted: &(impl Fn() -> bool + Sync),
    ) -> Result<Option<SweepRow>, SweepError> {
        if interrupted() {
            return Ok(None);
        }
        let begun = match self.begin(run) {
            Ok(begun) => begun,
            Err(error) => return Ok(Some(self.refused(run, &error))),
        };
        if interrupted() {
            return Ok(None);
        }
        let table = |directory: &Path| {
            let file = OutputDirectory::create(directory)?.file("trajectory.csv")?;
            Ok::<_, SweepError>(TrajectoryTable::new(file, &begun.study.prepared.mechanism)?)
        };
        let mut table = keep.map(table).transpose()?;
        let mut unwritten = None;
        let row = begun.go(interrupted, |sample| {
            if let Some(table) = &mut table {
                unwritten = table.row(sample.t, sample.q, sample.v).err();
            }
            if unwritten.is_some() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        if let Some(error) = unwritten {
            return Err(error.into());
        }
        // The run may have ended just before the request; it is made again then.
        if interrupted() {
            return Ok(None);
        }
        if let Some(table) = table {
            // The trajectory is stored on disk before the journal records the run.
            let mut file = table.finish()?;
            file.sync()?;
            file.finish()?;
        }
        Ok(Some(row))
    }

    /// Returns an error if no run can begin. The search ends at the first one that can.
    fn check(&self, interrupted: &(impl Fn() -> bool + Sync)) -> Result<(), SweepError> {
        let begins = |run: &u64| interrupted() || self.begin(*run).is_ok();
        let found = (1..=self.runs()).into_par_iter().find_any(begins);
        match (found, self.begin(1).err()) {
            (None, Some(error)) => Err(SweepError::NoneBegins {
                runs: self.runs(),
                values: self.values(1),
                reason: run::reason(&error),
            }),
            _ => Ok(()),
        }
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

/// Merges the journals of several directories into one set of tables.
///
/// # Errors
/// [`SweepError::Journal`]: they belong to different sweeps; [`SweepError::File`],
/// [`SweepError::Table`]: something could not be written.
pub fn merge<P: AsRef<Path>>(directories: &[P], into: &Path) -> Result<SweepDocument, SweepError> {
    let journals = Journals::read(directories)?;
    write_sweep(&OutputDirectory::create(into)?.shared()?, || Ok(journals))
}

/// Directory of the files of a run; its number has as many digits as that of the last run.
fn folder(directory: &Path, run: u64, runs: u64) -> PathBuf {
    let width = runs.to_string().len();
    directory.join("runs").join(format!("{run:0width$}"))
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
