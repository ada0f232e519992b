use pfaff_joint_macro::joint;

joint! { plane Wrong(i, j) {
    /// One wrong thing.
    params { s_i: Point in i, s_j: Point in j }
    rows: [x, y];
    fi: point(i, s_i) - point(j, s_j);
    place: point(i, s_i);
} }

fn main() {}
