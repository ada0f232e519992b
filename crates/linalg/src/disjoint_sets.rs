//! Disjoint sets of indices, which can be merged in pairs.

/// Disjoint sets of the indices below `n`. Initially, each index is a separate set.
///
/// ```
/// use pfaff_linalg::DisjointSets;
/// let mut sets = DisjointSets::new(5);
/// sets.join(3, 1);
/// sets.join(4, 3);
/// assert_eq!(sets.sets(), [vec![0], vec![1, 3, 4], vec![2]]);
/// ```
///
/// Source: R. Tarjan, Efficiency of a good but not linear set union algorithm, J. ACM 22 (1975)
/// 215–225; here the paths are halved, and the smallest index of a set is its representative.
#[derive(Clone, Debug)]
pub struct DisjointSets {
    /// A smaller index of the same set, or the index itself if it is the first of its set.
    leader: Vec<usize>,
}

impl DisjointSets {
    /// Creates n sets of one index each.
    #[must_use]
    pub fn new(n: usize) -> Self {
        Self {
            leader: (0..n).collect(),
        }
    }

    /// Merges the sets of two indices.
    ///
    /// # Panics
    /// Panics if an index is not below `n`.
    pub fn join(&mut self, a: usize, b: usize) {
        let [a, b] = [a, b].map(|k| self.first(k));
        self.leader[a.max(b)] = a.min(b);
    }

    /// Returns the first index of the set of `k`, and shortens the path to it.
    pub(crate) fn first(&mut self, mut k: usize) -> usize {
        while self.leader[k] != k {
            self.leader[k] = self.leader[self.leader[k]];
            k = self.leader[k];
        }
        k
    }

    /// Returns the sets, each in ascending order, sorted by their first indices.
    #[must_use]
    pub fn sets(mut self) -> Vec<Vec<usize>> {
        let mut sets = vec![Vec::new(); self.leader.len()];
        for k in 0..self.leader.len() {
            sets[self.first(k)].push(k);
        }
        sets.retain(|set| !set.is_empty());
        sets
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the sets with reachability in the graph of the joined pairs, vertex by vertex.
    #[test]
    fn sets_are_what_is_reachable() {
        const N: usize = 60;
        let mut random = 7_u64;
        let mut draw = || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (random >> 33) as usize % N
        };
        for pairs in [0, 10, 30, 60] {
            let pairs: Vec<[usize; 2]> = (0..pairs).map(|_| [draw(), draw()]).collect();
            let mut sets = DisjointSets::new(N);
            pairs.iter().for_each(|&[a, b]| sets.join(a, b));
            let mut expected: Vec<Vec<usize>> = Vec::new();
            for start in 0..N {
                if expected.iter().any(|set| set.contains(&start)) {
                    continue;
                }
                let mut reached = vec![start];
                for _ in 0..N {
                    for [a, b] in &pairs {
                        match [a, b].map(|k| reached.contains(k)) {
                            [true, false] => reached.push(*b),
                            [false, true] => reached.push(*a),
                            _ => (),
                        }
                    }
                }
                reached.sort_unstable();
                expected.push(reached);
            }
            assert_eq!(sets.sets(), expected);
        }
    }
}
