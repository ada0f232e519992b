force! { space PointForce(i) {
    /// A force with given global components at point `s` of the body.
    params {
        /// Point of application.
        s: Point in i,
        /// Global components [Fx, Fy, Fz].
        force: [Function<Force>, Function<Force>, Function<Force>],
    }
    variant frame = "global", default;
    force: force[0] on point(i, s)[0];
    force: force[1] on point(i, s)[1];
    force: force[2] on point(i, s)[2];
} }
