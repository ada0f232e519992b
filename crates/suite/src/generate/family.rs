//! The common interface of the families.

use std::io;

use super::answer::{Answer, FreeReaction};
use super::text::SceneText;

/// Mechanisms of one family and one size.
pub(super) trait Family: Send + Sync {
    /// Sizes and ranks.
    fn answer(&self) -> Answer;

    /// Returns the reactions that are not unique at the initial state, in the order of the file.
    fn free_reactions(&self) -> Vec<FreeReaction>;

    /// Returns a description for the head of the file: the mechanism, and the reactions that are
    /// not unique. Each element is one line.
    fn words(&self) -> Vec<String>;

    /// Writes the file without its head: gravity, bodies, joints, forces, and the run.
    fn write(&self, name: &str, scene: &mut SceneText) -> io::Result<()>;
}
