//! Derivatives along curves through a state: velocities and accelerations of the frames of all
//! bodies.

use linalg::{KeptRowSaddle, Matrix};
use model::space::{cross, norm};
use model::{Mechanism, Push, System};

use super::coordinate::{BODY, Coordinate, frame_row};
use super::error::LineariseError;
use crate::differences::{ORDER_6, ORDER_8};
use crate::limits::{
    LINEARISE_ACCURACY, LINEARISE_SHORTER, LINEARISE_STEP, STEADY_ACCELERATION, STEADY_FRACTION,
};
use crate::motion::KeptRowMotion;
use crate::prepare::PreparedMechanism;

/// Weights of the even part of a function, `(f(h) + f(−h))/2 − f(0)`, at the same distances. In the
/// weighted sum, terms of second, fourth and sixth order cancel, and the sum is 1 for `|x|`.
/// Therefore the sum detects corners. Central differences do not detect corners, because a corner
/// is even.
const CORNER: [f64; 4] = [14.0 / 5.0, -7.0 / 5.0, 2.0 / 5.0, -1.0 / 20.0];

/// Derivatives of the velocities and accelerations of all frames in ground axes, and the
/// corresponding displacement. Each list has `BODY` values for each body.
#[derive(Clone, Debug)]
pub(crate) struct Derivative {
    pub(crate) shift: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
}

/// A motion at one state, and curves through this state.
pub(crate) struct Curves<'m> {
    motion: KeptRowMotion<'m>,
    prepared: &'m PreparedMechanism,
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Matrix from velocities of the motion to velocities of all frames. The matrix has `BODY` rows
    /// for each body, and n_v columns.
    pub(crate) frames: Matrix,
    /// C at the state, all rows.
    c: Matrix,
    /// Natural rate of the mechanism (1/s), from its velocities or its accelerations.
    rate: f64,
    /// The largest acceleration of a body by a single force, without constraints, in sizes of the
    /// mechanism (1/s²).
    applied: f64,
    /// The largest derivative of an acceleration, and the largest error estimate of such a
    /// derivative. Both are dimensionless.
    largest: f64,
    doubt: f64,
}

impl<'m> Curves<'m> {
    pub(crate) fn new(
        mut motion: KeptRowMotion<'m>,
        prepared: &'m PreparedMechanism,
        (t, q, v): (f64, &[f64], &[f64]),
    ) -> Result<Self, LineariseError> {
        let mechanism = motion.mechanism();
        let mut a = vec![0.0; v.len()];
        motion.acceleration(t, q, v, &mut a)?;
        let c = mechanism.layout().dense(motion.scratch());
        let size = prepared.assembly.size;
        let space = mechanism.space();
        let largest = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, f64::max);
        let speed = largest(&mut (0..v.len()).map(|j| v[j].abs() / space.unit(j, size)));
        // Each force is evaluated separately, because the sum of balanced forces is a rounding
        // error.
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.twist(v, &mut s);
        mechanism.force(&mut s);
        let all = [mechanism.weight().to_vec(), s.force.clone()];
        let mass = mechanism.inertia(&s).full_diagonal();
        let parts = mechanism.applied_forces().parts(&mut s);
        let pushed = |force: Vec<f64>| {
            let free = (0..v.len()).filter(|&j| mass[j] > 0.0);
            let each = free.map(|j| force[j].abs() / mass[j] / space.unit(j, size));
            each.fold(0.0, f64::max)
        };
        let applied = largest(&mut all.into_iter().chain(parts.map(|(_, q)| q)).map(pushed));
        let rate = match speed.max(applied.sqrt()) {
            rate if rate > 0.0 && rate.is_finite() => rate,
            _ => 1.0,
        };
        let bodies = mechanism.bodies().len();
        let mut frames = Matrix::zeros(BODY * bodies, v.len());
        let mut one = vec![0.0; v.len()];
        for j in 0..v.len() {
            let body = space.body_of(j);
            one[j] = 1.0;
            let moved = mechanism.frames().body(body, q, &one);
            one[j] = 0.0;
            for (k, x) in moved.velocity.into_iter().chain(moved.omega).enumerate() {
                frames[(frame_row(body, k), j)] = x;
            }
        }
        Ok(Self {
            motion,
            prepared,
            t,
            q: q.to_vec(),
            v: v.to_vec(),
            a,
            frames,
            c,
            rate,
            applied,
            largest: 0.0,
            doubt: 0.0,
        })
    }

    pub(crate) fn mechanism(&self) -> &'m Mechanism {
        self.motion.mechanism()
    }

    pub(crate) fn state(&self) -> (f64, &[f64], &[f64]) {
        (self.t, &self.q, &self.v)
    }

    /// Returns the independent rows of Φ and of C.
    pub(crate) fn kept(&self) -> [&'m [usize]; 2] {
        let PreparedMechanism {
            position_decision,
            decision,
            ..
        } = self.prepared;
        [&position_decision.kept, &decision.kept]
    }

    /// Returns rows of C at the state.
    pub(crate) fn rows(&self, rows: &[usize]) -> Matrix {
        self.c.select_rows(rows)
    }

    /// Returns the squares of the units of the velocities.
    pub(crate) fn squared_units(&self) -> Vec<f64> {
        let unit = |j| self.mechanism().space().unit(j, self.size());
        (0..self.v.len()).map(|j| unit(j) * unit(j)).collect()
    }

    /// Returns the size of the mechanism (m).
    pub(crate) fn size(&self) -> f64 {
        self.prepared.assembly.size
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.v.iter().all(|v| *v == 0.0)
    }

    /// Returns the angular velocity of a body at the state.
    pub(crate) fn omega(&self, body: usize) -> [f64; 3] {
        let frames = self.mechanism().frames();
        frames.body(body, &self.q, &self.v).omega
    }

    /// Returns the largest difference between the derivatives of the two orders, as a share of the
    /// largest derivative.
    pub(crate) fn accuracy(&self) -> f64 {
        if self.largest > 0.0 {
            self.doubt / self.largest
        } else {
            0.0
        }
    }

    /// Returns the derivatives along the curve that leaves the state with the displacement `shift`
    /// and the velocity change `dv`, n_v values each.
    pub(crate) fn along(
        &mut self,
        shift: &[f64],
        dv: &[f64],
    ) -> Result<Derivative, LineariseError> {
        let bodies = self.mechanism().bodies().len();
        let moved = self.frames.times(shift);
        let Some(mut step) = self.step(shift, dv) else {
            return Ok(Derivative {
                shift: moved,
                velocity: vec![0.0; BODY * bodies],
                acceleration: vec![0.0; BODY * bodies],
            });
        };
        // Functions that are steep for this size of mechanism need shorter steps. Shorter steps do
        // not remove a corner.
        let mut found = self.differences(shift, dv, step);
        for _ in 0..LINEARISE_SHORTER {
            if found.is_ok() {
                break;
            }
            step /= 4.0;
            found = self.differences(shift, dv, step);
        }
        let mut high = found?;
        let acceleration = high.split_off(BODY * bodies);
        Ok(Derivative {
            shift: moved,
            velocity: high,
            acceleration,
        })
    }

    /// Returns differences of order eight of velocities and accelerations along a curve, if the
    /// differences are accurate derivatives.
    fn differences(
        &mut self,
        shift: &[f64],
        dv: &[f64],
        step: f64,
    ) -> Result<Vec<f64>, LineariseError> {
        let count = 2 * BODY * self.mechanism().bodies().len();
        let (mut high, mut low) = (vec![0.0; count], vec![0.0; count]);
        let mut corner = vec![0.0; count];
        let here = self.rates_at(0.0, shift, dv)?;
        for (k, w8) in ORDER_8.into_iter().enumerate() {
            let distance = (k + 1) as f64 * step;
            let ahead = self.rates_at(distance, shift, dv)?;
            let behind = self.rates_at(-distance, shift, dv)?;
            for i in 0..count {
                let d = (ahead[i] - behind[i]) / step;
                let bend = 0.5 * (ahead[i] + behind[i]) - here[i];
                high[i] += w8 * d;
                low[i] += ORDER_6[k] * d;
                corner[i] += CORNER[k] * bend / step;
            }
        }
        for (low, (high, corner)) in low.iter_mut().zip(high.iter().zip(&corner)) {
            *low = (*low - high).abs().max(corner.abs());
        }
        self.judge(&high, &low, (shift, dv))?;
        Ok(high)
    }

    /// Returns the loads of force functions at the state.
    pub(crate) fn pushes(&self) -> Vec<Push<'m>> {
        let mechanism = self.mechanism();
        let mut s = mechanism.scratch();
        mechanism.pose(self.t, &self.q, &mut s);
        mechanism.twist(&self.v, &mut s);
        mechanism.applied_forces().pushes(&mut s)
    }

    /// Returns the change of accelerations due to forces Q (n_v values) and right-hand sides Γ of
    /// the independent rows.
    pub(crate) fn pushed(&self, q: &[f64], gamma: &[f64]) -> Result<Derivative, LineariseError> {
        let [_, kept] = self.kept();
        let n = self.v.len();
        let mut a = vec![0.0; n];
        let inertia = self.mechanism().inertia_at(&self.q);
        let mut saddle = KeptRowSaddle::new(n, kept.len()).map_err(|_| LineariseError::Singular)?;
        saddle
            .factor(|k| self.c.row(kept[k]), inertia.matrix())
            .and_then(|()| saddle.motion(q, gamma, &mut a))
            .map_err(|_| LineariseError::Singular)?;
        let none = vec![0.0; self.frames.nrows()];
        Ok(Derivative {
            shift: none.clone(),
            velocity: none,
            acceleration: self.frames.times(&a),
        })
    }

    /// Returns the derivatives of the independent rows of `C·v − b`, and of the given frame
    /// velocities, along a displacement with constant v.
    pub(crate) fn missed_velocities(&self, shift: &[f64], free: &[Coordinate]) -> Vec<f64> {
        let [_, kept] = self.kept();
        let still = vec![0.0; shift.len()];
        let mut missed = vec![0.0; kept.len() + free.len()];
        let (of_rows, of_free) = missed.split_at_mut(kept.len());
        let Some(step) = self.step(shift, &still).filter(|_| !self.is_at_rest()) else {
            return missed;
        };
        let mechanism = self.mechanism();
        let mut s = mechanism.scratch();
        for (k, w) in ORDER_8.into_iter().enumerate() {
            for sign in [1.0, -1.0] {
                let distance = sign * (k + 1) as f64 * step;
                let q = mechanism.space().displaced(&self.q, distance, shift);
                mechanism.pose(self.t, &q, &mut s);
                mechanism.c(&mut s);
                mechanism.b(&mut s);
                for (missed, &i) in of_rows.iter_mut().zip(kept) {
                    let residual = mechanism.layout().velocity_residual(&s, i, &self.v);
                    *missed += sign * w * residual / step;
                }
                for (missed, c) in of_free.iter_mut().zip(free) {
                    let moved = mechanism.frames().body(c.body, &q, &self.v);
                    let velocity = [moved.velocity, moved.omega][c.direction / 3];
                    *missed += sign * w * velocity[c.direction % 3] / step;
                }
            }
        }
        missed
    }

    /// Returns the curve parameter that moves the mechanism by one step length, or `None` if the
    /// curve does not change any value.
    fn step(&self, shift: &[f64], dv: &[f64]) -> Option<f64> {
        let space = self.mechanism().space();
        let largest = |x: &[f64]| {
            let shares = x
                .iter()
                .enumerate()
                .map(|(j, x)| x.abs() / space.unit(j, self.size()));
            shares.fold(0.0, f64::max)
        };
        let way = largest(shift).max(largest(dv) / self.rate);
        (way > 0.0).then_some(LINEARISE_STEP / way)
    }

    /// Returns velocities and accelerations of all frames at a distance along a curve.
    fn rates_at(&mut self, d: f64, shift: &[f64], dv: &[f64]) -> Result<Vec<f64>, LineariseError> {
        let mechanism = self.mechanism();
        let q = mechanism.space().displaced(&self.q, d, shift);
        let v: Vec<f64> = self.v.iter().zip(dv).map(|(v, w)| v + d * w).collect();
        let mut a = vec![0.0; v.len()];
        self.motion.acceleration(self.t, &q, &v, &mut a)?;
        let mut velocities = Vec::with_capacity(2 * BODY * mechanism.bodies().len());
        let mut accelerations = Vec::new();
        for body in 0..mechanism.bodies().len() {
            let [velocity, acceleration] = frame_rates(mechanism, body, (&q, &v, &a));
            velocities.extend(velocity);
            accelerations.extend(acceleration);
        }
        velocities.append(&mut accelerations);
        Ok(velocities)
    }

    /// Compares derivatives with their error estimates.
    fn judge(
        &mut self,
        high: &[f64],
        doubts: &[f64],
        (shift, dv): (&[f64], &[f64]),
    ) -> Result<(), LineariseError> {
        let Some(step) = self.step(shift, dv) else {
            return Ok(());
        };
        // Derivatives are made dimensionless. The derivatives belong to a displacement by the size
        // of the mechanism, or by one radian.
        let way = LINEARISE_STEP / step;
        let accelerations = high.len() / 2..high.len();
        let (mut largest, mut doubt) = (self.largest, self.doubt);
        for i in accelerations {
            let unit = if i % BODY < 3 { self.size() } else { 1.0 };
            let scale = unit * way * self.rate * self.rate;
            let found = (high[i] / scale).abs();
            if !found.is_finite() {
                return Err(LineariseError::NotSmooth {
                    time: self.t,
                    body: self.name_of(i),
                });
            }
            largest = largest.max(found);
            doubt = doubt.max(doubts[i] / scale);
        }
        if doubt > LINEARISE_ACCURACY * largest.max(1.0) {
            let worst = (high.len() / 2..high.len()).fold(high.len() / 2, |a, b| {
                if doubts[b] > doubts[a] { b } else { a }
            });
            return Err(LineariseError::NotSmooth {
                time: self.t,
                body: self.name_of(worst),
            });
        }
        (self.largest, self.doubt) = (largest, doubt);
        Ok(())
    }

    fn name_of(&self, row: usize) -> String {
        let bodies = self.mechanism().bodies();
        bodies[row / BODY % bodies.len()].name.clone()
    }

    /// Checks that the state is an equilibrium, or is steady in rotating axes. Accelerations must
    /// result only from the rotation of the axes. This condition must also be satisfied along the
    /// motion.
    pub(crate) fn check_steady(&mut self, turning: [f64; 3]) -> Result<(), LineariseError> {
        let mechanism = self.mechanism();
        let (q, v, a) = (self.q.clone(), self.v.clone(), self.a.clone());
        let accelerations = |body: usize| frame_rates(mechanism, body, (&q, &v, &a))[1];
        for body in 0..mechanism.bodies().len() {
            let [velocity, _] = frame_rates(mechanism, body, (&q, &v, &a));
            let found = accelerations(body);
            let allowed = STEADY_ACCELERATION * self.applied.max(self.rate * self.rate);
            self.check_body(body, (velocity, found), turning, allowed, false)?;
        }
        if self.is_at_rest() {
            return Ok(());
        }
        // Derivatives along the motion itself.
        let along = self.along(&v, &a)?;
        for body in 0..mechanism.bodies().len() {
            let found = std::array::from_fn(|k| along.acceleration[frame_row(body, k)]);
            let allowed = STEADY_FRACTION * self.rate.powi(3);
            self.check_body(body, (accelerations(body), found), turning, allowed, true)?;
        }
        (self.largest, self.doubt) = (0.0, 0.0);
        Ok(())
    }

    /// Returns a description of the bodies that fall freely at the state, if there are any.
    fn falls(&self) -> Option<String> {
        crate::equilibrium::falling(self.prepared, self.t, &self.q)
    }

    fn check_body(
        &self,
        body: usize,
        (below, found): ([f64; BODY], [f64; BODY]),
        turning: [f64; 3],
        allowed: f64,
        changes: bool,
    ) -> Result<(), LineariseError> {
        for part in [0, 3] {
            let of = |x: [f64; BODY]| [x[part], x[part + 1], x[part + 2]];
            let turned = cross(turning, of(below));
            let own = of(found);
            let left: [f64; 3] = std::array::from_fn(|k| own[k] - turned[k]);
            let unit = if part == 0 { self.size() } else { 1.0 };
            let left = norm(&left);
            if left > allowed * unit {
                let body = self.mechanism().bodies()[body].name.clone();
                let time = self.t;
                return Err(LineariseError::NotSteady {
                    time,
                    body,
                    left,
                    unit: match (part, changes) {
                        (0, false) => "m/s²",
                        (0, true) => "m/s³",
                        (_, false) => "rad/s²",
                        (_, true) => "rad/s³",
                    },
                    moves: !self.is_at_rest(),
                    falls: self.falls(),
                });
            }
        }
        Ok(())
    }
}

/// Returns the velocity and acceleration of the frame of a body in ground axes. Each consists of
/// three translations and three rotations.
fn frame_rates(
    mechanism: &Mechanism,
    body: usize,
    (q, v, a): (&[f64], &[f64], &[f64]),
) -> [[f64; BODY]; 2] {
    let moved = mechanism.frames().with_accelerations(a).body(body, q, v);
    let join = |x: [f64; 3], y: [f64; 3]| [x[0], x[1], x[2], y[0], y[1], y[2]];
    [
        join(moved.velocity, moved.omega),
        join(moved.acceleration, moved.alpha),
    ]
}
