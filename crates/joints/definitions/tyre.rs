force! { plane Tyre(i) {
    /// Side force of a tyre at point `s` of the body, `−C·v_n/√(v_t² + v_0²)` along `normal`, with
    /// the velocities v_n of the point along `normal` and v_t across it. This is the linear tyre,
    /// with a side force C·α for a small slip angle α ≈ v_n/|v_t| (H. B. Pacejka, Tire and Vehicle
    /// Dynamics, 2012, chapter 1). At standstill, a damper C/v_0 replaces the law, so that the
    /// force remains finite. At the speed v_t the force is smaller than C·α by the share
    /// (v_0/v_t)²/2.
    params {
        /// The contact point.
        s: Point in i,
        /// Direction across the tyre, along which the force acts.
        normal: Direction in i,
        /// Cornering stiffness C, side force per slip angle.
        stiffness: CorneringStiffness,
        /// Speed v_0 below which the force decreases; 0.1 m/s if it is not given.
        low_speed: Velocity = 0.1,
    }
    require "the low speed is not zero": low_speed != 0.0;
    let n = direction(i, normal);
    let v = velocity(point(i, s));
    let side = dot(n, v);
    let speed = norm(vector(i, [dot(perp(n), v), low_speed]));
    force: -stiffness * side / speed * n[0] on point(i, s)[0];
    force: -stiffness * side / speed * n[1] on point(i, s)[1];
} }
