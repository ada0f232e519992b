force! { space PointForce(i) {
    /// A force at point `s` of the body, with given components
    params {
        /// Point of application.
        s: Point in i,
        /// Components [Fx, Fy, Fz] along the axes that the key `frame` selects.
        force: [Function<Force>, Function<Force>, Function<Force>],
    }
    variant frame {
        /// along the axes of the ground.
        "global": [force[0], force[1], force[2]],
        /// along the axes of the body.
        "body": vector(i, [force[0], force[1], force[2]]),
    }
    force: frame[0] on point(i, s)[0];
    force: frame[1] on point(i, s)[1];
    force: frame[2] on point(i, s)[2];
} }
