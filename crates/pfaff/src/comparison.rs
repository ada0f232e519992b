//! Compares, along a run, reactions that are not unique for several choices. The choices are the
//! choice of the run or the requested choices, the least norm, and sets of rows without reaction.
//! Each set of joints that share cycles is treated separately. Therefore the work grows with the
//! number of redundant sets, and not with the size of the mechanism.
//!
//! All solutions at an instant are `λ + Z·y`. The vector λ is the solution of the run. The matrix Z
//! belongs to the configuration at that instant, so unique components are recognised at every
//! instant and not only at the start. The rank is decided at the first frame. The decision is
//! carried from frame to frame and is made again at frames at which its rows do not show the rank.
//! If the rank is undecided, no comparison is made.

#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::page::{ComparedChoice, Comparison, Freedom};
use linalg::{Matrix, PivotedQr};
use model::{Mechanism, Part, RowRanges, Scratch, SpaceKind, System};
use rank::{RankDecision, deletions, dependencies};
use report::{Frame, Recording};
use solvability::Configuration;
use solvability::parts::parts;

/// Largest number of rows of a set whose choices are compared.
const ROWS_MAX: usize = 150;

/// Largest number of sets that are compared.
const SETS_MAX: usize = 24;

/// Number of sets of rows without reaction that are compared, and number of candidate sets from
/// which they are taken.
const ELIMINATIONS: usize = 6;
const CANDIDATES: usize = 400;

/// Smallest permitted pivot of rows without reaction, relative to the largest entry of Z. With a
/// smaller pivot, values are large only because the rows are ill-conditioned.
const FIRM: f64 = 0.02;

/// Values below this fraction of the largest free load of a set count as rounding.
const VISIBLE: f64 = 1e-9;

/// If the square of a free force across its main direction exceeds this fraction of the total, the
/// force is free in both directions of the plane.
const PLANE: f64 = 1e-9;

/// Returns the comparisons, and sentences about the sets that are not compared. `own` contains the
/// names of the choices in the frames: the requested choices, or the choice of the run.
pub(crate) fn compare(
    mechanism: &Mechanism,
    recording: &Recording,
    open: impl Fn(usize) -> bool,
    own: &[String],
) -> (Vec<Comparison>, Vec<String>) {
    let Some(first) = recording.frames.first() else {
        return (Vec::new(), Vec::new());
    };
    let groups = 0..mechanism.layout().groups.len();
    if first.multipliers.is_empty() || !groups.into_iter().any(&open) {
        return (Vec::new(), Vec::new());
    }
    let mut s = mechanism.scratch();
    mechanism.pose(first.t, &first.q, &mut s);
    mechanism.c(&mut s);
    let redundant = parts(mechanism, &s).into_iter();
    let redundant: Vec<Vec<usize>> = redundant
        .filter(|set| set.iter().any(|k| open(*k)))
        .collect();
    let mut left_out = Vec::new();
    let mut compared = Vec::new();
    for set in &redundant {
        let part = mechanism.part_of_groups(set);
        let reactions: Vec<usize> = set.iter().copied().filter(|k| open(*k)).collect();
        let names = || -> String {
            let few = reactions.iter().take(6);
            let few: Vec<&str> = few
                .map(|k| mechanism.layout().groups[*k].name.as_str())
                .collect();
            few.join(", ")
        };
        if part.places.rows.len() > ROWS_MAX || compared.len() >= SETS_MAX {
            left_out.push(names());
            continue;
        }
        match Set::new(&part, recording) {
            Some(set) => compared.push(set.compare(recording, own, &open)),
            None => left_out.push(names()),
        }
    }
    let words = match left_out.as_slice() {
        [] => Vec::new(),
        sets => vec![format!(
            "{} of {} sets of joints that share loads are not compared, because a set is too large, there are too many sets, or not all of their reactions were requested. The first set that was not compared contains {}. In these plots, components that are not unique have no curve.",
            sets.len(),
            redundant.len(),
            sets[0]
        )],
    };
    (compared, words)
}

/// Joints on common cycles, some of whose reactions are not unique.
struct Set<'a> {
    part: &'a Part,
    /// The first frame, with its decided rank.
    first: Configuration<'a>,
    eliminations: Vec<Vec<usize>>,
}

impl<'a> Set<'a> {
    /// Returns `None` if the multipliers of the run are unknown, or if the rank is undecided.
    fn new(part: &'a Part, recording: &Recording) -> Option<Self> {
        let frame = recording.frames.first()?;
        let known = |&i: &usize| frame.multipliers.get(i).is_some_and(|x| x.is_finite());
        if !part.places.rows.iter().all(known) {
            return None;
        }
        let q = coordinates(part, frame);
        let first = Configuration::decided(&part.mechanism, (frame.t, &q), None).ok()?;
        let decision = first.solvability().decision();
        let eliminations = decision.is_decided().then(|| eliminations(decision))?;
        Some(Self {
            part,
            first,
            eliminations,
        })
    }

    fn compare(
        &self,
        recording: &Recording,
        own: &[String],
        open: impl Fn(usize) -> bool,
    ) -> Comparison {
        let labels = &self.part.mechanism.layout().labels;
        let without = |rows: &Vec<usize>| {
            let rows: Vec<String> = rows
                .iter()
                .map(|&i| format!("{} ({})", labels[i].number, labels[i].joint))
                .collect();
            let word = if rows.len() == 1 { "row" } else { "rows" };
            format!("no reaction in {word} {}", rows.join(", "))
        };
        let labels = own.iter().cloned();
        let labels = labels.chain(["least norm (N, N·m)".to_owned()]);
        let labels = labels.chain(self.eliminations.iter().map(without));
        let mut choices: Vec<ComparedChoice> = labels
            .map(|label| ComparedChoice {
                label,
                values: Vec::with_capacity(recording.frames.len()),
            })
            .collect();
        let mut freedom = Vec::with_capacity(recording.frames.len());
        let mut last = None;
        for frame in &recording.frames {
            // The configuration of a frame does not exist if C is not finite.
            let q = coordinates(self.part, frame);
            let near = last.as_ref().unwrap_or(&self.first);
            let mechanism = &self.part.mechanism;
            last = Configuration::decided(mechanism, (frame.t, &q), Some(near)).ok();
            let instant = self.instant(frame, last.as_ref());
            let mut values = instant.values.into_iter();
            for choice in &mut choices {
                let of_choice = values.next();
                choice
                    .values
                    .push(of_choice.unwrap_or_else(|| self.unknown()));
            }
            freedom.push(instant.freedom);
        }
        // A choice without any finite number is removed.
        choices.retain(|c| c.values.iter().flatten().flatten().any(|x| x.is_finite()));
        // Reactions without a free component at any time are unique.
        let groups = &self.part.places.groups;
        let free = |k: usize| {
            let of = |f: &Vec<Freedom>| f[k] != Freedom::UNKNOWN && f[k].components.contains(&true);
            open(groups[k]) || freedom.iter().any(of)
        };
        let told: Vec<usize> = (0..groups.len()).filter(|&k| free(k)).collect();
        for choice in &mut choices {
            for frame in &mut choice.values {
                *frame = told
                    .iter()
                    .map(|&k| std::mem::take(&mut frame[k]))
                    .collect();
            }
        }
        for frame in &mut freedom {
            *frame = told.iter().map(|&k| frame[k]).collect();
        }
        Comparison {
            reactions: told.iter().map(|&k| groups[k]).collect(),
            choices,
            freedom,
        }
    }

    fn unknown(&self) -> Vec<Vec<f64>> {
        let components = self.part.mechanism.space().n_v();
        vec![vec![f64::NAN; components]; self.part.places.groups.len()]
    }

    fn instant(&self, frame: &Frame, configuration: Option<&Configuration<'_>>) -> Instant {
        let of_part = |all: &[f64]| -> Vec<f64> {
            let rows = self.part.places.rows.iter();
            rows.map(|&i| all[i]).collect()
        };
        let lambda = of_part(&frame.multipliers);
        let mechanism = &self.part.mechanism;
        let n = mechanism.layout().groups.len();
        let decided = configuration
            .filter(|configuration| configuration.solvability().decision().is_decided());
        let Some(configuration) = decided else {
            return Instant {
                values: Vec::new(),
                freedom: vec![Freedom::UNKNOWN; n],
            };
        };
        let (s, decision) = (
            configuration.scratch(),
            configuration.solvability().decision(),
        );
        let maps: Vec<Matrix> = mechanism
            .layout()
            .constraint_ids()
            .map(|id| mechanism.reactions(s).wrench_map(id))
            .collect();
        let own: Vec<Vec<Vec<f64>>> = match frame.chosen.as_slice() {
            [] => vec![self.wrenches(&maps, &lambda)],
            chosen => {
                let each = chosen.iter().map(|all| of_part(all));
                each.map(|lambda| self.wrenches(&maps, &lambda)).collect()
            }
        };
        if decision.redundancy == 0 {
            return Instant {
                values: vec![
                    self.wrenches(&maps, &lambda);
                    own.len() + 1 + self.eliminations.len()
                ],
                freedom: vec![Freedom::NONE; n],
            };
        }
        let z = dependencies(decision);
        let free: Vec<Matrix> = maps
            .iter()
            .zip(&mechanism.layout().groups)
            .map(|(w, g)| product(w, &z, &g.rows))
            .collect();
        let least = least_norm(&free, &self.wrenches(&maps, &lambda));
        let least = least.map(|y| moved(&lambda, &z, &y));
        let without = self.eliminations.iter();
        let others =
            std::iter::once(least).chain(without.map(|rows| without_load(&lambda, &z, rows)));
        let others = others.map(|lambda| lambda.map(|lambda| self.wrenches(&maps, &lambda)));
        let others: Vec<Option<Vec<Vec<f64>>>> = others.collect();
        // A curve of a single choice would look like a unique number.
        let are_several = own.len() > 1 || others.iter().any(Option::is_some);
        let own = own.into_iter().map(|own| are_several.then_some(own));
        let values = own.chain(others);
        Instant {
            values: values
                .map(|v| v.unwrap_or_else(|| self.unknown()))
                .collect(),
            freedom: freedom(
                mechanism.space(),
                &free,
                &self.turns(s),
                configuration.size(),
            ),
        }
    }

    fn wrenches(&self, maps: &[Matrix], lambda: &[f64]) -> Vec<Vec<f64>> {
        let groups = &self.part.mechanism.layout().groups;
        let each = maps.iter().zip(groups);
        let mut own = Vec::new();
        each.map(|(map, group)| map.times(group.rows.of(lambda, &mut own)))
            .collect()
    }

    /// The axes of the frame of the first body of each joint at this instant.
    fn turns(&self, s: &Scratch) -> Vec<[[f64; 3]; 3]> {
        let mechanism = &self.part.mechanism;
        let of = |id| {
            let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            if let Some(own) = mechanism.reactions(s).axes(id, model::Frame::FirstBody) {
                axes[..own.len()].copy_from_slice(&own);
            }
            axes
        };
        mechanism.layout().constraint_ids().map(of).collect()
    }
}

/// Returns, for each joint, the directions of the forces `W_X·Z_X·y` and the components of the
/// wrench that change with y. Torques are divided by the size of the set (m).
fn freedom(space: SpaceKind, free: &[Matrix], turns: &[[[f64; 3]; 3]], size: f64) -> Vec<Freedom> {
    let norm = |m: &Matrix, i: usize| m.row(i).iter().map(|x| x * x).sum::<f64>().sqrt();
    let all = |m: &Matrix, rows: Range<usize>| rows.map(|i| norm(m, i)).fold(0.0, f64::hypot);
    let as_force = |m: &Matrix| all(m, space.forces()).max(all(m, space.torques()) / size);
    let least = VISIBLE * free.iter().map(as_force).fold(0.0, f64::max);
    let is_free = |part: f64, component: usize| {
        let is_torque = space.torques().contains(&component);
        part > if is_torque { least * size } else { least }
    };
    let of = |(m, axes): (&Matrix, &[[f64; 3]; 3])| {
        let mut freedom = Freedom {
            angle: f64::NAN,
            plane: false,
            components: [false; 6],
            in_body: [false; 6],
        };
        for c in 0..space.n_v() {
            freedom.components[c] = is_free(norm(m, c), c);
            let own = if space.torques().contains(&c) {
                space.torques()
            } else {
                space.forces()
            };
            // Computes the component along an axis of the body from the components along the axes
            // of the ground.
            let axis = axes[space.axis_of(c)];
            let along = (0..m.ncols()).map(|y| {
                let terms = own.clone().map(|i| axis[space.axis_of(i)] * m[(i, y)]);
                terms.sum::<f64>()
            });
            let along = along.map(|x| x * x).sum::<f64>().sqrt();
            freedom.in_body[c] = is_free(along, c);
        }
        if space != SpaceKind::Space3 {
            (freedom.angle, freedom.plane) = direction(m, least);
        }
        freedom
    };
    free.iter().zip(turns).map(of).collect()
}

/// Returns the angle of a direction in which a force in the plane is free, and whether the force is
/// also free across this direction. The angle is NaN if there is no such direction.
fn direction(m: &Matrix, least: f64) -> (f64, bool) {
    let dot = |i: usize, j: usize| -> f64 {
        let terms = m.row(i).iter().zip(m.row(j));
        terms.map(|(a, b)| a * b).sum()
    };
    let (xx, xy, yy) = (dot(0, 0), dot(0, 1), dot(1, 1));
    let is_free = (xx + yy).sqrt() > least;
    if !is_free {
        return (f64::NAN, false);
    }
    // Computes the axes of the ellipse with these second moments.
    let half = (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt();
    let minor = (0.5 * (xx + yy) - half).max(0.0);
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    (angle, minor > PLANE * (xx + yy))
}

/// The values of the choices at an instant.
struct Instant {
    values: Vec<Vec<Vec<f64>>>,
    freedom: Vec<Freedom>,
}

/// Selects sets of redundant rows that can be deleted. If enough sets exist, every row that can be
/// deleted belongs to at least one selected set. Each step selects the set with the largest number
/// of rows that are not yet in a selected set. If there are several such sets, the step selects the
/// set with the largest pivots, because the remaining reactions are then determined best.
fn eliminations(decision: &RankDecision) -> Vec<Vec<usize>> {
    let z = dependencies(decision);
    let all = deletions(decision, CANDIDATES).unwrap_or_default();
    let firm = all.into_iter().filter_map(|rows| {
        let firmness = firmness(&z, &rows);
        // Most runs already use the redundant rows of the decision as their choice.
        (firmness >= 2.0 * FIRM && rows != decision.dropped).then_some((rows, firmness))
    });
    let mut firm: Vec<(Vec<usize>, f64)> = firm.collect();
    firm.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    let mut covered = vec![false; z.nrows()];
    let mut taken = Vec::new();
    while taken.len() < ELIMINATIONS {
        let gain = |rows: &[usize]| rows.iter().filter(|&&i| !covered[i]).count();
        let best = (0..firm.len()).max_by_key(|&k| (gain(&firm[k].0), std::cmp::Reverse(k)));
        let Some(best) = best.filter(|&k| gain(&firm[k].0) > 0) else {
            break;
        };
        let (rows, _) = firm.remove(best);
        rows.iter().for_each(|&i| covered[i] = true);
        taken.push(rows);
    }
    taken
}

/// Smallest pivot of Z_D relative to its largest entry.
fn firmness(z: &Matrix, rows: &[usize]) -> f64 {
    relative_pivot(z, &PivotedQr::of_columns(&z.select_rows(rows)))
}

fn relative_pivot(z: &Matrix, qr: &PivotedQr) -> f64 {
    let smallest = qr.r_diagonal().map(f64::abs).fold(f64::INFINITY, f64::min);
    smallest / z.max_abs().max(f64::MIN_POSITIVE)
}

/// Coordinates of the bodies of a part at a frame.
fn coordinates(part: &Part, frame: &Frame) -> Vec<f64> {
    let places = part.places.coordinates.iter();
    places.map(|&j| frame.q[j]).collect()
}

/// The multipliers `λ + Z·y`.
fn moved(lambda: &[f64], z: &Matrix, y: &[f64]) -> Vec<f64> {
    let change = z.times(y);
    lambda.iter().zip(change).map(|(l, c)| l + c).collect()
}

/// Returns the y for which the sum of the squares of all wrenches `w + W·Z·y` is smallest (N, N·m).
/// There is no such y if a free direction does not change the wrenches on the first bodies.
fn least_norm(free: &[Matrix], wrenches: &[Vec<f64>]) -> Option<Vec<f64>> {
    let p = free.first()?.ncols();
    let places: Vec<(&Matrix, usize)> = free
        .iter()
        .flat_map(|m| (0..m.nrows()).map(move |i| (m, i)))
        .collect();
    let stacked = Matrix::from_fn(places.len().max(p), p, |k, j| match places.get(k) {
        Some((m, i)) => m[(*i, j)],
        None => 0.0,
    });
    let qr = PivotedQr::of_columns(&stacked);
    let mut pivots = qr.r_diagonal().map(f64::abs);
    let largest = pivots.next()?;
    if pivots
        .chain([largest])
        .any(|pivot| pivot <= VISIBLE * largest)
    {
        return None;
    }
    let mut x: Vec<f64> = wrenches.iter().flatten().map(|w| -w).collect();
    x.resize(stacked.nrows(), 0.0);
    Some(solved(&qr, x, p))
}

/// Returns the multipliers `λ + Z·y` that are zero in as many rows as there are free directions, or
/// `None` if these rows are ill-conditioned.
fn without_load(lambda: &[f64], z: &Matrix, rows: &[usize]) -> Option<Vec<f64>> {
    if rows.len() != z.ncols() {
        return None;
    }
    let qr = PivotedQr::of_columns(&z.select_rows(rows));
    if relative_pivot(z, &qr) < FIRM {
        return None;
    }
    let own = rows.iter().map(|&i| -lambda[i]).collect();
    let mut lambda = moved(lambda, z, &solved(&qr, own, rows.len()));
    rows.iter().for_each(|&i| lambda[i] = 0.0);
    Some(lambda)
}

/// Returns the p values y for which `‖A·y − x‖` is smallest, from the factors of A.
fn solved(qr: &PivotedQr, mut x: Vec<f64>, p: usize) -> Vec<f64> {
    qr.q_transpose_mul(&mut x);
    x.truncate(p);
    qr.solve_r(&mut x);
    let mut y = vec![0.0; p];
    for (x, &k) in x.iter().zip(qr.permutation()) {
        y[k] = *x;
    }
    y
}

/// The product `W·Z` for these rows of Z.
fn product(w: &Matrix, z: &Matrix, rows: &RowRanges) -> Matrix {
    let rows: Vec<usize> = rows.iter().collect();
    Matrix::from_fn(w.nrows(), z.ncols(), |i, j| {
        let terms = w.row(i).iter().zip(&rows);
        terms.map(|(w, row)| w * z[(*row, j)]).sum()
    })
}
