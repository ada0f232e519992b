//! The assumptions of a run in plain words: the content of the model, the omitted effects, and the
//! accuracy of the data and of the motion. Every page of a run has this section.

use model::words::{estimate, listed, rounded, vector};
use model::{ContactLimits, System};

use super::run_page::RunPage;
use super::verdicts;
use crate::documents::{MisfitDocument, RunDocument};

pub(super) fn section(out: &mut String, page: &RunPage<'_>) {
    let Some(run) = page.run() else {
        return;
    };
    out.push_str(
        "<section id=\"assumptions\" aria-labelledby=\"assumptions-title\">\n<h2 id=\"assumptions-title\">Assumptions</h2>\n",
    );
    verdicts::some(out, &sentences(page, run));
    let notes = verdicts::notes(page);
    if page.is_for_customer() && !notes.is_empty() {
        out.push_str("<h3>Warnings and notes</h3>\n");
        verdicts::some(out, &notes);
    }
    out.push_str("</section>\n");
}

fn sentences(page: &RunPage<'_>, run: &RunDocument) -> Vec<String> {
    let mut all = vec![
        "All bodies are rigid. Joints are ideal: they have no clearance and no elasticity, and they act without friction."
            .to_owned(),
        forces(page),
        gravity(page),
    ];
    all.extend(drives(page));
    all.extend(contacts(page));
    all.push(
        "The model omits deformation, wear, the strength of parts, and contact between bodies unless a joint describes it. \
         It does not contain the shapes of bodies."
            .to_owned(),
    );
    all.extend(data(run));
    all.push(accuracy(page, run));
    all.extend(
        run.energy_warning()
            .map(|warning| format!("Warning: {warning}.")),
    );
    all.push(start(run));
    all.extend(choice(page, run));
    let misfits = MisfitDocument::lines(&run.misfits).into_iter();
    all.extend(misfits.map(|line| format!("Constraint violation within the tolerance: {line}.")));
    let spread = run.spread.iter();
    all.extend(spread.map(|spread| format!("Effect of the choice of independent rows: {spread}.")));
    if !page.scene.inactive.is_empty() {
        let names = page.scene.inactive.join(", ");
        all.push(format!(
            "Elements that are not active are not part of the model: {names}."
        ));
    }
    let bounds = run.bounds.iter();
    all.extend(bounds.map(|bounds| format!("The bounds (≤) are valid {}.", bounds.assumption)));
    all
}

/// Names the force elements. They are the only source of friction.
fn forces(page: &RunPage<'_>) -> String {
    let loads = page.mechanism.loads();
    let names: Vec<String> = loads
        .forces()
        .map(|(name, _)| format!("`{name}`"))
        .collect();
    match names.as_slice() {
        [] => "The scene has no force elements: no springs, no damping, no friction and no external loads.".to_owned(),
        names => format!(
            "Springs, damping, friction and external loads act only where a force element describes them: {}.",
            listed(names)
        ),
    }
}

/// Names the one-sided joints and the contacts that grip.
fn contacts(page: &RunPage<'_>) -> Vec<String> {
    let groups = page.mechanism.layout().groups.iter();
    let named = |is: fn(&ContactLimits) -> bool| -> Vec<String> {
        let own = groups.clone().filter(|group| is(&group.limits));
        own.map(|group| format!("`{}`", group.name)).collect()
    };
    let (sided, gripping) = (
        named(|limits| limits.open_side.is_some()),
        named(|limits| limits.grip.is_some()),
    );
    let mut all = Vec::new();
    if !sided.is_empty() {
        all.push(format!(
            "One-sided joints act in one direction only and can open: {}. The run ends when they cannot all stay closed. A choice among the solutions may contain loads that they do not permit.",
            listed(&sided)
        ));
    }
    if !gripping.is_empty() {
        all.push(format!(
            "Contacts with a coefficient of friction do not slip in the computed motion: {}. The run ends when they slip for every sharing of the loads.",
            listed(&gripping)
        ));
    }
    all
}

fn gravity(page: &RunPage<'_>) -> String {
    let g = &page.scene.gravity;
    if g.iter().all(|g| *g == 0.0) {
        return "There is no gravity.".to_owned();
    }
    format!("Gravity is {} in ground axes.", vector(g, 0.0, "m/s²"))
}

fn drives(page: &RunPage<'_>) -> Option<String> {
    let names: Vec<String> = page
        .drives
        .iter()
        .map(|d| format!("`{}`", d.name))
        .collect();
    match names.as_slice() {
        [] => None,
        [one] => Some(format!(
            "The drive {one} follows its prescribed motion exactly, whatever force this needs."
        )),
        names => Some(format!(
            "The drives {} follow their prescribed motions exactly, whatever forces this needs.",
            listed(names)
        )),
    }
}

/// States the accuracy of the data.
fn data(run: &RunDocument) -> Vec<String> {
    let data = &run.data;
    let length = data
        .tolerance
        .map(|tolerance| format!("points and lengths to {}", estimate(tolerance, "m")));
    let angle = data
        .angle_tolerance
        .map(|tolerance| format!("angles and directions to {}", estimate(tolerance, "rad")));
    let stated: Vec<String> = [length, angle].into_iter().flatten().collect();
    let first = match stated.as_slice() {
        [] => "The scene states no tolerances: its data count as exact except for rounding."
            .to_owned(),
        stated => format!(
            "The data of the scene are accurate within its tolerances: {}.",
            stated.join(", ")
        ),
    };
    let warning = data.warning(run.mobility);
    [Some(first), warning].into_iter().flatten().collect()
}

/// States the accuracy of the motion.
fn accuracy(page: &RunPage<'_>, run: &RunDocument) -> String {
    let stated = page.options.iter().find(|(what, _)| what == "Tolerances");
    let stated = stated.map_or_else(String::new, |(_, value)| {
        format!(" with the tolerances {value}")
    });
    format!(
        "The motion is computed up to t = {} s by {}{stated}. The largest constraint violation is {}, and the error of the energy \
         balance is {} of the largest kinetic energy.",
        rounded(run.t_end),
        run.method,
        report::page::short(run.max_position_residual),
        report::page::short(run.energy_balance)
    )
}

/// States how the start differs from the described start.
fn start(run: &RunDocument) -> String {
    let [position, velocity] =
        [run.start_correction, run.start_velocity_correction].map(report::page::short);
    match (
        run.start_correction > 0.0,
        run.start_velocity_correction > 0.0,
    ) {
        (false, false) => {
            "The start of the scene satisfies all constraints without a correction.".to_owned()
        }
        _ => format!(
            "The start was corrected so that it satisfies all constraints: coordinates by at most {position} (m or rad), velocities by at \
             most {velocity} (m/s or rad/s)."
        ),
    }
}

/// States which rows are redundant, and which results depend on the choice of the redundant rows.
fn choice(page: &RunPage<'_>, run: &RunDocument) -> Vec<String> {
    let redundancy = page.analysis.map(|a| a.ranks.redundancy);
    let mut all = Vec::new();
    match redundancy {
        Some(0) => all.push("No constraint row is redundant.".to_owned()),
        _ => {
            let rows = page
                .options
                .iter()
                .find(|(what, _)| what == "Dependent rows");
            let rows = rows.map_or_else(String::new, |(_, rows)| {
                let noun = if rows.contains(',') { "rows" } else { "row" };
                format!(" ({noun} {rows})")
            });
            all.push(format!(
                "The motion is computed without the redundant constraint rows{rows}. The motion does not depend on this choice of rows."
            ));
        }
    }
    if !run.choice.is_empty() {
        let named = run
            .choice
            .iter()
            .filter(|choice| choice.name != run.formulation);
        let mut named: Vec<&str> = named.map(|choice| choice.name.as_str()).collect();
        named.dedup();
        let named = match named.as_slice() {
            [] => String::new(),
            named => format!(" ({})", listed(named)),
        };
        all.push(format!(
            "Reactions that the model does not determine depend on elasticity and clearance, which the model does not contain. A solver \
             obtains numbers for them only by a choice{named}. No peak and no single curve on this page is such a number."
        ));
    }
    if let Some(first) = run.special.first() {
        all.push(format!(
            "At {} instants, the first at t = {} s, a verdict differs from the verdict before and after. The file summary.json lists them.",
            run.special.len(),
            rounded(first.time)
        ));
    }
    all
}
