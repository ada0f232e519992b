//! Table of limits: all values in this crate that its authors chose. Each comment states the
//! meaning, the unit, the effects of a value that is too small or too large, and the test that
//! fails then. `none, work only` means that only time or memory would change; `none` means that
//! there is no test yet. The test file `tests/all/limits.rs` reads this table.

// Singular values and scaling.

/// Maximum number of sweeps of an equilibration. Each sweep halves the remaining exponents, and the
/// exponents of `f64` span 2098 < 2¹². Further sweeps change nothing, except for patterns of zeros
/// that prevent a balance. Unit: sweeps. Too small: matrices of extreme entries stay badly scaled.
/// Too large: the scaling takes longer. Test: `row_and_column_maxima_are_near_one`.
pub(crate) const EQUILIBRATION_SWEEPS: usize = 12;

/// Maximum number of sweeps of Jacobi rotations over all pairs of columns or rows. Convergence is
/// quadratic, and four to six sweeps are usual. Unit: sweeps. Too small: singular values are not
/// accurate. Too large: matrices with an entry that is not a number take longer. Test:
/// `zeros_on_the_diagonal_cut_the_matrix`.
pub(crate) const JACOBI_SWEEPS: usize = 40;

/// Columns are orthogonal if the cosine of their angle is below this limit of a few rounding
/// errors. Unit: 1. Too small: rotations by rounding take time. Too large: singular values lose
/// digits. Test: `nearly_orthogonal_columns_are_turned_too`.
pub(crate) const ORTHOGONAL: f64 = 4.0 * f64::EPSILON;

/// Squared rows below this limit, relative to a largest entry of one, count as zero. The limit
/// prevents an underflow of the product of two squared rows. Unit: 1. Too small: products
/// underflow. Too large: small singular values become zero. Test:
/// `rotations_keep_the_digits_of_rows_whose_squares_are_tiny`.
pub(crate) const ZERO_SQUARED: f64 = 1e-150;

/// Maximum number of steps of the implicit QR algorithm for each singular value; two or three are
/// needed. Unit: steps. Too small: Jacobi rotations replace the algorithm, which takes longer. Too
/// large: matrices with an entry that is not a number take longer. Test: none, work only.
pub(crate) const QR_STEPS_EACH: usize = 60;

/// Maximum number of sweeps over rows and columns that balance a matrix before its eigenvalues are
/// computed; three to five are usual. Unit: sweeps. Too small: units of states cost digits. Too
/// large: the computation takes longer. Test: `units_do_not_matter`.
pub(crate) const BALANCINGS: usize = 20;

/// Maximum number of steps of the QR algorithm for one eigenvalue or a pair; two to four are usual.
/// Unit: steps. Too small: matrices are rejected. Too large: matrices without convergence take
/// longer. Test: `matrices_of_every_kind_have_small_residuals`.
pub(crate) const FRANCIS_STEPS: usize = 120;

/// Number of steps without a new eigenvalue after which exceptional shifts replace the usual
/// shifts. Unit: steps. Too small: convergence is disturbed. Too large: permutations take longer.
/// Test: `matrices_of_every_kind_have_small_residuals`.
pub(crate) const EXCEPTIONAL_EVERY: usize = 10;

/// Entries of an eigenvector above this limit are scaled down during the computation. Unit: 1. Too
/// small: the computation takes longer. Too large: entries overflow. Test:
/// `matrices_of_every_kind_have_small_residuals`.
pub(crate) const SUBSTITUTED: f64 = 1e100;

/// A row and its column are balanced if balancing reduces their sum to less than this share. Unit:
/// share. Too small: units of states cost digits. Too large: sweeps have no effect. Test:
/// `units_do_not_matter`.
pub(crate) const BALANCED: f64 = 0.95;

#[cfg(feature = "faer")]
/// Smaller dimension of a matrix above which faer computes singular values. Our own kernel is
/// faster up to about 200. Our own kernel takes 1.4 times as long at 400 and 1.5 times as long at
/// 600 (measured by `cargo run --release -p bench --features faer --example timings`). Our own
/// kernel computes the same bits on every processor; faer does not, because it chooses instructions
/// at run time. Unit: rows or columns. Too small: the last bits differ between processors. Too
/// large: the computation takes longer. Test: none, work only.
pub(crate) const FAER_FROM: usize = 256;

/// An updated norm is recomputed if cancellation has removed half of its digits: √eps. Unit: share
/// of the norm. Too small: the longest column is not found. Too large: the factorisation takes
/// longer. Test: `graded_columns_downdate_safely`.
pub(crate) const DOWNDATE_LIMIT: f64 = 1.490_116_119_384_765_6e-8;

/// Squares of entries above this limit do not lose digits in sums. Unit: 1. Too small: norms of
/// small vectors underflow. Too large: the computation takes longer. Test:
/// `norm_survives_the_ends_of_the_range`.
pub(crate) const SQUARE_MIN: f64 = 1e-140;

// Equations with independent rows, solved in the null space of the rows.

/// Masses count as graded above this spread, see [`mass_spread`](crate::mass_spread). Below it,
/// plain solutions keep about ten digits, and normally twelve. Unit: ratio of the heaviest to the
/// lightest mass. Too small: refinement takes time. Too large: digits are lost. Test:
/// `refinement_is_wanted_where_digits_are_lost`.
pub const GRADED_MASSES: f64 = 1e6;

/// If some masses are zero, the other masses count as graded above this spread. In NᵀMN, a massless
/// coordinate has no mass that would limit the effect of cancellation. Below this spread, the
/// choice of pivots by mass would only make the pivots smaller. Unit: ratio of the heaviest mass to
/// the lightest mass that is not zero. Too small: pivots are smaller. Too large: digits are lost.
/// Test: `masses_are_graded_from_their_spread_on`.
pub(crate) const GRADED_BESIDE_MASSLESS: f64 = 1e3;

/// If elimination reduces a mass to less than this share, the result loses the corresponding number
/// of digits. Unit: share of the mass. Too small: digits are lost. Too large: refinement takes
/// time. Test: `refinement_is_wanted_where_digits_are_lost`.
pub(crate) const CANCELLED: f64 = 1e-3;

/// A pivot below this share of its row is rounding noise at any configuration. Unit: share of the
/// largest entry of the row. Too small: the elimination divides by noise. Too large: rows near a
/// singular configuration are lost. Test: `a_pivot_of_a_few_roundings_is_no_pivot`.
pub(crate) const PIVOT_FLOOR: f64 = 16.0 * f64::EPSILON;

/// For graded masses, the pivot is chosen from the entries that are above this share of the largest
/// entry. The multipliers of the elimination stay below the inverse of this share. Unit: share of
/// the largest entry. Too small: the elimination amplifies errors. Too large: heavy coordinates
/// become pivots. Test: `graded_masses_choose_among_the_large_entries`.
pub(crate) const CANDIDATE: f64 = 0.1;

/// After the elimination of a row, the work for the other rows in one of its coordinates is
/// computed again if at most this many rows remain in this coordinate. If more rows remain, the
/// work for each of these rows hardly changes. Unit: rows. Too small: the row with the least work
/// is not found. Too large: the ordering takes longer. Test: none, work only.
pub(crate) const REVISED: usize = 4;

/// The order of elimination is planned for entries above this share of the largest entry of a row,
/// so that most of these entries are still large enough after the mechanism has moved. Unit: share
/// of the largest entry. Too small: the plan soon becomes invalid. Too large: the factors have more
/// entries. Test: none, work only.
pub(crate) const PIVOT_PLANNED: f64 = 0.5;

/// The pivot of a row is an entry above this share of the largest entry of the row. The pivot is in
/// the coordinate in which the fewest later rows have entries. The multipliers of the elimination
/// stay below the inverse of this share. Unit: share of the largest entry. Too small: the
/// elimination amplifies errors. Too large: the factors have more entries. Test:
/// `a_row_is_solved_for_what_few_later_rows_have_entries_in`.
pub(crate) const PIVOT_CHOSEN: f64 = 0.1;

/// A row keeps the pivot coordinate of the previous factorisation as long as its entry is above
/// this share of the largest entry. The multipliers of the elimination stay below the inverse of
/// this share. Unit: share of the largest entry. Too small: the elimination amplifies errors. Too
/// large: coordinates and the positions of all entries are searched repeatedly. Test:
/// `a_row_is_solved_for_the_same_entry_while_that_is_large`.
pub(crate) const PIVOT_REPEATED: f64 = 0.05;

/// The share that replaces [`PIVOT_REPEATED`] if a smaller entry has no advantage: for dense rows,
/// for given coordinates, and, in terms of c/√m, for graded masses. Unit: share of the best entry.
/// Too small: digits are lost. Too large: coordinates and the positions of all entries are searched
/// repeatedly. Test: `a_row_is_solved_for_the_same_entry_while_that_is_nearly_the_largest`.
pub(crate) const LARGEST_REPEATED: f64 = 0.8;

/// Number of entries of L and of U for which storage is initially reserved. Larger factors allocate
/// more storage on demand. Unit: entries. Too small: the first factorisations allocate memory. Too
/// large: more memory is used. Test: none, work only.
pub(crate) const RESERVED: usize = 1 << 14;

/// Number of vectors of all coordinates that a null-space solver stores. Unit: vectors. Too small:
/// the estimate of memory is too small. Too large: feasible runs are rejected. Test: none, work
/// only.
pub(crate) const VECTORS: usize = 20;

/// Maximum number of rounds of refinement. More rounds are needed only if the equations are
/// singular. Unit: rounds. Too small: solutions that converge slowly are rejected. Too large: the
/// rejection takes longer. Test: `rounds_that_do_not_converge_are_named`.
pub(crate) const REFINEMENT_ROUNDS: usize = 8;

/// The iteration ends if the expected relative change of the next round of refinement is below this
/// limit. Below the rounding of an `f64`, a further round has no effect. Unit: share of each
/// unknown. Too small: additional rounds have no effect. Too large: the last bit is wrong. Test:
/// `whole_numbers_come_back_exactly`.
pub(crate) const SETTLED: f64 = 0.0625 * f64::EPSILON;

/// Two successive changes below this share of the largest unknown of their kind, or of the largest
/// term that balances others, are rounding of double-double numbers: 2⁻⁹⁶. Unit: share of the
/// largest unknown or term. Too small: unknowns that are zero delay the other unknowns. Too large:
/// small unknowns are not refined. Test: `balanced_forces_are_settled`.
pub(crate) const REFINEMENT_NOISE: f64 = 1.262_177_448_353_619e-29;

// Equations with independent rows, solved through the Schur complement of the masses.

/// If the independent share of a row in the metric of the inverse masses is below this limit, the
/// row is rounding noise. The reason is that the Schur complement contains the square of this
/// share. Unit: share of the row. Too small: the elimination divides by noise. Too large: rows near
/// a singular configuration are lost. Test: `a_row_of_which_little_is_left_is_lost`.
pub(crate) const SCHUR_NOISE: f64 = 1e-7;

/// A row with a larger independent share counts as fully independent. Pivots are compared with this
/// share, or with their initial share if that is smaller. Unit: share of the row in the metric of
/// the inverse masses. Too small: pivots of rows that decrease to zero are hidden by pivots that
/// are always small. Too large: the simulation steps over singular configurations from a larger
/// distance than needed, with less accuracy. Test: `what_is_left_of_a_row_is_compared_with_itself`.
pub(crate) const SCHUR_WHOLE: f64 = 0.4;

/// Rows with a larger residual are corrected. Unit: share of the terms of the row. Too small:
/// rounding errors are corrected. Too large: digits are lost. Test:
/// `random_mechanisms_move_as_with_the_dense_solver`.
pub(crate) const SCHUR_ENOUGH: f64 = 1e-14;

/// The residual of a row after a correction is rounding if it is at most this share of all summed
/// terms, including multipliers that balance each other. Unit: share of all terms of the row. Too
/// small: rounding errors are corrected. Too large: digits are lost. Test:
/// `a_correction_leaves_rounding_of_all_terms`.
pub(crate) const SCHUR_ROUNDING: f64 = f64::EPSILON;

/// If a row has a larger residual after all corrections, the solution is rejected. Unit: share of
/// the terms of the row. Too small: good solutions are rejected. Too large: inaccurate solutions
/// are returned. Test: `what_corrections_leave_is_refused_from_a_billionth_on`.
pub(crate) const SCHUR_POOR: f64 = 1e-9;

/// Maximum number of corrections. Unit: corrections. Too small: badly conditioned rows are
/// rejected. Too large: the solution takes longer. Test:
/// `corrections_go_on_while_they_halve_what_is_left`.
pub(crate) const SCHUR_CORRECTIONS: usize = 4;

/// A correction must reduce the residual to less than this share; otherwise the iteration ends.
/// Unit: share of the previous residual. Too small: slow corrections are abandoned. Too large: the
/// solution takes longer. Test: `corrections_go_on_while_they_halve_what_is_left`.
pub(crate) const SCHUR_PROGRESS: f64 = 0.5;
