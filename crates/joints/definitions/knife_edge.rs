joint! { plane KnifeEdge(i) {
    /// Point `s` has no velocity along `normal` (a wheel or a blade): `(R·n)·v_s = 0`.
    params { s: Point in i, normal: Direction in i }
    rows: [normal];
    psi: dot(direction(i, normal), velocity(point(i, s)));
    component N: direction(i, normal);
    place: point(i, s);
} }
