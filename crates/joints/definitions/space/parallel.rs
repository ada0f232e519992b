joint! { space Parallel(i, j) {
    /// The axes of both bodies stay parallel.
    params {
        /// The axis on body i.
        axis: Axes in i,
        /// The axis on body j.
        axis_j: Axes in j like axis,
    }
    let w = direction(j, axis_j[2]);
    rows: [axis_u, axis_v];
    phi: [
        dot(direction(i, axis[0]), w),
        dot(direction(i, axis[1]), w),
    ];
    place: origin(i);
} }
