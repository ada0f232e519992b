//! Body frames whose origin is not the centre of mass. Only this module converts between the
//! positions and velocities of a description and the positions and velocities of the equations.
//!
//! The equations use centres of mass: q = (r, φ), and points of joints are relative to the centre
//! of mass. Descriptions and outputs use the origin o of the body frame. With c = [`Body::centre`],
//! `r = o + R·c` and `ṙ = ȯ + ω × R·c`.

#[cfg(test)]
mod tests;

use crate::body::{Body, BodyRecord, BodyRef, DescribedBody};
use crate::element::{Bodies, angle_at, axes_at, turned_at};
use crate::mechanism::Mechanism;
use crate::observed::{Marker, Measure, MeasureKind, Observables, are_parallel, unit};
use crate::space::{SpaceKind, cross, difference, dot, norm, normalised, quaternion_product};
use crate::system::System;

/// Position, velocity and acceleration of a point of a body, or of the origin of its frame, in
/// ground axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameState {
    /// The space of the mechanism.
    pub space: SpaceKind,
    /// Position (m).
    pub place: [f64; 3],
    /// Angle of the axes in the plane (rad), including full revolutions.
    pub angle: f64,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub omega: [f64; 3],
    /// Orientation in space, as stored in the coordinates.
    pub quaternion: [f64; 4],
    /// Acceleration (m/s²); NaN unless the accelerations of the bodies are known, see
    /// [`Frames::with_accelerations`].
    pub acceleration: [f64; 3],
    /// Angular acceleration (rad/s²); NaN unless the accelerations of the bodies are known.
    pub alpha: [f64; 3],
}

impl FrameState {
    /// Returns the frame of the ground.
    fn of_ground(space: SpaceKind) -> Self {
        Self {
            space,
            quaternion: [1.0, 0.0, 0.0, 0.0],
            ..Self::default()
        }
    }

    /// Transforms a vector from the axes of the frame to ground axes.
    fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        if self.space == SpaceKind::Space3 {
            let [w, e1, e2, e3] = self.quaternion;
            let [a, b, c] = axes_at(self.space, &[0.0, 0.0, 0.0, w, e1, e2, e3]);
            return [0, 1, 2].map(|k| a[k] * x + b[k] * y + c[k] * z);
        }
        let (sin, cos) = self.angle.sin_cos();
        [cos * x - sin * y, sin * x + cos * y, z]
    }

    /// Returns the distance to another state (m), and the angle between its axes and the axes of
    /// this state (rad). In the plane the angle includes full revolutions; in space it is at most
    /// half a revolution.
    ///
    /// ```
    /// use pfaff_model::{FrameState, SpaceKind};
    /// let state = |place, quaternion| FrameState {
    ///     space: SpaceKind::Space3, place, quaternion, ..FrameState::default()
    /// };
    /// // A third of a turn, about the diagonal of a cube; −q is the orientation q.
    /// let unturned = state([0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 0.0]);
    /// let turned = state([2.0, 3.0, 7.0], [0.5; 4]);
    /// let [distance, angle] = unturned.apart(&turned);
    /// assert_eq!(distance, 7.0);
    /// assert!((angle - std::f64::consts::TAU / 3.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn apart(&self, other: &Self) -> [f64; 2] {
        let distance = norm(&difference(other.place, self.place));
        let in_space = [self, other].map(|state| state.space == SpaceKind::Space3);
        if in_space == [false; 2] {
            return [distance, (other.angle - self.angle).abs()];
        }
        let [w, x, y, z] = self.orientation();
        let [w, x, y, z] = quaternion_product([w, -x, -y, -z], other.orientation());
        [distance, 2.0 * norm(&[x, y, z]).atan2(w.abs())]
    }

    /// Returns the orientation as a quaternion. In the plane, the rotation is about the normal of
    /// the plane.
    fn orientation(&self) -> [f64; 4] {
        if self.space == SpaceKind::Space3 {
            return self.quaternion;
        }
        let (sin, cos) = (0.5 * self.angle).sin_cos();
        [cos, 0.0, 0.0, sin]
    }

    /// Returns the values of the state, in the order of [`SpaceKind::columns`].
    pub fn numbers(&self) -> impl Iterator<Item = f64> + use<> {
        let ([x, y, z], [vx, vy, vz]) = (self.place, self.velocity);
        let ([w, e1, e2, e3], [wx, wy, wz]) = (self.quaternion, self.omega);
        let mut numbers = [x, y, z, w, e1, e2, e3, vx, vy, vz, wx, wy, wz];
        let mut count = numbers.len();
        if self.space != SpaceKind::Space3 {
            let planar = [x, y, self.angle, vx, vy, wz];
            count = planar.len();
            numbers[..count].copy_from_slice(&planar);
        }
        numbers.into_iter().take(count)
    }

    /// Names of the columns of [`Self::roll_pitch_yaw`].
    pub const ANGLES: [&str; 3] = ["roll", "pitch", "yaw"];

    /// Returns roll, pitch and yaw (rad) of the axes in space. The rotations about the axes x, then
    /// y, then z of the ground rotate the ground axes into this orientation. Pitch is between −π/2
    /// and π/2. At both limits only the sum or the difference of roll and yaw is defined, and roll
    /// is zero.
    ///
    /// ```
    /// use pfaff_model::{FrameState, SpaceKind};
    /// // A quarter turn about z.
    /// let quaternion = [1.0, 0.0, 0.0, 1.0];
    /// let turned = FrameState { space: SpaceKind::Space3, quaternion, ..FrameState::default() };
    /// assert_eq!(turned.roll_pitch_yaw(), [0.0, 0.0, std::f64::consts::FRAC_PI_2]);
    /// ```
    #[must_use]
    pub fn roll_pitch_yaw(&self) -> [f64; 3] {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|d| self.turned(d));
        let pitch = (0.0 - x[2]).atan2(x[0].hypot(x[1]));
        if are_parallel(x, [0.0, 0.0, 1.0]) {
            return [0.0, pitch, (0.0 - y[0]).atan2(y[1])];
        }
        [y[2].atan2(z[2]), pitch, x[1].atan2(x[0])]
    }

    /// Returns the accelerations of the state, in the order of [`SpaceKind::accelerations`].
    pub fn accelerations(&self) -> impl Iterator<Item = f64> + use<> {
        let (own, alpha, space) = (self.acceleration, self.alpha, self.space);
        let turning = space.torques().map(move |k| alpha[space.axis_of(k)]);
        own.into_iter().take(space.n_translations()).chain(turning)
    }
}

impl Mechanism {
    /// Returns the frames of the bodies, the markers and the measures of the mechanism.
    #[must_use]
    pub fn frames(&self) -> Frames<'_> {
        Frames {
            mechanism: self,
            a: None,
        }
    }

    /// Returns the coordinates and velocities given in the description, without correction.
    /// Velocities that are not given are zero.
    #[must_use]
    pub fn described_state(&self) -> (Vec<f64>, Vec<f64>) {
        let mut q = vec![0.0; self.layout().n_q];
        let n_q = self.space().n_q();
        for (body, q) in self.bodies().iter().zip(q.chunks_exact_mut(n_q)) {
            body.coordinates(self.space(), q);
        }
        let v = self.frames().given_velocities(&q).into_iter();
        let v = v.map(Option::unwrap_or_default).collect();
        (q, v)
    }
}

/// Converts between the equations of a mechanism, which use centres of mass, and descriptions and
/// outputs, which use body frames and points.
#[derive(Clone, Copy)]
pub struct Frames<'m> {
    mechanism: &'m Mechanism,
    /// Accelerations of the bodies, n_v.
    a: Option<&'m [f64]>,
}

impl<'m> Frames<'m> {
    /// Returns the frames with known accelerations of the bodies: n_v values, in the order of the
    /// velocities.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism};
    /// // A rod that turns about its centre of mass at 2 rad/s: r·ω² toward the centre.
    /// let mut d = Description::new("rod");
    /// d.body(Body { centre: [0.5, 0.0], ..Body::new("rod", 1.0, 0.1) });
    /// let rod = Mechanism::build(&d).unwrap();
    /// let frames = rod.frames().with_accelerations(&[0.0, 0.0, 3.0]);
    /// let end = frames.body(0, &[0.0, 0.0, 0.0], &[0.0, 0.0, 2.0]);
    /// assert_eq!(end.place, [-0.5, 0.0, 0.0]);
    /// assert_eq!(end.acceleration, [0.5 * 4.0, -0.5 * 3.0, 0.0]);
    /// ```
    #[must_use]
    pub fn with_accelerations<'a>(self, a: &'a [f64]) -> Frames<'a>
    where
        'm: 'a,
    {
        Frames {
            mechanism: self.mechanism,
            a: Some(a),
        }
    }

    /// Returns the markers and measures. A part of a mechanism contains only markers with a stated
    /// tolerance.
    #[must_use]
    pub fn observed(self) -> &'m Observables {
        &self.mechanism.observed
    }

    /// Transforms a vector from the axes of the coordinates of a body to the axes of the body
    /// frame. Examples are the points in [`Mechanism::points`] and in [`Bodies::to_local`]. The two
    /// sets of axes are equal unless the body has products of inertia. In this case the coordinates
    /// refer to the principal axes.
    ///
    /// # Panics
    /// Panics if the body does not exist.
    #[must_use]
    pub fn vector(self, body: BodyRef, own: [f64; 3]) -> [f64; 3] {
        let record = body.moving().map(|k| &self.mechanism.bodies()[k]);
        let principal = record.and_then(|record| record.principal.as_ref());
        principal.map_or(own, |of| of.to_frame(own))
    }

    /// Returns the poses of all bodies at q. A pose consists of the position of the centre of mass
    /// and the axes of the body frame.
    ///
    /// # Panics
    /// Panics if q has the wrong length.
    #[must_use]
    pub fn poses(self, q: &[f64]) -> Bodies {
        let space = self.mechanism.space();
        let mut told = q[..self.mechanism.bodies().len() * space.n_q()].to_vec();
        for (body, record) in self.mechanism.bodies().iter().enumerate() {
            if let Some(of) = &record.principal {
                let own = &mut told[space.coordinates(body)];
                let frame = of.turned_back([own[3], own[4], own[5], own[6]]);
                own[3..].copy_from_slice(&frame);
            }
        }
        Bodies::at(space, &told)
    }

    /// Returns the origin and the axes of a body frame at q and v, in the form written to outputs.
    /// If the frame of the body is at its centre of mass, the result equals the coordinates and
    /// velocities bit for bit.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Mechanism};
    /// // A rod whose frame is at its lower end, upright, turning about its centre of mass.
    /// let mut d = Description::new("rod");
    /// d.body(Body { centre: [0.5, 0.0], ..Body::new("rod", 1.0, 0.1) });
    /// let quarter = std::f64::consts::FRAC_PI_2;
    /// let rod = Mechanism::build(&d).unwrap();
    /// let rod = rod.frames().body(0, &[0.0, 0.5, quarter], &[0.0, 0.0, 2.0]);
    /// assert!(rod.place.iter().all(|x| x.abs() < 1e-15));
    /// assert!((rod.velocity[0] - 1.0).abs() < 1e-15 && rod.velocity[1].abs() < 1e-15);
    /// ```
    ///
    /// # Panics
    /// Panics if the body does not exist, or if q or v has the wrong length.
    #[must_use]
    pub fn body(self, body: usize, q: &[f64], v: &[f64]) -> FrameState {
        self.point(body, [0.0; 3], q, v)
    }

    /// Returns the state of a point at q and v. The point is given in the body frame.
    ///
    /// # Panics
    /// Panics under the same conditions as [`Self::body`].
    #[must_use]
    pub fn point(self, body: usize, point: [f64; 3], q: &[f64], v: &[f64]) -> FrameState {
        let space = self.mechanism.space();
        let own = &q[space.coordinates(body)];
        let arm = self.mechanism.bodies()[body].from_centre(point);
        let mut state = FrameState {
            space,
            angle: angle_at(space, own),
            ..FrameState::default()
        };
        // In the coordinates of both spaces, the position comes first.
        state.place[space.forces()].copy_from_slice(&own[space.forces()]);
        let v = &v[space.columns_of(body)];
        state.velocity[space.forces()].copy_from_slice(&v[space.forces()]);
        for k in space.torques() {
            state.omega[space.axis_of(k)] = v[k];
        }
        if space == SpaceKind::Space3 {
            state.omega = turned_at(space, own, state.omega);
            let axes = [own[3], own[4], own[5], own[6]];
            let principal = self.mechanism.bodies()[body].principal.as_ref();
            state.quaternion = principal.map_or(axes, |own| own.turned_back(axes));
        }
        if arm != [0.0; 3] {
            let arm = turned_at(space, own, arm);
            let moved = cross(state.omega, arm);
            for k in 0..3 {
                state.place[k] += arm[k];
                state.velocity[k] += moved[k];
            }
        }
        (state.acceleration, state.alpha) = ([f64::NAN; 3], [f64::NAN; 3]);
        if let Some(a) = self.a {
            // Accelerations depend on a in the same way as velocities depend on v; the centripetal
            // acceleration is added.
            let frames = self.mechanism.frames();
            let pushed = frames.point(body, point, q, a);
            let arm = turned_at(space, own, arm);
            let inwards = cross(state.omega, cross(state.omega, arm));
            state.acceleration = [0, 1, 2].map(|k| pushed.velocity[k] + inwards[k]);
            state.alpha = pushed.omega;
        }
        state
    }

    /// Returns the velocities given in the description at the configuration q, n_v values. The
    /// velocity of a centre of mass is computed from the given velocity and angular velocity of the
    /// body frame.
    #[must_use]
    pub fn given_velocities(self, q: &[f64]) -> Vec<Option<f64>> {
        let space = self.mechanism.space();
        let of_plane = |k: usize, b: &Body| -> Vec<Option<f64>> {
            let [mut vx, mut vy] = b.velocity.map_or([None; 2], |v| v.map(Some));
            if let (Some([x, y]), Some(omega), false) =
                (b.velocity, b.angular_velocity, b.is_centred())
            {
                let [cx, cy] = b.centre;
                let [ax, ay, _] = turned_at(space, &q[space.coordinates(k)], [cx, cy, 0.0]);
                (vx, vy) = (Some(x - omega * ay), Some(y + omega * ax));
            }
            vec![vx, vy, b.angular_velocity]
        };
        let of = |(k, record): (usize, &BodyRecord)| match &record.described {
            DescribedBody::Plane(b) => of_plane(k, b),
            DescribedBody::Space3(b) => {
                let own = &q[space.coordinates(k)];
                // The vector from the centre of mass to the origin is −c.
                let arm = turned_at(space, own, record.from_centre([0.0; 3])).map(|x| 0.0 - x);
                let carried = |v: [f64; 3], omega: [f64; 3]| -> [f64; 3] {
                    let turned = cross(omega, arm);
                    std::array::from_fn(|k| v[k] + turned[k])
                };
                // Without a given angular velocity, the frame is at the centre of mass; the build
                // checks this.
                let velocity = b.velocity.map(|v| match b.angular_velocity {
                    Some(omega) if arm != [0.0; 3] => carried(v, omega),
                    _ => v,
                });
                let axes = axes_at(space, own);
                let omega = b
                    .angular_velocity
                    .map(|omega| axes.map(|axis| (0..3).map(|k| axis[k] * omega[k]).sum::<f64>()));
                let all = [velocity, omega].map(|v| v.map_or([None; 3], |v| v.map(Some)));
                all.concat()
            }
        };
        self.mechanism
            .bodies()
            .iter()
            .enumerate()
            .flat_map(of)
            .collect()
    }

    /// Returns the state of a marker at q and v. The angle or orientation is that of the marker
    /// axes.
    ///
    /// # Panics
    /// Panics if the marker does not exist, or if q or v has the wrong length.
    #[must_use]
    pub fn marker(self, marker: usize, q: &[f64], v: &[f64]) -> FrameState {
        let Marker {
            body,
            point,
            angle,
            orientation,
            ..
        } = self.mechanism.observed.markers[marker];
        let of_body = match body {
            BodyRef::Body(k) => self.point(k, point, q, v),
            BodyRef::Ground => FrameState {
                place: point,
                ..FrameState::of_ground(self.mechanism.space())
            },
        };
        let quaternion = match orientation {
            Some(own) => quaternion_product(of_body.quaternion, normalised(own)),
            None => of_body.quaternion,
        };
        FrameState {
            angle: of_body.angle + angle.unwrap_or_default(),
            quaternion,
            ..of_body
        }
    }

    /// Returns the value of a measure at q and v.
    ///
    /// ```
    /// use pfaff_model::{Body, Description, Marker, Measure, MeasureKind, Mechanism};
    /// let mut d = Description::new("top");
    /// let body = d.body(Body::new("top", 1.0, 1.0));
    /// d.observed.markers.push(Marker::new("rim", body, [2.0, 0.0, 0.0]));
    /// for kind in [MeasureKind::Y, MeasureKind::Speed, MeasureKind::ANGLE] {
    ///     let (name, between) = (kind.name().into(), [None, Some(0)]);
    ///     d.observed.measures.push(Measure { name, kind, between });
    /// }
    /// let top = Mechanism::build(&d).unwrap();
    /// // After one and a half turns, at 3 rad/s.
    /// let turned = 3.0 * std::f64::consts::PI;
    /// let value = |k| top.frames().measure(k, &[0.0, 1.0, turned], &[0.0, 0.0, 3.0]);
    /// assert!((value(0) - 1.0).abs() < 1e-14 && (value(1) - 6.0).abs() < 1e-14);
    /// assert_eq!(value(2), turned);
    /// ```
    ///
    /// # Panics
    /// Panics if the measure does not exist, or if q or v has the wrong length.
    #[must_use]
    pub fn measure(self, measure: usize, q: &[f64], v: &[f64]) -> f64 {
        let [value, _, _] = self.measure_rates(measure, q, v);
        value
    }

    /// Returns the value of a measure at q and v, its rate and its second derivative. A value is
    /// NaN if it does not exist, for example the rate of a distance of zero. A value is also NaN if
    /// it requires accelerations that are not known (see [`Self::with_accelerations`]).
    ///
    /// # Panics
    /// Panics under the same conditions as [`Self::measure`].
    #[must_use]
    pub fn measure_rates(self, measure: usize, q: &[f64], v: &[f64]) -> [f64; 3] {
        let Measure { kind, between, .. } = self.mechanism.observed.measures[measure];
        let state = |of: Option<usize>| {
            let ground = || FrameState::of_ground(self.mechanism.space());
            of.map_or_else(ground, |marker| self.marker(marker, q, v))
        };
        let [first, second] = between.map(state);
        values(kind, &first, &second)
    }

    /// Returns the first measure that is not defined at q, with its requirement.
    pub(crate) fn unmet_requirement(self, q: &[f64]) -> Option<(String, &'static str)> {
        let rest = vec![0.0; self.mechanism.layout().n_v];
        let mut measures = self.observed().measures.iter().enumerate();
        let (_, unmet) = measures.find(|(k, _)| self.measure(*k, q, &rest).is_nan())?;
        let requirement = "its second direction is not parallel to `about`";
        Some((unmet.name.clone(), requirement))
    }
}

/// A vector with its first two derivatives.
type Vectors = [[f64; 3]; 3];

/// Returns a measure with its first two derivatives from the states of both markers. Derivatives of
/// vectors are taken in the axes of the first marker.
fn values(kind: MeasureKind, first: &FrameState, second: &FrameState) -> [f64; 3] {
    let d = difference(second.place, first.place);
    let moved = difference(
        difference(second.velocity, first.velocity),
        cross(first.omega, d),
    );
    let turning = difference(second.omega, first.omega);
    // a₂ − a₁ − α₁ × d − ω₁ × (ω₁ × d) − 2·ω₁ × ḋ
    let carried = [0, 1, 2].map(|k| {
        let inwards = cross(first.omega, cross(first.omega, d));
        cross(first.alpha, d)[k] + inwards[k] + 2.0 * cross(first.omega, moved)[k]
    });
    let pushed = difference(difference(second.acceleration, first.acceleration), carried);
    // α₂ − α₁ − ω₁ × ω₂
    let turned = difference(
        difference(second.alpha, first.alpha),
        cross(first.omega, second.omega),
    );
    let unknown = [f64::NAN; 3];
    let along = |n: [f64; 3], of: Vectors| of.map(|x| dot(n, x));
    // Returns the vectors of a direction that is fixed in the second marker.
    let fixed = |b: [f64; 3]| -> Vectors {
        let rate = cross(turning, b);
        let (sideways, inwards) = (cross(turned, b), cross(turning, rate));
        [b, rate, [0, 1, 2].map(|k| sideways[k] + inwards[k])]
    };
    match kind {
        MeasureKind::Distance => length([d, moved, pushed]),
        MeasureKind::Along(n) => along(first.turned(unit(n)), [d, moved, pushed]),
        MeasureKind::Angle {
            directions: [a, b], ..
        } if first.space != SpaceKind::Space3 => {
            let offset = cross(a, b)[2].atan2(dot(a, b));
            let angle = second.angle - first.angle + offset;
            [angle, turning[2], turned[2]]
        }
        MeasureKind::Angle {
            directions: [a, b],
            about,
        } => {
            let (a, b) = (first.turned(unit(a)), fixed(second.turned(unit(b))));
            let Some(about) = about.map(|about| first.turned(unit(about))) else {
                return angle(length(b.map(|b| cross(a, b))), along(a, b));
            };
            if are_parallel(b[0], about) {
                return unknown;
            }
            let across = [0, 1, 2].map(|k| a[k] - dot(about, a) * about[k]);
            angle(along(cross(about, a), b), along(across, b))
        }
        MeasureKind::Inclination([a, b]) => {
            let (a, b) = (first.turned(unit(a)), fixed(second.turned(unit(b))));
            angle(along(a, b), length(b.map(|b| cross(a, b))))
        }
        MeasureKind::Speed => length([moved, pushed, unknown]),
        MeasureKind::AngularVelocity if first.space == SpaceKind::Space3 => {
            length([turning, turned, unknown])
        }
        MeasureKind::AngularVelocity => [turning[2], turned[2], f64::NAN],
    }
}

/// Returns the length of a vector with its first two derivatives. A length of zero has no
/// derivatives.
fn length([x, rate, second]: Vectors) -> [f64; 3] {
    let length = norm(&x);
    let along = dot(x, rate) / length;
    let across = dot(rate, rate) - along * along;
    [length, along, (across + dot(x, second)) / length]
}

/// Returns atan2(y, x) with its first two derivatives.
fn angle(y: [f64; 3], x: [f64; 3]) -> [f64; 3] {
    let squared = x[0] * x[0] + y[0] * y[0];
    let rate = (x[0] * y[1] - y[0] * x[1]) / squared;
    let stretched = x[0] * x[1] + y[0] * y[1];
    let second = (x[0] * y[2] - y[0] * x[2] - 2.0 * rate * stretched) / squared;
    [y[0].atan2(x[0]), rate, second]
}
