//! Bounds of reactions for joints of any stiffness, compared with closed forms and with elastic
//! supports of many compliances, which are computed by least squares.

mod assumption;
mod ends;
mod equilibrium;
mod hull;
mod invariance;
mod parts;
mod within;

use model::ConstraintId;
use pfaff::prelude::*;
use pfaff::solvability::{ElasticBounds, Elasticity, Group, ReactionBounds, Term};
use tests::numbers::Numbers;

fn study(text: &str) -> Study {
    let options = RunOptions {
        t_end: Some(1.0),
        ..RunOptions::default()
    };
    Study::read("bounds.toml", text, &Registry::standard(), &options)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Returns the bounds of a component.
fn of(found: &ReactionBounds<'_, '_>, id: usize, name: &str) -> ElasticBounds {
    let term = Term {
        reaction: ConstraintId(id),
        component: name.to_owned(),
        coefficient: 1.0,
    };
    let numbers = found
        .group(&Group::Combination(vec![term]))
        .expect("bounds");
    numbers[0].1.clone()
}

/// The joints that do not give way.
fn rigid(ids: impl Into<Vec<ConstraintId>>) -> Elasticity {
    Elasticity {
        rigid: ids.into(),
        ..Elasticity::default()
    }
}

fn assert_range(found: &ElasticBounds, expected: [f64; 2], what: &str) {
    let size = 1e-9 * (1.0 + expected[0].abs().max(expected[1].abs()));
    for (found, expected) in [found.lowest, found.highest].into_iter().zip(expected) {
        assert!(
            (found - expected).abs() < size,
            "{what}: {found} {expected}"
        );
    }
}

/// A bar of 1 m, clamped at the left, on a roller at the right.
const CLAMPED: &str = r#"scene = { name = "bar", space = "plane", gravity = [0.0, -1.0] }
        body = [{ name = "bar", mass = 1.0, inertia = 1.0, position = [0.25, 0.0] }]
        joint = [
            { name = "clamp", type = "fixed", bodies = ["bar", "ground"], at = [0.0, 0.0] },
            { name = "roller", type = "point-on-line", body = "bar", at = [1.0, 0.0], line = [[0.0, 0.0], [1.0, 0.0]] },
        ]"#;

/// A table on four legs whose mass centre is not at the middle.
const TABLE: &str = r#"scene = { name = "table", space = "spatial", gravity = [0.0, 0.0, -9.81] }
        body = [{ name = "top", mass = 12.0, inertia = [1.0, 1.0, 2.0], position = [0.2, 0.1, 0.0] }]
        joint = [
            { name = "A", type = "point-on-plane", bodies = ["ground", "top"], at = [0.6, 0.4, 0.0], normal = [0, 0, 1] },
            { name = "B", type = "point-on-plane", bodies = ["ground", "top"], at = [-0.6, 0.4, 0.0], normal = [0, 0, 1] },
            { name = "C", type = "point-on-plane", bodies = ["ground", "top"], at = [-0.6, -0.4, 0.0], normal = [0, 0, 1] },
            { name = "D", type = "point-on-plane", bodies = ["ground", "top"], at = [0.6, -0.4, 0.0], normal = [0, 0, 1] },
        ]"#;

/// A body on random joints in the plane or in space.
fn random(numbers: &mut Numbers, in_space: bool) -> String {
    let mut joints = String::new();
    let point = |numbers: &mut Numbers| {
        let n = if in_space { 3 } else { 2 };
        let all: Vec<String> = (0..n).map(|_| format!("{:.3}", numbers.unit())).collect();
        format!("[{}]", all.join(", "))
    };
    let kinds: &[&str] = if in_space {
        &[
            "spherical",
            "spherical",
            "revolute",
            "fixed",
            "point-on-plane",
        ]
    } else {
        &["revolute", "revolute", "fixed", "point-on-line"]
    };
    // Joints in a line or on the same point are the degenerate cases.
    let line = numbers.once_in(4);
    let count = if in_space { 3 } else { 4 };
    for k in 0..count + numbers.below(2) {
        let kind = kinds[numbers.below(kinds.len())];
        let at = if line {
            let x = k as f64 - 1.0;
            if in_space {
                format!("[{x}, 0.0, 0.5]")
            } else {
                format!("[{x}, 0.5]")
            }
        } else {
            point(numbers)
        };
        let more = match kind {
            "revolute" if in_space => ", axis = [1.0, 0.0, 0.0]".to_owned(),
            "point-on-plane" => ", normal = [0.0, 0.0, 1.0]".to_owned(),
            "point-on-line" => format!(", line = [{at}, [2.0, {:.3}]]", numbers.unit()),
            _ => String::new(),
        };
        let of = match kind {
            "point-on-line" => "body = \"lid\"",
            _ => "bodies = [\"lid\", \"ground\"]",
        };
        joints.push_str(&format!(
            "{{ name = \"j{k}\", type = \"{kind}\", {of}, at = {at}{more} }},\n"
        ));
    }
    let (space, gravity, inertia) = if in_space {
        (
            "spatial",
            format!("[{:.3}, 1.0, -9.81]", numbers.unit()),
            "[1.0, 2.0, 1.5]",
        )
    } else {
        ("plane", format!("[{:.3}, -9.81]", numbers.unit()), "1.0")
    };
    format!(
        "scene = {{ name = \"lid\", space = \"{space}\", gravity = {gravity} }}\n\
         body = [{{ name = \"lid\", mass = 2.0, inertia = {inertia}, position = {} }}]\njoint = [\n{joints}]",
        point(numbers)
    )
}
