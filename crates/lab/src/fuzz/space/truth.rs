//! What exact arithmetic says of a drawing: ranks, and what of the reactions is unique.

use exact::Exact;
use num_bigint::BigInt;
use num_traits::{Signed, Zero};

use super::drawing::{Drawing, Side};
use super::ratio::{Ratio, quotient, whole_multiples};
use super::rows::{self, Owner, Row, Wrench};
use super::vector::Vector;

/// The rows of a drawing and the results for them.
pub struct Truth<'a> {
    /// The drawing.
    pub drawing: &'a Drawing,
    /// Its rows, in the order of a file.
    pub rows: Vec<Row>,
    /// Multiples of the wrenches of the rows on the second body in whole numbers.
    wrenches: Vec<Vec<BigInt>>,
    /// The factor of each row.
    factors: Vec<Ratio>,
    /// These rows over the velocities of all bodies, six columns each.
    whole: Vec<Vec<BigInt>>,
    exact: Exact,
}

/// A wrench on the first body of a joint or drive, about its place, in the axes of the ground, in a
/// unit of its own.
#[derive(Clone, Debug)]
pub struct Reaction([BigInt; 6]);

impl Reaction {
    /// Whether component `k` of Fx, Fy, Fz, Tx, Ty, Tz is zero.
    #[must_use]
    pub fn is_zero(&self, k: usize) -> bool {
        self.0[k].is_zero()
    }

    /// Its six numbers, the largest of size 1.
    #[must_use]
    pub fn rounded(&self) -> [f64; 6] {
        let largest = self.0.iter().map(Signed::abs).max();
        let largest = largest.filter(|x| !x.is_zero());
        let one = BigInt::from(1);
        self.0
            .each_ref()
            .map(|x| quotient(x, largest.as_ref().unwrap_or(&one)))
    }
}

impl<'a> Truth<'a> {
    /// Eliminates the rows of a drawing.
    #[must_use]
    pub fn of(drawing: &'a Drawing) -> Self {
        let rows = rows::rows(drawing);
        let whole = rows
            .iter()
            .map(|row| whole_multiples(&row.wrench.numbers()));
        let (wrenches, factors): (Vec<Vec<BigInt>>, Vec<Ratio>) = whole.unzip();
        let placed = rows.iter().zip(&wrenches);
        let placed =
            placed.map(|(row, wrench)| on_bodies(drawing, sides(drawing, row.owner), wrench));
        let whole: Vec<Vec<BigInt>> = placed.collect();
        Self {
            drawing,
            exact: Exact::of_whole(whole.clone()),
            rows,
            wrenches,
            factors,
            whole,
        }
    }

    /// rank C
    #[must_use]
    pub fn rank(&self) -> usize {
        self.exact.rank()
    }

    /// Number of rows minus rank.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.rows.len() - self.rank()
    }

    /// Number of velocities minus rank.
    #[must_use]
    pub fn mobility(&self) -> usize {
        6 * self.drawing.bodies.len() - self.rank()
    }

    /// The indices of rows with a property.
    pub fn rows_where(&self, wanted: impl Fn(&Row) -> bool) -> Vec<usize> {
        let rows = self.rows.iter().enumerate();
        rows.filter(|(_, row)| wanted(row))
            .map(|(i, _)| i)
            .collect()
    }

    /// The rows of a joint or drive.
    #[must_use]
    pub fn rows_of(&self, owner: Owner) -> Vec<usize> {
        self.rows_where(|row| row.owner == owner)
    }

    /// The rank of some rows.
    #[must_use]
    pub fn rank_of(&self, rows: &[usize]) -> usize {
        self.select(rows).rank()
    }

    fn select(&self, rows: &[usize]) -> Exact {
        Exact::of_whole(rows.iter().map(|&i| self.whole[i].clone()).collect())
    }

    fn without(&self, deleted: &[usize]) -> Vec<usize> {
        let all = 0..self.rows.len();
        all.filter(|i| !deleted.contains(i)).collect()
    }

    /// Whether the rank is unchanged without some rows.
    #[must_use]
    pub fn keeps_motion(&self, deleted: &[usize]) -> bool {
        self.rank_of(&self.without(deleted)) == self.rank()
    }

    /// Whether the reaction of these rows is the same in all solutions after other rows are
    /// deleted.
    #[must_use]
    pub fn is_unique_without(&self, rows: &[usize], deleted: &[usize]) -> bool {
        let left = self.without(deleted);
        let (own, others): (Vec<usize>, Vec<usize>) = left.iter().partition(|i| rows.contains(i));
        self.rank_of(&left) == self.rank_of(&own) + self.rank_of(&others)
    }

    /// Whether the multiplier of a row is the same in all solutions: the row is in no dependency.
    #[must_use]
    pub fn row_is_unique(&self, row: usize) -> bool {
        self.exact.row_is_unique(row)
    }

    /// The coefficients of these rows, as they are in [`Truth::rows`], if they are minimally
    /// dependent; the largest of size 1, for directions of length 1.
    #[must_use]
    pub fn circuit(&self, rows: &[usize]) -> Option<Vec<f64>> {
        let exact = self.select(rows);
        let [z] = exact.null_space() else { return None };
        if z.iter().any(Zero::is_zero) {
            return None;
        }
        let largest = z.iter().map(Signed::abs).max()?;
        let length = |i: usize| {
            let Wrench { force, moment } = &self.rows[i].wrench;
            let direction = if force.is_zero() { moment } else { force };
            direction.square().root() * self.factors[i].rounded()
        };
        let own = rows
            .iter()
            .zip(z)
            .map(|(&i, z)| quotient(z, &largest) * length(i));
        let own: Vec<f64> = own.collect();
        let most = own.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        Some(own.into_iter().map(|x| x / most).collect())
    }

    /// The wrenches of some rows of one joint on its second body without loads, about the origin of
    /// the ground, one for each independent solution; some may be 0.
    fn free_at_origin(&self, rows: &[usize]) -> Vec<[BigInt; 6]> {
        let sum = |z: &Vec<BigInt>| {
            [0, 1, 2, 3, 4, 5].map(|k| rows.iter().map(|&i| &z[i] * &self.wrenches[i][k]).sum())
        };
        self.exact.null_space().iter().map(sum).collect()
    }

    /// The wrenches on the first body without loads about a point, one for each independent
    /// solution; some may be 0.
    #[must_use]
    pub fn free_about(&self, owner: Owner, point: &Vector) -> Vec<Reaction> {
        self.free_of(&self.rows_of(owner), point)
    }

    /// The same for some rows of one joint.
    #[must_use]
    pub fn free_of(&self, rows: &[usize], point: &Vector) -> Vec<Reaction> {
        let (p, common) = whole_multiples(&point.0);
        // The point is p·(denominator)/(numerator) of the factor.
        let (d, n) = (common.denominator(), common.numerator());
        let about = |w: [BigInt; 6]| {
            let [x, y, z, a, b, c] = w;
            let arm = |i: &BigInt, f: &BigInt, j: &BigInt, g: &BigInt| d * &(i * f - j * g);
            let moment = [
                n * &a - arm(&p[1], &z, &p[2], &y),
                n * &b - arm(&p[2], &x, &p[0], &z),
                n * &c - arm(&p[0], &y, &p[1], &x),
            ];
            let force = [x, y, z].map(|f| n * f);
            let [x, y, z] = force;
            let [a, b, c] = moment;
            Reaction([x, y, z, a, b, c].map(|x| -x))
        };
        self.free_at_origin(rows).into_iter().map(about).collect()
    }

    /// The bodies that a joint or drive acts on.
    #[must_use]
    pub fn sides(&self, owner: Owner) -> [Side; 2] {
        sides(self.drawing, owner)
    }

    /// The place of a joint, or of the joint of a drive; the origin if it carries couples only.
    #[must_use]
    pub fn place(&self, owner: Owner) -> Vector {
        let joint = match owner {
            Owner::Joint(k) => k,
            Owner::Drive(k) => self.drawing.drives[k].joint,
        };
        let place = self.drawing.joints[joint].kind.place();
        place.cloned().unwrap_or_else(Vector::zero)
    }

    /// The same about the place of the joint.
    #[must_use]
    pub fn free_wrenches(&self, owner: Owner) -> Vec<Reaction> {
        self.free_about(owner, &self.place(owner))
    }

    /// Whether the sum of `force·F + moment·M` over joints is the same in all solutions, F and M
    /// on the first body about the place of each joint.
    #[must_use]
    pub fn sum_is_unique(&self, terms: &[(Owner, Wrench)]) -> bool {
        let mut sums = vec![Ratio::zero(); self.exact.null_space().len()];
        for (owner, weights) in terms {
            let place = self.place(*owner);
            // The factor that makes the reactions of this joint whole.
            let unit = whole_multiples(&place.0).1.numerator().clone();
            for (sum, free) in sums.iter_mut().zip(self.free_about(*owner, &place)) {
                for (weight, x) in weights.numbers().iter().zip(&free.0) {
                    *sum = &*sum + &(weight * &Ratio::new(x.clone(), unit.clone()));
                }
            }
        }
        sums.iter().all(Ratio::is_zero)
    }

    /// Number of independent directions in which the reaction is not unique.
    #[must_use]
    pub fn free_directions(&self, owner: Owner) -> usize {
        self.free_directions_of(&self.rows_of(owner))
    }

    /// Number of independent wrenches that the joint can carry.
    #[must_use]
    pub fn carried_directions(&self, owner: Owner) -> usize {
        self.carried_directions_of(&self.rows_of(owner))
    }

    /// The same for some rows of one joint.
    #[must_use]
    pub fn free_directions_of(&self, rows: &[usize]) -> usize {
        let free = self.free_at_origin(rows).into_iter().map(Vec::from);
        Exact::of_whole(free.collect()).rank()
    }

    /// The same for some rows of one joint.
    #[must_use]
    pub fn carried_directions_of(&self, rows: &[usize]) -> usize {
        let own = rows.iter().map(|&i| self.wrenches[i].clone());
        Exact::of_whole(own.collect()).rank()
    }
}

/// The row of C: the wrench on the second body, the opposite one on the first.
pub(super) fn on_bodies(drawing: &Drawing, sides: [Side; 2], wrench: &[BigInt]) -> Vec<BigInt> {
    let mut row = vec![BigInt::zero(); 6 * drawing.bodies.len()];
    for (side, sign) in sides.into_iter().zip([-1, 1]) {
        let Some(body) = side else { continue };
        for (entry, x) in row[6 * body..].iter_mut().zip(wrench) {
            *entry += x * sign;
        }
    }
    row
}

/// The bodies that a joint or drive acts on.
fn sides(drawing: &Drawing, owner: Owner) -> [Side; 2] {
    match owner {
        Owner::Joint(k) => drawing.joints[k].bodies,
        Owner::Drive(k) => drawing.joints[drawing.drives[k].joint].bodies,
    }
}
