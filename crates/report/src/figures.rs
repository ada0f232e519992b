//! Figures as SVG text: light background, system fonts, no external resources, and readable without
//! colour. Values that are NaN or infinite are gaps.
//!
//! | function | figure |
//! | --- | --- |
//! | [`mechanism()`] | a mechanism to scale; joints are marked by the verdicts on their reactions |
//! | [`history()`], [`histories`] | quantities over time |
//! | [`paths()`] | paths in the plane, with equal axes |
//! | [`work_precision()`] | error against run time, scene by scene |
//! | [`ranges()`], [`cloud()`] | distributions of values and of positions over samples |
//! | [`extremes()`] | error over an extreme parameter value, panel by panel |
//!
//! The function [`png()`] converts any of these figures to a PNG file (feature `png`).
//!
//! Other modules select the quantities and create the pages around figures.

mod axis;
mod curve;
mod decades;
pub mod drawing;
mod extremes;
mod geometry;
mod history;
mod label;
mod mechanism;
mod outline;
mod paths;
mod plot;
mod png;
mod projection;
mod range;
mod style;
mod svg;
mod symbol;
mod tolerance;
mod work_precision;

pub use extremes::{Extremes, extremes};
pub use history::{Panel, Series, histories, history};
pub use mechanism::{LOOKS, Labels, Marking, labelled_mechanism, mechanism};
pub use paths::{Path, PathRecorder, paths};
pub(crate) use png::SOFTWARE;
pub use png::{Png, PngError, check_png, png};
pub use range::{HistogramDocument, RangeDocument};
pub use style::{Pattern, Style};
pub(crate) use svg::GENERATOR;
pub(crate) use svg::escape;
pub use tolerance::{RangeRow, cloud, ranges};
pub use work_precision::work_precision;

/// Reason why a figure cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The coordinates belong to another mechanism.
    #[error("{found} coordinates, the mechanism `{mechanism}` has {expected}")]
    Coordinates {
        /// Name of the mechanism.
        mechanism: String,
        /// Number of coordinates given.
        found: usize,
        /// Number of coordinates of the mechanism.
        expected: usize,
    },
    /// A coordinate is NaN or infinite, or too large to draw.
    #[error(
        "coordinate {number} of `{mechanism}` is {value}, need a finite number up to {limit:e}"
    )]
    Coordinate {
        /// Name of the mechanism.
        mechanism: String,
        /// Index of the coordinate, from 1.
        number: usize,
        /// Value of the coordinate.
        value: f64,
        /// Largest value that can be drawn.
        limit: f64,
    },
    /// The verdicts belong to another mechanism.
    #[error("{found} verdicts, the mechanism `{mechanism}` has {expected} joints and drives")]
    Verdicts {
        /// Name of the mechanism.
        mechanism: String,
        /// Number of verdicts given.
        found: usize,
        /// Number of joints and drives.
        expected: usize,
    },
    /// A body does not exist.
    #[error("body {index} of `{mechanism}` does not exist: it has {bodies}, counted from 0")]
    Body {
        /// Name of the mechanism.
        mechanism: String,
        /// Index of the body.
        index: usize,
        /// Number of bodies.
        bodies: usize,
    },
}
