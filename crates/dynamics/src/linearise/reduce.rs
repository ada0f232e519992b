//! The motion relative to its cyclic coordinates. The cyclic coordinates are eliminated.

use linalg::Matrix;
use model::space::cross;

use super::chosen::CoordinateChoice;
use super::coordinate::{BODY, Coordinate};
use super::curve::Curves;
use super::error::LineariseError;
use super::followed::FollowedCoordinates;
use super::linearisation::Linearisation;
use crate::limits::SYMMETRY;

/// Eliminates the cyclic coordinates. The function first checks that the motion does not depend on
/// them.
pub(crate) fn reduce(
    followed: &FollowedCoordinates,
    whole: Linearisation,
    chosen: &CoordinateChoice,
    curves: &Curves<'_>,
) -> Result<Linearisation, LineariseError> {
    let (n, d) = (chosen.len(), chosen.positions.len());
    let place = |c: &Coordinate| chosen.positions.iter().position(|p| p.row() == c.row());
    let left_out: Vec<usize> = followed.coordinates.iter().filter_map(place).collect();
    let symmetries: Vec<Vec<f64>> = followed
        .coordinates
        .iter()
        .map(|c| symmetry(c, chosen, curves))
        .collect();
    let largest = whole.a.max_abs();
    for (c, symmetry) in followed.coordinates.iter().zip(&symmetries) {
        let mut rate = whole.a.times(symmetry);
        // Components along the directions of the other symmetries do not count as a change.
        let shares: Vec<f64> = left_out.iter().map(|&k| rate[k]).collect();
        for (share, other) in shares.iter().zip(&symmetries) {
            rate.iter_mut()
                .zip(other)
                .for_each(|(r, s)| *r -= share * s);
        }
        let size = symmetry.iter().fold(0.0_f64, |a, s| a.max(s.abs()));
        let worst = (0..n).fold(0, |a, b| if rate[b].abs() > rate[a].abs() { b } else { a });
        if rate[worst].abs() > SYMMETRY * largest * size {
            let states = chosen.positions.iter().chain(&chosen.velocities);
            return Err(LineariseError::NotASymmetry {
                name: c.name.clone(),
                state: states
                    .map(|c| c.name.clone())
                    .nth(worst)
                    .unwrap_or_default(),
                change: rate[worst],
            });
        }
    }
    let stay: Vec<usize> = (0..n).filter(|k| !left_out.contains(k)).collect();
    let relative = |m: &Matrix, i: usize, k: usize| -> f64 {
        let carried = left_out.iter().zip(&symmetries);
        m[(stay[i], k)] - carried.map(|(&f, s)| s[stay[i]] * m[(f, k)]).sum::<f64>()
    };
    let a = Matrix::from_fn(stay.len(), stay.len(), |i, k| {
        relative(&whole.a, i, stay[k])
    });
    let b = Matrix::from_fn(stay.len(), whole.b.ncols(), |i, k| relative(&whole.b, i, k));
    let stays = |k: &usize| !left_out.contains(k);
    let kept: Vec<usize> = (0..d).filter(stays).collect();
    Ok(Linearisation {
        a,
        b,
        positions: kept.iter().map(|&k| whole.positions[k].clone()).collect(),
        shapes: whole.shapes.select_rows(&kept),
        ..whole
    })
}

/// Returns the change of the states if the whole mechanism moves along a coordinate by one unit, or
/// rotates about the axis of this coordinate.
fn symmetry(c: &Coordinate, chosen: &CoordinateChoice, curves: &Curves<'_>) -> Vec<f64> {
    let (_, q, v) = curves.state();
    let frames = curves.mechanism().frames();
    let axis: [f64; 3] = std::array::from_fn(|k| f64::from(u8::from(k == c.direction % 3)));
    let turns = c.direction >= 3;
    let origin = frames.body(c.body, q, v).place;
    let of_body = |body: usize| -> [[f64; BODY]; 2] {
        let state = frames.body(body, q, v);
        if !turns {
            return [join(axis, [0.0; 3]), [0.0; BODY]];
        }
        let arm = std::array::from_fn(|k| state.place[k] - origin[k]);
        [
            join(cross(axis, arm), axis),
            join(cross(axis, state.velocity), cross(axis, state.omega)),
        ]
    };
    let positions = chosen
        .positions
        .iter()
        .map(|p| of_body(p.body)[0][p.direction]);
    let velocities = chosen
        .velocities
        .iter()
        .map(|p| of_body(p.body)[1][p.direction]);
    positions.chain(velocities).collect()
}

fn join(x: [f64; 3], y: [f64; 3]) -> [f64; BODY] {
    [x[0], x[1], x[2], y[0], y[1], y[2]]
}
