//! Describes spatial loads that joints can exert on each other without a resultant load on the
//! bodies. The description of each joint lists the forces and moments that the joint can carry.
//! These form a space of wrenches.
//!
//! In one loop, all joints carry the same wrench. The description of this wrench depends on the
//! space of the wrenches, and not on the choice of rows of the joints.
//!
//! The sentences use twists and wrenches instead of rows. Therefore they do not depend on the
//! equations by which a joint is defined.

use linalg::{Matrix, PivotedQr, small_svd};
use model::space::{cross, difference, dot, norm};
use model::{ConstraintId, Mechanism, Scratch, System};

use crate::limits::{SAME_PLACE, TOLD_LOADS, VISIBLE};
use crate::words::{list, names, place, vector};
use model::words::short;

/// Description of the loads on some joints.
pub(crate) enum LoadDescription {
    /// One load that all joints carry, or all loads of one space.
    Common(String),
    /// The same load at every joint, at its own reference point.
    Each(String),
    /// Joints with their loads: "`A` and `B` a moment about x, `C` a force along z".
    Various(String),
}

/// Describes the loads on these joints. The multipliers (all rows × any number) span the loads.
/// Returns `None` in the plane, and if too many joints carry different loads.
pub(crate) fn tell(
    mechanism: &Mechanism,
    s: &Scratch,
    size: f64,
    joints: &[ConstraintId],
    multipliers: &Matrix,
) -> Option<LoadDescription> {
    let layout = mechanism.layout();
    let reactions = mechanism.reactions(s);
    let places: Vec<[f64; 3]> = joints.iter().map(|&id| reactions.place(id)).collect();
    if layout.space.n_rotations() == 1 {
        return None;
    }
    let about = *places.first()?;
    let images: Vec<Matrix> = joints
        .iter()
        .map(|&id| {
            let rows: Vec<usize> = layout.groups[id.0].rows.iter().collect();
            let own = multipliers.select_rows(&rows);
            let mut image = reactions.wrench_map_about(id, about).product(&own);
            for k in layout.space.torques() {
                image.row_mut(k).iter_mut().for_each(|x| *x /= size);
            }
            image
        })
        .collect();
    let largest = images.iter().map(Matrix::max_abs).fold(0.0, f64::max);
    let mut sets: Vec<(Wrenches, Vec<ConstraintId>)> = Vec::new();
    for (&id, image) in joints.iter().zip(&images) {
        let own = Wrenches::spanned(image, VISIBLE * largest);
        if own.0.ncols() == 0 {
            // The rows of this joint move no body.
            continue;
        }
        match sets.iter_mut().find(|(other, _)| other.is_same(&own)) {
            Some((_, ids)) => ids.push(id),
            None => sets.push((own, vec![id])),
        }
    }
    let all = names(layout, joints);
    let at = Places {
        about,
        size,
        names: all,
        places,
    };
    let mut said: Vec<(String, Vec<ConstraintId>)> = Vec::new();
    for (own, ids) in &sets {
        let is_own: Vec<bool> = joints.iter().map(|id| ids.contains(id)).collect();
        let words = own.words(&at, &is_own);
        match said.iter_mut().find(|(other, _)| *other == words) {
            Some((_, same)) => same.extend(ids),
            None => said.push((words, ids.clone())),
        }
    }
    match said.as_slice() {
        [(words, _)] if sets.len() == 1 => Some(LoadDescription::Common(words.clone())),
        [(words, _)] => Some(LoadDescription::Each(words.clone())),
        said if said.len() <= TOLD_LOADS => {
            let of = |(words, ids): &(String, Vec<ConstraintId>)| {
                format!("{} {words}", list(&names(layout, ids)))
            };
            Some(LoadDescription::Various(
                said.iter().map(of).collect::<Vec<_>>().join(", "),
            ))
        }
        _ => None,
    }
}

/// The joints of a sentence, and the reference point of the moments.
struct Places {
    about: [f64; 3],
    size: f64,
    names: Vec<String>,
    places: Vec<[f64; 3]>,
}

/// A space of wrenches, given by orthonormal columns (6 × d). Each column contains a force, and a
/// moment divided by the size.
struct Wrenches(Matrix);

/// A force and its moment, both dimensionless.
type Wrench = [[f64; 3]; 2];

impl Wrenches {
    /// Returns the space that these columns span. Columns whose size is at most `nothing` are
    /// rounding.
    fn spanned(columns: &Matrix, nothing: f64) -> Self {
        let qr = PivotedQr::of_columns(columns);
        let rank = qr.r_diagonal().filter(|r| r.abs() > nothing).count();
        Self(qr.q_columns(0..rank))
    }

    fn is_same(&self, other: &Self) -> bool {
        let image = self.0.product(&self.0.transpose().product(&other.0));
        let apart = image.as_slice().iter().zip(other.0.as_slice());
        self.0.ncols() == other.0.ncols()
            && apart.map(|(a, b)| (a - b).abs()).all(|x| x <= SAME_PLACE)
    }

    /// Returns wrenches with independent forces, and a basis of the wrenches without a force.
    fn split(&self) -> (Vec<Wrench>, Vec<[f64; 3]>) {
        let d = self.0.ncols();
        let qr = PivotedQr::of_rows(self.0.select_rows(&[0, 1, 2]));
        let rank = qr.r_diagonal().filter(|r| r.abs() > SAME_PLACE).count();
        let combined = |columns: std::ops::Range<usize>| -> Vec<Wrench> {
            let image = self.0.product(&qr.q_columns(columns.clone()));
            let part = |first: usize, j: usize| std::array::from_fn(|k| image[(first + k, j)]);
            (0..columns.len())
                .map(|j| [part(0, j), part(3, j)])
                .collect()
        };
        let couples = combined(rank..d);
        (
            combined(0..rank),
            couples.into_iter().map(|[_, moment]| moment).collect(),
        )
    }

    /// Describes the space, for example "a force along z through `D`" or "forces in all directions
    /// and moments about x and y".
    fn words(&self, at: &Places, own: &[bool]) -> String {
        let (loads, couples) = self.split();
        let forces: Vec<[f64; 3]> = loads.iter().map(|[force, _]| *force).collect();
        let moments = match couples.as_slice() {
            [] => None,
            [one] => Some(format!("a moment about {}", direction(*one))),
            [a, b] => Some(format!("moments {}", across(cross(*a, *b), "about"))),
            _ => Some("moments about all axes".to_owned()),
        };
        let force = match forces.as_slice() {
            [] => None,
            [one] => {
                let is_across = |c: &[f64; 3]| dot(*c, *one).abs() <= SAME_PLACE * norm(one);
                if couples.len() == 2 && couples.iter().all(is_across) {
                    return format!(
                        "a load across the plane of the linkage (force along {} and two moments)",
                        direction(*one)
                    );
                }
                Some(format!("a force along {}", direction(*one)))
            }
            [a, b] => Some(format!("forces {}", across(cross(*a, *b), "along"))),
            _ => Some("forces in all directions".to_owned()),
        };
        let force = force.map(|words| words + &at.through(own, &loads, &couples));
        let said: Vec<String> = force.into_iter().chain(moments).collect();
        list(&said)
    }
}

impl Places {
    /// Describes a point on the lines of action of all forces. The moments `couples` are arbitrary
    /// and are ignored. If a joint of the sentence is at this point, the text contains the name of
    /// the joint. The text is empty if the forces act at the reference points of all their joints.
    /// If no such point exists, the text states the remaining moments.
    fn through(&self, own: &[bool], loads: &[Wrench], couples: &[[f64; 3]]) -> String {
        // The forces are unit vectors, so that moments are lengths.
        let sizes = loads.iter().map(|[force, _]| norm(force));
        let units = loads.iter().zip(sizes);
        let units: Vec<Wrench> = units
            .map(|(w, size)| w.map(|v| v.map(|x| x / size)))
            .collect();
        let free = Matrix::from_fn(3, couples.len(), |i, j| couples[j][i]);
        let held = PivotedQr::of_columns(&free).q_columns(couples.len()..3);
        // Returns the moments about a point (relative, dimensionless) that are not free.
        let moments = |p: [f64; 3]| -> Vec<f64> {
            let about = |[force, moment]: &Wrench| difference(*moment, cross(p, *force));
            units
                .iter()
                .flat_map(|w| held.transpose_times(&about(w)))
                .collect()
        };
        let meet = |p: [f64; 3]| norm(&moments(p)) <= SAME_PLACE;
        let relative = |p: [f64; 3]| difference(p, self.about).map(|x| x / self.size);
        let met: Vec<bool> = self.places.iter().map(|p| meet(relative(*p))).collect();
        if own.iter().zip(&met).all(|(own, met)| *met || !*own) {
            return String::new();
        }
        let named = self.names.iter().zip(&met).filter(|(_, met)| **met);
        if let Some((name, _)) = named.into_iter().next() {
            return format!(" through {name}");
        }
        // The moments are zero, or have a minimum, at the point at which the gradient of their
        // square is zero.
        let zero = moments([0.0; 3]);
        let unit = |k: usize| moments(std::array::from_fn(|i| f64::from(u8::from(i == k))));
        let columns = [0, 1, 2].map(unit);
        let arms = Matrix::from_fn(zero.len(), 3, |i, k| columns[k][i] - zero[i]);
        let svd = small_svd(&arms);
        let mut p = [0.0; 3];
        for (k, sigma) in svd
            .sigma
            .iter()
            .enumerate()
            .filter(|(_, s)| **s > SAME_PLACE)
        {
            let along: f64 = (0..zero.len()).map(|i| svd.u[(i, k)] * zero[i]).sum();
            (0..3).for_each(|i| p[i] -= svd.v[(i, k)] * along / sigma);
        }
        let mut point: [f64; 3] = std::array::from_fn(|k| self.about[k] + self.size * p[k]);
        if let [[force, _]] = units.as_slice() {
            // The point of the line of action that is nearest to the origin.
            let along = dot(point, *force);
            point = std::array::from_fn(|k| point[k] - along * force[k]);
        }
        let through = format!(" through {}", place(&point, self.size));
        match (meet(p), units.as_slice()) {
            (true, _) => through,
            (false, [[force, moment]]) if couples.is_empty() => {
                let pitch = dot(*force, *moment) * self.size;
                format!(
                    "{through} with a moment of {} N·m per N about it",
                    short(pitch)
                )
            }
            _ => " with moments".to_owned(),
        }
    }
}

/// Returns "along x and y" for the directions perpendicular to z, or "across (0.6, 0.8, 0)".
fn across(normal: [f64; 3], word: &str) -> String {
    match direction(normal).as_str() {
        "x" => format!("{word} y and z"),
        "y" => format!("{word} x and z"),
        "z" => format!("{word} x and y"),
        other => format!("{word} all axes across {other}"),
    }
}

/// Returns an axis of the ground, or the components of a unit vector with a positive first
/// component.
fn direction(v: [f64; 3]) -> String {
    let size = norm(&v);
    let unit = v.map(|x| {
        if x.abs() > SAME_PLACE * size {
            x / size
        } else {
            0.0
        }
    });
    match unit.map(|x| x != 0.0) {
        [true, false, false] => "x".to_owned(),
        [false, true, false] => "y".to_owned(),
        [false, false, true] => "z".to_owned(),
        _ => {
            let first = unit.into_iter().find(|x| *x != 0.0).unwrap_or(1.0);
            vector(unit.map(|x| x * first.signum()), 1.0)
        }
    }
}
