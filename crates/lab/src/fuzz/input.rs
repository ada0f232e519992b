//! Generates the text of an input, determined by the seed of a campaign and a number.

use std::sync::LazyLock;

use suite::numbers::Numbers;

use crate::fuzz::damage;
use crate::fuzz::scenes::{self, Space};
use crate::fuzz::space::catalogue;
use crate::fuzz::space::drawing::Drawing;
use crate::fuzz::space::text::text as scene_of;

/// Largest number of changes of one text.
const DAMAGES: usize = 4;

/// Returns the text of input `number`: a random scene or a known scene. Half of the random scenes
/// and all known scenes are damaged.
#[must_use]
pub fn text(space: Space, seed: u64, number: u64) -> String {
    // Each input has a separate seed from one random number, so that consecutive inputs are
    // independent.
    let mut numbers = Numbers::new(seed ^ Numbers::new(number).bits());
    let from_suite = numbers.once_in(4);
    let mut text = if from_suite {
        known(space, &mut numbers)
    } else {
        scenes::random(space, &mut numbers)
    };
    // Unchanged scenes of the suite have their own tests.
    if from_suite || numbers.once_in(2) {
        for _ in 0..=numbers.below(DAMAGES) {
            text = damage::damaged(space, &text, &mut numbers);
        }
    }
    text
}

/// Returns a scene of the suite, or in space a scene of the catalogue.
fn known(space: Space, numbers: &mut Numbers) -> String {
    static PLANE: LazyLock<Vec<String>> = LazyLock::new(|| {
        let suite = suite::all().map(|case| case.scene).chain([suite::ROBOT]);
        suite.map(str::to_owned).collect()
    });
    static SPACE: LazyLock<Vec<String>> = LazyLock::new(|| {
        let drawings = catalogue::all();
        drawings.iter().map(|(_, drawing)| drawn(drawing)).collect()
    });
    let all = match space {
        Space::Plane => &PLANE,
        Space::Space => &SPACE,
    };
    all[numbers.below(all.len())].clone()
}

/// Returns a drawing of the catalogue as a scene. The catalogue describes only one configuration;
/// the keys for a run are added here, so that the mechanism also moves.
fn drawn(drawing: &Drawing) -> String {
    scene_of(drawing) + "\n[simulate]\nt_end = 0.2\n"
}
