//! Components of reactions as linear forms of the multipliers.

use model::{Mechanism, Reaction, Scratch, System};

/// A component of the reaction of a joint or drive.
#[derive(Clone, Debug)]
pub struct Form {
    /// The joint or drive, as an index into the groups of the layout.
    pub group: usize,
    /// Name of the component: `Fx`, `T`, `N`, …
    pub name: &'static str,
    /// Index of the component among the components of a wrench; `None` for the named component of a
    /// joint.
    pub index: Option<usize>,
    /// Factor that converts the component to a force: 1, or 1/size for a torque.
    pub unit: f64,
    /// Nonzero coefficients. Each coefficient has the index of a row of C.
    pub coefficients: Vec<(usize, f64)>,
}

impl Form {
    /// Returns the value of this component in a reaction, as a force (N).
    #[must_use]
    pub fn of(&self, mechanism: &Mechanism, reaction: &Reaction) -> f64 {
        let value = match self.index {
            Some(k) => reaction.components(mechanism.space()).nth(k),
            None => reaction.component,
        };
        self.unit * value.unwrap_or(f64::NAN)
    }
}

/// Returns all components that are not identically zero, at the poses in `s`. A named component is
/// a torque if its row is an angle.
#[must_use]
pub fn forms(mechanism: &Mechanism, s: &Scratch, size: f64) -> Vec<Form> {
    let (layout, reactions) = (mechanism.layout(), mechanism.reactions(s));
    let mut all = Vec::new();
    for id in layout.constraint_ids() {
        let group = &layout.groups[id.0];
        let torques = group.space.torques();
        let mut add = |name: &'static str, index: Option<usize>, is_torque: bool| {
            let unit = if is_torque { 1.0 / size } else { 1.0 };
            let Some(own) = reactions.component_coefficients(id, name) else {
                return;
            };
            all.push(Form {
                group: id.0,
                name,
                index,
                unit,
                coefficients: group
                    .rows
                    .iter()
                    .zip(own.iter().map(|x| unit * x))
                    .collect(),
            });
        };
        for k in group.components() {
            add(group.space.components()[k], Some(k), torques.contains(&k));
        }
        if let Some(name) = group.spec.component {
            add(name, None, layout.is_angular(group.rows.row(0)));
        }
    }
    all
}
