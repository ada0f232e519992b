//! Free velocities of connected bodies, as motions of few bodies each.

use crate::limits::{AT_REST, NEW_MOTION, TRIALS};
use crate::pose::{dimensionless, evaluated, uncertainty, velocity_units};
use std::cmp::Reverse;
use std::collections::VecDeque;
use std::ops::Range;

use linalg::{Matrix, PivotedQr, equilibrate};
use model::space::{cross, difference, norm};
use model::start::scene_size;
use model::{BodyRef, ConstraintId, Mechanism, Scratch, System};
use rank::Accuracy;

use super::basis::{Condition, Form, Space, Subspace};

/// Connected bodies at a configuration, as a separate mechanism.
pub(super) struct Component<'a> {
    pub(super) mechanism: &'a Mechanism,
    pub(super) s: Scratch,
    /// Size of the mechanism (m).
    pub(super) size: f64,
    /// Velocities with the dimensionless value 1.
    units: Vec<f64>,
}

/// Velocities of all bodies of a component: first the velocity of the centre of mass (m/s), then
/// the angular velocity (rad/s), both in ground axes.
pub(super) type Velocities = Vec<Vec<f64>>;

/// Number of moving joints, number of moving bodies, and the mass of these bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Cost {
    joints: usize,
    bodies: usize,
    /// Mass of the moving bodies (kg).
    mass: f64,
}

/// Free motions of a component.
pub(super) struct Motions {
    /// Whether the component moves as one free body. The translations and rotations of the
    /// component then come before all other motions.
    pub(super) is_free: bool,
    /// Remaining motions, sorted by the number of moving joints.
    pub(super) motions: Vec<Velocities>,
}

impl<'a> Component<'a> {
    pub(super) fn new(mechanism: &'a Mechanism, t: f64, q: &[f64]) -> Self {
        let size = scene_size(mechanism, q);
        Self {
            s: evaluated(mechanism, t, q),
            size,
            units: velocity_units(mechanism, size),
            mechanism,
        }
    }

    /// Returns the pivots of the rows, the largest first. Each pivot is the part of a row that is
    /// independent of the previous rows.
    pub(super) fn pivots(&self, rows: &[usize]) -> Vec<f64> {
        let (qr, _) = self.factors(rows);
        qr.r_diagonal().map(f64::abs).collect()
    }

    /// Returns QR factors of these rows, equilibrated, and the exponents of their columns.
    fn factors(&self, rows: &[usize]) -> (PivotedQr, Vec<i32>) {
        let c = dimensionless(self.mechanism, &self.s, self.size).select_rows(rows);
        let known = uncertainty(self.mechanism, &self.s, self.size).select_rows(rows);
        // If an uncertainty is not finite, the matrix is not finite either.
        let scaling = Accuracy::from(&known)
            .equilibration(&c)
            .unwrap_or_else(|_| equilibrate(&c));
        (PivotedQr::of_rows(scaling.apply(&c)), scaling.cols)
    }

    /// Returns at most `most` motions that the rows leave free. `rank` is the rank of the rows.
    pub(super) fn motions(&self, rank: usize, most: usize) -> Motions {
        let rows: Vec<usize> = (0..self.mechanism.layout().rows()).collect();
        let (qr, columns) = self.factors(&rows);
        let mut free = qr.q_columns(rank.min(qr.steps())..qr.dimension());
        for (j, exponent) in columns.iter().enumerate() {
            let factor = f64::from(*exponent).exp2();
            free.row_mut(j).iter_mut().for_each(|x| *x *= factor);
        }
        let all = PivotedQr::of_columns(&free).q_columns(0..free.ncols());
        let mut space = Space::new(&all);
        let is_free = space.left() >= self.mechanism.space().n_v() && space.take_out(&self.rigid());
        let motions = self.chosen(&mut space, most);
        Motions { is_free, motions }
    }

    /// Returns at most `most` motions that span the remaining part of a space.
    fn chosen(&self, space: &mut Space<'_>, most: usize) -> Vec<Velocities> {
        let mut motions = Vec::new();
        while motions.len() < most && space.left() > 0 {
            let Some(v) = self.next(space) else {
                break;
            };
            motions.push(self.velocities(&v));
        }
        motions
    }

    /// Returns at most `most` motions that span these velocities. The rows of the matrix are
    /// columns of C.
    pub(super) fn among(&self, velocities: &Matrix, most: usize) -> Vec<Velocities> {
        let unit = |j: usize, i: usize| velocities[(i, j)] / self.units[j];
        let scaled = Matrix::from_fn(velocities.ncols(), velocities.nrows(), unit);
        let qr = PivotedQr::of_columns(&scaled);
        let largest = scaled.max_abs();
        let rank = qr
            .r_diagonal()
            .filter(|r| r.abs() > NEW_MOTION * largest)
            .count();
        let all = qr.q_columns(0..rank);
        self.chosen(&mut Space::new(&all), most)
    }

    /// Returns a motion of as few joints and bodies as the search finds.
    fn next(&self, space: &mut Space<'_>) -> Option<Vec<f64>> {
        let mut y = space.whole();
        if y.ncols() > 1 {
            y = self.smallest(space);
            for wish in self.wishes() {
                if y.ncols() == 1 {
                    break;
                }
                y = space.restricted(&y, &space.condition(&wish)).unwrap_or(y);
            }
        }
        space.take(&y)
    }

    /// Returns the subspace that remains after as many joints as possible, and then as many bodies
    /// as possible, are fixed. The search tries several orders and returns the best result.
    fn smallest(&self, space: &Space<'_>) -> Subspace {
        let bodies = self.mechanism.bodies();
        let groups = self.mechanism.layout().groups.len();
        let whole = space.whole();
        let work = (groups + bodies.len()) * whole.ncols() * whole.ncols();
        let trials = (TRIALS / work.max(1)).clamp(1, groups.max(1));
        let heaviest_first = {
            let mut order: Vec<usize> = (0..bodies.len()).collect();
            order.sort_by(|&a, &b| bodies[b].mass.total_cmp(&bodies[a].mass));
            order
        };
        let held = (0..groups).map(|group| space.condition(&self.held(group)));
        let held: Vec<Condition> = held.collect();
        let at_rest = (0..bodies.len()).map(|body| space.condition(&self.at_rest(body)));
        let at_rest: Vec<Condition> = at_rest.collect();
        let mut best: Option<(Cost, Subspace)> = None;
        for target in self.targets().into_iter().take(trials) {
            let mut cost = Cost::default();
            let mut y = whole.clone();
            for group in self.farthest_first(target) {
                match space.restricted(&y, &held[group]) {
                    Some(left) => y = left,
                    None => cost.joints += 1,
                }
            }
            for &body in &heaviest_first {
                match space.restricted(&y, &at_rest[body]) {
                    Some(left) => y = left,
                    None => {
                        cost.bodies += 1;
                        cost.mass += bodies[body].mass;
                    }
                }
            }
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, y));
            }
        }
        best.map_or(whole, |(_, y)| y)
    }

    /// Returns the joints at which the search for motions of few bodies begins. Joints at the ends
    /// of chains come first.
    fn targets(&self) -> Vec<usize> {
        let groups = &self.mechanism.layout().groups;
        let mut joints = vec![0_usize; self.mechanism.bodies().len()];
        let moving = |k: usize| groups[k].bodies.iter().filter_map(|b: &BodyRef| b.moving());
        for k in 0..groups.len() {
            moving(k).for_each(|b| joints[b] += 1);
        }
        let mut order: Vec<usize> = (0..groups.len()).collect();
        order.sort_by_key(|&k| moving(k).map(|b| joints[b]).min());
        order
    }

    /// Returns the joints by their distance from `target`, the farthest joint first and `target`
    /// last.
    fn farthest_first(&self, target: usize) -> Vec<usize> {
        let groups = &self.mechanism.layout().groups;
        let mut of_body = vec![Vec::new(); self.mechanism.bodies().len()];
        for (k, group) in groups.iter().enumerate() {
            let bodies = group.bodies.iter().filter_map(|b| b.moving());
            bodies.for_each(|b| of_body[b].push(k));
        }
        let mut distance = vec![usize::MAX; groups.len()];
        let mut queue = VecDeque::from([target]);
        distance[target] = 0;
        while let Some(k) = queue.pop_front() {
            let bodies = groups[k].bodies.iter().filter_map(|b| b.moving());
            for &next in bodies.flat_map(|b| &of_body[b]) {
                if distance[next] == usize::MAX {
                    distance[next] = distance[k] + 1;
                    queue.push_back(next);
                }
            }
        }
        let mut order: Vec<usize> = (0..groups.len()).collect();
        order.sort_by_key(|&k| Reverse(distance[k]));
        order
    }

    /// Returns conditions that make a motion easy to describe, the most useful condition first. The
    /// conditions are bodies that do not rotate, joints that stay at rest, rotations about one
    /// axis, centres of mass that stay at rest, and translations along one axis.
    fn wishes(&self) -> Vec<Vec<Form>> {
        let bodies = || 0..self.mechanism.bodies().len();
        let pinned = self.mechanism.layout().constraint_ids().flat_map(|id| {
            let place = self.place(id);
            let group = &self.mechanism.layout().groups[id.0];
            let bodies = group.bodies.iter().filter_map(|b| b.moving());
            bodies.map(move |b| self.point_at_rest(b, place))
        });
        let one = |column: usize| vec![vec![(column, 1.0)]];
        let space = self.mechanism.space();
        let turns = bodies().map(|b| self.turns(b).collect());
        let centres = bodies().map(|b| space.translations_of(b).flat_map(one).collect());
        let axes = bodies().flat_map(|b| space.translations_of(b).rev().map(one));
        // In the plane there is only one axis of rotation.
        let turned = bodies().filter(|_| space.n_rotations() > 1);
        let turned = turned.flat_map(|b| self.turns(b).rev().map(|form| vec![form]));
        let wishes = turns.chain(pinned).chain(turned);
        wishes.chain(centres).chain(axes).collect()
    }

    /// Returns the components of the angular velocity of a body in ground axes.
    fn turns(&self, body: usize) -> impl DoubleEndedIterator<Item = Form> + '_ {
        let space = self.mechanism.space();
        space.torques().map(move |k| {
            let parts = space
                .rotations_of(body)
                .map(|j| (j, self.axis(j)[space.axis_of(k)]));
            parts.collect()
        })
    }

    /// Returns the axis, in ground axes, about which a column of a rotation rotates its body.
    fn axis(&self, column: usize) -> [f64; 3] {
        let space = self.mechanism.space();
        let axes = self.s.bodies.axes(space.body_of(column));
        axes[space.axis_of(space.dof_of(column))]
    }

    /// Returns forms that vanish if the bodies of a joint move together. If one of the bodies is
    /// the ground, the forms vanish if the bodies are at rest.
    fn held(&self, group: usize) -> Vec<Form> {
        let place = self.place(ConstraintId(group));
        let all = &self.mechanism.layout().groups[group].bodies;
        let bodies: Vec<usize> = all.iter().filter_map(|b| b.moving()).collect();
        match bodies.as_slice() {
            // The second body of a joint with only one body is the ground.
            bodies if all.len() == 1 || bodies.len() < all.len() => {
                bodies.iter().flat_map(|&b| self.at_rest(b)).collect()
            }
            bodies => {
                let pairs = bodies.windows(2);
                pairs
                    .flat_map(|p| self.together([p[0], p[1]], place))
                    .collect()
            }
        }
    }

    /// Returns forms that vanish if a point of a body is at rest.
    fn point_at_rest(&self, body: usize, point: [f64; 3]) -> Vec<Form> {
        let space = self.mechanism.space();
        let arm = difference(point, self.origin(body));
        // The coefficients are below 1, because the point is within the size of the mechanism, and
        // rotations are scaled by this size.
        let turn = |axis: usize, j: usize| (j, self.units[j] * cross(self.axis(j), arm)[axis]);
        let form = |(axis, j): (usize, usize)| {
            let turns = space.rotations_of(body).map(|j| turn(axis, j));
            std::iter::once((j, 1.0)).chain(turns).collect()
        };
        space.translations_of(body).enumerate().map(form).collect()
    }

    /// Returns forms that vanish if two bodies move together. The motions are compared at a point.
    fn together(&self, [a, b]: [usize; 2], place: [f64; 3]) -> Vec<Form> {
        let difference = |(mut one, other): (Form, Form)| {
            one.extend(other.into_iter().map(|(j, c)| (j, -c)));
            one
        };
        let points = [a, b].map(|body| self.point_at_rest(body, place));
        let [one, other] = points;
        let mut forms: Vec<Form> = one.into_iter().zip(other).map(difference).collect();
        forms.extend(self.turns(a).zip(self.turns(b)).map(difference));
        forms
    }

    /// Returns the dimensionless motions of all bodies as one rigid body. The motions are
    /// translations, and rotations about the centre of mass of the first body.
    fn rigid(&self) -> Vec<Vec<f64>> {
        let space = self.mechanism.space();
        let bodies = self.mechanism.bodies().len();
        let centre = if bodies == 0 {
            [0.0; 3]
        } else {
            self.origin(0)
        };
        let motion = |k: usize| -> Vec<f64> {
            let moved = (0..bodies).flat_map(|body| {
                let arm = difference(self.origin(body), centre);
                space.rigid_motion(k, arm, self.s.bodies.axes(body))
            });
            moved.zip(&self.units).map(|(v, unit)| v / unit).collect()
        };
        (0..space.n_v()).map(motion).collect()
    }

    /// Returns forms that vanish if a body is at rest.
    fn at_rest(&self, body: usize) -> Vec<Form> {
        let columns = self.mechanism.space().columns_of(body);
        columns.map(|j| vec![(j, 1.0)]).collect()
    }

    /// Returns the centre of mass of a body.
    pub(super) fn origin(&self, body: usize) -> [f64; 3] {
        self.s.bodies.origin(body)
    }

    /// Returns the reference point of a joint or drive.
    pub(super) fn place(&self, id: ConstraintId) -> [f64; 3] {
        self.mechanism.reactions(&self.s).place(id)
    }

    /// Returns the rigid motions in physical units.
    pub(super) fn rigid_velocities(&self) -> Vec<Velocities> {
        self.rigid().iter().map(|v| self.velocities(v)).collect()
    }

    /// Returns velocities in physical units and ground axes. The velocities are scaled so that the
    /// largest rotation is 1, or the fastest translation if no body rotates. Rounding is set to
    /// zero.
    fn velocities(&self, v: &[f64]) -> Velocities {
        let space = self.mechanism.space();
        let mut v = v.to_vec();
        // All rotations have the same unit.
        for body in 0..self.mechanism.bodies().len() {
            let sum = |form: Form| form.iter().map(|(j, axis)| axis * v[*j]).sum();
            let turned: Vec<f64> = self.turns(body).map(sum).collect();
            v[space.rotations_of(body)].copy_from_slice(&turned);
        }
        let fastest = v.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let known = |x: f64| if x.abs() > AT_REST * fastest { x } else { 0.0 };
        let scaled = v.iter().zip(&self.units).map(|(x, unit)| known(*x) * unit);
        let scaled: Vec<f64> = scaled.collect();
        let bodies = || scaled.chunks_exact(space.n_v());
        let largest = |part: Range<usize>| {
            let sizes = bodies().map(|v| norm(&v[part.clone()]));
            sizes.fold(0.0, f64::max)
        };
        let unit = match (largest(space.torques()), largest(space.forces())) {
            (0.0, 0.0) => 1.0,
            (0.0, speed) => speed,
            (rotation, _) => rotation,
        };
        let normalised = bodies().map(|v| v.iter().map(|x| x / unit).collect());
        normalised.collect()
    }
}

/// Returns the number of independent rows in each component. The rows of all components together
/// have this rank. The largest pivots count, as in a pivoted factorisation of all rows.
pub(super) fn shared_rank(pivots: &[Vec<f64>], rank: usize) -> Vec<usize> {
    let all = pivots.iter().enumerate();
    let mut all: Vec<(f64, usize)> = all
        .flat_map(|(k, own)| own.iter().map(move |p| (*p, k)))
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut ranks = vec![0; pivots.len()];
    for (_, k) in all.into_iter().take(rank) {
        ranks[k] += 1;
    }
    ranks
}
