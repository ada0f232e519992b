//! A scene that is being written.

use clap::ValueEnum;

use suite::numbers::Numbers;

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
    /// Returns the number of components of a point.
    pub(super) fn axes(self) -> usize {
        match self {
            Self::Plane => 2,
            Self::Space => 3,
        }
    }
}

/// The part of a scene that has been written so far.
#[derive(Default)]
pub(super) struct Draft {
    pub(super) space: Space,
    pub(super) text: String,
    /// Names of bodies as in the file, quoted.
    pub(super) bodies: Vec<String>,
    /// Joints, each with its quoted name and its type.
    pub(super) joints: Vec<(String, &'static str)>,
    pub(super) drives: Vec<String>,
    pub(super) markers: Vec<String>,
}

impl Draft {
    pub(super) fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Returns a body or, with probability 1/`ground`, the ground.
    pub(super) fn body(&self, numbers: &mut Numbers, ground: usize) -> String {
        if self.bodies.is_empty() || numbers.once_in(ground) {
            "\"ground\"".to_owned()
        } else {
            self.bodies[numbers.below(self.bodies.len())].clone()
        }
    }

    /// Returns two bodies, or a body and the ground. The two names are mostly different.
    pub(super) fn pair(&self, numbers: &mut Numbers) -> [String; 2] {
        loop {
            let pair = [self.body(numbers, 3), self.body(numbers, 8)];
            if pair[0] != pair[1] || numbers.once_in(30) {
                return pair;
            }
        }
    }
}
