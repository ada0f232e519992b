//! Cases in which one number of a scene is replaced, for each number of the scene. If the new
//! number is NaN or infinite, the program must reject the scene. If the new number is finite, such
//! as ±1e308 or 0, the program may reject the scene. If the program accepts the scene, the first
//! row of the motion must be finite.

use std::ops::ControlFlow;

use dynamics::{MotionOptions, simulate};
use model::{Body, Description, Function};

use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{asking, built, refused, study};

/// Cases in which one number of a scene is replaced.
pub(super) const FAMILY: Family = Family {
    name: "bad-numbers",
    about: "NaN and infinity in every place of a scene: refused with the name of the key; 1e±308, 0 and −1 there: finite numbers or a refusal",
    cases,
};

/// A scene that contains every section, most keys and every kind of function.
const SCENE: &str = r#"
[scene]
name = "all"
space = "plane"
gravity = [0.1, -9.81]
[[body]]
name = "a"
mass = 1.0
inertia = 0.1
position = [1.0, 0.25]
angle = 0.5
velocity = [0.0, 0.0]
angular_velocity = 0.0
[[body]]
name = "b"
mass = 2.0
inertia = 0.2
position = [2.0, 0.5]
[[body]]
name = "c"
mass = 3.0
inertia = 0.3
position = [4.0, -1.0]
[[joint]]
name = "pivot"
type = "revolute"
bodies = ["ground", "a"]
points = { ground = [0.0, 0.0], a = [-0.9974371443, 0.2600296393] }
[[joint]]
name = "slide"
type = "translational"
bodies = ["a", "b"]
at = [1.5, 0.5]
axis = [1.0, 0.5]
[[joint]]
name = "rod"
type = "distance"
bodies = ["b", "c"]
at = [[2.0, 1.0], [4.0, -0.5]]
[[joint]]
name = "gears"
type = "gear"
bodies = ["a", "c"]
ratio = -2.0
[[joint]]
name = "edge"
type = "knife-edge"
body = "c"
point = [0.5, 0.5]
normal = [0.25, 1.0]
[[drive]]
name = "push"
joint = "slide"
type = "displacement"
motion = { type = "steps", start = 0.5, steps = [{ from = 1.0, to = 2.0, by = 0.25 }] }
[[force]]
name = "spring"
type = "spring-damper"
bodies = ["ground", "c"]
at = [[5.0, 5.0], [4.0, -1.0]]
stiffness = 10.0
damping = 0.5
free_length = 5.0
[[force]]
name = "torsion"
type = "torsion-spring-damper"
bodies = ["a", "b"]
stiffness = 3.0
damping = 0.25
free_angle = 0.125
[[force]]
name = "bush"
type = "bushing"
bodies = ["a", "c"]
at = [3.0, 3.0]
stiffness = [1.0, 2.0, 3.0]
damping = [0.5, 0.25, 0.125]
[[force]]
name = "pull"
type = "point-force"
body = "b"
point = [0.5, 0.25]
force = [1.5, { type = "harmonic", amplitude = 2.0, omega = 3.0, phase = 0.5, offset = 0.25 }]
[[force]]
name = "turn"
type = "torque"
body = "a"
torque = { type = "polynomial", coefficients = [1.0, 0.5, 0.25] }
[[force]]
name = "shaft"
type = "torque"
body = "c"
torque = { type = "table", times = [0.0, 1.0, 2.0, 3.0], values = [0.0, 0.5, 0.25, 1.0] }
[simulate]
t_end = 0.5
output_step = 0.25
rtol = 1e-6
atol = 1e-8
"#;

/// A number of the text.
struct Place {
    /// The range in the text.
    span: std::ops::Range<usize>,
    /// The key of the number.
    key: String,
    /// A readable name, which consists of the table, the key, and the index of the number after the
    /// key.
    name: String,
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for place in places(SCENE) {
        for bad in ["nan", "inf", "-inf"] {
            let text = with(&place, bad);
            let right = Expected::refusal(&[&format!("`{}`", place.key), "finite"]);
            cases.push(asking(place.name.clone(), bad, right, move || {
                first_row(&text)
            }));
        }
        for edge in ["1e308", "-1e308", "1e-308", "0.0", "-1.0"] {
            let text = with(&place, edge);
            let right = Expected::AnswerOrRefusal {
                bound: 0.0,
                source: "every coordinate, velocity and acceleration of the first row is finite",
                parts: Vec::new(),
            };
            cases.push(asking(place.name.clone(), edge, right, move || {
                first_row(&text)
            }));
        }
    }
    cases.extend(fields());
    cases
}

/// Returns cases for the values of a description that a Rust program builds without the text of a
/// scene.
fn fields() -> Vec<Case> {
    type Set = fn(&mut Description, f64);
    let fields: [(&str, Set); 6] = [
        ("mass", |d, x| d.bodies[0].mass = x),
        ("inertia", |d, x| d.bodies[0].inertia = x),
        ("position", |d, x| d.bodies[0].position[1] = x),
        ("angle", |d, x| d.bodies[0].angle = x),
        ("velocity", |d, x| d.bodies[0].velocity = Some([x, 0.0])),
        ("angular velocity", |d, x| {
            d.bodies[0].angular_velocity = Some(x);
        }),
    ];
    let mut cases = Vec::new();
    for (bad, word) in [
        (f64::NAN, "nan"),
        (f64::INFINITY, "inf"),
        (f64::NEG_INFINITY, "-inf"),
    ] {
        for (field, set) in fields {
            let right = Expected::refusal(&["stone", field]);
            cases.push(asking(
                format!("library: {field}"),
                word,
                right,
                move || {
                    let mut d = Description {
                        bodies: vec![Body {
                            name: "stone".into(),
                            mass: 1.0,
                            inertia: 1.0,
                            ..Body::default()
                        }],
                        ..Description::default()
                    };
                    set(&mut d, bad);
                    built(&d).map(|_| Outcome::fact(false, "a mechanism"))
                },
            ));
        }
        let right = Expected::refusal(&["finite"]);
        cases.push(asking(
            "library: coefficient of a function",
            word,
            right,
            move || {
                let made = Function::polynomial(&[1.0, bad]).map_err(Outcome::refused);
                made.map(|_| Outcome::fact(false, "a function"))
            },
        ));
    }
    cases
}

/// Returns the text of the scene with the given number at this place.
fn with(place: &Place, number: &str) -> String {
    let mut text = SCENE.to_owned();
    text.replace_range(place.span.clone(), number);
    text
}

/// Returns all numbers of a text, except numbers in quotes.
fn places(text: &str) -> Vec<Place> {
    let (mut places, mut from, mut table) = (Vec::new(), 0, String::new());
    for line in text.split_inclusive('\n') {
        if let Some(name) = line.strip_prefix("name = ") {
            table = name.trim().trim_matches('"').to_owned();
        } else if line.starts_with('[') {
            table = line.trim().trim_matches(['[', ']']).to_owned();
        }
        let (mut key, mut n, mut at) = (String::new(), 0, 0);
        for word in line.split_inclusive([' ', '[', ']', '{', '}', ',', '\n']) {
            let token = word.trim_end_matches([' ', '[', ']', '{', '}', ',', '\n']);
            if token.parse::<f64>().is_ok() {
                n += 1;
                let start = from + at;
                places.push(Place {
                    span: start..start + token.len(),
                    key: key.clone(),
                    name: format!("{table}: {key}, number {n} of its line"),
                });
            } else if token.starts_with(|c: char| c.is_ascii_lowercase()) {
                key = token.to_owned();
            }
            at += word.len();
        }
        from += line.len();
    }
    places
}

/// Returns the first row of the motion.
fn first_row(text: &str) -> Result<Outcome, Outcome> {
    let study = study(text)?;
    study.plan().map_err(|e| refused(&e))?;
    let options = study
        .options
        .clone()
        .unwrap_or_else(|| MotionOptions::to(1.0));
    let mut finite = false;
    let run = simulate(&study.prepared, &options, |sample| {
        let a = sample.acceleration()?;
        let mut all = sample.q.iter().chain(sample.v).chain(&a);
        finite = all.all(|x| x.is_finite());
        Ok(ControlFlow::Break(()))
    });
    match run {
        Ok(_) => Ok(Outcome::fact(finite, "a first row")),
        Err(failure) => Err(Outcome::refused(&failure.error)),
    }
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn every_number_is_judged() {
        assert_eq!(places(SCENE).len(), 79);
        super::super::assert_passes(FAMILY);
    }

    /// The original scene is not rejected.
    #[test]
    fn an_answer_where_a_refusal_is_right_is_silently_wrong() {
        let found = first_row(SCENE).expect("the scene moves");
        assert_eq!(
            judge(&Expected::answer(0.0, "finite"), &found),
            Judgement::Right
        );
        assert_eq!(
            judge(&Expected::refusal(&["finite"]), &found),
            Judgement::SilentlyWrong
        );
    }
}
