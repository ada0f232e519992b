joint! { space Spherical(i, j) {
    /// Point `s_i` of body i and point `s_j` of body j coincide.
    params {
        /// The centre of the ball on body i.
        s_i: Point in i,
        /// The centre of the ball on body j.
        s_j: Point in j,
    }
    rows: [x, y, z];
    phi: point(i, s_i) - point(j, s_j);
    place: point(i, s_i);
} }
