//! How do small motions about a state evolve?

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
use crate::start::{Start, asked_time};
use crate::words::Block;

/// Linearise at rest or in steady motion: eigenvalues, modes
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
#[cfg_attr(feature = "command", command(after_help = include_str!("linearise/examples.txt")))]
pub struct Linearise {
    /// Linearise the motion at this time (s)
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
    /// Independent coordinates to use, e.g. crank.angle, rod.x, rod.rz (space); others are chosen
    /// automatically
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "NAMES", value_delimiter = ',')
    )]
    pub coordinates: Vec<String>,
    /// Cyclic coordinates of a steady motion, e.g. frame.x,frame.y,frame.wz; they are eliminated,
    /// and the axes rotate with frame.wz
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "NAMES", value_delimiter = ',')
    )]
    pub follow: Vec<String>,
}

/// File name of the table of modes.
const MODES: &str = "modes.csv";

/// File name of the document.
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
        contents: "matrices, modes and animated pages",
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
        let at_time = asked_time(self.at_time, study.start_time())?;
        let found = study.linearise_until(at_time, &options, control.stop);
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
