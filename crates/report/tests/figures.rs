//! Tests figures: well-formed XML with the expected contents, for ordinary and for degenerate data.

use joints::Revolute;
use model::{Body, BodyRef, Description, Joint, Mechanism, System};
use pfaff_report::figures::{Marking, histories, history, mechanism, paths};
use pfaff_report::{FigureError, Panel, Path, PathRecorder, Series, Style};
use solvability::{Verdict, analyse};
use tests::robot::{robot, steering};

/// Parses a document to check that it is well-formed: tags are nested, attributes are quoted,
/// special characters are escaped. Returns the texts of the document.
fn texts(svg: &str) -> Vec<String> {
    let mut open: Vec<String> = Vec::new();
    let mut found = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let (before, tag) = (&rest[..start], &rest[start + 1..]);
        found.extend((!before.trim().is_empty()).then(|| unescaped(before)));
        let end = tag.find('>').expect("a tag ends");
        let (tag, after) = (&tag[..end], &tag[end + 1..]);
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name));
        } else {
            let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
            check_attributes(attributes.trim_end_matches('/'));
            if !tag.ends_with('/') {
                open.push(name.to_owned());
            }
        }
        rest = after;
    }
    assert!(open.is_empty() && rest.trim().is_empty());
    assert!(
        !svg.contains("NaN") && !svg.contains("inf"),
        "no number is missing"
    );
    found
}

fn check_attributes(attributes: &str) {
    let parts: Vec<&str> = attributes.split('"').collect();
    assert_eq!(parts.len() % 2, 1, "quotes are paired: {attributes}");
    let (last, pairs) = parts.split_last().expect("at least one part");
    assert!(last.trim().is_empty(), "{attributes}");
    let mut names = Vec::new();
    for pair in pairs.chunks(2) {
        let name = pair[0].trim().strip_suffix('=').expect("name=\"value\"");
        assert!(
            !names.contains(&name),
            "{name} is given twice: {attributes}"
        );
        names.push(name);
        unescaped(pair[1]);
    }
}

/// Returns a text without entities; control characters and single special characters are rejected.
fn unescaped(text: &str) -> String {
    assert!(!text.contains(|c: char| c.is_control() && c != '\n'));
    let plain = ["lt;", "gt;", "quot;", "amp;"];
    for part in text.split('&').skip(1) {
        assert!(plain.iter().any(|p| part.starts_with(p)), "&{part}");
    }
    text.replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&amp;", "&")
}

fn the_robot() -> (Mechanism, Vec<f64>) {
    let mechanism = Mechanism::build(&robot(steering())).expect("the robot builds");
    let q = mechanism.described_state().0;
    (mechanism, q)
}

/// Returns the value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let from = tag.find(&format!(" {name}=\"")).expect("the attribute") + name.len() + 3;
    let length = tag[from..].find('"').expect("its end");
    &tag[from..from + length]
}

/// Size of the smallest name (px).
const SIZE: f64 = 12.0;

#[test]
fn the_robot_has_all_names_and_verdicts_without_overlap() {
    let (robot, q) = the_robot();
    let analysis = analyse(&robot, 0.0, &q).expect("C is finite");
    let svg = mechanism(&robot, 0.0, &q, Marking::Verdicts(&analysis.reactions)).expect("draws");
    let texts = texts(&svg);
    let names: Vec<&str> = robot
        .bodies()
        .iter()
        .map(|b| b.name.as_str())
        .chain(robot.layout().groups.iter().map(|g| g.name.as_str()))
        .collect();
    // Labels consist of a name only. Tool tips have more words, except the tool tips of bodies.
    let labels: Vec<[f64; 4]> = svg
        .lines()
        .filter(|l| l.starts_with("<text class=\"name"))
        .map(|l| {
            let content = &l[l.find('>').expect("ends") + 1..l.rfind("</").expect("closes")];
            assert!(names.contains(&content), "{content}");
            let number = |name| attribute(l, name).parse::<f64>().expect("a number");
            // The estimated width is too small, so that every overlap found is real.
            let width = content.chars().count() as f64;
            [number("x"), number("y"), 0.25 * SIZE * width, 0.35 * SIZE]
        })
        .collect();
    assert_eq!(labels.len(), names.len(), "every name is shown once");
    for (k, a) in labels.iter().enumerate() {
        for b in &labels[..k] {
            let apart = |i: usize| (a[i] - b[i]).abs() >= a[i + 2] + b[i + 2];
            assert!(apart(0) || apart(1), "{a:?} {b:?}");
        }
    }
    for tip in [
        "B (revolute): reaction not unique",
        "W3 (knife-edge): reaction not unique",
        "W5 (knife-edge): reaction unique",
        "H (translational): reaction unique",
        "steering (displacement): reaction unique",
    ] {
        assert!(texts.iter().any(|t| t == tip), "{tip}");
    }
    for legend in ["reaction undecided", "knife-edge", "displacement drive"] {
        assert!(texts.iter().any(|t| t == legend), "{legend}");
    }
    assert!(texts.iter().any(|t| t == "0.2 m"), "the scale");
    assert!(!svg.contains("var("), "every colour is a number");
}

#[test]
fn an_undecided_reaction_is_drawn_as_such() {
    let (robot, q) = the_robot();
    let mut analysis = analyse(&robot, 0.0, &q).expect("C is finite");
    let reason = String::from("doubt");
    analysis.reactions[0].wrench.verdict = Verdict::Undecided { reason };
    let svg = mechanism(&robot, 0.0, &q, Marking::Verdicts(&analysis.reactions)).expect("draws");
    assert!(texts(&svg).contains(&"A (revolute): reaction undecided".to_owned()));
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    let (robot, mut q) = the_robot();
    let error = mechanism(&robot, 0.0, &q[1..], Marking::Plain).expect_err("one is missing");
    assert_eq!(
        error.to_string(),
        "20 coordinates, the mechanism `robot-trolley` has 21"
    );
    let error = mechanism(&robot, 0.0, &q, Marking::Verdicts(&[])).expect_err("none");
    assert!(
        matches!(
            error,
            FigureError::Verdicts {
                found: 0,
                expected: 14,
                ..
            }
        ),
        "{error}"
    );
    q[4] = f64::NAN;
    let error = mechanism(&robot, 0.0, &q, Marking::Plain).expect_err("NaN");
    assert!(
        error
            .to_string()
            .starts_with("coordinate 5 of `robot-trolley` is NaN")
    );
    assert!(matches!(
        PathRecorder::new(&robot, &[7]).err(),
        Some(FigureError::Body {
            index: 7,
            bodies: 7,
            ..
        })
    ));
}

/// Returns `n` bodies in a row, each connected to the previous one; names contain special
/// characters.
fn chain(n: usize, length: f64) -> (Mechanism, Vec<f64>) {
    let bodies = (0..n).map(|k| Body {
        name: format!("<b>&\"{k}'\u{7}"),
        mass: 1.0,
        inertia: 1.0,
        position: [length * k as f64, 0.0],
        ..Body::default()
    });
    let joints = (0..n).map(|k| {
        let before = k.checked_sub(1).map_or(BodyRef::Ground, BodyRef::Body);
        let reach = if k == 0 { 0.0 } else { length };
        let element = Revolute {
            s_i: [reach, 0.0],
            s_j: [0.0, 0.0],
        };
        Joint::new(&format!("]]>{k}"), &[before, BodyRef::Body(k)], element)
    });
    let description = Description {
        name: "chain <&>".into(),
        bodies: bodies.collect(),
        joints: joints.collect(),
        ..Description::default()
    };
    let mechanism = Mechanism::build(&description).expect("builds");
    let q = mechanism.described_state().0;
    (mechanism, q)
}

#[test]
fn degenerate_mechanisms_are_drawn() {
    for (n, length) in [(1, 1.0), (3, 0.0), (5, 1e-9), (5, 1e12), (2, 1e59)] {
        let (m, q) = chain(n, length);
        let svg = mechanism(&m, 0.0, &q, Marking::Plain).expect("draws");
        assert!(
            texts(&svg).contains(&"chain <&>".to_owned()),
            "{n} × {length}"
        );
        let width: f64 = attribute(&svg, "width").parse().expect("a number");
        let height: f64 = attribute(&svg, "height").parse().expect("a number");
        assert!(
            width < 2000.0 && height < 2000.0,
            "{n} × {length}: {height}"
        );
    }
}

#[test]
fn hostile_names_are_escaped() {
    let (m, q) = chain(2, 1.0);
    let svg = mechanism(&m, 0.0, &q, Marking::Plain).expect("draws");
    let texts = texts(&svg);
    assert!(texts.contains(&"<b>&\"0'\u{fffd}".to_owned()), "{texts:?}");
    assert!(texts.contains(&"]]>1 (revolute)".to_owned()));
}

#[test]
fn many_bodies_have_tool_tips_only() {
    let (m, q) = chain(400, 0.1);
    let svg = mechanism(&m, 0.0, &q, Marking::Plain).expect("draws");
    assert!(texts(&svg).contains(&"]]>399 (revolute)".to_owned()));
    assert!(!svg.contains("<text class=\"name"));
}

fn series<'a>(label: &'a str, t: &'a [f64], y: &'a [f64]) -> Series<'a> {
    Series {
        label,
        t,
        y,
        style: Style::default(),
    }
}

#[test]
fn gaps_split_curves() {
    let t = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let y = [0.0, 1.0, f64::NAN, 1.0, f64::INFINITY, 0.5, 0.25];
    let svg = history("force", "N", &[series("", &t, &y)]);
    assert_eq!(svg.matches("<polyline").count(), 2);
    assert_eq!(svg.matches("<circle").count(), 1, "a value alone is a dot");
    let texts = texts(&svg);
    assert!(texts.contains(&"force".to_owned()) && texts.contains(&"(N)".to_owned()));
    assert!(texts.contains(&"t (s)".to_owned()));
}

#[test]
fn one_legend_stands_for_panels_with_the_same_curves() {
    let (t, y) = ([0.0, 1.0], [0.0, 1.0]);
    let curves = [series("a", &t, &y), series("b & c", &t, &y)];
    let panel = |title| Panel {
        title,
        unit: "m",
        series: &curves,
    };
    let svg = histories(&[panel("x"), panel("y"), panel("z")], 2);
    let count = |text: &str| texts(&svg).iter().filter(|t| *t == text).count();
    assert_eq!((count("b & c"), count("z")), (1, 1));
    let other = [series("a", &t, &y)];
    let last = Panel {
        series: &other,
        ..panel("z")
    };
    let svg = histories(&[panel("x"), last], 2);
    assert_eq!(texts(&svg).iter().filter(|t| *t == "a").count(), 2);
}

#[test]
fn degenerate_histories_are_drawn() {
    let all: [(&[f64], &[f64]); 7] = [
        (&[], &[]),
        (&[0.0], &[1.0]),
        (&[0.0, 1.0], &[5.0, 5.0]),
        (&[0.0, 1.0], &[f64::NAN, f64::NAN]),
        (&[0.0, 1.0], &[-1e300, 1e300]),
        (&[0.0, 1.0, 2.0], &[f64::MAX, 1e-320]),
        (&[f64::NAN, 1.0], &[0.0, 0.0]),
    ];
    for (t, y) in all {
        texts(&history("x", "", &[series("curve", t, y)]));
        let path = Path {
            label: "p".into(),
            x: t.to_vec(),
            y: y.to_vec(),
            style: Style::nth(3),
        };
        texts(&paths("plane", &[path]));
    }
    assert!(texts(&histories(&[], 3)).is_empty());
    assert!(texts(&history("x", "m", &[])).contains(&"no data".to_owned()));
    assert!(texts(&paths("plane", &[])).contains(&"no data".to_owned()));
}

#[test]
fn both_axes_of_the_plane_have_one_scale() {
    // A circle must be as wide as it is high on the page.
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / 72.0;
    let circle = Path {
        label: "circle".into(),
        x: (0..=72).map(|k| 3.0 + angle(k).cos()).collect(),
        y: (0..=72).map(|k| angle(k).sin() - 8.0).collect(),
        style: Style::default(),
    };
    let svg = paths("plane", &[circle]);
    let line = svg
        .lines()
        .filter(|l| l.starts_with("<polyline"))
        .max_by_key(|l| l.len())
        .expect("a curve");
    let points: Vec<[f64; 2]> = attribute(line, "points")
        .split(' ')
        .map(|p| {
            let (x, y) = p.split_once(',').expect("x,y");
            [x, y].map(|v| v.parse().expect("a number"))
        })
        .collect();
    let extent = |k: usize| {
        let values = points.iter().map(|p| p[k]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    // Positions are written in hundredths of a pixel.
    assert!(
        (extent(0) - extent(1)).abs() < 0.03,
        "{} {}",
        extent(0),
        extent(1)
    );
    assert!(extent(0) > 300.0);
}

#[test]
fn the_recorder_follows_centres_and_contacts() {
    let (robot, q) = the_robot();
    let mut recorder = PathRecorder::new(&robot, &[0]).expect("a body");
    recorder.record(0.0, &q).expect("a configuration");
    let found: Vec<(String, f64, f64)> = recorder
        .finish()
        .into_iter()
        .map(|p| (p.label, p.x[0], p.y[0]))
        .collect();
    let expected = [
        ("platform", 0.0, 0.0),
        ("W1", 0.3, 0.0),
        ("W2", -0.3, 0.0),
        ("W3", 0.0, -0.2),
        ("W4", 0.0, 0.2),
        ("W5", -0.8, 0.0),
    ];
    assert_eq!(found.len(), expected.len());
    for ((name, x, y), (label, x_0, y_0)) in found.iter().zip(expected) {
        assert_eq!(name, label);
        assert!((x - x_0).abs() < 1e-15 && (y - y_0).abs() < 1e-15, "{name}");
    }
}
