//! `report.html` of a run, and the page of a start alone: one file that opens without a network,
//! for a reader who knows the mechanism but not the program. It contains an animation of the
//! mechanism, verdicts as text, and curves with a cursor at the time of the animation.
//!
//! A reaction that is not unique has no curve of its own: it is drawn as a band between named
//! choices ([`Comparison`]).
//!
//! | module | content |
//! | --- | --- |
//! | `comparison` | the same reaction under several choices |
//! | `first_order` | free motions and self-stresses of the start |
//! | `data` | bodies, joints and curves as one JSON document, rounded |
//! | `document`, `motion`, `verdicts`, `peaks`, `inputs` | the page around them |
//! | `report.css`, `script/` | its looks, and what moves |

mod comparison;
mod curves;
mod data;
mod document;
mod first_order;
mod inputs;
mod motion;
mod peaks;
mod run_page;
mod verdicts;

use model::Mechanism;

pub use comparison::{ComparedChoice, Comparison, Freedom};
pub use run_page::{DriveCurve, Origin, RunPage, Shows, WrittenScene};

/// Numbers in a row of a recording, including those that a page shows of it.
#[must_use]
pub fn numbers_per_row(mechanism: &Mechanism) -> usize {
    data::numbers_per_row(mechanism)
}

/// The page of a run. The same input gives the same bytes.
#[must_use]
pub fn run_page(page: &RunPage<'_>) -> String {
    document::document(page)
}
