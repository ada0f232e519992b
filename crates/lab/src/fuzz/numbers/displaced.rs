//! What moves a reaction: one point, direction or number of a joint at a time, displaced in the
//! direction of its largest effect. Bodies follow by the smallest motion, velocities by the
//! smallest change; rows that are dropped stay dropped, and loads are held.

use model::{DataBlock, DataUnit, Mechanism, System};

use super::forms::{Form, forms};
use super::newton::{Factored, Kept};
use super::run::Row;

/// Displacement in sizes, and radians: that of the definition of a sensitivity.
const MOVED: f64 = 1e-4;

/// A piece that is smaller than a twentieth of the mechanism is made more accurately.
const PIECE: f64 = 20.0;

/// Displacement for derivatives, relative to the full one.
const SMALL: f64 = 1e-3;

/// Iterations of Newton's method, and the correction (sizes) after which there is no other.
const ITERATIONS: usize = 12;
const CONVERGED: f64 = 1e-13;

/// The state whose data are displaced.
pub(super) struct Displaced<'a> {
    mechanism: &'a Mechanism,
    row: &'a Row,
    kept: &'a [usize],
    size: f64,
    force: Vec<f64>,
    numbers: Vec<f64>,
    blocks: Vec<DataBlock>,
    frozen: [Factored; 2],
    /// Values at the state itself.
    pub(super) values: Vec<f64>,
}

impl<'a> Displaced<'a> {
    /// At a state, with these rows kept. `None` if they are dependent.
    pub(super) fn new(
        mechanism: &'a Mechanism,
        row: &'a Row,
        kept: &'a [usize],
        size: f64,
    ) -> Option<Self> {
        let mut s = mechanism.scratch();
        mechanism.pose(row.t_before, &row.q, &mut s);
        mechanism.c(&mut s);
        mechanism.twist(&row.v, &mut s);
        mechanism.force(&mut s);
        let rows = Kept::new(mechanism, kept, size);
        let mut found = Self {
            mechanism,
            row,
            kept,
            size,
            force: s.force.clone(),
            numbers: mechanism.data().numbers(),
            blocks: mechanism.data().blocks(&s),
            frozen: [rows.of_positions(&s), rows.of_velocities(&s)],
            values: Vec::new(),
        };
        found.values = found.with(mechanism, true)?;
        Some(found)
    }

    /// By component, the largest changes of its value by any one datum, in both directions.
    pub(super) fn changes(&self) -> Vec<f64> {
        let count = self.values.len();
        // By component: the largest effect so far, its datum and its direction.
        let mut most: Vec<(f64, usize, [f64; 3])> = vec![(0.0, 0, [0.0; 3]); count];
        for (k, block) in self.blocks.iter().enumerate() {
            let moved = self.moved(block);
            let mut gradients = vec![[0.0; 3]; count];
            for axis in 0..block.directions() {
                let mut by = [0.0; 3];
                by[axis] = SMALL * moved;
                let Some(values) = self.displaced(block, by, true) else {
                    continue;
                };
                for ((g, new), old) in gradients.iter_mut().zip(values).zip(&self.values) {
                    g[axis] = (new - old) / SMALL;
                }
            }
            for (most, g) in most.iter_mut().zip(gradients) {
                let effect = g[0].hypot(g[1]).hypot(g[2]);
                if effect > most.0 {
                    *most = (effect, k, g.map(|g| g / effect * moved));
                }
            }
        }
        let mut changes = vec![0.0_f64; count];
        for (k, &(effect, block, by)) in most.iter().enumerate() {
            if effect == 0.0 {
                continue;
            }
            for sign in [1.0, -1.0] {
                let values = self.displaced(&self.blocks[block], by.map(|x| sign * x), false);
                // Where nothing satisfies the displaced rows, first order is all there is.
                let change = values.map_or(effect, |v| (v[k] - self.values[k]).abs());
                changes[k] = changes[k].max(change);
            }
        }
        changes
    }

    fn moved(&self, block: &DataBlock) -> f64 {
        if block.unit == DataUnit::Angle {
            return MOVED;
        }
        let bodies = &self.mechanism.layout().groups[block.group].bodies;
        let reach = bodies.iter().filter_map(|b| b.moving());
        let reach = reach.map(|k| self.mechanism.reach(k)).fold(0.0, f64::max);
        let piece = if reach > 0.0 {
            PIECE * reach
        } else {
            self.size
        };
        MOVED * self.size.min(piece)
    }

    fn displaced(&self, block: &DataBlock, by: [f64; 3], is_small: bool) -> Option<Vec<f64>> {
        let mut numbers = self.numbers.clone();
        let own = block.displaced(&self.numbers[block.numbers.clone()], by);
        numbers[block.numbers.clone()].copy_from_slice(&own);
        self.with(&self.mechanism.with_numbers(&numbers), is_small)
    }

    /// The values of all components with other data. Small displacements are followed with the
    /// matrices of the state itself.
    fn with(&self, mechanism: &Mechanism, is_small: bool) -> Option<Vec<f64>> {
        let rows = Kept::new(mechanism, self.kept, self.size);
        let (mut q, mut v) = (self.row.q.clone(), self.row.v.clone());
        let mut s = mechanism.scratch();
        for k in 0.. {
            mechanism.pose(self.row.t_before, &q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            let step = if is_small {
                rows.correct(&s, &self.frozen[0], &mut q)?
            } else {
                rows.correct(&s, &rows.of_positions(&s), &mut q)?
            };
            if step <= CONVERGED * self.size {
                break;
            }
            if k == ITERATIONS {
                return None;
            }
        }
        mechanism.pose(self.row.t_before, &q, &mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        let own = (!is_small).then(|| rows.of_velocities(&s));
        let by = own.as_ref().unwrap_or(&self.frozen[1]);
        // Twice, for the matrices of the state itself.
        rows.correct_velocities(&s, by, &mut v)?;
        rows.correct_velocities(&s, by, &mut v)?;
        mechanism.twist(&v, &mut s);
        mechanism.gamma(&mut s);
        let lambda = rows.multipliers(&s, &self.force)?;
        let forms = forms(mechanism, &s, self.size);
        Some(forms.iter().map(|form| value(form, &lambda)).collect())
    }
}

fn value(form: &Form, lambda: &[f64]) -> f64 {
    let terms = form.coefficients.iter();
    terms.map(|&(row, c)| c * lambda[row]).sum()
}
