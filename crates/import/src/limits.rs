//! Numbers that were chosen by the authors. Limits of a file before parsing prevent that a file
//! uses all memory or the whole stack. Other numbers define when loops are closed, axes are
//! parallel and numbers are exact, or are defaults of formats.

/// Largest size of a file.
/// Unit: bytes. Less: large scans of robots with comments are rejected. More: a malicious file uses
/// some 20 times as much memory. Test: `hostile_files_are_refused`.
pub(crate) const LARGEST: usize = 16 << 20;

/// Maximum number of nodes of a file: elements, texts and comments.
/// Unit: number. Less: a group of many robots is rejected. More: more memory is used. Test:
/// `hostile_files_are_refused`.
pub(crate) const MOST_NODES: u32 = 1 << 19;

/// Maximum nesting depth of elements.
/// Unit: number. Less: a long chain of nested bodies is rejected. More: recursive readers overflow
/// the stack. Test: `hostile_files_are_refused`.
pub(crate) const DEEPEST: usize = 300;

/// Maximum number of attributes of an element.
/// Unit: number. Less: no element of a format has more than 60, but extensions may have more. More:
/// more time is used, which grows with the second power. Test: `many_attributes_cost_no_time`.
pub(crate) const MOST_ATTRIBUTES: usize = 256;

/// Maximum number of declarations of name spaces in a file.
/// Unit: number. Less: files that repeat them in each element are rejected. More: more time is
/// used, because all declarations are valid within the elements that contain them. Test:
/// `many_attributes_cost_no_time`.
pub(crate) const MOST_NAME_SPACES: usize = 1024;

/// Maximum number of included files.
/// Unit: number. Less: a model of many parts is rejected. More: more memory is used. Test:
/// `includes_stay_in_their_folder`.
pub(crate) const MOST_FILES: usize = 64;

/// Maximum number of listed problems.
/// Unit: number. Less: a user needs more rounds of corrections. More: the list is too long to read.
/// Test: `problems_are_counted`.
pub(crate) const MOST_PROBLEMS: usize = 100;

/// Finest digit that is used as a tolerance.
/// Unit: share of the size, or rad. Less: the sixteenth digit of a double is a tolerance. More:
/// files with twelve digits count as exact. Test: `digits_give_the_tolerance`.
pub(crate) const FINEST: f64 = 1e-12;

/// Coarsest digit that is used as a tolerance.
/// Unit: share of the size, or rad. Less: files with three digits count as exact, and their
/// redundant rows as independent. More: numbers such as 0.5 written by hand count as inaccurate.
/// Test: `digits_give_the_tolerance`.
pub(crate) const COARSEST: f64 = 1e-3;

/// Gap below which a loop is closed.
/// Unit: share of the size, or rad. Less: rounding errors of long chains count as a gap. More: the
/// reader of scenes moves links that count as assembled. Test: `loops_are_closed_from_a_guess`.
pub(crate) const ASSEMBLED: f64 = 1e-11;

/// Largest gap that is accepted with a remark, if no pose closes the loops better because data with
/// few digits are inconsistent.
/// Unit: share of the size, or rad. Less: models with rounded numbers are rejected. More: open
/// loops count as closed. Test: `loops_that_cannot_close_are_refused`.
pub(crate) const CLOSED: f64 = 1e-4;

/// Gap at the described pose beyond which another pose is searched for.
/// Unit: as [`CLOSED`]. Less: rounding errors move all links. More: the reader of scenes must move
/// the links. Test: `loops_are_closed_from_a_guess`.
pub(crate) const OPEN: f64 = 1e-7;

/// Maximum number of steps of one search.
/// Unit: number. Less: poses far from the guess are not found. More: the search takes longer. Test:
/// `loops_are_closed_from_a_guess`.
pub(crate) const ITERATIONS: usize = 100;

/// Number of searches from other guesses.
/// Unit: number. Less: loops are not closed from a bad guess. More: it takes longer until a model
/// is rejected. Test: `loops_are_closed_from_a_guess`.
pub(crate) const GUESSES: usize = 24;

/// Maximum number of coordinates of a search.
/// Unit: number. Less: humanoid robots with many loops are not assembled. More: memory and time
/// grow with the third power. Test: `many_coordinates_are_not_tried`.
pub(crate) const MOST_COORDINATES: usize = 400;

/// Angle below which axes are parallel; it allows for the rounding error of products of rotations.
/// Unit: rad. Less: rounding errors are reported as a tilt. More: a tilt in the twelfth digit is
/// not reported. Test: `tilted_axes_are_told`.
pub(crate) const EXACT: f64 = 1e-12;

/// Angle up to which axes of a loop are reported as nearly parallel.
/// Unit: rad. Less: an accidental tilt of some degrees is not reported. More: spatial loops are
/// reported as nearly planar. Test: `tilted_axes_are_told`.
pub(crate) const NEARLY: f64 = 0.15;

/// Angle up to which axes are made parallel on request, even if it is larger than the digits of the
/// file explain.
/// Unit: rad. Less: π/2 written as 1.57 is not corrected. More: intended tilts are removed. Test:
/// `tilted_axes_are_told`.
pub(crate) const SNAPPED: f64 = 2e-3;

/// Cosine below which two intersecting hinges of one body are a universal joint.
/// Unit: 1. Less: because of rounding errors of unit vectors, a massless body is created between
/// the hinges. More: axes that are not perpendicular are made perpendicular. Test:
/// `every_file_is_a_scene`.
pub(crate) const PERPENDICULAR: f64 = 4.0 * f64::EPSILON;

/// Cosine below which both axes of a universal joint of SDF count as perpendicular; six digits have
/// this accuracy.
/// Unit: 1. Less: a massless body is created between rounded axes. More: oblique axes are made
/// perpendicular. Test: `loops_springs_and_limits`.
pub(crate) const RIGHT_ANGLE: f64 = 1e-6;

/// Largest number, as in scenes.
/// Unit: that of the number. Less: no effect is known. More: products of numbers overflow. Test:
/// `numbers_have_bounds`.
pub(crate) const LARGEST_NUMBER: f64 = 1e60;

/// Products of inertia below this share of the largest entry of a tensor are rounding errors of a
/// rotation or a sum.
/// Unit: 1. Less: diagonal tensors are written with products such as 1e-19. More: products that a
/// file states are removed. Test: `rounded_products_are_zero`.
pub(crate) const ROUNDING: f64 = 1e-15;

/// Allowed difference between a coordinate and its requested value.
/// Unit: share of the value, at least of 1 m or rad. Less: rounding errors are reported as a
/// change. More: a change in the ninth digit is not reported. Test:
/// `values_that_cannot_be_held_are_told`.
pub(crate) const HELD: f64 = 1e-9;

/// Angle in radians beyond which an angle looks like degrees: one revolution, whose last digit may
/// be rounded up.
/// Unit: rad. Less: a full revolution is reported. More: small angles in degrees are not reported.
/// Test: `angles_of_another_unit_are_seen`.
pub(crate) const TURN: f64 = 6.3;

/// An angle in degrees looks like radians if its distance from π/4, π/6 or one of their multiples
/// is at most this.
/// Unit: rad. Less: 1.57 is not reported. More: ordinary angles of few degrees are reported. Test:
/// `angles_of_another_unit_are_seen`.
pub(crate) const COMMON_ANGLE: f64 = 1e-3;

/// Step of finite differences for derivatives of gaps: their error is some 1e-10, which does not
/// slow down Newton's method.
/// Unit: 1 (rad, sizes). Less: the rounding error grows. More: the truncation error of the
/// difference grows. Test: `loops_are_closed_from_a_guess`.
pub(crate) const DIFFERENCE: f64 = 1e-5;

/// Distance below which two axes meet, as a share of the accuracy of lengths.
/// Unit: 1. Less: rounding errors are reported as a distance. More: distances in the last digit are
/// not reported. Test: `tilted_axes_are_told`.
pub(crate) const MEETING: f64 = 1e-6;

/// Maximum number of names in advice.
/// Unit: number. Less: the intended name is not in the list. More: the list is too long to read.
/// Test: `names_that_no_format_knows_are_refused`.
pub(crate) const MOST_LISTED: usize = 16;

/// Maximum number of letters of a file name in a message.
/// Unit: number. Less: different names look equal. More: a malicious name fills the screen. Test:
/// `names_that_no_format_knows_are_refused`.
pub(crate) const SHOWN: usize = 40;

/// Longest name of a scene, without the characters that are added to it.
/// Unit: number of letters. Less: different long names become equal. More: the reader of scenes
/// rejects them. Test: `names_are_made_fit_and_told`.
pub(crate) const LONGEST_NAME: usize = 900;

/// Width of comments of a scene.
/// Unit: number of letters. Less: comments have more lines. More: editors break the lines. Test:
/// `comments_are_broken_into_lines`.
pub(crate) const WIDTH: usize = 110;

/// Maximum nesting depth of lists in a file of loops.
/// Unit: number. Less: pairs in a list are rejected. More: a malicious file overflows the stack.
/// Test: `faults_of_a_yaml_have_places`.
pub(crate) const DEEPEST_LIST: usize = 8;

/// Default gravity along z for files without gravity.
/// Unit: m/s². Less or more: every weight is wrong. Test:
/// `a_file_without_gravity_has_that_of_the_earth`.
pub(crate) const GRAVITY: f64 = -9.81;

/// Default density of geoms in MuJoCo.
/// Unit: kg/m³. Less or more: masses are wrong. Test: `masses_come_from_geoms`.
pub(crate) const DENSITY: f64 = 1000.0;
