//! Several choices for reactions that are not unique, along a run. With these data, no curve of a
//! page appears to be a unique number.

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
    /// For each frame and each reaction, the components of the force and the torque on the first
    /// body (N, N·m) in ground axes. A component is NaN if the choice does not determine it.
    pub values: Vec<Vec<Vec<f64>>>,
}

/// The components of a reaction that the model leaves undetermined at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// In the plane, the angle of a direction in which the force is free (rad, global). The angle
    /// is NaN if the force is determined or unknown.
    pub angle: f64,
    /// Whether the force is also free across that direction.
    pub plane: bool,
    /// For each component of [`model::SpaceKind::components`], whether it is free. The remaining
    /// flags are false. A global component may be determined at one time and free at another time.
    pub components: [bool; 6],
    /// The same flags for the axes of the first body. A component along such an axis may be
    /// determined at all times.
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
