//! Consecutive runs of a sweep.

use std::fmt;

use serde::{Serialize, Serializer};

/// Consecutive runs of a sweep (1-based), from the first to the last, inclusive. A shard has at
/// least one run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Runs {
    first: u64,
    last: u64,
}

impl Runs {
    /// The runs from `first` to `last`; `None` if there are no such runs.
    #[must_use]
    pub fn new(first: u64, last: u64) -> Option<Self> {
        (1 <= first && first <= last).then_some(Self { first, last })
    }

    /// The first run.
    #[must_use]
    pub fn first(self) -> u64 {
        self.first
    }

    /// The last run.
    #[must_use]
    pub fn last(self) -> u64 {
        self.last
    }

    /// Number of runs.
    #[must_use]
    pub fn count(self) -> u64 {
        self.last - self.first + 1
    }

    /// Whether a run belongs to these runs.
    #[must_use]
    pub fn has(self, run: u64) -> bool {
        (self.first..=self.last).contains(&run)
    }

    /// Whether the two ranges have at least one common run.
    #[must_use]
    pub fn meets(self, other: Self) -> bool {
        self.first <= other.last && other.first <= self.last
    }

    /// Returns the runs that remain after the removal of other runs, in order.
    #[must_use]
    pub fn without(self, others: &[Self]) -> Vec<Self> {
        let mut others: Vec<Self> = others.iter().filter(|o| o.meets(self)).copied().collect();
        others.sort_unstable();
        let mut left = Vec::new();
        let mut next = self.first;
        for other in others {
            left.extend(Self::new(next, (other.first - 1).min(self.last)));
            next = next.max(other.last + 1);
        }
        left.extend(Self::new(next, self.last));
        left
    }

    /// Returns the groups of consecutive numbers in a list of ascending numbers.
    pub(super) fn among(numbers: impl IntoIterator<Item = u64>) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for run in numbers {
            match all.last_mut() {
                Some(last) if last.last + 1 == run => last.last = run,
                _ => all.extend(Self::new(run, run)),
            }
        }
        all
    }

    /// Returns the runs as the start of a file name. Each number has as many digits as the number
    /// of all runs, so that names are in the order of the runs.
    pub(super) fn name(self, all: u64) -> String {
        let width = all.to_string().len();
        format!("{:0width$}-{:0width$}", self.first, self.last)
    }

    /// The runs in a file name.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        let (first, last) = name.split_once('-')?;
        Self::new(first.parse().ok()?, last.parse().ok()?)
    }
}

/// Prints `3-7`, or `3` for a single run.
impl fmt::Display for Runs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count() {
            1 => write!(f, "{}", self.first),
            _ => write!(f, "{}-{}", self.first, self.last),
        }
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Runs {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Runs".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        <[u64; 2]>::json_schema(generator)
    }
}

/// Written as `[first, last]`.
impl Serialize for Runs {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        [self.first, self.last].serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::Runs;

    fn runs(first: u64, last: u64) -> Runs {
        Runs::new(first, last).expect("some")
    }

    #[test]
    fn holes_are_what_is_left() {
        let all = runs(1, 10);
        assert_eq!(all.without(&[]), [all]);
        assert_eq!(all.without(&[runs(1, 10)]), []);
        assert_eq!(all.without(&[runs(1, 3), runs(7, 20)]), [runs(4, 6)]);
        // The ranges overlap, are nested, and are not in order.
        let others = [runs(8, 8), runs(2, 6), runs(3, 4), runs(5, 7)];
        assert_eq!(all.without(&others), [runs(1, 1), runs(9, 10)]);
        assert_eq!(runs(4, 5).without(&[runs(1, 2), runs(7, 9)]), [runs(4, 5)]);
        assert_eq!(Runs::new(3, 2), None);
        assert_eq!(Runs::new(0, 2), None);
    }

    #[test]
    fn names_are_in_the_order_of_runs() {
        assert_eq!(runs(7, 12).name(1000), "0007-0012");
        assert_eq!(Runs::of_name("0007-0012"), Some(runs(7, 12)));
        for wrong in ["", "7", "12-7", "a-b", "0-3"] {
            assert_eq!(Runs::of_name(wrong), None, "{wrong}");
        }
        let found = Runs::among([1, 2, 3, 7, 9, 10]);
        assert_eq!(found, [runs(1, 3), runs(7, 7), runs(9, 10)]);
        assert_eq!(found[1].to_string() + &found[2].to_string(), "79-10");
    }
}
