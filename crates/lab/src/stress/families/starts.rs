//! Initial states that do not satisfy their constraints. The result is the smallest correction in
//! the mass metric, or a message that describes the error.

use model::start::scene_size;

use crate::stress::case::{Case, Expected, Family, Outcome};
use crate::stress::motion::{asking, study, worst};

/// One body on a pivot, described at a wrong position or with impossible velocities.
pub(super) const FAMILY: Family = Family {
    name: "starts",
    about: "a start off its constraints is moved by the least in the mass metric, and the correction is answer; far from them it is refused",
    cases,
};

/// Returns a bob with a pivot 1 m to the left of the bob. The described centre of the bob is
/// displaced by `off` to the right.
fn bob(off: f64, mass: f64, inertia: f64, velocity: [f64; 2], start: &str) -> String {
    let [vx, vy] = velocity;
    format!(
        r#"
scene = {{ name = "bob", space = "plane" }}
body = [{{ name = "bob", mass = {mass:e}, inertia = {inertia:e}, position = [{x:?}, 0.0], velocity = [{vx:?}, {vy:?}] }}]
joint = [{{ name = "pivot", type = "revolute", bodies = ["ground", "bob"], points = {{ ground = [0.0, 0.0], bob = [-1.0, 0.0] }} }}]
{start}
"#,
        x = 1.0 + off
    )
}

/// Returns the bob at rest, displaced by `off` to the right of the position that its pivot allows.
fn off_by(off: f64, start: &str) -> String {
    bob(off, 2.0, 0.3, [0.0; 2], start)
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for k in 1..=16 {
        let off = 10_f64.powi(-k);
        let right = match k {
            1 | 2 => Expected::refusal(&[
                "the start must be corrected by",
                "`bob`",
                "allow_correction",
            ]),
            // The displacement of 1e-3 of the size is omitted, because it is exactly the limit.
            3 => continue,
            _ => Expected::answer(
                1e-14,
                "closed form: back along the arm; rounding of numbers of size 1",
            ),
        };
        let case = asking(format!("{off:.0e} m off"), "start", right, move || {
            corrected(&off_by(off, ""), off)
        });
        cases.push(case.at("distance (m)", off));
    }
    let right = || {
        Expected::answer(
            1e-14,
            "closed form: back along the arm; rounding of numbers of size 1",
        )
    };
    let allowed = "start = { allow_correction = true }";
    for off in [0.01, 0.1, 0.5, 3.0] {
        cases.push(asking(
            format!("{off} m off, allowed"),
            "start",
            right(),
            move || corrected(&off_by(off, allowed), off),
        ));
    }
    for k in (-24..=24).step_by(6) {
        let ratio = 10_f64.powi(k);
        let right = Expected::answer(
            1e-13,
            "closed form: ω = 1/(1 + J/(m·L²)) of the described speed, relative",
        );
        let case = asking(
            format!("velocities with J/m = {ratio:.0e} m²"),
            "start",
            right,
            move || turned(ratio),
        );
        cases.push(case.at("J/m (m²)", ratio));
    }
    let kept = r#"start = { keep = ["bob.vx"] }"#;
    let right = Expected::refusal(&["`vx` of body `bob` is fixed by `keep` at 1", "pivot"]);
    cases.push(asking(
        "a velocity is held that no motion has",
        "start",
        right,
        move || {
            study(&bob(0.0, 1.0, 1.0, [1.0, 0.0], kept)).map(|_| Outcome::fact(false, "a start"))
        },
    ));
    let apart = bob(0.0, 1.0, 1.0, [0.0; 2], "").replace(
        "joint = [",
        r#"joint = [{ name = "second", type = "revolute", bodies = ["ground", "bob"], points = { ground = [0.5, 0.0], bob = [0.0, 0.0] } }, "#,
    );
    let right = Expected::refusal(&["cannot be assembled", "pivot", "second"]);
    cases.push(asking(
        "pivots that do not fit",
        "start",
        right,
        move || study(&apart).map(|_| Outcome::fact(false, "a start")),
    ));
    cases
}

/// The correction is along the lever arm. It does not rotate the bob or displace it sideways.
fn corrected(text: &str, off: f64) -> Result<Outcome, Outcome> {
    let found = study(text)?.prepared;
    let [x, y, angle] = found.q[..] else {
        return Ok(Outcome::fact(false, "not three coordinates"));
    };
    // The bound allows for the rounding error of a described value of size 1.
    let answer = found
        .assembly
        .correction
        .iter()
        .fold(0.0_f64, |a, c| a.max(c.abs()));
    let size = scene_size(&found.mechanism, &found.q);
    let error = worst([x - 1.0, y, angle, answer - off]);
    Ok(Outcome::answer(
        error,
        format!("corrected by {answer:e} m in a scene of {size} m"),
    ))
}

/// The bob is described with the velocity (0, 1) m/s and without rotation. The nearest possible
/// motion is a rotation about the pivot.
fn turned(ratio: f64) -> Result<Outcome, Outcome> {
    let allowed = "start = { allow_correction = true }";
    let given = bob(0.0, 1.0, ratio, [0.7, 1.0], allowed)
        .replace("velocity = [", "angular_velocity = 0.0, velocity = [");
    let found = study(&given)?.prepared;
    let omega = 1.0 / (1.0 + ratio);
    let error = worst([
        found.v[1] / omega - 1.0,
        found.v[2] / omega - 1.0,
        found.v[0] / omega,
    ]);
    Ok(Outcome::answer(error, format!("v = {:?}", found.v)))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;

    #[test]
    fn corrections_are_the_smallest() {
        super::super::assert_passes(FAMILY);
    }

    #[test]
    fn another_correction_is_silently_wrong() {
        let right = Expected::answer(1e-14, "closed form");
        for (off, judgement) in [(1e-5, Judgement::Right), (2e-5, Judgement::SilentlyWrong)] {
            let found = corrected(&off_by(off, ""), 1e-5).expect("a start");
            assert_eq!(judge(&right, &found), judgement, "{off}");
        }
    }
}
