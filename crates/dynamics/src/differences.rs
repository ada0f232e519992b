//! Weights w_k of central differences at the distances k·h, k = 1 to 4. The derivative is
//! `Σ w_k·(f(k·h) − f(−k·h))`, divided by the step h.

/// Weights of order eight.
pub(crate) const ORDER_8: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Weights of order six.
pub(crate) const ORDER_6: [f64; 4] = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0, 0.0];
