joint! { plane Angle(i, j) {
    /// The relative angle of two bodies keeps its initial value.
    params {}
    initial { angle_0: Angle = angle(j) - angle(i) }
    rows: [angle];
    phi: angle(j) - angle(i) - angle_0;
    place: origin(i);
} }
