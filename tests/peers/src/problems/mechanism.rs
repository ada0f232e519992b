//! A case of the suite with planar bodies as y' = [v; a(t, q, v)], in the form that a user would
//! pass to another library. The accelerations a are computed on independent rows.

use std::cell::RefCell;

use dynamics::{KeptRowMotion, MotionError, MotionFault, PreparedMechanism, RowChoice, prepare};
use model::{Mechanism, Registry, System};
use suite::{Case, Kind, Quantity};

use crate::problem::Problem;

/// The reason why a case cannot be used for this comparison.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// The suite has no such case.
    #[error("the suite has no case `{0}`")]
    NoSuchCase(&'static str),
    /// The scene cannot be read or built.
    #[error("the scene has {0} faults")]
    Scene(usize),
    /// The start or the choice of rows failed.
    #[error("{0}")]
    Motion(#[from] MotionError),
    /// The motion on independent rows failed.
    #[error("{0}")]
    MotionFault(#[from] MotionFault),
    /// The state has another number of components.
    #[error("q and v have {found} entries, expected {expected}")]
    Size { found: usize, expected: usize },
    /// The reference is not complete.
    #[error("the reference does not know {0} entries of q and v at the end")]
    Unknown(usize),
}

/// A mechanism that is ready for a run.
pub struct MovingCase {
    /// Mechanism, start and independent rows.
    pub prepared: PreparedMechanism,
    /// Last time (s).
    pub t_end: f64,
    /// q and v at the end.
    reference: Vec<f64>,
    /// The value by which errors of velocities are divided.
    velocity_scale: f64,
}

/// The scale of the errors of velocities, which makes them comparable with those of positions.
#[derive(Clone, Copy, Debug)]
pub enum VelocityScale {
    /// No scaling.
    One,
    /// The largest velocity at the end.
    Largest,
}

impl MovingCase {
    /// Reads a case of the suite and assembles it.
    ///
    /// # Errors
    /// Returns an error if there is no such case, or if it cannot be assembled.
    pub fn find(name: &'static str, scale: VelocityScale) -> Result<Self, CaseError> {
        let case = suite::find(name).ok_or(CaseError::NoSuchCase(name))?;
        let scene = scene::read(case.name, case.scene, &Registry::standard())
            .map_err(|faults| CaseError::Scene(faults.len()))?;
        let bodies: Vec<String> = scene
            .description
            .bodies()
            .iter()
            .map(|b| b.name.clone())
            .collect();
        let mechanism = Mechanism::build(&scene.description)
            .map_err(|faults| CaseError::Scene(faults.len()))?;
        let prepared = prepare(mechanism, &scene.start, &RowChoice::Automatic)?;
        let (t_end, reference) = end_of(case, &bodies)?;
        let velocity_scale = match scale {
            VelocityScale::One => 1.0,
            VelocityScale::Largest => largest(&reference[reference.len() / 2..]),
        };
        Ok(Self {
            prepared,
            t_end,
            reference,
            velocity_scale,
        })
    }

    /// Times at which drives are not smooth.
    pub fn break_times(&self) -> &[f64] {
        &self.prepared.mechanism.layout().break_times
    }

    /// [q; v] at the start.
    ///
    /// # Errors
    /// Returns an error if the state does not have N entries.
    pub fn start<const N: usize>(&self) -> Result<[f64; N], CaseError> {
        let y = [&self.prepared.q[..], &self.prepared.v[..]].concat();
        let found = y.len();
        y.try_into()
            .map_err(|_| CaseError::Size { found, expected: N })
    }

    /// Largest error of q and v at the end; the error of v is divided by its scale.
    pub fn error(&self, y: &[f64]) -> f64 {
        let d: Vec<f64> = y.iter().zip(&self.reference).map(|(a, b)| a - b).collect();
        let (q, v) = d.split_at(d.len() / 2);
        largest(q).max(largest(v) / self.velocity_scale)
    }
}

/// Largest absolute value; NaN if one is NaN.
fn largest(x: &[f64]) -> f64 {
    x.iter()
        .fold(0.0, |m: f64, x| if x.abs() <= m { m } else { x.abs() })
}

/// The last instant of the reference as [q; v].
fn end_of(case: &Case, bodies: &[String]) -> Result<(f64, Vec<f64>), CaseError> {
    let reference = case.reference();
    let n = 3 * bodies.len();
    let mut y = vec![f64::NAN; 2 * n];
    let end = reference.instants.last().ok_or(CaseError::Unknown(2 * n))?;
    for fact in &end.facts {
        let place = match fact.quantity {
            Quantity::X | Quantity::Vx => 0,
            Quantity::Y | Quantity::Vy => 1,
            Quantity::Angle | Quantity::Omega => 2,
            _ => continue,
        };
        let level = match fact.quantity.kind() {
            Kind::Position => 0,
            _ => n,
        };
        if let Some(body) = bodies.iter().position(|name| *name == fact.of) {
            y[level + 3 * body + place] = fact.value;
        }
    }
    match y.iter().filter(|y| y.is_nan()).count() {
        0 => Ok((end.t, y)),
        unknown => Err(CaseError::Unknown(unknown)),
    }
}

/// The right-hand side.
pub struct OnKeptRows<'a> {
    motion: RefCell<KeptRowMotion<'a>>,
}

impl<'a> OnKeptRows<'a> {
    /// The right-hand side of a prepared mechanism.
    ///
    /// # Errors
    /// Same errors as [`KeptRowMotion::new`].
    pub fn new(prepared: &'a PreparedMechanism) -> Result<Self, CaseError> {
        let motion = KeptRowMotion::new(prepared)?;
        Ok(Self {
            motion: RefCell::new(motion),
        })
    }
}

impl<const N: usize> Problem<N> for OnKeptRows<'_> {
    fn rhs(&self, t: f64, y: &[f64; N], dy: &mut [f64; N]) {
        let motion = &mut *self.motion.borrow_mut();
        let n_q = motion.mechanism().layout().n_q;
        let ((q, v), (qd, a)) = (y.split_at(n_q), dy.split_at_mut(n_q));
        motion.mechanism().rate(q, v, qd);
        if motion.acceleration(t, q, v, a).is_err() {
            a.fill(f64::NAN);
        }
    }
}
