//! Curves other than reactions: joint coordinates, drives, energies and residuals.

use model::{Measure, Mechanism, System};
use serde::Serialize;

use super::run_page::{DriveCurve, RunPage};
use report::Frame;
use report::channel::Channel;

/// Largest number of joint coordinates that are plotted.
pub(super) const MEASURES_MAX: usize = 24;

/// Largest number of drives that are plotted.
pub(super) const DRIVES_MAX: usize = 12;

/// Curves other than reactions.
#[derive(Serialize)]
pub(super) struct Curves<'a> {
    measures: Vec<MeasureCurve<'a>>,
    drives: Vec<Drive<'a>>,
    energy: Energy,
    residuals: Residuals,
}

#[derive(Serialize)]
struct MeasureCurve<'a> {
    name: &'a str,
    text: String,
    unit: &'static str,
    value: Channel,
}

#[derive(Serialize)]
struct Drive<'a> {
    name: &'a str,
    text: &'a str,
    unit: &'static str,
    value: Channel,
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

impl<'a> Curves<'a> {
    /// Returns the curves of a page.
    pub(super) fn of(page: &'a RunPage<'a>) -> Self {
        let measured = EnergyCurves::of(page.mechanism, &page.recording.frames);
        Self {
            measures: measures(page),
            drives: page.drives.iter().take(DRIVES_MAX).map(drive).collect(),
            energy: measured.energy(),
            residuals: Residuals {
                position: logarithmic(measured.position.iter().copied()),
                velocity: logarithmic(measured.velocity.iter().copied()),
            },
        }
    }
}

/// Returns the joint coordinates at the frames.
fn measures<'a>(page: &RunPage<'a>) -> Vec<MeasureCurve<'a>> {
    let (mechanism, frames) = (page.mechanism, &page.recording.frames);
    let observed = mechanism.frames().observed();
    let name = |of: Option<usize>| of.map_or("ground", |k| observed.markers[k].name.as_str());
    let measures = observed.measures.iter().take(MEASURES_MAX).enumerate();
    let curve = |(k, measure): (usize, &'a Measure)| {
        let [first, second] = measure.between.map(name);
        MeasureCurve {
            name: &measure.name,
            text: format!("{} of {second} from {first}", measure.kind.name()),
            unit: measure.kind.unit(),
            value: Channel::new(
                frames
                    .iter()
                    .map(|f| mechanism.frames().measure(k, &f.q, &f.v)),
            ),
        }
    };
    measures.map(curve).collect()
}

fn drive(curve: &DriveCurve) -> Drive<'_> {
    Drive {
        name: &curve.name,
        text: &curve.text,
        unit: curve.unit,
        value: Channel::new(curve.values.iter().copied()),
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
            // Rows at a break time contain the values just before it.
            let breaks = layout
                .break_times
                .binary_search_by(|t| t.total_cmp(&frame.t));
            let t = if breaks.is_ok() && frame.t > 0.0 {
                frame.t.next_down()
            } else {
                frame.t
            };
            mechanism.pose(t, &frame.q, &mut s);
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
