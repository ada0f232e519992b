//! Mechanisms near a lower rank, and the change of data that lowers the rank. The expected numbers
//! come from another solution of the same cone program (linear programming over coordinates,
//! configurations by finite differences). If a test states this, they come from manual calculation.

use joints::{Distance, Line, PointOnLine, Revolute};
use model::{Body, BodyRef, Description, Function, Mechanism};

use rank::RankStatus;

use crate::{Analysis, analyse};

fn bar(name: &str, [x, y]: [f64; 2], angle: f64) -> Body {
    Body {
        position: [x, y],
        angle,
        ..Body::new(name, 1.0, 1.0)
    }
}

/// Three parallel cranks of half a metre on one coupler. The ground pin of the third crank is
/// displaced by `off` along the base, and the hole of this crank is at the pin.
fn three_cranks(off: f64) -> Description {
    let angle = 0.7_f64;
    let (c, s) = (0.5 * angle.cos(), 0.5 * angle.sin());
    let mut d = Description::new("three-cranks");
    let mut cranks = Vec::new();
    for x in [0.0, 1.0, 2.0] {
        cranks.push(d.body(bar(&format!("crank {x}"), [x + 0.5 * c, 0.5 * s], angle)));
    }
    let coupler = d.body(bar("coupler", [1.0 + c, s], 0.0));
    for (crank, x) in cranks.into_iter().zip([0.0, 1.0, 2.0]) {
        let pin = if x == 2.0 { x + off } else { x };
        let ground = Revolute {
            s_i: [pin, 0.0],
            s_j: [-0.25 + (pin - x) * angle.cos(), -(pin - x) * angle.sin()],
        };
        let top = Revolute {
            s_i: [0.25, 0.0],
            s_j: [x - 1.0, 0.0],
        };
        d.joint(&format!("O{x}"), &[BodyRef::Ground, crank], ground);
        d.joint(&format!("P{x}"), &[crank, coupler], top);
    }
    d
}

/// A four-bar near its dead centre. The angle between crank and coupler is only `angle`, and a bar
/// across the rocker fixes the rocker.
fn held_four_bar(angle: f64) -> Description {
    let (a, b, c, g) = (0.2_f64, 0.5, 0.4, 0.6);
    let turn = (((a + b) * (a + b) + g * g - c * c) / (2.0 * (a + b) * g)).acos() + angle;
    let tip = [a * turn.cos(), a * turn.sin()];
    let to = [g - tip[0], -tip[1]];
    let length = to[0].hypot(to[1]);
    let alpha = ((b * b + length * length - c * c) / (2.0 * b * length)).acos();
    let beta = to[1].atan2(to[0]) + alpha;
    let knee = [tip[0] + b * beta.cos(), tip[1] + b * beta.sin()];
    let mut d = Description::new("four-bar");
    let mut member = |name: &str, p: [f64; 2], q: [f64; 2]| {
        let middle = [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0];
        d.body(bar(name, middle, (q[1] - p[1]).atan2(q[0] - p[0])))
    };
    let crank = member("crank", [0.0; 2], tip);
    let coupler = member("coupler", tip, knee);
    let rocker = member("rocker", [g, 0.0], knee);
    let pin = |s_i: f64, s_j: f64| Revolute {
        s_i: [s_i, 0.0],
        s_j: [s_j, 0.0],
    };
    d.joint("A", &[BodyRef::Ground, crank], pin(0.0, -a / 2.0));
    d.joint("B", &[crank, coupler], pin(a / 2.0, -b / 2.0));
    d.joint("C", &[coupler, rocker], pin(b / 2.0, c / 2.0));
    d.joint("D", &[BodyRef::Ground, rocker], pin(g, -c / 2.0));
    let along = (knee[1]).atan2(knee[0] - g);
    let far = [knee[0] - 2.0 * along.sin(), knee[1] + 2.0 * along.cos()];
    let strut = Distance::new([c / 2.0, 0.0], far);
    d.joint("strut", &[rocker, BodyRef::Ground], strut);
    d
}

fn analysed(description: &Description) -> Analysis {
    let mut mechanism = Mechanism::build(description).expect("it builds");
    let options = model::StartOptions {
        correction: model::start::CorrectionLimit::Any,
        ..model::StartOptions::default()
    };
    let start = model::start::assemble(&mut mechanism, &options).expect("it assembles");
    analyse(&mechanism, 0.0, &start.q).expect("it is finite")
}

fn lower_rank(analysis: &Analysis) -> [Option<f64>; 2] {
    let certificate = analysis.evidence().certificate.as_ref();
    let certificate = certificate.expect("certified");
    [certificate.lower_rank_here, certificate.lower_rank_from]
}

/// The constraint violation has to vanish at all configurations. It is divided among the eight
/// points between the first and the third crank, an eighth for each point.
#[test]
fn a_pin_that_is_off_is_redundant_from_a_part_of_the_misfit_on() {
    assert_eq!(analysed(&three_cranks(0.0)).decision.rank, 11);
    for (off, here, everywhere) in [
        (1e-5, 7.92e-7, 1.25e-6),
        (4e-4, 3.22e-5, 5e-5),
        (2e-3, 1.607e-4, 2.5e-4),
    ] {
        let analysis = analysed(&three_cranks(off));
        assert_eq!(analysis.decision.rank, 12, "{off}");
        let [Some(at_this_pose), Some(from)] = lower_rank(&analysis) else {
            panic!("{off}: {:?}", lower_rank(&analysis));
        };
        assert!(
            (at_this_pose / here - 1.0).abs() < 0.06,
            "{off}: {at_this_pose}"
        );
        assert!((from / everywhere - 1.0).abs() < 0.06, "{off}: {from}");
    }
}

/// A pin with an error of one nanometre. The required change of data is still determined by the
/// constraint violation, and not by the rounding of the entries.
#[test]
fn a_misfit_above_the_rounding_of_entries_is_one_of_data() {
    let [Some(here), _] = lower_rank(&analysed(&three_cranks(1e-9))) else {
        panic!("no lower rank is near");
    };
    assert!((here / 7.92e-11 - 1.0).abs() < 0.06, "{here}");
}

/// A beam on rollers at 0, 1 and ε: `row 2 = (1 − ε)·row 0 + ε·row 1`. The effect of the rounding
/// of the data on a row is computed if the coefficient of the row is neither noise nor certainly
/// nonzero.
#[test]
fn data_are_asked_about_small_coefficients_that_are_no_noise() {
    let beam = |epsilon: f64| {
        let mut d = Description::new("beam");
        let beam = d.body(bar("beam", [0.0; 2], 0.0));
        let line = Line::new([0.0; 2], [1.0, 0.0]).expect("a line");
        for (name, x) in [("left", 0.0), ("right", 1.0), ("middle", epsilon)] {
            d.joint(name, &[beam], PointOnLine { s: [x, 0.0], line });
        }
        analysed(&d)
    };
    let noise = beam(0.0).whole().expect("one part").row_noise(1);
    assert!(noise < 1e-12, "{noise}");
    for (epsilon, is_asked) in [
        (0.0, false),
        (0.03 * noise, false),
        (0.3 * noise, true),
        (1e-4, true),
        (1e-2, false),
    ] {
        let certificate = beam(epsilon).evidence().certificate.clone();
        let asked = certificate.expect("certified").row_data;
        assert_eq!(asked.is_some(), is_asked, "{epsilon}");
    }
}

#[test]
fn a_dead_centre_is_a_pose_and_no_redundancy() {
    for (angle, here) in [(1e-4, 7.43e-6), (1e-3, 7.46e-5)] {
        let analysis = analysed(&held_four_bar(angle));
        assert_eq!(analysis.decision.rank, 9, "{angle}");
        let [Some(at_this_pose), from] = lower_rank(&analysis) else {
            panic!("{angle}: {:?}", lower_rank(&analysis));
        };
        assert!(
            (at_this_pose / here - 1.0).abs() < 0.06,
            "{angle}: {at_this_pose}"
        );
        assert!(from.is_none_or(|from| from > 0.03), "{angle}: {from:?}");
    }
}

fn within(mut description: Description, tolerance: f64) -> Description {
    description.tolerance.length = Some(tolerance);
    description
}

/// The third crank is redundant above a twentieth of a millimetre. For tolerances of a third of
/// this value and of three times this value, the result is decided.
#[test]
fn a_tolerance_decides_what_is_redundant() {
    for (tolerance, rank) in [(1.2e-5, Some(12)), (5e-5, None), (1e-3, Some(11))] {
        let analysis = analysed(&within(three_cranks(4e-4), tolerance));
        let decided = analysis.decision.is_decided();
        assert_eq!(
            decided.then_some(analysis.decision.rank),
            rank,
            "{tolerance}"
        );
    }
    let analysis = analysed(&within(three_cranks(4e-4), 1e-3));
    assert_eq!((analysis.decision.redundancy, analysis.mobility()), (1, 1));
    let certificate = analysis.evidence().certificate.clone();
    let certificate = certificate.expect("certified");
    assert_eq!(certificate.grounds, rank::Grounds::WithinTolerance);
    // Without a constraint violation, the load is divided among all bearings, as it is here.
    for reaction in &analysis.reactions {
        assert_eq!(
            reaction.wrench.verdict,
            crate::Verdict::NotUnique,
            "{}",
            reaction.name
        );
    }
}

/// Near a dead centre, a row is redundant at one configuration only. No tolerance makes the row
/// redundant.
#[test]
fn a_tolerance_drops_no_row_for_a_pose() {
    for angle in [1e-4, 1e-3] {
        let analysis = analysed(&within(held_four_bar(angle), 1e-3));
        assert!(analysis.decision.is_decided(), "{angle}");
        assert_eq!(analysis.decision.rank, 9, "{angle}");
    }
}

/// A truss with five bars that are displaced from one line by `off`, and two oblique bars. There
/// are three bars at the hinge of a body; the hole of one of these bars is displaced by the same
/// length. One of the seven rows is redundant for all positions of the points. One more row is
/// redundant if the points are collinear.
#[test]
fn rows_that_are_nearly_redundant_at_a_pose_are_left_out_together() {
    let truss = |off: f64| {
        let mut d = Description::new("truss");
        let first = d.body(bar("first", [0.0, 0.0], 0.0));
        let middle = d.body(bar("middle", [3.0, -1.0], 0.0));
        let last = d.body(bar("last", [5.4, off], 0.0));
        let end = (BodyRef::Ground, [6.0, 0.0]);
        let (left, right) = ((first, [0.0; 2]), (last, [0.0; 2]));
        let hinge = (middle, [0.0, 1.0]);
        let beside = (hinge.0, [off, 1.0 + off]);
        let struts = [
            (left, beside),
            (hinge, right),
            (hinge, end),
            (left, end),
            (right, end),
            (left, (BodyRef::Ground, [0.2, 1.0])),
            (hinge, (BodyRef::Ground, [3.6, -0.2])),
        ];
        for (k, ((i, s_i), (j, s_j))) in struts.into_iter().enumerate() {
            let strut = Distance::new(s_i, s_j);
            d.joint(&format!("bar {k}"), &[i, j], strut);
        }
        d
    };
    for off in [1e-6, 1e-5] {
        assert_eq!(analysed(&truss(off)).decision.rank, 7, "{off}");
        let analysis = analysed(&within(truss(off), 1e-3));
        assert!(analysis.decision.is_decided(), "{off}");
        assert_eq!(analysis.decision.rank, 6, "{off}");
    }
}

/// A door on three hinges. The third hinge is half a millimetre off the axis of the first two
/// hinges.
fn door(off: f64) -> Description {
    let mut d = Description::new("door");
    let leaf = d.body(Body {
        position: [0.4, 0.0],
        ..Body::new("leaf", 10.0, 1.0)
    });
    for (name, x) in [("top", 0.0), ("middle", 0.0), ("bottom", off)] {
        let hinge = Revolute {
            s_i: [x, 0.0],
            s_j: [x - 0.4, 0.0],
        };
        d.joint(name, &[BodyRef::Ground, leaf], hinge);
    }
    d
}

/// Two points half a millimetre apart coincide within a millimetre. Therefore the door turns.
#[test]
fn a_door_turns_within_its_tolerance() {
    let exact = analysed(&door(0.0));
    assert_eq!((exact.decision.rank, exact.mobility()), (2, 1));
    let locked = analysed(&door(5e-4));
    assert_eq!((locked.decision.rank, locked.mobility()), (3, 0));
    let turns = analysed(&within(door(5e-4), 1e-3));
    assert_eq!((turns.decision.rank, turns.mobility()), (2, 1));
}

/// Two parallel hydraulic cylinders rotate an arm about its hinge. The directions of the axes of
/// the cylinders are rounded to `digits` digits. The load in one cylinder may be opposite to the
/// load in the other cylinder.
fn cylinders(digits: Option<i32>) -> Description {
    let mut d = Description::new("cylinders");
    let angle = 0.6_f64;
    let rounded = |x: f64| match digits {
        None => x,
        Some(digits) => {
            let unit = 10_f64.powi(digits);
            (x * unit).round() / unit
        }
    };
    let axis = joints::Direction::new([rounded(angle.cos()), rounded(angle.sin())]);
    let axis = axis.expect("a direction");
    let arm_at = [1.5 * angle.cos(), 1.5 * angle.sin()];
    let arm = d.body(bar("arm", arm_at, 0.0));
    let local = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let foot = [1.2, -0.1];
    let hinge = Revolute {
        s_i: foot,
        s_j: local(foot, arm_at),
    };
    d.joint("hinge", &[BodyRef::Ground, arm], hinge);
    for (k, offset) in [-0.2, 0.2].into_iter().enumerate() {
        let foot = [-offset * angle.sin(), offset * angle.cos()];
        let at = |s: f64| [foot[0] + s * angle.cos(), foot[1] + s * angle.sin()];
        let tube = d.body(bar(&format!("tube {k}"), at(0.4), 0.0));
        let rod = d.body(bar(&format!("rod {k}"), at(1.1), 0.0));
        let pin = Revolute {
            s_i: foot,
            s_j: local(foot, at(0.4)),
        };
        d.joint(&format!("A{k}"), &[BodyRef::Ground, tube], pin);
        let slide = joints::Translational::new([0.0; 2], [0.0; 2], axis);
        let drive = slide.displacement_drive();
        d.joint(&format!("S{k}"), &[tube, rod], slide);
        d.drive(
            &format!("pump {k}"),
            &[tube, rod],
            drive,
            Function::constant(0.0).expect("a number"),
        );
        let eye = at(1.5);
        let pin = Revolute {
            s_i: local(eye, at(1.1)),
            s_j: local(eye, arm_at),
        };
        d.joint(&format!("B{k}"), &[rod, arm], pin);
    }
    d
}

/// The mechanism has the same verdicts for any number of digits of its axes. These are the verdicts
/// of the exact mechanism. If the digits assign a fraction of the free force to a slide, the margin
/// of the slide is reported.
#[test]
fn parallel_cylinders_are_one_mechanism_with_any_digits() {
    let verdicts = |analysis: &Analysis| -> Vec<&'static str> {
        assert!(
            analysis.decision.is_decided(),
            "{:?}",
            analysis.decision.status
        );
        assert_eq!(
            (analysis.decision.rank, analysis.decision.redundancy),
            (15, 1)
        );
        let reactions = analysis.reactions.iter();
        reactions.map(|r| r.wrench.verdict.word()).collect()
    };
    let slides = |analysis: &Analysis| -> Vec<crate::Judgement> {
        let slides = analysis
            .reactions
            .iter()
            .filter(|r| r.name.starts_with('S'));
        slides.map(|r| r.wrench.clone()).collect()
    };
    let exact = analysed(&cylinders(None));
    let exact = verdicts(&exact);
    // The joints come first, then the drives. The force is in both cylinders, and the slides carry
    // no part of it.
    let [u, n] = ["unique", "not_unique"];
    assert_eq!(exact, [n, n, u, n, n, u, n, n, n]);
    for (digits, least, most) in [
        (None, 0.0, 1e-15),
        // The cosine of 0.6 is wrong by 3.6e-5, the sine is wrong by 4.2e-5, and the direction is
        // wrong by 1.5e-5 rad.
        (Some(4), 1e-6, 1.5e-5),
        (Some(6), 1e-8, 1.5e-6),
        (Some(12), 0.0, 1e-12),
    ] {
        let analysis = analysed(&within(cylinders(digits), 1e-4));
        assert_eq!(verdicts(&analysis), exact, "{digits:?}");
        for slide in slides(&analysis) {
            assert!(
                (least..most).contains(&slide.margin),
                "{digits:?}: {slide:?}"
            );
            assert_eq!(slide.within_tolerance, slide.margin > 1e-9, "{digits:?}");
        }
    }
    // With digits that are exact, the slides carry a fraction of the free force.
    for tolerance in [None, Some(1e-8)] {
        let mut intended = cylinders(Some(4));
        intended.tolerance.length = tolerance;
        let analysis = analysed(&intended);
        assert!(verdicts(&analysis).iter().all(|v| *v == n), "{tolerance:?}");
        assert!(
            slides(&analysis)
                .iter()
                .all(|slide| !slide.within_tolerance)
        );
    }
}

/// Two slides between the ground and one body, in a scene of two metres. Their forces act on lines
/// at this distance from each other. The combination `n_B − n_A` rotates the body by this lever,
/// and the angle rows balance the rotation. A lever that is zero within the tolerance is omitted,
/// and its size is reported. If the lever may be zero, it is undecided whether the angle rows
/// belong to the dependency. A large lever is part of the dependency.
#[test]
fn a_dependency_that_hangs_on_a_coefficient_is_marked_or_withheld() {
    let judged = |apart: f64, tolerance: f64| {
        let mut d = Description::new("slides");
        let body = d.body(Body::new("slide", 10.0, 1.0));
        for (name, ground, x) in [("A", -1.0, 0.0), ("B", 1.0, apart)] {
            let slide = joints::Translational::new([ground, 0.0], [x, 0.0], joints::Direction::X);
            d.joint(name, &[BodyRef::Ground, body], slide);
        }
        d.tolerance.length = Some(tolerance);
        let found = analysed(&d);
        let is_open = found.warnings.iter().any(|w| w.contains("it is undecided"));
        let rows: Vec<usize> = found.dependencies.iter().map(|d| d.rows.len()).collect();
        let left = found.dependencies.iter().map(|d| d.left_out);
        (rows, is_open, left.fold(0.0, f64::max))
    };
    let (rows, is_open, left) = judged(1e-4, 1e-2);
    assert_eq!((rows, is_open), (vec![2, 2], false));
    // The lever is 1e-4 m of two metres, up to the powers of two by which rows are scaled.
    assert!((1e-5..4e-4).contains(&left), "{left:e}");
    assert_eq!(judged(0.0, 1e-2), (vec![2, 2], false, 0.0));
    let (rows, is_open, _) = judged(0.02, 1e-2);
    assert_eq!((rows, is_open), (vec![], true));
    assert_eq!(judged(0.02, 1e-5), (vec![2, 3], false, 0.0));
}

/// Two equal bars, one metre long, whose direction differs from the y-axis by this angle. Neither
/// force is unique. The x component counts as zero within the tolerance if it is far below the
/// tolerance and far below a thousandth. It counts as nonzero if it is far above both values.
#[test]
fn a_component_that_is_none_within_the_tolerance_says_so() {
    let judged = |across: f64, tolerance: f64| {
        let mut d = Description::new("bars");
        let body = d.body(Body {
            position: [across, 1.0],
            ..Body::new("weight", 10.0, 1.0)
        });
        for name in ["A", "B"] {
            let bar = Distance::new([0.0; 2], [0.0; 2]);
            d.joint(name, &[BodyRef::Ground, body], bar);
        }
        d.tolerance.length = Some(tolerance);
        let found = analysed(&d);
        let x = found.reactions[0]
            .components
            .iter()
            .find(|c| c.name == "Fx");
        x.expect("a component").judgement.clone()
    };
    let none = judged(1e-4, 1e-3);
    assert!(
        none.verdict.is_unique() && none.within_tolerance,
        "{none:?}"
    );
    // One of two equal forces with a given sum: half of both forces, which is 1/√2 of a unit
    // vector.
    assert!(
        (none.margin / 1e-4 - 0.5_f64.sqrt()).abs() < 0.01,
        "{none:?}"
    );
    assert_eq!(judged(0.1, 1e-3).verdict, crate::Verdict::NotUnique);
    for (across, tolerance) in [(1e-2, 1e-2), (1e-2, 4e-2), (1e-2, 0.2)] {
        let open = judged(across, tolerance);
        assert_eq!(open.verdict.word(), "undecided", "{tolerance}: {open:?}");
    }
}

/// Two knife edges on one axle that are parallel to within a thousandth. Within a tolerance of a
/// centimetre one of the edges is redundant, and neither force is unique.
#[test]
fn edges_of_one_axle_share_their_force_within_a_tolerance() {
    let d = axle(1e-3);
    assert_eq!(analysed(&d).decision.rank, 2);
    let analysis = analysed(&within(d, 1e-2));
    assert_eq!((analysis.decision.rank, analysis.mobility()), (1, 2));
    for reaction in &analysis.reactions {
        assert_eq!(
            reaction.wrench.verdict,
            crate::Verdict::NotUnique,
            "{}",
            reaction.name
        );
    }
}

/// A cart on two knife edges on one axle, whose directions differ by this angle.
fn axle(angle: f64) -> Description {
    let mut d = Description::new("cart");
    let cart = d.body(Body::new("cart", 10.0, 1.0));
    for (name, y, x) in [("left", 0.5, 0.0), ("right", -0.5, angle)] {
        let normal = joints::Direction::new([x, 1.0]).expect("a direction");
        let s = [0.0, y];
        d.joint(name, &[cart], joints::KnifeEdge { s, normal });
    }
    d
}

/// Both directions have to be perpendicular to the axle, so one of the directions rotates by the
/// whole difference. No tolerance of lengths is stated, so lengths are uncertain by rounding
/// errors.
#[test]
fn an_angle_tolerance_counts_alone() {
    let judged = |tolerance: model::Tolerance| {
        let mut d = axle(1e-4);
        d.tolerance = tolerance;
        analysed(&d)
    };
    let angle = |angle: f64| model::Tolerance {
        length: None,
        angle: Some(angle),
    };
    let redundant = judged(angle(1e-3));
    let certificate = redundant.evidence().certificate.clone();
    let certificate = certificate.expect("certified");
    assert_eq!((redundant.decision.rank, redundant.mobility()), (1, 2));
    assert_eq!(certificate.grounds, rank::Grounds::WithinTolerance);
    assert!(
        redundant
            .reactions
            .iter()
            .all(|r| r.wrench.verdict == crate::Verdict::NotUnique)
    );

    let full = judged(angle(1e-5));
    assert!(full.decision.is_decided());
    assert_eq!(full.decision.rank, 2);
    let certificate = full.evidence().certificate.clone();
    let certificate = certificate.expect("certified");
    // The edges are 1 m apart, so the size is one.
    let from = certificate.lower_rank_from.expect("near");
    assert!(certificate.lower_rank_by_angles);
    assert!((from / 1e-4 - 1.0).abs() < 0.06, "{from:e}");

    let RankStatus::Undecided(doubt) = judged(angle(5e-5)).decision.status else {
        panic!("decided");
    };
    let text = doubt.to_string();
    assert!(
        text.contains("with data accurate to 5.0e-5 rad the rank is 1 or 2"),
        "{text}"
    );

    // A tolerance of length is equivalent to a tolerance of angles that is divided by the size.
    let length = model::Tolerance {
        length: Some(1e-3),
        angle: None,
    };
    assert_eq!(judged(length).decision.rank, 1);
    // With small tolerances of lengths and large tolerances of angles, the angles determine the
    // result.
    let both = model::Tolerance {
        length: Some(1e-9),
        angle: Some(1e-3),
    };
    assert_eq!(judged(both).decision.rank, 1);
}

/// A bar between two pins on the ground. One pin is 0.05 mm too far away. No configuration
/// satisfies all rows, but a configuration exists for data that differ by at most 0.1 mm.
#[test]
fn data_that_contradict_each_other_within_the_tolerance_are_assembled() {
    let clamped = |tolerance: Option<f64>| {
        let mut d = Description::new("clamped bar");
        d.tolerance.length = tolerance;
        let bar = d.body(bar("bar", [0.5, 0.0], 0.0));
        for (name, s_i, s_j) in [
            ("left", [0.0, 0.0], [-0.5, 0.0]),
            ("right", [1.0, 0.0], [0.500_05, 0.0]),
        ] {
            d.joint(name, &[BodyRef::Ground, bar], Revolute { s_i, s_j });
        }
        let mut mechanism = Mechanism::build(&d).expect("it builds");
        let start = model::start::assemble(&mut mechanism, &Default::default());
        start.map(|start| {
            let analysis = analyse(&mechanism, 0.0, &start.q).expect("it is analysed");
            (start.residual, analysis)
        })
    };
    for tolerance in [None, Some(1e-6)] {
        let refused = clamped(tolerance).map(|_| ());
        assert!(
            matches!(refused, Err(model::StartError::NoAssembly { .. })),
            "{tolerance:?}: {refused:?}"
        );
    }
    let (residual, analysis) = clamped(Some(1e-4)).expect("it is assembled");
    // The residual of both pins is half of the constraint violation.
    assert!((residual - 2.5e-5).abs() < 1e-8, "{residual:e}");
    assert!(analysis.decision.is_decided());
    assert_eq!(
        (analysis.decision.rank, analysis.decision.redundancy),
        (3, 1)
    );
    // A load along the bar in both pins is possible: the pins push against each other.
    let verdicts = analysis.reactions.iter().map(|r| {
        let components = r.components.iter();
        components
            .map(|c| c.judgement.verdict.word())
            .collect::<Vec<_>>()
    });
    for verdict in verdicts {
        assert_eq!(verdict, ["not_unique", "unique"]);
    }
}
