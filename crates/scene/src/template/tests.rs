//! Tests that numbers are found by their keys, and that the rest of the text does not change.

use model::Registry;

use super::{KeyError, RetypedJoint, Template, retyped};
use crate::read;

const SCENE: &str = r#"# a cart
[scene]
name = "cart" # its name
space = "plane"
gravity = [0, -9.81]

[[body]]
name = "cart"
mass = 0x10
inertia = 1

[[body]]
name = "cart.2"
mass = 2.0
inertia = 1.0
position = [1.0, 0.0]

[[joint]]
name = "rail"
type = "translational"
bodies = ["ground", "cart"]
points = { ground = [0.0, 0.0], cart = [0.0, 0.0] }
axis = [1.0, 0.0]

[[drive]]
name = "pull"
joint = "rail"
type = "displacement"
motion = { type = "steps", steps = [{ from = 0.0, to = 1.0, by = 0.5 }] }

[simulate]
t_end = 1.0
"#;

fn changed(keys: &[&str], values: &[f64]) -> String {
    Template::new(SCENE, keys)
        .expect("the keys exist")
        .with(values)
}

/// Checks the one line that a key changes.
#[track_caller]
fn check_line(key: &str, value: f64, expected: &str) {
    let text = changed(&[key], &[value]);
    let (old, new): (Vec<_>, Vec<_>) = (SCENE.lines().collect(), text.lines().collect());
    let same = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    assert_eq!(new[same], expected, "{key}");
    let rest = new.len() - same - 1;
    assert_eq!(new[same + 1..], old[old.len() - rest..], "{key}");
    if let Err(problems) = read("cart.toml", &text, &Registry::standard()) {
        panic!("{key}: {problems:?}");
    }
}

#[test]
fn numbers_are_found_by_their_names() {
    check_line("body.cart.mass", 3.5, "mass = 3.5");
    check_line("body[0].mass", 3.0, "mass = 3");
    check_line("body.cart.2.mass", 1e-300, "mass = 1e-300");
    check_line("scene.gravity[1]", -1.62, "gravity = [0, -1.62]");
    check_line("joint.rail.axis[1]", 0.1, "axis = [1.0, 0.1]");
    check_line(
        "joint.rail.points.cart[0]",
        -0.0,
        "points = { ground = [0.0, 0.0], cart = [-0, 0.0] }",
    );
    check_line(
        "drive.pull.motion.steps[0].by",
        0.25,
        "motion = { type = \"steps\", steps = [{ from = 0.0, to = 1.0, by = 0.25 }] }",
    );
    // A key that is missing in the text is added.
    check_line("simulate.rtol", 1e-6, "rtol = 1e-6");
    check_line("body.cart.2.angle", 2.0, "angle = 2");
    check_line(
        "drive.pull.motion.start",
        1.0,
        "motion = { start = 1, type = \"steps\", steps = [{ from = 0.0, to = 1.0, by = 0.5 }] }",
    );
}

#[test]
fn several_numbers_in_any_order() {
    let keys = ["simulate.rtol", "body.cart.mass", "simulate.atol"];
    let scene = read(
        "",
        &changed(&keys, &[1e-5, 7.0, 1e-9]),
        &Registry::standard(),
    );
    let scene = scene.expect("right");
    assert_eq!(scene.description.bodies()[0].mass, 7.0);
    let options = scene.simulate.expect("it has an end");
    assert_eq!((options.rtol, options.atol), (1e-5, 1e-9));
}

#[test]
fn every_number_comes_back_with_its_bits() {
    let template = Template::new(SCENE, &["body.cart.mass"]).expect("it exists");
    for value in [
        0.1 + 0.2,
        1.0 / 3.0,
        5e-324,
        joints::LARGEST,
        9_007_199_254_740_993.0,
        1e17,
        123_456_789.0,
    ] {
        let scene = read("", &template.with(&[value]), &Registry::standard()).expect("right");
        assert_eq!(
            scene.description.bodies()[0].mass.to_bits(),
            value.to_bits()
        );
    }
    // The reader of scenes rejects these values, although they are valid TOML.
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        let problems = read("", &template.with(&[value]), &Registry::standard()).err();
        let message = problems.expect("refused")[0].message.clone();
        assert!(message.contains("finite"), "{message}");
    }
}

#[test]
fn wrong_keys_say_what_there_is() {
    let text = |key: &str| match Template::new(SCENE, &[key]) {
        Err(e) => e.to_string(),
        Ok(_) => panic!("{key} was found"),
    };
    assert_eq!(
        text("bodi.cart.mass"),
        "`bodi.cart.mass`: there is no `bodi` in `the scene`; did you mean `body`?"
    );
    assert_eq!(
        text("mass"),
        "`mass`: there is no `mass` in `the scene`; there are `body`, `drive`, `joint`, `scene`, `simulate`"
    );
    assert_eq!(
        text("body.wheel.mass"),
        "`body.wheel.mass`: there is no `wheel` in `body`; there are `cart`, `cart.2`"
    );
    assert_eq!(
        text("scene.gravity[2]"),
        "`scene.gravity[2]`: `scene.gravity` has 2 entries, counted from 0; there is no entry `2`"
    );
    assert_eq!(
        text("scene.gravity"),
        "`scene.gravity` is a list of 2 values, not a number; its parts are `scene.gravity[0]`, `scene.gravity[1]`"
    );
    assert_eq!(
        text("joint.rail.type"),
        "`joint.rail.type` is the text \"translational\", not a number"
    );
    assert_eq!(
        text("body.cart.mass.x"),
        "`body.cart.mass.x`: there is no `x` in `body.cart.mass`"
    );
    for key in [
        "",
        ".",
        "body",
        "body.",
        "body.cart.",
        "body.cart[0]",
        "body[",
        "body[]",
        "body[-1].mass",
        "[0]",
    ] {
        assert!(Template::new(SCENE, &[key]).is_err(), "{key:?}");
    }
    // A misspelt last key is added; the reader of scenes rejects it and suggests the correct key.
    let problems = read(
        "",
        &changed(&["body.cart.mas"], &[1.0]),
        &Registry::standard(),
    );
    let problems = problems.err().unwrap_or_default();
    assert_eq!(problems[0].message, "body `cart` has no key `mas`");
    assert_eq!(problems[0].primary.text, "did you mean `mass`?");
}

#[test]
fn the_same_number_twice_is_refused() {
    for keys in [
        ["body.cart.mass", "body[0].mass"],
        ["simulate.rtol", "simulate.rtol"],
    ] {
        let error = Template::new(SCENE, &keys).expect_err("refused");
        assert!(matches!(error, KeyError::Repeated { .. }), "{error}");
    }
    assert_eq!(
        Template::new("a = = 1", &["a"]).err(),
        Some(KeyError::NotToml)
    );
    // A text that is too large for the reader of scenes is rejected here as well.
    let long = format!("a = 1\nb = [{}]", "0,".repeat(3_000_000));
    assert_eq!(Template::new(&long, &["a"]).err(), Some(KeyError::NotToml));
    let dotted = "[scene]\nmotion.rate = 1.0\n";
    let error = Template::new(dotted, &["scene.motion.start"]).err();
    assert!(matches!(error, Some(KeyError::NoRoom { .. })), "{error:?}");
}

#[test]
fn joints_of_other_types_keep_the_rest_of_the_text() {
    let registry = Registry::standard();
    let spec = |name: &str| {
        &registry
            .space()
            .constraints(name)
            .next()
            .unwrap()
            .spec
            .common
    };
    let change = |to: &str, directions: Vec<(&'static str, Vec<f64>)>| RetypedJoint {
        joint: "B".to_owned(),
        from: spec("revolute"),
        to: spec(to),
        directions,
    };
    let heads = "[[joint]]\nname = \"A\"\ntype = \"revolute\"\naxis = \"x\"\n\n[[joint]] # B\naxis = \"x\" # along the shaft\nname = \"B\"\ntype = \"revolute\"\t# kept\nat = [0, 0, 0]\n";
    let ball = retyped(heads, &[&change("spherical", Vec::new())]).unwrap();
    assert_eq!(
        ball,
        "[[joint]]\nname = \"A\"\ntype = \"revolute\"\naxis = \"x\"\n\n[[joint]] # B\nname = \"B\"\ntype = \"spherical\"\t# kept\nat = [0, 0, 0]\n"
    );
    let along = change("point-on-line", vec![("axis", vec![0.0, 1.0, 0.0])]);
    let line = retyped(heads, &[&along]).unwrap();
    assert!(
        line.contains("[[joint]] # B\nname = \"B\"\ntype = \"point-on-line\"\t# kept\naxis = [0, 1, 0]\nat = [0, 0, 0]\n"),
        "{line}"
    );
    // Lists of inline tables, with the key first, between others, and last.
    for (own, expected) in [
        (
            "{ axis = \"x\", name = \"B\", type = \"revolute\" }",
            "{ name = \"B\", type = \"spherical\" }",
        ),
        (
            "{ name = \"B\", axis = [1, 0, 0], type = \"revolute\" }",
            "{ name = \"B\", type = \"spherical\" }",
        ),
        (
            "{ name = \"B\", type = \"revolute\", axis = \"x\" }",
            "{ name = \"B\", type = \"spherical\" }",
        ),
    ] {
        let text = format!("joint = [{own}] # µ\n");
        let ball = retyped(&text, &[&change("spherical", Vec::new())]).unwrap();
        assert_eq!(ball, format!("joint = [{expected}] # µ\n"));
        let both = retyped(&text, &[&along]).unwrap();
        let typed = "type = \"point-on-line\", axis = [0, 1, 0]";
        assert!(both.contains(typed), "{both}");
    }
}
