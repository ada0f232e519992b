joint! { space ConstantVelocity(i, j) {
    /// Point `s_i` of body i and point `s_j` of body j coincide, and both bodies rotate about their
    /// axes by the same angle. This is true for any inclination of the axes (a homokinetic joint).
    /// The directions u_i, v_i are perpendicular to the axis of body i, and u_j, v_j to the axis of
    /// body j. At the start, the smallest rotation from the first axis to the second maps u_i, v_i
    /// to u_j, v_j. The row `u_i·v_j − v_i·u_j = 0` states that the bodies have no relative
    /// rotation about the sum of their axes.
    params {
        /// The centre of the joint on body i.
        s_i: Point in i,
        /// The centre of the joint on body j.
        s_j: Point in j,
        /// The axis of body i.
        axis: Axes in i,
        /// The axis of body j, which may have any inclination to the axis of body i.
        axis_j: Axes in j like axis,
    }
    let u = direction(i, axis[0]);
    let v = direction(i, axis[1]);
    let u_own = direction(j, axis_j[0]);
    let v_own = direction(j, axis_j[1]);
    let k = dot(direction(i, axis[2]), direction(j, axis_j[2]));
    let even = dot(u, u_own) + dot(v, v_own);
    let odd = dot(u, v_own) - dot(v, u_own);
    // Cosine and sine of the angle from u_j to the given direction across the axis of body j: the
    // smallest rotation has even = 1 + k and odd = 0.
    initial { cosine: Ratio = even / (1.0 + k), sine: Ratio = odd / (1.0 + k) }
    require "its axes do not point in opposite directions": 1.0 + k > 0.000001;
    rows: [x, y, z, turn];
    phi: [point(i, s_i) - point(j, s_j), cosine * odd - sine * even];
    place: point(i, s_i);
} }
