joint! { space Wheel(i) {
    /// A wheel rolls without slip on a plane of the ground. The wheel is a tube of radius `tube`
    /// around the circle of `radius` about point `s` normal to `axis`; without `tube` it is only
    /// this circle. Its lowest point, `tube` below the lowest point of the circle, is in the plane
    /// and has no velocity along the track (axis × up) or across it. With the height h of the
    /// centre above the plane, minus `tube`, and the slope k = up·axis, the contact condition is
    /// `(h² − radius²·(1 − k²))/(2·radius) = 0`. The velocity rows are multiplied by h/radius, so
    /// that no quotient is needed; the lever arms are those of a wheel that touches the plane.
    params {
        /// The centre of the wheel.
        s: Point in i,
        /// The axis of the wheel.
        axis: Direction in i,
        /// Radius of the circle that touches the plane, or of the centre circle of the tube.
        radius: Radius,
        /// Radius of the tube around this circle (the cross-section of a tyre); 0 if it is not
        /// given.
        tube: Radius = 0.0,
        /// The plane, with its normal towards the wheel.
        plane: GroundPlane,
    }
    let n = normal(plane);
    let a = direction(i, axis);
    let centre = point(i, s);
    let h = dot(n, centre - start(plane)) - tube;
    let k = dot(n, a);
    let steep = 1.0 - k * k;
    let along = cross(a, n);
    let across = cross(n, along);
    initial { inverse: PerLength = 1.0 / radius }
    let turned = cross(spin(i), (a * k - n) * (radius * radius) - n * (h * tube));
    require "the radius is not zero": radius > 0.0;
    require "the wheel is not parallel to the ground": steep > 0.000001;
    require "the wheel is on the side of the normal of its plane, and the distance of its centre is larger than `tube`": h > 0.0;
    rows: [gap contact, longitudinal, lateral];
    phi: (h * h - radius * radius * steep) * (inverse * 0.5);
    psi: [
        (h * dot(along, velocity(centre)) + dot(along, turned)) * inverse,
        (h * dot(across, velocity(centre)) + dot(across, turned)) * inverse,
    ];
    component N: n;
    place: centre - (n - a * k) * (radius / norm(n - a * k)) - n * tube;
} }
