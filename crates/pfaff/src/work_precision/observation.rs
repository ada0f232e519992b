//! What is compared of a motion at an instant: positions, velocities, accelerations and reactions,
//! by place.

use dynamics::{MotionFault, Sample};
use model::reaction::COMPONENTS;
use model::{ColumnKind, Mechanism, Reaction, System};
use suite::{Fact, Kind, Quantity};

/// Numbers per joint or drive: force, torque, and the named component, if it has one.
const PER_REACTION: usize = COMPONENTS.len() + 1;

/// All that is compared at one instant, kind by kind in the order of [`Kind::ALL`].
#[derive(Clone, Debug)]
pub struct Observation {
    /// Time (s).
    pub(super) t: f64,
    pub(super) q: Vec<f64>,
    pub(super) values: [Vec<f64>; 4],
}

impl Observation {
    /// Looks at a row of output.
    pub(super) fn of(sample: &mut Sample<'_, '_>) -> Result<Self, MotionFault> {
        let (a, reactions) = (sample.acceleration()?, sample.reactions()?);
        let [q, v] = [sample.q.to_vec(), sample.v.to_vec()];
        Ok(Self::new(sample.t, [q, v, a], &reactions))
    }

    /// The coordinates, velocities and accelerations at a time, with the reactions of all joints
    /// and drives.
    #[must_use]
    pub fn new(t: f64, [q, v, a]: [Vec<f64>; 3], reactions: &[Reaction]) -> Self {
        let numbers = reactions.iter().flat_map(|r| {
            let component = r.component.unwrap_or(f64::NAN);
            [r.force[0], r.force[1], r.torque, component]
        });
        let reactions = numbers.collect();
        Self {
            t,
            q: q.clone(),
            values: [q, v, a, reactions],
        }
    }
}

/// Place of a kind in [`Observation::values`].
pub(super) fn index(kind: Kind) -> usize {
    match kind {
        Kind::Position => 0,
        Kind::Velocity => 1,
        Kind::Acceleration => 2,
        Kind::Reaction => 3,
    }
}

/// Place of a reaction's component.
pub(super) fn reaction_place(group: usize, component: usize) -> usize {
    PER_REACTION * group + component
}

/// Where the value of a fact stands among those of its kind; `None` if the mechanism has nothing of
/// the name.
pub(super) fn place(fact: &Fact, mechanism: &Mechanism) -> Option<usize> {
    let coordinate = |name: &str| {
        let mut columns = 0..mechanism.layout().n_v;
        columns.find(|&k| mechanism.coordinate(k) == (fact.of.as_str(), name))
    };
    let reaction = |component: usize| {
        let mut groups = mechanism.layout().groups.iter();
        let group = groups.position(|g| g.name == fact.of)?;
        Some(reaction_place(group, component))
    };
    match fact.quantity {
        Quantity::X | Quantity::Vx | Quantity::Ax => coordinate("x"),
        Quantity::Y | Quantity::Vy | Quantity::Ay => coordinate("y"),
        Quantity::Angle | Quantity::Omega | Quantity::Alpha => coordinate("angle"),
        Quantity::Fx => reaction(0),
        Quantity::Fy => reaction(1),
        Quantity::Torque => reaction(2),
        Quantity::Normal => reaction(3),
    }
}

/// What the values of each kind are divided by so that they can be compared with each other:
/// lengths by the size of the mechanism (m), torques too; angles and forces by 1.
pub(super) fn units(mechanism: &Mechanism, size: f64) -> [Vec<f64>; 4] {
    let kinds = mechanism.column_kinds();
    let columns: Vec<f64> = kinds
        .iter()
        .map(|kind| match kind {
            ColumnKind::Translation => size,
            ColumnKind::Rotation => 1.0,
        })
        .collect();
    let groups = mechanism.layout().groups.len();
    let reactions = [1.0, 1.0, size, 1.0].repeat(groups);
    [columns.clone(), columns.clone(), columns, reactions]
}
