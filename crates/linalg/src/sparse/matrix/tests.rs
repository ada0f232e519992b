//! Comparison with dense matrices.

use super::*;

fn example() -> SparseMatrix {
    let rows = [
        vec![(3, 4.0), (0, 1.0)],
        vec![],
        vec![(1, -2.0), (1, 5.0), (2, 0.5)],
    ];
    SparseMatrix::from_rows(4, rows).expect("columns below 4")
}

#[test]
fn dense_and_back() {
    let dense = Matrix::from_rows(&[[1.0, 0.0, 0.0, 4.0], [0.0; 4], [0.0, 3.0, 0.5, 0.0]]);
    assert_eq!(example().dense(), dense);
    assert_eq!(SparseMatrix::from_dense(&dense), example());
    assert_eq!(example().transpose().dense(), dense.transpose());
    assert_eq!(example().transpose().transpose(), example());
    assert_eq!(
        example().select_rows(&[2, 0]).dense(),
        dense.select_rows(&[2, 0])
    );
}

#[test]
fn products_are_those_of_the_dense_matrix() {
    let (c, x, y) = (example(), [1.0, 2.0, 3.0, 4.0], [1.0, 10.0, 100.0]);
    let (mut cx, mut cty) = ([f64::NAN; 3], [f64::NAN; 4]);
    c.times(&x, &mut cx);
    c.transposed_times(&y, &mut cty);
    assert_eq!(cx, [17.0, 0.0, 7.5]);
    assert_eq!(cty, [1.0, 300.0, 50.0, 4.0]);
}

#[test]
fn wrong_column_is_named() {
    let error = SparseMatrix::from_rows(2, [vec![(1, 1.0)], vec![(0, 1.0), (2, 1.0)]]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "entry in row 1, column 2 of a matrix of 2 columns"
    );
}

#[test]
fn non_finite_entry_is_located() {
    let rows = [vec![], vec![(0, 1.0)], vec![], vec![(1, f64::NEG_INFINITY)]];
    let c = SparseMatrix::from_rows(2, rows).expect("columns below 2");
    assert_eq!(c.first_non_finite(), Some((3, 1, f64::NEG_INFINITY)));
    assert_eq!(example().first_non_finite(), None);
}

#[test]
fn empty_shapes_are_legal() {
    let none = SparseMatrix::from_rows(3, [[]; 0]).expect("no entries");
    assert_eq!(none.transpose().dense(), Matrix::zeros(3, 0));
    let narrow = SparseMatrix::from_rows(0, [[], []]).expect("no entries");
    assert_eq!(narrow.dense(), Matrix::zeros(2, 0));
    narrow.times(&[], &mut [1.0, 1.0]);
}

#[test]
fn scaling_is_that_of_the_dense_matrix() {
    let dense = Matrix::from_fn(9, 7, |i, j| match (i * j + i) % 3 {
        0 => (1.0 + (3 * i + 5 * j) as f64).sin() * 10f64.powi(4 * i as i32 - 7 * j as i32),
        _ => 0.0,
    });
    let sparse = SparseMatrix::from_dense(&dense);
    let scaling = crate::equilibrate_sparse(&sparse);
    assert_eq!(scaling, crate::equilibrate(&dense));
    assert_eq!(scaling.apply_sparse(&sparse).dense(), scaling.apply(&dense));
}
