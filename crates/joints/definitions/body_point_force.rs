force! { plane BodyPointForce(i) {
    /// A force with given components in the frame of the body at point `s` of the body.
    params {
        /// Point of application.
        s: Point in i,
        /// Components [Fx, Fy] along the axes of the body.
        force: [Function<Force>, Function<Force>],
    }
    scene "point-force";
    variant frame = "body";
    let f = vector(i, [force[0], force[1]]);
    force: f[0] on point(i, s)[0];
    force: f[1] on point(i, s)[1];
} }
