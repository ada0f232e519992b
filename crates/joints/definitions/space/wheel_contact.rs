joint! { space WheelContact(i) {
    /// A wheel touches a plane of the ground: of the circle of `radius` about point `s` across `axis` the lowest point
    /// lies in the plane. With the height h of the centre above the plane and the slope k = up·axis that is
    /// `(h² − radius²·(1 − k²))/(2·radius) = 0`.
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
    let h = dot(n, point(i, s) - start(plane));
    let k = dot(n, a);
    let steep = 1.0 - k * k;
    initial { half_inverse: PerLength = 0.5 / radius }
    require "the radius is not zero": radius * radius > 0.0;
    require "the wheel does not lie flat": steep > 0.000001;
    require "the wheel is on the side of the normal of its plane": h > 0.0;
    rows: [contact];
    phi: (h * h - radius * radius * steep) * half_inverse;
    place: point(i, s) - (n - a * k) * (radius / norm(n - a * k));
} }
