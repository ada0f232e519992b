//! The scene, options, versions and numbers of the run that are needed to reproduce the page. Also
//! a list of the parts that the page omits.

use dynamics::INDEPENDENT_ROWS;
use model::System;

use super::cast::Cast;
use super::curves::{self, Curves};
use super::data;
use super::run_page::RunPage;
use crate::documents::{MisfitDocument, RunDocument};
use report::page::{add, duration, list, safe, short};

/// Largest size of a scene included in a page (bytes).
const SCENE_MOST: usize = 200_000;

pub(super) fn section(out: &mut String, page: &RunPage<'_>, cast: &Cast, curves: &Curves) {
    out.push_str("<section id=\"inputs\" aria-labelledby=\"inputs-title\">\n<h2 id=\"inputs-title\">Inputs and versions</h2>\n<dl>\n");
    pair(
        out,
        "Command",
        &format!("<code>{}</code>", safe(&page.origin.command)),
    );
    pair(out, "Versions", &safe(&page.origin.versions));
    for (what, value) in page.options {
        pair(out, &safe(what), &safe(value));
    }
    out.push_str("</dl>\n");
    if let Some(run) = page.run() {
        out.push_str("<h3>Statistics of the run</h3>\n<dl>\n");
        numbers(out, run);
        out.push_str("</dl>\n<details><summary>Plan of the run</summary>\n");
        plan(out, run);
        out.push_str("</details>\n");
    }
    if let Some(text) = page.scene.text {
        out.push_str("<details><summary>Text of the scene</summary>\n");
        scene(out, text);
        out.push_str("</details>\n");
    }
    out.push_str("<h3>Omitted from this page</h3>\n");
    list(out, &left_out(page, cast, curves));
    out.push_str("</section>\n");
}

/// Writes the text of the scene and the plan as annexes. An annex is printed only if it is open.
pub(super) fn annexes(out: &mut String, page: &RunPage<'_>) {
    out.push_str(
        "<section id=\"annexes\" aria-labelledby=\"annexes-title\">\n<h2 id=\"annexes-title\" class=\"screen\">Annexes</h2>\n\
         <p class=\"grey screen\">An annex is printed if it is open.</p>\n",
    );
    if let Some(text) = page.scene.text {
        out.push_str(
            "<details class=\"on-request annex\"><summary>Annex: text of the scene</summary>\n",
        );
        scene(out, text);
        out.push_str("</details>\n");
    }
    if let Some(run) = page.run() {
        out.push_str("<details class=\"on-request annex\"><summary>Annex: plan and statistics of the run</summary>\n<dl>\n");
        for (what, value) in page.options {
            pair(out, &safe(what), &safe(value));
        }
        numbers(out, run);
        out.push_str("</dl>\n");
        plan(out, run);
        out.push_str("</details>\n");
    }
    out.push_str("</section>\n");
}

/// Writes the command and the versions that made the page.
pub(super) fn origin(out: &mut String, page: &RunPage<'_>) {
    add(
        out,
        format_args!(
            "<p class=\"grey origin\">Made by <code>{}</code> ({}).</p>\n",
            safe(&page.origin.command),
            safe(&page.origin.versions)
        ),
    );
}

fn plan(out: &mut String, run: &RunDocument) {
    out.push_str("<dl>\n");
    for (what, taken) in &run.plan.0 {
        pair(out, &safe(what), &safe(taken));
    }
    for component in &run.components {
        for (what, taken) in component.plan.0.iter().take(8) {
            pair(
                out,
                &safe(&format!("{}: {what}", component.name)),
                &safe(taken),
            );
        }
    }
    out.push_str("</dl>\n");
}

fn numbers(out: &mut String, run: &RunDocument) {
    let numbers = [
        (
            "Method",
            format!(
                "{} ({}, {})",
                run.method, INDEPENDENT_ROWS, run.stabilisation
            ),
        ),
        ("Time reached", format!("t = {} s", run.t_end)),
        (
            "Steps",
            format!("{} accepted, {} rejected", run.steps, run.rejected),
        ),
        (
            "Evaluations",
            format!("{} evaluations of the accelerations", run.evaluations),
        ),
        ("Projections", run.projections.to_string()),
        ("Run time of the integration", duration(run.wall_seconds)),
        ("Largest |Φ|", short(run.max_position_residual)),
        ("Largest |C·v − b|", short(run.max_velocity_residual)),
        (
            "Energy error",
            format!(
                "{} relative to the largest kinetic energy",
                short(run.energy_balance)
            ),
        ),
        (
            "Initial corrections",
            format!(
                "position {}, velocity {}",
                short(run.start_correction),
                short(run.start_velocity_correction)
            ),
        ),
        (
            "Separately simulated components",
            run.components.len().to_string(),
        ),
    ];
    for (what, value) in numbers {
        pair(out, what, &safe(&value));
    }
    for line in MisfitDocument::lines(&run.misfits) {
        pair(
            out,
            "Constraint violations within the tolerance",
            &safe(&line),
        );
    }
    if let Some(spread) = &run.spread {
        pair(
            out,
            "Difference between choices of independent rows",
            &safe(&spread.to_string()),
        );
    }
}

fn scene(out: &mut String, text: &str) {
    let end = text.floor_char_boundary(SCENE_MOST);
    out.push_str("<pre>");
    // Lines are escaped separately, because escaping replaces line feeds by spaces.
    for line in text[..end].lines() {
        out.push_str(&safe(line));
        out.push('\n');
    }
    out.push_str("</pre>\n");
    if end < text.len() {
        add(
            out,
            format_args!(
                "<p class=\"grey\">This page shows the first {end} of {} bytes of the scene.</p>\n",
                text.len()
            ),
        );
    }
}

fn pair(out: &mut String, what: &str, value: &str) {
    add(out, format_args!("<dt>{what}</dt><dd>{value}</dd>\n"));
}

/// Returns sentences about the omitted parts.
pub(super) fn left_out(page: &RunPage<'_>, cast: &Cast, curves: &Curves) -> Vec<String> {
    let mut told = Vec::new();
    let groups = page.mechanism.layout().groups.len();
    if !cast.is_whole() {
        told.push(format!(
            "The picture and the curves show {} of {groups} joints and drives: the joints and drives of the first {} of {} bodies.",
            cast.joints().len(),
            cast.bodies().len(),
            page.mechanism.bodies().len()
        ));
    }
    if page.recording.stride > 1 {
        told.push(format!(
            "This page uses one in {} output rows ({} of {}). The files trajectory.csv and reactions.csv contain all requested rows.",
            page.recording.stride,
            page.recording.frames.len(),
            page.recording.rows()
        ));
    }
    let measures = page.mechanism.frames().observed().measures.len();
    if curves.omitted > 0 {
        told.push(format!(
            "This page omits {} plots. The key `plots` of `[output]` selects the plots.",
            curves.omitted
        ));
    }
    if measures > curves::MEASURES_MAX {
        told.push(format!(
            "This page plots {} of {measures} measures. The file trajectory.csv contains all of them.",
            curves::MEASURES_MAX
        ));
    }
    if page.drives.len() > curves::DRIVES_MAX {
        told.push(format!(
            "This page plots {} of {} drives.",
            curves::DRIVES_MAX,
            page.drives.len()
        ));
    }
    if page.run().is_some() {
        told.push(format!(
        "Each curve is rounded to 1/{} of its range. Between output rows, the picture interpolates the positions with cubic polynomials that match the positions and velocities of the rows.",
        data::levels()
    ));
    }
    told.extend(page.left_out.iter().cloned());
    told
}
