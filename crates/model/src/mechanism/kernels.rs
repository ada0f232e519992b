//! The kernels of an assembled mechanism: every element in turn, on the caller's storage. What does
//! not change from one call to the next is not computed again: functions at the time of the last
//! call, sines and cosines of angles that have stayed, entries of C that are constant, Γ of rows
//! that are linear in q.

use std::ops::Range;

use joints::{Pose, Twist};

use super::{Mechanism, N_BODY, pose_of};
use crate::description::BodyRef;
use crate::space::{Space, in_space};
use crate::system::{Layout, Scratch, System};

/// What rounding moves an angle by that is held.
const HELD: f64 = 4.0 * f64::EPSILON;

impl System for Mechanism {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn scratch(&self) -> Scratch {
        let layout = &self.layout;
        Scratch {
            t: 0.0,
            poses: vec![Pose::GROUND; self.bodies.len()],
            turned_to: vec![f64::NAN; self.bodies.len()],
            phi: vec![0.0; layout.m],
            entries: self.entries.clone(),
            b: vec![0.0; layout.rows()],
            gamma: vec![0.0; layout.rows()],
            force: vec![0.0; layout.n_v],
            slot_poses: vec![Pose::GROUND; self.n_slots],
            slot_twists: vec![Twist::zero(); self.n_slots],
            jets: vec![[0.0; 3]; self.functions.len()],
            jets_at: f64::NAN,
            block: vec![0.0; self.block],
        }
    }

    fn pose(&self, t: f64, q: &[f64], s: &mut Scratch) {
        s.t = t;
        in_space!(self.space, S => {
            for (k, (pose, q)) in s.poses.iter_mut().zip(q.chunks_exact(S::N_Q)).enumerate() {
                (pose.x, pose.y, pose.angle) = (q[0], q[1], S::angle(q));
                if !self.stays(k, s.turned_to[k], pose.angle) {
                    s.turned_to[k] = pose.angle;
                    (pose.sin, pose.cos) = S::sin_cos(q);
                    note(Counted::Trigonometry);
                }
            }
        });
        let (poses, slot_poses) = (&s.poses, &mut s.slot_poses);
        for (slots, bodies) in self.places() {
            for (pose, &body) in slot_poses[slots].iter_mut().zip(bodies) {
                *pose = pose_of(poses, body);
            }
        }
        if s.jets_at != t {
            s.jets_at = t;
            for (jet, f) in s.jets.iter_mut().zip(&self.functions) {
                *jet = f.jet(t);
                note(Counted::Function);
            }
        }
    }

    fn phi(&self, s: &mut Scratch) {
        for c in &self.constraints {
            if c.rows.start < self.layout.m {
                let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
                c.element.element().phi(x, f, &mut s.phi[c.rows.clone()]);
            }
        }
    }

    fn c(&self, s: &mut Scratch) {
        for c in &self.constraints {
            if c.has_varying_entries() {
                let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
                c.element
                    .element()
                    .c(x, f, &mut s.entries[c.entries.clone()]);
            }
        }
    }

    fn b(&self, s: &mut Scratch) {
        for c in &self.constraints {
            let element = c.element.element();
            if c.depends_on_time() {
                let (x, f) = (&s.slot_poses[c.slots.clone()], &s.jets[c.functions.clone()]);
                element.b(x, f, &mut s.b[c.rows.clone()]);
            }
        }
    }

    fn twist(&self, v: &[f64], s: &mut Scratch) {
        self.spread(v, &mut s.slot_twists);
    }

    fn gamma(&self, s: &mut Scratch) {
        for c in &self.constraints {
            if !c.has_gamma() {
                s.gamma[c.rows.clone()].fill(0.0);
                continue;
            }
            let (x, v) = (
                &s.slot_poses[c.slots.clone()],
                &s.slot_twists[c.slots.clone()],
            );
            let f = &s.jets[c.functions.clone()];
            c.element
                .element()
                .gamma(x, v, f, &mut s.gamma[c.rows.clone()]);
        }
    }

    fn force(&self, s: &mut Scratch) {
        s.force.copy_from_slice(&self.weight);
        for force in &self.forces {
            let (x, v) = (
                &s.slot_poses[force.slots.clone()],
                &s.slot_twists[force.slots.clone()],
            );
            let f = &s.jets[force.functions.clone()];
            force.element.element().q(x, v, f, &mut s.block);
            for (column, value) in force.columns.iter().zip(&s.block) {
                if let Some(column) = column {
                    s.force[*column] += value;
                }
            }
        }
    }

    fn rate(&self, q: &[f64], v: &[f64], qd: &mut [f64]) {
        in_space!(self.space, S => {
            let bodies = q.chunks_exact(S::N_Q).zip(v.chunks_exact(N_BODY));
            for ((q, v), qd) in bodies.zip(qd.chunks_exact_mut(S::N_Q)) {
                S::rate(q, v, qd);
            }
        });
    }

    fn displace(&self, q: &mut [f64], d: &[f64]) {
        self.displace_number(q, d);
    }

    fn difference(&self, q: &[f64], from: &[f64], d: &mut [f64]) {
        in_space!(self.space, S => {
            let bodies = q.chunks_exact(S::N_Q).zip(from.chunks_exact(S::N_Q));
            for ((q, from), d) in bodies.zip(d.chunks_exact_mut(N_BODY)) {
                S::difference(q, from, d);
            }
        });
    }
}

impl Mechanism {
    /// The first force whose law has no finite value at the pose and the twist of the scratch.
    #[must_use]
    pub fn undefined_force(&self, s: &mut Scratch) -> Option<&str> {
        let undefined = self.forces.iter().find(|force| {
            let (x, v) = (
                &s.slot_poses[force.slots.clone()],
                &s.slot_twists[force.slots.clone()],
            );
            let f = &s.jets[force.functions.clone()];
            force.element.element().q(x, v, f, &mut s.block);
            let mut values = s.block[..force.columns.len()].iter();
            values.any(|value| !value.is_finite())
        });
        undefined.map(|force| force.name.as_str())
    }

    /// Whether a body has the sine and cosine at an angle that it had at another one. Where rows of
    /// angles hold it, rounding may move the angle, but does not turn it; elsewhere bits count: the
    /// sine of −0 is not that of 0.
    fn stays(&self, body: usize, from: f64, to: f64) -> bool {
        match self.held[body] {
            true => (to - from).abs() <= HELD * from.abs().max(1.0),
            false => to.to_bits() == from.to_bits(),
        }
    }

    /// Writes velocities or accelerations of the bodies to the slots; those of the ground stay
    /// zero.
    pub(super) fn spread(&self, v: &[f64], slot_twists: &mut [Twist]) {
        for (slots, bodies) in self.places() {
            for (twist, &body) in slot_twists[slots].iter_mut().zip(bodies) {
                if let BodyRef::Body(k) = body {
                    let v = &v[N_BODY * k..];
                    *twist = Twist {
                        x: v[0],
                        y: v[1],
                        omega: v[2],
                    };
                }
            }
        }
    }

    /// Slots and bodies of all constraints and forces.
    pub(super) fn places(&self) -> impl Iterator<Item = (Range<usize>, &[BodyRef])> {
        let constraints = self
            .constraints
            .iter()
            .map(|c| (c.slots.clone(), c.bodies.as_slice()));
        let forces = self
            .forces
            .iter()
            .map(|f| (f.slots.clone(), f.bodies.as_slice()));
        constraints.chain(forces)
    }
}

/// What tests count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// A sine and a cosine.
    Trigonometry,
    /// A function of time with its derivatives.
    Function,
}

/// Counts one piece of work, in tests of this crate only.
#[inline]
fn note(work: Counted) {
    #[cfg(test)]
    tests::COUNTS.with_borrow_mut(|counts| counts[work as usize] += 1);
    let _ = work;
}

#[cfg(test)]
mod tests;
