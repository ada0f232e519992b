//! `pfaff check`: reads and assembles a scene and reports all errors.

use pfaff::model::{Layout, Mechanism, System};
use pfaff::report::documents::{
    CheckDocument, DataDocument, FreedomsDocument, SensitivityDocument,
};
use pfaff::scene::{Diagnostic, Scene};
use pfaff::{ConfigurationAnalysis, Overrides, StudyError};

use crate::args::Check;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Outcome, count, wrapped};
use crate::resources::Resources;
use crate::watch;

pub(crate) fn run(arguments: &Check, console: &Console<'_>) -> Outcome {
    if arguments.watch {
        return watch::run(arguments, console);
    }
    Interrupt::ends_at_once()?;
    arguments.resources.apply(console);
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let checked = Checked::of(&source, arguments.resources)?;
    if arguments.json {
        console.document(&checked.document())
    } else {
        console.print(&checked.describe())
    }
}

/// Number of fragile reactions that have a warning each.
const FRAGILE_TOLD: usize = 10;

/// A scene that has been read and assembled.
pub(crate) struct Checked {
    scene: String,
    bodies: usize,
    layout: Layout,
    /// Largest change of a coordinate.
    position: f64,
    /// Largest change of a velocity; `None` if no motion begins.
    velocity: Option<f64>,
    /// Entries of the text that are probably mistakes, with their places.
    problems: Vec<Diagnostic>,
    /// The same as sentences, then the reason why the mechanism cannot be moved, if that is the
    /// only fault, and what the start shows.
    warnings: Vec<String>,
    /// The freedoms; `None` if the rank was not computed because the mechanism is large.
    freedoms: Option<Freedoms>,
    /// What is not active.
    inactive: Vec<String>,
}

/// Mobility, with the drives and without them.
struct Freedoms {
    mobility: usize,
    document: FreedomsDocument,
}

impl Freedoms {
    fn of(configuration: &ConfigurationAnalysis<'_>) -> Result<Self, StudyError> {
        let freedoms = configuration.freedoms()?;
        Ok(Self {
            mobility: freedoms.mobility,
            document: FreedomsDocument::new(&freedoms, configuration.mechanism),
        })
    }
}

/// Sentences on fragile reactions, then on fragile sums.
fn fragile(start: &ConfigurationAnalysis<'_>) -> Result<Vec<String>, StudyError> {
    let layout = start.mechanism.layout();
    let reactions = start.sensitivities()?;
    let mut sentences = reactions.sentences(layout);
    for (name, found) in start.group_sensitivities(&reactions)? {
        // Separate reactions have their own sentences.
        if !found.numbers.is_empty() {
            sentences.extend(SensitivityDocument::of_group(&found, &name, layout).hangs_on);
        }
    }
    Ok(sentences)
}

impl Checked {
    /// Reads and assembles the scene. A scene that only `analyze` can process is not an error here.
    pub(crate) fn of(source: &Source, resources: Resources) -> Result<Self, Failure> {
        let new = |scene: &Scene, mechanism: &Mechanism, correction: &[f64]| Self {
            scene: scene.name().to_owned(),
            bodies: mechanism.bodies().len(),
            layout: mechanism.layout().clone(),
            position: largest(correction),
            velocity: None,
            problems: scene.warnings.clone(),
            warnings: scene.cautions().collect(),
            freedoms: None,
            inactive: scene.inactive.iter().map(ToString::to_string).collect(),
        };
        let assembled = resources.assembled(source)?;
        match source.prepare(assembled, &Overrides::default()) {
            Ok(study) => {
                study.check_drives().map_err(|e| source.failure(e))?;
                let failure = |e| source.failure(e);
                let start = study.analyse(0.0, None).map_err(failure)?;
                let freedoms = Freedoms::of(&start).map_err(failure)?;
                let hanging = fragile(&start).map_err(failure)?;
                let p = &study.prepared;
                let mut checked = new(&study.scene, &p.mechanism, &p.assembly.correction);
                let more = hanging.len().saturating_sub(FRAGILE_TOLD);
                checked
                    .warnings
                    .extend(hanging.into_iter().take(FRAGILE_TOLD));
                let data = DataDocument::new(&start.analysis);
                checked
                    .warnings
                    .extend(data.warning(start.analysis.mobility()));
                checked.warnings.extend(study.cannot_begin());
                if more > 0 {
                    checked.warnings.push(
                        "more reactions are unique but fragile: `pfaff analyze` names all"
                            .to_owned(),
                    );
                }
                Ok(Self {
                    velocity: Some(largest(&p.velocity_correction)),
                    freedoms: Some(freedoms),
                    ..checked
                })
            }
            Err(e) => {
                let Some(warning) = e.only_motion() else {
                    return Err(source.failure(e));
                };
                // The error concerns the motion only, so the start can still be analysed.
                let mut assembled = resources.assembled(source)?;
                let start = assembled.analyse(None).map_err(|e| source.failure(e))?;
                let (described, _) = start.mechanism.described_state();
                let correction = start.mechanism.difference_of(&start.state.q, &described);
                let mut checked = new(start.scene, start.mechanism, &correction);
                checked.warnings.push(warning);
                Ok(checked)
            }
        }
    }

    fn document(&self) -> CheckDocument<'_, Diagnostic> {
        let freedoms = self.freedoms.as_ref();
        CheckDocument {
            ok: true,
            scene: &self.scene,
            bodies: self.bodies,
            coordinates: self.layout.n_q - self.layout.turns,
            velocities: self.layout.n_v,
            holonomic_rows: self.layout.m,
            nonholonomic_rows: self.layout.h,
            start_correction: self.position,
            start_velocity_correction: self.velocity,
            mobility: freedoms.map(|f| f.mobility),
            mobility_without_drives: freedoms.and_then(|f| f.document.mobility_without_drives()),
            cannot_move: freedoms.and_then(|f| f.document.cannot_move),
            inactive: &self.inactive,
            problems: &self.problems,
            warnings: &self.warnings,
        }
    }

    /// The result in words.
    pub(crate) fn describe(&self) -> String {
        let velocity = match self.velocity {
            Some(correction) => format!(" and {correction:.1e} in velocity"),
            None => String::new(),
        };
        let codes = self
            .problems
            .iter()
            .map(|d| format!("warning[{}]: ", d.code));
        let heads = codes.chain(std::iter::repeat("warning: ".to_owned()));
        let warnings = heads.zip(&self.warnings);
        let warnings: String = warnings.map(|(head, w)| wrapped(&head, w)).collect();
        let inactive = match self.inactive.as_slice() {
            [] => String::new(),
            names => wrapped("not active: ", &names.join(", ")),
        };
        let mobility = match &self.freedoms {
            Some(freedoms) => freedoms.document.summary(freedoms.mobility) + "\n",
            None => String::new(),
        };
        format!(
            "{}: {}, {}, {} ({} holonomic, {} nonholonomic)\n\
             {mobility}assembled; the start was corrected by {:.1e} in position{velocity}\n{inactive}{warnings}",
            self.scene,
            count(self.bodies, "body", "bodies"),
            count(
                self.layout.groups.len(),
                "joint or drive",
                "joints and drives"
            ),
            count(self.layout.rows(), "row", "rows"),
            self.layout.m,
            self.layout.h,
            self.position,
        )
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}
