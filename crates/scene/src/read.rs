//! Reads the text of a scene, or returns all problems in the text.

mod syntax;

use std::collections::BTreeMap;
use std::mem::discriminant;

use joints::{Plane, Space3};
use model::space::norm;
use model::{
    AnyDescription, BuildError, Mechanism, MechanismDescription, Observables, Registry,
    StartOptions, ToleranceScope,
};
use toml::de::DeTable;

use crate::active::{self, ACTIVE};
use crate::body::SceneBody;
use crate::case;
use crate::diagnostic::Diagnostic;
use crate::drive::DriveRead;
use crate::findings::Findings;
use crate::heading::{Heading, is_spatial};
use crate::language::{Language, LengthUnit, Units};
use crate::limits;
use crate::locate;
use crate::mistake::Mistake;
use crate::names::NameUse;
use crate::parts::{Participation, Parts};
use crate::plausible;
use crate::reactions::{self, GroupRequest, Output};
use crate::scene::Scene;
use crate::section::{self, section, tables};
use crate::simulate;
use crate::source_map::{Entry, SourceMap};
use crate::start;
use crate::table::Table;
use crate::text::SourceText;

/// Reads a scene file.
///
/// `source_name` is the name in diagnostics, usually the path. `registry` contains the joints and
/// forces that are permitted in the text.
///
/// # Errors
/// Returns an error with all problems of the text, in the order of the text. If the text is not
/// valid TOML, only this problem is reported. If there is no problem, [`model::Mechanism::build`]
/// accepts the description.
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
    checked(source_name, text, registry).map(|(scene, _)| scene)
}

/// Works like [`read()`], but also returns the mechanism of the scene, which was built to check the
/// text.
///
/// # Errors
/// Returns the same errors as [`read()`].
///
/// ```
/// use model::Registry;
/// let text = "scene = { name = \"stone\", space = \"plane\" }\n\
///             body = [{ name = \"stone\", mass = 1.0, inertia = 1.0 }]";
/// let read = pfaff_scene::read_and_build("stone.toml", text, &Registry::standard());
/// let (scene, mechanism) = read.expect("a scene");
/// assert_eq!((scene.name(), mechanism.bodies().len()), ("stone", 1));
/// ```
pub fn read_and_build(
    source_name: &str,
    text: &str,
    registry: &Registry,
) -> Result<(Scene, Mechanism), Vec<Diagnostic>> {
    let (scene, mechanism) = checked(source_name, text, registry)?;
    if scene.inactive.is_empty() {
        return Ok((scene, mechanism));
    }
    // The mechanism that was built for the check also contains the inactive parts.
    match Mechanism::build(&scene.description) {
        Ok(mechanism) => Ok((scene, mechanism)),
        Err(errors) => Err(errors
            .iter()
            .filter_map(|e| scene.locate_build(e))
            .collect()),
    }
}

/// Reads a scene and builds the mechanism of all parts, including inactive parts.
fn checked(
    source_name: &str,
    text: &str,
    registry: &Registry,
) -> Result<(Scene, Mechanism), Vec<Diagnostic>> {
    let source = SourceText::new(source_name, text);
    let findings = Findings::new(&source);
    if let Some(excess) = limits::excess(text) {
        findings.error(Mistake::TooLarge, excess.span, excess.message, excess.label);
        return Err(findings.sorted());
    }
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        syntax::report(&errors, &findings);
        return Err(findings.sorted());
    }
    let plain = Language::PLAIN;
    let mut whole = Table::new("the scene", 0..0, root.get_ref(), (&plain, &findings));
    let language = Language::read(&mut whole);
    let whole = Table::new("the scene", 0..0, root.get_ref(), (&language, &findings));
    let mut scene = if is_spatial(root.get_ref()) {
        document::<Space3>(whole, registry)
    } else {
        document::<Plane>(whole, registry)
    };
    scene.units = language.units;
    let unit = language.length_unit();
    drop(language);
    // The parsed text needs much more memory than the scene, so it is freed here.
    drop(root);
    let mechanism = match &scene.source {
        Some(source) => check(&scene.description, source, unit, &findings),
        None => None,
    };
    scene.take_out_inactive();
    scene.scales = findings.take_scales();
    scene.warnings = findings.take_warnings();
    if let Some(source) = &mut scene.source {
        source.silenced = findings.take_silenced();
    }
    match (mechanism, findings.sorted()) {
        (Some(mechanism), problems) if problems.is_empty() => Ok((scene, mechanism)),
        (_, problems) => Err(problems),
    }
}

/// Reads all sections. The result may be used only if no problem was found.
fn document<S: SceneBody>(mut root: Table, registry: &Registry) -> Scene {
    let findings = root.findings;
    let mut sections = BTreeMap::new();
    let head = section(&mut root, &section::SCENE, &mut sections);
    if head.is_none() && root.optional(section::SCENE.name).is_none() {
        let message = "the scene needs the section `[scene]`";
        let label = "`[scene]` is missing in this file";
        root.lacks(section::SCENE.name, message, label);
    }
    let heading = head.map_or_else(Heading::<S>::default, |head| Heading::read(head));
    section(&mut root, &section::PARAMETERS, &mut sections);
    let mut parts = Parts::<S>::read(&mut root, registry);
    let (groups, group_entries) = groups(&mut root, &mut parts);
    let cases = case::read(&mut root, findings);
    let start = section(&mut root, &section::START, &mut sections)
        .map(|table| start::read::<S>(table, &parts.bodies.names));
    let (start, start_time) = start.unwrap_or_default();
    let output = section(&mut root, &section::OUTPUT, &mut sections).map(|table| {
        reactions::output::<S>(
            table,
            &parts.reactions(Participation::Active),
            &parts.bodies.names,
        )
    });
    let simulate = section(&mut root, &section::SIMULATE, &mut sections)
        .and_then(|table| simulate::read(table));
    if parts.bodies.list.is_empty() {
        let label = "no `[[body]]` in this scene";
        let message = BuildError::NoBodies.to_string();
        root.lacks(section::BODY.name, message, label);
    }
    root.close();
    if let Some(simulate) = &simulate {
        simulate.check_domains(&parts.domains, findings);
        if let Some(rows) = parts.rows() {
            simulate.check_rows(rows, findings);
        }
    }
    let masses = parts.bodies.list.iter().map(S::mass);
    let weight = masses.sum::<f64>() * norm(heading.gravity.as_ref());
    let t_end = simulate.as_ref().map_or(0.0, |run| run.options.t_end);
    plausible::forces::applied(&parts.forces, weight, t_end, findings);
    let (measures, measure_entries) = parts.measures.into_iter().unzip();
    let joints = parts.joints.into_iter();
    let mut centres = Vec::new();
    let joints = joints.filter_map(|read| read.complete);
    let mut armatures = Vec::new();
    let joints = joints.map(|own| {
        centres.extend(own.centre);
        armatures.extend(own.armatures);
        (own.joint, own.entry)
    });
    let (joints, joint_entries) = joints.unzip();
    let drives = parts.drives.into_iter();
    let (drives, drive_entries) = drives.filter_map(DriveRead::into_motion).unzip();
    let (forces, force_entries) = parts.forces.into_iter().unzip();
    let description = S::described(MechanismDescription {
        name: heading.name,
        gravity: heading.gravity,
        tolerance: heading.tolerance,
        observed: Observables {
            markers: parts.bodies.markers.list,
            measures,
        },
        bodies: parts.bodies.list,
        joints,
        drives,
        forces,
        start_time,
        controllers: Vec::new(),
        armatures,
    });
    let source = SourceMap {
        silenced: Vec::new(),
        text: findings.source.clone(),
        markers: parts.bodies.markers.entries,
        measures: measure_entries,
        bodies: parts.bodies.names.entries,
        joints: joint_entries,
        drives: drive_entries,
        forces: force_entries,
        groups: group_entries,
        sections,
    };
    if let Some(output) = &output {
        parts.names.rates = output.accelerations;
        parts.names.angles = output.rpy;
    }
    parts.names.check(&source, findings);
    Scene {
        description,
        start: StartOptions {
            poses: parts.bodies.poses,
            ..start
        },
        simulate: simulate.map(|simulate| simulate.options),
        output: Output {
            cover: heading.cover,
            ..output.unwrap_or_default()
        },
        centres,
        groups,
        cases,
        source: Some(source),
        units: Units::SI,
        scales: Vec::new(),
        inactive: Vec::new(),
        warnings: Vec::new(),
    }
}

/// Reads the groups, with their positions in the text.
fn groups<S: SceneBody>(root: &mut Table, parts: &mut Parts<S>) -> (Vec<GroupRequest>, Vec<Entry>) {
    let found = tables(root, &section::GROUP);
    let mut entries = Vec::with_capacity(found.len());
    parts.names.groups = found.iter().map(|(t, name)| NameUse::of(name, t)).collect();
    if found.is_empty() {
        return (Vec::new(), entries);
    }
    let (all, active) = (
        parts.reactions(Participation::Any),
        parts.reactions(Participation::Active),
    );
    let mut groups = Vec::with_capacity(found.len());
    for (mut table, name) in found {
        let is_active = active::read(&table);
        table.optional(&ACTIVE);
        entries.push(Entry::switched(&name, &table, is_active));
        let names = if is_active { &active } else { &all };
        groups.extend(reactions::group(table, &name, names));
    }
    (groups, entries)
}

/// Builds the mechanism for a check. Reports the errors of the build. If there are no errors,
/// reports implausible values of the mechanism. The reader checked earlier that bodies exist, and
/// it checked all names, including the names in unreadable tables.
fn check(
    description: &AnyDescription,
    source: &SourceMap,
    unit: LengthUnit,
    findings: &Findings,
) -> Option<Mechanism> {
    let errors = match Mechanism::build(description) {
        Ok(built) => {
            plausible::check(&built, source, unit, findings);
            return Some(built);
        }
        Err(errors) => errors,
    };
    let is_of_drive = |error: &BuildError| match error {
        BuildError::Tolerance { of, .. } => matches!(of, ToleranceScope::Drive(_)),
        BuildError::SameBody { name, .. } | BuildError::GroundOnly { name } => {
            description.drives().any(|(drive, _)| drive == name)
        }
        _ => false,
    };
    // The joint of a drive has the same problem, unless the drive replaces the joint.
    let is_repeated = |error: &BuildError| {
        let mut same = errors
            .iter()
            .filter(|e| discriminant(*e) == discriminant(error));
        is_of_drive(error) && same.any(|other| !is_of_drive(other))
    };
    for (said, error) in errors.iter().enumerate() {
        if findings.is_full() {
            findings.count(errors.len() - said);
            return None;
        }
        match error {
            BuildError::DuplicateName { .. } | BuildError::Ground | BuildError::NoBodies => {}
            _ if is_repeated(error) => {}
            _ => findings.report(locate::build(source, description, error)),
        }
    }
    None
}
