//! The motion along which one-sided joints open, in words.

use model::words::clause;
use model::{BodyRef, ConstraintId, Mechanism, System};
use solvability::Impossible;

/// A rate counts as zero if it is below this fraction of the largest rate. Rates contain rounding
/// errors of the reference points.
const ROUNDING: f64 = 1e-9;

/// Describes why no distribution of the loads keeps all one-sided joints closed.
/// `lifts` are the joints whose gaps accelerate: a motion in which one of them stays closed proves
/// that joints open, but is not the motion that follows.
pub(super) fn tips(
    (mechanism, q): (&Mechanism, &[f64]),
    t: f64,
    proof: &Impossible,
    lifts: &[(ConstraintId, f64)],
) -> String {
    let groups = &mechanism.layout().groups;
    let names = |ids: &[ConstraintId]| -> Vec<String> {
        ids.iter().map(|id| groups[id.0].name.clone()).collect()
    };
    let why = "no sharing of the loads presses on all one-sided joints";
    if proof
        .closed
        .iter()
        .any(|id| lifts.iter().any(|(open, _)| open == id))
    {
        return why.to_owned();
    }
    let ids: Vec<ConstraintId> = proof.weights.iter().map(|(c, _)| c.joint).collect();
    let (opened, closed) = (names(&ids), names(&proof.closed));
    let mut s = mechanism.scratch();
    mechanism.pose(t, q, &mut s);
    let turns = || is_rotation(mechanism, &s, &ids, &proof.closed);
    let motion = match closed.as_slice() {
        [a, b] if turns() => format!("tips about the line `{a}`–`{b}`"),
        [one] if turns() => format!("tips about `{one}`"),
        [] => "moves".to_owned(),
        more => format!(
            "moves while {}",
            clause(more, ["stays closed", "stay closed"])
        ),
    };
    format!(
        "{why}: it {motion}, and {}",
        clause(&opened, ["opens", "open"])
    )
}

/// Whether the motion is the rotation of one body about the places of the closed joints: it opens
/// the gaps of the joints that open, and changes no other row.
fn is_rotation(
    mechanism: &Mechanism,
    s: &model::Scratch,
    opened: &[ConstraintId],
    closed: &[ConstraintId],
) -> bool {
    let (layout, reactions) = (mechanism.layout(), mechanism.reactions(s));
    let (origin, axis) = match closed {
        [one] if layout.space.n_rotations() == 1 => (reactions.place(*one), [0.0, 0.0, 1.0]),
        [a, b] if layout.space.n_rotations() == 3 => {
            let [a, b] = [a, b].map(|id| reactions.place(*id));
            (a, std::array::from_fn(|k| b[k] - a[k]))
        }
        _ => return false,
    };
    let bodies = |id: ConstraintId| &layout.groups[id.0].bodies;
    let mut moving = bodies(opened[0]).iter();
    let Some(body) = moving.find(|body| **body != BodyRef::Ground) else {
        return false;
    };
    // The rate of a gap, positive if it opens, or the rates of all rows.
    let rates = |id: ConstraintId| -> Vec<f64> {
        let map = reactions.wrench_map_about(id, origin);
        // The reaction acts on the first body, and resists the rates of the rows.
        let sign = if bodies(id)[0] == *body { -1.0 } else { 1.0 };
        let side = layout.groups[id.0].limits.open_side;
        let sign = side.map_or(sign, |side| sign * side.sign());
        let along = |j: usize| {
            let moments = layout.space.torques();
            let each = moments.map(|c| axis[layout.space.axis_of(c)] * map[(c, j)]);
            sign * each.sum::<f64>()
        };
        (0..map.ncols()).map(along).collect()
    };
    let own = layout
        .constraint_ids()
        .filter(|id| bodies(*id).contains(body));
    let (mut open, mut other): (Vec<f64>, f64) = (Vec::new(), 0.0);
    for id in own {
        if bodies(id).len() > 2 {
            return false;
        }
        let rates = rates(id);
        let gap = usize::from(opened.contains(&id));
        open.extend(&rates[..gap]);
        other = rates[gap..].iter().fold(other, |most, x| most.max(x.abs()));
    }
    let most = open.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let is_one_way = |sign: f64| open.iter().all(|x| sign * x > ROUNDING * most);
    open.len() == opened.len() && other <= ROUNDING * most && (is_one_way(1.0) || is_one_way(-1.0))
}
