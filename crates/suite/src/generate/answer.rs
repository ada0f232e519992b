//! The known results for a generated mechanism at its initial state.

/// Sizes and ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// Number of bodies.
    pub bodies: usize,
    /// Number of joints, knife edges included.
    pub joints: usize,
    /// Number of drives.
    pub drives: usize,
    /// Number of rows of C, m + h.
    pub rows: usize,
    /// Rank r of C.
    pub rank: usize,
    /// Degree of redundancy p, rows − r.
    pub redundancy: usize,
    /// Degrees of freedom, 3·bodies − r.
    pub mobility: usize,
}

impl Answer {
    /// Creates the result for planar bodies with this number of rows. `redundancy` of these rows
    /// depend on the other rows.
    pub(super) fn new(
        bodies: usize,
        joints: usize,
        drives: usize,
        rows: usize,
        redundancy: usize,
    ) -> Self {
        let rank = rows - redundancy;
        Self {
            bodies,
            joints,
            drives,
            rows,
            rank,
            redundancy,
            mobility: 3 * bodies - rank,
        }
    }
}

/// A reaction that is not unique.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeReaction {
    /// Name of the joint.
    pub name: String,
    /// The undetermined part of the reaction.
    pub free: Free,
}

/// The undetermined part of a reaction. The rest of the reaction is determined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Free {
    /// The force, in every direction.
    Force,
    /// The force along this direction (global components, length 1). The perpendicular force
    /// component is determined.
    Along([f64; 2]),
    /// The force along this direction, and the torque.
    AlongAndTorque([f64; 2]),
}

impl FreeReaction {
    pub(super) fn new(name: String, free: Free) -> Self {
        Self { name, free }
    }
}
