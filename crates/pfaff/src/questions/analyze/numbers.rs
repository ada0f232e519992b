//! Values of reactions for the requested choices.

use model::words::listed;

use crate::documents::{AnalysisDocument, DistributionDocument, ValueDocument, ValuesDocument};

use crate::words::{Block, Cell, load_unit};

/// Components that do not depend on the choice are listed once. Components that depend on the
/// choice have one column for each choice.
pub(super) fn of(d: &AnalysisDocument) -> Vec<Block> {
    let choices = &d.answers.choices;
    if choices.is_empty() {
        return Vec::new();
    }
    let mut header = ["reaction", "component", "determined"]
        .map(Cell::from)
        .to_vec();
    header.extend((1..=choices.len()).map(|k| Cell::from(format!("choice {k}"))));
    let mut table = vec![header];
    let all_of = |d: &'_ DistributionDocument| -> Vec<ValuesDocument> {
        d.reactions.iter().chain(&d.groups).cloned().collect()
    };
    let columns_of: Vec<Vec<ValuesDocument>> = choices.iter().map(all_of).collect();
    for (i, reaction) in columns_of[0].iter().enumerate() {
        for (j, component) in reaction.components.iter().enumerate() {
            let name = component.name.unwrap_or_default();
            let sum = d
                .groups
                .iter()
                .find(|g| name == "sum" && g.name == reaction.name);
            let unit = sum.map_or(load_unit(name), |sum| sum.unit.unwrap_or_default());
            let number = |v: &ValueDocument| Cell::quantity(v.value.in_solution(), unit);
            let mut cells = vec![reaction.name.as_str().into(), name.into()];
            if component.value.of_choice().is_none() {
                cells.push(number(component));
            } else {
                cells.push("".into());
                let all = columns_of.iter();
                cells.extend(all.map(|column| number(&column[i].components[j])));
            }
            table.push(cells);
        }
    }
    for (name, numbers) in &d.answers.loads.0 {
        let components = numbers
            .0
            .iter()
            .filter(|(number, _)| !load_unit(number).is_empty());
        for (component, value) in components {
            let mut cells = vec![
                name.as_str().into(),
                component.as_str().into(),
                Cell::quantity(*value, load_unit(component)),
            ];
            cells.extend(choices.iter().map(|_| Cell::from("")));
            table.push(cells);
        }
    }
    let heading = if d.answers.loads.is_empty() {
        "Reactions on the first body:"
    } else {
        "Reactions and forces on the first body:"
    };
    let mut out = vec![Block::Heading(heading.to_owned()), Block::Table(table)];
    let label = |(k, choice): (usize, &DistributionDocument)| {
        let mut text = choice.label.clone();
        if !choice.not_permitted.is_empty() {
            let found = listed(&choice.not_permitted);
            text += &format!("; the contacts do not permit these reactions: {found}");
        }
        if let Some(why) = &choice.permission_undecided {
            text += &format!("; whether the contacts permit these reactions is not decided: {why}");
        }
        Block::Legend(format!("choice {}", k + 1), text)
    };
    out.extend(choices.iter().enumerate().map(label));
    out
}
