joint! { plane KnifeEdge(i) {
    /// Point `s` has no velocity along `normal` (a wheel or a blade): `(R·n)·v_s = 0`.
    params {
        /// Where the edge touches the plane.
        s: Point in i,
        /// Across the edge: the point does not move this way.
        normal: Direction in i,
    }
    rows: [normal];
    psi: dot(direction(i, normal), velocity(point(i, s)));
    component N: direction(i, normal);
    place: point(i, s);
} }
