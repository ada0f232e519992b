//! Describes dependencies as sentences.

use model::{BodyRef, ConstraintId, Layout, Mechanism, Reaction, Scratch, System};
use rank::Circuit;

use super::FreeDirection;
use crate::limits::{TELLABLE, VISIBLE};
use crate::loads::LoadDescription;
use crate::matrices::Solvability;
use crate::verdict::Verdict;
use crate::words::{list, names};
use model::space::{dot, norm};
use model::words::short;

/// Describes a self-stress in terms of joints and bodies if its geometry allows it, and otherwise
/// in terms of rows. In space, `told` contains the loads on the joints. The numbers are the
/// components that all outputs print. The components belong to the first body of each joint, or to
/// the named component.
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
        if let (LoadDescription::Each(load), Some(sides)) = (&told, sides(directions)) {
            let [these, those] = sides.map(|ids| list(&names(layout, &ids)));
            return format!("{these} can load {those} with {load}, without external load");
        }
        let names = list(&names(layout, &ids));
        let (how, load) = match told {
            LoadDescription::Common(load) => ("load each other with", load),
            LoadDescription::Each(load) => ("each load the others with", load),
            LoadDescription::Various(loads) => ("load each other", format!("({loads})")),
        };
        return format!("{names} can {how} {load}, without external load");
    }
    let cancel = || list(&terms(layout, directions));
    match (directions, bodies.as_slice()) {
        ([x, y], [a, b]) if a == b => {
            let [i, j] = [0, 1].map(|k| format!("`{}`", layout.groups[ids[k].0].name));
            let action = match (drives, x.force) {
                (true, _) => format!("{i} and {j} both prescribe the same motion of {}", list(a)),
                (false, [0.0, 0.0, 0.0]) => {
                    format!("{i} and {j} both prevent {} from turning", against(a))
                }
                (false, _) if slips(layout, &ids) => {
                    format!(
                        "{i} and {j} both prevent {} from slipping sideways along the same line",
                        against(a)
                    )
                }
                (false, _) => format!("{i} and {j} both hold {} along the same line", against(a)),
            };
            format!(
                "{action}: {} cancel{}",
                cancel(),
                sum(mechanism, s, solvability, [x, y]).unwrap_or_default()
            )
        }
        ([_, _, _, ..], _) if circuit.rows.len() > TELLABLE => format!(
            "{} form one self-stress of {} rows: they can {} without external load",
            list(&names(layout, &ids)),
            circuit.rows.len(),
            Loads::of(mechanism, circuit).act()
        ),
        ([_, _, ..], _) => format!(
            "{} cancel: these joints can {} without external load",
            cancel(),
            Loads::of(mechanism, circuit).act()
        ),
        _ => describe(mechanism, circuit),
    }
}

/// Returns the joints whose forces on one body have the sense of the first force, and the joints
/// whose forces have the opposite sense. Returns `None` if the forces have other directions or act
/// on several bodies.
fn sides(directions: &[FreeDirection]) -> Option<[Vec<ConstraintId>; 2]> {
    let first = directions.first()?;
    let mut sides = [Vec::new(), Vec::new()];
    for load in directions {
        let along = dot(load.force, first.force);
        let size = norm(&load.force) * norm(&first.force);
        if load.bodies.first() != first.bodies.first() || along.abs() < (1.0 - VISIBLE) * size {
            return None;
        }
        sides[usize::from(along < 0.0)].push(load.joint);
    }
    let are_both = sides.iter().all(|ids| !ids.is_empty());
    are_both.then_some(sides)
}

/// Returns the names of the bodies that are not the ground, in order.
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

/// Returns whether all constraints are wheels and knife edges, which are single velocity conditions
/// on one body that do not depend on time.
fn slips(layout: &Layout, ids: &[ConstraintId]) -> bool {
    ids.iter().all(|id| {
        let group = &layout.groups[id.0];
        group.bodies.len() == 1
            && group.rows.len() == 1
            && group.rows.holonomic.is_empty()
            && !group.spec.rheonomic
    })
}

/// Returns the components that describe a load, with their values. If the joint has a single row,
/// this is the named component; otherwise it is each component that is not zero.
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

/// Returns the loads on joints as text, for example "`a.Fx` = 1 N" without the quotes.
fn terms(layout: &Layout, loads: &[FreeDirection]) -> Vec<String> {
    let of = |load: &FreeDirection| -> Vec<String> {
        let name = &layout.groups[load.joint.0].name;
        let unit = |component: &str| layout.load_unit(load.joint, component);
        let told = told_components(layout, load).into_iter();
        told.map(|(c, value)| format!("`{name}.{c}` = {} {}", short(value), unit(c)))
            .collect()
    };
    loads.iter().flat_map(of).collect()
}

/// Returns the combination of two reactions that is not changed by their loads, and whether the
/// combination is determined. Returns `None` if one of the two loads has both a force and a torque,
/// or no number.
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
    // The combination has the syntax of the option `--combine`.
    let combination = format!("`{i}.{c} {sign} {factor}{j}.{d}`");
    match solvability.combination(&l).map(|judged| judged.verdict) {
        Ok(Verdict::Unique) => Some(format!("; only {combination} is determined")),
        Ok(Verdict::NotUnique) => Some(format!("; {combination} is not determined, either")),
        _ => None,
    }
}

/// Formats a positive number with the smallest number of digits that reproduces the number to
/// twelve digits.
fn digits(x: f64) -> String {
    let told = |digits: usize| format!("{x:.digits$e}").parse().unwrap_or(x);
    let short = (0..12).map(told).find(|y: &f64| (y - x).abs() <= 1e-12 * x);
    format!("{}", short.unwrap_or_else(|| told(12)))
}

/// Explains the meaning of a circuit to the user. Sums that might be unique are not mentioned,
/// because the rows may also belong to other circuits.
pub(crate) fn describe(mechanism: &Mechanism, circuit: &Circuit) -> String {
    let layout = mechanism.layout();
    let labels: Vec<String> = circuit
        .rows
        .iter()
        .map(|&i| layout.labels[i].to_string())
        .collect();
    match labels.as_slice() {
        [row] => format!(
            "row {row} has no effect at this configuration: its multiplier is not determined"
        ),
        [a, b] => format!(
            "rows {a} and {b} prevent the same motion: the model does not determine how they share a load \
             (multipliers in the ratio {} cancel)",
            ratio(mechanism, circuit)
        ),
        rows => format!(
            "any {} of the rows {} imply the remaining one: the model does not determine how they share a load \
             (multipliers in the ratio {} cancel)",
            rows.len() - 1,
            rows.join(", "),
            ratio(mechanism, circuit)
        ),
    }
}

/// Kind of the multipliers of a circuit. The multiplier of a row in metres is a force, and the
/// multiplier of a row in radians is a torque.
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

    /// Returns the verb that describes how joints act on each other by these loads.
    fn act(self) -> &'static str {
        match self {
            Self::Forces => "press against each other",
            Self::Torques => "turn against each other",
            Self::Both => "press and turn against each other",
        }
    }
}

/// Formats the coefficients without trailing zeros. The sign is chosen so that most coefficients
/// are positive. Units are printed if the rows have different kinds.
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
