//! Independent tests of the results of `analyze`. Degenerate scenes are constructed with rational
//! numbers, moved, and written as text with every number rounded once. Exact arithmetic with the
//! rational numbers gives the correct results. The results of `analyze` for the text must be the
//! same: ranks, verdicts, components, rows, dependencies, and every sentence.
//!
//! The reference shares no code with the program. Rows are wrenches, derived by virtual work from
//! points and lines of the drawing, not from derivatives of Φ with respect to the coordinates of
//! bodies. Ranks are computed by elimination with integers. The same reference is used for the
//! mechanisms of [`space`](crate::fuzz::space) and for planar drawings, whose rows are converted to
//! space.
//!
//! | module | content |
//! | --- | --- |
//! | [`wrench`] | a mechanism, represented by the wrenches of its rows |
//! | [`truth`] | elimination, and the exact results |
//! | [`expected`] | the correct results as plain data |
//! | [`answer`] | the answer of the program |
//! | [`examine`] | comparison of answer and correct results |
//! | [`findings`] | the errors in an answer |
//! | [`words`] | comparison of the sentences |
//! | [`distance`] | comparison of the rank within a tolerance |
//! | [`deletions`] | comparison of the rows that may be deleted |
//! | [`outcome`] | the result for one scene |
//! | [`tally`] | the suites, and the results for many scenes |
//!
//! The families in the plane are:
//!
//! | module | content |
//! | --- | --- |
//! | [`ratio`] | fractions, and sums with one square root |
//! | [`drawing`] | bodies and joints at one configuration, in fractions |
//! | [`families`] | families of degenerate drawings, with similar drawings that are not degenerate |
//! | [`pose`] | variants of a drawing: translated, rotated, swapped, in another order |
//! | [`text`] | the scene as text |
//! | [`lift`] | the rows of a drawing as wrenches in space |
//! | [`doubles`] | a drawing in double precision, at any configuration and for any data |
//! | [`minimax`] | proved bounds of the smallest change of data that satisfies given equations |
//! | [`near`] | the distance of the data from a lower rank, computed with `doubles` and `minimax` |
//! | [`loads`] | reactions under gravity, in double precision |
//! | [`within`] | comparison of the answers within a tolerance |
//! | [`rounded`] | scenes with few digits, and scenes of full rank near a lower rank |

pub mod answer;
pub mod deletions;
pub mod distance;
pub mod doubles;
pub mod drawing;
pub mod examine;
pub mod expected;
pub mod families;
pub mod findings;
pub mod lift;
pub mod loads;
pub mod minimax;
pub mod near;
pub mod outcome;
pub mod pose;
pub mod precisions;
pub mod ratio;
pub mod rounded;
pub mod tally;
pub mod text;
pub mod truth;
pub mod within;
pub mod words;
pub mod wrench;

use suite::numbers::Numbers;

use drawing::Drawing;
use families::Family;
use pose::{Posed, Writing};

/// One scene, which contains one variant of a drawing.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Family of the scene.
    pub family: Family,
    /// Written form of the drawing.
    pub writing: Writing,
    /// The drawing after the motion, with its elements in the order of the file.
    pub posed: Posed,
}

/// Scene `number` of a seed. Scenes `4·k` to `4·k + 3` contain the same drawing, in the written
/// forms of [`Writing::ALL`].
#[must_use]
pub fn scene(seed: u64, number: u64) -> Scene {
    let ways = Writing::ALL.len() as u64;
    let (drawn, way) = (number / ways, number % ways);
    let family = Family::ALL[(drawn % Family::ALL.len() as u64) as usize];
    let stream = |salt: u64| Numbers::new(seed ^ Numbers::new(salt).bits());
    let drawing: Drawing = family.draw(&mut stream(drawn));
    let writing = Writing::ALL[way as usize];
    let posed = Posed::new(&drawing, writing, &mut stream(!number));
    Scene {
        family,
        writing,
        posed,
    }
}
