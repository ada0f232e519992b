//! Accuracy of lengths and directions of a scene: half a unit of the finest decimal place of the
//! file.

use crate::findings::Findings;
use crate::limits::{COARSEST, FINEST};
use crate::mechanism::Model;
use crate::write::number;

/// Returns the tolerances of lengths and directions. The text of a scene starts with these
/// tolerances. If there is no tolerance, the reason is reported.
pub(crate) fn tolerances(model: &Model, findings: &mut Findings) -> [Option<f64>; 2] {
    let size = size(model);
    let length = findings.lengths.half_unit();
    let angle = findings.directions.half_unit();
    let fits = |known: Option<f64>, size: f64| {
        known.filter(|known| (FINEST * size..=COARSEST * size).contains(known))
    };
    let found = [fits(length, size), fits(angle, 1.0)];
    let names = ["lengths", "directions and angles"];
    for ((name, known), unit) in names
        .iter()
        .zip([(length, found[0]), (angle, found[1])])
        .zip(["m", "rad"])
    {
        let remark = match known {
            (_, Some(told)) => format!(
                "The finest digit of {name} is {} {unit}: an accuracy of half this digit is assumed.",
                number(2.0 * told)
            ),
            (Some(coarse), None) if coarse > FINEST * size.max(1.0) => format!(
                "The digits of {name} are few: they are taken as exact. State a `tolerance` if they are not."
            ),
            _ => continue,
        };
        findings.remarks.push(remark);
    }
    found
}

/// Size of a model, defined as the largest distance of a joint or link from the first link.
fn size(model: &Model) -> f64 {
    let Some(first) = model.links.first() else {
        return 0.0;
    };
    let origin = first.pose.translation.vector;
    let links = model.links.iter().map(|link| link.pose.translation.vector);
    let joints = model.joints.iter().map(|joint| {
        let pose = model.pose(joint.links[1]);
        pose.translation.vector + pose.rotation * joint.points[1]
    });
    let centres = model
        .links
        .iter()
        .map(|link| link.pose.translation.vector + link.pose.rotation * link.mass.centre);
    let all = links.chain(joints).chain(centres);
    all.fold(0.0, |most: f64, point| most.max((point - origin).norm()))
}
