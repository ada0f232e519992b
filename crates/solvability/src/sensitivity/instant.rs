//! The solved equations of motion of connected bodies at one instant, and the derivatives of
//! reaction components with respect to all data.

use crate::limits::{
    ALIKE, FIRST_ORDER, FOLLOW_CORRECTIONS, FOLLOW_STEPS, FOLLOWED_DATA, FOLLOWED_WORK, FRAGILE,
    LOAD_ROUNDING, MOVED, NEAR_LIMIT, PIECE, SAME_EFFECT, SAME_WAY,
};
use std::borrow::Cow;

use linalg::{KeptRowSaddle, Matrix, SparseMatrix};
use model::space::norm;
use model::start::scene_size;
use model::{
    ColumnKind, ConstraintId, DataBlock, DataGradients, DataUnit, Derivatives, Mechanism, System,
};

use super::displaced::{BodyMasses, DisplacedEquations};
use super::held::{HeldMultipliers, HeldSlopes};
use super::joined::JoinedBodies;
use super::number::ReactionNumber;
use crate::choices::ChoiceError;
use crate::sparse::rows_of;
use crate::value::{Datum, Sensitivity};

/// Angle between the directions of successive unit loads (rad): the golden angle, which is far from
/// every simple fraction of a revolution.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// The solved equations of connected bodies at one instant.
pub(super) struct SolvedEquations<'a> {
    mechanism: &'a Mechanism,
    q: &'a [f64],
    s: model::Scratch,
    kept: &'a [usize],
    size: f64,
    saddle: KeptRowSaddle,
    lambda: Vec<f64>,
    slopes: Slopes,
    /// The equations with displaced data, if a configuration with a lower rank is near.
    displaced: Option<DisplacedEquations<'a>>,
    /// Points, directions and numbers, with the displacement of each.
    blocks: Vec<(DataBlock, f64)>,
    /// Largest applied or inertial load (N); torques are divided by the size.
    load: f64,
    work: Work,
}

/// Derivatives of the constraints with respect to configuration, velocities and data, at constant
/// applied loads.
struct Slopes {
    derivatives: model::Derivatives,
    by_data: DataGradients,
    /// Derivative of the loads of armatures with respect to a displacement.
    armature_dq: model::Sparse,
    /// Factored kept rows of C (only if the result depends on velocities) and of Φ. Columns are in
    /// velocity units.
    c: Option<KeptRowSaddle>,
    phi_q: KeptRowSaddle,
}

/// Storage of one gradient.
struct Work {
    zero: Vec<f64>,
    of_kept: Vec<f64>,
    y: Vec<f64>,
    y_kept: Vec<f64>,
    y_lambda: Vec<f64>,
    by_pose: Vec<f64>,
    w_v: Vec<f64>,
    w_q: Vec<f64>,
}

impl Work {
    fn new(n: usize, m: usize, kept: usize) -> Self {
        Self {
            zero: vec![0.0; n],
            of_kept: vec![0.0; kept],
            y: vec![0.0; n],
            y_kept: vec![0.0; kept],
            y_lambda: vec![0.0; m],
            by_pose: vec![0.0; n],
            w_v: vec![0.0; m],
            w_q: vec![0.0; m],
        }
    }
}

impl<'a> SolvedEquations<'a> {
    /// Solves the equations at time t with independent rows `kept`.
    pub(super) fn new(
        joined: &'a JoinedBodies<'a>,
        t: f64,
        kept: &'a [usize],
    ) -> Result<Self, ChoiceError> {
        let mechanism = joined.mechanism;
        let layout = mechanism.layout();
        let (n, m) = (layout.n_v, layout.rows());
        let mut s = mechanism.scratch();
        mechanism.pose(t, &joined.q, &mut s);
        mechanism.c(&mut s);
        mechanism.twist(&joined.v, &mut s);
        mechanism.gamma(&mut s);
        let size = scene_size(mechanism, &joined.q);
        let units = units(mechanism, size);
        let rows = rows_of(mechanism, &s, kept.iter().copied(), |_| 1.0);
        let mut saddle = KeptRowSaddle::of_rows(&rows, mechanism.inertia(&s))?;
        let mut gamma: Vec<f64> = kept.iter().map(|&i| s.gamma[i]).collect();
        let (mut a, mut of_kept) = (vec![0.0; n], vec![0.0; kept.len()]);
        saddle.solve(&joined.force, &gamma, &mut a, &mut of_kept)?;
        let mut v = Cow::Borrowed(&joined.v[..]);
        let inertial = mechanism.inertia(&s).product(&a);
        let mut load = largest_load(mechanism, &joined.force, &inertial, size);
        let (mut mass, mut force) = (BodyMasses::OfMechanism, joined.force.to_vec());
        if load <= LOAD_ROUNDING * largest_stop(mechanism, &v, size) {
            // The bodies are at rest and have equal masses, because without a load there is no
            // reference for speed or mass.
            v = Cow::Owned(vec![0.0; n]);
            mechanism.twist(&v, &mut s);
            gamma.fill(0.0);
            let equal: Vec<f64> = units.iter().map(|unit| 1.0 / (unit * unit)).collect();
            saddle.factor(|k| rows.row(k).1, &equal)?;
            mass = BodyMasses::Equal(equal);
            force = unit_loads(mechanism, size);
            saddle.solve(&force, &gamma, &mut a, &mut of_kept)?;
            load = 1.0;
        }
        let mut lambda = vec![0.0; m];
        for (&i, l) in kept.iter().zip(of_kept) {
            lambda[i] = l;
        }
        let mut derivatives = Derivatives::of_constraints(mechanism);
        derivatives.differentiate_constraints(mechanism, &a, &lambda, &s);
        // The terms that are quadratic in velocities are loads, which are constant. Therefore the
        // load of an armature changes as at rest.
        let mut of_armatures = Derivatives::of_constraints(mechanism);
        let mut inertial = vec![0.0; n];
        if mechanism.has_armatures() && matches!(mass, BodyMasses::OfMechanism) {
            inertial.clone_from(&a);
            let mut at_rest = s.clone();
            mechanism.twist(&vec![0.0; n], &mut at_rest);
            of_armatures.differentiate_constraints(mechanism, &a, &lambda, &at_rest);
        }
        let feels_velocities = derivatives.gamma_dv.iter().any(|(.., value)| value != 0.0);
        let holonomic = kept.partition_point(|&i| i < layout.m);
        let moved = |block: DataBlock| {
            let workshop = match block.unit {
                DataUnit::Length => MOVED * size.min(piece(mechanism, block.group)),
                DataUnit::Angle => MOVED,
            };
            let moved = workshop.max(block.tolerance.unwrap_or(0.0));
            (block, moved)
        };
        let follow = |first: usize| followed(&rows, &saddle, first, &units);
        let phi_q = follow(holonomic)?;
        let c = feels_velocities.then(|| follow(kept.len())).transpose()?;
        Ok(Self {
            displaced: is_near_limit(&rows.dense(), &units).then(|| DisplacedEquations {
                mechanism,
                t,
                q: &joined.q,
                v: v.to_vec(),
                kept,
                mass,
                force,
                units: units.clone(),
                size,
            }),
            slopes: Slopes {
                derivatives,
                armature_dq: of_armatures.armature_dq,
                by_data: mechanism.data().gradients(&s, &lambda, [&a, &inertial], &v),
                c,
                phi_q,
            },
            blocks: mechanism.data().blocks(&s).into_iter().map(moved).collect(),
            work: Work::new(n, m, kept.len()),
            mechanism,
            q: &joined.q,
            s,
            kept,
            size,
            saddle,
            lambda,
            load,
        })
    }

    /// Returns the largest change of each number with one datum.
    pub(super) fn changes(
        &mut self,
        numbers: &[ReactionNumber],
    ) -> Result<Vec<Change>, ChoiceError> {
        let held = HeldMultipliers {
            mechanism: self.mechanism,
            t: self.s.t,
            q: self.q,
            lambda: &self.lambda,
            size: self.size,
        };
        let slopes = held.slopes(numbers, &self.blocks);
        let mut gradient = vec![0.0; self.mechanism.data().count()];
        let each = numbers.iter().zip(&slopes);
        let each = each.map(|(number, slopes)| {
            self.gradient(number, slopes, &mut gradient)?;
            Ok(self.change(number, &gradient))
        });
        let mut changes = each.collect::<Result<Vec<_>, ChoiceError>>()?;
        let is_curved = changes.iter().any(|change| change.share() >= FIRST_ORDER);
        if self.displaced.is_some() && is_curved {
            let mut strongest = Vec::new();
            for (k, (number, slopes)) in numbers.iter().zip(&slopes).enumerate() {
                self.gradient(number, slopes, &mut gradient)?;
                strongest.extend(self.strongest((k, &changes[k]), &gradient));
            }
            self.displace(numbers, strongest, &mut changes);
        }
        Ok(changes)
    }

    /// Includes the changes of the mechanisms with displaced data. The most influential data come
    /// first. Numbers that are sensitive to first order do not change.
    fn displace(
        &self,
        numbers: &[ReactionNumber],
        mut strongest: Vec<Displacement>,
        changes: &mut [Change],
    ) {
        let Some(displaced) = &self.displaced else {
            return;
        };
        strongest.sort_by(|a, b| b.share.total_cmp(&a.share));
        let mut all: Vec<Displacement> = Vec::new();
        for own in strongest {
            match all.iter_mut().find(|other| other.is_same(&own)) {
                Some(known) => known.numbers.extend(own.numbers),
                None => all.push(own),
            }
        }
        let n = self.mechanism.layout().n_v;
        let corrections = 2 * FOLLOW_STEPS * FOLLOW_CORRECTIONS;
        let factors = [corrections, self.kept.len().max(1), n, n];
        let work = factors.into_iter().fold(1, usize::saturating_mul);
        all.truncate(FOLLOWED_DATA.min(FOLLOWED_WORK / work.max(1)));
        let stored = self.mechanism.data().numbers();
        let values: Vec<f64> = changes.iter().map(|change| change.value).collect();
        for own in &all {
            let (block, moved) = &self.blocks[own.block];
            for sign in [1.0, -1.0] {
                let there = displaced.changes(numbers, &values, |share: f64| {
                    let mut all = stored.clone();
                    let by = own.by.map(|x| sign * share * moved * x);
                    let there = block.displaced(&stored[block.numbers.clone()], by);
                    all[block.numbers.clone()].copy_from_slice(&there);
                    all
                });
                for (k, change) in changes.iter_mut().enumerate() {
                    let share = change.share();
                    if share.is_nan() || share > FRAGILE {
                        continue;
                    }
                    let other = match &there {
                        Some(changes) => changes[k],
                        // If no configuration exists, a number that depends on the datum has no
                        // value.
                        None if own.numbers.contains(&k) && share >= FIRST_ORDER => change.whole(),
                        None => 0.0,
                    };
                    if other > change.largest {
                        change.largest = other;
                        change.by = Some(datum(block, *moved));
                    }
                }
            }
        }
    }

    /// Returns the data that change a number with this gradient nearly as much as the largest
    /// change.
    fn strongest(&self, (number, change): (usize, &Change), gradient: &[f64]) -> Vec<Displacement> {
        let each = self.blocks.iter().enumerate();
        let strong = each.filter_map(|(k, (block, moved))| {
            let own = block.change(gradient, *moved);
            (own > 0.0 && own >= ALIKE * change.largest).then(|| Displacement {
                numbers: vec![number],
                block: k,
                by: block.steepest(gradient),
                share: own / change.whole(),
            })
        });
        strong.collect()
    }

    /// Returns the largest change of a number with this gradient.
    fn change(&self, number: &ReactionNumber, gradient: &[f64]) -> Change {
        let changes = self.blocks.iter();
        let changes: Vec<f64> = changes
            .map(|(block, moved)| block.change(gradient, *moved))
            .collect();
        let largest = changes.iter().copied().fold(0.0, f64::max);
        let mut changed = changes.iter();
        let first = changed.position(|change| SAME_EFFECT * change >= largest);
        let by = first.filter(|_| largest > 0.0);
        // The gradient is NaN if the equations are nearly singular.
        let is_known = changes.iter().all(|change| change.is_finite());
        Change {
            largest: if is_known { largest } else { f64::NAN },
            value: self.value(number, &self.lambda, number.joints()),
            load: self.load * number.unit(self.mechanism, self.size),
            by: by.map(|k| datum(&self.blocks[k].0, self.blocks[k].1)),
        }
    }

    /// Returns the contributions of these joints to a number, for these multipliers.
    fn value(
        &self,
        number: &ReactionNumber,
        lambda: &[f64],
        joints: impl IntoIterator<Item = usize>,
    ) -> f64 {
        let of_joint = |joint: usize| {
            let (id, reactions) = (ConstraintId(joint), self.mechanism.reactions(&self.s));
            number.of_joint(reactions, id, &reactions.reaction(id, lambda))
        };
        joints.into_iter().map(of_joint).sum()
    }

    /// Computes the derivatives of a reaction component with respect to all data of the
    /// constraints.
    fn gradient(
        &mut self,
        number: &ReactionNumber,
        held: &HeldSlopes,
        out: &mut [f64],
    ) -> Result<(), ChoiceError> {
        self.work.of_kept.fill(0.0);
        let mut unit = vec![0.0; self.lambda.len()];
        for joint in number.joints() {
            for row in &self.mechanism.layout().groups[joint].rows {
                if let Ok(k) = self.kept.binary_search(&row) {
                    unit[row] = 1.0;
                    self.work.of_kept[k] = self.value(number, &unit, [joint]);
                    unit[row] = 0.0;
                }
            }
        }
        let w = &mut self.work;
        self.saddle
            .solve(&w.zero, &w.of_kept, &mut w.y, &mut w.y_kept)?;
        for (&i, value) in self.kept.iter().zip(&w.y_kept) {
            w.y_lambda[i] = *value;
        }
        let slopes = &mut self.slopes;
        let d = &slopes.derivatives;
        // Contribution through the velocities, which change with the data and the configuration.
        if let Some(c) = &mut slopes.c {
            w.by_pose.fill(0.0);
            add_transposed(d.gamma_dv.iter(), &w.y_lambda, 1.0, &mut w.by_pose);
            multipliers(c, &w.by_pose, self.kept, &mut w.w_v);
        }
        // Contribution through the configuration, which changes with the data.
        w.by_pose.fill(0.0);
        for &(column, slope) in &held.by_pose {
            w.by_pose[column] += slope;
        }
        add_transposed(d.reaction_dq.iter(), &w.y, -1.0, &mut w.by_pose);
        add_transposed(slopes.armature_dq.iter(), &w.y, 1.0, &mut w.by_pose);
        add_transposed(d.residual_dq.iter(), &w.y_lambda, -1.0, &mut w.by_pose);
        add_transposed(d.velocity_dq.iter(), &w.w_v, -1.0, &mut w.by_pose);
        multipliers(&mut slopes.phi_q, &w.by_pose, self.kept, &mut w.w_q);
        let by_rows = [&w.y_lambda[..], &w.w_v, &w.w_q];
        slopes.by_data.gradient(&w.y, by_rows, out);
        out.iter_mut().for_each(|slope| *slope = -*slope);
        for &(place, slope) in &held.by_data {
            out[place] += slope;
        }
        Ok(())
    }
}

/// The largest change of a number of reactions due to one datum.
#[derive(Clone, Debug)]
pub(super) struct Change {
    /// The largest change, or NaN if the equations are nearly singular.
    pub(super) largest: f64,
    /// The datum with the largest change; `None` if no datum changes the number.
    pub(super) by: Option<Datum>,
    /// Value of the number.
    pub(super) value: f64,
    /// The largest load in the unit of the number.
    pub(super) load: f64,
}

/// A datum that is displaced in the direction in which it changes some numbers most.
struct Displacement {
    /// Indices of the numbers.
    numbers: Vec<usize>,
    block: usize,
    /// Direction of the displacement, a unit vector.
    by: [f64; 3],
    /// The largest first-order change of these numbers, as a share.
    share: f64,
}

impl Displacement {
    fn is_same(&self, other: &Self) -> bool {
        let along: f64 = self.by.iter().zip(other.by).map(|(a, b)| a * b).sum();
        self.block == other.block && along.abs() > SAME_WAY
    }
}

fn datum(block: &DataBlock, moved: f64) -> Datum {
    Datum {
        joint: ConstraintId(block.group),
        name: block.name,
        moved,
        unit: block.unit,
        is_number: block.numbers.len() == 1,
    }
}

impl Change {
    /// Returns the reference value of the share, which is the number or the load.
    fn whole(&self) -> f64 {
        self.value.abs().max(self.load)
    }

    /// Returns the change as a share, or NaN if the change is not known.
    fn share(&self) -> f64 {
        match self.by {
            None if self.largest == 0.0 => 0.0,
            _ => self.largest / self.whole(),
        }
    }

    /// Returns the change as a fraction, or `None` if the change is not known.
    pub(super) fn relative(self) -> Option<Sensitivity> {
        let change = self.share();
        let by = self.by;
        change.is_finite().then_some(Sensitivity { change, by })
    }

    /// Returns the change of a sum of two numbers that depend on different data.
    pub(super) fn and(self, other: Self) -> Self {
        let (value, load) = (self.value + other.value, self.load.max(other.load));
        let larger = if other.largest > self.largest || other.largest.is_nan() {
            other
        } else {
            self
        };
        Self {
            value,
            load,
            ..larger
        }
    }
}

/// Factors the first rows, which the smallest motion keeps satisfied if the data change. `solved`
/// contains factors of all rows.
fn followed(
    rows: &SparseMatrix,
    solved: &KeptRowSaddle,
    first: usize,
    units: &[f64],
) -> Result<KeptRowSaddle, ChoiceError> {
    let weights: Vec<f64> = units.iter().map(|unit| unit.powi(-2)).collect();
    if first < rows.nrows() {
        let first: Vec<usize> = (0..first).collect();
        return Ok(KeptRowSaddle::of_rows(&rows.select_rows(&first), &weights)?);
    }
    let mut saddle = solved.clone();
    saddle.factor(|k| rows.row(k).1, &weights)?;
    Ok(saddle)
}

/// Computes `w` with `gᵀ·δx = −wᵀ·δr`. Here δx is the smallest displacement that compensates a
/// change δr of the followed rows, which are the first rows of `kept`. Entries of other rows are
/// left unchanged. The entries are NaN if the rows are nearly dependent.
fn multipliers(rows: &mut KeptRowSaddle, g: &[f64], kept: &[usize], w: &mut [f64]) {
    let (still, mut x) = (vec![0.0; rows.n_rows()], vec![0.0; g.len()]);
    let mut found = still.clone();
    if rows.solve(g, &still, &mut x, &mut found).is_err() {
        found.fill(f64::NAN);
    }
    kept.iter()
        .zip(found)
        .for_each(|(&row, found)| w[row] = found);
}

/// Computes `y ← y + factor·Aᵀ·x`.
fn add_transposed(
    matrix: impl Iterator<Item = (usize, usize, f64)>,
    x: &[f64],
    factor: f64,
    y: &mut [f64],
) {
    for (row, column, value) in matrix {
        y[column] += factor * value * x[row];
    }
}

/// Returns the largest applied or inertial force on a body (N). Torques are divided by the size.
/// Forces and torques count as vectors, because single components depend on the axes.
fn largest_load(mechanism: &Mechanism, force: &[f64], inertial: &[f64], size: f64) -> f64 {
    let space = mechanism.space();
    let of_body = |body: usize| {
        let (columns, turned) = (space.columns_of(body), space.rotations_of(body));
        let moved = columns.start..turned.start;
        let of = |load: &[f64]| norm(&load[moved.clone()]).max(norm(&load[turned.clone()]) / size);
        of(force).max(of(inertial))
    };
    let bodies = 0..mechanism.bodies().len();
    bodies.map(of_body).fold(0.0, f64::max)
}

/// Returns whether rows of length one, with columns in these units, are near a lower rank.
fn is_near_limit(rows: &Matrix, units: &[f64]) -> bool {
    let mut scaled = Matrix::from_fn(rows.nrows(), units.len(), |i, j| rows[(i, j)] * units[j]);
    for i in 0..rows.nrows() {
        let length = linalg::kernels::norm(scaled.row(i));
        scaled.row_mut(i).iter_mut().for_each(|x| *x /= length);
    }
    let weakest = rank::weakest_combination(&scaled);
    weakest.is_some_and(|weakest| weakest.sigma < NEAR_LIMIT)
}

/// Returns velocities of one unit. The velocities are 1 m/s, and the rate that moves a point at the
/// size of the mechanism by 1 m/s. The velocities are weights of motions and are not rounded,
/// because a sensitivity must not depend on units.
pub(super) fn units(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let kinds = mechanism.layout().column_kinds();
    let unit = |kind: &ColumnKind| match kind {
        ColumnKind::Translation => 1.0,
        ColumnKind::Rotation => 1.0 / size,
    };
    kinds.iter().map(unit).collect()
}

/// Returns the length (m) to which manufacturing accuracy refers for the bodies of a joint. The
/// length is several times the reach of the bodies, or infinity if the reach is not known.
fn piece(mechanism: &Mechanism, group: usize) -> f64 {
    let bodies = mechanism.layout().groups[group].bodies.iter();
    let reach = bodies
        .filter_map(|b| b.moving())
        .map(|k| mechanism.reach(k));
    match reach.fold(0.0, f64::max) {
        reach if reach > 0.0 => PIECE * reach,
        _ => f64::INFINITY,
    }
}

/// Returns the force (N) that would stop the fastest body within a distance of the size of the
/// mechanism.
fn largest_stop(mechanism: &Mechanism, v: &[f64], size: f64) -> f64 {
    let kinds = mechanism.layout().column_kinds();
    let of = |((m, v), kind): ((&f64, &f64), &ColumnKind)| {
        let unit = match kind {
            ColumnKind::Translation => size,
            ColumnKind::Rotation => size * size,
        };
        m * v * v / unit
    };
    let each = mechanism.mass().iter().zip(v).zip(&kinds);
    each.map(of).fold(0.0, f64::max)
}

/// Returns a force of 1 N on each body, and a torque of up to 1 N times the size.
fn unit_loads(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let kinds = mechanism.layout().column_kinds();
    let number = |(j, kind): (usize, &ColumnKind)| {
        let space = mechanism.space();
        let (sin, cos) = (GOLDEN_ANGLE * (1 + space.body_of(j)) as f64).sin_cos();
        match (kind, space.dof_of(j)) {
            (ColumnKind::Rotation, _) => size * (2.0 * sin * cos),
            (ColumnKind::Translation, 0) => cos,
            (ColumnKind::Translation, _) => sin,
        }
    };
    kinds.iter().enumerate().map(number).collect()
}
