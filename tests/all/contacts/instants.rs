//! Instants at which supports open, or contacts slip, during a run.

use std::ops::ControlFlow;

use dynamics::{EventKind, MotionError, MotionFault, MotionOptions};

use super::study;

/// Accuracy of an instant (s) and of an angle (rad).
const INSTANT: f64 = 1e-9;

/// The end of a run.
struct Opened {
    /// The time of the error (s).
    time: f64,
    joints: Vec<String>,
    /// Coordinates in the last row.
    q: Vec<f64>,
    /// Number of rows.
    rows: usize,
}

/// Returns the end of a run in which joints open.
fn opened(text: &str, t_end: f64) -> Opened {
    ended(text, t_end, EventKind::Lifts)
}

/// Returns the end of a run with this event.
fn ended(text: &str, t_end: f64, kind: EventKind) -> Opened {
    let study = study(text);
    let options = MotionOptions {
        rtol: 1e-12,
        atol: 1e-13,
        ..MotionOptions::to(t_end)
    };
    let (mut last, mut rows) = ((0.0, Vec::new()), 0);
    let run = study.run(&options, |sample| {
        last = (sample.t, sample.q.to_vec());
        rows += 1;
        Ok(ControlFlow::Continue(()))
    });
    let failure = match run {
        Ok(summary) => panic!("nothing opens until {} s\n{text}", summary.t),
        Err(failure) => failure,
    };
    let (time, joints) = match (&failure.error, kind) {
        (MotionError::Fault(MotionFault::Opens { time, joints }), EventKind::Lifts)
        | (MotionError::Fault(MotionFault::Slips { time, joints }), EventKind::Slips) => {
            (time, joints)
        }
        _ => panic!("{failure}\n{text}"),
    };
    // The error, the summary, the last row and the event have one time.
    // An impulse is just after the time of its row.
    let end = failure.summary.t;
    assert!(
        end == last.0 && [end, end.next_up()].contains(time),
        "{end} {time}"
    );
    let events = failure.summary.events.iter().filter(|e| e.kind == kind);
    let times: Vec<f64> = events.map(|e| e.time).collect();
    assert_eq!(times, [*time]);
    let message = failure.to_string();
    assert!(
        joints
            .iter()
            .all(|name| message.contains(&format!("`{name}`"))),
        "{message}"
    );
    Opened {
        time: *time,
        joints: joints.clone(),
        q: last.1,
        rows,
    }
}

/// Rate of the ramp (rad/s), base and height of the block (m).
const RATE: f64 = 0.2;
const BASE: f64 = 0.3;
const HEIGHT: f64 = 0.5;

/// A block on a ramp that a drive raises with a constant rate. The ramp turns about y; the lower
/// edge of the block is at this distance from the hinge, where a stop and two guides keep it.
fn ramp(distance: f64) -> String {
    // The ramp rises towards negative x, so that a positive rate about y raises it.
    let x = |along: f64| -distance - along;
    let corner = |name: &str, along: f64, y: f64| {
        format!(
            "{{ name = \"{name}\", type = \"point-on-plane\", bodies = [\"ramp\", \"block\"], at = [{:?}, {y:?}, 0.0], \
             normal = [0, 0, 1], one_sided = \"pushes\" }},\n",
            x(along)
        )
    };
    let guide = |name: &str, along: f64, normal: &str| {
        format!(
            "{{ name = \"{name}\", type = \"point-on-plane\", bodies = [\"ramp\", \"block\"], at = [{:?}, 0.0, 0.0], \
             normal = {normal} }},\n",
            x(along)
        )
    };
    format!(
        "scene = {{ name = \"ramp\", space = \"spatial\", gravity = [0.0, 0.0, -9.81] }}\n\
         body = [\n\
         {{ name = \"ramp\", mass = 3.0, inertia = [1.0, 1.0, 1.0], position = [-1.0, 0.0, 0.0] }},\n\
         {{ name = \"block\", mass = 5.0, inertia = [0.2, 0.1, 0.3], position = [{:?}, 0.0, {:?}] }},\n]\n\
         joint = [\n\
         {{ name = \"hinge\", type = \"revolute\", bodies = [\"ground\", \"ramp\"], at = [0.0, 0.0, 0.0], axis = [0, 1, 0] }},\n\
         {}{}{}{}{}{}{}]\n\
         drive = [{{ name = \"jack\", joint = \"hinge\", type = \"angle\", motion = {{ type = \"constant-rate\", rate = {RATE:?} }} }}]\n",
        x(0.5 * BASE),
        0.5 * HEIGHT,
        corner("low left", 0.0, -0.2),
        corner("low right", 0.0, 0.2),
        corner("high left", BASE, -0.2),
        corner("high right", BASE, 0.2),
        guide("stop", 0.0, "[1, 0, 0]"),
        guide("guide low", 0.0, "[0, 1, 0]"),
        guide("guide high", BASE, "[0, 1, 0]"),
    )
}

/// The moment of the weight and of the centrifugal force m·ω²·r about the lower edge vanishes where
/// `g·(h·sin α − b·cos α) = ω²·h·x`, at the distance x of this edge from the hinge: at atan(b/h) if
/// the hinge is at the edge.
#[test]
fn a_body_leaves_its_supports_at_the_instant_of_the_closed_form() {
    for distance in [0.0, 0.4, 2.0] {
        let found = opened(&ramp(distance), 20.0);
        let diagonal = BASE.hypot(HEIGHT);
        let rises = RATE * RATE * HEIGHT * distance / 9.81;
        let angle = (BASE / HEIGHT).atan() + (rises / diagonal).asin();
        let off = found.time - angle / RATE;
        assert!(
            off.abs() <= INSTANT,
            "{distance}: {off:e} of {}",
            found.time
        );
        assert_eq!(found.joints, ["high left", "high right"]);
        assert!(found.rows > 10);
    }
}

/// The ramp of the same closed form with coarse tolerances: the instant is as accurate as the
/// motion, and a prescribed motion is exact.
#[test]
fn a_coarse_run_finds_the_instant_of_a_prescribed_motion() {
    let study = study(&ramp(0.0));
    let run = study.run(&MotionOptions::to(20.0), |_| Ok(ControlFlow::Continue(())));
    let failure = run.expect_err("the block tips");
    let off = failure.summary.t - (BASE / HEIGHT).atan() / RATE;
    assert!(off.abs() <= 1e-6, "{off:e}");
}

const LENGTH: f64 = 1.5;
const GRAVITY: f64 = 9.81;

fn pendulum(v: f64, swapped: bool) -> String {
    let (bodies, ends) = if swapped {
        (
            "\"stone\", \"ground\"",
            format!("[[0.0, -{LENGTH:?}], [0.0, 0.0]]"),
        )
    } else {
        (
            "\"ground\", \"stone\"",
            format!("[[0.0, 0.0], [0.0, -{LENGTH:?}]]"),
        )
    };
    format!(
        "scene = {{ name = \"pendulum\", space = \"plane\", gravity = [0.0, -{GRAVITY:?}] }}\n\
         body = [{{ name = \"stone\", mass = 0.7, inertia = 0.1, position = [0.0, -{LENGTH:?}], velocity = [{v:?}, 0.0], \
         angular_velocity = 0.0 }}]\n\
         joint = [{{ name = \"rope\", type = \"distance\", bodies = [{bodies}], at = {ends}, one_sided = \"pulls\" }}]\n"
    )
}

/// Time from the bottom to the angle θ: the integral of dθ/√(v²/l² − 2·g/l·(1 − cos θ)), by
/// Simpson's rule with Richardson's extrapolation.
fn time_to(angle: f64, v: f64) -> f64 {
    let slowness = |x: f64| {
        let rate = v * v / LENGTH - 2.0 * GRAVITY * (1.0 - x.cos());
        (LENGTH / rate).sqrt()
    };
    let simpson = |n: u32| {
        let h = angle / f64::from(n);
        let inner = (1..n).map(|k| [2.0, 4.0][(k % 2) as usize] * slowness(h * f64::from(k)));
        h / 3.0 * (slowness(0.0) + inner.sum::<f64>() + slowness(angle))
    };
    let (coarse, fine) = (simpson(2000), simpson(4000));
    fine + (fine - coarse) / 15.0
}

/// A stone on a rope is too fast to swing and too slow for a full circle: 2·g·l < v² < 5·g·l. The
/// rope is slack where cos θ = −(v² − 2·g·l)/(3·g·l).
#[test]
fn a_rope_is_slack_where_the_closed_form_says() {
    for (share, swapped) in [(2.3, false), (3.5, true), (4.9, false)] {
        let v = (share * GRAVITY * LENGTH).sqrt();
        let found = opened(&pendulum(v, swapped), 10.0);
        let angle = (-(share - 2.0) / 3.0).acos();
        let [x, y] = [found.q[0], found.q[1]];
        let reached = x.atan2(-y);
        assert!(
            (reached - angle).abs() <= INSTANT,
            "{share}: {reached} {angle}"
        );
        let time = time_to(angle, v);
        assert!(
            (found.time - time).abs() <= INSTANT,
            "{share}: {} {time}",
            found.time
        );
        assert_eq!(found.joints, ["rope"]);
    }
}

/// A pendulum that swings (v² < 2·g·l) or makes full circles (v² > 5·g·l) keeps its rope tight.
#[test]
fn a_rope_stays_tight_below_and_above_the_range() {
    for share in [1.99, 5.01] {
        let v: f64 = share * GRAVITY * LENGTH;
        let study = study(&pendulum(v.sqrt(), false));
        let run = study.run(&MotionOptions::to(5.0), |_| Ok(ControlFlow::Continue(())));
        assert!(run.is_ok_and(|summary| summary.t == 5.0 && summary.events.is_empty()));
    }
}

/// A force that grows from time 0 lifts a stone at the time at which it is the weight; the stone
/// lifts at time 0 if the force is already larger. A force that swings lifts it for a short time.
#[test]
fn a_stone_lifts_when_a_force_carries_it() {
    let grows = "{ type = \"polynomial\", coefficients = [0.0, 20.0] }";
    let found = opened(&stone(grows), 2.0);
    let time = 2.0 * 9.81 / 20.0;
    assert!((found.time - time).abs() <= INSTANT, "{}", found.time);
    assert_eq!(opened(&stone("19.63"), 2.0).time, 0.0);
    // The stone does not move, so the steps of the integration are long.
    let (amplitude, omega) = (25.0_f64, 7.0);
    let swings = format!(
        "{{ type = \"harmonic\", amplitude = {amplitude:?}, omega = {omega:?}, phase = 0.0, offset = 0.0 }}"
    );
    let found = opened(&stone(&swings), 10.0);
    let time = (2.0 * 9.81 / amplitude).asin() / omega;
    assert!(
        (found.time - time).abs() <= INSTANT,
        "{} {time}",
        found.time
    );
}

fn stone(force: &str) -> String {
    format!(
        "scene = {{ name = \"stone\", space = \"plane\", gravity = [0.0, -9.81] }}\n\
         body = [{{ name = \"stone\", mass = 2.0, inertia = 0.1 }}]\n\
         joint = [{{ name = \"floor\", type = \"point-on-line\", body = \"stone\", at = [0.0, 0.0], line = [[0.0, 0.0], [1.0, 0.0]], \
         one_sided = \"pushes\", toward = [0.3, 1.0] }}]\n\
         force = [{{ name = \"lift\", type = \"point-force\", body = \"stone\", at = [0.0, 0.0], force = [0.0, {force}] }}]\n"
    )
}

/// A platform with a stone that a drive stops moving up, or pulls down, at once: the impulse
/// presses on the stone, or would have to pull it.
#[test]
fn an_impulse_does_not_pull_on_a_stone() {
    let platform = |values: &str| {
        format!(
            "scene = {{ name = \"platform\", space = \"spatial\", gravity = [0.0, 0.0, -9.81] }}\n\
             body = [\n\
             {{ name = \"platform\", mass = 5.0, inertia = [1.0, 1.0, 1.0] }},\n\
             {{ name = \"stone\", mass = 2.0, inertia = [0.1, 0.1, 0.1], position = [0.0, 0.0, 0.2] }},\n]\n\
             joint = [\n\
             {{ name = \"guide\", type = \"translational\", bodies = [\"ground\", \"platform\"], at = [0, 0, 0], axis = [0, 0, 1] }},\n\
             {{ name = \"rest\", type = \"point-on-plane\", bodies = [\"platform\", \"stone\"], at = [0.0, 0.0, 0.1], normal = [0, 0, 1], one_sided = \"pushes\" }},\n]\n\
             drive = [{{ name = \"jack\", joint = \"guide\", type = \"displacement\", motion = {{ type = \"linear-table\", \
             times = [0.0, 0.5, 1.0], values = {values} }} }}]\n"
        )
    };
    for values in ["[0.0, 0.0, -0.5]", "[0.0, 0.5, 0.5]"] {
        let found = opened(&platform(values), 1.0);
        assert!((found.time - 0.5).abs() <= INSTANT, "{}", found.time);
        assert_eq!(found.joints, ["rest"]);
    }
    for values in ["[0.0, 0.0, 0.5]", "[0.0, -0.5, -0.5]"] {
        let study = study(&platform(values));
        let run = study.run(&MotionOptions::to(1.0), |_| Ok(ControlFlow::Continue(())));
        assert!(run.is_ok_and(|summary| summary.t == 1.0), "{values}");
    }
}

/// A sled of 19.62 N on two shoes that a horizontal force pulls at the height of the floor. Each
/// shoe presses with 9.81 N.
fn sled(force: &str, [front, rear]: [f64; 2]) -> String {
    let foot = |name: &str, x: f64, grip: f64| {
        format!(
            "{{ name = \"{name}\", type = \"point-on-line\", body = \"sled\", at = [{x:?}, 0.0], line = [[0.0, 0.0], [1.0, 0.0]], \
             one_sided = \"pushes\", toward = [0.0, 1.0] }},\n\
             {{ name = \"{name} shoe\", type = \"knife-edge\", body = \"sled\", at = [{x:?}, 0.0], normal = [1.0, 0.0], \
             grip = {grip:?}, load = \"{name}\" }},\n"
        )
    };
    format!(
        "scene = {{ name = \"sled\", space = \"plane\", gravity = [0.0, -9.81] }}\n\
         body = [{{ name = \"sled\", mass = 2.0, inertia = 0.1, position = [0.0, 0.5] }}]\n\
         joint = [\n{}{}]\n\
         force = [{{ name = \"rope\", type = \"point-force\", body = \"sled\", at = [0.0, 0.0], force = [{force}, 0.0] }}]\n",
        foot("front", 0.4, front),
        foot("rear", -0.4, rear)
    )
}

/// The shoes share the force in any ratio. They slip for every sharing when the force is the sum of
/// their frictions. A force that swings exceeds it for a short time within a long step.
#[test]
fn shoes_slip_when_the_force_is_the_sum_of_their_frictions() {
    let frictions = [0.2, 0.4];
    let most = 9.81 * (frictions[0] + frictions[1]);
    let grows = "{ type = \"polynomial\", coefficients = [0.0, 20.0] }";
    let found = ended(&sled(grows, frictions), 2.0, EventKind::Slips);
    let time = most / 20.0;
    assert!((found.time - time).abs() <= INSTANT, "{}", found.time);
    assert_eq!(found.joints, ["front shoe", "rear shoe"]);
    let constant = |force: f64| sled(&format!("{force:?}"), frictions);
    assert_eq!(
        ended(&constant(1.001 * most), 2.0, EventKind::Slips).time,
        0.0
    );
    let swings = |amplitude: f64| {
        sled(
            &format!(
                "{{ type = \"harmonic\", amplitude = {amplitude:?}, omega = 7.0, phase = 0.0, offset = 0.0 }}"
            ),
            frictions,
        )
    };
    let found = ended(&swings(1.2 * most), 10.0, EventKind::Slips);
    let time = (1.0_f64 / 1.2).asin() / 7.0;
    assert!(
        (found.time - time).abs() <= INSTANT,
        "{} {time}",
        found.time
    );
    for holds in [constant(0.999 * most), swings(0.999 * most)] {
        let study = study(&holds);
        let run = study.run(&MotionOptions::to(2.0), |_| Ok(ControlFlow::Continue(())));
        assert!(run.is_ok_and(|summary| summary.t == 2.0 && summary.events.is_empty()));
    }
}

/// Two knife edges, each pressed with 40 N, hold a cart along and across. The edge along the larger
/// component of the force slips when this component is 0.5·40 N.
#[test]
fn a_pressed_edge_slips_at_its_own_limit() {
    let (load, friction) = (40.0, 0.5);
    for angle in [0.0_f64, 0.3, 1.2] {
        let [x, y] = [angle.cos(), angle.sin()].map(|x| 20.0 * x);
        let rate = |x: f64| format!("{{ type = \"polynomial\", coefficients = [0.0, {x:?}] }}");
        let text = format!(
            "scene = {{ name = \"cart\", space = \"plane\" }}\n\
             body = [{{ name = \"cart\", mass = 2.0, inertia = 0.1 }}]\n\
             joint = [{{ name = \"along\", type = \"knife-edge\", body = \"cart\", at = [0.0, 0.0], normal = [1.0, 0.0], \
             grip = {friction:?}, load = {load:?} }},\n\
             {{ name = \"across\", type = \"knife-edge\", body = \"cart\", at = [0.0, 0.0], normal = [0.0, 1.0], \
             grip = {friction:?}, load = {load:?} }}]\n\
             force = [{{ name = \"push\", type = \"point-force\", body = \"cart\", at = [0.0, 0.0], force = [{}, {}] }}]\n",
            rate(x),
            rate(y)
        );
        let found = ended(&text, 5.0, EventKind::Slips);
        let time = friction * load / x.max(y);
        assert!(
            (found.time - time).abs() <= INSTANT,
            "{angle}: {}",
            found.time
        );
        assert_eq!(found.joints, [if x > y { "along" } else { "across" }]);
    }
}

/// A force at the centre of a solid ball rolls it; the floor takes 2/7 of the force. The ball slips
/// when this share is 0.3 of its weight, in any direction.
#[test]
fn a_ball_slips_in_any_direction_at_the_same_force() {
    let (mass, radius, friction) = (2.0, 0.2, 0.3);
    let time = 3.5 * friction * mass * 9.81 / 20.0;
    for angle in [0.0_f64, 0.1, 0.7, 2.0] {
        let rate = |x: f64| format!("{{ type = \"polynomial\", coefficients = [0.0, {x:?}] }}");
        let inertia = 0.4 * mass * radius * radius;
        let text = format!(
            "scene = {{ name = \"ball\", space = \"spatial\", gravity = [0, 0, -9.81] }}\n\
             body = [{{ name = \"ball\", mass = {mass:?}, inertia = [{inertia:?}, {inertia:?}, {inertia:?}], position = [0, 0, {radius:?}] }}]\n\
             joint = [{{ name = \"floor\", type = \"ball\", body = \"ball\", point = [0, 0, 0], radius = {radius:?}, \
             one_sided = \"pushes\", grip = {friction:?} }}]\n\
             force = [{{ name = \"push\", type = \"point-force\", body = \"ball\", at = [0, 0, {radius:?}], force = [{}, {}, 0] }}]\n",
            rate(20.0 * angle.cos()),
            rate(20.0 * angle.sin()),
        );
        let found = ended(&text, 2.0, EventKind::Slips);
        assert!(
            (found.time - time).abs() <= INSTANT,
            "{angle}: {} {time}",
            found.time
        );
        assert_eq!(found.joints, ["floor"]);
    }
}
