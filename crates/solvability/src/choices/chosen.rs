//! Numbers of one solution among several. The type of these numbers marks them as chosen.

use super::{Label, NamedChoice};

/// Numbers of one solution of the equations of motion. The solution has zero multipliers in some
/// rows, or a named choice selects it. The verdicts decide which of these numbers are the same in
/// every solution; the numbers themselves do not show it. The type therefore returns the numbers
/// only by a method whose name marks them as chosen.
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
    /// Name of the choice; `None` if the dropped rows define the choice.
    label: Option<Label>,
}

impl<T> ChosenValues<T> {
    /// Creates the numbers of the solution in which these rows (from 0) have no multiplier.
    #[must_use]
    pub fn new(values: Vec<T>, dropped: Vec<usize>) -> Self {
        Self {
            values,
            dropped,
            label: None,
        }
    }

    /// Creates the numbers of this choice.
    #[must_use]
    pub fn by(values: Vec<T>, choice: &NamedChoice) -> Self {
        Self {
            values,
            dropped: choice.choice.eliminated().to_vec(),
            label: Some(choice.label.clone()),
        }
    }

    /// Creates other numbers of the same choice.
    #[must_use]
    pub fn with<U>(&self, values: Vec<U>) -> ChosenValues<U> {
        ChosenValues {
            values,
            dropped: self.dropped.clone(),
            label: self.label.clone(),
        }
    }

    /// Returns the name of the choice; `None` if the dropped rows define the choice.
    #[must_use]
    pub fn label(&self) -> Option<&Label> {
        self.label.as_ref()
    }

    /// Returns the numbers of this choice.
    #[must_use]
    pub fn as_chosen(&self) -> &[T] {
        &self.values
    }

    /// Returns the rows whose multipliers are zero by choice, from 0, ascending.
    #[must_use]
    pub fn dropped(&self) -> &[usize] {
        &self.dropped
    }

    /// Sets the dropped rows for the numbers that are written next.
    pub fn choose(&mut self, dropped: &[usize]) {
        self.dropped.clear();
        self.dropped.extend_from_slice(dropped);
    }

    /// Returns the numbers of this choice as a buffer that the solver overwrites.
    pub fn to_be_written(&mut self) -> &mut [T] {
        &mut self.values
    }
}
