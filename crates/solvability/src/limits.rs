//! Table of limits: all numbers of this crate that its authors chose. Each comment states the
//! meaning, the unit, the effects of a number that is too small or too large, and the test that
//! fails then. `none, work only` means that only time or memory would change; `none` means that
//! there is no test yet. The test file `tests/all/limits.rs` reads this table.

// Ranks and certificates.

/// Largest number of rows for which a rank is certified. The work grows with the cube of the rows.
/// Unit: rows. Too small: ranks of large mechanisms are not certified. Too large: the analysis
/// takes longer. Test: `a_part_is_asked_under_what_the_rest_does_to_it`.
pub(crate) const ROWS_MAX: usize = 600;

/// Largest number of rows for which coefficients are decided within a stated tolerance. The work
/// grows with the number of rows times the number of dependencies, and with the cube of both
/// numbers. Unit: rows. Too small: coefficients are decided only within rounding errors. Too large:
/// the analysis takes longer. Test: `a_component_that_is_none_within_the_tolerance_says_so`.
pub(crate) const TOLERANCE_ROWS: usize = 200;

/// A coefficient above this value is nonzero without further tests. The row of such a coefficient
/// belongs to the dependency. Unit: coefficient of the equilibrated dependencies. Too small:
/// coefficients that a change of the data could make zero count as nonzero. Too large: the analysis
/// takes longer. Test: `data_are_asked_about_small_coefficients_that_are_no_noise`.
pub(crate) const COEFFICIENT_LARGE: f64 = 1e-3;

/// A coefficient below this share of its noise is zero without further tests. Unit: share of the
/// noise. Too small: the analysis takes longer. Too large: coefficients that a change of the data
/// could make large count as zero. Test:
/// `data_are_asked_about_small_coefficients_that_are_no_noise`.
pub(crate) const SAFELY: f64 = 0.1;

/// Maximum number of coefficients whose change by the rounding of the data is computed. Unit:
/// coefficients. Too small: coefficients near their noise are undecided. Too large: the analysis
/// takes longer. Test: none.
pub(crate) const ASKED: usize = 2_000;

/// Larger sets of rows are decided with sparse matrices. Unit: rows. Too small: small sets are
/// decided without singular values. Too large: the analysis takes longer. Test: none.
pub(crate) const SPARSE_FROM: usize = 150;

/// Number of random combinations in addition to the number of rows of the largest joint. Unit:
/// combinations. Too small: too few combinations decide a rank. Too large: the analysis takes
/// longer. Test: `random_combinations_show_the_rank_of_the_largest_joint`.
pub(crate) const SPARE_COMBINATIONS: usize = 4;

/// A mechanism with at most this number of rows is one part, even if its cycles would divide it.
/// All of its verdicts then come from one null space. Its rank can also be compared with the rank
/// at other configurations, which needs dense matrices of all rows and columns. Unit: rows. Too
/// small: small mechanisms are not compared with other configurations. Too large: the time grows
/// with the cube of the rows, and 600 rows take half a minute. Test:
/// `a_motor_that_lags_behind_is_named_with_the_joints_between`.
pub const ONE_PART: usize = 250;

/// Number of vectors of the left null space from which verdicts along a motion are computed. All
/// vectors are used if there are at most this many. Otherwise this number of random combinations of
/// the vectors is used. Unit: vectors. Too small: a coefficient comes from so few combinations that
/// they may cancel. Too large: each step takes longer for each row. Test:
/// `many_dependencies_are_read_from_few_combinations`.
pub const CARRIED_VECTORS: usize = 8;

/// Singular values must exceed the tolerance by this factor. Simulations with the stress matrix
/// keep their digits from a factor of thirty upwards. Unit: multiples of the tolerance. Too small:
/// the motion loses digits. Too large: motions near singular configurations are rejected. Test:
/// none.
pub(crate) const MOTION_CLEARANCE: f64 = 30.0;

/// Accuracy of the numbers of a motion, in roundings of data. The data are accurate to several
/// rounding errors, but the numbers of a motion to one rounding error. Unit: roundings of data. Too
/// small: rounding errors of the motion decide its rank. Too large: redundant rows near singular
/// configurations are undecided. Test: none.
pub(crate) const ONE_ROUNDING: f64 = f64::EPSILON / 2.0 / model::ROUNDING;

/// The entries of the map from multipliers to a reaction are products of a few numbers near one. If
/// a row is below this share of the largest row, it contains only rounding errors. Unit: share of
/// the largest row. Too small: a rounding error counts as a component of a reaction. Too large:
/// small components count as zero. Test: none.
pub(crate) const ROUNDING_OF_MAP: f64 = 1e-14;

/// Angles (rad) above this limit are too large for a first-order estimate. Unit: rad. Too small:
/// estimates with coarse angle tolerances are rejected. Too large: a first-order estimate is used
/// outside its range of validity. Test: none.
pub(crate) const LARGEST_TURN: f64 = 0.1;

/// A component of a unit vector above this value is reported, even if data within their stated
/// tolerances could make the component zero. Without this component, the printed vector would have
/// a different direction. Unit: part of a unit vector. Too small: rounding errors are reported. Too
/// large: small components are reported as zero. Test:
/// `a_part_of_a_direction_is_told_however_uncertain_coefficients_are`.
pub(crate) const LARGEST_ROUNDING: f64 = 1e-5;

// The intended mechanism.

/// From this singular value upwards, rounding cannot cause a lower rank of a matrix of norm one.
/// Near a singular configuration, a singular value changes with the square root of the data. A
/// lower rank by rounding would then require a value below a few times √(3·eps). Unit: singular
/// value of a matrix of norm one. Too small: a rounding error decides a rank. Too large: the
/// expensive test runs at configurations that are not nearly singular. Test: none.
pub(crate) const CLEAR_OF_ROUNDING: f64 = 1e-6;

/// The limit [`CLEAR_OF_ROUNDING`] as a multiple of the accuracy of the entries. The larger of the
/// two limits applies. Unit: multiples of the noise. Too small: a rounding error decides a rank.
/// Too large: the expensive test runs at configurations that are not nearly singular. Test: none.
pub(crate) const CLEAR_OF_NOISE: f64 = 1e3;

/// A singular value from `f64` counts as confirmed if the double-double computation returns at
/// least this share of the value. Unit: share of a singular value. Too small: a rounding error of
/// `f64` counts as a singular value. Too large: ranks are not confirmed. Test:
/// `a_door_turns_within_its_tolerance`.
pub(crate) const CONFIRMED: f64 = 0.1;

/// A lower rank is reported if data have this rank after changes of at most this share of the size
/// of the mechanism. Unit: share of the size of the mechanism. Too small: near redundancy is not
/// reported. Too large: sound mechanisms are reported as nearly redundant. Test:
/// `a_dead_centre_is_a_pose_and_no_redundancy`.
pub(crate) const NEAR_TOLD: f64 = 1e-3;

/// Factor in the error of first-order equations. The error is the square of the change, as a share
/// of the size, times this factor. The change that lowers the rank at all configurations is up to
/// ten times the change for one entry. Second derivatives are about ten if links are short.
/// Unit: 1. Too small: a first-order estimate is used outside its range of validity. Too large:
/// near redundancy is not proved. Test: `a_dead_centre_is_a_pose_and_no_redundancy`.
pub(crate) const CURVED: f64 = 100.0;

/// Maximum constraint violation of a configuration on a continuation path, as a share of the size.
/// Unit: share of the size of the mechanism. Too small: the continuation does not converge. Too
/// large: the configurations violate the constraints. Test:
/// `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const WALKED: f64 = 1e-12;

/// Limit for the weakest entry, as a share of the size of C. If the entry is larger, no change of
/// the data below a thousandth of the size makes it zero. An entry changes by its own size, times
/// the change of the configuration. This change is below the inverse of the entry. Unit: share of
/// the size of C. Too small: near redundancy is not examined. Too large: the analysis takes longer.
/// Test: `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const CLEAR_ENTRY: f64 = 0.1;

/// A dependency counts as a dependency of positions if the weight of its nonholonomic rows is below
/// this share of the weight of its other rows. Unit: share of the weights. Too small: dependencies
/// of positions are examined at one configuration only. Too large: dependencies of velocities are
/// examined at other configurations. Test: none.
pub(crate) const HOLONOMIC: f64 = 1e-6;

/// Singular vectors for singular values below this share of the largest singular value are
/// rounding, and need not be orthogonal to the other singular vectors. Unit: share of the largest
/// singular value. Too small: vectors of rounding are expected to be orthogonal. Too large: small
/// singular vectors are replaced. Test: `singular_vectors_of_rounding_are_replaced`.
pub(crate) const RESOLVED: f64 = 1e-13;

/// Number of left and right singular directions whose entries must vanish at one configuration, the
/// weakest directions first. Further directions would require exact zeros next to the near zero. If
/// directions are omitted, the share can only become smaller. Unit: pairs. Too small: a share is
/// too small. Too large: the analysis takes longer, and exact zeros are required. Test:
/// `an_angle_tolerance_counts_alone`.
pub(crate) const PAIRS: usize = 4;

/// Rounding of an entry of a scaled C between unit vectors, in units of eps·√(m·n). Unit:
/// eps·√(m·n). Too small: the rounding error of an entry counts as a change of data. Too large:
/// shares are too small. Test: `a_misfit_above_the_rounding_of_entries_is_one_of_data`.
pub(crate) const ENTRY_ROUNDINGS: f64 = 16.0;

/// Number of configurations on each side of the start in a continuation. Unit: poses. Too small: a
/// redundancy that exists only at the start is reported as permanent. Too large: the analysis takes
/// longer. Test: `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const WALK_POSES: usize = 3;

/// Distance from one configuration to the next, as a share of the size or in radians. The distance
/// is short, so that the continuation does not cross a singular configuration onto another branch.
/// Unit: share of the size of the mechanism, or rad. Too small: the configurations are nearly
/// equal. Too large: the continuation reaches other branches. Test:
/// `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const WALK_REACH: f64 = 0.05;

/// Number of continuation steps from one configuration to the next. Unit: steps. Too small: the
/// continuation does not converge. Too large: the analysis takes longer. Test:
/// `a_dead_centre_is_a_pose_and_no_redundancy`.
pub(crate) const WALK_STEPS: usize = 5;

/// Number of steps to the next configuration if [`WALK_STEPS`] larger steps do not converge. Unit:
/// steps. Too small: the continuation does not converge near singular configurations. Too large:
/// the analysis takes longer. Test: none.
pub(crate) const WALK_SMALL_STEPS: usize = 40;

/// Largest correction of a step onto the independent rows, as a share of the step. A configuration
/// with a larger correction may be on another branch. Unit: share of the step. Too small: the
/// continuation ends on curved paths. Too large: the continuation changes the branch. Test:
/// `rows_that_are_nearly_redundant_at_a_pose_are_left_out_together`.
pub(crate) const WALK_CORRECTED: f64 = 0.5;

/// Limit of the condition of Newton and Kantorovich for a configuration of a continuation. If the
/// condition is satisfied, the mechanism has such a configuration for all data within the stated
/// tolerance. Unit: 1. Too small: redundancy within a tolerance is undecided. Too large:
/// configurations that the intended mechanism does not have are used, and permanent redundancy
/// counts as full rank. Test: `bricard_with_few_digits_is_right_or_undecided`.
pub(crate) const KNOWN_POSE: f64 = 0.5;

/// Share of the other free directions in the direction of a continuation. Unit: share of a
/// direction. Too small: the other freedoms do not move. Too large: the path mixes all freedoms.
/// Test: `a_way_is_led_by_one_freedom_and_takes_the_others_along`.
pub(crate) const OTHER_DIRECTIONS: f64 = 0.3;

/// Maximum number of iterations. Each iteration solves a linear system with as many unknowns as the
/// problem has equations. Unit: iterations. Too small: bounds of the share are wide. Too large: the
/// analysis takes longer. Test: `one_equation_is_shared_by_all`.
pub(crate) const CONE_ITERATIONS: usize = 60;

/// The iteration ends if the ratio of the upper bound to the lower bound is below this factor.
/// Unit: 1. Too small: the analysis takes longer. Too large: bounds of the share are wide. Test:
/// `a_point_has_one_change_in_both_directions`.
pub(crate) const CONE_CLOSE: f64 = 1.05;

/// Permitted residual of an equation, as a share of its coefficients. Near the square root of eps,
/// the normal equations cannot distinguish consistent equations from inconsistent equations. More
/// digits of the share are not needed. Unit: share of the coefficients. Too small: consistent
/// equations count as inconsistent. Too large: inconsistent equations count as consistent. Test:
/// `what_no_change_satisfies_is_far_away`.
pub(crate) const CONE_RESOLVED: f64 = 1e-5;

/// Smallest weight, as a share of the largest weight. With this weight, changes that are not needed
/// remain available. Unit: share of the largest weight. Too small: normal equations lose their
/// digits. Too large: changes that are not needed remain in the result. Test:
/// `numbers_that_need_no_change_stay_out_of_the_bounds`.
pub(crate) const LEAST_WEIGHT: f64 = 1e-9;

/// Largest difference of two results that agree, as a share of the size. Positions cannot be
/// corrected onto nonholonomic rows later. Therefore errors of steps that are too long would
/// remain. Unit: share of the size of the mechanism. Too small: the steps become too small. Too
/// large: nonholonomic rows are violated. Test: `what_edges_lead_stays_on_its_way`.
pub(crate) const FOLLOWED: f64 = 1e-12;

// Other configurations.

/// Number of other configurations with which the given configuration is compared. Unit:
/// configurations. Too small: a coincidence makes redundancy look permanent. Too large: the
/// analysis takes longer. Test: `cranks_are_compared_with_themselves_elsewhere`.
pub(crate) const POINTS: usize = 4;

/// Maximum number of continuations, including those that reach no new configuration. Unit: walks.
/// Too small: too few configurations are found. Too large: the analysis takes longer. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const WALKS: usize = 12;

/// Number of steps from one configuration to the next. Unit: steps. Too small: the configurations
/// are near the given configuration. Too large: the analysis takes longer. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const GENERIC_STEPS: usize = 4;

/// Length of a step, as a share of the size of the mechanism or in radians. Unit: share of the size
/// of the mechanism, or rad. Too small: the configurations are near the given configuration. Too
/// large: the configurations cannot be assembled. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const GENERIC_STEP: f64 = 0.2;

/// Number of halvings with which the length of a step is tried, because not every displaced
/// mechanism can be assembled again. Unit: halvings. Too small: the continuation ends at once. Too
/// large: the analysis takes longer. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const GENERIC_HALVINGS: i32 = 5;

/// A step is rejected if the constraints correct it by more than this share of its length. Such a
/// step leads to another branch, whose rank can differ from the rank of this branch. Unit: share of
/// the step. Too small: curved branches are not followed. Too large: other branches are compared.
/// Test: `legs_that_stay_parallel_are_not_compared_with_those_that_do_not`.
pub(crate) const GENERIC_STRAYED: f64 = 0.3;

/// Rows that are redundant at one configuration are tested after a step on the other rows. These
/// rows are redundant at the new configuration, too, if their violation is below this share of
/// their terms. Unit: share of the terms. Too small: a rounding error counts as a violation. Too
/// large: rows that become inconsistent count as redundant. Test:
/// `legs_that_stay_parallel_are_not_compared_with_those_that_do_not`.
pub(crate) const GENERIC_HOLDS: f64 = 1e-12;

/// Minimum distance of the configurations from each other and from the given configuration, in the
/// unit of the step. Unit: share of the size of the mechanism, or rad. Too small: the same
/// configuration is examined twice. Too large: too few configurations are found. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const POINTS_APART: f64 = 0.1;

// Limit positions of drives.

/// Step along the curve of configurations towards the limit position of the drives. Unit: share of
/// the size of the mechanism, or rad. Too small: the limit position is not reached. Too large:
/// corrections lead to another branch. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_STEP: f64 = 0.02;

/// Maximum number of steps along the curve of configurations. A run that stops because of a limit
/// position ends at most this many steps before the limit position. Unit: steps. Too small: the
/// limit position is not reached. Too large: limit positions that did not stop the run are reported
/// as its cause. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_STEPS: usize = 20;

/// Maximum number of corrections of a point of the curve. Each correction doubles the number of
/// correct digits. Unit: corrections. Too small: points far from their tangent are not reached. Too
/// large: the analysis takes longer. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_CORRECTIONS: usize = 12;

/// The iteration has converged if its correction is shorter than this limit. Unit: share of the
/// size of the mechanism, or rad. Too small: rounding errors are corrected without end. Too large:
/// the limit position has few digits. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_ARRIVED: f64 = 1e-11;

/// Number of halvings of the last step. Unit: halvings. Too small: the limit position has few
/// digits. Too large: the analysis takes longer. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_HALVINGS: usize = 40;

/// Components of drives, time and curvatures below this share of the largest component are
/// rounding. Unit: share. Too small: a rounding error counts as a drive. Too large: a drive is
/// omitted. Test: `branches_that_meet_are_no_limit`.
pub(crate) const LIMIT_ROUNDING: f64 = 1e-6;

/// Maximum number of free velocities at the limit position. If there are more, the curvature is not
/// examined. Unit: velocities. Too small: drives of mechanisms with a free motion are not named.
/// are more. Unit: velocities. Too small: drives of mechanisms with a free motion are not named.
/// Too large: curvatures are not examined. Test: `a_free_arm_reaches_as_far_as_it_is_long`.
pub(crate) const LIMIT_FORMS: usize = 12;

// Contradicting drives.

/// Number of positions after the start at which drives are compared along a motion. Unit:
/// positions. Too small: later contradictions are not found. Too large: the analysis takes longer.
/// Test: `motors_that_part_later_are_named_with_the_time`.
pub(crate) const DRIVE_POSITIONS: u32 = 12;

/// Largest change of a drive from one position to the next, in rad or as a share of the size of the
/// mechanism. A larger step may end on another branch of the joints, where consistent drives
/// contradict each other. Unit: rad, or share of the size. Too small: the analysis takes longer.
/// Too large: a step ends on another branch. Test:
/// `agreeing_motors_are_followed_through_flat_poses`.
pub(crate) const STRIDE: f64 = 0.1;

/// Maximum number of steps along the motion. These steps suffice for a dozen revolutions. Later
/// contradictions are not found. Unit: steps. Too small: contradictions after few revolutions are
/// not found. Too large: the analysis takes longer. Test:
/// `agreeing_motors_are_followed_through_flat_poses`.
pub(crate) const DRIVE_STEPS: usize = 800;

/// Maximum number of halvings of a step that fails. A position that needs smaller steps is too near
/// to a singular configuration for the continuation. Unit: halvings. Too small: motions near
/// singular configurations are not followed. Too large: the analysis takes longer. Test:
/// `agreeing_motors_are_followed_through_flat_poses`.
pub(crate) const DRIVE_HALVINGS: usize = 6;

/// If drives differ by more than this share of their terms, a run certainly stops. (Runs compare to
/// 1e-11, divided by pivots.) Unit: share of the terms. Too small: a rounding error counts as a
/// contradiction. Too large: runs stop because of contradictions that were not reported. Test:
/// `small_differences_are_told_at_their_time`.
pub(crate) const RUNS_NOTICE: f64 = 1e-9;

// Analysis along a motion.

/// Maximum number of iterations of a search. This number of bisections reduces any interval to the
/// size of the rounding error. Unit: iterations. Too small: times are not accurate to rounding. Too
/// large: the search takes longer if there is no root. Test:
/// `roots_to_rounding_also_multiple_ones`.
pub(crate) const SEARCH_ITERATIONS: usize = 120;

/// Intervals shorter than this share of their times are not divided. Unit: share of a time. Too
/// small: the search takes longer. Too large: instants lose digits. Test:
/// `roots_to_rounding_also_multiple_ones`.
pub(crate) const RESOLUTION: f64 = 2.0 * f64::EPSILON;

/// The search for an edge ends at this share of its interval, because more digits are not needed.
/// Unit: share of the interval. Too small: the search takes longer. Too large: edges of stretches
/// lose digits. Test: `edges_from_both_sides`.
pub(crate) const EDGE: f64 = 1e-10;

/// Number of parabolas after which the search for a corner continues by golden sections. Unit:
/// evaluations. Too small: corners of smooth functions take longer. Too large: other minima take
/// longer. Test: `corners_take_few_evaluations`.
pub(crate) const CORNER_STEPS: usize = 14;

/// Factor of the estimate for the lowest value of a function around its minimum. If a convex
/// function is evaluated at golden sections, it lies above `least − 1.62·(largest − least)`. The
/// larger factor also covers functions that are not convex. Unit: 1. Too small: minima are missed.
/// Too large: the search takes longer. Test: `minima_of_corners_and_parabolas`.
pub(crate) const FALL: f64 = 4.0;

/// If a function reaches a limit within an interval, its distance from the limit decreases at least
/// with this power of the width. A square root decreases with the power 0.5; a jump does not
/// decrease. Unit: 1. Too small: the search takes longer at jumps. Too large: steep minima are
/// missed. Test: `minima_of_corners_and_parabolas`.
pub(crate) const NARROWING: f64 = 0.25;

/// A sample of a motion is not regular if its σ_r is below `rank::NEARLY_REDUNDANT` and below this
/// share of the largest σ_r of all samples. Unit: share of the largest singular value. Too small:
/// samples near a singular configuration count as regular. Too large: some motions have no regular
/// samples. Test: `a_motion_near_a_singular_pose_has_regular_samples`.
pub(crate) const REGULAR_SAMPLE: f64 = 0.1;

/// Number of intervals into which the surroundings of a minimum are divided again. The surroundings
/// include one more sample on each side. Unit: intervals. Too small: minima between samples are
/// missed. Too large: the search takes longer. Test:
/// `every_flat_pose_and_every_upright_one_of_several_turns`.
pub(crate) const FINER: u8 = 16;

/// A sign change belongs to a singular configuration if σ_r at the sign change is below this value.
/// Otherwise the rows or the frame have rotated. Unit: singular value of a matrix of norm one. Too
/// small: singular configurations are missed. Too large: rotations of rows count as singular
/// configurations. Test: `every_flat_pose_and_every_upright_one_of_several_turns`.
pub(crate) const SINGULAR_INSTANT: f64 = 1e-6;

/// If the overlap is below this value, a frame has rotated too far for a comparison of signs. Unit:
/// volume. Too small: signs of rotated frames are compared. Too large: the search takes longer.
/// Test: `two_passages_between_samples_show_in_a_turned_motion`.
pub(crate) const OVERLAP: f64 = 0.5;

/// If a determinant has decreased to this share, it may have become zero twice. Unit: share of the
/// determinant. Too small: pairs of singular configurations are missed. Too large: the search takes
/// longer. Test: `two_passages_between_samples_show_in_a_small_determinant`.
pub(crate) const MAY_PASS: f64 = 0.1;

/// Maximum number of halvings of an interval between samples. Unit: halvings. Too small: singular
/// configurations close to each other are missed. Too large: the search takes longer. Test:
/// `passages_are_found_that_are_two_thousandths_apart`.
pub(crate) const SAMPLE_HALVINGS: usize = 8;

/// Between two samples, the distance of C from its first value is at most this factor times the
/// distance between the samples. A motion is nearly straight between samples. Unit: 1. Too small:
/// singular configurations of curved motions are missed. Too large: the search takes longer. Test:
/// `noise_in_the_states_blurs_the_time_by_as_much`.
pub(crate) const BENT: f64 = 2.0;

/// The directions of the regular motion are computed at this share of the nearly singular interval
/// away from the instant. Unit: share of the nearly singular interval. Too small: the directions
/// are those of the singular configuration. Too large: the directions are those of a distant
/// configuration. Test: `a_pendulum_beside_the_cranks`.
pub(crate) const BESIDE_PASSAGE: f64 = 1e-2;

/// A minimum must be below this share of the larger of its two neighbours. Unit: share of the
/// larger neighbour. Too small: shallow minima are missed. Too large: a rounding error counts as a
/// minimum. Test: `a_minimum_lies_a_hundredth_below_a_neighbour`.
pub(crate) const MINIMUM_LOWER: f64 = 0.99;

/// Number of printed digits of a time that a search has found. The accuracy of such a time is the
/// accuracy of the motion, which is little better than the tolerance of the run. Unit: digits. Too
/// small: different times look the same. Too large: inaccurate digits are printed. Test:
/// `a_motion_that_turns_back_between_two_samples_passes_twice`.
pub(crate) const SEARCHED_DIGITS: usize = 7;

/// Number of printed digits of a time that is given by a function of the scene. Unit: digits. Too
/// small: different times look the same. Too large: inaccurate digits are printed. Test:
/// `a_rest_in_a_singular_pose_is_a_stretch`.
pub(crate) const GIVEN_DIGITS: usize = 10;

// Second order.

/// Maximum number of new motions for which the analysis attempts to prove that they are blocked.
/// The quadratic forms need Γ for each pair of motions. Unit: motions. Too small: blocked motions
/// count as free. Too large: the analysis takes longer. Test:
/// `a_blocked_freedom_beside_many_others`.
pub(crate) const FORMS_MAX: usize = 32;

/// Maximum number of new motions among which the analysis searches for branches. Unit: motions. Too
/// small: uniqueness is undecided. Too large: the time doubles with each motion. Test:
/// `what_is_not_decided_is_said`.
pub const KERNEL_MAX: usize = 4;

/// Permitted residual of the given motion in the quadratic equations, as a share of their
/// coefficients. The directions of the motion may come from neighbouring configurations. Unit:
/// share of the coefficients. Too small: motions next to a singular configuration are rejected. Too
/// large: wrong motions are examined. Test: `forms_are_of_a_motion_and_no_rounding`.
pub(crate) const REGULAR: f64 = 1e-6;

/// Error bound of the coefficients of the forms. Unit: 1. Too small: a rounding error of the forms
/// counts as a proof. Too large: blocked motions are undecided. Test:
/// `a_proof_contains_the_motion_by_rounding_only`.
pub(crate) const FORM_NOISE: f64 = 1e-9;

/// G must exceed this multiple of the identity if the combination w has norm one. Unit: multiples
/// of the identity. Too small: a rounding error counts as a proof. Too large: blocked motions are
/// undecided. Test: `a_definite_form_blocks_from_its_margin_on`.
pub(crate) const MARGIN: f64 = 1e-5;

/// Maximum number of corrections of w. Unit: corrections. Too small: blocked motions are undecided.
/// Too large: the analysis takes longer. Test: `narrow_proofs_are_found`.
pub(crate) const BLOCKED_CORRECTIONS: usize = 1000;

/// Largest number of unknowns for which a covering of the sphere is attempted. The number of boxes
/// grows exponentially with the number of unknowns. Unit: unknowns. Too small: locked mechanisms
/// are undecided. Too large: the analysis takes longer. Test: `four_unknowns_are_covered`.
pub(crate) const COVERED_UNKNOWNS: usize = 4;

/// Maximum number of boxes of a covering. Unit: boxes. Too small: locked mechanisms are undecided.
/// Too large: the analysis takes longer. Test: `four_unknowns_are_covered`.
pub(crate) const BOXES: usize = 100_000;

/// Maximum number of halvings of a box. A smaller box cannot be distinguished from a point because
/// of rounding. Unit: halvings. Too small: nearly common zeros are undecided. Too large: the
/// analysis takes longer. Test: `nearly_common_zeros_are_told_apart`.
pub(crate) const BOX_HALVINGS: i32 = 50;

/// A quadratic form counts as a combination of other forms if the remainder is below this multiple
/// of the error of its coefficients. Unit: multiples of the error of a coefficient. Too small:
/// combinations of rounding are tried. Too large: forms that exclude a zero are omitted. Test:
/// `nearly_dependent_forms_are_used`.
pub(crate) const DEPENDENT_FORMS: f64 = 1e3;

/// The remainder of a form is rounding if, for each unknown, it is below this multiple of the error
/// of the coefficients of the form. Unit: multiples of the error of a coefficient. Too small:
/// dependent forms leave zeros undecided. Too large: a zero of the other forms counts as a zero of
/// a form that is not zero at this point. Test: `a_form_above_its_error_is_no_rounding`.
pub(crate) const FORMS_OF_ROUNDING: f64 = 8.0;

/// Number of starts of the search for a transversal zero. Unit: starts. Too small: free motions are
/// undecided. Too large: the analysis takes longer. Test: `three_unknowns`.
pub(crate) const TRANSVERSAL_STARTS: usize = 60;

/// A singular value of a projection is one or zero. A computed value above this limit counts as
/// one. Unit: 1. Too small: a rounding error counts as a set of bodies. Too large: a set of bodies
/// is omitted. Test: `a_blocked_freedom_beside_many_others`.
pub(crate) const OWN_SHARE: f64 = 0.5;

/// Number of iterations from one start. Convergence to a simple solution is quadratic. Unit:
/// iterations. Too small: branches are not found. Too large: the analysis takes longer. Test:
/// `a_branch_differs_from_the_motion_by_a_thousandth`.
pub(crate) const BRANCH_ITERATIONS: usize = 60;

/// Largest residual of a solution of the equations. Unit: 1. Too small: branches are rejected
/// because of rounding. Too large: vectors that are not solutions count as branches. Test:
/// `a_branch_meets_its_equations_to_rounding`.
pub(crate) const BRANCH_RESIDUAL: f64 = 1e-12;

/// A solution belongs to another branch if its new motions exceed this value. For driven
/// mechanisms, the rate of time is included. Unit: share of the motion. Too small: the given motion
/// counts as another branch. Too large: branches are missed. Test:
/// `a_branch_differs_from_the_motion_by_a_thousandth`.
pub(crate) const OTHER_BRANCH: f64 = 1e-3;

/// Number of starts for each expected branch. Unit: starts. Too small: branches are missed. Too
/// large: the analysis takes longer. Test: `branches_nearer_than_a_thousandth_are_one`.
pub(crate) const BRANCH_STARTS: usize = 40;

/// Solutions whose distance is smaller are the same solution. Unit: share of the motion. Too small:
/// one branch counts twice. Too large: two branches count as one. Test:
/// `branches_nearer_than_a_thousandth_are_one`.
pub(crate) const SAME_BRANCH: f64 = 1e-6;

/// A coefficient is a sum of terms. A sum below this share of its terms is a rounding error. Unit:
/// share of the terms. Too small: a rounding error counts as a coefficient. Too large: small
/// coefficients count as zero. Test: `forms_are_of_a_motion_and_no_rounding`.
pub(crate) const FORM_ROUNDING: f64 = 1e-10;

/// Bodies whose velocity is smaller are at rest. Unit: m/s, or the rate of rotation that moves a
/// point of the mechanism by as much. Too small: a rounding error of velocities counts as a motion,
/// and finite reactions are undecided. Too large: moving bodies are reported to have no finite
/// reaction. Test: `bodies_that_move_are_undecided`.
pub(crate) const AT_REST_SPEED: f64 = 1e-12;

/// Loads do work along a freedom if the sum of their terms exceeds this share of the terms. Unit:
/// share of the terms. Too small: the rounding error of loads that cancel counts as a load. Too
/// large: small loads are ignored. Test: `loads_that_cancel_do_not_push`.
pub(crate) const PUSHES: f64 = 1e-9;

/// Forces of a load below this share of its largest force are rounding. For example, gravity has no
/// moment about rods that meet at a centre of mass. Unit: share of the largest force. Too small: a
/// rounding error counts as a load. Too large: small loads are ignored. Test:
/// `rods_that_meet_at_the_centre_of_mass_carry_it`.
pub(crate) const ROUNDING_PUSH: f64 = 1e-12;

// Freedoms.

/// Maximum number of reported motions. Further motions are only counted. Unit: motions. Too small:
/// motions are counted, but not described. Too large: the report is too long to read. Test:
/// `of_many_motions_the_first_are_told`.
pub const MOTIONS_REPORTED: usize = 12;

/// A velocity of length one satisfies a form if the value of the form is below this limit. The
/// limit is above the rounding errors of a null space and far below any velocity of practical
/// interest. Unit: velocity of length one. Too small: freedoms are missed because of rounding. Too
/// large: moving bodies count as resting. Test: `links_of_a_chain_turn_about_their_own_joints`.
pub(crate) const SATISFIED: f64 = 1e-9;

/// A velocity of length one is new if it differs from the chosen velocities by more than this
/// limit. The limit exceeds [`SATISFIED`]. Therefore the rounding errors of several conditions do
/// not count as a free motion. Unit: velocity of length one. Too small: a rounding error counts as
/// a freedom. Too large: freedoms are missed. Test: `links_of_a_chain_turn_about_their_own_joints`.
pub(crate) const NEW_MOTION: f64 = 1e-6;

/// A velocity below this share of the fastest velocity is zero. Rotations are multiplied by the
/// size of the mechanism. The limit covers rounding of a null space. Unit: share of the fastest
/// velocity. Too small: a rounding error counts as a motion. Too large: slow bodies count as
/// resting. Test: `slides_on_slides_move_along_their_axes`.
pub(crate) const AT_REST: f64 = 1e-10;

/// Limit for (joints + bodies) × freedoms² in the search for motions of few joints. Below the
/// limit, the search starts from every joint. Above the limit, the search starts from as many
/// joints as the limit permits. Unit: joints and bodies times freedoms². Too small: motions of few
/// joints are missed. Too large: the analysis takes longer. Test:
/// `the_motion_of_fewest_joints_comes_first`.
pub(crate) const TRIALS: usize = 2_000_000;

// Reactions of a choice, and sensitivity.

/// Error of a number, in rounding errors of the largest multiplier. Each multiplier is scaled by
/// its row. Unit: multiples of the rounding error of the largest multiplier. Too small: rounding
/// errors are printed. Too large: correct digits are not printed. Test:
/// `what_two_roundings_leave_is_zero_and_more_is_not`.
pub(crate) const VALUE_ROUNDINGS: f64 = 4.0;

/// Redundant accelerations agree if they differ by less than this share of their terms. The limit
/// is the rounding error of velocities that satisfy the constraints, with a margin. Unit: share of
/// the terms. Too small: a rounding error counts as a contradiction. Too large: inconsistent
/// equations are solved. Test: `three_cranks_with_least_norm`.
pub(crate) const AGREEMENT: f64 = 1e-9;

/// Number of solutions of the linear system. The first solution contains rounding, and the second
/// solution removes the significant part of this rounding. Unit: solves. Too small: the rounding of
/// the first solution remains. Too large: the computation takes longer. Test:
/// `beam_on_three_springs`.
pub(crate) const CHOICE_SOLVES: usize = 2;

/// Displacement of a datum for sensitivities. A point moves by this share of the size of the
/// mechanism (in long chains: of the size of its links), and a direction rotates by the same number
/// of radians. A good workshop achieves this accuracy. Unit: share of the size of the mechanism, or
/// rad. Too small: reactions that are sensitive to data are not found. Too large: all reactions
/// count as sensitive. Test: `a_beam_by_hand`.
pub const MOVED: f64 = 1e-4;

/// If the smallest singular value of the independent rows (scaled to length one) exceeds this
/// limit, the first order is sufficient for displacements of [`MOVED`]. Unit: singular value. Too
/// small: the printed changes near limit positions are too small. Too large: the computation takes
/// longer. Test: `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const NEAR_LIMIT: f64 = 5e-2;

/// If a number changes by less than this limit to first order, higher orders do not make it
/// sensitive to data. Unit: share of the number or the load. Too small: the computation takes
/// longer. Too large: the printed changes near limit positions are too small. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FIRST_ORDER: f64 = 0.01;

/// Near a limit position, a datum is displaced if it changes a number by at least this share of its
/// largest change. The first order does not show which of these data changes the number most. Unit:
/// share. Too small: the computation takes longer. Too large: a datum that is not displaced changes
/// the number most. Test: `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const ALIKE: f64 = 0.7;

/// One displacement of a datum serves all numbers whose gradients have at least this cosine. Next
/// to a limit position, a change of direction by 0.03 rad multiplies the change of a number several
/// times. Unit: cosine. Too small: some numbers change more for a displacement in their own
/// direction. Too large: the computation takes longer. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const SAME_WAY: f64 = 0.999_999;

/// Maximum number of data that are displaced near a limit position. The data that change a number
/// most are displaced. Unit: data. Too small: a number depends on a datum that is not displaced.
/// Too large: the computation takes longer. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOWED_DATA: usize = 64;

/// Limit for the operations of all displacements: displaced data × corrections × rows × columns².
/// Each correction of each step factors a matrix, and each datum is displaced in both directions.
/// Unit: operations. Too small: large parts near a limit position are computed to first order only.
/// Too large: the computation takes longer. Test: none, work only.
pub(crate) const FOLLOWED_WORK: usize = 1_000_000_000;

/// Number of steps in which the bodies follow a displaced datum. Unit: steps. Too small: the bodies
/// leave their branch. Too large: the computation takes longer. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_STEPS: usize = 8;

/// Length of the first step, as a share of the displacement. The step shows how fast the bodies
/// move. Unit: share. Too small: a rounding error determines the speed of the bodies. Too large: a
/// jump of the speed is not noticed. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_FIRST: f64 = 1e-3;

/// A step has left the branch if it moves the bodies by more than this multiple of the previous
/// step. Unit: multiples. Too small: steps of bodies that approach their limit position count as
/// another branch. Too large: other branches are not noticed. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_JUMP: f64 = 4.0;

/// Maximum number of corrections of a step. Unit: corrections. Too small: configurations near the
/// limit are not reached. Too large: the computation takes longer. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_CORRECTIONS: usize = 12;

/// The iteration ends if a correction is below this value. Unit: share of the size of the
/// mechanism. Too small: rounding errors are corrected. Too large: reactions lose digits. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_END: f64 = 1e-11;

/// A reaction component is sensitive to data if it changes by more than this share of its value, or
/// of the largest load. Unit: share of the number, or of the largest load. Too small: all reactions
/// count as sensitive. Too large: no reaction counts as sensitive. Test: `a_beam_by_hand`.
pub const FRAGILE: f64 = 0.1;

/// Step of the difference quotients for the directions of rows and the reference points of joints,
/// which change with the configuration and the data. Rounding and the square of the step are both
/// far below the changes that a sensitivity shows. Unit: share of the size of the mechanism, or
/// rad. Too small: a rounding error counts as a change. Too large: second-order terms distort the
/// result. Test: `numbers_change_as_those_of_mechanisms_built_with_other_data`.
pub(crate) const SLOPE_STEP: f64 = 1e-5;

/// If a reaction changes by this share of its size or more, the first order does not show how large
/// the change is. The estimate then shows only that no digit of the reaction is correct. Unit:
/// share of the reaction. Too small: estimates of the first order are omitted. Too large: estimates
/// outside the range of the first order are printed. Test: `sentences_are_for_people`.
pub(crate) const BEYOND: f64 = 1.0;

/// From this factor upwards, "several times" would understate the change. Unit: 1. Too small:
/// numbers are not printed. Too large: the sentences exaggerate. Test: `sentences_are_for_people`.
pub(crate) const MANY: f64 = 30.0;

/// A load below this share of m·v²/size is the rounding of a motion without loads. The load
/// m·v²/size stops the bodies within the size of the mechanism. Unit: share of the load that stops
/// the bodies. Too small: a rounding error counts as a load. Too large: small loads count as zero.
/// Test: `a_small_load_beside_a_fast_motion_is_a_load`.
pub(crate) const LOAD_ROUNDING: f64 = 1e-9;

/// Points move by a share of the size of the mechanism, but at most by the same share of this
/// multiple of the reach of the bodies that they join. A chain of a hundred links is manufactured
/// link by link. Therefore the errors of its holes are not a hundred times larger. The limit has no
/// effect on mechanisms of a few bodies. Unit: multiples of the largest distance of the bodies. Too
/// small: short chains are analysed link by link. Too large: long chains count as sensitive. Test:
/// `sensitivities_are_those_of_mechanisms_built_with_other_numbers`.
pub(crate) const PIECE: f64 = 20.0;

/// If the effects of several points differ by less than this factor, the first point is named. An
/// example is two points that coincide. Reactions that depend on the same constraint violation are
/// then named in one sentence. Unit: 1. Too small: several sentences name the same constraint
/// violation. Too large: one sentence combines different constraint violations. Test:
/// `a_beam_by_hand`.
pub(crate) const SAME_EFFECT: f64 = 1.01;

// Memory and text output.

/// Memory of a joint, drive or coupling with its verdict, its components and its name, including
/// the result. Unit: bytes. Too small: memory is exhausted. Too large: runs are rejected. Test:
/// none, work only.
pub(crate) const OF_GROUP: usize = 8_500;

/// Memory of a row with its verdict. Unit: bytes. Too small: memory is exhausted. Too large: runs
/// are rejected. Test: none, work only.
pub(crate) const OF_ROW: usize = 700;

/// Memory of an entry of the matrix of rows, in all of its orderings. Unit: bytes. Too small:
/// memory is exhausted. Too large: runs are rejected. Test: none, work only.
pub(crate) const OF_ENTRY: usize = 350;

/// Memory of a velocity with its body. Unit: bytes. Too small: memory is exhausted. Too large: runs
/// are rejected. Test: none, work only.
pub(crate) const OF_VELOCITY: usize = 340;

/// Number of dense matrices (all rows × all columns) in memory during the analysis of a small
/// mechanism. Unit: matrices. Too small: memory is exhausted. Too large: runs are rejected. Test:
/// none, work only.
pub(crate) const DENSE_MATRICES: usize = 16;

/// Number of dense matrices (all rows × all columns) in memory when the rank of a mechanism of
/// several parts is certified. Unit: matrices. Too small: memory is exhausted. Too large: runs are
/// rejected. Test: none, work only.
pub(crate) const CERTIFIED_MATRICES: usize = 9;

/// Largest distance of a reported point about which the moment of free wrenches vanishes. If free
/// wrenches are couples except for rounding, this point is at infinity. Unit: multiples of the size
/// of the mechanism. Too small: a centre outside the mechanism is not printed. Too large: points
/// without practical interest are printed. Test: `a_couple_has_no_centre`.
pub(crate) const FAR_CENTRE: f64 = 100.0;

/// Forces of free wrenches below this share of the largest force are rounding. Such forces are not
/// used to compute the point about which the moment vanishes. Unit: share of the largest singular
/// value. Too small: points lie at random on a line of action. Too large: points do not belong to
/// the wrenches. Test: `points_of_a_line_are_the_nearest`.
pub(crate) const FREE_FORCE: f64 = 1e-9;

/// Smallest pivot, as a share of the largest remaining entry, in the computation of readable bases
/// of directions. The entries are as accurate as the data, and a small pivot multiplies the errors
/// of the data. Unit: share of the largest entry. Too small: directions of inexact data are wrong.
/// Too large: unique components are still printed separately, but other components become pivots.
/// Test: `what_the_data_miss_is_not_multiplied`.
pub(crate) const SHARE_OF_PIVOT: f64 = 0.1;

/// A component of a self-stress below this share of the largest component is zero, in drawings and
/// in sentences. Such a component is rounding of the dependency. Unit: share of the largest number.
/// Too small: rounding errors are shown. Too large: small numbers are not shown. Test:
/// `far_axes_and_translations_are_told_apart`.
pub(crate) const VISIBLE: f64 = 1e-9;

/// Two bodies move together, or a joint is at a point, if they differ by less than this share of
/// the size of the mechanism. The limit is above the rounding error of a null space and below any
/// distance of joints in a drawing. Unit: share of the size of the mechanism. Too small: one point
/// counts as two. Too large: two points count as one. Test:
/// `a_four_bar_moves_without_its_motor_only`.
pub(crate) const SAME_PLACE: f64 = 1e-6;

/// Maximum number of sets of further bodies for which the axes of rotation are printed. The bodies
/// of a set move together. Unit: sets of bodies. Too small: the text only states that the bodies
/// rotate. Too large: the sentences are too long to read. Test:
/// `few_other_bodies_are_told_with_their_axes`.
pub(crate) const TOLD_MOVEMENTS: usize = 3;

/// Maximum number of sets of joints with different loads whose loads are printed separately. Unit:
/// sets of joints. Too small: loads are not described. Too large: the sentences are too long to
/// read. Test: `few_different_loads_are_told_joint_by_joint`.
pub(crate) const TOLD_LOADS: usize = 3;

/// Maximum number of bodies that a sentence names. Unit: bodies. Too small: bodies are counted, but
/// not named. Too large: the sentences are too long to read. Test:
/// `links_of_a_chain_turn_about_their_own_joints`.
pub(crate) const NAMED_BODIES: usize = 6;

/// Number of names that identify a part in a text. Unit: names. Too small: the names do not
/// identify the part. Too large: the sentences are too long to read. Test:
/// `a_part_is_named_by_its_first_three_joints`.
pub(crate) const FIRST_NAMED: usize = 3;

/// Maximum number of undetermined load components of a set of joints for which the load of each
/// joint is described. Unit: load components. Too small: short lists are omitted. Too large: joints
/// that share all loads are described by a sentence of several lines. Test:
/// `many_loads_are_not_described_joint_by_joint`.
pub(crate) const MANY_LOADS: usize = 5;

/// Maximum number of rows that a label lists completely. For more rows the label contains only the
/// first few. Unit: rows. Too small: rows are counted, but not named. Too large: the labels are too
/// long to read. Test: `eliminations_of_the_robot_are_runs_without_these_rows`.
pub(crate) const NAMED_ROWS: usize = 12;

/// Maximum number of rows that a sentence lists. Unit: rows. Too small: rows are counted, but not
/// named. Too large: the sentences are too long to read. Test:
/// `every_answer_is_that_of_its_session`.
pub(crate) const TELLABLE: usize = 8;

/// Limit below which a minor, or a component of a load, of a self-stress counts as zero, relative
/// to its rows. Unit: dimensionless. Too small: rounding errors create sets of components that
/// cannot be zero together. Too large: weak self-stresses are ignored. Test:
/// `a_weak_component_is_undecided`.
pub(crate) const ZERO_MINOR: f64 = 1e-10;

/// Limit from which a minor of a self-stress is certainly not zero, relative to its rows. Unit:
/// dimensionless. Too small: bounds depend on rounding. Too large: bounds of weak self-stresses are
/// rejected. Test: `a_weak_component_is_undecided`.
pub(crate) const CLEAR_MINOR: f64 = 1e-7;

/// Ratio of a coefficient that is certainly not zero to the accuracy of coefficients. Unit:
/// dimensionless. Too small: bounds depend on the accuracy of the data. Too large: bounds within a
/// tolerance are rejected. Test: `a_weak_component_is_undecided`.
pub(crate) const CLEAR_OF_ZERO: f64 = 10.0;

/// Maximum number of sets of components that are examined for bounds. Unit: sets. Too small: small
/// mechanisms have no bounds. Too large: the request takes long. Test:
/// `too_many_sets_are_refused`.
pub(crate) const ELASTIC_SETS: u64 = 100_000;

/// Number of random sets of compliances that are used if there are too many sets of components.
/// Unit: sets. Too small: the range that is reached is narrow. Too large: the request takes long.
/// Test: `a_range_that_is_reached_is_not_called_bounds`.
pub(crate) const RANDOM_SAMPLES: usize = 200;

/// Square root of the ratio of compliances in the random sets. Unit: dimensionless. Too small: the
/// range that is reached is narrow. Too large: solutions lose digits. Test:
/// `a_range_that_is_reached_is_not_called_bounds`.
pub(crate) const SAMPLED_RATIO: f64 = 1e3;

/// Maximum number of multiplications for the random sets. Unit: multiplications. Too small: large
/// parts have no range. Too large: the request takes long. Test: none, work only.
pub(crate) const SAMPLE_WORK: usize = 2_000_000_000;

/// Logarithm of the largest factor between weights of solutions for which the factor restricts
/// their averages. Unit: natural logarithm. Too small: bounds within a factor are wider than
/// necessary. Too large: weights leave the range of numbers. Test:
/// `large_factors_restrict_nothing`.
pub(crate) const LARGEST_EXPONENT: f64 = 500.0;

/// Largest difference of two leverages that count as equal. Unit: dimensionless. Too small: axes
/// depend on rounding. Too large: axes of different leverages are mixed. Test:
/// `bounds_do_not_depend_on_the_axes_of_the_scene`.
pub(crate) const EQUAL_LEVERAGE: f64 = 1e-6;

/// Maximum number of solutions that are compared for the magnitude of a load. Unit: solutions. Too
/// small: the bound of a magnitude is wider than necessary. Too large: the request takes long.
/// Test: `the_magnitude_is_that_of_a_vertex`.
pub(crate) const MAGNITUDE_POINTS: usize = 100_000;

/// Maximum number of products of solutions for which two blocks of self-stresses with a common load
/// are merged. Unit: products. Too small: ranges depend on the axes of the scene. Too large: the
/// request takes long. Test: `a_common_load_couples_its_components`.
pub(crate) const MERGED_POINTS: usize = 20_000;

/// Maximum number of products of corners and solutions for which the corners of a range of
/// compliances are examined. Unit: products. Too small: the bounds within a factor are wider than
/// necessary. Too large: the request takes long. Test:
/// `bounds_within_a_factor_are_those_of_corners`.
pub(crate) const CORNER_POINTS: usize = 1_000_000;

/// Largest difference of two values at the end of a range that count as equal, relative to the
/// largest value. Unit: dimensionless. Too small: an end is not marked as reached because of
/// rounding. Too large: an end is marked as reached by another solution. Test:
/// `the_middle_of_two_joints_is_not_reached`.
pub(crate) const TIED_ENDS: f64 = 1e-12;

/// Limit below which a weight or a squared residual counts as zero in the test of vertices. Unit:
/// dimensionless. Too small: rounding errors create vertices. Too large: vertices are not found.
/// Test: `vertices_are_separated_and_midpoints_are_not`.
pub(crate) const SEPARATED: f64 = 1e-9;

/// Maximum number of steps of the test of vertices. Unit: steps. Too small: vertices are not found.
/// Too large: the test takes long. Test: `vertices_are_separated_and_midpoints_are_not`.
pub(crate) const SEPARATION_STEPS: usize = 1000;

/// Limit below which the part of a row outside of the rows of another joint counts as zero,
/// relative to the row. Unit: dimensionless. Too small: rounding errors hide weaker joints. Too
/// large: a joint that restricts another motion counts as weaker. Test:
/// `a_weaker_joint_restricts_no_other_motion`.
pub(crate) const SAME_SPAN: f64 = 1e-9;

/// Required part of a released load component that is independent of the other released components,
/// relative to the component. Unit: dimensionless. Too small: replacements leave a mechanism that
/// is nearly redundant. Too large: replacements are not found. Test:
/// `dependent_releases_are_no_replacement`.
pub(crate) const CLEARLY_RELEASED: f64 = 1e-5;

/// Maximum number of steps of the search for replacements of joints. Unit: steps. Too small: the
/// first sets are not the cheapest sets, or no set is found. Too large: the search takes long.
/// Test: `the_search_ends`.
pub(crate) const REPLACEMENT_STEPS: usize = 100_000;

/// Number of sets of replacements that are kept. Unit: sets. Too small: no set is left if the first
/// sets cannot be used. Too large: the search takes longer. Test: none, work only.
pub(crate) const REPLACEMENT_WAYS: usize = 3;

/// Largest difference of two measures of independence that count as equal. Unit: natural logarithm.
/// Too small: a rounding error decides which of two equal sets of replacements comes first. Too
/// large: the first set is less clearly independent than another set. Test:
/// `equal_sets_keep_their_order`.
pub(crate) const TIED_CLEARNESS: f64 = 1e-6;

/// Limit below which the force of a support, or a weight in a proof, counts as zero. Unit: share of
/// the size of the loads, of the largest acceleration or of the largest weight. Too small: a load
/// exactly above an edge of a table has no admissible reactions. Too large: supports that lift
/// slowly count as closed. Test: `a_load_above_an_edge_is_not_outside`.
pub(crate) const SUPPORT_ROUNDING: f64 = 1e-12;

/// A support whose force is at least this limit certainly carries a load. Unit: share of the size
/// of the loads, or of the largest acceleration. Too small: rounding decides which supports lift.
/// Too large: small loads beyond an edge are undecided. Test:
/// `a_load_above_an_edge_is_not_outside`.
pub(crate) const CLEAR_SUPPORT: f64 = 1e-9;

/// Limit of the force with which a contact pulls. Above this limit, the contact certainly pulls. A
/// motion is less accurate than its start. Unit: share of the largest load. Too small: a contact
/// without load is reported to pull. Too large: a contact that begins to pull is reported late.
/// Test: `contacts_that_pull_are_one_warning`.
pub(crate) const CLEAR_PULL: f64 = 1e-6;

/// Maximum number of changes of the set of supports that carry a load. Unit: steps. Too small:
/// mechanisms with many supports have no range. Too large: a search that does not end because of
/// rounding errors takes long. Test: none, work only.
pub(crate) const PIVOTS: usize = 10_000;

/// Limit below which the acceleration of a gap counts as zero. The limit is relative to the largest
/// acceleration without pressing forces or without any other joint. Unit: dimensionless. Too small:
/// contacts that stay closed are reported to open. Too large: a contact that opens slowly is not
/// named. Test: `a_load_beyond_the_edge_lifts_two_legs`.
pub(crate) const OPENING: f64 = 1e-9;

/// Number of sides of the polygon that approximates the circle of a contact with friction in two
/// directions. Unit: sides. Too small: the least friction is computed to few digits. Too large: the
/// linear programs take long. Test: `a_wheel_grips_in_all_directions`.
pub(crate) const GRIP_SIDES: u32 = 32;

/// Accuracy of the least coefficient of friction. Unit: dimensionless. Too small: the search takes
/// long, and rounding decides. Too large: the coefficient differs from that of textbooks. Test:
/// `a_ladder_holds_with_the_friction_of_textbooks`.
pub(crate) const GRIP_ACCURACY: f64 = 1e-10;

/// Largest coefficient of friction that is examined. Unit: dimensionless. Too small: a contact on a
/// steep slope is reported to slip with any friction. Too large: the search takes long. Test: none,
/// work only.
pub(crate) const LARGEST_FRICTION: f64 = 1e6;

/// Limit below which the part of the force of a row across other rows of its contact counts as
/// zero. Unit: dimensionless. Too small: rounding makes a direction of slip. Too large: directions
/// close to each other count as one. Test: `a_wheel_grips_in_all_directions`.
pub(crate) const PARALLEL_SLIP: f64 = 1e-9;
