//! Drives from the actuators of a file.

use std::collections::HashSet;

use crate::findings::Findings;
use crate::mechanism::{Actuator, Drive, Model};
use crate::options::Drives;

/// Kind of omission for the content of an actuator that its drive does not contain.
const CONTENT: &str = "gear ratios, laws and limits of actuators: a drive acts on the joint itself";

/// Kinds of omission for actuators without a drive.
const DEPENDENT: &str = "actuators of joints that follow other joints or are locked";
const SECOND: &str = "further actuators of joints that have a drive";

/// Adds a drive for each actuator, on its joint coordinate. Coordinates that couplings determine
/// have no drive. If a file has no actuators and its format does not require them, each joint with
/// one freedom has a drive.
pub(crate) fn add(model: &mut Model, drives: Drives, format: &str, findings: &mut Findings) {
    if drives == Drives::None {
        return;
    }
    let dependent: HashSet<(usize, usize)> = model
        .couplings
        .iter()
        .filter(|coupling| coupling.is_active)
        .map(|coupling| coupling.y)
        .collect();
    let is_assumed = model.actuators.is_empty() && format != "MJCF";
    let found = if is_assumed {
        let free = free_joints(model, &dependent);
        free.into_iter().map(|at| (String::new(), at)).collect()
    } else {
        driven(model, &dependent, findings)
    };
    let is_motion = drives == Drives::Position;
    let joints: HashSet<String> = model
        .joints
        .iter()
        .map(|joint| joint.name.clone())
        .collect();
    for (name, at) in found {
        // A joint and a drive have different names.
        let name = if name.is_empty() || joints.contains(&name) {
            format!("{} drive", model.joints[at.0].names[at.1])
        } else {
            name
        };
        model.drives.push(Drive {
            name,
            at,
            is_motion,
        });
    }
    tell(model, is_assumed, findings);
}

/// Joints with one freedom that determine the position of a link. Joints that close loops are
/// passive.
fn free_joints(model: &Model, dependent: &HashSet<(usize, usize)>) -> Vec<(usize, usize)> {
    let is_free = |&k: &usize| {
        let joint = &model.joints[k];
        joint.places
            && joint.kind.measures().len() == 1
            && !dependent.contains(&(k, 0))
            && !model.passive.contains(&k)
    };
    let free = (0..model.joints.len()).filter(is_free);
    free.map(|k| (k, 0)).collect()
}

/// The names and the coordinates of actuators that become drives. Each omission of an actuator is
/// replaced by the part that the drive does not contain.
fn driven(
    model: &Model,
    dependent: &HashSet<(usize, usize)>,
    findings: &mut Findings,
) -> Vec<(String, (usize, usize))> {
    let mut found: Vec<(String, (usize, usize))> = Vec::new();
    let mut seen = HashSet::new();
    let mut have_drive = HashSet::new();
    for actuator in &model.actuators {
        let kind = if dependent.contains(&actuator.at) {
            DEPENDENT
        } else if !seen.insert(actuator.at) {
            SECOND
        } else {
            found.push((actuator.name.clone(), actuator.at));
            have_drive.insert(actuator.omission);
            if actuator.is_plain { "" } else { CONTENT }
        };
        let goes_on = kind.is_empty() || kind == CONTENT;
        if goes_on || !have_drive.contains(&actuator.omission) {
            set_kind(actuator, kind, findings);
        }
    }
    // The whole element became a drive.
    findings
        .omissions
        .retain(|omission| !omission.kind.is_empty());
    found
}

fn set_kind(actuator: &Actuator, kind: &'static str, findings: &mut Findings) {
    if let Some(omission) = findings.omissions.get_mut(actuator.omission) {
        omission.kind = kind;
    }
}

fn tell(model: &Model, is_assumed: bool, findings: &mut Findings) {
    let of = |drive: &Drive| {
        let (joint, coordinate) = drive.at;
        format!(
            "`{}` on `{}`",
            drive.name, model.joints[joint].names[coordinate]
        )
    };
    let names: Vec<String> = model.drives.iter().map(of).collect();
    let remark = match (names.is_empty(), is_assumed) {
        (true, _) => "No joint has a drive: no actuator acts on an independent joint.".to_owned(),
        (_, true) => format!(
            "The file has no actuators: each independent joint with one freedom has a drive: {}.",
            names.join(", ")
        ),
        (_, false) => format!("Drives from actuators: {}.", names.join(", ")),
    };
    findings.remarks.push(remark);
}
