//! The equations behind the multipliers, and one solution of them: on the kept rows of the rank decision, the dropped ones zero.

use linalg::{KeptRowSaddle, Matrix, RankDecision, RankStatus};
use model::{ColumnKind, Mechanism, System};

use super::ChoiceError;
use crate::groups::{RequestError, check};

/// `M·a + Cᵀ·λ = Q`, `C·a = Γ` at one instant.
///
/// ```
/// use linalg::{Matrix, decide};
/// use solvability::Equations;
/// // Two equal rows hold a unit mass against a force of 3.
/// let equations = Equations {
///     mass: vec![1.0],
///     force: vec![3.0],
///     c: Matrix::from_rows(&[[1.0], [1.0]]),
///     gamma: vec![0.0, 0.0],
///     gamma_terms: vec![0.0, 0.0],
/// };
/// let lambda = equations.multipliers(&decide(&equations.c, 0.0)?)?;
/// assert_eq!(lambda.iter().sum::<f64>(), 3.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    /// Diagonal of M, n_v.
    pub mass: Vec<f64>,
    /// Q, n_v.
    pub force: Vec<f64>,
    /// C, (m + h) × n_v.
    pub c: Matrix,
    /// Γ, m + h.
    pub gamma: Vec<f64>,
    /// Size of the terms that each entry of Γ is made of, m + h: what is small beside it is rounding. Zeros where Γ is exact.
    pub gamma_terms: Vec<f64>,
}

/// Redundant accelerations agree to this share of their terms: that of rounding in velocities on the constraints, with room.
const AGREEMENT: f64 = 1e-9;

impl Equations {
    /// Those of a mechanism at time t, coordinates q and velocities v, which must satisfy the constraints.
    ///
    /// # Errors
    /// [`RequestError::Length`], [`RequestError::NotFinite`]: t, q or v do not fit the mechanism.
    pub fn of(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Result<Self, RequestError> {
        let layout = mechanism.layout();
        check("t", &[t], 1)?;
        check("q", q, layout.n_q)?;
        check("v", v, layout.n_v)?;
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        mechanism.twist(v, &mut s);
        mechanism.gamma(&mut s);
        mechanism.force(&mut s);
        let size = model::start::scene_size(mechanism, q);
        let length = |kind: &ColumnKind| match kind {
            ColumnKind::Translation => size,
            ColumnKind::Rotation => 1.0,
        };
        let lengths: Vec<f64> = mechanism.column_kinds().iter().map(length).collect();
        // The fastest thing in the mechanism, in rad/s; Γ is quadratic in it.
        let rates = v.iter().zip(&lengths).map(|(v, length)| (v / length).abs());
        let rate = rates.fold(0.0, f64::max);
        let reach = |i| layout.row(&s, i).map(|(k, c)| c.abs() * lengths[k]);
        let gamma_terms = (0..layout.rows())
            .map(|i| rate * rate * reach(i).sum::<f64>())
            .collect();
        Ok(Self {
            mass: mechanism.mass().to_vec(),
            c: layout.dense(&s),
            force: s.force,
            gamma: s.gamma,
            gamma_terms,
        })
    }

    /// One solution λ: that of the kept rows, zero on the dropped ones. All others are `λ + Z·y`.
    ///
    /// # Errors
    /// - [`ChoiceError::Undecided`]: which rows to keep is not known.
    /// - [`ChoiceError::Saddle`]: the kept rows and the masses do not determine the accelerations.
    /// - [`ChoiceError::Contradiction`]: the dropped rows ask for other accelerations, so there is no solution at all.
    /// - [`ChoiceError::Request`]: sizes do not fit.
    pub fn multipliers(&self, decision: &RankDecision) -> Result<Vec<f64>, ChoiceError> {
        let (m, n) = (self.c.nrows(), self.c.ncols());
        check("gamma", &self.gamma, m)?;
        check("gamma_terms", &self.gamma_terms, m)?;
        if decision.scaling.rows.len() != m {
            return Err(ChoiceError::Request(RequestError::Length {
                argument: "the rank decision, by rows,",
                found: decision.scaling.rows.len(),
                expected: m,
            }));
        }
        if let RankStatus::Undecided(doubt) = decision.status {
            return Err(ChoiceError::Undecided(doubt));
        }
        let kept = &decision.kept;
        let mut saddle = KeptRowSaddle::new(n, kept.len())?;
        saddle.factor(|k| self.c.row(kept[k]), &self.mass)?;
        let gamma: Vec<f64> = kept.iter().map(|&i| self.gamma[i]).collect();
        let (mut a, mut of_kept) = (vec![0.0; n], vec![0.0; kept.len()]);
        saddle.solve(&self.force, &gamma, &mut a, &mut of_kept)?;
        let rounding = self.rounding_of(&a);
        for &row in &decision.dropped {
            let terms = self.c.row(row).iter().zip(&a).map(|(c, a)| c * a);
            let by = (terms.sum::<f64>() - self.gamma[row]).abs();
            let entries = self.c.row(row).iter().zip(&rounding);
            let size = entries.map(|(c, a)| c.abs() * a).sum::<f64>();
            let allowed = AGREEMENT * (size + self.gamma[row].abs() + self.gamma_terms[row]);
            if by.is_nan() || by > allowed {
                return Err(ChoiceError::Contradiction { row, by, allowed });
            }
        }
        let mut lambda = vec![0.0; m];
        for (&i, l) in kept.iter().zip(of_kept) {
            lambda[i] = l;
        }
        Ok(lambda)
    }

    /// What the error of each acceleration is proportional to: the largest one, each measured by the size of its column in C.
    fn rounding_of(&self, a: &[f64]) -> Vec<f64> {
        let units = linalg::equilibrate(&self.c).cols;
        let units: Vec<f64> = units.into_iter().map(|e| f64::from(e).exp2()).collect();
        let largest = a.iter().zip(&units).map(|(a, unit)| (a / unit).abs());
        let largest = largest.fold(0.0, f64::max);
        units.iter().map(|unit| unit * largest).collect()
    }
}
