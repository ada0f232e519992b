force! { plane TorqueBetween(i, j) {
    /// A torque on body j, opposite on body i.
    params {
        /// Torque on body j, positive counterclockwise; body i takes the opposite.
        torque: Function<Torque>,
    }
    scene "torque";
    force: torque on angle(j) - angle(i);
} }
