//! Reference values: what is known of a motion, at which instants, and how well.

/// What a value says of a body, a joint or a drive. SI units and radians, global components;
/// reactions are forces on the first body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Centre of mass, x.
    X,
    /// Centre of mass, y.
    Y,
    /// Angle of the body.
    Angle,
    /// Rate of x.
    Vx,
    /// Rate of y.
    Vy,
    /// Rate of the angle.
    Omega,
    /// Rate of vx.
    Ax,
    /// Rate of vy.
    Ay,
    /// Rate of omega.
    Alpha,
    /// Force along x.
    Fx,
    /// Force along y.
    Fy,
    /// Torque about the place of the joint.
    Torque,
    /// Force along the normal of a knife edge.
    Normal,
}

/// What is compared with its like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Coordinates.
    Position,
    /// Their rates.
    Velocity,
    /// Rates of the rates.
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

    /// Its name in tables.
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
    /// All quantities with their names in tables: those of `trajectory.csv` and `reactions.csv`,
    /// and `ax`, `ay`, `alpha`.
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

    /// What it is compared with.
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
    /// What of it.
    pub quantity: Quantity,
    /// The value.
    pub value: f64,
}

/// What is known at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Time (s).
    pub t: f64,
    /// Values.
    pub facts: Vec<Fact>,
}

/// How far values of each kind are from the truth at most, relative to the largest value of the
/// kind; infinite if nothing of the kind is known.
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
    /// Nothing is known.
    pub const NOTHING: Self = Self {
        position: f64::INFINITY,
        velocity: f64::INFINITY,
        acceleration: f64::INFINITY,
        reaction: f64::INFINITY,
    };

    /// That of one kind.
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

/// What is known of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Where the values come from.
    pub source: String,
    /// How well they are known.
    pub trust: Trust,
    /// Values, in the order of time.
    pub instants: Vec<Instant>,
}
