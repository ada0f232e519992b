force! { plane SpringDamper(i, j) {
    /// Tension `k(l − l0) + c·l̇` between point `s_i` of body i and point `s_j` of body j.
    params {
        s_i: Point in i,
        s_j: Point in j,
        stiffness: Stiffness,
        damping: Damping,
        free_length: Length = norm(point(j, s_j) - point(i, s_i)),
    }
    points apart;
    let length = norm(point(j, s_j) - point(i, s_i));
    require "the two points are apart, or the free length is zero":
        free_length == 0.0 || length > 0.0;
    force: -(stiffness * (length - free_length) + damping * rate(length)) on length;
} }
