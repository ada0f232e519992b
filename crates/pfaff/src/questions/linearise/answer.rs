//! A linearised motion: matrices, eigenvalues and modes.

use dynamics::linearise::{Coordinate, Linearisation, Mode, Stability};
use linalg::Matrix;
use report::ByName;
use serde::Serialize;

/// A linearised motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LineariseAnswer {
    /// Name of the scene.
    pub scene: String,
    /// Time of the state (s).
    pub time: f64,
    /// The states x: positions, then velocities.
    pub states: Vec<NamedState>,
    /// Number of positions among the states.
    pub positions: usize,
    /// The inputs u.
    pub inputs: Vec<NamedInput>,
    /// Drives and joints that are locked at this time because the state is at rest, and that
    /// functions of time would accelerate.
    pub held: Vec<String>,
    /// The matrix A of `ẋ = A·x + B·u`, by rows.
    pub a: Vec<Vec<f64>>,
    /// The matrix B, by rows.
    pub b: Vec<Vec<f64>>,
    /// M, D and K of `M·ÿ + D·ẏ + K·y`; `null` for moving states, for nonholonomic rows and if a
    /// cyclic coordinate is eliminated.
    pub second_order: Option<SecondOrderMatrices>,
    /// Difference between two orders of approximation, as a fraction of the largest derivative.
    pub accuracy: f64,
    /// First-order stability of small motions; `null` without eigenvalues.
    pub stability: Option<&'static str>,
    /// The modes, the fastest growing modes first; `null` without eigenvalues.
    pub modes: Option<Vec<ModeOfMotion>>,
    /// Pages of modes, each with the index of its mode, from 0.
    #[serde(skip)]
    pub pages: Vec<(usize, String)>,
}

/// A state of the linearised motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NamedState {
    /// Name of the body and coordinate.
    pub name: String,
    /// Unit of the state.
    pub unit: &'static str,
}

/// An input of the linearised motion.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NamedInput {
    /// Name of the drive or force.
    pub name: String,
    /// Kind of the input: `value`, `rate` or `acceleration` of a drive, or the function of a force.
    pub what: String,
}

/// Matrices of `M·ÿ + D·ẏ + K·y`, by rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SecondOrderMatrices {
    /// Matrix M.
    pub mass: Vec<Vec<f64>>,
    /// Matrix D.
    pub damping: Vec<Vec<f64>>,
    /// Matrix K.
    pub stiffness: Vec<Vec<f64>>,
}

/// A mode of the linearised motion. A conjugate pair is listed once, by the eigenvalue with the
/// positive imaginary part.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ModeOfMotion {
    /// Real part of the eigenvalue (1/s).
    pub real: f64,
    /// Imaginary part of the eigenvalue (rad/s).
    pub imaginary: f64,
    /// Frequency of the damped oscillation (Hz): Im λ/2π; zero if the mode does not oscillate.
    pub frequency: f64,
    /// Frequency of the oscillation without damping (Hz): |λ|/2π; `null` if the mode does not
    /// oscillate.
    pub natural_frequency: Option<f64>,
    /// Damping ratio −Re λ/|λ|; `null` for λ = 0.
    pub damping_ratio: Option<f64>,
    /// Shape: real and imaginary part of each state; the largest position is scaled to 1.
    pub shape: ByName<[f64; 2]>,
}

impl LineariseAnswer {
    /// Builds the answer for a linearised motion of a scene. If the modes are known, the answer
    /// contains them.
    pub(super) fn new(scene: &str, x: &Linearisation, modes: Option<&[Mode]>) -> Self {
        let states: Vec<&Coordinate> = x.positions.iter().chain(&x.velocities).collect();
        let mode = |mode: &Mode| ModeOfMotion {
            real: mode.value[0],
            imaginary: mode.value[1],
            frequency: mode.value[1] / std::f64::consts::TAU,
            natural_frequency: mode
                .oscillates()
                .then(|| mode.natural_frequency() / std::f64::consts::TAU),
            damping_ratio: mode.damping_ratio(),
            shape: ByName(
                states
                    .iter()
                    .zip(&mode.states)
                    .map(|(state, z)| (state.name.clone(), *z))
                    .collect(),
            ),
        };
        Self {
            scene: scene.to_owned(),
            time: x.time,
            positions: x.positions.len(),
            inputs: x
                .inputs
                .iter()
                .map(|input| NamedInput {
                    name: input.name.clone(),
                    what: input.what.clone(),
                })
                .collect(),
            held: x.held.clone(),
            a: rows(&x.a),
            pages: Vec::new(),
            b: rows(&x.b),
            second_order: x.second_order.as_ref().map(|second| SecondOrderMatrices {
                mass: rows(&second.mass),
                damping: rows(&second.damping),
                stiffness: rows(&second.stiffness),
            }),
            accuracy: x.accuracy,
            stability: modes.map(|modes| Stability::of(modes).word()),
            modes: modes.map(|modes| modes.iter().map(mode).collect()),
            states: states
                .iter()
                .map(|state| NamedState {
                    name: state.name.clone(),
                    unit: state.unit,
                })
                .collect(),
        }
    }
}

fn rows(m: &Matrix) -> Vec<Vec<f64>> {
    (0..m.nrows()).map(|i| m.row(i).to_vec()).collect()
}
