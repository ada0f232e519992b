//! Results from the pattern must be true. They are compared with the null space of random matrices
//! and of chains of bodies.

use super::*;
use crate::{decide, orthonormal};

/// Adds a pin between bodies in the plane, each with three columns. Points and lines are given in
/// global components, so that the rigid motions are (1, 0, −y), (0, 1, x) for every body.
fn pin(c: &mut Vec<Vec<f64>>, n: usize, pair: [Option<usize>; 2], at: [f64; 2]) -> Vec<usize> {
    let first = c.len();
    for k in 0..2 {
        let mut row = vec![0.0; 3 * n];
        for (body, sign) in pair.iter().zip([1.0, -1.0]) {
            if let Some(b) = body {
                row[3 * b + k] = sign;
                row[3 * b + 2] = sign * [-at[1], at[0]][k];
            }
        }
        c.push(row);
    }
    vec![first, first + 1]
}

fn matrix(rows: &[Vec<f64>]) -> Matrix {
    Matrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// Creates random pins between bodies and the ground. Every settled row or group is compared with
/// the null space of the whole matrix. Every open part is analysed separately and compared with the
/// same rows of the whole matrix.
#[test]
fn what_is_settled_is_true_and_parts_are_independent() {
    let mut state = 7_u64;
    let mut next = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % below
    };
    let (mut bridges, mut peeled, mut free_rows) = (0, 0, 0);
    for _ in 0..200 {
        let n = 2 + next(6);
        let mut rows = Vec::new();
        let mut groups = Vec::new();
        for _ in 0..2 + next(n + 3) {
            let i = next(n);
            // The ground is one more choice in addition to the other bodies.
            let j = match next(n + 1) {
                j if j == n || j == i => None,
                j => Some(j),
            };
            // The points are on a grid, so that pins sometimes coincide or are collinear.
            let at = [next(4) as f64, next(3) as f64];
            groups.push(RowGroup {
                rows: pin(&mut rows, n, [Some(i), j], at),
                ground: j.is_none(),
            });
        }
        let c = matrix(&rows);
        let blocks: Vec<Range<usize>> = (0..n).map(|b| 3 * b..3 * b + 3).collect();
        let found = structure(&c, crate::Accuracy::Rounding, &groups, &blocks).unwrap();
        let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
        let margin = |c: &Matrix, z: &Matrix, rows: &[usize]| {
            let c = c.select_rows(rows);
            c.transpose().product(&z.select_rows(rows)).max_abs()
        };
        let scaled = decision.scaling.apply(&c);
        let z = orthonormal(&decision);
        for (row, settled) in found.rows.iter().enumerate() {
            match settled {
                StructureVerdict::Peeled => {
                    peeled += 1;
                    assert!(linalg::kernels::max_abs(z.row(row)) < 1e-12);
                }
                StructureVerdict::Bridge => bridges += 1,
                StructureVerdict::Open(_) => {}
            }
        }
        let mut rank = 0;
        for (g, settled) in found.groups.iter().enumerate() {
            let rows: Vec<usize> = groups[g].rows.clone();
            let whole = margin(&scaled, &z, &rows);
            if let StructureVerdict::Open(k) = settled {
                let part = &found.open[*k];
                let own = c.select_rows(&part.rows);
                let alone = decide(&own, crate::Accuracy::Rounding).unwrap();
                let places: Vec<usize> = (0..part.rows.len())
                    .filter(|&i| rows.contains(&part.rows[i]))
                    .collect();
                let there = margin(&alone.scaling.apply(&own), &orthonormal(&alone), &places);
                assert_eq!(whole < 1e-10, there < 1e-10, "{whole:e} {there:e}");
                free_rows += usize::from(whole > 1e-10);
            } else {
                assert!(whole < 1e-12, "{settled:?} but {whole:e}");
            }
        }
        for part in &found.parts {
            rank += decide(&c.select_rows(&part.rows), crate::Accuracy::Rounding)
                .unwrap()
                .rank;
        }
        assert_eq!(rank, decision.rank, "ranks of parts add up");
    }
    assert!(
        bridges > 50 && peeled > 200 && free_rows > 50,
        "{bridges} {peeled} {free_rows}"
    );
}

/// A closed loop of three bars with a redundant bar is connected to the ground by one pin. No body
/// can be peeled, and the pin is a bridge.
#[test]
fn a_bridge_that_peeling_cannot_find() {
    let mut rows = Vec::new();
    let body = |b: usize| Some(b);
    let mut groups = vec![RowGroup {
        rows: pin(&mut rows, 3, [body(0), None], [0.0, 0.0]),
        ground: true,
    }];
    for (pair, at) in [
        ([0, 1], [1.0, 0.0]),
        ([1, 2], [1.0, 1.0]),
        ([2, 0], [0.0, 1.0]),
        ([2, 0], [0.0, 2.0]),
    ] {
        groups.push(RowGroup {
            rows: pin(&mut rows, 3, pair.map(body), at),
            ground: false,
        });
    }
    let blocks = [0..3, 3..6, 6..9];
    let found = structure(&matrix(&rows), crate::Accuracy::Rounding, &groups, &blocks).unwrap();
    assert_eq!(found.groups[0], StructureVerdict::Bridge);
    assert!(
        found.groups[1..]
            .iter()
            .all(|s| *s == StructureVerdict::Open(0))
    );
    // Without the guarantee that the loop acts only among its bars, the pin may transmit a load.
    groups.iter_mut().for_each(|g| g.ground = true);
    let careful = structure(&matrix(&rows), crate::Accuracy::Rounding, &groups, &blocks).unwrap();
    assert_eq!(careful.groups[0], StructureVerdict::Open(0));
}

/// Entries that are rounding errors relative to their row do not lead to peeling. Block 1 has only
/// an entry of 1e-17 in row 1. Apart from this entry, row 1 repeats row 0.
#[test]
fn rounding_does_not_peel() {
    let c = Matrix::from_rows(&[[1.0, 0.0, 0.0], [1.0, 1e-17, 0.0], [0.0, 1.0, 1.0]]);
    let groups = [0, 1, 2].map(|row| RowGroup {
        rows: vec![row],
        ground: true,
    });
    let found = structure(&c, crate::Accuracy::Rounding, &groups, &[0..1, 1..3]).unwrap();
    assert_eq!(found.rows, [StructureVerdict::Open(0); 3]);
}

/// Tests unusual input. A row of zeros is a dependency by itself. Ranges are truncated. Rows and
/// columns outside all ranges form separate sets.
#[test]
fn odd_input_has_an_answer() {
    let c = Matrix::from_rows(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let groups = [
        RowGroup {
            rows: (1..9).collect(),
            ground: true,
        },
        RowGroup {
            rows: Vec::new(),
            ground: false,
        },
    ];
    let found = structure(&c, crate::Accuracy::Rounding, &groups, &[]).unwrap();
    assert_eq!(
        found.rows,
        [
            StructureVerdict::Open(0),
            StructureVerdict::Peeled,
            StructureVerdict::Peeled
        ]
    );
    assert_eq!((found.parts.len(), found.open.len()), (2, 1));
    assert!(structure(&c, crate::Accuracy::Absolute(f64::NAN), &[], &[]).is_err());
    let empty = structure(&Matrix::zeros(0, 0), crate::Accuracy::Rounding, &[], &[]).unwrap();
    assert!(empty.parts.is_empty());
}

/// Tests every pair according to the definition. Two groups belong to one set iff they connect the
/// same vertices, or the other parts of both groups stay connected after removal of any vertex.
#[test]
fn cycles_are_what_no_single_vertex_separates() {
    let mut seed = 5_u64;
    let mut below = |n: usize| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % n
    };
    for _ in 0..400 {
        let vertices = 2 + below(6);
        let groups: Vec<Vec<usize>> = (0..1 + below(9))
            .map(|_| {
                let a = below(vertices);
                vec![a, (a + 1 + below(vertices - 1)) % vertices]
            })
            .collect();
        let found = super::cycles(vertices, &groups);
        let set_of = |g: usize| found.iter().position(|set| set.contains(&g));
        // Two edges are on a common cycle iff no vertex, and no single edge, separates them.
        let hang_together = |a: usize, b: usize, without: Option<usize>, edge: Option<usize>| {
            let mut label: Vec<usize> = (0..vertices).collect();
            for (g, pair) in groups.iter().enumerate() {
                if edge == Some(g) || pair.iter().any(|v| Some(*v) == without) {
                    continue;
                }
                let [x, y] = [label[pair[0]], label[pair[1]]];
                label.iter_mut().for_each(|l| {
                    if *l == y {
                        *l = x;
                    }
                });
            }
            let rest = |g: usize| {
                groups[g]
                    .iter()
                    .copied()
                    .filter(move |v| Some(*v) != without)
            };
            rest(a).any(|x| rest(b).any(|y| label[x] == label[y]))
        };
        for a in 0..groups.len() {
            for b in 0..a {
                let by_vertex = (0..vertices).all(|v| hang_together(a, b, Some(v), None));
                // An edge that alone connects the ends of another forms no cycle with it.
                let is_bridge = |g: usize| {
                    let [x, y] = [groups[g][0], groups[g][1]];
                    let mut label: Vec<usize> = (0..vertices).collect();
                    for (_, pair) in groups.iter().enumerate().filter(|(k, _)| *k != g) {
                        let [p, q] = [label[pair[0]], label[pair[1]]];
                        label.iter_mut().for_each(|l| {
                            if *l == q {
                                *l = p;
                            }
                        });
                    }
                    label[x] != label[y]
                };
                let common = by_vertex && !is_bridge(a) && !is_bridge(b);
                assert_eq!(set_of(a) == set_of(b), common, "{groups:?}: {a}, {b}");
            }
        }
    }
}

#[test]
fn a_group_on_three_vertices_holds_them_together() {
    let groups = [vec![0, 1, 2], vec![2, 3], vec![1, 2], vec![4], vec![]];
    let found = super::cycles(5, &groups);
    assert_eq!(found, [vec![0, 2], vec![1], vec![3], vec![4]]);
}

#[test]
fn a_long_chain_of_cycles_needs_no_stack() {
    let n = 50_000;
    let groups: Vec<Vec<usize>> = (0..2 * n).map(|k| vec![k / 2, k / 2 + 1]).collect();
    let found = super::cycles(n + 1, &groups);
    assert_eq!(found.len(), n);
    assert!(found.iter().all(|set| set.len() == 2));
}
