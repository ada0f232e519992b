//! Explains why reactions are not unique, as text and as directions that can be drawn: which joints
//! share loads, which loads they can put on each other without any effect on the motion, and which
//! part of a reaction is determined nevertheless.
//!
//! A statement about a sum or a component is made only after a test against all dependencies.

mod sentence;

pub(crate) use sentence::describe;

use crate::limits::VISIBLE;
use model::codes::Code;
use model::space::norm;
use model::start::scene_size;
use model::{BodyRef, ConstraintId, Layout, Mechanism, Scratch, SpaceKind, System};
use rank::{Circuit, StructureVerdict};

use crate::directions::readable;
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
    /// Joints and drives whose reactions are unique because of the structure alone, with the
    /// reason.
    pub settled: Vec<(ConstraintId, StructureVerdict)>,
}

/// Loads that joints can put on each other while the total force on each body is zero.
#[derive(Clone, Debug)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SelfStress {
    /// Rows of C, from 0: a minimal dependent set.
    pub rows: Vec<usize>,
    /// `Σ coefficient·row = 0`, the largest coefficient 1.
    pub coefficients: Vec<f64>,
    /// The largest coefficient (rows scaled) that counts as zero only within the tolerance of the
    /// scene; zero if there is none.
    pub left_out: f64,
    /// Load on each joint, in the order of rows. The largest force is 1 N, or the largest torque is
    /// 1 N·m if there is no force.
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
    /// Its bodies; the force acts on the first one.
    pub bodies: Vec<BodyRef>,
    /// The space of the mechanism.
    pub space: SpaceKind,
    /// Point at which the force acts (m), ground axes.
    pub place: [f64; 3],
    /// Force (N), ground axes.
    pub force: [f64; 3],
    /// Torque (N·m) about the place, ground axes.
    pub torque: [f64; 3],
    /// The named component of its definition: `N` of a knife edge (N), `drive` of a drive (N or
    /// N·m).
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
    /// Joints with which it shares loads, and the part of the reaction that is determined.
    pub text: String,
}

/// Reason why there is no explanation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExplanationError {
    /// The constraint matrix cannot be analysed.
    #[error(transparent)]
    Rank(#[from] rank::RankError),
    /// The rank is undecided, so every sentence would depend on one of two possible ranks.
    #[error("nothing can be explained while the rank is undecided: {0}")]
    Undecided(rank::Doubt),
    /// The solvability belongs to another constraint matrix.
    #[error(transparent)]
    Query(#[from] QueryError),
}

impl ExplanationError {
    /// Its code; see [`model::codes`].
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
    /// Converts the numbers of a part to those of the whole mechanism.
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
/// If C is not finite, or its rank is undecided.
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
    // A reaction that the structure makes unique for the exact numbers may be undecided within a
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

/// Components of coupled rows. In space, those of the same joints are one: rows that are separate
/// there are parts of the same loads.
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
    // Rows left open by the tolerance are not reported as decided.
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
        let missing = match redundancy {
            1 => "one number is".to_owned(),
            p => format!("{p} numbers are"),
        };
        let names = names(layout, &reactions);
        let text = match names.as_slice() {
            [one] => format!("inside {one} {missing} missing to determine its multipliers"),
            several => {
                let spanning = spanning(solvability, &rows);
                let told = loads::tell(
                    mechanism,
                    s,
                    scene_size(mechanism, q),
                    &reactions,
                    &spanning,
                );
                let share = match told {
                    None => "share loads".to_owned(),
                    Some(LoadDescription::Common(load)) => {
                        format!("can carry {load} that the bodies cannot tell apart")
                    }
                    Some(LoadDescription::Each(load)) => {
                        format!("can each carry {load} that the bodies cannot tell apart")
                    }
                    Some(LoadDescription::Various(loads)) => {
                        format!("share loads that the bodies cannot tell apart ({loads})")
                    }
                };
                format!(
                    "{} {share}: {missing} missing to determine all of them",
                    list(several)
                )
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

/// Multipliers of these rows that leave every body without a load, one solution in each column; all
/// other rows are zero.
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
            .map(|(x, &c)| match words::short(*x).as_str() {
                "1" => layout.space.components()[c].to_owned(),
                x => format!("{x}·{}", layout.space.components()[c]),
            })
            .collect();
        terms.join(" + ").replace("+ −", "− ")
    };
    let told = directions.map(|each| {
        each.map(|directions| -> Vec<String> { directions.iter().map(combination).collect() })
    });
    // What no load of the joint has is unique, and says nothing of the loads.
    let determined = match &told {
        None => "what of it is determined is not decided".to_owned(),
        Some([live, unique]) => match (&live[..], &unique[..]) {
            ([], []) => "nothing of it is determined".to_owned(),
            ([], [one]) => format!("determined is {one} only, which is zero whatever the loads"),
            ([], unique) => format!(
                "determined are {} only, which are zero whatever the loads",
                list(unique)
            ),
            (live, _) => format!("determined is {}", list(live)),
        },
    };
    let is_open = group
        .rows
        .iter()
        .any(|row| open.binary_search(&row).is_ok());
    let shared = match others.as_slice() {
        _ if is_open => "within the tolerance it is open what it shares loads with".to_owned(),
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

/// Scales the loads to largest force 1, or to largest torque 1 if all forces are rounding relative
/// to the torques divided by the size; the first number is positive. Rounding is set to zero.
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
    // The first number that is told is positive.
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

/// Whether the named component of a joint or drive is a torque.
fn is_turned(layout: &Layout, id: ConstraintId) -> bool {
    let rows = &layout.groups[id.0].rows;
    rows.iter().all(|row| layout.is_angular(row))
}

#[cfg(test)]
mod tests;
