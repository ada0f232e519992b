//! The convex hull of the solutions y_m, for rows of a matrix in groups.

use std::collections::{BTreeMap, BTreeSet};
use std::iter;

use linalg::kernels::{dot, norm};
use linalg::{DisjointSets, Matrix, PivotedQr, RowBasis, symmetric_eigen};

use super::separation::is_separated;
use crate::limits::{
    CLEAR_MINOR, CLEAR_OF_ZERO, CORNER_POINTS, ELASTIC_SETS, EQUAL_LEVERAGE, LARGEST_EXPONENT,
    MAGNITUDE_POINTS, MERGED_POINTS, RANDOM_SAMPLES, SAMPLE_WORK, SAMPLED_RATIO, TIED_ENDS,
    ZERO_MINOR,
};

/// A component of a load: `value + row·y` for the solution `λ₀ + Z·y`.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// The load to which it belongs; loads follow each other.
    pub(super) group: usize,
    /// Coefficients of y.
    pub(super) row: Vec<f64>,
    /// Value for λ₀.
    pub(super) value: f64,
}

/// The criterion for zero.
#[derive(Clone, Copy)]
struct Zero {
    /// Numbers up to this size are zero.
    zero: f64,
    /// Numbers from this size on are certainly not zero.
    clear: f64,
}

impl Zero {
    fn new(tolerance: f64) -> Self {
        Self {
            zero: ZERO_MINOR.max(tolerance),
            clear: CLEAR_MINOR.max(CLEAR_OF_ZERO * tolerance),
        }
    }

    /// Returns whether a number of a load is zero.
    fn holds(self, x: f64, group: usize) -> Result<bool, HullError> {
        match x.abs() {
            x if x <= self.zero => Ok(true),
            x if x < self.clear => Err(HullError::Unclear { group }),
            _ => Ok(false),
        }
    }
}

/// Reason why there is no hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum HullError {
    /// Whether components of this load may be zero together with others is undecided.
    Unclear { group: usize },
    /// There are too many sets.
    Many,
    /// This number of coordinates y changes no component.
    Free { free: usize },
}

/// Compliances between nominal values and a multiple of them.
#[derive(Clone, Debug)]
pub(super) struct Range<'n> {
    /// The multiple.
    pub(super) factor: f64,
    /// The nominal compliance of each load.
    pub(super) nominal: &'n [f64],
}

/// The solutions y_m in independent blocks of coordinates.
pub(super) struct Hull {
    /// Factors of the transposed rows of the basis: `y′ = A_B·y` are the coordinates of the blocks.
    basis: PivotedQr,
    blocks: Vec<Block>,
    /// Orthonormal directions of y that change the elements, if there are other directions.
    span: Option<Vec<Vec<f64>>>,
    /// Sizes by which the components of each load were divided.
    sizes: Vec<f64>,
    /// Number of sets in all blocks.
    pub(super) sets: u64,
}

/// A connected component of the matroid of the elements.
struct Block {
    /// Its coordinates among those of all blocks.
    coordinates: Vec<usize>,
    points: Vec<HullPoint>,
    /// Restriction of the weights of the points.
    weights: Weights,
}

/// The weights with which the points of a block are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Weights {
    /// Any weights c^m·w_m: a point is reached where its monomial dominates.
    Monomials,
    /// Any weights; every point is reached.
    Corners,
    /// The points are reached, and other points may lie outside of their hull.
    Samples,
    /// Between the weight of each point and this multiple of it. More averages are possible than
    /// with any compliances.
    UpTo(f64),
}

/// The loads of a monomial with their exponents, ascending.
type Monomial = Vec<(usize, u32)>;

impl Block {
    fn loads(&self) -> BTreeSet<usize> {
        let monomials = self.points.iter().flat_map(|point| &point.monomial);
        monomials.map(|(load, _)| *load).collect()
    }

    fn shares_a_load(&self, other: &Self) -> bool {
        !self.loads().is_disjoint(&other.loads())
    }

    /// Returns whether a point is approached for some compliances: its monomial dominates there.
    fn is_vertex(&self, k: usize) -> bool {
        let own = &self.points[k].monomial;
        let exponent = |of: &Monomial, load: usize| {
            let found = of.iter().find(|(known, _)| *known == load);
            found.map_or(0.0, |(_, n)| f64::from(*n))
        };
        let others = self
            .points
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != k);
        // Loads outside of the monomial are made rigid.
        let others = others.filter(|(_, point)| {
            let is_inside = |(load, _): &(usize, u32)| exponent(own, *load) > 0.0;
            point.monomial.iter().all(is_inside)
        });
        let differences = others.map(|(_, point)| {
            let difference =
                |&(load, n): &(usize, u32)| f64::from(n) - exponent(&point.monomial, load);
            own.iter().map(difference).collect()
        });
        is_separated(&differences.collect::<Vec<Vec<f64>>>())
    }

    /// Returns the block of all coordinates of both.
    fn times(&self, other: &Self) -> Self {
        let mut sums = Sums::default();
        for a in &self.points {
            for b in &other.points {
                let both = a.monomial.iter().chain(&b.monomial);
                let loads = both.flat_map(|&(load, n)| iter::repeat_n(load, n as usize));
                sums.add(
                    monomial(loads),
                    a.weight * b.weight,
                    [a.y.as_slice(), &b.y].concat(),
                );
            }
        }
        Self {
            coordinates: [self.coordinates.as_slice(), &other.coordinates].concat(),
            points: sums.points(),
            weights: Weights::Monomials,
        }
    }

    /// Restricts the compliances. If each load has at most one component in each monomial, y is a
    /// ratio of functions that are affine in each compliance, and its extremes belong to the
    /// corners of the range. Otherwise the weight of a monomial of degree p varies by the factor to
    /// the power p.
    fn restrict(&mut self, range: &Range<'_>, sizes: &[f64]) {
        // Logarithms: products of many compliances leave the range of numbers.
        let nominal = |(load, n): &(usize, u32)| {
            f64::from(*n) * (range.nominal[*load].ln() + 2.0 * sizes[*load].ln())
        };
        for point in &mut self.points {
            point.weight = point.weight.ln() + point.monomial.iter().map(nominal).sum::<f64>();
        }
        let degree = self.coordinates.len();
        let loads: Vec<usize> = self.loads().into_iter().collect();
        let mut monomials = self.points.iter().flat_map(|point| &point.monomial);
        let is_affine = monomials.all(|(_, n)| *n == 1);
        let corners = u32::try_from(loads.len()).ok();
        let corners = corners.and_then(|n| 1_usize.checked_shl(n));
        let corners = corners.filter(|n| n.saturating_mul(self.points.len()) <= CORNER_POINTS);
        match corners {
            _ if degree == 1 => {
                self.exponentiate();
                self.weights = Weights::UpTo(range.factor);
                self.points = [1.0, -1.0].map(|sign| self.end(sign)).into();
                self.weights = Weights::Corners;
            }
            Some(corners) if is_affine => {
                let points = (0..corners).map(|corner| {
                    let is_soft = |load: &usize| {
                        let place = loads.binary_search(load);
                        place.is_ok_and(|k| corner >> k & 1 == 1)
                    };
                    self.average(is_soft, range.factor)
                });
                self.points = points.collect();
                self.weights = Weights::Corners;
            }
            _ => {
                self.exponentiate();
                let exponent = range.factor.ln() * degree as f64;
                // A larger factor does not restrict the averages noticeably.
                if exponent < LARGEST_EXPONENT {
                    self.weights = Weights::UpTo(exponent.exp());
                }
            }
        }
    }

    /// Replaces the logarithms of the weights by weights relative to the largest one.
    fn exponentiate(&mut self) {
        let weights = self.points.iter().map(|point| point.weight);
        let most = weights.fold(f64::NEG_INFINITY, f64::max);
        for point in &mut self.points {
            point.weight = (point.weight - most).exp();
        }
    }

    /// Returns the smallest y of a block with one coordinate, or the largest for the sign −1.
    fn end(&self, sign: f64) -> HullPoint {
        let values = self.points.iter().map(|point| sign * point.y[0]);
        let (least, soft) = self.least(&values.collect::<Vec<f64>>());
        let soft = soft.iter().flat_map(|&k| &self.points[k].monomial);
        HullPoint {
            monomial: monomial(soft.map(|(load, _)| *load)),
            weight: 1.0,
            y: vec![sign * least],
        }
    }

    /// Returns the solution whose soft loads are softer by a factor.
    fn average(&self, is_soft: impl Fn(&usize) -> bool, factor: f64) -> HullPoint {
        let (mut total, mut y) = (0.0, vec![0.0; self.coordinates.len()]);
        let weight = |point: &HullPoint| {
            let soft = point.monomial.iter().filter(|(load, _)| is_soft(load));
            point.weight + soft.count() as f64 * factor.ln()
        };
        let most = self
            .points
            .iter()
            .map(weight)
            .fold(f64::NEG_INFINITY, f64::max);
        for point in &self.points {
            let weight = (weight(point) - most).exp();
            total += weight;
            y.iter_mut()
                .zip(&point.y)
                .for_each(|(sum, y)| *sum += weight * y);
        }
        HullPoint {
            monomial: self
                .loads()
                .into_iter()
                .filter(is_soft)
                .map(|load| (load, 1))
                .collect(),
            weight: total,
            y: y.iter().map(|y| y / total).collect(),
        }
    }

    /// Returns the smallest average of these values of the points, and the points that it weights
    /// most.
    fn least(&self, values: &[f64]) -> (f64, Vec<usize>) {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let Weights::UpTo(factor) = self.weights else {
            let width = values.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let is_tied = |k: &usize| values[*k] <= least + TIED_ENDS * width;
            return (least, (0..values.len()).filter(is_tied).collect());
        };
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let weight = |k: &usize| self.points[*k].weight;
        let moment = |k: &usize| weight(k) * (values[*k] - least);
        let mut total: f64 = order.iter().map(weight).sum();
        let mut sum: f64 = order.iter().map(moment).sum();
        let (mut best, mut most) = (sum / total, 0);
        for (n, k) in order.iter().enumerate() {
            total += (factor - 1.0) * weight(k);
            sum += (factor - 1.0) * moment(k);
            if sum / total < best {
                (best, most) = (sum / total, n + 1);
            }
        }
        order.truncate(most);
        (least + best, order)
    }

    /// Returns the point among these with equal values that some compliances reach.
    fn reached(&self, tied: &[usize]) -> Option<usize> {
        let mut tied = tied.iter().copied();
        match self.weights {
            Weights::Monomials => tied.find(|&k| self.is_vertex(k)),
            Weights::Corners | Weights::Samples => tied.next(),
            Weights::UpTo(_) => None,
        }
    }
}

/// Sums of weighted solutions for each monomial.
#[derive(Default)]
struct Sums(BTreeMap<Monomial, (f64, Vec<f64>)>);

impl Sums {
    fn add(&mut self, monomial: Monomial, weight: f64, y: Vec<f64>) {
        let new = || (0.0, vec![0.0; y.len()]);
        let (total, sum) = self.0.entry(monomial).or_insert_with(new);
        *total += weight;
        for (sum, y) in sum.iter_mut().zip(&y) {
            *sum += weight * y;
        }
    }

    fn points(self) -> Vec<HullPoint> {
        let all = self.0.into_iter();
        let all = all.map(|(monomial, (weight, sum))| HullPoint {
            monomial,
            weight,
            y: sum.iter().map(|x| x / weight).collect(),
        });
        all.collect()
    }
}

/// A solution y_m of a block.
struct HullPoint {
    monomial: Monomial,
    /// Sum of the squared determinants.
    weight: f64,
    y: Vec<f64>,
}

/// One end of the range of a linear form.
pub(super) struct RangeEnd {
    pub(super) value: f64,
    /// The loads whose joints give way.
    pub(super) groups: Vec<usize>,
    pub(super) is_reached: bool,
    /// Whether no compliances give a value beyond this one.
    pub(super) is_bound: bool,
}

impl Hull {
    /// Finds the hull for p coordinates; coefficients up to the tolerance may be rounding.
    pub(super) fn new(elements: Vec<Element>, p: usize, tolerance: f64) -> Result<Self, HullError> {
        Self::of_sets(elements, p, tolerance, ELASTIC_SETS)
    }

    /// Works like [`Self::new`]; blocks are sampled from this number of sets on.
    pub(super) fn of_sets(
        elements: Vec<Element>,
        p: usize,
        tolerance: f64,
        most: u64,
    ) -> Result<Self, HullError> {
        let zero = Zero::new(tolerance);
        let (mut elements, mut p, mut span) = (elements, p, None);
        let mut principal_axes = principal(&elements, p, zero);
        if let Err(HullError::Free { .. }) = principal_axes {
            let directions = span_of(&elements, p, zero);
            for element in &mut elements {
                element.row = directions.iter().map(|d| dot(d, &element.row)).collect();
            }
            p = directions.len();
            span = Some(directions);
            principal_axes = principal(&elements, p, zero);
        }
        let (elements, sizes) = principal_axes?;
        let matrix = Matrix::from_fn(elements.len(), p, |i, j| elements[i].row[j]);
        let basis = RowBasis::most_independent(matrix.clone(), p);
        let outside: Vec<Vec<f64>> = (0..basis.dropped().len())
            .map(|j| {
                let mut t = vec![0.0; p];
                basis.coefficients(j, &mut t);
                t
            })
            .collect();
        let mut sets = DisjointSets::new(p + outside.len());
        for (j, row) in outside.iter().enumerate() {
            for (k, x) in row.iter().enumerate() {
                if !zero.holds(*x, elements[basis.dropped()[j]].group)? {
                    sets.join(k, p + j);
                }
            }
        }
        let mut hull = Self {
            basis: PivotedQr::of_columns(&matrix.select_rows(basis.kept()).transpose()),
            blocks: Vec::new(),
            span,
            sizes,
            sets: 0,
        };
        let of_basis = |k: usize| &elements[basis.kept()[k]];
        for members in sets.sets() {
            let inside: Vec<usize> = members.iter().copied().filter(|&k| k < p).collect();
            if inside.is_empty() {
                continue;
            }
            let others: Vec<usize> = members.iter().filter_map(|k| k.checked_sub(p)).collect();
            let minors = Minors {
                inside: inside.iter().map(|&k| of_basis(k)).collect(),
                outside: others
                    .iter()
                    .map(|&j| &elements[basis.dropped()[j]])
                    .collect(),
                rows: Matrix::from_fn(others.len(), inside.len(), |i, k| {
                    let x = outside[others[i]][inside[k]];
                    if x.abs() <= zero.zero { 0.0 } else { x }
                }),
                zero,
            };
            let is_small = minors.count() <= most.saturating_sub(hull.sets);
            let (points, weights) = if is_small {
                let (points, sets) = minors.points()?;
                hull.sets += sets;
                (points, Weights::Monomials)
            } else {
                (minors.samples()?, Weights::Samples)
            };
            hull.blocks.push(Block {
                coordinates: inside,
                points,
                weights,
            });
        }
        hull.merge();
        Ok(hull)
    }

    /// Merges blocks with a common load, because its compliance is the same in both.
    fn merge(&mut self) {
        let mut merged: Vec<Block> = Vec::new();
        for mut block in std::mem::take(&mut self.blocks) {
            let mut k = 0;
            while k < merged.len() {
                let is_small = merged[k].points.len() * block.points.len() <= MERGED_POINTS;
                let all = [&merged[k], &block].map(|block| block.weights);
                let is_small = is_small && all == [Weights::Monomials; 2];
                if is_small && merged[k].shares_a_load(&block) {
                    block = merged.swap_remove(k).times(&block);
                    k = 0;
                } else {
                    k += 1;
                }
            }
            merged.push(block);
        }
        self.blocks = merged;
    }

    /// Returns the loads of each independent block.
    pub(super) fn loads(&self) -> impl Iterator<Item = BTreeSet<usize>> + '_ {
        self.blocks.iter().map(Block::loads)
    }

    /// Returns whether some blocks have only solutions for some compliances.
    pub(super) fn is_sampled(&self) -> bool {
        let mut blocks = self.blocks.iter();
        blocks.any(|block| block.weights == Weights::Samples)
    }

    /// Restricts the compliances of all loads.
    pub(super) fn restrict(&mut self, range: &Range<'_>) {
        for block in &mut self.blocks {
            block.restrict(range, &self.sizes);
        }
    }

    /// Returns the coefficients of a linear form of y in the coordinates of the blocks, or an error
    /// if it depends on directions of y that change no element.
    fn in_blocks(&self, along: &[f64]) -> Result<Vec<f64>, HullError> {
        let Some(span) = &self.span else {
            return Ok(solved(&self.basis, along.to_vec()));
        };
        let own: Vec<f64> = span.iter().map(|d| dot(d, along)).collect();
        let mut rest = along.to_vec();
        for (d, x) in span.iter().zip(&own) {
            rest.iter_mut().zip(d).for_each(|(r, d)| *r -= x * d);
        }
        if norm(&rest) > CLEAR_MINOR * norm(along) {
            let free = along.len() - span.len();
            return Err(HullError::Free { free });
        }
        Ok(solved(&self.basis, own))
    }

    /// Returns the smallest and the largest value of a linear form of y.
    ///
    /// # Errors
    /// [`HullError::Free`]
    pub(super) fn ends(&self, along: &[f64]) -> Result<[RangeEnd; 2], HullError> {
        let along = self.in_blocks(along)?;
        Ok([1.0, -1.0].map(|sign| {
            let (mut value, mut chosen) = (0.0, Vec::new());
            for block in &self.blocks {
                let own: Vec<f64> = block.coordinates.iter().map(|&k| along[k]).collect();
                let largest = own.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
                if largest <= ZERO_MINOR * norm(&along) {
                    continue;
                }
                let values = block.points.iter().map(|point| sign * dot(&own, &point.y));
                let (least, points) = block.least(&values.collect::<Vec<f64>>());
                value += sign * least;
                let reached = block.reached(&points);
                let point = reached.or(points.first().copied());
                chosen.push((block, point, reached.is_some()));
            }
            let soft = chosen
                .iter()
                .filter_map(|(block, point, _)| match block.weights {
                    Weights::Monomials | Weights::Corners => Some(&block.points[(*point)?]),
                    Weights::UpTo(_) | Weights::Samples => None,
                });
            let monomials = soft.flat_map(|point| &point.monomial);
            let mut groups: Vec<usize> = monomials.map(|(group, _)| *group).collect();
            groups.sort_unstable();
            groups.dedup();
            // Blocks that were not merged may have a common load.
            let mut loads: Vec<usize> = chosen.iter().flat_map(|(b, ..)| b.loads()).collect();
            let all = loads.len();
            loads.sort_unstable();
            loads.dedup();
            let is_reached = loads.len() == all && chosen.iter().all(|(.., reached)| *reached);
            let mut blocks = chosen.iter().map(|(block, ..)| block);
            RangeEnd {
                value,
                groups,
                is_reached,
                is_bound: !blocks.any(|block| block.weights == Weights::Samples),
            }
        }))
    }

    /// Returns the largest norm of vectors whose components are linear in y.
    ///
    /// # Errors
    /// [`HullError::Free`]; [`HullError::Many`]: there is a range, but no bound.
    pub(super) fn largest_norm(&self, terms: &[(f64, Vec<f64>)]) -> Result<f64, HullError> {
        let rows = terms.iter().map(|(_, along)| self.in_blocks(along));
        let rows: Vec<Vec<f64>> = rows.collect::<Result<_, _>>()?;
        let mut sums = vec![terms.iter().map(|(value, _)| *value).collect::<Vec<f64>>()];
        for block in &self.blocks {
            let change = |point: &HullPoint| -> Vec<f64> {
                let own = |row: &Vec<f64>| {
                    let pairs = block.coordinates.iter().zip(&point.y);
                    pairs.map(|(&k, y)| row[k] * y).sum()
                };
                rows.iter().map(own).collect()
            };
            let changes: Vec<Vec<f64>> = block.points.iter().map(change).collect();
            if changes.iter().flatten().all(|x| *x == 0.0) {
                continue;
            }
            if block.weights == Weights::Samples {
                return Err(HullError::Many);
            }
            let is_restricted = matches!(block.weights, Weights::UpTo(_));
            if is_restricted || sums.len() * changes.len() > MAGNITUDE_POINTS {
                return self.norm_of_ends(terms);
            }
            let add = |sum: &Vec<f64>, change: &Vec<f64>| -> Vec<f64> {
                sum.iter().zip(change).map(|(a, b)| a + b).collect()
            };
            let pairs = sums
                .iter()
                .flat_map(|sum| changes.iter().map(move |c| (sum, c)));
            sums = pairs.map(|(sum, change)| add(sum, change)).collect();
        }
        Ok(sums.iter().map(|x| norm(x)).fold(0.0, f64::max))
    }

    /// Returns the norm of the largest absolute values of the components.
    fn norm_of_ends(&self, terms: &[(f64, Vec<f64>)]) -> Result<f64, HullError> {
        let largest = terms.iter().map(|(value, along)| {
            let ends = self.ends(along)?.map(|end| (value + end.value).abs());
            Ok(ends[0].max(ends[1]))
        });
        Ok(norm(&largest.collect::<Result<Vec<f64>, _>>()?))
    }
}

/// The elements of a block in terms of its basis.
struct Minors<'e> {
    inside: Vec<&'e Element>,
    outside: Vec<&'e Element>,
    /// Rows of the other elements in terms of the basis.
    rows: Matrix,
    zero: Zero,
}

impl Minors<'_> {
    /// Returns the number of sets of elements that replace each other, at most.
    fn count(&self) -> u64 {
        let (n, p) = (self.inside.len() + self.outside.len(), self.inside.len());
        let mut count: u128 = 1;
        for k in 0..p.min(n - p) as u128 {
            count = count.saturating_mul(n as u128 - k) / (k + 1);
        }
        u64::try_from(count).unwrap_or(u64::MAX)
    }

    /// Returns y_m for all monomials, and the number of sets S.
    ///
    /// A set S contains the basis without the elements I, and the elements J outside. Its
    /// determinant is the minor of `rows` with the rows J and the columns I.
    fn points(&self) -> Result<(Vec<HullPoint>, u64), HullError> {
        let p = self.inside.len();
        // The remaining values of the elements outside, if all elements of the basis are zero.
        let at_zero: Vec<f64> = self.inside.iter().map(|e| -e.value).collect();
        let left = self.outside.iter().enumerate();
        let left: Vec<f64> = left
            .map(|(i, e)| e.value + dot(self.rows.row(i), &at_zero))
            .collect();
        let mut sums = Sums::default();
        let mut sets = 0;
        for k in 0..=p.min(self.outside.len()) {
            let columns = combinations(p, k);
            for rows in combinations(self.outside.len(), k) {
                for columns in &columns {
                    let minor = Matrix::from_fn(k, k, |i, j| self.rows[(rows[i], columns[j])]);
                    let Some((det, change)) = self.solved(minor, &rows, &left)? else {
                        continue;
                    };
                    sets += 1;
                    let kept = (0..p).filter(|j| !columns.contains(j));
                    let of_basis = kept.map(|j| self.inside[j].group);
                    let of_others = rows.iter().map(|&i| self.outside[i].group);
                    let monomial = monomial(of_basis.chain(of_others));
                    let mut y = at_zero.clone();
                    for (&j, d) in columns.iter().zip(&change) {
                        y[j] += d;
                    }
                    sums.add(monomial, det * det, y);
                }
            }
        }
        Ok((sums.points(), sets))
    }

    /// Returns solutions for some compliances: each load soft or stiff alone, and random ones.
    fn samples(&self) -> Result<Vec<HullPoint>, HullError> {
        let p = self.inside.len();
        let elements: Vec<&Element> = self.inside.iter().chain(&self.outside).copied().collect();
        let mut loads: Vec<usize> = elements.iter().map(|e| e.group).collect();
        loads.dedup();
        loads.sort_unstable();
        loads.dedup();
        let count = 2 * loads.len() + RANDOM_SAMPLES;
        let work = (elements.len() * p).saturating_mul(p).saturating_mul(count);
        if work > SAMPLE_WORK {
            return Err(HullError::Many);
        }
        // The coordinates are the changes of the elements of the basis.
        let coefficient = |i: usize, j: usize| match i.checked_sub(p) {
            None => f64::from(u8::from(i == j)),
            Some(i) => self.rows[(i, j)],
        };
        // A fixed sequence between −1 and 1.
        let mut state = 0.5_f64;
        let mut random = || {
            state = (state * 997.0 + 0.381_966).fract();
            2.0 * state - 1.0
        };
        let sample = |k: usize| {
            let root = |place: usize| match k.checked_sub(2 * loads.len()) {
                Some(_) => SAMPLED_RATIO.powf(random()),
                None if k / 2 != place => 1.0,
                None if k.is_multiple_of(2) => SAMPLED_RATIO,
                None => SAMPLED_RATIO.recip(),
            };
            let roots: Vec<f64> = (0..loads.len()).map(root).collect();
            let root = |e: &Element| loads.binary_search(&e.group).map_or(0.0, |k| roots[k]);
            let weighted = Matrix::from_fn(elements.len(), p, |i, j| {
                root(elements[i]) * coefficient(i, j)
            });
            let left = elements.iter().map(|e| -root(e) * e.value).collect();
            HullPoint {
                monomial: loads.iter().map(|load| (*load, 1)).collect(),
                weight: 1.0,
                y: solved(&PivotedQr::of_columns(&weighted), left),
            }
        };
        Ok((0..count).map(sample).collect())
    }

    /// Returns the determinant of a minor, and the change of the coordinates that makes the
    /// elements in its rows zero; `None` if the minor is singular.
    fn solved(
        &self,
        minor: Matrix,
        rows: &[usize],
        left: &[f64],
    ) -> Result<Option<(f64, Vec<f64>)>, HullError> {
        let k = minor.nrows();
        if k == 0 {
            return Ok(Some((1.0, Vec::new())));
        }
        let most: f64 = (0..k).map(|i| norm(minor.row(i))).product();
        if most == 0.0 {
            return Ok(None);
        }
        let qr = PivotedQr::of_columns(&minor);
        let det: f64 = qr.r_diagonal().product();
        if self.zero.holds(det / most, self.outside[rows[0]].group)? {
            return Ok(None);
        }
        let left: Vec<f64> = rows.iter().map(|&i| -left[i]).collect();
        Ok(Some((det, solved(&qr, left))))
    }
}

/// Returns orthonormal directions that span the rows of the elements.
fn span_of(elements: &[Element], p: usize, zero: Zero) -> Vec<Vec<f64>> {
    let size = |e: &Element| norm(&e.row).max(f64::MIN_POSITIVE);
    let rows = Matrix::from_fn(p, elements.len(), |i, j| {
        elements[j].row[i] / size(&elements[j])
    });
    let qr = PivotedQr::of_columns(&rows);
    let rank = qr.r_diagonal().filter(|r| r.abs() > zero.zero).count();
    let direction = |k: usize| {
        let mut unit = vec![0.0; p];
        unit[k] = 1.0;
        qr.q_mul(&mut unit);
        unit
    };
    (0..rank).map(direction).collect()
}

/// Rotates the components of each load to the principal axes of its leverage
/// `A_X·(Σ AᵀA)⁻¹·A_Xᵀ`, which do not depend on the axes of the scene, and scales each load to
/// size one. Components that do not depend on y are left out. The sizes are returned, too.
fn principal(
    elements: &[Element],
    p: usize,
    zero: Zero,
) -> Result<(Vec<Element>, Vec<f64>), HullError> {
    let groups = elements.chunk_by(|a, b| a.group == b.group);
    let size = |group: &[Element]| {
        let squares = group.iter().map(|e| dot(&e.row, &e.row));
        squares.sum::<f64>().sqrt()
    };
    let sizes: Vec<f64> = groups.clone().map(size).collect();
    let scaled = groups.zip(&sizes).map(|(group, &size)| {
        let scale = |e: &Element| Element {
            row: e.row.iter().map(|x| x / size).collect(),
            value: e.value / size,
            ..*e
        };
        group.iter().map(scale).collect::<Vec<_>>()
    });
    let scaled: Vec<Vec<Element>> = scaled.collect();
    let all: Vec<&Element> = scaled.iter().flatten().collect();
    let matrix = Matrix::from_fn(all.len(), p, |i, j| all[i].row[j]);
    let qr = PivotedQr::of_columns(&matrix);
    let rank = qr.r_diagonal().filter(|r| r.abs() > zero.zero).count();
    if rank < p {
        return Err(HullError::Free { free: p - rank });
    }
    let mut out = Vec::new();
    for group in &scaled {
        // R⁻ᵀ·Aᵀ: its products are the leverage.
        let mapped = group.iter().map(|e| {
            let mut x: Vec<f64> = qr.permutation().iter().map(|&k| e.row[k]).collect();
            qr.solve_r_transpose(&mut x);
            x
        });
        let mapped: Vec<Vec<f64>> = mapped.collect();
        let n = group.len();
        let leverage = Matrix::from_fn(n, n, |i, j| dot(&mapped[i], &mapped[j]));
        for axis in axes_of(&leverage) {
            let sum = |of: &dyn Fn(&Element) -> f64| -> f64 {
                axis.iter().zip(group).map(|(a, e)| a * of(e)).sum()
            };
            let row: Vec<f64> = (0..p).map(|j| sum(&|e| e.row[j])).collect();
            let own = group[0].group;
            if !zero.holds(norm(&row), own)? {
                let value = sum(&|e| e.value);
                out.push(Element {
                    group: own,
                    row,
                    value,
                });
            }
        }
    }
    Ok((out, sizes))
}

/// Returns orthonormal eigenvectors; among equal eigenvalues those along the given axes.
fn axes_of(leverage: &Matrix) -> Vec<Vec<f64>> {
    let n = leverage.nrows();
    let eigen = symmetric_eigen(leverage);
    let values = &eigen.values;
    let vector = |k: usize| -> Vec<f64> { (0..n).map(|i| eigen.vectors[(i, k)]).collect() };
    let mut axes: Vec<Vec<f64>> = Vec::new();
    let mut from = 0;
    while from < n {
        let equal = |k: &usize| (values[*k] - values[from]).abs() <= EQUAL_LEVERAGE;
        let to = from + (from..n).take_while(equal).count();
        let space: Vec<Vec<f64>> = (from..to).map(vector).collect();
        // Projections of the given axes on the eigenspace, the longest ones first.
        let project = |i: usize| -> Vec<f64> {
            let parts = space.iter().map(|v| v.iter().map(|x| x * v[i]));
            parts.fold(vec![0.0; n], |mut sum, part| {
                sum.iter_mut().zip(part).for_each(|(s, x)| *s += x);
                sum
            })
        };
        let mut candidates: Vec<Vec<f64>> = (0..n).map(project).collect();
        candidates.sort_by(|a, b| norm(b).total_cmp(&norm(a)));
        let known = axes.len();
        for mut candidate in candidates {
            if axes.len() - known == space.len() {
                break;
            }
            for axis in &axes[known..] {
                let along = dot(axis, &candidate);
                candidate
                    .iter_mut()
                    .zip(axis)
                    .for_each(|(x, a)| *x -= along * a);
            }
            let size = norm(&candidate);
            if size > EQUAL_LEVERAGE.sqrt() {
                axes.push(candidate.iter().map(|x| x / size).collect());
            }
        }
        from = to;
    }
    axes
}

fn monomial(groups: impl Iterator<Item = usize>) -> Monomial {
    let mut all: Vec<usize> = groups.collect();
    all.sort_unstable();
    let same = all.chunk_by(|a, b| a == b);
    same.map(|same| (same[0], same.len() as u32)).collect()
}

/// Returns all subsets of k of the numbers below n.
fn combinations(n: usize, k: usize) -> Vec<Vec<usize>> {
    let mut out = Vec::new();
    let mut chosen: Vec<usize> = (0..k).collect();
    if k > n {
        return out;
    }
    loop {
        out.push(chosen.clone());
        let Some(i) = (0..k).rev().find(|&i| chosen[i] < n - k + i) else {
            return out;
        };
        chosen[i] += 1;
        for j in i + 1..k {
            chosen[j] = chosen[j - 1] + 1;
        }
    }
}

/// Returns the x that minimises |A·x − b|, from the factors of A with full column rank.
fn solved(qr: &PivotedQr, mut b: Vec<f64>) -> Vec<f64> {
    let columns = qr.permutation();
    qr.q_transpose_mul(&mut b);
    b.truncate(columns.len());
    qr.solve_r(&mut b);
    let mut x = vec![0.0; columns.len()];
    for (b, &k) in b.iter().zip(columns) {
        x[k] = *b;
    }
    x
}
