//! The saddle solver allocates in `new` and nowhere else.

use linalg::KeptRowSaddle;

#[test]
fn factor_and_solve_allocate_nothing() {
    const N: usize = 21;
    const R: usize = 17;
    let c: Vec<f64> = (0..R * N).map(|l| ((l * l) as f64).sin()).collect();
    let mass = [1.0; N];
    let (f, gamma) = ([1.0; N], [0.5; R]);
    let (mut a, mut lambda) = ([0.0; N], [0.0; R]);
    let mut saddle = KeptRowSaddle::new(N, R).unwrap();
    let counted = allocation_counter::measure(|| {
        saddle
            .factor(|k| &c[k * N..(k + 1) * N], &mass)
            .and_then(|()| saddle.solve(&f, &gamma, &mut a, &mut lambda))
            .unwrap();
    });
    assert_eq!(counted.count_total, 0);
    let residual: f64 = c[..N].iter().zip(&a).map(|(x, y)| x * y).sum::<f64>() - 0.5;
    assert!(residual.abs() < 1e-12, "{residual:e}");
}
