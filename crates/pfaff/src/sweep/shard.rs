//! A part of a sweep.

use std::fmt;
use std::str::FromStr;

use report::sweep::Runs;
use serde::{Deserialize, Serialize};

/// The k-th of n parts of a sweep (1-based), written as `k/n`. Each part consists of consecutive
/// runs. The numbers of runs of two parts differ by at most one.
///
/// ```
/// use pfaff::sweep::Shard;
///
/// let shard: Shard = "2/3".parse()?;
/// assert_eq!(shard.runs(8).map(|runs| runs.to_string()), Some("3-5".to_owned()));
/// assert!("4/3".parse::<Shard>().is_err());
/// # Ok::<(), pfaff::sweep::ShardError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Shard {
    k: u64,
    n: u64,
}

/// A text that is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is not k/n with 1 ≤ k ≤ n")]
pub struct ShardError {
    text: String,
}

/// Largest number of parts that the search considers.
const PARTS_MAX: u64 = 100_000;

impl Shard {
    /// The shard that contains all runs.
    pub const WHOLE: Self = Self { k: 1, n: 1 };

    /// Creates the k-th of n parts.
    ///
    /// # Errors
    /// Returns an error unless 1 ≤ k ≤ n.
    pub fn new(k: u64, n: u64) -> Result<Self, ShardError> {
        if 1 <= k && k <= n {
            Ok(Self { k, n })
        } else {
            let text = format!("{k}/{n}");
            Err(ShardError { text })
        }
    }

    /// Returns the index of the part, counted from 1.
    #[must_use]
    pub fn k(self) -> u64 {
        self.k
    }

    /// Returns the number of parts.
    #[must_use]
    pub fn n(self) -> u64 {
        self.n
    }

    /// Returns the runs of the part. `all` is the number of runs of the sweep. Returns `None` if
    /// there are more parts than runs and this part is empty.
    #[must_use]
    pub fn runs(self, all: u64) -> Option<Runs> {
        // The result is at most `all`, because k ≤ n.
        let end = |k: u64| (u128::from(k) * u128::from(all) / u128::from(self.n)) as u64;
        Runs::new(end(self.k - 1) + 1, end(self.k))
    }

    /// Finds a number of parts for which all given ranges are parts. Returns `None` if a range
    /// contains all runs, if there are no ranges, or if the ranges belong to different numbers of
    /// parts.
    #[must_use]
    pub fn number(all: u64, parts: &[Runs]) -> Option<u64> {
        let size = parts.iter().map(|part| part.count()).min()?;
        let is_part = |n: u64, part: &Runs| {
            let k = (u128::from(part.last()) * u128::from(n)).div_ceil(u128::from(all));
            Self::new(k as u64, n).is_ok_and(|shard| shard.runs(all) == Some(*part))
        };
        let least = (all / (size + 1)).max(2);
        let most = (all / (size - 1).max(1) + 1).min(least + PARTS_MAX);
        (least..=most).find(|n| parts.iter().all(|part| is_part(*n, part)))
    }

    /// Of n parts, returns the parts that consist of these runs. Returns `None` if the runs begin
    /// or end inside a part.
    #[must_use]
    pub fn of(runs: Runs, all: u64, n: u64) -> Option<Vec<Self>> {
        let at = |run: u64| (u128::from(run) * u128::from(n)).div_ceil(u128::from(all)) as u64;
        let shards: Vec<Self> = (at(runs.first())..=at(runs.last()))
            .map(|k| Self::new(k, n))
            .collect::<Result<_, _>>()
            .ok()?;
        let first = shards.first()?.runs(all)?.first();
        let last = shards.last()?.runs(all)?.last();
        ((first, last) == (runs.first(), runs.last())).then_some(shards)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.k, self.n)
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl TryFrom<String> for Shard {
    type Error = ShardError;

    fn try_from(text: String) -> Result<Self, ShardError> {
        text.parse()
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let read = || {
            let (k, n) = text.split_once('/')?;
            Self::new(k.trim().parse().ok()?, n.trim().parse().ok()?).ok()
        };
        read().ok_or_else(|| ShardError {
            text: text.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Runs, Shard};

    #[test]
    fn shards_are_all_runs_once() {
        for all in [1, 2, 7, 24, 1000] {
            for n in [1, 2, 3, 7, 24, 200] {
                let parts = (1..=n).map(|k| Shard::new(k, n).expect("a shard").runs(all));
                let parts: Vec<Runs> = parts.flatten().collect();
                let mut next = 1;
                for part in &parts {
                    assert_eq!(part.first(), next);
                    assert!((all / n..=all / n + 1).contains(&part.count()));
                    next = part.last() + 1;
                }
                assert_eq!(next, all + 1, "{all} in {n}");
            }
        }
        assert_eq!(Shard::WHOLE.runs(9), Runs::new(1, 9));
        // The number of all runs may have the largest representable value.
        let last = Shard::new(u64::MAX, u64::MAX).expect("a shard");
        assert_eq!(last.runs(u64::MAX), Runs::new(u64::MAX, u64::MAX));
    }

    #[test]
    fn missing_shards_are_named() {
        let part = |k, n| Shard::new(k, n).expect("a shard").runs(1000).expect("some");
        assert_eq!(Shard::number(1000, &[part(2, 7), part(5, 7)]), Some(7));
        assert_eq!(Shard::number(1000, &[part(2, 7), part(5, 8)]), None);
        assert_eq!(Shard::number(1000, &[]), None);
        let hole = Runs::new(part(3, 7).first(), part(4, 7).last()).expect("some");
        let shards = Shard::of(hole, 1000, 7).expect("whole ones");
        let names: Vec<String> = shards.iter().map(Shard::to_string).collect();
        assert_eq!(names, ["3/7", "4/7"]);
        assert_eq!(Shard::of(part(3, 8), 1000, 7), None);
    }
}
