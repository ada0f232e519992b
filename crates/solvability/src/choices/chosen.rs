//! Numbers of one solution among all: their type says so.

use super::{Label, NamedChoice};

/// Numbers that belong to one solution of the equations of motion: that in which the multipliers of
/// some rows are zero, or that of a named choice. Which of them are the same in every solution is a
/// question for the verdicts; the numbers alone do not say it, so they are given only to a caller
/// who says that they are chosen.
///
/// ```
/// use pfaff_solvability::ChosenValues;
/// let lambda = ChosenValues::new(vec![3.0, 0.0], vec![1]);
/// assert_eq!(lambda.dropped(), [1]);
/// assert_eq!(lambda.as_chosen(), [3.0, 0.0]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenValues<T> {
    values: Vec<T>,
    dropped: Vec<usize>,
    /// Name of the choice; `None` if the choice is that of the dropped rows.
    label: Option<Label>,
}

impl<T> ChosenValues<T> {
    /// Numbers of the solution in which these rows (from 0) have no multiplier.
    #[must_use]
    pub fn new(values: Vec<T>, dropped: Vec<usize>) -> Self {
        Self {
            values,
            dropped,
            label: None,
        }
    }

    /// Numbers of this choice.
    #[must_use]
    pub fn by(values: Vec<T>, choice: &NamedChoice) -> Self {
        Self {
            values,
            dropped: choice.choice.eliminated().to_vec(),
            label: Some(choice.label.clone()),
        }
    }

    /// Other numbers of the same choice.
    #[must_use]
    pub fn with<U>(&self, values: Vec<U>) -> ChosenValues<U> {
        ChosenValues {
            values,
            dropped: self.dropped.clone(),
            label: self.label.clone(),
        }
    }

    /// The name of the choice; `None` if it is that of the dropped rows.
    #[must_use]
    pub fn label(&self) -> Option<&Label> {
        self.label.as_ref()
    }

    /// The numbers, of this choice.
    #[must_use]
    pub fn as_chosen(&self) -> &[T] {
        &self.values
    }

    /// The rows whose multipliers are zero by choice, from 0, ascending.
    #[must_use]
    pub fn dropped(&self) -> &[usize] {
        &self.dropped
    }

    /// States for which rows the numbers are that are written next.
    pub fn choose(&mut self, dropped: &[usize]) {
        self.dropped.clear();
        self.dropped.extend_from_slice(dropped);
    }

    /// The numbers of this choice, to be written by whoever solves for them.
    pub fn to_be_written(&mut self) -> &mut [T] {
        &mut self.values
    }
}
