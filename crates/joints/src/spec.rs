//! Specifications of definitions, as constants of the generated code, so that a scene reader, an
//! assembler and a report can handle any joint.

use std::fmt;
use std::ops::Range;

/// Common parts of the specifications of constraints and forces.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Name of the definition, for example `PinInSlot`.
    pub name: &'static str,
    /// Value of `type` in a scene file, for example `pin-in-slot`.
    pub scene_type: &'static str,
    /// The key that distinguishes definitions with the same scene type, if there are several.
    pub variant: Option<Variant>,
    /// The definition's doc comment.
    pub doc: &'static str,
    /// The source text of the definition.
    pub text: &'static str,
    /// Names of the body slots, for example `["i", "j"]`.
    pub slots: &'static [&'static str],
    /// Parameters, in the order of their arguments.
    pub parameters: &'static [Parameter],
    /// Whether a scene gives one common reference point (`at = [x, y]`) or one point for each point
    /// parameter.
    pub points_apart: bool,
    /// Whether two joints that a scene names define the bodies, points and axes of the definition,
    /// except the last point. The first two slots are wheels, and each of the joints supports one
    /// of them on the body in the third slot. The first point and the first axes in the third slot
    /// belong to the first bearing, the second ones to the second bearing. The third point is the
    /// reference point.
    pub bearings: bool,
    /// Requirements on the assembled start, as text, in the order of `requirement`.
    pub requirements: &'static [&'static str],
}

impl Spec {
    /// The slots of the bodies in whose frames the points are given, in the order of the points.
    pub fn slots_of_points(&self) -> impl Iterator<Item = usize> + use<> {
        self.parameters.iter().filter_map(|p| match p.shape {
            Shape::Point { slot } => Some(slot),
            _ => None,
        })
    }

    /// Units of the functions of time that the kernels use, in the order of `f`.
    pub fn functions(&self) -> impl Iterator<Item = (&'static str, Unit)> + use<> {
        self.parameters.iter().flat_map(|p| {
            let units = match p.shape {
                Shape::Functions(units) => units,
                _ => &[],
            };
            units.iter().map(|u| (p.name, *u))
        })
    }
}

/// The key that distinguishes definitions of one scene type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Name of the key.
    pub key: &'static str,
    /// Value of the key for this definition.
    pub value: &'static str,
    /// Whether this definition is selected if the key is not given.
    pub default: bool,
}

/// One parameter of a definition.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name, which is the key in a scene file unless the parameter is a point.
    pub name: &'static str,
    /// Kind of the value.
    pub shape: Shape,
    /// Whether the parameter may be omitted: then its value at the assembled start is used.
    pub optional: bool,
    /// Doc comment of the parameter: its purpose in one sentence. Frame and unit follow from the
    /// shape.
    pub doc: &'static str,
}

impl Parameter {
    /// A parameter that must be given.
    #[must_use]
    pub const fn required(name: &'static str, shape: Shape, doc: &'static str) -> Self {
        Self {
            name,
            shape,
            optional: false,
            doc,
        }
    }

    /// A parameter that may be omitted: then its value at the assembled start is used.
    #[must_use]
    pub const fn optional(name: &'static str, shape: Shape, doc: &'static str) -> Self {
        Self {
            name,
            shape,
            optional: true,
            doc,
        }
    }
}

/// Kind of value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A point in the frame of the body in this slot.
    Point {
        /// The slot.
        slot: usize,
    },
    /// A direction in the frame of the body in this slot.
    Direction {
        /// The slot.
        slot: usize,
    },
    /// An axis of space in the frame of the body in this slot, with the directions across it.
    Axes {
        /// The slot.
        slot: usize,
        /// Index of the parameter to whose axes these are parallel at the described start, unless
        /// they are given.
        like: Option<usize>,
    },
    /// A straight line of the ground through two points.
    GroundLine,
    /// A plane of the ground: a point, and a vector normal to it.
    GroundPlane,
    /// Numbers with their units; one number is written without brackets.
    Numbers(&'static [Unit]),
    /// Functions of time with the units of their values.
    Functions(&'static [Unit]),
}

impl Shape {
    /// Description of the shape, with as many coordinates as vectors have components.
    #[must_use]
    pub fn words(self, dim: usize) -> impl fmt::Display {
        ShapeWords { shape: self, dim }
    }
}

/// Description of a shape.
struct ShapeWords {
    shape: Shape,
    dim: usize,
}

impl fmt::Display for ShapeWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let vector = if self.dim == 3 { "[x, y, z]" } else { "[x, y]" };
        match self.shape {
            Shape::Point { .. } => write!(f, "a point {vector}"),
            Shape::Direction { .. } => write!(f, "a direction {vector}"),
            Shape::Axes { .. } => write!(f, "the direction {vector} of an axis"),
            Shape::GroundLine => write!(f, "two points [{vector}, {vector}]"),
            Shape::GroundPlane => write!(f, "a plane {{ point = {vector}, normal = {vector} }}"),
            Shape::Numbers(units) => {
                let range = if units.iter().any(|unit| unit.may_be_negative()) {
                    ""
                } else {
                    " ≥ 0"
                };
                match units {
                    [unit] => write!(f, "a number{range} ({unit})"),
                    _ => write!(f, "{} numbers{range} ({})", units.len(), list(units)),
                }
            }
            Shape::Functions([unit]) => write!(f, "a number or a function of time ({unit})"),
            Shape::Functions(units) => {
                write!(
                    f,
                    "{} numbers or functions of time ({})",
                    units.len(),
                    list(units)
                )
            }
        }
    }
}

fn list(units: &[Unit]) -> String {
    units
        .iter()
        .map(Unit::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}

/// Unit of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// m
    Length,
    /// m, not negative
    Radius,
    /// rad
    Angle,
    /// 1
    Ratio,
    /// m/s
    Velocity,
    /// rad/s
    AngularVelocity,
    /// N
    Force,
    /// N·m
    Torque,
    /// N/m, not negative
    Stiffness,
    /// N·m/rad, not negative
    TorsionStiffness,
    /// N·s/m, not negative
    Damping,
    /// N·m·s/rad, not negative
    TorsionDamping,
    /// N/rad, not negative
    CorneringStiffness,
    /// 1/m, only for values stored at the start
    PerLength,
}

impl Unit {
    /// Whether negative values are allowed.
    #[must_use]
    pub fn may_be_negative(self) -> bool {
        !matches!(
            self,
            Self::Radius
                | Self::Stiffness
                | Self::TorsionStiffness
                | Self::Damping
                | Self::TorsionDamping
                | Self::CorneringStiffness
        )
    }

    /// Whether it is the unit of lengths.
    #[must_use]
    pub fn is_length(self) -> bool {
        matches!(self, Self::Length | Self::Radius)
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length | Self::Radius => "m",
            Self::Angle => "rad",
            Self::Ratio => "1",
            Self::Velocity => "m/s",
            Self::AngularVelocity => "rad/s",
            Self::Force => "N",
            Self::Torque => "N·m",
            Self::Stiffness => "N/m",
            Self::TorsionStiffness => "N·m/rad",
            Self::Damping => "N·s/m",
            Self::TorsionDamping => "N·m·s/rad",
            Self::CorneringStiffness => "N/rad",
            Self::PerLength => "1/m",
        })
    }
}

/// Specification of a constraint definition.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintSpec {
    /// The common parts of constraints and forces.
    pub common: Spec,
    /// Joint, or drive of a joint coordinate.
    pub role: Role,
    /// Rows: `Φ(q, t) = 0`, then `Ψ(q, t)·q̇ + ψ(q, t) = 0`.
    pub rows: &'static [Row],
    /// Number of holonomic rows; they are the first rows.
    pub holonomic: usize,
    /// Entries of the block of C that are not identically zero, row by row.
    pub c: &'static [Entry],
    /// Whether the constraint depends on time explicitly, so that b is not identically zero.
    pub rheonomic: bool,
    /// Entries (component, row) of the map from multipliers to the wrench on the first body that
    /// are not identically zero.
    pub wrench: &'static [[usize; 2]],
    /// A named force component in addition to the components of the wrench.
    pub component: Option<&'static str>,
    /// A note for readers of the reaction, without the name of the joint.
    pub note: Option<&'static str>,
    /// Relative coordinates that a drive may prescribe.
    pub measures: &'static [Measure],
    /// Whether kernels use the cosine and the sine of the function of time instead of the function
    /// itself, each with two derivatives: drives of angles in space.
    pub turning: bool,
    /// Number of angles of space that the kernels receive with their full revolutions. Each has
    /// three values after the functions of time: the angle since the start, its cosine and its
    /// sine; their derivatives are not used.
    pub turns: usize,
    /// Pattern (row of the block, column of the block) of `∂(Cᵀλ)/∂x`.
    pub d_force_dx: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂(C·a − Γ)/∂x`.
    pub d_residual_dx: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂Γ/∂v`.
    pub d_gamma_dv: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂(C·v − b)/∂x`.
    pub d_velocity_dx: &'static [[usize; 2]],
    /// The numbers that the constraint stores: parameters, followed by values stored at the start.
    /// Each number that is not computed from others belongs to exactly one datum.
    pub data: &'static [Datum],
}

impl ConstraintSpec {
    /// Number of values in `data`.
    #[must_use]
    pub const fn n_data(&self) -> usize {
        match self.data {
            [.., last] => last.first + last.count,
            [] => 0,
        }
    }

    /// Number of values with derivatives in the input `f` of the kernels: functions of time, of
    /// which one may be replaced by its cosine and sine, and three for each unwrapped angle.
    #[must_use]
    pub fn n_jets(&self) -> usize {
        self.common.functions().count() + usize::from(self.turning) + 3 * self.turns
    }

    /// Number of nonholonomic rows, which follow the holonomic ones.
    #[must_use]
    pub const fn nonholonomic(&self) -> usize {
        self.rows.len() - self.holonomic
    }
}

/// Numbers stored by a constraint that belong together: a point, a direction, or a single number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Datum {
    /// Name of the parameter or of the stored value; `name[k]` for one number of a list.
    pub name: &'static str,
    /// Kind of the numbers.
    pub shape: DatumShape,
    /// Index of the first number among the numbers of the constraint.
    pub first: usize,
    /// Count of the numbers.
    pub count: usize,
}

impl Datum {
    /// The datum with `count` numbers from `first` on.
    #[must_use]
    pub const fn new(name: &'static str, shape: DatumShape, first: usize, count: usize) -> Self {
        Self {
            name,
            shape,
            first,
            count,
        }
    }

    /// Indices of the numbers among the numbers of the constraint.
    #[must_use]
    pub fn numbers(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

/// Kind of the numbers of a datum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DatumShape {
    /// As many numbers as a vector has components: a point in the frame of the body in this slot
    /// (m).
    Point {
        /// The slot.
        slot: usize,
    },
    /// Components of a unit vector in the frame of the body in this slot. Only changes
    /// perpendicular to the vector are meaningful.
    Direction {
        /// The slot.
        slot: usize,
    },
    /// Three numbers: the rotation vector of axes in the frame of the body in this slot (rad); they
    /// are zero for the stored axes.
    Axes {
        /// The slot.
        slot: usize,
    },
    /// Four numbers: x and y of the start of a line of the ground (m), and of the unit vector of
    /// the line.
    Line,
    /// Six numbers: a point of a plane of the ground (m), and its unit normal.
    Plane,
    /// One number. An optional number that is not given has its value at the start.
    Number(Unit),
    /// One number stored at the start; an angle that is stored by its cosine and sine has the value
    /// 0 for the stored angle.
    Kept(Unit),
    /// Components, in the frame of the body in this slot, of a vector stored at the start (m).
    KeptVector {
        /// The slot.
        slot: usize,
    },
}

/// Purpose of a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Connects bodies.
    Joint,
    /// Prescribes a joint coordinate.
    Drive,
}

/// One row of a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// Name of the row within the joint.
    pub name: &'static str,
    /// Whether the row restricts the start: a row that stores an initial value is satisfied at any
    /// start.
    pub restricts_start: bool,
}

impl Row {
    /// A row that restricts the start.
    #[must_use]
    pub const fn restricting_start(name: &'static str) -> Self {
        Self {
            name,
            restricts_start: true,
        }
    }

    /// A row that stores an initial value.
    #[must_use]
    pub const fn keeping_start(name: &'static str) -> Self {
        Self {
            name,
            restricts_start: false,
        }
    }
}

/// One entry of the block of C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Row of the constraint.
    pub row: usize,
    /// Body slot.
    pub slot: usize,
    /// Degree of freedom of the body: 0 x, 1 y, 2 rotation in the plane; 0 x, 1 y, 2 z, 3 to 5
    /// rotations in space.
    pub dof: usize,
    /// Whether the entry depends only on parameters.
    pub constant: bool,
}

impl Entry {
    /// An entry that depends only on parameters.
    #[must_use]
    pub const fn constant(row: usize, slot: usize, dof: usize) -> Self {
        Self {
            row,
            slot,
            dof,
            constant: true,
        }
    }

    /// An entry that depends on the configuration.
    #[must_use]
    pub const fn varying(row: usize, slot: usize, dof: usize) -> Self {
        Self {
            row,
            slot,
            dof,
            constant: false,
        }
    }
}

/// A relative coordinate that a drive may prescribe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Value of a drive's `type` in a scene file.
    pub name: &'static str,
    /// Name of the definition of the driven rows.
    pub drive: &'static str,
    /// Whether the rows of the joint keep the coordinate at its initial value, so that the driven
    /// rows replace them.
    pub is_kept: bool,
}

impl Measure {
    /// A joint coordinate and the definition of its drive.
    #[must_use]
    pub const fn new(name: &'static str, drive: &'static str) -> Self {
        Self {
            name,
            drive,
            is_kept: false,
        }
    }

    /// A joint coordinate that the rows of the joint keep constant, and the definition of its
    /// drive.
    #[must_use]
    pub const fn kept(name: &'static str, drive: &'static str) -> Self {
        Self {
            is_kept: true,
            ..Self::new(name, drive)
        }
    }
}

/// Specification of a force definition.
#[derive(Clone, Copy, Debug)]
pub struct ForceSpec {
    /// The parts in common with constraints.
    pub common: Spec,
    /// Columns of the block of Q that are not identically zero.
    pub q: &'static [usize],
    /// Pattern (row, column of the block) of `∂Q/∂x`.
    pub dq_dx: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂Q/∂v`.
    pub dq_dv: &'static [[usize; 2]],
    /// Whether the force depends on velocities.
    pub dissipative: bool,
    /// Number of angles of space that the force receives with their full revolutions, like
    /// [`ConstraintSpec::turns`].
    pub turns: usize,
    /// Whether the force depends on time explicitly.
    pub rheonomic: bool,
}
