//! Table of limits: every constant of this crate that was chosen by its authors. Each entry states
//! the meaning of the constant, its unit, and the effects of a value that is too small or too
//! large. Each entry also contains the name of the test that fails for such a value. `none, work
//! only` means that only time or memory change, and `none` means that there is no test yet. The
//! test file `tests/all/limits.rs` reads this table.
//!
//! A share of pivots is relative to the *reference pivots*. These are the pivots at the state at
//! which the independent rows were chosen. "Independent rows" are the constraint rows that are
//! solved (`kept`), and "redundant rows" are the other rows (`dropped`). A *rounding* is the
//! relative rounding error of `f64`.

use std::ops::RangeInclusive;

use crate::options::MotionOptions;

// Solvers.

/// Number of independent rows from which the equations are solved through the Schur complement, if
/// the mechanism has more than [`FREE_MOST`] degrees of freedom. Unit: rows. Too small: small
/// mechanisms are solved without independent coordinates and refinement. Too large: the work of one
/// evaluation of a chain grows with the cube of its rows. Test:
/// `it_is_where_its_drive_is_by_every_method`.
pub(crate) const SCHUR_FROM: usize = 64;

/// Up to this number of degrees of freedom, the null space takes less work than the Schur
/// complement. Unit: motions. Too small: runs take longer, and mechanisms with few degrees of
/// freedom are solved without independent coordinates and refinement. Too large: runs take longer.
/// Test: none, work only.
pub(crate) const FREE_MOST: usize = 16;

/// Implicit methods are available up to this number of degrees of freedom of a mechanism with at
/// least [`SCHUR_FROM`] rows, or without rows. Unit: motions. Too small: implicit methods are not
/// available for bodies that are connected by bushings. Too large: hundreds of free bodies require
/// large dense matrices. Test: `free_bodies_take_memory_in_proportion`.
pub(crate) const FREE_DENSE: usize = 1024;

/// If the user does not choose a method, the stiffness of a mechanism with many free motions is
/// estimated up to this number of velocities. Unit: velocities. Too small: stiff robots are
/// computed with the short steps of an explicit method. Too large: the choice of independent
/// coordinates takes longer than a run, because its work grows with the cube of the velocities.
/// Test: `stiff_chains_are_implicit_with_many_free_motions`.
pub(crate) const ESTIMATED_MOST: usize = 600;

/// Number of independent rows from which the coefficients of two random sums of redundant rows are
/// computed instead of those of each redundant row. Unit: rows. Too small: large coefficients may
/// cancel. Too large: runs take longer. Test: none, work only.
pub(crate) const SUMMED_FROM: usize = 64;

/// Up to this number of independent rows, solutions with graded masses are refined, for any number
/// of degrees of freedom. Unit: rows. Too small: solutions for light bodies of large mechanisms
/// lose digits. Too large: the work grows with the cube of the rows. Test: none.
pub(crate) const REFINED_MOST: usize = 600;

/// A mechanism with more rows than this number and more than [`FREE_MOST`] degrees of freedom is
/// not solved in its null space. Unit: rows. Too small: mechanisms are rejected that could be
/// solved. Too large: matrices need more than a gigabyte. Test:
/// `the_motion_is_the_same_by_every_way_through_it`.
pub(crate) const NULL_SPACE_MOST: usize = 5000;

/// Number of vectors of all coordinates, velocities and rows that a run stores. Unit: vectors. Too
/// small: the memory estimate is too small. Too large: runs are rejected although they would fit
/// into memory. Test: none, work only.
pub(crate) const VECTORS: usize = 38;

/// Solutions are refined for mechanisms that are larger than this size or smaller than its inverse.
/// Unit: m. Too small: ordinary machines spend time on refinement. Too large: digits are lost if
/// weights and centrifugal terms differ by many powers of ten. Test:
/// `solutions_are_refined_where_digits_would_be_lost`.
pub(crate) const FAR_FROM_A_METRE: f64 = 1e5;

/// A row whose pivot is below this share counts as dependent at this instant and is left out of the
/// solution. Unit: share of pivots. Too small: rounding errors dominate accelerations at a singular
/// configuration. Too large: rows are left out that still transmit force. Test:
/// `limits_stand_in_their_order`.
pub(crate) const PIVOT_SINGULAR: f64 = 1e-6;

/// At an accepted step, quaternions with a length in this range are unchanged. Other quaternions
/// are scaled to length one. The motion does not depend on the length, but the tolerance of a step
/// is relative to the length. Unit: length. Too small: steps change coordinates unnecessarily. Too
/// large: the orientation of free bodies loses digits in runs with loose tolerances. Test:
/// `a_quaternion_that_has_drifted_far_is_scaled`.
pub(crate) const QUATERNION_LENGTHS: RangeInclusive<f64> = 0.5..=2.0;

// Equilibria.

/// A run is at rest if its kinetic energy and its energy error are below this number of rounding
/// errors of the potential energy. Unit: roundings. Too small: a start at rest causes a warning.
/// Too large: energy errors of slow motions are not reported. Test:
/// `what_is_written_starts_at_rest_and_stays_there`.
pub(crate) const ENERGY_ROUNDINGS: f64 = 64.0;

/// Prescribed rates below this limit count as zero. Unit: sizes of the mechanism per second, or
/// rad/s. Too small: the rounding error of a cosine at a quarter turn counts as a motion. Too
/// large: slow drives count as locked. Test: `a_drive_that_moves_at_the_start_is_refused_by_name`.
pub(crate) const RESTING_RATE: f64 = 1e-12;

/// Step length of the finite differences of forces. The longest of the steps is four times as long.
/// Unit: share of the size of the mechanism, or rad. Too small: the rounding error is divided by a
/// shorter step. Too large: the stiffness of short springs is inaccurate. Test:
/// `a_short_spring_on_a_long_bar_is_stiff_enough`.
pub(crate) const STIFFNESS_STEP: f64 = 1.0 / 512.0;

/// Initial limit of the step length, for each body. Unit: share of the size of the mechanism, or
/// rad. Too small: the search takes more steps. Too large: the search may find an equilibrium that
/// is not the nearest. Test: none, work only.
pub(crate) const REST_RADIUS: f64 = 0.1;

/// Upper limit of the step length, for each body. Unit: share of the size of the mechanism, or rad.
/// Too small: the search takes more steps. Too large: the search may find an equilibrium that is
/// not the nearest. Test: none, work only.
pub(crate) const REST_LONGEST: f64 = 0.8;

/// The search ends if its steps become shorter than this limit. Unit: share of the size of the
/// mechanism, or rad. Too small: failing searches take longer. Too large: searches end early
/// although they could continue. Test: none, work only.
pub(crate) const REST_SHORTEST: f64 = 1e-10;

/// Maximum number of steps of a search. Unit: steps. Too small: distant equilibria are not found.
/// Too large: searches that do not converge take longer. Test:
/// `a_motor_that_is_too_strong_finds_no_rest`.
pub(crate) const REST_STEPS: usize = 500;

/// Number of bisections for the length of a step. Unit: halvings. Too small: steps are shorter than
/// allowed. Too large: the search takes longer. Test: none, work only.
pub(crate) const REST_BISECTIONS: usize = 50;

/// Remaining forces below this number of rounding errors of the acting forces count as zero. Unit:
/// roundings. Too small: searches continue until they stall. Too large: the equilibrium position
/// loses digits. Test: `a_pendulum_on_a_torsion_spring_leans_as_bisection_says`.
pub(crate) const REST_ROUNDINGS: f64 = 16.0;

/// If further steps do not reduce the remaining forces, forces below this number of roundings count
/// as zero. Unit: roundings. Too small: equilibria at which large forces cancel are not accepted.
/// Too large: a configuration without equilibrium is accepted. Test:
/// `forces_that_cancel_are_balanced_to_their_rounding`.
pub(crate) const REST_LEFT: f64 = 4096.0;

/// A search has stalled if the remaining force has not fallen by half in this number of steps.
/// Unit: steps. Too small: slow searches end early. Too large: stalled searches take longer. Test:
/// none, work only.
pub(crate) const REST_STALLED: usize = 4;

/// Length of the displacement by which a search leaves an unstable equilibrium. Unit: share of the
/// size of the mechanism, or rad. Too small: the forces at the displaced configuration are rounding
/// errors. Too large: a shallow equilibrium nearby is skipped. Test:
/// `a_push_lets_an_upright_pendulum_fall`.
pub(crate) const REST_PUSH: f64 = 1e-2;

/// Maximum number of displacements from unstable equilibria. Unit: pushes. Too small: the search
/// stops at an intermediate state of an upright chain. Too large: the search takes longer. Test:
/// `a_push_lets_an_upright_pendulum_fall`.
pub(crate) const REST_PUSHES: usize = 40;

/// A motion counts as free of resistance if a unit displacement along it changes its generalised
/// force by at most this share of all forces. Unit: share. Too small: a rounding error counts as
/// stiffness. Too large: soft springs are ignored. Test:
/// `what_nothing_holds_is_refused_with_what_pushes_it`.
pub(crate) const UNRESISTED: f64 = 1e-9;

/// An unresisted motion is rejected if its force is more than this share of the largest force.
/// Unit: share. Too small: remaining forces of slow searches cause an error. Too large: light
/// bodies fall for many steps before they are rejected. Test:
/// `what_nothing_holds_is_refused_with_what_pushes_it`.
pub(crate) const UNRESISTED_FORCE: f64 = 1e-6;

/// The load along a motion is reported as a moment if the motion rotates by at least this angle
/// while its fastest body moves by the size of the mechanism. Unit: rad. Too small: for a
/// translation with a small rotation, the load is divided by this small rotation. Too large: the
/// load that rotates a body about a distant axis is reported as a force. Test:
/// `what_falls_freely_is_named_with_its_weight`.
pub(crate) const MOSTLY_TURNS: f64 = 0.1;

/// A force on one body counts as constant if its change between two poses is below this share.
/// Unit: share of the force. Too small: the rounding error at distant poses counts as a change. Too
/// large: forces that change slowly count as constant. Test:
/// `what_falls_freely_is_named_with_its_weight`.
pub(crate) const DEAD_LOAD: f64 = 1e-9;

/// An unresisted motion with a force is rejected after this number of successive steps without
/// resistance. Unit: steps. Too small: a horizontal pendulum is rejected, because its weight has an
/// extremum there. Too large: the search takes longer. Test: `a_horizontal_pendulum_falls`.
pub(crate) const UNRESISTED_STEPS: usize = 3;

/// A stiffness below this share of the largest stiffness, or of all forces, counts as zero. Unit:
/// share. Too small: the rounding error of differences decides on stability. Too large: soft
/// springs count as zero stiffness. Test: `a_soft_spring_beside_a_stiff_one_still_counts`.
pub(crate) const IDLE: f64 = 1e-10;

/// Forces have no potential if the skew part of their stiffness is above this share. Unit: share.
/// Too small: rounding errors of differences count as a skew part. Too large: the stability of
/// follower forces is decided by a potential that they do not have. Test:
/// `a_follower_force_is_not_judged`.
pub(crate) const ASYMMETRIC: f64 = 1e-7;

// Linearised motions.

/// Step length along a curve. The longest of the eight steps is four times as long. Unit: share of
/// the size of the mechanism, or rad. Too small: the rounding error, 1e-16, is divided by a shorter
/// step. Too large: the truncation error, which grows with the eighth power of the step, is no
/// longer negligible. Test: `a_pendulum_has_the_matrices_of_its_textbook`.
pub(crate) const LINEARISE_STEP: f64 = 1.0 / 128.0;

/// Derivatives of two different orders may differ by at most this share of the largest derivative.
/// Unit: share. Too small: steep functions are rejected. Too large: a corner of a function is
/// accepted as a slope. Test: `a_force_with_a_corner_is_refused`.
pub(crate) const LINEARISE_ACCURACY: f64 = 1e-6;

/// Maximum number of times that the step of a difference is divided by four. The step is divided as
/// long as the difference is not an accurate derivative. Unit: quarterings. Too small: forces that
/// are steep relative to the size of the mechanism are rejected. Too large: a rounding error counts
/// as a corner. Test: `a_short_rod_in_a_large_mechanism_has_derivatives`.
pub(crate) const LINEARISE_SHORTER: usize = 3;

/// The state is at rest if each body accelerates by no more than this share of the acceleration
/// that the same forces would cause without joints. Unit: share. Too small: equilibria that are
/// accurate to only a few digits are rejected. Too large: matrices are computed for a state that
/// the motion leaves immediately. Test: `a_pendulum_held_aside_is_not_at_rest`.
pub(crate) const STEADY_ACCELERATION: f64 = 1e-6;

/// In a steady state, the rate of change of the acceleration is at most this share of the cube of
/// the natural rate. Unit: share. Too small: rounding errors of derivatives cause steady states to
/// be rejected. Too large: a mass that moves through its equilibrium counts as steady. Test:
/// `a_mass_that_passes_its_place_of_rest_is_not_steady`.
pub(crate) const STEADY_FRACTION: f64 = 1e-6;

/// A cyclic coordinate (option `follow`) may change the rates by at most this share of the largest
/// entry of A. Unit: share. Too small: rounding errors of derivatives cause symmetries to be
/// rejected. Too large: coordinates are eliminated on which the motion depends. Test:
/// `what_the_motion_depends_on_cannot_be_followed`.
pub(crate) const SYMMETRY: f64 = 1e-7;

/// Eigenvalues below this share of the largest eigenvalue count as zero. The limit is the square
/// root of the rounding error, because zero eigenvalues of free motions are double. Unit: share of
/// the largest eigenvalue. Too small: free motions seem to grow or decay. Too large: slow modes are
/// lost. Test: `the_benchmark_bicycle_has_its_published_eigenvalues`.
pub(crate) const ZERO_EIGENVALUE: f64 = 1e-7;

/// Rounding error of the entries of A, for each row of A. Unit: share of the norm of A. Too small:
/// zero eigenvalues of large Jordan blocks seem to grow. Too large: slow modes are lost in
/// mechanisms that also have stiff parts. Test:
/// `rounding_around_a_multiple_zero_neither_grows_nor_decays`.
pub(crate) const ZERO_ENTRY: f64 = 16.0 * f64::EPSILON;

/// A mode whose real part is below this share of the largest eigenvalue neither grows nor decays.
/// Unit: share of the largest eigenvalue. Too small: undamped motions are reported as unstable
/// because of rounding. Too large: lightly damped motions are not reported as stable. Test:
/// `what_first_order_says_of_stability`.
pub(crate) const NEITHER: f64 = 1e-9;

/// The free share of a direction is the part that the directions chosen before do not determine.
/// The first direction with a free share of at least this fraction of the largest free share is
/// chosen. Unit: share. Too small: the chosen coordinates may be nearly dependent. Too large: a
/// rounding error decides which coordinates are chosen. Test:
/// `a_pendulum_has_the_matrices_of_its_textbook`.
pub(crate) const CHOSEN_PIVOT: f64 = 0.3;

/// A direction is determined by the chosen directions if less than this share of it is free. Unit:
/// share. Too small: coordinates are accepted that depend on the chosen coordinates. Too large:
/// useful coordinates near a dead centre are rejected. Test:
/// `asked_coordinates_have_to_be_independent`.
pub(crate) const DEPENDENT_COORDINATE: f64 = 1e-6;

// Projection.

/// Maximum number of position corrections in one projection. One or two corrections are usual. Very
/// loose tolerances need more. Unit: corrections. Too small: steps with loose tolerances are
/// rejected. Too large: a diverging projection takes longer to fail. Test:
/// `it_is_where_its_drive_is_by_every_method`.
pub(crate) const CORRECTIONS: usize = 20;

/// Maximum number of position corrections by generated code. After this number, the run uses the
/// interpreter. Unit: corrections. Too small: the run stops using generated code at steps with
/// loose tolerances. Too large: runs take longer. Test: `limits_stand_in_their_order`.
pub(crate) const CODE_CORRECTIONS: usize = 6;

/// Maximum number of velocity corrections per projection. Unit: corrections. Too small: the
/// rounding error of the first correction remains. Too large: runs take longer. Test:
/// `it_is_where_its_drive_is_by_every_method`.
pub(crate) const VELOCITY_CORRECTIONS: usize = 3;

/// Independent rows count as satisfied if their residual is below this number of rounding errors of
/// their terms. Unit: roundings. Too small: each step needs one more correction. Too large: the
/// constraints drift. Test: `rows_are_corrected_until_they_are_satisfied_or_stall_close_to_it`.
pub(crate) const ROUNDINGS: f64 = 10.0;

/// Limit that replaces [`ROUNDINGS`] for rows whose pivots have fallen below [`WEAK`] and for
/// dependent coordinates. Unit: roundings. Too small: the limit cannot be reached. Too large: the
/// residuals of the independent rows are amplified in the redundant rows. Test:
/// `limits_stand_in_their_order`.
pub(crate) const FEW_ROUNDINGS: f64 = 1.0;

/// Pivots below this share are weak. Unit: share of pivots. Too small: redundant rows are violated
/// near singular configurations. Too large: each step needs one more correction. Test:
/// `limits_stand_in_their_order`.
pub(crate) const WEAK: f64 = 0.5;

/// Size of the terms of an independent rotation that is computed from a quaternion. The rotation is
/// a sum of four products, each of which is at most two. Unit: rad. Too small: the completion of
/// states fails because of rounding. Too large: rotations drift. Test:
/// `bricards_linkage_by_an_implicit_method`.
pub(crate) const READ_ROTATION: f64 = 8.0;

/// If a further correction does not help, independent rows count as satisfied below this number of
/// rounding errors. The same limit applies to generated code, which cannot compute more accurate
/// residuals. Unit: roundings. Too small: projections fail because of rounding. Too large: the
/// constraints drift. Test: `rows_are_corrected_until_they_are_satisfied_or_stall_close_to_it`.
pub(crate) const STALLED_ROUNDINGS: f64 = 50.0;

/// The factors of an earlier configuration are used as long as a correction reduces the residual to
/// at most this share. A factorisation costs about as much as ten corrections. Unit: share. Too
/// small: more factorisations are computed. Too large: more corrections are computed. Test:
/// `factors_serve_as_long_as_a_correction_gains_a_digit`.
pub(crate) const CONVERGENCE: f64 = 0.1;

/// The independent rows imply a redundant row if its residual is below this share of its terms. The
/// terms are those of the row itself, and those of the independent rows times their coefficients.
/// For example, the terms of a row with an arm of 1e30 m do not limit the violation of an angle.
/// Unit: share of terms. Too small: rounding errors of the independent rows, 1e-15, cause good
/// steps to be rejected. Too large: contradictions between rows are detected late. Test:
/// `drives_that_contradict_each_other_later_stop_the_run_and_keep_its_rows`.
pub(crate) const DROPPED_MISFIT: f64 = 1e-11;

/// A constraint violation that grows by less than this share counts as unchanged. In this case, the
/// time of its first occurrence is reported. Unit: share of the misfit. Too small: a rounding error
/// decides the time of a constant violation. Too large: the reported time of a growing violation is
/// too early. Test: `a_door_on_two_hinges_misses_by_their_distance`.
pub(crate) const SAME_MISFIT: f64 = 1e-9;

/// The velocities of redundant rows may differ by this share of the size of the mechanism per
/// duration of the run, even if the motion is slow. The share is some hundred rounding errors.
/// Unit: share of size. Too small: mechanisms at rest are rejected. Too large: slow contradictions
/// are not detected. Test: `limits_stand_in_their_order`.
pub(crate) const AT_REST: f64 = 1e-13;

/// The residual of a redundant row of Φ must not exceed this share of the terms of the row, even if
/// the distances in the independent rows that imply it are large. Unit: share of terms. Too small:
/// distant points cause good steps to be rejected. Too large: another configuration of the
/// independent rows is accepted. Test: `limits_stand_in_their_order`.
pub(crate) const POSITION_MISFIT: f64 = 1e-5;

/// If the pivots fall, the allowed residual of redundant rows increases, down to this share of the
/// reference pivots. Below this share, rows are left out of the solution. Unit: share of pivots.
/// Too small: redundant rows may be violated by any amount. Too large: good steps near a singular
/// configuration are rejected. Test: `limits_stand_in_their_order`.
pub(crate) const NEAREST_PIVOT: f64 = 1e-6;

/// The rows of bodies at rest contain rounding errors of the other rows. For generated code, the
/// terms of these rows count as at least this share of the largest term. Unit: share of terms. Too
/// small: the run stops using generated code if bodies are at rest. Too large: the constraints of
/// slow bodies drift. Test: none.
pub(crate) const CODE_AT_REST: f64 = 1e-4;

// Independent coordinates.

/// A partition into independent and dependent coordinates is replaced if its pivots have fallen
/// below this share of the pivots at its choice. Within a step, the pivots must not fall so far
/// that rows are omitted. Unit: share of pivots. Too small: the completion of states fails within a
/// step. Too large: linear systems are set up repeatedly. Test:
/// `partitions_are_renewed_as_a_blade_turns`.
pub(crate) const PARTITION_WORN: f64 = 0.5;

/// If a dependent coordinate moves by more than this limit when a state is completed, the state may
/// be on another branch or in another revolution. Unit: share of the mechanism's size, or rad. Too
/// small: long steps are rejected. Too large: the motion changes to another branch. Test:
/// `shifted_systems_are_solved`.
pub(crate) const FAR_COMPLETION: f64 = 0.6;

/// In addition to [`FAR_COMPLETION`], dependent coordinates may move by this multiple of a
/// distance. The distance is the displacement since the last accepted state, extrapolated with the
/// velocities of this state. Unit: ways. Too small: long steps are rejected. Too large: the motion
/// changes to another branch. Test: none.
pub(crate) const FAR_EXTRAPOLATED: f64 = 2.0;

/// Allowed distance between the end of a step and the position predicted from the velocities at
/// both ends. Unit: share of the largest displacement along the motion. Too small: steps of curved
/// motions are rejected. Too large: the motion changes to another branch. Test: none.
pub(crate) const FAR_IN_A_STEP: f64 = 0.5;

/// Allowed distance in addition to [`FAR_IN_A_STEP`]. The distance applies even if the mechanism
/// does not move. Unit: share of the mechanism's size, or rad. Too small: starts from rest are
/// rejected. Too large: the motion changes to another branch. Test:
/// `a_grip_of_1e12_takes_few_steps`.
pub(crate) const FAR_AT_REST: f64 = 1e-2;

// Exchange of independent rows.

/// Other independent rows are chosen if the pivots have fallen below this share. The rounding
/// errors of the independent rows affect the redundant rows, multiplied by the inverse of the
/// pivots. Unit: share of pivots. Too small: redundant rows are violated. Too large: the rows are
/// chosen again at every step. Test: `limits_stand_in_their_order`.
pub(crate) const PIVOT_LOSS: f64 = 0.1;

/// Share of pivots above which the rows requested by the user are used again. Unit: share of
/// pivots. Too small: the rows change at every step. Too large: the requested rows are not used
/// again. Test: `limits_stand_in_their_order`.
pub(crate) const PIVOT_RECOVERY: f64 = 0.2;

/// Rows that the program chose are exchanged if a coefficient in a redundant row is larger than
/// this limit. Unit: 1. Too small: the rows are chosen again at every step. Too large: redundant
/// rows are violated. Test: `rows_that_multiply_their_rounding_are_exchanged`.
pub(crate) const LARGE_COEFFICIENT: f64 = 10.0;

/// Other rows are used if their coefficients are smaller by at least this factor. Unit: 1. Too
/// small: the rows change at every step. Too large: badly conditioned rows are still used. Test:
/// `sixty_four_step_sizes_over_the_flat_pose`.
pub(crate) const WORTH_EXCHANGE: f64 = 3.0;

/// Output rows are checked only if the pivots are below this share. Above it, the independent rows
/// amplify rounding errors only slightly. Unit: share of pivots. Too small: the constraints are
/// violated in output rows between two steps. Too large: runs take longer. Test:
/// `limits_stand_in_their_order`.
pub(crate) const SOUND: f64 = 0.5;

// Singular configurations.

/// Below this share, positions are corrected at least once. A state whose rows have a rounding
/// error δ has a position error δ/share and an acceleration error δ/share². One correction makes
/// angles exact, for any rounding error of the coordinates. Unit: share of pivots. Too small: steps
/// through singular configurations far from the origin fail. Too large: unnecessary corrections are
/// computed. Test: `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const SHARPENED: f64 = 0.2;

/// Below this share, rows are ill-conditioned, and the stages of a method must be on the constraint
/// manifold. Unit: share of pivots. Too small: stages with a constraint violation δ have an error
/// of δ/share. Too large: ordinary steps need the additional work of projected stages. Test:
/// `limits_stand_in_their_order`.
pub(crate) const DELICATE: f64 = 0.1;

/// A step is searched for a singular configuration if the pivots of a stage are below this share.
/// Unit: share of pivots. Too small: singular configurations are not reported, and their branches
/// are not compared. Too large: ordinary steps are searched. Test:
/// `rows_that_nobody_wants_are_not_computed`.
pub(crate) const SUSPECT: f64 = 0.1;

/// Smallest allowed distance between the end of a step and a singular configuration. Unit: share of
/// pivots. Too small: a projection cannot distinguish the branches. Too large: no step can end if
/// the motion is slow. Test: `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NEAREST: f64 = 1e-3;

/// The smallest distance to a singular configuration in units of the relative tolerance. Unit:
/// tolerances. Too small: steps with loose tolerances take another branch. Too large: no step can
/// end if the motion is slow. Test: `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NEAREST_TOLERANCES: f64 = 100.0;

/// Upper limit of the smallest distance to a singular configuration, for loose tolerances. Unit:
/// share of pivots. Too small: steps with loose tolerances take another branch. Too large: runs
/// with loose tolerances stop. Test: `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NEAREST_MAX: f64 = 0.1;

/// A step that approaches a singular configuration suddenly is repeated with a shorter length if it
/// ends closer than this multiple of the smallest distance. The rounding error of accelerations
/// grows with the inverse third power of the distance. Unit: nearest approaches. Too small: the
/// next step starts at a state at which rounding errors dominate its stages. Too large: steps are
/// rejected unnecessarily. Test: `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const NEARBY: f64 = 10.0;

/// An approach is sudden if the pivot has fallen to this share. Unit: share of the pivot at the
/// last accepted step. Too small: the next step starts at a state at which rounding errors dominate
/// its stages. Too large: motions that stay near a singular configuration are slowed down. Test:
/// `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const FALLEN: f64 = 0.1;

/// Singular configurations are predicted for this multiple of the last step. No method increases
/// its step by a larger factor. Unit: steps. Too small: a step reaches an unpredicted singular
/// configuration. Too large: unnecessary searches are made. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const FORESIGHT: f64 = 12.0;

/// An implicit method is replaced by `dop853` this number of steps before a singular configuration.
/// An explicit method is replaced as soon as the singular configuration is predicted. Unit: steps.
/// Too small: implicit methods step over the singular configuration and fail. Too large: explicit
/// steps are made under stiff forces. Test: `a_grip_of_1e12_takes_few_steps`.
pub(crate) const IMPLICIT_REACH: f64 = 4.0;

/// Limit for the constraint violation that the rounding error of the coordinates causes. Above this
/// limit, stages are moved onto the constraints as soon as a singular configuration is predicted.
/// Unit: share of the size of the mechanism. Too small: steps towards the singular configuration
/// lose the order of accuracy of the method. Too large: steps through singular configurations far
/// from the origin fail. Test: `parallelograms_pass_their_flat_poses_at_speed`.
pub(crate) const COARSE: f64 = 1e-13;

/// Smallest weight of a component near zero in the error norm of a step over a singular
/// configuration. The rounding error does not decrease with the component. Unit: tolerances times
/// the size of the mechanism. Too small: the step size collapses before the singular configuration
/// if a component is near zero. Too large: the motion changes to another branch. Test:
/// `a_passage_far_away_is_as_good_as_its_coordinates_are_known`.
pub(crate) const LEAST_SCALE: f64 = 0.1;

/// Relative error that rounding may cause in a step over a singular configuration if the steps are
/// short. A limit of 1e-10 was not enough at a tolerance of 1e-10 if the run switched to the
/// interpreter before the singular configuration. Unit: 1. Too small: the step size collapses
/// before the singular configuration. Too large: the step over the singular configuration loses
/// digits. Test: none.
pub(crate) const PASSED: f64 = 1e-9;

/// Largest correction of a step over a singular configuration. Unit: share of the distance at which
/// the step ends. Other branches are at a similar distance. Too small: runs stop before the
/// singular configuration. Too large: the motion changes to another branch. Test:
/// `a_run_may_end_in_the_flat_pose_or_beside_it`.
pub(crate) const SMOOTH: f64 = 0.01;

/// Allowed difference between two velocities after a singular configuration: the computed
/// velocities, and the velocities extrapolated with the accelerations on both sides. A step over a
/// singular configuration is short relative to the curvature of the motion, and another branch has
/// another direction. Unit: share of momentum. Too small: runs stop after the singular
/// configuration. Too large: the motion changes to another branch. Test:
/// `flat_poses_of_many_four_bars_are_passed_on_the_branch`.
pub(crate) const KINK: f64 = 0.25;

/// If the step size becomes too small, a contradiction of constraints is reported as the cause. The
/// contradiction must lie at most this share of the run after the last state. Unit: share of the
/// run. Too small: the contradiction is not reported as the cause. Too large: a later contradiction
/// is reported as the cause, although it did not stop the run. Test:
/// `a_contradiction_just_ahead_is_why_a_run_stops`.
pub(crate) const JUST_AHEAD: f64 = 1e-9;

/// Reactions are not reported if the pivots are below this share. Unit: share of pivots. Too small:
/// reactions are rounding errors. Too large: accurate reactions are left out. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NO_REACTIONS: f64 = 1e-6;

/// The limit for reactions in units of the relative tolerance. A row with a motion error δ has
/// reactions with an error of δ/share. Unit: tolerances. Too small: reactions are wrong. Too large:
/// accurate reactions are left out. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NO_REACTIONS_TOLERANCES: f64 = 1e3;

/// Share of pivots above which reactions are reported even if the tolerance is loose. Unit: share
/// of pivots. Too small: reactions are wrong. Too large: accurate reactions are left out. Test:
/// `pivots_are_compared_with_what_the_tolerance_leaves_of_them`.
pub(crate) const NO_REACTIONS_MAX: f64 = 1e-2;

// Search for singular instants.

/// Number of intervals into which a step is divided for the first search. Unit: intervals. Too
/// small: two singular configurations within a step count as one. Too large: the search takes
/// longer. Test: `forty_four_bars_are_where_one_angle_says`.
pub(crate) const PLACES: usize = 16;

/// Accuracy of the instant at which a pivot is smallest. The pivot is then accurate to the same
/// share. Unit: share of the interval. Too small: the search takes longer. Too large: singular
/// configurations are overlooked. Test: none.
pub(crate) const SHARP: f64 = 1e-7;

/// A singular configuration is searched for up to this multiple of a distance. The distance is that
/// at which a linear extrapolation reaches the singular configuration. Unit: distances. Too small:
/// pivots that vanish along a curve are not predicted. Too large: the search takes longer. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const BEYOND: f64 = 1.5;

/// A pivot that falls to this share of the current pivot and rises again counts as vanishing,
/// because the predicted path is only a parabola. Unit: share of the current pivot. Too small:
/// singular configurations are not predicted. Too large: steps avoid regular configurations. Test:
/// `limits_stand_in_their_order`.
pub(crate) const VANISHES: f64 = 0.2;

/// A search is made if a pivot falls below this share of the current pivot at one of [`GLANCES`]
/// instants. A pivot that vanishes between two of these instants is detected, unless it vanishes
/// much earlier than expected. Unit: share of the current pivot. Too small: singular configurations
/// are not predicted. Too large: the search takes longer. Test: `limits_stand_in_their_order`.
pub(crate) const STAYS: f64 = 0.75;

/// Number of instants at which a pivot is evaluated before a search. Unit: places. Too small:
/// singular configurations are not predicted. Too large: the search takes longer. Test:
/// `forty_four_bars_are_where_one_angle_says`.
pub(crate) const GLANCES: usize = 6;

/// A pivot has a minimum between two instants if it falls to this share of both neighbouring
/// values. A pivot that is small at an end of the searched interval has no minimum there. Unit:
/// share of the pivots at the neighbouring samples. Too small: singular configurations are not
/// found. Too large: one singular configuration is reported twice. Test:
/// `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const RISES: f64 = 0.5;

/// A search assumes that, between two instants, a pivot falls by at most this multiple of its
/// largest change between neighbouring instants. Unit: 1. Too small: singular configurations are
/// not found. Too large: the search takes longer. Test:
/// `a_pivot_that_vanishes_as_a_root_is_searched_for`.
pub(crate) const STEEPER: f64 = 2.0;

/// At a singular configuration, the independent rows that are still used imply a redundant row if
/// at most this share of the row remains. A redundant row that replaces an independent row remains
/// nearly in full. Unit: share of the row. Too small: the rank is decided at every singular
/// configuration, which takes longer. Too large: replaced rows count as a loss of rank. Test:
/// `a_row_that_replaces_another_is_no_loss`.
pub(crate) const IMPLIED: f64 = 1e-2;

/// Number of intervals into which a step is divided to analyse the motion through a singular
/// configuration. Unit: intervals. Too small: the analysis does not find the singular
/// configuration. Too large: the analysis takes longer. Test:
/// `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const PASSAGE_STATES: usize = 8;

/// Maximum number of rows for which the motion through a singular configuration is analysed. The
/// work for determinants at many instants grows with the cube of the rows. Unit: rows. Too small:
/// uniqueness is not decided. Too large: the analysis takes longer. Test:
/// `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const JUDGED_MOST: usize = 64;

/// Maximum number of singular configurations that are reported for one step. Unit: passages. Too
/// small: some singular configurations are not reported. Too large: the search takes longer. Test:
/// `passages_are_told_at_the_same_time`.
pub(crate) const MOST_PASSAGES: usize = 8;

/// Smallest distance between two singular configurations of one step. Unit: share of the step. Too
/// small: one singular configuration counts twice. Too large: two singular configurations count as
/// one. Test: `a_driven_parallelogram_goes_on_smoothly_and_says_so`.
pub(crate) const BESIDE: f64 = 0.02;

// Jumps.

/// Residuals below this share of the terms of their row do not count as jumps. For rates, the
/// reference is the sum of the terms of the row with the largest terms. Unit: share of terms. Too
/// small: a rounding error counts as an impulse. Too large: small jumps are not reported. Test:
/// `smooth_steps_are_no_jumps`.
pub(crate) const NO_JUMP: f64 = 1e-9;

/// A continuous function changes much more between two times that are this number of rounding
/// errors apart than between neighbouring floating-point numbers. Unit: roundings. Too small:
/// rounding errors hide the change. Too large: other changes are included. Test:
/// `smooth_steps_are_no_jumps`.
pub(crate) const WIDE: f64 = 1e6;

/// A change is a jump if the change over the narrow interval is more than this share of the change
/// over the wide interval ([`WIDE`]). Unit: share. Too small: steep functions count as jumps. Too
/// large: jumps count as steep functions. Test: `a_jump_of_the_rate_is_an_impulse_with_its_energy`.
pub(crate) const REMAINS: f64 = 0.5;

// Rows of output.

/// Allowed distance between an output row and the cubic through both ends of its step. Unit: share
/// of the displacement of the step. Too small: good output rows are rejected. Too large: output
/// rows on another branch are accepted. Test: `rows_lie_where_their_step_leads`.
pub(crate) const ROW_DEVIATION: f64 = 0.25;

/// Allowed distance in addition to [`ROW_DEVIATION`]. The distance applies even if the mechanism
/// does not move. Unit: share of the mechanism's size, or rad. Too small: good output rows are
/// rejected. Too large: output rows on another branch are accepted. Test:
/// `rows_lie_where_their_step_leads`.
pub(crate) const ROW_DEVIATION_AT_REST: f64 = 1e-3;

/// Velocities along a step may be this multiple of the mean velocity of the step. Unit: 1. Too
/// small: output rows are rejected if drives are at rest at both ends of a step. Too large: output
/// rows on another branch are accepted. Test:
/// `a_drive_that_rests_at_both_ends_of_a_step_may_be_fast_between`.
pub(crate) const PEAK: f64 = 3.0;

/// Number of trials after which a step that is repeated many times discards its stored stages.
/// Unit: times. Too small: stages are evaluated twice. Too large: more memory is used. Test: none,
/// work only.
pub(crate) const REMEMBERED: usize = 256;

/// Number of output rows by which a component may be ahead of the other components. Unit: rows. Too
/// small: threads wait for each other. Too large: more memory is used. Test: none, work only.
pub(crate) const AHEAD: usize = 64;

// Generated code.

/// A run stops using generated code below this health, because the interpreter must detect a
/// singular configuration in advance. A run does not start with code below this health. Unit: share
/// of the pivots for which the code was generated. Too small: generated code reaches singular
/// configurations. Too large: a run stops using code that is still accurate. Test:
/// `limits_stand_in_their_order`.
pub const LEAVE: f64 = 0.1;

/// Health above which a run uses generated code again. Unit: share of the pivots for which the code
/// was generated. Too small: the run switches frequently. Too large: the code is not used again.
/// Test: `limits_stand_in_their_order`.
pub(crate) const RETURN: f64 = 0.3;

/// Number of accepted steps before generated code is used again for the first time. The number
/// doubles each time the run stops using the code. Unit: steps. Too small: the run switches
/// frequently. Too large: runs take longer. Test: `code_that_is_not_sure_is_left_and_comes_back`.
pub(crate) const PATIENCE: u64 = 8;

/// Largest allowed difference between the accelerations of generated code and of the interpreter
/// when the run uses the code again. Unit: share of the largest value. Too small: rounding errors
/// prevent the use of code. Too large: wrong code is used again. Test: none.
pub(crate) const SAME_ACCELERATIONS: f64 = 1e-9;

/// Allowed difference between the values of generated code and of the interpreter at the start and
/// at states near the start. Unit: share of terms. Too small: rounding errors cause code to be
/// rejected. Too large: code of a similar mechanism is accepted. Test:
/// `code_of_another_mechanism_is_refused`.
pub(crate) const SAME_VALUES: f64 = 1e-9;

/// Number of states near the start at which values are compared. Unit: states. Too small: the code
/// of another mechanism agrees by chance. Too large: the comparison takes longer. Test: none.
pub(crate) const CODE_STATES: usize = 6;

/// Distance from the start of the states for this comparison. Unit: size of the mechanism, or rad.
/// Too small: differences in geometry are not detected. Too large: the code is not healthy at these
/// states. Test: none.
pub(crate) const DISTANCE: f64 = 0.01;

/// Velocities at the states for this comparison. The velocities must be so large that terms
/// quadratic in the velocities are significant. Unit: size of the mechanism, or rad, per second.
/// Too small: these terms are not significant. Too large: these terms dominate all other terms.
/// Test: `code_of_another_mechanism_is_refused`.
pub(crate) const SPEED: f64 = 1.0;

// Choices of method and components.

/// A motion is stiff if an explicit method would need more steps than this number for stability
/// alone. Unit: steps. Too small: implicit methods are used for motions that explicit methods
/// compute faster. Too large: runs take hours. Test:
/// `components_move_as_they_do_alone_and_each_at_its_own_pace`.
pub(crate) const STIFF: f64 = 2e4;

/// From this number of steps for stability alone, a motion is also stiff if its decays are faster
/// than all other motions by the factor [`GAP`]. Unit: steps. Too small: implicit methods are used
/// for short runs, which explicit methods compute faster. Too large: robots with dampers require up
/// to a hundred times as many evaluations. Test: `fast_decays_are_stiff_and_oscillations_are_not`.
pub(crate) const STIFF_DECAY: f64 = 200.0;

/// At the relative tolerance [`GAP_RTOL`], an implicit method takes less work than an explicit
/// method if decays are faster than all other motions by this factor. The factor grows with the
/// power −1/5 of the tolerance, like the number of steps of Radau IIA. For an oscillation with a
/// decay, the two methods take the same time at 8, 22, 45 and 130 times for tolerances of 1e-4,
/// 1e-6, 1e-8 and 1e-10. With more degrees of freedom, steps of the implicit method take
/// relatively more time. Unit: 1. Too small: implicit methods compute oscillations that explicit
/// methods compute faster. Too large: the effect is the same as for [`STIFF_DECAY`]. Test:
/// `fast_decays_are_stiff_and_oscillations_are_not`.
pub(crate) const GAP: f64 = 100.0;

/// Relative tolerance for [`GAP`]. Unit: 1. Too small or too large: the effects are the same as for
/// [`GAP`]. Test: `fast_decays_are_stiff_and_oscillations_are_not`.
pub(crate) const GAP_RTOL: f64 = 1e-6;

/// Explicit steps are stable up to about this multiple of 1/|λ|. The value belongs to
/// Dormand–Prince 8(5,3) along the negative real axis.
/// Unit: 1. Too small or too large: the effects are the same as for [`STIFF`]. Test:
/// `explicit_steps_are_stable_up_to_the_limit_and_not_far_beyond`.
pub(crate) const STABLE: f64 = 6.0;

/// Number of iterations for the largest |λ|. Only the second half is used for the result. Unit:
/// iterations. Too small: the rate of oscillations is wrong. Too large: the choice takes longer.
/// Test: `the_fastest_rate_is_found_also_of_oscillations`.
pub(crate) const POWER_ITERATIONS: usize = 64;

/// Maximum number of components that run at the same time, each on its own thread. Unit: threads.
/// Too small: many mechanisms must use the same steps. Too large: threads cost more time than they
/// save. Test: `too_many_components_stay_one`.
pub(crate) const MOST_COMPONENTS: usize = 256;

/// Maximum number of bodies of a component that are named. For more bodies, their number is
/// printed. Unit: bodies. Too small or too large: names of components are too short or too long.
/// Test: `three_bodies_are_named_and_more_are_counted`.
pub(crate) const NAMED: usize = 3;

/// Rows with a weight below this share of the largest weight are not listed in a combination that
/// is reported. Unit: share. Too small: insignificant rows are listed. Too large: significant rows
/// are not listed. Test: `a_start_names_the_rows_that_nearly_depend_and_no_others`.
pub(crate) const TAKES_PART: f64 = 0.1;

// Default options of a run.

impl MotionOptions {
    /// Default number of output steps of a run. Unit: steps. Too small: curves in figures show
    /// corners. Too large: files are large. Test: `a_turn_is_as_round_as_a_picture_shows`.
    pub const OUTPUT_STEPS: f64 = 200.0;

    /// Default relative tolerance. Unit: 1. Too small: runs take longer. Too large: motions are
    /// wrong in digits that users read. Test:
    /// `motions_without_stated_tolerances_have_the_digits_that_are_read`.
    pub const RTOL: f64 = 1e-8;

    /// Default absolute tolerance. Unit: m or rad, and m/s or rad/s. Too small or too large: the
    /// effects are the same as for the relative tolerance. Test:
    /// `motions_without_stated_tolerances_have_the_digits_that_are_read`.
    pub const ATOL: f64 = 1e-10;

    /// Allowed range of the relative tolerance. Unit: 1. Too small: the rounding error of a step is
    /// larger than the tolerance. Too large: the error of a step is not small. Test:
    /// `the_ends_of_the_ranges_are_right`.
    pub const RTOL_RANGE: RangeInclusive<f64> = 1e-15..=0.1;

    /// Description of [`MotionOptions::RTOL_RANGE`] for error messages.
    pub const RTOL_EXPECTED: &str = "a number from 1e-15 (rounding) to 0.1";

    /// Maximum number of output rows. For a hundred bodies with six values each, the output then
    /// takes some 100 GB. Unit: rows. Too small: long runs are rejected. Too large: the table of a
    /// run fills the disk. Test: `runs_that_would_never_end_are_refused_by_name`.
    pub const MOST_ROWS: f64 = 1e7;

    /// Default maximum number of accepted and rejected steps. Unit: steps. Too small: long runs are
    /// rejected. Too large: runs that do not end are not stopped. Test:
    /// `runs_that_would_never_end_are_refused_by_name`.
    pub const MAX_STEPS: u64 = 1_000_000;
}

/// Accuracy of the instant at which one-sided joints open, relative to the time. Unit:
/// dimensionless. Too small: rounding decides. Too large: the instant is late. Test:
/// `a_body_leaves_its_supports_at_the_instant_of_the_closed_form`.
pub(crate) const OPENING_TIME: f64 = 1e-15;

/// Maximum number of states at which the opening instant is searched. Unit: states. Too small: the
/// instant is inaccurate. Too large: the search takes long. Test: none, work only.
pub(crate) const OPENING_SEARCH: usize = 80;

#[cfg(test)]
mod tests {
    use super::*;

    /// In each row of the table, each value is less than the next value. Otherwise a state would
    /// belong to two classes.
    #[test]
    fn limits_stand_in_their_order() {
        let rows: [(&str, &[f64]); 11] = [
            ("roundings", &[FEW_ROUNDINGS, ROUNDINGS, STALLED_ROUNDINGS]),
            (
                "a row becomes independent again without the loss of another row",
                &[PIVOT_LOSS, PIVOT_RECOVERY],
            ),
            (
                "rows are corrected further before other rows replace them",
                &[PIVOT_LOSS, PIVOT_RECOVERY, WEAK, 1.0],
            ),
            (
                "generated code is used again although its pivots have not decreased",
                &[LEAVE, RETURN],
            ),
            (
                "output rows are omitted although no step ends near them",
                &[PIVOT_SINGULAR, NEAREST],
            ),
            (
                "no step ends nearer",
                &[NEAREST, NEAREST_MAX, 2.0 * DELICATE],
            ),
            ("delicate rows are not sound", &[DELICATE, SOUND, 1.0]),
            (
                "reactions are reported only at ends of steps",
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
        // If rows are left out, redundant rows must not have residuals larger than this limit.
        assert_eq!([NEAREST_PIVOT], [PIVOT_SINGULAR]);
    }
}
