//! Mechanisms in space whose motion is known: a spinning top, a rolling disk, and linkages that
//! move although Grübler's formula gives zero degrees of freedom.

use joints::space3::{Axes, Direction, GroundPlane, Revolute, Spherical, Wheel, cross};
use model::{BodyRef, SpatialBody, SpatialDescription};

use crate::fuzz::space::pose::{Writing, posed};
use crate::fuzz::space::text::Precision;
use crate::fuzz::space::{catalogue, description};
use suite::numbers::Numbers;

/// Returns a tensor with these moments along the axes of the body.
#[must_use]
pub fn diagonal(moments: [f64; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { moments[i] } else { 0.0 }))
}

/// Returns the heavy top of 15 kg. The mass centre is 1 m from the fixed point, and the top spins
/// at 150 rad/s about its axis.
///
/// Source: F. Romano, benchmark of the heavy top; M. Géradin, A. Cardona, Flexible Multibody
/// Dynamics, 2001.
#[must_use]
pub fn top() -> SpatialDescription {
    let mut d = SpatialDescription::new("top");
    d.gravity = [0.0, 0.0, -9.81];
    let centre = [0.0, 1.0, 0.0];
    let omega = [0.0, 150.0, -4.615_38];
    let top = d.body(SpatialBody {
        position: centre,
        velocity: Some(cross(omega, centre)),
        angular_velocity: Some(omega),
        ..SpatialBody::new("top", 15.0, diagonal([0.234_375, 0.468_75, 0.234_375]))
    });
    let pivot = Spherical {
        s_i: [0.0; 3],
        s_j: [0.0, -1.0, 0.0],
    };
    d.joint("pivot", &[BodyRef::Ground, top], pivot);
    d
}

/// Returns Bricard's linkage of the IFToMM benchmark A04: five rods of 1 kg on six hinges, at rest.
/// The height of the third pivot is `sin θ/(1 − sin θ)` with the angle θ of rod 1.
#[must_use]
pub fn bricard() -> SpatialDescription {
    bricard_of_size(1.0)
}

/// Returns the same linkage with rods of this length (m).
#[must_use]
pub fn bricard_of_size(size: f64) -> SpatialDescription {
    let p: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, -1.0, 1.0],
        [0.0, -1.0, 1.0],
        [0.0, 0.0, 1.0],
    ]
    .map(|p: [f64; 3]| p.map(|x| size * x));
    let hinges = [1, 2, 0, 1, 2, 0].map(|k| Axes::FRAME.uvw()[k]);
    let mut d = SpatialDescription::new("Bricard");
    d.gravity = [0.0, -9.81, 0.0];
    let (long, thin) = [(1.0 + 0.01) / 12.0, 0.02 / 12.0]
        .map(|x| x * size * size)
        .into();
    let rods: Vec<BodyRef> = (0..5)
        .map(|k| {
            let along: [f64; 3] = std::array::from_fn(|j| p[k + 1][j] - p[k][j]);
            let moments = along.map(|a| if a == 0.0 { long } else { thin });
            let position = std::array::from_fn(|j| 0.5 * (p[k][j] + p[k + 1][j]));
            d.body(SpatialBody {
                position,
                velocity: Some([0.0; 3]),
                angular_velocity: Some([0.0; 3]),
                ..SpatialBody::new(&format!("rod {k}"), 1.0, diagonal(moments))
            })
        })
        .collect();
    for (k, (at, hinge)) in p.into_iter().zip(hinges).enumerate() {
        let pair = [
            k.checked_sub(1)
                .map_or(BodyRef::Ground, |before| rods[before]),
            rods.get(k).copied().unwrap_or(BodyRef::Ground),
        ];
        let [s_i, s_j] = pair.map(|body| d.local(body, at));
        // The constructor cannot fail for a coordinate axis.
        let axis = Axes::new(hinge, None).unwrap_or(Axes::FRAME);
        let hinge = Revolute {
            s_i,
            s_j,
            axis,
            axis_j: axis,
        };
        d.joint(&format!("hinge {k}"), &pair, hinge);
    }
    d
}

/// Returns Bennett's linkage under gravity; its links have rotated frames and arbitrary mass
/// centres, and the whole linkage is rotated and translated.
///
/// # Errors
/// This function never returns an error, because the drawing is a mechanism.
pub fn bennett() -> Result<SpatialDescription, String> {
    let drawing = posed(
        &catalogue::bennett(),
        Writing::Moved,
        &mut Numbers::new(BENNETT),
    );
    Ok(SpatialDescription {
        name: "Bennett".into(),
        gravity: [0.0, 0.0, -9.81],
        ..description(&drawing, &Precision::default())?
    })
}

/// Seed that selects the frames of [`bennett`].
const BENNETT: u64 = 11;

/// A disk that rolls steadily without slip, so that its centre moves on a circle.
#[derive(Clone, Copy, Debug)]
pub struct RollingDisk {
    /// Angle between the axis of the disk and the vertical (rad).
    pub tilt: f64,
    /// Rate of precession (rad/s).
    pub precession: f64,
}

impl RollingDisk {
    /// Mass of the disk (kg).
    pub const MASS: f64 = 15.0;
    /// Radius of the disk (m).
    pub const RADIUS: f64 = 1.0;
    /// Moment of inertia A about a diameter, and moment of inertia C about the axis (kg·m²).
    pub const MOMENTS: [f64; 2] = [3.75, 7.5];
    /// Acceleration of free fall (m/s²).
    pub const GRAVITY: f64 = 9.81;

    /// Returns the angular velocity along the axis (rad/s):
    /// `(C + m·r²)·ω₃ = A·Ω·cos θ − m·g·r·cos θ/(Ω·sin θ)`
    #[must_use]
    pub fn spin(&self) -> f64 {
        let (sin, cos) = self.tilt.sin_cos();
        let [a, c] = Self::MOMENTS;
        let weight = Self::MASS * Self::GRAVITY * Self::RADIUS;
        let moment = a * self.precession * cos - weight * cos / (self.precession * sin);
        moment / (c + Self::MASS * Self::RADIUS * Self::RADIUS)
    }

    /// Returns the disk on the plane z = 0. The axis of the disk is the z-axis of the body.
    #[must_use]
    pub fn description(&self) -> SpatialDescription {
        let (sin, cos) = self.tilt.sin_cos();
        // The rotation is about y: the axis is (sin θ, 0, cos θ), and the steepest radius is (−cos
        // θ, 0, sin θ).
        let (half_sin, half_cos) = (0.5 * self.tilt).sin_cos();
        let (axis, steepest) = ([sin, 0.0, cos], [-cos, 0.0, sin]);
        let omega: [f64; 3] =
            std::array::from_fn(|k| self.spin() * axis[k] + self.precession * sin * steepest[k]);
        let to_centre = steepest.map(|x| Self::RADIUS * x);
        let [a, c] = Self::MOMENTS;
        let mut d = SpatialDescription::new("disk");
        d.gravity = [0.0, 0.0, -Self::GRAVITY];
        let disk = d.body(SpatialBody {
            position: [0.0, 0.0, Self::RADIUS * sin],
            orientation: [half_cos, 0.0, half_sin, 0.0],
            velocity: Some(cross(omega, to_centre)),
            angular_velocity: Some(omega),
            ..SpatialBody::new("disk", Self::MASS, diagonal([a, a, c]))
        });
        let edge = Wheel::new([0.0; 3], Direction::Z, Self::RADIUS, GroundPlane::Z);
        d.joint("edge", &[disk], edge);
        d
    }
}
