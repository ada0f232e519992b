//! Compares circuits with a brute-force search over all subsets of rows of small integer matrices,
//! in exact arithmetic.

use super::*;
use crate::decide;
use linalg::Matrix;

/// Returns the rank, by fraction-free elimination in integers.
fn exact_rank(rows: &[Vec<i128>]) -> usize {
    let mut a = rows.to_vec();
    let n = a.first().map_or(0, Vec::len);
    let mut rank = 0;
    for column in 0..n {
        let Some(at) = (rank..a.len()).find(|&i| a[i][column] != 0) else {
            continue;
        };
        a.swap(rank, at);
        for i in rank + 1..a.len() {
            let (pivot, factor) = (a[rank][column], a[i][column]);
            for k in 0..n {
                a[i][k] = a[i][k] * pivot - factor * a[rank][k];
            }
        }
        rank += 1;
    }
    rank
}

/// Returns all minimal dependent sets of rows. Every set is tested.
fn all_circuits(rows: &[Vec<i128>]) -> Vec<Vec<usize>> {
    let rank_of =
        |set: &[usize]| exact_rank(&set.iter().map(|&i| rows[i].clone()).collect::<Vec<_>>());
    let mut circuits: Vec<Vec<usize>> = Vec::new();
    for size in 1..=rows.len() {
        for set in subsets(rows.len(), size) {
            let contains = |c: &Vec<usize>| c.iter().all(|i| set.contains(i));
            if !circuits.iter().any(contains) && rank_of(&set) < size {
                circuits.push(set);
            }
        }
    }
    circuits
}

/// Returns small integers from a seed. A few rows repeat, vanish, or are sums of other rows, as in
/// mechanisms.
fn integer_rows(seed: u64, m: usize, n: usize) -> Vec<Vec<i128>> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = |below: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) % below
    };
    let mut rows: Vec<Vec<i128>> = Vec::new();
    for _ in 0..m {
        let row = match (rows.len(), next(5)) {
            (1.., 0) => rows[next(rows.len() as u64) as usize]
                .iter()
                .map(|x| 3 * x)
                .collect(),
            (2.., 1) => {
                let pair = [0; 2].map(|_| next(rows.len() as u64) as usize);
                (0..n)
                    .map(|k| rows[pair[0]][k] - 2 * rows[pair[1]][k])
                    .collect()
            }
            _ => (0..n)
                .map(|_| [0, 0, 0, 1, 1, -1, 2, -3][next(8) as usize])
                .collect(),
        };
        rows.push(row);
    }
    rows
}

fn matrix(rows: &[Vec<i128>]) -> Matrix {
    Matrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j] as f64)
}

#[test]
fn short_circuits_are_the_shortest_basis_of_all_circuits() {
    let mut redundancies = [0; 9];
    for seed in 1..=300 {
        let rows = integer_rows(seed, 4 + seed as usize % 6, 2 + seed as usize % 4);
        let c = matrix(&rows);
        let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
        assert_eq!(decision.rank, exact_rank(&rows), "seed {seed}");
        redundancies[decision.redundancy] += 1;
        let exact = all_circuits(&rows);
        let found = short_circuits(&decision);
        // Each vector is a circuit, and its coefficients cancel its rows. All vectors together span
        // the dependencies.
        let z = Matrix::from_fn(found.len(), c.nrows(), |k, i| {
            let at = found[k].rows.iter().position(|&row| row == i);
            at.map_or(0.0, |at| found[k].coefficients[at])
        });
        for circuit in &found {
            assert!(
                exact.contains(&circuit.rows),
                "seed {seed}: {:?} is no circuit",
                circuit.rows
            );
        }
        assert!(z.product(&c).max_abs() < 1e-12, "seed {seed}");
        assert_eq!(found.len(), decision.redundancy);
        assert_eq!(
            decide(&z, crate::Accuracy::Rounding).unwrap().rank,
            decision.redundancy,
            "seed {seed}"
        );
        // No independent set of circuits is shorter. The test makes the greedy choice from the
        // exact list, with ranks of the exact rows.
        let total: usize = found.iter().map(|c| c.rows.len()).sum();
        assert_eq!(
            total,
            shortest_total(&rows, &exact, decision.redundancy),
            "seed {seed}"
        );
    }
    assert!(
        redundancies[3..].iter().sum::<usize>() > 100,
        "{redundancies:?}"
    );
}

/// Returns the total length of a shortest basis of circuits. The vector of a circuit is computed
/// from cofactors, so it is exact.
fn shortest_total(rows: &[Vec<i128>], circuits: &[Vec<usize>], p: usize) -> usize {
    let mut basis: Vec<Vec<i128>> = Vec::new();
    let mut total = 0;
    for circuit in circuits {
        let mut larger = basis.clone();
        larger.push(exact_dependency(rows, circuit));
        if exact_rank(&larger) == larger.len() {
            basis = larger;
            total += circuit.len();
        }
    }
    assert_eq!(basis.len(), p);
    total
}

/// Returns the dependency of a circuit in integers, from elimination of the rows with an identity
/// matrix appended.
fn exact_dependency(rows: &[Vec<i128>], circuit: &[usize]) -> Vec<i128> {
    let (n, k) = (rows[0].len(), circuit.len());
    let mut a: Vec<Vec<i128>> = (0..k)
        .map(|i| {
            let unit = (0..k).map(|j| i128::from(i == j));
            rows[circuit[i]].iter().copied().chain(unit).collect()
        })
        .collect();
    let mut done = 0;
    for column in 0..n {
        let Some(at) = (done..k).find(|&i| a[i][column] != 0) else {
            continue;
        };
        a.swap(done, at);
        for i in done + 1..k {
            let (pivot, factor) = (a[done][column], a[i][column]);
            for j in 0..n + k {
                a[i][j] = a[i][j] * pivot - factor * a[done][j];
            }
        }
        done += 1;
    }
    assert_eq!(done, k - 1);
    let mut z = vec![0; rows.len()];
    // Elimination leaves a common factor, which would overflow in the next step.
    let dependency = &a[k - 1][n..];
    let gcd = dependency.iter().fold(0_i128, |mut a, &b| {
        let mut b = b.abs();
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    });
    for (&row, x) in circuit.iter().zip(dependency) {
        z[row] = x / gcd;
    }
    z
}

/// If there are too many hyperplanes, the fundamental circuits are returned instead.
#[test]
fn a_component_with_too_many_circuits_falls_back() {
    let c = Matrix::from_fn(30, 15, |i, j| ((i * i + 7 * j * j + i * j) as f64).sin());
    let decision = decide(&c, crate::Accuracy::Rounding).unwrap();
    assert_eq!(decision.redundancy, 15);
    let found = short_circuits(&decision);
    assert_eq!(found.len(), 15);
    // Any 15 rows of a generic matrix are independent, and any 16 rows are a circuit.
    assert!(found.iter().all(|c| c.rows.len() == 16));
}

/// Two vectors that differ by 1e-3 determine the plane that they span. Two vectors that differ by
/// 1e-5 do not determine it.
#[test]
fn vectors_have_to_span_what_a_circuit_vanishes_on() {
    let rows = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [2.0, 1.0]];
    let decision = decide(&Matrix::from_rows(&rows), crate::Accuracy::Rounding).unwrap();
    let all: Vec<usize> = (0..rows.len()).collect();
    let dual = Dual::new(&decision, &Support::new(&decision), &all);
    for (apart, is_found) in [(1e-3, true), (1e-5, false)] {
        let vectors = vec![vec![1.0, 1.0, 1.0], vec![1.0, 1.0, 1.0 + apart]];
        let found = vanishing_on(vectors, dual.dimension(), &dual);
        assert_eq!(found.is_some(), is_found, "{apart}");
    }
}
