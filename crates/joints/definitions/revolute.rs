joint! { plane Revolute(i, j) {
    /// Point `s_i` of body i and point `s_j` of body j coincide.
    params {
        /// The pin on body i.
        s_i: Point in i,
        /// The pin on body j.
        s_j: Point in j,
    }
    rows: [x, y];
    phi: point(i, s_i) - point(j, s_j);
    measure angle: angle(j) - angle(i);
    place: point(i, s_i);
} }
