force! { plane Torque(i) {
    /// A torque on one body.
    params { torque: Function<Torque> }
    force: torque on angle(i);
} }
