//! Faults of markers and measures.

use joints::is_usable;

use super::BuildError;
use crate::description::Described;
use crate::element::BodySpace;
use crate::observed::Observed;

/// Reports markers and measures that cannot be evaluated.
pub(super) fn observed<S: BodySpace>(d: &Described<S>, errors: &mut Vec<BuildError>) {
    let Observed { markers, measures } = &d.observed;
    for marker in markers {
        let name = || marker.name.clone();
        if let Some(body) = marker.body.moving().filter(|k| *k >= d.bodies.len()) {
            errors.push(BuildError::UnknownBody {
                name: name(),
                body,
                n_bodies: d.bodies.len(),
            });
        }
        let ([x, y], angle) = (marker.point, marker.angle.unwrap_or_default());
        if ![x, y, angle].iter().all(|x| is_usable(*x)) {
            errors.push(BuildError::Marker {
                name: name(),
                x,
                y,
                angle,
            });
        }
    }
    for measure in measures {
        let [first, second] = measure.between;
        let name = measure.name.clone();
        let unknown = |k: &usize| *k >= markers.len();
        if let Some(marker) = [first, second].into_iter().flatten().find(unknown) {
            errors.push(BuildError::UnknownMarker {
                name,
                marker,
                n_markers: markers.len(),
            });
        } else if first == second {
            errors.push(BuildError::SameMarker { name });
        }
    }
}
