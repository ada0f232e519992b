joint! { space PointOnPlane(i, j) {
    /// Point `s_j` of body j stays in the plane through point `s_i` of body i normal to `normal`.
    params {
        /// A point of the plane in body i.
        s_i: Point in i,
        /// The point of body j that stays in the plane.
        s_j: Point in j,
        /// The normal of the plane in body i.
        normal: Direction in i,
    }
    rows: [gap normal];
    phi: dot(direction(i, normal), point(j, s_j) - point(i, s_i));
    place: point(i, s_i);
} }
