//! Checks forces against the weight of the mechanism, and springs against their free length. Each
//! check gives at most one warning for a scene, and the warning names the first force.

use joints::spec::Unit;
use model::codes::Code;
use model::space::norm;
use model::words::{quantity, rounded};
use model::{Force, ForceDefinition, Function};

use crate::bodies::Bodies;
use crate::element::ElementRead;
use crate::findings::Findings;
use crate::limits::{HEAVIEST_FORCE, LONGEST_SPRING, RUN_INSTANTS};
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;

/// Warns about given forces that are much larger than the weight of all bodies. The functions of
/// time are evaluated at their break times and at instants up to the end of the run.
pub(crate) fn applied<S: SceneSpace>(
    forces: &[(Force<S>, Entry)],
    weight: f64,
    t_end: f64,
    findings: &Findings,
) {
    if weight <= 0.0 {
        return;
    }
    for (force, entry) in forces.iter().filter(|(_, entry)| entry.is_active) {
        let spec = &force.element.spec().common;
        let all = spec.functions().zip(&force.functions);
        let own: Vec<_> = all.filter(|((_, unit), _)| *unit == Unit::Force).collect();
        let functions: Vec<&Function> = own.iter().map(|(_, function)| *function).collect();
        let Some(((key, _), _)) = own.first() else {
            continue;
        };
        let ratio = largest(&functions, t_end) / weight;
        if ratio <= HEAVIEST_FORCE {
            continue;
        }
        findings.warning_once(
            const { Code::new(188) },
            entry.span(key),
            format!(
                "force `{}` reaches {} N, {} times the weight of the mechanism, {} N",
                force.name,
                rounded(ratio * weight),
                rounded(ratio),
                rounded(weight)
            ),
            "in another unit?",
            "write the force in N, or the masses in kg: numbers without a unit are in these units",
        );
    }
}

/// The largest length of a vector with these components.
fn largest(components: &[&Function], t_end: f64) -> f64 {
    let breaks = components.iter().flat_map(|f| f.break_times());
    let is_constant = components.iter().all(|f| f.is_constant());
    let instants = if is_constant { 1 } else { RUN_INSTANTS };
    let run = (0..=instants).map(|k| t_end * f64::from(k) / f64::from(instants));
    let at = |t: f64| {
        let vector: Vec<f64> = components.iter().map(|f| f.jet(t)[0]).collect();
        norm(&vector)
    };
    breaks.chain(run).map(at).fold(0.0, f64::max)
}

/// Warns about a spring whose ends are much further apart at the start than its stated free length.
/// A free length of zero is permitted.
pub(crate) fn spring<S: SceneSpace>(
    table: &Table,
    read: &ElementRead<'_, ForceDefinition<S>>,
    bodies: &Bodies<S>,
) {
    let Some((of, element)) = &read.element else {
        return;
    };
    let (spec, arguments) = (&element.spec().common, &read.arguments);
    let Some((key, free, span)) = arguments.stated_length(spec).filter(|_| spec.points_apart)
    else {
        return;
    };
    let places = spec.slots_of_points().zip(arguments.points::<S>(spec));
    let mut places = places.map(|(slot, point)| S::point(bodies.at_start(of[slot], point)));
    let (Some(a), Some(b)) = (places.next(), places.next()) else {
        return;
    };
    let length = norm(&[a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
    if !(free > 0.0 && length > LONGEST_SPRING * free) {
        return;
    }
    table.findings.warning_once(
        const { Code::new(189) },
        span,
        format!(
            "{}: `{key}` is {}, but at the start its ends are {} apart, {} times as far",
            table.subject,
            quantity(free, "m"),
            quantity(length, "m"),
            rounded(length / free)
        ),
        "in another unit?",
        &format!(
            "numbers without a unit are in {}: correct `{key}`, or leave it out for the length at the start",
            table.language.length_unit().name
        ),
    );
}
