//! Machines in the plane.

use super::jet::{Jet, Point, corner, length, meeting, minus, plus, point, slope, steps, turned};
use super::tables::Run;
use super::works::{
    Machine, Moving, Push, Vector, cross, difference, dot, drive_loads, sum, times,
};

/// The machines with a test here.
pub(super) const MACHINES: &[&str] = &[
    "excavator",
    "gearbox",
    "hatch",
    "loader",
    "pusher",
    "tipper",
    "tractor",
];

/// m/s², as 9810 mm/s² in the scenes.
const G: f64 = 9.81;

const DOWN: Vector = [0.0, -G, 0.0];

const X_Y: &[&str] = &["Fx", "Fy"];

fn flat(p: Point) -> [Jet; 3] {
    [p[0], p[1], 0.0.into()]
}

fn at(p: Point) -> Vector {
    [p[0].x, p[1].x, 0.0]
}

/// The unit vector from one point to another.
fn direction(from: Point, to: Point) -> Vector {
    let d = difference(at(to), at(from));
    times(1.0 / dot(d, d).sqrt(), d)
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A point of a body that turns about a pivot: the pivot and the point as drawn, the pivot now.
fn carried(drawn: [f64; 2], pivot: [f64; 2], now: Point, angle: Jet) -> Point {
    plus(now, turned(minus(point(drawn), point(pivot)), angle))
}

/// The rotation of an arm about a fixed pivot by a cylinder, from the drawn position: the angle of
/// the triangle between foot, pivot and eye changes with the side opposite to it.
fn swing(pivot: [f64; 2], foot: [f64; 2], eye: [f64; 2], stroke: Jet) -> Jet {
    let (a, b, c) = (apart(pivot, foot), apart(pivot, eye), apart(foot, eye));
    corner(a, b, stroke + c) - corner(a, b, c.into())
}

/// Rows of the tables that are compared.
fn rows(run: &Run) -> Vec<usize> {
    (0..run.times.len()).step_by(8).collect()
}

/// Boom and stick swing by triangles of their cylinders: the boom to the left as its cylinder
/// grows, the stick to the right of the boom. Forces of the cylinders follow from virtual work of
/// their strokes, those of the pins from the equilibrium of the bodies beyond them.
#[test]
fn excavator() {
    for (case, payload, dig) in [
        (None, 1200.0, 0.0),
        (Some("empty"), 0.0, 0.0),
        (Some("dig"), 1200.0, 40e3),
    ] {
        let run = Run::of("excavator", case);
        let (foot, pin) = ([0.0, 1.8], [5.2, 3.6]);
        let boom_ends = ([0.7, 1.2], [2.3, 3.4]);
        let stick_ends = ([2.6, 4.3], [4.75, 4.25]);
        let pose = |s: &[Jet]| {
            let boom = swing(foot, boom_ends.0, boom_ends.1, s[0]);
            let stick = boom - swing(pin, stick_ends.0, stick_ends.1, s[1]);
            let pin_now = carried(pin, foot, point(foot), boom);
            (boom, stick, pin_now)
        };
        let machine = |s: &[Jet]| {
            let (boom, stick, pin_now) = pose(s);
            let of_stick = |p| carried(p, pin, pin_now, stick);
            Machine {
                gravity: DOWN,
                bodies: vec![
                    Moving::plane(
                        1600.0,
                        4000.0,
                        carried([2.6, 3.3], foot, point(foot), boom),
                        boom,
                    ),
                    Moving::plane(800.0, 900.0, of_stick([5.8, 2.7]), stick),
                    Moving::plane(payload, payload * 0.16, of_stick([6.8, 0.9]), stick),
                ],
                pushes: vec![Push {
                    body: 2,
                    at: flat(of_stick([6.8, 0.6])),
                    force: [dig, dig / 3.0, 0.0],
                }],
                springs: vec![],
            }
        };
        for row in rows(&run) {
            let t = run.times[row];
            let motion = [steps(&[(0.5, 4.5, 0.3)], t), steps(&[(1.0, 4.0, 0.25)], t)];
            let f = drive_loads(&motion, machine);
            run.equals("boom oil.drive", row, -f[0]);
            run.equals("stick oil.drive", row, -f[1]);
            let (boom, stick, pin_now) = pose(&motion);
            let now = machine(&motion);
            let eye = carried(boom_ends.1, foot, point(foot), boom);
            let boom_way = direction(point(boom_ends.0), eye);
            let stick_way = direction(
                carried(stick_ends.0, foot, point(foot), boom),
                carried(stick_ends.1, pin, pin_now, stick),
            );
            // Joints act on their second body with what it needs, on the first one oppositely.
            let (on_stick, _) = now.needs(&[1, 2], [0.0; 3]);
            let on_stick = difference(on_stick, times(f[1], stick_way));
            run.force("stick pin", row, times(-1.0, on_stick), X_Y);
            let (all, turning) = now.needs(&[0, 1, 2], [foot[0], foot[1], 0.0]);
            let on_boom = difference(all, times(f[0], boom_way));
            run.force("boom foot", row, times(-1.0, on_boom), X_Y);
            run.force("on the frame", row, times(-1.0, all), X_Y);
            run.equals("on the frame.T", row, -turning[2]);
            let bucket = at(carried([6.8, 1.2], pin, pin_now, stick));
            let (force, torque) = now.needs(&[2], bucket);
            run.force("bucket", row, times(-1.0, force), X_Y);
            run.equals("bucket.T", row, -torque[2]);
        }
        run.redundancy(0);
        run.not_unique(&[]);
        run.peak("boom oil", "drive");
    }
}

/// One rotation. The gas springs push along the line of their ends with a force that follows from
/// their length alone.
#[test]
fn hatch() {
    for (case, force) in [(None, 450.0), (Some("cold"), 390.0), (Some("hot"), 520.0)] {
        let run = Run::of("hatch", case);
        let (frame, eye) = ([0.1, -0.12], [0.5, -0.03]);
        for row in rows(&run) {
            let motion = [steps(&[(0.0, 3.0, 75.0_f64.to_radians())], run.times[row])];
            let ends = |s: &[Jet]| (point(frame), turned(point(eye), s[0]));
            let (fixed, moving) = ends(&motion);
            let long = length(fixed, moving);
            let push = 2.0 * force * (1.0 + 0.3 * (0.6 - long.x) / 0.19);
            let machine = |s: &[Jet]| {
                let (fixed, moving) = ends(s);
                let lid = Moving::plane(45.0, 3.2, turned(point([0.4, -0.02]), s[0]), s[0]);
                Machine {
                    gravity: DOWN,
                    bodies: vec![lid],
                    pushes: vec![],
                    springs: vec![(length(fixed, moving), -push)],
                }
            };
            let f = drive_loads(&motion, machine);
            run.equals("hand.drive", row, -f[0]);
            let way = direction(fixed, moving);
            run.force("gas", row, times(-push, way), X_Y);
            run.equals("gas.length", row, long.x);
            run.equals("gas.rate", row, long.d);
            let (needed, _) = machine(&motion).needs(&[0], [0.0; 3]);
            let hinge = difference(needed, times(push, way));
            run.force("hinge", row, times(-1.0, hinge), X_Y);
        }
        run.not_unique(&[]);
    }
}

/// The lift cylinder swings the arm. The rocker is where its upper pin has its distances from its
/// pivot and from the foot of the tilt cylinder, the bucket where its upper pin has its distances
/// from its lower pin and from the lower pin of the rocker.
#[test]
fn loader() {
    for (case, payload, push) in [
        (None, 1800.0, 0.0),
        (Some("empty"), 0.0, 0.0),
        (Some("digging"), 0.0, 50e3),
    ] {
        let run = Run::of("loader", case);
        let (arm_pin, rocker_pin, bucket_pin) = ([0.0, 1.9], [1.3, 1.45], [2.3, 0.35]);
        let (lift, tilt) = (([0.3, 1.0], [1.25, 1.15]), ([0.15, 1.75], [1.15, 2.0]));
        let (low, ear) = ([1.45, 0.85], [2.15, 0.7]);
        // Drives in the order of the motion: lift, tilt.
        let pose = |s: &[Jet]| {
            let arm = swing(arm_pin, lift.0, lift.1, s[0]);
            let on_arm = |p| carried(p, arm_pin, point(arm_pin), arm);
            let (pivot, lower) = (on_arm(rocker_pin), on_arm(bucket_pin));
            let radius = apart(rocker_pin, tilt.1).into();
            let reach = s[1] + apart(tilt.0, tilt.1);
            // Both upper pins are to the left of the lines between their centres.
            let upper = meeting(point(tilt.0), reach, pivot, radius, 1.0);
            let drawn = |a: [f64; 2], b: [f64; 2]| slope(minus(point(b), point(a)));
            let rocker = slope(minus(upper, pivot)) - drawn(rocker_pin, tilt.1);
            let end = carried(low, rocker_pin, pivot, rocker);
            let [near, far] = [apart(bucket_pin, ear), apart(low, ear)].map(Jet::from);
            let top = meeting(end, far, lower, near, 1.0);
            let bucket = slope(minus(top, lower)) - drawn(bucket_pin, ear);
            (arm, rocker, bucket, [pivot, lower, upper, end, top])
        };
        let machine = |s: &[Jet]| {
            let (arm, rocker, bucket, [pivot, lower, ..]) = pose(s);
            let mass = 700.0 + payload;
            let centre = carried([1.15, 1.25], arm_pin, point(arm_pin), arm);
            let filled = carried([2.75, 0.45], bucket_pin, lower, bucket);
            Machine {
                gravity: DOWN,
                bodies: vec![
                    Moving::plane(900.0, 650.0, centre, arm),
                    Moving::plane(120.0, 12.0, pivot, rocker),
                    Moving::plane(mass, mass * 0.45 * 0.45, filled, bucket),
                ],
                pushes: vec![Push {
                    body: 2,
                    at: flat(carried([3.3, 0.15], bucket_pin, lower, bucket)),
                    force: [-push, -push / 2.0, 0.0],
                }],
                springs: vec![],
            }
        };
        for row in rows(&run) {
            let t = run.times[row];
            let motion = [steps(&[(1.0, 5.0, 0.45)], t), steps(&[(0.5, 1.5, 0.12)], t)];
            let f = drive_loads(&motion, machine);
            run.equals("lift oil.drive", row, -f[0]);
            run.equals("tilt oil.drive", row, -f[1]);
            let (arm, _, _, [_, lower, upper, end, top]) = pose(&motion);
            let now = machine(&motion);
            // The link pulls the bucket towards the rocker; only it turns the bucket about its pin.
            let way = direction(end, top);
            let (needed, turning) = now.needs(&[2], at(lower));
            let lever = cross(difference(at(top), at(lower)), way)[2];
            let pull = times(-turning[2] / lever, way);
            run.force("link", row, pull, X_Y);
            run.force("bucket pin", row, times(-1.0, sum(needed, pull)), X_Y);
            let tilt_force = times(f[1], direction(point(tilt.0), upper));
            let (needed, _) = now.needs(&[1], [0.0; 3]);
            let on_rocker = difference(difference(needed, pull), tilt_force);
            run.force("rocker pin", row, times(-1.0, on_rocker), X_Y);
            let eye = carried(lift.1, arm_pin, point(arm_pin), arm);
            let lift_force = times(f[0], direction(point(lift.0), eye));
            let (needed, _) = now.needs(&[0, 1, 2], [0.0; 3]);
            let on_arm = difference(difference(needed, lift_force), tilt_force);
            run.force("arm pin", row, times(-1.0, on_arm), X_Y);
        }
        run.not_unique(&[]);
    }
}

/// The pin of the crank gives the direction of the lever, the lever its upper end, and the link the
/// slide. The motor turns steadily, so all work belongs to inertia, weight and cartons.
#[test]
fn pusher() {
    for (case, cartons) in [(None, 120.0), (Some("no cartons"), 0.0)] {
        let run = Run::of("pusher", case);
        let (c, r, l, link) = (0.35_f64, 0.12_f64, 0.7, 0.26);
        let swing = (r / c).asin();
        let pose = |s: &[Jet]| {
            let crank = s[0] + (std::f64::consts::PI + swing);
            let pin = plus(point([0.0, c]), turned(point([r, 0.0]), crank));
            let lever = slope(pin) - Jet::from(std::f64::consts::FRAC_PI_2);
            let end = turned(point([0.0, l]), lever);
            let height = end[1] * -1.0 + 0.72;
            let slide = [
                end[0] + (height * height * -1.0 + link * link).sqrt(),
                0.72.into(),
            ];
            (crank, lever, [pin, end, slide])
        };
        let start = at(pose(&[0.0.into()]).2[2]);
        for row in rows(&run) {
            let t = run.times[row];
            if (t - 0.61).abs() < 0.01 {
                continue; // The force jumps here.
            }
            let load = if t < 0.61 { -cartons } else { 0.0 };
            let machine = |s: &[Jet]| {
                let (crank, lever, [_, _, slide]) = pose(s);
                let crank_centre = plus(point([0.0, c]), turned(point([0.04, 0.0]), crank));
                let head = plus(slide, point([0.15, -0.06]));
                Machine {
                    gravity: DOWN,
                    bodies: vec![
                        Moving::plane(2.5, 0.02, crank_centre, crank),
                        Moving::plane(8.0, 0.45, turned(point([0.0, 0.33]), lever), lever),
                        Moving::plane(14.0, 0.1, slide, 0.0.into()),
                    ],
                    pushes: vec![Push {
                        body: 2,
                        at: flat(head),
                        force: [load, 0.0, 0.0],
                    }],
                    springs: vec![],
                }
            };
            let rate = -std::f64::consts::TAU;
            let motion = [Jet {
                x: rate * t,
                d: rate,
                dd: 0.0,
            }];
            let f = drive_loads(&motion, machine);
            run.equals("motor.drive", row, -f[0]);
            let (_, lever, [pin, end, slide]) = pose(&motion);
            let now = machine(&motion);
            // Along the rail only the link acts on the slide; it pulls the slide to the lever.
            let way = direction(end, slide);
            let (needed, turning) = now.needs(&[2], start);
            let pull = times(-needed[0] / way[0], way);
            run.force("link", row, pull, X_Y);
            let on_slide = sum(needed, pull);
            run.force("rail", row, times(-1.0, on_slide), X_Y);
            let by_link = cross(difference(at(slide), start), pull);
            run.equals("rail.T", row, -(turning[2] + by_link[2]));
            // Across the lever the pin of the crank acts at the distance of the pin.
            let (needed, turning) = now.needs(&[1], [0.0; 3]);
            let across = [-lever.x.cos(), -lever.x.sin(), 0.0];
            let distance = dot(at(pin), at(pin)).sqrt();
            let by_link = cross(at(end), pull);
            let pressure = times((turning[2] - by_link[2]) / distance, across);
            run.force("slot", row, pressure, X_Y);
            let on_lever = difference(difference(needed, pull), pressure);
            run.force("lever foot", row, times(-1.0, on_lever), X_Y);
            let (needed, _) = now.needs(&[0], [0.0; 3]);
            run.force("motor shaft", row, times(-1.0, sum(needed, pressure)), X_Y);
        }
        run.not_unique(&[]);
    }
}

/// The cylinder swings the bowl about its hinge. Gravity is inclined on a slope. The front wheels
/// carry what turns the whole cart about the rear wheels.
#[test]
fn tipper() {
    for (case, payload, slope) in [
        (None, 3000.0, 0.0),
        (Some("uphill"), 3000.0, 8.0_f64),
        (Some("empty"), 0.0, 0.0),
    ] {
        let run = Run::of("tipper", case);
        let (hinge, foot, eye) = ([-0.4, 0.9], [1.5, 0.7], [1.8, 1.0]);
        let (sin, cos) = slope.to_radians().sin_cos();
        let machine = |s: &[Jet]| {
            let tilt = swing(hinge, foot, eye, s[0]);
            let mass = 700.0 + payload;
            let bowl = carried([1.0, 1.4], hinge, point(hinge), tilt);
            Machine {
                gravity: [-G * sin, -G * cos, 0.0],
                bodies: vec![
                    Moving::plane(1800.0, 2400.0, point([1.7, 0.7]), 0.0.into()),
                    Moving::plane(mass, mass * 0.36, bowl, tilt),
                ],
                pushes: vec![],
                springs: vec![],
            }
        };
        let mut least = f64::INFINITY;
        for row in rows(&run) {
            let motion = [steps(&[(0.5, 8.5, 1.4)], run.times[row])];
            let f = drive_loads(&motion, machine);
            run.equals("oil.drive", row, -f[0]);
            let now = machine(&motion);
            let (needed, turning) = now.needs(&[0, 1], [0.0; 3]);
            let front = turning[2] / 3.0;
            run.equals("front wheels.Fy", row, front);
            least = least.min(front);
            let rear = difference(needed, [0.0, front, 0.0]);
            run.force("rear wheels", row, times(-1.0, rear), X_Y);
            let tilt = swing(hinge, foot, eye, motion[0]);
            let way = direction(point(foot), carried(eye, hinge, point(hinge), tilt));
            let (needed, _) = now.needs(&[1], [0.0; 3]);
            let on_bowl = difference(needed, times(f[0], way));
            run.force("hinge", row, times(-1.0, on_bowl), X_Y);
        }
        assert!(least > 0.0, "the front wheels stay down: {least}");
        run.not_unique(&[]);
    }
}

/// Ratio of Willis: with a fixed ring of 60 teeth and a sun of 20, the carrier turns at a quarter
/// of the sun, and a planet of 20 teeth at minus one half. The work of the motor accelerates these
/// rotations and drives the load at a quarter. Each of four planets carries what the others do not:
/// of the 20 rows, 17 are independent.
#[test]
fn gearbox() {
    for (case, load) in [(None, 200.0), (Some("idle"), 0.0)] {
        let run = Run::of("gearbox", case);
        let (sun, carrier, planet, mass, a) = (1e-3, 15e-3, 0.8e-3, 1.8, 0.06_f64);
        let start = 100.0;
        let orbit = carrier + 4.0 * mass * a * a;
        let motor = start * (sun + orbit / 16.0 + 4.0 * planet / 4.0) + load / 4.0;
        let growth = start * (sun + orbit / 4.0 - 4.0 * planet / 2.0);
        let weight = (2.2 + 6.0 + 4.0 * mass) * G;
        for row in rows(&run) {
            run.equals("motor.drive", row, -motor);
            // The teeth hold the sun back: they take what does not accelerate it.
            run.equals("all teeth of the sun", row, start * sun - motor);
            // The accelerations of the planets cancel; their weights hang symmetrically.
            run.equals("on the housing.Fx", row, 0.0);
            run.equals("on the housing.Fy", row, -weight);
            run.equals("on the housing.T", row, motor - load - growth);
        }
        run.redundancy(3);
        run.not_unique(&[
            "input", "output", "pin 1", "pin 2", "pin 3", "pin 4", "sun 1", "sun 2", "sun 3",
            "sun 4", "ring 1", "ring 2", "ring 3", "ring 4",
        ]);
    }
}

/// In the steady curve both bodies turn about the point O on the line of the rear axle, where the
/// line of the front axle meets it. All accelerations point to O. Along the trailer, at the middle
/// of the tandem, the velocity is that of a rotation about O; across it, its two axles move to
/// opposite sides by rotation alone.
#[test]
fn tractor() {
    let run = Run::of("tractor", None);
    let (base, hitch, draw, gap) = (2.6, 0.9, 4.8, 1.3);
    let steer = 15.0_f64.to_radians();
    let k = steer.tan() / base;
    let bend = (hitch * k).atan() + (draw * k / (1.0 + hitch * hitch * k * k).sqrt()).asin();
    let (speed, middle) = (12.0 / 3.6, [0.0, 1.0 / k, 0.0]);
    let rate = speed * k;
    let to_middle = |p: Vector| times(rate * rate, difference(middle, p));
    let along = [bend.cos(), -bend.sin(), 0.0];
    let across = [bend.sin(), bend.cos(), 0.0];
    let hook = [-hitch, 0.0, 0.0];
    let tandem = difference(hook, times(draw, along));
    // The trailer: moments about the hitch, then forces.
    let inertia = times(14e3, to_middle(sum(tandem, times(0.3, along))));
    let forward = dot(cross([0.0, 0.0, rate], difference(tandem, middle)), along);
    let aside = rate * gap / 2.0;
    let scrub = 400e3 * aside / forward.hypot(0.1);
    let lever = times(-(draw - 0.3), along);
    let side = (-scrub * gap - cross(lever, inertia)[2]) / draw;
    let resistance = times(-5e3, along);
    let on_trailer = difference(difference(inertia, times(side, across)), resistance);
    // The tractor: moments about the rear axle, then forces.
    let inertia = times(5200.0, to_middle([1.0, 0.0, 0.0]));
    let front = (inertia[1] - hitch * on_trailer[1]) / (base * steer.cos());
    let steered = times(front, [-steer.sin(), steer.cos(), 0.0]);
    let rest = difference(sum(inertia, on_trailer), steered);
    for row in rows(&run) {
        let (sin, cos) = (rate * run.times[row]).sin_cos();
        let now = |v: Vector| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], 0.0];
        run.equals("tandem.N", row, side);
        run.equals("front.N", row, front);
        run.equals("rear.N", row, rest[1]);
        run.force("engine", row, now([rest[0], 0.0, 0.0]), X_Y);
        run.force("hitch", row, now(times(-1.0, on_trailer)), X_Y);
        run.force("scrub 1", row, now(times(-scrub, across)), X_Y);
        run.force("scrub 2", row, now(times(scrub, across)), X_Y);
        run.force("rolling resistance", row, now(resistance), X_Y);
    }
    run.redundancy(0);
    run.not_unique(&[]);

    // Straight ahead the engine carries the resistance. Side forces and moments of two bodies are
    // four equations for five forces: two axles of the tractor, two of the trailer, the hitch.
    let run = Run::of("tractor", Some("straight"));
    for row in rows(&run) {
        run.equals("engine.Fx", row, 5e3);
        run.equals("hitch.Fx", row, -5e3);
    }
    run.redundancy(1);
    run.not_unique(&["hitch", "rear", "front", "tandem 1", "tandem 2"]);
}
