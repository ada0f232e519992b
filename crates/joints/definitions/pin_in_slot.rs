joint! { plane PinInSlot(i, j) {
    /// Point `s_j` of body j stays on the line through point `s_i` of body i along `axis`.
    params {
        /// A point of the slot in body i.
        s_i: Point in i,
        /// The pin on body j.
        s_j: Point in j,
        /// Direction of the slot.
        axis: Direction in i,
    }
    let d = point(j, s_j) - point(i, s_i);
    rows: [normal];
    phi: dot(perp(direction(i, axis)), d);
    measure displacement: dot(direction(i, axis), d);
    measure angle: angle(j) - angle(i);
    place: point(i, s_i);
} }
