//! The conditions of contacts as half spaces of the free coordinates y of their parts.

use linalg::DisjointSets;
use model::{ConstraintId, Grip, GripLoad, Mechanism, Scratch, System};

use super::carried::pressing_force;
use super::error::PermittedError;
use crate::choices::{FreeMultipliers, Solution, not_finite};
use crate::groups::{Configuration, LinearForm, RequestError};
use crate::limits::{CLEAR_PULL, GRIP_SIDES, PARALLEL_SLIP, SUPPORT_ROUNDING};
use crate::polyhedra::polyhedron::{HalfSpace, Polyhedron};
use crate::questions::Questions;
use crate::verdict::Verdict;

/// A condition of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ContactCondition {
    /// The joint.
    pub joint: ConstraintId,
    /// The condition that the joint must satisfy.
    pub kind: ConditionKind,
}

/// A kind of condition that a contact must satisfy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum ConditionKind {
    /// The joint stays closed: its force presses, N ≥ 0.
    Presses,
    /// The contact does not slip: |S| ≤ μ·N.
    Grips,
}

/// Polygons that approximate the circle `|S| ≤ μ·N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Polygon {
    /// The polygon contains the circle.
    Outer,
    /// The circle contains the polygon.
    Inner,
}

/// The number `value + row·y`.
#[derive(Clone, Debug)]
pub(super) struct LoadNumber {
    pub(super) row: Vec<f64>,
    pub(super) value: f64,
}

/// A contact with friction.
pub(super) struct GripConditions {
    pub(super) joint: ConstraintId,
    pub(super) friction: f64,
    /// The force N that presses the contact.
    pub(super) load: LoadNumber,
    /// The components of the force S along orthonormal directions.
    pub(super) slip: Vec<LoadNumber>,
}

/// Parts whose contacts depend on each other, and the loads that their contacts permit.
pub(super) struct Cluster {
    /// The parts, each with the index of its first coordinate.
    parts: Vec<(usize, usize)>,
    p: usize,
    /// The forces with which one-sided joints press.
    presses: Vec<(ConstraintId, LoadNumber)>,
    pub(super) grips: Vec<GripConditions>,
    /// The conditions of the half spaces of `permitted`.
    pub(super) conditions: Vec<ContactCondition>,
    /// The permitted loads, with the outer polygons of contacts with friction.
    pub(super) permitted: Polyhedron,
    /// Size of the loads (N).
    size: f64,
    /// Size of the rows of the conditions, the unit of y.
    unit: f64,
}

/// A load in a part: the part, the number, and the coefficient.
type LoadShare<'f> = (usize, &'f LinearForm, f64);

impl Cluster {
    /// Returns a number as a function of y.
    pub(super) fn number(
        &self,
        (questions, solution): (&Questions<'_>, &Solution),
        shares: &[LoadShare<'_>],
        name: impl Fn() -> String,
    ) -> Result<LoadNumber, PermittedError> {
        let mut number = LoadNumber {
            row: vec![0.0; self.p],
            value: 0.0,
        };
        for &(k, form, coefficient) in shares {
            let (configuration, extent) =
                (questions.configuration(k)?, &questions.parts()[k].extent);
            if let Some(why) = not_finite(&solution.no_finite, extent, form) {
                return Err(PermittedError::NoFinite(why));
            }
            let lambda = extent.of_rows(solution.multipliers.as_chosen());
            number.value += coefficient * configuration.value(form, &lambda);
            match configuration.judge(form)?.verdict {
                Verdict::Unique => continue,
                Verdict::NotUnique => {}
                Verdict::Undecided { .. } => return Err(PermittedError::Verdict(name())),
            }
            let first = self.parts.iter().find(|(part, _)| *part == k);
            let first = first.map_or(0, |(_, first)| *first);
            let free = FreeMultipliers::of(configuration.solvability());
            let (image, size) = form.image(&free);
            for (own, x) in number.row[first..].iter_mut().zip(image) {
                *own += coefficient * x * size / self.unit;
            }
        }
        Ok(number)
    }

    /// Chooses the unit of y so that the largest row of a condition has the size 1.
    fn scale(&mut self) {
        let grips = self.grips.iter_mut();
        let of_grips = grips.flat_map(|g| std::iter::once(&mut g.load).chain(&mut g.slip));
        let presses = self.presses.iter_mut().map(|(_, number)| number);
        let mut all: Vec<&mut LoadNumber> = presses.chain(of_grips).collect();
        let largest = all.iter().map(|n| linalg::kernels::norm(&n.row));
        let largest = largest.fold(0.0, f64::max);
        if largest > 0.0 {
            self.unit = largest;
            let rows = all.iter_mut().flat_map(|n| &mut n.row);
            rows.for_each(|x| *x /= largest);
        }
    }

    /// Returns the half spaces of one-sided joints, and of contacts with these coefficients of
    /// friction. Each half space has its condition.
    pub(super) fn half_spaces(
        &self,
        friction: impl Fn(&GripConditions) -> f64,
        polygon: Polygon,
    ) -> (Vec<ContactCondition>, Vec<HalfSpace>) {
        let presses = self.presses.iter().map(|(joint, number)| {
            let kind = ConditionKind::Presses;
            (
                ContactCondition {
                    joint: *joint,
                    kind,
                },
                number.as_half_space(),
            )
        });
        let grips = self.grips.iter().flat_map(|grip| {
            let (joint, kind) = (grip.joint, ConditionKind::Grips);
            let own = grip.half_spaces(friction(grip), polygon);
            own.into_iter()
                .map(move |half| (ContactCondition { joint, kind }, half))
        });
        presses.chain(grips).unzip()
    }

    /// Returns the conditions that the solution with y = 0 violates, each once.
    pub(super) fn violated(&self) -> Vec<ContactCondition> {
        let (conditions, halves) = self.half_spaces(|grip| grip.friction, Polygon::Outer);
        let all = conditions.into_iter().zip(halves);
        let violated = all.filter(|(_, half)| half.value < -CLEAR_PULL * self.size);
        let mut conditions: Vec<ContactCondition> = violated.map(|(c, _)| c).collect();
        conditions.dedup();
        conditions
    }

    /// Returns the forces with which one-sided joints press at a point y.
    pub(super) fn pressing(&self, y: &[f64]) -> Vec<(ConstraintId, f64)> {
        let presses = self.presses.iter();
        let force = |number: &LoadNumber| number.value + linalg::kernels::dot(&number.row, y);
        presses.map(|(id, number)| (*id, force(number))).collect()
    }

    /// Returns the components of reactions that change along a direction of y, with their changes.
    pub(super) fn changes(
        &self,
        of: (&Questions<'_>, &Solution),
        ray: &[f64],
    ) -> Result<Vec<(ConstraintId, &'static str, f64)>, PermittedError> {
        let (questions, layout) = (of.0, of.0.mechanism().layout());
        let mut changes = Vec::new();
        for id in layout.constraint_ids() {
            let (k, own) = questions.place(id)?;
            if !self.parts.iter().any(|(part, _)| *part == k) {
                continue;
            }
            let group = &layout.groups[id.0];
            for name in group.component_names() {
                let form = questions
                    .configuration(k)?
                    .reactions()
                    .component(own, name)?;
                let number = self.number(of, &[(k, &form, 1.0)], || group.name.clone())?;
                let change = linalg::kernels::dot(&number.row, ray);
                let terms = number.row.iter().zip(ray).map(|(a, b)| (a * b).abs());
                if change.abs() > SUPPORT_ROUNDING * terms.sum::<f64>() {
                    changes.push((id, name, change));
                }
            }
        }
        Ok(changes)
    }

    /// Returns the loads that one-sided joints permit, whether or not contacts slip.
    pub(super) fn of_presses(&self) -> Polyhedron {
        let presses = self
            .presses
            .iter()
            .map(|(_, number)| number.as_half_space());
        self.permitted_by(&presses.collect::<Vec<_>>())
    }

    /// Returns the loads in these half spaces.
    pub(super) fn permitted_by(&self, halves: &[HalfSpace]) -> Polyhedron {
        Polyhedron::new(self.p, halves, self.size)
    }
}

impl LoadNumber {
    pub(super) fn as_half_space(&self) -> HalfSpace {
        HalfSpace {
            row: self.row.clone(),
            value: self.value,
        }
    }

    /// Returns `a·self + Σ c·other`.
    fn combined(&self, a: f64, others: &[(f64, &Self)]) -> HalfSpace {
        let mut half = HalfSpace {
            row: self.row.iter().map(|x| a * x).collect(),
            value: a * self.value,
        };
        for (c, other) in others {
            half.value += c * other.value;
            for (own, x) in half.row.iter_mut().zip(&other.row) {
                *own += c * x;
            }
        }
        half
    }
}

impl GripConditions {
    /// Returns the half space `μ·N − e·S ≥ 0` with the direction e of S at y = 0. It contains the
    /// cone, and is exact if S has only one value. `None` if S is zero.
    pub(super) fn tangent(&self) -> Option<HalfSpace> {
        let along: Vec<f64> = self.slip.iter().map(|s| s.value).collect();
        let size = linalg::kernels::norm(&along);
        let terms = self.slip.iter().map(|s| (-s.value / size, s));
        (size > 0.0).then(|| {
            let terms: Vec<_> = terms.collect();
            self.load.combined(self.friction, &terms)
        })
    }

    /// Returns the half spaces `μ·N − e·S ≥ 0` for the directions e of a polygon.
    pub(super) fn half_spaces(&self, friction: f64, polygon: Polygon) -> Vec<HalfSpace> {
        match self.slip.as_slice() {
            [one] => [1.0, -1.0]
                .map(|sign| self.load.combined(friction, &[(sign, one)]))
                .into(),
            [one, other] => {
                let turn = std::f64::consts::TAU / f64::from(GRIP_SIDES);
                let factor = match polygon {
                    Polygon::Outer => friction,
                    Polygon::Inner => friction * (0.5 * turn).cos(),
                };
                let side = |k: u32| {
                    let (sin, cos) = (f64::from(k) * turn).sin_cos();
                    self.load.combined(factor, &[(-cos, one), (-sin, other)])
                };
                (0..GRIP_SIDES).map(side).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// A condition with its loads as linear forms of the multipliers of parts.
struct ConditionForms {
    joint: ConstraintId,
    friction: Option<f64>,
    /// The part and the linear form of N, or a constant force.
    load: Result<(usize, LinearForm), f64>,
    /// The part and the components of S.
    slip: Vec<(usize, LinearForm)>,
}

/// Returns the clusters of all conditions, and the cluster of each part.
pub(super) fn clusters(
    questions: &Questions<'_>,
    solution: &Solution,
) -> Result<(Vec<Cluster>, Vec<Option<usize>>), PermittedError> {
    let stated = stated(questions)?;
    let parts = questions.parts();
    let mut sets = DisjointSets::new(parts.len());
    for condition in &stated {
        let mut own = condition.parts();
        if let Some(first) = own.next() {
            own.for_each(|other| sets.join(first, other));
        }
    }
    let has_condition = |k: &usize| stated.iter().any(|s| s.parts().any(|own| own == *k));
    let mut sets = sets.sets();
    sets.retain(|own| own.iter().any(has_condition));
    let mut cluster_of = vec![None; parts.len()];
    for (c, own) in sets.iter().enumerate() {
        own.iter().for_each(|k| cluster_of[*k] = Some(c));
    }
    let of_cluster = |own: &Vec<usize>| {
        let conditions = stated
            .iter()
            .filter(|s| s.parts().any(|k| own.contains(&k)));
        cluster((questions, solution), own, conditions)
    };
    let clusters = sets.iter().map(of_cluster).collect::<Result<_, _>>()?;
    Ok((clusters, cluster_of))
}

impl ConditionForms {
    fn parts(&self) -> impl Iterator<Item = usize> + '_ {
        let load = self.load.iter().map(|(k, _)| *k);
        load.chain(self.slip.iter().map(|(k, _)| *k))
    }
}

/// Returns the cluster of these parts and conditions.
fn cluster<'s>(
    of: (&Questions<'_>, &Solution),
    parts: &[usize],
    stated: impl Iterator<Item = &'s ConditionForms>,
) -> Result<Cluster, PermittedError> {
    let (questions, solution) = of;
    let mut cluster = Cluster {
        parts: Vec::new(),
        p: 0,
        presses: Vec::new(),
        grips: Vec::new(),
        conditions: Vec::new(),
        permitted: Polyhedron::new(0, &[], 1.0),
        size: 0.0,
        unit: 1.0,
    };
    for &k in parts {
        let decision = &questions.parts()[k].decision;
        if decision.status() != rank::RankStatus::Decided {
            return Err(PermittedError::Rank);
        }
        cluster.parts.push((k, cluster.p));
        cluster.p += decision.redundancy();
    }
    // Loads that vanish are rounding errors of the other loads, and of the forces that accelerate
    // the bodies.
    let mut inertia = vec![0.0; solution.acceleration.len()];
    let matrix = questions.mechanism().inertia_at(&questions.q);
    matrix.add_sizes(&solution.acceleration, &mut inertia);
    let mut size = linalg::kernels::max_abs(&inertia);
    for &k in parts {
        let lambda = questions.parts()[k]
            .extent
            .of_rows(solution.multipliers.as_chosen());
        size = size.max(linalg::kernels::max_abs(&lambda));
    }
    for condition in stated {
        let layout = questions.mechanism().layout();
        let name = || layout.groups[condition.joint.0].name.clone();
        let mut number = |(k, form): &(usize, LinearForm)| {
            let lambda = questions.parts()[*k]
                .extent
                .of_rows(solution.multipliers.as_chosen());
            size = size.max(form.size(|row| lambda[row].abs()));
            cluster.number(of, &[(*k, form, 1.0)], name)
        };
        let load = match &condition.load {
            Ok(form) => number(form)?,
            Err(constant) => LoadNumber {
                row: vec![0.0; cluster.p],
                value: *constant,
            },
        };
        let slip = condition.slip.iter().map(&mut number);
        let slip = slip.collect::<Result<Vec<_>, _>>()?;
        size = size.max(load.value.abs());
        match condition.friction {
            None => cluster.presses.push((condition.joint, load)),
            Some(friction) => cluster.grips.push(GripConditions {
                joint: condition.joint,
                friction,
                load,
                slip,
            }),
        }
    }
    // Without any load, all values are exactly zero.
    cluster.size = if size > 0.0 { size } else { 1.0 };
    cluster.scale();
    let (conditions, halves) = cluster.half_spaces(|grip| grip.friction, Polygon::Outer);
    cluster.conditions = conditions;
    cluster.permitted = cluster.permitted_by(&halves);
    Ok(cluster)
}

/// Returns the conditions of all joints.
fn stated(questions: &Questions<'_>) -> Result<Vec<ConditionForms>, RequestError> {
    let layout = questions.mechanism().layout();
    let mut all = Vec::new();
    for id in layout.constraint_ids() {
        if let Some(load) = press(questions, id)? {
            all.push(ConditionForms {
                joint: id,
                friction: None,
                load: Ok(load),
                slip: Vec::new(),
            });
        }
        if let Some(Grip { friction, load }) = &layout.groups[id.0].limits.grip {
            let presser = match load {
                GripLoad::Constant(_) => None,
                GripLoad::Own => Some(id),
                GripLoad::Joint(name) => {
                    let mut ids = layout.constraint_ids();
                    ids.find(|other| layout.groups[other.0].name == *name)
                }
            };
            let pressing = presser
                .map(|id| press(questions, id))
                .transpose()?
                .flatten();
            let load = match load {
                GripLoad::Constant(load) => Err(*load),
                // The description has been checked: the joint exists and is one-sided.
                GripLoad::Own | GripLoad::Joint(_) => pressing.ok_or(0.0),
            };
            all.push(ConditionForms {
                joint: id,
                friction: Some(*friction),
                load,
                slip: slip(questions, id)?,
            });
        }
    }
    Ok(all)
}

/// Returns the part of a one-sided joint and the force N with which it presses.
fn press(
    questions: &Questions<'_>,
    id: ConstraintId,
) -> Result<Option<(usize, LinearForm)>, RequestError> {
    let (k, own) = questions.place(id)?;
    let form = questions.configuration(k)?.press(own)?;
    Ok(form.map(|form| (k, form)))
}

impl Configuration<'_> {
    /// Returns the force N with which a joint presses, or `None` if the joint is not one-sided.
    /// According to `M·v̇ + Cᵀ·λ = Q`, the multiplier of a gap that opens towards positive values
    /// is negative while the joint presses.
    pub(crate) fn press(&self, id: ConstraintId) -> Result<Option<LinearForm>, RequestError> {
        let group = &self.layout().groups[id.0];
        let Some(side) = group.limits.open_side else {
            return Ok(None);
        };
        let reactions = self.reactions();
        let size = pressing_force(&reactions.mechanism, &reactions.s, id);
        let mut form = reactions.zero();
        form.add(&[(group.rows.row(0), -side.sign() * size)])?;
        Ok(Some(form))
    }
}

/// Returns the part of a joint and the components of the force of its nonholonomic rows along
/// orthonormal directions.
fn slip(
    questions: &Questions<'_>,
    id: ConstraintId,
) -> Result<Vec<(usize, LinearForm)>, RequestError> {
    let (k, own) = questions.place(id)?;
    let reactions = questions.configuration(k)?.reactions();
    let of_axis = |terms: &Vec<(usize, f64)>| {
        let mut form = reactions.zero();
        form.add(terms)?;
        Ok((k, form))
    };
    let axes = slip_terms(&reactions.mechanism, &reactions.s, own);
    axes.iter().map(of_axis).collect()
}

/// Returns the force of the nonholonomic rows of a joint along orthonormal directions. Each
/// component is a list of rows with the coefficients of their multipliers.
pub(super) fn slip_terms(
    mechanism: &Mechanism,
    s: &Scratch,
    id: ConstraintId,
) -> Vec<Vec<(usize, f64)>> {
    let rows = &mechanism.layout().groups[id.0].rows;
    let space = mechanism.space();
    let map = mechanism.reactions(s).wrench_map(id);
    // The force of each row for a multiplier of 1, in global components.
    let of_row = |j: usize| {
        let mut force = [0.0; 3];
        space
            .forces()
            .for_each(|c| force[space.axis_of(c)] = map[(c, j)]);
        force
    };
    let forces = (0..map.ncols()).map(of_row);
    let slipping: Vec<(usize, [f64; 3])> =
        rows.iter().zip(forces).skip(rows.holonomic.len()).collect();
    let mut axes: Vec<[f64; 3]> = Vec::new();
    for (_, force) in &slipping {
        let mut rest = *force;
        for axis in &axes {
            let along = dot(*axis, rest);
            (rest.iter_mut().zip(axis)).for_each(|(x, a)| *x -= along * a);
        }
        let size = model::space::norm(&rest);
        if size > PARALLEL_SLIP * model::space::norm(force) {
            axes.push(rest.map(|x| x / size));
        }
    }
    let of_axis = |axis: &[f64; 3]| {
        let terms = slipping.iter().map(|(row, f)| (*row, dot(*axis, *f)));
        terms.collect()
    };
    axes.iter().map(of_axis).collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
