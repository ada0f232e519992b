force! { plane TorsionSpringDamper(i, j) {
    /// Torque `−k(φ_j − φ_i − φ0) − c(ω_j − ω_i)` on body j, opposite on body i.
    params {
        /// Stiffness k, torque per relative angle.
        stiffness: TorsionStiffness,
        /// Damping c, torque per relative angular velocity.
        damping: TorsionDamping,
        /// Relative angle φ_j − φ_i without torque at rest, φ0.
        free_angle: Angle = angle(j) - angle(i),
    }
    let twist = angle(j) - angle(i);
    force: -(stiffness * (twist - free_angle) + damping * rate(twist)) on twist;
} }
