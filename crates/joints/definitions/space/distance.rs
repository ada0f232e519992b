joint! { space Distance(i, j) {
    /// The distance of point `s_i` of body i and point `s_j` of body j keeps its initial value L, in the form
    /// `(d·d − L²)/(2L) = 0`, whose multiplier is a force.
    params {
        /// End on body i.
        s_i: Point in i,
        /// End on body j.
        s_j: Point in j,
    }
    points apart;
    let d = point(j, s_j) - point(i, s_i);
    initial { length: Length = norm(d), half_inverse: PerLength = 0.5 / length }
    require "the two points are apart (L > 0)": length > 0.0;
    rows: [gap distance];
    phi: (dot(d, d) - length * length) * half_inverse;
    measure length, kept;
    place: point(i, s_i);
} }
