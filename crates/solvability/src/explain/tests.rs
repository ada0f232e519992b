//! Spatial loads that the equilibrium of the bodies does not determine. They are compared with the
//! screws of single loops. All joints can carry a wrench iff the wrench is reciprocal to the screws
//! of all joints.

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

/// Compares the text about joints that share loads, without the names and the missing number.
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
    let words = "`H0` and `H1` share 5 load components that equilibrium does not determine (forces in all directions \
        and moments about x and y); of the sums, Fx, Fy, Fz, Tx and Ty about (0, 0, 0.4) m are determined";
    share(&door(&[Revolute; 2], HOME), words);
    let words = "(forces in all directions and moments about x and y)";
    share(&door(&[Revolute; 3], HOME), words);
    // A cylindrical joint carries no force along its axis, and a ball carries only forces through
    // its centre.
    share(
        &door(&[Revolute, Cylindrical], HOME),
        "(forces along x and y and moments about x and y)",
    );
    share(
        &door(&[Revolute, Spherical], HOME),
        "(forces in all directions through `H1`)",
    );
    share(
        &door(&[Cylindrical, Spherical], HOME),
        "(forces along x and y through `H1`)",
    );
}

#[test]
fn a_planar_linkage_carries_loads_across_its_plane() {
    let words = "`A`, `B`, `C` and `D` share 3 load components that equilibrium does not determine (a load across the \
        plane of the linkage (force along z and two moments))";
    let [home, beside, turned] = places();
    share(&four_bar([Revolute; 4], home), words);
    share(&four_bar([Revolute; 4], beside), words);
    // Neither the unit of length nor the distance from the origin has an influence.
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
    share(&four_bar(kinds, home), "(moments about x and y)");
    let kinds = [Revolute, Revolute, Revolute, Spherical];
    share(&four_bar(kinds, home), "(a force along z through `D`)");
    // The slider-crank can also move in its plane.
    let names = ["crank", "rod", "block", "O", "A", "B", "slide"];
    let points = [[0.0; 3], [0.3, 0.4, 0.0], [1.5, 0.0, 0.0], [1.5, 0.0, 0.0]];
    let slider = |middle: Kind| {
        let kinds = [Revolute, Revolute, middle, Translational];
        loop_of_four(names, kinds, points, [Z, Z, Z, X], HOME)
    };
    share(
        &slider(Revolute),
        "a load across the plane of the linkage (force along z and two moments)",
    );
    share(&slider(Spherical), "(a force along z through `B`)");
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
    share(&linkage, "(forces in all directions through (0, 0, 0) m)");
}

/// The wrenches (F, M) about the origin that are reciprocal to the axes through (0, 0, 0) m, (0, 3,
/// 0) … have M = (−4·Fx + 3·Fz, −3·Fy + 4·Fz, 0).
#[test]
fn the_wrenches_of_bennett_have_pitches() {
    let found = explained(&bennett(HOME));
    assert!(
        found.mixing[0]
            .text
            .contains("(forces in all directions with moments)")
    );
    let loads = [
        "a force along x through (0, 0, 0) m with a moment of −4 N·m per N about it",
        "a force along y through (0, 0, 0) m with a moment of −3 N·m per N about it",
        "a force along z through (−4, 3, 0) m",
    ];
    for (stress, load) in found.stresses.iter().zip(loads) {
        let words = format!("`J0`, `J1`, `J2` and `J3` can load each other with {load}");
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
        "`P0`, `P1`, `P2` and `P3` share one load component that equilibrium does not determine (a force along z at each)",
    );
    // f1 + f2 = 0 and f2 + 1.5·f3 = 0: the moments about y and x.
    let words = "`P0` and `P2` can load `P1` and `P3` with a force along z, without external load";
    assert!(explained(&table).stresses[0].text.starts_with(words));
}

/// A hinge along x and two points on planes. The forces of the points have no moment about the
/// hinge, and their lines do not intersect.
#[test]
fn few_different_loads_are_told_joint_by_joint() {
    let mut s = slab(&[[1.0, 0.0]]);
    let slab = model::BodyRef::Body(0);
    s.joint("H", Revolute, [GROUND, slab], [0.0; 3], X);
    s.joint("Q", OnPlane, [GROUND, slab], [0.0, 0.5, 2.0], X);
    let words = "`P0`, `H` and `Q` share 2 load components that equilibrium does not determine (`P0` a force along z, \
        `H` forces along x and z with moments, `Q` a force along x)";
    let found = explained(&s);
    let told: Vec<&str> = found.mixing.iter().map(|m| m.text.as_str()).collect();
    assert!(told.iter().any(|text| text.contains(words)), "{told:?}");
}

/// Three hinges on one axis and two points: 21 rows with the points, 6 freedoms, and different
/// loads.
#[test]
fn many_loads_are_not_described_joint_by_joint() {
    let mut s = slab(&[[1.0, 0.0]]);
    let slab = model::BodyRef::Body(0);
    for (k, x) in [0.0, 0.5, 1.5].into_iter().enumerate() {
        s.joint(&format!("H{k}"), Revolute, [GROUND, slab], [x, 0.0, 0.0], X);
    }
    s.joint("Q", OnPlane, [GROUND, slab], [0.0, 0.5, 2.0], X);
    let found = explained(&s);
    let words = "load components that equilibrium does not determine; of the sums";
    let [mixing] = found.mixing.as_slice() else {
        panic!("{:?}", found.mixing);
    };
    assert!(mixing.redundancy > 5, "{}", mixing.redundancy);
    assert!(mixing.text.contains(words), "{}", mixing.text);
}

/// Unique loads are reported component by component.
#[test]
fn what_is_determined_is_told_in_components() {
    let told = |kinds: [Kind; 4]| -> Vec<String> {
        let found = explained(&four_bar(kinds, HOME)).reactions.into_iter();
        let determined = |r: ReactionExplanation| r.text.split("; ").last().map(str::to_owned);
        found.filter_map(determined).collect()
    };
    assert_eq!(told([Revolute; 4]), ["only Fx and Fy are determined"; 4]);
    // A force f along z through D(1.4, 0) has the moment Ty = −1.4·f and no Tx at A.
    let found = told([Revolute, Revolute, Revolute, Spherical]);
    assert_eq!(
        found[0],
        "only Fx, Fy, 0.8137·Fz + 0.5812·Ty and Tx are determined"
    );
    assert_eq!(found[3], "only Fx and Fy are determined");
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

/// Returns the text about the dependency of a body that two joints or drives hold on the ground.
/// The frame of the body is at (1, 0).
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

/// The numbers are the components of the reactions on the first body of each joint. This body is
/// the ground for some joints, and the moving body for the other joints. By manual calculation, the
/// ground pushes the body up by 1 N at one joint, and down at the other joint.
#[test]
fn loads_that_cancel_are_told_as_reactions_are() {
    use joints::{Direction, Fixed, Gear, Line, PinInSlot, PointOnLine};

    let roller = |s| PointOnLine::new(s, Line::new([0.0, 0.0], [1.0, 0.0]).expect("a line"));
    // The force of the slot acts on the ground, and the force of the roller on the body.
    let found = held(|d, pair| {
        d.joint(
            "slot",
            &pair,
            PinInSlot::new([1.0, 0.0], [0.0; 2], Direction::X),
        );
        d.joint("roller", &pair[1..], roller([0.0; 2]));
    });
    let words =
        "`slot.Fy` = 1 N and `roller.Fy` = 1 N cancel; only `slot.Fy - roller.Fy` is determined";
    assert!(found.ends_with(words), "{found}");

    // A force at an arm of 1 m has a moment, which the clamp supports.
    let found = held(|d, pair| {
        d.joint("clamp", &pair, Fixed::new([0.0; 2], [-1.0, 0.0]));
        d.joint("roller", &pair[1..], roller([0.0; 2]));
    });
    let words = "`clamp.Fy` = 1 N, `clamp.T` = 1 N·m and `roller.Fy` = 1 N cancel";
    assert!(found.ends_with(words), "{found}");

    // A guide and a drive. The text describes a drive by the load along its joint coordinate. Here
    // this load acts on the ground.
    let found = held(|d, pair| {
        let guide = joints::Translational::new([1.0, 0.0], [0.0; 2], Direction::Y);
        let motion = model::Function::constant_rate(0.0).expect("finite");
        d.drive("m", &pair, guide.displacement_drive(), motion);
        d.joint("roller", &pair[1..], roller([0.0; 2]));
    });
    let words =
        "`roller.Fy` = 1 N and `m.drive` = 1 N cancel; only `roller.Fy - m.drive` is determined";
    assert!(found.ends_with(words), "{found}");

    // Two gear meshes with ratio −2. The order of the wheels is reversed in the second mesh. The
    // load λ on `one` is balanced by the load λ/−2 of the second mesh, whose first body is `two`.
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
    let words =
        "`m12.T` = 1 N·m and `m21.T` = −0.5 N·m cancel; only `m12.T + 2*m21.T` is determined";
    let found = dependencies(&d);
    assert!(found.iter().any(|text| text.ends_with(words)), "{found:?}");
}

/// Hinges have no moment about their axis, and two hinges of a door share all other moments.
#[test]
fn what_is_zero_whatever_the_loads_is_told_to_be_so() {
    let found = explained(&door(&[Revolute; 2], HOME)).reactions;
    assert_eq!(found.len(), 2);
    for reaction in &found {
        let end = "; only Tz is determined, and it is zero under every load";
        assert!(reaction.text.ends_with(end), "{}", reaction.text);
    }
}
