//! Independent tests of verdicts in space. Mechanisms with planted redundancy are constructed with
//! rational numbers, moved, written as text with every number rounded once, and analysed by exact
//! arithmetic.
//!
//! The reference shares no code with the program. The rows of the reference are wrenches, derived
//! by virtual work from the points and axes of the joints in the axes of the ground. No derivatives
//! are used, and ranks are computed by elimination with integers.
//!
//! ```
//! use lab::fuzz::space::{Drawing, Expected, text};
//!
//! for scene in lab::fuzz::space::scenes(1).take(3) {
//!     let drawing: &Drawing = &scene.drawing;
//!     let (text, right): (String, Expected) = (text::text(drawing), Expected::of(drawing));
//!     assert_eq!(right.mobility, 6 * drawing.bodies.len() - right.rank);
//!     assert!(text.starts_with("[scene]"));
//! }
//! ```
//!
//! | module | content |
//! | --- | --- |
//! | [`ratio`] | fractions of any size |
//! | [`vector`] | vectors, rotations and similarity transformations with rational numbers |
//! | [`mod@drawing`] | bodies, joints and drives at one configuration |
//! | [`kind`] | types of joints |
//! | [`rows`] | constraint rows as screws |
//! | [`catalogue`] | mechanisms with results derived by hand |
//! | [`families`] | random mechanisms with planted redundancy |
//! | [`relatives`] | the same mechanisms with fewer rows in one joint, or with one rotated axis |
//! | [`pose`] | variants of a drawing: moved, with other frames, in another order |
//! | [`text`] | the scene as text |
//! | [`mod@examine`] | comparison of the answer of the program with exact arithmetic |
//! | [`lifted`] | planar scenes converted to space |
//! | [`graph`] | cycles of the joints that keep bodies in the plane |
//! | [`permanence`] | whether a redundancy exists at all configurations of the mechanism |
//! | [`within`] | comparison of the answers for scenes with few digits |

pub mod catalogue;
pub mod drawing;
pub mod examine;
pub mod families;
pub mod graph;
pub mod kind;
pub mod lifted;
pub mod permanence;
pub mod pose;
pub mod ratio;
pub mod relatives;
pub mod rows;
#[cfg(test)]
mod tests;
pub mod text;
pub mod vector;
pub mod within;

use suite::numbers::Numbers;

pub use crate::fuzz::exact::expected::Expected;
pub use drawing::Drawing;
pub use text::description;

use families::Family;
use pose::Writing;
use text::Precision;

/// One scene, which contains one variant of a drawing.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Number of the scene.
    pub number: u64,
    /// Family of the scene.
    pub family: Family,
    /// Written form of the drawing.
    pub writing: Writing,
    /// The drawing after the motion, with its elements in the order of the file.
    pub drawing: Drawing,
}

/// Scene `number` of a seed. Scenes `4·k` to `4·k + 3` contain the same drawing, in the written
/// forms of [`Writing::ALL`].
#[must_use]
pub fn scene(seed: u64, number: u64) -> Scene {
    let ways = Writing::ALL.len() as u64;
    let (drawn, way) = (number / ways, number % ways);
    let family = Family::ALL[(drawn % Family::ALL.len() as u64) as usize];
    let stream = |salt: u64| Numbers::new(seed ^ Numbers::new(salt).bits());
    let drawing = family.draw(&mut stream(drawn));
    let writing = Writing::ALL[way as usize];
    Scene {
        number,
        family,
        writing,
        drawing: pose::posed(&drawing, writing, &mut stream(!number)),
    }
}

/// Returns the infinite sequence of scenes of a seed.
pub fn scenes(seed: u64) -> impl Iterator<Item = Scene> {
    (0..).map(move |number| scene(seed, number))
}

impl Drawing {
    /// Returns the text with all digits of a double, and the correct result.
    #[must_use]
    pub fn judged(&self) -> (String, Expected) {
        (text::text(self), Expected::of(self))
    }

    /// Returns the text with some significant digits and the corresponding tolerance.
    #[must_use]
    pub fn rounded(&self, digits: usize) -> String {
        text::text_within(self, &Precision::of_digits(self, digits))
    }
}
