//! Kernels as dense blocks. Entries that a kernel does not write stay NaN, so that no comparison
//! ignores them.

use super::block::Block;
use super::case::Motion;
use crate::constraint::Constraint;
use crate::force::Force;
use crate::plane::{N_DOF, Pose, Twist};
use crate::ring::{Real, Ring};

fn unwritten<T: Ring>(n: usize) -> Vec<T> {
    vec![T::from(f64::NAN); n]
}

/// A dense block with these entries and zero elsewhere.
fn scatter<T: Ring>(shape: [usize; 2], pattern: &[[usize; 2]], entries: &[T]) -> Block<T> {
    let mut block = Block::filled(shape[0], shape[1], T::from(0.0));
    for (&[row, column], &e) in pattern.iter().zip(entries) {
        block.set(row, column, e);
    }
    block
}

/// Number of rows and of columns of the block of C.
pub(super) fn shape<K: Constraint>() -> [usize; 2] {
    [K::SPEC.rows.len(), N_DOF * K::SPEC.common.slots.len()]
}

/// Row and column of each entry of C.
pub(super) fn c_pattern<K: Constraint>() -> Vec<[usize; 2]> {
    K::SPEC
        .c
        .iter()
        .map(|e| [e.row, N_DOF * e.slot + e.dof])
        .collect()
}

pub(super) fn phi<T: Ring>(k: &impl Constraint, x: &[Pose<T>], f: &[[T; 3]]) -> Block<T> {
    let mut out = unwritten(rows(k));
    k.element::<T>().phi(x, f, &mut out);
    Block::column(out)
}

fn rows<K: Constraint>(_: &K) -> usize {
    K::SPEC.rows.len()
}

/// Entries of C in the order of the pattern.
pub(super) fn c_entries<T: Ring, K: Constraint>(k: &K, x: &[Pose<T>], f: &[[T; 3]]) -> Vec<T> {
    let mut constant = unwritten::<f64>(K::SPEC.c.len());
    k.c_constant(&mut constant);
    let mut varying = unwritten(K::SPEC.c.len());
    k.element::<T>().c(x, f, &mut varying);
    let both = K::SPEC.c.iter().zip(constant.iter().zip(&varying));
    both.map(|(e, (&c, &v))| if e.constant { T::from(c) } else { v })
        .collect()
}

pub(super) fn c<T: Ring, K: Constraint>(k: &K, x: &[Pose<T>], f: &[[T; 3]]) -> Block<T> {
    scatter(shape::<K>(), &c_pattern::<K>(), &c_entries(k, x, f))
}

pub(super) fn b<T: Ring, K: Constraint>(k: &K, x: &[Pose<T>], f: &[[T; 3]]) -> Block<T> {
    let mut out = if K::SPEC.rheonomic {
        unwritten(rows(k))
    } else {
        vec![T::from(0.0); rows(k)]
    };
    k.element::<T>().b(x, f, &mut out);
    Block::column(out)
}

pub(super) fn gamma<T: Ring>(
    k: &impl Constraint,
    x: &[Pose<T>],
    v: &[Twist<T>],
    f: &[[T; 3]],
) -> Block<T> {
    let mut out = unwritten(rows(k));
    k.element::<T>().gamma(x, v, f, &mut out);
    Block::column(out)
}

pub(super) fn wrench<K: Constraint>(k: &K, x: &[Pose], f: &[[f64; 3]]) -> Block {
    let mut out = unwritten(K::SPEC.wrench.len());
    k.wrench(x, f, &mut out);
    scatter([N_DOF, rows(k)], K::SPEC.wrench, &out)
}

pub(super) fn component<K: Constraint>(k: &K, x: &[Pose], f: &[[f64; 3]]) -> Block {
    let mut out = unwritten(if K::SPEC.component.is_some() {
        rows(k)
    } else {
        0
    });
    k.component(x, f, &mut out);
    Block::column(out)
}

pub(super) fn d_force_dx<K: Constraint>(
    k: &K,
    x: &[Pose],
    f: &[[f64; 3]],
    lambda: &[f64],
) -> Block {
    let mut out = unwritten(K::SPEC.d_force_dx.len());
    k.d_force_dx(x, f, lambda, &mut out);
    let [_, n] = shape::<K>();
    scatter([n, n], K::SPEC.d_force_dx, &out)
}

pub(super) fn d_residual_dx<K: Constraint>(
    k: &K,
    x: &[Pose],
    v: &[Twist],
    a: &[Twist],
    f: &[[f64; 3]],
) -> Block {
    let mut out = unwritten(K::SPEC.d_residual_dx.len());
    k.d_residual_dx(x, v, a, f, &mut out);
    scatter(shape::<K>(), K::SPEC.d_residual_dx, &out)
}

pub(super) fn d_gamma_dv<K: Constraint>(k: &K, x: &[Pose], v: &[Twist], f: &[[f64; 3]]) -> Block {
    let mut out = unwritten(K::SPEC.d_gamma_dv.len());
    k.d_gamma_dv(x, v, f, &mut out);
    scatter(shape::<K>(), K::SPEC.d_gamma_dv, &out)
}

pub(super) fn d_velocity_dx<K: Constraint>(
    k: &K,
    x: &[Pose],
    v: &[Twist],
    f: &[[f64; 3]],
) -> Block {
    let mut out = unwritten(K::SPEC.d_velocity_dx.len());
    k.d_velocity_dx(x, v, f, &mut out);
    scatter(shape::<K>(), K::SPEC.d_velocity_dx, &out)
}

/// The numbers stored by the constraint.
pub(super) fn data<K: Constraint>(k: &K) -> Vec<f64> {
    let mut out = unwritten(K::SPEC.n_data());
    k.data(&mut out);
    out
}

pub(super) fn d_phi_dp<T: Ring, K: Constraint>(
    k: &K,
    x: &[Pose<T>],
    f: &[[T; 3]],
    lambda: &[T],
) -> Block<T> {
    let mut out = unwritten(K::SPEC.n_data());
    k.element::<T>().d_phi_dp(x, f, lambda, &mut out);
    Block::column(out)
}

pub(super) fn d_residual_dp<K: Constraint>(
    k: &K,
    x: &[Pose],
    motion: &Motion,
    f: &[[f64; 3]],
) -> Block {
    let mut out = unwritten(K::SPEC.n_data());
    k.d_residual_dp(x, &motion.v, &motion.a, f, &motion.lambda, &mut out);
    Block::column(out)
}

/// The generalised force, all degrees of freedom of all slots.
pub(super) fn q<T: Real, K: Force>(k: &K, x: &[Pose<T>], v: &[Twist<T>], f: &[[T; 3]]) -> Block<T> {
    let mut out = unwritten(K::SPEC.q.len());
    k.element::<T>().q(x, v, f, &mut out);
    let pattern: Vec<[usize; 2]> = K::SPEC.q.iter().map(|&row| [row, 0]).collect();
    scatter([N_DOF * K::SPEC.common.slots.len(), 1], &pattern, &out)
}

pub(super) fn dq_dx<K: Force>(k: &K, x: &[Pose], v: &[Twist], f: &[[f64; 3]]) -> Block {
    let mut out = unwritten(K::SPEC.dq_dx.len());
    k.dq_dx(x, v, f, &mut out);
    let n = N_DOF * K::SPEC.common.slots.len();
    scatter([n, n], K::SPEC.dq_dx, &out)
}

pub(super) fn dq_dv<K: Force>(k: &K, x: &[Pose], v: &[Twist], f: &[[f64; 3]]) -> Block {
    let mut out = unwritten(K::SPEC.dq_dv.len());
    k.dq_dv(x, v, f, &mut out);
    let n = N_DOF * K::SPEC.common.slots.len();
    scatter([n, n], K::SPEC.dq_dv, &out)
}
