//! Accuracy of lengths and directions of a scene: half a unit of the finest decimal place of the
//! file.

use crate::assemble;
use crate::findings::Findings;
use crate::limits::{ASSEMBLED, COARSEST, COVERS, FINEST};
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

/// Returns tolerances that cover the gap of the loops at the pose of the scene. The gap is a share
/// of the size of the model, or in rad. A gap of rounding changes nothing.
pub(crate) fn covering(
    known: [Option<f64>; 2],
    gap: f64,
    model: &Model,
    findings: &mut Findings,
) -> [Option<f64>; 2] {
    if gap <= ASSEMBLED {
        return known;
    }
    let needed = [assemble::size(model), 1.0].map(|unit| one_digit_above(COVERS * gap * unit));
    let covers = |k: usize| Some(known[k].map_or(needed[k], |known| known.max(needed[k])));
    findings.remarks.push(format!(
        "The loops of the file do not close exactly. The tolerances {} m and {} rad cover {COVERS} times the largest gap.",
        number(needed[0]),
        number(needed[1])
    ));
    [covers(0), covers(1)]
}

/// Rounds a positive number up to one digit.
fn one_digit_above(x: f64) -> f64 {
    let exponent = x.log10().floor();
    let digit = (x / 10_f64.powf(exponent) * (1.0 - 1e-12)).ceil();
    // The decimal text is the nearest number to the digit with its exponent.
    format!("{digit}e{exponent}").parse().unwrap_or(x)
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
