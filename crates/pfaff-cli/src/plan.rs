//! `pfaff plan`: the parts of the program that a run needs, those it omits, and the reasons.

use pfaff::Overrides;
use pfaff::dynamics::Plan;
use pfaff::dynamics::plan::Line;
use pfaff::memory::Bytes;
use pfaff::report::PlanDocument;

use crate::args;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Outcome, columns, count, wrapped};
use crate::sweep;

pub(crate) fn run(arguments: &args::Plan, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let overrides = Overrides {
        t_end: arguments.t_end,
        ..arguments.way.overrides()?
    };
    let study = source.study(&overrides, arguments.resources, console)?;
    let plan = study.plan().map_err(|e| source.failure(e))?;
    let memory = study
        .memory(source.text.len())
        .map_err(|e| source.failure(e))?;
    let sweep = match arguments.vary.as_slice() {
        [] => None,
        axes => Some(sweep::read(&source, axes.to_vec())?.evaluation()),
    };
    if !arguments.json {
        let mut text = describe(study.scene.name(), &plan, memory);
        if let Some(sweep) = sweep {
            text.push_str(&wrapped("\nruns of the sweep: ", &sweep));
        }
        return console.print(&text);
    }
    let mut document = PlanDocument::new(&plan, memory);
    document.sweep = sweep;
    console.document(&document)
}

/// One table for the whole mechanism, and one for each component if there are several.
fn describe(name: &str, plan: &Plan<'_>, memory: usize) -> String {
    let options = plan.options();
    let lines = plan.lines();
    let mut text = format!(
        "{name}: the plan of a run to t = {} s ({}, {}), about {} of memory\n\n",
        options.t_end,
        pfaff::dynamics::FORMULATION,
        options.stabilisation.name(),
        Bytes(memory as u64),
    );
    let of = |component| lines.iter().filter(move |line| line.component == component);
    text.push_str(&table(of(None)));
    if plan.components.len() == 1 {
        return text;
    }
    for component in &plan.components {
        let sizes = &component.sizes;
        text.push_str(&format!(
            "\n{}: {}, {}, rank {}\n",
            component.name,
            count(sizes.velocities, "velocity", "velocities"),
            count(sizes.rows(), "row", "rows"),
            sizes.rank,
        ));
        text.push_str(&table(of(Some(component.name.as_str()))));
    }
    text
}

fn table<'p>(lines: impl Iterator<Item = &'p Line<'p>>) -> String {
    let header = ["decision", "taken", "saves", "reason"]
        .map(str::to_owned)
        .to_vec();
    let cells = lines.map(|line| {
        let saves = line.saves.map_or(String::new(), |saves| saves.to_string());
        vec![
            line.decision.to_owned(),
            line.taken.to_owned(),
            saves,
            line.reason.to_owned(),
        ]
    });
    columns(&std::iter::once(header).chain(cells).collect::<Vec<_>>())
}
