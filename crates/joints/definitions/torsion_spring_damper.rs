force! { plane TorsionSpringDamper(i, j) {
    /// Torque `−k(φ_j − φ_i − φ0) − c(ω_j − ω_i)` on body j, opposite on body i.
    params {
        stiffness: TorsionStiffness,
        damping: TorsionDamping,
        free_angle: Angle = angle(j) - angle(i),
    }
    let twist = angle(j) - angle(i);
    force: -(stiffness * (twist - free_angle) + damping * rate(twist)) on twist;
} }
