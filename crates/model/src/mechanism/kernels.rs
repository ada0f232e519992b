//! The kernels of an assembled mechanism: they evaluate all elements, in storage of the caller.
//! Values that do not change between calls are not computed again: functions at the same time,
//! sines and cosines of unchanged angles, constant entries of C, and Γ of rows that are linear in
//! q.

use joints::{Pose, Twist};

use super::Mechanism;
use crate::space::{PlanarSpace, Space, in_space};
use crate::system::{Layout, Scratch, Slots, System, pose_of};

/// Largest change by rounding of an angle that is held constant.
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
            entries: self.elements.entries.clone(),
            b: vec![0.0; layout.rows()],
            gamma: vec![0.0; layout.rows()],
            force: vec![0.0; layout.n_v],
            slots: Slots {
                poses: vec![Pose::GROUND; self.elements.n_slots],
                twists: vec![Twist::zero(); self.elements.n_slots],
                jets: vec![[0.0; 3]; self.elements.functions.len()],
            },
            jets_at: f64::NAN,
            block: vec![0.0; self.elements.block],
        }
    }

    fn pose(&self, t: f64, q: &[f64], s: &mut Scratch) {
        s.t = t;
        in_space!(self.space(), S => {
            for (k, (pose, q)) in s.poses.iter_mut().zip(q.chunks_exact(S::N_Q)).enumerate() {
                (pose.x, pose.y, pose.angle) = (q[0], q[1], S::angle(q));
                if !stays(self.held[k], s.turned_to[k], pose.angle) {
                    s.turned_to[k] = pose.angle;
                    (pose.sin, pose.cos) = S::sin_cos(q);
                    note(Counted::Trigonometry);
                }
            }
        });
        for site in self.elements.sites() {
            let slots = &mut s.slots.poses[site.slots.clone()];
            for (pose, &body) in slots.iter_mut().zip(&site.bodies) {
                *pose = pose_of(&s.poses, body);
            }
        }
        if s.jets_at != t {
            s.jets_at = t;
            for (jet, f) in s.slots.jets.iter_mut().zip(&self.elements.functions) {
                *jet = f.jet(t);
                note(Counted::Function);
            }
        }
    }

    fn phi(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            if c.rows.start < self.layout.m {
                let (x, f) = (c.site.x(&s.slots), c.site.f(&s.slots));
                c.element.phi(x, f, &mut s.phi[c.rows.clone()]);
            }
        }
    }

    fn c(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            if c.has_varying_entries() {
                let (x, f) = (c.site.x(&s.slots), c.site.f(&s.slots));
                c.element.c(x, f, &mut s.entries[c.entries.clone()]);
            }
        }
    }

    fn b(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            let element = &c.element;
            if c.depends_on_time() {
                let (x, f) = (c.site.x(&s.slots), c.site.f(&s.slots));
                element.b(x, f, &mut s.b[c.rows.clone()]);
            }
        }
    }

    fn twist(&self, v: &[f64], s: &mut Scratch) {
        self.elements.spread(v, &mut s.slots.twists);
    }

    fn gamma(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            if !c.has_gamma() {
                s.gamma[c.rows.clone()].fill(0.0);
                continue;
            }
            let (x, v, f) = c.site.xvf(&s.slots);
            c.element.gamma(x, v, f, &mut s.gamma[c.rows.clone()]);
        }
    }

    fn force(&self, s: &mut Scratch) {
        s.force.copy_from_slice(&self.weight);
        for force in &self.elements.forces {
            let (x, v, f) = force.site.xvf(&s.slots);
            force.element.q(x, v, f, &mut s.block);
            for (column, value) in force.columns.iter().zip(&s.block) {
                if let Some(column) = column {
                    s.force[*column] += value;
                }
            }
        }
    }

    fn rate(&self, q: &[f64], v: &[f64], qd: &mut [f64]) {
        in_space!(self.space(), S => {
            let bodies = q.chunks_exact(S::N_Q).zip(v.chunks_exact(S::N_V));
            for ((q, v), qd) in bodies.zip(qd.chunks_exact_mut(S::N_Q)) {
                S::rate(q, v, qd);
            }
        });
    }

    fn displace(&self, q: &mut [f64], d: &[f64]) {
        self.space().displace(q, d);
    }

    fn difference(&self, q: &[f64], from: &[f64], d: &mut [f64]) {
        self.space().difference(q, from, d);
    }
}

/// Whether a body keeps its sine and cosine when its angle changes. If rows of angles hold the
/// angle, a change by rounding is not a rotation; otherwise every bit counts: the sine of −0 is not
/// that of 0.
fn stays(is_held: bool, from: f64, to: f64) -> bool {
    if is_held {
        (to - from).abs() <= HELD * from.abs().max(1.0)
    } else {
        to.to_bits() == from.to_bits()
    }
}

/// Kinds of work that tests count.
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
