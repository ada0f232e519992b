//! A part of a sweep.

use std::str::FromStr;

/// Every n-th run of a sweep, beginning with run i: `i/n`, counted from 1. Neighbouring runs of the
/// grid take similar times, so shards end at similar times.
///
/// ```
/// use pfaff::sweep::Shard;
///
/// let shard: Shard = "2/3".parse()?;
/// assert_eq!((1..=7).filter(|run| shard.has(*run)).collect::<Vec<_>>(), [2, 5]);
/// assert!("4/3".parse::<Shard>().is_err());
/// # Ok::<(), pfaff::sweep::ShardError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    i: u64,
    n: u64,
}

/// A text that is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is not i/n with 1 ≤ i ≤ n")]
pub struct ShardError {
    text: String,
}

impl Shard {
    /// All runs.
    pub const WHOLE: Self = Self { i: 1, n: 1 };

    /// Whether a run (from 1) belongs to it.
    #[must_use]
    pub fn has(self, run: u64) -> bool {
        run % self.n == self.i % self.n
    }

    /// Name of its journal; shards may write into one directory at the same time.
    pub(super) fn journal(self) -> String {
        match self {
            Self::WHOLE => "sweep".to_owned(),
            Self { i, n } => format!("sweep-{i}-of-{n}"),
        }
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let read = || {
            let (i, n) = text.split_once('/')?;
            let (i, n) = (i.trim().parse().ok()?, n.trim().parse().ok()?);
            (1 <= i && i <= n).then_some(Self { i, n })
        };
        read().ok_or_else(|| ShardError {
            text: text.to_owned(),
        })
    }
}
