force! { plane TorqueBetween(i, j) {
    /// A torque on body j, opposite on body i.
    params { torque: Function<Torque> }
    scene "torque";
    force: torque on angle(j) - angle(i);
} }
