//! A scene from its text to its results: read, assemble, decide, move, write. What the commands do, without their
//! printing.

use std::ops::ControlFlow;

use dynamics::{
    Failure, Method, MotionError, MotionOptions, Prepared, RowChoice, Sample, Summary, Trip,
    prepare, simulate,
};
use model::{ConstraintId, Mechanism, Registry, System};
use report::{
    Ending, FileError, OutputDirectory, ReactionTable, Run, RunDocument, Selection, TableError,
    TrajectoryTable, write_json,
};
use scene::{
    Combination, CombinationError, Diagnostic, GroupContent, Scene, WantedReactions, WrenchTerm,
};
use solvability::{
    Analysis, AnalysisError, Group, Judgement, RequestError, Term, analyse, analyse_dropping,
    is_permanent, judge_groups,
};

/// A scene that has been assembled and can move.
pub struct Study {
    /// What was read.
    pub scene: Scene,
    /// Start and kept rows.
    pub prepared: Prepared,
    /// What a run is asked to do; nothing where neither the scene nor the caller says how long it takes.
    pub options: Option<MotionOptions>,
}

/// What an analysis found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Ranks, verdicts and dependencies.
    pub analysis: Analysis,
    /// Whether the redundancy is the same at other configurations; nothing if that could not be told.
    pub permanent: Option<bool>,
    /// Verdicts of groups and combinations, by name.
    pub groups: Vec<(String, Judgement)>,
}

/// What the caller wants otherwise than the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Last time (s).
    pub t_end: Option<f64>,
    /// Relative tolerance.
    pub rtol: Option<f64>,
    /// Absolute tolerance.
    pub atol: Option<f64>,
    /// Integrator.
    pub method: Option<Method>,
    /// Rows to drop, from 0.
    pub drop: Option<Vec<usize>>,
}

/// Why there are no results, or only a part of them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The scene is wrong, with all places.
    #[error("{} problem(s) in the scene, the first: {}", .0.len(), .0.first().map_or(String::new(), ToString::to_string))]
    Scene(Vec<Diagnostic>),
    /// Nobody says how long the run takes.
    #[error("the scene has no `[simulate]` with `t_end`, and no last time was given")]
    NoEnd,
    /// A combination that cannot be read.
    #[error("`{text}`: {error}")]
    Combination {
        /// The combination.
        text: String,
        /// What is wrong.
        error: CombinationError,
    },
    /// A group names a joint or drive that the mechanism does not have.
    #[error("there is no joint or drive `{name}`")]
    UnknownReaction {
        /// The name.
        name: String,
    },
    /// A group cannot be judged.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// A motion could not begin or go on.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A configuration could not be judged.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table could not be written.
    #[error(transparent)]
    Table(#[from] TableError),
}

impl StudyError {
    /// Whether the input is wrong; otherwise the computation stopped.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Scene(_)
            | Self::NoEnd
            | Self::Combination { .. }
            | Self::UnknownReaction { .. }
            | Self::Request(_) => true,
            Self::Motion(e) => matches!(
                e,
                MotionError::Start(_)
                    | MotionError::Contradiction(_)
                    | MotionError::Rows(_)
                    | MotionError::Option { .. }
            ),
            Self::Analysis(e) => matches!(e, AnalysisError::Rows { .. }),
            Self::File(_) | Self::Table(_) => false,
        }
    }
}

impl Study {
    /// Reads a scene, finds its consistent start and chooses rows. `name` is the file's name in messages.
    ///
    /// # Errors
    /// - [`StudyError::Scene`]: everything that is wrong with the text, the start included.
    /// - [`StudyError::Motion`]: the start exists, but no rows can be chosen.
    pub fn read(
        name: &str,
        text: &str,
        registry: &Registry,
        overrides: &Overrides,
    ) -> Result<Self, StudyError> {
        let scene = scene::read(name, text, registry).map_err(StudyError::Scene)?;
        let options = options(&scene, overrides);
        let rows = match (&overrides.drop, &options) {
            (Some(drop), _) => RowChoice::Drop(drop.clone()),
            (None, Some(options)) => options.rows.clone(),
            (None, None) => RowChoice::Automatic,
        };
        let mechanism = Mechanism::build(&scene.description)
            .map_err(|e| StudyError::Scene(e.iter().map(|e| scene.locate_build(e)).collect()))?;
        let prepared = match prepare(mechanism, &scene.start, &rows) {
            Ok(prepared) => prepared,
            // Faults of the text have a place in it; rows may come from the caller.
            Err(e @ (MotionError::Start(_) | MotionError::Contradiction(_))) => {
                return Err(StudyError::Scene(vec![scene.locate_motion(&e)]));
            }
            Err(e) => return Err(e.into()),
        };
        Ok(Self {
            scene,
            prepared,
            options,
        })
    }

    /// Verdicts at a time of the motion; at t = 0 nothing has to move. Groups are those of the scene, then `combine`: sums of
    /// components as `W3.N + W4.N`, or of whole wrenches as `W3 + W4`.
    ///
    /// # Errors
    /// If the motion does not reach that time, C cannot be judged there, or a combination names something unknown.
    pub fn analyse_at(
        &self,
        t: f64,
        drop: Option<&[usize]>,
        combine: &[String],
    ) -> Result<Findings, StudyError> {
        let requests = self.requests(combine)?;
        let q = if t == 0.0 {
            self.prepared.q.clone()
        } else {
            self.configuration_at(t)?
        };
        let mechanism = &self.prepared.mechanism;
        let analysis = match drop {
            Some(rows) => analyse_dropping(mechanism, t, &q, rows)?,
            None => analyse(mechanism, t, &q)?,
        };
        let (names, groups): (Vec<String>, Vec<Group>) = requests.into_iter().unzip();
        let judged = judge_groups(mechanism, t, &q, &analysis.decision, &groups)?;
        let judgements = judged.into_iter().map(|verdict| verdict.judgement);
        let groups = names.into_iter().zip(judgements).collect();
        let permanent = is_permanent(mechanism, t, &q, &analysis.decision);
        Ok(Findings {
            analysis,
            permanent,
            groups,
        })
    }

    /// Groups by name: those of the scene, then the combinations asked for.
    fn requests(&self, combine: &[String]) -> Result<Vec<(String, Group)>, StudyError> {
        let mut requests = Vec::new();
        for group in &self.scene.groups {
            let content = match &group.content {
                GroupContent::Members(names) => Group::Members(
                    names
                        .iter()
                        .map(|n| self.constraint(n))
                        .collect::<Result<_, _>>()?,
                ),
                GroupContent::Combination(combination) => self.combination(combination)?,
            };
            requests.push((group.name.clone(), content));
        }
        for text in combine {
            let read = self.scene.combination(text);
            let combination = read.map_err(|error| StudyError::Combination {
                text: text.clone(),
                error,
            })?;
            requests.push((text.clone(), self.combination(&combination)?));
        }
        Ok(requests)
    }

    fn combination(&self, combination: &Combination) -> Result<Group, StudyError> {
        match combination {
            Combination::Components(terms) => {
                let term = |term: &scene::Term| {
                    Ok(Term {
                        reaction: self.constraint(&term.reaction)?,
                        component: term.component.clone(),
                        coefficient: term.coefficient,
                    })
                };
                let terms: Result<_, StudyError> = terms.iter().map(term).collect();
                Ok(Group::Combination(terms?))
            }
            Combination::Wrenches(terms) => {
                let term =
                    |term: &WrenchTerm| Ok((term.coefficient, self.constraint(&term.reaction)?));
                let terms: Result<_, StudyError> = terms.iter().map(term).collect();
                Ok(Group::WrenchSum(terms?))
            }
        }
    }

    fn constraint(&self, name: &str) -> Result<ConstraintId, StudyError> {
        let groups = &self.prepared.mechanism.layout().groups;
        let place = groups.iter().position(|g| g.name == name);
        place
            .map(ConstraintId)
            .ok_or_else(|| StudyError::UnknownReaction {
                name: name.to_owned(),
            })
    }

    fn configuration_at(&self, t: f64) -> Result<Vec<f64>, StudyError> {
        let base = self.options.clone().unwrap_or_else(|| MotionOptions::to(t));
        let options = MotionOptions {
            t_end: t,
            output_step: t,
            ..base
        };
        let mut q = Vec::new();
        self.run(&options, |sample| {
            q = sample.q.to_vec();
            Ok(ControlFlow::Continue(()))
        })
        .map_err(|f| f.error)?;
        Ok(q)
    }

    /// Runs the scene and shows projected rows of output; see [`dynamics::simulate()`].
    ///
    /// # Errors
    /// With what was reached.
    pub fn run(
        &self,
        options: &MotionOptions,
        row: impl FnMut(&mut Sample<'_, '_>) -> Result<ControlFlow<()>, Trip>,
    ) -> Result<Summary, Box<Failure>> {
        simulate(&self.prepared, options, row)
    }

    /// Runs the scene and writes `trajectory.csv`, `reactions.csv` and `summary.json` into a directory, each if the scene
    /// wants it. `progress` sees the time of each row and may stop the run. What a stopped run has written stays, and
    /// its summary says `partial`.
    ///
    /// # Errors
    /// - [`StudyError::NoEnd`]: nobody says how long the run takes.
    /// - [`StudyError::Motion`]: the run stopped; everything before is written.
    /// - [`StudyError::File`], [`StudyError::Table`]: something could not be written.
    pub fn simulate_into(
        &self,
        directory: &OutputDirectory,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<RunDocument, StudyError> {
        let options = self.options.as_ref().ok_or(StudyError::NoEnd)?;
        // Before anything of an earlier run is touched.
        options.check()?;
        let mechanism = &self.prepared.mechanism;
        let output = &self.scene.output;
        let analysis = analyse(mechanism, 0.0, &self.prepared.q)?;
        let mut trajectory = match output.trajectory {
            true => Some(TrajectoryTable::new(
                directory.file("trajectory.csv")?,
                mechanism,
            )?),
            false => None,
        };
        let mut reactions = match selection(&output.reactions) {
            Some(selection) => Some(ReactionTable::new(
                directory.file("reactions.csv")?,
                mechanism,
                &selection,
            )?),
            None => None,
        };
        let (mut unwritten, mut interrupted) = (None, false);
        let outcome = self.run(options, |sample| {
            let written = write_row(sample, trajectory.as_mut(), reactions.as_mut())?;
            interrupted = progress(sample.t).is_break();
            unwritten = written.err();
            Ok(match interrupted || unwritten.is_some() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            })
        });
        let (summary, error) = match outcome {
            Ok(summary) => (summary, None),
            Err(failure) => (failure.summary, Some(failure.error)),
        };
        let ending = match (&error, interrupted) {
            (Some(error), _) => Ending::Stopped(error),
            (None, true) => Ending::Interrupted,
            (None, false) => Ending::Complete,
        };
        let run = Run {
            prepared: &self.prepared,
            options,
            analysis: &analysis,
            summary: &summary,
            ending,
        };
        let document = RunDocument::new(&run);
        let whole = matches!(ending, Ending::Complete) && unwritten.is_none();
        for file in [
            trajectory.map(TrajectoryTable::finish),
            reactions.map(ReactionTable::finish),
        ] {
            match file {
                Some(file) if whole => drop(file?.finish()?),
                Some(file) => drop(file?.finish_partial()?),
                None => {}
            }
        }
        let mut text = Vec::new();
        write_json(&mut text, &document).map_err(|source| TableError::Write {
            table: "summary.json",
            source,
        })?;
        directory.write("summary.json", &text)?;
        match (unwritten, error) {
            (Some(e), _) => Err(e.into()),
            (None, Some(e)) => Err(e.into()),
            (None, None) => Ok(document),
        }
    }
}

fn write_row(
    sample: &mut Sample<'_, '_>,
    trajectory: Option<&mut TrajectoryTable<report::OutputFile>>,
    reactions: Option<&mut ReactionTable<report::OutputFile>>,
) -> Result<Result<(), TableError>, Trip> {
    if let Some(table) = trajectory
        && let Err(e) = table.row(sample.t, sample.q, sample.v)
    {
        return Ok(Err(e));
    }
    match reactions {
        Some(table) => Ok(table.row(sample.t, &sample.reactions()?)),
        None => Ok(Ok(())),
    }
}

/// Which reactions a table has; nothing where no table is wanted.
fn selection(wanted: &WantedReactions) -> Option<Selection> {
    match wanted {
        WantedReactions::All => Some(Selection::All),
        WantedReactions::Of(names) => Some(Selection::Names(names.clone())),
        WantedReactions::None => None,
    }
}

/// The scene's wishes with those of the caller on top.
fn options(scene: &Scene, overrides: &Overrides) -> Option<MotionOptions> {
    let mut options = match (&scene.simulate, overrides.t_end) {
        (Some(options), _) => options.clone(),
        (None, Some(t_end)) => MotionOptions::to(t_end),
        (None, None) => return None,
    };
    if let Some(t_end) = overrides.t_end {
        options.t_end = t_end;
        options.output_step = options.output_step.min(if t_end > 0.0 {
            t_end
        } else {
            options.output_step
        });
    }
    options.rtol = overrides.rtol.unwrap_or(options.rtol);
    options.atol = overrides.atol.unwrap_or(options.atol);
    options.method = overrides.method.unwrap_or(options.method);
    if let Some(drop) = &overrides.drop {
        options.rows = RowChoice::Drop(drop.clone());
    }
    Some(options)
}
