use pfaff_joint_macro::joint;

joint! { plane Wrong(i) {
    /// One wrong thing.
    params { s: Point in i, motion: Length }
    rows: [x];
    phi: point(i, s)[0] - motion;
    place: point(i, s);
} }

fn main() {}
