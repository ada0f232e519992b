//! Computes the reactions for given choices at the states of a motion. The equations are solved
//! with the factored rows that the simulation has already computed at each state.
//!
//! The rank is the rank that the simulation uses, as for verdicts along a motion. The left null
//! space is computed from the factored kept rows. The rows are scaled with the factors of the
//! initial state.

use std::borrow::Cow;

use linalg::{Matrix, singular_values};
use model::{ConfigurationAccuracy, Mechanism, RowRanges, Scratch, System};
use rank::KeptRowsError;

use super::free::Choosing;
use super::multipliers::FreeMultipliers;
use super::{Choice, ChoiceError, Label, rows_refused};
use crate::certificate::UncertainRows;
use crate::error::AnalysisError;
use crate::groups::{ReactionForms, RequestError};
use crate::matrices::orthonormal;
use crate::parts::{Extent, open_parts};
use crate::pose::evaluated;

/// A choice with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedChoice {
    /// Name of the choice, printed with the reactions that it gives.
    pub label: Label,
    /// The rule.
    pub choice: Choice,
}

/// Choices among the solutions of a motion, evaluated at successive states.
pub struct CarriedChoices<'m> {
    mechanism: &'m Mechanism,
    parts: Vec<FreePart<'m>>,
    /// Number of choices.
    count: usize,
}

/// Joints on common cycles whose rows depend on each other.
struct FreePart<'m> {
    extent: Extent,
    mechanism: Cow<'m, Mechanism>,
    /// Length that makes C dimensionless (m).
    size: f64,
    /// Factors of rows and columns by which C was equilibrated at the initial state.
    row_factor: Vec<f64>,
    column_factor: Vec<f64>,
    /// The smallest singular value at the start, and the smallest permitted singular value of kept
    /// rows.
    sigma: f64,
    required: f64,
    tolerance: f64,
    /// For each choice, the rules that concern the rows of this part.
    choices: Vec<Choice>,
}

/// A state of the motion with one solution of its equations.
pub struct CarriedSolution<'s> {
    /// Time (s).
    pub t: f64,
    /// Coordinates, which satisfy the constraints.
    pub q: &'s [f64],
    /// Work space that contains C, evaluated at this state.
    pub scratch: &'s Scratch,
    /// Rows (from 0) whose multipliers are zero in the solution.
    pub dropped: &'s [usize],
    /// For each row in `dropped`, the vector z with `Cᵀ·z = 0`. The vector z states how the row
    /// depends on the other rows. z has one element for each row of C; the rows are in SI units.
    pub dependencies: &'s [Vec<f64>],
    /// The multipliers of all rows.
    pub multipliers: &'s [f64],
}

impl<'m> CarriedChoices<'m> {
    /// Prepares the choices for a motion that starts at time t with coordinates q. The multipliers
    /// of the rows `dropped` are zero in the motion.
    ///
    /// # Errors
    /// [`AnalysisError`]: C cannot be analysed at the start.
    pub fn new(
        mechanism: &'m Mechanism,
        (t, q): (f64, &[f64]),
        dropped: &[usize],
        choices: &[Choice],
    ) -> Result<Self, AnalysisError> {
        let open = open_parts(mechanism, (t, q), dropped).into_iter();
        let parts = open.map(|(extent, own, _)| {
            let choices = choices.iter().map(|choice| choice.share(&extent)).collect();
            FreePart::new((extent, own), (t, q), choices)
        });
        Ok(Self {
            mechanism,
            parts: parts.collect::<Result<_, _>>()?,
            count: choices.len(),
        })
    }

    /// Returns the multipliers of all rows for each choice. If a choice does not select a solution
    /// at this state, the function returns an error for it. If the given multipliers of a part are
    /// NaN, the returned multipliers of the part are NaN, too.
    #[must_use]
    pub fn at(&self, at: &CarriedSolution<'_>) -> Vec<Result<Vec<f64>, ChoiceError>> {
        let mut found = vec![Ok(at.multipliers.to_vec()); self.count];
        for part in &self.parts {
            let own = part.extent.of_rows(at.multipliers);
            if own.iter().any(|l| l.is_nan()) {
                continue;
            }
            let solved = part.solve(self.mechanism, at, &own);
            for (whole, own) in found.iter_mut().zip(solved) {
                match (whole.as_mut(), own) {
                    (Ok(whole), Ok(own)) => {
                        for (k, l) in own.into_iter().enumerate() {
                            whole[part.extent.row(k)] = l;
                        }
                    }
                    (Ok(_), Err(error)) => *whole = Err(error),
                    (Err(_), _) => {}
                }
            }
        }
        found
    }
}

impl<'m> FreePart<'m> {
    fn new(
        (extent, mechanism): (Extent, Cow<'m, Mechanism>),
        (t, q): (f64, &[f64]),
        choices: Vec<Choice>,
    ) -> Result<Self, AnalysisError> {
        let q = extent.coordinates(q);
        let rows = UncertainRows::new(&mechanism, t, &q, ConfigurationAccuracy::AsStored)?;
        let (size, decision) = (rows.size(), rows.decide()?);
        drop(rows);
        let scaling = &decision.scaling;
        let dimensions = mechanism.layout().dimension_scaling(size).cols;
        let columns = dimensions.iter().zip(&scaling.cols);
        Ok(Self {
            size,
            row_factor: (0..scaling.rows.len())
                .map(|i| scaling.row_factor(i))
                .collect(),
            column_factor: columns.map(|(a, b)| f64::from(a + b).exp2()).collect(),
            sigma: decision.evidence.sigma_r,
            required: decision.required_of_kept(),
            tolerance: rank::support_tolerance(&decision),
            choices,
            mechanism,
            extent,
        })
    }

    /// Returns the multipliers of the part for each choice.
    fn solve(
        &self,
        whole: &Mechanism,
        at: &CarriedSolution<'_>,
        lambda: &[f64],
    ) -> Vec<Result<Vec<f64>, ChoiceError>> {
        let scratch = match &self.extent {
            Extent::Whole => Cow::Borrowed(at.scratch),
            extent => Cow::Owned(evaluated(&self.mechanism, at.t, &extent.coordinates(at.q))),
        };
        let reactions = ReactionForms::at(&self.mechanism, &scratch, self.size);
        let rows: Vec<usize> = (0..lambda.len()).map(|k| self.extent.row(k)).collect();
        let own = at.dropped.iter().zip(at.dependencies);
        let own = own.filter(|(row, _)| self.extent.own_row(**row).is_some());
        let own: Vec<&[f64]> = own.map(|(_, z)| z.as_slice()).collect();
        let z = orthonormal(&own, &rows, &self.row_factor, own.len());
        let b_x = |rows: &RowRanges| -> Result<Matrix, RequestError> {
            Ok(self.cancelling(&scratch, rows, &z))
        };
        let choosing = Choosing {
            reactions: &reactions,
            free: FreeMultipliers {
                z: Cow::Borrowed(&z),
                row_factor: Cow::Borrowed(&self.row_factor),
                tolerance: self.tolerance,
            },
            b_x: Box::new(b_x),
        };
        let choices = self.choices.iter();
        let solved = choices.map(|choice| match choice {
            Choice::MinimumNorm(weights) => choosing.least_norm(lambda, *weights),
            Choice::Compliance(supports) => choosing.elastic(lambda, supports),
            Choice::Elimination(rows) => {
                self.check_rows(whole, &z, rows)?;
                Ok(choosing.free.eliminated(lambda, rows))
            }
        });
        solved.collect()
    }

    /// Checks that the remaining rows are independent without these rows.
    fn check_rows(&self, whole: &Mechanism, z: &Matrix, rows: &[usize]) -> Result<(), ChoiceError> {
        let p = z.ncols();
        let refused = |source| {
            let of_whole: Vec<usize> = rows.iter().map(|&i| self.extent.row(i)).collect();
            Err(rows_refused(whole.layout(), &of_whole, |_| false, source))
        };
        if rows.len() != p {
            return refused(KeptRowsError::WrongCount {
                dropped: rows.len(),
                kept: z.nrows().saturating_sub(rows.len()),
                rank: z.nrows() - p,
                rows: z.nrows(),
            });
        }
        // Without the rows D, the smallest singular value is at least σ_r times the smallest
        // singular value of Z_D.
        let weakest = singular_values(&z.select_rows(rows)).last().copied();
        let smallest = self.sigma * weakest.unwrap_or(1.0);
        if smallest < self.required {
            return refused(KeptRowsError::Dependent {
                smallest_singular_value: smallest,
                required: self.required,
            });
        }
        Ok(())
    }

    /// Returns `C_Xᵀ·Z_X` of equilibrated rows.
    fn cancelling(&self, s: &Scratch, rows: &RowRanges, z: &Matrix) -> Matrix {
        let layout = self.mechanism.layout();
        let mut b = Matrix::zeros(layout.n_v, z.ncols());
        for i in rows.iter() {
            for (j, c) in layout.row(s, i) {
                let c = c * self.row_factor[i] * self.column_factor[j];
                for (b, z) in b.row_mut(j).iter_mut().zip(z.row(i)) {
                    *b += c * z;
                }
            }
        }
        b
    }
}
