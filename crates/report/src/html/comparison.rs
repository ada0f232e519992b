//! Several choices for reactions that are not unique, along a run: plain data, so that no curve of
//! a page is taken for a fact.

/// Joints and drives that share loads, with what different choices say of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Joints and drives whose reaction is not unique at some time of the run, as places among all.
    pub reactions: Vec<usize>,
    /// The choices.
    pub choices: Vec<ComparedChoice>,
    /// For each frame and each reaction, what of it is free.
    pub freedom: Vec<Vec<Freedom>>,
}

/// A choice with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedChoice {
    /// In words.
    pub label: String,
    /// For each frame and each reaction `[Fx, Fy, T]` on the first body (N, N·m); NaN where the
    /// choice says nothing.
    pub values: Vec<Vec<[f64; 3]>>,
}

/// What of a reaction the model leaves open at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Angle of a direction in which the force is free (rad, global); NaN where the force is
    /// determined or nothing is known.
    pub angle: f64,
    /// Whether the force is free across that direction, too.
    pub plane: bool,
    /// Whether Fx, Fy and T are free. In global components a reaction may be determined at one time
    /// and not at another.
    pub components: [bool; 3],
    /// Whether the force is free along the x and the y of the first body, where it may be
    /// determined throughout.
    pub in_body: [bool; 2],
}

impl Freedom {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self {
        angle: f64::NAN,
        plane: false,
        components: [true; 3],
        in_body: [true; 2],
    };

    /// Nothing is free.
    pub const NONE: Self = Self {
        angle: f64::NAN,
        plane: false,
        components: [false; 3],
        in_body: [false; 2],
    };
}
