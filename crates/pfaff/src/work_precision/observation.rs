//! The quantities of a motion that are compared at an instant: positions, velocities, accelerations
//! and reactions, by index.

use dynamics::{MotionFault, Sample};
use model::{ColumnKind, Mechanism, Reaction, SpaceKind, System};

/// Kinds of quantities. Values of the same kind are compared with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Coordinates of the mechanism.
    Position,
    /// Time derivatives of the coordinates.
    Velocity,
    /// Second time derivatives of the coordinates.
    Acceleration,
    /// Forces and torques of joints and drives.
    Reaction,
}

impl Kind {
    /// Number of kinds.
    pub const COUNT: usize = 4;

    /// Returns the index of the quantity `name` of `of` in an [`Observation`] of planar bodies. A
    /// body has `x`, `y` or `angle`; a joint or drive has `Fx`, `Fy`, `T`, or the name of its only
    /// component. Returns `None` if the mechanism has no quantity with this name.
    #[must_use]
    pub fn place(self, of: &str, name: &str, mechanism: &Mechanism) -> Option<usize> {
        if self != Self::Reaction {
            let mut columns = 0..mechanism.layout().n_v;
            return columns.find(|&k| mechanism.coordinate(k) == (of, name));
        }
        let mut groups = mechanism.layout().groups.iter();
        let group = groups.position(|g| g.name == of)?;
        let space = mechanism.space();
        let component = space.component(name).unwrap_or(space.n_v());
        Some(reaction_place(mechanism, group, component))
    }
}

/// All quantities compared at one instant, by kind in the order of [`Kind`].
#[derive(Clone, Debug)]
pub struct Observation {
    /// Time (s).
    pub(super) t: f64,
    pub(super) values: [Vec<f64>; Kind::COUNT],
}

impl Observation {
    /// Reads the quantities of an output row.
    pub(super) fn of(sample: &mut Sample<'_, '_>, space: SpaceKind) -> Result<Self, MotionFault> {
        let (a, reactions) = (sample.acceleration()?, sample.reactions()?);
        let [q, v] = [sample.q.to_vec(), sample.v.to_vec()];
        Ok(Self::new(space, sample.t, [q, v, a], reactions.as_chosen()))
    }

    /// Stores coordinates, velocities and accelerations at a time, with the reactions of all joints
    /// and drives.
    #[must_use]
    pub fn new(space: SpaceKind, t: f64, [q, v, a]: [Vec<f64>; 3], reactions: &[Reaction]) -> Self {
        let numbers = reactions.iter().flat_map(|r| {
            let component = r.component.unwrap_or(f64::NAN);
            r.components(space).chain([component])
        });
        let reactions = numbers.collect();
        // After the bodies, q contains unwrapped angles.
        let bodies = &q[..(v.len() / space.n_v() * space.n_q()).min(q.len())];
        Self {
            t,
            values: [space.pose_numbers(bodies), v, a, reactions],
        }
    }
}

/// Returns the index of a component of a reaction. Each joint or drive has the components of the
/// force and the torque, and the named component, if the definition has a named component.
pub(super) fn reaction_place(mechanism: &Mechanism, group: usize, component: usize) -> usize {
    (mechanism.space().n_v() + 1) * group + component
}

/// Returns the units by which the values of each kind are divided, so that they can be compared
/// with each other. The unit of lengths and torques is the size of the mechanism (m), and the unit
/// of angles and forces is 1.
pub(super) fn units(mechanism: &Mechanism, size: f64) -> [Vec<f64>; 4] {
    let kinds = mechanism.layout().column_kinds();
    let columns: Vec<f64> = kinds
        .iter()
        .map(|kind| match kind {
            ColumnKind::Translation => size,
            ColumnKind::Rotation => 1.0,
        })
        .collect();
    let groups = mechanism.layout().groups.len();
    let space = mechanism.space();
    let mut of_reaction = vec![1.0; space.n_v() + 1];
    of_reaction[space.torques()].fill(size);
    let reactions = of_reaction.repeat(groups);
    // Units of poses: a length for each translation, and 1 for directions.
    let of_pose = |body: &[f64]| match space {
        SpaceKind::Space3 => [&body[..3], &[1.0; 9]].concat(),
        _ => body.to_vec(),
    };
    let poses = columns.chunks_exact(space.n_v()).flat_map(of_pose);
    [poses.collect(), columns.clone(), columns, reactions]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After the body there are ten unwrapped angles, which is more than the number of coordinates
    /// of a body. These angles do not belong to a pose.
    #[test]
    fn turns_are_no_poses() {
        let pose = [1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0];
        let q = [&pose[..], &[0.5; 10]].concat();
        let rest = vec![0.0; 6];
        let found = Observation::new(SpaceKind::Space3, 0.0, [q, rest.clone(), rest], &[]);
        assert_eq!(found.values[0].len(), 12);
    }
}
