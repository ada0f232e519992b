joint! { plane Mesh(i, j, carrier) {
    /// Gear mesh of two wheels that rotate on a carrier about their centres `s_i` and `s_j`. At the
    /// pitch point P of the carrier both wheels have the same velocity along the line of action n,
    /// `n·(v_i(P) − v_j(P)) = 0`. The integral of this row is
    /// `n·(p_i − p_j) + cos α·(r_i·(φ_i − φ_carrier) + r_j·(φ_j − φ_carrier)) = const` with
    /// `r_i + r_j = a`, the distance of the centres, and `r_j·ratio = −r_i`. The reference point of
    /// the reaction is the centre of wheel i; λ is the force of the gear mesh, along −n on wheel i.
    params {
        /// Centre of wheel i.
        s_i: Point in i,
        /// Centre of wheel j.
        s_j: Point in j,
        /// Rotation of body j over that of body i, both relative to the carrier; negative for an external mesh.
        ratio: Ratio,
        /// Angle of the line of action from the perpendicular of the centre line; 0 if it is not
        /// given. The sign of this angle selects the tooth flanks that touch.
        pressure_angle: Angle = 0.0,
    }
    points apart;
    let d = point(j, s_j) - point(i, s_i);
    initial {
        share: Ratio = ratio / (ratio - 1.0),
        centres: Vector in carrier = local(carrier, d),
        line: Vector in carrier = local(carrier, cos(pressure_angle) * perp(d) + sin(pressure_angle) * d),
        inverse: PerLength = 1.0 / norm(d),
    }
    require "the ratio is not 1": (ratio - 1.0) * (ratio - 1.0) > 0.0;
    require "the two centres are apart": norm(d) > 0.0;
    let n = vector(carrier, line);
    let arm = perp(vector(carrier, centres));
    let turns = share * (angle(i) - angle(carrier)) + (1.0 - share) * (angle(j) - angle(carrier));
    let teeth = inverse * (dot(n, arm) * turns - dot(n, d));
    initial { phase: Length = teeth }
    rows: [teeth];
    phi: teeth - phase;
    place: point(i, s_i);
} }
