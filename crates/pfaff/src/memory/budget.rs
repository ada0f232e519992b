//! Limits for the memory that computations may use.

use std::fmt;
use std::str::FromStr;

use model::codes::Code;
use model::{Mechanism, Registry, Tolerance};
use solvability::memory_of_verdicts;

use super::of_reading;
use crate::assembled::AssembledScene;
use crate::refusal::Refusal;

#[cfg(target_os = "linux")]
use super::linux::available;

/// The memory that computations may use. A computation that needs more memory is rejected before
/// the memory is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// The limit; `None` means the available memory of the machine.
    pub limit: Option<Bytes>,
    /// The name of the option that sets the limit, for messages.
    pub option: &'static str,
}

impl Budget {
    /// Rejects a computation that needs more memory than is allowed.
    ///
    /// # Errors
    /// Returns P0007, with both numbers.
    ///
    /// ```
    /// use pfaff::memory::{Budget, Bytes};
    ///
    /// let budget = Budget { limit: Some(Bytes(1_000_000)), option: "max_memory" };
    /// assert!(budget.allow(1_000_000, "this run").is_ok());
    /// let refusal = budget.allow(3_000_000, "this run").unwrap_err();
    /// let words = "this run takes about 3 MB of memory, max_memory allows 1 MB; nothing was computed";
    /// assert_eq!(refusal.document().error, words);
    /// ```
    pub fn allow(self, bytes: usize, what: &str) -> Result<(), Refusal> {
        let option = self.option;
        let needed = Bytes(bytes as u64);
        let (allowed, by, advice) = match (self.limit, available().map(Bytes)) {
            (Some(limit), _) => (limit, format!("{option} allows"), String::new()),
            (None, Some(left)) => {
                let advice = format!(" ({option} overrides this)");
                (left, "the machine has left".to_owned(), advice)
            }
            (None, None) => return Ok(()),
        };
        if needed.0 <= allowed.0 {
            return Ok(());
        }
        let words = format!(
            "{what} takes about {needed} of memory, {by} {allowed}; nothing was computed{advice}"
        );
        Err(Refusal::stopped(words).coded(const { Code::new(7) }))
    }

    /// Reads a scene, given by its name and its text, and builds the mechanism. Returns an error if
    /// the memory is not sufficient for the mechanism and its verdicts.
    ///
    /// # Errors
    /// Returns an error if the memory is not sufficient, and the errors of the scene.
    pub fn assembled(
        self,
        (name, text): (&str, &str),
        registry: &Registry,
        tolerance: Tolerance,
    ) -> Result<AssembledScene, Refusal> {
        self.allow_reading(text)?;
        let assembled = AssembledScene::read(name, text, registry)
            .and_then(|assembled| assembled.stating(tolerance))
            .map_err(|e| Refusal::of((name, text), e))?;
        self.allow_scene((name, text), &assembled.mechanism)?;
        Ok(assembled)
    }

    /// Rejects a scene, given by its name, its text and its mechanism, if the memory is not
    /// sufficient for the mechanism and its verdicts.
    ///
    /// # Errors
    /// Returns the errors of [`Self::allow`], and an error if elimination would take too many
    /// operations.
    pub fn allow_scene(
        self,
        (name, text): (&str, &str),
        mechanism: &Mechanism,
    ) -> Result<(), Refusal> {
        let reading = self.allow_reading(text)?;
        let verdicts = memory_of_verdicts(mechanism, crate::threads());
        let verdicts = verdicts.map_err(|e| Refusal::of((name, text), e.into()))?;
        self.allow(
            reading.saturating_add(verdicts.most(0)),
            "deciding the ranks of this scene",
        )
    }

    fn allow_reading(self, text: &str) -> Result<usize, Refusal> {
        let reading = of_reading(text.len());
        self.allow(reading, "reading this scene")?;
        Ok(reading)
    }
}

/// A size in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bytes(pub u64);

/// Units that the parser accepts. Larger units come first.
const UNITS: [(&str, u64); 9] = [
    ("TiB", 1 << 40),
    ("GiB", 1 << 30),
    ("MiB", 1 << 20),
    ("KiB", 1 << 10),
    ("TB", 1_000_000_000_000),
    ("GB", 1_000_000_000),
    ("MB", 1_000_000),
    ("kB", 1_000),
    ("B", 1),
];

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let said = || {
            format!(
                "`{text}` is not a size; write a number with B, kB, MB, GB, TB, KiB, MiB, GiB or TiB, e.g. 4GB"
            )
        };
        let (number, unit) = UNITS
            .iter()
            .find_map(|(name, bytes)| Some((text.strip_suffix(name)?, *bytes)))
            .ok_or_else(said)?;
        let number: f64 = number.trim().parse().map_err(|_| said())?;
        let bytes = number * unit as f64;
        if number > 0.0 && bytes < u64::MAX as f64 {
            Ok(Self(bytes as u64))
        } else {
            Err(said())
        }
    }
}

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.0 as f64;
        match self.0 {
            1_000_000_000.. => write!(f, "{:.1} GB", bytes / 1e9),
            _ => write!(f, "{:.0} MB", (bytes / 1e6).max(1.0)),
        }
    }
}

/// The memory (bytes) of the machine that is still available, if the system reports it.
#[cfg(all(not(target_os = "linux"), feature = "sysinfo"))]
fn available() -> Option<u64> {
    let mut system = sysinfo::System::new().ok()?;
    system.refresh_memory();
    // On unsupported systems this function returns 0.
    Some(system.available_memory()).filter(|bytes| *bytes > 0)
}

/// Without the feature `sysinfo` the available memory is unknown.
#[cfg(all(not(target_os = "linux"), not(feature = "sysinfo")))]
fn available() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        let read = |text: &str| text.parse::<Bytes>().ok().map(|bytes| bytes.0);
        assert_eq!(read("4GB"), Some(4_000_000_000));
        assert_eq!(read("1.5 MiB"), Some(1_572_864));
        assert_eq!(read("10B"), Some(10));
        for wrong in ["", "4", "GB", "-1GB", "NaNGB", "0MB", "1e99TB", "4gb"] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
