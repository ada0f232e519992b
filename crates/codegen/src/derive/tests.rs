//! Compares derived kernels with manually derived formulas.

use super::{Entry, Sparse};
use crate::testing::{KNIFE_EDGE, REVOLUTE, State, VELOCITY, assert_close, constraint, force};

/// Returns `R(angle)·s`.
fn turned(angle: f64, s: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * s[0] - sin * s[1], sin * s[0] + cos * s[1]]
}

fn at(c: &[Entry]) -> Vec<(usize, usize, bool)> {
    c.iter().map(|e| (e.row, e.column, e.constant)).collect()
}

fn places(block: &Sparse) -> Vec<[usize; 2]> {
    block.iter().map(|(at, _)| *at).collect()
}

#[test]
fn revolute() {
    let (model, _, k) = constraint(REVOLUTE);
    let state = State {
        pose: vec![[0.1, 0.2, 0.7], [0.3, -0.5, -1.9]],
        twist: vec![[1.0, 2.0, 3.0], [-1.0, 0.5, -2.0]],
        parameters: vec![
            ("s_i[0]", 0.4),
            ("s_i[1]", -0.6),
            ("s_j[0]", 1.1),
            ("s_j[1]", 0.8),
        ],
        f: Vec::new(),
    };
    let (a, b) = (turned(0.7, [0.4, -0.6]), turned(-1.9, [1.1, 0.8]));
    assert_close(
        &state.values(&model, &k.phi),
        &[0.1 + a[0] - 0.3 - b[0], 0.2 + a[1] + 0.5 - b[1]],
    );

    // C = [I, (R_i·s_i)⊥, −I, −(R_j·s_j)⊥]
    let pattern = [
        (0, 0, true),
        (0, 2, false),
        (0, 3, true),
        (0, 5, false),
        (1, 1, true),
        (1, 2, false),
        (1, 4, true),
        (1, 5, false),
    ];
    assert_eq!(at(&k.c), pattern);
    let c: Vec<_> = k.c.iter().map(|e| e.value).collect();
    assert_close(
        &state.values(&model, &c),
        &[1.0, -a[1], -1.0, b[1], 1.0, a[0], -1.0, -b[0]],
    );
    assert!(k.b.is_empty(), "a scleronomic constraint has no b");
    // Γ = R_i·s_i·ω_i² − R_j·s_j·ω_j²
    let gamma = [9.0 * a[0] - 4.0 * b[0], 9.0 * a[1] - 4.0 * b[1]];
    assert_close(&state.values(&model, &k.gamma), &gamma);
    // The force is −λ and acts at the reference point, so there is no torque.
    assert_eq!(places(&k.wrench), [[0, 0], [1, 1]]);
    // Only the rotation of a body changes Cᵀλ, and it changes only the torque on this body.
    assert_eq!(places(&k.d_force_dx), [[2, 2], [5, 5]]);
    // ∂Γ/∂ω_i = 2·R_i·s_i·ω_i
    assert_eq!(places(&k.d_gamma_dv), [[0, 2], [0, 5], [1, 2], [1, 5]]);
    let slopes: Vec<_> = k.d_gamma_dv.iter().map(|(_, e)| *e).collect();
    assert_close(
        &state.values(&model, &slopes),
        &[6.0 * a[0], 4.0 * b[0], 6.0 * a[1], 4.0 * b[1]],
    );
    assert_eq!(k.restricts_start, [true, true]);
}

fn edge_state() -> State {
    State {
        pose: vec![[5.0, 6.0, 0.9]],
        twist: vec![[1.5, -0.7, 2.0]],
        parameters: vec![
            ("s[0]", 0.3),
            ("s[1]", 1.2),
            ("normal.xy()[0]", 0.6),
            ("normal.xy()[1]", 0.8),
        ],
        f: vec![[0.25, -1.5, 3.0]],
    }
}

/// Returns n, R·s, and the velocity of the point for [`edge_state`].
fn edge() -> ([f64; 2], [f64; 2], [f64; 2]) {
    let (n, s) = (turned(0.9, [0.6, 0.8]), turned(0.9, [0.3, 1.2]));
    (n, s, [1.5 - 2.0 * s[1], -0.7 + 2.0 * s[0]])
}

/// Returns Γ = −ω·(Ω·n)·v_s + ω²·n·R·s for [`edge_state`].
fn edge_gamma() -> f64 {
    let (n, s, v) = edge();
    -2.0 * (-n[1] * v[0] + n[0] * v[1]) + 4.0 * (n[0] * s[0] + n[1] * s[1])
}

#[test]
fn knife_edge() {
    let (model, _, k) = constraint(KNIFE_EDGE);
    let (n, s, _) = edge();
    let state = edge_state();
    assert!(k.phi.is_empty() && k.b.is_empty());
    // Ψ = [n, n·(Ω·R·s)]. The last entry does not depend on the pose, because both vectors rotate
    // together.
    assert_eq!(at(&k.c), [(0, 0, false), (0, 1, false), (0, 2, true)]);
    let c: Vec<_> = k.c.iter().map(|e| e.value).collect();
    assert_close(
        &state.values(&model, &c),
        &[n[0], n[1], -n[0] * s[1] + n[1] * s[0]],
    );
    assert_close(&state.values(&model, &k.gamma), &[edge_gamma()]);
    // The torque about the contact vanishes identically, although no simplification rule of the
    // graph shows it.
    assert_eq!(places(&k.wrench), [[0, 0], [1, 0]]);
    // The force −λ·n along n is −λ.
    assert_close(&state.values(&model, &k.component), &[-1.0]);
}

#[test]
fn affine_rheonomic_psi() {
    let (model, _, k) = constraint(VELOCITY);
    let state = edge_state();
    // For n·v_s − f(t) = 0, b is f, and Γ is the sum of ḟ and the Γ of the knife edge.
    assert_close(&state.values(&model, &k.b), &[0.25]);
    assert_close(&state.values(&model, &k.gamma), &[edge_gamma() - 1.5]);
    // ∂(C·v − b)/∂φ = (Ω·n)·v of the origin: the contribution of ω rotates with the normal.
    let (n, ..) = edge();
    assert_eq!(places(&k.d_velocity_dx), [[0, 2]]);
    assert_close(
        &state.values(&model, &[k.d_velocity_dx[0].1]),
        &[-n[1] * 1.5 + n[0] * -0.7],
    );
}

#[test]
fn rows_that_keep_the_start_do_not_restrict_it() {
    let (_, _, k) = constraint(
        "plane Keep(i, j) {
            /// An angle keeps its value, a point stays at a given one.
            params { s: Point in i, l: Length }
            initial { angle_0: Angle = angle(j) - angle(i), twice: Length = 2.0 * l }
            rows: [angle, x];
            phi: [angle(j) - angle(i) - angle_0, point(i, s)[0] - twice];
            place: origin(i);
        }",
    );
    assert_eq!(k.restricts_start, [false, true]);
}

#[test]
fn forces_have_generalised_forces_along_their_coordinates() {
    let (model, k) = force(
        "plane Spring(i, j) {
            /// A torsion spring with damper.
            params { k: TorsionStiffness, c: TorsionDamping }
            let twist = angle(j) - angle(i);
            force: -(k * twist + c * rate(twist)) on twist;
        }",
    );
    let state = State {
        pose: vec![[0.0, 0.0, 0.5], [0.0, 0.0, 2.0]],
        twist: vec![[0.0, 0.0, 3.0], [0.0, 0.0, -1.0]],
        parameters: vec![("k", 10.0), ("c", 2.0)],
        f: Vec::new(),
    };
    // The torque is −(10·1.5 + 2·(−4)) = −7 on body j and 7 on body i.
    assert_eq!(k.q.iter().map(|(at, _)| *at).collect::<Vec<_>>(), [2, 5]);
    let q: Vec<_> = k.q.iter().map(|(_, e)| *e).collect();
    assert_close(&state.values(&model, &q), &[7.0, -7.0]);
    assert_eq!(places(&k.dq_dx), [[2, 2], [2, 5], [5, 2], [5, 5]]);
    assert_eq!(places(&k.dq_dv), [[2, 2], [2, 5], [5, 2], [5, 5]]);
    let slopes: Vec<_> = k.dq_dx.iter().chain(&k.dq_dv).map(|(_, e)| *e).collect();
    assert_close(
        &state.values(&model, &slopes),
        &[-10.0, 10.0, 10.0, -10.0, -2.0, 2.0, 2.0, -2.0],
    );
}
