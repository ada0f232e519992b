joint! { plane Translational(i, j) {
    /// Point `s_j` of body j stays on the line through point `s_i` of body i along `axis`; the relative angle keeps its
    /// initial value.
    params {
        /// A point of the line in body i.
        s_i: Point in i,
        /// The point of body j that stays on the line.
        s_j: Point in j,
        /// Direction of the line.
        axis: Direction in i,
    }
    let d = point(j, s_j) - point(i, s_i);
    initial { angle_0: Angle = angle(j) - angle(i) }
    rows: [normal, angle];
    phi: [
        dot(perp(direction(i, axis)), d),
        angle(j) - angle(i) - angle_0,
    ];
    measure displacement: dot(direction(i, axis), d);
    place: point(i, s_i);
} }
