//! The state of a mechanism for Python, and a Python function that controls a run.

use std::sync::Arc;

use numpy::PyArray1;
use pfaff::Study;
use pfaff::model::{AnyDescription, BodyRef, ControlState, Efforts, Mechanism, System};
use pyo3::prelude::*;

use crate::fault::{Fault, wrong};
use crate::functions::{Arguments, Call, number, state, wrench};
use crate::hearing::Hearing;
use crate::options::unknown;

/// The positions, joint coordinates and measures of a mechanism at any state.
#[pyclass(frozen, module = "pfaff._pfaff")]
pub(crate) struct Kinematics(Mechanism);

impl Kinematics {
    pub(crate) fn of(mechanism: &Mechanism) -> Self {
        Self(mechanism.clone())
    }

    fn check(&self, q: &[f64], v: &[f64]) -> PyResult<()> {
        let checked = pfaff::solvability::check_state(&self.0, 0.0, q, v);
        checked.map_err(|e| Python::attach(|py| wrong(e.to_string()).raised(py)))
    }
}

#[pymethods]
impl Kinematics {
    /// The names of the bodies, of the drives by laws with the springs on joint coordinates, and of
    /// the measures.
    fn names(&self) -> [Vec<String>; 3] {
        let bodies = self.0.bodies().iter().map(|body| body.name.clone());
        let laws = self.0.applied_forces().law_drives();
        let measures = self.0.frames().observed().measures.iter();
        [
            bodies.collect(),
            laws.map(|(name, _)| name.to_owned()).collect(),
            measures.map(|measure| measure.name.clone()).collect(),
        ]
    }

    /// The time of the start (s).
    #[getter]
    fn start_time(&self) -> f64 {
        self.0.layout().start_time
    }

    /// What each coordinate and each velocity is, in words.
    fn words(&self) -> [Vec<String>; 2] {
        let layout = self.0.layout();
        let q = (0..layout.n_q).map(|k| self.0.coordinate_name(k));
        let v = (0..layout.n_v).map(|k| self.0.coordinate(k));
        let words = |(body, what): (&str, &str)| format!("{body}: {what}");
        [q.map(words).collect(), v.map(words).collect()]
    }

    /// The state of the centre of mass of a body.
    fn body(&self, py: Python<'_>, body: usize, q: Vec<f64>, v: Vec<f64>) -> PyResult<Arguments> {
        self.check(&q, &v)?;
        let mut s = self.0.scratch();
        self.0.pose(0.0, &q, &mut s);
        let found = self.0.body_states(&s, &v).nth(body);
        let found = found.ok_or_else(|| wrong(format!("there is no body {body}")).raised(py))?;
        state(py, self.0.space(), &found)
    }

    /// The joint coordinates of the drives by laws and their rates.
    fn coordinates(&self, t: f64, q: Vec<f64>, v: Vec<f64>) -> PyResult<Vec<[f64; 2]>> {
        self.check(&q, &v)?;
        let mut s = self.0.scratch();
        self.0.pose(t, &q, &mut s);
        self.0.twist(&v, &mut s);
        let drives = self.0.drive_states(&s);
        Ok(drives.map(|drive| [drive.measure, drive.rate]).collect())
    }

    /// The measures and their rates.
    fn measures(&self, q: Vec<f64>, v: Vec<f64>) -> PyResult<Vec<[f64; 2]>> {
        self.check(&q, &v)?;
        let count = self.0.frames().observed().measures.len();
        let all = (0..count).map(|k| self.0.frames().measure_rates(k, &q, &v));
        Ok(all.map(|[value, rate, _]| [value, rate]).collect())
    }
}

/// Time, coordinates, velocities, and the joint coordinates of drives by laws with their rates.
type StateArguments = (f64, Py<PyArray1<f64>>, Py<PyArray1<f64>>, Vec<[f64; 2]>);

/// Adds a Python function to the description of a study. The function is called once at the start:
/// its result names the drives that it commands and the bodies on which it acts.
pub(crate) fn control(
    function: Py<PyAny>,
    study: &Study,
    description: &mut AnyDescription,
    hearing: &Arc<Hearing>,
) -> Result<(), Fault> {
    let call = Call::new("the controller".to_owned(), function, hearing);
    let prepared = &study.prepared;
    let mechanism = &prepared.mechanism;
    let mut s = mechanism.scratch();
    let t = prepared.start_time();
    mechanism.pose(t, &prepared.q, &mut s);
    mechanism.twist(&prepared.v, &mut s);
    let drives = mechanism.drive_states(&s);
    let drives: Vec<[f64; 2]> = drives.map(|drive| [drive.measure, drive.rate]).collect();
    let mut names = Vec::new();
    let begun = call.value(
        t,
        |py| Ok(arguments(py, (t, &prepared.q, &prepared.v), &drives)),
        |found| {
            names = found.extract::<(Vec<String>, Vec<Py<PyAny>>)>()?.0;
            Ok(())
        },
    );
    if let Some(raised) = hearing.raised() {
        return Err(raised.into());
    }
    begun.map_err(|e| wrong(format!("the controller: {e}")))?;
    let laws: Vec<String> = description.laws().map(str::to_owned).collect();
    let bodies = description.bodies();
    let (mut commanded, mut loaded) = (Vec::new(), Vec::new());
    for name in &names {
        let body = bodies.iter().position(|body| body.name == *name);
        match (laws.contains(name), body) {
            (true, Some(_)) => {
                return Err(wrong(format!(
                    "`{name}` is a drive and a body: rename one of them"
                )));
            }
            (true, None) => commanded.push(name.as_str()),
            (false, Some(body)) => loaded.push((name.as_str(), BodyRef::Body(body))),
            (false, None) => {
                let known = laws.iter().chain(bodies.iter().map(|body| &body.name));
                let known: Vec<&str> = known.map(String::as_str).collect();
                return Err(unknown("drive by a law or body", name, &known));
            }
        }
    }
    let space = description.space();
    let place = |name: &str| {
        names
            .iter()
            .position(|known| known == name)
            .unwrap_or_default()
    };
    let of_drives: Vec<usize> = commanded.iter().map(|name| place(name)).collect();
    let of_bodies: Vec<usize> = loaded.iter().map(|(name, _)| place(name)).collect();
    let refs: Vec<BodyRef> = loaded.iter().map(|(_, body)| *body).collect();
    let expected = names.clone();
    let evaluate = move |state: &ControlState<'_>, efforts: &mut Efforts| {
        let drives = state.drives.iter().map(|at| [at.measure, at.rate]);
        let drives: Vec<[f64; 2]> = drives.collect();
        let (t, q, v) = (state.time, state.q, state.v);
        call.value(
            t,
            |py| Ok(arguments(py, (t, q, v), &drives)),
            |found| {
                let (names, values): (Vec<String>, Vec<Bound<'_, PyAny>>) = found.extract()?;
                if names != expected {
                    let (now, before) = (names.join(", "), expected.join(", "));
                    return Err(format!(
                        "it returned values for [{now}], at the start for [{before}]"
                    )
                    .into());
                }
                for (effort, &k) in efforts.drives.iter_mut().zip(&of_drives) {
                    *effort = number(&values[k])?;
                }
                for (load, &k) in efforts.bodies.iter_mut().zip(&of_bodies) {
                    *load = wrench(space, &values[k])?;
                }
                Ok(())
            },
        )
    };
    let added = description.control(&commanded, &refs, evaluate);
    added.map_err(|e| wrong(e.to_string()))
}

fn arguments(
    py: Python<'_>,
    (t, q, v): (f64, &[f64], &[f64]),
    drives: &[[f64; 2]],
) -> StateArguments {
    let array = |x: &[f64]| PyArray1::from_slice(py, x).unbind();
    (t, array(q), array(v), drives.to_vec())
}
