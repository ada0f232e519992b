//! Curves other than reactions: joint coordinates, drives, energies and residuals.

use model::{Load, Mechanism, System};
use serde::Serialize;

use super::run_page::{DriveCurve, RunPage};
use report::channel::Channel;
use report::{Frame, load_columns, load_numbers};

/// Largest number of joint coordinates that are plotted.
pub(super) const MEASURES_MAX: usize = 24;

/// Largest number of drives that are plotted.
pub(super) const DRIVES_MAX: usize = 12;

/// Largest number of force elements that are plotted.
pub(super) const LOADS_MAX: usize = 12;

/// Curves other than reactions.
#[derive(Serialize)]
pub(super) struct Curves {
    charts: Vec<Chart>,
    energy: Energy,
    residuals: Residuals,
}

/// Curves of one unit in a frame.
#[derive(Serialize)]
struct Chart {
    /// Identifier of the element of the page that contains the chart.
    place: &'static str,
    title: String,
    unit: &'static str,
    /// Each curve with its label.
    curves: Vec<(String, Channel)>,
}

#[derive(Serialize)]
struct Energy {
    kinetic: Channel,
    potential: Channel,
    work: Channel,
    /// log₁₀ of |E − E₀ − work| relative to the largest kinetic energy.
    gap: Channel,
}

#[derive(Serialize)]
struct Residuals {
    /// log₁₀ of the largest |Φ|.
    position: Channel,
    /// log₁₀ of the largest |C·v − b|.
    velocity: Channel,
}

impl Curves {
    /// Returns the curves of a page.
    pub(super) fn of(page: &RunPage<'_>) -> Self {
        let measured = EnergyCurves::of(page.mechanism, &page.recording.frames);
        let drives = page.drives.iter().take(DRIVES_MAX).map(drive);
        let charts = measures(page).chain(loads(page)).chain(drives);
        Self {
            charts: charts.collect(),
            energy: measured.energy(),
            residuals: Residuals {
                position: logarithmic(measured.position.iter().copied()),
                velocity: logarithmic(measured.velocity.iter().copied()),
            },
        }
    }
}

/// Returns the joint coordinates at the frames.
fn measures<'p>(page: &'p RunPage<'_>) -> impl Iterator<Item = Chart> + 'p {
    let (mechanism, frames) = (page.mechanism, &page.recording.frames);
    let observed = mechanism.frames().observed();
    let name = |of: Option<usize>| of.map_or("ground", |k| observed.markers[k].name.as_str());
    let measures = observed.measures.iter().take(MEASURES_MAX).enumerate();
    measures.map(move |(k, measure)| {
        let [first, second] = measure.between.map(name);
        let values = frames.iter();
        let values = values.map(|f| mechanism.frames().measure(k, &f.q, &f.v));
        let kind = measure.kind.name();
        Chart {
            place: "measure-curves",
            title: format!("{}: {kind} of {second} from {first}", measure.name),
            unit: measure.kind.unit(),
            curves: vec![(measure.name.clone(), Channel::new(values))],
        }
    })
}

/// Returns the loads of force elements at the frames, one chart for each unit of an element.
/// Components that are always zero are left out.
fn loads<'p>(page: &'p RunPage<'_>) -> impl Iterator<Item = Chart> + 'p {
    let (mechanism, frames) = (page.mechanism, &page.recording.frames);
    let (space, mut loads) = (mechanism.space(), mechanism.loads());
    let layout = mechanism.layout();
    let rows: Vec<Vec<Load>> = frames
        .iter()
        .map(|f| loads.at(layout.before_break(f.t), &f.q, &f.v))
        .collect();
    let forces = loads.forces().take(LOADS_MAX).enumerate();
    forces.flat_map(move |(k, (name, measure))| {
        let mut charts: Vec<Chart> = Vec::new();
        for (at, column) in load_columns(space, name, measure).enumerate() {
            let number = |row: &Vec<Load>| load_numbers(space, &row[k]).nth(at);
            let values = rows.iter().map(|row| number(row).unwrap_or(f64::NAN));
            let values: Vec<f64> = values.collect();
            if values.iter().all(|value| *value == 0.0) {
                continue;
            }
            let curve = (column.number.to_owned(), Channel::new(values.into_iter()));
            match charts.last_mut() {
                Some(chart) if chart.unit == column.unit => chart.curves.push(curve),
                _ => charts.push(Chart {
                    place: "load-curves",
                    title: name.to_owned(),
                    unit: column.unit,
                    curves: vec![curve],
                }),
            }
        }
        charts
    })
}

fn drive(curve: &DriveCurve) -> Chart {
    Chart {
        place: "drive-curves",
        title: format!("{}: {}", curve.name, curve.text),
        unit: curve.unit,
        curves: vec![(
            curve.name.clone(),
            Channel::new(curve.values.iter().copied()),
        )],
    }
}

/// Energies and residuals at the frames.
struct EnergyCurves {
    kinetic: Vec<f64>,
    potential: Vec<f64>,
    work: Vec<f64>,
    position: Vec<f64>,
    velocity: Vec<f64>,
}

impl EnergyCurves {
    fn of(mechanism: &Mechanism, frames: &[Frame]) -> Self {
        let mut measured = Self {
            kinetic: frames
                .iter()
                .map(|f| mechanism.kinetic_energy(&f.v))
                .collect(),
            potential: frames
                .iter()
                .map(|f| mechanism.potential_energy(&f.q))
                .collect(),
            work: frames.iter().map(|f| f.work).collect(),
            position: Vec::with_capacity(frames.len()),
            velocity: Vec::with_capacity(frames.len()),
        };
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        for frame in frames {
            mechanism.pose(layout.before_break(frame.t), &frame.q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            mechanism.b(&mut s);
            let rows = 0..layout.rows();
            let residuals = rows.map(|i| layout.velocity_residual(&s, i, &frame.v));
            measured.velocity.push(largest(residuals));
            measured.position.push(largest(s.phi.iter().copied()));
        }
        measured
    }

    fn energy(&self) -> Energy {
        let largest_kinetic = largest(self.kinetic.iter().copied());
        let total = |k: usize| self.kinetic[k] + self.potential[k] - self.work[k];
        let gap = (0..self.work.len()).map(|k| (total(k) - total(0)) / largest_kinetic);
        Energy {
            kinetic: Channel::new(self.kinetic.iter().copied()),
            potential: Channel::new(self.potential.iter().copied()),
            work: Channel::new(self.work.iter().copied()),
            gap: logarithmic(gap),
        }
    }
}

/// Returns log₁₀ of absolute values; a zero value becomes a gap.
fn logarithmic(values: impl Iterator<Item = f64> + Clone) -> Channel {
    Channel::new(values.map(|x| x.abs().log10()))
}

/// Returns the largest absolute value; zero if there are no values.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, x| if x.abs() > a { x.abs() } else { a })
}
