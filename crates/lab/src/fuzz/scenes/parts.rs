//! Parts of the tables of a random scene.

use super::Values;
use super::draft::Draft;

/// Adds the key `active`, which is mostly omitted.
pub(super) fn active(draft: &mut Draft, values: &mut Values<'_>) {
    if values.numbers.once_in(25) {
        let is_active = values.one(&["false", "true", "false", "0", "1"]);
        draft.line(&format!("active = {is_active}"));
    }
}

/// Begins a joint.
pub(super) fn begin(draft: &mut Draft, values: &mut Values<'_>, kind: &'static str) {
    let k = draft.joints.len();
    let name = values.name("j", k);
    draft.line(&format!("[[joint]]\nname = {name}\ntype = \"{kind}\""));
    active(draft, values);
    draft.joints.push((name, kind));
}

/// Adds the point of a joint between two bodies. In most scenes the point is given in ground axes,
/// so that the joint is consistent with any initial configuration.
pub(super) fn place(draft: &mut Draft, values: &mut Values<'_>, pair: &[String; 2]) {
    let line = if values.numbers.once_in(8) {
        format!(
            "points = {{ {} = {}, {} = {} }}",
            pair[0],
            values.point(),
            pair[1],
            values.point()
        )
    } else if !draft.markers.is_empty() && values.numbers.once_in(6) {
        let marker = values.numbers.below(draft.markers.len());
        format!("at = {}", draft.markers[marker])
    } else {
        format!("at = {}", values.point())
    };
    draft.line(&line);
}

/// Adds the point of a joint on one body.
pub(super) fn own_place(draft: &mut Draft, values: &mut Values<'_>) {
    let key = values.one(&["at", "point"]);
    draft.line(&format!("{key} = {}", values.point()));
}

/// Returns a stiffness or damping constant; the value is sometimes very large.
pub(super) fn stiff(values: &mut Values<'_>) -> String {
    if values.numbers.once_in(6) {
        format!("1e{}", values.numbers.between(3, 12))
    } else {
        values.positive()
    }
}
