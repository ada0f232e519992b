//! Nodes sorted by degree, as lists of nodes of equal degree.

/// Value for the absence of a node.
const NONE: usize = usize::MAX;

/// A subset of the nodes `0..n`, each with a degree below n. Among nodes of equal degree, the
/// latest node comes first.
pub(super) struct Buckets {
    first: Vec<usize>,
    next: Vec<usize>,
    previous: Vec<usize>,
    degree: Vec<usize>,
    /// All lists with an index below `least` are empty.
    least: usize,
}

impl Buckets {
    pub(super) fn new(n: usize) -> Self {
        Self {
            first: vec![NONE; n],
            next: vec![NONE; n],
            previous: vec![NONE; n],
            degree: vec![0; n],
            least: 0,
        }
    }

    /// Inserts a new node.
    pub(super) fn insert(&mut self, node: usize, degree: usize) {
        let degree = degree.min(self.first.len() - 1);
        let after = std::mem::replace(&mut self.first[degree], node);
        self.next[node] = after;
        self.previous[node] = NONE;
        if after != NONE {
            self.previous[after] = node;
        }
        self.degree[node] = degree;
        self.least = self.least.min(degree);
    }

    /// Removes a contained node; returns its degree.
    pub(super) fn remove(&mut self, node: usize) -> usize {
        let (before, after) = (self.previous[node], self.next[node]);
        match before {
            NONE => self.first[self.degree[node]] = after,
            _ => self.next[before] = after,
        }
        if after != NONE {
            self.previous[after] = before;
        }
        self.degree[node]
    }

    /// Removes the first node of least degree.
    pub(super) fn pop(&mut self) -> Option<usize> {
        while *self.first.get(self.least)? == NONE {
            self.least += 1;
        }
        let node = self.first[self.least];
        self.remove(node);
        Some(node)
    }
}
