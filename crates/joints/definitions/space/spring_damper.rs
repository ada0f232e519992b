force! { space SpringDamper(i, j) {
    /// Tension `k(l − l0) + c·l̇` between point `s_i` of body i and point `s_j` of body j.
    params {
        /// End on body i.
        s_i: Point in i,
        /// End on body j.
        s_j: Point in j,
        /// Stiffness k, tension per extension.
        stiffness: Stiffness,
        /// Damping c, tension per rate of extension.
        damping: Damping,
        /// Length without tension at rest, l0.
        free_length: Length = norm(point(j, s_j) - point(i, s_i)),
    }
    points apart;
    let d = point(j, s_j) - point(i, s_i);
    let length = norm(d);
    require "the two points are apart, or the free length is zero":
        free_length == 0.0 || length > 0.0;
    // −k·l on l is −k on d·d/2, which needs no direction: the derivative is correct even if the
    // points coincide.
    force: -stiffness on 0.5 * dot(d, d);
    force: stiffness * free_length - damping * rate(length) on length;
} }
