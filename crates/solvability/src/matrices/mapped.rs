//! Decides which components and directions of a reaction `W·λ_X` are the same in all solutions.
//!
//! The module `basis` provides the rows and their null space, and the module `mechanism` provides
//! W.

use crate::limits::{LARGEST_ROUNDING, LARGEST_TURN, ROUNDING_OF_MAP};
use linalg::{Matrix, PivotedQr};
use rank::{CoefficientReading, ExactNullSpace, RankStatus};

use super::basis::{Basis, Noise, check_coefficients, combination, norm};
use super::error::QueryError;
use crate::verdict::{Judgement, Verdict};

/// Reason why a component is undecided. Within the tolerance of the data, it cannot be
/// distinguished from zero.
const TURNED: &str = "the tolerance leaves open whether the force has this component";

/// Whether a component of a force or torque is zero, given the uncertainty of its direction.
#[derive(Clone, Copy, Debug)]
enum ForceComponent {
    /// The component is not zero.
    Nonzero,
    /// The component is zero within the tolerance; `margin` is its margin without the tolerance.
    Zero { margin: f64 },
    /// The component is undecided: too large to count as zero, and too small to be certainly not
    /// zero.
    Undecided,
}

/// A map W (k × |X|) from the multipliers of rows X to components, and the image of the null space
/// under W.
#[derive(Clone, Debug)]
pub(crate) struct MultiplierMap<'a> {
    basis: &'a Basis,
    map: &'a Matrix,
    rows: Vec<usize>,
    /// `W·Z_X` with rows divided by their size.
    images: Matrix,
    /// Norms of the rows of `W·D_r⁻¹`. A norm is zero if the row is only rounding relative to the
    /// other rows.
    sizes: Vec<f64>,
    /// The largest entry of `sizes`.
    largest: f64,
    /// Uncertainty of the entries of W within a stated tolerance.
    wobble: Option<Matrix>,
    /// Whether each component is zero within a stated tolerance.
    within_tolerance: Vec<ForceComponent>,
}

impl<'a> MultiplierMap<'a> {
    pub(super) fn new(
        basis: &'a Basis,
        map: &'a Matrix,
        rows: Vec<usize>,
    ) -> Result<Self, QueryError> {
        (0..map.nrows()).try_for_each(|i| check_coefficients(map.row(i), rows.len()))?;
        let mut images = Matrix::zeros(map.nrows(), basis.z.ncols());
        let mut sizes: Vec<f64> = (0..map.nrows())
            .map(|i| basis.scaled_row(map.row(i), &rows, images.row_mut(i)))
            .collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        if basis.exact.is_none() {
            let rounding = basis.rounding_of_map() * largest;
            for (i, size) in sizes.iter_mut().enumerate() {
                if *size <= rounding {
                    images.row_mut(i).fill(0.0);
                    *size = 0.0;
                }
            }
        }
        Ok(Self {
            within_tolerance: vec![ForceComponent::Nonzero; sizes.len()],
            basis,
            map,
            rows,
            images,
            sizes,
            largest,
            wobble: None,
        })
    }

    /// Applies a stated tolerance to the components. The first `forces` components belong to a
    /// force, and the other components belong to a torque. The direction of a force or couple is
    /// uncertain by an angle, and its line of action is uncertain by a length. Both make the
    /// components uncertain. A component counts as zero if it is much smaller than the other
    /// components of its vector within this uncertainty.
    #[must_use]
    pub(crate) fn with_forces(mut self, forces: usize) -> Self {
        let (Some(turns), None) = (&self.basis.known.row_turn, &self.basis.exact) else {
            return self;
        };
        let known: Vec<[f64; 2]> = self.rows.iter().map(|&i| turns[i]).collect();
        let turn = known.iter().map(|[turn, _]| turn.min(LARGEST_TURN));
        let turn = turn.fold(0.0, f64::max);
        let (vectors, k) = ([0..forces, forces..self.sizes.len()], self.sizes.len());
        let size = |vector: usize, j: usize| {
            let parts = vectors[vector].clone().map(|k| self.map[(k, j)]);
            parts.fold(0.0, f64::hypot)
        };
        let wobble = |k: usize, j: usize| {
            let [turn, shift] = known[j];
            if k < forces {
                turn * size(0, j)
            } else {
                turn * size(1, j) + shift * size(0, j)
            }
        };
        self.wobble = Some(Matrix::from_fn(k, self.rows.len(), wobble));
        for vector in vectors {
            // The torque of a planar mechanism has no variable direction.
            if vector.start == forces && vector.len() < 2 {
                continue;
            }
            let whole = self.sizes[vector.clone()].iter().copied();
            let whole = whole.fold(0.0, f64::hypot);
            for i in vector {
                let share = self.sizes[i] / whole;
                // The first order is not valid for larger rotations.
                let is_near = turn >= LARGEST_TURN || share <= rank::BEYOND_DOUBT * turn;
                if share > rank::STATED_ZERO && is_near {
                    self.within_tolerance[i] = ForceComponent::Undecided;
                } else if share > 0.0 && share <= (1.0 / rank::BEYOND_DOUBT) * turn {
                    self.within_tolerance[i] = ForceComponent::Zero {
                        margin: self.margin(i),
                    };
                    self.images.row_mut(i).fill(0.0);
                    self.sizes[i] = 0.0;
                }
            }
        }
        self
    }

    /// Returns the norm of row k of `W·Z_X`, relative to the largest row of W.
    fn margin(&self, k: usize) -> f64 {
        match self.largest {
            // Zero is divided by zero, because a map of zeros has no reaction.
            0.0 => 0.0,
            largest => norm(self.images.row(k)) * (self.sizes[k] / largest),
        }
    }

    /// Returns the verdict on component `k`. The component is unique iff row k of `W·Z_X` is zero.
    /// The margin is relative to the largest row of W. A row of W that is only rounding relative to
    /// the other rows counts as zero, unless the entries are exact. If the component counts as zero
    /// only within a stated tolerance, the verdict states this and keeps its margin.
    ///
    /// # Errors
    /// Returns an error if the component does not exist.
    pub(crate) fn component(&self, k: usize) -> Result<Judgement, QueryError> {
        if k >= self.sizes.len() {
            return Err(QueryError::ComponentOutOfRange {
                component: k,
                components: self.sizes.len(),
            });
        }
        let noise = self.noise(k, self.largest);
        let (map, rows) = (self.map.row(k), &self.rows);
        let vanishes = |z: &ExactNullSpace| z.annihilates(combination(map, rows));
        let judged = self.basis.judge(self.margin(k), noise, vanishes);
        Ok(match self.within_tolerance[k] {
            _ if !judged.verdict.is_unique() => judged,
            ForceComponent::Nonzero => judged,
            ForceComponent::Zero { margin } => Judgement {
                margin,
                within_tolerance: margin > noise.rounding,
                ..judged
            },
            // The component is unique if its multipliers are unique. Otherwise the component is
            // undecided.
            ForceComponent::Undecided => {
                let noise = self.basis.noise_of_row(map, rows, self.largest);
                match self.basis.judge(judged.margin, noise, vanishes) {
                    own if own.verdict.is_unique() => own,
                    own => Judgement::new(
                        Verdict::Undecided {
                            reason: TURNED.to_owned(),
                        },
                        own.margin,
                    ),
                }
            }
        })
    }

    /// Returns whether component `k` is zero for all multipliers. In this case, row k of W is so
    /// small relative to the largest row that the component is unique for this reason alone.
    ///
    /// # Errors
    /// Returns the same errors as [`MultiplierMap::component`].
    pub(crate) fn is_zero(&self, k: usize) -> Result<bool, QueryError> {
        let judged = self.component(k)?;
        let size = self.sizes[k];
        if size == 0.0 {
            return Ok(true);
        }
        if size == self.largest || self.basis.exact.is_some() || !judged.verdict.is_unique() {
            return Ok(false);
        }
        let whole = norm(self.images.row(k));
        let own = self
            .basis
            .known
            .readings
            .read(whole, self.noise(k, size).known);
        Ok(own == CoefficientReading::NonZero)
    }

    /// Returns the directions in which the reaction is unique. The directions are a basis of the
    /// left null space of `W·Z_X`. The directions are unit vectors with k entries, the largest of
    /// which is positive.
    ///
    /// # Errors
    /// Returns an error if the number of directions is undecided.
    pub(crate) fn unique_directions(&self) -> Result<Vec<Vec<f64>>, QueryError> {
        if let RankStatus::Undecided(doubt) = self.basis.known.status {
            return Err(QueryError::Rank(doubt));
        }
        let k = self.sizes.len();
        let qr = PivotedQr::of_columns(&self.images);
        let rank = match &self.basis.exact {
            Some(z) => {
                let rows = (0..k).map(|i| combination(self.map.row(i), &self.rows));
                z.rank_of(&rows.collect::<Vec<_>>())
            }
            None => {
                let noise = (0..k).map(|i| self.noise(i, self.sizes[i]).known);
                self.basis.clear_rank(&qr, noise.fold(0.0, f64::max))?
            }
        };
        if rank == 0 {
            return Ok((0..k).map(|i| unit(k, i)).collect());
        }
        let basis = qr.q_columns(rank..k);
        let direction = |j: usize| (0..k).map(|i| basis[(i, j)] / self.scale(i)).collect();
        Ok((0..k - rank)
            .map(|j| normalised(direction(j), self.nothing()))
            .collect())
    }

    /// Returns the largest component of the reaction, in the unit of margins, that counts as zero
    /// within a stated tolerance. The directions are unique because this component counts as zero.
    /// The value is zero if no component counts as zero.
    ///
    /// # Errors
    /// Returns the same errors as [`MultiplierMap::unique_directions`].
    pub(crate) fn directions_left_out(&self) -> Result<f64, QueryError> {
        let none = self
            .within_tolerance
            .iter()
            .map(|component| match component {
                ForceComponent::Zero { margin } => *margin,
                _ => 0.0,
            });
        if self.wobble.is_none() {
            return Ok(0.0);
        }
        let noise = (0..self.sizes.len()).map(|i| self.noise(i, self.sizes[i]));
        let (known, rounding) = noise.fold((0.0, 0.0), |(known, rounding), noise| {
            (
                f64::max(known, noise.known),
                f64::max(rounding, noise.rounding),
            )
        });
        let qr = PivotedQr::of_columns(&self.images);
        let rank = self.basis.clear_rank(&qr, known)?;
        let left = qr.r_diagonal().skip(rank).map(f64::abs);
        let left = left.chain(none).filter(|left| *left > rounding);
        Ok(left.fold(0.0, f64::max))
    }

    /// Returns the unique directions in which a reaction is possible. The returned directions are
    /// perpendicular to the directions in which the reaction is zero for all multipliers.
    pub(crate) fn live_directions(&self, unique: &[Vec<f64>]) -> Vec<Vec<f64>> {
        if unique.is_empty() {
            return Vec::new();
        }
        let idle = self.idle_directions();
        let live = unique.len().saturating_sub(idle.ncols());
        if idle.ncols() == 0 || live == 0 {
            return unique[..live].to_vec();
        }
        let k = self.sizes.len();
        let unique = Matrix::from_fn(k, unique.len(), |i, j| unique[j][i]);
        let idle_part = idle.product(&idle.transpose().product(&unique));
        let rest = Matrix::from_fn(k, unique.ncols(), |i, j| unique[(i, j)] - idle_part[(i, j)]);
        let basis = PivotedQr::of_columns(&rest).q_columns(0..live);
        let column = |j: usize| (0..k).map(|i| basis[(i, j)]).collect();
        let rounding = self.nothing().max(ROUNDING_OF_MAP);
        (0..live).map(|j| normalised(column(j), rounding)).collect()
    }

    /// Returns the size below which a component of a unit vector is rounding.
    fn nothing(&self) -> f64 {
        self.basis.known.tolerance.min(LARGEST_ROUNDING)
    }

    /// Returns an orthonormal basis of the left null space of W, one vector in each column. The
    /// rank is determined from rows scaled to equal size.
    fn idle_directions(&self) -> Matrix {
        let k = self.sizes.len();
        let equal = Matrix::from_fn(k, self.rows.len(), |i, j| match self.sizes[i] {
            0.0 => 0.0,
            size => self.map[(i, j)] * self.basis.known.row_factor[self.rows[j]] / size,
        });
        let qr = PivotedQr::of_columns(&equal);
        let rounding = self.basis.rounding_of_map();
        let rank = qr.r_diagonal().filter(|r| r.abs() > rounding).count();
        if rank == k {
            return Matrix::zeros(k, 0);
        }
        let idle = qr.q_columns(rank..k);
        let idle = Matrix::from_fn(k, k - rank, |i, j| idle[(i, j)] / self.scale(i));
        PivotedQr::of_columns(&idle).q_columns(0..k - rank)
    }

    /// Returns the factor that converts components of equal size to the units of the map.
    fn scale(&self, i: usize) -> f64 {
        match self.sizes[i] {
            0.0 => 1.0,
            size => size,
        }
    }

    /// Returns the noise of row k of `W·D_r·Z_X / size`.
    fn noise(&self, k: usize, size: f64) -> Noise {
        let of_rows = self.basis.noise_of_row(self.map.row(k), &self.rows, size);
        match &self.wobble {
            Some(wobble) if size > 0.0 => {
                let rows = self.rows.iter().zip(wobble.row(k));
                let of_map = rows.map(|(&i, wobble)| {
                    wobble * self.basis.known.row_factor[i] * norm(self.basis.z.row(i)) / size
                });
                of_rows.within_tolerance(of_map.fold(0.0, f64::hypot))
            }
            _ => of_rows,
        }
    }
}

fn unit(n: usize, i: usize) -> Vec<f64> {
    (0..n).map(|k| if k == i { 1.0 } else { 0.0 }).collect()
}

/// Returns the unit vector along x with a positive largest entry. Rounding is set to zero.
fn normalised(mut x: Vec<f64>, rounding: f64) -> Vec<f64> {
    let largest = x
        .iter()
        .fold(0.0_f64, |a, &b| if b.abs() > a.abs() { b } else { a });
    let size = norm(&x) * largest.signum();
    for x in &mut x {
        *x /= size;
        if x.abs() <= rounding {
            *x = 0.0;
        }
    }
    x
}
