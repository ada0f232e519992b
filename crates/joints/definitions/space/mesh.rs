joint! { space Mesh(i, j, carrier) {
    /// Gear mesh of two wheels, each of which rotates about an axis of one carrier: at the pitch
    /// point P of the carrier both wheels have the same velocity along the line of action n,
    /// `n·(v_i(P) − v_j(P)) = 0`. If the bearings are satisfied, this is the rate of `Φ_i − Φ_j`
    /// with `Φ_k = n·(s_k − p_k) + (m_k·a_k)·θ_k + (m_k − x_k·a_k × n)·(a_k × b_k)`. Here p_k and
    /// a_k are point and axis of the bearing on the carrier, and s_k and b_k those on wheel k. The
    /// other symbols are `m_k = (P − p_k) × n`, `x_k = a_k·(s_k − p_k)`, and θ_k, the rotation
    /// angle of wheel k with its full revolutions. The reference point of the reaction is P; λ is
    /// the force of the gear mesh, along −n on wheel i.
    params {
        /// Point of the first bearing on wheel i.
        s_i: Point in i,
        /// Point of the second bearing on wheel j.
        s_j: Point in j,
        /// Point of the first bearing on the carrier.
        p_i: Point in carrier,
        /// Point of the second bearing on the carrier.
        p_j: Point in carrier,
        /// The pitch point.
        pitch: Point in carrier,
        /// Axis of the first bearing on the carrier.
        axis_i: Axes in carrier,
        /// Axis of the second bearing on the carrier.
        axis_j: Axes in carrier,
        /// Axis of the first bearing on wheel i.
        own_i: Axes in i like axis_i,
        /// Axis of the second bearing on wheel j.
        own_j: Axes in j like axis_j,
        /// The line of action.
        line: Direction in carrier,
    }
    bearings;
    let n = direction(carrier, line);
    let a_i = direction(carrier, axis_i[2]);
    let a_j = direction(carrier, axis_j[2]);
    let m_i = cross(point(carrier, pitch) - point(carrier, p_i), n);
    let m_j = cross(point(carrier, pitch) - point(carrier, p_j), n);
    // m_k·a_k, m_k × a_k and (a_k × n) × a_k.
    initial {
        lever_i: Length = dot(m_i, a_i),
        lever_j: Length = dot(m_j, a_j),
        arm_i: Vector in carrier = local(carrier, cross(m_i, a_i)),
        arm_j: Vector in carrier = local(carrier, cross(m_j, a_j)),
        across_i: Vector in carrier = local(carrier, n - a_i * dot(n, a_i)),
        across_j: Vector in carrier = local(carrier, n - a_j * dot(n, a_j)),
    }
    let d_i = point(i, s_i) - point(carrier, p_i);
    let d_j = point(j, s_j) - point(carrier, p_j);
    let b_i = direction(i, own_i[2]);
    let b_j = direction(j, own_j[2]);
    let tilt_i = dot(vector(carrier, arm_i), b_i) - dot(a_i, d_i) * dot(vector(carrier, across_i), b_i);
    let tilt_j = dot(vector(carrier, arm_j), b_j) - dot(a_j, d_j) * dot(vector(carrier, across_j), b_j);
    let shift = dot(n, d_i - d_j) + tilt_i - tilt_j;
    turns turn_i: angle(axis_i, own_i);
    turns turn_j: angle(axis_j, own_j);
    initial { phase: Length = shift }
    rows: [teeth];
    phi: shift - phase + lever_i * turn_i - lever_j * turn_j;
    place: point(carrier, pitch);
} }
