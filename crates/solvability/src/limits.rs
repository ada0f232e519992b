//! The table of limits: every number of this crate that somebody chose. Each says what it is, in
//! which unit, what breaks if it is wrong (`Less`: if it were smaller, `More`: if it were larger),
//! and which test fails then; `none, work only` if only time or memory change, `none` if there is
//! no test yet. `tests/all/limits.rs` reads it.

// Ranks and certificates.

/// Rows up to which a rank is certified: the work grows with their cube.
/// Unit: rows. Less: ranks of large mechanisms are not certified. More: time. Test:
/// `a_part_is_asked_under_what_the_rest_does_to_it`.
pub(crate) const ROWS_MAX: usize = 600;

/// Rows up to which coefficients are read to a stated tolerance: the work grows with the number of
/// rows times that of dependencies, and with the cube of both.
/// Unit: rows. Less: coefficients are read to rounding only. More: time. Test:
/// `a_component_that_is_none_within_the_tolerance_says_so`.
pub(crate) const TOLERANCE_ROWS: usize = 200;

/// Coefficients that are larger belong to their dependency beyond doubt.
/// Unit: coefficient of the equilibrated dependencies. Less: coefficients that the data could make
/// zero are believed. More: time. Test:
/// `data_are_asked_about_small_coefficients_that_are_no_noise`.
pub(crate) const COEFFICIENT_LARGE: f64 = 1e-3;

/// Coefficients below this share of their noise are zero beyond doubt.
/// Unit: share of the noise. Less: time. More: coefficients that the data could make large are
/// called zero. Test: `data_are_asked_about_small_coefficients_that_are_no_noise`.
pub(crate) const SAFELY: f64 = 0.1;

/// Coefficients of which it is asked what the rounding of the data makes of them.
/// Unit: coefficients. Less: coefficients near their noise are undecided. More: time. Test: none.
pub(crate) const ASKED: usize = 2_000;

/// Sets of more rows are decided sparsely.
/// Unit: rows. Less: small sets lose their singular values. More: time. Test: none.
pub(crate) const SPARSE_FROM: usize = 150;

/// Combinations beyond the rows of the largest joint.
/// Unit: combinations. Less: a rank is read from too few. More: time. Test:
/// `random_combinations_show_the_rank_of_the_largest_joint`.
pub(crate) const SPARE_COMBINATIONS: usize = 4;

/// A mechanism of at most so many rows is one part, whatever its cycles: all of its verdicts are
/// then read from one null space, and it can be compared with itself at other configurations, which
/// takes matrices of all rows and columns.
/// Unit: rows. Less: small mechanisms are not compared with themselves elsewhere. More: time: it
/// grows with their cube, and 600 rows take half a minute. Test:
/// `a_motor_that_lags_behind_is_named_with_the_joints_between`.
pub const ONE_PART: usize = 250;

/// Vectors of the left null space from which verdicts are read along a motion: a redundancy up to
/// this is read whole, a larger one from as many random combinations.
/// Unit: vectors. Less: a coefficient is read from so few combinations that they may cancel. More:
/// time at each step and row. Test: `many_dependencies_are_read_from_few_combinations`.
pub const CARRIED_VECTORS: usize = 8;

/// By how much singular values must clear the tolerance: runs of the stress matrix keep their
/// digits from a factor of thirty on.
/// Unit: multiples of the tolerance. Less: digits of the motion are lost. More: motions near
/// singular poses are refused. Test: none.
pub(crate) const MOTION_CLEARANCE: f64 = 30.0;

/// Data are known to several roundings, the numbers of a motion to one.
/// Unit: roundings of data. Less: the rank of a motion is read below its rounding. More: redundant
/// rows near singular poses are doubted. Test: none.
pub(crate) const ONE_ROUNDING: f64 = f64::EPSILON / 2.0 / model::ROUNDING;

/// Entries of the map from multipliers to a reaction are products of a few numbers near one; below
/// this share of the largest row a row is their rounding.
/// Unit: share of the largest row. Less: rounding is a component of a reaction. More: small
/// components are none. Test: none.
pub(crate) const ROUNDING_OF_MAP: f64 = 1e-14;

/// What the first order says of larger angles (rad) means nothing.
/// Unit: rad. Less: coarse angles decide nothing. More: the first order is asked too much. Test:
/// none.
pub(crate) const LARGEST_TURN: f64 = 0.1;

/// A part of a unit vector above this is reported, whatever a stated tolerance makes of it: without
/// it the direction is another one.
/// Unit: part of a unit vector. Less: small parts are none. More: rounding is reported. Test:
/// `a_part_of_a_direction_is_told_however_uncertain_coefficients_are`.
pub(crate) const LARGEST_ROUNDING: f64 = 1e-5;

// The intended mechanism.

/// From this singular value on no rounding explains a lower rank in a matrix of size one: near a
/// singular pose, where a singular value moves with the root of the data, it would have to be below
/// √(3·eps) times a few.
/// Unit: singular value of a matrix of size one. Less: rounding decides a rank. More: poses near
/// singular ones are asked at length. Test: none.
pub(crate) const CLEAR_OF_ROUNDING: f64 = 1e-6;

/// The same as a multiple of what the entries are known to, where that is larger.
/// Unit: multiples of the noise. Less: noise decides a rank. More: poses near singular ones are
/// asked at length. Test: none.
pub(crate) const CLEAR_OF_NOISE: f64 = 1e3;

/// Share of a singular value in f64 that double-double has to confirm.
/// Unit: share of a singular value. Less: rounding of `f64` is believed. More: ranks are not
/// confirmed. Test: `a_door_turns_within_its_tolerance`.
pub(crate) const CONFIRMED: f64 = 0.1;

/// A lower rank is reported where the data are nearer to it than this share of the size.
/// Unit: share of the size. Less: near redundancy is not reported. More: sound mechanisms are said
/// to be near it. Test: `a_dead_centre_is_a_pose_and_no_redundancy`.
pub(crate) const NEAR_TOLD: f64 = 1e-3;

/// Equations of the first order are wrong by the square of the change, as a share of the size,
/// times this: the change that serves all poses is up to ten times that of one entry, and second
/// derivatives are of the order of ten where links are short.
/// Unit: 1. Less: the first order is believed too far. More: near redundancy is not proved. Test:
/// `a_dead_centre_is_a_pose_and_no_redundancy`.
pub(crate) const CURVED: f64 = 100.0;

/// Positions on a walk are met to this share of the size.
/// Unit: share of the size. Less: walks do not arrive. More: poses are off the constraints. Test:
/// `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const WALKED: f64 = 1e-12;

/// A weakest entry above this share of the size of C belongs to no change of data below a
/// thousandth of the size: an entry changes by its own size, times what the pose answers, which is
/// below the inverse of the entry.
/// Unit: share of the size of C. Less: near redundancy is not asked for. More: time. Test:
/// `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const CLEAR_ENTRY: f64 = 0.1;

/// A dependency whose nonholonomic rows weigh less than this share of the others is one of
/// positions.
/// Unit: share of the weights. Less: dependencies of positions are asked at one pose only. More:
/// those of velocities are asked at other poses. Test: none.
pub(crate) const HOLONOMIC: f64 = 1e-6;

/// Singular vectors below this share of the largest singular value are rounding and need not be
/// orthogonal to the others.
/// Unit: share of the largest singular value. Less: rounding has to be orthogonal. More: small
/// singular vectors are not. Test: `singular_vectors_of_rounding_are_replaced`.
pub(crate) const RESOLVED: f64 = 1e-13;

/// Entries of one pose that are asked to vanish: pairs of this many left and right directions, the
/// weakest first. More would be exact zeros next to the near one; leaving them out can only make
/// the share smaller.
/// Unit: pairs. Less: a share is too small. More: time, and exact zeros are asked for. Test:
/// `an_angle_tolerance_counts_alone`.
pub(crate) const PAIRS: usize = 4;

/// Rounding of an entry of a scaled C between unit vectors, in units of eps·√(m·n).
/// Unit: eps·√(m·n). Less: rounding of an entry is a change of data. More: shares are too small.
/// Test: `a_misfit_above_the_rounding_of_entries_is_one_of_data`.
pub(crate) const ENTRY_ROUNDINGS: f64 = 16.0;

/// Poses to each side.
/// Unit: poses. Less: redundancy of one pose is called permanent. More: time. Test:
/// `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const WALK_POSES: usize = 3;

/// From one pose to the next: a share of the size, or radians. Short, so that the walk does not
/// pass a singular pose onto another branch.
/// Unit: share of the size, or rad. Less: poses are nearly the same. More: walks pass onto other
/// branches. Test: `a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on`.
pub(crate) const WALK_REACH: f64 = 0.05;

/// Steps from one pose to the next.
/// Unit: steps. Less: walks do not arrive. More: time. Test:
/// `a_dead_centre_is_a_pose_and_no_redundancy`.
pub(crate) const WALK_STEPS: usize = 5;

/// The same where such steps do not arrive.
/// Unit: steps. Less: walks near singular poses do not arrive. More: time. Test: none.
pub(crate) const WALK_SMALL_STEPS: usize = 40;

/// The largest correction of a step onto the kept rows, as a share of the step: what is corrected
/// by more may be on another branch.
/// Unit: share of the step. Less: walks along curved ways end. More: walks change the branch. Test:
/// `rows_that_are_nearly_redundant_at_a_pose_are_left_out_together`.
pub(crate) const WALK_CORRECTED: f64 = 0.5;

/// The condition of Newton and Kantorovich for a pose of a walk: with data anywhere within the
/// stated tolerance the mechanism has a pose there.
/// Unit: 1. Less: what a tolerance makes redundant is undecided. More: poses count that the
/// intended mechanism does not have, and permanent redundancy is called full rank. Test:
/// `bricard_with_few_digits_is_right_or_undecided`.
pub(crate) const KNOWN_POSE: f64 = 0.5;

/// Share of the other directions.
/// Unit: share of a direction. Less: freedoms stand still. More: the way is that of all freedoms.
/// Test: `a_way_is_led_by_one_freedom_and_takes_the_others_along`.
pub(crate) const OTHER_DIRECTIONS: f64 = 0.3;

/// Iterations at most. Each costs a solution of as many equations as there are.
/// Unit: iterations. Less: bounds of the share are wide. More: time. Test:
/// `one_equation_is_shared_by_all`.
pub(crate) const CONE_ITERATIONS: usize = 60;

/// The bounds are close enough if they differ by this factor.
/// Unit: 1. Less: time. More: bounds of the share are wide. Test:
/// `a_point_has_one_change_in_both_directions`.
pub(crate) const CONE_CLOSE: f64 = 1.05;

/// An equation may miss by this share of its coefficients: near the root of eps the normal
/// equations do not tell contradicting equations from agreeing ones, and no share is wanted to more
/// digits.
/// Unit: share of the coefficients. Less: equations that agree contradict each other. More:
/// equations that contradict each other agree. Test: `what_no_change_satisfies_is_far_away`.
pub(crate) const CONE_RESOLVED: f64 = 1e-5;

/// No weight falls below this share of the largest: changes that are not needed stay available.
/// Unit: share of the largest weight. Less: normal equations lose their digits. More: changes that
/// are not needed remain. Test: `numbers_that_need_no_change_stay_out_of_the_bounds`.
pub(crate) const LEAST_WEIGHT: f64 = 1e-9;

/// The difference of two results that agree, as a share of the size: what nonholonomic rows hold is
/// met by nothing later, and must not be lost by steps that are too long.
/// Unit: share of the size. Less: steps become too small. More: nonholonomic rows are lost. Test:
/// `what_edges_lead_stays_on_its_way`.
pub(crate) const FOLLOWED: f64 = 1e-12;

// Other configurations.

/// Points compared.
/// Unit: configurations. Less: chance calls redundancy permanent. More: time. Test:
/// `cranks_are_compared_with_themselves_elsewhere`.
pub(crate) const POINTS: usize = 4;

/// Walks at most, also those that lead nowhere.
/// Unit: walks. Less: too few configurations are found. More: time. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const WALKS: usize = 12;

/// Steps from one point to the next.
/// Unit: steps. Less: configurations are near the given one. More: time. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const GENERIC_STEPS: usize = 4;

/// Length of a step: a share of the mechanism's size, or as many radians.
/// Unit: share of the size, or rad. Less: configurations are near the given one. More:
/// configurations cannot be assembled. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const GENERIC_STEP: f64 = 0.2;

/// A step is tried at this many halved lengths, because not every displacement can be assembled
/// again.
/// Unit: halvings. Less: walks end at once. More: time. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const GENERIC_HALVINGS: i32 = 5;

/// A step is refused if the constraints correct it by more than this share of its length: it leads
/// to another branch, whose rank says nothing of this one.
/// Unit: share of the step. Less: branches that curve are not followed. More: other branches are
/// compared. Test: `legs_that_stay_parallel_are_not_compared_with_those_that_do_not`.
pub(crate) const GENERIC_STRAYED: f64 = 0.3;

/// Rows that are redundant at a configuration and miss by less than this share of their terms
/// after a step on the others are redundant there, too.
/// Unit: share of the terms. Less: rounding is a miss. More: rows that part count as redundant.
/// Test: `legs_that_stay_parallel_are_not_compared_with_those_that_do_not`.
pub(crate) const GENERIC_HOLDS: f64 = 1e-12;

/// Points must be this far from each other and from the given one, in the same measure.
/// Unit: share of the size, or rad. Less: the same configuration is asked twice. More: too few
/// configurations are found. Test:
/// `a_drive_that_is_redundant_at_the_start_alone_contradicts_nothing_later`.
pub(crate) const POINTS_APART: f64 = 0.1;

// Drives that cannot go on.

/// Step along the curve of configurations towards the place where drives cannot go on.
/// Unit: share of the size, or rad. Less: the place is not reached. More: corrections lead to
/// another branch. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_STEP: f64 = 0.02;

/// Such steps: a run that stops there stands before it.
/// Unit: steps. Less: the place is not reached. More: places that did not stop the run are blamed.
/// Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_STEPS: usize = 20;

/// Corrections of a point of the curve, at most: each doubles its digits.
/// Unit: corrections. Less: points far from their tangent are not reached. More: time. Test:
/// `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_CORRECTIONS: usize = 12;

/// A shorter correction has arrived.
/// Unit: share of the size, or rad. Less: rounding is corrected without end. More: the place has
/// few digits. Test: `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_ARRIVED: f64 = 1e-11;

/// Halvings of the last step.
/// Unit: halvings. Less: the place has few digits. More: time. Test:
/// `a_winch_stops_where_its_bar_is_stretched`.
pub(crate) const LIMIT_HALVINGS: usize = 40;

/// Shares of the largest part below this are rounding, of drives, of time and of curvatures.
/// Unit: share. Less: rounding is a drive. More: a drive is left out. Test:
/// `branches_that_meet_are_no_limit`.
pub(crate) const LIMIT_ROUNDING: f64 = 1e-6;

/// Free velocities there, at most: the curvature of more is not examined.
/// Unit: velocities. Less: drives of mechanisms with a free motion are not named. More: curvatures
/// are not examined. Test: `a_free_arm_reaches_as_far_as_it_is_long`.
pub(crate) const LIMIT_FORMS: usize = 12;

// Drives that contradict each other.

/// Positions after the start at which drives are compared along a motion.
/// Unit: positions. Less: contradictions later on are not found. More: time. Test:
/// `motors_that_part_later_are_named_with_the_time`.
pub(crate) const DRIVE_POSITIONS: u32 = 12;

/// What drives may change by from one position to the next (rad, or as a share of the size of the
/// mechanism): a larger step may end on another branch of the joints, where drives that agree do
/// not.
/// Unit: rad, or share of the size. Less: time. More: a step ends on another branch. Test:
/// `agreeing_motors_are_followed_through_flat_poses`.
pub(crate) const STRIDE: f64 = 0.1;

/// Steps on the way at most: a dozen revolutions. What comes later is not known.
/// Unit: steps. Less: what comes after few revolutions is not known. More: time. Test:
/// `agreeing_motors_are_followed_through_flat_poses`.
pub(crate) const DRIVE_STEPS: usize = 800;

/// A step that fails is halved so often at most: what is reached by smaller ones only is too near
/// to a singular configuration to be followed.
/// Unit: halvings. Less: motions near singular poses are not followed. More: time. Test:
/// `agreeing_motors_are_followed_through_flat_poses`.
pub(crate) const DRIVE_HALVINGS: usize = 6;

/// Share of their terms by which drives must differ before a run stops for it with certainty (runs
/// compare to 1e-11, divided by pivots).
/// Unit: share of the terms. Less: rounding contradicts. More: runs stop for what was not reported.
/// Test: `small_differences_are_told_at_their_time`.
pub(crate) const RUNS_NOTICE: f64 = 1e-9;

// Motions along time.

/// Halvings that bring any interval to rounding, and more.
/// Unit: iterations. Less: times are not found to rounding. More: time, where nothing is found.
/// Test: `roots_to_rounding_also_multiple_ones`.
pub(crate) const SEARCH_ITERATIONS: usize = 120;

/// Intervals are not divided below this share of their times.
/// Unit: share of a time. Less: time. More: instants lose digits. Test:
/// `roots_to_rounding_also_multiple_ones`.
pub(crate) const RESOLUTION: f64 = 2.0 * f64::EPSILON;

/// Where an edge is found to this share of its interval, one reads no more digits.
/// Unit: share of the interval. Less: time. More: edges of stretches lose digits. Test:
/// `edges_from_both_sides`.
pub(crate) const EDGE: f64 = 1e-10;

/// A convex function with these values around its minimum lies above `least − 1.62·(largest −
/// least)` where it was asked at golden sections; the rest is room for functions that are not
/// convex.
/// Unit: 1. Less: minima are missed. More: time. Test: `minima_of_corners_and_parabolas`.
pub(crate) const FALL: f64 = 4.0;

/// A function that reaches a limit within an interval comes as near to it as this power of the
/// width of the interval, at least: a square root does with 0.5; a jump stays where it is.
/// Unit: 1. Less: time, at jumps. More: steep minima are missed. Test:
/// `minima_of_corners_and_parabolas`.
pub(crate) const NARROWING: f64 = 0.25;

/// A sample that is singular relative to the best one of the motion is not regular, whatever its
/// value.
/// Unit: share of the largest singular value. Less: samples near a singular pose are regular. More:
/// motions without regular samples. Test: `a_motion_near_a_singular_pose_has_regular_samples`.
pub(crate) const REGULAR_SAMPLE: f64 = 0.1;

/// A minimum, with a sample more on each side, is divided once more into so many intervals.
/// Unit: intervals. Less: minima between samples are missed. More: time. Test:
/// `every_flat_pose_and_every_upright_one_of_several_turns`.
pub(crate) const FINER: u8 = 16;

/// A sign change belongs to a singular configuration if σ_r is below this there; otherwise rows or
/// frame have turned.
/// Unit: singular value of a matrix of size one. Less: passages are missed. More: rows that turn
/// are passages. Test: `every_flat_pose_and_every_upright_one_of_several_turns`.
pub(crate) const SINGULAR_INSTANT: f64 = 1e-6;

/// A frame has turned too far to compare signs if its overlap is below this.
/// Unit: volume. Less: signs of turned frames are compared. More: time. Test:
/// `two_passages_between_samples_show_in_a_turned_motion`.
pub(crate) const OVERLAP: f64 = 0.5;

/// A determinant that has fallen to this share may have passed zero twice.
/// Unit: share of the determinant. Less: double passages are missed. More: time. Test:
/// `two_passages_between_samples_show_in_a_small_determinant`.
pub(crate) const MAY_PASS: f64 = 0.1;

/// An interval between samples is halved as often at most.
/// Unit: halvings. Less: passages near each other are missed. More: time. Test:
/// `passages_are_found_that_are_two_thousandths_apart`.
pub(crate) const SAMPLE_HALVINGS: usize = 8;

/// Between two samples C is no farther from the first than this times their distance: a motion is
/// nearly straight there.
/// Unit: 1. Less: passages of curved motions are missed. More: time. Test:
/// `noise_in_the_states_blurs_the_time_by_as_much`.
pub(crate) const BENT: f64 = 2.0;

/// Directions of the regular motion are those at this share of the nearly singular interval next to
/// the instant.
/// Unit: share of the nearly singular interval. Less: directions are those of the singular pose.
/// More: directions are those of elsewhere. Test: `a_pendulum_beside_the_cranks`.
pub(crate) const BESIDE_PASSAGE: f64 = 1e-2;

/// What a minimum must be lower than the larger neighbour by.
/// Unit: share of the larger neighbour. Less: shallow minima are missed. More: rounding is a
/// minimum. Test: `a_minimum_lies_a_hundredth_below_a_neighbour`.
pub(crate) const MINIMUM_LOWER: f64 = 0.99;

/// Digits of a time that was searched for: it is known as well as the motion, which a run knows to
/// little more than its tolerance.
/// Unit: digits. Less: times that differ look the same. More: digits that are not known are shown.
/// Test: `a_motion_that_turns_back_between_two_samples_passes_twice`.
pub(crate) const SEARCHED_DIGITS: i32 = 7;

/// Digits of a time that a function of the scene gives.
/// Unit: digits. Less: times that differ look the same. More: digits that are rounding are shown.
/// Test: `a_rest_in_a_singular_pose_is_a_stretch`.
pub(crate) const GIVEN_DIGITS: i32 = 10;

// Second order.

/// New motions for which a proof that they are blocked is sought: the forms need Γ for each pair.
/// Unit: motions. Less: blocked motions are called free. More: time. Test:
/// `a_blocked_freedom_beside_many_others`.
pub(crate) const FORMS_MAX: usize = 32;

/// New motions among which branches are sought.
/// Unit: motions. Less: uniqueness is undecided. More: time: it doubles with each. Test:
/// `what_is_not_decided_is_said`.
pub const KERNEL_MAX: usize = 4;

/// The given motion may miss the equations by this share of their coefficients: its directions may
/// come from neighbouring configurations.
/// Unit: share of the coefficients. Less: motions next to a singular pose are doubted. More: wrong
/// motions are examined. Test: `forms_are_of_a_motion_and_no_rounding`.
pub(crate) const REGULAR: f64 = 1e-6;

/// Coefficients of the forms may be wrong by this.
/// Unit: 1. Less: rounding of the forms is a proof. More: blocked motions are undecided. Test:
/// `a_proof_contains_the_motion_by_rounding_only`.
pub(crate) const FORM_NOISE: f64 = 1e-9;

/// G must exceed this multiple of the identity; the combination w has size one.
/// Unit: multiples of the identity. Less: rounding is a proof. More: blocked motions are undecided.
/// Test: `a_definite_form_blocks_from_its_margin_on`.
pub(crate) const MARGIN: f64 = 1e-5;

/// Corrections of w at most.
/// Unit: corrections. Less: blocked motions are undecided. More: time. Test:
/// `narrow_proofs_are_found`.
pub(crate) const BLOCKED_CORRECTIONS: usize = 1000;

/// Unknowns up to which a covering of the sphere is tried; the number of boxes is a power of it.
/// Unit: unknowns. Less: locked mechanisms are undecided. More: time. Test:
/// `four_unknowns_are_covered`.
pub(crate) const COVERED_UNKNOWNS: usize = 4;

/// Boxes of a covering at most.
/// Unit: boxes. Less: locked mechanisms are undecided. More: time. Test:
/// `four_unknowns_are_covered`.
pub(crate) const BOXES: usize = 100_000;

/// Halvings of a box at most: below, all is rounding.
/// Unit: halvings. Less: nearly common zeros are undecided. More: time. Test:
/// `nearly_common_zeros_are_told_apart`.
pub(crate) const BOX_HALVINGS: i32 = 50;

/// A form belongs to the combinations of the others if what is left of it is below so many times
/// the error of its coefficients.
/// Unit: errors of a coefficient. Less: combinations of rounding are tried. More: forms that
/// exclude a zero are left out. Test: `nearly_dependent_forms_are_used`.
pub(crate) const DEPENDENT_FORMS: f64 = 1e3;

/// What is left of a form is rounding below so many times the error of its coefficients, for each
/// unknown.
/// Unit: errors of a coefficient. Less: dependent forms leave zeros undecided. More: a zero of the
/// others is one of a form that has none. Test: `a_form_above_its_error_is_no_rounding`.
pub(crate) const FORMS_OF_ROUNDING: f64 = 8.0;

/// Starts of the search for a transversal zero.
/// Unit: starts. Less: free motions are undecided. More: time. Test: `three_unknowns`.
pub(crate) const TRANSVERSAL_STARTS: usize = 60;

/// A singular value of a projection is one or zero; above this it is one.
/// Unit: 1. Less: rounding is a set of bodies. More: a set of bodies is lost. Test:
/// `a_blocked_freedom_beside_many_others`.
pub(crate) const OWN_SHARE: f64 = 0.5;

/// Iterations from one start; convergence to a simple solution is quadratic.
/// Unit: iterations. Less: branches are not found. More: time. Test:
/// `a_branch_differs_from_the_motion_by_a_thousandth`.
pub(crate) const BRANCH_ITERATIONS: usize = 60;

/// A solution meets the equations to this.
/// Unit: 1. Less: rounding refuses branches. More: what is no branch is one. Test:
/// `a_branch_meets_its_equations_to_rounding`.
pub(crate) const BRANCH_RESIDUAL: f64 = 1e-12;

/// A solution belongs to another branch if its new motions (and, driven, its rate of time) exceed
/// this.
/// Unit: share of the motion. Less: the given motion is another branch. More: branches are missed.
/// Test: `a_branch_differs_from_the_motion_by_a_thousandth`.
pub(crate) const OTHER_BRANCH: f64 = 1e-3;

/// Starts for each expected branch.
/// Unit: starts. Less: branches are missed. More: time. Test:
/// `branches_nearer_than_a_thousandth_are_one`.
pub(crate) const BRANCH_STARTS: usize = 40;

/// Solutions nearer to each other than this are one.
/// Unit: share of the motion. Less: one branch counts twice. More: two branches count as one.
/// Test: `branches_nearer_than_a_thousandth_are_one`.
pub(crate) const SAME_BRANCH: f64 = 1e-6;

/// Coefficients below this share of the terms that they are sums of are rounding.
/// Unit: share of the terms. Less: rounding is a coefficient. More: small coefficients are none.
/// Test: `forms_are_of_a_motion_and_no_rounding`.
pub(crate) const FORM_ROUNDING: f64 = 1e-10;

/// Bodies that are slower stand still.
/// Unit: m/s, or the rate of rotation that moves a point of the mechanism by as much. Less:
/// rounding of velocities is a motion, and finite reactions are undecided. More: what moves is said
/// to have no finite reaction. Test: `bodies_that_move_are_undecided`.
pub(crate) const AT_REST_SPEED: f64 = 1e-12;

/// Loads push along a freedom if their sum is above this share of their terms.
/// Unit: share of the terms. Less: rounding of loads that cancel pushes. More: small loads do not
/// count. Test: `loads_that_cancel_do_not_push`.
pub(crate) const PUSHES: f64 = 1e-9;

/// Forces of a load below this share of the largest are its rounding: where rods meet at a centre
/// of mass, gravity turns nothing.
/// Unit: share of the largest force. Less: rounding pushes. More: small loads push nothing. Test:
/// `rods_that_meet_at_the_centre_of_mass_carry_it`.
pub(crate) const ROUNDING_PUSH: f64 = 1e-12;

// Freedoms.

/// Motions that are reported; of the others there is a count.
/// Unit: motions. Less: motions are counted only. More: sentences nobody reads. Test:
/// `of_many_motions_the_first_are_told`.
pub const MOTIONS_REPORTED: usize = 12;

/// A velocity of length one satisfies a form below this: rounding of a null space, far below any
/// freedom that is worth a word.
/// Unit: velocity of length one. Less: freedoms are missed by rounding. More: what moves is at
/// rest. Test: `links_of_a_chain_turn_about_their_own_joints`.
pub(crate) const SATISFIED: f64 = 1e-9;

/// A velocity of length one is new if it differs from the chosen ones by more than this. Above
/// [`SATISFIED`], so that what is left by rounding of several conditions is not taken for a
/// freedom.
/// Unit: velocity of length one. Less: rounding is a freedom. More: freedoms are missed. Test:
/// `links_of_a_chain_turn_about_their_own_joints`.
pub(crate) const NEW_MOTION: f64 = 1e-6;

/// A velocity is zero below this share of the fastest one, rotations measured at the size of the
/// mechanism: rounding of a null space.
/// Unit: share of the fastest velocity. Less: rounding moves. More: slow bodies are at rest. Test:
/// `slides_on_slides_move_along_their_axes`.
pub(crate) const AT_REST: f64 = 1e-10;

/// Joints and bodies × freedoms² up to which a motion of few joints is looked for from every joint;
/// beyond, from as many as this allows.
/// Unit: joints and bodies times freedoms². Less: motions of few joints are missed. More: time.
/// Test: `the_motion_of_fewest_joints_comes_first`.
pub(crate) const TRIALS: usize = 2_000_000;

// Reactions by a choice, sensitivity.

/// A number is known to so many roundings of the largest multiplier, each measured by its row.
/// Unit: roundings of the largest multiplier. Less: rounding is shown. More: digits are not. Test:
/// `what_two_roundings_leave_is_zero_and_more_is_not`.
pub(crate) const VALUE_ROUNDINGS: f64 = 4.0;

/// Redundant accelerations agree to this share of their terms: that of rounding in velocities on
/// the constraints, with room.
/// Unit: share of the terms. Less: rounding contradicts. More: contradictions are solved. Test:
/// `three_cranks_with_least_norm`.
pub(crate) const AGREEMENT: f64 = 1e-9;

/// The first solve leaves its own rounding; the second removes what of it matters.
/// Unit: solves. Less: rounding of the first remains. More: time. Test: `beam_on_three_springs`.
pub(crate) const CHOICE_SOLVES: usize = 2;

/// A point moves by this share of the mechanism's size (in long chains: of the size of its links),
/// a direction by as many radians: what a careful workshop holds.
/// Unit: share of the size, or rad. Less: fragile reactions are not found. More: all are fragile.
/// Test: `a_beam_by_hand`.
pub const MOVED: f64 = 1e-4;

/// Above this smallest singular value of the kept rows (of length one) first order is enough for
/// displacements of [`MOVED`].
/// Unit: singular value. Less: changes near limit positions are told too small. More: time. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const NEAR_LIMIT: f64 = 5e-2;

/// A number that changes by less than this to first order is not made fragile by higher ones.
/// Unit: share of the number or the load. Less: time. More: changes near limit positions are told
/// too small. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FIRST_ORDER: f64 = 0.01;

/// Data that change a number by at least this share of its largest change are displaced near a
/// limit: which of them changes it most is not known to first order.
/// Unit: share. Less: time. More: a number changes more by another datum. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const ALIKE: f64 = 0.7;

/// A datum is displaced once for numbers whose gradients have at least this cosine: next to a limit
/// a number changes several times more where the direction turns by 0.03 rad.
/// Unit: cosine. Less: numbers change more in a direction of their own. More: time. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const SAME_WAY: f64 = 0.999_999;

/// Data that are displaced near a limit, at most: those that move a number most.
/// Unit: data. Less: a number hangs on one that is not displaced. More: time. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOWED_DATA: usize = 64;

/// The same as a product with rows and the square of columns, which each correction of each step
/// factors on both sides, at most.
/// Unit: operations. Less: large parts near a limit are told to first order. More: time. Test:
/// none, work only.
pub(crate) const FOLLOWED_WORK: usize = 1_000_000_000;

/// Steps in which bodies follow a displaced datum.
/// Unit: steps. Less: they leave their branch. More: time. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_STEPS: usize = 8;

/// Share of the displacement in the first step, which shows how fast bodies move.
/// Unit: share. Less: rounding is their speed. More: a jump in it is not noticed. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_FIRST: f64 = 1e-3;

/// A step that moves bodies by this multiple of the one before has left the branch.
/// Unit: multiples. Less: bodies on the way to their limit have left it. More: other branches are
/// not noticed. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_JUMP: f64 = 4.0;

/// Corrections of a step.
/// Unit: corrections. Less: places near the limit are not reached. More: time. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_CORRECTIONS: usize = 12;

/// A correction below this is the last one.
/// Unit: share of the size. Less: rounding is corrected. More: reactions lose digits. Test:
/// `near_its_limit_a_reaction_changes_by_more_than_first_order`.
pub(crate) const FOLLOW_END: f64 = 1e-11;

/// A number of reactions that changes by more than this share of itself, or of the largest load, is
/// fragile.
/// Unit: share of the number, or of the largest load. Less: all reactions are fragile. More: none
/// is. Test: `a_beam_by_hand`.
pub const FRAGILE: f64 = 0.1;

/// Steps of the differences by which the directions of rows and the places of joints change with
/// the pose and the data: rounding and the square of the step are both far below what a sensitivity
/// shows.
/// Unit: share of the size, or rad. Less: rounding is a change. More: the second order is one.
/// Test: `numbers_change_as_those_of_mechanisms_built_with_other_data`.
pub(crate) const SLOPE_STEP: f64 = 1e-5;

/// From this change on, relative to its size, the first order does not say how far a reaction
/// changes: it says that none of its digits is left.
/// Unit: share of the reaction. Less: the first order is silent. More: the first order says too
/// much. Test: `sentences_are_for_people`.
pub(crate) const BEYOND: f64 = 1.0;

/// From here on "several times" would be too little.
/// Unit: 1. Less: numbers are not given. More: sentences exaggerate. Test:
/// `sentences_are_for_people`.
pub(crate) const MANY: f64 = 30.0;

/// A load below this share of what would stop the bodies within the size of the mechanism,
/// m·v²/size, is the rounding of a motion without any.
/// Unit: share of what stops the bodies. Less: rounding is a load. More: small loads are none.
/// Test: `a_small_load_beside_a_fast_motion_is_a_load`.
pub(crate) const LOAD_ROUNDING: f64 = 1e-9;

/// Points move by a share of the size of the mechanism, but at most by that of so many times the
/// reach of the bodies that they join: a chain of a hundred links is made link by link, and its
/// holes are not a hundred times worse than those of one. In mechanisms of a few bodies it plays no
/// part.
/// Unit: reaches of the bodies. Less: short chains are judged link by link. More: long chains are
/// fragile. Test: `sensitivities_are_those_of_mechanisms_built_with_other_numbers`.
pub(crate) const PIECE: f64 = 20.0;

/// Of points whose effects differ by less than this factor, as those of two points that coincide,
/// the first is named: reactions that hang on the same misfit are then named in one sentence.
/// Unit: 1. Less: one misfit is named in many sentences. More: different misfits are named as one.
/// Test: `a_beam_by_hand`.
pub(crate) const SAME_EFFECT: f64 = 1.01;

// Memory and words.

/// Bytes of a joint, drive or coupling with its verdict, its components and its name, also in the
/// answer.
/// Unit: bytes. Less: memory runs out. More: runs are refused. Test: none, work only.
pub(crate) const OF_GROUP: usize = 6500;

/// Bytes of a row with its verdict.
/// Unit: bytes. Less: memory runs out. More: runs are refused. Test: none, work only.
pub(crate) const OF_ROW: usize = 700;

/// Bytes of an entry of the matrix of rows, in all of its orders.
/// Unit: bytes. Less: memory runs out. More: runs are refused. Test: none, work only.
pub(crate) const OF_ENTRY: usize = 350;

/// Bytes of a velocity with its body.
/// Unit: bytes. Less: memory runs out. More: runs are refused. Test: none, work only.
pub(crate) const OF_VELOCITY: usize = 340;

/// Matrices of all rows and columns that are held at once where a small mechanism is judged.
/// Unit: matrices. Less: memory runs out. More: runs are refused. Test: none, work only.
pub(crate) const DENSE_MATRICES: usize = 16;

/// Matrices of all rows and columns that are held at once where the rank of several parts is
/// certified.
/// Unit: matrices. Less: memory runs out. More: runs are refused. Test: none, work only.
pub(crate) const CERTIFIED_MATRICES: usize = 9;

/// Farthest point about which a moment is asked of itself, in sizes of the mechanism: free wrenches
/// that are couples but for rounding have one at infinity.
/// Unit: sizes of the mechanism. Less: a centre outside is not told. More: points that nobody looks
/// for. Test: `a_couple_has_no_centre`.
pub(crate) const FAR_CENTRE: f64 = 100.0;

/// Forces of free wrenches below this share of the largest do not place the point about which their
/// moment vanishes: they are rounding.
/// Unit: share of the largest singular value. Less: points at random along a line of action. More:
/// points that are not those of the wrenches. Test: `points_of_a_line_are_the_nearest`.
pub(crate) const FREE_FORCE: f64 = 1e-9;

/// A pivot has this share of the largest entry that is left, where directions are given a basis for
/// readers: entries are known no better than the data, and a small pivot multiplies what they miss.
/// Unit: share of the largest entry. Less: directions of inexact data are wrong. More: unique
/// components are still told alone, but others lead. Test:
/// `what_the_data_miss_is_not_multiplied`.
pub(crate) const SHARE_OF_PIVOT: f64 = 0.1;

/// A component of a self-stress is zero below this share of its largest one: rounding of the
/// dependence, drawn or said.
/// Unit: share of the largest number. Less: rounding is shown. More: small numbers are not. Test:
/// `far_axes_and_translations_are_told_apart`.
pub(crate) const VISIBLE: f64 = 1e-9;

/// Two bodies move as one, and a joint stands at a point, to this share of the size of the
/// mechanism: above the rounding of a null space, below any distance between joints that a drawing
/// shows.
/// Unit: share of the size. Less: one point counts as two. More: two points count as one. Test:
/// `a_four_bar_moves_without_its_motor_only`.
pub(crate) const SAME_PLACE: f64 = 1e-6;

/// Other bodies in so many sets that move as one are told with the axes about which they turn.
/// Unit: sets of bodies. Less: it is said only that they turn. More: sentences nobody reads. Test:
/// `few_other_bodies_are_told_with_their_axes`.
pub(crate) const TOLD_MOVEMENTS: usize = 3;

/// Joints in so many sets that carry different loads are told one by one.
/// Unit: sets of joints. Less: loads are not described. More: sentences nobody reads. Test:
/// `few_different_loads_are_told_joint_by_joint`.
pub(crate) const TOLD_LOADS: usize = 3;

/// Bodies that a sentence names.
/// Unit: bodies. Less: bodies are counted only. More: sentences nobody reads. Test:
/// `links_of_a_chain_turn_about_their_own_joints`.
pub(crate) const NAMED_BODIES: usize = 6;

/// Names that tell which part it is.
/// Unit: names. Less: one does not know which part it is. More: sentences nobody reads. Test:
/// `a_part_is_named_by_its_first_three_joints`.
pub(crate) const FIRST_NAMED: usize = 3;

/// Rows that a label names; of more it names the first few.
/// Unit: rows. Less: rows are counted only. More: labels nobody reads. Test:
/// `eliminations_of_the_robot_are_runs_without_these_rows`.
pub(crate) const NAMED_ROWS: usize = 12;

/// More rows than this are not listed in a sentence.
/// Unit: rows. Less: rows are counted only. More: sentences nobody reads. Test:
/// `every_answer_is_that_of_its_session`.
pub(crate) const TELLABLE: usize = 8;
