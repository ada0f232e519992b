joint! { plane RackAndPinion(i, j) {
    /// Rack i and pinion j roll on each other without slip:
    /// `Δ(axis·(p_pinion − p_rack)) + radius·Δ(φ_pinion − φ_rack) = 0` with the pinion's centre
    /// `s_j`. With a negative radius, the pinion rolls on the other side of the rack. The reference
    /// point of the reaction is the point of the rack at which the pinion's centre is at the start.
    params {
        /// Centre of the pinion.
        s_j: Point in j,
        /// Direction of the rack.
        axis: Direction in i,
        /// Radius of the pinion; if negative, the pinion rolls on the other side of the rack.
        radius: Length,
    }
    initial {
        phase: Length = dot(direction(i, axis), point(j, s_j) - origin(i)) + radius * (angle(j) - angle(i)),
        centre: Vector in i = local(i, point(j, s_j) - origin(i)),
    }
    rows: [mesh];
    phi: dot(direction(i, axis), point(j, s_j) - origin(i)) + radius * (angle(j) - angle(i)) - phase;
    place: origin(i) + vector(i, centre);
    note "the reaction of a rack and its pinion is the force of the teeth along the rack, without the separating force of the teeth; the reactions of bearing and guide do not contain this force, either";
} }
