//! What numbers as stored are known to.

/// Relative error of the numbers of a scene and of values computed from them: half a unit in the
/// last place for each of eight roundings, which are reading of the number, the position of its
/// body (two), its rotation into the frame of the body (two), sine and cosine, and the evaluation
/// of C (two).
pub const ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;

/// Points whose distance is at most this many roundings of their coordinates coincide.
const COINCIDE: f64 = 1e3;

/// Whether two points at this distance are apart: it is more than the rounding of the lengths that
/// are added in their coordinates, the longest of which is `farthest`.
pub(crate) fn are_apart(distance: f64, farthest: f64) -> bool {
    distance > COINCIDE * ROUNDING * farthest
}
