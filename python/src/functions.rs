//! Python functions as laws of drives and as forces on bodies, for one run.

use std::sync::Arc;

use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLikeDyn, PyUntypedArrayMethods};
use pfaff::Study;
use pfaff::model::description::SetLawError;
use pfaff::model::{
    AnyDescription, BodyRef, BodyState, CallError, Law, SpaceKind, Wrench, words::rounded,
};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};

use crate::control::control;
use crate::fault::{Fault, wrong};
use crate::hearing::Hearing;
use crate::options::unknown;

/// Functions by the names of drives and of bodies.
pub(crate) struct Functions {
    pub(crate) drives: Vec<(String, Py<PyAny>)>,
    pub(crate) forces: Vec<(String, Py<PyAny>)>,
    /// A function of the whole state.
    pub(crate) controller: Option<Py<PyAny>>,
}

impl Functions {
    pub(crate) fn is_empty(&self) -> bool {
        self.drives.is_empty() && self.forces.is_empty() && self.controller.is_none()
    }

    /// Adds the functions to a description. The functions are called until a function raises an
    /// exception. `hearing` stores this exception.
    pub(crate) fn put_into(
        self,
        description: &mut AnyDescription,
        study: &Study,
        hearing: &Arc<Hearing>,
    ) -> Result<(), Fault> {
        if let Some(controller) = self.controller {
            control(controller, study, description, hearing)?;
        }
        for (name, function) in self.drives {
            let call = Call::new(format!("the function of drive `{name}`"), function, hearing);
            let law = Law::called(move |at| {
                let state = (at.time, at.measure, at.rate);
                call.value(at.time, |_| Ok(state), number)
            });
            match description.set_law(&name, &law) {
                Ok(()) => {}
                Err(SetLawError::Unknown { name }) => {
                    let known: Vec<&str> = description.laws().collect();
                    if known.is_empty() {
                        return Err(wrong(format!(
                            "there is no drive `{name}`: the scene has no drive by a law; add one to a joint, with `torque = 0` or `force = 0`"
                        )));
                    }
                    return Err(unknown("drive by a law", &name, &known));
                }
                Err(other) => return Err(wrong(other.to_string())),
            }
        }
        let (bodies, space) = (description.bodies(), description.space());
        for (name, function) in self.forces {
            let Some(body) = bodies.iter().position(|body| body.name == name) else {
                let known: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
                return Err(unknown("body", &name, &known));
            };
            let call = Call::new(format!("the function of body `{name}`"), function, hearing);
            let own = format!("push on {name}");
            description.called_force(&own, BodyRef::Body(body), move |at| {
                call.value(at.time, |py| state(py, space, at), |x| wrench(space, x))
            });
        }
        Ok(())
    }
}

/// A function that a run calls.
pub(crate) struct Call {
    /// Description for messages, such as "the function of drive `motor`".
    subject: String,
    function: Py<PyAny>,
    hearing: Arc<Hearing>,
}

impl Call {
    pub(crate) fn new(subject: String, function: Py<PyAny>, hearing: &Arc<Hearing>) -> Self {
        Self {
            subject,
            function,
            hearing: Arc::clone(hearing),
        }
    }

    /// Calls the function with its arguments, and converts the result by `read`. An exception in
    /// the function ends the run.
    pub(crate) fn value<A, T>(
        &self,
        time: f64,
        arguments: impl FnOnce(Python<'_>) -> PyResult<A>,
        read: impl FnOnce(&Bound<'_, PyAny>) -> Result<T, CallError>,
    ) -> Result<T, CallError>
    where
        A: for<'py> pyo3::call::PyCallArgs<'py>,
    {
        if self.hearing.has_raised() {
            return Err("an exception has ended the run".into());
        }
        Python::attach(|py| {
            let called = arguments(py).and_then(|a| self.function.bind(py).call1(a));
            let raised = match called {
                Ok(found) => return read(&found),
                Err(raised) => raised,
            };
            // Python 3.11 and later support notes.
            let note = format!("in {} at t = {} s", self.subject, rounded(time));
            let _ = raised.value(py).call_method1("add_note", (note,));
            let words = raised.to_string();
            self.hearing.end(Some(raised));
            Err(words.into())
        })
    }
}

/// Reads one number: a float, or a value that NumPy converts to a float.
pub(crate) fn number(found: &Bound<'_, PyAny>) -> Result<f64, CallError> {
    if let Ok(found) = found.cast_exact::<PyFloat>() {
        return Ok(found.value());
    }
    let is_one = found
        .getattr("shape")
        .is_ok_and(|shape| shape.cast::<PyTuple>().is_ok_and(|shape| shape.is_empty()));
    let is_array = found.hasattr("shape").unwrap_or(false);
    match found.extract::<f64>() {
        Ok(number) if is_one || !is_array => Ok(number),
        _ => Err(other(found, "one number")),
    }
}

/// Reads the force and the torque from an array.
pub(crate) fn wrench(space: SpaceKind, found: &Bound<'_, PyAny>) -> Result<Wrench, CallError> {
    let (n, needed) = match space {
        SpaceKind::Space3 => (6, "6 numbers: a force and a torque"),
        _ => (3, "3 numbers: a force, 2, and a torque"),
    };
    let array = found.extract::<PyArrayLikeDyn<'_, f64, AllowTypeChange>>();
    let array = array.map_err(|_| other(found, needed))?;
    if array.shape() != [n] {
        return Err(other(array.as_any(), needed));
    }
    let array = array.as_array();
    let x: Vec<f64> = array.iter().copied().collect();
    Ok(match x[..] {
        [fx, fy, fz, tx, ty, tz] => Wrench {
            force: [fx, fy, fz],
            torque: [tx, ty, tz],
        },
        [fx, fy, t, ..] => Wrench {
            force: [fx, fy, 0.0],
            torque: [0.0, 0.0, t],
        },
        _ => Wrench::default(),
    })
}

/// Describes a returned value of a wrong type or size.
fn other(found: &Bound<'_, PyAny>, needed: &str) -> CallError {
    let shape = found.getattr("shape").and_then(|shape| shape.str());
    let what = match (found.is_none(), shape, found.get_type().name()) {
        (true, ..) => "None".to_owned(),
        (_, Ok(shape), _) => format!("an array of shape {shape}"),
        (_, _, Ok(name)) => format!("`{name}`"),
        _ => "an object".to_owned(),
    };
    format!("it returned {what}, need {needed}").into()
}

/// Returns the time, then position, rotation, velocity, angle and angular velocity of a body. In
/// the plane, vectors have two components.
pub(crate) fn state<'py>(py: Python<'py>, space: SpaceKind, at: &BodyState) -> PyResult<Arguments> {
    let n = space.n_translations();
    let vector = |x: &[f64; 3]| PyArray1::from_slice(py, &x[..n]).into_any().unbind();
    let rows: Vec<Vec<f64>> = at.rotation[..n].iter().map(|r| r[..n].to_vec()).collect();
    let turn = PyArray2::from_vec2(py, &rows)?.into_any().unbind();
    let [.., spin] = at.angular_velocity;
    let (angle, spin) = match space {
        SpaceKind::Space3 => (f64::NAN, vector(&at.angular_velocity)),
        _ => (at.angle, PyFloat::new(py, spin).into_any().unbind()),
    };
    let (place, velocity) = (vector(&at.position), vector(&at.velocity));
    Ok((at.time, place, turn, angle, velocity, spin))
}

pub(crate) type Arguments = (f64, Py<PyAny>, Py<PyAny>, f64, Py<PyAny>, Py<PyAny>);
