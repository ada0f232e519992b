//! Requests for scenes, and the estimated size of a scene.

use std::io::{self, BufWriter, Write};

use super::answer::{Answer, FreeReaction};
use super::family::Family;
use super::fleet::Fleet;
use super::lattice::Lattice;
use super::n_four_bar::NFourBar;
use super::parallelograms::Parallelograms;
use super::random::Random;
use super::text::SceneText;

/// Largest scene that is written (bytes).
pub const LARGEST: f64 = 1e10;

/// Number of names in an element: its own name, and the names of the elements to which it refers.
const NAMES: f64 = 3.0;

/// A family of mechanisms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Loops of unit rods in a row, with one degree of freedom.
    NFourBar,
    /// A chain of parallelogram cells. Each cell is mounted on the coupler of the previous cell.
    /// Cells with a third crank are redundant.
    Parallelograms,
    /// A square lattice of rods that is suspended from a corner. Some cells have braces.
    Lattice,
    /// Copies of the robot with its trolley in a row.
    Fleet,
    /// Random rods, slides and loops. Some of them have additional, redundant joints or cranks.
    Random,
}

impl Kind {
    /// All families.
    pub const ALL: &'static [Self] = &[
        Self::NFourBar,
        Self::Parallelograms,
        Self::Lattice,
        Self::Fleet,
        Self::Random,
    ];

    /// Returns the name of the family.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NFourBar => "n-four-bar",
            Self::Parallelograms => "parallelograms",
            Self::Lattice => "lattice",
            Self::Fleet => "fleet",
            Self::Random => "random",
        }
    }

    /// Returns the unit that n counts in this family.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::NFourBar => "loops",
            Self::Parallelograms => "cells",
            Self::Lattice => "cells along each side",
            Self::Fleet => "robots",
            Self::Random => "modules",
        }
    }

    /// Returns the default fraction of the cells that are redundant. Returns `None` if the family
    /// has no such option.
    fn share(self) -> Option<f64> {
        match self {
            Self::NFourBar | Self::Fleet => None,
            Self::Parallelograms => Some(2.0 / 3.0),
            Self::Lattice => Some(1.0),
            Self::Random => Some(1.0 / 3.0),
        }
    }

    fn has_seed(self) -> bool {
        matches!(self, Self::Parallelograms | Self::Random)
    }

    fn family(self, n: usize, seed: u64, share: f64) -> Box<dyn Family> {
        match self {
            Self::NFourBar => Box::new(NFourBar::new(n)),
            Self::Parallelograms => Box::new(Parallelograms::new(n, seed, share)),
            Self::Lattice => Box::new(Lattice::new(n, share)),
            Self::Fleet => Box::new(Fleet::new(n)),
            Self::Random => Box::new(Random::new(n, seed, share)),
        }
    }

    /// Returns a sample size from which larger sizes are estimated. The sample has some hundreds of
    /// bodies, which is enough to average random differences.
    fn sample(self) -> usize {
        match self {
            Self::Lattice => 20,
            Self::NFourBar | Self::Parallelograms | Self::Fleet => 200,
            Self::Random => 2000,
        }
    }

    /// Returns the factor by which the number of bodies and joints grows from size `a` to size `b`.
    fn growth(self, a: usize, b: usize) -> f64 {
        let ratio = b as f64 / a as f64;
        match self {
            Self::Lattice => ratio * (b as f64 + 1.0) / (a as f64 + 1.0),
            _ => ratio,
        }
    }
}

/// A request for a scene.
///
/// ```
/// use suite::generate::{Kind, Order};
/// // Three loops: 4 uprights and 3 rods, 4 feet and 6 tops, two rows each.
/// let generator = Order::of(Kind::NFourBar, 3).generate()?;
/// let answer = generator.answer();
/// assert_eq!((answer.bodies, answer.joints, answer.rows), (7, 10, 20));
/// assert_eq!((answer.redundancy, answer.mobility), (0, 1));
/// let mut scene = Vec::new();
/// generator.write(&mut scene).unwrap();
/// assert!(scene.starts_with(b"# n-four-bar-3: "));
/// # Ok::<(), suite::generate::GenerateError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The family.
    pub kind: Kind,
    /// Size: number of loops, cells, cells along each side, robots, modules.
    pub n: usize,
    /// Seed of the random choices. If no seed is given, the seed is 1.
    pub seed: Option<u64>,
    /// Fraction of the cells that are redundant, 0 to 1.
    pub redundant: Option<f64>,
}

/// The reason why a scene is not generated.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GenerateError {
    /// The scene would be empty.
    Empty {
        /// The family of the request.
        kind: Kind,
    },
    /// The file would be too large.
    TooLarge {
        /// The family of the request.
        kind: Kind,
        /// The requested size.
        n: usize,
        /// Estimated size of the file (bytes).
        bytes: f64,
    },
    /// The fraction is not between 0 and 1.
    Share {
        /// The given value.
        value: f64,
    },
    /// The family does not have this option.
    Unused {
        /// The family of the request.
        kind: Kind,
        /// Name of the option.
        option: &'static str,
        /// The reason why the option does not apply.
        reason: &'static str,
    },
}

impl std::fmt::Display for GenerateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Empty { kind } => write!(
                f,
                "{} of n = 0 is empty: n counts {}, need at least 1",
                kind.name(),
                kind.unit()
            ),
            Self::TooLarge { kind, n, bytes } => write!(
                f,
                "{} of n = {n} would be a file of about {:.0} GB, more than {:.0} GB: choose a smaller n ({})",
                kind.name(),
                bytes / 1e9,
                LARGEST / 1e9,
                kind.unit()
            ),
            Self::Share { value } => {
                write!(
                    f,
                    "the redundant share is {value}, need a number from 0 to 1"
                )
            }
            Self::Unused {
                kind,
                option,
                reason,
            } => write!(f, "{} takes no {option}: {reason}", kind.name()),
        }
    }
}

impl std::error::Error for GenerateError {}

impl Order {
    /// Creates a request for a size of a family, with the defaults.
    #[must_use]
    pub fn of(kind: Kind, n: usize) -> Self {
        Self {
            kind,
            n,
            seed: None,
            redundant: None,
        }
    }

    /// Checks the request.
    ///
    /// # Errors
    /// - [`GenerateError::Empty`]: n is 0.
    /// - [`GenerateError::TooLarge`]: the file would be larger than [`LARGEST`].
    /// - [`GenerateError::Share`]: the fraction is not from 0 to 1.
    /// - [`GenerateError::Unused`]: the family has no such choice.
    pub fn generate(&self) -> Result<Generator, GenerateError> {
        let Self {
            kind,
            n,
            seed,
            redundant,
        } = *self;
        if n == 0 {
            return Err(GenerateError::Empty { kind });
        }
        if seed.is_some() && !kind.has_seed() {
            return Err(GenerateError::Unused {
                kind,
                option: "seed",
                reason: "the campaign contains no random choices",
            });
        }
        let default = kind.share();
        if redundant.is_some() && default.is_none() {
            return Err(GenerateError::Unused {
                kind,
                option: "redundant share",
                reason: "its redundancy has no choice",
            });
        }
        if let Some(value) = redundant.filter(|share| !(0.0..=1.0).contains(share)) {
            return Err(GenerateError::Share { value });
        }
        let (seed, share) = (seed.unwrap_or(1), redundant.or(default).unwrap_or(0.0));
        let bytes = estimate(kind, n, seed, share);
        if bytes > LARGEST {
            return Err(GenerateError::TooLarge { kind, n, bytes });
        }
        Ok(Generator {
            kind,
            n,
            bytes,
            family: kind.family(n, seed, share),
        })
    }
}

/// Returns the estimated size of a scene (bytes). It is extrapolated from a small scene of the same
/// family, and allows for the additional digits in the names.
fn estimate(kind: Kind, n: usize, seed: u64, share: f64) -> f64 {
    let sample = n.min(kind.sample());
    let small = Generator {
        kind,
        n: sample,
        bytes: 0.0,
        family: kind.family(sample, seed, share),
    };
    let mut count = Count(0);
    // Counting bytes cannot fail.
    let _ = small.write(&mut count);
    let growth = kind.growth(sample, n);
    let answer = small.answer();
    let things = (answer.bodies + answer.joints) as f64;
    let digits = (n as f64).log10().floor() - (sample as f64).log10().floor();
    growth * (count.0 as f64 + NAMES * things * digits)
}

/// Counts bytes.
struct Count(u64);

impl Write for Count {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A scene that can be written, and its known results.
pub struct Generator {
    kind: Kind,
    n: usize,
    bytes: f64,
    family: Box<dyn Family>,
}

impl Generator {
    /// Name of the scene.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}-{}", self.kind.name(), self.n)
    }

    /// Sizes and ranks.
    #[must_use]
    pub fn answer(&self) -> Answer {
        self.family.answer()
    }

    /// The reactions that are not unique at the initial state, in the order of the file. All other
    /// reactions are unique.
    #[must_use]
    pub fn free_reactions(&self) -> Vec<FreeReaction> {
        self.family.free_reactions()
    }

    /// The estimated size of the text (bytes).
    #[must_use]
    pub fn bytes(&self) -> f64 {
        self.bytes
    }

    /// Writes the scene, buffered.
    ///
    /// # Errors
    /// Returns an error if the writer fails.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut out = BufWriter::with_capacity(1 << 16, out);
        let mut scene = SceneText::new(&mut out);
        let name = self.name();
        let Answer {
            bodies,
            joints,
            drives,
            rows,
            rank,
            redundancy,
            mobility,
        } = self.answer();
        let mut words = self.family.words().into_iter();
        scene.comment(&format!("{name}: {}", words.next().unwrap_or_default()))?;
        scene.comment(&format!(
            "Known: {bodies} bodies, {joints} joints, {drives} drives, {rows} rows, rank {rank}, redundancy {redundancy}, mobility {mobility}."
        ))?;
        for line in words {
            scene.comment(&line)?;
        }
        self.family.write(&name, &mut scene)?;
        out.flush()
    }
}

impl std::fmt::Debug for Generator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Generator")
            .field("name", &self.name())
            .field("answer", &self.answer())
            .finish_non_exhaustive()
    }
}
