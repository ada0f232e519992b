//! The equations of motion of the robot, derived by hand for this mechanism only. This module uses
//! no joint definitions, and no part of it applies to another mechanism.
//!
//! The wheels W3 and W4 allow the platform only a speed u along its x-axis. W1 makes the platform
//! rotate with `ω = κ·u`, `κ = tan β/0.3`, with the angle β of the front knuckle. By symmetry, W2
//! gives the same condition. β follows from the displacement d(t) of the slider in closed form. The
//! trolley follows its hitch with `ω₇ = −(sin δ/0.4 + κ·cos δ)·u`, with the angle δ between trolley
//! and platform. All velocities are `J·u + c(t)`, and all accelerations are `J·u̇ + Γ`, so that
//!
//! `(Σ Jᵀ·M·J)·u̇ = −Σ Jᵀ·M·Γ`.
//!
//! States that violate the constraints occur in the stages of an integrator. At these states, the
//! accelerations differ from the accelerations of the other methods. Vectors are in the frame of
//! the platform.

/// Half the wheelbase, and the distances from the hitch to the platform centre, to the trolley
/// wheel and to the centre of the trolley (m).
const WHEEL: f64 = 0.3;
const HITCH: f64 = 0.4;
const TONGUE: f64 = 0.4;
const CENTRE: f64 = 0.35;
/// Vector from the pivot of the front knuckle to the joint of its link, at β = 0.
const ARM: [f64; 2] = [-0.09, 0.05];
/// Position of the joint between slider and front link, at d = 0.
const EYE: [f64; 2] = [0.2, -0.2];
/// Squared length of a link, which connects (0.2, −0.2) and (0.21, 0.05).
const LINK_2: f64 = 0.01 * 0.01 + 0.25 * 0.25;
/// Squared length of the arm of a knuckle.
const ARM_2: f64 = ARM[0] * ARM[0] + ARM[1] * ARM[1];

const PLATFORM: [f64; 2] = [20.0, 1.2];
const KNUCKLE: [f64; 2] = [0.5, 0.002];
const LINK: [f64; 2] = [0.3, 0.0016];
const SLIDER: [f64; 2] = [1.0, 0.02];
const TROLLEY: [f64; 2] = [8.0, 0.5];

/// Position and angle of a body relative to the platform, with their derivatives.
#[derive(Clone, Copy)]
struct Carried {
    r: [f64; 2],
    rd: [f64; 2],
    rdd: [f64; 2],
    thetadd: f64,
}

impl Carried {
    /// The mirror image of the body on the other side of the platform.
    fn mirrored(&self) -> Self {
        let across = |[x, y]: [f64; 2]| [-x, y];
        Self {
            r: across(self.r),
            rd: across(self.rd),
            rdd: across(self.rdd),
            thetadd: -self.thetadd,
        }
    }
}

/// J and Γ of one body, with `a = J·u̇ + Γ`: two components of the translation, and the rotation.
type Share = ([f64; 3], [f64; 3]);

/// Computes v̇ of all bodies.
pub(crate) fn acceleration(t: f64, q: &[f64], v: &[f64], a: &mut [f64]) {
    let (sin, cos) = q[2].sin_cos();
    let (sin_d, cos_d) = (q[20] - q[2]).sin_cos();
    let u = cos * v[0] + sin * v[1];
    let (knuckle, link, slider, [kappa, kappad]) = linkage(steering(t));
    let (omega, beside) = (kappa * u, kappad * u);

    // The trolley is connected at the hitch, so that ω₇ = κ₇·u.
    let kappa_7 = -(sin_d / TONGUE + kappa * cos_d * (HITCH / TONGUE));
    let omega_7 = kappa_7 * u;
    let deltad = omega_7 - omega;
    let kappad_7 =
        -(cos_d * deltad / TONGUE + (kappad * cos_d - kappa * sin_d * deltad) * (HITCH / TONGUE));
    let (beside_7, s, c) = (kappad_7 * u, CENTRE * sin_d, CENTRE * cos_d);
    let trolley: Share = (
        [1.0 + kappa_7 * s, -HITCH * kappa - kappa_7 * c, kappa_7],
        [
            HITCH * omega * omega + beside_7 * s + omega_7 * omega_7 * c,
            u * omega - HITCH * beside - beside_7 * c + omega_7 * omega_7 * s,
            beside_7,
        ],
    );

    let carried = |b: &Carried| -> Share {
        let ([x, y], [xd, yd], [xdd, ydd]) = (b.r, b.rd, b.rdd);
        (
            [1.0 - kappa * y, kappa * x, kappa],
            [
                xdd - beside * y - omega * omega * x - 2.0 * omega * yd,
                ydd + u * omega + beside * x - omega * omega * y + 2.0 * omega * xd,
                beside + b.thetadd,
            ],
        )
    };
    let platform: Share = ([1.0, 0.0, kappa], [0.0, u * omega, beside]);
    let shares = [
        (PLATFORM, platform),
        (KNUCKLE, carried(&knuckle)),
        (KNUCKLE, carried(&knuckle.mirrored())),
        (LINK, carried(&link)),
        (LINK, carried(&link.mirrored())),
        (SLIDER, carried(&slider)),
        (TROLLEY, trolley),
    ];
    let (mut mass, mut force) = (0.0, 0.0);
    for ([m, inertia], (j, gamma)) in &shares {
        mass += m * (j[0] * j[0] + j[1] * j[1]) + inertia * j[2] * j[2];
        force -= m * (j[0] * gamma[0] + j[1] * gamma[1]) + inertia * j[2] * gamma[2];
    }
    let ud = force / mass;
    for ((_, (j, gamma)), a) in shares.iter().zip(a.chunks_exact_mut(3)) {
        let [x, y, alpha] = std::array::from_fn(|k| j[k] * ud + gamma[k]);
        a.copy_from_slice(&[cos * x - sin * y, sin * x + cos * y, alpha]);
    }
}

/// Returns front knuckle, front link, slider, and `[κ, κ̇]`, for `[d, ḋ, d̈]`.
///
/// The arm p of the knuckle and the link ℓ form the loop `w + p = ℓ`, in which w is the vector from
/// the joint on the slider to the pivot. The condition `|w + p| = |ℓ|` is
/// `cos β·(w·s) + sin β·(w·s⊥) = c`, and its derivatives are two linear equations for the rates of
/// p and ℓ.
fn linkage([d, dd, ddd]: [f64; 3]) -> (Carried, Carried, Carried, [f64; 2]) {
    let w = [WHEEL - EYE[0], -EYE[1] - d];
    let along = w[0] * ARM[0] + w[1] * ARM[1];
    let across = w[1] * ARM[0] - w[0] * ARM[1];
    let c = 0.5 * (LINK_2 - ARM_2 - w[0] * w[0] - w[1] * w[1]);
    let size = along * along + across * across;
    let (root, inverse) = ((size - c * c).sqrt(), 1.0 / size);
    let cos = (along * c - across * root) * inverse;
    let sin = (across * c + along * root) * inverse;
    let p = [cos * ARM[0] - sin * ARM[1], cos * ARM[1] + sin * ARM[0]];
    let l = [w[0] + p[0], w[1] + p[1]];

    let inverse = 1.0 / (p[0] * l[1] - p[1] * l[0]);
    let (betad, thetad) = (dd * l[1] * inverse, dd * p[1] * inverse);
    let (beta_2, theta_2) = (betad * betad, thetad * thetad);
    let g = [
        beta_2 * p[0] - theta_2 * l[0],
        ddd + beta_2 * p[1] - theta_2 * l[1],
    ];
    let betadd = (g[0] * l[0] + g[1] * l[1]) * inverse;
    let thetadd = (g[0] * p[0] + g[1] * p[1]) * inverse;

    let knuckle = Carried {
        r: [WHEEL + 0.5 * p[0], 0.5 * p[1]],
        rd: [-0.5 * betad * p[1], 0.5 * betad * p[0]],
        rdd: [
            -0.5 * (betadd * p[1] + beta_2 * p[0]),
            0.5 * (betadd * p[0] - beta_2 * p[1]),
        ],
        thetadd: betadd,
    };
    let link = Carried {
        r: [EYE[0] + 0.5 * l[0], EYE[1] + d + 0.5 * l[1]],
        rd: [-0.5 * thetad * l[1], dd + 0.5 * thetad * l[0]],
        rdd: [
            -0.5 * (thetadd * l[1] + theta_2 * l[0]),
            ddd + 0.5 * (thetadd * l[0] - theta_2 * l[1]),
        ],
        thetadd,
    };
    let slider = Carried {
        r: [0.0, EYE[1] + d],
        rd: [0.0, dd],
        rdd: [0.0, ddd],
        thetadd: 0.0,
    };
    let tan = sin / cos;
    let kappad = betad * (1.0 + tan * tan) / WHEEL;
    (knuckle, link, slider, [tan / WHEEL, kappad])
}

/// Returns `[d, ḋ, d̈]`. The function d consists of steps of one second each, 10s³ − 15s⁴ + 6s⁵.
fn steering(t: f64) -> [f64; 3] {
    const STEPS: [(f64, f64); 4] = [(1.0, 0.02), (3.0, -0.02), (6.0, -0.021876), (8.0, 0.021876)];
    let mut jet = [0.0; 3];
    for (from, by) in STEPS {
        let s = t - from;
        if s >= 1.0 {
            jet[0] += by;
        } else if s > 0.0 {
            let rest = s * (s - 1.0);
            jet[0] += by * s * s * s * (10.0 + s * (6.0 * s - 15.0));
            jet[1] += by * 30.0 * rest * rest;
            jet[2] += by * 60.0 * rest * (2.0 * s - 1.0);
        }
    }
    jet
}
