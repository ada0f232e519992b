//! The list of the optional parts of an analysis. Each part has its own folder.

use super::addition::Addition;
use super::{about, bounds, contacts, frames, matrices};

/// All optional parts, in the order of the text.
pub(super) const ADDITIONS: &[&dyn Addition] = &[
    &frames::OtherFrames,
    &about::Moments,
    &contacts::ContactsOfScene,
    &bounds::BoundsOfReactions,
    &matrices::Matrices,
];
