//! How do small motions about a state go on?

mod answer;
mod page;
mod tables;
mod words;

use dynamics::linearise::LineariseOptions;
use report::Family;
use serde::Deserialize;

pub use answer::{LineariseAnswer, ModeOfMotion, NamedInput, NamedState, SecondOrderMatrices};

use crate::question::{Answer, Control, Output, Place, Question, Writing};
use crate::refusal::{Refusal, json};
use crate::start::Start;
use crate::words::Block;

/// Small motions about a state at rest or a steady one: matrices, eigenvalues, modes
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("linearise/examples.txt")))]
pub struct Linearise {
    /// Time of the motion at which it is linearised (s)
    #[cfg_attr(
        feature = "command",
        arg(
            long,
            value_name = "T",
            default_value_t = 0.0,
            allow_hyphen_values = true
        )
    )]
    pub at_time: f64,
    /// Independent coordinates to use, such as crank.angle or rod.x, in space also rod.rz; the
    /// others are chosen
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "NAMES", value_delimiter = ',')
    )]
    pub coordinates: Vec<String>,
    /// Coordinates in which a steady motion goes on, such as frame.x,frame.y,frame.wz: they are
    /// left out, and the axes turn with the latter
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "NAMES", value_delimiter = ',')
    )]
    pub follow: Vec<String>,
}

/// The table of the modes.
const MODES: &str = "modes.csv";

/// The document.
const DOCUMENT: &str = "linearisation.json";

impl Question for Linearise {
    const NAME: &'static str = "linearise";
    const SCHEMA: &'static str = include_str!("linearise/answer.schema.json");
    const OUTPUT: Option<Output> = Some(Output {
        family: Family(&[
            "a.csv",
            "b.csv",
            "m.csv",
            "d.csv",
            "k.csv",
            MODES,
            DOCUMENT,
            "mode-*.html",
        ]),
        contents: "matrices and modes as tables, and pages on which the modes move",
        writing: Writing::AtEnd,
    });
    type Subject<'s> = &'s Start<'s>;
    type Answer = LineariseAnswer;

    fn answer(&self, of: &Start<'_>, control: &Control<'_>) -> Result<LineariseAnswer, Refusal> {
        let study = of.study(control)?;
        let options = LineariseOptions {
            coordinates: self.coordinates.clone(),
            follow: self.follow.clone(),
        };
        let found = study.linearise_until(self.at_time, &options, control.stop);
        let found = found.map_err(|e| of.refusal(e))?;
        let modes = found.modes();
        let mut answer = LineariseAnswer::new(study.scene.name(), &found, modes.as_deref());
        if control.wants_files {
            let modes = modes.as_deref().unwrap_or_default();
            answer.pages = page::all(&study, &found, modes, &control.provenance.into());
        }
        Ok(answer)
    }
}

impl Answer for LineariseAnswer {
    fn words(&self) -> Vec<Block> {
        words::of(self)
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        for (name, text) in tables::matrices(self)? {
            place.put(name, &text)?;
        }
        if self.modes.is_some() {
            place.put(MODES, &tables::modes(MODES, self)?)?;
        }
        place.put(DOCUMENT, json(self)?.as_bytes())?;
        for (k, page) in &self.pages {
            place.put(&format!("mode-{}.html", k + 1), page.as_bytes())?;
        }
        Ok(())
    }
}
