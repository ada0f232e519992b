joint! { plane PointOnLine(i) {
    /// Point `s` of the body stays on a straight line of the ground.
    params { s: Point in i, line: GroundLine }
    rows: [normal];
    phi: dot(perp(along(line)), point(i, s) - start(line));
    place: point(i, s);
} }
