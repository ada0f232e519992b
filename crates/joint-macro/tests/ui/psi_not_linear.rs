use pfaff_joint_macro::joint;

joint! { plane Wrong(i) {
    /// One wrong thing.
    params { s: Point in i, n: Direction in i }
    let v = velocity(point(i, s));
    rows: [n];
    psi: dot(v, v) - 1.0;
    place: point(i, s);
    component N: direction(i, n);
} }

fn main() {}
