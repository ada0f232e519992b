//! Loop closures of a URDF as a file of their own, as in the collection of parallel robots of
//! Gepetto: pairs of links whose frames coincide, and joints with more freedoms than URDF knows.
//! Of YAML it reads keys with texts and lists, in brackets or with dashes.

use std::collections::HashMap;

use nalgebra::{UnitQuaternion, Vector3};
use scene::SourceText;

use crate::findings::{Fault, Findings};
use crate::limits::DEEPEST_LIST;
use crate::mechanism::{Joint, JointKind, Model};

/// A value of the file with its place.
#[derive(Clone, Debug, PartialEq)]
enum Node {
    Text(String, usize),
    List(Vec<Node>),
}

impl Node {
    /// The texts of a list.
    fn texts(&self) -> Option<Vec<(&str, usize)>> {
        let Self::List(items) = self else { return None };
        let text = |item: &'_ Node| match item {
            Self::Text(text, _) => Some(text.len()),
            Self::List(_) => None,
        };
        if items.iter().any(|item| text(item).is_none()) {
            return None;
        }
        let own = items.iter().filter_map(|item| match item {
            Self::Text(text, at) => Some((text.as_str(), *at)),
            Self::List(_) => None,
        });
        Some(own.collect())
    }
}

/// A place and what is wrong there.
type Wrong = (usize, String);

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
    let find = |key: &str| -> Result<Option<(usize, Node)>, Wrong> {
        let found = keys.iter().find(|of| of.name == key);
        found.map(|of| Ok((of.at, of.value()?))).transpose()
    };
    let of_types = find("type")?;
    let types = texts("type", of_types.as_ref())?;
    let of_loops = find("closed_loop")?;
    let start = of_loops.as_ref().map_or(0, |(at, _)| *at);
    let has_joints = keys.iter().any(|key| key.name == "joint_name");
    let pairs = pairs(of_loops.as_ref(), has_joints)?;
    if of_types.is_none() && !pairs.is_empty() {
        let message = "key `type` is missing: a list with `3d` or `6d` for each pair";
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
    let (of_names, of_kinds) = (find("joint_name")?, find("joint_type")?);
    let names = texts("joint_name", of_names.as_ref())?;
    let kinds = texts("joint_type", of_kinds.as_ref())?;
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
            return Err((at, format!("joint `{name}` is no hinge")));
        }
        change_kind(model, joint, kind)?;
    }
    Ok(())
}

/// Each key once, and none that may be another one, misspelt.
fn check_names(keys: &[Key], text: &SourceText, findings: &mut Findings) -> Result<(), Wrong> {
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for key in keys {
        let (name, line) = (key.name.as_str(), text.line(key.at));
        if let Some(first) = seen.insert(name, key.at) {
            let line = text.line(first);
            return Err((
                key.at,
                format!("key `{name}` is there already, in line {line}"),
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

/// Two names of links, each with its place.
type Pair<'n> = [(&'n str, usize); 2];

/// The pairs of links of `closed_loop`, which may be missing if the file has joints.
fn pairs<'n>(loops: Option<&'n (usize, Node)>, has_joints: bool) -> Result<Vec<Pair<'n>>, Wrong> {
    let (start, pairs) = match loops {
        Some((at, Node::List(pairs))) => (*at, pairs),
        Some((at, Node::Text(..))) => {
            let message = "`closed_loop` has to be a list of pairs: write `[[link, link]]`";
            return Err((*at, message.to_owned()));
        }
        None if has_joints => return Ok(Vec::new()),
        None => {
            let message = "key `closed_loop` is missing: a list of pairs `[[link, link]]`";
            return Err((0, message.to_owned()));
        }
    };
    let names = |(k, pair): (usize, &'n Node)| {
        let names = pair.texts().and_then(|names| names.try_into().ok());
        names.ok_or_else(|| {
            let (what, at) = match pair {
                Node::Text(text, at) => (format!("`{text}`"), *at),
                Node::List(items) => (format!("a list of {}", items.len()), start),
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
        return Err((at, format!("pair {} is one link twice", k + 1)));
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

/// Makes a hinge a joint with more freedoms.
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
            // The rotation from the joint's axes to those of the first link.
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
fn texts<'n>(key: &str, value: Option<&'n (usize, Node)>) -> Result<Vec<(&'n str, usize)>, Wrong> {
    let Some((at, node)) = value else {
        return Ok(Vec::new());
    };
    node.texts().ok_or_else(|| match node {
        Node::Text(text, at) => (*at, format!("`{key}` has to be a list: write `[{text}]`")),
        Node::List(_) => (*at, format!("`{key}` has to be a list of texts")),
    })
}

fn no_type(kind: &str) -> String {
    format!(
        "`{kind}` is no type of a joint here: `SPHERICAL`, or `UJOINT_XY` with two of the letters X, \
         Y, Z; other joints are those of the URDF"
    )
}

/// The keys that are read.
const KEYS: [&str; 4] = ["closed_loop", "type", "joint_name", "joint_type"];

/// A key of the first level with its place, and the signs of its value with their places.
struct Key {
    name: String,
    at: usize,
    signs: Vec<(char, usize)>,
}

impl Key {
    fn value(&self) -> Result<Node, Wrong> {
        value(&self.signs, self.at)
    }
}

/// The keys of the first level; their values are taken apart when they are asked for.
fn keys(text: &str) -> Result<Vec<Key>, Wrong> {
    let mut out: Vec<Key> = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let kept = uncommented(line);
        let starts = kept
            .chars()
            .next()
            .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
        let mut from = 0;
        if starts && let Some((key, _)) = kept.split_once(':') {
            out.push(Key {
                name: key.trim().to_owned(),
                at,
                signs: Vec::new(),
            });
            from = key.len() + 1;
        } else if starts && !kept.trim().is_empty() {
            return Err((at, "expected `key:`".to_owned()));
        }
        if let Some(Key { signs, .. }) = out.last_mut() {
            let own = kept[from..].char_indices();
            signs.extend(own.map(|(k, c)| (c, at + from + k)));
            signs.push(('\n', at + kept.len()));
        } else if !kept.trim().is_empty() && kept.trim() != "---" {
            return Err((at, "expected `key:`".to_owned()));
        }
        at += line.len();
    }
    Ok(out)
}

/// A line without its comment.
fn uncommented(line: &str) -> &str {
    let line = line.trim_end_matches(['\n', '\r']);
    let (mut quote, mut before) = (None, ' ');
    for (at, c) in line.char_indices() {
        match quote {
            Some(open) if c == open => quote = None,
            Some(_) => {}
            None if c == '\'' || c == '"' => quote = Some(c),
            None if c == '#' && before.is_whitespace() => return &line[..at],
            None => {}
        }
        before = c;
    }
    line
}

fn value(signs: &[(char, usize)], at: usize) -> Result<Node, Wrong> {
    let first = signs.iter().position(|(c, _)| !c.is_whitespace());
    let Some(first) = first else {
        return Ok(Node::Text(String::new(), at));
    };
    let signs = &signs[first..];
    if signs[0].0 == '-' && signs.get(1).is_some_and(|(c, _)| c.is_whitespace()) {
        return dashes(signs, at);
    }
    let (node, used) = flow(signs, 0)?;
    let rest = signs[used..].iter().find(|(c, _)| !c.is_whitespace());
    match rest {
        Some((c, at)) => Err((*at, format!("unexpected `{c}`"))),
        None => Ok(node),
    }
}

/// A list with a dash in front of each item.
fn dashes(signs: &[(char, usize)], at: usize) -> Result<Node, Wrong> {
    let mut items = Vec::new();
    let mut lines: Vec<Vec<(char, usize)>> = Vec::new();
    for line in signs.split(|(c, _)| *c == '\n') {
        let first = line.iter().position(|(c, _)| !c.is_whitespace());
        let Some(first) = first else { continue };
        let is_item =
            line[first].0 == '-' && line.get(first + 1).is_none_or(|(c, _)| c.is_whitespace());
        match lines.last_mut() {
            _ if is_item => lines.push(line[first + 1..].to_vec()),
            Some(last) => {
                last.push((' ', line[first].1));
                last.extend(&line[first..]);
            }
            None => return Err((at, "expected `-`".to_owned())),
        }
    }
    for line in &lines {
        let first = line.iter().position(|(c, _)| !c.is_whitespace());
        let Some(first) = first else {
            return Err((at, "an item without a value".to_owned()));
        };
        let (node, used) = flow(&line[first..], 0)?;
        if let Some((c, at)) = line[first + used..]
            .iter()
            .find(|(c, _)| !c.is_whitespace())
        {
            return Err((*at, format!("unexpected `{c}`")));
        }
        items.push(node);
    }
    Ok(Node::List(items))
}

/// A text or a list in brackets; and how many signs it takes.
fn flow(signs: &[(char, usize)], depth: usize) -> Result<(Node, usize), Wrong> {
    let (first, at) = signs[0];
    match first {
        '[' if depth < DEEPEST_LIST => {
            let (mut items, mut k) = (Vec::new(), 1);
            loop {
                while signs
                    .get(k)
                    .is_some_and(|(c, _)| c.is_whitespace() || *c == ',')
                {
                    k += 1;
                }
                match signs.get(k) {
                    None => return Err((at, "a list without its end `]`".to_owned())),
                    Some((']', _)) => return Ok((Node::List(items), k + 1)),
                    Some(_) => {
                        let (node, used) = flow(&signs[k..], depth + 1)?;
                        items.push(node);
                        k += used;
                    }
                }
            }
        }
        '[' => Err((at, "lists within too many others".to_owned())),
        '\'' | '"' => {
            let end = signs[1..].iter().position(|(c, _)| *c == first);
            let end = end.ok_or_else(|| (at, "a text without its end".to_owned()))?;
            let text = signs[1..=end].iter().map(|(c, _)| c).collect();
            Ok((Node::Text(text, at), end + 2))
        }
        '{' | '}' | ']' | '&' | '*' | '!' | '|' | '>' | '%' | '@' | '`' => {
            Err((at, format!("`{first}` is not read here")))
        }
        _ => {
            let end = signs
                .iter()
                .position(|(c, _)| matches!(c, ',' | ']' | '[' | '\n'));
            let end = end.unwrap_or(signs.len());
            let text: String = signs[..end].iter().map(|(c, _)| c).collect();
            Ok((Node::Text(text.trim().to_owned(), at), end.max(1)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_in_brackets_and_with_dashes_are_the_same() {
        let brackets = "# loops\npairs:\n  [\n    [\"a\", 'b c'], # one\n    [d, e],\n  ]\n";
        let dashes = "---\npairs:\n  - [a, 'b c']\n  - [d,\n     e]\n";
        let plain = |text: &str| -> Vec<Vec<String>> {
            let keys = keys(text).expect("readable");
            let value = keys[0].value().expect("readable");
            let Node::List(pairs) = &value else {
                panic!("{value:?}")
            };
            let texts = |pair: &Node| {
                pair.texts()
                    .expect("texts")
                    .iter()
                    .map(|(t, _)| (*t).to_owned())
                    .collect()
            };
            pairs.iter().map(texts).collect()
        };
        assert_eq!(plain(brackets), [["a", "b c"], ["d", "e"]]);
        assert_eq!(plain(dashes), plain(brackets));
        for wrong in [
            "a",
            "a: [",
            "a: 'x",
            "a: {}",
            "a: [x] y",
            "- a",
            "a:\n  - - x: [",
        ] {
            let found = keys(wrong).and_then(|keys| {
                let values = keys.iter().map(Key::value);
                values.collect::<Result<Vec<Node>, Wrong>>()
            });
            assert!(found.is_err(), "{wrong}");
        }
    }
}
