//! The saddle solvers allocate when they are made and nowhere else.

use linalg::{KeptRowSaddle, Matrix, MinimumNormSaddle, ProximalSaddle, Refinement};

const N: usize = 21;
const R: usize = 17;

/// R rows, the last two of which are sums of others in the matrix of all rows.
fn rows(m: usize) -> Matrix {
    let entry = |i: usize, j: usize| ((i * N + j).pow(2) as f64).sin();
    Matrix::from_fn(m, N, |i, j| match i < R {
        true => entry(i, j),
        false => entry(i - R, j) + entry(i - R + 1, j),
    })
}

#[test]
fn factor_and_solve_allocate_nothing() {
    let (c, all) = (rows(R), rows(R + 2));
    let mass = [1.0; N];
    let f = [1.0; N];
    let gamma = all.times(&[0.5; N]);
    let (mut a, mut lambda) = ([0.0; N], [0.0; R + 2]);
    let mut kept = KeptRowSaddle::new(N, R).unwrap();
    let mut least = MinimumNormSaddle::new(&all, R).unwrap();
    let mut proximal = ProximalSaddle::new(&all, &mass, R, 1e-8).unwrap();
    let mut refinement = Refinement::new(N, R);
    let mut accelerations = [[0.0; N]; 4];
    let counted = allocation_counter::measure(|| {
        kept.factor(|k| c.row(k), &mass)
            .and_then(|()| kept.solve(&f, &gamma[..R], &mut a, &mut lambda[..R]))
            .unwrap();
        accelerations[0] = a;
        least
            .factor(&all, &mass)
            .and_then(|()| least.solve(&f, &gamma, &mut a, &mut lambda))
            .unwrap();
        accelerations[1] = a;
        proximal
            .factor(&all, &mass)
            .and_then(|()| proximal.solve(&f, &gamma, &mut a, &mut lambda))
            .unwrap();
        accelerations[2] = a;
        let (a, lambda) = (&mut accelerations[3], &mut lambda[..R]);
        kept.solve_refined(&mut refinement, |k| c.row(k), &f, &gamma[..R], a, lambda)
            .unwrap();
    });
    assert_eq!(counted.count_total, 0);
    for (a, tolerance) in accelerations.iter().zip([1e-12, 1e-12, 1e-6, 1e-14]) {
        for (row, gamma) in c.times(a).iter().zip(&gamma) {
            assert!((row - gamma).abs() < tolerance, "{row} {gamma}");
        }
    }
}
