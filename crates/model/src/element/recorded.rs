//! Arguments of kernels as inputs of a recording.

use joints::Recorded;
use joints::plane::{Pose, Twist};

use super::bodies::{InEach, Poses, Twists};
use super::slots::{Kinematics, Site, pose_of};
use crate::body::BodyRef;
use crate::space::Space;

/// Meaning of an input of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A coordinate, by its index in q.
    Coordinate(usize),
    /// The cosine of the coordinate with this index in q.
    Cos(usize),
    /// The sine of the coordinate with this index in q.
    Sin(usize),
    /// A velocity, by its index in v.
    Velocity(usize),
    /// A function of time as used by the mechanism, or a derivative of it.
    Function {
        /// Index of the function, in the order of [`crate::Mechanism::functions`].
        function: usize,
        /// Order of the derivative: 0, 1 or 2.
        derivative: usize,
    },
}

/// Poses, twists and functions of time of one element.
type Arguments<'a, S> = (
    Vec<<S as joints::Space>::Pose<Recorded>>,
    Vec<<S as joints::Space>::Twist<Recorded>>,
    &'a [[Recorded; 3]],
);

/// Poses and twists of all bodies, and functions of time, as inputs of a recording.
pub(crate) struct RecordedSlots {
    poses: Poses<Recorded>,
    twists: Twists<Recorded>,
    jets: Vec<[Recorded; 3]>,
}

impl RecordedSlots {
    /// Inputs of a planar mechanism whose coordinates are positions and angles; `input` gives the
    /// number of each.
    pub(crate) fn new(
        bodies: usize,
        functions: usize,
        mut input: impl FnMut(Input) -> Recorded,
    ) -> Self {
        const N: usize = <crate::space::Plane as Space>::N_Q;
        let poses = (0..bodies).map(|k| Pose {
            x: input(Input::Coordinate(N * k)),
            y: input(Input::Coordinate(N * k + 1)),
            angle: input(Input::Coordinate(N * k + 2)),
            cos: input(Input::Cos(N * k + 2)),
            sin: input(Input::Sin(N * k + 2)),
        });
        let poses = InEach {
            plane: poses.collect(),
            space3: Vec::new(),
        };
        let twists = (0..bodies).map(|k| Twist {
            x: input(Input::Velocity(N * k)),
            y: input(Input::Velocity(N * k + 1)),
            omega: input(Input::Velocity(N * k + 2)),
        });
        let twists = InEach {
            plane: twists.collect(),
            space3: Vec::new(),
        };
        let jets = (0..functions).map(|function| {
            [0, 1, 2].map(|derivative| {
                input(Input::Function {
                    function,
                    derivative,
                })
            })
        });
        let jets = jets.collect();
        Self {
            poses,
            twists,
            jets,
        }
    }

    /// Poses, twists and functions of time of an element.
    pub(super) fn of<S: Kinematics>(&self, site: &Site) -> Arguments<'_, S> {
        let rest = || S::twist(&[Recorded::from(0.0); 6]);
        let twist = |b: &BodyRef| b.moving().map_or_else(rest, |k| S::twists(&self.twists)[k]);
        (
            site.bodies
                .iter()
                .map(|&b| pose_of::<S, Recorded>(&self.poses, b))
                .collect(),
            site.bodies.iter().map(twist).collect(),
            &self.jets[site.functions.clone()],
        )
    }
}
