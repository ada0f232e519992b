//! Starts far from the constraints: the ten examples in space with every body displaced and rotated
//! at random. The required directions of the axes of a joint are taken from the scene in the
//! gallery, whose poses are correct.

use joints::space3::{Pose, dot};
use model::start::{CorrectionLimit, consistent_velocity, scene_size};
use model::{AnyDescription, BodyRef, Mechanism, Registry, SpatialDescription, StartError, System};
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};
use pfaff::AssembledScene;
use tests::numbers::Numbers;

use crate::examples;

const NAMES: [&str; 10] = [
    "hinges", "linkage", "hooke", "bennett", "sarrus", "bricard", "table", "hexapod", "top",
    "wagon",
];

/// Largest |Φ|, relative to the size of the mechanism for lengths: rounding of the terms of a row.
const RESIDUAL: f64 = 1e-12;

/// Cosine of the angle between axes that are parallel.
const PARALLEL: f64 = 1.0 - 1e-12;

fn read(name: &str) -> AssembledScene {
    let text = examples::read(&examples::scene(name));
    AssembledScene::read(name, &text, &Registry::standard())
        .unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn spatial(d: &AnyDescription) -> &SpatialDescription {
    match d {
        AnyDescription::Space3(d) => d,
        AnyDescription::Plane(_) => panic!("a scene in space"),
    }
}

/// Returns a random direction with uniform distribution.
fn direction(numbers: &mut Numbers) -> [f64; 3] {
    loop {
        let d = [0; 3].map(|_| numbers.unit());
        let square = dot(d, d);
        if (0.01..=1.0).contains(&square) {
            return d.map(|x| x / square.sqrt());
        }
    }
}

/// Returns the product a∘b.
fn product([a, x, y, z]: [f64; 4], [b, u, v, w]: [f64; 4]) -> [f64; 4] {
    [
        a * b - x * u - y * v - z * w,
        a * u + x * b + y * w - z * v,
        a * v + y * b + z * u - x * w,
        a * w + z * b + x * v - y * u,
    ]
}

/// Rotates every body by this angle and displaces it by this length.
fn disturb(d: &mut AnyDescription, angle: f64, length: f64, numbers: &mut Numbers) {
    let AnyDescription::Space3(d) = d else {
        panic!("a scene in space")
    };
    for body in &mut d.bodies {
        let [axis, way] = [(); 2].map(|()| direction(numbers));
        let (sin, cos) = (0.5 * angle).sin_cos();
        let turn = [cos, sin * axis[0], sin * axis[1], sin * axis[2]];
        body.orientation = product(turn, body.orientation);
        body.position = [0, 1, 2].map(|k| body.position[k] + length * way[k]);
    }
}

/// Returns the poses of the bodies of a joint; the tensors of the examples are diagonal, so that
/// coordinates are those of the frames.
fn poses(bodies: &[BodyRef], q: &[f64]) -> Vec<Pose> {
    let of = |body: &BodyRef| match body {
        BodyRef::Ground => Pose::GROUND,
        BodyRef::Body(k) => {
            let [x, y, z, e @ ..]: [f64; 7] =
                q[7 * k..][..7].try_into().expect("seven coordinates");
            Pose::new([x, y, z], e)
        }
    };
    bodies.iter().map(of).collect()
}

/// Returns errors of a start: violated rows, axes with other directions than in the gallery, and
/// wheels below the ground.
fn faults(
    d: &SpatialDescription,
    right: &[f64],
    m: &Mechanism,
    q: &[f64],
    size: f64,
) -> Vec<String> {
    let mut s = m.scratch();
    m.pose(0.0, q, &mut s);
    m.phi(&mut s);
    let layout = m.layout();
    let mut found = Vec::new();
    for (row, phi) in s.phi.iter().enumerate() {
        let unit = if layout.is_angular(row) { 1.0 } else { size };
        if phi.abs() > RESIDUAL * unit {
            found.push(format!("row {} misses by {phi:e}", layout.labels[row]));
        }
    }
    for joint in &d.joints {
        let [before, after] = [right, q].map(|q| poses(&joint.bodies, q));
        let kept: &[usize] = match joint.element.spec().common.scene_type {
            "revolute" => &[2],
            "translational" => &[0, 1, 2],
            "wheel" => {
                if after[0].r[2] <= 0.0 {
                    found.push(format!("`{}` lies below the ground", joint.name));
                }
                &[]
            }
            _ => &[],
        };
        for &k in kept {
            let first = joint.element.axes().expect("a joint with an axis")[k];
            let second = before[1].direction_to_local(before[0].direction_to_global(first));
            let [a, b] = [(0, first), (1, second)].map(|(k, d)| after[k].direction_to_global(d));
            if dot(a, b) < PARALLEL {
                found.push(format!("axes of `{}` at {}", joint.name, dot(a, b)));
            }
        }
    }
    found
}

/// Assembles starts of each example with every body displaced by this amount (rad; fraction of the
/// size), and asserts that all succeed.
fn assembles(starts: usize, angle: f64, share: f64, seed: u64) {
    let mut wrong = Vec::new();
    for name in NAMES {
        let mut as_it_is = read(name);
        let right = as_it_is
            .assemble()
            .unwrap_or_else(|e| panic!("{name}: {e}"))
            .q;
        let size = scene_size(&as_it_is.mechanism, &right);
        let mut numbers = Numbers::new(seed);
        for start in 0..starts {
            let mut scene = read(name).scene;
            scene.start.correction = CorrectionLimit::Any;
            disturb(&mut scene.description, angle, share * size, &mut numbers);
            let mut disturbed =
                AssembledScene::build(scene).unwrap_or_else(|e| panic!("{name}: {e}"));
            match disturbed.assemble() {
                Err(e) => wrong.push(format!("{name} {start}: {e}")),
                Ok(found) => {
                    let d = spatial(&as_it_is.scene.description);
                    let faults = faults(d, &right, &disturbed.mechanism, &found.q, size);
                    if !faults.is_empty() {
                        wrong.push(format!("{name} {start}: {}", faults.join(", ")));
                    }
                }
            }
        }
    }
    let (n, of) = (wrong.len(), starts * NAMES.len());
    assert!(wrong.is_empty(), "{n} of {of}:\n{}", wrong.join("\n"));
}

#[test]
fn starts_ten_degrees_and_ten_percent_off_assemble() {
    assembles(20, 10_f64.to_radians(), 0.1, 1);
}

#[test]
fn starts_twenty_degrees_and_twenty_percent_off_assemble() {
    assembles(10, 20_f64.to_radians(), 0.2, 2);
}

/// A body on a ball joint is rotated, and a point of it has to move with 0.5 m/s along a direction.
const BALL: &str = r#"
scene = { name = "ball", space = "spatial" }
body = [{ name = "b", mass = 1.0, inertia = [0.3, 0.7, 0.9], orientation = { axis = [1, -2, 3], angle = 0.8 } }]
joint = [
    { name = "J", type = "spherical", bodies = ["ground", "b"], at = [0, 0, 0] },
    { name = "V", type = "velocity", body = "b", point = [0.3, 0.2, -0.4], direction = [0.6, 0.0, 0.8], rate = 0.5 },
]
"#;

/// The reference is the least kinetic energy, solved with multipliers in ground axes by nalgebra:
/// kept components are zero.
#[test]
fn components_of_an_angular_velocity_are_kept_along_the_axes_of_the_ground() {
    let axis = Vector3::new(1.0, -2.0, 3.0).normalize();
    let r = UnitQuaternion::from_scaled_axis(0.8 * axis).to_rotation_matrix();
    let inertia =
        r.matrix() * Matrix3::from_diagonal(&Vector3::new(0.3, 0.7, 0.9)) * r.matrix().transpose();
    let (point, way) = (
        r * Vector3::new(0.3, 0.2, -0.4),
        r * Vector3::new(0.6, 0.0, 0.8),
    );
    // The identity is way·(ω × point) = ω·(point × way).
    let row = point.cross(&way);
    for kept in [vec![], vec![0], vec![1], vec![2], vec![0, 1], vec![2, 0]] {
        let n = 4 + kept.len();
        let mut matrix = DMatrix::<f64>::zeros(n, n);
        matrix.view_mut((0, 0), (3, 3)).copy_from(&inertia);
        let units = kept.iter().map(|&k| Vector3::ith(k, 1.0));
        for (k, row) in std::iter::once(row).chain(units).enumerate() {
            matrix
                .view_mut((3 + k, 0), (1, 3))
                .copy_from(&row.transpose());
            matrix.view_mut((0, 3 + k), (3, 1)).copy_from(&row);
        }
        let mut right = DVector::zeros(n);
        right[3] = 0.5;
        let expected = matrix.lu().solve(&right).expect("one solution");

        let names: Vec<_> = kept
            .iter()
            .map(|k| format!("\"b.w{}\"", ["x", "y", "z"][*k]))
            .collect();
        let text = format!("{BALL}start = {{ keep = [{}] }}\n", names.join(", "));
        let mut scene = AssembledScene::read("ball", &text, &Registry::standard())
            .unwrap_or_else(|e| panic!("{e}"));
        let q = scene.assemble().expect("it is").q;
        let (m, given) = (
            &scene.mechanism,
            scene.mechanism.frames().given_velocities(&q),
        );
        let found = consistent_velocity(m, &scene.scene.start, &q, &given, &[0, 1, 2, 3])
            .unwrap_or_else(|e| panic!("{e}"));
        let omega = m.frames().body(0, &q, &found.v).omega;
        for k in 0..3 {
            assert!(
                (omega[k] - expected[k]).abs() < 1e-14,
                "{kept:?}: {omega:?}, {expected}"
            );
        }
    }
}

/// Users write angular velocities along the axes of the ground, and the messages use the same axes.
#[test]
fn an_impossible_angular_velocity_is_told_along_the_axes_of_the_ground() {
    let text = r#"
scene = { name = "hinge", space = "spatial" }
body = [{ name = "b", mass = 1.0, inertia = [0.3, 0.7, 0.9], orientation = { axis = [0, 0, 1], angle = 1.5707963267948966 }, velocity = [0, 0, 0], angular_velocity = [0.25, 3.0, 0.0] }]
joint = [{ name = "J", type = "revolute", bodies = ["ground", "b"], at = [0, 0, 0], axis = [0, 1, 0] }]
"#;
    let mut scene = AssembledScene::read("hinge", text, &Registry::standard()).expect("a scene");
    let q = scene.assemble().expect("it is").q;
    let (m, given) = (
        &scene.mechanism,
        scene.mechanism.frames().given_velocities(&q),
    );
    let rows = [0, 1, 2, 3, 4];
    let found = consistent_velocity(m, &scene.scene.start, &q, &given, &rows);
    let Err(StartError::Velocities(conflict)) = found else {
        panic!("{found:?}")
    };
    // The hinge rotates about y of the ground, which is x of the body.
    assert_eq!((conflict.coordinate, conflict.given), ("wx", 0.25));
    assert!(conflict.nearest.abs() < 1e-15, "{conflict}");
}
