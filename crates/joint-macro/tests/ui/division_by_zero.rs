use pfaff_joint_macro::force;

force! { plane Wrong(i, j) {
    /// One wrong thing.
    params { k: Stiffness }
    force: k / (angle(i) - angle(i)) on angle(j);
} }

fn main() {}
