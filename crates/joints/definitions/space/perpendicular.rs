joint! { space Perpendicular(i, j) {
    /// The axis of body i stays perpendicular to the axis of body j.
    params {
        /// The axis on body i.
        axis: Direction in i,
        /// The axis on body j.
        cross: Direction in j,
    }
    rows: [cross];
    phi: dot(direction(i, axis), direction(j, cross));
    place: origin(i);
} }
