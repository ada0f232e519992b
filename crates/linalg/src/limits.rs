//! The table of limits: every number of this crate that somebody chose. Each says what it is, in
//! which unit, what breaks if it is wrong (`Less`: if it were smaller, `More`: if it were larger),
//! and which test fails then; `none, work only` if only time or memory change, `none` if there is
//! no test yet. `tests/all/limits.rs` reads it.

// Singular values and scaling.

/// Sweeps of an equilibration at most. Each one halves the exponents still to be balanced, and the
/// exponents of `f64` span 2098 < 2¹², so more change nothing unless the pattern fights back.
/// Unit: sweeps. Less: matrices of extreme entries stay badly scaled. More: time. Test:
/// `row_and_column_maxima_are_near_one`.
pub(crate) const EQUILIBRATION_SWEEPS: usize = 12;

/// Sweeps of Jacobi rotations over all pairs of columns or rows at most; convergence is quadratic,
/// four to six are usual.
/// Unit: sweeps. Less: singular values are not accurate. More: time, where something is not a
/// number. Test: `zeros_on_the_diagonal_cut_the_matrix`.
pub(crate) const JACOBI_SWEEPS: usize = 40;

/// Columns are orthogonal if the cosine between them is below this: a few roundings.
/// Unit: 1. Less: time, for rotations by rounding. More: singular values lose digits. Test:
/// `nearly_orthogonal_columns_are_turned_too`.
pub(crate) const ORTHOGONAL: f64 = 4.0 * f64::EPSILON;

/// Squared rows below this, relative to a largest entry of one, are zero for every purpose; keeps
/// the products of two of them clear of underflow.
/// Unit: 1. Less: products underflow. More: small singular values become zero. Test:
/// `rotations_keep_the_digits_of_rows_whose_squares_are_tiny`.
pub(crate) const ZERO_SQUARED: f64 = 1e-150;

/// Steps of the implicit QR algorithm for each singular value at most; two or three are needed.
/// Unit: steps. Less: Jacobi rotations take over, which take longer. More: time, where something is
/// not a number. Test: none, work only.
pub(crate) const QR_STEPS_EACH: usize = 60;

/// Sweeps over rows and columns of a matrix before its eigenvalues at most; three to five are
/// usual.
/// Unit: sweeps. Less: units of states cost digits. More: time. Test: `units_do_not_matter`.
pub(crate) const BALANCINGS: usize = 20;

/// Steps of the QR algorithm for one eigenvalue or a pair at most; two to four are usual.
/// Unit: steps. Less: matrices are refused. More: time, where something does not converge. Test:
/// `matrices_of_every_kind_have_small_residuals`.
pub(crate) const FRANCIS_STEPS: usize = 120;

/// Every so many steps without an eigenvalue, shifts are others than the best ones.
/// Unit: steps. Less: convergence is disturbed. More: permutations take longer. Test:
/// `matrices_of_every_kind_have_small_residuals`.
pub(crate) const EXCEPTIONAL_EVERY: usize = 10;

/// Entries of an eigenvector above this are scaled down while it is made.
/// Unit: 1. Less: work. More: overflow. Test: `matrices_of_every_kind_have_small_residuals`.
pub(crate) const SUBSTITUTED: f64 = 1e100;

/// A row and its column are balanced if their sum then is below this share.
/// Unit: share. Less: units of states cost digits. More: sweeps for nothing. Test:
/// `units_do_not_matter`.
pub(crate) const BALANCED: f64 = 0.95;

#[cfg(feature = "faer")]
/// Smaller dimension from which faer finds singular values: up to about 200 our own kernel is
/// faster, at 400 it takes 1.4 times as long, at 600 1.5 times (measured by
/// `cargo run --release -p bench --features faer --example timings`). Our own gives the same
/// bits on every processor, which faer's run-time choice of instructions does not.
/// Unit: rows or columns. Less: the last bits differ between processors. More: time. Test: none,
/// work only.
pub(crate) const FAER_FROM: usize = 256;

/// A downdated norm is recomputed once cancellation has eaten half of its digits: √eps.
/// Unit: share of the norm. Less: the longest column is not found. More: time. Test:
/// `graded_columns_downdate_safely`.
pub(crate) const DOWNDATE_LIMIT: f64 = 1.490_116_119_384_765_6e-8;

/// Squares of numbers above this do not lose digits in sums.
/// Unit: 1. Less: norms of small vectors underflow. More: time. Test:
/// `norm_survives_the_ends_of_the_range`.
pub(crate) const SQUARE_MIN: f64 = 1e-140;

// Kept rows, solved in their null space.

/// Masses are graded from this spread on, see [`mass_spread`](crate::mass_spread): below it plain
/// solutions keep about ten digits, and normally twelve.
/// Unit: heaviest by lightest mass. Less: time of refinement. More: digits are lost. Test:
/// `refinement_is_wanted_where_digits_are_lost`.
pub const GRADED_MASSES: f64 = 1e6;

/// If some masses are zero, the others are graded from this spread on: nothing of a massless
/// coordinate's own is left in NᵀMN to stand against what cancels there. Below it pivots by mass
/// would only be smaller.
/// Unit: heaviest by lightest mass that is not zero. Less: smaller pivots. More: digits are lost.
/// Test: `masses_are_graded_from_their_spread_on`.
pub(crate) const GRADED_BESIDE_MASSLESS: f64 = 1e3;

/// If elimination leaves less than this share of a reduced mass, so many digits are gone.
/// Unit: share of the mass. Less: digits are lost. More: time of refinement. Test:
/// `refinement_is_wanted_where_digits_are_lost`.
pub(crate) const CANCELLED: f64 = 1e-3;

/// A pivot below this share of its row is rounding noise, whatever the configuration.
/// Unit: share of the largest entry of the row. Less: noise is divided by. More: rows near a
/// singular configuration are lost. Test: `a_pivot_of_a_few_roundings_is_no_pivot`.
pub(crate) const PIVOT_FLOOR: f64 = 16.0 * f64::EPSILON;

/// Graded masses choose among the entries above this share of the largest one: multipliers of the
/// elimination stay below its inverse.
/// Unit: share of the largest entry. Less: elimination grows. More: heavy coordinates are solved
/// for. Test: `graded_masses_choose_among_the_large_entries`.
pub(crate) const CANDIDATE: f64 = 0.1;

/// When a row has been eliminated, rows in its coordinates are looked at again if so many are left
/// there: few others have become much less work.
/// Unit: rows. Less: other rows would have been less work. More: time of the order. Test: none,
/// work only.
pub(crate) const REVISED: usize = 4;

/// The order of elimination is planned for entries above this share of the largest one of a row, so
/// that most are still large enough when the mechanism has moved on.
/// Unit: share of the largest entry. Less: the plan soon does not hold. More: factors fill. Test:
/// none, work only.
pub(crate) const PIVOT_PLANNED: f64 = 0.5;

/// A row is solved for one of its entries above this share of the largest one, in a coordinate in
/// which few later rows have entries: multipliers of the elimination stay below its inverse.
/// Unit: share of the largest entry. Less: elimination grows. More: factors fill. Test:
/// `a_row_is_solved_for_what_few_later_rows_have_entries_in`.
pub(crate) const PIVOT_CHOSEN: f64 = 0.1;

/// A row is solved for the same coordinate as in the factorisation before as long as its entry is
/// above this share of the largest one: multipliers of the elimination stay below its inverse.
/// Unit: share of the largest entry. Less: elimination grows. More: coordinates and the places of
/// all entries are searched for again and again. Test:
/// `a_row_is_solved_for_the_same_entry_while_that_is_large`.
pub(crate) const PIVOT_REPEATED: f64 = 0.05;

/// The same where nothing is gained by a smaller entry: where rows are dense, where coordinates are
/// given, and, by c/√m, where masses are graded.
/// Unit: share of the best entry. Less: digits are lost. More: coordinates and the places of all
/// entries are searched for again and again. Test:
/// `a_row_is_solved_for_the_same_entry_while_that_is_nearly_the_largest`.
pub(crate) const LARGEST_REPEATED: f64 = 0.8;

/// Entries of L and of U for which storage is reserved at once; larger factors ask for it when
/// they find them.
/// Unit: entries. Less: allocations in the first factorisations. More: memory. Test: none, work
/// only.
pub(crate) const RESERVED: usize = 1 << 14;

/// Vectors of all coordinates that a solver in the null space holds.
/// Unit: vectors. Less: the estimate of memory is too small. More: runs are refused that fit. Test:
/// none, work only.
pub(crate) const VECTORS: usize = 20;

/// Rounds of refinement at most; more than these only happen if the equations are singular.
/// Unit: rounds. Less: solutions that converge slowly are refused. More: time before the refusal.
/// Test: `rounds_that_do_not_converge_are_named`.
pub(crate) const REFINEMENT_ROUNDS: usize = 8;

/// What the next round of refinement would change, as a share: below the rounding of an `f64` there
/// is nothing to gain.
/// Unit: share of each unknown. Less: rounds without gain. More: the last bit is wrong. Test:
/// `whole_numbers_come_back_exactly`.
pub(crate) const SETTLED: f64 = 0.0625 * f64::EPSILON;

/// Changes this much smaller than the largest unknown of their kind, twice running, are rounding of
/// double-double numbers: 2⁻⁹⁶.
/// Unit: share of the largest unknown. Less: unknowns that are zero keep others waiting. More:
/// small unknowns are not refined. Test: none.
pub(crate) const REFINEMENT_NOISE: f64 = 1.262_177_448_353_619e-29;

// Kept rows, solved through the Schur complement of the masses.

/// A row of which less than this share is left, in the metric of the inverse masses, is rounding
/// noise: the Schur complement has the square of it.
/// Unit: share of the row. Less: noise is divided by. More: rows near a singular configuration are
/// lost. Test: `a_row_of_which_little_is_left_is_lost`.
pub(crate) const SCHUR_NOISE: f64 = 1e-7;

/// A row of which more than this remains is as independent as a row can be: pivots are compared
/// with this, or with what remained at first if that is less.
/// Unit: share of the row in the metric of the inverse masses. Less: pivots of rows that fall to
/// nothing hide behind those that are always small. More: singular configurations are passed from
/// farther away than needed, with less accuracy. Test:
/// `what_is_left_of_a_row_is_compared_with_itself`.
pub(crate) const SCHUR_WHOLE: f64 = 0.4;

/// Rows that miss by more than this are corrected.
/// Unit: share of the terms of the row. Less: corrections of rounding. More: digits are lost. Test:
/// `random_mechanisms_move_as_with_the_dense_solver`.
pub(crate) const SCHUR_ENOUGH: f64 = 1e-14;

/// What a correction leaves of a row is rounding if it is at most this share of all terms that were
/// added, multipliers that balance each other included.
/// Unit: share of all terms of the row. Less: corrections of rounding. More: digits are lost. Test:
/// `a_correction_leaves_rounding_of_all_terms`.
pub(crate) const SCHUR_ROUNDING: f64 = f64::EPSILON;

/// Rows that miss by more than this after all corrections are not solved.
/// Unit: share of the terms of the row. Less: good solutions are refused. More: poor ones are
/// given. Test: `what_corrections_leave_is_refused_from_a_billionth_on`.
pub(crate) const SCHUR_POOR: f64 = 1e-9;

/// Corrections at most.
/// Unit: corrections. Less: badly conditioned rows are refused. More: time. Test:
/// `corrections_go_on_while_they_halve_what_is_left`.
pub(crate) const SCHUR_CORRECTIONS: usize = 4;

/// A correction has to leave less than this, or it is of no use.
/// Unit: share of the miss before. Less: slow corrections are given up. More: time. Test:
/// `corrections_go_on_while_they_halve_what_is_left`.
pub(crate) const SCHUR_PROGRESS: f64 = 0.5;
