//! Bounds for any stiffness in the presence of supports that only push.

use std::fmt::Write as _;

use pfaff::solvability::{Choice, Compliance, Elasticity, Group, Term};
use tests::numbers::Numbers;

use super::{ends, range, study};

const SEED: u64 = 30_112_026;

const PLATES: usize = 200;

/// Number of random compliances of each plate.
const SAMPLES: usize = 20;

/// A plate of 10 kg on legs at random places, with its mass centre at [x, y].
fn plate(legs: &[[f64; 2]], [x, y]: [f64; 2]) -> String {
    let mut text = format!(
        "scene = {{ name = \"plate\", space = \"spatial\", gravity = [0.0, 0.0, -10.0] }}\n\
         body = [{{ name = \"plate\", mass = 10.0, inertia = [1.0, 1.0, 2.0], position = [{x:?}, {y:?}, 0.5] }}]\n\
         joint = [\n"
    );
    for (k, [x, y]) in legs.iter().enumerate() {
        let written = writeln!(
            text,
            "{{ name = \"L{k}\", type = \"point-on-plane\", bodies = [\"ground\", \"plate\"], at = [{x:?}, {y:?}, 0.0], \
             normal = [0, 0, 1], one_sided = \"pushes\" }},"
        );
        written.expect("a text");
    }
    text + "]\n"
}

/// The force of each leg has one component, so each vertex of the permitted loads is a plate on
/// three legs: a solution in which all other legs give way. The bounds are therefore the range of
/// the permitted loads. With random compliances, legs that all press carry loads within the bounds.
#[test]
fn bounds_of_plates_on_legs_are_the_ranges_of_their_pushes() {
    let mut numbers = Numbers::new(SEED);
    let mut pressing = 0;
    for case in 0..PLATES {
        let count = 4 + case % 4;
        let mut place = || [numbers.within(-1.0, 1.0), numbers.within(-1.0, 1.0)];
        let legs: Vec<[f64; 2]> = (0..count).map(|_| place()).collect();
        // Between the legs, so that some sharing presses on all.
        let middle = [0, 1].map(|k| legs.iter().map(|leg| leg[k]).sum::<f64>() / count as f64);
        let text = plate(&legs, middle);
        let study = study(&text);
        let start = study.analyse(0.0, None).expect("small");
        let solution = start.solution().expect("decided");
        let permitted = start.permitted(solution).expect("clear").expect("legs");
        let bounds = start.bounds(solution, &Elasticity::default());
        let mut known = Vec::new();
        for k in 0..count {
            let name = format!("L{k}");
            let range = range(&start, &permitted, &[(&name, "Fz", 1.0)]);
            let [Some(lowest), Some(highest)] = ends(&range.expect("clear")) else {
                panic!("the legs carry the weight\n{text}");
            };
            let term = Term {
                reaction: start.reaction(&name).expect("a leg"),
                component: "Fz".to_owned(),
                coefficient: 1.0,
            };
            let found = bounds.group(&Group::Combination(vec![term]));
            let found = found.unwrap_or_else(|e| panic!("{e}\n{text}"))[0].1.clone();
            for (found, expected) in [(found.lowest, lowest), (found.highest, highest)] {
                assert!(
                    (found - expected).abs() < 1e-6,
                    "leg {k}: {found} is not {expected}\n{text}"
                );
            }
            known.push((found.lowest, found.highest));
        }
        for _ in 0..SAMPLES {
            let compliances = (0..count).map(|k| Compliance {
                reaction: start.reaction(&format!("L{k}")).expect("a leg"),
                along: [10_f64.powf(numbers.within(-4.0, 4.0)); 3],
                rotation: 0.0,
            });
            let choice = Choice::Compliance(compliances.collect::<Vec<_>>().into());
            let shared = start.distribution(&choice).expect("legs that give way");
            let loads: Vec<f64> = (shared.reactions.iter())
                .map(|leg| {
                    let mut own = leg.components.iter();
                    let own = own.find(|(name, _)| *name == "Fz").expect("Fz");
                    own.1.in_solution().expect("a number")
                })
                .collect();
            if loads.iter().all(|load| *load <= 0.0) {
                pressing += 1;
                for (load, (lowest, highest)) in loads.iter().zip(&known) {
                    let inside = lowest - 1e-6 <= *load && *load <= highest + 1e-6;
                    assert!(inside, "{load} is not within {lowest} … {highest}\n{text}");
                }
            }
        }
    }
    assert!(pressing > PLATES, "{pressing} samples press on all legs");
}

/// The vertical forces on a bar of 100 N that stands on three supports, with its load above the
/// first one: no support pulls, so the others carry nothing, although some stiffness would make
/// them pull.
#[test]
fn a_load_above_a_support_is_not_shared_whatever_the_stiffness() {
    let supports = [0.0, 1.0, 2.0].map(|x| {
        format!(
            "{{ name = \"S{x}\", type = \"point-on-line\", body = \"bar\", at = [{x:?}, 0.0], \
             line = [[0, 0], [1, 0]], one_sided = \"pushes\", toward = [0, 1] }},\n"
        )
    });
    let text = format!(
        "scene = {{ name = \"bar\", space = \"plane\", gravity = [0.0, -10.0] }}\n\
         body = [{{ name = \"bar\", mass = 10.0, inertia = 1.0, position = [0.0, 0.0] }}]\n\
         joint = [\n{}]\n",
        supports.concat()
    );
    let study = study(&text);
    let start = study.analyse(0.0, None).expect("small");
    let solution = start.solution().expect("decided");
    let bounds = start.bounds(solution, &Elasticity::default());
    for (name, expected) in [("S0", 100.0), ("S1", 0.0), ("S2", 0.0)] {
        let term = Term {
            reaction: start.reaction(name).expect("a support"),
            component: "Fy".to_owned(),
            coefficient: 1.0,
        };
        let found = bounds
            .group(&Group::Combination(vec![term]))
            .expect("bounds");
        let found = &found[0].1;
        for end in [found.lowest, found.highest] {
            assert!((end - expected).abs() < 1e-6, "{name}: {found:?}");
        }
    }
}
