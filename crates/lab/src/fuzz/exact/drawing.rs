//! Bodies and joints at one configuration, in fractions. A drawing may be stretched along its
//! second axis by √k: forces act along lines, and which lines depend on each other does not change
//! when the plane is stretched. So configurations with irrational coordinates, as of three wheels
//! at 120°, have an exact answer in fractions.

use super::ratio::Ratio;

/// A point or vector of the drawing.
pub type Vector = [Ratio; 2];

/// A body by its place, or the ground.
pub type Side = Option<usize>;

/// The ground.
pub const GROUND: Side = None;

/// A mechanism at one configuration.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The second coordinate is stretched by √stretch.
    pub stretch: u32,
    /// For each body where its origin lies, if that matters.
    pub origins: Vec<Option<Vector>>,
    /// Joints and drives.
    pub links: Vec<Link>,
    /// The redundancy, where theory tells it without any arithmetic.
    pub redundancy: Option<usize>,
    /// Theory tells that the rank is the same at all configurations.
    pub has_constant_rank: bool,
    /// Positions of bodies are off by one unit in the last place, as a script writes them.
    pub is_careless: bool,
}

/// A joint or drive.
#[derive(Clone, Debug)]
pub struct Link {
    /// Its name.
    pub name: String,
    /// One side for each slot.
    pub sides: Vec<Side>,
    /// What it is, and where.
    pub tie: Tie,
}

/// What a joint or drive does. `at` lies on its last body that has a point, `from` on its first;
/// `along` is a line of force.
#[derive(Clone, Copy, Debug)]
pub enum Tie {
    /// Both bodies share a point.
    Revolute {
        /// The point.
        at: Vector,
    },
    /// A weld.
    Fixed {
        /// The place.
        at: Vector,
    },
    /// A slider of the second body on a line of the first that is perpendicular to `along`.
    Translational {
        /// A point of the line on the first body.
        from: Vector,
        /// The slider.
        at: Vector,
        /// Across the line.
        along: Vector,
    },
    /// A pin of the second body in a slot of the first that is perpendicular to `along`.
    PinInSlot {
        /// A point of the slot.
        from: Vector,
        /// The pin.
        at: Vector,
        /// Across the slot.
        along: Vector,
    },
    /// A point on a line of the ground that is perpendicular to `along`.
    PointOnLine {
        /// The point.
        at: Vector,
        /// Across the line.
        along: Vector,
    },
    /// A massless rod.
    Distance {
        /// Its end on the first body.
        from: Vector,
        /// Its end on the second body.
        at: Vector,
    },
    /// Equal rotations.
    Angle,
    /// Rotations in a ratio, relative to the third side, which is always there.
    Gear {
        /// The ratio.
        ratio: Ratio,
    },
    /// A pinion, the second body, on a rack.
    Rack {
        /// Its centre.
        at: Vector,
        /// The rack.
        along: Vector,
        /// Torque of a unit of `along` about the centre, in units of the drawing.
        radius: Ratio,
    },
    /// A wheel or blade.
    KnifeEdge {
        /// Where it touches.
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
    /// A wheel, the second body, that rolls as the point of the first moves.
    Rolling {
        /// The point on the first body.
        at: Vector,
        /// The way of rolling.
        along: Vector,
        /// Torque of a unit of `along` on the wheel, in units of the drawing.
        radius: Ratio,
    },
    /// A drive of the angle of a revolute joint.
    AngleDrive {
        /// The place of the joint among the links.
        joint: usize,
    },
}

impl Tie {
    /// Whether it restricts velocities only.
    #[must_use]
    pub fn is_nonholonomic(&self) -> bool {
        matches!(
            self,
            Self::KnifeEdge { .. } | Self::Velocity { .. } | Self::Rolling { .. }
        )
    }

    /// Whether it prescribes a motion.
    #[must_use]
    pub fn is_drive(&self) -> bool {
        matches!(self, Self::AngleDrive { .. })
    }

    /// The points that it names.
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

    /// Whether its rows are those of the axes of the world, so that it can be turned in a stretched
    /// drawing by quarters only.
    #[must_use]
    pub fn has_axes(&self) -> bool {
        matches!(self, Self::Revolute { .. } | Self::Fixed { .. })
    }
}

impl Link {
    /// The same joint with its first two bodies exchanged. `None` if there is no such joint.
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
    /// Nothing yet.
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

    /// Adds a body whose origin may lie anywhere.
    pub fn body(&mut self) -> Side {
        self.origins.push(None);
        Some(self.origins.len() - 1)
    }

    /// Adds a body with its origin here.
    pub fn body_at(&mut self, origin: Vector) -> Side {
        self.origins.push(Some(origin));
        Some(self.origins.len() - 1)
    }

    /// Adds a joint or drive, and returns its place.
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

    /// A direction along the line on which a point may move that a force along `u` holds:
    /// perpendicular to it once the plane is stretched.
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

/// `p + factor·d`
#[must_use]
pub fn along(p: Vector, factor: Ratio, d: Vector) -> Vector {
    [p[0] + factor * d[0], p[1] + factor * d[1]]
}
