//! Compares the kernels of couplings with difference quotients, at poses with parallel axes. The
//! known part of an angle follows the poses, as in a mechanism.

use joints::space3::{
    Axes, CylindricalAngleDrive, CylindricalDisplacementDrive, DistanceLengthDrive, Pose,
    RevoluteAngleDrive, Twist,
};
use joints::{Constraint, ConstraintKernels, SlopedOutputs, Space3};

use super::*;
use crate::BodyRef::{Body, Ground};
use crate::space::SpaceKind;

/// Step of differences of fourth order: the error is H⁴ plus the rounding error divided by H.
const H: f64 = 1e-3;
const CLOSE: f64 = 2e-8;

fn slope(at: impl Fn(f64) -> f64) -> f64 {
    (8.0 * (at(H) - at(-H)) - (at(2.0 * H) - at(-2.0 * H))) / (12.0 * H)
}

type Kernels = Box<dyn ConstraintKernels<Space3>>;

fn triad(axis: [f64; 3], across: [f64; 3]) -> Axes {
    Axes::new(axis, Some(across)).expect("axes")
}

fn arguments() -> Vec<joints::Argument> {
    use joints::Argument as A;
    vec![
        A::Triple([0.3, -0.2, 0.5]),
        A::Triple([-0.1, 0.4, 0.2]),
        A::Axes(triad([0.2, 0.9, -0.4], [1.0, 0.1, 0.3])),
        A::Axes(triad([-0.5, 0.3, 0.8], [0.2, 1.0, 0.0])),
        A::Absent,
    ]
}

fn drive<K: Constraint<Space3>>() -> Kernels {
    Box::new(K::from_arguments(&arguments()).expect("arguments"))
}

/// Returns couplings of an angle with an angle and with a length. The coupled joints have a common
/// body in some couplings only.
fn couplings() -> Vec<AttachedConstraint<Space3>> {
    let angle = drive::<RevoluteAngleDrive>;
    let length = drive::<CylindricalDisplacementDrive>;
    let other = drive::<CylindricalAngleDrive>;
    let placed = [
        couple(
            [
                (vec![Body(0), Body(1)], angle()),
                (vec![Body(2), Body(3)], length()),
            ],
            &[0.7, -0.2, 0.05],
        ),
        couple(
            [
                (vec![Body(0), Body(1)], length()),
                (vec![Body(1), Body(2)], angle()),
            ],
            &[-1.3],
        ),
        couple(
            [
                (vec![Ground, Body(1)], angle()),
                (vec![Ground, Body(2)], other()),
            ],
            &[0.4, 0.3],
        ),
    ];
    placed.into_iter().map(|p| p.expect("coupled")).collect()
}

/// Returns a value between −1 and 1 for each seed.
fn noise(seed: usize) -> f64 {
    (seed as f64 * 12.9898 + 4.1).sin()
}

/// The poses and the twists of some bodies, and the change of the poses with time.
struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl State {
    fn new(slots: usize, seed: usize) -> Self {
        let quaternion = |k: usize| if k % 7 < 3 { 0.0 } else { 0.4 };
        Self {
            q: (0..7 * slots)
                .map(|k| noise(seed + k) + quaternion(k))
                .collect(),
            v: (0..6 * slots).map(|k| noise(2 * seed + k + 100)).collect(),
            a: (0..6 * slots).map(|k| noise(3 * seed + k + 200)).collect(),
        }
    }

    fn poses(&self, d: &[f64]) -> Vec<Pose> {
        let q = SpaceKind::Space3.displaced(&self.q, 1.0, d);
        let pose = |q: &[f64]| Pose::new([q[0], q[1], q[2]], [q[3], q[4], q[5], q[6]]);
        q.chunks(7).map(pose).collect()
    }

    /// Makes body j rotate like body i, plus a rotation about their common axis at this rate.
    fn keep_parallel(&mut self, [i, j]: [usize; 2], rate: f64) {
        let poses = self.poses(&self.still());
        let arguments = arguments();
        let joints::Argument::Axes(axes) = &arguments[2] else {
            panic!("axes");
        };
        let own = [0, 1, 2].map(|k| self.v[6 * i + 3 + k] + rate * axes.uvw()[2][k]);
        let ground = poses[i].direction_to_global(own);
        let turned = poses[j].direction_to_local(ground);
        self.v[6 * j + 3..6 * j + 6].copy_from_slice(&turned);
    }

    fn still(&self) -> Vec<f64> {
        vec![0.0; self.v.len()]
    }
}

fn twists(v: &[f64]) -> Vec<Twist> {
    let twist = |v: &[f64]| Twist {
        v: [v[0], v[1], v[2]],
        omega: [v[3], v[4], v[5]],
    };
    v.chunks(6).map(twist).collect()
}

/// Returns the values of the unwrapped angles at some poses.
fn given(kernels: &Kernels, x: &[Pose]) -> Vec<[f64; 3]> {
    let still = vec![Twist::zero(); x.len()];
    let of = |k: usize| {
        let [cos, sin, _] = kernels.turned(k, x, &still);
        let angle = sin.atan2(cos) + 3.0 * std::f64::consts::TAU;
        [angle, angle.cos(), angle.sin()].map(|value| [value, 0.0, 0.0])
    };
    (0..kernels.spec().turns).flat_map(of).collect()
}

type Quaternion = [f64; 4];

fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    crate::space::quaternion_product(a, b)
}

/// Returns the quaternion of the axes u, v, w.
fn of_axes(axes: Axes) -> Quaternion {
    let [u, v, w] = axes.uvw();
    let scalar = 0.5 * (1.0 + u[0] + v[1] + w[2]).sqrt();
    let part = |a: f64, b: f64| (a - b) / (4.0 * scalar);
    [scalar, part(v[2], w[1]), part(w[0], u[2]), part(u[1], v[0])]
}

/// Rotates body j so that its axis is parallel to the axis of body i, at some angle about this
/// axis.
fn aligned(q: &mut [f64], [i, j]: [usize; 2], angle: f64) {
    let at = |slot: usize| 7 * slot + 3..7 * slot + 7;
    let arguments = arguments();
    let [
        joints::Argument::Axes(first),
        joints::Argument::Axes(second),
    ] = &arguments[2..4]
    else {
        panic!("axes");
    };
    let own = &q[at(i)];
    let length = own.iter().map(|e| e * e).sum::<f64>().sqrt();
    let own = [0, 1, 2, 3].map(|k| own[k] / length);
    let turn = [(0.5 * angle).cos(), 0.0, 0.0, (0.5 * angle).sin()];
    let [w, x, y, z] = of_axes(*second);
    let there = product(
        product(own, of_axes(*first)),
        product(turn, [w, -x, -y, -z]),
    );
    q[at(j)].copy_from_slice(&there);
}

struct Case {
    kernels: Kernels,
    state: State,
}

impl Case {
    fn dense(&self, x: &[Pose]) -> Vec<f64> {
        let spec = self.kernels.spec();
        let mut values = vec![0.0; spec.c.len()];
        self.kernels.c(x, &given(&self.kernels, x), &mut values);
        let mut row = vec![0.0; self.state.v.len()];
        for (e, value) in spec.c.iter().zip(values) {
            row[6 * e.slot + e.dof] += value;
        }
        row
    }

    fn phi(&self, x: &[Pose]) -> f64 {
        let mut phi = [0.0];
        self.kernels.phi(x, &given(&self.kernels, x), &mut phi);
        phi[0]
    }

    fn gamma(&self, x: &[Pose], v: &[f64]) -> f64 {
        let mut gamma = [0.0];
        self.kernels
            .gamma(x, &twists(v), &given(&self.kernels, x), &mut gamma);
        gamma[0]
    }

    fn residual(&self, x: &[Pose]) -> f64 {
        dot(&self.dense(x), &self.state.a) - self.gamma(x, &self.state.v)
    }

    fn unit(&self, k: usize, h: f64) -> Vec<f64> {
        let mut d = self.state.still();
        d[k] = h;
        d
    }

    /// Returns a derivative along each column of the block.
    fn slopes(&self, f: impl Fn(&[Pose]) -> f64) -> Vec<f64> {
        let along = |k| {
            let at = |h| f(&self.state.poses(&self.unit(k, h)));
            slope(at)
        };
        (0..self.state.v.len()).map(along).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn close(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (k, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!(
            (a - b).abs() < CLOSE * b.abs().max(1.0),
            "{what} {k}: {a}, by differences {b}"
        );
    }
}

fn cases() -> Vec<Case> {
    // Indices of the two bodies of each angle, for each coupling.
    let angles: [&[[usize; 2]]; 3] = [&[[2, 3]], &[[0, 1]], &[[0, 2], [0, 1]]];
    let case = |(seed, (bodies, mut kernels)): (usize, AttachedConstraint<Space3>)| {
        let state = |number: usize| {
            let mut state = State::new(bodies.len(), number);
            for (k, slots) in angles[seed].iter().enumerate() {
                aligned(&mut state.q, *slots, 3.0 * noise(number + k));
                state.keep_parallel(*slots, 5.0 * noise(number + k + 50));
            }
            state
        };
        let start = state(31 * seed + 7);
        kernels.initialise(&start.poses(&start.still()));
        Case {
            state: state(57 * seed + 11),
            kernels,
        }
    };
    couplings().into_iter().enumerate().map(case).collect()
}

/// Converts a row of the block from sparse to dense storage.
fn row(pattern: &[[usize; 2]], values: &[f64], columns: usize) -> Vec<f64> {
    let mut row = vec![0.0; columns];
    for (&[_, k], value) in pattern.iter().zip(values) {
        row[k] += value;
    }
    row
}

#[test]
fn kernels_agree_with_differences() {
    for (number, case) in cases().iter().enumerate() {
        let (state, kernels, spec) = (&case.state, &case.kernels, case.kernels.spec());
        let (x, n) = (state.poses(&state.still()), state.v.len());
        let (v, a) = (twists(&state.v), twists(&state.a));
        let what = |name: &str| format!("coupling {number}: {name}");
        close(&case.dense(&x), &case.slopes(|x| case.phi(x)), &what("C"));
        // Checks Γ = −d(C·v)/dt along the motion x + τ·v.
        let moved = |h: f64| {
            let d: Vec<f64> = state.v.iter().map(|v| h * v).collect();
            dot(&case.dense(&state.poses(&d)), &state.v)
        };
        let expected = -slope(moved);
        close(&[case.gamma(&x, &state.v)], &[expected], &what("Γ"));
        let mut values = vec![0.0; spec.d_velocity_dx.len()];
        kernels.d_velocity_dx(&x, &v, &given(kernels, &x), &mut values);
        let expected = case.slopes(|x| dot(&case.dense(x), &state.v));
        close(
            &row(spec.d_velocity_dx, &values, n),
            &expected,
            &what("∂(C·v)/∂x"),
        );
        let mut values = vec![0.0; spec.d_residual_dx.len()];
        kernels.d_residual_dx(&x, &v, &a, &given(kernels, &x), &mut values);
        let expected = case.slopes(|x| case.residual(x));
        close(
            &row(spec.d_residual_dx, &values, n),
            &expected,
            &what("∂(C·a − Γ)/∂x"),
        );
        let mut values = vec![0.0; spec.d_gamma_dv.len()];
        kernels.d_gamma_dv(&x, &v, &given(kernels, &x), &mut values);
        let by_v = |k: usize| {
            let at = |h: f64| {
                let mut v = state.v.clone();
                v[k] += h;
                case.gamma(&x, &v)
            };
            slope(at)
        };
        let expected: Vec<f64> = (0..n).map(by_v).collect();
        close(&row(spec.d_gamma_dv, &values, n), &expected, &what("∂Γ/∂v"));
        let mut values = vec![0.0; spec.d_force_dx.len()];
        kernels.d_force_dx(&x, &given(kernels, &x), &[1.7], &mut values);
        for i in 0..n {
            let own = spec
                .d_force_dx
                .iter()
                .zip(&values)
                .filter(|(pair, _)| pair[0] == i);
            let (pattern, values): (Vec<[usize; 2]>, Vec<f64>) = own.map(|(p, v)| (*p, *v)).unzip();
            let expected = case.slopes(|x| 1.7 * case.dense(x)[i]);
            close(&row(&pattern, &values, n), &expected, &what("∂(Cᵀλ)/∂x"));
        }
    }
}

#[test]
fn derivatives_by_data_agree_with_differences() {
    for (number, case) in cases().iter().enumerate() {
        let (state, kernels, spec) = (&case.state, &case.kernels, case.kernels.spec());
        let x = state.poses(&state.still());
        let v = twists(&state.v);
        let mut numbers = vec![0.0; spec.n_data()];
        kernels.data(&mut numbers);
        let slopes = |f: &dyn Fn(&Case) -> f64| -> Vec<f64> {
            let along = |k: usize| {
                let at = |h: f64| {
                    let mut other = numbers.clone();
                    other[k] += h;
                    let mut kernels = kernels.boxed();
                    kernels.set_data(&other);
                    f(&Case {
                        kernels,
                        state: State {
                            q: state.q.clone(),
                            v: state.v.clone(),
                            a: state.a.clone(),
                        },
                    })
                };
                slope(at)
            };
            (0..numbers.len()).map(along).collect()
        };
        let mut found = vec![0.0; numbers.len()];
        let by_data = kernels.slopes(&x, &given(kernels, &x), SlopedOutputs::All(&v));
        by_data.phi(&[1.3], &mut found);
        let expected = slopes(&|case| 1.3 * case.phi(&x));
        close(&found, &expected, &format!("coupling {number}: ∂(λᵀΦ)/∂p"));
        by_data.residual(&[1.3], &state.a, &mut found);
        let expected = slopes(&|case| 1.3 * case.residual(&x));
        close(
            &found,
            &expected,
            &format!("coupling {number}: ∂(λᵀ(C·a − Γ))/∂p"),
        );
    }
}

/// In all cases, the load along y, −C, is the only load on the second body of the joint of y. The
/// opposite load acts on the first body of this joint, even if the joint of x also loads this body.
#[test]
fn the_wrench_is_the_load_along_the_measure_that_follows() {
    for case in cases() {
        let x = case.state.poses(&case.state.still());
        let pattern = case.kernels.spec().wrench;
        let mut entries = vec![0.0; pattern.len()];
        case.kernels
            .wrench(&x, &given(&case.kernels, &x), &mut entries);
        let mut wrench = [0.0; 6];
        for (&[component, _], value) in pattern.iter().zip(entries) {
            wrench[component] += value;
        }
        let c = case.dense(&x);
        let force = [c[6], c[7], c[8]];
        close(&wrench[..3], &force, "force");
        let torque = x[1].direction_to_global([c[9], c[10], c[11]]);
        let place = case.kernels.place(&x);
        let arm: [f64; 3] = std::array::from_fn(|k| place[k] - x[1].r[k]);
        let moved = joints::space3::cross(arm, force);
        let expected: Vec<f64> = (0..3).map(|k| torque[k] - moved[k]).collect();
        close(&wrench[3..], &expected, "torque");
    }
}

#[test]
fn what_cannot_be_coupled_is_refused() {
    let arguments: Vec<joints::Argument> = vec![
        joints::Argument::Triple([0.0; 3]),
        joints::Argument::Triple([1.0, 0.0, 0.0]),
        joints::Argument::Absent,
    ];
    let length = DistanceLengthDrive::from_arguments(&arguments).expect("arguments");
    let kept = (vec![Body(0), Body(1)], Box::new(length) as Kernels);
    let other = (vec![Body(0), Body(1)], drive::<RevoluteAngleDrive>());
    let refused = couple([kept, other], &[1.0]).err();
    assert!(
        matches!(refused, Some(CouplingError::Measure { .. })),
        "{refused:?}"
    );
    let angle = || (vec![Body(0), Body(1)], drive::<RevoluteAngleDrive>());
    for coefficients in [&[0.0, 0.0][..], &[], &[f64::NAN]] {
        let refused = couple([angle(), angle()], coefficients).err();
        assert_eq!(refused, Some(CouplingError::Coefficients));
    }
}
