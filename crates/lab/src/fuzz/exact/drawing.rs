//! Bodies and joints at one configuration, with rational coordinates. A drawing may be stretched
//! along its second axis by √k. Forces act along lines, and the dependencies between lines do not
//! change when the plane is stretched. Therefore configurations with irrational coordinates, such
//! as three wheels at 120°, can be analysed exactly with rational numbers.

use super::ratio::Ratio;

/// A point or vector of the drawing.
pub type Vector = [Ratio; 2];

/// A body by its index, or the ground.
pub type Side = Option<usize>;

/// The ground.
pub const GROUND: Side = None;

/// A mechanism at one configuration.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The second coordinate is stretched by √stretch.
    pub stretch: u32,
    /// The origin of each body, if its position matters.
    pub origins: Vec<Option<Vector>>,
    /// Joints and drives.
    pub links: Vec<Link>,
    /// The redundancy, if theory gives it without computation.
    pub redundancy: Option<usize>,
    /// Whether theory shows that the rank is the same at all configurations.
    pub has_constant_rank: bool,
    /// Whether the positions of bodies have errors of one unit in the last place, like positions
    /// computed by a script.
    pub is_careless: bool,
}

/// A joint or drive.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name of the joint or drive.
    pub name: String,
    /// Bodies (or the ground) in the order of the arguments of the joint or drive.
    pub sides: Vec<Side>,
    /// Kind and position of the joint or drive.
    pub tie: Tie,
}

/// The kind of a joint or drive. The point `from` is on the first body of the joint, and `at` is on
/// the last body that has a point. The vector `along` is the direction of a force.
#[derive(Clone, Copy, Debug)]
pub enum Tie {
    /// Both bodies share a point.
    Revolute {
        /// The point.
        at: Vector,
    },
    /// A rigid connection.
    Fixed {
        /// The reference point.
        at: Vector,
    },
    /// A slider of the second body on a line of the first body. The line is perpendicular to
    /// `along`.
    Translational {
        /// A point of the line on the first body.
        from: Vector,
        /// The slider.
        at: Vector,
        /// The normal of the line.
        along: Vector,
    },
    /// A pin of the second body in a slot of the first body. The slot is perpendicular to `along`.
    PinInSlot {
        /// A point of the slot.
        from: Vector,
        /// The pin.
        at: Vector,
        /// The normal of the slot.
        along: Vector,
    },
    /// A point on a line of the ground. The line is perpendicular to `along`.
    PointOnLine {
        /// The point.
        at: Vector,
        /// The normal of the line.
        along: Vector,
    },
    /// A massless rod.
    Distance {
        /// The end on the first body.
        from: Vector,
        /// The end on the second body.
        at: Vector,
    },
    /// Equal rotations.
    Angle,
    /// Rotations in a fixed ratio, relative to the third side, which is always given.
    Gear {
        /// The ratio.
        ratio: Ratio,
    },
    /// A pinion, the second body, on a rack.
    Rack {
        /// The centre of the pinion.
        at: Vector,
        /// The direction of the rack.
        along: Vector,
        /// Torque of a unit force along `along` about the centre, in units of the drawing.
        radius: Ratio,
    },
    /// A wheel or knife edge.
    KnifeEdge {
        /// The contact point.
        at: Vector,
        /// The normal.
        along: Vector,
    },
    /// A velocity that is prescribed to be zero.
    Velocity {
        /// The point.
        at: Vector,
        /// The direction.
        along: Vector,
    },
    /// A wheel, the second body, that rolls while the point of the first body moves.
    Rolling {
        /// The point on the first body.
        at: Vector,
        /// The direction of rolling.
        along: Vector,
        /// Torque of a unit force along `along` on the wheel, in units of the drawing.
        radius: Ratio,
    },
    /// A drive of the angle of a revolute joint.
    AngleDrive {
        /// The index of the joint among the links.
        joint: usize,
    },
}

impl Tie {
    /// Whether the element restricts only velocities.
    #[must_use]
    pub fn is_nonholonomic(&self) -> bool {
        matches!(
            self,
            Self::KnifeEdge { .. } | Self::Velocity { .. } | Self::Rolling { .. }
        )
    }

    /// Whether the element prescribes a motion.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        matches!(self, Self::AngleDrive { .. })
    }

    /// Returns the points that the element contains.
    #[must_use]
    pub fn points(&self) -> Vec<Vector> {
        match *self {
            Self::Translational { from, at, .. }
            | Self::PinInSlot { from, at, .. }
            | Self::Distance { from, at } => vec![from, at],
            Self::Revolute { at }
            | Self::Fixed { at }
            | Self::PointOnLine { at, .. }
            | Self::Rack { at, .. }
            | Self::KnifeEdge { at, .. }
            | Self::Velocity { at, .. }
            | Self::Rolling { at, .. } => vec![at],
            Self::Angle | Self::Gear { .. } | Self::AngleDrive { .. } => Vec::new(),
        }
    }

    /// Whether the rows of the element are parallel to the axes of the world, so that a stretched
    /// drawing with this element can be rotated only by multiples of 90°.
    #[must_use]
    pub fn has_axes(&self) -> bool {
        matches!(self, Self::Revolute { .. } | Self::Fixed { .. })
    }
}

impl Link {
    /// Returns the same joint with its first two bodies exchanged. Returns `None` if there is no
    /// such joint.
    #[must_use]
    pub fn swapped(&self) -> Option<Self> {
        let tie = match self.tie {
            Tie::Revolute { .. } | Tie::Fixed { .. } | Tie::Angle => self.tie,
            Tie::Translational { from, at, along } => Tie::Translational {
                from: at,
                at: from,
                along,
            },
            Tie::Distance { from, at } => Tie::Distance { from: at, at: from },
            Tie::Gear { ratio } => Tie::Gear {
                ratio: ratio.inverse(),
            },
            _ => return None,
        };
        let mut sides = self.sides.clone();
        sides.swap(0, 1);
        Some(Self {
            name: self.name.clone(),
            sides,
            tie,
        })
    }
}

impl Drawing {
    /// Creates an empty drawing.
    #[must_use]
    pub fn new() -> Self {
        Self {
            stretch: 1,
            origins: Vec::new(),
            links: Vec::new(),
            redundancy: None,
            has_constant_rank: false,
            is_careless: false,
        }
    }

    /// Adds a body whose origin may be anywhere.
    pub fn body(&mut self) -> Side {
        self.origins.push(None);
        Some(self.origins.len() - 1)
    }

    /// Adds a body with this origin.
    pub fn body_at(&mut self, origin: Vector) -> Side {
        self.origins.push(Some(origin));
        Some(self.origins.len() - 1)
    }

    /// Adds a joint or drive, and returns its index.
    pub fn link(&mut self, sides: &[Side], tie: Tie) -> usize {
        let place = self.links.len();
        self.links.push(Link {
            name: format!("j{place}"),
            sides: sides.to_vec(),
            tie,
        });
        place
    }

    /// Drives the angle of a revolute joint.
    pub fn drive(&mut self, joint: usize) {
        let sides = self.links[joint].sides.clone();
        self.link(&sides, Tie::AngleDrive { joint });
    }

    /// Returns the direction in which a point can move if a force along `u` constrains the point.
    /// After the plane is stretched, this direction is perpendicular to `u`.
    #[must_use]
    pub fn across(&self, [x, y]: Vector) -> Vector {
        [Ratio::whole(i64::from(self.stretch)) * y, -x]
    }
}

impl Default for Drawing {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns `p + factor·d`.
#[must_use]
pub fn along(p: Vector, factor: Ratio, d: Vector) -> Vector {
    [p[0] + factor * d[0], p[1] + factor * d[1]]
}
