use pfaff_joint_macro::joint;

joint! { plane Wrong(i, j) {
    /// One wrong thing.
    params { s_i: Point in i, s_j: Point in j }
    initial { v_0: Velocity = norm(velocity(point(i, s_i))) }
    rows: [x];
    phi: v_0 * dot(point(i, s_i), point(j, s_j));
    place: point(i, s_i);
} }

fn main() {}
