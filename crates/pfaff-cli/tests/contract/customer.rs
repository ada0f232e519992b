//! Tests the report for a customer, curves of sums of reactions, and plots with several curves.

use serde_json::Value;

use super::report::{data, without_time};
use super::{Folder, stderr, with_scene};

/// Weight of the bar (N).
const WEIGHT: f64 = 2.0 * 9.81;

/// A bar of 2 kg and length 2 lies on two pins, with a pendulum under its middle that a spring
/// holds. The pins can push against each other along the bar, and the model determines all other
/// loads. Each pin carries half of the weight of the bar.
const BAR: &str = r#"
[scene]
name = "bar"
space = "plane"
gravity = [0, -9.81]
title = "Bar \"on\" <pins> & more"
author = "A. Author"
project = "Project P"
date = "2026-03-02"

[[body]]
name = "bar"
mass = 2.0
inertia = 0.3
position = [1, 0]

[[body]]
name = "bob"
mass = 1.0
inertia = 0.1
position = [1, -3]
velocity = [0.5, 0]
angular_velocity = 0.5

[[joint]]
name = "left"
type = "revolute"
bodies = ["ground", "bar"]
at = [0, 0]

[[joint]]
name = "right"
type = "revolute"
bodies = ["ground", "bar"]
at = [2, 0]

[[joint]]
name = "pivot"
type = "revolute"
bodies = ["ground", "bob"]
at = [1, -2]

[[force]]
name = "spring"
type = "spring-damper"
bodies = ["ground", "bob"]
points = { ground = [3, -3], bob = [0, 0] }
stiffness = 10.0
damping = 0.0
free_length = 1.0

[[marker]]
name = "tip"
body = "bob"
point = [0, -1]

[[measure]]
name = "height"
type = "y"
markers = ["tip"]

[[group]]
name = "both pins"
combine = "left.Fy + right.Fy"

[[group]]
name = "across"
combine = "left.Fx - right.Fx"

[[group]]
name = "whole"
combine = "left + right"

[[group]]
name = "together"
members = ["left", "right"]

[simulate]
t_end = 1.0
output_step = 0.01
"#;

/// Runs a scene into a folder with more options and returns its page.
#[track_caller]
fn run(folder: &Folder, scene: &str, more: &[&str]) -> String {
    let args = [&["simulate", "-", "--out", folder.text()][..], more].concat();
    let output = with_scene(&args, scene);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    folder.read("report.html")
}

/// Returns the values of a curve of the data at all frames; a gap is NaN.
fn values(channel: &Value, frames: usize) -> Vec<f64> {
    let Some(steps) = channel["d"].as_array() else {
        return vec![channel.as_f64().unwrap_or(f64::NAN); frames];
    };
    let number = |key: &str| channel[key].as_f64().expect("a number");
    let mut level = 0.0;
    let value = |step: &Value| {
        step.as_f64().map_or(f64::NAN, |step| {
            level += step;
            number("o") + number("s") * level
        })
    };
    steps.iter().map(value).collect()
}

fn charts<'d>(data: &'d Value, place: &str) -> Vec<&'d Value> {
    let all = data["charts"].as_array().expect("a list").iter();
    all.filter(|chart| chart["place"] == place).collect()
}

fn titles<'d>(charts: &[&'d Value]) -> Vec<&'d str> {
    let titles = charts.iter().map(|chart| chart["title"].as_str());
    titles.map(|title| title.expect("a title")).collect()
}

/// Returns the text between two others.
#[track_caller]
fn between<'t>(text: &'t str, begin: &str, end: &str) -> &'t str {
    let (_, rest) = text
        .split_once(begin)
        .unwrap_or_else(|| panic!("no `{begin}`"));
    rest.split_once(end)
        .unwrap_or_else(|| panic!("no `{end}`"))
        .0
}

#[test]
fn sums_of_reactions_have_curves_and_peaks_where_they_are_determined() {
    let folder = Folder::new("customer-groups");
    let page = run(&folder, BAR, &[]);
    let data = data(&page);
    let groups = charts(&data, "group-curves");
    // The reactions act on the ground, and both pins carry the weight; `across` is not determined.
    let (of_sums, of_whole): (Vec<_>, Vec<_>) = groups
        .iter()
        .partition(|chart| chart["title"] == "both pins");
    assert!(
        titles(&of_whole)
            .iter()
            .all(|title| title.starts_with("whole.")),
        "{groups:?}"
    );
    let sum = of_sums.first().expect("a chart of the sum");
    assert_eq!(
        (&sum["badge"], &sum["unit"]),
        (&"unique".into(), &"N".into())
    );
    let curve = values(&sum["curves"][0][1], 1);
    assert!((curve[0] + WEIGHT).abs() < 1e-6 * WEIGHT, "{curve:?}");
    let peaks = between(&page, "Peak loads</h2>", "</table>");
    let row = |name: &str| between(peaks, &format!("<td><b>{name}</b></td>"), "</tr>");
    assert!(
        row("both pins").contains("−19.62 N"),
        "{}",
        row("both pins")
    );
    assert!(row("both pins").contains("every choice (unique combination)"));
    assert!(row("across").contains("not determined by the model"));
    assert!(!row("across").contains(" N"), "{}", row("across"));
    // A group of members has a verdict and no number.
    assert!(!peaks.contains("<b>together</b>"));
    assert!(page.contains("The combined reactions of “across” and “together” are not unique."));
}

#[test]
fn a_sum_that_is_not_determined_is_a_band_with_bounds() {
    let folder = Folder::new("customer-bands");
    let data = data(&run(&folder, BAR, &["--bounds"]));
    let groups = charts(&data, "group-curves");
    let across = groups.iter().find(|chart| chart["title"] == "across");
    let across = across.expect("a chart with a band");
    assert_eq!(across["badge"], "not_unique");
    assert_eq!(
        across["curves"].as_array().map(Vec::len),
        Some(0),
        "{across}"
    );
    assert_eq!(across["band"].as_array().map(Vec::len), Some(2), "{across}");
}

#[test]
fn a_report_for_a_customer_says_the_same_in_fewer_sections() {
    let (full, short) = (Folder::new("customer-full"), Folder::new("customer-short"));
    let full = run(&full, BAR, &[]);
    let page = run(&short, BAR, &["--print", "customer"]);
    assert!(
        page.contains("<body class=\"customer\">") && !full.contains("<body class=\"customer\">")
    );
    let part = |begin, end| {
        let parts = [&full, &page].map(|page| between(page, begin, end));
        assert_eq!(parts[0], parts[1], "{begin}");
        parts[0].to_owned()
    };
    let verdict = part("<p class=\"answer\">", "</p>");
    assert!(
        verdict.contains("The reactions of left and right are not unique"),
        "{verdict}"
    );
    part("<h3>Ways to make a reaction unique", "</ul>");
    let assumptions = part("<h2 id=\"assumptions-title\">", "</ul>");
    for words in [
        "All bodies are rigid",
        "without friction",
        "only where a force element describes them: <b>spring</b>",
        "(0, −9.81) m/s²",
        "without the redundant constraint rows (row ",
        "only by a choice",
        "satisfies all constraints without a correction",
        "1e-8 relative",
    ] {
        assert!(assumptions.contains(words), "{words}: {assumptions}");
    }
    let cover = part("<h1>", "</dl>");
    for words in [
        "Bar &quot;on&quot; &lt;pins&gt; &amp; more",
        "<dd>Project P</dd>",
        "<dd>A. Author</dd>",
        "<dd>2026-03-02</dd>",
    ] {
        assert!(cover.contains(words), "{words}: {cover}");
    }
    assert!(
        page.contains(
            r#"@bottom-left { content: "Bar \22 on\22  \3c pins> \26  more · Project P" }"#
        )
    );
    for section in [
        "id=\"verdicts\"",
        "id=\"reactions\"",
        "id=\"energy-curves\"",
        "class=\"tiles\"",
    ] {
        assert!(
            full.contains(section) && !page.contains(section),
            "{section}"
        );
    }
}

#[test]
fn a_report_for_a_customer_has_determined_numbers_only() {
    let folder = Folder::new("customer-numbers");
    let page = run(&folder, BAR, &["--print", "customer"]);
    let peaks = between(&page, "Determined peaks</h2>", "</section>");
    assert!(
        peaks.contains("<th class=\"figure\">Force (N)</th>"),
        "{peaks}"
    );
    // Each pin carries half of the weight on the ground.
    let left = between(peaks, "<b>left</b>", "</tr>");
    assert!(left.contains(">Fy<") && left.contains(">−9.81<"), "{left}");
    assert!(!peaks.contains(">Fx<"), "{peaks}");
    assert!(peaks.contains("<b>both pins</b>") && peaks.contains(">−19.62<"));
    assert!(
        peaks.contains("no load other than zero for <b>across</b>"),
        "{peaks}"
    );
    assert!(peaks.contains("<b>height</b>") && peaks.contains(">smallest value<"));
    let data = data(&page);
    let all = data["charts"].as_array().expect("a list").len();
    let printed = charts(&data, "printed-curves");
    assert_eq!(printed.len(), all);
    // Loads that stay the same have no curve.
    assert_eq!(titles(&printed)[0], "pivot", "{:?}", titles(&printed));
    // Annexes are closed, so that they are not printed.
    let annexes = between(&page, "<section id=\"annexes\"", "</section>");
    assert_eq!(
        annexes
            .matches("<details class=\"on-request annex\"><summary>")
            .count(),
        2
    );
    assert!(annexes.contains("name = &quot;both pins&quot;"));
    assert!(
        !page
            .replace(annexes, "")
            .contains("name = &quot;both pins&quot;")
    );
}

#[test]
fn a_report_for_a_customer_depends_only_on_its_input() {
    let folder = Folder::new("customer-same");
    let scene = format!("{BAR}\n[output]\nreport = false\nprint = \"full\"\n");
    // The option takes precedence over the scene.
    let first = without_time(&run(&folder, &scene, &["--print", "customer"]));
    assert_eq!(
        first,
        without_time(&run(&folder, &scene, &["--print", "customer"]))
    );
    let of_scene = format!("{BAR}\n[output]\nprint = \"customer\"\n");
    assert!(run(&folder, &of_scene, &[]).contains("<body class=\"customer\">"));
    assert!(!run(&folder, &of_scene, &["--print", "full"]).contains("<body class=\"customer\">"));
    let output = with_scene(
        &["simulate", "-", "--out", folder.text(), "--print", "client"],
        BAR,
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("full, customer"),
        "{}",
        stderr(&output)
    );
}

/// Every column of the tables is a curve with the values of the table.
#[test]
fn a_plot_may_have_every_column_of_the_tables() {
    let folder = Folder::new("customer-columns");
    let accelerations = "[output]\naccelerations = true\n";
    run(&folder, &format!("{BAR}\n{accelerations}"), &[]);
    let mut columns = Vec::new();
    for table in ["reactions.csv", "loads.csv", "trajectory.csv"] {
        let text = folder.read(table);
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
        let header: Vec<String> = lines.next().expect("a header").collect();
        let last: Vec<String> = lines.next_back().expect("a row").collect();
        columns.extend(header.into_iter().zip(last).skip(1));
    }
    assert!(columns.len() > 40, "{columns:?}");
    let names = columns
        .iter()
        .map(|(name, _)| name.trim_end_matches(".fragile"));
    let plots: Vec<String> = names.map(|name| format!("[\"{name}\"]")).collect();
    let scene = format!("{BAR}\n{accelerations}plots = [{}]\n", plots.join(", "));
    let data = data(&run(&folder, &scene, &[]));
    let frames = data["t"].as_array().expect("times").len();
    let found = charts(&data, "plot-curves");
    assert_eq!(found.len(), columns.len());
    for ((name, cell), chart) in columns.iter().zip(found) {
        let curve = values(&chart["curves"][0][1], frames);
        let last = curve.last().copied().unwrap_or(f64::NAN);
        let range = curve.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        match cell.parse::<f64>() {
            // A curve is rounded to a fraction of its range.
            Ok(value) => assert!(
                (last - value).abs() <= 1e-3 * range + 1e-9,
                "{name}: {last} {value}"
            ),
            Err(_) => assert!(last.is_nan(), "{name}: {last}"),
        }
    }
}

#[test]
fn a_plot_has_several_curves_of_one_unit() {
    let folder = Folder::new("customer-plots");
    let plots = r#"
[output]
print = "customer"
plots = [["left.Fy", "both pins", "left.Fx"], { title = "Heights", curves = ["height", "tip.y"] }]
"#;
    let page = run(&folder, &format!("{BAR}\n{plots}"), &[]);
    let data = data(&page);
    let charts = charts(&data, "printed-curves");
    assert_eq!(titles(&charts), ["left.Fy, both pins, left.Fx", "Heights"]);
    let curves = charts[0]["curves"].as_array().expect("curves");
    let last = |curve: &Value| values(&curve[1], 2)[1];
    assert!((last(&curves[0]) + 0.5 * WEIGHT).abs() < 1e-6, "{curves:?}");
    assert!((last(&curves[1]) + WEIGHT).abs() < 1e-6, "{curves:?}");
    assert_eq!(curves[2][0], "left.Fx (not determined by the model)");
    assert!(last(&curves[2]).is_nan());
    for (plots, words) in [
        (
            "[[\"left.Fz\"]]",
            "no column `left.Fz`: did you mean `left.F",
        ),
        (
            "[[\"height\", \"left.Fy\"]]",
            "`height` is in m, `left.Fy` is in N: all curves of a plot have one unit",
        ),
        ("[[\"both pin\"]]", "did you mean `both pins`?"),
        ("[[\"spring\"]]", "there are spring.Fx, spring.Fy"),
        (
            "[[\"qqq\"]]",
            "write a column of reactions.csv, loads.csv or trajectory.csv",
        ),
    ] {
        let scene = format!("{BAR}\n[output]\nplots = {plots}\n");
        for question in ["check", "simulate"] {
            let args = [&[question, "-"][..], &["--out", folder.text()]].concat();
            let args = if question == "check" {
                &args[..2]
            } else {
                &args
            };
            let output = with_scene(args, &scene);
            assert_eq!(output.status.code(), Some(2), "{plots}");
            let message = stderr(&output)
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" ");
            assert!(message.contains(words), "{message}");
        }
    }
}

#[test]
fn without_a_table_of_reactions_none_is_plotted() {
    let folder = Folder::new("customer-none");
    let scene = format!("{BAR}\n[output]\nreactions = false\nplots = [[\"height\"]]\n");
    let data = data(&run(&folder, &scene, &[]));
    assert_eq!(titles(&charts(&data, "plot-curves")), ["height"]);
    assert!(charts(&data, "group-curves").is_empty());
    let output = with_scene(
        &["check", "-"],
        &scene.replace("\"height\"]]", "\"left.Fy\"]]"),
    );
    assert!(
        stderr(&output).contains("`reactions` is false"),
        "{}",
        stderr(&output)
    );
}
