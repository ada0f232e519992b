//! A scene by every method at many tolerances: error against run time.

use std::sync::Arc;

use pfaff::model::Tolerance;
use pfaff::refusal::json;
use pfaff::report::{Provenance, WorkPrecisionDocument};
use pfaff::work_precision::{Plan, Subject, overview, provenance};
use pfaff::{RunOptions as Overrides, StudyError};
use pyo3::prelude::*;

use crate::hearing::heard;
use crate::options::budget;
use crate::scene::Scene;

/// Makes the runs of `pfaff work-precision`, and returns its document. `quick` are three
/// tolerances, `all` every method with every stabilisation.
#[pyfunction]
#[pyo3(signature = (scene, quick, all))]
pub(crate) fn work_precision(
    py: Python<'_>,
    scene: &Scene,
    quick: bool,
    all: bool,
) -> PyResult<String> {
    let scene = Arc::clone(&scene.0);
    heard(py, move |hearing| {
        let fault = |e: StudyError| scene.fault(e);
        let study = scene.assembled(Tolerance::default(), budget(None)?)?;
        let study = study.prepare(&Overrides::default()).map_err(fault)?;
        let subject = Subject::of_study(study).map_err(fault)?;
        let plan = match (quick, all) {
            (true, _) => Plan::quick(),
            (false, true) => Plan::everything(),
            (false, false) => Plan::standard(),
        };
        let ends = || hearing.has_ended();
        let row = |_: &_| Ok::<(), StudyError>(());
        let compared = subject.compare(&plan, &[], &ends, row).map_err(fault)?;
        let document = WorkPrecisionDocument {
            provenance: Provenance {
                machine: provenance::machine(),
                versions: format!("pfaff {}", env!("CARGO_PKG_VERSION")),
                date: provenance::date(),
                command: "called from Python".to_owned(),
            },
            partial: compared.interrupted,
            summary: overview(std::slice::from_ref(&compared.scene)),
            scenes: vec![compared.scene],
        };
        Ok(json(&document)?)
    })
}
