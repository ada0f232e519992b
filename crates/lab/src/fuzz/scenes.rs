//! Random scenes with all types of joints, drives, forces and functions of time. Most bodies are
//! placed on a coarse grid, so that parallel axes, coincident points and redundant loops are
//! frequent.

mod draft;
mod functions;
mod parts;
mod plane;
mod space;
mod things;
mod values;

use suite::numbers::Numbers;

use draft::Draft;

pub use draft::Space;
pub(crate) use values::{EXTREMES, Values};

/// Returns the text of a random scene. Most of these scenes can be read, many can be assembled, and
/// some can move.
#[must_use]
pub fn random(space: Space, numbers: &mut Numbers) -> String {
    let mut draft = Draft {
        space,
        ..Draft::default()
    };
    let mut values = Values::new(numbers, space.axes());
    things::head(&mut draft, &mut values);
    let bodies = match values.numbers.below(40) {
        0 => 0,
        1 => 12,
        n => 1 + n % 5,
    };
    for k in 0..bodies {
        body(&mut draft, &mut values, k);
    }
    let markers = values.numbers.below(6).saturating_sub(3);
    for _ in 0..markers {
        things::marker(&mut draft, &mut values);
    }
    if values.numbers.once_in(4) {
        things::measure(&mut draft, &mut values);
    }
    // The joints of a tree come first, then additional joints that close loops.
    for k in 0..bodies {
        if !values.numbers.once_in(5) {
            let parent = if k == 0 || values.numbers.once_in(3) {
                "\"ground\"".to_owned()
            } else {
                draft.bodies[values.numbers.below(k)].clone()
            };
            let child = draft.bodies[k].clone();
            joint(&mut draft, &mut values, [parent, child]);
        }
    }
    let more = values.numbers.below(4);
    for _ in 0..more {
        let pair = draft.pair(values.numbers);
        joint(&mut draft, &mut values, pair);
    }
    let edges = values.numbers.below(4).saturating_sub(1);
    for _ in 0..edges {
        nonholonomic(&mut draft, &mut values);
    }
    for joint in draft.joints.clone() {
        if values.numbers.once_in(5) {
            drive(&mut draft, &mut values, &joint);
        }
    }
    let forces = values.numbers.below(4).saturating_sub(1);
    for _ in 0..forces {
        force(&mut draft, &mut values);
    }
    things::wishes(&mut draft, &mut values);
    draft.text
}

fn body(draft: &mut Draft, values: &mut Values<'_>, k: usize) {
    match draft.space {
        Space::Plane => plane::body(draft, values, k),
        Space::Space => space::body(draft, values, k),
    }
}

fn joint(draft: &mut Draft, values: &mut Values<'_>, pair: [String; 2]) {
    match draft.space {
        Space::Plane => plane::joint(draft, values, pair),
        Space::Space => space::joint(draft, values, pair),
    }
}

fn nonholonomic(draft: &mut Draft, values: &mut Values<'_>) {
    match draft.space {
        Space::Plane => plane::nonholonomic(draft, values),
        Space::Space => space::nonholonomic(draft, values),
    }
}

fn drive(draft: &mut Draft, values: &mut Values<'_>, joint: &(String, &'static str)) {
    let measure = match draft.space {
        Space::Plane => plane::measure_of(values, joint.1),
        Space::Space => space::measure_of(values, joint.1),
    };
    if let Some(measure) = measure {
        things::drive(draft, values, joint, measure);
    }
}

fn force(draft: &mut Draft, values: &mut Values<'_>) {
    match draft.space {
        Space::Plane => plane::force(draft, values),
        Space::Space => space::force(draft, values),
    }
}
