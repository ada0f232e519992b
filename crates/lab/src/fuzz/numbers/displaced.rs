//! Computes sensitivities of a reaction. One point, direction or scalar datum of a joint at a time
//! is displaced in the direction of its largest effect. Positions and velocities of bodies are
//! corrected by the smallest changes that satisfy the constraints. The selection of redundant rows
//! and the loads do not change.

use model::{DataBlock, DataUnit, Mechanism, System};

use super::forms::{Form, forms};
use super::newton::{Factored, Kept};
use super::run::Row;

/// Displacement as a fraction of the size, or in radians, as in the definition of a sensitivity.
const MOVED: f64 = 1e-4;

/// For a part that is smaller than the size of the mechanism divided by this factor, the
/// displacement is relative to this factor times the size of the part.
const PIECE: f64 = 20.0;

/// Displacement for derivatives, relative to the full displacement. The motion of bodies is the
/// displacement divided by the smallest singular value, and must be far below this singular value.
const SMALL: f64 = 1e-5;

/// Size of the first step of a displacement.
const FIRST: f64 = 1e-3;

/// If the effects of displacements in both directions differ by this fraction of their sum, the
/// effects are not of first order.
const CURVED: f64 = 0.1;

/// Number of steps of a displacement. With these steps, bodies remain on their branch.
const STEPS: usize = 8;

/// If a step moves bodies by more than this multiple of the previous step, the branch was left.
const JUMP: f64 = 5.0;

/// Largest number of iterations of Newton's method, and the correction (as a fraction of the size)
/// at which the iteration ends.
const ITERATIONS: usize = 12;
const CONVERGED: f64 = 1e-13;

/// The first-order change of a component caused by one datum.
#[derive(Clone, Default)]
struct Effect {
    size: f64,
    /// Index of the datum.
    block: usize,
    /// Displacement with the largest effect.
    by: [f64; 3],
    /// Whether displacements in both directions have the same effect.
    is_straight: bool,
}

/// The state with displaced data.
pub(super) struct Displaced<'a> {
    mechanism: &'a Mechanism,
    row: &'a Row,
    kept: &'a [usize],
    size: f64,
    force: Vec<f64>,
    numbers: Vec<f64>,
    blocks: Vec<DataBlock>,
    frozen: [Factored; 2],
    /// Values at the undisplaced state.
    pub(super) values: Vec<f64>,
}

impl<'a> Displaced<'a> {
    /// Creates the computation at a state, with these independent rows. Returns `None` if the rows
    /// are dependent.
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
        let [mut q, mut v] = [&row.q, &row.v].map(|x| x.clone());
        found.values = found.with(mechanism, (&mut q, &mut v), true)?;
        Some(found)
    }

    /// Returns for each component the largest change of its value caused by any single datum,
    /// displaced in both directions.
    pub(super) fn changes(&self) -> Vec<f64> {
        let count = self.values.len();
        let mut most = vec![Effect::default(); count];
        for (k, block) in self.blocks.iter().enumerate() {
            for (most, effect) in most.iter_mut().zip(self.effects(k, block)) {
                if effect.size > most.size {
                    *most = effect;
                }
            }
        }
        let mut changes = vec![0.0_f64; count];
        for (k, effect) in most.iter().enumerate() {
            if effect.size == 0.0 {
                continue;
            }
            for sign in [1.0, -1.0] {
                let by = effect.by.map(|x| sign * x);
                let values = self.displaced(&self.blocks[effect.block], by);
                // If no configuration satisfies the constraints with displaced data, only the
                // first-order effect is available.
                let alone = if effect.is_straight { effect.size } else { 0.0 };
                let change = values.map_or(alone, |v| (v[k] - self.values[k]).abs());
                changes[k] = changes[k].max(change);
            }
        }
        changes
    }

    /// Returns for each component the first-order effect of one datum.
    fn effects(&self, number: usize, block: &DataBlock) -> Vec<Effect> {
        let moved = self.moved(block);
        let none = Effect {
            block: number,
            is_straight: true,
            ..Effect::default()
        };
        let mut effects = vec![none; self.values.len()];
        for axis in 0..block.directions() {
            let [after, before] = [SMALL, -SMALL].map(|small| {
                let mut by = [0.0; 3];
                by[axis] = small * moved;
                self.displaced_little(block, by)
            });
            let (Some(after), Some(before)) = (after, before) else {
                continue;
            };
            let values = after.iter().zip(&before).zip(&self.values);
            for (effect, ((after, before), value)) in effects.iter_mut().zip(values) {
                let (up, down) = (after - value, value - before);
                effect.by[axis] = 0.5 * (up + down) / SMALL;
                effect.is_straight &= (up - down).abs() <= CURVED * (up + down).abs();
            }
        }
        for effect in &mut effects {
            let [x, y, z] = effect.by;
            effect.size = x.hypot(y).hypot(z);
            effect.by = effect.by.map(|g| g / effect.size * moved);
        }
        effects
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

    fn with_displaced(&self, block: &DataBlock, by: [f64; 3]) -> Mechanism {
        let mut numbers = self.numbers.clone();
        let own = block.displaced(&self.numbers[block.numbers.clone()], by);
        numbers[block.numbers.clone()].copy_from_slice(&own);
        self.mechanism.with_numbers(&numbers)
    }

    /// Returns the values of all components for a small displacement of a datum, computed with the
    /// matrices of the undisplaced state.
    fn displaced_little(&self, block: &DataBlock, by: [f64; 3]) -> Option<Vec<f64>> {
        let [mut q, mut v] = [&self.row.q, &self.row.v].map(|x| x.clone());
        self.with(&self.with_displaced(block, by), (&mut q, &mut v), true)
    }

    /// Returns the values of all components with a displaced datum. Returns `None` if no
    /// configuration on the branch of the state satisfies the constraints with the displaced datum.
    fn displaced(&self, block: &DataBlock, by: [f64; 3]) -> Option<Vec<f64>> {
        let [mut q, mut v] = [&self.row.q, &self.row.v].map(|x| x.clone());
        let (mut values, mut at, mut rate) = (None, 0.0, f64::INFINITY);
        let all = (1..=STEPS).map(|k| k as f64 / STEPS as f64);
        for share in std::iter::once(FIRST).chain(all) {
            let mechanism = self.with_displaced(block, by.map(|x| share * x));
            let begun = q.clone();
            values = Some(self.with(&mechanism, (&mut q, &mut v), false)?);
            let (_, moved) = mechanism.largest_difference(&q, &begun, self.size);
            if moved > JUMP * rate * (share - at) {
                return None;
            }
            rate = moved.max(CONVERGED * self.size) / (share - at);
            at = share;
        }
        values
    }

    /// Returns the values of all components with other data, and the resulting positions and
    /// velocities of bodies.
    fn with(
        &self,
        mechanism: &Mechanism,
        (q, v): (&mut [f64], &mut [f64]),
        is_small: bool,
    ) -> Option<Vec<f64>> {
        let rows = Kept::new(mechanism, self.kept, self.size);
        let mut s = mechanism.scratch();
        for k in 0.. {
            mechanism.pose(self.row.t_before, q, &mut s);
            mechanism.phi(&mut s);
            mechanism.c(&mut s);
            let step = if is_small {
                rows.correct(&s, &self.frozen[0], q)?
            } else {
                rows.correct(&s, &rows.of_positions(&s), q)?
            };
            if step <= CONVERGED * self.size {
                break;
            }
            if k == ITERATIONS {
                return None;
            }
        }
        mechanism.pose(self.row.t_before, q, &mut s);
        mechanism.c(&mut s);
        mechanism.b(&mut s);
        let own = (!is_small).then(|| rows.of_velocities(&s));
        let by = own.as_ref().unwrap_or(&self.frozen[1]);
        // The correction is applied twice, because the matrices of the undisplaced state are used.
        rows.correct_velocities(&s, by, v)?;
        rows.correct_velocities(&s, by, v)?;
        mechanism.twist(v, &mut s);
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
