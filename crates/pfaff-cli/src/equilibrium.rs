//! `pfaff equilibrium`: a start at rest, in words, as JSON, and as a scene that starts there.

use std::path::Path;

use pfaff::dynamics::equilibrium::EquilibriumOptions;
use pfaff::model::System;
use pfaff::model::words::rounded;
use pfaff::report::documents::{EquilibriumDocument, Named, ReactionAtRestDocument};
use pfaff::report::{Family, PROVENANCE, write_json};
use pfaff::{Overrides, Study, StudyError};

use crate::args::Equilibrium;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Failure, Files, Outcome, columns, count, directory, wrapped};

/// Numbers below this share of the largest of their kind are shown as zero.
const VISIBLE: f64 = 1e-12;

/// The scene that starts at rest.
const SCENE: &str = "at-rest.toml";

/// The document.
const DOCUMENT: &str = "equilibrium.json";

/// The files of a state at rest.
const FAMILY: Family = Family(&[SCENE, DOCUMENT]);

pub(crate) fn run(arguments: &Equilibrium, console: &Console<'_>) -> Outcome {
    Interrupt::ends_at_once()?;
    let source =
        Source::read(&arguments.scene, &arguments.known.settings, console)?.known(&arguments.known);
    let study = source.study(&Overrides::default(), arguments.resources, console)?;
    let options = EquilibriumOptions {
        stable: arguments.stable,
    };
    let (found, there) = study.equilibrium(&options).map_err(|e| source.failure(e))?;
    let reactions = reactions_at_rest(&there.held_at(found.time)).map_err(|e| e.to_string());
    let mut document = EquilibriumDocument::new(
        study.scene.name(),
        &study.prepared.mechanism,
        &study.prepared.q,
        &found,
        reactions,
    );
    let written = match &arguments.out {
        Some(path) => {
            let text = study.text_at_rest(&found.q);
            let text = text.map_err(|e| Failure::input(e.to_string()).coded(e.code()))?;
            write(path, arguments.force, &source, &text, &mut document)?
        }
        None => String::new(),
    };
    if arguments.json {
        return console.document(&document);
    }
    console.print(&(describe(&document) + &written))
}

/// The reactions at the start of a study.
fn reactions_at_rest(there: &Study) -> Result<Named<ReactionAtRestDocument>, StudyError> {
    let configuration = there.analyse(0.0, None)?;
    Ok(ReactionAtRestDocument::all(
        &configuration.analysis.reactions,
        &configuration.determined_reactions()?,
        &configuration.sensitivities()?,
        configuration.mechanism.layout(),
    ))
}

/// Writes the scene that starts at rest, and the document; returns what was written, in words.
fn write(
    path: &Path,
    force: bool,
    source: &Source<'_>,
    text: &str,
    document: &mut EquilibriumDocument,
) -> Result<String, Failure> {
    // What is written has to start where it says.
    Study::read(SCENE, text, source.registry, &Overrides::default()).map_err(|e| {
        Failure::stopped(format!("the scene that starts at rest cannot be read: {e}"))
    })?;
    let place = directory(path, FAMILY, force)?;
    let mut files = Files::of(&place, FAMILY)?;
    let head = format!("{PROVENANCE} equilibrium: `start` says where bodies start, at rest\n");
    files.put(SCENE, (head + text).as_bytes())?;
    document.file = Some(SCENE.to_owned());
    let mut json = Vec::new();
    write_json(&mut json, document).map_err(|e| Failure::stopped(e.to_string()))?;
    files.put(DOCUMENT, &json)?;
    let beside = files.finish()?;
    let scene = path.join(SCENE);
    Ok(format!(
        "\nwritten to {}: {SCENE}, {DOCUMENT}\n`pfaff simulate {scene}` and `pfaff linearise {scene}` start there\n{beside}",
        path.display(),
        scene = scene.display(),
    ))
}

fn describe(d: &EquilibriumDocument) -> String {
    let balance = match d.residual {
        0.0 => "forces balance".to_owned(),
        left => format!("forces balance to {left:.1e} of the largest"),
    };
    let found = match (d.steps, d.pushes) {
        (0, 0) => "rests where it starts".to_owned(),
        (steps, 0) => format!("rests, found in {}", count(steps, "step", "steps")),
        (steps, pushes) => format!(
            "rests, found in {} after {}",
            count(steps, "step", "steps"),
            count(pushes, "push", "pushes")
        ),
    };
    let mut text = format!(
        "{} {found}, with functions of time at t = {} s: {balance}\n",
        d.scene, d.time
    );
    text.push_str(&wrapped("", &stability(d)));
    let listed = |names: &[String]| {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    let mut say = |lead: &str, what: String| text.push_str(&wrapped("", &format!("{lead}{what}")));
    if !d.idle.is_empty() {
        say(
            "free motions that nothing pushes, so that other places along them are places of rest, too: ",
            d.idle.join("; "),
        );
    }
    if d.depends_on_way {
        say(
            "rolling and knife edges restrict the way, not the place: other ways lead to other places of rest",
            String::new(),
        );
    }
    if !d.held.is_empty() {
        let lead = format!("drives are held at t = {} s: ", d.time);
        say(&lead, listed(&d.held));
    }
    if !d.moving_on.is_empty() {
        say(
            "a run from here begins with other forces, since functions of time accelerate: ",
            listed(&d.moving_on),
        );
    }
    text.push('\n');
    let places = d.bodies.0.iter().flat_map(|(_, body)| body.at.0.iter());
    let largest = places.fold(0.0, |a: f64, (_, x)| a.max(x.abs()));
    let header = ["body", "moved (m)", "turned (rad)", "is at"].map(str::to_owned);
    let bodies = d.bodies.0.iter().map(|(name, body)| {
        let at = body
            .at
            .0
            .iter()
            .map(|(name, x)| format!("{name} = {}", short(*x, largest)));
        vec![
            name.clone(),
            short(body.moved, largest),
            short(body.turned, 1.0),
            at.collect::<Vec<_>>().join(", "),
        ]
    });
    let rows: Vec<Vec<String>> = std::iter::once(header.to_vec()).chain(bodies).collect();
    text.push_str(&columns(&rows));
    if let Some(why) = &d.no_reactions_because {
        text.push('\n');
        text.push_str(&wrapped("", &format!("no reactions: {why}")));
    } else if !d.reactions.0.is_empty() {
        text.push('\n');
        text.push_str(&columns(&reactions(d)));
    }
    text
}

fn reactions(d: &EquilibriumDocument) -> Vec<Vec<String>> {
    let header = ["reaction", "on the first body", "verdict"].map(str::to_owned);
    let values = d.reactions.0.iter().flat_map(|(_, r)| r.values.0.iter());
    let values = values.filter_map(|(_, x)| x.determined());
    let largest = values.fold(0.0, |a: f64, x| a.max(x.abs()));
    let each = d.reactions.0.iter().map(|(name, reaction)| {
        let values = reaction.values.0.iter();
        // What is not determined has no number.
        let values = values.map(|(name, x)| match x.determined() {
            None => format!("{name} = –"),
            Some(x) => format!("{name} = {}", short(x, largest)),
        });
        let verdict = reaction.verdict.verdict.replace('_', " ");
        vec![name.clone(), values.collect::<Vec<_>>().join(", "), verdict]
    });
    std::iter::once(header.to_vec()).chain(each).collect()
}

fn stability(d: &EquilibriumDocument) -> String {
    match d.stability {
        "immovable" => "nothing can move".to_owned(),
        "stable" => "stable: forces push back from every displacement".to_owned(),
        "idle" => "no displacement is pushed further, and some are not pushed back".to_owned(),
        "unstable" => format!(
            "unstable: forces push further along: {}; `--stable` leaves such places",
            d.falling.join("; ")
        ),
        _ => format!(
            "whether it is stable is not judged: {}",
            d.not_judged_because.unwrap_or_default()
        ),
    }
}

/// A number with six digits; what is a rounding of the largest of its kind is zero.
fn short(x: f64, largest: f64) -> String {
    match x.abs() {
        size if size <= VISIBLE * largest => "0".to_owned(),
        _ => rounded(x),
    }
}
