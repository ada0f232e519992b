//! Numbers that somebody chose: what a file may have before it is taken apart, so that no file can
//! take all memory or the whole stack; what counts as closed, parallel, exact; defaults of formats.

/// Largest file. Unit: bytes. Less: large scans of robots with comments are refused. More:
/// a hostile file takes some 20 times as much memory. Test: `hostile_files_are_refused`.
pub(crate) const LARGEST: usize = 16 << 20;

/// Most nodes of a file: elements, texts and comments. Unit: number. Less: a crowd of robots is
/// refused. More: memory. Test: `hostile_files_are_refused`.
pub(crate) const MOST_NODES: u32 = 1 << 19;

/// Deepest nesting of elements. Unit: number. Less: a long chain of bodies, each within the other,
/// is refused. More: readers that call themselves reach the end of the stack. Test:
/// `hostile_files_are_refused`.
pub(crate) const DEEPEST: usize = 300;

/// Most attributes of an element. Unit: number. Less: no element of a format has more than 60, but
/// extensions may. More: time, which grows with the second power. Test:
/// `many_attributes_cost_no_time`.
pub(crate) const MOST_ATTRIBUTES: usize = 256;

/// Most declarations of name spaces in a file. Unit: number. Less: files that repeat them in each
/// element are refused. More: time, as all of them are in force within the elements that declare
/// them. Test: `many_attributes_cost_no_time`.
pub(crate) const MOST_NAME_SPACES: usize = 1024;

/// Most files that are included. Unit: number. Less: a model of many parts is refused. More:
/// memory. Test: `includes_stay_in_their_folder`.
pub(crate) const MOST_FILES: usize = 64;

/// Most problems that are listed. Unit: number. Less: a user mends and tries again more often.
/// More: nobody reads them. Test: `problems_are_counted`.
pub(crate) const MOST_PROBLEMS: usize = 100;

/// Finest digit that is taken for a tolerance. Unit: share of the size, or rad. Less: sixteen
/// digits of doubles are a tolerance. More: files with twelve digits are taken as exact. Test:
/// `digits_give_the_tolerance`.
pub(crate) const FINEST: f64 = 1e-12;

/// Coarsest digit that is taken for a tolerance. Unit: share of the size, or rad. Less: files with
/// three digits are taken as exact, and their redundant rows as independent. More: numbers such as
/// 0.5 written by hand are taken as rough. Test: `digits_give_the_tolerance`.
pub(crate) const COARSEST: f64 = 1e-3;

/// Gap of a loop below which it is closed. Unit: share of the size, or rad. Less: rounding of long
/// chains is taken for a gap. More: the reader of scenes moves what is called assembled. Test:
/// `loops_are_closed_from_a_guess`.
pub(crate) const ASSEMBLED: f64 = 1e-11;

/// Gap that is accepted, and told, where no pose closes the loops better: data with few digits do
/// not fit. Unit: share of the size, or rad. Less: models with rounded numbers are refused. More:
/// open loops are called closed. Test: `loops_that_cannot_close_are_refused`.
pub(crate) const CLOSED: f64 = 1e-4;

/// Gap at the described pose beyond which a pose is sought. Unit: as [`CLOSED`]. Less: rounding
/// moves all links. More: the reader of scenes has to move them. Test:
/// `loops_are_closed_from_a_guess`.
pub(crate) const OPEN: f64 = 1e-7;

/// Steps of one search. Unit: number. Less: poses far from the guess are not found. More: time.
/// Test: `loops_are_closed_from_a_guess`.
pub(crate) const ITERATIONS: usize = 100;

/// Searches from other guesses. Unit: number. Less: loops are not closed from a bad guess. More:
/// time until a model is refused. Test: `loops_are_closed_from_a_guess`.
pub(crate) const GUESSES: usize = 24;

/// Most coordinates of a search. Unit: number. Less: humanoids with many loops are not assembled.
/// More: memory and time, which grow with its third power. Test: `many_coordinates_are_not_tried`.
pub(crate) const MOST_COORDINATES: usize = 400;

/// Angle below which axes are parallel: rounding of products of rotations. Unit: rad. Less:
/// rounding is told as a tilt. More: a tilt of the twelfth digit is not told. Test:
/// `tilted_axes_are_told`.
pub(crate) const EXACT: f64 = 1e-12;

/// Angle up to which axes of a loop are told to be nearly parallel. Unit: rad. Less: a tilt of some
/// degrees by mistake is not told. More: spatial loops are told to be nearly planar. Test:
/// `tilted_axes_are_told`.
pub(crate) const NEARLY: f64 = 0.15;

/// Angle up to which axes are made parallel on request, beyond the digits of the file. Unit: rad.
/// Less: π/2 written as 1.57 is not mended. More: tilts that are meant vanish. Test:
/// `tilted_axes_are_told`.
pub(crate) const SNAPPED: f64 = 2e-3;

/// Cosine below which two hinges of one body that meet are a universal joint. Unit: 1. Less:
/// rounding of unit vectors makes a body without mass between them. More: axes that are not at
/// right angles are made so. Test: `every_file_is_a_scene`.
pub(crate) const PERPENDICULAR: f64 = 4.0 * f64::EPSILON;

/// The same for both axes of a joint of SDF, which says itself that it is universal: what six
/// digits tell. Unit: 1. Less: rounded axes have a body without mass between them. More: oblique
/// axes are made perpendicular. Test: `loops_springs_and_limits`.
pub(crate) const RIGHT_ANGLE: f64 = 1e-6;

/// Largest number, as in scenes. Unit: that of the number. Less: none known. More: products of
/// numbers overflow. Test: `numbers_have_bounds`.
pub(crate) const LARGEST_NUMBER: f64 = 1e60;

/// Share of the largest entry of a tensor below which its products are the rounding of a rotation
/// or a sum. Unit: 1. Less: diagonal tensors are written with products such as 1e-19. More:
/// products that a file states vanish. Test: `rounded_products_are_zero`.
pub(crate) const ROUNDING: f64 = 1e-15;

/// Difference up to which a coordinate has the value that was asked for. Unit: share of the value,
/// at least of 1 m or rad. Less: rounding is told as a change. More: a change of the ninth digit is
/// not told. Test: `values_that_cannot_be_held_are_told`.
pub(crate) const HELD: f64 = 1e-9;

/// Angle beyond which one in rad looks like degrees: a turn, whose last digit may be rounded up.
/// Unit: rad. Less: a whole turn is told. More: small angles in degrees are not told. Test:
/// `angles_of_another_unit_are_seen`.
pub(crate) const TURN: f64 = 6.3;

/// Distance of an angle in degrees from a part of a turn in rad, π/4 or π/6 and their multiples, up
/// to which it looks like rad. Unit: rad. Less: 1.57 is not told. More: ordinary angles of few
/// degrees are told. Test: `angles_of_another_unit_are_seen`.
pub(crate) const COMMON_ANGLE: f64 = 1e-3;

/// Step of differences for derivatives of gaps: their error is some 1e-10, which costs a step of
/// Newton nothing. Unit: 1 (rad, sizes). Less: rounding grows. More: the error of the difference
/// grows. Test: `loops_are_closed_from_a_guess`.
pub(crate) const DIFFERENCE: f64 = 1e-5;

/// Distance of two axes below which they meet, as a share of what lengths are known to. Unit: 1.
/// Less: rounding is told as a distance. More: distances of the last digit are not told. Test:
/// `tilted_axes_are_told`.
pub(crate) const MEETING: f64 = 1e-6;

/// Most names in an advice. Unit: number. Less: the name that was meant is not among them. More:
/// nobody reads them. Test: `names_that_no_format_knows_are_refused`.
pub(crate) const MOST_LISTED: usize = 16;

/// Most letters of a name of a file in a message. Unit: number. Less: names that differ look alike.
/// More: a hostile name fills the screen. Test: `names_that_no_format_knows_are_refused`.
pub(crate) const SHOWN: usize = 40;

/// Longest name of a scene, less what is added to it. Unit: number of letters. Less: long names
/// that differ become the same. More: scenes refuse them. Test: `names_are_made_fit_and_told`.
pub(crate) const LONGEST_NAME: usize = 900;

/// Width of comments of a scene. Unit: number of letters. Less: more lines. More: lines are broken
/// by editors. Test: `comments_are_broken_into_lines`.
pub(crate) const WIDTH: usize = 110;

/// Deepest nesting of lists in a file of loops. Unit: number. Less: pairs in a list are refused.
/// More: a hostile file takes the stack. Test: `faults_of_a_yaml_have_places`.
pub(crate) const DEEPEST_LIST: usize = 8;

/// Gravity along z where a file has none. Unit: m/s². Less or more: every weight is wrong. Test:
/// `a_file_without_gravity_has_that_of_the_earth`.
pub(crate) const GRAVITY: f64 = -9.81;

/// Density of geoms of MuJoCo where none is given. Unit: kg/m³. Less or more: masses are wrong.
/// Test: `masses_come_from_geoms`.
pub(crate) const DENSITY: f64 = 1000.0;
