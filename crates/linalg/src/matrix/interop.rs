//! Conversions from and to `nalgebra::DMatrix` at the public boundary, behind the feature
//! `nalgebra`. The conversions copy the values, because nalgebra stores columns and this crate
//! stores rows.

use nalgebra::DMatrix;

use super::Matrix;

impl From<&DMatrix<f64>> for Matrix {
    fn from(a: &DMatrix<f64>) -> Self {
        Self::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
    }
}

impl From<DMatrix<f64>> for Matrix {
    fn from(a: DMatrix<f64>) -> Self {
        Self::from(&a)
    }
}

impl From<&Matrix> for DMatrix<f64> {
    fn from(a: &Matrix) -> Self {
        DMatrix::from_row_slice(a.nrows(), a.ncols(), a.as_slice())
    }
}

impl From<Matrix> for DMatrix<f64> {
    fn from(a: Matrix) -> Self {
        Self::from(&a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        let a = Matrix::from_rows(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let b: DMatrix<f64> = (&a).into();
        assert_eq!(b[(1, 0)], 4.0);
        assert_eq!(Matrix::from(b), a);
    }
}
