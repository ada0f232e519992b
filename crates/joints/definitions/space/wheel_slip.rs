joint! { space WheelSlip(i) {
    /// A wheel that touches a plane of the ground does not slip on it: the point of contact has no velocity along the
    /// track (axis × up) and across it. Rows are multiplied by the height of the centre over the radius, so that no
    /// quotient is needed; arms are those of a wheel that touches.
    params {
        /// The centre of the wheel.
        s: Point in i,
        /// The axis of the wheel.
        axis: Direction in i,
        /// Radius of the circle that touches the plane.
        radius: Length,
        /// The plane, its normal towards the side of the wheel.
        plane: GroundPlane,
    }
    let n = normal(plane);
    let a = direction(i, axis);
    let centre = point(i, s);
    let h = dot(n, centre - start(plane));
    let k = dot(n, a);
    let along = cross(a, n);
    let across = cross(n, along);
    initial { inverse: PerLength = 1.0 / radius }
    let turned = cross(spin(i), (a * k - n) * (radius * radius));
    require "the radius is not zero": radius * radius > 0.0;
    require "the wheel does not lie flat": 1.0 - k * k > 0.000001;
    rows: [longitudinal, lateral];
    psi: [
        (h * dot(along, velocity(centre)) + dot(along, turned)) * inverse,
        (h * dot(across, velocity(centre)) + dot(across, turned)) * inverse,
    ];
    place: centre - (n - a * k) * (radius / norm(n - a * k));
} }
