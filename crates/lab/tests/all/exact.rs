//! Tests that the results of the program for degenerate scenes equal the results of exact
//! arithmetic. `cargo run --release -p lab -- fuzz exact` tests 20 000 of them.

use lab::fuzz::exact::answer::answer;
use lab::fuzz::exact::doubles::Doubles;
use lab::fuzz::exact::drawing::{Drawing, GROUND, Tie, Vector};
use lab::fuzz::exact::examine::examine;
use lab::fuzz::exact::expected::Verdict;
use lab::fuzz::exact::families::Family;
use lab::fuzz::exact::findings::{Kind, list};
use lab::fuzz::exact::pose::{Posed, Writing};
use lab::fuzz::exact::precisions;
use lab::fuzz::exact::ratio::Ratio;
use lab::fuzz::exact::tally::{Suite, Tally};
use lab::fuzz::exact::truth::Truth;
use lab::fuzz::exact::within::Meant;
use lab::fuzz::exact::{scene, text};
use lab::fuzz::space::text::Precision;
use serde_json::{Value, json};
use suite::numbers::Numbers;

const SEED: u64 = 1;

/// Twelve scenes of each family in each variant.
const SCENES: u64 = 384;

#[test]
fn no_answer_contradicts_exact_arithmetic() {
    let tally = Tally::of(Suite::Plane, SEED, 0, SCENES, || ());
    assert!(tally.passes(), "\n{}", tally.describe());
    assert_eq!(tally.contradicting, [0; 0], "\n{}", tally.describe());
}

/// A program that reports all scenes as redundant, or all as not redundant, would be wrong in every
/// family.
#[test]
fn every_family_has_members_of_full_rank_and_others() {
    for (place, family) in Family::ALL.into_iter().enumerate() {
        let redundancies: Vec<usize> = (0..40)
            .map(|k| 4 * (Family::ALL.len() as u64 * k + place as u64))
            .map(|number| Truth::of(&scene(SEED, number).posed).redundancy())
            .collect();
        let full = redundancies.iter().filter(|p| **p == 0).count();
        assert!((1..=38).contains(&full), "{family:?}: {full} of 40");
    }
}

/// Returns a point whose coordinates are given in tenths.
fn at(x: i128, y: i128) -> Vector {
    [x, y].map(|x| Ratio::new(x, 10))
}

/// Compares the reference with closed forms: trains of gears, planets and parallel cranks.
#[test]
fn exact_arithmetic_finds_what_theory_tells() {
    let mut answer = 0;
    for number in 0..1000 {
        let scene = scene(SEED, number);
        if let Some(redundancy) = scene.posed.redundancy {
            assert_eq!(Truth::of(&scene.posed).redundancy(), redundancy, "{number}");
            answer += 1;
        }
    }
    assert!(answer > 80, "{answer}");
}

/// Asserts for all variants that the result of exact arithmetic equals the result found by hand,
/// and that the program returns the same result.
fn assert_answer(drawing: &Drawing, rank: usize, not_unique: &[&str]) {
    for seed in 0..8 * Writing::ALL.len() as u64 {
        let writing = Writing::ALL[seed as usize % Writing::ALL.len()];
        let posed = Posed::new(drawing, writing, &mut Numbers::new(seed));
        let (truth, right) = posed.right();
        assert_eq!(right.rank, rank, "{writing:?}");
        for reaction in &right.reactions {
            let name = reaction.name.as_str();
            let is_unique = Verdict::from(!not_unique.contains(&name));
            assert_eq!(reaction.is_unique, is_unique, "{name}, {writing:?}");
        }
        let text = text::text(&posed);
        let document = answer(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let mut findings = examine(&truth, &right, &document).0;
        // Far from the origin double precision may not be accurate enough for a decision.
        findings.retain(|f| writing != Writing::Far || f.kind.is_wrong());
        assert!(findings.is_empty(), "{writing:?}: {findings:#?}\n{text}");
    }
}

/// Three distances between three points on a line, and an oblique bar. The distances have one
/// redundant constraint, and the reaction of the oblique bar is unique.
#[test]
fn three_bars_on_a_line_and_an_oblique_one() {
    let mut drawing = Drawing::new();
    let nodes = [at(0, 30), at(0, 70), at(0, 40)];
    let [a, b, c] = nodes.map(|node| drawing.body_at(node));
    for (pair, [i, j]) in [([a, b], [0, 1]), ([b, c], [1, 2]), ([c, a], [2, 0])] {
        let (from, at) = (nodes[i], nodes[j]);
        drawing.link(&pair, Tie::Distance { from, at });
    }
    let (from, at) = (nodes[0], at(-40, 40));
    drawing.link(&[a, GROUND], Tie::Distance { from, at });
    assert_answer(&drawing, 3, &["j0", "j1", "j2"]);
}

/// The normals meet in the origin of the body, so the body can rotate about this point.
#[test]
fn three_edges_whose_normals_meet() {
    for centre in [at(0, 0), at(10, 0), at(3, -11)] {
        let mut drawing = Drawing::new();
        let body = drawing.body_at(centre);
        for (p, along) in [
            (at(3, 1), at(9, 3)),
            (at(0, 7), at(0, 10)),
            (at(7, 7), at(1, 1)),
        ] {
            let at = [centre[0] + p[0], centre[1] + p[1]];
            drawing.link(&[body], Tie::KnifeEdge { at, along });
        }
        assert_answer(&drawing, 2, &["j0", "j1", "j2"]);
    }
}

/// Three edges at 120° with radial normals, each with a rotating wheel. The rank for the three
/// normals is 2, and the rows of the wheels do not add redundancy.
#[test]
fn three_wheels_at_120_degrees() {
    for centre in [at(0, 0), at(10, 0)] {
        let mut drawing = Drawing::new();
        drawing.stretch = 3;
        let body = drawing.body_at(centre);
        for spoke in [at(10, 0), at(-5, 5), at(-5, -5)] {
            let at = [centre[0] + spoke[0], centre[1] + spoke[1]];
            let along = spoke;
            drawing.link(&[body], Tie::KnifeEdge { at, along });
            let wheel = drawing.body_at(at);
            let (along, radius) = (drawing.across(spoke), Ratio::new(1, 10));
            drawing.link(&[body, wheel], Tie::Rolling { at, along, radius });
        }
        assert_answer(&drawing, 5, &["j0", "j2", "j4"]);
    }
}

/// A wheel is in a bearing at its centre. The position of the bearing has an error of one unit in
/// the last place. The wheel rotates freely, independently of all other constraints.
#[test]
fn a_wheel_pinned_at_its_centre() {
    let mut drawing = Drawing::new();
    let (body, wheel) = (drawing.body_at(at(0, 0)), drawing.body_at(at(3, 0)));
    drawing.link(&[body, wheel], Tie::Revolute { at: at(3, 0) });
    for y in [-5, 5] {
        let (at, along) = (at(0, y), at(0, 10));
        drawing.link(&[body], Tie::KnifeEdge { at, along });
    }
    for is_careless in [false, true] {
        drawing.is_careless = is_careless;
        assert_answer(&drawing, 3, &["j1", "j2"]);
    }
}

/// With the ratios 1/3 and 3, both meshes give the same condition.
#[test]
fn two_meshes_of_the_same_wheels() {
    for (closing, rank) in [(Ratio::whole(3), 1), (Ratio::new(301, 100), 2)] {
        let mut drawing = Drawing::new();
        let wheels = [drawing.body(), drawing.body()];
        let ratio = Ratio::new(1, 3);
        drawing.link(&[wheels[0], wheels[1], GROUND], Tie::Gear { ratio });
        let ratio = closing;
        drawing.link(&[wheels[1], wheels[0], GROUND], Tie::Gear { ratio });
        let not_unique: &[&str] = if rank == 1 { &["j0", "j1"] } else { &[] };
        assert_answer(&drawing, rank, not_unique);
    }
}

/// The comparison finds errors in a correct document that was changed.
#[test]
fn a_changed_document_is_found_out() {
    // Two bars are along one line between the same bodies, and a third one has a unique reaction.
    let mut drawing = Drawing::new();
    let (a, b) = (drawing.body(), drawing.body());
    let (from, end) = (at(2, 3), at(14, 8));
    drawing.link(&[a, b], Tie::Distance { from, at: end });
    drawing.link(
        &[a, b],
        Tie::Distance {
            from,
            at: at(26, 13),
        },
    );
    let (from, at) = (at(1, 1), at(0, 9));
    drawing.link(&[a, GROUND], Tie::Distance { from, at });
    let posed = Posed::new(&drawing, Writing::AsDrawn, &mut Numbers::new(SEED));
    let (truth, right) = posed.right();
    let document = answer(&text::text(&posed)).expect("it is a scene");
    let kinds = |document: &Value| {
        let findings = examine(&truth, &right, document).0;
        findings.into_iter().map(|f| f.kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&document), []);
    let changes = [
        ("/rank", json!(3), Kind::Rank),
        ("/mobility", json!(3), Kind::Rank),
        ("/kept_rows", json!([1, 2]), Kind::Rank),
        ("/rank_holonomic", json!(3), Kind::Rank),
        ("/reactions/0/verdict", json!("unique"), Kind::Verdict),
        ("/reactions/2/verdict", json!("not_unique"), Kind::Verdict),
        ("/reactions/0/multipliers", json!("unique"), Kind::Verdict),
        (
            "/reactions/0/row_verdicts/0/verdict",
            json!("unique"),
            Kind::Verdict,
        ),
        (
            "/reactions/0/components/1/verdict",
            json!("unique"),
            Kind::Verdict,
        ),
        (
            "/reactions/0/unique_directions",
            json!([[0.0, 1.0]]),
            Kind::Verdict,
        ),
        ("/dependencies/0/rows", json!([1, 2, 3]), Kind::Sentence),
        (
            "/dependencies/0/coefficients",
            json!([1.0, 1.0]),
            Kind::Sentence,
        ),
        (
            "/dependencies/0/coefficients",
            json!([1.0, -1.0 + 1e-8]),
            Kind::Sentence,
        ),
        ("/dependencies", json!([]), Kind::Sentence),
        (
            "/reactions/1/free_directions/0/force",
            json!([1.0, 0.5]),
            Kind::Load,
        ),
        (
            "/reactions/0/free_directions/0/torque",
            json!(1e-6),
            Kind::Load,
        ),
        ("/mixing/0/rows", json!([1, 2, 3]), Kind::Sentence),
        ("/mixing", json!([]), Kind::Sentence),
        ("/reactions/0/settled", json!("bridge"), Kind::Sentence),
        ("/eliminations/count", json!(3), Kind::Sentence),
        ("/make_unique/0/ways/0/rows", json!([3]), Kind::Sentence),
        ("/make_unique/0/ways", json!([]), Kind::Sentence),
        ("/evidence/status", json!("undecided"), Kind::Undecided),
    ];
    for (pointer, value, kind) in changes {
        let mut changed = document.clone();
        let place = changed.pointer_mut(pointer);
        *place.unwrap_or_else(|| panic!("{pointer} of {document:#}")) = value.clone();
        assert!(kinds(&changed).contains(&kind), "{pointer} = {value}");
    }
    let sentences = [
        ("/dependencies/0/text", "`j1`", "`j2`"),
        ("/dependencies/0/text", "` = 0.9231 N", "` = 0.9331 N"),
        ("/dependencies/0/text", "j0.Fx + j1.Fx", "j0.Fx - j1.Fx"),
        ("/mixing/0/text", "`j1`", "`j2`"),
        ("/reactions/0/explanation", "`j1`", "`j2`"),
        ("/reactions/0/explanation", "0.9231·Fy is", "0.5·Fy is"),
    ];
    for (pointer, words, other) in sentences {
        let mut changed = document.clone();
        let place = changed.pointer_mut(pointer);
        let place = place.unwrap_or_else(|| panic!("{pointer} of {document:#}"));
        let text = place.as_str().unwrap_or_default().to_owned();
        *place = json!(text.replace(words, other));
        assert!(
            kinds(&changed).contains(&Kind::Sentence),
            "{words} in {text}"
        );
    }
}

/// Number of drawings for each of the sets with a tolerance.
const DRAWINGS: u64 = 40;

/// Returns the results for all scenes of some drawings.
fn of_drawings(suite: Suite, from: u64, drawings: u64) -> Tally {
    let ways = suite.ways() as u64;
    Tally::of(suite, SEED, ways * from, ways * drawings, || ())
}

/// For degenerate drawings with 3 … 16 digits, no result contradicts exact arithmetic. With the
/// largest number of digits and without a tolerance, all results are decided.
#[test]
fn with_few_digits_no_answer_is_wrong() {
    let tally = of_drawings(Suite::RoundedInPlane, 0, DRAWINGS);
    assert_eq!(tally.wrong(), 0, "\n{}", tally.describe());
    let all = tally.sum(|_, way| way == precisions::DIGITS.len() - 1);
    assert_eq!(
        (all.right, all.not.len()),
        (40, 0),
        "\n{}",
        tally.describe()
    );
}

/// Drawings with a scene whose result was wrong in the past. The causes were: contradicting rows
/// that share their residual, initial and refined poses that differ from the intended
/// configuration, singular vectors that consist of rounding errors, and coefficients of a tenth
/// that counted as zero.
#[test]
fn answers_that_were_wrong_once_are_right() {
    for drawn in [7, 62, 71, 127, 182, 231, 237, 278, 317] {
        let tally = of_drawings(Suite::RoundedInPlane, drawn, 1);
        assert_eq!(tally.wrong(), 0, "{drawn}\n{}", tally.describe());
    }
}

/// If the tolerance is below a third of the distance from a lower rank, drawings of full rank are
/// reported with full rank.
#[test]
fn no_tolerance_below_a_third_makes_a_row_redundant() {
    let tally = of_drawings(Suite::FullRank, 0, DRAWINGS);
    assert!(tally.passes(), "\n{}", tally.describe());
}

/// Compares the reference for τ* with a closed form: the error δ of a pin can be distributed to
/// eight points, each of which must move by an eighth of δ.
#[test]
fn a_third_crank_is_redundant_from_an_eighth_of_its_misfit_on() {
    for (off, right) in [
        (Ratio::new(1, 100_000), 1.25e-6),
        (Ratio::new(1, 2_500), 5e-5),
    ] {
        let mut drawing = Drawing::new();
        let coupler = drawing.body_at(at(10, 0));
        let arm = at(4, 3);
        for k in 0..3 {
            let crank = drawing.body();
            let [x, y] = at(10 * k, 0);
            let pin = match k {
                2 => [x + off, y],
                _ => [x, y],
            };
            let tip = [x + arm[0], y + arm[1]];
            drawing.link(&[GROUND, crank], Tie::Revolute { at: pin });
            drawing.link(&[crank, coupler], Tie::Revolute { at: tip });
        }
        let posed = Posed::new(&drawing, Writing::AsDrawn, &mut Numbers::new(SEED));
        let truth = Truth::of(&posed);
        assert_eq!(truth.rank(), 12);
        let found = Doubles::of(&posed).lower_rank_from(12);
        assert!(
            found.low <= 1.02 * right && found.high >= 0.98 * right,
            "{found:?}, {right}"
        );
        // The bounds differ because of the second-order terms, and because the iteration ends
        // before convergence.
        assert!(found.high < 1.25 * found.low, "{found:?}");
    }
}

/// The comparison within a tolerance also finds errors in a changed document: a rank that is too
/// large or too small, or a reaction of zero.
#[test]
fn a_changed_document_is_found_out_within_a_tolerance() {
    let mut drawing = Drawing::new();
    let body = drawing.body_at(at(0, 0));
    for x in [-20, 10, 30] {
        drawing.link(&[GROUND, body], Tie::Revolute { at: at(x, 0) });
    }
    drawing.links[2].tie = Tie::PinInSlot {
        from: at(-20, 0),
        at: at(-20, 0),
        along: at(10, 0),
    };
    drawing.links[1].tie = Tie::PinInSlot {
        from: at(10, 0),
        at: at(10, 0),
        along: at(0, 10),
    };
    let posed = Posed::new(&drawing, Writing::AsDrawn, &mut Numbers::new(SEED));
    let meant = Meant::of(&posed, SEED, [1.0, -10.0]);
    assert_eq!((meant.right.rank, meant.right.redundancy), (3, 1));
    assert!(meant.is_permanent);
    let tolerance = 1e-4;
    let precision = Precision {
        digits: Some(6),
        tolerance: Some(tolerance),
        gravity: [1.0, -10.0, 0.0],
    };
    let document = answer(&text::text_within(&posed, &precision)).expect("it is a scene");
    let kinds = |document: &Value| {
        let findings = meant.judge(document, tolerance).findings.0;
        findings.into_iter().map(|f| f.kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&document), []);
    let unique = list(&document["reactions"])
        .iter()
        .position(|r| r["verdict"] == "unique");
    let unique = unique.expect("one is unique");
    for (pointer, value, kind) in [
        ("/rank".to_owned(), json!(2), Kind::Rank),
        ("/rank".to_owned(), json!(4), Kind::Rank),
        (
            format!("/reactions/{unique}/verdict"),
            json!("not_unique"),
            Kind::Verdict,
        ),
        (
            format!("/choices/0/reactions/{unique}/components/0/value"),
            json!(1e3),
            Kind::Load,
        ),
        (
            "/dependencies/0/rows".to_owned(),
            json!([1, 2, 3]),
            Kind::Sentence,
        ),
        (
            "/evidence/status".to_owned(),
            json!("undecided"),
            Kind::Undecided,
        ),
    ] {
        let mut changed = document.clone();
        let place = changed.pointer_mut(&pointer);
        *place.unwrap_or_else(|| panic!("{pointer} of {document:#}")) = value.clone();
        assert!(kinds(&changed).contains(&kind), "{pointer} = {value}");
    }
}
