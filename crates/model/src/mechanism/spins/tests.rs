//! Tests which rotations influence nothing, on mechanisms whose rotations are known by inspection.

use joints::space3::{self, BodyPointForce, Spherical};
use joints::{
    Direction, Distance, KnifeEdge, Revolute, RevoluteAngleDrive, SpringDamper, TorsionSpringDamper,
};

use crate::body::{Body, BodyRef, SpatialBody};
use crate::description::{Description, SpatialDescription};
use crate::function::Function;
use crate::mechanism::Mechanism;
use crate::system::System;

const GROUND: BodyRef = BodyRef::Ground;

fn bob(d: &mut Description, name: &str, y: f64) -> BodyRef {
    d.body(Body {
        position: [0.0, y],
        ..Body::new(name, 2.0, 0.0)
    })
}

fn spins(m: &Mechanism) -> Vec<String> {
    let columns = m.free_spins.iter();
    columns.map(|&j| m.coordinate(j).0.to_owned()).collect()
}

/// Two bobs on a rope. The rope ends at the centre of the second bob, or at another point.
fn rope(end: [f64; 2]) -> Mechanism {
    let mut d = Description::new("rope");
    d.gravity = [0.0, -9.81];
    let [a, b] = [bob(&mut d, "a", -1.0), bob(&mut d, "b", -2.0)];
    d.joint("upper", &[GROUND, a], Distance::new([0.0; 2], [0.0; 2]));
    d.joint("lower", &[a, b], Distance::new([0.0; 2], end));
    Mechanism::build(&d).expect("builds")
}

#[test]
fn a_mass_on_a_rope_rotates_freely_if_the_rope_ends_at_its_centre() {
    let m = rope([0.0; 2]);
    assert_eq!(spins(&m), ["a", "b"]);
    assert!(m.mass().iter().all(|&m| m > 0.0), "{:?}", m.mass());
    // Without the energy ½·J·ω² of the rotations.
    let (q, _) = m.described_state();
    let energy = m.kinetic_energy(&q, &[3.0, 0.0, 5.0, 0.0, 1.0, 7.0]);
    assert!((energy - 10.0).abs() < 1e-12, "{energy}");
    assert_eq!(spins(&rope([0.0, 1e-6])), ["a"]);
}

#[test]
fn a_part_has_the_free_rotations_of_the_whole() {
    let mut d = Description::new("two ropes");
    let [a, b] = [bob(&mut d, "a", -1.0), bob(&mut d, "b", -2.0)];
    for (name, body) in [("first", a), ("second", b)] {
        d.joint(name, &[GROUND, body], Distance::new([0.0; 2], [0.0; 2]));
    }
    let whole = Mechanism::build(&d).expect("builds");
    let part = whole.part(&[1]).mechanism;
    assert_eq!(spins(&part), ["b"]);
    assert_eq!(part.mass(), &whole.mass()[3..]);
}

#[test]
fn joints_and_forces_that_turn_with_a_body_depend_on_its_rotation() {
    let hinge = Revolute::new([0.0; 2], [0.0; 2]);
    let mut d = Description::new("wheel");
    let wheel = bob(&mut d, "wheel", 0.0);
    d.joint("hinge", &[GROUND, wheel], hinge);
    // A hinge at the centre of mass allows any rotation.
    assert_eq!(spins(&Mechanism::build(&d).expect("builds")), ["wheel"]);
    // A rotor at the hinge gives the rotation an inertia.
    let mut with_rotor = d.clone();
    let drive = RevoluteAngleDrive::new([0.0; 2], [0.0; 2]);
    with_rotor.armature("hinge", &[GROUND, wheel], drive, 0.3);
    let m = Mechanism::build(&with_rotor).expect("builds");
    assert!(spins(&m).is_empty());
    let (q, _) = m.described_state();
    let energy = m.kinetic_energy(&q, &[0.0, 0.0, 2.0]);
    assert!((energy - 0.6).abs() < 1e-15, "{energy}");
    d.force(
        "spring",
        &[GROUND, wheel],
        TorsionSpringDamper::new(2.0, 0.0),
    );
    assert!(spins(&Mechanism::build(&d).expect("builds")).is_empty());

    // The blade turns with the body, although it has no lever arm.
    let mut d = Description::new("skate");
    let skate = bob(&mut d, "skate", 0.0);
    d.joint("blade", &[skate], KnifeEdge::new([0.0; 2], Direction::X));
    assert!(spins(&Mechanism::build(&d).expect("builds")).is_empty());

    // A spring on a point mass and on a body that cannot rotate.
    let mut d = Description::new("spring");
    let [a, b] = [bob(&mut d, "a", -1.0), bob(&mut d, "b", -2.0)];
    d.joint("fixed", &[GROUND, b], joints::Angle::new());
    d.force(
        "spring",
        &[a, b],
        SpringDamper::new([0.0; 2], [0.5, 0.0], 3.0, 1.0),
    );
    assert_eq!(spins(&Mechanism::build(&d).expect("builds")), ["a"]);
}

/// A thin rod along x between two balls, with a force that is fixed in the rod.
fn rod(force: [f64; 3]) -> Mechanism {
    let mut d = SpatialDescription::new("rod");
    let inertia = [[0.0, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.3]];
    let rod = d.body(SpatialBody::new("rod", 2.0, inertia));
    let end = d.body(SpatialBody {
        position: [1.0, 0.0, 0.0],
        ..SpatialBody::new("end", 1.0, [[0.0; 3]; 3])
    });
    d.joint(
        "ball",
        &[GROUND, rod],
        Spherical::new([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]),
    );
    d.joint(
        "tip",
        &[rod, end],
        Spherical::new([1.0, 0.0, 0.0], [0.0; 3]),
    );
    let push = BodyPointForce { s: [0.5, 0.0, 0.0] };
    let components = force.map(|f| Function::constant(f).expect("a number"));
    d.force("push", &[rod], push).functions = components.into();
    let spring = space3::SpringDamper::new([0.0, 3.0, 0.0], [1.0, 0.0, 0.0], 4.0, 0.5);
    d.force("spring", &[GROUND, rod], spring);
    Mechanism::build(&d).expect("builds")
}

#[test]
fn a_thin_rod_between_balls_rotates_freely_about_its_axis() {
    let m = rod([5.0, 0.0, 0.0]);
    assert_eq!(m.free_spins, [3, 9, 10, 11]);
    assert_eq!(m.moments(0), [0.0, 0.3, 0.3]);
    assert_eq!(m.mass()[3], 0.3);
    let mut s = m.scratch();
    let (q, mut v) = m.described_state();
    v[3..6].copy_from_slice(&[2.0, 3.0, 5.0]);
    m.pose(0.0, &q, &mut s);
    m.twist(&v, &mut s);
    m.force(&mut s);
    // The gyroscopic torque −ω × J·ω with J = diag(0, 0.3, 0.3): no torque about the axis.
    assert_eq!(s.force[3], 0.0);
}

#[test]
fn a_thin_rod_depends_on_its_rotation_if_its_force_is_not_along_its_axis() {
    assert_eq!(rod([5.0, 1e-9, 0.0]).free_spins, [9, 10, 11]);
    assert_eq!(rod([5.0, 1e-15, 0.0]).free_spins, [3, 9, 10, 11]);
}
