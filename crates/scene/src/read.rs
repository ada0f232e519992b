//! From a text to a scene, or to all of its problems.

mod syntax;

use std::collections::{BTreeMap, HashMap};

use joints::{Plane, Space, Space3};
use model::{
    AnyDescription, BuildError, Described, Mechanism, Observed, Registry, StartOptions, Stated,
    Tolerance,
};
use toml::de::DeTable;

use crate::active;
use crate::bodies::Bodies;
use crate::body::SceneBody;
use crate::combination::{ReactionNames, Reactions};
use crate::dependent::{self, Found, Kind};
use crate::diagnostic::Diagnostic;
use crate::element::Types;
use crate::findings::Findings;
use crate::force::Forces;
use crate::function::Domain;
use crate::joint::{Drives, JointNames, Joints};
use crate::key::{Key, Takes};
use crate::language::{self, Language, LengthUnit, Units};
use crate::limits;
use crate::locate;
use crate::measure::Measures;
use crate::mistake::Mistake;
use crate::names::{Names, Use};
use crate::nearest::{did_you_mean, list, nearest};
use crate::plausible;
use crate::reactions::{self, GroupRequest, components};
use crate::scene::Scene;
use crate::section::{self, section, tables};
use crate::silence;
use crate::simulate;
use crate::source_map::{Entry, SourceMap};
use crate::space::SceneSpace;
use crate::spring;
use crate::start;
use crate::table::Table;
use crate::text::SourceText;
use crate::tolerance;

/// Reads a scene file.
///
/// `source_name` is the name in diagnostics, usually the path; `registry` contains the joints and
/// forces that the text may use.
///
/// # Errors
/// All problems of the text, in the order of the text. If a file is not TOML, only that is
/// reported. A scene without problems is a description that [`model::Mechanism::build`] accepts.
///
/// ```
/// use model::Registry;
/// let text = "[[body]]\nname = \"crank\"\nmas = 2.0\ninertia = 0.1\n";
/// let problems = pfaff_scene::read("crank.toml", text, &Registry::standard()).err().unwrap();
/// let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
/// assert_eq!(lines, [
///     "crank.toml:1:1: error: the scene needs the section `[scene]`",
///     "crank.toml:3:1: error: body `crank` has no key `mas`",
/// ]);
/// assert_eq!(problems[1].primary.text, "did you mean `mass`?");
/// ```
pub fn read(source_name: &str, text: &str, registry: &Registry) -> Result<Scene, Vec<Diagnostic>> {
    let source = SourceText::new(source_name, text);
    let mut findings = Findings::new(&source);
    if let Some(excess) = limits::excess(text) {
        findings.error(Mistake::TooLarge, excess.span, excess.message, excess.label);
        return Err(findings.sorted());
    }
    let (root, errors) = DeTable::parse_recoverable(text);
    syntax(&errors, &mut findings);
    if !errors.is_empty() {
        return Err(findings.sorted());
    }
    let plain = Language::PLAIN;
    let mut whole = Table::new("the scene", 0..0, root.get_ref(), &plain);
    let language = Language::read(&mut whole, &mut findings);
    let whole = Table::new("the scene", 0..0, root.get_ref(), &language);
    let mut scene = if is_spatial(root.get_ref()) {
        document::<Space3>(whole, registry, &mut findings)
    } else {
        document::<Plane>(whole, registry, &mut findings)
    };
    scene.units = language.units;
    let unit = language.length_unit();
    drop(language);
    // Large compared with what was read from it.
    drop(root);
    if let Some(source) = &scene.source {
        check(&scene.description, source, unit, &mut findings);
    }
    scene.take_out_inactive();
    scene.scales = findings.take_scales();
    scene.warnings = findings.take_warnings();
    let problems = findings.sorted();
    if problems.is_empty() {
        Ok(scene)
    } else {
        Err(problems)
    }
}

/// Reports text that is not TOML, one error for each line. An error at the end of the text means
/// that a bracket was never closed: only the first error shows where, and the others are its
/// consequences.
fn syntax(errors: &[toml::de::Error], findings: &mut Findings) {
    let source = findings.source;
    let text = source.text();
    let end = text.trim_end().len();
    let start = |error: &toml::de::Error| error.span().map_or(0, |span| span.start);
    let never_closed = errors.iter().any(|error| start(error) >= end);
    if never_closed && let Some(fault) = syntax::never_closed(text, start(&errors[0])) {
        return say(fault, findings);
    }
    let mut line = 0;
    for (k, error) in errors.iter().enumerate() {
        let here = findings.line(start(error));
        if (never_closed && k > 0) || here == line {
            continue;
        }
        line = here;
        let span = error.span().unwrap_or(0..0);
        let fault = match error.message() {
            "duplicate key" => syntax::twice(text, span.clone()),
            _ => syntax::fault(text, span.clone()),
        };
        match fault {
            Some(fault) => say(fault, findings),
            None => {
                findings.error(Mistake::NotToml, span, error.message(), "not valid TOML");
            }
        }
    }
}

fn say(fault: syntax::Fault, findings: &mut Findings) {
    let syntax::Fault {
        span,
        message,
        label,
        help,
    } = fault;
    findings.error_with_help(Mistake::NotToml, span, message, label, help);
}

/// Whether the scene says that its bodies move in space. Where it says nothing or another word, the
/// first position or point tells by its numbers, so that one mistake is not followed by many; and
/// without one, what the word may mean.
fn is_spatial(root: &DeTable) -> bool {
    let heading = root.get(section::SCENE.name);
    let space = heading.and_then(|heading| heading.get_ref().get(SPACE.name));
    let space = space.and_then(|space| space.get_ref().as_str());
    if let Some(known) = spaces().into_iter().find(|known| space == Some(*known)) {
        return known == Space3::NAME;
    }
    let points = [("body", "position"), ("joint", "at")].map(|(section, key)| {
        let entries = root.get(section).and_then(|all| all.get_ref().as_array());
        let points = entries.into_iter().flatten();
        let mut points = points.filter_map(|entry| entry.get_ref().get(key)?.get_ref().as_array());
        points.next().map(|point| point.len())
    });
    match points.into_iter().flatten().next() {
        Some(numbers) => numbers == Space3::DIM,
        None => space.and_then(|space| nearest(space, spaces())) == Some(Space3::NAME),
    }
}

/// Reads all sections. The result may be used only if no problem was found.
fn document<S: SceneBody>(mut root: Table, registry: &Registry, findings: &mut Findings) -> Scene {
    let mut sections = BTreeMap::new();
    let head = section(&mut root, &section::SCENE, &mut sections, findings);
    if head.is_none() && root.optional(section::SCENE.name).is_none() {
        let message = "the scene needs the section `[scene]`";
        let label = "`[scene]` is missing in this file";
        root.lacks(section::SCENE.name, message, label, findings);
    }
    let heading = head.map_or_else(Heading::<S>::default, |head| Heading::read(head, findings));
    section(&mut root, &section::PARAMETERS, &mut sections, findings);
    let mut parts = Parts::<S>::read(&mut root, registry, findings);
    let (groups, group_entries) = groups(&mut root, &mut parts, findings);
    let start = section(&mut root, &section::START, &mut sections, findings)
        .map(|table| start::read::<S>(table, &parts.bodies.names, findings));
    let output = section(&mut root, &section::OUTPUT, &mut sections, findings)
        .map(|table| reactions::output(table, &parts.reactions(Asked::Active), findings));
    let simulate = section(&mut root, &section::SIMULATE, &mut sections, findings)
        .and_then(|table| simulate::read(table, findings));
    if parts.bodies.list.is_empty() {
        let label = "no `[[body]]` in this scene";
        let message = BuildError::NoBodies.to_string();
        root.lacks(section::BODY.name, message, label, findings);
    }
    root.close(findings);
    if let Some(simulate) = &simulate {
        simulate.check_domains(&parts.domains, findings);
        if let Some(rows) = parts.rows() {
            simulate.check_rows(rows, findings);
        }
    }
    let description = S::described(Described {
        name: heading.name,
        gravity: heading.gravity,
        tolerance: heading.tolerance,
        observed: Observed {
            markers: parts.bodies.markers.list,
            measures: parts.measures.list,
        },
        bodies: parts.bodies.list,
        joints: parts.joints.list,
        drives: parts.drives.list,
        forces: parts.forces.list,
    });
    let source = SourceMap {
        text: findings.source.clone(),
        markers: parts.bodies.markers.entries,
        measures: parts.measures.entries,
        bodies: parts.bodies.names.entries,
        joints: parts.joints.entries,
        drives: parts.drives.entries,
        forces: parts.forces.entries,
        groups: group_entries,
        sections,
    };
    parts.names.check(&source, findings);
    Scene {
        description,
        start: StartOptions {
            poses: parts.bodies.poses,
            ..start.unwrap_or_default()
        },
        simulate: simulate.map(|simulate| simulate.options),
        output: output.unwrap_or_default(),
        groups,
        source: Some(source),
        units: Units::SI,
        scales: Vec::new(),
        inactive: Vec::new(),
        warnings: Vec::new(),
    }
}

/// The parts of the mechanism.
struct Parts<'r, S: SceneBody> {
    bodies: Bodies<S>,
    measures: Measures,
    joints: Joints<'r, S>,
    drives: Drives<S>,
    forces: Forces<S>,
    names: Names,
    domains: Vec<Domain>,
}

impl<'r, S: SceneBody> Parts<'r, S> {
    fn read(root: &mut Table, registry: &'r Registry, findings: &mut Findings) -> Self {
        let mut parts = Self {
            bodies: Bodies::default(),
            measures: Measures::default(),
            joints: Joints::default(),
            drives: Drives::default(),
            forces: Forces::default(),
            names: Names::of(S::KIND),
            domains: Vec::new(),
        };
        let Self {
            bodies,
            measures,
            joints,
            drives,
            forces,
            names,
            domains,
        } = &mut parts;
        for (table, name) in tables(root, &section::BODY, findings) {
            names.bodies.push(Use::of(&name, &table));
            bodies.read(table, &name, findings);
        }
        for (table, name) in tables(root, &section::MARKER, findings) {
            names.bodies.push(Use::of(&name, &table));
            bodies
                .markers
                .read::<S>(table, &name, &bodies.names, findings);
        }
        for (table, name) in tables(root, &section::MEASURE, findings) {
            names.bodies.push(Use::of(&name, &table));
            names.measures.push(Use::of(&name, &table));
            measures.read(table, &name, S::KIND, &bodies.markers, findings);
        }
        let types = Types::of_joints(registry);
        let mut dependent = Vec::new();
        for (table, name) in tables(root, &section::JOINT, findings) {
            names.elements.push(Use::of(&name, &table));
            match Kind::of(&table, &types) {
                Some(kind) => dependent.push(Found::behind(kind, table, name, joints)),
                None => joints.read(table, &name, &types, bodies, domains, findings),
            }
        }
        dependent::read(dependent, bodies, joints, findings);
        let by_name = JointNames::of(joints);
        for (table, name) in tables(root, &section::DRIVE, findings) {
            names.elements.push(Use::of(&name, &table));
            drives.read(table, &name, &by_name, domains, findings);
        }
        *forces = std::mem::take(&mut drives.laws);
        let types = Types::of_forces(registry);
        for (table, name) in tables(root, &section::FORCE, findings) {
            names.elements.push(Use::of(&name, &table));
            if spring::is_meant::<S>(&table) {
                forces.read_spring(table, &name, &by_name, findings);
            } else {
                forces.read(table, &name, &types, bodies, domains, findings);
            }
        }
        joints.leave_out(&drives.replaced);
        parts
    }

    /// Joints and drives by name, including those that could not be read: all, or those that take
    /// part.
    fn reactions(&self, of: Asked) -> Reactions<'_> {
        let is_wanted = |is_active: bool| is_active || of == Asked::All;
        let joints = self.joints.known.iter().map(|joint| {
            let names = ReactionNames {
                name: &joint.name,
                components: joint
                    .definition
                    .map(|d| components(self.names.space, d.spec)),
            };
            (names, joint.is_active)
        });
        let complete = self.drives.list.iter();
        let complete: HashMap<&str, _> = complete
            .map(|drive| (drive.name.as_str(), drive.element.spec()))
            .collect();
        let drives = self.drives.known.iter().map(|(name, is_active)| {
            let names = ReactionNames {
                name,
                components: complete
                    .get(name.as_str())
                    .map(|spec| components(self.names.space, spec)),
            };
            (names, *is_active)
        });
        let (wanted, others): (Vec<_>, Vec<_>) = joints
            .chain(drives)
            .partition(|(_, is_active)| is_wanted(*is_active));
        let wanted = wanted.into_iter().map(|(names, _)| names).collect();
        Reactions::new(wanted).without(others.into_iter().map(|(names, _)| names.name))
    }

    /// Number of rows, if all joints and drives could be read.
    fn rows(&self) -> Option<usize> {
        let complete = self.joints.list.len() == self.joints.known.len()
            && self.drives.list.len() == self.drives.known.len();
        let joints = self.joints.list.iter().map(|joint| &joint.element);
        let joints = joints.zip(&self.joints.entries);
        let drives = self.drives.list.iter().map(|drive| &drive.element);
        let all = joints.chain(drives.zip(&self.drives.entries));
        let active = all.filter(|(_, entry)| entry.is_active);
        complete.then(|| active.map(|(e, _)| e.spec().rows.len()).sum())
    }
}

/// Which joints and drives may be named.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asked {
    All,
    Active,
}

/// Groups with their places.
fn groups<S: SceneBody>(
    root: &mut Table,
    parts: &mut Parts<S>,
    findings: &mut Findings,
) -> (Vec<GroupRequest>, Vec<Entry>) {
    let found = tables(root, &section::GROUP, findings);
    let mut entries = Vec::with_capacity(found.len());
    parts.names.groups = found.iter().map(|(t, name)| Use::of(name, t)).collect();
    if found.is_empty() {
        return (Vec::new(), entries);
    }
    let (all, active) = (parts.reactions(Asked::All), parts.reactions(Asked::Active));
    let mut groups = Vec::with_capacity(found.len());
    for (mut table, name) in found {
        let is_active = active::read(&mut table, findings);
        entries.push(Entry::switched(&name, &table, is_active));
        let names = if is_active { &active } else { &all };
        groups.extend(reactions::group(table, &name, names, findings));
    }
    (groups, entries)
}

/// The spaces of scenes.
fn spaces() -> Vec<&'static str> {
    vec![Plane::NAME, Space3::NAME]
}

const NAME: Key = Key::required("name", "the name of the scene", Takes::Text)
    .doc("The name of the scene, as reports and figures say it");
const SPACE: Key = Key::required("space", "\"plane\" or \"spatial\"", Takes::OneOf(spaces))
    .doc("The space of the bodies");

/// Keys of `[scene]`, in addition to gravity and those of tolerances.
pub(crate) const SCENE_KEYS: [Key; 2] = [NAME, SPACE];

/// `[scene]`
struct Heading<S: SceneSpace> {
    name: String,
    gravity: S::Vector<f64>,
    tolerance: Tolerance,
}

impl<S: SceneSpace> Default for Heading<S> {
    fn default() -> Self {
        Self {
            name: String::new(),
            gravity: S::vector([0.0; 3]),
            tolerance: Tolerance::default(),
        }
    }
}

impl<S: SceneSpace> Heading<S> {
    fn read(mut table: Table, findings: &mut Findings) -> Self {
        let name = table.required(&NAME, findings).and_then(|field| {
            let name = field.text(NAME.expected, findings)?;
            if let Some((reason, label)) = section::unfit(name) {
                let message = format!("`[scene]`: `name` {reason}");
                findings.error(Mistake::UnfitName, field.span(), message, label);
            }
            Some(name.to_owned())
        });
        let space = table.required(&SPACE, findings);
        if let Some(field) = space
            && let Some(space) = field.text(SPACE.expected, findings)
            && space != S::NAME
        {
            let known = list(spaces());
            findings.error(
                Mistake::UnknownChoice,
                field.span(),
                format!("`[scene]`: `space` is \"{space}\", there are {known}"),
                did_you_mean(space, spaces()).unwrap_or_else(|| "no such space".to_owned()),
            );
        }
        let gravity = table.optional(&S::GRAVITY).and_then(|field| {
            let Key { expected, unit, .. } = S::GRAVITY;
            let gravity = field.vector::<S>(expected, unit, findings)?;
            plausible::gravity(&field, gravity.as_ref(), findings);
            Some(gravity)
        });
        let tolerance = tolerance::of_scene(&mut table, findings);
        for key in &language::read::SCENE_KEYS {
            table.optional(key);
        }
        silence::read(&mut table, findings);
        table.close(findings);
        Self {
            name: name.unwrap_or_default(),
            gravity: gravity.unwrap_or_else(|| S::vector([0.0; 3])),
            tolerance,
        }
    }
}

/// Reports what the mechanism refuses, or else what is not plausible in it. The existence of
/// bodies has already been checked, and so have names, including those of tables that could not be
/// read.
fn check(
    description: &AnyDescription,
    source: &SourceMap,
    unit: LengthUnit,
    findings: &mut Findings,
) {
    let errors = match Mechanism::build(description) {
        Ok(built) => return plausible::check(&built, source, unit, findings),
        Err(errors) => errors,
    };
    let of_drive = |of: &str| description.drives().any(|(drive, _)| drive == of);
    for (said, error) in errors.iter().enumerate() {
        if findings.is_full() {
            return findings.count(errors.len() - said);
        }
        match error {
            BuildError::DuplicateName { .. } | BuildError::Ground | BuildError::NoBodies => {}
            // Its joint has the same problem.
            BuildError::Tolerance {
                of: Stated::Drive(_),
                ..
            } => {}
            // Its joint has the same problem.
            BuildError::SameBody { name, .. } | BuildError::GroundOnly { name }
                if of_drive(name) => {}
            _ => findings.report(locate::build(source, description, error)),
        }
    }
}
