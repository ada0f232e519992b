//! Tests of the scene reader through its public functions.

mod active;
mod armature;
mod cover;
mod diagnostics;
mod elements;
mod language;
mod locate;
mod mutations;
mod own_joint;
mod places;
mod plausible;
mod robot_trolley;
mod schema;
mod silence;
mod space;
mod tolerance;
mod validator;
mod words;

use model::Registry;
use pfaff_scene::{Diagnostic, Scene};

/// The mechanism of the published paper.
const ROBOT: &str = include_str!("../../../robot-trolley/robot-trolley.toml");

/// The bodies are a at (1, 2), rotated by 90°, b at (3, 2), and c at (0, 0).
const BODIES: &str = r#"[scene]
name = "small"
space = "plane"

[[body]]
name = "a"
mass = 1.0
inertia = 1.0
position = [1.0, 2.0]
angle = 1.5707963267948966

[[body]]
name = "b"
mass = 1.0
inertia = 1.0
position = [3.0, 2.0]

[[body]]
name = "c"
mass = 1.0
inertia = 1.0

"#;

/// Reads a text with the standard registry of joints and forces.
fn read(text: &str) -> Result<Scene, Vec<Diagnostic>> {
    pfaff_scene::read("x.toml", text, &Registry::standard())
}

/// Reads a scene with these three bodies and further text.
fn read_more(text: &str) -> Scene {
    read(&format!("{BODIES}{text}")).unwrap_or_else(|problems| panic!("{text}\n{problems:#?}"))
}

/// Rounding error of several operations on numbers of size one.
const ROUNDING: f64 = 1e-14;

/// Compares values with those derived by hand.
#[track_caller]
fn assert_close(found: &[f64], expected: &[f64]) {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDING;
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(near),
        "found {found:?}, expected {expected:?}"
    );
}
