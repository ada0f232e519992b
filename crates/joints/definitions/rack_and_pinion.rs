joint! { plane RackAndPinion(i, j) {
    /// Rack i and pinion j roll on each other without slip:
    /// `Δ(axis·(p_pinion − p_rack)) + radius·Δ(φ_pinion − φ_rack) = 0` with the pinion's centre `s_j`. A negative
    /// radius is the other side of the rack.
    params {
        /// Centre of the pinion.
        s_j: Point in j,
        /// Along the rack.
        axis: Direction in i,
        /// Radius of the pinion; negative: it rolls on the other side of the rack.
        radius: Length,
    }
    initial {
        phase: Length = dot(direction(i, axis), point(j, s_j) - origin(i)) + radius * (angle(j) - angle(i))
    }
    rows: [mesh];
    phi: dot(direction(i, axis), point(j, s_j) - origin(i)) + radius * (angle(j) - angle(i)) - phase;
    place: origin(i);
} }
