//! The picture with its controls: views, visible items, free motions and self-stresses, and the
//! time.

use model::SpaceKind;

use super::data::Data;
use super::first_order::FirstOrder;
use super::run_page::RunPage;
use report::page::{add, safe};

/// Title of the section with the picture.
pub(super) fn title(page: &RunPage<'_>) -> &'static str {
    if page.moves() { "Motion" } else { "Picture" }
}

/// Standard views of space.
const VIEWS: &str = "<div class=\"views\" role=\"group\" aria-label=\"View\">\
<button id=\"view-x\" type=\"button\" aria-label=\"View along x\">x</button>\
<button id=\"view-y\" type=\"button\" aria-label=\"View along y\">y</button>\
<button id=\"view-z\" type=\"button\" aria-label=\"View along z\">z</button>\
<button id=\"view-home\" type=\"button\" aria-label=\"View from the right and above\" title=\"From the right and above\">◳</button>\
<button id=\"perspective\" type=\"button\" aria-label=\"Perspective\" aria-pressed=\"false\" title=\"Perspective\">⬡</button></div>\n\
<p id=\"view\" class=\"unseen\" aria-live=\"polite\"></p>\n";

/// Description of the keys of a picture in space, for readers who cannot see the picture.
const SPATIAL_KEYS: &str = ". Arrow keys rotate the view. Shift with an arrow key moves the view. Plus and minus zoom. The keys x, y, z and i select standard views. The key p switches the perspective on or off";

/// Controls that only the page of a run has. `$bodies` is replaced by the title of the list of
/// bodies.
const OF_RUN: &str = "<fieldset class=\"option\"><legend>Arrows</legend><input id=\"arrows\" type=\"range\" min=\"-2\" max=\"2\" \
step=\"0.1\" value=\"0\" aria-label=\"Length of arrows\"></fieldset>\n\
<fieldset class=\"option\"><legend>$bodies</legend><div id=\"bodies\"></div></fieldset>\n";

/// Controls that save the picture as shown.
const SAVE: &str = "<fieldset class=\"option save\"><legend>Save picture</legend>\
<button id=\"save-svg\" type=\"button\" aria-label=\"Save picture as SVG\">SVG</button>\
<button id=\"save-png\" type=\"button\" aria-label=\"Save picture as PNG\">PNG</button></fieldset>\n";

/// Writes the animation with its controls.
pub(super) fn section(out: &mut String, page: &RunPage<'_>, data: &Data<'_>) {
    let title = title(page);
    add(
        out,
        format_args!(
            "<section id=\"motion\" aria-labelledby=\"motion-title\">\n<h2 id=\"motion-title\">{title}</h2>\n"
        ),
    );
    out.push_str(
        "<noscript><p class=\"warning\">The picture and the curves require JavaScript. The verdicts and inputs below do not.</p></noscript>\n\
         <div class=\"stage\">\n",
    );
    let is_spatial = page.mechanism.space() == SpaceKind::Space3;
    out.push_str(if is_spatial {
        "<div class=\"picture spatial\">\n"
    } else {
        "<div class=\"picture\">\n"
    });
    add(
        out,
        format_args!(
            "<canvas id=\"picture\" role=\"img\" tabindex=\"0\" aria-label=\"Animated drawing of {} to scale. Each joint is marked with the verdict of its \
             reaction; the table below lists these verdicts{}\"></canvas>\n",
            safe(page.mechanism.name()),
            if is_spatial { SPATIAL_KEYS } else { "" }
        ),
    );
    out.push_str(
        "<div class=\"now\" id=\"now\"></div>\n<div class=\"now\" id=\"rate\" hidden></div>\n<div class=\"zoom\"><button id=\"zoom-in\" type=\"button\" aria-label=\"Zoom in\">+</button>\
         <button id=\"zoom-out\" type=\"button\" aria-label=\"Zoom out\">−</button>\
         <button id=\"zoom-reset\" type=\"button\" aria-label=\"Show all\">⤢</button></div>\n",
    );
    if is_spatial {
        out.push_str(VIEWS);
    }
    out.push_str(
        "<div class=\"legend\" id=\"symbols\"></div>\n</div>\n<aside class=\"panel\" \
         aria-label=\"Legend and display options\">\n",
    );
    if !page.verdicts().is_empty() {
        out.push_str("<fieldset><legend>Reactions</legend>\n");
        legend(out, page);
        out.push_str("</fieldset>\n");
    }
    out.push_str(
        "<fieldset class=\"option\"><legend>Show</legend><div id=\"options\"></div></fieldset>\n",
    );
    out.push_str(SAVE);
    if page.run().is_some() {
        // The report for a customer has no curves of bodies.
        let bodies = if page.is_for_customer() {
            "Traces"
        } else {
            "Traces and curves"
        };
        out.push_str(&OF_RUN.replace("$bodies", bodies));
    }
    out.push_str("</aside>\n</div>\n");
    if !page.is_for_customer() {
        first_order(out, &data.first_order);
    }
    out.push_str(
        "<p class=\"grey\">The model does not contain the shapes of bodies. Each body is drawn through its centre of mass and the points \
         at which joints and forces act on it. <span class=\"screen\">",
    );
    out.push_str(if is_spatial { "Drag to rotate the view. Drag with Shift, the right button or two fingers to move the view. Zoom with Ctrl and the wheel, or with the wheel after a click" } else { "Drag to move the view. Zoom with Ctrl and the wheel, or with the wheel after a click" });
    out.push_str(match (page.run(), page.is_for_customer()) {
        (None, _) => "",
        (_, false) => ". Click a joint to plot its reaction, or a body to show or hide its trace",
        (_, true) => ". Click a body to show or hide its trace",
    });
    out.push_str(".</span></p>\n</section>\n");
}

/// Writes the lists of free motions and self-stresses, if there are any.
fn first_order(out: &mut String, shown: &FirstOrder<'_>) {
    if shown.motions.is_empty() && shown.stresses.is_empty() {
        return;
    }
    out.push_str("<div class=\"first-order\">\n");
    if !shown.motions.is_empty() {
        out.push_str(
            "<fieldset class=\"option\"><legend>Free motions at the start</legend><div id=\"motions\"></div></fieldset>\n",
        );
    }
    if !shown.stresses.is_empty() {
        out.push_str(
            "<fieldset class=\"option\"><legend>Loads that cancel (self-stresses)</legend><select id=\"stress\" aria-label=\"Self-stress\">\
             <option value=\"\">none</option></select><div id=\"stress-loads\"></div></fieldset>\n",
        );
    }
    out.push_str("</div>\n");
}

/// Writes the meaning of marks and arrows that occur in the picture.
fn legend(out: &mut String, page: &RunPage<'_>) {
    const MARK: &str = "<g transform=\"translate(17 11)\" class=\"site VERDICT\"><circle class=\"mark\" r=\"6.5\"/></g>";
    const ARROW: &str = "<path class=\"force\" d=\"M2 9.4H22V6L32 11L22 16V12.6H2Z\"/>";
    const MOMENT: &str =
        "<path class=\"force\" d=\"M2 9.4H14V6L23 9.4V6L32 11L23 16V12.6L14 16V12.6H2Z\"/>";
    const FREE: &str = "<path class=\"free\" d=\"M1 11L10 4V8H24V4L33 11L24 18V14H10V18Z\"/>";
    let all = page.verdicts();
    let occurs = |word: &str| all.iter().any(|(_, verdict, _)| *verdict == word);
    let mut row = |picture: &str, words: &str| {
        add(
            out,
            format_args!(
                "<div class=\"key-row\"><svg viewBox=\"0 0 34 22\" aria-hidden=\"true\">{picture}</svg>{words}</div>\n"
            ),
        );
    };
    for (verdict, words) in [
        ("unique", "unique"),
        ("not_unique", "not unique"),
        ("undecided", "undecided"),
    ] {
        if occurs(verdict) {
            row(&MARK.replace("VERDICT", verdict), words);
        }
    }
    let is_spatial = page.mechanism.space() == SpaceKind::Space3;
    if page.run().is_some() {
        row(ARROW, "determined part of the reaction on the first body");
        if is_spatial {
            row(
                MOMENT,
                "determined part of the reaction moment on the first body",
            );
        }
    }
    // In space, the directions are drawn only for the joint whose curves are selected.
    let is_drawn = !(is_spatial && page.is_for_customer());
    if is_drawn && !page.comparisons.is_empty() {
        row(
            FREE,
            if is_spatial {
                "directions in which the model does not determine the selected reaction"
            } else {
                "direction in which the model does not determine the reaction"
            },
        );
    }
}

/// Writes the controls of the time.
pub(super) fn transport(out: &mut String) {
    out.push_str(
        "<div class=\"transport\" role=\"group\" aria-label=\"Time\">\n\
         <button id=\"play\" type=\"button\" aria-label=\"Play\">▶</button>\n\
         <div class=\"track\"><div id=\"marks\"></div><input id=\"scrub\" type=\"range\" aria-label=\"Time (s)\"></div>\n\
         <span id=\"time\"></span>\n<label>Speed <select id=\"speed\"></select></label>\n\
         <span class=\"keys\">space: play or pause · ← →: step one frame</span>\n</div>\n",
    );
}
