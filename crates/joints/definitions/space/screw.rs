joint! { space Screw(i, j) {
    /// Point `s_j` of body j stays on the line through point `s_i` of body i along `axis`. The axes
    /// of both bodies are parallel, and body j moves by `pitch` along the axis for each revolution
    /// about it.
    params {
        /// A point of the axis on body i.
        s_i: Point in i,
        /// The point of body j that stays on the axis.
        s_j: Point in j,
        /// The axis on body i.
        axis: Axes in i,
        /// The axis on body j.
        axis_j: Axes in j like axis,
        /// Advance along the axis per revolution, right-handed: negative for a left-handed thread.
        pitch: Length,
    }
    let d = point(j, s_j) - point(i, s_i);
    let w = direction(j, axis_j[2]);
    let along = dot(direction(i, axis[2]), d);
    turns turn: angle(axis, axis_j);
    initial { along_0: Length = along }
    rows: [u, v, axis_u, axis_v, thread];
    phi: [
        dot(direction(i, axis[0]), d),
        dot(direction(i, axis[1]), d),
        dot(direction(i, axis[0]), w),
        dot(direction(i, axis[1]), w),
        along - along_0 - 0.15915494309189535 * pitch * turn,
    ];
    measure displacement: along;
    measure angle: angle(axis, axis_j);
    place: point(i, s_i);
} }
