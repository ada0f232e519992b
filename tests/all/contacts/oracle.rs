//! Loads of contacts by enumeration in rational arithmetic, from equilibrium equations that are
//! written down here.
//!
//! A contact k with multiplier t_k pushes its second body with the force t_k·n_k and its first body
//! with the opposite force, so that `Σ t_k·w_k + f = 0` for the wrenches w_k of unit multipliers
//! and the load f. The permitted t form a polyhedron. With one more coordinate s it is the cone `Σ
//! t_k·w_k + f·s = 0`, `t_k ≥ 0` for one-sided contacts, `s ≥ 0`. The cone consists of lines and of
//! rays; vertices are the rays with s > 0.

use super::fractions::{Fraction, Row, dot, kernel, sets};

pub(super) type Vector = [i128; 3];

/// A contact between two bodies, or a body and the ground.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    /// The bodies; the contact pushes the second one along the normal.
    pub(super) bodies: [Option<usize>; 2],
    pub(super) at: Vector,
    pub(super) normal: Vector,
    pub(super) is_one_sided: bool,
}

impl Contact {
    /// Length of the normal: the force for a multiplier of 1.
    pub(super) fn length(&self) -> f64 {
        let squares = self.normal.map(|x| x * x);
        (squares.iter().sum::<i128>() as f64).sqrt()
    }
}

/// Bodies under loads in balance with forces of their contacts.
#[derive(Clone, Debug)]
pub(super) struct Bodies {
    /// Positions of the mass centres.
    pub(super) centres: Vec<Vector>,
    pub(super) contacts: Vec<Contact>,
    /// Force and moment about the mass centre of each body.
    pub(super) loads: Vec<[Vector; 2]>,
}

pub(super) const MASS: i128 = 2;
/// Principal moments of inertia.
pub(super) const INERTIA: Vector = [1, 2, 3];

fn cross(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

/// Ends of a range; `None` if the number changes without limit.
pub(super) type Ends = [Option<Fraction>; 2];

/// The permitted multipliers.
pub(super) struct Permitted {
    lines: Vec<Row>,
    rays: Vec<Row>,
}

impl Bodies {
    /// Returns the wrench of a unit multiplier on all bodies: three forces and three moments each.
    pub(super) fn wrench(&self, contact: &Contact) -> Row {
        let mut wrench = vec![Fraction::ZERO; 6 * self.centres.len()];
        for (body, sign) in contact.bodies.iter().zip([-1, 1]) {
            let Some(body) = *body else { continue };
            let centre = self.centres[body];
            let arm = [0, 1, 2].map(|k| contact.at[k] - centre[k]);
            let force = contact.normal.map(|x| sign * x);
            for (k, x) in force.into_iter().chain(cross(arm, force)).enumerate() {
                wrench[6 * body + k] = x.into();
            }
        }
        wrench
    }

    /// Returns the load on all bodies.
    pub(super) fn load(&self) -> Row {
        let all = self.loads.iter().flatten().flatten();
        all.map(|x| Fraction::from(*x)).collect()
    }

    /// Sets the loads that balance these multipliers.
    pub(super) fn balance(&mut self, multipliers: &[i128]) {
        let mut sums = vec![Fraction::ZERO; 6 * self.centres.len()];
        for (contact, t) in self.contacts.iter().zip(multipliers) {
            for (sum, x) in sums.iter_mut().zip(self.wrench(contact)) {
                *sum = *sum - x * (*t).into();
            }
        }
        let whole = |x: &Fraction| x.to_f64() as i128;
        let three = |part: &[Fraction]| std::array::from_fn(|k| whole(&part[k]));
        let bodies = sums.chunks(6);
        self.loads = bodies
            .map(|own| [three(&own[..3]), three(&own[3..])])
            .collect();
    }

    /// Returns the equations of equilibrium for the multipliers and s.
    pub(super) fn equations(&self) -> Vec<Row> {
        let wrenches: Vec<Row> = self.contacts.iter().map(|c| self.wrench(c)).collect();
        let load = self.load();
        let equation = |i: usize| {
            let own = wrenches.iter().map(|w| w[i]);
            own.chain([load[i]]).collect()
        };
        (0..load.len()).map(equation).collect()
    }

    /// Enumerates the permitted multipliers.
    pub(super) fn permitted(&self) -> Permitted {
        let n = self.contacts.len();
        let unit = |k: usize| -> Row {
            (0..=n)
                .map(|i| Fraction::from(i128::from(i == k)))
                .collect()
        };
        let sided = (0..n).filter(|k| self.contacts[*k].is_one_sided);
        let limits: Vec<Row> = sided.chain([n]).map(unit).collect();
        let equations = self.equations();
        let space = kernel(&equations.iter().collect::<Vec<_>>(), n + 1).len();
        let fixed: Vec<&Row> = equations.iter().chain(&limits).collect();
        let lines = kernel(&fixed, n + 1);
        let mut rays = Vec::new();
        // A ray is on all but one of the dimensions that the lines leave.
        let Some(tight) = (space - lines.len()).checked_sub(1) else {
            return Permitted { lines, rays };
        };
        for set in sets(limits.len(), tight) {
            let rows: Vec<&Row> = equations
                .iter()
                .chain(set.iter().map(|k| &limits[*k]))
                .chain(&lines)
                .collect();
            let [ray] = &kernel(&rows, n + 1)[..] else {
                continue;
            };
            for sign in [1, -1] {
                let ray: Row = ray.iter().map(|x| *x * sign.into()).collect();
                if limits.iter().all(|limit| dot(limit, &ray).signum() >= 0) {
                    rays.push(ray);
                }
            }
        }
        Permitted { lines, rays }
    }

    /// Returns the accelerations of Gauss' principle: the contacts of a set stay closed and push,
    /// the gaps of all others do not close. `None` if no set is found.
    pub(super) fn accelerations(&self) -> Option<Vec<Fraction>> {
        let wrenches: Vec<Row> = self.contacts.iter().map(|c| self.wrench(c)).collect();
        let load = self.load();
        let mobility = |i: usize| match i % 6 {
            k @ 0..3 => (k, Fraction::new(1, MASS)),
            k => (k, Fraction::new(1, INERTIA[k - 3])),
        };
        let lighter = |x: &Row| -> Row {
            x.iter()
                .enumerate()
                .map(|(i, x)| *x * mobility(i).1)
                .collect()
        };
        let free = lighter(&load);
        let light: Vec<Row> = wrenches.iter().map(lighter).collect();
        let is_independent = |set: &[usize]| {
            let rows: Vec<&Row> = set.iter().map(|k| &wrenches[*k]).collect();
            kernel(&rows, load.len()).len() + set.len() == load.len()
        };
        // Independent two-sided contacts.
        let mut two_sided: Vec<usize> = Vec::new();
        let n = self.contacts.len();
        for k in (0..n).filter(|k| !self.contacts[*k].is_one_sided) {
            two_sided.push(k);
            if !is_independent(&two_sided) {
                two_sided.pop();
            }
        }
        let sided: Vec<usize> = (0..n).filter(|k| self.contacts[*k].is_one_sided).collect();
        for count in 0..=sided.len() {
            for set in sets(sided.len(), count) {
                let mut closed = two_sided.clone();
                closed.extend(set.iter().map(|k| sided[*k]));
                if !is_independent(&closed) {
                    continue;
                }
                // W·M⁻¹·Wᵀ·t + W·M⁻¹·f = 0
                let row = |i: &usize| -> Row {
                    let own = closed.iter().map(|j| dot(&wrenches[*i], &light[*j]));
                    own.chain([dot(&wrenches[*i], &free)]).collect()
                };
                let rows: Vec<Row> = closed.iter().map(row).collect();
                let solution = kernel(&rows.iter().collect::<Vec<_>>(), closed.len() + 1);
                let [solution] = &solution[..] else { continue };
                let scale = solution[closed.len()].inverse();
                let forces: Vec<Fraction> = solution.iter().map(|x| *x * scale).collect();
                let mut all = free.clone();
                for (t, k) in forces.iter().zip(&closed) {
                    all.iter_mut()
                        .zip(&light[*k])
                        .for_each(|(a, x)| *a = *a + *t * *x);
                }
                let pushes = closed.iter().zip(&forces);
                let mut pushes = pushes.filter(|(k, _)| self.contacts[**k].is_one_sided);
                let is_open = |k: &usize| dot(&wrenches[*k], &all).signum() >= 0;
                if pushes.all(|(_, t)| t.signum() >= 0) && sided.iter().all(is_open) {
                    return Some(all);
                }
            }
        }
        None
    }
}

impl Permitted {
    /// Returns the range of a sum of multipliers; `None` if no multipliers are permitted.
    pub(super) fn range(&self, form: &[Fraction]) -> Option<Ends> {
        let n = form.len();
        let mut ends: Ends = [None; 2];
        for ray in self.rays.iter().filter(|ray| ray[n].signum() > 0) {
            let value = dot(form, &ray[..n]) * ray[n].inverse();
            for (end, sign) in ends.iter_mut().zip([1, -1]) {
                let is_further = |end: Fraction| (end - value).signum() * sign > 0;
                if end.is_none_or(is_further) {
                    *end = Some(value);
                }
            }
        }
        ends[0]?;
        for ray in self.rays.iter().filter(|ray| ray[n].signum() == 0) {
            match dot(form, &ray[..n]).signum() {
                0 => {}
                sign => ends[usize::from(sign > 0)] = None,
            }
        }
        if self
            .lines
            .iter()
            .any(|line| dot(form, &line[..n]).signum() != 0)
        {
            ends = [None; 2];
        }
        Some(ends)
    }
}
