//! Random bodies on contacts with integer coordinates: ranges, proofs, and supports that lift,
//! against vertices in rational arithmetic.
//!
//! `PFAFF_CASES=20000 cargo test -p tests contacts_of_random -- --nocapture` makes a longer run.

use model::ConstraintId;
use pfaff::configuration::ConfigurationAnalysis;
use pfaff::solvability::{
    ConditionKind, ContactCondition, Liftoff, PermittedEnd, PermittedError, PermittedRange,
    PermittedReactions, RangeKind, lifted,
};
use tests::numbers::Numbers;

use super::fractions::{Fraction, Row, dot, kernel};
use super::oracle::{Bodies, Contact, INERTIA, MASS, Permitted};
use super::{FORCE, id_of, near, range, study};
use crate::tally::cases;

const SEED: u64 = 21_112_026;

const SCENES: usize = 2000;

/// Largest share of the answers that may be refused.
const REFUSED: f64 = 1e-3;

/// Number of solutions for which the proof of an end is evaluated.
const SOLUTIONS: usize = 3;

/// Kinds of random bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// One body on feet on the ground.
    Legs,
    /// Contacts in any direction.
    Any,
    /// Ropes to any points.
    Ropes,
    /// Some contacts also pull.
    Mixed,
    /// Contacts from both sides.
    Clamped,
    /// Feet in the same places.
    EqualFeet,
    /// The load is above one contact, or above an edge.
    Edge,
    /// Two bodies with contacts between them.
    Two,
}

const KINDS: [Kind; 12] = [
    Kind::Legs,
    Kind::Any,
    Kind::Mixed,
    Kind::EqualFeet,
    Kind::Clamped,
    Kind::Edge,
    Kind::Ropes,
    Kind::Mixed,
    Kind::Edge,
    Kind::Two,
    Kind::Clamped,
    Kind::Legs,
];

/// Number of answers.
#[derive(Clone, Debug, Default)]
struct Counts {
    scenes: usize,
    points: usize,
    /// Points of numbers that are not unique without the signs.
    by_signs: usize,
    intervals: usize,
    half_lines: usize,
    lines: usize,
    empty: usize,
    /// Supports that lift.
    lifts: usize,
    /// Proofs of ends that were verified.
    proofs: usize,
    preloads: usize,
    refused: Vec<String>,
}

#[test]
#[expect(
    clippy::print_stdout,
    reason = "a longer run is read by a person, with --nocapture"
)]
fn contacts_of_random_bodies_are_those_of_vertices() {
    let each = cases(SCENES).div_ceil(2);
    let half = |in_space: bool| {
        let mut numbers = Numbers::new(SEED + u64::from(in_space));
        let mut counts = Counts::default();
        for k in 0..each {
            let kind = KINDS[k % KINDS.len()];
            let bodies = draw(kind, in_space, &mut numbers);
            examine(&bodies, in_space, &mut numbers, &mut counts);
        }
        counts
    };
    let [plane, space] = std::thread::scope(|scope| {
        [false, true]
            .map(|in_space| scope.spawn(move || half(in_space)))
            .map(|found| found.join().expect("no panic"))
    });
    for (what, c) in [("plane", plane), ("space", space)] {
        println!("{what}: {c:?}");
        let answers = c.points + c.intervals + c.half_lines + c.lines + c.empty;
        assert!(
            c.refused.len() as f64 <= REFUSED * answers as f64,
            "{:?}",
            c.refused
        );
        let fewest = each / 20;
        let kinds = [
            c.by_signs,
            c.intervals,
            c.half_lines,
            c.lines,
            c.empty,
            c.lifts,
        ];
        assert!(kinds.iter().all(|n| *n > fewest), "{c:?}");
    }
}

/// Draws bodies with loads in balance with some forces of their contacts.
fn draw(kind: Kind, in_space: bool, numbers: &mut Numbers) -> Bodies {
    let depth = if in_space { 3 } else { 0 };
    let centre = |numbers: &mut Numbers| {
        [
            numbers.between(-3, 3).into(),
            numbers.between(-3, 3).into(),
            numbers.between(-depth, depth).into(),
        ]
    };
    let count = if kind == Kind::Two { 2 } else { 1 };
    let mut bodies = Bodies {
        centres: (0..count).map(|_| centre(numbers)).collect(),
        contacts: Vec::new(),
        loads: Vec::new(),
    };
    let most = 3 + numbers.below(if kind == Kind::Two { 4 } else { 6 });
    while bodies.contacts.len() < most {
        let last = bodies.contacts.last().cloned();
        let mut contact = contact(kind, in_space, numbers);
        match (kind, last) {
            (Kind::EqualFeet, Some(last)) if numbers.once_in(2) => contact = last,
            (Kind::Clamped, Some(last)) if numbers.once_in(2) => {
                contact = last;
                contact.normal = contact.normal.map(|x| -x);
            }
            (Kind::Mixed, Some(last)) if numbers.once_in(3) => {
                contact = last;
                contact.is_one_sided = numbers.once_in(2);
            }
            (Kind::Mixed, _) => contact.is_one_sided = !numbers.once_in(2),
            _ => {}
        }
        bodies.contacts.push(contact);
    }
    let is_permitted = !numbers.once_in(4);
    let balance = |(k, contact): (usize, &Contact)| -> i128 {
        let t = numbers.between(-3, 4);
        let is_loaded = k < 2 || !matches!(kind, Kind::Edge);
        let t = if is_permitted && contact.is_one_sided {
            t.max(0)
        } else {
            t
        };
        i128::from(if is_loaded { t } else { 0 })
    };
    let multipliers: Vec<i128> = bodies.contacts.iter().enumerate().map(balance).collect();
    bodies.balance(&multipliers);
    bodies
}

fn contact(kind: Kind, in_space: bool, numbers: &mut Numbers) -> Contact {
    let whole = |numbers: &mut Numbers, n: i32| i128::from(numbers.between(-n, n));
    let mut at = [whole(numbers, 3), whole(numbers, 3), 0];
    if in_space && !matches!(kind, Kind::Legs | Kind::EqualFeet | Kind::Edge) {
        at[2] = whole(numbers, 2);
    }
    let up = if in_space { [0, 0, 1] } else { [0, 1, 0] };
    let mut normal = up;
    let is_level = matches!(kind, Kind::Legs | Kind::EqualFeet | Kind::Edge);
    // Feet that are not level slide unless other contacts keep them.
    if !is_level || numbers.once_in(8) {
        while normal == up || normal == [0; 3] {
            normal = [whole(numbers, 2), whole(numbers, 2), 0];
            if in_space {
                normal[2] = whole(numbers, 2);
            }
        }
    }
    let bodies = match (kind, numbers.below(3)) {
        (Kind::Two, 0) => [None, Some(0)],
        (Kind::Two, 1) => [None, Some(1)],
        (Kind::Two, _) => [Some(0), Some(1)],
        _ => [None, Some(0)],
    };
    Contact {
        bodies,
        at,
        normal,
        is_one_sided: true,
    }
}

/// A scene with the name of each contact, its component, and the component for a multiplier of 1.
struct Scene {
    text: String,
    components: Vec<(String, &'static str, i128)>,
}

fn scene(bodies: &Bodies, in_space: bool, numbers: &mut Numbers) -> Scene {
    let list = |x: &[i128]| {
        let all: Vec<String> = x.iter().map(|x| format!("{x}.0")).collect();
        format!("[{}]", all.join(", "))
    };
    let n = if in_space { 3 } else { 2 };
    let place = |x: [i128; 3]| list(&x[..n]);
    let (mut text, mut components) = (String::new(), Vec::new());
    let space = if in_space { "spatial" } else { "plane" };
    text += &format!("scene = {{ name = \"random\", space = \"{space}\" }}\nbody = [\n");
    for (k, centre) in bodies.centres.iter().enumerate() {
        let inertia = if in_space {
            list(&INERTIA)
        } else {
            INERTIA[2].to_string() + ".0"
        };
        text += &format!(
            "{{ name = \"b{k}\", mass = {MASS}.0, inertia = {inertia}, position = {} }},\n",
            place(*centre)
        );
    }
    text += "]\nforce = [\n";
    for (k, [force, moment]) in bodies.loads.iter().enumerate() {
        let moment = if in_space {
            list(moment)
        } else {
            format!("{}.0", moment[2])
        };
        let origin = place([0; 3]);
        text += &format!(
            "{{ name = \"f{k}\", type = \"point-force\", body = \"b{k}\", point = {origin}, force = {} }},\n\
             {{ name = \"m{k}\", type = \"torque\", body = \"b{k}\", torque = {moment} }},\n",
            place(*force)
        );
    }
    text += "]\njoint = [\n";
    for (k, contact) in bodies.contacts.iter().enumerate() {
        let name = format!("c{k}");
        let body = |body: Option<usize>| match body {
            Some(body) => format!("\"b{body}\""),
            None => "\"ground\"".to_owned(),
        };
        let [first, second] = contact.bodies.map(body);
        let at = contact.at;
        // The largest component of the normal.
        let axis = (0..3).max_by_key(|k| contact.normal[*k].abs()).unwrap_or(0);
        let component = ["Fx", "Fy", "Fz"][axis];
        // The reported reaction acts on the first body, the one that is pushed with −n·t.
        let mut on_first = -contact.normal[axis];
        let way = |along: bool| match (contact.is_one_sided, along) {
            (false, _) => String::new(),
            (true, true) => ", one_sided = \"pushes\"".to_owned(),
            (true, false) => ", one_sided = \"pulls\"".to_owned(),
        };
        let is_rope = contact.bodies[0].is_some() && !in_space || numbers.once_in(5);
        let more = if is_rope {
            // The rope pulls the second body along the normal, or a strut pushes it.
            let pulls = numbers.once_in(2);
            let sign = if pulls { 1 } else { -1 };
            let far: [i128; 3] = std::array::from_fn(|k| at[k] + sign * contact.normal[k]);
            format!(
                "type = \"distance\", bodies = [{first}, {second}], at = [{}, {}]{}",
                place(far),
                place(at),
                way(!pulls)
            )
        } else if in_space {
            let pushes = numbers.once_in(2);
            let normal = if pushes {
                contact.normal
            } else {
                contact.normal.map(|x| -x)
            };
            format!(
                "type = \"point-on-plane\", bodies = [{first}, {second}], at = {}, normal = {}{}",
                place(at),
                place(normal),
                way(pushes)
            )
        } else {
            // The body is the first one of such a joint.
            on_first = contact.normal[axis];
            let pushes = numbers.once_in(2);
            let sign = if pushes { 1 } else { -1 };
            let [x, y, _] = contact.normal.map(|x| sign * x);
            let (turn, slant) = (
                [1, -1][numbers.below(2)],
                i128::from(numbers.between(-2, 2)),
            );
            let end = [at[0] + turn * y, at[1] - turn * x, 0];
            let toward = [x + slant * y, y - slant * x, 0];
            let toward = if contact.is_one_sided {
                format!(", toward = {}", place(toward))
            } else {
                String::new()
            };
            format!(
                "type = \"point-on-line\", body = {second}, at = {}, line = [{}, {}]{toward}{}",
                place(at),
                place(at),
                place(end),
                way(pushes)
            )
        };
        text += &format!("{{ name = \"{name}\", {more} }},\n");
        components.push((name, component, on_first));
    }
    text += "]\n";
    Scene { text, components }
}

/// What is known of a scene.
struct Known<'a> {
    bodies: &'a Bodies,
    permitted: Permitted,
    text: &'a str,
    /// Multipliers of some solutions, permitted or not.
    solutions: Vec<Vec<f64>>,
    size: f64,
}

impl Known<'_> {
    /// The force with which a contact presses.
    fn pressing(&self, solution: &[f64], id: ConstraintId) -> f64 {
        solution[id.0] * self.bodies.contacts[id.0].length()
    }

    /// The weighted sum of the forces of conditions.
    fn sum(&self, weights: &[(ContactCondition, f64)], solution: &[f64]) -> f64 {
        let each = weights.iter().map(|(condition, weight)| {
            assert_eq!(condition.kind, ConditionKind::Presses);
            assert!(*weight >= 0.0 && self.bodies.contacts[condition.joint.0].is_one_sided);
            weight * self.pressing(solution, condition.joint)
        });
        each.sum()
    }
}

fn examine(bodies: &Bodies, in_space: bool, numbers: &mut Numbers, counts: &mut Counts) {
    let scene = scene(bodies, in_space, numbers);
    let text = &scene.text;
    let study = study(text);
    let start = study
        .analyse(0.0, None)
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    let solution = start.solution().unwrap_or_else(|e| panic!("{e}\n{text}"));
    counts.scenes += 1;
    let found = match start.permitted(solution) {
        Ok(Some(found)) => found,
        Ok(None) => {
            assert!(!bodies.contacts.iter().any(|c| c.is_one_sided));
            return;
        }
        Err(e) => {
            counts.refused.push(format!("{e}\n{text}"));
            return;
        }
    };
    let n = bodies.contacts.len();
    let equations = bodies.equations();
    let all = kernel(&equations.iter().collect::<Vec<_>>(), n + 1);
    let solutions = (0..SOLUTIONS).map(|_| random_solution(&all, numbers));
    let permitted = bodies.permitted();
    let mut known = Known {
        permitted,
        bodies,
        text,
        solutions: solutions.collect(),
        size: 1.0,
    };
    let of_solutions = known.solutions.iter().flatten().copied();
    known.size = 10.0 * tests::largest(of_solutions);
    let mut forms: Vec<Vec<(usize, i128)>> = (0..n).map(|k| vec![(k, 1)]).collect();
    for _ in 0..2 {
        let pair = [numbers.below(n), numbers.below(n)];
        if pair[0] != pair[1] {
            forms.push(pair.map(|k| (k, i128::from(numbers.between(1, 3)))).into());
        }
    }
    let is_empty = known.permitted.range(&vec![Fraction::ZERO; n]).is_none();
    for form in &forms {
        let terms: Vec<(&str, &str, f64)> = form
            .iter()
            .map(|&(k, c)| (&scene.components[k].0[..], scene.components[k].1, c as f64))
            .collect();
        let mut exact = vec![Fraction::ZERO; n];
        for &(k, c) in form {
            exact[k] = exact[k] + (c * scene.components[k].2).into();
        }
        match range(&start, &found, &terms) {
            Ok(range) => check(&known, (&exact, &terms), &range, &all, counts),
            Err(PermittedError::Unclear) => counts.refused.push(format!("{terms:?}\n{text}")),
            Err(e) => panic!("{e}\n{text}"),
        }
    }
    examine_opening(&known, (&start, &found), is_empty, counts);
}

/// Returns multipliers that satisfy the equations of equilibrium.
fn random_solution(all: &[Row], numbers: &mut Numbers) -> Vec<f64> {
    let n = all[0].len() - 1;
    let fixed = all.iter().find(|x| x[n].signum() != 0).expect("balanced");
    let mut solution: Row = fixed.iter().map(|x| *x * fixed[n].inverse()).collect();
    for x in all {
        // A change of the multipliers without a load.
        let factor = Fraction::from(i128::from(numbers.between(-4, 4)));
        for (i, own) in solution.iter_mut().enumerate() {
            let change = x[i] - x[n] * fixed[n].inverse() * fixed[i];
            *own = *own + change * factor;
        }
    }
    solution[..n].iter().map(|x| x.to_f64()).collect()
}

/// Compares a range with the enumerated one, and verifies its proof.
fn check(
    known: &Known<'_>,
    (form, terms): (&[Fraction], &[(&str, &str, f64)]),
    found: &PermittedRange,
    all: &[Row],
    counts: &mut Counts,
) {
    let what = || format!("{terms:?}: {found:?}\n{}", known.text);
    let Some(expected) = known.permitted.range(form) else {
        assert_eq!(
            (found.kind, &found.ends),
            (RangeKind::Empty, &None),
            "{}",
            what()
        );
        counts.empty += 1;
        return;
    };
    let n = form.len();
    let kind = match expected {
        [Some(a), Some(b)] if a == b => RangeKind::Point,
        [Some(_), Some(_)] => RangeKind::Interval,
        [None, None] => RangeKind::Line,
        _ => RangeKind::HalfLine,
    };
    assert_eq!(found.kind, kind, "{expected:?} {}", what());
    match kind {
        RangeKind::Point => {
            counts.points += 1;
            let changes = |x: &Row| {
                let fixed = all.iter().find(|x| x[n].signum() != 0).expect("balanced");
                let factor = x[n] * fixed[n].inverse();
                (dot(form, &x[..n]) - factor * dot(form, &fixed[..n])).signum() != 0
            };
            counts.by_signs += usize::from(all.iter().any(changes));
        }
        RangeKind::Interval => counts.intervals += 1,
        RangeKind::HalfLine => counts.half_lines += 1,
        RangeKind::Line => counts.lines += 1,
        RangeKind::Empty => {}
    }
    let of =
        |solution: &[f64]| -> f64 { form.iter().zip(solution).map(|(a, t)| a.to_f64() * t).sum() };
    let ends = found.ends.as_ref().expect("not empty");
    for ((end, expected), sign) in ends.iter().zip(expected).zip([1.0, -1.0]) {
        match (end, expected) {
            (
                PermittedEnd::Reached {
                    value,
                    weights,
                    pressing,
                },
                Some(expected),
            ) => {
                assert!(
                    near(*value, expected.to_f64(), known.size),
                    "{expected:?} {}",
                    what()
                );
                for solution in &known.solutions {
                    let distance = sign * (of(solution) - value);
                    let sum = known.sum(weights, solution);
                    assert!(
                        near(sum, distance, known.size),
                        "{sum} {distance} {}",
                        what()
                    );
                }
                let pushed = pressing.iter().map(|(_, force)| *force);
                assert!(
                    pushed.clone().all(|n| n >= -FORCE * known.size),
                    "{}",
                    what()
                );
                reaches(known, pressing, &what);
                counts.proofs += 1;
            }
            (PermittedEnd::Unlimited { preload }, None) => {
                if preload.is_empty() {
                    // Two-sided contacts that no condition limits.
                    assert_eq!(kind, RangeKind::Line, "{}", what());
                    continue;
                }
                let changes = changes(known, preload);
                assert!(near(-sign, of(&changes), 1.0), "{}", what());
                let most = tests::largest(changes.iter().copied()).max(1.0);
                let equations = known.bodies.equations();
                for equation in &equations {
                    let sum: f64 = equation
                        .iter()
                        .zip(&changes)
                        .map(|(a, t)| a.to_f64() * t)
                        .sum();
                    assert!(near(sum, 0.0, 10.0 * most), "{sum} {}", what());
                }
                for (contact, t) in known.bodies.contacts.iter().zip(&changes) {
                    assert!(!contact.is_one_sided || *t >= -FORCE * most, "{}", what());
                }
                counts.preloads += 1;
            }
            (found, expected) => panic!("{found:?} {expected:?} {}", what()),
        }
    }
}

/// Returns the multipliers of a preload, whose components must be parallel to the normals.
fn changes(known: &Known<'_>, preload: &[(ConstraintId, &'static str, f64)]) -> Vec<f64> {
    let contacts = known.bodies.contacts.iter().enumerate();
    let of = |(k, contact): (usize, &Contact)| {
        let component = |name: &str| {
            let mut own = preload
                .iter()
                .filter(|(id, own, _)| id.0 == k && *own == name);
            own.next().map_or(0.0, |(.., x)| *x)
        };
        let force = ["Fx", "Fy", "Fz"].map(component);
        let normal = contact.normal.map(|x| x as f64);
        let along: f64 = force.iter().zip(normal).map(|(a, b)| a * b).sum();
        let along = along / contact.length().powi(2);
        for (force, n) in force.iter().zip(normal) {
            assert!(
                near(*force, along * n, 1.0 + along.abs()),
                "{preload:?}\n{}",
                known.text
            );
        }
        // The reported reaction acts on the first body: the pushed one only for `body`.
        let is_pushed = known
            .text
            .contains(&format!("\"c{k}\", type = \"point-on-line\""));
        if is_pushed { along } else { -along }
    };
    contacts.map(of).collect()
}

/// Asserts that forces of the two-sided contacts complete these forces to a balance with the loads.
fn reaches(known: &Known<'_>, pressing: &[(ConstraintId, f64)], what: &dyn Fn() -> String) {
    let contacts = &known.bodies.contacts;
    let sided = contacts.iter().filter(|c| c.is_one_sided).count();
    if pressing.len() < sided {
        // Some contacts do not depend on this number.
        return;
    }
    let wrenches: Vec<Row> = contacts.iter().map(|c| known.bodies.wrench(c)).collect();
    let load = known.bodies.load();
    let two_sided = wrenches
        .iter()
        .zip(contacts)
        .filter(|(_, c)| !c.is_one_sided);
    let two_sided: Vec<&Row> = two_sided.map(|(w, _)| w).collect();
    // Motions that the two-sided contacts permit.
    for motion in kernel(&two_sided, load.len()) {
        let mut work = dot(&motion, &load).to_f64();
        let mut most = 1.0;
        for (id, force) in pressing {
            let rate = dot(&motion, &wrenches[id.0]).to_f64() / contacts[id.0].length();
            work += force * rate;
            most = rate.abs().max(most);
        }
        assert!(
            near(work, 0.0, 10.0 * most * known.size),
            "{work} {}",
            what()
        );
    }
}

/// Compares the contacts that open, and verifies the proof that some must.
fn examine_opening(
    known: &Known<'_>,
    (start, found): (&ConfigurationAnalysis<'_>, &PermittedReactions<'_, '_>),
    is_empty: bool,
    counts: &mut Counts,
) {
    let text = known.text;
    let impossible = match found.impossible() {
        Ok(impossible) => impossible,
        Err(e) => {
            counts.refused.push(format!("{e}\n{text}"));
            return;
        }
    };
    assert_eq!(!impossible.is_empty(), is_empty, "{text}");
    for proof in &impossible {
        assert!(proof.is_opening() && proof.sum < 0.0);
        for solution in &known.solutions {
            let sum = known.sum(&proof.weights, solution);
            assert!(near(sum, proof.sum, known.size), "{sum} {proof:?}\n{text}");
        }
    }
    let Liftoff {
        joints: opened,
        accelerations,
    } = match lifted(start.mechanism, (0.0, &start.state.q, &start.state.v)) {
        Ok(found) => found,
        Err(PermittedError::Unclear) => {
            counts.refused.push(format!("lifted\n{text}"));
            return;
        }
        Err(e) => panic!("{e}\n{text}"),
    };
    let expected = known
        .bodies
        .accelerations()
        .expect("Gauss' principle has a solution");
    let in_plane = accelerations.len() == 3 * known.bodies.centres.len();
    let components: &[usize] = if in_plane {
        &[0, 1, 5]
    } else {
        &[0, 1, 2, 3, 4, 5]
    };
    let expected_of = |k: usize| {
        let body = k / components.len();
        expected[6 * body + components[k % components.len()]].to_f64()
    };
    for (k, found) in accelerations.iter().enumerate() {
        assert!(
            near(*found, expected_of(k), known.size),
            "{k}: {found} {expected:?}\n{text}"
        );
    }
    let contacts = known.bodies.contacts.iter().enumerate();
    let mut gaps = Vec::new();
    for (k, contact) in contacts.filter(|(_, c)| c.is_one_sided) {
        let gap = dot(&known.bodies.wrench(contact), &expected);
        if gap.signum() != 0 {
            let id = id_of(start, &format!("c{k}"));
            gaps.push((id, gap.to_f64() / contact.length()));
        }
    }
    assert_eq!(
        opened.iter().map(|(id, _)| *id).collect::<Vec<_>>(),
        gaps.iter().map(|(id, _)| *id).collect::<Vec<_>>(),
        "{opened:?} {gaps:?}\n{text}"
    );
    for ((_, found), (_, expected)) in opened.iter().zip(&gaps) {
        assert!(
            near(*found, *expected, known.size),
            "{opened:?} {gaps:?}\n{text}"
        );
    }
    assert_eq!(is_empty, !opened.is_empty(), "{text}");
    counts.lifts += opened.len();
}
