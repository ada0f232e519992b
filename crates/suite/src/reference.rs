//! Reference values: known values of a motion at given instants, and the accuracy of these values.

/// A quantity of a body, a joint or a drive, in SI units and radians, with global components.
/// Reactions are the forces on the first body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Coordinate x of the centre of mass.
    X,
    /// Coordinate y of the centre of mass.
    Y,
    /// Angle of the body.
    Angle,
    /// Time derivative of x.
    Vx,
    /// Time derivative of y.
    Vy,
    /// Time derivative of the angle.
    Omega,
    /// Time derivative of vx.
    Ax,
    /// Time derivative of vy.
    Ay,
    /// Time derivative of the angular velocity `omega`.
    Alpha,
    /// Force along x.
    Fx,
    /// Force along y.
    Fy,
    /// Torque about the reference point of the joint.
    Torque,
    /// Force along the normal of a knife edge.
    Normal,
}

/// Kind of a quantity; quantities of the same kind are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Coordinates.
    Position,
    /// Time derivatives of the coordinates.
    Velocity,
    /// Second time derivatives.
    Acceleration,
    /// Forces and torques of joints and drives.
    Reaction,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 4] = [
        Self::Position,
        Self::Velocity,
        Self::Acceleration,
        Self::Reaction,
    ];

    /// Returns the name of the kind in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Reaction => "reaction",
        }
    }
}

impl Quantity {
    /// All quantities with their names in tables: the names in `trajectory.csv` and
    /// `reactions.csv`, and `ax`, `ay`, `alpha`.
    pub const NAMES: [(Self, &'static str); 13] = [
        (Self::X, "x"),
        (Self::Y, "y"),
        (Self::Angle, "angle"),
        (Self::Vx, "vx"),
        (Self::Vy, "vy"),
        (Self::Omega, "omega"),
        (Self::Ax, "ax"),
        (Self::Ay, "ay"),
        (Self::Alpha, "alpha"),
        (Self::Fx, "Fx"),
        (Self::Fy, "Fy"),
        (Self::Torque, "T"),
        (Self::Normal, "N"),
    ];

    /// Returns the kind of the quantity.
    #[must_use]
    pub fn kind(self) -> Kind {
        match self {
            Self::X | Self::Y | Self::Angle => Kind::Position,
            Self::Vx | Self::Vy | Self::Omega => Kind::Velocity,
            Self::Ax | Self::Ay | Self::Alpha => Kind::Acceleration,
            Self::Fx | Self::Fy | Self::Torque | Self::Normal => Kind::Reaction,
        }
    }
}

/// One known value.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// The body, joint or drive.
    pub of: String,
    /// The quantity.
    pub quantity: Quantity,
    /// The value.
    pub value: f64,
}

/// The known values at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Time (s).
    pub t: f64,
    /// Values.
    pub facts: Vec<Fact>,
}

/// Largest errors of the values of each kind, relative to the largest value of the kind. The error
/// is infinite if no value of the kind is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trust {
    /// Coordinates.
    pub position: f64,
    /// Velocities.
    pub velocity: f64,
    /// Accelerations.
    pub acceleration: f64,
    /// Reactions.
    pub reaction: f64,
}

impl Trust {
    /// No value is known.
    pub const NOTHING: Self = Self {
        position: f64::INFINITY,
        velocity: f64::INFINITY,
        acceleration: f64::INFINITY,
        reaction: f64::INFINITY,
    };

    /// Returns the error of one kind.
    #[must_use]
    pub fn of(&self, kind: Kind) -> f64 {
        match kind {
            Kind::Position => self.position,
            Kind::Velocity => self.velocity,
            Kind::Acceleration => self.acceleration,
            Kind::Reaction => self.reaction,
        }
    }

    pub(crate) fn of_mut(&mut self, kind: Kind) -> &mut f64 {
        match kind {
            Kind::Position => &mut self.position,
            Kind::Velocity => &mut self.velocity,
            Kind::Acceleration => &mut self.acceleration,
            Kind::Reaction => &mut self.reaction,
        }
    }
}

/// The known values of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The source of the values.
    pub source: String,
    /// The accuracy of the values.
    pub trust: Trust,
    /// The values at each time, in the order of time.
    pub instants: Vec<Instant>,
}
