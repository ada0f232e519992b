//! Machines in space.

use pfaff::dynamics::equilibrium::EquilibriumOptions;
use pfaff::model::System;
use pfaff::scene::Setting;

use super::jet::{Jet, corner, steps};
use super::tables::{Run, SHARE, scene};
use super::works::{
    Machine, Moving, Push, Vector, cross, difference, dot, drive_loads, solved, sum, times, values,
};

/// The machines with a test here.
pub(super) const MACHINES: &[&str] = &["bed", "gantry", "scissor-lift", "slider", "wishbone"];

const G: f64 = 9.81;

const DOWN: Vector = [0.0, 0.0, -G];

const ALL: &[&str] = &["Fx", "Fy", "Fz"];

const MOMENTS: &[&str] = &["Tx", "Ty", "Tz"];

fn rows(run: &Run) -> Vec<usize> {
    (0..run.times.len()).step_by(8).collect()
}

/// A point that moves along x.
fn advanced([x, y, z]: Vector, by: Jet) -> [Jet; 3] {
    [by + x, y.into(), z.into()]
}

/// The slide only translates. Both bushings together carry all loads across the rails, and the
/// screw, whose force is on the line of rail A, the rest. Bushings that may turn about their rails
/// leave the moment about rail A to the vertical force of rail B, so both vertical forces are
/// determined. The other six loads of the bushings have three determined sums.
#[test]
fn slider() {
    let machine = |t: f64| {
        let by = steps(&[(0.0, 0.6, 0.6)], t);
        Machine {
            gravity: DOWN,
            bodies: vec![Moving::sliding(120.0, advanced([0.0, 0.03, 0.15], by))],
            pushes: vec![Push {
                body: 0,
                at: advanced([0.05, 0.1, 0.35], by),
                force: [-2000.0, 800.0, -1500.0],
            }],
            springs: vec![],
        }
    };
    // The reactions on the rails refer to the points of the ground as drawn.
    let (rail_a, rail_b) = ([0.0, -0.2, 0.0], [0.0, 0.2, 0.0]);
    let loads = |t: f64| {
        let (force, torque) = machine(t).needs(&[0], rail_a);
        (force, torque, torque[0] / 0.4)
    };
    let run = Run::of("slider", None);
    for row in rows(&run) {
        let (force, torque, on_b) = loads(run.times[row]);
        run.equals("screw.drive", row, -force[0]);
        run.equals("rail A.Fz", row, -(force[2] - on_b));
        run.equals("rail B.Fz", row, -on_b);
        run.force(
            "both rails",
            row,
            times(-1.0, [0.0, force[1], force[2]]),
            ALL,
        );
        run.force("both rails", row, times(-1.0, torque), MOMENTS);
    }
    run.redundancy(3);
    run.not_unique(&["rail A", "rail B"]);
    run.peak("screw", "drive");

    let run = Run::of("slider", Some("floating"));
    for row in rows(&run) {
        let t = run.times[row];
        let (force, torque, on_b) = loads(t);
        let contact = sum(rail_b, [steps(&[(0.0, 0.6, 0.6)], t).x, 0.0, 0.0]);
        let lift = [0.0, 0.0, on_b];
        run.equals("screw.drive", row, -force[0]);
        run.force("support B", row, times(-1.0, lift), ALL);
        let about_b = cross(difference(contact, rail_b), lift);
        run.force("support B", row, times(-1.0, about_b), MOMENTS);
        let on_a = [0.0, force[1], force[2] - on_b];
        run.force("rail A", row, times(-1.0, on_a), ALL);
        let about_a = difference(torque, cross(difference(contact, rail_a), lift));
        run.force("rail A", row, times(-1.0, about_a), MOMENTS);
    }
    run.redundancy(0);
    run.not_unique(&[]);
}

/// The legs turn by the triangle of their foot and the ends of the cylinder, and the table rises
/// without moving along x. The force of the cylinder follows from virtual work, so the place of the
/// pallet on the table is not in it. Of the other loads only sums of the left and the right side in
/// the plane of the legs are determined: four bodies without the pallet have 24 velocities and one
/// motion, so 15 of their 38 rows are redundant.
#[test]
fn scissor_lift() {
    let cases = [
        (None, 1000.0, [0.9, 0.0]),
        (Some("edge"), 1000.0, [1.6, 0.3]),
        (Some("unloaded"), 0.0, [0.9, 0.0]),
    ];
    for (case, pallet, [px, py]) in cases {
        let run = Run::of("scissor-lift", case);
        let (leg, foot) = (2.0, [0.6, -0.05_f64]);
        let start = 25.0_f64.to_radians();
        let lug = 0.7 * leg;
        let [d, e] = [leg * start.cos(), leg * start.sin()];
        let drawn = (0.7 * d - foot[0]).hypot(0.7 * e - foot[1]);
        let reach = foot[0].hypot(foot[1]);
        let angle = |stroke: Jet| corner(reach, lug, stroke + drawn) + foot[1].atan2(foot[0]);
        let machine = |s: &[Jet]| {
            let phi = angle(s[0]);
            let (d, e) = (phi.cos() * leg, phi.sin() * leg);
            let middle = |y: f64| [d * 0.5, y.into(), e * 0.5];
            let turning = |mass, inertia, y, angle| Moving {
                mass,
                inertia,
                axis: [0.0, -1.0, 0.0], // from x to z
                centre: middle(y),
                angle,
            };
            Machine {
                gravity: DOWN,
                bodies: vec![
                    turning(110.0, 40.0, 0.0, phi),
                    turning(45.0, 16.0, 0.45, -phi),
                    turning(45.0, 16.0, -0.45, -phi),
                    Moving::sliding(260.0, [0.95.into(), 0.0.into(), e + 0.06]),
                    Moving::sliding(pallet, [px.into(), py.into(), e + 0.5]),
                ],
                pushes: vec![],
                springs: vec![],
            }
        };
        for row in rows(&run) {
            let motion = [steps(&[(0.5, 6.5, 0.35)], run.times[row])];
            let f = drive_loads(&motion, machine)[0];
            run.equals("oil.drive", row, -f);
            let now = machine(&motion);
            let phi = angle(motion[0]).x;
            let (d, e) = (leg * phi.cos(), leg * phi.sin());
            // About the upper pins of the legs only the upper rollers turn the table.
            let (needed, turning) = now.needs(&[3, 4], [0.0, 0.0, e]);
            let rollers = -turning[1] / d;
            run.equals("upper rollers", row, rollers);
            run.equals("tops.Fx", row, needed[0]);
            run.equals("tops.Fz", row, needed[2] - rollers);
            // About the feet of the frame the cylinder and the lower rollers turn the machine.
            let (needed, turning) = now.needs(&[0, 1, 2, 3, 4], [0.0; 3]);
            let way = [0.7 * d - foot[0], 0.0, 0.7 * e - foot[1]];
            let push = times(f / dot(way, way).sqrt(), way);
            let by_oil = cross([foot[0], 0.0, foot[1]], push);
            let lower = -(turning[1] - by_oil[1]) / d;
            run.equals("feet.Fx", row, -(needed[0] - push[0]));
            run.equals("feet.Fz", row, -(needed[2] - push[2] - lower));
            // The lashing carries the pallet alone; its reference point is below the centre.
            let (needed, _) = now.needs(&[4], [0.0; 3]);
            run.force("lashing", row, times(-1.0, needed), ALL);
            run.force("lashing", row, [0.0; 3], MOMENTS);
        }
        run.redundancy(15);
        run.not_unique(&[
            "feet",
            "tops",
            "foot L",
            "foot R",
            "middle L",
            "middle R",
            "top L",
            "top R",
            "lower roller L",
            "lower roller R",
            "upper roller L",
            "upper roller R",
        ]);
    }
}

/// All parts move along x together, the trolley along y, too. Ten loads act in the balls and by the
/// motors: four vertical forces, four across the rails, two of the motors. Six equations of the
/// bridge with its trolley leave four of them open. Determined are the sums: of the motors by the
/// force along x, of the vertical forces of each side and of the front by moments about lines
/// through balls.
#[test]
fn gantry() {
    for (case, payload) in [(None, 2000.0), (Some("no load"), 0.0)] {
        let run = Run::of("gantry", case);
        let trolley = 350.0 + payload;
        for row in rows(&run) {
            let t = run.times[row];
            let x = steps(&[(0.0, 4.0, 6.0)], t);
            let y = steps(&[(1.0, 5.0, 3.5)], t);
            let carriages = [[0.9, 3.0], [0.9, -3.0], [-0.9, 3.0], [-0.9, -3.0]];
            let carriages =
                carriages.map(|[a, b]| Moving::sliding(80.0, advanced([a, b, 0.15], x)));
            let mut bodies = vec![
                Moving::sliding(2600.0, advanced([0.0, 0.0, 2.6], x)),
                Moving::sliding(trolley, [x + 0.1, y + -2.0, 2.5.into()]),
            ];
            bodies.extend(carriages);
            let machine = Machine {
                gravity: DOWN,
                bodies,
                pushes: vec![Push {
                    body: 0,
                    at: advanced([0.0, 0.0, 3.0], x),
                    force: [-1500.0, 0.0, 0.0],
                }],
                springs: vec![],
            };
            let (all, _) = machine.needs(&[0, 1, 2, 3, 4, 5], [0.0; 3]);
            run.equals("both motors", row, -all[0]);
            // Lines through the balls of the right side, the left side and the rear.
            let about = |y: f64| machine.needs(&[0, 1], [x.x - 0.9, y, 0.3]).1;
            let (right, left) = (about(-3.0), about(3.0));
            let two_carriages = 2.0 * 80.0 * G;
            run.equals("left rail", row, -(right[0] / 6.0 + two_carriages));
            run.equals("right rail", row, -(-left[0] / 6.0 + two_carriages));
            run.equals("front wheels", row, -(-right[1] / 1.8 + two_carriages));
            // The trolley hangs at one joint; its drive acts along the line of the bridge.
            let rail = [x.x, -2.0, 2.6];
            let (force, torque) = machine.needs(&[1], rail);
            run.equals("winch car.drive", row, -force[1]);
            run.force(
                "bridge rail",
                row,
                times(-1.0, [force[0], 0.0, force[2]]),
                ALL,
            );
            run.force("bridge rail", row, times(-1.0, torque), MOMENTS);
        }
        run.redundancy(4);
        run.not_unique(&[
            "rail FL", "rail FR", "rail RL", "rail RR", "ball FL", "ball FR", "ball RL", "ball RR",
            "motor L", "motor R",
        ]);
    }
}

/// Places of the mounts.
const MOUNTS: [Vector; 4] = [
    [0.9, 0.4, 0.0],
    [0.9, -0.4, 0.0],
    [-0.9, 0.4, 0.0],
    [-0.9, -0.4, 0.0],
];

/// Stiffness (N/m) and damping (N·s/m) of a mount along x, y, z.
const STIFFNESS: Vector = [0.8e6, 0.8e6, 2e6];
const DAMPING: Vector = [4e3, 4e3, 8e3];

/// Along the run each mount carries what its law states for the position and the velocity of its
/// point of the bed.
#[test]
fn bed() {
    let run = Run::of("bed", None);
    for row in rows(&run) {
        let of = |columns| run.vector("bed", columns, row);
        let (place, v, w) = (
            of(["x", "y", "z"]),
            of(["vx", "vy", "vz"]),
            of(["wx", "wy", "wz"]),
        );
        let axis = of(["qx", "qy", "qz"]);
        let scalar = run.value("bed.qw", row);
        let turned = |p: Vector| {
            let aside = times(2.0, cross(axis, p));
            sum(p, sum(times(scalar, aside), cross(axis, aside)))
        };
        for (k, mount) in MOUNTS.iter().enumerate() {
            let arm = turned(*mount);
            let moved = difference(sum(place, arm), *mount);
            let rate = sum(v, cross(w, arm));
            // On the ground, the first body: the force of the bed through the point of the bed.
            let load = [0, 1, 2].map(|i| STIFFNESS[i] * moved[i] + DAMPING[i] * rate[i]);
            let name = format!("mount {}", k + 1);
            run.force(&name, row, load, ALL);
            run.force(&name, row, cross(moved, load), MOMENTS);
        }
        let phase = 50.0 * std::f64::consts::PI * run.times[row];
        run.force(
            "unbalance",
            row,
            [0.0, 600.0 * phase.sin(), 600.0 * phase.cos()],
            ALL,
        );
    }
    assert_eq!(run.study.prepared.mechanism.layout().rows(), 0);
}

/// With its centre in the middle the bed falls straight down: z'' = −g − (4·c·z' + 4·k·z)/m, a
/// damped vibration about −m·g/(4·k).
#[test]
fn a_centred_bed_vibrates_vertically() {
    let text = scene("bed", Some("stopped"));
    let settings = ["off = 0", "simulate.rtol = 1e-13", "simulate.atol = 1e-15"];
    let settings = settings.map(|x| x.parse::<Setting>().expect("a setting"));
    let text = Setting::replaced(&text, &settings).expect("keys of the scene");
    let run = Run::of_text("bed", &text, "centred");
    let (mass, k, c) = (1600.0, 4.0 * STIFFNESS[2], 4.0 * DAMPING[2]);
    let (decay, sag) = (c / (2.0 * mass), mass * G / k);
    let frequency = (k / mass - decay * decay).sqrt();
    for row in rows(&run) {
        let t = run.times[row];
        let (sin, cos) = (frequency * t).sin_cos();
        let envelope = sag * (-decay * t).exp();
        let z = envelope * (cos + decay / frequency * sin) - sag;
        let rate = -envelope * (frequency + decay * decay / frequency) * sin;
        for mount in 1..=4 {
            let load = 0.25 * (k * z + c * rate);
            run.force(&format!("mount {mount}"), row, [0.0, 0.0, load], ALL);
        }
    }
}

/// At rest the bed with its centre ahead of the middle sinks and tilts in the plane of symmetry.
/// Forces and moment of the springs and the weight vanish at x, z and the tilt, which Newton's
/// method finds here.
#[test]
fn a_bed_at_rest_tilts() {
    let run = Run::of("bed", Some("stopped"));
    let (_, there) = run
        .study
        .equilibrium(&EquilibriumOptions::default())
        .expect("an equilibrium");
    let state = |[x, z, tilt]: [f64; 3]| {
        let (sin, cos) = tilt.sin_cos();
        let turned = |[a, _, b]: Vector| [cos * a + sin * b, 0.0, -sin * a + cos * b];
        let moved = |mount: Vector| {
            let arm = turned(mount);
            (arm, [x + arm[0] - mount[0], 0.0, z + arm[2] - mount[2]])
        };
        let mut rest = [0.0; 3];
        for mount in MOUNTS {
            let (arm, moved) = moved(mount);
            let load = [-STIFFNESS[0] * moved[0], 0.0, -STIFFNESS[2] * moved[2]];
            let moment = cross([arm[0], 0.0, arm[2]], load)[1];
            rest = [rest[0] + load[0], rest[1] + load[2], rest[2] + moment];
        }
        let weight = [0.0, 0.0, -1600.0 * G];
        rest[1] += weight[2];
        rest[2] += cross(turned([0.12, 0.0, 0.45]), weight)[1];
        (rest, MOUNTS.map(|mount| moved(mount).1))
    };
    let mut found = [0.0; 3];
    for _ in 0..20 {
        let (rest, _) = state(found);
        let step = 1e-7;
        let mut slopes = [[0.0; 3]; 3];
        for k in 0..3 {
            let mut near = found;
            near[k] += step;
            let (there, _) = state(near);
            for i in 0..3 {
                slopes[i][k] = (there[i] - rest[i]) / step;
            }
        }
        let change = solved(slopes, rest);
        for k in 0..3 {
            found[k] -= change[k];
        }
    }
    let (rest, moved) = state(found);
    assert!(rest.iter().all(|x| x.abs() < 1e-8), "{rest:?}");
    let prepared = &there.prepared;
    let mut loads = prepared.mechanism.loads();
    let loads = loads.at(0.0, &prepared.q, &prepared.v);
    for (load, moved) in loads.iter().zip(moved) {
        for k in 0..3 {
            let expected = STIFFNESS[k] * moved[k];
            let error = (load.wrench.force[k] - expected).abs();
            assert!(error < SHARE * 1600.0 * G, "{load:?}: {expected}");
        }
    }
}

/// A vector, turned about a unit axis (formula of Rodrigues).
fn about(axis: Vector, angle: Jet, v: Vector) -> [Jet; 3] {
    let (sin, cos) = (angle.sin(), angle.cos());
    let (aside, along) = (cross(axis, v), times(dot(axis, v), axis));
    [0, 1, 2].map(|k| cos * (v[k] - along[k]) + sin * aside[k] + along[k])
}

fn unit(v: Vector) -> Vector {
    times(1.0 / dot(v, v).sqrt(), v)
}

/// The point at given distances from three centres, on the side of a nearby point.
fn of_three(centres: [Vector; 3], distances: [f64; 3], near: Vector) -> Vector {
    let [p, q, r] = centres;
    let ex = unit(difference(q, p));
    let (d, to_r) = (dot(difference(q, p), ex), difference(r, p));
    let i = dot(ex, to_r);
    let ey = unit(difference(to_r, times(i, ex)));
    let j = dot(ey, to_r);
    let squares = distances.map(|x| x * x);
    let x = (squares[0] - squares[1] + d * d) / (2.0 * d);
    let y = (squares[0] - squares[2] + i * i + j * j - 2.0 * i * x) / (2.0 * j);
    let z = (squares[0] - x * x - y * y).sqrt();
    let ez = cross(ex, ey);
    let z = z.copysign(dot(ez, difference(near, p)));
    sum(p, sum(times(x, ex), sum(times(y, ey), times(z, ez))))
}

/// Three axes at right angles from three points.
fn axes([p, q, r]: [Vector; 3]) -> [Vector; 3] {
    let x = unit(difference(q, p));
    let z = unit(cross(x, difference(r, p)));
    [x, cross(z, x), z]
}

/// At the start, at rest: forces of both balls and of the tie rod are seven unknowns. Six equations
/// of the wheel with its knuckle, and the moment about the axis of the upper arm, determine them.
/// The lower arm and the rack follow. Along the run the spring has the length of its ends, and the
/// wheel follows from distances alone: the lower ball turns with its arm, the upper ball is at its
/// distance from it on its circle, and the end of the tie rod at its distances from three points.
#[test]
fn wishbone() {
    for (case, brake, side) in [
        (None, 0.0, 0.0),
        (Some("braking"), -4e3, 0.0),
        (Some("cornering"), 0.0, -3.5e3),
    ] {
        let run = Run::of("wishbone", case);
        let (lower_pin, upper_pin) = ([0.0, 0.35, 0.25], [0.0, 0.45, 0.56]);
        let (lower_axis, upper_axis) = (unit([1.0, 0.0, 0.05]), unit([1.0, 0.0, -0.08]));
        let (lower, upper) = ([0.01, 0.72, 0.22], [-0.015, 0.68, 0.54]);
        let (inner, outer) = ([0.12, 0.365, 0.316], [0.13, 0.7, 0.29]);
        let (tower, seat) = ([0.0, 0.48, 0.72], [0.0, 0.58, 0.24]);
        let weight = |mass: f64| [0.0, 0.0, -G * mass];
        let road = [brake, side, 4500.0];

        let rod = unit(difference(outer, inner));
        let strut = difference(tower, seat);
        let tension = 90e3 * (dot(strut, strut).sqrt() - 0.56);
        let spring = times(tension, unit(strut));
        let wheel = [0.0, 0.75, 0.32];
        let mut a = [[0.0; 7]; 7];
        let mut b = [0.0; 7];
        let known = sum(road, weight(45.0));
        let turning = cross(difference([0.0, 0.765, 0.0], wheel), road);
        for k in 0..3 {
            let mut one = [0.0; 3];
            one[k] = 1.0;
            a[k][k] = 1.0;
            a[k][3 + k] = 1.0;
            // The tie rod pulls the knuckle towards the rack.
            a[k][6] = -rod[k];
            b[k] = -known[k];
            let by_lower = cross(difference(lower, wheel), one);
            let by_upper = cross(difference(upper, wheel), one);
            for i in 0..3 {
                a[3 + i][k] = by_lower[i];
                a[3 + i][3 + k] = by_upper[i];
            }
            a[6][3 + k] = -dot(upper_axis, cross(difference(upper, upper_pin), one));
            b[3 + k] = -turning[k];
        }
        let by_rod = cross(difference(outer, wheel), rod);
        for i in 0..3 {
            a[3 + i][6] = -by_rod[i];
        }
        let hang = cross(difference([-0.005, 0.58, 0.55], upper_pin), weight(5.0));
        b[6] = -dot(upper_axis, hang);
        let found = solved(a, b);
        let (by_lower, by_upper) = (
            [found[0], found[1], found[2]],
            [found[3], found[4], found[5]],
        );
        let pull = times(found[6], rod);
        run.force("lower ball", 0, times(-1.0, by_lower), ALL);
        run.force("upper ball", 0, times(-1.0, by_upper), ALL);
        run.force("tie rod", 0, pull, ALL);
        run.equals("steering.drive", 0, pull[1]);
        run.force("housing", 0, [pull[0], 0.0, pull[2] - G * 4.0], ALL);
        let on_lower = difference(by_lower, sum(weight(8.0), spring));
        run.force("lower axis", 0, times(-1.0, on_lower), ALL);
        run.force(
            "upper axis",
            0,
            times(-1.0, difference(by_upper, weight(5.0))),
            ALL,
        );
        let moment = |at: Vector, force: Vector| cross(difference(at, lower_pin), force);
        let turning = sum(
            moment(lower, times(-1.0, by_lower)),
            sum(moment([0.0, 0.56, 0.23], weight(8.0)), moment(seat, spring)),
        );
        run.equals("bump.drive", 0, dot(lower_axis, turning));

        let apart = |a: Vector, b: Vector| dot(difference(a, b), difference(a, b)).sqrt();
        let drawn = axes([lower, upper, outer]);
        let mut swing = 0.0;
        for row in 0..run.times.len() {
            let t = run.times[row];
            let degrees = steps(&[(0.0, 1.0, 10.0), (1.0, 3.0, -20.0)], t);
            let arm = degrees * 1.0_f64.to_radians();
            let of_arm = |p: Vector| {
                let turned = about(lower_axis, arm, difference(p, lower_pin));
                [0, 1, 2].map(|k| turned[k] + lower_pin[k])
            };
            let end = of_arm(seat);
            let square = |k: usize| (end[k] + -tower[k]) * (end[k] + -tower[k]);
            let long = (square(0) + square(1) + square(2)).sqrt();
            let tension = 90e3 * (long.x - 0.56) + 2e3 * long.d;
            let way = times(1.0 / long.x, difference(values(end), tower));
            run.force("spring", row, times(tension, way), ALL);

            let ball = values(of_arm(lower));
            let joined = apart(lower, upper);
            let of_upper = |angle: f64| {
                let turned = about(upper_axis, angle.into(), difference(upper, upper_pin));
                sum(values(turned), upper_pin)
            };
            // Newton's method from the previous row; the difference quotient needs no accuracy.
            for _ in 0..20 {
                let miss = |angle: f64| apart(of_upper(angle), ball) - joined;
                let slope = (miss(swing + 1e-6) - miss(swing)) / 1e-6;
                swing -= miss(swing) / slope;
            }
            let top = of_upper(swing);
            let rack = sum(inner, [0.0, steps(&[(3.0, 4.0, 0.04)], t).x, 0.0]);
            let distances = [
                apart(outer, lower),
                apart(outer, upper),
                apart(outer, inner),
            ];
            // Seen from the arms, the tie rod is ahead.
            let near = sum(ball, difference(outer, lower));
            let end = of_three([ball, top, rack], distances, near);
            let now = axes([ball, top, end]);
            let axle = (0..3).fold([0.0; 3], |v, k| sum(v, times(drawn[k][1], now[k])));
            let camber = axle[2].asin().to_degrees();
            let toe = (-axle[0]).atan2(axle[1]).to_degrees();
            for (measure, expected) in [("camber", camber), ("toe", toe)] {
                let found = run.value(measure, row);
                assert!(
                    (found - expected).abs() < SHARE * 20.0,
                    "{measure} at {t} s: {found}, {expected}"
                );
            }
        }
        run.redundancy(0);
        run.not_unique(&[]);
    }
}
