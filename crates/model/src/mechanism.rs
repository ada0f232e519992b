//! The assembled mechanism: a list of elements. Each element has its bodies, its rows and its
//! entries in the matrices. The build checks for all errors, so a built mechanism is always valid.

mod armature;
mod build;
mod build_error;
mod check;
mod commands;
mod counted;
mod derivatives;
mod elements;
mod forces;
mod holds;
mod initial;
mod kernels;
mod loads;
mod part;
mod same;
mod spins;
mod states;
mod time_function;
mod turn;
mod work;

use crate::body::BodyRecord;
use crate::group::ConstraintId;
use crate::observed::Observables;
use crate::rounding::are_apart;
use crate::space::{Space, SpaceKind, in_space};
use crate::system::{Layout, Scratch};
use crate::tolerance::Tolerance;

pub use armature::{InertiaAt, JointArmature};
pub use build::Buildable;
pub use build_error::BuildError;
pub use derivatives::{Derivatives, Sparse};
pub(crate) use elements::{Elements, KernelInput};
pub use forces::{
    AppliedForce, AppliedForces, DerivativeGap, ForceWithoutDerivatives, Push, UndefinedForce,
};
pub(crate) use initial::{initialise, unmet_requirement, unmet_rows};
pub(crate) use kernels::gyroscopic;
pub use loads::{ForceMeasure, Load, Loads};
pub use part::{Part, Places};
pub use time_function::{FunctionForm, TimeFunction};
pub use work::Work;

/// A mechanism: bodies, constraints, forces, and the equations of motion.
///
/// ```
/// use joints::Revolute;
/// use pfaff_model::{Body, BodyRef, Description, Joint, Mechanism, System};
/// // A pendulum of length 2 hanging straight down, moving with 1 rad/s.
/// let pendulum = Description {
///     gravity: [0.0, -9.81],
///     bodies: vec![Body {
///         name: "bob".into(),
///         mass: 1.0,
///         inertia: 0.1,
///         position: [0.0, -2.0],
///         ..Body::default()
///     }],
///     joints: vec![Joint::new(
///         "pivot",
///         &[BodyRef::Ground, BodyRef::Body(0)],
///         Revolute { s_i: [0.0, 0.0], s_j: [0.0, 2.0] },
///     )],
///     ..Description::default()
/// };
/// let mechanism = Mechanism::build(&pendulum).unwrap();
/// let mut s = mechanism.scratch();
/// mechanism.pose(0.0, &[0.0, -2.0, 0.0], &mut s);
/// mechanism.phi(&mut s);
/// assert_eq!(s.phi, [0.0, 0.0]);
/// mechanism.twist(&[2.0, 0.0, 1.0], &mut s);
/// mechanism.gamma(&mut s);
/// // Γ = −R_j·s_j·φ̇² on the second body.
/// assert_eq!(s.gamma, [0.0, -2.0]);
/// ```
#[derive(Clone)]
pub struct Mechanism {
    name: String,
    bodies: Vec<BodyRecord>,
    pub(crate) elements: Elements,
    mass: Vec<f64>,
    /// Columns of the rotations without inertia that influence nothing (free spins). Their entries
    /// in `mass` are positive.
    free_spins: Vec<usize>,
    weight: Vec<f64>,
    tolerance: Tolerance,
    /// Longest arm of each body in the initial configuration (m).
    reach: Vec<f64>,
    /// For each body, whether rows that restrict angles keep the angle of the body constant.
    held: Vec<bool>,
    pub(crate) observed: Observables,
    layout: Layout,
}

impl Mechanism {
    /// Returns the mechanism with all functions of time replaced by their values at t. In this
    /// mechanism, drives are locked, and prescribed forces are constant. Force laws of drives may
    /// still depend on time.
    ///
    /// ```
    /// use joints::{Revolute, RevoluteAngleDrive};
    /// use pfaff_model::{Body, BodyRef, Description, Function, Mechanism, System};
    /// let mut d = Description::new("crank");
    /// let crank = d.body(Body::new("crank", 1.0, 1.0));
    /// let (bodies, s) = ([BodyRef::Ground, crank], [0.0, 0.0]);
    /// d.joint("pin", &bodies, Revolute { s_i: s, s_j: s });
    /// // 0.3·t²
    /// let swept = Function::polynomial(&[0.0, 0.0, 0.3]).unwrap();
    /// d.drive("motor", &bodies, RevoluteAngleDrive::new(s, s), swept);
    /// let held = Mechanism::build(&d).unwrap().held_at(2.0);
    /// let mut s = held.scratch();
    /// held.pose(5.0, &[0.0, 0.0, 1.2], &mut s);
    /// held.twist(&[0.0; 3], &mut s);
    /// held.phi(&mut s);
    /// held.gamma(&mut s);
    /// assert!(s.phi[2].abs() < 1e-15 && s.gamma[2] == 0.0);
    /// ```
    #[must_use]
    pub fn held_at(&self, t: f64) -> Self {
        let mut held = self.clone();
        for given in &mut held.elements.given {
            if let KernelInput::Function(of) = given {
                of.function = of.function.held_at(t);
            }
        }
        held
    }
}

impl Mechanism {
    /// Returns whether a function of time in the rows of a joint or drive prescribes a motion. A
    /// drive with a constant function is a lock, and so is a prescribed rate that is always zero.
    ///
    /// # Panics
    /// Panics if the joint or drive does not exist.
    #[must_use]
    pub fn prescribes_motion(&self, ConstraintId(group): ConstraintId) -> bool {
        let constraint = &self.elements.constraints[group];
        let given = &self.elements.given[constraint.site.functions.clone()];
        let gives_rate = !constraint.rows.nonholonomic.is_empty();
        let mut functions = given.iter().filter_map(KernelInput::function);
        functions
            .any(|of| !of.function.is_constant() || (gives_rate && of.function.jet(0.0)[0] != 0.0))
    }

    /// Returns the mechanism with another time of the start (s). The initial values of joints and
    /// drives do not change.
    #[must_use]
    pub fn starting_at(mut self, t: f64) -> Self {
        self.layout.start_time = t;
        self
    }

    /// Returns the name of the mechanism.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the space in which the bodies move.
    #[must_use]
    pub fn space(&self) -> SpaceKind {
        self.layout.space
    }

    /// Returns the mechanism with planar coordinates (x, y, cos φ, sin φ); the start is not yet
    /// assembled.
    #[cfg(feature = "unit-circle")]
    #[must_use]
    pub fn on_unit_circle(mut self) -> Self {
        self.layout.space = SpaceKind::UnitCircle;
        self.layout.n_q = self.space().n_q() * self.bodies.len();
        self
    }

    /// Returns the tolerance of the data for which neither the joint nor the body states a
    /// tolerance.
    #[must_use]
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }

    /// Returns the descriptions of the bodies.
    #[must_use]
    pub fn bodies(&self) -> &[BodyRecord] {
        &self.bodies
    }

    /// Returns the coordinates of the bodies in a configuration. The coordinates of the bodies are
    /// all coordinates except the unwrapped angles and the states of force laws.
    pub fn of_bodies<'q, T>(&self, q: &'q [T]) -> &'q [T] {
        &q[..self.layout.angles().start.min(q.len())]
    }

    /// Returns the coordinates of the bodies in a configuration as a mutable slice.
    pub fn of_bodies_mut<'q, T>(&self, q: &'q mut [T]) -> &'q mut [T] {
        let n = self.layout.angles().start.min(q.len());
        &mut q[..n]
    }

    /// Returns the displacement (n_v) that moves the configuration `from` to q. The function
    /// allocates memory.
    #[must_use]
    pub fn difference_of(&self, q: &[f64], from: &[f64]) -> Vec<f64> {
        let mut d = vec![0.0; self.layout.n_v];
        self.space().difference(q, from, &mut d);
        d
    }

    /// Copies the coordinates of these columns of C from another configuration exactly, and also
    /// all unwrapped angles and all states of force laws.
    pub fn take(&self, q: &mut [f64], from: &[f64], columns: &[usize]) {
        self.space().take(q, from, columns);
        let first = self.layout.angles().start;
        q[first..].copy_from_slice(&from[first..]);
    }

    /// Returns the column of C in which two configurations differ most, and the difference. Lengths
    /// are given as a fraction of `size`, and angles in radians.
    #[must_use]
    pub fn largest_difference(&self, a: &[f64], b: &[f64], size: f64) -> (usize, f64) {
        let space = self.space();
        space.largest_difference(self.of_bodies(a), self.of_bodies(b), size)
    }

    /// Returns the kinetic energy at coordinates q and velocities v (J), including the energy
    /// ½·a·ṡ² of armatures.
    #[must_use]
    pub fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        let energy = |(m, v): (&f64, &f64)| 0.5 * m * v * v;
        let spins = self.free_spins.iter().map(|&j| (&self.mass[j], &v[j]));
        let spins: f64 = spins.map(energy).sum();
        if self.elements.armatures.is_empty() {
            return self.mass.iter().zip(v).map(energy).sum::<f64>() - spins;
        }
        0.5 * self.inertia_at(q).between(v, v) - spins
    }

    /// Returns the principal moments of a body in space (kg·m²). The moment of a free spin is zero.
    pub(crate) fn moments(&self, body: usize) -> [f64; 3] {
        let first = self.space().rotations_of(body).start;
        [first, first + 1, first + 2].map(|j| match self.free_spins.binary_search(&j) {
            Ok(_) => 0.0,
            Err(_) => self.mass[j],
        })
    }

    /// Gives the free spins positive entries of M: the largest moment of inertia of the body, or
    /// the moment of its mass at one metre.
    fn set_free_spins(&mut self, columns: Vec<usize>) {
        for &j in &columns {
            let body = self.space().body_of(j);
            let own = &self.mass[self.space().rotations_of(body)];
            let largest = own.iter().fold(0.0, |a: f64, &j| a.max(j));
            let candidates = [largest, self.bodies[body].mass, 1.0];
            self.mass[j] = candidates.into_iter().find(|&m| m > 0.0).unwrap_or(1.0);
        }
        self.free_spins = columns;
    }

    /// Returns the rate of the sum of the kinetic energy and the potential energy of gravity (W),
    /// for velocities v and accelerations a: `vᵀ·(M·a − weight)`. If the constraints are satisfied,
    /// this rate is the power of drives and applied forces, because `M·a − Q = −Cᵀ·λ` and `C·v =
    /// b`. An armature a adds a·ṡ·s̈. If there are armatures, the work space must contain the
    /// state:
    /// [`System::force`] must have been called.
    ///
    /// [`System::force`]: crate::System::force
    #[must_use]
    pub fn energy_rate(&self, s: &Scratch, v: &[f64], a: &[f64]) -> f64 {
        let terms = self.mass.iter().zip(a).zip(self.weight.iter().zip(v));
        let bodies = terms.map(|((m, a), (w, v))| (m * a - w) * v).sum();
        let armatures = self.elements.armatures.iter().enumerate();
        armatures.fold(bodies, |sum, (k, armature)| {
            let acceleration = s.armatures.added.times(k, a) - s.armatures.gamma[k];
            sum + armature.inertia * s.armatures.added.times(k, v) * acceleration
        })
    }

    /// Returns the names of the body and of its coordinate that belong to a column of C.
    #[must_use]
    pub fn coordinate(&self, column: usize) -> (&str, &'static str) {
        let (space, body) = (self.space(), self.space().body_of(column));
        let direction = space.directions()[space.dof_of(column)];
        (&self.bodies[body].name, direction)
    }

    /// Returns the names of the body and of its coordinate that belong to an entry of q.
    #[must_use]
    pub fn coordinate_name(&self, k: usize) -> (&str, &'static str) {
        let n = self.space().n_q();
        match self.bodies.get(k / n) {
            Some(body) => in_space!(self.space(), S => (body.name.as_str(), S::COORDINATES[k % n])),
            None => {
                let angles = self.layout.angles();
                match self.elements.state_name(k.wrapping_sub(angles.end)) {
                    Some(name) if k >= angles.end => (name, "state of the law"),
                    _ => {
                        let (k, groups) = (k - angles.start, &self.layout.groups);
                        (
                            self.elements.counted_name(k, groups),
                            "angle with its turns",
                        )
                    }
                }
            }
        }
    }

    /// Returns the generalised forces of gravity, n_v values.
    #[must_use]
    pub fn weight(&self) -> &[f64] {
        &self.weight
    }

    /// Returns the potential energy of gravity (J).
    #[must_use]
    pub fn potential_energy(&self, q: &[f64]) -> f64 {
        let space = self.space();
        let translations = space.n_translations();
        let of_body = |(w, q): (&[f64], &[f64])| {
            let each = w[..translations].iter().zip(q);
            each.fold(-0.0, |sum, (w, q)| sum - w * q)
        };
        let weights = self.weight.chunks_exact(space.n_v());
        weights.zip(q.chunks_exact(space.n_q())).map(of_body).sum()
    }

    /// Returns the longest arm of a body in the initial configuration (m). The position of the body
    /// is accurate to about the rounding error of this arm, even near the origin.
    #[must_use]
    pub fn reach(&self, body: usize) -> f64 {
        self.reach[body]
    }

    /// Returns whether a length in a body (m), for example the distance of a joint from the centre
    /// of mass, exceeds the rounding error of the longest arm.
    #[must_use]
    pub fn is_length(&self, body: usize, length: f64) -> bool {
        are_apart(length, self.reach(body))
    }
}
