force! { plane TorqueBetween(i, j) {
    /// A torque on body j, opposite on body i.
    params {
        /// Torque on body j, positive counterclockwise; the opposite torque acts on body i.
        torque: Function<Torque>,
    }
    scene "torque";
    force: torque on angle(j) - angle(i);
} }
