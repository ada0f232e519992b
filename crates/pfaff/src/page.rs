//! `report.html` of a run, and the page of a start without a run. The page is one file that opens
//! without a network. It is for a reader who is familiar with the mechanism but not with the
//! program. The page contains an animation of the mechanism, verdicts as text, and curves with a
//! cursor at the time of the animation.
//!
//! A reaction that is not unique has no single curve. The page shows a band between named choices
//! ([`Comparison`]).
//!
//! | module | content |
//! | --- | --- |
//! | `comparison` | reactions for several choices |
//! | `first_order` | free motions and self-stresses at the start |
//! | `cast`, `values` | the drawn part, and the determined values |
//! | `data` | bodies, joints and curves as one JSON document, rounded |
//! | `document`, `motion`, `verdicts`, `contacts`, `peaks`, `assumptions`, `inputs` | the sections of the page |
//! | `report.css`, `script/` | style sheet, and scripts |
//!
//! A page for a customer ([`scene::PrintStyle::Customer`]) has the same sentences in fewer
//! sections: title, verdict, picture, determined peaks and curves, assumptions, and annexes on
//! request.
//!
//! A page computes no verdict. Its rows are the rows of the run. It uses additional rows only if
//! the tables have too few rows for an animation. A reaction is drawn as determined only if no
//! choice changes the reaction during the run. Scripts and styles are inserted unchanged, and the
//! page loads no external file.

mod assumptions;
mod cast;
mod comparison;
mod contacts;
mod curves;
mod data;
mod document;
mod first_order;
mod inputs;
mod motion;
mod peaks;
mod run_page;
mod values;
mod verdicts;

use model::Mechanism;
use model::words::{UnitSystem, in_units};

pub use comparison::{ComparedChoice, Comparison, Freedom};
pub use run_page::{Band, DriveCurve, Origin, Plot, PlotCurve, RunPage, Shows, WrittenScene};

/// Returns the number of values in a row of a recording, including the values that a page shows.
#[must_use]
pub fn numbers_per_row(mechanism: &Mechanism) -> usize {
    data::numbers_per_row(mechanism)
}

/// Builds the page of a run. The same input gives the same bytes.
#[must_use]
pub fn run_page(page: &RunPage<'_>) -> String {
    in_units(UnitSystem::Scene(page.scene.units), || {
        document::document(page)
    })
}
