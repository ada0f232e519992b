joint! { space Ball(i) {
    /// A ball rolls without slip on a plane of the ground: the lowest point of the sphere of
    /// `radius` about point `s` is in the plane and has no velocity along a fixed direction of the
    /// plane or across it.
    params {
        /// The centre of the ball.
        s: Point in i,
        /// Radius of the ball.
        radius: Radius,
        /// The plane, with its normal towards the ball. Longitudinal is the coordinate axis with
        /// the smallest component along the normal, made orthogonal to it, and lateral = normal ×
        /// longitudinal: x and y on the plane z = 0.
        plane: GroundPlane,
    }
    let n = normal(plane);
    let track = along(plane);
    let centre = point(i, s);
    let slip = velocity(centre) - cross(spin(i), n) * radius;
    require "the radius is not zero": radius > 0.0;
    rows: [gap contact, longitudinal, lateral];
    phi: dot(n, centre - start(plane)) - radius;
    psi: [dot(track, slip), dot(cross(n, track), slip)];
    component N: n;
    place: centre - n * radius;
} }
