//! Operations on vectors with three components, or with any number of components.

/// Returns the cross product `e × a`, where e is the unit vector along an axis of the ground (0 for
/// x to 2 for z). The result is the velocity of a point at the position `a` of a body that rotates
/// about this axis at 1 rad/s.
#[must_use]
pub fn unit_cross(axis: usize, a: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| match (k + 3 - axis) % 3 {
        0 => 0.0,
        // The subtraction avoids the negative zero of `-a`.
        1 => 0.0 - a[(k + 1) % 3],
        _ => a[(k + 2) % 3],
    })
}

/// Returns a − b.
#[must_use]
pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Returns the length of a vector with any number of components.
#[must_use]
pub fn norm(x: &[f64]) -> f64 {
    match x {
        [x, others @ ..] => others.iter().fold(x.abs(), |norm, x| match *x {
            // Zeros are skipped: most vectors of planar mechanisms contain zeros, and square roots
            // are expensive.
            0.0 => norm,
            x if norm == 0.0 => x.abs(),
            x => norm.hypot(x),
        }),
        [] => 0.0,
    }
}
