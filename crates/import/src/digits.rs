//! What the numbers of a file are known to: half a unit of the finest decimal place that it writes.
//!
//! A file does not say how many digits of its numbers count: `0.5` may be a half or a rounded
//! number. The finest place among all lengths is what its writer could tell, so half a unit of it
//! is their tolerance; the same for angles and directions.

use crate::findings::Findings;
use crate::limits::{COARSEST, FINEST};
use crate::mechanism::Model;
use crate::write::number;

/// The finest decimal place of numbers of one kind.
#[derive(Clone, Copy, Default)]
pub(crate) struct Digits {
    /// Largest number of decimals that was written; `None` if no number had any.
    pub(crate) decimals: Option<i32>,
}

impl Digits {
    /// Counts the decimals of a number. Trailing zeros count: they were written.
    pub(crate) fn see(&mut self, text: &str) {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse().unwrap_or(0)),
            None => (text, 0_i32),
        };
        let nonzero = mantissa.bytes().any(|b| matches!(b, b'1'..=b'9'));
        let after = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
        let decimals = i32::try_from(after)
            .unwrap_or(i32::MAX)
            .saturating_sub(exponent);
        if nonzero && decimals > 0 {
            self.decimals = Some(self.decimals.map_or(decimals, |most| most.max(decimals)));
        }
    }

    /// Half a unit of the finest place.
    pub(crate) fn half_unit(self) -> Option<f64> {
        self.decimals.map(|decimals| 0.5 * 10_f64.powi(-decimals))
    }
}

/// The tolerances of lengths and of directions for the head of a scene, and why there is none.
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
                "The finest digit of {name} is {} {unit}: they are taken to be known to half of it.",
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

/// Size of a model: the largest distance of a joint or link from the first link.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_finest_digit_counts() {
        let finest = |words: &[&str]| {
            let mut digits = Digits::default();
            words.iter().for_each(|word| digits.see(word));
            digits.decimals
        };
        assert_eq!(finest(&["0.5", "1.25", "-3"]), Some(2));
        assert_eq!(finest(&["1.5e-3", "2E2"]), Some(4));
        assert_eq!(finest(&["0.500"]), Some(3));
        assert_eq!(finest(&["0.000", "1", "0"]), None);
    }
}
