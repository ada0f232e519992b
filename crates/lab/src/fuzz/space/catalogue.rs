//! Mechanisms whose results were derived by hand: textbook linkages and similar mechanisms, with
//! rational coordinates. The tests in this folder contain the results.

#[cfg(test)]
mod tests;

use super::drawing::{Drawing, GROUND, Kind, Measure, Side};
use super::ratio::Ratio;
use super::vector::{Rotation, Vector, parts, whole};

/// Returns all mechanisms of the catalogue with their names.
#[must_use]
pub fn all() -> Vec<(&'static str, Drawing)> {
    use Flat::{C, P, R, S, U};
    let hinges = |kinds: &[Flat]| {
        let places = kinds.iter().zip([0, 3, 7, 12]);
        let hinges = places.map(|(kind, z)| flat(*kind, &parts([2, 5, z], 10)));
        door(&hinges.collect::<Vec<_>>())
    };
    let corners = [[0, 0], [4, 0], [1, 3], [5, 4], [-2, 3]];
    let balls = [[3, 0], [-2, 3], [-1, -4], [2, 5]];
    vec![
        ("V1 three hinges", hinges(&[R, R, R])),
        ("V1 two hinges", hinges(&[R, R])),
        ("V1 four hinges", hinges(&[R, R, R, R])),
        ("V1 revolute and two cylindrical", hinges(&[R, C, C])),
        ("V3 RRRR", four_bar([R, R, R, R])),
        ("V3 RRRS", four_bar([R, R, R, S])),
        ("V3 RRSC", four_bar([R, R, S, C])),
        ("V3 RSCR", four_bar([R, S, C, R])),
        ("V3 RRCR", four_bar([R, R, C, R])),
        ("V3 RSSR", four_bar([R, S, S, R])),
        ("V3 RRUS", four_bar([R, R, U, S])),
        (
            "V3 RRUS with axes along z and C–D",
            four_bar_with_flat_cross(),
        ),
        ("V4 RRRP", slider_crank([R, R, R, P])),
        ("V4 RRCP", slider_crank([R, R, C, P])),
        ("V4 RRSP", slider_crank([R, R, S, P])),
        ("V4 RSRP", slider_crank([R, S, R, P])),
        ("V4 RSUP", slider_crank([R, S, U, P])),
        ("V5 three cranks", three_cranks()),
        ("V6 two parallelograms", parallelograms(2, [3, 4])),
        ("V6 two parallelograms, flat", parallelograms(2, [5, 0])),
        ("V8 Oldham", oldham()),
        ("V10 Hooke with its cross", hooke_with_cross()),
        ("V10 Hooke as universal joint", hooke_as_universal()),
        ("V11 Bennett", bennett()),
        ("V13 Bricard", bricard()),
        ("V14 Sarrus with two legs", sarrus(&[0, 1])),
        ("V14 Sarrus with three legs", sarrus(&[0, 1, 2])),
        ("V16 table on three points", table(&corners[..3])),
        ("V16 table on four points", table(&corners[..4])),
        ("V16 table on five points", table(&corners)),
        ("V17 three balls in grooves", grooves(&balls[..3])),
        ("V17 four balls in grooves", grooves(&balls)),
        ("V18 6-UPS", hexapod(false)),
        ("V18 6-UPS, driven", hexapod(true)),
        ("V19 Delta", delta()),
        ("V22 car, straight", car(&Ratio::zero())),
        ("V22 car, front axle turned", car(&Ratio::new(1, 10))),
    ]
}

/// A kind of joint of a planar mechanism in space. The third axis is normal to the plane of the
/// mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flat {
    /// Revolute joint about the normal.
    R,
    /// Cylindrical joint along the normal.
    C,
    /// Spherical joint.
    S,
    /// Translational joint in the plane along its first axis.
    P,
    /// Universal joint with both axes oblique.
    U,
}

/// Returns the joint at a point, for the normal z.
#[must_use]
pub fn flat(kind: Flat, at: &Vector) -> Kind {
    let (at, axis) = (at.clone(), Vector::unit(2));
    match kind {
        Flat::R => Kind::Revolute { at, axis },
        Flat::C => cylindrical(&at, &axis),
        Flat::S => Kind::Spherical { at },
        Flat::P => translational(&at, &Vector::unit(0)),
        Flat::U => Kind::Universal {
            at,
            first: whole([1, 2, 2]),
            second: whole([2, 1, -2]),
        },
    }
}

/// Returns a revolute joint.
#[must_use]
pub fn revolute(at: &Vector, axis: &Vector) -> Kind {
    Kind::Revolute {
        at: at.clone(),
        axis: axis.clone(),
    }
}

/// Returns a cylindrical joint with both points at the same position.
#[must_use]
pub fn cylindrical(at: &Vector, axis: &Vector) -> Kind {
    Kind::Cylindrical {
        from: at.clone(),
        at: at.clone(),
        axis: axis.clone(),
    }
}

/// Returns a translational joint with both points at the same position.
#[must_use]
pub fn translational(at: &Vector, axis: &Vector) -> Kind {
    Kind::Translational {
        from: at.clone(),
        at: at.clone(),
        axis: axis.clone(),
    }
}

/// Joins two sides by a chain of joints with new bodies between them; returns the bodies.
pub fn chain(drawing: &mut Drawing, from: Side, to: Side, kinds: &[Kind]) -> Vec<Side> {
    let mut bodies = Vec::new();
    let mut last = from;
    for (k, kind) in kinds.iter().enumerate() {
        let next = if k + 1 == kinds.len() {
            to
        } else {
            let body = drawing.body();
            bodies.push(body);
            body
        };
        drawing.joint([last, next], kind.clone());
        last = next;
    }
    bodies
}

/// Returns a single loop through the ground.
#[must_use]
pub fn ring(kinds: &[Kind]) -> Drawing {
    let mut drawing = Drawing::default();
    chain(&mut drawing, GROUND, GROUND, kinds);
    drawing
}

/// Case V1: a door on hinges.
#[must_use]
pub fn door(kinds: &[Kind]) -> Drawing {
    let mut drawing = Drawing::default();
    let door = drawing.body();
    for kind in kinds {
        drawing.joint([GROUND, door], kind.clone());
    }
    drawing
}

/// Returns the pivots of the four-bar of V3.
#[must_use]
pub fn four_bar_points() -> [Vector; 4] {
    [[0, 0, 0], [3, 8, 0], [15, 11, 0], [14, 0, 0]].map(|p| parts(p, 10))
}

/// Case V3: the four-bar with joints of these kinds at A, B, C, D.
#[must_use]
pub fn four_bar(kinds: [Flat; 4]) -> Drawing {
    let joints = kinds.iter().zip(four_bar_points());
    ring(&joints.map(|(kind, p)| flat(*kind, &p)).collect::<Vec<_>>())
}

/// Case V3: R R U S. The axes of the universal joint are along z and along the line from C to D.
#[must_use]
pub fn four_bar_with_flat_cross() -> Drawing {
    let [_, _, at, d] = four_bar_points();
    let mut drawing = four_bar([Flat::R, Flat::R, Flat::U, Flat::S]);
    drawing.joints[2].kind = Kind::Universal {
        first: Vector::unit(2),
        second: &d - &at,
        at,
    };
    drawing
}

/// Case V4: a slider-crank with the crank at the origin, crank pin, rod end, and slider on the
/// ground along x.
#[must_use]
pub fn slider_crank(kinds: [Flat; 4]) -> Drawing {
    let points = [[0, 0, 0], [3, 4, 0], [15, -1, 0], [15, -1, 0]].map(|p| parts(p, 10));
    let joints = kinds.iter().zip(points);
    ring(&joints.map(|(kind, p)| flat(*kind, &p)).collect::<Vec<_>>())
}

/// Case V5: a coupler on three parallel cranks of equal length.
#[must_use]
pub fn three_cranks() -> Drawing {
    let mut drawing = Drawing::default();
    let coupler = drawing.body();
    for x in [0, 10, 17] {
        let (low, high) = (parts([x, 0, 0], 10), parts([x + 3, 4, 0], 10));
        let joints = [flat(Flat::R, &low), flat(Flat::R, &high)];
        chain(&mut drawing, GROUND, coupler, &joints);
    }
    drawing
}

/// Case V6: parallelograms side by side that share their cranks. The cranks point along `crank`, a
/// vector in tenths of a metre.
#[must_use]
pub fn parallelograms(count: usize, crank: [i64; 2]) -> Drawing {
    let mut drawing = Drawing::default();
    let mut before = GROUND;
    for k in 0..=count {
        let low = parts([10 * k as i64, 0, 0], 10);
        let high = &low + &parts([crank[0], crank[1], 0], 10);
        let bar = drawing.body();
        drawing.joint([GROUND, bar], flat(Flat::R, &low));
        if k > 0 {
            let left = &high - &whole([1, 0, 0]);
            let joints = [flat(Flat::R, &left), flat(Flat::R, &high)];
            chain(&mut drawing, before, bar, &joints);
        }
        before = bar;
    }
    drawing
}

/// Case V8: an Oldham coupling with the shafts along z.
#[must_use]
pub fn oldham() -> Drawing {
    let (left, right) = (whole([0; 3]), parts([1, 2, 0], 10));
    ring(&[
        flat(Flat::R, &left),
        translational(&left, &whole([3, 4, 0])),
        translational(&right, &whole([-4, 3, 0])),
        flat(Flat::R, &right),
    ])
}

/// Returns the shafts of V10, and the axes of its cross.
fn hooke_axes() -> [Vector; 4] {
    // The cross is perpendicular to both shafts: x, and the perpendicular axis in the plane.
    [
        whole([0, 0, 1]),
        whole([1, 0, 0]),
        whole([0, 4, -3]),
        whole([0, 3, 4]),
    ]
}

/// Case V10: a Hooke joint between two shafts in bearings, with its cross as a body.
#[must_use]
pub fn hooke_with_cross() -> Drawing {
    let [first, a, b, second] = hooke_axes();
    let centre = Vector::zero();
    ring(&[
        revolute(&first.times(&Ratio::whole(-2)), &first),
        revolute(&centre, &a),
        revolute(&centre, &b),
        revolute(&second.times(&Ratio::new(2, 5)), &second),
    ])
}

/// Case V10 as a universal joint.
#[must_use]
pub fn hooke_as_universal() -> Drawing {
    let [shaft, first, second, other] = hooke_axes();
    let at = Vector::zero();
    ring(&[
        revolute(&shaft.times(&Ratio::whole(-2)), &shaft),
        Kind::Universal { at, first, second },
        revolute(&other.times(&Ratio::new(2, 5)), &other),
    ])
}

/// Case V11: a Bennett linkage.
#[must_use]
pub fn bennett() -> Drawing {
    let points = [
        whole([0, 0, 0]),
        whole([0, 3, 0]),
        parts([-16, -9, 12], 13),
        whole([-4, 0, 0]),
    ];
    let axes = [[0, 0, 1], [3, 0, 4], [-3, 4, 12], [0, 4, 3]].map(whole);
    let joints = points.iter().zip(&axes);
    ring(&joints.map(|(p, a)| revolute(p, a)).collect::<Vec<_>>())
}

/// Case V13: a Bricard linkage of five rods.
#[must_use]
pub fn bricard() -> Drawing {
    let points = [
        [0, 0, 0],
        [1, 0, 0],
        [1, -1, 0],
        [1, -1, 1],
        [0, -1, 1],
        [0, 0, 1],
    ];
    let axes = [1, 2, 0, 1, 2, 0].map(Vector::unit);
    let joints = points.into_iter().map(whole).zip(&axes);
    ring(&joints.map(|(p, a)| revolute(&p, a)).collect::<Vec<_>>())
}

/// Case V14: a Sarrus linkage whose legs (chains of three hinges) are at these multiples of 90°.
#[must_use]
pub fn sarrus(quarters: &[usize]) -> Drawing {
    let mut drawing = Drawing::default();
    let platform = drawing.body();
    for &quarter in quarters {
        let turn = [[1, 0, 0, 0], [1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, -1]][quarter % 4];
        let turn = Rotation::whole(turn);
        let points = [[10, 0, 0], [14, 0, 3], [10, 0, 6]].map(|p| turn.of(&parts(p, 10)));
        let axis = turn.of(&Vector::unit(1));
        let joints = points.each_ref().map(|p| revolute(p, &axis));
        chain(&mut drawing, GROUND, platform, &joints);
    }
    drawing
}

/// Case V16: a table on points of a horizontal plane.
#[must_use]
pub fn table(points: &[[i64; 2]]) -> Drawing {
    let mut drawing = Drawing::default();
    let table = drawing.body();
    for &[x, y] in points {
        let at = whole([x, y, 0]);
        let kind = Kind::PointOnPlane {
            from: at.clone(),
            at,
            normal: Vector::unit(2),
        };
        drawing.joint([GROUND, table], kind);
    }
    drawing
}

/// Case V17: balls of a body in grooves of the ground that point to a centre.
#[must_use]
pub fn grooves(points: &[[i64; 2]]) -> Drawing {
    let mut drawing = Drawing::default();
    let body = drawing.body();
    for &[x, y] in points {
        let at = whole([x, y, 0]);
        let kind = Kind::PointOnLine {
            from: at.clone(),
            axis: at.clone(),
            at,
        };
        drawing.joint([GROUND, body], kind);
    }
    drawing
}

/// Case V18: a platform on six legs with a universal, a translational and a spherical joint each.
#[must_use]
pub fn hexapod(driven: bool) -> Drawing {
    let mut drawing = Drawing::default();
    let platform = drawing.body();
    // Rational approximations of the tangents of 60°, ±0.125 rad and ±0.4 rad.
    let third = Ratio::new(173, 100);
    let turn = |t: &Ratio| Rotation::about(&Vector::unit(2), t);
    for k in 0..3 {
        let mut sector = Rotation::none();
        for _ in 0..k {
            sector = turn(&third).after(&sector);
        }
        for side in [-1, 1] {
            let (low, high) = (Ratio::new(side, 8), Ratio::new(21 * side, 50));
            let base = sector.after(&turn(&low)).of(&parts([3, 0, 0], 2));
            let top = sector.after(&turn(&high)).of(&parts([4, 0, 6], 5));
            let leg = &top - &base;
            let first = Vector::unit(2).cross(&leg);
            let second = leg.cross(&first);
            let middle = base.along(&Ratio::new(1, 2), &leg);
            let slider = drawing.joints.len() + 1;
            let joints = [
                Kind::Universal {
                    at: base,
                    first,
                    second,
                },
                translational(&middle, &leg),
                Kind::Spherical { at: top },
            ];
            chain(&mut drawing, GROUND, platform, &joints);
            if driven {
                drawing.drive(slider, Measure::Displacement);
            }
        }
    }
    drawing
}

/// Case V19: a Delta robot with revolute parallelograms. Each leg has an upper arm and a
/// parallelogram of two bars between two short rods. The hinges of a leg on base, elbow and
/// platform are parallel.
#[must_use]
pub fn delta() -> Drawing {
    let mut drawing = Drawing::default();
    let platform = drawing.body();
    let third = Rotation::about(&Vector::unit(2), &Ratio::new(173, 100));
    let mut sector = Rotation::none();
    // The arms have different angles, so the platform is not below the centre of the base.
    for arm in [[3, 0, 4], [4, 0, 3], [5, 0, 0]] {
        let place = |p: [i64; 3]| sector.of(&parts(p, 10));
        let (axis, base) = (sector.of(&Vector::unit(1)), place([20, 0, 80]));
        let (elbow, corner) = (
            &base + &place(arm),
            &place([8, 0, 0]) + &parts([1, 2, 0], 10),
        );
        // The hinges of the parallelogram are perpendicular to its plane.
        let across = axis.cross(&(&corner - &elbow));
        let [upper, top, bottom] = [0; 3].map(|_| drawing.body());
        let hinges = [
            ([GROUND, upper], &base),
            ([upper, top], &elbow),
            ([bottom, platform], &corner),
        ];
        for (pair, at) in hinges {
            drawing.joint(pair, revolute(at, &axis));
        }
        for side in [-2, 2] {
            let side = place([0, side, 0]);
            let joints = [&elbow, &corner].map(|at| revolute(&(at + &side), &across));
            chain(&mut drawing, top, bottom, &joints);
        }
        sector = third.after(&sector);
    }
    drawing
}

/// Returns four-bars in series. The first four-bar is mounted on the ground. Each other four-bar is
/// mounted on the coupler of the previous four-bar. The planes of the four-bars have different
/// directions. Each four-bar adds 20 rows, three of which are redundant, and one degree of freedom.
#[must_use]
pub fn four_bars_in_a_row(count: usize) -> Drawing {
    let turns = [[1, 0, 0, 0], [3, 1, 0, 0], [3, 0, 1, 0], [2, 1, 1, 1]].map(Rotation::whole);
    let mut drawing = Drawing::default();
    let mut base = GROUND;
    for k in 0..count {
        // The chain is folded back and forth in a box, so that a long chain is in a small region.
        let (x, row) = (k % FOLD, k / FOLD);
        let (y, layer) = (row % FOLD, row / FOLD);
        let fold = |at: usize, lines: usize| {
            if lines.is_multiple_of(2) {
                at
            } else {
                FOLD - 1 - at
            }
        };
        let [x, y, z] = [fold(x, row), fold(y, layer), layer].map(|at| 2 * at as i64);
        let (turn, origin) = (&turns[k % turns.len()], whole([x, y, z]));
        let points = four_bar_points().map(|p| &origin + &turn.of(&p));
        let joints = points.each_ref().map(|p| revolute(p, &turn.axes()[2]));
        let first = drawing.bodies.len();
        let bodies = chain(&mut drawing, base, base, &joints);
        for (body, p) in drawing.bodies[first..].iter_mut().zip(points) {
            body.position = p;
        }
        base = bodies[1];
    }
    drawing
}

/// Number of four-bars along each edge of the box.
const FOLD: usize = 32;

/// Case V22: a chassis on four wheels on the plane z = 0. The argument is the tangent of half the
/// steering angle of both front wheels.
#[must_use]
pub fn car(half_tangent: &Ratio) -> Drawing {
    let mut drawing = Drawing::default();
    let chassis = drawing.body();
    for (x, y) in [(13, 7), (13, -7), (-13, 7), (-13, -7)] {
        let centre = parts([x, y, 3], 10);
        let steering = Rotation::about(&Vector::unit(2), half_tangent);
        let axis = if x > 0 {
            steering.of(&Vector::unit(1))
        } else {
            Vector::unit(1)
        };
        let wheel = drawing.body();
        drawing.joint([chassis, wheel], revolute(&centre, &axis));
        let kind = Kind::Wheel {
            centre,
            axis,
            contact: parts([x, y, 0], 10),
            normal: Vector::unit(2),
        };
        drawing.joint([wheel, GROUND], kind);
    }
    drawing
}
