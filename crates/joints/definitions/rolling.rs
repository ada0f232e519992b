joint! { plane Rolling(i, j) {
    /// The velocity of point `s` of the carrier i along `direction` is the rolling speed of the
    /// spinner j:
    params {
        /// The point of the carrier whose velocity makes the spinner roll, usually the centre of
        /// the wheel.
        s: Point in i,
        /// Direction of rolling.
        direction: Direction in i,
        /// Radius of the spinner, not zero; if negative, the spinner rotates in the opposite
        /// direction.
        radius: Length,
    }
    variant spin {
        /// `(R·d)·v_s − radius·ω_j = 0`. The spin ω_j is absolute, so it contains the rotation of
        /// the carrier.
        "absolute": angle(j),
        /// `(R·d)·v_s − radius·(ω_j − ω_i) = 0`. The spin ω_j − ω_i is relative to the carrier, like
        /// that of a motor on the carrier, so a rotation of both bodies together is not rolling.
        "relative": angle(j) - angle(i),
    }
    require "the radius is not zero": radius * radius > 0.0;
    rows: [along];
    psi: dot(direction(i, direction), velocity(point(i, s))) - radius * rate(spin);
    place: point(i, s);
} }
