//! Compares timings of the kernels with nalgebra and faer, in one run on one machine. Compare
//! ratios, not absolute values: `cargo run --release -p bench --features faer --example timings`.
#![allow(clippy::print_stdout, reason = "this example exists for its output")]

use std::hint::black_box;
use std::time::Instant;

use faer::linalg::solvers::Solve;
use linalg::{KeptRowSaddle, Matrix, singular_values};
use nalgebra::{DMatrix, DVector};
use rank::decide;

/// Returns the time of one call (µs), which is the median over batches.
fn microseconds(mut call: impl FnMut()) -> f64 {
    const BATCHES: usize = 31;
    const BATCH_SECONDS: f64 = 0.01;
    let start = Instant::now();
    call();
    let calls = (BATCH_SECONDS / start.elapsed().as_secs_f64().max(1e-7)).ceil() as usize;
    let mut times: Vec<f64> = (0..BATCHES)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..calls {
                call();
            }
            start.elapsed().as_secs_f64() * 1e6 / calls as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[BATCHES / 2]
}

/// Returns an r×n matrix with `per_row` entries in each row, or with all entries.
fn rows(r: usize, n: usize, per_row: usize) -> Matrix {
    Matrix::from_fn(r, n, |i, j| {
        if (j + n - i) % n < per_row {
            ((i * n + j) as f64 * 1.7).sin() + if i == j { 2.0 } else { 0.0 }
        } else {
            0.0
        }
    })
}

fn saddle(n: usize, r: usize, per_row: usize) {
    let c = rows(r, n, per_row);
    let mass: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
    let (f, gamma) = (vec![1.0; n], vec![0.5; r]);
    let (mut a, mut lambda) = (vec![0.0; n], vec![0.0; r]);
    let mut ours = KeptRowSaddle::new(n, r).expect("r ≤ n");
    let t_ours = microseconds(|| {
        ours.factor(|k| black_box(&c).row(k), &mass)
            .expect("independent rows");
        ours.solve(&f, &gamma, &mut a, &mut lambda)
            .expect("finite input");
    });

    let order = n + r;
    let entry = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) if i == j => mass[i],
        (false, true) => c[(i - n, j)],
        (true, false) => c[(j - n, i)],
        _ => 0.0,
    };
    let rhs = |i: usize| if i < n { f[i] } else { gamma[i - n] };
    let full = DMatrix::from_fn(order, order, entry);
    let b = DVector::from_fn(order, |i, _| rhs(i));
    let mut x = b.clone();
    let t_nalgebra = microseconds(|| {
        x = black_box(&full).clone().lu().solve(&b).expect("regular");
    });
    for i in 0..order {
        let found = if i < n { a[i] } else { lambda[i - n] };
        assert!(
            (found - x[i]).abs() < 1e-9 * x.amax(),
            "{i}: {found} {}",
            x[i]
        );
    }
    let full = faer::Mat::from_fn(order, order, entry);
    let b = faer::Mat::from_fn(order, 1, |i, _| rhs(i));
    let t_faer = microseconds(|| {
        black_box(black_box(&full).partial_piv_lu().solve(&b));
    });
    println!(
        "saddle n = {n:3}, r = {r:3}, {per_row:3} entries per row: ours {t_ours:8.2} µs, \
         nalgebra LU {t_nalgebra:8.2} µs, faer LU {t_faer:8.2} µs"
    );
}

fn spectrum(n: usize) {
    let a = rows(n, n, n);
    let ours = microseconds(|| {
        black_box(singular_values(black_box(&a)));
    });
    let decision = microseconds(|| {
        black_box(decide(black_box(&a), rank::Accuracy::Rounding).expect("finite"));
    });
    let dense = DMatrix::from_row_slice(n, n, a.as_slice());
    let nalgebra = microseconds(|| {
        black_box(black_box(&dense).singular_values());
    });
    let dense = faer::Mat::from_fn(n, n, |i, j| a[(i, j)]);
    let faer = microseconds(|| {
        black_box(black_box(&dense).singular_values().expect("convergence"));
    });
    println!(
        "singular values {n:3}×{n:3}: ours {ours:9.1} µs, nalgebra {nalgebra:9.1} µs, \
         faer {faer:9.1} µs; whole rank decision {decision:9.1} µs"
    );
}

fn main() {
    saddle(21, 20, 21);
    saddle(21, 20, 4);
    saddle(12, 11, 12);
    saddle(60, 50, 60);
    saddle(150, 140, 150);
    for n in [12, 22, 43, 63, 64, 100, 200, 400, 600] {
        spectrum(n);
    }
}
