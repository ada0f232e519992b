//! The numbers of groups during a motion.

use model::start::scene_size;
use model::{Mechanism, Scratch, System};

use super::error::RequestError;
use super::group::Group;
use super::reactions::ReactionForms;
use crate::choices::ChosenValues;

/// Groups whose numbers are computed at successive configurations.
pub struct GroupNumbers<'m> {
    mechanism: &'m Mechanism,
    groups: Vec<Group>,
    s: Scratch,
    /// Length (m) by which torques are divided so that they can be compared with forces.
    size: f64,
}

impl<'m> GroupNumbers<'m> {
    /// Creates groups of a mechanism. The coordinates q define the size of the mechanism.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism, q: &[f64], groups: &[Group]) -> Self {
        Self {
            mechanism,
            groups: groups.to_vec(),
            s: mechanism.scratch(),
            size: scene_size(mechanism, q),
        }
    }

    /// Returns the groups.
    #[must_use]
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// Returns the values of all group components (N, N·m) at time t and coordinates q. The values
    /// are computed from the multipliers of all rows. The values of one group are consecutive, in
    /// the order of [`Group::number_names`].
    ///
    /// # Errors
    /// Returns the same errors as [`crate::judge_groups`].
    pub fn at(
        &mut self,
        t: f64,
        q: &[f64],
        multipliers: &ChosenValues<f64>,
    ) -> Result<ChosenValues<f64>, RequestError> {
        let mut values = Vec::new();
        if !self.groups.is_empty() {
            self.mechanism.pose(t, q, &mut self.s);
            self.mechanism.c(&mut self.s);
            let forms = ReactionForms::at(self.mechanism, &self.s, self.size);
            for group in &self.groups {
                let numbers = forms.numbers(group)?.into_iter();
                values.extend(numbers.map(|(_, form)| form.value(multipliers.as_chosen())));
            }
        }
        Ok(multipliers.with(values))
    }
}
