//! Writes `report.html` of a comparison, one file that can be opened offline, for readers who have
//! not used the program.

use super::{
    Place, ReferenceDocument, WorkPrecisionDocument, WorkPrecisionRow, WorkPrecisionScene,
};
use crate::page::{add, close, duration, list, open, safe, short};

/// Explanation of the values for all scenes.
const EXPLANATION: &str = "<p>Each run is compared with reference values that do not come from the same run. <em>Errors</em> are the largest over all \
components and reference times. Lengths are divided by the size of the mechanism. The error of each kind (position, velocity, \
acceleration, reaction) is relative to the largest value of that kind. Only unique reactions are compared: the values of other reactions \
depend on the chosen independent rows, not only on the mechanism. <em>Evaluations</em> count the computations of accelerations, including \
rejected steps and starts. Each evaluation solves the equations of motion once. <em>Factorisations</em> count the factorised iteration \
matrices of implicit methods. <em>Seconds</em> are the shortest run time of at least three runs without output, after one warm-up run. Runs \
are repeated until their total time is at least 20 ms. In the figure, the error is the larger of the errors of position and velocity. Each point \
belongs to one tolerance; points further down and to the left are better. Errors below the dashed line are smaller than the uncertainty of \
the reference. The tables also list failed, rejected and abandoned runs with their reasons.</p>\n";

/// The page of a comparison; `figure` is the SVG of [`crate::figures::work_precision()`].
#[must_use]
pub fn work_precision_page(document: &WorkPrecisionDocument, figure: &str) -> String {
    let mut page = open("Error against run time");
    if document.partial {
        page.push_str(
            "<p><strong>The comparison was interrupted. Some runs are missing.</strong></p>\n",
        );
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
        "<p class=\"grey\">Reference: {} Accuracy: {position} (position), {velocity} (velocity), {acceleration} (acceleration), {reaction} \
         (unique reactions). {}</p>\n",
        safe(&reference.source),
        safe(&reference.agreement)
    );
    add(page, words);
}

/// Time and evaluations of each curve at each error; the fastest curve is marked.
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
    page.push_str("<div class=\"wide\"><table>\n<tr><th class=\"name\">run time and evaluations for an error of</th>");
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
