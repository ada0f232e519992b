//! The blocks of a graph: groups that share a cycle.

use linalg::DisjointSets;

/// Returns sets of groups on common cycles of the graph in which each group joins its vertices.
/// Each set ascends, and the sets are ordered by their first groups. A group that is on no cycle,
/// or on a single vertex, is a separate set.
///
/// In mechanics the vertices are bodies and the ground. The groups are joints whose rows vanish on
/// the common rigid motions of their bodies. If two sides have only one body in common, the side
/// without the ground is in equilibrium by itself. The joints between this side and the common body
/// transmit no total wrench. Therefore every `z` with `Cᵀ·z = 0` is a sum of vectors with the same
/// property, each of which is zero outside one set. Each set can thus be analysed separately. The
/// redundancy is the sum of the redundancies of the sets.
///
/// ```
/// use pfaff_rank::cycles;
/// // Vertices 0, 1, 2 form a triangle; 3 is connected to 2, and twice to 4.
/// let groups = [vec![0, 1], vec![1, 2], vec![2, 3], vec![2, 0], vec![3, 4], vec![4, 3]];
/// assert_eq!(cycles(5, &groups), [vec![0, 1, 3], vec![2], vec![4, 5]]);
/// ```
///
/// Vertices that are not below `vertices` are ignored. The work is linear in the number of entries.
///
/// Source: R. Tarjan, Depth-first search and linear graph algorithms, SIAM J. Comput. 1 (1972)
/// 146–160.
#[must_use]
pub fn cycles(vertices: usize, groups: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let graph = Graph::new(vertices, groups);
    let mut sets = DisjointSets::new(groups.len());
    let mut search = Search {
        order: vec![0; vertices],
        reach: vec![0; vertices],
        next: graph.first.clone(),
        visited: 0,
        pending: Vec::new(),
        is_taken: vec![false; graph.group.len()],
    };
    for root in 0..vertices {
        if search.order[root] == 0 {
            search.from(root, &graph, &mut sets);
        }
    }
    sets.sets()
}

/// Edges in compressed adjacency lists. A group on k vertices is stored as a cycle through these
/// vertices, which remain connected if any one vertex is removed.
struct Graph {
    /// Index of the first edge of each vertex (one more entry than vertices), and the edges.
    first: Vec<usize>,
    ends: Vec<(usize, usize)>,
    /// The group of each edge.
    group: Vec<usize>,
}

impl Graph {
    fn new(vertices: usize, groups: &[Vec<usize>]) -> Self {
        let mut edges: Vec<[usize; 2]> = Vec::new();
        let mut group = Vec::new();
        for (g, of_group) in groups.iter().enumerate() {
            let mut own: Vec<usize> = of_group.iter().copied().filter(|&v| v < vertices).collect();
            own.sort_unstable();
            own.dedup();
            let around = if own.len() > 2 {
                own.len()
            } else {
                own.len().saturating_sub(1)
            };
            for k in 0..around {
                edges.push([own[k], own[(k + 1) % own.len()]]);
                group.push(g);
            }
        }
        let mut first = vec![0; vertices + 1];
        edges.as_flattened().iter().for_each(|&v| first[v + 1] += 1);
        for v in 0..vertices {
            first[v + 1] += first[v];
        }
        let mut next = first.clone();
        let mut ends = vec![(0, 0); 2 * edges.len()];
        for (e, &[a, b]) in edges.iter().enumerate() {
            for (from, to) in [(a, b), (b, a)] {
                ends[next[from]] = (to, e);
                next[from] += 1;
            }
        }
        Self { first, ends, group }
    }
}

/// Depth-first search without recursion.
struct Search {
    /// The order in which each vertex was reached, counted from 1, and the earliest vertex that its
    /// subtree reaches.
    order: Vec<usize>,
    reach: Vec<usize>,
    /// The next edge to examine.
    next: Vec<usize>,
    visited: usize,
    /// Edges since the last block was closed.
    pending: Vec<usize>,
    is_taken: Vec<bool>,
}

impl Search {
    fn enter(&mut self, vertex: usize) {
        self.visited += 1;
        self.order[vertex] = self.visited;
        self.reach[vertex] = self.visited;
    }

    fn from(&mut self, root: usize, graph: &Graph, sets: &mut DisjointSets) {
        self.enter(root);
        // The current path, with the number of pending edges before each vertex.
        let mut way = vec![(root, 0)];
        while let Some(&(vertex, before)) = way.last() {
            if self.next[vertex] < graph.first[vertex + 1] {
                let (to, edge) = graph.ends[self.next[vertex]];
                self.next[vertex] += 1;
                if std::mem::replace(&mut self.is_taken[edge], true) {
                    continue;
                }
                let before = self.pending.len();
                self.pending.push(edge);
                if self.order[to] == 0 {
                    self.enter(to);
                    way.push((to, before));
                } else {
                    self.reach[vertex] = self.reach[vertex].min(self.order[to]);
                }
                continue;
            }
            way.pop();
            let Some(&(parent, _)) = way.last() else {
                return;
            };
            self.reach[parent] = self.reach[parent].min(self.reach[vertex]);
            if self.reach[vertex] >= self.order[parent] {
                // The pending edges since the edge to this vertex reach no vertex before the
                // parent, so they form a block.
                let block = self.pending.split_off(before);
                for pair in block.windows(2) {
                    sets.join(graph.group[pair[0]], graph.group[pair[1]]);
                }
            }
        }
    }
}
