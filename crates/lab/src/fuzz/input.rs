//! The text of an input, determined by the seed of a campaign and a number.

use crate::numbers::Numbers;

use crate::fuzz::{damage, scenes};

/// Largest number of changes of one text.
const DAMAGES: usize = 4;

/// The text of input `number`: a random scene, or one of the suite; half of them damaged.
#[must_use]
pub fn text(seed: u64, number: u64) -> String {
    // Each input has its own seed from one random number, so that consecutive inputs are
    // independent.
    let mut numbers = Numbers::new(seed ^ Numbers::new(number).bits());
    let from_suite = numbers.once_in(4);
    let mut text = if from_suite {
        known(&mut numbers)
    } else {
        scenes::random(&mut numbers)
    };
    // Unchanged scenes of the suite have their own tests.
    if from_suite || numbers.once_in(2) {
        for _ in 0..=numbers.below(DAMAGES) {
            text = damage::damaged(&text, &mut numbers);
        }
    }
    text
}

fn known(numbers: &mut Numbers) -> String {
    let all: Vec<&str> = suite::all()
        .map(|case| case.scene)
        .chain([suite::ROBOT])
        .collect();
    all[numbers.below(all.len())].to_owned()
}
