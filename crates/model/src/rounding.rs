//! Accuracy of stored numbers.

/// Relative error of the values in a scene and of values computed from them. The error is half a
/// unit in the last place for each of eight roundings: reading of the value, the position of the
/// body
pub const ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;

/// Two points coincide if their distance is at most this multiple of the rounding error of their
/// coordinates.
const COINCIDE: f64 = 1e3;

/// Returns whether two points at this distance are separate. Two points are separate if the
/// distance exceeds the rounding error of their coordinates. The coordinates are sums of lengths,
/// and `farthest` is the longest of these lengths.
pub(crate) fn are_apart(distance: f64, farthest: f64) -> bool {
    distance > COINCIDE * ROUNDING * farthest
}
