joint! { space Planar(i, j) {
    /// Point `s_j` of body j stays in the plane through point `s_i` of body i normal to `normal`,
    /// and the normals of both bodies are parallel.
    params {
        /// A point of the plane on body i.
        s_i: Point in i,
        /// The point of body j that stays in the plane.
        s_j: Point in j,
        /// The normal of the plane on body i.
        normal: Axes in i,
        /// The normal on body j.
        normal_j: Axes in j like normal,
    }
    let w = direction(j, normal_j[2]);
    rows: [normal, axis_u, axis_v];
    phi: [
        dot(direction(i, normal[2]), point(j, s_j) - point(i, s_i)),
        dot(direction(i, normal[0]), w),
        dot(direction(i, normal[1]), w),
    ];
    place: point(i, s_i);
} }
