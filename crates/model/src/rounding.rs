//! Accuracy of stored numbers.

/// Relative error of the numbers of a scene and of values computed from them. It is half a unit in
/// the last place for each of eight roundings: reading of the number, the position of its body
/// (two), its rotation into the frame of the body (two), sine and cosine, and the evaluation of C
/// (two).
pub const ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;

/// Points whose distance is at most this many roundings of their coordinates coincide.
const COINCIDE: f64 = 1e3;

/// Returns whether two points at this distance are separate: the distance exceeds the rounding of
/// the lengths that are added in their coordinates. The longest of these lengths is `farthest`.
pub(crate) fn are_apart(distance: f64, farthest: f64) -> bool {
    distance > COINCIDE * ROUNDING * farthest
}
