//! The quantities of a motion that are compared at an instant: positions, velocities, accelerations
//! and reactions, by index.

use dynamics::{MotionFault, Sample};
use model::{ColumnKind, Mechanism, Reaction, SpaceKind, System};

/// Kinds of quantities: values of the same kind are compared with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Coordinates.
    Position,
    /// Their rates.
    Velocity,
    /// Rates of the rates.
    Acceleration,
    /// Forces and torques of joints and drives.
    Reaction,
}

impl Kind {
    /// Number of kinds.
    pub const COUNT: usize = 4;

    /// Index of the quantity `name` of `of` in an [`Observation`] of planar bodies: for a body `x`,
    /// `y` or `angle`, for a joint or drive `Fx`, `Fy`, `T`, or the name of its one component.
    /// Returns `None` if the mechanism has nothing of that name.
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
    /// Takes the quantities of a row of output.
    pub(super) fn of(sample: &mut Sample<'_, '_>, space: SpaceKind) -> Result<Self, MotionFault> {
        let (a, reactions) = (sample.acceleration()?, sample.reactions()?);
        let [q, v] = [sample.q.to_vec(), sample.v.to_vec()];
        Ok(Self::new(space, sample.t, [q, v, a], reactions.as_chosen()))
    }

    /// Coordinates, velocities and accelerations at a time, with the reactions of all joints and
    /// drives.
    #[must_use]
    pub fn new(space: SpaceKind, t: f64, [q, v, a]: [Vec<f64>; 3], reactions: &[Reaction]) -> Self {
        let numbers = reactions.iter().flat_map(|r| {
            let component = r.component.unwrap_or(f64::NAN);
            r.components(space).chain([component])
        });
        let reactions = numbers.collect();
        // Behind the bodies q counts turns.
        let bodies = &q[..(v.len() / space.n_v() * space.n_q()).min(q.len())];
        Self {
            t,
            values: [space.pose_numbers(bodies), v, a, reactions],
        }
    }
}

/// Index of a component of a reaction: for each joint or drive there are force, torque, and the
/// named component, if it has one.
pub(super) fn reaction_place(mechanism: &Mechanism, group: usize, component: usize) -> usize {
    (mechanism.space().n_v() + 1) * group + component
}

/// Units by which the values of each kind are divided so that they can be compared with each other:
/// for lengths and torques the size of the mechanism (m), for angles and forces 1.
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
    // Those of poses: a length each of the translations, and directions.
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

    /// Behind a body stand ten angles that count their turns, as many as a body has coordinates and
    /// more: they belong to no pose.
    #[test]
    fn turns_are_no_poses() {
        let pose = [1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0];
        let q = [&pose[..], &[0.5; 10]].concat();
        let rest = vec![0.0; 6];
        let found = Observation::new(SpaceKind::Space3, 0.0, [q, rest.clone(), rest], &[]);
        assert_eq!(found.values[0].len(), 12);
    }
}
