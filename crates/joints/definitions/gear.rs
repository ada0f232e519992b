joint! { plane Gear(i, j, carrier) {
    /// Rotations relative to the carrier keep a ratio: `Δ(φ_j − φ_carrier) = ratio·Δ(φ_i − φ_carrier)`. The
    /// ratio of an external mesh is negative.
    params {
        /// Rotation of body j over that of body i, both relative to the carrier; negative for an external mesh.
        ratio: Ratio,
    }
    require "the ratio is not zero": ratio * ratio > 0.0;
    initial { phase: Angle = angle(j) - angle(carrier) - ratio * (angle(i) - angle(carrier)) }
    rows: [mesh];
    phi: angle(j) - angle(carrier) - ratio * (angle(i) - angle(carrier)) - phase;
    place: origin(i);
    note "the reaction of a gear is a couple, without the force of teeth or belt; the reactions of the wheels' bearings do not contain this force, either";
} }
