//! What residuals are compared with. Each row has a size of its own, made of the terms that cancel
//! in it, so that nothing depends on units, on the size of a mechanism or on where it stands.

use linalg::Scaling;

use crate::description::BodyRef;
use crate::mechanism::{Mechanism, N_BODY};
use crate::space::{Space, in_space};
use crate::system::{Scratch, System};

impl Mechanism {
    /// Size of the terms of row `i` of Φ at the pose of the scratch: `Σ |C_ij|·|q_j|`, an angle
    /// counting at least one radian, because arms turn with it, and a position at least the longest
    /// arm of its body, because it is where the arms put it. Needs C there.
    #[must_use]
    pub fn position_scale(&self, s: &Scratch, i: usize) -> f64 {
        let term = |(j, c): (usize, f64)| {
            let body = j / N_BODY;
            let pose = &s.poses[body];
            let (at, least) = match j - N_BODY * body {
                0 => (pose.x, self.reach(body)),
                1 => (pose.y, self.reach(body)),
                _ => (pose.angle, 1.0),
            };
            let at = at.abs();
            c.abs() * if at > least { at } else { least }
        };
        self.layout().row(s, i).map(term).sum()
    }

    /// What the entries of row `i` of C are at most whichever way the bodies point: column and
    /// bound. A force on a body has one size in all directions, and an arm is no longer than the
    /// body's longest one. Needs C at the pose of the scratch; allocates.
    #[must_use]
    pub fn entry_bounds(&self, s: &Scratch, i: usize) -> Vec<(usize, f64)> {
        let row: Vec<(usize, f64)> = self.layout().row(s, i).collect();
        let bodies: std::collections::BTreeSet<usize> =
            row.iter().map(|(j, _)| j / N_BODY).collect();
        let bounds = bodies.into_iter().flat_map(|body| {
            let entry = |k: usize| {
                let entries = row.iter().filter(|(j, _)| *j == N_BODY * body + k);
                entries.map(|(_, c)| c).sum::<f64>().abs()
            };
            let force = entry(0).hypot(entry(1));
            let turn = entry(2).max(force * self.reach(body));
            let first = N_BODY * body;
            [(first, force), (first + 1, force), (first + 2, turn)]
        });
        bounds.collect()
    }

    /// Size of the terms of row `i` of Φ for entries below `bounds`: as
    /// [`Mechanism::position_scale`].
    #[must_use]
    pub fn bounded_position_scale(&self, bounds: &[(usize, f64)], q: &[f64]) -> f64 {
        let term = |&(j, c): &(usize, f64)| c * self.position(q, j).abs().max(self.least(j));
        bounds.iter().map(term).sum()
    }

    /// What a coordinate counts at least.
    fn least(&self, j: usize) -> f64 {
        match j % N_BODY == 2 {
            true => 1.0,
            false => self.reach(j / N_BODY),
        }
    }

    /// Size of the terms of row `i` of `C·v − b`. Needs C and b at the pose of the scratch.
    #[must_use]
    pub fn velocity_scale(&self, s: &Scratch, i: usize, v: &[f64]) -> f64 {
        let terms = self.layout().row(s, i).map(|(j, c)| (c * v[j]).abs());
        terms.sum::<f64>() + s.b[i].abs()
    }

    /// Size of the terms of row `i` of `C·v − b` whichever way the bodies point: a row that happens
    /// to be perpendicular to the motion is known to the rounding of these, not to that of the
    /// terms it has. Needs C and b at the pose of the scratch; allocates.
    #[must_use]
    pub fn bounded_velocity_scale(&self, s: &Scratch, i: usize, v: &[f64]) -> f64 {
        let bounds = self.entry_bounds(s, i).into_iter();
        bounds.map(|(j, c)| c * v[j].abs()).sum::<f64>() + s.b[i].abs()
    }

    /// Size of the terms of row `i` of `C·v̇ − Γ` at velocities v: `|Γ_i|` and what the row makes
    /// of the centripetal terms of its bodies, `|C_ij|·(|v_j|·ω + size·ω²)` for translations and
    /// `|C_ij|·ω²` for rotations, with the largest |ω| of the row. Needs C and Γ.
    #[must_use]
    pub fn acceleration_scale(&self, s: &Scratch, i: usize, v: &[f64], size: f64) -> f64 {
        let row = || self.layout().row(s, i);
        let rotations = row().map(|(j, _)| v[j - j % N_BODY + 2].abs());
        let omega = rotations.fold(0.0, f64::max);
        let term = |(j, c): (usize, f64)| {
            let rate = if j % N_BODY == 2 {
                omega
            } else {
                v[j].abs() + size * omega
            };
            c.abs() * rate * omega
        };
        row().map(term).sum::<f64>() + s.gamma[i].abs()
    }

    /// Size of what the functions of time prescribe in row `i` at the time of the scratch: the sum
    /// of `|f| + |ḟ| + |f̈|`. A rate that is rounding beside it is zero.
    #[must_use]
    pub fn prescribed_scale(&self, s: &Scratch, i: usize) -> f64 {
        // Rows are numbered in the order of the constraints.
        let constraints = self.constraints();
        let at = constraints.partition_point(|c| c.rows.end <= i);
        let of_row = constraints.get(at);
        let jets = of_row.map_or(&[][..], |c| &s.jets[c.functions.clone()]);
        jets.iter().flatten().map(|x| x.abs()).sum()
    }

    /// What motions along column `j` of C are measured by: lengths by `size`, angles by one radian.
    #[must_use]
    pub fn unit(&self, j: usize, size: f64) -> f64 {
        if j % N_BODY == 2 { 1.0 } else { size }
    }

    /// The column of C along which two configurations differ most, and by how much: lengths as
    /// share of `size`, angles in radians.
    #[must_use]
    pub fn largest_difference(&self, a: &[f64], b: &[f64], size: f64) -> (usize, f64) {
        let mut largest = (0, 0.0);
        let mut d = [0.0; N_BODY];
        in_space!(self.space(), S => {
            let bodies = a.chunks_exact(S::N_Q).zip(b.chunks_exact(S::N_Q));
            for (body, (a, b)) in bodies.enumerate() {
                S::difference(a, b, &mut d);
                for (dof, d) in d.iter().enumerate() {
                    let j = N_BODY * body + dof;
                    let difference = d.abs() / self.unit(j, size);
                    if difference > largest.1 {
                        largest = (j, difference);
                    }
                }
            }
        });
        largest
    }

    /// Whether row `i` compares angles: no translation takes part in it.
    #[must_use]
    pub fn is_angular(&self, i: usize) -> bool {
        let pattern = &self.layout().pattern;
        let columns = &pattern.column[pattern.start[i]..pattern.start[i + 1]];
        columns.iter().all(|j| j % N_BODY == 2)
    }

    /// Scaling of the columns of a dimensionless C as bodies feel them: one unit for all lengths,
    /// and for the rotation of each body the distance of its farthest joint, where it has one.
    /// Unlike an equilibration it does not depend on the directions of joints. Needs the poses of
    /// the scratch.
    #[must_use]
    pub fn felt_scaling(&self, s: &Scratch, size: f64) -> Scaling {
        let mut arms = vec![0.0_f64; self.bodies().len()];
        for id in self.constraint_ids() {
            let [x, y] = self.place(id, s);
            for body in &self.layout().groups[id.0].bodies {
                if let BodyRef::Body(k) = *body {
                    arms[k] = arms[k].max((x - s.poses[k].x).hypot(y - s.poses[k].y));
                }
            }
        }
        let layout = self.layout();
        let mut scaling = Scaling::identity(layout.rows(), layout.n_v);
        for (body, arm) in arms.into_iter().enumerate().filter(|(_, arm)| *arm > 0.0) {
            let exponent = (size / arm).log2().round();
            if exponent.is_finite() {
                scaling.cols[N_BODY * body + 2] = exponent as i32;
            }
        }
        scaling
    }

    /// The scaling that makes C dimensionless for a mechanism of this size: columns of rotations
    /// divided by the size, rounded to a power of two. Ranks, dependencies and verdicts of the
    /// scaled C are those of C; margins do not depend on units.
    #[must_use]
    pub fn dimension_scaling(&self, size: f64) -> Scaling {
        let exponent = size.log2().round();
        let layout = self.layout();
        let mut scaling = Scaling::identity(layout.rows(), layout.n_v);
        if exponent.is_finite() {
            for e in scaling.cols.iter_mut().skip(2).step_by(N_BODY) {
                *e = -(exponent as i32);
            }
        }
        scaling
    }

    /// What the entries of a dimensionless C may be wrong by at a configuration: the largest |Φ_i|,
    /// and at least the rounding of its terms, relative to what row `i` changes by when the
    /// mechanism moves by its own size. Needs Φ and C.
    #[must_use]
    pub fn relative_residual(&self, s: &Scratch, size: f64) -> f64 {
        let layout = self.layout();
        let of_row = |i: usize| {
            let rounding = f64::EPSILON * self.position_scale(s, i);
            self.relative_to_reach(s, i, size, s.phi[i].abs().max(rounding))
        };
        (0..layout.m).map(of_row).fold(0.0, f64::max)
    }

    /// How far the constraints are open: the largest |Φ_i| relative to what row `i` changes by when
    /// the mechanism moves by its own size. Needs Φ and C.
    #[must_use]
    pub fn relative_opening(&self, s: &Scratch, size: f64) -> f64 {
        (0..self.layout().m)
            .map(|i| self.relative_to_reach(s, i, size, s.phi[i].abs()))
            .fold(0.0, f64::max)
    }

    /// `x` relative to what row `i` changes by when the mechanism moves by its own size. Needs C.
    #[must_use]
    pub fn relative_to_reach(&self, s: &Scratch, i: usize, size: f64, x: f64) -> f64 {
        let reach = |(j, c): (usize, f64)| c.abs() * if j % N_BODY == 2 { 1.0 } else { size };
        let reach: f64 = self.layout().row(s, i).map(reach).sum();
        if reach > 0.0 { x / reach } else { x }
    }
}
