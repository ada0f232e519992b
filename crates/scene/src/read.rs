//! From a text to a scene, or to everything that is wrong with it.

use std::collections::BTreeMap;
use std::ops::Range;

use model::{BuildError, Description, Mechanism, Registry, StartOptions, System};
use toml::de::DeTable;

use crate::body::{Bodies, GROUND};
use crate::combination::ReactionNames;
use crate::diagnostic::Diagnostic;
use crate::field::Field;
use crate::findings::Findings;
use crate::force::Forces;
use crate::joint::{Drives, Joints};
use crate::locate;
use crate::reactions::{self, Output, components};
use crate::scene::Scene;
use crate::simulate::{self, Simulate};
use crate::source_map::{Entry, SourceMap};
use crate::start;
use crate::table::Table;
use crate::text::SourceText;

/// Reads a scene file.
///
/// `source_name` is what diagnostics call it, usually its path; `registry` has the joints and forces that it may name.
///
/// # Errors
/// Everything that is wrong with the text, in the order of the text. A file that is not TOML is judged no further than
/// that. A scene without problems is a description that [`model::Mechanism::build`] accepts.
///
/// ```
/// use model::Registry;
/// let text = "[[body]]\nname = \"crank\"\nmas = 2.0\ninertia = 0.1\n";
/// let problems = scene::read("crank.toml", text, &Registry::planar()).err().unwrap();
/// let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
/// assert_eq!(lines, [
///     "crank.toml:1:1: error: the scene needs the section `[scene]`",
///     "crank.toml:1:1: error: body `crank` needs the key `mass`: a number ≥ 0",
///     "crank.toml:3:1: error: body `crank` has no key `mas`",
/// ]);
/// assert_eq!(problems[2].primary.text, "did you mean `mass`?");
/// ```
pub fn read(source_name: &str, text: &str, registry: &Registry) -> Result<Scene, Vec<Diagnostic>> {
    let source = SourceText::new(source_name, text);
    let mut findings = Findings::new(&source);
    let (root, errors) = DeTable::parse_recoverable(text);
    for error in &errors {
        let span = error.span().unwrap_or(0..0);
        findings.error(span, error.message(), "not valid TOML");
    }
    if !errors.is_empty() {
        return Err(findings.sorted());
    }
    let whole = Table::new("the scene".to_owned(), 0..0, root.get_ref());
    let scene = document(whole, registry, &mut findings);
    let problems = findings.sorted();
    match scene {
        Some(scene) if problems.is_empty() => Ok(scene),
        _ => Err(problems),
    }
}

/// Reads all sections. The result is to be used only if nothing was found.
fn document(mut root: Table, registry: &Registry, findings: &mut Findings) -> Option<Scene> {
    let mut sections = BTreeMap::new();
    let head = section(&mut root, "scene", &mut sections, findings);
    if head.is_none() && root.optional("scene").is_none() {
        let message = "the scene needs the section `[scene]`";
        findings.error(0..0, message, "`[scene]` is missing in this file");
    }
    let (name, gravity) = head.map_or((String::new(), [0.0; 2]), |head| heading(head, findings));

    let mut names = Names::default();
    let mut domains = Vec::new();
    let mut bodies = Bodies::default();
    for (table, name) in list(&mut root, "body", findings) {
        names.bodies.push(Entry::of(&name, &table));
        bodies.read(table, &name, findings);
    }
    let mut joints = Joints::default();
    for (table, name) in list(&mut root, "joint", findings) {
        names.elements.push(Entry::of(&name, &table));
        joints.read(table, &name, registry, &bodies, &mut domains, findings);
    }
    let mut drives = Drives::default();
    let mut reactions = reaction_names(&joints);
    let drive_tables = list(&mut root, "drive", findings);
    let drive_names: Vec<String> = drive_tables.iter().map(|(_, name)| name.clone()).collect();
    for (table, name) in drive_tables {
        names.elements.push(Entry::of(&name, &table));
        drives.read(table, &name, &joints, &mut domains, findings);
    }
    reactions.extend(drive_names.iter().map(|name| {
        let drive = drives.list.iter().find(|drive| drive.name == *name);
        let components = drive.map(|drive| components(drive.element.element().spec()));
        ReactionNames { name, components }
    }));
    let mut forces = Forces::default();
    for (table, name) in list(&mut root, "force", findings) {
        names.elements.push(Entry::of(&name, &table));
        forces.read(table, &name, registry, &bodies, &mut domains, findings);
    }

    let (mut groups, mut group_entries) = (Vec::new(), Vec::new());
    for (table, name) in list(&mut root, "group", findings) {
        names.groups.push(Entry::of(&name, &table));
        let entry = Entry::of(&name, &table);
        if let Some(group) = reactions::group(table, &name, &reactions, findings) {
            groups.push(group);
            group_entries.push(entry);
        }
    }
    let start = section(&mut root, "start", &mut sections, findings)
        .map_or_else(StartOptions::default, |t| start::read(t, &bodies, findings));
    let output = section(&mut root, "output", &mut sections, findings)
        .map_or_else(Output::default, |t| {
            reactions::output(t, &reactions, findings)
        });
    let simulate = section(&mut root, "simulate", &mut sections, findings)
        .and_then(|t| simulate::read(t, findings));
    root.close(findings);

    let description = Description {
        name,
        gravity,
        bodies: bodies.list,
        joints: joints.list,
        drives: drives.list,
        forces: forces.list,
    };
    let source = SourceMap {
        text: findings.source.clone(),
        bodies: bodies.entries,
        joints: joints.entries,
        drives: drives.entries,
        forces: forces.entries,
        groups: group_entries,
        sections,
    };
    names.check(&source, findings);
    check(&description, &source, simulate.as_ref(), findings);
    if let Some(simulate) = &simulate {
        simulate.check_domains(&domains, findings);
    }
    Some(Scene {
        description,
        start,
        simulate: simulate.map(|simulate| simulate.options),
        output,
        groups,
        source,
    })
}

/// `[scene]`: name and gravity.
fn heading(mut table: Table, findings: &mut Findings) -> (String, [f64; 2]) {
    const PLANE: &str = "plane";
    let name = table
        .required("name", "the name of the scene", findings)
        .and_then(|field| field.text("the name of the scene", findings));
    let space = table.required("space", "\"plane\"", findings);
    if let Some(field) = space
        && let Some(space) = field.text("\"plane\"", findings)
        && space != PLANE
    {
        findings.error(
            field.span(),
            format!("`[scene]`: `space` is \"{space}\", only \"{PLANE}\" is available"),
            "not available",
        );
    }
    let gravity = table
        .optional("gravity")
        .and_then(|field| field.pair("an acceleration [gx, gy]", findings));
    table.close(findings);
    (
        name.unwrap_or_default().to_owned(),
        gravity.unwrap_or_default(),
    )
}

/// A table that occurs once, if it is given.
fn section<'t>(
    root: &mut Table<'t>,
    name: &str,
    sections: &mut BTreeMap<String, Entry>,
    findings: &mut Findings,
) -> Option<Table<'t>> {
    let field = root.optional(name)?;
    let mut table = field.table(&format!("one table `[{name}]`"), findings)?;
    table.subject = format!("`[{name}]`");
    sections.insert(name.to_owned(), Entry::of(name, &table));
    Some(table)
}

/// Tables that may occur many times, with the names of what they describe.
fn list<'t>(root: &mut Table<'t>, kind: &str, findings: &mut Findings) -> Vec<(Table<'t>, String)> {
    let expected = format!("a list of tables `[[{kind}]]`");
    let Some(field) = root.optional(kind) else {
        return Vec::new();
    };
    let items = match field.value.get_ref().is_table() {
        // One pair of brackets too few: say so, and read on.
        true => {
            field.mismatch(&expected, findings);
            vec![field]
        }
        false => field.items(&expected, findings).unwrap_or_default(),
    };
    let numbered = items.iter().enumerate();
    numbered
        .filter_map(|(k, item)| named(item, kind, k + 1, findings))
        .collect()
}

/// A table with its name, or with its number where it has none.
fn named<'t>(
    item: &Field<'t>,
    kind: &str,
    number: usize,
    findings: &mut Findings,
) -> Option<(Table<'t>, String)> {
    let mut table = item.table(&format!("a list of tables `[[{kind}]]`"), findings)?;
    table.subject = format!("{kind} number {number}");
    let name = table
        .required("name", "a text", findings)
        .and_then(|field| {
            let name = field.text("a text", findings)?;
            if name.trim().is_empty() {
                let message = format!("{}: `name` is empty", table.subject);
                findings.error(field.span(), message, "expected a name");
                return None;
            }
            Some(name)
        });
    let name = match name {
        Some(name) => {
            table.subject = format!("{kind} `{name}`");
            name.to_owned()
        }
        None => table.subject.clone(),
    };
    Some((table, name))
}

fn reaction_names<'a>(joints: &'a Joints) -> Vec<ReactionNames<'a>> {
    let name = |joint: &'a crate::joint::Known| ReactionNames {
        name: &joint.entry.name,
        components: joint.definition.map(|d| components(d.spec)),
    };
    joints.known.iter().map(name).collect()
}

/// Names of everything, complete or not, in their spaces.
#[derive(Default)]
struct Names {
    bodies: Vec<Entry>,
    elements: Vec<Entry>,
    groups: Vec<Entry>,
}

impl Names {
    /// Reports names that are used twice, and `ground`.
    fn check(&self, map: &SourceMap, findings: &mut Findings) {
        for entry in self.bodies.iter().chain(&self.elements) {
            if entry.name == GROUND {
                findings.error(
                    entry.name_span(),
                    BuildError::Ground.to_string(),
                    "choose another name",
                );
            }
        }
        for space in [&self.bodies, &self.elements, &self.groups] {
            let mut uses: BTreeMap<&str, Vec<Range<usize>>> = BTreeMap::new();
            for entry in space.iter().filter(|entry| entry.name != GROUND) {
                uses.entry(&entry.name).or_default().push(entry.name_span());
            }
            for (name, uses) in uses {
                let name = name.to_owned();
                let error = BuildError::DuplicateName { name };
                for diagnostic in locate::duplicates(map, &uses, &error) {
                    findings.report(diagnostic);
                }
            }
        }
    }
}

/// Reports what the mechanism refuses. Names have been checked, also those of what could not be read.
fn check(
    description: &Description,
    source: &SourceMap,
    simulate: Option<&Simulate>,
    findings: &mut Findings,
) {
    let errors = match Mechanism::build(description) {
        Ok(mechanism) => {
            // With a joint missing the rows are not those of the file.
            if let Some(simulate) = simulate
                && findings.is_empty()
            {
                simulate.check_rows(mechanism.layout().rows(), findings);
            }
            return;
        }
        Err(errors) => errors,
    };
    let of_drive = |of: &str| description.drives.iter().any(|drive| drive.name == of);
    for error in errors {
        match &error {
            BuildError::DuplicateName { .. } | BuildError::Ground => {}
            // Its joint has them too.
            BuildError::SameBody { name, .. } | BuildError::GroundOnly { name }
                if of_drive(name) => {}
            _ => findings.report(locate::build(source, description, &error)),
        }
    }
}
