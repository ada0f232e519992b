use pfaff_joint_macro::joint;

joint! { plane Wrong(i, j) {
    /// One wrong thing.
    params { s_i: Point in i, s_j: Point in j }
    initial { d: Vector in i = local(j, point(j, s_j) - point(i, s_i)) }
    rows: [x, y];
    phi: point(i, s_i) + vector(i, d) - point(j, s_j);
    place: point(i, s_i);
} }

fn main() {}
