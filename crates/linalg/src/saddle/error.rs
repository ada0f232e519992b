//! Why saddle equations are not solved, and the checks of their arguments.

use crate::kernels::all_finite;

/// Why the saddle equations have no (unique) solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SaddleError {
    /// More rows than coordinates cannot be independent.
    #[error("{r} independent rows in {n} coordinates are impossible: keep at most {n}")]
    TooManyRows {
        /// Coordinates.
        n: usize,
        /// Rows.
        r: usize,
    },
    /// An argument has the wrong length.
    #[error("{argument} has {found} entries, need {expected}")]
    Length {
        /// Name of the argument.
        argument: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// A column that there is not.
    #[error("row {row} has an entry in column {column}, need columns below {n}")]
    Column {
        /// Number of the row.
        row: usize,
        /// The column.
        column: usize,
        /// Coordinates.
        n: usize,
    },
    /// Coordinates that cannot be solved for.
    #[error("coordinate {coordinate} cannot be solved for: need different coordinates below {n}")]
    Partition {
        /// The coordinate.
        coordinate: usize,
        /// Coordinates.
        n: usize,
    },
    /// A NaN or infinite entry.
    #[error("{argument} contains the value {value} at {index}, need finite numbers")]
    NonFinite {
        /// Name of the argument.
        argument: &'static str,
        /// Entry; for the rows of C the index in row-major order.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A negative mass.
    #[error("mass {index} is {value:.3e}, need a number that is not negative")]
    NegativeMass {
        /// Coordinate.
        index: usize,
        /// Its mass.
        value: f64,
    },
    /// A coordinate without mass, where every one needs some.
    #[error(
        "mass {index} is {value:.3e}: the solver of large mechanisms needs mass and inertia for every coordinate; give it some"
    )]
    ZeroMass {
        /// Coordinate.
        index: usize,
        /// Its mass.
        value: f64,
    },
    /// What only the dense solver can do.
    #[error(
        "{rows} rows are solved sparsely, without independent coordinates: take an explicit method on kept rows, with projection"
    )]
    Large {
        /// Rows.
        rows: usize,
    },
    /// A kept row depends on the rows before it.
    #[error(
        "kept row {row} depends on the rows before it: pivot {pivot:.3e} in a row of size \
         {scale:.3e}; the configuration is singular or the kept rows were chosen elsewhere"
    )]
    RankLost {
        /// Number of the kept row.
        row: usize,
        /// Largest entry left of it.
        pivot: f64,
        /// Largest entry of it before elimination.
        scale: f64,
    },
    /// A motion that the constraints allow moves no mass.
    #[error(
        "the mass is not positive definite on the allowed motions: reduced mass {reduced:.3e} of \
         {size:.3e}; give mass or inertia to what moves along the massless motion {motion:?}"
    )]
    MasslessMotion {
        /// What is left of the reduced mass.
        reduced: f64,
        /// The size that it must be compared with.
        size: f64,
        /// The motion, largest entry 1.
        motion: Vec<f64>,
    },
    /// Refinement does not converge: the equations are singular to working precision.
    #[error(
        "refinement of the solution does not converge: after {rounds} rounds it still changes by the share {change:.3e}; \
         the equations are singular to working precision"
    )]
    Unrefined {
        /// Rounds made.
        rounds: usize,
        /// Largest change of the last one, relative to the size of what changed.
        change: f64,
    },
    /// `solve` without a successful `factor`.
    #[error("nothing is factored: call `factor` and handle its error before `solve`")]
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
