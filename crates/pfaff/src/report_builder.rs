//! Builds `report.html` of a run. This module collects data during the motion, and analyses the
//! start afterwards. Data that the scene does not request are not computed. The page shows all
//! available data.

use std::ops::ControlFlow;

use crate::bounds_of_run::FoundBounds;
use crate::contacts;
use crate::documents::MakeUniqueDocument;
use crate::documents::{AnalysisDocument, RunDocument};
use crate::page::{DriveCurve, Origin, RunPage, Shows, WrittenScene, numbers_per_row, run_page};
use dynamics::plan::Rows;
use dynamics::{MotionOptions, Plan, PreparedMechanism, Sample};
use model::{AnyDescription, Mechanism, System};
use rank::Limits;
use report::{Frame, ReactionColumn, Recording};
use scene::Scene;
use solvability::{DeletableRows, Sensitivities, Stretches, Verdict};

use crate::comparison::compare;
use crate::configuration::ConfigurationAnalysis;
use crate::error::StudyError;
use crate::plots::PlotRecorder;
use crate::pulls::{PullTimes, PullWarning};
use crate::questions::analyze::remedies::RemedyDocument;
use crate::rows::{RowFault, RowSink};

/// The page lists deletions that would make non-unique reactions unique. These constants are the
/// number of such reactions, and the number of sets tried for each reaction.
const HINTS: usize = 8;
const HINT_TRIALS: usize = 2_000;

/// Data of a run for its page.
#[derive(Clone, Copy)]
pub(crate) struct OfRun<'a> {
    pub(crate) start: &'a ConfigurationAnalysis<'a>,
    pub(crate) sensitivities: &'a Sensitivities,
    pub(crate) document: &'a RunDocument,
    /// Verdicts of the run; `None` if no reactions were requested.
    pub(crate) stretches: Option<&'a Stretches>,
    /// Bounds of the columns of reactions, if they were requested.
    pub(crate) bounds: Option<(&'a [ReactionColumn], &'a FoundBounds)>,
    pub(crate) remedies: &'a [RemedyDocument],
}

/// Rows of a run that are collected for its page.
pub(crate) struct ReportBuilder<'a> {
    scene: &'a Scene,
    prepared: &'a PreparedMechanism,
    options: &'a MotionOptions,
    recording: Recording,
    /// Whether reactions are collected.
    has_reactions: bool,
    compares: bool,
    /// Whether choices other than the independent rows of the run are requested.
    has_choices: bool,
    ends_only: bool,
    curves: PlotRecorder<'a>,
}

impl RowSink for ReportBuilder<'_> {
    fn row(&mut self, sample: &mut Sample<'_, '_>) -> Result<ControlFlow<()>, RowFault> {
        if !self.recording.wants(sample.t) {
            return Ok(ControlFlow::Continue(()));
        }
        let (mut reactions, mut multipliers) = (Vec::new(), Vec::new());
        let mut chosen = Vec::new();
        if self.has_reactions {
            reactions = sample.reactions()?.as_chosen().to_vec();
        }
        if self.compares && self.has_reactions {
            multipliers = sample.multipliers()?.as_chosen().to_vec();
            if !sample.choices.is_empty() {
                let all = sample.chosen()?.into_iter();
                chosen.extend(all.map(|found| found.multipliers.as_chosen().to_vec()));
            }
        }
        self.curves.row(sample, &reactions)?;
        self.recording.frames.push(Frame {
            t: sample.t,
            q: sample.q.to_vec(),
            v: sample.v.to_vec(),
            work: sample.work,
            reactions,
            multipliers,
            chosen,
        });
        Ok(ControlFlow::Continue(()))
    }
}

impl<'a> ReportBuilder<'a> {
    pub(crate) fn new(
        scene: &'a Scene,
        prepared: &'a PreparedMechanism,
        asked: &'a MotionOptions,
        plan: &Plan<'_>,
    ) -> Result<Self, StudyError> {
        let options = plan.options();
        let mechanism = &prepared.mechanism;
        let rows = match plan.rows.value {
            Rows::Every | Rows::Interpolated => options.t_end / options.output_step + 1.0,
            Rows::Ends => 2.0,
        };
        Ok(Self {
            scene,
            prepared,
            options: asked,
            recording: Recording::new(
                options.t_end,
                rows,
                numbers_per_row(mechanism) + plan.choices.len() * mechanism.layout().rows(),
            ),
            ends_only: plan.rows.value == Rows::Ends,
            has_reactions: scene.output.reactions != scene::WantedReactions::None,
            compares: prepared.decision.redundancy > 0,
            has_choices: !plan.choices.is_empty(),
            curves: PlotRecorder::new(scene, mechanism, &prepared.q)?,
        })
    }

    /// Builds the page.
    pub(crate) fn page(
        &self,
        of_run: &OfRun<'_>,
        origin: &Origin,
        work_precision: Option<&str>,
    ) -> String {
        let mechanism = &self.prepared.mechanism;
        let OfRun {
            start,
            sensitivities,
            document: run,
            stretches,
            bounds,
            remedies,
        } = *of_run;
        let choices = if self.has_choices {
            run.choice.iter().map(ToString::to_string).collect()
        } else {
            let own = run.choice.first();
            vec![own.map_or_else(|| "this run".to_owned(), |own| format!("this run: {own}"))]
        };
        let is_open = |k: usize| {
            let own = run.reactions.0.get(k);
            own.is_some_and(|(_, r)| r.verdict() == "not_unique")
        };
        let (comparisons, mut left_out) = compare(mechanism, &self.recording, is_open, &choices);
        let (mut analysis, hints) = self.analysis(start, remedies);
        analysis.warnings.extend(self.scene.cautions());
        let pulling = PullWarning::new(&run.pulls, PullTimes::Run);
        let pulling = pulling.map(|warning| warning.to_string());
        analysis.warnings.extend(pulling);
        analysis.add_sensitivities(sensitivities, mechanism.layout());
        analysis.add_notes(mechanism.layout());
        if self.ends_only {
            left_out.push(
                "The scene requests neither a trajectory nor reactions. Therefore only the start and the end were computed."
                    .to_owned(),
            );
        }
        let times = self.recording.frames.iter().map(|frame| frame.t);
        let times: Vec<f64> = times.collect();
        let bands = bounds.zip(stretches);
        let bands = bands.map_or_else(Vec::new, |((columns, found), stretches)| {
            found.bands(columns, stretches, &times)
        });
        run_page(&RunPage {
            mechanism,
            analysis: Some(&analysis),
            hints: &hints,
            shows: Shows::Run(run),
            stretches,
            recording: &self.recording,
            comparisons: &comparisons,
            bands: &bands,
            groups: &self.curves.groups(stretches, bounds, &times),
            plots: &self.curves.plots(stretches, &times),
            drives: &self.drives(),
            origin,
            scene: written_scene(self.scene),
            options: &self.options(),
            left_out: &left_out,
            work_precision,
        })
    }

    /// Computes the verdicts at the start with their reasons, and hints.
    fn analysis(
        &self,
        start: &ConfigurationAnalysis<'_>,
        remedies: &[RemedyDocument],
    ) -> (AnalysisDocument, Vec<MakeUniqueDocument>) {
        let mut document = AnalysisDocument::new(self.scene.name(), &start.analysis, None);
        if let Ok(Some(explanation)) = start.explanation() {
            document.explain(&explanation, start.mechanism.layout());
        }
        document.answers.remedies = remedies.to_vec();
        // Contacts whose loads cannot be computed must not prevent the page.
        if let Err(e) = contacts::add(&[], start, &mut document) {
            document.warnings.push(format!("contacts: {e}"));
        }
        let limits = Limits {
            trials: HINT_TRIALS,
            ..Limits::default()
        };
        let open =
            start.analysis.reactions.iter().filter(|r| {
                r.wrench.verdict == Verdict::NotUnique && !document.has_remedy(&r.name)
            });
        let hints = open.take(HINTS).map(|r| {
            let found = start.make_unique(r.id, &DeletableRows::Sensible, limits);
            MakeUniqueDocument::new(&r.name, &DeletableRows::Sensible, found)
        });
        let hints = hints.collect();
        (document, hints)
    }

    /// Returns the values that drives prescribe at the frames.
    fn drives(&self) -> Vec<DriveCurve> {
        let mechanism = &self.prepared.mechanism;
        let forces = mechanism.space().forces();
        let drives = self.scene.description.motions();
        drives
            .map(|drive| {
                let start = drive.of_time.jet(0.0)[0];
                let mut wrench = drive.spec.wrench.iter();
                let pushes = wrench.any(|[component, _]| forces.contains(component));
                DriveCurve {
                    name: drive.name.to_owned(),
                    text: format!(
                        "change since the start, between {}",
                        between(mechanism, drive.bodies)
                    ),
                    unit: if pushes { "m" } else { "rad" },
                    values: self
                        .recording
                        .frames
                        .iter()
                        .map(|f| drive.of_time.jet(f.t)[0] - start)
                        .collect(),
                }
            })
            .collect()
    }

    fn options(&self) -> Vec<(String, String)> {
        let o = self.options;
        let rows: Vec<String> = self
            .prepared
            .decision
            .dropped
            .iter()
            .map(|i| (i + 1).to_string())
            .collect();
        let mut options = vec![
            (
                "End time",
                format!("{} s, a row every {} s", o.t_end, o.output_step),
            ),
            (
                "Tolerances",
                format!("{:e} relative, {:e} absolute", o.rtol, o.atol),
            ),
            (
                "Requested",
                format!(
                    "{}, {}, {}",
                    o.method.name(),
                    dynamics::FORMULATION,
                    o.stabilisation.name()
                ),
            ),
        ];
        if !rows.is_empty() && rows.len() <= 40 {
            options.push(("Dependent rows", rows.join(", ")));
        }
        options
            .into_iter()
            .map(|(what, value)| (what.to_owned(), value))
            .collect()
    }
}

/// Information about the text of a scene for the page.
#[must_use]
pub fn written_scene(scene: &Scene) -> WrittenScene<'_> {
    WrittenScene {
        text: scene.text(),
        inactive: scene.inactive.iter().map(ToString::to_string).collect(),
        units: scene.units.printed(),
        gravity: match &scene.description {
            AnyDescription::Plane(d) => d.gravity.to_vec(),
            AnyDescription::Space3(d) => d.gravity.to_vec(),
        },
        cover: scene.output.cover.clone(),
        print: scene.output.print,
    }
}

fn between(mechanism: &Mechanism, bodies: &[model::BodyRef]) -> String {
    let names = bodies.iter().map(|b| {
        b.moving()
            .map_or("ground", |k| mechanism.bodies()[k].name.as_str())
    });
    let names: Vec<&str> = names.collect();
    names.join(" and ")
}
