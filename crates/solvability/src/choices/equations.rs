//! The equations for the multipliers, and their solution on the kept rows of the rank decision. The
//! multipliers of dropped rows are zero.

use std::sync::Arc;

use crate::limits::{AGREEMENT, ROWS_MAX};
use crate::pose::velocity_units;
use crate::row_decision::RowDecision;
use crate::value::NoFiniteReaction;
use linalg::{AddedMass, KeptRowSaddle, MassMatrix, Matrix, SchurSaddle, SchurStructure};
use model::start::scene_size;
use model::{Level, Mechanism, Scratch, System};
use rank::RankStatus;

use super::{ChoiceError, ChosenValues};
use crate::existence::may_miss;
use crate::groups::{RequestError, check};
use crate::sparse::{blocks, rows_of};

/// The equations `M·a + Cᵀ·λ = Q`, `C·a = Γ` at one instant.
///
/// ```
/// use linalg::{Matrix};
/// use rank::{decide};
/// use pfaff_solvability::{Equations, RowTerms};
/// // Two equal rows hold a unit mass against a force of 3.
/// let c = Matrix::from_rows(&[[1.0], [1.0]]);
/// let equations = Equations {
///     mass: vec![1.0],
///     added: linalg::AddedMass::default(),
///     force: vec![3.0],
///     terms: RowTerms::of_matrix(&c),
///     c,
///     gamma: vec![0.0, 0.0],
/// };
/// let lambda = equations.multipliers(&decide(&equations.c, rank::Accuracy::Rounding)?)?;
/// assert_eq!(lambda.as_chosen().iter().sum::<f64>(), 3.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    /// Diagonal of the mass matrix M without its rows, n_v values.
    pub mass: Vec<f64>,
    /// The rows of the mass matrix M, see [`linalg::MassMatrix`].
    pub added: AddedMass,
    /// Generalised forces Q, n_v values.
    pub force: Vec<f64>,
    /// Constraint matrix C, (m + h) × n_v.
    pub c: Matrix,
    /// Right-hand side Γ of the acceleration constraints, m + h values.
    pub gamma: Vec<f64>,
    /// Sizes of the terms in the sum of each row.
    pub terms: RowTerms,
}

/// Sizes of the terms in the sums of the rows of `C·a = Γ`. A difference that is small relative to
/// these sizes is rounding. See [`model::Scales::terms`].
#[derive(Clone, Debug, PartialEq)]
pub struct RowTerms {
    /// Sizes for the entries of Γ, m + h values. These sizes are zero if Γ is exact.
    pub gamma: Vec<f64>,
    /// Sizes for C·a with accelerations of one unit in any direction, m + h values.
    pub extents: Vec<f64>,
    /// Unit of each acceleration, n_v values.
    pub units: Vec<f64>,
}

impl RowTerms {
    /// Returns the sizes for a matrix whose columns have the same unit, with an exact Γ.
    #[must_use]
    pub fn of_matrix(c: &Matrix) -> Self {
        let extent = |i: usize| c.row(i).iter().map(|x| x.abs()).sum();
        Self {
            gamma: vec![0.0; c.nrows()],
            extents: (0..c.nrows()).map(extent).collect(),
            units: vec![1.0; c.ncols()],
        }
    }

    /// Returns the sizes for a mechanism of this size (m) at velocities v (n_v). C and Γ must have
    /// been evaluated in the scratch at this state.
    #[must_use]
    pub fn of(mechanism: &Mechanism, s: &Scratch, v: &[f64], size: f64) -> Self {
        let scales = mechanism.scales(s);
        let rows = || 0..mechanism.layout().rows();
        let level = Level::accelerations(mechanism, size, v, None);
        let unit = |j: usize| mechanism.space().unit(j, size);
        Self {
            gamma: rows().map(|i| scales.terms(i, &level)).collect(),
            extents: rows().map(|i| scales.extent(i, size)).collect(),
            units: (0..mechanism.layout().n_v).map(unit).collect(),
        }
    }

    /// Returns the size of the terms of row `i` at accelerations up to `largest`.
    fn of_row(&self, i: usize, largest: f64) -> f64 {
        largest * self.extents[i] + self.gamma[i]
    }

    /// Returns the largest of the accelerations a and of the accelerations that the forces alone
    /// would cause, in their units. If the rows fix a body, the computed accelerations of the body
    /// are rounding errors of these values.
    fn largest(&self, a: &[f64], (mass, force): (&[f64], &[f64])) -> f64 {
        let alone = force.iter().zip(mass).map(
            |(force, mass)| {
                if *mass > 0.0 { force / mass } else { 0.0 }
            },
        );
        let all = a.iter().copied().zip(alone).zip(&self.units);
        let shares = all.map(|((a, alone), unit)| a.abs().max(alone.abs()) / unit);
        shares.fold(0.0, f64::max)
    }
}

/// Accelerations, and one solution for the multipliers.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Accelerations a, n_v values.
    pub acceleration: Vec<f64>,
    /// Multipliers λ, zero for the dropped rows. All other solutions are `λ + Z·y`.
    pub multipliers: ChosenValues<f64>,
    /// Reactions that have no finite value in the motion, although their multipliers are finite;
    /// see [`crate::no_finite_reactions`]. The list is empty unless the caller requests it.
    pub no_finite: Vec<Arc<NoFiniteReaction>>,
}

impl Equations {
    /// Returns the equations of a mechanism at time t, coordinates q and velocities v, which must
    /// satisfy the constraints.
    ///
    /// # Errors
    /// [`RequestError::Length`], [`RequestError::NotFinite`]: t, q or v do not fit the mechanism.
    pub fn of(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Result<Self, RequestError> {
        Ok(Self::at(mechanism, (q, v), evaluated(mechanism, t, q, v)?))
    }

    /// Returns the equations at an evaluated state.
    fn at(mechanism: &Mechanism, (q, v): (&[f64], &[f64]), s: Scratch) -> Self {
        Self {
            mass: mechanism.mass().to_vec(),
            added: mechanism.inertia(&s).added().clone(),
            c: mechanism.layout().dense(&s),
            terms: RowTerms::of(mechanism, &s, v, scene_size(mechanism, q)),
            force: s.force,
            gamma: s.gamma,
        }
    }

    /// Computes one λ in which the dropped rows have zeros. All other solutions are `λ + Z·y`.
    ///
    /// # Errors
    /// - [`ChoiceError::Undecided`]: the rank is undecided, so the independent rows are not
    ///   determined.
    /// - [`ChoiceError::Saddle`]: the kept rows and the masses do not determine the accelerations.
    /// - [`ChoiceError::Contradiction`]: the dropped rows require other accelerations, so there is
    ///   no solution.
    /// - [`ChoiceError::Request`]: sizes do not fit.
    pub fn multipliers(
        &self,
        rows: impl Into<RowDecision>,
    ) -> Result<ChosenValues<f64>, ChoiceError> {
        self.solution(rows).map(|solution| solution.multipliers)
    }

    /// Works like [`Equations::multipliers`], and also returns the accelerations.
    ///
    /// # Errors
    /// Returns the same errors as [`Equations::multipliers`].
    pub fn solution(&self, rows: impl Into<RowDecision>) -> Result<Solution, ChoiceError> {
        self.solution_within(&rows.into(), |_, _| 0.0)
    }

    /// Returns the mass matrix M.
    #[must_use]
    pub fn inertia(&self) -> MassMatrix<'_> {
        MassMatrix::new(&self.mass, &self.added)
    }

    fn solved(&self, rows: &RowDecision) -> Result<(Solution, KeptRowSaddle), ChoiceError> {
        let (m, n) = (self.c.nrows(), self.c.ncols());
        check("gamma", &self.gamma, m)?;
        check("terms of gamma", &self.terms.gamma, m)?;
        check("extents", &self.terms.extents, m)?;
        check("units", &self.terms.units, n)?;
        check_rows(rows, m)?;
        let kept = &rows.kept;
        let mut saddle = KeptRowSaddle::new(n, kept.len())?;
        saddle.factor(|k| self.c.row(kept[k]), self.inertia())?;
        let gamma: Vec<f64> = kept.iter().map(|&i| self.gamma[i]).collect();
        let (mut a, mut of_kept) = (vec![0.0; n], vec![0.0; kept.len()]);
        saddle.solve(&self.force, &gamma, &mut a, &mut of_kept)?;
        let solution = Solution {
            acceleration: a,
            multipliers: ChosenValues::new(on_all_rows(kept, of_kept, m), rows.dropped.clone()),
            no_finite: Vec::new(),
        };
        Ok((solution, saddle))
    }

    /// Works like [`Equations::solution`]. For a combination of rows at given accelerations,
    /// `explained` must return the difference that data within a stated tolerance can cause.
    fn solution_within(
        &self,
        rows: &RowDecision,
        explained: impl Fn(&[f64], &[f64]) -> f64,
    ) -> Result<Solution, ChoiceError> {
        let (solution, mut saddle) = self.solved(rows)?;
        let a = &solution.acceleration;
        let row = |i: usize| self.c.row(i).iter().copied().enumerate();
        let masses = self.inertia().full_diagonal();
        let largest = self.terms.largest(a, (&masses, &self.force));
        agree(rows, row, a, (&self.gamma, &self.terms, largest), |i| {
            let z = self.dependency(rows, i, &mut saddle)?;
            let implied = rows
                .kept
                .iter()
                .map(|&k| z[k].abs() * self.terms.of_row(k, largest));
            Ok((implied.sum(), explained(&z, a)))
        })?;
        Ok(solution)
    }

    /// Returns the combination of rows in which the kept rows cancel the dropped row i, m + h
    /// values. Loads in this ratio cause no acceleration.
    fn dependency(
        &self,
        rows: &RowDecision,
        i: usize,
        saddle: &mut KeptRowSaddle,
    ) -> Result<Vec<f64>, ChoiceError> {
        let kept = rows.kept.len();
        let (mut still, mut of_kept) = (vec![0.0; self.c.ncols()], vec![0.0; kept]);
        saddle.solve(self.c.row(i), &vec![0.0; kept], &mut still, &mut of_kept)?;
        let mut z = on_all_rows(&rows.kept, of_kept, self.c.nrows());
        z.iter_mut().for_each(|z| *z = -*z);
        z[i] = 1.0;
        Ok(z)
    }
}

/// Evaluates the terms of the equations of a mechanism at one instant.
fn evaluated(mechanism: &Mechanism, t: f64, q: &[f64], v: &[f64]) -> Result<Scratch, RequestError> {
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
    Ok(s)
}

/// Returns one solution of the equations of a mechanism of any size at time t, coordinates q and
/// velocities v, which must satisfy the constraints. The function uses dense matrices, or sparse
/// matrices if dense matrices would be too large.
///
/// # Errors
/// Returns the same errors as [`Equations::of`] and [`Equations::multipliers`]. With sparse
/// matrices, every coordinate needs a mass.
pub fn solution(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    rows: &RowDecision,
) -> Result<Solution, ChoiceError> {
    let s = evaluated(mechanism, t, q, v)?;
    if mechanism.layout().rows() > ROWS_MAX {
        return sparse_solution(mechanism, (q, v), &s, &s.force, rows);
    }
    let equations = Equations::at(mechanism, (q, v), s.clone());
    let (data, size) = (mechanism.data(), scene_size(mechanism, q));
    equations.solution_within(rows, |z, a| {
        let level = Level::accelerations(mechanism, size, v, Some(a));
        let mut gradient = vec![0.0; data.count()];
        data.explained(&s, &data.blocks(&s), z, &level, &mut gradient)
    })
}

/// Returns the solution with sparse matrices under the given forces (n_v values), which replace the
/// forces of the mechanism.
pub(crate) fn solution_under(
    mechanism: &Mechanism,
    (t, q, v): (f64, &[f64], &[f64]),
    force: &[f64],
    rows: &RowDecision,
) -> Result<Solution, ChoiceError> {
    let s = evaluated(mechanism, t, q, v)?;
    sparse_solution(mechanism, (q, v), &s, force, rows)
}

fn sparse_solution(
    mechanism: &Mechanism,
    (q, v): (&[f64], &[f64]),
    s: &Scratch,
    force: &[f64],
    rows: &RowDecision,
) -> Result<Solution, ChoiceError> {
    let layout = mechanism.layout();
    check_rows(rows, layout.rows())?;
    let size = scene_size(mechanism, q);
    let units = velocity_units(mechanism, size);
    let scaled = |x: &[f64]| -> Vec<f64> { x.iter().zip(&units).map(|(x, u)| x * u).collect() };
    let kept = &rows.kept;
    let c = rows_of(mechanism, s, kept.iter().copied(), |j| units[j]);
    let inertia = mechanism.inertia(s);
    let mut added = inertia.added().clone();
    added.take(inertia.added(), &units);
    let masses = scaled(&scaled(mechanism.mass()));
    let structure = SchurStructure::with_added(&c, &blocks(mechanism), &added);
    let mut saddle = SchurSaddle::new(structure);
    saddle.factor(&c, MassMatrix::new(&masses, &added))?;
    let gamma: Vec<f64> = kept.iter().map(|&i| s.gamma[i]).collect();
    let (mut x, mut of_kept) = (vec![0.0; layout.n_v], vec![0.0; kept.len()]);
    saddle.solve(&c, &scaled(force), &gamma, &mut x, &mut of_kept)?;
    let a = scaled(&x);
    let row = |i: usize| layout.row(s, i);
    if !may_miss(mechanism) {
        let terms = RowTerms::of(mechanism, s, v, size);
        let largest = terms.largest(&a, (&inertia.full_diagonal(), force));
        let of_rows = (&s.gamma[..], &terms, largest);
        agree(rows, row, &a, of_rows, |_| Ok((0.0, 0.0)))?;
    }
    Ok(Solution {
        acceleration: a,
        multipliers: ChosenValues::new(
            on_all_rows(kept, of_kept, layout.rows()),
            rows.dropped.clone(),
        ),
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

/// Checks that the dropped rows agree with these accelerations, each of which has the rounding
/// error of `largest`. `implied` is called if a row differs by more than the rounding of its own
/// terms. The function `implied` must return the terms of the kept rows in this row and the
/// difference that the data can cause.
fn agree<R: Iterator<Item = (usize, f64)>>(
    rows: &RowDecision,
    row: impl Fn(usize) -> R,
    a: &[f64],
    (gamma, terms, largest): (&[f64], &RowTerms, f64),
    mut implied: impl FnMut(usize) -> Result<(f64, f64), ChoiceError>,
) -> Result<(), ChoiceError> {
    let share = AGREEMENT.max(rows.support_tolerance);
    for &i in &rows.dropped {
        let by = (row(i).map(|(j, c)| c * a[j]).sum::<f64>() - gamma[i]).abs();
        let own = terms.of_row(i, largest);
        if by <= share * own {
            continue;
        }
        let (of_kept, explained) = implied(i)?;
        let allowed = share * (own + of_kept) + explained;
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

/// Returns the multipliers of the kept rows, with zeros for the dropped rows.
fn on_all_rows(kept: &[usize], of_kept: Vec<f64>, rows: usize) -> Vec<f64> {
    let mut lambda = vec![0.0; rows];
    for (&i, l) in kept.iter().zip(of_kept) {
        lambda[i] = l;
    }
    lambda
}
