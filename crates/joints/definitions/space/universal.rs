joint! { space Universal(i, j) {
    /// Point `s_i` of body i and point `s_j` of body j coincide, and the axis of body i is perpendicular to the axis
    /// of body j: the two axes of a cross.
    params {
        /// The centre of the cross on body i.
        s_i: Point in i,
        /// The centre of the cross on body j.
        s_j: Point in j,
        /// The axis of the cross that is fixed in body i.
        axis: Direction in i,
        /// The axis of the cross that is fixed in body j.
        cross: Direction in j,
    }
    let a = direction(i, axis);
    let b = direction(j, cross);
    let k = dot(a, b);
    // The other axis of the cross, in the frame of each body at the start.
    initial {
        b_in_i: Vector in i = local(i, b),
        a_in_j: Vector in j = local(j, a),
    }
    require "the two axes of its cross do not lie along one line": 1.0 - k * k > 0.000001;
    rows: [x, y, z, cross];
    phi: [point(i, s_i) - point(j, s_j), k];
    measure first: turn(a, vector(i, b_in_i), b);
    measure second: turn(b, a, vector(j, a_in_j));
    place: point(i, s_i);
} }
