//! Many gradients with respect to the numbers of the constraints at one instant, with a single
//! evaluation of the kernels.
//!
//! `λᵀ·C·y + y_λᵀ·(C·a − Γ) + w_vᵀ·C·v + w_qᵀ·Φ` is linear in y, y_λ, w_v and w_q. So its gradient
//! with respect to the numbers of one constraint is a small matrix times the few entries that
//! belong to that constraint.

use std::ops::Range;

use joints::Twist;

use super::Data;
use crate::mechanism::twist_of;
use crate::space::{Plane, Space};
use crate::system::{Scratch, System};

/// Gradients of `λᵀ·C·y + y_λᵀ·(C·a − Γ) + w_vᵀ·C·v + w_qᵀ·Φ` with respect to all numbers of the
/// constraints, for any y, y_λ, w_v and w_q.
#[derive(Clone, Debug)]
pub struct DataGradients {
    each: Vec<OfConstraint>,
    /// Matrices by columns, constraint by constraint.
    values: Vec<f64>,
    /// Whether any velocity is not zero.
    moves: bool,
}

/// The columns that belong to one constraint.
#[derive(Clone, Debug)]
struct OfConstraint {
    numbers: Range<usize>,
    /// Velocities of its bodies: first columns of C.
    bodies: Vec<usize>,
    rows: Range<usize>,
    is_holonomic: bool,
}

/// Unit velocities of a body.
const UNITS: [Twist; Plane::N_V] = [
    Twist {
        x: 1.0,
        y: 0.0,
        omega: 0.0,
    },
    Twist {
        x: 0.0,
        y: 1.0,
        omega: 0.0,
    },
    Twist {
        x: 0.0,
        y: 0.0,
        omega: 1.0,
    },
];

impl Data<'_> {
    /// The gradients at the pose and the twist of the scratch, for multipliers (m + h),
    /// accelerations a and velocities v (n_v); allocates.
    #[must_use]
    pub fn gradients(self, s: &Scratch, lambda: &[f64], a: &[f64], v: &[f64]) -> DataGradients {
        let moves = v.iter().any(|v| *v != 0.0);
        let (mut each, mut values) = (Vec::new(), Vec::new());
        for (c, numbers) in self.numbered() {
            let element = &c.element;
            if numbers.is_empty() {
                continue;
            }
            let mut column = |fill: &mut dyn FnMut(&mut [f64])| {
                let place = values.len();
                values.resize(place + numbers.len(), 0.0);
                fill(&mut values[place..]);
            };
            let (x, twists, f) = c.site.xvf(&s.slots);
            // Without velocities and functions of time, Γ vanishes.
            let (still, no_f) = (
                vec![Twist::zero(); c.site.bodies.len()],
                vec![[0.0; 3]; c.site.functions.len()],
            );
            let own = &lambda[c.rows.clone()];
            let (mut slots, mut bodies) = (still.clone(), Vec::new());
            for (k, body) in c.site.bodies.iter().enumerate() {
                let Some(body) = body.moving() else {
                    continue;
                };
                bodies.push(Plane::N_V * body);
                for unit in UNITS {
                    slots[k] = unit;
                    column(&mut |out| element.d_residual_dp(x, &still, &slots, &no_f, own, out));
                }
                slots[k] = Twist::zero();
            }
            let of = |x: &[f64]| -> Vec<Twist> {
                c.site
                    .bodies
                    .iter()
                    .map(|&body| twist_of(body, x))
                    .collect()
            };
            let (a, v) = (of(a), of(v));
            let is_holonomic = c.rows.start < self.0.layout().m;
            let mut unit = vec![0.0; c.rows.len()];
            for i in 0..unit.len() {
                unit[i] = 1.0;
                column(&mut |out| element.d_residual_dp(x, twists, &a, f, &unit, out));
                if moves {
                    column(&mut |out| element.d_residual_dp(x, &still, &v, &no_f, &unit, out));
                }
                if is_holonomic {
                    column(&mut |out| element.d_phi_dp(x, f, &unit, out));
                }
                unit[i] = 0.0;
            }
            each.push(OfConstraint {
                numbers,
                bodies,
                rows: c.rows.clone(),
                is_holonomic,
            });
        }
        DataGradients {
            each,
            values,
            moves,
        }
    }
}

impl DataGradients {
    /// Computes one gradient and overwrites `out`; y has n_v values, the others m + h.
    ///
    /// # Panics
    /// If a slice is too short.
    pub fn gradient(&self, y: &[f64], [y_lambda, w_v, w_q]: [&[f64]; 3], out: &mut [f64]) {
        out.fill(0.0);
        let mut rest = &self.values[..];
        for c in &self.each {
            let out = &mut out[c.numbers.clone()];
            let mut add = |x: f64| {
                let (column, tail) = rest.split_at(out.len());
                rest = tail;
                if x != 0.0 {
                    for (out, value) in out.iter_mut().zip(column) {
                        *out += x * value;
                    }
                }
            };
            for &first in &c.bodies {
                y[first..first + Plane::N_V].iter().for_each(|y| add(*y));
            }
            for row in c.rows.clone() {
                add(y_lambda[row]);
                if self.moves {
                    add(w_v[row]);
                }
                if c.is_holonomic {
                    add(w_q[row]);
                }
            }
        }
    }
}
