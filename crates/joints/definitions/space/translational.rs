joint! { space Translational(i, j) {
    /// Point `s_j` of body j stays on the line through point `s_i` of body i along `axis`, and the
    /// bodies do not rotate relative to each other.
    params {
        /// A point of the line in body i.
        s_i: Point in i,
        /// The point of body j that stays on the line.
        s_j: Point in j,
        /// The line in body i.
        axis: Axes in i,
        /// The axes of body j, which stay parallel to the axes of body i.
        axis_j: Axes in j like axis,
    }
    let d = point(j, s_j) - point(i, s_i);
    let w = direction(j, axis_j[2]);
    rows: [u, v, axis_u, axis_v, turn];
    phi: [
        dot(direction(i, axis[0]), d),
        dot(direction(i, axis[1]), d),
        dot(direction(i, axis[0]), w),
        dot(direction(i, axis[1]), w),
        dot(direction(i, axis[1]), direction(j, axis_j[0])),
    ];
    measure displacement: dot(direction(i, axis[2]), d);
    place: point(i, s_i);
} }
