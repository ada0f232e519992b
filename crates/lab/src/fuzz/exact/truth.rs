//! Results of exact arithmetic for a mechanism: ranks, dependencies, and the unique parts of the
//! reactions.

use std::collections::BTreeSet;
use std::ops::Deref;

use exact::Exact;
use num_bigint::BigInt;
use num_traits::{Signed, Zero};

use super::wrench::{Owner, Side, Wrench, Wrenches};
use crate::fuzz::space::ratio::{Ratio, quotient, whole_multiples};
use crate::fuzz::space::vector::Vector;

/// Coefficients of dependencies must be correct to this fraction of the largest coefficient,
/// because they are computed in double precision.
const ROUNDING: f64 = 1e-9;

/// Tolerance for each metre by which a scene was moved. Coordinates are accurate to 1e-16 times the
/// distance, and small angles between lines increase the rounding errors by a factor of up to ten
/// thousand.
const ROUNDING_PER_METRE: f64 = 1e-12;

/// Returns the tolerance for coefficients of dependencies of a scene at a distance (m) from the
/// origin.
fn rounding_at(distance: f64) -> f64 {
    ROUNDING.max(ROUNDING_PER_METRE * distance)
}

/// The rows of a mechanism and the results for them.
#[derive(Clone)]
pub struct Truth {
    wrenches: Wrenches,
    /// The tolerance for components of directions and coefficients of dependencies, relative to the
    /// largest component or coefficient.
    pub rounding: f64,
    /// Integer multiples of the rows, as wrenches on the first body of the element.
    first: Vec<[BigInt; 6]>,
    /// The factor of each row.
    factors: Vec<Ratio>,
    /// The same multiples of the rows, as coefficients of the velocities of all bodies.
    whole: Vec<Vec<BigInt>>,
    exact: Exact,
}

impl Deref for Truth {
    type Target = Wrenches;

    fn deref(&self) -> &Wrenches {
        &self.wrenches
    }
}

/// A wrench on the first body of a joint or drive, about its reference point, in integers.
#[derive(Clone, Debug)]
pub struct Reaction {
    numbers: [BigInt; 6],
    /// The wrench is the integers divided by this unit.
    unit: BigInt,
}

impl Reaction {
    /// Whether component `k` of Fx, Fy, Fz, Tx, Ty, Tz in the axes of the drawing is zero.
    #[must_use]
    pub fn is_zero(&self, k: usize) -> bool {
        self.numbers[k].is_zero()
    }

    /// Returns the largest absolute value of the integers, at least 1.
    #[must_use]
    pub fn size(&self) -> BigInt {
        largest(&self.numbers)
    }
}

/// Returns the largest absolute value of some integers, at least 1.
#[must_use]
pub fn largest(numbers: &[BigInt]) -> BigInt {
    let one = BigInt::from(1);
    numbers.iter().map(Signed::abs).fold(one, BigInt::max)
}

impl Truth {
    /// Eliminates the rows of a mechanism.
    #[must_use]
    pub fn of(wrenches: impl Into<Wrenches>) -> Self {
        let wrenches = wrenches.into();
        let (mut first, mut factors, mut whole) = (Vec::new(), Vec::new(), Vec::new());
        for row in &wrenches.rows {
            let element = wrenches.element(row.owner);
            let numbers = row.loads.iter().flat_map(|(_, w)| w.numbers());
            let (numbers, factor) = whole_multiples(&numbers.collect::<Vec<_>>());
            let loads = || {
                let sides = row.loads.iter().map(|(side, _)| *side);
                sides.zip(numbers.chunks_exact(6))
            };
            first.push(sum(loads(), element.sides[0]));
            factors.push(factor);
            whole.push(over_velocities(&wrenches, loads()));
        }
        Self {
            rounding: rounding_at(wrenches.distance),
            exact: Exact::of_whole(whole.clone()),
            wrenches,
            first,
            factors,
            whole,
        }
    }

    /// Returns the rank of C.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.exact.rank()
    }

    /// Returns the number of rows minus the rank.
    #[must_use]
    pub fn redundancy(&self) -> usize {
        self.rows.len() - self.rank()
    }

    /// Returns the number of velocities minus the rank.
    #[must_use]
    pub fn mobility(&self) -> usize {
        self.velocities.len() * self.bodies - self.rank()
    }

    /// Returns the rank of the matrix of some rows.
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

    /// Whether the rank does not change if these rows are deleted.
    #[must_use]
    pub fn keeps_motion(&self, deleted: &[usize]) -> bool {
        self.rank_of(&self.without(deleted)) == self.rank()
    }

    /// Whether the reaction of these rows is the same in all solutions:
    /// `rank C = rank C_X + rank of the other rows`.
    #[must_use]
    pub fn is_unique(&self, rows: &[usize]) -> bool {
        self.is_unique_without(rows, &[])
    }

    /// Whether the reaction of these rows is the same in all solutions after other rows are
    /// deleted.
    #[must_use]
    pub fn is_unique_without(&self, rows: &[usize], deleted: &[usize]) -> bool {
        let left = self.without(deleted);
        let (own, others): (Vec<usize>, Vec<usize>) = left.iter().partition(|i| rows.contains(i));
        self.rank_of(&left) == self.rank_of(&own) + self.rank_of(&others)
    }

    /// Whether the multiplier of a row is the same in all solutions, that is, whether the row is in
    /// no dependency.
    #[must_use]
    pub fn row_is_unique(&self, row: usize) -> bool {
        self.exact.row_is_unique(row)
    }

    /// Returns the coefficients of these rows, as integer multiples, if the rows are minimally
    /// dependent.
    #[must_use]
    pub fn circuit(&self, rows: &[usize]) -> Option<Vec<BigInt>> {
        let exact = self.select(rows);
        match exact.null_space() {
            [z] if !z.iter().any(Zero::is_zero) => Some(z.clone()),
            _ => None,
        }
    }

    /// Returns the coefficients in the normalisation of the program: for the rows of the program,
    /// with a largest absolute value of 1.
    #[must_use]
    pub fn coefficients(&self, rows: &[usize], circuit: &[BigInt]) -> Vec<f64> {
        let largest = largest(circuit);
        let own = rows
            .iter()
            .zip(circuit)
            .map(|(&i, z)| quotient(z, &largest) * self.factors[i].rounded() * self.rows[i].length);
        let own: Vec<f64> = own.collect();
        let most = own.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        own.into_iter().map(|x| x / most).collect()
    }

    /// Returns the connected components of the circuits: sets of rows that are in common
    /// dependencies directly or through other rows.
    #[must_use]
    pub fn components_of_circuits(&self) -> Vec<BTreeSet<usize>> {
        let mut basis: Vec<usize> = Vec::new();
        let mut components: Vec<BTreeSet<usize>> = Vec::new();
        for i in 0..self.rows.len() {
            basis.push(i);
            let exact = self.select(&basis);
            let [z] = exact.null_space() else { continue };
            basis.pop();
            let with_i = basis.iter().chain([&i]).zip(z);
            let mut joined: BTreeSet<usize> = with_i
                .filter(|(_, z)| !z.is_zero())
                .map(|(i, _)| *i)
                .collect();
            components.retain(|other| {
                let touches = !other.is_disjoint(&joined);
                if touches {
                    joined.extend(other);
                }
                !touches
            });
            components.push(joined);
        }
        components
    }

    /// Returns the wrench about the origin on the first body of a joint, for given multipliers of
    /// some rows of this joint.
    fn wrench<'z>(&self, rows: impl Iterator<Item = (usize, &'z BigInt)>) -> [BigInt; 6] {
        let mut wrench = [0; 6].map(BigInt::from);
        for (i, z) in rows {
            for (total, x) in wrench.iter_mut().zip(&self.first[i]) {
                *total += x * z;
            }
        }
        wrench
    }

    /// Returns the wrenches in the self-stresses that some rows of one joint exert on the first
    /// body of the joint, about the origin of the drawing. There is one wrench for each independent
    /// self-stress; some may be 0.
    fn free_at_origin(&self, rows: &[usize]) -> Vec<[BigInt; 6]> {
        let of = |z: &Vec<BigInt>| self.wrench(rows.iter().map(|&i| (i, &z[i])));
        self.exact.null_space().iter().map(of).collect()
    }

    /// Returns the wrenches on the first body in the self-stresses, about a point. There is one
    /// wrench for each independent self-stress; some may be 0.
    #[must_use]
    pub fn free_about(&self, owner: Owner, point: &Vector) -> Vec<Reaction> {
        self.free_of(&self.rows_of(owner), point)
    }

    /// Returns the same wrenches for some rows of one joint.
    #[must_use]
    pub fn free_of(&self, rows: &[usize], point: &Vector) -> Vec<Reaction> {
        let free = self.free_at_origin(rows).into_iter();
        free.map(|w| about(w, point)).collect()
    }

    /// Returns the same wrenches about the reference point of the joint; `None` if the point is not
    /// in the drawing.
    #[must_use]
    pub fn free_wrenches(&self, owner: Owner) -> Option<Vec<Reaction>> {
        let place = self.element(owner).place.as_ref()?;
        Some(self.free_about(owner, place))
    }

    /// Returns the wrench of a joint in a circuit, in the same form.
    #[must_use]
    pub fn carried(&self, owner: Owner, rows: &[usize], circuit: &[BigInt]) -> Option<Reaction> {
        let own = rows.iter().copied().zip(circuit);
        let own = own.filter(|(i, _)| self.rows[*i].owner == owner);
        let place = self.element(owner).place.as_ref()?;
        Some(about(self.wrench(own), place))
    }

    /// Returns the rational part and the factor of √k of component `k` of a reaction in the world.
    /// The unit is the same for all reactions.
    fn parts(&self, reaction: &Reaction, k: usize) -> [BigInt; 2] {
        [0, 1].map(|part| {
            let terms = self.wrenches.components[k].terms.iter();
            terms.map(|(i, x)| &x[part] * &reaction.numbers[*i]).sum()
        })
    }

    /// Whether component `k` of a reaction is exactly zero.
    #[must_use]
    pub fn is_zero(&self, reaction: &Reaction, k: usize) -> bool {
        self.parts(reaction, k).iter().all(Zero::is_zero)
    }

    /// Returns the components of a reaction in the world, divided by a number that is not zero.
    #[must_use]
    pub fn rounded(&self, reaction: &Reaction, divisor: &BigInt) -> Vec<f64> {
        let root = f64::from(self.stretch).sqrt();
        let component = |k: usize| {
            let unit = &reaction.unit * &self.wrenches.components[k].unit * divisor;
            let [a, b] = self.parts(reaction, k).map(|x| quotient(&x, &unit));
            a + root * b
        };
        (0..self.wrenches.components.len()).map(component).collect()
    }

    /// Whether a combination of two components of reactions is the same in all solutions. The
    /// coefficients are such that a circuit does not change the combination. The component `N` is
    /// the only multiplier of its joint. Returns `None` if a component is not rational.
    #[must_use]
    pub fn pair_is_unique(
        &self,
        (rows, circuit): (&[usize], &[BigInt]),
        pair: [(Owner, &str); 2],
    ) -> Option<bool> {
        let mut parts = Vec::new();
        for (owner, component) in pair {
            let mut coefficients = Vec::new();
            for i in self.rows_of(owner) {
                coefficients.push((i, self.coefficient(i, component)?));
            }
            let in_circuit = |i: &usize| rows.iter().position(|row| row == i);
            let load: BigInt = coefficients
                .iter()
                .filter_map(|(i, c)| Some(c * &circuit[in_circuit(i)?]))
                .sum();
            parts.push((coefficients, load));
        }
        let mut l = vec![BigInt::zero(); self.rows.len()];
        for (own, other, sign) in [(0, 1, 1), (1, 0, -1)] {
            for (i, c) in &parts[own].0 {
                l[*i] += c * &parts[other].1 * BigInt::from(sign);
            }
        }
        Some(self.exact.determines(&l))
    }

    /// Returns a component of the reaction for a unit multiplier of a row, times a factor that is
    /// the same for all rows of a joint. Returns `None` if the product is not an integer.
    fn coefficient(&self, row: usize, component: &str) -> Option<BigInt> {
        if component == "N" {
            return Some(BigInt::from(1));
        }
        let mut components = self.wrenches.components.iter();
        let k = components.position(|c| c.name == component)?;
        let place = self.element(self.rows[row].owner).place.as_ref()?;
        let reaction = about(self.first[row].clone(), place);
        let [a, b] = self.parts(&reaction, k);
        // A component is rational, or a multiple of √k.
        let has = |part: usize| {
            let mut terms = self.wrenches.components[k].terms.iter();
            terms.any(|(_, x)| !x[part].is_zero())
        };
        match (has(0), has(1)) {
            (true, true) => None,
            (false, true) => Some(b),
            _ => Some(a),
        }
    }

    /// Whether the sum of `force·F + moment·M` over joints is the same in all solutions. F and M
    /// act on the first body about the reference point of each joint, in the axes of the drawing.
    #[must_use]
    pub fn sum_is_unique(&self, terms: &[(Owner, Wrench)]) -> bool {
        let mut sums = vec![Ratio::zero(); self.exact.null_space().len()];
        for (owner, weights) in terms {
            let Some(all) = self.free_wrenches(*owner) else {
                return false;
            };
            for (sum, free) in sums.iter_mut().zip(all) {
                for (weight, x) in weights.numbers().iter().zip(&free.numbers) {
                    *sum = &*sum + &(weight * &Ratio::new(x.clone(), free.unit.clone()));
                }
            }
        }
        sums.iter().all(Ratio::is_zero)
    }

    /// Returns the number of independent directions in which the reaction of some rows of one joint
    /// is not unique.
    #[must_use]
    pub fn free_directions(&self, rows: &[usize]) -> usize {
        let free = self.free_at_origin(rows).into_iter().map(Vec::from);
        Exact::of_whole(free.collect()).rank()
    }

    /// Returns the number of independent wrenches that some rows of one joint can exert on its
    /// first body.
    #[must_use]
    pub fn carried_directions(&self, rows: &[usize]) -> usize {
        let own = rows.iter().map(|&i| self.first[i].to_vec());
        Exact::of_whole(own.collect()).rank()
    }
}

/// Returns the sum of the loads on a side.
fn sum<'l>(loads: impl Iterator<Item = (Side, &'l [BigInt])>, wanted: Side) -> [BigInt; 6] {
    let mut sum = [0; 6].map(BigInt::from);
    for (_, load) in loads.filter(|(side, _)| *side == wanted) {
        for (total, x) in sum.iter_mut().zip(load) {
            *total += x;
        }
    }
    sum
}

/// Returns the row of C: the loads on all bodies.
fn over_velocities<'l>(
    wrenches: &Wrenches,
    loads: impl Iterator<Item = (Side, &'l [BigInt])>,
) -> Vec<BigInt> {
    let each = wrenches.velocities.len();
    let mut row = vec![BigInt::zero(); each * wrenches.bodies];
    for (side, load) in loads {
        let Some(body) = side else { continue };
        for (entry, &k) in row[each * body..].iter_mut().zip(&wrenches.velocities) {
            *entry += &load[k];
        }
    }
    row
}

/// Transfers a wrench about the origin to a point.
fn about([x, y, z, a, b, c]: [BigInt; 6], point: &Vector) -> Reaction {
    // The point is p divided by the factor.
    let (p, common) = whole_multiples(&point.0);
    let (d, n) = (common.denominator(), common.numerator());
    let arm = |i: &BigInt, f: &BigInt, j: &BigInt, g: &BigInt| d * &(i * f - j * g);
    let moment = [
        n * &a - arm(&p[1], &z, &p[2], &y),
        n * &b - arm(&p[2], &x, &p[0], &z),
        n * &c - arm(&p[0], &y, &p[1], &x),
    ];
    let [a, b, c] = moment;
    Reaction {
        numbers: [n * &x, n * &y, n * &z, a, b, c],
        unit: n.clone(),
    }
}
