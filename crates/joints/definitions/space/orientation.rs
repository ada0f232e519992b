joint! { space Orientation(i, j) {
    /// The axes of both bodies stay parallel: the bodies do not rotate relative to each other.
    params {
        /// Axes of body i.
        axes: Axes in i optional,
        /// The axes of body j, parallel to the axes of body i.
        axes_j: Axes in j like axes,
    }
    let w = direction(j, axes_j[2]);
    rows: [axis_u, axis_v, turn];
    phi: [
        dot(direction(i, axes[0]), w),
        dot(direction(i, axes[1]), w),
        dot(direction(i, axes[1]), direction(j, axes_j[0])),
    ];
    place: origin(i);
} }
