//! Dependencies as sentences.

use model::{BodyRef, ConstraintId, Layout, Mechanism, System};
use rank::Circuit;

use super::FreeDirection;
use crate::limits::TELLABLE;
use crate::loads::Told;
use crate::matrices::Solvability;
use crate::verdict::Verdict;
use crate::words::{list, names, short};

/// Describes a self-stress in terms of joints and bodies if its geometry allows it, otherwise in
/// terms of rows. In space, `told` are the loads on the joints.
pub(super) fn of_stress(
    mechanism: &Mechanism,
    solvability: &Solvability,
    circuit: &Circuit,
    directions: &[FreeDirection],
    told: Option<Told>,
) -> String {
    let layout = mechanism.layout();
    let ids: Vec<ConstraintId> = directions.iter().map(|d| d.joint).collect();
    let drives = ids.iter().all(|id| layout.groups[id.0].is_drive());
    let bodies: Vec<Vec<String>> = directions
        .iter()
        .map(|d| moving(mechanism, &d.bodies))
        .collect();
    if let (Some(told), false, [_, _, ..]) = (told, drives, ids.as_slice()) {
        let names = list(&names(layout, &ids));
        let shared = "without any load; how a load is shared among them is not determined";
        return match told {
            Told::Common(load) => format!("{names} can put {load} on each other {shared}"),
            Told::Each(load) => format!("{names} can each put {load} on the others {shared}"),
            Told::Various(loads) => format!("{names} can load each other ({loads}) {shared}"),
        };
    }
    match (ids.as_slice(), bodies.as_slice()) {
        ([_, _], [a, b]) if a == b => {
            let [i, j] = [0, 1].map(|k| format!("`{}`", layout.groups[ids[k].0].name));
            let action = match (drives, directions[0].force) {
                (true, _) => format!("{i} and {j} both prescribe the same motion of {}", list(a)),
                (false, [0.0, 0.0, 0.0]) => {
                    format!("{i} and {j} both stop {} from turning", against(a))
                }
                (false, _) if slips(layout, &ids) => {
                    format!(
                        "{i} and {j} both stop {} from slipping sideways along the same line",
                        against(a)
                    )
                }
                (false, _) => format!("{i} and {j} both hold {} along the same line", against(a)),
            };
            format!(
                "{action}; how the load is shared between them is not determined{}",
                sum(mechanism, solvability, circuit)
            )
        }
        ([_, _, _, ..], _) if circuit.rows.len() > TELLABLE => format!(
            "{} can {} without any load, in one way that involves {} rows; how a load is shared among \
             them is not determined",
            list(&names(layout, &ids)),
            Loads::of(mechanism, circuit).act(),
            circuit.rows.len()
        ),
        ([_, _, _, ..], _) => {
            let rows: Vec<String> = circuit
                .rows
                .iter()
                .map(|&i| layout.labels[i].to_string())
                .collect();
            format!(
                "{} can {} without any load: of the rows {}, any {} imply the remaining one; how a load is \
                 shared among them is not determined ({} cancel out)",
                list(&names(layout, &ids)),
                Loads::of(mechanism, circuit).act(),
                rows.join(", "),
                rows.len() - 1,
                in_ratio(mechanism, circuit)
            )
        }
        _ => describe(mechanism, circuit),
    }
}

/// Names of the bodies that are not the ground, in order.
fn moving(mechanism: &Mechanism, bodies: &[BodyRef]) -> Vec<String> {
    let mut bodies = bodies.to_vec();
    bodies.sort_unstable();
    let name = |b: &BodyRef| match *b {
        BodyRef::Ground => None,
        BodyRef::Body(k) => Some(format!("`{}`", mechanism.bodies()[k].name)),
    };
    bodies.iter().filter_map(name).collect()
}

fn against(bodies: &[String]) -> String {
    match bodies {
        [a, b] => format!("{a} against {b}"),
        bodies => list(bodies),
    }
}

/// Whether all are single velocity conditions on one body that do not depend on time: wheels and
/// knife edges.
fn slips(layout: &Layout, ids: &[ConstraintId]) -> bool {
    ids.iter().all(|id| {
        let group = &layout.groups[id.0];
        group.bodies.len() == 1
            && group.rows.len() == 1
            && group.rows.holonomic.is_empty()
            && !group.spec.rheonomic
    })
}

/// Describes what two rows share: forces that cancel, and whether the combination that this circuit
/// leaves unchanged is determined.
fn sum(mechanism: &Mechanism, solvability: &Solvability, circuit: &Circuit) -> String {
    let loads = Loads::of(mechanism, circuit).word();
    let cancel = format!("; {loads} {} on them cancel", ratio(mechanism, circuit));
    let ([i, j], [a, b]) = (circuit.rows.as_slice(), circuit.coefficients.as_slice()) else {
        return cancel;
    };
    let decision = solvability.decision();
    let mut l = vec![0.0; decision.rank + decision.redundancy];
    (l[*i], l[*j]) = (*b, -*a);
    let combined = Circuit {
        left_out: circuit.left_out,
        rows: circuit.rows.clone(),
        coefficients: vec![*b, -*a],
    };
    match solvability.combination(&l).map(|judged| judged.verdict) {
        Ok(Verdict::Unique) => format!(
            "{cancel}, their sum with weights {} is determined",
            ratio(mechanism, &combined)
        ),
        Ok(Verdict::NotUnique) => {
            format!("{cancel}, and their sum depends on other reactions that are not determined")
        }
        _ => cancel,
    }
}

/// Explains the meaning of a circuit to the reader. Sums that might be unique are not mentioned,
/// because the rows may take part in other circuits too.
pub(crate) fn describe(mechanism: &Mechanism, circuit: &Circuit) -> String {
    let layout = mechanism.layout();
    let labels: Vec<String> = circuit
        .rows
        .iter()
        .map(|&i| layout.labels[i].to_string())
        .collect();
    match labels.as_slice() {
        [row] => format!("row {row} constrains nothing here: its multiplier is not determined"),
        [a, b] => format!(
            "rows {a} and {b} forbid the same motion: how a load is shared between them is not determined \
             ({} cancel out)",
            in_ratio(mechanism, circuit)
        ),
        rows => format!(
            "of the rows {}, any {} imply the remaining one: how a load is shared among them is not determined \
             ({} cancel out)",
            rows.join(", "),
            rows.len() - 1,
            in_ratio(mechanism, circuit)
        ),
    }
}

/// Kind of the multipliers of a circuit: a row in metres has a force, a row in radians a torque.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Loads {
    Forces,
    Torques,
    Both,
}

impl Loads {
    fn of(mechanism: &Mechanism, circuit: &Circuit) -> Self {
        let angular = circuit
            .rows
            .iter()
            .filter(|&&i| mechanism.layout().is_angular(i));
        match angular.count() {
            0 => Self::Forces,
            n if n == circuit.rows.len() => Self::Torques,
            _ => Self::Both,
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Forces => "forces",
            Self::Torques => "torques",
            Self::Both => "forces and torques",
        }
    }

    /// The verb for the action of joints on each other by these loads.
    fn act(self) -> &'static str {
        match self {
            Self::Forces => "press against each other",
            Self::Torques => "turn against each other",
            Self::Both => "press and turn against each other",
        }
    }
}

fn in_ratio(mechanism: &Mechanism, circuit: &Circuit) -> String {
    let loads = Loads::of(mechanism, circuit).word();
    format!("{loads} in the ratio {}", ratio(mechanism, circuit))
}

/// Coefficients without trailing zeros, with the sign for which most are positive; with units if
/// the rows have different kinds.
fn ratio(mechanism: &Mechanism, circuit: &Circuit) -> String {
    let negative = circuit.coefficients.iter().filter(|c| **c < 0.0).count();
    let sign = if 2 * negative > circuit.coefficients.len() {
        -1.0
    } else {
        1.0
    };
    let is_mixed = Loads::of(mechanism, circuit) == Loads::Both;
    let unit = |row: usize| match (is_mixed, mechanism.layout().is_angular(row)) {
        (false, _) => "",
        (true, false) => " N",
        (true, true) => " N·m",
    };
    let terms = circuit.rows.iter().zip(&circuit.coefficients);
    let parts: Vec<String> = terms
        .map(|(&row, c)| format!("{}{}", short(sign * c), unit(row)))
        .collect();
    parts.join(" : ")
}
