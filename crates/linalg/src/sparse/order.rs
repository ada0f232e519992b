//! The order in which bodies are eliminated: approximate minimum degree on the graph in which the
//! bodies of a joint are connected.
//!
//! The elimination of a node joins all its neighbours to each other. The graph is therefore stored
//! as a cover by cliques, not edge by edge. The joints are the first cliques. An eliminated node
//! unites its cliques into one clique (element absorption), and storage never grows. A degree is
//! bounded by `|L_p ∖ i| + Σ_e |L_e ∖ L_p|` over the cliques e of i, where `L_p` is the new clique.
//! Nodes in the same cliques are treated as one node.
//!
//! Source: P. R. Amestoy, T. A. Davis, I. S. Duff, An approximate minimum degree ordering
//! algorithm, SIAM J. Matrix Anal. Appl. 17 (1996) 886–905.

mod buckets;
#[cfg(test)]
mod tests;

use buckets::Buckets;

/// Returns an elimination order of the nodes `0..n` with little fill. The next node is
/// approximately the node of least degree.
///
/// `cliques` are sets of nodes that are all connected to each other; nodes not below `n` are
/// ignored. The same input gives the same order.
///
/// ```
/// use pfaff_linalg::minimum_degree;
/// // A star: the centre 0 comes after all but one of its neighbours, so there is no fill.
/// let order = minimum_degree(4, &[vec![0, 1], vec![0, 2], vec![0, 3]]);
/// assert!(order.iter().position(|&node| node == 0) >= Some(2));
/// ```
pub fn minimum_degree(n: usize, cliques: &[Vec<usize>]) -> Vec<usize> {
    let mut graph = Cover::new(n, cliques);
    let mut order = Vec::with_capacity(n);
    while let Some(node) = graph.buckets.pop() {
        graph.eliminate(node, &mut order);
    }
    order
}

/// A graph as a cover by cliques, with nodes of the same cliques merged.
struct Cover {
    /// Nodes of each clique. The list is empty if another clique contains the clique.
    nodes: Vec<Vec<usize>>,
    /// Number of nodes of each clique, including merged nodes.
    size: Vec<usize>,
    /// Cliques of each node, ascending.
    cliques: Vec<Vec<usize>>,
    /// Nodes that were merged into each node.
    twins: Vec<Vec<usize>>,
    /// One plus the number of twins; 0 after the node is eliminated or merged.
    weight: Vec<usize>,
    /// Number of nodes not yet eliminated, including merged nodes.
    remaining: usize,
    /// The last elimination that marked each node.
    mark: Vec<usize>,
    /// The size `|L_e ∖ L_p|` of the clique e, and the elimination in which this size was counted.
    outside: Vec<(usize, usize)>,
    buckets: Buckets,
}

/// A neighbour of the node that is being eliminated.
struct Neighbour {
    /// A key that is equal for nodes with the same cliques.
    key: usize,
    node: usize,
    /// Bound on the degree of the node without the new clique.
    degree: usize,
}

impl Cover {
    fn new(n: usize, cliques: &[Vec<usize>]) -> Self {
        let within = |clique: &Vec<usize>| {
            let mut nodes: Vec<usize> = clique.iter().copied().filter(|&i| i < n).collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        let mut nodes: Vec<Vec<usize>> = cliques.iter().map(within).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes.retain(|clique| clique.len() > 1);
        let mut of_node = vec![Vec::new(); n];
        let mut degree = vec![0; n];
        for (e, clique) in nodes.iter().enumerate() {
            for &i in clique {
                of_node[i].push(e);
                degree[i] += clique.len() - 1;
            }
        }
        let mut buckets = Buckets::new(n);
        for i in (0..n).rev() {
            buckets.insert(i, degree[i].min(n - 1));
        }
        Self {
            size: nodes.iter().map(Vec::len).collect(),
            outside: vec![(0, 0); nodes.len()],
            nodes,
            cliques: of_node,
            twins: vec![Vec::new(); n],
            weight: vec![1; n],
            remaining: n,
            mark: vec![0; n],
            buckets,
        }
    }

    /// Eliminates a node with its twins, and with neighbours that have no other neighbours.
    fn eliminate(&mut self, pivot: usize, order: &mut Vec<usize>) {
        let stamp = order.len() + 1;
        let mut united = self.unite(pivot, stamp);
        self.settle(pivot, order);
        self.count_outside(&united, stamp);
        let p = self.nodes.len();
        let mut neighbours = Vec::with_capacity(united.len());
        for &i in &united {
            let mut beyond = 0;
            let outside = &self.outside;
            // Removes cliques that are contained in the new clique.
            self.cliques[i].retain(|&e| {
                beyond += outside[e].0;
                outside[e].0 > 0
            });
            let old = self.buckets.remove(i);
            if beyond == 0 {
                self.settle(i, order);
            } else {
                self.cliques[i].push(p);
                neighbours.push(Neighbour {
                    key: self.cliques[i].iter().sum(),
                    node: i,
                    degree: beyond.min(old),
                });
            }
        }
        self.merge_twins(&mut neighbours);
        united.retain(|&i| self.weight[i] > 0);
        let inside: usize = united.iter().map(|&i| self.weight[i]).sum();
        for Neighbour { node, degree, .. } in neighbours {
            let own = self.weight[node];
            if own > 0 {
                let degree = (degree + inside - own).min(self.remaining - own);
                self.buckets.insert(node, degree);
            }
        }
        self.size.push(inside);
        self.outside.push((0, 0));
        self.nodes.push(united);
    }

    /// Returns the neighbours of a node. The neighbours of a node are the union of its cliques,
    /// which are removed.
    fn unite(&mut self, pivot: usize, stamp: usize) -> Vec<usize> {
        self.mark[pivot] = stamp;
        let mut united = Vec::new();
        for e in std::mem::take(&mut self.cliques[pivot]) {
            for i in std::mem::take(&mut self.nodes[e]) {
                if self.weight[i] > 0 && self.mark[i] != stamp {
                    self.mark[i] = stamp;
                    united.push(i);
                }
            }
            self.size[e] = 0;
        }
        united
    }

    /// Counts `|L_e ∖ L_p|` for all cliques e that share nodes with the new clique.
    fn count_outside(&mut self, united: &[usize], stamp: usize) {
        for &i in united {
            for &e in &self.cliques[i] {
                if self.outside[e].1 != stamp {
                    self.outside[e] = (self.size[e], stamp);
                }
                let outside = &mut self.outside[e].0;
                *outside = outside.saturating_sub(self.weight[i]);
            }
        }
    }

    /// Merges nodes that are in the same cliques.
    fn merge_twins(&mut self, neighbours: &mut [Neighbour]) {
        neighbours.sort_unstable_by_key(|neighbour| (neighbour.key, neighbour.node));
        for same in neighbours.chunk_by(|a, b| a.key == b.key) {
            for (at, i) in same.iter().map(|neighbour| neighbour.node).enumerate() {
                for j in same[at + 1..].iter().map(|neighbour| neighbour.node) {
                    let both = self.weight[i] > 0 && self.weight[j] > 0;
                    if both && self.cliques[i] == self.cliques[j] {
                        self.weight[i] += std::mem::take(&mut self.weight[j]);
                        let others = std::mem::take(&mut self.twins[j]);
                        self.twins[i].push(j);
                        self.twins[i].extend(others);
                        self.cliques[j] = Vec::new();
                    }
                }
            }
        }
    }

    /// Appends a node and its twins to the order.
    fn settle(&mut self, node: usize, order: &mut Vec<usize>) {
        self.remaining -= std::mem::take(&mut self.weight[node]);
        order.push(node);
        order.append(&mut self.twins[node]);
    }
}
