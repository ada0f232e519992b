//! The equations of motion at one instant, solved, and the gradients of reactions by all data.

use linalg::{KeptRowSaddle, Matrix, PivotedQr};
use model::start::scene_size;
use model::{ColumnKind, ConstraintId, DataUnit, Mechanism, System};

use super::{Datum, MOVED, Sensitivity};
use crate::choices::ChoiceError;
use crate::mechanism::velocity_units;

/// A load below this share of what would stop the bodies within the size of the mechanism, m·v²/size, is the rounding of a motion without any.
const LOAD_ROUNDING: f64 = 1e-9;

/// Points move by a share of the size of the mechanism, but at most by that of so many times the reach of the bodies that they join: a chain of a hundred
/// links is made link by link, and its holes are not a hundred times worse than those of one. In mechanisms of a few bodies it plays no part.
const PIECE: f64 = 20.0;

/// Angle between the directions of successive unit loads (rad): the golden one, which comes near no simple fraction of a turn.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// The equations at one instant, solved.
pub(super) struct Instant<'a> {
    mechanism: &'a Mechanism,
    s: model::Scratch,
    v: &'a [f64],
    kept: &'a [usize],
    size: f64,
    saddle: KeptRowSaddle,
    a: Vec<f64>,
    lambda: Vec<f64>,
    derivatives: model::Derivatives,
    /// Kept rows of C, and kept rows of Φ, with columns in velocity units, factored.
    c: Follow,
    phi_q: Follow,
    blocks: Vec<model::DataBlock>,
    /// Largest applied or inertial load (N; torques divided by the size).
    load: f64,
}

impl<'a> Instant<'a> {
    pub(super) fn new(
        mechanism: &'a Mechanism,
        t: f64,
        q: &[f64],
        v: &'a [f64],
        kept: &'a [usize],
    ) -> Result<Self, ChoiceError> {
        let layout = mechanism.layout();
        let (n, m) = (layout.n_v, layout.rows());
        let mut s = mechanism.scratch();
        mechanism.pose(t, q, &mut s);
        mechanism.c(&mut s);
        mechanism.twist(v, &mut s);
        mechanism.gamma(&mut s);
        mechanism.force(&mut s);
        let dense = layout.dense(&s);
        let mut saddle = KeptRowSaddle::new(n, kept.len())?;
        saddle.factor(|k| dense.row(kept[k]), mechanism.mass())?;
        let gamma: Vec<f64> = kept.iter().map(|&i| s.gamma[i]).collect();
        let (mut a, mut of_kept) = (vec![0.0; n], vec![0.0; kept.len()]);
        saddle.solve(&s.force, &gamma, &mut a, &mut of_kept)?;
        let mut lambda = vec![0.0; m];
        for (&i, l) in kept.iter().zip(of_kept) {
            lambda[i] = l;
        }
        let size = scene_size(mechanism, q);
        let units = velocity_units(mechanism, size);
        let holonomic: Vec<usize> = kept.iter().copied().filter(|&i| i < layout.m).collect();
        let c = Follow::new(&dense, kept.to_vec(), &units);
        let mut load = largest_load(mechanism, &s.force, &a, size);
        if load <= LOAD_ROUNDING * largest_stop(mechanism, v, size) {
            // Reactions of the unit loads alone; what they leave of them would accelerate.
            let unit = unit_loads(mechanism, size);
            lambda = c.multipliers(&unit, m);
            a.fill(0.0);
            load = 1.0;
        }
        let mut derivatives = mechanism.derivatives();
        mechanism.differentiate(&a, &lambda, &s, &mut derivatives);
        Ok(Self {
            c,
            phi_q: Follow::new(&dense, holonomic, &units),
            blocks: mechanism.data_blocks(&s),
            mechanism,
            s,
            v,
            kept,
            size,
            saddle,
            a,
            lambda,
            derivatives,
            load,
        })
    }

    pub(super) fn of(&mut self, id: ConstraintId) -> Result<Sensitivity, ChoiceError> {
        let group = &self.mechanism.layout().groups[id.0];
        let map = self.mechanism.wrench_map(id, &self.s);
        let components = group.components();
        let mut squares = vec![0.0; self.blocks.len()];
        let mut reaction = 0.0_f64;
        for &component in &components {
            // Torques count as forces at the size of the mechanism.
            let unit = if component == 2 { 1.0 / self.size } else { 1.0 };
            let row = map.row(component);
            let terms = row.iter().zip(&self.lambda[group.rows.clone()]);
            reaction = reaction.hypot(unit * terms.map(|(w, l)| w * l).sum::<f64>());
            let gradient = self.gradient(group.rows.clone().zip(row.iter().map(|w| w * unit)))?;
            for (sum, block) in squares.iter_mut().zip(&self.blocks) {
                let [x, y] = block.part(&gradient);
                *sum += x * x + y * y;
            }
        }
        let (size, mechanism) = (self.size, self.mechanism);
        let moved = |block: &model::DataBlock| {
            let workshop = match block.unit {
                DataUnit::Length => MOVED * size.min(piece(mechanism, block.group)),
                DataUnit::Angle => MOVED,
            };
            workshop.max(block.tolerance.unwrap_or(0.0))
        };
        let changes = squares.iter().zip(&self.blocks);
        let changes = changes.map(|(sum, block)| (sum.sqrt() * moved(block), block));
        let largest = changes.max_by(|a, b| a.0.total_cmp(&b.0));
        let reference = reaction.max(self.load);
        Ok(match largest {
            Some((change, block)) if change > 0.0 && reference > 0.0 => Sensitivity {
                change: change / reference,
                by: Some(Datum {
                    joint: ConstraintId(block.group),
                    name: block.name,
                    moved: moved(block),
                    unit: block.unit,
                    is_number: block.numbers.len() == 1,
                }),
            },
            _ => Sensitivity {
                change: 0.0,
                by: None,
            },
        })
    }

    /// The gradient of `wᵀ·λ` by all numbers of the constraints, for weights of some rows.
    fn gradient(
        &mut self,
        weights: impl Iterator<Item = (usize, f64)>,
    ) -> Result<Vec<f64>, ChoiceError> {
        let layout = self.mechanism.layout();
        let mut of_kept = vec![0.0; self.kept.len()];
        for (row, w) in weights {
            if let Ok(k) = self.kept.binary_search(&row) {
                of_kept[k] = w;
            }
        }
        let (mut y, mut y_kept) = (vec![0.0; layout.n_v], vec![0.0; self.kept.len()]);
        self.saddle
            .solve(&vec![0.0; layout.n_v], &of_kept, &mut y, &mut y_kept)?;
        let mut y_lambda = vec![0.0; layout.rows()];
        for (&i, value) in self.kept.iter().zip(y_kept) {
            y_lambda[i] = value;
        }
        let d = &self.derivatives;
        // By velocities, which follow the data and the pose.
        let mut by_v = vec![0.0; layout.n_v];
        add_transposed(&d.gamma_dv, &y_lambda, 1.0, &mut by_v);
        add_transposed(&d.force_dv, &y, 1.0, &mut by_v);
        let w_v = self.c.multipliers(&by_v, layout.rows());
        // By the pose, which follows the data.
        let mut by_q = vec![0.0; layout.n_v];
        add_transposed(&d.force_dq, &y, 1.0, &mut by_q);
        add_transposed(&d.reaction_dq, &y, -1.0, &mut by_q);
        add_transposed(&d.residual_dq, &y_lambda, -1.0, &mut by_q);
        add_transposed(&d.velocity_dq, &w_v, -1.0, &mut by_q);
        let w_q = self.phi_q.multipliers(&by_q, layout.rows());
        let mut gradient = vec![0.0; self.mechanism.data_count()];
        let (s, out) = (&self.s, &mut gradient);
        self.mechanism
            .add_power_by_data(s, &self.lambda, &y, -1.0, out);
        self.mechanism
            .add_residual_by_data(s, &y_lambda, &self.a, -1.0, out);
        self.mechanism.add_power_by_data(s, &w_v, self.v, -1.0, out);
        self.mechanism.add_phi_by_data(s, &w_q, -1.0, out);
        Ok(gradient)
    }
}

/// Rows that stay satisfied: what follows a change of the data by the smallest motion.
struct Follow {
    rows: Vec<usize>,
    units: Vec<f64>,
    qr: PivotedQr,
}

impl Follow {
    fn new(dense: &Matrix, rows: Vec<usize>, units: &[f64]) -> Self {
        let mut selected = dense.select_rows(&rows);
        for i in 0..selected.nrows() {
            let row = selected.row_mut(i).iter_mut();
            row.zip(units).for_each(|(entry, unit)| *entry *= unit);
        }
        Self {
            qr: PivotedQr::of_rows(selected),
            rows,
            units: units.to_vec(),
        }
    }

    /// `w` with `gᵀ·δx = −wᵀ·δr` for the smallest δx that answers a change δr of the rows; all rows of the mechanism.
    fn multipliers(&self, g: &[f64], all: usize) -> Vec<f64> {
        let mut answer: Vec<f64> = g
            .iter()
            .zip(&self.units)
            .map(|(g, unit)| g * unit)
            .collect();
        self.qr.q_transpose_mul(&mut answer);
        let mut w = answer[..self.rows.len()].to_vec();
        self.qr.solve_r(&mut w);
        let mut out = vec![0.0; all];
        for (w, &k) in w.iter().zip(self.qr.permutation()) {
            out[self.rows[k]] = *w;
        }
        out
    }
}

/// `y ← y + factor·Aᵀ·x`
fn add_transposed(matrix: &model::Sparse, x: &[f64], factor: f64, y: &mut [f64]) {
    for (row, column, value) in matrix.iter() {
        y[column] += factor * value * x[row];
    }
}

/// The largest applied or inertial force on a body (N), torques divided by the size.
fn largest_load(mechanism: &Mechanism, force: &[f64], a: &[f64], size: f64) -> f64 {
    let inertial = mechanism.mass().iter().zip(a).map(|(m, a)| (m * a).abs());
    let applied = force.iter().map(|f| f.abs());
    let kinds = mechanism.column_kinds();
    let larger = inertial.zip(applied).zip(&kinds).map(|((i, f), kind)| {
        let unit = match kind {
            ColumnKind::Translation => 1.0,
            ColumnKind::Rotation => 1.0 / size,
        };
        i.max(f) * unit
    });
    larger.fold(0.0, f64::max)
}

/// The length to which a workshop works where it makes the bodies of a joint (m): several times their reach; without an end where that is not known.
fn piece(mechanism: &Mechanism, group: usize) -> f64 {
    let bodies = mechanism.layout().groups[group].bodies.iter();
    let reach = bodies
        .filter_map(|b| b.moving())
        .map(|k| mechanism.reach(k));
    match reach.fold(0.0, f64::max) {
        reach if reach > 0.0 => PIECE * reach,
        _ => f64::INFINITY,
    }
}

/// What would stop the fastest body within the size of the mechanism (N).
fn largest_stop(mechanism: &Mechanism, v: &[f64], size: f64) -> f64 {
    let kinds = mechanism.column_kinds();
    let of = |((m, v), kind): ((&f64, &f64), &ColumnKind)| {
        let unit = match kind {
            ColumnKind::Translation => size,
            ColumnKind::Rotation => size * size,
        };
        m * v * v / unit
    };
    let each = mechanism.mass().iter().zip(v).zip(&kinds);
    each.map(of).fold(0.0, f64::max)
}

/// A force of 1 N on each body, and a torque of up to 1 N times the size.
fn unit_loads(mechanism: &Mechanism, size: f64) -> Vec<f64> {
    let kinds = mechanism.column_kinds();
    let number = |(j, kind): (usize, &ColumnKind)| {
        let (sin, cos) = (GOLDEN_ANGLE * (1 + j / COLUMNS) as f64).sin_cos();
        match (kind, j % COLUMNS) {
            (ColumnKind::Rotation, _) => size * (2.0 * sin * cos),
            (ColumnKind::Translation, 0) => cos,
            (ColumnKind::Translation, _) => sin,
        }
    };
    kinds.iter().enumerate().map(number).collect()
}

/// Columns of a planar body.
const COLUMNS: usize = 3;
