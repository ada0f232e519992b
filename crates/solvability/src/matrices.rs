//! Solvability of a plain constraint matrix: which combinations of multipliers are the same in all solutions
//! `λ = λ₀ + Z·y` of `M·a + Cᵀ·λ = Q`.
//!
//! Source: Wojtyra, Frączek (2013), doi 10.1007/s11044-013-9352-0: with `C·P = Q·R` and the last p columns
//! of Q as Z, the reaction of a joint with rows X is unique iff `B_X = C_Xᵀ·Z_X = 0` (27). Here Z is an orthonormal
//! basis of the left null space of the equilibrated C; it spans the same space, up to the scaling of rows.

use std::ops::Range;

use linalg::{Matrix, PivotedQr, RankDecision, RankError, RankStatus};

use crate::verdict::Judgement;

/// Entries of the map from multipliers to a reaction are products of a few numbers near one; below this share of the
/// largest row a row is their rounding.
const ROUNDING_OF_MAP: f64 = 1e-14;

/// What can be said of the multipliers of a constraint matrix.
///
/// ```
/// use linalg::Matrix;
/// use solvability::{Solvability, Verdict};
/// // Rows 0 and 1 say the same; row 2 stands alone.
/// let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 1.0]]);
/// let s = Solvability::of(&c, 0.0)?;
/// assert_eq!((s.decision().rank, s.decision().redundancy), (2, 1));
/// assert_eq!(s.row(0).verdict, Verdict::NotUnique);
/// assert_eq!(s.row(2).verdict, Verdict::Unique);
/// // λ₀ + 2·λ₁ is the total force along x: unique.
/// assert_eq!(s.combination(&[1.0, 2.0, 0.0]).verdict, Verdict::Unique);
/// # Ok::<(), linalg::RankError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solvability {
    decision: RankDecision,
    /// The equilibrated matrix, m × n.
    c: Matrix,
    /// Orthonormal basis of its left null space, m × p.
    z: Matrix,
    tolerance: f64,
}

impl Solvability {
    /// Decides the rank of `c` (m × n) and keeps what verdicts need. `residual` is that of the constraints at the point where `c`
    /// was evaluated, relative to the lengths of the model.
    ///
    /// # Errors
    /// If an entry or the residual is not finite.
    pub fn of(c: &Matrix, residual: f64) -> Result<Self, RankError> {
        Ok(Self::from_decision(c, linalg::decide(c, residual)?))
    }

    /// The same for a rank that has been decided already.
    #[must_use]
    pub fn from_decision(c: &Matrix, decision: RankDecision) -> Self {
        let z = linalg::orthonormal(&decision);
        let tolerance = linalg::support_tolerance(&decision);
        Self {
            c: decision.scaling.apply(c),
            z,
            tolerance,
            decision,
        }
    }

    /// The rank and its evidence.
    #[must_use]
    pub fn decision(&self) -> &RankDecision {
        &self.decision
    }

    /// Orthonormal basis of the left null space of the equilibrated matrix, m × p.
    #[must_use]
    pub fn null_space(&self) -> &Matrix {
        &self.z
    }

    /// `D_r·C·D_c`, the matrix that verdicts are about.
    pub(crate) fn equilibrated(&self) -> &Matrix {
        &self.c
    }

    /// The multiplier of one row: unique iff `Z_i = 0`.
    #[must_use]
    pub fn row(&self, i: usize) -> Judgement {
        self.judge(norm(self.z.row(i)))
    }

    /// All multipliers of a group of rows: unique iff `Z_X = 0`. Stronger than [`Solvability::group`] where the rows
    /// depend on each other.
    #[must_use]
    pub fn multipliers(&self, rows: Range<usize>) -> Judgement {
        self.judge(rows.map(|i| norm(self.z.row(i))).fold(0.0, f64::hypot))
    }

    /// `B_X = C_Xᵀ·Z_X` (n × p) of a group of rows, equilibrated.
    #[must_use]
    pub fn b_x(&self, rows: Range<usize>) -> Matrix {
        let mut b = Matrix::zeros(self.c.ncols(), self.z.ncols());
        for i in rows {
            for (k, &c) in self.c.row(i).iter().enumerate().filter(|(_, c)| **c != 0.0) {
                for (b, z) in b.row_mut(k).iter_mut().zip(self.z.row(i)) {
                    *b += c * z;
                }
            }
        }
        b
    }

    /// The reaction of a group of rows: unique iff `B_X = 0`; the margin is ‖B_X‖ (Frobenius).
    #[must_use]
    pub fn group(&self, rows: Range<usize>) -> Judgement {
        self.judge(self.b_x(rows).frobenius_norm())
    }

    /// A linear combination `ℓᵀ·λ` of all multipliers: unique iff `ℓᵀ·Z = 0`; the margin is relative to ‖ℓ‖, both
    /// for equilibrated rows.
    #[must_use]
    pub fn combination(&self, l: &[f64]) -> Judgement {
        self.judge(norm(&self.scaled_row(l, 0..l.len()).0))
    }

    /// Component `k` of a reaction `W·λ_X`: unique iff row k of `W·Z_X` is zero; the margin is relative to the largest row of W.
    /// A row that is rounding beside the others is zero.
    #[must_use]
    pub fn component(&self, map: &Matrix, k: usize, rows: Range<usize>) -> Judgement {
        let size = |i: usize| self.scaled_norm(map.row(i), rows.clone());
        let largest = (0..map.nrows()).map(size).fold(0.0, f64::max);
        if size(k) <= ROUNDING_OF_MAP * largest {
            return self.judge(0.0);
        }
        let (image, own) = self.scaled_row(map.row(k), rows);
        self.judge(norm(&image) * own / largest)
    }

    /// Directions in which a reaction is unique: a basis of the left null space of `W·Z_X` for the map W
    /// (k × |X|) from multipliers to components. Unit vectors with k entries; the largest entry is positive.
    #[must_use]
    pub fn unique_directions(&self, map: &Matrix, rows: Range<usize>) -> Vec<Vec<f64>> {
        let k = map.nrows();
        let largest = (0..k)
            .map(|i| self.scaled_norm(map.row(i), rows.clone()))
            .fold(0.0, f64::max);
        let (images, sizes): (Vec<_>, Vec<_>) = (0..k)
            .map(|i| match self.scaled_row(map.row(i), rows.clone()) {
                // Rounding beside the other components is zero.
                (image, size) if size <= ROUNDING_OF_MAP * largest => (vec![0.0; image.len()], 1.0),
                row => row,
            })
            .unzip();
        let p = self.z.ncols();
        let image = Matrix::from_fn(k, p, |i, j| images[i][j]);
        let qr = PivotedQr::of_columns(&image);
        let rank = qr.r_diagonal().filter(|r| r.abs() > self.tolerance).count();
        if rank == 0 {
            return (0..k).map(|i| unit(k, i)).collect();
        }
        let basis = qr.q_columns(rank..k);
        (0..k - rank)
            .map(|j| {
                // Back from components of equal size to the units of the map.
                let direction = (0..k).map(|i| basis[(i, j)] / sizes[i]).collect();
                normalised(direction, self.tolerance)
            })
            .collect()
    }

    fn scaled_norm(&self, w: &[f64], rows: Range<usize>) -> f64 {
        norm(
            &rows
                .zip(w)
                .map(|(i, w)| w * self.decision.scaling.row_factor(i))
                .collect::<Vec<_>>(),
        )
    }

    /// `wᵀ·D_r·Z_X / ‖wᵀ·D_r‖` and the norm that was divided by (1 for w = 0).
    fn scaled_row(&self, w: &[f64], rows: Range<usize>) -> (Vec<f64>, f64) {
        let scaled: Vec<f64> = rows
            .clone()
            .zip(w)
            .map(|(i, w)| w * self.decision.scaling.row_factor(i))
            .collect();
        let size = match norm(&scaled) {
            0.0 => 1.0,
            size => size,
        };
        let mut out = vec![0.0; self.z.ncols()];
        for (i, w) in rows.zip(&scaled) {
            for (o, z) in out.iter_mut().zip(self.z.row(i)) {
                *o += w / size * z;
            }
        }
        (out, size)
    }

    fn judge(&self, margin: f64) -> Judgement {
        match &self.decision.status {
            RankStatus::Undecided(doubt) => Judgement::without_rank(margin, doubt),
            _ => Judgement::of(margin, self.tolerance),
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit(n: usize, i: usize) -> Vec<f64> {
    (0..n).map(|k| if k == i { 1.0 } else { 0.0 }).collect()
}

/// The unit vector along x, the largest entry positive, rounding set to zero.
fn normalised(mut x: Vec<f64>, rounding: f64) -> Vec<f64> {
    let largest = x
        .iter()
        .fold(0.0_f64, |a, &b| if b.abs() > a.abs() { b } else { a });
    let size = norm(&x) * largest.signum();
    for x in &mut x {
        *x /= size;
        if x.abs() <= rounding {
            *x = 0.0;
        }
    }
    x
}
