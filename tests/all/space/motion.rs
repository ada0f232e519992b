//! Compares motions in space with known ones: closed forms, and digits from integrations in higher
//! precision with other coordinates.

use std::ops::ControlFlow;

use dynamics::{
    Method, MotionOptions, PreparedMechanism, RowChoice, Sample, Summary, prepare, simulate,
};
use joints::space3::{Axes, Pose, Revolute, Spherical, SpringDamper};
use lab::mechanisms::space::{RollingDisk, bricard, diagonal, top};
use model::{
    Body, BodyRef, Description, Function, Mechanism, SpatialBody, SpatialDescription, StartOptions,
};

/// Simulates a mechanism and passes on every row.
pub(super) fn run(
    d: &SpatialDescription,
    options: &MotionOptions,
    mut row: impl FnMut(&PreparedMechanism, &mut Sample<'_, '_>),
) -> Summary {
    let mechanism = Mechanism::build(d).unwrap_or_else(|e| panic!("{}: {e:?}", d.name));
    let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic)
        .unwrap_or_else(|e| panic!("{}: {e}", d.name));
    simulate(&prepared, options, |sample| {
        row(&prepared, sample);
        Ok(ControlFlow::Continue(()))
    })
    .unwrap_or_else(|e| panic!("{}: {e}", d.name))
}

/// Returns options with this method and this tolerance, and with twenty rows.
pub(super) fn options(t_end: f64, method: Method, rtol: f64) -> MotionOptions {
    MotionOptions {
        rtol,
        atol: rtol,
        method,
        output_step: t_end / 20.0,
        ..MotionOptions::to(t_end)
    }
}

/// Returns coordinates and velocities at the end of a run, and the largest drift of the energy
/// relative to the largest kinetic energy.
fn moved(
    d: &SpatialDescription,
    t_end: f64,
    method: Method,
    rtol: f64,
) -> (Vec<f64>, Vec<f64>, f64) {
    let mut last = (Vec::new(), Vec::new());
    let (mut energies, mut kinetic) = (Vec::new(), 0.0_f64);
    run(d, &options(t_end, method, rtol), |prepared, row| {
        let m = &prepared.mechanism;
        let own = m.kinetic_energy(row.q, row.v);
        energies.push(own + m.potential_energy(row.q));
        kinetic = kinetic.max(own);
        last = (row.q.to_vec(), row.v.to_vec());
    });
    let drift = energies
        .iter()
        .map(|e| (e - energies[0]).abs())
        .fold(0.0, f64::max);
    (last.0, last.1, drift / kinetic)
}

fn close(found: &[f64], expected: &[f64], bound: f64, what: &str) {
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() < bound,
            "{what}: {found:?}, expected {expected:?}"
        );
    }
}

/// Steps of a tenth of the coordinates change the length of a quaternion by some percent each, and
/// fine steps do not. The body rotates uniformly in both cases.
#[test]
fn a_quaternion_that_has_drifted_far_is_scaled() {
    let mut d = SpatialDescription::new("spinning body");
    d.body(SpatialBody {
        velocity: Some([0.0; 3]),
        angular_velocity: Some([0.0, 0.0, 2.0]),
        ..SpatialBody::new("body", 1.0, diagonal([1.0, 2.0, 3.0]))
    });
    for (rtol, is_coarse) in [(0.1, true), (1e-10, false)] {
        let mut lengths = Vec::new();
        let summary = run(&d, &options(200.0, Method::Dopri5, rtol), |_, row| {
            let square: f64 = row.q[3..7].iter().map(|e| e * e).sum();
            lengths.push(square.sqrt());
            assert_eq!(row.v[5], 2.0);
        });
        let scaled = summary.normalisations;
        assert_eq!(scaled > 0, is_coarse, "{scaled}: {lengths:?}");
        let last = lengths.last().expect("rows");
        assert!((0.5..=2.0).contains(last), "{lengths:?}");
    }
}

/// A free body has the moments of inertia 1, 2, 3: ω(10) follows from Jacobi's elliptic functions.
#[test]
fn a_free_body_turns_as_eulers_equations_say() {
    let mut d = SpatialDescription::new("free body");
    d.body(SpatialBody {
        velocity: Some([0.0; 3]),
        angular_velocity: Some([0.01, 1.0, 0.01]),
        ..SpatialBody::new("body", 1.0, diagonal([1.0, 2.0, 3.0]))
    });
    let expected = [
        -0.874_573_437_891_093_6,
        0.484_996_187_341_048_45,
        0.505_001_220_547_913_3,
    ];
    for (method, rtol, bound) in [
        (Method::Dop853, 1e-13, 1e-11),
        (Method::Radau5, 1e-11, 1e-8),
    ] {
        let (q, v, drift) = moved(&d, 10.0, method, rtol);
        close(&v[3..], &expected, bound, "ω");
        assert!(drift < bound, "{drift:e}");
        let length: f64 = q[3..].iter().map(|e| e * e).sum();
        assert!(length > 0.25 && length < 4.0, "{length}");
    }
}

/// The spinning top is that of the benchmark of Romano: 15 kg, with its mass centre 1 m from the
/// fixed point.
#[test]
fn a_heavy_top() {
    let d = top();
    let half = [
        -0.702_468_297_056_585_6,
        -0.021_165_184_701_923_307,
        -0.711_400_257_651_737_4,
    ];
    let one = [
        0.173_343_964_094_386_04,
        0.640_088_592_070_568_8,
        -0.748_490_791_133_581_3,
    ];
    for (t_end, expected) in [(0.5, half), (1.0, one)] {
        let (q, v, drift) = moved(&d, t_end, Method::Dop853, 1e-13);
        close(&q[..3], &expected, 1e-9, "centre");
        assert!((v[4] - 150.0).abs() < 1e-9, "{}", v[4]);
        assert!(drift < 1e-11, "{drift:e}");
    }
}

/// A point mass on a spherical joint.
#[test]
fn a_spherical_pendulum() {
    let mut d = SpatialDescription::new("pendulum");
    d.gravity = [0.0, 0.0, -9.81];
    let bob = d.body(SpatialBody {
        position: [1.0, 0.0, 0.0],
        velocity: Some([0.0, 1.0, 0.0]),
        angular_velocity: Some([0.0, 0.0, 1.0]),
        // The body is nearly a point: a tensor of zeros would leave the spin about the rod without
        // inertia.
        ..SpatialBody::new("bob", 1.0, diagonal([1e-14, 1e-14, 1e-14]))
    });
    let pivot = Spherical {
        s_i: [0.0; 3],
        s_j: [-1.0, 0.0, 0.0],
    };
    d.joint("pivot", &[BodyRef::Ground, bob], pivot);
    let expected = [
        -0.810_268_626_725_769_7,
        0.426_669_594_730_150_03,
        -0.401_768_353_005_491_65,
    ];
    let (q, _, drift) = moved(&d, 5.0, Method::Dop853, 1e-13);
    close(&q[..3], &expected, 1e-9, "place");
    assert!(drift < 1e-11, "{drift:e}");
}

/// Returns the axes of a body.
fn axes(q: &[f64], body: usize) -> [[f64; 3]; 3] {
    let own = &q[7 * body..7 * body + 7];
    let pose = Pose::new([own[0], own[1], own[2]], [own[3], own[4], own[5], own[6]]);
    Axes::FRAME.map(|v| pose.direction_to_global(v)).uvw()
}

/// Returns the angle of rod 1 of Bricard's linkage, and the height of its third pivot.
fn bricards_angle(q: &[f64]) -> (f64, f64) {
    // Rod 1 is along x of its body; the second rod ends half a metre from its middle along −y.
    let (along, side) = (axes(q, 0)[0], axes(q, 1)[1]);
    (along[2].atan2(along[0]), q[9] - 0.5 * side[2])
}

/// Bricard's linkage of the IFToMM benchmark (A04) moves although Grübler's formula gives no degree
/// of freedom; angle and rate after 1 s come from an integration of its angle in higher precision.
#[test]
fn bricards_linkage() {
    let (q, v, drift) = moved(&bricard(), 1.0, Method::Dop853, 1e-12);
    let (theta, _) = bricards_angle(&q);
    assert!((theta + 1.035_028_459_518).abs() < 1e-9, "{theta}");
    assert!((v[4].abs() - 2.036_415_381_0).abs() < 1e-8, "{}", v[4]);
    assert!(drift < 1e-10, "{drift:e}");
}

/// With independent coordinates the state is the rotation of one rod about one of its axes, and the
/// other two axes are dependent: the error decreases with the tolerance.
#[test]
fn bricards_linkage_by_an_implicit_method() {
    for (rtol, most) in [(1e-6, 1e-5), (1e-8, 1e-7), (1e-10, 1e-9)] {
        let (q, v, drift) = moved(&bricard(), 1.0, Method::Radau5, rtol);
        let (theta, _) = bricards_angle(&q);
        let off = (theta + 1.035_028_459_518).abs();
        assert!(off < most, "{off:e} at {rtol:e}");
        let off = (v[4].abs() - 2.036_415_381_0).abs();
        assert!(off < 5.0 * most, "{off:e} at {rtol:e}");
        assert!(drift < 10.0 * most, "{drift:e}");
    }
}

/// The height of the third pivot is a closed form of its angle, along ten seconds.
#[test]
fn bricards_linkage_keeps_its_shape() {
    let options = MotionOptions {
        output_step: 0.02,
        ..options(10.0, Method::Dop853, 1e-13)
    };
    let (mut off, mut range) = (0.0_f64, [0.0_f64; 2]);
    run(&bricard(), &options, |_, row| {
        let (theta, height) = bricards_angle(row.q);
        off = off.max((height - theta.sin() / (1.0 - theta.sin())).abs());
        range = [range[0].min(theta), range[1].max(theta)];
    });
    assert!(range[0] < -2.0, "it swings: {range:?}");
    assert!(off < 1e-11, "{off:e}");
}

/// A disk that rolls steadily keeps its spin, tilt and precession, and the ground carries exactly
/// its weight.
#[test]
fn a_disk_rolls_steadily() {
    let disk = RollingDisk {
        tilt: 1.2,
        precession: 0.7,
    };
    assert!((disk.spin() + 3.590_036_905_313_046_3).abs() < 1e-15);
    let weight = RollingDisk::MASS * RollingDisk::GRAVITY;
    let options = options(5.0, Method::Dop853, 1e-13);
    let mut rows = 0;
    run(&disk.description(), &options, |_, row| {
        let [_, _, axis] = axes(row.q, 0);
        // Precession turns the axis about the vertical.
        let (sin, cos) = (disk.precession * row.t).sin_cos();
        let tilt = disk.tilt.sin();
        close(
            &axis,
            &[tilt * cos, tilt * sin, disk.tilt.cos()],
            1e-9,
            "axis",
        );
        assert!((row.v[5] - disk.spin()).abs() < 1e-9, "{}", row.v[5]);
        close(&row.q[2..3], &[RollingDisk::RADIUS * tilt], 1e-10, "height");
        let reactions = row.reactions().expect("unique").as_chosen().to_vec();
        let [edge] = &reactions[..] else {
            panic!("one joint: {reactions:?}");
        };
        close(&[edge.force[2]], &[weight], 1e-6, "contact");
        close(&edge.torque, &[0.0; 3], 1e-6, "moment about the contact");
        rows += 1;
    });
    assert_eq!(rows, 21);
}

/// A driven crank follows its drive over fifty revolutions, many of them within one output row, and
/// its bearing carries m·ω²·r.
#[test]
fn a_drive_goes_through_many_turns() {
    let mut d = SpatialDescription::new("crank");
    let crank = d.body(SpatialBody {
        position: [0.0, 0.4, 0.0],
        orientation: [1.0, 1.0, 1.0, 1.0],
        ..SpatialBody::new("crank", 2.0, diagonal([0.1, 0.2, 0.25]))
    });
    let pair = [BodyRef::Ground, crank];
    let [s_i, s_j] = pair.map(|body| d.local(body, [0.0; 3]));
    // The x-axis of the ground is the z-axis of a body rotated by 120° about the diagonal.
    let axis = Axes::new([1.0, 0.0, 0.0], Some([0.0, 1.0, 0.0])).expect("an axis");
    let origin = d.local(crank, [0.0; 3]);
    let axis_j = axis.map(|v| {
        let tip = d.local(crank, v);
        std::array::from_fn(|k| tip[k] - origin[k])
    });
    let hinge = Revolute {
        s_i,
        s_j,
        axis,
        axis_j,
    };
    let rate = 100.0 * std::f64::consts::PI;
    d.drive(
        "motor",
        &pair,
        hinge.angle_drive(),
        Function::constant_rate(rate).expect("finite"),
    );
    d.joint("hinge", &pair, hinge);
    let (q, v, _) = moved(&d, 1.005, Method::Dop853, 1e-10);
    // The angle is 50 and a quarter revolutions.
    close(&q[..3], &[0.0, 0.0, 0.4], 1e-9, "centre");
    close(&v[..3], &[0.0, -0.4 * rate, 0.0], 1e-6, "velocity");
}

/// A four-bar in the plane and the same four-bar in space on four hinges have the same motion,
/// although the one in space has three redundant rows.
#[test]
fn a_lifted_linkage_moves_as_in_the_plane() {
    let places = [[0.0, 0.0], [0.3, 0.8], [1.5, 1.1], [1.4, 0.0]];
    let mid = |k: usize| [0, 1].map(|j| 0.5 * (places[k][j] + places[k + 1][j]));
    let mut flat = Description {
        gravity: [0.0, -9.81],
        ..Description::new("flat")
    };
    let mut lifted = SpatialDescription::new("lifted");
    lifted.gravity = [0.0, -9.81, 0.0];
    let bodies: Vec<BodyRef> = (0..3)
        .map(|k| {
            let ([x, y], name) = (mid(k), format!("bar {k}"));
            let inertia = 0.1 + 0.05 * k as f64;
            flat.body(Body {
                position: [x, y],
                ..Body::new(&name, 1.0, inertia)
            });
            lifted.body(SpatialBody {
                position: [x, y, 0.0],
                ..SpatialBody::new(
                    &name,
                    1.0,
                    diagonal([0.5 * inertia, 0.5 * inertia, inertia]),
                )
            })
        })
        .collect();
    for (k, [x, y]) in places.into_iter().enumerate() {
        let of = |k: usize| bodies.get(k).copied().unwrap_or(BodyRef::Ground);
        let pair = [if k == 0 { BodyRef::Ground } else { of(k - 1) }, of(k)];
        let [s_i, s_j] = pair.map(|body| flat.local(body, [x, y]));
        flat.joint(&format!("pin {k}"), &pair, joints::Revolute { s_i, s_j });
        let [s_i, s_j] = pair.map(|body| lifted.local(body, [x, y, 0.0]));
        let axis = Axes::FRAME;
        let hinge = Revolute {
            s_i,
            s_j,
            axis,
            axis_j: axis,
        };
        lifted.joint(&format!("pin {k}"), &pair, hinge);
    }
    let (q, _, drift) = moved(&lifted, 0.6, Method::Dop853, 1e-12);
    assert!(drift < 1e-10, "{drift:e}");
    let mechanism = Mechanism::build(&flat).expect("a mechanism");
    let prepared = prepare(mechanism, &StartOptions::default(), &RowChoice::Automatic);
    let prepared = prepared.expect("a start");
    let options = MotionOptions {
        rtol: 1e-12,
        atol: 1e-12,
        ..MotionOptions::to(0.6)
    };
    let mut planar = Vec::new();
    simulate(&prepared, &options, |row| {
        planar = row.q.to_vec();
        Ok(ControlFlow::Continue(()))
    })
    .expect("a run");
    for k in 0..3 {
        close(
            &q[7 * k..7 * k + 2],
            &planar[3 * k..3 * k + 2],
            1e-11,
            "place",
        );
        let angle = 2.0 * q[7 * k + 6].atan2(q[7 * k + 3]);
        let turns = (angle - planar[3 * k + 2]) / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-11, "{turns}");
    }
}

/// For a rod on a ball joint and a spring, dop853 and radau5 agree, with the gyroscopic torque in
/// the Jacobian of the latter.
#[test]
fn explicit_and_implicit_methods_agree_in_space() {
    let mut d = SpatialDescription::new("sprung rod");
    d.gravity = [0.0, 0.0, -9.81];
    let rod = d.body(SpatialBody {
        position: [0.5, 0.0, 0.0],
        orientation: [1.0, 0.2, -0.1, 0.3],
        angular_velocity: Some([0.0, 0.0, 3.0]),
        ..SpatialBody::new("rod", 1.0, diagonal([0.02, 0.09, 0.1]))
    });
    let pair = [BodyRef::Ground, rod];
    let [s_i, s_j] = pair.map(|body| d.local(body, [0.0; 3]));
    d.joint("ball", &pair, Spherical { s_i, s_j });
    let s_j = d.local(rod, [1.0, 0.0, 0.0]);
    let spring = SpringDamper::new([1.0, 0.5, 0.8], s_j, 400.0, 3.0).with_free_length(0.4);
    d.force("spring", &pair, spring);
    let (explicit, v, _) = moved(&d, 2.0, Method::Dop853, 1e-12);
    let (implicit, w, _) = moved(&d, 2.0, Method::Radau5, 1e-11);
    close(&explicit, &implicit, 1e-7, "q");
    close(&v, &w, 1e-6, "v");
}
