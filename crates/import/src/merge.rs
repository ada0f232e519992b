//! Merges links that are fixed to each other.

use nalgebra::Isometry3;

use crate::findings::Findings;
use crate::mechanism::{Frame, HeldWeight, Joint, JointKind, Model};
use crate::pose::{Motion, placing};

/// Position of the axes of a link after merging: the host into which the link was merged, and the
/// pose of the axes relative to the host.
type Host = (Option<usize>, Isometry3<f64>);

/// If a fixed joint determines the position of a link, this function merges the link into the first
/// link of the joint. `motions` contains the motions of the links. The motions of the remaining
/// links do not change.
pub(crate) fn merge(model: &mut Model, motions: &mut Vec<Motion>, findings: &mut Findings) {
    let hosts = hosts(model);
    let is_merged = |k: &usize| hosts[*k].0 != Some(*k);
    let merged: Vec<usize> = (0..hosts.len()).filter(is_merged).collect();
    if merged.is_empty() {
        return;
    }
    let name = |&k: &usize| {
        let host = hosts[k].0.map_or("ground", |host| &model.links[host].name);
        format!("`{}` in `{host}`", model.links[k].name)
    };
    let names: Vec<String> = merged.iter().map(name).collect();
    findings.remarks.push(format!(
        "Fixed links are parts of the bodies that they are fixed to (--keep-fixed keeps them): {}.",
        names.join(", ")
    ));
    for &link in &merged {
        absorb(model, link, &hosts[link]);
    }
    // New indices of the remaining links.
    let mut numbers = vec![None; hosts.len()];
    let stay = (0..hosts.len()).filter(|k| !is_merged(k));
    for (new, old) in stay.enumerate() {
        numbers[old] = Some(new);
    }
    let place = |link: Option<usize>| -> Host {
        let (host, pose) = link.map_or((None, Isometry3::identity()), |link| hosts[link]);
        (host.and_then(|host| numbers[host]), pose)
    };
    let mut kept = vec![None; model.joints.len()];
    for (k, mut joint) in std::mem::take(&mut model.joints).into_iter().enumerate() {
        if joint.places && joint.links[1].is_some_and(|link| numbers[link].is_none()) {
            continue;
        }
        move_ends(&mut joint, place);
        if joint.links[0] == joint.links[1] {
            findings.remarks.push(format!(
                "Joint `{}` is between parts of one body, so it is omitted.",
                joint.name
            ));
            continue;
        }
        kept[k] = Some(model.joints.len());
        model.joints.push(joint);
    }
    model.couplings.retain_mut(|coupling| {
        let y = kept[coupling.y.0];
        let x = coupling
            .x
            .map(|(joint, coordinate)| (kept[joint], coordinate));
        let (Some(y), None | Some((Some(_), _))) = (y, x) else {
            return false;
        };
        coupling.y.0 = y;
        coupling.x = x.and_then(|(joint, coordinate)| Some((joint?, coordinate)));
        true
    });
    model.drives.retain_mut(|drive| {
        let new = kept[drive.at.0];
        drive.at.0 = new.unwrap_or_default();
        new.is_some()
    });
    for frame in &mut model.frames {
        let (link, pose) = place(frame.link);
        frame.link = link;
        frame.pose = pose * frame.pose;
    }
    let mut flags = numbers.iter().map(Option::is_some);
    model.links.retain(|_| flags.next().unwrap_or(true));
    let mut flags = numbers.iter().map(Option::is_some);
    motions.retain(|_| flags.next().unwrap_or(true));
}

/// The host of each link. It is the first link of the chain of fixed joints that determine the
/// position of the link.
fn hosts(model: &Model) -> Vec<Host> {
    let before = placing(model);
    let fixed = |link: usize| {
        let joint = before[link].map(|joint| &model.joints[joint])?;
        let merges = joint.kind == JointKind::Fixed && joint.is_active && joint.frames.is_none();
        merges.then_some(joint.links[0])
    };
    let host = |link: usize| {
        let (mut host, mut steps) = (Some(link), 0);
        while let Some(parent) = host.and_then(fixed) {
            host = parent;
            steps += 1;
            if steps > model.links.len() {
                return (Some(link), Isometry3::identity());
            }
        }
        if host == Some(link) {
            return (host, Isometry3::identity());
        }
        (host, model.pose(host).inverse() * model.links[link].pose)
    };
    (0..model.links.len()).map(host).collect()
}

/// Adds the mass of a link to the mass of its host, and the name of the link to the frames.
fn absorb(model: &mut Model, link: usize, (host, pose): &Host) {
    let own = model.links[link].clone();
    if let Some(host) = *host {
        let whole = &mut model.links[host];
        whole.mass = whole.mass.plus(&own.mass.seen(pose));
        whole.held.extend(own.held.iter().map(|held| HeldWeight {
            mass: held.mass,
            centre: pose.translation.vector + pose.rotation * held.centre,
        }));
    }
    model.frames.push(Frame {
        name: own.name,
        link: Some(link),
        pose: Isometry3::identity(),
    });
}

/// Describes a joint in the axes of the hosts of its links.
fn move_ends(joint: &mut Joint, place: impl Fn(Option<usize>) -> Host) {
    for side in 0..2 {
        let (link, pose) = place(joint.links[side]);
        joint.links[side] = link;
        if pose != Isometry3::identity() {
            joint.points[side] = pose.translation.vector + pose.rotation * joint.points[side];
            joint.axes[side] = pose.rotation * joint.axes[side];
            if side == 1 {
                joint.cross = pose.rotation * joint.cross;
            }
            if let Some(frames) = &mut joint.frames {
                frames[side] = pose.rotation * frames[side];
            }
        }
    }
}
