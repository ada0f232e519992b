//! Curves other than the reactions of single joints: sums of reactions, requested plots, joint
//! coordinates, drives, energies and residuals. Also the determined curves of a page for print.

use model::{ConstraintId, Load, Mechanism, System};
use serde::Serialize;

use super::cast::Cast;
use super::run_page::{DriveCurve, Plot, RunPage};
use super::values::{self, largest};
use report::channel::Channel;
use report::{Frame, load_columns, load_numbers};

/// Largest number of joint coordinates that are plotted.
pub(super) const MEASURES_MAX: usize = 24;

/// Largest number of drives that are plotted.
pub(super) const DRIVES_MAX: usize = 12;

/// Largest number of force elements that are plotted.
pub(super) const LOADS_MAX: usize = 12;

/// Largest number of plots in a page for print: about two sheets of paper.
pub(super) const PRINTED_MAX: usize = 16;

/// Curves other than reactions.
#[derive(Serialize)]
pub(super) struct Curves {
    pub(super) charts: Vec<Chart>,
    /// Number of plots that a page for print omits.
    #[serde(skip)]
    pub(super) omitted: usize,
    energy: Energy,
    residuals: Residuals,
}

/// Curves of one unit in a frame.
#[derive(Serialize)]
pub(super) struct Chart {
    /// Identifier of the element of the page that contains the chart.
    pub(super) place: &'static str,
    title: String,
    unit: &'static str,
    /// Each curve with its label.
    curves: Vec<(String, Channel)>,
    /// Verdict on the only curve, if it is a reaction.
    #[serde(skip_serializing_if = "Option::is_none")]
    badge: Option<&'static str>,
    /// The smallest and the largest value, if the curve has bounds.
    #[serde(skip_serializing_if = "Option::is_none")]
    band: Option<[Channel; 2]>,
}

impl Chart {
    /// A chart without verdict and band.
    fn new(place: &'static str, title: String, unit: &'static str) -> Self {
        Self {
            place,
            title,
            unit,
            curves: Vec::new(),
            badge: None,
            band: None,
        }
    }

    /// Whether at least one value changes over the run.
    fn varies(&self) -> bool {
        self.curves.iter().any(|(_, curve)| varies(curve))
    }
}

/// Whether a value of a curve differs from the first value.
fn varies(curve: &Channel) -> bool {
    match curve {
        Channel::Constant(_) => false,
        Channel::Varying { d, .. } => d.0.iter().flatten().any(|step| *step != 0),
    }
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
    pub(super) fn of(page: &RunPage<'_>, cast: &Cast) -> Self {
        let measured = EnergyCurves::of(page.mechanism, &page.recording.frames);
        let mut charts: Vec<Chart> = if page.is_for_customer() {
            printed(page, cast)
        } else {
            let drives = page.drives.iter().take(DRIVES_MAX).map(drive);
            let groups = page.groups.iter().filter_map(|plot| group(page, plot));
            let own = groups.chain(plots(page, PLOTS)).chain(measures(page));
            own.chain(loads(page)).chain(drives).collect()
        };
        let is_selected = !page.is_for_customer() || !page.plots.is_empty();
        let most = if is_selected {
            charts.len()
        } else {
            PRINTED_MAX
        };
        let omitted = charts.len().saturating_sub(most);
        charts.truncate(charts.len() - omitted);
        Self {
            charts,
            omitted,
            energy: measured.energy(),
            residuals: Residuals {
                position: logarithmic(measured.position.iter().copied()),
                velocity: logarithmic(measured.velocity.iter().copied()),
            },
        }
    }
}

/// Identifiers of elements of the page that contain charts.
pub(super) const GROUPS: &str = "group-curves";
pub(super) const PLOTS: &str = "plot-curves";
pub(super) const PRINTED: &str = "printed-curves";

/// Returns the curves of a page for print. These are the requested plots. If no plots are
/// requested, they are sums of reactions, determined reactions, measures and loads that change
/// during the run.
fn printed(page: &RunPage<'_>, cast: &Cast) -> Vec<Chart> {
    if !page.plots.is_empty() {
        return plots(page, PRINTED).collect();
    }
    let groups = page.groups.iter();
    let groups = groups.filter(|plot| plot.curves.iter().any(|curve| !curve.is_empty()));
    let groups = groups.filter_map(|plot| group(page, plot));
    let reactions = cast.joints().iter();
    let reactions = reactions.flat_map(|&k| reaction(page, ConstraintId(k)));
    let all = groups.chain(reactions);
    let all = all.chain(measures(page)).chain(loads(page));
    let all = all.filter(Chart::varies).map(|chart| Chart {
        place: PRINTED,
        ..chart
    });
    all.collect()
}

/// Returns the determined components of a reaction, with one chart for each unit. If the component
/// that the definition names is determined throughout, the chart contains only this component.
fn reaction(page: &RunPage<'_>, id: ConstraintId) -> Vec<Chart> {
    let group = &page.mechanism.layout().groups[id.0];
    let noise = values::noise(&page.recording.frames);
    let own = page.stretches.and_then(|s| s.reactions.get(id.0));
    let Some(own) = own else {
        return Vec::new();
    };
    let is_unique = |name: &&str| own.component(name).is_some_and(|c| c.of_run().is_unique());
    let named = group.spec.component.filter(is_unique);
    let names = match &named {
        Some(named) => std::slice::from_ref(named),
        None => group.space.components(),
    };
    let mut charts: Vec<Chart> = Vec::new();
    for name in names {
        let Some(track) = own.component(name) else {
            continue;
        };
        let values = values::determined(page, id, name);
        let channel = Channel::above(noise, values.into_iter());
        if !varies(&channel) {
            continue;
        }
        let label = labelled(name, track.of_run().word(), true);
        let unit = page.mechanism.layout().load_unit(id, name);
        match charts.last_mut() {
            Some(chart) if chart.unit == unit => chart.curves.push((label, channel)),
            _ => {
                let mut chart = Chart::new(PRINTED, group.name.clone(), unit);
                chart.curves.push((label, channel));
                charts.push(chart);
            }
        }
    }
    charts
}

/// Returns the name of a curve with its verdict, if it has gaps.
fn labelled(name: &str, verdict: &str, has_values: bool) -> String {
    match (verdict, has_values) {
        ("unique", _) => name.to_owned(),
        (_, true) => format!("{name} (determined values only)"),
        (_, false) => format!("{name} (not determined by the model)"),
    }
}

/// Size of a value that counts as rounding.
fn noise_of(page: &RunPage<'_>, unit: &str) -> f64 {
    match unit {
        "N" | "N·m" => values::noise(&page.recording.frames),
        _ => 0.0,
    }
}

/// Returns the chart of a sum of reactions. Returns `None` if there is nothing to draw.
fn group(page: &RunPage<'_>, plot: &Plot) -> Option<Chart> {
    let curve = plot.curves.first()?;
    if curve.verdict != "unique" && curve.is_empty() && curve.band.is_none() {
        return None;
    }
    let noise = noise_of(page, plot.unit);
    let end = |k: usize| {
        let ends = curve.band.iter().flatten().map(move |ends| ends[k]);
        Channel::above(noise, ends)
    };
    let values = Channel::above(noise, curve.values.iter().copied());
    let label = labelled(&curve.name, curve.verdict, true);
    let drawn = (!curve.is_empty()).then_some((label, values));
    Some(Chart {
        curves: drawn.into_iter().collect(),
        badge: Some(curve.verdict),
        band: curve.band.as_ref().map(|_| [end(0), end(1)]),
        ..Chart::new(GROUPS, plot.title.clone(), plot.unit)
    })
}

/// Returns the requested plots.
fn plots<'p>(page: &'p RunPage<'_>, place: &'static str) -> impl Iterator<Item = Chart> + 'p {
    page.plots.iter().map(move |plot| {
        let noise = noise_of(page, plot.unit);
        let curves = plot.curves.iter().map(|curve| {
            let label = labelled(&curve.name, curve.verdict, !curve.is_empty());
            (label, Channel::above(noise, curve.values.iter().copied()))
        });
        Chart {
            curves: curves.collect(),
            ..Chart::new(place, plot.title.clone(), plot.unit)
        }
    })
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
        let title = format!("{}: {kind} of {second} from {first}", measure.name);
        Chart {
            curves: vec![(measure.name.clone(), Channel::new(values))],
            ..Chart::new("measure-curves", title, measure.kind.unit())
        }
    })
}

/// Returns the loads of force elements at the frames, with one chart for each unit of an element.
/// Components that are always zero are omitted.
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
            let noise = noise_of(page, column.unit);
            let values = rows.iter().map(|row| number(row).unwrap_or(f64::NAN));
            let values: Vec<f64> = values.collect();
            if values.iter().all(|value| value.abs() <= noise) {
                continue;
            }
            let values = Channel::above(noise, values.into_iter());
            let curve = (column.number.to_owned(), values);
            match charts.last_mut() {
                Some(chart) if chart.unit == column.unit => chart.curves.push(curve),
                _ => charts.push(Chart {
                    curves: vec![curve],
                    ..Chart::new("load-curves", name.to_owned(), column.unit)
                }),
            }
        }
        charts
    })
}

fn drive(curve: &DriveCurve) -> Chart {
    let title = format!("{}: {}", curve.name, curve.text);
    let values = Channel::new(curve.values.iter().copied());
    Chart {
        curves: vec![(curve.name.clone(), values)],
        ..Chart::new("drive-curves", title, curve.unit)
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
                .map(|f| mechanism.kinetic_energy(&f.q, &f.v))
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

/// Returns log₁₀ of absolute values. A zero value becomes a gap.
fn logarithmic(values: impl Iterator<Item = f64> + Clone) -> Channel {
    Channel::new(values.map(|x| x.abs().log10()))
}
