//! `report.html` of a run, and the page of a start alone: one file that opens without a network,
//! for a reader who has the mechanism in mind and not the program. The mechanism moves, verdicts
//! are told in words, curves have their cursor where the picture is.
//!
//! A reaction that is not unique has no curve of its own: it is a band between choices that are
//! named ([`Comparison`]).
//!
//! | module | content |
//! | --- | --- |
//! | `comparison` | what several choices say of the same reaction |
//! | `data` | bodies, joints and curves as one JSON document, rounded |
//! | `document`, `verdicts`, `inputs` | the page around them |
//! | `report.css`, `script/` | its looks, and what moves |

mod comparison;
mod data;
mod document;
mod inputs;
mod run_page;
mod verdicts;

use model::Mechanism;

pub use comparison::{ComparedChoice, Comparison, Freedom};
pub use run_page::{DriveCurve, Origin, RunPage};

/// Numbers of a row of a recording: what it holds, and what a page shows of it.
#[must_use]
pub fn numbers_per_row(mechanism: &Mechanism) -> usize {
    data::numbers_per_row(mechanism)
}

/// The page. Same input, same bytes.
#[must_use]
pub fn run_page(page: &RunPage<'_>) -> String {
    document::document(page)
}
