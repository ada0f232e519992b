//! A table of the largest force and the largest moment of each reaction over the run, with their
//! times. A number that the model does not determine has no peak. The table shows the bound of such
//! a number for joints of any stiffness, or omits the number.

use model::words::short;
use model::{Mechanism, System};

use super::run_page::RunPage;
use super::{values, verdicts};
use crate::documents::{
    ByName, ExtremeDocument, LoadOfRunDocument, PeakDocument, RunGroupDocument, RunNumberDocument,
    TrackDocument,
};
use crate::words::Scale;
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

impl Peak {
    /// Returns the peak. A value not larger than `noise` counts as zero.
    fn above(self, noise: f64) -> Self {
        let value = if self.value.abs() <= noise {
            0.0
        } else {
            self.value
        };
        Self { value, ..self }
    }
}

/// Writes the table, if the run has reactions.
pub(super) fn table(out: &mut String, page: &RunPage<'_>) {
    let lines = lines(page);
    if lines.is_empty() {
        return;
    }
    let numbers = lines.iter().flat_map(PeakLine::numbers);
    let scale = Scale::new(numbers);
    let [force, moment] = [FORCE, MOMENT].map(|unit| scale.unit(unit).0);
    add(
        out,
        format_args!(
            "<section aria-labelledby=\"peaks-title\">\n<h2 id=\"peaks-title\">Peak loads</h2>\n<div class=\"wide\"><table class=\"peaks\">\n<thead><tr><th>Joint, drive, force or group</th>\
             <th>Largest force ({force})</th><th>at (s)</th><th>Largest moment ({moment})</th><th>at (s)</th>\
             <th>Component</th><th>at (s)</th><th>Valid for</th></tr></thead>\n<tbody>\n",
        ),
    );
    for line in &lines {
        line.write(out, &scale);
    }
    out.push_str("</tbody>\n</table></div>\n");
    notes(out, page.mechanism);
    out.push_str("</section>\n");
}

/// Writes the determined peaks for print, with a line for each number. Also lists the reactions
/// without a determined number.
pub(super) fn determined(out: &mut String, page: &RunPage<'_>) {
    let lines = lines(page);
    let measures = measures(page);
    if lines.is_empty() && measures.is_empty() {
        return;
    }
    let numbers: Vec<PeakNumber<'_>> = lines
        .iter()
        .flat_map(PeakLine::apart)
        .filter(|number| number.peak.value != 0.0)
        .chain(measures)
        .collect();
    let values = numbers.iter().map(|n| (n.peak.value, n.unit));
    let scale = Scale::new(values);
    let mut units: Vec<&'static str> = Vec::new();
    for number in &numbers {
        if !units.contains(&number.unit) {
            units.push(number.unit);
        }
    }
    out.push_str(
        "<section aria-labelledby=\"peaks-title\">\n<h2 id=\"peaks-title\">Determined peaks</h2>\n",
    );
    if !numbers.is_empty() {
        let headers = units.iter().map(|unit| {
            let header = format!("{} ({})", kind(unit), scale.unit(unit).0);
            format!(
                "<th class=\"figure\">{}</th>",
                safe(header.trim_end_matches(" ()"))
            )
        });
        add(
            out,
            format_args!(
                "<div class=\"wide\"><table class=\"peaks\">\n<thead><tr><th>Part</th><th>Quantity</th>{}<th class=\"figure\">at (s)</th>\
                 <th>Determined</th></tr></thead>\n<tbody>\n",
                headers.collect::<String>()
            ),
        );
        for (k, number) in numbers.iter().enumerate() {
            let is_first = k == 0 || numbers[k - 1].name != number.name;
            number.write(out, is_first, &units, &scale);
        }
        out.push_str("</tbody>\n</table></div>\n");
    }
    let has_number = |name: &str| numbers.iter().any(|number| number.name == name);
    let open = lines
        .iter()
        .filter(|line| !line.is_unique && !has_number(line.name));
    let open: Vec<String> = open.map(|line| format!("`{}`", line.name)).collect();
    if !open.is_empty() {
        let text = format!(
            "The model determines no load other than zero for {}. These parts have no line in the table.",
            open.join(", ")
        );
        add(out, format_args!("<p>{}</p>\n", verdicts::marked(&text)));
    }
    if !numbers.is_empty() {
        notes(out, page.mechanism);
    }
    out.push_str("</section>\n");
}

/// Returns the header of a column for numbers in an SI unit.
fn kind(unit: &str) -> &'static str {
    match unit {
        FORCE => "Force",
        MOMENT => "Moment",
        "m" => "Length",
        "rad" => "Angle",
        "m/s" => "Speed",
        "rad/s" => "Angular velocity",
        _ => "Value",
    }
}

/// Returns the smallest and the largest value of each measure over the run.
fn measures<'p>(page: &RunPage<'p>) -> Vec<PeakNumber<'p>> {
    let (mechanism, frames) = (page.mechanism, &page.recording.frames);
    let measures = mechanism.frames().observed().measures.iter().enumerate();
    let each = measures.take(LINES).flat_map(|(k, measure)| {
        let values = frames.iter().map(|frame| Peak {
            value: mechanism.frames().measure(k, &frame.q, &frame.v),
            t: frame.t,
        });
        let values = values.filter(|peak| peak.value.is_finite());
        // If several values are equal, the first value is used.
        let least = values
            .clone()
            .reduce(|a, b| if b.value < a.value { b } else { a });
        let largest = values.reduce(|a, b| if b.value > a.value { b } else { a });
        let ends = [("smallest value", least), ("largest value", largest)];
        ends.into_iter().filter_map(|(quantity, peak)| {
            Some(PeakNumber {
                name: &measure.name,
                quantity: quantity.to_owned(),
                unit: measure.kind.unit(),
                peak: peak?,
                is_bound: false,
                determined: "throughout".to_owned(),
            })
        })
    });
    each.collect()
}

/// Returns the lines of joints and drives, of groups, and of force elements.
fn lines<'p>(page: &'p RunPage<'p>) -> Vec<PeakLine<'p>> {
    let (Some(run), frames) = (page.run(), &page.recording.frames) else {
        return Vec::new();
    };
    let layout = page.mechanism.layout();
    let has_reactions = frames.iter().any(|f| !f.reactions.is_empty());
    let has_reactions = has_reactions && run.reactions.0.len() == layout.groups.len();
    let noise = values::noise(frames);
    let told = layout
        .constraint_ids()
        .take(if has_reactions { LINES } else { 0 });
    let lines = told.map(|id| {
        let (name, document) = &run.reactions.0[id.0];
        if document.verdict() == "unique" {
            let magnitudes = document.peak.as_ref();
            let of = |peak: Option<&PeakDocument>| determined_peak(peak?, noise);
            let component = layout.groups[id.0].spec.component;
            let named = component.and_then(|name| document.components.get(name));
            let named = named.and_then(|number| of(number.peak.as_ref()));
            let unit = layout.load_unit(id, component.unwrap_or_default());
            return PeakLine {
                name,
                is_unique: true,
                is_bound: false,
                force: of(magnitudes.and_then(|peak| peak.force.as_ref())),
                moment: of(magnitudes.and_then(|peak| peak.moment.as_ref())),
                components: named
                    .map(|peak| (component, unit, peak))
                    .into_iter()
                    .collect(),
                tracks: None,
                holds: "every choice (unique reaction)".to_owned(),
            };
        }
        // Determined components. Each component has its own intervals.
        let determined = document.components.0.iter().filter_map(|(name, number)| {
            let peak = determined_peak(number.peak.as_ref()?, noise)?;
            Some((Some(name.as_str()), layout.load_unit(id, name), peak))
        });
        let most = document.magnitude_at_most.as_ref();
        let bound = |extreme: Option<ExtremeDocument>| {
            let (value, t) = extreme.map(|extreme| (extreme.value, extreme.time))?;
            (value > noise).then_some(Peak { value, t })
        };
        let mut holds = holds(&document.components);
        if most.is_some() {
            holds += "; ≤: joints of any stiffness that fit exactly";
        }
        PeakLine {
            name,
            is_unique: false,
            is_bound: most.is_some(),
            force: most.and_then(|most| bound(most.force)),
            moment: most.and_then(|most| bound(most.moment)),
            components: determined.collect(),
            tracks: Some(&document.components),
            holds,
        }
    });
    let groups = run.groups.0.iter().take(LINES);
    let groups = groups.filter_map(|group| PeakLine::of_group(group, page, noise));
    let loads = run.loads.0.iter().take(LINES);
    let loads = loads.map(|load| PeakLine::of_load(load, noise));
    lines.chain(groups).chain(loads).collect()
}

/// Returns a peak if the model determines its value. Values not larger than `noise` count as zero.
fn determined_peak(peak: &PeakDocument, noise: f64) -> Option<Peak> {
    let (value, t) = (peak.value.determined()?, peak.time);
    Some(Peak { value, t }.above(noise))
}

/// Unit of forces.
const FORCE: &str = "N";

/// Unit of moments.
const MOMENT: &str = "N·m";

/// A line of the table.
struct PeakLine<'a> {
    name: &'a str,
    /// Whether all numbers are determined throughout the run.
    is_unique: bool,
    /// Whether force and moment are upper bounds.
    is_bound: bool,
    force: Option<Peak>,
    moment: Option<Peak>,
    /// Components with their names and units.
    components: Vec<(Option<&'a str>, &'static str, Peak)>,
    /// Verdicts of the components, if the reaction is not unique.
    tracks: Option<&'a ByName<RunNumberDocument>>,
    /// The intervals on which the numbers are determined.
    holds: String,
}

/// States on which intervals the numbers are determined, for a reaction that is not unique over the
/// run.
fn holds(components: &ByName<RunNumberDocument>) -> String {
    let parts = components.0.iter().filter_map(|(name, number)| {
        let on = determined_on(&number.of_run)?;
        Some(format!("{name} is determined{on}"))
    });
    let parts: Vec<String> = parts.collect();
    match parts.as_slice() {
        [] => "not determined by the model".to_owned(),
        parts => format!(
            "{}; the other components are not determined",
            parts.join("; ")
        ),
    }
}

/// Returns the intervals on which a number is determined, such as ` on 0 … 1 s`. The text is empty
/// if the number is determined throughout. Returns `None` if the number is not determined.
fn determined_on(of_run: &TrackDocument) -> Option<String> {
    if of_run.verdict == "unique" {
        return Some(String::new());
    }
    let intervals = of_run.determined.iter();
    let intervals = intervals.map(|[from, to]| format!("{} … {} s", short(*from), short(*to)));
    let intervals: Vec<String> = intervals.collect();
    (!intervals.is_empty()).then(|| format!(" on {}", intervals.join(", ")))
}

/// A peak for print.
struct PeakNumber<'a> {
    name: &'a str,
    quantity: String,
    unit: &'static str,
    peak: Peak,
    /// Whether the number is an upper bound of a number that is not determined.
    is_bound: bool,
    /// The intervals on which the number is determined.
    determined: String,
}

impl PeakNumber<'_> {
    /// Writes a line with one column for each unit. Only the first line of an item contains its
    /// name.
    fn write(&self, out: &mut String, is_first: bool, units: &[&'static str], scale: &Scale) {
        let name = if is_first {
            safe(self.name)
        } else {
            String::new()
        };
        add(
            out,
            format_args!(
                "<tr><td><b>{name}</b></td><td data-label=\"Quantity\">{}</td>",
                safe(&self.quantity)
            ),
        );
        for unit in units {
            let label = format!("{} ({})", kind(unit), scale.unit(unit).0);
            let (class, number) = match *unit == self.unit {
                true if self.is_bound => (
                    "figure",
                    format!("≤ {}", scale.number(self.peak.value, unit)),
                ),
                true => ("figure", scale.number(self.peak.value, unit)),
                false => ("figure none", String::new()),
            };
            add(
                out,
                format_args!("<td class=\"{class}\" data-label=\"{label}\">{number}</td>"),
            );
        }
        add(
            out,
            format_args!(
                "<td class=\"figure\" data-label=\"at (s)\">{}</td><td data-label=\"Determined\">{}</td></tr>\n",
                short(self.peak.t),
                self.determined
            ),
        );
    }
}

impl<'a> PeakLine<'a> {
    /// Returns the line of a group. Returns `None` for a group without numbers.
    fn of_group(
        (name, group): &'a (String, RunGroupDocument),
        page: &RunPage<'_>,
        noise: f64,
    ) -> Option<Self> {
        let unit = |number: Option<&str>| {
            let title = number.map_or_else(|| name.clone(), |own| format!("{name}.{own}"));
            let plot = page.groups.iter().find(|plot| plot.title == title);
            plot.map(|plot| plot.unit)
        };
        let is_unique = group.of_run.verdict == "unique";
        let peak = |number: Option<&'a str>, peak: Option<&PeakDocument>| {
            Some((number, unit(number)?, determined_peak(peak?, noise)?))
        };
        let (components, holds) = if group.components.is_empty() {
            // Without a column, the group only analyses its reactions together.
            unit(None)?;
            let determined = determined_on(&group.of_run);
            let holds = match determined.as_deref() {
                Some(on) if !is_unique => format!("determined{on}"),
                _ => self::holds(&group.components),
            };
            let sum = peak(None, group.peak.as_ref());
            (sum.into_iter().collect(), holds)
        } else {
            let own = group.components.0.iter();
            let own = own.filter_map(|(number, own)| peak(Some(number), own.peak.as_ref()));
            (own.collect(), self::holds(&group.components))
        };
        Some(Self {
            name,
            is_unique,
            is_bound: false,
            force: None,
            moment: None,
            components,
            tracks: Some(&group.components).filter(|_| !is_unique),
            holds: if is_unique {
                "every choice (unique combination)".to_owned()
            } else {
                holds
            },
        })
    }

    /// Returns the numbers one by one. The force and the moment are magnitudes.
    fn apart(&self) -> Vec<PeakNumber<'a>> {
        let number = |quantity: &str, unit, peak, determined: String| PeakNumber {
            name: self.name,
            quantity: quantity.to_owned(),
            unit,
            peak,
            is_bound: false,
            determined,
        };
        // A named component that is the whole force or moment is listed only once.
        let is_named = |peak: Peak, unit: &str| {
            let mut components = self.components.iter();
            components.any(|(_, own, named)| {
                *own == unit && short(named.value.abs()) == short(peak.value)
            })
        };
        let determined = if self.is_bound {
            "no; bound for joints of any stiffness that fit exactly"
        } else {
            "throughout"
        };
        let totals = [("|F|", self.force, FORCE), ("|M|", self.moment, MOMENT)];
        let totals = totals.into_iter().filter_map(|(quantity, peak, unit)| {
            let peak = peak.filter(|peak| !is_named(*peak, unit))?;
            Some(PeakNumber {
                is_bound: self.is_bound,
                ..number(quantity, unit, peak, determined.to_owned())
            })
        });
        let components = self.components.iter().map(|(name, unit, peak)| {
            let track = name.and_then(|name| self.tracks?.get(name));
            let on = match track {
                Some(track) => determined_on(&track.of_run),
                None => Some(String::new()).filter(|_| self.is_unique),
            };
            let determined = match on.as_deref() {
                Some("") => "throughout".to_owned(),
                Some(on) => on.trim_start().to_owned(),
                None => self.holds.clone(),
            };
            number(name.unwrap_or("sum"), unit, *peak, determined)
        });
        totals.chain(components).collect()
    }

    /// Returns the line of a force element. Lengths and angles have both extreme values.
    fn of_load((name, load): &'a (String, LoadOfRunDocument), noise: f64) -> Self {
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
            is_unique: true,
            is_bound: false,
            force: load.peak.force.map(peak).map(|peak| peak.above(noise)),
            moment: load.peak.moment.map(peak).map(|peak| peak.above(noise)),
            components: ranges.flatten().collect(),
            tracks: None,
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

fn notes(out: &mut String, mechanism: &Mechanism) {
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
    out.push_str(
        "<p class=\"grey\">Each peak is the largest value in the rows of the tables. Between these rows, a reaction may be larger. Forces and \
         moments act on the first body. Moments are about the reference point of the joint, or about the point of the force on this body.</p>\n",
    );
}
