joint! { space KnifeEdge(i) {
    /// Point `s` has no velocity along `normal` (a wheel or a blade): `(R·n)·v_s = 0`.
    params {
        /// The contact point.
        s: Point in i,
        /// Direction across the edge, in which the point cannot move.
        normal: Direction in i,
    }
    rows: [normal];
    psi: dot(direction(i, normal), velocity(point(i, s)));
    component N: direction(i, normal);
    place: point(i, s);
} }
