//! Accuracy of stored numbers.

/// Relative error of the values in a scene and of values computed from them. It is half a unit in
/// the last place for each of eight roundings: reading of the value, the position of the body
/// (two), the rotation into the body frame (two), sine and cosine, and the evaluation of C (two).
pub const ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;

/// Two points coincide if their distance is at most this multiple of the rounding error of their
/// coordinates.
const COINCIDE: f64 = 1e3;

/// Returns whether two points at this distance are separate: the distance exceeds the rounding
/// error of their coordinates, which are sums of lengths. The longest of these lengths is
/// `farthest`.
pub(crate) fn are_apart(distance: f64, farthest: f64) -> bool {
    distance > COINCIDE * ROUNDING * farthest
}
