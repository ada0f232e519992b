force! { plane PointForce(i) {
    /// A force at point `s` of the body, with given components
    params {
        /// Point of application.
        s: Point in i,
        /// Components [Fx, Fy] along the axes that the key `frame` selects.
        force: [Function<Force>, Function<Force>],
    }
    variant frame {
        /// along the axes of the ground.
        "global": [force[0], force[1]],
        /// along the axes of the body.
        "body": vector(i, [force[0], force[1]]),
    }
    force: frame[0] on point(i, s)[0];
    force: frame[1] on point(i, s)[1];
} }
