//! Text about the verdicts along the motion.

use crate::documents::{AlongDocument, AlongReactionDocument, SpecialDocument};
use model::words::rounded;

use super::additions::ADDITIONS;
use super::phrases::spoken;
use crate::words::{Block, count};

/// Distance between analysed states above which a change may remain undetected. It is a fraction of
/// the size of the mechanism, or an angle (rad).
const COARSE: f64 = 0.2;

/// Number of instants that are listed.
const INSTANTS: usize = 12;

/// Describes the verdicts over the motion, the instants and intervals with different verdicts, and
/// the singular configurations.
pub(super) fn of(along: &AlongDocument) -> Vec<Block> {
    let (to, judged) = (
        seconds(along.to),
        count(along.samples, "state analysed", "states analysed"),
    );
    let heading = format!("Along the motion, t = 0 to {to} s ({judged}):");
    let mut out = vec![Block::Heading(heading)];
    let mut say = |text: String| out.push(Block::after("- ", text));
    say(over_the_motion(along));
    for (name, reaction) in &along.reactions.0 {
        if reaction.of_run.verdict != "unique" {
            say(components(name, reaction));
        }
    }
    let special = special(along);
    let stretches = along.stretches.iter().map(|s| &s.text);
    let passages = along.passages.iter().map(|p| &p.text);
    let all: Vec<&String> = stretches
        .chain(passages)
        .chain(special.iter().take(INSTANTS))
        .collect();
    all.iter().for_each(|text| say((*text).clone()));
    let is_constant = |(_, r): &(String, AlongReactionDocument)| r.of_run.determined.is_empty();
    if all.is_empty() && along.reactions.0.iter().all(is_constant) {
        say("the verdicts are the same at all times".to_owned());
    }
    if special.len() > INSTANTS {
        let more = count(special.len() - INSTANTS, "more instant", "more instants");
        say(format!("and {more} (`--json` prints all)"));
    }
    if along.reach > COARSE {
        say(format!(
            "warning: bodies move by up to {:.1} sizes of the mechanism (or radians) between analysed states; short events may be missed",
            along.reach
        ));
    }
    if let Some(reason) = &along.stopped {
        say(match along.continued_to {
            Some(to) => format!(
                "the motion stopped; a smooth continuation was analysed up to t = {} s: {reason}",
                seconds(to)
            ),
            None => format!("the motion stopped; later times were not analysed: {reason}"),
        });
    }
    let additions = ADDITIONS.iter();
    out.extend(additions.flat_map(|addition| addition.words_along(along)));
    out
}

/// Describes the rank, and the verdict on each reaction over the motion.
fn over_the_motion(along: &AlongDocument) -> String {
    let generic = &along.generic;
    let reactions = &along.reactions.0;
    let named = |word: &str| -> Vec<&str> {
        let with = reactions.iter().filter(|(_, r)| r.of_run.verdict == word);
        with.map(|(name, _)| name.as_str()).collect()
    };
    let mut text = format!(
        "almost always rank {}, redundancy {}",
        generic.rank, generic.redundancy
    );
    for word in ["unique", "not_unique", "undecided"] {
        let names = match named(word).as_slice() {
            [] if word == "undecided" => continue,
            [] => "none".to_owned(),
            names => names.join(", "),
        };
        text.push_str(&format!("; {}: {names}", spoken(word)));
    }
    text
}

/// Describes the verdict on each component over the motion.
fn components(name: &str, reaction: &AlongReactionDocument) -> String {
    let each = reaction.components.0.iter().map(|(component, track)| {
        let on = match track.on_intervals() {
            on if on.is_empty() => String::new(),
            on => format!(" (unique on {on})"),
        };
        format!("{component} {}{on}", spoken(track.verdict))
    });
    format!("`{name}`: {}", each.collect::<Vec<_>>().join(", "))
}

/// Describes different verdicts at single instants that are not singular configurations.
fn special(along: &AlongDocument) -> Vec<String> {
    let is_apart = |s: &&SpecialDocument| along.passages.iter().all(|p| p.time != s.time);
    let mut instants: Vec<(String, Vec<(&str, String)>)> = Vec::new();
    for special in along.special.iter().filter(is_apart) {
        let time = rounded(special.time);
        let name = match special.component {
            Some(component) => format!("{}.{component}", special.name),
            None => special.name.clone(),
        };
        let found = (special.verdict, name);
        match instants.last_mut() {
            Some((known, all)) if *known == time => {
                if !all.contains(&found) {
                    all.push(found);
                }
            }
            _ => instants.push((time, vec![found])),
        }
    }
    let text = |(time, all): &(String, Vec<(&str, String)>)| {
        let of = |word: &str| {
            let names = all.iter().filter(|(verdict, _)| *verdict == word);
            let names: Vec<&str> = names.map(|(_, name)| name.as_str()).collect();
            (!names.is_empty()).then(|| format!("{}: {}", spoken(word), names.join(", ")))
        };
        let words = ["unique", "not_unique", "undecided"].into_iter();
        let words: Vec<String> = words.filter_map(of).collect();
        format!("only at the instant t = {time} s: {}", words.join("; "))
    };
    instants.iter().map(text).collect()
}

/// Formats a time to the nanosecond, without trailing zeros.
fn seconds(t: f64) -> String {
    let text = format!("{t:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
