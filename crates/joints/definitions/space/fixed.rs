joint! { space Fixed(i, j) {
    /// Point `s_i` of body i and point `s_j` of body j coincide, and the axes of both bodies stay parallel.
    params {
        /// The point of body i at which the reaction is reported.
        s_i: Point in i,
        /// The same point on body j.
        s_j: Point in j,
        /// Axes of body i.
        axes: Axes in i optional,
        /// The axes of body j, parallel to the axes of body i.
        axes_j: Axes in j like axes,
    }
    let w = direction(j, axes_j[2]);
    rows: [x, y, z, axis_u, axis_v, turn];
    phi: [
        point(i, s_i) - point(j, s_j),
        dot(direction(i, axes[0]), w),
        dot(direction(i, axes[1]), w),
        dot(direction(i, axes[1]), direction(j, axes_j[0])),
    ];
    place: point(i, s_i);
} }
