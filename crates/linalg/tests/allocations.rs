//! The saddle solvers allocate only when they are created, and at their first rows, which determine
//! the order of elimination.

use pfaff_linalg::{KeptRowSaddle, Matrix, Refinement};

const N: usize = 21;
const R: usize = 17;

#[test]
fn factor_and_solve_allocate_nothing() {
    let c = Matrix::from_fn(R, N, |i, j| ((i * N + j).pow(2) as f64).sin());
    let mass = [1.0; N];
    let f = [1.0; N];
    let gamma = c.times(&[0.5; N]);
    let (mut a, mut lambda) = ([0.0; N], [0.0; R]);
    let mut kept = KeptRowSaddle::new(N, R).unwrap();
    kept.factor(|k| c.row(k), &mass).unwrap();
    let mut refinement = Refinement::new(N, R);
    let mut accelerations = [[0.0; N]; 2];
    let counted = allocation_counter::measure(|| {
        kept.factor(|k| c.row(k), &mass)
            .and_then(|()| kept.solve(&f, &gamma, &mut a, &mut lambda))
            .unwrap();
        accelerations[0] = a;
        let a = &mut accelerations[1];
        kept.solve_refined(&mut refinement, |k| c.row(k), &f, &gamma, a, &mut lambda)
            .unwrap();
    });
    assert_eq!(counted.count_total, 0);
    for (a, tolerance) in accelerations.iter().zip([1e-12, 1e-14]) {
        for (row, gamma) in c.times(a).iter().zip(&gamma) {
            assert!((row - gamma).abs() < tolerance, "{row} {gamma}");
        }
    }
}
