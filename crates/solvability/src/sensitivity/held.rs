//! Computes how reaction components change with the configuration and the data if the multipliers
//! are constant. The components change because the directions of the rows and the reference points
//! of the joints change.

use std::collections::BTreeMap;

use model::reaction::Reactions;
use model::{ConstraintId, DataBlock, DataUnit, Mechanism, System};

use super::number::ReactionNumber;
use crate::limits::SLOPE_STEP;

/// Derivatives of one reaction component at constant multipliers.
#[derive(Clone, Debug, Default)]
pub(super) struct HeldSlopes {
    /// Derivatives with respect to velocity directions of the configuration.
    pub(super) by_pose: Vec<(usize, f64)>,
    /// Derivatives with respect to the numbers of the constraints.
    pub(super) by_data: Vec<(usize, f64)>,
}

/// A mechanism at an instant, and its multipliers.
pub(super) struct HeldMultipliers<'a> {
    pub(super) mechanism: &'a Mechanism,
    pub(super) t: f64,
    pub(super) q: &'a [f64],
    pub(super) lambda: &'a [f64],
    /// Size of the mechanism (m).
    pub(super) size: f64,
}

impl HeldMultipliers<'_> {
    /// Returns the derivatives of these numbers. The derivatives are central differences of values
    /// at neighbouring configurations, and of values of mechanisms that store neighbouring data.
    pub(super) fn slopes(
        &self,
        numbers: &[ReactionNumber],
        blocks: &[(DataBlock, f64)],
    ) -> Vec<HeldSlopes> {
        let mut found = vec![HeldSlopes::default(); numbers.len()];
        // The numbers that contain the reaction of a joint, if it is not zero.
        let mut of_joint: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (k, number) in numbers.iter().enumerate() {
            for joint in number.joints() {
                let rows = &self.mechanism.layout().groups[joint].rows;
                if rows.iter().any(|i| self.lambda[i] != 0.0) {
                    of_joint.entry(joint).or_default().push(k);
                }
            }
        }
        self.by_pose(numbers, &of_joint, &mut found);
        self.by_data(numbers, &of_joint, blocks, &mut found);
        found
    }

    fn by_pose(
        &self,
        numbers: &[ReactionNumber],
        of_joint: &BTreeMap<usize, Vec<usize>>,
        found: &mut [HeldSlopes],
    ) {
        let mut on_body: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &joint in of_joint.keys() {
            let bodies = self.mechanism.layout().groups[joint].bodies.iter();
            for body in bodies.filter_map(|body| body.moving()) {
                let joints = on_body.entry(body).or_default();
                if !joints.contains(&joint) {
                    joints.push(joint);
                }
            }
        }
        let space = self.mechanism.space();
        let mut s = self.mechanism.scratch();
        let mut moved = vec![0.0; self.mechanism.layout().n_v];
        for (&body, joints) in &on_body {
            for column in space.columns_of(body) {
                let unit = space.unit(column, self.size);
                moved[column] = SLOPE_STEP * unit;
                let [plus, minus] = [1.0, -1.0].map(|sign| {
                    let mut q = self.q.to_vec();
                    let of_bodies = self.mechanism.of_bodies_mut(&mut q);
                    of_bodies.copy_from_slice(&space.displaced(of_bodies, sign, &moved));
                    self.mechanism.pose(self.t, &q, &mut s);
                    self.values(self.mechanism.reactions(&s), numbers, joints, of_joint)
                });
                moved[column] = 0.0;
                for (k, slope) in slopes(plus, minus, SLOPE_STEP * unit) {
                    found[k].by_pose.push((column, slope));
                }
            }
        }
    }

    /// Returns the derivatives with respect to the data of a joint. These data change only the
    /// reaction of this joint.
    fn by_data(
        &self,
        numbers: &[ReactionNumber],
        of_joint: &BTreeMap<usize, Vec<usize>>,
        blocks: &[(DataBlock, f64)],
        found: &mut [HeldSlopes],
    ) {
        let mut s = self.mechanism.scratch();
        self.mechanism.pose(self.t, self.q, &mut s);
        let all = self.mechanism.data().numbers();
        for &joint in of_joint.keys() {
            let own = blocks.iter().map(|(block, _)| block);
            let own: Vec<&DataBlock> = own.filter(|block| block.group == joint).collect();
            let first = own.iter().map(|block| block.numbers.start).min();
            let last = own.iter().map(|block| block.numbers.end).max();
            let (Some(first), Some(last)) = (first, last) else {
                continue;
            };
            let mut stored = all[first..last].to_vec();
            for block in own {
                let step = match block.unit {
                    DataUnit::Length => SLOPE_STEP * self.size,
                    DataUnit::Angle => SLOPE_STEP,
                };
                for place in block.numbers.clone() {
                    let [plus, minus] = [step, -step].map(|step| {
                        stored[place - first] = all[place] + step;
                        // Axes are rotated from their current position. Therefore each value has
                        // its own copy.
                        let mut copy = self.mechanism.copy_of(ConstraintId(joint));
                        copy.set_numbers(&stored);
                        let reactions = self.mechanism.reactions(&s).with(&copy);
                        self.values(reactions, numbers, &[joint], of_joint)
                    });
                    stored[place - first] = all[place];
                    for (k, slope) in slopes(plus, minus, step) {
                        found[k].by_data.push((place, slope));
                    }
                }
            }
        }
    }

    /// Returns the contributions of these joints to the numbers that contain them.
    fn values(
        &self,
        reactions: Reactions<'_>,
        numbers: &[ReactionNumber],
        joints: &[usize],
        of_joint: &BTreeMap<usize, Vec<usize>>,
    ) -> Vec<(usize, f64)> {
        let (mut values, mut block) = (Vec::new(), Vec::new());
        for &joint in joints {
            let id = ConstraintId(joint);
            let reaction = reactions.reaction_in(&mut block, id, self.lambda);
            for &k in of_joint.get(&joint).into_iter().flatten() {
                values.push((k, numbers[k].of_joint(reactions, id, &reaction)));
            }
        }
        values
    }
}

/// Returns slopes between two lists of values of the same numbers. The lists are two steps apart.
/// Zeros are omitted.
fn slopes(
    plus: Vec<(usize, f64)>,
    minus: Vec<(usize, f64)>,
    step: f64,
) -> impl Iterator<Item = (usize, f64)> {
    let both = plus.into_iter().zip(minus);
    let each = both.map(move |((k, plus), (_, minus))| (k, (plus - minus) / (2.0 * step)));
    each.filter(|(_, slope)| *slope != 0.0)
}
