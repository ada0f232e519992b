//! The graph of blocks, groups and ground. This file finds the connected parts of the graph without
//! the ground, and the bridges of the graph with the ground as a vertex.

use linalg::DisjointSets;

use super::incidence::{Incidence, Part};

/// Returns the connected parts of the remaining rows in the graph without the ground, ordered by
/// their first rows. Rows of one group are in the same part.
pub(super) fn parts(incidence: &Incidence) -> Vec<Part> {
    let n_blocks = incidence.blocks.len();
    // Vertices: blocks, then groups.
    let mut sets = DisjointSets::new(n_blocks + incidence.groups.len());
    let remaining: Vec<Vec<usize>> = (0..incidence.groups.len())
        .map(|g| incidence.remaining(g))
        .collect();
    for (g, rows) in remaining.iter().enumerate() {
        for &b in rows.iter().flat_map(|&row| &incidence.touches[row]) {
            sets.join(b, n_blocks + g);
        }
    }
    let mut parts = Vec::new();
    for set in sets.sets() {
        let groups = set
            .into_iter()
            .filter_map(|vertex| vertex.checked_sub(n_blocks));
        let groups: Vec<usize> = groups.filter(|&g| !remaining[g].is_empty()).collect();
        let mut rows: Vec<usize> = groups
            .iter()
            .flat_map(|&g| &remaining[g])
            .copied()
            .collect();
        rows.sort_unstable();
        let touched = rows.iter().flat_map(|&row| &incidence.touches[row]);
        let mut blocks: Vec<usize> = touched.copied().collect();
        blocks.sort_unstable();
        blocks.dedup();
        if !rows.is_empty() {
            parts.push(Part {
                rows,
                groups,
                blocks,
            });
        }
    }
    parts.sort_by_key(|part| part.rows[0]);
    parts
}

/// One end of an edge.
#[derive(Clone, Copy)]
struct End {
    vertex: usize,
    edge: usize,
}

/// Returns groups on exactly two vertices (blocks or the ground) that are not connected by any
/// other path.
///
/// A depth-first search finds the earliest vertex that each subtree reaches. An edge is a bridge
/// iff no edge connects the subtree below it with an earlier vertex. A group on more than two
/// vertices is stored as a star around an additional vertex and is never a bridge.
///
/// Source: R. Tarjan, A note on finding the bridges of a graph, Inform. Process. Lett. 2 (1974)
/// 160–161.
pub(super) fn bridges(incidence: &Incidence) -> Vec<usize> {
    let ground = incidence.blocks.len();
    let mut ends: Vec<Vec<End>> = vec![Vec::new(); ground + 1];
    // The group of each edge; `None` for the edges of a star.
    let mut group_of: Vec<Option<usize>> = Vec::new();
    for g in 0..incidence.groups.len() {
        let mut vertices = incidence.blocks_of(g);
        if vertices.is_empty() {
            continue;
        }
        if incidence.groups[g].ground || vertices.len() == 1 {
            vertices.push(ground);
        }
        let mut connect = |a: usize, b: usize, group: Option<usize>| {
            let edge = group_of.len();
            group_of.push(group);
            ends[a].push(End { vertex: b, edge });
            ends[b].push(End { vertex: a, edge });
        };
        if let [a, b] = vertices[..] {
            connect(a, b, Some(g));
        } else {
            // Edges from the first vertex connect all vertices, as an additional vertex would.
            vertices[1..]
                .iter()
                .for_each(|&v| connect(vertices[0], v, None));
        }
    }
    bridge_edges(&ends)
        .into_iter()
        .filter_map(|edge| group_of[edge])
        .collect()
}

/// A vertex on the current path of the search.
struct PathVertex {
    vertex: usize,
    /// The edge along which the search reached this vertex.
    through: Option<usize>,
    /// Number of ends examined so far.
    next: usize,
}

fn bridge_edges(ends: &[Vec<End>]) -> Vec<usize> {
    const NEW: usize = usize::MAX;
    let mut order = vec![NEW; ends.len()];
    let mut reach = vec![NEW; ends.len()];
    let mut count = 0;
    let mut found = Vec::new();
    for start in 0..ends.len() {
        if order[start] != NEW {
            continue;
        }
        let mut path = vec![PathVertex {
            vertex: start,
            through: None,
            next: 0,
        }];
        while let Some(step) = path.last_mut() {
            let v = step.vertex;
            if step.next == 0 && order[v] == NEW {
                (order[v], reach[v]) = (count, count);
                count += 1;
            }
            if let Some(&End { vertex, edge }) = ends[v].get(step.next) {
                step.next += 1;
                if Some(edge) == step.through {
                    continue;
                }
                if order[vertex] == NEW {
                    path.push(PathVertex {
                        vertex,
                        through: Some(edge),
                        next: 0,
                    });
                } else {
                    reach[v] = reach[v].min(order[vertex]);
                }
                continue;
            }
            let through = step.through;
            path.pop();
            if let (Some(before), Some(edge)) = (path.last(), through) {
                let u = before.vertex;
                reach[u] = reach[u].min(reach[v]);
                if reach[v] > order[u] {
                    found.push(edge);
                }
            }
        }
    }
    found
}
