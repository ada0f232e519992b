//! A random scene: every joint, drive, force and function of time, on bodies that are mostly placed
//! on a coarse grid, so that parallel axes, coinciding points and redundant loops are frequent.

mod functions;
mod things;
mod values;

use crate::numbers::Numbers;

pub(crate) use values::Values;

/// The part of a scene that has been written so far.
#[derive(Default)]
struct Draft {
    text: String,
    /// Names of bodies as in the file, quoted.
    bodies: Vec<String>,
    /// Joints: name, quoted, and type.
    joints: Vec<(String, &'static str)>,
    drives: Vec<String>,
    markers: Vec<String>,
}

impl Draft {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// A body or, once in `ground` times, the ground.
    fn body(&self, numbers: &mut Numbers, ground: usize) -> String {
        if self.bodies.is_empty() || numbers.once_in(ground) {
            "\"ground\"".to_owned()
        } else {
            self.bodies[numbers.below(self.bodies.len())].clone()
        }
    }

    /// Two bodies or a body and the ground, mostly different ones.
    fn pair(&self, numbers: &mut Numbers) -> [String; 2] {
        loop {
            let pair = [self.body(numbers, 3), self.body(numbers, 8)];
            if pair[0] != pair[1] || numbers.once_in(30) {
                return pair;
            }
        }
    }
}

/// The text of a random scene. Most can be read, many can be assembled, some can move.
#[must_use]
pub fn random(numbers: &mut Numbers) -> String {
    let mut draft = Draft::default();
    let mut values = Values::new(numbers);
    things::head(&mut draft, &mut values);
    let bodies = match values.numbers.below(40) {
        0 => 0,
        1 => 12,
        n => 1 + n % 5,
    };
    for k in 0..bodies {
        things::body(&mut draft, &mut values, k);
    }
    let markers = values.numbers.below(6).saturating_sub(3);
    for _ in 0..markers {
        things::marker(&mut draft, &mut values);
    }
    if values.numbers.once_in(4) {
        things::measure(&mut draft, &mut values);
    }
    // First a tree, then additional loops.
    for k in 0..bodies {
        if !values.numbers.once_in(5) {
            let parent = if k == 0 || values.numbers.once_in(3) {
                "\"ground\"".to_owned()
            } else {
                draft.bodies[values.numbers.below(k)].clone()
            };
            let child = draft.bodies[k].clone();
            things::joint(&mut draft, &mut values, [parent, child]);
        }
    }
    let more = values.numbers.below(4);
    for _ in 0..more {
        let pair = draft.pair(values.numbers);
        things::joint(&mut draft, &mut values, pair);
    }
    let edges = values.numbers.below(4).saturating_sub(1);
    for _ in 0..edges {
        things::nonholonomic(&mut draft, &mut values);
    }
    for joint in draft.joints.clone() {
        if values.numbers.once_in(5) {
            things::drive(&mut draft, &mut values, &joint);
        }
    }
    let forces = values.numbers.below(4).saturating_sub(1);
    for _ in 0..forces {
        things::force(&mut draft, &mut values);
    }
    things::wishes(&mut draft, &mut values);
    draft.text
}
