//! The text of an input, from the seed of a campaign and a number.

use crate::numbers::Numbers;

use crate::fuzz::{damage, scenes};

/// The published mechanism.
const ROBOT: &str = include_str!("../../../robot-trolley/robot-trolley.toml");

/// Most damages of one text.
const DAMAGES: usize = 4;

/// The text of input `number`: a random scene, or one of the suite; half of them damaged.
#[must_use]
pub fn text(seed: u64, number: u64) -> String {
    // A seed of its own for each input, by one draw: neighbours have nothing in common.
    let mut numbers = Numbers::new(seed ^ Numbers::new(number).bits());
    let from_suite = numbers.once_in(4);
    let mut text = if from_suite {
        known(&mut numbers)
    } else {
        scenes::random(&mut numbers)
    };
    // Scenes of the suite as they are have tests of their own.
    if from_suite || numbers.once_in(2) {
        for _ in 0..=numbers.below(DAMAGES) {
            text = damage::damaged(&text, &mut numbers);
        }
    }
    text
}

fn known(numbers: &mut Numbers) -> String {
    let all: Vec<&str> = suite::all().map(|case| case.scene).chain([ROBOT]).collect();
    all[numbers.below(all.len())].to_owned()
}
