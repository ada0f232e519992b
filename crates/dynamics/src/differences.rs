//! Weights of central differences, for the distances of one to four steps: the derivative is the
//! sum of `w·(f(h) − f(−h))` over one step.

/// Of order eight.
pub(crate) const ORDER_8: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Of order six.
pub(crate) const ORDER_6: [f64; 4] = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0, 0.0];
