//! Decides to first order, in exact arithmetic, whether a redundancy exists at all configurations
//! or only at the drawn configuration. The test uses velocities v that the holonomic rows without
//! drives allow. Along a motion with velocities v, the rank is the same to first order if and only
//! if `Zᵀ·Ċ(v)·N = 0`, with bases Z of null(Cᵀ) and N of ker C.
//!
//! The rows of a joint are a set of wrenches that spans all wrenches of the joint. Each wrench is a
//! product of at most two vectors, so the difference over ±v is exactly twice the derivative.
//! Additional wrenches in a set depend on the other wrenches at every configuration, so they have
//! no effect.

use exact::Exact;
use num_bigint::BigInt;

use super::drawing::{Drawing, Joint, Kind, Measure, Side};
use super::ratio::{Ratio, whole_multiples};
use super::vector::Vector;
use crate::fuzz::exact::expected::Elsewhere;
use crate::fuzz::exact::truth::Truth;
use crate::fuzz::exact::wrench::{Meaning, Wrench};

/// The twist of a body: velocity of the body point at the origin of the ground, and angular
/// velocity.
type Twist = [Vector; 2];

/// Returns the rank of a drawing at other configurations.
///
/// The result is "same" if the rank of all rows and the rank of the holonomic rows are both the
/// same to first order along all velocities. Rows that prevent slip may exclude to first order a
/// motion that the other rows allow. An example is a tilting wheel on a spherical hub. The result
/// is then "unknown". The result is "higher" if the rank of all rows increases along a velocity
/// that certainly belongs to a motion, because the holonomic rows without drives are independent.
#[must_use]
pub fn elsewhere(truth: &Truth, drawing: &Drawing) -> Elsewhere {
    let all = |_: &Row| true;
    let holonomic = |row: &Row| row.leads;
    if truth.redundancy() == 0 {
        return Elsewhere::Same;
    }
    let leading =
        truth.rows_where(|row| !row.meaning.is_nonholonomic() && row.meaning != Meaning::Driven);
    let stays = is_permanent_of(drawing, all);
    if stays && is_permanent_of(drawing, holonomic) {
        Elsewhere::Same
    } else if !stays && truth.rank_of(&leading) == leading.len() {
        Elsewhere::Higher
    } else {
        Elsewhere::Unknown
    }
}

fn is_permanent_of(drawing: &Drawing, wanted: impl Fn(&Row) -> bool) -> bool {
    let rows = |velocity: &[Twist]| {
        let rows = rows(drawing, velocity).into_iter();
        rows.filter(&wanted).collect::<Vec<Row>>()
    };
    let matrix = |rows: &[&Row]| -> Vec<Vec<BigInt>> {
        let whole = |row: &&Row| whole_multiples(&row.wrench.numbers()).0;
        let rows = rows.iter();
        rows.map(|row| on_bodies(drawing, row.sides, &whole(row)))
            .collect()
    };
    let still = rows(&vec![
        [Vector::zero(), Vector::zero()];
        drawing.bodies.len()
    ]);
    let all = matrix(&still.iter().collect::<Vec<_>>());
    let exact = Exact::of_whole(all.clone());
    let left = exact.null_space();
    if left.is_empty() {
        return true;
    }
    let leading = matrix(&still.iter().filter(|row| row.leads).collect::<Vec<_>>());
    let columns = 6 * drawing.bodies.len();
    let motions = kernel(&leading, columns);
    let free: Vec<Vec<Twist>> = kernel(&all, columns).iter().map(|n| twists(n)).collect();
    motions.iter().all(|motion| {
        let there = twists(motion);
        let back: Vec<Twist> = there.iter().map(|t| t.each_ref().map(|x| -x)).collect();
        let pairs = rows(&there).into_iter().zip(rows(&back));
        // The factors that convert the rows to integers are included.
        let changes: Vec<Wrench> = pairs
            .zip(&still)
            .map(|((a, b), row)| {
                let factor = whole_multiples(&row.wrench.numbers()).1;
                Wrench {
                    force: (&a.wrench.force - &b.wrench.force).times(&factor),
                    moment: (&a.wrench.moment - &b.wrench.moment).times(&factor),
                }
            })
            .collect();
        free.iter().all(|n| {
            let powers = still.iter().zip(&changes);
            let powers = powers.map(|(row, change)| power(change, row.sides, n));
            let powers: Vec<Ratio> = powers.collect();
            left.iter().all(|z| {
                let terms = z.iter().zip(&powers);
                let terms = terms.map(|(z, power)| &Ratio::new(z.clone(), 1) * power);
                terms.fold(Ratio::zero(), |sum, x| &sum + &x).is_zero()
            })
        })
    })
}

/// Returns the row of C: the wrench on the second body, and the opposite wrench on the first body.
fn on_bodies(drawing: &Drawing, sides: [Side; 2], wrench: &[BigInt]) -> Vec<BigInt> {
    let mut row = vec![BigInt::default(); 6 * drawing.bodies.len()];
    for (side, sign) in sides.into_iter().zip([-1, 1]) {
        let Some(body) = side else { continue };
        for (entry, x) in row[6 * body..].iter_mut().zip(wrench) {
            *entry += x * sign;
        }
    }
    row
}

struct Row {
    sides: [Side; 2],
    wrench: Wrench,
    /// Whether the row restricts the configurations of the mechanism, whatever the motion of its
    /// drives.
    leads: bool,
}

/// Returns the kernel of a matrix with this number of columns.
fn kernel(rows: &[Vec<BigInt>], columns: usize) -> Vec<Vec<BigInt>> {
    let column = |j: usize| rows.iter().map(|row| row[j].clone()).collect();
    let exact = Exact::of_whole((0..columns).map(column).collect());
    exact.null_space().to_vec()
}

fn twists(numbers: &[BigInt]) -> Vec<Twist> {
    let vector = |x: &[BigInt]| Vector([0, 1, 2].map(|k| Ratio::new(x[k].clone(), 1)));
    let bodies = numbers.chunks_exact(6);
    bodies.map(|x| [vector(&x[..3]), vector(&x[3..])]).collect()
}

/// Returns the power of a wrench on the second body and of the opposite wrench on the first body.
fn power(wrench: &Wrench, sides: [Side; 2], twists: &[Twist]) -> Ratio {
    let of = |side: Side| {
        side.map_or(Ratio::zero(), |k| {
            let [velocity, omega] = &twists[k];
            &wrench.force.dot(velocity) + &wrench.moment.dot(omega)
        })
    };
    &of(sides[1]) - &of(sides[0])
}

/// Returns spanning wrenches of all joints and drives after every point and direction has moved by
/// its velocity.
fn rows(drawing: &Drawing, velocity: &[Twist]) -> Vec<Row> {
    let moved = |joint: &Joint| displaced(joint, velocity);
    let joints = drawing.joints.iter().flat_map(|joint| {
        let wrenches = spanning(&moved(joint)).into_iter().enumerate();
        // For a wheel only the first row, the contact, is holonomic.
        let leads = |k: usize| match joint.kind {
            Kind::KnifeEdge { .. } => false,
            Kind::Wheel { .. } => k == 0,
            _ => true,
        };
        wrenches.map(move |(k, wrench)| Row {
            sides: joint.bodies,
            wrench,
            leads: leads(k),
        })
    });
    let drives = drawing.drives.iter().map(|drive| {
        let joint = &drawing.joints[drive.joint];
        Row {
            sides: joint.bodies,
            wrench: super::rows::driven(&moved(joint), drive.measure),
            leads: false,
        }
    });
    joints.chain(drives).collect()
}

/// Returns the joint after each point and direction has moved by its velocity.
fn displaced(joint: &Joint, velocity: &[Twist]) -> Kind {
    let twist = |side: Side| side.map(|k| &velocity[k]);
    let point = |side: usize, p: &Vector| match twist(joint.bodies[side]) {
        Some([v, omega]) => &(p + v) + &omega.cross(p),
        None => p.clone(),
    };
    let direction = |side: usize, d: &Vector| match twist(joint.bodies[side]) {
        Some([_, omega]) => d + &omega.cross(d),
        None => d.clone(),
    };
    let mut moved = joint.kind.clone();
    match &mut moved {
        Kind::Spherical { at } | Kind::Fixed { at } => *at = point(1, at),
        Kind::Revolute { at, axis } => (*at, *axis) = (point(1, at), direction(0, axis)),
        Kind::Universal { at, first, second } => {
            *at = point(1, at);
            (*first, *second) = (direction(0, first), direction(1, second));
        }
        Kind::Translational { from, at, axis }
        | Kind::Cylindrical { from, at, axis }
        | Kind::PointOnLine { from, at, axis }
        | Kind::Planar {
            from,
            at,
            normal: axis,
        }
        | Kind::PointOnPlane {
            from,
            at,
            normal: axis,
        } => {
            (*from, *at) = (point(0, from), point(1, at));
            *axis = direction(0, axis);
        }
        Kind::Parallel { axis } => *axis = direction(0, axis),
        Kind::Perpendicular { first, second } => {
            (*first, *second) = (direction(0, first), direction(1, second));
        }
        Kind::Orientation => {}
        Kind::Distance { from, at } => (*from, *at) = (point(0, from), point(1, at)),
        Kind::KnifeEdge { at, normal } => (*at, *normal) = (point(0, at), direction(0, normal)),
        Kind::Wheel {
            centre,
            axis,
            contact,
            normal,
        } => {
            // The vector from the centre to the lowest point of the circle is λ·D with D = (n·a)·a
            // − (a·a)·n.
            let change = &direction(0, axis) - axis;
            let share = normal.dot(axis);
            let down = &axis.times(&share) - &normal.times(&axis.square());
            let turned = &change.times(&share) + &axis.times(&normal.dot(&change));
            let along = &down.dot(&turned) / &down.square();
            let spoke = &*contact - &*centre;
            let length = &spoke.dot(&down) / &down.square();
            let turned = (&turned - &down.times(&along)).times(&length);
            let travel = &point(0, centre) - &*centre;
            *contact = &(&*contact + &travel) + &turned;
        }
    }
    moved
}

/// Returns wrenches that span all wrenches of a joint. Each wrench is a product of at most two
/// vectors.
fn spanning(kind: &Kind) -> Vec<Wrench> {
    let units = [0, 1, 2].map(Vector::unit);
    let each = |wrench: &dyn Fn(&Vector) -> Wrench| units.each_ref().map(wrench).to_vec();
    let point = |at: &Vector| each(&|e| Wrench::line(at, e));
    let offsets = |at: &Vector, w: &Vector| each(&|e| Wrench::line(at, &e.cross(w)));
    let directions = |w: &Vector| each(&|e| Wrench::couple(e.cross(w)));
    let orientation = || each(&|e| Wrench::couple(e.clone()));
    let perpendicular = |a: &Vector, b: &Vector| vec![Wrench::couple(b.cross(a))];
    match kind {
        Kind::Spherical { at } => point(at),
        Kind::Revolute { at, axis } => [point(at), directions(axis)].concat(),
        Kind::Universal { at, first, second } => [point(at), perpendicular(first, second)].concat(),
        Kind::Translational { at, axis, .. } => [offsets(at, axis), orientation()].concat(),
        Kind::Cylindrical { at, axis, .. } => [offsets(at, axis), directions(axis)].concat(),
        Kind::Planar { at, normal, .. } => {
            [vec![Wrench::line(at, normal)], directions(normal)].concat()
        }
        Kind::Fixed { at } => [point(at), orientation()].concat(),
        Kind::PointOnLine { at, axis, .. } => offsets(at, axis),
        Kind::PointOnPlane { at, normal, .. } | Kind::KnifeEdge { at, normal } => {
            vec![Wrench::line(at, normal)]
        }
        Kind::Parallel { axis } => directions(axis),
        Kind::Perpendicular { first, second } => perpendicular(first, second),
        Kind::Orientation => orientation(),
        Kind::Distance { .. } => vec![super::rows::driven(kind, Measure::Length)],
        Kind::Wheel {
            contact, normal, ..
        } => {
            // The plane belongs to the ground, so its normal and tangents are constant.
            let u = Vector::unit(least(normal)).cross(normal);
            let v = normal.cross(&u);
            [normal, &u, &v].map(|d| Wrench::line(contact, d)).to_vec()
        }
    }
}

/// Returns the coordinate axis with the smallest component of a vector.
fn least(d: &Vector) -> usize {
    let sizes = d.0.each_ref().map(Ratio::abs);
    (1..3).fold(0, |k, j| if sizes[j].is_below(&sizes[k]) { j } else { k })
}

#[cfg(test)]
mod tests {
    use super::super::catalogue;
    use super::*;

    /// Parallelograms can leave their singular configuration on a branch that is not parallel.
    #[test]
    fn what_belongs_to_the_mechanism_and_what_to_its_pose() {
        let drawings = catalogue::all().into_iter();
        let singular = drawings
            .filter(|(_, drawing)| elsewhere(&Truth::of(drawing), drawing) != Elsewhere::Same);
        let singular: Vec<&str> = singular.map(|(name, _)| name).collect();
        assert_eq!(singular, ["V6 two parallelograms, flat"]);
    }
}
