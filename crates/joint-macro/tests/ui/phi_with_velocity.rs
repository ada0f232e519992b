use pfaff_joint_macro::joint;

joint! { plane Wrong(i) {
    /// One wrong thing.
    params { s: Point in i, n: Direction in i }
    rows: [n];
    phi: dot(direction(i, n), velocity(point(i, s)));
    place: point(i, s);
} }

fn main() {}
