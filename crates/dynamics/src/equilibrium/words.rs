//! Free motions in words, and what pushes them.

use linalg::kernels::dot;
use solvability::motions_among;

use super::balance::{Balance, Statics};
use crate::limits::{TAKES_PART, UNRESISTED};

/// What pushes a free motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Pushed {
    /// The motion, in words.
    pub motion: String,
    /// Force or torque along it, for its fastest translation or rotation.
    pub force: f64,
    /// N or N·m.
    pub unit: &'static str,
    /// What pushes: the weight and applied forces, in words.
    pub by: Vec<String>,
}

/// Free motions, d components each, in words.
pub(super) fn motions(statics: &Statics<'_>, at: &Balance, of: &[Vec<f64>]) -> Vec<String> {
    let velocities: Vec<Vec<f64>> = of.iter().map(|y| statics.velocity(at, y)).collect();
    let told = motions_among(statics.mechanism, statics.t, &at.q, &velocities);
    let told = told.unwrap_or_default().into_iter();
    told.map(|motion| motion.text).collect()
}

/// What pushes along a free motion.
pub(super) fn pushed(statics: &mut Statics<'_>, at: &Balance, along: &[f64]) -> Pushed {
    let told = motions(statics, at, &[along.to_vec()]);
    let mut v = statics.velocity(at, along);
    let space = statics.mechanism.space();
    let fastest = |turns: bool| {
        let own = (0..v.len()).filter(|&j| space.is_rotation(j) == turns);
        own.map(|j| v[j].abs()).fold(0.0, f64::max)
    };
    let (turn, slide) = (fastest(true), fastest(false));
    // What is a rounding of a translation is no rotation.
    let (largest, unit) = if turn * statics.size > UNRESISTED * slide {
        (turn, "N·m")
    } else {
        (slide, "N")
    };
    v.iter_mut().for_each(|v| *v /= largest);
    statics.evaluate(&at.q);
    let weight = dot(statics.mechanism.weight(), &v);
    let mut parts = vec![("the weight".to_owned(), weight)];
    let forces = statics.mechanism.applied_forces().parts(&mut statics.s);
    parts.extend(forces.map(|(name, q)| (format!("`{name}`"), dot(&q, &v))));
    let force: f64 = parts.iter().map(|(_, power)| power).sum();
    let by = parts
        .into_iter()
        .filter(|(_, power)| power.abs() > TAKES_PART * force.abs())
        .map(|(name, _)| name);
    Pushed {
        motion: told.join("; "),
        force,
        unit,
        by: by.collect(),
    }
}
