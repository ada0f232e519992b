//! Forces that call a function of the caller: of the laws of drives, and of wrenches on bodies,
//! values alone are known. Nothing that needs derivatives works with them.

mod kernels;

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use crate::law::UndefinedValue;

/// Why a called function has no value; its message ends the run.
pub type CallError = Box<dyn Error + Send + Sync>;

/// What the force of a drive depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DriveState {
    /// Time (s).
    pub time: f64,
    /// The measure (m or rad).
    pub measure: f64,
    /// Its rate (m/s or rad/s).
    pub rate: f64,
}

/// The state of a body, of its centre of mass, in ground axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodyState {
    /// Time (s).
    pub time: f64,
    /// Place of the centre of mass (m).
    pub position: [f64; 3],
    /// From the frame of the body to ground axes, by rows.
    pub rotation: [[f64; 3]; 3],
    /// Angle in the plane (rad), not reduced to one revolution; 0 in space.
    pub angle: f64,
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub angular_velocity: [f64; 3],
}

/// A force through the centre of mass of a body, and a torque, in ground axes. In the plane the
/// components out of it do nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force (N).
    pub force: [f64; 3],
    /// Torque (N·m).
    pub torque: [f64; 3],
}

/// A function that is called. It is equal to its copies only.
pub(crate) struct CalledFunction<I, O>(Arc<Callback<I, O>>);

type Callback<I, O> = dyn Fn(&I) -> Result<O, CallError> + Send + Sync;

impl<I, O> CalledFunction<I, O> {
    pub(crate) fn new(
        function: impl Fn(&I) -> Result<O, CallError> + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(function))
    }
}

impl<I, O> Clone for CalledFunction<I, O> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<I, O> PartialEq for CalledFunction<I, O> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<I, O> fmt::Debug for CalledFunction<I, O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("CalledFunction(..)")
    }
}

fn failed(why: &CallError) -> UndefinedValue {
    UndefinedValue::Failed(why.to_string())
}

impl CalledFunction<DriveState, f64> {
    /// Its value for measure, rate and time.
    pub(crate) fn value(&self, [measure, rate, time]: [f64; 3]) -> Result<f64, UndefinedValue> {
        if !(measure.is_finite() && rate.is_finite()) {
            return Err(UndefinedValue::Input);
        }
        let state = DriveState {
            time,
            measure,
            rate,
        };
        match (self.0)(&state).map_err(|why| failed(&why))? {
            force if force.is_finite() => Ok(force),
            other => Err(UndefinedValue::Returned(other.to_string())),
        }
    }
}

/// A wrench on one body by a function of its state.
#[derive(Clone, Debug, PartialEq)]
pub struct CalledWrench(CalledFunction<BodyState, Wrench>);

impl CalledWrench {
    /// The wrench that a function returns, under the conditions of [`crate::Law::called`].
    pub fn new(
        function: impl Fn(&BodyState) -> Result<Wrench, CallError> + Send + Sync + 'static,
    ) -> Self {
        Self(CalledFunction::new(function))
    }

    /// Force and torque in ground axes.
    fn value(&self, state: &BodyState) -> Result<Wrench, UndefinedValue> {
        let [r, v, omega] = [state.position, state.velocity, state.angular_velocity];
        if !r.iter().chain(&v).chain(&omega).all(|x| x.is_finite()) {
            return Err(UndefinedValue::Input);
        }
        let found = (self.0.0)(state).map_err(|why| failed(&why))?;
        let Wrench { force, torque } = found;
        if force.iter().chain(&torque).all(|x| x.is_finite()) {
            Ok(found)
        } else {
            Err(UndefinedValue::Returned(format!(
                "the force {force:?} and the torque {torque:?}"
            )))
        }
    }
}
