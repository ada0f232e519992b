force! { space BodyPointForce(i) {
    /// A force with given components in the frame of the body at point `s` of the body.
    params {
        /// Point of application.
        s: Point in i,
        /// Components [Fx, Fy, Fz] along the axes of the body.
        force: [Function<Force>, Function<Force>, Function<Force>],
    }
    scene "point-force";
    variant frame = "body";
    let f = vector(i, [force[0], force[1], force[2]]);
    force: f[0] on point(i, s)[0];
    force: f[1] on point(i, s)[1];
    force: f[2] on point(i, s)[2];
} }
