//! The figures of the book that the program draws, from the scenes in its text and from the
//! reports.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path as File;

use pfaff::dynamics::MotionOptions;
use pfaff::model::{Mechanism, Reaction, Registry, System};
use pfaff::report::figures::{self, Labels, Marking};
use pfaff::report::figures::{Path, PathRecorder, Pattern, Style, histories, paths};
use pfaff::report::work_precision::{
    CurveName, ReferenceDocument, WorkPrecisionRow, WorkPrecisionScene,
};
use pfaff::report::{Panel, Series};
use pfaff::solvability::analyse;
use pfaff::{RunOptions, Study};

type Fallible<T> = Result<T, Box<dyn Error>>;

const ROBOT: &str = "crates/robot-trolley/robot-trolley.toml";

/// Name and text of every figure.
pub(crate) fn all(root: &File) -> Fallible<Vec<(&'static str, String)>> {
    let page = |chapter: &str, name: &str| scene_of_page(root, chapter, name);
    let robot = std::fs::read_to_string(root.join(ROBOT))?;
    Ok(vec![
        ("robot.svg", with_rows(&robot)?),
        ("cart.svg", cart(&page("getting-started.md", "cart.toml")?)?),
        ("door.svg", door()),
        ("beam.svg", beam()),
        (
            "three-cranks.svg",
            leaning(&page("uniqueness.md", "three-cranks.toml")?, 0.2)?,
        ),
        ("reaction-band.svg", reactions(&robot)?),
        (
            "work-precision.svg",
            work_precision(&std::fs::read_to_string(
                root.join("docs/reports/work-precision/work_precision.csv"),
            )?)?,
        ),
        (
            "tipper.svg",
            viewed(&page("from-a-drawing.md", "tipper.toml")?)?,
        ),
        (
            "four-hinges.svg",
            viewed(&page("space.md", "four-hinges.toml")?)?,
        ),
        ("gate.svg", viewed(&page("space.md", "gate.toml")?)?),
        ("planets.svg", viewed(&page("gears.md", "planets.toml")?)?),
        (
            "differential.svg",
            viewed(&page("gears.md", "differential.toml")?)?,
        ),
    ])
}

/// The block of a chapter that begins with the name of its file.
fn scene_of_page(root: &File, chapter: &str, name: &str) -> Fallible<String> {
    let text = std::fs::read_to_string(root.join("docs/book").join(chapter))?;
    let head = format!("# {name}\n");
    let found = text
        .split("```")
        .find(|block| block.starts_with("toml") && block.contains(&head));
    let block = found.ok_or_else(|| format!("{chapter} has no {name}"))?;
    let (_, scene) = block
        .split_once('\n')
        .ok_or("a block begins with its kind")?;
    Ok(scene.to_owned())
}

fn read(text: &str, overrides: &RunOptions) -> Fallible<Study> {
    Ok(Study::read(
        "scene.toml",
        text,
        &Registry::standard(),
        overrides,
    )?)
}

/// Draws a mechanism at its start, with joints marked by verdict and labelled with their rows.
fn with_rows(text: &str) -> Fallible<String> {
    let study = read(text, &RunOptions::default())?;
    let described = study.scene.description.plane();
    let mut described = described.ok_or("a scene of the plane")?.clone();
    let rows: Vec<String> = study
        .prepared
        .mechanism
        .layout()
        .groups
        .iter()
        .map(|g| format!("{} ({})", g.name, g.rows))
        .collect();
    let named = |name: &str| {
        let found = rows
            .iter()
            .find(|r| r.split_once(" (").is_some_and(|(n, _)| n == name));
        found.cloned().unwrap_or_else(|| name.to_owned())
    };
    for joint in &mut described.joints {
        joint.name = named(&joint.name);
    }
    for drive in &mut described.drives {
        drive.name = named(&drive.name);
    }
    let mechanism = Mechanism::build(&described).map_err(|e| format!("{e:?}"))?;
    let q = &study.prepared.q;
    let analysis = analyse(&mechanism, 0.0, q)?;
    Ok(figures::mechanism(
        &mechanism,
        0.0,
        q,
        Marking::Verdicts(&analysis.reactions),
    )?)
}

/// Draws a mechanism at a time of its motion, marked by verdict.
fn leaning(text: &str, t: f64) -> Fallible<String> {
    let study = read(text, &RunOptions::default())?;
    let configuration = study.analyse(t, None)?;
    Ok(figures::mechanism(
        configuration.mechanism,
        t,
        &configuration.state.q,
        Marking::Verdicts(&configuration.analysis.reactions),
    )?)
}

/// Draws a mechanism at its start, as `pfaff view` does.
fn viewed(text: &str) -> Fallible<String> {
    let study = read(text, &RunOptions::default())?;
    let start = study.analyse(0.0, None)?;
    Ok(figures::labelled_mechanism(
        start.mechanism,
        0.0,
        &start.state.q,
        Marking::Verdicts(&start.analysis.reactions),
        Labels::NamesAndRows,
    )?)
}

fn cart(text: &str) -> Fallible<String> {
    let study = read(text, &RunOptions::default())?;
    let mut recorder = PathRecorder::new(&study.prepared.mechanism, &[0])?;
    let options = MotionOptions {
        output_step: 0.05,
        ..study.options.clone().ok_or("the cart runs")?
    };
    study
        .run(&options, |sample| {
            // If a row cannot be drawn, the figure differs from its file, and the test fails.
            let drawn = recorder.record(sample.t, sample.q);
            Ok(match drawn {
                Ok(()) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            })
        })
        .map_err(|failure| failure.error)?;
    Ok(paths(
        "Path of the cart and of its wheels",
        &recorder.finish(),
    ))
}

fn door() -> String {
    let leaf = outline("leaf", &[[0.0, 0.0], [0.8, 0.0], [0.8, 2.0], [0.0, 2.0]]);
    // The wall makes the figure wide enough for its title.
    let mut wall = outline(
        "wall",
        &[[-1.0, -0.5], [-0.1, -0.5], [-0.1, 2.5], [-1.0, 2.5]],
    );
    wall.style.pattern = Pattern::Dashed;
    paths(
        "Forces on the leaf that cancel",
        &[
            leaf,
            wall,
            arrow("upper: 1", [0.0, 1.8], [0.0, 2.4], 1),
            arrow("lower: −1", [0.0, 0.2], [0.0, -0.4], 2),
        ],
    )
}

fn beam() -> String {
    let [low, high] = [-0.1, 0.1];
    let beam = outline(
        "beam",
        &[[-2.2, low], [2.2, low], [2.2, high], [-2.2, high]],
    );
    paths(
        "Forces on the beam that cancel",
        &[
            beam,
            arrow("left: 0.5", [-2.0, low], [-2.0, 0.6], 1),
            arrow("middle: −1", [0.0, high], [0.0, -1.3], 2),
            arrow("right: 0.5", [2.0, low], [2.0, 0.6], 3),
        ],
    )
}

fn outline(label: &str, corners: &[[f64; 2]]) -> Path {
    let closed = || corners.iter().chain(&corners[..1]);
    Path {
        label: label.to_owned(),
        x: closed().map(|c| c[0]).collect(),
        y: closed().map(|c| c[1]).collect(),
        style: Style {
            colour: 6,
            ..Style::default()
        },
    }
}

/// An arrow whose line begins at `from`, with its tip at the end.
fn arrow(label: &str, from: [f64; 2], to: [f64; 2], colour: usize) -> Path {
    const BARB: f64 = 0.08;
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let length = dx.hypot(dy);
    let [ux, uy] = [BARB * dx / length, BARB * dy / length];
    let barb = |side: f64| [to[0] - 2.0 * ux - side * uy, to[1] - 2.0 * uy + side * ux];
    let points = [from, to, barb(1.0), to, barb(-1.0), to];
    Path {
        label: label.to_owned(),
        x: points.iter().map(|p| p[0]).collect(),
        y: points.iter().map(|p| p[1]).collect(),
        style: Style {
            colour,
            ..Style::default()
        },
    }
}

/// Pairs of rows that are eliminated, from 1.
const DROPPED: [[usize; 2]; 4] = [[6, 21], [18, 21], [19, 21], [20, 21]];

/// The component of a reaction that is shown.
type Component = fn(&Reaction) -> f64;

/// Reactions of the robot for several choices: those that are not unique on the left, unique ones
/// on the right.
fn reactions(text: &str) -> Fallible<String> {
    let shown: [(&str, &str, Component); 6] = [
        ("W3.N, not unique", "W3", |r| {
            r.component.unwrap_or(f64::NAN)
        }),
        ("W5.N, unique", "W5", |r| r.component.unwrap_or(f64::NAN)),
        ("W1.N, not unique", "W1", |r| {
            r.component.unwrap_or(f64::NAN)
        }),
        ("A.Fy, unique", "A", |r| r.force[1]),
        ("B.Fy, not unique", "B", |r| r.force[1]),
        ("D.Fy, unique", "D", |r| r.force[1]),
    ];
    let mut times = Vec::new();
    // By component, by choice, by time.
    let mut values = vec![vec![Vec::new(); DROPPED.len()]; shown.len()];
    for (choice, dropped) in DROPPED.iter().enumerate() {
        let overrides = RunOptions {
            drop: Some(dropped.map(|row| row - 1).to_vec()),
            ..RunOptions::default()
        };
        let study = read(text, &overrides)?;
        let groups = &study.prepared.mechanism.layout().groups;
        let at = shown.map(|(_, joint, _)| groups.iter().position(|g| g.name == joint));
        let options = study.options.clone().ok_or("the robot runs")?;
        times.clear();
        study
            .run(&options, |sample| {
                times.push(sample.t);
                let found = sample.reactions()?.as_chosen().to_vec();
                for (k, (_, _, component)) in shown.iter().enumerate() {
                    let value = at[k].map_or(f64::NAN, |g| component(&found[g]));
                    values[k][choice].push(value);
                }
                Ok(ControlFlow::Continue(()))
            })
            .map_err(|failure| failure.error)?;
    }
    let labels = DROPPED.map(|[a, b]| format!("without rows {a} and {b}"));
    let series: Vec<Vec<Series<'_>>> = values
        .iter()
        .map(|choices| {
            let curves = choices.iter().zip(&labels).enumerate();
            curves
                .map(|(k, (y, label))| Series {
                    label,
                    t: &times,
                    y,
                    style: Style::nth(k),
                })
                .collect()
        })
        .collect();
    let panels: Vec<Panel<'_>> = shown
        .iter()
        .zip(&series)
        .map(|((title, _, _), series)| Panel {
            title,
            unit: "N",
            series,
        })
        .collect();
    Ok(histories(&panels, 2))
}

/// The scene of the report on error versus run time that is shown.
const SHOWN: &str = "robot-trolley";

/// Draws the part of the figure of the report that belongs to the robot.
fn work_precision(csv: &str) -> Fallible<String> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next().ok_or("an empty table")?.split(',').collect();
    let mut rows = Vec::new();
    for line in lines.filter(|line| line.split(',').next() == Some(SHOWN)) {
        let cells: Vec<&str> = line.split(',').collect();
        let text = |column: &str| -> Fallible<&str> {
            let place = head.iter().position(|c| *c == column);
            let cell = place.and_then(|k| cells.get(k));
            Ok(cell.ok_or_else(|| format!("no column {column}"))?)
        };
        let number = |column: &str| -> Fallible<f64> { Ok(text(column)?.parse()?) };
        let count = |column: &str| -> Fallible<u64> { Ok(text(column)?.parse()?) };
        rows.push(WorkPrecisionRow {
            scene: SHOWN.to_owned(),
            curve: CurveName {
                formulation: known(text("formulation")?)?,
                method: known(text("method")?)?,
                stabilisation: known(text("stabilisation")?)?,
            },
            tolerance: number("tolerance")?,
            errors: [
                number("error_position")?,
                number("error_velocity")?,
                number("error_acceleration")?,
                number("error_reaction")?,
            ],
            constraint_residual: number("constraint_residual")?,
            evaluations: count("evaluations")?,
            projections: count("projections")?,
            factorisations: count("factorisations")?,
            steps: count("steps")?,
            seconds: number("seconds")?,
            status: text("status")?.to_owned(),
            rejected: count("rejected")?,
            repetitions: text("repetitions")?.parse()?,
            energy_error: number("energy_error")?,
            error_state: number("error_state")?,
            reference_limit: number("reference_limit")?,
        });
    }
    let limit = rows.first().map_or(f64::NAN, |row| row.reference_limit);
    let scene = WorkPrecisionScene {
        name: SHOWN.to_owned(),
        title: "Robot with trolley, two redundant rows".to_owned(),
        automatic: "dop853",
        reference: ReferenceDocument {
            source: String::new(),
            limits: [limit; 4],
            agreement: String::new(),
        },
        summary: Vec::new(),
        ranking: Vec::new(),
        rows,
    };
    Ok(figures::work_precision(&[scene]))
}

/// Returns the names that may occur in a row of the report: those of pfaff, and of the reference
/// methods of the laboratory.
fn known(name: &str) -> Fallible<&'static str> {
    use pfaff::dynamics::{Method, Stabilisation};
    const OTHERS: [&str; 8] = [
        "kept-rows",
        "null-space",
        "minimum-norm",
        "proximal",
        "baumgarte",
        "gbs",
        "generalized-alpha",
        "hem4",
    ];
    let methods = Method::ALL.iter().map(|m| m.name());
    let stabilisations = Stabilisation::ALL.iter().map(|s| s.name());
    let mut all = methods.chain(stabilisations).chain(OTHERS);
    Ok(all
        .find(|n| *n == name)
        .ok_or_else(|| format!("no method or formulation is called {name}"))?)
}
