//! Tests of the fill of known graphs, and checks that an order is a permutation.

use super::*;

/// Number of entries of the Cholesky factor of a graph in an order. Nodes are eliminated one by one
/// with explicit sets of neighbours.
fn fill(n: usize, cliques: &[Vec<usize>], order: &[usize]) -> usize {
    let mut sorted = order.to_vec();
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..n), "a permutation");
    let mut neighbours = vec![std::collections::BTreeSet::new(); n];
    for clique in cliques {
        for &i in clique {
            neighbours[i].extend(clique.iter().copied().filter(|&j| j != i));
        }
    }
    let mut entries = 0;
    for &pivot in order {
        let joined = std::mem::take(&mut neighbours[pivot]);
        entries += 1 + joined.len();
        for &i in &joined {
            neighbours[i].remove(&pivot);
            neighbours[i].extend(joined.iter().copied().filter(|&j| j != i));
        }
    }
    entries
}

fn chain(n: usize) -> Vec<Vec<usize>> {
    (1..n).map(|i| vec![i - 1, i]).collect()
}

fn grid(side: usize) -> Vec<Vec<usize>> {
    let at = |x: usize, y: usize| side * y + x;
    let mut cliques = Vec::new();
    for y in 0..side {
        for x in 1..side {
            cliques.push(vec![at(x - 1, y), at(x, y)]);
            cliques.push(vec![at(y, x - 1), at(y, x)]);
        }
    }
    cliques
}

#[test]
fn trees_do_not_fill() {
    let binary: Vec<_> = (1..255).map(|i| vec![(i - 1) / 2, i]).collect();
    let star: Vec<_> = (1..50).map(|i| vec![0, i]).collect();
    for (n, cliques) in [(200, chain(200)), (255, binary), (50, star)] {
        let order = minimum_degree(n, &cliques);
        assert_eq!(fill(n, &cliques, &order), 2 * n - 1);
    }
}

#[test]
fn chordal_graphs_do_not_fill() {
    // Triangles along a strip: the cliques of three bodies at a joint.
    let strip: Vec<_> = (2..100).map(|i| vec![i - 2, i - 1, i]).collect();
    let order = minimum_degree(100, &strip);
    assert_eq!(fill(100, &strip, &order), 3 * 100 - 3);
}

#[test]
fn a_ring_fills_one_edge_for_each_node() {
    let mut ring = chain(100);
    ring.push(vec![99, 0]);
    // Every order of a ring gives a triangulation: 3 entries for each node except the last two.
    assert_eq!(fill(100, &ring, &minimum_degree(100, &ring)), 3 * 100 - 3);
}

#[test]
fn grids_fill_as_by_amd() {
    // Entries of L by AMD of SuiteSparse 5.12 for grids of 10² and 30² nodes.
    for (side, amd) in [(10, 648), (30, 10_231)] {
        let (n, cliques) = (side * side, grid(side));
        let entries = fill(n, &cliques, &minimum_degree(n, &cliques));
        assert!(10 * entries < 11 * amd, "{side}: {entries}, AMD {amd}");
    }
}

#[test]
fn whatever_comes_is_ordered_once() {
    assert_eq!(minimum_degree(0, &[vec![0, 1]]), [0; 0]);
    assert_eq!(minimum_degree(1, &[]), [0]);
    let all = minimum_degree(5, &[vec![4, 1, 4, 9], (0..5).collect(), vec![], vec![2]]);
    assert_eq!(all.len(), 5);
    // The same input gives the same order, and the order of the cliques has no effect.
    let mut cliques = grid(12);
    let order = minimum_degree(144, &cliques);
    cliques.reverse();
    assert_eq!(minimum_degree(144, &cliques), order);
}

#[test]
fn large_chains_take_no_time() {
    let n = 40_000;
    let order = minimum_degree(n, &chain(n));
    assert_eq!(order.len(), n);
}
