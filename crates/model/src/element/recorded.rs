//! Arguments of kernels as inputs of a recording.

use joints::plane::Pose;
use joints::{Plane, RecordedNumber, Space as _, Space3, space3};

use super::bodies::{InEach, Poses, Twists};
use super::constraint::PlacedConstraint;
use super::kernels::{AnyConstraint, stored, with};
use super::slots::{Kinematics, Site, pose_of};
use crate::body::BodyRef;
use crate::space::SpaceKind;

/// Meaning of an input of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A coordinate, by its index in q.
    Coordinate(usize),
    /// The cosine of the coordinate with this index in q.
    Cos(usize),
    /// The sine of the coordinate with this index in q.
    Sin(usize),
    /// An entry of the matrix that transforms vectors from the principal axes of a spatial body to
    /// ground axes. The matrix is computed from the quaternion of the body, which may have any
    /// length.
    Rotation {
        /// Index of the body.
        body: usize,
        /// Axis of the ground.
        row: usize,
        /// Principal axis of the body.
        column: usize,
    },
    /// A velocity, by its index in v.
    Velocity(usize),
    /// A function of time as used by the mechanism, or a derivative of such a function.
    Function {
        /// Index of the function, in the order of [`crate::Mechanism::functions`].
        function: usize,
        /// Order of the derivative: 0, 1 or 2.
        derivative: usize,
    },
}

/// Poses, twists and functions of time of one element.
type Arguments<'a, S> = (
    Vec<<S as joints::Space>::Pose<RecordedNumber>>,
    Vec<<S as joints::Space>::Twist<RecordedNumber>>,
    &'a [[RecordedNumber; 3]],
);

/// Poses and twists of all bodies, and functions of time, as inputs of a recording.
pub(crate) struct RecordedSlots {
    poses: Poses<RecordedNumber>,
    twists: Twists<RecordedNumber>,
    jets: Vec<[RecordedNumber; 3]>,
    /// Coordinates and velocities of all bodies.
    q: Vec<RecordedNumber>,
    v: Vec<RecordedNumber>,
}

impl RecordedSlots {
    /// Creates the inputs of a mechanism. The function `input` returns the recorded number of each
    /// input.
    pub(crate) fn new(
        space: SpaceKind,
        bodies: usize,
        functions: usize,
        mut input: impl FnMut(Input) -> RecordedNumber,
    ) -> Self {
        let (mut q, mut poses, mut twists) = (Vec::new(), InEach::default(), InEach::default());
        for body in 0..bodies {
            let own: Vec<RecordedNumber> = space
                .coordinates(body)
                .map(|k| input(Input::Coordinate(k)))
                .collect();
            q.extend_from_slice(&own);
            match space {
                SpaceKind::Space3 => {
                    let of = |row, column| Input::Rotation { body, row, column };
                    let rot = [0, 1, 2].map(|row| [0, 1, 2].map(|column| input(of(row, column))));
                    let r = [own[0], own[1], own[2]];
                    poses.space3.push(space3::Pose { r, rot });
                }
                _ => {
                    let angle = space.coordinates(body).start + 2;
                    poses.plane.push(Pose {
                        x: own[0],
                        y: own[1],
                        angle: own[2],
                        cos: input(Input::Cos(angle)),
                        sin: input(Input::Sin(angle)),
                    });
                }
            }
        }
        let columns = 0..space.n_v() * bodies;
        let v: Vec<RecordedNumber> = columns.map(|k| input(Input::Velocity(k))).collect();
        for own in v.chunks_exact(space.n_v()) {
            match space {
                SpaceKind::Space3 => twists.space3.push(Space3::twist(own)),
                _ => twists.plane.push(Plane::twist(own)),
            }
        }
        let jets = (0..functions).map(|function| {
            [0, 1, 2].map(|derivative| {
                input(Input::Function {
                    function,
                    derivative,
                })
            })
        });
        Self {
            poses,
            twists,
            jets: jets.collect(),
            q,
            v,
        }
    }

    /// Returns the coordinates and velocities of all bodies.
    pub(crate) fn state(&self) -> (&[RecordedNumber], &[RecordedNumber]) {
        (&self.q, &self.v)
    }

    /// Returns the angular velocity of each spatial body in its principal axes.
    pub(crate) fn spins(&self) -> impl Iterator<Item = [RecordedNumber; 3]> + '_ {
        self.twists.space3.iter().map(|twist| twist.omega)
    }

    /// Computes Φ of the holonomic rows of a constraint.
    pub(crate) fn phi(&self, constraint: &PlacedConstraint, out: &mut [RecordedNumber]) {
        with!(AnyConstraint, constraint.kernels(), element, S => {
            let (x, _, f) = self.of::<S>(&constraint.site);
            element.programs().of(&stored(element.as_ref())).phi::<S>(&x, f, out);
        });
    }

    /// Computes C of a constraint.
    pub(crate) fn c(&self, constraint: &PlacedConstraint, out: &mut [RecordedNumber]) {
        with!(AnyConstraint, constraint.kernels(), element, S => {
            let (x, _, f) = self.of::<S>(&constraint.site);
            element.programs().of(&stored(element.as_ref())).c::<S>(&x, f, out);
        });
    }

    /// Computes b of a constraint.
    pub(crate) fn b(&self, constraint: &PlacedConstraint, out: &mut [RecordedNumber]) {
        with!(AnyConstraint, constraint.kernels(), element, S => {
            let (x, _, f) = self.of::<S>(&constraint.site);
            element.programs().of(&stored(element.as_ref())).b::<S>(&x, f, out);
        });
    }

    /// Computes Γ of a constraint.
    pub(crate) fn gamma(&self, constraint: &PlacedConstraint, out: &mut [RecordedNumber]) {
        with!(AnyConstraint, constraint.kernels(), element, S => {
            let (x, v, f) = self.of::<S>(&constraint.site);
            element.programs().of(&stored(element.as_ref())).gamma::<S>(&x, &v, f, out);
        });
    }

    /// Returns the poses, twists and functions of time of an element.
    pub(super) fn of<S: Kinematics>(&self, site: &Site) -> Arguments<'_, S> {
        let rest = || S::twist(&[RecordedNumber::from(0.0); 6]);
        let twist = |b: &BodyRef| b.moving().map_or_else(rest, |k| S::twists(&self.twists)[k]);
        (
            site.bodies
                .iter()
                .map(|&b| pose_of::<S, RecordedNumber>(&self.poses, b))
                .collect(),
            site.bodies.iter().map(twist).collect(),
            &self.jets[site.functions.clone()],
        )
    }
}
