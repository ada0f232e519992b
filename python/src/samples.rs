//! A scene whose data vary within their tolerances: the document of the samples, and its table.

use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1};
use pfaff::refusal::{Refusal, json};
use pfaff::tolerance::{
    ToleranceError, ToleranceOptions, ToleranceResult, ToleranceStudy, Variation, Varied,
};
use pyo3::prelude::*;

use crate::fault::{Fault, wrong};
use crate::hearing::{Hearing, heard};
use crate::options::{Size, budget, threads, tolerance as stated};
use crate::scene::{REGISTRY, Scene, Source};

/// What samples are made of.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SampleOptions {
    runs: usize,
    seed: u64,
    t: f64,
    /// Keys and by how much, as `±2%`.
    vary: Vec<(String, String)>,
    threads: Option<usize>,
    tolerance: Option<f64>,
    angle_tolerance: Option<f64>,
    max_memory: Option<Size>,
}

/// A column of the table: words or numbers, NaN for what does not exist.
#[derive(IntoPyObject)]
pub(crate) enum Values {
    Words(Vec<String>),
    Numbers(Py<PyArray1<f64>>),
}

/// Makes samples of the data within their tolerances. Returns the document of
/// `pfaff tolerance --json`, and the columns of `tolerance.csv`.
#[pyfunction]
pub(crate) fn tolerance(
    py: Python<'_>,
    scene: &Scene,
    options: SampleOptions,
) -> PyResult<(String, Vec<(String, Values)>)> {
    let scene = Arc::clone(&scene.0);
    let (document, columns) = heard(py, move |hearing| sampled(&scene, &options, hearing))?;
    let values = |of: Column| match of {
        Column::Words(words) => Values::Words(words),
        Column::Numbers(numbers) => Values::Numbers(numbers.into_pyarray(py).unbind()),
    };
    let columns = columns.into_iter().map(|(name, of)| (name, values(of)));
    Ok((document, columns.collect()))
}

enum Column {
    Words(Vec<String>),
    Numbers(Vec<f64>),
}

fn sampled(
    scene: &Source,
    options: &SampleOptions,
    hearing: &Hearing,
) -> Result<(String, Vec<(String, Column)>), Fault> {
    if !(options.t >= 0.0 && options.t.is_finite()) {
        return Err(wrong(format!("t is {}, need a time ≥ 0", options.t)));
    }
    let within = stated(options.tolerance, options.angle_tolerance);
    let budget = budget(options.max_memory.as_ref())?;
    let assembled = scene.assembled(within, budget)?;
    let failed = |e: ToleranceError| failure(scene, e);
    let vary = match &options.vary[..] {
        [] => None,
        list => {
            let read = |(key, by): &(String, String)| format!("{key}={by}").parse();
            let list: Result<Vec<Variation>, String> = list.iter().map(read).collect();
            let of = (scene.name.as_str(), scene.text.as_str());
            let vary = Varied::new(of, &REGISTRY, within, list.map_err(wrong)?);
            Some(vary.map_err(failed)?)
        }
    };
    let study = ToleranceStudy::varying(assembled, options.t, vary).map_err(failed)?;
    let asked = ToleranceOptions {
        samples: options.runs,
        seed: options.seed,
        threads: options.threads.map(threads).transpose()?,
    };
    budget.allow(study.memory(options.runs), "keeping these samples")?;
    let ends = || hearing.has_ended();
    let found = study.run(&asked, ends, |_| ()).map_err(failed)?;
    Ok((json(&found.document)?, table(&study, &found)))
}

/// The table of the samples, column by column.
fn table(study: &ToleranceStudy<'_>, found: &ToleranceResult) -> Vec<(String, Column)> {
    let reactions = &found.document.reactions;
    let is_words = |name: &str| {
        let of = name.strip_suffix(".verdict");
        name == "status" || of.is_some_and(|of| reactions.iter().any(|r| r.name == of))
    };
    let mut columns: Vec<(String, Column)> = (study.columns().into_iter())
        .map(|name| {
            let empty = if is_words(&name) {
                Column::Words(Vec::new())
            } else {
                Column::Numbers(Vec::new())
            };
            (name, empty)
        })
        .collect();
    for sample in &found.samples {
        for ((_, column), value) in columns.iter_mut().zip(study.row(sample)) {
            match column {
                Column::Words(words) => words.push(value),
                Column::Numbers(numbers) => numbers.push(value.parse().unwrap_or(f64::NAN)),
            }
        }
    }
    columns
}

fn failure(scene: &Source, error: ToleranceError) -> Fault {
    match error {
        ToleranceError::Study(e) => scene.fault(e),
        e if e.is_input() => Refusal::input(e.to_string()).coded(e.code()).into(),
        e => Refusal::stopped(e.to_string()).coded(e.code()).into(),
    }
}
