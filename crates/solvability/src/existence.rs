//! Existence before uniqueness: redundant rows must agree. `C·v = b` has a solution iff `Zᵀ·b = 0`, and
//! `C·a = Γ` iff `Zᵀ·Γ = 0`; each circuit is one such condition.

use linalg::RankDecision;
use model::RowLabel;

/// Where rows are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintLevel {
    /// Φ = 0
    Position,
    /// C·v = b
    Velocity,
    /// C·a = Γ
    Acceleration,
}

impl std::fmt::Display for ConstraintLevel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Position => "positions",
            Self::Velocity => "velocities",
            Self::Acceleration => "accelerations",
        })
    }
}

/// Redundant rows that cannot hold together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "at t = {time} s rows {} depend on each other but ask for different {level}: they differ by {size:.3e}. \
     Redundant drives must follow the same motion; delete or correct one of them",
    list(rows)
)]
pub struct Contradiction {
    /// When.
    pub time: f64,
    /// The rows of one circuit.
    pub rows: Vec<RowLabel>,
    /// Position, velocity or acceleration.
    pub level: ConstraintLevel,
    /// `|Σ coefficient·right-hand side|`, the largest coefficient 1.
    pub size: f64,
}

fn list(rows: &[RowLabel]) -> String {
    rows.iter()
        .map(RowLabel::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}

/// Redundant right-hand sides agree to this share of their scale: the noise of the coefficients, with room.
const AGREEMENT: f64 = 1e-9;

/// The worst contradiction among the circuits of a rank decision for a right-hand side (b or Γ), if there is one. `scale` is
/// the size of a right-hand side that matters: that of the terms it is made of, or of the velocities of the mechanism.
///
/// # Panics
/// If `labels` and `rhs` have not one entry for each row.
#[must_use]
pub fn contradiction(
    decision: &RankDecision,
    labels: &[RowLabel],
    rhs: &[f64],
    scale: f64,
    level: ConstraintLevel,
    time: f64,
) -> Option<Contradiction> {
    assert!(
        labels.len() == rhs.len(),
        "{} labels, {} values",
        labels.len(),
        rhs.len()
    );
    linalg::circuits(decision)
        .into_iter()
        .filter_map(|circuit| {
            let terms = circuit
                .rows
                .iter()
                .zip(&circuit.coefficients)
                .map(|(&i, c)| c * rhs[i]);
            let size = terms.sum::<f64>().abs();
            (size.is_nan() || size > AGREEMENT * scale).then(|| Contradiction {
                time,
                rows: circuit.rows.iter().map(|&i| labels[i].clone()).collect(),
                level,
                size,
            })
        })
        .max_by(|a, b| a.size.total_cmp(&b.size))
}
