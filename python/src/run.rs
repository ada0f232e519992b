//! The rows of a run as arrays, created once.

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pfaff::refusal::Refusal;
use pfaff::report::ReactionColumn;
use pfaff::solvability::Stretches;
use pyo3::prelude::*;

use crate::fault::exception;

/// Kind, owner and quantity of a column.
pub(crate) type Column = (String, String, String);

/// Rows that are recorded during the run.
#[derive(Default)]
pub(crate) struct Recorded {
    pub(crate) t: Vec<f64>,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) trajectory: RecordedTable,
    pub(crate) reactions: RecordedTable,
    pub(crate) loads: RecordedTable,
    /// The same values for each choice, with its name.
    pub(crate) chosen: Vec<(String, Vec<f64>)>,
    /// The lowest and the highest values of the columns of reactions; empty without bounds.
    pub(crate) bounds: [Vec<f64>; 2],
    /// Names of the columns in `reactions.csv`.
    pub(crate) reaction_names: Vec<String>,
    pub(crate) document: String,
    /// Reason why the run stopped before its end.
    pub(crate) stopped: Option<Refusal>,
}

/// The numbers of a table, row by row, and its columns.
#[derive(Default)]
pub(crate) struct RecordedTable {
    pub(crate) numbers: Vec<f64>,
    pub(crate) columns: Vec<Column>,
}

impl Recorded {
    /// Completes the values of the choices: determined components have the values of the run.
    /// Values of the run that are not determined become NaN, unless `are_told` is true.
    pub(crate) fn tell_determined(
        &mut self,
        columns: &[ReactionColumn],
        stretches: &Stretches,
        are_told: bool,
    ) {
        let width = columns.len().max(1);
        for (k, number) in self.reactions.numbers.iter_mut().enumerate() {
            let (t, column) = (self.t[k / width], &columns[k % width]);
            let value = column.quantity.value(stretches, t, *number);
            if let Some(determined) = value.determined() {
                self.chosen
                    .iter_mut()
                    .for_each(|(_, own)| own[k] = determined);
            } else if !are_told {
                *number = f64::NAN;
            }
        }
    }
}

/// A run. Arrays have a row for each time.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Run {
    #[pyo3(get)]
    t: Py<PyArray1<f64>>,
    #[pyo3(get)]
    q: Py<PyArray2<f64>>,
    #[pyo3(get)]
    v: Py<PyArray2<f64>>,
    /// Trajectory, reactions and loads, each with its columns.
    tables: [(Py<PyArray2<f64>>, Vec<Column>); 3],
    /// Names and values of choices.
    chosen: Vec<(String, Py<PyArray2<f64>>)>,
    /// The lowest and the highest values.
    bounds: [Py<PyArray2<f64>>; 2],
    #[pyo3(get)]
    reaction_names: Vec<String>,
    #[pyo3(get)]
    document: String,
    stopped: Option<Refusal>,
}

impl Run {
    pub(crate) fn new(py: Python<'_>, recorded: Recorded) -> Self {
        let n = recorded.t.len();
        Self {
            q: by_rows(py, recorded.q, n),
            v: by_rows(py, recorded.v, n),
            tables: [recorded.trajectory, recorded.reactions, recorded.loads]
                .map(|table| (by_rows(py, table.numbers, n), table.columns)),
            chosen: recorded
                .chosen
                .into_iter()
                .map(|(name, numbers)| (name, by_rows(py, numbers, n)))
                .collect(),
            bounds: recorded.bounds.map(|numbers| by_rows(py, numbers, n)),
            t: recorded.t.into_pyarray(py).unbind(),
            reaction_names: recorded.reaction_names,
            document: recorded.document,
            stopped: recorded.stopped,
        }
    }
}

#[pymethods]
impl Run {
    /// The trajectory, the reactions and the loads, each with its columns.
    fn tables(&self, py: Python<'_>) -> Vec<(Py<PyArray2<f64>>, Vec<Column>)> {
        let each = self.tables.iter();
        each.map(|(numbers, columns)| (numbers.clone_ref(py), columns.clone()))
            .collect()
    }

    /// The columns of `reactions` for each choice, with its name.
    fn chosen(&self, py: Python<'_>) -> Vec<(String, Py<PyArray2<f64>>)> {
        let each = self.chosen.iter();
        each.map(|(name, numbers)| (name.clone(), numbers.clone_ref(py)))
            .collect()
    }

    /// The lowest and the highest values of `reactions` for elastic joints; without columns if no
    /// bounds were requested.
    fn bounds(&self, py: Python<'_>) -> [Py<PyArray2<f64>>; 2] {
        self.bounds.each_ref().map(|numbers| numbers.clone_ref(py))
    }

    /// The exception with the reason why the run stopped before its end, if an error stopped it.
    fn stopped(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        let refusal = self.stopped.as_ref()?;
        Some(exception(py, refusal).into_value(py).into_any())
    }
}

/// Returns an array of n rows that takes ownership of the values.
pub(crate) fn by_rows(py: Python<'_>, mut numbers: Vec<f64>, n: usize) -> Py<PyArray2<f64>> {
    let columns = numbers.len().checked_div(n).unwrap_or(0);
    numbers.truncate(n * columns);
    let array = Array2::from_shape_vec((n, columns), numbers);
    let array = array.unwrap_or_else(|_| Array2::zeros((0, 0)));
    array.into_pyarray(py).unbind()
}
