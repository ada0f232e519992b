force! { space Bushing(i, j) {
    /// Springs and dampers along and about the axes of body i between point `s_i` of body i and
    /// point `s_j` of body j, without load at the start. Here d are the components, in these axes,
    /// of the vector from the first point to the second one. The components of the rotation vector
    /// of body j relative to body i since the start are θ. The loads `−k·Δd − c·ḋ` and
    /// `−k·θ − c·θ̇` act on these six numbers. The springs have the energy `½·Σ k·Δd² + ½·Σ k·θ²`,
    /// and the torques are those of this energy. Rotations beyond 3 rad have no value, because θ
    /// would change its sign at half a turn. The force on body j acts at its own point; the
    /// opposite force acts on body i at the same point.
    params {
        /// End on body i.
        s_i: Point in i,
        /// End on body j; the force on body i acts at this point, too.
        s_j: Point in j,
        /// Stiffness along x, y and z of the frame of body i, and about these axes.
        stiffness: [Stiffness, Stiffness, Stiffness, TorsionStiffness, TorsionStiffness, TorsionStiffness],
        /// Damping along x, y and z of the frame of body i, and about these axes.
        damping: [Damping, Damping, Damping, TorsionDamping, TorsionDamping, TorsionDamping],
    }
    initial {
        offset: Vector in i = local(i, point(j, s_j) - point(i, s_i)),
        x_0: Vector in i = local(i, vector(j, [1.0, 0.0, 0.0])),
        y_0: Vector in i = local(i, vector(j, [0.0, 1.0, 0.0])),
        z_0: Vector in i = local(i, vector(j, [0.0, 0.0, 1.0])),
    }
    let d = local(i, point(j, s_j) - point(i, s_i));
    let x = vector(i, local(i, vector(j, [1.0, 0.0, 0.0])));
    let y = vector(i, local(i, vector(j, [0.0, 1.0, 0.0])));
    let z = vector(i, local(i, vector(j, [0.0, 0.0, 1.0])));
    // 2·sin θ along the axis of the rotation, and its trace, 1 + 2·cos θ.
    let twice = cross(vector(i, x_0), x) + cross(vector(i, y_0), y) + cross(vector(i, z_0), z);
    let trace = dot(vector(i, x_0), x) + dot(vector(i, y_0), y) + dot(vector(i, z_0), z);
    let theta = local(i, twice * (0.5 * angle_over_sine(0.5 * trace - 0.5)));
    force: -(stiffness[0] * (d[0] - offset[0]) + damping[0] * rate(d[0])) on d[0];
    force: -(stiffness[1] * (d[1] - offset[1]) + damping[1] * rate(d[1])) on d[1];
    force: -(stiffness[2] * (d[2] - offset[2]) + damping[2] * rate(d[2])) on d[2];
    force: -(stiffness[3] * theta[0] + damping[3] * rate(theta[0])) on theta[0];
    force: -(stiffness[4] * theta[1] + damping[4] * rate(theta[1])) on theta[1];
    force: -(stiffness[5] * theta[2] + damping[5] * rate(theta[2])) on theta[2];
} }
