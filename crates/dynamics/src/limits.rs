//! The table of limits: every number of this crate that somebody chose. Each says what it is, in
//! which unit, what breaks if it is wrong (`Less`: if it were smaller, `More`: if it were larger),
//! and which test fails then; `none, work only` if only time or memory change, `none` if there is
//! no test yet. `tests/all/limits.rs` reads it.
//!
//! Shares of pivots are shares of the *reference pivots*, those at which the rows were chosen.

use std::ops::RangeInclusive;

use crate::options::MotionOptions;

// Solvers.

/// From so many kept rows on they are solved through the Schur complement, if they leave more than
/// [`FREE_MOST`] motions free.
/// Unit: rows. Less: small mechanisms lose independent coordinates and refinement. More: an
/// evaluation of a chain grows with the cube of its rows. Test:
/// `it_is_where_its_drive_is_by_every_method`.
pub(crate) const SCHUR_FROM: usize = 64;

/// Up to so many free motions the null space is less work than the Schur complement.
/// Unit: motions. Less: time, and mechanisms of few motions lose independent coordinates and
/// refinement. More: time. Test: none, work only.
pub(crate) const FREE_MOST: usize = 16;

/// Without rows, up to so many velocities the null space is kept, for implicit methods.
/// Unit: velocities. Less: bodies on bushings alone lose implicit methods. More: dense matrices of
/// hundreds of free bodies. Test: `free_bodies_take_memory_in_proportion`.
pub(crate) const FREE_DENSE: usize = 1024;

/// From so many kept rows on the dropped ones are compared with them in sums.
/// Unit: rows. Less: large coefficients may cancel. More: time. Test: none, work only.
pub(crate) const SUMMED_FROM: usize = 64;

/// Kept rows up to which solutions with graded masses are refined, however many motions are free.
/// Unit: rows. Less: light bodies of large mechanisms lose digits. More: work grows with the
/// cube. Test: none.
pub(crate) const REFINED_MOST: usize = 600;

/// More rows that leave more than [`FREE_MOST`] motions free are not solved in their null space.
/// Unit: rows. Less: refuses what could be solved. More: matrices of more than a gigabyte. Test:
/// `the_motion_is_the_same_by_every_way_through_it`.
pub(crate) const NULL_SPACE_MOST: usize = 5000;

/// Vectors of all coordinates, velocities and rows that a run holds.
/// Unit: vectors. Less: the estimate of memory is too small. More: runs are refused that fit. Test:
/// none, work only.
pub(crate) const VECTORS: usize = 38;

/// Solutions of mechanisms larger than this, or smaller than its inverse, are refined.
/// Unit: m. Less: ordinary machines pay for refinement. More: weights and centrifugal terms that
/// differ by many powers of ten lose digits. Test:
/// `solutions_are_refined_where_digits_would_be_lost`.
pub(crate) const FAR_FROM_A_METRE: f64 = 1e5;

/// Rows below this share of the reference pivots are dependent for an instant and left out of a
/// solve.
/// Unit: share of pivots. Less: accelerations at a flat pose are rounding. More: rows are left
/// out that still carry. Test:
/// `limits_stand_in_their_order`.
pub(crate) const PIVOT_SINGULAR: f64 = 1e-6;

/// Quaternions of these lengths are left as they are at an accepted step; others are scaled to
/// length one. The motion does not depend on the length, but the tolerance of a step is one of its
/// parts.
/// Unit: length. Less: steps change coordinates for nothing. More: coarse runs of free bodies lose
/// digits of their orientation. Test: `a_quaternion_that_has_drifted_far_is_scaled`.
pub(crate) const QUATERNION_LENGTHS: RangeInclusive<f64> = 0.5..=2.0;

// Places of rest.

/// A run whose kinetic energy and gap are below so many roundings of the potential is at rest.
/// Unit: roundings. Less: a start at rest is warned of. More: gaps of slow motions are not seen.
/// Test: `what_is_written_starts_at_rest_and_stays_there`.
pub(crate) const ENERGY_ROUNDINGS: f64 = 64.0;

/// A row that prescribes less per second rests.
/// Unit: sizes or rad per second. Less: the rounding of a cosine at a quarter turn is a motion.
/// More: slow drives are held. Test: `a_drive_that_moves_at_the_start_is_refused_by_name`.
pub(crate) const RESTING_RATE: f64 = 1e-12;

/// Length of a step of the differences of forces; the longest is four times as long.
/// Unit: share of the size, or rad. Less: rounding is divided by it. More: short springs are not
/// seen as they are. Test: `a_short_spring_on_a_long_bar_is_stiff_enough`.
pub(crate) const STIFFNESS_STEP: f64 = 1.0 / 512.0;

/// First length of a step, for each body.
/// Unit: share of the size, or rad. Less: more steps. More: other places of rest are found than the
/// nearest. Test: none, work only.
pub(crate) const REST_RADIUS: f64 = 0.1;

/// Largest length of a step, for each body.
/// Unit: share of the size, or rad. Less: more steps. More: other places of rest are found than the
/// nearest. Test: none, work only.
pub(crate) const REST_LONGEST: f64 = 0.8;

/// Shorter steps are given up.
/// Unit: share of the size, or rad. Less: time. More: searches end that could go on. Test: none,
/// work only.
pub(crate) const REST_SHORTEST: f64 = 1e-10;

/// Steps of a search at most.
/// Unit: steps. Less: far places are not found. More: searches without an end are long. Test:
/// `a_motor_that_is_too_strong_finds_no_rest`.
pub(crate) const REST_STEPS: usize = 500;

/// Bisections of the length of a step.
/// Unit: halvings. Less: steps are shorter than allowed. More: time. Test: none, work only.
pub(crate) const REST_BISECTIONS: usize = 50;

/// Forces below so many roundings of those that act are none.
/// Unit: roundings. Less: searches go on until they stall. More: digits of the place are lost.
/// Test: `a_pendulum_on_a_torsion_spring_leans_as_bisection_says`.
pub(crate) const REST_ROUNDINGS: f64 = 16.0;

/// The same if further steps do not help.
/// Unit: roundings. Less: places where forces cancel are not accepted. More: a place is accepted
/// that has no balance. Test: `forces_that_cancel_are_balanced_to_their_rounding`.
pub(crate) const REST_LEFT: f64 = 4096.0;

/// Steps without a force half as large after which a search has stalled.
/// Unit: steps. Less: slow searches end early. More: time. Test: none, work only.
pub(crate) const REST_STALLED: usize = 4;

/// Length of a push away from a place that is not stable.
/// Unit: share of the size, or rad. Less: forces there are rounding. More: a shallow place nearby
/// is passed over. Test: `a_push_lets_an_upright_pendulum_fall`.
pub(crate) const REST_PUSH: f64 = 1e-2;

/// Pushes at most.
/// Unit: pushes. Less: chains that stand upright are left halfway. More: time. Test:
/// `a_push_lets_an_upright_pendulum_fall`.
pub(crate) const REST_PUSHES: usize = 40;

/// A motion is not resisted if a displacement by one changes its force by no more than this share
/// of all forces.
/// Unit: share. Less: rounding resists. More: soft springs do not. Test:
/// `what_nothing_holds_is_refused_with_what_pushes_it`.
pub(crate) const UNRESISTED: f64 = 1e-9;

/// And is refused if its force is more than this share of the largest.
/// Unit: share. Less: what is left of slow searches is refused. More: light bodies fall for many
/// steps before they are refused. Test: `what_nothing_holds_is_refused_with_what_pushes_it`.
pub(crate) const UNRESISTED_FORCE: f64 = 1e-6;

/// A motion is pushed with a moment if it turns by at least this many radians while its fastest
/// body moves by the size of the mechanism.
/// Unit: rad. Less: forces along a translation with a little rotation are divided by that little.
/// More: what turns about a far axis is pushed with a force. Test:
/// `what_falls_freely_is_named_with_its_weight`.
pub(crate) const MOSTLY_TURNS: f64 = 0.1;

/// A force on one body that changes less from pose to pose is the same at all poses.
/// Unit: share of the force. Less: rounding of far poses is a change. More: forces that change
/// slowly are taken for constant. Test: `what_falls_freely_is_named_with_its_weight`.
pub(crate) const DEAD_LOAD: f64 = 1e-9;

/// And over so many steps.
/// Unit: steps. Less: a horizontal pendulum, whose weight is an extremum there, is refused. More:
/// time. Test: `a_horizontal_pendulum_falls`.
pub(crate) const UNRESISTED_STEPS: usize = 3;

/// Stiffness below this share of the largest, or of all forces, is none.
/// Unit: share. Less: rounding of differences decides on stability. More: soft springs are called
/// idle. Test: `a_soft_spring_beside_a_stiff_one_still_counts`.
pub(crate) const IDLE: f64 = 1e-10;

/// Stiffness with a skew part above this share has no potential.
/// Unit: share. Less: rounding of differences has none. More: followers are judged by a potential
/// that they do not have. Test: `a_follower_force_is_not_judged`.
pub(crate) const ASYMMETRIC: f64 = 1e-7;

// Linearised motions.

/// Length of a step along a curve, in sizes of the mechanism or radians; the longest of the eight
/// is four times as long.
/// Unit: share of the size, or rad. Less: rounding, 1e-16, is divided by it. More: truncation, its
/// eighth power, takes part. Test: `a_pendulum_has_the_matrices_of_its_textbook`.
pub(crate) const LINEARISE_STEP: f64 = 1.0 / 128.0;

/// Two orders of a derivative differ by at most this share of the largest one.
/// Unit: share. Less: steep functions are refused. More: a corner passes as a slope. Test:
/// `a_force_with_a_corner_is_refused`.
pub(crate) const LINEARISE_ACCURACY: f64 = 1e-6;

/// Quarterings of the step of a difference, while it is no derivative.
/// Unit: quarterings. Less: forces that are steep for the size of the mechanism are refused. More:
/// rounding passes as a corner. Test: `a_short_rod_in_a_large_mechanism_has_derivatives`.
pub(crate) const LINEARISE_SHORTER: usize = 3;

/// A body accelerates by no more than this share of what forces would do without joints.
/// Unit: share. Less: places of rest known to a few digits are refused. More: matrices of a state
/// that is left at once are believed. Test: `a_pendulum_held_aside_is_not_at_rest`.
pub(crate) const STEADY_ACCELERATION: f64 = 1e-6;

/// A steady state changes its acceleration by no more than this share of the cube of its rate.
/// Unit: share. Less: rounding of derivatives refuses steady states. More: a mass that passes its
/// place of rest counts as steady. Test: `a_mass_that_passes_its_place_of_rest_is_not_steady`.
pub(crate) const STEADY_FRACTION: f64 = 1e-6;

/// What a followed coordinate changes of the rates, as a share of the largest entry of A.
/// Unit: share. Less: rounding of derivatives refuses symmetries. More: what the motion depends on
/// is left out. Test: `what_the_motion_depends_on_cannot_be_followed`.
pub(crate) const SYMMETRY: f64 = 1e-7;

/// Eigenvalues below this share of the largest one are zero: the square root of rounding, since
/// zeros of free motions are double.
/// Unit: share of the largest eigenvalue. Less: free motions seem to grow or decay. More: slow
/// modes are lost. Test: `the_benchmark_bicycle_has_its_published_eigenvalues`.
pub(crate) const ZERO_EIGENVALUE: f64 = 1e-7;

/// Rounding of the entries of A, for each of its rows.
/// Unit: share of the norm of A. Less: zeros of large Jordan blocks seem to grow. More: slow modes
/// of mechanisms that are stiff elsewhere are lost. Test:
/// `rounding_around_a_multiple_zero_neither_grows_nor_decays`.
pub(crate) const ZERO_ENTRY: f64 = 16.0 * f64::EPSILON;

/// Real parts below this share of the largest eigenvalue neither grow nor decay.
/// Unit: share of the largest eigenvalue. Less: rounding calls undamped motions unstable. More:
/// lightly damped ones are not called stable. Test: `what_first_order_says_of_stability`.
pub(crate) const NEITHER: f64 = 1e-9;

/// Among free directions the first one is chosen whose share is at least this part of the largest.
/// Unit: share. Less: coordinates may determine the state badly. More: names follow rounding. Test:
/// `a_pendulum_has_the_matrices_of_its_textbook`.
pub(crate) const CHOSEN_PIVOT: f64 = 0.3;

/// A direction with less than this share left free is determined by those chosen before.
/// Unit: share. Less: coordinates that determine nothing are accepted. More: useful ones near a
/// dead centre are refused. Test: `asked_coordinates_have_to_be_independent`.
pub(crate) const DEPENDENT_COORDINATE: f64 = 1e-6;

// Projection.

/// Corrections of the position per projection; one or two are the rule, more where a tolerance is
/// very loose.
/// Unit: corrections. Less: loose steps are refused. More: a projection that diverges takes longer
/// to say so. Test: `it_is_where_its_drive_is_by_every_method`.
pub(crate) const CORRECTIONS: usize = 20;

/// The same by generated code, which is left for the interpreter after them.
/// Unit: corrections. Less: code is left at loose steps. More: time. Test:
/// `limits_stand_in_their_order`.
pub(crate) const CODE_CORRECTIONS: usize = 6;

/// Corrections of the velocity per projection.
/// Unit: corrections. Less: what rounding leaves of the first stays. More: time. Test:
/// `it_is_where_its_drive_is_by_every_method`.
pub(crate) const VELOCITY_CORRECTIONS: usize = 3;

/// Kept rows count as satisfied below this many roundings of their terms.
/// Unit: roundings. Less: a correction more for each step. More: drift. Test:
/// `rows_are_corrected_until_they_are_satisfied_or_stall_close_to_it`.
pub(crate) const ROUNDINGS: f64 = 10.0;

/// The same where pivots have fallen below [`WEAK`], and for dependent coordinates.
/// Unit: roundings. Less: cannot be reached. More: what kept rows miss by is multiplied in the
/// dropped ones. Test:
/// `limits_stand_in_their_order`.
pub(crate) const FEW_ROUNDINGS: f64 = 1.0;

/// Pivots below this share are weak.
/// Unit: share of pivots. Less: dropped rows miss near singular configurations. More: a
/// correction more for each step. Test:
/// `limits_stand_in_their_order`.
pub(crate) const WEAK: f64 = 0.5;

/// Size of what is added up where an independent rotation is read of a quaternion: four products of
/// at most two.
/// Unit: rad. Less: completions fail at rounding. More: rotations drift. Test:
/// `bricards_linkage_by_an_implicit_method`.
pub(crate) const READ_ROTATION: f64 = 8.0;

/// Kept rows count as satisfied below this many roundings where a further correction does not
/// help; and by generated code, which has no better look.
/// Unit: roundings. Less: projections fail at rounding. More: drift. Test:
/// `rows_are_corrected_until_they_are_satisfied_or_stall_close_to_it`.
pub(crate) const STALLED_ROUNDINGS: f64 = 50.0;

/// Factors of an earlier configuration serve as long as a correction leaves this share: a
/// factorisation costs about ten corrections.
/// Unit: share. Less: more factorisations. More: more corrections. Test:
/// `factors_serve_as_long_as_a_correction_gains_a_digit`.
pub(crate) const CONVERGENCE: f64 = 0.1;

/// Dropped rows count as implied by the kept ones below this share of their own terms and of
/// those of the kept rows, as much as these enter: a row with an arm of 1e30 m says nothing of
/// what an angle may miss by.
/// Unit: share of terms. Less: rounding of the kept rows, 1e-15, refuses good steps. More: rows
/// that part are seen late. Test:
/// `drives_that_contradict_each_other_later_stop_the_run_and_keep_its_rows`.
pub(crate) const DROPPED_MISFIT: f64 = 1e-11;

/// A misfit that grows by less than this share is the same one: its time is the first.
/// Unit: share of the misfit. Less: rounding decides when a constant misfit occurs. More: the time
/// of a growing one is early. Test: `a_door_on_two_hinges_misses_by_their_distance`.
pub(crate) const SAME_MISFIT: f64 = 1e-9;

/// The share of the size of the mechanism by which velocities may part in the time of a run,
/// however slow it is: some hundred roundings.
/// Unit: share of size. Less: mechanisms at rest are refused. More: slow contradictions are not
/// seen. Test:
/// `limits_stand_in_their_order`.
pub(crate) const AT_REST: f64 = 1e-13;

/// A dropped row of Φ never misses by more than this share of its own terms, however far away the
/// places are from which the kept rows imply it.
/// Unit: share of terms. Less: far places refuse good steps. More: another configuration of the
/// kept rows passes as this one. Test:
/// `limits_stand_in_their_order`.
pub(crate) const POSITION_MISFIT: f64 = 1e-5;

/// Smallest share of the reference pivots that allows dropped rows to miss by more: nearer, rows
/// are left out.
/// Unit: share of pivots. Less: dropped rows may miss by anything. More: good steps near a flat
/// pose are refused. Test:
/// `limits_stand_in_their_order`.
pub(crate) const NEAREST_PIVOT: f64 = 1e-6;

/// Rows of bodies at rest feel the rounding of others: by generated code their terms count as
/// this share of the largest.
/// Unit: share of terms. Less: code is left where bodies rest. More: drift of slow bodies. Test:
/// none.
pub(crate) const CODE_AT_REST: f64 = 1e-4;

// Independent coordinates.

/// A partition is renewed once its pivots have fallen below this share of those at its choice:
/// steps should not reach those of lost rows.
/// Unit: share of pivots. Less: completions fail within a step. More: linear systems are set up
/// again and again. Test: `partitions_are_renewed_as_a_blade_turns`.
pub(crate) const PARTITION_WORN: f64 = 0.5;

/// Dependent coordinates that move by more than this when a state is completed may have gone to
/// another branch or another turn.
/// Unit: share of the mechanism's size, or rad. Less: long steps are refused. More: another branch
/// is taken. Test: `shifted_systems_are_solved`.
pub(crate) const FAR_COMPLETION: f64 = 0.6;

/// In addition they may move by so many times the way that the mechanism would go from the last
/// accepted state with its rates.
/// Unit: ways. Less: long steps are refused. More: another branch is taken. Test: none.
pub(crate) const FAR_EXTRAPOLATED: f64 = 2.0;

/// The end of a step may lie so far from where the rates at both ends lead.
/// Unit: share of the largest way on it. Less: steps of curved motions are refused. More: another
/// branch is taken. Test: none.
pub(crate) const FAR_IN_A_STEP: f64 = 0.5;

/// The same in addition, where nothing moves.
/// Unit: share of the mechanism's size, or rad. Less: starts from rest are refused. More: another
/// branch is taken. Test: `a_grip_of_1e12_takes_few_steps`.
pub(crate) const FAR_AT_REST: f64 = 1e-2;

// Exchange of rows.

/// Other rows are kept once the pivots have fallen below this share: rounding of the kept rows
/// reaches the dropped ones through the inverse of the pivots.
/// Unit: share of pivots. Less: dropped rows miss. More: rows are decided again at every step.
/// Test:
/// `limits_stand_in_their_order`.
pub(crate) const PIVOT_LOSS: f64 = 0.1;

/// Rows that were asked for come back above this share.
/// Unit: share of pivots. Less: they come and go at every step. More: they stay away. Test:
/// `limits_stand_in_their_order`.
pub(crate) const PIVOT_RECOVERY: f64 = 0.2;

/// Rows chosen by themselves are exchanged above this coefficient in a dropped row.
/// Unit: 1. Less: rows are decided again at every step. More: dropped rows miss. Test:
/// `rows_that_multiply_their_rounding_are_exchanged`.
pub(crate) const LARGE_COEFFICIENT: f64 = 10.0;

/// Other rows are worth an exchange if their coefficients are so many times smaller.
/// Unit: 1. Less: rows change at every step. More: poor rows stay. Test:
/// `sixty_four_step_sizes_over_the_flat_pose`.
pub(crate) const WORTH_EXCHANGE: f64 = 3.0;

/// Rows of output are looked at below this share only: what kept rows multiply rounding by is
/// small above it.
/// Unit: share of pivots. Less: written rows miss between two steps. More: time. Test:
/// `limits_stand_in_their_order`.
pub(crate) const SOUND: f64 = 0.5;

// Singular configurations.

/// Below this share positions are corrected at least once: a state that misses its rows by rounding
/// δ is off by δ over the share, and its accelerations by that over the square of it. One
/// correction makes angles exact, whatever the coordinates are rounded to.
/// Unit: share of pivots. Less: far from the origin passages fail. More: corrections for nothing.
/// Test: `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const SHARPENED: f64 = 0.2;

/// Below this share rows are delicate: stages have to lie on the constraints.
/// Unit: share of pivots. Less: stages off the constraints by δ are wrong by δ over the share.
/// More: ordinary steps pay for projected stages. Test:
/// `limits_stand_in_their_order`.
pub(crate) const DELICATE: f64 = 0.1;

/// Stages below this share make a step suspect.
/// Unit: share of pivots. Less: passages are not reported, and branches not compared. More:
/// ordinary steps are searched. Test: `rows_that_nobody_wants_are_not_computed`.
pub(crate) const SUSPECT: f64 = 0.1;

/// Nearest approach of the end of a step to a singular configuration.
/// Unit: share of pivots. Less: a projection cannot tell the branches apart. More: no step ends
/// where the motion is slow. Test: `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NEAREST: f64 = 1e-3;

/// The same in units of the relative tolerance.
/// Unit: tolerances. Less: loose steps take another branch. More: as above. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NEAREST_TOLERANCES: f64 = 100.0;

/// Loose tolerances must not keep a motion farther away than this.
/// Unit: share of pivots. Less: loose steps take another branch. More: loose runs stop. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NEAREST_MAX: f64 = 0.1;

/// A step that comes near all at once begins again, shorter, if it ends at less than so many times
/// the nearest approach: rounding of accelerations grows with the third power of the distance.
/// Unit: nearest approaches. Less: the next step has to pass from where its stages are rounding.
/// More: steps are refused in vain. Test: `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const NEARBY: f64 = 10.0;

/// It has come near all at once if its pivot has fallen to this share.
/// Unit: share of the pivot at the last accepted step. Less: as above. More: motions that stay
/// near a singular configuration are slowed down. Test:
/// `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const FALLEN: f64 = 0.1;

/// Singular configurations are foreseen for so many steps like the last one: no method lets steps
/// grow by more.
/// Unit: steps. Less: a step meets one unforeseen. More: searches in vain. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const FORESIGHT: f64 = 12.0;

/// Implicit methods hand over to `dop853` this many steps before a singular configuration; explicit
/// ones as soon as it is predicted.
/// Unit: steps. Less: they pass it themselves, and fail. More: explicit steps under stiff forces.
/// Test: `a_grip_of_1e12_takes_few_steps`.
pub(crate) const IMPLICIT_REACH: f64 = 4.0;

/// If what rows miss by rounding of their coordinates exceeds this share of the mechanism, stages
/// are moved onto the constraints as soon as a singular configuration is predicted.
/// Unit: share of the size. Less: steps up to it lose accuracy of the method. More: far from the
/// origin passages fail. Test: `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const COARSE: f64 = 1e-13;

/// Weight of a component near zero in the norm of a step over a singular configuration: rounding
/// does not become less with the component.
/// Unit: tolerances times the size of the mechanism. Less: steps collapse before it where a
/// component is near zero. More: another branch is taken. Test:
/// `a_passage_far_away_is_as_good_as_its_coordinates_are_known`.
pub(crate) const LEAST_SCALE: f64 = 0.1;

/// Relative error of a step over a singular configuration that rounding may cause where steps are
/// short; 1e-10 was not enough at 1e-10 where generated code is left on the way to one.
/// Unit: 1. Less: steps collapse before it. More: the passage costs digits. Test: none.
pub(crate) const PASSED: f64 = 1e-9;

/// Largest relative correction of a step over a singular configuration.
/// Unit: share of the distance at which it ends: other branches are as far away as that. Less:
/// runs stop before it. More: another branch is taken. Test:
/// `a_run_may_end_in_the_flat_pose_or_beside_it`.
pub(crate) const SMOOTH: f64 = 0.01;

/// Velocities behind a singular configuration may miss those that the accelerations on both sides
/// explain by this share: a step over it is short relative to the curvature of the motion, and
/// another branch leads elsewhere.
/// Unit: share of momentum. Less: runs stop behind it. More: another branch is taken. Test:
/// `flat_poses_of_many_four_bars_are_passed_on_the_branch`.
pub(crate) const KINK: f64 = 0.25;

/// Steps that end at a contradiction collapse within this share of the run before it.
/// Unit: share of the run. Less: the contradiction is not named. More: another one is. Test:
/// `a_contradiction_just_ahead_is_why_a_run_stops`.
pub(crate) const JUST_AHEAD: f64 = 1e-9;

/// Reactions are not reported nearer to a singular configuration than this share.
/// Unit: share of pivots. Less: reactions are rounding. More: they are left out where they are
/// known. Test: `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NO_REACTIONS: f64 = 1e-6;

/// The same in units of the relative tolerance: a row off its motion by δ has reactions that are
/// wrong by δ divided by that share.
/// Unit: tolerances. Less: reactions are wrong. More: they are left out. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NO_REACTIONS_TOLERANCES: f64 = 1e3;

/// Loose tolerances must not hide reactions farther away than this.
/// Unit: share of pivots. Less: reactions are wrong. More: they are left out. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NO_REACTIONS_MAX: f64 = 1e-2;

// The search for singular instants.

/// Places at which a step is first looked at.
/// Unit: intervals. Less: two passages within a step are one. More: time. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const PLACES: usize = 16;

/// An instant at which a pivot is smallest is found to this: there the pivot is as small.
/// Unit: share of the interval. Less: time. More: passages are missed. Test: none.
pub(crate) const SHARP: f64 = 1e-7;

/// A singular configuration is looked for up to so many times the distance at which a straight
/// line meets it.
/// Unit: distances. Less: curved pivots vanish unforeseen. More: time. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const BEYOND: f64 = 1.5;

/// Where a pivot falls to this share of the present one and rises again, it vanishes: what is
/// left is the error of a parabola.
/// Unit: share of the present pivot. Less: passages are not foreseen. More: steps avoid what is
/// no passage. Test:
/// `limits_stand_in_their_order`.
pub(crate) const VANISHES: f64 = 0.2;

/// A search is worth its price where a pivot falls below this share of the present one at one of
/// [`GLANCES`] places: between two of them a pivot that vanishes on the way shows itself, unless
/// that is much earlier than expected.
/// Unit: share of the present pivot. Less: passages are not foreseen. More: time. Test:
/// `limits_stand_in_their_order`.
pub(crate) const STAYS: f64 = 0.75;

/// Those places.
/// Unit: places. Less: passages are not foreseen. More: time. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const GLANCES: usize = 6;

/// A pivot has a minimum between two places if it falls there to this share of both: at an end of
/// what is searched it only falls.
/// Unit: share of the pivots at the neighbouring places. Less: passages are not found. More: one
/// passage is reported twice. Test: `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const RISES: f64 = 0.5;

/// Between two places a pivot falls at most by so many times what it changes by between any two
/// neighbouring ones.
/// Unit: 1. Less: passages are not found. More: time. Test:
/// `a_pivot_that_vanishes_as_a_root_is_searched_for`.
pub(crate) const STEEPER: f64 = 2.0;

/// States of a step by which a passage is judged.
/// Unit: intervals. Less: the judge does not find it. More: time. Test:
/// `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const PASSAGE_STATES: usize = 8;

/// Rows up to which the motion at a passage is judged: determinants at many instants grow with
/// their cube.
/// Unit: rows. Less: uniqueness is not decided. More: time. Test:
/// `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const JUDGED_MOST: usize = 64;

/// Passages of one step that are reported at most.
/// Unit: passages. Less: some are not reported. More: time. Test:
/// `passages_are_told_at_the_same_time`.
pub(crate) const MOST_PASSAGES: usize = 8;

/// What they are apart at least.
/// Unit: share of the step. Less: one counts twice. More: two count as one. Test:
/// `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const BESIDE: f64 = 0.02;

// Jumps.

/// Residuals below this share of the terms of their row, or for rates of the largest row, are no
/// jumps.
/// Unit: share of terms. Less: rounding is an impulse. More: small jumps are not reported. Test:
/// `smooth_steps_are_no_jumps`.
pub(crate) const NO_JUMP: f64 = 1e-9;

/// Between times that are so many roundings apart a continuous function changes much more than
/// between neighbouring ones.
/// Unit: roundings. Less: rounding hides the change. More: other changes take part. Test:
/// `smooth_steps_are_no_jumps`.
pub(crate) const WIDE: f64 = 1e6;

/// What remains of the wider change, if it is more than this share, is a jump.
/// Unit: share. Less: steep functions jump. More: jumps are steep. Test:
/// `a_jump_of_the_rate_is_an_impulse_with_its_energy`.
pub(crate) const REMAINS: f64 = 0.5;

// Rows of output.

/// A row may lie so far from the cubic through both ends of its step.
/// Unit: share of the way of the step. Less: good rows are refused. More: rows on another branch
/// are shown. Test:
/// `rows_lie_where_their_step_leads`.
pub(crate) const ROW_DEVIATION: f64 = 0.25;

/// The same in addition, where nothing moves.
/// Unit: share of the mechanism's size, or rad. Less: good rows are refused. More: rows on
/// another branch are shown. Test:
/// `rows_lie_where_their_step_leads`.
pub(crate) const ROW_DEVIATION_AT_REST: f64 = 1e-3;

/// Velocities on a way may be so many times those of going it evenly.
/// Unit: 1. Less: rows of drives that rest at both ends of a step are refused. More: rows on
/// another branch are shown. Test:
/// `a_drive_that_rests_at_both_ends_of_a_step_may_be_fast_between`.
pub(crate) const PEAK: f64 = 3.0;

/// A step that is tried again and again forgets what it has seen after so many times.
/// Unit: times. Less: stages are evaluated twice. More: memory. Test: none, work only.
pub(crate) const REMEMBERED: usize = 256;

/// Rows that a component may be ahead of the others.
/// Unit: rows. Less: threads wait. More: memory. Test: none, work only.
pub(crate) const AHEAD: usize = 64;

// Generated code.

/// Runs leave code below this health: the interpreter has to see a singular configuration from
/// afar. They do not begin on it either.
/// Unit: share of the generator's pivots. Less: singular configurations are met on code. More:
/// code is left where it is good. Test:
/// `limits_stand_in_their_order`.
pub const LEAVE: f64 = 0.1;

/// Code comes back above this health.
/// Unit: share of the generator's pivots. Less: it comes and goes. More: it stays away. Test:
/// `limits_stand_in_their_order`.
pub(crate) const RETURN: f64 = 0.3;

/// Accepted steps before code comes back at first; twice as many after every further time it was
/// left.
/// Unit: steps. Less: it comes and goes. More: time. Test:
/// `code_that_is_not_sure_is_left_and_comes_back`.
pub(crate) const PATIENCE: u64 = 8;

/// Accelerations of code that comes back differ from interpreted ones by at most this share.
/// Unit: share of the largest. Less: rounding keeps it away. More: wrong code comes back. Test:
/// none.
pub(crate) const SAME_ACCELERATIONS: f64 = 1e-9;

/// Values of code and interpreter may differ by this share of the terms that they are made of.
/// Unit: share of terms. Less: rounding refuses code. More: code of a similar mechanism is taken.
/// Test: `code_of_another_mechanism_is_refused`.
pub(crate) const SAME_VALUES: f64 = 1e-9;

/// States around the start at which values are compared.
/// Unit: states. Less: code of another mechanism agrees by chance. More: time. Test: none.
pub(crate) const CODE_STATES: usize = 6;

/// How far these are from it.
/// Unit: size of the mechanism, or rad. Less: geometry does not count. More: code is not healthy
/// there. Test: none.
pub(crate) const DISTANCE: f64 = 0.01;

/// The same for velocities: terms in their squares have to count.
/// Unit: size of the mechanism, or rad, per second. Less: they do not. More: they alone do. Test:
/// `code_of_another_mechanism_is_refused`.
pub(crate) const SPEED: f64 = 1.0;

// Choices.

/// A motion for which an explicit method would need more steps than this, only to stay stable, is
/// stiff.
/// Unit: steps. Less: implicit methods where explicit ones are faster. More: runs that take
/// hours. Test: `components_move_as_they_do_alone_and_each_at_its_own_pace`.
pub(crate) const STIFF: f64 = 2e4;

/// Explicit steps are stable up to about this many times 1/|λ|: Dormand–Prince 8(5,3), along the
/// negative real axis.
/// Unit: 1. Less, more: as for [`STIFF`]. Test:
/// `explicit_steps_are_stable_up_to_the_limit_and_not_far_beyond`.
pub(crate) const STABLE: f64 = 6.0;

/// Iterations for the largest |λ|; the second half counts.
/// Unit: iterations. Less: oscillations are misjudged. More: time. Test:
/// `the_fastest_rate_is_found_also_of_oscillations`.
pub(crate) const POWER_ITERATIONS: usize = 64;

/// Components that are run at the same time at most, each on its own thread.
/// Unit: threads. Less: many mechanisms share their steps. More: threads cost more than they
/// save. Test: `too_many_components_stay_one`.
pub(crate) const MOST_COMPONENTS: usize = 256;

/// Bodies of a component that are named; more are counted.
/// Unit: bodies. Less, more: names of components are too short or too long. Test:
/// `three_bodies_are_named_and_more_are_counted`.
pub(crate) const NAMED: usize = 3;

/// Rows with a smaller share than this of the largest weight take no part in a combination that
/// is reported.
/// Unit: share. Less: rows are named that do not matter. More: some that do are not. Test:
/// `a_start_names_the_rows_that_nearly_depend_and_no_others`.
pub(crate) const TAKES_PART: f64 = 0.1;

// What a run does where nobody says otherwise.

impl MotionOptions {
    /// Output steps of a run where none is given.
    /// Unit: steps. Less: pictures have corners. More: files are large. Test:
    /// `a_turn_is_as_round_as_a_picture_shows`.
    pub const OUTPUT_STEPS: f64 = 200.0;

    /// Relative tolerance where none is given.
    /// Unit: 1. Less: time. More: motions are wrong in the digits that are read. Test:
    /// `motions_without_stated_tolerances_have_the_digits_that_are_read`.
    pub const RTOL: f64 = 1e-8;

    /// Absolute tolerance where none is given.
    /// Unit: m, rad, and these per second. Less, more: as the relative one. Test:
    /// `motions_without_stated_tolerances_have_the_digits_that_are_read`.
    pub const ATOL: f64 = 1e-10;

    /// Relative tolerances that can be asked for.
    /// Unit: 1. Less: rounding of a step is larger. More: its error is no longer small. Test:
    /// `the_ends_of_the_ranges_are_right`.
    pub const RTOL_RANGE: RangeInclusive<f64> = 1e-15..=0.1;

    /// That in words.
    pub const RTOL_EXPECTED: &str = "a number from 1e-15 (rounding) to 0.1";

    /// Most rows of output: a hundred bodies of six numbers then take some 100 GB.
    /// Unit: rows. Less: long runs are refused. More: disks are filled. Test:
    /// `runs_that_would_never_end_are_refused_by_name`.
    pub const MOST_ROWS: f64 = 1e7;

    /// Accepted and rejected steps at most, where no other limit is given.
    /// Unit: steps. Less: long runs are refused. More: runs that do not end are not stopped.
    /// Test: `runs_that_would_never_end_are_refused_by_name`.
    pub const MAX_STEPS: u64 = 1_000_000;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each number of a row is less than the next, or a state would be two things at once.
    #[test]
    fn limits_stand_in_their_order() {
        let rows: [(&str, &[f64]); 11] = [
            ("roundings", &[FEW_ROUNDINGS, ROUNDINGS, STALLED_ROUNDINGS]),
            (
                "rows come back where others are not lost",
                &[PIVOT_LOSS, PIVOT_RECOVERY],
            ),
            (
                "rows are corrected further before others replace them",
                &[PIVOT_LOSS, PIVOT_RECOVERY, WEAK, 1.0],
            ),
            ("code comes back where it is not left", &[LEAVE, RETURN]),
            (
                "rows are left out where no step ends",
                &[PIVOT_SINGULAR, NEAREST],
            ),
            (
                "no step ends nearer",
                &[NEAREST, NEAREST_MAX, 2.0 * DELICATE],
            ),
            ("delicate rows are not sound", &[DELICATE, SOUND, 1.0]),
            (
                "reactions are reported where steps end",
                &[NO_REACTIONS, NEAREST, NO_REACTIONS_MAX],
            ),
            (
                "dropped rows",
                &[f64::EPSILON, AT_REST, DROPPED_MISFIT, POSITION_MISFIT],
            ),
            ("what vanishes does not stay", &[VANISHES, STAYS, 1.0]),
            (
                "code gives up first",
                &[CODE_CORRECTIONS as f64, CORRECTIONS as f64],
            ),
        ];
        for (what, values) in rows {
            let is_ordered = values.windows(2).all(|w| w[0] < w[1]);
            assert!(is_ordered, "{what}: {values:?}");
        }
        // Rows that are left out allow dropped ones no more than this.
        assert_eq!([NEAREST_PIVOT], [PIVOT_SINGULAR]);
    }
}
