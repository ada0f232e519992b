//! Solves one right-hand side of a long chain of parallelograms by factorisation and solution
//! through the Schur complement, from 3e2 to 1e5 rows.
//!
//! `cargo run --release -p pfaff-linalg --example large_saddle`
#![allow(clippy::print_stdout)]

use std::time::Instant;

use pfaff_linalg::{SchurSaddle, SchurStructure, SparseMatrix};

/// Number of runs of each size; the smallest time is printed.
const RUNS: usize = 15;

fn main() {
    println!("   rows   columns  entries of L  structure    factor     solve    memory  misfit");
    let mut last: Option<(f64, f64)> = None;
    for cells in [30, 300, 3000, 9000] {
        let (c, bodies) = chain(cells);
        let (n, r) = (c.ncols(), c.nrows());
        let blocks: Vec<_> = (0..bodies).map(|b| 3 * b..3 * b + 3).collect();
        let begun = Instant::now();
        let structure = SchurStructure::new(&c, &blocks);
        let analysis = begun.elapsed().as_secs_f64();
        let (entries, bytes) = (structure.n_entries(), structure.bytes());
        let mut saddle = SchurSaddle::new(structure);
        let mass: Vec<f64> = (0..n).map(|j| if j % 3 == 2 { 0.1 } else { 1.0 }).collect();
        let force: Vec<f64> = (0..n)
            .map(|j| if j % 3 == 1 { -9.81 } else { 0.0 })
            .collect();
        let gamma = vec![0.1; r];
        let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; r]);
        let (mut factor, mut solve) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..RUNS {
            let begun = Instant::now();
            saddle.factor(&c, &mass).expect("independent rows");
            factor = factor.min(begun.elapsed().as_secs_f64());
            let begun = Instant::now();
            saddle
                .solve(&c, &force, &gamma, &mut a, &mut lambda)
                .expect("solved");
            solve = solve.min(begun.elapsed().as_secs_f64());
        }
        let mut left = vec![0.0; r];
        c.times(&a, &mut left);
        let misfit = left
            .iter()
            .zip(&gamma)
            .map(|(x, g)| (x - g).abs())
            .fold(0.0, f64::max);
        println!(
            "{r:7} {n:9} {entries:13} {:7.1} ms {:6.2} ms {:6.2} ms {:6.1} MB  {misfit:.1e}",
            analysis * 1e3,
            factor * 1e3,
            solve * 1e3,
            bytes as f64 / 1e6
        );
        let now = (r as f64, factor + solve);
        if let Some((rows, seconds)) = last {
            println!(
                "        exponent {:.2}",
                (now.1 / seconds).ln() / (now.0 / rows).ln()
            );
        }
        last = Some(now);
    }
}

/// Returns the rows of a chain of cells. A cell consists of two or three equal cranks and a
/// coupler, which carries the next cell. One row of each third crank is omitted.
fn chain(cells: usize) -> (SparseMatrix, usize) {
    let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
    let (mut bodies, mut base) = (0, None);
    for cell in 0..cells {
        let cranks = if cell % 3 == 2 { 2 } else { 3 };
        let angle = 0.4 + 0.8 * (0.618 * cell as f64).fract();
        let [x, y] = [0.5 * angle.cos(), 0.5 * angle.sin()];
        let coupler = bodies + cranks;
        for k in 0..cranks {
            let (crank, place) = (bodies + k, k as f64 - 0.5 * (cranks - 1) as f64);
            let joint = |other: Option<usize>, [ax, ay]: [f64; 2], [bx, by]: [f64; 2]| {
                let of = |body: usize, sign: f64, [x, y]: [f64; 2]| {
                    [
                        vec![(3 * body, sign), (3 * body + 2, -sign * y)],
                        vec![(3 * body + 1, sign), (3 * body + 2, sign * x)],
                    ]
                };
                let [mut x_row, mut y_row] = of(crank, 1.0, [ax, ay]);
                if let Some(other) = other {
                    let [x_other, y_other] = of(other, -1.0, [bx, by]);
                    x_row.extend(x_other);
                    y_row.extend(y_other);
                }
                [x_row, y_row]
            };
            rows.extend(joint(base, [-x, -y], [place, 0.1]));
            let [along_x, along_y] = joint(Some(coupler), [x, y], [place, -0.1]);
            rows.push(along_x);
            // The force along the third crank is redundant; its larger component is about along y.
            if k < 2 {
                rows.push(along_y);
            }
        }
        bodies = coupler + 1;
        base = Some(coupler);
    }
    (
        SparseMatrix::from_rows(3 * bodies, rows).expect("columns of bodies"),
        bodies,
    )
}
