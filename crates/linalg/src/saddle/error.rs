//! Errors of the solvers of saddle-point equations, and checks of the arguments of these solvers.

use crate::AddedMass;
use crate::kernels::all_finite;

/// Error of a solver of saddle-point equations.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SaddleError {
    /// There are more rows than coordinates, so they cannot be independent.
    #[error("{r} independent rows in {n} coordinates are impossible: keep at most {n}")]
    TooManyRows {
        /// Number of coordinates.
        n: usize,
        /// Number of rows.
        r: usize,
    },
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, need {expected}")]
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// Length of the argument.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// The column of an entry does not exist.
    #[error("row {row} has an entry in column {column}, need columns below {n}")]
    Column {
        /// Index of the row.
        row: usize,
        /// The column.
        column: usize,
        /// Number of coordinates.
        n: usize,
    },
    /// The given coordinates cannot be used as pivots.
    #[error("coordinate {coordinate} cannot be solved for: need different coordinates below {n}")]
    Partition {
        /// The coordinate.
        coordinate: usize,
        /// Number of coordinates.
        n: usize,
    },
    /// An entry is NaN or infinite.
    #[error("{argument} contains the value {value} at {index}, need finite numbers")]
    NonFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Index of the entry; for the rows of C in row-major order.
        index: usize,
        /// Value of the entry.
        value: f64,
    },
    /// A mass is negative.
    #[error("mass {index} is {value:.3e}, need a number that is not negative")]
    NegativeMass {
        /// Index of the coordinate.
        index: usize,
        /// The negative mass.
        value: f64,
    },
    /// A coordinate has no mass, but the solver needs a positive mass for every coordinate.
    #[error(
        "mass {index} is {value:.3e}: the solver of large mechanisms needs mass and inertia for every coordinate; give it some"
    )]
    ZeroMass {
        /// Index of the coordinate.
        index: usize,
        /// Mass of the coordinate.
        value: f64,
    },
    /// Only the null-space solver supports this operation.
    #[error(
        "{rows} rows with so many free motions are solved only through the Schur complement, without independent coordinates: use an explicit method on kept rows, with projection"
    )]
    Large {
        /// Number of rows.
        rows: usize,
    },
    /// The number of free motions exceeds the limit for a solver that treats them separately.
    #[error("{free} free motions are more than the dense solver supports")]
    ManyFree {
        /// Number of free motions.
        free: usize,
    },
    /// A row depends on the previous rows.
    #[error(
        "kept row {row} depends on the rows before it: pivot {pivot:.3e} in a row of size \
         {scale:.3e}; the configuration is singular or the kept rows were chosen elsewhere"
    )]
    RankLost {
        /// Index of the row in C.
        row: usize,
        /// Largest remaining entry of the row.
        pivot: f64,
        /// Largest entry of the row before elimination.
        scale: f64,
    },
    /// The constraints allow a motion without mass.
    #[error(
        "the mass is not positive definite on the allowed motions: reduced mass {reduced:.3e} of \
         {size:.3e}; give mass or inertia to the bodies that move along the massless motion {motion:?}"
    )]
    MasslessMotion {
        /// The remaining reduced mass.
        reduced: f64,
        /// The reference size for the reduced mass.
        size: f64,
        /// The motion, scaled so that its largest entry is 1.
        motion: Vec<f64>,
    },
    /// Refinement does not converge: the equations are singular to working precision.
    #[error(
        "refinement of the solution does not converge: after {rounds} rounds it still changes by the share {change:.3e}; \
         the equations are singular to working precision"
    )]
    Unrefined {
        /// Number of rounds.
        rounds: usize,
        /// Largest change in the last round, relative to the size of the changed quantity.
        change: f64,
    },
    /// The caller used `solve` without a successful `factor`.
    #[error("no matrix is factored: call `factor` and handle its error before `solve`")]
    NotFactored,
}

pub(crate) fn check_length<T>(
    argument: &'static str,
    x: &[T],
    expected: usize,
) -> Result<(), SaddleError> {
    if x.len() == expected {
        Ok(())
    } else {
        Err(SaddleError::Length {
            argument,
            found: x.len(),
            expected,
        })
    }
}

/// Checks that the rows of a mass matrix are finite, and that they have no other columns than n.
pub(crate) fn check_added(added: &AddedMass, n: usize) -> Result<(), SaddleError> {
    if let Some((index, value)) = added.wrong() {
        return Err(if value.is_finite() {
            SaddleError::NegativeMass { index, value }
        } else {
            SaddleError::NonFinite {
                argument: "added mass",
                index,
                value,
            }
        });
    }
    let found = added.n_columns();
    if found > n {
        return Err(SaddleError::Length {
            argument: "row of the mass matrix",
            found,
            expected: n,
        });
    }
    Ok(())
}

/// `first` is the index of `x[0]` in the argument.
pub(crate) fn check_finite(
    argument: &'static str,
    x: &[f64],
    first: usize,
) -> Result<(), SaddleError> {
    if all_finite(x) {
        return Ok(());
    }
    match x.iter().position(|a| !a.is_finite()) {
        Some(i) => Err(SaddleError::NonFinite {
            argument,
            index: first + i,
            value: x[i],
        }),
        None => Ok(()),
    }
}
