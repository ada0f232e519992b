//! Starts with velocities: given velocities are kept, drives determine the velocities that they
//! prescribe, and the others are those of least kinetic energy. An error names impossible
//! velocities, with advice that works. The correct result is computed from singular values of the
//! dense rows, which the program does not use here.

mod scenes;

use model::start::{HeldVelocity, StartError, scene_size};
use model::{Registry, System};
use nalgebra::{DMatrix, DVector};
use pfaff::{AssembledScene, RunOptions, Study, StudyError};
use scenes::{NAMES, Sketch};
use tests::numbers::Numbers;

const SEED: u64 = 8;

/// Number of scenes of the test.
const SCENES: usize = 1000;

/// Singular values below this fraction of the largest are zero; the scenes have no value between
/// this and a thousandth.
const ZERO: f64 = 1e-8;

/// Largest error of the velocities of the program, relative to the fastest: rounding at a hundred
/// sizes from the origin, times the condition number of a linkage.
const AGREES: f64 = 1e-9;

/// Rows and right-hand sides of a start, with columns in units of points: rotations are multiplied
/// by the size of the mechanism.
struct Rows {
    c: DMatrix<f64>,
    b: DVector<f64>,
    mass: Vec<f64>,
    unit: Vec<f64>,
    is_drive: Vec<bool>,
    is_joint_alone: Vec<usize>,
}

fn read(text: &str) -> AssembledScene {
    AssembledScene::read("starts.toml", text, &Registry::standard())
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn rows(text: &str) -> Rows {
    let mut assembled = read(text);
    let q = assembled
        .assemble()
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
        .q;
    let m = &assembled.mechanism;
    let size = scene_size(m, &q);
    let mut s = m.scratch();
    m.pose(0.0, &q, &mut s);
    m.c(&mut s);
    m.b(&mut s);
    let layout = m.layout();
    let dense = layout.dense(&s);
    let unit: Vec<f64> = (0..layout.n_v)
        .map(|j| if j % 3 == 2 { 1.0 / size } else { 1.0 })
        .collect();
    // Rows of angles are scaled to the size of the rows of lengths.
    let scale = |i: usize| if m.layout().is_angular(i) { size } else { 1.0 };
    let drives = layout.drive_rows();
    Rows {
        c: DMatrix::from_fn(layout.rows(), layout.n_v, |i, j| {
            scale(i) * dense[(i, j)] * unit[j]
        }),
        b: DVector::from_fn(layout.rows(), |i, _| scale(i) * s.b[i]),
        mass: m.mass().iter().zip(&unit).map(|(m, u)| m * u * u).collect(),
        unit,
        is_drive: (0..layout.rows()).map(|i| drives.contains(&i)).collect(),
        is_joint_alone: (0..layout.rows()).filter(|i| !drives.contains(i)).collect(),
    }
}

/// Returns orthonormal bases of the range and of the left null space.
fn range(a: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = a.nrows();
    if a.ncols() == 0 || n == 0 {
        return (DMatrix::zeros(n, 0), DMatrix::identity(n, n));
    }
    // All left singular vectors are needed, so the matrix must have at least as many columns as
    // rows.
    let wide = a.clone().resize_horizontally(n.max(a.ncols()), 0.0);
    let svd = wide.svd(true, false);
    let u = svd.u.expect("asked for");
    let largest = svd.singular_values.max();
    let live: Vec<usize> = (0..n)
        .filter(|&k| svd.singular_values[k] > ZERO * largest)
        .collect();
    let dead: Vec<usize> = (0..n).filter(|k| !live.contains(k)).collect();
    (u.select_columns(&live), u.select_columns(&dead))
}

/// Returns the component of a vector outside of the range.
fn outside(a: &DMatrix<f64>, b: &DVector<f64>) -> f64 {
    let (_, left) = range(a);
    (left.transpose() * b).norm()
}

fn solve(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    if a.ncols() == 0 {
        return DVector::zeros(0);
    }
    let svd = a.clone().svd(true, true);
    let floor = ZERO * svd.singular_values.max();
    svd.solve(b, floor).expect("both factors")
}

/// Way in which velocities are given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Given {
    Exact,
    Rounded,
    OneWrong,
    Any,
}

/// Gives some velocities of a scene.
fn give(sketch: &mut Sketch, rows: &Rows, numbers: &mut Numbers, how: Given) {
    let fastest = match rows.b.amax() {
        0.0 => 1.0,
        b => b,
    };
    let n = rows.unit.len();
    let particular = solve(&rows.c, &rows.b);
    let (_, free) = range(&rows.c.transpose());
    let random = DVector::from_fn(free.ncols(), |_, _| fastest * numbers.unit());
    let mut v = particular + free * random;
    if how == Given::Any {
        v = DVector::from_fn(n, |_, _| fastest * numbers.unit());
    }
    let scale = v.amax();
    let digits = |x: f64| match how {
        // The velocities of a locked part are only rounding errors of the generator.
        _ if x.abs() < 1e-12 * fastest => 0.0,
        Given::Rounded => format!("{x:.4e}").parse().expect("a number"),
        _ => x,
    };
    let wrong = numbers.below(sketch.bodies.len());
    for (k, body) in sketch.bodies.iter_mut().enumerate() {
        let of = |dof: usize| digits(v[3 * k + dof]) * rows.unit[3 * k + dof];
        body.velocity = numbers.once_in(2).then(|| [of(0), of(1)]);
        body.angular_velocity = numbers.once_in(2).then(|| of(2));
        if how == Given::OneWrong && k == wrong {
            let off = 0.3 * scale.max(fastest);
            body.velocity = Some([of(0) + off, of(1) - 0.7 * off]);
        }
    }
    if how == Given::Exact && numbers.once_in(3) {
        let body = numbers.below(sketch.bodies.len());
        let dof = numbers.below(3);
        let is_given = match dof {
            2 => sketch.bodies[body].angular_velocity.is_some(),
            _ => sketch.bodies[body].velocity.is_some(),
        };
        if is_given {
            sketch.keep.push((body, dof));
        }
    }
}

/// Returns the given velocities by column, in units of points.
fn held(sketch: &Sketch, rows: &Rows) -> Vec<Option<f64>> {
    let all = sketch.bodies.iter().flat_map(|b| {
        let [vx, vy] = b.velocity.map_or([None; 2], |v| v.map(Some));
        [vx, vy, b.angular_velocity]
    });
    all.zip(&rows.unit)
        .map(|(v, unit)| v.map(|v| v / unit))
        .collect()
}

/// The correct result for a start.
enum Truth {
    /// Drives contradict each other or the joints.
    Drives,
    /// Velocities exist: `g` contains the given ones.
    Velocities { g: Vec<f64>, is_exact: bool },
    /// The given velocities are impossible, but others exist.
    Given,
    /// The start is too close to a limit for a reliable result.
    Border,
}

/// Returns the columns that are given, and the other columns.
fn split(held: &[Option<f64>]) -> (Vec<usize>, Vec<usize>) {
    (0..held.len()).partition(|&j| held[j].is_some())
}

fn truth(rows: &Rows, held: &[Option<f64>]) -> Truth {
    let size = rows
        .b
        .norm()
        .max(held.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs())));
    if size == 0.0 {
        return Truth::Velocities {
            g: held.iter().flatten().copied().collect(),
            is_exact: true,
        };
    }
    if outside(&rows.c, &rows.b) > 1e-6 * rows.b.norm() {
        return Truth::Drives;
    }
    let (given, free) = split(held);
    let g = DVector::from_iterator(given.len(), given.iter().filter_map(|&j| held[j]));
    let (cf, cg) = (rows.c.select_columns(&free), rows.c.select_columns(&given));
    let (_, z) = range(&cf);
    let rhs = z.transpose() * (&rows.b - &cg * &g);
    if rhs.norm() <= 1e-11 * size {
        return Truth::Velocities {
            g: g.iter().copied().collect(),
            is_exact: true,
        };
    }
    // Computes the smallest correction in the mass metric.
    let root = DVector::from_iterator(
        given.len(),
        given.iter().map(|&j| rows.mass[j].sqrt().recip()),
    );
    let a = z.transpose() * &cg * DMatrix::from_diagonal(&root);
    let delta = solve(&a, &rhs).component_mul(&root);
    let corrected = &g + &delta;
    let fastest = {
        let free = solve(&cf, &(&rows.b - &cg * &corrected));
        free.amax().max(g.amax()).max(corrected.amax())
    };
    // The limit applies to connected bodies: between these bounds the separate parts of a scene may
    // differ.
    match delta.amax() / fastest {
        share if share > 2e-2 => Truth::Given,
        share if share < 1e-4 => Truth::Velocities {
            g: corrected.iter().copied().collect(),
            is_exact: false,
        },
        _ => Truth::Border,
    }
}

/// Checks C·v = b, the given velocities, and M·v = Cᵀ·μ for the others.
fn check_accepted(rows: &Rows, held: &[Option<f64>], study: &Study, g: &[f64], is_exact: bool) {
    let v: Vec<f64> = study
        .prepared
        .v
        .iter()
        .zip(&rows.unit)
        .map(|(v, u)| v / u)
        .collect();
    let v = DVector::from_vec(v);
    let fastest = v.amax().max(rows.b.amax());
    let misses = (&rows.c * &v - &rows.b).amax();
    assert!(
        misses <= AGREES * fastest,
        "C·v − b = {misses:e} of {fastest:e}"
    );
    let (given, free) = split(held);
    for (&j, &g) in given.iter().zip(g) {
        let off = (v[j] - g).abs();
        let exact = held[j].expect("given");
        assert!(
            off <= AGREES * fastest || is_exact && v[j] == exact,
            "given {g:e}, {off:e} off"
        );
    }
    // The vector M·v is in the range of C_Fᵀ.
    let momentum = DVector::from_iterator(free.len(), free.iter().map(|&j| rows.mass[j] * v[j]));
    let left = outside(&rows.c.select_columns(&free).transpose(), &momentum);
    let heaviest = rows.mass.iter().copied().fold(0.0, f64::max);
    assert!(
        left <= AGREES * heaviest * fastest,
        "M·v − Cᵀ·μ = {left:e} of {:e}",
        heaviest * fastest
    );
}

/// Returns the scene without the entries that the advice omits.
fn without(sketch: &Sketch, leave_out: &[HeldVelocity]) -> Sketch {
    let mut sketch = sketch.clone();
    for held in leave_out {
        let at = |name: &String, s: &Sketch| {
            s.bodies
                .iter()
                .position(|b| b.name == *name)
                .expect("a body")
        };
        match held {
            HeldVelocity::Velocity { body } => {
                let k = at(body, &sketch);
                assert!(
                    sketch.bodies[k].velocity.take().is_some(),
                    "`{body}` gives no velocity"
                );
            }
            HeldVelocity::AngularVelocity { body } => {
                let k = at(body, &sketch);
                assert!(
                    sketch.bodies[k].angular_velocity.take().is_some(),
                    "`{body}` gives no rate"
                );
            }
            HeldVelocity::Keep { body, coordinate } => {
                let k = at(body, &sketch);
                let dof = NAMES
                    .iter()
                    .position(|name| name == coordinate)
                    .expect("a velocity");
                let before = sketch.keep.len();
                sketch.keep.retain(|kept| *kept != (k, dof));
                assert_eq!(sketch.keep.len() + 1, before);
            }
            other => panic!("{other}"),
        }
    }
    sketch
}

/// The reason why a start was rejected: drives, or one of the conflicts.
enum Refusal {
    Drives,
    Later,
    Given(Box<model::start::VelocityConflict>),
}

fn refusal(sketch: &Sketch, error: &StudyError) -> Refusal {
    if error.only_motion().is_some() {
        return Refusal::Later;
    }
    let mut assembled = read(&sketch.text());
    let q = assembled.assemble().expect("assembled").q;
    let found = solvability::rows(&assembled.mechanism, 0.0, &q).expect("finite");
    let start = &assembled.scene.start;
    match dynamics::start_velocity(&assembled.mechanism, start, &found, &q, &found.all.kept) {
        Err(dynamics::MotionError::Contradiction(c)) => {
            assert!(c.is_of_drives(), "{c}");
            Refusal::Drives
        }
        Err(dynamics::MotionError::Start(StartError::Velocities(conflict))) => {
            Refusal::Given(conflict)
        }
        // The error concerns accelerations: at these velocities the joints do not allow the
        // accelerations of the drives.
        Ok((_, Some(_))) => Refusal::Later,
        other => panic!("{:?}: {error}", other.err()),
    }
}

/// A thousand scenes are accepted exactly if such velocities exist, and then the velocities are
/// correct; otherwise the named entries cause the conflict and the advice works.
#[test]
fn a_thousand_random_starts() {
    let mut numbers = Numbers::new(SEED);
    let mut tally = std::collections::BTreeMap::<&str, usize>::new();
    for number in 0..SCENES {
        let mut sketch = Sketch::random(&mut numbers);
        let bare = rows(&sketch.text());
        let how = [Given::Exact, Given::Rounded, Given::OneWrong, Given::Any][numbers.below(4)];
        give(&mut sketch, &bare, &mut numbers, how);
        let text = sketch.text();
        let held = held(&sketch, &bare);
        let context = || format!("scene {number}, {how:?}\n{text}");
        let result = read(&text).prepare(&RunOptions::default());
        let kind = match (truth(&bare, &held), &result) {
            (Truth::Border, _) => "too near to a limit",
            (Truth::Velocities { g, is_exact }, Ok(study)) => {
                let checked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
                    check_accepted(&bare, &held, study, &g, is_exact);
                }));
                assert!(checked.is_ok(), "{}", context());
                if is_exact { "accepted" } else { "corrected" }
            }
            (Truth::Drives, Err(e)) => {
                assert!(
                    matches!(refusal(&sketch, e), Refusal::Drives),
                    "{e}\n{}",
                    context()
                );
                "drives named"
            }
            (Truth::Given, Err(e)) => {
                let Refusal::Given(conflict) = refusal(&sketch, e) else {
                    panic!("{e}\n{}", context());
                };
                check_conflict(&bare, &held, &sketch, &conflict, &context());
                if conflict.drives.is_empty() {
                    "given velocity named"
                } else {
                    "drive and given velocity named"
                }
            }
            (Truth::Velocities { .. }, Err(e)) => {
                let is_later = matches!(refusal(&sketch, e), Refusal::Later);
                assert!(sketch.is_singular && is_later, "{e}\n{}", context());
                "velocities that cannot continue"
            }
            (Truth::Drives | Truth::Given, Ok(_)) => panic!("accepted: {}", context()),
        };
        *tally.entry(kind).or_default() += 1;
    }
    for kind in [
        "accepted",
        "corrected",
        "drives named",
        "given velocity named",
        "drive and given velocity named",
    ] {
        assert!(tally.get(kind).is_some_and(|n| *n >= 20), "{tally:?}");
    }
    assert!(
        tally
            .get("too near to a limit")
            .is_none_or(|n| *n < SCENES / 20),
        "{tally:?}"
    );
}

fn check_conflict(
    rows: &Rows,
    held: &[Option<f64>],
    sketch: &Sketch,
    conflict: &model::start::VelocityConflict,
    context: &str,
) {
    // The velocity is given, and the conflict is smaller without it.
    let body = sketch
        .bodies
        .iter()
        .position(|b| b.name == conflict.body)
        .expect("a body");
    let dof = NAMES
        .iter()
        .position(|name| *name == conflict.coordinate)
        .expect("a velocity");
    let column = 3 * body + dof;
    assert!(held[column].is_some(), "{conflict}\n{context}");
    let miss = |held: &[Option<f64>], c: &DMatrix<f64>, b: &DVector<f64>| {
        let (given, free) = split(held);
        let g = DVector::from_iterator(given.len(), given.iter().filter_map(|&j| held[j]));
        outside(
            &c.select_columns(&free),
            &(b - c.select_columns(&given) * g),
        )
    };
    let before = miss(held, &rows.c, &rows.b);
    let mut freed = held.to_vec();
    freed[column] = None;
    let after = miss(&freed, &rows.c, &rows.b);
    assert!(
        after < before * (1.0 - 1e-9),
        "{before:e} → {after:e}: {conflict}\n{context}"
    );
    // A drive is named if the joints alone allow the velocity together with the others.
    let joints = rows.c.select_rows(&rows.is_joint_alone);
    let nothing = DVector::zeros(joints.nrows());
    if miss(held, &joints, &nothing) <= 1e-9 * before {
        assert!(!conflict.drives.is_empty(), "{conflict}\n{context}");
    }
    if !rows.is_drive.contains(&true) {
        assert!(conflict.drives.is_empty(), "{conflict}\n{context}");
    }
    // The advice must work.
    assert!(
        conflict.is_enough && !conflict.leave_out.is_empty(),
        "{conflict}\n{context}"
    );
    let mended = without(sketch, &conflict.leave_out);
    match read(&mended.text()).prepare(&RunOptions::default()) {
        Ok(_) => {}
        Err(e) => assert!(
            sketch.is_singular && matches!(refusal(&mended, &e), Refusal::Later),
            "{conflict}\nbut then {e}\n{context}"
        ),
    }
    if conflict.can_be_corrected {
        let allowed = sketch
            .text()
            .replace("[start]", "[start]\nallow_correction = true");
        if let Err(e) = read(&allowed).prepare(&RunOptions::default()) {
            assert!(
                sketch.is_singular && e.only_motion().is_some(),
                "{e}\n{context}"
            );
        }
    }
}

/// A locked part with a velocity larger than rounding is rejected with an error; with a velocity up
/// to rounding it is at rest, at any position and of any size.
#[test]
fn locked_parts() {
    for size in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for far in [0.0, 1e3] {
            let scene = |velocity: f64, rate: f64| {
                format!(
                    "scene = {{ name = \"locked\", space = \"plane\" }}\n\
                     body = [{{ name = \"part\", mass = 2.0, inertia = {:e}, position = [{:e}, {:e}], velocity = [{velocity:e}, 0.0], angular_velocity = {rate:e} }}]\n\
                     joint = [\n\
                       {{ name = \"A\", type = \"revolute\", bodies = [\"ground\", \"part\"], at = [{:e}, {:e}] }},\n\
                       {{ name = \"B\", type = \"revolute\", bodies = [\"ground\", \"part\"], at = [{:e}, {:e}] }},\n]\n",
                    0.1 * size * size,
                    far * size,
                    0.0,
                    (far - 0.5) * size,
                    0.0,
                    (far + 0.5) * size,
                    0.3 * size
                )
            };
            for speed in [1e-9, 1e-3, 1.0, 1e3] {
                for (velocity, rate) in [(speed * size, 0.0), (0.0, speed), (speed * size, -speed)]
                {
                    let error = read(&scene(velocity, rate))
                        .prepare(&RunOptions::default())
                        .err();
                    let said = error.expect("it is locked").to_string();
                    assert!(
                        said.contains("of body `part` is given as"),
                        "{size:e}, {far}: {said}"
                    );
                    assert!(said.contains("omit"), "{said}");
                }
            }
            for rounding in [0.0, 1e-17, -1e-20, 1e-300] {
                let study =
                    read(&scene(rounding * size, 0.3 * rounding)).prepare(&RunOptions::default());
                let study = study.unwrap_or_else(|e| panic!("{size:e}, {rounding:e}: {e}"));
                assert!(
                    study
                        .prepared
                        .v
                        .iter()
                        .all(|v| v.abs() <= rounding.abs() * size.max(1.0))
                );
            }
        }
    }
}

/// The velocity of a locked part may be as large as the rounding error of the rate of a fast wheel;
/// a velocity that is a billion times as large is an error.
#[test]
fn rounding_of_a_fast_wheel_is_no_velocity_of_a_locked_part() {
    let scene = |rate: f64, noise: f64| {
        format!(
            "scene = {{ name = \"noise\", space = \"plane\" }}\n\
             body = [\n\
               {{ name = \"wheel\", mass = 1.0, inertia = 1.0, angular_velocity = {rate:e} }},\n\
               {{ name = \"lever\", mass = 1.0, inertia = 1.0, position = [5.0, 0.0], angular_velocity = {noise:e} }},\n]\n\
             joint = [\n\
               {{ name = \"shaft\", type = \"revolute\", bodies = [\"ground\", \"wheel\"], at = [0.0, 0.0] }},\n\
               {{ name = \"clamp\", type = \"fixed\", bodies = [\"ground\", \"lever\"], at = [5.0, 0.0] }},\n]\n"
        )
    };
    for rate in [3.0, 3e3, 3e6] {
        let study = read(&scene(rate, 1.5e-14 * rate)).prepare(&RunOptions::default());
        let v = study.unwrap_or_else(|e| panic!("{rate}: {e}")).prepared.v;
        assert!(v[5].abs() <= 1e-16 * rate, "{v:?}");
        let error = read(&scene(rate, 1e-5 * rate))
            .prepare(&RunOptions::default())
            .err();
        let said = error.expect("it is locked").to_string();
        assert!(said.contains("of body `lever` is given as"), "{said}");
    }
}
