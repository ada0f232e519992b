//! Tests the answer of the program for a drawing with a tolerance. The answer is compared with
//! exact arithmetic and with the distance of the data from a lower rank.

use serde_json::Value;

use super::distance::{BEYOND_DOUBT, Distance, Left};
use super::doubles::Doubles;
use super::drawing::Tie;
use super::examine::{elsewhere, kept_rows, reactions};
use super::expected::Expected;
use super::findings::{Finding, Findings, Kind, list};
use super::loads::Reactions;
use super::minimax::Bounds;
use super::outcome::JudgedStart;
use super::pose::Posed;
use super::truth::Truth;
use super::words;

/// A reaction counts as linear in the data if the change of all data together changes the reaction
/// by less than this fraction.
const FIRST_ORDER: f64 = 0.1;

/// Factor for the change of several points of a joint together, relative to the effect of the most
/// sensitive point.
const AT_ONCE: f64 = 3.0;

/// Part of the sentence about dependencies that are undecided.
const OPEN: &str = "within the tolerance it is undecided which rows of";

/// Accuracy of `sensitivity` and of reactions in double precision.
const ROUNDING: f64 = 1e-8;

/// The correct results for a drawing.
pub struct Meant<'a> {
    posed: &'a Posed,
    /// Results of exact arithmetic.
    pub truth: Truth,
    /// The same results as plain data.
    pub right: Expected,
    /// The size of the drawing (m).
    pub size: f64,
    /// Number of points, directions and single values of the drawing.
    pub blocks: usize,
    /// Whether the redundancy of the drawing is the same at all configurations.
    pub is_permanent: bool,
    /// Value of τ* (m) for a rank that is lower by one.
    pub from: Bounds,
    /// Value of τ* (m) for this rank at all configurations; zero if the rank is the same at all
    /// configurations for the given data.
    pub everywhere_from: Bounds,
    /// Reactions under gravity.
    pub reactions: Reactions,
    /// The drawing in double precision.
    pub doubles: Doubles,
}

impl<'a> Meant<'a> {
    /// Computes the correct results for a drawing.
    #[must_use]
    pub fn of(posed: &'a Posed, seed: u64, gravity: [f64; 2]) -> Self {
        let (truth, right) = posed.right();
        let doubles = Doubles::of(posed);
        let rank = truth.rank();
        let is_permanent = truth.redundancy() == 0 || doubles.is_permanent(rank, seed);
        let everywhere_from = if is_permanent {
            Bounds {
                low: 0.0,
                high: 0.0,
            }
        } else {
            doubles.lower_rank_from(rank + 1)
        };
        Self {
            posed,
            truth,
            right,
            size: doubles.size,
            blocks: doubles.blocks.len(),
            is_permanent,
            everywhere_from,
            from: doubles.lower_rank_from(rank),
            reactions: doubles.reactions(posed, rank, gravity),
            doubles,
        }
    }

    /// Returns a tolerance (m) and τ*.
    #[must_use]
    pub fn distance(&self, tolerance: f64) -> Distance {
        Distance {
            tolerance,
            to_lower_rank: self.from.low,
            is_permanent: self.is_permanent,
        }
    }

    /// Returns the allowed relative difference of results if the data have a tolerance (m).
    fn rounding(&self, tolerance: f64) -> f64 {
        let known_to = (10.0 * tolerance / self.from.low).min(0.5);
        self.truth.rounding.max(known_to)
    }

    /// Compares a document with the correct results.
    #[must_use]
    pub fn judge(&self, answer: &Value, tolerance: f64) -> JudgedStart {
        let mut judged = JudgedStart::default();
        let rank = self.truth.rank();
        let left = self.distance(tolerance).judge(rank, answer, &mut judged);
        let findings = &mut judged.findings;
        let is_wrong = BEYOND_DOUBT * tolerance < self.everywhere_from.low;
        let is_redundant_within = answer["evidence"]["grounds"] == "within_tolerance";
        if left != Left::Nothing && is_wrong && is_redundant_within {
            let text = format!(
                "rank: answer {rank} within the tolerance, is so at one pose only up to {:.2e} m",
                self.everywhere_from.low
            );
            findings.note(Kind::Rank, text);
        }
        if left != Left::Verdicts {
            return judged;
        }
        let mut truth = self.truth.clone();
        truth.rounding = self.rounding(tolerance);
        self.verdicts(answer, tolerance, findings);
        kept_rows(&truth, answer, findings);
        elsewhere(&self.right, answer, findings);
        let warnings = list(&answer["warnings"]).iter().filter_map(Value::as_str);
        for warning in warnings.filter(|w| w.contains(OPEN)) {
            findings.note(Kind::Undecided, warning.to_owned());
        }
        words::circuits(&truth, answer, findings);
        self.loads(answer, tolerance, findings);
        judged
    }

    /// Verdicts must be the verdicts for the drawing. The program may report a reaction that is not
    /// unique as unique if it is unique for other data within the tolerance.
    fn verdicts(&self, answer: &Value, tolerance: f64, findings: &mut Findings) {
        let mut all = Findings::default();
        let rounding = self.rounding(tolerance);
        reactions(&self.right, rounding, answer, &mut all);
        let rank = self.truth.rank();
        let hidden = self.right.reactions.iter().filter(|right| {
            let is_named = |f: &Finding| concerns(&f.text, &right.name);
            let wrong = |f: &Finding| f.kind.is_wrong() && is_named(f);
            // Only reactions that are unique for other data within the tolerance are accepted.
            !right.is_unique.is_unique() && all.0.iter().any(wrong) && {
                let [size, change] = self.doubles.margin(rank, &right.own_rows(), tolerance);
                size <= change
            }
        });
        let hidden: Vec<&str> = hidden.map(|right| right.name.as_str()).collect();
        let is_open = |text: &str| hidden.iter().any(|name| concerns(text, name));
        let kept = all.0.into_iter().filter(|f| !is_open(&f.text));
        findings.0.extend(kept);
    }

    /// Unique reactions must equal the reactions of the drawing, up to their sensitivity.
    fn loads(&self, answer: &Value, tolerance: f64, findings: &mut Findings) {
        let Some(chosen) = list(&answer["choices"]).first() else {
            return;
        };
        for (link, placed) in self.posed.links.iter().enumerate() {
            let name = placed.link.name.as_str();
            let named = |of: &&Value| of["name"] == name;
            let Some(reaction) = list(&answer["reactions"]).iter().find(named) else {
                continue;
            };
            let Some(change) = reaction["sensitivity"].as_f64() else {
                continue;
            };
            // The loads act perpendicular to collinear bodies, so no finite reaction exists. The
            // answer contains this reason instead of values.
            if !reaction["no_finite_reaction"].is_null() {
                continue;
            }
            let right = self.right.reaction(name);
            if reaction["verdict"] != "unique" || right.is_none_or(|r| !r.is_unique.is_unique()) {
                continue;
            }
            // The sensitivity applies to the larger of 1e-4 of the size and the tolerance.
            let moved = tolerance.max(1e-4 * self.size);
            let all = AT_ONCE * (self.blocks as f64).sqrt() * change * tolerance / moved;
            if all > FIRST_ORDER {
                continue;
            }
            let (force, torque) = self.reactions.each[link];
            // The torque of a wheel refers to the reference point of the wheel, which may be
            // another point.
            let torque = torque.filter(|_| !matches!(placed.link.tie, Tie::Rack { .. }));
            let size = force[0]
                .hypot(force[1])
                .max(torque.map_or(0.0, f64::abs) / self.size);
            let allowed = (all + tolerance / self.size + ROUNDING) * size.max(self.reactions.load);
            let Some(values) = list(&chosen["reactions"]).iter().find(named) else {
                continue;
            };
            for component in list(&values["components"]) {
                let (right, unit) = match component["name"].as_str() {
                    Some("Fx") => (force[0], 1.0),
                    Some("Fy") => (force[1], 1.0),
                    Some("T") => match torque {
                        Some(torque) => (torque, self.size),
                        None => continue,
                    },
                    _ => continue,
                };
                let answer = component["value"].as_f64().unwrap_or(f64::NAN);
                if (answer - right).abs() > allowed * unit || answer.is_nan() {
                    let text = format!(
                        "{name}.{}: answer {answer:.6e}, is {right:.6e}, allowed {:.1e}; sensitivity {change:.2e}, \
                         tolerance {tolerance:.1e}",
                        component["name"],
                        allowed * unit
                    );
                    findings.note(Kind::Load, text);
                }
            }
        }
    }
}

/// Whether a finding is about the joint or drive with this name.
fn concerns(text: &str, name: &str) -> bool {
    let rest = text.strip_prefix(name);
    rest.is_some_and(|rest| rest.starts_with([':', ',', '.']))
}
