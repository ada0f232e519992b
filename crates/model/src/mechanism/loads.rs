//! The loads of applied forces on their bodies at a state.

use joints::spec::{ForceSpec, Shape, Unit};

use super::{Mechanism, gyroscopic};
use crate::body::BodyRef;
use crate::element::PlacedForce;
use crate::reaction::Reaction;
use crate::space::{cross, difference};
use crate::system::{Scratch, System};

/// The joint coordinate of an applied force, which is a quantity measured by the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceMeasure {
    /// Distance of two points, or the joint coordinate of a drive (m).
    Length,
    /// Angle between two bodies (rad).
    Angle,
}

impl ForceMeasure {
    /// Returns the names of the measure and of its rate in tables.
    #[must_use]
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Self::Length => ["length", "rate"],
            Self::Angle => ["angle", "rate"],
        }
    }

    /// Returns the units of the measure and of its rate.
    #[must_use]
    pub fn units(self) -> [&'static str; 2] {
        match self {
            Self::Length => ["m", "m/s"],
            Self::Angle => ["rad", "rad/s"],
        }
    }

    fn of(spec: &ForceSpec, is_law: bool) -> Option<Self> {
        if is_law {
            let mut units = spec.common.functions();
            let turns = units.any(|(_, unit)| unit == Unit::Angle);
            return Some(if turns { Self::Angle } else { Self::Length });
        }
        if spec.common.points_apart {
            return Some(Self::Length);
        }
        let mut parameters = spec.common.parameters.iter();
        let turns = parameters.any(|p| matches!(p.shape, Shape::Numbers([Unit::Angle])));
        turns.then_some(Self::Angle)
    }
}

/// The load of an applied force: the wrench on its first body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Force and torque on the first body, in ground axes (N, N·m). The torque is about
    /// [`Load::place`].
    pub wrench: Reaction,
    /// The first point of the force on the first body (m, ground axes). If a force has no such
    /// point, the centre of mass of the body is used, or the origin of the ground.
    pub place: [f64; 3],
    /// The measure of the force and its rate, if the force has a measure.
    pub measure: Option<[f64; 2]>,
}

/// Computes the loads of the applied forces of a mechanism. A drive with a force law is an applied
/// force. The weight is not an applied force.
pub struct Loads<'m> {
    mechanism: &'m Mechanism,
    s: Scratch,
    block: Vec<f64>,
}

impl Mechanism {
    /// Returns the loads of the applied forces; see [`Loads`]. The function allocates memory.
    ///
    /// ```
    /// use joints::SpringDamper;
    /// use pfaff_model::{Body, BodyRef, Description, Mechanism};
    /// let mut d = Description::new("hanging");
    /// let bob = d.body(Body::new("bob", 1.0, 1.0));
    /// let mut spring = SpringDamper::new([0.0, 1.0], [0.0; 2], 50.0, 0.0);
    /// spring.free_length = Some(0.8);
    /// d.force("spring", &[BodyRef::Ground, bob], spring);
    /// let mechanism = Mechanism::build(&d).unwrap();
    /// let load = mechanism.loads().at(0.0, &[0.0; 3], &[0.0; 3])[0];
    /// // The spring pulls the ground down.
    /// assert!((load.wrench.force[1] + 10.0).abs() < 1e-12);
    /// assert_eq!(load.measure, Some([1.0, 0.0]));
    /// ```
    #[must_use]
    pub fn loads(&self) -> Loads<'_> {
        Loads {
            mechanism: self,
            s: self.scratch(),
            block: vec![0.0; self.scratch().buffers.block.len()],
        }
    }
}

impl<'m> Loads<'m> {
    /// Returns the name of each force, with its measure.
    pub fn forces(&self) -> impl Iterator<Item = (&'m str, Option<ForceMeasure>)> + use<'m> {
        let forces = self.mechanism.elements.forces.iter();
        forces.map(|f| (f.name.as_str(), ForceMeasure::of(f.spec(), f.is_law())))
    }

    /// Computes the loads at time t (s), coordinates q and velocities v, in the order of the
    /// forces. An undefined load is NaN.
    ///
    /// # Panics
    /// Panics if q or v has the wrong length.
    pub fn at(&mut self, t: f64, q: &[f64], v: &[f64]) -> Vec<Load> {
        self.set(t, q, v);
        let mut block = std::mem::take(&mut self.block);
        let forces = self.mechanism.elements.forces.iter();
        let loads = forces.map(|force| self.of(force, (q, v), &mut block));
        let loads = loads.collect();
        self.block = block;
        loads
    }

    /// Sets the state of [`Loads::on_body`] and [`Loads::of_mass`].
    ///
    /// # Panics
    /// Panics if q or v has the wrong length.
    pub fn set(&mut self, t: f64, q: &[f64], v: &[f64]) {
        self.mechanism.pose(t, q, &mut self.s);
        self.mechanism.twist(v, &mut self.s);
        self.mechanism.command(&mut self.s);
    }

    fn of(&self, force: &PlacedForce, (q, v): (&[f64], &[f64]), block: &mut [f64]) -> Load {
        let s = &self.s;
        let points = force.points();
        let first = force.site.bodies.first().copied();
        let first = first.unwrap_or(BodyRef::Ground);
        let own = points.iter().find(|(body, _)| *body == first);
        let place = match (own, first) {
            (Some((body, point)), _) => self.global(*body, *point),
            (None, BodyRef::Body(k)) => s.bodies.origin(k),
            (None, BodyRef::Ground) => [0.0; 3],
        };
        force.q(&s.slots, block);
        let moving = force.site.bodies.iter().filter_map(|body| body.moving());
        let wrench = match first {
            BodyRef::Body(k) => self.wrench(force, block, k, place),
            // The load on the ground is opposite to the loads on the other bodies.
            BodyRef::Ground => moving.fold(Reaction::default(), |all, k| {
                all.minus(self.wrench(force, block, k, place))
            }),
        };
        Load {
            wrench,
            place,
            measure: self.measure(force, &points, (q, v)),
        }
    }

    /// Returns a part of Q as a wrench on one body about a point. `block` contains the values of
    /// the part.
    fn wrench(&self, force: &PlacedForce, block: &[f64], body: usize, about: [f64; 3]) -> Reaction {
        let space = self.mechanism.space();
        let entries = force.columns.iter().zip(block);
        let entries = entries.filter_map(|(column, &value)| Some(((*column)?, value)));
        let own = entries.filter(|(column, _)| space.body_of(*column) == body);
        self.of_entries(body, about, own)
    }

    /// Returns entries of a vector of generalised forces as a wrench on a body about a point. Each
    /// entry is given with its column.
    fn of_entries(
        &self,
        body: usize,
        about: [f64; 3],
        entries: impl Iterator<Item = (usize, f64)>,
    ) -> Reaction {
        let (s, space) = (&self.s, self.mechanism.space());
        let mut wrench = Reaction::default();
        for (column, value) in entries {
            let dof = space.dof_of(column);
            let torque = if space.forces().contains(&dof) {
                let mut pushed = [0.0; 3];
                pushed[dof] = value;
                wrench.force[dof] += value;
                cross(difference(s.bodies.origin(body), about), pushed)
            } else if space.n_rotations() == 1 {
                [0.0, 0.0, value]
            } else {
                s.bodies.axes(body)[space.axis_of(dof)].map(|x| value * x)
            };
            for (own, x) in wrench.torque.iter_mut().zip(torque) {
                *own += x;
            }
        }
        wrench
    }

    /// Returns two loads of a body about its centre of mass, in ground axes: the weight, and the
    /// load of its inertia, −m·a and −(J·α + ω × J·ω). The state is the state of the last
    /// [`Loads::set`], with the accelerations v̇.
    ///
    /// # Panics
    /// Panics if the body does not exist, or if v̇ has the wrong length.
    pub fn of_mass(&self, body: usize, acceleration: &[f64]) -> [Reaction; 2] {
        let (mechanism, space) = (self.mechanism, self.mechanism.space());
        let columns = space.columns_of(body);
        let mass = &mechanism.mass()[columns.clone()];
        let a = &acceleration[columns.clone()];
        let mut inertia: Vec<f64> = mass.iter().zip(a).map(|(m, a)| -m * a).collect();
        if let Some(&omega) = self.s.spins.get(body) {
            let own = space.rotations_of(body).start - columns.start;
            let turning = gyroscopic(mechanism.moments(body), omega);
            for (x, torque) in inertia[own..].iter_mut().zip(turning) {
                *x += torque;
            }
        }
        let centre = self.s.bodies.origin(body);
        let weight = &mechanism.weight()[columns.clone()];
        [weight, &inertia].map(|entries| {
            self.of_entries(body, centre, columns.clone().zip(entries.iter().copied()))
        })
    }

    /// Returns the loads on one body about its centre of mass, in ground axes, at the state of the
    /// last [`Loads::set`]. Each load is returned with the index of the force that acts on the
    /// body.
    ///
    /// # Panics
    /// Panics if the body does not exist.
    pub fn on_body(&self, body: usize) -> impl Iterator<Item = (usize, Reaction)> + '_ {
        let forces = self.mechanism.elements.forces.iter().enumerate();
        let own = forces.filter(move |(_, f)| f.site.bodies.contains(&BodyRef::Body(body)));
        let centre = self.s.bodies.origin(body);
        let mut block = vec![0.0; self.block.len()];
        own.map(move |(k, force)| {
            force.q(&self.s.slots, &mut block);
            (k, self.wrench(force, &block, body, centre))
        })
    }

    /// Returns the loads of armatures on one body about its centre of mass, in ground axes, at the
    /// state of the last [`Loads::set`], with the accelerations v̇. The load along the joint
    /// coordinate s of an armature a is −a·s̈. Each load is returned with the index of the armature
    /// in [`Mechanism::armatures`].
    ///
    /// # Panics
    /// Panics if the body does not exist, or if v̇ has the wrong length.
    pub fn of_armatures(
        &self,
        body: usize,
        acceleration: &[f64],
    ) -> impl Iterator<Item = (usize, Reaction)> + '_ {
        let armatures = self.mechanism.elements.armatures.iter().enumerate();
        let own = armatures.filter(move |(_, a)| a.site.bodies.contains(&BodyRef::Body(body)));
        let (space, centre) = (self.mechanism.space(), self.s.bodies.origin(body));
        let acceleration = acceleration.to_vec();
        own.map(move |(k, armature)| {
            let columns = armature.columns();
            let mut gradient = vec![0.0; columns.len()];
            armature.gradient(&self.s.slots, &mut gradient);
            let along = columns.iter().zip(&gradient);
            let along: f64 = along.map(|(&j, g)| g * acceleration[j]).sum();
            let load = -armature.inertia * (along - armature.gamma(&self.s.slots));
            let entries = columns.iter().zip(&gradient);
            let entries = entries.filter(|(column, _)| space.body_of(**column) == body);
            let entries = entries.map(|(&column, g)| (column, load * g));
            (k, self.of_entries(body, centre, entries))
        })
    }

    fn global(&self, body: BodyRef, point: [f64; 3]) -> [f64; 3] {
        let moved = |k| self.s.bodies.to_global(k, point);
        body.moving().map_or(point, moved)
    }

    fn measure(
        &self,
        force: &PlacedForce,
        points: &[(BodyRef, [f64; 3])],
        (q, v): (&[f64], &[f64]),
    ) -> Option<[f64; 2]> {
        let measure = ForceMeasure::of(force.spec(), force.is_law())?;
        if let Some(drive) = force.drive(&self.s.slots) {
            return Some([drive.measure, drive.rate]);
        }
        let omega = |body: BodyRef| {
            let turning = |k| self.mechanism.frames().body(k, q, v).omega;
            body.moving().map_or([0.0; 3], turning)
        };
        let &[from, to] = force.site.bodies.as_slice() else {
            return None;
        };
        if measure == ForceMeasure::Angle {
            let angle = |body: BodyRef| body.moving().map_or(0.0, |k| self.s.bodies.angle(k));
            return Some([angle(to) - angle(from), omega(to)[2] - omega(from)[2]]);
        }
        let &[a, b] = points else { return None };
        let state = |(body, point): (BodyRef, [f64; 3])| {
            let place = self.global(body, point);
            let Some(k) = body.moving() else {
                return (place, [0.0; 3]);
            };
            let turned = cross(omega(body), difference(place, self.s.bodies.origin(k)));
            let mut velocity = turned;
            for (x, column) in velocity
                .iter_mut()
                .zip(self.mechanism.space().translations_of(k))
            {
                *x += v[column];
            }
            (place, velocity)
        };
        let ((a, va), (b, vb)) = (state(a), state(b));
        let (d, dv) = (difference(b, a), difference(vb, va));
        let length = crate::space::norm(&d);
        let along: f64 = d.iter().zip(&dv).map(|(x, v)| x * v).sum();
        Some([length, if length > 0.0 { along / length } else { 0.0 }])
    }
}
