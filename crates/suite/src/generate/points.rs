//! Points and directions.

/// The direction at an angle from the x-axis.
pub(super) fn direction(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// `point + length·direction`
pub(super) fn step(point: [f64; 2], length: f64, direction: [f64; 2]) -> [f64; 2] {
    [
        point[0] + length * direction[0],
        point[1] + length * direction[1],
    ]
}

/// Returns the midpoint of two points.
pub(super) fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}
