//! What exact arithmetic says of a scene, as the comparison with an answer reads it: the same for
//! scenes in the plane and in space.

/// The right results for a scene.
pub trait Reference {
    /// Numbers of rows and velocities, and ranks.
    fn ranks(&self) -> Ranks;

    /// The rank of some rows.
    fn rank_of(&self, rows: &[usize]) -> usize;

    /// Joints and drives in the order of the file.
    fn reactions(&self) -> Vec<RightReaction>;

    /// What is known of the rank at other configurations.
    fn elsewhere(&self) -> Elsewhere;

    /// The tolerance for numbers of directions and dependencies, relative to the largest.
    fn rounding(&self) -> f64;
}

/// Numbers of rows and velocities, and ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ranks {
    /// Number of rows.
    pub rows: usize,
    /// Number of velocities.
    pub velocities: usize,
    /// The rank of C.
    pub all: usize,
    /// The rank of Φq alone.
    pub holonomic: usize,
    /// The rank of Ψ alone.
    pub nonholonomic: usize,
    /// The rank without the rows of drives, and their number; `None` if it is not compared.
    pub without_drives: Option<[usize; 2]>,
}

/// The rank at almost all other configurations that the holonomic rows without drives allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elsewhere {
    /// The same as at this one.
    Same,
    /// The same, or a lower one if data within a stated tolerance have it.
    NotHigher,
    /// A higher one: this configuration is singular.
    Higher,
    /// Not known.
    Unknown,
}

impl Elsewhere {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Same => "the same rank elsewhere",
            Self::NotHigher => "no higher rank elsewhere",
            Self::Higher => "a higher rank elsewhere",
            Self::Unknown => "unknown rank elsewhere",
        }
    }
}

/// The right verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The same in all solutions.
    Unique,
    /// Not the same in all solutions.
    NotUnique,
    /// Not the same in all solutions, but data within the stated tolerance may make it so.
    Open,
}

impl From<bool> for Verdict {
    fn from(is_unique: bool) -> Self {
        if is_unique {
            Self::Unique
        } else {
            Self::NotUnique
        }
    }
}

/// What is unique of a reaction.
#[derive(Clone, Debug)]
pub struct RightReaction {
    /// Name of the joint or drive.
    pub name: String,
    /// Its rows, from 0, and whether their multipliers are unique.
    pub rows: Vec<(usize, Verdict)>,
    /// Whether it is unique.
    pub is_unique: Verdict,
    /// The wrench on the first body; `None` if the drawing does not define its place.
    pub wrench: Option<RightWrench>,
}

impl RightReaction {
    /// Its rows, from 0.
    #[must_use]
    pub fn own_rows(&self) -> Vec<usize> {
        self.rows.iter().map(|(i, _)| *i).collect()
    }

    /// Whether its multipliers are unique.
    #[must_use]
    pub fn multipliers(&self) -> Verdict {
        let has = |verdict| self.rows.iter().any(|(_, v)| *v == verdict);
        if has(Verdict::NotUnique) {
            Verdict::NotUnique
        } else if has(Verdict::Open) {
            Verdict::Open
        } else {
            Verdict::Unique
        }
    }
}

/// What is unique of a wrench.
#[derive(Clone, Debug)]
pub struct RightWrench {
    /// Its components by name, and whether they are unique.
    pub components: Vec<(&'static str, Verdict)>,
    /// Independent directions along which it is unique, without those along which it is always
    /// zero.
    pub live: usize,
    /// Whether the number of these directions may be another one within the stated tolerance.
    pub is_open: bool,
    /// Its components in the solutions without loads, one for each independent solution.
    pub free: Vec<Vec<f64>>,
}
