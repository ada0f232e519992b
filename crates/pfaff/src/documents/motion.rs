//! A motion with its rows as plain data: the combined contents of `summary.json`, `trajectory.csv`
//! and `reactions.csv`.

use model::{FrameState, Mechanism, Reaction, System};
use serde::Serialize;
use solvability::{ChosenValues, Stretches};

use super::{ByName, RunDocument};

/// A run and its rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MotionDocument {
    /// The content of `summary.json`.
    pub summary: RunDocument,
    /// The rows of `trajectory.csv` and `reactions.csv`, by the names of their columns.
    pub rows: Vec<MomentDocument>,
}

impl MotionDocument {
    /// Builds the document of a run with its rows for one choice. Numbers that are not determined
    /// on their stretch are omitted.
    #[must_use]
    pub fn new(
        summary: RunDocument,
        mut rows: Vec<MomentDocument>,
        mechanism: &Mechanism,
        stretches: Option<&Stretches>,
    ) -> Self {
        if let Some(stretches) = stretches {
            for row in &mut rows {
                row.leave_out_choices(mechanism, stretches);
            }
        }
        Self { summary, rows }
    }
}

/// State and reactions at one time.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MomentDocument {
    /// Time (s).
    pub t: f64,
    /// Bodies by name, in the order of the coordinates.
    pub bodies: ByName<ByName<f64>>,
    /// Markers by name.
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub markers: ByName<ByName<f64>>,
    /// Joint coordinates (measures) by name (m, rad, m/s, rad/s).
    #[serde(skip_serializing_if = "ByName::is_empty")]
    pub measures: ByName<f64>,
    /// Force and torque on the first body of joints and drives, by name and in the order of their
    /// rows. The components are `Fx`, `Fy` (N), `T` (N·m), and the named component of the
    /// definition, if it has one. Values that are not determined on their stretch, or were not
    /// computed, are NaN, `null` in JSON.
    pub reactions: ByName<ByName<f64>>,
}

/// Returns position and velocity of a body or marker by the names of the columns of its space. In
/// the plane these are `x`, `y` (m), `angle` (rad, not reduced to one revolution), `vx`, `vy` (m/s)
/// and `omega` (rad/s). The point is the marker, or the origin of the frame of the body, which is
/// its centre of mass unless the scene states otherwise.
fn state(of: &FrameState) -> ByName<f64> {
    let columns = of.space.columns().iter();
    ByName(
        columns
            .map(|name| (*name).to_owned())
            .zip(of.numbers())
            .collect(),
    )
}

impl MomentDocument {
    /// Omits numbers that are not determined on their stretch.
    fn leave_out_choices(&mut self, mechanism: &Mechanism, stretches: &Stretches) {
        let ids = mechanism.layout().constraint_ids();
        for (id, (_, numbers)) in ids.zip(&mut self.reactions.0) {
            let own = &stretches.reactions[id.0];
            for (name, number) in &mut numbers.0 {
                let value = own.value(name, self.t, *number);
                *number = value.determined().unwrap_or(f64::NAN);
            }
        }
    }

    /// Returns the state and the reactions of a mechanism. q and v are given body by body, and the
    /// reactions of all joints and drives in the order of their rows.
    ///
    /// # Panics
    /// Panics if q and v do not belong to the mechanism.
    #[must_use]
    pub fn new(
        mechanism: &Mechanism,
        t: f64,
        q: &[f64],
        v: &[f64],
        reactions: &ChosenValues<Reaction>,
    ) -> Self {
        let bodies = mechanism.bodies().iter().enumerate();
        let bodies =
            bodies.map(|(k, b)| (b.name.clone(), state(&mechanism.frames().body(k, q, v))));
        let observed = mechanism.frames().observed();
        let markers = observed.markers.iter().enumerate();
        let markers =
            markers.map(|(k, m)| (m.name.clone(), state(&mechanism.frames().marker(k, q, v))));
        let measures = observed.measures.iter().enumerate();
        let measures = measures.map(|(k, m)| (m.name.clone(), mechanism.frames().measure(k, q, v)));
        let groups = mechanism.layout().groups.iter().zip(reactions.as_chosen());
        let reactions = groups.map(|(group, reaction)| {
            let names = group.space.components().iter().copied();
            let names = names.chain(group.spec.component);
            let numbers = reaction.components(group.space);
            let numbers = names.zip(numbers.chain(reaction.component));
            let numbers = numbers.map(|(name, value)| (name.to_owned(), value));
            (group.name.clone(), ByName(numbers.collect()))
        });
        Self {
            t,
            bodies: ByName(bodies.collect()),
            markers: ByName(markers.collect()),
            measures: ByName(measures.collect()),
            reactions: ByName(reactions.collect()),
        }
    }
}
