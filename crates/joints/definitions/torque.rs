force! { plane Torque(i) {
    /// A torque on one body.
    params {
        /// Torque on the body, positive counterclockwise.
        torque: Function<Torque>,
    }
    force: torque on angle(i);
} }
