/// `start` and steps `[from, to, by]` of `by·(10s³ − 15s⁴ + 6s⁵)` with two derivatives.
fn steps(t: f64, start: f64, steps: &[[f64; 3]]) -> [f64; 3] {
    let mut jet = [start, 0.0, 0.0];
    for &[from, to, by] in steps {
        if t >= to {
            jet[0] += by;
        } else if t > from {
            let span = to - from;
            let s = (t - from) / span;
            jet[0] += by * s * s * s * (10.0 + s * (6.0 * s - 15.0));
            jet[1] += by / span * 30.0 * s * s * (s - 1.0) * (s - 1.0);
            jet[2] += by / (span * span) * 60.0 * s * (s - 1.0) * (2.0 * s - 1.0);
        }
    }
    jet
}
