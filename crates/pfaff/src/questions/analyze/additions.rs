//! The list of what an analysis also says if it is asked to, each in a folder of its own.

use super::addition::Addition;
use super::{about, frames};

/// All of them, in the order of the words.
pub(super) const ADDITIONS: &[&dyn Addition] = &[&frames::OtherFrames, &about::Moments];
