//! The table of limits: every number of this crate that somebody chose. Each says what it is, in
//! which unit, what breaks if it is wrong (`Less`: if it were smaller, `More`: if it were larger),
//! and which test fails then; `none, work only` if only time or memory change, `none` if there is
//! no test yet. `tests/all/limits.rs` reads it.

// Dense ranks.

/// Factor between the noise estimate and the tolerance τ: rounding of an equilibrated matrix and
/// the polished residual were each measured within a factor 4 of the singular value they cause.
/// Unit: 1. Less: rounding is read as rank. More: exact redundancy hides small numbers. Test:
/// `a_singular_value_clears_the_data_by_four`.
pub const NOISE_FACTOR: f64 = 10.0;

/// The smallest non-zero singular value must clear τ by this factor, or the rank is undecided.
/// Unit: multiples of the tolerance. Less: rows are kept by noise. More: ranks near singular poses
/// are undecided. Test: `a_number_counts_a_thousand_times_above_its_noise`.
pub(crate) const CLEARANCE: f64 = 1e3;

/// Data that are known to less than this share of a row say nothing of it: what they hide is no
/// redundancy.
/// Unit: share of a row of size one. Less: exact redundancy within coarse data is doubted. More:
/// what nobody knows is called redundant. Test: `coarse_data_hide_what_is_no_rounding`.
pub const HIDDEN: f64 = 0.01;

/// What is above the root of eps in a matrix of size one is no rounding of its entries.
/// Unit: singular value of a matrix of size one. Less: rounding of the pose is read as rank. More:
/// misalignment of the drawing is called rounding. Test: `coarse_data_hide_what_is_no_rounding`.
pub const NOT_ROUNDING: f64 = 1.5e-8;

/// A configuration is known to about √eps near a singular one, whatever its residual: Newton's
/// method stops there as at a double root. A smallest singular value below this may be zero at the
/// true configuration.
/// Unit: singular value of a matrix of size one. Less: singular poses are read as regular. More:
/// poses near singular ones are undecided. Test: `a_singular_value_between_is_undecided`.
pub const NEARLY_SINGULAR: f64 = 1e-7;

/// Below this smallest singular value the rank as read stands, but the reactions it determines are
/// large: of size 1/σ_r per unit of load, and anything known only to σ_r moves them by their own
/// size.
/// Unit: singular value of a matrix of size one. Less: large reactions go unmarked. More: sound
/// mechanisms are marked. Test: `a_thousandth_is_nearly_redundant`.
pub const NEARLY_REDUNDANT: f64 = 1e-3;

/// Covers the rounding of norms and of the last few operations, each a few eps times the number of
/// entries (below 2³⁰).
/// Unit: share of the bound. Less: a bound is none by rounding. More: bounds say less. Test:
/// `bounds_are_below_and_near_the_truth`.
pub(crate) const BOUND_SLACK: f64 = 1e-6;

/// Noise that reaches further hides numbers that matter: nothing is zero relative to it.
/// Unit: singular value of a matrix of size one. Less: nothing is certified on coarse data. More:
/// numbers that matter are called zero. Test: `a_number_counts_a_thousand_times_above_its_noise`.
pub(crate) const NOISE_MAX: f64 = 1e-4;

/// An entry sets the scale of its row and column only above this multiple of its uncertainty. Not
/// less: an entry that is what several roundings left of larger terms must never be scaled up to
/// size one; and nothing is lost, since the rank does not depend on scales.
/// Unit: multiples of the uncertainty of the entry. Less: rounding is scaled up to size one. More:
/// small bodies are scaled badly. Test: `an_entry_near_its_uncertainty_does_not_set_the_scale`.
pub const SIGNIFICANT: f64 = 1e5;

/// Singular values of one level, relative to its largest: above √eps, so that `f64` solves it with
/// half of its digits to spare.
/// Unit: share of the largest singular value. Less: a level is solved without digits. More: more
/// levels. Test: `exact_redundancy_falls_with_the_precision_and_misalignment_stays`.
pub(crate) const LEVEL_SPREAD: f64 = 1e-6;

/// Corrections of T by double-double residuals; each gains at least eight digits.
/// Unit: corrections. Less: coefficients are not accurate to double-double. More: time. Test:
/// `planted_ranks_in_double_double`.
pub(crate) const CORRECTIONS_MAX: usize = 5;

/// Primes of the zero tests. A minor of thousands of bits is divisible by fewer than 2¹⁰ of the 2⁵⁵
/// primes, so three agree by chance with probability below 2⁻¹³⁰.
/// Unit: primes. Less: a minor is zero by chance. More: time. Test:
/// `primes_that_divide_a_determinant_are_outvoted`.
pub(crate) const WITNESSES: usize = 3;

/// σ_{r+1} vanishes if it falls by ten digits below the 1e-16 of `f64`; what remains is the
/// polishing of the point in double-double.
/// Unit: singular value of a matrix of size one. Less: polishing hides exact redundancy. More:
/// misalignment far below rounding is called exact. Test:
/// `what_vanishes_is_ten_digits_below_rounding`.
pub(crate) const VANISHES: f64 = 1e-26;

/// Above this multiple of the tolerance a singular value is larger than the data can explain.
/// Unit: multiples of the tolerance. Less: data within their rounding are called misaligned. More:
/// misalignment is called rounding. Test: `a_singular_value_clears_the_data_by_four`.
pub(crate) const CLEAR_OF_DATA: f64 = 4.0;

/// The bound f of Gu and Eisenstat: |T_ji| ≤ f.
/// Unit: 1. Less: exchanges without end. More: kept rows are less independent than they could be.
/// Test: `exchanges_until_the_coefficients_are_bounded`.
pub(crate) const COEFFICIENT_BOUND: f64 = 2.0;

/// Rounds of "factor, then exchange". Exchanges within a round work on an updated T; a further
/// round is needed only if its rounding errors mattered.
/// Unit: rounds. Less: coefficients of ill-conditioned rows are not bounded. More: time. Test:
/// `exchanges_until_the_coefficients_are_bounded`.
pub(crate) const EXCHANGE_ROUNDS: usize = 8;

/// Share of the longest direction below which one is rounding.
/// Unit: share of the longest direction. Less: rounding is a direction. More: short directions are
/// lost. Test: `equal_rows_cancel`.
pub(crate) const DIRECTION_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Inverse iterations; each gains the square of the gap between the two smallest singular values.
/// Unit: iterations. Less: the weakest combination mixes with the next. More: time. Test:
/// `equal_rows_cancel`.
pub(crate) const INVERSE_ITERATIONS: usize = 3;

// Coefficients of dependencies.

/// Noise of coefficients over that of singular values: the triangular solves.
/// Unit: 1. Less: rounding is a coefficient. More: small coefficients are undecided. Test:
/// `planted_matrices_read_as_by_the_dense_code`.
pub(crate) const SOLVE_FACTOR: f64 = 10.0;

/// No coefficient below this is certainly not zero: where a small part hangs on a large one, the
/// rounding of the data of the large part reaches the small one amplified by the ratio of their
/// sizes, which the first order does not show.
/// Unit: coefficient of the equilibrated dependencies. Less: rounding of the data is a coefficient.
/// More: small coefficients are undecided. Test: `a_coefficient_has_to_clear_its_tolerance`.
pub(crate) const CERTAIN: f64 = 1e-9;

/// Below this σ_r of a certified matrix the uncertainty of the data would hide all coefficients;
/// they are those of the matrix as read.
/// Unit: singular value of a matrix of size one. Less: near redundancy hides all coefficients.
/// More: coefficients are those of rounded data. Test:
/// `coefficients_of_a_nearly_redundant_matrix_are_as_read`.
pub(crate) const AS_READ: f64 = 1e-6;

/// A coefficient above the tolerance by this factor is certainly not zero; the tolerance is itself
/// a tenfold bound of the noise.
/// Unit: multiples of the tolerance. Less: rounding is a coefficient. More: small coefficients are
/// undecided. Test: `a_coefficient_has_to_clear_its_tolerance`.
pub(crate) const COEFFICIENT_CLEARANCE: f64 = 10.0;

/// Evidence that cannot tell a coefficient of this size from zero calls nothing zero.
/// Unit: coefficient of the equilibrated dependencies. Less: poor evidence decides nothing. More:
/// poor evidence calls coefficients zero. Test: `a_coefficient_has_to_clear_its_tolerance`.
pub(crate) const TOLERANCE_MAX: f64 = 1e-5;

/// The same where the noise is that of a stated tolerance: of larger changes the first order says
/// nothing.
/// Unit: coefficient of the equilibrated dependencies. Less: coarse tolerances decide nothing.
/// More: the first order is asked too much. Test: `within_a_tolerance_only_what_is_small_is_zero`.
pub(crate) const STATED_MAX: f64 = 0.1;

/// A coefficient above this is not called zero there: that data within the tolerance could make it
/// zero does not say that they do, and what is reported as none must not matter.
/// Unit: coefficient of the equilibrated dependencies. Less: coarse tolerances call nothing zero.
/// More: reactions that matter are called none. Test:
/// `within_a_tolerance_only_what_is_small_is_zero`.
pub const STATED_ZERO: f64 = 1e-3;

/// By this factor a coefficient is certainly not zero there: all data together would have to be
/// wrong by as many tolerances, as for ranks.
/// Unit: 1. Less: data are trusted too much. More: more is undecided. Test:
/// `within_a_tolerance_only_what_is_small_is_zero`.
pub const BEYOND_DOUBT: f64 = 3.0;

/// A coefficient that has come out as small as this in double-double is zero, whatever the data are
/// known to.
/// Unit: coefficient of the equilibrated dependencies. Less: exact zeros are undecided. More: small
/// coefficients are called zero. Test:
/// `what_vanishes_is_zero_and_what_is_near_the_smallest_is_not`.
pub(crate) const VANISHED: f64 = 1e-13;

/// Random combinations of coefficients are zero and not zero only with this factor between them.
/// Unit: 1. Less: chance decides. More: structural zeros are undecided. Test:
/// `what_vanishes_is_zero_and_what_is_near_the_smallest_is_not`.
pub(crate) const COMBINATION_SPREAD: f64 = 1e4;

/// Data move entries by themselves and through the pose that follows them, which links that are ten
/// times shorter than others amplify. Never above what all entries together are known to, over σ_r.
/// Unit: 1. Less: short links move entries more than is allowed for. More: small coefficients are
/// undecided. Test: `parallel_cylinders_are_one_mechanism_with_any_digits`.
pub(crate) const POSE_FACTOR: f64 = 10.0;

/// Coefficients below this are rounding, whatever is stated.
/// Unit: coefficient of the scaled rows. Less: rounding joins rows. More: small coefficients do
/// not. Test: `an_open_row_joins_what_it_belongs_to_beyond_rounding`.
pub const COEFFICIENT_ROUNDING: f64 = 1e-12;

// Sparse ranks.

/// How much shall be left of a kept row next to those kept before it, if there are enough of them.
/// Long chains have rows of which 1e-3 is left.
/// Unit: share of the row. Less: kept rows are nearly dependent. More: rows of long chains are
/// passed over. Test: `of_nearly_parallel_rows_one_is_kept`.
pub(crate) const LEFT: f64 = 1e-4;

/// Solves with RᵀR. With q of them the bound is too low by at most `(√(3·r)/ε)^(1/2q)`: 4.3 at r =
/// 10⁵, and 2.4 at r = 100.
/// Unit: solves. Less: the bound of the smallest singular value is too low. More: time. Test:
/// `planted_matrices_read_as_by_the_dense_code`.
pub(crate) const SOLVES: i32 = 3;

/// How likely the bound is none.
/// Unit: probability. Less: the bound is lower. More: the bound may be none. Test:
/// `the_smallest_singular_value_is_bounded_from_below`.
pub(crate) const FAILURE: f64 = 1e-9;

/// Vectors that are turned at once.
/// Unit: vectors. Less: memory is read more often. More: registers do not hold them. Test: none,
/// work only.
pub(crate) const REFLECTORS_WIDTH: usize = 8;

/// A front of at most this many columns is not worth its own assembly.
/// Unit: columns. Less: many small fronts. More: products with zeros. Test:
/// `r_has_the_gram_matrix_of_c`.
pub(crate) const SMALL_FRONT: usize = 24;

/// More operations than this take minutes, and their fronts gigabytes: a single dense front of 10⁴
/// columns.
/// Unit: operations. Less: mechanisms that could be judged are refused. More: answers take hours.
/// Test: `what_would_take_hours_is_refused`.
pub(crate) const WORK_MAX: f64 = 1e12;

/// Primes made once; more are made when they are asked for.
/// Unit: primes. Less: primes are made again and again. More: memory. Test: none, work only.
pub(crate) const PRIMES_READY: usize = 64;

/// Bits of every prime: `2⁶¹ < p < 2⁶²`.
/// Unit: bits. Less: more primes for the same certainty. More: products overflow. Test:
/// `primes_differ_and_have_their_bits`.
pub(crate) const PRIME_BITS: u32 = 61;

// Questions that may grow beyond measure.

/// Hyperplanes of one component that are tried at most.
/// Unit: hyperplanes. Less: shortest circuits are not found. More: time. Test:
/// `short_circuits_are_the_shortest_basis_of_all_circuits`.
pub(crate) const HYPERPLANES_MAX: usize = 20_000;

/// Vectors that span a hyperplane by less than this do not say where it lies: small coefficients
/// would drown in the noise.
/// Unit: 1. Less: noise is read as a circuit. More: circuits are missed. Test:
/// `vectors_have_to_span_what_a_circuit_vanishes_on`.
pub(crate) const PIVOT_MIN: f64 = 1e-4;

/// Steps of deletion and contraction that one component may take; each costs about m·p²
/// multiplications.
/// Unit: steps. Less: sets are not counted. More: time. Test: `large_redundancies_are_counted`.
pub(crate) const COUNT_STEPS: usize = 20_000;
