//! Motions with a closed form, which is evaluated in `f64` with an error of a few units in the last
//! place.

use crate::reference::{Fact, Instant, Quantity, Reference, Trust};

/// Rounding error of a few products and of the sine of an angle between 10 and 100 rad.
const ROUNDING: f64 = 4e-15;

/// Times at which the closed forms are evaluated (s).
const TIMES: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// A body with a knife edge at its centre of mass slides on a plane with slope `σ` and rotates with
/// `ω`; x points downhill:
///
/// `x = g·sin σ/(2ω²)·sin²ωt`, `y = g·sin σ/(2ω²)·(ωt − sin 2ωt/2)`, `φ = ωt`,
/// `N = 2m·g·sin σ·sin ωt` across the edge.
///
/// Here g = 9.81 m/s², σ = 30°, m = 2 kg, ω = 0.5 rad/s. Source: Bloch, Nonholonomic Mechanics and
/// Control, chapter 1.
///
/// ```
/// let reference = suite::closed_forms::knife_edge();
/// let x = &reference.instants[3].facts[0];
/// assert!((x.value - 9.0206458501199992783).abs() < 1e-14); // computed to 20 digits
/// ```
#[must_use]
pub fn knife_edge() -> Reference {
    let (pull, mass, omega) = (9.81 * 0.5, 2.0, 0.5);
    let at = |t: f64| {
        let (sin, cos) = (omega * t).sin_cos();
        let along = pull / omega * sin;
        let size = pull / (2.0 * omega * omega);
        Instant {
            t,
            facts: [
                planar(
                    "skate",
                    POSITION,
                    [size * sin * sin, size * (omega * t - sin * cos), omega * t],
                ),
                planar("skate", VELOCITY, [along * cos, along * sin, omega]),
                planar(
                    "skate",
                    ACCELERATION,
                    [pull * (cos * cos - sin * sin), 2.0 * pull * sin * cos, 0.0],
                ),
                vec![fact("edge", Quantity::Normal, 2.0 * mass * pull * sin)],
            ]
            .concat(),
        }
    };
    reference(
        "Bloch, Nonholonomic Mechanics and Control, chapter 1: a cycloid.",
        at,
    )
}

/// A vertical disk rolls with spin rate `Ω` while its heading changes with rate `ω`, on a circle:
///
/// `x = RΩ/ω·sin ωt`, `y = RΩ/ω·(1 − cos ωt)`; the contact force is perpendicular to the heading,
/// `N = m·ω·RΩ`, and its component along the heading is zero.
///
/// Here m = 3 kg, R = 0.4 m, ω = 2 rad/s, Ω = 1 rad/s. Source: Bloch, Nonholonomic Mechanics and
/// Control, chapter 1.
///
/// ```
/// let reference = suite::closed_forms::rolling_disk();
/// let y = &reference.instants[3].facts[1];
/// assert!((y.value - 0.11838358763732160279).abs() < 1e-15); // computed to 20 digits
/// ```
#[must_use]
pub fn rolling_disk() -> Reference {
    let (mass, radius, turn, spin) = (3.0, 0.4, 2.0, 1.0);
    let (speed, size) = (radius * spin, radius * spin / turn);
    let at = |t: f64| {
        let (sin, cos) = (turn * t).sin_cos();
        let acceleration = [-turn * speed * sin, turn * speed * cos];
        Instant {
            t,
            facts: [
                planar(
                    "carrier",
                    POSITION,
                    [size * sin, size * (1.0 - cos), turn * t],
                ),
                planar("spin", POSITION, [0.0, 0.0, spin * t]),
                planar("carrier", VELOCITY, [speed * cos, speed * sin, turn]),
                planar("spin", VELOCITY, [0.0, 0.0, spin]),
                planar(
                    "carrier",
                    ACCELERATION,
                    [acceleration[0], acceleration[1], 0.0],
                ),
                planar("spin", ACCELERATION, [0.0; 3]),
                vec![
                    fact("edge", Quantity::Fx, mass * acceleration[0]),
                    fact("edge", Quantity::Fy, mass * acceleration[1]),
                    fact("edge", Quantity::Normal, mass * turn * speed),
                    fact("contact", Quantity::Fx, 0.0),
                    fact("contact", Quantity::Fy, 0.0),
                ],
            ]
            .concat(),
        }
    };
    reference(
        "Bloch, Nonholonomic Mechanics and Control, chapter 1: circles.",
        at,
    )
}

const POSITION: [Quantity; 3] = [Quantity::X, Quantity::Y, Quantity::Angle];
const VELOCITY: [Quantity; 3] = [Quantity::Vx, Quantity::Vy, Quantity::Omega];
const ACCELERATION: [Quantity; 3] = [Quantity::Ax, Quantity::Ay, Quantity::Alpha];

fn fact(of: &str, quantity: Quantity, value: f64) -> Fact {
    let of = of.to_owned();
    Fact {
        of,
        quantity,
        value,
    }
}

fn planar(body: &str, quantities: [Quantity; 3], values: [f64; 3]) -> Vec<Fact> {
    let pairs = quantities.into_iter().zip(values);
    pairs
        .map(|(quantity, value)| fact(body, quantity, value))
        .collect()
}

fn reference(source: &str, at: impl Fn(f64) -> Instant) -> Reference {
    Reference {
        source: source.to_owned(),
        trust: Trust {
            position: ROUNDING,
            velocity: ROUNDING,
            acceleration: ROUNDING,
            reaction: ROUNDING,
        },
        instants: TIMES.map(at).to_vec(),
    }
}
