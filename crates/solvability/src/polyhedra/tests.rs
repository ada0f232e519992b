//! Ranges of random polyhedra, compared with vertices and rays that are enumerated with integers.

use exact::Exact;
use linalg::Matrix;
use suite::numbers::Numbers;

use super::complementarity::support_motion;
use super::polyhedron::{AdmissibleRange, Emptiness, Extremum, HalfSpace, Polyhedron};
use crate::limits::SUPPORT_ROUNDING;

const POLYHEDRA: usize = 2000;

/// Relative accuracy of values. The largest numbers are about 1e3. At vertices of integers up to 4,
/// rounding errors are multiplied by at most 1e4.
const TOLERANCE: f64 = 1e-9;

/// Returns a row of integers from −3 to 3.
fn row(numbers: &mut Numbers, p: usize) -> Vec<i128> {
    (0..p).map(|_| numbers.below(7) as i128 - 3).collect()
}

/// The half space `row·y + value ≥ 0` with integers. The list contains the row and, at its end, the
/// value.
type Plane = Vec<i128>;

fn dot(a: &[i128], b: &[i128]) -> i128 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns a basis of the vectors of length n whose products with the rows are zero.
fn kernel(rows: &[&Plane], n: usize) -> Vec<Plane> {
    let coordinates = (0..n).map(|i| rows.iter().map(|row| row[i].into()).collect());
    let exact = Exact::of_whole(coordinates.collect());
    let whole = |z: &Vec<_>| {
        z.iter()
            .map(|x| i128::try_from(x).expect("small"))
            .collect()
    };
    exact.null_space().iter().map(whole).collect()
}

/// All points of a polyhedron. They are given by lines and by the extreme rays (y, t) of the cone
/// `row·y + value·t ≥ 0`, `t ≥ 0`. The rays are orthogonal to the lines. Vertices are y/t, and
/// directions have t = 0.
struct Enumerated {
    lines: Vec<Plane>,
    rays: Vec<Plane>,
}

/// The ends of a range; `None` if the number has no limit.
type Ends = [Option<f64>; 2];

impl Enumerated {
    fn new(p: usize, planes: &[Plane]) -> Self {
        let mut cone = planes.to_vec();
        cone.push((0..=p).map(|i| i128::from(i == p)).collect());
        let lines = kernel(&cone.iter().collect::<Vec<_>>(), p + 1);
        let chosen = p - lines.len();
        let mut rays = Vec::new();
        for set in sets(cone.len(), chosen) {
            let rows: Vec<&Plane> = set.iter().map(|&k| &cone[k]).chain(&lines).collect();
            let [ray] = &kernel(&rows, p + 1)[..] else {
                continue;
            };
            for sign in [1, -1] {
                let ray: Plane = ray.iter().map(|x| sign * x).collect();
                if cone.iter().all(|plane| dot(plane, &ray) >= 0) {
                    rays.push(ray);
                }
            }
        }
        Self { lines, rays }
    }

    /// Returns whether the polyhedron has points that are not bounded.
    fn is_unbounded(&self) -> bool {
        !self.lines.is_empty() || self.rays.iter().any(|ray| ray.last() == Some(&0))
    }

    /// Returns the range of `row·y + value`, or `None` if there are no points.
    fn range(&self, form: &Plane) -> Option<Ends> {
        let (p, mut ends) = (form.len() - 1, [None, None]);
        for ray in self.rays.iter().filter(|ray| ray[p] > 0) {
            let value = dot(form, ray) as f64 / ray[p] as f64;
            ends[0] = Some(ends[0].map_or(value, |lowest: f64| lowest.min(value)));
            ends[1] = Some(ends[1].map_or(value, |highest: f64| highest.max(value)));
        }
        ends[0]?;
        let directions = self.rays.iter().filter(|ray| ray[p] == 0);
        for change in directions.map(|ray| dot(form, ray)) {
            if change != 0 {
                ends[usize::from(change > 0)] = None;
            }
        }
        if self.lines.iter().any(|line| dot(form, line) != 0) {
            ends = [None, None];
        }
        Some(ends)
    }
}

/// Returns the largest s with `row·y + value − s ≥ 0`, if s is bounded.
fn depth(p: usize, planes: &[Plane]) -> Option<f64> {
    let deeper = planes.iter().map(|plane| {
        let mut plane = plane.clone();
        plane.insert(p, -1);
        plane
    });
    let deeper = Enumerated::new(p + 1, &deeper.collect::<Vec<_>>());
    let ends = deeper.range(&(0..p + 2).map(|i| i128::from(i == p)).collect());
    let [_, depth] = ends.expect("points of low depth");
    depth
}

/// Returns all sets of k numbers below n.
fn sets(n: usize, k: usize) -> Vec<Vec<usize>> {
    let Some(smaller) = k.checked_sub(1) else {
        return vec![Vec::new()];
    };
    let with_last = |last: usize| {
        sets(last, smaller).into_iter().map(move |mut set| {
            set.push(last);
            set
        })
    };
    (smaller..n).flat_map(with_last).collect()
}

/// The way in which a polyhedron is built.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Any half spaces are used.
    Any,
    /// The polyhedron is within a simplex.
    Bounded,
    /// All planes contain one point.
    Vertex,
    /// Pairs of half spaces have one common plane.
    Flat,
    /// Two of the half spaces exclude each other.
    Empty,
}

fn planes(kind: Kind, p: usize, numbers: &mut Numbers) -> Vec<Plane> {
    let most = 12;
    let mut planes: Vec<Plane> = Vec::new();
    let inside = row(numbers, p);
    if matches!(kind, Kind::Bounded | Kind::Flat) {
        for i in 0..=p {
            let sign = |j: usize| if i == p { -1 } else { i128::from(i == j) };
            let mut plane: Plane = (0..p).map(sign).collect();
            plane.push(numbers.below(5) as i128 - dot(&plane, &inside));
            planes.push(plane);
        }
    }
    let count = numbers.below((2 * p + 3).min(most + 1 - planes.len()));
    for _ in 0..count {
        let mut plane = row(numbers, p);
        let slack = match kind {
            Kind::Vertex => 0,
            Kind::Any if numbers.below(4) == 0 => numbers.below(13) as i128 - 6,
            _ => numbers.below(7) as i128,
        };
        plane.push(slack - dot(&plane, &inside));
        planes.push(plane);
    }
    if planes.is_empty() {
        return planes;
    }
    let copies = match kind {
        Kind::Flat | Kind::Empty => 1 + numbers.below(p + 1),
        Kind::Vertex => numbers.below(3),
        Kind::Any | Kind::Bounded => 0,
    };
    for _ in 0..copies {
        if planes.len() >= most {
            break;
        }
        let mut plane = planes[numbers.below(planes.len())].clone();
        if kind != Kind::Vertex {
            if kind == Kind::Flat {
                plane[p] = -dot(&plane[..p], &inside);
                planes.push(plane.clone());
            }
            plane.iter_mut().for_each(|x| *x = -*x);
            plane[p] -= i128::from(kind == Kind::Empty);
        }
        planes.push(plane);
    }
    planes
}

/// A change of the data that does not change ranges. It consists of an orthogonal change of y,
/// another order of the half spaces and another length of each row.
struct Change {
    reflection: Vec<f64>,
    lengths: Vec<f64>,
}

impl Change {
    fn new(p: usize, count: usize, numbers: &mut Numbers) -> Self {
        let mut axis: Vec<f64> = (0..p).map(|_| numbers.below(1000) as f64 - 499.5).collect();
        let norm = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        axis.iter_mut().for_each(|x| *x /= norm);
        Self {
            reflection: axis,
            lengths: (0..count)
                .map(|_| 0.003 + numbers.below(1000) as f64 / 1e3)
                .collect(),
        }
    }

    fn row(&self, row: &[f64]) -> Vec<f64> {
        let along: f64 = row.iter().zip(&self.reflection).map(|(x, a)| x * a).sum();
        let pairs = row.iter().zip(&self.reflection);
        pairs.map(|(x, a)| x - 2.0 * along * a).collect()
    }

    fn half_spaces(&self, half_spaces: &[HalfSpace]) -> Vec<HalfSpace> {
        let scaled = half_spaces
            .iter()
            .zip(&self.lengths)
            .map(|(h, length)| HalfSpace {
                row: self.row(&h.row).iter().map(|x| x * length).collect(),
                value: h.value * length,
            });
        scaled.rev().collect()
    }
}

fn numbers_of(plane: &[i128]) -> HalfSpace {
    let (value, row) = plane.split_last().expect("a value");
    HalfSpace {
        row: row.iter().map(|x| *x as f64).collect(),
        value: *value as f64,
    }
}

fn sum(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Compares a range with its ends and with the proofs of the ends.
fn check(
    range: &AdmissibleRange,
    ends: Ends,
    form: &HalfSpace,
    half_spaces: &[HalfSpace],
    size: f64,
) {
    for (k, (end, expected)) in range.ends.iter().zip(ends).enumerate() {
        let sign = [1.0, -1.0][k];
        match (end, expected) {
            (Extremum::Finite { value, at, weights }, Some(expected)) => {
                let accuracy = TOLERANCE * size;
                assert!(
                    (value - expected).abs() <= accuracy,
                    "{value} is not {expected}"
                );
                assert!((sum(&form.row, at) + form.value - expected).abs() <= accuracy);
                for half_space in half_spaces {
                    assert!(sum(&half_space.row, at) + half_space.value >= -accuracy);
                }
                let bound: f64 = weights
                    .iter()
                    .zip(half_spaces)
                    .map(|(u, h)| u * h.value)
                    .sum();
                assert!((form.value - sign * bound - expected).abs() <= accuracy);
                for i in 0..at.len() {
                    let rows = weights.iter().zip(half_spaces).map(|(u, h)| u * h.row[i]);
                    assert!((rows.sum::<f64>() - sign * form.row[i]).abs() <= TOLERANCE);
                }
                assert!(weights.iter().all(|u| *u >= 0.0));
            }
            (Extremum::Infinite { ray }, None) => {
                assert!(sign * sum(&form.row, ray) < 0.0);
                let stays = |h: &HalfSpace| sum(&h.row, ray) >= -TOLERANCE;
                assert!(half_spaces.iter().all(stays));
            }
            (end, expected) => panic!("{end:?} instead of {expected:?}"),
        }
    }
    let is_point = matches!(ends, [Some(lowest), Some(highest)] if lowest == highest);
    assert_eq!(range.is_point, is_point, "{ends:?}");
}

#[test]
fn ranges_are_those_of_enumerated_vertices() {
    let mut numbers = Numbers::new(7);
    let (mut unclear, mut asked) = (Vec::new(), 0);
    let (mut unbounded, mut degenerate, mut empty) = (0, 0, 0);
    for k in 0..POLYHEDRA {
        let p = [0, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 5, 6][numbers.below(13)];
        let kind = [
            Kind::Any,
            Kind::Bounded,
            Kind::Any,
            Kind::Vertex,
            Kind::Any,
            Kind::Flat,
        ];
        let kind = if k % 10 == 9 {
            Kind::Empty
        } else {
            kind[k % 6]
        };
        let planes = planes(kind, p, &mut numbers);
        let half_spaces: Vec<HalfSpace> = planes.iter().map(|plane| numbers_of(plane)).collect();
        let size = half_spaces
            .iter()
            .map(|h| h.value.abs())
            .fold(1.0, f64::max);
        let change = Change::new(p, planes.len(), &mut numbers);
        let changed = change.half_spaces(&half_spaces);
        let enumerated = Enumerated::new(p, &planes);
        let depth = depth(p, &planes);
        let polyhedron = Polyhedron::new(p, &half_spaces, size);
        let other = Polyhedron::new(p, &changed, size);
        asked += 1;
        match polyhedron.emptiness() {
            Err(reason) => unclear.push(reason),
            Ok(Emptiness::Points { depth: found }) => {
                assert_eq!(found.is_some(), depth.is_some(), "{kind:?} {planes:?}");
                let difference = found.unwrap_or(0.0) - depth.unwrap_or(0.0);
                assert!(difference.abs() <= TOLERANCE * size, "{found:?}, {depth:?}");
                assert!(depth.is_none_or(|depth| depth >= 0.0));
            }
            Ok(Emptiness::Empty {
                depth: found,
                weights,
            }) => {
                let depth = depth.expect("bounded");
                assert!(depth < 0.0 && (found - depth).abs() <= TOLERANCE * size);
                let values: Vec<f64> = half_spaces.iter().map(|h| h.value).collect();
                assert!((sum(weights, &values) - depth).abs() <= TOLERANCE * size);
            }
        }
        match enumerated.range(&vec![0; p + 1]) {
            None => empty += 1,
            Some(_) if enumerated.is_unbounded() => unbounded += 1,
            Some(_) => {}
        }
        degenerate += usize::from(matches!(kind, Kind::Vertex | Kind::Flat | Kind::Empty));
        let mut forms: Vec<Plane> = (0..3).map(|_| row(&mut numbers, p + 1)).collect();
        forms.extend(planes.first().cloned());
        for form in &forms {
            let ends = enumerated.range(form);
            let form = numbers_of(form);
            let turned = HalfSpace {
                row: change.row(&form.row),
                value: form.value,
            };
            let both = [
                (&polyhedron, &form, &half_spaces),
                (&other, &turned, &changed),
            ];
            for (polyhedron, form, half_spaces) in both {
                asked += 1;
                match polyhedron.range(&form.row, form.value) {
                    Err(reason) => unclear.push(reason),
                    Ok(None) => assert!(ends.is_none(), "{planes:?}"),
                    Ok(Some(range)) => {
                        let ends = ends.unwrap_or_else(|| panic!("no point: {planes:?}"));
                        check(&range, ends, form, half_spaces, size);
                    }
                }
            }
        }
    }
    let counts = [asked, unbounded, degenerate, empty];
    assert!(
        unclear.len() <= 3,
        "{} of {counts:?}: {unclear:?}",
        unclear.len()
    );
    let enough = 3 * unbounded >= POLYHEDRA && 4 * degenerate >= POLYHEDRA && empty > 100;
    assert!(enough, "{counts:?}");
}

/// Number of units of the values in a test with small differences.
const FINE: i128 = 1 << 44;

/// Half spaces that nearly have a common vertex or a common plane. The differences are between the
/// rounding of `f64` and 1e-6. Answers may be undecided, but they must not be wrong.
#[test]
fn small_differences_are_right_or_undecided() {
    let mut numbers = Numbers::new(2);
    let (mut decided, mut undecided) = (0, 0);
    for k in 0..300 {
        let p = [0, 1, 2, 2, 3, 3, 4][numbers.below(7)];
        let kind = [
            Kind::Any,
            Kind::Bounded,
            Kind::Vertex,
            Kind::Vertex,
            Kind::Flat,
        ][k % 5];
        let mut planes = planes(kind, p, &mut numbers);
        let difference = 1 << numbers.below(26);
        for plane in &mut planes {
            let change = numbers.below(2 * difference) as i128 - difference as i128;
            plane[p] = FINE * plane[p] + change * numbers.below(2) as i128;
        }
        let fine = |plane: &Plane| {
            let mut fine = numbers_of(plane);
            fine.value /= FINE as f64;
            fine
        };
        let half_spaces: Vec<HalfSpace> = planes.iter().map(fine).collect();
        let size = half_spaces
            .iter()
            .map(|h| h.value.abs())
            .fold(1.0, f64::max);
        let polyhedron = Polyhedron::new(p, &half_spaces, size);
        let enumerated = Enumerated::new(p, &planes);
        let mut forms = vec![row(&mut numbers, p + 1)];
        forms.extend(planes.first().cloned());
        for form in &forms {
            let ends = enumerated.range(form);
            let form = fine(form);
            match (polyhedron.range(&form.row, form.value), ends) {
                (Err(_), _) => undecided += 1,
                (Ok(None), None) => decided += 1,
                (Ok(None), Some(_)) => panic!("there are points: {planes:?}"),
                (Ok(Some(_)), None) => {
                    let depth = depth(p, &planes).expect("bounded") / FINE as f64;
                    assert!(
                        depth >= -2.0 * SUPPORT_ROUNDING * size,
                        "{depth}: {planes:?}"
                    );
                }
                (Ok(Some(range)), Some(ends)) => {
                    decided += 1;
                    for (end, expected) in range.ends.iter().zip(ends) {
                        let expected = expected.map(|end| end / FINE as f64);
                        match (end, expected) {
                            (Extremum::Infinite { .. }, None) => {}
                            (Extremum::Finite { value, weights, .. }, Some(expected)) => {
                                let weights = 1.0 + weights.iter().sum::<f64>();
                                let error = (value - expected).abs();
                                assert!(error <= TOLERANCE * size * weights, "{error}");
                            }
                            (end, expected) => panic!("{end:?} instead of {expected:?}"),
                        }
                    }
                }
            }
        }
    }
    assert!(
        decided > 300 && undecided > 30,
        "{decided}, {undecided} undecided"
    );
}

/// Legs of a plate at integer points, and its load.
pub(crate) struct Plate {
    legs: Vec<[i128; 2]>,
    load: [i128; 2],
}

impl Plate {
    pub(crate) fn new(numbers: &mut Numbers) -> Self {
        let count = 4 + numbers.below(6);
        let mut place = || [0, 1].map(|_| numbers.below(5) as i128 - 2);
        Self {
            legs: (0..count).map(|_| place()).collect(),
            load: place(),
        }
    }

    /// Returns the least and the largest push of each leg as shares of the load. They are computed
    /// from all plates on three legs that do not fall. There are no shares if all legs are on one
    /// line.
    pub(crate) fn shares(&self) -> Option<Vec<Option<[f64; 2]>>> {
        let area = |a: [i128; 2], b: [i128; 2], c: [i128; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let mut ends: Vec<Option<[f64; 2]>> = vec![None; self.legs.len()];
        let mut stands = false;
        for set in sets(self.legs.len(), 3) {
            let [a, b, c] = [0, 1, 2].map(|i| self.legs[set[i]]);
            let (load, all) = (self.load, area(a, b, c));
            let parts = [area(load, b, c), area(a, load, c), area(a, b, load)];
            stands |= all != 0;
            if all == 0 || parts.iter().any(|part| part * all < 0) {
                continue;
            }
            for (k, ends) in ends.iter_mut().enumerate() {
                let at = set.iter().position(|&leg| leg == k);
                let share = at.map_or(0.0, |at| parts[at] as f64 / all as f64);
                let [lowest, highest] = ends.unwrap_or([share; 2]);
                *ends = Some([lowest.min(share), highest.max(share)]);
            }
        }
        stands.then_some(ends)
    }

    /// Returns the velocity of the plate at each leg, due to the velocity of the load and due to
    /// two rotations.
    fn motions(&self) -> Matrix {
        Matrix::from_fn(self.legs.len(), 3, |k, i| match i.checked_sub(1) {
            None => 1.0,
            Some(i) => (self.legs[k][i] - self.load[i]) as f64,
        })
    }

    /// Returns one solution of the equations of the pushes, and an orthonormal basis of all
    /// changes.
    pub(crate) fn half_spaces(&self) -> Vec<HalfSpace> {
        let (motions, count) = (self.motions(), self.legs.len());
        let equations = motions.transpose();
        let units = Matrix::identity(count);
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut pushes = vec![0.0; count];
        for i in 0..3 + count {
            let original = if i < 3 {
                equations.row(i)
            } else {
                units.row(i - 3)
            };
            let mut row = original.to_vec();
            // The products are subtracted twice, because rounding errors remain after the first
            // pass.
            for direction in basis.iter().chain(&basis) {
                let along = sum(&row, direction);
                row.iter_mut()
                    .zip(direction)
                    .for_each(|(x, d)| *x -= along * d);
            }
            let length = sum(&row, &row).sqrt();
            if length < TOLERANCE {
                continue;
            }
            row.iter_mut().for_each(|x| *x /= length);
            if i < 3 {
                let required = if i == 0 { WEIGHT } else { 0.0 };
                let left = (required - sum(original, &pushes)) / length;
                pushes
                    .iter_mut()
                    .zip(&row)
                    .for_each(|(f, d)| *f += left * d);
            }
            basis.push(row);
        }
        let changes = |k: usize| basis[3..].iter().map(|change| change[k]).collect();
        let half_spaces = pushes.iter().enumerate().map(|(k, push)| HalfSpace {
            row: changes(k),
            value: *push,
        });
        half_spaces.collect()
    }
}

/// Weight of the plates (N).
pub(crate) const WEIGHT: f64 = 117.72;

const PLATES: usize = 1000;

/// Some loads are above a leg or above the line through two legs. If the load is outside the
/// polygon of the legs, a leg lifts. In all other cases, no leg lifts.
#[test]
fn pushes_of_plates_are_those_on_three_legs() {
    let mut numbers = Numbers::new(3);
    let (mut falling, mut points, mut intervals) = (0, 0, 0);
    for _ in 0..PLATES {
        let plate = Plate::new(&mut numbers);
        let Some(shares) = plate.shares() else {
            continue;
        };
        let half_spaces = plate.half_spaces();
        let polyhedron = Polyhedron::new(plate.legs.len() - 3, &half_spaces, WEIGHT);
        for (half_space, share) in half_spaces.iter().zip(&shares) {
            let range = polyhedron.range(&half_space.row, half_space.value);
            match (range.expect("decided"), share) {
                (None, None) => falling += 1,
                (Some(range), Some(ends)) => {
                    let ends = ends.map(|share| Some(WEIGHT * share));
                    check(&range, ends, half_space, &half_spaces, WEIGHT);
                    points += usize::from(range.is_point);
                    intervals += usize::from(!range.is_point);
                }
                (range, share) => panic!("{range:?} instead of {share:?}"),
            }
        }
        let motions = plate.motions();
        let (mass, inertias) = (12.0, [1.5, 0.7]);
        let inverse = Matrix::from_rows(&[
            [1.0 / mass, 0.0, 0.0],
            [0.0, 1.0 / inertias[0], 0.0],
            [0.0, 0.0, 1.0 / inertias[1]],
        ]);
        let w = motions.product(&inverse).product(&motions.transpose());
        let free = vec![-WEIGHT / mass; plate.legs.len()];
        let found = support_motion(&w, &free).expect("decided");
        let lifts = found.accelerations.iter().any(|a| *a > 0.0);
        assert_eq!(
            lifts,
            shares[0].is_none(),
            "{:?}, {:?}",
            plate.legs,
            plate.load
        );
    }
    assert!(
        falling > 1000 && points > 1000 && intervals > 1000,
        "{falling} {points} {intervals}"
    );
}
