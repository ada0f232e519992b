//! Rooted trees and the order conditions of Butcher's theory, for tests of the coefficient tables.
//! The conditions are generated from the trees, not copied from a table.
//!
//! A Runge–Kutta formula with weights b(θ) has order p if `Σ b_i(θ)·Φ_i(τ) = θ^|τ| / γ(τ)` for all
//! rooted trees τ with at most p nodes. Source: Hairer, Nørsett, Wanner I, 2nd ed., II.2 and II.6.

/// A rooted tree, represented by the sorted subtrees at its root.
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

    /// Returns Φ_i for all stages.
    fn weights<const S: usize>(&self, a: &[[f64; S]; S]) -> [f64; S] {
        let mut phi = [1.0; S];
        for child in &self.0 {
            let inner = child.weights(a);
            for (p, row) in phi.iter_mut().zip(a) {
                *p *= dot(row, &inner);
            }
        }
        phi
    }
}

/// Returns all trees with `order` nodes. Each tree is a root with subtrees of a composition of
/// order − 1.
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

fn dot<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Returns the defects of `weights` at θ in the conditions of one order. Each defect is returned
/// with the symmetry of its tree.
fn defects<const S: usize>(
    a: &[[f64; S]; S],
    weights: &[f64; S],
    order: i32,
    theta: f64,
) -> Vec<(f64, f64)> {
    trees(order)
        .iter()
        .map(|t| {
            let defect = dot(weights, &t.weights(a)) - theta.powi(order) / t.density();
            (defect, t.symmetry())
        })
        .collect()
}

/// Computes the largest violation of the conditions of one order.
pub(crate) fn violation<const S: usize>(
    a: &[[f64; S]; S],
    weights: &[f64; S],
    order: i32,
    theta: f64,
) -> f64 {
    let defects = defects(a, weights, order, theta);
    defects.iter().map(|d| d.0.abs()).fold(0.0, f64::max)
}

/// Computes the Euclidean norm of the error coefficients of one order. Each coefficient is divided
/// by the symmetry of its tree.
pub(crate) fn error_size<const S: usize>(
    a: &[[f64; S]; S],
    weights: &[f64; S],
    order: i32,
    theta: f64,
) -> f64 {
    let defects = defects(a, weights, order, theta);
    defects
        .iter()
        .map(|d| (d.0 / d.1).powi(2))
        .sum::<f64>()
        .sqrt()
}

#[test]
fn there_are_as_many_trees_as_in_the_book() {
    let counts: Vec<usize> = (1..=8).map(|n| trees(n).len()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]); // Hairer, Nørsett, Wanner I, table II.2.1
}
