//! The space of a definition: its sizes, and the names of the body fields that kernels read.

/// The space in which the bodies of a definition move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// `plane`
    Plane,
    /// `space`
    Space3,
}

impl Space {
    /// Returns the number of components of a vector.
    #[must_use]
    pub fn dim(self) -> usize {
        match self {
            Self::Plane => 2,
            Self::Space3 => 3,
        }
    }

    /// Returns the number of velocities of a body.
    #[must_use]
    pub fn n_dof(self) -> usize {
        match self {
            Self::Plane => 3,
            Self::Space3 => 6,
        }
    }

    /// Returns whether a degree of freedom of a body is a rotation.
    pub(crate) fn is_rotation(self, dof: usize) -> bool {
        dof >= self.dim()
    }

    /// Returns the word for the space in a definition.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Space3 => "space",
        }
    }

    /// Returns the fields of a pose, each with the name of its input. In the names, `{}` is the
    /// slot.
    pub(crate) fn pose(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Plane => &[
                ("x", "r_{}_x"),
                ("y", "r_{}_y"),
                ("angle", "angle_{}"),
                ("cos", "cos_{}"),
                ("sin", "sin_{}"),
            ],
            Self::Space3 => &[
                ("r[0]", "r_{}_x"),
                ("r[1]", "r_{}_y"),
                ("r[2]", "r_{}_z"),
                ("rot[0][0]", "rot_{}_xx"),
                ("rot[0][1]", "rot_{}_xy"),
                ("rot[0][2]", "rot_{}_xz"),
                ("rot[1][0]", "rot_{}_yx"),
                ("rot[1][1]", "rot_{}_yy"),
                ("rot[1][2]", "rot_{}_yz"),
                ("rot[2][0]", "rot_{}_zx"),
                ("rot[2][1]", "rot_{}_zy"),
                ("rot[2][2]", "rot_{}_zz"),
            ],
        }
    }

    /// Returns the fields of a twist, each with the names of the inputs for velocity and
    /// acceleration.
    pub(crate) fn twist(self) -> &'static [(&'static str, [&'static str; 2])] {
        match self {
            Self::Plane => &[
                ("x", ["v_{}_x", "a_{}_x"]),
                ("y", ["v_{}_y", "a_{}_y"]),
                ("omega", ["omega_{}", "alpha_{}"]),
            ],
            Self::Space3 => &[
                ("v[0]", ["v_{}_x", "a_{}_x"]),
                ("v[1]", ["v_{}_y", "a_{}_y"]),
                ("v[2]", ["v_{}_z", "a_{}_z"]),
                ("omega[0]", ["omega_{}_x", "alpha_{}_x"]),
                ("omega[1]", ["omega_{}_y", "alpha_{}_y"]),
                ("omega[2]", ["omega_{}_z", "alpha_{}_z"]),
            ],
        }
    }
}

/// Names of the axes.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
