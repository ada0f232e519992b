//! Several choices for reactions that are not unique, along a run: plain data, so that no curve of
//! a page appears to be a unique number.

/// Joints and drives that share loads, with their reactions for different choices.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Joints and drives whose reactions are not unique at some time of the run, as indices.
    pub reactions: Vec<usize>,
    /// The choices.
    pub choices: Vec<ComparedChoice>,
    /// For each frame and each reaction, its free components.
    pub freedom: Vec<Vec<Freedom>>,
}

/// A choice, with the reactions that it gives.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedChoice {
    /// Name of the choice.
    pub label: String,
    /// For each frame and each reaction the components of the force and the torque on the first
    /// body (N, N·m), ground axes; NaN if the choice does not determine it.
    pub values: Vec<Vec<Vec<f64>>>,
}

/// The components of a reaction that the model leaves undetermined at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// In the plane, angle of a direction in which the force is free (rad, global); NaN if the
    /// force is determined or unknown.
    pub angle: f64,
    /// Whether the force is also free across that direction.
    pub plane: bool,
    /// Whether the components of [`model::SpaceKind::components`] are free; the rest is false. A
    /// reaction may be determined in global components at one time and not at another.
    pub components: [bool; 6],
    /// The same flags along the axes of the first body, along which a component may always be
    /// determined.
    pub in_body: [bool; 6],
}

impl Freedom {
    /// The free components are unknown.
    pub const UNKNOWN: Self = Self {
        angle: f64::NAN,
        plane: false,
        components: [true; 6],
        in_body: [true; 6],
    };

    /// No component is free.
    pub const NONE: Self = Self {
        angle: f64::NAN,
        plane: false,
        components: [false; 6],
        in_body: [false; 6],
    };
}
