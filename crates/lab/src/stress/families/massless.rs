//! Bodies without mass or inertia are accepted if and only if every motion has kinetic energy, or
//! is a rotation about the centre of mass that nothing restricts, without an acceleration.
//! Otherwise the error message describes a motion without mass or inertia.

use dynamics::MotionOptions;
use joints::Fixed;
use model::{Body, BodyRef, Description, Joint};

use crate::mechanisms::cranks::cranks;
use crate::mechanisms::revolute;
use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{acceleration, moving, prepared, worst};

/// All combinations of zero mass and zero inertia.
pub(super) const FAMILY: Family = Family {
    name: "massless",
    about: "m = 0 and J = 0 in every combination: accelerations where M is definite on the motions of C or a rotation influences nothing, else the massless motion by name",
    cases,
};

/// Acceleration of free fall (m/s²).
const G: f64 = 9.81;

/// Relative error bound of accelerations, for all extreme masses.
const BOUND: f64 = 1e-13;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    {
        let options = MotionOptions::to(1.0);
        for k in 0..32_u8 {
            let chain = Chain::nth(k);
            let run =
                move |o: &MotionOptions| falling(&chain.description(), &chain.accelerations(), o);
            cases.push(moving(chain.name(), options.clone(), chain.expected(), run));
        }
        for (name, pivots) in [
            ("parallelogram", &[0.0, 1.0][..]),
            ("three cranks", &[0.0, 1.0, 1.7]),
        ] {
            for k in 0..1_u8 << (pivots.len() + 1) {
                let case = massless_cranks(name, pivots, k, &options);
                cases.push(case);
            }
        }
        for [mass, inertia] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] {
            let right = if mass > 0.0 {
                Expected::answer(0.0, "a point mass falls")
            } else {
                Expected::refusal(&["without mass or inertia", "`stone`"])
            };
            let d = stone(mass, inertia);
            let name = format!("free body, m = {mass}, J = {inertia}");
            cases.push(moving(name, options.clone(), right, move |o| {
                falling(&d, &[0.0, -G, 0.0], o)
            }));
        }
        let right = Expected::answer(0.0, "it cannot move");
        let mut d = stone(0.0, 0.0);
        let weld = Fixed::new([0.0; 2], [0.0; 2]);
        d.joints = vec![Joint::new(
            "weld",
            &[BodyRef::Ground, BodyRef::Body(0)],
            weld,
        )];
        cases.push(moving("massless body, welded", options, right, move |o| {
            falling(&d, &[0.0; 3], o)
        }));
    }
    cases
}

fn stone(mass: f64, inertia: f64) -> Description {
    Description {
        name: "stone".into(),
        gravity: [0.0, -G],
        bodies: vec![Body {
            name: "stone".into(),
            mass,
            inertia,
            ..Body::default()
        }],
        ..Description::default()
    }
}

/// Two links that are horizontal and at rest. The centre of the first link is 1 m from the pin on
/// the ground, and the pin of the second link is 2 m from the pin on the ground. The centre of the
/// second link is 1 m beyond its pin or at its pin.
#[derive(Clone, Copy)]
struct Chain {
    /// Mass and inertia of both links, 0 or 1.
    links: [[f64; 2]; 2],
    /// Distance of the second centre from its pin (m).
    arm: f64,
}

impl Chain {
    fn nth(k: u8) -> Self {
        let bit = |place: u8| f64::from((k >> place) & 1);
        Self {
            links: [[bit(0), bit(1)], [bit(2), bit(3)]],
            arm: bit(4),
        }
    }

    fn name(&self) -> String {
        let [[m1, j1], [m2, j2]] = self.links;
        format!(
            "chain, m = {m1}, {m2}, J = {j1}, {j2}, second arm {} m",
            self.arm
        )
    }

    /// Returns the matrix A of the kinetic energy `½·αᵀ·A·α` in the rates α of the two angles, and
    /// the moments of the weights.
    fn reduced(&self) -> ([[f64; 2]; 2], [f64; 2]) {
        let ([[m1, j1], [m2, j2]], c) = (self.links, self.arm);
        let a = [
            [m1 + j1 + 4.0 * m2, 2.0 * c * m2],
            [2.0 * c * m2, c * c * m2 + j2],
        ];
        (a, [-G * (m1 + 2.0 * m2), -G * c * m2])
    }

    /// Returns the determinant, which is exact for integers.
    fn determinant(&self) -> f64 {
        let ([[a, b], [_, d]], _) = self.reduced();
        a * d - b * b
    }

    fn expected(&self) -> Expected {
        let ([[a, _], [_, d]], _) = self.reduced();
        match (self.determinant() == 0.0, a, d) {
            (true, 1.0.., 0.0) if self.arm == 0.0 => Expected::answer(
                BOUND,
                "closed form: one equation, the second link does not rotate",
            ),
            (false, ..) => Expected::answer(BOUND, "closed form: two equations in the angles"),
            // The rotation of the second link alone moves no mass.
            (true, 1.0.., 0.0) => Expected::refusal(&["without mass or inertia", "`second`"]),
            (true, ..) => Expected::refusal(&["without mass or inertia"]),
        }
    }

    fn accelerations(&self) -> Vec<f64> {
        let ([[a, b], [_, d]], [f, g]) = self.reduced();
        let det = self.determinant();
        let [first, second] = if self.arm == 0.0 && d == 0.0 {
            [f / a, 0.0]
        } else {
            [(f * d - b * g) / det, (a * g - b * f) / det]
        };
        vec![
            0.0,
            first,
            first,
            0.0,
            2.0 * first + self.arm * second,
            second,
        ]
    }

    fn description(&self) -> Description {
        let body = |name: &str, [mass, inertia]: [f64; 2], x: f64| Body {
            name: name.into(),
            mass,
            inertia,
            position: [x, 0.0],
            ..Body::default()
        };
        let bodies = vec![
            body("first", self.links[0], 1.0),
            body("second", self.links[1], 2.0 + self.arm),
        ];
        let [first, second] = [BodyRef::Body(0), BodyRef::Body(1)];
        let joints = vec![
            revolute("pivot", &bodies, [BodyRef::Ground, first], [0.0, 0.0]),
            revolute("hinge", &bodies, [first, second], [2.0, 0.0]),
        ];
        Description {
            name: "chain".into(),
            gravity: [0.0, -G],
            bodies,
            joints,
            ..Description::default()
        }
    }
}

/// Returns a case with cranks under a coupler. Some cranks are massless, and all cranks have the
/// same angle.
fn massless_cranks(name: &str, pivots: &[f64], massless: u8, options: &MotionOptions) -> Case {
    let (length, theta) = (0.5, 1.0_f64);
    let mut d = cranks(pivots, length, theta);
    d.gravity = [0.0, -G];
    let mut names = Vec::new();
    for (k, body) in d.bodies.iter_mut().enumerate() {
        if (massless >> k) & 1 == 1 {
            (body.mass, body.inertia) = (0.0, 0.0);
            names.push(body.name.clone());
        }
    }
    let (coupler, links) = match d.bodies.split_last() {
        Some((coupler, links)) => (coupler.mass, links.iter().map(|b| b.mass).sum::<f64>()),
        None => (0.0, 0.0),
    };
    let moment = -G * theta.cos() * length * (0.5 * links + coupler);
    let alpha = moment / (length * length * (links / 3.0 + coupler));
    let right = if names.len() > pivots.len() {
        Expected::refusal(&["without mass or inertia"])
    } else {
        Expected::answer(BOUND, "closed form: one equation in the common angle")
    };
    let at = |r: f64| [-r * theta.sin() * alpha, r * theta.cos() * alpha];
    let mut a: Vec<f64> = Vec::new();
    for _ in pivots {
        a.extend(at(0.5 * length));
        a.push(alpha);
    }
    a.extend(at(length));
    a.push(0.0);
    let what = if names.is_empty() {
        "nothing massless".to_owned()
    } else {
        format!("massless: {}", names.join(", "))
    };
    moving(
        format!("{name}, {what}"),
        options.clone(),
        right,
        move |o| falling(&d, &a, o),
    )
}

/// Returns the error of the accelerations at the initial state, relative to the largest exact
/// acceleration.
fn falling(d: &Description, right: &[f64], options: &MotionOptions) -> Result<Outcome, Outcome> {
    let found = acceleration(&prepared(d)?, options)?;
    let scale = worst(right.iter().copied());
    let off = worst(found.iter().zip(right).map(|(a, b)| a - b));
    let whole = found.len() == right.len();
    let error = match (whole, scale > 0.0) {
        (false, _) => f64::NAN,
        (true, true) => off / scale,
        (true, false) => off,
    };
    Ok(Outcome::answer(
        error,
        format!("largest acceleration {scale:.3}"),
    ))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn accepted_exactly_where_every_motion_has_mass() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn another_inertia_is_silently_wrong() {
        let chain = Chain::nth(0b11111);
        let mut d = chain.description();
        d.bodies[0].inertia = 1.0 + 1e-11;
        let found = falling(&d, &chain.accelerations(), &MotionOptions::to(1.0)).expect("it falls");
        assert_eq!(judge(&chain.expected(), &found), Judgement::SilentlyWrong);
    }
}
