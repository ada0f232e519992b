//! Tests that a joint outside the library can be read after its registration.

use joint_macro::joint;
use joints::Pose;
use model::Registry;

use crate::{BODIES, assert_close, read};

joint! { plane PinOnParabola(i, j) {
    /// Point `s_j` of body j is always on the parabola `y = x²/(2·vertex_radius)` of body i.
    params { s_j: Point in j, vertex_radius: Length }
    initial { curvature: PerLength = 1.0 / vertex_radius }
    let p = local(i, point(j, s_j) - origin(i));
    rows: [normal];
    phi: p[1] - 0.5 * curvature * p[0] * p[0];
    measure run: p[0];
    place: point(j, s_j);
} }

#[test]
fn a_registered_joint_has_its_keys_and_measures() {
    let text = format!(
        "{BODIES}[[joint]]\nname = \"slot\"\ntype = \"pin-on-parabola\"\nbodies = [\"ground\", \"b\"]\n\
         points = {{ b = [1, 5] }}\nvertex_radius = 0.25\n\
         [[drive]]\nname = \"run\"\njoint = \"slot\"\ntype = \"run\"\nmotion = 1.0\n"
    );
    let mut registry = Registry::standard();
    registry.add_constraint::<PinOnParabola>();
    let d = pfaff_scene::read("own.toml", &text, &registry)
        .unwrap_or_else(|problems| panic!("{problems:#?}"))
        .description
        .plane()
        .expect("a planar scene")
        .clone();
    let mut element = d.joints[0].element.clone();
    let x = [Pose::GROUND; 2];
    element.initialise(&x);
    let mut phi = [f64::NAN];
    element.phi(&x, &[], &mut phi);
    // The expected value is 5 − 1²/(2·0.25).
    assert_close(&phi, &[3.0]);
    assert_eq!(d.drives.len(), 1);

    let problems = read(&text).expect_err("not registered here");
    assert_eq!(
        problems[0].message,
        "joint `slot` has the unknown type `pin-on-parabola`"
    );
}
