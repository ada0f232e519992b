//! Many gradients with respect to the values stored by the constraints at one instant. The kernels
//! are evaluated only once.
//!
//! The expression `λᵀ·C·y + y_λᵀ·(C·a − Γ) + w_vᵀ·C·v + w_qᵀ·Φ` is linear in y, y_λ, w_v and w_q.
//! For a joint with an armature, the expression also contains yᵀ·gᵀ·a·g·v̇, the inertia of the
//! armature.
//! Therefore its gradient with respect to the values of one constraint is a small matrix times the
//! entries of y, y_λ, w_v and w_q for this constraint.

use std::ops::Range;

use super::Data;
use crate::rows::RowRanges;
use crate::system::{Scratch, System};

/// Gradients of `λᵀ·C·y + y_λᵀ·(C·a − Γ) + w_vᵀ·C·v + w_qᵀ·Φ` with respect to all values stored by
/// the constraints, for any y, y_λ, w_v and w_q.
#[derive(Clone, Debug)]
pub struct DataGradients {
    each: Vec<OfConstraint>,
    /// Matrices by columns, constraint by constraint.
    values: Vec<f64>,
    /// Whether any velocity component is not zero.
    moves: bool,
}

/// The columns that belong to one constraint.
#[derive(Clone, Debug)]
struct OfConstraint {
    numbers: Range<usize>,
    /// Columns of C of the bodies of the constraint.
    bodies: Vec<Range<usize>>,
    rows: RowRanges,
}

impl Data<'_> {
    /// Returns the gradients at the configuration and the velocities in the work space, for
    /// multipliers (m + h), accelerations a and velocities v (n_v). `of_armatures` are the
    /// accelerations of the armatures (n_v): zeros if their inertia is not part of the equations.
    /// The function allocates memory.
    #[must_use]
    pub fn gradients(
        self,
        s: &Scratch,
        lambda: &[f64],
        [a, of_armatures]: [&[f64]; 2],
        v: &[f64],
    ) -> DataGradients {
        let space = self.0.space();
        let moves = v.iter().any(|v| *v != 0.0);
        let (mut each, mut values) = (Vec::new(), Vec::new());
        for ((c, numbers), group) in self.numbered().zip(&self.0.layout().groups) {
            if numbers.is_empty() {
                continue;
            }
            let armatures = || {
                let armatures = self.0.elements.armatures.iter();
                armatures.filter(|armature| armature.joint == group.name)
            };
            let mut column = |fill: &mut dyn FnMut(&mut [f64])| {
                let place = values.len();
                values.resize(place + numbers.len(), 0.0);
                fill(&mut values[place..]);
            };
            let (mut storage, mut bodies) = (Vec::new(), Vec::new());
            let own = c.rows.of(lambda, &mut storage);
            let slopes = c.slopes(&s.slots);
            let [mut unit, mut own_a, mut inertial, mut own_v] = [const { Vec::new() }; 4];
            unit.resize(space.n_v() * c.site.bodies.len(), 0.0);
            c.site.own_rates(a, &mut own_a);
            c.site.own_rates(of_armatures, &mut inertial);
            c.site.own_rates(v, &mut own_v);
            for (k, body) in c.site.bodies.iter().enumerate() {
                let Some(body) = body.moving() else {
                    continue;
                };
                bodies.push(space.columns_of(body));
                for dof in 0..space.n_v() {
                    let at = space.n_v() * k + dof;
                    unit[at] = 1.0;
                    column(&mut |out| {
                        slopes.power(own, &unit, out);
                        for armature in armatures() {
                            armature.add_slopes(&s.slots, c.spec(), [&unit, &inertial], out);
                        }
                    });
                    unit[at] = 0.0;
                }
            }
            let holonomic = c.rows.holonomic.len();
            let mut unit = vec![0.0; c.rows.len()];
            for i in 0..unit.len() {
                unit[i] = 1.0;
                column(&mut |out| slopes.residual(&unit, &own_a, out));
                if moves {
                    column(&mut |out| slopes.power(&unit, &own_v, out));
                }
                if i < holonomic {
                    column(&mut |out| slopes.phi(&unit[..holonomic], out));
                }
                unit[i] = 0.0;
            }
            each.push(OfConstraint {
                numbers,
                bodies,
                rows: c.rows.clone(),
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
    /// Computes one gradient and writes it to `out`. y has n_v values; y_λ, w_v and w_q have m + h
    /// values each.
    ///
    /// # Panics
    /// Panics if a slice is too short.
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
            for columns in &c.bodies {
                y[columns.clone()].iter().for_each(|y| add(*y));
            }
            for row in &c.rows {
                add(y_lambda[row]);
                if self.moves {
                    add(w_v[row]);
                }
                if c.rows.holonomic.contains(&row) {
                    add(w_q[row]);
                }
            }
        }
    }
}
