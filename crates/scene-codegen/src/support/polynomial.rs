/// `Σ c[k]·tᵏ` with two derivatives.
fn polynomial(t: f64, c: &[f64]) -> [f64; 3] {
    let mut jet = [0.0; 3];
    for c in c.iter().rev() {
        let [f, d, dd] = jet;
        jet = [f * t + c, d * t + f, dd * t + 2.0 * d];
    }
    jet
}
