//! A mechanism in the form that exact arithmetic analyses: for each row, the wrenches in space on
//! the bodies of the row. The rows of planar scenes are wrenches without out-of-plane components,
//! and the out-of-plane velocities of bodies are omitted, as if guides constrained every body to
//! its plane. A guide does no work in planar motions and shares no row with other joints. Therefore
//! ranks, dependencies and verdicts are the same as in the plane.

use num_bigint::BigInt;

use crate::fuzz::space::ratio::Ratio;
use crate::fuzz::space::vector::Vector;

/// A body by its index, or the ground.
pub type Side = Option<usize>;

/// A force, and a moment about the origin of the drawing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrench {
    /// The force.
    pub force: Vector,
    /// The moment.
    pub moment: Vector,
}

impl Wrench {
    /// Creates a force along a line through p.
    #[must_use]
    pub fn line(p: &Vector, force: &Vector) -> Self {
        Self {
            force: force.clone(),
            moment: p.cross(force),
        }
    }

    /// Creates a couple.
    #[must_use]
    pub fn couple(moment: Vector) -> Self {
        Self {
            force: Vector::zero(),
            moment,
        }
    }

    /// Returns the opposite wrench.
    #[must_use]
    pub fn opposite(&self) -> Self {
        Self {
            force: -&self.force,
            moment: -&self.moment,
        }
    }

    /// Returns the six components.
    #[must_use]
    pub fn numbers(&self) -> [Ratio; 6] {
        let ([a, b, c], [d, e, f]) = (&self.force.0, &self.moment.0);
        [a, b, c, d, e, f].map(Clone::clone)
    }

    /// Returns the magnitude of the force, or of the moment if the force is zero.
    #[must_use]
    pub fn length(&self) -> f64 {
        let direction = if self.force.is_zero() {
            &self.moment
        } else {
            &self.force
        };
        direction.square().root()
    }
}

/// The element to which a row belongs, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A joint.
    Joint(usize),
    /// A drive.
    Drive(usize),
}

/// Meaning of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Points coincide along an axis of the ground.
    Point(usize),
    /// A point remains on a line or plane: the offset along u (0), v (1) or the normal (2) is zero.
    Offset(usize),
    /// The second axis does not rotate from the first axis towards u (0) or v (1).
    Direction(usize),
    /// The axis u of the second body does not rotate towards the axis v of the first body, so that
    /// there is no relative rotation about w.
    Turn,
    /// Two axes remain perpendicular.
    Perpendicular,
    /// A distance is constant.
    Length,
    /// A gear mesh: two rotations, or a rotation and a displacement, have a fixed ratio.
    Mesh,
    /// The velocity along the normal of an edge is zero or prescribed.
    Edge,
    /// A wheel touches its plane.
    Contact,
    /// A wheel does not slip along its heading.
    Longitudinal,
    /// A wheel does not slip across its heading.
    Lateral,
    /// A driven joint coordinate.
    Driven,
}

impl Meaning {
    /// Whether the row restricts only velocities.
    #[must_use]
    pub fn is_nonholonomic(self) -> bool {
        matches!(self, Self::Edge | Self::Longitudinal | Self::Lateral)
    }
}

/// One constraint row.
#[derive(Clone, Debug)]
pub struct Row {
    /// Joint or drive of the row.
    pub owner: Owner,
    /// Meaning of the row.
    pub meaning: Meaning,
    /// The wrenches of a unit multiplier; one body may occur several times.
    pub loads: Vec<(Side, Wrench)>,
    /// The corresponding row of the program is this row divided by this length.
    pub length: f64,
}

impl Row {
    /// Creates a row that acts with a wrench on the second body and with the opposite wrench on the
    /// first body.
    #[must_use]
    pub fn between(
        owner: Owner,
        meaning: Meaning,
        [first, second]: [Side; 2],
        wrench: Wrench,
    ) -> Self {
        Self {
            owner,
            meaning,
            length: wrench.length(),
            loads: vec![(first, wrench.opposite()), (second, wrench)],
        }
    }
}

/// A joint or drive.
#[derive(Clone, Debug)]
pub struct Element {
    /// Owner of the element.
    pub owner: Owner,
    /// Name of the element.
    pub name: String,
    /// Bodies of the element. The wrench on the first body is the reaction of the element.
    pub sides: Vec<Side>,
    /// The reference point of the reaction, or the origin if the element transmits only couples.
    /// `None` if the point is not in the drawing.
    pub place: Option<Vector>,
}

/// A component of a reaction: `Σ (a + b·√k)·wrench[i]/unit`.
#[derive(Clone, Debug)]
pub struct Component {
    /// Name of the component.
    pub name: &'static str,
    /// The terms of the sum: index i, with a and b.
    pub terms: Vec<(usize, [BigInt; 2])>,
    /// The unit of the component.
    pub unit: BigInt,
}

/// All rows of a mechanism.
#[derive(Clone, Debug)]
pub struct Wrenches {
    /// Number of bodies.
    pub bodies: usize,
    /// The indices of the velocities of a body among the six velocity components in space.
    pub velocities: Vec<usize>,
    /// The components of reactions.
    pub components: Vec<Component>,
    /// The number k in the irrational parts of components.
    pub stretch: u32,
    /// Joints and drives in the order of the file.
    pub elements: Vec<Element>,
    /// Rows in the order of the program: holonomic rows of joints, rows of drives, then
    /// nonholonomic rows.
    pub rows: Vec<Row>,
    /// Distance from the origin (m).
    pub distance: f64,
    /// The redundancy according to theory, if it is known.
    pub theory: Option<usize>,
}

impl Wrenches {
    /// Returns the joint or drive of an owner.
    #[must_use]
    pub fn element(&self, owner: Owner) -> &Element {
        element(&self.elements, owner)
    }

    /// Returns the name of the joint or drive of a row.
    #[must_use]
    pub fn name_of(&self, row: usize) -> &str {
        &self.element(self.rows[row].owner).name
    }

    /// Returns the indices of rows with a property.
    pub fn rows_where(&self, wanted: impl Fn(&Row) -> bool) -> Vec<usize> {
        let rows = self.rows.iter().enumerate();
        rows.filter(|(_, row)| wanted(row))
            .map(|(i, _)| i)
            .collect()
    }

    /// Returns the rows of a joint or drive.
    #[must_use]
    pub fn rows_of(&self, owner: Owner) -> Vec<usize> {
        self.rows_where(|row| row.owner == owner)
    }

    /// Returns the rows in the order of the program; rows of each kind keep their order.
    #[must_use]
    pub fn in_order(mut self) -> Self {
        self.rows.sort_by_key(|row| match row.meaning {
            Meaning::Driven => 1,
            meaning if meaning.is_nonholonomic() => 2,
            _ => 0,
        });
        self
    }
}

/// Names of the components of a wrench in space.
pub const AXES: [&str; 6] = ["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"];

fn element(elements: &[Element], owner: Owner) -> &Element {
    let mut own = elements.iter().filter(|e| e.owner == owner);
    own.next().expect("a row belongs to an element")
}
