use pfaff_joint_macro::joint;

joint! { plane Wrong(i, r#type) {
    /// One wrong thing.
    params { s_i: Point in i, s_j: Point in r#type }
    rows: [x, y];
    phi: point(i, s_i) - point(r#type, s_j);
    place: point(i, s_i);
} }

fn main() {}
