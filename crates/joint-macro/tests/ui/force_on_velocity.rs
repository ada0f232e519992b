use pfaff_joint_macro::force;

force! { plane Wrong(i, j) {
    /// One wrong thing.
    params { damping: Damping }
    force: -damping on rate(angle(j) - angle(i));
} }

fn main() {}
