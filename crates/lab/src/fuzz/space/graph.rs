//! Cycles of a graph, which may have several edges between the same nodes.

/// Nodes, and edges with names.
pub struct Graph {
    /// Number of nodes.
    pub nodes: usize,
    /// Names and ends of edges.
    pub edges: Vec<(String, [usize; 2])>,
}

impl Graph {
    /// Returns the number of connected components.
    #[must_use]
    pub fn components(&self) -> usize {
        self.components_without(None)
    }

    /// Returns the number of independent cycles.
    #[must_use]
    pub fn cycle_rank(&self) -> usize {
        self.edges.len() + self.components() - self.nodes
    }

    /// Whether the edge with this name is on a cycle. This is the case if the number of components
    /// is the same without this edge. Returns `None` if the edge does not exist.
    #[must_use]
    pub fn is_on_cycle(&self, name: &str) -> Option<bool> {
        let place = self.edges.iter().position(|(own, _)| own == name)?;
        Some(self.components_without(Some(place)) == self.components())
    }

    fn components_without(&self, skipped: Option<usize>) -> usize {
        let mut leader: Vec<usize> = (0..self.nodes).collect();
        let mut count = self.nodes;
        for (k, (_, ends)) in self.edges.iter().enumerate() {
            if Some(k) == skipped {
                continue;
            }
            let [a, b] = ends.map(|end| leader[end]);
            if a != b {
                count -= 1;
                leader.iter_mut().filter(|x| **x == b).for_each(|x| *x = a);
            }
        }
        count
    }
}
