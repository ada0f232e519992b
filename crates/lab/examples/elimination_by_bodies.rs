//! Prototype of an elimination by bodies. It solves `M·v̇ + Cᵀ·λ = Q`, `C·v̇ = Γ` of a mechanism in
//! space; the number of operations for each body is constant for loops in a row or in a tower.
//!
//! | command | output |
//! | --- | --- |
//! | `check` | errors of v̇ and λ of this elimination and of the present solver, from solutions in double-double on the same rows |
//! | `pivots N` | smallest pivots of both along the motion of N parallelograms through their flat pose |
//!
//! # Equations
//!
//! Motions t are twists at one point of a block, in the axes of the ground, so that a rigid motion
//! is the same twist for all bodies. Body i has a joint to its parent p in a tree.
//!
//! - Joint: the LU factors of the rows C_i give free motions S_i and a particular motion d_i, and
//!   `t_i = t_p + d_i + S_i·z_i`.
//! - Closing row, with a wrench w on a body: `G_i = ± w·S_i` for the joints i on the path between
//!   its bodies, and `G·z = γ = Γ − Σ ± w·d_i`.
//! - Free motions: `z = z₀ + N·u`, `G·N = 0`, `T_i = T_p + S_i·N_i`, `m = Σ T_iᵀ·I_i·T_i`.
//! - Block on a base: inertia `Σ I_i − P·m⁻¹·Pᵀ` with `P = Σ I_i·T_i`, and the corresponding
//!   wrench.
//! - λ: `h_i = S_iᵀ·f_i` with the sum f_i of `Q − M·v̇` over the bodies behind joint i, `Gᵀ·μ = h`,
//!   and `C_iᵀ·λ_i` is the rest of f_i.
//!
//! A second way, which is not in this file, solves blocks with `40·k² > 1500 + 25·r²`, where k is
//! the number of free motions and r the number of rows of G. From the last joints to the base it
//! computes `U = A·S`, `D = Sᵀ·U`, `g = Gᵀ + Sᵀ·W`, `φ = Sᵀ·(f − A·d)`, and adds `A − U·D⁻¹·Uᵀ`,
//! `W − U·D⁻¹·g` and `f − A·d − U·D⁻¹·φ` to A, W and f of the parent. A is at first the inertia of
//! the body, W is zero. Then `H = Σ gᵀ·D⁻¹·g`, `H·μ = Σ (Wᵀ·d + gᵀ·D⁻¹·φ) − γ`, and back to the
//! last joints `z = D⁻¹·(φ − g·μ − Uᵀ·t_p)`. On a base, W also adds `W·H⁻¹·Wᵀ` to the
//! inertia and `−W·μ` to the wrench, and the acceleration a of the base adds `Wᵀ·a` to `H·μ`.
//!
//! Source: W. Jerkovsky, The structure of multibody dynamics equations, J. Guidance and Control 1
//! (1978) 173–182, and S. S. Kim, M. J. Vanderploeg, A general and efficient method for dynamic
//! analysis of mechanical systems using velocity transformations, J. Mech. Trans. Autom. Des. 108
//! (1986) 176–182, for the null space; R. Featherstone, The calculation of robot dynamics using
//! articulated-body inertias, Int. J. Robotics Research 2 (1983) 13–30, for bases and the second
//! way.
//!
//! # Corrections of the design
//!
//! 1. A body follows its parent by the rigid motion and not by the smallest v_i that satisfies the
//!    joint. Otherwise a closing row does not vanish at the common ancestor of its bodies.
//! 2. Joints have LU factors with planned pivots, 272 instructions for five rows with S, instead of
//!    QR factors, 564. Entries of S above 20 require new pivots.
//! 3. The mechanism is divided at bodies that separate it. Each block has its own G and k. A
//!    finished block is an inertia and a wrench on its base. Open chains are the articulated body
//!    algorithm, and a free body has `S = 1`.
//! 4. Pivots of G are compared with the rows of C. At a flat pose a whole row of G vanishes, and
//!    its ratio to its own entries stays at 0.5. With rows of C, the ratio of the pivot and sin θ
//!    is constant down to θ = 1e-12 on both sides. The sign of the pivots of joints and of
//!    `det [G; B·T]` is the present orientation, for a frame B of velocities of the bodies.
//! 5. Redundant rows are rows of G, so that the rank of C is Σ m + rank G. With N parallelograms G
//!    has 5·N rows and 2·N + 1 columns; 2·N rows are independent.
//!
//! # Measurements
//!
//! Instructions of a right-hand side for each body. They were counted in a form of this program
//! with arrays of fixed size, without allocation: the rows of C in one array in the order of
//! elimination, a list of places of the entries of C, joints compiled for each number of rows, and
//! bodies without mounted blocks with mass and tensor of inertia instead of a 6 × 6 matrix.
//!
//! | mechanism | present | by bodies |
//! | --- | --- | --- |
//! | row of 1, 16, 64, 256 parallelograms | 6912, 7686, 7335, 7430 | 4568, 4805, 4813, 4868 |
//! | tower of 16, 64, 256 four-bars | 20 898, 17 898, 17 997 | 4730, 4785, 4788 |
//! | robot, hexapod, 6-UPS, Delta | 8993, 8730, 13 260, 11 311 | 6024, 6251, 8526, 5712 |
//! | Bennett, Bricard, ring of 20 revolute joints | 7161, 7187, 26 977 | 4568, 4475, 6049 |
//! | lattice 2 × 2, 4 × 4, 6 × 6, 9 × 9 | 11 800, 19 200, 28 800, 22 400 | 5700, 8500, 11 500, 17 200 |
//! | free bodies, without a special case | 2518 | 7457 |
//!
//! The elimination is worse in these cases: if constraints are violated by δ, v̇ differs by O(δ),
//! because rows are transformed to the axes of the ground (one correction with the residual of C
//! gains 2 to 2.5 digits); at 1e6 m from the origin the error of λ is 3.5e-9 (arms should follow
//! from the joints); for open spherical chains whose masses grow by 1e12 towards the tip it is 5e-5
//! (the refined solver remains); lattices with more than 25 to 30 free motions are slower.
//!
//! # Order of the port
//!
//! `TallLu` with scales of rows and without masses; joints and inertias in `linalg`; planning; one
//! block on the ground as a solver; blocks on bases, free bodies and the second way; arms from
//! joints and one correction; kernels that write the blocks of bodies; the plane; certificate and
//! start.
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::cmp::Reverse;
use std::error::Error;
use std::iter::successors;
use std::ops::Range;
use std::process::ExitCode;

use dynamics::{KeptRowMotion, PreparedMechanism};
use joints::space3::Pose;
use lab::fuzz::space::text::Precision;
use lab::fuzz::space::{Drawing, catalogue, description};
use lab::mechanisms::space::{RollingDisk, bennett, bricard, top};
use lab::stress::motion;
use linalg::kernels::max_abs;
use linalg::{DisjointSets, KeptRowSaddle, Refinement, SparseMatrix};
use model::{BodyRef, Mechanism, Scratch, SpatialDescription, System};
use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Matrix6xX, Vector3, Vector6};

type Outcome<T> = Result<T, Box<dyn Error>>;
type Vector = DVector<f64>;
type Matrix = DMatrix<f64>;
/// A twist (v, ω) or a wrench (f, τ).
type Screw = Vector6<f64>;
type Inertia = Matrix6<f64>;
/// Twists or wrenches, one in each column.
type Screws = Matrix6xX<f64>;

/// The parent of bodies that are joined to the ground, and the base of their blocks.
const GROUND: usize = usize::MAX;
/// G is eliminated as a dense matrix up to this number of entries. `KeptRowSaddle` eliminates
/// larger matrices, but it does not compare pivots with the rows of C.
const DENSE: usize = 600;
/// Largest entry of S in units of the body. A larger entry requires other pivots of the joint.
const LARGEST: f64 = 20.0;
/// Smallest pivot of a joint of the tree, relative to the largest entry of its row of C.
const JOINED: f64 = 0.05;
/// A pivot of G is replaced if it is below this part of the largest entry of its row.
const REPLACED: f64 = 0.05;
/// Rows of G whose pivots are at most this part of their rows of C are redundant.
const INDEPENDENT: f64 = 1e-7;
/// Pivots within this factor are equal, so that rounding does not choose between them.
const TIE: f64 = 1.0 + 1e-9;

/// Error message of triangular solutions.
const ZERO: &str = "a pivot is zero";

/// Chooses rows and columns by complete pivoting, until the pivots are at most `least`. Returns the
/// rows in the order of elimination, and all columns, pivots first.
fn complete_pivoting(mut a: Matrix, least: f64) -> [Vec<usize>; 2] {
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
            (k..n).for_each(|j| a[(i, j)] -= l * a[(k, j)]);
        }
    }
    [rows, column]
}

/// `A·P = L·U` for r rows with n columns. The first r columns of U contain the pivots.
#[derive(Clone, Default)]
struct PivotedLu {
    /// The column of A at each position.
    column: Vec<usize>,
    l: Matrix,
    u: Matrix,
}

impl PivotedLu {
    /// Factors the rows. If scales are given, the function replaces small pivots, and returns the
    /// smallest ratio of a pivot to the scale of its row.
    fn factor(&mut self, a: &Matrix, scale: Option<&[f64]>) -> f64 {
        let (r, n) = a.shape();
        let mut u = a.select_columns(&self.column);
        self.l = DMatrix::identity(r, r);
        let mut smallest = f64::INFINITY;
        for j in 0..r {
            for k in 0..j {
                let l = u[(j, k)] / u[(k, k)];
                self.l[(j, k)] = l;
                (k..n).for_each(|c| u[(j, c)] -= l * u[(k, c)]);
            }
            if let Some(scale) = scale {
                let best = j + u.view((j, j), (1, n - j)).icamax_full().1;
                let largest = u[(j, best)].abs();
                smallest = smallest.min(largest / scale[j]);
                if u[(j, j)].abs() < REPLACED * largest {
                    u.swap_columns(j, best);
                    self.column.swap(j, best);
                }
            }
        }
        self.u = u;
        smallest
    }

    fn pivots(&self) -> Matrix {
        self.u.columns(0, self.u.nrows()).into_owned()
    }

    /// Solves `A·x = gamma`, where unknowns without a pivot are zero.
    fn particular(&self, gamma: &Vector) -> Outcome<Vector> {
        let y = self.l.solve_lower_triangular(gamma).ok_or(ZERO)?;
        let y = self.pivots().solve_upper_triangular(&y).ok_or(ZERO)?;
        let mut x = DVector::zeros(self.column.len());
        self.column.iter().zip(&y).for_each(|(&c, y)| x[c] = *y);
        Ok(x)
    }

    /// Returns a basis of the null space of A, where one unknown without a pivot is one, and the
    /// others are zero.
    fn null_space(&self) -> Outcome<Matrix> {
        let (r, n) = self.u.shape();
        let (u, mut x) = (self.u.columns(r, n - r), DMatrix::zeros(n, n - r));
        let y = self.pivots().solve_upper_triangular(&u).ok_or(ZERO)?;
        (0..r).for_each(|p| x.set_row(self.column[p], &-y.row(p)));
        (r..n).for_each(|p| x[(self.column[p], p - r)] = 1.0);
        Ok(x)
    }

    /// Solves the equations `Aᵀ·mu = h` of the pivots.
    fn multipliers(&self, h: &Vector) -> Outcome<Vector> {
        let h = DVector::from_fn(self.u.nrows(), |p, _| h[self.column[p]]);
        let y = self.pivots().tr_solve_upper_triangular(&h).ok_or(ZERO)?;
        Ok(self.l.tr_solve_lower_triangular(&y).ok_or(ZERO)?)
    }
}

// The tree.

/// A body with the joint to its parent in the tree, and their values at a configuration. Motions
/// are twists (v, ω), and forces are wrenches (f, τ), at the origin of the block, in the axes of
/// the ground. Values "of the body" are in its columns of C: v in the axes of the ground, ω in the
/// axes of the body.
#[derive(Clone, Default)]
struct Node {
    body: usize,
    parent: usize,
    depth: usize,
    /// Rows of C of the joint in the order of elimination, and their factors.
    rows: Vec<usize>,
    joint: PivotedLu,
    /// First of the unknowns of the joint in its block.
    first: usize,
    /// Units of the columns of the body: 1, and a reciprocal of a length (1/m) for the angular
    /// columns.
    units: Vector6<f64>,
    /// `diag(1, R)`, and the matrix B from motions to velocities of the body, with its inverse.
    frame: Matrix6<f64>,
    b: Matrix6<f64>,
    b_inverse: Matrix6<f64>,
    /// Inertia of the body with the blocks that are mounted on it, in the columns of the body.
    carried: Inertia,
    /// The same inertia for motions.
    inertia: Inertia,
    /// Free motions of the joint, particular motion of the joint, and motion of the body.
    s: Screws,
    particular: Screw,
    motion: Screw,
    /// Acceleration and force of the body. The force contains the forces of mounted blocks.
    acceleration: Screw,
    force: Screw,
    /// The force at the origin of the block.
    wrench: Screw,
}

impl Node {
    /// Creates the node of a free body.
    fn free(m: &Mechanism, size: f64, body: usize) -> Self {
        let reach = Some(m.reach(body)).filter(|reach| m.is_length(body, *reach));
        let length = reach.map_or(size, |reach| reach.min(size));
        let unit = (-length.log2().round()).exp2();
        let mut node = Self::default();
        (node.body, node.parent) = (body, GROUND);
        node.joint.column = Vec::from_iter(0..6);
        node.units = Vector6::new(1.0, 1.0, 1.0, unit, unit, unit);
        node
    }

    fn n_free(&self) -> usize {
        6 - self.rows.len()
    }

    /// Returns row `i` of C in the columns of the body, in their units.
    fn row(&self, m: &Mechanism, s: &Scratch, i: usize) -> Screw {
        let mut row = Vector6::zeros();
        for (column, c) in m.layout().row(s, i) {
            if column / 6 == self.body {
                row[column % 6] += c * self.units[column % 6];
            }
        }
        row
    }

    fn joint_rows(&self, m: &Mechanism, s: &Scratch) -> Matrix {
        let rows: Vec<_> = self.rows.iter().map(|&i| self.row(m, s, i)).collect();
        DMatrix::from_fn(rows.len(), 6, |k, c| rows[k][c])
    }

    /// Plans the elimination of the joint. Returns whether all pivots are above a limit.
    fn plan(&mut self, m: &Mechanism, s: &Scratch, least: f64) -> bool {
        let mut rows = self.joint_rows(m, s);
        for mut row in rows.row_iter_mut() {
            row /= row.amax().max(f64::MIN_POSITIVE);
        }
        let [order, column] = complete_pivoting(rows, least);
        let is_complete = order.len() == self.rows.len();
        if is_complete {
            self.rows = order.iter().map(|&k| self.rows[k]).collect();
            self.joint.column = column;
        }
        is_complete
    }

    /// Factors the rows of the joint. Returns whether no entry of S is too large.
    fn factor(&mut self, m: &Mechanism, s: &Scratch) -> bool {
        self.joint.factor(&self.joint_rows(m, s), None);
        let Ok(free) = self.joint.null_space() else {
            return false;
        };
        self.s = self.b_inverse * Matrix6::from_diagonal(&self.units) * &free;
        free.iter().all(|x| x.abs() <= LARGEST)
    }

    /// Computes all values at a configuration except those of other bodies.
    fn set(&mut self, m: &Mechanism, s: &Scratch, q: &[f64], origin: Vector3<f64>) -> Outcome<()> {
        let r = Matrix3::from(pose(q, self.body).rot).transpose();
        let arm = (Vector3::from(pose(q, self.body).r) - origin).cross_matrix();
        self.frame = upper(Matrix3::zeros(), r);
        self.b_inverse = upper(arm * r, r);
        self.b = upper(-arm, r.transpose());
        let mass = &m.mass()[6 * self.body..][..6];
        self.carried = Matrix6::from_diagonal(&Vector6::from_column_slice(mass));
        if self.factor(m, s) || self.plan(m, s, 0.0) && self.factor(m, s) {
            return Ok(());
        }
        Err(format!("the joint of body {} is singular", self.body).into())
    }
}

/// Returns `[1 a; 0 r]`.
fn upper(a: Matrix3<f64>, r: Matrix3<f64>) -> Matrix6<f64> {
    let mut out = Matrix6::identity();
    out.fixed_view_mut::<3, 3>(0, 3).copy_from(&a);
    out.fixed_view_mut::<3, 3>(3, 3).copy_from(&r);
    out
}

fn pose(q: &[f64], body: usize) -> Pose {
    let q = &q[7 * body..][..7];
    Pose::new([q[0], q[1], q[2]], [q[3], q[4], q[5], q[6]])
}

/// Returns the nodes from a node up to another node, which is excluded.
fn path(nodes: &[Node], from: usize, to: usize) -> Vec<usize> {
    let above = |&x: &usize| (x != GROUND).then(|| nodes[x].parent);
    let path = successors(Some(from), above);
    path.take_while(|&x| x != to && x != GROUND).collect()
}

/// Returns the tree, parents first, and the other joints and drives. Joints with many rows come
/// first, then joints near the ground.
fn spanning_tree(m: &Mechanism, size: f64, s: &Scratch) -> (Vec<Node>, Vec<usize>) {
    let (count, groups) = (m.bodies().len(), &m.layout().groups);
    let (mut nodes, mut node_of) = (Vec::<Node>::new(), vec![None; count]);
    let mut closing = Vec::from_iter(0..groups.len());
    while let Some(unreached) = node_of.iter().position(Option::is_none) {
        let of = |x: BodyRef| x.moving().map_or(Some(GROUND), |body| node_of[body]);
        let joints = groups.iter().enumerate().filter_map(|(id, group)| {
            let [a, b] = match group.bodies[..] {
                [a, b] => [a, b],
                [b] => [BodyRef::Ground, b],
                _ => return None,
            };
            let (parent, outer) = match (of(a), of(b)) {
                (Some(parent), None) => (parent, b),
                (None, Some(parent)) => (parent, a),
                _ => return None,
            };
            let mut node = Node::free(m, size, outer.moving()?);
            node.parent = parent;
            node.depth = nodes.get(parent).map_or(0, |parent| parent.depth + 1);
            node.rows = group.rows.iter().collect();
            let is_good = !group.is_drive() && node.rows.len() <= 6 && node.plan(m, s, JOINED);
            is_good.then_some((id, node))
        });
        let best = joints.max_by_key(|(id, x)| (x.rows.len(), Reverse((x.depth, *id))));
        closing.retain(|id| best.as_ref().is_none_or(|best| best.0 != *id));
        let node = best.map_or_else(|| Node::free(m, size, unreached), |best| best.1);
        node_of[node.body] = Some(nodes.len());
        nodes.push(node);
    }
    (nodes, closing)
}

// Closing rows.

/// A row of G: a row of C that closes loops.
struct ClosingRow {
    row: usize,
    parts: Vec<Part>,
}

/// A body on which a closing row acts, with its row of C as a wrench.
#[derive(Clone)]
struct Part {
    node: usize,
    /// The nodes between the body and the base with their signs.
    path: Vec<(usize, f64)>,
    wrench: Screw,
}

impl ClosingRow {
    /// Calls a function for each node of the paths, with the wrench on the node.
    fn for_each(&self, mut f: impl FnMut(usize, Screw)) {
        for part in &self.parts {
            for &(x, sign) in &part.path {
                f(x, sign * part.wrench);
            }
        }
    }
}

/// G and its factors.
#[derive(Default)]
struct ClosingRows {
    rows: Vec<ClosingRow>,
    g: Matrix,
    /// Largest entry of each row of C. It is the reference of pivots, because a row of G may vanish
    /// completely at a singular configuration.
    scale: Vec<f64>,
    lu: PivotedLu,
    /// Replaces `lu` if G is large.
    sparse: Option<KeptRowSaddle>,
    /// Smallest pivot.
    pivot: f64,
}

impl ClosingRows {
    /// Computes G: the sum of `sign·wrench·S` over the nodes of the paths.
    fn fill(&mut self, m: &Mechanism, s: &Scratch, nodes: &[Node], n: usize) {
        self.g = DMatrix::zeros(self.rows.len(), n);
        self.scale = vec![f64::MIN_POSITIVE; self.rows.len()];
        for (i, row) in self.rows.iter_mut().enumerate() {
            for part in &mut row.parts {
                let node = &nodes[part.node];
                let c = node.row(m, s, row.row);
                self.scale[i] = self.scale[i].max(c.amax());
                part.wrench = node.b.tr_mul(&c.component_div(&node.units));
            }
            row.for_each(|x, wrench| {
                let (node, n_free) = (&nodes[x], nodes[x].n_free());
                let mut g = self.g.view_mut((i, node.first), (1, n_free));
                g += wrench.tr_mul(&node.s);
            });
        }
    }

    /// Keeps independent rows, in the order of elimination.
    fn choose(&mut self) {
        let (m, n) = self.g.shape();
        let g = DMatrix::from_fn(m, n, |i, z| self.g[(i, z)] / self.scale[i]);
        let [order, column] = complete_pivoting(g, INDEPENDENT);
        self.lu.column = column;
        let mut all: Vec<_> = self.rows.drain(..).map(Some).collect();
        self.rows = order.iter().filter_map(|&i| all[i].take()).collect();
    }

    fn factor(&mut self) -> Outcome<()> {
        let (r, n) = self.g.shape();
        if n * r <= DENSE {
            self.pivot = self.lu.factor(&self.g, Some(&self.scale));
            return Ok(());
        }
        let g = &self.g;
        let all = |i| (0..n).map(move |z| (z, g[(i, z)]));
        let row = |i| all(i).filter(|(_, x)| *x != 0.0);
        let g = SparseMatrix::from_rows(n, (0..r).map(row))?;
        let saddle = KeptRowSaddle::of_rows(&g, &vec![1.0; n][..])?;
        self.pivot = saddle.pivot_ratio();
        self.sparse = Some(saddle);
        Ok(())
    }

    fn null_space(&self) -> Outcome<Matrix> {
        let Some(saddle) = &self.sparse else {
            return self.lu.null_space();
        };
        let (r, n) = self.g.shape();
        let mut frame = DMatrix::zeros(n, n - r);
        saddle.null_frame(frame.as_mut_slice());
        Ok(frame)
    }

    fn particular(&mut self, gamma: &Vector) -> Outcome<Vector> {
        let Some(saddle) = &mut self.sparse else {
            return self.lu.particular(gamma);
        };
        let mut x = DVector::zeros(self.g.ncols());
        saddle.complete(gamma.as_slice(), x.as_mut_slice())?;
        Ok(x)
    }

    fn multipliers(&mut self, h: &Vector) -> Outcome<Vector> {
        let Some(saddle) = &mut self.sparse else {
            return self.lu.multipliers(h);
        };
        let (mut mu, zeros) = (DVector::zeros(self.g.nrows()), vec![0.0; h.len()]);
        saddle.multipliers(h.as_slice(), &zeros, mu.as_mut_slice())?;
        Ok(mu)
    }
}

// Blocks.

/// Bodies that no single body separates, mounted on the body `base`. The free motions of the block
/// are vectors N of the null space of G.
#[derive(Default)]
struct Block {
    base: usize,
    nodes: Range<usize>,
    /// Number of unknowns of the joints.
    n: usize,
    g: ClosingRows,
    /// Motions `T = S·N` of each node and momenta of the block for the free motions.
    t: Vec<Screws>,
    p: Screws,
    /// Inverse of the reduced mass, and forces on the free motions.
    mass: Matrix,
    force: Vector,
}

impl Block {
    /// Returns the position of the parent in the block, if the parent is not the base.
    fn inner(&self, node: &Node) -> Option<usize> {
        (node.parent != self.base).then(|| node.parent - self.nodes.start)
    }

    /// Factors G and the reduced mass, and returns the inertia of the block for its base.
    fn factor(&mut self, m: &Mechanism, s: &Scratch, nodes: &mut [Node]) -> Outcome<Inertia> {
        self.g.fill(m, s, nodes, self.n);
        self.g.factor()?;
        let null_space = self.g.null_space()?;
        let k = null_space.ncols();
        let (mut whole, mut mass) = (Matrix6::zeros(), DMatrix::zeros(k, k));
        self.t.clear();
        self.p = Matrix6xX::zeros(k);
        for node in &mut nodes[self.nodes.clone()] {
            node.inertia = node.b.tr_mul(&node.carried) * node.b;
            let mut t = &node.s * null_space.rows(node.first, node.n_free());
            if let Some(parent) = self.inner(node) {
                t += &self.t[parent];
            }
            let momentum = node.inertia * &t;
            mass += t.tr_mul(&momentum);
            self.p += momentum;
            self.t.push(t);
            whole += node.inertia;
        }
        let inverse = Cholesky::new(mass).map(|mass| mass.inverse());
        self.mass = inverse.ok_or("the reduced mass is not positive definite")?;
        Ok(whole - &self.p * &self.mass * self.p.transpose())
    }

    /// First half of a solution: computes a particular motion and the forces on the free motions.
    /// Returns the wrench on the base.
    fn inward(&mut self, nodes: &mut [Node], gamma: &[f64]) -> Outcome<Screw> {
        let left = |row: &ClosingRow| {
            let mut left = gamma[row.row];
            row.for_each(|x, wrench| left -= wrench.dot(&nodes[x].particular));
            left
        };
        let gamma = self.g.rows.iter().map(left);
        let z = self.g.particular(&Vector::from_vec(gamma.collect()))?;
        let mut on_base = Vector6::zeros();
        self.force = DVector::zeros(self.p.ncols());
        for (x, t) in self.nodes.clone().zip(&self.t) {
            let node = &nodes[x];
            let mut motion = node.particular + &node.s * z.rows(node.first, node.n_free());
            if let Some(parent) = self.inner(node) {
                motion += nodes[self.nodes.start + parent].motion;
            }
            let left = node.b.tr_mul(&node.force) - node.inertia * motion;
            self.force += t.tr_mul(&left);
            on_base += left;
            nodes[x].motion = motion;
        }
        Ok(on_base - &self.p * (&self.mass * &self.force))
    }

    /// Second half of a solution: computes the accelerations.
    fn outward(&mut self, nodes: &mut [Node]) {
        let base = nodes.get(self.base);
        let of_base = base.map_or_else(Vector6::zeros, |base| base.frame * base.acceleration);
        let u = &self.mass * (&self.force - self.p.tr_mul(&of_base));
        for (node, t) in nodes[self.nodes.clone()].iter_mut().zip(&self.t) {
            node.motion += of_base + t * &u;
            node.acceleration = node.b * node.motion;
        }
    }

    /// Computes λ from the forces without accelerations, and returns the wrench on the base.
    fn multipliers(&mut self, nodes: &mut [Node], lambda: &mut [f64]) -> Outcome<Screw> {
        let (mut h, mut on_base) = (DVector::zeros(self.n), Vector6::zeros());
        for node in &mut nodes[self.nodes.clone()] {
            node.wrench = node.b.tr_mul(&node.force);
        }
        for x in self.nodes.clone().rev() {
            let (node, wrench) = (&nodes[x], nodes[x].wrench);
            let mut of_joint = h.rows_mut(node.first, node.n_free());
            of_joint.copy_from(&node.s.tr_mul(&wrench));
            match self.inner(node) {
                Some(parent) => nodes[self.nodes.start + parent].wrench += wrench,
                None => on_base += wrench,
            }
        }
        let mu = self.g.multipliers(&h)?;
        for (mu, row) in mu.iter().zip(&self.g.rows) {
            lambda[row.row] = *mu;
            row.for_each(|x, wrench| nodes[x].wrench -= wrench * *mu);
        }
        for node in &nodes[self.nodes.clone()] {
            let h = node.b_inverse.tr_mul(&node.wrench);
            let h = h.component_mul(&node.units);
            let own = node
                .joint
                .multipliers(&Vector::from_column_slice(h.as_slice()))?;
            (0..own.len()).for_each(|k| lambda[node.rows[k]] = own[k]);
        }
        Ok(on_base)
    }
}

/// The equations of a mechanism, eliminated body by body.
struct Elimination {
    nodes: Vec<Node>,
    blocks: Vec<Block>,
}

impl Elimination {
    /// Plans the elimination at a configuration. `s` contains C.
    fn new(p: &PreparedMechanism, s: &Scratch) -> Outcome<Self> {
        let (m, groups) = (&p.mechanism, &p.mechanism.layout().groups);
        let (tree, closing_groups) = spanning_tree(m, p.assembly.size, s);
        let count = tree.len();
        let mut node_of = vec![GROUND; count];
        (0..count).for_each(|x| node_of[tree[x].body] = x);
        // A constraint joins the nodes on the paths between its bodies to one block.
        let mut sets = DisjointSets::new(count);
        let mut closing = Vec::new();
        for group in closing_groups.into_iter().map(|id| &groups[id]) {
            let of = |x: &BodyRef| x.moving().map_or(GROUND, |body| node_of[body]);
            let mut ends: Vec<usize> = group.bodies.iter().map(of).collect();
            ends.sort_unstable();
            ends.dedup();
            if ends.len() == 1 {
                ends.push(GROUND);
            }
            let above = |x: usize| path(&tree, x, GROUND);
            let is_common = |x: &usize| ends.iter().all(|&end| above(end).contains(x));
            let common = above(ends[0]).into_iter().find(is_common).unwrap_or(GROUND);
            let touched: Vec<usize> = ends.iter().flat_map(|&x| path(&tree, x, common)).collect();
            if let Some(&first) = touched.first() {
                touched.iter().for_each(|&x| sets.join(first, x));
                closing.push((group, ends, common, first));
            }
        }
        // Nodes are ordered by blocks. The base of a block precedes its nodes.
        let sets = sets.sets();
        let (order, mut new_of) = (sets.concat(), vec![0; count]);
        (0..count).for_each(|new| new_of[order[new]] = new);
        let renamed = |x: usize| new_of.get(x).copied().unwrap_or(GROUND);
        let (mut nodes, mut blocks) = (Vec::<Node>::new(), Vec::<Block>::new());
        for set in &sets {
            let (start, mut n) = (nodes.len(), 0);
            for &old in set {
                let mut node = tree[old].clone();
                (node.parent, node.first) = (renamed(node.parent), n);
                n += node.n_free();
                nodes.push(node);
            }
            let (base, nodes) = (nodes[start].parent, start..nodes.len());
            let mut block = Block::default();
            (block.base, block.nodes, block.n) = (base, nodes, n);
            blocks.push(block);
        }
        for (group, ends, common, first) in closing {
            let (common, first) = (renamed(common), renamed(first));
            let ends: Vec<usize> = ends.into_iter().map(renamed).collect();
            let steps = |x: usize, sign: f64| -> Vec<(usize, f64)> {
                let path = path(&nodes, x, common).into_iter();
                path.map(|x| (x, sign)).collect()
            };
            // If two bodies move as one rigid body, the row does not change. Thus the wrenches on
            // both bodies are opposite, and the row of one body is sufficient.
            let own: Vec<usize> = ends
                .iter()
                .copied()
                .filter(|x| ![GROUND, common].contains(x))
                .collect();
            let paths = match own[..] {
                [a, b] if ends.len() == 2 => vec![(b, [steps(b, 1.0), steps(a, -1.0)].concat())],
                _ => own.iter().map(|&x| (x, steps(x, 1.0))).collect(),
            };
            let wrench = Vector6::zeros();
            let part = |(node, path)| Part { node, path, wrench };
            let parts: Vec<Part> = paths.into_iter().map(part).collect();
            for block in blocks.iter_mut().filter(|b| b.nodes.contains(&first)) {
                for row in group.rows.iter() {
                    let parts = parts.clone();
                    block.g.rows.push(ClosingRow { row, parts });
                }
            }
        }
        let mut this = Self { nodes, blocks };
        this.set_nodes(m, &p.q, s)?;
        for block in &mut this.blocks {
            block.g.fill(m, s, &this.nodes, block.n);
            block.g.choose();
        }
        Ok(this)
    }

    fn set_nodes(&mut self, m: &Mechanism, q: &[f64], s: &Scratch) -> Outcome<()> {
        for block in &self.blocks {
            let origin = self
                .nodes
                .get(block.base)
                .unwrap_or(&self.nodes[block.nodes.start]);
            let origin = Vector3::from(pose(q, origin.body).r);
            for node in &mut self.nodes[block.nodes.clone()] {
                node.set(m, s, q, origin)?;
            }
        }
        Ok(())
    }

    /// Factors the equations at a configuration. `s` contains C.
    fn factor(&mut self, m: &Mechanism, q: &[f64], s: &Scratch) -> Outcome<()> {
        self.set_nodes(m, q, s)?;
        for block in self.blocks.iter_mut().rev() {
            let inertia = block.factor(m, s, &mut self.nodes)?;
            if let Some(base) = self.nodes.get_mut(block.base) {
                base.carried += base.frame.tr_mul(&inertia) * base.frame;
            }
        }
        Ok(())
    }

    /// Solves `M·a + Cᵀ·λ = force`, `C·a = gamma` for a.
    fn solve(&mut self, force: &[f64], gamma: &[f64], a: &mut [f64]) -> Outcome<()> {
        for node in &mut self.nodes {
            node.force = Vector6::from_column_slice(&force[6 * node.body..][..6]);
            let of_rows = node.rows.iter().map(|&i| gamma[i]).collect();
            let x = node.joint.particular(&Vector::from_vec(of_rows))?;
            node.particular = node.b_inverse * node.units.component_mul(&x.fixed_rows::<6>(0));
        }
        for block in self.blocks.iter_mut().rev() {
            let on_base = block.inward(&mut self.nodes, gamma)?;
            if let Some(base) = self.nodes.get_mut(block.base) {
                base.force += base.frame.tr_mul(&on_base);
            }
        }
        for block in &mut self.blocks {
            block.outward(&mut self.nodes);
        }
        for node in &self.nodes {
            a[6 * node.body..][..6].copy_from_slice(node.acceleration.as_slice());
        }
        Ok(())
    }

    /// Computes λ of the last solution, which had these forces.
    fn multipliers(&mut self, m: &Mechanism, force: &[f64], lambda: &mut [f64]) -> Outcome<()> {
        for node in &mut self.nodes {
            for (k, x) in node.force.iter_mut().enumerate() {
                let column = 6 * node.body + k;
                *x = force[column] - m.mass()[column] * node.acceleration[k];
            }
        }
        for block in self.blocks.iter_mut().rev() {
            let on_base = block.multipliers(&mut self.nodes, lambda)?;
            if let Some(base) = self.nodes.get_mut(block.base) {
                base.force += base.frame.tr_mul(&on_base);
            }
        }
        Ok(())
    }

    /// Returns the rows of C that are kept, in ascending order.
    fn kept(&self) -> Vec<usize> {
        let of_tree = self.nodes.iter().flat_map(|node| node.rows.iter().copied());
        let of_g = self.blocks.iter().flat_map(|block| &block.g.rows);
        let mut kept: Vec<usize> = of_tree.chain(of_g.map(|row| row.row)).collect();
        kept.sort_unstable();
        kept
    }

    /// Returns the smallest pivot of G.
    fn pivot(&self) -> f64 {
        let pivots = self.blocks.iter().map(|block| block.g.pivot);
        pivots.fold(f64::INFINITY, f64::min)
    }
}

// Scenes and commands.

/// Largest error of v̇ that `check` accepts. The largest error of the scenes is 6e-15.
const BOUND: f64 = 1e-13;

fn described(d: &SpatialDescription) -> Outcome<PreparedMechanism> {
    motion::prepared(d).map_err(|outcome| format!("{outcome:?}").into())
}

fn drawn(drawing: &Drawing) -> Outcome<PreparedMechanism> {
    let mut d = description(drawing, &Precision::default())?;
    d.gravity = [0.3, -9.81, 1.0];
    described(&d)
}

/// Checks all scenes, and returns whether all errors are small.
fn check_all() -> Outcome<bool> {
    println!("errors of                                                    v̇               λ");
    println!(
        "scene                          bodies   G   k blocks   pivot  bodies present  bodies present"
    );
    let disk = RollingDisk {
        tilt: 1.2,
        precession: 0.8,
    };
    let mut scenes = vec![
        ("heavy top".to_owned(), described(&top())?),
        ("Bricard of A04".to_owned(), described(&bricard())?),
        ("Bennett, rotated".to_owned(), described(&bennett()?)?),
        ("rolling disk".to_owned(), described(&disk.description())?),
    ];
    for (name, drawing) in catalogue::all() {
        scenes.push((name.to_owned(), drawn(&drawing)?));
    }
    for n in [1, 4, 16, 64] {
        let row = drawn(&catalogue::parallelograms(n, [3, 4]))?;
        let tower = drawn(&catalogue::four_bars_in_a_row(n))?;
        scenes.push((format!("row of {n}"), row));
        scenes.push((format!("tower of {n}"), tower));
    }
    let mut is_good = true;
    for (name, prepared) in &scenes {
        is_good &= check(name, prepared)?;
    }
    Ok(is_good)
}

/// Returns the largest difference, relative to the right values if these are above one.
fn error(found: &[f64], right: &[f64]) -> f64 {
    let difference = found.iter().zip(right).map(|(a, b)| (a - b).abs());
    // A NaN is an error.
    difference.fold(0.0, |e, x| if x <= e { e } else { x }) / max_abs(right).max(1.0)
}

/// Compares v̇ and λ with refined solutions in double-double, and prints the errors of the
/// elimination and of the present solver. For λ the latter has the same rows of C. At the flat pose
/// of V6, velocities are arbitrary motions of a singular configuration, so that v̇ depends on the
/// rows that a solver keeps.
fn check(name: &str, prepared: &PreparedMechanism) -> Outcome<bool> {
    let (m, q, t) = (&prepared.mechanism, &prepared.q, prepared.start_time());
    let (n, layout) = (m.layout().n_v, m.layout());
    let mut s = m.scratch();
    m.pose(t, q, &mut s);
    m.c(&mut s);
    m.b(&mut s);
    let mut elimination = Elimination::new(prepared, &s)?;
    elimination.factor(m, q, &s)?;
    let mut v = prepared.v.clone();
    if v.iter().all(|v| *v == 0.0) {
        // Any motion that satisfies the constraints, so that Γ is not zero.
        let push: Vec<f64> = (0..n).map(|k| (1.0 + 2.3 * k as f64).sin()).collect();
        elimination.solve(&push, &s.b, &mut v)?;
    }
    m.twist(&v, &mut s);
    m.gamma(&mut s);
    m.force(&mut s);

    let kept = elimination.kept();
    let rows = kept.iter().map(|&i| layout.row(&s, i).collect::<Vec<_>>());
    let c = SparseMatrix::from_rows(n, rows)?;
    let gamma: Vec<f64> = kept.iter().map(|&i| s.gamma[i]).collect();
    let mut saddle = KeptRowSaddle::of_rows(&c, m.inertia(&s))?;
    let [mut a, mut right] = [vec![0.0; n], vec![0.0; n]];
    let [mut lambda, mut right_lambda] = [vec![0.0; kept.len()], vec![0.0; kept.len()]];
    saddle.solve(&s.force, &gamma, &mut a, &mut lambda)?;
    let mut refinement = Refinement::new(n, kept.len());
    let row = |k: usize| c.row(k).1;
    let (force, out) = (&s.force, (&mut right, &mut right_lambda));
    saddle.solve_refined(&mut refinement, row, force, &gamma, out.0, out.1)?;
    KeptRowMotion::new(prepared)?.acceleration(t, q, &v, &mut a)?;

    let mut errors = [0.0, error(&a, &right), 0.0, error(&lambda, &right_lambda)];
    let mut all = vec![0.0; layout.rows()];
    elimination.solve(&s.force, &s.gamma, &mut a)?;
    elimination.multipliers(m, &s.force, &mut all)?;
    let own: Vec<f64> = kept.iter().map(|&i| all[i]).collect();
    (errors[0], errors[2]) = (error(&a, &right), error(&own, &right_lambda));
    let blocks = &elimination.blocks;
    let g: usize = blocks.iter().map(|block| block.g.rows.len()).sum();
    let (bodies, k, pivot) = (m.bodies().len(), n - kept.len(), elimination.pivot());
    print!(
        "{name:34} {bodies:2} {g:3} {k:3} {:6} {pivot:7.1e}",
        blocks.len()
    );
    for e in errors {
        print!(" {e:7.0e}");
    }
    let is_rank = kept.len() == prepared.decision.rank;
    println!("{}", if is_rank { "" } else { "  not the rank" });
    Ok(is_rank && errors[0] <= BOUND)
}

/// Prints pivots along the motion of N parallelograms through their flat pose. From N = 13 on,
/// `KeptRowSaddle` compares the pivots of G with G itself, so that the last column is not constant.
fn pivots(n: usize) -> Outcome<bool> {
    let prepared = drawn(&catalogue::parallelograms(n, [3, 4]))?;
    let m = &prepared.mechanism;
    let (mut s, mut a) = (m.scratch(), vec![0.0; m.layout().n_v]);
    m.pose(0.0, &prepared.q, &mut s);
    m.c(&mut s);
    let mut elimination = Elimination::new(&prepared, &s)?;
    let mut motion = KeptRowMotion::new(&prepared)?;
    let mut first = None;
    println!("     angle    present          G  (…)/sin  (…)/sin, both relative to the first line");
    let before = (0..23).map(|k| 10.0_f64.powf(-1.0 - 0.5 * f64::from(k)));
    let after = before.clone().rev().map(|angle| -angle);
    let start = 0.8_f64.asin();
    for angle in [0.7].into_iter().chain(before).chain(after) {
        let (sin, cos) = (angle - start).sin_cos();
        let mut d = vec![0.0; m.layout().n_v];
        for (body, d) in d.chunks_exact_mut(6).enumerate() {
            if body == 0 || body % 2 == 1 {
                // A crank rotates about its foot.
                let q = &prepared.q[7 * body..];
                let [x, y] = [q[0] - body.div_ceil(2) as f64, q[1]];
                (d[0], d[1]) = (cos * x - sin * y - x, sin * x + cos * y - y);
                d[5] = angle - start;
            } else {
                d[0] = 0.5 * (angle.cos() - start.cos());
                d[1] = 0.5 * (angle.sin() - start.sin());
            }
        }
        let mut q = prepared.q.clone();
        m.displace(&mut q, &d);
        motion.acceleration(0.0, &q, &prepared.v, &mut a)?;
        m.pose(0.0, &q, &mut s);
        m.c(&mut s);
        elimination.factor(m, &q, &s)?;
        let pivots = [motion.pivot_ratio(), elimination.pivot()];
        let first = *first.get_or_insert(pivots);
        let [a, b] = [0, 1].map(|k| pivots[k] / first[k] / angle.sin().abs());
        let [present, g] = pivots;
        println!("{angle:10.2e} {present:10.2e} {g:10.2e} {a:8.4} {b:8.4}");
    }
    Ok(true)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|argument| argument.to_string_lossy().into_owned())
        .collect();
    let n = arguments.get(1).and_then(|n| n.parse::<u8>().ok());
    let outcome = match (arguments.first().map(String::as_str), arguments.len(), n) {
        (Some("check"), 1, _) => check_all(),
        (Some("pivots"), 2, Some(n @ 1..)) => pivots(n.into()),
        _ => {
            eprintln!("usage: elimination_by_bodies check | pivots N, with N from 1 to 255");
            return ExitCode::from(2);
        }
    };
    let is_good = outcome.unwrap_or_else(|error| {
        eprintln!("{error}");
        false
    });
    ExitCode::from(u8::from(!is_good))
}
