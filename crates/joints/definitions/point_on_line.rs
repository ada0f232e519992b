joint! { plane PointOnLine(i) {
    /// Point `s` of the body stays on a straight line of the ground.
    params {
        /// The point that stays on the line.
        s: Point in i,
        /// The line.
        line: GroundLine,
    }
    rows: [gap normal];
    phi: dot(perp(along(line)), point(i, s) - start(line));
    place: point(i, s);
} }
