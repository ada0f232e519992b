//! Compares linearised motions with closed forms and published tables.

use linalg::{Matrix, eigenpairs};
use model::Registry;
use pfaff::dynamics::linearise::{Linearisation, LineariseError, LineariseOptions, Stability};
use pfaff::{RunOptions, Study, StudyError};

use crate::bicycle;

fn study(text: &str) -> Study {
    let study = Study::read(
        "test.toml",
        text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    study.unwrap_or_else(|e| panic!("{e}"))
}

fn asked(
    text: &str,
    coordinates: &[&str],
    follow: &[&str],
) -> Result<Linearisation, LineariseError> {
    let words = |x: &[&str]| x.iter().map(|x| (*x).to_owned()).collect();
    let options = LineariseOptions {
        coordinates: words(coordinates),
        follow: words(follow),
    };
    study(text).linearise(0.0, &options).map_err(|e| match e {
        StudyError::Linearise(e) => e,
        other => panic!("{other}"),
    })
}

fn linearised(text: &str) -> Linearisation {
    asked(text, &[], &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn eigenvalues(a: &Matrix) -> Vec<[f64; 2]> {
    let pairs = eigenpairs(a).expect("converges");
    pairs.into_iter().map(|pair| pair.value).collect()
}

/// A compound pendulum has m = 2, J = 0.5, the mass centre 1.5 below the pin, and g = 9.81. Its
/// equation is `(J + m·l²)·ÿ + m·g·l·y = 0`.
#[test]
fn a_pendulum_has_the_matrices_of_its_textbook() {
    let text = "
scene = { name = \"pendulum\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [0.0, -1.5] }]
joint = [{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0] }]
";
    let x = linearised(text);
    let names: Vec<&str> = x
        .positions
        .iter()
        .chain(&x.velocities)
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(names, ["rod.angle", "rod.omega"]);
    let (mass, stiffness) = (0.5 + 2.0 * 1.5 * 1.5, 2.0 * 9.81 * 1.5);
    let expected = [[0.0, 1.0], [-stiffness / mass, 0.0]];
    for i in 0..2 {
        for k in 0..2 {
            assert!((x.a[(i, k)] - expected[i][k]).abs() < 1e-12, "{:?}", x.a);
        }
    }
    let second = x.second_order.expect("at rest");
    assert!((second.mass[(0, 0)] - mass).abs() < 1e-13);
    assert!((second.stiffness[(0, 0)] - stiffness).abs() < 1e-11);
    assert!(second.damping[(0, 0)].abs() < 1e-12);
    assert!(x.accuracy < 1e-10, "{:e}", x.accuracy);
}

#[test]
fn a_pendulum_held_aside_is_not_at_rest() {
    let text = "
scene = { name = \"pendulum\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [1e-4, -1.5] }]
joint = [{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0] }]
";
    let refused = asked(text, &[], &[]).expect_err("it swings");
    assert!(
        matches!(refused, LineariseError::NotSteady { ref body, .. } if body == "rod"),
        "{refused}"
    );
}

/// For a body without support the message does not recommend a search for an equilibrium, in which
/// it would fall as well.
#[test]
fn a_body_that_falls_freely_is_told_to_be_held() {
    let text = "
scene = { name = \"stone\", space = \"spatial\", gravity = [0.0, 0.0, -10.0] }
body = [{ name = \"stone\", mass = 2.0, inertia = [0.1, 0.2, 0.25] }]
";
    let refused = asked(text, &[], &[]).expect_err("it falls").to_string();
    let end = "there is no equilibrium: `stone` slides along (0, 0, −1), pushed with 20 N by the weight at every \
               position; add a joint to the ground, or describe the support";
    assert!(refused.ends_with(end), "{refused}");
}

/// A mass on a spring in the middle of its swing has no acceleration, but it is not in steady
/// motion.
#[test]
fn a_mass_that_passes_its_place_of_rest_is_not_steady() {
    let text = "
scene = { name = \"mass\", space = \"plane\", gravity = [0.0, 0.0] }
body = [{ name = \"mass\", mass = 2.0, inertia = 0.5, velocity = [1.0, 0.0] }]
joint = [{ name = \"rail\", type = \"translational\", bodies = [\"ground\", \"mass\"], at = [0.0, 0.0], axis = [1.0, 0.0] }]
force = [{ name = \"spring\", type = \"spring-damper\", bodies = [\"ground\", \"mass\"], points = { ground = [-1.0, 0.0], mass = [0.0, 0.0] }, free_length = 1.0, stiffness = 50.0, damping = 0.0 }]
";
    let refused = asked(text, &[], &[]).expect_err("it swings");
    assert!(
        matches!(refused, LineariseError::NotSteady { moves: true, .. }),
        "{refused}"
    );
    let x = linearised(&text.replace("velocity = [1.0, 0.0]", "velocity = [0.0, 0.0]"));
    assert!((x.a[(1, 0)] + 25.0).abs() < 1e-11, "{:?}", x.a);
}

#[test]
fn asked_coordinates_have_to_be_independent() {
    let text = "
scene = { name = \"pendulum\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [0.0, -1.5] }]
joint = [{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0] }]
";
    let by_place = asked(text, &["rod.x"], &[]).expect("x determines the angle");
    assert_eq!(by_place.positions[0].name, "rod.x");
    let refused = |coordinates: &[&str]| asked(text, coordinates, &[]).expect_err("refused");
    assert!(matches!(
        refused(&["rod.y"]),
        LineariseError::Dependent { .. }
    ));
    assert!(matches!(
        refused(&["rod.x", "rod.angle"]),
        LineariseError::Dependent { .. }
    ));
    assert!(matches!(
        refused(&["rod.z"]),
        LineariseError::Coordinate { .. }
    ));
    assert!(matches!(
        refused(&["bar.x"]),
        LineariseError::Coordinate { .. }
    ));
    assert!(matches!(refused(&["x"]), LineariseError::Coordinate { .. }));
}

/// A disk that rolls upright at ω leans with `(A + m·r²)·λ² = m·g·r − C·(C + m·r²)·ω²/A`: m = 3, r
/// = 0.4, A = 0.12, C = 0.24. All other eigenvalues vanish.
#[test]
fn a_rolling_disk_is_steady_beyond_its_critical_speed() {
    let (m, r, a, c, g) = (3.0_f64, 0.4_f64, 0.12_f64, 0.24_f64, 9.81_f64);
    for omega in [0.5, 4.0] {
        let speed = omega * r;
        let text = format!(
            "
[scene]
name = \"disk\"
space = \"spatial\"
gravity = [0.0, 0.0, -{g}]
[[body]]
name = \"disk\"
mass = {m}
inertia = [{a}, {c}, {a}]
position = [0.0, 0.0, {r}]
velocity = [{speed}, 0.0, 0.0]
angular_velocity = [0.0, {omega}, 0.0]
[[joint]]
name = \"contact\"
type = \"wheel\"
body = \"disk\"
point = [0.0, 0.0, 0.0]
axis = [0.0, 1.0, 0.0]
radius = {r}
"
        );
        let x = asked(&text, &["disk.rx"], &["disk.x", "disk.y"]).unwrap_or_else(|e| panic!("{e}"));
        let square = (m * g * r - c * (c + m * r * r) * omega * omega / a) / (a + m * r * r);
        let found = eigenvalues(&x.a);
        let lean = if square > 0.0 {
            [square.sqrt(), 0.0]
        } else {
            [0.0, (-square).sqrt()]
        };
        let has = |value: [f64; 2]| {
            found
                .iter()
                .any(|z| (z[0] - value[0]).hypot(z[1] - value[1]) < 1e-9)
        };
        assert!(
            has(lean) && has([-lean[0], -lean[1]]),
            "{omega}: {found:?}, {lean:?}"
        );
        let zeros = found.iter().filter(|z| z[0].hypot(z[1]) < 1e-6).count();
        assert_eq!(zeros, found.len() - 2, "{found:?}");
    }
}

/// The weight of a pendulum depends on its angle.
#[test]
fn what_the_motion_depends_on_cannot_be_followed() {
    let text = "
scene = { name = \"pendulum\", space = \"plane\", gravity = [0.0, -9.81] }
body = [{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [0.0, -1.5] }]
joint = [{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0] }]
";
    let refused = asked(text, &[], &["rod.angle"]).expect_err("it swings");
    assert!(
        matches!(refused, LineariseError::NotASymmetry { .. }),
        "{refused}"
    );
}

/// A bumper begins to push at the position of the mass.
#[test]
fn a_force_with_a_corner_is_refused() {
    let text = "
scene = { name = \"mass\", space = \"plane\", format = 2, gravity = [0.0, 0.0] }
body = [{ name = \"mass\", mass = 2.0, inertia = 0.5 }]
joint = [{ name = \"rail\", type = \"translational\", bodies = [\"ground\", \"mass\"], at = [0.0, 0.0], axis = [1.0, 0.0] }]
drive = [{ name = \"bumper\", joint = \"rail\", type = \"displacement\", force = \"-50 * max(measure, 0)\" }]
";
    let refused = asked(text, &[], &[]).expect_err("a corner");
    assert!(
        matches!(refused, LineariseError::NotSmooth { ref body, .. } if body == "mass"),
        "{refused}"
    );
}

/// A bob on a rod of 0.2 m is 10 m away from a pendulum: steps of the size of the mechanism are
/// long for the rod. The reference is `ω² = g/l`, and `m·g·l/(J + m·l²)` for the pendulum.
#[test]
fn a_short_rod_in_a_large_mechanism_has_derivatives() {
    let text = "
scene = { name = \"bob\", space = \"plane\", gravity = [0.0, -9.81] }
body = [
    { name = \"bob\", mass = 1.0, inertia = 1.0, position = [0.0, -0.2] },
    { name = \"far\", mass = 1.0, inertia = 1.0, position = [10.0, -1.0] },
]
joint = [
    { name = \"rod\", type = \"distance\", bodies = [\"ground\", \"bob\"], at = [[0.0, 0.0], [0.0, -0.2]] },
    { name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"far\"], at = [10.0, 0.0] },
]
";
    let x = linearised(text);
    let mut found: Vec<f64> = eigenvalues(&x.a).iter().map(|value| value[1]).collect();
    found.sort_by(f64::total_cmp);
    let [bob, far] = [(9.81_f64 / 0.2).sqrt(), (9.81_f64 / 2.0).sqrt()];
    // The bob turns freely about its mass centre.
    let expected = [-bob, -far, 0.0, 0.0, far, bob];
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
    }
}

/// A rod on a pin hangs or is upright, with or without a damper.
#[test]
fn what_first_order_says_of_stability() {
    let scene = |y: f64, damping: f64| {
        format!(
            "
scene = {{ name = \"rod\", space = \"plane\", gravity = [0.0, -9.81] }}
body = [{{ name = \"rod\", mass = 2.0, inertia = 0.5, position = [0.0, {y:?}] }}]
joint = [{{ name = \"pin\", type = \"revolute\", bodies = [\"ground\", \"rod\"], at = [0.0, 0.0] }}]
force = [{{ name = \"oil\", type = \"torsion-spring-damper\", bodies = [\"ground\", \"rod\"], stiffness = 0.0, damping = {damping:?} }}]
"
        )
    };
    let said = |y, damping| {
        let modes = linearised(&scene(y, damping)).modes().expect("converges");
        Stability::of(&modes)
    };
    assert_eq!(said(-1.5, 0.3), Stability::Stable);
    assert_eq!(said(-1.5, 0.0), Stability::Marginal);
    assert_eq!(said(1.5, 0.3), Stability::Unstable);
    let modes = linearised(&scene(-1.5, 0.3)).modes().expect("converges");
    let [mode] = &modes[..] else {
        panic!("{modes:?}")
    };
    // The equation is (J + m·l²)·ÿ + d·ẏ + m·g·l·y = 0.
    let (mass, stiffness): (f64, f64) = (5.0, 2.0 * 9.81 * 1.5);
    let natural = (stiffness / mass).sqrt();
    assert!((mode.natural_frequency() - natural).abs() < 1e-11);
    let ratio = mode.damping_ratio().expect("not zero");
    assert!(
        (ratio - 0.3 / (2.0 * mass * natural)).abs() < 1e-12,
        "{ratio}"
    );
}

/// A pendulum of mass m has its mass centre l below a cart on a rail, which a drive moves:
/// `(J + m·l²)·φ̈ = −m·g·l·φ − m·l·ẍ`. A force on the bob along x gives `l/(J + m·l²)`.
#[test]
fn drives_and_forces_are_inputs() {
    let text = "
scene = { name = \"cart\", space = \"plane\", gravity = [0.0, -9.81] }
body = [
  { name = \"cart\", mass = 3.0, inertia = 1.0 },
  { name = \"rod\", mass = 2.0, inertia = 0.5, position = [0.0, -1.5] },
]
joint = [
  { name = \"rail\", type = \"translational\", bodies = [\"ground\", \"cart\"], at = [0.0, 0.0], axis = [1.0, 0.0] },
  { name = \"pin\", type = \"revolute\", bodies = [\"cart\", \"rod\"], at = [0.0, 0.0] },
]
drive = [{ name = \"motor\", joint = \"rail\", type = \"displacement\", motion = { type = \"polynomial\", coefficients = [0.0] } }]
force = [{ name = \"push\", type = \"point-force\", body = \"rod\", point = [0.0, 0.0], force = [0.0, 0.0] }]
";
    let x = linearised(text);
    let names: Vec<String> = x
        .inputs
        .iter()
        .map(|i| format!("{}.{}", i.name, i.what))
        .collect();
    let expected = [
        ("motor.value", 0.0),
        ("motor.rate", 0.0),
        ("motor.acceleration", -2.0 * 1.5 / 5.0),
        ("push.force.x", 1.5 / 5.0),
        ("push.force.y", 0.0),
    ];
    assert_eq!(names, expected.map(|(name, _)| name));
    assert_eq!([x.positions.len(), x.velocities.len()], [1, 1]);
    for (k, (name, rate)) in expected.iter().enumerate() {
        assert!(x.b[(0, k)].abs() < 1e-13, "{name}");
        assert!(
            (x.b[(1, k)] - rate).abs() < 1e-12,
            "{name}: {}",
            x.b[(1, k)]
        );
    }
}

/// Table 2 of Meijaard et al.: the eigenvalues of weave, capsize and castering.
const BICYCLE: [(f64, [[f64; 2]; 4]); 11] = [
    (
        0.0,
        [
            [-3.131_643_247_906_56, 0.0],
            [3.131_643_247_906_56, 0.0],
            [-5.530_943_717_653_93, 0.0],
            [5.530_943_717_653_93, 0.0],
        ],
    ),
    (
        1.0,
        [
            [3.526_961_709_900_70, 0.807_740_275_199_30],
            [3.526_961_709_900_70, -0.807_740_275_199_30],
            [-3.134_231_250_665_78, 0.0],
            [-7.110_080_146_374_42, 0.0],
        ],
    ),
    (
        2.0,
        [
            [2.682_345_175_127_45, 1.680_662_965_906_75],
            [2.682_345_175_127_45, -1.680_662_965_906_75],
            [-3.071_586_456_415_14, 0.0],
            [-8.673_879_848_317_35, 0.0],
        ],
    ),
    (
        3.0,
        [
            [1.706_756_056_639_75, 2.315_824_473_843_25],
            [1.706_756_056_639_75, -2.315_824_473_843_25],
            [-2.633_661_372_536_67, 0.0],
            [-10.351_014_672_459_2, 0.0],
        ],
    ),
    (
        4.0,
        [
            [0.413_253_315_211_25, 3.079_108_186_032_06],
            [0.413_253_315_211_25, -3.079_108_186_032_06],
            [-1.429_444_273_613_26, 0.0],
            [-12.158_614_265_764_47, 0.0],
        ],
    ),
    (
        5.0,
        [
            [-0.775_341_882_195_85, 4.464_867_713_788_23],
            [-0.775_341_882_195_85, -4.464_867_713_788_23],
            [-0.322_866_429_004_09, 0.0],
            [-14.078_389_692_798_22, 0.0],
        ],
    ),
    (
        6.0,
        [
            [-1.526_444_865_841_42, 5.876_730_605_987_09],
            [-1.526_444_865_841_42, -5.876_730_605_987_09],
            [-0.004_066_900_769_70, 0.0],
            [-16.085_371_230_980_26, 0.0],
        ],
    ),
    (
        7.0,
        [
            [-2.138_756_442_583_62, 7.195_259_133_298_05],
            [-2.138_756_442_583_62, -7.195_259_133_298_05],
            [0.102_681_705_747_66, 0.0],
            [-18.157_884_661_252_62, 0.0],
        ],
    ),
    (
        8.0,
        [
            [-2.693_486_835_810_97, 8.460_379_713_969_31],
            [-2.693_486_835_810_97, -8.460_379_713_969_31],
            [0.143_278_797_657_13, 0.0],
            [-20.279_408_943_945_69, 0.0],
        ],
    ),
    (
        9.0,
        [
            [-3.216_754_022_524_85, 9.693_773_515_317_91],
            [-3.216_754_022_524_85, -9.693_773_515_317_91],
            [0.157_901_840_309_17, 0.0],
            [-22.437_885_590_408_58, 0.0],
        ],
    ),
    (
        10.0,
        [
            [-3.720_168_404_372_87, 10.906_811_394_762_87],
            [-3.720_168_404_372_87, -10.906_811_394_762_87],
            [0.161_053_386_531_72, 0.0],
            [-24.624_596_350_174_04, 0.0],
        ],
    ),
];

#[test]
fn the_benchmark_bicycle_has_its_published_eigenvalues() {
    for (speed, expected) in BICYCLE {
        let x = linearised(&bicycle::upright(speed));
        let found = eigenvalues(&x.a);
        for value in expected {
            let nearest = found
                .iter()
                .map(|z| (z[0] - value[0]).hypot(z[1] - value[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 1e-9,
                "{speed} m/s: {value:?} by {nearest:e} in {found:?}"
            );
        }
    }
}
