force! { plane Damper(i, j) {
    /// Tension `c·l̇` between point `s_i` of body i and point `s_j` of body j: a damper without a spring.
    params {
        /// End on body i.
        s_i: Point in i,
        /// End on body j.
        s_j: Point in j,
        /// Damping c, tension per rate of extension.
        damping: Damping,
    }
    points apart;
    let length = norm(point(j, s_j) - point(i, s_i));
    require "the two points are apart": length > 0.0;
    force: -damping * rate(length) on length;
} }
