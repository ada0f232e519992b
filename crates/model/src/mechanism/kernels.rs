//! The kernels of an assembled mechanism. The kernels evaluate all elements and write the results
//! to storage of the caller. Values that do not change between calls are not recomputed. Examples
//! are functions at the same time, sines and cosines of unchanged angles, constant entries of C,
//! and Γ of rows that are linear in q.

use joints::Ring;
use linalg::{AddedMass, MassMatrix};

use super::Mechanism;
use crate::element::{Bodies, Slots};
use crate::space::{self, Space, SpaceKind};
use crate::system::{ArmatureRows, KernelBuffers, Layout, Scratch, System};

impl System for Mechanism {
    fn layout(&self) -> &Layout {
        &self.layout
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn inertia<'s>(&'s self, s: &'s Scratch) -> MassMatrix<'s> {
        MassMatrix::new(&self.mass, &s.armatures.added)
    }

    fn scratch(&self) -> Scratch {
        let layout = &self.layout;
        let armatures = &self.elements.armatures;
        let mut s = Scratch {
            t: 0.0,
            bodies: Bodies::new(self.space(), self.bodies.len()),
            phi: vec![0.0; layout.m],
            entries: self.elements.entries.clone(),
            b: vec![0.0; layout.rows()],
            gamma: vec![0.0; layout.rows()],
            force: vec![0.0; layout.n_v],
            slots: Slots::new(
                self.space(),
                self.elements.n_slots,
                self.elements.given.len(),
            ),
            spins: match self.space() {
                SpaceKind::Space3 => vec![[0.0; 3]; self.bodies.len()],
                _ => Vec::new(),
            },
            jets_at: f64::NAN,
            buffers: KernelBuffers {
                block: vec![0.0; self.elements.block],
                own_rows: Vec::new(),
            },
            armatures: ArmatureRows {
                added: AddedMass::default(),
                gamma: vec![0.0; armatures.len()],
            },
        };
        for armature in armatures {
            s.armatures
                .added
                .push(armature.inertia, &armature.columns());
        }
        s.slots.commands = self.commands();
        s
    }

    fn pose(&self, t: f64, q: &[f64], s: &mut Scratch) {
        s.t = t;
        self.set_state(s, 0, q);
        let turns = || note(WorkKind::Trigonometry);
        s.bodies.take(self.space(), q, &self.held, turns);
        s.slots.take(self.elements.sites(), &s.bodies);
        if s.jets_at != t {
            s.jets_at = t;
            for (jet, given) in s.slots.jets.iter_mut().zip(&self.elements.given) {
                if let Some(f) = given.function() {
                    *jet = f.jet(t);
                    note(WorkKind::Function);
                }
            }
        }
        let known = &q[self.layout.angles()];
        self.elements.count_turns(known, &mut s.slots);
        self.take_states(&q[self.layout.angles().end..], s);
    }

    fn phi(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            if !c.rows.holonomic.is_empty() {
                c.phi(&s.slots, &mut s.phi[c.rows.holonomic.clone()]);
            }
        }
    }

    fn c(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            if c.has_varying_entries() {
                c.c(&s.slots, &mut s.entries[c.entries.clone()]);
            }
        }
        self.add_mass(s);
    }

    fn b(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            if c.depends_on_time() {
                c.rows
                    .write(&mut s.b, &mut s.buffers.own_rows, |b| c.b(&s.slots, b));
            }
        }
    }

    fn twist(&self, v: &[f64], s: &mut Scratch) {
        self.set_state(s, self.layout.n_q, v);
        s.slots.rates.take(self.elements.sites(), v);
        if self.space() == SpaceKind::Space3 {
            let bodies = v.chunks_exact(<space::Space3 as Space>::N_V);
            for (spin, v) in s.spins.iter_mut().zip(bodies) {
                spin.copy_from_slice(&v[3..]);
            }
        }
    }

    fn gamma(&self, s: &mut Scratch) {
        for c in &self.elements.constraints {
            c.rows
                .write(&mut s.gamma, &mut s.buffers.own_rows, |gamma| {
                    if c.has_gamma() {
                        c.gamma(&s.slots, gamma);
                    } else {
                        gamma.fill(0.0);
                    }
                });
        }
    }

    fn force(&self, s: &mut Scratch) {
        self.command(s);
        s.force.copy_from_slice(&self.weight);
        for (body, &omega) in s.spins.iter().enumerate() {
            let at = self.space().rotations_of(body);
            let torques = gyroscopic(self.moments(body), omega);
            for (force, torque) in s.force[at].iter_mut().zip(torques) {
                *force += torque;
            }
        }
        for force in &self.elements.forces {
            force.q(&s.slots, &mut s.buffers.block);
            for (column, value) in force.columns.iter().zip(&s.buffers.block) {
                if let Some(column) = column {
                    s.force[*column] += value;
                }
            }
        }
        self.add_mass(s);
        for (k, armature) in self.elements.armatures.iter().enumerate() {
            let gamma = armature.gamma(&s.slots);
            s.armatures.gamma[k] = gamma;
            let (inertia, columns, values) = s.armatures.added.row(k);
            for (&column, g) in columns.iter().zip(values) {
                s.force[column] += g * (inertia * gamma);
            }
        }
    }

    fn rate(&self, q: &[f64], v: &[f64], qd: &mut [f64]) {
        self.space().rate(q, v, qd);
        let (rates, states) = qd[self.layout.angles().start..].split_at_mut(self.layout.turns);
        self.elements.rate_of_angles(q, v, rates);
        states.fill(0.0);
    }

    fn displace(&self, q: &mut [f64], d: &[f64]) {
        let first = self.layout.angles().start;
        self.elements.displace_angles(first, q, d);
        self.space().displace(q, d);
        self.elements.settle_angles(first, q);
    }

    fn difference(&self, q: &[f64], from: &[f64], d: &mut [f64]) {
        self.space().difference(q, from, d);
    }
}

impl Mechanism {
    /// Computes the rows of M.
    fn add_mass(&self, s: &mut Scratch) {
        for (k, armature) in self.elements.armatures.iter().enumerate() {
            armature.gradient(&s.slots, s.armatures.added.values_mut(k));
        }
    }
}

/// Returns −ω × J·ω in principal axes, the gyroscopic term in Q.
pub(crate) fn gyroscopic<T: Ring>([jx, jy, jz]: [f64; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    [
        T::from(jy - jz) * (y * z),
        T::from(jz - jx) * (z * x),
        T::from(jx - jy) * (x * y),
    ]
}

/// Kinds of work that tests count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WorkKind {
    /// A sine and a cosine.
    Trigonometry,
    /// A function of time with its derivatives.
    Function,
}

/// Counts one evaluation of this kind, in tests of this crate only.
#[inline]
fn note(work: WorkKind) {
    #[cfg(test)]
    tests::COUNTS.with_borrow_mut(|counts| counts[work as usize] += 1);
    let _ = work;
}

#[cfg(test)]
mod tests;
