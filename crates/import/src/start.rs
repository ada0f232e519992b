//! The initial state of a scene: a keyframe, or a pose with closed loops near the requested values.

use crate::angles;
use crate::assemble::{self, Assembly, AssemblyFailure};
use crate::axes::{self, Axes};
use crate::couple;
use crate::findings::{Fault, Findings};
use crate::limits::{ASSEMBLED, HELD, OPEN};
use crate::mechanism::{Joint, Keyframe, Model};
use crate::options::{Base, Options};
use crate::pose::{self, Motion};
use crate::xml::Element;
use model::words::rough;

/// Returns the initial state of the scene, and whether this state has velocities. Returns `None` if
/// the scene starts at the described pose. `angle` is the accuracy of angles in the file.
pub(crate) fn start(
    model: &mut Model,
    options: &Options,
    angle: Option<f64>,
    root: Element,
    (gap, findings): (&mut f64, &mut Findings),
) -> Option<(Vec<Motion>, bool)> {
    let told = |state: &Keyframe| format!("`{}`", state.name);
    let Some(name) = &options.keyframe else {
        if !model.states.is_empty() {
            let names: Vec<String> = model.states.iter().map(told).collect();
            let names = names.join(", ");
            findings.remarks.push(format!(
                "Keyframes of the file (--keyframe NAME starts there): {names}."
            ));
        }
        *gap = close(model, options, angle, root, findings);
        return None;
    };
    if !options.pose.is_empty() {
        let message = "a pose and a keyframe both define the start: give only one of them";
        findings.of(Fault::Value, root, message);
        return None;
    }
    let Some(state) = model.states.iter().find(|state| state.name == *name) else {
        let names: Vec<String> = model.states.iter().map(told).collect();
        let names = if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        };
        let message = format!("there is no keyframe `{name}`; there are: {names}");
        findings.of(Fault::Unknown, root, message);
        return None;
    };
    let motions = pose::at_state(model, &state.q, state.v.as_deref());
    findings
        .remarks
        .push(format!("The scene starts at the keyframe `{name}`."));
    let (moves, line) = (state.v.is_some(), state.line);
    let q = state.q.clone();
    set_moved(model, &q);
    let poses: Vec<_> = motions.iter().map(|motion| motion.pose).collect();
    let moved: Vec<[f64; 2]> = model.joints.iter().map(|joint| joint.moved).collect();
    let open = assemble::open(model, &poses, &moved);
    if !open.is_empty() {
        findings.remarks.push(format!(
            "The keyframe `{name}` (line {line}) leaves loops open, {}: the start closes them only if it is near the keyframe.",
            open.join(", ")
        ));
    }
    if assemble::gap(model) > OPEN {
        *gap = if open.is_empty() {
            describe_keyframe(model, &q, name, root, findings);
            0.0
        } else {
            close(model, options, angle, root, findings)
        };
        set_moved(model, &q);
    }
    refuse_turns(model, name, root, findings);
    Some((motions, moves))
}

/// Sets the changes of the joint coordinates from the described pose to a keyframe.
fn set_moved(model: &mut Model, q: &[Vec<f64>]) {
    for (joint, q) in model.joints.iter_mut().zip(q) {
        for k in 0..joint.kind.measures().len().min(q.len()) {
            joint.moved[k] = q[k] - joint.zero[k];
        }
    }
}

/// Describes the links at a keyframe that closes the loops. The loops of a scene must be closed
/// where the links are described.
fn describe_keyframe(
    model: &mut Model,
    q: &[Vec<f64>],
    name: &str,
    root: Element,
    findings: &mut Findings,
) {
    let moved = model.joints.iter().map(|joint| joint.moved).collect();
    let displacements = pose::displacements(model, q);
    let found = Assembly::of_keyframe(model, moved, displacements);
    findings.remarks.push(format!(
        "The links are described at the keyframe `{name}`, because loops are open where the file describes them."
    ));
    leave_springs(assemble::describe(model, &found), root, findings);
}

/// Reports springs of spherical joints that were removed.
fn leave_springs(joints: Vec<String>, root: Element, findings: &mut Findings) {
    let kind = "springs of spherical joints, because the start differs from the described pose";
    for joint in joints {
        findings.leave_element(kind, root, &joint);
    }
}

/// Rejects keyframes with full revolutions of coupled joints. The initial angles in a scene do not
/// contain full revolutions, but couplings depend on full revolutions.
fn refuse_turns(model: &Model, keyframe: &str, root: Element, findings: &mut Findings) {
    for coupling in model.couplings.iter().filter(|coupling| coupling.is_active) {
        for (joint, k) in coupling.x.into_iter().chain([coupling.y]) {
            let joint = &model.joints[joint];
            let turns = joint.kind.measures().get(k) != Some(&"displacement");
            if turns && joint.moved[k].abs() > std::f64::consts::PI {
                let message = format!(
                    "the keyframe `{keyframe}` turns `{}` by {:.3} rad, more than half a turn, and `{}` counts turns from the described position of the links",
                    joint.name, joint.moved[k], coupling.name
                );
                findings.of(Fault::Unsupported, root, message);
            }
        }
    }
}

/// A coordinate and its requested value.
struct RequestedValue<'o> {
    name: &'o str,
    value: f64,
    joint: usize,
    coordinate: usize,
}

impl RequestedValue<'_> {
    fn unit(&self, joint: &Joint) -> &'static str {
        match joint.kind.measures().get(self.coordinate) {
            Some(&"displacement") => "m",
            _ => "rad",
        }
    }
}

/// The coordinates in a requested pose.
fn asked<'o>(
    model: &Model,
    pose: &'o [(String, f64)],
    root: Element,
    findings: &mut Findings,
) -> Vec<RequestedValue<'o>> {
    let mut out = Vec::new();
    for (name, value) in pose {
        let coordinates = model.joints.iter().enumerate().flat_map(|(joint, of)| {
            let count = of.kind.measures().len();
            (0..count).map(move |coordinate| (joint, coordinate))
        });
        let found = coordinates
            .clone()
            .find(|&(joint, c)| model.joints[joint].names[c] == *name);
        let of_joint = |&(joint, c): &(usize, usize)| model.joints[joint].name == *name && c == 0;
        let found = found.or_else(|| coordinates.clone().find(of_joint));
        let Some((joint, coordinate)) = found else {
            let names = coordinates.map(|(joint, c)| model.joints[joint].names[c].as_str());
            let near = scene::nearest(name, names);
            let help = near.map(|near| format!("did you mean `{near}`?"));
            let message = format!("there is no joint `{name}` with a coordinate");
            let fault = Fault::Unknown;
            findings.fault_with_help(fault, root.source, root.span(), message, "", help);
            continue;
        };
        let is_asked = |of: &RequestedValue| (of.joint, of.coordinate) == (joint, coordinate);
        if let Some(first) = out.iter().find(|of| is_asked(of)) {
            let message = format!(
                "`{name}` is requested at {value}, and `{}` at {}: a coordinate has only one value",
                first.name, first.value
            );
            findings.of(Fault::Twice, root, message);
            continue;
        }
        let one = RequestedValue {
            name,
            value: *value,
            joint,
            coordinate,
        };
        if one.unit(&model.joints[joint]) == "rad" && angles::is_beyond_a_turn(*value) {
            findings.remarks.push(format!(
                "`{name}` is requested at {value} rad, more than a turn: angles are in rad, and {value}° are {} rad.",
                short(value.to_radians())
            ));
        }
        out.push(one);
    }
    out
}

/// A number rounded to five digits.
fn short(x: f64) -> f64 {
    format!("{x:.4e}").parse().unwrap_or(x)
}

/// Moves the links to a pose with closed loops, if the loops are open at the described pose or if a
/// pose is requested. Returns the largest gap that remains, as a share of the size or in rad.
fn close(
    model: &mut Model,
    options: &Options,
    angle: Option<f64>,
    root: Element,
    findings: &mut Findings,
) -> f64 {
    let asked = asked(model, &options.pose, root, findings);
    if findings.has_problems() {
        return 0.0;
    }
    let given = asked.iter().map(|one| {
        let change = one.value - model.joints[one.joint].zero[one.coordinate];
        (one.joint, one.coordinate, change)
    });
    let given: Vec<_> = given.collect();
    let guess = couple::follow(model, &given);
    if options.axes == Axes::Snapped {
        let poses = assemble::poses(model, &guess);
        axes::align(model, &poses, angle, findings);
    }
    let open = assemble::gap(model);
    if asked.is_empty() && open <= OPEN {
        return 0.0;
    }
    let held: Vec<_> = given.iter().map(|&(joint, c, _)| (joint, c)).collect();
    match assemble::assemble(model, &guess, &held) {
        Ok(found) => {
            let mut remark = format!(
                "The links are described at a pose at which loops are closed, found {}",
                found.way
            );
            if open > OPEN {
                remark += &format!(
                    "; where the file describes them, loops are open by {open} of the size or rad",
                    open = rough(open)
                );
            }
            remark += ".";
            if found.gap > ASSEMBLED {
                remark += &format!(
                    " The best pose leaves {} of the size or rad.",
                    rough(found.gap)
                );
            }
            findings.remarks.push(remark);
            leave_springs(assemble::describe(model, &found), root, findings);
            tell_moved(model, &asked, findings);
            return found.gap;
        }
        Err(AssemblyFailure::Open(name, gap)) => {
            let message = format!(
                "no pose was found at which all loops are closed: at the best pose, `{name}` is open by {gap} of the size or rad",
                gap = rough(gap)
            );
            let mut help =
                "give a pose at which the loops are nearly closed: --pose joint=0.3,other=-0.2"
                    .to_owned();
            let poses = assemble::poses(model, &guess);
            if let Some(tilts) = axes::tilts(model, &poses, angle) {
                help = format!("{tilts}: --snap makes axes parallel; or {help}");
            }
            let fault = Fault::Assembly;
            findings.fault_with_help(fault, root.source, root.span(), message, "", help);
        }
        Err(AssemblyFailure::TooLarge(n)) => {
            findings.remarks.push(format!(
                "Loops are open by {open} of the size or rad, and {n} coordinates are more than are tried.", open = rough(open)));
        }
    }
    0.0
}

/// Reports the coordinates whose values differ from the requested values.
fn tell_moved(model: &Model, asked: &[RequestedValue], findings: &mut Findings) {
    let mut moved = Vec::new();
    for one in asked {
        let joint = &model.joints[one.joint];
        let found = joint.zero[one.coordinate];
        if (found - one.value).abs() > HELD * one.value.abs().max(1.0) {
            moved.push(format!(
                "`{}`: requested {} {unit}, found {} {unit}",
                one.name,
                one.value,
                short(found),
                unit = one.unit(joint),
            ));
        }
    }
    if !moved.is_empty() {
        findings.remarks.push(format!(
            "Loops and couplings do not close with all values of the pose: {}.",
            moved.join("; ")
        ));
    }
}

/// Explains why the mechanism cannot move, if its root is fixed by default.
pub(crate) fn nothing_moves(format: &str, base: Base) -> Option<String> {
    let is_fixed = format == "URDF" && base == Base::Fixed;
    is_fixed.then(|| "the root link is fixed to the ground by default: --base free".to_owned())
}
