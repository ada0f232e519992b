//! The figures of the paper for these dimensions.

use std::path::PathBuf;

use pfaff::model::{Mechanism, Reaction, System};
use pfaff::report::figures::{self, Marking, PathRecorder, Style};
use pfaff::report::{OutputDirectory, Panel, Series};
use pfaff::solvability::Analysis;

use crate::variants::Variant;

type Written = Result<Vec<PathBuf>, Box<dyn std::error::Error>>;

/// One component of a reaction.
type Component = fn(&Reaction) -> f64;

/// Writes all figures.
pub(crate) fn write(
    mechanism: &Mechanism,
    start: &Analysis,
    variants: &[Variant],
    directory: &OutputDirectory,
) -> Written {
    let instants = &variants[0].rows;
    let q = &instants[0].q;
    let drawing = figures::mechanism(mechanism, 0.0, q, Marking::Verdicts(&start.reactions))?;

    let platform = 0;
    let mut recorder = PathRecorder::new(mechanism, &[platform])?;
    for instant in instants {
        recorder.record(instant.t, &instant.q)?;
    }
    let paths = figures::paths("Platform centre and contact points", &recorder.finish());

    let non_unique: [(&str, &str, Component); 3] = [
        ("B x, not unique", "B", |r| r.force[0]),
        ("B y, not unique", "B", |r| r.force[1]),
        ("W3 normal, not unique", "W3", |r| {
            r.component.unwrap_or(f64::NAN)
        }),
    ];
    let unique: [(&str, &str, Component); 3] = [
        ("D x, unique", "D", |r| r.force[0]),
        ("D y, unique", "D", |r| r.force[1]),
        ("W5 normal, unique", "W5", |r| {
            r.component.unwrap_or(f64::NAN)
        }),
    ];
    // Two columns: reactions that differ on the left, reactions that agree on the right.
    let pairs = non_unique.into_iter().zip(unique).flat_map(|(a, b)| [a, b]);
    Ok(vec![
        directory.write("mechanism.svg", drawing.as_bytes())?,
        directory.write("drive.svg", drive(mechanism, variants).as_bytes())?,
        directory.write("trajectories.svg", paths.as_bytes())?,
        directory.write(
            "reactions.svg",
            reactions(mechanism, variants, pairs).as_bytes(),
        )?,
    ])
}

/// The displacement of the slider along the platform's y-axis.
fn drive(mechanism: &Mechanism, variants: &[Variant]) -> String {
    let place = |name: &str| {
        mechanism
            .bodies()
            .iter()
            .position(|b| b.name == name)
            .unwrap_or(0)
    };
    let (platform, slider) = (3 * place("platform"), 3 * place("slider"));
    let instants = &variants[0].rows;
    let t: Vec<f64> = instants.iter().map(|r| r.t).collect();
    let along = |q: &[f64]| {
        let (sin, cos) = q[platform + 2].sin_cos();
        cos * (q[slider + 1] - q[platform + 1]) - sin * (q[slider] - q[platform])
    };
    let start = along(&instants[0].q);
    let y: Vec<f64> = instants.iter().map(|r| along(&r.q) - start).collect();
    let series = Series {
        label: "d(t)",
        t: &t,
        y: &y,
        style: Style::nth(0),
    };
    figures::history("Displacement of the slider in joint H", "m", &[series])
}

fn reactions<'a>(
    mechanism: &Mechanism,
    variants: &[Variant],
    wanted: impl Iterator<Item = (&'a str, &'a str, Component)>,
) -> String {
    let groups = &mechanism.layout().groups;
    let t: Vec<f64> = variants[0].rows.iter().map(|r| r.t).collect();
    let labels: Vec<String> = variants
        .iter()
        .map(|v| format!("without rows {} and {}", v.deleted[0], v.deleted[1]))
        .collect();
    let curves: Vec<(&str, Vec<Vec<f64>>)> = wanted
        .map(|(title, joint, component)| {
            let at = groups.iter().position(|g| g.name == joint).unwrap_or(0);
            let values = variants
                .iter()
                .map(|v| v.rows.iter().map(|r| component(&r.reactions[at])).collect())
                .collect();
            (title, values)
        })
        .collect();
    let series: Vec<Vec<Series<'_>>> = curves
        .iter()
        .map(|(_, values)| {
            let curves = values.iter().zip(&labels).enumerate();
            curves
                .map(|(k, (y, label))| Series {
                    label,
                    t: &t,
                    y,
                    style: Style::nth(k),
                })
                .collect()
        })
        .collect();
    let panels: Vec<Panel<'_>> = curves
        .iter()
        .zip(&series)
        .map(|((title, _), series)| Panel {
            title,
            unit: "N",
            series,
        })
        .collect();
    figures::histories(&panels, 2)
}
