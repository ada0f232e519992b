force! { plane Bushing(i, j) {
    /// Springs and dampers along the axes of body i and about the rotation between point `s_i` of
    /// body i and point `s_j` of body j, without load at the start. The force on body j acts at its
    /// own point; the opposite force acts on body i at the same point.
    params {
        /// End on body i.
        s_i: Point in i,
        /// End on body j; the force on body i acts at this point, too.
        s_j: Point in j,
        /// Stiffness along x and y of the frame of body i, and about the relative rotation.
        stiffness: [Stiffness, Stiffness, TorsionStiffness],
        /// Damping along x and y of the frame of body i, and about the relative rotation.
        damping: [Damping, Damping, TorsionDamping],
    }
    initial {
        offset: Vector in i = local(i, point(j, s_j) - point(i, s_i)),
        angle_0: Angle = angle(j) - angle(i),
    }
    let d = local(i, point(j, s_j) - point(i, s_i));
    let twist = angle(j) - angle(i);
    force: -(stiffness[0] * (d[0] - offset[0]) + damping[0] * rate(d[0])) on d[0];
    force: -(stiffness[1] * (d[1] - offset[1]) + damping[1] * rate(d[1])) on d[1];
    force: -(stiffness[2] * (twist - angle_0) + damping[2] * rate(twist)) on twist;
} }
