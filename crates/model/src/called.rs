//! Forces that are computed by a callback function of the caller: force laws of drives, wrenches on
//! bodies, and controllers that command several drives and bodies. The callback returns only
//! values. Therefore methods that need derivatives do not support these forces.
//!
//! The derivatives of a mechanism with such a force cannot be computed. Each method that needs
//! derivatives must return an error or leave its result undecided. Finite differences of the
//! callback are not used. A controller may have corners, noise or an internal state, and then
//! finite differences are wrong without a warning.
//!
//! A plan does not split such a mechanism and uses an explicit method. Callbacks must be called in
//! the thread of the caller and in the order of time. If a callback does not return a finite value,
//! the simulation ends at the stage that called the callback. A shorter step would not help, and
//! the callback may have raised an exception.

mod kernels;

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use crate::law::UndefinedValue;
use crate::space::SpaceKind;

/// Reason why a callback has no value. The message becomes the error of the simulation.
pub type CallError = Box<dyn Error + Send + Sync>;

/// Arguments of the force of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DriveState {
    /// Time (s).
    pub time: f64,
    /// The joint coordinate (m or rad).
    pub measure: f64,
    /// Rate of the joint coordinate (m/s or rad/s).
    pub rate: f64,
}

/// State of the centre of mass of a body, in ground axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BodyState {
    /// Time (s).
    pub time: f64,
    /// Position of the centre of mass (m).
    pub position: [f64; 3],
    /// Rotation matrix from the body frame to ground axes, by rows.
    pub rotation: [[f64; 3]; 3],
    /// Angle in the plane (rad), including full revolutions; 0 in space.
    pub angle: f64,
    /// Velocity of the centre of mass (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub angular_velocity: [f64; 3],
}

/// A force through the centre of mass of a body, and a torque, in ground axes. In the plane,
/// components out of the plane have no effect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force (N).
    pub force: [f64; 3],
    /// Torque (N·m).
    pub torque: [f64; 3],
}

/// A callback function. Two callbacks are equal only if one is a copy of the other.
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
    /// Returns the value for a joint coordinate, its rate and the time.
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

/// A wrench on one body. The wrench is a function of the state of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct CalledWrench(CalledFunction<BodyState, Wrench>);

impl CalledWrench {
    /// Creates a wrench from a function that satisfies the conditions of [`crate::Law::called`].
    pub fn new(
        function: impl Fn(&BodyState) -> Result<Wrench, CallError> + Send + Sync + 'static,
    ) -> Self {
        Self(CalledFunction::new(function))
    }

    /// Returns the force and torque in ground axes.
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

/// The state of a mechanism for its controller.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ControlState<'s> {
    /// Time (s).
    pub time: f64,
    /// Coordinates q, n_q values.
    pub q: &'s [f64],
    /// Velocities v, n_v values.
    pub v: &'s [f64],
    /// Joint coordinates of the drives with force laws and of the springs on joint coordinates, in
    /// the order of the forces.
    pub drives: &'s [DriveState],
    /// The centres of mass of the bodies.
    pub bodies: &'s [BodyState],
}

/// The values of a controller.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Efforts {
    /// Force (N) or torque (N·m) of each commanded drive along its joint coordinate.
    pub drives: Vec<f64>,
    /// Force and torque on each loaded body.
    pub bodies: Vec<Wrench>,
}

/// A callback that commands drives and loads bodies; see
/// [`control`](crate::MechanismDescription::control).
#[derive(Clone)]
pub struct Controller {
    function: Arc<ControlFunction>,
    /// Name of the force that reads each value. The forces of drives come first.
    pub(crate) values: Vec<String>,
    /// Number of commanded drives, and number of loaded bodies.
    sizes: [usize; 2],
}

type ControlFunction =
    dyn Fn(&ControlState<'_>, &mut Efforts) -> Result<(), CallError> + Send + Sync;

impl Controller {
    pub(crate) fn new(
        values: Vec<String>,
        sizes: [usize; 2],
        function: impl Fn(&ControlState<'_>, &mut Efforts) -> Result<(), CallError>
        + Send
        + Sync
        + 'static,
    ) -> Self {
        let function = Arc::new(function);
        Self {
            function,
            values,
            sizes,
        }
    }

    /// Returns storage for the values.
    pub(crate) fn efforts(&self) -> Efforts {
        let [drives, bodies] = self.sizes;
        Efforts {
            drives: vec![f64::NAN; drives],
            bodies: vec![Wrench::default(); bodies],
        }
    }

    /// Calls the function, and checks that it returned values for all drives.
    pub(crate) fn call(
        &self,
        state: &ControlState<'_>,
        efforts: &mut Efforts,
    ) -> Result<(), UndefinedValue> {
        if !state.q.iter().chain(state.v).all(|x| x.is_finite()) {
            return Err(UndefinedValue::Input);
        }
        efforts.drives.fill(f64::NAN);
        efforts.bodies.fill(Wrench::default());
        (self.function)(state, efforts).map_err(|why| failed(&why))?;
        let loads = efforts.bodies.iter();
        let loads = loads.flat_map(|load| load.force.iter().chain(&load.torque));
        match loads.chain(&efforts.drives).find(|x| !x.is_finite()) {
            Some(other) => Err(UndefinedValue::Returned(other.to_string())),
            None => Ok(()),
        }
    }
}

impl Efforts {
    /// Returns all values in the order of [`Controller::values`].
    pub(crate) fn values(&self, space: SpaceKind) -> impl Iterator<Item = f64> {
        let loads = self.bodies.iter().flat_map(move |load| {
            let force = &load.force[..space.n_translations()];
            let torque = &load.torque[3 - space.n_rotations()..];
            force.iter().chain(torque).copied()
        });
        self.drives.iter().copied().chain(loads)
    }
}

impl fmt::Debug for Controller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Controller")
            .field("values", &self.values)
            .finish_non_exhaustive()
    }
}

/// The values of all controllers at one state, with storage for the state.
#[derive(Clone, Debug, Default)]
pub(crate) struct Commands {
    /// Coordinates and velocities; empty without controllers.
    pub(crate) state: Vec<f64>,
    pub(crate) drives: Vec<DriveState>,
    pub(crate) bodies: Vec<BodyState>,
    /// The values of each controller.
    pub(crate) efforts: Vec<Efforts>,
    /// Whether the values belong to the current poses and velocities.
    pub(crate) are_known: bool,
}
