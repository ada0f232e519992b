//! Families of drawings. Each family draws degenerate examples and similar examples that are not
//! degenerate. In the examples that are not degenerate, a point is displaced from its line by one
//! step of the grid, which is at least a hundredth of the size. Therefore a program that reports
//! all rows as redundant is wrong as often as a program that reports all rows as independent.

mod bars;
mod doubled;
mod edges;
mod gears;
mod linkages;
mod pen;
pub mod slender;
mod trusses;
mod wheels;

use suite::numbers::Numbers;

use super::drawing::{Drawing, GROUND, Tie};
use pen::Pen;

/// A family of drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Nodes on a line connected by distances, with oblique bars.
    Trusses,
    /// Bodies supported by bars that meet in a point or are parallel.
    Bars,
    /// Knife edges, prescribed velocities and rolling wheels. The lines of action of their
    /// reactions meet in a point or are parallel.
    Edges,
    /// Castors and pulleys pinned at their centres.
    Wheels,
    /// Gears and racks, with closed trains.
    Gears,
    /// Cranks, chains and dead centres.
    Linkages,
    /// Two joints between the same bodies.
    Doubled,
    /// Drawings of two of these families in one scene, with or without a hinge between them.
    Several,
}

impl Family {
    /// All families.
    pub const ALL: [Self; 8] = [
        Self::Trusses,
        Self::Bars,
        Self::Edges,
        Self::Wheels,
        Self::Gears,
        Self::Linkages,
        Self::Doubled,
        Self::Several,
    ];

    /// Returns the name of the family.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Trusses => "collinear trusses",
            Self::Bars => "concurrent bars",
            Self::Edges => "edges and rolling wheels",
            Self::Wheels => "castors and pulleys",
            Self::Gears => "gears and racks",
            Self::Linkages => "flat linkages",
            Self::Doubled => "doubled joints",
            Self::Several => "two in one scene",
        }
    }

    /// Returns a drawing of the family.
    #[must_use]
    pub fn draw(self, numbers: &mut Numbers) -> Drawing {
        let mut pen = Pen::new(numbers);
        add(&mut pen, self);
        pen.drawing
    }
}

/// Adds an example of a family to the drawing.
fn add(pen: &mut Pen<'_>, family: Family) {
    match family {
        Family::Trusses => trusses::truss(pen),
        Family::Bars => bars::bars(pen),
        Family::Edges => edges::edges(pen),
        Family::Wheels => wheels::wheels(pen),
        Family::Gears => gears::gears(pen),
        Family::Linkages => linkages::linkage(pen),
        Family::Doubled => doubled::doubled(pen),
        Family::Several => several(pen),
    }
}

fn several(pen: &mut Pen<'_>) {
    let mut firsts = vec![GROUND];
    for _ in 0..2 {
        let family = Family::ALL[pen.numbers.below(Family::ALL.len() - 1)];
        firsts.push(Some(pen.drawing.origins.len()));
        add(pen, family);
    }
    if pen.numbers.once_in(2) {
        let at = pen.point();
        let pair = [firsts[1], firsts[2]];
        pen.drawing.link(&pair, Tie::Revolute { at });
    }
    pen.drawing.redundancy = None;
    pen.drawing.has_constant_rank = false;
}
