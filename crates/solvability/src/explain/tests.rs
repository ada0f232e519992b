//! Loads in space that bodies cannot tell apart, compared with what the screws of single loops
//! leave: a wrench is handed round iff it is reciprocal to the screws of all joints.

use super::*;
use crate::pose::{dimensionless, evaluated};
use crate::sketch::{
    GROUND, Kind, Sketch, X, Z, bennett, door, four_bar, loop_of_four, places, scaled_four_bar,
};
use joints::space3::Pose;

use Kind::{Cylindrical, OnPlane, Revolute, Spherical, Translational};

const HOME: Pose = Pose::GROUND;

fn explained(sketch: &Sketch) -> Explanation {
    let (mechanism, q, analysis) = sketch.judged();
    let s = evaluated(&mechanism, 0.0, &q);
    let c = dimensionless(&mechanism, &s, scene_size(&mechanism, &q));
    let decision = analysis.whole().expect("small").into_owned();
    let solvability = Solvability::from_decision(&c, decision);
    explain(&mechanism, &s, &q, &solvability).expect("decided")
}

/// Compares what is said of the joints that share loads, without the names and what is missing.
fn share(sketch: &Sketch, expected: &str) {
    let found = explained(sketch);
    let [mixing] = found.mixing.as_slice() else {
        panic!("{:?}", found.mixing);
    };
    assert!(
        mixing.text.contains(expected),
        "{} does not say `{expected}`",
        mixing.text
    );
}

/// A wrench through the hinges has no moment about their axis.
#[test]
fn coaxial_hinges_share_all_forces_and_the_moments_across() {
    let words = "`H0` and `H1` can carry forces in all directions and moments about x and y that the bodies cannot \
        tell apart: 5 numbers are missing to determine all of them";
    share(&door(&[Revolute; 2], HOME), words);
    let words =
        "`H0`, `H1` and `H2` can carry forces in all directions and moments about x and y that";
    share(&door(&[Revolute; 3], HOME), words);
    // A cylindrical joint carries no force along its axis, a ball only forces through it.
    share(
        &door(&[Revolute, Cylindrical], HOME),
        "can carry forces along x and y and moments about x and y that",
    );
    share(
        &door(&[Revolute, Spherical], HOME),
        "can carry forces in all directions through `H1` that",
    );
    share(
        &door(&[Cylindrical, Spherical], HOME),
        "can carry forces along x and y through `H1` that",
    );
}

#[test]
fn a_planar_linkage_carries_loads_across_its_plane() {
    let words = "`A`, `B`, `C` and `D` can carry a load across the plane of the linkage (force along z and two \
        moments) that the bodies cannot tell apart: 3 numbers are missing to determine all of them";
    let [home, beside, turned] = places();
    share(&four_bar([Revolute; 4], home), words);
    share(&four_bar([Revolute; 4], beside), words);
    // Neither the unit of length counts, nor the distance from the origin.
    for (size, x) in [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e6)] {
        let far = Pose::new([x, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
        share(&scaled_four_bar(size, far), words);
    }
    // (−6, −74, 93)/119 is the third axis of the rotation.
    share(
        &four_bar([Revolute; 4], turned),
        "(force along (0.05042, 0.6218, −0.7815) and two moments)",
    );
    let kinds = [Revolute, Revolute, Cylindrical, Revolute];
    share(
        &four_bar(kinds, home),
        "can carry moments about x and y that",
    );
    let kinds = [Revolute, Revolute, Revolute, Spherical];
    share(
        &four_bar(kinds, home),
        "can carry a force along z through `D` that",
    );
    // The slider-crank, too, moves in its plane.
    let names = ["crank", "rod", "block", "O", "A", "B", "slide"];
    let points = [[0.0; 3], [0.3, 0.4, 0.0], [1.5, 0.0, 0.0], [1.5, 0.0, 0.0]];
    let slider = |middle: Kind| {
        let kinds = [Revolute, Revolute, middle, Translational];
        loop_of_four(names, kinds, points, [Z, Z, Z, X], HOME)
    };
    share(
        &slider(Revolute),
        "a load across the plane of the linkage (force along z and two moments) that",
    );
    share(
        &slider(Spherical),
        "can carry a force along z through `B` that",
    );
}

/// Every force through the centre of a spherical linkage is reciprocal to rotations about it.
#[test]
fn a_spherical_linkage_carries_forces_through_its_centre() {
    let axes = [
        Z,
        [0.0, 0.6, 0.8],
        [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0],
        [0.8, 0.0, 0.6],
    ];
    let names = ["crank", "coupler", "rocker", "A", "B", "C", "D"];
    let linkage = loop_of_four(names, [Revolute; 4], axes, axes, HOME);
    share(
        &linkage,
        "can carry forces in all directions through (0, 0, 0) that",
    );
}

/// Reciprocal to the axes through (0, 0, 0), (0, 3, 0) … are the wrenches (F, M) about the origin
/// with M = (−4·Fx + 3·Fz, −3·Fy + 4·Fz, 0).
#[test]
fn the_wrenches_of_bennett_have_pitches() {
    let found = explained(&bennett(HOME));
    assert!(
        found.mixing[0]
            .text
            .contains("can carry forces in all directions with moments that")
    );
    let loads = [
        "a force along x through (0, 0, 0) with a moment of −4 N·m per N about it",
        "a force along y through (0, 0, 0) with a moment of −3 N·m per N about it",
        "a force along z through (−4, 3, 0)",
    ];
    for (stress, load) in found.stresses.iter().zip(loads) {
        let words =
            format!("`J0`, `J1`, `J2` and `J3` can put {load} on each other without any load");
        assert!(stress.text.starts_with(&words), "{}", stress.text);
    }
}

/// A slab on points of the plane z = 0.
fn slab(at: &[[f64; 2]]) -> Sketch {
    let mut s = Sketch::new();
    let slab = s.body("slab", [0.2, 0.1, 0.5]);
    for (k, [x, y]) in at.iter().enumerate() {
        s.joint(&format!("P{k}"), OnPlane, [GROUND, slab], [*x, *y, 0.0], Z);
    }
    s
}

#[test]
fn legs_of_a_table_carry_forces_along_its_axis() {
    let table = slab(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.5]]);
    share(
        &table,
        "`P0`, `P1`, `P2` and `P3` can each carry a force along z that the bodies cannot tell apart",
    );
    let words =
        "`P0`, `P1`, `P2` and `P3` can each put a force along z on the others without any load";
    assert!(explained(&table).stresses[0].text.starts_with(words));
}

/// A hinge along x and two points on planes, whose forces do not turn about it and do not meet.
#[test]
fn few_different_loads_are_told_joint_by_joint() {
    let mut s = slab(&[[1.0, 0.0]]);
    let slab = model::BodyRef::Body(0);
    s.joint("H", Revolute, [GROUND, slab], [0.0; 3], X);
    s.joint("Q", OnPlane, [GROUND, slab], [0.0, 0.5, 2.0], X);
    let words = "`P0`, `H` and `Q` share loads that the bodies cannot tell apart (`P0` a force along z, \
        `H` forces along x and z with moments, `Q` a force along x): 2 numbers are missing";
    let found = explained(&s);
    let told: Vec<&str> = found.mixing.iter().map(|m| m.text.as_str()).collect();
    assert!(told.iter().any(|text| text.contains(words)), "{told:?}");
}

/// What is unique is told component by component.
#[test]
fn what_is_determined_is_told_in_components() {
    let told = |kinds: [Kind; 4]| -> Vec<String> {
        let found = explained(&four_bar(kinds, HOME)).reactions.into_iter();
        let determined = |r: ReactionExplanation| r.text.split("; ").last().map(str::to_owned);
        found.filter_map(determined).collect()
    };
    assert_eq!(told([Revolute; 4]), ["determined is Fx and Fy"; 4]);
    // A force f along z through D(1.4, 0): at A it has Ty = −1.4·f and no Tx.
    let found = told([Revolute, Revolute, Revolute, Spherical]);
    assert_eq!(
        found[0],
        "determined is Fx, Fy, 0.8137·Fz + 0.5812·Ty and Tx"
    );
    assert_eq!(found[3], "determined is Fx and Fy");
}

/// The sentences on the dependencies of a planar mechanism at its start.
fn dependencies(d: &model::Description) -> Vec<String> {
    let mechanism = Mechanism::build(d).expect("builds");
    let (q, _) = mechanism.described_state();
    let s = evaluated(&mechanism, 0.0, &q);
    let solvability = Solvability::of_exact(&dimensionless(&mechanism, &s, 1.0)).expect("finite");
    let told = explain(&mechanism, &s, &q, &solvability).expect("decided");
    told.stresses.into_iter().map(|s| s.text).collect()
}

/// A body on the ground, held by two joints or drives, with its frame at (1, 0).
fn held(build: impl Fn(&mut model::Description, [BodyRef; 2])) -> String {
    let mut d = model::Description::new("held");
    let body = model::Body::new("b", 1.0, 1.0);
    let b = d.body(model::Body {
        position: [1.0, 0.0],
        ..body
    });
    build(&mut d, [GROUND, b]);
    let [one] = <[String; 1]>::try_from(dependencies(&d)).expect("one dependency");
    one
}

/// Numbers are those of the reactions: on the first body of each joint, which is the ground for
/// some of them and the body for others. Worked out by hand: the ground pushes the body up by 1 N
/// at the one joint and down at the other.
#[test]
fn loads_that_cancel_are_told_as_reactions_are() {
    use joints::{Direction, Fixed, Gear, Line, PinInSlot, PointOnLine};

    let roller = |s| PointOnLine::new(s, Line::new([0.0, 0.0], [1.0, 0.0]).expect("a line"));
    // The slot's force is that on the ground, the roller's that on the body.
    let found = held(|d, pair| {
        d.joint(
            "slot",
            &pair,
            PinInSlot::new([1.0, 0.0], [0.0; 2], Direction::X),
        );
        d.joint("roller", &pair[1..], roller([0.0; 2]));
    });
    let words = "`slot.Fy` = 1 N and `roller.Fy` = 1 N cancel, `slot.Fy - roller.Fy` is determined";
    assert!(found.ends_with(words), "{found}");

    // A force at an arm of 1 m has a moment, which the clamp takes.
    let found = held(|d, pair| {
        d.joint("clamp", &pair, Fixed::new([0.0; 2], [-1.0, 0.0]));
        d.joint("roller", &pair[1..], roller([0.0; 2]));
    });
    let words = "`clamp.Fy` = 1 N, `clamp.T` = 1 N·m and `roller.Fy` = 1 N cancel";
    assert!(found.ends_with(words), "{found}");

    // Guide and drive: a drive is told by the load along its measure, here on the ground.
    let found = held(|d, pair| {
        let guide = joints::Translational::new([1.0, 0.0], [0.0; 2], Direction::Y);
        let motion = model::Function::constant_rate(0.0).expect("finite");
        d.drive("m", &pair, guide.displacement_drive(), motion);
        d.joint("roller", &pair[1..], roller([0.0; 2]));
    });
    let words = "`roller.Fy` = 1 N and `m.drive` = 1 N cancel, `roller.Fy - m.drive` is determined";
    assert!(found.ends_with(words), "{found}");

    // Wheels of ratio −2, twice: the second gear is turned round. λ on `one` is balanced by λ/−2
    // of the other, whose first body is `two`.
    let mut d = model::Description::new("gears");
    let [one, two] = ["one", "two"].map(|name| d.body(model::Body::new(name, 1.0, 1.0)));
    for (name, body) in [("A", one), ("B", two)] {
        d.joint(
            name,
            &[GROUND, body],
            joints::Revolute::new([0.0; 2], [0.0; 2]),
        );
    }
    d.joint("m12", &[one, two, GROUND], Gear::new(-2.0));
    d.joint("m21", &[two, one, GROUND], Gear::new(-0.5));
    let words = "`m12.T` = 1 N·m and `m21.T` = −0.5 N·m cancel, `m12.T + 2*m21.T` is determined";
    let found = dependencies(&d);
    assert!(found.iter().any(|text| text.ends_with(words)), "{found:?}");
}

/// Hinges have no moment about their axis, and a door on two shares all others.
#[test]
fn what_is_zero_whatever_the_loads_is_told_to_be_so() {
    let found = explained(&door(&[Revolute; 2], HOME)).reactions;
    assert_eq!(found.len(), 2);
    for reaction in &found {
        let end = "; determined is Tz only, which is zero whatever the loads";
        assert!(reaction.text.ends_with(end), "{}", reaction.text);
    }
}
