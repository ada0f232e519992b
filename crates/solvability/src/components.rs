//! The components of reactions for which verdicts are computed along motions and at several
//! configurations.

use linalg::Matrix;
use model::reaction::ConstraintGroup;
use model::{ConstraintId, Layout, Mechanism, Scratch, System};

use crate::matrices::{Basis, QueryError};
use crate::mechanism::component_map;
use crate::verdict::{Judgement, Verdict};

/// Returns the names of the numbers of a joint or drive for which a simulation computes verdicts.
/// The numbers are the components that are not identically zero, and the named component of the
/// definition, such as `N` or `drive`. [`ConstraintGroup::component_names`] lists named components
/// only for couplings.
pub(crate) fn number_names(group: &ConstraintGroup) -> impl Iterator<Item = &'static str> {
    let names = group.space.components();
    let own = group.components().into_iter().map(|c| names[c]);
    own.chain(group.spec.component)
}

/// Returns the joint or drive and the name of each component of a mechanism, in the order of rows.
pub(crate) fn all_components(
    layout: &Layout,
) -> impl Iterator<Item = (ConstraintId, &'static str)> {
    let ids = layout.constraint_ids();
    ids.flat_map(|id| number_names(&layout.groups[id.0]).map(move |name| (id, name)))
}

/// Returns the verdicts on the components of a joint or drive at the configuration of the scratch,
/// in the order of their names. `rows` are the indices of the rows of the joint or drive in the
/// basis.
pub(crate) fn judge_components(
    mechanism: &Mechanism,
    id: ConstraintId,
    s: &Scratch,
    basis: &Basis,
    places: &[usize],
) -> Result<Vec<Judgement>, QueryError> {
    let group = &mechanism.layout().groups[id.0];
    if basis.is_free_of(places) {
        let unique = Judgement::new(Verdict::Unique, 0.0);
        return Ok(vec![unique; number_names(group).count()]);
    }
    let (components, map) = component_map(mechanism, id, s);
    let forces = group.space.forces();
    let forces = components.iter().filter(|c| forces.contains(*c)).count();
    let mapped = basis
        .mapped(&map, places.iter().copied())?
        .with_forces(forces);
    let own = (0..components.len()).map(|k| mapped.component(k));
    let mut judged = own.collect::<Result<Vec<_>, _>>()?;
    if let Some(name) = group.spec.component {
        let reactions = mechanism.reactions(s);
        let coefficients = reactions.component_coefficients(id, name);
        let coefficients = coefficients.unwrap_or_else(|| vec![0.0; places.len()]);
        let map = Matrix::from_fn(1, places.len(), |_, j| coefficients[j]);
        judged.push(basis.mapped(&map, places.iter().copied())?.component(0)?);
    }
    Ok(judged)
}

/// Returns the verdicts on the components of all joints and drives of a mechanism that is one part,
/// with a basis of all rows.
pub(crate) fn judge_all(
    mechanism: &Mechanism,
    s: &Scratch,
    basis: &Basis,
) -> Result<Vec<Judgement>, QueryError> {
    let layout = mechanism.layout();
    let mut all = Vec::new();
    for id in layout.constraint_ids() {
        let rows: Vec<usize> = layout.groups[id.0].rows.iter().collect();
        all.extend(judge_components(mechanism, id, s, basis, &rows)?);
    }
    Ok(all)
}
