//! First-order results at the start, for the picture. Free motions are velocities of bodies, and
//! self-stresses are loads on the first bodies of joints.

use std::collections::HashMap;

use model::{ConstraintId, Mechanism, System};
use serde::Serialize;

use super::cast::Cast;
use super::run_page::{RunPage, Shows};
use crate::documents::DependencyDocument;
use report::channel::FewDigits;

/// Largest number of free motions, and of self-stresses, that can be chosen.
const MOST: usize = 40;

/// A free motion at the start.
#[derive(Serialize)]
pub(super) struct Motion<'a> {
    /// Introduction and description of the motion.
    lead: String,
    text: &'a str,
    /// The moving drawn bodies for each degree of freedom of the description, with the velocities
    /// of their frames in ground axes.
    velocities: Vec<Vec<(usize, Vec<FewDigits>)>>,
}

/// A self-stress at the start: loads that cancel on every body.
#[derive(Serialize)]
pub(super) struct Stress<'a> {
    text: &'a str,
    /// Drawn joints and drives, with the components of the load on their first bodies.
    joints: Vec<usize>,
    wrenches: Vec<Vec<FewDigits>>,
}

/// Motions and self-stresses that can be chosen for the picture.
#[derive(Serialize)]
pub(super) struct FirstOrder<'a> {
    pub(super) motions: Vec<Motion<'a>>,
    pub(super) stresses: Vec<Stress<'a>>,
}

impl<'a> FirstOrder<'a> {
    /// Returns the motions and self-stresses of a page whose bodies and joints are drawn.
    pub(super) fn of(page: &'a RunPage<'_>, cast: &Cast) -> Self {
        Self {
            motions: motions(page, cast),
            stresses: stresses(page, cast),
        }
    }
}

/// Returns the free motions of a page whose bodies are drawn.
fn motions<'a>(page: &'a RunPage<'_>, cast: &Cast) -> Vec<Motion<'a>> {
    let bodies = page.mechanism.bodies();
    let place: HashMap<&str, usize> = (0..)
        .zip(cast.bodies())
        .map(|(own, &k)| (bodies[k].name.as_str(), own))
        .collect();
    let free = match page.shows {
        Shows::Mode(_) => None,
        _ => page.freedoms(),
    };
    let all = free.map(|free| free.motions()).unwrap_or_default();
    let told = all.into_iter().take(MOST).map(|(lead, motion)| Motion {
        lead,
        text: &motion.text,
        velocities: motion
            .velocities
            .iter()
            .map(|moving| {
                let known = moving.0.iter();
                let drawn = known.filter_map(|(name, v)| {
                    let own = *place.get(name.as_str())?;
                    Some((own, v.iter().copied().map(FewDigits).collect()))
                });
                drawn.collect()
            })
            .collect(),
    });
    told.collect()
}

/// Returns the self-stresses of a page whose joints are all drawn.
fn stresses<'a>(page: &'a RunPage<'_>, cast: &Cast) -> Vec<Stress<'a>> {
    let (Some(analysis), Some(frame)) = (page.analysis, page.recording.frames.first()) else {
        return Vec::new();
    };
    let mut s = page.mechanism.scratch();
    page.mechanism.pose(frame.t, &frame.q, &mut s);
    let stress = |dependency: &'a DependencyDocument| {
        let lambda = multipliers(page.mechanism, dependency)?;
        let groups = page.mechanism.layout().groups.iter().enumerate();
        let loaded = groups.filter(|(_, group)| group.rows.iter().any(|row| lambda[row] != 0.0));
        let mut told = Stress {
            text: &dependency.text,
            joints: Vec::new(),
            wrenches: Vec::new(),
        };
        for (k, group) in loaded {
            told.joints.push(cast.joints().binary_search(&k).ok()?);
            let reaction = page
                .mechanism
                .reactions(&s)
                .reaction(ConstraintId(k), &lambda);
            let components = reaction.components(group.space);
            told.wrenches.push(components.map(FewDigits).collect());
        }
        Some(told)
    };
    let dependencies = &analysis.reasons.dependencies;
    dependencies.iter().filter_map(stress).take(MOST).collect()
}

/// Converts the coefficients of a dependency to multipliers of all rows. Returns `None` if a row
/// does not exist.
fn multipliers(mechanism: &Mechanism, dependency: &DependencyDocument) -> Option<Vec<f64>> {
    let mut lambda = vec![0.0; mechanism.layout().rows()];
    for (row, coefficient) in dependency.rows.iter().zip(&dependency.coefficients) {
        *lambda.get_mut(row.checked_sub(1)?)? = *coefficient;
    }
    Some(lambda)
}
