//! Reads loop closures of a URDF from a separate file, as in Gepetto's collection of parallel
//! robots. The file contains pairs of links whose frames coincide, and joints with more degrees of
//! freedom than URDF supports.

mod yaml;

use std::collections::HashMap;

use nalgebra::{UnitQuaternion, Vector3};
use scene::SourceText;

use crate::findings::{Fault, Findings};
use crate::mechanism::{Joint, JointKind, Model};
use yaml::{Key, Node, Wrong, keys};

/// Adds the closures to a model.
pub(crate) fn read(
    model: &mut Model,
    links: &HashMap<String, usize>,
    text: &SourceText,
    findings: &mut Findings,
) {
    let told = keys(text.text()).and_then(|keys| apply(model, links, &keys, text, findings));
    if let Err((at, message)) = told {
        findings.fault(Fault::Loops, text, at..at + 1, message, "");
    }
}

fn apply(
    model: &mut Model,
    links: &HashMap<String, usize>,
    keys: &[Key],
    text: &SourceText,
    findings: &mut Findings,
) -> Result<(), Wrong> {
    check_names(keys, text, findings)?;
    let find = |name: &str| keys.iter().find(|key| key.name == name);
    let of_types = find("type");
    let types = texts(of_types)?;
    let of_loops = find("closed_loop");
    let start = of_loops.map_or(0, |key| key.at);
    let pairs = pairs(of_loops, find("joint_name").is_some())?;
    if of_types.is_none() && !pairs.is_empty() {
        let message = "key `type` is missing: it lists `3d` or `6d` for each pair";
        return Err((start, message.to_owned()));
    }
    if types.len() != pairs.len() {
        let message = format!(
            "`closed_loop` has {} pairs, `type` {} types",
            pairs.len(),
            types.len()
        );
        return Err((start, message));
    }
    for (k, (pair, kind)) in pairs.iter().zip(types).enumerate() {
        model.joints.push(closure(k, pair, kind, links)?);
    }
    let names = texts(find("joint_name"))?;
    let kinds = texts(find("joint_type"))?;
    if names.len() != kinds.len() {
        let at = names.first().map_or(0, |(_, at)| *at);
        return Err((
            at,
            "`joint_name` and `joint_type` have different lengths".into(),
        ));
    }
    let joints = model.joints.iter().enumerate();
    let joints: HashMap<String, usize> = joints.map(|(k, j)| (j.name.clone(), k)).collect();
    for ((name, at), kind) in names.into_iter().zip(kinds) {
        let joint = joints.get(name).copied();
        let joint = joint.ok_or_else(|| (at, format!("there is no joint `{name}`")))?;
        if !matches!(
            model.joints[joint].kind,
            JointKind::Revolute | JointKind::Fixed
        ) {
            return Err((
                at,
                format!("joint `{name}` is not a revolute or fixed joint"),
            ));
        }
        change_kind(model, joint, kind)?;
    }
    Ok(())
}

/// Checks that each key occurs once, and that no key is a misspelt form of a supported key.
fn check_names(keys: &[Key], text: &SourceText, findings: &mut Findings) -> Result<(), Wrong> {
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for key in keys {
        let (name, line) = (key.name.as_str(), text.line(key.at));
        if let Some(first) = seen.insert(name, key.at) {
            let line = text.line(first);
            return Err((
                key.at,
                format!("key `{name}` is already defined in line {line}"),
            ));
        }
        match name {
            _ if KEYS.contains(&name) => {}
            "name_mot" => findings.leave("actuators", name, text, line),
            _ => match scene::nearest(name, KEYS) {
                Some(near) => {
                    let message = format!("there is no key `{name}`: did you mean `{near}`?");
                    return Err((key.at, message));
                }
                None => findings.leave("extensions that are not read", name, text, line),
            },
        }
    }
    Ok(())
}

/// Two names of links, each with its position in the text.
type Pair<'n> = [(&'n str, usize); 2];

/// The pairs of links in the key `closed_loop`. The key may be missing if the file has joints.
fn pairs(loops: Option<&Key>, has_joints: bool) -> Result<Vec<Pair<'_>>, Wrong> {
    let pairs = match loops.map(|key| (key.at, &key.value)) {
        Some((_, Node::List(pairs, _))) => pairs,
        Some((at, _)) => {
            let message = "`closed_loop` must be a list of pairs: write `[[link, link]]`";
            return Err((at, message.to_owned()));
        }
        None if has_joints => return Ok(Vec::new()),
        None => {
            let message = "key `closed_loop` is missing: a list of pairs `[[link, link]]`";
            return Err((0, message.to_owned()));
        }
    };
    let names = |(k, pair)| {
        let names = Node::texts(pair).and_then(|names| names.try_into().ok());
        names.ok_or_else(|| {
            let (what, at) = match pair {
                Node::Text(text, at) => (format!("`{text}`"), *at),
                Node::List(items, at) => (format!("a list of {}", items.len()), *at),
                Node::Keys(at) => ("a list of keys".to_owned(), *at),
            };
            let message = format!("entry {} is {what}, not a pair `[link, link]`", k + 1);
            (at, message)
        })
    };
    pairs.iter().enumerate().map(names).collect()
}

/// The joint of pair k.
fn closure(
    k: usize,
    pair: &Pair<'_>,
    (kind, at): (&str, usize),
    links: &HashMap<String, usize>,
) -> Result<Joint, Wrong> {
    let mut ends = [None; 2];
    for (end, (name, at)) in ends.iter_mut().zip(pair) {
        let found = links.get(*name).copied();
        *end = Some(found.ok_or_else(|| (*at, format!("there is no link `{name}`")))?);
    }
    let kind = match kind.to_ascii_lowercase().as_str() {
        "6d" => JointKind::Fixed,
        "3d" => JointKind::Spherical,
        other => return Err((at, format!("the type `{other}` is neither `3d` nor `6d`"))),
    };
    if ends[0] == ends[1] {
        return Err((at, format!("pair {} contains one link twice", k + 1)));
    }
    let name = format!("{} to {}", pair[0].0, pair[1].0);
    let zero = [Vector3::zeros(); 2];
    let frames = (kind == JointKind::Fixed).then(|| [UnitQuaternion::identity(); 2]);
    Ok(Joint {
        places: false,
        frames,
        ..Joint::new(name, kind, ends, zero, [Vector3::z(); 2])
    })
}

/// Changes a hinge to a joint with more degrees of freedom.
fn change_kind(model: &mut Model, joint: usize, (kind, at): (&str, usize)) -> Result<(), Wrong> {
    let joint = &mut model.joints[joint];
    let axis = |letter: char| match letter {
        'X' => Some(Vector3::x()),
        'Y' => Some(Vector3::y()),
        'Z' => Some(Vector3::z()),
        _ => None,
    };
    let letters: Vec<char> = kind
        .strip_prefix("UJOINT_")
        .unwrap_or_default()
        .chars()
        .collect();
    match letters.as_slice() {
        [] if kind == "SPHERICAL" => joint.kind = JointKind::Spherical,
        &[a, b] => {
            let (Some(first), Some(second)) = (axis(a), axis(b)) else {
                return Err((at, no_type(kind)));
            };
            if first == second {
                return Err((at, format!("`{kind}` has one axis twice")));
            }
            // The rotation from the joint's axes to the axes of the first link.
            let turned = model.links[joint.links[1].unwrap_or(0)].pose.rotation;
            let before = joint.links[0].map(|link| model.links[link].pose.rotation);
            let relation = before.unwrap_or_default().inverse() * turned;
            joint.kind = JointKind::Universal;
            joint.axes = [relation * first, first];
            joint.cross = second;
        }
        _ => return Err((at, no_type(kind))),
    }
    joint.loads = Default::default();
    joint.places = true;
    Ok(())
}

/// The texts of a list.
fn texts(key: Option<&Key>) -> Result<Vec<(&str, usize)>, Wrong> {
    let Some(Key { name, value, .. }) = key else {
        return Ok(Vec::new());
    };
    value.texts().ok_or_else(|| match value {
        Node::Text(text, at) => (*at, format!("`{name}` must be a list: write `[{text}]`")),
        Node::List(_, at) | Node::Keys(at) => (*at, format!("`{name}` must be a list of texts")),
    })
}

fn no_type(kind: &str) -> String {
    format!(
        "`{kind}` is not a joint type here: use `SPHERICAL`, or `UJOINT_XY` with two of the letters X, \
         Y, Z; other joints are those of the URDF"
    )
}

/// The keys that are read.
const KEYS: [&str; 4] = ["closed_loop", "type", "joint_name", "joint_type"];
