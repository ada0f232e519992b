//! Values of reactions for the requested choices.

use crate::documents::{DistributionDocument, ValueDocument, ValuesDocument};

use crate::words::Block;

/// Components that do not depend on a choice are listed once; components that depend on it have one
/// column for each choice.
pub(super) fn of(choices: &[DistributionDocument]) -> Vec<Block> {
    if choices.is_empty() {
        return Vec::new();
    }
    let mut header = ["reaction", "component", "determined"]
        .map(str::to_owned)
        .to_vec();
    header.extend((1..=choices.len()).map(|k| format!("choice {k}")));
    let mut table = vec![header];
    let all_of = |d: &'_ DistributionDocument| -> Vec<ValuesDocument> {
        d.reactions.iter().chain(&d.groups).cloned().collect()
    };
    let columns_of: Vec<Vec<ValuesDocument>> = choices.iter().map(all_of).collect();
    for (i, reaction) in columns_of[0].iter().enumerate() {
        for (j, component) in reaction.components.iter().enumerate() {
            let name = component.name.unwrap_or_default();
            let mut cells = vec![reaction.name.clone(), name.to_owned()];
            let number = |v: &ValueDocument| format!("{:>12}", number(v.value.in_solution()));
            let is_fact = component.value.of_choice().is_none();
            if is_fact {
                cells.push(number(component));
            } else {
                cells.push(String::new());
                let all = columns_of.iter();
                cells.extend(all.map(|column| number(&column[i].components[j])));
            }
            table.push(cells);
        }
    }
    let heading = "Reactions on the first body (N, N·m):".to_owned();
    let mut out = vec![Block::Heading(heading), Block::Table(table)];
    let label = |(k, choice): (usize, &DistributionDocument)| {
        Block::Legend(format!("choice {}", k + 1), choice.label.clone())
    };
    out.extend(choices.iter().enumerate().map(label));
    out
}

/// Formats a number with six digits; zero is `0`, and a missing number is `none`.
pub(super) fn number(value: Option<f64>) -> String {
    match value {
        None => "none".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(value) => format!("{value:.5e}"),
    }
}
