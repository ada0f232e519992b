joint! { space PointOnLine(i, j) {
    /// Point `s_j` of body j stays on the line through point `s_i` of body i along `axis`.
    params {
        /// A point of the line in body i.
        s_i: Point in i,
        /// The point of body j that stays on the line.
        s_j: Point in j,
        /// The line in body i.
        axis: Axes in i,
    }
    let d = point(j, s_j) - point(i, s_i);
    rows: [u, v];
    phi: [
        dot(direction(i, axis[0]), d),
        dot(direction(i, axis[1]), d),
    ];
    place: point(i, s_i);
} }
