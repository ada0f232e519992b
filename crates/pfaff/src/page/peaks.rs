//! The largest force and the largest moment of each reaction over the run, with their times, as a
//! table. A number that the model does not determine has no peak of its own: it is shown with the
//! bound of joints of any stiffness, or it is left out.

use model::words::short;
use model::{ConstraintId, Mechanism, Reaction, System};

use super::run_page::RunPage;
use super::{data, verdicts};
use crate::documents::{ExtremeDocument, LoadOfRunDocument, RunReactionDocument};
use crate::words::{Scale, UnitSystem};
use report::Frame;
use report::page::{add, safe};

/// Largest number of lines of the table.
const LINES: usize = 300;

/// A peak over the rows of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Peak {
    value: f64,
    /// Time (s).
    t: f64,
}

/// The peaks of a joint or drive; `None` if no finite value is known.
struct Peaks {
    force: Option<Peak>,
    moment: Option<Peak>,
    /// Peak of the named component, with its sign. Values not larger than `noise` count as zero.
    named: Option<Peak>,
}

impl Peaks {
    fn of(frames: &[Frame], id: ConstraintId, noise: f64) -> Self {
        let of = |value: &dyn Fn(&Reaction) -> Option<f64>| {
            let known = frames.iter().filter_map(|frame| {
                let value = value(frame.reactions.get(id.0)?)?;
                let value = if value.abs() <= noise { 0.0 } else { value };
                value.is_finite().then_some(Peak { value, t: frame.t })
            });
            // Of equal values the first one is used.
            known.fold(None, |best: Option<Peak>, peak| match best {
                Some(best) if best.value.abs() >= peak.value.abs() => Some(best),
                _ => Some(peak),
            })
        };
        let size = |v: [f64; 3]| Some(model::space::norm(&v));
        Self {
            force: of(&|r| size(r.force)),
            moment: of(&|r| size(r.torque)),
            named: of(&|r| r.component),
        }
    }
}

/// Writes the table, if the run has reactions.
pub(super) fn table(out: &mut String, page: &RunPage<'_>) {
    let (Some(run), frames) = (page.run(), &page.recording.frames) else {
        return;
    };
    let layout = page.mechanism.layout();
    let has_reactions = frames.iter().any(|f| !f.reactions.is_empty());
    let has_reactions = has_reactions && run.reactions.0.len() == layout.groups.len();
    if !has_reactions && run.loads.is_empty() {
        return;
    }
    let noise = data::noise(frames);
    let told = layout
        .constraint_ids()
        .take(if has_reactions { LINES } else { 0 });
    let lines = told.map(|id| {
        let (name, document) = &run.reactions.0[id.0];
        if document.verdict() == "unique" {
            let peaks = Peaks::of(frames, id, noise);
            let component = layout.groups[id.0].spec.component;
            let unit = layout.load_unit(id, component.unwrap_or_default());
            let named = peaks.named.map(|peak| (component, unit, peak));
            return PeakLine {
                name,
                is_bound: false,
                force: peaks.force,
                moment: peaks.moment,
                components: named.into_iter().collect(),
                holds: "every choice (unique reaction)".to_owned(),
            };
        }
        // Determined components, each on its own intervals.
        let determined = document.components.0.iter().filter_map(|(name, number)| {
            let peak = number.peak.as_ref()?;
            let value = peak.value.determined()?;
            let value = if value.abs() <= noise { 0.0 } else { value };
            let t = peak.time;
            let unit = layout.load_unit(id, name);
            Some((Some(name.as_str()), unit, Peak { value, t }))
        });
        let most = document.magnitude_at_most.as_ref();
        let bound = |extreme: Option<ExtremeDocument>| {
            let (value, t) = extreme.map(|extreme| (extreme.value, extreme.time))?;
            (value > noise).then_some(Peak { value, t })
        };
        let mut holds = holds(document);
        if most.is_some() {
            holds += "; ≤: joints of any stiffness that fit exactly";
        }
        PeakLine {
            name,
            is_bound: most.is_some(),
            force: most.and_then(|most| bound(most.force)),
            moment: most.and_then(|most| bound(most.moment)),
            components: determined.collect(),
            holds,
        }
    });
    let loads = run.loads.0.iter().take(LINES);
    let lines: Vec<PeakLine<'_>> = lines.chain(loads.map(PeakLine::of_load)).collect();
    let numbers = lines.iter().flat_map(PeakLine::numbers);
    let scale = Scale::new(numbers, UnitSystem::Scene(page.scene.units));
    let [force, moment] = [FORCE, MOMENT].map(|unit| scale.unit(unit).0);
    add(
        out,
        format_args!(
            "<section aria-labelledby=\"peaks-title\">\n<h2 id=\"peaks-title\">Peak loads</h2>\n<div class=\"wide\"><table class=\"peaks\">\n<thead><tr><th>Joint, drive or force</th>\
             <th>Largest force ({force})</th><th>at (s)</th><th>Largest moment ({moment})</th><th>at (s)</th>\
             <th>Component</th><th>at (s)</th><th>Valid for</th></tr></thead>\n<tbody>\n",
        ),
    );
    for line in &lines {
        line.write(out, &scale);
    }
    out.push_str("</tbody>\n</table></div>\n");
    notes(out, page.mechanism, page.recording.stride);
    out.push_str("</section>\n");
}

/// Unit of forces.
const FORCE: &str = "N";

/// Unit of moments.
const MOMENT: &str = "N·m";

/// A line of the table.
struct PeakLine<'a> {
    name: &'a str,
    /// Whether force and moment are upper bounds.
    is_bound: bool,
    force: Option<Peak>,
    moment: Option<Peak>,
    /// Components with their names and units.
    components: Vec<(Option<&'a str>, &'static str, Peak)>,
    /// When the numbers hold.
    holds: String,
}

/// States when the numbers hold, for a reaction that is not unique over the run.
fn holds(document: &RunReactionDocument) -> String {
    let mut parts: Vec<String> = Vec::new();
    for (name, number) in &document.components.0 {
        if number.of_run.verdict == "unique" {
            parts.push(format!("{name} is determined"));
        } else if !number.of_run.determined.is_empty() {
            let intervals = number.of_run.determined.iter();
            let intervals =
                intervals.map(|[from, to]| format!("{} … {} s", short(*from), short(*to)));
            let intervals: Vec<String> = intervals.collect();
            parts.push(format!("{name} is determined on {}", intervals.join(", ")));
        }
    }
    match parts.as_slice() {
        [] => "not determined by the model".to_owned(),
        parts => format!(
            "{}; the other components are not determined",
            parts.join("; ")
        ),
    }
}

impl<'a> PeakLine<'a> {
    /// The line of a force element; lengths and angles have both extreme values.
    fn of_load((name, load): &'a (String, LoadOfRunDocument)) -> Self {
        let peak = |extreme: ExtremeDocument| Peak {
            value: extreme.value,
            t: extreme.time,
        };
        let ranges = load.components.0.iter();
        let ranges = ranges.filter_map(|(number, range)| {
            let (named, unit) = match number.as_str() {
                "length" => (["least length", "largest length"], "m"),
                "angle" => (["least angle", "largest angle"], "rad"),
                _ => return None,
            };
            let ends = named.into_iter().zip([range.lowest, range.highest]);
            Some(ends.map(move |(named, end)| (Some(named), unit, peak(end))))
        });
        Self {
            name,
            is_bound: false,
            force: load.peak.force.map(peak),
            moment: load.peak.moment.map(peak),
            components: ranges.flatten().collect(),
            holds: "every choice (force element)".to_owned(),
        }
    }

    /// Returns all numbers with their units.
    fn numbers(&self) -> impl Iterator<Item = (f64, &'static str)> {
        let totals = [(self.force, FORCE), (self.moment, MOMENT)];
        let totals = totals.map(|(peak, unit)| peak.map(|peak| (peak.value, unit)));
        let components = self.components.iter();
        let components = components.map(|(_, unit, peak)| (peak.value, *unit));
        totals.into_iter().flatten().chain(components)
    }

    fn write(&self, out: &mut String, scale: &Scale) {
        let cell = |label: &str, told: &[String]| {
            let (class, told) = match told {
                [] => ("number none", "–".to_owned()),
                told => ("number", told.join("<br>")),
            };
            format!("<td class=\"{class}\" data-label=\"{label}\">{told}</td>")
        };
        let total = |label: &str, peak: Option<Peak>, unit: &str| {
            let sign = if self.is_bound { "≤ " } else { "" };
            let value = peak.map(|p| format!("{sign}{}", scale.number(p.value, unit)));
            let label = format!("{label} ({})", scale.unit(unit).0);
            cell(&label, value.as_slice()) + &cell("at (s)", peak.map(|p| short(p.t)).as_slice())
        };
        let components = self.components.iter().map(|(name, unit, peak)| {
            let prefix = name.map(|n| format!("{} = ", safe(n))).unwrap_or_default();
            let number = scale.number(peak.value, unit);
            (
                format!("{prefix}{number} {}", scale.unit(unit).0),
                short(peak.t),
            )
        });
        let (values, times): (Vec<String>, Vec<String>) = components.unzip();
        add(
            out,
            format_args!(
                "<tr><td><b>{}</b></td>{}{}{}<td class=\"why\" data-label=\"Valid for\">{}</td></tr>\n",
                safe(self.name),
                total("Largest force", self.force, FORCE),
                total("Largest moment", self.moment, MOMENT),
                cell("Component", &values) + &cell("at (s)", &times),
                verdicts::marked(&self.holds)
            ),
        );
    }
}

fn notes(out: &mut String, mechanism: &Mechanism, stride: usize) {
    let groups = mechanism.layout().groups.len();
    if groups > LINES {
        add(
            out,
            format_args!(
                "<p class=\"grey\">The table omits {} joints and drives. The file reactions.csv contains all of them.</p>\n",
                groups - LINES
            ),
        );
    }
    let rows = match stride {
        0 | 1 => "output rows".to_owned(),
        n => format!("output rows on this page (one in {n})"),
    };
    add(
        out,
        format_args!(
            "<p class=\"grey\">Each peak is the largest value in the {rows}. Between these rows, a reaction may be larger. Forces and \
             moments act on the first body. Moments are about the reference point of the joint, or about the point of the force on this body.</p>\n"
        ),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(t: f64, force: [f64; 3], component: f64) -> Frame {
        Frame {
            reactions: vec![Reaction {
                force,
                torque: [0.0, 0.0, f64::NAN],
                component: Some(component),
            }],
            ..Frame::at_rest(t, &[], 0)
        }
    }

    #[test]
    fn a_peak_is_the_first_largest_and_keeps_its_sign() {
        let frames = [
            frame(0.0, [3.0, 0.0, 4.0], 1.0),
            frame(0.5, [0.0, -13.0, 0.0], -7.0),
            frame(1.0, [5.0, 12.0, 0.0], 7.0),
            frame(1.5, [f64::NAN, 100.0, 0.0], 2.0),
        ];
        let peaks = Peaks::of(&frames, ConstraintId(0), 1e-9);
        let at = |value, t| Some(Peak { value, t });
        assert_eq!(peaks.force, at(13.0, 0.5));
        assert_eq!(peaks.named, at(-7.0, 0.5));
        assert_eq!(peaks.moment, None);
        assert_eq!(
            Peaks::of(&frames[..1], ConstraintId(0), 2.0).named,
            at(0.0, 0.0)
        );
    }
}
