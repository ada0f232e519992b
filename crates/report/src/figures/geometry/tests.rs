//! Compares the computed points of joints with the points of their definitions.

use joints::{
    Angle, Direction, Distance, Fixed, Gear, KnifeEdge, Line, Mesh, PinInSlot, PointOnLine,
    Revolute, RevoluteAngleDrive, Rolling, Translational, TranslationalDisplacementDrive,
};
use model::start::assemble;
use model::{
    Body, BodyRef, ConstraintKernels, Description, Drive, Function, Joint, Mechanism, StartOptions,
    System,
};

use super::{posed, sites};
use crate::figures::drawing::Stage;
use crate::figures::symbol::Symbol;
use crate::recording::Frame;

/// The points are computed by divisions of values of order one.
const ROUNDING: f64 = 1e-14;

/// Two bodies at general poses with one joint or drive.
fn two_bodies(element: impl ConstraintKernels + 'static, drives: bool) -> Mechanism {
    let body = |name: &str, position, angle| Body {
        name: name.into(),
        mass: 1.0,
        inertia: 1.0,
        position,
        angle,
        ..Body::default()
    };
    let mut description = Description {
        bodies: vec![
            body("first", [0.0, 0.0], 0.5),
            body("second", [2.0, 1.0], -0.7),
        ],
        ..Description::default()
    };
    let slots = element.spec().common.slots.len();
    let bodies = [BodyRef::Body(0), BodyRef::Body(1), BodyRef::Ground][..slots].to_vec();
    if drives {
        description.drives.push(Drive {
            name: "drive".into(),
            bodies,
            element: Box::new(element),
            motion: Function::steps(0.0, &[]).expect("no step"),
            tolerance: None,
        });
    } else {
        description
            .joints
            .push(Joint::new("joint", &bodies, element));
    }
    let mut mechanism = Mechanism::build(&description).expect("builds");
    // Only the initial values are needed. The initial state may violate the constraint, and the
    // picture is drawn nevertheless.
    let _ = assemble(&mut mechanism, &StartOptions::default());
    mechanism
}

/// The computed position of the joint between the two bodies.
fn site(element: impl ConstraintKernels + 'static, drives: bool) -> super::Site {
    let mechanism = two_bodies(element, drives);
    let mut s = mechanism.scratch();
    posed(&mechanism, 0.0, &mechanism.described_state().0, &mut s).expect("finite");
    sites(&mechanism, &s).remove(0)
}

/// Corners of the second body in its frame.
fn outline_of_second(element: impl ConstraintKernels + 'static) -> Vec<[f64; 2]> {
    let mechanism = two_bodies(element, false);
    let q = mechanism.described_state().0;
    let stage = Stage {
        mechanism: &mechanism,
        bodies: &[0, 1],
        coordinates: &[0, 1, 2, 3, 4, 5],
        frames: &[Frame::at_rest(0.0, &q, mechanism.layout().n_v)],
    };
    let outline = &stage.drawing(&mechanism).bodies[1].outline;
    outline.iter().map(|p| flat(p.at())).collect()
}

/// Global points of the bodies above.
fn first([x, y]: [f64; 2]) -> [f64; 2] {
    joints::Pose::new(0.0, 0.0, 0.5).to_global([x, y])
}
fn second([x, y]: [f64; 2]) -> [f64; 2] {
    joints::Pose::new(2.0, 1.0, -0.7).to_global([x, y])
}

fn flat([x, y, _]: [f64; 3]) -> [f64; 2] {
    [x, y]
}

fn near(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) <= ROUNDING
}

/// Whether two directions are parallel, with equal or opposite sense.
fn parallel(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] * b[1] - a[1] * b[0]).abs() <= ROUNDING && (a[0].hypot(a[1]) - 1.0).abs() <= ROUNDING
}

const S_I: [f64; 2] = [0.3, -0.2];

#[test]
fn symbols_follow_from_rows() {
    let fixed = Fixed::new(S_I, [0.0, 0.1]);
    let gear = Gear::new(-2.0);
    let turn = RevoluteAngleDrive::new(S_I, [0.0; 2]);
    let pin = Revolute {
        s_i: S_I,
        s_j: [0.0; 2],
    };
    assert_eq!(site(pin, false).symbol, Symbol::Pin);
    assert_eq!(site(fixed, false).symbol, Symbol::Weld);
    assert_eq!(site(gear, false).symbol, Symbol::Rotation);
    assert_eq!(site(Angle::new(), false).symbol, Symbol::Rotation);
    assert_eq!(site(turn, true).symbol, Symbol::Drive { axis: None });
}

/// The centres are at (0, 0) and (2, 1), √5 apart.
#[test]
fn wheels_touch_where_their_speeds_agree() {
    let gear = |ratio: f64| site(Gear::new(ratio), false);
    for (ratio, point, radii) in [
        // External contact: the second wheel is twice as fast and half as large.
        (-2.0, [4.0 / 3.0, 2.0 / 3.0], [2.0 / 3.0, 1.0 / 3.0]),
        // Internal contact: the slow wheel is a ring around the fast wheel.
        (0.5, [-2.0, -1.0], [1.0, 2.0]),
    ] {
        let site = gear(ratio);
        assert!(near(flat(site.place), point), "{:?}", site.place);
        assert_eq!(site.pitch.len(), 2);
        for (circle, radius) in site.pitch.iter().zip(radii) {
            assert!((circle.radius - radius * 5.0_f64.sqrt()).abs() <= ROUNDING);
        }
    }
    assert_eq!(gear(1.0).pitch, []);
}

/// The same wheels with a gear mesh: they touch at the pitch point for every pressure angle.
#[test]
fn teeth_are_at_the_pitch_point() {
    for pressure_angle in [None, Some(0.35), Some(-0.2)] {
        let mut teeth = Mesh::new([0.0; 2], [0.0; 2], -2.0);
        teeth.pressure_angle = pressure_angle;
        let mesh = site(teeth, false);
        assert_eq!(mesh.symbol, Symbol::Rotation);
        assert!(
            near(flat(mesh.place), [4.0 / 3.0, 2.0 / 3.0]),
            "{:?}",
            mesh.place
        );
        assert_eq!(mesh.end, mesh.place);
        let radii = [2.0 / 3.0, 1.0 / 3.0];
        assert_eq!(mesh.pitch.len(), 2);
        for (circle, radius) in mesh.pitch.iter().zip(radii) {
            assert!((circle.radius - radius * 5.0_f64.sqrt()).abs() <= ROUNDING);
        }
    }
}

#[test]
fn the_far_end_of_a_rod_is_found_from_gamma() {
    let s_j = [-0.4, 0.25];
    let rod = Distance::new(S_I, s_j);
    let found = site(rod.clone(), false);
    assert_eq!(found.symbol, Symbol::Rod);
    assert!(near(flat(found.place), first(S_I)));
    assert!(near(flat(found.end), second(s_j)), "{found:?}");
    assert_eq!(outline_of_second(rod), [s_j, [0.0, 0.0]]);
}

#[test]
fn a_slider_holds_the_second_body_on_its_axis() {
    // The second point is on the axis of the first body.
    let axis = first([0.6, 0.8]);
    let on_axis = [0, 1].map(|k| first(S_I)[k] + 1.7 * axis[k]);
    let s_j = joints::Pose::new(2.0, 1.0, -0.7).to_local(on_axis);
    let local = Direction::new([0.6, 0.8]).expect("a direction");
    let slider = Translational::new(S_I, s_j, local);
    let slot = PinInSlot {
        s_i: S_I,
        s_j,
        axis: local,
    };
    let drive = TranslationalDisplacementDrive::new(S_I, s_j, local);
    let found = site(slider, false);
    assert!(matches!(found.symbol, Symbol::Block { axis: a } if parallel(flat(a), axis)));
    assert!(near(flat(found.end), on_axis), "{found:?}");
    let found = site(slot, false);
    assert!(matches!(found.symbol, Symbol::Slot { axis: a } if parallel(flat(a), axis)));
    assert!(near(flat(found.end), on_axis), "{found:?}");
    let found = site(drive, true);
    assert!(matches!(found.symbol, Symbol::Drive { axis: Some(a) } if parallel(flat(a), axis)));
}

#[test]
fn edges_lie_across_their_normals_and_lines_along_themselves() {
    let normal = Direction::new([0.6, 0.8]).expect("a direction");
    let found = site(KnifeEdge { s: S_I, normal }, false);
    assert!(
        matches!(found.symbol, Symbol::Edge { along } if parallel(flat(along), first([-0.8, 0.6])))
    );
    assert!(!found.grounded && near(flat(found.place), first(S_I)));
    let rolling = Rolling {
        s: S_I,
        direction: normal,
        radius: 0.1,
    };
    let found = site(rolling.clone(), false);
    assert!(matches!(found.symbol, Symbol::Edge { .. }));
    let spinner = outline_of_second(rolling);
    assert_eq!(spinner, [[0.0, 0.0]], "the spinner by its centre");
    let line = Line::new([0.0, 0.0], [3.0, 4.0]).expect("a line");
    let found = site(PointOnLine { s: S_I, line }, false);
    assert!(matches!(found.symbol, Symbol::Slot { axis } if parallel(flat(axis), [0.6, 0.8])));
    assert!(found.grounded);
}
