//! Tests definitions outside the library against values derived by hand, and names that may collide
//! with generated code.

#![deny(warnings)]

mod pfaff {
    //! A facade crate from the point of view of its users: it exports the crate `joints` under
    //! another path and wraps the macro.
    pub(crate) use joints as kernels;

    /// The macro `joint!` with the path in the facade.
    #[macro_export]
    macro_rules! facade_joint {
        ($($definition:tt)*) => {
            pfaff_joint_macro::joint! { #![runtime = $crate::pfaff::kernels] $($definition)* }
        };
    }
}

use joints::{
    Constraint, ConstraintKernels, Definition, Element, Force, ForceElement, Pose, Reaction,
    SlopedOutputs, Twist,
};
use pfaff_joint_macro::{force, joint};

joint! { plane EqualDistance(i, j, k) {
    /// The origin of body k is as far from the origin of body i as from the origin of body j:
    /// `a·a − b·b = 0`.
    params {}
    let a = origin(k) - origin(i);
    let b = origin(k) - origin(j);
    rows: [distance];
    phi: dot(a, a) - dot(b, b);
    place: origin(k);
} }

/// The value of the row at r_i = (0, 0), r_j = (4, 0), r_k = (1, 2), where a = (1, 2) and b = (−3,
/// 2).
#[test]
fn equal_distance_by_hand() {
    let joint = EqualDistance {};
    let x = [
        Pose::GROUND,
        Pose::new(4.0, 0.0, 0.3),
        Pose::new(1.0, 2.0, -0.7),
    ];
    let v = [
        Twist {
            x: 0.0,
            y: 0.0,
            omega: 0.0,
        },
        Twist {
            x: 1.0,
            y: 1.0,
            omega: 5.0,
        },
        Twist {
            x: 2.0,
            y: 0.0,
            omega: 9.0,
        },
    ];
    let mut phi = [0.0];
    Element::phi(&joint, &x, &[], &mut phi);
    // The expected value is 5 − 13.
    assert_eq!(phi, [-8.0]);

    // The derivatives are d(a·a)/dr_i = −2a, d(−b·b)/dr_j = 2b, d(a·a − b·b)/dr_k = 2(a − b) = (8,
    // 0); there are no rotations.
    let pattern: Vec<_> = EqualDistance::SPEC
        .c
        .iter()
        .map(|e| (e.slot, e.dof))
        .collect();
    assert_eq!(pattern, [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)]);
    let mut c = [f64::NAN; 6];
    Element::<f64>::c_constant(&joint, &mut c);
    Element::c(&joint, &x, &[], &mut c);
    assert_eq!(c, [-2.0, -4.0, -6.0, 4.0, 8.0, 0.0]);

    // The expected Γ is −2(ȧ·ȧ − ḃ·ḃ) with ȧ = (2, 0) and ḃ = (1, −1), that is −2(4 − 2).
    let mut gamma = [0.0];
    Element::gamma(&joint, &x, &v, &[], &mut gamma);
    assert_eq!(gamma, [-4.0]);
    assert_eq!(Reaction::<f64>::place(&joint, &x), [1.0, 2.0]);
}

facade_joint! { plane ScaledPin(i) {
    /// Point `s` of the body stays at `scale·(1, 2)` of the ground, through a facade.
    params { s: Point in i, scale: Ratio }
    rows: [x, y];
    phi: [point(i, s)[0] - scale, point(i, s)[1] - 2.0 * scale];
    place: point(i, s);
} }

#[test]
fn the_facade_path_is_used() {
    let pin = ScaledPin {
        s: [3.0, 1.0],
        scale: 2.0,
    };
    let mut phi = [0.0; 2];
    Element::phi(&pin, &[Pose::GROUND], &[], &mut phi);
    assert_eq!(phi, [1.0, -3.0]);
}

// In this definition, every parameter has the name of a value in the generated code.
joint! { plane Awkward(i, s) {
    /// A point of body i has prescribed coordinates in body s; the names are chosen to collide.
    params {
        s_i: Point in i,
        s_i_x: Length,
        s_i_y: Length,
        s_i_local: Length,
        n: Direction in i,
        n_x: Length,
        n_local_x: Length,
        arm_i_x: Length,
        cos_i: Length,
        r_i_x: Length,
        t0: Length,
        x: Length,
        k: Length,
        out: Length,
        f: [Function<Length>, Function<Length>],
        f_0: Length,
        f_0_t: Length,
    }
    let a = s_i_x + s_i_y + s_i_local + n_x + n_local_x + arm_i_x + cos_i + r_i_x + t0 + x + k + out + f_0 + f_0_t;
    let lambda = point(i, s_i) - origin(s);
    rows: [x, y];
    phi: [dot(direction(i, n), lambda) - a - f[0], dot(perp(direction(i, n)), lambda) - f[1]];
    place: point(i, s_i);
} }

#[test]
fn names_that_collide_are_told_apart() {
    let direction = joints::Direction::new([0.0, 1.0]).expect("not zero");
    let joint = Awkward {
        s_i: [10.0, 20.0],
        s_i_x: 1.0,
        s_i_y: 2.0,
        s_i_local: 3.0,
        n: direction,
        n_x: 4.0,
        n_local_x: 5.0,
        arm_i_x: 6.0,
        cos_i: 7.0,
        r_i_x: 8.0,
        t0: 9.0,
        x: 10.0,
        k: 11.0,
        out: 12.0,
        f_0: 13.0,
        f_0_t: 14.0,
    };
    // Body i is rotated by 90°. Therefore its point is at r_i + (−20, 10), its n is (−1, 0), and
    // perp(n) is (0, −1).
    let x = [
        Pose {
            x: 100.0,
            y: 200.0,
            angle: 0.0,
            cos: 0.0,
            sin: 1.0,
        },
        Pose::new(1.0, 2.0, 0.0),
    ];
    let f = [[0.25, 0.0, 0.0], [0.5, 0.0, 0.0]];
    let mut phi = [0.0; 2];
    Element::phi(&joint, &x, &f, &mut phi);
    // With lambda = (79, 208) the values are −79 − (1 + 2 + … + 14) − 0.25 and −208 − 0.5.
    assert_eq!(phi, [-184.25, -208.5]);
}

// Stored values with the names of arguments of kernels, or of a pattern of Rust.
joint! { plane Shadows(i) {
    /// `N² + N + angle = lambda·x_0` with `N = d² + d`, `d = x − x_0`.
    params { lambda: Ratio }
    initial { x: Length = origin(i)[0], v: Length = lambda * x }
    let out = origin(i)[0] - x;
    let None = out * out + out;
    rows: [out];
    phi: None * None + None + angle(i) - v;
    measure out: out;
    place: origin(i);
} }

#[test]
fn names_of_arguments_hide_nothing() {
    let mut joint = Shadows::new(3.0);
    Definition::initialise(&mut joint, &[Pose::new(2.0, 0.0, 0.0)]);
    let mut phi = [0.0];
    Element::phi(&joint, &[Pose::new(3.0, 0.0, 0.5)], &[], &mut phi);
    // With out = 1 and None = 2 the value is 4 + 2 + 0.5 − 3·2.
    assert_eq!(phi, [0.5]);
}

/// The value `v = lambda·x_0` is computed from other stored values, so it changes with them. Here
/// out = 1, None = 2, and dNone/dx_0 = −3.
#[test]
fn what_is_computed_from_other_numbers_changes_with_them() {
    let mut joint = Shadows::new(3.0);
    Definition::initialise(&mut joint, &[Pose::new(2.0, 0.0, 0.0)]);
    let named: Vec<&str> = Shadows::SPEC.data.iter().map(|d| d.name).collect();
    assert_eq!(named, ["lambda", "x"]);
    assert_eq!(Shadows::SPEC.n_data(), 2);
    let pose = [Pose::new(3.0, 0.0, 0.5)];
    let mut gradient = [0.0; 2];
    joint
        .slopes(&pose, &[], SlopedOutputs::Phi)
        .phi(&[10.0], &mut gradient);
    // The derivatives are ∂/∂lambda = −x_0 = −2 and ∂/∂x_0 = (2·2 + 1)·(−3) − 3 = −18.
    assert_eq!(gradient, [-20.0, -180.0]);
    // C = (2·None + 1)·(2·out + 1) along x, so its derivative with respect to x_0 is 2·(−3)·3 +
    // 5·(−2) = −28.
    let slopes = joint.slopes(&pose, &[], SlopedOutputs::All(&[Twist::zero()]));
    slopes.residual(&[10.0], &[1.0, 0.0, 0.0], &mut gradient);
    assert_eq!(gradient, [0.0, -280.0]);

    // The changed values are returned unchanged, and v = 5·4 is computed from them; the row is 0 +
    // 0 + 0.5 − 20.
    Definition::set_data(&mut joint, &[5.0, 4.0]);
    let mut numbers = [0.0; 2];
    Definition::data(&joint, &mut numbers);
    assert_eq!(numbers, [5.0, 4.0]);
    let mut phi = [0.0];
    Element::phi(&joint, &[Pose::new(4.0, 0.0, 0.5)], &[], &mut phi);
    assert_eq!(phi, [-19.5]);
}

// Quotients that are computed before the motion, so that the kernels of the constraint are
// polynomials.
joint! { plane Scaled(i, j) {
    /// `along·(p − start) = square·angle` with a square that is a chain of quotients.
    params {
        line: GroundLine,
        rest: Length = norm(origin(j) - origin(i)),
        sizes: [Length, Ratio],
    }
    initial {
        inverse: PerLength = 1 / norm(origin(j) - origin(i)),
        share: Ratio = sizes[1] / rest,
        square: Ratio = share * inverse / sizes[0],
    }
    rows: [row];
    phi: dot(along(line), origin(j) - start(line)) - square * angle(j);
    place: origin(i);
} }

/// The square is (s_1/rest)·inverse/s_0 with inverse = 1/5 from the initial configuration, the
/// given rest = 2, and s = (4, 3). Its value is (3/2)·(1/5)/4.
#[test]
fn quotients_of_data_have_their_derivatives() {
    use joints::spec::{DatumShape as S, Unit};
    let arguments = [
        joints::Argument::Pairs([[1.0, 2.0], [1.0, 7.0]]),
        joints::Argument::Numbers(vec![2.0]),
        joints::Argument::Numbers(vec![4.0, 3.0]),
    ];
    let mut joint = Scaled::from_arguments(&arguments).expect("the arguments are right");
    let start = [Pose::GROUND, Pose::new(3.0, 4.0, 0.0)];
    // The constructor has the values without their shapes as arguments; stored initial values are
    // computed from the initial configuration.
    assert_eq!(Scaled::new(joint.line, [4.0, 3.0]).with_rest(2.0), joint);
    assert_ne!(Scaled::new(joint.line, [4.0, 3.0]), joint);
    Definition::initialise(&mut joint, &start);
    let data: Vec<_> = Scaled::SPEC
        .data
        .iter()
        .map(|d| (d.name, d.shape))
        .collect();
    let expected = [
        ("line", S::Line),
        ("sizes[0]", S::Number(Unit::Length)),
        ("sizes[1]", S::Number(Unit::Ratio)),
        ("rest", S::Number(Unit::Length)),
        ("inverse", S::Kept(Unit::PerLength)),
    ];
    assert_eq!(data, expected);
    let mut numbers = [0.0; 8];
    Definition::data(&joint, &mut numbers);
    assert_eq!(numbers, [1.0, 2.0, 0.0, 1.0, 4.0, 3.0, 2.0, 0.2]);

    let x = [Pose::GROUND, Pose::new(6.0, 8.0, -0.5)];
    let mut found = [0.0; 8];
    joint
        .slopes(&x, &[], SlopedOutputs::Phi)
        .phi(&[1.0], &mut found);
    // Φ = along·(p − start) + square/2. Its derivative with respect to the start is −along, and
    // with respect to along it is p − start; the other derivatives are those of square/2 with
    // respect to each factor.
    let half = 0.5 * 0.075;
    let expected = [
        0.0,
        -1.0,
        5.0,
        6.0,
        -half / 4.0,
        half / 3.0,
        -half / 2.0,
        half / 0.2,
    ];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }

    // A rest length that is given by the user does not change when initial values are computed
    // again.
    numbers[6] = 8.0;
    Definition::set_data(&mut joint, &numbers);
    Definition::initialise(&mut joint, &start);
    Definition::data(&joint, &mut numbers);
    assert_eq!((joint.rest, numbers[6]), (Some(8.0), 8.0));
}

force! { plane Magnet(i, j) {
    /// Attraction `strength/l²` between two origins; at the start the origins differ, or the
    /// attraction is switched off.
    params { strength: Ratio, off: Ratio }
    let l = norm(origin(j) - origin(i));
    require "apart and nearer than ten, or switched off": (l > 0.0 || off == 1.0) && (l < 10.0 || off == 1.0);
    force: -(1.0 - off) * strength / (l * l) on l;
} }

/// At a distance of 5 along (3, 4), the attraction is 100/25 = 4 N, so the force on body j is
/// −4·(0.6, 0.8).
#[test]
fn magnet_by_hand() {
    let magnet = Magnet {
        strength: 100.0,
        off: 0.0,
    };
    let x = [Pose::GROUND, Pose::new(3.0, 4.0, 0.0)];
    let mut q = [0.0; 4];
    assert_eq!(Magnet::SPEC.q, [0, 1, 3, 4]);
    ForceElement::q(&magnet, &x, &[Twist::zero(); 2], &[], &mut q);
    for (found, expected) in q.into_iter().zip([2.4, 3.2, -2.4, -3.2]) {
        // The bound covers the rounding errors of several operations on values of 1 to 100.
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
}

/// The generated code contains `(A || B) && (C || D)` with its parentheses: at l = 20 and with the
/// attraction switched on, C and D are both false.
#[test]
fn conditions_keep_their_parentheses() {
    let far = [Pose::GROUND, Pose::new(12.0, 16.0, 0.0)];
    let near = [Pose::GROUND, Pose::new(3.0, 4.0, 0.0)];
    let on = Magnet {
        strength: 1.0,
        off: 0.0,
    };
    let off = Magnet {
        strength: 1.0,
        off: 1.0,
    };
    assert!(!Definition::requirement(&on, 0, &far));
    assert!(Definition::requirement(&on, 0, &near));
    assert!(Definition::requirement(&off, 0, &far));
    assert!(!Definition::requirement(&on, 0, &[Pose::GROUND; 2]));
    assert!(Definition::requirement(&off, 0, &[Pose::GROUND; 2]));
}

#[test]
fn the_text_is_what_its_author_wrote() {
    let text = EqualDistance::SPEC.common.text;
    assert!(
        text.starts_with("joint! { plane EqualDistance(i, j, k) {\n    /// The origin of body k"),
        "{text}"
    );
    assert!(text.ends_with("place: origin(k);\n} }"), "{text}");
}

// A joint in space: a pin in a slot with two walls; the pin can rotate about a third direction.
joint! { space SlottedPin(i, j) {
    /// Point `p` of body j has constant distances from two walls of body i, and its axis is always
    /// parallel to that of the slot.
    params {
        s: Point in i,
        p: Point in j,
        slot: Axes in i,
        slot_j: Axes in j like slot,
        gap: Length,
    }
    let d = point(j, p) - point(i, s);
    rows: [across, level, axis];
    phi: [
        dot(direction(i, slot[0]), d) - gap,
        dot(direction(i, slot[1]), d),
        dot(cross(direction(i, slot[0]), direction(j, slot_j[2])), direction(i, slot[2])),
    ];
    measure turn: angle(slot, slot_j);
    place: point(i, s);
} }

/// Body i is rotated by 90° about z, and body j by 180°. Therefore u = (0, 1, 0), v = (−1, 0, 0),
/// w = (0, 0, 1), and d = (−3, 2, 5) − (1, 1, 1). The third row is (u × w)·w = 0; the joint
/// coordinate is 90°, and it was 0 at the start.
#[test]
fn a_joint_in_space_by_hand() {
    use joints::space3::{Axes, Pose};
    let mut pin = SlottedPin {
        s: [0.0; 3],
        p: [1.0, 0.0, 0.0],
        slot: Axes::FRAME,
        slot_j: Axes::FRAME,
        gap: 0.25,
    };
    let x = [
        Pose::new([1.0, 1.0, 1.0], [1.0, 0.0, 0.0, 1.0]),
        Pose::new([-2.0, 2.0, 5.0], [0.0, 0.0, 0.0, 1.0]),
    ];
    pin.initialise(&x);
    let mut phi = [0.0; 3];
    Element::phi(&pin, &x, &[], &mut phi);
    assert_eq!(phi, [0.75, 4.0, 0.0]);
    assert_eq!(Reaction::<f64, _>::place(&pin, &x), [1.0; 3]);

    let mut turn = pin.turn_drive();
    turn.initialise(&[Pose::GROUND; 2]);
    let mut phi = [0.0];
    // The row is sin(90° − f) for f = 0; f is given by its cosine and sine.
    Element::phi(&turn, &x, &[[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]], &mut phi);
    assert_eq!(phi, [1.0]);
    assert_eq!(SlottedPin::SPEC.measures.len(), 1);
}
