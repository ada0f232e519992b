//! The inner loop of explicit methods: sums of stages. Each method chooses its stages and weights.

/// Writes `y = y0 + h·Σ w_j k_j`. All slices are at least as long as `y`.
#[inline]
pub(crate) fn combine<const N: usize>(
    y: &mut [f64],
    y0: &[f64],
    h: f64,
    terms: [(f64, &[f64]); N],
) {
    let n = y.len();
    let (y0, terms) = (&y0[..n], terms.map(|(w, k)| (w, &k[..n])));
    for i in 0..n {
        let mut sum = 0.0;
        for (w, k) in terms {
            sum += w * k[i];
        }
        y[i] = y0[i] + h * sum;
    }
}
