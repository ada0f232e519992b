//! The largest force and the largest moment of each reaction over the run, with their times, as a
//! table. A number that the model does not determine has no peak of its own: it is shown with the
//! choice on which it depends, or it is left out.

use model::{ConstraintId, Mechanism, Reaction, System};

use super::run_page::RunPage;
use super::{data, verdicts};
use crate::documents::RunReactionDocument;
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
    if !has_reactions || run.reactions.0.len() != layout.groups.len() {
        return;
    }
    out.push_str(
        "<h3>Peak reactions</h3>\n<div class=\"wide\"><table class=\"peaks\">\n<thead><tr><th>Joint or drive</th>\
         <th>Largest force (N)</th><th>at (s)</th><th>Largest moment (N·m)</th><th>at (s)</th>\
         <th>Component</th><th>at (s)</th><th>Valid for</th></tr></thead>\n<tbody>\n",
    );
    let noise = data::noise(frames);
    let told = layout.constraint_ids().take(LINES);
    for id in told {
        let (name, document) = &run.reactions.0[id.0];
        let is_unique = document.verdict() == "unique";
        let named = layout.groups[id.0].spec.component;
        if is_unique {
            let peaks = Peaks::of(frames, id, noise);
            let component = (named, peaks.named);
            let forces = [peaks.force, peaks.moment];
            line(
                out,
                name,
                forces,
                &[component],
                "every choice (unique reaction)",
            );
            continue;
        }
        // Determined components, each on its own intervals.
        let determined = document.components.0.iter();
        let determined: Vec<(Option<&str>, Option<Peak>)> = determined
            .filter_map(|(name, number)| {
                let peak = number.peak.as_ref()?;
                let value = peak.value.determined()?;
                let value = if value.abs() <= noise { 0.0 } else { value };
                let peak = Peak {
                    value,
                    t: peak.time,
                };
                Some((Some(name.as_str()), Some(peak)))
            })
            .collect();
        line(out, name, [None, None], &determined, &holds(document));
    }
    out.push_str("</tbody>\n</table></div>\n");
    notes(out, page.mechanism, page.recording.stride);
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
                intervals.map(|[from, to]| format!("{} … {} s", digits(*from), digits(*to)));
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

fn line(
    out: &mut String,
    name: &str,
    [force, moment]: [Option<Peak>; 2],
    components: &[(Option<&str>, Option<Peak>)],
    holds: &str,
) {
    let value = |label: &str, peak: Option<Peak>| {
        let cell = |label: &str, told: Option<String>| match told {
            Some(told) => format!("<td class=\"number\" data-label=\"{label}\">{told}</td>"),
            None => format!("<td class=\"number none\" data-label=\"{label}\">–</td>"),
        };
        let told = peak.map(|p| digits(p.value));
        cell(label, told) + &cell("at (s)", peak.map(|p| digits(p.t)))
    };
    let known = components.iter().filter_map(|(named, peak)| {
        let prefix = named.map(|n| format!("{} = ", safe(n))).unwrap_or_default();
        let peak = peak.as_ref()?;
        Some((format!("{prefix}{}", digits(peak.value)), digits(peak.t)))
    });
    let (values, times): (Vec<String>, Vec<String>) = known.unzip();
    let several = |label: &str, told: &[String]| {
        let (class, told) = match told {
            [] => ("number none", "–".to_owned()),
            told => ("number", told.join("<br>")),
        };
        format!("<td class=\"{class}\" data-label=\"{label}\">{told}</td>")
    };
    add(
        out,
        format_args!(
            "<tr><td><b>{}</b></td>{}{}{}<td class=\"why\" data-label=\"Valid for\">{}</td></tr>\n",
            safe(name),
            value("Largest force (N)", force),
            value("Largest moment (N·m)", moment),
            several("Component", &values) + &several("at (s)", &times),
            verdicts::marked(holds)
        ),
    );
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
             moments act on the first body. Moments are about the reference point of the joint.</p>\n"
        ),
    );
}

/// Formats a number with four digits.
fn digits(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let size = x.abs();
    if !(1e-3..1e5).contains(&size) {
        return format!("{x:.3e}");
    }
    let decimals = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
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

    #[test]
    fn numbers_have_four_digits() {
        let told = [0.0, 3.0, 12.34567, -0.0123456, 1234.5, 2.5e-7].map(digits);
        assert_eq!(told, ["0", "3", "12.35", "-0.01235", "1234", "2.500e-7"]);
    }
}
