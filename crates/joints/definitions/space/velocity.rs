joint! { space Velocity(i) {
    /// The velocity of point `s` along `direction` is a given function of time: `(R·d)·v_s = rate(t)`.
    params {
        /// The point whose velocity is prescribed.
        s: Point in i,
        /// Direction of the prescribed velocity.
        direction: Direction in i,
        /// Velocity of the point along the direction.
        rate: Function<Velocity>,
    }
    rows: [along];
    psi: dot(direction(i, direction), velocity(point(i, s))) - rate;
    place: point(i, s);
} }
