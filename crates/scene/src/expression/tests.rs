//! Compares values with closed forms in decimal digits, and checks the positions of errors.

use std::collections::BTreeMap;
use std::f64::consts::{E, FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, LN_10, PI, SQRT_2};

use super::token::LONGEST;
use super::*;

/// The parameters by name, and the units of bare numbers.
struct Names(BTreeMap<&'static str, Option<Quantity>>, Bases);

impl Scope for Names {
    fn parameter(&self, name: &str) -> Option<Option<Quantity>> {
        self.0.get(name).copied()
    }
    fn bases(&self) -> Bases {
        self.1
    }
}

fn names() -> Names {
    let bare = |x: f64| Some(Quantity::bare(x.into()));
    let rod = Some(Quantity::unit(300.0, 1e3, Dimension::LENGTH));
    let list = [
        ("L", bare(3.0)),
        ("phi", bare(0.5)),
        ("rod", rod),
        ("wrong", None),
    ];
    Names(list.into(), Bases::SI)
}

fn in_drawing_units() -> Names {
    let bases = Bases {
        length: decimal("1e-3"),
        angle: Quantity::unit(PI, 180.0, Dimension::ANGLE).value,
    };
    Names(names().0, bases)
}

fn value(text: &str, of: Dimension, names: &Names) -> Result<f64, String> {
    let say = |faults: Vec<Fault>| {
        let said = faults
            .iter()
            .map(|f| format!("{:?}: {}", f.span, f.problem));
        said.collect::<Vec<_>>().join("; ")
    };
    let q = evaluate(text, names).map_err(say)?;
    let q = q.at(of, names.1).map_err(|problem| problem.to_string())?;
    Ok(q.to_f64())
}

const NONE: Dimension = Dimension::NONE;
const LENGTH: Dimension = Dimension::LENGTH;
const ANGLE: Dimension = Dimension::ANGLE;

#[test]
fn exact_values_are_the_doubles_next_to_them() {
    for (text, of, expected) in [
        ("0.1 + 0.2", NONE, 0.3),
        ("1e6 + 0.3 - 1e6", NONE, 0.3),
        ("1/3 + 1/3 + 1/3 - 1", NONE, 0.0),
        ("300.1 mm", LENGTH, 0.3001),
        ("25mm+2.5 cm", LENGTH, 0.05),
        ("1 in", LENGTH, 0.0254),
        ("2 mm^2/(1 mm)", LENGTH, 0.002),
        ("sqrt(9 mm²)", LENGTH, 0.003),
        ("90 deg", ANGLE, FRAC_PI_2),
        ("30°", ANGLE, FRAC_PI_6),
        ("5 m/s * 3 ms", LENGTH, 0.015),
        ("2 min", Dimension::TIME, 120.0),
        ("250 g", Dimension::MASS, 0.25),
        ("3 kN", Dimension::FORCE, 3000.0),
        ("2 kg*m/s^2", Dimension::FORCE, 2.0),
        ("-2^2", NONE, -4.0),
        ("2^3^2", NONE, 512.0),
        ("2^-2", NONE, 0.25),
        ("2*-3 - -1", NONE, -5.0),
        ("10 - 3 - 2", NONE, 5.0),
        ("24/4/3", NONE, 2.0),
        ("((2))*(1+1)", NONE, 4.0),
        ("1_000.5e-1", NONE, 100.05),
        (".5 + 1.", NONE, 1.5),
        ("L*cos(0)", LENGTH, 3.0),
        ("rod + 0.5", LENGTH, 0.8),
        ("min(L, rod)", LENGTH, 0.3),
        ("max(2, -7)", NONE, 2.0),
        ("abs(-rod)", LENGTH, 0.3),
        ("300 mm / 600 mm", ANGLE, 0.5),
        ("1e60*1", NONE, 1e60),
        ("1e-320", NONE, 1e-320),
        (
            "123456789012345678901234567890",
            NONE,
            123_456_789_012_345_680_000_000_000_000.0,
        ),
    ] {
        assert_eq!(value(text, of, &names()), Ok(expected), "{text}");
    }
}

/// The symbols of textbooks are parameters, except in unit terms. The expected values were computed
/// by hand.
#[test]
fn parameters_have_priority_over_units_outside_of_unit_terms() {
    let bare = |x: f64| Some(Quantity::bare(x.into()));
    let list = [
        ("m", bare(2.0)),
        ("g", bare(9.5)),
        ("s", bare(0.5)),
        ("N", bare(5.0)),
        ("deg", bare(3.0)),
    ];
    let stated = Names(list.into(), Bases::SI);
    let (force, time) = (Dimension::FORCE, Dimension::TIME);
    let damping = force.times(LENGTH, -1).times(time, 1);
    for (text, of, expected) in [
        ("m*g", NONE, 19.0),
        ("2*m", NONE, 4.0),
        ("m^2*s", NONE, 2.0),
        ("N*3 + deg", NONE, 18.0),
        ("-m", NONE, -2.0),
        ("min(m, s)", NONE, 0.5),
        ("m*mm", LENGTH, 0.002),
        ("2 m", LENGTH, 2.0),
        ("2m", LENGTH, 2.0),
        ("0.4 N*s/mm", damping, 400.0),
        ("0.4 N·s/mm", damping, 400.0),
        ("5 m/s", Dimension::VELOCITY, 5.0),
        ("5 m / s", LENGTH, 10.0),
        ("5 m/ s", LENGTH, 10.0),
        ("5 m /s", LENGTH, 10.0),
        ("5 m/(s)", LENGTH, 10.0),
        ("3 kg*m^2", Dimension::INERTIA, 3.0),
        ("3 kg*m²", Dimension::INERTIA, 3.0),
        ("3 m^-2*kg*m^4", Dimension::INERTIA, 3.0),
        ("3 m^+1*s^-2", Dimension::ACCELERATION, 3.0),
        ("8 m²/s²/(2 m)", Dimension::ACCELERATION, 4.0),
        ("5 m/s*s", LENGTH, 5.0),
        ("5 m/s * s", Dimension::VELOCITY, 2.5),
        ("2 m/m", NONE, 2.0),
        ("6 mm/3*m", LENGTH, 0.004),
        ("30° + 0*deg", ANGLE, FRAC_PI_6),
    ] {
        let found = value(text, of, &stated);
        assert_eq!(found, Ok(expected), "{text}");
    }
    let exponent = value("3^2 m", NONE, &stated).expect_err("an exponent with a unit");
    assert_eq!(exponent, "2..5: an exponent is a length (m)");
    // Without these parameters, the same names are units everywhere.
    for (text, of, expected) in [
        ("3*m", LENGTH, 3.0),
        ("L*N / m", force.times(LENGTH, -1), 3.0),
        ("5 m / s", Dimension::VELOCITY, 5.0),
    ] {
        assert_eq!(value(text, of, &names()), Ok(expected), "{text}");
    }
}

/// Definitions: 1 bar = 10⁵ Pa, 1 MPa = 1 N/mm².
#[test]
fn pressures_powers_and_micrometres_have_units() {
    let pressure = Dimension::FORCE.times(LENGTH, -2);
    let power = Dimension::FORCE.times(Dimension::VELOCITY, 1);
    let torque = Dimension::FORCE.times(LENGTH, 1);
    for (text, of, expected) in [
        ("160 bar", pressure, 1.6e7),
        ("2 MPa", pressure, 2e6),
        ("210e3 MPa*mm²", Dimension::FORCE, 2.1e5),
        ("160 bar * 20 cm^2", Dimension::FORCE, 3.2e4),
        ("1.5 kW", power, 1500.0),
        ("1.5 kW/(10 rad/s)", torque, 150.0),
        ("250 \u{b5}m", LENGTH, 2.5e-4),
        ("250 \u{3bc}m", LENGTH, 2.5e-4),
        ("2 mm/\u{3bc}m", NONE, 2000.0),
        ("2 N/\u{b5}m", Dimension::FORCE.times(LENGTH, -1), 2e6),
    ] {
        assert_eq!(value(text, of, &names()), Ok(expected), "{text}");
    }
    let said = value("2 bar", LENGTH, &names());
    let expected = "found a pressure (N/m²), need a length (m)";
    assert_eq!(said, Err(expected.to_owned()));
    let said = value("2 kW", LENGTH, &names());
    let expected = "found a power (N·m/s), need a length (m)";
    assert_eq!(said, Err(expected.to_owned()));
}

/// Closed forms as decimals (from tables, 20 digits), accurate to two units in the last place.
#[test]
fn functions_have_their_known_values() {
    for (text, of, expected) in [
        ("sin(30 deg)", NONE, 0.5),
        ("cos(90 deg)", NONE, 0.0),
        ("sin(180 deg)", NONE, 0.0),
        ("tan(45 deg)", NONE, 1.0),
        ("cos(36 deg) - (1 + sqrt(5))/4", NONE, 0.0),
        ("sin(1)", NONE, 0.841_470_984_807_896_5),
        ("exp(1)", NONE, E),
        ("log(10)", NONE, LN_10),
        ("asin(1)", ANGLE, FRAC_PI_2),
        ("acos(-1)", ANGLE, PI),
        ("acos(0.5) - 60 deg", ANGLE, 0.0),
        ("atan(1)", ANGLE, FRAC_PI_4),
        ("atan2(-1, -1)", ANGLE, -2.356_194_490_192_345),
        ("atan2(rod, 0.3)", ANGLE, FRAC_PI_4),
        ("2^0.5", NONE, SQRT_2),
        ("pi", ANGLE, PI),
        ("(1 + L^2)^0.5", NONE, 3.162_277_660_168_379_4),
    ] {
        let found = value(text, of, &names()).unwrap_or_else(|e| panic!("{text}: {e}"));
        let bound = 2.0 * f64::EPSILON * f64::abs(expected);
        assert!((found - expected).abs() <= bound, "{text}: {found}");
    }
}

#[test]
fn bare_numbers_take_the_unit_of_their_place() {
    let inertia = Dimension::INERTIA;
    let stiffness = Dimension::FORCE.times(LENGTH, -1);
    for (text, of, expected) in [
        ("300.1", LENGTH, 0.3001),
        ("L*cos(60)", LENGTH, 0.0015),
        ("L + 25 mm", LENGTH, 0.028),
        ("rod + 5", LENGTH, 0.305),
        ("2*25 mm", LENGTH, 0.05),
        ("180", ANGLE, PI),
        ("300 mm/600 mm", ANGLE, 0.5),
        ("90", Dimension::ANGULAR_VELOCITY, FRAC_PI_2),
        ("5e6", inertia, 5.0),
        ("-9810", Dimension::ACCELERATION, -9.81),
        ("2", stiffness, 2000.0),
        ("2 N/m", stiffness, 2.0),
        ("7", Dimension::FORCE, 7.0),
        ("acos(0)", ANGLE, FRAC_PI_2),
        ("pi/2*rad", ANGLE, FRAC_PI_2),
        ("L*pi/pi", LENGTH, 0.003),
    ] {
        assert_eq!(value(text, of, &in_drawing_units()), Ok(expected), "{text}");
    }
}

#[test]
fn faults_have_their_places() {
    for (text, of, expected) in [
        ("", NONE, "0..0: the text is empty"),
        (
            "2 +",
            NONE,
            "3..3: a number, a name or `(` is missing at the end",
        ),
        (
            "2 ** 3",
            NONE,
            "3..4: a number, a name or `(` is missing before `*`",
        ),
        ("2 L", NONE, "2..3: an operator is missing before `L`"),
        ("1.5.2", NONE, "3..5: an operator is missing before `.2`"),
        (
            "2,5",
            NONE,
            "1..2: `,` is outside of the arguments of a function",
        ),
        ("(1 + 2", NONE, "0..1: a bracket is never closed"),
        ("1 + 2)", NONE, "5..6: `)` closes no bracket"),
        ("2 $ 3", NONE, "2..3: `$` has no meaning in an expression"),
        ("λ*2", NONE, "0..2: there is no parameter `λ`"),
        (
            "a + b*c(2)",
            NONE,
            "0..1: there is no parameter `a`; 4..5: there is no parameter `b`; 6..7: there is no function `c`",
        ),
        ("2*cos", NONE, "2..5: `cos` is a function"),
        (
            "atan2(1)",
            NONE,
            "0..8: `atan2` takes two values (y, x), found 1",
        ),
        (
            "cos(25 mm)",
            NONE,
            "4..9: found a length (m), need an angle (rad)",
        ),
        ("90 deg", LENGTH, "found an angle (rad), need a length (m)"),
        (
            "1/2 mm",
            LENGTH,
            "found a quantity (1/m), need a length (m)",
        ),
        (
            "90 deg",
            NONE,
            "found an angle (rad), need a number without a unit",
        ),
        (
            "1 + (25 mm + 3 s)",
            NONE,
            "5..16: a length (m) and a time (s) have no sum, difference or order",
        ),
        ("2^(1 m)", NONE, "2..7: an exponent is a length (m)"),
        (
            "rod^0.5",
            NONE,
            "0..7: a length (m) has whole powers up to 64 only",
        ),
        ("sqrt(rod)", NONE, "0..9: a length (m) has no square root"),
        ("1/(L - 3)", NONE, "2..9: division by zero"),
        ("1/0", NONE, "2..3: division by zero"),
        ("0^-1", NONE, "0..4: division by zero"),
        ("sqrt(-1)", NONE, "0..8: `sqrt` is not defined for -1"),
        ("asin(1.5)", NONE, "0..9: `asin` is not defined for 1.5"),
        (
            "tan(90 deg)",
            NONE,
            "0..11: `tan` is not defined for 1.5708",
        ),
        (
            "log(0)",
            NONE,
            "0..6: the result is not a number up to 1e60",
        ),
        ("atan2(0, 0)", NONE, "0..11: `atan2` is not defined for 0"),
        (
            "1e200*1e200",
            NONE,
            "0..11: the result is not a number up to 1e60",
        ),
        ("(-8)^0.5", NONE, "0..8: a power is not defined for -8"),
    ] {
        assert_eq!(
            value(text, of, &names()),
            Err(expected.to_owned()),
            "{text}"
        );
    }
    // Errors in parameters are reported at the positions of the parameters.
    assert_eq!(
        value("2*wrong + cos(wrong)", NONE, &names()),
        Err(String::new())
    );
}

#[test]
fn pi_is_no_angle_in_degrees() {
    for text in ["pi/6", "2*pi - L", "pi + 90 deg", "cos(pi/3)", "sin(-pi^2)"] {
        let said = value(text, ANGLE, &in_drawing_units()).expect_err(text);
        assert!(said.contains("a number with `pi` is an angle"), "{said}");
        let in_radians = value(text, ANGLE, &names());
        assert!(in_radians.is_ok(), "{text}: {in_radians:?}");
    }
}

#[test]
fn nothing_nests_without_limit() {
    let n = LONGEST / 6;
    for text in ["(", "-", "cos(", "2^", "2 mm^("] {
        let said = value(&text.repeat(n), NONE, &names()).expect_err("too deep");
        assert!(said.contains("nested deeper than 60"), "{said}");
    }
    let flat = |n: usize| value(&("1+".repeat(n) + "1"), NONE, &names());
    assert_eq!(flat(LONGEST / 2 - 1), Ok((LONGEST / 2) as f64));
    let said = flat(LONGEST / 2).expect_err("too long");
    assert!(said.contains("longer than 16384 bytes"), "{said}");
}

#[test]
fn what_cancels_is_accurate_to_less() {
    let error = |text: &str| {
        let q = evaluate(text, &names()).unwrap_or_else(|faults| panic!("{faults:?}"));
        q.error / q.to_f64().abs()
    };
    assert!(error("1 - 0.9999999999999999") < 1e-14);
    assert!(error("sin(1)*cos(2)") < 5.0 * f64::EPSILON);
    assert!(error("1 - cos(1e-5)") > 1e-8);
    assert!(error("1/3 + 300 mm/(7 m)") < 1e-30);
}
