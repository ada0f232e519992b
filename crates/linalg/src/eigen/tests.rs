//! Compares eigenvalues with closed forms, and checks the residuals for many matrices.

use super::*;

/// The matrix contains Jordan blocks and other eigenvalues, in general axes. Its entries are
/// changed by 1e-15.
#[test]
fn zeros_are_counted_though_rounding_spreads_them() {
    let sizes = [3, 2, 1];
    let n = 9;
    let mut jordan = Matrix::zeros(n, n);
    let mut first = 0;
    for size in sizes {
        for k in first..first + size - 1 {
            jordan[(k, k + 1)] = 2.0;
        }
        first += size;
    }
    // The other eigenvalues are 1e-3 and 4 ± 3i.
    jordan[(6, 6)] = 1e-3;
    (jordan[(7, 7)], jordan[(8, 8)]) = (4.0, 4.0);
    (jordan[(7, 8)], jordan[(8, 7)]) = (3.0, -3.0);
    // The matrix is transformed by a reflection and changed without a pattern.
    let w = Matrix::from_fn(n, 1, |i, _| 1.0 / (1.0 + i as f64).sqrt());
    let square = w.transpose().product(&w)[(0, 0)];
    let turn = Matrix::from_fn(n, n, |i, k| {
        f64::from(u8::from(i == k)) - 2.0 * w[(i, 0)] * w[(k, 0)] / square
    });
    let turned = turn.product(&jordan.product(&turn));
    let a = Matrix::from_fn(n, n, |i, k| {
        turned[(i, k)] + 1e-15 * (7.0 * i as f64 + 3.0 * k as f64).sin()
    });
    let expected = ZeroEigenvalue {
        multiplicity: 6,
        index: 3,
    };
    assert_eq!(zero_eigenvalue(&a, 1e-12), expected);
    assert_eq!(zero_eigenvalue(&turned, 1e-12), expected);
    let whole = Matrix::from_rows(&[[1.0, 5.0], [0.0, 2.0]]);
    assert_eq!(zero_eigenvalue(&whole, 1e-12), ZeroEigenvalue::default());
    // The computed eigenvalues are far from zero.
    let pairs = eigenpairs(&a).expect("converges");
    let sizes = pairs.iter().map(|p| p.value[0].hypot(p.value[1]));
    let mut sizes: Vec<f64> = sizes.collect();
    sizes.sort_by(f64::total_cmp);
    assert!(sizes[5] > 1e-6 && sizes[6] > 9e-4, "{sizes:?}");
}

/// The companion matrix of (λ − 1)(λ + 2)(λ² + 9), in units that differ by 1e±8.
#[test]
fn units_do_not_matter() {
    let companion = Matrix::from_rows(&[
        [-1.0, -7.0, -9.0, 18.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ]);
    let unit = [1.0, 1e8, 1e-8, 1e3];
    let a = Matrix::from_fn(4, 4, |i, k| companion[(i, k)] * unit[k] / unit[i]);
    let found = eigenpairs(&a).expect("converges");
    let expected = [[1.0, 0.0], [0.0, 3.0], [0.0, -3.0], [-2.0, 0.0]];
    for (pair, value) in found.iter().zip(expected) {
        for (x, y) in pair.value.iter().zip(value) {
            assert!((x - y).abs() < 1e-14, "{:?}", pair.value);
        }
        // The residual of A·w = λ·w.
        let [re, im] = [0, 1].map(|part| {
            let part: Vec<f64> = pair.vector.iter().map(|z| z[part]).collect();
            a.times(&part)
        });
        for i in 0..4 {
            let [x, y] = pair.vector[i];
            let [l, m] = pair.value;
            let scale = 1e-13
                * (0..4)
                    .map(|k| a[(i, k)].abs() * pair.vector[k][0].hypot(pair.vector[k][1]))
                    .sum::<f64>();
            assert!((re[i] - l * x + m * y).abs() <= scale, "row {i}");
            assert!((im[i] - l * y - m * x).abs() <= scale, "row {i}");
        }
    }
    assert_eq!(eigenpairs(&Matrix::from_rows(&[[f64::NAN]])), None);
}

/// Pseudo-random values between −1 and 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        // Knuth's multiplier; the upper bits are used.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn matrix(&mut self, n: usize) -> Matrix {
        Matrix::from_fn(n, n, |_, _| self.next())
    }
}

/// Returns a matrix of a kind on which QR algorithms are known to fail, or a random matrix.
fn of_kind(kind: usize, numbers: &mut Numbers) -> Matrix {
    let n = 3 + (9.0 + 9.0 * numbers.next()) as usize;
    match kind {
        // A permutation: all eigenvalues have equal size, and a plain step changes nothing.
        0 => Matrix::from_fn(n, n, |i, k| f64::from(u8::from(k == (i + 1) % n))),
        // Undamped oscillators with the same frequency.
        1 => {
            let square = (1.0 + numbers.next()) * 10.0;
            Matrix::from_fn(2 * n, 2 * n, |i, k| {
                if i < n {
                    f64::from(u8::from(k == i + n))
                } else {
                    -square * f64::from(u8::from(k + n == i))
                }
            })
        }
        // One Jordan block.
        2 => {
            let value = numbers.next();
            Matrix::from_fn(n, n, |i, k| match k.checked_sub(i) {
                Some(0) => value,
                Some(1) => 1.0,
                _ => 0.0,
            })
        }
        // Units that differ by up to 1e±8.
        3 => {
            let units: Vec<f64> = (0..n)
                .map(|_| 10.0_f64.powf(8.0 * numbers.next()))
                .collect();
            let a = numbers.matrix(n);
            Matrix::from_fn(n, n, |i, k| a[(i, k)] * units[i] / units[k])
        }
        // Grcar's matrix, which is far from normal.
        4 => Matrix::from_fn(n, n, |i, k| match k as i64 - i as i64 {
            -1 => -1.0,
            0..=3 => 1.0,
            _ => 0.0,
        }),
        // Frank's matrix, whose small eigenvalues are ill-conditioned.
        5 => Matrix::from_fn(n, n, |i, k| {
            if k + 1 < i {
                0.0
            } else {
                (n - i.max(k)) as f64
            }
        }),
        6 => Matrix::zeros(n, n),
        // Rows and columns of very different sizes.
        7 => {
            let a = numbers.matrix(n);
            Matrix::from_fn(n, n, |i, k| a[(i, k)] * 10.0_f64.powi(-((i + k) as i32)))
        }
        // Rank one and rank two.
        8 => {
            let (x, y) = (numbers.matrix(n), numbers.matrix(n));
            let rank = 1 + n % 2;
            let part = |a: &Matrix| Matrix::from_fn(n, rank, |i, k| a[(i, k)]);
            part(&x).product(&part(&y).transpose())
        }
        // Rotations and reflections: all eigenvalues on the unit circle.
        9 => PivotedQr::of_columns(&numbers.matrix(n)).q_columns(0..n),
        // Large and small entries.
        10 => {
            let unit = 10.0_f64.powf(140.0 * numbers.next());
            let a = numbers.matrix(n);
            Matrix::from_fn(n, n, |i, k| unit * a[(i, k)])
        }
        _ => numbers.matrix(n),
    }
}

/// Each pair satisfies its equation to rounding, and the sum of the eigenvalues equals the sum of
/// the diagonal.
#[test]
fn matrices_of_every_kind_have_small_residuals() {
    let mut numbers = Numbers(1);
    for k in 0..10_000 {
        let a = of_kind(k % 20, &mut numbers);
        let n = a.nrows();
        let pairs = eigenpairs(&a).unwrap_or_else(|| panic!("matrix {k} does not converge"));
        assert_eq!(pairs.len(), n);
        let norm = a.as_slice().iter().fold(0.0_f64, |a, x| a.hypot(*x));
        let bound = n as f64 * f64::EPSILON * norm;
        for pair in &pairs {
            let [l, m] = pair.value;
            let [re, im] = [0, 1].map(|part| {
                let part: Vec<f64> = pair.vector.iter().map(|z| z[part]).collect();
                a.times(&part)
            });
            let missed = (0..n).fold(0.0_f64, |sum, i| {
                let [x, y] = pair.vector[i];
                sum.hypot(re[i] - l * x + m * y)
                    .hypot(im[i] - l * y - m * x)
            });
            let length = pair
                .vector
                .iter()
                .flatten()
                .fold(0.0_f64, |a, x| a.hypot(*x));
            assert!((length - 1.0).abs() < 1e-14, "matrix {k}: length {length}");
            assert!(
                missed <= 5.0 * bound,
                "matrix {k} of {n}: {missed:e}, {bound:e}"
            );
        }
        let trace: f64 = (0..n).map(|i| a[(i, i)]).sum();
        let sum: f64 = pairs.iter().map(|p| p.value[0]).sum();
        assert!(
            (trace - sum).abs() <= 10.0 * bound,
            "matrix {k}: {trace:e}, {sum:e}"
        );
    }
}

/// Eigenvalues that are zero or roots of unity are exact to rounding.
#[test]
fn permutations_have_roots_of_one() {
    for n in 3..=20 {
        let a = Matrix::from_fn(n, n, |i, k| f64::from(u8::from(k == (i + 1) % n)));
        let pairs = eigenpairs(&a).expect("converges");
        for pair in &pairs {
            let [x, y] = pair.value;
            let turned = y.atan2(x) * n as f64 / std::f64::consts::TAU;
            assert!((x.hypot(y) - 1.0).abs() < 1e-14 && (turned - turned.round()).abs() < 1e-12);
        }
        // Pairs are conjugate to the last bit.
        let sum: f64 = pairs.iter().map(|p| p.value[1]).sum();
        assert_eq!(sum, 0.0);
    }
}
