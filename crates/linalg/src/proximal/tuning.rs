//! How μ, the number of iterations and the weights of rows are chosen: once, where the rank has been decided.

use crate::rank::ROUNDING;
use crate::saddle::SaddleError;
use crate::{Matrix, PivotedQr, ldl, singular_values};

/// μ and the number of proximal iterations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProximalTuning {
    /// μ, compared with the eigenvalues of C̃·M⁻¹·C̃ᵀ.
    pub mu: f64,
    /// k
    pub iterations: usize,
}

impl ProximalTuning {
    /// μ a decade below σ_r², and as many iterations as leave the share `tolerance` of the slowest direction: `(μ/(μ + σ_r²))^k ≤ tolerance`.
    ///
    /// A tolerance below the rounding of numbers is taken for that; an infinite σ_r² (no rows, or none that moves mass) for 1.
    ///
    /// ```
    /// use linalg::ProximalTuning;
    /// let tuning = ProximalTuning::rule(4e-3, 1e-8);
    /// assert!((tuning.mu - 4e-4).abs() < 1e-18);
    /// assert_eq!(tuning.iterations, 8); // 11⁻⁸ = 4.7e-9
    /// ```
    #[must_use]
    pub fn rule(sigma_squared: f64, tolerance: f64) -> Self {
        const DECADE: f64 = 0.1;
        let mu = DECADE * sigma_squared.min(1.0);
        let share = DECADE / (1.0 + DECADE);
        let tolerance = tolerance.clamp(f64::EPSILON, share);
        Self {
            mu,
            iterations: (tolerance.ln() / share.ln()).ceil() as usize,
        }
    }
}

/// `w_i = (C_i·M⁻¹·C_iᵀ)^(−½)`: the root of the mass that a row moves. Coordinates without mass do not count; a row that moves none at all is
/// as heavy as the heaviest one.
pub(super) fn row_weights(c: &Matrix, mass: &[f64]) -> Vec<f64> {
    let mobility = |i: usize| {
        let terms = c.row(i).iter().zip(mass).filter(|(_, m)| **m > 0.0);
        terms.map(|(c, m)| c * c / m).sum::<f64>()
    };
    let weight = |mobility: f64| (mobility > 0.0).then(|| mobility.sqrt().recip());
    let weights: Vec<Option<f64>> = (0..c.nrows()).map(|i| weight(mobility(i))).collect();
    let heaviest = weights.iter().flatten().fold(0.0, |a: f64, w| a.max(*w));
    let otherwise = if heaviest > 0.0 { heaviest } else { 1.0 };
    weights
        .into_iter()
        .map(|w| w.unwrap_or(otherwise))
        .collect()
}

/// σ_r², the r-th eigenvalue of C̃·M⁻¹·C̃ᵀ, from L·D·Lᵀ of M + C̃ᵀ·C̃, in which it is `σ²/(1 + σ²)`: so masses may be zero.
pub(super) fn smallest_direction(
    rows: &Matrix,
    factored: &[f64],
    rank: usize,
) -> Result<f64, SaddleError> {
    let (m, n) = (rows.nrows(), rows.ncols());
    let Some(last) = rank.checked_sub(1) else {
        return Ok(f64::INFINITY);
    };
    if rank > m.min(n) {
        return Err(SaddleError::TooManyRows {
            n: m.min(n),
            r: rank,
        });
    }
    let mut whitened = rows.clone();
    for k in 0..m {
        let row = whitened.row_mut(k);
        ldl::forward(factored, row);
        for (i, x) in row.iter_mut().enumerate() {
            *x /= factored[i * n + i].sqrt();
        }
    }
    let sigma = singular_values(&whitened);
    if sigma[last] <= ROUNDING * sigma[0] {
        return Err(SaddleError::RankLost {
            row: PivotedQr::of_rows(whitened).permutation()[last],
            pivot: sigma[last],
            scale: sigma[0],
        });
    }
    // A direction that moves no mass is 1 up to rounding.
    let share = sigma[last] * sigma[last];
    Ok(match 1.0 - share {
        left if left > 0.0 => share / left,
        _ => f64::INFINITY,
    })
}
