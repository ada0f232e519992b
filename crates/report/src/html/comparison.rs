//! Several choices for reactions that are not unique, along a run: plain data, so that no curve of
//! a page appears to be a unique number.

/// Joints and drives that share loads, with their reactions for different choices.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Joints and drives whose reaction is not unique at some time of the run, as indices.
    pub reactions: Vec<usize>,
    /// The choices.
    pub choices: Vec<ComparedChoice>,
    /// For each frame and each reaction, its free components.
    pub freedom: Vec<Vec<Freedom>>,
}

/// A choice with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedChoice {
    /// Name of the choice.
    pub label: String,
    /// For each frame and each reaction `[Fx, Fy, T]` on the first body (N, N·m); NaN if the choice
    /// does not determine it.
    pub values: Vec<Vec<[f64; 3]>>,
}

/// The components of a reaction that the model leaves undetermined at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Angle of a direction in which the force is free (rad, global); NaN if the force is
    /// determined or unknown.
    pub angle: f64,
    /// Whether the force is also free across that direction.
    pub plane: bool,
    /// Whether Fx, Fy and T are free. In global components a reaction may be determined at one time
    /// and not at another.
    pub components: [bool; 3],
    /// Whether the force is free along the x and the y axis of the first body, along which it may
    /// always be determined.
    pub in_body: [bool; 2],
}

impl Freedom {
    /// Not known.
    pub const UNKNOWN: Self = Self {
        angle: f64::NAN,
        plane: false,
        components: [true; 3],
        in_body: [true; 2],
    };

    /// No component is free.
    pub const NONE: Self = Self {
        angle: f64::NAN,
        plane: false,
        components: [false; 3],
        in_body: [false; 2],
    };
}
