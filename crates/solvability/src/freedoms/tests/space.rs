//! Free motions in space, compared with manually derived screws.

use joints::space3::Pose;

use super::texts;
use crate::Freedoms;
use crate::freedoms::movement::{Line, Movement, Twist};
use crate::sketch::{GROUND, Kind, Sketch, X, Y, Z, bennett, door, four_bar, loop_of_four, places};

use Kind::{Cylindrical, Planar, Revolute, Spherical, Translational};

/// Permitted difference between computed and derived numbers: rounding.
const ROUNDING: f64 = 1e-11;

fn freedoms(sketch: &Sketch) -> Freedoms {
    let (mechanism, q, analysis) = sketch.judged();
    let found = analysis.freedoms(&mechanism, &q);
    found.expect("the same configuration")
}

/// Compares the texts of the motions in the home pose.
fn tells(sketch: &Sketch, expected: &[&str]) {
    let found = freedoms(sketch);
    assert_eq!(texts(&found.motions), expected);
    assert_eq!(
        (found.mobility, found.motions.left_out),
        (expected.len(), None)
    );
}

#[test]
fn a_door_turns_about_its_hinges() {
    let words = "`door` turns about the axis through `H0` and `H1` along (0, 0, 1)";
    tells(&door(&[Revolute; 3], Pose::GROUND), &[words]);
    // The text names the joint with the most constraints.
    let words = "`door` turns about the axis through `H1` along (0, 0, 1)";
    tells(&door(&[Cylindrical, Revolute], Pose::GROUND), &[words]);
}

/// The coupler rotates about the intersection of A–B and D–C: s·(.3, .8) = (1.4, 0) + t·(.1, 1.1).
const FOUR_BAR: &str = "`crank` turns about the axis through `A` along (0, 0, 1); with it `coupler` turns about \
    the axis through (1.848, 4.928, 0) m along (0, 0, −1) and `rocker` turns about the axis through `D` along (0, 0, 1)";

#[test]
fn few_other_bodies_are_told_with_their_axes() {
    tells(&four_bar([Revolute; 4], Pose::GROUND), &[FOUR_BAR]);
    // Four bodies follow, so the text only states that they rotate.
    let mut s = four_bar([Revolute; 4], Pose::GROUND);
    let [crank, rocker] = [0, 2].map(model::BodyRef::Body);
    let [b, c] = [[0.3, 0.8, 0.0], [1.5, 1.1, 0.0]];
    for (name, shift) in [("second", 0.1), ("third", 0.2)] {
        // The link is carried by the crank, and rotates relative to the rocker about its own line.
        let link = s.body(name, [0.9, 0.95, shift]);
        let at = |p: [f64; 3]| [p[0], p[1], shift];
        s.joint(&format!("{name} B"), Revolute, [crank, link], at(b), Z);
        s.joint(&format!("{name} C"), Revolute, [link, rocker], at(c), Z);
    }
    // They move like the coupler, and the text names them together with it.
    let together = FOUR_BAR.replace(
        "`coupler` turns",
        "`coupler`, `second` and `third` turn together",
    );
    tells(&s, &[&together]);
    // With a second loop on the rocker, there are four other bodies, so the text only states that
    // they rotate.
    let mut s = four_bar([Revolute; 4], Pose::GROUND);
    let link = s.body("link", [2.0, 1.2, 0.0]);
    let lever = s.body("lever", [2.5, 0.6, 0.0]);
    let [c, e, f] = [c, [2.5, 1.3, 0.0], [2.6, 0.0, 0.0]];
    s.joint("C2", Revolute, [rocker, link], c, Z);
    s.joint("E", Revolute, [link, lever], e, Z);
    s.joint("F", Revolute, [lever, GROUND], f, Z);
    let words = "`crank` turns about the axis through `A` along (0, 0, 1); with it `coupler`, `rocker`, `link` and \
        `lever` turn";
    tells(&s, &[words]);
}

/// For O(0, 0), A(.3, .4), B(1.5, 0), the rod rotates about (1.5, 2) m at −1/4 of the crank.
#[test]
fn a_block_slides_with_the_crank() {
    let names = ["crank", "rod", "block", "O", "A", "B", "slide"];
    let points = [[0.0; 3], [0.3, 0.4, 0.0], [1.5, 0.0, 0.0], [1.5, 0.0, 0.0]];
    let words = "`crank` turns about the axis through `O` along (0, 0, 1); with it `rod` turns about the axis \
        through (1.5, 2, 0) m along (0, 0, −1) and `block` slides along (−1, 0, 0)";
    for middle in [Revolute, Cylindrical, Spherical] {
        let kinds = [Revolute, Revolute, middle, Translational];
        tells(
            &loop_of_four(names, kinds, points, [Z, Z, Z, X], Pose::GROUND),
            &[words],
        );
    }
}

/// Rates about the axes 1 : −5/13 : −1 : 5/13, from the screws in rational numbers: the middle link
/// has ω = (−3, 0, 9)/13 and the velocity (−12, 0, 9)/13 at the origin, so a pitch of 2π·13/10 m.
#[test]
fn the_middle_link_of_bennett_moves_as_a_screw() {
    let words = "`first` turns about the axis through `J0` along (0, 0, 1); with it `middle` turns about the axis \
        through (0, −0.9, 0) m along (−0.3162, 0, 0.9487) with a pitch of 8.168 m per turn and `last` turns about \
        the axis through `J3` along (0, −0.8, −0.6)";
    tells(&bennett(Pose::GROUND), &[words]);
}

/// The axes pass through the origin. The coupler rotates about the intersection of the planes of
/// neighbouring axes, x = 0 and 1.2·x + y = 1.6·z.
#[test]
fn a_spherical_four_bar_turns_about_its_centre() {
    let axes = [
        Z,
        [0.0, 0.6, 0.8],
        [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0],
        [0.8, 0.0, 0.6],
    ];
    let names = ["crank", "coupler", "rocker", "A", "B", "C", "D"];
    let words = "`crank` turns about the axis through `A` along (0, 0, 1); with it `coupler` turns about the axis \
        through (0, 0, 0) m along (0, −0.848, −0.53) and `rocker` turns about the axis through `D` along (0.8, 0, 0.6)";
    tells(
        &loop_of_four(names, [Revolute; 4], axes, axes, Pose::GROUND),
        &[words],
    );
}

#[test]
fn a_coupler_between_two_balls_spins_about_their_line() {
    let kinds = [Revolute, Spherical, Spherical, Revolute];
    let spin = "`coupler` turns about the axis through `B` and `C` along (0.9701, 0.2425, 0)";
    tells(&four_bar(kinds, Pose::GROUND), &[spin, FOUR_BAR]);
}

#[test]
fn single_joints_leave_their_screws() {
    let at = [0.5, -0.3, 0.2];
    let alone = |kind: Kind, axis: [f64; 3]| {
        let mut s = Sketch::new();
        let block = s.body("block", [1.0, 2.0, 3.0]);
        s.joint("J", kind, [GROUND, block], at, axis);
        s
    };
    let w = [0.6, 0.0, 0.8];
    let slides = "`block` slides along (0.6, 0, 0.8)";
    let turns = "`block` turns about the axis through `J` along (0.6, 0, 0.8)";
    tells(&alone(Revolute, w), &[turns]);
    tells(&alone(Translational, w), &[slides]);
    tells(&alone(Cylindrical, w), &[slides, turns]);
    let turns = |along: &str| format!("`block` turns about the axis through `J` along {along}");
    let [x, y, z] = ["(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)"].map(turns);
    tells(&alone(Spherical, w), &[&x, &y, &z]);
    let slides = [
        "`block` slides along (1, 0, 0)",
        "`block` slides along (0, 1, 0)",
    ];
    tells(&alone(Planar, Z), &[slides[0], slides[1], &z]);
}

/// Six motions in one entry: along the axes of the ground, and about these axes through the centre
/// of mass, which differs from the origin of the frame.
#[test]
fn a_body_that_nothing_holds_has_six_motions() {
    let mut s = Sketch::new();
    s.body("stone", [1.0, 2.0, 3.0]);
    let found = freedoms(&s);
    assert_eq!(
        (found.mobility, texts(&found.motions)),
        (6, vec!["`stone` is free"])
    );
    let frame = s.d.bodies[0].position;
    let [x, y, z] = [frame[0] - 1.0, frame[1] - 2.0, frame[2] - 3.0];
    let expected = [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [0.0, -z, y, 1.0, 0.0, 0.0],
        [z, 0.0, -x, 0.0, 1.0, 0.0],
        [-y, x, 0.0, 0.0, 0.0, 1.0],
    ];
    for (found, expected) in found.motions.motions[0].velocities.iter().zip(expected) {
        assert!(
            found[0]
                .1
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < ROUNDING)
        );
    }
}

/// Two bodies that are joined only to each other have six motions of both, and the motions between
/// them.
#[test]
fn bodies_in_space_that_hold_only_each_other_are_free_together() {
    let mut s = Sketch::new();
    let [a, b] = ["a", "b"].map(|name| s.body(name, [f64::from(u8::from(name == "b")), 0.0, 0.0]));
    s.joint("hinge", Revolute, [a, b], [0.5, 0.0, 0.0], Z);
    let words = [
        "`a` and `b` together are free",
        "`b` turns about the axis through `hinge` along (0, 0, 1)",
    ];
    let found = freedoms(&s);
    assert_eq!((found.mobility, texts(&found.motions)), (7, words.to_vec()));
    assert_eq!(found.motions.motions[0].velocities.len(), 6);
}

#[test]
fn a_car_rolls_straight_on() {
    let mut s = Sketch::new();
    let chassis = s.body("chassis", [0.1, 0.0, 0.5]);
    for (k, [x, y]) in [[1.2, 0.7], [1.2, -0.7], [-1.1, 0.7], [-1.1, -0.7]]
        .into_iter()
        .enumerate()
    {
        let wheel = s.body(&format!("wheel {k}"), [x, y, 0.3]);
        s.joint(
            &format!("hub {k}"),
            Revolute,
            [chassis, wheel],
            [x, y, 0.3],
            Y,
        );
        s.wheel(&format!("tread {k}"), wheel, Y, 0.3);
    }
    let words = "`wheel 0` and `wheel 1` turn together about the axis through `tread 0` and `tread 1` along (0, 1, 0); \
        with them `chassis` slides along (1, 0, 0) and `wheel 2` and `wheel 3` turn together about the axis through \
        `tread 2` and `tread 3` along (0, 1, 0)";
    tells(&s, &[words]);
}

/// The velocities rotate with the mechanism; their sign is that of the ground axes.
#[test]
fn motions_do_not_depend_on_where_a_mechanism_stands() {
    let all: [fn(Pose) -> Sketch; 3] = [
        |moved| four_bar([Revolute; 4], moved),
        bennett,
        |moved| door(&[Revolute, Cylindrical, Cylindrical], moved),
    ];
    for sketch in all {
        // The first link rotates about z; the frame passes these points of the ground.
        for place in places() {
            let s = sketch(place);
            let found = freedoms(&s);
            let [motion] = found.motions.motions.as_slice() else {
                panic!("{:?}", found.motions);
            };
            let (body, v) = &motion.velocities[0][0];
            let w = place.direction_to_global(Z);
            let sign = w
                .into_iter()
                .find(|w| w.abs() > ROUNDING)
                .map_or(1.0, f64::signum);
            let omega = w.map(|w| sign * w);
            let [x, y, z] = std::array::from_fn(|k| s.d.bodies[*body].position[k] - place.r[k]);
            let velocity = [
                omega[1] * z - omega[2] * y,
                omega[2] * x - omega[0] * z,
                omega[0] * y - omega[1] * x,
            ];
            // In Bennett's linkage, too, the first link is the fastest.
            let expected = velocity.into_iter().chain(omega);
            let off = v
                .iter()
                .zip(expected)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(off < ROUNDING, "{v:?}");
        }
    }
}

/// A rotation about a point at a distance of 1e8 sizes counts as a rotation, but a rotation that is
/// only rounding does not.
#[test]
fn far_axes_and_translations_are_told_apart() {
    let moves = |omega: f64, along: f64| {
        let twist = Twist {
            velocity: [1.0, 0.0, along],
            omega: [0.0, 0.0, omega],
        };
        twist.movement([1.0, 2.0, 3.0], 1.0)
    };
    let Movement::Turn(Line { point, along }) = moves(1e-8, 0.0) else {
        panic!("no rotation");
    };
    assert_eq!((point, along), ([1.0, 2.0 + 1e8, 3.0], Z));
    assert!(matches!(moves(1e-10, 0.0), Movement::Slide([x, ..]) if x == 1.0));
    assert!(matches!(moves(2.0, 1e-10), Movement::Turn(_)));
    let Movement::Screw(Line { point, along }, pitch) = moves(-2.0, 0.5) else {
        panic!("no screw");
    };
    assert_eq!((point, along), ([1.0, 1.5, 3.0], [0.0, 0.0, -1.0]));
    // The screw is left-handed: half a metre in 1/2π·2 revolutions a second, against the rotation.
    assert!((pitch + std::f64::consts::PI / 2.0).abs() < ROUNDING);
}

/// V24: six bars between corners at 120°·k + 150° above and feet at 120°·k below. A bar from foot f
/// to corner a keeps its length if `(a − f)·(ω × a + v) = 0`, that is `v_z = f·(ω × a) = −ω·sin α`
/// with the angle α from f to a. This angle is 150° or 30°, so v_z = −ω/2 and the pitch is −π m.
/// Second order blocks this motion, but not the additional pendulum.
#[test]
fn a_screw_that_second_order_blocks_is_told() {
    let mut s = Sketch::new();
    let top = s.body("triangle", [0.0, 0.0, 1.0]);
    let corner = |degrees: f64, z: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [cos, sin, z]
    };
    for k in 0..3 {
        for foot in [k, k + 1] {
            let ends = [
                corner(120.0 * f64::from(foot), 0.0),
                corner(120.0 * f64::from(k) + 150.0, 1.0),
            ];
            s.bar(&format!("bar {k} {foot}"), [GROUND, top], ends);
        }
    }
    let screw = "`triangle` turns about the axis through its centre of mass along (0, 0, 1) with a pitch of \
        −3.142 m per turn";
    let blocked = |s: &Sketch| {
        let found = freedoms(s);
        let texts: Vec<String> = found.blocked.iter().map(|m| m.text.clone()).collect();
        (found.mobility, texts)
    };
    assert_eq!(blocked(&s), (1, vec![screw.to_owned()]));
    let bob = s.body("bob", [3.0, 0.0, 0.0]);
    s.joint("pivot", Revolute, [GROUND, bob], [3.0, 0.0, 1.0], Y);
    assert_eq!(blocked(&s), (2, vec![screw.to_owned()]));
    // A movable linkage has no blocked freedom.
    assert_eq!(blocked(&bennett(Pose::GROUND)), (1, Vec::new()));
}

/// The texts depend neither on the unit of length nor on the distance from the origin.
#[test]
fn small_large_and_far_linkages_are_told_alike() {
    use crate::sketch::scaled_four_bar;
    for (size, centre, far) in [
        (1e-3, "(0.001848, 0.004928, 0)", [0.0; 3]),
        (1e3, "(1848, 4928, 0)", [0.0; 3]),
        (1.0, "(1000000, 4.928, 0)", [1e6, 0.0, 0.0]),
    ] {
        let s = scaled_four_bar(size, Pose::new(far, [1.0, 0.0, 0.0, 0.0]));
        tells(&s, &[&FOUR_BAR.replace("(1.848, 4.928, 0)", centre)]);
    }
}
