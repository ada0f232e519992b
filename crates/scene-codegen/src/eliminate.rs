//! Elimination of the independent rows as straight-line code. The order of the pivots is determined
//! once, for all sampled states. A candidate for a pivot must be large compared with its row and
//! its column at every state. Among the candidates, the entry with the least fill is selected
//! (Markowitz strategy with a threshold).
//!
//! Rows are given in axes in which few entries vary ([`crate::axes`]); masses, forces and results
//! are in the axes of the equations.
//!
//! The rows determine r dependent coordinates; the other coordinates are free. Every solution is
//! computed in the null space: x = x₀ + N·w. Here x₀ satisfies the rows with the free coordinates
//! at zero, and the columns of N are the motions for unit values of the free coordinates. The
//! vector w minimises the remaining residual in the mass metric. Zeros and ones of the mechanism
//! are constants of the program, so sparse matrices need no special treatment.
//!
//! Source of the threshold rule: I. S. Duff, A. M. Erisman, J. K. Reid, Direct Methods for Sparse
//! Matrices, 2nd ed. (2017), chapters 5 and 7.
//!
//! The free coordinates are determined when the code is generated. This method needs a third of the
//! operations of a sparse LDLᵀ factorisation of the saddle-point matrix. If a pivot becomes too
//! small, the run continues with the interpreter.

use std::cmp::Ordering;

use symbolic::Value;

use crate::axes::Axes;
use crate::equations::Number;
use crate::error::CodeError;
use crate::sampled::SampledProgram;

/// Desired lower limit for a pivot at every state, as a fraction of the largest entry of its row
/// and of its column.
const THRESHOLD: f64 = 0.1;

/// Smallest permitted fraction. If no pivot reaches this fraction, no fixed order of elimination is
/// suitable for the motion.
const SMALLEST: f64 = 1e-3;

/// A free motion is massless if at most this fraction of its mass remains after the elimination of
/// the other motions; the remainder is then a rounding error.
const MASSLESS: f64 = 1e-13;

/// The factored rows, and the mass matrix of the free motions.
pub(crate) struct FactoredRows {
    n: usize,
    axes: Axes,
    pivots: Vec<Pivot>,
    /// Coordinates that the rows do not determine, which are free.
    free: Vec<usize>,
    /// N: for each free coordinate, the motion of all coordinates, in the axes of the equations.
    frame: Vec<Vec<Value>>,
    /// Rows of the factor L of NᵀMN = L·D·Lᵀ, and 1/D.
    reduced: Vec<(Vec<Value>, Value)>,
    /// All divisors of the code.
    pub(crate) divisors: Vec<Value>,
}

struct Pivot {
    row: usize,
    column: usize,
    inverse: Value,
    /// Rows from which a multiple of the pivot row is subtracted, with this multiple.
    below: Vec<(usize, Value)>,
    /// The entries of the pivot row in the dependent coordinates of later pivots.
    right: Vec<(usize, Value)>,
    /// The entries of the pivot row in the free coordinates, in the order of these coordinates.
    free: Vec<Value>,
}

impl FactoredRows {
    /// Factors `rows` (r × n; zero entries are the constant 0) for velocities along `axes` and the
    /// masses `mass`. For the comparison of sizes, columns are multiplied by `scale`.
    pub(crate) fn new(
        code: &mut SampledProgram,
        mut rows: Vec<Vec<Value>>,
        axes: &Axes,
        (mass, scale): (&[Number], &[f64]),
    ) -> Result<Self, CodeError> {
        let (r, n) = (rows.len(), mass.len());
        let mut open_rows: Vec<usize> = (0..r).collect();
        let mut open_columns: Vec<usize> = (0..n).collect();
        let mut chosen = Vec::with_capacity(r);
        while !open_rows.is_empty() {
            let (row, column) = best_pivot(code, &rows, &open_rows, &open_columns, scale)?;
            open_rows.retain(|&i| i != row);
            open_columns.retain(|&j| j != column);
            let p = &mut code.program;
            let (one, pivot) = (p.number(1.0), rows[row][column]);
            let inverse = p.div(one, pivot);
            let mut below = Vec::new();
            for &i in &open_rows {
                if p.is_zero(rows[i][column]) {
                    continue;
                }
                let multiple = p.mul(rows[i][column], inverse);
                below.push((i, multiple));
                for &j in &open_columns {
                    let part = p.mul(multiple, rows[row][j]);
                    rows[i][j] = p.sub(rows[i][j], part);
                }
            }
            chosen.push((row, column, pivot, inverse, below));
        }
        let free = open_columns;
        let mut divisors = Vec::new();
        let mut pivots = Vec::with_capacity(r);
        for (k, (row, column, pivot, inverse, below)) in chosen.iter().enumerate() {
            let p = &code.program;
            let later = chosen[k + 1..].iter().map(|c| c.1);
            let right = later.map(|j| (j, rows[*row][j]));
            if p.as_number(*pivot).is_none() {
                divisors.push(*pivot);
            }
            pivots.push(Pivot {
                row: *row,
                column: *column,
                inverse: *inverse,
                below: below.clone(),
                right: right.filter(|(_, v)| !p.is_zero(*v)).collect(),
                free: free.iter().map(|&j| rows[*row][j]).collect(),
            });
        }
        let mut factored = Self {
            n,
            axes: axes.clone(),
            pivots,
            free,
            frame: Vec::new(),
            reduced: Vec::new(),
            divisors,
        };
        factored.frame = factored.null_frame(code);
        factored.reduce_mass(code, mass)?;
        Ok(factored)
    }

    /// Returns the solution x of `rows·x = rhs` that is nearest to M⁻¹·force in the mass metric.
    /// For Q and Γ, x contains the accelerations.
    pub(crate) fn solve(
        &self,
        code: &mut SampledProgram,
        mass: &[Number],
        rhs: &[Value],
        force: &[Value],
    ) -> Vec<Value> {
        let x = self.particular(code, rhs);
        let mut x = self.axes.velocities_out(code, &x);
        let p = &mut code.program;
        let left: Vec<Value> = (0..self.n)
            .map(|i| {
                let inertia = {
                    let m = mass[i].value(p);
                    p.mul(m, x[i])
                };
                p.sub(force[i], inertia)
            })
            .collect();
        let pulled: Vec<Value> = self.frame.iter().map(|n| dot(code, n, &left)).collect();
        let w = self.solve_reduced(code, pulled);
        let p = &mut code.program;
        for (n, w) in self.frame.iter().zip(w) {
            for (x, n) in x.iter_mut().zip(n) {
                let moved = p.mul(*n, w);
                *x = p.add(*x, moved);
            }
        }
        x
    }

    /// Returns the solution λ of `rowsᵀ·λ = excess` in the dependent coordinates. λ contains one
    /// multiplier for each row.
    pub(crate) fn multipliers(&self, code: &mut SampledProgram, excess: &[Value]) -> Vec<Value> {
        let mut left = self.axes.forces_in(code, excess);
        let p = &mut code.program;
        let zero = p.number(0.0);
        let mut lambda = vec![zero; self.pivots.len()];
        // Solves Uᵀ·y = excess, then Lᵀ·λ = y.
        for pivot in &self.pivots {
            let y = p.mul(left[pivot.column], pivot.inverse);
            lambda[pivot.row] = y;
            for &(column, u) in &pivot.right {
                let part = p.mul(u, y);
                left[column] = p.sub(left[column], part);
            }
        }
        for pivot in self.pivots.iter().rev() {
            for &(row, multiple) in &pivot.below {
                let part = p.mul(multiple, lambda[row]);
                lambda[pivot.row] = p.sub(lambda[pivot.row], part);
            }
        }
        lambda
    }

    /// Returns the solution x of `rows·x = rhs` for which the free coordinates are zero.
    fn particular(&self, code: &mut SampledProgram, rhs: &[Value]) -> Vec<Value> {
        let p = &mut code.program;
        let mut rhs = rhs.to_vec();
        for pivot in &self.pivots {
            for &(row, multiple) in &pivot.below {
                let part = p.mul(multiple, rhs[pivot.row]);
                rhs[row] = p.sub(rhs[row], part);
            }
        }
        let zero = p.number(0.0);
        let mut x = vec![zero; self.n];
        for pivot in self.pivots.iter().rev() {
            let mut left = rhs[pivot.row];
            for &(column, u) in &pivot.right {
                let part = p.mul(u, x[column]);
                left = p.sub(left, part);
            }
            x[pivot.column] = p.mul(left, pivot.inverse);
        }
        x
    }

    /// For each free coordinate, returns the motion of all coordinates.
    fn null_frame(&self, code: &mut SampledProgram) -> Vec<Vec<Value>> {
        let p = &mut code.program;
        let (zero, one) = (p.number(0.0), p.number(1.0));
        let motion = |(k, &free): (usize, &usize)| {
            let mut x = vec![zero; self.n];
            x[free] = one;
            for pivot in self.pivots.iter().rev() {
                let mut left = p.neg(pivot.free[k]);
                for &(column, u) in &pivot.right {
                    let part = p.mul(u, x[column]);
                    left = p.sub(left, part);
                }
                x[pivot.column] = p.mul(left, pivot.inverse);
            }
            x
        };
        let motions: Vec<_> = self.free.iter().enumerate().map(motion).collect();
        let out = |x: Vec<Value>| self.axes.velocities_out(code, &x);
        motions.into_iter().map(out).collect()
    }

    /// Computes the factors of NᵀMN = L·D·Lᵀ.
    fn reduce_mass(&mut self, code: &mut SampledProgram, mass: &[Number]) -> Result<(), CodeError> {
        let of = |m: &Number| m.value(&mut code.program);
        let masses: Vec<Value> = mass.iter().map(of).collect();
        let varies = mass.iter().any(|m| matches!(m, Number::Input(_)));
        let heavy: Vec<Vec<Value>> = self
            .frame
            .iter()
            .map(|n| {
                let pairs = n.iter().zip(&masses);
                pairs.map(|(n, m)| code.program.mul(*m, *n)).collect()
            })
            .collect();
        let k = self.free.len();
        // The factors are computed row by row. `row` contains the current row of L·D.
        for i in 0..k {
            let mut row: Vec<Value> = (0..=i)
                .map(|j| dot(code, &self.frame[i], &heavy[j]))
                .collect();
            let whole = row[i];
            let mut factors = Vec::with_capacity(i);
            let p = &mut code.program;
            for j in 0..i {
                for l in 0..j {
                    let part = p.mul(row[l], self.reduced[j].0[l]);
                    row[j] = p.sub(row[j], part);
                }
            }
            for j in 0..i {
                let factor = p.mul(row[j], self.reduced[j].1);
                let part = p.mul(factor, row[j]);
                row[i] = p.sub(row[i], part);
                factors.push(factor);
            }
            let diagonal = row[i];
            let (left, all) = (code.at(diagonal).to_vec(), code.at(whole));
            let mut shares = left.iter().zip(all);
            if !shares.all(|(left, all)| *left > MASSLESS * all) {
                return Err(CodeError::Massless {
                    column: self.free[i],
                });
            }
            let p = &mut code.program;
            // If a mass is an input, the remainder is compared with this mass.
            let divisor = match varies {
                true if diagonal == whole => p.number(1.0),
                true => p.div(diagonal, whole),
                false => diagonal,
            };
            if p.as_number(divisor).is_none() {
                self.divisors.push(divisor);
            }
            let one = p.number(1.0);
            let inverse = p.div(one, diagonal);
            self.reduced.push((factors, inverse));
        }
        Ok(())
    }

    fn solve_reduced(&self, code: &mut SampledProgram, mut w: Vec<Value>) -> Vec<Value> {
        let p = &mut code.program;
        for i in 0..w.len() {
            for j in 0..i {
                let part = p.mul(self.reduced[i].0[j], w[j]);
                w[i] = p.sub(w[i], part);
            }
        }
        for (w, (_, inverse)) in w.iter_mut().zip(&self.reduced) {
            *w = p.mul(*w, *inverse);
        }
        for i in (0..w.len()).rev() {
            for j in i + 1..w.len() {
                let part = p.mul(self.reduced[j].0[i], w[j]);
                w[i] = p.sub(w[i], part);
            }
        }
        w
    }
}

/// Σ aᵢ·bᵢ
fn dot(code: &mut SampledProgram, a: &[Value], b: &[Value]) -> Value {
    let products: Vec<_> = a.iter().copied().zip(b.iter().copied()).collect();
    code.sum(&products)
}

/// Returns the entry with the least fill among the entries that are sufficiently large at every
/// state. Constants are preferred.
fn best_pivot(
    code: &mut SampledProgram,
    rows: &[Vec<Value>],
    open_rows: &[usize],
    open_columns: &[usize],
    scale: &[f64],
) -> Result<(usize, usize), CodeError> {
    let states = code.states();
    let mut row_top = vec![vec![0.0_f64; states]; rows.len()];
    let mut column_top = vec![vec![0.0_f64; states]; scale.len()];
    let mut row_count = vec![0; rows.len()];
    let mut column_count = vec![0; scale.len()];
    let entries: Vec<(usize, usize)> = open_rows
        .iter()
        .flat_map(|&i| open_columns.iter().map(move |&j| (i, j)))
        .filter(|&(i, j)| !code.program.is_zero(rows[i][j]))
        .collect();
    for &(i, j) in &entries {
        row_count[i] += 1;
        column_count[j] += 1;
        for (k, value) in code.at(rows[i][j]).iter().enumerate() {
            let size = value.abs() * scale[j];
            row_top[i][k] = row_top[i][k].max(size);
            column_top[j][k] = column_top[j][k].max(size);
        }
    }
    let mut best: Option<(Candidate, usize, usize)> = None;
    for &(i, j) in &entries {
        let at = code.at(rows[i][j]);
        let keeps_sign = at.iter().all(|value| value * at[0] > 0.0);
        let share = at
            .iter()
            .enumerate()
            .map(|(k, value)| value.abs() * scale[j] / row_top[i][k].max(column_top[j][k]))
            .fold(1.0, |a: f64, share| if share < a { share } else { a });
        let candidate = Candidate {
            keeps_sign,
            share,
            fill: (row_count[i] - 1) * (column_count[j] - 1),
            varies: code.program.as_number(rows[i][j]).is_none(),
        };
        if best
            .as_ref()
            .is_none_or(|(b, ..)| candidate.is_better_than(b))
        {
            best = Some((candidate, i, j));
        }
    }
    match best {
        Some((candidate, i, j)) if candidate.share >= SMALLEST => Ok((i, j)),
        _ => Err(CodeError::NoPivot {
            share: best.map_or(0.0, |b| b.0.share),
            left: open_rows.len(),
        }),
    }
}

/// The criteria by which a pivot is chosen.
struct Candidate {
    /// Whether the pivot has the same sign at all states. Otherwise, the motion passes a point at
    /// which the pivot is zero.
    keeps_sign: bool,
    /// Smallest ratio over all states of the pivot to the largest entry of its row and column.
    share: f64,
    /// Upper bound of the number of new entries.
    fill: usize,
    varies: bool,
}

impl Candidate {
    fn is_better_than(&self, other: &Self) -> bool {
        let class = |c: &Self| (c.keeps_sign, c.share >= THRESHOLD);
        match class(self).cmp(&class(other)) {
            Ordering::Greater => true,
            Ordering::Less => false,
            Ordering::Equal if self.share < THRESHOLD => self.share > other.share,
            Ordering::Equal => (self.fill, self.varies) < (other.fill, other.varies),
        }
    }
}
