//! A mechanism as what exact arithmetic examines: the wrenches that each of its rows causes on its
//! bodies, in space. Scenes of the plane are lifted: their rows are wrenches without parts across
//! the plane, and the velocities across it are left out, as if every body had guides that keep it
//! in its plane. A guide does no work in the plane and shares no row with others, so ranks,
//! dependencies and verdicts are those of the plane.

use num_bigint::BigInt;

use crate::fuzz::space::ratio::Ratio;
use crate::fuzz::space::vector::Vector;

/// A body by its index, or the ground.
pub type Side = Option<usize>;

/// Force, and moment about the origin of the drawing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrench {
    /// The force.
    pub force: Vector,
    /// The moment.
    pub moment: Vector,
}

impl Wrench {
    /// A force along a line through p.
    #[must_use]
    pub fn line(p: &Vector, force: &Vector) -> Self {
        Self {
            force: force.clone(),
            moment: p.cross(force),
        }
    }

    /// A couple.
    #[must_use]
    pub fn couple(moment: Vector) -> Self {
        Self {
            force: Vector::zero(),
            moment,
        }
    }

    /// The opposite wrench.
    #[must_use]
    pub fn opposite(&self) -> Self {
        Self {
            force: -&self.force,
            moment: -&self.moment,
        }
    }

    /// Its six numbers.
    #[must_use]
    pub fn numbers(&self) -> [Ratio; 6] {
        let ([a, b, c], [d, e, f]) = (&self.force.0, &self.moment.0);
        [a, b, c, d, e, f].map(Clone::clone)
    }

    /// The length of its force, or that of a couple.
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

/// The element that a row belongs to, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A joint.
    Joint(usize),
    /// A drive.
    Drive(usize),
}

/// What a row says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Points coincide along an axis of the ground.
    Point(usize),
    /// A point stays on a line or plane: the offset along u (0), v (1) or the normal (2).
    Offset(usize),
    /// The second axis does not leave the first one towards u (0) or v (1).
    Direction(usize),
    /// The second u does not turn towards the first v: no relative rotation about w.
    Turn,
    /// Two axes stay perpendicular.
    Perpendicular,
    /// A length.
    Length,
    /// Teeth: rotations in a ratio, or a rotation and a displacement.
    Mesh,
    /// No velocity along the normal of an edge, or a prescribed one.
    Edge,
    /// A wheel touches its plane.
    Contact,
    /// A wheel does not slip along its heading.
    Longitudinal,
    /// A wheel does not slip across its heading.
    Lateral,
    /// A driven measure.
    Driven,
}

impl Meaning {
    /// Whether it restricts velocities only.
    #[must_use]
    pub fn is_nonholonomic(self) -> bool {
        matches!(self, Self::Edge | Self::Longitudinal | Self::Lateral)
    }
}

/// One row.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its joint or drive.
    pub owner: Owner,
    /// What it says.
    pub meaning: Meaning,
    /// The wrenches of a unit multiplier; one body may occur several times.
    pub loads: Vec<(Side, Wrench)>,
    /// The row of the program is this one divided by this length.
    pub length: f64,
}

impl Row {
    /// A row that acts with a wrench on the second body and with its opposite on the first.
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
    /// Which one.
    pub owner: Owner,
    /// Its name.
    pub name: String,
    /// Its bodies; the wrench on the first of them is its reaction.
    pub sides: Vec<Side>,
    /// The point for which its reaction is given, the origin if it carries couples only. `None` if
    /// the point is not in the drawing.
    pub place: Option<Vector>,
}

/// A component of a reaction: `Σ (a + b·√k)·wrench[i]/unit`.
#[derive(Clone, Debug)]
pub struct Component {
    /// Its name.
    pub name: &'static str,
    /// The indices i with a and b.
    pub terms: Vec<(usize, [BigInt; 2])>,
    /// The unit.
    pub unit: BigInt,
}

/// All rows of a mechanism.
#[derive(Clone, Debug)]
pub struct Wrenches {
    /// Number of bodies.
    pub bodies: usize,
    /// The indices of the velocities of a body among the six of space.
    pub velocities: Vec<usize>,
    /// The components of reactions.
    pub components: Vec<Component>,
    /// k in the irrational parts of components.
    pub stretch: u32,
    /// Joints and drives in the order of the file.
    pub elements: Vec<Element>,
    /// Rows in the order of the program: holonomic ones of joints, those of drives, then
    /// nonholonomic ones.
    pub rows: Vec<Row>,
    /// Distance from the origin (m).
    pub distance: f64,
    /// The redundancy that theory gives, if it does.
    pub theory: Option<usize>,
}

impl Wrenches {
    /// The joint or drive of an owner.
    #[must_use]
    pub fn element(&self, owner: Owner) -> &Element {
        element(&self.elements, owner)
    }

    /// The name of the joint or drive of a row.
    #[must_use]
    pub fn name_of(&self, row: usize) -> &str {
        &self.element(self.rows[row].owner).name
    }

    /// The indices of rows with a property.
    pub fn rows_where(&self, wanted: impl Fn(&Row) -> bool) -> Vec<usize> {
        let rows = self.rows.iter().enumerate();
        rows.filter(|(_, row)| wanted(row))
            .map(|(i, _)| i)
            .collect()
    }

    /// The rows of a joint or drive.
    #[must_use]
    pub fn rows_of(&self, owner: Owner) -> Vec<usize> {
        self.rows_where(|row| row.owner == owner)
    }

    /// The same with rows in the order of the program; those of each kind stay in their order.
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
