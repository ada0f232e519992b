//! Dependencies as sentences.

use model::{BodyRef, ConstraintId, Layout, Mechanism, Reaction, Scratch, System};
use rank::Circuit;

use super::{FreeDirection, is_turned};
use crate::limits::TELLABLE;
use crate::loads::LoadDescription;
use crate::matrices::Solvability;
use crate::verdict::Verdict;
use crate::words::{list, names, short};

/// Describes a self-stress in terms of joints and bodies if its geometry allows it, otherwise in
/// terms of rows. In space, `told` are the loads on the joints. Numbers are those of the reactions
/// as all outputs tell them: on the first body of each joint, or the named component.
pub(super) fn of_stress(
    mechanism: &Mechanism,
    s: &Scratch,
    solvability: &Solvability,
    circuit: &Circuit,
    directions: &[FreeDirection],
    told: Option<LoadDescription>,
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
            LoadDescription::Common(load) => {
                format!("{names} can put {load} on each other {shared}")
            }
            LoadDescription::Each(load) => {
                format!("{names} can each put {load} on the others {shared}")
            }
            LoadDescription::Various(loads) => {
                format!("{names} can load each other ({loads}) {shared}")
            }
        };
    }
    let cancel = || list(&terms(layout, directions));
    match (directions, bodies.as_slice()) {
        ([x, y], [a, b]) if a == b => {
            let [i, j] = [0, 1].map(|k| format!("`{}`", layout.groups[ids[k].0].name));
            let action = match (drives, x.force) {
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
                "{action}; how the load is shared between them is not determined; {} cancel{}",
                cancel(),
                sum(mechanism, s, solvability, [x, y]).unwrap_or_default()
            )
        }
        ([_, _, _, ..], _) if circuit.rows.len() > TELLABLE => format!(
            "{} can {} without any load, in one way that involves {} rows; how a load is shared among \
             them is not determined",
            list(&names(layout, &ids)),
            Loads::of(mechanism, circuit).act(),
            circuit.rows.len()
        ),
        ([_, _, ..], _) => {
            let rows: Vec<String> = circuit
                .rows
                .iter()
                .map(|&i| layout.labels[i].to_string())
                .collect();
            format!(
                "{} can {} without any load: of the rows {}, any {} imply the remaining one; how a load is \
                 shared among them is not determined ({} cancel)",
                list(&names(layout, &ids)),
                Loads::of(mechanism, circuit).act(),
                rows.join(", "),
                rows.len() - 1,
                cancel()
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

/// The component of a load by which it is told: the named one if the joint has a single row,
/// otherwise each that is not zero. With its value.
fn told_components(layout: &Layout, load: &FreeDirection) -> Vec<(&'static str, f64)> {
    let group = &layout.groups[load.joint.0];
    if let (Some(name), Some(value), 1) = (group.spec.component, load.component, group.rows.len()) {
        return vec![(name, value)];
    }
    let space = layout.space;
    let wrench = Reaction {
        force: load.force,
        torque: load.torque,
        component: None,
    };
    let named = space.components().iter().copied();
    let all = named.zip(wrench.components(space));
    all.filter(|(_, value)| *value != 0.0).collect()
}

/// The loads on joints, as "`a.Fx` = 1 N" without the quotes.
fn terms(layout: &Layout, loads: &[FreeDirection]) -> Vec<String> {
    let space = layout.space;
    let of = |load: &FreeDirection| -> Vec<String> {
        let name = &layout.groups[load.joint.0].name;
        let unit = |component: &str| {
            let is_torque = match space.component(component) {
                Some(k) => !space.forces().contains(&k),
                None => is_turned(layout, load.joint),
            };
            if is_torque { "N·m" } else { "N" }
        };
        let told = told_components(layout, load).into_iter();
        told.map(|(c, value)| format!("`{name}.{c}` = {} {}", short(value), unit(c)))
            .collect()
    };
    loads.iter().flat_map(of).collect()
}

/// The combination of two reactions that their loads leave as it is, and whether it is determined;
/// nothing if one of the two loads has both a force and a torque, or no number.
fn sum(
    mechanism: &Mechanism,
    s: &Scratch,
    solvability: &Solvability,
    loads: [&FreeDirection; 2],
) -> Option<String> {
    let layout = mechanism.layout();
    // Forces along one line have the same largest component.
    let told = loads.map(|load| {
        let is_mixed = load.force != [0.0; 3] && load.torque != [0.0; 3];
        let components = told_components(layout, load);
        let largest = components.into_iter().max_by(|a, b| {
            let difference = a.1.abs() - b.1.abs();
            difference.total_cmp(&0.0)
        });
        largest.filter(|_| !is_mixed)
    });
    let [(c, x), (d, y)] = [told[0]?, told[1]?];
    let weight = -x / y;
    let decision = solvability.decision();
    let mut l = vec![0.0; decision.rank + decision.redundancy];
    for (load, component, weight) in [(loads[0], c, 1.0), (loads[1], d, weight)] {
        let id = load.joint;
        let coefficients = mechanism
            .reactions(s)
            .component_coefficients(id, component)?;
        for (row, coefficient) in layout.groups[id.0].rows.iter().zip(coefficients) {
            l[row] += weight * coefficient;
        }
    }
    let [i, j] = loads.map(|load| &layout.groups[load.joint.0].name);
    let factor = match digits(weight.abs()).as_str() {
        "1" => String::new(),
        weight => format!("{weight}*"),
    };
    let sign = if weight < 0.0 { '-' } else { '+' };
    // As `--combine` reads it.
    let combination = format!("`{i}.{c} {sign} {factor}{j}.{d}`");
    match solvability.combination(&l).map(|judged| judged.verdict) {
        Ok(Verdict::Unique) => Some(format!(", {combination} is determined")),
        Ok(Verdict::NotUnique) => Some(format!(
            ", and {combination} depends on other reactions that are not determined"
        )),
        _ => None,
    }
}

/// A positive number with as few digits as tell it to twelve.
fn digits(x: f64) -> String {
    let told = |digits: usize| format!("{x:.digits$e}").parse().unwrap_or(x);
    let short = (0..12).map(told).find(|y: &f64| (y - x).abs() <= 1e-12 * x);
    format!("{}", short.unwrap_or_else(|| told(12)))
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
             (multipliers in the ratio {} cancel)",
            ratio(mechanism, circuit)
        ),
        rows => format!(
            "of the rows {}, any {} imply the remaining one: how a load is shared among them is not determined \
             (multipliers in the ratio {} cancel)",
            rows.join(", "),
            rows.len() - 1,
            ratio(mechanism, circuit)
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

    /// The verb for the action of joints on each other by these loads.
    fn act(self) -> &'static str {
        match self {
            Self::Forces => "press against each other",
            Self::Torques => "turn against each other",
            Self::Both => "press and turn against each other",
        }
    }
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
