joint! { plane Velocity(i) {
    /// The velocity of point `s` along `direction` is a given function of time: `(R·d)·v_s = rate(t)`.
    params { s: Point in i, direction: Direction in i, rate: Function<Velocity> }
    rows: [along];
    psi: dot(direction(i, direction), velocity(point(i, s))) - rate;
    place: point(i, s);
} }
