//! The simplex method for small linear programs with dense data: minimise `cᵀ·x` subject to
//! `A·x = b`, `x ≥ 0`.
//!
//! Each basis is factored anew from the data, and its solutions are refined with residuals in
//! double-double arithmetic, so rounding errors do not grow with the number of steps. The column
//! enters along which the cost decreases most for its length. After a step that changes no
//! variable, columns enter and leave by the rule of the smallest index (R. G. Bland, New finite
//! pivoting rules for the simplex method, Math. Oper. Res. 2 (1977) 103–107) until a step changes
//! one, so the search ends at degenerate vertices.
//!
//! The columns of A may differ in size, because components are compared with the lengths of their
//! columns. The rounding errors of b are relative to the size of b. The rounding errors of the
//! costs are relative to a size that the caller states.

use linalg::{Lu, Matrix, kernels};

use super::{Unclear, refined, rounding_of_dot};
use crate::limits::{CLEAR_MINOR, PIVOTS, SUPPORT_ROUNDING, ZERO_MINOR};

/// A linear program.
pub(crate) struct Program<'p> {
    /// The matrix Aᵀ. Row k is column k of A.
    pub(crate) columns: &'p Matrix,
    /// The vector b, one number for each equation.
    pub(crate) right: &'p [f64],
    /// The vector c, one number for each column.
    pub(crate) cost: &'p [f64],
    /// Size of the data from which the costs were computed.
    pub(crate) cost_size: f64,
}

/// The solution of a linear program.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// The cost is minimal.
    Optimal {
        /// A vertex with this cost.
        x: Vec<f64>,
        /// A vector y with `Aᵀ·y ≤ c` and `bᵀ·y = cᵀ·x`.
        multipliers: Vec<f64>,
    },
    /// The cost decreases without limit.
    Unbounded,
    /// There is no solution.
    Infeasible {
        /// A vector y with `Aᵀ·y ≤ 0` and `bᵀ·y > 0`.
        multipliers: Vec<f64>,
    },
}

/// Solves a linear program.
pub(crate) fn minimise(program: &Program) -> Result<Outcome, Unclear> {
    let mut simplex = Simplex::new(program);
    let Some(vertex) = simplex.descend(Phase::Feasible)? else {
        // A sum of non-negative numbers has a minimum.
        return Err(Unclear::Unproved);
    };
    let columns = program.columns.nrows();
    let levels = simplex.basic.iter().zip(&vertex.levels);
    let artificial: f64 = levels.filter(|(j, _)| **j >= columns).map(|(_, x)| x).sum();
    let size: f64 = program.right.iter().map(|b| b.abs()).sum();
    if artificial > ZERO_MINOR * size {
        return if artificial >= CLEAR_MINOR * size {
            Ok(Outcome::Infeasible {
                multipliers: vertex.multipliers,
            })
        } else {
            Err(Unclear::Distance(artificial / size))
        };
    }
    let Some(vertex) = simplex.descend(Phase::Cheapest)? else {
        return Ok(Outcome::Unbounded);
    };
    let mut x = vec![0.0; columns];
    for (&j, level) in simplex.basic.iter().zip(vertex.levels) {
        if j < columns {
            x[j] = level;
        }
    }
    Ok(Outcome::Optimal {
        x,
        multipliers: vertex.multipliers,
    })
}

/// The quantity that the search decreases.
#[derive(Clone, Copy, PartialEq)]
enum Phase {
    /// The sum of the artificial variables.
    Feasible,
    /// The cost. Artificial variables are zero.
    Cheapest,
}

/// The solution of the equations with the current basis.
struct Vertex {
    /// The factored columns of the basic variables.
    factors: Lu,
    /// Values of the basic variables.
    levels: Vec<f64>,
    multipliers: Vec<f64>,
}

/// The current basis. Variable `columns + i` is the artificial variable of equation i.
struct Simplex<'p> {
    program: &'p Program<'p>,
    /// Lengths of the columns.
    lengths: Vec<f64>,
    basic: Vec<usize>,
    steps: usize,
}

impl<'p> Simplex<'p> {
    /// Starts with the artificial variables.
    fn new(program: &'p Program<'p>) -> Self {
        let (columns, equations) = (program.columns.nrows(), program.right.len());
        let lengths = (0..columns).map(|k| kernels::norm(program.columns.row(k)));
        Self {
            program,
            lengths: lengths.collect(),
            basic: (columns..columns + equations).collect(),
            steps: 0,
        }
    }

    /// Changes the basis until no column decreases the cost. Returns no vertex if the cost
    /// decreases without limit.
    fn descend(&mut self, phase: Phase) -> Result<Option<Vertex>, Unclear> {
        let mut is_degenerate = false;
        loop {
            let mut vertex = self.vertex(phase)?;
            let slope = |k| self.slope(k, &vertex.multipliers, phase).map(|s| (k, s));
            let nonbasic = (0..self.lengths.len()).filter(|k| !self.basic.contains(k));
            let mut falling = nonbasic.filter_map(slope);
            let entering = if is_degenerate {
                falling.next()
            } else {
                falling.min_by(|(_, a), (_, b)| a.total_cmp(b))
            };
            let Some((entering, _)) = entering else {
                return Ok(Some(vertex));
            };
            let Some(leaving) = self.leaving(entering, &mut vertex)? else {
                return Ok(None);
            };
            is_degenerate = vertex.levels[leaving] == 0.0;
            self.basic[leaving] = entering;
            self.steps += 1;
            if self.steps > PIVOTS {
                return Err(Unclear::Steps);
            }
        }
    }

    /// Returns entry i of the column of a variable.
    fn entry(&self, i: usize, variable: usize) -> f64 {
        match variable.checked_sub(self.lengths.len()) {
            None => self.program.columns[(variable, i)],
            Some(equation) if equation == i => 1.0_f64.copysign(self.program.right[i]),
            Some(_) => 0.0,
        }
    }

    /// Returns the length of the column of a variable.
    fn length(&self, variable: usize) -> f64 {
        self.lengths.get(variable).copied().unwrap_or(1.0)
    }

    fn is_artificial(&self, variable: usize) -> bool {
        variable >= self.lengths.len()
    }

    /// Returns the cost of a variable.
    fn cost(&self, variable: usize, phase: Phase) -> f64 {
        match (phase, self.is_artificial(variable)) {
            (Phase::Feasible, artificial) => f64::from(u8::from(artificial)),
            (Phase::Cheapest, true) => 0.0,
            (Phase::Cheapest, false) => self.program.cost[variable],
        }
    }

    /// Factors the basis and solves the equations.
    fn vertex(&self, phase: Phase) -> Result<Vertex, Unclear> {
        let singular = |_| Unclear::Component(0.0);
        let entry = |i: usize, j: usize| self.entry(i, self.basic[j]);
        let mut factors = Lu::new(self.basic.len());
        let cost: Vec<f64> = self.basic.iter().map(|&j| self.cost(j, phase)).collect();
        factors.factor(|i, j| entry(j, i)).map_err(singular)?;
        let multipliers = refined(&mut factors, |i, j| entry(j, i), &cost);
        factors.factor(entry).map_err(singular)?;
        let mut levels = refined(&mut factors, entry, self.program.right);
        let share = |x: f64, j: usize| x.abs() * self.length(j);
        let shares = levels.iter().zip(&self.basic).map(|(x, &j)| share(*x, j));
        let zero = SUPPORT_ROUNDING * shares.fold(0.0, f64::max);
        for (level, &j) in levels.iter_mut().zip(&self.basic) {
            let is_fixed = phase == Phase::Cheapest && self.is_artificial(j);
            if is_fixed || share(*level, j) <= zero {
                *level = 0.0;
            } else if level.is_nan() || *level < 0.0 {
                return Err(Unclear::Unproved);
            }
        }
        Ok(Vertex {
            factors,
            levels,
            multipliers,
        })
    }

    /// Returns the change of the cost with this variable, relative to the length of its column, if
    /// the cost decreases.
    fn slope(&self, variable: usize, multipliers: &[f64], phase: Phase) -> Option<f64> {
        let column = self.program.columns.row(variable);
        let reduced = self.cost(variable, phase) - kernels::dot(column, multipliers);
        let rounding = rounding_of_dot(column, multipliers);
        let zero = match phase {
            Phase::Feasible => self.lengths[variable],
            Phase::Cheapest => self.program.cost_size,
        };
        let is_falling = reduced < -(SUPPORT_ROUNDING * zero + rounding);
        is_falling.then(|| reduced / self.lengths[variable])
    }

    /// Returns the position of the basic variable that becomes zero first, if a basic variable
    /// decreases. Artificial variables that are zero leave first, so that they stay zero.
    fn leaving(&self, entering: usize, vertex: &mut Vertex) -> Result<Option<usize>, Unclear> {
        let column = self.program.columns.row(entering);
        let entry = |i: usize, j: usize| self.entry(i, self.basic[j]);
        let direction = refined(&mut vertex.factors, entry, column);
        let levels = &vertex.levels;
        let length = self.lengths[entering];
        let component = |i: usize| direction[i] * self.length(self.basic[i]);
        let all = 0..levels.len();
        let zero_artificial = |&i: &usize| levels[i] == 0.0 && self.is_artificial(self.basic[i]);
        let first = all.clone().filter(zero_artificial);
        let first = first.max_by(|&i, &j| component(i).abs().total_cmp(&component(j).abs()));
        let first = first.filter(|&i| component(i).abs() > ZERO_MINOR * length);
        let leaving = first.or_else(|| {
            let decreasing = all.filter(|&i| component(i) > ZERO_MINOR * length);
            decreasing.min_by(|&i, &j| {
                let step = |i: usize| levels[i] / direction[i];
                let order = step(i).total_cmp(&step(j));
                order.then(self.basic[i].cmp(&self.basic[j]))
            })
        });
        match leaving {
            Some(i) if component(i).abs() < CLEAR_MINOR * length => {
                Err(Unclear::Component(component(i) / length))
            }
            leaving => Ok(leaving),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves the program with these rows of Aᵀ, and costs.
    fn solved(columns: &[&[f64]], right: &[f64], cost: &[f64]) -> Outcome {
        let columns = Matrix::from_fn(columns.len(), right.len(), |k, i| columns[k][i]);
        let program = Program {
            columns: &columns,
            right,
            cost,
            cost_size: kernels::max_abs(cost),
        };
        minimise(&program).unwrap()
    }

    /// The example is from E. M. L. Beale, Cycling in the dual simplex algorithm, Naval Res.
    /// Logist. Quart. 2 (1955) 269–275. With the rule of the steepest descent, the search returns
    /// to its first basis.
    #[test]
    fn the_search_ends_at_degenerate_vertices() {
        let columns: [&[f64]; 7] = [
            &[0.25, 0.5, 0.0],
            &[-60.0, -90.0, 0.0],
            &[-1.0 / 25.0, -1.0 / 50.0, 1.0],
            &[9.0, 3.0, 0.0],
            &[1.0, 0.0, 0.0],
            &[0.0, 1.0, 0.0],
            &[0.0, 0.0, 1.0],
        ];
        let cost = [-0.75, 150.0, -0.02, 6.0, 0.0, 0.0, 0.0];
        let Outcome::Optimal { x, multipliers } = solved(&columns, &[0.0, 0.0, 1.0], &cost) else {
            panic!("no optimum");
        };
        let found: f64 = x.iter().zip(cost).map(|(x, c)| x * c).sum();
        assert!((found + 0.05).abs() < 1e-15, "{found}");
        assert!((multipliers[2] + 0.05).abs() < 1e-15);
    }

    #[test]
    fn multipliers_prove_that_there_is_no_solution() {
        // The equation 2·x = −1 for x ≥ 0, and an equation that follows from it.
        let outcome = solved(&[&[2.0, 4.0]], &[-1.0, -2.0], &[1.0]);
        let Outcome::Infeasible { multipliers: y } = outcome else {
            panic!("{outcome:?}");
        };
        assert!(2.0 * y[0] + 4.0 * y[1] <= 0.0 && -y[0] - 2.0 * y[1] > 0.0);
    }

    #[test]
    fn dependent_equations_and_falling_costs_are_found() {
        let columns: [&[f64]; 2] = [&[1.0, 2.0], &[-1.0, -2.0]];
        let outcome = solved(&columns, &[1.0, 2.0], &[1.0, -2.0]);
        assert!(matches!(outcome, Outcome::Unbounded), "{outcome:?}");
        let outcome = solved(&columns, &[1.0, 2.0], &[1.0, 2.0]);
        let Outcome::Optimal { x, .. } = outcome else {
            panic!("{outcome:?}");
        };
        assert_eq!(x, [1.0, 0.0]);
        assert!(matches!(solved(&[], &[], &[]), Outcome::Optimal { .. }));
    }

    #[test]
    fn weak_components_are_undecided() {
        let of = |weak: f64| {
            let columns = Matrix::from_rows(&[[-1.0, 0.0], [1.0, weak]]);
            let program = Program {
                columns: &columns,
                right: &[0.0, 1.0],
                cost: &[0.0, 0.0],
                cost_size: 1.0,
            };
            minimise(&program).map(|outcome| matches!(outcome, Outcome::Optimal { .. }))
        };
        assert_eq!(of(1e-5), Ok(true));
        assert!(matches!(of(1e-8), Err(Unclear::Component(_))));
        assert_eq!(of(1e-14), Ok(false));
    }
}
