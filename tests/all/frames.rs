//! Frames whose origin is not the centre of mass, markers and joint coordinates. A scene describes
//! the same motion in any frames, and its columns belong to these frames.

use pfaff::documents::MotionDocument;
use pfaff::model::Registry;
use pfaff::{RunOptions, Study};

/// The centre of mass of each body in its frame: cranks, coupler and pendulum.
type Centres = [[f64; 2]; 5];

const AT_THE_CENTRES: Centres = [[0.0; 2]; 5];

/// The frames are at a joint, beyond the body, and at the centre of mass.
const SHIFTED: Centres = [
    [0.2, 0.0],
    [-0.3, 0.7],
    [0.0, 0.0],
    [1.5, -2.0],
    [0.05, -0.25],
];

/// Angle of the cranks at the start (rad), their rate (rad/s) and length (m).
const PHI: f64 = 1.0;
const RATE: f64 = 2.0;
const CRANK: f64 = 0.4;
/// Angle and angular velocity of the pendulum at the start.
const SWING: f64 = 0.3;
const SWING_RATE: f64 = -1.0;

const NAMES: [&str; 5] = ["one", "two", "three", "coupler", "pendulum"];

fn turned(angle: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// The velocity ω × r.
fn whirl(omega: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    [-omega * y, omega * x]
}

/// A driven parallelogram has a third crank, which makes it redundant. A pendulum on its coupler
/// has a spring; a load acts in the frame of the coupler; and `start` keeps some values.
fn scene(centres: &Centres) -> String {
    let tip = turned(PHI, [CRANK, 0.0]);
    let hook = plus(tip, [0.5, 0.0]);
    // Centres of mass, angles and velocities: those of the pendulum are given.
    let hang = turned(SWING, [0.0, -0.25]);
    let hook_velocity = whirl(RATE, tip);
    let mass_centres = [
        turned(PHI, [0.2, 0.0]),
        plus(turned(PHI, [0.2, 0.0]), [1.0, 0.0]),
        plus(turned(PHI, [0.2, 0.0]), [0.6, 0.0]),
        hook,
        plus(hook, hang),
    ];
    let angles = [PHI, PHI, PHI, 0.0, SWING];
    let mut text =
        String::from("[scene]\nname = \"frames\"\nspace = \"plane\"\ngravity = [0.0, -9.81]\n");
    for k in 0..5 {
        let (c, arm) = (centres[k], turned(angles[k], centres[k]));
        let origin = minus(mass_centres[k], arm);
        text += &format!(
            "[[body]]\nname = {:?}\nmass = {}\ninertia = {}\ncentre = {c:?}\nposition = {origin:?}\nangle = {:?}\n",
            NAMES[k],
            1.0 + k as f64,
            0.1 + 0.05 * k as f64,
            angles[k],
        );
        if k == 4 {
            let of_mass = plus(hook_velocity, whirl(SWING_RATE, hang));
            let of_origin = minus(of_mass, whirl(SWING_RATE, arm));
            text += &format!("velocity = {of_origin:?}\nangular_velocity = {SWING_RATE:?}\n");
        }
    }
    let point = |k: usize, s: [f64; 2]| format!("{} = {:?}", NAMES[k], plus(centres[k], s));
    let mut pin = |name: &str, first: String, second: String, of: [&str; 2]| {
        text += &format!(
            "[[joint]]\nname = {name:?}\ntype = \"revolute\"\nbodies = {of:?}\npoints = {{ {first}, {second} }}\n"
        );
    };
    for (k, x) in [(0, 0.0), (1, 1.0), (2, 0.6)] {
        let ground = format!("ground = [{x:?}, 0.0]");
        pin(
            &format!("foot {k}"),
            ground,
            point(k, [-0.2, 0.0]),
            ["ground", NAMES[k]],
        );
        let head = point(3, [x - 0.5, 0.0]);
        pin(
            &format!("head {k}"),
            point(k, [0.2, 0.0]),
            head,
            [NAMES[k], "coupler"],
        );
    }
    pin(
        "hook",
        point(3, [0.0, 0.0]),
        point(4, [0.0, 0.25]),
        ["coupler", "pendulum"],
    );
    let [rim, end] = [plus(centres[3], [0.1, 0.2]), plus(centres[4], [0.0, -0.25])];
    text += &format!(
        "[[marker]]\nname = \"rim\"\nbody = \"coupler\"\npoint = {rim:?}\n\
         [[marker]]\nname = \"end\"\nbody = \"pendulum\"\npoint = {end:?}\nangle = 0.5\n\
         [[marker]]\nname = \"wall\"\nbody = \"ground\"\npoint = [0.0, -1.0]\n"
    );
    for (name, kind, of) in [
        ("span", "distance", "[\"rim\", \"end\"]"),
        ("turn", "angle", "[\"rim\", \"end\"]"),
        ("along", "x", "[\"end\", \"rim\"]"),
        ("across", "y", "[\"end\", \"rim\"]"),
        ("pace", "speed", "[\"end\", \"rim\"]"),
        ("rim pace", "speed", "[\"rim\"]"),
        ("whirl", "angular-velocity", "[\"ground\", \"end\"]"),
    ] {
        text += &format!("[[measure]]\nname = {name:?}\ntype = {kind:?}\nmarkers = {of}\n");
    }
    text += "[[drive]]\nname = \"motor\"\njoint = \"foot 0\"\ntype = \"angle\"\n\
             motion = { type = \"constant-rate\", rate = 2.0 }\n\
             [[force]]\nname = \"spring\"\ntype = \"spring-damper\"\nbodies = [\"ground\", \"pendulum\"]\n\
             at = [\"wall\", \"end\"]\nstiffness = 20.0\ndamping = 0.5\n\
             [[force]]\nname = \"load\"\ntype = \"point-force\"\nbody = \"coupler\"\npoint = \"rim\"\n\
             force = [1.0, -2.0]\nframe = \"body\"\n\
             [start]\nkeep = [\"pendulum.x\", \"pendulum.angle\", \"pendulum.vx\", \"pendulum.omega\"]\n\
             [simulate]\nt_end = 3.0\nrtol = 1e-10\natol = 1e-12\noutput_step = 0.1\n";
    text
}

fn moved(centres: &Centres) -> MotionDocument {
    let text = scene(centres);
    let study = Study::read(
        "frames.toml",
        &text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    let study = study.unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = study.options.clone().expect("it has a run");
    study.motion(&options).expect("it moves")
}

/// Limit for the rounding of values of size ten, amplified along three seconds of the motion.
const SAME: f64 = 1e-10;

#[track_caller]
fn assert_same(found: f64, expected: f64, what: &str) {
    let apart = (found - expected).abs();
    // A component that is not determined has no value in either scene.
    let is_none = found.is_nan() && expected.is_nan();
    assert!(
        is_none || apart <= SAME * expected.abs().max(1.0),
        "{what}: {found} instead of {expected}, {apart:e} apart"
    );
}

#[test]
fn a_scene_in_other_frames_says_the_same_motion() {
    let (plain, shifted) = (moved(&AT_THE_CENTRES), moved(&SHIFTED));
    let verdicts = |m: &MotionDocument| -> Vec<(String, &'static str)> {
        let all = m.summary.reactions.0.iter();
        all.map(|(name, r)| (name.clone(), r.verdict())).collect()
    };
    let known = verdicts(&plain);
    assert_eq!(known, verdicts(&shifted));
    let unique = known.iter().filter(|(_, verdict)| *verdict == "unique");
    assert_eq!((known.len(), unique.count()), (8, 2), "{known:?}");
    assert_eq!((plain.rows.len(), shifted.rows.len()), (31, 31));
    for (a, b) in plain.rows.iter().zip(&shifted.rows) {
        for (k, name) in NAMES.iter().enumerate() {
            let (mass, frame) = (&a.bodies[name], &b.bodies[name]);
            // Computes the origin of the frame, and its velocity, from the centre of mass.
            let arm = turned(mass["angle"], SHIFTED[k]);
            let [x, y] = minus([mass["x"], mass["y"]], arm);
            let [vx, vy] = minus([mass["vx"], mass["vy"]], whirl(mass["omega"], arm));
            let expected = [x, y, mass["angle"], vx, vy, mass["omega"]];
            let found = [
                frame["x"],
                frame["y"],
                frame["angle"],
                frame["vx"],
                frame["vy"],
                frame["omega"],
            ];
            for (found, expected) in found.into_iter().zip(expected) {
                assert_same(found, expected, &format!("{name} at {} s", a.t));
            }
        }
        for (name, reaction) in &a.reactions.0 {
            for (component, expected) in &reaction.0 {
                let found = b.reactions[name][component];
                assert_same(
                    found,
                    *expected,
                    &format!("{name}.{component} at {} s", a.t),
                );
            }
        }
        for (name, expected) in &a.measures.0 {
            assert_same(b.measures[name], *expected, &format!("{name} at {} s", a.t));
        }
    }
}

#[test]
fn markers_and_measures_are_those_of_closed_forms() {
    let motion = moved(&SHIFTED);
    for row in &motion.rows {
        let phi = PHI + RATE * row.t;
        let what = format!("at {} s", row.t);
        // The coupler does not rotate: its points move on circles.
        let rim = plus(turned(phi, [CRANK, 0.0]), [0.6, 0.2]);
        let marker = &row.markers["rim"];
        assert_same(marker["x"], rim[0], &what);
        assert_same(marker["y"], rim[1], &what);
        let rim_velocity = whirl(RATE, turned(phi, [CRANK, 0.0]));
        assert_same(marker["vx"], rim_velocity[0], &what);
        assert_same(marker["vy"], rim_velocity[1], &what);
        assert_same(row.measures["rim pace"], RATE * CRANK, &what);
        // Computes the end of the pendulum from its angle and its rate.
        let pendulum = &row.bodies["pendulum"];
        let (angle, omega) = (pendulum["angle"], pendulum["omega"]);
        let hook = plus(turned(phi, [CRANK, 0.0]), [0.5, 0.0]);
        let end = plus(hook, turned(angle, [0.0, -0.5]));
        let end_velocity = plus(rim_velocity, whirl(omega, turned(angle, [0.0, -0.5])));
        let marker = &row.markers["end"];
        for (found, expected) in [
            (marker["x"], end[0]),
            (marker["y"], end[1]),
            (marker["angle"], angle + 0.5),
            (marker["vx"], end_velocity[0]),
            (marker["vy"], end_velocity[1]),
            (marker["omega"], omega),
        ] {
            assert_same(found, expected, &what);
        }
        let apart = minus(rim, end);
        let [along, across] = turned(-(angle + 0.5), apart);
        // In rotating axes the velocity is d/dt of Rᵀ·(r₂ − r₁).
        let seen = minus(minus(rim_velocity, end_velocity), whirl(omega, apart));
        for (name, expected) in [
            ("span", apart[0].hypot(apart[1])),
            ("turn", angle + 0.5),
            ("along", along),
            ("across", across),
            ("pace", seen[0].hypot(seen[1])),
            ("whirl", omega),
        ] {
            assert_same(row.measures[name], expected, &format!("{name} {what}"));
        }
    }
}

/// Returns the error of the reader for the scene with this change.
fn refused(change: impl Fn(String) -> String) -> String {
    let text = change(scene(&SHIFTED));
    let read = Study::read(
        "frames.toml",
        &text,
        &Registry::standard(),
        &RunOptions::default(),
    );
    read.err().expect("it is refused").to_string()
}

#[test]
fn what_belongs_to_a_shifted_origin_needs_the_rotation() {
    let alone = refused(|s| s.replace("angular_velocity = -1.0\n", ""));
    assert!(
        alone.contains("body `pendulum`: `velocity` is that of the origin of its frame"),
        "{alone}"
    );
    let without_angle = refused(|s| s.replace("\"pendulum.angle\", ", ""));
    assert!(
        without_angle.contains("keep `pendulum.angle`, too"),
        "{without_angle}"
    );
    let without_omega = refused(|s| s.replace(", \"pendulum.omega\"]", "]"));
    assert!(
        without_omega.contains("keep `pendulum.omega`, too"),
        "{without_omega}"
    );
}
