force! { space TorqueBetween(i, j) {
    /// A torque with given global components on body j, opposite on body i.
    params {
        /// Global components [Tx, Ty, Tz] on body j; the opposite torque acts on body i.
        torque: [Function<Torque>, Function<Torque>, Function<Torque>],
    }
    scene "torque";
    force: 1.0 on dot(vector(ground, [torque[0], torque[1], torque[2]]), spin(j) - spin(i));
} }
