//! Verdicts along the motion: the run with its progress bar on a terminal, and the answer in words.

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use pfaff::report::documents::AlongDocument;
use pfaff::{Progress, Study, StudyError};

use crate::input::Source;
use crate::output::{Failure, count, wrapped};

/// Steps of the progress bar over the whole motion.
const TICKS: u64 = 1000;

/// Judged states farther apart than this may miss a change: a fraction of the mechanism's size, or
/// radians.
const COARSE: f64 = 0.2;

/// Runs and judges the motion.
pub(super) fn judge(
    source: &Source,
    study: &Study,
    t_end: Option<f64>,
    bars: &MultiProgress,
) -> Result<AlongDocument, Failure> {
    let own = study.options.as_ref().map(|options| options.t_end);
    let Some(end) = t_end.or(own) else {
        return Err(source.failure(StudyError::NoEnd));
    };
    if !(end.is_finite() && end > 0.0) {
        return Err(Failure::input(format!(
            "--along goes to {end}, need a time > 0"
        )));
    }
    // It hides itself if standard error is not a terminal.
    let bar = bars.add(ProgressBar::new(TICKS));
    if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40}") {
        bar.set_style(style);
    }
    let mut doing = "";
    let along_motion = study.verdicts_along_motion(t_end, |progress| {
        let (what, t) = match progress {
            Progress::Moving(t) => ("moving ", t),
            Progress::Judging(t) => ("judging", t),
        };
        if what != doing {
            bar.set_message(what);
            doing = what;
        }
        bar.set_position((t / end * TICKS as f64) as u64);
    });
    bar.finish_and_clear();
    let along_motion = along_motion.map_err(|e| source.failure(e))?;
    Ok(along_motion.document())
}

/// The verdict that holds along the motion, then the intervals with other verdicts.
pub(super) fn describe(along: &AlongDocument) -> String {
    let mut out = format!(
        "\nAlong the motion, t = 0 to {} s ({}):\n",
        seconds(along.to),
        count(along.samples, "state judged", "states judged"),
    );
    let generic = &along.generic;
    let named = |word: &str| {
        let reactions = generic.reactions.iter();
        let with: Vec<&str> = reactions
            .filter(|r| r.verdict.verdict == word)
            .map(|r| r.name.as_str())
            .collect();
        match with.as_slice() {
            [] => "none".to_owned(),
            names => names.join(", "),
        }
    };
    let mut general = format!(
        "almost always rank {}, redundancy {}; unique: {}; not unique: {}",
        generic.rank,
        generic.redundancy,
        named("unique"),
        named("not_unique"),
    );
    if generic
        .reactions
        .iter()
        .any(|r| r.verdict.verdict == "undecided")
    {
        general.push_str(&format!("; undecided: {}", named("undecided")));
    }
    out.push_str(&wrapped("- ", &general));
    let stretches = along.stretches.iter().map(|s| &s.text);
    let passages = along.passages.iter().map(|p| &p.text);
    for text in stretches.chain(passages) {
        out.push_str(&wrapped("- ", text));
    }
    if along.stretches.is_empty() && along.passages.is_empty() {
        out.push_str("- nothing else holds at any time\n");
    }
    if along.reach > COARSE {
        let between = format!(
            "warning: between judged states bodies move by up to {:.1} of the mechanism's size or radians: short events may be missed",
            along.reach
        );
        out.push_str(&wrapped("- ", &between));
    }
    if let Some(reason) = &along.stopped {
        let judged = match along.continued_to {
            Some(to) => format!(
                "the motion stopped there; continued as smoothly as it came, it was judged up to t = {} s: {reason}",
                seconds(to)
            ),
            None => format!("the motion stopped, and was judged only so far: {reason}"),
        };
        out.push_str(&wrapped("- ", &judged));
    }
    out
}

/// Formats a time to the nanosecond, without trailing zeros.
fn seconds(t: f64) -> String {
    let text = format!("{t:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
