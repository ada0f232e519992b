//! Prototype of a condensation by a tree of bodies. The equations are `M·v + Cᵀ·λ = f` and
//! `C·v = γ`. The condensation reduces them to the closing rows of the tree, with a diagonal mass
//! matrix. The two present solvers of saddle equations, the null space and the Schur complement,
//! then solve the reduced equations.
//!
//! | command | output |
//! | --- | --- |
//! | `check [TREE [SCENE …]]` | errors of v̇ and λ, from solutions in double-double on the same rows |
//! | `count [TREE [SCENE …]]` | instructions for each body, by callgrind; requires `--profile profiling` |
//! | `time [TREE [SCENE …]]` | run times for each body (µs) |
//! | `pivots N` | pivots and errors along the motion of N parallelograms through their flat pose |
//! | `motion [TREE [SCENE …]]` | new plans and errors along a motion |
//! | `transport [TREE [SCENE …]]` | rests of closing rows at the common ancestors of their bodies |
//!
//! TREE is `rows` (joints with many rows come first), `floating` (contacts with the ground do not
//! belong to the tree), `ground` (joints with the ground come first), `decided` (the independent
//! rows of the product instead of those of the tree), and for `check` also `violated` (the
//! constraints are violated by 1e-3).
//!
//! # Equations
//!
//! M is diagonal, with the rows g of armatures: `M = diag(m) + Σ a·gᵀ·g`. Body i has the parent p.
//! The rows between both are the joint `C_i·v_i + C_p·v_p = γ`. All other rows are closing rows; an
//! armature is a closing row with the compliance `H₀ = 1/a` and γ = 0. P are m columns of C_i that
//! complete pivoting has chosen, and F are the other columns.
//!
//! - Joint: `v_i = X·v_p + S·z + d`, where z is `v_F`, and X has only rows P.
//! - From the last bodies to the ground, A is the inertia, W are the open closing rows, and f is
//!   the force: `U = A·S`, `D = Sᵀ·U = L·Δ·Lᵀ`, `g = Sᵀ·W`, `φ = Sᵀ·(f − A·d)`. The parent receives
//!   `Xᵀ·(A − U·D⁻¹·Uᵀ)·X`, `Xᵀ·(W − U·D⁻¹·g)` and `Xᵀ·(f − A·d − U·D⁻¹·φ)`, and γ of the closing
//!   rows decreases by `Wᵀ·d`.
//! - Reduced equations: `x = Lᵀ·(z + D⁻¹·Uᵀ·X·v_p)`, `Δ·x + G̃ᵀ·μ = L⁻¹·φ`, `G̃·x − H₀·μ = γ`. A
//!   row of G̃ contains `L⁻¹·g` of all joints between its bodies and the ground. Armatures are rows
//!   of the reduced mass matrix; their γ adds `a·g̃·γ` to the force.
//! - Blocks: closing rows that share joints form a block, whose base is the common ancestor of its
//!   bodies. A small block is eliminated at its base: `H = H₀ + Σ g̃ᵀ·Δ⁻¹·g̃`, the inertia of the
//!   base increases by `W·H⁻¹·Wᵀ`, and its force by `W·H⁻¹·γ`. The other rows remain open up to the
//!   ground and are rows of the reduced equations.
//! - λ of joints, from the last bodies to the ground: `C_Pᵀ·λ_i` is the rest of the forces of body
//!   i in the columns P.
//!
//! Source: R. Featherstone, The calculation of robot dynamics using articulated-body inertias, Int.
//! J. Robotics Research 2 (1983) 13–30, for the condensation; A. Jain, G. Rodriguez, Diagonalized
//! Lagrangian robot dynamics, IEEE Trans. Robotics and Automation 11 (1995) 571–584, for x.
//!
//! # Measurements
//!
//! Instructions for each body of one factorisation and one motion v̇, without λ. The columns are
//! the null space and the Schur complement of all rows, the tree with all closing rows in the
//! reduced equations, and the tree with blocks. The better of the two solvers of the reduced
//! equations is listed. Where blocks leave rows over, this was the null space in all scenes. k is
//! the number of free motions. The product uses the Schur complement from 64 rows and 17 free
//! motions on.
//!
//! | mechanism | k | null space | Schur | tree | with blocks |
//! | --- | --- | --- | --- | --- | --- |
//! | floating base, 4 arms of 6 joints, armatures | 30 | 19 988 | 10 957 | 8028 | 3966 |
//! | the same without armatures | 30 | 18 344 | 9240 | 2913 | 2913 |
//! | the same with loops in two arms, armatures | 28 | 18 791 | 14 381 | 7967 | 4108 |
//! | with loops, without armatures | 28 | 17 335 | 9376 | 3627 | 3134 |
//! | row of 1, 16, 64 parallelograms | 1 | 4322, 4499, 4506 | 7584 to 11 597 | 3267, 3746, 3774 | 2625, 3746, 3774 |
//! | tower of 4 four-bars | 4 | 7871 | 13 217 | 4601 | 3543 |
//! | tower of 16, 64, 256 | 16, 64, 256 | 26 362 to 1.2e6 | 13 974, 14 185, 14 228 | 8429, 30 728, 237 617 | 4065, 4127, 4153 |
//! | spherical chain of 16, 64, 256 | 48, 192, 768 | 40 938 to 6.3e6 | 5082, 5163, 5241 | 1956, 2154, 2161 | 1956, 2154, 2161 |
//! | top, rolling disk | 3 | 4953, 5372 | 4069, 4165 | 1439, 1513 | 1439, 1513 |
//! | robot in space, hexapod | 1, 0 | 5629, 5869 | 14 074, 11 559 | 5496, 5278 | 5497, 5278 |
//! | 6-UPS, Delta | 6, 3 | 10 397, 8680 | 8781, 12 591 | 6257, 5372 | 6256, 5372 |
//! | Bennett, Bricard | 1 | 4861, 4903 | 9825, 10 440 | 3347, 4044 | 2705, 3515 |
//! | 1, 4, 16 cars with wheels | 1 | 5072, 5115, 5140 | 11 975 to 15 198 | 4705, 4919, 5282 | 4075, 4919, 5281 |
//! | plane: robot, 16 robots | 1, 16 | 2123, 2540 | 3999, 3892 | 2032, 2100 | 1602, 1678 |
//! | plane: 4, 16, 64 cells on couplers | 4, 16, 64 | 2964, 6678, 45 399 | 4027, 4119, 5470 | 2308, 5326, 28 843 | 1318, 1363, 1469 |
//! | plane: 16, 64 four-bars in a row | 1 | 1835, 1827 | 3430, 3500 | 1698, 1765 | 1698, 1765 |
//! | plane: lattice 2, 4, 6, 9 | 1, 2, 3, 6 | 2310, 3296, 3830, 5045 | 6798 to 8809 | 2565, 3730, 4802, 6702 | 2878, 3730, 4802, 6701 |
//! | plane: 4, 16, 64 carriages on knife edges | 2 | 2672, 2770, 2794 | 3626 to 3983 | 2192, 3290, 8092 | 1285, 3290, 8092 |
//!
//! λ takes 340 to 752 more instructions for a body in mechanisms in space, and 451 to 1178 in the
//! present null space.
//!
//! Run times for each body, of the null space, the Schur complement, the tree and the tree with
//! blocks (µs): arms with armatures 0.82, 0.54, 0.40, 0.19; with loops 0.76, 0.72, 0.39, 0.20;
//! tower of 16 1.09, 0.66, 0.41, 0.19; 6-UPS 0.46, 0.43, 0.34, 0.34; Delta 0.37, 0.62, 0.28, 0.27;
//! row of 16 0.20, 0.56, 0.19, 0.19; lattice 4 0.15, 0.38, 0.17, 0.17; 4 cars 0.22, 0.71, 0.26,
//! 0.26; robot in space 0.24, 0.66, 0.30, 0.30.
//!
//! # Results
//!
//! 1. Apart from masses that grow by 1e12, errors of v̇ are at most 1e-13 in the null space of the
//!    tree (tower of 64) and 2e-14 with blocks, and those of λ 1e-13. The present null space has
//!    1e-13 in this tower, and 4e-12 in a spherical chain of 64, in which the tree has 4e-15. If
//!    constraints are violated by 1e-3, the errors are at most 1e-13, and 3e-13 for λ: the given
//!    rows are solved, and nothing is transported to a common point.
//! 2. The choice between `v_F` and the rigid motion as the origin of z has no effect. With
//!    `X' = X + S·K` all transported terms are the same, since `Sᵀ·(A − U·D⁻¹·Uᵀ) = 0` (measured:
//!    9e-16 of A) and `Sᵀ·(W − U·D⁻¹·g) = 0`, and x is the same, too. Therefore X is used, which
//!    has m rows. A closing row does not vanish at the common ancestor for any choice; there it has
//!    up to 5.2 times its own entries in the arms, and 2.5 times in a tower of four four-bars.
//! 3. Therefore rows that are open up to the ground make towers quadratic or worse, and each
//!    armature of an arm meets all joints below it. Blocks remove both. With blocks, the solver of
//!    the reduced equations matters only for blocks of many rows on the ground.
//! 4. Blocks of more than 12 rows on the ground are better in the reduced equations. With dense H:
//!    6-UPS 5284 instead of 6256, but hexapod 5677 instead of 5278, row of 16 5908 instead of 3746,
//!    lattice 4 8832 instead of 3730.
//! 5. The choice of independent rows must prefer the rows of joints of the tree. With the present
//!    choice, a row of 16 takes 6170 instead of 3746, Delta 7002 instead of 5372, and a tower of 16
//!    5415 instead of 4065.
//! 6. At a flat pose, a whole row of G̃ vanishes. Relative to itself, its pivot stays at 1.0 for
//!    one and four parallelograms, and at 0.2 for 16, where the present pivots are proportional to
//!    sin θ. The smallest singular value of `G̃·Δ^(−1/2)`, relative to rows of C in the metric of
//!    the masses, is also proportional to sin θ, from θ = 1e-2 to 1e-12 within 2 % on each side.
//!    Errors of v̇ at θ = 1e-5: one parallelogram 5e-16 (null space) and 1e-15 (blocks), present
//!    1e-16; four 4e-16 and 5e-12, present 4e-12; sixteen 2e-10, present 1e-10.
//! 7. Pivots of joints change seldom. In 1600 evaluations of a free motion of 0.8 s the arms need 9
//!    new plans (39 without armatures, 10 and 43 with loops), the robot in space 6, a random planar
//!    mechanism 3, 6-UPS 1, and the other scenes none.
//! 8. Along these motions, blocks and pivots that are not new lose digits, and one correction with
//!    the residuals of all equations in double precision gives them back. The largest errors of v̇
//!    are for blocks, corrected blocks and the present null space: arms 3e-13, 8e-16, 1e-13; arms
//!    with loops 1e-13, 4e-16, 4e-14; tower of 64 6e-13, 9e-15, 4e-13; lattice 2 2e-11, 5e-14,
//!    2e-13; random 7e-12, 6e-15, 2e-14. With 8000 steps of 1e-4 s, more of which are near a
//!    singular pose: lattice 2 9e-7, 4e-12, 7e-12; random 6e-9, 1e-13, 3e-13; tower of 16 9e-12,
//!    6e-15, 1e-13. λ and a correction, as written here, take 3995 more instructions for each body
//!    of the arms, 4113 of the tower of 16, and 2130 of lattice 2.
//!
//! # What is worse
//!
//! - Lattices and long trains, which have few free motions: the null space is better. A wheel or a
//!   knife edge whose parent is not the ground has a path through all bodies up to the ground. If
//!   such bodies are joined to the ground (`ground`), 64 carriages take 3004 instead of 8092
//!   instructions, but the null space takes 2794. 16 cars then take 6032 instead of 5281. With a
//!   floating root (`floating`) they take 10 954, and 64 carriages 8180.
//! - Mechanisms with one free motion save at most 25 % of the instructions, except for single
//!   loops, which save 28 to 44 %. Cars, the robot in space and lattices take 15 to 25 % more time.
//! - Masses that grow by 1e12 towards the tip of a spherical chain: the error of v̇ is 3e-4, and
//!   one correction in double precision gives 7e-9, two give 2e-13. The present solvers have 1e-15
//!   and 3e-15. Masses that decrease towards the tip cause no error.
//! - Zero masses: D of such a body is zero, if no other body gives it an inertia.
//! - Blocks have the square of the condition number: 1e-14 instead of 1e-16 in the most rigid
//!   loops, and 9e-7 instead of 4e-12 near a singular pose, without a correction.
//! - Chains whose masses differ by 1e12 do not reach the end of `motion`. Whether the steps or the
//!   errors of v̇ are too large was not examined.
//! - Rows that are dependent for an instant are not skipped, there is no basis of the free motions,
//!   and no orientation.
//!
//! # Order of a port into `dynamics/src/solve/solver.rs`
//!
//! 1. `linalg`: the condensation without its solver, with const generics for planes and space, and
//!    a plan from kept rows, groups of columns and parents. Only one joint has to be planned again.
//! 2. `prepare`: independent rows that prefer the joints of a tree.
//! 3. `solver.rs`: an additional solver, used by stages of explicit methods for motions
//!    and multipliers of all rows. It requires positive masses that are not graded, all rows in use
//!    at the last accepted step, and k ≥ 3 or armatures or only blocks. The null space, or the
//!    Schur complement, is factored at the ends of steps: for pivots, skipped rows, orientation,
//!    independent coordinates, and refinement. Near a singular pose it also computes the stages, or
//!    solutions are corrected once if a pivot of H is small.
//! 4. One reduced system for each block on the ground, so that the number of free motions of a
//!    block decides between the null space and the Schur complement.
//! 5. Kernels that write the rows of a joint as dense blocks: at least 290 of the 2130 instructions
//!    of a revolute joint copy entries. A special case for a block of one armature, which takes
//!    1100 instructions.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::collections::HashMap;
use std::error::Error;
use std::iter::successors;
use std::ops::Range;
use std::process::{Command, ExitCode};
use std::time::Instant;

use dynamics::PreparedMechanism;
use lab::fuzz::space::text::Precision;
use lab::fuzz::space::{Drawing, catalogue, description};
use lab::mechanisms::robot::{robot, steering};
use lab::mechanisms::space::{RollingDisk, bennett, bricard, top};
use lab::stress::motion;
use linalg::kernels::max_abs;
use linalg::{
    AddedMass, DisjointSets, KeptRowSaddle, MassMatrix, Refinement, SchurSaddle, SchurStructure,
    SparseMatrix, mass_spread,
};
use model::{BodyRef, BodySpace, Mechanism, MechanismDescription, Registry, Scratch, System};
use nalgebra::DMatrix;
use pfaff::{RunOptions, Study};
use suite::generate::{Kind as Family, Order};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// The parent of bodies that are joined to the ground.
const GROUND: usize = usize::MAX;
/// No place in an arena.
const NONE: usize = usize::MAX;
/// Largest entry of S in units of the body. A larger entry requires other pivots of the joint.
const LARGEST: f64 = 20.0;
/// Smallest pivot of a joint of the tree, relative to the largest entry of its row of C.
const JOINED: f64 = 0.05;
/// Closing rows whose pivots are at most this part of the row are redundant.
const INDEPENDENT: f64 = 1e-7;
/// Pivots within this factor are equal, so that rounding does not choose between them.
const TIE: f64 = 1.0 + 1e-9;
/// Largest number of closing rows that are eliminated at the ground, and at a body. At a body more
/// rows are worth it, because they would otherwise be open up to the ground.
const LOCAL: [usize; 2] = [12, 16];

/// Chooses rows and columns by complete pivoting, until the pivots are at most `least`. Returns the
/// rows in the order of elimination, and all columns, pivots first.
fn complete_pivoting(mut a: DMatrix<f64>, least: f64) -> [Vec<usize>; 2] {
    let (m, n) = a.shape();
    let (mut rows, mut column) = (Vec::from_iter(0..m), Vec::from_iter(0..n));
    for k in 0..=m.min(n) {
        let mut best = (least, 0, 0);
        for i in k..m {
            for j in k..n {
                if a[(i, j)].abs() > best.0 * TIE {
                    best = (a[(i, j)].abs(), i, j);
                }
            }
        }
        let (size, i, j) = best;
        if size <= least {
            rows.truncate(k);
            break;
        }
        rows.swap(k, i);
        a.swap_rows(k, i);
        column.swap(k, j);
        a.swap_columns(k, j);
        for i in k + 1..m {
            let l = a[(i, k)] / a[(k, k)];
            if l != 0.0 {
                (k..n).for_each(|j| a[(i, j)] -= l * a[(k, j)]);
            }
        }
    }
    [rows, column]
}

// The tree.

/// Which joints with the ground belong to the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Style {
    /// All joints; joints with many rows come first.
    ManyRows,
    /// Only joints with more rows than a contact has.
    Floating,
    /// All joints; joints with the ground come first.
    OnGround,
    /// The tree of `ManyRows` with the independent rows that the product has chosen.
    Decided,
}

/// A body with the rows of the joint to its parent.
#[derive(Clone, Debug)]
struct TreeNode {
    body: usize,
    parent: usize,
    depth: usize,
    rows: Vec<usize>,
}

/// A row that does not belong to a joint of the tree, with the nodes of its bodies.
#[derive(Clone, Debug)]
struct ClosingRow {
    source: Source,
    ends: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
enum Source {
    /// A row of C.
    Row(usize),
    /// A row of the mass matrix.
    Armature(usize),
}

/// The nodes, parents first, and the closing rows.
#[derive(Clone, Debug)]
struct Tree {
    nodes: Vec<TreeNode>,
    closing: Vec<ClosingRow>,
}

/// Reciprocal units of the columns of all bodies, for the choice of pivots.
fn units(m: &Mechanism, size: f64) -> Vec<f64> {
    let n = m.space().n_v();
    let mut units = vec![1.0; m.layout().n_v];
    for (body, units) in units.chunks_exact_mut(n).enumerate() {
        let reach = Some(m.reach(body)).filter(|reach| m.is_length(body, *reach));
        let length = reach.map_or(size, |reach| reach.min(size));
        units[m.space().torques()].fill((-length.log2().round()).exp2());
    }
    units
}

/// Returns the rows of C in the columns of a body, in its units, divided by their largest entries.
fn rows_of(m: &Mechanism, s: &Scratch, units: &[f64], body: usize, rows: &[usize]) -> DMatrix<f64> {
    let columns = m.layout().columns(body);
    let mut a = DMatrix::<f64>::zeros(rows.len(), columns.len());
    for (k, &i) in rows.iter().enumerate() {
        for (column, c) in m.layout().row(s, i) {
            if columns.contains(&column) {
                a[(k, column - columns.start)] += c * units[column];
            }
        }
        let largest = a.row(k).amax().max(f64::MIN_POSITIVE);
        a.row_mut(k).scale_mut(largest.recip());
    }
    a
}

/// Returns the tree, with all rows that do not belong to it as closing rows.
fn spanning_tree(m: &Mechanism, s: &Scratch, units: &[f64], style: Style) -> Tree {
    let groups = &m.layout().groups;
    let count = m.bodies().len();
    let contact = m.space().n_v() / 2;
    // Rows between each pair of bodies.
    let mut pairs: Vec<([BodyRef; 2], Vec<usize>)> = Vec::new();
    for group in groups {
        let [a, b] = match group.bodies[..] {
            [a, b] => [a, b],
            [b] => [BodyRef::Ground, b],
            _ => continue,
        };
        let same = |pair: &[BodyRef; 2]| *pair == [a, b] || *pair == [b, a];
        match pairs.iter_mut().find(|(pair, _)| same(pair)) {
            Some((_, rows)) => rows.extend(group.rows.iter()),
            None => pairs.push(([a, b], group.rows.iter().collect())),
        }
    }
    let joined = |body: usize, rows: &[usize]| -> Vec<usize> {
        let [order, _] = complete_pivoting(rows_of(m, s, units, body, rows), JOINED);
        order.iter().map(|&k| rows[k]).collect()
    };
    let (mut nodes, mut node_of) = (Vec::<TreeNode>::new(), vec![NONE; count]);
    while let Some(unreached) = node_of.iter().position(|&x| x == NONE) {
        let of = |x: BodyRef| match x.moving() {
            None => Some(GROUND),
            Some(body) => Some(node_of[body]).filter(|&x| x != NONE),
        };
        let mut best: Option<TreeNode> = None;
        let mut best_key = (0, 0, 0);
        for ([a, b], rows) in &pairs {
            let (parent, outer) = match (of(*a), of(*b)) {
                (Some(parent), None) => (parent, *b),
                (None, Some(parent)) => (parent, *a),
                _ => continue,
            };
            let Some(body) = outer.moving() else { continue };
            let is_ground = parent == GROUND;
            if is_ground && style == Style::Floating && rows.len() <= contact {
                continue;
            }
            let depth = nodes.get(parent).map_or(0, |parent| parent.depth + 1);
            let first = usize::from(style == Style::OnGround && is_ground);
            let most = rows.len().min(m.space().n_v());
            if best.is_some() && (first, most, usize::MAX - depth) <= best_key {
                continue;
            }
            let rows = joined(body, rows);
            let key = (first, rows.len(), usize::MAX - depth);
            if !rows.is_empty() && (best.is_none() || key > best_key) {
                best_key = key;
                best = Some(TreeNode {
                    body,
                    parent,
                    depth,
                    rows,
                });
            }
        }
        let node = best.unwrap_or(TreeNode {
            body: unreached,
            parent: GROUND,
            depth: 0,
            rows: Vec::new(),
        });
        node_of[node.body] = nodes.len();
        nodes.push(node);
    }
    let mut in_tree = vec![false; m.layout().rows()];
    for node in &nodes {
        node.rows.iter().for_each(|&i| in_tree[i] = true);
    }
    let end = |x: &BodyRef| x.moving().map_or(GROUND, |body| node_of[body]);
    let mut closing = Vec::new();
    for group in groups {
        let mut ends: Vec<usize> = group.bodies.iter().map(end).collect();
        if ends.len() == 1 {
            ends.push(GROUND);
        }
        for row in group.rows.iter().filter(|&i| !in_tree[i]) {
            let (source, ends) = (Source::Row(row), ends.clone());
            closing.push(ClosingRow { source, ends });
        }
    }
    for (k, armature) in m.armatures().enumerate() {
        let mut ends: Vec<usize> = armature.bodies.iter().map(end).collect();
        if ends.len() == 1 {
            ends.push(GROUND);
        }
        let source = Source::Armature(k);
        closing.push(ClosingRow { source, ends });
    }
    Tree { nodes, closing }
}

// The condensation.

/// A value of C, and its place in the rows of a joint: row·N + column of the body or of its parent.
#[derive(Clone, Copy)]
struct Entry {
    value: u32,
    place: u32,
}

/// A value of a closing row: its index, its slot, its node, its column in the order of the node.
#[derive(Clone, Copy)]
struct ClosingEntry {
    value: u32,
    slot: u32,
    link: u32,
    node: u32,
    column: u8,
}

/// How the unknowns of a joint are eliminated.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// No closing row passes through the joint.
    Alone,
    /// With the closing rows of a block, at its base.
    Block(usize),
    /// By the solver of the reduced equations.
    Reduced,
}

/// A body with its joint. Columns are in the order of the node: the m pivots, then the others.
#[derive(Clone)]
struct Node<const N: usize> {
    body: usize,
    parent: usize,
    m: usize,
    way: Way,
    column: [usize; N],
    rows: [usize; N],
    entries: Range<usize>,
    /// Number of entries in the columns of the body. They precede those of the parent.
    of_body: usize,
    slots: Range<usize>,
    mounted: Range<usize>,
    /// First of the unknowns in the reduced equations.
    first: usize,
    /// Units of the columns.
    units: [f64; N],
    mass: [f64; N],
    /// LU factors of C_P and, behind them, T = C_P⁻¹·C_F.
    c: [[f64; N]; N],
    /// Rows P of X.
    x: [[f64; N]; N],
    /// Articulated inertia.
    a: [[f64; N]; N],
    /// Rows P of U·L⁻ᵀ, transposed.
    v: [[f64; N]; N],
    l: [[f64; N]; N],
    delta: [f64; N],
    inverse: [f64; N],
    f: [f64; N],
    d: [f64; N],
    phi: [f64; N],
    motion: [f64; N],
}

/// An open closing row at a body.
#[derive(Clone)]
struct Slot<const N: usize> {
    w: [f64; N],
    g: [f64; N],
    up: usize,
    link: usize,
    /// Place in the block, or in the values of the reduced rows.
    place: usize,
}

/// Closing rows that are eliminated at one body.
#[derive(Clone)]
struct Block {
    base: usize,
    links: Range<usize>,
    /// Slots at the base. There is no slot if the base is the ground.
    slots: Range<usize>,
    /// First entry of H.
    first: usize,
}

#[derive(Clone, Copy)]
struct Link {
    source: Source,
    /// 1/a of an armature; 0 for a row of C.
    compliance: f64,
    /// Row of the reduced equations, or row of their mass matrix.
    reduced: usize,
}

/// The solver of the reduced equations.
enum Reduced {
    Nothing,
    NullSpace(Box<KeptRowSaddle>),
    Schur(Box<SchurSaddle>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Treatment {
    /// All closing rows in the null space.
    NullSpace,
    /// All closing rows through the Schur complement.
    Schur,
    /// Closing rows of small blocks at their bases, and the others in the null space.
    Early,
    /// The same, and the others through the Schur complement.
    EarlySchur,
}

struct Condensation<const N: usize> {
    nodes: Vec<Node<N>>,
    slots: Vec<Slot<N>>,
    blocks: Vec<Block>,
    links: Vec<Link>,
    entries: Vec<Entry>,
    closing: Vec<ClosingEntry>,
    /// Values of C, then values of the rows of the mass matrix.
    values: Vec<f64>,
    /// H of the blocks and its factors.
    h: Vec<f64>,
    /// Right-hand sides and multipliers of the links.
    gamma: Vec<f64>,
    mu: Vec<f64>,
    mass: Vec<f64>,
    rows: SparseMatrix,
    added: AddedMass,
    reduced: Reduced,
    r_f: Vec<f64>,
    r_x: Vec<f64>,
    r_gamma: Vec<f64>,
    r_mu: Vec<f64>,
}

/// Returns the nodes from a node up to another node, which is excluded.
fn path(nodes: &[TreeNode], from: usize, to: usize) -> Vec<usize> {
    let above = |&x: &usize| (x != GROUND).then(|| nodes[x].parent);
    let path = successors(Some(from), above);
    path.take_while(|&x| x != to && x != GROUND).collect()
}

/// Calls a function for the number of pivots of a node.
macro_rules! by_pivots {
    ($n:ident, $m:expr, $f:ident $args:tt) => {
        match ($n, $m) {
            (6, 0) => $f::<$n, 0, 6> $args,
            (6, 1) => $f::<$n, 1, 5> $args,
            (6, 2) => $f::<$n, 2, 4> $args,
            (6, 3) => $f::<$n, 3, 3> $args,
            (6, 4) => $f::<$n, 4, 2> $args,
            (6, 5) => $f::<$n, 5, 1> $args,
            (6, 6) => $f::<$n, 6, 0> $args,
            (3, 0) => $f::<$n, 0, 3> $args,
            (3, 1) => $f::<$n, 1, 2> $args,
            (3, 2) => $f::<$n, 2, 1> $args,
            (3, 3) => $f::<$n, 3, 0> $args,
            _ => unreachable!("a body has three or six velocities"),
        }
    };
}

/// Factors the rows of a joint, and adds the condensed inertia to the parent. Returns whether the
/// pivots are good.
#[inline(never)]
fn factor_joint<const N: usize, const M: usize, const F: usize>(
    node: &mut Node<N>,
    parent: Option<&mut Node<N>>,
    entries: &[Entry],
    values: &[f64],
) -> bool {
    let mut c = [[0.0; N]; M];
    let mut x = [[0.0; N]; M];
    let has_parent = parent.is_some();
    let (of_body, of_parent) = entries.split_at(node.of_body);
    for e in of_body {
        c.as_flattened_mut()[e.place as usize] = values[e.value as usize];
    }
    for e in of_parent {
        x.as_flattened_mut()[e.place as usize] = -values[e.value as usize];
    }
    let mut inverse = [0.0; M];
    for k in 0..M {
        inverse[k] = 1.0 / c[k][k];
        for j in k + 1..M {
            let l = c[j][k] * inverse[k];
            if l != 0.0 {
                c[j][k] = l;
                for i in k + 1..N {
                    c[j][i] -= l * c[k][i];
                }
                if has_parent {
                    for i in 0..N {
                        x[j][i] -= l * x[k][i];
                    }
                }
            }
        }
    }
    let mut largest = 0.0_f64;
    for k in (0..M).rev() {
        for j in k + 1..M {
            let u = c[k][j];
            if u != 0.0 {
                for i in M..N {
                    c[k][i] -= u * c[j][i];
                }
                if has_parent {
                    for i in 0..N {
                        x[k][i] -= u * x[j][i];
                    }
                }
            }
        }
        for i in M..N {
            c[k][i] *= inverse[k];
            largest = largest.max((c[k][i] * node.units[i]).abs() / node.units[k]);
        }
        if has_parent {
            for i in 0..N {
                x[k][i] *= inverse[k];
            }
        }
    }
    // Uᵀ, one row for each free motion.
    let mut a = [[0.0; M]; M];
    for p in 0..M {
        a[p].copy_from_slice(&node.a[p][..M]);
    }
    let mut u = [[0.0; M]; F];
    for f in 0..F {
        u[f].copy_from_slice(&node.a[M + f][..M]);
        for q in 0..M {
            let t = c[q][M + f];
            for p in 0..M {
                u[f][p] -= a[q][p] * t;
            }
        }
    }
    let mut d = [[0.0; F]; F];
    for f in 0..F {
        for h in 0..=f {
            let mut sum = node.a[M + f][M + h];
            for p in 0..M {
                sum -= node.a[M + f][p] * c[p][M + h] + c[p][M + f] * u[h][p];
            }
            d[f][h] = sum;
        }
    }
    let mut is_positive = true;
    for k in 0..F {
        is_positive &= d[k][k] > 0.0;
        let inverse = 1.0 / d[k][k];
        node.delta[k] = d[k][k];
        node.inverse[k] = inverse;
        for j in k + 1..F {
            let l = d[j][k] * inverse;
            for i in k + 1..=j {
                d[j][i] -= l * d[i][k];
            }
        }
        for j in k + 1..F {
            d[j][k] *= inverse;
            node.l[j][k] = d[j][k];
        }
    }
    // Vᵀ = L⁻¹·Uᵀ.
    for f in 0..F {
        for h in 0..f {
            for p in 0..M {
                u[f][p] -= d[f][h] * u[h][p];
            }
        }
    }
    if let Some(parent) = parent {
        for f in 0..F {
            for p in 0..M {
                let by = u[f][p] * node.inverse[f];
                for q in 0..M {
                    a[p][q] -= by * u[f][q];
                }
            }
        }
        let mut y = [[0.0; N]; M];
        for p in 0..M {
            for q in 0..M {
                let a = a[p][q];
                for i in 0..N {
                    y[p][i] += a * x[q][i];
                }
            }
        }
        for i in 0..N {
            let mut sum = parent.a[i];
            for p in 0..M {
                let x = x[p][i];
                for j in 0..N {
                    sum[j] += x * y[p][j];
                }
            }
            parent.a[i] = sum;
        }
        node.x[..M].copy_from_slice(&x);
    }
    node.c[..M].copy_from_slice(&c);
    for f in 0..F {
        node.v[f][..M].copy_from_slice(&u[f]);
    }
    is_positive && largest <= LARGEST
}

/// Computes g of a slot, and adds its condensed row to the slot of the parent.
fn factor_slot<const N: usize, const M: usize, const F: usize>(
    node: &Node<N>,
    slot: &mut Slot<N>,
    up: Option<&mut Slot<N>>,
) {
    let mut g = [0.0; F];
    for f in 0..F {
        let mut sum = slot.w[M + f];
        for p in 0..M {
            sum -= node.c[p][M + f] * slot.w[p];
        }
        for h in 0..f {
            sum -= node.l[f][h] * g[h];
        }
        g[f] = sum;
    }
    slot.g[..F].copy_from_slice(&g);
    let Some(up) = up else { return };
    for f in 0..F {
        g[f] *= node.inverse[f];
    }
    for p in 0..M {
        let mut left = slot.w[p];
        for f in 0..F {
            left -= node.v[f][p] * g[f];
        }
        for i in 0..N {
            up.w[i] += node.x[p][i] * left;
        }
    }
}

/// Computes d and φ of a joint, and adds the condensed force to the parent.
fn inward_joint<const N: usize, const M: usize, const F: usize>(
    node: &mut Node<N>,
    parent: Option<&mut Node<N>>,
    gamma: &[f64],
) {
    let mut d = [0.0; M];
    for k in 0..M {
        d[k] = gamma[node.rows[k]];
        for j in 0..k {
            d[k] -= node.c[k][j] * d[j];
        }
    }
    for k in (0..M).rev() {
        for j in k + 1..M {
            d[k] -= node.c[k][j] * d[j];
        }
        d[k] /= node.c[k][k];
    }
    let mut r = node.f;
    for p in 0..M {
        for q in 0..M {
            r[p] -= node.a[q][p] * d[q];
        }
    }
    let mut phi = [0.0; F];
    for f in 0..F {
        let mut sum = r[M + f];
        for p in 0..M {
            sum -= node.a[M + f][p] * d[p] + node.c[p][M + f] * r[p];
        }
        for h in 0..f {
            sum -= node.l[f][h] * phi[h];
        }
        phi[f] = sum;
    }
    node.d[..M].copy_from_slice(&d);
    node.phi[..F].copy_from_slice(&phi);
    let Some(parent) = parent else { return };
    for p in 0..M {
        let mut left = r[p];
        for f in 0..F {
            left -= node.v[f][p] * (node.inverse[f] * phi[f]);
        }
        for i in 0..N {
            parent.f[i] += node.x[p][i] * left;
        }
    }
}

/// Computes the motion of a body from x, which is in `phi`, and from the motion of the parent.
fn outward_joint<const N: usize, const M: usize, const F: usize>(
    node: &mut Node<N>,
    parent: Option<&Node<N>>,
) {
    let mut on_parent = [0.0; M];
    if let Some(parent) = parent {
        for p in 0..M {
            for i in 0..N {
                on_parent[p] += node.x[p][i] * parent.motion[i];
            }
        }
    }
    let mut z = [0.0; F];
    for f in (0..F).rev() {
        let mut sum = 0.0;
        for p in 0..M {
            sum += node.v[f][p] * on_parent[p];
        }
        z[f] = node.phi[f] - node.inverse[f] * sum;
        for h in f + 1..F {
            z[f] -= node.l[h][f] * z[h];
        }
    }
    for p in 0..M {
        let mut sum = on_parent[p] + node.d[p];
        for f in 0..F {
            sum -= node.c[p][M + f] * z[f];
        }
        node.motion[p] = sum;
    }
    node.motion[M..].copy_from_slice(&z);
}

/// Computes λ of a joint from the rest of the forces of the body, and adds the reaction to the
/// parent.
fn reaction<const N: usize, const M: usize, const FREE: usize>(
    node: &mut Node<N>,
    parent: Option<&mut Node<N>>,
    entries: &[Entry],
    values: &[f64],
    lambda: &mut [f64],
) {
    let mut y = [0.0; M];
    for k in 0..M {
        let mut sum = node.f[k];
        for j in 0..k {
            sum -= node.c[j][k] * y[j];
        }
        y[k] = sum / node.c[k][k];
    }
    for k in (0..M).rev() {
        for j in k + 1..M {
            y[k] -= node.c[j][k] * y[j];
        }
        lambda[node.rows[k]] = y[k];
    }
    let Some(parent) = parent else { return };
    for e in &entries[node.of_body..] {
        let place = e.place as usize;
        parent.f[place % N] -= values[e.value as usize] * y[place / N];
    }
}

/// Returns a node and its parent.
fn with_parent<const N: usize>(
    nodes: &mut [Node<N>],
    i: usize,
) -> (&mut Node<N>, Option<&mut Node<N>>) {
    let (before, after) = nodes.split_at_mut(i);
    let node = &mut after[0];
    let parent = before.get_mut(node.parent);
    (node, parent)
}

/// Factors a symmetric matrix of order r as L·D·Lᵀ; the diagonal becomes 1/D. Returns the smallest
/// ratio of a pivot to its diagonal entry.
fn factor_block(h: &mut [f64], r: usize) -> f64 {
    let mut smallest = f64::INFINITY;
    for k in 0..r {
        for j in 0..k {
            let mut sum = h[k * r + j];
            for i in 0..j {
                sum -= h[k * r + i] * h[j * r + i];
            }
            h[k * r + j] = sum;
        }
        let before = h[k * r + k];
        let mut pivot = before;
        for j in 0..k {
            let l = h[k * r + j] * h[j * r + j];
            pivot -= l * h[k * r + j];
            h[k * r + j] = l;
        }
        smallest = smallest.min(pivot / before);
        h[k * r + k] = 1.0 / pivot;
    }
    smallest
}

/// Solves with the factors of [`factor_block`], first half: `x ← L⁻¹·x`.
fn half_solve(h: &[f64], r: usize, x: &mut [f64]) {
    for k in 0..r {
        for j in 0..k {
            x[k] -= h[k * r + j] * x[j];
        }
    }
}

/// Second half: `x ← L⁻ᵀ·D⁻¹·x`.
fn other_half(h: &[f64], r: usize, x: &mut [f64]) {
    for k in (0..r).rev() {
        x[k] *= h[k * r + k];
        for j in k + 1..r {
            x[k] -= h[j * r + k] * x[j];
        }
    }
}

impl<const N: usize> Condensation<N> {
    /// Plans the condensation for a tree whose rows are rows of `c`, and chooses pivots for these
    /// values.
    fn new(
        tree: &Tree,
        c: &SparseMatrix,
        mass: MassMatrix<'_>,
        units: &[f64],
        way: Treatment,
    ) -> Outcome<Self> {
        let count = tree.nodes.len();
        let mut node_of = vec![NONE; count];
        (0..count).for_each(|i| node_of[tree.nodes[i].body] = i);
        let (blocks_of, ways, order) = partition(tree, way);

        // Pivots.
        let mut nodes: Vec<Node<N>> = Vec::with_capacity(count);
        let mut local = vec![[0_usize; N]; count];
        let mut n_reduced = 0;
        for (i, of) in tree.nodes.iter().enumerate() {
            let first = of.body * N;
            let mut rows = DMatrix::<f64>::zeros(of.rows.len(), N);
            for (k, &row) in of.rows.iter().enumerate() {
                for (column, value) in c.entries(row) {
                    if column / N == of.body {
                        rows[(k, column - first)] = value * units[column];
                    }
                }
                let largest: f64 = rows.row(k).amax().max(f64::MIN_POSITIVE);
                rows.row_mut(k).scale_mut(largest.recip());
            }
            let [in_order, column] = complete_pivoting(rows, 0.0);
            if in_order.len() < of.rows.len() {
                return Err(format!("the joint of body {} is singular", of.body).into());
            }
            let m = in_order.len();
            let mut node = Node {
                body: of.body,
                parent: of.parent,
                m,
                way: ways[i],
                column: [0; N],
                rows: [0; N],
                entries: 0..0,
                of_body: 0,
                slots: 0..0,
                mounted: 0..0,
                first: n_reduced,
                units: [0.0; N],
                mass: [0.0; N],
                c: [[0.0; N]; N],
                x: [[0.0; N]; N],
                a: [[0.0; N]; N],
                v: [[0.0; N]; N],
                l: [[0.0; N]; N],
                delta: [0.0; N],
                inverse: [0.0; N],
                f: [0.0; N],
                d: [0.0; N],
                phi: [0.0; N],
                motion: [0.0; N],
            };
            for k in 0..N {
                node.column[k] = first + column[k];
                node.units[k] = units[first + column[k]];
                local[i][column[k]] = k;
            }
            for k in 0..m {
                node.rows[k] = of.rows[in_order[k]];
            }
            if ways[i] == Way::Reduced {
                n_reduced += N - m;
            }
            nodes.push(node);
        }

        // Entries of joints.
        let mut entries = Vec::new();
        for i in 0..count {
            let start = entries.len();
            let (body, parent) = (nodes[i].body, nodes[i].parent);
            let mut of_parent = Vec::new();
            for k in 0..nodes[i].m {
                let row = nodes[i].rows[k];
                for (at, &column) in c.row(row).0.iter().enumerate() {
                    let value = (c.start(row) + at) as u32;
                    let entry = |local: &[usize; N]| Entry {
                        value,
                        place: (k * N + local[column % N]) as u32,
                    };
                    if column / N == body {
                        entries.push(entry(&local[i]));
                    } else if parent != GROUND && column / N == nodes[parent].body {
                        of_parent.push(entry(&local[parent]));
                    } else {
                        return Err("a row of a joint touches another body".into());
                    }
                }
            }
            nodes[i].of_body = entries.len() - start;
            entries.extend(of_parent);
            nodes[i].entries = start..entries.len();
        }

        // Links, blocks and slots.
        let mut links = Vec::new();
        let mut through: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut block_of = Vec::new();
        let (mut n_rows, mut n_added) = (0, 0);
        for &(closing, block) in &order {
            let row = &tree.closing[closing];
            let top = block.map_or(GROUND, |b: usize| blocks_of[b]);
            let mut touched: Vec<usize> = { row.ends.iter() }
                .flat_map(|&end| path(&tree.nodes, end, top))
                .collect();
            touched.sort_unstable();
            touched.dedup();
            touched.iter().for_each(|&i| through[i].push(links.len()));
            let (compliance, number) = match row.source {
                Source::Row(_) => (0.0, &mut n_rows),
                Source::Armature(k) => (mass.added().row(k).0.recip(), &mut n_added),
            };
            links.push(Link {
                source: row.source,
                compliance,
                reduced: *number,
            });
            *number += usize::from(block.is_none());
            block_of.push(block);
        }
        let mut blocks: Vec<Block> = Vec::new();
        let mut n_h = 0;
        for (b, &base) in blocks_of.iter().enumerate() {
            let first = block_of.iter().position(|x| *x == Some(b)).unwrap_or(0);
            let r = block_of.iter().filter(|x| **x == Some(b)).count();
            blocks.push(Block {
                base,
                links: first..first + r,
                slots: 0..0,
                first: n_h,
            });
            n_h += r * r;
        }
        let mut slots: Vec<Slot<N>> = Vec::new();
        let mut slot_of = HashMap::new();
        let new_slot = |slots: &mut Vec<Slot<N>>, link: usize, up: usize, place: usize| {
            let (w, g) = ([0.0; N], [0.0; N]);
            slots.push(Slot {
                w,
                g,
                up,
                link,
                place,
            });
            slots.len() - 1
        };
        // First unused value of each reduced row.
        let mut row_ends = vec![0; links.len()];
        let mut reduced_columns: Vec<Vec<usize>> = vec![Vec::new(); links.len()];
        for i in 0..count {
            let start = slots.len();
            for &link in &through[i] {
                let up = slot_of.get(&(nodes[i].parent, link)).copied();
                let place = match block_of[link] {
                    Some(b) => link - blocks[b].links.start,
                    None => row_ends[link],
                };
                let free = N - nodes[i].m;
                row_ends[link] += free;
                reduced_columns[link].extend(nodes[i].first..nodes[i].first + free);
                let slot = new_slot(&mut slots, link, up.unwrap_or(NONE), place);
                slot_of.insert((i, link), slot);
            }
            nodes[i].slots = start..slots.len();
            let first = blocks.iter().position(|block| block.base == i);
            let mounted = blocks.iter().filter(|block| block.base == i).count();
            let first = first.unwrap_or(0);
            nodes[i].mounted = first..first + mounted;
            for block in &mut blocks[first..first + mounted] {
                let start = slots.len();
                for link in block.links.clone() {
                    let slot = new_slot(&mut slots, link, NONE, link - block.links.start);
                    slot_of.insert((i, link), slot);
                }
                block.slots = start..slots.len();
            }
        }
        let mut starts = vec![c.nnz()];
        for (_, columns, _) in mass.added().rows() {
            starts.push(starts[starts.len() - 1] + columns.len());
        }
        let mut closing = Vec::new();
        for (index, link) in links.iter().enumerate() {
            let (start, columns) = match link.source {
                Source::Row(row) => (c.start(row), c.row(row).0),
                Source::Armature(k) => (starts[k], mass.added().row(k).1),
            };
            for (at, &column) in columns.iter().enumerate() {
                let node = node_of[column / N];
                let slot = slot_of.get(&(node, index));
                closing.push(ClosingEntry {
                    value: (start + at) as u32,
                    slot: *slot.ok_or("a closing row touches a body that is not on its paths")?
                        as u32,
                    link: index as u32,
                    node: node as u32,
                    column: local[node][column % N] as u8,
                });
            }
        }

        // The reduced equations.
        let mut added = AddedMass::default();
        let mut rows = Vec::new();
        for (index, link) in links.iter().enumerate() {
            let columns = std::mem::take(&mut reduced_columns[index]);
            match (block_of[index], link.source) {
                (Some(_), _) => {}
                (None, Source::Row(_)) => {
                    // Places are relative to the row until here.
                    rows.push((index, columns));
                }
                (None, Source::Armature(_)) => added.push(link.compliance.recip(), &columns),
            }
        }
        let pattern = rows
            .iter()
            .map(|(_, columns)| columns.iter().map(|&j| (j, 0.0)));
        let rows_matrix = SparseMatrix::from_rows(n_reduced, pattern)?;
        for slot in &mut slots {
            if let (None, Source::Row(_)) = (block_of[slot.link], links[slot.link].source) {
                slot.place += rows_matrix.start(links[slot.link].reduced);
            }
        }
        let n_values = starts[starts.len() - 1];
        let n_links = links.len();
        let joint_columns: Vec<Range<usize>> = { nodes.iter() }
            .filter(|node| node.way == Way::Reduced && node.m < N)
            .map(|node| node.first..node.first + N - node.m)
            .collect();
        let reduced = if n_rows + n_added == 0 {
            Reduced::Nothing
        } else if matches!(way, Treatment::NullSpace | Treatment::Early) {
            if n_rows > n_reduced {
                Reduced::Nothing
            } else {
                let columns: Vec<Vec<usize>> = rows.into_iter().map(|(_, c)| c).collect();
                let saddle = KeptRowSaddle::with_columns(n_reduced, &columns)?.graded_by(1.0);
                Reduced::NullSpace(Box::new(saddle))
            }
        } else {
            let structure = SchurStructure::with_added(&rows_matrix, &joint_columns, &added);
            Reduced::Schur(Box::new(SchurSaddle::new(structure)))
        };
        Ok(Self {
            nodes,
            slots,
            blocks,
            links,
            entries,
            closing,
            values: vec![0.0; n_values],
            h: vec![0.0; n_h],
            gamma: vec![0.0; n_links],
            mu: vec![0.0; n_links],
            mass: vec![0.0; n_reduced],
            rows: rows_matrix,
            added,
            reduced,
            r_f: vec![0.0; n_reduced],
            r_x: vec![0.0; n_reduced],
            r_gamma: vec![0.0; n_rows],
            r_mu: vec![0.0; n_rows],
        })
    }

    /// Factors the equations up to the reduced equations. Returns whether the pivots of the joints
    /// are good.
    fn condense(&mut self, c: &SparseMatrix, mass: MassMatrix<'_>) -> bool {
        let (of_c, mut rest) = self.values.split_at_mut(c.nnz());
        of_c.copy_from_slice(c.values());
        for (_, _, values) in mass.added().rows() {
            let (row, after) = rest.split_at_mut(values.len());
            row.copy_from_slice(values);
            rest = after;
        }
        for slot in &mut self.slots {
            slot.w = [0.0; N];
        }
        for e in &self.closing {
            self.slots[e.slot as usize].w[usize::from(e.column)] = self.values[e.value as usize];
        }
        self.h.fill(0.0);
        for block in &self.blocks {
            let r = block.links.len();
            for (k, link) in self.links[block.links.clone()].iter().enumerate() {
                self.h[block.first + k * (r + 1)] = link.compliance;
            }
        }
        for node in &mut self.nodes {
            node.a = [[0.0; N]; N];
            for k in 0..N {
                node.mass[k] = mass.diagonal()[node.column[k]];
                node.a[k][k] = node.mass[k];
            }
        }
        let mut is_good = true;
        for i in (0..self.nodes.len()).rev() {
            for block in &self.blocks[self.nodes[i].mounted.clone()] {
                mount(block, &mut self.h, &mut self.slots, &mut self.nodes[i].a);
            }
            let (node, parent) = with_parent(&mut self.nodes, i);
            let entries = &self.entries[node.entries.clone()];
            is_good &= by_pivots!(N, node.m, factor_joint(node, parent, entries, &self.values));
            let range = node.slots.clone();
            let free = N - node.m;
            if node.way == Way::Reduced {
                self.mass[node.first..node.first + free].copy_from_slice(&node.delta[..free]);
            }
            if range.is_empty() {
                continue;
            }
            let (before, own) = self.slots.split_at_mut(range.start);
            let own = &mut own[..range.len()];
            for slot in own.iter_mut() {
                let up = before.get_mut(slot.up);
                by_pivots!(N, node.m, factor_slot(node, slot, up));
            }
            match node.way {
                Way::Alone => {}
                Way::Block(b) => {
                    let block = &self.blocks[b];
                    let r = block.links.len();
                    for (k, slot) in own.iter().enumerate() {
                        let row = block.first + slot.place * r;
                        for other in &own[..=k] {
                            let mut sum = 0.0;
                            for f in 0..free {
                                sum += slot.g[f] * node.inverse[f] * other.g[f];
                            }
                            self.h[row + other.place] += sum;
                        }
                    }
                }
                Way::Reduced => {
                    for slot in own.iter() {
                        let link = &self.links[slot.link];
                        let values = match link.source {
                            Source::Row(_) => self.rows.values_mut(),
                            Source::Armature(_) => self.added.values_mut(link.reduced),
                        };
                        values[slot.place..slot.place + free].copy_from_slice(&slot.g[..free]);
                    }
                }
            }
        }
        for block in &self.blocks {
            if block.base == GROUND {
                let r = block.links.len();
                factor_block(&mut self.h[block.first..block.first + r * r], r);
            }
        }
        is_good
    }

    fn factor(&mut self, c: &SparseMatrix, mass: MassMatrix<'_>) -> Outcome<bool> {
        let is_good = self.condense(c, mass);
        let mass = MassMatrix::new(&self.mass, &self.added);
        match &mut self.reduced {
            Reduced::Nothing => {}
            Reduced::NullSpace(saddle) => saddle.factor(|k| self.rows.row(k).1, mass)?,
            Reduced::Schur(saddle) => saddle.factor(&self.rows, mass)?,
        }
        Ok(is_good)
    }

    /// Solves `M·a + Cᵀ·λ = force`, `C·a = gamma`.
    fn solve(
        &mut self,
        force: &[f64],
        gamma: &[f64],
        a: &mut [f64],
        lambda: Option<&mut [f64]>,
    ) -> Outcome<()> {
        for (own, link) in self.gamma.iter_mut().zip(&self.links) {
            *own = match link.source {
                Source::Row(row) => gamma[row],
                Source::Armature(_) => 0.0,
            };
        }
        for node in &mut self.nodes {
            for k in 0..N {
                node.f[k] = force[node.column[k]];
            }
        }
        for i in (0..self.nodes.len()).rev() {
            for block in &self.blocks[self.nodes[i].mounted.clone()] {
                let r = block.links.len();
                let h = &self.h[block.first..block.first + r * r];
                let y = &mut self.gamma[block.links.clone()];
                half_solve(h, r, y);
                for (k, slot) in self.slots[block.slots.clone()].iter().enumerate() {
                    let by = h[k * (r + 1)] * y[k];
                    for j in 0..N {
                        self.nodes[i].f[j] += slot.g[j] * by;
                    }
                }
            }
            let (node, parent) = with_parent(&mut self.nodes, i);
            by_pivots!(N, node.m, inward_joint(node, parent, gamma));
            let free = N - node.m;
            for slot in &self.slots[node.slots.clone()] {
                let left = &mut self.gamma[slot.link];
                for p in 0..node.m {
                    *left -= slot.w[p] * node.d[p];
                }
                if node.way != Way::Reduced {
                    for f in 0..free {
                        *left -= slot.g[f] * node.inverse[f] * node.phi[f];
                    }
                }
            }
            if node.way == Way::Reduced {
                self.r_f[node.first..node.first + free].copy_from_slice(&node.phi[..free]);
            }
        }
        for block in &self.blocks {
            if block.base == GROUND {
                let r = block.links.len();
                let h = &self.h[block.first..block.first + r * r];
                let y = &mut self.gamma[block.links.clone()];
                half_solve(h, r, y);
                let mu = &mut self.mu[block.links.clone()];
                (0..r).for_each(|k| mu[k] = -y[k]);
                other_half(h, r, mu);
            }
        }
        self.solve_reduced(lambda.is_some())?;
        for i in 0..self.nodes.len() {
            let (node, parent) = with_parent(&mut self.nodes, i);
            let free = N - node.m;
            match node.way {
                Way::Alone => (0..free).for_each(|f| node.phi[f] *= node.inverse[f]),
                Way::Block(_) => {
                    for slot in &self.slots[node.slots.clone()] {
                        let mu = self.mu[slot.link];
                        (0..free).for_each(|f| node.phi[f] -= slot.g[f] * mu);
                    }
                    (0..free).for_each(|f| node.phi[f] *= node.inverse[f]);
                }
                Way::Reduced => {
                    node.phi[..free].copy_from_slice(&self.r_x[node.first..node.first + free]);
                }
            }
            let parent = parent.map(|parent| &*parent);
            by_pivots!(N, node.m, outward_joint(node, parent));
            for k in 0..N {
                a[node.column[k]] = node.motion[k];
            }
            for block in &self.blocks[node.mounted.clone()] {
                let r = block.links.len();
                let mu = &mut self.mu[block.links.clone()];
                let y = &self.gamma[block.links.clone()];
                for (k, slot) in self.slots[block.slots.clone()].iter().enumerate() {
                    mu[k] = -y[k];
                    for j in 0..N {
                        mu[k] += slot.g[j] * node.motion[j];
                    }
                }
                other_half(&self.h[block.first..block.first + r * r], r, mu);
            }
        }
        if let Some(lambda) = lambda {
            self.reactions(force, lambda);
        }
        Ok(())
    }

    fn solve_reduced(&mut self, with_multipliers: bool) -> Outcome<()> {
        for (index, link) in self.links.iter().enumerate() {
            if !self.is_reduced(index) {
                continue;
            }
            match link.source {
                Source::Row(_) => self.r_gamma[link.reduced] = self.gamma[index],
                Source::Armature(_) => {
                    let (inertia, columns, values) = self.added.row(link.reduced);
                    let force = inertia * self.gamma[index];
                    for (&j, g) in columns.iter().zip(values) {
                        self.r_f[j] += force * g;
                    }
                }
            }
        }
        let (f, gamma) = (&self.r_f, &self.r_gamma);
        let (x, mu) = (&mut self.r_x, &mut self.r_mu);
        match &mut self.reduced {
            Reduced::Nothing => return Ok(()),
            Reduced::NullSpace(saddle) if with_multipliers => saddle.solve(f, gamma, x, mu)?,
            Reduced::NullSpace(saddle) => saddle.motion(f, gamma, x)?,
            Reduced::Schur(saddle) => saddle.solve(&self.rows, f, gamma, x, mu)?,
        }
        for index in 0..self.links.len() {
            let link = self.links[index];
            if !self.is_reduced(index) {
                continue;
            }
            self.mu[index] = match link.source {
                Source::Row(_) => self.r_mu[link.reduced],
                Source::Armature(_) => {
                    let rate = self.added.times(link.reduced, &self.r_x);
                    (rate - self.gamma[index]) / link.compliance
                }
            };
        }
        Ok(())
    }

    /// Returns whether a link belongs to the reduced equations. Links of blocks come first.
    fn is_reduced(&self, link: usize) -> bool {
        link >= self.blocks.last().map_or(0, |block| block.links.end)
    }

    /// Returns the reduced rows in the metric of the reduced masses, relative to the rows of C in
    /// the metric of the masses, with the numbers of these rows of C.
    fn scaled(&self, c: &SparseMatrix, mass: &[f64]) -> (DMatrix<f64>, Vec<usize>) {
        let (r, z) = (self.rows.nrows(), self.rows.ncols());
        let (mut g, mut of_row) = (DMatrix::<f64>::zeros(r, z), vec![0; r]);
        for (index, link) in self.links.iter().enumerate() {
            let (Source::Row(row), true) = (link.source, self.is_reduced(index)) else {
                continue;
            };
            of_row[link.reduced] = row;
            let squares = c.entries(row).filter(|(j, _)| mass[*j] > 0.0);
            let scale: f64 = squares.map(|(j, x)| x * x / mass[j]).sum();
            for (j, x) in self.rows.entries(link.reduced) {
                g[(link.reduced, j)] = x / (self.mass[j] * scale).sqrt();
            }
        }
        (g, of_row)
    }

    fn reactions(&mut self, force: &[f64], lambda: &mut [f64]) {
        for node in &mut self.nodes {
            for k in 0..N {
                node.f[k] = force[node.column[k]] - node.mass[k] * node.motion[k];
            }
        }
        for e in &self.closing {
            let by = self.values[e.value as usize] * self.mu[e.link as usize];
            self.nodes[e.node as usize].f[usize::from(e.column)] -= by;
        }
        for (link, mu) in self.links.iter().zip(&self.mu) {
            if let Source::Row(row) = link.source {
                lambda[row] = *mu;
            }
        }
        for i in (0..self.nodes.len()).rev() {
            let (node, parent) = with_parent(&mut self.nodes, i);
            let entries = &self.entries[node.entries.clone()];
            by_pivots!(
                N,
                node.m,
                reaction(node, parent, entries, &self.values, lambda)
            );
        }
    }
}

/// Adds the inertia of a block to its base.
fn mount<const N: usize>(
    block: &Block,
    h: &mut [f64],
    slots: &mut [Slot<N>],
    a: &mut [[f64; N]; N],
) {
    let r = block.links.len();
    let h = &mut h[block.first..block.first + r * r];
    factor_block(h, r);
    let slots = &mut slots[block.slots.clone()];
    for k in 0..r {
        let mut y = slots[k].w;
        for j in 0..k {
            let l = h[k * r + j];
            for i in 0..N {
                y[i] -= l * slots[j].g[i];
            }
        }
        let inverse = h[k * (r + 1)];
        for i in 0..N {
            let scaled = y[i] * inverse;
            for j in 0..N {
                a[i][j] += scaled * y[j];
            }
        }
        slots[k].g = y;
    }
}

/// The base of each block, the way of each node, and the closing rows with their blocks. Rows of
/// blocks come first. Blocks are ordered by their bases.
type Partition = (Vec<usize>, Vec<Way>, Vec<(usize, Option<usize>)>);

fn partition(tree: &Tree, way: Treatment) -> Partition {
    let count = tree.nodes.len();
    let is_early = matches!(way, Treatment::Early | Treatment::EarlySchur);
    let touched: Vec<(usize, Vec<usize>)> = { tree.closing.iter() }
        .map(|row| {
            let above = |x: usize| path(&tree.nodes, x, GROUND);
            let is_common = |x: &usize| row.ends.iter().all(|&end| above(end).contains(x));
            let common = if is_early && !row.ends.contains(&GROUND) {
                above(row.ends[0]).into_iter().find(is_common)
            } else {
                None
            };
            let top = common.unwrap_or(GROUND);
            let nodes = { row.ends.iter() }.flat_map(|&end| path(&tree.nodes, end, top));
            (top, nodes.collect())
        })
        .collect();
    let mut sets = DisjointSets::new(count);
    for (_, nodes) in &touched {
        nodes.iter().for_each(|&i| sets.join(nodes[0], i));
    }
    let sets = sets.sets();
    let mut set_of = vec![0; count];
    for (k, set) in sets.iter().enumerate() {
        set.iter().for_each(|&i| set_of[i] = k);
    }
    let set_of_row = |k: usize| touched[k].1.first().map(|&i| set_of[i]);
    let mut rows = vec![0; sets.len()];
    (0..touched.len())
        .filter_map(set_of_row)
        .for_each(|set| rows[set] += 1);
    // Parents come first, so the first node of a set is mounted on the base.
    let base = |set: usize| tree.nodes[sets[set][0]].parent;
    let mut is_local: Vec<bool> = (0..sets.len())
        .map(|set| is_early && rows[set] <= LOCAL[usize::from(base(set) != GROUND)])
        .collect();
    // Rows of the reduced equations are open up to the ground.
    loop {
        let mut has_changed = false;
        for set in 0..sets.len() {
            if rows[set] > 0 && !is_local[set] {
                for i in path(&tree.nodes, sets[set][0], GROUND) {
                    let other = set_of[i];
                    has_changed |= rows[other] > 0 && is_local[other];
                    if rows[other] > 0 {
                        is_local[other] = false;
                    }
                }
            }
        }
        if !has_changed {
            break;
        }
    }
    let mut ways = vec![Way::Alone; count];
    let mut locals: Vec<usize> = (0..sets.len())
        .filter(|&set| rows[set] > 0 && is_local[set])
        .collect();
    locals.sort_by_key(|&set| base(set));
    let mut order = Vec::new();
    for (b, &set) in locals.iter().enumerate() {
        sets[set].iter().for_each(|&i| ways[i] = Way::Block(b));
        let own = (0..touched.len()).filter(|&k| set_of_row(k) == Some(set));
        order.extend(own.map(|k| (k, Some(b))));
    }
    for k in 0..touched.len() {
        let is_block = set_of_row(k).is_some_and(|set| is_local[set]);
        if !is_block {
            order.push((k, None));
            for &i in &touched[k].1 {
                path(&tree.nodes, i, GROUND)
                    .into_iter()
                    .for_each(|i| ways[i] = Way::Reduced);
            }
        }
    }
    (locals.iter().map(|&set| base(set)).collect(), ways, order)
}

// Equations of a mechanism.

/// The equations at a state, and a tree whose rows are rows of `c`.
struct Equations {
    tree: Tree,
    c: SparseMatrix,
    gamma: Vec<f64>,
    units: Vec<f64>,
    s: Scratch,
    kept: Vec<usize>,
    v: Vec<f64>,
    is_rank: bool,
}

/// The values of rows of C as a sparse matrix.
fn sparse(m: &Mechanism, s: &Scratch, kept: &[usize]) -> Outcome<SparseMatrix> {
    let rows = kept
        .iter()
        .map(|&i| m.layout().row(s, i).collect::<Vec<_>>());
    Ok(SparseMatrix::from_rows(m.layout().n_v, rows)?)
}

/// Returns the tree with its rows renumbered.
fn renumbered(tree: &Tree, kept: &[usize]) -> Tree {
    let number = |row: usize| kept.binary_search(&row).ok();
    let mut tree = tree.clone();
    for node in &mut tree.nodes {
        node.rows = node.rows.iter().filter_map(|&i| number(i)).collect();
    }
    tree.closing.retain_mut(|row| match &mut row.source {
        Source::Row(i) => match number(*i) {
            Some(k) => {
                *i = k;
                true
            }
            None => false,
        },
        Source::Armature(_) => true,
    });
    tree
}

/// Returns the equations at the start. If `shift` is not zero, the constraints are violated by
/// about this length.
fn equations<const N: usize>(
    p: &PreparedMechanism,
    style: Style,
    shift: f64,
) -> Outcome<Equations> {
    let (m, t) = (&p.mechanism, p.start_time());
    let n = m.layout().n_v;
    let mut s = m.scratch();
    m.pose(t, &p.q, &mut s);
    m.c(&mut s);
    m.b(&mut s);
    let units = units(m, p.assembly.size);
    let tree = spanning_tree(m, &s, &units, style);
    // Closing rows are chosen in the metric of the reduced masses.
    let all = Vec::from_iter(0..m.layout().rows());
    let c = sparse(m, &s, &all)?;
    let mut without = tree.clone();
    without
        .closing
        .retain(|row| matches!(row.source, Source::Row(_)));
    let mut whole =
        Condensation::<N>::new(&without, &c, m.inertia(&s), &units, Treatment::NullSpace)?;
    whole.condense(&c, m.inertia(&s));
    let (g, of_row) = whole.scaled(&c, m.mass());
    let [chosen, _] = complete_pivoting(g, INDEPENDENT);
    let mut kept: Vec<usize> = chosen.iter().map(|&k| of_row[k]).collect();
    kept.extend(tree.nodes.iter().flat_map(|node| &node.rows));
    if style == Style::Decided {
        kept.clone_from(&p.decision.kept);
    }
    kept.sort_unstable();
    let is_rank = kept.len() == p.decision.rank;
    let tree = renumbered(&tree, &kept);
    if shift > 0.0 {
        let d = (0..n).map(|k| shift * (0.7 + 1.9 * k as f64).sin());
        let mut q = p.q.clone();
        m.displace(&mut q, &d.collect::<Vec<_>>());
        m.pose(t, &q, &mut s);
        m.c(&mut s);
        m.b(&mut s);
    }
    let c = sparse(m, &s, &kept)?;

    let mut v = p.v.clone();
    if v.iter().all(|v| *v == 0.0) {
        // Any motion that satisfies the constraints, so that Γ is not zero.
        let push: Vec<f64> = (0..n).map(|k| (1.0 + 2.3 * k as f64).sin()).collect();
        let b: Vec<f64> = kept.iter().map(|&i| s.b[i]).collect();
        let mut saddle = SchurSaddle::new(structure(m, &c, &s));
        let mass: Vec<f64> = m.mass().iter().map(|m| m.max(1e-3)).collect();
        saddle.factor(&c, MassMatrix::new(&mass, m.inertia(&s).added()))?;
        saddle.solve(&c, &push, &b, &mut v, &mut vec![0.0; kept.len()])?;
    }
    m.twist(&v, &mut s);
    m.gamma(&mut s);
    m.force(&mut s);
    // A push, so that no scene is in equilibrium.
    for (k, (force, m)) in s.force.iter_mut().zip(m.mass()).enumerate() {
        *force += m * (0.5 + 1.7 * k as f64).sin();
    }
    let gamma = kept.iter().map(|&i| s.gamma[i]).collect();
    Ok(Equations {
        tree,
        c,
        gamma,
        units,
        s,
        kept,
        v,
        is_rank,
    })
}

fn structure(m: &Mechanism, c: &SparseMatrix, s: &Scratch) -> SchurStructure {
    let bodies = 0..m.bodies().len();
    let blocks: Vec<_> = bodies.map(|b| m.layout().columns(b)).collect();
    SchurStructure::with_added(c, &blocks, m.inertia(s).added())
}

// Scenes.

fn described<S: BodySpace>(d: &MechanismDescription<S>) -> Outcome<PreparedMechanism> {
    motion::prepared(d).map_err(|outcome| format!("{outcome:?}").into())
}

fn drawn(drawing: &Drawing) -> Outcome<PreparedMechanism> {
    let mut d = description(drawing, &Precision::default())?;
    d.gravity = [0.3, -9.81, 1.0];
    described(&d)
}

fn read(name: &str, text: &str) -> Outcome<PreparedMechanism> {
    let study = Study::read(name, text, &Registry::standard(), &RunOptions::default())?;
    Ok(study.prepared)
}

fn generated(family: Family, n: usize) -> Outcome<PreparedMechanism> {
    let mut text = Vec::new();
    Order::of(family, n).generate()?.write(&mut text)?;
    read(family.name(), &String::from_utf8(text)?)
}

fn body(name: &str, mass: f64, inertia: [f64; 3], at: [f64; 3]) -> String {
    format!(
        "[[body]]\nname = \"{name}\"\nmass = {mass:?}\ninertia = {inertia:?}\nposition = {at:?}\n"
    )
}

fn joint(name: &str, kind: &str, bodies: [&str; 2], at: [f64; 3], more: &str) -> String {
    format!(
        "[[joint]]\nname = \"{name}\"\ntype = \"{kind}\"\nbodies = {bodies:?}\nat = {at:?}\n{more}\n"
    )
}

fn space(name: &str) -> String {
    format!("[scene]\nname = \"{name}\"\nspace = \"spatial\"\ngravity = [0.3, 1.0, -9.81]\n")
}

/// A floating base with four chains of six revolute joints. Two chains may have a loop.
fn arms(armature: f64, has_loops: bool) -> Outcome<PreparedMechanism> {
    const LENGTH: f64 = 0.3;
    let mut text = space("arms");
    text += &body("base", 20.0, [0.8, 0.9, 1.2], [0.0; 3]);
    let axes = [
        "[0, 0, 1]",
        "[0, 1, 0]",
        "[0, 1, 0]",
        "[0, 1, 0]",
        "[0, 0, 1]",
        "[1, 0, 0]",
    ];
    let corners = [[1.0, 0.3], [1.0, -0.3], [-1.0, 0.25], [-1.0, -0.35]];
    for (arm, [side, y]) in corners.into_iter().enumerate() {
        let mut before = "base".to_owned();
        let at = |k: f64, z: f64| [side * (0.2 + LENGTH * k), y, z + 0.03 * k * k];
        for (k, axis) in axes.iter().enumerate() {
            let name = format!("link-{arm}-{k}");
            let centre = at(k as f64 + 0.5, 0.01);
            text += &body(&name, 2.0 - 0.2 * k as f64, [0.004, 0.02, 0.019], centre);
            let more = if armature > 0.0 {
                format!("axis = {axis}\narmature = {armature:?}")
            } else {
                format!("axis = {axis}")
            };
            let at = at(k as f64, 0.0);
            text += &joint(
                &format!("J{arm}-{k}"),
                "revolute",
                [&before, &name],
                at,
                &more,
            );
            before = name;
        }
        if has_loops && arm < 2 {
            let rod = format!("rod-{arm}");
            text += &body(&rod, 0.4, [0.001, 0.006, 0.006], at(2.5, 0.15));
            let ends = [format!("link-{arm}-1"), format!("link-{arm}-3")];
            let more = "axis = [0, 1, 0]";
            let name = format!("R{arm}");
            text += &joint(&name, "revolute", [&ends[0], &rod], at(1.6, 0.15), more);
            let name = format!("S{arm}");
            text += &joint(&name, "spherical", [&rod, &ends[1]], at(3.4, 0.15), "");
        }
    }
    read("arms", &text)
}

/// Bodies on spherical joints, suspended from the ground. The masses grow by this factor from body
/// to body.
fn spherical_chain(n: usize, growth: f64) -> Outcome<PreparedMechanism> {
    let mut text = space("chain");
    let mut before = "ground".to_owned();
    let at = |k: f64| [0.5 * k, 0.1 * (k * 1.3).sin(), -0.2 * (k * 0.7).cos()];
    for k in 0..n {
        let (name, x) = (format!("b{k}"), k as f64);
        let mass = growth.powi(k as i32);
        let inertia = [0.004, 0.02, 0.021].map(|x| x * mass);
        text += &body(&name, mass, inertia, at(x + 0.5));
        text += &joint(&format!("S{k}"), "spherical", [&before, &name], at(x), "");
        before = name;
    }
    read("chain", &text)
}

/// Carriages on knife edges in the plane, with a pin between neighbours.
fn carriages(n: usize) -> Outcome<PreparedMechanism> {
    let mut text = "[scene]\nname = \"carriages\"\nspace = \"plane\"\n".to_owned();
    for k in 0..n {
        let x = -(k as f64);
        text += &format!(
            "[[body]]\nname = \"c{k}\"\nmass = 2.0\ninertia = 0.3\nposition = [{x:?}, 0.0]\n\
             velocity = [1.0, 0.0]\nangular_velocity = 0.0\n[[joint]]\nname = \"E{k}\"\n\
             type = \"knife-edge\"\nbody = \"c{k}\"\npoint = [-0.2, 0.0]\nnormal = [0, 1]\n"
        );
        if k > 0 {
            let before = k - 1;
            text += &format!(
                "[[joint]]\nname = \"P{k}\"\ntype = \"revolute\"\nbodies = [\"c{before}\", \
                 \"c{k}\"]\nat = [{:?}, 0.0]\n",
                x + 0.5
            );
        }
    }
    read("carriages", &text)
}

/// Cars with four wheels, with a ball joint between neighbours.
fn cars(n: usize) -> Outcome<PreparedMechanism> {
    let mut text = space("cars");
    for k in 0..n {
        let x = -4.0 * k as f64;
        let chassis = format!("c{k}");
        text += &body(&chassis, 20.0, [2.0, 6.0, 7.0], [x, 0.0, 0.5]);
        for (j, [dx, y]) in [[1.3, 0.7], [1.3, -0.7], [-1.3, 0.7], [-1.3, -0.7]]
            .iter()
            .enumerate()
        {
            let wheel = format!("w{k}-{j}");
            let at = [x + dx, *y, 0.3];
            text += &body(&wheel, 1.0, [0.02, 0.04, 0.02], at);
            let name = format!("H{k}-{j}");
            text += &joint(
                &name,
                "revolute",
                [&chassis, &wheel],
                at,
                "axis = [0, 1, 0]",
            );
            text += &format!(
                "[[joint]]\nname = \"W{k}-{j}\"\ntype = \"wheel\"\nbody = \"{wheel}\"\n\
                 point = [0.0, 0.0, 0.0]\naxis = [0, 1, 0]\nradius = 0.3\n"
            );
        }
        if k > 0 {
            let before = format!("c{}", k - 1);
            let at = [x + 2.0, 0.0, 0.4];
            text += &joint(&format!("B{k}"), "spherical", [&before, &chassis], at, "");
        }
    }
    read("cars", &text)
}

fn example(name: &str) -> Outcome<PreparedMechanism> {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    read(name, &std::fs::read_to_string(path)?)
}

/// The scenes of `check` in addition to the catalogue, and the scenes of `count`.
const SCENES: &[&str] = &[
    "arms",
    "arms without armatures",
    "arms with loops",
    "arms with loops without armatures",
    "row 1",
    "row 4",
    "row 16",
    "row 64",
    "tower 1",
    "tower 4",
    "tower 16",
    "tower 64",
    "robot",
    "robot in space",
    "hexapod",
    "top",
    "disk",
    "Bennett",
    "Bricard",
    "V18 6-UPS",
    "V18 6-UPS, driven",
    "V19 Delta",
    "V22 car, straight",
    "spherical chain 4",
    "spherical chain 16",
    "spherical chain 64",
    "graded chain 16",
    "light chain 16",
    "lattice 2",
    "lattice 4",
    "lattice 6",
    "cells 4",
    "cells 16",
    "n-four-bar 16",
    "n-four-bar 64",
    "fleet 16",
    "random 16",
    "carriages 4",
    "carriages 16",
    "carriages 64",
    "cars 1",
    "cars 4",
    "cars 16",
];

fn scene(name: &str) -> Outcome<PreparedMechanism> {
    let (kind, n) = name.rsplit_once(' ').unwrap_or((name, ""));
    let n: usize = n.parse().unwrap_or(0);
    let disk = RollingDisk {
        tilt: 1.2,
        precession: 0.8,
    };
    match (name, kind) {
        ("arms", _) => arms(0.05, false),
        ("arms without armatures", _) => arms(0.0, false),
        ("arms with loops", _) => arms(0.05, true),
        ("arms with loops without armatures", _) => arms(0.0, true),
        ("robot", _) => described(&robot(steering())),
        ("robot in space", _) => example("robot-in-space"),
        ("hexapod", _) => example("hexapod"),
        ("top", _) => described(&top()),
        ("disk", _) => described(&disk.description()),
        ("Bennett", _) => described(&bennett()?),
        ("Bricard", _) => described(&bricard()),
        ("row without mass", _) => {
            let drawing = catalogue::parallelograms(1, [3, 4]);
            let mut d = description(&drawing, &Precision::default())?;
            d.gravity = [0.3, -9.81, 1.0];
            (d.bodies[1].mass, d.bodies[1].inertia) = (0.0, [[0.0; 3]; 3]);
            described(&d)
        }
        (_, "row") => drawn(&catalogue::parallelograms(n, [3, 4])),
        (_, "tower") => drawn(&catalogue::four_bars_in_a_row(n)),
        (_, "spherical chain") => spherical_chain(n, 1.0),
        (_, "graded chain") => spherical_chain(n, 1e12_f64.powf(1.0 / (n as f64 - 1.0))),
        (_, "light chain") => spherical_chain(n, 1e-12_f64.powf(1.0 / (n as f64 - 1.0))),
        (_, "lattice") => generated(Family::Lattice, n),
        (_, "cells") => generated(Family::Parallelograms, n),
        (_, "fleet") => generated(Family::Fleet, n),
        (_, "random") => generated(Family::Random, n),
        (_, "n-four-bar") => generated(Family::NFourBar, n),
        (_, "carriages") => carriages(n),
        (_, "cars") => cars(n),
        _ => {
            let all = catalogue::all();
            let found = all.iter().find(|(of, _)| *of == name);
            drawn(&found.ok_or(format!("no scene `{name}`"))?.1)
        }
    }
}

// Commands.

/// Largest error of v̇ that `check` accepts, and above which it corrects a solution.
const BOUND: f64 = 1e-12;

/// Returns the largest difference, relative to the right values if these are above one.
fn error(found: &[f64], right: &[f64]) -> f64 {
    let difference = found.iter().zip(right).map(|(a, b)| (a - b).abs());
    // A NaN is an error.
    difference.fold(0.0, |e, x| if x <= e { e } else { x }) / max_abs(right).max(1.0)
}

/// Corrects a solution once with the residuals of the equations in double precision.
fn corrected<const N: usize>(
    own: &mut Condensation<N>,
    (c, mass): (&SparseMatrix, MassMatrix<'_>),
    (force, gamma): (&[f64], &[f64]),
    (a, lambda): (&mut [f64], &mut [f64]),
) -> Outcome<()> {
    let (n, r) = (a.len(), lambda.len());
    let (mut rest, mut reaction) = (mass.product(a), vec![0.0; n]);
    c.transposed_times(lambda, &mut reaction);
    for k in 0..n {
        rest[k] = force[k] - rest[k] - reaction[k];
    }
    let mut rows = vec![0.0; r];
    c.times(a, &mut rows);
    let each = rows.iter_mut().zip(gamma);
    each.for_each(|(x, gamma)| *x = gamma - *x);
    let (mut by_a, mut by_lambda) = (vec![0.0; n], vec![0.0; r]);
    own.solve(&rest, &rows, &mut by_a, Some(&mut by_lambda))?;
    a.iter_mut().zip(by_a).for_each(|(a, by)| *a += by);
    let each = lambda.iter_mut().zip(by_lambda);
    each.for_each(|(a, by)| *a += by);
    Ok(())
}

const WAYS: [Treatment; 4] = [
    Treatment::NullSpace,
    Treatment::Schur,
    Treatment::Early,
    Treatment::EarlySchur,
];

fn check<const N: usize>(
    name: &str,
    p: &PreparedMechanism,
    (style, shift): (Style, f64),
) -> Outcome<bool> {
    let m = &p.mechanism;
    let e = equations::<N>(p, style, shift)?;
    let (n, r) = (m.layout().n_v, e.c.nrows());
    let mass = m.inertia(&e.s);
    let free = e.tree.nodes.iter().map(|node| N - node.rows.len());
    print!(
        "{name:34} {:3} {r:4} {:3} {:4} {:3}",
        m.bodies().len(),
        n - r,
        free.sum::<usize>(),
        e.tree.closing.len()
    );
    let spread = mass_spread(m.mass());
    let mut saddle = KeptRowSaddle::of_rows(&e.c, mass)?.graded_by(spread);
    saddle.factor(|k| e.c.row(k).1, mass)?;
    let [mut a, mut right] = [vec![0.0; n], vec![0.0; n]];
    let [mut lambda, mut right_lambda] = [vec![0.0; r], vec![0.0; r]];
    let force = &e.s.force;
    saddle.solve(force, &e.gamma, &mut a, &mut lambda)?;
    let mut refinement = Refinement::new(n, r);
    let out = (&mut right, &mut right_lambda);
    let row = |k: usize| e.c.row(k).1;
    saddle.solve_refined(&mut refinement, row, force, &e.gamma, out.0, out.1)?;
    print!(
        " | {:6.0e} {:6.0e}",
        error(&a, &right),
        error(&lambda, &right_lambda)
    );
    let mut schur = SchurSaddle::new(structure(m, &e.c, &e.s));
    let mut solved = || -> Outcome<()> {
        schur.factor(&e.c, mass)?;
        Ok(schur.solve(&e.c, force, &e.gamma, &mut a, &mut lambda)?)
    };
    match solved() {
        Ok(()) => print!(
            " | {:6.0e} {:6.0e}",
            error(&a, &right),
            error(&lambda, &right_lambda)
        ),
        Err(_) => print!(" | {:13}", "fails"),
    }
    let mut is_good = true;
    for way in WAYS {
        let mut solved = || -> Outcome<bool> {
            let mut own = Condensation::<N>::new(&e.tree, &e.c, mass, &e.units, way)?;
            let is_good = own.factor(&e.c, mass)?;
            a.fill(f64::NAN);
            lambda.fill(f64::NAN);
            own.solve(force, &e.gamma, &mut a, Some(&mut lambda))?;
            Ok(is_good)
        };
        match solved() {
            Ok(pivots) => {
                let mut of_motion = error(&a, &right);
                print!(" | {of_motion:6.0e} {:6.0e}", error(&lambda, &right_lambda));
                if of_motion > BOUND {
                    let mut own = Condensation::<N>::new(&e.tree, &e.c, mass, &e.units, way)?;
                    own.factor(&e.c, mass)?;
                    for _ in 0..2 {
                        let equations = ((&e.c, mass), (&force[..], &e.gamma[..]));
                        let out = (&mut a[..], &mut lambda[..]);
                        corrected(&mut own, equations.0, equations.1, out)?;
                        of_motion = error(&a, &right);
                        print!(" → {of_motion:6.0e}");
                    }
                }
                // NaN is not good.
                is_good &= pivots && of_motion <= BOUND;
                if !pivots {
                    print!(" pivots");
                }
            }
            Err(error) => print!(" | {:13.13}", error.to_string()),
        }
    }
    println!("{}", if e.is_rank { "" } else { "  not the rank" });
    Ok(is_good && e.is_rank)
}

fn check_scene(name: &str, style: (Style, f64)) -> Outcome<bool> {
    let p = scene(name)?;
    if p.mechanism.space().n_v() == 6 {
        check::<6>(name, &p, style)
    } else {
        check::<3>(name, &p, style)
    }
}

fn check_all(style: (Style, f64)) -> Outcome<bool> {
    let names: Vec<&str> = SCENES.to_vec();
    println!("errors of v̇ and λ");
    println!(
        "{:34} bod rows  free  z clos | null space   | Schur         | tree, null    | tree, Schur   | early, null   | early, Schur",
        "scene"
    );
    let mut is_good = true;
    let all = catalogue::all();
    let more = all
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| !names.contains(name));
    for name in names.iter().copied().chain(more) {
        is_good &= check_scene(name, style).unwrap_or_else(|error| {
            println!("{name:34} {error}");
            false
        });
    }
    Ok(is_good)
}

/// What is measured: the present solvers, and the condensation with its ways.
struct Measured<'m, const N: usize> {
    e: &'m Equations,
    mass: MassMatrix<'m>,
    a: Vec<f64>,
    lambda: Vec<f64>,
    times: usize,
}

impl<const N: usize> Measured<'_, N> {
    #[inline(never)]
    fn measured_null_space(&mut self, saddle: &mut KeptRowSaddle) -> Outcome<()> {
        for _ in 0..self.times {
            saddle.factor(|k| self.e.c.row(k).1, self.mass)?;
            saddle.motion(&self.e.s.force, &self.e.gamma, &mut self.a)?;
        }
        Ok(())
    }

    #[inline(never)]
    fn measured_schur(&mut self, saddle: &mut SchurSaddle) -> Outcome<()> {
        for _ in 0..self.times {
            saddle.factor(&self.e.c, self.mass)?;
            let (f, gamma) = (&self.e.s.force, &self.e.gamma);
            saddle.solve(&self.e.c, f, gamma, &mut self.a, &mut self.lambda)?;
        }
        Ok(())
    }

    fn condensed(&mut self, own: &mut Condensation<N>) -> Outcome<()> {
        for _ in 0..self.times {
            own.factor(&self.e.c, self.mass)?;
            own.solve(&self.e.s.force, &self.e.gamma, &mut self.a, None)?;
        }
        Ok(())
    }

    #[inline(never)]
    fn measured_tree_null(&mut self, own: &mut Condensation<N>) -> Outcome<()> {
        // The number keeps the compiler from merging equal functions.
        std::hint::black_box(0);
        self.condensed(own)
    }

    #[inline(never)]
    fn measured_tree_schur(&mut self, own: &mut Condensation<N>) -> Outcome<()> {
        // The number keeps the compiler from merging equal functions.
        std::hint::black_box(1);
        self.condensed(own)
    }

    #[inline(never)]
    fn measured_early_null(&mut self, own: &mut Condensation<N>) -> Outcome<()> {
        // The number keeps the compiler from merging equal functions.
        std::hint::black_box(2);
        self.condensed(own)
    }

    #[inline(never)]
    fn measured_early_schur(&mut self, own: &mut Condensation<N>) -> Outcome<()> {
        // The number keeps the compiler from merging equal functions.
        std::hint::black_box(3);
        self.condensed(own)
    }

    #[inline(never)]
    fn measured_present_lambda(&mut self, saddle: &mut KeptRowSaddle) -> Outcome<()> {
        for _ in 0..self.times {
            saddle.multipliers(&self.e.s.force, &self.a, &mut self.lambda)?;
        }
        Ok(())
    }

    /// Counts the reactions and one correction.
    #[inline(never)]
    fn measured_correction(&mut self, own: &mut Condensation<N>) -> Outcome<()> {
        for _ in 0..self.times {
            own.reactions(&self.e.s.force, &mut self.lambda);
            let given = (&self.e.s.force[..], &self.e.gamma[..]);
            let out = (&mut self.a[..], &mut self.lambda[..]);
            corrected(own, (&self.e.c, self.mass), given, out)?;
        }
        Ok(())
    }

    #[inline(never)]
    fn measured_reactions(&mut self, own: &mut Condensation<N>) {
        for _ in 0..self.times {
            own.reactions(&self.e.s.force, &mut self.lambda);
        }
    }
}

/// Number of repetitions that are counted.
const TIMES: usize = 10;

fn run<const N: usize>(p: &PreparedMechanism, style: Style) -> Outcome<()> {
    let m = &p.mechanism;
    let e = equations::<N>(p, style, 0.0)?;
    let (n, r) = (m.layout().n_v, e.c.nrows());
    let free = e.tree.nodes.iter().map(|node| N - node.rows.len());
    println!(
        "{} {r} {} {} {}",
        m.bodies().len(),
        n - r,
        free.sum::<usize>(),
        e.tree.closing.len()
    );
    let mut it = Measured::<N> {
        e: &e,
        mass: m.inertia(&e.s),
        a: vec![0.0; n],
        lambda: vec![0.0; r],
        times: TIMES,
    };
    let mass = it.mass;
    let spread = mass_spread(m.mass());
    let mut saddle = KeptRowSaddle::of_rows(&e.c, mass)?.graded_by(spread);
    saddle.factor(|k| e.c.row(k).1, mass)?;
    it.measured_null_space(&mut saddle)?;
    it.measured_present_lambda(&mut saddle)?;
    let mut schur = SchurSaddle::new(structure(m, &e.c, &e.s));
    schur.factor(&e.c, mass)?;
    if let Err(error) = it.measured_schur(&mut schur) {
        eprintln!("{error}");
    }
    for way in WAYS {
        let planned = Condensation::<N>::new(&e.tree, &e.c, mass, &e.units, way);
        let Ok(mut own) = planned else { continue };
        // The first factorisation plans the order of elimination.
        if own.factor(&e.c, mass).is_err() {
            continue;
        }
        let measured = match way {
            Treatment::NullSpace => it.measured_tree_null(&mut own),
            Treatment::Schur => it.measured_tree_schur(&mut own),
            Treatment::Early => it.measured_early_null(&mut own),
            Treatment::EarlySchur => it.measured_early_schur(&mut own),
        };
        if let Err(error) = measured {
            eprintln!("{error}");
        }
        if way == Treatment::Early {
            it.measured_reactions(&mut own);
            it.measured_correction(&mut own)?;
        }
    }
    Ok(())
}

fn run_scene(name: &str, style: Style) -> Outcome<bool> {
    let p = scene(name)?;
    if p.mechanism.space().n_v() == 6 {
        run::<6>(&p, style)?;
    } else {
        run::<3>(&p, style)?;
    }
    Ok(true)
}

/// Prints run times (µs) of one factorisation and one motion for each body: the null space, the
/// Schur complement, and the four ways of the condensation.
fn time<const N: usize>(name: &str, p: &PreparedMechanism, style: Style) -> Outcome<bool> {
    let m = &p.mechanism;
    let e = equations::<N>(p, style, 0.0)?;
    let (n, r) = (m.layout().n_v, e.c.nrows());
    let mut it = Measured::<N> {
        e: &e,
        mass: m.inertia(&e.s),
        a: vec![0.0; n],
        lambda: vec![0.0; r],
        times: 20,
    };
    let mass = it.mass;
    let print = |seconds: f64, times: usize| {
        print!(" {:8.3}", 1e6 * seconds / (times * m.bodies().len()) as f64);
    };
    print!("{name:34}");
    let mut saddle = KeptRowSaddle::of_rows(&e.c, mass)?.graded_by(mass_spread(m.mass()));
    saddle.factor(|k| e.c.row(k).1, mass)?;
    let mut least = f64::INFINITY;
    for _ in 0..30 {
        let clock = Instant::now();
        it.measured_null_space(&mut saddle)?;
        least = least.min(clock.elapsed().as_secs_f64());
    }
    print(least, it.times);
    let mut schur = SchurSaddle::new(structure(m, &e.c, &e.s));
    let mut least = f64::INFINITY;
    for _ in 0..30 {
        let clock = Instant::now();
        it.measured_schur(&mut schur)?;
        least = least.min(clock.elapsed().as_secs_f64());
    }
    print(least, it.times);
    for way in WAYS {
        let mut own = Condensation::<N>::new(&e.tree, &e.c, mass, &e.units, way)?;
        own.factor(&e.c, mass)?;
        let mut least = f64::INFINITY;
        for _ in 0..30 {
            let clock = Instant::now();
            it.condensed(&mut own)?;
            least = least.min(clock.elapsed().as_secs_f64());
        }
        print(least, it.times);
    }
    println!();
    Ok(true)
}

/// Steps of `motion`, and their size (s).
const STEPS: (usize, f64) = (400, 2e-3);

/// Moves a mechanism by the classical Runge–Kutta method with accelerations of the condensation.
/// Prints the number of new plans, and the largest error of v̇ and violation of the rows of C·v.
fn move_on<const N: usize>(name: &str, p: &PreparedMechanism, style: Style) -> Outcome<bool> {
    let m = &p.mechanism;
    let mut e = equations::<N>(p, style, 0.0)?;
    let (n, r, n_q) = (m.layout().n_v, e.c.nrows(), m.layout().n_q);
    let mut s = m.scratch();
    let inertia = m.inertia(&e.s);
    let mut own = Condensation::<N>::new(&e.tree, &e.c, inertia, &e.units, Treatment::Early)?;
    let (mut q, mut v, mut t) = (p.q.clone(), e.v.clone(), p.start_time());
    let (mut plans, mut turned) = (0, 0.0_f64);
    let [mut most, mut once, mut without, mut present, mut left] = [0.0_f64; 5];
    let mut saddle = KeptRowSaddle::of_rows(&e.c, inertia)?;
    let mut refinement = Refinement::new(n, r);
    let [mut right, mut lambda] = [vec![0.0; n], vec![0.0; r]];
    for _ in 0..STEPS.0 {
        let mut slopes: Vec<[Vec<f64>; 2]> = Vec::new();
        for (stage, part) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
            let ahead = |x: &[f64], k: usize| -> Vec<f64> {
                match slopes.last() {
                    None => x.to_vec(),
                    Some(slope) => {
                        let each = x.iter().zip(&slope[k]);
                        each.map(|(x, slope)| x + part * STEPS.1 * slope).collect()
                    }
                }
            };
            let (q, v) = (ahead(&q, 0), ahead(&v, 1));
            m.pose(t + part * STEPS.1, &q, &mut s);
            m.c(&mut s);
            m.twist(&v, &mut s);
            m.gamma(&mut s);
            m.force(&mut s);
            e.c = sparse(m, &s, &e.kept)?;
            let gamma: Vec<f64> = e.kept.iter().map(|&i| s.gamma[i]).collect();
            if !own.factor(&e.c, m.inertia(&s))? {
                let mass = m.inertia(&s);
                own = Condensation::new(&e.tree, &e.c, mass, &e.units, Treatment::Early)?;
                own.factor(&e.c, mass)?;
                plans += 1;
            }
            let (mut a, mut rate) = (vec![0.0; n], vec![0.0; n_q]);
            own.solve(&s.force, &gamma, &mut a, None)?;
            if stage == 0 {
                saddle.factor(|k| e.c.row(k).1, m.inertia(&s))?;
                let row = |k: usize| e.c.row(k).1;
                let out = (&mut right, &mut lambda);
                saddle.solve_refined(&mut refinement, row, &s.force, &gamma, out.0, out.1)?;
                most = most.max(error(&a, &right));
                let mut plain = a.clone();
                let mass = m.inertia(&s);
                let mut mu = vec![0.0; r];
                own.reactions(&s.force, &mut mu);
                let given = (&s.force[..], &gamma[..]);
                corrected(&mut own, (&e.c, mass), given, (&mut plain, &mut mu))?;
                once = once.max(error(&plain, &right));
                let planned = Condensation::new(&e.tree, &e.c, mass, &e.units, WAYS[0]);
                let mut reduced: Condensation<N> = planned?;
                reduced.factor(&e.c, mass)?;
                reduced.solve(&s.force, &gamma, &mut plain, None)?;
                without = without.max(error(&plain, &right));
                saddle.motion(&s.force, &gamma, &mut plain)?;
                present = present.max(error(&plain, &right));
                m.b(&mut s);
                let residual = |&i: &usize| m.layout().velocity_residual(&s, i, &v).abs();
                left = e.kept.iter().map(residual).fold(left, f64::max);
            }
            m.rate(&q, &v, &mut rate);
            slopes.push([rate, a]);
        }
        for (k, x) in [&mut q, &mut v].into_iter().enumerate() {
            for (i, x) in x.iter_mut().enumerate() {
                let by = |stage: usize| slopes[stage][k][i];
                *x += STEPS.1 / 6.0 * (by(0) + 2.0 * (by(1) + by(2)) + by(3));
            }
        }
        t += STEPS.1;
        let mut d = vec![0.0; n];
        m.difference(&q, &p.q, &mut d);
        turned = turned.max(max_abs(&d));
    }
    println!(
        "{name:34} moved {turned:6.2}, {plans} new plans, v̇ {most:7.0e}, corrected {once:7.0e}, \
         without blocks {without:7.0e}, present {present:7.0e}, C·v {left:7.0e}"
    );
    Ok(true)
}

fn move_scene(name: &str, style: Style) -> Outcome<bool> {
    let p = scene(name)?;
    if p.mechanism.space().n_v() == 6 {
        move_on::<6>(name, &p, style)
    } else {
        move_on::<3>(name, &p, style)
    }
}

fn time_scene(name: &str, style: Style) -> Outcome<bool> {
    let p = scene(name)?;
    if p.mechanism.space().n_v() == 6 {
        time::<6>(name, &p, style)
    } else {
        time::<3>(name, &p, style)
    }
}

/// Prints how much of a closing row is left at the common ancestor of its bodies, relative to the
/// row, and the largest entry of `Sᵀ·(A − U·D⁻¹·Uᵀ)` relative to A.
fn transport<const N: usize>(name: &str, p: &PreparedMechanism, style: Style) -> Outcome<bool> {
    let m = &p.mechanism;
    let e = equations::<N>(p, style, 0.0)?;
    let mass = m.inertia(&e.s);
    let mut own = Condensation::<N>::new(&e.tree, &e.c, mass, &e.units, Treatment::Early)?;
    own.condense(&e.c, mass);
    let (mut left, mut most) = (0.0_f64, 0.0_f64);
    for block in &own.blocks {
        for slot in &own.slots[block.slots.clone()] {
            let mut row = 0.0_f64;
            for (entry, of) in own.closing.iter().map(|entry| (entry, entry.link as usize)) {
                if of == slot.link {
                    row = row.max(own.values[entry.value as usize].abs());
                }
            }
            left = left.max(max_abs(&slot.w) / row);
        }
    }
    for node in &own.nodes {
        let (m, free) = (node.m, N - node.m);
        let a = DMatrix::from_fn(N, N, |i, j| node.a[i][j]);
        let s = DMatrix::from_fn(N, free, |i, f| {
            if i < m {
                -node.c[i][m + f]
            } else {
                f64::from(u8::from(i - m == f))
            }
        });
        let u = &a * &s;
        let Some(inverse) = (s.transpose() * &u).try_inverse() else {
            continue;
        };
        let rest = s.transpose() * (&a - &u * inverse * u.transpose());
        if free > 0 {
            most = most.max(rest.amax() / a.amax());
        }
    }
    println!("{name:34} {left:8.1e} {most:8.1e}");
    Ok(true)
}

fn transport_scene(name: &str, style: Style) -> Outcome<bool> {
    let p = scene(name)?;
    if p.mechanism.space().n_v() == 6 {
        transport::<6>(name, &p, style)
    } else {
        transport::<3>(name, &p, style)
    }
}

/// Prints pivots and errors of v̇ along the motion of N parallelograms through their flat pose.
fn pivots(n: usize) -> Outcome<bool> {
    let p = drawn(&catalogue::parallelograms(n, [3, 4]))?;
    let m = &p.mechanism;
    let mut e = equations::<6>(&p, Style::ManyRows, 0.0)?;
    let (n_v, r) = (m.layout().n_v, e.c.nrows());
    let mut saddle = KeptRowSaddle::of_rows(&e.c, m.mass())?;
    let ways = [Treatment::NullSpace, Treatment::Schur, Treatment::Early];
    let planned = |e: &Equations| -> Outcome<Vec<Condensation<6>>> {
        let of = |way: &Treatment| {
            Condensation::<6>::new(&e.tree, &e.c, m.inertia(&e.s), &e.units, *way)
        };
        ways.iter().map(of).collect()
    };
    let mut own = planned(&e)?;
    let mut first = None;
    let mut plans = 0;
    println!(
        "     angle  pivots: present  reduced  of C  (…)/sin θ, relative to the first line  errors: present  null  Schur  early"
    );
    let before = (0..12).map(|k| 10.0_f64.powf(-1.0 - f64::from(k)));
    let after = before.clone().rev().map(|angle| -angle);
    let start = 0.8_f64.asin();
    for angle in [0.7].into_iter().chain(before).chain(after) {
        let (sin, cos) = (angle - start).sin_cos();
        let mut d = vec![0.0; n_v];
        for (body, d) in d.chunks_exact_mut(6).enumerate() {
            if body == 0 || body % 2 == 1 {
                // A crank rotates about its foot.
                let q = &p.q[7 * body..];
                let [x, y] = [q[0] - body.div_ceil(2) as f64, q[1]];
                (d[0], d[1]) = (cos * x - sin * y - x, sin * x + cos * y - y);
                d[5] = angle - start;
            } else {
                d[0] = 0.5 * (angle.cos() - start.cos());
                d[1] = 0.5 * (angle.sin() - start.sin());
            }
        }
        let mut q = p.q.clone();
        m.displace(&mut q, &d);
        m.pose(0.0, &q, &mut e.s);
        m.c(&mut e.s);
        e.c = sparse(m, &e.s, &e.kept)?;
        // All cranks rotate with the same speed.
        let mut v = vec![0.0; n_v];
        for (body, v) in v.chunks_exact_mut(6).enumerate() {
            let is_crank = body == 0 || body % 2 == 1;
            let arm = if is_crank { 0.25 } else { 0.5 };
            (v[0], v[1]) = (-arm * angle.sin(), arm * angle.cos());
            v[5] = if is_crank { 1.0 } else { 0.0 };
        }
        m.twist(&v, &mut e.s);
        m.gamma(&mut e.s);
        m.force(&mut e.s);
        let gamma: Vec<f64> = e.kept.iter().map(|&i| e.s.gamma[i]).collect();
        let mut right = vec![0.0; n_v];
        let mut lambda = vec![0.0; r];
        saddle.factor(|k| e.c.row(k).1, m.mass())?;
        let mut a = vec![0.0; n_v];
        saddle.motion(&e.s.force, &gamma, &mut a)?;
        let mut refinement = Refinement::new(n_v, r);
        let row = |k: usize| e.c.row(k).1;
        let refined = saddle.solve_refined(
            &mut refinement,
            row,
            &e.s.force,
            &gamma,
            &mut right,
            &mut lambda,
        );
        let mut errors = vec![error(&a, &right)];
        let is_good = own[0].factor(&e.c, m.inertia(&e.s)).unwrap_or(false);
        if !is_good {
            own = planned(&e)?;
            plans += 1;
        }
        for own in &mut own {
            a.fill(f64::NAN);
            let solved = own
                .factor(&e.c, m.inertia(&e.s))
                .and_then(|_| own.solve(&e.s.force, &gamma, &mut a, None));
            errors.push(if solved.is_ok() {
                error(&a, &right)
            } else {
                f64::NAN
            });
        }
        let (g, _) = own[0].scaled(&e.c, m.mass());
        let of_c = g.singular_values().min();
        let reduced = match &own[0].reduced {
            Reduced::NullSpace(saddle) => saddle.pivot_ratio(),
            _ => f64::NAN,
        };
        let pivots = [saddle.pivot_ratio(), reduced, of_c];
        let first = *first.get_or_insert(pivots);
        print!("{angle:10.1e}");
        pivots.iter().for_each(|x| print!(" {x:8.1e}"));
        (0..3).for_each(|k| print!(" {:8.4}", pivots[k] / first[k] / angle.sin().abs()));
        if refined.is_ok() {
            errors.iter().for_each(|x| print!(" {x:8.1e}"));
        } else {
            print!(" no reference");
        }
        println!();
    }
    println!("{plans} new plans");
    Ok(true)
}

const COUNTED: [&str; 9] = [
    "measured_null_space",
    "measured_schur",
    "measured_tree_null",
    "measured_tree_schur",
    "measured_early_null",
    "measured_early_schur",
    "measured_present_lambda",
    "measured_reactions",
    "measured_correction",
];

/// Counts instructions for each body by callgrind.
fn count(names: &[String], of: &str) -> Outcome<bool> {
    println!(
        "{:34} bod rows  free  z clos | null space  Schur | tree: null  Schur | early: null  Schur | λ: null      tree | correction",
        "instructions for each body"
    );
    let out = std::env::temp_dir().join(format!("condensation-{}", std::process::id()));
    for name in names {
        let run = Command::new("valgrind")
            .args(["--tool=callgrind", "--toggle-collect=*measured_*"])
            .arg(format!("--callgrind-out-file={}", out.display()))
            .arg(std::env::current_exe()?)
            .args(["run", of, name])
            .output()?;
        let sizes = String::from_utf8(run.stdout)?;
        let sizes: Vec<usize> = sizes
            .split_whitespace()
            .filter_map(|x| x.parse().ok())
            .collect();
        let [bodies, rows, free, z, closing] = sizes[..] else {
            println!("{name:34} {}", String::from_utf8_lossy(&run.stderr));
            continue;
        };
        let listed = Command::new("callgrind_annotate")
            .args(["--inclusive=yes", "--threshold=100"])
            .arg(&out)
            .output()?;
        let listed = String::from_utf8(listed.stdout)?;
        print!("{name:34} {bodies:3} {rows:4} {free:4} {z:4} {closing:4}");
        for (k, counted) in COUNTED.iter().enumerate() {
            let line = listed.lines().find(|line| line.contains(counted));
            let number = line.and_then(|line| line.split_whitespace().next());
            let number = number.and_then(|x| x.replace(',', "").parse::<f64>().ok());
            let separator = if k % 2 == 0 { " | " } else { " " };
            match number {
                Some(x) => print!("{separator}{:9.0}", x / (TIMES * bodies) as f64),
                None => print!("{separator}{:>9}", "–"),
            }
        }
        println!();
    }
    std::fs::remove_file(&out)?;
    Ok(true)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|argument| argument.to_string_lossy().into_owned())
        .collect();
    let style = match arguments.get(1).map(String::as_str) {
        Some("floating") => Style::Floating,
        Some("ground") => Style::OnGround,
        Some("decided") => Style::Decided,
        _ => Style::ManyRows,
    };
    let violated = arguments.get(1).is_some_and(|of| of == "violated");
    let checked = (style, if violated { 1e-3 } else { 0.0 });
    let of = arguments.get(1).map_or("rows", String::as_str);
    let names: Vec<String> = match arguments.get(2..) {
        Some(names) if !names.is_empty() => names.to_vec(),
        _ => SCENES.iter().map(|name| (*name).to_owned()).collect(),
    };
    let outcome = match (arguments.first().map(String::as_str), arguments.len()) {
        (Some("check"), 1 | 2) => check_all(checked),
        (Some("check"), _) => names.iter().try_fold(true, |is_good, name| {
            check_scene(name, checked).map(|x| x && is_good)
        }),
        (Some("pivots"), 2) => arguments[1]
            .parse()
            .map_err(Into::into)
            .and_then(|n: usize| pivots(n.clamp(1, 255))),
        (Some("transport"), _) => names.iter().try_fold(true, |is_good, name| {
            transport_scene(name, style).map(|x| x && is_good)
        }),
        (Some("motion"), _) => names.iter().try_fold(true, |is_good, name| {
            let moved = move_scene(name, style).unwrap_or_else(|error| {
                println!("{name:34} {error}");
                false
            });
            Ok(moved && is_good)
        }),
        (Some("time"), _) => names.iter().try_fold(true, |is_good, name| {
            time_scene(name, style).map(|x| x && is_good)
        }),
        (Some("run"), 3) => run_scene(&names[0], style),
        (Some("count"), _) => count(&names, of),
        _ => {
            eprintln!(
                "usage: condensation_by_tree check | count [rows | floating | ground [SCENE …]]"
            );
            return ExitCode::from(2);
        }
    };
    let is_good = outcome.unwrap_or_else(|error| {
        eprintln!("{error}");
        false
    });
    ExitCode::from(u8::from(!is_good))
}
