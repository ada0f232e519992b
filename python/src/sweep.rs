//! Many runs of one scene, performed in shards and read as columns.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use numpy::IntoPyArray;
use pfaff::refusal::{Refusal, json};
use pfaff::report::SweepDocument;
use pfaff::report::sweep::{Cell, Extent, Kind, Records, Shards};
use pfaff::sweep::{Axis, Shard, SweepError, SweepProgress, SweepSettings, Tables};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::fault::{Fault, guarded, wrong};
use crate::hearing::{Hearing, heard};
use crate::scene::REGISTRY;

/// Time between two checks for signals and for a request to stop.
const LOOK: Duration = Duration::from_millis(20);

/// Time between two reports of progress.
const REPORT: Duration = Duration::from_millis(100);

/// A scene with its varied numbers.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Sweep(Arc<Described>);

/// A sweep with the text of its scene.
struct Described {
    name: String,
    text: String,
    of: pfaff::sweep::Sweep<'static>,
}

impl From<SweepError> for Fault {
    fn from(error: SweepError) -> Self {
        refused(("", ""), error)
    }
}

/// Adds positions in the text to an error about the scene.
fn refused(source: (&str, &str), error: SweepError) -> Fault {
    let error = match error {
        SweepError::Study(error) => return Refusal::of(source, error).into(),
        other => other,
    };
    Refusal::from(error).into()
}

#[pymethods]
impl Sweep {
    #[new]
    fn new(
        py: Python<'_>,
        name: String,
        text: String,
        vary: Vec<String>,
        keep_rows: bool,
    ) -> PyResult<Self> {
        heard(py, move |_| {
            let axes = vary.iter().map(|text| text.parse::<Axis>());
            let axes = axes
                .collect::<Result<Vec<_>, _>>()
                .map_err(SweepError::from)?;
            let of = pfaff::sweep::Sweep::read(&name, &text, &REGISTRY, axes);
            let of = of.map_err(|e| refused((&name, &text), e))?;
            let of = if keep_rows { of.keeping_rows() } else { of };
            Ok(Self(Arc::new(Described { name, text, of })))
        })
    }

    /// Number of runs of all shards.
    #[getter]
    fn runs(&self) -> u64 {
        self.0.of.runs()
    }

    /// Performs a run without writing any file, and returns its time (s).
    fn seconds(&self, py: Python<'_>, run: u64) -> PyResult<f64> {
        let own = Arc::clone(&self.0);
        heard(py, move |_| {
            if !(1..=own.of.runs()).contains(&run) {
                return Err(wrong(format!("there is no run {run}")));
            }
            let begun = Instant::now();
            drop(own.of.row(run));
            Ok(begun.elapsed().as_secs_f64())
        })
    }

    /// Returns the number of shards of a directory, if its files determine it.
    fn shards(&self, py: Python<'_>, directory: PathBuf) -> PyResult<Option<u64>> {
        guarded(py, || {
            // Either no run has begun, or the state of begun runs is checked when runs are
            // performed.
            let known = Shards::find(&directory).and_then(|shards| shards.sealed());
            Ok(Shard::number(self.0.of.runs(), &known.unwrap_or_default()))
        })
    }

    /// Returns the shards, of n, that are not finished.
    fn unfinished(&self, py: Python<'_>, directory: PathBuf, n: u64) -> PyResult<Vec<u64>> {
        guarded(py, || {
            let all = self.0.of.runs();
            let known = Shards::find(&directory).and_then(|shards| shards.sealed());
            let known = known.unwrap_or_default();
            let mut left = Vec::new();
            for k in 1..=n {
                let shard = Shard::new(k, n).map_err(|e| wrong(e.to_string()))?;
                let runs = shard.runs(all);
                if runs.is_some_and(|runs| !runs.without(&known).is_empty()) {
                    left.push(k);
                }
            }
            Ok(left)
        })
    }

    /// Performs the unfinished runs of a shard. Returns the summary of the shard, the number of
    /// runs that were performed, and whether the tables of all runs were written.
    ///
    /// `on_runs` receives the number of finished runs and of failed runs among them, from time to
    /// time; the shard ends if `on_runs` or `stop` returns `True`.
    #[pyo3(signature = (directory, k, n, threads, on_runs, stop))]
    #[allow(clippy::too_many_arguments)]
    fn make(
        &self,
        py: Python<'_>,
        directory: PathBuf,
        k: u64,
        n: u64,
        threads: usize,
        on_runs: Option<Py<PyAny>>,
        stop: Option<Py<PyAny>>,
    ) -> PyResult<(String, u64, bool)> {
        guarded(py, || {
            let shard = Shard::new(k, n).map_err(|e| wrong(e.to_string()))?;
            let settings = SweepSettings { shard, threads };
            let hearing = Hearing::new();
            let (mut made, mut count, mut failed) = (0, 0, 0);
            let mut reported = Instant::now();
            let note = |progress: SweepProgress<'_>| {
                match progress {
                    SweepProgress::Begin { finished, .. } => count = finished,
                    SweepProgress::Finished(row) => {
                        made += 1;
                        count += 1;
                        failed += u64::from(row.status.is_failure());
                    }
                }
                if let Some(on_runs) = &on_runs
                    && reported.elapsed() > REPORT
                {
                    hearing.call(|py| on_runs.call1(py, (count, failed)));
                    reported = Instant::now();
                }
            };
            let outcome = thread::scope(|scope| {
                let (done, is_done) = channel();
                let hearing = &hearing;
                let interrupted = move || hearing.has_ended();
                let directory = &directory;
                let work = move || {
                    let outcome = self.0.of.run_into(directory, &settings, interrupted, note);
                    // The calling thread waits for this message.
                    let _ = done.send(());
                    outcome.map_err(|e| refused((&self.0.name, &self.0.text), e))
                };
                // Python receives signals only on this thread, which may be the main thread.
                let worker = scope.spawn(work);
                while is_done.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                    if worker.is_finished() {
                        break;
                    }
                    hearing.ends();
                    if let Some(stop) = &stop {
                        hearing.call(|py| stop.call0(py));
                    }
                }
                worker.join()
            });
            let outcome = outcome.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            if let Some(raised) = hearing.raised() {
                return Err(raised.into());
            }
            let outcome = outcome?;
            let has_tables = outcome.tables == Tables::Written;
            Ok((json(&outcome.document)?, made, has_tables))
        })
    }
}

/// Deletes the rows of runs that ended their process, so that these runs are repeated. Returns the
/// number of these runs.
#[pyfunction]
pub(crate) fn forget_crashed(py: Python<'_>, directory: PathBuf) -> PyResult<u64> {
    heard(py, move |_| Ok(pfaff::sweep::forget_crashed(&directory)?))
}

/// Writes the tables of the results in some directories. Returns the summary of the tables.
#[pyfunction]
pub(crate) fn merge(py: Python<'_>, directories: Vec<PathBuf>, into: PathBuf) -> PyResult<String> {
    heard(py, move |_| {
        let merged = pfaff::sweep::merge(&directories, &into).map_err(Fault::from)?;
        Ok(json(&merged.document)?)
    })
}

/// Names and values of columns.
type Columns = Vec<(String, Py<PyAny>)>;

/// Returns the summary of the results in a directory, and its columns: counts as integers, or with
/// NaN if some are unknown, numbers, and lists of texts.
#[pyfunction]
pub(crate) fn sweep_columns(py: Python<'_>, directory: PathBuf) -> PyResult<(String, Columns)> {
    let (document, records) = heard(py, move |_| {
        let records = Records::merged(&[&directory]).map_err(SweepError::from)?;
        Ok((json(&SweepDocument::new(&records, Extent::Whole))?, records))
    })?;
    let columns = records.plan.columns().into_iter().enumerate();
    let columns = columns.map(|(k, column)| {
        let cells = records.rows.values().filter_map(|cells| cells.get(k));
        let values = match column.kind {
            Kind::Count => {
                let counts: Vec<Option<i64>> = cells.map(count).collect();
                match counts.iter().copied().collect::<Option<Vec<i64>>>() {
                    Some(counts) => counts.into_pyarray(py).into_any(),
                    None => {
                        let known = |n: Option<i64>| n.map_or(f64::NAN, |n| n as f64);
                        let counts: Vec<f64> = counts.into_iter().map(known).collect();
                        counts.into_pyarray(py).into_any()
                    }
                }
            }
            Kind::Number => {
                let numbers: Vec<f64> = cells.map(number).collect();
                numbers.into_pyarray(py).into_any()
            }
            Kind::Text => {
                let texts: Vec<&str> = cells.map(text).collect();
                PyList::new(py, texts)?.into_any()
            }
        };
        Ok((column.name, values.unbind()))
    });
    Ok((document, columns.collect::<PyResult<_>>()?))
}

fn count(cell: &Cell) -> Option<i64> {
    match cell {
        Cell::Count(n) => n.and_then(|n| i64::try_from(n).ok()),
        _ => None,
    }
}

fn number(cell: &Cell) -> f64 {
    match cell {
        Cell::Number(x) => *x,
        _ => f64::NAN,
    }
}

fn text(cell: &Cell) -> &str {
    match cell {
        Cell::Text(text) => text,
        _ => "",
    }
}
