//! The precisions to which drawings are written.

/// Numbers of significant digits. Scenes with the last number of digits state no tolerance.
pub const DIGITS: [usize; 14] = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// Tolerances for drawings near a lower rank, as fractions of τ*/3.
pub const PARTS: [f64; 6] = [0.99, 0.5, 0.1, 1e-2, 1e-4, 1e-7];
