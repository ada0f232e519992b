force! { space Torque(i) {
    /// A torque with given global components on one body.
    params {
        /// Global components [Tx, Ty, Tz].
        torque: [Function<Torque>, Function<Torque>, Function<Torque>],
    }
    force: 1.0 on dot(vector(ground, [torque[0], torque[1], torque[2]]), spin(i));
} }
