//! Reads `<compiler>`, which defines the meaning of numbers and angles, and reads orientations.

use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::findings::{Fault, Findings, NumberKind, unit};
use crate::pose::{along_z, quaternion, rotation};
use crate::xml::{Element, Value};

/// Attributes of which one states an orientation.
pub(super) const WAYS: [&str; 5] = ["quat", "axisangle", "euler", "xyaxes", "zaxis"];

/// Use of the inertia of geoms.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum FromGeoms {
    /// Geoms are used if the file states no inertia for a body.
    Auto,
    Always,
    Never,
}

pub(super) struct Compiler {
    /// Radians per unit of an angle.
    pub(super) angle: f64,
    /// Axes of Euler angles (0, 1, 2), and whether each axis is fixed.
    pub(super) euler: [(usize, bool); 3],
    pub(super) from_geoms: FromGeoms,
    /// Groups of geoms that contribute inertia.
    pub(super) groups: [f64; 2],
    pub(super) least_mass: f64,
    pub(super) least_inertia: f64,
    pub(super) balances: bool,
    pub(super) total_mass: Option<f64>,
    pub(super) auto_limits: bool,
    /// Whether the axes of free bodies are moved to their inertial frames by default.
    pub(super) aligns_free: bool,
}

impl Compiler {
    pub(super) fn read(sections: &[Element], findings: &mut Findings) -> Self {
        let mut compiler = Self {
            angle: std::f64::consts::PI / 180.0,
            euler: [(0, false), (1, false), (2, false)],
            from_geoms: FromGeoms::Auto,
            groups: [0.0, 5.0],
            least_mass: 0.0,
            least_inertia: 0.0,
            balances: false,
            total_mass: None,
            auto_limits: true,
            aligns_free: false,
        };
        for section in sections
            .iter()
            .filter(|section| section.name() == "compiler")
        {
            for (key, value) in section.attributes() {
                compiler.attribute(key, &value, findings);
            }
        }
        compiler
    }

    fn attribute(&mut self, key: &str, value: &Value, findings: &mut Findings) {
        let word = value.text.trim();
        match (key, word) {
            ("angle", "radian") => self.angle = 1.0,
            ("angle", "degree") => self.angle = std::f64::consts::PI / 180.0,
            ("coordinate", "local") => {}
            ("eulerseq", _) => match euler(word) {
                Some(axes) => self.euler = axes,
                None => unknown(value, "three of the letters x, y, z, X, Y, Z", findings),
            },
            ("inertiafromgeom", "auto") => self.from_geoms = FromGeoms::Auto,
            ("inertiafromgeom", "true") => self.from_geoms = FromGeoms::Always,
            ("inertiafromgeom", "false") => self.from_geoms = FromGeoms::Never,
            ("inertiagrouprange", _) => {
                if let Some(groups) = findings.numbers(value, [2, 2], NumberKind::Other) {
                    self.groups = [groups[0], groups[1]];
                }
            }
            ("boundmass", _) => {
                self.least_mass = findings
                    .not_negative(value, NumberKind::Other)
                    .unwrap_or(0.0);
            }
            ("boundinertia", _) => {
                self.least_inertia = findings
                    .not_negative(value, NumberKind::Other)
                    .unwrap_or(0.0);
            }
            ("balanceinertia", _) => self.balances = findings.boolean(value).unwrap_or(false),
            ("settotalmass", _) => {
                let total = findings.number(value, NumberKind::Other);
                self.total_mass = total.filter(|total| *total > 0.0);
            }
            ("autolimits", _) => self.auto_limits = findings.boolean(value).unwrap_or(true),
            ("alignfree", _) => self.aligns_free = findings.boolean(value).unwrap_or(false),
            ("angle", _) => unknown(value, "`degree` or `radian`", findings),
            ("inertiafromgeom", _) => unknown(value, "`auto`, `true` or `false`", findings),
            ("coordinate", _) => {
                let message = format!("{}: only `local` is read", value.subject);
                findings.at(Fault::Unsupported, value, message);
            }
            _ => {}
        }
    }

    /// Position and orientation of an element. `get` returns its attributes.
    pub(super) fn pose<'a>(
        &self,
        get: impl Fn(&str) -> Option<Value<'a>>,
        findings: &mut Findings,
    ) -> Isometry3<f64> {
        let position = get("pos").and_then(|value| findings.vector(&value, NumberKind::Length));
        let turned = self.orientation(get, findings);
        Isometry3::from_parts(position.unwrap_or_default().into(), turned)
    }

    /// The orientation, from one of the attributes `quat`, `axisangle`, `euler`, `xyaxes`, `zaxis`.
    pub(super) fn orientation<'a>(
        &self,
        get: impl Fn(&str) -> Option<Value<'a>>,
        findings: &mut Findings,
    ) -> UnitQuaternion<f64> {
        self.find_orientation(get, findings).unwrap_or_default()
    }

    fn look_for_radians(&self, value: &Value, angles: &[f64], findings: &mut Findings) {
        if self.angle != 1.0 {
            findings.look_for_radians(value, angles);
        }
    }

    fn find_orientation<'a>(
        &self,
        get: impl Fn(&str) -> Option<Value<'a>>,
        findings: &mut Findings,
    ) -> Option<UnitQuaternion<f64>> {
        let given: Vec<Value> = WAYS.iter().filter_map(|way| get(way)).collect();
        if let [_, second, ..] = given.as_slice() {
            let message = format!("{}: a second orientation is given", second.subject);
            findings.at(Fault::Value, second, message);
            return None;
        }
        let no_direction = |value: &Value, findings: &mut Findings| {
            let message = format!("{} gives no orientation", value.subject);
            findings.at(Fault::Range, value, message);
        };
        let finite = |x: f64| x.is_finite() && x > 0.0;
        if let Some(value) = get("quat") {
            let q = findings.numbers(&value, [4, 4], NumberKind::Direction)?;
            let largest = q.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            if !finite(largest) {
                no_direction(&value, findings);
                return None;
            }
            let whole = q.iter().all(|x| x.abs() <= 1.0);
            let scale = if whole { 1.0 } else { largest };
            return Some(quaternion([
                q[0] / scale,
                q[1] / scale,
                q[2] / scale,
                q[3] / scale,
            ]));
        }
        if let Some(value) = get("axisangle") {
            let n = findings.numbers(&value, [4, 4], NumberKind::Direction)?;
            let axis = Vector3::new(n[0], n[1], n[2]);
            if !finite(axis.amax()) {
                no_direction(&value, findings);
                return None;
            }
            self.look_for_radians(&value, &n[3..], findings);
            return Some(rotation(unit(axis), n[3] * self.angle));
        }
        if let Some(value) = get("euler") {
            let angles = findings.numbers(&value, [3, 3], NumberKind::Direction)?;
            self.look_for_radians(&value, &angles, findings);
            let mut turned = UnitQuaternion::identity();
            for ((axis, is_fixed), angle) in self.euler.iter().zip(angles) {
                let mut direction = Vector3::zeros();
                direction[*axis] = 1.0;
                let turn = rotation(direction, angle * self.angle);
                turned = if *is_fixed {
                    turn * turned
                } else {
                    turned * turn
                };
            }
            return Some(turned);
        }
        if let Some(value) = get("xyaxes") {
            let n = findings.numbers(&value, [6, 6], NumberKind::Direction)?;
            let (x, y) = (
                Vector3::new(n[0], n[1], n[2]),
                Vector3::new(n[3], n[4], n[5]),
            );
            if !finite(x.amax()) || !finite(y.amax()) {
                no_direction(&value, findings);
                return None;
            }
            let x = unit(x);
            let y = unit(y);
            let y = y - x * x.dot(&y);
            if !finite(y.amax()) || y.amax() < 1e-9 {
                no_direction(&value, findings);
                return None;
            }
            let y = unit(y);
            let m = Matrix3::from_columns(&[x, y, x.cross(&y)]);
            let turned = Rotation3::from_matrix_unchecked(m);
            return Some(UnitQuaternion::from_rotation_matrix(&turned));
        }
        let value = get("zaxis")?;
        let z = findings.direction(&value)?;
        Some(along_z(z))
    }
}

fn unknown(value: &Value, expected: &str, findings: &mut Findings) {
    let shown: String = value.text.chars().take(40).collect();
    let message = format!("{}: expected {expected}, found `{shown}`", value.subject);
    findings.at(Fault::Value, value, message);
}

fn euler(word: &str) -> Option<[(usize, bool); 3]> {
    let axis = |c: char| match c {
        'x' => Some((0, false)),
        'y' => Some((1, false)),
        'z' => Some((2, false)),
        'X' => Some((0, true)),
        'Y' => Some((1, true)),
        'Z' => Some((2, true)),
        _ => None,
    };
    let axes: Vec<(usize, bool)> = word.chars().map_while(axis).collect();
    let axes: [(usize, bool); 3] = axes.try_into().ok()?;
    (word.chars().count() == 3).then_some(axes)
}
