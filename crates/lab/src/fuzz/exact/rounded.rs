//! Sets of scenes with a tolerance: degenerate drawings whose coordinates are rounded to 3 … 16
//! significant digits, and drawings of full rank near a lower rank.

use suite::numbers::Numbers;

use super::answer;
use super::distance::BEYOND_DOUBT;
use super::doubles::{Doubles, extent};
use super::examine::examine;
use super::families::Family;
use super::families::slender::Slender;
use super::outcome::{JudgedStart, Outcome, judged};
use super::pose::{Posed, Writing};
use super::precisions::{DIGITS, PARTS};
use super::ratio::Ratio;
use super::tally::Suite;
use super::text::text_within;
use super::within::Meant;
use crate::fuzz::space;
use crate::fuzz::space::text::Precision;

/// Gravity (m/s²). The direction is not parallel to an axis.
const GRAVITY: [f64; 3] = [3.0, -9.0, 0.0];

/// Returns a drawing in the plane, translated by up to its size and rotated.
fn posed(suite: Suite, seed: u64, drawn: u64) -> (&'static str, Posed) {
    let mut numbers = Numbers::new(seed ^ Numbers::new(drawn).bits());
    let (name, drawing) = if suite == Suite::FullRank {
        let kind = Slender::ALL[(drawn % Slender::ALL.len() as u64) as usize];
        (kind.name(), kind.draw(&mut numbers))
    } else {
        let family = Family::ALL[(drawn % Family::ALL.len() as u64) as usize];
        (family.name(), family.draw(&mut numbers))
    };
    let mut posed = Posed::new(&drawing, Writing::Moved, &mut numbers);
    posed.shift = [Ratio::ZERO; 2];
    let size = extent(&posed);
    let tenths = (7.0 * size).floor() as i32;
    posed.shift = [0; 2].map(|_| Ratio::new(numbers.between(-tenths, tenths).into(), 10));
    (name, posed)
}

/// Returns the results for all scenes of one drawing. For `Suite::FullRank`, the drawing must have
/// full rank. The list is empty if the random numbers give a drawing with redundant rows.
#[must_use]
pub fn outcomes(suite: Suite, seed: u64, drawn: u64) -> Vec<Outcome> {
    if suite == Suite::RoundedInSpace {
        return space::within::outcomes(seed, drawn);
    }
    let (family, posed) = posed(suite, seed, drawn);
    let is_rounded = suite == Suite::RoundedInPlane;
    let gravity = if is_rounded { GRAVITY } else { [0.0; 3] };
    let meant = Meant::of(&posed, seed, [gravity[0], gravity[1]]);
    if !is_rounded && meant.right.redundancy > 0 {
        return Vec::new();
    }
    let largest = largest_coordinate(&posed);
    let one = |way: usize| {
        let precision = if is_rounded {
            let digits = DIGITS[way];
            let tolerance = 2.0 * 10_f64.powi(1 - digits as i32) * largest;
            Precision {
                digits: Some(digits),
                tolerance: (digits < 16).then_some(tolerance),
                gravity,
            }
        } else {
            Precision {
                tolerance: Some(PARTS[way] * meant.from.low / BEYOND_DOUBT),
                ..Precision::default()
            }
        };
        outcome(suite, family, way, (&posed, &meant), &precision)
    };
    (0..suite.ways()).map(one).collect()
}

fn outcome(
    suite: Suite,
    family: &'static str,
    way: usize,
    (posed, meant): (&Posed, &Meant<'_>),
    precision: &Precision,
) -> Outcome {
    let text = text_within(posed, precision);
    let is_full_rank = suite == Suite::FullRank;
    let judged = judged(
        || answer::answer(&text),
        |document| match precision.tolerance {
            Some(tolerance) => {
                let judged = meant.judge(document, tolerance);
                let other_rank = judged.other_rank.filter(|_| !is_full_rank);
                JudgedStart {
                    other_rank,
                    ..judged
                }
            }
            None => JudgedStart {
                findings: examine(&meant.truth, &meant.right, document),
                ..JudgedStart::default()
            },
        },
    );
    let tolerance = precision.tolerance.unwrap_or(0.0);
    Outcome {
        family,
        way,
        truth: format!(
            "{}\nτ* from {:.3e} m to {:.3e} m, tolerance {tolerance:.3e} m, size {:.3e} m, {}",
            meant.right.describe(),
            meant.from.low,
            meant.from.high,
            meant.size,
            if meant.is_permanent {
                "permanent"
            } else {
                "singular pose"
            },
        ),
        text,
        judged,
        must_be_decided: is_full_rank || meant.distance(tolerance).is_far(),
        is_redundant: meant.right.redundancy > 0,
    }
}

/// Returns the largest coordinate in the text (m).
fn largest_coordinate(posed: &Posed) -> f64 {
    let doubles = Doubles::of(posed);
    let lengths = doubles.blocks.iter().filter(|b| b.count == 2);
    let local = lengths.flat_map(|b| &doubles.data[b.first..b.first + 2]);
    let bodies = doubles.q.chunks_exact(3).flat_map(|q| &q[..2]);
    let world = posed.links.iter().flat_map(|p| p.link.tie.points());
    let world = world.flat_map(|p| posed.point(p).map(|x| x.rounded(posed.stretch)));
    let largest = local.chain(bodies).copied().chain(world);
    largest.fold(0.0, |a: f64, x| a.max(x.abs())).max(1.0)
}
