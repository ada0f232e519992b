joint! { space Revolute(i, j) {
    /// Point `s_i` of body i and point `s_j` of body j coincide, and the axes of both bodies are parallel.
    params {
        /// A point of the axis on body i.
        s_i: Point in i,
        /// The same point on body j.
        s_j: Point in j,
        /// The axis on body i, about which body j rotates right-handed.
        axis: Axes in i,
        /// The axis on body j.
        axis_j: Axes in j like axis,
    }
    let w = direction(j, axis_j[2]);
    rows: [x, y, z, axis_u, axis_v];
    phi: [
        point(i, s_i) - point(j, s_j),
        dot(direction(i, axis[0]), w),
        dot(direction(i, axis[1]), w),
    ];
    measure angle: angle(axis, axis_j);
    place: point(i, s_i);
} }
