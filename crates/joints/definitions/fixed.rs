joint! { plane Fixed(i, j) {
    /// Point `s_j` of body j keeps its initial position in body i, and the relative angle keeps its
    /// initial value.
    params {
        /// The point of body i at which the reaction is reported.
        s_i: Point in i,
        /// The point of body j that keeps its position in body i.
        s_j: Point in j,
    }
    initial {
        offset: Vector in i = local(i, point(j, s_j) - point(i, s_i)),
        angle_0: Angle = angle(j) - angle(i),
    }
    rows: [x, y, angle];
    phi: [
        point(i, s_i) + vector(i, offset) - point(j, s_j),
        angle(j) - angle(i) - angle_0,
    ];
    place: point(i, s_i);
} }
