//! The equations for the multipliers, and the solution of them on the kept rows of the rank
//! decision; the multipliers of dropped rows are zero.

use std::sync::Arc;

use crate::finite::NoFiniteReaction;
use crate::limits::{AGREEMENT, ROWS_MAX};
use crate::pose::velocity_units;
use crate::row_decision::RowDecision;
use linalg::{KeptRowSaddle, Matrix, SchurSaddle, SchurStructure};
use model::{ColumnKind, Mechanism, Scratch, System};
use rank::RankStatus;

use super::ChoiceError;
use crate::groups::{RequestError, check};
use crate::parts::Extent;
use crate::sparse::{blocks, rows_of};

/// `M·a + Cᵀ·λ = Q`, `C·a = Γ` at one instant.
///
/// ```
/// use linalg::{Matrix};
/// use rank::{decide};
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
    /// Size of the terms that are added up in each entry of Γ, m + h: an entry that is small
    /// relative to it is rounding. Zeros if Γ is exact.
    pub gamma_terms: Vec<f64>,
}

/// Accelerations, and one solution for the multipliers.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// a, n_v.
    pub acceleration: Vec<f64>,
    /// λ with zeros on the dropped rows. All other solutions are `λ + Z·y`.
    pub multipliers: Vec<f64>,
    /// Reactions that have no finite value in the motion, whatever the multipliers say:
    /// [`crate::no_finite_reactions`]. Empty unless the caller asks for them.
    pub no_finite: Vec<Arc<NoFiniteReaction>>,
}

impl Equations {
    /// The equations of a mechanism at time t, coordinates q and velocities v, which must satisfy
    /// the constraints.
    ///
    /// # Errors
    /// [`RequestError::Length`], [`RequestError::NotFinite`]: t, q or v do not fit the mechanism.
    pub fn of(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Result<Self, RequestError> {
        let Terms { s, gamma_terms } = Terms::of(mechanism, t, q, v)?;
        Ok(Self {
            mass: mechanism.mass().to_vec(),
            c: mechanism.layout().dense(&s),
            force: s.force,
            gamma: s.gamma,
            gamma_terms,
        })
    }

    /// The equations of a part of a mechanism, given a solution of the whole; the forces of other
    /// parts on its bodies become loads. The accelerations are the same, and the multipliers of the
    /// whole are one of the solutions of the part.
    ///
    /// # Errors
    /// As [`Equations::of`].
    pub(crate) fn of_part(
        part: &Mechanism,
        extent: &Extent,
        (t, q, v): (f64, &[f64], &[f64]),
        solution: &Solution,
    ) -> Result<Self, RequestError> {
        let [q, v, a] = [
            extent.coordinates(q),
            extent.velocities(v),
            extent.velocities(&solution.acceleration),
        ];
        let of_part = Self::of(part, t, &q, &v)?;
        let lambda = extent.of_rows(&solution.multipliers);
        // The accelerations are known, so any positive masses serve; only zeros are replaced.
        let largest = of_part.mass.iter().fold(0.0_f64, |a, m| a.max(*m));
        let some = |m: &f64| match (*m > 0.0, largest > 0.0) {
            (true, _) => *m,
            (false, true) => largest,
            (false, false) => 1.0,
        };
        let mass: Vec<f64> = of_part.mass.iter().map(some).collect();
        let mut force = of_part.c.transpose_times(&lambda);
        for ((f, m), a) in force.iter_mut().zip(&mass).zip(a.iter()) {
            *f += m * a;
        }
        Ok(Self {
            mass,
            force,
            gamma: of_part.c.times(&a),
            ..of_part
        })
    }

    /// Solves for one λ, with zeros on the dropped rows. All other solutions are `λ + Z·y`.
    ///
    /// # Errors
    /// - [`ChoiceError::Undecided`]: the rank is undecided, so the kept rows are not known.
    /// - [`ChoiceError::Saddle`]: the kept rows and the masses do not determine the accelerations.
    /// - [`ChoiceError::Contradiction`]: the dropped rows require other accelerations, so there is
    ///   no solution.
    /// - [`ChoiceError::Request`]: sizes do not fit.
    pub fn multipliers(&self, rows: impl Into<RowDecision>) -> Result<Vec<f64>, ChoiceError> {
        self.solution(rows).map(|solution| solution.multipliers)
    }

    /// Like [`Equations::multipliers`], with the accelerations.
    ///
    /// # Errors
    /// As [`Equations::multipliers`].
    pub fn solution(&self, rows: impl Into<RowDecision>) -> Result<Solution, ChoiceError> {
        let rows = rows.into();
        let (m, n) = (self.c.nrows(), self.c.ncols());
        check("gamma", &self.gamma, m)?;
        check("gamma_terms", &self.gamma_terms, m)?;
        check_rows(&rows, m)?;
        let kept = &rows.kept;
        let mut saddle = KeptRowSaddle::new(n, kept.len())?;
        saddle.factor(|k| self.c.row(kept[k]), &self.mass)?;
        let gamma: Vec<f64> = kept.iter().map(|&i| self.gamma[i]).collect();
        let (mut a, mut of_kept) = (vec![0.0; n], vec![0.0; kept.len()]);
        saddle.solve(&self.force, &gamma, &mut a, &mut of_kept)?;
        // The error of each acceleration is estimated with the sizes of the columns of C.
        let units = linalg::equilibrate(&self.c).cols;
        let units: Vec<f64> = units.into_iter().map(|e| f64::from(e).exp2()).collect();
        let row = |i: usize| self.c.row(i).iter().copied().enumerate();
        agree(&rows, row, &a, &units, [&self.gamma, &self.gamma_terms])?;
        Ok(Solution {
            acceleration: a,
            multipliers: on_all_rows(kept, of_kept, m),
            no_finite: Vec::new(),
        })
    }
}

/// The values of a mechanism at one instant, before a dense matrix is built.
struct Terms {
    s: Scratch,
    gamma_terms: Vec<f64>,
}

impl Terms {
    fn of(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Result<Self, RequestError> {
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
        let lengths: Vec<f64> = mechanism
            .layout()
            .column_kinds()
            .iter()
            .map(length)
            .collect();
        // The largest rate in the mechanism (rad/s); Γ is quadratic in it.
        let rates = v.iter().zip(&lengths).map(|(v, length)| (v / length).abs());
        let rate = rates.fold(0.0, f64::max);
        let reach = |i| layout.row(&s, i).map(|(k, c)| c.abs() * lengths[k]);
        let gamma_terms = (0..layout.rows())
            .map(|i| rate * rate * reach(i).sum::<f64>())
            .collect();
        Ok(Self { s, gamma_terms })
    }
}

/// One solution of the equations of a mechanism of any size at time t, coordinates q and velocities
/// v, which must satisfy the constraints. Uses dense matrices, or sparse ones if dense ones would
/// be too large.
///
/// # Errors
/// As [`Equations::of`] and [`Equations::multipliers`]; with sparse matrices every
/// coordinate needs a mass.
pub fn solution(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    rows: &RowDecision,
) -> Result<Solution, ChoiceError> {
    if mechanism.layout().rows() <= ROWS_MAX {
        return Equations::of(mechanism, t, q, v)?.solution(rows);
    }
    let terms = Terms::of(mechanism, t, q, v)?;
    sparse_solution(mechanism, q, &terms, &terms.s.force, rows)
}

/// The solution with sparse matrices under the given forces, n_v values, instead of those of the
/// mechanism.
pub(crate) fn solution_under(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    force: &[f64],
    rows: &RowDecision,
) -> Result<Solution, ChoiceError> {
    let terms = Terms::of(mechanism, t, q, v)?;
    sparse_solution(mechanism, q, &terms, force, rows)
}

fn sparse_solution(
    mechanism: &Mechanism,
    q: &[f64],
    Terms { s, gamma_terms }: &Terms,
    force: &[f64],
    rows: &RowDecision,
) -> Result<Solution, ChoiceError> {
    let layout = mechanism.layout();
    check_rows(rows, layout.rows())?;
    let units = velocity_units(mechanism, model::start::scene_size(mechanism, q));
    let scaled = |x: &[f64]| -> Vec<f64> { x.iter().zip(&units).map(|(x, u)| x * u).collect() };
    let kept = &rows.kept;
    let c = rows_of(mechanism, s, kept.iter().copied(), |j| units[j]);
    let mut saddle = SchurSaddle::new(SchurStructure::new(&c, &blocks(mechanism)));
    saddle.factor(&c, &scaled(&scaled(mechanism.mass())))?;
    let gamma: Vec<f64> = kept.iter().map(|&i| s.gamma[i]).collect();
    let (mut x, mut of_kept) = (vec![0.0; layout.n_v], vec![0.0; kept.len()]);
    saddle.solve(&c, &scaled(force), &gamma, &mut x, &mut of_kept)?;
    let a = scaled(&x);
    let row = |i: usize| layout.row(s, i);
    agree(rows, row, &a, &units, [&s.gamma, gamma_terms])?;
    Ok(Solution {
        acceleration: a,
        multipliers: on_all_rows(kept, of_kept, layout.rows()),
        no_finite: Vec::new(),
    })
}

/// Checks that the rank is decided and that the decision has this number of rows.
fn check_rows(rows: &RowDecision, m: usize) -> Result<(), ChoiceError> {
    let found = rows.kept.len() + rows.dropped.len();
    if found != m {
        return Err(ChoiceError::Request(RequestError::Length {
            argument: "the rank decision, by rows,",
            found,
            expected: m,
        }));
    }
    match rows.status {
        RankStatus::Undecided(doubt) => Err(ChoiceError::Undecided(doubt)),
        _ => Ok(()),
    }
}

/// Checks that the dropped rows agree with these accelerations. Every acceleration, in these units,
/// is assumed to have the error of the largest one.
fn agree<R: Iterator<Item = (usize, f64)>>(
    rows: &RowDecision,
    row: impl Fn(usize) -> R,
    a: &[f64],
    units: &[f64],
    [gamma, gamma_terms]: [&[f64]; 2],
) -> Result<(), ChoiceError> {
    let largest = a.iter().zip(units).map(|(a, unit)| (a / unit).abs());
    let largest = largest.fold(0.0, f64::max);
    for &i in &rows.dropped {
        let by = (row(i).map(|(j, c)| c * a[j]).sum::<f64>() - gamma[i]).abs();
        let size = row(i).map(|(j, c)| c.abs() * units[j] * largest);
        let allowed = AGREEMENT * (size.sum::<f64>() + gamma[i].abs() + gamma_terms[i]);
        if by.is_nan() || by > allowed {
            return Err(ChoiceError::Contradiction {
                row: i,
                by,
                allowed,
            });
        }
    }
    Ok(())
}

/// Multipliers of the kept rows, with zeros for the dropped rows.
fn on_all_rows(kept: &[usize], of_kept: Vec<f64>, rows: usize) -> Vec<f64> {
    let mut lambda = vec![0.0; rows];
    for (&i, l) in kept.iter().zip(of_kept) {
        lambda[i] = l;
    }
    lambda
}
