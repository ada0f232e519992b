//! Constants chosen by the authors. Some limits are checked before parsing; they prevent a file
//! from using all memory or the whole stack. Some constants define when loops are closed, axes are
//! parallel and values are exact. The other constants are defaults of formats.

/// Largest size of a file. Unit: bytes. Too small: large scans of robots with comments are
/// rejected. Too large: a malicious file of this size uses about 20 times as much memory. Test:
/// `hostile_files_are_refused`.
pub(crate) const LARGEST: usize = 16 << 20;

/// Maximum number of nodes of a file: elements, texts and comments. Unit: number. Too small: a
/// group of many robots is rejected. Too large: more memory is used. Test:
/// `hostile_files_are_refused`.
pub(crate) const MOST_NODES: u32 = 1 << 19;

/// Maximum nesting depth of elements. Unit: number. Too small: a long chain of nested bodies is
/// rejected. Too large: recursive readers overflow the stack. Test: `hostile_files_are_refused`.
pub(crate) const DEEPEST: usize = 300;

/// Maximum nesting depth of models in SDF, including the models of included files. Unit: number.
/// Too small: a robot of nested modules is rejected. Too large: recursive readers overflow the
/// stack. Test: `models_are_nested`.
pub(crate) const DEEPEST_MODEL: usize = 32;

/// Maximum number of attributes of an element. Unit: number. Too small: elements with many
/// attributes of extensions are rejected; the formats define at most 60. Too large: the time grows
/// with the square of the number. Test: `many_attributes_cost_no_time`.
pub(crate) const MOST_ATTRIBUTES: usize = 256;

/// Maximum number of declarations of name spaces in a file. Unit: number. Too small: files that
/// repeat the declarations in each element are rejected. Too large: more time is used, because the
/// parser searches all declarations of the surrounding elements. Test:
/// `many_attributes_cost_no_time`.
pub(crate) const MOST_NAME_SPACES: usize = 1024;

/// Maximum number of included files. Unit: number. Too small: a model of many parts is rejected.
/// Too large: more memory is used. Test: `includes_stay_in_their_folder`.
pub(crate) const MOST_FILES: usize = 64;

/// Maximum number of listed problems. Unit: number. Too small: a user must correct and import a
/// file more often. Too large: the list is too long to read. Test: `problems_are_counted`.
pub(crate) const MOST_PROBLEMS: usize = 100;

/// Finest digit that is used as a tolerance. Unit: share of the size of the mechanism, or rad. Too
/// small: the sixteenth digit of a double counts as a tolerance. Too large: files with twelve
/// digits count as exact. Test: `digits_give_the_tolerance`.
pub(crate) const FINEST: f64 = 1e-12;

/// Coarsest digit that is used as a tolerance. Unit: share of the size of the mechanism, or rad.
/// Too small: files with three digits count as exact, and redundant rows of these files count as
/// independent. Too large: numbers such as 0.5 written by hand count as inaccurate. Test:
/// `digits_give_the_tolerance`.
pub(crate) const COARSEST: f64 = 1e-3;

/// Gap below which a loop counts as closed. Unit: share of the size of the mechanism, or rad. Too
/// small: rounding errors of long chains count as a gap. Too large: the reader of scenes moves
/// links that count as assembled. Test: `loops_are_closed_from_a_guess`.
pub(crate) const ASSEMBLED: f64 = 1e-11;

/// Distance of a joint from its parent frame above which the distance is reported. Unit: m. Too
/// small: rounded poses are reported. Too large: a joint at a wrong place is not reported. Test:
/// `a_joint_far_from_its_parent_frame_is_told`.
pub(crate) const APART: f64 = 1e-6;

/// Largest gap of a loop that the import accepts, with a tolerance that covers the gap. Such a gap
/// remains at the best pose if data with few digits are inconsistent. Unit: share of the size of
/// the mechanism, or rad. Too small: models with rounded numbers are rejected. Too large: open
/// loops count as closed. Test: `loops_that_cannot_close_are_refused`.
pub(crate) const CLOSED: f64 = 1e-3;

/// Tolerance of a scene whose loops leave gaps, for each largest gap. Unit: none. Too small: the
/// start, which moves all links, finds no pose within the tolerance. Too large: rows that are
/// independent count as redundant. Test: `loops_that_nearly_close_have_a_tolerance`.
pub(crate) const COVERS: f64 = 3.0;

/// Gap at the described pose. If the gap is larger, the import searches for another pose. Unit: as
/// [`CLOSED`]. Too small: rounding errors move all links. Too large: the reader of scenes must move
/// the links. Test: `loops_are_closed_from_a_guess`.
pub(crate) const OPEN: f64 = 1e-7;

/// Maximum number of steps of one search. Unit: number. Too small: poses far from the guess are not
/// found. Too large: the search takes longer. Test: `loops_are_closed_from_a_guess`.
pub(crate) const ITERATIONS: usize = 100;

/// Number of searches from other guesses. Unit: number. Too small: loops are not closed from a bad
/// guess. Too large: the rejection of a model takes longer. Test: `loops_are_closed_from_a_guess`.
pub(crate) const GUESSES: usize = 24;

/// Maximum number of coordinates of a search. Unit: number. Too small: humanoid robots with many
/// loops are not assembled. Too large: time grows with the third power of the number. Test:
/// `many_coordinates_are_not_tried`.
pub(crate) const MOST_COORDINATES: usize = 400;

/// Angle below which axes count as parallel; this value allows for the rounding error of products
/// of rotations. Unit: rad. Too small: rounding errors are reported as a tilt. Too large: a tilt in
/// the twelfth digit is not reported. Test: `tilted_axes_are_told`.
pub(crate) const EXACT: f64 = 1e-12;

/// Angle up to which axes of a loop are reported as nearly parallel. Unit: rad. Too small: an
/// accidental tilt of some degrees is not reported. Too large: spatial loops are reported as nearly
/// planar. Test: `tilted_axes_are_told`.
pub(crate) const NEARLY: f64 = 0.15;

/// Angle up to which axes are made parallel on request, even if the number of digits in the file
/// does not explain this angle. Unit: rad. Too small: π/2 written as 1.57 is not corrected. Too
/// large: intended tilts are removed. Test: `tilted_axes_are_told`.
pub(crate) const SNAPPED: f64 = 2e-3;

/// Cosine below which two intersecting hinges of one body become a universal joint. Unit: 1. Too
/// small: because of rounding errors of unit vectors, a massless body is created between the
/// hinges. Too large: axes that are not perpendicular are made perpendicular. Test:
/// `every_file_is_a_scene`.
pub(crate) const PERPENDICULAR: f64 = 4.0 * f64::EPSILON;

/// Cosine below which the two axes of a universal joint of SDF count as perpendicular. It is the
/// accuracy of six digits. Unit: 1. Too small: a massless body is created between rounded axes. Too
/// large: oblique axes are made perpendicular. Test: `loops_springs_and_limits`.
pub(crate) const RIGHT_ANGLE: f64 = 1e-6;

/// Largest value of a number, the same as in scenes. Unit: the unit of the number. Too small: large
/// values are rejected; no file with such values is known. Too large: products of values overflow.
/// Test: `numbers_have_bounds`.
pub(crate) const LARGEST_NUMBER: f64 = 1e60;

/// Products of inertia below this share of the largest entry of a tensor are rounding errors of a
/// rotation or a sum. Unit: 1. Too small: diagonal tensors are written with products of inertia
/// such as 1e-19. Too large: products of inertia that a file contains are removed. Test:
/// `rounded_products_are_zero`.
pub(crate) const ROUNDING: f64 = 1e-15;

/// Allowed difference between a coordinate and its requested value. Unit: share of the value, at
/// least of 1 m or rad. Too small: rounding errors are reported as a change. Too large: a change in
/// the ninth digit is not reported. Test: `values_that_cannot_be_held_are_told`.
pub(crate) const HELD: f64 = 1e-9;

/// An angle in radians above this value was probably written in degrees. The value is one
/// revolution, rounded up. Unit: rad. Too small: a full revolution is reported. Too large: small
/// angles in degrees are not reported. Test: `angles_of_another_unit_are_seen`.
pub(crate) const TURN: f64 = 6.3;

/// An angle in degrees was probably written in radians if its difference from a multiple of π/4 or
/// π/6 is at most this value. Unit: rad. Too small: 1.57 is not reported. Too large: ordinary
/// angles of few degrees are reported. Test: `angles_of_another_unit_are_seen`.
pub(crate) const COMMON_ANGLE: f64 = 1e-3;

/// Step of finite differences for derivatives of gaps. The error of the derivatives is about 1e-10,
/// which does not slow down Newton's method. Unit: 1 (rad, sizes). Too small: the rounding error
/// grows. Too large: the truncation error of the difference grows. Test:
/// `loops_are_closed_from_a_guess`.
pub(crate) const DIFFERENCE: f64 = 1e-5;

/// Distance below which two axes count as intersecting, as a share of the accuracy of lengths.
/// Unit: 1. Too small: rounding errors are reported as a distance. Too large: distances in the last
/// digit are not reported. Test: `tilted_axes_are_told`.
pub(crate) const MEETING: f64 = 1e-6;

/// Maximum number of names in advice. Unit: number. Too small: the intended name may be missing in
/// the list. Too large: the list is too long to read. Test:
/// `names_that_no_format_knows_are_refused`.
pub(crate) const MOST_LISTED: usize = 16;

/// Maximum number of letters of a file name in a message. Unit: number. Too small: different names
/// look equal. Too large: a malicious name fills the screen. Test:
/// `names_that_no_format_knows_are_refused`.
pub(crate) const SHOWN: usize = 40;

/// Longest name of a scene, without the characters that are added to it. Unit: number of letters.
/// Too small: different long names become equal. Too large: the reader of scenes rejects the names.
/// Test: `names_are_made_fit_and_told`.
pub(crate) const LONGEST_NAME: usize = 900;

/// Width of comments of a scene. Unit: number of letters. Too small: comments have more lines. Too
/// large: editors break the lines. Test: `comments_are_broken_into_lines`.
pub(crate) const WIDTH: usize = 110;

/// Maximum nesting depth of lists in a file of loops. Unit: number. Too small: pairs in a list are
/// rejected. Too large: a malicious file overflows the stack. Test: `faults_of_a_yaml_have_places`.
pub(crate) const DEEPEST_LIST: usize = 8;

/// Default gravity along z for files without gravity. Unit: m/s². Too small or too large: every
/// weight is wrong. Test: `a_file_without_gravity_has_that_of_the_earth`.
pub(crate) const GRAVITY: f64 = -9.81;

/// Default density of geoms in MuJoCo and of collision shapes in SDF. Unit: kg/m³. Too small or too
/// large: masses are wrong. Test: `masses_come_from_geoms`.
pub(crate) const DENSITY: f64 = 1000.0;
