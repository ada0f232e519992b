//! Tests the symbols of joints in space between two bodies, at general poses that satisfy the
//! constraints.

use joints::Space3;
use joints::space3::{
    Axes, Cylindrical, Direction, Fixed, Orientation, Planar, PointOnLine, Pose, Revolute,
    Spherical, Translational, Universal,
};
use model::{
    BodyRef, ConstraintId, ConstraintKernels, Function, Mechanism, SpatialBody, SpatialDescription,
    System,
};

use crate::figures::geometry::{Site, posed, site};
use crate::figures::symbol::Symbol;

const BODIES: [BodyRef; 2] = [BodyRef::Body(0), BodyRef::Body(1)];

/// Position of the centre of the second body in the axes of the first body. Both bodies have
/// parallel axes.
const APART: [f64; 3] = [0.7, -0.4, 1.1];

/// A point of the first body, an axis through this point, and the directions perpendicular to the
/// axis.
const POINT: [f64; 3] = [0.3, -0.2, 0.5];
const AXIS: [f64; 3] = [0.36, 0.48, 0.8];

/// Pose of the first body.
fn pose() -> Pose {
    Pose::new([5.0, -3.0, 2.0], [0.9, 0.1, -0.3, 0.2])
}

fn bodies() -> SpatialDescription {
    let mut d = SpatialDescription::new("two bodies");
    for position in [[5.0, -3.0, 2.0], pose().to_global(APART)] {
        d.body(SpatialBody {
            position,
            orientation: [0.9, 0.1, -0.3, 0.2],
            ..SpatialBody::new(
                "body",
                1.0,
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            )
        });
    }
    d.bodies[1].name = "second".into();
    d
}

fn drawn(d: &SpatialDescription) -> Site {
    let mechanism = Mechanism::build(d).expect("builds");
    let mut s = mechanism.scratch();
    posed(&mechanism, 0.0, &mechanism.described_state().0, &mut s).expect("finite");
    site(&mechanism, ConstraintId(0), &s)
}

fn of(element: impl ConstraintKernels<Space3> + 'static) -> Site {
    let mut d = bodies();
    d.joint("joint", &BODIES, element);
    drawn(&d)
}

/// Returns a point of the second body. It is the point of the first body, displaced by multiples of
/// the two perpendicular directions and of the axis.
fn second(moved: [f64; 3]) -> [f64; 3] {
    let uvw = axes().uvw();
    [0, 1, 2].map(|k| POINT[k] - APART[k] + (0..3).map(|j| moved[j] * uvw[j][k]).sum::<f64>())
}

fn axes() -> Axes {
    Axes::new(AXIS, None).expect("an axis")
}

/// Whether a direction is the axis in ground axes, up to its sign.
fn is_axis(found: [f64; 3]) -> bool {
    let axis = pose().direction_to_global(AXIS);
    let along: f64 = (0..3).map(|k| axis[k] * found[k]).sum();
    (along.abs() - 1.0).abs() < 1e-12
}

#[test]
fn what_turns_about_an_axis_only_has_it() {
    let (axis, at) = (axes(), second([0.0; 3]));
    let hinge = Revolute {
        s_i: POINT,
        s_j: at,
        axis,
        axis_j: axis,
    };
    let found = of(hinge.clone());
    assert!(
        matches!(found.symbol, Symbol::Hinge { axis } if is_axis(axis)),
        "{found:?}"
    );
    let expected = pose().to_global(POINT);
    for k in 0..3 {
        assert!((found.place[k] - expected[k]).abs() < 1e-14, "{found:?}");
        assert!((found.end[k] - expected[k]).abs() < 1e-14, "{found:?}");
    }
    let at = second([0.3, -0.6, 0.0]);
    let table = Planar {
        s_i: POINT,
        s_j: at,
        normal: axis,
        normal_j: axis,
    };
    let found = of(table);
    assert!(
        matches!(found.symbol, Symbol::Hinge { axis } if is_axis(axis)),
        "{found:?}"
    );

    let mut d = bodies();
    let motion = Function::steps(0.0, &[]).expect("no step");
    d.drive("drive", &BODIES, hinge.angle_drive(), motion);
    let found = drawn(&d);
    assert!(
        matches!(found.symbol, Symbol::Turn { axis } if is_axis(axis)),
        "{found:?}"
    );
}

#[test]
fn what_slides_along_an_axis_only_has_it_far_from_its_place_too() {
    let axis = axes();
    for far in [0.0, 1.7] {
        let (s_i, s_j) = (POINT, second([0.0, 0.0, far]));
        let found = of(Translational {
            s_i,
            s_j,
            axis,
            axis_j: axis,
        });
        assert!(
            matches!(found.symbol, Symbol::Block { axis } if is_axis(axis)),
            "{found:?}"
        );
        let found = of(Cylindrical {
            s_i,
            s_j,
            axis,
            axis_j: axis,
        });
        assert!(
            matches!(found.symbol, Symbol::Slot { axis } if is_axis(axis)),
            "{found:?}"
        );
        let found = of(PointOnLine { s_i, s_j, axis });
        assert!(
            matches!(found.symbol, Symbol::Slot { axis } if is_axis(axis)),
            "{found:?}"
        );
        let end = pose().to_global([0, 1, 2].map(|k| POINT[k] + far * AXIS[k]));
        assert!(
            (0..3).all(|k| (found.end[k] - end[k]).abs() < 1e-14),
            "{found:?}"
        );
    }
}

#[test]
fn other_joints_have_no_axis() {
    let (axes, s_i, s_j) = (axes(), POINT, second([0.0; 3]));
    assert_eq!(of(Spherical { s_i, s_j }).symbol, Symbol::Pin);
    let [u, _, w] = axes.uvw();
    let [cross, axis] = [u, w].map(|d| Direction::new(d).expect("a direction"));
    assert_eq!(
        of(Universal::new(s_i, s_j, axis, cross)).symbol,
        Symbol::Pin
    );
    assert_eq!(
        of(Fixed {
            s_i,
            s_j,
            axes,
            axes_j: axes
        })
        .symbol,
        Symbol::Weld
    );
    assert_eq!(
        of(Orientation { axes, axes_j: axes }).symbol,
        Symbol::Rotation
    );
}
