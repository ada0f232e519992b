use pfaff_joint_macro::joint;

joint! { plane Wrong(i, j) {
    /// One wrong thing.
    params { s_i: Point in i, s_j: Point in j }
    let d = point(j, s_j) - point(i, s_i);
    let l = norm(d);
    rows: [distance];
    phi: 2.0 * l - 1.0;
    place: point(i, s_i);
} }

fn main() {}
