//! Tests measures and their derivatives. They are compared with rotations that are known, and with
//! differences.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};

use crate::mechanism::{BuildError, Mechanism};
use crate::start::assemble;
use crate::{
    Body, Description, Marker, Measure, MeasureKind, SpatialBody, SpatialDescription, StartError,
    StartOptions,
};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Rounding error of a few operations on numbers of size one.
const ROUNDED: f64 = 1e-14;

/// Step of the differences. The error of the differences is of order four, with rounding errors of
/// 1e-15 that are divided by the square of the step.
const STEP: f64 = 2e-3;
const OF_DIFFERENCES: f64 = 1e-7;

fn measured(kind: MeasureKind, between: [Option<usize>; 2]) -> Measure {
    Measure {
        name: "m".to_owned(),
        kind,
        between,
    }
}

/// Returns the mechanism of a hub with a wheel whose axis is y of the hub. The hub is turned by
/// this rotation. The mechanism contains a measure of this kind from the ground to the hub.
fn hub(rotation: UnitQuaternion<f64>, kind: MeasureKind) -> Result<Mechanism, Vec<BuildError>> {
    let mut d = SpatialDescription::new("hub");
    let body = SpatialBody::new("hub", 1.0, Matrix3::identity());
    let pose = Isometry3::from_parts(Translation3::new(1.0, -0.7, 0.3), rotation);
    let body = d.body(body.posed(&pose));
    d.observed.markers = vec![Marker::new("wheel", body, [0.0; 3])];
    d.observed.measures = vec![measured(kind, [None, Some(0)])];
    Mechanism::build(&d)
}

fn value(rotation: UnitQuaternion<f64>, kind: MeasureKind) -> f64 {
    let hub = hub(rotation, kind).expect("builds");
    let (q, v) = hub.described_state();
    hub.frames().measure(0, &q, &v)
}

fn turned(axis: [f64; 3], angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::from(axis) * angle)
}

fn angle(directions: [[f64; 3]; 2], about: Option<[f64; 3]>) -> MeasureKind {
    MeasureKind::Angle { directions, about }
}

#[test]
fn toe_and_camber_of_a_wheel_are_its_rotations() {
    for (toe, camber, spin) in [(0.02, -0.03, 0.0), (-2.5, 0.4, 1.1), (0.0, 0.0, -2.0)] {
        // The spin about the axis of the wheel changes no angle of the axis.
        let rotation = turned(Z, toe) * turned(X, camber) * turned(Y, spin);
        let close = |kind, expected: f64| {
            let found = value(rotation, kind);
            assert!(
                (found - expected).abs() < ROUNDED,
                "{kind:?}: {found}, not {expected}"
            );
        };
        close(angle([Y, Y], Some(Z)), toe);
        // The length of a direction has no influence, but its sense has an influence.
        close(angle([[0.0, 3.0, 0.0], Y], Some([0.0, 0.0, -0.1])), -toe);
        close(MeasureKind::Inclination([Z, Y]), camber);
        close(MeasureKind::Inclination([Z, [0.0, -2.0, 0.0]]), -camber);
        close(angle([Y, Y], None), (toe.cos() * camber.cos()).acos());
    }
    // The projections determine the angle, also for directions that are not perpendicular to
    // `about`.
    let quarter = turned(Z, FRAC_PI_2);
    let found = value(quarter, angle([[1.0, 0.0, 5.0], [1.0, 0.0, -2.0]], Some(Z)));
    assert!((found - FRAC_PI_2).abs() < ROUNDED, "{found}");
    // Small angles and nearly straight angles keep their digits.
    for expected in [1e-9, PI - 1e-9] {
        let found = value(turned(Z, expected), angle([X, X], None));
        assert!((found - expected).abs() < 1e-15, "{found}");
    }
}

#[test]
fn a_component_along_a_direction_is_that_of_the_first_marker() {
    let mut d = SpatialDescription::new("two");
    let body = |name: &str| SpatialBody::new(name, 1.0, Matrix3::identity());
    let pose = Isometry3::from_parts(Translation3::new(1.0, 2.0, 3.0), turned(Z, FRAC_PI_2));
    let first = d.body(body("first").posed(&pose));
    let second = d.body(body("second").posed(&Translation3::new(1.5, 4.0, 8.0).into()));
    let marker = |body| Marker::new("m", body, [0.0; 3]);
    d.observed.markers = vec![
        Marker {
            name: "a".into(),
            ..marker(first)
        },
        Marker {
            name: "b".into(),
            ..marker(second)
        },
    ];
    let along = MeasureKind::Along([3.0, 0.0, 4.0]);
    d.observed.measures = vec![measured(along, [Some(0), Some(1)])];
    let two = Mechanism::build(&d).expect("builds");
    let (q, v) = two.described_state();
    // The difference (0.5, 2, 5) is (2, −0.5, 5) in the axes of the first marker.
    let found = two.frames().measure(0, &q, &v);
    assert!(
        (found - (3.0 * 2.0 + 4.0 * 5.0) / 5.0).abs() < ROUNDED,
        "{found}"
    );
}

#[test]
fn in_the_plane_an_angle_between_directions_counts_revolutions() {
    let mut d = Description::new("top");
    let body = d.body(Body {
        angle: 9.0,
        ..Body::new("top", 1.0, 1.0)
    });
    d.observed.markers = vec![Marker {
        angle: Some(0.5),
        ..Marker::new("rim", body, [0.0; 3])
    }];
    d.observed.measures = vec![measured(angle([[0.0, 2.0, 0.0], X], None), [None, Some(0)])];
    let top = Mechanism::build(&d).expect("builds");
    let (q, v) = top.described_state();
    let found = top.frames().measure(0, &q, &v);
    assert!((found - (9.5 - FRAC_PI_2)).abs() < ROUNDED, "{found}");
}

/// Returns all kinds of measures, with random directions.
fn kinds() -> Vec<MeasureKind> {
    let [a, b, o] = [[0.3, 1.0, -0.4], [-0.2, 0.7, 0.9], [1.0, 0.2, 0.5]];
    vec![
        MeasureKind::Distance,
        MeasureKind::Along(a),
        angle([a, b], None),
        angle([a, b], Some(o)),
        MeasureKind::Inclination([a, b]),
        MeasureKind::Speed,
        MeasureKind::AngularVelocity,
    ]
}

#[test]
fn rates_in_space_are_differences() {
    let mut d = SpatialDescription::new("two");
    let tensor = Matrix3::new(2.0, 0.1, 0.0, 0.1, 2.5, 0.2, 0.0, 0.2, 3.0);
    for (name, at, turn) in [("one", [0.3, -0.2, 1.0], X), ("other", [1.1, 0.6, -0.5], Y)] {
        let body = SpatialBody {
            centre: [0.2, -0.1, 0.4],
            ..SpatialBody::new(name, 1.0, tensor)
        };
        let pose = Isometry3::from_parts(Translation3::from(Vector3::from(at)), turned(turn, 0.8));
        let body = d.body(body.posed(&pose));
        d.observed.markers.push(Marker {
            orientation: Some([0.9, 0.1, -0.3, 0.2]),
            ..Marker::new(&format!("m{name}"), body, [0.5, 0.25, -0.75])
        });
    }
    for (k, kind) in kinds().into_iter().enumerate() {
        d.observed.measures.push(Measure {
            name: k.to_string(),
            ..measured(kind, [Some(0), Some(1)])
        });
    }
    let two = Mechanism::build(&d).expect("builds");
    check_rates(&two, 7, 12);
}

#[test]
fn rates_in_the_plane_are_differences() {
    let mut d = Description::new("two");
    for (name, x) in [("one", 0.3), ("other", 1.7)] {
        let body = d.body(Body {
            position: [x, -0.4],
            angle: x,
            centre: [0.2, 0.3],
            ..Body::new(name, 1.0, 1.0)
        });
        let marker = Marker::new(&format!("m{name}"), body, [0.5, 0.25, 0.0]);
        d.observed.markers.push(Marker {
            angle: Some(0.3),
            ..marker
        });
    }
    let kinds = [
        MeasureKind::Distance,
        MeasureKind::Along([0.3, 1.0, 0.0]),
        angle([X, [0.5, 1.0, 0.0]], None),
        MeasureKind::Speed,
        MeasureKind::AngularVelocity,
    ];
    for (k, kind) in kinds.into_iter().enumerate() {
        d.observed.measures.push(Measure {
            name: k.to_string(),
            ..measured(kind, [Some(0), Some(1)])
        });
    }
    let two = Mechanism::build(&d).expect("builds");
    check_rates(&two, 5, 6);
}

/// Compares the derivatives of all measures, and the accelerations of all markers, with differences
/// along a path with these velocities and accelerations.
fn check_rates(mechanism: &Mechanism, n_measures: usize, n_v: usize) {
    let space = mechanism.space();
    let (q, _) = mechanism.described_state();
    let number = |k: usize, from: f64| (from + 1.7 * k as f64).sin();
    let v: Vec<f64> = (0..n_v).map(|k| number(k, 0.4)).collect();
    let a: Vec<f64> = (0..n_v).map(|k| 2.0 * number(k, 2.9)).collect();
    let at = |t: f64| {
        let moved: Vec<f64> = (0..n_v).map(|k| v[k] * t + 0.5 * a[k] * t * t).collect();
        let v: Vec<f64> = (0..n_v).map(|k| v[k] + a[k] * t).collect();
        (space.displaced(&q, 1.0, &moved), v)
    };
    let differences = |value: &dyn Fn(&[f64], &[f64]) -> f64| {
        let [far_back, back, here, on, far_on] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| {
            let (q, v) = at(k * STEP);
            value(&q, &v)
        });
        let first = (far_back - 8.0 * back + 8.0 * on - far_on) / (12.0 * STEP);
        let second = 16.0 * (back + on) - far_back - far_on - 30.0 * here;
        [first, second / (12.0 * STEP * STEP)]
    };
    let frames = mechanism.frames().with_accelerations(&a);
    for k in 0..n_measures {
        let kind = frames.observed().measures[k].kind;
        let found = frames.measure_rates(k, &q, &v);
        let value = |q: &[f64], v: &[f64]| mechanism.frames().measure(k, q, v);
        assert_eq!(found[0].to_bits(), value(&q, &v).to_bits(), "{kind:?}");
        let expected = differences(&value);
        for order in 0..2 {
            let (found, expected) = (found[order + 1], expected[order]);
            // A derivative that requires more than accelerations has neither a unit nor a value.
            match kind.units()[order + 1] {
                None => assert!(found.is_nan(), "{kind:?}: {found}"),
                Some(_) => assert!(
                    (found - expected).abs() < OF_DIFFERENCES,
                    "{kind:?}, derivative {}: {found}, not {expected}",
                    order + 1
                ),
            }
        }
    }
    for k in 0..2 {
        let found = frames.marker(k, &q, &v);
        for axis in 0..3 {
            let place = |q: &[f64], v: &[f64]| mechanism.frames().marker(k, q, v).place[axis];
            let [_, expected] = differences(&place);
            assert!((found.acceleration[axis] - expected).abs() < OF_DIFFERENCES);
            let omega = |q: &[f64], v: &[f64]| mechanism.frames().marker(k, q, v).omega[axis];
            let [expected, _] = differences(&omega);
            assert!((found.alpha[axis] - expected).abs() < OF_DIFFERENCES);
        }
        // Without accelerations of the bodies, the acceleration of the marker is NaN.
        let unknown = mechanism.frames().marker(k, &q, &v);
        assert!(unknown.acceleration.iter().all(|x| x.is_nan()));
    }
}

#[test]
fn an_angle_about_a_parallel_direction_is_rejected() {
    let straight = UnitQuaternion::identity();
    // The first direction is parallel to `about` in any configuration.
    let reason = "its first direction must not be parallel to `about`";
    let name = "m".to_owned();
    let refused = hub(straight, angle([Z, X], Some([0.0, 1e-10, -2.0])));
    assert_eq!(
        refused.err(),
        Some(vec![BuildError::Measure { name, reason }])
    );
    // The second direction is parallel at the start.
    let start = |second| {
        let mut hub = hub(straight, angle([X, second], Some(Z))).expect("builds");
        assemble(&mut hub, &StartOptions::default()).map(|_| ())
    };
    assert_eq!(start([1e-8, 0.0, 1.0]), Ok(()));
    let Err(StartError::Requirement { name, requirement }) = start([1e-10, 0.0, 1.0]) else {
        panic!("an angle without a meaning is accepted");
    };
    assert_eq!(name, "m");
    assert!(requirement.contains("second direction"), "{requirement}");
}

#[test]
fn directions_are_checked() {
    let refused = |kind| hub(UnitQuaternion::identity(), kind).is_err();
    assert!(refused(MeasureKind::Along([0.0; 3])));
    assert!(refused(MeasureKind::Along([f64::NAN, 0.0, 1.0])));
    assert!(refused(MeasureKind::Inclination([
        X,
        [0.0, f64::INFINITY, 0.0]
    ])));
    assert!(!refused(MeasureKind::Along([1e-200, 0.0, 0.0])));
    let plane = |kind: MeasureKind| kind.fault(crate::SpaceKind::Plane).is_some();
    assert!(plane(angle([X, Y], Some(Z))) && plane(angle([X, Z], None)));
    assert!(plane(MeasureKind::Inclination([X, Y])) && plane(MeasureKind::Along(Z)));
    assert!(!plane(angle([X, Y], None)) && !plane(MeasureKind::Along(Y)));
}

#[test]
fn roll_pitch_and_yaw_are_rotations_about_fixed_axes() {
    let angles = |rotation: UnitQuaternion<f64>| {
        let hub = hub(rotation, MeasureKind::Distance).expect("builds");
        let (q, v) = hub.described_state();
        hub.frames().marker(0, &q, &v).roll_pitch_yaw()
    };
    for [roll, pitch, yaw] in [[0.3, -1.2, 2.9], [-3.0, 0.01, -0.5], [1.0, 1.5, 3.1]] {
        let found = angles(turned(Z, yaw) * turned(Y, pitch) * turned(X, roll));
        for (found, expected) in found.into_iter().zip([roll, pitch, yaw]) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }
    // At a pitch of a quarter turn, only the difference of roll and yaw is defined.
    let [roll, pitch, yaw] = angles(turned(Z, 0.7) * turned(Y, FRAC_PI_2) * turned(X, 0.2));
    assert_eq!(roll, 0.0);
    assert!((pitch - FRAC_PI_2).abs() < 1e-7 && (yaw - 0.5).abs() < 1e-7);
    let [roll, pitch, yaw] = angles(turned(Z, 0.7) * turned(Y, -FRAC_PI_2) * turned(X, 0.2));
    assert_eq!(roll, 0.0);
    assert!((pitch + FRAC_PI_2).abs() < 1e-7 && (yaw - 0.9).abs() < 1e-7);
}
