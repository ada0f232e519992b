//! The tableau and both dense outputs against the order conditions of Butcher's theory, which know no table.
//!
//! A Runge–Kutta formula with weights b(θ) has order p if `Σ b_i(θ)·Φ_i(τ) = θ^|τ| / γ(τ)` for all rooted trees τ with at most
//! p nodes. Source: Hairer, Nørsett, Wanner I, 2nd ed., II.2 and II.6.

use super::dense::{quartic_weights, quintic_weights};
use super::tableau::{A, C, D, E, NODE_A, NODE_B};

/// Seven stages and the two extra evaluations.
const STAGES: usize = 9;
/// Rounding of sums of up to 9 products of size ≤ 10.
const TOLERANCE: f64 = 1e-13;

/// A rooted tree: the sorted subtrees at its root.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Tree(Vec<Tree>);

impl Tree {
    fn order(&self) -> i32 {
        1 + self.0.iter().map(Tree::order).sum::<i32>()
    }

    fn density(&self) -> f64 {
        f64::from(self.order()) * self.0.iter().map(Tree::density).product::<f64>()
    }

    fn symmetry(&self) -> f64 {
        let mut product = 1.0;
        let mut run = 0.0;
        for (i, child) in self.0.iter().enumerate() {
            run = if i > 0 && self.0[i - 1] == *child {
                run + 1.0
            } else {
                1.0
            };
            product *= run * child.symmetry();
        }
        product
    }

    /// Φ_i for all stages.
    fn weights(&self, a: &[[f64; STAGES]; STAGES]) -> [f64; STAGES] {
        let mut phi = [1.0; STAGES];
        for child in &self.0 {
            let inner = child.weights(a);
            for (p, row) in phi.iter_mut().zip(a) {
                *p *= dot(row, &inner);
            }
        }
        phi
    }
}

/// All trees with `order` nodes: a root with subtrees of every composition of order − 1.
fn trees(order: i32) -> Vec<Tree> {
    fn forests(nodes: i32, largest: i32) -> Vec<Vec<Tree>> {
        if nodes == 0 {
            return vec![Vec::new()];
        }
        let mut all = Vec::new();
        for first in 1..=nodes.min(largest) {
            for tree in trees(first) {
                for mut rest in forests(nodes - first, first) {
                    rest.push(tree.clone());
                    rest.sort();
                    all.push(rest);
                }
            }
        }
        all
    }
    let mut all: Vec<Tree> = forests(order - 1, order - 1)
        .into_iter()
        .map(Tree)
        .collect();
    all.sort();
    all.dedup();
    all
}

fn dot(a: &[f64; STAGES], b: &[f64; STAGES]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn step_weights() -> [f64; STAGES] {
    let mut b = [0.0; STAGES];
    b[..6].copy_from_slice(&A[5]);
    b
}

fn quartic(theta: f64) -> [f64; STAGES] {
    let w = quartic_weights(theta);
    let mut b = step_weights().map(|b| w.delta * b);
    for (b, d) in b.iter_mut().zip(D) {
        *b += w.d * d;
    }
    b[0] += w.f0;
    b[6] += w.f1;
    b
}

fn quintic(theta: f64) -> [f64; STAGES] {
    let w = quintic_weights(theta);
    let mut b = step_weights().map(|b| w.delta * b);
    b[0] += w.f0;
    b[6] += w.f1;
    b[7] += w.f_a;
    b[8] += w.f_b;
    b
}

fn stage_matrix() -> [[f64; STAGES]; STAGES] {
    let mut a = [[0.0; STAGES]; STAGES];
    for (row, from) in a[1..7].iter_mut().zip(A) {
        row[..6].copy_from_slice(&from);
    }
    a[7] = quartic(NODE_A);
    a[8] = quartic(NODE_B);
    a
}

/// Largest violation over the trees of one order.
fn violation(weights: &[f64; STAGES], order: i32, theta: f64) -> f64 {
    let a = stage_matrix();
    trees(order)
        .iter()
        .map(|t| (dot(weights, &t.weights(&a)) - theta.powi(order) / t.density()).abs())
        .fold(0.0, f64::max)
}

/// Euclidean norm of the error coefficients of one order, each divided by the symmetry of its tree.
fn error_size(weights: &[f64; STAGES], order: i32, theta: f64) -> f64 {
    let a = stage_matrix();
    trees(order)
        .iter()
        .map(|t| {
            let e = dot(weights, &t.weights(&a)) - theta.powi(order) / t.density();
            (e / t.symmetry()).powi(2)
        })
        .sum::<f64>()
        .sqrt()
}

#[test]
fn there_are_as_many_trees_as_in_the_book() {
    let counts: Vec<usize> = (1..=6).map(|n| trees(n).len()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20]); // Hairer, Nørsett, Wanner I, table II.2.1
}

#[test]
fn nodes_are_row_sums() {
    for (row, c) in A.iter().zip(C) {
        assert!((row.iter().sum::<f64>() - c).abs() < TOLERANCE);
    }
}

#[test]
fn step_has_order_five_and_the_embedded_solution_four() {
    let b = step_weights();
    let mut embedded = b;
    for (b, e) in embedded.iter_mut().zip(E) {
        *b -= e;
    }
    for order in 1..=5 {
        assert!(violation(&b, order, 1.0) < TOLERANCE, "order {order}");
    }
    for order in 1..=4 {
        assert!(
            violation(&embedded, order, 1.0) < TOLERANCE,
            "order {order}"
        );
    }
    assert!(violation(&b, 6, 1.0) > 1e-4);
    assert!(violation(&embedded, 5, 1.0) > 1e-4);
}

#[test]
fn dense_outputs_have_order_four_and_five_everywhere() {
    for theta in [0.05, 0.3, 0.5, 0.77, 1.0] {
        for order in 1..=4 {
            assert!(violation(&quartic(theta), order, theta) < TOLERANCE);
        }
        for order in 1..=5 {
            assert!(violation(&quintic(theta), order, theta) < TOLERANCE);
        }
    }
    assert!(violation(&quartic(0.5), 5, 0.5) > 1e-5);
}

#[test]
fn quintic_is_nowhere_less_accurate_than_the_step() {
    let at_end = error_size(&quintic(1.0), 6, 1.0);
    assert!((at_end - error_size(&step_weights(), 6, 1.0)).abs() < TOLERANCE);
    for i in 1..=100 {
        let theta = f64::from(i) / 100.0;
        assert!(
            error_size(&quintic(theta), 6, theta) <= at_end * (1.0 + 1e-12),
            "θ = {theta}"
        );
    }
}
