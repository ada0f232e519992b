//! A random scene: every joint, drive, force and function of time, on bodies that are mostly placed
//! on a coarse grid, so that parallel axes, coinciding points and redundant loops are frequent.

mod functions;
mod space;
mod things;
mod values;

use clap::ValueEnum;

use crate::numbers::Numbers;

pub(crate) use values::Values;

/// The space of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Space {
    /// Bodies in the plane.
    #[default]
    Plane,
    /// Bodies in space.
    Space,
}

impl Space {
    /// The number of components of a point.
    fn axes(self) -> usize {
        match self {
            Self::Plane => 2,
            Self::Space => 3,
        }
    }
}

/// The part of a scene that has been written so far.
#[derive(Default)]
struct Draft {
    space: Space,
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

    fn add_body(&mut self, values: &mut Values<'_>, k: usize) {
        match self.space {
            Space::Plane => things::body(self, values, k),
            Space::Space => space::body(self, values, k),
        }
    }

    fn add_joint(&mut self, values: &mut Values<'_>, pair: [String; 2]) {
        match self.space {
            Space::Plane => things::joint(self, values, pair),
            Space::Space => space::joint(self, values, pair),
        }
    }

    fn add_nonholonomic(&mut self, values: &mut Values<'_>) {
        match self.space {
            Space::Plane => things::nonholonomic(self, values),
            Space::Space => space::nonholonomic(self, values),
        }
    }

    fn add_drive(&mut self, values: &mut Values<'_>, joint: &(String, &'static str)) {
        let measure = match self.space {
            Space::Plane => things::measure_of(values, joint.1),
            Space::Space => space::measure_of(values, joint.1),
        };
        if let Some(measure) = measure {
            things::drive(self, values, joint, measure);
        }
    }

    fn add_force(&mut self, values: &mut Values<'_>) {
        match self.space {
            Space::Plane => things::force(self, values),
            Space::Space => space::force(self, values),
        }
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
        draft.add_body(&mut values, k);
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
            draft.add_joint(&mut values, [parent, child]);
        }
    }
    let more = values.numbers.below(4);
    for _ in 0..more {
        let pair = draft.pair(values.numbers);
        draft.add_joint(&mut values, pair);
    }
    let edges = values.numbers.below(4).saturating_sub(1);
    for _ in 0..edges {
        draft.add_nonholonomic(&mut values);
    }
    for joint in draft.joints.clone() {
        if values.numbers.once_in(5) {
            draft.add_drive(&mut values, &joint);
        }
    }
    let forces = values.numbers.below(4).saturating_sub(1);
    for _ in 0..forces {
        draft.add_force(&mut values);
    }
    things::wishes(&mut draft, &mut values);
    draft.text
}
