//! Names of choices.

use crate::limits::{FIRST_NAMED, NAMED_ROWS};

use model::{ConstraintId, Layout, RowLabel};

use super::error::{list, row_word};
use super::{Choice, Compliance, Misfit};
use crate::value::Label;
use crate::words;

/// Returns the name of a choice in which these joints and drives are rigid.
pub(crate) fn label(layout: &Layout, choice: &Choice, rigid: &[ConstraintId]) -> Label {
    let text = match choice {
        Choice::MinimumNorm(w) => format!(
            "minimum norm, forces weighted by {}/N and torques by {}/(N·m)",
            w.force, w.torque
        ),
        Choice::Compliance(supports) => {
            let joint = |j: &Compliance| {
                let name = &layout.groups[j.reaction.0].name;
                let axes = ["x", "y", "z"].into_iter().zip(j.along);
                let directions = axes.take(layout.space.n_translations());
                let along = if directions.clone().all(|(_, along)| along == j.along[0]) {
                    format!("{:e} m/N", j.along[0])
                } else {
                    let each = directions.map(|(axis, c)| format!("{c:e} m/N along {axis}"));
                    each.collect::<Vec<_>>().join(", ")
                };
                if j.rotation == 0.0 {
                    format!("`{name}` {along}")
                } else {
                    format!("`{name}` {along}, {:e} rad/(N·m)", j.rotation)
                }
            };
            let listed: Vec<String> = supports.compliances.iter().map(joint).collect();
            let rigid = match words::names(layout, rigid).as_slice() {
                [] => String::new(),
                names => format!("; rigid: {}", names.join(", ")),
            };
            let misfit = |m: &Misfit| {
                let name = &layout.groups[m.reaction.0].name;
                let part = |numbers: &[f64], unit| {
                    let numbers = numbers.iter().map(|x| format!("{x}"));
                    let numbers: Vec<String> = numbers.collect();
                    format!("({}) {unit}", numbers.join(", "))
                };
                let along = part(&m.along[..layout.space.n_translations()], "m");
                match layout.space.n_rotations() {
                    _ if m.rotation == [0.0; 3] => format!("`{name}` {along}"),
                    1 => format!("`{name}` {along}, {} rad", m.rotation[2]),
                    _ => format!("`{name}` {along}, {}", part(&m.rotation, "rad")),
                }
            };
            let misfits: Vec<String> = supports.misfits.iter().map(misfit).collect();
            let misfits = match misfits.as_slice() {
                [] => String::new(),
                all => format!("; misfit: {}", all.join("; ")),
            };
            format!("elastic supports: {}{rigid}{misfits}", listed.join("; "))
        }
        Choice::Elimination(rows) => {
            let known = rows.iter().filter_map(|&i| layout.labels.get(i));
            let labels: Vec<RowLabel> = known.cloned().collect();
            // The label is repeated with every number. Therefore it lists only the first rows.
            let (first, more) = if labels.len() > NAMED_ROWS {
                labels.split_at(FIRST_NAMED)
            } else {
                (&labels[..], &[][..])
            };
            let word = row_word(&labels);
            match more.len() {
                0 => format!("no reaction in {word} {}", list(first)),
                more => format!("no reaction in {word} {} and {more} more", list(first)),
            }
        }
    };
    Label::new(text)
}
