//! Explains why reactions are not unique, as text and as directions that can be drawn. The
//! explanation contains the joints that share loads, the loads between joints that do not affect
//! the motion, and the part of a reaction that is nevertheless determined.
//!
//! Every statement about a sum or a component is tested against all dependencies.

mod sentence;

pub(crate) use sentence::describe;

use crate::limits::{MANY_LOADS, VISIBLE};
use model::codes::Code;
use model::space::norm;
use model::start::scene_size;
use model::{BodyRef, ConstraintId, Layout, Mechanism, Scratch, SpaceKind, System};
use rank::{Circuit, StructureVerdict};

use crate::directions::readable;
use crate::groups::{LinearForm, ReactionForms};
use crate::loads::{self, LoadDescription};
use crate::matrices::{QueryError, Solvability};
use crate::verdict::Verdict;
use crate::words::{self, list, names};

/// Explanation of the redundancy of a configuration.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Explanation {
    /// One self-stress for each degree of redundancy, short ones first.
    pub stresses: Vec<SelfStress>,
    /// Sets of joints and drives whose reactions are coupled, ordered by their first row.
    pub mixing: Vec<Mixing>,
    /// The reactions that are not unique, in the order of their rows.
    pub reactions: Vec<ReactionExplanation>,
    /// Joints and drives whose reactions are unique because of the structure alone, each with the
    /// reason.
    pub settled: Vec<(ConstraintId, StructureVerdict)>,
}

/// Loads that joints can exert on each other while the total force on each body is zero.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SelfStress {
    /// Rows of C, from 0: a minimal dependent set.
    pub rows: Vec<usize>,
    /// Coefficients of `Σ coefficient·row = 0`; the largest coefficient is 1.
    pub coefficients: Vec<f64>,
    /// The largest coefficient (for scaled rows) that counts as zero only within the tolerance of
    /// the scene; zero if there is no such coefficient.
    pub left_out: f64,
    /// Load on each joint, in the order of rows. The largest force is 1 N. If there is no force,
    /// the largest torque is 1 N·m.
    pub directions: Vec<FreeDirection>,
    /// Explanation as text.
    pub text: String,
}

/// Load on one joint or drive in a self-stress.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FreeDirection {
    /// The joint or drive.
    pub joint: ConstraintId,
    /// Bodies of the joint or drive. The force acts on the first body.
    pub bodies: Vec<BodyRef>,
    /// The space of the mechanism.
    pub space: SpaceKind,
    /// Point at which the force acts (m), in ground axes.
    pub place: [f64; 3],
    /// Force (N), in ground axes.
    pub force: [f64; 3],
    /// Torque about this point (N·m), in ground axes.
    pub torque: [f64; 3],
    /// The named component of the definition of the joint: `N` of a knife edge (N), or `drive` of a
    /// drive (N or N·m).
    pub component: Option<f64>,
}

/// Joints and drives whose reactions are coupled by dependencies.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Mixing {
    /// The joints and drives.
    pub reactions: Vec<ConstraintId>,
    /// Rows of C, from 0.
    pub rows: Vec<usize>,
    /// Number of further conditions that would determine all of these reactions.
    pub redundancy: usize,
    /// Explanation as text.
    pub text: String,
}

/// The reason why the reaction of one joint or drive is not unique.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ReactionExplanation {
    /// The joint or drive.
    pub id: ConstraintId,
    /// Text with the joints that share loads with this joint or drive, and with the determined part
    /// of the reaction.
    pub text: String,
}

/// Reason why there is no explanation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExplanationError {
    /// The constraint matrix cannot be analysed.
    #[error(transparent)]
    Rank(#[from] rank::RankError),
    /// The rank is undecided. Every sentence would depend on one of two possible ranks.
    #[error("explanations need a decided rank: {0}")]
    Undecided(rank::Doubt),
    /// The solvability was computed from another constraint matrix.
    #[error(transparent)]
    Query(#[from] QueryError),
}

impl ExplanationError {
    /// Returns the error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Rank { .. } | Self::Undecided { .. } | Self::Query { .. } => {
                const { Code::new(316) }
            }
        }
    }
}

impl Explanation {
    /// Converts the numbers of a part to the numbers of the whole mechanism.
    pub(crate) fn renumber(
        &mut self,
        row: impl Fn(usize) -> usize,
        id: impl Fn(ConstraintId) -> ConstraintId,
        body: impl Fn(BodyRef) -> BodyRef,
    ) {
        for stress in &mut self.stresses {
            stress.rows.iter_mut().for_each(|k| *k = row(*k));
            for direction in &mut stress.directions {
                direction.joint = id(direction.joint);
                direction.bodies.iter_mut().for_each(|b| *b = body(*b));
            }
        }
        for mixing in &mut self.mixing {
            mixing.reactions.iter_mut().for_each(|k| *k = id(*k));
            mixing.rows.iter_mut().for_each(|k| *k = row(*k));
        }
        self.reactions.iter_mut().for_each(|r| r.id = id(r.id));
        self.settled.iter_mut().for_each(|s| s.0 = id(s.0));
    }

    /// Adds the explanation of another part.
    pub(crate) fn add(&mut self, other: Self) {
        self.stresses.extend(other.stresses);
        self.mixing.extend(other.mixing);
        self.reactions.extend(other.reactions);
        self.settled.extend(other.settled);
    }

    /// Sorts the explanations of several parts.
    pub(crate) fn sort(&mut self) {
        self.mixing
            .sort_by_key(|mixing| mixing.rows.first().copied());
        self.reactions.sort_by_key(|reaction| reaction.id.0);
        self.settled.sort_by_key(|settled| settled.0.0);
    }
}

/// Explains the verdicts at the configuration q of the scratch, where Φ and C have been evaluated.
///
/// # Errors
/// The function returns an error if C is not finite, or if its rank is undecided.
pub fn explain(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    solvability: &Solvability,
) -> Result<Explanation, ExplanationError> {
    if let rank::RankStatus::Undecided(doubt) = solvability.decision().status {
        return Err(ExplanationError::Undecided(doubt));
    }
    let structure = crate::structure::structure(mechanism, s, q)?;
    let mixing = mixing(mechanism, s, q, solvability);
    let open = rank::open_rows(solvability.decision());
    let is_known = |rows: &[usize]| !rows.iter().any(|row| open.binary_search(row).is_ok());
    let ids = mechanism.layout().constraint_ids();
    let reactions = ids
        .filter_map(|id| reaction(mechanism, s, solvability, (&mixing, &open), id).transpose())
        .collect::<Result<_, _>>()?;
    let stresses = rank::short_circuits(solvability.decision())
        .into_iter()
        .filter(|circuit| is_known(&circuit.rows))
        .map(|circuit| stress(mechanism, s, q, solvability, circuit))
        .collect();
    // A reaction that is unique for exact data because of the structure may be undecided within a
    // tolerance.
    let is_unique = |id: &ConstraintId| {
        let rows = mechanism.layout().groups[id.0].rows.clone();
        let judged = solvability.group(rows);
        judged.is_ok_and(|j| j.verdict.is_unique())
    };
    let settled = mechanism
        .layout()
        .constraint_ids()
        .zip(structure.groups)
        .filter(|(id, why)| !matches!(why, StructureVerdict::Open(_)) && is_unique(id));
    Ok(Explanation {
        stresses,
        mixing,
        reactions,
        settled: settled.collect(),
    })
}

/// Returns the components of coupled rows. In space, components of the same joints are merged,
/// because their separate rows are parts of the same loads.
fn mixing(mechanism: &Mechanism, s: &Scratch, q: &[f64], solvability: &Solvability) -> Vec<Mixing> {
    let layout = mechanism.layout();
    let decision = solvability.decision();
    let open = rank::open_rows(decision);
    let touching = |rows: &[usize]| -> Vec<ConstraintId> {
        let touched = |id: &ConstraintId| {
            rows.iter()
                .any(|row| layout.groups[id.0].rows.contains(*row))
        };
        layout.constraint_ids().filter(touched).collect()
    };
    let mut coupled: Vec<(Vec<ConstraintId>, Vec<usize>)> = Vec::new();
    // Rows that are undecided within the tolerance are not reported as decided.
    let all = rank::components(decision).coupled.into_iter();
    for rows in all.filter(|rows| !rows.iter().any(|row| open.binary_search(row).is_ok())) {
        let reactions = touching(&rows);
        let same = coupled.iter_mut().find(|(ids, _)| *ids == reactions);
        match same.filter(|_| layout.space.n_rotations() > 1) {
            Some((_, known)) => {
                known.extend(rows);
                known.sort_unstable();
            }
            None => coupled.push((reactions, rows)),
        }
    }
    let of = |(reactions, rows): (Vec<ConstraintId>, Vec<usize>)| {
        let redundancy = decision
            .dropped
            .iter()
            .filter(|row| rows.contains(row))
            .count();
        let names = names(layout, &reactions);
        let text = match names.as_slice() {
            [one] => format!("the rows of {one} leave {redundancy} of its multipliers free"),
            several => {
                let spanning = spanning(solvability, &rows);
                let size = scene_size(mechanism, q);
                let loads = loads::tell(mechanism, s, size, &reactions, &spanning);
                let loads = loads.and_then(|loads| match loads {
                    // The sums of many components are shorter than their list.
                    LoadDescription::Various(_) if redundancy > MANY_LOADS => None,
                    LoadDescription::Each(load) => Some(format!(" ({load} at each)")),
                    LoadDescription::Common(all) | LoadDescription::Various(all) => {
                        Some(format!(" ({all})"))
                    }
                });
                let loads = loads.unwrap_or_default();
                let components = match redundancy {
                    1 => "one load component that equilibrium does not determine".to_owned(),
                    p => format!("{p} load components that equilibrium does not determine"),
                };
                let forms = ReactionForms::at(mechanism, s, size);
                let sums = determined_sums(&forms, solvability, &reactions);
                let sums = match sums.as_slice() {
                    [] => String::new(),
                    [one] => format!("; of the sums, {one} is determined"),
                    all => format!("; of the sums, {} are determined", list(all)),
                };
                format!("{} share {components}{loads}{sums}", list(several))
            }
        };
        Mixing {
            reactions,
            rows,
            redundancy,
            text,
        }
    };
    coupled.into_iter().map(of).collect()
}

/// Returns the components of the total wrench of these reactions that are unique although the
/// wrench of a single reaction is not unique. The text has the form "Fx, Fz and T about (1, 2)".
/// Forces are forces on the first bodies.
fn determined_sums(
    forms: &ReactionForms<'_>,
    solvability: &Solvability,
    reactions: &[ConstraintId],
) -> Vec<String> {
    // A sum of loads on different bodies is not meaningful.
    let groups = &forms.mechanism.layout().groups;
    let mut on_body = reactions.iter().map(|id| groups[id.0].bodies.first());
    let first = on_body.next();
    if on_body.any(|body| Some(body) != first) {
        return Vec::new();
    }
    let space = forms.mechanism.space();
    let is_unique = |form: &LinearForm| {
        let judged = form.judge(solvability);
        judged.is_ok_and(|judged| judged.verdict.is_unique())
    };
    let sum_of = |ids: &[ConstraintId]| {
        let terms: Vec<(f64, ConstraintId)> = ids.iter().map(|id| (1.0, *id)).collect();
        forms.wrench_sum(&terms).unwrap_or_default()
    };
    let own: Vec<Vec<LinearForm>> = reactions.iter().map(|id| sum_of(&[*id])).collect();
    let total = sum_of(reactions).into_iter().enumerate();
    let found = total.filter(|(k, form)| {
        let is_trivial = own.iter().all(|forms| is_unique(&forms[*k]));
        !is_trivial && is_unique(form)
    });
    let found: Vec<usize> = found.map(|(k, _)| k).collect();
    let mut names: Vec<String> = found
        .iter()
        .map(|&k| space.components()[k].to_owned())
        .collect();
    let is_torque = |k: &usize| space.torques().contains(k);
    if let (Some(last), true, Ok(place)) = (
        names.last_mut(),
        found.iter().any(is_torque),
        forms.place(reactions[0]),
    ) {
        let place = &place[..space.forces().len()];
        let size = place.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        last.push_str(&format!(" about {}", words::place(place, size)));
    }
    names
}

/// Returns multipliers of these rows without a resultant load on any body. Each column contains one
/// solution. The multipliers of all other rows are zero.
fn spanning(solvability: &Solvability, rows: &[usize]) -> linalg::Matrix {
    let (z, scaling) = (solvability.null_space(), &solvability.decision().scaling);
    let mut own = linalg::Matrix::zeros(z.nrows(), z.ncols());
    for &row in rows {
        let factor = scaling.row_factor(row);
        let entries = own.row_mut(row).iter_mut().zip(z.row(row));
        entries.for_each(|(own, z)| *own = factor * z);
    }
    own
}

fn reaction(
    mechanism: &Mechanism,
    s: &Scratch,
    solvability: &Solvability,
    (mixing, open): (&[Mixing], &[usize]),
    id: ConstraintId,
) -> Result<Option<ReactionExplanation>, QueryError> {
    let layout = mechanism.layout();
    let group = &layout.groups[id.0];
    if solvability.group(group.rows.clone())?.verdict != Verdict::NotUnique {
        return Ok(None);
    }
    let mut others: Vec<ConstraintId> = mixing
        .iter()
        .filter(|m| m.reactions.contains(&id))
        .flat_map(|m| m.reactions.iter().copied())
        .filter(|other| *other != id)
        .collect();
    others.sort_unstable();
    others.dedup();
    let components = group.components();
    let full = mechanism.reactions(s).wrench_map(id);
    let map = linalg::Matrix::from_fn(components.len(), group.rows.len(), |i, j| {
        full[(components[i], j)]
    });
    let forces = components
        .iter()
        .filter(|&c| layout.space.forces().contains(c))
        .count();
    let mapped = solvability.basis().mapped(&map, group.rows.clone())?;
    let mapped = mapped.with_forces(forces);
    let directions = match mapped.unique_directions() {
        Err(QueryError::Directions { .. }) => None,
        known => {
            let unique = known?;
            let told = |directions| match layout.space.n_rotations() {
                1 => directions,
                _ => readable(directions),
            };
            Some([told(mapped.live_directions(&unique)), told(unique)])
        }
    };
    let combination = |direction: &Vec<f64>| {
        let terms = direction
            .iter()
            .zip(&components)
            .filter(|(x, _)| x.abs() > VISIBLE);
        let terms: Vec<String> = terms
            .map(|(x, &c)| match model::words::short(*x).as_str() {
                "1" => layout.space.components()[c].to_owned(),
                x => format!("{x}·{}", layout.space.components()[c]),
            })
            .collect();
        terms.join(" + ").replace("+ −", "− ")
    };
    let told = directions.map(|each| {
        each.map(|directions| -> Vec<String> { directions.iter().map(combination).collect() })
    });
    // A component that does not occur in any load of the joint is unique. Such a component does not
    // describe the loads.
    let determined = match &told {
        None => "the determined part of it is undecided".to_owned(),
        Some([live, unique]) => match (&live[..], &unique[..]) {
            ([], []) => "no part of it is determined".to_owned(),
            ([], [one]) => format!("only {one} is determined, and it is zero under every load"),
            ([], unique) => format!(
                "only {} are determined, and they are zero under every load",
                list(unique)
            ),
            ([one], _) => format!("only {one} is determined"),
            (live, _) => format!("only {} are determined", list(live)),
        },
    };
    let is_open = group
        .rows
        .iter()
        .any(|row| open.binary_search(&row).is_ok());
    let shared = match others.as_slice() {
        _ if is_open => {
            "the joints that share its loads are undecided within the tolerance".to_owned()
        }
        [] => "its rows depend on each other".to_owned(),
        others => format!("it shares loads with {}", list(&names(layout, others))),
    };
    Ok(Some(ReactionExplanation {
        id,
        text: format!(
            "the reaction of `{}` is not determined: {shared}; {determined}",
            group.name
        ),
    }))
}

fn stress(
    mechanism: &Mechanism,
    s: &Scratch,
    q: &[f64],
    solvability: &Solvability,
    circuit: Circuit,
) -> SelfStress {
    let layout = mechanism.layout();
    let mut lambda = vec![0.0; layout.rows()];
    for (&row, &coefficient) in circuit.rows.iter().zip(&circuit.coefficients) {
        lambda[row] = coefficient;
    }
    let carries = |id: ConstraintId| {
        let group = &layout.groups[id.0];
        if !group.rows.iter().any(|row| lambda[row] != 0.0) {
            return None;
        }
        let reaction = mechanism.reactions(s).reaction(id, &lambda);
        Some(FreeDirection {
            joint: id,
            bodies: group.bodies.clone(),
            space: layout.space,
            place: mechanism.reactions(s).place(id),
            force: reaction.force,
            torque: reaction.torque,
            component: reaction.component,
        })
    };
    let mut directions: Vec<FreeDirection> = mechanism
        .layout()
        .constraint_ids()
        .filter_map(carries)
        .collect();
    let size = scene_size(mechanism, q);
    normalise(layout, &mut directions, size);
    let ids: Vec<ConstraintId> = directions.iter().map(|d| d.joint).collect();
    let multipliers = linalg::Matrix::from_fn(lambda.len(), 1, |i, _| lambda[i]);
    let told = loads::tell(mechanism, s, size, &ids, &multipliers);
    SelfStress {
        text: sentence::of_stress(mechanism, s, solvability, &circuit, &directions, told),
        left_out: circuit.left_out,
        rows: circuit.rows,
        coefficients: circuit.coefficients,
        directions,
    }
}

/// Scales the loads so that the largest force is 1. If all forces are rounding relative to the
/// torques divided by the size, the loads are scaled so that the largest torque is 1. The first
/// number is positive. Rounding is set to zero.
fn normalise(layout: &Layout, directions: &mut [FreeDirection], size: f64) {
    let force = |d: &FreeDirection| norm(&d.force);
    let force = directions.iter().map(force).fold(0.0, f64::max);
    let torque = directions
        .iter()
        .map(|d| norm(&d.torque))
        .fold(0.0, f64::max);
    let unit = if force > VISIBLE * torque / size {
        force
    } else {
        torque
    };
    if unit == 0.0 {
        return;
    }
    // The first printed number is positive.
    let first = directions.first().and_then(|d| {
        let numbers = d.component.into_iter().chain(d.force).chain(d.torque);
        numbers.into_iter().find(|x| x.abs() > VISIBLE * unit)
    });
    let unit = unit * first.map_or(1.0, f64::signum);
    let largest = force.max(torque / size);
    for d in directions {
        let arm = if is_turned(layout, d.joint) {
            size
        } else {
            1.0
        };
        let forces = d.force.iter_mut().map(|x| (x, 1.0));
        let torques = d.torque.iter_mut().map(|x| (x, size));
        let named = d.component.iter_mut().map(|x| (x, arm));
        for (x, scale) in forces.chain(torques).chain(named) {
            *x = if x.abs() <= VISIBLE * largest * scale {
                0.0
            } else {
                *x / unit
            };
        }
    }
}

/// Returns whether the named component of a joint or drive is a torque.
fn is_turned(layout: &Layout, id: ConstraintId) -> bool {
    let rows = &layout.groups[id.0].rows;
    rows.iter().all(|row| layout.is_angular(row))
}

#[cfg(test)]
mod tests;
