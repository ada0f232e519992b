use pfaff_joint_macro::force;

force! { plane Wrong(i) {
    /// One wrong thing.
    params { m: Ratio }
    force: m * rate(rate(angle(i))) on angle(i);
} }

fn main() {}
