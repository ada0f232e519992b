/// The cubic spline through points `[t, value, second derivative]`, continued as straight lines, with two derivatives.
fn spline(t: f64, points: &[[f64; 3]]) -> [f64; 3] {
    let last = points.len() - 1;
    let inner = |k: usize, t: f64| {
        let ([ta, fa, ka], [tb, fb, kb]) = (points[k], points[k + 1]);
        let h = tb - ta;
        let (a, b) = ((tb - t) / h, (t - ta) / h);
        [
            a * fa + b * fb + h * h / 6.0 * (a * (a * a - 1.0) * ka + b * (b * b - 1.0) * kb),
            (fb - fa) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * ka + (3.0 * b * b - 1.0) * kb),
            a * ka + b * kb,
        ]
    };
    if t < points[0][0] || t > points[last][0] {
        let (end, at) = if t < points[0][0] { (0, 0) } else { (last, last - 1) };
        let [from, value, _] = points[end];
        let slope = inner(at, from)[1];
        return [value + slope * (t - from), slope, 0.0];
    }
    inner(points.partition_point(|p| p[0] <= t).clamp(1, last) - 1, t)
}
