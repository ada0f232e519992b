force! { plane PointForce(i) {
    /// A force with given global components at point `s` of the body.
    params {
        /// Point of application.
        s: Point in i,
        /// Global components [Fx, Fy].
        force: [Function<Force>, Function<Force>],
    }
    variant frame = "global", default;
    force: force[0] on point(i, s)[0];
    force: force[1] on point(i, s)[1];
} }
