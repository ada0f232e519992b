//! Compares samples with closed forms: a beam, nearly parallel cranks, and coaxial hinges.

use crate::documents::{RangeDocument, ReactionRangeDocument, ToleranceDocument};
use model::{Registry, Tolerance};

use super::{ToleranceError, ToleranceOptions, ToleranceResult, ToleranceStudy, VariedText};
use crate::assembled::AssembledScene;

fn study(text: &str) -> ToleranceStudy<'static> {
    try_study(text).unwrap_or_else(|e| panic!("{e}"))
}

fn try_study(text: &str) -> Result<ToleranceStudy<'static>, ToleranceError> {
    let scene = AssembledScene::read("scene.toml", text, &Registry::standard());
    ToleranceStudy::new(scene.expect("it is read"), 0.0)
}

fn sampled(study: &ToleranceStudy<'_>, samples: usize) -> ToleranceResult {
    let options = ToleranceOptions {
        samples,
        ..ToleranceOptions::default()
    };
    let found = study.run(&options, || false, |_| ());
    found.unwrap_or_else(|e| panic!("{e}"))
}

fn reaction<'d>(d: &'d ToleranceDocument, name: &str) -> &'d ReactionRangeDocument {
    let found = d.reactions.iter().find(|r| r.name == name);
    found.unwrap_or_else(|| panic!("no `{name}`"))
}

fn range<'d>(d: &'d ToleranceDocument, name: &str, value: &str) -> &'d RangeDocument {
    let values = &reaction(d, name).values;
    let found = values.iter().find(|v| v.name == value);
    let range = found.and_then(|v| v.range.as_ref());
    range.unwrap_or_else(|| panic!("`{name}` has no {value}: {values:?}"))
}

/// The scene has a beam with a weight of 20 N on a hinge and a roller. The centre of mass is 1 m
/// from the hinge, and the roller is 2 m from the hinge. The text `of_roller` is inserted into the
/// table of the roller.
fn beam(of_scene: &str, of_roller: &str) -> String {
    format!(
        r#"
scene = {{ name = "beam", space = "plane", gravity = [0.0, -10.0]{of_scene} }}
body = [{{ name = "beam", mass = 2.0, inertia = 1.0, position = [1.0, 0.0] }}]
joint = [
    {{ name = "hinge", type = "revolute", bodies = ["ground", "beam"], at = [0.0, 0.0] }},
    {{ name = "roller", type = "pin-in-slot", bodies = ["ground", "beam"], at = [2.0, 0.0], axis = [1, 0]{of_roller} }},
]
"#
    )
}

/// Bound on the effect of rotations of the beam and of the slot. The rotations have the size of the
/// tolerance, and their effect is a few times their squares.
fn of_second_order(tolerance: f64) -> f64 {
    20.0 * 4.0 * tolerance * tolerance
}

/// Only the distance L of the roller from the hinge varies: N = 20·1/L, and L is in 2 ± τ. For 1.9
/// % of the points of a disk, x is more than 0.9 of the radius. Among 1000 points, there are such
/// points on each side.
#[test]
fn a_beam_on_a_roller_that_is_somewhere_carries_what_its_lever_says() {
    let tolerance = 2e-3;
    let found = sampled(&study(&beam("", ", tolerance = 2e-3")), 1000);
    let d = &found.document;
    assert_eq!((d.assembled, d.failures.len()), (1000, 0));
    let roller = range(d, "roller", "|F|");
    let [least, greatest] = [2.0 + tolerance, 2.0 - tolerance].map(|lever| 20.0 / lever);
    let slack = of_second_order(tolerance);
    assert_eq!(roller.described, Some(10.0));
    assert!(roller.least >= least - slack && roller.greatest <= greatest + slack);
    assert!(
        roller.least <= 10.0 - 0.9 * (10.0 - least) + slack,
        "{roller:?}"
    );
    assert!(
        roller.greatest >= 10.0 + 0.9 * (greatest - 10.0) - slack,
        "{roller:?}"
    );
    // The mean of 1/L is 1/2, and the standard deviation of x in a disk is half of its radius.
    let per_metre = 20.0 / 4.0;
    assert!((roller.mean - 10.0).abs() < 5.0 * per_metre * tolerance / 2.0 / 1000f64.sqrt());
    let deviation = roller.deviation / (per_metre * tolerance / 2.0);
    assert!((deviation - 1.0).abs() < 0.1, "{deviation}");
    // The hinge carries the load that the roller does not carry. The reaction of the hinge acts on
    // the ground.
    let hinge = range(d, "hinge", "Fy");
    assert!(
        (roller.greatest - hinge.greatest - 20.0).abs() < slack,
        "{hinge:?}"
    );
    assert!(
        reaction(d, "roller")
            .sentence
            .starts_with("within ± 2 mm `roller` carries ")
    );
}

/// Hinge points also vary: dN = −20·(h + r)/4 with h and r in ± τ each, so N is in 10 ± 10·τ.
#[test]
fn all_points_of_a_beam_together_stay_within_the_sum() {
    let found = sampled(&study(&beam(", tolerance = 1e-3", "")), 1000);
    let roller = range(&found.document, "roller", "|F|");
    let most = 10.0 * 1e-3 + of_second_order(1e-3);
    assert!((roller.least - 10.0).abs() <= most && (roller.greatest - 10.0).abs() <= most);
    assert!(roller.width() > most, "{roller:?}");
    let d = &found.document;
    assert_eq!(
        (d.ranks.len(), d.ranks[0].rank, d.ranks[0].samples),
        (1, 3, 1000)
    );
    assert!(d.misfits.is_empty() && d.undecided == 0);
}

/// Three cranks of half a metre are inclined by 0.7 rad and carry 6 kg in total. The pin of the
/// third crank is displaced by `off`.
fn three_cranks(off: f64, tolerance: f64) -> String {
    let (c, s) = (0.5 * 0.7_f64.cos(), 0.5 * 0.7_f64.sin());
    let (mut bodies, mut joints) = (String::new(), String::new());
    for k in 0..3 {
        let (n, x) = (k + 1, f64::from(k));
        let pin = if k == 2 { x + off } else { x };
        bodies += &format!(
            "{{ name = \"crank{n}\", mass = 1.0, inertia = 0.02, position = [{}, {}], angle = 0.7 }},\n",
            x + 0.5 * c,
            0.5 * s
        );
        joints += &format!(
            "{{ name = \"O{n}\", type = \"revolute\", bodies = [\"ground\", \"crank{n}\"], at = [{pin}, 0.0] }},\n\
             {{ name = \"P{n}\", type = \"revolute\", bodies = [\"crank{n}\", \"coupler\"], at = [{}, {s}] }},\n",
            x + c
        );
    }
    format!(
        "scene = {{ name = \"cranks\", space = \"plane\", gravity = [0.0, -9.81], tolerance = {tolerance:e} }}\n\
         body = [\n{bodies}{{ name = \"coupler\", mass = 3.0, inertia = 1.0, position = [{}, {s}] }},\n]\n\
         joint = [\n{joints}]\n",
        1.0 + c
    )
}

/// The coupler can only translate, across the cranks, with the force G = 2.25 kg·m·g·cos 0.7/0.5 m
/// in this direction. The third crank is not parallel to the other cranks. The force N along the
/// third crank satisfies N·sin ε = G. The weight of this crank loads its pin transversely with some
/// newtons.
fn of_third_crank(off: f64) -> f64 {
    let (c, s) = (0.5 * 0.7_f64.cos(), 0.5 * 0.7_f64.sin());
    let across = 2.25 * 9.81 * 0.7_f64.cos() / 0.5;
    let sine = off * s / (0.5 * (c - off).hypot(s));
    across / sine
}

#[test]
fn a_third_crank_beside_its_place_carries_kilonewtons_somewhere_in_a_wide_range() {
    let off = 4e-4;
    let expected = of_third_crank(off);
    assert!((6e4..7e4).contains(&expected), "{expected}");
    let sample = |tolerance: f64| {
        let found = sampled(&study(&three_cranks(off, tolerance)), 400);
        let d = found.document;
        assert_eq!(
            (d.assembled, d.described.rank, d.described.mobility),
            (400, 12, 0)
        );
        assert!(d.described.undecided_because.is_none());
        let third = reaction(&d, "P3");
        assert!(third.fragile && third.verdict == "unique" && third.verdicts.unique == 400);
        assert!(
            third.sentence.contains("`P3` carries "),
            "{}",
            third.sentence
        );
        let range = range(&d, "P3", "|F|").clone();
        let described = range.described.expect("unique");
        assert!(
            (described / expected - 1.0).abs() < 1e-3,
            "{described} {expected}"
        );
        assert!(range.least < described && described < range.greatest);
        range
    };
    // The same seed displaces the same points ten times as far. For small displacements, the range
    // is ten times as wide. Sixteen displacements of 1e-7 m are 0.6 % of the misalignment off·sin
    // 0.7. The cranks rotate by the corresponding angle to close the gap, which changes G by its
    // tangent and ε by its cotangent.
    let (fine, coarse) = (sample(1e-8), sample(1e-7));
    let ratio = coarse.width() / fine.width();
    assert!((ratio - 10.0).abs() < 0.1, "{ratio}");
    let relative = coarse.width() / expected;
    let share = 16.0 * 1e-7 / (off * 0.7_f64.sin());
    let turned = 0.7_f64.tan() + 0.7_f64.tan().recip();
    assert!(
        (0.1 * share..2.0 * share * (1.0 + turned)).contains(&relative),
        "{relative}"
    );
    // At some micrometres, the range is arbitrarily wide.
    let wide = sample(5e-6);
    assert!(wide.greatest > 1.5 * wide.least, "{wide:?}");
}

#[test]
fn near_the_change_of_the_rank_samples_that_go_elsewhere_are_counted() {
    let found = sampled(&study(&three_cranks(4e-4, 1.5e-5)), 400);
    let d = &found.document;
    assert_eq!(d.described.rank, 12);
    let failed: u64 = d.failures.iter().map(|f| f.samples).sum();
    assert!(failed > 0, "{d:?}");
    assert_eq!((d.assembled + failed, d.samples), (400, 400));
    let first = &d.failures[0];
    let own = found.samples.iter().find(|s| s.number == first.first);
    let failure = own.expect("it is there").outcome.as_ref().err();
    assert_eq!(failure.map(|f| f.reason), Some(&*first.reason));
    let counted: u64 = d.ranks.iter().map(|r| r.samples).sum();
    assert_eq!(counted + d.undecided, d.assembled);
}

#[test]
fn exact_cranks_lock_in_every_sample_and_their_misfit_has_a_bound() {
    let tolerance = 1e-4;
    let found = sampled(&study(&three_cranks(0.0, tolerance)), 1000);
    let d = &found.document;
    let described = &d.described;
    assert_eq!(
        (described.rank, described.redundancy, described.mobility),
        (11, 1, 1)
    );
    let locked = d
        .ranks
        .iter()
        .find(|r| r.rank == 12)
        .expect("locked samples");
    assert_eq!((locked.mobility, locked.redundancy), (0, 0));
    assert_eq!(locked.samples + d.undecided, 1000);
    assert!(locked.samples > 980, "{d:?}");
    // The self-stress 1 : −2 : 1 along the cranks has the violation of twelve points. There are two
    // points on each of six pins. Points on the outer cranks count once, and points on the middle
    // crank count twice. The violation is relative to the redundant row, which has a share of at
    // least one half of its pin.
    let [misfit] = &d.misfits[..] else {
        panic!("{:?}", d.misfits)
    };
    let bound = (4.0 + 8.0 + 4.0) * tolerance / 0.5;
    assert!(
        misfit.greatest <= bound && misfit.greatest >= tolerance,
        "{misfit:?}"
    );
    assert!(misfit.mean < misfit.greatest && misfit.mean > 0.1 * tolerance);
    let third = reaction(d, "P3");
    assert_eq!((third.verdict, third.fragile), ("not_unique", false));
    // A range covers all samples. If the rank of one sample is undecided, there is no range.
    assert!(d.undecided > 0);
    assert_eq!(third.values[0].reading, "none");
    assert!(third.values[0].range.is_none());
    let found = sampled(&study(&three_cranks(0.0, tolerance)), 60);
    let d = &found.document;
    assert_eq!(d.undecided, 0, "the first samples are decided");
    let third = reaction(d, "P3");
    assert_eq!(third.values[0].reading, "exact");
    assert!(
        third.sentence.contains("rigid and without play"),
        "{}",
        third.sentence
    );
    let range = third.values[0].range.as_ref().expect("a range");
    assert!(
        range.described.is_none() && range.greatest > 1e5,
        "{range:?}"
    );
    // No smaller bound is certain, because the sine of the angle can be as large as the points
    // allow.
    let sine = 16.0 * tolerance / 0.5;
    assert!(range.least > 0.5 * of_third_crank(4e-4) * 4e-4 * 0.7_f64.sin() / 0.5 / sine);
}

/// A door hangs at rest on two hinges in space.
const DOOR: &str = r#"
scene = { name = "door", space = "spatial", gravity = [0.0, 0.0, -10.0], tolerance = 1e-4, angle_tolerance = 1e-4 }
body = [{ name = "leaf", mass = 20.0, inertia = [6.0, 8.0, 2.0], position = [0.5, 0.0, 1.0] }]
joint = [
    { name = "bottom", type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 0.0, 0.2], axis = [0, 0, 1] },
    { name = "top", type = "revolute", bodies = ["ground", "leaf"], at = [0.0, 0.0, 1.8], axis = [0, 0, 1] },
]
marker = [{ name = "latch", body = "leaf", point = [0.5, 0.0, 0.0] }]
"#;

#[test]
fn two_hinges_never_share_an_axis_exactly_and_it_is_said() {
    let found = sampled(&study(DOOR), 300);
    let d = &found.document;
    assert_eq!(
        (
            d.described.rank,
            d.described.redundancy,
            d.described.mobility
        ),
        (5, 5, 1)
    );
    let [all] = &d.ranks[..] else {
        panic!("{:?}", d.ranks)
    };
    assert_eq!((all.rank, all.mobility, all.samples), (6, 0, 300));
    assert_eq!(d.misfits.len(), 5);
    // The bound contains four points of 0.1 mm along the vertical, and rotated arms.
    assert!(
        d.misfits
            .iter()
            .all(|m| m.greatest > 0.0 && m.greatest < 3e-3),
        "{:?}",
        d.misfits
    );
    let said = d.sentences().join(" ");
    for words in [
        "the rank without tolerance is 6 (redundancy 4, mobility 0) in 300 of 300 samples",
        "without play or slip one free motion is lost",
        "the redundant rows are violated: row ",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let without = d.without_range();
    assert_eq!(
        without,
        ["no range, because not unique in any sample: `bottom`, `top`"]
    );
    for name in ["bottom", "top"] {
        assert_eq!(reaction(d, name).verdicts.not_unique, 300);
    }
    let latch = &d.markers["latch"];
    assert!(latch.farthest > 5e-5 && latch.farthest < 1e-3 && latch.mean < latch.farthest);
}

#[test]
fn samples_depend_on_the_seed_and_on_nothing_else() {
    let study = study(DOOR);
    let table = |seed, threads| {
        let options = ToleranceOptions {
            samples: 40,
            seed,
            threads: std::num::NonZeroUsize::new(threads),
        };
        let found = study.run(&options, || false, |_| ());
        let found = found.unwrap_or_else(|e| panic!("{e}"));
        let rows: Vec<Vec<String>> = found.samples.iter().map(|s| study.row(s)).collect();
        (rows, found.document)
    };
    assert_eq!(table(3, 1), table(3, 2));
    assert_ne!(table(3, 1).0, table(4, 1).0);
    assert_eq!(table(3, 1).0[7], study.row(&study.sample(3, 8)));
    assert_eq!(study.columns().len(), table(3, 1).0[0].len());
}

#[test]
fn a_request_to_stop_keeps_what_is_done() {
    let study = study(DOOR);
    let made = std::sync::atomic::AtomicUsize::new(0);
    let count = std::sync::atomic::Ordering::Relaxed;
    let options = ToleranceOptions::default();
    let stop = || made.load(count) >= 20;
    let found = study.run(&options, stop, |_| {
        made.fetch_add(1, count);
    });
    let d = found.unwrap_or_else(|e| panic!("{e}")).document;
    assert!(
        d.partial && d.samples >= 20 && d.samples < 1000,
        "{}",
        d.samples
    );
    assert_eq!(d.drawn.samples, 1000);
    assert!(d.sentences().iter().any(|s| s.starts_with("interrupted: ")));
}

#[test]
fn nothing_to_vary_is_refused_by_name() {
    let refused = |text: &str| try_study(text).err().expect("refused");
    assert!(matches!(
        refused(&beam("", "")),
        ToleranceError::NoTolerance
    ));
    let stone = r#"
scene = { name = "stone", space = "plane", tolerance = 1e-3 }
body = [{ name = "stone", mass = 1.0, inertia = 1.0 }]
"#;
    assert!(matches!(refused(stone), ToleranceError::NoData));
    let study = study(&beam(", tolerance = 1e-3", ""));
    for samples in [0, super::SAMPLES_MAX + 1] {
        let options = ToleranceOptions {
            samples,
            ..ToleranceOptions::default()
        };
        let refused = study
            .run(&options, || false, |_| ())
            .err()
            .expect("refused");
        assert!(
            matches!(refused, ToleranceError::Samples { .. }),
            "{refused}"
        );
    }
}

/// A crank has a drive. The drive and the joint have the same points, so only these points and the
/// zero of the drive vary.
#[test]
fn a_drive_has_the_points_of_its_joint() {
    let text = r#"
scene = { name = "slide", space = "plane", gravity = [0.0, -10.0], tolerance = 1e-3 }
body = [{ name = "block", mass = 2.0, inertia = 1.0, position = [1.0, 0.0] }]
joint = [{ name = "guide", type = "translational", bodies = ["ground", "block"], at = [0.0, 0.0], axis = [1, 0] }]
drive = [{ name = "motor", joint = "guide", type = "displacement", motion = { type = "constant-rate", rate = 0.5 } }]
"#;
    let study = study(text);
    let mechanism = &study.nominal.mechanism;
    let (guide, motor) = (0, 1);
    let streams = |group: usize| -> Vec<(&str, u64)> {
        let own = study.nominal.data.iter().filter(|d| d.block.group == group);
        own.map(|d| (d.block.name, d.stream)).collect()
    };
    assert!(mechanism.driven(model::ConstraintId(motor)).is_some());
    let shared: Vec<_> = streams(motor)
        .into_iter()
        .filter(|own| streams(guide).contains(own))
        .collect();
    assert!(shared.iter().any(|(name, _)| *name == "axis"), "{shared:?}");
    let kept = streams(motor)
        .into_iter()
        .filter(|own| !shared.contains(own));
    assert!(kept.count() >= 1);
}

/// The reaction is half of the weight of a beam. In one scene the mass of the beam is accurate to 1
/// %, and in another scene the weight is a parameter.
#[test]
fn varied_numbers_move_reactions_by_their_interval() {
    let registry = Registry::standard();
    let varied = |text: &str, vary: &str| {
        let scene = AssembledScene::read("beam.toml", text, &registry).expect("it is read");
        let list = vec![vary.parse().expect("a variation")];
        let vary = VariedText::new(("beam.toml", text), &registry, Tolerance::default(), list)?;
        ToleranceStudy::varying(scene, 0.0, Some(vary))
    };
    let text = beam("", "");
    for vary in ["body.beam.mass=±1%", "body.beam.mass=+-0.02"] {
        let study = varied(&text, vary).unwrap_or_else(|e| panic!("{e}"));
        let found = sampled(&study, 300);
        let roller = range(&found.document, "roller", "|F|");
        assert!(roller.least >= 9.9 - 1e-12 && roller.greatest <= 10.1 + 1e-12);
        // Of 300 uniform numbers at least one is within 2 % of each end, with an error probability
        // of exp(−300·0.02/2) = 5 %.
        assert!(
            roller.least < 9.904 && roller.greatest > 10.096,
            "{roller:?}"
        );
        // The force belongs to the random mass of the sample.
        let own = found.samples[4].outcome.as_ref().expect("assembled");
        let mass = 2.0 * (1.0 + 0.01 * found.samples[4].varied[0]);
        assert!(
            (own.kept[3] - 5.0 * mass).abs() < 1e-12 || (own.kept[0] - 5.0 * mass).abs() < 1e-12
        );
        assert_eq!(found.document.drawn.varied.len(), 1);
    }
    let refused = |vary: &str| varied(&text, vary).err().expect("refused").to_string();
    let text = refused("body.beam.mass=±110%");
    assert!(text.contains("`--vary body.beam.mass=±110%`: "), "{text}");
    assert!(refused("body.rod.mass=±1%").contains("there is no `rod`"));
}
