//! `report.html` of a comparison: one file that opens offline, for readers who do not know the
//! program.

use super::{
    Place, ReferenceDocument, WorkPrecisionDocument, WorkPrecisionRow, WorkPrecisionScene,
};
use crate::page::{add, close, duration, list, open, safe, short};

/// Explanation of the numbers, once for all scenes.
const EXPLANATION: &str = "<p>Each run is compared with values that it did not make itself. <em>Errors</em> are the largest over all \
components and reference times; lengths are measured in the size of the mechanism, and the error of each kind (position, velocity, \
acceleration, reaction) is relative to the largest value of the kind. Reactions are compared only where they are unique: other \
ones belong to the elimination, not to the mechanism. <em>Evaluations</em> are solved accelerations, rejected steps and starts \
included; each of them solves the equations once, and <em>factorisations</em> are those of the iteration matrices of implicit methods. \
<em>Seconds</em> are the shortest of at least three runs after one to warm up, without output; runs are repeated until \
they have taken 20 ms. In the figure the error is the larger one of position and velocity, a point is a tolerance, and down and to the left \
is better. Below the dashed line the reference itself is not known better. Runs that failed, were refused or given up are rows of the tables with \
their reason.</p>\n";

/// The page of a comparison; `figure` is the SVG of [`crate::figures::work_precision()`].
#[must_use]
pub fn work_precision_page(document: &WorkPrecisionDocument, figure: &str) -> String {
    let mut page = open("Error against run time");
    if document.partial {
        page.push_str("<p><strong>Interrupted: not all runs were made.</strong></p>\n");
    }
    list(&mut page, &document.summary);
    page.push_str(EXPLANATION);
    page.push_str(figure);
    for scene in &document.scenes {
        section(&mut page, scene);
    }
    close(&mut page, &document.provenance);
    page
}

fn section(page: &mut String, scene: &WorkPrecisionScene) {
    let id = safe(&scene.name);
    let heading = format_args!("<h2 id=\"{id}\">{}</h2>\n", safe(&scene.title));
    add(page, heading);
    reference(page, &scene.reference);
    list(page, &scene.summary);
    ranking(page, scene);
    runs(page, scene);
}

fn reference(page: &mut String, reference: &ReferenceDocument) {
    let [position, velocity, acceleration, reaction] = reference.limits.map(short);
    let words = format_args!(
        "<p class=\"grey\">Reference: {} Known to {position} (position), {velocity} (velocity), {acceleration} (acceleration), {reaction} \
         (unique reactions). {}</p>\n",
        safe(&reference.source),
        safe(&reference.agreement)
    );
    add(page, words);
}

/// Time and evaluations of each curve at each error; the fastest is marked.
fn ranking(page: &mut String, scene: &WorkPrecisionScene) {
    let mut curves = Vec::new();
    for place in scene.ranking.iter().flat_map(|line| &line.places) {
        if !curves.contains(&&place.curve) {
            curves.push(&place.curve);
        }
    }
    if curves.is_empty() {
        return;
    }
    page.push_str("<div class=\"wide\"><table>\n<tr><th class=\"name\">time, evaluations for an error of</th>");
    for line in &scene.ranking {
        add(page, format_args!("<th>{:.0e}</th>", line.error));
    }
    page.push_str("</tr>\n");
    for curve in curves {
        let name = [curve.method, curve.formulation, curve.stabilisation].join(", ");
        add(
            page,
            format_args!("<tr><td class=\"name\">{}</td>", safe(&name)),
        );
        for line in &scene.ranking {
            let place = line.places.iter().position(|p| p.curve == *curve);
            match place.map(|k| (k, &line.places[k])) {
                Some((
                    k,
                    Place {
                        seconds,
                        evaluations,
                        ..
                    },
                )) => {
                    let class = if k == 0 { " class=\"best\"" } else { "" };
                    let cell =
                        format_args!("<td{class}>{}, {evaluations:.0}</td>", duration(*seconds));
                    add(page, cell);
                }
                None => page.push_str("<td>–</td>"),
            }
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</table></div>\n");
}

/// All runs.
fn runs(page: &mut String, scene: &WorkPrecisionScene) {
    let summary = format_args!(
        "<details><summary>All {} runs</summary>\n",
        scene.rows.len()
    );
    add(page, summary);
    page.push_str(
        "<div class=\"wide\"><table>\n<tr><th class=\"name\">method</th><th class=\"name\">formulation</th>\
         <th class=\"name\">stabilisation</th><th>tolerance</th><th>position</th><th>velocity</th><th>acceleration</th>\
         <th>reactions</th><th>constraints</th><th>energy</th><th>evaluations</th><th>projections</th><th>factorisations</th><th>steps</th>\
         <th>rejected</th><th>time</th><th class=\"name\">status</th></tr>\n",
    );
    for row in &scene.rows {
        run(page, row);
    }
    page.push_str("</table></div></details>\n");
}

fn run(page: &mut String, row: &WorkPrecisionRow) {
    let curve = &row.curve;
    page.push_str("<tr>");
    for name in [curve.method, curve.formulation, curve.stabilisation] {
        add(page, format_args!("<td class=\"name\">{}</td>", safe(name)));
    }
    add(page, format_args!("<td>{:.0e}</td>", row.tolerance));
    for number in row
        .errors
        .into_iter()
        .chain([row.constraint_residual, row.energy_error])
    {
        add(page, format_args!("<td>{}</td>", short(number)));
    }
    for count in [
        row.evaluations,
        row.projections,
        row.factorisations,
        row.steps,
        row.rejected,
    ] {
        add(page, format_args!("<td>{count}</td>"));
    }
    let end = format_args!(
        "<td>{}</td><td class=\"status\">{}</td></tr>\n",
        duration(row.seconds),
        safe(&row.status)
    );
    add(page, end);
}
