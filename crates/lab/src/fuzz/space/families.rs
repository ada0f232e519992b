//! Families of mechanisms with planted redundancy, and of similar mechanisms with less or no
//! redundancy. A submechanism is drawn in separate coordinates and placed on a base, which is the
//! ground or a body of another submechanism. If theory gives the redundancy without computation,
//! the drawing contains it.

mod chains;
mod couplings;
mod cylinders;
mod doors;
mod flat;
mod overconstrained;
mod pen;
mod platforms;
mod supports;
mod vehicles;

use suite::numbers::Numbers;

use super::drawing::{Drawing, GROUND, Side};
use super::relatives;
use pen::Pen;

/// A family of mechanisms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Open chains and closed loops of any joints.
    Chains,
    /// Doors on two to four coaxial hinges.
    Doors,
    /// Planar loops: four-bars, slider-cranks, parallel cranks.
    Flat,
    /// Loops of axes through one point.
    Spherical,
    /// Bennett's linkage, and two merged Bennett linkages.
    Bennett,
    /// Six-bar linkages: Sarrus, Bricard.
    SixBars,
    /// Couplings of shafts: Oldham, Hooke.
    Couplings,
    /// Bodies on points of planes and in grooves.
    Supports,
    /// Parallel hydraulic cylinders.
    Cylinders,
    /// Platforms on rods and legs.
    Platforms,
    /// Chassis on wheels.
    Vehicles,
    /// Two of these mechanisms in one scene.
    Several,
}

impl Family {
    /// All families.
    pub const ALL: [Self; 12] = [
        Self::Chains,
        Self::Doors,
        Self::Flat,
        Self::Spherical,
        Self::Bennett,
        Self::SixBars,
        Self::Couplings,
        Self::Supports,
        Self::Cylinders,
        Self::Platforms,
        Self::Vehicles,
        Self::Several,
    ];

    /// Returns the name of the family.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Chains => "chains and loops",
            Self::Doors => "doors",
            Self::Flat => "flat linkages",
            Self::Spherical => "spherical linkages",
            Self::Bennett => "Bennett and Goldberg",
            Self::SixBars => "Sarrus and Bricard",
            Self::Couplings => "couplings",
            Self::Supports => "tables and grooves",
            Self::Cylinders => "parallel cylinders",
            Self::Platforms => "platforms on rods",
            Self::Vehicles => "vehicles",
            Self::Several => "two in one scene",
        }
    }

    /// Returns a drawing. One in three drawings has a joint with fewer rows or a rotated axis.
    #[must_use]
    pub fn draw(self, numbers: &mut Numbers) -> Drawing {
        loop {
            let mut drawing = Drawing {
                redundancy: Some(0),
                ..Drawing::default()
            };
            if self == Self::Several {
                several(&mut drawing, numbers);
            } else {
                piece(&mut drawing, self, GROUND, numbers);
            }
            // The drawing is empty if the shafts of a coupling do not fit.
            if !drawing.bodies.is_empty() {
                return drawing;
            }
        }
    }
}

/// Adds a submechanism to a drawing, and in one of three cases changes one of its joints.
fn piece(drawing: &mut Drawing, family: Family, base: Side, numbers: &mut Numbers) {
    let first = drawing.joints.len();
    let mut pen = Pen::new(drawing, base, numbers);
    match family {
        Family::Chains => chains::chains(&mut pen),
        Family::Doors => doors::doors(&mut pen),
        Family::Flat => flat::flat(&mut pen),
        Family::Spherical => chains::spherical(&mut pen),
        Family::Bennett => overconstrained::bennett(&mut pen),
        Family::SixBars => overconstrained::six_bars(&mut pen),
        Family::Couplings => couplings::couplings(&mut pen),
        Family::Supports => supports::supports(&mut pen),
        Family::Cylinders => cylinders::cylinders(&mut pen),
        Family::Platforms => platforms::platforms(&mut pen),
        Family::Vehicles | Family::Several => vehicles::vehicles(&mut pen),
    }
    if numbers.once_in(3) {
        relatives::change_one(drawing, first, numbers);
    }
}

/// Draws two submechanisms. The second submechanism is mounted on the ground or on a body of the
/// first submechanism. The redundancies can then be added, because a self-stress of the second
/// submechanism exerts no load on its base. Up to two further joints connect both submechanisms. If
/// the base of the second submechanism is the ground, a joint to one of its bodies closes a loop
/// through the ground.
fn several(drawing: &mut Drawing, numbers: &mut Numbers) {
    let pieces = [0; 2].map(|_| Family::ALL[numbers.below(Family::ALL.len() - 1)]);
    piece(drawing, pieces[0], GROUND, numbers);
    let middle = drawing.bodies.len();
    let stands_on_ground = pieces[1] == Family::Vehicles || numbers.once_in(2) || middle == 0;
    let base = if stands_on_ground {
        GROUND
    } else {
        Some(numbers.below(middle))
    };
    piece(drawing, pieces[1], base, numbers);
    let count = numbers.below(4).saturating_sub(1);
    if count == 0 || middle == 0 || drawing.bodies.len() == middle {
        return;
    }
    drawing.redundancy = None;
    let second = drawing.bodies.len() - middle;
    for _ in 0..count {
        let pair = [
            Some(numbers.below(middle)),
            Some(middle + numbers.below(second)),
        ];
        let mut pen = Pen::new(drawing, GROUND, numbers);
        let kind = pen.any_joint();
        pen.joint(pair, kind);
    }
}
