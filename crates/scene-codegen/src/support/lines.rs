/// Straight lines through points `[t, value]` with two derivatives; at a point the line that begins there.
fn lines(t: f64, points: &[[f64; 2]]) -> [f64; 3] {
    let k = points.partition_point(|p| p[0] <= t).clamp(1, points.len() - 1);
    let ([ta, fa], [tb, fb]) = (points[k - 1], points[k]);
    let rate = (fb - fa) / (tb - ta);
    [fa + rate * (t - ta), rate, 0.0]
}
