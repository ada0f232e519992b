//! SDF: masses that follow from collision shapes (`auto`).

use std::f64::consts::PI;

use pfaff_import::Options;

use super::{import_text, numbers, refused, value};

/// Allowed relative difference: some roundings of sums and products.
const ROUNDING: f64 = 1e-14;

/// A model with a hinge and a link with the given content, which is in line 2.
fn link(inner: &str) -> String {
    format!(
        "<sdf version='1.11'><model name='m'><frame name='aside'><pose>0 0 1 0 0 0</pose></frame>\
         <joint name='j' type='revolute'><parent>world</parent><child>b</child></joint>\
         <link name='b'>\n{inner}\n</link></model></sdf>"
    )
}

fn auto(inner: &str, collisions: &str) -> String {
    link(&format!(
        "<inertial auto='true'>{inner}</inertial>{collisions}"
    ))
}

fn shape(geometry: &str) -> String {
    format!("<collision name='c'><geometry>{geometry}</geometry></collision>")
}

/// Mass, centre of mass and principal moments of the link in the scene.
fn body(text: &str) -> (f64, Vec<f64>, Vec<f64>) {
    let scene = import_text(text, &Options::default()).scene;
    let of = |key| value(&scene, "body", "b", key);
    let mass = of("mass").and_then(|mass| mass.parse().ok());
    let centre = of("centre").map_or_else(|| vec![0.0; 3], |list| numbers(&list));
    let inertia = of("inertia").unwrap_or_else(|| panic!("{scene}"));
    (mass.expect("a mass"), centre, numbers(&inertia))
}

fn assert_near(found: f64, expected: f64, text: &str) {
    let allowed = ROUNDING * expected.abs().max(ROUNDING);
    assert!(
        (found - expected).abs() <= allowed,
        "{text}: {found} {expected}"
    );
}

/// Volume and moments per mass, from tables of solids. The centre of mass of a cone is a quarter of
/// its length below the middle of its axis.
#[test]
fn shapes_have_their_masses() {
    let (r, l) = (0.2, 0.6);
    let round = format!("<radius>{r}</radius><length>{l}</length>");
    let (tube, ball) = (PI * r * r * l, 4.0 / 3.0 * PI * r * r * r);
    // Two hemispheres with their centres of mass at l/2 + 3r/8 from the middle.
    let arm = l / 2.0 + 3.0 * r / 8.0;
    let capsule = [
        tube * (r * r / 4.0 + l * l / 12.0) + ball * (83.0 / 320.0 * r * r + arm * arm),
        tube * r * r / 2.0 + ball * 0.4 * r * r,
    ]
    .map(|moment| moment / (tube + ball));
    for (geometry, volume, centre, moments) in [
        (
            "<box><size>0.2 0.4 0.6</size></box>".to_owned(),
            0.048,
            0.0,
            [0.52 / 12.0, 0.40 / 12.0, 0.20 / 12.0],
        ),
        (
            "<sphere><radius>0.2</radius></sphere>".into(),
            ball,
            0.0,
            [0.016; 3],
        ),
        (
            "<ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid>".into(),
            PI * 0.008,
            0.0,
            [0.026, 0.020, 0.010],
        ),
        (
            format!("<cylinder>{round}</cylinder>"),
            tube,
            0.0,
            [0.01 + 0.03, 0.01 + 0.03, 0.02],
        ),
        (
            format!("<cone>{round}</cone>"),
            tube / 3.0,
            -l / 4.0,
            [
                3.0 / 80.0 * (0.16 + 0.36),
                3.0 / 80.0 * (0.16 + 0.36),
                0.012,
            ],
        ),
        (
            format!("<capsule>{round}</capsule>"),
            tube + ball,
            0.0,
            [capsule[0], capsule[0], capsule[1]],
        ),
    ] {
        let (mass, at, inertia) = body(&auto("", &shape(&geometry)));
        assert_near(mass, 1000.0 * volume, &geometry);
        assert_near(at[2], centre, &geometry);
        for (found, moment) in inertia.iter().zip(moments) {
            assert_near(*found, 1000.0 * volume * moment, &geometry);
        }
    }
}

/// The density of a collision precedes the density of `<inertial>`. Two cubes of 1 m at x = 1 and
/// x = −1 have 2 kg and 6 kg, so the centre of mass is at x = −0.5. About this point, the moments
/// about y and z are 8/6 + 2·1.5² + 6·0.5² = 22/3.
#[test]
fn densities_and_poses_of_shapes() {
    let cube = |x: &str, density: &str| {
        format!(
            "<collision name='c{x}'><pose relative_to='aside'>{x} 0 -1 0 0 0</pose>{density}\
             <geometry><box><size>1 1 1</size></box></geometry></collision>"
        )
    };
    let cubes = cube("1", "") + &cube("-1", "<density>6</density>");
    let (mass, centre, inertia) = body(&auto("<density>2</density>", &cubes));
    assert_eq!((mass, centre), (8.0, vec![-0.5, 0.0, 0.0]));
    for (found, expected) in inertia.iter().zip([8.0 / 6.0, 22.0 / 3.0, 22.0 / 3.0]) {
        assert_near(*found, expected, "cubes");
    }
    // A stated mass scales the moments; a stated pose is not used, and the header states this.
    let stated = "<density>2</density><mass>4</mass><pose>9 0 0 0 0 0</pose>";
    let text = auto(stated, &cubes);
    let (mass, centre, inertia) = body(&text);
    assert_eq!((mass, centre), (4.0, vec![-0.5, 0.0, 0.0]));
    assert_near(inertia[2], 11.0 / 3.0, "scaled");
    let remarks = import_text(&text, &Options::default()).remarks;
    let replaces = |remark: &String| remark.contains("`auto` replaces the stated centre of mass");
    assert!(remarks.iter().any(replaces), "{remarks:?}");
}

#[test]
fn shapes_without_a_known_mass_are_refused() {
    let numbers = "give `<mass>`, `<pose>` and `<inertia>`";
    for (text, code, message, help) in [
        (auto("", ""), "P0608", "their mass is zero", numbers),
        (
            auto("", &shape("<empty/>")),
            "P0608",
            "their mass is zero",
            numbers,
        ),
        (
            auto("", &shape("<mesh><uri>a.stl</uri></mesh>")),
            "P0608",
            "link `b` from a `<mesh>`",
            numbers,
        ),
        (
            auto("", &shape("<plane/>")),
            "P0608",
            "from a `<plane>`",
            numbers,
        ),
        (
            auto("", "<collision name='c'/>"),
            "P0604",
            "`<geometry>`",
            "",
        ),
        (auto("", &shape("<box/>")), "P0604", "`<size>`", ""),
        (
            auto("", &shape("<box><size>1 -1 1</size></box>")),
            "P0610",
            "-1, which may not be negative",
            "",
        ),
        (auto("<density>-2</density>", ""), "P0610", "-2", ""),
        (
            auto("", "<collision name='c'><densty>2</densty></collision>"),
            "P0614",
            "densty",
            "`<density>`",
        ),
        (
            auto(
                "",
                "<collision name='c'><pose relative_to='no'/></collision>",
            ),
            "P0606",
            "no frame `no`",
            "",
        ),
    ] {
        let refusal = refused(&text);
        let problem = &refusal.diagnostics[0];
        assert_eq!(problem.code.to_string(), code, "{text}: {problem}");
        assert!(problem.message.contains(message), "{text}: {problem}");
        let found = problem.help.as_deref().unwrap_or_default();
        assert!(found.contains(help), "{text}: {found}");
        assert_eq!(problem.primary.line, 2, "{text}");
    }
}
