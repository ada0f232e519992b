//! The choice of independent coordinates.

use linalg::{Matrix, PivotedQr};
use model::words::listed;

use super::coordinate::{BODY, Coordinate, coordinate, frame_row, named};
use super::curve::{Curves, Derivative};
use super::error::LineariseError;
use super::followed::FollowedCoordinates;
use crate::limits::{CHOSEN_PIVOT, DEPENDENT_COORDINATE};

/// The independent coordinates of a linearisation.
pub(crate) struct CoordinateChoice {
    pub(crate) positions: Vec<Coordinate>,
    pub(crate) velocities: Vec<Coordinate>,
}

impl CoordinateChoice {
    /// Chooses velocities first, and then positions whose rates are these velocities. Cyclic and
    /// requested coordinates are chosen first, then rotations, and then translations. Among several
    /// candidates, the first candidate with a large free share is chosen.
    pub(crate) fn new(
        curves: &Curves<'_>,
        followed: &FollowedCoordinates,
        asked: &[String],
    ) -> Result<Self, LineariseError> {
        let mechanism = curves.mechanism();
        let mut wanted: Vec<(usize, String)> = Vec::new();
        for coordinate in &followed.coordinates {
            wanted.push((coordinate.row(), coordinate.name.clone()));
        }
        for name in asked {
            let (coordinate, _) = named(mechanism, name)?;
            if !wanted.iter().any(|w| w.0 == coordinate.row()) {
                wanted.push((coordinate.row(), name.clone()));
            }
        }
        let [of_phi, of_c] = curves.kept();
        let velocities = FreeMotions::new(curves, of_c).choose(&wanted, &[], false)?;
        let positions = FreeMotions::new(curves, of_phi).choose(&wanted, &velocities, true)?;
        let all = |rows: Vec<usize>, is_velocity| {
            let of = |row: usize| coordinate(mechanism, row / BODY, row % BODY, is_velocity);
            rows.into_iter().map(of).collect()
        };
        Ok(Self {
            positions: all(positions, false),
            velocities: all(velocities, true),
        })
    }

    /// Returns the number of states.
    pub(crate) fn len(&self) -> usize {
        self.positions.len() + self.velocities.len()
    }

    /// Returns the rates of all states for the derivatives along a curve, in rotating axes.
    pub(crate) fn rates<'a>(
        &'a self,
        d: &'a Derivative,
        curves: &'a Curves<'_>,
        turning: [f64; 3],
    ) -> impl Iterator<Item = f64> + 'a {
        let part = |x: &[f64], c: &Coordinate| -> [f64; 3] {
            let first = frame_row(c.body, c.direction / 3 * 3);
            [x[first], x[first + 1], x[first + 2]]
        };
        let turned = move |x: [f64; 3], by: [f64; 3], axis: usize| model::space::cross(by, x)[axis];
        let positions = self.positions.iter().map(move |c| {
            let axis = c.direction % 3;
            let shift = part(&d.shift, c);
            let carried = if c.direction < 3 {
                0.0
            } else {
                turned(shift, curves.omega(c.body), axis)
            };
            d.velocity[c.row()] + carried - turned(shift, turning, axis)
        });
        let velocities = self.velocities.iter().map(move |c| {
            let axis = c.direction % 3;
            d.acceleration[c.row()] - turned(part(&d.velocity, c), turning, axis)
        });
        positions.chain(velocities)
    }
}

/// Motions of all frames that the rows allow.
struct FreeMotions<'c, 'm> {
    curves: &'c Curves<'m>,
    /// Dimensionless motions of the frames, with one row for each direction and one column for each
    /// free motion.
    rows: Matrix,
    /// Orthonormal directions that were already chosen.
    taken: Vec<Vec<f64>>,
}

impl<'c, 'm> FreeMotions<'c, 'm> {
    fn new(curves: &'c Curves<'m>, kept: &[usize]) -> Self {
        let squared = curves.squared_units();
        let mut rows = curves.rows(kept);
        let n = rows.ncols();
        for i in 0..rows.nrows() {
            let row = rows.row_mut(i);
            row.iter_mut()
                .zip(&squared)
                .for_each(|(c, u)| *c *= u.sqrt());
            let size = row.iter().map(|c| c * c).sum::<f64>().sqrt();
            if size > 0.0 {
                row.iter_mut().for_each(|c| *c /= size);
            }
        }
        let count = rows.nrows();
        let mut basis = PivotedQr::of_rows(rows).q_columns(count.min(n)..n);
        for j in 0..n {
            let unit = squared[j].sqrt();
            basis.row_mut(j).iter_mut().for_each(|x| *x *= unit);
        }
        let mut rows = curves.frames.product(&basis);
        for i in 0..rows.nrows() {
            if i % BODY < 3 {
                let size = curves.size();
                rows.row_mut(i).iter_mut().for_each(|x| *x /= size);
            }
        }
        Self {
            curves,
            rows,
            taken: Vec::new(),
        }
    }

    /// Returns the part of a row that the directions already chosen do not determine.
    fn left(&self, row: usize) -> Vec<f64> {
        let mut left = self.rows.row(row).to_vec();
        // The second pass removes the rounding error of the first pass.
        for taken in self.taken.iter().chain(&self.taken) {
            let share: f64 = left.iter().zip(taken).map(|(a, b)| a * b).sum();
            left.iter_mut()
                .zip(taken)
                .for_each(|(a, b)| *a -= share * b);
        }
        left
    }

    fn take(&mut self, row: usize) {
        let mut left = self.left(row);
        let size = length(&left);
        left.iter_mut().for_each(|x| *x /= size);
        self.taken.push(left);
    }

    fn choose(
        mut self,
        wanted: &[(usize, String)],
        first: &[usize],
        all_wanted: bool,
    ) -> Result<Vec<usize>, LineariseError> {
        let free = self.rows.ncols();
        let mut chosen: Vec<usize> = Vec::new();
        let of_wanted = wanted.iter().map(|w| (w.0, Some(w)));
        for (row, asked) in of_wanted.chain(first.iter().map(|&row| (row, None))) {
            if chosen.contains(&row) {
                continue;
            }
            if length(&self.left(row)) > DEPENDENT_COORDINATE {
                self.take(row);
                chosen.push(row);
            } else if let Some((_, name)) = asked.filter(|_| all_wanted) {
                return Err(self.dependent(name, &chosen));
            }
        }
        let turns_first = |row: &usize| (row % BODY < 3, *row);
        let mut order: Vec<usize> = (0..self.rows.nrows()).collect();
        order.sort_by_key(turns_first);
        while chosen.len() < free {
            let sizes: Vec<f64> = order.iter().map(|&row| length(&self.left(row))).collect();
            let largest = sizes.iter().copied().fold(0.0, f64::max);
            let next = sizes.iter().position(|x| *x >= CHOSEN_PIVOT * largest);
            let Some(next) = next.filter(|_| largest > DEPENDENT_COORDINATE) else {
                return Err(LineariseError::Singular);
            };
            self.take(order[next]);
            chosen.push(order[next]);
        }
        Ok(chosen)
    }

    fn dependent(&self, name: &str, chosen: &[usize]) -> LineariseError {
        let mechanism = self.curves.mechanism();
        let others = chosen
            .iter()
            .map(|row| coordinate(mechanism, row / BODY, row % BODY, false).name);
        let others: Vec<String> = others.map(|name| format!("`{name}`")).collect();
        LineariseError::Dependent {
            name: name.to_owned(),
            others: if others.is_empty() {
                "the joints, which hold it".to_owned()
            } else {
                listed(&others)
            },
        }
    }
}

fn length(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
