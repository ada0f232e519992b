//! Derivatives of the rows with respect to the values stored by the constraints at one
//! configuration.

use std::cell::OnceCell;

use joints::Slopes;

use super::Data;
use crate::element::PlacedConstraint;
use crate::rows::RowRanges;
use crate::system::Scratch;

/// The derivatives of Φ and C with respect to the values stored by the constraints, at the
/// configuration in a work space. The derivatives of a constraint are computed and stored at the
/// first request.
pub struct DataSlopes<'a> {
    data: Data<'a>,
    s: &'a Scratch,
    phi: Vec<OnceCell<Slopes>>,
    c: Vec<OnceCell<Slopes>>,
}

impl<'m> Data<'m> {
    /// Returns the derivatives of the rows with respect to all values stored by the constraints.
    #[must_use]
    pub fn slopes<'a>(self, s: &'a Scratch) -> DataSlopes<'a>
    where
        'm: 'a,
    {
        let empty = vec![OnceCell::new(); self.0.elements.constraints.len()];
        DataSlopes {
            data: self,
            s,
            phi: empty.clone(),
            c: empty,
        }
    }
}

impl DataSlopes<'_> {
    /// Adds `factor` times the gradient of `λᵀ·C·v` with respect to all values stored by the
    /// constraints to `out`. `lambda` has m + h values, and `v` has n_v values.
    pub fn add_power(&self, lambda: &[f64], v: &[f64], factor: f64, out: &mut [f64]) {
        let mut rates = Vec::new();
        self.add(
            (lambda, RowRanges::clone),
            factor,
            out,
            |k, c, lambda, own| {
                c.site.own_rates(v, &mut rates);
                let slopes = self.c[k].get_or_init(|| c.slopes_of_c(&self.s.slots));
                slopes.power(lambda, &rates, own);
            },
        );
    }

    /// Adds `factor` times the gradient of `λᵀ·Φ` with respect to all values stored by the
    /// constraints to `out`. `lambda` must have at least m values.
    pub fn add_phi(&self, lambda: &[f64], factor: f64, out: &mut [f64]) {
        let of_phi = |rows: &RowRanges| RowRanges {
            holonomic: rows.holonomic.clone(),
            nonholonomic: 0..0,
        };
        self.add((lambda, of_phi), factor, out, |k, c, lambda, own| {
            let slopes = self.phi[k].get_or_init(|| c.slopes_of_phi(&self.s.slots));
            slopes.phi(lambda, own);
        });
    }

    /// Adds `factor` times a gradient to `out`; `kernel` computes the gradient for constraint k and
    /// the multipliers of some of its rows.
    fn add(
        &self,
        (lambda, some): (&[f64], fn(&RowRanges) -> RowRanges),
        factor: f64,
        out: &mut [f64],
        mut kernel: impl FnMut(usize, &PlacedConstraint, &[f64], &mut [f64]),
    ) {
        let (mut own, mut storage) = (Vec::new(), Vec::new());
        for (k, (c, numbers)) in self.data.numbered().enumerate() {
            let rows = some(&c.rows);
            let lambda = rows.of(lambda, &mut storage);
            if numbers.is_empty() || lambda.iter().all(|l| *l == 0.0) {
                continue;
            }
            own.clear();
            own.resize(numbers.len(), 0.0);
            kernel(k, c, lambda, &mut own);
            for (out, own) in out[numbers].iter_mut().zip(&own) {
                *out += factor * own;
            }
        }
    }
}
