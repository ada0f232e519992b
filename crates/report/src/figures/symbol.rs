//! Symbols as data: strokes relative to the point of the symbol (px, y downwards), with the axis of
//! the symbol along x. The SVG of a mechanism and the animation of a page draw the same strokes,
//! with the styles in `picture.css`.

use serde::ser::{Serialize, SerializeMap, Serializer};

use super::label::Rect;

/// Kind of relative motion that a joint allows, as a symbol. Directions are global unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Symbol {
    /// A joint at which two points coincide.
    Pin,
    /// In space, a joint that allows only rotation about an axis.
    Hinge { axis: [f64; 3] },
    /// A weld, which allows no motion.
    Weld,
    /// A block on a straight guide.
    Block { axis: [f64; 3] },
    /// A pin in a straight slot.
    Slot { axis: [f64; 3] },
    /// A rod, which keeps the distance of two points constant.
    Rod,
    /// A knife edge or wheel, seen from above.
    Edge { along: [f64; 3] },
    /// A coupling of rotations.
    Rotation,
    /// A prescribed motion along an axis, or about the reference point.
    Drive { axis: Option<[f64; 3]> },
    /// In space, a prescribed rotation about an axis.
    Turn { axis: [f64; 3] },
}

impl Symbol {
    /// Name in [`SHAPES`].
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Pin | Self::Hinge { .. } => "pin",
            Self::Weld => "weld",
            Self::Block { .. } => "block",
            Self::Slot { .. } => "slot",
            Self::Rod => "rod",
            Self::Edge { .. } => "edge",
            Self::Rotation => "rotation",
            Self::Drive { axis: Some(_) } => "push",
            Self::Drive { axis: None } | Self::Turn { .. } => "turn",
        }
    }

    /// The direction along which the symbol is drawn, or about which it rotates.
    pub(crate) fn axis(self) -> Option<[f64; 3]> {
        match self {
            Self::Block { axis } | Self::Slot { axis } | Self::Edge { along: axis } => Some(axis),
            Self::Hinge { axis } | Self::Turn { axis } => Some(axis),
            Self::Drive { axis } => axis,
            _ => None,
        }
    }
}

/// A symbol to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    /// Half the width and half the height of the box of the symbol (px), and the vertical offset
    /// between the point of the symbol and the middle of the box (px).
    pub(crate) half: [f64; 2],
    pub(crate) middle: f64,
    /// Class and path data of each stroke, in the order of drawing.
    pub(crate) strokes: &'static [(&'static str, &'static str)],
}

impl Shape {
    /// Returns the shape with this name. If the name does not exist, returns the first shape.
    pub(super) fn named(name: &str) -> Self {
        SHAPES
            .into_iter()
            .find(|s| s.name == name)
            .unwrap_or(SHAPES[0])
    }

    /// The box on the page around a point (px), rotated by an angle (rad).
    pub(super) fn around(&self, at: [f64; 2], angle: f64) -> Rect {
        let ((sin, cos), [x, y]) = (angle.sin_cos(), self.half);
        Rect {
            centre: [at[0] + sin * self.middle, at[1] + cos * self.middle],
            half: [x * cos.abs() + y * sin.abs(), x * sin.abs() + y * cos.abs()],
        }
    }
}

const fn shape(
    name: &'static str,
    half: [f64; 2],
    middle: f64,
    strokes: &'static [(&'static str, &'static str)],
) -> Shape {
    Shape {
        name,
        half,
        middle,
        strokes,
    }
}

const PIN: &str = "M-6.3 0a6.3 6.3 0 1 1 12.6 0a6.3 6.3 0 1 1-12.6 0Z";
const CROSS: &str = "M-6.5-6.5L6.5 6.5M-6.5 6.5L6.5-6.5";
const BLOCK: &str = "M-10.5-7.5h21a1.5 1.5 0 0 1 1.5 1.5v12a1.5 1.5 0 0 1-1.5 1.5h-21\
                     a1.5 1.5 0 0 1-1.5-1.5v-12a1.5 1.5 0 0 1 1.5-1.5Z";
const GROOVE: &str = "M-11-7h22a7 7 0 0 1 0 14h-22a7 7 0 0 1 0-14Z";
const PEG: &str = "M-5 0a5 5 0 1 1 10 0a5 5 0 1 1-10 0Z";
const END: &str = "M-4.5 0a4.5 4.5 0 1 1 9 0a4.5 4.5 0 1 1-9 0Z";
const BLADE: &str = "M-14.5-4.4h29a2.5 2.5 0 0 1 2.5 2.5v3.8a2.5 2.5 0 0 1-2.5 2.5h-29\
                     a2.5 2.5 0 0 1-2.5-2.5v-3.8a2.5 2.5 0 0 1 2.5-2.5Z";
const WHEEL: &str = "M-8.5 0a8.5 8.5 0 1 1 17 0a8.5 8.5 0 1 1-17 0Z";
const TURNS: &str = "M4.6 0A4.6 4.6 0 1 0-4.45 1.18L-5.96 1.57L-1.23 3.81L-1.78.47L-3.29.87\
                     A3.4 3.4 0 1 1 3.4 0Z";
const PUSH: &str = "M-19 19L-9 13.25V16.5H9V13.25L19 19L9 24.75V21.5H-9V24.75Z";
const TURN: &str = "M15 0A15 15 0 1 0-14.01 5.37L-18.86 7.23L-6.37 11.33L-5.42 2.08L-10.27 3.94\
                    A11 11 0 1 1 11 0Z";
const COUPLE: &str = "M16 0A16 16 0 1 0-11.98 10.61L-13.92 12.34L-4.61 14.27L-8.53 7.56L-10.48 9.28\
                      A14 14 0 1 1 14 0Z";
const STAND: &str = "M0 0L-9 14H9Z";
const GROUND: &str = "M-15 14H15M-9 14l-5 6M-3 14l-5 6M3 14l-5 6M9 14l-5 6M15 14l-5 6";
const CENTRE: &str = "M-4 0H4M0-4V4M-4 0a4 4 0 1 1 8 0a4 4 0 1 1-8 0";

/// All symbols in the order of drawing. Symbols that would hide other symbols are drawn first.
pub(crate) const SHAPES: [Shape; 15] = [
    shape("rod", [5.0, 5.0], 0.0, &[("mark", END)]),
    shape("block", [12.0, 7.5], 0.0, &[("mark", BLOCK)]),
    shape(
        "slot",
        [18.0, 7.0],
        0.0,
        &[("groove", GROOVE), ("mark", PEG)],
    ),
    shape("edge", [17.0, 4.4], 0.0, &[("mark", BLADE)]),
    shape(
        "rotation",
        [8.5, 8.5],
        0.0,
        &[("mark", WHEEL), ("thin", TURNS)],
    ),
    shape(
        "weld",
        [6.5, 6.5],
        0.0,
        &[("mark", "M-6.5-6.5h13v13h-13Z"), ("thin", CROSS)],
    ),
    shape("push", [19.0, 6.0], 19.0, &[("mark", PUSH)]),
    shape("turn", [18.0, 15.0], 0.0, &[("mark", TURN)]),
    shape("pin", [6.3, 6.3], 0.0, &[("mark", PIN)]),
    // Symbols for other items than joints: the ground below a point, centres of mass, markers,
    // applied forces and torques.
    shape(
        "foot",
        [16.0, 10.0],
        10.0,
        &[("foot", STAND), ("foot", GROUND)],
    ),
    shape("centre", [4.0, 4.0], 0.0, &[("centre", CENTRE)]),
    shape("marker", [6.0, 6.0], 0.0, &[("marker", "M-6 0H6M0-6V6")]),
    shape("load", [8.0, 7.0], -2.0, &[("load", "M0-9L8 5H-8Z")]),
    shape("couple", [16.0, 15.0], 0.0, &[("load", COUPLE)]),
    shape(
        "short spring",
        [5.0, 5.0],
        0.0,
        &[("spring", "M-5-5H5V5H-5Z")],
    ),
];

/// Points of a spring: x as a fraction of the length, y in px.
pub(crate) const SPRING: [[f64; 2]; 16] = [
    [0.0, 0.0],
    [0.1, 0.0],
    [0.133, -6.0],
    [0.2, 6.0],
    [0.267, -6.0],
    [0.333, 6.0],
    [0.4, -6.0],
    [0.467, 6.0],
    [0.533, -6.0],
    [0.6, 6.0],
    [0.667, -6.0],
    [0.733, 6.0],
    [0.8, -6.0],
    [0.867, 6.0],
    [0.9, 0.0],
    [1.0, 0.0],
];

/// Length below which a spring has no space for coils (px).
pub(crate) const SHORT: f64 = 4.0;

/// The symbols by name, for scripts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shapes;

impl Serialize for Shapes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(SHAPES.len()))?;
        for Shape {
            name,
            half,
            middle,
            strokes,
        } in SHAPES
        {
            map.serialize_entry(name, &(half, middle, strokes))?;
        }
        map.end()
    }
}
