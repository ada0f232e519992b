joint! { space Cylindrical(i, j) {
    /// Point `s_j` of body j stays on the line through point `s_i` of body i along `axis`, and the
    /// axes of both bodies are parallel: body j slides along the axis and rotates about it.
    params {
        /// A point of the axis on body i.
        s_i: Point in i,
        /// The point of body j that stays on the axis.
        s_j: Point in j,
        /// The axis on body i.
        axis: Axes in i,
        /// The axis on body j.
        axis_j: Axes in j like axis,
    }
    let d = point(j, s_j) - point(i, s_i);
    let w = direction(j, axis_j[2]);
    rows: [u, v, axis_u, axis_v];
    phi: [
        dot(direction(i, axis[0]), d),
        dot(direction(i, axis[1]), d),
        dot(direction(i, axis[0]), w),
        dot(direction(i, axis[1]), w),
    ];
    measure displacement: dot(direction(i, axis[2]), d);
    measure angle: angle(axis, axis_j);
    place: point(i, s_i);
} }
