//! Mechanisms whose free motions are derived manually: a point p of a body at r has the velocity
//! `v + ω × (p − r)`.

use crate::limits::MOTIONS_REPORTED;
mod space;

use joints::{
    Direction, Fixed, Gear, KnifeEdge, Revolute, RevoluteAngleDrive, Translational,
    TranslationalDisplacementDrive,
};
use model::start::assemble;
use model::{Body, BodyRef, Description, Function, Mechanism, StartOptions};

use super::{FreeMotions, Freedoms};
use crate::analyse;

const GROUND: BodyRef = BodyRef::Ground;

/// Permitted difference between computed and derived numbers. It is a rounding error.
const ROUNDING: f64 = 1e-12;

/// A bar with its centre of mass at `position`.
fn at(name: &str, position: [f64; 2]) -> Body {
    Body {
        position,
        ..Body::new(name, 1.0, 1.0)
    }
}

fn pin(d: &mut Description, name: &str, bodies: [BodyRef; 2], place: [f64; 2]) {
    let [s_i, s_j] = bodies.map(|b| d.local(b, place));
    d.joint(name, &bodies, Revolute { s_i, s_j });
}

fn motor(d: &mut Description, name: &str, bodies: [BodyRef; 2], place: [f64; 2]) {
    let [s_i, s_j] = bodies.map(|b| d.local(b, place));
    let drive = RevoluteAngleDrive::new(s_i, s_j);
    d.drive(
        name,
        &bodies,
        drive,
        Function::constant_rate(2.0).expect("finite"),
    );
}

/// A guide along an axis (global direction; bodies have angle 0).
fn rail(d: &mut Description, name: &str, bodies: [BodyRef; 2], place: [f64; 2], axis: Direction) {
    let [s_i, s_j] = bodies.map(|b| d.local(b, place));
    let rail = Translational::new(s_i, s_j, axis);
    d.joint(name, &bodies, rail);
}

fn pusher(d: &mut Description, name: &str, bodies: [BodyRef; 2], place: [f64; 2], axis: Direction) {
    let [s_i, s_j] = bodies.map(|b| d.local(b, place));
    let drive = TranslationalDisplacementDrive::new(s_i, s_j, axis);
    d.drive(
        name,
        &bodies,
        drive,
        Function::constant_rate(1.0).expect("finite"),
    );
}

/// Thirty four-bars on a tower of two parts on a carriage. The rail is farther from the joints of
/// the four-bars than any other joint, but it moves alone.
#[test]
fn the_motion_of_fewest_joints_comes_first() {
    let mut d = Description::new("carriage");
    let tower = [
        ("carriage", [0.0, -2.0]),
        ("middle", [0.0, -1.0]),
        ("top", [0.0, 0.0]),
    ];
    let [carriage, middle, top] = tower.map(|(name, place)| d.body(at(name, place)));
    for k in 0..30 {
        let along = |[x, y]: [f64; 2]| [x + 4.0 * f64::from(k), y];
        let mut link = |name: &str, place| d.body(at(&format!("{name} {k}"), along(place)));
        let crank = link("crank", [0.0, 0.5]);
        let coupler = link("coupler", [1.0, 1.5]);
        let rocker = link("rocker", [2.5, 1.0]);
        for (name, bodies, place) in [
            ("A", [top, crank], [0.0, 0.0]),
            ("B", [crank, coupler], [0.0, 1.0]),
            ("C", [coupler, rocker], [2.0, 2.0]),
            ("D", [top, rocker], [3.0, 0.0]),
        ] {
            pin(&mut d, &format!("{name} {k}"), bodies, along(place));
        }
        if k == 0 {
            let axis = Direction::new([1.0, 0.0]).expect("a direction");
            rail(&mut d, "rail", [GROUND, carriage], [0.0, -2.0], axis);
        }
    }
    let welds = [
        ("lower", [carriage, middle], [0.0, -1.5]),
        ("upper", [middle, top], [0.0, -0.5]),
    ];
    for (name, bodies, place) in welds {
        let [s_i, s_j] = bodies.map(|b| d.local(b, place));
        d.joint(name, &bodies, Fixed::new(s_i, s_j));
    }
    let slides: Vec<_> = (0..93).map(|body| (body, [1.0, 0.0, 0.0])).collect();
    moves(&freedoms(&d).motions, 0, &slides);
}

fn freedoms(d: &Description) -> Freedoms {
    let mut mechanism = Mechanism::build(d).expect("builds");
    let q = assemble(&mut mechanism, &StartOptions::default())
        .expect("assembles")
        .q;
    let analysis = analyse(&mechanism, 0.0, &q).expect("a configuration");
    analysis
        .freedoms(&mechanism, &q)
        .expect("the same configuration")
}

fn texts(motions: &FreeMotions) -> Vec<&str> {
    motions.motions.iter().map(|m| m.text.as_str()).collect()
}

/// Compares the velocities of one motion with the derived velocities.
fn moves(motions: &FreeMotions, which: usize, expected: &[(usize, [f64; 3])]) {
    let [found] = motions.motions[which].velocities.as_slice() else {
        panic!("{motions:?}");
    };
    let bodies: Vec<usize> = found.iter().map(|(b, _)| *b).collect();
    assert!(
        bodies.iter().eq(expected.iter().map(|(b, _)| b)),
        "{motions:?}"
    );
    for ((body, v), (_, w)) in found.iter().zip(expected) {
        let off = v
            .iter()
            .zip(w)
            .map(|(v, w)| (v - w).abs())
            .fold(0.0, f64::max);
        assert!(off < ROUNDING, "body {body}: {v:?}, derived {w:?}");
    }
}

/// Crank (0, 0)–(0, 1), coupler to (2, 2), rocker from (3, 0).
fn four_bar() -> Description {
    let mut d = Description::new("four-bar");
    let crank = d.body(at("crank", [0.0, 0.5]));
    let coupler = d.body(at("coupler", [1.0, 1.5]));
    let rocker = d.body(at("rocker", [2.5, 1.0]));
    pin(&mut d, "A", [GROUND, crank], [0.0, 0.0]);
    pin(&mut d, "B", [crank, coupler], [0.0, 1.0]);
    pin(&mut d, "C", [coupler, rocker], [2.0, 2.0]);
    pin(&mut d, "D", [GROUND, rocker], [3.0, 0.0]);
    d
}

/// The velocities are v_B = (−ω, 0), v_C = ω_r·(−2, −1) and v_C − v_B = ω_c·(−1, 2). It follows
/// that ω_c = −ω/5 and ω_r = 2ω/5.
#[test]
fn a_four_bar_moves_without_its_motor_only() {
    const WORDS: &str = "`crank` turns about `A`; with it `coupler` and `rocker` turn";
    let derived = [
        (0, [-0.5, 0.0, 1.0]),
        (1, [-0.9, -0.2, -0.2]),
        (2, [-0.4, -0.2, 0.4]),
    ];
    let free = freedoms(&four_bar());
    assert_eq!((free.mobility, &free.without_drives), (1, &None));
    assert_eq!(texts(&free.motions), [WORDS]);
    moves(&free.motions, 0, &derived);
    assert_eq!(free.motions.left_out, None);

    let mut d = four_bar();
    motor(&mut d, "motor", [GROUND, BodyRef::Body(0)], [0.0, 0.0]);
    let driven = freedoms(&d);
    assert_eq!((driven.mobility, texts(&driven.motions)), (0, vec![]));
    assert_eq!(driven.cannot_move, Some(false));
    let without = driven.without_drives.expect("there is a drive");
    let ranks = (without.ranks.rank, without.ranks.redundancy);
    assert_eq!((without.drives, ranks, without.mobility), (1, (8, 0), 1));
    assert_eq!(texts(&without.motions), [WORDS]);
    moves(&without.motions, 0, &derived);
}

/// If the rocker is driven, the rocker is named first, because the drive moves it.
#[test]
fn what_a_drive_moves_is_named_first() {
    let mut d = four_bar();
    motor(&mut d, "motor", [GROUND, BodyRef::Body(2)], [3.0, 0.0]);
    let without = freedoms(&d).without_drives.expect("there is a drive");
    let words = "`rocker` turns about `D`; with it `crank` and `coupler` turn";
    assert_eq!(texts(&without.motions), [words]);
}

/// Two motors follow the same law. With the motors the redundancy is 1, and without them it is
/// zero.
#[test]
fn redundant_drives_leave_no_redundancy_behind() {
    let mut d = four_bar();
    motor(&mut d, "one", [GROUND, BodyRef::Body(0)], [0.0, 0.0]);
    motor(&mut d, "two", [GROUND, BodyRef::Body(0)], [0.0, 0.0]);
    let free = freedoms(&d);
    let without = free.without_drives.expect("drives");
    let found = (without.drives, without.ranks.redundancy, without.mobility);
    assert_eq!((free.mobility, found), (0, (2, 0, 1)));
}

#[test]
fn a_slider_slides_along_its_rail() {
    let axis = Direction::new([0.6, 0.8]).expect("a direction");
    let mut d = Description::new("slider");
    let block = d.body(at("block", [2.0, 1.0]));
    rail(&mut d, "rail", [GROUND, block], [2.0, 1.0], axis);
    let free = freedoms(&d);
    assert_eq!(texts(&free.motions), ["`block` slides along (0.6, 0.8)"]);
    moves(&free.motions, 0, &[(0, [0.6, 0.8, 0.0])]);
    pusher(&mut d, "pusher", [GROUND, block], [2.0, 1.0], axis);
    let driven = freedoms(&d);
    let without = driven.without_drives.expect("a drive").mobility;
    assert_eq!((driven.mobility, without), (0, 1));
}

/// A cart on a rail has a wheel that is pinned at its centre. The wheel can rotate alone.
#[test]
fn a_wheel_at_its_centre_spins_alone() {
    let mut d = Description::new("cart");
    let cart = d.body(at("cart", [0.0, 1.0]));
    let wheel = d.body(at("wheel", [0.5, 0.5]));
    rail(&mut d, "rail", [GROUND, cart], [0.0, 1.0], Direction::X);
    pin(&mut d, "axle", [cart, wheel], [0.5, 0.5]);
    let free = freedoms(&d);
    let words = [
        "`wheel` turns about `axle`",
        "`cart` and `wheel` slide together along (1, 0)",
    ];
    assert_eq!(texts(&free.motions), words);
    moves(&free.motions, 0, &[(1, [0.0, 0.0, 1.0])]);
    moves(
        &free.motions,
        1,
        &[(0, [1.0, 0.0, 0.0]), (1, [1.0, 0.0, 0.0])],
    );
}

/// Each link rotates about its own joint and moves all later links.
#[test]
fn links_of_a_chain_turn_about_their_own_joints() {
    let mut d = Description::new("arm");
    let upper = d.body(at("upper", [0.5, 0.0]));
    let fore = d.body(at("forearm", [1.5, 0.0]));
    let hand = d.body(at("hand", [2.0, 0.5]));
    pin(&mut d, "shoulder", [GROUND, upper], [0.0, 0.0]);
    pin(&mut d, "elbow", [upper, fore], [1.0, 0.0]);
    pin(&mut d, "wrist", [fore, hand], [2.0, 0.0]);
    let free = freedoms(&d);
    let words = [
        "`hand` turns about `wrist`",
        "`forearm` and `hand` turn together about `elbow`",
        "`upper`, `forearm` and `hand` turn together about `shoulder`",
    ];
    assert_eq!(texts(&free.motions), words);
    moves(&free.motions, 0, &[(2, [-0.5, 0.0, 1.0])]);
    moves(
        &free.motions,
        1,
        &[(1, [0.0, 0.5, 1.0]), (2, [-0.5, 1.0, 1.0])],
    );
    let all = [
        (0, [0.0, 0.5, 1.0]),
        (1, [0.0, 1.5, 1.0]),
        (2, [-0.5, 2.0, 1.0]),
    ];
    moves(&free.motions, 2, &all);
}

#[test]
fn a_body_that_nothing_holds_is_free() {
    let mut d = four_bar();
    d.body(at("stone", [7.0, 7.0]));
    let free = freedoms(&d);
    assert_eq!(free.mobility, 4);
    assert_eq!(texts(&free.motions)[1], "`stone` is free");
    let unit = |k: usize| (0..3).map(|i| f64::from(u8::from(i == k))).collect();
    let expected: Vec<Vec<(usize, Vec<f64>)>> = (0..3).map(|k| vec![(3, unit(k))]).collect();
    assert_eq!(free.motions.motions[1].velocities, expected);
}

/// If drives are omitted, a body that is connected to the ground only by a drive is free.
#[test]
fn a_body_that_a_drive_alone_holds_is_free_without_it() {
    let mut d = Description::new("driven stone");
    let stone = d.body(at("stone", [0.0, 0.0]));
    motor(&mut d, "motor", [GROUND, stone], [0.0, 0.0]);
    let free = freedoms(&d);
    let words = ["`stone` slides along (1, 0)", "`stone` slides along (0, 1)"];
    assert_eq!(texts(&free.motions), words);
    let without = free.without_drives.expect("a drive");
    assert_eq!((without.ranks.rank, without.mobility), (0, 3));
    assert_eq!(texts(&without.motions), ["`stone` is free"]);
}

/// Two bars that are pinned only to each other have three freedoms of both bars together, and one
/// freedom of their relative motion. The relative motion is described by the lighter bar.
#[test]
fn bodies_that_hold_only_each_other_are_free_together() {
    let mut d = Description::new("bars");
    let a = d.body(Body {
        mass: 2.0,
        ..at("a", [0.0, 0.0])
    });
    let b = d.body(at("b", [2.0, 0.0]));
    pin(&mut d, "P", [a, b], [1.0, 0.0]);
    let free = freedoms(&d);
    assert_eq!(free.mobility, 4);
    let words = ["`a` and `b` together are free", "`b` turns about `P`"];
    assert_eq!(texts(&free.motions), words);
    moves(&free.motions, 1, &[(1, [0.0, 1.0, 1.0])]);
    // Two translations, and a rotation about the first centre of mass.
    let rotation = vec![(0, vec![0.0, 0.0, 1.0]), (1, vec![0.0, 2.0, 1.0])];
    assert_eq!(free.motions.motions[0].velocities[2], rotation);
}

#[test]
fn components_move_apart() {
    let mut d = Description::new("two pendulums");
    for (name, joint, x) in [("left", "P", 0.0), ("right", "Q", 3.0)] {
        let bob = d.body(at(name, [x, -1.0]));
        pin(&mut d, joint, [GROUND, bob], [x, 0.0]);
    }
    let free = freedoms(&d);
    assert_eq!(
        texts(&free.motions),
        ["`left` turns about `P`", "`right` turns about `Q`"]
    );
    moves(&free.motions, 0, &[(0, [1.0, 0.0, 1.0])]);
    moves(&free.motions, 1, &[(1, [1.0, 0.0, 1.0])]);
}

#[test]
fn a_skate_slides_along_its_edge_and_turns_about_it() {
    let mut d = Description::new("skate");
    let skate = d.body(at("skate", [0.0, 0.0]));
    let normal = Direction::Y;
    d.joint(
        "blade",
        &[skate],
        KnifeEdge {
            s: [0.2, 0.0],
            normal,
        },
    );
    let free = freedoms(&d);
    let words = ["`skate` slides along (1, 0)", "`skate` turns about `blade`"];
    assert_eq!(texts(&free.motions), words);
    moves(&free.motions, 1, &[(0, [0.0, -0.2, 1.0])]);
}

/// Axles whose lines intersect at (−1, 3).
#[test]
fn a_car_turns_about_the_point_where_its_axles_meet() {
    let mut d = Description::new("car");
    let car = d.body(at("car", [0.0, 0.0]));
    for (name, s) in [
        ("rear-left", [-1.0, 0.5]),
        ("rear-right", [-1.0, -0.5]),
        ("front-left", [1.0, 0.5]),
        ("front-right", [1.0, -0.5]),
    ] {
        let normal = Direction::new([-1.0 - s[0], 3.0 - s[1]]).expect("a direction");
        d.joint(name, &[car], KnifeEdge { s, normal });
    }
    let free = freedoms(&d);
    assert_eq!(texts(&free.motions), ["`car` turns about (−1, 3) m"]);
    moves(&free.motions, 0, &[(0, [3.0, 1.0, 1.0])]);
}

/// A sun wheel with 30 teeth, a planet wheel with 15 teeth and a fixed ring with 60 teeth. If the
/// carrier rotates by 1/3, the sun rotates by 1 and the planet by −1.
#[test]
fn wheels_of_a_planetary_gear_turn_together() {
    let mut d = Description::new("planetary gear");
    let sun = d.body(at("sun", [0.0, 0.0]));
    let carrier = d.body(at("carrier", [0.0, 0.0]));
    let planet = d.body(at("planet", [0.045, 0.0]));
    pin(&mut d, "sun-bearing", [GROUND, sun], [0.0, 0.0]);
    pin(&mut d, "carrier-bearing", [GROUND, carrier], [0.0, 0.0]);
    pin(&mut d, "pin", [carrier, planet], [0.045, 0.0]);
    for (name, bodies, ratio) in [
        ("outer", [sun, planet, carrier], -2.0),
        ("inner", [planet, GROUND, carrier], 0.25),
    ] {
        d.joint(name, &bodies, Gear::new(ratio));
    }
    let free = freedoms(&d);
    let words = "`sun` turns about `sun-bearing`; with it `carrier` and `planet` turn";
    assert_eq!(texts(&free.motions), [words]);
    let third = 1.0 / 3.0;
    let derived = [
        (0, [0.0, 0.0, 1.0]),
        (1, [0.0, 0.0, third]),
        (2, [0.0, 0.045 * third, -1.0]),
    ];
    moves(&free.motions, 0, &derived);
}

/// A slide with a tool that slides across the slide. Each axis moves separately.
#[test]
fn slides_on_slides_move_along_their_axes() {
    let mut d = Description::new("gantry");
    let bridge = d.body(at("bridge", [0.0, 0.0]));
    let tool = d.body(at("tool", [0.0, 0.5]));
    rail(&mut d, "floor", [GROUND, bridge], [0.0, 0.0], Direction::X);
    rail(&mut d, "beam", [bridge, tool], [0.0, 0.5], Direction::Y);
    let free = freedoms(&d);
    let words = [
        "`tool` slides along (0, 1)",
        "`bridge` and `tool` slide together along (1, 0)",
    ];
    assert_eq!(texts(&free.motions), words);
}

#[test]
fn a_locked_door_cannot_move_with_its_motor_or_without() {
    let mut d = Description::new("door");
    let leaf = d.body(at("leaf", [0.4, 0.0]));
    pin(&mut d, "hinge", [GROUND, leaf], [0.0, 0.0]);
    pin(&mut d, "third", [GROUND, leaf], [0.8, 0.0]);
    motor(&mut d, "motor", [GROUND, leaf], [0.0, 0.0]);
    let free = freedoms(&d);
    assert!(free.mobility == 0 && free.cannot_move == Some(true));
    let without = free.without_drives.expect("a drive");
    assert_eq!((without.ranks.rank, without.ranks.redundancy), (3, 1));
    assert!(without.motions.motions.is_empty());
}

#[test]
fn of_many_motions_the_first_are_told() {
    let mut d = Description::new("pendulums");
    for k in 0..20 {
        let bob = d.body(at(&format!("bob {k}"), [f64::from(k), -1.0]));
        pin(
            &mut d,
            &format!("pin {k}"),
            [GROUND, bob],
            [f64::from(k), 0.0],
        );
    }
    let free = freedoms(&d);
    assert_eq!(free.motions.motions.len(), MOTIONS_REPORTED);
    let left_out = free.motions.left_out.expect("not all are listed");
    assert_eq!(left_out.freedoms, 8);
    assert_eq!(left_out.reason, "the first 12 motions are listed");
}

#[test]
fn a_mechanism_without_rows_is_free_bodies() {
    let mut d = Description::new("stones");
    for name in ["one", "two"] {
        d.body(at(name, [0.0, 0.0]));
    }
    let free = freedoms(&d);
    assert_eq!(free.mobility, 6);
    assert_eq!(texts(&free.motions), ["`one` is free", "`two` is free"]);
}
