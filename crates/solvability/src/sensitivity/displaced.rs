//! Solves the mechanism with a displaced datum near a limit position of its bodies. Near a limit
//! position the first order is not sufficient. The smallest singular value of the kept rows
//! approaches zero with the square root of the datum, and reactions grow with the inverse of this
//! singular value. The displacements of the bodies and the changes of the velocities are as small
//! as possible. Loads are constant.

use linalg::{KeptRowSaddle, Matrix, least_squares_step};
use model::{ConstraintId, Mechanism, System};

use super::number::ReactionNumber;
use crate::limits::{FOLLOW_CORRECTIONS, FOLLOW_END, FOLLOW_FIRST, FOLLOW_JUMP, FOLLOW_STEPS};
use crate::sparse::rows_of;

/// The equations of connected bodies at one instant, with variable data.
pub(super) struct DisplacedEquations<'a> {
    pub(super) mechanism: &'a Mechanism,
    pub(super) t: f64,
    pub(super) q: &'a [f64],
    pub(super) v: Vec<f64>,
    pub(super) kept: &'a [usize],
    pub(super) mass: BodyMasses,
    pub(super) force: Vec<f64>,
    /// Velocities of one unit.
    pub(super) units: Vec<f64>,
    /// Size of the mechanism (m).
    pub(super) size: f64,
}

/// Masses of the equations.
pub(super) enum BodyMasses {
    /// The masses of the mechanism.
    OfMechanism,
    /// Equal masses, because there is no load.
    Equal(Vec<f64>),
}

impl DisplacedEquations<'_> {
    /// Returns the largest differences between numbers on the path to other data and these values.
    /// `data` returns all numbers of the constraints after a share of the displacement. The bodies
    /// follow in several steps. Returns `None` if no configuration near the previous configuration
    /// satisfies the rows.
    pub(super) fn changes(
        &self,
        numbers: &[ReactionNumber],
        values: &[f64],
        data: impl Fn(f64) -> Vec<f64>,
    ) -> Option<Vec<f64>> {
        let (mut q, mut at, mut rate) = (self.q.to_vec(), 0.0, f64::INFINITY);
        let mut changes = vec![0.0_f64; values.len()];
        // The first step is short, because it shows how fast the bodies move.
        let all = (1..=FOLLOW_STEPS).map(|k| k as f64 / FOLLOW_STEPS as f64);
        for share in std::iter::once(FOLLOW_FIRST).chain(all) {
            let displaced = self.mechanism.with_numbers(&data(share));
            let moved = self.follow(&displaced, &mut q)?;
            if moved > FOLLOW_JUMP * rate * (share - at) {
                return None;
            }
            rate = moved.max(FOLLOW_END) / (share - at);
            at = share;
            // A number is largest if the displaced mechanism is nearest to a lower rank.
            let there = self.solved(&displaced, &q, numbers)?;
            for (change, (there, value)) in changes.iter_mut().zip(there.iter().zip(values)) {
                *change = change.max((there - value).abs());
            }
        }
        Some(changes)
    }

    /// Returns these rows at the configuration of the scratch in dimensionless form.
    fn rows(&self, mechanism: &Mechanism, s: &model::Scratch, rows: &[usize]) -> Matrix {
        let c = mechanism.layout().dense(s).select_rows(rows);
        Matrix::from_fn(c.nrows(), c.ncols(), |i, j| c[(i, j)] * self.units[j])
    }

    /// Returns the smallest dimensionless x with `rows·x = −missed`, for the constraint violations
    /// `missed`.
    fn least(&self, rows: &Matrix, missed: &[f64]) -> Option<Vec<f64>> {
        let weights = vec![1.0; self.units.len()];
        let x = least_squares_step(rows, missed, &weights, f64::EPSILON).ok()?;
        x.iter().all(|x| x.is_finite()).then_some(x)
    }

    /// Moves coordinates onto the kept holonomic rows. Returns the distance in sizes of the
    /// mechanism.
    fn follow(&self, mechanism: &Mechanism, q: &mut [f64]) -> Option<f64> {
        let m = mechanism.layout().m;
        let holonomic = &self.kept[..self.kept.partition_point(|&i| i < m)];
        let mut s = mechanism.scratch();
        let mut whole = 0.0;
        for _ in 0..FOLLOW_CORRECTIONS {
            mechanism.pose(self.t, q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            let missed: Vec<f64> = holonomic.iter().map(|&i| s.phi[i]).collect();
            let x = self.least(&self.rows(mechanism, &s, holonomic), &missed)?;
            let step: Vec<f64> = x
                .iter()
                .zip(&self.units)
                .map(|(x, unit)| x * unit)
                .collect();
            mechanism.displace(q, &step);
            let length = linalg::kernels::norm(&x) / self.size;
            whole += length;
            if length <= FOLLOW_END {
                return Some(whole);
            }
        }
        None
    }

    /// Returns the values of numbers at coordinates that satisfy the kept rows.
    fn solved(
        &self,
        mechanism: &Mechanism,
        q: &[f64],
        numbers: &[ReactionNumber],
    ) -> Option<Vec<f64>> {
        let layout = mechanism.layout();
        let mut s = mechanism.scratch();
        mechanism.pose(self.t, q, &mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        let missed = self
            .kept
            .iter()
            .map(|&i| layout.velocity_residual(&s, i, &self.v));
        let missed: Vec<f64> = missed.collect();
        let x = self.least(&self.rows(mechanism, &s, self.kept), &missed)?;
        let followed = self.v.iter().zip(&x).zip(&self.units);
        let v: Vec<f64> = followed.map(|((v, x), unit)| v + x * unit).collect();
        mechanism.twist(&v, &mut s);
        mechanism.gamma(&mut s);
        let n = layout.n_v;
        let gamma: Vec<f64> = self.kept.iter().map(|&i| s.gamma[i]).collect();
        let (mut a, mut of_kept) = (vec![0.0; n], vec![0.0; self.kept.len()]);
        let rows = rows_of(mechanism, &s, self.kept.iter().copied(), |_| 1.0);
        let mut saddle = match &self.mass {
            BodyMasses::OfMechanism => KeptRowSaddle::of_rows(&rows, mechanism.inertia(&s)),
            BodyMasses::Equal(masses) => KeptRowSaddle::of_rows(&rows, masses),
        }
        .ok()?;
        saddle
            .solve(&self.force, &gamma, &mut a, &mut of_kept)
            .ok()?;
        let mut lambda = vec![0.0; layout.rows()];
        for (&i, l) in self.kept.iter().zip(of_kept) {
            lambda[i] = l;
        }
        let reactions = mechanism.reactions(&s);
        let value = |number: &ReactionNumber| -> f64 {
            let of_joint = |joint: usize| {
                let id = ConstraintId(joint);
                number.of_joint(reactions, id, &reactions.reaction(id, &lambda))
            };
            number.joints().into_iter().map(of_joint).sum()
        };
        let values: Vec<f64> = numbers.iter().map(value).collect();
        values.iter().all(|x| x.is_finite()).then_some(values)
    }
}
