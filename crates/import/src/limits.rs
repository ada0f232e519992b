//! What a file may have before it is taken apart. Larger ones are refused, so that no file can take
//! all memory or the whole stack.

/// Largest file (bytes). Unit: bytes. Less: large scans of robots with comments are refused. More:
/// a hostile file takes some 20 times as much memory. Test: `hostile_files_are_refused`.
pub(crate) const LARGEST: usize = 16 << 20;

/// Most nodes of a file: elements, texts and comments. Unit: number. Less: a crowd of robots is
/// refused. More: memory. Test: `hostile_files_are_refused`.
pub(crate) const MOST_NODES: u32 = 1 << 19;

/// Deepest nesting of elements. Unit: number. Less: a long chain of bodies, each within the other,
/// is refused. More: readers that call themselves reach the end of the stack. Test:
/// `hostile_files_are_refused`.
pub(crate) const DEEPEST: usize = 300;

/// Most files that are included. Unit: number. Less: a model of many parts is refused. More:
/// memory. Test: `includes_stay_in_their_folder`.
pub(crate) const MOST_FILES: usize = 64;

/// Most problems that are listed. Unit: number. Less: a user mends and tries again more often.
/// More: nobody reads them. Test: `problems_are_counted`.
pub(crate) const MOST_PROBLEMS: usize = 100;

/// Finest and coarsest digit that is taken for a tolerance. Unit: share of the size, or rad. Less
/// than the coarsest: files with three digits are taken as exact, and their redundant rows as
/// independent. More: numbers such as 0.5 written by hand are taken as rough. Finer than the finest
/// are sixteen digits of doubles. Test: `digits_give_the_tolerance`.
pub(crate) const FINEST: f64 = 1e-12;
/// See [`FINEST`].
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
/// time until a model is refused. Test: `loops_that_cannot_close_are_refused`.
pub(crate) const GUESSES: usize = 24;

/// Most coordinates of a search. Unit: number. Less: humanoids with many loops are not assembled.
/// More: memory and time, which grow with its third power. Test: none, a matter of patience.
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
