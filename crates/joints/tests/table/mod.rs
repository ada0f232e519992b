//! The format of the tables in `tests/golden`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use pfaff_joints::space3::{self, Axes};
use pfaff_joints::spec::{Shape, Spec};
use pfaff_joints::{Argument, Plane, Pose, Space, Space3};
use serde::Deserialize;

/// One pose with the values computed for it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Golden {
    #[serde(default)]
    parameters: BTreeMap<String, Value>,
    /// The poses of the assembled initial configuration, if they differ from the pose.
    start: Option<Vec<Vec<Scalar>>>,
    x: Vec<Vec<Scalar>>,
    v: Option<Vec<Vec<Scalar>>>,
    #[serde(default)]
    f: Vec<[Scalar; 3]>,
    #[serde(default)]
    lambda: Vec<Scalar>,
    pub(crate) phi: Option<Vec<Scalar>>,
    /// The residual C·v − b of the velocity rows.
    pub(crate) velocity: Option<Vec<Scalar>>,
    pub(crate) gamma: Option<Vec<Scalar>>,
    pub(crate) wrench: Option<Vec<Scalar>>,
    pub(crate) component: Option<Vec<Scalar>>,
    pub(crate) place: Option<Vec<Scalar>>,
    pub(crate) q: Option<Vec<Scalar>>,
    pub(crate) requirements: Option<Vec<bool>>,
}

/// A number, or an expression such as `-3pi/2` or `atan2(3, 4)`.
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
    Two([Vec<f64>; 2]),
}

/// A space with the notation of the tables.
pub(crate) trait Tabled: Space {
    /// Folder of the tables.
    const FOLDER: &'static str;
    /// Reads a pose: x, y, angle, or x, y, z and a quaternion of any length.
    fn tabled_pose(numbers: &[f64]) -> Self::Pose<f64>;
    /// Reads a point or a vector.
    fn vector(numbers: &[f64]) -> Argument;
    /// Reads two vectors: points of a line of the ground, or an axis and a vector perpendicular to
    /// it.
    fn two(vectors: &[Vec<f64>; 2]) -> Argument;
}

impl Tabled for Plane {
    const FOLDER: &'static str = "";
    fn tabled_pose(numbers: &[f64]) -> Pose {
        Pose::new(numbers[0], numbers[1], numbers[2])
    }
    fn vector(numbers: &[f64]) -> Argument {
        Argument::Pair([numbers[0], numbers[1]])
    }
    fn two([a, b]: &[Vec<f64>; 2]) -> Argument {
        Argument::Pairs([[a[0], a[1]], [b[0], b[1]]])
    }
}

impl Tabled for Space3 {
    const FOLDER: &'static str = "space";
    fn tabled_pose(numbers: &[f64]) -> space3::Pose {
        space3::Pose::new(
            [0, 1, 2].map(|k| numbers[k]),
            [3, 4, 5, 6].map(|k| numbers[k]),
        )
    }
    fn vector(numbers: &[f64]) -> Argument {
        Argument::Triple([0, 1, 2].map(|k| numbers[k]))
    }
    fn two(vectors: &[Vec<f64>; 2]) -> Argument {
        let [axis, cross] = vectors.each_ref().map(|v| [0, 1, 2].map(|k| v[k]));
        let axes = Axes::new(axis, Some(cross)).expect("two directions");
        Argument::Axes(axes)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    pose: Vec<Golden>,
}

fn directory<S: Tabled>() -> PathBuf {
    let planar = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    planar.join(S::FOLDER)
}

/// Returns the name of the file for a definition: `pin_in_slot.toml` for `PinInSlot`.
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

/// Returns all files of the definitions of a space.
pub(crate) fn files<S: Tabled>() -> BTreeSet<String> {
    let entries = fs::read_dir(directory::<S>()).expect("the folder of tables exists");
    entries
        .map(|e| e.expect("readable"))
        .filter(|e| e.path().is_file())
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect()
}

/// Returns the poses of a definition.
pub(crate) fn read<S: Tabled>(definition: &str) -> Vec<Golden> {
    let path = directory::<S>().join(file_name(definition));
    let text = fs::read_to_string(&path)
        .unwrap_or_else(|e| panic!("`{definition}` has no golden table {}: {e}", path.display()));
    let file: File = toml::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    file.pose
}

impl Golden {
    pub(crate) fn arguments<S: Tabled>(&self, spec: &Spec) -> Vec<Argument> {
        for name in self.parameters.keys() {
            let known = spec.parameters.iter().any(|p| p.name == name);
            assert!(known, "`{}` has no parameter `{name}`", spec.name);
        }
        let argument =
            |p: &pfaff_joints::spec::Parameter| match (self.parameters.get(p.name), p.shape) {
                (None, _) => Argument::Absent,
                (Some(Value::Many(v)), Shape::Point { .. } | Shape::Direction { .. }) => {
                    S::vector(v)
                }
                (Some(Value::Two([a, b])), Shape::GroundPlane) => {
                    Argument::Triples([a, b].map(|v| [0, 1, 2].map(|k| v[k])))
                }
                (Some(Value::Two(two)), _) => S::two(two),
                (Some(Value::One(n)), _) => Argument::Numbers(vec![*n]),
                (Some(Value::Many(v)), _) => Argument::Numbers(v.clone()),
            };
        spec.parameters.iter().map(argument).collect()
    }

    pub(crate) fn x<S: Tabled>(&self) -> Vec<S::Pose<f64>> {
        poses::<S>(&self.x)
    }

    pub(crate) fn start<S: Tabled>(&self) -> Vec<S::Pose<f64>> {
        poses::<S>(self.start.as_ref().unwrap_or(&self.x))
    }

    /// Returns the velocities, one for each velocity component of each body. They are zero if the
    /// table has no `v`.
    pub(crate) fn v<S: Tabled>(&self) -> Vec<f64> {
        match &self.v {
            Some(v) => v.iter().flatten().map(Scalar::value).collect(),
            None => vec![0.0; S::N_DOF * self.x.len()],
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

    /// Returns whether the table contains only values for forces.
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

fn poses<S: Tabled>(x: &[Vec<Scalar>]) -> Vec<S::Pose<f64>> {
    let numbers = |x: &Vec<Scalar>| x.iter().map(Scalar::value).collect::<Vec<f64>>();
    x.iter().map(|x| S::tabled_pose(&numbers(x))).collect()
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
    if let Some((above, below)) = text.split_once('/')
        && let (Ok(above), Ok(below)) = (above.parse::<f64>(), below.parse::<f64>())
    {
        return Some(above / below);
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
