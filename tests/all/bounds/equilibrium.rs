//! Equilibrium of bodies under gravity, and the loads for given compliances. The equations follow
//! from the places and directions of unit loads, in double-double arithmetic.

use linalg::Dd;

/// Pivots of the equations up to this size are zero; lengths are about 1.
const ZERO_PIVOT: f64 = 1e-11;

/// Parts whose equations have a pivot between [`ZERO_PIVOT`] and this size are not drawn: their
/// rank is a matter of accuracy.
const CLEAR_PIVOT: f64 = 1e-3;

pub(super) type Vector = [f64; 3];

/// Mass of each body (kg).
pub(super) const MASS: f64 = 2.0;

/// Principal moments of inertia of each body (kg·m²).
pub(super) const INERTIA: Vector = [1.0, 2.0, 1.5];

/// A unit load on the first body of a joint, and the opposite load on the second body.
pub(super) struct Unit {
    pub(super) bodies: [Option<usize>; 2],
    pub(super) at: Vector,
    pub(super) axis: Vector,
    pub(super) is_moment: bool,
    /// The load to which it belongs.
    pub(super) load: usize,
}

/// Reduced row echelon form of equations with some right-hand sides.
struct Reduced {
    rows: Vec<Vec<Dd>>,
    /// The column of the pivot of each row.
    pivots: Vec<usize>,
    columns: usize,
}

impl Reduced {
    /// Reduces the equations; further columns are right-hand sides. Returns `None` if a pivot is
    /// small but not zero.
    fn of(mut rows: Vec<Vec<Dd>>, columns: usize) -> Option<Self> {
        let mut pivots = Vec::new();
        loop {
            let step = pivots.len();
            let places = (step..rows.len()).flat_map(|i| (0..columns).map(move |j| (i, j)));
            let size = |&(i, j): &(usize, usize)| rows[i][j].abs().to_f64();
            let largest = places.max_by(|a, b| size(a).total_cmp(&size(b)));
            let largest = largest.filter(|place| size(place) > ZERO_PIVOT);
            let Some((i, j)) = largest else {
                rows.truncate(step);
                for x in rows.iter_mut().flatten() {
                    if x.abs().to_f64() <= ZERO_PIVOT {
                        *x = Dd::ZERO;
                    }
                }
                return Some(Self {
                    rows,
                    pivots,
                    columns,
                });
            };
            if size(&(i, j)) < CLEAR_PIVOT {
                return None;
            }
            rows.swap(step, i);
            pivots.push(j);
            let pivot = rows[step][j];
            rows[step].iter_mut().for_each(|x| *x = *x / pivot);
            let own = rows[step].clone();
            for (k, row) in rows.iter_mut().enumerate() {
                let factor = row[j];
                if k != step && factor != Dd::ZERO {
                    row.iter_mut()
                        .zip(&own)
                        .for_each(|(x, own)| *x -= factor * *own);
                }
            }
        }
    }

    /// Returns a solution for the first right-hand side.
    fn solution(&self) -> Vec<Dd> {
        let mut x = vec![Dd::ZERO; self.columns];
        for (row, &j) in self.rows.iter().zip(&self.pivots) {
            x[j] = row[self.columns];
        }
        x
    }

    /// Returns a basis of the solutions with zero right-hand sides.
    fn null_basis(&self) -> Vec<Vec<Dd>> {
        let free = (0..self.columns).filter(|j| !self.pivots.contains(j));
        let vector = |free: usize| {
            let mut x = vec![Dd::ZERO; self.columns];
            x[free] = Dd::ONE;
            for (row, &j) in self.rows.iter().zip(&self.pivots) {
                x[j] = -row[free];
            }
            x
        };
        free.map(vector).collect()
    }
}

/// All loads in equilibrium: fixed ones and any multiples of the self-stresses.
pub(super) struct Loads {
    of_load: Vec<usize>,
    fixed: Vec<Dd>,
    stresses: Vec<Vec<Dd>>,
}

impl Loads {
    /// Returns the loads for any compliances; `None` if the rank is a matter of accuracy.
    ///
    /// Units in columns and forces and moments on each body in rows give G, and the loads s satisfy
    /// `G·s = M·v̇ − Q` with the acceleration `v̇ = N·(Nᵀ·M·N)⁻¹·Nᵀ·Q` of the free motions N.
    pub(super) fn of(units: &[Unit], bodies: &[Vector], gravity: Vector) -> Option<Self> {
        let n = 6 * bodies.len();
        let zero = vec![Dd::ZERO; units.len()];
        let mut g = vec![zero; n];
        for (j, unit) in units.iter().enumerate() {
            for (body, sign) in unit.bodies.iter().zip([1.0, -1.0]) {
                let Some(body) = *body else { continue };
                let arm = [0, 1, 2].map(|k| Dd::from(unit.at[k]) - Dd::from(bodies[body][k]));
                let axis = unit.axis.map(|x| Dd::from(sign * x));
                for k in 0..3 {
                    if unit.is_moment {
                        g[6 * body + 3 + k][j] = axis[k];
                    } else {
                        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                        g[6 * body + k][j] = axis[k];
                        g[6 * body + 3 + k][j] = arm[a] * axis[b] - arm[b] * axis[a];
                    }
                }
            }
        }
        let mass = |i: usize| if i % 6 < 3 { MASS } else { INERTIA[i % 6 - 3] };
        let force = |i: usize| {
            if i % 6 < 3 {
                MASS * gravity[i % 6]
            } else {
                0.0
            }
        };
        let transposed: Vec<Vec<Dd>> = (0..units.len())
            .map(|j| g.iter().map(|row| row[j]).collect())
            .collect();
        let free = Reduced::of(transposed, n)?.null_basis();
        let product = |a: &[Dd], b: &dyn Fn(usize) -> Dd| -> Dd {
            (0..n).fold(Dd::ZERO, |sum, i| sum + a[i] * b(i))
        };
        let normal = free.iter().map(|a| {
            let of = |b: &Vec<Dd>| product(a, &|i| b[i] * mass(i));
            let right = product(a, &|i| Dd::from(force(i)));
            free.iter().map(of).chain([right]).collect()
        });
        let speeds = Reduced::of(normal.collect(), free.len())?.solution();
        let right = |i: usize| {
            let along = free.iter().zip(&speeds);
            let acceleration = along.fold(Dd::ZERO, |sum, (v, x)| sum + v[i] * *x);
            acceleration * mass(i) - Dd::from(force(i))
        };
        for (i, row) in g.iter_mut().enumerate() {
            row.push(right(i));
        }
        let reduced = Reduced::of(g, units.len())?;
        Some(Self {
            of_load: units.iter().map(|unit| unit.load).collect(),
            fixed: reduced.solution(),
            stresses: reduced.null_basis(),
        })
    }

    /// Returns the number of undetermined load components.
    pub(super) fn free(&self) -> usize {
        self.stresses.len()
    }

    /// Returns the unit loads s with the smallest `Σ c·s²` in equilibrium, for one compliance of
    /// each load.
    ///
    /// The coordinates y are the two softest unit loads that can be zero together, and
    /// `s = s₀ + Z·y` with `Zᵀ·D·Z·y = −Zᵀ·D·s₀`. The softest coordinates keep the matrix
    /// well-conditioned after scaling, whatever the compliances.
    pub(super) fn shared(&self, compliances: &[f64]) -> Vec<f64> {
        let c = |k: usize| compliances[self.of_load[k]];
        let [u, v] = [0, 1].map(|k| self.stresses[k].as_slice());
        let clean = |x: Dd| {
            if x.abs().to_f64() > ZERO_PIVOT {
                x
            } else {
                Dd::ZERO
            }
        };
        let minor = |i: usize, j: usize| clean(u[i] * v[j] - u[j] * v[i]);
        let mut order: Vec<usize> = (0..u.len()).collect();
        order.sort_by(|&i, &j| c(j).total_cmp(&c(i)));
        let mut pairs = order
            .iter()
            .flat_map(|&i| order.iter().map(move |&j| [i, j]));
        let pair = pairs.find(|&[i, j]| minor(i, j) != Dd::ZERO);
        let [first, second] = pair.expect("two self-stresses");
        let det = minor(first, second);
        let each = (0..u.len()).map(|k| {
            let z = [minor(k, second) / det, minor(first, k) / det];
            let fixed = self.fixed[k] - z[0] * self.fixed[first] - z[1] * self.fixed[second];
            (
                c(k),
                z,
                if k == first || k == second {
                    Dd::ZERO
                } else {
                    fixed
                },
            )
        });
        let each: Vec<(f64, [Dd; 2], Dd)> = each.collect();
        let sum = |of: &dyn Fn(&[Dd; 2], Dd) -> Dd| {
            each.iter()
                .fold(Dd::ZERO, |sum, (c, z, fixed)| sum + of(z, *fixed) * *c)
        };
        let [aa, bb] = [0, 1].map(|i| sum(&|z, _| z[i] * z[i]));
        let ab = sum(&|z, _| z[0] * z[1]);
        let [a, b] = [0, 1].map(|i| -sum(&|z, fixed| z[i] * fixed));
        let det = aa * bb - ab * ab;
        let y = [(a * bb - b * ab) / det, (b * aa - a * ab) / det];
        each.iter()
            .map(|(_, z, fixed)| (*fixed + z[0] * y[0] + z[1] * y[1]).to_f64())
            .collect()
    }
}
