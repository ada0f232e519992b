//! Compares the rank in an answer for data within a tolerance with the distance of the data from a
//! lower rank.

use serde_json::Value;

use super::findings::Kind;
use super::outcome::JudgedStart;

/// A tolerance below the distance divided by this factor does not change the rank. A tolerance
/// above the distance times this factor lowers the rank.
pub const BEYOND_DOUBT: f64 = 3.0;

/// If the distance of the data from a lower rank is at least the tolerance times this factor, the
/// program must decide all results.
const FAR: f64 = 30.0;

/// A tolerance, and the distance of the data from a lower rank, in the same unit.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// The stated tolerance.
    pub tolerance: f64,
    /// Lower bound of the distance: no change below this value lowers the rank.
    pub to_lower_rank: f64,
    /// Whether the redundancy is the same at all configurations.
    pub is_permanent: bool,
}

/// Results that remain to be compared after the rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// No results, because the rank is not decided, or a different rank is also correct.
    Nothing,
    /// No verdicts, because coefficients may vanish within the tolerance.
    NoVerdict,
    /// All results.
    Verdicts,
}

impl Distance {
    /// Returns whether the distance of the data from a lower rank is at least `FAR` times the
    /// tolerance. If so, the program must decide all results.
    #[must_use]
    pub fn is_far(self) -> bool {
        self.to_lower_rank >= FAR * self.tolerance
    }

    /// Compares the rank of a document with the correct rank.
    pub fn judge(self, rank: usize, answer: &Value, judged: &mut JudgedStart) -> Left {
        let evidence = &answer["evidence"];
        if evidence["status"] != "decided" {
            let text = format!("rank {}: {}", answer["rank"], evidence["reason"]);
            judged.findings.note(Kind::Undecided, text);
            return Left::Nothing;
        }
        let found = answer["rank"].as_u64().unwrap_or(0) as usize;
        let is_safe = BEYOND_DOUBT * self.tolerance < self.to_lower_rank;
        let told = format!(
            "rank: answer {found}, is {rank}; tolerance {:.2e}, to a lower rank {:.2e}; {}",
            self.tolerance, self.to_lower_rank, evidence["grounds"]
        );
        if found < rank {
            if is_safe {
                judged.findings.note(Kind::Rank, told);
            }
            judged.other_rank = Some("lower within the tolerance");
            Left::Nothing
        } else if found > rank {
            if self.is_permanent {
                let text = format!("{told}, at all poses");
                judged.findings.note(Kind::Rank, text);
            }
            judged.other_rank = Some("singular pose");
            Left::Nothing
        } else if is_safe {
            Left::Verdicts
        } else {
            judged.other_rank = Some("verdicts near a lower rank");
            Left::NoVerdict
        }
    }
}
