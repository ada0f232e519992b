//! Motions far from the origin. Coordinates are accurate only to their last digit, but no further
//! accuracy may be lost.

use dynamics::{MotionOptions, Summary};

use crate::stress::case::{Case, Expected, Family};
use crate::stress::motion::{Row, case, combinations, steps, worst};

/// A skate on a slope, and a turning parallelogram with a redundant crank.
pub(super) const FAMILY: Family = Family {
    name: "far-away",
    about: "a skate on a slope and three turning cranks, up to 1e9 m from the origin",
    cases,
};

/// Tolerance and duration of the runs.
const RTOL: f64 = 1e-10;
const T_END: f64 = 2.0;

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for exponent in [0, 3, 6, 9] {
        let x = if exponent == 0 {
            0.0
        } else {
            10.0_f64.powi(exponent)
        };
        // The relative tolerance of a coordinate refers to the distance from the origin.
        let known = RTOL.max(100.0 * f64::EPSILON * x.max(1.0));
        let base = MotionOptions {
            rtol: RTOL / x.max(1.0),
            atol: known,
            ..MotionOptions::to(T_END)
        };
        let base = MotionOptions {
            rtol: base.rtol.max(1e-15),
            ..base
        };
        for options in combinations(&base) {
            let tolerances = (10.0 * steps(options.method, 2.0 * T_END, known)).max(1e4);
            let right = Expected::answer(
                tolerances * known.max(1e-15 * x),
                "closed forms; ten tolerances a step, 1e4 in all where steps are few; the tolerance is at least a hundred roundings of the \
                 distance",
            );
            let name = format!("skate at {x:e} m");
            let made = case(
                name,
                skate(x),
                options.clone(),
                right.clone(),
                move |row, _| off_cycloid(row, x),
            );
            cases.push(made.at("distance", x.max(1.0)));
            let name = format!("cranks at {x:e} m");
            let made = case(name, turning(x), options, right, move |row, s| {
                off_circle(row, s, x)
            });
            cases.push(made.at("distance", x.max(1.0)));
        }
    }
    cases
}

/// Returns a skate at (x, −x) that rotates at 0.5 rad/s on a slope of 30° along x. The motion is
/// the cycloid of the knife edge in `suite`.
fn skate(x: f64) -> String {
    format!(
        r#"
scene = {{ name = "skate", space = "plane", gravity = [{PULL}, 0.0] }}
body = [{{ name = "skate", mass = 2.0, inertia = 0.3, position = [{x:?}, {y:?}], angular_velocity = {TURN} }}]
joint = [{{ name = "edge", type = "knife-edge", body = "skate", at = [{x:?}, {y:?}], normal = [0.0, 1.0] }}]
"#,
        y = -x
    )
}

const PULL: f64 = 4.905;
const TURN: f64 = 0.5;

fn off_cycloid(row: &Row, x: f64) -> f64 {
    let (sin, cos) = (TURN * row.t).sin_cos();
    let size = 0.5 * PULL / (TURN * TURN);
    let (along, turned) = (PULL / TURN * sin, TURN * row.t);
    let place = [size * sin * sin, size * (turned - sin * cos), turned];
    worst([
        row.q[0] - x - place[0],
        row.q[1] + x - place[1],
        row.q[2] - place[2],
        row.v[0] - along * cos,
        row.v[1] - along * sin,
        row.v[2] - TURN,
    ])
}

/// Returns three cranks under a coupler at (x, x). Without gravity the cranks rotate uniformly,
/// from 57° to 172°.
fn turning(x: f64) -> String {
    let (sin, cos) = 1.0_f64.sin_cos();
    let mut bodies = String::new();
    let mut joints = String::new();
    for (k, at) in [0.0, 1.0, 2.5].into_iter().enumerate() {
        let pivot = [x + at, x];
        let middle = [pivot[0] + 0.5 * cos, pivot[1] + 0.5 * sin];
        let speed = [-0.5 * sin, 0.5 * cos];
        let tip = [pivot[0] + cos, pivot[1] + sin];
        bodies += &format!(
            "[[body]]\nname = \"crank-{k}\"\nmass = 1.0\ninertia = 0.1\nposition = {middle:?}\nangle = 1.0\nvelocity = {speed:?}\nangular_velocity = 1.0\n"
        );
        joints += &format!(
            "[[joint]]\nname = \"pivot-{k}\"\ntype = \"revolute\"\nbodies = [\"ground\", \"crank-{k}\"]\nat = {pivot:?}\n\
             [[joint]]\nname = \"tip-{k}\"\ntype = \"revolute\"\nbodies = [\"crank-{k}\", \"coupler\"]\nat = {tip:?}\n"
        );
    }
    let middle = [x + 1.25 + cos, x + sin];
    let speed = [-sin, cos];
    format!(
        "scene = {{ name = \"cranks\", space = \"plane\" }}\n{bodies}[[body]]\nname = \"coupler\"\nmass = 2.0\ninertia = 0.4\nposition = {middle:?}\nvelocity = {speed:?}\n{joints}"
    )
}

fn off_circle(row: &Row, _: &Summary, x: f64) -> f64 {
    let angle = 1.0 + row.t;
    let (sin, cos) = angle.sin_cos();
    let of_crank = |k: usize| [row.q[3 * k + 2] - angle, row.v[3 * k + 2] - 1.0];
    let coupler = [row.q[9] - x - 1.25 - cos, row.q[10] - x - sin, row.q[11]];
    worst((0..3).flat_map(of_crank).chain(coupler))
}

#[cfg(test)]
mod tests {
    use crate::stress::Judgement;

    use super::*;
    use crate::stress::judge;
    use crate::stress::motion::outcome;

    #[test]
    fn another_place_is_silently_wrong() {
        let options = MotionOptions::to(T_END);
        let found = outcome(&skate(1e6), &options, |row, _| off_cycloid(row, 1e6 + 1e-3));
        let right = Expected::answer(1e-6, "closed form");
        assert_eq!(judge(&right, &found), Judgement::SilentlyWrong);
    }
}
