//! The elimination tree. The tree contains the nodes that are connected to a node when the node is
//! eliminated. The elimination tree depends only on the pattern.

use super::minimum_degree;

/// Nodes in an order of elimination with little fill, see [`minimum_degree`], and the connections
/// that the elimination creates. Nodes are identified by their *position* in this order.
///
/// ```
/// use pfaff_linalg::EliminationTree;
/// // A chain 0 – 1 – 2 of two cliques: no order creates fill.
/// let tree = EliminationTree::new(3, &[vec![0, 1], vec![1, 2]]);
/// let joined: Vec<usize> = tree.beyond.iter().map(Vec::len).collect();
/// assert_eq!(joined, [1, 1, 0]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EliminationTree {
    /// The node at each position.
    pub order: Vec<usize>,
    /// Cliques whose first node is at this position.
    pub led: Vec<Vec<usize>>,
    /// Positions that are connected to this position when it is eliminated, ascending. The first of
    /// these positions is the parent of this position.
    pub beyond: Vec<Vec<usize>>,
    /// Positions that have this position as parent, ascending.
    pub children: Vec<Vec<usize>>,
}

impl EliminationTree {
    /// Returns the tree of `n` nodes; the nodes in each set are connected to each other.
    #[must_use]
    pub fn new(n: usize, cliques: &[Vec<usize>]) -> Self {
        let tree =
            Self::while_admitted(n, cliques, |_, _, _| Ok::<(), std::convert::Infallible>(()));
        tree.unwrap_or_else(|never| match never {})
    }

    /// Works like [`Self::new`], but stops when `admit` returns an error. The function `admit` is
    /// called with each position, the order, and the later positions connected to this position.
    ///
    /// # Errors
    /// Returns the first error of `admit`.
    pub fn while_admitted<E>(
        n: usize,
        cliques: &[Vec<usize>],
        mut admit: impl FnMut(usize, &[usize], &[usize]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let order = minimum_degree(n, cliques);
        let mut place = vec![0; n];
        for (k, &node) in order.iter().enumerate() {
            place[node] = k;
        }
        let mut tree = Self {
            led: vec![Vec::new(); n],
            beyond: Vec::with_capacity(n),
            children: vec![Vec::new(); n],
            order,
        };
        for (clique, nodes) in cliques.iter().enumerate() {
            if let Some(first) = nodes.iter().map(|&node| place[node]).min() {
                tree.led[first].push(clique);
            }
        }
        let mut mark = vec![usize::MAX; n];
        for k in 0..n {
            mark[k] = k;
            let own = tree.led[k].iter().flat_map(|&clique| &cliques[clique]);
            let own = own.map(|&node| place[node]);
            let below = tree.children[k].iter().flat_map(|&c| &tree.beyond[c]);
            let mut joined = Vec::new();
            for j in own.chain(below.copied()) {
                if std::mem::replace(&mut mark[j], k) != k {
                    joined.push(j);
                }
            }
            joined.sort_unstable();
            tree.beyond.push(joined);
            admit(k, &tree.order, &tree.beyond[k])?;
            if let Some(&parent) = tree.beyond[k].first() {
                tree.children[parent].push(k);
            }
        }
        Ok(tree)
    }
}
