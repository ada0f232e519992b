//! Splits a prepared mechanism into prepared components. The rows were decided at the start of the
//! whole mechanism. Each component uses the rows that belong to it.
//!
//! The redundant rows of a component are the redundant rows of the whole mechanism that belong to
//! the component. Therefore one sentence is sufficient to describe the choice of rows.

use model::start::scene_size;
use model::{Assembly, DerivativeGap, Mechanism, Part, Places, System};

use super::decided::Decision;
use super::saving::Cost;
use crate::error::MotionError;
use crate::limits::MOST_COMPONENTS;
use crate::options::RowChoice;
use crate::prepare::PreparedMechanism;

/// A prepared part and its indices in the whole mechanism.
type PreparedPart = (PreparedMechanism, Places);

/// Returns whether the mechanism is split, and its components. The list is empty if the mechanism
/// is not split.
pub(super) fn split(
    whole: &PreparedMechanism,
) -> Result<(Decision<bool>, Vec<PreparedPart>), MotionError> {
    let sets = whole.mechanism.components();
    let n = sets.len();
    if n == 1 {
        return Ok(stays(match whole.mechanism.bodies().len() {
            1 => "there is one body".to_owned(),
            _ => "all bodies are connected".to_owned(),
        }));
    }
    let mut forces = whole.mechanism.applied_forces().without_derivatives();
    if let Some(called) = forces.find(|force| force.gap == DerivativeGap::Function) {
        let kind = called.kind();
        return Ok(stays(format!(
            "{kind} `{}` calls a function, which a single thread must call in the order of time",
            called.name
        )));
    }
    let groups = &whole.mechanism.layout().groups;
    if let Some(sided) = groups.iter().find(|g| g.limits.open_side.is_some()) {
        return Ok(stays(format!(
            "`{}` may open, which ends the motion of all bodies",
            sided.name
        )));
    }
    if n > MOST_COMPONENTS {
        return Ok(stays(format!(
            "{n} independent components, more than {MOST_COMPONENTS}: a thread for each would cost more"
        )));
    }
    let mut parts = Vec::with_capacity(n);
    for set in &sets {
        parts.push(prepared(whole, whole.mechanism.part(set)));
    }
    let of = elimination(&whole.mechanism, whole.decision.rank);
    let own = |(p, _): &PreparedPart| elimination(&p.mechanism, p.decision.rank);
    let apart: u64 = parts.iter().map(own).sum();
    let taken = format!("{n}, each with its own method and step size");
    let decided = Decision::new(true, taken, "no joint, drive or force connects them");
    let decided = decided.saving(of.saturating_sub(apart), of, Cost::Elimination);
    Ok((decided, parts))
}

/// Returns the decision that the mechanism is not split.
pub(super) fn stays(reason: String) -> (Decision<bool>, Vec<PreparedPart>) {
    let decided = Decision::new(false, "solved as one", reason);
    (decided, Vec::new())
}

/// Returns the multiply-adds of a dense elimination of r rows (or fewer) for n velocities, and of
/// the elimination of the remaining matrix.
pub(super) fn elimination(mechanism: &Mechanism, r: usize) -> u64 {
    let (n, r) = (mechanism.layout().n_v as u64, r as u64);
    let (k, free) = (r.min(n), n.saturating_sub(r));
    2 * r * n * k + 2 * k * k * k / 3 - (r + n) * k * k + free * free * n + free * free * free / 6
}

/// Returns a part with the start and the rows of the whole mechanism.
fn prepared(whole: &PreparedMechanism, part: Part) -> PreparedPart {
    let Part { mechanism, places } = part;
    let (q, v) = (
        pick(&whole.q, &places.coordinates),
        pick(&whole.v, &places.velocities),
    );
    let mut s = mechanism.scratch();
    mechanism.pose(mechanism.layout().start_time, &q, &mut s);
    mechanism.phi(&mut s);
    let decision = whole.decision.of_rows(&places.rows);
    let position_decision = whole.position_decision.of_rows(&places.rows);
    let choice = match &whole.choice {
        RowChoice::Automatic => RowChoice::Automatic,
        RowChoice::Drop(rows) => RowChoice::Drop(own_rows(rows, &places)),
    };
    let of_whole = &whole.assembly;
    let assembly = Assembly {
        q: pick(&of_whole.q, &places.coordinates),
        correction: pick(&of_whole.correction, &places.velocities),
        residual: s.phi.iter().fold(0.0, |a, phi| f64::max(a, phi.abs())),
        size: scene_size(&mechanism, &q),
    };
    let own = PreparedMechanism {
        velocity_correction: pick(&whole.velocity_correction, &places.velocities),
        mechanism,
        q,
        v,
        choice,
        start: whole.start.clone(),
        may_miss: whole.may_miss && !decision.dropped.is_empty(),
        decision,
        position_decision,
        decided: None,
        assembly,
        code: None,
    };
    (own, places)
}

/// Returns the rows of the whole mechanism that belong to a part. The rows have the numbers of the
/// part.
fn own_rows(rows: &[usize], places: &Places) -> Vec<usize> {
    let own = |row: &usize| places.rows.binary_search(row).ok();
    rows.iter().filter_map(own).collect()
}

/// Returns the entries of a list of the whole mechanism that belong to a part.
fn pick<T: Copy>(x: &[T], places: &[usize]) -> Vec<T> {
    places.iter().map(|&k| x[k]).collect()
}
