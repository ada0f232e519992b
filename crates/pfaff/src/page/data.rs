//! The data of a page as one JSON document for the scripts, limited so that the page stays small.

use std::collections::BTreeMap;

use model::words::Prefix;
use model::{ConstraintId, Mechanism, SpaceKind, System};
use serde::Serialize;

use super::cast::{Cast, DRAWN_MAX};
use super::comparison::{Comparison, Freedom};
use super::curves::Curves;
use super::first_order::FirstOrder;
use super::run_page::RunPage;
use super::values::{determined, noise};
use crate::documents::{EventDocument, ReactionDocument};
use report::channel::Channel;
use report::figures::drawing::DrawingModel;

/// All data that the scripts need.
#[derive(Serialize)]
pub(super) struct Data<'a> {
    name: &'a str,
    /// Times of the frames (s).
    t: Vec<Time>,
    drawing: DrawingModel,
    /// Names and units of the components of a reaction.
    components: Vec<(&'static str, &'static str)>,
    joints: Vec<Joint<'a>>,
    #[serde(flatten)]
    pub(super) first_order: FirstOrder<'a>,
    comparisons: Vec<ComparisonData<'a>>,
    #[serde(flatten)]
    pub(super) curves: Curves,
    events: &'a [EventDocument],
    /// Units of the scene for the units of the curves, with the number of scene units in one SI
    /// unit.
    units: BTreeMap<&'static str, (String, f64)>,
    /// Prefixes of other units: the smallest number with the prefix, its symbol and its value.
    prefixes: Vec<(f64, &'static str, f64)>,
    /// Symbols of the units that may have a prefix.
    prefixed: [&'static str; 8],
}

/// A time that is written with ten digits.
struct Time(f64);

impl Serialize for Time {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rounded = format!("{:.9e}", self.0).parse().unwrap_or(self.0);
        serializer.serialize_f64(rounded)
    }
}

/// A joint or drive with its reaction.
#[derive(Serialize)]
struct Joint<'a> {
    name: &'a str,
    #[serde(rename = "type")]
    kind: &'static str,
    bodies: Vec<String>,
    verdict: &'static str,
    /// Names, units and verdicts of the components that are not identically zero.
    components: Vec<Component>,
    explanation: Option<&'a str>,
    /// The choice on which the numbers of a reaction depend if they are not unique.
    choice: Option<String>,
    /// Components of the reaction, and the named component; `None` if reactions were not requested.
    reaction: Option<Reaction>,
    /// The smallest and the largest value of components with bounds.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    bounds: BTreeMap<&'static str, [Channel; 2]>,
}

#[derive(Serialize)]
struct Component {
    name: &'static str,
    unit: &'static str,
    verdict: &'static str,
    /// The intervals on which the reaction is determined (s), if it is determined on only some.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    determined: Vec<[f64; 2]>,
}

#[derive(Serialize)]
struct Reaction {
    wrench: Vec<Channel>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    named: Option<NamedComponent>,
}

/// The component that the definition of a joint names.
#[derive(Serialize)]
struct NamedComponent {
    component: &'static str,
    unit: &'static str,
    named: Channel,
}

#[derive(Serialize)]
struct ComparisonData<'a> {
    joints: Vec<usize>,
    choices: Vec<ChoiceData<'a>>,
    freedom: Vec<FreedomData>,
}

#[derive(Serialize)]
struct ChoiceData<'a> {
    label: &'a str,
    /// Components of the wrench of each joint.
    wrenches: Vec<Vec<Channel>>,
}

#[derive(Serialize)]
struct FreedomData {
    angle: Channel,
    plane: bool,
    /// Whether the components are free at some time.
    components: Vec<bool>,
    /// Whether the components along the axes of the first body are free at some time.
    in_body: Vec<bool>,
}

impl<'a> Data<'a> {
    pub(super) fn new(page: &'a RunPage<'a>, cast: &Cast) -> Self {
        let frames = &page.recording.frames;
        let stage = cast.stage(page.mechanism, frames);
        let noise = noise(frames);
        Self {
            name: page.mechanism.name(),
            t: frames.iter().map(|f| Time(f.t)).collect(),
            drawing: stage.drawing(page.mechanism),
            components: {
                let space = page.mechanism.space();
                let names = space.components().iter();
                names
                    .map(|name| (*name, space.load_unit(name).unwrap_or_default()))
                    .collect()
            },
            joints: cast
                .joints()
                .iter()
                .map(|&k| joint(page, k, noise))
                .collect(),
            first_order: FirstOrder::of(page, cast),
            comparisons: page
                .comparisons
                .iter()
                .filter_map(|c| comparison(c, cast, page.mechanism.space(), noise))
                .collect(),
            curves: Curves::of(page, cast),
            units: ["m", "rad", "m/s", "rad/s"]
                .into_iter()
                .filter_map(|si| {
                    let (unit, value) = page.scene.units.unit(si)?;
                    Some((si, (unit, value.recip())))
                })
                .collect(),
            prefixes: Prefix::ALL
                .iter()
                .map(|(from, prefix)| (*from, prefix.symbol, prefix.factor))
                .collect(),
            prefixed: Prefix::UNITS,
            events: page.run().map_or(&[], |run| &run.events),
        }
    }
}

fn joint<'a>(page: &'a RunPage<'a>, k: usize, noise: f64) -> Joint<'a> {
    let group = &page.mechanism.layout().groups[k];
    let of_analysis: Option<&ReactionDocument> = page.analysis.and_then(|a| a.reactions.get(k));
    let of_run = page
        .run()
        .and_then(|run| run.reactions.0.get(k))
        .map(|(_, r)| r);
    let verdict = of_run
        .map(|r| r.verdict())
        .or(of_analysis.map(|r| r.wrench.verdict))
        .unwrap_or("undecided");
    let bodies = group.bodies.iter().map(|b| match b.moving() {
        None => "ground".to_owned(),
        Some(k) => page.mechanism.bodies()[k].name.clone(),
    });
    let id = ConstraintId(k);
    let is_open = verdict != "unique";
    Joint {
        name: &group.name,
        kind: group.spec.common.scene_type,
        bodies: bodies.collect(),
        verdict,
        components: components(page, id),
        explanation: of_analysis.and_then(|r| r.explanation.as_deref()),
        choice: page.run().filter(|_| is_open).and_then(|run| {
            let first = run.choice.first();
            first.map(ToString::to_string)
        }),
        reaction: reaction(page, id, noise),
        bounds: bounds(page, id, noise),
    }
}

/// Returns the bounds of the components of the wrench at the frames.
fn bounds(
    page: &RunPage<'_>,
    id: ConstraintId,
    noise: f64,
) -> BTreeMap<&'static str, [Channel; 2]> {
    let is_wrench = |name: &str| page.mechanism.space().component(name).is_some();
    let own = page.bands.iter();
    let own = own.filter(|band| band.id == id && is_wrench(band.component));
    own.map(|band| {
        let end = |k: usize| Channel::above(noise, band.ends.iter().map(move |ends| ends[k]));
        (band.component, [end(0), end(1)])
    })
    .collect()
}

/// Returns the components of a reaction with their verdicts over the run. Without a run, the
/// verdicts are the verdicts at the start.
fn components(page: &RunPage<'_>, id: ConstraintId) -> Vec<Component> {
    let group = &page.mechanism.layout().groups[id.0];
    if let Some(own) = page.stretches.and_then(|s| s.reactions.get(id.0)) {
        let wrench = own.components.iter();
        let wrench = wrench.filter(|(name, _)| group.space.component(name).is_some());
        return wrench
            .map(|(name, track)| Component {
                name,
                unit: group.space.load_unit(name).unwrap_or_default(),
                verdict: track.of_run().word(),
                determined: if track.of_run().is_unique() {
                    Vec::new()
                } else {
                    track.determined()
                },
            })
            .collect();
    }
    let at_start = page.analysis.and_then(|a| a.reactions.get(id.0));
    let known = at_start.map_or(&[][..], |r| &r.components).iter();
    known
        .filter(|c| group.space.component(c.name).is_some())
        .map(|c| Component {
            name: c.name,
            unit: group.space.load_unit(c.name).unwrap_or_default(),
            verdict: c.verdict.verdict,
            determined: Vec::new(),
        })
        .collect()
}

/// Returns the reaction at the frames. Numbers that are not determined become gaps.
fn reaction(page: &RunPage<'_>, id: ConstraintId, noise: f64) -> Option<Reaction> {
    let (frames, space) = (&page.recording.frames, page.mechanism.space());
    if !frames.iter().all(|f| f.reactions.len() > id.0) {
        return None;
    }
    let names = space.components().iter();
    let wrench: Vec<Vec<f64>> = names.map(|name| determined(page, id, name)).collect();
    let known = frames.iter().any(|f| {
        let mut values = f.reactions[id.0].components(space);
        values.any(f64::is_finite)
    });
    let named = page.mechanism.layout().groups[id.0].spec.component;
    let channel = |values: Vec<f64>| Channel::above(noise, values.into_iter());
    known.then(|| Reaction {
        wrench: wrench.into_iter().map(channel).collect(),
        named: named.map(|component| NamedComponent {
            component,
            unit: page.mechanism.layout().load_unit(id, component),
            named: channel(determined(page, id, component)),
        }),
    })
}

/// Converts a comparison to data. Returns `None` if one of its joints is not drawn.
fn comparison<'a>(
    c: &'a Comparison,
    cast: &Cast,
    space: SpaceKind,
    noise: f64,
) -> Option<ComparisonData<'a>> {
    let components = 0..space.n_v();
    // The torque of the plane has the same value in all axes.
    let of_body = if space.n_rotations() > 1 {
        components.clone()
    } else {
        space.forces()
    };
    let places = c
        .reactions
        .iter()
        .map(|k| cast.joints().binary_search(k).ok());
    let joints: Vec<usize> = places.collect::<Option<_>>()?;
    let choices = c.choices.iter().map(|choice| ChoiceData {
        label: &choice.label,
        wrenches: (0..c.reactions.len())
            .map(|j| {
                let values = choice.values.iter();
                let curve = |k| Channel::above(noise, values.clone().map(move |f| f[j][k]));
                components.clone().map(curve).collect()
            })
            .collect(),
    });
    let freedom = (0..c.reactions.len()).map(|j| {
        let frames = || c.freedom.iter().map(move |f| f[j]);
        FreedomData {
            angle: Channel::new(unwound(frames()).into_iter()),
            plane: frames().any(|f| f.plane),
            components: components
                .clone()
                .map(|c| frames().any(|f| f.components[c]))
                .collect(),
            in_body: of_body
                .clone()
                .map(|c| frames().any(|f| f.in_body[c]))
                .collect(),
        }
    });
    Some(ComparisonData {
        joints,
        choices: choices.collect(),
        freedom: freedom.collect(),
    })
}

/// Unwraps angles of axes, so that they do not jump by half a revolution.
fn unwound(freedom: impl Iterator<Item = Freedom>) -> Vec<f64> {
    let half = std::f64::consts::PI;
    let mut last = 0.0;
    freedom
        .map(|f| {
            if f.angle.is_nan() {
                return f64::NAN;
            }
            last = f.angle + half * ((last - f.angle) / half).round();
            last
        })
        .collect()
}

/// Returns a weighted number of values in a row, which limits the size of a recording. Each stored
/// value counts once, and each value that is shown has an additional weight.
pub(super) fn numbers_per_row(mechanism: &Mechanism) -> usize {
    let layout = mechanism.layout();
    let kept = layout.n_q + layout.n_v + layout.rows() + 4 * layout.groups.len();
    let bodies = mechanism.bodies().len().min(DRAWN_MAX);
    let joints = layout.groups.len().min(DRAWN_MAX);
    kept + SHOWN * (layout.space.columns().len() * bodies + layout.space.n_v() * joints)
}

/// A value that is shown has the weight of this many stored values.
const SHOWN: usize = 10;

/// Returns the number of levels of a curve, as a power of ten.
pub(super) fn levels() -> u64 {
    report::channel::LEVELS as u64
}
