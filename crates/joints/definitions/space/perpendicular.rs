joint! { space Perpendicular(i, j) {
    /// The axis of body i stays perpendicular to the axis of body j.
    params {
        /// The axis on body i.
        axis: Direction in i,
        /// The axis on body j.
        cross: Direction in j,
    }
    let k = dot(direction(i, axis), direction(j, cross));
    require "its two axes do not lie along one line": 1.0 - k * k > 0.000001;
    rows: [cross];
    phi: k;
    place: origin(i);
} }
