//! Words in the names of unknown elements and plugins that change the mechanism, with advice, and
//! elements that may occur only once.

use crate::findings::{Fault, Findings};
use crate::xml::Element;

/// Unknown elements with these words in their names change the mechanism. Each word has advice.
const CHANGING: [(&str, &str); 11] = [
    ("linear_bushing_rpy", BUSHING),
    (
        "bushing",
        "import a copy without it, and add a force `bushing` to the scene",
    ),
    (
        "constraint",
        "import a copy without it, and add the joint to the scene",
    ),
    (
        "tendon",
        "import a copy without it, and add a `coupling` or a `spring` to the scene",
    ),
    (
        "coupler",
        "import a copy without it, and add a `coupling` to the scene",
    ),
    (
        "weld",
        "import a copy without it, and add a `fixed` joint to the scene",
    ),
    ("loop_closure", CLOSURE),
    ("closed_loop", CLOSURE),
    ("kinematic_loop", CLOSURE),
    (
        "mimic",
        "write `<mimic joint=\"…\"/>` into the joint that follows",
    ),
    (
        "spring",
        "import a copy without it, and add a `spring` to the scene",
    ),
];

/// The law of Drake differs from the law of a scene, so the element is not converted.
const BUSHING: &str = "its law differs from a `bushing` of a scene: Drake computes the torques \
    from roll, pitch and yaw, and the force in axes halfway between both frames; a `bushing` uses \
    the rotation vector and the axes of the first body, and is unloaded at the start. For frames \
    that coincide at the start and for small motions, both laws agree to first order: import a \
    copy without it, and add a force `bushing` to the scene";

const CLOSURE: &str = "describe it as `<loop_joint>`, or with --loops";

/// Returns advice for an unknown element or plugin that changes the mechanism.
pub(crate) fn advice(name: &str) -> Option<&'static str> {
    let name = name.to_lowercase();
    let mut all = CHANGING.iter();
    all.find(|(word, _)| name.contains(word))
        .map(|(_, advice)| *advice)
}

/// Refuses an element that changes the mechanism.
pub(crate) fn refuse(element: Element, name: &str, advice: &str, findings: &mut Findings) {
    let message = format!("{name} changes the mechanism, and is not supported");
    let (source, span) = (element.source, element.span());
    let advice = advice.to_owned();
    findings.fault_with_help(Fault::Unsupported, source, span, message, "", Some(advice));
}

/// Rejects a second element of a kind that an element may contain once. `reader` states which
/// program uses only the first element.
pub(crate) fn refuse_second(
    parent: Element,
    kinds: &[&str],
    reader: &str,
    findings: &mut Findings,
) {
    for kind in kinds {
        let mut found = parent.children().filter(|child| child.name() == *kind);
        let (Some(first), Some(second)) = (found.next(), found.next()) else {
            continue;
        };
        let of = parent.attribute("name").map(|name| name.text.trim());
        let of = of.map_or(String::new(), |name| format!(" `{name}`"));
        let message = format!(
            "a second `<{kind}>` in `<{}>`{of}: {reader} the first one (line {})",
            parent.name(),
            first.line()
        );
        let help = format!("remove one of the two `<{kind}>`");
        let (source, span) = (second.source, second.span());
        findings.fault_with_help(Fault::Structure, source, span, message, "", help);
    }
}
