//! The tables that random scenes in the plane and in space both contain.

use super::draft::{Draft, Space};
use super::functions::function;
use super::parts::active;
use super::{Values, space};

/// Adds the table `[scene]`.
pub(super) fn head(draft: &mut Draft, values: &mut Values<'_>) {
    let name = values.name("scene", 0);
    let gravity = match values.numbers.below(4) {
        0 => String::new(),
        1 => format!("gravity = {}", values.velocity()),
        _ => match draft.space {
            Space::Plane => "gravity = [0.0, -9.81]".to_owned(),
            Space::Space => "gravity = [0.0, 0.0, -9.81]".to_owned(),
        },
    };
    let space = match draft.space {
        Space::Plane => "plane",
        Space::Space => "spatial",
    };
    draft.line(&format!(
        "[scene]\nname = {name}\nspace = \"{space}\"\n{gravity}"
    ));
    if values.numbers.once_in(5) {
        // Accuracies of the data, from rounding errors to manual measurements.
        let tolerances = ["1e-9", "1e-6", "1e-4", "1e-2"];
        draft.line(&format!("tolerance = {}", values.one(&tolerances)));
    }
    if values.has_expressions() {
        draft.line("format = 2");
        if values.numbers.once_in(3) {
            let units = [
                "length = \"mm\"",
                "angle = \"deg\"",
                "length = \"in\", angle = \"deg\"",
            ];
            draft.line(&format!("units = {{ {} }}", values.one(&units)));
        }
        draft.line(&values.parameters());
    }
}

/// Adds the table `[[marker]]`.
pub(super) fn marker(draft: &mut Draft, values: &mut Values<'_>) {
    let name = values.name("m", draft.markers.len());
    let body = draft.body(values.numbers, 4);
    draft.line(&format!(
        "[[marker]]\nname = {name}\nbody = {body}\npoint = {}",
        values.point()
    ));
    if values.numbers.once_in(2) {
        let turned = match draft.space {
            Space::Plane => format!("angle = {}", values.angle()),
            Space::Space => format!("orientation = {}", space::orientation(values)),
        };
        draft.line(&turned);
    }
    if values.numbers.once_in(8) {
        draft.line("tolerance = 1e-5");
    }
    draft.markers.push(name);
}

/// Adds the table `[[measure]]` between markers.
pub(super) fn measure(draft: &mut Draft, values: &mut Values<'_>) {
    let kinds = match draft.space {
        Space::Plane => [
            "distance",
            "x",
            "component",
            "speed",
            "angle",
            "angular-velocity",
        ],
        Space::Space => [
            "distance",
            "inclination",
            "component",
            "speed",
            "angle",
            "z",
        ],
    };
    let kind = values.one(&kinds);
    let directions = match (kind, draft.space) {
        ("component", _) => format!("\naxis = {}", values.direction()),
        ("angle", Space::Plane) => String::new(),
        ("angle" | "inclination", _) => {
            let (first, second) = (values.direction(), values.direction());
            let about = if kind == "angle" && values.numbers.once_in(2) {
                format!("\nabout = {}", values.direction())
            } else {
                String::new()
            };
            format!("\naxes = [{first}, {second}]{about}")
        }
        _ => String::new(),
    };
    let k = draft.text.len();
    let name = values.name("q", k);
    let count = draft.markers.len();
    let of = |values: &mut Values<'_>| {
        if count == 0 || values.numbers.once_in(8) {
            "\"ground\"".to_owned()
        } else {
            draft.markers[values.numbers.below(count)].clone()
        }
    };
    let first = of(values);
    let second = of(values);
    let markers = if values.numbers.once_in(3) || first == second && !values.numbers.once_in(8) {
        first
    } else {
        format!("{first}, {second}")
    };
    draft.line(&format!(
        "[[measure]]\nname = {name}\ntype = \"{kind}\"\nmarkers = [{markers}]{directions}"
    ));
}

/// Adds the table `[[drive]]` of a joint.
pub(super) fn drive(
    draft: &mut Draft,
    values: &mut Values<'_>,
    joint: &(String, &'static str),
    measure: &str,
) {
    let name = values.name("d", draft.drives.len());
    draft.line(&format!(
        "[[drive]]\nname = {name}\njoint = {}\ntype = \"{measure}\"",
        joint.0
    ));
    if values.numbers.once_in(4) {
        law(draft, values, measure);
    } else {
        draft.line(&format!("motion = {}", function(values)));
    }
    active(draft, values);
    draft.drives.push(name);
}

/// Adds a torque or a force as a function of the joint coordinate, its rate and the time.
pub(super) fn law(draft: &mut Draft, values: &mut Values<'_>, measure: &str) {
    let key = if measure == "angle" {
        "torque"
    } else {
        "force"
    };
    let laws = [
        "2 - 0.5*rate",
        "-3*measure - rate",
        "sin(5*t)",
        "-abs(rate)*rate",
        "1/measure",
        "log(rate)",
        "sqrt(measure)",
        "exp(1e3*t)",
        "1e6*(0.1 - measure)",
        "p0*rate",
    ];
    let law = values.one(&laws);
    draft.line(&format!("{key} = \"{law}\""));
}

/// Adds the remaining tables: `[start]`, `[[group]]`, `[simulate]`, `[output]`.
pub(super) fn wishes(draft: &mut Draft, values: &mut Values<'_>) {
    if values.numbers.once_in(4) {
        draft.line("[start]\nallow_correction = true");
        let component = match draft.space {
            Space::Plane => values.one(&["x", "y", "angle", "vx", "vy", "omega"]),
            Space::Space => values.one(&["x", "z", "rotation", "vy", "omega", "wx", "wz"]),
        };
        if values.numbers.once_in(2)
            && let Some(body) = draft.bodies.first()
            && !body.contains('\\')
        {
            draft.line(&format!(
                "keep = [\"{}.{component}\"]",
                body.trim_matches('"')
            ));
        }
    }
    if values.numbers.once_in(5) && draft.joints.len() > 1 {
        draft.line(&format!(
            "[[group]]\nname = \"g\"\nmembers = [{}, {}]",
            draft.joints[0].0, draft.joints[1].0
        ));
    }
    if !values.numbers.once_in(8) {
        let end = values.one(&["0.05", "0.1", "0.2", "1.0", "10", "0"]);
        draft.line(&format!("[simulate]\nt_end = {end}"));
        let methods = ["auto", "auto", "dopri5", "dop853", "tsit5", "radau5"];
        let method = values.one(&methods);
        draft.line(&format!("method = \"{method}\""));
        // Radau IIA relies on projection.
        if method != "radau5" && values.numbers.once_in(4) || values.numbers.once_in(40) {
            draft.line(&format!(
                "stabilisation = \"{}\"",
                values.one(&["projection", "none"])
            ));
        }
        if values.numbers.once_in(4) {
            draft.line(&format!(
                "rtol = {}\natol = {}",
                values.one(&["1e-3", "1e-6", "1e-12"]),
                values.one(&["1e-6", "1e-14", "1e-30"])
            ));
        }
        if values.numbers.once_in(4) {
            draft.line(&format!("output_step = {}", values.positive()));
        }
    }
    if values.numbers.once_in(6) {
        draft.line(&format!(
            "[output]\nreactions = {}\naccelerations = true\ntrajectory = {}",
            values.one(&["true", "false"]),
            values.one(&["true", "false"])
        ));
    }
}
