//! The format of the tables in `tests/golden`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use joints::spec::{Shape, Spec};
use joints::{Argument, Pose, Twist};
use serde::Deserialize;

/// One pose with the numbers computed for it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Golden {
    #[serde(default)]
    parameters: BTreeMap<String, Value>,
    /// The assembled start, if it is not the pose itself.
    start: Option<Vec<[Scalar; 3]>>,
    x: Vec<[Scalar; 3]>,
    v: Option<Vec<[Scalar; 3]>>,
    #[serde(default)]
    f: Vec<[Scalar; 3]>,
    #[serde(default)]
    lambda: Vec<Scalar>,
    pub(crate) phi: Option<Vec<Scalar>>,
    /// C·v − b
    pub(crate) velocity: Option<Vec<Scalar>>,
    pub(crate) gamma: Option<Vec<Scalar>>,
    pub(crate) wrench: Option<Vec<Scalar>>,
    pub(crate) component: Option<Vec<Scalar>>,
    pub(crate) place: Option<Vec<Scalar>>,
    pub(crate) q: Option<Vec<Scalar>>,
    pub(crate) requirements: Option<Vec<bool>>,
}

/// A number, or a text like `-3pi/2` or `atan2(3, 4)`.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub(crate) enum Scalar {
    Number(f64),
    Text(String),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Value {
    One(f64),
    Many(Vec<f64>),
    Line([[f64; 2]; 2]),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    pose: Vec<Golden>,
}

fn directory() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

/// The file for a definition: `PinInSlot` has `pin_in_slot.toml`.
pub(crate) fn file_name(definition: &str) -> String {
    let mut name = String::new();
    for c in definition.chars() {
        if c.is_ascii_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.push(c.to_ascii_lowercase());
    }
    name + ".toml"
}

/// All files of planar definitions; the spatial ones are in the folder `space`.
pub(crate) fn files() -> BTreeSet<String> {
    let entries = fs::read_dir(directory()).expect("tests/golden exists");
    entries
        .map(|e| e.expect("readable"))
        .filter(|e| e.path().is_file())
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect()
}

/// The poses of a definition.
pub(crate) fn read(definition: &str) -> Vec<Golden> {
    let path = directory().join(file_name(definition));
    let text = fs::read_to_string(&path)
        .unwrap_or_else(|e| panic!("`{definition}` has no golden table {}: {e}", path.display()));
    let file: File = toml::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    file.pose
}

impl Golden {
    pub(crate) fn arguments(&self, spec: &Spec) -> Vec<Argument> {
        for name in self.parameters.keys() {
            let known = spec.parameters.iter().any(|p| p.name == name);
            assert!(known, "`{}` has no parameter `{name}`", spec.name);
        }
        let argument = |p: &joints::spec::Parameter| match (self.parameters.get(p.name), p.shape) {
            (None, _) => Argument::Absent,
            (Some(Value::Many(v)), Shape::Point { .. } | Shape::Direction { .. }) => {
                Argument::Pair([v[0], v[1]])
            }
            (Some(Value::Line(l)), _) => Argument::Pairs(*l),
            (Some(Value::One(n)), _) => Argument::Numbers(vec![*n]),
            (Some(Value::Many(v)), _) => Argument::Numbers(v.clone()),
        };
        spec.parameters.iter().map(argument).collect()
    }

    pub(crate) fn x(&self) -> Vec<Pose> {
        poses(&self.x)
    }

    pub(crate) fn start(&self) -> Vec<Pose> {
        poses(self.start.as_ref().unwrap_or(&self.x))
    }

    /// At rest if the table has no `v`.
    pub(crate) fn v(&self) -> Vec<Twist> {
        match &self.v {
            Some(v) => v
                .iter()
                .map(|v| {
                    let [x, y, omega] = v.each_ref().map(Scalar::value);
                    Twist { x, y, omega }
                })
                .collect(),
            None => vec![Twist::zero(); self.x.len()],
        }
    }

    pub(crate) fn f(&self) -> Vec<[f64; 3]> {
        self.f
            .iter()
            .map(|f| f.each_ref().map(Scalar::value))
            .collect()
    }

    pub(crate) fn lambda(&self) -> Vec<f64> {
        self.lambda.iter().map(Scalar::value).collect()
    }

    /// Whether the table contains only values that forces have.
    pub(crate) fn only_force(&self) -> bool {
        [
            &self.phi,
            &self.velocity,
            &self.gamma,
            &self.wrench,
            &self.component,
            &self.place,
        ]
        .iter()
        .all(|entry| entry.is_none())
    }
}

fn poses(x: &[[Scalar; 3]]) -> Vec<Pose> {
    x.iter()
        .map(|x| {
            let [x, y, angle] = x.each_ref().map(Scalar::value);
            Pose::new(x, y, angle)
        })
        .collect()
}

impl Scalar {
    pub(crate) fn value(&self) -> f64 {
        match self {
            Self::Number(n) => *n,
            Self::Text(t) => parse(t).unwrap_or_else(|| panic!("`{t}` is no number")),
        }
    }
}

fn parse(text: &str) -> Option<f64> {
    if let Some(list) = text
        .strip_prefix("atan2(")
        .and_then(|t| t.strip_suffix(')'))
    {
        let (y, x) = list.split_once(',')?;
        let (y, x): (f64, f64) = (y.trim().parse().ok()?, x.trim().parse().ok()?);
        return Some(y.atan2(x));
    }
    let (times, over) = text.split_once("pi")?;
    let times = match times {
        "" => 1.0,
        "-" => -1.0,
        number => number.parse().ok()?,
    };
    let over = match over.strip_prefix('/') {
        Some(number) => number.parse().ok()?,
        None if over.is_empty() => 1.0,
        None => return None,
    };
    Some(times * std::f64::consts::PI / over)
}
