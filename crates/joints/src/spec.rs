//! Specifications of definitions, as constants of the generated code. With the specifications, a
//! scene reader, an assembler and a report can process any joint.

use std::fmt;
use std::ops::Range;

/// The common part of the specifications of constraints and forces.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Name of the definition, for example `PinInSlot`.
    pub name: &'static str,
    /// Value of `type` in a scene file, for example `pin-in-slot`.
    pub scene_type: &'static str,
    /// The key that distinguishes definitions with the same type in scenes, if several definitions
    /// have this type.
    pub variant: Option<Variant>,
    /// The doc comment of the definition.
    pub doc: &'static str,
    /// The source text of the definition.
    pub text: &'static str,
    /// Names of the bodies in the definition, for example `["i", "j"]`.
    pub slots: &'static [&'static str],
    /// Parameters, in the order of their arguments.
    pub parameters: &'static [Parameter],
    /// Whether a scene gives one common reference point (`at = [x, y]`) or one point for each point
    /// parameter.
    pub points_apart: bool,
    /// Whether the bodies, points and axes of the definition, except the last point, are taken from
    /// two joints. The scene gives the names of these joints. The first two bodies are wheels, and
    /// the third body is the carrier. Each wheel turns on the carrier about the axis of one of the
    /// two joints. On the carrier, the first point and the first axes belong to the first wheel,
    /// and the second point and the second axes belong to the second wheel. The third point is the
    /// reference point.
    pub bearings: bool,
    /// Texts of the requirements for the assembled initial configuration, in the order of
    /// `requirement`.
    pub requirements: &'static [&'static str],
}

impl Spec {
    /// Returns, for each point, the index of the body in whose frame the point is given.
    pub fn slots_of_points(&self) -> impl Iterator<Item = usize> + use<> {
        self.parameters.iter().filter_map(|p| match p.shape {
            Shape::Point { slot } => Some(slot),
            _ => None,
        })
    }

    /// Returns the name and the unit of each function of time that the kernels use, in the order of
    /// `f`.
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

/// The key that distinguishes definitions with the same type in scenes.
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
    /// Whether the parameter may be omitted. The value is then taken from the assembled initial
    /// configuration.
    pub optional: bool,
    /// Doc comment of the parameter: its purpose in one sentence. Frame and unit follow from the
    /// shape.
    pub doc: &'static str,
}

impl Parameter {
    /// Creates a parameter that must be given.
    #[must_use]
    pub const fn required(name: &'static str, shape: Shape, doc: &'static str) -> Self {
        Self {
            name,
            shape,
            optional: false,
            doc,
        }
    }

    /// Creates a parameter that may be omitted. The value is then taken from the assembled initial
    /// configuration.
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
    /// A point in the frame of the body with this index.
    Point {
        /// Index of the body.
        slot: usize,
    },
    /// A direction in the frame of the body with this index.
    Direction {
        /// Index of the body.
        slot: usize,
    },
    /// An axis in space in the frame of the body with this index, and the directions perpendicular
    /// to it.
    Axes {
        /// Index of the body.
        slot: usize,
        /// Index of another parameter with axes. If the parameter is not given, its axes are
        /// parallel to the axes of the other parameter in the described configuration.
        like: Option<usize>,
    },
    /// A straight line of the ground through two points.
    GroundLine,
    /// A plane of the ground: a point, and a vector normal to it.
    GroundPlane,
    /// Numbers with their units. A single number is written without brackets.
    Numbers(&'static [Unit]),
    /// Functions of time with the units of their values.
    Functions(&'static [Unit]),
}

impl Shape {
    /// Returns a description of the shape, in which points and vectors have `dim` components.
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
    /// 1/m, only for stored initial values
    PerLength,
}

impl Unit {
    /// Returns whether negative values are permitted.
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

    /// Returns whether this is the unit of lengths.
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
    /// The common part of a specification.
    pub common: Spec,
    /// Whether the constraint is a joint, or the drive of a joint coordinate.
    pub role: Role,
    /// Rows: `Φ(q, t) = 0`, then `Ψ(q, t)·q̇ + ψ(q, t) = 0`.
    pub rows: &'static [Row],
    /// Number of holonomic rows. The holonomic rows come first.
    pub holonomic: usize,
    /// Entries of the block of C that are not identically zero, in the order of the rows.
    pub c: &'static [Entry],
    /// Whether the constraint depends explicitly on time, so that b is not identically zero.
    pub rheonomic: bool,
    /// The entries (component, row) that are not identically zero in the map from multipliers to
    /// the wrench on the first body.
    pub wrench: &'static [[usize; 2]],
    /// A component of the reaction that has a name, in addition to the components of the wrench.
    pub component: Option<&'static str>,
    /// A note for reports about the meaning of the reaction. It does not contain the name of the
    /// joint.
    pub note: Option<&'static str>,
    /// Joint coordinates that a drive may prescribe.
    pub measures: &'static [Measure],
    /// Whether the kernels receive the cosine and the sine of the function of time in place of the
    /// function. Cosine and sine have two derivatives each. This is the case for drives of angles
    /// in space.
    pub turning: bool,
    /// Number of angles in space that the kernels receive including full revolutions. For each
    /// angle, the kernels receive three values after the functions of time: the angle since the
    /// start, its cosine and its sine. The derivatives of these values are not used.
    pub turns: usize,
    /// Pattern of `∂(Cᵀλ)/∂x`: pairs of row and column of the block.
    pub d_force_dx: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂(C·a − Γ)/∂x`.
    pub d_residual_dx: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂Γ/∂v`.
    pub d_gamma_dv: &'static [[usize; 2]],
    /// Pattern (row, column of the block) of `∂(C·v − b)/∂x`.
    pub d_velocity_dx: &'static [[usize; 2]],
    /// The values that the constraint stores: parameters, followed by initial values. A value that
    /// is not computed from other values belongs to exactly one datum.
    pub data: &'static [Datum],
}

impl ConstraintSpec {
    /// Returns the number of values in `data`.
    #[must_use]
    pub const fn n_data(&self) -> usize {
        match self.data {
            [.., last] => last.first + last.count,
            [] => 0,
        }
    }

    /// Returns the number of elements of the argument `f` of the kernels. There is one element for
    /// each function of time; the cosine and the sine may replace one function. There are three
    /// elements for each unwrapped angle.
    #[must_use]
    pub fn n_jets(&self) -> usize {
        self.common.functions().count() + usize::from(self.turning) + 3 * self.turns
    }

    /// Returns whether a joint may be one-sided. This is true if the only holonomic row is the gap
    /// of a contact.
    #[must_use]
    pub const fn has_gap(&self) -> bool {
        matches!(self.rows, [first, ..] if first.is_gap)
    }

    /// Returns whether the gap is measured from a line. The order of the two points of the line
    /// decides on which side the gap is positive.
    #[must_use]
    pub fn is_gap_of_line(&self) -> bool {
        let mut parameters = self.common.parameters.iter();
        self.has_gap() && parameters.any(|p| p.shape == Shape::GroundLine)
    }

    /// Returns whether the joint is a contact with a surface. The gap of such a joint is measured
    /// from the surface along the normal that the parameters state, and is positive outside. A line
    /// has no such normal. A gap that is zero at every start, for example the gap of a constant
    /// distance, has no surface.
    #[must_use]
    pub fn has_surface(&self) -> bool {
        let restricts = matches!(self.rows, [first, ..] if first.restricts_start);
        self.has_gap() && restricts && !self.is_gap_of_line()
    }

    /// Returns whether a contact of this type slips if a force is too large. This is true if the
    /// contact has nonholonomic rows and these rows do not prescribe a motion.
    #[must_use]
    pub const fn can_slip(&self) -> bool {
        self.nonholonomic() > 0 && !self.rheonomic
    }

    /// Returns the number of nonholonomic rows. They come after the holonomic rows.
    #[must_use]
    pub const fn nonholonomic(&self) -> usize {
        self.rows.len() - self.holonomic
    }
}

/// Values stored by a constraint that belong together: a point, a direction, or a scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Datum {
    /// Name of the parameter or of the initial value. It is `name[k]` for one entry of a list.
    pub name: &'static str,
    /// Kind of the values.
    pub shape: DatumShape,
    /// Index of the first of these values among all values of the constraint.
    pub first: usize,
    /// Number of values.
    pub count: usize,
}

impl Datum {
    /// Creates the datum with `count` values. The first value has the index `first`.
    #[must_use]
    pub const fn new(name: &'static str, shape: DatumShape, first: usize, count: usize) -> Self {
        Self {
            name,
            shape,
            first,
            count,
        }
    }

    /// Returns the indices of these values among all values of the constraint.
    #[must_use]
    pub fn numbers(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

/// Kind of the values of a datum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DatumShape {
    /// A point in the frame of the body with this index (m). The number of values is the dimension
    /// of the space.
    Point {
        /// Index of the body.
        slot: usize,
    },
    /// Components of a unit vector in the frame of the body with this index. Only changes
    /// perpendicular to the vector are meaningful.
    Direction {
        /// Index of the body.
        slot: usize,
    },
    /// Three values: the rotation vector of axes in the frame of the body with this index (rad).
    /// The rotation vector is zero for the stored axes.
    Axes {
        /// Index of the body.
        slot: usize,
    },
    /// Four values: x and y of the start of a line of the ground (m), and the components of the
    /// unit vector along the line.
    Line,
    /// Six values: a point of a plane of the ground (m), and the unit normal of the plane.
    Plane,
    /// A scalar parameter. An optional parameter that is not given has the value of the assembled
    /// initial configuration.
    Number(Unit),
    /// A scalar initial value. An angle that is stored by its cosine and sine has the value 0 for
    /// the stored angle.
    Kept(Unit),
    /// Components of a vector stored as an initial value (m), in the frame of the body with this
    /// index.
    KeptVector {
        /// Index of the body.
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
    /// Name of the row. It is unique within the joint.
    pub name: &'static str,
    /// Whether the row restricts the initial configuration. A row that stores an initial value does
    /// not restrict the initial configuration, because every initial configuration satisfies this
    /// row.
    pub restricts_start: bool,
    /// Whether the row is the gap of a contact. The gap is positive if the contact is open. A joint
    /// may be one-sided in this row.
    pub is_gap: bool,
}

impl Row {
    /// Creates a row that restricts the initial configuration.
    #[must_use]
    pub const fn restricting_start(name: &'static str) -> Self {
        Self {
            name,
            restricts_start: true,
            is_gap: false,
        }
    }

    /// Creates a row that stores an initial value.
    #[must_use]
    pub const fn keeping_start(name: &'static str) -> Self {
        Self {
            name,
            restricts_start: false,
            is_gap: false,
        }
    }

    /// Returns the same row as the gap of a contact.
    #[must_use]
    pub const fn gap(self) -> Self {
        Self {
            is_gap: true,
            ..self
        }
    }
}

/// One entry of the block of C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Index of the row in the constraint.
    pub row: usize,
    /// Index of the body in the list of bodies.
    pub slot: usize,
    /// Velocity component of the body: 0 x, 1 y, 2 rotation in the plane; 0 x, 1 y, 2 z, 3 to 5
    /// rotations in space.
    pub dof: usize,
    /// Whether the entry depends only on parameters.
    pub constant: bool,
}

impl Entry {
    /// Creates an entry that depends only on parameters.
    #[must_use]
    pub const fn constant(row: usize, slot: usize, dof: usize) -> Self {
        Self {
            row,
            slot,
            dof,
            constant: true,
        }
    }

    /// Creates an entry that depends on the configuration.
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

/// A joint coordinate that a drive may prescribe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Value of the key `type` of the drive in a scene file.
    pub name: &'static str,
    /// Name of the definition of the drive.
    pub drive: &'static str,
    /// Whether the rows of the joint keep the coordinate at its initial value. In this case, the
    /// rows of the drive replace these rows of the joint.
    pub is_kept: bool,
}

impl Measure {
    /// Creates a joint coordinate with the definition of its drive.
    #[must_use]
    pub const fn new(name: &'static str, drive: &'static str) -> Self {
        Self {
            name,
            drive,
            is_kept: false,
        }
    }

    /// Creates a joint coordinate that the rows of the joint keep constant. The second argument is
    /// the definition of the drive.
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
    /// The common part of a specification.
    pub common: Spec,
    /// Columns of the block of Q that are not identically zero.
    pub q: &'static [usize],
    /// Pattern of `∂Q/∂x`: pairs of row and column of the block.
    pub dq_dx: &'static [[usize; 2]],
    /// Pattern of `∂Q/∂v`: pairs of row and column of the block.
    pub dq_dv: &'static [[usize; 2]],
    /// Whether the force depends on velocities.
    pub dissipative: bool,
    /// Number of angles in space that the kernels receive including full revolutions; see
    /// [`ConstraintSpec::turns`].
    pub turns: usize,
    /// Whether the force depends explicitly on time.
    pub rheonomic: bool,
}
