//! Table of limits: all values in this crate that its authors chose. Each comment states the
//! meaning, the unit, the effects of a value that is too small or too large, and the test that
//! fails then. `none, work only` means that only time or memory would change; `none` means that
//! there is no test yet. The test file `tests/all/limits.rs` reads this table.

// Dense ranks.

/// Factor between the noise estimate and the tolerance τ. The noise estimates are the rounding of
/// an equilibrated matrix and the residual of the refined configuration. In measurements, each
/// estimate differed by at most a factor of 4 from the singular value that it causes. Unit: 1. Too
/// small: a rounding error counts as rank. Too large: exact redundancy hides small singular values.
/// Test: `a_singular_value_clears_the_data_by_four`.
pub const NOISE_FACTOR: f64 = 10.0;

/// The smallest non-zero singular value must exceed τ by this factor. Otherwise the rank is
/// undecided. Unit: multiples of the tolerance. Too small: noise makes rows look independent. Too
/// large: ranks near singular configurations are undecided. Test:
/// `a_number_counts_a_thousand_times_above_its_noise`.
pub(crate) const CLEARANCE: f64 = 1e3;

/// If the accuracy of the data is worse than this share of a row, the data do not determine the
/// row. A redundancy that depends on such data does not count. Unit: share of a row of norm one.
/// Too small: exact redundancy within coarse data is undecided. Too large: rows without reliable
/// data count as redundant. Test: `coarse_data_hide_what_is_no_rounding`.
pub const HIDDEN: f64 = 0.01;

/// A singular value above the square root of eps in a matrix of norm one is not rounding of the
/// entries. Unit: singular value of a matrix of norm one. Too small: the rounding error of the
/// configuration counts as rank. Too large: a misalignment in the drawing counts as rounding. Test:
/// `coarse_data_hide_what_is_no_rounding`.
pub const NOT_ROUNDING: f64 = 1.5e-8;

/// The accuracy of a configuration near a singular configuration is about √eps, for any residual,
/// because Newton's method stops there as at a double root. A smallest singular value below this
/// limit may be zero at the true configuration. Unit: singular value of a matrix of norm one. Too
/// small: singular configurations count as regular. Too large: configurations near singular
/// configurations are undecided. Test: `a_singular_value_between_is_undecided`.
pub const NEARLY_SINGULAR: f64 = 1e-7;

/// Below this smallest singular value, the decided rank is valid, but the reactions that it
/// determines are large. The size of these reactions is 1/σ_r for each unit of load. Data with an
/// accuracy of only σ_r change these reactions by 100 %. Unit: singular value of a matrix of norm
/// one. Too small: large reactions are not marked. Too large: sound mechanisms are marked. Test:
/// `a_thousandth_is_nearly_redundant`.
pub const NEARLY_REDUNDANT: f64 = 1e-3;

/// Margin for the rounding of norms and of the last few operations. Each rounding is a few eps
/// times the number of entries (below 2³⁰). Unit: share of the bound. Too small: a rounding error
/// makes a bound invalid. Too large: bounds are less sharp. Test:
/// `bounds_are_below_and_near_the_truth`.
pub(crate) const BOUND_SLACK: f64 = 1e-6;

/// Noise above this limit hides significant values. No value then counts as zero. Unit: singular
/// value of a matrix of norm one. Too small: no rank of coarse data is certified. Too large:
/// significant values count as zero. Test: `a_number_counts_a_thousand_times_above_its_noise`.
pub(crate) const NOISE_MAX: f64 = 1e-4;

/// An entry determines the scale of its row and column only above this multiple of its uncertainty.
/// The factor must not be smaller, because an entry that consists of several rounding errors of
/// larger terms must not be scaled up to norm one. A larger factor has no disadvantage, since the
/// rank does not depend on scales. Unit: multiples of the uncertainty of the entry. Too small:
/// rounding errors are scaled up to norm one. Too large: small bodies are scaled badly. Test:
/// `an_entry_near_its_uncertainty_does_not_set_the_scale`.
pub const SIGNIFICANT: f64 = 1e5;

/// Smallest singular value of one level, relative to the largest one of the level. The value is
/// above √eps, so that the solution in `f64` keeps half of its digits. Unit: share of the largest
/// singular value. Too small: the solution of a level has no correct digits. Too large: there are
/// more levels. Test: `exact_redundancy_falls_with_the_precision_and_misalignment_stays`.
pub(crate) const LEVEL_SPREAD: f64 = 1e-6;

/// Maximum number of corrections of T by double-double residuals. Each correction adds at least
/// eight correct digits. Unit: corrections. Too small: coefficients are not accurate to
/// double-double. Too large: the decision takes longer. Test: `planted_ranks_in_double_double`.
pub(crate) const CORRECTIONS_MAX: usize = 5;

/// Number of primes of the zero tests. A minor of thousands of bits is divisible by fewer than 2¹⁰
/// of the 2⁵⁵ primes. Therefore three primes agree by coincidence with a probability below 2⁻¹³⁰.
/// Unit: primes. Too small: a nonzero minor that is zero modulo all primes may count as zero. Too
/// large: the decision takes longer. Test: `primes_that_divide_a_determinant_are_outvoted`.
pub(crate) const WITNESSES: usize = 3;

/// σ_{r+1} vanishes if it decreases by ten digits below the 1e-16 of `f64`. The remaining value
/// comes from the refinement of the configuration in double-double. Unit: singular value of a
/// matrix of norm one. Too small: the refinement hides exact redundancy. Too large: a misalignment
/// far below a rounding error counts as exact. Test: `what_vanishes_is_ten_digits_below_rounding`.
pub(crate) const VANISHES: f64 = 1e-26;

/// A singular value above this multiple of the tolerance is larger than errors of the data. Unit:
/// multiples of the tolerance. Too small: data within their rounding count as misaligned. Too
/// large: a misalignment counts as rounding. Test: `a_singular_value_clears_the_data_by_four`.
pub(crate) const CLEAR_OF_DATA: f64 = 4.0;

/// Bound f of Gu and Eisenstat: |T_ji| ≤ f. Unit: 1. Too small: the exchanges do not end. Too
/// large: kept rows are less independent than possible. Test:
/// `exchanges_until_the_coefficients_are_bounded`.
pub(crate) const COEFFICIENT_BOUND: f64 = 2.0;

/// Maximum number of rounds of factorisation and exchanges. Exchanges within a round use an updated
/// T. A further round is needed only if the rounding errors of T are significant. Unit: rounds. Too
/// small: coefficients of ill-conditioned rows are not bounded. Too large: the decision takes
/// longer. Test: `exchanges_until_the_coefficients_are_bounded`.
pub(crate) const EXCHANGE_ROUNDS: usize = 8;

/// A direction below this share of the longest direction is rounding. Unit: share of the longest
/// direction. Too small: a rounding error counts as a direction. Too large: short directions are
/// lost. Test: `equal_rows_cancel`.
pub(crate) const DIRECTION_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Number of inverse iterations. Each iteration multiplies the error by the square of the ratio of
/// the smallest to the second smallest singular value. Unit: iterations. Too small: the weakest
/// combination is mixed with the second weakest. Too large: the decision takes longer. Test:
/// `equal_rows_cancel`.
pub(crate) const INVERSE_ITERATIONS: usize = 3;

// Coefficients of dependencies.

/// Ratio of the noise of coefficients to the noise of singular values. The additional noise comes
/// from the triangular solves. Unit: 1. Too small: a rounding error counts as a coefficient. Too
/// large: small coefficients are undecided. Test: `planted_matrices_read_as_by_the_dense_code`.
pub(crate) const SOLVE_FACTOR: f64 = 10.0;

/// A coefficient below this limit is never certainly nonzero. If a small part is connected to a
/// large one, the rounding of the data of the large part affects the small part. The ratio of their
/// sizes amplifies this effect, and the first order does not show it. Unit: coefficient of the
/// equilibrated dependencies. Too small: the rounding error of the data counts as a coefficient.
/// Too large: small coefficients are undecided. Test: `a_coefficient_has_to_clear_its_tolerance`.
pub(crate) const CERTAIN: f64 = 1e-9;

/// Below this σ_r of a certified matrix, the uncertainty of the data would hide all coefficients.
/// The decision then returns the coefficients of the stored matrix. Unit: singular value of a
/// matrix of norm one. Too small: near redundancy hides all coefficients. Too large: the
/// coefficients are those of rounded data. Test:
/// `coefficients_of_a_nearly_redundant_matrix_are_as_read`.
pub(crate) const AS_READ: f64 = 1e-6;

/// A coefficient above this multiple of the tolerance is certainly not zero. The tolerance itself
/// is a tenfold bound of the noise. Unit: multiples of the tolerance. Too small: a rounding error
/// counts as a coefficient. Too large: small coefficients are undecided. Test:
/// `a_coefficient_has_to_clear_its_tolerance`.
pub(crate) const COEFFICIENT_CLEARANCE: f64 = 10.0;

/// If the evidence cannot distinguish a coefficient of this size from zero, no coefficient counts
/// as zero. Unit: coefficient of the equilibrated dependencies. Too small: the rank remains
/// undecided if the evidence is imprecise. Too large: imprecise evidence makes coefficients zero.
/// Test: `a_coefficient_has_to_clear_its_tolerance`.
pub(crate) const TOLERANCE_MAX: f64 = 1e-5;

/// The limit that replaces [`TOLERANCE_MAX`] for the noise of a stated tolerance. The first order
/// is not valid for larger changes. Unit: coefficient of the equilibrated dependencies. Too small:
/// coefficients remain undecided for coarse tolerances. Too large: a first-order estimate is used
/// outside its range of validity. Test: `within_a_tolerance_only_what_is_small_is_zero`.
pub(crate) const STATED_MAX: f64 = 0.1;

/// A coefficient above this limit does not count as zero within a stated tolerance. Data within the
/// tolerance could make it zero, but need not do so. A value that is reported as zero must be
/// insignificant. Unit: coefficient of the equilibrated dependencies. Too small: no coefficient is
/// zero within coarse tolerances. Too large: significant reactions count as zero. Test:
/// `within_a_tolerance_only_what_is_small_is_zero`.
pub const STATED_ZERO: f64 = 1e-3;

/// Data that vary within their stated tolerances change a coefficient. A coefficient that is larger
/// than this factor times the change is certainly not zero. To make the coefficient zero, all data
/// would have to be wrong by this number of tolerances at the same time. Ranks use the same factor.
/// Unit: 1. Too small: the accuracy of data is overestimated. Too large: more coefficients are
/// undecided. Test: `within_a_tolerance_only_what_is_small_is_zero`.
pub const BEYOND_DOUBT: f64 = 3.0;

/// A coefficient below this limit in double-double is zero, for any accuracy of the data. Unit:
/// coefficient of the equilibrated dependencies. Too small: exact zeros are undecided. Too large:
/// small coefficients count as zero. Test:
/// `what_vanishes_is_zero_and_what_is_near_the_smallest_is_not`.
pub(crate) const VANISHED: f64 = 1e-13;

/// Random combinations of coefficients can be divided into zero and nonzero ones only if this
/// factor separates them. Unit: 1. Too small: coincidence decides. Too large: structural zeros are
/// undecided. Test: `what_vanishes_is_zero_and_what_is_near_the_smallest_is_not`.
pub(crate) const COMBINATION_SPREAD: f64 = 1e4;

/// Amplification of data errors. Changes of the data change entries directly, and also through the
/// configuration that depends on the data. Links that are ten times shorter than others amplify
/// this change. The result is at most the uncertainty of all entries together, divided by σ_r.
/// Unit: 1. Too small: short links change entries more than permitted. Too large: small
/// coefficients are undecided. Test: `parallel_cylinders_are_one_mechanism_with_any_digits`.
pub(crate) const POSE_FACTOR: f64 = 10.0;

/// Coefficients below this limit are rounding, for any stated tolerance. Unit: coefficient of the
/// scaled rows. Too small: a rounding error couples rows. Too large: small coefficients do not
/// couple rows. Test: `an_open_row_joins_what_it_belongs_to_beyond_rounding`.
pub const COEFFICIENT_ROUNDING: f64 = 1e-12;

// Sparse ranks.

/// Required independent share of a kept row with respect to the previously kept rows, if enough
/// rows have this share. Long chains have rows with an independent share of 1e-3. Unit: share of
/// the row. Too small: kept rows are nearly dependent. Too large: rows of long chains are skipped.
/// Test: `of_nearly_parallel_rows_one_is_kept`.
pub(crate) const LEFT: f64 = 1e-4;

/// Number q of solves with RᵀR. The bound is too low by at most `(√(3·r)/ε)^(1/2q)`: 4.3 at r =
/// 10⁵, and 2.4 at r = 100. Unit: solves. Too small: the bound of the smallest singular value is
/// too low. Too large: the decision takes longer. Test:
/// `planted_matrices_read_as_by_the_dense_code`.
pub(crate) const SOLVES: i32 = 3;

/// Probability that the bound is invalid. Unit: probability. Too small: the bound is lower. Too
/// large: the bound may be invalid. Test: `the_smallest_singular_value_is_bounded_from_below`.
pub(crate) const FAILURE: f64 = 1e-9;

/// Number of vectors that a reflection transforms at the same time. Unit: vectors. Too small:
/// memory is read more often. Too large: the registers are too small. Test: none, work only.
pub(crate) const REFLECTORS_WIDTH: usize = 8;

/// A front of at most this many columns is merged, because a separate assembly does not pay off.
/// Unit: columns. Too small: there are many small fronts. Too large: products contain zeros. Test:
/// `r_has_the_gram_matrix_of_c`.
pub(crate) const SMALL_FRONT: usize = 24;

/// More operations than this take minutes, and their fronts need gigabytes. A single dense front of
/// 10⁴ columns reaches this limit. Unit: operations. Too small: mechanisms that could be analysed
/// are rejected. Too large: results take hours. Test: `what_would_take_hours_is_refused`.
pub(crate) const WORK_MAX: f64 = 1e12;

/// Number of precomputed primes; further primes are computed on request. Unit: primes. Too small:
/// primes are computed repeatedly. Too large: more memory is used. Test: none, work only.
pub(crate) const PRIMES_READY: usize = 64;

/// Bits of every prime: `2⁶¹ < p < 2⁶²`. Unit: bits. Too small: the same certainty needs more
/// primes. Too large: products overflow. Test: `primes_differ_and_have_their_bits`.
pub(crate) const PRIME_BITS: u32 = 61;

// Requests with a potentially excessive number of operations.

/// Maximum number of hyperplanes of one component that are tried. Unit: hyperplanes. Too small:
/// shortest circuits are not found. Too large: the search takes longer. Test:
/// `short_circuits_are_the_shortest_basis_of_all_circuits`.
pub(crate) const HYPERPLANES_MAX: usize = 20_000;

/// If the last pivot of the vectors of a hyperplane is below this limit, the vectors do not
/// determine the hyperplane: noise would hide small coefficients. Unit: 1. Too small: noise counts
/// as a circuit. Too large: circuits are not found. Test:
/// `vectors_have_to_span_what_a_circuit_vanishes_on`.
pub(crate) const PIVOT_MIN: f64 = 1e-4;

/// Maximum number of steps of deletion and contraction for one component. Each step costs about
/// m·p² multiplications. Unit: steps. Too small: sets are not counted. Too large: the count takes
/// longer. Test: `large_redundancies_are_counted`.
pub(crate) const COUNT_STEPS: usize = 20_000;
